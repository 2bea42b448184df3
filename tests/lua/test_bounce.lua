-- Mirrors and glass against closed forms: single rays and their hits, energy, depth, absorption, tinted shadows; and
-- identical pictures in every configuration.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local LOSS = 2 ^ -20 -- largest error: the light that dropped weak rays may carry
local ROUNDING = 2 ^ -23 -- rounding error of a float32 near 1

local function material(fields)
  fields.diffuse = fields.diffuse or 0
  fields.ambient = fields.ambient or 0
  return glint.material(fields)
end
local function glass(ior, more)
  local fields = { transmission = 1, ior = ior }
  for name, value in pairs(more or {}) do fields[name] = value end
  return material(fields)
end
local function ball(radius, of, center) return glint.sphere { center = center or { 0, 0, 0 }, radius = radius, material = of } end
local function floor(of, y, up) return glint.plane { point = { 0, y or 0, 0 }, normal = { 0, up or 1, 0 }, material = of } end

-- Casts one ray, through the centre of a one-pixel picture.
local function look(eye, direction, objects, more)
  local scene = glint.scene {
    camera = glint.camera { eye = eye, direction = direction, fov = 10 },
    ambient = 1, background = more and more.background or 0,
  }
  for _, object in ipairs(objects) do scene:add(object) end
  local fields = { width = 1, height = 1, output = "none", passes = "beauty,mirror,transmission" }
  for name, value in pairs(more or {}) do if name ~= "background" then fields[name] = value end end
  local image = scene:render(fields)
  return (image:pixel(0, 0)), image, scene
end

-- ---- Paths: a light of radius 1e-6 is where the ray must end --------------------------------------------------------

