-- Lists the values of --sweep: name=from:to:count, name=from:to:*count for equal factors, or name=v1,v2.
local the = ...

local POINTS_MAX <const> = 1000000

local function is_finite(value) return value and value - value == 0 end

-- Returns the ends of a range, whether each value is the one before times a factor, and the count; nil: it is no range.
local function read_range(my, text)
  local from, to, star, count = text:match "^([^:]*):([^:]*):(%*?)%s*%+?(%d+)$"
  from, to, count = my.number(from), my.number(to), tonumber(count)
  if not (is_finite(from) and is_finite(to) and count >= 1 and count <= POINTS_MAX) then return nil end
  return from, to, star == "*", count
end

-- Rounds to 15 significant digits of `scale`, so that 0.1:0.9:9 has 0.3 and not 0.30000000000000004.
local function shorten(value, scale)
  if value % 1 == 0 then return value end -- also if the scale is 0
  local decimals = 14 - math.floor(math.log(scale, 10))
  if decimals < 1 or decimals > 99 then return value end
  return tonumber(("%." .. decimals .. "f"):format(value))
end

-- Returns value number `step` of steps 0 .. last. The ends are exact, and so are whole numbers if steps are whole:
-- 1:50:50 contains 28.
local function value_at(my, from, to, has_factor, step, last)
  if step == 0 then return from end
  if step == last then return to end
  if has_factor then
    local value = from * my.power(to / from, step / last)
    return shorten(value, math.abs(value))
  end
  local value = (from * (last - step) + to * step) / last
  if not is_finite(value) then value = from * ((last - step) / last) + to * (step / last) end
  return shorten(value, math.max(math.abs(from), math.abs(to)))
end

-- Returns the shortest text that reads back as the number.
local function spell(value)
  for digits = 15, 17 do
    local text = ("%." .. digits .. "g"):format(value)
    if digits == 17 or tonumber(text) == value then return text end
  end
end

local function list_range(my, name, from, to, has_factor, count)
  if has_factor and not (to / from > 0 and is_finite(to / from)) then
    error(name .. ": expected two ends of the same sign, neither of them 0, for steps of equal factors", 0)
  end
  local out = {}
  for step = 0, count - 1 do out[#out + 1] = spell(value_at(my, from, to, has_factor, step, count - 1)) end
  return out
end

local function list_words(name, text)
  local out = {}
  for word in (text .. ","):gmatch "([^,]*)," do
    if word == "" then error(name .. ": a value expected before and after each comma, got '" .. text .. "'", 0) end
    out[#out + 1] = word
  end
  return out
end

-- Returns the values, each with a zero byte after it.
function the.values(my)
  local name, text = my.text:match "^([^=]+)=(.*)$"
  local is_list = text and text:find(",", 1, true)
  local from, to, has_factor, count
  if text and not is_list then from, to, has_factor, count = read_range(my, text) end
  if not (is_list or from) then
    error(("expected name=from:to:count with count 1 .. %d, such as radius=1:5:9, name=from:to:*count for equal "
      .. "factors, or a list, name=1,5,9; got '%s'"):format(POINTS_MAX, my.text), 0)
  end
  local values = is_list and list_words(name, text) or list_range(my, name, from, to, has_factor, count)
  return table.concat(values, "\0") .. "\0"
end
