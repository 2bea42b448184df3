-- Renders frames of a script in every configuration: instruction sets, threads, shards, with and without cached stages.
-- Checks that the last frame has the same bytes in all of them.
local command = os.getenv "GLINT" or (os.getenv "BUILD" or "build") .. "/glint"

-- Returns the bytes of frame `last` as a .pfm, or nil, and the command's messages.
local function render(environment, script, last, options)
  local path = os.tmpname()
  local ok = os.execute(("%s %s %s --quiet --force %s -o %s_%%d.pfm 2>%s"):format(environment, command, script, options, path, path))
  local file = ok and io.open(("%s_%d.pfm"):format(path, last), "rb")
  local bytes = file and file:read "a"
  if file then file:close() end
  local said <close> = assert(io.open(path))
  for n = 1, last do os.remove(("%s_%d.pfm"):format(path, n)) end
  os.remove(path)
  return bytes, said:read "a"
end

-- Checks frame `last` of the script's `count` frames.
return function(tally, script, last, count)
  local size = (" --size %dx%d"):format(tally.side(75), tally.side(53))
  local only, all = "-f " .. last, "-f 1-" .. last
  for _, precision in ipairs { "double", "float" } do
    local picture = size .. " --precision " .. precision
    local usual, message = render("", script, last, all .. picture)
    tally.check(usual, "a picture: %s", message)
    for _, way in ipairs(tally.with_sets({
      { "", only .. " --threads 1" }, { "", all .. " --threads 7 --no-reuse" }, { "", ("--shard %d/%d"):format(last, count) },
      { "", all .. " --reuse-memory 1M" },
    }, only)) do
      local other, said = render(way[1], script, last, way[2] .. picture)
      local name = way[1] .. " " .. way[2] .. picture
      if not other and said:find("this machine lacks", 1, true) then
        print("# skip " .. name)
      else
        tally.check(other == usual, "the same picture: %s %s", name, other and "" or said)
      end
    end
  end
end
