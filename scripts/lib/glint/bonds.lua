-- Bonds by distance, as cylinders: two atoms closer than the sum of their covalent radii and a tolerance are joined.
--     local set = particles.new { scale = 0.25 }
--     set:add_frame(xyz.frame "caffeine.xyz")
--     scene:add(bonds.new(set))       -- before set:spheres(), which takes the set's data away
-- Each half of a bond has the material of its atom. The atoms are sorted into cells as wide as the longest bond, so
-- each is compared only with its neighbours: the time grows linearly with the number of atoms. In a periodic box
-- (known for LAMMPS frames, otherwise given as box = { size = { 10, 10, 10 } }) bonds also cross the faces: each atom
-- is joined to the nearest image of the other by half a bond, which ends outside the box. box = false omits these
-- bonds.
local glint = require "glint"
local elements, boxes = require "glint.elements", require "glint.box"

local bonds = {}

local CLOSEST = 0.4 -- angstroms: closer atoms are one atom in alternate positions
local NEVER = 0 / 0 -- NaN: no distance is below this reach, as every comparison is false
local SIDE = 1 << 20 -- cells along each axis, at most
local IMAGES = 8 -- limit of the longest bond, in sides of the periodic box

-- Returns the options with their defaults; refuses unknown ones.
local function settings(options)
  local known = { radius = 0.15, tolerance = 0.45, distance = false }
  for name, value in pairs(options or {}) do
    if name == "box" then
      known.box = value and boxes.check(value, "bonds.box")
    elseif known[name] == nil then
      error(("bonds.%s: no such option; the options are radius, tolerance, distance, box"):format(name), 3)
    elseif type(value) ~= "number" or value ~= value or value <= (name == "tolerance" and -1 or 0) then
      error(("bonds.%s: a number above %d expected, got %s"):format(name, name == "tolerance" and -1 or 0, value), 3)
    else
      known[name] = value
    end
  end
  return known
end

-- Returns half the length of the longest bond of a kind.
local function reach_of(name, set)
  if name == "ghost" then return NEVER end
  if set.distance then return set.distance / 2 end
  local element = elements[elements.symbol(name) or ""]
  if not element then
    error(("bonds: %q is not an element and has no covalent radius; set distance, the longest bond"):format(name), 0)
  end
  return element.covalent + set.tolerance / 2
end

--- Calls found(i, j) once for every bond, with the numbers of two atoms, i > j.
---@param x number[]  x coordinates of the atoms; y and z likewise
---@param y number[]
---@param z number[]
---@param reach number[]  reach of each atom; a bond is at most as long as the sum of its atoms' reaches
---@param closest number  a bond is longer than this
---@param found function
function bonds.each(x, y, z, reach, closest, found)
  local low, width = { math.huge, math.huge, math.huge }, 0
  for i = 1, #x do
    low = { math.min(low[1], x[i]), math.min(low[2], y[i]), math.min(low[3], z[i]) }
    width = math.max(width, 2 * reach[i])
  end
  local first, after = {}, {} -- first: the first atom of each cell; after: the next atom of each atom
  for i = 1, #x do
    local xi, yi, zi, ri = x[i], y[i], z[i], reach[i]
    local cx, cy, cz = (xi - low[1]) // width | 0, (yi - low[2]) // width | 0, (zi - low[3]) // width | 0
    for u = cx - 1, cx + 1 do
      for v = cy - 1, cy + 1 do
        for w = cz - 1, cz + 1 do
          local j = first[(u * SIDE + v) * SIDE + w]
          while j do
            local dx, dy, dz, most = x[j] - xi, y[j] - yi, z[j] - zi, ri + reach[j]
            local square = dx * dx + dy * dy + dz * dz
            if square <= most * most and square > closest * closest then found(i, j) end
            j = after[j]
          end
        end
      end
    end
    local cell = (cx * SIDE + cy) * SIDE + cz
    first[cell], after[i] = i, first[cell]
  end
end

-- Returns the periodic box: from the options, otherwise from the frames; nil when nothing repeats.
local function box_of(set, options)
  local box = options.box
  if box == nil then
    if set.box == false then
      error("bonds: the frames of the set have different boxes; set box, or box = false for bonds inside only", 3)
    end
    box = set.box
  end
  if box and (box.periodic[1] or box.periodic[2] or box.periodic[3]) then return box end
end

-- As bonds.each in a periodic box: found(i, j, dx, dy, dz) has the vector from j to i, or between their nearest images.
local function each_across(box, x, y, z, reach, closest, found)
  local n, widest, at, u, v, w, own = #x, 0, {}, {}, {}, {}, {}
  for i = 1, n do
    u[i], v[i], w[i] = boxes.unscale(box, boxes.wrapped(box, boxes.scale(box, x[i], y[i], z[i])))
    own[i], at[i] = reach[i], i
    widest = math.max(widest, 2 * reach[i])
  end
  for i = 1, 3 do
    if box.periodic[i] and widest > IMAGES * box.size[i] then
      local message = "bonds: a periodic box of at least 1/%d of the longest bond expected, got %.6g for a bond of %.6g"
      error(message:format(IMAGES, box.size[i], widest), 3)
    end
  end
  boxes.images(box, n, u, v, w, widest, function(i, ux, vx, wx)
    local k = #at + 1
    at[k], u[k], v[k], w[k], own[k] = i, ux, vx, wx, reach[i]
  end)
  bonds.each(u, v, w, own, closest, function(i, j)
    if j <= n then found(at[i], j, u[i] - u[j], v[i] - v[j], w[i] - w[j]) end
  end)
end

--- Returns the bonds of a set of glint.particles as one group; nil if there are none.
---@param set table
---@param options? { radius: number, tolerance: number, distance: number, box: table|false }  radius of the cylinders
--- (default 0.15); tolerance in angstroms (default 0.45); distance, the longest bond of any two instead of covalent
--- radii; box, whose periodic faces bonds may cross, see glint.box (default: the box of the frames, if any)
---@return table? group
---@return integer count  number of bonds
function bonds.new(set, options)
  options = settings(options)
  local box = box_of(set, options)
  local x, y, z, place = set:places_of_all()
  local by_kind, reach = {}, {}
  for name, kind in pairs(set.kinds) do
    if kind.place and name == kind.name then by_kind[kind.place] = reach_of(name, options) end
  end
  for n, kind in pairs(set.kind_of_place) do by_kind[n] = reach_of(kind.name, options) end
  for i = 1, #x do reach[i] = by_kind[place[i]] end
  local parts, count = {}, 0
  local function half(i, mx, my, mz)
    parts[#parts + 1] = glint.cylinder { base = { x[i], y[i], z[i] }, top = { mx, my, mz }, radius = options.radius,
      capped = false, material = set.materials[place[i]] }
  end
  local function join(i, j, dx, dy, dz)
    half(i, x[i] - dx / 2, y[i] - dy / 2, z[i] - dz / 2)
    half(j, x[j] + dx / 2, y[j] + dy / 2, z[j] + dz / 2)
    count = count + 1
  end
  local closest = options.distance and 0 or CLOSEST
  if box then
    each_across(box, x, y, z, reach, closest, join)
  else
    bonds.each(x, y, z, reach, closest, function(i, j) join(i, j, x[i] - x[j], y[i] - y[j], z[i] - z[j]) end)
  end
  return count > 0 and glint.group(parts) or nil, count
end

return bonds
