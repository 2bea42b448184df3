-- Indirect light against closed forms: uniform enclosures, planes and balls under a uniform sky, parallel plates, a
-- glowing ball above a floor; the convergence rate; and identical pictures in every configuration.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local function near3(r, g, b, want, tolerance, name)
  for c, got in ipairs { r, g, b } do near(got, want[c], tolerance, name .. ", channel " .. c) end
end

local LOSS = 2 ^ -20 -- largest error: the light that dropped weak paths may carry
local ROUNDING = 2 ^ -23 -- rounding error of a float32 near 1

local function ball(radius, material, center)
  return glint.sphere { center = center or { 0, 0, 0 }, radius = radius, material = material }
end
local function floor(material, y, up)
  return glint.plane { point = { 0, y or 0, 0 }, normal = { 0, up or 1, 0 }, material = material }
end

-- Renders a small picture of a scene, seen from `eye`.
local function look(eye, direction, fields, more)
  fields.camera = glint.camera { eye = eye, direction = direction, fov = 40, up = { 0, 0.1, 1 } }
  local options = { width = 9, height = 7, output = "none", passes = "beauty,ambient,diffuse,indirect,mirror,transmission" }
  for name, value in pairs(more or {}) do options[name] = value end
  local scene = glint.scene(fields)
  return scene:render(options), scene
end

-- ---- Uniform enclosures: exact geometric series ---------------------------------------------------------------------

local kd = { 0.5, 0.25, 0.75 }
local function series(first, bounces)
  local out = {}
  for c = 1, 3 do
    out[c] = 0
    for b = 0, bounces do out[c] = out[c] + first[c] * kd[c] ^ b end
  end
  return out
end
local function plain(fields)
  fields.diffuse = fields.diffuse or kd
  return glint.material(fields)
end

-- Each wall point of a ball with a light at its centre has n.l = 1, and so does each point that it sees.
for _, precision in ipairs { "double", "float" } do
  for _, bounces in ipairs { 1, 2, 5, 40 } do
    local image = look({ 0.3, 0.2, 0.1 }, { 1, 0, 0 }, {
      indirect = { samples = 3, bounces = bounces }, glint.point_light { position = { 0, 0, 0 } }, ball(2, plain {}),
    }, { precision = precision })
    local name = ("lamp in a ball, %s, %d bounces"):format(precision, bounces)
    for x = 0, 8, 4 do
      local r, g, b = image:pixel(x, x % 7)
      near3(r, g, b, series(kd, bounces), 4 * ROUNDING + 4 * LOSS, name)
    end
  end
end

-- The walls' emission: the excess of `ambient` over `diffuse`. At the end of a path, Ia replaces the rest of the
-- light: if Ia equals the enclosure's light, the number of bounces does not matter.
do
  local glow, own = { 0.5 + 0.25, 0.25 + 0.5, 0.75 + 0.125 }, { 0.25, 0.5, 0.125 }
  for _, bounces in ipairs { 1, 3, 60 } do
    local image = look({ 0, 0, 0 }, { 0, 0, 1 }, {
      ambient = 1, indirect = { samples = 2, bounces = bounces }, ball(3, plain { ambient = glow }),
    })
    local want = series(own, bounces)
    for c = 1, 3 do want[c] = want[c] + kd[c] ^ (bounces + 1) end
    local r, g, b = image:pixel(4, 3)
    near3(r, g, b, want, 4 * ROUNDING + 4 * LOSS, "glowing walls, bounces " .. bounces)
    r, g, b = image:pixel(4, 3, "ambient")
    near3(r, g, b, own, ROUNDING, "their own light stays")
    if bounces == 60 then near3(r / 0.5, g / 0.75, b / 0.25, { 0.5, 2 / 3, 0.5 }, ROUNDING, "ambient / (1 - kd)") end
    image = look({ 0, 0, 0 }, { 0, 0, 1 }, {
      ambient = { 0.5, 0.5, 0.5 }, indirect = { samples = 2, bounces = bounces },
      glint.point_light { position = { 0, 0, 0 }, intensity = 0.5 }, ball(3, plain { diffuse = 0.5 }),
    })
    near(image:pixel(4, 3), 0.5, 2 * ROUNDING + LOSS, "an even state, bounces " .. bounces)
  end
