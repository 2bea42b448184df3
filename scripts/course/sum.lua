-- The three terms together. Above 1 a display cannot follow: colours wash out, the red of the ball turns to white.
local glint = require "glint"

local P = glint.params {
  ambient = { 0.15, min = 0, max = 1, doc = "Ia, the ambient light" },
  intensity = { 0.8, min = 0, max = 4, doc = "intensity of the lamp" },
  diffuse = { 0.8, min = 0, max = 1, doc = "kd, times the colour of each ball" },
  specular = { 0.5, min = 0, max = 1, doc = "ks, white" },
  tone = { "clamp", choices = { "clamp", "reinhard", "filmic" }, doc = "how light above 1 becomes a colour" },
}

local function ball(x, z, radius, color)
  local kd = P.diffuse
  return glint.sphere { center = { x, radius, z }, radius = radius, material = glint.material {
    diffuse = { kd * color[1], kd * color[2], kd * color[3] }, specular = P.specular, shininess = 40 } }
end
return glint.animation {
  orbit = true,
  scene = glint.scene {
    camera = glint.camera { eye = { 0, 3.4, 10 }, at = { 0, 1.1, 0 }, fov = 32 },
    ambient = P.ambient, background = "#10141c",
    glint.point_light { position = { 5, 8, 7 }, intensity = P.intensity },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.5 * P.diffuse } },
    ball(0, 0, 1.5, { 0.9, 0.15, 0.1 }),
    ball(-2.9, 0.3, 1.1, { 0.15, 0.45, 0.9 }), ball(2.7, 0.6, 1, { 0.95, 0.7, 0.1 }),
  },
  frames = 1, width = 640, height = 360, samples = 4, tone = P.tone,
}
