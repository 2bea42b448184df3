-- Patterns as a material's ambient reflectance: closed forms, comparison with constants of the same value in every
-- configuration, and the light of glowing surfaces on other surfaces.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"
local tests = {}

local ROUNDING <const> = 2 ^ -23 -- rounding error of a float32 near 1
local LOSS <const> = 2 ^ -20 -- largest error: the light that dropped weak rays may carry
local PASSES <const> = "beauty,ambient,diffuse,specular,indirect,mirror"

-- A pattern of one colour that the tracer cannot recognise as constant.
local function even(color)
  return glint.pattern(function(p) return glint.vector(color) + 0 * p.x end)
end

-- Seen from above: x to the right, z down, one unit per pixel.
local function floor_picture(material, more, ambient)
  local options = { width = 4, height = 4, output = "none", passes = "beauty,ambient,diffuse" }
  for name, value in pairs(more or {}) do options[name] = value end
  return glint.scene { ambient = ambient or { 0.5, 0.25, 1 },
    camera = glint.camera { projection = "orthographic", eye = { 0, 5, 0 }, direction = { 0, -1, 0 }, up = { 0, 0, -1 }, height = 4 },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = material } }:render(options)
end

function tests.it_is_the_number_at_each_point()
  local stripes = glint.pattern(function(p) return glint.select(glint.less(0, p.x), { 0.5, 1, 0.25 }, 0.125) end)
  for _, precision in ipairs { "double", "float" } do
    local image = floor_picture(glint.material { diffuse = 0.7, ambient = stripes }, { precision = precision })
    for x = 0, 3 do
      local want = x < 2 and { 0.0625, 0.03125, 0.125 } or { 0.25, 0.25, 0.25 }
      local got = { image:pixel(x, x, "ambient") }
      for c = 1, 3 do check(got[c] == want[c], "%s: ka Ia: %g expected, got %g", precision, want[c], got[c]) end
      check(image:pixel(x, x, "diffuse") == 0)
    end
  end
  -- NaN and negative values become 0. A pattern without inputs equals a constant.
  check(floor_picture(glint.material { ambient = glint.pattern(function(p) return -1 + 0 * p.x end) }):pixel(1, 1) == 0)
  check(floor_picture(glint.material { ambient = glint.pattern(function() return 0.5 end) }):pixel(1, 1) == 0.25)
  local material = glint.material { diffuse = even { 0.5, 0.5, 0.5 } }
  check(floor_picture(material):pixel(1, 1) == 0.25, "it follows diffuse")
  material.ambient = even { 1, 1, 1 }
  check(floor_picture(material):pixel(1, 1) == 0.5, "until it has its own")
  material.ambient = nil
  check(floor_picture(material):pixel(1, 1) == 0.25, "and follows again")
end

-- Constants and patterns of the same value, in every shading configuration.
local KA <const> = { 0.5, 0.25, 0.75 }
local function room(kd, ka, more)
  local function material(fields)
    fields.diffuse, fields.ambient = kd, ka
    return glint.material(fields)
  end
  local scene = glint.scene { ambient = { 0.4, 0.3, 0.2 }, background = 0.2, indirect = more.indirect,
    camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 1, 0 }, fov = 50 }, glint.point_light { position = { 3, 5, 4 }, intensity = 0.6 },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = material {} },
    glint.sphere { center = { -1.6, 1, 0 }, radius = 1, material = material { specular = 0.5, shininess = 20 } },
    glint.sphere { center = { 0.5, 0.6, 1.8 }, radius = 0.6, material = material { mirror = 0.5 } },
    glint.sphere { center = { -0.4, 0.4, 3 }, radius = 0.4,
      material = material { model = glint.shader(function(s) return s.kd * s.light * s.n:dot(s.l) end) } },
    glint.sphere_mesh { center = { 1.6, 1, 0 }, radius = 1, segments = 12, shading = more.shading or "gouraud", material = material {} } }
  local options = { width = 60, height = 40, output = "none", passes = PASSES }
  for name, value in pairs(more.render or {}) do options[name] = value end
  return scene:render(options)
end

local function compare(name, kd, more, tolerance)
  local number, pattern = room(kd, KA, more), room(kd, even(KA), more)
  local worst = 0
  for pass in PASSES:gmatch "%a+" do
    for y = 0, 39 do
      for x = 0, 59 do
        local a, b = { number:pixel(x, y, pass) }, { pattern:pixel(x, y, pass) }
        for c = 1, 3 do worst = math.max(worst, math.abs(a[c] - b[c])) end
      end
    end
  end
  near(worst, 0, tolerance, name .. ": the greatest difference")
end

function tests.it_is_a_number_by_every_way_to_shade()
  local number, pattern = { 0.6, 0.1, 0.3 }, even { 0.6, 0.1, 0.3 }
  for kind, kd in pairs { number = number, pattern = pattern } do
    compare(kind .. ", one sample", kd, {}, ROUNDING)
    compare(kind .. ", flat", kd, { shading = "flat" }, ROUNDING)
    compare(kind .. ", four samples", kd, { render = { samples = 4 } }, ROUNDING)
    compare(kind .. ", adaptive", kd, { render = { samples = 4, adaptive = 0.1 } }, ROUNDING)
    compare(kind .. ", float", kd, { render = { precision = "float" } }, ROUNDING)
    compare(kind .. ", indirect", kd, { indirect = { samples = 4, bounces = 2 } }, 8 * LOSS) -- these drop more rays
    compare(kind .. ", no bounces", kd, { indirect = { samples = 4, bounces = 0 } }, ROUNDING)
  end
end

-- The excess of ambient over diffuse lights other surfaces: a floor next to an infinite wall that emits E receives kd
-- E / 2, because half of the cosine-weighted directions hit the wall.
function tests.it_lights_others()
  local glow = 0.5
  local scene = glint.scene { ambient = 1, indirect = { samples = 4096, bounces = 1 },
    camera = glint.camera { projection = "orthographic", eye = { 1, 5, 0 }, direction = { 0, -1, 0 }, up = { 0, 0, -1 }, height = 0.01 },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.8, ambient = 0 } },
    glint.plane { point = { 0, 0, 0 }, normal = { 1, 0, 0 },
      material = glint.material { diffuse = 0, ambient = glint.pattern(function(p) return glow + 0 * p.y end) } } }
  local image = scene:render { width = 2, height = 2, output = "none" }
  near(image:pixel(0, 0), 0.8 * glow / 2, 2e-3, "half of the sky glows")
end

-- A changed number in the pattern reruns the stages that read it. The picture equals one from a fresh renderer.
function tests.a_changed_number_shows()
  local k = 0.25
  local material = glint.material { diffuse = 0.5, ambient = glint.pattern(function(p) return k + 0 * p.x end) }
  local scene = glint.scene { ambient = 1, camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } },
    glint.sphere { center = { 0, 0, 0 }, radius = 1, material = material } }
  for _, want in ipairs { 0.25, 0.25, 0.5, 0.5, 0.75, 0.25 } do
    k = want
    check(scene:render { width = 8, height = 8, output = "none" }:pixel(4, 4) == want, "%g", want)
  end
end

tally.run(tests)
tally.finish()
