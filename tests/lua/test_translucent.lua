-- Opacity between 0 and 1: a surface of opacity o contributes o of its light and passes 1 - o straight on, for the eye,
-- shadows, mirrors, glass and indirect light. Closed forms, and blends of the same scenes with and without the surface.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"
local BUILD = os.getenv "BUILD" or "build"

local ROUNDING <const> = 2e-6 -- allowed error of light near 1: float32 rounding and dropped weak rays

local raises = tally.raises

local function camera(fields)
  local all = { eye = { 0, 0, 9 }, at = { 0, 0, 0 }, fov = 40 }
  for name, value in pairs(fields or {}) do all[name] = value end
  return glint.camera(all)
end

-- Makes a square of side 2 s, perpendicular to the z axis.
local function sheet(z, material, s)
  s = s or 1
  return glint.mesh { vertices = { { -s, -s, z }, { s, -s, z }, { s, s, z }, { -s, s, z } }, faces = { { 1, 2, 3, 4 } }, material = material }
end

local function plain(color, fields)
  local all = { diffuse = color }
  for name, value in pairs(fields or {}) do all[name] = value end
  return glint.material(all)
end

-- Returns the centre of a picture of these objects under ambient light only.
local function look(objects, fields, options)
  local all, render = { camera = camera(), ambient = 1, background = { 0.2, 0.4, 0.6 } }, { width = 9, height = 9 }
  for name, value in pairs(fields or {}) do all[name] = value end
  for name, value in pairs(options or {}) do render[name] = value end
  for i, object in ipairs(objects) do all[i] = object end
  return glint.scene(all):render(render)
end

local function is(image, want, name, pass)
  local got = { image:pixel(4, 4, pass) }
  for c = 1, #want do near(got[c], want[c], ROUNDING, ("%s, channel %d"):format(name, c)) end
end

local tests = {}

-- ---- Closed forms ----

function tests.one_sheet_and_two()
  for _, o in ipairs { 0.1, 0.3, 0.5, 0.7, 0.99 } do
    local red, green = plain({ 1, 0, 0 }, { opacity = o }), plain({ 0, 1, 0 }, { opacity = 1 - o / 2 })
    is(look { sheet(0, red) }, { o + (1 - o) * 0.2, (1 - o) * 0.4, (1 - o) * 0.6 }, ("one of %g"):format(o))
    local rest = (1 - o) * (o / 2)
    is(look { sheet(-1, green), sheet(0, red) }, { o + rest * 0.2, (1 - o) * (1 - o / 2) + rest * 0.4, rest * 0.6 }, ("two of %g"):format(o))
    is(look({ sheet(0, red) }, {}, { precision = "float" }), { o + (1 - o) * 0.2, (1 - o) * 0.4, (1 - o) * 0.6 }, ("float, %g"):format(o))
    is(look({ sheet(0, red) }, {}, { max_depth = 0 }), { o + (1 - o) * 0.2, (1 - o) * 0.4, (1 - o) * 0.6 }, "max_depth does not count it")
  end
end

-- A ball has two surfaces: the inside of the farther one is visible through the nearer one.
function tests.a_ball_has_two_surfaces()
  for _, projection in ipairs { "perspective", "orthographic" } do
    local o, material = 0.3, plain({ 1, 0, 0 }, { opacity = 0.3 })
    local shapes = {
      ball = glint.sphere { center = { 0, 0, 0 }, radius = 1, material = material },
      egg = glint.sphere { center = { 0, 0, 0 }, radius = 1, transform = glint.scale(2, 1, 1), material = material },
      box = glint.box { min = { -1, -1, -1 }, max = { 1, 1, 1 }, material = material },
      mesh = glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 12, shading = "flat", material = material },
      solid = glint.intersection { glint.sphere { center = { 0, 0, 0 }, radius = 1, material = material },
        glint.sphere { center = { 0, 0, 0.5 }, radius = 1, material = material } },
    }
    local view = { camera = camera(projection == "orthographic" and { projection = projection, height = 5 } or {}) }
    if projection == "orthographic" then view.camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 }, projection = projection, height = 5 } end
    for name, shape in pairs(shapes) do
      local left = (1 - o) ^ 2
      is(look({ shape }, view), { (o + (1 - o) * o) + left * 0.2, left * 0.4, left * 0.6 }, name .. ", " .. projection)
    end
  end
end

