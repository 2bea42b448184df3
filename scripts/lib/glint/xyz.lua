-- XYZ: a number of atoms, a comment line, then a line per atom: element (or its number), x, y, z. One or more frames.
--     for frame in xyz.frames "water.xyz" do
--       print(frame.comment, frame.count)
--       for label, x, y, z in frame:atoms() do ... end
--     end
-- Extended XYZ describes the columns and the periodic cell in its comment:
--     Lattice="10 0 0 0 10 0 0 0 10" Properties=species:S:1:pos:R:3:vel:R:3:charge:R:1 pbc="T T F"
-- frame.keys has the values of all keys as texts, by their names in small letters. frame.columns are then
-- species, x, y, z, vel_x, vel_y, vel_z, charge (name_1 ... for a property of 2 or of more than 3 numbers); a column
-- radius or diameter gives the radius of each atom;
-- frame.cell = { origin, a, b, c } has the cell's corner and sides; frame.box is the same as a box (glint.box),
-- if a lies along x and b in the plane of x and y. Without Properties the columns after the fourth are "5", "6"
-- and so on.
local boxes, frames = require "glint.box", require "glint.frames"

local xyz = {}

local AXES = { "_x", "_y", "_z" }

local function read_atom(source, frame)
  local line = source:next()
  if not line then source:fail(("atom %d of %d"):format(frame.done, frame.count), nil) end
  frame.line = line
  local label, x, y, z = line:match(frame.pattern)
  if frame.swaps and label then x, y, z, label = label, x, y, z end
  if frame.is_type and label and label:find "^%d+$" then label = "type" .. label end
  if not label then source:fail(("atom %d of %d (%s)"):format(frame.done, frame.count, frame.form), line) end
  local size = frame.size_pattern and source:number_of(line:match(frame.size_pattern), frame.size_name)
  if size and frame.size_name:lower() == "diameter" then size = size / 2 end
  return label, source:number_of(x, "x"), source:number_of(y, "y"), source:number_of(z, "z"), size
end

-- Returns the text between quotation marks or brackets at `from`, and the position after them. nil: they do not end.
local function enclosed(text, from)
  local mark = text:sub(from, from)
  if mark == '"' or mark == "'" then
    local at = from + 1
    while at <= #text do
      local c = text:sub(at, at)
      if c == mark then return text:sub(from + 1, at - 1), at + 1 end
      at = at + (c == "\\" and 2 or 1)
    end
    return nil
  end
  local inside = text:match(mark == "{" and "^%b{}" or "^%b[]", from)
  if inside then return inside:gsub("[][{},]", " "), from + #inside end
end

-- Returns the keys of a comment, in small letters, and their values, as texts: key=word, key="words" or 'words', and
-- arrays [a, b] and {a b}. Quoted text is one value, whatever it contains.
local function read_keys(comment)
  local keys, at = {}, 1
  while at <= #comment do
    local name, after = comment:match("^([^%s=\"'{}%[%]]+)%s*=%s*()", at)
    local value
    if name then
      value, at = enclosed(comment, after)
      if not value then value, at = comment:match("^(%S*)()", after) end
      keys[name:lower()] = keys[name:lower()] or value
    else
      local _, beyond = enclosed(comment, at)
      at = beyond or comment:match("^%s+()", at) or comment:match("^%S+()", at)
    end
  end
  return keys
end

