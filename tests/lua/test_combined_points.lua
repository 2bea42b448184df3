-- Random nested CSG shapes: a ray from outside reaches no point inside before its hit, and vice versa. The test decides
-- which points are inside. In half of the shapes all coordinates are on a lattice, so that faces coincide and rays run
-- along them. Points with both inside and outside neighbours decide nothing, and may count as hits.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"
local CASES, RAYS, PLACES, NEAR = tonumber(os.getenv "CASES" or 60), 40, 40, 1e-6
local tests, lattice = {}, false

local function random(a, b) return a + (b - a) * math.random() end
local function number(a, b) return lattice and math.random(math.ceil(2 * a), math.floor(2 * b)) / 2 or random(a, b) end
local function vector(size) return { number(-size, size), number(-size, size), number(-size, size) } end
local function axis()
  local along = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 0, -1, 0 } }
  return lattice and along[math.random(4)] or { random(-1, 1), random(-1, 1), random(0.2, 1) }
end
local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
local function step(a, t, b) return { a[1] + t * b[1], a[2] + t * b[2], a[3] + t * b[3] } end

-- ---- Parts: each with a function that tests whether a point is inside ----

local function corners()
  local low = vector(1.5)
  return low, { low[1] + number(0.5, 2), low[2] + number(0.5, 2), low[3] + number(0.5, 2) }
end

local function between(low, high)
  return function(p)
    return p[1] > low[1] and p[1] < high[1] and p[2] > low[2] and p[2] < high[2] and p[3] > low[3] and p[3] < high[3]
  end
end

-- Returns the distance of a point along an axis, and its distance from the axis.
local function around(base, way, p)
  local length, from = math.sqrt(dot(way, way)), step(p, -1, base)
  local along = dot(from, way) / length
  return along, math.sqrt(math.max(dot(from, from) - along * along, 0)), length
end

local parts = {}
function parts.sphere()
  local center, radius = vector(1), number(0.5, 1.5)
  return glint.sphere { center = center, radius = radius }, function(p)
    local from = step(p, -1, center)
    return dot(from, from) < radius * radius
  end
end
function parts.box()
  local low, high = corners()
  return glint.box { min = low, max = high }, between(low, high)
end
function parts.mesh()
  local low, high = corners()
  local vertices = {}
  for i = 0, 7 do
    vertices[i + 1] = { (i & 1 > 0 and high or low)[1], (i & 2 > 0 and high or low)[2], (i & 4 > 0 and high or low)[3] }
  end
  return glint.mesh { vertices = vertices, faces = { { 1, 3, 4, 2 }, { 5, 6, 8, 7 }, { 1, 2, 6, 5 }, { 3, 7, 8, 4 }, { 1, 5, 7, 3 },
    { 2, 4, 8, 6 } } }, between(low, high)
end
function parts.cylinder()
  local base, way, radius = vector(1), step({ 0, 0, 0 }, number(0.5, 2), axis()), number(0.5, 1.2)
  return glint.cylinder { base = base, top = step(base, 1, way), radius = radius }, function(p)
    local along, off, length = around(base, way, p)
    return along > 0 and along < length and off < radius
  end
end
function parts.cone()
  local base, way, radius = vector(1), step({ 0, 0, 0 }, number(0.5, 2), axis()), number(0.5, 1.5)
  return glint.cone { base = base, top = step(base, 1, way), radius = radius }, function(p)
    local along, off, length = around(base, way, p)
    return along > 0 and along < length and off < radius * (1 - along / length)
  end
end
function parts.torus()
  local center, way, major = vector(1), axis(), number(0.7, 1.5)
  local minor = major * random(0.1, 0.9)
  return glint.torus { center = center, axis = way, major = major, minor = minor }, function(p)
    local along, off = around(center, way, p)
    return (off - major) ^ 2 + along * along < minor * minor
  end
end
function parts.plane()
  local point, normal = vector(1), axis()
  return glint.plane { point = point, normal = normal }, function(p) return dot(normal, step(p, -1, point)) < 0 end
end
local kinds = { "sphere", "box", "mesh", "cylinder", "cone", "torus", "plane" }

-- ---- CSG shapes ----

local sets = {
  union = function(p, inside)
    for _, f in ipairs(inside) do if f(p) then return true end end
    return false
  end,
  intersection = function(p, inside)
    for _, f in ipairs(inside) do if not f(p) then return false end end
    return true
  end,
  difference = function(p, inside)
    for i = 2, #inside do if inside[i](p) then return false end end
    return inside[1](p)
  end,
}
sets.group = sets.union
local names = { "union", "intersection", "difference", "difference", "group" }

