-- Materials against their definitions in doubles, and against physical properties of a reflectance: white furnace,
-- reciprocity, integrals over the hemisphere, small roughness.
local glint = require "glint"

local count, failed = 0, 0

local function ok(good, name, ...)
  count = count + 1
  if good then
    print("ok - " .. name)
  else
    failed = failed + 1
    print("not ok - " .. name .. " " .. string.format(...))
  end
end

local function raises(want, make)
  local good, message = pcall(make)
  ok(not good and tostring(message):find(want, 1, true), want, "got %s", tostring(message))
end

-- ---- Vectors ----

local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end

local function unit(v)
  local length = math.sqrt(dot(v, v))
  return { v[1] / length, v[2] / length, v[3] / length }
end

local function cross(a, b)
  return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

local UP = { 0, 0, 1 }

-- Returns a direction above the surface, from its cosine and azimuth.
local function above(cosine, azimuth)
  local sine = math.sqrt(1 - cosine * cosine)
  return { sine * math.cos(azimuth), sine * math.sin(azimuth), cosine }
end

local function specular(material, l, v)
  return material:evaluate({ normal = UP, to_light = l, to_eye = v }).specular.x
end

-- ---- The definitions, in doubles ----

local function half(l, v) return unit { l[1] + v[1], l[2] + v[2], l[3] + v[3] } end

local function phong(m, l, v)
  local r = { 2 * l[3] * UP[1] - l[1], 2 * l[3] * UP[2] - l[2], 2 * l[3] - l[3] }
  local s = m.shininess
  local lobe = math.max(dot(r, v), 0) ^ s
  return m.normalized and (s + 2) / 2 * lobe * l[3] or lobe
end

local function blinn(m, l, v)
  local s = m.matched and 4 * m.shininess or m.shininess
  local lobe = half(l, v)[3] ^ s
  return m.normalized and (s + 2) * (s + 4) / (8 * (2 ^ (-s / 2) + s)) * lobe * l[3] or lobe
end

-- Smith's Lambda (Heitz 2014). t: tangent of the angle to the normal.
local function lambda(m, alpha, t)
  if m.distribution == "ggx" then
    return (math.sqrt(1 + (alpha * t) ^ 2) - 1) / 2
  end
  local a = 1 / (alpha * t)
  return a < 1.6 and (1 - 1.259 * a + 0.396 * a * a) / (3.535 * a + 2.181 * a * a) or 0
end

local function cook_torrance(m, l, v)
  local h, alpha = half(l, v), m.roughness ^ 2
  local across = cross(UP, h)
  local s2 = dot(across, across)
  local c2 = h[3] * h[3]
  local d
  if m.distribution == "ggx" then
    d = alpha ^ 2 / (math.pi * (s2 + alpha ^ 2 * c2) ^ 2)
  else
    d = math.exp(-s2 / (c2 * alpha ^ 2)) / (math.pi * alpha ^ 2 * c2 * c2)
  end
  local function tangent(w) return math.sqrt(math.max(1 - w[3] * w[3], 0)) / w[3] end
  local g = 1 / (1 + lambda(m, alpha, tangent(l)) + lambda(m, alpha, tangent(v)))
  local f0 = m.f0[1]
  local f = f0 + (1 - f0) * (1 - dot(v, h)) ^ 5
  return math.pi * d * f * g / (4 * v[3])
end

local DEFINITIONS = { phong = phong, blinn_phong = blinn, cook_torrance = cook_torrance }

local MATERIALS = {
  { model = "phong", specular = 1 },
  { model = "phong", specular = 1, normalized = true },
  { model = "blinn_phong", specular = 1 },
  { model = "blinn_phong", specular = 1, matched = true },
  { model = "blinn_phong", specular = 1, normalized = true },
  { model = "blinn_phong", specular = 1, normalized = true, matched = true },
  { model = "cook_torrance", f0 = 1 },
  { model = "cook_torrance", distribution = "beckmann", f0 = 1 },
}

local function name_of(m)
  return string.format("%s%s%s%s", m.model == "cook_torrance" and m.distribution or m.model,
    m.normalized and ", normalised" or "", m.matched and ", matched" or "", m.model == "cook_torrance" and
    string.format(", roughness %g", m.roughness) or string.format(", shininess %g", m.shininess))
end

local function random_pair()
  return above(math.max(math.random(), 1e-3), 7 * math.random()), above(math.max(math.random(), 1e-3), 7 * math.random())
end

