-- Rough reflection and refraction against integrals of the same formulas by material:evaluate, closed forms, and
-- limits; and identical pictures in every configuration.
local tally = dofile "tests/lua/tally.lua"
local check, near, raises = tally.check, tally.near, tally.raises
local glint = require "glint"

local tests = {}
local DISTRIBUTIONS <const> = { "ggx", "beckmann" }

-- The share of a white surroundings' light that the facets reflect in a direction with this cosine: the integral of
-- the lobe over the hemisphere.
local function albedo(material, cosine, n)
  local sum, eye = 0, { math.sqrt(1 - cosine * cosine), cosine, 0 }
  for i = 0, n - 1 do
    local c = (i + 0.5) / n
    local s = math.sqrt(1 - c * c)
    for k = 0, 2 * n - 1 do
      local angle = math.pi * (k + 0.5) / n
      local light = { s * math.cos(angle), c, s * math.sin(angle) }
      sum = sum + material:evaluate({ normal = { 0, 1, 0 }, to_light = light, to_eye = eye }).specular.x
    end
  end
  return sum / (n * n)
end

-- Renders the middle row of a ball seen by parallel rays, and returns a function of the column that gives a pass and the cosine there.
local SIDE <const> = 63
local function ball(material, fields, options)
  local scene = glint.scene { glint.sphere { center = { 0, 0, 0 }, radius = 1, material = material } }
  scene.camera = glint.camera { eye = { 0, 0, 20 }, at = { 0, 0, 0 }, projection = "orthographic", height = 2.2 / SIDE }
  for name, value in pairs(fields) do
    if type(name) == "number" then scene:add(value) else scene[name] = value end
  end
  local given = { width = SIDE, height = 1, samples = 16, passes = "beauty,mirror,transmission,specular" }
  for name, value in pairs(options or {}) do given[name] = value end
  local image = scene:render(given)
  return function(x, pass)
    local away = (SIDE // 2 - x) * 2.2 / SIDE
    return image:pixel(x, 0, pass), math.sqrt(1 - away * away)
  end
end

-- In a white furnace a ball loses only what single scattering loses.
function tests.furnace()
  for _, distribution in ipairs(DISTRIBUTIONS) do
    for _, roughness in ipairs { 0.5, 0.7, 1 } do
      local want = {} -- by column
      local material = glint.material { model = "cook_torrance", f0 = 1, diffuse = 0, roughness = roughness, distribution = distribution }
      for _, precision in ipairs { "double", "float" } do
        local at = ball(material, { background = 1, reflection_samples = 256 }, { precision = precision })
        for _, x in ipairs { 31, 20, 8 } do
          local got, cosine = at(x, "mirror")
          want[x] = want[x] or albedo(material, cosine, 80)
          near(got, want[x], 1.5e-3, ("%s %g, %s, cosine %.3f"):format(distribution, roughness, precision, cosine))
        end
      end
    end
    local fresnel = glint.material { model = "cook_torrance", f0 = { 0.04, 0.5, 1 }, diffuse = 0, roughness = 0.5, distribution = distribution }
    local got, cosine = ball(fresnel, { background = 1, reflection_samples = 256 })(12, "mirror")
    near(got, albedo(fresnel, cosine, 80), 1e-3, distribution .. ": Schlick's reflectance at the facet")
    local mirror = glint.material { diffuse = 0, mirror = 1, roughness = 0.6, distribution = distribution }
    local white = glint.material { model = "cook_torrance", f0 = 1, roughness = 0.6, distribution = distribution }
    local seen, c = ball(mirror, { background = 1, reflection_samples = 256 })(15, "mirror")
    near(seen, albedo(white, c, 80), 1.5e-3, distribution .. ": a rough mirror is white facets")
  end
end

-- Half of the sky is white, half black: the mean of the lobe over one half, by the same integral.
function tests.step_sky()
  local step = glint.pattern(function(d) return glint.select(glint.less(0, d.x), 1, 0) end)
  for _, distribution in ipairs(DISTRIBUTIONS) do
    local material = glint.material { model = "cook_torrance", f0 = 1, diffuse = 0, roughness = 0.7, distribution = distribution }
    local at = ball(material, { background = step, reflection_samples = 1024 })
    for _, x in ipairs { 31, 24, 38 } do
      local got, cosine = at(x, "mirror")
      local away = (x - SIDE // 2) * 2.2 / SIDE
      local normal, n, sum = { away, 0, cosine }, 120, 0
      for i = 0, n - 1 do
        local c = (i + 0.5) / n -- height above the surface's horizon
        local s = math.sqrt(1 - c * c)
        for k = 0, 2 * n - 1 do
          local angle = math.pi * (k + 0.5) / n
          local across = s * math.cos(angle)
          local light = { normal[1] * c + normal[3] * across, s * math.sin(angle), normal[3] * c - normal[1] * across }
          if light[1] > 0 then
            sum = sum + material:evaluate({ normal = normal, to_light = light, to_eye = { 0, 0, 1 } }).specular.x
          end
        end
      end
      near(got, sum / (n * n), 4e-3, ("%s: a step sky, column %d"):format(distribution, x))
    end
  end
end

-- A sun in a dim sky: its light by the sum over its disc, with little noise at 64 rays.
function tests.sun()
  local COSINE <const>, L <const> = 0.9995, 1e4
  local sun = glint.unit { 0.5, 0.6, 0.62 }
  local sky = glint.pattern(function(d) return glint.select(glint.less(COSINE, d:dot(sun)), L, 0.2) end)
  local across = glint.unit(sun:cross { 0, 0, 1 })
  local up = across:cross(sun)
  for _, distribution in ipairs(DISTRIBUTIONS) do
    local material = glint.material { model = "cook_torrance", f0 = 0.8, diffuse = 0, roughness = 0.5, distribution = distribution }
    local at = ball(material, { background = sky, reflection_samples = 64 }, { samples = 1 })
    for _, x in ipairs { 31, 36, 41, 46 } do
      local got, cosine = at(x, "mirror")
      local normal, sum, count = { (x - SIDE // 2) * 2.2 / SIDE, 0, cosine }, 0, 0
      for i = 0, 19 do
        local c = 1 - (1 - COSINE) * (i + 0.5) / 20
        local s = math.sqrt(1 - c * c)
        for k = 0, 19 do
          local angle = 2 * math.pi * (k + 0.5) / 20
          local light = sun * c + (across * math.cos(angle) + up * math.sin(angle)) * s
          sum = sum + material:evaluate({ normal = normal, to_light = light, to_eye = { 0, 0, 1 } }).specular.x
          count = count + 1
        end
      end
      local want = L * 2 * (1 - COSINE) * sum / count
      check(math.abs(got - want) < 0.12 * want + 0.2, "%s: a sun of %g, column %d: %g expected, got %g", distribution, L, x, want, got)
    end
  end
end

-- Roughness 0 is the mirror, bit for bit, and small roughness approaches it.
function tests.smooth_limit()
  local sky = glint.pattern(function(d) return d * 0.5 + 0.5 end)
  local function picture(fields)
    fields.diffuse = 0.2
    return ball(glint.material(fields), { background = sky, ambient = 0.5, glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 } } })
  end
  for _, kind in ipairs { { mirror = 0.8 }, { fresnel = true, transmission = 0.9 }, { transmission = 0.7, mirror = 0.2, ior = 1.3 } } do
    local function with(more)
      local fields = more
      for name, value in pairs(kind) do fields[name] = value end
      return picture(fields)
    end
    local sharp, zero, narrow = with {}, with { roughness = 0 }, with { roughness = 1e-4 }
    for x = 3, 59, 7 do
      check(sharp(x, "beauty") == zero(x, "beauty"), "roughness 0 is smooth, column %d", x)
    end
    if not kind.transmission then
      for x = 6, 56, 10 do near(narrow(x, "mirror"), (sharp(x, "mirror")), 1e-5, "roughness 1e-4, column " .. x) end
    end
  end
  local metal = picture { model = "cook_torrance", f0 = 1, roughness = 1e-6 }
  local mirror = picture { mirror = 1 }
  for x = 6, 56, 10 do near(metal(x, "mirror"), (mirror(x, "mirror")), 1e-5, "narrow facets, column " .. x) end
end

-- All light that meets rough glass is reflected or refracted, apart from what single scattering loses.
function tests.glass()
  for _, distribution in ipairs(DISTRIBUTIONS) do
    local loss = 0
    for _, roughness in ipairs { 0.05, 0.3, 0.6 } do
      local glass = glint.material { diffuse = 0, fresnel = true, transmission = 1, roughness = roughness, distribution = distribution }
      local at = ball(glass, { background = 1, reflection_samples = 256 }, { max_depth = 30 })
      local light = at(31, "beauty")
      check(light < 1.003 - loss, "%s, roughness %g: %g of the light, less than from smoother glass", distribution, roughness, light)
      loss = 1 - light
    end
    check(loss < 0.25, "%s: rough glass keeps three quarters, got a loss of %g", distribution, loss)
  end
end

-- Lamps have highlights on facets already: reflected rays do not see them again. Other rough mirrors do see them.
function tests.lamps()
  local function scene(material, visible)
    return ball(material, { glint.sphere_light { position = { 0, 4, 4 }, radius = 1.5, radiance = 3, samples = 256, visible = visible },
      reflection_samples = 1024 }, { samples = 4 })
  end
  local metal = glint.material { model = "cook_torrance", f0 = 1, diffuse = 0, roughness = 0.5 }
  local mirror = glint.material { mirror = 1, diffuse = 0, roughness = 0.5 }
  local hidden, seen = scene(metal, false), scene(metal, true)
  for x = 12, 52, 10 do
    check(hidden(x, "beauty") == seen(x, "beauty") and seen(x, "mirror") == 0, "facets count a lamp once, column %d", x)
  end
  local most = 0
  for x = 12, 52, 10 do
    local got, want = scene(mirror, true)(x, "mirror"), hidden(x, "specular")
    most = math.max(most, want)
    near(got, want, 0.01, "a rough mirror shows the lamp as facets reflect it, column " .. x)
  end
  check(most > 0.1, "the lamp is seen: %g", most)
end

-- Within a ball of glowing rough mirror, each ray sees the same light: a geometric series.
function tests.enclosure()
  for _, roughness in ipairs { 1e-4, 1e-3 } do
    for _, depth in ipairs { 1, 3, 6 } do
      local wall = glint.material { diffuse = 0, ambient = 1, mirror = 0.5, roughness = roughness }
      local scene = glint.scene { ambient = 0.25, camera = glint.camera { eye = { 0.3, 0.2, 0.1 }, direction = { 1, 0, 0 }, fov = 60 },
        glint.sphere { center = { 0, 0, 0 }, radius = 2, material = wall } }
      local image = scene:render { width = 9, height = 7, max_depth = depth }
      for x = 0, 8, 4 do
        near(image:pixel(x, x % 7), 0.5 * (1 - 0.5 ^ (depth + 1)), 1e-5, ("a rough ball from within, roughness %g, depth %d"):format(roughness, depth))
      end
    end
  end
end

-- Grazing rays, narrow lobes and turned normals: no ray brings more than the white furnace has, or, for Beckmann's
-- facets, more than 4/e times G2 / G1 of GGX, which is below 2.7.
function tests.hard_cases()
  local waves = glint.pattern(function(p) return 0.05 * glint.sin(20 * p.x) * glint.sin(20 * p.z) end)
  for _, distribution in ipairs(DISTRIBUTIONS) do
    for _, roughness in ipairs { 0, 1e-9, 1e-4, 0.1, 1 } do
      for _, bump in ipairs { false, waves } do
        for _, fields in ipairs { { model = "cook_torrance", f0 = 1 }, { mirror = 1 }, { fresnel = true, transmission = 1 } } do
          local own = { diffuse = 0, roughness = roughness, distribution = distribution, bump = bump or nil }
          for name, value in pairs(fields) do own[name] = value end
          local camera = glint.camera { eye = { 0, 1e-3, 9 }, at = { 0, 0, 0 }, fov = 2 }
          local scene = glint.scene { background = 1, reflection_samples = 4, camera = camera,
            glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material(own) } }
          local image = scene:render { width = 16, height = 12 }
          local least, most = math.huge, -math.huge
          for y = 0, 11 do
            for x = 0, 15 do
              local v = image:pixel(x, y)
              least, most = math.min(least, v == v and v or -1), math.max(most, v)
            end
          end
          check(least >= 0 and most <= (distribution == "ggx" and 1.05 or 2.7), "%s, roughness %g, %s: light of %g to %g",
            distribution, roughness, fields.model or "phong", least, most)
        end
      end
    end
  end
end

function tests.fields()
  local material = glint.material {}
  check(material.roughness == 0 and material.mirror.x == 0, "smooth by default")
  material.model = "cook_torrance"
  check(material.roughness == 0.3 and material.mirror.x == 1, "facets reflect by default")
  material.roughness = 0.6
  material.model = "phong"
  check(material.roughness == 0.6 and material.mirror.x == 0, "a given roughness stays")
  material.roughness = nil
  check(material.roughness == 0, "nil restores the default")
  raises("scene.reflection_samples: whole number 0 .. 65536 expected, got -1", function() glint.scene { reflection_samples = -1 } end)
  raises("material.roughness: number 0 .. 1 expected, got 2", function() glint.material { mirror = 1, roughness = 2 } end)
  local gold = glint.material { model = "cook_torrance", f0 = { 1, 0.8, 0.3 }, diffuse = 0 }
  check(ball(gold, { background = 1, reflection_samples = 0 })(31, "beauty") == 0, "no samples: lamps alone")
  check(ball(gold, { background = 1 }, { max_depth = 0 })(31, "beauty") == 0, "max_depth 0: lamps alone")
  gold.mirror = 0
  check(ball(gold, { background = 1 })(31, "beauty") == 0, "mirror 0: lamps alone")
  gold.mirror, gold.specular = nil, glint.pattern(function() return 0.5 end)
  local half = ball(gold, { background = 1, reflection_samples = 64 })(31, "mirror")
  gold.specular = glint.pattern(function(p) return 0.5 + 0 * p.x end)
  check(ball(gold, { background = 1, reflection_samples = 64 })(31, "mirror") == half and half > 0.3, "a pattern of the highlight weighs what facets reflect")
end

-- With reflection_samples = 0, paths of indirect light end at rough glass as at a black ball.
function tests.paths_end_at_rough_glass_without_samples()
  local function light(material)
    return glint.scene {
      indirect = { samples = 8, bounces = 3 }, reflection_samples = 0, background = { 0.5, 0.7, 1 },
      camera = glint.camera { eye = { 0, 3, 8 }, at = { 0, 0.5, 0 }, fov = 40 },
      glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.8, specular = 0 } },
      glint.plane { point = { 0, 0, -2 }, normal = { 0, 0, 1 }, material = glint.material { diffuse = 0.8, specular = 0 } },
      glint.sphere { center = { 0, 1, 0 }, radius = 1, material = material } }
      :render { width = 64, height = 48, samples = 2, passes = { "indirect" } }:bytes "indirect"
  end
  local black <const> = light(glint.material { diffuse = 0, specular = 0 })
  for _, model in ipairs { "phong", "cook_torrance" } do
    for _, fresnel in ipairs { false, true } do
      for _, mirror in ipairs { 0, 0.5 } do
        local glass = glint.material { model = model, diffuse = 0, transmission = 0.5, mirror = mirror, fresnel = fresnel, roughness = 0.4, ior = 1.4 }
        check(light(glass) == black, "%s, fresnel %s, mirror %g", model, fresnel, mirror)
      end
    end
  end