end

-- ---- Under a uniform sky --------------------------------------------------------------------------------------------

local sky = { 0.5, 1, 2 }
local under_sky = { kd[1] * sky[1], kd[2] * sky[2], kd[3] * sky[3] }
local shapes = {
  plane = floor(plain {}, 0),
  ball = ball(2, plain {}, { 0, -2, 0 }),
  box = glint.box { min = { -2, -4, -2 }, max = { 2, 0, 2 }, material = plain {} },
  cone = glint.cone { base = { 0, -4, 0 }, top = { 0, 0.5, 0 }, radius = 3, material = plain {} },
  ellipsoid = glint.sphere { center = { 0, 0, 0 }, radius = 1, material = plain {},
    transform = glint.translate(0, -1, 0) * glint.rotate("z", 20) * glint.scale(3, 1, 2) },
  ["flat mesh"] = glint.sphere_mesh { center = { 0, -2, 0 }, radius = 2, segments = 12, shading = "flat", material = plain {} },
  ["one-sided mesh"] = glint.mesh { vertices = { { -9, 0, -9 }, { 9, 0, -9 }, { 0, 0, 9 } }, faces = { { 1, 3, 2 } },
    two_sided = false, material = plain {} },
}
for name, shape in pairs(shapes) do
  for _, precision in ipairs { "double", "float" } do
    local image = look({ 0.2, 5, 0.3 }, { 0.02, -1, 0 }, {
      ambient = 0.3, background = sky, indirect = { samples = 5, bounces = 2 }, shape,
    }, { precision = precision, samples = 2 })
    local r, g, b = image:pixel(4, 3)
    near3(r, g, b, under_sky, 2 * ROUNDING, name .. " under an even sky, " .. precision)
  end
end

-- ---- Parallel plates: every path from one leads to the other --------------------------------------------------------

do -- matt below, matt above: L1 = e1 + k1 L2, L2 = e2 + k2 L1
  local low = glint.material { diffuse = 0.5, ambient = 0.75 }
  local high = glint.material { diffuse = 0.25, ambient = 0.75 }
  local image = look({ 0, 1, 0 }, { 0, -1, 0.1 }, {
    ambient = 1, indirect = { samples = 4, bounces = 50 }, floor(low, 0), floor(high, 2, -1),
  })
  near(image:pixel(4, 3), (0.25 + 0.5 * 0.5) / (1 - 0.5 * 0.25), 2 * ROUNDING + LOSS, "matt plates")
end
do -- a mirror above: the floor's light returns to the floor without another bounce
  local image = look({ 0, 1, 0 }, { 0, -1, 0.1 }, {
    ambient = 1, indirect = { samples = 4, bounces = 30 }, floor(glint.material { diffuse = 0.5, ambient = 0.75 }, 0),
    floor(glint.material { diffuse = 0, mirror = 0.5 }, 2, -1),
  }, { max_depth = 30 })
  near(image:pixel(4, 3), 0.25 / (1 - 0.25), 2 * ROUNDING + LOSS, "a mirror above")
  local seen = look({ 0, 1, 0 }, { 0, 1, 0.1 }, {
    ambient = 1, indirect = { samples = 4, bounces = 30 }, floor(glint.material { diffuse = 0.5, ambient = 0.75 }, 0),
    floor(glint.material { diffuse = 0, mirror = 0.5 }, 2, -1),
  }, { max_depth = 30 })
  near(seen:pixel(4, 3, "mirror"), 0.5 * 0.25 / (1 - 0.25), 2 * ROUNDING + 4 * LOSS, "and what it shows")
  check(seen:pixel(4, 3, "indirect") == 0, "a mirror without diffuse has no indirect light of its own")
