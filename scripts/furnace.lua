-- Which highlights obey physics? The share of the incoming light that leaves again, drawn from material:evaluate.
--
-- Across: a direction, from straight above to the horizon. Up: the light that leaves in this direction when it arrives
-- from all directions (thick), and the share that leaves in all directions when light arrives from this one (thin). No
-- passive surface rises above the grey line at 1, but plain Phong does, without bound at grazing incidence. Where thick
-- and thin differ, the model is not reciprocal: plain Phong is not. The other three are, so one curve hides the other.
--     glint scripts/furnace.lua                       furnace.png; -o furnace.svg or furnace.pdf for print
--     glint scripts/furnace.lua --set model=ward      a shader of scripts/lib/glint/models.lua in black, too
--     glint scripts/furnace.lua --set picture=balls   white balls in white surroundings: what they lose shows as grey
local glint = require "glint"
local models = require "glint.models"

local P = glint.params {
  picture = { "curves", choices = { "curves", "balls" }, doc = "curves of the formulas, or rendered balls" },
  steps = { 40, min = 8, max = 200, whole = true, doc = "rings of directions that are summed up" },
  model = {
    "none", choices = { "none", "phong", "blinn_phong", "ward", "toon", "gooch" },
    doc = "a shader to be drawn beside them",
  },
}

-- Balls of white facets, GGX above and Beckmann below, rougher to the right. Without loss they would be invisible.
-- Light that one facet sends to the next is not followed, so rough balls are grey, as the curves say.
if P.picture == "balls" then
  local furnace = glint.scene {
    background = 1, reflection_samples = 64,
    camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 }, projection = "orthographic", height = 4.8 },
  }
  for row, distribution in ipairs { "ggx", "beckmann" } do
    for i = 1, 5 do
      local white = glint.material {
        model = "cook_torrance", f0 = 1, diffuse = 0, roughness = i / 5, distribution = distribution,
      }
      furnace:add(glint.sphere { center = { 2.3 * (i - 3), 3.45 - 2.3 * row, 0 }, radius = 1, material = white })
    end
  end
  return glint.animation { scene = furnace, frames = 1, width = 960, height = 400 }
end

local POINTS <const>, WIDEST <const> = 48, 88 -- directions, up to so many degrees from the normal
local CURVES <const> = {
  { "Phong, s = 1", "#ef476f", { model = "phong", shininess = 1 } },
  { "Phong, s = 8", "#ff9f1c", { model = "phong", shininess = 8 } },
  { "normalised, s = 8", "#06d6a0", { model = "phong", shininess = 8, normalized = true } },
  { "GGX, roughness 0.5", "#4cc9f0", { model = "cook_torrance", f0 = 1, roughness = 0.5 } },
  { "Beckmann, 0.5", "#9d7bff", { model = "cook_torrance", f0 = 1, roughness = 0.5, distribution = "beckmann" } },
}

if P.model ~= "none" then
  table.insert(CURVES, { P.model, "black", { model = models[P.model] {}, diffuse = 0, shininess = 8 } })
end

local function direction(cosine, azimuth)
  local sine = math.sqrt(1 - cosine * cosine)
  return { sine * glint.cos(azimuth), cosine, sine * glint.sin(azimuth) }
end

-- Sums over directions of equal weight. seen: from all lights to one eye; otherwise from one light to all eyes.
local function share(material, cosine, seen)
  local one, sum, n = direction(cosine, 0), 0, P.steps
  for i = 0, n - 1 do
    local c = (i + 0.5) / n
    for k = 0, 2 * n - 1 do
      local other = direction(c, math.pi * (k + 0.5) / n)
      local l, v = seen and other or one, seen and one or other
      local s = material:evaluate({ normal = { 0, 1, 0 }, to_light = l, to_eye = v }).specular.x
      sum = sum + (seen and s or s * c / cosine) -- outgoing light is weighted by its own cosine
    end
  end
  return sum / (n * n)
end

local angles, series = {}, { { x = { 0, 90 }, y = { 1, 1 }, color = "gray", width = 1 } }
for i = 0, POINTS do angles[i + 1] = WIDEST * i / POINTS end
for _, curve in ipairs(CURVES) do
  local label, color, fields = table.unpack(curve)
  fields.specular = 1
  local material = glint.material(fields)
  for _, seen in ipairs { true, false } do
    table.insert(series, {
      label = seen and label or "", color = color, width = seen and 3 or 1, x = angles,
      y = function(angle) return share(material, glint.cos(math.rad(angle)), seen) end,
    })
  end
end

local scene = glint.scene {
  background = "white",
  camera = glint.camera { eye = { 0, 0, 1 }, at = { 0, 0, 0 } },
  glint.chart {
    title = "White furnace", series = series, x_range = { 0, 90 }, y_range = { 0, 2.2 },
    x_label = "angle from the normal / degrees", y_label = "share of the light",
  },
}
return glint.animation { scene = scene, frames = 1, width = 960, height = 640 }
