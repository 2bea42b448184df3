-- Bonds by distance, as cylinders: two atoms closer than the sum of their covalent radii and a tolerance are joined.
--     local set = particles.new { scale = 0.25 }
--     set:add_frame(xyz.frame "caffeine.xyz")
--     scene:add((bonds.new(set)))
--     scene:add(set:spheres())
-- Each half of a bond has the material of its atom, also with color_by, or all have the option `material`. In a
-- periodic box (known for LAMMPS frames, otherwise given as box = { size = { 10, 10, 10 } }) bonds also cross the
-- faces: each atom is joined to the nearest image of the other by half a bond, which ends outside the box. box = false
-- omits these bonds. All bonds are one glint.cylinders, with 120 bytes a bond.
local glint = require "glint"
local elements, boxes = require "glint.elements", require "glint.box"

local bonds = {}

local CLOSEST = 0.4 -- angstroms: closer atoms are one atom in alternate positions
local NEVER = 0 / 0 -- NaN: no distance is below this reach, as every comparison is false

-- Returns the options with their defaults; refuses unknown ones.
local function settings(options)
  local known = { radius = 0.15, tolerance = 0.45, distance = false }
  for name, value in pairs(options or {}) do
    if name == "box" then
      known.box = value and boxes.check(value, "bonds.box")
    elseif name == "material" then
      known.material = value
    elseif known[name] == nil then
      error(("bonds.%s: no such option; the options are radius, tolerance, distance, box, material"):format(name), 3)
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

--- Returns the bonds of a set of glint.particles as one shape; nil if there are none.
---@param set table
---@param options? table  radius of the cylinders (default 0.15); tolerance in angstroms (default 0.45); distance, the
--- longest bond of any two instead of covalent radii; box, whose periodic faces bonds may cross, see glint.box (default
--- is the frames' box, if any; false: none); material of all bonds instead of the atoms' materials
---@return table? cylinders
---@return integer count  number of bonds
function bonds.new(set, options)
  options = settings(options)
  local box, all, by_place = box_of(set, options), set:arrays(), {}
  if all.count == 0 then return nil, 0 end
  for i = 1, #set.materials do by_place[i] = NEVER end
  for name, kind in pairs(set.kinds) do
    if kind.place and name == kind.name then by_place[kind.place] = reach_of(name, options) end
  end
  for place, kind in pairs(set.kind_of_place) do by_place[place] = reach_of(kind.name, options) end
  local given = { points = all.data, reach = glint.array(by_place):at(all.places), radius = options.radius,
    closest = options.distance and 0 or CLOSEST, index = all.index, materials = all.materials }
  if options.material then given.index, given.materials = nil, { options.material } end
  if box then
    given.low, given.size, given.tilt = box.low, box.size, { box.xy, box.xz, box.yz }
    given.periodic = {}
    for i = 1, 3 do given.periodic[i] = box.periodic[i] and 1 or 0 end
  end
  return glint._bonds(given)
end

return bonds
