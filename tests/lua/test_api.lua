-- The Lua API: constructors, fields, exact error messages, vectors, colours, lifetimes; under several collector modes.
package.cpath = (os.getenv "BUILD" or "build") .. "/?.so;" .. package.cpath
local glint = require "glint"

local passed, failed, mode = 0, 0, "default"
local function check(ok, format, ...)
  if ok then
    passed = passed + 1
  else
    failed = failed + 1
    print(("not ok - %s (collector: %s, line %d)"):format(format:format(...), mode,
      debug.getinfo(2, "l").currentline))
  end
end

-- Checks that the function raises exactly this message, prefixed with this file and a line.
local function raises(expected, f, ...)
  local ok, message = pcall(f, ...)
  local where, text = tostring(message):match "^([^:]*api[_%w]*%.lua:%d+): (.*)$"
  check(not ok and where and text == expected, "expected error <%s>, got <%s>", expected, tostring(message))
end

local function is(got, x, y, z)
  return type(got) == "userdata" and got[1] == x and got[2] == y and got[3] == z
end

-- Copies a table without one key, or with another value for it.
local function with(t, key, value)
  local copy = {}
  for k, v in pairs(t) do copy[k] = v end
  copy[key] = value
  return copy
end

local SPHERE = { center = { 0, 0, 0 }, radius = 1 }
local LAMP = { position = { 0, 20, 0 } }
local CAMERA = { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }

local tests = {}

