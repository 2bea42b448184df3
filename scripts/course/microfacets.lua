-- A surface of tiny mirrors: roughness is how far their normals spread. Phong on the left for comparison, with the
-- exponent (2 / roughness^4 - 2) / 4, which gives a highlight of about the same width.
local glint = require "glint"

local P = glint.params {
  roughness = { 0.35, min = 0.05, max = 1, doc = "0 is a mirror, 1 is nearly matt" },
  angle = { 60, min = 0, max = 170, doc = "direction of the lamp: 0 is behind the viewer, 90 straight above" },
  distribution = { "ggx", choices = { "ggx", "beckmann" }, doc = "distribution of the tiny mirrors' normals" },
  metal = { "gold", choices = { "gold", "copper", "silver" }, doc = "the metal; its reflectance seen head-on is f0" },
}

local f0 = ({ gold = { 1, 0.77, 0.34 }, copper = { 0.95, 0.64, 0.54 }, silver = { 0.95, 0.93, 0.88 } })[P.metal]
local angle = math.rad(P.angle)
local function ball(x, material)
  return glint.sphere { center = { x, 0, 0 }, radius = 1.3, material = material }
end
return glint.animation {
  orbit = true,
  scene = glint.scene {
    camera = glint.camera { eye = { 0, 1, 10 }, at = { 0, 0, 0 }, fov = 22 },
    ambient = 0, background = "#10141c",
    glint.directional_light { direction = { 0, -glint.sin(angle), -glint.cos(angle) } },
    ball(-1.5, glint.material { diffuse = 0, specular = f0, normalized = true,
      shininess = math.max(0, 2 / P.roughness ^ 4 - 2) / 4 }),
    ball(1.5, glint.material { model = "cook_torrance", diffuse = 0, specular = 1, f0 = f0, mirror = 0,
      roughness = P.roughness, distribution = P.distribution }),
  },
  frames = 1, width = 640, height = 320, samples = 4,
}
