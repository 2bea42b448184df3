-- Shared by the readers of atoms and points: files of one or several frames, read one atom at a time.
--     for frame in xyz.frames(path) do for label, x, y, z, radius in frame:atoms() do ... end end
-- A frame has number (from 1), count (nil unless the format states it first), and the data of its format. Atoms that a
-- script does not read are skipped, but still checked. Nothing is stored, so a file of any size takes the memory of a
-- line. Named columns come after the radius, as numbers if possible, otherwise as text:
--     for label, x, y, z, radius, charge, speed in frame:atoms("q", "speed") do ... end
-- frame.columns lists the names. The same as arrays (glint.array), read in bulk:
--     local all, charge, speed = frame:arrays("q", "speed")     -- all.positions, .labels, .kinds, .radii
-- A film provides the frames of a file in any order:
--     local film = xyz.film "melt.xyz"
--     set:add_frame(film:frame(n))
-- It remembers where each frame begins that it has passed, and continues from there.
local glint = require "glint"
local lines = require "glint.lines"

local frames = {}

-- Texts for a missing value in files, in small letters. NA is in capitals because Na is an element.
local MISSING = { nan = true, ["-nan"] = true, ["+nan"] = true, ["-1.#ind"] = true, ["1.#qnan"] = true, NA = true,
  ["n/a"] = true, null = true, [""] = true }

--- Returns NaN for a missing value.
function frames.value_of(value)
  return type(value) == "string" and (MISSING[value] or MISSING[value:lower()]) and 0 / 0 or value
end

frames.WORDS = 90 -- words of a line that a Lua pattern can capture

local frame = {}
frame.__index = frame

-- Begins to read the atoms and these columns.
function frame:begin(names)
  if self.is_taken then
    error(("%s: the atoms of frame %d have already been read"):format(self.source.path, self.number), 0)
  end
  for _, name in ipairs(names) do
    if not self.places[name] then
      error(("%s: a column among %s expected, got %q"):format(self.source.path, table.concat(self.columns, ", "),
        tostring(name)), 3)
    end
  end
  self.is_taken = true
  if #names > 0 then self.named = self.pick(names) end
end

--- Iterates once over a frame's atoms: label, x, y, z, radius (nil if the file has none), and the named columns.
---@param ... string  names among frame.columns
function frame:atoms(...)
  self:begin { ... }
  return function()
    if not self.is_done then return self:take(self.next_atom()) end
  end
end

-- Returns an atom, and remembers the end of the frame.
function frame:take(label, x, y, z, radius)
  if label == nil then
    self.is_done = true
    return nil
  end
  if not self.named then return label, x, y, z, radius end
  return label, x, y, z, radius, self.named(self.line)
end

