-- One highlight and its exponent. The ball on the left has a quarter of it, the ball on the right four times as much.
local glint = require "glint"

local P = glint.params {
  shininess = { 32, min = 1, max = 1000, doc = "exponent n of the middle ball" },
  specular = { 0.8, min = 0, max = 1, doc = "ks, the strength of the highlight" },
}

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0, 10 }, at = { 0, 0, 0 }, projection = "orthographic", height = 2.6 },
  ambient = 0.1, background = "#10141c",
  glint.directional_light { direction = { -0.25, -0.4, -1 } },
}
for i = -1, 1 do
  scene:add(glint.sphere { center = { 1.55 * i, 0, 0 }, radius = 0.72, material = glint.material {
    diffuse = { 0.12, 0.3, 0.5 }, specular = P.specular, shininess = P.shininess * 4.0 ^ i } })
end
return glint.animation { scene = scene, frames = 1, width = 640, height = 320, samples = 4 }
