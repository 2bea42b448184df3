-- Makes choices from the input: objects with fields of every kind and size, edits of the objects, and small pictures.
-- Each is valid, or refused with a message. An error of Lua itself from inside the module is a finding.
local glint = require "glint"

local bytes, at = "", 1
local function next_byte()
  local b = bytes:byte(at) or 0
  at = at + 1
  return b
end
local function any(list) return list[next_byte() % #list + 1] end

local NUMBERS = { 0, 1, -1, 2, 0.5, 3, 1e-3, 1e3, 1e-30, 1e30, 1e-310, 1e308, -1e308, 1 / 0, -1 / 0, 0 / 0, 2 ^ 31, 2 ^ 53, 16, -0.0 }
local TEXTS = { "", "red", "#123456", "phong", "blinn_phong", "cook_torrance", "lambert", "flat", "gouraud", "ggx", "f32", "hard", "a\0b" }
local function number()
  local kind = next_byte()
  if kind == 255 then return glint.variable("x", (next_byte() - 100) / 16) end
  return kind < 200 and (next_byte() - 100) / 16 or any(NUMBERS)
end
local function three() return { number(), number(), number() } end

local PROGRAMS = {
  glint.pattern(function(p) return glint.checker(p, 0.2) end), glint.pattern(function(p, s) return p * s.n + glint.noise(p) end),
  glint.pattern(function(_, s) return s.uv.u end), glint.pattern(function() return 0.25 end),
  glint.shader(function(s) return s.kd * s.light, s.ks end), glint.texture { file = "tests/fuzz/corpus/picture/rgb.png" },
}

local depth = 0
local value
local KINDS = {
  number, number, three, three,
  function() return { { number(), number(), number() }, three(), three() } end,
  function() return any { true, false } end,
  function() return any(TEXTS) end,
  function() return {} end,
  function()
    local t = {}
    for i = 1, next_byte() % 16 do t[i] = number() end
    return t
  end,
  function() return { { 1, 2, 3 }, { 1, 3, next_byte() % 6 } } end,
  function() return any(PROGRAMS) end,
}
function value()
  depth = depth + 1
  local v = any(KINDS)()
  depth = depth - 1
  return v
end

local FIELDS = {
  mesh = { "vertices", "faces", "normals", "shading", "material", "uv", "index" },
  spheres = { "data", "format", "material", "index" },
  sphere_mesh = { "center", "radius", "segments", "shading" },
  ambient_occlusion = { "distance" },
  label = { "text", "at", "at_point", "hidden", "position", "size", "margin", "color", "background", "opacity" },
  colorbar = { "map", "low", "high", "title", "ticks", "orientation", "length", "at", "size", "background" },
  axes = { "labels", "length", "at", "position", "size", "box", "values" },
  arrow = { "from", "to", "label", "width", "hidden", "size", "margin", "color", "background" },
  line = { "from", "to", "label", "width", "hidden", "opacity" },
  arc = { "at", "from", "to", "radius", "label", "width", "hidden" },
  chart = { "series", "x", "title", "x_label", "y_label", "x_scale", "y_scale", "x_range", "y_range", "extent", "at", "size" },
  polyline = { "points", "label", "width", "hidden" },
  lobe = { "point", "to_light", "normal", "scale", "label", "hidden" },
  path = { "origin", "direction", "depth", "reach", "hidden" },
}
-- The functions of the module that may raise a message. Lua's own messages for a programming error are not accepted.
local function refused(message)
  assert(type(message) == "string", "an error that is no text")
  for _, own in ipairs { "attempt to", "stack overflow", "not enough memory", "out of memory" } do
    assert(not message:find(own, 1, true), message)
  end
end

-- The first values of each list are valid, so that most edited objects stay valid.
local GOOD = {
  sphere = { center = { 0, 0, 0 }, radius = 1 }, plane = { point = { 0, -1, 0 }, normal = { 0, 1, 0 } },
  box = { min = { -1, -1, -1 }, max = { 1, 1, 1 } }, disk = { center = { 0, 0, 0 }, normal = { 0, 1, 0 }, radius = 1 },
  cylinder = { base = { 0, 0, 0 }, top = { 0, 1, 0 }, radius = 1 }, cone = { base = { 0, 0, 0 }, top = { 0, 1, 0 }, radius = 1 },
  torus = { center = { 0, 0, 0 }, major = 1, minor = 0.3 },
  mesh = { vertices = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1 }, faces = { { 1, 2, 3 }, { 2, 3, 4 } } },
  spheres = { data = { 0, 0, 0, 1, 2, 0, 0, 1 } }, sphere_mesh = { center = { 0, 0, 0 }, radius = 1, segments = 6 }, group = {},
  union = { glint.sphere { center = { 1, 0, 0 }, radius = 1 } }, intersection = { glint.sphere { center = { 0, 0, 0 }, radius = 2 } },
  difference = { glint.box { min = { -1, -1, -1 }, max = { 1, 1, 1 } }, glint.sphere { center = { 1, 1, 1 }, radius = 1 } },
  point_light = { position = { 0, 5, 0 } }, directional_light = { direction = { 0, -1, 0 } },
  spot_light = { position = { 0, 5, 0 }, direction = { 0, -1, 0 }, inner = 10, outer = 20 },
  disk_light = { position = { 0, 5, 0 }, normal = { 0, -1, 0 }, radius = 1 },
  polygon_light = { vertices = { { 0, 5, 0 }, { 1, 5, 0 }, { 0, 5, 1 } } }, sphere_light = { position = { 0, 5, 0 }, radius = 1 },
  material = {}, camera = { eye = { 0, 0, 9 }, at = { 0, 0, 0 } },
  ambient_occlusion = { samples = 2 }, label = { text = "a" }, colorbar = { map = "magma", low = 0, high = 1 }, axes = {},
  arrow = { from = { 0, 0, 0 }, to = { 2, 1, 0 }, label = "a" }, line = { from = { -2, 0, 0 }, to = { 2, 1, 0 } },
  arc = { at = { 0, 1, 0 }, from = { 1, 0, 0 }, to = { 0, 1, 0 } },
  chart = { series = { { y = { 1, 2 } } } },
  polyline = { points = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 } } }, path = { origin = { -5, 0, 0 }, direction = { 1, 0.1, 0 } },
  lobe = { point = { 0, 1, 0 }, material = glint.material { specular = 1 }, to_light = { 1, 1, 0 }, normal = { 0, 1, 0 } },
}

