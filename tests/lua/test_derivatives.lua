-- Derivatives by variables: properties that need no formula, differences, dual numbers, errors, identical bits.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"
local BUILD = os.getenv "BUILD" or "build"

local W, H = 48, 36
local tests = {}

local function render(scene, passes, more)
  local fields = { width = W, height = H, passes = passes, output = "none" }
  for name, value in pairs(more or {}) do fields[name] = value end
  return scene:render(fields)
end

-- Makes a scene of a shiny ball above a matt floor.
local function scene_of(lamp, more)
  more = more or {}
  return glint.scene { camera = glint.camera { eye = { 0, 2, 8 }, at = { 0, 0, 0 } }, ambient = more.ambient or 0,
    background = more.background or 0, reflection_samples = more.reflection_samples, lamp,
    glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.5 } },
    glint.sphere { center = { 0, 0, 0 }, radius = 1, material = more.material or
      glint.material { diffuse = { 0.7, 0.2, 0.1 }, specular = 0.5, shininess = 20 } } }
end

-- Calls f with the three numbers of each pixel of two passes, from one or two images.
local function each(a, pass_a, b, pass_b, f)
  for y = 0, H - 1 do
    for x = 0, W - 1 do
      local p, q = { a:pixel(x, y, pass_a) }, { b:pixel(x, y, pass_b) }
      for c = 1, 3 do f(p[c], q[c], x, y) end
    end
  end
end

-- Returns the largest difference between pass a and k times pass b, relative to the largest value of a.
local function off(a, pass_a, b, pass_b, k)
  local worst, most = 0, 0
  each(a, pass_a, b, pass_b, function(p, q)
    worst, most = math.max(worst, math.abs(p - k * q)), math.max(most, math.abs(p))
  end)
  check(most > 0, "%s is 0 everywhere", pass_a)
  return worst / most
end

function tests.light_is_linear_in_its_intensity()
  for _, kind in ipairs { "point", "spot", "directional", "disk", "sphere" } do
    local fields = { intensity = glint.variable("strength", 1.7) }
    if kind ~= "directional" then fields.position = { 2, 4, 3 } end
    if kind == "spot" or kind == "directional" then fields.direction = { -2, -4, -3 } end
    if kind == "spot" then fields.inner, fields.outer = 10, 20 end
    if kind == "disk" then fields.normal = { -2, -4, -3 } end
    if kind == "disk" or kind == "sphere" then fields.radius = 0.6 end
    local image = render(scene_of(glint[kind .. "_light"](fields)), "d:strength")
    near(off(image, "d:strength", image, "beauty", 1 / 1.7), 0, 4e-7, kind .. " light by its intensity")
  end
  for _, shadow in ipairs { "rays", "caps", "hard" } do
    local lamp = glint.sphere_light { position = { 2, 4, 3 }, radius = 0.6, shadow = shadow,
      radiance = glint.variable("strength", 3) }
    local image = render(scene_of(lamp), "d:strength", { samples = 4 })
    near(off(image, "d:strength", image, "beauty", 1 / 3), 0, 4e-7, "radiance with shadows by " .. shadow)
  end
end

function tests.a_dark_lamp_has_a_derivative()
  local dark = render(scene_of(glint.point_light { position = { 2, 4, 3 }, intensity = glint.variable("strength", 0) }),
    "d:strength")
  local lit = render(scene_of(glint.point_light { position = { 2, 4, 3 } }), "beauty")
  near(off(dark, "d:strength", lit, "beauty", 1), 0, 4e-7, "a lamp of intensity 0")
end

function tests.chain_rule()
  local t = glint.variable("t", 0.8)
  local strength = t ^ 2 * math.sin(t) + glint.exp(-t) / (1 + t) + math.sqrt(t) - math.min(t, 2)
  local s = glint.value(strength)
  local function of(x) return x ^ 2 * math.sin(x) + math.exp(-x) / (1 + x) + math.sqrt(x) - x end
  near(s, of(0.8), 1e-15, "the value")
  local slope = (of(0.8 + 1e-5) - of(0.8 - 1e-5)) / 2e-5
  local image = render(scene_of(glint.point_light { position = { 2, 4, 3 }, intensity = strength }), "d:t")
  near(off(image, "d:t", image, "beauty", slope / s), 0, 1e-6, "through a curved function")
end

function tests.passes_add_up()
  local x, y, both = glint.variable("x", 2), glint.variable("y", 4), glint.variable("both", 0)
  local lamp = glint.point_light { position = { x + 2 * both, y - 3 * both, 3 }, attenuation = { 1, 0, 0.02 } }
  local image = render(scene_of(lamp), "d:x,d:y,d:both")
  check(table.concat(image.passes, " ") == "beauty d:x d:y d:both", "passes are %s", table.concat(image.passes, " "))
  local worst = 0
  for py = 0, H - 1 do
    for px = 0, W - 1 do
      local dx, dy, d = image:pixel(px, py, "d:x"), image:pixel(px, py, "d:y"), image:pixel(px, py, "d:both")
      worst = math.max(worst, math.abs(d - (2 * dx - 3 * dy)))
    end
  end
  near(worst, 0, 1e-6, "2 d:x - 3 d:y")
  lamp.y = 4 -- sets only a component: after this, nothing depends on y
  local ok, message = pcall(render, lamp and scene_of(lamp), "d:y")
  check(not ok and message:find("derivative 'y': nothing in the scene depends on it", 1, true), "got %s", message)
  check(glint.value(lamp.x) == 2 and tostring(lamp.position[1]) == "2.0", "fields read back as they were written")
end

-- Where nothing changes at a frame's own time, the derivative is 0. Where nothing depends on the name, it is an error.
function tests.level_here_is_no_error()
  local x, y = glint.variable("x", 2), glint.variable("y", 0)
  local image = render(scene_of(glint.point_light { position = { 2, 4, 3 + y ^ 2 }, intensity = (x - 2) ^ 2 + 1 }), "d:x,d:y")
  local most = 0
  each(image, "d:x", image, "d:y", function(p, q) most = math.max(most, math.abs(p), math.abs(q)) end)
  check(most == 0, "slopes of 0 give %g", most)
  local function refused(what, scene, options)
    local ok, message = pcall(render, scene, "d:x", options)
    check(not ok and message:find("derivative 'x': nothing in the scene depends on it", 1, true), "%s: got %s", what, message)
  end
  local level, lamp = (x - 2) ^ 2, glint.point_light { position = { 2, 4, 3 } }
  glint.point_light { position = { level, 0, 0 } } -- a light that is in no scene
  refused("a lamp that is in no scene", scene_of(lamp))
  refused("what nothing reads", scene_of(lamp, { material = glint.material { mirror = 0.5, ior = 1.5 + level } }))
  refused("a mirror that sends nothing on", scene_of(lamp, { material = glint.material { mirror = 0.5 + level } }), { max_depth = 0 })
  image = render(scene_of(lamp, { material = glint.material { mirror = 0.5 + level } }), "d:x")
  check(image:pixel(24, 18, "d:x") == 0, "a mirror that is level")
  for what, fields in pairs {
    ["a pattern that is level"] = { diffuse = glint.pattern(function(p) return 0.5 + level * p.x * 1e9 end) },
    ["one with a root of 0"] = { diffuse = glint.pattern(function(p) return 0.5 + glint.sqrt(level * glint.abs(p.x)) end) },
    ["a shader that is level"] = { model = glint.shader(function(s) return s.kd * s.light * (level + glint.dot(s.n, s.l)) end) },
  } do
    most = 0
    image = render(scene_of(lamp, { material = glint.material(fields) }), "d:x")
    each(image, "d:x", image, "d:x", function(p) most = math.max(most, math.abs(p)) end)
    check(most == 0, "%s: slopes of 0 give %g", what, most)
  end
  refused("a pattern without it", scene_of(lamp, { material = glint.material { diffuse = glint.pattern(function(p) return p.x end) } }))
