-- The box of a simulation: { low, size, periodic, xy, xz, yz } as in glint.lammps; its sides are {size x, 0, 0},
-- {xy, size y, 0} and {xz, yz, size z}. By default a box is at 0, upright and periodic: { size = { 10, 10, 10 } }.
--     scene:add(box.edges(frame.box))                 -- drawn as thin cylinders; also for frame.cell of glint.xyz
--     scene:add(glint.axes { box = frame.box or frame.cell })     -- with numbers along three of its edges
local glint = require "glint"

local box = {}

local function three(value, name, kind)
  for i = 1, 3 do
    local v = type(value) == "table" and value[i]
    if type(v) ~= kind or (kind == "number" and (v ~= v or math.abs(v) == math.huge)) then
      error(("%s: three %s expected, got %s"):format(name, kind == "number" and "finite numbers" or "booleans",
        type(value) == "table" and ("%s at %d"):format(tostring(v), i) or tostring(value)), 0)
    end
  end
  return value
end

--- Returns a complete box from the given fields; raises if something is missing or wrong.
---@param given table
---@param name string  for messages
function box.check(given, name)
  if type(given) ~= "table" then error(("%s: a box expected, got %s"):format(name, tostring(given)), 0) end
  local size = three(given.size, name .. ".size", "number")
  local periodic = three(given.periodic or { true, true, true }, name .. ".periodic", "boolean")
  for i = 1, 3 do
    if size[i] < 0 or size[i] == 0 and periodic[i] then
      error(("%s.size: numbers > 0 expected, got %.14g"):format(name, size[i]), 0)
    end
  end
  local tilt = three({ given.xy or 0, given.xz or 0, given.yz or 0 }, name .. ".xy, xz, yz", "number")
  return {
    size = size, low = three(given.low or { 0, 0, 0 }, name .. ".low", "number"),
    periodic = periodic, xy = tilt[1], xz = tilt[2], yz = tilt[3],
  }
end

local CORNERS = {
  { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 1, 0 }, { 1, 0, 1 }, { 0, 1, 1 }, { 1, 1, 1 },
}

--- Converts a cell { origin, a, b, c } to a box; nil unless a lies along x and b in the plane of x and y. Sides of
--- length 0 do not repeat.
---@param cell table
---@param periodic boolean[]
function box.of_cell(cell, periodic)
  local a, b, c = cell.a, cell.b, cell.c
  if a[2] ~= 0 or a[3] ~= 0 or b[3] ~= 0 or a[1] < 0 or b[2] < 0 or c[3] < 0 then return nil end
  if a[1] == 0 and b[2] == 0 and c[3] == 0 then return nil end
  periodic = { periodic[1] and a[1] > 0, periodic[2] and b[2] > 0, periodic[3] and c[3] > 0 }
  return { low = cell.origin, size = { a[1], b[2], c[3] }, periodic = periodic, xy = b[1], xz = c[1], yz = c[2] }
end

-- Returns the corner and the three sides of a box, or of a cell { origin, a, b, c } with sides in any direction.
local function sides_of(given, name)
  if type(given) == "table" and given.a then
    local sides = {}
    for i, side in ipairs { "a", "b", "c" } do sides[i] = three(given[side], name .. "." .. side, "number") end
    return three(given.origin or { 0, 0, 0 }, name .. ".origin", "number"), sides
  end
  local b = box.check(given, name)
  return b.low, { { b.size[1], 0, 0 }, { b.xy, b.size[2], 0 }, { b.xz, b.yz, b.size[3] } }
end

--- Makes the edges of a box, or of a cell { origin, a, b, c } as in glint.xyz: twelve thin cylinders with balls at
--- their ends, as one group.
---@param given table
---@param options? { radius: number, material: table }  radius of the cylinders (default 1/250 of the box's diagonal);
--- their material (default dark grey)
---@return table group
function box.edges(given, options)
  options = options or {}
  for name in pairs(options) do
    if name ~= "radius" and name ~= "material" then
      error(("box.%s: no such option; the options are radius, material"):format(name), 2)
    end
  end
  local origin, sides = sides_of(given, "box")
  local function place(corner)
    local p = {}
    for i = 1, 3 do
      p[i] = origin[i] + corner[1] * sides[1][i] + corner[2] * sides[2][i] + corner[3] * sides[3][i]
    end
    return p
  end
  local far, square = place { 1, 1, 1 }, 0
  for i = 1, 3 do square = square + (far[i] - origin[i]) ^ 2 end
  local material = options.material or glint.material { diffuse = 0.12, name = "cell" }
  local radius, parts = options.radius or math.sqrt(square) / 250, {}
  for _, corner in ipairs(CORNERS) do
    parts[#parts + 1] = glint.sphere { center = place(corner), radius = radius, material = material }
    for i = 1, 3 do
      local side = sides[i]
      if corner[i] == 0 and (side[1] ~= 0 or side[2] ~= 0 or side[3] ~= 0) then
        local to = { table.unpack(corner) }
        to[i] = 1
        parts[#parts + 1] = glint.cylinder { base = place(corner), top = place(to), radius = radius, capped = false,
          material = material }
      end
    end
  end
  return glint.group(parts)
end

--- Returns the lowest and the highest corner of the upright box around a box or cell.
---@param given table
---@return number[][]
function box.corners(given)
  local low, sides = sides_of(given, "box")
  local first, last = { table.unpack(low) }, { table.unpack(low) }
  for _, side in ipairs(sides) do
    for i = 1, 3 do
      first[i], last[i] = first[i] + math.min(side[i], 0), last[i] + math.max(side[i], 0)
    end
  end
  return { first, last }
end

-- Returns the side lengths for fractional coordinates: 1 for a flat side, whose coordinates stay lengths.
local function sizes_of(b)
  local size = b.size
  local x, y, z = size[1], size[2], size[3]
  return x == 0 and 1 or x, y == 0 and 1 or y, z == 0 and 1 or z
end

--- Converts fractional coordinates in the box to a point: numbers or arrays, as in the next two functions.
function box.unscale(b, u, v, w)
  local low, a, c, d = b.low, sizes_of(b)
  return low[1] + u * a + v * b.xy + w * b.xz, low[2] + v * c + w * b.yz, low[3] + w * d
end

--- Converts a point to fractional coordinates, 0 .. 1 inside.
function box.scale(b, x, y, z)
  local low, a, c, d = b.low, sizes_of(b)
  local w = (z - low[3]) / d
  local v = (y - low[2] - w * b.yz) / c
  return (x - low[1] - v * b.xy - w * b.xz) / a, v, w
end

local function wrap(u)
  return u - (type(u) == "userdata" and u:floor() or math.floor(u))
end

--- Wraps fractional coordinates into the box along its periodic sides.
function box.wrapped(b, u, v, w)
  local periodic = b.periodic
  return periodic[1] and wrap(u) or u, periodic[2] and wrap(v) or v, periodic[3] and wrap(w) or w
end

return box
