-- Single rays and single reflections through the Lua API. hard_cases.c and hard_shading.c have the full list of hard
-- cases and their variations. The cases here would reveal a number changed by the binding.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local function near(name, got, want, tolerance)
  check(math.abs(got - want) <= tolerance, "%s: %.17g expected, got %.17g (off by %g, %g allowed)", name, want, got,
    math.abs(got - want), tolerance)
end

local function sphere_scene(center, radius)
  local sphere = glint.sphere { center = center, radius = radius }
  return glint.scene { sphere }, sphere
end

-- ---- Spheres ----

local O = { 0, 0, 0 }
-- id, origin, direction, centre, radius, t, normal; t is false for a miss
local cases = {
  { "S01", { 0, 0, 5 }, { 0, 0, -1 }, O, 1, 4, { 0, 0, 1 } },
  { "S10", { 0, 1.75, 0 }, { 1, -0.125, 0.25 }, { 0, -1e7, 0 }, 1e7, 14.000083300991285,
    { 1.40000833e-06, 1, 3.500020825e-07 } },
  { "S10c", { 0, 1.75, 0 }, { 1, -0.125, 0.25 }, { 0, -1e9, 0 }, 1e9, 14.000000833000099,
    { 1.400000083e-08, 1, 3.500000208e-09 } },
  { "S13", { 1, 0, 0 }, { 1, 0, 0 }, O, 1, false },
  { "S14", { 1, 0, 0 }, { -1, 0, 0 }, O, 1, 2, { -1, 0, 0 } },
  { "S17", { 1 - 0x1p-24, 0, 5 }, { 0, 0, -1 }, O, 1, 4.9996547330221436, { 0.9999999404, 0, 0.0003452669779 } },
  { "S18b", { 1 + 0x1p-52, 0, 5 }, { 0, 0, -1 }, O, 1, false },
  { "S20", { 0, 0, 5 }, { 0, 0, -1e-20 }, O, 1, 4.0000000000000002e+20, { 0, 0, 1 } },
  { "S23", { 0, 0, 5 }, { 0, 0, -1e-200 }, O, 1, 4.0000000000000001e+200, { 0, 0, 1 } },
  { "S24", { 0, 0, 5 }, { 0, 0, -1 }, O, 1e-20, 5, { 0, 0, 1 } },
  { "S27", { 0, 0, 5 }, { 0, 0, -1 }, O, 1e160, 1e+160, { 0, 0, -1 } },
  { "S29", { 10000000.5, 0.125, 5 }, { 0, 0, -1 }, { 10000000.25, 0, 0 }, 1, 4.039856781516424,
    { 0.25, 0.125, 0.9601432185 } },
}

local function distance(a, b)
  return math.sqrt((a[1] - b[1]) ^ 2 + (a[2] - b[2]) ^ 2 + (a[3] - b[3]) ^ 2)
end

local function check_hit(id, hit, origin, direction, center, radius, t, normal)
  local away = distance(origin, center)
  local allowed = math.max(1e-9, 8 * 0x1p-53 * (away + radius) / radius)
  near(id .. ": t", hit.t, t, 1e-13 * t)
  for c = 1, 3 do
    near(("%s: normal[%d]"):format(id, c), hit.normal[c], normal[c], allowed)
    -- The point must be where t says, up to a rounding error relative to these terms.
    local size = math.abs(origin[c]) + math.abs(t * direction[c]) + radius + math.abs(center[c])
    near(("%s: point[%d]"):format(id, c), hit.point[c], origin[c] + t * direction[c], 1e-12 * size)
  end
  near(id .. ": the normal is unit", hit.normal.x ^ 2 + hit.normal.y ^ 2 + hit.normal.z ^ 2, 1, 1e-15)
end

for _, case in ipairs(cases) do
  local id, origin, direction, center, radius, t, normal = table.unpack(case)
  local scene, sphere = sphere_scene(center, radius)
  local hit = scene:cast(origin, direction)
  if t then
    check(hit, "%s: a hit expected", id)
    if hit then
      check(rawequal(hit.object, sphere) and hit.element == nil, "%s: another object", id)
      check_hit(id, hit, origin, direction, center, radius, t, normal)
    end
    local many = glint.scene { glint.spheres { data = { center[1], center[2], center[3], radius } } }
    local same = many:cast(origin, direction)
    check(same and hit and same.t == hit.t and same.normal == hit.normal and same.element == 1,
      "%s: glint.spheres gives another answer than glint.sphere", id)
  else
    check(not hit, "%s: a miss expected, got t = %.17g", id, hit and hit.t or 0)
  end
end

