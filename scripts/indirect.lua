-- Light reflected between surfaces: a white room with one red and one green wall, lit by a lamp under its ceiling.
--
-- Without `indirect` only the lamp lights the room, and `ambient` replaces all other light. It is the same from all
-- directions, so corners, ceiling and the middle of the shadow look flat, and the red wall tints nothing. With
-- `indirect` the engine traces some paths backwards from each point. `bounces` is the number of matt surfaces on a
-- path; at the end of a path `ambient` replaces the remaining light.
--     glint scripts/indirect.lua                                   4 pictures: 0, 1, 2 and 6 bounces
--     glint scripts/indirect.lua --set samples=256                 less noise: the error falls as 1/sqrt(n) or faster
--     glint scripts/indirect.lua --set ambient=0                   the remaining light is lost: least at 6 bounces
--     glint scripts/indirect.lua -f 4 --passes diffuse,indirect    direct light and indirect light
-- Look at: the ceiling, which the lamp does not reach; red and green on floor, ceiling and box; corners, which go dark
-- without any trick; the ball, whose shaded side is lit by the floor.
local glint = require "glint"

local P = glint.params {
  samples = { 64, min = 1, max = 65536, whole = true, doc = "light paths for each sample of a pixel" },
  ambient = { 0.3, min = 0, max = 1, doc = "ambient light, which replaces the light that paths leave out" },
}

local white = glint.material { diffuse = 0.73 }
local red = glint.material { diffuse = { 0.63, 0.06, 0.05 } }
local green = glint.material { diffuse = { 0.14, 0.45, 0.09 } }

-- A wall: a thin box.
local function wall(min, max, material) return glint.box { min = min, max = max, material = material } end

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2.5, 11.2 }, at = { 0, 2.5, 0 }, fov = 35 },
  ambient = P.ambient,
  glint.polygon_light { -- corners counter-clockwise seen from below, the lit side
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
