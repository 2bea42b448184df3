-- The cost of accuracy: more rays per pixel for smooth edges, more rays to the lamp for smooth shadows.
local glint = require "glint"

local P = glint.params {
  samples = { 4, min = 1, max = 64, whole = true, doc = "rays per pixel" },
  light_samples = { 4, min = 1, max = 64, whole = true, doc = "shadow rays to the lamp, for each ray through a pixel" },
  radius = { 1.5, min = 0, max = 4, doc = "radius of the lamp: 0 gives hard shadows" },
}

local function ball(x, z, radius, color)
  local paint = glint.material { diffuse = color, specular = 0.5, shininess = 80 }
  return glint.sphere { center = { x, radius, z }, radius = radius, material = paint }
end
return glint.animation {
  scene = glint.scene {
    camera = glint.camera { eye = { 0, 5, 16 }, at = { 0, 2.2, 0 }, fov = 36 },
    ambient = 0.15, background = "#8fb3d9",
    glint.sphere_light { position = { 3, 12, 4 }, radius = P.radius, samples = P.light_samples },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.5 } },
    ball(-0.7, -2, 2.6, { 0.7, 0.1, 0.08 }), ball(3.9, 0, 1.8, { 0.85, 0.55, 0.1 }),
    ball(-4, 1, 1.6, { 0.1, 0.35, 0.62 }),
  },
  frames = 1, width = 640, height = 360, samples = P.samples,
}