-- No option limits a chain of sheets, and it stays exact, without random choices, beyond 16 surfaces.
function tests.many_sheets_in_any_order()
  for _, count in ipairs { 20, 60 } do
    local objects, o, want, left = {}, 0.05, { 0, 0, 0 }, 1
    for i = count, 1, -1 do -- 7 is coprime to the counts: the sheets are ordered differently from the list
      local k = i * 7 % count + 1
      objects[#objects + 1] = sheet(-0.01 * k, plain({ k / count, 1 - k / count, 0.5 }, { opacity = o }))
    end
    for k = 1, count do
      for c, value in ipairs { k / count, 1 - k / count, 0.5 } do want[c] = want[c] + left * o * value end
      left = left * (1 - o)
    end
    for c, value in ipairs { 0.2, 0.4, 0.6 } do want[c] = want[c] + left * value end
    is(look(objects), want, count .. " sheets")
    is(look(objects, {}, { samples = 3 }), want, count .. " sheets, 3 samples")
  end
end

-- Lights for a floor, with a sheet between the whole floor and each light.
local lights = {
  point = function() return glint.point_light { position = { 1, 8, 1 } } end,
  near = function() return glint.point_light { position = { 1, 8, 1 }, attenuation = { 0, 0, 0.03 } } end,
  directional = function() return glint.directional_light { direction = { 0.2, -1, 0.1 } } end,
  spot = function() return glint.spot_light { position = { 1, 8, 1 }, direction = { -0.1, -1, 0 }, inner = 50, outer = 70 } end,
  disk = function() return glint.disk_light { position = { 1, 8, 1 }, normal = { 0, -1, 0 }, radius = 1, samples = 7 } end,
  polygon = function()
    return glint.polygon_light { vertices = { { 0, 8, 0 }, { 2, 8, 0 }, { 2, 8, 2 } }, two_sided = true, samples = 5, radiance = 9 }
  end,
  sphere = function() return glint.sphere_light { position = { 1, 8, 1 }, radius = 1, samples = 6 } end,
  cone = function() return glint.sphere_light { position = { 1, 8, 1 }, radius = 1, samples = 6, radiance = 12 } end,
  caps = function() return glint.sphere_light { position = { 1, 8, 1 }, radius = 1, shadow = "caps" } end,
  hard = function() return glint.sphere_light { position = { 1, 8, 1 }, radius = 1, shadow = "hard", samples = 3 } end,
}

function tests.shadows_keep_their_share_of_light()
  local o = 0.35
  local veil = plain(0.8, { opacity = o })
  local covers = {
    sheet = { 1, function()
      return glint.mesh { vertices = { { -40, 4, -40 }, { -40, 4, 40 }, { 40, 4, 40 }, { 40, 4, -40 } }, faces = { { 1, 2, 3, 4 } }, material = veil }
    end },
    plane = { 1, function() return glint.plane { point = { 0, 4, 0 }, normal = { 0, 1, 0 }, material = veil } end },
    slab = { 2, function() return glint.box { min = { -40, 4, -40 }, max = { 40, 4.5, 40 }, material = veil } end },
    two = { 2, function()
      local function cover(y) return glint.plane { point = { 0, y, 0 }, normal = { 0, 1, 0 }, material = veil } end
      return glint.group { cover(4), cover(3) }
    end },
  }
  local floor = glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = plain({ 0.9, 0.5, 0.2 }, { specular = 0.4 }) }
  for kind, light in pairs(lights) do
    local buried = glint.sphere { center = { 0, -60, 0 }, radius = 1, material = veil } -- same light without cover
    local function picture(cover)
      local scene = glint.scene { camera = glint.camera { eye = { 0, 2, 5 }, at = { 0, 0, 0 } }, light(), floor, buried }
      if cover then scene:add(cover) end
      return scene:render { width = 8, height = 6, samples = 2 }
    end
    local open = picture()
    for name, cover in pairs(covers) do
      local image, worst = picture(cover[2]()), 0
      for y = 3, 5 do
        for x = 0, 7 do
          local a, b = { image:pixel(x, y) }, { open:pixel(x, y) }
          for c = 1, 3 do worst = math.max(worst, math.abs(a[c] - b[c] * (1 - o) ^ cover[1]) / b[c]) end
        end
      end
      near(worst, 0, 4e-6, ("%s light through a %s"):format(kind, name))
    end
  end
end

-- ---- One sheet in front: without shadows, light is linear in its opacity ----

local W <const>, H <const> = 24, 18

local function backdrop() return sheet(-3, plain({ 0.1, 0.6, 0.3 }, { specular = 0.5 }), 6) end

