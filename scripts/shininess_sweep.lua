-- How strong and how tight is a highlight? Two numbers of the Phong model, swept.
--
-- `specular` (ks) scales the highlight, `shininess` (n) is the exponent in (r.v)^n: 3 is chalk, 200 is billiard ball.
-- A sweep renders every combination of its axes, the first axis across, the second down:
--     glint scripts/shininess_sweep.lua                   9 pictures: specular 0.25 0.5 0.75 by shininess 3 9 200
--     glint scripts/shininess_sweep.lua --set kind=log    16 pictures: shininess 1 .. 1000 in equal ratios
-- Equal ratios look like equal steps: the highlight's width goes with 1 / sqrt(n).
local glint = require "glint"

local P = glint.params {
  kind = { "grid", choices = { "grid", "log" }, doc = "grid: specular by shininess; log: shininess 1 .. 1000" },
  steps = { 16, min = 2, max = 1000, whole = true, doc = "pictures of the log sweep" },
}

local clay = glint.material { diffuse = { 0.50, 0.16, 0.10 }, specular = 0.5, shininess = 50 }

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 1.2, 7 }, at = { 0, 0, 0 }, fov = 26 },
  ambient = { 0.09, 0.09, 0.11 },
  background = "#20242c",
  glint.point_light { position = { -5, 6, 7 }, intensity = 0.75, name = "key" },
  glint.point_light { position = { 7, 1, 2 }, intensity = 0.22, color = "#d6e4ff", shadows = false, name = "rim" },
  glint.plane {
    point = { 0, -1.2, 0 }, normal = { 0, 1, 0 },
    material = glint.material { diffuse = { 0.30, 0.31, 0.34 } },
  },
  glint.sphere { center = { 0, 0, 0 }, radius = 1.2, material = clay },
}

local over
if P.kind == "grid" then
  over = { { clay, "specular", { 0.25, 0.5, 0.75 } }, { clay, "shininess", { 3, 9, 200 } } }
else
  local values = {}
  for i = 1, P.steps do
    values[i] = glint.pow(1000, (i - 1) / (P.steps - 1))
  end
  over = { { clay, "shininess", values } }
end

return glint.sweep { scene = scene, over = over, width = 640, height = 480, samples = 4 }
