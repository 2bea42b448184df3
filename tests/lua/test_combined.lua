-- CSG shapes against closed forms: hits, their material and object, refused arguments.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local function box(low, high, more)
  local fields = { min = low, max = high }
  for name, value in pairs(more or {}) do fields[name] = value end
  return glint.box(fields)
end

local function ball(x, y, z, radius, more)
  local fields = { center = { x, y, z }, radius = radius }
  for name, value in pairs(more or {}) do fields[name] = value end
  return glint.sphere(fields)
end

local CUBE = { { -1, -1, -1 }, { 1, 1, 1 } }
local RED, GREEN, BLUE = glint.material { diffuse = { 1, 0, 0 } }, glint.material { diffuse = { 0, 1, 0 } },
  glint.material { diffuse = { 0, 0, 1 } }

-- Casts straight down from y = 9 at x, z.
local function down(scene, x, z) return scene:cast({ x, 9, z }, { 0, -1, 0 }) end

local function hit_is(hit, t, normal, what)
  check(hit, "%s: nothing is hit", what)
  if not hit then return end
  near(hit.t, t, 1e-15, what)
  local n = hit.normal
  near(math.abs(n.x - normal[1]) + math.abs(n.y - normal[2]) + math.abs(n.z - normal[3]), 0, 1e-12, what .. ": normal")
end

-- The colour of a surface under ambient light.
local function color_at(shape, x, z, background)
  local scene = glint.scene { camera = glint.camera { eye = { x, 9, z }, direction = { 0, -1, 0 }, up = { 0, 0, -1 },
    projection = "orthographic", height = 1e-6 }, ambient = 1, background = background or 0, shape }
  return { scene:render { width = 1, height = 1, output = "none" }:pixel(0, 0) }
end

local function is_color(got, want, what)
  check(got[1] == want[1] and got[2] == want[2] and got[3] == want[3], "%s: %g %g %g", what, got[1], got[2], got[3])
end

local tests = {}

function tests.sets()
  local a, b = box(CUBE[1], CUBE[2]), ball(0, 1, 0, 0.5)
  local union = glint.scene { glint.union { a, b } }
  hit_is(down(union, 0, 0), 7.5, { 0, 1, 0 }, "a ball on a cube")
  hit_is(down(union, 0.75, 0), 8, { 0, 1, 0 }, "the cube beside it")
  local cut = glint.scene { glint.difference { a, b } }
  hit_is(down(cut, 0, 0), 8.5, { 0, 1, 0 }, "the bottom of a bowl")
  hit_is(down(cut, 0.3, 0), 8 + 0.4, { -0.6, 0.8, 0 }, "its side")
  local both = glint.scene { glint.intersection { a, b } }
  hit_is(down(both, 0.25, 0), 8, { 0, 1, 0 }, "the flat side of half a ball")
  check(not down(both, 0.75, 0), "beside it there is nothing")
  hit_is(both:cast({ 0, -9, 0 }, { 0, 1, 0 }), 9.5, { 0, -1, 0 }, "from below")
end

function tests.planes_are_half_spaces()
  local half = glint.intersection { ball(0, 0, 0, 1), glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } } }
  hit_is(down(glint.scene { half }, 0.5, 0), 9, { 0, 1, 0 }, "the lower half of a ball")
  hit_is(glint.scene { half }:cast({ 0, -9, 0 }, { 0, 1, 0 }), 8, { 0, -1, 0 }, "from below")
  local pit = glint.difference { glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } }, ball(0, 0, 0, 1) }
  hit_is(down(glint.scene { pit }, 0, 0), 10, { 0, 1, 0 }, "a pit in the ground")
  hit_is(down(glint.scene { pit }, 50, 3), 9, { 0, 1, 0 }, "the ground, which has no end")
  local wedge = glint.intersection { glint.plane { point = { 0, 0, 0 }, normal = { 1, 1, 0 } },
    glint.plane { point = { 0, 0, 0 }, normal = { -1, 1, 0 } } }
  local s = math.sqrt(0.5)
  hit_is(down(glint.scene { wedge }, 2, 7), 11, { s, s, 0 }, "a roof")
end