-- Returns the largest difference between a picture with opacity o and the blend of the opaque picture (o) and the
-- clear one (1 - o), and how far these two differ. make: makes the shape from a material with `fields` and opacity.
local function superposition(make, fields, o, scene_fields, options)
  local function picture(opacity, mode)
    local own = { opacity = opacity, opacity_mode = mode }
    for name, value in pairs(fields) do own[name] = value end
    local all = { camera = camera { eye = { 1, 2, 7 } }, ambient = 0.3, background = { 0.2, 0.4, 0.6 } }
    for name, value in pairs(scene_fields or {}) do all[name] = value end
    local scene = glint.scene(all)
    scene:add(backdrop())
    scene:add(glint.point_light { position = { 3, 5, 6 }, shadows = false })
    scene:add(glint.point_light { position = { -3, 1, 6 }, color = { 0.3, 0.5, 1 }, intensity = 0.5, shadows = false })
    local shape = make(glint.material(own))
    if shape then scene:add(shape) end
    local render = { width = W, height = H }
    for name, value in pairs(options or {}) do render[name] = value end
    return scene:render(render)
  end
  local part, all, none = picture(o.value, o.mode), picture(1), picture(0)
  local worst, apart = 0, 0
  for y = 0, H - 1 do
    for x = 0, W - 1 do
      local p, a, n = { part:pixel(x, y) }, { all:pixel(x, y) }, { none:pixel(x, y) }
      for c = 1, 3 do
        worst = math.max(worst, math.abs(p[c] - (o.number * a[c] + (1 - o.number) * n[c])))
        apart = math.max(apart, math.abs(a[c] - n[c]))
      end
    end
  end
  return worst, apart
end

local function bumpy(p) return 0.05 * glint.noise(p * 3) end
local looks = {
  phong = { diffuse = { 0.8, 0.3, 0.1 }, specular = 0.7 },
  ["own ambient"] = { diffuse = { 0.8, 0.3, 0.1 }, ambient = { 0.1, 0.9, 0.3 } },
  blinn = { diffuse = 0.4, specular = 0.7, model = "blinn_phong", normalized = true },
  facets = { diffuse = 0.4, model = "cook_torrance", roughness = 0.2, f0 = { 0.9, 0.6, 0.3 } },
  mirror = { diffuse = 0.1, mirror = { 0.9, 0.5, 0.2 } },
  fresnel = { diffuse = 0.3, fresnel = true },
  glass = { diffuse = 0.1, transmission = { 0.9, 0.7, 0.5 }, ior = 1.5, mirror = 0.05 },
  dielectric = { diffuse = 0.1, transmission = 1, ior = 1.3, fresnel = true },
  pattern = { diffuse = glint.pattern(function(p) return 0.4 + 0.4 * glint.noise(p * 3) end), specular = 0.5 },
  shiny = { diffuse = 0.2, specular = glint.pattern(function(p) return { 0.4, 0.2 + 0.2 * glint.noise(p), 0.1 } end),
    shininess = glint.pattern(function(p) return 20 + 10 * glint.noise(p) end), normalized = true },
  rough = { diffuse = 0.1, model = "cook_torrance", roughness = glint.pattern(function(p) return 0.3 + 0.2 * glint.noise(p) end) },
  ["a pattern's mirror"] = { diffuse = 0.1, mirror = glint.pattern(function(p) return 0.5 + 0.4 * glint.noise(p * 3) end) },
  bump = { diffuse = 0.6, specular = 0.5, bump = glint.pattern(bumpy) },
  shader = { diffuse = { 0.9, 0.5, 0.2 }, specular = 0.5, model = glint.shader(function(s)
    local lit = glint.max(0, s.n:dot(s.l))
    return s.light * (s.kd * s.kd * lit + 0.1), s.light * s.ks * s.ks * lit * lit
  end) },
  ["a painted shader"] = { diffuse = glint.pattern(function(p) return 0.4 + 0.4 * glint.noise(p * 3) end), model = glint.shader(function(s)
    return s.light * s.kd * s.kd * glint.max(0, s.n:dot(s.l))
  end) },
}
local function square(material) return sheet(0, material, 1.5) end
local function fan(shading)
  return function(material)
    return glint.mesh { vertices = { { -1.5, -1, 0 }, { 1.5, -1, 0 }, { 1.2, 1.3, 0.3 }, { -1, 1.4, 0 } }, faces = { { 1, 2, 3 }, { 1, 3, 4 } },
      normals = shading ~= "flat" and { { -0.3, 0, 1 }, { 0.3, 0, 1 }, { 0.3, 0.3, 1 }, { -0.2, 0.4, 1 } } or nil, shading = shading, material = material }
  end
end

