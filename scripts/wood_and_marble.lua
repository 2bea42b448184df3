-- Wood and marble: two old recipes of noise.
--
-- Wood is rings around an axis, sqrt(x^2 + z^2), pushed about by noise; marble is stripes of a sine that turbulence
-- bends (K. Perlin, "An Image Synthesizer", SIGGRAPH 1985). Both are solid textures, so the pattern on one face of the
-- block continues round the corner. The pixel's footprint leaves out octaves finer than a pixel.
--     glint scripts/wood_and_marble.lua --set rings=14 --set veins=3
local glint = require "glint"

local P = glint.params {
  rings = { 9, min = 1, max = 40, doc = "rings of the wood per world unit" },
  veins = { 1.6, min = 0.2, max = 8, doc = "veins of the marble per world unit" },
  turbulence = { 2.6, min = 0, max = 8, doc = "how far the veins are bent" },
}

-- Sums octaves of |noise|, each half as strong and twice as fine as the last, while they are wider than two pixels.
local function turbulence(p, footprint, octaves)
  local sum, scale = 0, 1
  for _ = 1, octaves do
    local wide = glint.smoothstep(1, 0.5, footprint * scale)
    sum = sum + wide * glint.abs(glint.noise(p * scale)) / scale
    scale = 2 * scale
  end
  return sum
end

local wood = glint.pattern(function(p, s)
  local q = p + 0.12 * glint.noise3(p * 1.3)
  local r = glint.sqrt(q.x ^ 2 + q.z ^ 2) + 0.02 * glint.noise(glint.vector(p.x * 9, p.y * 0.8, p.z * 9))
  local ring = glint.smoothstep(0.05, 0.95, glint.fract(P.rings * r))
  local grain = glint.noise(glint.vector(p.x * 60, p.y * 3, p.z * 60)) * glint.smoothstep(0.03, 0.01, s.footprint)
  return glint.mix({ 0.62, 0.36, 0.16 }, { 0.28, 0.12, 0.04 }, ring * ring) * (1 + 0.12 * grain)
end)

local marble = glint.pattern(function(p, s)
  local bend = P.turbulence * turbulence(p * 1.5, 1.5 * s.footprint, 6)
  local vein = 0.5 + 0.5 * glint.sin(math.pi * (P.veins * (p.x + 0.4 * p.y) + bend))
  return glint.mix({ 0.2, 0.22, 0.28 }, { 0.93, 0.92, 0.88 }, glint.sqrt(vein))
end)

local timber = glint.material { diffuse = wood, specular = 0.12, shininess = 20, name = "wood" }
local stone = glint.material { diffuse = marble, specular = 0.5, shininess = 90, name = "marble" }

local scene = glint.scene {
  camera = glint.camera { eye = { 0.4, 2.6, 8.4 }, at = { 0, 0.72, 0 }, fov = 36 },
  ambient = 0.18, background = "#20242c",
  glint.disk_light { position = { -4, 7, 6 }, normal = { 4, -7, -6 }, radius = 1.2, samples = 16, intensity = 0.9 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.42 } },
  glint.box {
    min = { -1, 0, -0.9 }, max = { 1, 1.9, 0.9 }, material = timber,
    transform = glint.translate(-1.75, 0, 0) * glint.rotate({ 0, 1, 0 }, 32),
  },
  glint.sphere { center = { 1.1, 1.1, 0 }, radius = 1.1, material = stone },
  glint.cylinder { base = { 2.9, 0, -1.6 }, top = { 2.9, 2, -1.6 }, radius = 0.5, material = stone },
  glint.sphere { center = { -0.15, 0.42, 1.9 }, radius = 0.42, material = timber },
}

return glint.animation { scene = scene, frames = 1, width = 1280, height = 720, samples = 4 }
