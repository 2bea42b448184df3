-- Snell's law: n1 sin(t1) = n2 sin(t2). A beam meets the surface of a block; part is mirrored, the rest is refracted.
-- Coming from inside, beyond the critical angle, nothing is refracted.
local glint = require "glint"

local P = glint.params {
  angle = { 50, min = 0, max = 89, unit = "°", doc = "angle of the beam from the normal" },
  ior = { 1.5, min = 1, max = 2.5, doc = "index of refraction of the block: water 1.33, glass 1.5, diamond 2.4" },
  from = { "above", choices = { "above", "inside" }, doc = "the side from which the beam comes" },
}

local side = P.from == "above" and 1 or -1
local ratio = P.from == "above" and 1 / P.ior or P.ior
local sine, cosine = glint.sin(math.rad(P.angle)), glint.cos(math.rad(P.angle))
local refracted = ratio * sine -- sine of the refracted beam's angle; above 1: total reflection

-- The mirrored share of the light: Fresnel's formula for unpolarised light.
local mirrored = 1
if refracted < 1 then
  local across = math.sqrt(1 - refracted * refracted)
  local s = (ratio * cosine - across) / (ratio * cosine + across)
  local p = (cosine - ratio * across) / (cosine + ratio * across)
  mirrored = (s * s + p * p) / 2
end

local block = glint.material { diffuse = { 0.07, 0.15, 0.2 } }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0, 10 }, at = { 0, 0, 0 }, projection = "orthographic", height = 4.4 },
  ambient = 1, background = "#10141c",
  glint.box { min = { -4, -2.2, -1 }, max = { 4, 0, -0.9 }, material = block },
}
local function beam(x, y, share, color, width)
  local paint = glint.material { diffuse = 0, ambient = { share * color[1], share * color[2], share * color[3] } }
  scene:add(glint.cylinder { base = { 0, 0, 0 }, top = { 3 * x, 3 * y, 0 }, radius = width or 0.035, material = paint })
end
beam(0, 1, 0.35, { 1, 1, 1 }, 0.01) -- the normal, on both sides
beam(0, -1, 0.35, { 1, 1, 1 }, 0.01)
beam(-sine, side * cosine, 1, { 1, 0.8, 0.2 })
beam(sine, side * cosine, mirrored ^ 0.5, { 1, 0.3, 0.2 }) -- the square root makes faint beams visible
if refracted < 1 then
  beam(refracted, -side * math.sqrt(1 - refracted * refracted), (1 - mirrored) ^ 0.5, { 0.3, 0.8, 1 })
end
return glint.animation { scene = scene, frames = 1, width = 640, height = 360, samples = 16 }
