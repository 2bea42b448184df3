-- Lambert's cosine law: a matt surface shows kd Id (n.l). The tiles turn away from the light step by step; the ball
-- has every angle at once.
local glint = require "glint"

local P = glint.params {
  angle = { 40, min = 0, max = 180, unit = "°", doc = "angle of the light from straight above" },
}

local white = glint.material { diffuse = 0.9, ambient = 0 }
local angle = math.rad(P.angle)
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 6, 10 }, at = { 0, 0.2, 0 }, projection = "orthographic", height = 3.7 },
  ambient = 0, background = "#10141c",
  glint.directional_light { direction = { -glint.sin(angle), -glint.cos(angle), 0 }, shadows = false },
  glint.sphere { center = { -1.8, 0.2, 0 }, radius = 1.2, material = white },
}
for i = 0, 4 do
  local turn = glint.translate(0.15 + 0.62 * i, 0.2, 0) * glint.rotate("z", -22.5 * i)
  scene:add(glint.box { min = { -0.3, -0.02, -1 }, max = { 0.3, 0.02, 1 }, material = white, transform = turn })
end
return glint.animation { scene = scene, frames = 1, width = 640, height = 360, samples = 4 }
