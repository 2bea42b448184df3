-- Typical mistakes: each message names its fix.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local tests = {}

-- Runs the code with the module's names. The message must contain `want` literally.
local function wrong(want, code)
  local env = setmetatable({
    glint = glint,
    ball = glint.sphere { center = { 0, 0, 0 }, radius = 1 },
    lamp = glint.point_light { position = { 0, 5, 0 } },
    scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } } },
  }, { __index = _G })
  env.image = env.scene:render { width = 2, height = 2 }
  local good, message = pcall(assert(load(code, "=code", "t", env)))
  check(not good and tostring(message):find(want, 1, true), "%s: %s", code, message)
  check(good or tostring(message):find("^code:1: "), "a place: %s", message)
end

function tests.functions_stand_for_patterns()
  local write = "; write glint.pattern(function(p, s) ... end)"
  wrong("material.diffuse: a value or a pattern expected, got function" .. write, "glint.material { diffuse = function(p) return 1 end }")
  wrong("material.shininess: a value or a pattern expected, got function" .. write, "glint.material { shininess = function(p) return 1 end }")
  wrong("scene.background: a value or a pattern expected, got function" .. write, "scene.background = function(p) return 1 end")
  wrong("material.bump: a value or a pattern expected, got function" .. write, "glint.material { bump = function(p) return 1 end }")
  wrong("material.model: a name or a shader expected, got function; write glint.shader(function(s) ... end)",
    "glint.material { model = function(s) return 1 end }")
  wrong("material.model: a name or a shader expected, got pattern; write glint.shader(",
    "glint.material { model = glint.pattern(function(p) return p.x end) }")
  wrong("material.diffuse: a value or a pattern expected, got shader; a shader is a material's model",
    "glint.material { diffuse = glint.shader(function(s) return 1 end) }")
end

function tests.tables_stand_for_objects()
  wrong("sphere.material: material expected, got table; write glint.material { ... }",
    "glint.sphere { center = { 0, 0, 0 }, radius = 1, material = { diffuse = 1 } }")
  wrong("sphere.material: material expected, got table; write glint.material { ... }", "ball.material = { diffuse = 1 }")
  wrong('sphere.material: material expected, got string "red"; write glint.material { diffuse = "red" }',
    "glint.sphere { center = { 0, 0, 0 }, radius = 1, material = 'red' }")
  wrong("scene.camera: camera expected, got table; write glint.camera { ... }", "glint.scene { camera = { eye = { 0, 0, 9 } } }")
  wrong("got table; write glint.sphere { ... }, glint.point_light { ... } or another", "glint.scene { { center = { 0, 0, 0 } } }")
  wrong("sphere: a name for each value expected, sphere { center = ... }", "glint.sphere({ 0, 0, 0 }, 1)")
  wrong("point_light: a name for each value expected, point_light { position = ... }", "glint.point_light { { 0, 1, 0 } }")
end

function tests.objects_of_a_scene_have_no_names()
  local cure = ": shapes and lights are listed in a scene without a name: glint.scene { camera = ..., lamp, ball }"
  wrong("scene.lights" .. cure, "glint.scene { lights = { lamp } }")
  wrong("scene.lights" .. cure, "glint.scene { lights = { position = { 0, 5, 0 } } }")
  wrong("scene.objects" .. cure, "glint.scene { objects = { ball } }")
  wrong("scene.ball" .. cure, "glint.scene { ball = ball }")
  wrong("scene[2]: shape, light or overlay expected, got a list; put its objects into the scene directly",
    "glint.scene { lamp, { ball } }")
end

function tests.dots_and_colons()
  wrong("scene expected, got sphere; a method takes a colon: object:add(...)", "scene.add(ball)")
  wrong("scene expected, got table; a method takes a colon: object:render(...)", "scene.render { width = 2, height = 2 }")
  wrong("image expected, got string \"x.png\"; a method takes a colon: object:save(...)", "image.save 'x.png'")
  wrong("vector expected, got no value; a method takes a colon: object:unpack(...)", "ball.center.unpack()")
  wrong("sphere: write glint.sphere { ... } with a dot, not with a colon", "glint:sphere { center = { 0, 0, 0 }, radius = 1 }")
  wrong("write glint.pattern with a dot, not with a colon", "glint:pattern(function(p) return p.x end)")
  wrong("sin: write glint.sin with a dot, not with a colon", "glint:sin(1)")
end

-- The reported position is in the pattern's function, not at the call that renders.
function tests.patterns_of_one_number_have_a_place()
  local code = "local three = glint.pattern(function(p) return { p.x, 1, 1 } end)\n"
    .. "scene:add(glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { shininess = three, specular = 1 } })\n"
    .. "scene:render { width = 2, height = 2 }"
  wrong("code:1: material.shininess: a pattern of one number expected, got one of 3", code)
end

function tests.vectors_are_one_type()
  local camera = glint.camera { eye = { 0, 0, 4 }, at = { 0, 0, 0 } }
  check(camera.eye == glint.vector(0, 0, 4) and glint.vector(0, 0, 4) == camera.eye and camera.eye ~= glint.vector(0, 0, 5))
  check(camera.eye + 1 == glint.vector(1, 1, 5) and camera.eye % 3 == glint.vector(0, 0, 1) and camera.eye.v == 0)
  check(tostring(camera.eye) == tostring(glint.vector(0, 0, 4)))
end

-- Axes of a sweep that are no objects, and words of other programs.
function tests.objects_of_a_sweep()
  for got, value in pairs { ["a variable"] = "glint.variable('v', 1)", vector = "glint.vector(1, 2, 3)", ["7"] = "7", ["function"] = "print" } do
    wrong("sweep.over[1][1]: object expected, got " .. got, ("glint.sweep { scene = scene, over = { { %s, 'radius', { 1, 2 } } } }"):format(value))
  end
  wrong("falloff: no such field; did you mean 'attenuation'?", "lamp.falloff = 2")
  wrong("did you mean 'attenuation'?", "glint.point_light { position = { 0, 1, 0 }, falloff = 2 }")
end

-- Fields of a frame in a scene.
function tests.fields_of_a_frame()
  wrong("scene.max_depth: no such field; it belongs to scene:render and glint.animation, or to the command as --max-depth",
    "glint.scene { max_depth = 3 }")
  wrong("scene.samples: no such field; it belongs to scene:render and glint.animation", "scene.samples = 4")
end

tally.run(tests)
tally.finish()
