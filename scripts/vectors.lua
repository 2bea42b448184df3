-- The vectors at a point, as a figure: the normal n, the directions l to the light and v to the eye, the mirrored
-- direction r and the half vector h.
--     glint scripts/vectors.lua -o vectors.png
--     glint scripts/vectors.lua -o print.png --size 2400x1500 --dpi 300 --set size=9    letters of 9 points in print
--     glint scripts/vectors.lua -o steep.png --set angle=20 --set model=phong
-- The arrows lie in the scene: they move with the camera, and dashes show what is behind the sphere.
local glint = require "glint"

local P = glint.params {
  angle = { 42, min = 5, max = 80, doc = "between the normal and the light, degrees" },
  model = { "blinn_phong", choices = { "phong", "blinn_phong" }, doc = "of the highlight" },
  size = { 0, min = 0, max = 100, doc = "of the letters, points; 0: by the picture's height" },
}

-- All vectors lie in a plane, at an angle to the normal.
local RADIUS, LENGTH, EYE = 2, 1.9, 66
local n = glint.vector(0, 0.9, 0.44):unit()
local p = RADIUS * n
local function at_angle(degrees)
  return math.cos(math.rad(degrees)) * n + math.sin(math.rad(degrees)) * glint.vector(1, 0, 0)
end
local l, v = at_angle(-P.angle), at_angle(EYE)
local r, h = (-l):reflect(n), (l + v):unit()

local clay = glint.material { model = P.model, diffuse = { 0.42, 0.52, 0.62 }, specular = 0.45 }
clay.shininess = P.model == "phong" and 25 or 100
local scene = glint.scene {
  camera = glint.camera { eye = { 0.9, 4.2, 11.5 }, at = { 0.1, 1.06, 0.4 }, fov = 28 },
  ambient = 0.45, background = "#f7f5f0",
  glint.point_light { position = p + 6 * l, intensity = 0.85 },
  glint.sphere { center = { 0, 0, 0 }, radius = RADIUS, material = clay },
}

local letters = P.size > 0 and P.size or nil
local function arrow(direction, name, color)
  local tip = p + LENGTH * direction
  scene:add(glint.arrow { from = p, to = tip, label = name, color = color, size = letters, hidden = "dashed" })
end
local ink, warm, green, cool = "#1d2228", "#b8420f", "#1f6f2b", "#0b5fa5"
arrow(l, [[$\hat l$]], warm)
arrow(r, [[$\hat r$]], warm)
arrow(v, [[$\hat v$]], cool)
arrow(h, [[$\hat h$]], green)
arrow(n, [[$\hat n$]], ink)
scene:add(glint.arc { at = p, from = n, to = l, radius = 0.75, label = [[$\theta$]], color = warm, size = letters })
scene:add(glint.arc { at = p, from = n, to = r, radius = 0.75, label = [[$\theta$]], color = warm, size = letters })
scene:add(glint.line { from = { 0, 0, 0 }, to = p, color = ink, size = letters, hidden = "dashed" })
scene:add(glint.label { text = "$p$", at_point = p, color = ink, size = letters })

return glint.animation { scene = scene, frames = 1, width = 800, height = 500, samples = 16 }