-- Polar angles are measured from +z towards +x in the plane y = 0. The ray leaves the ball of radius 2 at the angle
-- `leaves` in the direction `goes`. objects: the scene's objects.
local function comes_out(name, eye, direction, objects, leaves, goes)
  local function at(angle, length) return length * math.sin(angle), length * math.cos(angle) end
  local x, z = at(leaves, 2)
  local dx, dz = at(goes, 5)
  objects[#objects + 1] = ball(1e-6, material { ambient = 1 }, { x + dx, 0, z + dz })
  near(look(eye, direction, objects), 1, LOSS, name)
end

local asin, pi = math.asin, math.pi
for _, n in ipairs { 1.5, 1, 2.4, 1.0001 } do
  for _, b in ipairs { 0, 0.1, 1, 1.9, 1.999 } do
    local i, r = asin(b / 2), asin(b / (2 * n))
    comes_out(("ball of %g at %g"):format(n, b), { b, 0, 9 }, { 0, 0, -1 }, { ball(2, glass(n)) }, i + pi - 2 * r, 2 * i + pi - 2 * r)
  end
end
for _, n in ipairs { { 1.5, 1.2 }, { 1.2, 1.5 }, { 1.5, 1.5 }, { 1.33, 1 } } do
  for _, b in ipairs { 0.05, 0.5, 0.9 } do -- a ball of radius 1 inside one of radius 2
    local i1, r1, i2, r2 = asin(b / 2), asin(b / (2 * n[1])), asin(b / n[1]), asin(b / n[2])
    local leaves = i1 + 2 * (i2 - r1) + pi - 2 * r2
    local outer, inner = ball(2, glass(n[1])), ball(1, glass(n[2]))
    comes_out(("ball of %g in %g at %g"):format(n[2], n[1], b), { b, 0, 9 }, { 0, 0, -1 }, { outer, inner }, leaves, leaves + i1)
    local s = asin(b) -- also tests with the eye inside both balls
    leaves = pi - s + asin(n[2] * b / n[1]) - asin(n[2] * b / n[1] / 2)
    if n[2] * b / n[1] < 1 then
      comes_out(("eye in ball of %g in %g at %g"):format(n[2], n[1], b), { b, 0, 0 }, { 0, 0, -1 }, { inner, outer }, leaves,
        leaves + asin(n[2] * b / 2))
    end
  end
end
do -- total reflection at a bubble: at b = 1.2 the bubble of radius 1 in glass of index 1.5 is beyond the critical angle
  local b, n = 1.2, 1.5
  local i1, r1, i2 = asin(b / 2), asin(b / (2 * n)), asin(b / n)
  local leaves = i1 + 2 * (i2 - r1)
  comes_out("total reflection", { b, 0, 9 }, { 0, 0, -1 }, { ball(2, glass(n)), ball(1, glass(1)) }, leaves, leaves + i1)
end

-- ---- Amounts --------------------------------------------------------------------------------------------------------

do -- a mirror shows the reflected light times its colour; with fresnel, times a dielectric's reflectance
  local down = { 0, -1, -1 }
  near(look({ 0, 5, 0 }, down, { floor(material { mirror = 0.9 }) }, { background = 0.5 }), 0.45, ROUNDING, "mirror")
  near(look({ 0, 5, 0 }, { 0, -1, 0 }, { floor(material { fresnel = true }) }, { background = 1 }), 0.04, ROUNDING, "coat")
  near(look({ 0, 5, 0 }, { 0, -1, 0 }, { floor(material { fresnel = true, mirror = 0 }) }, { background = 1 }), 0, 0, "no coat")
  near(look({ 0, 5, 0 }, { 0, -1, 0 }, { floor(glass(1.5, { fresnel = true })) }, { background = 1 }), 1, ROUNDING, "both")
  local grazing = look({ 0, 5, 0 }, { math.sqrt(0.75), -0.5, 0 }, { floor(material { fresnel = true }) }, { background = 1 })
  near(grazing, 0.0891867128, 1e-8, "coat at 60 degrees")
end

do -- facing mirrors of reflectance 0.9 that emit a: a (1 + 0.9 + ... + 0.9^k) at depth k
  local a = 0.05
  local wall = material { mirror = 0.9, ambient = a }
  local objects = { floor(wall, 0, 1), floor(wall, 1, -1) }
  for _, depth in ipairs { 0, 1, 2, 5, 20, 60, 1000, 1000000 } do
    local got, image = look({ 0, 0.5, 0 }, { 0.3, -1, 0 }, objects, { max_depth = depth })
    near(got, a * (1 - 0.9 ^ (depth + 1)) / 0.1, LOSS + ROUNDING, "facing mirrors, depth " .. depth)
    check(image:pixel(0, 0, "mirror") <= got - a + 2 * ROUNDING, "the rest is the mirror's")
  end
end

do -- energy: in a white world mirrors, glass and nested balls neither lose nor gain light
  local furnace = {
    mirror = { ball(1, material { mirror = 1 }) },
    mirrors = { ball(1, material { mirror = 1 }), ball(1, material { mirror = 1 }, { 1.2, 1.9, 0 }), floor(material { mirror = 1 }, -1) },
    glass = { ball(1, glass(1.5, { fresnel = true })) },
    window = { ball(1, glass(1.5)) },
    ["glass in glass"] = { ball(1, glass(1.5, { fresnel = true })), ball(0.7, glass(1.1, { fresnel = true })), ball(0.4, material { mirror = 1 }) },
  }
  for name, objects in pairs(furnace) do
    local scene = glint.scene { camera = glint.camera { eye = { 0, 0.3, 4 }, at = { 0, 0, 0 }, fov = 40 }, background = 1 }
    for _, object in ipairs(objects) do scene:add(object) end
    local nested = name == "glass in glass" -- two rays at every surface: chains end with more light
    local image = scene:render { width = 24, height = 24, output = "none", max_depth = nested and 14 or 300 }
    local least, most = math.huge, -math.huge
    for y = 0, 23 do
      for x = 0, 23 do
        local r, g, b = image:pixel(x, y)
        least, most = math.min(least, r, g, b), math.max(most, r, g, b)
      end
    end
    check(least >= (nested and 0.99 or 1 - LOSS - ROUNDING) and most <= 1 + 2 * ROUNDING, "furnace of %s: %.9g .. %.9g", name, least, most)
  end
end

do -- total reflection does not cross the surface: a prism applies `transmission` twice, however often it reflects
  local function prism(of) -- a triangle with legs of length 1 along x and y
    local vertices = {}
    for _, z in ipairs { -1, 1 } do
      for _, p in ipairs { { 0, 0 }, { 1, 0 }, { 0, 1 } } do vertices[#vertices + 1] = { p[1], p[2], z } end
    end
    return glint.mesh { vertices = vertices, material = of,
      faces = { { 1, 3, 2 }, { 4, 5, 6 }, { 1, 2, 5, 4 }, { 2, 3, 6, 5 }, { 3, 1, 4, 6 } } }
  end
  local function seen(of, more)
    local fields = { background = 1, max_depth = 40 }
    for name, value in pairs(more or {}) do fields[name] = value end
    return look({ -1, 0.3, 0 }, { 1, 0, 0 }, { prism(of) }, fields)
  end
  local off = LOSS + ROUNDING
  near(seen(glass(1.5, { transmission = 0.5 })), 0.25, off, "prism of 45 degrees")
  near(seen(glass(1.5, { transmission = 0.5 }), { precision = "float" }), 0.25, off, "and in float")
  near(seen(glass(1.4, { transmission = 0.5 })), 0.25, off, "below the critical angle, two surfaces as well")
  local red, green, blue = select(2, seen(glass(1.5, { transmission = { 0.5, 0, 1 } }))):pixel(0, 0)
  check(math.abs(red - 0.25) <= off and green == 0 and math.abs(blue - 1) <= off, "each channel its own: %g %g %g", red, green, blue)
  -- The rest of the light bounces between the legs: a + r a r' + ..., where r and r' are the legs' reflectances.
  local both = seen(glass(1.5, { transmission = 0.5, mirror = 0.2 }))
  near(both, 0.2 + (0.25 + 0.2 * 0.25) / (1 - 0.2 ^ 2), off, "a mirror beside it")
  near(seen(glass(1.5, { transmission = 0.5, fresnel = true })), 0.04 + (0.48 ^ 2 + 0.04 * 0.48 ^ 2) / (1 - 0.04 ^ 2), off, "and with fresnel")
  local guide = glint.box { min = { 0, 0, -1 }, max = { 10, 1, 1 }, material = glass(1.5, { transmission = 0.8 }) }
  near(look({ -0.5, 0, 0 }, { 1, 1, 0 }, { guide }, { background = 1, max_depth = 7 }), 0.64, off, "five reflections in a rod")
  near(look({ -0.5, 0, 0 }, { 1, 1, 0 }, { guide }, { background = 1, max_depth = 6 }), 0, 0, "seven surfaces are needed")
end

do -- absorption by the path length inside; in shadows, transmission twice, and absorption along a diameter
  local dense = glass(1, { transmission = 0.9, absorption = { 0.5, 0, 2 } })
  local through = 0.81 * math.exp(-0.5 * 2 * 1.5)
  near(look({ 0, 0, 9 }, { 0, 0, -1 }, { ball(1.5, dense) }, { background = 1 }), through, ROUNDING, "absorption")
  local endless = { floor(glass(1, { transmission = 0.9, absorption = 0.1 })) }
  near(look({ 0, 5, 0 }, { 0, -1, -1 }, endless, { background = 1 }), 0, 0, "a medium without an end")
  local shadowed = look({ 0, 0.5, 5 }, { 0, -0.5, -5 }, {
    floor(material { diffuse = 0.8 }), ball(1.5, glass(1.5, { transmission = 0.9, absorption = { 0.5, 0, 2 } }), { 0, 5, 0 }),
    glint.point_light { position = { 0, 10, 0 } },
  })
  near(shadowed, 0.8 * through, ROUNDING, "tinted shadow")
  local dark = look({ 0, 0.5, 5 }, { 0, -0.5, -5 }, {
    floor(material { diffuse = 0.8 }), ball(1.5, glass(1.5), { 0, 5, 0 }), ball(0.5, material {}, { 0, 5, 0 }),
    glint.point_light { position = { 0, 10, 0 } },
  })
  near(dark, 0, 0, "what is opaque in the glass")
  local directional = look({ 0, 0.5, 5 }, { 0, -0.5, -5 }, {
    floor(material { diffuse = 0.8 }), ball(1, glass(1.5, { transmission = 0.5 }), { 0, 5, 0 }),
    ball(1, glass(1.5, { transmission = 0.5 }), { 0, 8, 0 }), glint.directional_light { direction = { 0, -1, 0 } },
  })
  near(directional, 0.8 * 0.0625, ROUNDING, "two balls, four surfaces")
end

-- An eye inside glass sees every term of the clear picture times exp(-absorption x depth).
local TERMS = { "background", "ambient", "diffuse", "specular", "indirect", "mirror", "transmission" }

do
  local a, r = { 0.5, 0, 2 }, 1.5
  local function wall(more)
    more.transmission, more.ior, more.absorption, more.ambient = 0.25, 1, a, 0.5
    return material(more)
  end
  local function channels(name, want, ...)
    local got = { select(2, look(...)):pixel(0, 0) }
    for c = 1, 3 do near(got[c], want[c], ROUNDING, name .. (" %d"):format(c)) end
  end
  local function left(of, way)
    local out = {}
    for c = 1, 3 do out[c] = of * math.exp(-a[c] * way) end
    return out
  end
  channels("from the centre", left(0.5, r), { 0, 0, 0 }, { 1, 2, 3 }, { ball(r, wall {}) }, { max_depth = 0 })
  channels("and what is behind the wall", left(0.5 + 0.25 * 0.8, r), { 0, 0, 0 }, { 1, 2, 3 }, { ball(r, wall {}) }, { background = 0.8 })
  channels("from beside it", left(0.5, r + 1), { 0, 0, 1 }, { 0, 0, -1 }, { ball(r, wall {}) }, {})
  channels("from inside all of a ball's clear glass", left(0.5 + 0.25 * 0.5, 0), { 0, 0, 0 }, { 0, 0, -1 },
    { ball(0.5, material { transmission = 0.25, ior = 1, ambient = 0.5 }), ball(r, material { transmission = 0.25, absorption = 0, ambient = 0.5, ior = 1 }) },
    { max_depth = 1 })
  local clear = { ball(0.5, material { transmission = 1, ior = 1 }), ball(r, wall {}) }
  channels("only what is around the eye", left(0.5, r - 0.5), { 0, 0, 0 }, { 0, 0, -1 }, clear, {})
  channels("nothing to be hit", { 0, 0.7, 0 }, { 0, -1, 0 }, { 0, -1, -1 }, { floor(wall {}) }, { background = 0.7 })
  channels("an eye outside", { 0.5, 0.5, 0.5 }, { 0, 0, 9 }, { 0, 0, -1 }, { ball(r, wall {}) }, { max_depth = 0 })
end

do -- any shape of glass: absorption depends on the path to the exit, reflection on the change of index there
  local a = { 0.5, 0, 2 }
  local function wall(ior) return material { transmission = 0.25, ior = ior or 1, absorption = a, ambient = 0.5 } end
  local function cube(of, turn) -- a cube from -1 to 1; with turn, the faces point inwards
    local faces = { { 1, 3, 4, 2 }, { 5, 6, 8, 7 }, { 1, 2, 6, 5 }, { 3, 7, 8, 4 }, { 1, 5, 7, 3 }, { 2, 4, 8, 6 } }
    local vertices = {}
    for i = 0, 7 do vertices[i + 1] = { (i & 1) * 2 - 1, (i >> 1 & 1) * 2 - 1, (i >> 2 & 1) * 2 - 1 } end
    for _, face in ipairs(turn and faces or {}) do face[2], face[4] = face[4], face[2] end
    return glint.mesh { vertices = vertices, faces = faces, material = of }
  end
  local turned = glint.rotate({ 0, 0, 1 }, 90) * glint.scale(2, 1, 1)
  local shapes = { -- name, object, eye, direction, path length in the glass
    { "box", glint.box { min = { -1, -1, -1 }, max = { 1, 1, 1 }, material = wall() }, { 0.5, 0, 0 }, { 1, 0, 0 }, 0.5 },
    { "cylinder", glint.cylinder { base = { 0, -1, 0 }, top = { 0, 1, 0 }, radius = 1, material = wall() }, { 0, 0.25, 0 }, { 0, 1, 0 }, 0.75 },
    { "cone", glint.cone { base = { 0, 0, 0 }, top = { 0, 2, 0 }, radius = 1, material = wall() }, { 0, 1, 0 }, { 1, 0, 0 }, 0.5 },
    { "torus", glint.torus { center = { 0, 0, 0 }, major = 2, minor = 0.5, material = wall() }, { 2, 0, 0 }, { 0, 1, 0 }, 0.5 },
    { "ellipsoid", glint.sphere { center = { 0, 0, 0 }, radius = 1, transform = turned, material = wall() }, { 0, 1, 0 }, { 0, 1, 0 }, 1 },
    { "mesh", cube(wall()), { 0.25, 0, 0 }, { 1, 0, 0 }, 0.75 },
    { "mesh, by an edge and a corner", cube(wall()), { 0, 0, 0 }, { 1, 1, 1 }, math.sqrt(3) },
    { "a group's mesh, mirrored", glint.group { transform = glint.scale(2, 1, 1), cube(wall()) }, { 0.5, 0, 0 }, { 1, 0, 0 }, 1.5 },
    { "ball of triangles", glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 16, material = wall() }, { 0, 0.5, 0 }, { 0, 1, 0 }, 0.5 },
    { "mesh in a mesh", glint.group { cube(wall()), glint.group { transform = glint.scale(0.5), cube(material { transmission = 1, ior = 1 }) } },
      { 0.75, 0, 0 }, { 1, 0, 0 }, 0.25 },
  }
  for _, shape in ipairs(shapes) do
    local name, object, eye, way, length = table.unpack(shape)
    local got = { select(2, look(eye, way, { object })):pixel(0, 0) }
    for c = 1, 3 do near(got[c], 0.5 * math.exp(-a[c] * length), ROUNDING, ("an eye in a %s %d"):format(name, c)) end
  end
  local outside = { -- outside, inside shapes without an interior, and behind a face that points away
    { "beside a box", glint.box { min = { -1, -1, -1 }, max = { 1, 1, 1 }, material = wall() }, { 3, 0, 0 }, { -1, 0, 0 } },
    { "beside a mesh", cube(wall()), { 3, 0, 0 }, { -1, 0, 0 } },
    { "behind a mesh", cube(wall()), { 3, 0.25, 0.5 }, { 1, 0, 0 } },
    { "in the hole of a mesh turned inside out", cube(wall(), true), { 0.25, 0, 0 }, { 1, 0, 0 } },
    { "in a tube", glint.cylinder { base = { 0, -1, 0 }, top = { 0, 1, 0 }, radius = 1, capped = false, material = wall() }, { 0, 0, 0 }, { 1, 0, 0 } },
    { "in a cone's air", glint.cone { base = { 0, 0, 0 }, top = { 0, 2, 0 }, radius = 1, material = wall() }, { 0.9, 1, 0 }, { -1, 0, 0 } },
    { "in a torus's hole", glint.torus { center = { 0, 0, 0 }, major = 2, minor = 0.5, material = wall() }, { 0, 0, 0 }, { 1, 0.1, 0 } },
    { "an opaque mesh", cube(material { ambient = 0.5, absorption = a }), { 0.25, 0, 0 }, { 1, 0, 0 } },
  }
  for _, shape in ipairs(outside) do
    local name, object, eye, way = table.unpack(shape)
    local got = { select(2, look(eye, way, { object }, { max_depth = 0 })):pixel(0, 0) }
    local want = name == "behind a mesh" and 0 or 0.5
    for c = 1, 3 do near(got[c], want, ROUNDING, ("an eye %s %d"):format(name, c)) end
  end
end

-- Absorption along the light's path as well: the light in the same glass as the lit point, in another glass, or only
-- the point in glass. Beer's law gives exp(-absorption x path inside). The path from the eye absorbs first.
do
  local a = { 0.5, 0, 2 }
  local function dense(share) return material { transmission = share or 1, ior = 1, absorption = a } end
  local function lit(name, way, share, eye, direction, objects, more)
    local fields = more or { max_depth = 0 }
    local got = { select(2, look(eye, direction, objects, fields)):pixel(0, 0) }
    for c = 1, 3 do near(got[c], share * math.exp(-a[c] * way), 2 * ROUNDING, name .. (" %d"):format(c)) end
  end
  local white = material { diffuse = 1 }
  local lamp = function(at, more)
    local fields = { position = at }
    for key, value in pairs(more or {}) do fields[key] = value end
    return glint.point_light(fields)
  end
  -- The eye is 1 above the floor.
  local box = function(low, high, share) return glint.box { min = { -9, low, -9 }, max = { 9, high, 9 }, material = dense(share) } end
  local down, eye = { 0, -1, 0 }, { 0, 1, 0 }
  lit("a light in the eye's glass", 1 + 2.5, 1, eye, down, { floor(white), ball(5, dense()), lamp { 0, 2.5, 0 } })
  lit("and in float", 1 + 2.5, 1, eye, down, { floor(white), ball(5, dense()), lamp { 0, 2.5, 0 } }, { max_depth = 0, precision = "float" })
  lit("across, with fall-off", 1 + 5, 0.8 / 26, eye, down,
    { floor(white), ball(9, dense()), lamp({ 3, 4, 0 }, { attenuation = { 1, 0, 1 } }) })
  lit("many samples of a small light", 1 + 2.5, 1, eye, down,
    { floor(white), ball(5, dense()), glint.sphere_light { position = { 0, 2.5, 0 }, radius = 1e-9, samples = 4 } })
  lit("the glass itself, from inside", 1 + 3, 0.5, { 0, 2, 0 }, down, -- the lower side of the glass, at y = 1
    { glint.box { min = { -9, 1, -9 }, max = { 9, 9, 9 }, material = material { transmission = 1, ior = 1, absorption = a, diffuse = 0.5 } },
      lamp { 0, 4, 0 } })
  lit("another ball in the way, clear", 1 + 3 - 1, 0.25, eye, down,
    { floor(white), ball(9, dense()), ball(0.5, glass(1, { transmission = 0.5 }), { 0, 2, 0 }), lamp { 0, 3, 0 } })
  lit("the light alone in the glass", 1.5, 0.5, eye, down, { floor(white), box(2, 5, 0.5), lamp { 0, 3.5, 0 } })
  lit("the point alone in the glass", 1 + 2, 0.5, eye, down, { floor(white), box(-1, 2, 0.5), lamp { 0, 4, 0 } })
  lit("the sun, through the glass around", 1 + 2, 0.5, eye, down,
    { floor(white), box(-1, 2, 0.5), glint.directional_light { direction = { 0, -1, 0 } } })
  lit("a light without shadows", 1, 1, eye, down, { floor(white), ball(5, dense()), lamp({ 0, 2.5, 0 }, { shadows = false }) })
  lit("seen from outside", 2 + 1.5, 0.5, { 0, 4, 0 }, down, { floor(white), box(-1, 2, 0.5), lamp { 0, 1.5, 0 } }, { max_depth = 3 })
  lit("in a mirror", 1 + 2 + 0.75, 1, eye, { 0, 1, 0 },
    { ball(9, dense()), floor(material { mirror = 1 }, 2, -1), floor(white), lamp { 0, 0.75, 0 } }, { max_depth = 2 })
end

local function pool(absorption, more)
  local scene = glint.scene {
    camera = glint.camera { eye = { 0, 0.3, 2 }, at = { 0, 0, 0 }, fov = 70 }, ambient = 0.3, background = { 0.2, 0.4, 0.6 },
    indirect = { samples = 2, bounces = 1 },
    ball(3, glass(1.2, { fresnel = true, absorption = absorption, ambient = 0.1 })),
    ball(0.6, glint.material { diffuse = { 0.8, 0.5, 0.3 }, specular = 0.4 }),
    ball(0.4, material { mirror = 0.7, ambient = 0.05 }, { 0.9, 0.2, 0.3 }),
    glint.sphere_light { position = { -0.8, 1, 0 }, radius = 0.2, samples = 2, visible = true, intensity = 0.5, shadows = false },
  }
  for name, value in pairs(more or {}) do scene[name] = value end
  return scene
end
local A = { 0.2, 0.05, 0.7 }

do -- only the eye's own path dims a term; mirrors and glass dim further; light without shadows is not absorbed
  local fields = { width = 40, height = 30, output = "none", passes = "depth,beauty," .. table.concat(TERMS, ",") }
  local clear, dense = pool(0):render(fields), pool(A):render(fields)
  local worst, sums = 0, 0
  for y = 0, 29 do
    for x = 0, 39 do
      local way = dense:pixel(x, y, "depth")
      local sum = 0
      for _, term in ipairs(TERMS) do
        local bright, dark = { clear:pixel(x, y, term) }, { dense:pixel(x, y, term) }
        local mine = term ~= "indirect" and term ~= "mirror" and term ~= "transmission"
        for c = 1, mine and 3 or 0 do
          worst = math.max(worst, math.abs(dark[c] - bright[c] * math.exp(-A[c] * way)))
        end
        sum = string.unpack("f", string.pack("f", sum + dark[1]))
      end
      sums = sums + (sum == dense:pixel(x, y) and 1 or 0)
    end
  end
  check(worst < 4 * ROUNDING, "every term of the first surface: %.3g off", worst)
  check(sums == 1200, "passes sum to the picture in glass")
  local cued = pool(A, { depth_cue = { near = 1, far = 4, color = { 0.1, 0.2, 0.3 } } }):render(fields)
  worst = 0
  for y = 0, 29 do
    for x = 0, 39 do
      local share = math.min(math.max((dense:pixel(x, y, "depth") - 1) / 3, 0), 1)
      local before, after = { dense:pixel(x, y) }, { cued:pixel(x, y) }
      for c = 1, 3 do worst = math.max(worst, math.abs(after[c] - (before[c] * (1 - share) + share * c / 10))) end
    end
  end
  check(worst < 4 * ROUNDING, "a depth cue fades what is left: %.3g off", worst)
end

do -- endless chains: beyond 16 surfaces one ray replaces two, so that work stays bounded and no light is lost
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0.3, 4 }, at = { 0, 0, 0 }, fov = 30 }, background = 1,
    ball(1, glass(1.5, { fresnel = true })), ball(0.7, glass(1.1, { fresnel = true })), ball(0.4, glass(2, { fresnel = true })) }
  local image = scene:render { width = 8, height = 8, output = "none", max_depth = 1000000 }
  local least, most = math.huge, 0
  for y = 0, 7 do
    for x = 0, 7 do
      local r = image:pixel(x, y)
      least, most = math.min(least, r), math.max(most, r)
    end
  end
  check(least >= 1 - LOSS - ROUNDING and most <= 1 + 2 * ROUNDING, "glass in glass, depth 1e6: %.9g .. %.9g", least, most)