-- The error bound of float arithmetic: roundings of 2^-24, and as many in the exponent if there is one. A power below
-- 2^-40 is 0. Beckmann's exponent takes the squared cosine from 1 minus the squared sine, which adds a rounding of 1.
local function definitions()
  math.randomseed(4)
  for _, fields in ipairs(MATERIALS) do
    local m, worst = glint.material(fields), 0
    for _ = 1, 4000 do
      m.shininess = 10 ^ (4 * math.random() - 1)
      m.roughness = 0.02 + 0.98 * math.random()
      if fields.f0 then m.f0 = math.random() end
      local l, v = random_pair()
      local want, got = DEFINITIONS[m.model](m, l, v), specular(m, l, v)
      local exponent = math.abs(math.log(math.max(want, 1e-38))) + (fields.f0 and -4 * math.log(m.roughness) or 0)
      local dark = fields.f0 and 1e-30 or 2 ^ -40 * (fields.normalized and 4 * m.shininess + 2 or 1)
      if fields.distribution then exponent = exponent / half(l, v)[3] ^ 2 end
      worst = math.max(worst, math.abs(got - want) / (want * (32 + 4 * exponent) * 2 ^ -24 + dark))
    end
    ok(worst <= 1, name_of(m) .. " by its definition", "%g times what roundings explain", worst)
  end
end

-- ---- Physics ----

-- Returns the albedo towards v: the midpoint rule over rings around the mirror direction,
-- which are denser close to it.
local function albedo(m, v, n)
  local sum, r = 0, { -v[1], -v[2], v[3] }
  local side = unit(cross(r, math.abs(r[1]) < 0.5 and { 1, 0, 0 } or { 0, 1, 0 }))
  local other = cross(r, side)
  for i = 0, n - 1 do
    local u = (i + 0.5) / n
    local angle, width = math.pi * u ^ 3, 3 * math.pi * u * u / n
    for k = 0, n - 1 do
      local turn = 2 * math.pi * (k + 0.5) / n
      local a, b, c = math.cos(angle), math.sin(angle) * math.cos(turn), math.sin(angle) * math.sin(turn)
      local l = {}
      for x = 1, 3 do
        l[x] = a * r[x] + b * side[x] + c * other[x]
      end
      if l[3] > 0 then
        sum = sum + specular(m, l, v) * math.sin(angle) * width * 2 * math.pi / n
      end
    end
  end
  return sum / math.pi
end

local CONSERVING = {}
for _, s in ipairs { 0.5, 1, 4, 30 } do
  table.insert(CONSERVING, { model = "phong", specular = 1, normalized = true, shininess = s })
  table.insert(CONSERVING, { model = "blinn_phong", specular = 1, normalized = true, shininess = s })
end
for _, roughness in ipairs { 0.3, 0.6, 1 } do
  table.insert(CONSERVING, { model = "cook_torrance", f0 = 1, roughness = roughness })
  table.insert(CONSERVING, { model = "cook_torrance", f0 = 1, roughness = roughness, distribution = "beckmann" })
end

local function furnace()
  for _, fields in ipairs(CONSERVING) do
    local m = glint.material(fields)
    for _, cosine in ipairs { 1, 0.7, 0.2 } do
      local v = above(cosine, 0.3)
      local coarse, fine = albedo(m, v, 40), albedo(m, v, 80)
      local err = math.abs(fine - coarse) + 1e-5
      ok(fine <= 1 + err and err < 0.01, string.format("furnace: %s, n.v = %g", name_of(m), cosine), "%g +- %g", fine, err)
    end
  end
  for _, model in ipairs { "phong", "blinn_phong" } do -- these models are normalised by their albedo seen from above
    for _, s in ipairs { 1, 4, 30 } do
      local m = glint.material { model = model, specular = 1, normalized = true, shininess = s }
      local share = albedo(m, UP, 80)
      ok(math.abs(share - 1) < 2e-3, string.format("%s, shininess %g: all light leaves, seen from above", model, s), "%g", share)
    end
  end
  local smooth = glint.material { model = "cook_torrance", f0 = 1, roughness = 0.3 }
  local share = albedo(smooth, UP, 80)
  ok(share > 0.98, "little is lost between facets of a smooth surface", "%g", share)
  local bare = glint.material { model = "phong", specular = 1, shininess = 4 }
  share = albedo(bare, above(0.1, 0), 40)
  ok(share < 0.9, "plain Phong loses most where it is sharp, and not", "%g", share)
  bare.shininess = 0
  share = albedo(bare, UP, 40)
  ok(share > 1.9, "plain Phong gives off more light than it gets", "%g", share)
end

-- ---- Physics of narrow lobes ----

local NARROW = {}
for _, distribution in ipairs { "ggx", "beckmann" } do
  for _, roughness in ipairs { 0.2, 0.1, 0.05, 0.01 } do
    table.insert(NARROW, { model = "cook_torrance", f0 = 1, distribution = distribution, roughness = roughness })
  end
