-- Normal maps: red along u, green along v, blue outward, -1 .. 1 over the range of pixel values.
--
-- A bump's normal follows from the slopes of a height, but the map gives the slopes themselves. As floor has slope 0,
-- the slope of floor(a) x is floor(a): this makes a height with any slopes. Heights and directions are in world space.
local check = require "gr.check"
local glint = require "glint"
check.own_source()
local normal_map = {}

local tonumber, tostring = tonumber, tostring

local STEPS = 1 << 20 -- number of steps of a slope between whole numbers
local FLAT = 0.02 -- least outward component of a normal
local AXES = { x = { 1, 0, 0 }, y = { 0, 1, 0 }, z = { 0, 0, 1 } }

local function constant(a) return glint.floor(a * STEPS) / STEPS end

-- The direction of u at a point of a shape, in the shape's space; of any length.
local along_u = {
  sphere = function(p, node) return glint.vector(AXES.y):cross(p - node.center) end,
  cylinder = function(p, node) return glint.vector(AXES[node.axis]):cross(p) end,
  box = function(p, node)
    local z = glint.equal(p.x, node.min[1]) - glint.equal(p.x, node.max[1])
    local x = glint.select(z, 0, 1) * (1 - 2 * glint.equal(p.z, node.min[3]) * glint.less(node.min[2], p.y)
      * glint.less(p.y, node.max[2]))
    return glint.vector(x, 0, z)
  end,
}
along_u.cone = along_u.cylinder

-- A point inside a shape, in the shape's space.
local inside = {
  sphere = function(node) return node.center end,
  cylinder = function(node)
    local axis = AXES[node.axis]
    return { axis[1] / 2, axis[2] / 2, axis[3] / 2 }
  end,
  box = function(node)
    local low, high = node.min, node.max
    return { (low[1] + high[1]) / 2, (low[2] + high[2]) / 2, (low[3] + high[3]) / 2 }
  end,
}
inside.cone = inside.cylinder

--- Returns whether shapes of that kind have such directions.
function normal_map.lies_on(node) return along_u[node.kind] ~= nil end

local function numbers_of(map)
  local m = {}
  for word in tostring(map):gmatch "[-+%w.]+" do m[#m + 1] = tonumber(word) end
  return m
end

-- Transforms a direction to the world: its length is 1, or 0 if it was 0.
local function to_world(m, d)
  local w = glint.vector(m[1] * d.x + m[2] * d.y + m[3] * d.z, m[5] * d.x + m[6] * d.y + m[7] * d.z,
    m[9] * d.x + m[10] * d.y + m[11] * d.z)
  return w / glint.max(w:length(), 1e-300)
end

local function place_in_world(m, p)
  return glint.vector(m[1] * p[1] + m[2] * p[2] + m[3] * p[3] + m[4], m[5] * p[1] + m[6] * p[2] + m[7] * p[3] + m[8],
    m[9] * p[1] + m[10] * p[2] + m[11] * p[3] + m[12])
end

local function is_mirrored(m)
  return m[1] * (m[6] * m[11] - m[7] * m[10]) - m[2] * (m[5] * m[11] - m[7] * m[9])
    + m[3] * (m[5] * m[10] - m[6] * m[9]) < 0
end

--- Returns the bump of a normal map on a node's shape, placed by `map`.
function normal_map.bump(normals, node, map)
  local m, photo, picture = numbers_of(map), normals.photo, normals.picture
  local side, middle = is_mirrored(m) and -1 or 1, place_in_world(m, inside[node.kind](node))
  return glint.pattern(function(p, s)
    local c = photo(s.uv.u * picture.across, s.uv.v * picture.down, s.uv_footprint * picture.wide,
      s.uv_footprint * picture.high)
    local outward = glint.max(2 * c.b - 1, FLAT) / normals.strength
    local u = to_world(m, along_u[node.kind](p, node))
    local from_within = glint.less(s.n:dot(s.world - middle), 0) -- s.n is on the viewer's side; the shapes are convex
    local v = s.n:cross(u) * glint.select(from_within, -side, side)
    local function slope(code, d)
      local at = s.world
      local a = constant((1 - 2 * code) / outward)
      return a * (constant(d.x) * at.x + constant(d.y) * at.y + constant(d.z) * at.z)
    end
    return slope(c.r, u) + slope(c.g, v)
  end)
end

return normal_map
