-- Points from columns of text, CSV, TSV, or numbers separated by spaces (.xyz, .pts), and clouds .ply and .pcd.
--     for label, x, y, z, radius in points.frame "stars.csv":atoms() do ... end
-- The first line may name the columns: x, y, z, and optionally radius and label, in any order and case. Others are
-- available by name: frame:atoms("mass"). Points with red, green and blue (or r, g, b; 0 .. 1, or 0 .. 255) have
-- frame.color, and spheres of glint.particles get their colour. Without names the columns are x, y, z, radius. In six
-- columns the last three are a colour, or a normal if all have length 1; seven are x, y, z, intensity and a colour;
-- options.columns = { "label", "x", ... } overrides this. The separator is the first of tab, semicolon and comma in
-- that line, otherwise spaces. A field may be "in quotes", with "" for a quote. Empty lines and lines that begin with #
-- are ignored.
local clouds, frames, lines = require "glint.clouds", require "glint.frames", require "glint.lines"

local points = {}

local DEFAULT_LABEL = "point"

-- Returns the field of a line that begins at `from`, and the start of the next one or nil.
local function next_field(source, line, separator, from)
  if not line:find("^%s*\"", from) then
    local at = line:find(separator, from, true)
    return line:sub(from, at and at - 1):match "^%s*(.-)%s*$", at and at + 1
  end
  local text, after = "", line:find("\"", from, true)
  repeat
    local first = after + 1
    after = line:find("\"", first, true)
    if not after then source:fail("a closing quote in this line", line) end
    local is_quote = line:byte(after + 1) == 34
    text = text .. line:sub(first, is_quote and after or after - 1)
    if is_quote then after = after + 1 end
  until not is_quote
  local at = line:match("^%s*()", after + 1)
  if at <= #line and line:sub(at, at) ~= separator then source:fail("a separator after a quoted field", line) end
  return text, at <= #line and at + 1 or nil
end

