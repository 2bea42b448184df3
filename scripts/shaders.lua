-- Reflection models written in Lua, next to two built-in models.
--
-- Above: Phong and Blinn-Phong, each built in (left) and as a shader of three lines (right), without a visible
-- difference. Below: models that are not built in: Oren and Nayar's matt clay, Ward's brushed metal, the bands of a
-- cartoon, and Gooch's cool and warm tones of technical drawings. scripts/lib/glint/models.lua defines them, with
-- formula and source.
--     glint scripts/shaders.lua
--     glint scripts/furnace.lua --set model=ward       how much of the light leaves again
local glint = require "glint"
local models = require "glint.models"

local P = glint.params {
  shininess = { 40, min = 1, max = 1000, doc = "exponent of the highlights" },
  roughness = { 0.6, min = 0, max = 1.5, doc = "roughness of Oren and Nayar's model, radians" },
}

local BLUE <const>, CLAY <const> = { 0.1, 0.25, 0.6 }, { 0.65, 0.3, 0.2 }
local STEEL <const>, RED <const> = { 0.12, 0.12, 0.13 }, { 0.8, 0.15, 0.1 }

local ROWS <const> = {
  {
    { diffuse = BLUE, specular = 0.6 },
    { diffuse = BLUE, specular = 0.6, model = models.phong() },
    { diffuse = BLUE, specular = 0.6, model = "blinn_phong" },
    { diffuse = BLUE, specular = 0.6, model = models.blinn_phong() },
  },
  {
    { diffuse = CLAY, model = models.oren_nayar { roughness = P.roughness } },
    { diffuse = STEEL, specular = 0.5, model = models.ward { along = 0.12, across = 0.5 } },
    { diffuse = RED, specular = 0.9, model = models.toon {} },
    { diffuse = RED, specular = 0.4, ambient = { 1, 0.19, 1.4 }, model = models.gooch {} },
  },
}

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0.4, 14 }, at = { 0, 0, 0 }, fov = 24 },
  ambient = 0.2, background = "#20242c",
  glint.directional_light { direction = { -1, -1.2, -1.5 } },
}

for row, list in ipairs(ROWS) do
  for column, fields in ipairs(list) do
    fields.shininess = fields.specular and P.shininess
    local center = { 2.2 * (column - 2.5), 2.3 * (1.5 - row), 0 }
    scene:add(glint.sphere { center = center, radius = 0.95, material = glint.material(fields) })
  end
end

return glint.animation { scene = scene, frames = 1, width = 1280, height = 720, samples = 9 }
