-- Visible lights: position, brightness, the objects that they occlude, and unaffected passes.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local ALL = "beauty,background,ambient,diffuse,specular,mirror,transmission,depth,normal,object_id"
local W, H = 96, 72
local EYE = { 0.5, 2, 9 }

local function camera(more)
  local fields = { eye = EYE, at = { 0, 1.5, 0 }, fov = 50 }
  for name, value in pairs(more or {}) do fields[name] = value end
  return glint.camera(fields)
end

local function render(scene, more)
  local fields = { width = W, height = H, passes = ALL, output = "none" }
  for name, value in pairs(more or {}) do fields[name] = value end
  return scene:render(fields)
end

-- A pentagon, made coplanar in double; and the shapes that look like the lights below.
local CORNERS = { { -1, 1, 0.5 }, { 1.2, 0.9, 0 }, { 1.4, 2.7, 0.1 }, { -0.3, 3, 0.6 }, { -1.2, 2.1, 0.7 } }
do -- moves all corners into one plane
  local a, b, c = CORNERS[1], CORNERS[2], CORNERS[3]
  local u = { b[1] - a[1], b[2] - a[2], b[3] - a[3] }
  local v = { c[1] - a[1], c[2] - a[2], c[3] - a[3] }
  local n = { u[2] * v[3] - u[3] * v[2], u[3] * v[1] - u[1] * v[3], u[1] * v[2] - u[2] * v[1] }
  for i = 4, 5 do
    local p = CORNERS[i]
    p[3] = a[3] - (n[1] * (p[1] - a[1]) + n[2] * (p[2] - a[2])) / n[3]
  end
end
local function copy(t, more)
  local out = {}
  for name, value in pairs(t) do out[name] = value end
  for name, value in pairs(more or {}) do out[name] = value end
  return out
end
local BALL = { position = { -0.6, 1.7, 1 }, radius = 1.1 }
local DISK = { position = { 0.4, 1.6, 0 }, normal = { 0.4, 0.3, 1 }, radius = 1.5 }
local POLYGON = { vertices = CORNERS }
local KINDS = {
  ball = { glint.sphere_light, BALL, glint.sphere { center = BALL.position, radius = BALL.radius } },
  disk = { glint.disk_light, DISK, glint.disk { center = DISK.position, normal = DISK.normal, radius = DISK.radius } },
  polygon = { glint.polygon_light, POLYGON, glint.mesh { vertices = CORNERS, faces = { { 1, 2, 3, 4, 5 } } } },
}

local tests = {}

-- A light appears in the same pixels as a shape of its form, at the same distance, with the same normal.
function tests.the_form_of_the_shape()
  for name, kind in pairs(KINDS) do
    for _, projection in ipairs { "perspective", "orthographic" } do
      for _, precision in ipairs { "double", "float" } do
        local view = camera { projection = projection, height = 7 }
        local lamp = glint.scene { camera = view, kind[1](copy(kind[2], { visible = true, radiance = 0.2 })) }
        local shape = glint.scene { camera = view, kind[3] }
        local a, b = render(lamp, { precision = precision }), render(shape, { precision = precision })
        local seen, wrong, off, turned = 0, 0, 0, 0
        for y = 0, H - 1 do
          for x = 0, W - 1 do
            local there = b:pixel(x, y, "object_id") == 1
            seen = seen + (there and 1 or 0)
            wrong = wrong + ((a:pixel(x, y, "background") > 0) ~= there and 1 or 0)
            local d, e = a:pixel(x, y, "depth"), b:pixel(x, y, "depth")
            if there and d < math.huge then
              off = math.max(off, math.abs(d / e - 1))
              local n, m = { a:pixel(x, y, "normal") }, { b:pixel(x, y, "normal") }
              for c = 1, 3 do turned = math.max(turned, math.abs(n[c] - m[c])) end
            end
          end
        end
        check(seen > 300 and wrong <= (precision == "float" and 2 or 0), "%s, %s, %s: %d pixels, %d wrong", name, projection,
          precision, seen, wrong)
        check(off <= 4e-7 and turned <= 3e-6, "%s: depth off by %.2g, normal by %.2g", name, off, turned)
      end
    end
  end
end

