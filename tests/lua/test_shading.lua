-- Flat and Gouraud shading against light computed here, for each face and vertex; neighbours must not shadow each
-- other, and a moving camera must not change the light.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

math.randomseed(11)
local function uniform(a, b) return a + (b - a) * math.random() end
local function vector(size) return { uniform(-size, size), uniform(-size, size), uniform(-size, size) } end
local function plus(a, b, s) return { a[1] + s * b[1], a[2] + s * b[2], a[3] + s * b[3] } end
local function minus(a, b) return plus(a, b, -1) end
local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
local function cross(a, b)
  return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end
local function times(a, s) return { a[1] * s, a[2] * s, a[3] * s } end
local function unit(a) return times(a, 1 / math.sqrt(dot(a, a))) end
local function xyz(v) return { v.x, v.y, v.z } end

-- Returns the bits of every pixel.
local function bits(image)
  local out = {}
  for y = 0, image.height - 1 do
    for x = 0, image.width - 1 do out[#out + 1] = string.pack("fff", image:pixel(x, y)) end
  end
  return table.concat(out)
end

-- ---- The truth ----

-- Returns where a segment from p to q hits the triangle, as a fraction of its length; nil: a miss.
local function crossing(p, q, a, b, c)
  local e, f, d = minus(b, a), minus(c, a), minus(q, p)
  local n = cross(e, f)
  local along = dot(n, d)
  if along == 0 then return nil end
  local t = -dot(n, minus(p, a)) / along
  local x = minus(plus(p, d, t), a)
  local u, v = dot(cross(x, f), n) / dot(n, n), dot(cross(e, x), n) / dot(n, n)
  if t <= 1e-9 or t >= 1 or u < 0 or v < 0 or u + v > 1 then return nil end
  return t
end

-- Returns the light that a site (a face or vertex) sends to the eye. Faces occlude unless they touch the site.
local function evaluate(model, site, normal, eye)
  local total = { 0, 0, 0 }
  for _, lamp in ipairs(model.lamps) do
    local dark = false
    for _, face in ipairs(model.faces) do
      for i = 2, #face - 1 do dark = dark or crossing(site, lamp, face[1], face[i], face[i + 1]) ~= nil end
    end
    local l, v = unit(minus(lamp, site)), unit(minus(eye, site))
    local nl = dot(normal, l)
    if not dark and nl > 0 then
      local cosine = 2 * nl * dot(normal, v) - dot(l, v) -- r.v
      if model.material.model == "blinn_phong" then cosine = dot(normal, unit(plus(l, v, 1))) end
      local highlight = 0.6 * math.max(cosine, 0) ^ 9
      for c, kd in ipairs { 0.9, 0.5, 0.2 } do total[c] = total[c] + kd * nl + highlight end
    end
  end
  return total
end

-- Returns the weights of the three corners at p, in the plane of the triangle.
local function weights(p, a, b, c)
  local n = cross(minus(b, a), minus(c, a))
  local v = dot(cross(minus(p, a), minus(c, a)), n) / dot(n, n)
  local w = dot(cross(minus(b, a), minus(p, a)), n) / dot(n, n)
  return 1 - v - w, v, w
end

local function centroid(face)
  local n, total, sum = { 0, 0, 0 }, 0, { 0, 0, 0 }
  for i = 2, #face - 1 do
    local area = cross(minus(face[i], face[1]), minus(face[i + 1], face[1]))
    local size = math.sqrt(dot(area, area))
    n, total = plus(n, area, 1), total + size
    for _, j in ipairs { 1, i, i + 1 } do sum = plus(sum, face[j], size / 3) end
  end
  return times(sum, 1 / total), unit(n)
end

-- ---- A folded sheet of planar quads, seen from anywhere ----

local function sheet()
  local model = { vertices = {}, numbers = {}, faces = {}, lamps = { vector(9), vector(9) } }
  local slope, columns, rows = {}, 4, 3
  for x = 1, columns + 1 do slope[x] = uniform(-0.7, 0.7) end
  for x = 1, columns + 1 do
    for y = 1, rows + 1 do table.insert(model.vertices, { x - 3, y - 2, slope[x] + 0.2 * y }) end
  end
  for x = 0, columns - 1 do
    for y = 1, rows do
      local first = x * (rows + 1) + y
      table.insert(model.numbers, { first, first + rows + 1, first + rows + 2, first + 1 })
    end
  end
  model.material = glint.material { diffuse = { 0.9, 0.5, 0.2 }, ambient = 0, specular = 0.6, shininess = 9,
    model = math.random(2) == 1 and "phong" or "blinn_phong" }
  return model
end

-- Makes a rotation about a random axis, then a translation: three rows and an offset.
local function random_map(turned, way)
  if not turned then return { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, way } end
  local x = unit(vector(1))
  local y = unit(cross(x, vector(1)))
  return { x, y, cross(x, y), way }
end

local function turned(map, v) return { dot(map[1], v), dot(map[2], v), dot(map[3], v) } end

local function as_transform(map)
  local rows = {}
  for i = 1, 3 do
    for j = 1, 3 do table.insert(rows, map[i][j]) end
    table.insert(rows, map[4][i])
  end
  return glint.matrix(rows)
end

-- Places the sheet with a map, and computes the normals of its vertices.
local function place(model, map)
  model.placed, model.faces, model.normals = {}, {}, {}
  for i, v in ipairs(model.vertices) do
    model.placed[i], model.normals[i] = plus(turned(map, v), map[4], 1), { 0, 0, 0 }
  end
  for _, face in ipairs(model.numbers) do
    local corners = {}
    for i, number in ipairs(face) do corners[i] = model.placed[number] end
    table.insert(model.faces, corners)
  end
end

local tests = {}

local function smooth(model)
  for _, face in ipairs(model.numbers) do
    for i = 2, #face - 1 do
      local a, b, c = model.vertices[face[1]], model.vertices[face[i]], model.vertices[face[i + 1]]
      local area = cross(minus(b, a), minus(c, a))
      for _, number in ipairs { face[1], face[i], face[i + 1] } do
        model.normals[number] = plus(model.normals[number], area, 1)
      end
    end
  end
end

-- Returns the light of both sides of each face or vertex for the eye: [1] with the normal, [-1] with its opposite.
local function light_sites(model, shading, eye)
  local out = { [1] = {}, [-1] = {} }
  for side, list in pairs(out) do
    for i, corners in ipairs(shading == "flat" and model.faces or model.placed) do
      local point, normal = corners, model.normals[i]
      if shading == "flat" then point, normal = centroid(corners) end
      list[i] = evaluate(model, point, times(unit(normal), side), eye)
    end
  end
  return out
end

-- Returns the interpolated value of a pixel that shows triangle `element` at `point`.
local function expect(model, shading, sites, element, point, eye)
  local face = (element + 1) // 2
  local _, normal = centroid(model.faces[face])
  sites = sites[dot(normal, minus(eye, point)) < 0 and -1 or 1]
  if shading == "flat" then return sites[face] end
  local numbers = model.numbers[face]
  local at = { numbers[1], numbers[2 + (element + 1) % 2], numbers[3 + (element + 1) % 2] }
  local w = { weights(point, model.placed[at[1]], model.placed[at[2]], model.placed[at[3]]) }
  local out = { 0, 0, 0 }
  for j = 1, 3 do out = plus(out, sites[at[j]], w[j]) end
  return out
end

local function against_truth(shading, round)
  local model = sheet()
  local map = random_map(round % 2 == 0, round % 3 == 0 and { 50, -20, 7 } or { 0, 0, 0 })
  place(model, map)
  smooth(model)
  for i, n in ipairs(model.normals) do model.normals[i] = turned(map, n) end
  local middle = map[4]
  for i, lamp in ipairs(model.lamps) do model.lamps[i] = plus(middle, lamp, 1) end
  local eye = plus(middle, vector(6), 1)
  local mesh = glint.mesh { vertices = model.vertices, faces = model.numbers, shading = shading, material = model.material }
  local scene = glint.scene { camera = glint.camera { eye = eye, at = middle, fov = 60 },
    glint.group { mesh, transform = as_transform(map) }, glint.point_light { position = model.lamps[1] },
    glint.point_light { position = model.lamps[2] } }
  local image = scene:render { width = 48, height = 40, output = "none" }
  local sites, worst, seen = light_sites(model, shading, eye), 0, 0
  local forward = unit(minus(middle, eye))
  local right = unit(cross(forward, { 0, 1, 0 }))
  local up = cross(right, forward)
  local half = math.tan(math.rad(30))
  for y = 0, 39 do
    for x = 0, 47 do
      local direction = plus(plus(forward, right, (2 * x + 1 - 48) / 40 * half), up, (40 - 2 * y - 1) / 40 * half)
      local hit = scene:cast(eye, direction)
      if hit then
        local want = expect(model, shading, sites, hit.element, xyz(hit.point), eye)
        local got = { image:pixel(x, y) }
        for c = 1, 3 do worst = math.max(worst, math.abs(got[c] - want[c]) / math.max(1, want[c])) end
        seen = seen + 1
      end
    end
  end
  return worst, seen
end

function tests.truth()
  for _, shading in ipairs { "flat", "gouraud" } do
    local seen = 0
    for round = 1, 24, tally.step do
      local worst, pixels = against_truth(shading, round)
      check(worst < 2e-6, "%s, round %d: %.3g off", shading, round, worst)
      seen = seen + pixels
    end
    check(seen * tally.step > 5000, "%s: %d pixels looked at", shading, seen)
  end
end

-- A ball's faces and vertices never shadow each other, at any position and size: if they face the light, they are lit.
function tests.no_shadow_by_neighbours()
  for _, case in ipairs { { 0, 1 }, { 1e7, 1 }, { 3, 1e-5 }, { -40, 1e5 } } do
    local at, size = case[1], case[2]
    for _, shading in ipairs { "flat", "gouraud" } do
      for _, precision in ipairs { "double", "float" } do
        local function picture(shadows)
          local center = { at, 2 * at, -at }
          return bits(glint.scene {
            camera = glint.camera { eye = plus(center, { 0, size, 4 * size }, 1), at = center },
            glint.sphere_mesh { center = center, radius = size, segments = 13, shading = shading },
            glint.directional_light { direction = { -1, -2, -1.5 }, shadows = shadows },
          }:render { width = 64, height = 48, output = "none", precision = precision })
        end
        check(picture(true) == picture(false), "%s at %g, size %g, %s", shading, at, size, precision)
      end
    end
  end
end

-- A floor of quads: an occluder shadows the faces below it, and no others.
function tests.shadows()
  local vertices, faces = {}, {}
  for z = 0, 4 do
    for x = 0, 4 do table.insert(vertices, { x, 0, z }) end
  end
  for z = 0, 3 do
    for x = 1, 4 do table.insert(faces, { 5 * z + x, 5 * z + x + 5, 5 * z + x + 6, 5 * z + x + 1 }) end
  end
  local function picture(shading)
    return glint.scene {
      camera = glint.camera { eye = { 2, 20, 2 }, at = { 2, 0, 2 }, up = { 0, 0, -1 }, projection = "orthographic", height = 4 },
      glint.mesh { vertices = vertices, faces = faces, shading = shading, material = glint.material { diffuse = 1, ambient = 0 } },
      glint.sphere { center = { 1, 30, 1 }, radius = 0.7 + 0.1 }, -- above the corner shared by four faces
      glint.directional_light { direction = { 0, -1, 0 } },
    }:render { width = 16, height = 16, output = "none" }
  end
  local flat, gouraud = picture "flat", picture "gouraud"
  for y = 0, 15 do
    for x = 0, 15 do
      local dark = x < 8 and y < 8 -- only the four faces around the corner are dark
      check(flat:pixel(x, y) == (dark and 0 or 1), "flat %d, %d: %g", x, y, (flat:pixel(x, y)))
    end
  end
  -- One vertex is dark; halfway to its neighbours the light is back to one half.
  check(math.abs(gouraud:pixel(4, 4) - 0.25) < 0.2 and gouraud:pixel(10, 10) == 1, "between a dark vertex and lit ones")
  check(gouraud:pixel(3, 3) < gouraud:pixel(1, 1) and gouraud:pixel(1, 1) < 1, "it grows away from the dark one")
end

-- A corner with its own normal is a separate vertex: a box with eight vertices and a normal for each corner of a face
-- equals one with 24 vertices.
function tests.corner_normals()
  local corners, faces, normals, apart, each, own = {}, {}, {}, {}, {}, {}
  for i = 0, 7 do corners[i + 1] = { i % 2 * 2 - 1, i // 2 % 2 * 2 - 1, i // 4 * 2 - 1 } end
  for axis = 0, 2 do
    for side = 0, 1 do
      local face, n = {}, { 0, 0, 0 }
      n[axis + 1] = 2 * side - 1
      for _, step in ipairs { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } } do
        local number = 1 + (side << axis) + (step[1] << (axis + 1) % 3) + (step[2] << (axis + 2) % 3)
        table.insert(face, number)
        table.insert(normals, n)
        table.insert(apart, corners[number])
        table.insert(own, n)
      end
      table.insert(faces, face)
      table.insert(each, { #apart - 3, #apart - 2, #apart - 1, #apart })
    end
  end
  local function picture(mesh)
    mesh.shading, mesh.material = "gouraud", glint.material { specular = 0.5 }
    return bits(glint.scene { camera = glint.camera { eye = { 3, 4, 5 }, at = { 0, 0, 0 } }, glint.mesh(mesh),
      glint.point_light { position = { 2, 5, 3 } } }:render { width = 40, height = 40, output = "none" })
  end
  local shared = picture { vertices = corners, faces = faces, normals = normals }
  check(shared == picture { vertices = apart, faces = each, normals = own }, "a box of shared vertices")
  check(shared ~= picture { vertices = corners, faces = faces }, "is not one of smooth corners")
end

-- A vertex's normal may be tilted so far from the eye that it points away from the halfway vector: (n.h) < 0 and no
-- highlight, however broad.
function tests.normals_that_look_away()
  local lean, v = unit { 2, 0, 1 }, unit { -8, 0, 1 }
  for _, lamp in ipairs { { -0.4, 0, 1 }, { 1, 0, 1 } } do
    local l = unit(lamp)
    local want = math.max(dot(lean, unit(plus(l, v, 1))), 0)
    for _, precision in ipairs { "double", "float" } do
      local image = glint.scene { camera = glint.camera { eye = times(v, 8), at = { 0, 0, 0 } },
        glint.mesh { vertices = { { -9, -9, 0 }, { 9, -9, 0 }, { 0, 9, 0 } }, faces = { { 1, 2, 3 } },
          normals = { lean, lean, lean }, shading = "phong",
          material = glint.material { diffuse = 0, specular = 1, shininess = 1, model = "blinn_phong" } },
        glint.directional_light { direction = times(l, -1), shadows = false },
      }:render { width = 1, height = 1, output = "none", precision = precision }
      check(math.abs(image:pixel(0, 0) - want) < 1e-6, "%g, expected %g", image:pixel(0, 0), want)
    end
  end
end

-- Passes sum up to beauty, samples average, and the backs of one-sided faces have only ambient light.
function tests.terms()
  local ball = glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 10, shading = "gouraud",
    material = glint.material { diffuse = 0.7, specular = 0.5, ambient = 0.3 } }
  local scene = glint.scene { camera = glint.camera { eye = { 0, 1, 5 }, at = { 0, 0, 0 }, fov = 30 }, ambient = 0.5,
    ball, glint.point_light { position = { 3, 5, 6 } } }
  local function pass(name, samples)
    return scene:render { width = 24, height = 24, samples = samples, passes = name, output = "none" }
  end
  for _, samples in ipairs { 1, 4 } do
    local beauty = pass("beauty", samples)
    local ambient, diffuse, specular = pass("ambient", samples), pass("diffuse", samples), pass("specular", samples)
    local same, shiny = true, 0
    for y = 0, 23 do
      for x = 0, 23 do
        local function f32(v) return (string.unpack("f", string.pack("f", v))) end
        local sum = f32(f32(ambient:pixel(x, y, "ambient") + diffuse:pixel(x, y, "diffuse")) + specular:pixel(x, y, "specular"))
        same = same and sum == beauty:pixel(x, y)
        shiny = math.max(shiny, (specular:pixel(x, y, "specular")))
      end
    end
    check(same and shiny > 0.05, "%d samples: terms add up, %g of specular", samples, shiny)
  end
  for _, shading in ipairs { "flat", "gouraud" } do
    local inside = glint.scene { camera = glint.camera { eye = { 0, 0, 0 }, at = { 0, 0, 1 } }, ambient = 0.5,
      glint.sphere_mesh { center = { 0, 0, 0 }, radius = 3, segments = 8, shading = shading, two_sided = false },
      glint.point_light { position = { 0, 0.5, 0 } } }
    local image = inside:render { width = 4, height = 4, output = "none" }
    check(math.abs(image:pixel(2, 2) - 0.4) < 1e-6, "%s: the back of a one-sided mesh", shading)
  end
end

-- ---- The stages of a frame, and reused stages ----

local scratch = os.getenv "SCRATCH" or os.tmpname() .. ".d"
os.execute("mkdir -p '" .. scratch .. "'")
local command = (os.getenv "BUILD" or "build") .. "/glint"

local function run(script, options)
  local path = scratch .. "/scene.lua"
  local file = assert(io.open(path, "w"))
  file:write(script)
  file:close()
  local out = assert(io.popen(("'%s' '%s' --json -o none %s 2>&1"):format(command, path, options or "")))
  local text = out:read "a"
  out:close()
  return text
end

local MOVING = [[
  local glint = require "glint"
  local ball = glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 12, shading = "SHADING",
    material = glint.material { specular = SPECULAR } }
  local lamp = glint.point_light { position = { 3, 5, 6 } }
  local camera = glint.camera { eye = { 0, 1, 5 }, at = { 0, 0, 0 } }
  local scene = glint.scene { camera = camera, ball, lamp }
  return glint.animation { scene = scene, frames = 3, width = 64, height = 48, frame = function(_, n)
    if "MOVE" == "lamp" then lamp.x = n else camera.eye = { 0.01 * n, 1, 5 } end
  end }
]]

function tests.reuse()
  for _, case in ipairs {
    { "flat", "0", "camera", "reused" }, { "gouraud", "0", "camera", "reused" },
    { "gouraud", "0.5", "camera", "run" }, { "gouraud", "0", "lamp", "run" },
  } do
    local script = MOVING:gsub("SHADING", case[1]):gsub("SPECULAR", case[2]):gsub("MOVE", case[3])
    local text, states = run(script), {}
    for state in text:gmatch '"vertex":"(%a+)"' do states[#states + 1] = state end
    -- Faces are computed when they become visible. Nearly all faces were visible before.
    local last = states[3] == "partial" and "reused" or states[3]
    check(states[1] == "run" and last == case[4], "%s, specular %s, %s: %s", case[1], case[2], case[3],
      table.concat(states, " ") .. text:sub(1, 300))
  end
end

function tests.called_for()
  for _, shading in ipairs { "faceted", "phong" } do
    local script = MOVING:gsub("SHADING", shading):gsub("SPECULAR", "0"):gsub("MOVE", "lamp")
    check(not run(script):find '"vertex"', "%s: no such stage", shading)
  end
  local script = MOVING:gsub("SHADING", "flat"):gsub("SPECULAR", "0"):gsub("MOVE", "lamp")
  local path = scratch .. "/scene.lua"
  run(script)
  local out = assert(io.popen(("'%s' explain '%s'"):format(command, path)))
  local text = out:read "a"
  out:close()
  check(text:find "flat shading" and text:find "vertex", "explain: %s", text)
end

-- ---- Smooth normals of a stretched mesh: interpolated in its own space, then mapped ----

do
  local corners = { unit { 0.3, -0.2, 1 }, unit { -0.6, 0.1, 1 }, unit { 0.2, 0.7, 0.8 } }
  local map = glint.translate(0.5, -1, 2) * glint.scale(2, 3, 0.25)
  local function between(shares, lengths) -- blends normals under diag(1/2, 1/3, 4); with lengths: unnormalised
    local sum = { 0, 0, 0 }
    for i, n in ipairs(corners) do
      local m = { n[1] / 2, n[2] / 3, n[3] * 4 }
      sum = plus(sum, lengths and m or unit(m), shares[i])
    end
    return unit(sum)
  end
  for _, way in ipairs { "transform", "group", "mirrored" } do
    local mesh = glint.mesh { vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, faces = { { 1, 2, 3 } }, normals = corners,
      shading = "phong" }
    local shown = mesh
    if way == "group" then shown = glint.group { mesh, transform = map } else mesh.transform = map end
    if way == "mirrored" then shown = glint.group { mesh, transform = glint.scale(-1, 1, 1) } end
    local sign = way == "mirrored" and -1 or 1
    local image = glint.scene { camera = glint.camera { eye = { sign * 1.1, 0.05, 9 }, direction = { 0, 0, -1 }, projection = "orthographic",
      height = 0.6 }, ambient = 1, shown }:render { width = 5, height = 5, output = "none", passes = "normal" }
    local worst, least = 0, math.huge
    for y = 0, 4 do
      for x = 0, 4 do
        local wx, wy = sign * 1.1 + (x - 2) * 0.12, 0.05 - (y - 2) * 0.12
        local u, v = (sign * wx - 0.5) / 2, (wy + 1) / 3
        local shares = { 1 - u - v, u, v }
        local want, other = between(shares, true), between(shares, false)
        local got = { image:pixel(x, y, "normal") }
        got[1] = got[1] * sign
        worst = math.max(worst, math.abs(got[1] - want[1]), math.abs(got[2] - want[2]), math.abs(got[3] - want[3]))
        least = math.min(least, math.abs(other[1] - want[1]) + math.abs(other[2] - want[2]))
      end
    end
    check(worst < 1e-6, "stretched by a %s: normals %.3g off", way, worst)
    check(least > 1e-3, "stretched by a %s: normals made unit before would be %.3g off", way, least)
  end
end

-- ---- Identical bits in mirrors, instances, threads and soft light ----

local BITS = [[
  local glint = require "glint"
  local function ball(x, shading)
    return glint.sphere_mesh { center = { x, 0, 0 }, radius = 0.9, segments = 14, shading = shading,
      material = glint.material { diffuse = { 0.8, 0.5, 0.3 }, specular = 0.5, mirror = shading == "flat" and 0.2 or nil } }
  end
  local pair = glint.group { ball(-1, "flat"), ball(1, "gouraud") }
  local scene = glint.scene { camera = glint.camera { eye = { 0, 3, 9 }, at = { 0, 0, 0 } }, ambient = 0.1,
    glint.group { pair, transform = glint.translate(-2, 0, 0) },
    glint.group { pair, transform = glint.translate(2, 0.5, -1) * glint.rotate("y", 40) * glint.scale(1, 1.5, 1) },
    glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = glint.material { mirror = 0.5 } },
    glint.sphere { center = { 0, 2, 1 }, radius = 0.4, material = glint.material { transmission = { 0.2, 0.9, 0.3 } } },
    glint.sphere_light { position = { 4, 6, 5 }, radius = 1, samples = 4 },
    glint.point_light { position = { -4, 3, 6 }, intensity = 0.5 } }
  scene:render { width = WIDTH, height = HEIGHT, samples = SAMPLES, precision = "PRECISION" }
]]

function tests.bits()
  for _, case in ipairs { { "1", "double" }, { "2", "float" } } do
    local script = BITS:gsub("SAMPLES", case[1]):gsub("PRECISION", case[2])
      :gsub("WIDTH", tally.side(90)):gsub("HEIGHT", tally.side(70))
    local want
    for _, isa in ipairs(tally.instruction_sets) do
      for _, threads in ipairs { 1, 3 } do
        local path = ("%s/%s-%d.png"):format(scratch, isa, threads)
        os.remove(path)
        local file = assert(io.open(scratch .. "/scene.lua", "w"))
        file:write(script)
        file:close()
        os.execute(("GLINT_ISA=%s '%s' '%s/scene.lua' -t %d --bits 16 --quiet -o '%s' 2>'%s/errors'"):format(isa, command, scratch,
          threads, path, scratch))
        local picture = io.open(path, "rb")
        local got = picture and picture:read "a"
        if picture then picture:close() end
        if not got then
          local errors = assert(io.open(scratch .. "/errors")):read "a"
          check(errors:find "lacks", "%s: %s", isa, errors)
        else
          want = want or got
          check(got == want, "%s, %d threads, %s samples, %s", isa, threads, case[1], case[2])
        end
      end
    end
  end
end

-- Points of a mesh with `terminator` move to the curved surface: by Hanika's formula, in front and behind, which a lamp
-- with attenuation shows as a distance. Corners are at -1 and 1 of an orthographic picture of 200 x 200 pixels.
function tests.terminator()
  local corners = { { -1, -1, 0 }, { 1, -1, 0.2 }, { 0, 1, -0.1 } }
  local normals = { unit { -0.5, -0.3, 1 }, unit { 0.6, -0.2, 1 }, unit { 0.1, 0.7, 1 } }
  for _, z in ipairs { 5, -5 } do
    local lamp = { 0.3, 0.4, z / 4 }
    for _, share in ipairs { 0, 0.5, 1 } do
      local scene = glint.scene {
        camera = glint.camera { eye = { 0, 0, z }, at = { 0, 0, 0 }, projection = "orthographic", height = 2 },
        glint.point_light { position = lamp, attenuation = { 0, 0, 1 } },
        glint.mesh { vertices = corners, faces = { { 1, 2, 3 } }, normals = normals, terminator = share,
          material = glint.material { diffuse = 1 } },
      }
      local image = scene:render { width = 200, height = 200, output = "none" }
      for _, at in ipairs { { 100, 110 }, { 60, 180 }, { 130, 120 }, { 95, 30 } } do
        local x, y = (at[1] + 0.5) / 100 - 1, 1 - (at[2] + 0.5) / 100
        if z < 0 then x = -x end
        -- weights of the corners: x = w2 - w1, y = 2 w3 - 1
        local w3 = (y + 1) / 2
        local w = { (1 - w3 - x) / 2, (1 - w3 + x) / 2, w3 }
        local p, n, moved = { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 }
        for j = 1, 3 do
          p = plus(p, corners[j], w[j])
          n = plus(n, normals[j], z > 0 and w[j] or -w[j])
        end
        for j = 1, 3 do
          local own = times(normals[j], z > 0 and 1 or -1)
          moved = plus(moved, own, -w[j] * math.min(0, dot(minus(p, corners[j]), own)))
        end
        local to_lamp = minus(lamp, plus(p, moved, share))
        local want = math.max(dot(unit(n), to_lamp), 0) / dot(to_lamp, to_lamp) ^ 1.5
        local got = image:pixel(at[1], at[2])
        check(math.abs(got - want) <= 1e-6 * want, "eye at %g, terminator %g, pixel %d, %d: %g, not %g", z, share, at[1], at[2],
          got, want)
      end
    end
  end
  -- A coarse ball has no shadow on itself where its shading is lit; another ball's shadow stays.
  local function dark(terminator, shadows, ...)
    local scene = glint.scene {
      camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 }, fov = 26 },
      glint.directional_light { direction = { -1, -0.3, -0.2 }, shadows = shadows },
      glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 16, terminator = terminator }, ...,
    }
    local image, count = scene:render { width = 120, height = 120, output = "none" }, 0
    for y = 0, 119 do
      for x = 0, 119 do count = count + (image:pixel(x, y) > 0 and 0 or 1) end
    end
    return count
  end
  local lit = dark(0, false)
  check(dark(0, true) > lit + 100, "steps at the terminator")
  check(dark(1, true) == lit, "no steps with terminator = 1: %d, not %d", dark(1, true), lit)
  check(dark(1, true, glint.sphere { center = { 2, 0.6, 0.4 }, radius = 0.3 }) > lit + 30, "a shadow of another ball")
  for field, value in pairs { transmission = 0.5, opacity = 0.5 } do
    local scene = glint.scene { glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 8, terminator = 1, name = "pane",
      material = glint.material { [field] = value } } }
    local good, message = pcall(scene.render, scene, { width = 8, height = 8, output = "none" })
    check(not good and message:find("mesh pane.terminator: expected 0", 1, true), "%s: %s", field, message)
  end
end

local only = arg[1]
for _, name in ipairs { "truth", "no_shadow_by_neighbours", "shadows", "corner_normals", "terms", "reuse", "called_for", "bits", "terminator" } do
  if not only or only == name then tests[name]() end
end
os.execute("rm -rf '" .. scratch .. "'")
tally.finish()
