-- Light that surfaces send each other: a white room with one red and one green wall, lit by a lamp under its ceiling.
--
-- Without `indirect` the lamp alone lights the room, and `ambient` stands for everything else: the same light from
-- everywhere, so that corners, ceiling and the shadow's middle are flat, and a red wall makes nothing red. With it,
-- some ways of light are followed backwards from each point; the number of matt surfaces on a way is `bounces`, and
-- where a way is cut off `ambient` stands for the rest.
--     glint scripts/indirect.lua                                   4 pictures: 0, 1, 2 and 6 bounces
--     glint scripts/indirect.lua --set samples=256                 less noise: the error falls with the root or faster
--     glint scripts/indirect.lua --set ambient=0                   what is cut off is lost: least at 6 bounces
--     glint scripts/indirect.lua -f 4 --passes diffuse,indirect    light from the lamp, and light from the room
-- Look at: the ceiling, which the lamp does not reach; red and green on floor, ceiling and box; corners, which go dark
-- by themselves; the ball, whose shaded side is lit by the floor.
local glint = require "glint"

local P = glint.params {
  samples = { 64, min = 1, max = 65536, doc = "ways of light a sample of a pixel" },
  ambient = { 0.3, min = 0, max = 1, doc = "light that stands for what is not followed" },
}

local white = glint.material { diffuse = 0.73 }
local red = glint.material { diffuse = { 0.63, 0.06, 0.05 } }
local green = glint.material { diffuse = { 0.14, 0.45, 0.09 } }

-- A wall, a thin box.
local function wall(min, max, material) return glint.box { min = min, max = max, material = material } end

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2.5, 11.2 }, at = { 0, 2.5, 0 }, fov = 35 },
  ambient = P.ambient,
  glint.polygon_light { -- corners counter-clockwise from below, where it shines
    vertices = { { -0.8, 4.98, -0.8 }, { 0.8, 4.98, -0.8 }, { 0.8, 4.98, 0.8 }, { -0.8, 4.98, 0.8 } },
    radiance = 5, color = { 1, 0.86, 0.66 }, samples = 16, name = "lamp",
  },
  wall({ -2.6, -0.1, -2.6 }, { 2.6, 0, 2.6 }, white), -- floor
  wall({ -2.6, 5, -2.6 }, { 2.6, 5.1, 2.6 }, white), -- ceiling
  wall({ -2.6, 0, -2.7 }, { 2.6, 5, -2.5 }, white), -- back
  wall({ -2.7, 0, -2.6 }, { -2.5, 5, 2.6 }, red),
  wall({ 2.5, 0, -2.6 }, { 2.7, 5, 2.6 }, green),
  glint.box { min = { -0.75, 0, -0.75 }, max = { 0.75, 3, 0.75 }, material = white,
    transform = glint.translate(-0.95, 0, -1) * glint.rotate("y", 18) },
  glint.sphere { center = { 1.15, 0.9, 0.7 }, radius = 0.9, material = white },
}

local followed = {}
for i, bounces in ipairs { 0, 1, 2, 6 } do followed[i] = { samples = P.samples, bounces = bounces } end

return glint.sweep { scene = scene, width = 480, height = 480, samples = 4, over = { { scene, "indirect", followed } } }