end

-- Lights in no scene, which are collected at any time, also while a frame is planned.
function tests.objects_in_no_scene_are_collected()
  local x = glint.variable("x", 2)
  local scene = scene_of(glint.point_light { position = { 2, 4, x } })
  local function slope() return render(scene, "d:x", { width = 4, height = 4 }):pixel(2, 1, "d:x") end
  local usual = slope()
  collectgarbage "generational"
  for i = 1, 2000 do
    for _ = 1, 3 do glint.point_light { position = { x, 0, 0 } } end
    local now = slope()
    if now ~= usual then check(false, "slope %g at picture %d, first %g", now, i, usual) end
  end
  collectgarbage "incremental"
end

-- Area lights against differences of pictures, which float32 limits to five digits. Samples move with their light.
function tests.area_lights_against_differences()
  local function compare(name, make, at, h)
    local image = render(make(glint.variable("p", at)), "d:p")
    local high, low = render(make(at + h), "beauty"), render(make(at - h), "beauty")
    local list, most = {}, 0
    each(high, "beauty", low, "beauty", function(p, q) list[#list + 1] = (p - q) / (2 * h) end)
    local distances = {}
    each(image, "d:p", image, "d:p", function(d)
      distances[#distances + 1] = math.abs(d - list[#distances + 1])
      most = math.max(most, math.abs(d))
    end)
    table.sort(distances) -- takes the 99th percentile: there is a step where a light sample rises above the horizon
    local worst = distances[#distances * 99 // 100]
    check(most > 0 and worst < 1e-3 * most, "%s: off by %.2g of %.2g", name, worst, most)
  end
  compare("disk by radiance", function(x) return scene_of(glint.disk_light { position = { x, 4, 3 }, radius = 0.5,
    normal = { -2, -4, -3 }, radiance = 3, shadows = false }) end, 2, 1e-2)
  compare("disk by intensity", function(x) return scene_of(glint.disk_light { position = { 2, x, 3 }, radius = 0.5,
    normal = { -2, -4, -3 }, attenuation = { 1, 0.1 * x, 0.01 }, shadows = false }) end, 4, 1e-2)
  compare("sphere by intensity", function(x) return scene_of(glint.sphere_light { position = { 2, 4, x }, radius = 0.5,
    shadows = false }) end, 3, 1e-2)
  compare("polygon by radiance", function(x) return scene_of(glint.polygon_light { two_sided = true, radiance = x * x,
    vertices = { { 2, 4, 3 }, { 3, 4, 3 }, { 3, 4, 2 } } }) end, 2, 1e-2)
  compare("what the sky and the ambient light are", function(x)
    return scene_of(glint.point_light { position = { 2, 4, 3 }, ambient = { 0, x * 0.1, 0 } },
      { ambient = x ^ 2 * 0.1, background = { x * 0.1, 0, math.cos(x) ^ 2 } })
  end, 1.3, 1e-2)
  compare("a shininess through math and comparisons", function(x)
    local s = x > 5 and math.max(x * 2, 3) or 0
    return scene_of(glint.point_light { position = { 2, 4, 3 } },
      { material = glint.material { diffuse = 0.1, specular = 0.5, shininess = math.abs(-s) } })
  end, 10, 1e-1)
end

-- Returns how far the derivative by a scene's number `at` is from a difference, and the derivative's largest value. The
-- distance is the 98th percentile: shadows have edges.
local function away(make, at, h)
  local image = render(make(glint.variable("p", at)), "d:p")
  local high, low = render(make(at + h), "beauty"), render(make(at - h), "beauty")
  local list, most, distances = {}, 0, {}
  each(high, "beauty", low, "beauty", function(p, q) list[#list + 1] = (p - q) / (2 * h) end)
  each(image, "d:p", image, "d:p", function(d)
    distances[#distances + 1] = math.abs(d - list[#distances + 1])
    most = math.max(most, math.abs(d))
  end)
  table.sort(distances)
  return distances[#distances * 49 // 50], most
end

-- Tests each row of a material that takes a variable: in the materials that give the field, or with its default.
function tests.every_field_of_a_material()
  local given = {}
  local materials = {
    { diffuse = 0.4, ambient = 0.3, specular = 0.5, shininess = 9 },
    { diffuse = 0.3, model = "cook_torrance", specular = 0.7, roughness = 0.4, f0 = 0.3 },
    { diffuse = 0.2, specular = 0.5, shininess = 5, mirror = 0.3, transmission = 0.6, ior = 1.4, absorption = 0.3 },
    { diffuse = 0.5, specular = 0.4, shininess = 7, opacity = 0.6 },
  }
  for _, fields in ipairs(materials) do
    for name in pairs(fields) do given[name] = true end
  end
  for _, row in ipairs(glint._rows "material") do
    local seen = 0
    for i, fields in ipairs(row.takes_variable and materials or {}) do
      local at = fields[row.name] or not given[row.name] and row.default
      local function make(x)
        local copy = { [row.name] = x }
        for name, value in pairs(fields) do copy[name] = copy[name] or value end
        local lamp = glint.point_light { position = { 2, 4, 3 }, shadows = false }
        return scene_of(lamp, { material = glint.material(copy), ambient = 0.3, background = 0.2, reflection_samples = 0 })
      end
      if at then
        local worst, most = away(make, at, 1e-2)
        check(worst < 2e-3 * math.max(most, 1e-3), "material %d by %s: off by %.2g of %.2g", i, row.name, worst, most)
        seen = math.max(seen, most)
      end
    end
    check(seen > 0 or not row.takes_variable, "nothing depends on %s", row.name)
  end
end

-- Tests derivatives next to patterns whose results they do not change.
function tests.beside_patterns_against_differences()
  local function compare(name, make)
    local worst, most = away(make, 2, 1e-2)
    check(most > 0 and worst < 1e-3 * most, "%s: off by %.2g of %.2g", name, worst, most)
  end
  local wave = glint.pattern(function(p) return 0.4 + 0.3 * glint.sin(5 * p.y) end)
  local exponent = glint.pattern(function(p) return 20 + 10 * glint.sin(5 * p.y) end)
  local color = glint.pattern(function(p) return { 0.4 + 0.3 * glint.sin(3 * p.x), 0.3, 0.5 } end)
  local function with(x, fields, floor)
    fields.diffuse = color
    local scene = scene_of(glint.point_light { position = { x, 4, 3 }, attenuation = { 1, 0, 0.02 }, ambient = 0.1 * x },
      { material = glint.material(fields), ambient = 0.1, background = 0.2 })
    scene:add(glint.plane { point = { 0, 0, -3 }, normal = { 0, 0, 1 }, material = glint.material(floor or { diffuse = color, ambient = wave }) })
    return scene
  end
  compare("colours", function(x) return with(x, { specular = wave, shininess = 2 * x }) end)
  compare("exponents", function(x) return with(x, { specular = 0.5, shininess = exponent }) end)
  compare("even highlights", function(x)
    return with(x, { specular = 0.5, shininess = exponent, model = "blinn_phong", normalized = true, matched = true })
  end)
  compare("even highlights by a colour", function(x) return with(x, { specular = wave, shininess = 5 * x, normalized = true }) end)
  compare("microfacets", function(x)
    return with(x, { model = "cook_torrance", mirror = 0, f0 = x / 4, specular = wave, roughness = wave })
  end)
  compare("mirrors", function(x) return with(x, { mirror = wave }, { diffuse = color, mirror = x / 4 }) end)
  compare("flat and smooth corners", function(x)
    local scene = with(x, { specular = wave, shininess = exponent })
    for i, shading in ipairs { "flat", "gouraud" } do
      scene:add(glint.sphere_mesh { center = { 3 - 2 * i, 0, 2 }, radius = 0.6, segments = 9, shading = shading,
        material = glint.material { diffuse = color, ambient = wave, specular = wave, shininess = 2 * x } })
    end
    scene:add(glint.box { min = { -2, 2, 1 }, max = { 2, 2.1, 3 }, material = glint.material { diffuse = 0.2, transmission = { x / 4, 0.5, 0.2 } } })
    return scene
  end)
  compare("bumps", function(x) return with(x, { mirror = x / 5, fresnel = true, bump = wave }) end)
  compare("holes", function(x) return with(x, { mirror = x / 5, opacity = wave }) end)
end

-- Compares the pass d:p of `image` with the difference of two frames over 2 h. Takes the quantile `share`, as the
-- other pixels are at edges. The picture must equal the one with plain numbers.
local function is_slope(name, image, plain, high, low, h, share)
  local list, most, distances, same = {}, 0, {}, true
  each(high, "beauty", low, "beauty", function(p, q) list[#list + 1] = (p - q) / (2 * h) end)
  each(image, "beauty", plain, "beauty", function(p, q) same = same and p == q end)
  each(image, "d:p", image, "d:p", function(d)
    distances[#distances + 1] = math.abs(d - list[#distances + 1])
    most = math.max(most, math.abs(d))
  end)
  table.sort(distances)
  local worst = distances[math.floor(#distances * share)]
  check(most > 0 and worst < 2e-3 * most, "%s: off by %.2g of %.2g", name, worst, most)
  check(same, "%s: the picture is that of plain numbers", name)
end

-- Tests derivatives by variables in patterns.
function tests.patterns_against_differences()
  local function compare(name, fields)
    local at, h = 2, 1e-3
    local function make(x)
      local list = { diffuse = 0.4, specular = 0.3, shininess = 9 }
      for key, value in pairs(fields(x)) do
        list[key] = type(value) == "function" and glint.pattern(value) or value
      end
      list.floor, list.mesh = nil, nil
      local floor = glint.pattern(function(p) return 0.4 + 0.3 * glint.sin(x * p.x) end)
      local scene = scene_of(glint.point_light { position = { 2, 4, 3 }, shadows = false },
        { material = glint.material(list), ambient = 0.1, background = 0.2 })
      scene:add(glint.plane { point = { 0, 0, -3 }, normal = { 0, 0, 1 }, material = glint.material { diffuse = fields(x).floor and floor or 0.4 } })
      if fields(x).mesh then
        scene:add(glint.sphere_mesh { center = { 1, 0, 2 }, radius = 0.6, segments = 9, shading = "gouraud", material = glint.material(list) })
        scene:add(glint.sphere_mesh { center = { -1, 0, 2 }, radius = 0.6, segments = 9, shading = "flat", material = glint.material(list) })
      end
      return scene
    end
    local image = render(make(glint.variable("p", at)), "d:p")
    local plain, high, low = render(make(at), "beauty"), render(make(at + h), "beauty"), render(make(at - h), "beauty")
    is_slope(name, image, plain, high, low, h, 49 / 50)
  end
  compare("colours", function(x)
    return { diffuse = function(p) return { 0.4 + 0.3 * glint.sin(x * p.x), 0.1 * x, p.y * x } end }
  end)
  compare("vectors and choices", function(x)
    return { diffuse = function(p)
      local q = x * p + p * x - p / x
      return glint.mix({ 0.1, 0.1 * x, 0.3 }, 0.1 * q, glint.smoothstep(-x, x, glint.max(p.x, p.y / x)))
    end }
  end)
  compare("noise and cells", function(x)
    return { diffuse = function(p) return 0.4 + 0.2 * glint.noise(x * p) + 0.1 * glint.cell(p * x) ^ x end }
  end)
  compare("whole parts", function(x)
    return { diffuse = function(p) return 0.1 * x + 0.01 * (x // (2 + p.x)) + 0.01 * ((p.y + 2) // x) end }
  end)
  compare("corners", function(x)
    return { mesh = true, diffuse = function(p) return 0.4 + 0.3 * glint.sin(x * p.y) end, shininess = function(p) return 9 + x * p.x end }
  end)
  compare("specular", function(x) return { specular = function(p) return 0.4 + 0.3 * glint.sin(x * p.y) end } end)
  compare("shininess", function(x) return { shininess = function(p) return 20 + 10 * glint.sin(x * p.y) end } end)
  compare("an even highlight", function(x)
    return { model = "blinn_phong", normalized = true, matched = true, shininess = function(p) return 20 + 10 * glint.sin(x * p.y) end,
      specular = function(p) return 0.1 + 0.1 * glint.sin(x * p.x) end }
  end)
  compare("roughness", function(x)
    return { model = "cook_torrance", mirror = 0, roughness = function(p) return 0.4 + 0.2 * glint.sin(x * p.y) end }
  end)
  compare("ambient", function(x) return { ambient = function(p) return 0.4 + 0.2 * glint.sin(x * p.y) end } end)
  compare("mirror", function(x) return { floor = true, mirror = function(p) return 0.4 + 0.2 * glint.sin(x * p.y) end } end)
  compare("glass", function(x)
    return { floor = true, fresnel = true, transmission = function(p) return 0.4 + 0.2 * glint.sin(x * p.y) end }
  end)
end

-- Tests shaders, by inputs and by constants: nineteen of twenty pixels, as the other pixels are at edges.
function tests.shaders_against_differences()
  local h = 1e-3
  local function compare(name, at, make, more)
    local image = render(make(glint.variable("p", at)), "d:p", more)
    local plain, high, low = render(make(at), "beauty", more), render(make(at + h), "beauty", more), render(make(at - h), "beauty", more)
    is_slope(name, image, plain, high, low, h, 19 / 20)
  end
  local phong = glint.shader(function(s)
    local r = 2 * glint.dot(s.n, s.l) * s.n - s.l
    return s.kd * s.light * glint.max(0, glint.dot(s.n, s.l)), s.ks * s.light * glint.max(0, glint.dot(r, s.v)) ^ s.shininess
  end)
  local function of(fields)
    local list = { model = phong, diffuse = { 0.7, 0.4, 0.2 }, specular = 0.4, shininess = 12 }
    for key, value in pairs(fields or {}) do list[key] = value end
    return glint.material(list)
  end
  local function with(lamp, fields, ...)
    local scene = scene_of(lamp, { material = of(fields), background = { 0.2, 0.3, 0.4 }, ambient = 0.1 })
    scene:add(glint.plane { point = { 0, 0, -3 }, normal = { 0, 0, 1 }, material = of(fields) })
    for _, shape in ipairs { ... } do scene:add(shape) end
    return scene
  end
  local function by(shader) return { model = glint.shader(shader) } end
  local lamp = glint.point_light { position = { 2, 4, 3 }, attenuation = { 1, 0, 0.02 }, shadows = false }
  compare("a lamp", 2, function(x) return with(glint.point_light { position = { x, 4, 3 }, attenuation = { 1, 0.05 * x, 0.02 } }) end)
  compare("a spot light", 1, function(x) return with(glint.spot_light { position = { 2, 4, 3 }, direction = { -2, -4 * x, -3 }, inner = 5,
    outer = 40 * x, exponent = 3 * x }) end)
  compare("a parallel light", 0.3, function(x) return with(glint.directional_light { direction = { x, -1, -1 }, intensity = x }) end)
  compare("a disk", 1, function(x) return with(glint.disk_light { position = { 2, 4, 3 }, normal = { -2, -4, -3 }, radius = 0.5,
    radiance = x + 1, shadows = false }) end)
  compare("a ball", 1, function(x) return with(glint.sphere_light { position = { 2, 4, 3 }, radius = 0.5, radiance = x + 1 }) end)
  compare("a ball's caps", 1, function(x)
    return with(glint.sphere_light { position = { 2, 4, 3 }, radius = 0.5, intensity = x, shadow = "caps", attenuation = { 1, 0.1, 0 } })
  end)
  compare("reflectances", 0.7, function(x) return with(lamp, { diffuse = { x, 0.4, x * x }, specular = 0.3 * x, shininess = 10 * x }) end)
  compare("reflectances by patterns", 2, function(x)
    return with(lamp, { diffuse = glint.pattern(function(p) return 0.4 + 0.3 * glint.sin(x * p.x) end),
      shininess = glint.pattern(function(p) return 10 + glint.sin(p.x * x) end) })
  end)
  compare("numbers of both parts", 0.7, function(x)
    return with(lamp, by(function(s) return s.kd * s.light * (x + glint.dot(s.n, s.l)), s.light * (x + glint.noise(x * s.p)) end))
  end)
  compare("a number of one", 0.7, function(x) return with(lamp, by(function(s) return s.kd * glint.sin(x * s.world.y + s.distance) end)) end)
  compare("light through glass", 2, function(x)
    return with(glint.point_light { position = { 2, 4, 3 } }, {}, glint.box { min = { -2, 2, 1 }, max = { 2, 2.1, 3 },
      material = glint.material { diffuse = 0.2, transmission = { x / 4, 0.5, 0.2 } } })
  end)
  local waves = by(function(s) return s.light * (0.5 + 0.3 * glint.sin(4 * s.p.x + s.world.y + s.distance)) end)
  for name, options in pairs { plain = {}, ["with samples"] = { samples = 4 } } do
    compare("an eye before mirrors, " .. name, 0.2, function(x)
      local scene = with(lamp, { mirror = 0.5 }, glint.sphere { center = { 1.5, 0.3, 2 + x }, radius = 0.4 + x, material = of(waves) })
      scene.camera.eye = { x, 2, 8 }
      scene.depth_cue = { near = 4, far = 25, color = 0.3 }
      return scene
    end, options)
  end
  compare("under a map that keeps no angles", 0.1, function(x)
    return with(lamp, {}, glint.group { transform = glint.translate(1.5, 0.5, 2) * glint.rotate("z", 30) * glint.scale(0.5, 0.4, -0.7),
      glint.sphere { center = { x, 0, 0 }, radius = 1 + x, material = of(waves) } })
  end)
  compare("meshes", 0.4, function(x)
    local scene = with(lamp)
    for i, shading in ipairs { "flat", "gouraud", "phong" } do
      scene:add(glint.sphere_mesh { center = { 1.2 * i - 2.4, 0.2, 2 }, radius = 0.5, segments = 24, shading = shading, material = of() })
    end
    scene.camera.eye = { x, 2, 8 }
    return scene
  end)
  compare("bumps", 0.4, function(x)
    return with(glint.point_light { position = { x, 4, 3 }, shadows = false }, { bump = glint.pattern(function(p) return 0.05 * glint.sin(3 * p.y) end) })
  end)
end

-- Compares every pixel, without quantiles: a bump hides the normal of only a few pixels, so one wrong value must fail.
function tests.every_pixel_against_differences()
  local function compare(name, at, h, fields)
    local function make(x)
      return glint.scene { camera = glint.camera { eye = { 0.5, 2, 9 }, at = { 0, 0.8, 0 } },
        glint.point_light { position = { 0, 6, 4 }, shadows = false },
        glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material(fields(x)) } }
    end
    local image, worst, most = render(make(glint.variable("p", at)), "d:p"), 0, 0
    local high, low, list = render(make(at + h), "beauty"), render(make(at - h), "beauty"), {}
    each(high, "beauty", low, "beauty", function(p, q) list[#list + 1] = (p - q) / (2 * h) end)
    local i = 0
    each(image, "d:p", image, "d:p", function(d)
      i = i + 1
      worst, most = math.max(worst, math.abs(d - list[i])), math.max(most, math.abs(list[i]))
    end)
    check(most > 0 and worst < 1e-3 * most, "%s: off by %.2g of %.2g", name, worst, most)
  end
  local waves = glint.pattern(function(p) return 0.03 * glint.sin(4 * p.x) end)
  for _, distribution in ipairs { "ggx", "beckmann" } do
    compare(distribution .. " on bumps", 0.5, 1e-2, function(x)
      return { diffuse = 0.2, model = "cook_torrance", mirror = 0, distribution = distribution, roughness = 0.5, specular = x, bump = waves }
    end)
  end
  local exponent = glint.pattern(function(p) return 12 + 4 * glint.sin(p.y + p.x) end)
  for _, model in ipairs { "phong", "blinn_phong" } do
    compare("an even highlight by a number", 0.5, 1e-2, function(x)
      return { diffuse = 0.1 * x, model = model, specular = { x, 0.3, x * x }, normalized = true, shininess = exponent }
    end)
  end
  compare("an even highlight by a number and its pattern", 0.5, 1e-3, function(x)
    return { specular = { x, 0, x * x }, normalized = true, shininess = glint.pattern(function(p) return 12 + 8 * x * glint.sin(p.x) end) }
  end)
  compare("what ior reflects straight back", 1.5, 1e-2, function(x)
    return { diffuse = 0.2, model = "cook_torrance", mirror = 0, roughness = 0.4, ior = x }
  end)
end

-- Objects dropped by the script count until they are collected, whenever that happens.
function tests.dropped_objects()
  local x = glint.variable("x", 0.5)
  local scene, good = scene_of(glint.point_light { position = { 2, 4, 3 }, intensity = x }), true
  for _ = 1, 2000 do
    glint.material { diffuse = x }
    good = good and pcall(render, scene, "d:x", { width = 2, height = 2 })
  end
  check(good, "what is dropped changes no derivative")
end

-- Tests an eye above faces or inside a ball, and a moving ball under a lens: nineteen of twenty pixels, not at edges.
function tests.what_moves_against_differences()
  local h = 1e-3
  local function compare(name, make, at, more)
    local image = render(make(glint.variable("p", at)), "d:p", more)
    local high, low = render(make(at + h), "beauty", more), render(make(at - h), "beauty", more)
    local list, most, distances = {}, 0, {}
    each(high, "beauty", low, "beauty", function(p, q) list[#list + 1] = (p - q) / (2 * h) end)
    each(image, "d:p", image, "d:p", function(d)
      distances[#distances + 1] = math.abs(d - list[#distances + 1])
      most = math.max(most, math.abs(d))
    end)
    table.sort(distances)
    local worst = distances[#distances * 19 // 20]
    check(most > 0 and worst < 2e-3 * most, "%s: off by %.2g of %.2g", name, worst, most)
  end
  local lamp = glint.point_light { position = { 2, 4, 3 }, attenuation = { 1, 0, 0.02 } }
  compare("faces", function(x)
    local scene = scene_of(lamp)
    scene:add(glint.mesh { vertices = { { -3, -1, 0 }, { 3, -1, 1 }, { 0, 3, 0.5 } }, faces = { { 1, 2, 3 } },
      material = glint.material { diffuse = 0.3, specular = 0.5, shininess = 10 } })
    scene.camera.eye = { x, 2, 8 }
    return scene
  end, 0.3)
  compare("within a ball", function(x)
    return glint.scene { camera = glint.camera { eye = { 0, 0, 0.5 }, at = { 0, 0, 0 }, fov = 80 },
      glint.point_light { position = { 0.2, 0.4, 0 } }, glint.sphere { center = { x, 0, 0 }, radius = 2 + x,
        material = glint.material { specular = 0.5, shininess = 10 } } }
  end, 0.1)
  local function mirror(x) return glint.material { diffuse = 0.3, specular = 0.3, shininess = 10, mirror = x } end
  local glass = glint.material { diffuse = 0.05, transmission = 0.9, ior = 1.5, fresnel = true }
  local function with(x, ...)
    local scene = scene_of(lamp, { material = mirror(0.5), background = { 0.2, 0.3, 0.4 } })
    for _, shape in ipairs { ... } do scene:add(shape) end
    scene.camera.eye = { x, 2, 8 }
    return scene
  end
  compare("solids", function(x)
    return with(x, glint.box { min = { -3, -1, -2 }, max = { -1.7, 1, 0 }, material = mirror(0.3) },
      glint.cylinder { base = { -1, -1, 2 }, top = { -1.2, 0, 2.1 }, radius = 0.4, material = mirror(0.2) },
      glint.cone { base = { 1.2, -1, 2 }, top = { 1.2, 0.4, 2 }, radius = 0.5, material = mirror(0.2) },
      glint.torus { center = { 0, -0.6, 3 }, axis = { 0, 1, 0.2 }, major = 0.6, minor = 0.2, material = glass })
  end, 0.3)
  compare("a smooth mesh that mirrors", function(x)
    return with(x, glint.mesh { vertices = { { -2, -1, 1.5 }, { 2, -1, 1.8 }, { 0, 2, 1 } }, faces = { { 1, 2, 3 } }, shading = "phong",
      normals = { { -0.5, 0.1, 1 }, { 0.6, 0, 1 }, { 0, 0.7, 1 } }, material = mirror(0.6) })
  end, 0.3)
  compare("shapes under a map that keeps no angles", function(x)
    return with(0, glint.group { transform = glint.translate(-1, 0.5, 2.5) * glint.rotate("z", 30) * glint.scale(0.5, 0.4, -0.7),
      glint.sphere { center = { x, 0, 0 }, radius = 1 + x, material = mirror(0.3) }, glint.plane { point = { 0, -2, 0 }, normal = { x, 1, 0 } } })
  end, 0.1)
  compare("a ball that is cut and the ball that cuts it", function(x)
    return with(0, glint.difference { glint.sphere { center = { -1 + x, 1, 2.5 }, radius = 0.7, material = mirror(0.3) },
      glint.sphere { center = { -1, 1 + x, 3.2 }, radius = 0.5, material = mirror(0.2) } })
  end, 0.1)
  compare("a plane that turns around its point", function(x)
    return with(0, glint.plane { point = { -3, 0, -4 }, normal = { x, 0, 1 } })
  end, 0)
  compare("a mirror under a lens", function(x)
    local scene = with(0.1, glint.sphere { center = { x, 0.5, 3 }, radius = 0.5, material = glass })
    scene.camera.aperture = 0.05
    return scene
  end, 0.2, { samples = 4 })
  for name, change in pairs {
    aperture = function(camera, x) camera.aperture = 0.2 * x end,
    ["a focus"] = function(camera, x) camera.aperture, camera.focus = 0.05, 5 + x end,
    ["an eye with a lens"] = function(camera, x) camera.aperture, camera.eye = 0.05, { x, 2, 8 } end,
    ["an orthographic height"] = function(camera, x) camera.projection, camera.height = "orthographic", 4 + x end,
    ["an orthographic eye"] = function(camera, x) camera.projection, camera.height, camera.eye = "orthographic", 4, { x, 2, 8 } end,
  } do
    compare(name .. " before mirrors, glass and a depth cue", function(x)
      local scene = with(0.1, glint.sphere { center = { 0.2, 0.5, 3 }, radius = 0.5, material = glass })
      scene.depth_cue = { near = 5, far = 12, color = { 0.1, 0.3, 0.2 } }
      change(scene.camera, x)
      return scene
    end, 0.2, { samples = 4 })
  end
  compare("within what absorbs, by how much and where the eye is", function(x)
    local scene = scene_of(glint.point_light { position = { 2, 4, 3 }, shadows = false }, { material = mirror(0.5) })
    scene:add(glint.sphere { center = { 0, 0, 0 }, radius = 50,
      material = glint.material { diffuse = 0.1, transmission = 1, absorption = { 0.1 * x, 0, 0.1 } } })
    scene.camera.eye = { x, 2, 8 }
    return scene
  end, 0.4)
  local function sheet(shading, material)
    return glint.mesh { vertices = { { -3, -1, 1 }, { 3, -1, 1.5 }, { 2, 3, 0.5 }, { -2, 3, 1 } }, faces = { { 1, 2, 3 }, { 1, 3, 4 } },
      normals = shading == "gouraud" and { { -0.5, 0.1, 1 }, { 0.6, 0, 1 }, { 0, 0.7, 1 }, { -0.2, 0, 1 } } or nil, shading = shading,
      material = material }
  end
  for _, shading in ipairs { "flat", "gouraud" } do
    compare(shading .. " faces that mirror, seen in glass, with a depth cue", function(x)
      local scene = with(x, sheet(shading, mirror(0.4)), glint.sphere { center = { 0, 0.5, 4 }, radius = 0.5, material = glass })
      scene.depth_cue = { near = 3, far = 14, color = 0.3 }
      return scene
    end, 0.3)
    compare(shading .. " faces in a mirror that moves", function(x)
      return with(0, sheet(shading, mirror(0)), glint.sphere { center = { x, 0.5, 3 }, radius = 0.6, material = mirror(0.7) })
    end, 0.3)
  end
  compare("an area light in mirrors", function(x)
    local scene = with(0.1, glint.sphere { center = { x, 0.5, 3 }, radius = 0.5, material = mirror(0.8) })
    scene:add(glint.sphere_light { position = { -2, 4, 3 }, radius = 0.4, samples = 4, shadows = false, intensity = 0.3 })
    return scene
  end, 0.2)
  compare("a ball and a floor under a lens", function(x)
    local camera = glint.camera { eye = { 0, 2, 8 }, at = { 0, 0, 0 }, aperture = 0.05 }
    return glint.scene { camera = camera, lamp, glint.sphere { center = { 0, x, 0 }, radius = 1.5 },
      glint.plane { point = { 0, x - 2, 0 }, normal = { x, 5, 0 } } }
  end, 0.2, { samples = 4 })
end

function tests.duals_are_numbers()
  local x = glint.variable("x", 3)
  check(x + 1 == x + 1 and x < 4 and x <= 3.5 and 2 < x and -x < 0, "comparisons")
  check(tostring(x * 2) == "6.0" and "x = " .. x == "x = 3.0", "as text: %s", tostring(x))
  check(x // 2 == 1 and glint.value(x % 2) == 1 and math.type(math.floor(x)) == "integer", "whole parts")
  check(type(glint.floor(x)) == "number" and type(x // 2) == "number", "what is level wherever it has a slope is a plain number")
  check(glint.value(x - x) == 0 and tostring(x * 0) == "0.0", "what is level here still depends on it")
  check(glint.value(math.max(x, 2, 9)) == 9 and glint.value(math.min(x, 5)) == 3, "math.max, math.min")
  check(math.sin(0.5) == math.sin(0.5) and math.max(1, 2.5) == 2.5 and math.floor(2.7) == 2, "math of plain numbers")
  near(glint.value(math.atan(x, 2)), math.atan(3, 2), 0, "math.atan")
  near(glint.value(glint.pow(x, 2.5)), 3 ^ 2.5, 1e-12, "glint.pow")
  local material = glint.material { diffuse = x / 10 }
  check(glint.value(material.diffuse[2]) == 0.3, "a grey of one number")
  material.diffuse = { 0.1, 0.2, 0.3 }
  check(math.abs(material.diffuse.g - 0.2) < 1e-15, "a plain colour again")
end

function tests.errors_are_told()
  local x = glint.variable("x", 3)
  local function raises(text, f, ...)
    local ok, message = pcall(f, ...)
    check(not ok and tostring(message):find(text, 1, true), "'%s' expected, got %s", text, ok and "no error" or message)
  end
  local lamp = glint.point_light { position = { x, 4, 3 } }
  raises("d:q: no variable of that name", render, scene_of(lamp), "d:q")
  raises("did you mean 'd:strength'", render, scene_of(lamp), "d:strenght")
  raises("'d:': expected a name of 1 .. 31 bytes", render, scene_of(lamp), "d:")
  raises("'d:x' is not stored", function() render(scene_of(lamp), "beauty"):pixel(0, 0, "d:x") end)
  raises("box.min: this has no derivative", glint.box, { min = { x, 0, 0 }, max = { 9, 9, 9 } })
  raises("camera.shutter: this has no derivative", glint.camera, { eye = { 3, 0, 0 }, at = { 0, 0, 0 }, shutter = x })
  raises("camera.focus: this has no derivative", glint.camera, { eye = { 3, 0, 0 }, at = { 0, 0, 0 }, focus = { x, 0, 0 } })
  raises("camera.focus: number > 0 or {x, y, z} expected, got -3.0", glint.camera, { eye = { 3, 0, 0 }, at = { 0, 0, 0 }, focus = -x })
  local moved = scene_of(glint.point_light { position = { 2, 4, 3 } })
  local ball = glint.sphere { center = { x, 0, 0 }, radius = 0.2 }
  moved:add(ball)
  moved.background = glint.pattern(function(d) return d.y end)
  moved.camera.eye = { x, 2, 8 }
  raises("derivative 'x': background: a camera has no derivative with a pattern or texture as the background", render, moved, "d:x")
  moved.camera.eye = { 3, 2, 8 }
  moved:add(glint.sphere { center = { 0, 0, 4 }, radius = 0.2, material = glint.material { mirror = 0.5 } })
  raises("derivative 'x': background: moving objects or bending rays", render, moved, "d:x")
  moved = scene_of(glint.sphere_light { position = { 2, 4, 3 }, radius = 1, radiance = 1 })
  moved.camera.fov = 10 * x
  raises("sphere_light #1: position", render, moved, "d:x")
  raises("scene.depth_cue.far: this has no derivative", function() moved.depth_cue = { far = x } end)
  raises("a + b: number or vector expected, got a number made of glint.variable; glint.value(x) is the plain number",
    function() return x + glint.vector(1, 2, 3) end)
  raises("this has no derivative", glint.translate, { x, 0, 0 })
  raises("variable.name: string", glint.variable, 3, 3)
  raises("variable.value: number", glint.variable, "x", "y")
  raises("variable.name: name of 1 to 31 bytes", glint.variable, "a,b", 1)
  local none = glint.variable("none", 0)
  local dull = scene_of(glint.point_light { position = { 2, 4, 3 } }, { material = glint.material { mirror = none } })
  raises("derivative 'none': material.mirror: 0 has no derivative", render, dull, "d:none")
  dull = scene_of(glint.point_light { position = { 2, 4, 3 } }, { material = glint.material { transmission = none } })
  raises("derivative 'none': material.transmission: 0 has no derivative", render, dull, "d:none")
  local bent = scene_of(glint.point_light { position = { 2, 4, 3 } }, { material = glint.material { mirror = 0.5, ior = x } })
  raises("derivative 'x': nothing in the scene depends on it", render, bent, "d:x")
  bent = scene_of(lamp, { material = glint.material { transmission = 0.5, absorption = 0.1 } })
  raises("derivative 'x': absorption: light through an absorbing material", render, bent, "d:x")
  bent = scene_of(glint.point_light { position = { 2, 4, 3 } }, { material = glint.material { mirror = 0.5 * x / 3 } })
  raises("derivative 'x': nothing in the scene depends on it", render, bent, "d:x", { max_depth = 0 })
  local lit = scene_of(lamp)
  lit.indirect = { samples = 4 }
  raises("derivative 'x': scene.indirect", render, lit, "d:x")
  local shaded = scene_of(lamp, { material = glint.material { model = glint.shader(function(q) return q.light * q.uv.u end) } })
  shaded.camera.eye = { x, 2, 8 }
  raises("derivative 'x': material: moving objects or bending rays has no derivative where materials have patterns or bumps, or shaders that read uv",
    render, shaded, "d:x")
  local long = glint.material { model = glint.shader(function(q)
    local a = q.n
    for i = 1, 200 do a = a + 0.01 * glint.sin(q.l * i + a * q.v) end
    return a * q.light
  end) }
  raises("derivative 'x': material.model: the shader's derivative: program: at most 4096 instructions", render,
    scene_of(glint.point_light { position = { x, 4, 3 } }, { material = long }), "d:x")
  local both = scene_of(glint.point_light { position = { x, 4, 3 } }, { material = long })
  both.background = glint.variable("sky", 0.2)
  raises("derivative 'x': material.model: the shader's derivative", render, both, "d:sky,d:x")
  local bricks = glint.material { diffuse = glint.pattern(function(p) return p.x end), transmission = glint.pattern(function(p) return p.y end) }
  raises("derivative 'x': material.transmission: light through a patterned material", render, scene_of(lamp, { material = bricks }), "d:x")
  moved = scene_of(glint.point_light { position = { 2, 4, 3 } }, { material = bricks })
  moved.camera.eye = { x, 2, 8 }
  raises("derivative 'x': material: moving objects or bending rays", render, moved, "d:x")
  local function patterned(field, f) return scene_of(glint.point_light { position = { 2, 4, 3 } },
    { material = glint.material { [field] = glint.pattern(f) } }) end
  raises("material.diffuse: a pattern with the same number everywhere", render, patterned("diffuse", function() return x / 9 end), "d:x")
  local unread = { model = "cook_torrance", mirror = 0, diffuse = x / 9, specular = 0.5, shininess = glint.pattern(function(p) return 9 + x * p.x end) }
  local dull_shine = scene_of(glint.point_light { position = { 2, 4, 3 } }, { material = glint.material(unread) })
  check(pcall(render, dull_shine, "d:x"), "a pattern that nothing reads is ignored")
  unread.diffuse = 0.5
  dull_shine = scene_of(glint.point_light { position = { 2, 4, 3 } }, { material = glint.material(unread) })
  raises("derivative 'x': nothing in the scene depends on it", render, dull_shine, "d:x")
  raises("derivative 'x': material.bump: this field has no derivative", render, patterned("bump", function(p) return x * p.x end), "d:x")
  raises("derivative 'x': material.transmission: light through a patterned material has no derivative by the pattern", render,
    patterned("transmission", function(p) return x * p.x end), "d:x")
  for _, fields in ipairs { { normalized = true, specular = { none, 1, 1 } }, { specular = none } } do
    fields.shininess = glint.pattern(function(p) return 9 + p.x end)
    local shapely = scene_of(glint.point_light { position = { 2, 4, 3 } }, { material = glint.material(fields) })
    raises("derivative 'none': material.specular: 0 has no derivative where", render, shapely, "d:none")
  end
  local sky = scene_of(glint.point_light { position = { 2, 4, 3 } })
  sky.background = glint.pattern(function(d) return x * d.y end)
  raises("derivative 'x': background: the numbers of its program have no derivative", render, sky, "d:x")
  local seen = glint.sphere_light { position = { x, 4, 3 }, radius = 1, visible = true }
  raises("sphere_light #1: visible", render, scene_of(seen), "d:x")
  local cone = glint.sphere_light { position = { x, 4, 3 }, radius = 1, radiance = 1 }
  raises("sphere_light #1: position", render, scene_of(cone), "d:x")
  local names = {}
  for i = 1, 9 do names[i] = "d:v" .. i end
  raises("and at most 8 derivatives", render, scene_of(lamp), table.concat(names, ","))
end

-- A refined pixel has the derivative of all samples, another pixel the derivative of one sample.
function tests.adaptive()
  local x = glint.variable("x", 2)
  local function compare(what, change)
    local scene = scene_of(glint.point_light { position = { x, 4, 3 } }, { material = glint.material { mirror = 0.5, specular = 0.5 } })
    change(scene)
    local mixed = render(scene, "d:x,refined", { samples = 4, adaptive = 0.1 })
    local all, one = render(scene, "d:x", { samples = 4 }), render(scene, "d:x")
    local count, wrong = { [0] = 0, 0 }, 0
    for y = 0, H - 1 do
      for column = 0, W - 1 do
        local refined = mixed:pixel(column, y, "refined")
        count[refined] = count[refined] + 1
        local got, want = { mixed:pixel(column, y, "d:x") }, { (refined == 1 and all or one):pixel(column, y, "d:x") }
        for c = 1, 3 do wrong = wrong + (got[c] ~= want[c] and 1 or 0) end
      end
    end
    check(count[0] > 100 and count[1] > 100 and wrong == 0, "%s: %d refined, %d not, %d numbers wrong", what, count[1], count[0], wrong)
  end
  compare("mirrors", function() end)
  compare("what fades, and faces that are lit once", function(scene)
    scene.depth_cue = { near = 4, far = 15, color = 0.3 }
    scene.camera.eye = { x, 2, 8 }
    scene:add(glint.sphere_mesh { center = { 1.5, 0, 2 }, radius = 0.5, segments = 8, shading = "flat" })
    scene:add(glint.sphere_mesh { center = { -1.5, 0, 2 }, radius = 0.5, segments = 8, shading = "gouraud" })
  end)
end

-- A frame's cached results are identical with and without derivatives.
function tests.beauty_is_as_without()
  local x, passes = glint.variable("x", 0.3), "beauty,diffuse,mirror,transmission"
  local function compare(absorption, shadows, samples)
    local glass = glint.material { diffuse = 0.05, transmission = 0.9, mirror = x, ior = 1.4 + x, fresnel = true, absorption = absorption }
    local lamp = glint.point_light { position = { 2, 4, 3 }, shadows = shadows, intensity = x }
    local scene = scene_of(lamp, { material = glass, background = { 0.2, 0.3, 0.4 } })
    scene:add(glint.disk_light { position = { -2, 4, 3 }, normal = { 2, -4, -3 }, radius = 0.5, samples = 4, intensity = 0.5, shadows = shadows })
    scene:add(glint.sphere { center = { 1.5, 0, -1 }, radius = 0.8, material = glint.material { mirror = 0.5, specular = 0.5 } })
    local with = render(scene, passes .. ",d:x", { samples = samples })
    local without = render(scene, passes, { samples = samples })
    for pass in passes:gmatch "%a+" do
      local differ = 0
      each(with, pass, without, pass, function(p, q) differ = differ + (p ~= q and 1 or 0) end)
      check(differ == 0, "%s with %d samples: %d numbers differ", pass, samples, differ)
    end
  end
  compare(0.2, false, 1)
  compare(0, true, 1)
  compare(0, true, 4)
end

-- Runs the same script through the command: threads, instruction sets, reuse and additional passes change no byte.
function tests.bits()
  local folder = os.tmpname()
  os.remove(folder)
  os.execute("mkdir " .. folder)
  local script = folder .. "/s.lua"
  local file = assert(io.open(script, "w"))
  file:write [[
local glint = require "glint"
local P = glint.params { x = 2.5, s = 20, meshes = true }
local lamp = glint.point_light { position = { P.x, 4, 3 } }
local soft = glint.disk_light { position = { -3, 5, 2 }, normal = { 3, -5, -2 }, radius = 0.5, intensity = 0.3 }
local shiny = glint.material { diffuse = { 0.7, 0.2, 0.1 }, specular = 0.5, shininess = P.s }
local scene = glint.scene { camera = glint.camera { eye = { 0, 2, 8 }, at = { 0, 0, 0 } }, ambient = 0.1, lamp, soft,
  glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.5, mirror = 0.1 } },
  glint.sphere { center = { -1.4, P.s / 100 - 0.5, 2 }, radius = 0.4, material = glint.material { model = glint.shader(function(s)
    return s.kd * s.light * glint.dot(s.n, s.l) ^ 2, s.light * glint.dot(s.n, glint.unit(s.l + s.v)) ^ s.shininess
  end) } },
  glint.sphere { center = { 0, 0, 0 }, radius = 1, material = shiny },
  glint.sphere { center = { 2, P.s / 100, 0 }, radius = 0.5, material = glint.material { diffuse = 0, transmission = 0.9, fresnel = true } } }
if P.meshes then
  scene:add(glint.mesh { vertices = { { -3, -0.5, 0 }, { -1.6, -0.5, 1 }, { -1.6, 0.5, 1 }, { -3, 0.5, 0 } }, faces = { { 1, 2, 3, 4 } },
    normals = { { -1, 0, 1 }, { 0, 0, 1 }, { 0, 1, 1 }, { -1, 1, 1 } }, shading = "gouraud", material = shiny })
  scene:add(glint.mesh { vertices = { { 1.6, 0.5, 0 }, { 2.6, 0.5, 1 }, { 2.6, 1.2, 1 } }, faces = { { 1, 2, 3 } }, shading = "flat", material = shiny })
end
return glint.animation { scene = scene, frames = 9, width = 100, height = 60, frame = function(_, n)
  lamp.position = { P.x + (n > 5 and 1 or 0), 4, 3 }
  shiny.shininess = P.s * (n > 7 and 2 or 1)
  scene.ambient = n > 8 and 0.2 * P.x or 0.1
end }
]]
  file:close()
  local function run(name, options, before)
    local ok = os.execute(("%s %s/glint %s -o '%s/%s_%%d.pfm' %s >/dev/null 2>&1"):format(before or "", BUILD, script,
      folder, name, options))
    check(ok, "%s ran", name)
  end
  local function same(name, pass)
    for n = 1, 9 do
      local ok = os.execute(("cmp -s %s/first_%d.%s.pfm %s/%s_%d.%s.pfm"):format(folder, n, pass, folder, name, n, pass))
      check(ok, "frame %d of %s by %s is as the first", n, pass, name)
    end
  end
  run("first", "--passes d:x,d:s --no-reuse --threads 1")
  run("reuse", "--passes d:x,d:s --threads 1")
  run("threads", "--passes d:x,d:s,normal --threads 3")
  for _, name in ipairs { "reuse", "threads" } do
    same(name, "d_x")
    same(name, "d_s")
  end
  run("alone", "--passes d:s")
  same("alone", "d_s")
  for _, isa in ipairs { "ref", "generic" } do
    local probe = ("GLINT_ISA=%s %s/glint %s -f 1 -o none 2>&1"):format(isa, BUILD, script)
    local told = io.popen(probe):read "a"
    if not told:find("this machine lacks '" .. isa .. "'", 1, true) then -- some builds have one set only
      run(isa, "--passes d:x", "GLINT_ISA=" .. isa)
      same(isa, "d_x")
    end
  end
  local pipe = io.popen(("%s/glint %s -f 1 -D meshes=false --passes d:x,d:s -o %s/e_%%d.png --json"):format(BUILD, script, folder))
  local event = pipe:read "a"
  pipe:close()
  local share = tonumber(event:match '"shifted":([%d.e-]+)')
  check(share and share > 0.001 and share < 0.2, "the share of pixels beside moved shadows is told: %s", share)
  check(event:find('"d:x":"' .. folder .. '/e_1.d_x.png"', 1, true), "the event names the files")
  local again = os.execute(("%s/glint reproduce %s/e_1.d_s.png %s >/dev/null"):format(BUILD, folder, script))
  check(again, "a derivative is reproduced byte for byte")
  os.execute("rm -r " .. folder)
end

-- scripts/fit.lua recovers its hidden parameters, from its own picture and from the file of that picture.
function tests.fit()
  local hidden = { lamp_x = 3.2, lamp_y = 4.1, lamp_z = 2.4, intensity = 1.6, shininess = 45 }
  local folder = os.tmpname()
  os.remove(folder)
  for _, options in ipairs { "-o '%s/%%d.pfm'", "-o none --set file=%s/1.pfm" } do
    local pipe = io.popen(("%s/glint scripts/fit.lua --quiet %s 2>/dev/null"):format(BUILD, options:format(folder)))
    local found = 0
    for line in pipe:lines() do
      local name, value = line:match "^(%S+) (%S+) %+%- %S+$"
      local want = hidden[name]
      if want then near(tonumber(value), want, 2e-5 * want, name .. " by " .. options) end
      found = found + (want and 1 or 0)
    end
    check(pipe:close() and found == 5, "fit.lua %s gives five numbers", options)
  end
  os.execute("rm -r " .. folder)
end

tally.run(tests)
tally.finish()
