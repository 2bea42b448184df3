-- Lambert's cosine law, as a figure: the same light falls on a larger area, the more the surface turns away from it.
--     glint scripts/cosine.lua -o cosine.png
--     glint scripts/cosine.lua -o steep.png --set angle=75
-- Each plate gets a beam of the same width, between the thin lines. The thick line is the area that it lights, and the
-- plate is as bright as the cosine of the angle θ between its normal n and the direction l to the light.
local glint = require "glint"

local P = glint.params {
  angle = { 60, min = 10, max = 80, doc = "between the last plate's normal and the light, degrees" },
}

local ink, warm, cool = "#1d2228", "#b8420f", "#0b5fa5"
local BEAM, APART = 0.9, 3.7

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 3.4, 12 }, at = { 0, 0.4, 0 }, projection = "orthographic", height = 6.7 },
  ambient = 0.02, background = "#f7f5f0",
  glint.directional_light { direction = { 0, -1, 0 }, intensity = 1, shadows = false },
}
local paper = glint.material { model = "lambert", diffuse = { 0.55, 0.68, 0.82 } }
local up = glint.vector(0, 1, 0)

local function plate(x, degrees)
  local a = math.rad(degrees)
  local n, along = glint.vector(glint.sin(a), glint.cos(a), 0), glint.vector(glint.cos(a), -glint.sin(a), 0)
  local p = glint.vector(x, 0, 0)
  scene:add(glint.box { min = { -1.25, -0.1, -0.9 }, max = { 1.25, 0, 0.9 }, material = paper,
    transform = glint.translate(x, 0, 0) * glint.rotate("z", -degrees) })
  local half = BEAM / 2 / glint.cos(a)
  for side = -1, 1, 2 do
    local foot = p + side * half * along
    scene:add(glint.line { from = { foot.x, 2.6, 0 }, to = foot, color = warm, width = 1 })
  end
  scene:add(glint.line { from = p - half * along, to = p + half * along, color = warm, width = 4 })
  local name = degrees > 0 and [[$\hat l$]] or [[$\hat l = \hat n$]]
  scene:add(glint.arrow { from = p, to = p + 1.9 * up, label = name, color = warm })
  if degrees > 0 then
    scene:add(glint.arrow { from = p, to = p + 1.9 * n, label = [[$\hat n$]], color = cool })
    scene:add(glint.arc { at = p, from = up, to = n, radius = 0.95, label = [[$\theta$]], color = cool })
  end
  local left, right = { x - 1, -1.9, 0 }, { x + 1, -1.9, 0 }
  local value = ([[$\cos %g^\circ = %.2f$]]):format(degrees, glint.cos(a))
  scene:add(glint.line { from = left, to = right, label = value, color = ink, width = 0.5 })
end

plate(-APART, 0)
plate(0, P.angle / 2)
plate(APART, P.angle)

return glint.animation { scene = scene, frames = 1, width = 640, height = 360, samples = 16 }
