-- The angle of a highlight, as a figure: Phong compares the mirrored light r with the direction v to the viewer,
-- Blinn-Phong the half vector h with the normal n. The violet curves are the highlights themselves, in polar form.
--     glint scripts/highlight_angles.lua -o angles.png
--     glint scripts/highlight_angles.lua -o low.png --set light=70 --set viewer=40
local glint = require "glint"

local P = glint.params {
  light = { 50, min = 5, max = 80, doc = "between the normal and the light, degrees" },
  viewer = { 22, min = 0, max = 80, doc = "between the normal and the viewer, degrees" },
  shininess = { 12, min = 1, max = 400, doc = "Phong's exponent; Blinn-Phong's is four times it" },
}

local ink, warm, green, cool, pale = "#1d2228", "#b8420f", "#1f6f2b", "#0b5fa5", "#8a7fb5"
local LENGTH = 2.5
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 1.05, 20 }, at = { 0, 1.05, 0 }, projection = "orthographic", height = 4.4 },
  ambient = 1, background = "#f7f5f0",
}
local stone = glint.material { model = "lambert", diffuse = 0, ambient = "#cfc9bd" }

local function at_angle(degrees)
  local a = math.rad(degrees)
  return glint.vector(glint.sin(a), glint.cos(a), 0)
end
local n, l, v = at_angle(0), at_angle(-P.light), at_angle(P.viewer)
local r, h = (-l):reflect(n), (l + v):unit()

-- Draws the vectors at x. The angle is between `from` and `to`, the highlight is the material's.
local function panel(x, title, material, from, to, other, name, color, angle)
  local p = glint.vector(x, 0, 0)
  local function arrow(direction, label, paint)
    scene:add(glint.arrow { from = p, to = p + LENGTH * direction, label = label, color = paint })
  end
  scene:add(glint.box { min = { x - 1.9, -0.6, -1 }, max = { x + 1.9, 0, 1 }, material = stone })
  scene:add(glint.lobe { point = p, normal = n, to_light = l, material = material, scale = 2.1, color = pale })
  arrow(l, [[$\hat l$]], warm)
  arrow(n, [[$\hat n$]], ink)
  arrow(v, [[$\hat v$]], cool)
  arrow(other, name, color)
  scene:add(glint.arc { at = p, from = from, to = to, radius = 1.5, label = angle, color = color })
  local left, right = { x - 1.9, -0.6, 0 }, { x + 1.9, -0.6, 0 }
  scene:add(glint.line { from = left, to = right, label = title, color = ink, width = 0.5 })
end

local phong = glint.material { model = "phong", specular = 1, shininess = P.shininess }
local blinn = glint.material { model = "blinn_phong", specular = 1, shininess = 4 * P.shininess }
panel(-2.35, [[Phong: $\hat r\cdot\hat v = \cos\alpha$]], phong, r, v, r, [[$\hat r$]], warm, [[$\alpha$]])
panel(2.35, [[Blinn-Phong: $\hat n\cdot\hat h = \cos\beta$]], blinn, n, h, h, [[$\hat h$]], green, [[$\beta$]])

return glint.animation { scene = scene, frames = 1, width = 640, height = 300, samples = 4 }
