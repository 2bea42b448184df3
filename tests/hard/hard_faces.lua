-- Rays at coplanar faces of different shapes must always hit the shape defined first. Rays that start on a face must
-- not hit that face again. Coordinates use all their digits: multiples of powers of two can be right by accident.
--   hard_faces.lua [--table] [--rays N] [--seed S]
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local tabular, rays, seed = false, 12000, 7
for i = 1, #arg do
  if arg[i] == "--table" then tabular = true end
  if arg[i] == "--rays" then rays = tonumber(arg[i + 1]) end
  if arg[i] == "--seed" then seed = tonumber(arg[i + 1]) end
end
math.randomseed(seed)
local random = math.random
local function u(a, b) return a + (b - a) * random() end
local function vector(size) return { u(-size, size), u(-size, size), u(-size, size) } end
local function plus(a, b, s) return { a[1] + s * b[1], a[2] + s * b[2], a[3] + s * b[3] } end
local function minus(a, b) return plus(a, b, -1) end
local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
local function cross(a, b)
  return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end
local function unit(a) return plus({ 0, 0, 0 }, a, 1 / math.sqrt(dot(a, a))) end
local function across(n)
  local x = unit(cross(n, math.abs(n[1]) < .5 and { 1, 0, 0 } or { 0, 1, 0 }))
  return x, cross(n, x)
end

local function row(name, count, wrong)
  if tabular then print(("| %s | %d | %d |"):format(name, count, wrong)) end
  check(wrong == 0, "%s: %d wrong of %d", name, wrong, count)
  check(count > 0, "%s: nothing was tried", name)
end

-- ---- Shapes with a face at height h and nothing above it ----

local function box(h)
  local x, z = u(-.5, 0), u(-.5, 0)
  return glint.box { min = { x - u(.2, 1), h - u(.1, 1), z - u(.2, 1) }, max = { x + u(.7, 2), h, z + u(.7, 2) } }
end

local makers = {
  { "box", box },
  { "disk", function(h)
    return glint.disk { center = { u(-.2, .2), h, u(-.2, .2) }, normal = { 0, random() < .5 and u(1, 2) or -1, 0 }, radius = u(.5, 1.5) }
  end },
  { "plane", function(h) return glint.plane { point = { u(-3, 3), h, u(-3, 3) }, normal = { 0, u(.3, 3), 0 } } end },
  { "cylinder", function(h)
    local x, z = u(-.2, .2), u(-.2, .2)
    local ends = { { x, h - u(.2, 1), z }, { x, h, z } }
    local up = random(2)
    return glint.cylinder { base = ends[up], top = ends[3 - up], radius = u(.5, 1.5) }
  end },
  { "cone", function(h)
    local x, z = u(-.2, .2), u(-.2, .2)
    return glint.cone { base = { x, h, z }, top = { x, h - u(.2, 1), z }, radius = u(.5, 1.5) }
  end },
  { "mesh", function(h)
    local a, b, c, d = u(-1.5, -.5), u(-1.5, -.5), u(.5, 1.5), u(.5, 1.5)
    return glint.mesh { vertices = { { a, h, b }, { a, h, d }, { c, h, d }, { c, h, b } }, faces = { { 1, 2, 3 }, { 1, 3, 4 } } }
  end },
}

-- ---- Maps: none, axis-aligned, arbitrary ----

local function no_map() return nil, function(p) return p end, "" end

local function along_axes()
  local t, s = vector(2), { u(.3, 3), u(-3, -.3), u(.3, 3) }
  return glint.translate(t) * glint.rotate("x", 90) * glint.scale(s), function(p)
    return plus({ p[1] * s[1], -p[3] * s[3], p[2] * s[2] }, t, 1)
  end, ", along the axes"
end

local function any_map()
  local axis, angle, t, s = unit(vector(1)), u(0, 360), vector(2), { u(.3, 3), u(.3, 3), u(.3, 3) }
  local c, d = math.cos(math.rad(angle)), math.sin(math.rad(angle))
  return glint.translate(t) * glint.rotate(axis, angle) * glint.scale(s), function(p)
    local v = { p[1] * s[1], p[2] * s[2], p[3] * s[3] }
    local turned = plus(plus(plus({ 0, 0, 0 }, v, c), cross(axis, v), d), axis, dot(axis, v) * (1 - c))
    return plus(turned, t, 1)
  end, ", in a group that turns"
