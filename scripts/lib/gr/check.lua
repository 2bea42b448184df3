-- Checks the arguments of the dialect's calls as the course's glue code does: numeric strings count as numbers, vectors
-- have exactly n entries, extra arguments are ignored. Errors name the function, the argument and the value, at the
-- scene's line. The libraries' functions are saved here, because a scene may overwrite the globals.
local glint = require "glint"
local check = {}

local error, pairs, rawget, rawlen, tonumber, tostring, type = error, pairs, rawget, rawlen, tonumber, tostring, type
local format, getinfo, huge, mathtype = string.format, debug.getinfo, math.huge, math.type
local abs, concat, max, select = math.abs, table.concat, math.max, select

local own = {} -- sources of the dialect's modules, where errors are not reported

--- Called by each module of the dialect as it loads.
function check.own_source() own[getinfo(2, "S").source] = true end
check.own_source()

-- Returns a message with the nearest line of the scene.
local function placed(text, ...)
  local message = format(text, ...)
  for level = 3, huge do
    local at = getinfo(level, "Sl")
    if not at then break end
    if at.currentline > 0 and not own[at.source] then
      return at.short_src .. ":" .. at.currentline .. ": " .. message
    end
  end
  return message
end

--- Raises an error at the nearest line of the scene.
function check.raise(text, ...) error(placed(text, ...), 0) end

local told = {}

--- Warns, once for each `key`.
function check.tell(key, text, ...)
  if told[key] then return end
  told[key] = true
  glint._warn(placed(text, ...))
end

--- Warns once about arguments beyond those that a call reads; ignores those without effect (0, false, "").
function check.left_out(call, ...)
  local texts, says = {}, false
  for i = 1, select("#", ...) do
    local value = select(i, ...)
    texts[i] = check.spelling(value)
    says = says or value and value ~= 0 and value ~= ""
  end
  if says then check.tell(call .. " left out", "gr.%s: left out: %s", call, concat(texts, ", ")) end
end

--- Returns the file whose code calls the dialect, or nil if it is not a file.
function check.caller()
  for level = 2, huge do
    local at = getinfo(level, "Sl")
    if not at then return nil end
    if at.currentline > 0 and not own[at.source] then return at.source:match "^@(.*)" end
  end
end

local spelt = setmetatable({}, { __mode = "k" }) -- names of nodes, materials and lights in messages

--- Sets the name of an object of the dialect for messages.
function check.name_object(object, name) spelt[object] = name end

--- Returns a value as messages show it.
function check.spelling(value)
  local kind = type(value)
  if kind == "string" then
    return #value <= 40 and format("%q", value):gsub("\\\n", "\\n") or format("%q...", value:sub(1, 40))
  elseif kind == "number" then
    return value ~= value and "nan" or mathtype(value) == "integer" and tostring(value) or format("%.14g", value)
  elseif kind == "table" then
    return spelt[value] or format("table of %d", rawlen(value))
  elseif kind == "boolean" then
    return tostring(value)
  end
  return kind
end

function check.refuse(call, argument, expected, value)
  check.raise("gr.%s: %s: %s expected, got %s", call, argument, expected, check.spelling(value))
end

--- Returns a finite number, also from a string that spells one.
function check.number(call, argument, value)
  local number = tonumber(value)
  if not number then check.refuse(call, argument, "number", value) end
  if number ~= number or number == huge or number == -huge then
    check.refuse(call, argument, "finite number", value)
  end
  return number
end

--- Returns a number of at least `least`.
function check.at_least(call, argument, value, least)
  local number = check.number(call, argument, value)
  if number < least then check.refuse(call, argument, "number >= " .. least, value) end
  return number
end

--- Returns a number above `limit`.
function check.above(call, argument, value, limit)
  local number = check.number(call, argument, value)
  if number <= limit then check.refuse(call, argument, "number above " .. limit, value) end
  return number
end

--- Checks that a value is a table but no object of the dialect.
function check.list(call, argument, value)
  if type(value) ~= "table" or spelt[value] then check.refuse(call, argument, "table", value) end
  return value
end

--- Returns a new table of exactly n numbers, each at least `least` if that is given.
function check.vector(call, argument, value, n, least)
  check.list(call, argument, value)
  if rawlen(value) ~= n then check.refuse(call, argument, "table of " .. n .. " numbers", value) end
  local out = {}
  for i = 1, n do
    local entry = argument .. "[" .. i .. "]"
    local number = rawget(value, i)
    out[i] = least and check.at_least(call, entry, number, least) or check.number(call, entry, number)
  end
  return out
end

--- Returns a new table: the value normalised to length 1.
function check.direction(call, argument, value)
  local out = check.vector(call, argument, value, 3)
  local most = max(abs(out[1]), abs(out[2]), abs(out[3]))
  if most == 0 then check.raise("gr.%s: %s: a direction other than {0, 0, 0} expected", call, argument) end
  local x, y, z = out[1] / most, out[2] / most, out[3] / most
  local length = (x * x + y * y + z * z) ^ 0.5
  return { x / length, y / length, z / length }
end

--- Returns a string; a number counts as one.
function check.text(call, argument, value)
  if type(value) ~= "string" and type(value) ~= "number" then check.refuse(call, argument, "string", value) end
  return tostring(value)
end

--- For options: returns one of the choices, or raises an error that lists them.
function check.choice(name, choices, value)
  for _, choice in pairs(choices) do
    if value == choice then return value end
  end
  check.raise("gr.options.%s: %s expected, got %s", name, choices.text, check.spelling(value))
end

return check
