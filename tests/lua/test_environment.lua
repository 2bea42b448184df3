-- Backgrounds from a picture or a function, by the direction in which rays leave the scene: each direction of a small
-- picture, its seam and its poles; mirrors and glass, with directions computed here; indirect light under a uniform
-- sky; and identical pictures in every configuration.
local tally = dofile "tests/lua/tally.lua"
package.path = "scripts/lib/?.lua;" .. package.path
local check, near = tally.check, tally.near
local glint = require "glint"
local png = require "glint.png"
local tests = {}

local ROUNDING <const> = 2 ^ -23 -- rounding error of a float32 near 1
local LOSS <const> = 2 ^ -20 -- largest error: the light that dropped weak rays may carry

local raises = tally.raises

-- Returns the linear value of the 8-bit pixel value k.
local function decoded(k)
  local x = k / 255
  return x <= 0.04045 and x / 12.92 or ((x + 0.055) / 1.055) ^ 2.4
end

-- Makes a picture of 8-bit values: code(x, y), y from the top. It is read as linear.
local function picture_of(width, height, code, fields)
  local name, picture = os.tmpname() .. ".png", png.grey(width, height)
  for y = 0, height - 1 do
    for x = 0, width - 1 do picture:set(x, y, decoded(code(x, y))) end
  end
  picture:save(name)
  local all = { file = name, transfer = "linear" }
  for key, value in pairs(fields or {}) do all[key] = value end
  local texture = glint.texture(all)
  os.remove(name)
  return texture
end

local function up_beside(d) return math.abs(d[2]) > 0.9 and { 0, 0, -1 } or { 0, 1, 0 } end

-- Returns the centre pixel of a view with parallel rays along `direction`.
local function look(direction, background, objects, more)
  local fields = { background = background, camera = glint.camera { projection = "orthographic", eye = { 0, 0, 0 },
    direction = direction, up = up_beside(direction), height = 1e-3 }, table.unpack(objects or {}) }
  local options = { width = 3, height = 3, output = "none", passes = "beauty,background,mirror,transmission" }
  for key, value in pairs(more or {}) do options[key] = value end
  local image = glint.scene(fields):render(options)
  local r, g, b = image:pixel(1, 1)
  return r, g, b, image
end

-- Returns the direction for u, v: 0, 0 is the lower left corner; the picture's centre is -z.
local function direction_of(u, v)
  local turn, height = 2 * math.pi * (u - 0.5), -math.cos(math.pi * v)
  local flat = math.sin(math.pi * v)
  return { flat * math.sin(turn), height, -flat * math.cos(turn) }
end

local W <const>, H <const> = 8, 4
local function code_at(x, y) return 10 * x + 70 * y // 2 + 1 end

function tests.each_pixel_is_where_it_belongs()
  for _, filter in ipairs { "nearest", "bilinear" } do
    local sky = picture_of(W, H, code_at, { filter = filter })
    for _, precision in ipairs { "double", "float" } do
      for y = 0, H - 1 do
        for x = 0, W - 1 do
          local d = direction_of((x + 0.5) / W, 1 - (y + 0.5) / H)
          local name = ("%s, %s, column %d, row %d"):format(filter, precision, x, y)
          near(look(d, sky, nil, { precision = precision }), code_at(x, y) / 255, filter == "nearest" and 2 ^ -24 or 2e-6, name)
        end
      end
    end
  end
end