-- A ray can be inside a torus twice. A torus is cut off at one side, or cut out of a box.
function tests.tori()
  local ring = glint.torus { center = { 0, 0, 0 }, axis = { 0, 1, 0 }, major = 2, minor = 0.5 }
  local groove = glint.scene { glint.difference { box({ -4, -1, -4 }, { 4, 0, 4 }), ring } }
  hit_is(down(groove, 2, 0), 9.5, { 0, 1, 0 }, "the bottom of a groove")
  hit_is(down(groove, 0, 0), 9, { 0, 1, 0 }, "within the ring")
  local half = glint.scene { glint.difference { ring, box({ -9, -9, -9 }, { 0, 9, 9 }) } }
  hit_is(half:cast({ -9, 0, 0 }, { 1, 0, 0 }), 10.5, { -1, 0, 0 }, "the other half")
  hit_is(half:cast({ 9, 0, 0 }, { -1, 0, 0 }), 6.5, { 1, 0, 0 }, "from its side")
  local seal = glint.union { ring, ball(0, 0, 0, 1) }
  hit_is(glint.scene { seal }:cast({ -1.25, 0, 0 }, { 1, 0, 0 }), 0.25, { -1, 0, 0 }, "a ball in the hole")
  hit_is(glint.scene { seal }:cast({ 1.25, 0, 0 }, { 1, 0, 0 }), 0.25, { -1, 0, 0 }, "the ring from within")
  check(glint.scene { seal }:cast({ -9, 0, 0 }, { 1, 0, 0 }).element == 1 and down(glint.scene { seal }, 0, 0).element == 2,
    "a torus is one part")
end

function tests.nested_under_transforms()
  local hollow = glint.difference { ball(0, 0, 0, 2), ball(0, 0, 0, 1.5), transform = glint.translate(0, 1, 0) }
  local kernel = glint.difference { hollow, glint.group { box({ -9, 0, -9 }, { 9, 9, 9 }), transform = glint.translate(0, 1, 0) } }
  local scene = glint.scene { kernel }
  hit_is(down(scene, 0, 0), 9.5, { 0, 1, 0 }, "the bottom of a shell")
  hit_is(down(scene, 1.75, 0), 8, { 0, 1, 0 }, "its rim")
  kernel.transform = glint.scale(1, 2, 1)
  hit_is(down(scene, 1.75, 0), 7, { 0, 1, 0 }, "the rim of a higher one")
  hollow.transform = nil
  hit_is(down(scene, 0, 0), 9 + 3, { 0, 1, 0 }, "a part that moved")
end

function tests.materials()
  local cube, cutter = box(CUBE[1], CUBE[2]), ball(0, 1, 0, 0.5)
  local whole = glint.difference { cube, cutter, material = RED }
  is_color(color_at(whole, 0.9, 0.9), { 1, 0, 0 }, "the whole's, of the first part")
  is_color(color_at(whole, 0, 0), { 1, 0, 0 }, "the whole's, of the cutter")
  cutter.material = BLUE
  is_color(color_at(whole, 0, 0), { 0, 0, 1 }, "the cutter's own")
  is_color(color_at(whole, 0.9, 0.9), { 1, 0, 0 }, "the whole's, beside it")
  local bare = glint.difference { box(CUBE[1], CUBE[2], { material = GREEN }), ball(0, 1, 0, 0.5) }
  is_color(color_at(bare, 0, 0), { 0, 1, 0 }, "that of the first part that has one")
  local inner = glint.union { ball(0, 1, 0, 0.5), material = BLUE }
  local nested = glint.difference { box(CUBE[1], CUBE[2]), inner, material = RED }
  is_color(color_at(nested, 0, 0), { 0, 0, 1 }, "that of the nearest solid around it")
  local plain = glint.material {}
  inner.material = plain
  check(inner.material == plain, "material is read as it was set")
end

function tests.first_of_several_faces()
  local low, high = box(CUBE[1], CUBE[2], { material = RED }), box({ 0, -1, -1 }, { 2, 1, 1 }, { material = BLUE })
  is_color(color_at(glint.union { low, high }, 0.5, 0), { 1, 0, 0 }, "the first defined")
  is_color(color_at(glint.union { high, low }, 0.5, 0), { 0, 0, 1 }, "the other way round")
  is_color(color_at(glint.union { glint.difference { low, box({ -1, 0, -1 }, { 1, 1, 1 }) }, high }, 0.5, 0), { 0, 0, 1 },
    "not that of one that is cut away there")
  is_color(color_at(glint.difference { low, box({ -0.5, 0, -0.5 }, { 0.5, 1, 0.5 }, { material = GREEN }) }, 0, 0), { 0, 1, 0 },
    "a flush cutter leaves no skin")
