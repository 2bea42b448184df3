-- Passes light:NAME on random scenes: beauty is identical with and without them and equals their sum; each equals the
-- picture of its own lights, "ambient" is the rest; groups, names, and errors.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local SUM = 2 ^ -21 -- allowed difference between beauty and the sum of all passes, from float32 rounding
local LOST = 2 ^ -20 -- linear light in weak rays that are not traced, see max_depth in the manual
local W, H = 48, 40

local raises = tally.raises

local function random(lo, hi) return lo + (hi - lo) * math.random() end
local function one_of(...) return (select(math.random(select("#", ...)), ...)) end
local function color(most) return { random(0, most or 1), random(0, most or 1), random(0, most or 1) } end
local function place(size, y) return { random(-size, size), random(y or -size, size), random(-size, size) } end

local function material()
  local kind = math.random(8)
  if kind == 1 then return glint.material { diffuse = 0.1, mirror = color(0.8) } end
  if kind == 2 then return glint.material { diffuse = 0, transmission = color(0.9), fresnel = one_of(true, false), absorption = one_of(0, color(0.3)) } end
  if kind == 3 then return glint.material { model = "cook_torrance", diffuse = color(), specular = 0.6, roughness = random(0.1, 0.6) } end
  if kind == 4 then return glint.material { diffuse = color(), ambient = color(), specular = color(), shininess = random(1, 90) } end
  if kind == 5 then
    local tint = color()
    return glint.material { diffuse = glint.pattern(function(p) return glint.select(glint.less(p.x, 0), tint[1], tint[2]) end), specular = 0.3 }
  end
  if kind == 6 then
    return glint.material { diffuse = color(), model = glint.shader(function(s) return s.light * s.kd * glint.max(0, s.n:dot(s.l)) * 0.8 end) }
  end
  return glint.material { diffuse = color(), specular = 0.4, model = one_of("phong", "blinn_phong", "lambert") }
end

local function shape()
  local kind = math.random(5)
  if kind == 1 then return glint.box { min = { -1, -1, -1 }, max = { 1, 1, 1 }, transform = glint.translate(place(4)), material = material() } end
  if kind == 2 then
    return glint.sphere_mesh { center = place(4), radius = random(0.5, 2), segments = 9, shading = one_of("flat", "gouraud", "phong"), material = material() }
  end
  return glint.sphere { center = place(4), radius = random(0.4, 2), material = material() }
end

-- hidden: makes the light's surface invisible. A visible surface would hide objects even when the light is off.
local function light(name, hidden)
  local fields = { name = name, color = color(), intensity = random(0.2, 1.5), shadows = math.random() < 0.8 }
  if math.random() < 0.3 then fields.ambient = color(0.2) end
  if math.random() < 0.3 then fields.attenuation = { 1, 0, 0.01 } end
  local kind = math.random(6)
  if kind == 1 then fields.direction = { random(-1, 1), -1, random(-1, 1) } return glint.directional_light(fields) end
  if kind == 2 then
    fields.position, fields.direction, fields.inner, fields.outer = place(8, 4), { 0, -1, 0 }, 30, 60
    return glint.spot_light(fields)
  end
  fields.position = place(8, 3)
  if kind == 3 then fields.radius, fields.samples, fields.visible = 1, one_of(1, 4, 19), not hidden return glint.sphere_light(fields) end
  if kind == 4 then fields.radius, fields.samples, fields.normal, fields.visible = 2, 5, { 0, -1, 0 }, not hidden return glint.disk_light(fields) end
  return glint.point_light(fields)
end

