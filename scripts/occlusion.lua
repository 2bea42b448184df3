-- Ambient occlusion shows shape without lamps: ambient light is dim where shapes hide much of the sky.
--     glint scripts/occlusion.lua -f 2                      the whole sky; frame 1: none, 3: near occluders only
--     glint scripts/occlusion.lua -f 3 --set distance=1.5   ignores occluders farther away than this
--     glint scripts/occlusion.lua -f 2 --set samples=256    less noise; more samples per pixel reduce it, too
-- The body is porous: randomly shifted balls of a lattice, without the balls inside some round pores.
local glint = require "glint"

local P = glint.params {
  samples = { 32, min = 1, max = 65536, whole = true, doc = "rays from each point" },
  distance = { 3, min = 0.01, doc = "distance of the farthest occluders in the third frame" },
  side = { 22, min = 4, max = 200, whole = true, doc = "balls along a side" },
}

local state = 7
local function noise() -- -1 .. 1, the same numbers on every machine
  state = state * 48271 % 0x7fffffff
  return state / 0x3fffffff - 1
end

local pores, balls = {}, {}
for i = 1, 26 do
  pores[i] = { noise() * P.side / 2, noise() * P.side / 2, noise() * P.side / 2, P.side * (0.16 + 0.06 * noise()) }
end

local function is_pore(x, y, z)
  for _, p in ipairs(pores) do
    if (x - p[1]) ^ 2 + (y - p[2]) ^ 2 + (z - p[3]) ^ 2 < p[4] ^ 2 then return true end
  end
  return false
end

for i = 0, P.side ^ 3 - 1 do
  local x, y, z = i % P.side - P.side / 2, i // P.side % P.side - P.side / 2, i // P.side ^ 2 - P.side / 2
  if not is_pore(x, y, z) then
    for _, place in ipairs { x, y, z } do balls[#balls + 1] = place + 0.2 * noise() end
    balls[#balls + 1] = 0.6
  end
end

local scene = glint.scene {
  camera = glint.camera { eye = { 1.2 * P.side, 1.1 * P.side, 1.7 * P.side }, at = { -0.5, -0.8, 0 }, fov = 34 },
  ambient = 1, background = "#20262e",
  glint.spheres { data = balls, material = glint.material { diffuse = { 0.93, 0.72, 0.48 } } },
}
local ways = { false, { samples = P.samples }, { samples = P.samples, distance = P.distance } }

return glint.animation { scene = scene, frames = 3, width = 800, height = 500, samples = 4,
  frame = function(_, n) scene.ambient_occlusion = ways[n] or nil end }
