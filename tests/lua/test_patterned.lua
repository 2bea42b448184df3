-- Materials whose fields hold patterns: they can be read and written, are called once per frame, and show in pictures.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local SIZE <const> = { width = 48, height = 32, passes = { "beauty", "albedo" } }

local function make_scene(material, ...)
  return glint.scene {
    camera = glint.camera { eye = { 1, 4, 9 }, at = { 0, 0, 0 }, fov = 50 }, ambient = 0.2,
    glint.point_light { position = { 4, 9, 6 } },
    glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = material }, ...,
  }
end

local function picture(scene)
  local image, text = scene:render(SIZE), {}
  for y = 0, image.height - 1 do
    for x = 0, image.width - 1 do text[#text + 1] = string.pack("<ddd", image:pixel(x, y)) end
  end
  return table.concat(text), image
end

local function raises(want, call)
  local good, message = pcall(call)
  check(not good and tostring(message):find(want, 1, true), "'%s' expected, got %s", want, tostring(message))
end

local FIELDS = { "diffuse", "ambient", "specular", "mirror", "transmission", "shininess", "roughness" }
local tests = {}

function tests.fields_read_as_their_pattern()
  local pattern = glint.pattern(function(p) return p.x end)
  for _, field in ipairs(FIELDS) do
    local made = glint.material { [field] = pattern }
    check(rawequal(made[field], pattern), "%s of the constructor", field)
    made[field] = 0.25
    check(not rawequal(made[field], pattern) and tostring(made[field]):find "0.25", "%s after a number", field)
    made[field] = pattern
    check(rawequal(made[field], pattern), "%s assigned", field)
  end
  local material = glint.material { diffuse = pattern }
  check(rawequal(material.ambient, pattern), "ambient follows diffuse")
  material.ambient = 0.5
  check(material.ambient.x == 0.5)
  material.ambient = nil
  check(rawequal(material.ambient, pattern), "and follows again")
end

function tests.other_fields_take_none()
  local pattern = glint.pattern(function(p) return p.x end)
  local shader = glint.shader(function(s) return s.kd end)
  for _, field in ipairs { "ior", "absorption", "f0", "fresnel", "model", "name", "matched" } do
    raises("expected, got pattern", function() return glint.material { [field] = pattern } end)
  end
  for _, field in ipairs { "diffuse", "shininess", "bump" } do
    raises("expected, got shader", function() return glint.material { [field] = shader } end)
  end
  raises("material.bump: pattern expected, got 1", function() return glint.material { bump = 1 } end)
  raises("sphere.radius: number expected, got pattern", function() return glint.sphere { center = { 0, 0, 0 }, radius = pattern } end)
  raises("one number expected", function()
    make_scene(glint.material { specular = 1, shininess = glint.pattern(function(p) return p end) }):render(SIZE)
  end)
end

function tests.numbers_alone_are_the_number()
  local plain = picture(make_scene(glint.material { diffuse = { 0.8, 0.5, 0.25 }, specular = 0.5, shininess = 20 }))
  local traced = picture(make_scene(glint.material {
    diffuse = glint.pattern(function() return { 0.8, 0.5, 0.25 } end), specular = glint.pattern(function() return 0.5 end),
    shininess = glint.pattern(function() return 4 * 5 end),
  }))
  check(plain == traced, "the same picture")
end

function tests.minus_0_is_0()
  local function lit(shininess) return (picture(make_scene(glint.material { specular = 0.3, shininess = shininess }))) end
  local minus = lit(-0.0) -- first, so that no results are cached from the other zero
  check(minus == lit(glint.pattern(function() return -0.0 end)), "as a pattern")
  check(minus == lit(0.0), "as 0")
end

-- v runs from the base to the top of a shape. It is constant on a cap or base, which shows one row of a texture.
function tests.ends_are_in_one_row()
  local halves = glint.pattern(function(_, s) return glint.floor(2 * glint.fract(s.uv.v)) end)
  local function count(shape) -- pixels of the lower and upper halves of v, from above, so that only the end is visible
    local image = glint.scene { camera = glint.camera { eye = { 0.1, 9, 0 }, at = { 0, 0, 0 }, fov = 20 }, ambient = 1, shape }
      :render { width = 96, height = 96, passes = { "albedo", "object_id" } }
    local seen = { [0] = 0, 0 }
    for y = 0, 95 do
      for x = 0, 95 do
        local half = image:pixel(x, y, "albedo") // 1
        if image:pixel(x, y, "object_id") > 0 then seen[half] = (seen[half] or 0) + 1 end
      end
    end
    return seen
  end
  local material = glint.material { diffuse = halves }
  for i = 1, 8 do
    local low, high = { 0.003 * i, 0.01 * i, 0.01 }, { -0.005 * i, 0.1, 0.002 * i }
    local cap = count(glint.cylinder { base = low, top = high, radius = 0.8, material = material })
    check(cap[0] < 99 and cap[1] > 400, "a cap: %d pixels of the lower half, %d of the upper", cap[0], cap[1])
    local base = count(glint.cone { base = high, top = low, radius = 0.8, material = material })
    check(base[1] < 99 and base[0] > 400, "a base: %d pixels of the lower half, %d of the upper", base[0], base[1])
  end
end

-- The pass albedo equals the function evaluated by plain Lua at the point, rounded to float.
function tests.albedo_is_what_plain_lua_says()
  local function f(p) return glint.mix({ 0.1, 0.2, 0.9 }, { 1, 0.5, 0.25 }, glint.smoothstep(-0.2, 0.2, glint.noise(p * 1.7))) end
  local ball = glint.sphere { center = { 0, 0.5, 0 }, radius = 1.5, material = glint.material { diffuse = glint.pattern(f) } }
  local scene = make_scene(glint.material {}, ball)
  local _, image = picture(scene)
  local camera, seen = scene.camera, 0
  local w = (glint.vector(camera.eye) - camera.at):unit()
  local u = glint.cross({ 0, 1, 0 }, w):unit()
  local v = w:cross(u)
  for y = 0, image.height - 1 do
    for x = 0, image.width - 1 do
      local half = math.tan(math.rad(25))
      local sx, sy = (x + 0.5 - 24) / 16 * half, (16 - y - 0.5) / 16 * half
      local hit = scene:cast(camera.eye, u * sx + v * sy - w)
      if hit and hit.object == ball then
        seen = seen + 1
        local want, got = f(glint.vector(hit.point)), { image:pixel(x, y, "albedo") }
        for c = 1, 3 do tally.near(got[c], want[c], 1e-6, ("pixel %d, %d"):format(x, y)) end
      end
    end
  end
  check(seen > 60, "%d pixels show the ball", seen)
end

function tests.a_pattern_is_called_once_a_frame()
  local calls, other = 0, 0
  local shared = glint.pattern(function(p) calls = calls + 1 return glint.fract(p.x) end)
  local material = glint.material { diffuse = shared, specular = shared }
  local unused = glint.material { diffuse = glint.pattern(function(p) other = other + 1 return p.x end) }
  local scene = make_scene(material, glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { mirror = shared } })
  scene:render(SIZE)
  check(calls == 65, "once, and at 64 points: %d", calls)
  scene:render(SIZE)
  check(calls == 66, "once more: %d", calls)
  check(other == 0 and unused ~= nil, "not those of other scenes")
