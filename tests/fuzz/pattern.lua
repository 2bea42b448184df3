-- Makes a function from the input, as a pattern and as a shader. The program must give the same bits as plain Lua.
-- When a material or a background accepts the program, a picture is rendered, or refused with a message.
local glint = require "glint"

local bytes, at = "", 1
local function next_byte()
  local b = bytes:byte(at) or 0
  at = at + 1
  return b
end
local function random(from, to)
  if not from then return next_byte() / 256 end
  if not to then from, to = 1, from end
  return from + next_byte() % (to - from + 1)
end

local functions = dofile "tests/lua/random_functions.lua"(random)
local FIELDS = { "diffuse", "ambient", "specular", "mirror", "transmission", "shininess", "roughness", "bump", "opacity" }

local function refused(message)
  assert(type(message) == "string", "an error that is no text")
  for _, own in ipairs { "attempt to", "stack overflow", "not enough memory", "out of memory" } do
    assert(not message:find(own, 1, true), message)
  end
end

-- A number outside the function that changes from frame to frame.
local outside = 0

local function material_of(f)
  local material = glint.material { model = functions.any { "phong", "cook_torrance" } }
  for _ = 1, random(2) do
    local ok, message = pcall(function()
      material[functions.any(FIELDS)] = glint.pattern(function(p, s) return f(p, s) + outside end)
    end)
    if not ok then refused(message) end
  end
  if random(3) == 1 then
    material.model = glint.shader(function(s) return s.kd * s.light * f(s.world, s), s.ks * s.n:dot(s.l) end)
  end
  return material
end

return function(input)
  bytes, at = input, 1
  local f, text = functions.make()
  for _ = 1, 2 do
    local got, wrong = functions.compare(f, text)
    assert(got, wrong)
  end
  local material = material_of(f)
  local scene = glint.scene {
    camera = glint.camera { eye = { 0, 1, 4 }, at = { 0, 0, 0 } }, ambient = 0.2,
    random(2) == 1 and glint.point_light { position = { 3, 5, 4 } } or
      glint.sphere_light { position = { 3, 5, 4 }, radius = 1, samples = 2 },
    glint.sphere { center = { 0, 0, 0 }, radius = 1, material = material },
    glint.box { min = { -2, -2, -2 }, max = { 2, -1, 2 }, material = material },
  }
  if random(4) == 1 then scene.background = glint.pattern(function(p, s) return f(p, s) end) end
  for frame = 1, random(2) do
    outside = frame / 8
    local ok, image, message = pcall(scene.render, scene, { width = 8, height = 6, samples = functions.any { 1, 4 }, max_depth = 2,
      precision = functions.any { "double", "float" } })
    if not ok then refused(image) else assert(image or message) end
  end
end
