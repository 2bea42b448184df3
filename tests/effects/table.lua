--- Unused effects cost nothing: measures the cost of every effect in a scene that does not use it.
---   table.lua check BUILD    checks its counters and its calls: 0 without the effect, nonzero with it
---   table.lua bench BUILD    prints these, and the instructions of BUILD and of BUILD/without/PART, which lacks it
---   table.lua parts          the parts for which there are such builds
--- Instructions and calls are counted by valgrind, within tiles, for AVX2, which it supports, or generic kernels.
local here = arg[0]:gsub("[^/]*$", "")
local rows = dofile(here .. "rows.lua")
local LIMIT = 0.01 -- largest allowed cost of an unused effect, as a share of the instructions
local mode, build = arg[1], arg[2]

local function output(command)
  local pipe = assert(io.popen(command .. " 2>&1"))
  local text = pipe:read "a"
  return text, pipe:close()
end

local libraries = build and output(("%s/glint --version --verbose"):format(build)) or ""
local isa = libraries:find "kernels:[^;]* avx2" and "avx2" or "generic"

--- file: where the picture goes, or nil.
local function arguments(row, more, file)
  return ("%sscene.lua -D effect=%s -o %s -t 1 --size 320x180 %s %s"):format(here, row and row.name or "none",
    file or "none", row and row.options or "", more)
end

--- The counter of an effect in the events of a frame that uses `called` (a row, or nil).
local function counted(row, called)
  local text = output(("%s/glint %s"):format(build, arguments(called, "--json")))
  local stages = assert(text:match '},"stages":(%b{})', text)
  local found = row.stage and stages:find(('"%s":'):format(row.stage), 1, true) and 1 or 0
  return row.rays and tonumber(text:match(('"%s":(%%d+)'):format(row.rays))) + found or found
end

--- Instructions by function and in total: within tiles, or of the whole program if a picture with that ending is
--- written. Uses a copy without debug information: valgrind cannot read all of clang's, and symbols have the names.
local function traced(folder, row, ending)
  local file, bare = os.tmpname(), os.tmpname()
  local picture = ending and ("%s.%s"):format(file, ending)
  local log, ok = output(("strip --strip-debug -o %s %s/glint && GLINT_ISA=%s valgrind --tool=callgrind "
    .. "--callgrind-out-file=%s --compress-strings=no %s %s %s"):format(bare, folder, isa, file,
    ending and "" or "--toggle-collect=glint_tile_render", bare, arguments(row, "--quiet", picture)))
  os.remove(bare)
  if picture then output(("rm -f %s*.%s"):format(file, ending)) end
  assert(ok, log)
  local functions, total, name, skip = {}, 0, nil, false
  for line in io.lines(file) do
    local cost = line:match "^[%d+*-]%S* (%d+)$"
    if line:match "^fn=" then
      name = line:match "^fn=(.*)$"
    elseif line:match "^calls=" then
      skip = true
    elseif cost and skip then
      skip = false
    elseif cost then
      functions[name] = (functions[name] or 0) + tonumber(cost)
      total = total + tonumber(cost)
    end
  end
  os.remove(file)
  return functions, total
end

local function calls(row, functions)
  local count = 0
  for name in pairs(functions) do
    for _, pattern in ipairs(row.functions) do
      if name:match(pattern) then count = count + 1 break end
    end
  end
  return count
end

local function parts()
  local seen, list = {}, {}
  for _, row in ipairs(rows) do
    if row.part and not seen[row.part] then list[#list + 1] = row.part end
    if row.part then seen[row.part] = true end
  end
  return list
end

if mode == "parts" then
  print(table.concat(parts(), " "))
  return
end

local functions, total = traced(build, nil)
local written = traced(build, nil, "png")
local without = {}
for _, part in ipairs(mode == "bench" and parts() or {}) do
  local _, less = traced(build .. "/without/" .. part, nil)
  without[part] = total / less - 1
end
local passed, failed = 0, 0
print(("# %-12s %8s %8s %10s %10s %14s"):format("effect", "counter", "with it", "functions", "with it", "instructions"))
for _, row in ipairs(rows) do
  if row.library and not libraries:find(row.library, 1, true) then goto next end
  local none, some = counted(row, nil), counted(row, row)
  local called, called_with = calls(row, row.file and written or functions), calls(row, (traced(build, row, row.file)))
  local more = row.part and without[row.part]
  local good = none == 0 and called == 0 and (some > 0 or not (row.stage or row.rays)) and
    (called_with > 0 or #row.functions == 0) and (not more or more <= LIMIT)
  if good then passed = passed + 1 else failed = failed + 1 end
  print(("%s %-12s %8d %8d %10d %10d %14s"):format(good and "ok" or "not ok", row.name, none, some, called, called_with,
    more and ("%+.3f %%"):format(100 * more) or "-"))
  ::next::
end
print(("%d passed, %d failed, 0 skipped"):format(passed, failed))
os.exit(failed == 0)