-- Rebuilds the same scene. only: names of the lights that shine; nil: all, plus the rest.
local function make(seed, only)
  math.randomseed(seed)
  local fields = { camera = glint.camera { eye = { 0, 3, 14 }, at = { 0, 0, 0 }, fov = 45, aperture = math.random() < 0.2 and 0.3 or 0 } }
  for _ = 1, math.random(2, 6) do fields[#fields + 1] = shape() end
  fields[#fields + 1] = glint.plane { point = { 0, -3, 0 }, normal = { 0, 1, 0 }, material = material() }
  local lights, names = math.random(1, 20), {}
  for i = 1, lights do
    local lamp = light("lamp" .. i % 5, seed % 3 == 0)
    names[lamp.name] = true
    if only and not only[lamp.name] then lamp.intensity = 0 end
    fields[#fields + 1] = lamp
  end
  fields.ambient, fields.background = color(0.3), one_of(0, color(0.5))
  if math.random() < 0.4 then fields.indirect = { samples = 3, bounces = 1 }
  elseif math.random() < 0.3 then fields.ambient_occlusion = { samples = 3 } end
  local cue = color()
  if math.random() < 0.3 then fields.depth_cue = { near = 8, far = 30, color = only and 0 or cue } end
  if only then fields.ambient, fields.background = 0, 0 end
  local options = { width = W, height = H, output = "none", samples = one_of(1, 1, 3), alpha = math.random() < 0.2 or nil }
  if math.random() < 0.2 then options.samples, options.adaptive = 4, 0.1 end
  if only then options.adaptive = nil end
  return glint.scene(fields), options, names
end

local function render(seed, passes, only)
  local scene, options, names = make(seed, only)
  options.passes = passes
  return scene:render(options), names, options
end

local tests = {}

local function compare(seed)
  local plain = render(seed)
  local image, names, options = render(seed, "light:*")
  local passes = image.passes
  local count = 1
  for _ in pairs(names) do count = count + 1 end
  check(#passes >= count + 1, "seed %d: a pass a light and the rest, got %s", seed, table.concat(passes, " "))
  local worst, same = 0, true
  for y = 0, H - 1 do
    for x = 0, W - 1 do
      local own, beauty = { plain:pixel(x, y) }, { image:pixel(x, y) }
      local sum = { 0, 0, 0 }
      for _, pass in ipairs(passes) do
        if pass:find "^light:" then
          local light_of = { image:pixel(x, y, pass) }
          for c = 1, 3 do
            sum[c] = sum[c] + light_of[c]
            same = same and light_of[c] >= 0
          end
        end
      end
      for c = 1, 3 do
        same = same and own[c] == beauty[c]
        worst = math.max(worst, math.abs(sum[c] - beauty[c]) / math.max(beauty[c], 1e-30))
      end
    end
  end
  check(same, "seed %d: beauty is as without light passes, and no pass is below 0", seed)
  check(worst <= SUM, "seed %d: passes add up to beauty, off by %g", seed, worst)
  return image, names, options
end

-- Checks that each pass equals the picture of its lights.
local function compare_each(seed, image, names, options)
  for name in pairs(names) do
    local own = render(seed, nil, { [name] = true })
    local worst = 0
    for y = 0, H - 1 do
      for x = 0, W - 1 do
        local a, b = { own:pixel(x, y) }, { image:pixel(x, y, "light:" .. name) }
        for c = 1, 3 do worst = math.max(worst, (math.abs(a[c] - b[c]) - SUM * a[c])) end
      end
    end
    check(worst <= LOST, "seed %d: light:%s is the picture of these lights, off by %g (samples %d)", seed, name, worst, options.samples)
  end
end

function tests.random_scenes()
  for seed = 1, tonumber(os.getenv "SEEDS" or 60), tally.step do
    local image, names, options = compare(seed)
    if not options.adaptive and seed % 3 == 0 then compare_each(seed, image, names, options) end
  end
end

local function still(fields, options)
  fields.camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }
  fields[#fields + 1] = glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { diffuse = 0.5 } }
  local all = { width = 8, height = 8, output = "none" }
  for name, value in pairs(options) do all[name] = value end
  return glint.scene(fields):render(all)
end
local function lamp(fields)
  fields.position = fields.position or { 0, 0, 5 }
  return glint.point_light(fields)
end

function tests.names_and_groups()
  local a, b = lamp { name = "a", group = "g" }, lamp { name = "b", group = "g" }
  local image = still({ ambient = 0.5, a, b, lamp {}, lamp { name = "c" } }, { passes = { "light:*" } })
  check(table.concat(image.passes, " ") == "beauty light:g light:point_light_3 light:c light:ambient", "got %s", table.concat(image.passes, " "))
  local one, both = image:pixel(4, 4, "light:c"), image:pixel(4, 4, "light:g")
  check(one > 0 and both == 2 * one, "a group holds both of its lights: %g and %g", one, both)
  check(image:pixel(4, 4, "light:ambient") == 0.25, "the rest")
  check(image:pixel(0, 0, "light:ambient") == 0, "the rest of nothing")
  local some = still({ lamp { name = "a" }, lamp { name = "b", intensity = 0 } }, { passes = "light:b" })
  check(some:pixel(4, 4, "light:b") == 0, "of a lamp without strength nothing")
  local rest = still({ ambient = 1, lamp { name = "a", ambient = 1 } }, { passes = "light:ambient,light:a" })
  check(rest:pixel(4, 4, "light:ambient") == 0.5 and rest:pixel(4, 4, "light:a") > 0.5, "a lamp's own ambient light is the lamp's")
  raises("light:x' is not stored", function() rest:pixel(0, 0, "light:x") end)
end

function tests.errors()
  raises("did you mean 'light:key'?", still, { lamp { name = "key" } }, { passes = "light:kye" })
  raises("the scene has 'ambient', 'key'", still, { lamp { name = "key" } }, { passes = "light:somethingelse" })
  raises("'light:': expected a light's name", still, { lamp { name = "key" } }, { passes = "light:" })
  raises("use another name", still, { lamp { name = "ambient" } }, { passes = "light:*" })
  raises("for its light pass, expected", still, { lamp { name = "a/b" } }, { passes = "light:*" })
  check(pcall(still, { lamp { name = "a/b" }, lamp { name = "key" } }, { passes = "light:key" }), "names that are not asked for may be any")
end

tally.run(tests)
tally.finish()
