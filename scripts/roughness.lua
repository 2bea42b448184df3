-- Microfacet roughness above, Phong exponents below: two descriptions of the same highlight.
--
-- A surface of roughness r has a GGX distribution of width alpha = r^2; the normalised Phong exponent of about the same
-- width is 2 / alpha^2 - 2 for n.h (times 1/4 for r.v, whose angle is twice as large). The balls agree in the middle of
-- the highlight and differ in its tails: GGX has a wide, dim skirt, a power of a cosine has none. Only the microfacets
-- brighten towards the rim (Fresnel).
--     glint scripts/roughness.lua                                 five roughnesses
--     glint scripts/roughness.lua --set distribution=beckmann     a distribution with Phong's short tails
local glint = require "glint"

local P = glint.params {
  distribution = { "ggx", choices = { "ggx", "beckmann" }, doc = "distribution of the facets' slopes" },
  f0 = { 0.5, min = 0, max = 1, doc = "reflectance of the surface seen head-on" },
}

local ROUGHNESS <const> = { 0.25, 0.35, 0.5, 0.65, 0.8 }
local tint = { 0.10, 0.13, 0.20 }

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0, 20 }, at = { 0, 0, 0 }, projection = "orthographic", height = 4.6 },
  ambient = 0.3, background = "#14161b",
  glint.directional_light { direction = { 1, -1.2, -1.5 }, intensity = 0.8, name = "key" },
  glint.directional_light { direction = { -1, 0.3, 0.5 }, intensity = 0.4, color = "#9fc3ff", name = "rim" },
}

for i, roughness in ipairs(ROUGHNESS) do
  local alpha = roughness * roughness
  local facets = glint.material {
    model = "cook_torrance", distribution = P.distribution, roughness = roughness, f0 = P.f0, diffuse = tint,
    mirror = 0, -- the lamps alone, as with Phong
  }
  local power = glint.material {
    model = "phong", normalized = true, shininess = math.max(2 / alpha ^ 2 - 2, 0) / 4, specular = P.f0, diffuse = tint,
  }
  for row, material in ipairs { facets, power } do
    scene:add(glint.sphere { center = { 2.2 * (i - 3), 3.3 - 2.2 * row, 0 }, radius = 1, material = material })
  end
end

return glint.animation { scene = scene, frames = 1, width = 1280, height = 530, samples = 9, tone = "filmic",
  exposure = 1 }