end

-- ---- Depth, passes, bad input ---------------------------------------------------------------------------------------

do
  local objects = { ball(1, glass(1.5, { fresnel = true, ambient = 0.1 })), floor(material { mirror = 0.5, ambient = 0.2 }, -1) }
  local black, image = look({ 0, 0, 4 }, { 0, 0, -1 }, objects, { background = 1, max_depth = 0 })
  near(black, 0.1, ROUNDING, "depth 0")
  check(image:pixel(0, 0, "mirror") == 0 and image:pixel(0, 0, "transmission") == 0, "and its passes")
  local one = look({ 0, 0, 4 }, { 0, 0, -1 }, objects, { background = 1, max_depth = 1 })
  near(one, 0.1 + 0.04 + 0.96 * 0.1, ROUNDING, "depth 1")
  local terms = { "background", "ambient", "diffuse", "specular", "mirror", "transmission" }
  local sums, _, _, scene = 0, look({ 0, 0, 4 }, { 0, 0, -1 }, objects, { background = 1 })
  image = scene:render { width = 16, height = 16, samples = 3, output = "none", passes = "beauty," .. table.concat(terms, ",") }
  for y = 0, 15 do
    for x = 0, 15 do
      local sum = 0
      for _, term in ipairs(terms) do sum = string.unpack("f", string.pack("f", sum + image:pixel(x, y, term))) end
      sums = sums + (sum == image:pixel(x, y) and 1 or 0)
    end
  end
  check(sums == 256, "passes sum to the picture")