-- Returns a random transform and the inverse of the transform.
local function random_map()
  local kind, k = math.random(3), math.random(3)
  if kind == 1 then
    local by = vector(1)
    return glint.translate(by[1], by[2], by[3]), function(p) return step(p, -1, by) end
  elseif kind == 2 then
    local degrees = lattice and 90 * math.random(3) or random(0, 360)
    local c, s, a, b = math.cos(math.rad(degrees)), math.sin(math.rad(degrees)), k % 3 + 1, (k + 1) % 3 + 1
    return glint.rotate(("xyz"):sub(k, k), degrees), function(p)
      local out = { p[1], p[2], p[3] }
      out[a], out[b] = c * p[a] + s * p[b], c * p[b] - s * p[a]
      return out
    end
  end
  local by = lattice and { 0.5, -1, 2 } or { random(0.5, 1.5), -random(0.5, 1.5), random(0.5, 1.5) }
  return glint.scale(by[1], by[2], by[3]), function(p) return { p[1] / by[1], p[2] / by[2], p[3] / by[3] } end
end

local function random_set(depth, must)
  if depth == 0 or (not must and math.random() < 0.25) then return parts[kinds[math.random(#kinds)]]() end
  local name, shapes, inside = must or names[math.random(#names)], {}, {}
  for i = 1, depth > 1 and 2 or math.random(2, 3) do shapes[i], inside[i] = random_set(depth - 1) end
  if math.random() < 0.5 then
    local map, back = random_map()
    shapes.transform = map
    return glint[name](shapes), function(p) return sets[name](back(p), inside) end
  end
  return glint[name](shapes), function(p) return sets[name](p, inside) end
end

-- ---- Rays ----

-- Returns "in" or "out" if the whole neighbourhood of a point is on that side, otherwise nil.
local function side_of(inside, p, count)
  local first = inside(p)
  for _ = 1, count do
    local q = { p[1] + random(-NEAR, NEAR), p[2] + random(-NEAR, NEAR), p[3] + random(-NEAR, NEAR) }
    if inside(q) ~= first then return nil end
  end
  return first and "in" or "out"
end

local function random_ray()
  if lattice and math.random(3) == 1 then -- a ray in the plane of a face
    local from, way, c = vector(4), { 0, 0, 0 }, math.random(3)
    way[c], from[c] = math.random(2) * 2 - 3, from[c] + random(-0.4, 0.4)
    return from, way
  end
  local from = { random(-5, 5), random(-5, 5), random(-5, 5) }
  local way = step({ random(-1, 1), random(-1, 1), random(-1, 1) }, -1, from)
  return from, step({ 0, 0, 0 }, 1 / math.sqrt(dot(way, way)), way)
end

-- Returns a point where the ray has crossed to the other side before the reported hit, or nil.
local function passes(inside, from, way, far, side)
  for k = 1, PLACES do
    local p = step(from, far * (k - random(0.01, 0.99)) / PLACES, way)
    local found = side_of(inside, p, 4)
    if found and found ~= side and side_of(inside, p, 400) then return p end
  end
end

function tests.rays_and_points()
  local met, missed = 0, 0
  for case = 1, CASES, tally.step do
    math.randomseed(case)
    lattice = case % 2 == 0
    local solid, inside = random_set(3, names[case % 4 + 1])
    local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, solid }
    for ray = 1, RAYS do
      local from, way = random_ray()
      local side = side_of(inside, from, 400)
      local hit = side and scene:cast(from, way)
      local over = side and passes(inside, from, way, hit and hit.t or 40, side)
      check(not over, "case %d, ray %d: %s goes over before %s", case, ray, side, hit and hit.t or "nothing")
      if hit then
        local before = side_of(inside, step(from, hit.t - 10 * NEAR, way), 400)
        local behind = side_of(inside, step(from, hit.t + 10 * NEAR, way), 400)
        local crosses = not before or not behind or before ~= behind or hit.t < 20 * NEAR
        check(crosses or not side_of(inside, step(from, hit.t, way), 400), "case %d, ray %d: no boundary at %.17g", case, ray, hit.t)
        check(dot(hit.normal, way) * (side == "in" and -1 or 1) <= 1e-9, "case %d, ray %d: the normal is outward", case, ray)
      end
      met, missed = met + (hit and 1 or 0), missed + (side and not hit and 1 or 0)
    end
  end
  check(met * tally.step > CASES * RAYS / 5 and missed * tally.step > CASES * RAYS / 20, "%d rays met something, %d nothing", met, missed)
end

tally.run(tests)
tally.finish()
