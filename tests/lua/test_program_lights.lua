-- Programs under every kind of light: Lambert's law as a shader equals the built-in model,
-- and a bump without slope changes nothing.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local POSITION <const> = { 2, 3, 1 }
local LIGHTS = {
  point = function() return glint.point_light { position = POSITION, attenuation = { 1, 0.1, 0.02 } } end,
  directional = function() return glint.directional_light { direction = { -1, -2, -0.5 } } end,
  spot = function() return glint.spot_light { position = POSITION, direction = { -2, -3, -1 }, inner = 20, outer = 40 } end,
  ["sphere by intensity"] = function() return glint.sphere_light { position = POSITION, radius = 1, samples = 16 } end,
  ["sphere by radiance"] = function()
    return glint.sphere_light { position = POSITION, radius = 1, radiance = 5, samples = 16 }
  end,
  ["sphere that touches"] = function()
    return glint.sphere_light { position = { 0.5, 0, 2 }, radius = 1.25, radiance = 2, samples = 16, shadows = false }
  end,
  ["disk by radiance"] = function()
    return glint.disk_light { position = POSITION, normal = { -2, -3, -1 }, radius = 1, radiance = 5, samples = 16 }
  end,
  caps = function() return glint.sphere_light { position = POSITION, radius = 1, shadow = "caps" } end,
}

local lambert = glint.shader(function(s) return s.kd * s.light * glint.max(s.n:dot(s.l), 0) end)
local level = glint.pattern(function(p) return 0 * p.x end)

local function picture(light, fields, precision)
  fields.diffuse = { 0.8, 0.5, 0.3 }
  local material = glint.material(fields)
  local scene = glint.scene {
    camera = glint.camera { eye = { 0, 3, 8 }, at = { 0, 0, 0 } }, ambient = 0.1, light,
    glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = material },
    glint.sphere { center = { 0, 0, 0 }, radius = 1, material = material },
  }
  return scene:render { width = 48, height = 32, passes = { "beauty" }, precision = precision }
end

local function largest_difference(a, b)
  local most = 0
  for y = 0, a.height - 1 do
    for x = 0, a.width - 1 do
      local u, v = { a:pixel(x, y) }, { b:pixel(x, y) }
      for c = 1, 3 do most = math.max(most, math.abs(u[c] - v[c])) end
    end
  end
  return most
end

local tests = {}
for name, make in pairs(LIGHTS) do
  for _, precision in ipairs { "double", "float" } do
    tests[name .. " " .. precision] = function()
      local want = picture(make(), { model = "lambert" }, precision)
      local bright = 0
      for y = 0, want.height - 1 do
        for x = 0, want.width - 1 do bright = math.max(bright, (want:pixel(x, y))) end
      end
      check(bright > 0.2, "%s: some light", name)
      for what, fields in pairs { shader = { model = lambert }, bump = { model = "lambert", bump = level } } do
        local off = largest_difference(want, picture(make(), fields, precision))
        check(off <= 1e-5, "%s of %s in %s: %g off", what, name, precision, off)
      end
    end
  end
end

tally.run(tests)
tally.finish()