end

function tests.one_object()
  local whole = glint.union { box(CUBE[1], CUBE[2]), ball(0, 1, 0, 0.5), glint.group { ball(5, 0, 0, 1), ball(9, 0, 0, 1) } }
  local last = ball(-9, 0, 0, 1)
  local scene = glint.scene { ball(0, -50, 0, 1), whole, last }
  local hit = down(scene, 0, 0)
  check(hit.object == whole and hit.element == 2, "the whole, by its second part")
  check(down(scene, 9, 0).object == whole and down(scene, 9, 0).element == 4, "by the second of a group in it")
  check(down(scene, -9, 0).object == last, "what comes after it")
  scene.camera = glint.camera { eye = { 0, 9, 0 }, direction = { 0, -1, 0 }, up = { 0, 0, -1 }, projection = "orthographic", height = 40 }
  local image = scene:render { width = 40, height = 40, output = "none", passes = "object_id" }
  check(image:pixel(20, 20, "object_id") == 2 and image:pixel(25, 20, "object_id") == 2, "one object in the pass")
  check(image:pixel(10, 20, "object_id") == 3, "the next has the next number")
end

function tests.shared_parts_move_everywhere()
  local pin = glint.cylinder { base = { 0, 0, 0 }, top = { 0, 3, 0 }, radius = 0.5 }
  local a = glint.difference { box(CUBE[1], CUBE[2]), pin }
  local b = glint.union { box({ 4, -1, -1 }, { 6, 1, 1 }), glint.group { pin, transform = glint.translate(5, 0, 0) } }
  local scene = glint.scene { a, b, pin }
  check(down(scene, 0, 0).object == pin, "it stands in the hole that it leaves")
  scene:remove(pin)
  near(down(scene, 0, 0).t, 9, 0, "the hole")
  near(down(scene, 5, 0).t, 6, 0, "a pin elsewhere")
  pin.base, pin.top = { 0, 0.5, 0 }, { 0, 4, 0 }
  near(down(scene, 0, 0).t, 8.5, 0, "a shallower hole")
  near(down(scene, 5, 0).t, 5, 0, "a longer pin")
end

-- A box minus another box, in glass: light enters and leaves the same medium, whichever part of the shape it crosses.
function tests.glass()
  local function glass(more)
    local fields = { diffuse = 0, transmission = 1, ior = 1, absorption = 0.5 }
    for name, value in pairs(more or {}) do fields[name] = value end
    return glint.material(fields)
  end
  local whole = glint.difference { box({ -1, -1, -1 }, { 1, 1, 1 }), box({ -0.5, -0.5, -0.5 }, { 0.5, 0.5, 0.5 }), material = glass() }
  near(color_at(whole, 0.75, 0, 1)[1], math.exp(-1), 1e-6, "two of glass")
  near(color_at(whole, 0, 0, 1)[1], math.exp(-0.5), 1e-6, "a hollow in it")
  local coated = glint.difference { box({ -1, -1, -1 }, { 1, 1, 1 }), material = glass(),
    box({ -0.5, -0.5, -0.5 }, { 0.5, 0.5, 0.5 }, { material = glass { absorption = 9, ior = 3, transmission = 0.5 } }) }
  near(color_at(coated, 0, 0, 1)[1], math.exp(-0.5) / 4, 1e-6, "a coat takes its part twice; the inside is the whole's")
  local halves = glint.union { box({ -1, -1, -1 }, { 1, 0, 1 }), box({ -1, 0, -1 }, { 1, 1, 1 }), material = glass() }
  near(color_at(halves, 0, 0, 1)[1], math.exp(-1), 1e-6, "halves have nothing between them")
  -- the eye is inside the shape
  local scene = glint.scene { camera = glint.camera { eye = { 0.75, 0, 0 }, direction = { 0, 1, 0 }, up = { 0, 0, 1 }, fov = 1e-3 }, background = 1,
    whole }
  near(scene:render { width = 1, height = 1, output = "none" }:pixel(0, 0), math.exp(-0.5), 1e-6, "the eye in glass")
  scene.camera.eye = { 0, 0, 0 }
  near(scene:render { width = 1, height = 1, output = "none" }:pixel(0, 0), math.exp(-0.25), 1e-6, "the eye in the hollow")