end

function tests.upvalues_change_the_picture()
  local scale = 1
  local scene = make_scene(glint.material { diffuse = glint.pattern(function(p) return glint.checker(p * scale) end) })
  local first = picture(scene)
  scale = 2
  local second = picture(scene)
  check(first ~= second, "another scale is another picture")
  scale = 1
  check(picture(scene) == first, "and back")
  local fresh = make_scene(glint.material { diffuse = glint.pattern(function(p) return glint.checker(p * 1) end) })
  check(picture(fresh) == first, "as a scene of its own")
end

function tests.groups_and_lists_are_found()
  local calls = 0
  local function material() return glint.material { diffuse = glint.pattern(function(p) calls = calls + 1 return p.x end) } end
  local ball = glint.sphere { center = { 0, 0, 0 }, radius = 1, material = material() }
  local inner = glint.group { ball, transform = glint.translate(1, 0, 0) }
  local scene = make_scene(glint.material {}, glint.group { inner, glint.group { inner } },
    glint.spheres { data = { 0, 0, 0, 1, 2, 0, 0, 1 }, materials = { material(), material() }, index = { 1, 2 } })
  scene:render(SIZE)
  check(calls == 3 * 65, "three patterns: %d", calls)
end

function tests.a_closed_material_keeps_its_pattern()
  local calls = 0
  local function make()
    local material <close> = glint.material { diffuse = glint.pattern(function(p) calls = calls + 1 return glint.fract(p.x) end) }
    return make_scene(material)
  end
  local scene = make()
  collectgarbage()
  local closed = picture(scene)
  check(calls == 65, "%d", calls)
  check(closed == picture(make_scene(glint.material { diffuse = glint.pattern(function(p) return glint.fract(p.x) end) })))