end

-- ---- Faces in one plane ----

-- Counts the rays that hit the coplanar faces of both shapes, and the rays that then fail to return the first shape.
local function both(first, second, map, to_world, h)
  local function scene(...)
    local camera = glint.camera { eye = to_world { u(-.3, .3), h + 4.3, u(-.3, .3) }, at = to_world { 0, h, 0 }, up = { .1, .2, 1 }, fov = 9 }
    return glint.scene { camera = camera, map and glint.group { transform = map, ... } or glint.group { ... } }
  end
  local one, two, all = scene(first), scene(second), scene(first, second)
  local count, wrong = 0, 0
  for _ = 1, 12 do
    local from = to_world { u(-2, 2), h + u(.5, 5), u(-2, 2) }
    local way = minus(to_world { u(-.8, .8), h, u(-.8, .8) }, from)
    local a, b, c = one:cast(from, way), two:cast(from, way), all:cast(from, way)
    -- on the side of a box or cylinder, the t of one shape is unrelated to the t of the other
    if a and b and math.abs(a.t - b.t) < 1e-12 * a.t then
      count = count + 1
      if a.t ~= b.t or c.t ~= a.t or c.object ~= first then wrong = wrong + 1 end
    end
  end
  return count, wrong
end

local function coincident(map_of, count)
  local _, _, suffix = map_of()
  for _, a in ipairs(makers) do
    local sum, bad = 0, 0
    for _, b in ipairs(makers) do
      for _ = 1, count do
        local map, to_world = map_of()
        local h = u(-1, 1)
        local n, wrong = both(a[2](h), b[2](h), map, to_world, h)
        sum, bad = sum + n, bad + wrong
      end
    end
    row(a[1] .. " before others" .. suffix, sum, bad)
  end
end

-- Tests a disk, a plane and a cap with a common point and an oblique normal.
local function oblique(count)
  local sum, bad = 0, 0
  for _ = 1, count do
    local at, n = vector(2), vector(1)
    local shapes = {
      function() return glint.plane { point = at, normal = n } end,
      function() return glint.disk { center = at, normal = n, radius = u(.5, 2) } end,
    }
    local k = random(2)
    local first, second = shapes[k](), shapes[3 - k]()
    local x, y = across(unit(n))
    for _ = 1, 10 do
      local from = plus(at, vector(1), u(1, 20))
      local to = plus(plus(at, x, u(-.3, .3)), y, u(-.3, .3))
      local hit = glint.scene { first, second }:cast(from, minus(to, from))
      sum = sum + 1
      if not hit or hit.object ~= first then bad = bad + 1 end
    end
  end
  row("disk and plane of one oblique place and normal", sum, bad)
end