end
do -- non-refracting glass between floor and sky, which tints its shadow and its transmitted light equally
  local pane = glint.material { diffuse = 0, transmission = { 0.5, 0.8, 0.2 }, ior = 1 }
  local image = look({ 0, 1, 0 }, { 0, -1, 0.1 }, {
    background = 1, indirect = { samples = 4, bounces = 3 }, floor(plain {}, 0), floor(pane, 2),
  })
  local r, g, b = image:pixel(4, 3)
  near3(r, g, b, { 0.25, 0.2, 0.15 }, 2 * ROUNDING, "through a pane")
end
do -- a surface that scatters, reflects and transmits: the path chooses at random, and the average is right
  local mixed = glint.material { diffuse = { 0.3, 0.1, 0.2 }, ambient = 0, mirror = { 0.1, 0.4, 0.2 }, transmission = 0.25, ior = 1 }
  local image = look({ 0, 1, 0 }, { 0, -1, 0.1 }, {
    background = 1, indirect = { samples = 256, bounces = 1 },
    floor(glint.material { diffuse = 1, ambient = 0 }, 0), floor(mixed, 2, -1),
  }, { samples = 16 })
  local sum = { 0, 0, 0 }
  for y = 0, 6 do
    for x = 0, 8 do
      for c, got in ipairs { image:pixel(x, y, "indirect") } do sum[c] = sum[c] + got / 63 end
    end
  end
  -- After `mixed`, a path with one bounce ends if scattered, ends on the floor if reflected, or reaches the sky.
  near3(sum[1], sum[2], sum[3], { 0.25, 0.25, 0.25 }, 2e-3, "a mixed surface, one bounce")
end

-- ---- A glowing ball above a floor: the hemisphere integral kd L (R / d)^2 cos ---------------------------------------

-- Returns the root mean square error of the whole picture.
local function error_of_ball(samples, pixel_samples, seed)
  local height, radius = 2, 1.2
  local image = look({ 0, 8, 0 }, { 0, -1, 0 }, {
    ambient = 1, indirect = { samples = samples, bounces = 1 },
    floor(glint.material { diffuse = 0.5, ambient = 0 }, 0),
    ball(radius, glint.material { diffuse = 0, ambient = 1 }, { 4, height, 0 }),
  }, { width = 48, height = 48, samples = pixel_samples, seed = seed })
  local half, sum, count = 8 * math.tan(math.rad(20)), 0, 0
  for y = 0, 47 do
    for x = 0, 47 do
      -- Seen from above, with the top of the picture towards +z, right is -x.
      local px, pz = (2 * (x + 0.5) / 48 - 1) * half, (1 - 2 * (y + 0.5) / 48) * half
      local right, up = -px, pz
      local d2 = (right - 4) ^ 2 + height ^ 2 + up ^ 2
      local want = 0.5 * radius ^ 2 / d2 * height / math.sqrt(d2)
      local got, _, _ = image:pixel(x, y, "indirect")
      if math.abs(right - 4) + math.abs(up) > 2.2 then
        sum = sum + (got - want) ^ 2
        count = count + 1
      end
    end
  end
  check(count > 1500, "most of the floor is compared, %d points", count)
  return math.sqrt(sum / count)
end
do
  local four, coarse, fine, finest = error_of_ball(4, 1), error_of_ball(16, 1), error_of_ball(64, 1), error_of_ball(1024, 1)
  check(fine < four / 4 * 1.1, "error: 4 ways %g, 64 ways %g", four, fine)
  check(finest < coarse / 8, "error: 16 ways %g, 1024 ways %g", coarse, finest)
  check(finest < fine / 4.5, "better than the root: 64 ways %g, 1024 ways %g", fine, finest)
  check(finest < 1.5e-3, "it converges to the integral: %g", finest)
  local both = error_of_ball(16, 16) -- the samples of a pixel are additional samples of the hemisphere
  check(both < fine / 1.5, "16 ways for 16 samples %g, 64 for one %g", both, fine)
  local other = error_of_ball(64, 1, 3)
  check(other ~= fine and other < 1.5 * fine and fine < 1.5 * other, "seeds are equally good: %g, %g", fine, other)
