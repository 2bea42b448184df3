-- Reads the input as a data file; its first byte selects the reader. The reader returns data, or an error that names
-- file and line. An error of Lua itself (a nil indexed, a nil added to) is a finding.
package.path = "scripts/lib/?.lua;" .. package.path
local path = ("/dev/shm/glint-fuzz-data-%d"):format(io.open("/proc/self/stat"):read "n")

local function walk(frames)
  return function()
    for frame in frames(path) do
      for _ in frame:atoms() do end
    end
  end
end

-- Reads the columns of all frames by name, then the frames again in another order.
local function run(reader)
  return function()
    local film = reader.film(path)
    for n = film:length(), 1, -2 do
      local frame = film:frame(n)
      for _ in frame:atoms(table.unpack(frame.columns, 1, 30)) do end
    end
  end
end

local function load(name) return require("glint." .. name) end
local readers = {
  walk(load "xyz".frames),
  walk(load "pdb".frames),
  walk(load "lammps".frames),
  function() for _ in load "points".frame(path):atoms() do end end,
  function() load "nff".load(path) end,
  run(load "xyz"),
  run(load "pdb"),
  run(load "lammps"),
}

return function(bytes)
  if #bytes < 1 then return end
  local file = assert(io.open(path, "wb"))
  file:write(bytes:sub(2))
  file:close()
  local ok, message = pcall(readers[bytes:byte() % #readers + 1])
  os.remove(path)
  if ok then return end
  assert(type(message) == "string", "an error that is no text")
  message = message:gsub("^%S+%.lua:%d+: ", "") -- the rest of the message may quote the file
  for _, own in ipairs { "attempt to", "bad argument", "stack overflow", "malformed", "number has no" } do
    assert(message:find(own, 1, true) ~= 1, message)
  end
end