function tests.all_that_a_surface_gives_counts_in_part()
  local o = { value = 0.3, number = 0.3 }
  for name, fields in pairs(looks) do
    local worst, apart = superposition(square, fields, o)
    near(worst, 0, 4e-6, name)
    check(apart > 0.1, "%s: %g", name, apart)
  end
  for _, shading in ipairs { "flat", "faceted", "gouraud", "phong" } do
    near(superposition(fan(shading), looks.phong, o), 0, 4e-6, shading)
  end
  near(superposition(square, looks.phong, o, {}, { precision = "float" }), 0, 4e-6, "float")
  near(superposition(square, looks.phong, o, {}, { samples = 4 }), 0, 4e-6, "4 samples")
  near(superposition(fan "flat", looks.phong, o, {}, { visibility = "scan" }), 0, 4e-6, "scan conversion")
  near(superposition(square, looks.phong, o, { background = glint.pattern(function(d) return 0.5 + 0.5 * d.y end) }), 0, 4e-6, "a sky")
end

-- ---- Which opacities blend, and which cut ----

local function bits(image)
  local all = {}
  for y = 0, H - 1 do
    for x = 0, W - 1 do all[#all + 1] = ("%a %a %a"):format(image:pixel(x, y)) end
  end
  return table.concat(all, "\n")
end

local function seen(material, options)
  local all = { width = W, height = H }
  for name, value in pairs(options or {}) do all[name] = value end
  return glint.scene { camera = camera { eye = { 1, 2, 7 } }, ambient = 0.3, background = { 0.2, 0.4, 0.6 },
    glint.point_light { position = { 3, 5, 6 } }, backdrop(), material and square(material) }:render(all)
end

function tests.numbers_blend_and_patterns_cut()
  local function constant(o) return glint.pattern(function() return o end) end
  local none, all = bits(seen()), bits(seen(plain({ 1, 0, 0 })))
  check(glint.material {}.opacity_mode == "auto", "the default")
  for _, mode in ipairs { "auto", "cut", "blend" } do
    check(bits(seen(plain({ 1, 0, 0 }, { opacity = 0, opacity_mode = mode }))) == none, "%s: 0 is nothing", mode)
    check(bits(seen(plain({ 1, 0, 0 }, { opacity = 1, opacity_mode = mode }))) == all, "%s: 1 is all", mode)
    check(bits(seen(plain({ 1, 0, 0 }, { opacity = constant(0), opacity_mode = mode }))) == none, "%s: a pattern of 0 is nothing", mode)
    check(bits(seen(plain({ 1, 0, 0 }, { opacity = constant(1), opacity_mode = mode }))) == all, "%s: a pattern of 1 is all", mode)
  end
  for _, o in ipairs { 0.49, 0.5 } do
    local want = o < 0.5 and none or all
    check(bits(seen(plain({ 1, 0, 0 }, { opacity = o, opacity_mode = "cut" }))) == want, "the number %g cuts", o)
    check(bits(seen(plain({ 1, 0, 0 }, { opacity = constant(o) }))) == want, "a pattern of %g cuts", o)
    local number, worst = seen(plain({ 1, 0, 0 }, { opacity = o })), 0
    local pattern = seen(plain({ 1, 0, 0 }, { opacity = constant(o), opacity_mode = "blend" }))
    for y = 0, H - 1 do
      for x = 0, W - 1 do worst = math.max(worst, math.abs(number:pixel(x, y) - pattern:pixel(x, y))) end
    end
    near(worst, 0, ROUNDING, ("a pattern that blends is the number %g"):format(o))
  end
  raises('material.opacity_mode: "auto", "cut" or "blend" expected', glint.material, { opacity_mode = "mix" })
end

-- A blending pattern equals its value at each point; values are clamped to 0 .. 1, and NaN becomes 0.
function tests.patterns_may_blend()
  for name, fields in pairs(looks) do
    local constant = glint.pattern(function(p) return 0.3 + 0 * p.x end)
    local worst = superposition(square, fields, { value = constant, mode = "blend", number = 0.3 })
    near(worst, 0, 6e-6, name)
  end
  local level = { value = glint.pattern(function(p) return 0.3 + 0 * p.x end), mode = "blend", number = 0.3 }
  near(superposition(fan "gouraud", looks.phong, level), 0, 6e-6, "gouraud")
  local ramp = glint.pattern(function(p) return p.x end)
  local left = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 }, projection = "orthographic", height = 3 }, ambient = 1,
    background = { 0.2, 0.4, 0.6 }, sheet(0, plain({ 1, 0, 0 }, { opacity = ramp, opacity_mode = "blend" }), 2) }
  local image = left:render { width = 30, height = 30 }
  for x = 0, 29 do
    local o = math.min(math.max((x + 0.5 - 15) / 10, 0), 1)
    near((image:pixel(x, 15)), o + (1 - o) * 0.2, ROUNDING, "a ramp at " .. x)
  end
  local odd = glint.pattern(function(p) return glint.sqrt(-1 - p.y * p.y) end)
  is(look { sheet(0, plain({ 1, 0, 0 }, { opacity = odd, opacity_mode = "blend" })) }, { 0.2, 0.4, 0.6 }, "NaN is nothing")
  local tiles = glint.texture { file = "scripts/data/tiles.png" }
  local leaf = glint.mesh { vertices = { { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 } }, faces = { { 1, 2, 3, 4 } },
    uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } },
    material = plain({ 1, 0, 0 }, { opacity = glint.pattern(function(_, s) return tiles(s.uv).r end), opacity_mode = "blend" }) }
  local cards = look({ leaf }, { background = 0 })
  local shown = glint.mesh { vertices = { { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 } }, faces = { { 1, 2, 3, 4 } },
    uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, material = plain(glint.pattern(function(_, s) return tiles(s.uv).r end)) }
  near((cards:pixel(4, 4)), (look({ shown }, { background = 0 }):pixel(4, 4)), ROUNDING, "a picture that blends")
