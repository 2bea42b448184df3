-- The same mesh shaded flat, by Gouraud and by Phong, with the light turning around it. The outline stays a polygon.
local glint = require "glint"

local P = glint.params {
  segments = { 14, min = 4, max = 96, whole = true, doc = "faces around the equator" },
  light = { 20, min = -90, max = 90, unit = "°", doc = "direction of the light, from the viewer" },
  shininess = { 40, min = 1, max = 200, doc = "exponent of the highlight" },
}

local clay = glint.material { diffuse = { 0.55, 0.3, 0.18 }, specular = 0.7, shininess = P.shininess }
local turn = math.rad(P.light)
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0, 10 }, at = { 0, 0, 0 }, projection = "orthographic", height = 2.6 },
  ambient = 0.12, background = "#10141c",
  glint.directional_light { direction = { -glint.sin(turn), -0.35, -glint.cos(turn) }, shadows = false },
}
for i, shading in ipairs { "flat", "gouraud", "phong" } do
  scene:add(glint.sphere_mesh { center = { 1.55 * (i - 2), 0, 0 }, radius = 0.72, segments = P.segments,
    shading = shading, material = clay })
end
return glint.animation { scene = scene, frames = 1, width = 640, height = 320, samples = 4 }
