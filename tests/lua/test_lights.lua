-- Spot and area lights against closed forms. Every scene is a white matt plane, or a point of it seen from close up.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local WHITE = glint.material { diffuse = 1, ambient = 0 }
local FLOOR = { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = WHITE }

-- Looks straight down at a floor: the picture is `width` world units wide, and image row 0 is at z = -width / 2.
local function above(light, width, more)
  local scene = glint.scene {
    camera = glint.camera { eye = { 0, 50, 0 }, at = { 0, 0, 0 }, up = { 0, 0, -1 }, projection = "orthographic",
      height = width },
    light, glint.plane(FLOOR),
  }
  for _, object in ipairs(more or {}) do scene:add(object) end
  return scene
end

local function render(scene, pixels, more)
  local fields = { width = pixels, height = pixels, output = "none" }
  for name, value in pairs(more or {}) do fields[name] = value end
  return scene:render(fields)
end

-- Returns the light at the middle of the floor: mean and root mean square error of a block of 16 pixels.
local function irradiance(light, want, width)
  local image = render(above(light, width or 1e-6), 4)
  local sum, square = 0, 0
  for x = 0, 3 do
    for y = 0, 3 do
      local e = image:pixel(x, y)
      sum, square = sum + e, square + (e - want) ^ 2
    end
  end
  return sum / 16, math.sqrt(square / 16)
end