end

-- An area light shines on surfaces that light others: each path uses one of its samples, in rotation.
do
  local image = look({ 2.9, 0, 0 }, { 1, 0, 0 }, {
      indirect = { samples = 256, bounces = 1 }, ball(3, plain { diffuse = 0.5 }),
      glint.sphere_light { position = { 0, 0, 0 }, radius = 0.5, samples = 256, radiance = 1 / math.pi },
    }, { samples = 4 })
  local first = image:pixel(4, 3, "diffuse")
  near(first, 0.5 / 36, 1e-4, "a ball light in a ball")
  local sum = 0
  for x = 0, 8 do
    for y = 0, 6 do sum = sum + image:pixel(x, y, "indirect") / 63 end
  end
  near(sum, 0.25 / 36, 1e-4, "and what the ball sends back: half")
end

-- A visible light counts once: points receive its light directly, not through paths that hit its surface.
do
  local function plain_room(visible)
    local room = {
      indirect = { samples = 8, bounces = 2 }, ball(3, plain { diffuse = 0.5, mirror = 0.2 }),
      glint.sphere_light { position = { 0, 0, 0 }, radius = 1, samples = 4, radiance = 1, visible = visible },
    }
    return (look({ 2.9, 0, 0 }, { 1, 0, 0 }, room, { max_depth = 0 }))
  end
  local seen, unseen, same = plain_room(true), plain_room(false), 0
  for x = 0, 8 do
    for y = 0, 6 do same = same + (seen:pixel(x, y) == unseen:pixel(x, y) and 1 or 0) end
  end
  check(same == 63, "a light that is seen counts once: %d of 63 pixels", same)
end

-- ---- Only when needed, depth, sums, wrong input ---------------------------------------------------------------------

local function off(scene)
  return scene:render { width = 16, height = 12, output = "none", passes = "beauty,ambient,indirect" }
end
do
  local objects = { ambient = 0.5, background = 0.25, floor(plain {}, 0), ball(1, plain {}, { 0, 1, -4 }) }
  local _, scene = look({ 0, 2, 0 }, { 0, -0.4, -1 }, objects)
  local without = off(scene)
  scene.indirect = { samples = 4, bounces = 0 }
  local zero = off(scene)
  scene.indirect = { samples = 4, bounces = 1 }
  local one = off(scene)
  local same, differ = true, false
  for y = 0, 11 do
    for x = 0, 15 do
      same = same and without:pixel(x, y) == zero:pixel(x, y) and zero:pixel(x, y, "indirect") == 0
      differ = differ or without:pixel(x, y) ~= one:pixel(x, y)
    end
  end
  check(same, "0 bounces: as without, and the pass is black")
  check(differ and one:pixel(8, 11, "ambient") == 0 and one:pixel(8, 11, "indirect") > 0, "1: ambient light is replaced")
  scene.indirect = nil
  check(scene.indirect == nil, "nil turns it off")
end
do -- a long path in a white room ends at random; the mirror depth also limits paths
  local image = look({ 0, 0, 0 }, { 1, 0, 0 }, {
    indirect = { samples = 1, bounces = 2 ^ 31 }, glint.point_light { position = { 0, 0, 0 } }, ball(2, plain { diffuse = 0.9 }),
  })
  near(image:pixel(4, 3), 9, 1e-4, "as many bounces as there are")
  local mirrors = { indirect = { samples = 2, bounces = 1 }, floor(glint.material { diffuse = 0.5 }, 0),
    floor(glint.material { diffuse = 0, mirror = 1 }, 1, -1), background = 1 }
  image = look({ 0, 0.5, 0 }, { 0, -1, 0 }, mirrors, { max_depth = 0 })
  check(image:pixel(4, 3) == 0, "no way beyond a mirror at depth 0")