local function split(source, line, separator)
  local list = {}
  if separator == " " then
    for word in line:gmatch "%S+" do list[#list + 1] = word end
    return list
  end
  local from = 1
  while from do
    list[#list + 1], from = next_field(source, line, separator, from)
  end
  return list
end

-- Finds the columns from their names.
local function places(source, names, line)
  local place = {}
  for i, name in ipairs(names) do place[name:lower()] = i end
  for _, name in ipairs { "x", "y", "z" } do
    if not place[name] then source:fail(("a column named %s"):format(name), line) end
  end
  return place
end

local function read_point(source, fields, line, place, separator, count)
  local list = split(source, line, separator)
  fields.line = list
  if #list ~= count then
    source:fail(("%d columns (as in the first line)"):format(count), line)
  end
  local function number(name) return source:number_of(list[place[name]], name) end
  local label = place.label and list[place.label] or DEFAULT_LABEL
  return label, number "x", number "y", number "z",
    place.radius and number "radius" or nil
end

-- Returns a function that extracts the wanted columns from the fields of a line.
local function pick(columns, wanted)
  return function(list)
    local found = {}
    for i, name in ipairs(wanted) do
      local text = list[columns[name]]
      found[i] = text and lines.value(text)
    end
    return table.unpack(found, 1, #wanted)
  end
end

-- ---- Columns without names ----

local PROBED = 50 -- lines that are examined for the meaning of unnamed columns

-- Returns the first lines of a file as lists of numbers, without lines that contain other text.
local function probe(source, line, separator)
  local list, other = {}, source.path ~= "-" and lines.open(source.path)
  local text = other and other:next_full() or line
  while text and #list < PROBED do
    local row, found = split(source, text, separator), {}
    for i, word in ipairs(row) do found[i] = lines.number(word) end
    if #row > 2 then list[#list + 1] = found end
    text = other and other:next_full()
  end
  if other then other:close() end
  return list
end

-- Returns the value of full colour: 255, or 1. Colours 0 .. 1 that are slightly too bright have fractions.
local function most_of_color(most, is_whole)
  return most > (is_whole and 1 or 16) and 255 or 1
end

-- Returns the meaning of three columns from `first` on: "normal", or the value of full colour, 1 or 255; nil: neither.
local function kind_of(rows, first)
  local most, is_color, is_unit, is_turned, is_whole = 0, true, true, false, true
  for _, row in ipairs(rows) do
    local square = 0
    for i = first, first + 2 do
      local v = row[i] or -1
      most, square = math.max(most, v), square + v * v
      is_color = is_color and v >= 0 and v <= 255
      is_turned = is_turned or v < 0 or v > 0 and v < 1
      is_whole = is_whole and v == math.floor(v)
    end
    is_unit = is_unit and (square == 0 or math.abs(square - 1) < 0.01)
  end
  if is_unit and is_turned then return "normal" end
  return is_color and most_of_color(most, is_whole) or nil
end

local function is_constant(rows, column)
  for _, row in ipairs(rows) do
    if row[column] ~= rows[1][column] then return false end
  end
  return true
end

-- Returns the names for unnamed columns, and the value of full colour if they have one. Files .xyzn have normals, and
-- .xyzrgb colours; in others the numbers decide.
local function guess_columns(source, line, separator, count)
  local ending = lines.ending(source.path)
  local names, rows, most = { "x", "y", "z" }, probe(source, line, separator), nil
  local function add(...) table.move({ ... }, 1, select("#", ...), #names + 1, names) end
  local function add_three(first)
    local kind = ending == "xyzn" and "normal" or kind_of(rows, first)
    if ending == "xyzrgb" and kind == "normal" then kind = 1 end
    if kind == "normal" then add("nx", "ny", "nz") elseif kind and not most then
      add("red", "green", "blue")
      most = kind
    end
    return kind
  end
  if (count == 6 or count == 9) and kind_of(rows, 4) then
    add_three(4)
    if count == 9 then add_three(7) end
  elseif count == 7 and ending ~= "pts" and tonumber(kind_of(rows, 4)) and is_constant(rows, 7) then
    add_three(4)
    add "alpha"
  elseif count == 7 and tonumber(kind_of(rows, 5)) then
    add "intensity"
    add_three(5)
  elseif count > 3 then
    add(ending == "pts" and "intensity" or "radius")
  end
  return table.move(names, 1, math.min(#names, count), 1, {}), most
end

-- Returns the value of full colour for named colour columns.
local function most_of(source, line, separator, place)
  local rows, most, is_whole = probe(source, line, separator), 0, true
  for _, row in ipairs(rows) do
    for _, name in ipairs { "red", "green", "blue" } do
      local v = row[place[name]] or 0
      most, is_whole = math.max(most, v), is_whole and v == math.floor(v)
    end
  end
  return most_of_color(most, is_whole)
end

local LONG = { r = "red", g = "green", b = "blue" }

-- Returns the names in a first line, also in CloudCompare's form: //X Y Z R G B.
local function clean_names(first)
  local names = {}
  for i, name in ipairs(first) do
    name = i == 1 and name:gsub("^//%s*", "") or name
    names[i] = LONG[name:lower()] or name
  end
  return names
end

local function start(source, number, options)
  if number > 1 then return nil end
  local line = source:next()
  local fields, next_atom = clouds.start(source, line or "")
  if fields then return fields, next_atom end
  if line then source:back(line) end
  line = source:next_full()
  local expected = line and math.tointeger(tonumber(line:match "^%s*%d+%s*$")) -- the number of points, as in .pts
  if expected then line = source:next_full() end
  if not line then source:fail("a line of points", nil) end
  local separator = options.separator or line:match "[\t;,]" or " "
  local first = split(source, line, separator)
  local is_header = not options.columns and not lines.number(first[1])
  if is_header then
    for _, name in ipairs(first) do is_header = is_header and not lines.number(name) end
    if not is_header then source:fail("numbers, or the names of the columns", line) end
  end
  local names, most = is_header and clean_names(first) or options.columns, nil
  if not names then names, most = guess_columns(source, line, separator, #first) end
  local place, count = places(source, names, line), #first
  if not is_header then source:back(line) end
  fields = {}
  frames.name_columns(fields, names, function(wanted) return pick(fields.places, wanted) end)
  if place.red and place.green and place.blue then
    fields.color = { most = most or most_of(source, line, separator, place) }
    for _, name in ipairs { "red", "green", "blue" } do fields.places[name] = place[name] end
  end
  fields.done, fields.expected = 0, expected
  fields.layout = { label = place.label, x = place.x, y = place.y, z = place.z, radius = place.radius, fields = count,
    separator = separator }
  return fields, function()
    local text = source:next_full()
    if expected and fields.done == expected and text and text:find "^%s*%d+%s*$" then -- another scan follows
      expected, fields.done, text = math.tointeger(tonumber(text)), 0, source:next_full()
      fields.expected = expected
    end
    fields.done = fields.done + 1
    if expected and fields.done <= expected and not text then
      source:fail(("point %d of %d"):format(fields.done, expected), nil)
    end
    if text then return read_point(source, fields, text, place, separator, count) end
  end
end

--- Returns the points of a file, as a frame: frame:atoms() -> label, x, y, z, radius or nil.
---@param path string
---@param options? { columns: string[], separator: string }
function points.frame(path, options)
  return frames.pick(path, frames.each(path, function(source, number) return start(source, number, options or {}) end))
end

return points