-- No shape that ends at the plane shadows it, as seen from above: pictures are identical with and without shadows.
local function shadows(count)
  local sum, bad = 0, 0
  local oblique_way = unit(vector(1))
  for i = 1, count do
    local h = u(-1, 1)
    local a, b = makers[random(#makers)][2](h), makers[random(#makers)][2](h)
    local slant = i % 2 == 0
    if slant then
      local at = vector(1)
      a = glint.plane { point = at, normal = oblique_way }
      b = glint.disk { center = at, normal = oblique_way, radius = u(.5, 1) }
      if random() < .5 then a, b = b, a end
    end
    local up = slant and oblique_way or { 0, 1, 0 }
    local at = slant and { 0, 0, 0 } or { 0, h, 0 }
    local x = across(up)
    local function picture(shadow)
      local scene = glint.scene { camera = glint.camera { eye = plus(at, up, 5.7), at = at, up = x, fov = 8 }, a, b,
        glint.point_light { position = plus(plus(at, up, 3.1), x, 1.3), shadows = shadow } }
      return scene:render { width = 24, height = 18 }
    end
    math.randomseed(i)
    local with = picture(true)
    local without = picture(false)
    for py = 0, 17 do
      for px = 0, 23 do
        sum = sum + 1
        if with:pixel(px, py) ~= without:pixel(px, py) then bad = bad + 1 end
      end
    end
    math.randomseed(seed + i)
  end
  row("shadows on planes that shapes share, pixels", sum, bad)
end

-- ---- Rays that start on a face ----

local function toward(o, q) return o, minus(q, o) end

local function on_box()
  local low, high, o, q = {}, {}, {}, {}
  for k = 1, 3 do
    low[k] = u(-2, 1)
    high[k] = low[k] + u(.1, 2)
    o[k], q[k] = u(low[k], high[k]), u(low[k], high[k])
  end
  local k = random(3)
  o[k] = random() < .5 and low[k] or high[k]
  return glint.box { min = low, max = high }, toward(o, q)
end

-- Tests rays that start on the side or the base of a cylinder or cone. straight: the axis is along a coordinate axis.
local function on_round(kind, straight, cap)
  return function()
    local base = vector(2)
    local along, k = vector(1), random(3)
    if straight then
      along = { 0, 0, 0 }
      along[k] = u(.3, 2) * (random() < .5 and -1 or 1)
    end
    local x, y = across(unit(along))
    local radius = u(.2, 2)
    local function place(w, share)
      local turn, taper = u(0, 6.3), kind == "cone" and 1 - w or 1
      return plus(plus(plus(base, along, w), x, radius * taper * share * math.cos(turn)), y, radius * taper * share * math.sin(turn))
    end
    local o = cap and place(0, u(0, .9)) or place(u(.05, .95), 1)
    local shape = glint[kind] { base = base, top = plus(base, along, 1), radius = radius }
    return shape, toward(o, place(u(.1, .9), .7))
  end
end

local function on_disk()
  local center, n, radius = vector(2), vector(1), u(.2, 2)
  local x, y = across(unit(n))
  local o = plus(plus(center, x, u(-.6, .6) * radius), y, u(-.6, .6) * radius)
  return glint.disk { center = center, normal = n, radius = radius }, o, vector(1)
end

local function on_ball()
  local center, radius, n = vector(2), u(.1, 2), unit(vector(1))
  return glint.sphere { center = center, radius = radius }, toward(plus(center, n, radius), plus(center, vector(.3), radius))
end

-- Rays from a point of a triangle perpendicular to an axis, or from a point of another triangle without rounding.
local function on_mesh(straight)
  return function()
    local v, k, h = { vector(2), vector(2), vector(2) }, random(3), u(-2, 2)
    for j = 1, 3 do
      for c = 1, 3 do v[j][c] = math.floor(v[j][c] * 2 ^ 40) * 2 ^ -40 end
      if straight then v[j][k] = h end
    end
    local o = plus(plus(plus({ 0, 0, 0 }, v[1], .25), v[2], .25), v[3], .5)
    if straight then o[k] = h end
    return glint.mesh { vertices = v, faces = { { 1, 2, 3 } } }, o, vector(1)
  end
end

local function begins(name, make, map_of, count)
  local bad = 0
  local suffix = ""
  for _ = 1, count do
    local shape, o, way = make()
    local map, to_world, after = map_of()
    suffix = after
    if map then
      shape.transform = map
      way = minus(to_world(plus(o, way, 1)), to_world(o))
      o = to_world(o)
    end
    local hit = glint.scene { shape }:cast(o, way)
    if hit and hit.t < 1e-9 then bad = bad + 1 end
  end
  row("from " .. name .. suffix, count, bad)
end

if tabular then print("Faces in one plane, and rays that begin on one.\n\n| what | how many | wrong |\n| --- | --- | --- |") end
local pairs_each, casts = math.ceil(rays / 3000), math.ceil(rays / 20)
coincident(no_map, pairs_each)
coincident(along_axes, pairs_each)
coincident(any_map, pairs_each)
oblique(math.ceil(rays / 100))
shadows(math.ceil(rays / 300))
local round = { { "a cylinder's side", on_round("cylinder") }, { "a cone's side", on_round("cone") },
  { "an upright cylinder's side", on_round("cylinder", true) }, { "an upright cone's side", on_round("cone", true) },
  { "a cylinder's cap", on_round("cylinder", false, true) }, { "a cone's base", on_round("cone", false, true) },
  { "an upright cylinder's cap", on_round("cylinder", true, true) }, { "a box", on_box }, { "a disk", on_disk } }
for _, map_of in ipairs { no_map, any_map } do
  for _, r in ipairs(round) do begins(r[1], r[2], map_of, casts) end
end
begins("a box", on_box, along_axes, casts)
begins("an ellipsoid", on_ball, any_map, casts)
begins("a triangle square to an axis", on_mesh(true), no_map, casts)
begins("a triangle", on_mesh(false), no_map, casts)
tally.finish()