end
do -- passes sum to the picture
  local terms = { "background", "ambient", "diffuse", "specular", "indirect", "mirror", "transmission" }
  local image = look({ 0, 2, 6 }, { 0, -0.2, -1 }, {
    ambient = 0.2, background = { 0.1, 0.2, 0.3 }, indirect = { samples = 3, bounces = 2 },
    glint.point_light { position = { 3, 5, 4 } }, floor(plain { specular = 0.3, ambient = 0.9 }, 0),
    ball(1, plain { mirror = 0.3, transmission = 0.3, specular = 0.5 }, { 0, 1, 0 }),
  }, { width = 16, height = 16, samples = 3, passes = "beauty," .. table.concat(terms, ",") })
  local sums = 0
  for y = 0, 15 do
    for x = 0, 15 do
      local sum = 0
      for _, term in ipairs(terms) do sum = string.unpack("f", string.pack("f", sum + image:pixel(x, y, term))) end
      sums = sums + (sum == image:pixel(x, y) and 1 or 0)
    end
  end
  check(sums == 256, "passes sum to the picture: %d of 256", sums)
end

local raises = tally.raises
local scene = glint.scene {}
local function set(value) scene.indirect = value end
check(scene.indirect == nil, "off by default")
raises("scene.indirect: table expected, got 16", set, 16)
raises("scene.indirect: table expected, got true", set, true)
raises("scene.indirect.sample: no such field; did you mean 'samples'?", set, { sample = 3 })
raises("scene.indirect.samples: whole number 1 .. 65536 expected, got 0", set, { samples = 0 })
raises("scene.indirect.samples: whole number 1 .. 65536 expected, got 1000000000", set, { samples = 1e9 })
raises("scene.indirect.bounces: whole number 0 .. 2147483648 expected, got -1", set, { bounces = -1 })
raises("scene.indirect.bounces: whole number 0 .. 2147483648 expected, got 1.5", set, { bounces = 1.5 })
raises("scene.indirect.bounces: finite number expected", set, { bounces = 0 / 0 })
raises("scene.indirect.samples: number expected, got string", set, { samples = "16" })
raises("scene.indirect", glint.scene, { indirect = { 16, 2 } })
check(scene.indirect == nil, "a refused value changes nothing")
scene.indirect = {}
check(scene.indirect.samples == 16 and scene.indirect.bounces == 2, "defaults 16 and 2")
scene.indirect = { samples = 5, bounces = 7 }
raises("indirect: assign a whole table", function() scene.indirect.samples = 3 end)
raises("indirect: assign a whole table", function() scene.indirect.colour = 3 end)
local read = 0
for name, value in pairs(scene.indirect) do read = read + (name == "samples" and value or 10 * value) end
check(read == 75, "pairs reads both fields")
local copy = glint.scene { indirect = scene.indirect }
check(copy.indirect.samples == 5 and copy.indirect.bounces == 7, "what was read may be assigned")
do -- a finalizer changes the scene while the engine reads a table
  local busy = glint.scene { camera = glint.camera { eye = { 0, 0, 1 }, at = { 0, 0, 0 } } }
  for _ = 1, 200 do
    setmetatable({}, { __gc = function() busy.camera = glint.camera { eye = { 0, 0, 2 }, at = { 0, 0, 0 } } end })
    busy.indirect = { samples = 3 }
    if _ % 20 == 0 then collectgarbage() end
  end
  check(busy.indirect.samples == 3 and busy.camera.eye.z == 2, "finalizers may change the scene")
end

-- ---- clamp ----------------------------------------------------------------------------------------------------------

