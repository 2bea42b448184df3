-- An area light and its shadow, as a figure: a point of the floor that sees nothing of the lamp is in the umbra, and a
-- point that sees a part of the lamp is in the penumbra.
--     glint scripts/penumbra.lua -o penumbra.png
--     glint scripts/penumbra.lua -o small.png --set radius=0.2    a small lamp has a narrow penumbra
local glint = require "glint"

local P = glint.params {
  radius = { 0.7, min = 0.05, max = 1.5, doc = "of the lamp" },
  height = { 1.5, min = 0.5, max = 2.5, doc = "of the disk that throws the shadow" },
}

local ink, warm, cool = "#1d2228", "#b8420f", "#0b5fa5"
local LAMP, DISK = 3.6, 1.0
local matt = glint.material { model = "lambert", diffuse = 0.85, ambient = 0.5 }
local slate = glint.material { model = "lambert", diffuse = { 0.25, 0.3, 0.36 } }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 3.6, 14 }, at = { 0, 1.45, 0 }, projection = "orthographic", height = 5.2 },
  ambient = 0.25, background = "#f7f5f0",
  glint.disk_light { position = { 0, LAMP, 0 }, normal = { 0, -1, 0 }, radius = P.radius, intensity = 0.9,
    samples = 64 },
  glint.box { min = { -4.4, -0.15, -1.6 }, max = { 4.4, 0, 1.6 }, material = matt },
  glint.cylinder { base = { 0, P.height, 0 }, top = { 0, P.height + 0.06, 0 }, radius = DISK, material = slate },
}

-- Draws the line from a point of the lamp past the edge of the disk. Returns where it meets the floor.
local function ray(from, edge, color)
  local x = from + (edge - from) * LAMP / (LAMP - P.height)
  scene:add(glint.line { from = { from, LAMP, 0 }, to = { x, 0, 0 }, color = color, width = 1.2 })
  return x
end

local inner, outer
for side = -1, 1, 2 do
  inner = ray(side * P.radius, side * DISK, cool)
  outer = ray(-side * P.radius, side * DISK, warm)
end
scene:add(glint.line { from = { -P.radius, LAMP, 0 }, to = { P.radius, LAMP, 0 }, color = "#a87400", width = 5,
  label = "area light" })
local function range(first, last, text, color)
  local left, right = { first, -0.7, 1.6 }, { last, -0.7, 1.6 }
  scene:add(glint.line { from = left, to = right, label = text, color = color, width = 3 })
end
if inner > 0 then range(-inner, inner, "umbra", ink) end
range(math.max(inner, 0), outer, "penumbra", warm)
range(-outer, -math.max(inner, 0), "penumbra", warm)

return glint.animation { scene = scene, frames = 1, width = 640, height = 360, samples = 16 }
