-- A chain of rings hangs between two posts, and a lamp passes by: each ring shadows the next, itself and the floor.
--
-- A torus is a circle with a tube around it: `major` is the circle's radius, and `minor` the tube's radius, which must
-- be smaller. The rings of the chain are linked, alternately upright and level; a transform places each ring. Two rings
-- lie on the floor: one is a mirror, the other is of glass. A ray intersects a ring up to four times.
--     glint scripts/rings.lua                      48 pictures, rings_0001.png ...
--     glint scripts/rings.lua -f 13 --samples 9    one of them, smooth
--     glint scripts/rings.lua --set thickness=0.3  a heavier chain
local glint = require "glint"

local P = glint.params {
  links = { 11, min = 3, max = 99, whole = true, doc = "rings of the chain" },
  thickness = { 0.17, min = 0.01, max = 0.3, doc = "radius of a ring's tube, as a fraction of the ring's radius" },
  frames = { 48, min = 1, max = 10000, whole = true, doc = "pictures of the lamp's motion" },
}

local steel = glint.material { diffuse = { 0.42, 0.45, 0.5 }, specular = 0.7, shininess = 70 }
local brass = glint.material { diffuse = { 0.62, 0.45, 0.16 }, specular = { 0.7, 0.6, 0.35 }, shininess = 60 }
local wood = glint.material { diffuse = { 0.34, 0.22, 0.13 } }
local mirror = glint.material { diffuse = 0.05, mirror = { 0.8, 0.78, 0.72 }, specular = 0.8, shininess = 200 }
local glass = glint.material { diffuse = 0.02, mirror = 0.06, transmission = { 0.8, 0.92, 0.88 }, ior = 1.5,
  specular = 0.9, shininess = 300 }

local lamp = glint.point_light { position = { 0, 6, 5 }, intensity = 1.05, color = { 1, 0.95, 0.86 } }
local scene = glint.scene {
  camera = glint.camera { eye = { 1.5, 4.2, 11.5 }, at = { 0, 1.9, 0 }, fov = 36 },
  ambient = { 0.14, 0.15, 0.19 }, background = { 0.3, 0.34, 0.42 },
  lamp,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 },
    material = glint.material { diffuse = { 0.55, 0.53, 0.5 } } },
  glint.plane { point = { 0, 0, -4 }, normal = { 0, 0, 1 },
    material = glint.material { diffuse = { 0.5, 0.55, 0.6 } } },
}

-- The curve of the chain: a parabola from post to post, x = -4 .. 4. Its height, and its slope in degrees.
local function height(x) return 1.1 + 2.4 * (x / 4) ^ 2 end
local function slope(x) return math.deg(math.atan(2 * 2.4 * x / 16)) end

local STEP <const> = 0.01
local function step_length(x) return math.sqrt(STEP ^ 2 + (height(x) - height(x - STEP)) ^ 2) end
local length = 0
for k = 1, 8 / STEP do length = length + step_length(-4 + k * STEP) end

-- Returns x at a share of the curve's length.
local function along(share)
  local x, way = -4, share * length
  while way > 0 do
    x, way = x + STEP, way - step_length(x + STEP)
  end
  return x
end

local size = length / (P.links - 1) / (2 - 2.6 * P.thickness) * 0.97 -- size of a link: neighbours nearly touch
for i = 1, P.links do
  local x = along((i - 1) / (P.links - 1))
  scene:add(glint.torus {
    center = { 0, 0, 0 }, axis = { 0, 0, 1 }, major = size, minor = P.thickness * size,
    material = i % 2 == 0 and brass or steel,
    transform = glint.translate(x, height(x), 0) * glint.rotate("z", slope(x)) *
      glint.rotate("x", i % 2 == 0 and 80 or 0),
  })
end

local peg = height(4) + size * (1 - P.thickness) - 0.09 -- the first and last links hang here
for side = -1, 1, 2 do
  local x = 4 * side
  scene:add(glint.cylinder { base = { x, 0, -0.6 }, top = { x, peg + 0.2, -0.6 }, radius = 0.16, material = wood })
  scene:add(glint.cylinder { base = { x, peg, -0.6 }, top = { x, peg, 0.5 }, radius = 0.09, material = wood })
  scene:add(glint.torus { center = { 2.2 * side, 0.42, 2.2 }, axis = { 0.25 * side, 1, 0.3 }, major = 0.95, minor = 0.3,
    material = side < 0 and mirror or glass })
end

return glint.animation {
  scene = scene, frames = P.frames, fps = 24, cyclic = true, output = "rings_%04d.png",
  frame = function(t) lamp.position = { 5.5 * glint.cos(2 * math.pi * t), 5 + glint.sin(4 * math.pi * t), 5.5 } end,
}
