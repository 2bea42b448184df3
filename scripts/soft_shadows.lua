-- How the size of a lamp changes its shadows, and how many samples a picture without noise needs.
--
-- A point light casts hard shadows. With an area light, points in the penumbra see a part of the lamp. The penumbra is
-- wider for a larger lamp and for a more distant occluder. The engine casts rays to `samples` points of the lamp. The
-- points differ between the pixels of a 4 x 4 block, and between the 4 samples of a pixel here: few points give noise,
-- but never bands.
--     glint scripts/soft_shadows.lua                       12 pictures: radius 0 0.6 1.8 across, samples 1 4 16 64 down
--     glint scripts/soft_shadows.lua --set lamp=disk       a disk that faces the floor
--     glint scripts/soft_shadows.lua --set lamp=window     a square of the same area
-- Only the penumbra costs rays: one test settles points that see all of the lamp, or nothing. `--json` counts them.
local glint = require "glint"

local P = glint.params {
  lamp = { "sphere", choices = { "sphere", "disk", "window" }, doc = "shape of the lamp" },
}

local height = 5
local lamp, size -- the lamp, and the field that sets its size
if P.lamp == "sphere" then
  lamp, size = glint.sphere_light { position = { -1, height, 1.5 }, radius = 1, name = "lamp" }, "radius"
elseif P.lamp == "disk" then
  lamp = glint.disk_light { position = { -1, height, 1.5 }, normal = { 0, -1, 0 }, radius = 1, name = "lamp" }
  size = "radius"
else
  lamp, size = glint.polygon_light { vertices = { { -1, height, 1 }, { 0, height, 1 }, { 0, height, 2 } },
    name = "lamp" }, "vertices"
end

-- Returns a square with the area of a disk of this radius; corners counter-clockwise seen from below, the lit side.
local function window(radius)
  local h = 0.5 * radius * math.sqrt(math.pi)
  return {
    { -1 - h, height, 1.5 - h }, { -1 + h, height, 1.5 - h }, { -1 + h, height, 1.5 + h }, { -1 - h, height, 1.5 + h },
  }
end

local sizes = { 0, 0.6, 1.8 }
if size == "vertices" then sizes = { window(0.05), window(0.6), window(1.8) } end

local clay = glint.material { diffuse = { 0.75, 0.32, 0.18 }, specular = 0.2, shininess = 60 }
local chalk = glint.material { diffuse = 0.7 }

local scene = glint.scene {
  camera = glint.camera { eye = { 1.5, 3.6, 8.5 }, at = { 0.2, 0.9, 0 }, fov = 30 },
  ambient = { 0.07, 0.08, 0.1 },
  background = "#20242c",
  lamp,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = chalk },
  glint.sphere { center = { -0.9, 0.8, 0 }, radius = 0.8, material = clay }, -- on the floor: its shadow begins sharp
  glint.sphere { center = { 1.1, 2.0, -0.3 }, radius = 0.45, material = clay }, -- in the air: its whole shadow is soft
}

return glint.sweep {
  scene = scene, width = 480, height = 360, samples = 4,
  over = { { lamp, size, sizes }, { lamp, "samples", { 1, 4, 16, 64 } } },
}