end

-- ---- Indirect light ----

-- In a white world with light 1 everything looks like light 1, however much of it is translucent: energy is conserved.
function tests.no_light_is_lost()
  local o = 0.4
  local white = plain(1, { opacity = o })
  local cases = {
    sheet = { sheet(0, white, 2) },
    sheets = { sheet(0, white, 2), sheet(-1, white, 2), sheet(-2, white, 2) },
    ball = { glint.sphere { center = { 0, 0, 0 }, radius = 1, material = white } },
    floor = { glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = plain(1) },
      glint.sphere { center = { 0, 0, 0 }, radius = 1, material = white } },
    mirror = { sheet(0, plain(0.5, { mirror = 0.5, opacity = o }), 2), glint.sphere { center = { 0, 0, 3 }, radius = 0.5, material = white } },
  }
  for name, objects in pairs(cases) do
    for _, bounces in ipairs { 1, 3 } do
      local image = look(objects, { background = 1, indirect = { samples = 7, bounces = bounces } })
      is(image, { 1, 1, 1 }, ("%s, %d bounces"):format(name, bounces))
    end
  end
end

-- Black sheets above a white floor leave (1 - o)^n of the light from above, without noise.
function tests.light_from_all_around_goes_through()
  local o = 0.3
  local black = plain(0, { opacity = o })
  for count = 0, 3 do
    local objects = { glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = plain(1) } }
    for k = 1, count do objects[k + 1] = glint.plane { point = { 0, 2 + k, 0 }, normal = { 0, 1, 0 }, material = black } end
    local below = { camera = glint.camera { eye = { 0, 1, 4 }, at = { 0, 0, 0 } }, ambient = 0, background = 1 }
    below.indirect = { samples = 4, bounces = 1 }
    is(look(objects, below), { (1 - o) ^ count, (1 - o) ^ count, (1 - o) ^ count }, count .. " sheets over the floor")
    below.indirect, below.ambient = nil, 1
    objects[#objects + 1] = glint.ambient_occlusion { samples = 4, distance = math.huge }
    is(look(objects, below), { (1 - o) ^ count, (1 - o) ^ count, (1 - o) ^ count }, count .. " sheets, ambient occlusion")
  end
end

-- ---- Passes ----

function tests.passes_are_of_the_first_surface()
  local front = sheet(1, plain({ 0.6, 0.2, 0.1 }, { opacity = 0.25 }))
  local image = look({ front, sheet(0, plain { 0, 1, 0 }) }, {}, { passes = { "beauty", "depth", "normal", "object_id", "albedo", "transmission", "ambient" } })
  near((image:pixel(4, 4, "depth")), 8, 1e-5, "depth")
  is(image, { 0, 0, 1 }, "normal", "normal")
  is(image, { 0.6, 0.2, 0.1 }, "albedo, without the opacity", "albedo")
  is(image, { 0.15, 0.05, 0.025 }, "ambient, with it", "ambient")
  is(image, { 0, 0.75, 0 }, "what is behind", "transmission")
  near((image:pixel(4, 4, "object_id")), 1, 0, "the first object")
end

-- The pass of each light equals the picture without the other lights.
function tests.light_passes_add_up()
  local function picture(only)
    local scene = glint.scene { camera = camera { eye = { 1, 2, 7 } }, ambient = only and 0 or 0.2, background = only and 0 or { 0.2, 0.4, 0.6 },
      backdrop(), square(plain({ 0.9, 0.4, 0.2 }, { opacity = 0.4, specular = 0.4 })),
      glint.sphere { center = { 0.4, 0, -1.5 }, radius = 0.8, material = plain({ 0.2, 0.4, 0.9 }, { opacity = 0.6, mirror = 0.2 }) } }
    if only ~= "b" then scene:add(glint.point_light { name = "a", position = { 3, 5, 6 } }) end
    if only ~= "a" then
      scene:add(glint.disk_light { name = "b", position = { -3, 4, 5 }, normal = { 3, -4, -5 }, radius = 1, samples = 5, intensity = 0.5 })
    end
    return scene:render { width = W, height = H, passes = only and "beauty" or "beauty,light:a,light:b,light:ambient" }
  end
  local image, a, b, worst = picture(), picture "a", picture "b", { 0, 0, 0 }
  for y = 0, H - 1 do
    for x = 0, W - 1 do
      local all, la, lb, rest = (image:pixel(x, y)), (image:pixel(x, y, "light:a")), (image:pixel(x, y, "light:b")), (image:pixel(x, y, "light:ambient"))
      worst[1] = math.max(worst[1], math.abs(all - (la + lb + rest)))
      worst[2] = math.max(worst[2], math.abs(la - a:pixel(x, y)))
      worst[3] = math.max(worst[3], math.abs(lb - b:pixel(x, y)))
    end
  end
  for k, name in ipairs { "the sum", "light:a", "light:b" } do near(worst[k], 0, 4e-6, name) end
end

-- ---- Alpha ----

-- Alpha is 1 minus the light from the background; the colour excludes the background.
function tests.alpha_follows_what_is_let_through()
  local o, red = 0.3, plain({ 1, 0, 0 }, { opacity = 0.3 })
  local pane = plain(0, { transmission = { 0.9, 0.6, 0.3 }, ior = 1 })
  local glass = plain(0, { transmission = 0.9, ior = 1.5 })
  local cases = {
    { "a sheet", { sheet(0, red) }, o, { o, 0, 0 } },
    { "two sheets", { sheet(0, red), sheet(-1, red) }, 1 - (1 - o) ^ 2, { o + (1 - o) * o, 0, 0 } },
    { "before something", { sheet(0, red), sheet(-1, plain { 0, 1, 0 }) }, 1, { o, 1 - o, 0 } },
    { "a clear pane", { sheet(0, pane) }, 0.4, { 0, 0, 0 } },
    { "a clear ball", { glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glass } }, 1 - 0.81, { 0, 0, 0 } },
    { "before a mirror", -- the mirror shows the other side of the sheet, and the background
      { sheet(0, red), sheet(-1, plain(0, { mirror = 1 })) }, 1, { o + (1 - o) * (o + (1 - o) * 0.2), (1 - o) ^ 2 * 0.4, (1 - o) ^ 2 * 0.6 } },
    { "more than all", { sheet(0, plain(0, { transmission = 3, ior = 1 })) }, 0, { 0, 0, 0 } },
    { "nothing", {}, 0, { 0, 0, 0 } },
  }
  local skies = { color = { 0.2, 0.4, 0.6 }, pattern = glint.pattern(function(d) return { 0.2 + 0 * d.x, 0.4, 0.6 } end) }
  for sky, background in pairs(skies) do
    for _, case in ipairs(cases) do
      local name, objects, alpha, light = table.unpack(case)
      for _, options in ipairs { {}, { samples = 5 }, { samples = 4, adaptive = 0.1 } } do
        options.alpha, options.passes = true, "beauty,alpha"
        local image = look(objects, { background = background }, options)
        near((image:pixel(4, 4, "alpha")), alpha, ROUNDING, name .. ": alpha before a " .. sky)
        is(image, light, name .. " before a " .. sky)
      end
      local kept = look(objects, { background = background }, { passes = "beauty,alpha" })
      near((kept:pixel(4, 4, "alpha")), alpha, ROUNDING, name .. ": alpha, the background kept")
    end
  end
  local lamp = glint.disk_light { position = { 0, 0, -4 }, normal = { 0, 0, 1 }, radius = 2, radiance = 1 / math.pi, visible = true, shadows = false }
  local lit = look({ sheet(0, plain({ 1, 0, 0 }, { opacity = o, ambient = 0, diffuse = 0 })), lamp }, {}, { alpha = true, passes = "beauty,alpha" })
  near((lit:pixel(4, 4, "alpha")), 1, ROUNDING, "a light is something")
  is(lit, { 0.7, 0.7, 0.7 }, "a light behind a sheet")