end

-- Returns the half vector at quantile u of the facets' projected area, from vertical outwards, and its density.
local function facet(m, u, azimuth)
  local a2 = m.roughness ^ 4
  local t2 = m.distribution == "ggx" and a2 * u / (1 - u) or -a2 * math.log(1 - u) -- squared tangent of h's angle
  local c2 = 1 / (1 + t2)
  local density = m.distribution == "ggx" and 1 / (math.pi * a2 * c2 ^ 1.5 * (1 + t2 / a2) ^ 2) or math.exp(-t2 / a2) / (math.pi * a2 * c2 ^ 1.5)
  local sine = math.sqrt(t2 * c2)
  return { sine * math.cos(azimuth), sine * math.sin(azimuth), math.sqrt(c2) }, density
end

local function mirrored(v, h)
  local d = 2 * dot(v, h)
  return { d * h[1] - v[1], d * h[2] - v[2], d * h[3] - v[3] }
end

-- Like `albedo`, by the midpoint rule over half vectors, whose density follows the lobe; and the value from the
-- definition, where density and lobe cancel: the facets that are neither masked nor shadowed.
local function narrow_albedo(m, v, n)
  local function tangent(w) return math.sqrt(math.max(1 - w[3] * w[3], 0)) / w[3] end
  local sum, open = 0, 0
  for i = 0, n - 1 do
    for k = 0, n - 1 do
      local h, density = facet(m, (i + 0.5) / n, 2 * math.pi * (k + 0.5) / n)
      local l = mirrored(v, h)
      if dot(v, h) > 0 and l[3] > 0 then
        sum = sum + specular(m, l, v) * 4 * dot(v, h) / density
        local alpha = m.roughness ^ 2
        open = open + dot(v, h) / (v[3] * h[3]) / (1 + lambda(m, alpha, tangent(l)) + lambda(m, alpha, tangent(v)))
      end
    end
  end
  return sum / (n * n) / math.pi, open / (n * n)
end

local function narrow()
  for _, fields in ipairs(NARROW) do
    local m = glint.material(fields)
    for _, cosine in ipairs { 1, 0.7, 0.2, 0.05 } do
      local v = above(cosine, 0.3)
      local coarse, fine, open = (narrow_albedo(m, v, 40)), narrow_albedo(m, v, 80)
      local err = math.abs(fine - coarse) + 1e-5
      ok(fine <= 1 + err and math.abs(fine - open) < 1e-5 and err < 0.01,
        string.format("furnace: %s, n.v = %g", name_of(m), cosine), "%.7g +- %g, by the definition %.7g", fine, err, open)
    end
    math.randomseed(6)
    local worst, bright = 0, 0
    for _ = 1, 4000 do
      local v = above(math.max(math.random(), 1e-2), 7 * math.random())
      local l = mirrored(v, (facet(m, math.random(), 7 * math.random())))
      if l[3] > 1e-2 then
        local there, back = specular(m, l, v) / l[3], specular(m, v, l) / v[3]
        worst = math.max(worst, math.abs(there - back) / math.max(there, back))
        bright = bright + 1
      end
    end
    ok(worst <= 1e-6 and bright > 3000, "reciprocal within its lobe: " .. name_of(m), "%g of %d", worst, bright)
  end
end

local function reciprocity()
  math.randomseed(5)
  for _, fields in ipairs(CONSERVING) do
    local m, worst = glint.material(fields), 0
    for _ = 1, 1000 do
      local l, v = random_pair()
      local there, back = specular(m, l, v) / l[3], specular(m, v, l) / v[3]
      worst = math.max(worst, math.abs(there - back) / (math.max(there, back) + 1e-3))
    end
    ok(worst <= 1e-6, "reciprocal: " .. name_of(m), "%g", worst)
  end
  local plain = glint.material { model = "phong", specular = 1, shininess = 4 }
  local l, v = above(0.9, 0), above(0.3, math.pi)
  ok(math.abs(specular(plain, l, v) / l[3] - specular(plain, v, l) / v[3]) > 0.4, "plain Phong is not reciprocal", "")
end

-- ---- Small roughness ----

local function tilted(angle) return { math.sin(angle), 0, math.cos(angle) } end

