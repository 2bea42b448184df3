-- Translucent things: a ball and three panes over a checkered floor, all of one opacity.
--
-- An opacity of 0.45 shows 45 % of a surface and lets 55 % of the light straight through, to the eye and in shadows.
-- The ball has two surfaces, so it lets 30 % through, and so does each pane, which is a thin box. `--set opacity=1`
-- makes all of it opaque, and `--sweep opacity=0.1:1:4` shows what lies between.
--     glint scripts/translucent.lua -o translucent.png
local glint = require "glint"

local P = glint.params {
  opacity = { 0.45, min = 0, max = 1, doc = "opacity of the ball and of each pane" },
}

local function pane(x, z, color)
  return glint.box {
    min = { -0.9, 0.02, -0.01 }, max = { 0.9, 2.2, 0.01 },
    transform = glint.translate(x, 0, z) * glint.rotate("y", -25),
    material = glint.material { diffuse = color, specular = 0.2, opacity = P.opacity },
  }
end
local tiles = glint.pattern(function(p, s)
  return glint.mix(0.85, { 0.12, 0.14, 0.2 }, glint.checker(p, s.footprint))
end)

return glint.scene {
  camera = glint.camera { eye = { 0.6, 2.6, 8 }, at = { 0.2, 0.8, 0 }, fov = 34 },
  ambient = 0.25, background = { 0.5, 0.62, 0.75 },
  glint.sphere_light { position = { -4, 7, 4 }, radius = 0.7, intensity = 0.75, samples = 16 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = tiles } },
  glint.sphere {
    center = { -1.5, 1, 0.4 }, radius = 1,
    material = glint.material { diffuse = { 0.85, 0.2, 0.1 }, specular = 0.5, shininess = 60, opacity = P.opacity },
  },
  pane(0.9, 0.9, { 0.9, 0.7, 0.1 }), pane(1.6, 0, { 0.1, 0.6, 0.3 }), pane(2.3, -0.9, { 0.15, 0.35, 0.9 }),
}