-- Returns the bits of every pixel.
local function bits(image)
  local out = {}
  for y = 0, image.height - 1 do
    for x = 0, image.width - 1 do out[#out + 1] = string.pack("fff", image:pixel(x, y)) end
  end
  return table.concat(out)
end

local tests = {}

-- ---- Spots ----

function tests.profile()
  local c = glint.cos(math.rad(25))
  local x = (c - glint.cos(math.rad(30))) / (glint.cos(math.rad(20)) - glint.cos(math.rad(30)))
  local step = x * x * (3 - 2 * x)
  near(step, 0.5700181842, 1e-10, "the formula itself")
  local axis = { glint.sin(math.rad(25)), -glint.cos(math.rad(25)), 0 } -- the point is 25 degrees off the axis
  local function spot(fields)
    local f = { position = { 0, 4, 0 }, direction = axis, inner = 20, outer = 30 }
    for name, value in pairs(fields or {}) do f[name] = value end
    return (irradiance(glint.spot_light(f), 0))
  end
  near(spot(), step, 2e-7, "smoothstep in the cosine")
  near(spot { exponent = 7 }, step * c ^ 7, 5e-7, "times cos^exponent")
  near(spot { exponent = 7, intensity = 3, attenuation = { 1, 0, 0.25 } }, step * c ^ 7 * 3 / 5, 1e-6, "and the rest")
  near(spot { direction = { 0, -9, 0 } }, 1, 0, "on the axis")
  near(spot { outer = 24 }, 0, 0, "outside")
  near(spot { inner = 25.001, outer = 25.001 }, 1, 0, "a step: within")
  near(spot { inner = 24.999, outer = 24.999 }, 0, 0, "a step: outside")
  near(spot { inner = 0, outer = 0, direction = { 0, -1, 0 } }, 1, 1, "no angle at all: no NaN")
end

-- A picture of many tiles: each spot light lights everything in its cone, however small its part of a tile.
function tests.spots_on_tiles()
  local pixels, width, height = 160, 12, 3
  local wrong, lit, unlit = 0, 0, 0
  for i = 1, 24 do
    local x, z = 7 * glint.sin(2.4 * i), 7 * glint.cos(2.4 * i)
    local outer = i % 6 == 0 and 80 + 4 * i or 2 + 3 * (i % 16) -- some angles are beyond 90 degrees
    local axis = { 0.7 * glint.sin(5 * i), -1, 0.7 * glint.cos(3 * i) }
    local length = math.sqrt(axis[1] ^ 2 + 1 + axis[3] ^ 2)
    local image = render(above(glint.spot_light { position = { x, height, z }, direction = axis, inner = outer,
      outer = outer }, width), pixels)
    for row = 0, pixels - 1 do
      for column = 0, pixels - 1 do
        local dx = ((column + 0.5) / pixels - 0.5) * width - x
        local dz = ((row + 0.5) / pixels - 0.5) * width - z
        local far = math.sqrt(dx * dx + height * height + dz * dz)
        local inside = (axis[1] * dx + height + axis[3] * dz) / (length * far) - glint.cos(math.rad(outer))
        local want = inside > 0 and height / far or 0
        if math.abs(inside) > 1e-9 and math.abs(image:pixel(column, row) - want) > 1e-6 then wrong = wrong + 1 end
        lit, unlit = lit + (inside > 0 and 1 or 0), unlit + (inside > 0 and 0 or 1)
      end
    end
  end
  check(wrong == 0, wrong .. " pixels are not what the cones say")
  check(lit > 10000 and unlit > 10000, "cones end within the pictures")
end

function tests.whole_spot()
  local ball = glint.sphere { center = { 0, 1, 0 }, radius = 1, material = WHITE }
  local place = { 3, 4, 1 }
  local point = render(above(glint.point_light { position = place }, 12, { ball }), 48)
  local spot = render(above(glint.spot_light { position = place, direction = { 1, 2, 3 }, inner = 180, outer = 180 },
    12, { ball }), 48)
  check(bits(spot) == bits(point), "180 degrees: a point light")
end

-- ---- One plain light, whose light is computed together with the surface ----

-- Returns the light from a light of intensity 2 at a point, in closed form: n.l / (c0 + c1 d + c2 d^2).
local function given(hit, place, c)
  local l, d = {}, 0
  for k = 1, 3 do
    l[k] = place[k] - hit.point[k]
    d = d + l[k] ^ 2
  end
  d = math.sqrt(d)
  local cosine = (hit.normal[1] * l[1] + hit.normal[2] * l[2] + hit.normal[3] * l[3]) / d
  return 2 * math.max(cosine, 0) / (c[1] + c[2] * d + c[3] * d * d)
end

-- Tests points of a ball on a floor or a hill, seen from close up and from far away.
function tests.attenuated()
  local place, c = { 3, 4, 1 }, { 0.5, 0.1, 0.01 }
  local ball = glint.sphere { center = { 0, 1, 0 }, radius = 1, material = WHITE }
  local hill = glint.sphere { center = { 0, -1000, 0 }, radius = 1000, material = WHITE }
  local seen = { [true] = 0, [false] = 0 }
  math.randomseed(4)
  for i = 1, 90 do
    local at = { math.random() * 3 - 1.5, math.random() * 2 - 0.3, math.random() * 3 - 1.5 }
    local eye = { 0, 2, i % 2 == 0 and 6 or 60 }
    local scene = glint.scene { camera = glint.camera { eye = eye, at = at, fov = 1e-7 }, ball,
      i % 3 == 0 and hill or glint.plane(FLOOR),
      glint.point_light { position = place, attenuation = c, intensity = 2, shadows = false } }
    local hit = scene:cast(eye, { at[1] - eye[1], at[2] - eye[2], at[3] - eye[3] })
    if hit then
      local want, round = given(hit, place, c), hit.object == ball
      seen[round] = seen[round] + (want > 0 and 1 or 0)
      for pixels = 1, 4, 3 do near(render(scene, pixels):pixel(0, 0), want, 1e-6, "point " .. i) end
    end
  end
  check(seen[true] > 15 and seen[false] > 15, "lit: %d of the ball, %d below it", seen[true], seen[false])
end

-- ---- Small and close ----

function tests.radius_0()
  local ball = glint.sphere { center = { 0, 1, 0 }, radius = 1, material = glint.material { specular = 0.5 } }
  local place, attenuation = { 3, 4, 1 }, { 0.5, 0.1, 0.01 }
  local function picture(make, fields)
    fields.position, fields.attenuation, fields.intensity = place, attenuation, 1.7
    return bits(render(above(make(fields), 12, { ball }), 48))
  end
  local point = picture(glint.point_light, {})
  check(picture(glint.sphere_light, { radius = 0 }) == point, "sphere of radius 0")
  check(picture(glint.disk_light, { radius = 0, normal = { 0, -1, 0 } }) == point, "disk of radius 0 over all")
  near((irradiance(glint.sphere_light { position = { 0, 2, 0 }, radius = 0, radiance = 1e9 }, 0)), 0, 0,
    "nothing radiates from no surface")
end

function tests.near_light()
  local function e(light) return (irradiance(light, 0)) end
  local inside = e(glint.sphere_light { position = { 0, 0.5, 0 }, radius = 2, radiance = 1, samples = 4096 })
  near(inside, math.pi, 0.03, "within a sphere light the sky is full")
  near(e(glint.sphere_light { position = { 0, 0, 0 }, radius = 2, radiance = 1, samples = 4096 }), math.pi, 0.02,
    "at its centre")
  local small = e(glint.sphere_light { position = { 0, 1, 0 }, radius = 1e-4, radiance = 1e8, samples = 256 })
  near(small, math.pi, 0.02, "a small sphere")
  for _, distance in ipairs { 1e-30, 1e-12, 1e12, 1e30 } do
    local x = irradiance(glint.sphere_light { position = { 0, distance, 0 }, radius = distance / 2, radiance = 1,
      samples = 1024 }, 0, math.min(distance / 1000, 1))
    near(x, math.pi / 4, 0.02, "a sphere at distance " .. distance)
  end
  for _, kind in ipairs { "disk_light", "sphere_light" } do -- the floor passes through the light
    local x = e(glint[kind] { position = { 0, 0, 0 }, normal = kind == "disk_light" and { 0, -1, 0 } or nil, radius = 1 })
    check(x == x and x >= 0 and x < 1e9, "%s on the floor: finite, got %g", kind, x)
  end
end

-- ---- Irradiance in closed form, and the convergence rate ----

-- Lambert's formula: the integral of L cos cos' / d^2 over a polygon that is entirely above the floor's point.
local function lambert(corners)
  local sum = 0
  local function unit(a)
    local l = math.sqrt(a[1] ^ 2 + a[2] ^ 2 + a[3] ^ 2)
    return { a[1] / l, a[2] / l, a[3] / l }
  end
  for i = 1, #corners do
    local a, b = unit(corners[i]), unit(corners[i % #corners + 1])
    local c = { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
    local sine = math.sqrt(c[1] ^ 2 + c[2] ^ 2 + c[3] ^ 2)
    sum = sum + math.atan(sine, a[1] * b[1] + a[2] * b[2] + a[3] * b[3]) * c[2] / sine
  end
  return sum / 2
end

local function polygon(corners, more)
  local fields = { vertices = corners, radiance = 1 }
  for name, value in pairs(more or {}) do fields[name] = value end
  return fields
end

local SQUARE = { { -1, 2, -1 }, { 1, 2, -1 }, { 1, 2, 1 }, { -1, 2, 1 } } -- a square that shines down
local TILTED = { { 1, 1, -2 }, { 1.5, 3, -1.5 }, { 1.45, 2.9, 1 }, { 0.95, 0.9, 0.5 } } -- not a parallelogram
local FIVE = {} -- a regular pentagon, tilted and off-centre
for i = 0, 4 do
  local a = 2 * math.pi * i / 5
  FIVE[i + 1] = { 1 + 0.9 * math.cos(a), 2 + 0.3 * math.cos(a), -1 + 0.8 * math.sin(a) }
end
local TRIANGLE = { { -2, 1.5, 0 }, { 0.5, 1, 2 }, { 0.5, 3, -0.5 } }

function tests.closed_forms()
  local kinds = {
    disk = { math.pi / 5, glint.disk_light, { position = { 0, 2, 0 }, normal = { 0, -1, 0 }, radius = 1, radiance = 1 } },
    sphere = { math.pi / 4, glint.sphere_light, { position = { 0, 2, 0 }, radius = 1, radiance = 1 } },
    ["sphere aside"] = { math.pi / 4 * 2 / math.sqrt(5) * 4 / 5, glint.sphere_light,
      { position = { 1, 2, 0 }, radius = 1, radiance = 1 } },
    square = { math.abs(lambert(SQUARE)), glint.polygon_light, polygon(SQUARE) },
    tilted = { math.abs(lambert(TILTED)), glint.polygon_light, polygon(TILTED, { two_sided = true }) },
    pentagon = { math.abs(lambert(FIVE)), glint.polygon_light, polygon(FIVE, { two_sided = true }) },
    triangle = { math.abs(lambert(TRIANGLE)), glint.polygon_light, polygon(TRIANGLE, { two_sided = true }) },
  }
  for name, kind in pairs(kinds) do
    local want, make, fields = kind[1], kind[2], kind[3]
    local first, last, mean
    for _, n in ipairs { 16, 64, 256, 1024 } do
      fields.samples = n
      local error
      mean, error = irradiance(make(fields), want)
      first, last = first or error, error
      check(error <= math.max(2 * first / math.sqrt(n / 16), 1e-6 * want), "%s: error of %d samples %.2g, of 16 %.2g", name, n, error, first)
      near(mean, want, 2.5 * error / math.sqrt(16) + 1e-6, name .. ": mean of a block of " .. n)
    end
    check(last <= math.max(first / 8, 1e-6 * want), "%s: 64 times the samples: error %.2g, before %.2g", name, last, first)
    near(mean, want, 2e-3 * want, name)
  end
end

-- One side is dark unless two_sided; then both are equally bright. The side with counter-clockwise corners shines.
function tests.sides()
  local up = { SQUARE[4], SQUARE[3], SQUARE[2], SQUARE[1] }
  local function e(make, fields) return (irradiance(make(fields), 0)) end
  local shining = e(glint.polygon_light, polygon(SQUARE))
  check(shining > 0.5 and e(glint.polygon_light, polygon(up)) == 0, "the back of a polygon is dark")
  near(e(glint.polygon_light, polygon(up, { two_sided = true })), shining, 1e-3, "unless it has two")
  near(e(glint.polygon_light, { vertices = up }), 0, 0, "by intensity too")
  near(e(glint.polygon_light, { vertices = up, two_sided = true }), 0.9, 0.1, "and two")
  for _, sign in ipairs { -1, 1 } do
    local disk = { position = { 0, 2, 0 }, normal = { 0, sign, 0 }, radius = 1 }
    check((e(glint.disk_light, disk) > 0) == (sign < 0), "a disk's side, %d", sign)
    disk.radius = 0
    check((e(glint.disk_light, disk) > 0) == (sign < 0), "a point-like disk's side, %d", sign)
  end
end

-- By intensity: the mean of n.l over the surface; for a disk above the point 2 h (sqrt(h^2 + r^2) - h) / r^2.
function tests.intensity()
  local h, r = 2, 1
  local disk = { position = { 0, h, 0 }, normal = { 0, -1, 0 }, radius = r, samples = 1024 }
  local mean = irradiance(glint.disk_light(disk), 0)
  near(mean, 2 * h * (math.sqrt(h * h + r * r) - h) / (r * r), 1e-4, "mean cosine of a disk")
  disk.samples = 37
  local odd = irradiance(glint.disk_light(disk), 0)
  near(odd, mean, 1e-3, "any number of samples")
end

-- ---- Penumbra ----

-- A sphere light of radius 0.5 at height 4 above a sphere of radius 0.5 at height 2: umbra 0.5, penumbra sqrt(3).
function tests.penumbra()
  local light = glint.sphere_light { position = { 0, 4, 0 }, radius = 0.5, samples = 64 }
  local ball = glint.sphere { center = { 0, 2, 0 }, radius = 0.5, material = WHITE }
  local scene = glint.scene { camera = glint.camera { eye = { 3, 1.4, 0 }, at = { 0, 0, 0 }, fov = 70 }, light, ball,
    glint.plane(FLOOR) }
  local lit = glint.scene { camera = scene.camera, light, glint.plane(FLOOR) }
  local size = { width = 240, height = 240, passes = "beauty,object_id,diffuse", output = "none" }
  local shadowed, open = scene:render(size), lit:render(size)
  local dark, partial = 0, 0
  for y = 0, 239 do
    for x = 0, 239 do
      if shadowed:pixel(x, y, "object_id") == 2 then
        -- The floor's point on the ray through the pixel's centre.
        local eye = scene.camera.eye
        local f = { -3 / math.sqrt(10.96), -1.4 / math.sqrt(10.96), 0 }
        local up, half = { f[2], -f[1], 0 }, math.tan(math.rad(35))
        if up[2] < 0 then up = { -up[1], -up[2], 0 } end
        local sx, sy = ((x + 0.5) / 120 - 1) * half, (1 - (y + 0.5) / 120) * half
        local d = { f[1] + sy * up[1], f[2] + sy * up[2], -sx }
        local t = -eye.y / d[2]
        local distance = math.sqrt((eye.x + t * d[1]) ^ 2 + (eye.z + t * d[3]) ^ 2)
        local a, b = shadowed:pixel(x, y, "diffuse"), open:pixel(x, y, "diffuse")
        if distance < 0.5 - 1e-9 then
          dark = dark + 1
          check(a == 0, "umbra: 0 at %.3f, got %g", distance, a)
        elseif distance > math.sqrt(3) + 1e-9 then
          check(a == b, "beyond the penumbra: whole light at %.4f", distance)
        elseif distance > 0.8 and distance < 1.4 then
          partial = partial + 1
          check(a > 0 and a < b, "penumbra: some light at %.3f: %g of %g", distance, a, b)
        end
      end
    end
  end
  check(dark > 100 and partial > 1000, "%d pixels of umbra, %d of penumbra", dark, partial)
end

-- A light too far away for float casts the shadows of a directional light. In extreme_radii, radiance needs the
-- squared radius: the smallest and largest allowed radii give finite light, others are refused.
function tests.beyond_float()
  local function picture(light)
    return render(above(light, 12, {
      glint.sphere { center = { 0, 1, 0 }, radius = 0.7, material = WHITE },
      glint.sphere { center = { 1.5, 0.5, 2 }, radius = 0.4, material = WHITE },
      glint.box { min = { -3, 0, -1 }, max = { -2.2, 1.4, 0 }, material = WHITE },
    }), 120)
  end
  for _, far in ipairs { 1e20, 1e39, 1e150 } do
    local way = { far, 0.8731 * far, 0.2317 * far }
    local lamp = picture(glint.point_light { position = way })
    local sun = picture(glint.directional_light { direction = { -1, -0.8731, -0.2317 } })
    local wrong, dark = 0, 0
    for y = 0, 119 do
      for x = 0, 119 do
        if math.abs(lamp:pixel(x, y) - sun:pixel(x, y)) > 1e-5 then wrong = wrong + 1 end
        if sun:pixel(x, y) == 0 then dark = dark + 1 end
      end
    end
    check(wrong == 0 and dark > 300, far .. ": " .. wrong .. " pixels of another light, " .. dark .. " in shadow")
  end
end

function tests.extreme_radii()
  for _, radius in ipairs { 0, 1e-150, 1e150 } do
    local r = render(above(glint.sphere_light { position = { 0, 3, 0 }, radius = radius, radiance = 1, samples = 4 }, 8), 8)
      :pixel(4, 4)
    check(r >= 0 and r < 10, "radius %g: %g", radius, r)
  end
  for _, radius in ipairs { 1e-160, 1e160 } do
    local ok, message = pcall(glint.sphere_light, { position = { 0, 3, 0 }, radius = radius, radiance = 1 })
    check(not ok and message:find "radius: 0 or a number 1e%-150 %.%. 1e150 together with a radiance expected", tostring(message))
  end
end

-- A light crosses a face, with its centre below the face: one ray to the centre decides, for any kind of shape.
function tests.the_middle_behind_a_face()
  local function faces(shape)
    return glint.scene { camera = glint.camera { eye = { 2, 3, 4 }, at = { 0, 0, 0 }, fov = 40 }, shape,
      glint.sphere_light { position = { 3, 0.8, 0 }, radius = 0.6, samples = 16, shadow = "hard" } }
  end
  local corners = {}
  for i = 0, 7 do corners[i + 1] = { i & 1 == 0 and -1 or 1, i & 2 == 0 and -1 or 1, i & 4 == 0 and -1 or 1 } end
  local mesh = glint.mesh { vertices = corners, material = WHITE,
    faces = { { 1, 3, 4, 2 }, { 5, 6, 8, 7 }, { 1, 2, 6, 5 }, { 3, 7, 8, 4 }, { 1, 5, 7, 3 }, { 2, 4, 8, 6 } } }
  local box = glint.box { min = { -1, -1, -1 }, max = { 1, 1, 1 }, material = WHITE }
  local a, b, top = render(faces(mesh), 64), render(faces(box), 64), 0
  check(bits(a) == bits(b), "a box and its mesh")
  for x = 28, 36 do top = top + a:pixel(x, 20) end
  check(top == 0, "the face that the middle is below")
end

-- ---- Identical pictures in every configuration ----

function tests.seeds_and_blocks()
  local light = glint.disk_light { position = { 1, 3, 0 }, normal = { 0, -1, 0 }, radius = 1, samples = 4 }
  local ball = glint.sphere { center = { 0, 1, 0 }, radius = 1, material = WHITE }
  local scene = above(light, 8, { ball })
  local plain, seeded = render(scene, 64), render(scene, 64, { seed = 5 })
  check(bits(plain) ~= bits(seeded), "a seed turns the pattern")
  local whole = render(above(light, 8, { ball }), 64)
  check(bits(plain) == bits(whole), "and the pattern is that of the pixel")
  local a, b = 0, 0
  for y = 0, 63 do
    for x = 0, 63 do a, b = a + plain:pixel(x, y), b + seeded:pixel(x, y) end
  end
  near(a / b, 1, 2e-3, "as much light with any seed")
end

tally.run(tests)
-- ---- A limit of rays: the picture of a scene whose lights and surfaces have no more samples ---------------------------

for _, kind in ipairs { "indirect", "ambient_occlusion", "neither" } do
  local function shown(most, rays)
    local function few(samples) return math.min(samples, most) end
    local fields = {
      camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 1, 0 }, fov = 45 }, ambient = 0.2, background = { 0.2, 0.3, 0.5 },
      reflection_samples = few(7),
      glint.disk_light { position = { 0, 5, 1 }, normal = { 0, -1, 0 }, radius = 1, samples = few(9), radiance = 2 },
      glint.polygon_light { vertices = { { -2, 4, 3 }, { -1, 4, 3 }, { -1, 5, 3 } }, two_sided = true, samples = few(6), radiance = 3 },
      glint.sphere_light { position = { 4, 4, 4 }, radius = 0.5, samples = few(2), intensity = 0.4 },
      glint.sphere_light { position = { -4, 3, 4 }, radius = 0.5, samples = few(8), radiance = 2, color = { 1, 0.5, 0 } },
      glint.point_light { position = { 4, 4, 4 }, intensity = 0.4 },
      glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } },
      glint.sphere { center = { -1.5, 1, 0 }, radius = 1,
        material = glint.material { model = "cook_torrance", f0 = { 1, 0.77, 0.34 }, diffuse = 0, roughness = 0.4 } },
      glint.box { min = { 0.5, 0, -1 }, max = { 2, 1.5, 0 } },
    }
    if kind ~= "neither" then fields[kind] = { samples = few(5), distance = kind == "ambient_occlusion" and 3 or nil } end
    return glint.scene(fields):render { width = 40, height = 25, samples = 2, output = "none", rays = rays }:bytes()
  end
  local full = shown(math.huge)
  check(shown(math.huge, 0) == full and shown(math.huge, 9) == full, "%s: 0 and 9 limit no rays", kind)
  for most = 1, 8 do check(shown(math.huge, most) == shown(most), "%s: at most %d rays", kind, most) end
  check(shown(math.huge, 1) ~= full and shown(math.huge, 3) ~= shown(math.huge, 2), "%s: fewer rays are seen", kind)
end

tally.finish()