end

-- ---- Derivatives ----

function tests.light_has_derivatives_by_opacity()
  local x = glint.variable("x", 0.3)
  local red = plain({ 1, 0, 0 }, { opacity = x })
  is(look({ sheet(0, red) }, {}, { passes = "d:x" }), { 1 - 0.2, -0.4, -0.6 }, "a sheet", "d:x")
  is(look({ sheet(0, red), sheet(-1, red) }, {}, { passes = "d:x" }),
    { 1 - 0.3 + 0.7 - 2 * 0.7 * 0.2, -2 * 0.7 * 0.4, -2 * 0.7 * 0.6 }, "two", "d:x")
  local function compare(name, make)
    local h = 1e-3
    local function picture(value)
      return make(value):render { width = W, height = H, passes = type(value) == "number" and "beauty" or "beauty,d:x" }
    end
    local image, below, above, worst, most = picture(glint.variable("x", 0.4)), picture(0.4 - h), picture(0.4 + h), 0, 0
    for py = 0, H - 1 do
      for px = 0, W - 1 do
        local slope = (above:pixel(px, py) - below:pixel(px, py)) / (2 * h)
        worst, most = math.max(worst, math.abs(image:pixel(px, py, "d:x") - slope)), math.max(most, math.abs(slope))
      end
    end
    check(most > 0.1 and worst < 5e-4, "%s: off by %g of %g", name, worst, most)
  end
  local function scene(material, shadows, more)
    return glint.scene { camera = camera { eye = { 1, 2, 7 } }, ambient = 0.3, background = { 0.2, 0.4, 0.6 },
      glint.point_light { position = { 3, 5, 6 }, shadows = shadows }, backdrop(), square(material),
      glint.sphere { center = { 0.4, 0, -1.5 }, radius = 0.8, material = more or material } }
  end
  local painted = { pattern = true, shiny = true, ["a pattern's mirror"] = true, shader = true, ["a painted shader"] = true }
  for name, fields in pairs(looks) do
    local function make(value)
      local own = { opacity = value }
      for key, field in pairs(fields) do own[key] = field end
      own.mirror = own.model == "cook_torrance" and 0 or own.mirror -- rays of rough surfaces have no derivative
      return scene(glint.material(own), false, plain({ 0.2, 0.4, 0.9 }, { opacity = 0.6 }))
    end
    if painted[name] then
      raises("derivative 'x': material.opacity: it has no derivative where patterns or a shader", function()
        make(x):render { width = 8, height = 6, passes = "d:x" }
      end)
    else
      compare(name, make)
    end
  end
  compare("in shadows", function(value) return scene(plain({ 0.9, 0.4, 0.2 }, { opacity = value, specular = 0.4 }), true) end)
  compare("a colour", function(value) return scene(plain({ value, 0.4, 0.2 }, { opacity = 0.4, mirror = value }), false) end)
  compare("what moves", function(value)
    local all = scene(plain({ 0.9, 0.4, 0.2 }, { opacity = 0.4 }), false)
    all.ambient = 0.3 * value
    return all
  end)
  for _, opacity in ipairs { 0, 1 } do
    raises("derivative 'e': material.opacity: 0, 1 and cut-outs have no derivative", look,
      { sheet(0, plain({ 1, 0, 0 }, { opacity = glint.variable("e", opacity) })) }, {}, { passes = "d:e" })
  end
  raises("derivative 'x': material.opacity: 0, 1 and cut-outs", look,
    { sheet(0, plain({ 1, 0, 0 }, { opacity = x, opacity_mode = "cut" })) }, {}, { passes = "d:x" })
  raises("derivative 'x': material.opacity: a material has no derivative where a pattern blends it", look,
    { sheet(0, plain({ x, 0, 0 }, { opacity = glint.pattern(function(p) return p.y end), opacity_mode = "blend" })) }, {}, { passes = "d:x" })