-- Returns the names of the columns, from name:type:count:name:type:count ...
local function property_names(source, text, comment)
  local names, is_good = {}, true
  for name, kind, count in (text .. ":"):gmatch "([^:]+):([^:]+):(%d+):" do
    count = tonumber(count)
    is_good = is_good and kind:find "^[SRIL]$" and count > 0 and count < 1000 and #names < 1000
    for i = 1, is_good and count or 0 do
      local ending = count == 3 and AXES[i] or "_" .. i
      names[#names + 1] = name:lower() == "pos" and AXES[i] and AXES[i]:sub(2) or count == 1 and name or name .. ending
    end
  end
  if not is_good or #names == 0 then source:fail("Properties=name:type:count:...", comment) end
  return names
end

-- Returns the number of a column, by its name in small letters.
local function column_of(names, wanted)
  for i, name in ipairs(names) do
    if name:lower() == wanted then return i end
  end
end

-- Chooses how a line is read: one pattern for the four columns that every frame has.
local function find_columns(source, fields)
  local text = fields.keys.properties
  local names, place = text and property_names(source, text, fields.comment) or { "element", "x", "y", "z" }, {}
  for i, name in ipairs(names) do place[name] = place[name] or i end
  local label = place.species or place.element or place.Z or place.type
  if not (label and place.x and place.y == place.x + 1 and place.z == place.x + 2) then
    source:fail("species and pos among the Properties", fields.comment)
  end
  if math.max(label, place.z) > frames.WORDS then
    source:fail(("species and pos among the first %d columns"):format(frames.WORDS), fields.comment)
  end
  local parts = {}
  for i = 1, math.max(label, place.z) do parts[i] = "%S+" end
  for _, i in ipairs { label, place.x, place.y, place.z } do parts[i] = "(%S+)" end
  fields.pattern, fields.swaps = "^%s*" .. table.concat(parts, "%s+"), label > place.x
  fields.is_type = label == place.type
  fields.form = text and table.concat(names, " ") or "element x y z"
  local size = column_of(names, "radius") or column_of(names, "diameter")
  if size and size > frames.WORDS then
    source:fail(("%s among the first %d columns"):format(names[size], frames.WORDS), fields.comment)
  end
  fields.size_name = names[size]
  fields.layout = { label = label, x = place.x, y = place.y, z = place.z, radius = size,
    is_diameter = size and names[size]:lower() == "diameter" }
  fields.size_pattern = size and "^%s*" .. ("%S+%s+"):rep(size - 1) .. "(%S+)"
  frames.name_columns(fields, names)
  if not text then
    setmetatable(fields.places, { __index = function(_, name)
      local number = type(name) == "string" and name:find "^[1-9]%d?$" and math.tointeger(tonumber(name))
      return number or nil
    end })
  end
end

local function numbers_of(source, text, count, what, comment)
  local list = {}
  for word in text:gmatch "[^%s,;{}%[%]]+" do list[#list + 1] = source:number_of(word, what) end
  if #list ~= count then source:fail(("%d numbers for %s"):format(count, what), comment) end
  return list
end

local TRUTHS = { t = true, ["true"] = true, ["1"] = true, f = false, ["false"] = false, ["0"] = false }

-- Returns the sides along which a frame repeats: pbc="T T F" or TTF, or one word for all. Default: all.
local function periodic_of(source, fields)
  local list, text = {}, (fields.keys.pbc or "T"):lower()
  text = text:gsub("^%s*([tf01])([tf01])([tf01])%s*$", "%1 %2 %3")
  for word in text:gmatch "[^%s,;{}%[%]]+" do
    if TRUTHS[word] == nil then source:fail("T or F of pbc", word) end
    list[#list + 1] = TRUTHS[word]
  end
  if #list == 1 then return { list[1], list[1], list[1] } end
  if #list ~= 3 then source:fail("three words T or F of pbc", fields.comment) end
  return list
end

-- Returns the cell of a frame, and its box if the sides are aligned like a box.
local function find_cell(source, fields)
  local text = fields.keys.lattice
  if not text then return end
  local v = numbers_of(source, text, 9, "Lattice", fields.comment)
  local origin = numbers_of(source, fields.keys.origin or "0 0 0", 3, "Origin", fields.comment)
  local periodic = periodic_of(source, fields)
  fields.cell = { origin = origin, a = { v[1], v[2], v[3] }, b = { v[4], v[5], v[6] }, c = { v[7], v[8], v[9] } }
  fields.box = boxes.of_cell(fields.cell, periodic)
end

-- Begins a frame. Blank lines may precede a count, but appear nowhere else.
local function start(source, number)
  local line = source:next()
  while line and not line:find "%S" do line = source:next() end
  if not line and number > 1 then return nil end
  local before = number > 1 and (" of frame %d (the frame before it is complete)"):format(number) or ""
  if not line or not line:find "^%s*%d+%s*$" then source:fail("the number of atoms" .. before, line) end
  local count = source:whole(line, "the number of atoms", 0)
  local comment = source:next()
  if not comment then source:fail("a line of comment", nil) end
  local fields = { count = count, expected = count, done = 0, comment = comment, keys = read_keys(comment) }
  find_columns(source, fields)
  find_cell(source, fields)
  return fields, function()
    if fields.done == count then return nil end
    fields.done = fields.done + 1
    return read_atom(source, fields)
  end
end

--- Iterates over the frames of a file: number, count, comment, and frame:atoms() -> label, x, y, z, radius or nil
--- (angstroms).
---@param path string
function xyz.frames(path)
  return frames.each(path, start)
end

--- Returns one frame, from 1. Default 1.
---@param path string
---@param number? integer
function xyz.frame(path, number)
  return frames.pick(path, xyz.frames(path), number)
end

--- Returns the frames of a file in any order: film:frame(n), film:length().
---@param path string
function xyz.film(path)
  return frames.film(path, start)
end

return xyz
