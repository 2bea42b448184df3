--- Spheres, one light, and at most one effect: see rows.lua.
local glint = require "glint"
local rows = dofile((arg and arg[0] or "tests/effects/scene.lua"):gsub("[^/]*$", "") .. "rows.lua")

local names = { "none" }
for i, row in ipairs(rows) do names[i + 1] = row.name end
local P = glint.params { effect = { "none", choices = names, doc = "what the scene calls for" } }

local ball = glint.material { diffuse = { 0.8, 0.3, 0.2 }, specular = 0.5, shininess = 64 }
local lamp = glint.point_light { position = { 0, 20, 0 }, shadows = false }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 4, 22 }, at = { 0, 1, 0 }, fov = 40 },
  ambient = 0.1,
  lamp,
  glint.sphere { center = { 0, -10002, 0 }, radius = 10000, material = glint.material { diffuse = 0.6 } },
  glint.sphere { center = { -5, 1, 0 }, radius = 3, material = ball },
  glint.sphere { center = { 5, 0, 2 }, radius = 2, material = ball },
}
local parts, frame = { ball = ball, lamp = lamp }, nil
for _, row in ipairs(rows) do
  if row.name == P.effect and row.call then row.call(glint, parts, scene) end
  if row.name == P.effect then frame = row.frame end
end
return glint.animation { scene = scene, frames = 1, frame = function(t)
  if frame then frame(parts, t) end
end }
