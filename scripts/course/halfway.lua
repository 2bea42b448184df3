-- Phong on the left, Blinn-Phong on the right. The lamp goes from behind the viewer to behind the balls.
local glint = require "glint"

local P = glint.params {
  angle = { 120, min = 20, max = 175, doc = "direction of the lamp: 90 is straight above, more is behind the balls" },
  shininess = { 24, min = 1, max = 200, doc = "Phong's exponent" },
  factor = { 4, min = 0.5, max = 8, doc = "Blinn-Phong's exponent divided by Phong's" },
}

local angle = math.rad(P.angle)
local function ball(x, model, exponent)
  return glint.sphere { center = { x, 0, 0 }, radius = 1.3, material = glint.material {
    model = model, diffuse = { 0.08, 0.22, 0.34 }, specular = 0.7, shininess = exponent } }
end
return glint.animation {
  orbit = true,
  scene = glint.scene {
    camera = glint.camera { eye = { 0, 1.6, 10 }, at = { 0, 0, 0 }, fov = 24 },
    ambient = 0.12, background = "#10141c",
    glint.directional_light { direction = { 0, -glint.sin(angle), -glint.cos(angle) }, intensity = 0.9 },
    ball(-1.6, "phong", P.shininess), ball(1.6, "blinn_phong", P.factor * P.shininess),
  },
  frames = 1, width = 640, height = 360, samples = 4,
}