-- Tests the manual's table of panorama columns.
function tests.axes_are_columns_of_the_table()
  local columns = picture_of(360, 180, function(x) return x // 2 end)
  local axes = { { { 0, 0, -1 }, 180 }, { { 1, 0, 0 }, 270 }, { { -1, 0, 0 }, 90 } }
  for _, axis in ipairs(axes) do -- the mean of two columns, which have the values x // 2
    near(255 * look(axis[1], columns), axis[2] / 2 - 0.5, 1e-4, "column " .. axis[2])
  end
  near(255 * look({ 0, 0, 1 }, columns), (0 + 179) / 2, 1e-4, "the first and the last meet at +z")
end

function tests.the_seam_is_none()
  local sky = picture_of(W, H, function(x) return x == 0 and 200 or x == W - 1 and 100 or 10 end)
  for _, shift in ipairs { -0.4, -0.1, 0, 0.1, 0.4 } do -- shifts in columns, to the right of the seam
    local d = direction_of(shift / W, 0.5)
    near(255 * look(d, sky), 150 + 100 * shift, 1e-3, ("%g columns from the seam"):format(shift))
  end
  for _, wrap in ipairs { "clamp", "repeat", "around" } do -- a background has no border, whatever the wrap mode
    local same = picture_of(W, H, function(x) return x == 0 and 200 or x == W - 1 and 100 or 10 end, { wrap = wrap })
    near(255 * look({ 0, 0, 1 }, same), 150, 1e-4, wrap)
  end
end

function tests.poles_are_the_first_and_last_rows()
  local sky = picture_of(W, H, function(_, y) return y == 0 and 200 or y == H - 1 and 50 or 120 end)
  near(255 * look({ 0, 1, 0 }, sky), 200, 1e-4, "up")
  near(255 * look({ 0, -1, 0 }, sky), 50, 1e-4, "down")
  near(255 * look({ 0, 0, -1 }, sky), 120, 1e-4, "ahead")
  local picture = sky -- inside a function the wrap mode of the texture applies
  local own = glint.pattern(function(_, s) return picture(s.uv) end)
  near(255 * look({ 0, 1, 0 }, own), 125, 1e-3, "repeat: the first row and the last")
  local around = picture_of(W, H, function(_, y) return y == 0 and 200 or y == H - 1 and 50 or 120 end, { wrap = "around" })
  near(255 * look({ 0, 1, 0 }, glint.pattern(function(_, s) return around(s.uv) end)), 200, 1e-3, "around")
end

-- A colour that encodes the direction.
local compass = glint.pattern(function(d) return d * 0.5 + 0.5 end)
local function expect(got, d, tolerance, name)
  for c = 1, 3 do near(got[c], d[c] * 0.5 + 0.5, tolerance, ("%s, %s"):format(name, ("xyz"):sub(c, c))) end
end

function tests.the_eye_sees_along_its_rays()
  local forward, right, up = { 0, 0, -1 }, { 1, 0, 0 }, { 0, 1, 0 }
  local width, height, half = 40, 30, math.tan(math.rad(35))
  local image = glint.scene { background = compass,
    camera = glint.camera { eye = { 3, 2, 1 }, direction = forward, fov = 70 } }
    :render { width = width, height = height, output = "none", passes = "beauty,background,alpha,depth" }
  for y = 0, height - 1, 7 do
    for x = 0, width - 1, 7 do
      local a, b = (2 * x + 1 - width) / height * half, (height - 2 * y - 1) / height * half
      local d = glint.unit { forward[1] + a * right[1] + b * up[1], forward[2] + a * right[2] + b * up[2], -1 }
      expect({ image:pixel(x, y) }, { d.x, d.y, d.z }, ROUNDING, ("pixel %d, %d"):format(x, y))
      check(image:pixel(x, y, "background") == image:pixel(x, y) and image:pixel(x, y, "alpha") == 0 and image:pixel(x, y, "depth") == math.huge)
    end
  end
end

function tests.s_is_that_of_a_direction()
  local d = glint.unit { 0.3, 0.5, -0.8 }
  local function shown(f) return { look({ d.x, d.y, d.z }, glint.pattern(f)) } end
  expect(shown(function(_, s) return s.world * 0.5 + 0.5 end), { d.x, d.y, d.z }, ROUNDING, "world")
  expect(shown(function(_, s) return s.v * 0.5 + 0.5 end), { -d.x, -d.y, -d.z }, ROUNDING, "v")
  expect(shown(function(_, s) return s.n * 0.5 + 0.5 end), { -d.x, -d.y, -d.z }, ROUNDING, "n")
  check(shown(function(_, s) return s.footprint + s.uv_footprint end)[1] == 0, "parallel rays have no angle between them")
  local u, v = 0.5 + math.atan(d.x, -d.z) / (2 * math.pi), math.acos(-d.y) / math.pi
  local uv = shown(function(_, s) return { s.uv.u, s.uv.v, 0 } end)
  near(uv[1], u, 1e-7, "u") near(uv[2], v, 1e-7, "v")
  local image = glint.scene { camera = glint.camera { eye = { 0, 0, 0 }, direction = { 0, 0, -1 }, fov = 60 },
    background = glint.pattern(function(_, s) return { 100 * s.footprint, 100 * s.uv_footprint, 0 } end) }
    :render { width = 20, height = 10, output = "none" }
  local r, g = image:pixel(10, 5)
  near(r, 100 * 2 * math.tan(math.rad(30)) / 10, 1e-5, "the angle of a pixel")
  near(g, r / (2 * math.pi), 1e-5, "as part of a turn")
end

-- Parallel rays along -z towards a mirror ball: at x, y on the unit ball the normal is (x, y, z), and the reflected
-- ray is (2 z x, 2 z y, 2 z^2 - 1).
function tests.a_ball_mirrors_it()
  local size = 16
  local image = glint.scene { background = compass,
    camera = glint.camera { projection = "orthographic", eye = { 0, 0, 9 }, direction = { 0, 0, -1 }, height = 2 },
    glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { diffuse = 0, mirror = 0.75 } } }
    :render { width = size, height = size, output = "none", passes = "beauty,mirror,background" }
  local hit = 0
  for j = 0, size - 1 do
    for i = 0, size - 1 do
      local x, y = (2 * i + 1) / size - 1, 1 - (2 * j + 1) / size
      local z2 = 1 - x * x - y * y
      if z2 > 0 then
        local z, got = math.sqrt(z2), { image:pixel(i, j, "mirror") }
        for c = 1, 3 do got[c] = got[c] / 0.75 end
        expect(got, { 2 * z * x, 2 * z * y, 2 * z2 - 1 }, 4 * ROUNDING, ("mirror %d, %d"):format(i, j))
        hit = hit + 1
      end
    end
  end
  check(hit > 100)
  local sky = picture_of(W, H, code_at)
  local flat = glint.plane { point = { 0, 0, -5 }, normal = { 0, 0, 1 }, material = glint.material { diffuse = 0, mirror = 1 } }
  near(look({ 0, 0, -1 }, sky, { flat }), look({ 0, 0, 1 }, sky), ROUNDING, "a picture in a flat mirror")