do -- S28: the outer of two concentric spheres, in any order of definition
  local inner = glint.sphere { center = O, radius = 1 }
  local outer = glint.sphere { center = O, radius = 1 + 0x1p-23 }
  for _, scene in ipairs { glint.scene { inner, outer }, glint.scene { outer, inner } } do
    local hit = scene:cast({ 0.25, 0.125, 5 }, { 0, 0, -1 })
    check(hit and hit.object == outer, "S28: the outer sphere expected")
    near("S28: t", hit and hit.t or 0, 4.0398566573586039, 4.04e-13)
  end
end

do -- ties: the object defined first wins
  local a, b = glint.sphere { center = O, radius = 1 }, glint.sphere { center = O, radius = 1 }
  check(glint.scene { a, b }:cast({ 0, 0, 5 }, { 0, 0, -1 }).object == a, "S38: the first expected, a here")
  check(rawequal(glint.scene { b, a }:cast({ 0, 0, 5 }, { 0, 0, -1 }).object, b), "S38: the first expected, b here")
end

-- ---- Planes ----

do
  local floor = glint.scene { glint.plane { point = { 0, -1, 0 }, normal = { 0, 2, 0 } } }
  local hit = floor:cast({ 3, 1, 4 }, { 1, -0.5, 0 })
  check(hit, "plane: a hit expected")
  near("plane: t", hit.t, 4, 4e-13)
  check(hit.normal == floor:cast({ 0, 1, 0 }, { 0, -1, 0 }).normal and hit.normal.y == 1, "plane: its own normal")
  near("plane: point", hit.point.x, 7, 1e-12)
  check(not floor:cast({ 0, 1, 0 }, { 1, 0, 0 }), "G1: a parallel ray misses")
  check(not floor:cast({ 0, -1, 0 }, { 1, 0, 0 }), "G1: a ray in the plane misses")
  check(not floor:cast({ 0, 1, 0 }, { 0, 1, 0 }), "plane: behind the origin")
  local below = floor:cast({ 0, -3, 0 }, { 0, 1, 0 })
  check(below and below.t == 2 and below.normal.y == 1, "plane: its own normal also from behind")
end

do -- which of many spheres is hit; a scene with nothing to hit
  local rows = {}
  for i = 1, 100 do
    for _, x in ipairs { i, 0, 0, 0.25 } do rows[#rows + 1] = x end
  end
  local many = glint.spheres { data = rows }
  local scene = glint.scene { many }
  for _, i in ipairs { 1, 2, 37, 99, 100 } do
    local hit = scene:cast({ i, 0, 5 }, { 0, 0, -1 })
    check(hit and hit.element == i and hit.t == 4.75 and hit.object == many, "spheres: number %d expected", i)
  end
  check(scene:cast({ 0, 0, 5 }, { 0, 0, -1 }) == nil, "spheres: nil for a miss")
  check(glint.scene {}:cast({ 0, 0, 5 }, { 0, 0, -1 }) == nil, "empty scene: nil")
end

-- ---- Reflection ----

local function specular(model, shininess, n, l, v)
  local material = glint.material { model = model, diffuse = 1, specular = 1, shininess = shininess }
  local reflection = material:evaluate { normal = n, to_light = l, to_eye = v }
  return reflection.specular[1], reflection.diffuse[1]
end
local function phong(...) return specular("phong", ...) end
local function blinn(...) return specular("blinn_phong", ...) end

-- Returns a direction in the x-z plane that is at an angle of cosine c to the z axis.
local function tilted(c) return { math.sqrt(1 - c * c), 0, c } end
local Z = { 0, 0, 1 }
local REL = 4e-6 -- the kernels shade in float32, with this error bound for their power function

local function near_rel(name, got, want) near(name, got, want, REL * want) end

do
  local s, d = phong(10, Z, { 0.6, 0, 0.8 }, Z)
  near_rel("P1: phong", s, 0.1073741824)
  near("P1: diffuse", d, 0.8, 1e-7)
  near_rel("P1: blinn", blinn(40, Z, { 0.6, 0, 0.8 }, Z), 0.1215766546)
  near_rel("P2: phong", phong(50, Z, { 3, 0, 4 }, { -3, 1, 4 }), 0.3751168023)
  near_rel("P6", phong(1e6, Z, Z, tilted(0.999999)), 0.367879257221)
  s, d = phong(1, { 0, 1, 0 }, { 0.8, -0.6, 0 }, { -0.96, 0.28, 0 })
  check(s == 0 and d == 0, "P3: nothing from a light below the horizon, got %g and %g", d, s)
  s, d = specular("lambert", 1, Z, Z, Z)
  check(s == 0 and d == 1, "lambert: no highlight, got %g and %g", d, s)
end

tally.finish()