end

-- Randomly rotated, in matt, mirrors and glass, under a soft light: halves equal the whole, a cutter may end in the
-- face it cuts, and shapes with opacity 0 are invisible; bit for bit.
function tests.pictures()
  local map = glint.translate(0.2, 0.1, 0) * glint.rotate({ 1, 2, 3 }, 37)
  local function picture(shape)
    local scene = glint.scene { camera = glint.camera { eye = { 1, 3, 8 }, at = { 0, 0.5, 0 } }, ambient = 0.1, background = { 0.2, 0.3, 0.5 },
      glint.sphere_light { position = { 4, 8, 5 }, radius = 0.5, samples = 4 }, glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 } },
      ball(-1.5, 0, -2, 1, { material = glint.material { diffuse = { 0.8, 0.2, 0.1 }, mirror = 0.4 } }), shape }
    local image, rows = scene:render { width = 80, height = 60, output = "none" }, {}
    for y = 0, 59 do
      for x = 0, 79 do rows[#rows + 1] = string.pack("fff", image:pixel(x, y)) end
    end
    return table.concat(rows)
  end
  local function pocket(top, more)
    return glint.difference { box(CUBE[1], CUBE[2], more), box({ -0.6, -0.5, -0.6 }, { 0.6, top, 0.6 }), transform = map }
  end
  for name, fields in pairs { matt = { diffuse = 0.8 }, mirror = { diffuse = 0.3, mirror = 0.5 },
    glass = { diffuse = 0.05, transmission = 0.9, ior = 1.3, absorption = 0.2 } } do
    local more = { material = glint.material(fields) }
    local halves = glint.union { box(CUBE[1], { 0, 1, 1 }, more), box({ 0, -1, -1 }, CUBE[2]), transform = map }
    check(picture(halves) == picture(box(CUBE[1], CUBE[2], { material = more.material, transform = map })), "halves, %s", name)
    check(picture(pocket(1, more)) == picture(pocket(3, more)), "a flush cutter, %s", name)
  end
  local clear = { material = glint.material { opacity = 0 } }
  check(picture(pocket(1, clear)) == picture(box({ 0, -9, 0 }, { 1, -8, 1 })), "what is not there")
end

-- Compares light through a hole, next to the hole, and through glass.
function tests.shadows()
  local roof = glint.difference { box({ -3, 2, -3 }, { 3, 3, 3 }), box({ -1, 2, -1 }, { 1, 3, 1 }) }
  local floor = glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 1 } }
  local function at(x, light)
    local scene = glint.scene { camera = glint.camera { eye = { x, 1, 0 }, direction = { 0, -1, 0 }, up = { 0, 0, -1 }, projection = "orthographic",
      height = 1e-6 }, light, floor, roof }
    return (scene:render { width = 1, height = 1, output = "none" }:pixel(0, 0))
  end
  for _, sun in ipairs { glint.directional_light { direction = { 0, -1, 0 } },
    glint.sphere_light { position = { 0, 1e6, 0 }, radius = 1, samples = 4 } } do
    near(at(0.5, sun), 1, 1e-6, "under the hole")
    check(at(1.5, sun) == 0, "under the roof")
    near(at(3.5, sun), 1, 1e-6, "beside it")
  end
  roof.material = glint.material { diffuse = 0, transmission = 0.5, ior = 1, absorption = 1 }
  near(at(1.5, glint.directional_light { direction = { 0, -1, 0 } }), 0.25 * math.exp(-1), 1e-6, "through glass")
end

