-- LAMMPS dump files (text, `dump custom` and `dump atom`): any number of frames, orthogonal and triclinic boxes.
--     for frame in lammps.frames("melt.dump", { wrap = true }) do
--       print(frame.step, frame.count, frame.box.size[1])
--       for label, x, y, z, radius in frame:atoms() do ... end
--     end
-- Columns are found by their names, in any order: x y z or xu yu zu (lengths), xs ys zs or xsu ysu zsu (fractions
-- of the box); `radius` or `diameter` if present. The label is the column `element` or `typelabel`, a word in
-- `type`, `types[type]` of the options, "type1", "type2" ..., or "point" if no column has kinds. All columns are
-- available by name: frame:atoms("vx", "c_pe"). The u columns may lie outside a periodic box; wrap = true wraps
-- them.
local frames, boxes = require "glint.frames", require "glint.box"

local lammps = {}

local POSITIONS = {
  { "x", "y", "z" }, { "xs", "ys", "zs", scaled = true }, { "xu", "yu", "zu" }, { "xsu", "ysu", "zsu", scaled = true },
}

local function words(text)
  local list = {}
  for word in text:gmatch "%S+" do list[#list + 1] = word end
  return list
end

local function bounds(source, what, count)
  local line = source:next()
  local list = words(line or "")
  if #list ~= count then source:fail(("%d numbers (%s of the box)"):format(count, what), line) end
  for i = 1, count do list[i] = source:number_of(list[i], what .. " of the box") end
  if list[1] > list[2] then source:fail(("%s of the box, the lower one first"):format(what), line) end
  return list
end

-- Reads a cell with sides in any direction (abc origin), and its box if the sides are aligned like a box.
local function read_cell(source, kinds, frame)
  local rows, origin = {}, {}
  for i, side in ipairs { "a", "b", "c" } do
    local line = source:next()
    local list = words(line or "")
    if #list ~= 4 then source:fail(("4 numbers (%s and the origin of the box)"):format(side), line) end
    for k = 1, 4 do list[k] = source:number_of(list[k], side .. " and the origin of the box") end
    rows[i], origin[i] = { list[1], list[2], list[3] }, list[4]
  end
  frame.cell = { origin = origin, a = rows[1], b = rows[2], c = rows[3] }
  frame.box = boxes.of_cell(frame.cell, kinds)
end

-- Reads the box from the three lines of its bounds. For a tilted box LAMMPS writes its bounding box. Boundaries without
-- kinds, as in old versions, are periodic, which is LAMMPS's default.
local function read_box(source, header, frame)
  local names = words(header)
  local tilted, general = names[1] == "xy", names[1] == "abc"
  local skipped = tilted and 3 or general and 2 or 0
  local kinds = { true, true, true }
  if #names ~= skipped and #names ~= skipped + 3 then
    source:fail("ITEM: BOX BOUNDS with three boundary kinds such as pp pp pp, after xy xz yz when tilted", header)
  end
  for i = 1, 3 do kinds[i] = #names == skipped or names[skipped + i] == "pp" end
  if general then return read_cell(source, kinds, frame) end
  local n = tilted and 3 or 2
  local x, y, z = bounds(source, "x bounds", n), bounds(source, "y bounds", n), bounds(source, "z bounds", n)
  local xy, xz, yz = x[3] or 0, y[3] or 0, z[3] or 0
  local low = { x[1] - math.min(0, xy, xz, xy + xz), y[1] - math.min(0, yz), z[1] }
  local high = { x[2] - math.max(0, xy, xz, xy + xz), y[2] - math.max(0, yz), z[2] }
  local box = { low = low, high = high, size = {}, periodic = kinds, xy = xy, xz = xz, yz = yz }
  for i = 1, 3 do
    box.size[i] = high[i] - low[i]
    kinds[i] = kinds[i] and box.size[i] > 0
    if box.size[i] < 0 then source:fail("a box larger than its tilt", header) end
  end
  frame.box = box
end

-- Returns a function from the coordinates in a file to positions, numbers or arrays; nil: they are positions.
local function find_place(source, frame, scaled, options)
  local box, cell = frame.box, frame.cell
  if scaled and not box and not options.wrap then
    return function(u, v, w)
      local found = { table.unpack(cell.origin) }
      for i, side in ipairs { cell.a, cell.b, cell.c } do
        for k = 1, 3 do found[k] = found[k] + ({ u, v, w })[i] * side[k] end
      end
      return table.unpack(found)
    end
  end
  if not scaled and not options.wrap then return nil end
  return function(x, y, z)
    if not box then
      source:fail("a box for scaled coordinates, with a along x and b in the xy plane", frame.line)
    end
    if not scaled then x, y, z = boxes.scale(box, x, y, z) end
    if options.wrap then x, y, z = boxes.wrapped(box, x, y, z) end
    return boxes.unscale(box, x, y, z)
  end
end

-- Finds the meaning of the columns. One pattern captures the columns needed, at most five, of a line: columns.x and so
-- on are the numbers of the captures.
local function find_columns(source, header, frame, options)
  local names, place, used = words(header), {}, {}
  for i, name in ipairs(names) do place[name] = i end
  local columns, position = { count = #names, captures = {} }, nil
  if #names > frames.WORDS then source:fail(("at most %d columns"):format(frames.WORDS), header) end
  for _, set in ipairs(POSITIONS) do
    if not position and place[set[1]] and place[set[2]] and place[set[3]] then position = set end
  end
  if not position then source:fail("columns x y z, xs ys zs, xu yu zu or xsu ysu zsu", header) end
  local label = place.element or place.typelabel or place.type
  local size = place.radius or place.diameter
  frame.layout = { label = label, fields = #names, radius = size, is_diameter = size and not place.radius,
    x = place[position[1]], y = place[position[2]], z = place[position[3]],
    place = find_place(source, frame, position.scaled, options) }
  used[place[position[1]]], used[place[position[2]]], used[place[position[3]]] = "x", "y", "z"
  if label then used[label] = label == place.type and "type" or "label" end
  if size then used[size] = place.radius and "radius" or "diameter" end
  local parts, rank = {}, 0
  for i = 1, #names do
    parts[i] = used[i] and "(%S+)" or "%S+"
    if used[i] then
      rank = rank + 1
      columns[used[i]] = rank
    end
  end
  columns.pattern = "^%s*" .. table.concat(parts, "%s+") .. "%s*$"
  return columns
end

local function label_of(source, columns, list, options)
  if columns.label then return list[columns.label] end
  if not columns.type then return "point" end
  if list[columns.type]:find "^%a" then return list[columns.type] end -- type labels from dump_modify
  local number = source:whole(list[columns.type], "the type of an atom", 1)
  if not options.types then return "type" .. number end
  return options.types[number] or source:fail(("a type among the %d of the option types"):format(#options.types),
    list[columns.type])
end

local function read_atom(source, frame, columns, options)
  local line = source:next()
  if not line then source:fail(("atom %d of %d"):format(frame.done, frame.count), nil) end
  frame.line = line
  local list = columns.captures
  list[1], list[2], list[3], list[4], list[5] = line:match(columns.pattern)
  if not list[1] then
    source:fail(("atom %d of %d, with %d columns"):format(frame.done, frame.count, columns.count), line)
  end
  local x, y = source:number_of(list[columns.x], "x"), source:number_of(list[columns.y], "y")
  local z, radius = source:number_of(list[columns.z], "z"), nil
  if frame.layout.place then x, y, z = frame.layout.place(x, y, z) end
  if columns.radius then
    radius = source:number_of(list[columns.radius], "radius")
  elseif columns.diameter then
    radius = source:number_of(list[columns.diameter], "diameter") / 2
  end
  return label_of(source, columns, list, options), x, y, z, radius
end

-- Reads the lines below each ITEM line, up to the atoms.
local function read_header(source, line, frame)
  while true do
    local item = line and line:match "^ITEM:%s*(.-)%s*$"
    if not item then source:fail("a line ITEM: ...", line) end
    if item == "TIMESTEP" then
      frame.step = source:whole(source:next(), "the time step", 0)
    elseif item == "NUMBER OF ATOMS" then
      frame.count = source:whole(source:next(), "the number of atoms", 0)
    elseif item:find "^BOX BOUNDS" then
      read_box(source, item:sub(#"BOX BOUNDS" + 1), frame)
    elseif item == "UNITS" or item == "TIME" then
      frame[item:lower()] = source:next()
    elseif item:find "^ATOMS" then
      return item:sub(#"ATOMS" + 1)
    elseif item:find "^ENTRIES" then
      source:fail("ITEM: ATOMS of dump atom or dump custom", line)
    else
      repeat line = source:next() until not line or line:find "^ITEM:" -- skips unused items
      if line then source:back(line) end
    end
    line = source:next()
  end
end

local function start(source, number, options)
  local line = source:next()
  while line and not line:find "%S" do line = source:next() end
  if not line and number > 1 then return nil end
  if not line or not line:find "^ITEM:" then
    source:fail(number > 1 and ("ITEM: ... of frame %d (the frame before it is complete)"):format(number) or
      "ITEM: TIMESTEP", line)
  end
  local frame = { done = 0 }
  local header = read_header(source, line, frame)
  for _, name in ipairs { "step", "count", frame.cell and "cell" or "box" } do
    if not frame[name] then source:fail(("the %s of the frame above ITEM: ATOMS"):format(name), "ITEM: ATOMS") end
  end
  local columns = find_columns(source, header, frame, options)
  frame.expected = frame.count
  frames.name_columns(frame, words(header))
  return frame, function()
    if frame.done == frame.count then return nil end
    frame.done = frame.done + 1
    return read_atom(source, frame, columns, options)
  end
end

--- Iterates over the frames of a file: number, step, count, box { low, high, size, periodic, xy, xz, yz } or, for abc
--- origin, cell { origin, a, b, c }, and frame:atoms() -> label, x, y, z, radius or nil.
---@param path string
---@param options? { types: string[], wrap: boolean }
function lammps.frames(path, options)
  return frames.each(path, function(source, number) return start(source, number, options or {}) end)
end

--- Returns one frame, from 1. Default 1.
---@param path string
---@param number? integer
---@param options? { types: string[], wrap: boolean }
function lammps.frame(path, number, options)
  return frames.pick(path, lammps.frames(path, options), number)
end

--- Returns the frames of a file in any order: film:frame(n), film:length().
---@param path string
---@param options? { types: string[], wrap: boolean }
function lammps.film(path, options)
  return frames.film(path, function(source, number) return start(source, number, options or {}) end)
end

return lammps
