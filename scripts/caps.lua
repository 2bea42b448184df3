-- Soft shadows without noise. A ball stands in front of a spherical light: how much of the light does it hide? Seen
-- from the shaded point, both are disks in the sky, and a formula gives the overlap of two disks on a sphere.
-- `shadow = "caps"` multiplies the light by the visible share. `shadow = "rays"` (the default) casts a ray to each of
-- `samples` points of the light.
--
-- Six frames: 4 rays a pixel, 64 rays, the formula; then the same with a lamp four times as wide.
-- On the floor the formula is as accurate as thousands of rays. It has two errors. Where the light sinks below a
-- ball's own horizon, the light counts as a point at its centre, so the terminator on a ball is too sharp. Where
-- several balls stand in front of the light, the formula multiplies their visible shares. Behind two in a row that is
-- too dark or too bright, but never darker than if they hid separate parts of the light.
--     glint scripts/caps.lua                               then glint sheet 'caps_%04d.png' --columns 3 -o sheet.png
--     glint cost scripts/caps.lua --frame 6                the time and the error of both
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