-- The fields of the other objects are in the engine's tables. "part" adds a shape to a combined solid.
local COMBINED = { union = true, intersection = true, difference = true }
local NAMES = {}
for name in pairs(GOOD) do
  NAMES[#NAMES + 1] = name
  if not FIELDS[name] then
    FIELDS[name] = { COMBINED[name] and "part" }
    for _, row in ipairs(glint._rows(name)) do table.insert(FIELDS[name], row.name) end
  end
end
table.sort(NAMES)

-- Shapes that can be parts of a CSG shape, and some that cannot.
local PARTS = { "sphere", "box", "torus", "cylinder", "cone", "plane", "disk", "mesh", "group", "union", "difference" }

local function field_value(field, made)
  if field == "material" and made.material then return made.material end
  if field == "transform" then
    local ok, t = pcall(function() return glint.translate(number(), number(), number()) * glint.scale(number(), number(), number()) end)
    return ok and t or glint.translate(0, 0, 0)
  end
  if field == "samples" then return 1 + next_byte() % 4 end
  if field == "segments" then return next_byte() % 40 end -- 16384 is valid but slow
  return value()
end

-- A metal, a rough mirror, rough glass, and none of these.
local LOOKS = { {}, { model = "cook_torrance", roughness = 0.3, diffuse = 0 }, { mirror = 0.5, roughness = 0.2 },
  { fresnel = true, transmission = 0.9, roughness = 0.4, distribution = "beckmann" } }

local function make(name, made)
  local fields = { samples = nil }
  for key, v in pairs(name == "material" and any(LOOKS) or {}) do fields[key] = v end
  for key, v in pairs(GOOD[name]) do fields[key] = v end
  for _ = 1, next_byte() % 4 do
    local field = any(FIELDS[name])
    if field == "part" then
      fields[#fields + 1] = made[any(PARTS)]
    else
      fields[field] = field_value(field, made)
    end
    if field == "index" then fields.materials = { made.material or glint.material {}, glint.material { mirror = 0.5 } } end
  end
  if name:find "disk_light" or name:find "polygon_light" or name:find "sphere_light" then fields.samples = 1 + next_byte() % 4 end
  local ok, object = pcall(glint[name], fields)
  if not ok then refused(object) end
  return ok and object or nil
end

local function change(object, name, made)
  local field = any(FIELDS[name])
  local ok, message = pcall(function() object[field] = field_value(field, made) end)
  if not ok then refused(message) end
end

local SCENE = {
  indirect = function() return { samples = 1 + next_byte() % 3, bounces = next_byte() % 3 } end,
  depth_cue = function() return { far = number(), near = number(), color = value() } end,
  ambient_occlusion = function() return { samples = 1 + next_byte() % 3, distance = number() } end,
  background = value, ambient = value,
  reflection_samples = function() return next_byte() % 4 end,
}
local SCENE_NAMES = { "indirect", "depth_cue", "ambient_occlusion", "background", "ambient", "reflection_samples" }

local function change_scene(scene)
  local field = any(SCENE_NAMES)
  local ok, message = pcall(function() scene[field] = SCENE[field]() end)
  if not ok then refused(message) end
end

local PASSES = { "beauty", "d:x", "depth,normal,object_id", "albedo,outline,refined", "alpha,indirect,mirror" }

local function render(scene)
  local ok, image, message = pcall(scene.render, scene, {
    width = 1 + next_byte() % 24, height = 1 + next_byte() % 24, samples = any { 1, 1, 2, 4 }, precision = any { "double", "float" },
    max_depth = next_byte() % 4, passes = any(PASSES), adaptive = any { false, 0, 0.1 } or nil, visibility = any { "auto", "scan" },
  })
  if not ok then refused(image) else assert(image or message) end
end

return function(input)
  bytes, at = input, 1
  local made, list = {}, {}
  local camera = make("camera", made) or glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }
  local scene = glint.scene { camera = camera, ambient = 0.1, reflection_samples = 2 }
  for _ = 1, 2 + next_byte() % 10 do
    local name = any(NAMES)
    local object = make(name, made)
    made[name] = object or made[name]
    if object then list[#list + 1] = { object, name } end
    if object and name ~= "material" and name ~= "camera" then
      local ok, message = pcall(scene.add, scene, object)
      if not ok then refused(message) end
    end
  end
  for _ = 1, next_byte() % 3 do change_scene(scene) end
  render(scene)
  for _ = 1, next_byte() % 4 do
    if #list > 0 then
      local pick = any(list)
      change(pick[1], pick[2], made)
    end
    render(scene)
  end
end