end

-- A scene with all of it, whose lamp and roughness change.
local EVERYTHING <const> = [[
local glint = require "glint"
local rough = glint.pattern(function(p) return 0.2 + 0.2 * glint.noise(p * 3) end)
local wave = glint.pattern(function(p) return 0.02 * glint.sin(9 * p.x) end)
local floor = glint.material { diffuse = 0.5, mirror = 0.2, roughness = 0.2 }
local function ball(x, z, radius, fields)
  return glint.sphere { center = { x, 0.3, z }, radius = radius, material = glint.material(fields) }
end
local lamp = glint.sphere_light { position = { 3, 5, 4 }, radius = 0.5, samples = 4, visible = true }
local scene = glint.scene { ambient = 0.2, background = glint.pattern(function(d) return d * 0.4 + 0.5 end),
  camera = glint.camera { eye = { 0, 1.5, 7 }, at = { 0, 0.5, 0 } }, reflection_samples = 4,
  indirect = { samples = 2, bounces = 2 }, lamp,
  glint.plane { point = { 0, -0.5, 0 }, normal = { 0, 1, 0 }, material = floor },
  ball(-1.6, 0, 0.8, { model = "cook_torrance", f0 = 0.7, roughness = rough }),
  ball(0, 0.5, 0.8, { diffuse = 0, fresnel = true, transmission = 0.9, absorption = { 0.3, 0.1, 0 }, roughness = 0.3 }),
  ball(0, 0.5, 0.3, { diffuse = 0.2, mirror = 0.6, roughness = 0.5, distribution = "beckmann" }),
  ball(1.7, 0, 0.8, { model = "cook_torrance", f0 = 0.5, roughness = 0.4, opacity = 0.6, bump = wave }),
  ball(3.2, 1, 0.7, { diffuse = 0, mirror = 0.9 }),
}
return glint.animation { scene = scene, frames = 4, samples = 2, frame = function(t, n)
  lamp.intensity = 1 + t
  floor.roughness = n == 3 and 0.3 or 0.2
end }
]]