end

function tests.it_is_seen_through_glass()
  local function pane(ior)
    return glint.sphere { center = { 0, 0, -4 }, radius = 1, material = glint.material { diffuse = 0, transmission = 1, ior = ior } }
  end
  for _, d in ipairs { { 0, 0, -1 }, { 0.12, 0.05, -1 } } do
    local u = glint.unit(d)
    expect({ look({ u.x, u.y, u.z }, compass, { pane(1) }) }, { u.x, u.y, u.z }, 4 * ROUNDING, "of index 1")
  end
  -- At an offset b the ray hits a ball of index n at sin a = b, and turns twice by a - asin(b / n), towards the axis.
  local b, n = 0.5, 1.5
  local turn = 2 * (math.asin(b) - math.asin(b / n))
  local image = glint.scene { background = compass,
    camera = glint.camera { projection = "orthographic", eye = { 0, b, 4 }, direction = { 0, 0, -1 }, height = 1e-6 },
    glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { diffuse = 0, transmission = 1, ior = n } } }
    :render { width = 1, height = 1, output = "none" }
  expect({ image:pixel(0, 0) }, { 0, -math.sin(turn), -math.cos(turn) }, 8 * ROUNDING, "of index 1.5")
end

-- Makes a pattern of a uniform colour that the tracer cannot recognise as constant.
local function even(color)
  return glint.pattern(function(d) return glint.vector(color) + 0 * d.x end)
end

function tests.an_even_one_is_a_plain_background()
  local color = { 0.25, 0.5, 0.75 }
  local function render(background, more)
    local options = { width = 50, height = 40, output = "none", samples = 2, passes = "beauty,background,indirect,mirror,transmission,ambient,diffuse" }
    for key, value in pairs(more or {}) do options[key] = value end
    return glint.scene { background = background, indirect = { samples = 8, bounces = 3 }, ambient = 0.3,
      camera = glint.camera { eye = { 0, 1.5, 6 }, at = { 0, 0.5, 0 }, fov = 50 },
      glint.sphere_light { position = { 2, 3, 2 }, radius = 0.3, samples = 4, visible = true },
      glint.plane { point = { 0, -0.5, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = { 0.8, 0.6, 0.4 } } },
      glint.sphere { center = { -1.2, 0.5, 0 }, radius = 1, material = glint.material { diffuse = 0.2, mirror = 0.6 } },
      glint.sphere { center = { 1.2, 0.5, 0 }, radius = 1, material = glint.material { diffuse = 0, transmission = 1, fresnel = true, absorption = 0.1 } },
      glint.sphere { center = { 0.2, 0, 1.6 }, radius = 0.5, material = glint.material { diffuse = 0.7 } } }:render(options)
  end
  for _, more in ipairs { {}, { precision = "float" }, { adaptive = 0.1, samples = 4 }, { alpha = true } } do
    local plain, program, worst = render(color, more), render(even(color), more), 0
    for _, pass in ipairs { "beauty", "background", "indirect", "mirror", "transmission", "diffuse" } do
      for y = 0, 39 do
        for x = 0, 49 do
          local a, b = { plain:pixel(x, y, pass) }, { program:pixel(x, y, pass) }
          for c = 1, 3 do worst = math.max(worst, math.abs(a[c] - b[c])) end
        end
      end
    end
    near(worst, 0, 4 * LOSS, "the greatest difference") -- indirect light drops more rays
  end
  -- Under a uniform sky of radiance L a floor shows kd L.
  local open = glint.scene { background = even(color), indirect = { samples = 4, bounces = 1 },
    camera = glint.camera { eye = { 0, 3, 0 }, direction = { 0, -1, 0 }, up = { 0, 0, -1 } },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.5 } } }:render { width = 4, height = 4, output = "none" }
  local r, g, b = open:pixel(1, 2)
  near(r, 0.125, ROUNDING, "red") near(g, 0.25, ROUNDING, "green") near(b, 0.375, ROUNDING, "blue")