function tests.vectors()
  local v = glint.point_light { position = { 1, 2.5, -3 } }.position
  check(v.x == 1 and v.y == 2.5 and v.z == -3 and v.r == 1 and v.g == 2.5 and v.b == -3, "components")
  check(v[1] == 1 and v[2] == 2.5 and v[3] == -3 and v[0] == nil and v[4] == nil and #v == 3, "numbers")
  check(tostring(v) == "{1, 2.5, -3}", "tostring: %s", tostring(v))
  check(select("#", v:unpack()) == 3 and table.concat({ v:unpack() }, " ") == "1.0 2.5 -3.0", "unpack")
  local sum = 0
  for _, x in ipairs(v) do sum = sum + x end
  check(sum == 0.5, "ipairs")
  check(v == v * 1 and v ~= v * 2 and v ~= 1, "equality")
  check(is(v + v, 2, 5, -6) and is(v - { 1, 1, 1 }, 0, 1.5, -4) and is({ 1, 1, 1 } + v, 2, 3.5, -2), "sums")
  check(is(-v, -1, -2.5, 3) and is(v * 2, 2, 5, -6) and is(2 * v, 2, 5, -6) and is(v * v, 1, 6.25, 9), "products")
  check(is(v / 2, 0.5, 1.25, -1.5) and is(v / { 1, 2.5, 3 }, 1, 1, -1), "quotients")
  check(getmetatable(v) == false, "the metatable is out of reach")
  raises("vector.x: a vector cannot be changed; assign a new vector to the object's field: object.field = {x, y, z}",
    function() v.x = 1 end)
  raises("vector.1: a vector cannot be changed; assign a new vector to the object's field: object.field = {x, y, z}",
    function() v[1] = 1 end)
  raises("vector.w: no such field", function() return v.w end)
  raises("vector.unpak: no such field; did you mean 'unpack'?", function() return v.unpak end)
  raises("vector: name of a field expected, got true", function() return v[true] end)
  raises('a + b: number, symbol or vector expected, got string "1"', function() return v + "1" end)
  check(v + 1 == glint.vector(v.x + 1, v.y + 1, v.z + 1) and v == glint.vector(v:unpack()) and v ~= glint.vector(0, 0, 0))
  raises("vector.x: a vector cannot be changed; assign a new vector to the object's field: object.field = {x, y, z}",
    function() glint.vector(1, 2, 3).x = 4 end)
  raises("a * b: number, symbol or vector expected, got nil: is a variable or a field not set?", function() return v * nil end)
  raises("vector expected, got no value; a method takes a colon: object:unpack(...)", function() v.unpack() end)
end

function tests.vector_arguments()
  local lamp = glint.point_light(LAMP)
  for _, case in ipairs {
    { { 1, 2 }, "[3]: number expected, got nil" },
    { { 1, nil, 3 }, "[2]: number expected, got nil" },
    { { 1, 2, 3, 4 }, ": {x, y, z} expected, got a table with [4]" },
    { { x = 1, y = 2, z = 3 }, ": {x, y, z} expected, got a table with the key string", true },
    { { 1, 2, 3, x = 0 }, ': {x, y, z} expected, got a table with the key string "x"' },
    { { 1, "2", 3 }, '[2]: number expected, got string "2"' },
    { { 1, 2, 0 / 0 }, "[3]: finite number expected, got nan" },
    { { -1 / 0, 2, 0 }, "[1]: finite number expected, got -inf" },
    { {}, "[1]: number expected, got nil" },
    { 5, ": {x, y, z} expected, got 5" },
    { "red", ': {x, y, z} expected, got string "red"' },
    { false, ": {x, y, z} expected, got false" },
    { print, ": {x, y, z} expected, got function" },
    { lamp, ": {x, y, z} expected, got point_light" },
  } do
    local value, message, is_start = table.unpack(case)
    if is_start then
      local _, got = pcall(function() lamp.position = value end)
      check(got:find(message, 1, true), "got <%s>", got)
    else
      raises("point_light.position" .. message, function() lamp.position = value end)
    end
  end
  check(is(lamp.position, 0, 20, 0), "the lamp is as it was")
  lamp.position = { 1, 2, math.tointeger(3) }
  lamp.position = lamp.position + { 0, 0, 1 }
  check(is(lamp.position, 1, 2, 4), "vectors and integers are taken")
end

function tests.colors()
  local m = glint.material {}
  local function close(r, g, b)
    return math.abs(m.diffuse.r - r) < 1e-12 and math.abs(m.diffuse.g - g) < 1e-12 and math.abs(m.diffuse.b - b) < 1e-12
  end
  m.diffuse = 0.25
  check(is(m.diffuse, 0.25, 0.25, 0.25), "one number")
  m.diffuse = { 0.1, 0.2, 0.3 }
  check(is(m.diffuse, 0.1, 0.2, 0.3), "three numbers are linear")
  for _, name in ipairs { "#808080", "gray", "grey", "GREY", "#808080" } do
    m.diffuse = name
    check(close(0.21586050011389926, 0.21586050011389926, 0.21586050011389926), "%s: %s", name, m.diffuse)
  end
  m.diffuse = "#f0A"
  check(close(1, 0, 0.40197777983219577), "#f0A: %s", m.diffuse)
  m.diffuse = "rebeccapurple" -- rgb(102, 51, 153)
  check(close(0.13286832155381798, 0.033104766570885055, 0.31854677812509186), "rebeccapurple: %s", m.diffuse)
  for _, name in ipairs { "aliceblue", "white", "yellowgreen", "lightgoldenrodyellow", "black", "red", "Tomato" } do
    check(pcall(function() m.diffuse = name end), "colour %s", name)
  end
  local expected = 'material.diffuse: colour name, "#rgb" or "#rrggbb" expected, got string '
  m.diffuse = 0
  for _, name in ipairs { "", "#", "#12345", "#12345g", "#1234567", "no colour at all", "123" } do
    raises(expected .. '"' .. name .. '"', function() m.diffuse = name end)
  end
  raises(expected .. "\"bleu\"; did you mean 'blue'?", function() m.diffuse = "bleu" end)
  raises(expected .. '"red?"' .. "; did you mean 'red'?", function() m.diffuse = "red\0" end)
  raises("material.diffuse: {r, g, b}, a number or a colour name expected, got true", function() m.diffuse = true end)
  raises("material.diffuse: {r, g, b}, a number or a colour name expected, got nil", function() m.diffuse = nil end)
  raises("material.diffuse: finite number expected, got nan", function() m.diffuse = 0 / 0 end)
  raises("material.diffuse[2]: finite number expected, got inf", function() m.diffuse = { 0, 1 / 0, 0 } end)
  raises("material.specular: colour >= 0 expected, got {0, -1, 0}", function() m.specular = { 0, -1, 0 } end)
  raises("material.specular: colour >= 0 expected, got {-0.5, -0.5, -0.5}", function() m.specular = -0.5 end)
  check(is(m.diffuse, 0, 0, 0) and is(m.specular, 0, 0, 0), "the material is as it was")
end

function tests.material()
  local m = glint.material {}
  check(m.model == "phong" and is(m.diffuse, 0.8, 0.8, 0.8) and is(m.specular, 0, 0, 0) and m.shininess == 32
    and m.name == "", "defaults")
  check(is(m.ambient, 0.8, 0.8, 0.8), "ambient is diffuse")
  m.diffuse = 0.5
  check(is(m.ambient, 0.5, 0.5, 0.5), "ambient follows diffuse")
  m.ambient = 0.1
  m.diffuse = 0.6
  check(is(m.ambient, 0.1, 0.1, 0.1), "until it is set")
  m.ambient = nil
  check(is(m.ambient, 0.6, 0.6, 0.6), "and follows again")
  for _, model in ipairs { "blinn_phong", "lambert", "phong" } do
    m.model = model
    check(m.model == model, "model %s", model)
  end
  m.shininess, m.name = 64, "brass"
  check(m.shininess == 64 and m.name == "brass" and tostring(m) == "material 'brass'", "shininess, name")
  m.name = ""
  check(tostring(m):find "^material: 0x%x+$", "tostring: %s", tostring(m))
  raises("material.shininess: number >= 0 expected, got -1", function() m.shininess = -1 end)
  raises('material.shininess: number expected, got string "64"', function() m.shininess = "64" end)
  raises("material.shininess: finite number expected, got nan", function() m.shininess = 0 / 0 end)
  raises("material.shininess: finite number expected, got inf", function() m.shininess = math.huge end)
  raises("material.shininess: number expected, got nil", function() m.shininess = nil end)
  raises('material.model: "phong", "blinn_phong", "lambert" or "cook_torrance" expected, got string "fong"',
    function() m.model = "fong" end)
  raises('material.model: "phong", "blinn_phong", "lambert" or "cook_torrance" expected, got 1', function() m.model = 1 end)
  raises("material.name: string expected, got 5", function() m.name = 5 end)
  raises("material.name: at most 63 bytes expected, got 64", function() m.name = ("x"):rep(64) end)
  raises("material.name: string without a zero byte expected", function() m.name = "a\0b" end)
  raises("material.shinyness: no such field; did you mean 'shininess'?", function() m.shinyness = 1 end)
  raises("material.Diffuse: no such field; did you mean 'diffuse'?", function() return m.Diffuse end)
  raises("material.spec: no such field; did you mean 'specular'?", function() return m.spec end)
  raises("material.mirrors: no such field; did you mean 'mirror'?", function() m.mirrors = 1 end)
  raises("material.x: no such field", function() m.x = 1 end)
  raises("material: name of a field expected, got 1", function() m[1] = 1 end)
  raises("material.evaluate: a method cannot be assigned", function() m.evaluate = print end)
  raises("material.close: a method cannot be assigned", function() m.close = print end)
  raises("material.color: no such field; did you mean 'diffuse'?", function() return m.color end)
  raises("material.kd: no such field; did you mean 'diffuse'?", function() glint.material { kd = 1 } end)
  raises("material.xyzzy: no such field", function() return m.xyzzy end)
  raises("sphere.position: no such field; did you mean 'center'?", function() glint.sphere { position = { 0, 0, 0 }, radius = 1 } end)
  raises("sphere.color: no such field; did you mean 'material'?", function()
    glint.sphere { center = { 0, 0, 0 }, radius = 1, color = "red" }
  end)
  raises("camera.look_at: no such field; did you mean 'at'?", function() glint.camera { eye = { 0, 0, 1 }, look_at = { 0, 0, 0 } } end)
  raises("glint.checkers: no such field; did you mean 'checker'?", function() return glint.checkers end)
  raises("glint.pointlight: no such field; did you mean 'point_light'?", function() glint.pointlight {} end)
  raises("glint.cube: no such field; did you mean 'box'?", function() glint.cube {} end)
  raises("glint.xyzzy: no such field", function() return glint.xyzzy end)
  raises("glint: name of a field expected, got 1", function() return glint[1] end)
  raises("glint.particles: this is a separate module; write local particles = require \"glint.particles\"", function()
    package.path = "scripts/lib/?.lua;" .. package.path
    return glint.particles
  end)
  raises("material.evaluat: no such field; did you mean 'evaluate'?", function() m:evaluat {} end)
  check(m.shininess == 64 and m.model == "phong", "the material is as it was")
  raises("material: table expected, got nil", function() glint.material() end)
  raises("material: table expected, got 5", function() glint.material(5) end)
  raises("material: a name for each value expected, material { model = ... }, got a value without a name", function() glint.material { 0.5 } end)
  raises("material.shinines: no such field; did you mean 'shininess'?", function() glint.material { shinines = 1 } end)
end

function tests.evaluate()
  local m = glint.material { diffuse = { 1, 0.5, 0 }, specular = 0.5, shininess = 10 }
  local at = { normal = { 0, 0, 2 }, to_light = { 0, 0, 3 }, to_eye = { 0, 0, 1 } }
  local reflection = m:evaluate(at)
  check(is(reflection.diffuse, 1, 0.5, 0) and is(reflection.specular, 0.5, 0.5, 0.5), "head on")
  check(next(reflection, next(reflection, next(reflection))) == nil, "two fields")
  raises("evaluate: table expected, got nil", function() m:evaluate(nil) end)
  raises("evaluate.normal: {x, y, z} expected, got nil", function() m:evaluate {} end)
  check(m:evaluate({ n = at.normal, to_light = at.to_light, v = at.to_eye }).specular == reflection.specular, "short names and long ones")
  raises("evaluate: n and normal are the same direction; give only one of them", function() m:evaluate { n = at.normal, normal = at.normal } end)
  raises("evaluate.to_light: vector that is not zero expected, got {0, 0, 0}",
    function() m:evaluate(with(at, "to_light", { 0, 0, 0 })) end)
  raises("evaluate.to_eye[1]: finite number expected, got nan",
    function() m:evaluate(with(at, "to_eye", { 0 / 0, 0, 0 })) end)
  raises("evaluate.eye: no such field", function() m:evaluate(with(at, "eye", { 0, 0, 1 })) end)
  raises("material expected, got nil; a method takes a colon: object:evaluate(...)", function() m.evaluate(nil, at) end)
  raises("material expected, got sphere; a method takes a colon: object:evaluate(...)", function() m.evaluate(glint.sphere(SPHERE), at) end)
end

function tests.lights()
  local lamp = glint.point_light(LAMP)
  check(is(lamp.color, 1, 1, 1) and lamp.intensity == 1 and is(lamp.ambient, 0, 0, 0) and is(lamp.diffuse, 1, 1, 1)
    and is(lamp.specular, 1, 1, 1) and is(lamp.attenuation, 1, 0, 0) and lamp.shadows == true
    and lamp.visible == false and lamp.name == "" and is(lamp.position, 0, 20, 0), "defaults")
  check(lamp.x == 0 and lamp.y == 20 and lamp.z == 0, "components of the place")
  lamp.x, lamp.z = 3, -4
  check(is(lamp.position, 3, 20, -4), "x and z set")
  lamp.color = 0.5
  check(is(lamp.diffuse, 0.5, 0.5, 0.5) and is(lamp.specular, 0.5, 0.5, 0.5), "diffuse and specular follow color")
  lamp.specular, lamp.diffuse = "white", 0.25
  lamp.color = 0.75
  check(is(lamp.specular, 1, 1, 1) and is(lamp.diffuse, 0.25, 0.25, 0.25), "until they are set")
  lamp.specular = nil
  check(is(lamp.specular, 0.75, 0.75, 0.75), "and follow again")
  lamp.intensity, lamp.ambient, lamp.attenuation = 2, 0.1, { 1, 0.5, 0.25 }
  lamp.shadows, lamp.visible, lamp.name = false, true, "key"
  check(lamp.intensity == 2 and is(lamp.ambient, 0.1, 0.1, 0.1) and is(lamp.attenuation, 1, 0.5, 0.25)
    and not lamp.shadows and lamp.visible and tostring(lamp) == "point_light 'key'", "each is set")
  raises("point_light.position: {x, y, z} expected, got nil", function() glint.point_light {} end)
  raises("point_light.intensity: number >= 0 expected, got -2", function() lamp.intensity = -2 end)
  raises("point_light.x: finite number expected, got nan", function() lamp.x = 0 / 0 end)
  raises('point_light.y: number expected, got string "3"', function() lamp.y = "3" end)
  raises("point_light.shadows: boolean expected, got 1", function() lamp.shadows = 1 end)
  raises("point_light.shadows: boolean expected, got nil", function() lamp.shadows = nil end)
  raises("point_light.attenuation: one number > 0 expected, got {0, 0, 0}", function() lamp.attenuation = { 0, 0, 0 } end)
  raises("point_light.posision: no such field; did you mean 'position'?",
    function() glint.point_light { posision = { 0, 0, 0 } } end)
  raises("point_light.direction: no such field", function() lamp.direction = { 0, 0, 1 } end)
  local sun = glint.directional_light { direction = { 0, -1, 0 }, color = "orange", name = "sun" }
  check(is(sun.direction, 0, -1, 0) and tostring(sun) == "directional_light 'sun'", "sun")
  raises("directional_light.direction: vector that is not zero expected, got {0, 0, 0}",
    function() sun.direction = { 0, 0, 0 } end)
  raises("directional_light.direction: {x, y, z} expected, got nil", function() glint.directional_light {} end)
  raises("directional_light.x: no such field", function() return sun.x end)
  raises("directional_light.position: no such field", function() return sun.position end)
end

function tests.spot_lights()
  local spot = glint.spot_light { position = { 1, 2, 3 }, direction = { 0, -2, 0 }, inner = 20, outer = 30 }
  check(spot.inner == 20 and spot.outer == 30 and spot.exponent == 0 and is(spot.direction, 0, -2, 0) and spot.y == 2,
    "spot")
  spot.outer = 90
  spot.inner, spot.exponent, spot.x = 45, 2.5, 7
  check(spot.inner == 45 and spot.outer == 90 and spot.exponent == 2.5 and is(spot.position, 7, 2, 3), "each is set")
  raises("spot_light.inner: half angles 0 <= inner <= outer <= 180 expected, got inner 91 and outer 90",
    function() spot.inner = 91 end)
  raises("spot_light.outer: half angles 0 <= inner <= outer <= 180 expected, got inner 45 and outer 181",
    function() spot.outer = 181 end)
  raises("spot_light.inner: half angles 0 <= inner <= outer <= 180 expected, got inner -1 and outer 90",
    function() spot.inner = -1 end)
  raises("spot_light.exponent: number >= 0 expected, got -1", function() spot.exponent = -1 end)
  raises("spot_light.direction: vector that is not zero expected, got {0, 0, 0}",
    function() spot.direction = { 0, 0, 0 } end)
  raises("spot_light.outer: number expected, got nil",
    function() glint.spot_light { position = { 0, 0, 0 }, direction = { 0, -1, 0 }, inner = 5 } end)
  raises("spot_light.radius: no such field", function() spot.radius = 1 end)
end

function tests.area_lights()
  local disk = glint.disk_light { position = { 0, 4, 0 }, normal = { 0, -2, 0 }, radius = 2 }
  check(disk.samples == 16 and disk.radiance == nil and is(disk.normal, 0, -2, 0) and disk.radius == 2, "disk")
  disk.radiance, disk.samples = 5, 64
  check(disk.radiance == 5 and disk.samples == 64 and disk.intensity == 1, "radiance")
  raises("disk_light.intensity: with a radiance, expected 1, got 2", function() disk.intensity = 2 end)
  disk.radiance = nil
  disk.intensity = 2
  check(disk.radiance == nil and disk.intensity == 2, "back to intensity")
  raises("disk_light.samples: whole number 1 .. 65536 expected, got 0", function() disk.samples = 0 end)
  raises("disk_light.samples: whole number 1 .. 65536 expected, got 1000000000", function() disk.samples = 1e9 end)
  raises("disk_light.samples: whole number 1 .. 65536 expected, got 2.5", function() disk.samples = 2.5 end)
  for text, huge in pairs { ["1e+300"] = 1e300, ["-1e+300"] = -1e300, ["9.2233720368548e+18"] = 2 ^ 63, ["4294967297"] = 2 ^ 32 + 1,
    ["9223372036854775807"] = math.maxinteger, ["-9223372036854775808"] = math.mininteger } do
    raises("disk_light.samples: whole number 1 .. 65536 expected, got " .. text, function() disk.samples = huge end)
  end
  disk.samples = 16.0
  check(disk.samples == 16, "whole numbers of both types")
  raises("disk_light.radius: number >= 0 expected, got -1", function() disk.radius = -1 end)
  raises("disk_light.normal: vector that is not zero expected, got {0, 0, 0}", function() disk.normal = { 0, 0, 0 } end)
  disk.visible = true
  check(disk.visible, "visible")
  local ball = glint.sphere_light { position = { 0, 4, 0 }, radius = 0, name = "bulb" }
  check(ball.radius == 0 and tostring(ball) == "sphere_light 'bulb'", "sphere of radius 0")
  raises("sphere_light.radius: number expected, got nil", function() glint.sphere_light { position = { 0, 0, 0 } } end)
  raises("sphere_light.normal: no such field", function() ball.normal = { 0, 1, 0 } end)
  raises("point_light.samples: no such field", function() return glint.point_light(LAMP).samples end)
end

function tests.polygon_lights()
  local function polygon(...) return glint.polygon_light { vertices = { ... } } end
  local light = polygon({ 0, 4, 0 }, { 1, 4, 0 }, { 1, 4, 1 })
  check(#light.vertices == 3 and is(light.vertices[2], 1, 4, 0) and light.two_sided == false, "triangle")
  light.vertices = { { 0, 4, 0 }, { 1, 4, 0 }, { 1, 4, 1 }, { 0, 4, 1 } }
  light.vertices = light.vertices
  light.two_sided = true
  collectgarbage()
  check(#light.vertices == 4 and is(light.vertices[4], 0, 4, 1) and light.two_sided, "square")
  raises("polygon_light.vertices: 3 to 4096 corners expected, got 2",
    function() polygon({ 0, 0, 0 }, { 1, 0, 0 }) end)
  raises("polygon_light.vertices: corners in one plane expected, got corner 2 -0.0499 out of it",
    function() polygon({ 0, 0, 0 }, { 1, 0, 0 }, { 1, 0, 1 }, { 0, 0.1, 1 }) end)
  raises("polygon_light.vertices: convex polygon expected, got corner 4 outside of the edge from corner 2",
    function() polygon({ 0, 0, 0 }, { 4, 0, 0 }, { 1, 0, 1 }, { 0, 0, 4 }) end)
  raises("polygon_light.vertices: convex polygon expected, got corner 4 outside of the edge from corner 1", function()
    local star = {} -- a star with five corners
    for i = 0, 4 do star[i + 1] = { math.cos(i * 4 * math.pi / 5), math.sin(i * 4 * math.pi / 5), 0 } end
    glint.polygon_light { vertices = star }
  end)
  raises("polygon_light.vertices: corners that differ expected, got corner 1 again as corner 5", function()
    local square = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }
    for i = 1, 4 do square[4 + i] = square[i] end
    glint.polygon_light { vertices = square }
  end)
  raises("polygon_light.vertices: polygon with an area expected, got area 0",
    function() polygon({ 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 }) end)
  raises("polygon_light.vertices[2]: {x, y, z} expected, got 5", function() polygon({ 0, 0, 0 }, 5, { 1, 0, 0 }) end)
  raises("polygon_light.vertices: list of {x, y, z} expected, got nil", function() glint.polygon_light {} end)
  raises('polygon_light.vertices: a list expected, got a table with the key string "x"', function() light.vertices = { x = 1 } end)
  raises("polygon_light.position: no such field", function() return light.position end)
  check(#light.vertices == 4, "unchanged by what was refused")
end

function tests.camera()
  local c = glint.camera(CAMERA)
  check(is(c.eye, 0, 0, 5) and is(c.at, 0, 0, 0) and c.direction == nil and is(c.up, 0, 1, 0) and c.fov == 40
    and c.projection == "perspective" and c.height == 10 and c.pixel_offset == 0.5 and c.name == "", "defaults")
  c.direction = { 0, 0, -1 }
  check(is(c.direction, 0, 0, -1) and c.at == nil, "direction replaces at")
  c.at = { 1, 0, 0 }
  check(is(c.at, 1, 0, 0) and c.direction == nil, "at replaces direction")
  c.direction = nil
  raises("camera.at: {x, y, z} expected, got nil", function() c.at = nil end)
  check(is(c.at, 1, 0, 0), "at stays")
  for _, fov in ipairs { 0.1, 1, 33.3, 45, 60, 90, 110.25, 179.9 } do
    c.fov = fov
    check(c.fov == fov, "fov %g reads %.17g", fov, c.fov)
  end
  c.projection, c.height, c.pixel_offset, c.up, c.name = "orthographic", 4, 0, { 0, 0, 1 }, "plan"
  check(c.projection == "orthographic" and c.height == 4 and c.pixel_offset == 0 and is(c.up, 0, 0, 1)
    and tostring(c) == "camera 'plan'", "each is set")
  check(is(glint.camera { eye = { 0, 0, 0 }, direction = { 1, 0, 0 } }.direction, 1, 0, 0), "by direction")
  raises("camera: at or direction expected, got both", function() glint.camera(with(CAMERA, "direction", { 1, 0, 0 })) end)
  raises("camera: at or direction expected, got neither", function() glint.camera { eye = { 0, 0, 0 } } end)
  raises("camera.eye: {x, y, z} expected, got nil", function() glint.camera { at = { 0, 0, 0 } } end)
  raises("camera.at: a point other than the eye expected, got {0, 0, 5}",
    function() glint.camera(with(CAMERA, "at", { 0, 0, 5 })) end)
  for _, fov in ipairs { 0, 180, -1, 200 } do
    raises("camera.fov: angle between 0 and 180 degrees expected, got " .. fov, function() c.fov = fov end)
  end
  raises("camera.fov: finite number expected, got nan", function() c.fov = 0 / 0 end)
  raises("camera.up: vector that is not zero expected, got {0, 0, 0}", function() c.up = { 0, 0, 0 } end)
  raises("camera.height: number > 0 expected, got 0", function() c.height = 0 end)
  raises("camera.pixel_offset: number 0 .. 1 expected, got 1.5", function() c.pixel_offset = 1.5 end)
  raises("camera.shutter: number 0 .. 1 expected, got -0.1", function() c.shutter = -0.1 end)
  raises("camera.shutter: number 0 .. 1 expected, got 2", function() c.shutter = 2 end)
  for _, times in ipairs { 0, 2.5, 1025 } do
    raises("camera.shutter_times: whole number 1 .. 1024 expected, got " .. times, function() c.shutter_times = times end)
  end
  raises('camera.projection: "perspective" or "orthographic" expected, got string "fisheye"',
    function() c.projection = "fisheye" end)
  raises("camera.wobble: no such field", function() return c.wobble end)
end

-- ---- Running them ----

local more = assert(loadfile((arg[0]:gsub("[^/]*$", "") .. "api_objects.lua")))
more(glint, { check = check, raises = raises, is = is, with = with, SPHERE = SPHERE, LAMP = LAMP, CAMERA = CAMERA },
  tests)

function tests.animation_without_a_frame_function()
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } } }
  local still = glint.animation { scene = scene, width = 8, height = 6, output = "none" }
  check(still.frames == 1 and still.frame == nil, "one frame, no function")
  local ok, message = pcall(glint.animation, { scene = scene, frame = 3 })
  check(not ok and message:find("animation.frame: function expected, got 3", 1, true), "%s", tostring(message))
end

local names = {}
for name in pairs(tests) do names[#names + 1] = name end
table.sort(names)
local modes = {
  { "default", function() collectgarbage("incremental", 200, 100, 13) end },
  { "incremental, hostile", function() collectgarbage("incremental", 1, 1000, 1) end },
  { "generational", function() collectgarbage("generational", 1, 1) end },
}
for _, entry in ipairs(modes) do
  mode = entry[1]
  entry[2]()
  for _, name in ipairs(names) do
    local ok, message = xpcall(tests[name], debug.traceback)
    check(ok, "%s stopped: %s", name, tostring(message))
    collectgarbage()
  end
end
print(("%d passed, %d failed"):format(passed, failed))
os.exit(failed == 0, true)
