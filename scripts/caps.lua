-- Soft shadows without noise. A ball before a ball of light: how much of the light does it hide? To the point that
-- asks, both are disks in the sky, and the part that two disks of a sphere have in common is a formula.
-- `shadow = "caps"` multiplies the light by it, where `shadow = "rays"` (the default) asks `samples` of its points
-- one by one.
--
-- Six frames: 4 rays a pixel, 64 rays, the formula; then the same with a lamp four times as wide.
-- On the floor the formula is as near to the truth as thousands of rays. Where the light sinks below
-- a ball's own horizon it takes the light as a point at its middle: the edge of day on a ball is sharper than it should
-- be. Where several balls stand before the light it multiplies what each leaves: behind two in a row that is too dark
-- or too bright, never darker than if they hid nothing in common.
--     glint scripts/caps.lua                               then glint sheet 'caps_%04d.png' --columns 3 -o sheet.png
--     glint cost scripts/caps.lua --frame 6                what both take, and how far they are off
local glint = require "glint"

local lamp = glint.sphere_light { position = { -2.5, 7, 2 }, radius = 1, samples = 4, name = "lamp" }

local scene = glint.scene {
  camera = glint.camera { eye = { 0.4, 4.6, 8.5 }, at = { 0.2, 0.4, 0 }, fov = 28 },
  ambient = { 0.06, 0.07, 0.09 }, background = "#20242c", lamp,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.7 } },
}
local clay = glint.material { diffuse = { 0.75, 0.32, 0.18 }, specular = 0.2, shininess = 60 }
for i = 0, 11 do -- a spiral stair of balls
  local a = i * math.pi / 6
  scene:add(glint.sphere { center = { 1.5 * glint.cos(a), 0.3 + 0.13 * i, 1.2 * glint.sin(a) }, radius = 0.26,
    material = clay })
end

local ways = { { "rays", 4 }, { "rays", 64 }, { "caps", 16 } }

return glint.animation {
  scene = scene, width = 400, height = 300, frames = 6,
  frame = function(_, n)
    lamp.radius = n <= 3 and 0.4 or 1.6
    lamp.shadow, lamp.samples = table.unpack(ways[(n - 1) % 3 + 1])
  end,
}
