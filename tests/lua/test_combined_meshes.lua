-- Closed meshes as parts of CSG shapes against closed forms: hits and their objects, light, refused arguments.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local BOX_FACES = { { 1, 3, 4, 2 }, { 5, 6, 8, 7 }, { 1, 2, 6, 5 }, { 3, 7, 8, 4 }, { 1, 5, 7, 3 }, { 2, 4, 8, 6 } }
local BOTTOM, TOP = 3, 4 -- indices of the faces at the ends of the y axis

-- Returns the coordinates of a box's eight corners.
local function corners(low, high)
  local out = {}
  for i = 0, 7 do
    for c = 1, 3 do out[#out + 1] = i >> (c - 1) & 1 == 0 and low[c] or high[c] end
  end
  return out
end

local function box(low, high, more)
  local fields = { vertices = corners(low, high), faces = BOX_FACES }
  for name, value in pairs(more or {}) do fields[name] = value end
  return glint.mesh(fields)
end

-- Makes one mesh of several boxes; box k is inside out if turned[k].
local function boxes(list, turned)
  local vertices, faces = {}, {}
  for k, ends in ipairs(list) do
    local first = #vertices // 3
    for _, x in ipairs(corners(ends[1], ends[2])) do vertices[#vertices + 1] = x end
    for _, face in ipairs(BOX_FACES) do
      local a, b, c, d = face[1] + first, face[2] + first, face[3] + first, face[4] + first
      faces[#faces + 1] = turned and turned[k] and { d, c, b, a } or { a, b, c, d }
    end
  end
  return glint.mesh { vertices = vertices, faces = faces }
end

local LOW, HIGH = { -1, -1, -1 }, { 1, 1, 1 }
local RED, GREEN, BLUE = glint.material { diffuse = { 1, 0, 0 } }, glint.material { diffuse = { 0, 1, 0 } },
  glint.material { diffuse = { 0, 0, 1 } }
local function ball(x, y, z, radius, material) return glint.sphere { center = { x, y, z }, radius = radius, material = material } end
local function down(shape, x, z) return glint.scene { shape }:cast({ x, 9, z }, { 0, -1, 0 }) end

local function hit_is(hit, t, normal, what)
  check(hit, "%s: nothing is hit", what)
  if not hit then return end
  near(hit.t, t, 1e-15, what)
  local n = hit.normal
  near(math.abs(n.x - normal[1]) + math.abs(n.y - normal[2]) + math.abs(n.z - normal[3]), 0, 1e-12, what .. ": normal")
end

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
  local a, b = box(LOW, HIGH), ball(0, 1, 0, 0.5)
  hit_is(down(glint.difference { a, b }, 0, 0), 8.5, { 0, 1, 0 }, "the bottom of a bowl")
  hit_is(down(glint.difference { a, b }, 0.9, 0.8), 8, { 0, 1, 0 }, "the mesh beside it")
  hit_is(down(glint.union { a, b }, 0, 0), 7.5, { 0, 1, 0 }, "a ball on a mesh")
  hit_is(down(glint.intersection { a, b }, 0.25, 0), 8, { 0, 1, 0 }, "the flat side of half a ball")
  check(not down(glint.intersection { a, b }, 0.75, 0), "beside it there is nothing")
  local pit = box({ -0.5, 0, -0.5 }, { 0.5, 1, 0.5 })
  hit_is(down(glint.difference { a, pit }, 0, 0), 9, { 0, 1, 0 }, "a mesh as a flush cutter leaves no skin")
  hit_is(down(glint.difference { glint.box { min = LOW, max = HIGH }, pit }, 0.2, 0.1), 9, { 0, 1, 0 }, "of a box, too")
  hit_is(down(glint.difference { glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } }, a }, 0, 0), 10, { 0, 1, 0 }, "a pit in the ground")
  hit_is(down(glint.union { glint.group { a, transform = glint.scale(1, 2, 1) } }, 0, 0), 7, { 0, 1, 0 }, "within a group")
  hit_is(down(glint.union { glint.group { a, transform = glint.scale(1, -1, 1) } }, 0.3, 0), 8, { 0, 1, 0 }, "mirrored")
end

-- Overlapping bodies merge; an inside-out body in another one is a hollow; an entirely inside-out mesh is unchanged.
function tests.bodies()
  local both = boxes { { LOW, HIGH }, { { -0.5, 0, -0.5 }, { 0.5, 3, 0.5 } } }
  hit_is(down(glint.union { both }, 0, 0), 6, { 0, 1, 0 }, "two bodies")
  hit_is(down(glint.difference { both, glint.box { min = { -2, 0.5, -2 }, max = { 2, 9, 2 } } }, 0, 0), 8.5, { 0, 1, 0 }, "cut where they overlap")
  local shell = boxes({ { LOW, HIGH }, { { -0.5, -0.5, -0.5 }, { 0.5, 0.5, 0.5 } } }, { false, true })
  local open = glint.difference { shell, glint.box { min = { -0.25, 0, -0.25 }, max = { 0.25, 2, 0.25 } } }
  hit_is(down(open, 0, 0), 9.5, { 0, 1, 0 }, "the bottom of a hollow, by a hole")
  hit_is(down(glint.union { boxes({ { LOW, HIGH } }, { true }) }, 0, 0), 8, { 0, 1, 0 }, "inside out")
  hit_is(glint.scene { glint.union { boxes({ { LOW, HIGH } }, { true }) } }:cast({ 0, 0, 0 }, { 0, 1, 0 }), 1, { 0, 1, 0 }, "from within")
end

-- Tests more spans along a ray than the engine stores at a time, and more overlapping bodies.
function tests.many_stretches()
  local list = {}
  for i = 1, 40 do list[i] = { { -1, -i - 0.25, -1 }, { 1, -i + 0.25, 1 } } end
  local stack = boxes(list)
  for i = 1, 39 do
    local cut = glint.difference { stack, glint.box { min = { -2, -i - 0.5, -2 }, max = { 2, 5, 2 } } }
    hit_is(down(cut, 0.1, 0.2), 9 + i + 0.75, { 0, 1, 0 }, "the next of a stack")
  end
  local inside = glint.intersection { stack, glint.box { min = { -2, -40.1, -2 }, max = { 2, -39.9, 2 } } }
  hit_is(down(inside, 0.1, 0.2), 48.9, { 0, 1, 0 }, "the last alone")
  local copies = {}
  for i = 1, 30 do copies[i] = { LOW, HIGH } end
  hit_is(down(glint.difference { boxes(copies), ball(0, 1, 0, 0.5) }, 0, 0), 8.5, { 0, 1, 0 }, "thirty in one place")
end

-- Aims at corners, edges and centres of a mesh box, and along its diagonals and faces: each entry has an exit.
function tests.edges_and_corners()
  local whole = glint.scene { glint.union { box(LOW, HIGH) } }
  local missed, wrong, n = 0, 0, 0
  for i = -4, 4 do
    for j = -4, 4 do
      for side = -1, 1, 2 do
        for axis = 1, 3 do
          local to = { i / 4, j / 4 }
          table.insert(to, axis, side)
          for _, eye in ipairs { { 3, 5, 7 }, { 0, 8, 0 }, { -4, -4, -4 }, { 0.5, -9, 0.25 } } do
            -- Aims at the box's centre, through a point on its surface.
            local o = { to[1] + eye[1] * 0.5, to[2] + eye[2] * 0.5, to[3] + eye[3] * 0.5 }
            local d = { -o[1], -o[2], -o[3] }
            local hit = whole:cast(o, d)
            n = n + 1
            if math.max(math.abs(o[1]), math.abs(o[2]), math.abs(o[3])) > 1 then
              if not hit then
                missed = missed + 1
              else
                local p = hit.point
                wrong = wrong + (math.abs(math.max(math.abs(p.x), math.abs(p.y), math.abs(p.z)) - 1) > 1e-14 and 1 or 0)
              end
            end
          end
        end
      end
    end
  end
  check(n > 1900 and missed == 0 and wrong == 0, "towards the middle: %d missed, %d off the surface, of %d", missed, wrong, n)
  -- From inside, every ray hits.
  missed = 0
  for i = -8, 8 do
    for j = -8, 8 do
      if not whole:cast({ 0, 0, 0 }, { i / 8, j / 8, 1 }) then missed = missed + 1 end
      if not whole:cast({ 0.25, 0.5, -0.125 }, { 1, i / 8, j / 8 }) then missed = missed + 1 end
    end
  end
  check(missed == 0, "%d rays from within get out", missed)
end

function tests.materials_and_parts()
  local sides = box(LOW, HIGH, { materials = { RED, GREEN }, index = { 1, 1, 1, 2, 1, 1 } })
  is_color(color_at(glint.difference { sides, ball(0, 1, 0, 0.5, BLUE) }, 0.9, 0), { 0, 1, 0 }, "a face's own")
  is_color(color_at(glint.difference { sides, ball(0, 1, 0, 0.5, BLUE) }, 0, 0), { 0, 0, 1 }, "the cutter's")
  is_color(color_at(glint.difference { box(LOW, HIGH), ball(0, 9, 0, 0.5), material = RED }, 0, 0), { 1, 0, 0 }, "the whole's")
  is_color(color_at(glint.difference { box(LOW, HIGH, { material = GREEN }), ball(0, 9, 0, 0.5), material = RED }, 0, 0), { 0, 1, 0 }, "its own")
  local whole = glint.union { ball(9, 0, 0, 1), box(LOW, HIGH), box({ 3, -1, -1 }, { 5, 1, 1 }), glint.torus { center = { 0, 5, 0 }, major = 3, minor = 1 } }
  local last = box({ -9, -1, -1 }, { -7, 1, 1 })
  local scene = glint.scene { whole, last }
  for x, element in pairs { [9] = 1, [0.5] = 2, [4.5] = 3, [-3] = 4 } do
    local hit = scene:cast({ x, 9, 0 }, { 0, -1, 0 })
    check(hit and hit.object == whole and hit.element == element, "part %d, got %s", element, hit and hit.element)
  end
  check(scene:cast({ -8, 9, 0 }, { 0, -1, 0 }).object == last, "what comes after it")
  scene.camera = glint.camera { eye = { 0, 9, 0 }, direction = { 0, -1, 0 }, up = { 0, 0, -1 }, projection = "orthographic", height = 40 }
  local image = scene:render { width = 40, height = 40, output = "none", passes = "object_id" }
  check(image:pixel(20, 20, "object_id") == 1 and image:pixel(24, 20, "object_id") == 1 and image:pixel(12, 20, "object_id") == 2, "one object")
end

function tests.what_moves()
  local part = box({ -0.5, 0, -0.5 }, { 0.5, 2, 0.5 })
  local whole = glint.difference { box(LOW, HIGH), part }
  local scene = glint.scene { whole, camera = glint.camera { eye = { 2, 5, 4 }, at = { 0, 0, 0 } }, ambient = 0.2,
    glint.point_light { position = { 3, 9, 5 } } }
  local renderer = { width = 64, height = 48, output = "none" }
  local function pixels(of)
    local image, out = of:render(renderer), {}
    for y = 0, 47 do
      for x = 0, 63 do out[#out + 1] = string.pack("fff", image:pixel(x, y)) end
    end
    return table.concat(out)
  end
  local first = pixels(scene)
  for step = 1, 3 do
    part.transform = glint.translate(0.1 * step, 0.1, 0)
    local moved = pixels(scene)
    local fresh = glint.scene { glint.difference { box(LOW, HIGH), box({ -0.5, 0, -0.5 }, { 0.5, 2, 0.5 }, { transform = part.transform }) },
      camera = scene.camera, ambient = 0.2, glint.point_light { position = { 3, 9, 5 } } }
    check(moved == pixels(fresh) and moved ~= first, "frame %d of a part that moves is as if made anew", step)
  end
  near(scene:cast({ 0.3, 9, 0 }, { 0, -1, 0 }).t, 8.9, 1e-15, "a part that moved")
end

-- A glass mesh with a hollow equals one made of solid boxes, also with the eye inside.
function tests.glass()
  local glass = glint.material { diffuse = 0, transmission = 1, ior = 1, absorption = 0.5 }
  local whole = glint.difference { box(LOW, HIGH), box({ -0.5, -0.5, -0.5 }, { 0.5, 0.5, 0.5 }), material = glass }
  near(color_at(whole, 0.75, 0.1, 1)[1], math.exp(-1), 1e-6, "two of glass")
  near(color_at(whole, 0.2, 0.1, 1)[1], math.exp(-0.5), 1e-6, "a hollow in it")
  local scene = glint.scene { camera = glint.camera { eye = { 0.75, 0, 0 }, direction = { 0, 1, 0 }, up = { 0, 0, 1 }, fov = 1e-3 }, background = 1, whole }
  near(scene:render { width = 1, height = 1, output = "none" }:pixel(0, 0), math.exp(-0.5), 1e-6, "the eye in glass")
  scene.camera.eye = { 0, 0, 0 }
  near(scene:render { width = 1, height = 1, output = "none" }:pixel(0, 0), math.exp(-0.25), 1e-6, "the eye in the hollow")
  -- Through edges and corners, each ray enters as often as it leaves.
  local wrong = 0
  local solid = glint.scene { camera = glint.camera { eye = { 0, 0, 8 }, at = { 0, 0, 0 } }, background = 1, glint.union { box(LOW, HIGH), material = glass } }
  for i = -4, 4 do
    for _, to in ipairs { { i / 4, 1, 1 }, { 1, 1, i / 4 }, { i / 4, i / 4, 1 }, { i / 4, 1, 0 } } do
      for _, eye in ipairs { { 4, 5, 6 }, { 0.5, 8, 0.25 }, { -6, 7, 2 } } do
        solid.camera = glint.camera { eye = eye, at = to, up = { 0.1, 1, 0.3 }, fov = 1e-3 }
        local enter, leave = 0, math.huge
        for c = 1, 3 do
          local d = to[c] - eye[c]
          local a, b = (-1 - eye[c]) / d, (1 - eye[c]) / d
          if d ~= 0 then enter, leave = math.max(enter, math.min(a, b)), math.min(leave, math.max(a, b)) end
        end
        local length = math.sqrt((to[1] - eye[1]) ^ 2 + (to[2] - eye[2]) ^ 2 + (to[3] - eye[3]) ^ 2) * math.max(leave - enter, 0)
        local got = solid:render { width = 1, height = 1, output = "none", max_depth = 9 }:pixel(0, 0)
        if math.abs(got - math.exp(-0.5 * length)) > 2e-5 then wrong = wrong + 1 end
      end
    end
  end
  check(wrong == 0, "%d of 108 rays through edges and corners of glass", wrong)
end

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
  -- A cup whose wall shadows its own bottom.
  local cup = glint.scene { camera = glint.camera { eye = { 0, 9, 0 }, direction = { 0, -1, 0 }, up = { 0, 0, -1 }, projection = "orthographic",
    height = 1e-6 },
    glint.point_light { position = { -4, 1.2, 0 } }, glint.difference { box({ -1, 0, -1 }, { 1, 2, 1 }), box({ -0.8, 0.5, -0.8 }, { 0.8, 2, 0.8 }) } }
  check(cup:render { width = 1, height = 1, output = "none" }:pixel(0, 0) == 0, "the wall of a cup throws a shadow into it")
end

-- A smooth mesh keeps its normals. A pattern uses the part's space and coordinates.
function tests.surfaces()
  local globe = glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 64, shading = "phong" }
  local hit, own = down(glint.difference { globe, ball(3, 0, 0, 1) }, 0.3, 0.2), down(globe, 0.3, 0.2)
  near(hit.t, own.t, 1e-14, "a smooth mesh")
  near(hit.normal.x, own.normal.x, 1e-14, "its normal")
  for name, want in pairs { u = 0.75, v = 0.25 } do
    local mapped = box(LOW, HIGH, { material = glint.material { diffuse = glint.pattern(function(_, s) return s.uv[name] end) },
      uv = { 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 1, 0, 1, 1, 1 } })
    near(color_at(glint.difference { mapped, ball(0, 1, 0, 0.2) }, 0.5, -0.5)[1], want, 1e-6, name)
  end
end

local function refused(text, f, ...)
  local ok, message = pcall(f, ...)
  check(not ok and message:find(text, 1, true), "%s expected, got %s", text, tostring(message))
end

function tests.errors()
  local open = { table.unpack(BOX_FACES, 1, 5) }
  local function mesh(faces, more) return box(LOW, HIGH, { faces = faces, name = more }) end
  refused("union: parts with an inside expected: a closed mesh, got mesh 'crate': its edge from {1, 1, -1} to {1, -1, -1} has 1 triangle", glint.union,
    { mesh(open, "crate") })
  refused("has 1 triangle", glint.difference, { ball(0, 0, 0, 1), glint.group { mesh(open) } })
  local turned = { table.unpack(BOX_FACES) }
  turned[TOP] = { 4, 8, 7, 3 }
  refused("has 2 triangles, not equally many in each direction along it", glint.union, { mesh(turned) })
  local fin = { table.unpack(BOX_FACES) }
  fin[7] = { 1, 2, 8 }
  refused("has 3 triangles", glint.union, { mesh(fin) })
  for _, shading in ipairs { "flat", "gouraud" } do
    refused('parts with an inside expected: shading = "faceted" or "phong", got mesh', glint.union, { box(LOW, HIGH, { shading = shading }) })
  end
  local part = box(LOW, HIGH)
  local whole = glint.union { part, name = "whole" }
  part.shading = "flat"
  refused('union \'whole\': parts with an inside expected: shading = "faceted" or "phong", got mesh', down, whole, 0, 0)
  local many = glint.union { ball(0, 0, 0, 1), name = "many" }
  for i = 1, 15 do many:add(box({ 2 * i, 0, 0 }, { 2 * i + 1, 1, 1 })) end
  check(down(many, 30.5, 0.5), "15 meshes and a ball")
  many:add(box({ 40, 0, 0 }, { 41, 1, 1 }))
  refused("union 'many': at most 64 parts expected", down, many, 0, 0)
  local corner = glint.mesh { vertices = corners(LOW, HIGH), faces = { BOX_FACES[BOTTOM], { 1, 5, 6, 2 } } }
  check(not down(glint.union { corner }, 0, 0), "two sheets back to back are closed, with nothing in them")
end

tally.run(tests)
tally.finish()