end

local raises = tally.raises
for _, ior in ipairs { 0, -1 } do raises("ior: number > 0 expected, got " .. ior, glint.material, { ior = ior }) end
raises("material.ior: finite number expected, got nan", glint.material, { ior = 0 / 0 })
raises("material.mirror", glint.material, { mirror = -1 })
raises("material.transmission", glint.material, { transmission = { 1, 2, -3 } })
raises("material.absorption", glint.material, { absorption = -0.1 })
raises("material.fresnel: boolean expected", glint.material, { fresnel = 1 })
for _, depth in ipairs { -1, 0.5, 0 / 0, 1e18 } do
  raises("max_depth", look, { 0, 0, 4 }, { 0, 0, -1 }, { ball(1, glass(1.5)) }, { max_depth = depth })
end
local gain = { ball(1, glass(1.5, { mirror = 1 })) }
raises("max_depth: expected at most 31, because the mirror + transmission of a material is above 1 (here 2), got 32", look, { 0, 0, 4 },
  { 0, 0, -1 }, gain, { max_depth = 32 })
check(look({ 0, 0, 4 }, { 0, 0.01, -1 }, gain, { max_depth = 12, background = 1 }) > 1, "up to 31 it may be")
local m = glint.material { fresnel = true }
check(m.mirror.x == 1, "fresnel: a mirror's colour is 1")
m.mirror = 0.5
check(m.mirror.x == 0.5, "until it is set")
m.mirror, m.fresnel = nil, false
check(m.mirror.x == 0, "and it follows again")

