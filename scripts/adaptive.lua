-- Many samples only where they are needed. `adaptive` first takes one sample per pixel. It then takes all samples of
-- each pixel that shows an edge, or whose object or colour differs from a neighbour's.
--
--     glint scripts/adaptive.lua                          5 pictures: all samples everywhere, then 0.3 .. 0.01
--     glint scripts/adaptive.lua --passes refined         also shows the pixels that got all samples, in white
--     glint scripts/adaptive.lua --json | grep refined    the number of these pixels, and of their rays
--     glint scripts/adaptive.lua -f 4 --set samples=64    smooth areas cost no more
-- Look at: outlines and shadow edges, which every threshold finds; the checkered floor far away and in the mirror;
-- the soft shadow: a threshold of 0.03 still smooths the noise of single samples, 0.3 leaves it.
local glint = require "glint"

local P = glint.params {
  samples = { 16, min = 1, max = 65536, whole = true, doc = "samples of the pixels that need them" },
}

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 3, 9 }, at = { 0, 0.9, 0 }, fov = 34 },
  ambient = 0.12, background = { 0.5, 0.62, 0.78 },
  glint.point_light { position = { 6, 9, 6 }, intensity = 0.7 },
  glint.sphere_light { position = { -5, 6, 3 }, radius = 1.2, samples = 4, intensity = 0.5 },
  glint.sphere { center = { -1.5, 1.1, 0 }, radius = 1.1,
    material = glint.material { diffuse = { 0.7, 0.16, 0.12 }, specular = 0.6, shininess = 120 } },
  glint.sphere { center = { 1.2, 1.2, -0.6 }, radius = 1.2,
    material = glint.material { diffuse = 0.05, mirror = 0.85 } },
  glint.box { min = { -0.5, 0, -0.5 }, max = { 0.5, 1, 0.5 },
    material = glint.material { diffuse = { 0.2, 0.35, 0.7 } },
    transform = glint.translate(0.3, 0, 1.8) * glint.rotate("y", 35) },
}
local dark, light = glint.material { diffuse = 0.25 }, glint.material { diffuse = 0.75 }
for i = -9, 8 do
  for k = -16, 5 do
    local tile = (i + k) % 2 == 0 and dark or light
    scene:add(glint.box { min = { i, -1, k }, max = { i + 1, 0, k + 1 }, material = tile })
  end
end

for i, threshold in ipairs { 0, 0.3, 0.1, 0.03, 0.01 } do
  scene:render { width = 640, height = 360, samples = P.samples, adaptive = threshold,
    output = ("adaptive_%d.png"):format(i) }
end
