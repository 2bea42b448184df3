-- Times patterns in plain Lua, one point at a time, and the tracing of a pattern. LUA_CPATH must find glint.so. Prints
-- "name unit value": nanoseconds per point of checker and marble as in glint_program.c, microseconds per trace.
local glint = require "glint"

-- Runs a function for at least a tenth of a second. Returns seconds per call.
local function time_of(f)
  local calls = 1
  while true do
    local start = os.clock()
    for i = 1, calls do f(i) end
    local seconds = os.clock() - start
    if seconds >= 0.1 then return seconds / calls end
    calls = calls * 2
  end
end

local floor, noise, sin = math.floor, glint.noise, math.sin

local function checker(i)
  local x, y, z = 0.37 * i, 0.11 * i, 0.23 * i
  return (floor(x) + floor(y) + floor(z)) % 2 == 0 and 0.9 or 0.05
end

local point = { x = 0, y = 0, z = 0 }
local function octaves(x, y, z)
  local sum, size, strength = 0, 1, 1
  for _ = 1, 3 do
    point.x, point.y, point.z = size * x, size * y, size * z
    sum, size, strength = sum + strength * noise(point), 2 * size, strength / 2
  end
  return sum
end

local function marble(i)
  local x, y, z = 0.37 * (i % 50), 0.11 * (i % 60), 0.23 * (i % 70)
  local share = 0.5 * sin(7 * x + 5 * octaves(x, y, z)) + 0.5
  return 0.9 + share * (0.05 - 0.9), 0.9 + share * (0.15 - 0.9), 0.9 + share * (0.25 - 0.9)
end

-- Bricks with a grain. Any number could change in the next frame, so a trace costs as much as in a frame.
local height = 1
local bricks = glint.pattern(function(p)
  local row = glint.floor(p.y / height)
  local u, v = glint.fract(p.x / 2 + 0.5 * glint.mod(row, 2)), glint.fract(p.y / height)
  local mortar = glint["or"](glint.less(u, 0.05 * height), glint.less(v, 0.1 * height))
  local grain = 0.1 * glint.noise(p * 9) + 0.05 * glint.noise(p * 21) * glint.fract(p.z)
  return glint.select(mortar, 0.5, { 0.6 + grain, 0.2 + grain, 0.15 + grain * glint.sqrt(u + v) })
end)

assert(#bricks >= 28 and #bricks <= 34, #bricks)
local function say(name, unit, value) print(("%s %s %.6g"):format(name, unit, value)) end

say("checker", "ns", 1e9 * time_of(checker))
say("marble", "ns", 1e9 * time_of(marble))
say("trace", "us", 1e6 * time_of(function(i)
  height = 1 + 1e-6 * i
  return #bricks
end))
