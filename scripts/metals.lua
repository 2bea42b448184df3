-- Gold, copper and glass, from polished to frosted: rough surfaces show their surroundings blurred.
--
-- A rough surface is a field of tiny mirrors. Each ray that meets it is reflected by one of them, so the picture in the
-- surface is the mean of many mirror pictures: the rougher, the wider their spread. Highlights of lamps grow and dim in
-- the same way.
--     glint scripts/metals.lua
--     glint scripts/metals.lua --set distribution=beckmann      facets with fewer steep slopes
--     glint scripts/metals.lua --set rays=64                    less noise
--     glint cost scripts/metals.lua --knobs reflection_samples  what the noise costs
local glint = require "glint"

local P = glint.params {
  distribution = { "ggx", choices = { "ggx", "beckmann" }, doc = "distribution of the facets' slopes" },
  rays = { 16, min = 1, max = 4096, whole = true, doc = "reflected rays for each sample of a pixel" },
}

local ROUGHNESS <const> = { 0.05, 0.2, 0.35, 0.5, 0.7 }
local LOOKS <const> = {
  { model = "cook_torrance", f0 = { 1, 0.77, 0.34 }, diffuse = 0 }, -- gold
  { model = "cook_torrance", f0 = { 0.96, 0.64, 0.54 }, diffuse = 0 }, -- copper
  { fresnel = true, transmission = 0.95, ior = 1.3, diffuse = 0 }, -- glass
}

local sky = glint.pattern(function(d)
  local high = glint.smoothstep(-0.1, 0.7, d.y)
  return glint.mix(glint.vector(0.95, 0.86, 0.75), glint.vector(0.16, 0.34, 0.72), high)
end)
local tiles = glint.pattern(function(p)
  return glint.mix(0.12, 0.6, (glint.floor(p.x) + glint.floor(p.z)) % 2)
end)

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 4.6, 10 }, at = { 0, 0.35, -0.1 }, fov = 30 },
  background = sky, ambient = 0.25, reflection_samples = P.rays,
  glint.directional_light { direction = { -1, -2, -1.2 }, intensity = 0.8, name = "sun" },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = tiles } },
}
for row, look in ipairs(LOOKS) do
  for i, roughness in ipairs(ROUGHNESS) do
    look.roughness, look.distribution = roughness, P.distribution
    local center = { 1.75 * (i - 3), 0.75, 2.1 * row - 4.2 }
    scene:add(glint.sphere { center = center, radius = 0.75, material = glint.material(look) })
  end
end

return glint.animation { scene = scene, frames = 1, width = 960, height = 480, samples = 4, tone = "filmic" }
