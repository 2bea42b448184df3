-- Points from columns of text: CSV, TSV, or numbers with blanks between them.
--     for label, x, y, z, radius in points.frame "stars.csv":atoms() do ... end
-- The first line may name the columns: x, y, z, and where they are there radius and label, in any order and case;
-- others are there by name: frame:atoms("mass"). Without names the columns are x, y, z, radius; options.columns =
-- { "label", "x", ... } says otherwise. The separator is the first of tab, semicolon and comma in that line, else
-- blanks. A field may stand "in quotes", with "" for a quote. Lines that are empty or begin with # are passed over.
local frames, lines = require "glint.frames", require "glint.lines"

local points = {}

local DEFAULT_COLUMNS = { "x", "y", "z", "radius" }
local DEFAULT_LABEL = "point"

-- The field of a line that begins at `from`, and where the next one begins or nil.
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

-- Where the columns are, from their names.
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
    source:fail(("%d columns, as many as in the first line,"):format(count), line)
  end
  local function number(name) return source:number_of(list[place[name]], name) end
  local label = place.label and list[place.label] or DEFAULT_LABEL
  return label, number "x", number "y", number "z",
    place.radius and number "radius" or nil
end

-- A function that takes the wanted columns out of the fields of a line.
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

local function start(source, number, options)
  if number > 1 then return nil end
  local line = source:next_full()
  if not line then source:fail("a line of points", nil) end
  local separator = options.separator or line:match "[\t;,]" or " "
  local first = split(source, line, separator)
  local is_header = not options.columns and not tonumber(first[1])
  if is_header then
    for _, name in ipairs(first) do is_header = is_header and not tonumber(name) end
    if not is_header then source:fail("numbers, or the names of the columns", line) end
  end
  local names = is_header and first or options.columns or { table.unpack(DEFAULT_COLUMNS, 1, math.min(#first, 4)) }
  local place, count = places(source, names, line), #first
  if not is_header then source:back(line) end
  local fields = {}
  frames.name_columns(fields, names, function(wanted) return pick(fields.places, wanted) end)
  return fields, function()
    local text = source:next_full()
    if text then return read_point(source, fields, text, place, separator, count) end
  end
end

--- The points of a file, as a frame: frame:atoms() -> label, x, y, z, radius or nil.
---@param path string
---@param options? { columns: string[], separator: string }
function points.frame(path, options)
  return frames.pick(path, frames.each(path, function(source, number) return start(source, number, options or {}) end))
end

return points