-- A shell lit from inside its opening: its inside is lit, its outside is in its own shadow.
function tests.shadow_of_itself()
  local cup = glint.difference { glint.cylinder { base = { 0, 0, 0 }, top = { 0, 2, 0 }, radius = 1 },
    glint.cylinder { base = { 0, 0.5, 0 }, top = { 0, 2, 0 }, radius = 0.8 }, material = glint.material { diffuse = 1 } }
  local function at(x, lamp)
    local scene = glint.scene { camera = glint.camera { eye = { x, 9, 0 }, direction = { 0, -1, 0 }, up = { 0, 0, -1 }, projection = "orthographic",
      height = 1e-6 }, glint.point_light { position = lamp }, cup }
    return (scene:render { width = 1, height = 1, output = "none" }:pixel(0, 0))
  end
  near(at(0, { 0, 1, 0 }), 1, 1e-6, "the bottom, lit from inside")
  near(at(0, { 0, 9, 0 }), 1, 1e-6, "from above")
  check(at(-0.7, { -4, 3, 0 }) == 0, "the wall stands in the way of light from the side")
  near(at(0.7, { -4, 6, 0 }), 5.5 / math.sqrt(5.5 ^ 2 + 4.7 ^ 2), 1e-6, "the far side of the bottom is lit over the wall")
  check(at(0.9, { 0, 1, 0 }) == 0, "the rim looks away from a lamp below it")
end

function tests.fields()
  local part = ball(0, 0, 0, 1)
  local whole = glint.union { part, name = "pair" }
  check(whole.count == 1 and whole.name == "pair" and whole.two_sided, "fields are read")
  local more = box(CUBE[1], CUBE[2])
  check(whole:add(more) == more and whole.count == 2, "a part is added")
  whole:remove(part)
  hit_is(down(glint.scene { whole }, 0.9, 0.9), 8, { 0, 1, 0 }, "what is left")
  whole:remove(more)
  check(not down(glint.scene { whole, ball(0, -9, 0, 1) }, 5, 5), "without parts it is nothing")
  check(not down(glint.scene { glint.difference { glint.group {}, ball(0, 0, 0, 1) } }, 0, 0), "nothing, less a ball")
  hit_is(down(glint.scene { glint.difference { ball(0, 0, 0, 1), glint.group {} } }, 0, 0), 8, { 0, 1, 0 }, "a ball, less nothing")
  check(not down(glint.scene { glint.intersection { ball(0, 0, 0, 1), ball(5, 0, 0, 1) } }, 0, 0), "what is apart has nothing in common")
end

local function refused(text, f, ...)
  local ok, message = pcall(f, ...)
  check(not ok and message:find(text, 1, true), "%s expected, got %s", text, tostring(message))
end

function tests.errors()
  refused("union: shapes expected", glint.union, {})
  refused("union[1]: shape expected", glint.union, { 3 })
  refused("difference[2]: shape expected, got material", glint.difference, { ball(0, 0, 0, 1), RED })
  refused("parts with an inside expected: capped = true, got cylinder", glint.union,
    { glint.cylinder { base = { 0, 0, 0 }, top = { 0, 1, 0 }, radius = 1, capped = false } })
  local closed = "difference: parts with an inside expected: a sphere, box, cylinder, cone, torus, plane, closed mesh, group or combined solid, got "
  refused(closed .. "disk", glint.difference, { glint.disk { center = { 0, 0, 0 }, normal = { 0, 1, 0 }, radius = 1 } })
  refused(closed .. "spheres", glint.difference, { glint.spheres { data = { 0, 0, 0, 1 } } })
  refused(closed .. "group with others", glint.difference, { glint.group { glint.disk { center = { 0, 0, 0 }, normal = { 0, 1, 0 }, radius = 1 } } })
  local whole = glint.union { ball(0, 0, 0, 1) }
  refused("union: a solid cannot contain itself", whole.add, whole, glint.group { whole })
  local part = ball(1, 0, 0, 1)
  whole:add(part)
  refused("union: already in the union", whole.add, whole, part)
  refused("union: not in the union", whole.remove, whole, ball(0, 0, 0, 1))
  refused("union.add: one shape expected", whole.add, whole)
  refused("union.radius: no such field", function() whole.radius = 2 end)
  refused("merge", function() return glint.merge end)
  -- a group that gets its children later
  local group = glint.group {}
  whole:add(group)
  group:add(glint.disk { center = { 0, 0, 0 }, normal = { 0, 1, 0 }, radius = 1 })
  refused("union #1: parts with an inside expected", down, glint.scene { whole }, 0, 0)
  local many = glint.union { ball(0, 0, 0, 1), name = "many" }
  for i = 2, 64 do many:add(ball(i, 0, 0, 1)) end
  hit_is(down(glint.scene { many }, 64, 0), 8, { 0, 1, 0 }, "64 parts")
  many:add(ball(65, 0, 0, 1))
  refused("union 'many': at most 64 parts expected", down, glint.scene { many }, 0, 0)
  local vast = glint.union { glint.sphere { center = { 0, 0, 0 }, radius = 1 }, glint.sphere { center = { 0, 0, 0 }, radius = 1e300 } }
  refused("half widths 1e-150 .. 1e+150 in the world expected, got 1e+300", down, glint.scene { vast }, 0, 0)