-- ---- Identical pictures in every configuration ----------------------------------------------------------------------

local command = os.getenv "GLINT" or (os.getenv "BUILD" or "build") .. "/glint"
local function picture(environment, options)
  local path = os.tmpname()
  local line = ("%s %s scripts/mirror_and_glass.lua --size %dx%d --quiet --force %s -o %s.pfm 2>%s"):format(environment, command,
    tally.side(90), tally.side(60), options, path, path)
  local ok = os.execute(line)
  local file = ok and io.open(path .. ".pfm", "rb")
  local bytes = file and file:read "a"
  if file then file:close() end
  local said = io.open(path):read "a"
  os.remove(path)
  os.remove(path .. ".pfm")
  return bytes, said
end
for _, precision in ipairs { "double", "float" } do
  local options = "--precision " .. precision
  local want = picture("", options)
  check(want, "a picture in %s", precision)
  for _, isa in ipairs(tally.instruction_sets) do
    local got, said = picture("GLINT_ISA=" .. isa, options)
    if not got and said:find "lacks" then
      print("skipped: " .. isa)
    else
      check(got == want, "%s in %s", isa, precision)
    end
  end
  for _, way in ipairs { "-t 1", "-t 7", "--no-reuse", "--shard 1/1", "--repeat 2" } do
    check(picture("", options .. " " .. way) == want, "%s in %s", way, precision)
  end