end

function tests.errors_of_a_frame_have_the_functions_line()
  local line = debug.getinfo(1, "l").currentline + 1
  local scene = make_scene(glint.material { diffuse = glint.pattern(function(p) return p.w end) })
  local good, message = pcall(scene.render, scene, SIZE)
  check(not good and message:find("test_patterned.lua:" .. line .. ": vector.w: no such field", 1, true), "%s", message)
  check(picture(make_scene(glint.material {})) ~= "", "and the next frame is rendered")
end

function tests.a_frames_functions_change_nothing()
  local scene
  local ball = glint.sphere { center = { 0, 0, 0 }, radius = 1 }
  local material = glint.material { diffuse = glint.pattern(function() scene:remove(scene:add(ball)) return 1 end) }
  scene = make_scene(material)
  raises("scene.add: the function of a pattern must not change objects", function() scene:render(SIZE) end)
  local renders = glint.material { diffuse = glint.pattern(function() scene:render(SIZE) return 1 end) }
  raises("scene.render: the function of a pattern must not change objects", function() make_scene(renders):render(SIZE) end)
end

function tests.animations_see_each_frame()
  local shift = 0
  local material = glint.material { diffuse = glint.pattern(function(p) return glint.stripe(p.x + shift) end) }
  local scene, folder = make_scene(material), os.tmpname()
  os.remove(folder)
  local film = glint.animation { scene = scene, frames = 3, width = 32, height = 24, output = folder .. "_%d.png",
    frame = function(t) shift = t end }
  film:run()
  local function content(n)
    local file = assert(io.open(("%s_%d.png"):format(folder, n), "rb"))
    local text = file:read "a"
    file:close()
    return text
  end
  check(content(1) ~= content(2) and content(2) ~= content(3))
  for n = 1, 3 do os.remove(("%s_%d.png"):format(folder, n)) end
end

function tests.evaluate_sees_the_point()
  local material = glint.material { specular = glint.pattern(function(p) return glint.select(glint.checker(p), 1, 0) end), shininess = 8,
    diffuse = glint.pattern(function(p) return { p.x, 0.5, 0 } end) }
  local plain = glint.material { specular = 1, shininess = 8, diffuse = { 0.75, 0.5, 0 } }
  local at = { normal = { 0, 0, 1 }, to_light = { 0.3, 0.1, 1 }, to_eye = { -0.2, 0, 1 }, p = { 0.75, 1.5, 0 } }
  local got, want = material:evaluate(at), plain:evaluate(at)
  check(got.diffuse == want.diffuse and got.specular == want.specular and want.specular.x > 0)
  at.p = { 0.75, 0.5, 0 }
  check(material:evaluate(at).specular.x == 0)
end

function tests.evaluate_runs_shaders()
  local at = { normal = { 0, 0, 1 }, to_light = { 0.3, 0.1, 1 }, to_eye = { -0.2, 0, 1 } }
  local toon = glint.material { diffuse = 0.5, specular = 0.25, model = glint.shader(function(s)
    return s.kd * glint.select(glint.less(0.9, s.n:dot(s.l)), 1, 0.25), s.ks * s.shininess
  end) }
  local out = toon:evaluate(at)
  check(out.diffuse.x == 0.5 and out.specular.x == 0.25 * 32)
  at.to_light = { 0, 0, -1 }
  check(toon:evaluate(at).diffuse.x == 0, "a light behind the surface")
end

-- Phong's model as a shader equals the built-in model, except for rounding to float.
function tests.phong_as_a_shader_is_phong()
  local shader = glint.shader(function(s)
    return s.kd * s.light * s.n:dot(s.l), s.ks * s.light * glint.highlight((-s.l):reflect(s.n):dot(s.v), s.shininess)
  end)
  local function image(model)
    return select(2, picture(make_scene(glint.material { diffuse = { 0.6, 0.3, 0.1 }, specular = 0.5, shininess = 30, model = model })))
  end
  local plain, shaded, worst = image "phong", image(shader), 0
  for y = 0, plain.height - 1 do
    for x = 0, plain.width - 1 do
      local a, b = { plain:pixel(x, y) }, { shaded:pixel(x, y) }
      for c = 1, 3 do worst = math.max(worst, math.abs(a[c] - b[c])) end
    end
  end
  tally.near(worst, 0, 2e-6, "the greatest difference")
end