local function small_roughness()
  local m = glint.material { model = "cook_torrance", f0 = 1, diffuse = 0, roughness = math.sqrt(1e-3) }
  local d = 4 * specular(m, UP, UP) / math.pi
  ok(math.abs(d / 318309.886 - 1) < 3e-7, "P12: the peak at alpha 1e-3", "%.9g", d)
  m.roughness = 0.1
  local v = tilted(0.01)
  d = 4 * v[3] * specular(m, v, v) / math.pi
  ok(math.abs(d / 795.880826 - 1) < 1e-6, "P13: alpha 0.01, 0.01 rad off", "%.9g", d)
  for _, distribution in ipairs { "ggx", "beckmann" } do
    m.distribution = distribution
    for _, roughness in ipairs { 0, 1e-9, 1e-6, 1e-3 } do
      m.roughness = roughness
      local peak, beside, low = specular(m, UP, UP), specular(m, tilted(0.01), UP), specular(m, tilted(1.5707), tilted(-1.5707))
      local fine = peak > 1e10 and peak < math.huge and beside >= 0 and beside < 1e-3 and low > 0 and low < math.huge
      ok(fine, string.format("%s, roughness %g: white at the mirror's angle, dark beside", distribution, roughness),
        "%g, %g, %g", peak, beside, low)
    end
  end
  ok(specular(m, above(0.5, 0), { -above(0.5, 0)[1], 0, -0.5 }) == 0, "P9: the light straight behind", "")
end

-- ---- Fields ----

local function fields()
  local m = glint.material { model = "cook_torrance" }
  ok(m.specular == glint.material { specular = 1 }.specular, "cook_torrance reflects without being told to", "")
  ok(math.abs(m.f0.x - 0.04) < 1e-15, "f0 follows ior", "%g", m.f0.x)
  m.ior = 2
  ok(math.abs(m.f0.x - 1 / 9) < 1e-15, "f0 follows another ior", "%g", m.f0.x)
  m.f0 = { 1, 0.8, 0.3 }
  m.ior = 1
  ok(m.f0.y == 0.8, "f0 as it was set", "")
  m.f0 = nil
  ok(m.f0.x == 0, "f0 follows again", "")
  m.specular = 0.5
  m.specular = nil
  m.model = "phong"
  ok(m.specular.x == 0, "specular follows the model again", "")
  raises("material.roughness: number 0 .. 1 expected, got -1", function() m.roughness = -1 end)
  raises("material.roughness: number 0 .. 1 expected, got 1.5", function() m.roughness = 1.5 end)
  raises("material.ior: number > 0 expected, got 0", function() m.ior = 0 end)
  raises("f0: at most 1 expected, got 1.5", function() m.f0 = { 1, 1.5, 1 } end)
  raises("material.distribution: \"ggx\" or \"beckmann\" expected, got string \"gxg\"; did you mean \"ggx\"?",
    function() m.distribution = "gxg" end)
  raises("did you mean \"cook_torrance\"?", function() m.model = "cook-torrance" end)
  raises("material.roughnes: no such field; did you mean 'roughness'?", function() m.roughnes = 1 end)
end

-- ---- Effects that a frame with them uses ----

local GLINT = os.getenv("GLINT") or "build/glint"

-- Returns the command's output for a script that renders three frames while `change` is applied.
local function stages_of(change)
  local path = os.tmpname()
  local file <close> = assert(io.open(path, "w"))
  file:write([[
    local glint = require "glint"
    local metal = glint.material { model = "cook_torrance", f0 = { 0.9, 0.6, 0.3 }, diffuse = 0, mirror = 0 }
    local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } },
      glint.point_light { position = { 4, 5, 6 } }, glint.sphere { center = { 0, 0, 0 }, radius = 2, material = metal } }
    return glint.animation { scene = scene, frames = 4, width = 64, height = 48, frame = function(t, n) ]] .. change .. " end }")
  file:close()
  local pipe <close> = assert(io.popen(GLINT .. " " .. path .. " -o none --json --quiet"))
  local last
  for line in pipe:lines() do
    last = line:find('"event":"frame"', 1, true) and line or last
  end
  os.remove(path)
  return last
end

local function reuse()
  for _, change in ipairs { "metal.roughness = 0.1 + t / 2", "metal.f0 = { 0.5 + t / 3, 0.2, 0.1 }",
    "metal.distribution = n % 2 == 0 and 'ggx' or 'beckmann'" } do
    local line = stages_of(change)
    local kept = true
    for _, stage in ipairs { "cast", "surface", "view", "light", "facet", "occlude" } do
      kept = kept and line:find('"' .. stage .. '":"reused"', 1, true)
    end
    ok(kept and line:find('"shade":"run"', 1, true), change .. ": shade alone runs", "%s", line)
  end
  local line = stages_of("metal.model = 'phong' metal.shininess = 10 + t")
  ok(not line:find('"facet"', 1, true) and not line:find('"view"', 1, true), "without microfacets no stage of theirs",
    "%s", line)
end

definitions()
furnace()
reciprocity()
narrow()
small_roughness()
fields()
reuse()
print(string.format("%d passed, %d failed", count - failed, failed))
os.exit(failed == 0, true)
