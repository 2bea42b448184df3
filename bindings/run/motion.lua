-- glint.ease and glint.keys: numbers that change with a frame's time. They use only sums and products, so that the
-- results are the same on every machine.
local the = ...
local M = {}
local floor, concat, format = math.floor, table.concat, string.format
local next, rawget, select, tostring, type = next, rawget, select, tostring, type

local VALUE_MAX <const> = 16 -- numbers in a key's value, at most
local NAMES <const> = { "linear", "smooth", "smoother", "in", "out" }
local EASINGS <const> = {
  linear = function(t) return t end,
  smooth = function(t) return t * t * (3 - 2 * t) end,
  smoother = function(t) return t * t * t * (t * (t * 6 - 15) + 10) end, -- K. Perlin, "Improving Noise", SIGGRAPH 2002
  ["in"] = function(t) return t * t end,
  out = function(t) return t * (2 - t) end,
}

local function eased(ease, t) return EASINGS[ease](t > 0 and (t < 1 and t or 1.0) or 0.0) end

-- ---- The curve between keys ----

-- Returns the slope at a key: the slope between its neighbours (E. Catmull, R. Rom, "A Class of Local Interpolating
-- Splines", 1974, for times that are not evenly spaced). At the ends, the slope of the first or last segment, or around
-- the cycle.
local function slope(track, i, c)
  local times, values, last = track.times, track.values, #track.times
  if i > 1 and i < last then return (values[i + 1][c] - values[i - 1][c]) / (times[i + 1] - times[i - 1]) end
  local first_span, last_span = times[2] - times[1], times[last] - times[last - 1]
  local first_rise, last_rise = values[2][c] - values[1][c], values[last][c] - values[last - 1][c]
  if track.cyclic then return (first_rise + last_rise) / (first_span + last_span) end
  return i == 1 and first_rise / first_span or last_rise / last_span
end

-- Returns component c between keys i and i + 1, at the fraction t of the interval.
local function between(track, i, t, c)
  local a, b = track.values[i][c], track.values[i + 1][c]
  if t <= 0 or t >= 1 then return t <= 0 and a or b end
  if track.ease ~= "spline" then return a + eased(track.ease, t) * (b - a) end
  local span, s, rest = track.times[i + 1] - track.times[i], t * t * (3 - 2 * t), 1 - t
  return (a + s * (b - a)) + span * (t * rest * (rest * slope(track, i, c) - t * slope(track, i + 1, c)))
end

local function read_time(path, ...)
  local t = the.read_number(path, ...)
  if t ~= t then the.refuse(t, path, "number that is not NaN") end
  return t
end

local function value_at(track, t)
  local times, i, out = track.times, 1, {}
  local first = times[1]
  local whole = times[#times] - first
  if track.cyclic and (t < first or t >= first + whole) then t = t - whole * floor((t - first) / whole) end
  while i + 1 < #times and t >= times[i + 1] do i = i + 1 end
  local share = (t - times[i]) / (times[i + 1] - times[i])
  for c = 1, track.size do out[c] = between(track, i, share, c) end
  if not track.is_list then return out[1] end
  return track.size == 3 and the.vector(out[1], out[2], out[3]) or out
end

-- ---- In and out ----

local function check_easing(value, path, more)
  if type(value) ~= "string" or not (EASINGS[value] or (more and value == "spline")) then
    the.refuse(value, path, "one of '" .. concat(NAMES, "', '") .. (more and "', 'spline'" or "'"))
  end
  return value
end

function M.ease(...)
  local t, kind = read_time("ease", ...), select(2, ...)
  return eased(kind == nil and "smooth" or check_easing(kind, "ease: kind"), t)
end

local function read_finite(value, path)
  local x = the.read_number(path, value)
  if x - x ~= 0 then the.refuse(value, path, "finite number") end
  return x
end

-- Returns how many numbers a value has: a number, a vector, or a list of numbers; and whether it is a vector or a list.
local function size_of(value, path)
  if type(value) == "number" then return 1, false end
  if the.is_vector(value) then return 3, true end
  local size = type(value) == "table" and the.check_list(value, path) or 0
  if size < 1 or size > VALUE_MAX then the.refuse(value, path, "number, vector or list of up to 16 numbers") end
  return size, true
end

-- Returns the numbers of a value, which must have the form of the first key's.
local function read_value(value, path, track)
  local size, is_list = size_of(value, path)
  if size ~= track.size or is_list ~= track.is_list then
    the.raise(path .. ": expected a value of the same type and length as the first key's")
  end
  if not is_list then return { read_finite(value, path) } end
  local out, is_vector = {}, type(value) ~= "table"
  for c = 1, size do out[c] = is_vector and value[c] or read_finite(rawget(value, c), path) end
  return out
end

-- Returns the time and the value of key i, and its name for messages.
local function read_key(keys, i)
  local key, path = rawget(keys, i), format("keys[%d]", i)
  if type(key) ~= "table" or the.check_list(key, path) ~= 2 then the.refuse(key, path, "{time, value}") end
  return rawget(key, 1), rawget(key, 2), path
end

local function read_options(keys, track)
  for name, value in next, keys do
    if name == "ease" then
      track.ease = check_easing(value, "keys.ease", true)
    elseif name == "cyclic" then
      if type(value) ~= "boolean" then the.refuse(value, "keys.cyclic", "boolean") end
      track.cyclic = value
    elseif type(name) == "string" then
      the.no_such_field("keys", name, the.nearer(name, the.nearer(name, nil, "ease"), "cyclic"))
    end
  end
end

function M.keys(keys)
  if type(keys) ~= "table" then the.refuse(keys, "keys", "list of {time, value}") end
  local count = the.check_list(keys, "keys", true)
  if count < 2 then the.raise(format("keys: two keys or more expected, got %d", count)) end
  local track, _, first, name = { times = {}, values = {}, ease = "smooth" }, read_key(keys, 1)
  track.size, track.is_list = size_of(first, name)
  local times = track.times
  for i = 1, count do
    local time, value, path = read_key(keys, i)
    track.values[i] = read_value(value, path, track)
    times[i] = read_finite(time, path)
    if i > 1 and times[i] <= times[i - 1] then
      the.raise(format("%s: a time after %s expected, got %s", path, tostring(times[i - 1]), tostring(times[i])))
    end
  end
  read_options(keys, track)
  return function(...) return value_at(track, read_time("keys", ...)) end
end

return M
