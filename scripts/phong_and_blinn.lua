-- Phong on the left, Blinn-Phong on the right: nearly the same highlight, made from two different angles.
--
--     Phong         S = (r.v)^n    r: the light mirrored at the surface, v: towards the eye
--     Blinn-Phong   S = (n.h)^m    h: halfway between light and eye
-- While n, l and v lie in one plane the angle between n and h is half of the angle between r and v, so Blinn-Phong
-- needs about four times the exponent for a highlight of the same size. Watch the difference grow as the lamp sinks
-- behind the balls: at grazing light Phong's highlight smears along the rim, Blinn-Phong's stays compact.
--     glint scripts/phong_and_blinn.lua                    5 pictures, the lamp from high to low behind the balls
--     glint scripts/phong_and_blinn.lua --set factor=1     with the same exponent: Blinn-Phong's is far too wide
local glint = require "glint"

local P = glint.params {
  shininess = { 24, min = 1, max = 500, doc = "exponent of the Phong ball" },
  factor = { 4, min = 0.1, max = 16, doc = "Blinn-Phong's exponent is this many times Phong's" },
  frames = { 5, min = 1, max = 1000, whole = true, doc = "number of angles of the light" },
}

local tint = { 0.08, 0.22, 0.34 }
local phong = glint.material { model = "phong", diffuse = tint, specular = 0.7, shininess = P.shininess }
local blinn = glint.material {
  model = "blinn_phong", diffuse = tint, specular = 0.7, shininess = P.factor * P.shininess,
}
local floor = { diffuse = { 0.16, 0.15, 0.14 }, specular = 0.3, shininess = P.shininess / 2 }
local lamp = glint.directional_light { direction = { 0, -1, 0 }, intensity = 0.9, color = { 1, 0.95, 0.85 } }

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2.2, 10 }, at = { 0, 0.2, 0 }, fov = 28 },
  ambient = { 0.10, 0.11, 0.13 },
  background = "#161a22",
  lamp,
  glint.plane { point = { 0, -1.5, 0 }, normal = { 0, 1, 0 }, material = glint.material(floor) },
  glint.sphere { center = { -1.75, 0, 0 }, radius = 1.5, material = phong, name = "phong" },
  glint.sphere { center = { 1.75, 0, 0 }, radius = 1.5, material = blinn, name = "blinn" },
}

return glint.animation {
  scene = scene, frames = P.frames, width = 1280, height = 640, samples = 4,
  frame = function(t)
    -- From 60 degrees over the viewer's shoulder to 10 degrees above the horizon behind the balls.
    local angle = math.rad(60 + 110 * t)
    lamp.direction = { 0, -glint.sin(angle), -glint.cos(angle) }
  end,
}