end

-- Random parts: the union of a set with itself or with an empty set is that set, however many parts overlap along a
-- ray. Compares all passes, with shadows, mirrors and glass, so that rays also start on parts.
function tests.the_same_set_said_otherwise()
  local state = 12345
  local function random(low, high)
    state = (state * 1103515245 + 12345) % 0x80000000
    return low + (high - low) * state / 0x80000000
  end
  local function at(reach) return { random(-reach, reach), random(-reach, reach), random(-reach, reach) } end
  local function part()
    local kind = random(0, 5) // 1
    if kind == 0 then return glint.sphere { center = at(0.8), radius = random(0.4, 1.2) } end
    if kind == 1 then return glint.box { min = { random(-1.2, 0), random(-1.2, 0), -1 }, max = { random(0.1, 1), 0.8, 1 } } end
    if kind == 2 then return glint.cylinder { base = at(1), top = { 0, 1.5, 0 }, radius = random(0.2, 0.7) } end
    if kind == 3 then return glint.torus { center = at(0.4), axis = at(1), major = 0.8, minor = random(0.1, 0.5) } end
    return glint.plane { point = at(0.5), normal = at(1) }
  end
  local operations = { glint.union, glint.difference, glint.intersection }
  local function picture(shape, material)
    local scene = glint.scene { camera = glint.camera { eye = { 3, 2.5, 5 }, at = { 0, 0, 0 }, fov = 34 }, ambient = 0.1,
      background = { 0.2, 0.3, 0.4 }, glint.point_light { position = { 4, 6, 3 } },
      glint.sphere_light { position = { -4, 5, 4 }, radius = 0.5, samples = 3, intensity = 0.4 },
      glint.plane { point = { 0, -1.6, 0 }, normal = { 0, 1, 0 } }, shape }
    shape.material = material
    return scene:render { width = 48, height = 40, output = "none", passes = "depth,normal" }
  end
  local looks = { glint.material { diffuse = 0.7, specular = 0.3 }, glint.material { diffuse = 0.2, mirror = 0.6 },
    glint.material { diffuse = 0.1, transmission = 0.8, ior = 1.3 } }
  for round = 1, 24 do
    local first, second = operations[random(1, 4) // 1 | 0], operations[random(1, 4) // 1 | 0]
    local a, b, c = glint.intersection { part(), glint.sphere { center = { 0, 0, 0 }, radius = 1.5 } }, part(), part()
    local function whole() return round % 2 == 0 and first { a, b } or second { first { a, b }, c } end
    local bounded = function(shape) return glint.intersection { shape, glint.sphere { center = { 0, 0, 0 }, radius = 1.6 } } end
    local plain = picture(bounded(whole()), looks[1 + round % 3])
    for name, other in pairs {
      twice = glint.union { whole(), whole() }, both = glint.intersection { whole(), whole() },
      with_nothing = glint.union { whole(), glint.group {} }, less_nothing = glint.difference { whole(), glint.group {} },
      from_nothing = glint.union { glint.difference { glint.group {}, b }, whole() },
      far = glint.union { whole(), glint.intersection { a, glint.sphere { center = { 50, 0, 0 }, radius = 1 } } },
    } do
      local got, differ = picture(bounded(other), looks[1 + round % 3]), 0
      for y = 0, 39 do
        for x = 0, 47 do
          for _, pass in ipairs { "beauty", "depth", "normal" } do
            local p, q = { plain:pixel(x, y, pass) }, { got:pixel(x, y, pass) }
            for k, value in ipairs(p) do differ = differ + (value == q[k] and 0 or 1) end
          end
        end
      end
      check(differ == 0, "round %d, %s: %d numbers differ", round, name, differ)
    end
  end
end

tally.run(tests)
tally.finish()
