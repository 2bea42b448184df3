-- The axes of glint.sweep: a list of { object, "field", { values } }, of which the first changes fastest. Reads them,
-- sets the scene to a frame, and names axes and values for files and labels.
local the = ...
local M = {}
local format, gsub = string.format, string.gsub
local concat, sort = table.concat, table.sort
local ipairs, next, rawget, rawlen, tostring, type = ipairs, next, rawget, rawlen, tostring, type

local AXES_MAX <const>, FRAMES_MAX <const> = 16, 100000000

-- ---- Reading ----

-- Returns a copy of a list of axes, which the script cannot change later.
function M.copy_axes(axes)
  local copy = {}
  for i = 1, rawlen(axes) do
    local axis = rawget(axes, i)
    local from, values = rawget(axis, 3), {}
    for v = 1, rawlen(from) do values[v] = rawget(from, v) end
    copy[i] = { rawget(axis, 1), rawget(axis, 2), values }
  end
  return copy
end

-- Checks one axis. Returns how many values it has.
local function check_axis(axis, path)
  if type(axis) ~= "table" or the.check_list(axis, path) ~= 3 then
    the.refuse(axis, path, '{ object, "field", { values } }')
  end
  local object, field, values = rawget(axis, 1), rawget(axis, 2), rawget(axis, 3)
  if type(object) ~= "table" and not the.is_object(object) then the.refuse(object, path .. "[1]", "object") end
  if type(field) ~= "string" then the.refuse(field, path .. "[2]", "name of a field") end
  local _ = object[field] -- raises if there is no such field
  if type(values) ~= "table" then the.refuse(values, path .. "[3]", "list of values") end
  local count = the.check_list(values, path .. "[3]")
  if count == 0 then the.raise(path .. "[3]: at least one value expected, got an empty list") end
  return count
end

-- Reads sweep.over. Returns a copy of the axes and the number of frames.
function M.read_axes(over)
  if type(over) ~= "table" then the.refuse(over, "sweep.over", "list of axes") end
  local count, frames = the.check_list(over, "sweep.over"), 1
  if count == 0 or count > AXES_MAX then
    the.raise(format("sweep.over: 1 .. %d axes expected, got %d", AXES_MAX, count))
  end
  for i = 1, count do
    frames = frames * check_axis(rawget(over, i), format("sweep.over[%d]", i))
    if frames > FRAMES_MAX then the.raise(format("sweep.over: at most %d frames expected", FRAMES_MAX)) end
  end
  return M.copy_axes(over), frames
end

-- ---- Names and values ----

-- Returns the name of an axis: its field; with the object before it if another axis has the same field.
local function name_of(axes, i)
  local object, field, others = axes[i][1], axes[i][2], 0
  for j, axis in ipairs(axes) do others = others + (j ~= i and axis[2] == field and 1 or 0) end
  if others == 0 then return field end
  local name = the.name_of_object(object)
  return name and name .. "." .. field or format("%s %d", field, i)
end

-- Returns "object.field" for an axis, or only its name if the object has none.
function M.title_of_axis(axes, i)
  local name = the.name_of_object(axes[i][1])
  return name and name .. "." .. axes[i][2] or name_of(axes, i)
end

-- Returns the text of a table, with or without names: a vector, a colour, the fields of indirect.
local function spell_table(value)
  local parts, names = {}, {}
  for i = 1, rawlen(value) do parts[i] = tostring(rawget(value, i)) end
  for name in next, value do
    if type(name) == "string" then names[#names + 1] = name end
  end
  sort(names)
  for _, name in ipairs(names) do parts[#parts + 1] = name .. " = " .. tostring(rawget(value, name)) end
  return "{" .. concat(parts, ", ") .. "}"
end

-- Returns the text of value number `i` of an axis, on one line.
local function spell(value, i)
  local text
  if type(value) == "table" then
    text = spell_table(value)
  elseif the.is_object(value) then
    text = format("number %d", i)
  else
    text = the.spell_number(value) or tostring(value)
  end
  return (gsub(text, "\n", " "))
end

-- Returns an iterator over the axes with their numbers, and the values at frame n with their numbers.
local function each_value(axes, n)
  local i, rest = 0, n - 1
  return function()
    i = i + 1
    local axis = axes[i]
    if not axis then return nil end
    local at = rest % #axis[3] + 1
    rest = rest // #axis[3]
    return i, axis, axis[3][at], at
  end
end

-- Returns "name=value" lines for frame n, one per axis.
function M.place_of_frame(axes, n)
  local lines = {}
  for i, _, value, at in each_value(axes, n) do lines[i] = name_of(axes, i) .. "=" .. spell(value, at) end
  return concat(lines, "\n")
end

-- Returns the lines "axis=" and "value=" for all axes and values: the names that a sheet can give a text.
function M.list_values(axes)
  local lines = {}
  for a, axis in ipairs(axes) do
    lines[#lines + 1] = name_of(axes, a) .. "="
    for i, value in ipairs(axis[3]) do lines[#lines + 1] = spell(value, i) .. "=" end
  end
  return concat(lines, "\n")
end

-- Returns the table name -> value for frame n.
function M.values_of_frame(axes, n)
  local values = {}
  for i, _, value in each_value(axes, n) do values[name_of(axes, i)] = value end
  return values
end

-- ---- The scene at a frame ----

-- Sets the fields to their values at frame n. Returns the frame's place, and the values that the fields had before the
-- first frame.
function M.set_axes(axes, saved, n)
  if not saved then
    saved = {}
    for i, axis in ipairs(axes) do saved[i] = axis[1][axis[2]] end
  end
  for _, axis, value in each_value(axes, n) do axis[1][axis[2]] = value end
  return M.place_of_frame(axes, n), saved
end

-- Restores the values that the fields had before the first frame.
function M.restore_axes(axes, saved)
  for i, axis in ipairs(axes) do
    if saved[i] ~= nil then axis[1][axis[2]] = saved[i] end
  end
end

return M