end

-- The cosine-weighted mean of a sky that is L for d.y > h and 0 below: L (1 - h^2).
function tests.indirect_light_is_its_mean_by_the_cosine()
  for _, h in ipairs { 0.3, 0.6, 0.9 } do
    local scene = glint.scene { background = glint.pattern(function(d) return glint.less(h, d.y) end), indirect = { samples = 1024, bounces = 1 },
      camera = glint.camera { eye = { 0, 3, 0 }, direction = { 0, -1, 0 }, up = { 0, 0, -1 } },
      glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.5 } } }
    local image, sum = scene:render { width = 4, height = 4, output = "none" }, 0
    for y = 0, 3 do
      for x = 0, 3 do sum = sum + image:pixel(x, y) / 16 end
    end
    near(sum, 0.5 * (1 - h * h), 2e-3, ("light above %g"):format(h))
  end
end

function tests.numbers_alone_are_a_colour()
  local seven = glint.pattern(function() return 0.7 end)
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, background = seven, depth_cue = { far = 9 } }
  near(scene:render { width = 2, height = 2, output = "none" }:pixel(0, 0), 0.7, ROUNDING, "one number")
  check(rawequal(scene.background, seven), "the field is the pattern")
  scene.background = { 0.1, 0.2, 0.3 }
  near(select(2, scene:render { width = 2, height = 2, output = "none" }:pixel(0, 0)), 0.2, ROUNDING, "a colour again")
  check(scene.background.r == 0.1)
  near(look({ 0, 1, 0 }, glint.pattern(function(d) return -d.y end)), 0, 0, "below 0 is 0")
  near(look({ 0, 1, 0 }, glint.pattern(function(d) return glint.sqrt(-d.y) end)), 0, 0, "NaN is 0")
  near(look({ 0, 1, 0 }, glint.pattern(function() return -1 end)), 0, 0, "a negative number is 0, too")
  near(look({ 0, 1, 0 }, glint.pattern(function(d) return d.y / 0 end)), 2 ^ 100, 2 ^ 77, "at most 2^100")
  scene.depth_cue = nil
  local k = 0.25 -- a variable that changes between frames
  scene.background = glint.pattern(function(d) return k + 0 * d.x end)
  for _, want in ipairs { 0.25, 0.5, 0.75 } do
    k = want
    near(scene:render { width = 2, height = 2, output = "none" }:pixel(0, 0), want, ROUNDING, "traced anew")
  end
end

function tests.lamps_and_alpha()
  local lamp = glint.sphere_light { position = { 0, 0, -5 }, radius = 1, radiance = 0.2 / math.pi, visible = true, samples = 1 }
  near(look({ 0, 0, -1 }, compass, { lamp }), 0.2, ROUNDING, "a lamp stands before it")
  local d = glint.unit { 0, 0.5, -1 }
  near(select(2, look({ d.x, d.y, d.z }, compass, { lamp })), d.y * 0.5 + 0.5, ROUNDING, "beside the lamp")
  check(look({ 0, 0, -1 }, compass, {}, { alpha = true }) == 0, "not where the background is left out")
  local mirror = glint.plane { point = { 0, 0, -5 }, normal = { 0, 0, 1 }, material = glint.material { diffuse = 0, mirror = 1 } }
  expect({ look({ 0, 0, -1 }, compass, { mirror }, { alpha = true }) }, { 0, 0, 1 }, ROUNDING, "but in mirrors")
  local fades = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, background = compass, depth_cue = { color = 0, far = 9 } }
  expect({ fades:render { width = 1, height = 1, output = "none" }:pixel(0, 0) }, { 0, 0, -1 }, ROUNDING, "it does not fade")
end