-- Checks the brightness: pi L by radiance, I A(D) by intensity.
function tests.how_bright()
  local function shown(make, fields)
    local image = render(glint.scene { camera = camera(), make(copy(fields, { visible = true })) })
    return { image:pixel(W // 2, H // 2, "beauty") }
  end
  for name, kind in pairs(KINDS) do
    local tint = { 0.25, 0.5, 1 }
    local c = shown(kind[1], copy(kind[2], { radiance = 0.3, color = tint }))
    for i = 1, 3 do near(c[i], 0.3 * math.pi * tint[i], 1e-7, name .. ": pi L") end
    near(shown(kind[1], copy(kind[2], { intensity = 0.7 }))[1], 0.7, 1e-7, name .. ": I without fall-off")
  end
  local r = BALL.radius
  near(shown(glint.sphere_light, copy(BALL, { intensity = 3, attenuation = { 0, 0, 2 } }))[1],
    math.pi * 3 / (2 * math.pi * r * r), 1e-6, "I / (c2 area) is the radiance")
  near(shown(glint.sphere_light, copy(BALL, { intensity = 3, attenuation = { 1, 1, 2 } }))[1],
    3 / (1 + r + 2 * r * r), 1e-6, "A at its radius")
  near(shown(glint.sphere_light, copy(BALL, { diffuse = 0, specular = 0, color = 0.5 }))[1], 0.5, 0, "its colour alone")
end

-- A white matt surface inside a shining ball has the brightness of the ball.
function tests.furnace()
  local white = glint.material { diffuse = 1, ambient = 0 }
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 }, fov = 60 },
    glint.sphere_light { position = { 0, 0, 0 }, radius = 20, radiance = 0.25, visible = true, shadows = false,
      samples = 1024 },
    glint.sphere { center = { 0, 0, 0 }, radius = 1, material = white } }
  local image = render(scene)
  near(image:pixel(0, 0), 0.25 * math.pi, 1e-7, "the inside of the light")
  near(image:pixel(W // 2, H // 2), 0.25 * math.pi, 2e-2, "what it lights")
end

-- From behind, a one-sided light is invisible.
function tests.sides()
  local function sees(make, fields)
    local image = render(glint.scene { camera = camera(), make(copy(fields, { visible = true })) })
    return image:pixel(W // 2, H // 2) > 0
  end
  local back = {}
  for i = 1, 5 do back[i] = CORNERS[6 - i] end
  check(sees(glint.polygon_light, POLYGON) and not sees(glint.polygon_light, { vertices = back }), "polygon")
  check(sees(glint.polygon_light, { vertices = back, two_sided = true }), "polygon of two sides")
  check(sees(glint.disk_light, DISK) and not sees(glint.disk_light, copy(DISK, { normal = { 0, 0, -1 } })), "disk")
  check(not sees(glint.disk_light, copy(DISK, { radius = 0 })), "radius 0: nothing to see")
  check(not sees(glint.sphere_light, copy(BALL, { intensity = 0 })), "without light: nothing to see")
  check(not sees(glint.point_light, { position = { 0, 1.5, 0 } }), "a point has no surface")
end

-- Makes a light with an opaque ball in front and another ball behind, a mirror, and glass of index 1.
local function room(visible)
  return glint.scene { camera = camera(), ambient = 0.1, background = { 0.02, 0.03, 0.05 },
    glint.sphere_light { position = { -0.5, 2.4, 0 }, radius = 0.9, radiance = 0.2, color = { 1, 0.5, 0.25 }, samples = 4,
      visible = visible },
    glint.disk_light { position = { 3, 2, -1 }, normal = { -1, 0, 0.6 }, radius = 0.8, visible = visible, samples = 4 },
    glint.plane { point = { 0, -0.5, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.4, mirror = 0.5 } },
    glint.sphere { center = { -0.6, 1.9, 2 }, radius = 0.4 },
    glint.sphere { center = { -1.2, 2.6, -2.5 }, radius = 1 },
    glint.sphere { center = { 0.1, 2.9, 2 }, radius = 0.35,
      material = glint.material { diffuse = 0, transmission = 1, ior = 1 } } }
end

function tests.in_the_room()
  local image, dark = render(room(true)), render(room(false))
  local lamps, mirrored, through = 0, 0, 0
  local function sum(got, x, y)
    local t = 0
    for _, pass in ipairs { "background", "ambient", "diffuse", "specular", "mirror", "transmission" } do
      t = string.unpack("f", string.pack("f", t + got:pixel(x, y, pass)))
    end
    return t
  end
  for y = 0, H - 1 do
    for x = 0, W - 1 do
      local id, depth = image:pixel(x, y, "object_id"), image:pixel(x, y, "depth")
      check(sum(image, x, y) == image:pixel(x, y), "the passes sum to the picture at %d, %d", x, y)
      if id == 0 and depth < math.huge then
        lamps = lamps + 1
        local _, _, blue = image:pixel(x, y, "background")
        local a, b = 0.2 * math.pi * 0.25, 1
        check(math.abs(blue - a) < 1e-6 or blue == b, "the light's colour alone at %d, %d: %g", x, y, blue)
        check(image:pixel(x, y, "diffuse") == 0 and image:pixel(x, y, "ambient") == 0, "and no surface's")
      else
        for _, pass in ipairs { "background", "ambient", "diffuse", "specular", "object_id" } do
          check(image:pixel(x, y, pass) == dark:pixel(x, y, pass), "%s of what is no light at %d, %d", pass, x, y)
        end
        if image:pixel(x, y, "mirror") > dark:pixel(x, y, "mirror") + 0.05 then mirrored = mirrored + 1 end
        if image:pixel(x, y, "transmission") > 0.19 * math.pi then through = through + 1 end
      end
    end
  end
  check(lamps > 200 and mirrored > 50 and through > 10, "%d, %d mirrored, %d through glass", lamps, mirrored, through)
end

-- A light covers the scene behind it, also in alpha.
function tests.coverage()
  local scene = glint.scene { camera = camera(), background = 1,
    glint.sphere_light(copy(BALL, { radiance = 0.1, visible = true })) }
  local image = render(scene, { alpha = true, passes = "beauty,alpha", samples = 4 })
  check(image:pixel(0, 0, "alpha") == 0 and image:pixel(0, 0) == 0, "nothing is nothing")
  near(image:pixel(W // 2 - 7, H // 2, "alpha"), 1, 0, "a light is something")
  near(image:pixel(W // 2 - 7, H // 2), 0.1 * math.pi, 1e-7, "with its colour")
end

-- A mirror of 0.5 shows half of the light.
function tests.in_a_mirror()
  local scene = glint.scene { camera = glint.camera { eye = { 0, 1, 3 }, at = { 0, 0, 0 }, fov = 10 },
    glint.sphere_light { position = { 0, 1, -3 }, radius = 0.9, radiance = 0.3, visible = true },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0, mirror = 0.5 } } }
  near(render(scene):pixel(W // 2, H // 2, "mirror"), 0.5 * 0.3 * math.pi, 1e-7, "mirrored")
  near(render(scene, { max_depth = 0 }):pixel(W // 2, H // 2, "mirror"), 0, 0, "not at depth 0")
end

-- A flat light in the plane of a wall hides the wall from every direction, axis-aligned or not.
function tests.in_a_wall()
  local n, u, v = { 2 / 3, 1 / 3, 2 / 3 }, { -1 / math.sqrt(5), 2 / math.sqrt(5), 0 }, {}
  for i = 1, 3 do
    local j, k = i % 3 + 1, (i + 1) % 3 + 1
    v[i] = n[j] * u[k] - n[k] * u[j]
  end
  local function at(a, b, c)
    local p = {}
    for i = 1, 3 do p[i] = 10 + a * u[i] + b * v[i] + c * n[i] end
    return p
  end
  local lights = {
    glint.polygon_light { vertices = { at(-1, -1, 0), at(1, -1, 0), at(1, 1, 0), at(-1, 1, 0) }, visible = true },
    glint.disk_light { position = at(0, 0, 0), normal = n, radius = 1, visible = true },
  }
  for i, light in ipairs(lights) do
    for _, height in ipairs { 5, 0.3, 0.01 } do
      for _, precision in ipairs { "double", "float" } do
        local scene = glint.scene { camera = glint.camera { eye = at(-1.5, 0.2, height), at = at(0, 0, 0), fov = height < 0.1 and 1 or 12 }, light,
          glint.plane { point = at(5, 3, 0), normal = n } }
        local image, holes = render(scene, { precision = precision }), 0
        for y = H // 2 - 1, H // 2 + 1 do
          for x = W // 2 - 12, W // 2 + 12 do holes = holes + (image:pixel(x, y, "background") == 0 and 1 or 0) end
        end
        check(holes == 0, "light %d from height %g, %s: %d holes", i, height, precision, holes)
      end
    end
  end
end

-- With several samples per pixel, the light's share of the pixel is the share of the samples that see the light.
function tests.samples()
  local scene = glint.scene { camera = camera(), glint.sphere_light(copy(BALL, { radiance = 1 / math.pi, visible = true })) }
  local one, many, edge = render(scene), render(scene, { samples = 16 }), 0
  for y = 1, H - 2 do
    for x = 1, W - 2 do
      local share = many:pixel(x, y) * 16
      near(share, math.floor(share + 0.5), 1e-5, "sixteenths")
      if share > 0.5 and share < 15.5 then edge = edge + 1 end
      if one:pixel(x, y) == one:pixel(x - 1, y) and one:pixel(x, y) == one:pixel(x + 1, y)
        and one:pixel(x, y) == one:pixel(x, y - 1) and one:pixel(x, y) == one:pixel(x, y + 1) then
        near(share / 16, one:pixel(x, y), 0.7, "inside and outside")
      end
    end
  end
  check(edge > 20, "%d pixels at the edge", edge)
end

tally.run(tests)
tally.finish()