function tests.same_everywhere()
  local script = os.tmpname()
  local file = assert(io.open(script, "w"))
  file:write(EVERYTHING)
  file:close()
  dofile "tests/lua/everywhere.lua"(tally, script, 4, 4)
  os.remove(script)
end

-- The pass albedo includes what a surface reflects and transmits at normal incidence: Fresnel's colour of metal, 1 for glass.
function tests.albedo_for_denoisers()
  local cases = {
    { { 0.3, 0.3, 0.3 }, { diffuse = 0.3 } }, { { 2, 2, 2 }, { diffuse = 2 } },
    { { 1, 0.77, 0.34 }, { diffuse = 0, model = "cook_torrance", specular = 1, f0 = { 1, 0.77, 0.34 }, roughness = 0.3 } },
    { { 0.14, 0.14, 0.14 }, { diffuse = 0.1, model = "cook_torrance", specular = 1, f0 = 0.04, roughness = 0.3 } },
    { { 0.1, 0.1, 0.1 }, { diffuse = 0.1, model = "cook_torrance", specular = 1, f0 = 0.04, mirror = 0 } }, -- lamps alone
    { { 0.6, 0.6, 0.6 }, { diffuse = 0, mirror = 0.6, roughness = 0.2 } }, { { 0.9, 0.8, 1 }, { diffuse = 0.5, mirror = { 0.4, 0.3, 0.9 } } },
    { { 1, 1, 1 }, { diffuse = 0, mirror = 1, transmission = 1, ior = 1.5, fresnel = true } },
    { { 0.96 * 0.5 + 0.04, 1, 1 }, { diffuse = 0, mirror = 1, transmission = { 0.5, 1, 1 }, ior = 1.5, fresnel = true, roughness = 0.2 } },
    { { 0.6, 0.6, 0.6 }, { diffuse = 0.2, opacity = 0.5, mirror = 0.4 } }, -- without its opacity
    { { 0.45, 0.45, 0.45 }, { diffuse = 0.25, mirror = glint.pattern(function() return 0.2 end) } },
  }
  for i, case in ipairs(cases) do
    local image = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } },
      glint.sphere { center = { 0, 0, 0 }, radius = 2, material = glint.material(case[2]) },
    }:render { width = 3, height = 3, output = "none", passes = "albedo" }
    for c, want in ipairs(case[1]) do near(select(c, image:pixel(1, 1, "albedo")), want, 1e-6, ("albedo %d.%d"):format(i, c)) end
  end