end

-- ---- Inside absorbing glass: the effect is used because of the eye; identical with and without reuse ----------------

local POOL = [[
local glint = require "glint"
local P = glint.params { absorption = 0.3, out = 2 }
local water = glint.material { transmission = 0.8, ior = 1.2, absorption = P.absorption, diffuse = 0, ambient = 0.1, name = "water" }
local scene = glint.scene { camera = glint.camera { eye = { 0, 0.3, P.out }, at = { 0, 0, 0 }, fov = 70 }, background = 0.5,
  glint.sphere { center = { 0, 0, 0 }, radius = 3, material = water },
  glint.sphere { center = { 0, 0, 0 }, radius = 0.8, material = glint.material { diffuse = 0.7 } },
  glint.point_light { position = { 2, 2, 1 } } }
return glint.animation { scene = scene, frames = 6, width = 96, height = 64,
  frame = function(_, n) if P.absorption > 0 and n > 3 then water.absorption = { 0.1 * n, 0, 0.4 } end end }
]]
local path = os.tmpname()
io.open(path, "w"):write(POOL):close()
local function said(options)
  local pipe <close> = io.popen(("%s %s 2>&1"):format(command, options:gsub("POOL", path)))
  return pipe:read "a"
end
local explained = said "explain POOL"
check(explained:find("absorption before the eye", 1, true) and explained:find "water" and explained:find "\n%s*depth_cue", "explained: %s", explained)
for _, outside in ipairs { "-D absorption=0", "-D out=9" } do
  local got = said("explain POOL " .. outside)
  check(got:find "refraction" and not got:find("before the eye", 1, true) and not got:find "\n%s*depth_cue", "%s: %s", outside, got)