function tests.errors_name_the_field()
  local function render(fields)
    fields.camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }
    return glint.scene(fields):render { width = 2, height = 2, output = "none" }
  end
  raises("depth_cue.color: a colour expected, because its default, the background, is a pattern", render, { background = compass, depth_cue = { far = 3 } })
  raises("scene.background: ", render, { background = glint.shader(function(s) return s.kd end) })
  raises("scene.background: ", render, { background = function() return 1 end })
  raises("scene.ambient: ", render, { ambient = compass })
  raises("l: a pattern has no light", render, { background = glint.pattern(function(_, s) return s.l end) })
  raises("no_such_sky.png: No such file", glint.texture, { file = "no_such_sky.png" })
  local name = os.tmpname() .. ".png"
  png.new(8, 4):save(name)
  local bytes = io.open(name, "rb"):read "a"
  for _, case in ipairs { { bytes:sub(1, 60), "ends too early" }, { "no picture", "does not begin as one" } } do
    local file <close> = assert(io.open(name, "wb"))
    file:write(case[1])
    file:flush()
    raises(case[2], glint.texture, { file = name })
  end
  os.remove(name)
end

-- ---- Identical pictures in every configuration ----------------------------------------------------------------------

local command = os.getenv "GLINT" or (os.getenv "BUILD" or "build") .. "/glint"
local script = os.tmpname()

function tests.one_picture_by_every_way()
  local sky = os.tmpname() .. ".png"
  local picture = png.new(16, 8)
  for y = 0, 7 do
    for x = 0, 15 do picture:set(x, y, { x / 15, y / 7, (x + y) % 2 }) end
  end
  picture:save(sky)
  local file = assert(io.open(script, "w"))
  file:write(([[
local glint = require "glint"
local sky = glint.texture { file = %q, wrap = "around" }
local turn, lamp = 0, glint.point_light { position = { 4, 4, 4 }, intensity = 0.4 }
local matt = glint.material { diffuse = { 0.7, 0.3, 0.2 }, specular = 0.4 }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 1, 0 }, fov = 45 }, ambient = 0.2,
  background = glint.pattern(function(d, s) return sky(s.uv.u + turn, s.uv.v, s.uv_footprint) * (0.5 + 0.25 * d.y) end),
  indirect = { samples = 2, bounces = 2 }, lamp,
  glint.sphere { center = { 0, 0, 0 }, radius = 1, material = matt },
  glint.sphere { center = { -2, 1, 0 }, radius = 1, material = glint.material { diffuse = 0.4, mirror = 0.3 } },
  glint.sphere { center = { 1.4, 0.7, 1.6 }, radius = 0.7, material = glint.material { diffuse = 0.1, transmission = 0.8, fresnel = true } },
}
return glint.animation { scene = scene, frames = 4, samples = 2, frame = function(_, n)
  turn = n == 4 and 0.3 or 0.1 -- a number of the background changes in the last frame, a lamp in the one before
  lamp.position = { 4, n >= 3 and 5 or 4, 4 }
end }
]]):format(sky))
  file:close()
  for frame = 3, 4 do dofile "tests/lua/everywhere.lua"(tally, script, frame, 4) end
  os.remove(sky)
end

-- Tests the plan and its report.
function tests.it_is_explained_and_counted()
  local function write(text)
    local file <close> = assert(io.open(script, "w"))
    file:write(text)
  end
  local function read(line)
    local pipe <close> = assert(io.popen(line .. " 2>&1"))
    return pipe:read "a"
  end
  local plain = [[local glint = require "glint"
    return glint.animation { frames = 1, width = 20, height = 10, output = "none", frame = function() end,
    scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } },
    background = %s, glint.sphere { center = { 0, 0, 0 }, radius = 1 } } }]]
  write(plain:format "0.5")
  local without = read(command .. " explain " .. script)
  check(without:find("background +scene.background") and not without:find "environment", "a plain one has no stage: %s", without)
  write(plain:format "glint.pattern(function(d) return 2 * d.y end)")
  local with = read(command .. " explain --programs " .. script)
  check(with:find "pattern: background +scene, 1 instruction, 1 row" and with:find "environment +%x+  the background pattern"
    and with:find "\nscene.background\n" and with:find "r0 = mul 2 p.y", "explain: %s", with)
  local events = read(command .. " explain --json " .. script)
  check(events:find('"effect":"pattern: background","caller":"scene, 1 instruction', 1, true), "explain --json: %s", events)
  local said = read(command .. " " .. script .. " --quiet")
  check(said:find "scene.background: the pattern is below 0 at %d+ directions, such as %(", "odd values are told of: %s", said)
  write(plain:format "glint.pattern(function(d) return 0.5 + 0.5 * d.y end)")
  check(read(command .. " " .. script .. " --quiet --warnings=error") == "", "and others are not")
end

tally.run(tests)
os.remove(script)
tally.finish()