end

-- A limit of the light of paths leaves the background that is seen through a piece of rough glass as it is, and limits what
-- is reflected on the way.
function tests.a_limit_spares_glass()
  local function look(clamp, depth)
    return glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 }, fov = 12 }, background = 10, reflection_samples = 8,
      glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { diffuse = 0, transmission = 1, fresnel = true, roughness = 0.3 } },
    }:render { width = 8, height = 8, output = "none", passes = "beauty,transmission", clamp = clamp, max_depth = depth }
  end
  for depth = 2, 4 do
    local free, limited, lower = look(0, depth), look(1, depth), 0
    for y = 0, 7 do
      for x = 0, 7 do
        local a, b = free:pixel(x, y, "transmission"), limited:pixel(x, y, "transmission")
        lower = lower + (b < a and 1 or 0)
        check(b <= a and b >= 0.5 * a, "depth %d, pixel %d, %d: %g becomes %g", depth, x, y, a, b)
      end
    end
    check((lower > 0) == (depth > 2), "depth %d: %d pixels are limited", depth, lower)
  end
end

-- The pass albedo shows what smooth mirrors and smooth glass show: the blend of the albedos of their rays, 1 for the surroundings.
function tests.albedo_through_mirrors_and_glass()
  local red, silver = { 0.8, 0.2, 0.1 }, { 0.9, 0.8, 0.7 }
  local function matt(diffuse) return glint.material { diffuse = diffuse } end
  local function shows(what, want, objects, options)
    local fields = { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 }, fov = 20 }, background = { 3, 0, 0 }, table.unpack(objects) }
    local all = { width = 3, height = 3, output = "none", passes = "albedo,normal" }
    for name, value in pairs(options or {}) do all[name] = value end
    local image = glint.scene(fields):render(all)
    for c = 1, 3 do near(select(c, image:pixel(1, 1, "albedo")), want[c], 1e-5, ("%s: channel %d"):format(what, c)) end
    near(select(3, image:pixel(1, 1, "normal")), 1, 1e-6, what .. ": the normal is the first surface's")
  end
  local function times(a, b) return { a[1] * b[1], a[2] * b[2], a[3] * b[3] } end
  local function wall(z, material) return glint.box { min = { -50, -50, z - 1 }, max = { 50, 50, z }, material = material } end
  local behind = glint.sphere { center = { 0, 0, 12 }, radius = 2, material = matt(red) } -- of the camera
  local mirror = glint.material { diffuse = 0, mirror = silver }
  local stripes = glint.pattern(function(p) return glint.select(glint.less(p.z, 5), 1, red) end)
  shows("a mirror that shows a ball", times(silver, red), { wall(0, mirror), behind })
  shows("with several samples", times(silver, red), { wall(0, mirror), behind }, { samples = 5 })
  shows("in float", times(silver, red), { wall(0, mirror), behind }, { precision = "float" })
  shows("adaptive", times(silver, red), { wall(0, mirror), behind }, { samples = 4, adaptive = 0.1 })
  shows("a mirror that shows a ball with a pattern", times(silver, red),
    { wall(0, mirror), glint.sphere { center = { 0, 0, 12 }, radius = 2, material = glint.material { diffuse = stripes } } })
  shows("a mirror that shows the background", silver, { wall(0, mirror) })
  shows("no rays", silver, { wall(0, mirror), behind }, { max_depth = 0 })
  shows("two mirrors that show a ball", times(silver, times(silver, silver)),
    { wall(0, mirror), glint.box { min = { -50, -50, 12 }, max = { 50, 50, 13 }, material = mirror } }, { max_depth = 2 })
  shows("a mirror that shows rough metal", times(silver, { 1, 0.77, 0.34 }), { wall(0, mirror), glint.sphere { center = { 0, 0, 12 }, radius = 2,
    material = glint.material { model = "cook_torrance", diffuse = 0, specular = 1, f0 = { 1, 0.77, 0.34 }, roughness = 0.3 } } })
  shows("a matt surface that mirrors", { 0.3 + 0.5 * 0.8, 0.3 + 0.5 * 0.2, 0.3 + 0.5 * 0.1 },
    { wall(0, glint.material { diffuse = 0.3, mirror = 0.5 }), behind })
  shows("a translucent mirror", times(silver, red), { wall(0, glint.material { diffuse = 0, mirror = silver, opacity = 0.5 }), behind })
  shows("at most 1", { 1, 1, 1 }, { wall(0, glint.material { diffuse = 0.9, mirror = 1 }), behind })
  local r, t, through = 0.04, 0.96, {}
  local glass = { diffuse = 0, mirror = 1, transmission = 1, ior = 1.5, fresnel = true }
  for c = 1, 3 do through[c] = r + t * t * (red[c] + r) / (1 - r * r) end
  local globe = glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material(glass) }
  shows("a glass ball before a wall", through, { globe, wall(-3, matt(red)) })
  glass.mirror, glass.fresnel, glass.transmission, glass.absorption = nil, false, 0.9, { 0.1, 0.2, 0.3 }
  for c = 1, 3 do through[c] = 0.81 * math.exp(-2 * glass.absorption[c]) * red[c] end
  shows("tinted glass before a wall", through,
    { glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material(glass) }, wall(-3, matt(red)) })
end

tally.run(tests)
tally.finish()