end

-- ---- The plan ----

function tests.explain_names_translucent_materials()
  local pipe = assert(io.popen(BUILD .. "/glint explain scripts/translucent.lua 2>&1"))
  local text = pipe:read "a"
  pipe:close()
  check(text:find("translucent surface +material of sphere #2") and text:find("tinted shadow +material of sphere #2"), "translucent: %s", text)
  check(not text:find("material of plane #1\n") and text:find("\n  bounce "), "the stage that they call for")
  pipe = assert(io.popen(BUILD .. "/glint explain scripts/translucent.lua --set opacity=1 2>&1"))
  text = pipe:read "a"
  pipe:close()
  check(not text:find "translucent surface" and not text:find "tinted shadow" and not text:find("\n  bounce "), "opaque: %s", text)
end

-- ---- The same bits ----

local function random_scene(seed)
  math.randomseed(seed)
  local function random(low, high) return low + (high - low) * math.random() end
  local function color() return { math.random(), math.random(), math.random() } end
  local kinds = {
    function() return { opacity = math.random() } end,
    function() return { opacity = math.random(), mirror = 0.3, specular = 0.4 } end,
    function() return { opacity = math.random(), transmission = 0.7, absorption = 0.2, fresnel = math.random() < 0.5 } end,
    function() return { opacity = glint.pattern(function(p) return 0.5 + glint.noise(p * 2) end), opacity_mode = "blend", specular = 0.3 } end,
    function() return { opacity = glint.pattern(function(p) return 0.5 + glint.noise(p * 2) end) } end,
    function() return { opacity = math.random(), model = glint.shader(function(s) return s.light * s.kd * glint.max(0, s.n:dot(s.l)) end) } end,
    function() return {} end,
  }
  local function material() return plain(color(), kinds[math.random(#kinds)]()) end
  local function place() return { random(-2, 2), random(-1, 2), random(-2, 2) } end
  local fields = { camera = camera { eye = { 1, 2, 7 } }, ambient = 0.2, background = color() }
  fields[1] = glint.plane { point = { 0, -1.2, 0 }, normal = { 0, 1, 0 }, material = material() }
  for i = 2, 6 do
    local kind = math.random(4)
    fields[i] = kind == 1 and glint.box { min = { -0.6, -0.6, -0.6 }, max = { 0.6, 0.6, 0.6 }, transform = glint.translate(place()), material = material() } or
      kind == 2 and glint.sphere_mesh { center = place(), radius = 0.8, segments = 8, shading = ({ "flat", "gouraud", "phong" })[math.random(3)],
        material = material() } or
      glint.sphere { center = place(), radius = random(0.4, 1), material = material() }
  end
  fields[7] = glint.point_light { position = { 3, 5, 6 }, intensity = 0.6 }
  fields[8] = glint.sphere_light { position = { -3, 4, 2 }, radius = 0.5, samples = 3, intensity = 0.5 }
  if seed % 3 == 0 then fields.indirect = { samples = 2, bounces = 2 } end
  return glint.scene(fields), fields
end

local function options_of(seed)
  return { width = W, height = H, samples = seed % 4 == 0 and 3 or 1, precision = seed % 5 == 0 and "float" or "double",
    alpha = seed % 2 == 0, passes = "beauty,alpha" }
end

if arg and arg[1] == "digest" then
  for seed = 1, 24, tally.step do
    local image = random_scene(seed):render(options_of(seed))
    io.write(bits(image), "\n")
    for x = 0, W - 1 do io.write(("%a "):format(image:pixel(x, H // 2, "alpha"))) end
  end
  os.exit(true)
end

function tests.instruction_sets_agree()
  local first, count = nil, 0
  for _, isa in ipairs(tally.instruction_sets) do
    local pipe = assert(io.popen(("BUILD=%s GLINT_ISA=%s %s %s digest 2>/dev/null"):format(BUILD, isa, arg[-1] or "lua5.4", arg[0])))
    local text = pipe:read "a"
    pipe:close()
    if text ~= "" then -- the text is empty when this machine or build lacks the instruction set
      count, first = count + 1, first or text
      check(#text * tally.step > 24 * W * H * 20, "%s: %s", isa, text:sub(1, 200))
      check(text == first, "%s has the bits of ref", isa)
    end
  end
  check(count >= 2, "some instruction sets were compared")
end

-- Cached results are used only where they still apply: a changing scene has the same bits as one rendered afresh.
function tests.frames_that_reuse_have_the_same_bits()
  for seed = 1, 12, tally.step do
    local scene, fields = random_scene(seed)
    local options = options_of(seed)
    scene:render(options)
    local changes = {
      opacity = function(f) f[3].material.opacity = 0.37 end,
      mode = function(f) f[4].material.opacity_mode = f[4].material.opacity_mode == "cut" and "blend" or "cut" end,
      diffuse = function(f) f[5].material.diffuse = { 0.9, 0.1, 0.4 } end,
      light = function(f) f[7].position = { 1, 6, 5 } end,
      pattern = function(f)
        f[2].material.opacity_mode = "blend"
        f[2].material.opacity = glint.pattern(function(p) return 0.5 + 0.4 * glint.noise(p) end)
      end,
      gone = function(f) f[6].material.opacity = 0 end,
    }
    local done = {}
    for _, name in ipairs { "opacity", "light", "mode", "diffuse", "pattern", "gone" } do
      done[#done + 1] = name
      changes[name](fields)
      local anew, fresh = random_scene(seed)
      for _, before in ipairs(done) do changes[before](fresh) end
      check(bits(scene:render(options)) == bits(anew:render(options)), "scene %d: %s", seed, name)
    end
  end
end

tally.run(tests)
tally.finish()
