-- Runs the measurements in rounds, each in a shuffled order, and collects the values that their programs print.
local M = {}

local absent = {
  hand = "not built: needs AVX-512",
  embree = "not built: needs AVX-512 and libembree-dev",
  embree_lone = "not built: needs libembree-dev",
  povray = "povray is not installed",
  tachyon = "tachyon is not installed",
}

local function file_exists(path)
  local file = io.open(path, "rb")
  if file then file:close() end
  return file ~= nil
end

local function installed(command)
  return os.execute("command -v " .. command .. " >/dev/null 2>&1") == true
end

-- Returns the command that runs a side, or nil and the reason. "unlike SIDE" compares the picture of SIDE with glint's.
local function command_of(side, build)
  if side == "povray" or side == "tachyon" then
    if not installed(side) then return nil, absent[side] end
    return ("BUILD='%s' tests/bench/peer.sh %s"):format(build, side)
  end
  if side == "lua" then return ("LUA_CPATH='%s/?.so;;' lua5.4 tests/bench/lua_program.lua"):format(build) end
  local compared = side:match "^unlike (.+)$"
  local name = (compared or side):gsub("^glint$", "glint_side")
  local program = ("%s/tests/bench/%s"):format(build, name)
  if not file_exists(program) then return nil, absent[name] or program .. " is not there" end
  return compared and ("BUILD='%s' tests/bench/unlike.sh %s"):format(build, name) or program
end

-- Runs a command and returns its lines "name unit value"; nil and the reason when the command fails or refuses.
local function run(command)
  local pipe = assert(io.popen(command, "r"))
  local values, refusal = {}, nil
  for line in pipe:lines() do
    local name, unit, value = line:match "^(%S+) (%S+) (%S+)$"
    if name == "late" then
      refusal = ("over %s s"):format(value)
    elseif name == "lacks_isa" then
      refusal = "this machine lacks the instruction set"
    elseif name then
      values[name] = { unit = unit, value = assert(tonumber(value), line) }
    end
  end
  if not pipe:close() then refusal = "failed" end
  if refusal then return nil, refusal end
  return values
end

-- Runs one measurement once and appends its values to its samples. A side that refuses is not run again.
local function measure(m, folder)
  local arguments = m[3]:gsub("%$OUT", folder)
  local values, why = run(m.command .. " " .. arguments)
  if not values then
    m.refused = why
    return
  end
  for name, v in pairs(values) do
    local samples = m.samples[name] or { unit = v.unit }
    samples[#samples + 1] = v.value
    m.samples[name] = samples
  end
end

local function shuffle(list)
  for i = #list, 2, -1 do
    local j = math.random(i)
    list[i], list[j] = list[j], list[i]
  end
end

-- Returns the wanted measurements whose side is available, with `command` set. Sets `refused` in the others.
local function selected_of(measurements, options)
  local selected = {}
  for _, m in ipairs(measurements) do
    m.samples = {}
    if not options.wanted[m[1]] then
      m.refused = "not run"
    else
      m.command, m.refused = command_of(m[2], options.build)
      if m.command then selected[#selected + 1] = m end
    end
  end
  return selected
end

-- Runs every wanted measurement, and stores its `samples` by name, or the reason `refused`.
-- options: build, runs, wanted (set of ids), folder (for files), progress (a line on stderr)
function M.run(measurements, options)
  local selected = selected_of(measurements, options)
  for round = 1, options.runs do
    local left = {}
    for _, m in ipairs(selected) do
      if not m.refused and round <= (m.runs or options.runs) then left[#left + 1] = m end
    end
    shuffle(left)
    for i, m in ipairs(left) do
      if options.progress then
        io.stderr:write(("\rround %d of %d, %d of %d: %-40s"):format(round, options.runs, i, #left, m[1]))
      end
      measure(m, options.folder)
    end
  end
  if options.progress then io.stderr:write("\r", (" "):rep(72), "\r") end
end

-- Returns the lower quartile, the median and the upper quartile.
function M.quartiles(samples)
  local sorted = table.move(samples, 1, #samples, 1, {})
  table.sort(sorted)
  local n = #sorted
  return sorted[1 + n // 4], sorted[1 + n // 2], sorted[n - n // 4]
end

return M