end
local function frames(options)
  local got = said(("POOL --quiet --force --max-depth 0 -o %s%%d.pfm %s"):format(path, options))
  for n = 1, 6 do
    local file <close> = io.open(path .. n .. ".pfm", "rb")
    got = got .. (file and file:read "a" or "nothing")
    os.remove(path .. n .. ".pfm")
  end
  return got
end
local fresh = frames "--no-reuse"
for _, way in ipairs { "", "-t 1", "-t 3 --samples 1" } do check(frames(way) == fresh, "reused as fresh, %s", way) end
os.remove(path)

-- ---- A mirror or glass must not change other pixels ----

-- Pixels that show no mirror and whose light is not dimmed are identical bit for bit with and without a mirror or
-- glass in the frame, whether or not their tile shows it.
local LIGHT = { "beauty", "background", "ambient", "diffuse", "specular", "mirror", "transmission" }
local function with_ball(of, samples)
  local scene = glint.scene {
    camera = glint.camera { eye = { 0, 3, 9 }, at = { 0, 0.6, 0 }, fov = 40 }, ambient = 0.1, background = { 0.2, 0.3, 0.5 },
    glint.point_light { position = { 4, 6, 5 } }, glint.point_light { position = { -3, 5, 4 }, color = { 0.3, 0.4, 0.1 } },
    glint.disk_light { position = { 0, 7, 2 }, normal = { 0, -1, 0 }, radius = 0.5, samples = 4, intensity = 0.5 },
    floor(glint.material { diffuse = { 0.7, 0.5, 0.2 }, specular = 0.3, shininess = 20 }),
    ball(0.8, glint.material { diffuse = { 0.1, 0.5, 0.7 }, specular = 0.6 }, { -1.6, 0.8, 0 }), ball(0.7, of, { 2.2, 0.7, 1 }),
  }
  return scene:render { width = 130, height = 90, samples = samples, output = "none", passes = table.concat(LIGHT, ",") .. ",object_id" }
end
for _, samples in ipairs { 1, 3 } do
  local plain = with_ball(material { diffuse = 0.3 }, samples)
  for name, of in pairs { mirror = material { diffuse = 0.3, mirror = 0.5 }, glass = glass(1, { diffuse = 0.3, transmission = 0.5 }) } do
    local mixed, shown, changed = with_ball(of, samples), 0, 0
    for y = 0, 89 do
      for x = 0, 129 do
        local is_shown, equal = plain:pixel(x, y, "object_id") == 3, true
        for _, pass in ipairs(LIGHT) do
          local a, b = { plain:pixel(x, y, pass) }, { mixed:pixel(x, y, pass) }
          equal = equal and a[1] == b[1] and a[2] == b[2] and a[3] == b[3]
        end
        shown, changed = shown + (is_shown and 1 or 0), changed + ((is_shown or equal) and 0 or 1)
      end
    end
    local most = name == "glass" and 400 or samples > 1 and 40 or 0 -- the ball's shadow, and its edges
    check(shown > 300 and changed <= most, "%s, %d samples: of %d other pixels %d changed", name, samples, 130 * 90 - shown, changed)
  end
end

tally.finish()