-- In a ball whose walls glow with kd Ia, each path brings kd^(bounces + 1) Ia, so the limit is exact and keeps the colour.
for bounces = 1, 2 do
  for _, clamp in ipairs { 0, 0.25, 1, 100 } do
    local image = look({ 0.3, 0.2, 0.1 }, { 1, 0, 0 },
      { ambient = 8, indirect = { samples = 3, bounces = bounces }, ball(2, plain {}) }, { clamp = clamp, samples = 2 })
    local want, most = {}, 0
    for c = 1, 3 do
      want[c] = 8 * kd[c] ^ (bounces + 1)
      most = math.max(most, want[c])
    end
    for c = 1, 3 do want[c] = want[c] * (clamp > 0 and math.min(clamp / most, 1) or 1) end
    local r, g, b = image:pixel(4, 3)
    near3(r, g, b, want, 4 * ROUNDING + 32 * LOSS, ("%d bounces, clamp %g"):format(bounces, clamp))
  end
end

-- The background that the first ray of a path shows has no limit. Beyond a mirror above the floor, it has.
do
  local disk = glint.disk { center = { 0, 0, 0 }, normal = { 0, 1, 0 }, radius = 0.01, material = plain { diffuse = 1 } }
  local function brightness(clamp, ...)
    local image = look({ 0, 0.2, 0 }, { 0, -1, 0 },
      { background = 10, indirect = { samples = 16, bounces = 1 }, disk, ... }, { clamp = clamp, max_depth = 1, width = 3, height = 3 })
    return (image:pixel(1, 1))
  end
  local mirror = floor(glint.material { diffuse = 0, mirror = 1 }, 1, -1)
  near(brightness(1), 10, 1e-5, "open sky, clamp 1")
  check(brightness(0, mirror) > 9.9, "mirrored sky")
  near(brightness(1, mirror), 1, 1e-5, "mirrored sky, clamp 1")
end

-- ---- Identical pictures in every configuration ----------------------------------------------------------------------

local script = os.tmpname()
do
  local file = assert(io.open(script, "w"))
  file:write [[
local glint = require "glint"
local matt, glossy = glint.material { diffuse = { 0.7, 0.3, 0.2 }, specular = 0.4 }, glint.material { diffuse = 0.4, mirror = 0.3 }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 1, 0 }, fov = 45 }, ambient = 0.2, background = { 0.2, 0.3, 0.5 },
  indirect = { samples = 3, bounces = 3 },
  glint.disk_light { position = { 0, 5, 1 }, normal = { 0, -1, 0 }, radius = 1, samples = 5 }, glint.point_light { position = { 4, 4, 4 }, intensity = 0.4 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = matt },
  glint.sphere { center = { -1.5, 1, 0 }, radius = 1, material = glossy },
  glint.sphere { center = { 0.4, 0.7, 1.6 }, radius = 0.7, material = glint.material { diffuse = 0.1, transmission = 0.8, fresnel = true } },
  glint.sphere_mesh { center = { 1.6, 1, 0 }, radius = 1, segments = 24, terminator = 1, material = matt },
  glint.sphere_mesh { center = { 2.8, 0.5, 1.5 }, radius = 0.5, segments = 10, shading = "gouraud", material = matt },
  glint.box { min = { -4, 0, -3 }, max = { 4, 3, -2.5 }, material = glint.material { diffuse = { 0.2, 0.6, 0.3 } } },
}
return glint.animation { scene = scene, frames = 3, samples = 2, clamp = 0.3, frame = function(t)
  matt.diffuse = { 0.7, 0.3 + 0.2 * t, 0.2 } -- what the walls send on changes, what they are does not
end }
]]
  file:close()
end
dofile "tests/lua/everywhere.lua"(tally, script, 3, 3)
os.remove(script)

local sparse = glint.scene { indirect = { samples = 3 } }.indirect
check(sparse.samples == 3 and sparse.bounces == 2, "fields that a table lacks: %g %g", sparse.samples, sparse.bounces)

tally.finish()
