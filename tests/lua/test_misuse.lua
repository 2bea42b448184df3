-- Every function, method and field of the API gets values of every kind. It gives a result or a message, never
-- crashes, and damages no object. The seed is fixed.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

math.randomseed(20240611)
local function any(list) return list[math.random(#list)] end

local KINDS = {
  "box", "camera", "cone", "cylinder", "difference", "directional_light", "disk", "disk_light", "group", "material", "mesh", "pattern", "plane", "point_light",
  "polygon_light", "scene", "shader",
  "sphere", "sphere_light", "spheres", "spot_light", "torus", "triple", "vector",
}

local function objects()
  local material = glint.material { name = "m" }
  local ball = glint.sphere { center = { 0, 0, 0 }, radius = 1, material = material }
  local lamp = glint.point_light { position = { 0, 5, 0 } }
  return {
    material = material, sphere = ball, point_light = lamp,
    directional_light = glint.directional_light { direction = { 0, -1, 0 } },
    spot_light = glint.spot_light { position = { 0, 5, 0 }, direction = { 0, -1, 0 }, inner = 10, outer = 20 },
    disk_light = glint.disk_light { position = { 0, 5, 0 }, normal = { 0, -1, 0 }, radius = 1 },
    polygon_light = glint.polygon_light { vertices = { { 0, 5, 0 }, { 1, 5, 0 }, { 0, 5, 1 } } },
    sphere_light = glint.sphere_light { position = { 0, 5, 0 }, radius = 1 },
    camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } },
    plane = glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 } },
    spheres = glint.spheres { data = { 0, 0, 0, 1, 2, 0, 0, 1 }, material = material },
    mesh = glint.mesh { vertices = { 0, 0, 0, 1, 0, 0, 0, 1, 0 }, faces = { { 1, 2, 3 } }, material = material },
    box = glint.box { min = { -1, -1, -1 }, max = { 1, 1, 1 } },
    disk = glint.disk { center = { 0, 0, 0 }, normal = { 0, 1, 0 }, radius = 1 },
    cylinder = glint.cylinder { base = { 0, 0, 0 }, top = { 0, 1, 0 }, radius = 1 },
    cone = glint.cone { base = { 0, 0, 0 }, top = { 0, 1, 0 }, radius = 1 },
    torus = glint.torus { center = { 0, 0, 0 }, major = 1, minor = 0.3 },
    group = glint.group { ball, transform = glint.translate(1, 0, 0) },
    difference = glint.difference { ball, glint.box { min = { 0, 0, 0 }, max = { 1, 1, 1 } } },
    scene = glint.scene { ball, lamp },
    vector = ball.center,
    pattern = glint.pattern(function(p) return p * 2 end),
    shader = glint.shader(function(at) return at.kd end),
    triple = glint.vector(1, 2, 3),
  }
end

local closed = glint.sphere { center = { 0, 0, 0 }, radius = 1 }
closed:close()

-- Returns a value of any kind; tables contain more values.
local function value(depth)
  local kind = math.random(depth > 0 and 14 or 11)
  if kind == 1 then return nil
  elseif kind == 2 then return math.random() < 0.5
  elseif kind == 3 then return any { 0, 1, -1, 2, 8, 64, 0.5, -0.0, math.maxinteger, math.mininteger, 2 ^ 31, 2 ^ 53 }
  elseif kind == 4 then return any { 1e308, -1e308, 1e-320, 1 / 0, -1 / 0, 0 / 0, 1e10, 65536 }
  elseif kind == 5 then return any { "", "red", "#fff", "1", "phong", "depth", "a\0b", ("x"):rep(1000), "f32", "%s%n" }
  elseif kind == 6 then return any { print, io.stdout, coroutine.create(print), closed, glint }
  elseif kind <= 9 then return any { { 1, 2, 3 }, { 0, 0, 0 }, { 1, 2 }, { 0.2, 0.4, 0.9 }, { 1, 2, 3, 4 }, {} }
  elseif kind <= 11 then
    return objects()[any(KINDS)]
  end
  local t = {}
  for i = 1, math.random(0, 4) do t[i] = value(depth - 1) end
  for _ = 1, math.random(0, 3) do
    t[any { "name", "center", "position", "diffuse", "data", "vertices", "faces", "normals", "camera", "at", "eye", "x", "n", 0, 1.5, true }] =
      value(depth - 1)
  end
  if math.random() < 0.2 then
    setmetatable(t, { __index = function() error "read through a metatable" end, __len = function() return 1e9 end })
  end
  return t
end

-- Calls f. An error must be a string message.
local function try(what, f, ...)
  local ok, message = pcall(f, ...)
  check(ok or (type(message) == "string" and #message < 2000), "%s raised %s", what, tostring(message))
end

local calls = {}
for name, f in pairs(glint) do
  if type(f) == "function" then calls[#calls + 1] = name end
end
table.sort(calls)
for _, name in ipairs(calls) do
  for _ = 1, 400, tally.step do try(name, glint[name], value(2), value(1), value(1)) end
end

-- These methods are not called: {} and nil are valid arguments, and a frame is slow.
local skipped = { render = true, run = true, close = true }
for _, kind in ipairs(KINDS) do
  local members = {}
  for member in pairs(glint._fields()[kind]) do members[#members + 1] = member end
  table.sort(members)
  for _, member in ipairs(members) do
    for _ = 1, 200, tally.step do
      local object = objects()[kind]
      local what = kind .. "." .. member
      if glint._fields()[kind][member] == "field" then
        try(what, function() object[member] = value(2) end)
        try(what, function() return object[member] end)
        check(tostring(object), "%s: no name left", what)
      elseif not skipped[member] then
        try(what, object[member], object, value(2), value(2), value(1))
        try(what, object[member], value(2), value(2))
      end
    end
  end
  for _ = 1, 200, tally.step do
    local object, key = objects()[kind], value(1)
    try(kind, function() return object[key] end)
    try(kind, function() object[key] = value(1) end)
    try(kind, function() return object == value(1), object < value(1) end)
    try(kind, function() return object .. "", #object end)
    try(kind, function() return object(value(1)) end)
  end
end
collectgarbage()

tally.finish()
