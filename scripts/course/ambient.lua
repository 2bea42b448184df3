-- Only ambient light: every point of a surface shows the same value, ka Ia, so a ball looks like a disk.
local glint = require "glint"

local P = glint.params {
  ambient = { 0.3, min = 0, max = 1, doc = "Ia, the ambient light of the scene" },
  lamp = { false, doc = "add a lamp and see what the ambient term leaves out" },
}

local function ball(x, color)
  return glint.sphere { center = { x, 1.2, 0 }, radius = 1.2, material = glint.material { diffuse = color } }
end

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2.2, 9 }, at = { 0, 1.1, 0 }, fov = 32 },
  ambient = P.ambient, background = "#10141c",
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.5 } },
  ball(-2.7, { 0.8, 0.2, 0.15 }), ball(0, { 0.85, 0.6, 0.15 }), ball(2.7, { 0.15, 0.4, 0.75 }),
}
if P.lamp then
  scene:add(glint.point_light { position = { 4, 7, 6 }, intensity = 0.7 })
end
return glint.animation { scene = scene, frames = 1, width = 640, height = 360, samples = 4 }