-- Returns a reader for the rows of a frame, and the names of its columns in their order; nil: the frame has no rows.
local function reader_of(self, names, size, checks)
  local layout = self.layout
  if not layout then return nil end
  local kinds, columns, order = {}, {}, {}
  local function add(name, place, kind)
    if not place then return end
    local is_fixed = type(place) == "table" -- first and last byte
    local field, width = is_fixed and place[1] or place, is_fixed and place[2] - place[1] + 1 or nil
    columns[#columns + 1] = not kinds[field] and { field = field, width = width, kind = kind } or nil
    kinds[field] = kinds[field] or name
    return kinds[field] == name
  end
  local is_simple = add("label", layout.label, "word") ~= false
  for _, name in ipairs { "x", "y", "z" } do is_simple = add(name, layout[name], "number") and is_simple end
  is_simple = add("radius", layout.radius, size) ~= false and is_simple
  for i, place in ipairs(layout.words or {}) do is_simple = add("word" .. i, place, "word") and is_simple end
  for i, name in ipairs(names) do is_simple = add(i, self.places[name], "value") and is_simple end
  if not is_simple or #columns > 64 then return nil end -- a column is read twice: atom by atom
  table.sort(columns, function(a, b) return a.field < b.field end)
  for i, column in ipairs(columns) do order[i] = kinds[column.field] end
  return glint._row_reader { columns = columns, fields = layout.fields, separator = layout.separator,
    skips = layout.separator ~= nil, checks = checks }, order
end

-- Makes a reader read the words of the line just read as a number.
local function learn(self, reader, number)
  local line, layout = self.line, self.layout
  if layout.words_of then
    for _, word in ipairs(layout.words_of(line)) do reader:learn(word, number) end
  elseif layout.label and type(line) == "table" then
    reader:learn(line[layout.label], number)
  elseif layout.label then
    reader:learn(line:match("^%s*" .. ("%S+%s+"):rep(layout.label - 1) .. "(%S+)"), number)
  end
end

--- Reads all atoms in bulk. Calls atom(label, x, y, z, radius, ...) for the first atom, and for those whose line has
--- a new label or needs more care; it returns a number for the label, or nil. Between them, calls rows(n, arrays) for
--- n atoms: arrays.label has the numbers of their labels (nil if there is no column of labels: all have the last
--- number); arrays.x, y, z and radius (nil: none) the coordinates; arrays[i] the column names[i], NaN where a value is
--- missing. If rows returns false, these atoms and all after them are read one by one.
---@param names string[]
---@param size string  "size": radii > 0 only; "number": any
---@param atom function
---@param rows function?  nil: the rows are checked only
function frame:bulk(names, size, atom, rows)
  local reader, order = reader_of(self, names, size, not rows)
  local place = reader and self.layout.place
  local function take(n, ...)
    local arrays = {}
    for i, name in ipairs(rows and order or {}) do arrays[name] = select(i, ...) end
    if rows and place then arrays.x, arrays.y, arrays.z = place(arrays.x, arrays.y, arrays.z) end
    if rows and self.layout.is_diameter then arrays.radius = arrays.radius / 2 end
    return not rows or rows(n, arrays)
  end
  local function one(label, ...)
    if label == nil then return false end
    local number = atom(label, ...)
    if not number or not reader then return true end
    learn(self, reader, number)
    local most = self.expected and self.expected - self.done or math.maxinteger
    local count, left = self.source:rows(reader, most, take)
    self.done = self.done + count
    if left then reader = nil end
    return true
  end
  while not self.is_done and one(self:take(self.next_atom())) do end
end

--- Returns the atoms as arrays: a table with positions (rows of x, y, z), labels (a list of all different ones), kinds
--- (for each atom, the number of its label in this list), radii (nil if the file has none); and an array for each named
--- column, NaN where a value is missing.
---@param ... string  names among frame.columns
---@return table all
function frame:arrays(...)
  local names, all, numbers = { ... }, { labels = {} }, {}
  local keys, parts, single, count, last = { "label", "x", "y", "z", "radius" }, {}, {}, 0, nil
  for i in ipairs(names) do keys[5 + i] = i end
  for _, key in ipairs(keys) do parts[key], single[key] = {}, {} end
  local function pack() -- moves the atoms that were read one by one into arrays
    for key, list in pairs(single) do
      if #list > 0 then parts[key][#parts[key] + 1] = glint.array(list, key == "label" and "integer" or nil) end
      single[key] = {}
    end
    count = 0
  end
  self:begin(names)
  self:bulk(names, "number", function(label, x, y, z, radius, ...)
    count = count + 1
    for i, name in ipairs(names) do
      local value = frames.value_of((select(i, ...)))
      if type(value) ~= "number" then self:fail(("a number in the column %q"):format(name), tostring(value)) end
      single[i][count] = value
    end
    last = numbers[label] or #all.labels + 1
    numbers[label], all.labels[last] = last, label
    single.label[count], single.x[count], single.y[count], single.z[count], single.radius[count] = last, x, y, z, radius
    return last
  end, function(n, arrays)
    pack()
    arrays.label = arrays.label or glint.array(n, "integer") + last
    for key, list in pairs(parts) do list[#list + 1] = arrays[key] end
  end)
  pack()
  for _, key in ipairs(keys) do parts[key] = glint._join(parts[key], 1) end
  all.kinds = #all.labels > 0 and parts.label or glint.array(0, "integer")
  all.positions = glint.array { parts.x, parts.y, parts.z }
  all.radii = #parts.radius > 0 and parts.radius or nil
  return all, table.unpack(parts, 1, #names)
end

--- Raises an error at the file and line of the last atom.
function frame:fail(expected, got)
  self.source:fail(expected, got)
end

-- Returns the captures of a line, as numbers if possible.
local function values(...)
  local list = { ... }
  for i = 1, select("#", ...) do list[i] = list[i] and lines.value(list[i]) end
  return table.unpack(list, 1, select("#", ...))
end

--- For frames whose lines are words: returns pick(names), which returns a function from a line to these columns' words.
---@param places table<string, integer>  the number of the word of each name, from 1
function frames.words(places)
  return function(names)
    local last, parts, rank, order = 0, {}, {}, {}
    for _, name in ipairs(names) do last = math.max(last, places[name]) end
    for i = 1, last do parts[i] = "%S+" end
    for _, name in ipairs(names) do parts[places[name]] = "(%S+)" end
    for i = 1, last do
      if parts[i] == "(%S+)" then
        order[#order + 1] = i
        rank[i] = #order
      end
    end
    if #order > 30 then error(("at most 30 columns at once expected, got %d"):format(#order), 3) end
    if last > frames.WORDS then
      error(("columns among the first %d of a line expected, got number %d"):format(frames.WORDS, last), 3)
    end
    local pattern, in_order = "^%s*" .. table.concat(parts, "%s+"), true
    for i, name in ipairs(names) do in_order = in_order and rank[places[name]] == i end
    if in_order then return function(line) return values(line:match(pattern)) end end
    return function(line)
      local found, list = { line:match(pattern) }, {}
      for i, name in ipairs(names) do list[i] = found[rank[places[name]]] end
      return values(table.unpack(list, 1, #names))
    end
  end
end

--- Adds columns to a frame's fields: their names in order, their positions, and how to extract them from fields.line.
function frames.name_columns(fields, names, pick)
  fields.columns, fields.places = names, {}
  for i, name in ipairs(names) do fields.places[name] = fields.places[name] or i end
  fields.pick = pick or frames.words(fields.places)
end

-- Skips the rest of a frame.
local function read_over(last)
  if not last or last.is_done then return end
  last.named = nil
  last:bulk({}, "number", function() return 0 end)
  last.is_done = true
end

local function begin(source, start, number)
  local fields, next_atom = start(source, number)
  if not fields then return nil end
  fields.source, fields.number, fields.next_atom, fields.done = source, number, next_atom, fields.done or 0
  return setmetatable(fields, frame)
end

--- Iterates over the frames of a file.
---@param path string
---@param start function  (source, number) -> nil, or the next frame's fields and a function that gives an atom or nil
function frames.each(path, start)
  local source, last, number = lines.open(path), nil, 0
  return function()
    read_over(last)
    last = begin(source, start, number + 1)
    if not last then
      source:close()
      return nil
    end
    number = number + 1
    return last
  end
end

local film = {}
film.__index = film

--- Returns the frames of a file in any order. film:frame(n) ends the reading of the previous frame.
---@param path string
---@param start function  as in frames.each
function frames.film(path, start)
  local source = lines.open(path)
  return setmetatable({ path = path, source = source, start = start, places = { { 0, 0 } } }, film)
end

-- Begins frame `number`, whose position is known; nil at the end of the file.
local function film_begin(self, number)
  local source, place = self.source, self.places[number]
  local at = source:tell()
  if at ~= place[1] or not source.file then source:go(place[1], place[2]) end
  self.last = begin(source, self.start, number)
  return self.last
end

-- Finds the position of the frame after the last known one. False: there is none.
local function film_step(self)
  local known = #self.places
  if self.count and known > self.count then return false end
  if not self.last or self.last.number ~= known then
    if not film_begin(self, known) then
      self.count = known - 1
      return false
    end
  end
  read_over(self.last)
  self.places[known + 1] = { self.source:tell() }
  self.last = nil
  return true
end

--- Returns frame `number`, from 1. Its atoms are valid until the next call. Raises if the file has fewer frames.
---@param number integer
function film:frame(number)
  local whole = math.tointeger(number)
  if not whole or whole < 1 then
    error(("film.frame: a whole number >= 1 expected, got %s"):format(tostring(number)), 2)
  end
  while #self.places < whole and film_step(self) do end
  local found = #self.places >= whole and film_begin(self, whole)
  if found then return found end
  self.count = math.min(self.count or math.huge, #self.places - 1)
  error(("%s: frame %d expected, got a file of %d"):format(self.path, whole, self.count), 2)
end

--- Returns how many frames the file has; reads it to its end, once.
---@return integer
function film:length()
  while film_step(self) do end
  self.last = nil
  return self.count
end

--- Closes the file.
function film:close()
  self.source:close()
end

--- Returns one frame of a reader's frames(). Raises if there are fewer.
---@param path string
---@param each function
---@param number integer  from 1. Default 1
function frames.pick(path, each, number)
  number = number or 1
  local last = 0
  for found in each do
    last = found.number
    if last == number then return found end
  end
  error(("%s: frame %d expected, got a file of %d"):format(path, number, last), 0)
end

return frames