-- A height of a x tilts a floor's normal to (-a, 1, 0).
function tests.a_bump_of_a_slope_tilts_the_normal()
  local slope = 0.25
  local function lit(fields, direction)
    local scene = glint.scene {
      camera = glint.camera { eye = { 0, 5, 0.001 }, at = { 0, 0, 0 } }, glint.directional_light { direction = direction },
      glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material(fields) },
    }
    return (scene:render { width = 8, height = 8 }:pixel(4, 4))
  end
  local bump = glint.pattern(function(p) return slope * p.x end)
  local l = glint.unit { 0.5, 1, 0.2 }
  local want = 0.8 * glint.unit({ -slope, 1, 0 }):dot(l)
  tally.near(lit({ diffuse = 0.8, bump = bump }, -l), want, 1e-6, "tilted")
  tally.near(lit({ diffuse = 0.8, bump = glint.pattern(function() return 3 end) }, -l), 0.8 * l.y, 1e-6, "a height without slope")
end

-- The ambient light of a pattern is not in its material's constants: frames with another ambient must not reuse it.
function tests.ambient_light_changes_what_patterns_show()
  local wave = glint.pattern(function(p) return 0.25 + glint.fract(p.x) / 2 end)
  local shader = glint.shader(function(s) return s.kd end)
  local kinds = { { diffuse = wave }, { diffuse = 0.5, ambient = wave }, { diffuse = wave, ambient = 0.3 }, { diffuse = wave, model = shader } }
  for i, fields in ipairs(kinds) do
    for _, occluded in ipairs { false, true } do
      local scene = glint.scene { camera = glint.camera { eye = { 0, 2, 9 }, at = { 0, 0.8, 0 } }, ambient = 0.1,
        glint.sphere { center = { 0, 1, 0 }, radius = 2, material = glint.material(fields) } }
      scene.ambient_occlusion = occluded and glint.ambient_occlusion { samples = 1 } or nil
      local first
      for frame = 1, 5 do
        scene.ambient = frame < 4 and 0.1 or 0.4
        local here = scene:render { width = 16, height = 12 }:pixel(8, 6)
        first = first or here
        tally.near(here, (frame < 4 and 1 or 4) * first, 1e-6, ("kind %d, frame %d"):format(i, frame))
      end
      check(first > 0)
    end
  end
end

function tests.textures_are_looked_up()
  local name = os.tmpname() .. ".png"
  local source = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, background = { 0.25, 0.5, 1 },
    ambient = 1, glint.sphere { center = { 1, 0, 0 }, radius = 1, material = glint.material { diffuse = 0, ambient = { 1, 0, 0 } } } }
  source:render { width = 16, height = 8 }:save(name)
  local photo = glint.texture { file = name, wrap = "clamp", filter = "nearest" }
  check(photo.width == 16 and photo.height == 8 and photo.wrap == "clamp" and photo.transfer == "srgb" and photo.file == name)
  local blue = photo(0.05, 0.5)
  tally.near(blue.r, 0.25, 0.01, "red") tally.near(blue.g, 0.5, 0.01, "green") tally.near(blue.b, 1, 0.01, "blue")
  check(blue.a == 1)
  local pattern = glint.pattern(function(_, s) return photo(s.uv, s.uv_footprint) end)
  check(pattern:evaluate { uv = { 0.05, 0.5 } } == glint.sphere { center = blue, radius = 1 }.center, "the same bits in a pattern")
  check(photo:evaluate { uv = { 0.05, 0.5 } }.x == blue.x, "and by itself")
  local image = select(2, picture(make_scene(glint.material { diffuse = photo })))
  local r, g, b = image:pixel(5, 30, "albedo")
  check(r > 0 and g >= 0 and b >= 0)
  raises("a texture cannot be changed", function() photo.wrap = "repeat" end)
  raises("texture.wrong: no such field", function() return photo.wrong end)
  raises("texture.file: name of a PNG file expected, got nil", function() return glint.texture {} end)
  raises('texture.file: name of a PNG file expected, got string ""', function() return glint.texture { file = "" } end)
  raises("no_such_file.png", function() return glint.texture { file = "no_such_file.png" } end)
  local file = assert(io.open(name, "rb"))
  local bytes = file:read "a"
  file:close()
  file = assert(io.open(name, "wb"))
  file:write(bytes:sub(1, #bytes // 2))
  file:close()
  raises(name, function() return glint.texture { file = name } end)
  os.remove(name)
end

tally.run(tests)
tally.finish()
