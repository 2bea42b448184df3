-- Which highlights obey physics? The share of the incoming light that leaves again, drawn from material:evaluate.
--
-- Across: a direction, from straight above (left) to the horizon (right). Up: the light that leaves in this direction
-- when it arrives from all directions (thick), and the share that leaves in all directions when light arrives from
-- this one (thin). The white line is at 1. No passive surface rises above it, but plain Phong does, without bound at
-- grazing incidence. Where thick and thin differ, the model is not reciprocal: plain Phong is not. The other three
-- are, so one curve hides the other.
--     red Phong, s = 1   orange Phong, s = 8   green normalised Phong, s = 8
--     blue GGX, roughness 0.5   violet Beckmann, roughness 0.5
--     glint scripts/furnace.lua
--     glint scripts/furnace.lua --set model=ward      a shader of scripts/lib/glint/models.lua in white, too
local glint = require "glint"
local models = require "glint.models"

local P = glint.params {
  steps = { 40, min = 8, max = 200, doc = "rings of directions that are summed up" },
  model = {
    "none", choices = { "none", "phong", "blinn_phong", "ward", "toon", "gooch" },
    doc = "a shader to be drawn beside them",
  },
}

local WIDTH <const>, HEIGHT <const>, POINTS <const> = 6, 2, 48
local CURVES <const> = {
  { "#ef476f", { model = "phong", shininess = 1 } },
  { "#ff9f1c", { model = "phong", shininess = 8 } },
  { "#06d6a0", { model = "phong", shininess = 8, normalized = true } },
  { "#4cc9f0", { model = "cook_torrance", f0 = 1, roughness = 0.5 } },
  { "#9d7bff", { model = "cook_torrance", f0 = 1, roughness = 0.5, distribution = "beckmann" } },
}

if P.model ~= "none" then
  table.insert(CURVES, { "#ffffff", { model = models[P.model] {}, diffuse = 0, shininess = 8 } })
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

local function bright(color) return glint.material { model = "lambert", diffuse = 0, ambient = color } end

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2.1, 9 }, direction = { 0, 0, -1 }, projection = "orthographic", height = 4.8 },
  ambient = 1, background = "#14161b",
}

local function draw(points, radius, color)
  local data = {}
  for i = 2, #points do
    local a, b = points[i - 1], points[i]
    local n = math.max(1, math.ceil(math.sqrt((b[1] - a[1]) ^ 2 + (b[2] - a[2]) ^ 2) / radius))
    for k = 0, n do
      local t = k / n
      table.move({ a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2]), 0, radius }, 1, 4, #data + 1, data)
    end
  end
  scene:add(glint.spheres { data = data, material = bright(color) })
end

local left, right = -WIDTH / 2, WIDTH / 2
draw({ { left, 0 }, { right, 0 } }, 0.012, "#5c6370")
draw({ { left, 0 }, { left, 2.2 * HEIGHT } }, 0.012, "#5c6370")
draw({ { left, HEIGHT }, { right, HEIGHT } }, 0.012, "#ffffff")
for _, curve in ipairs(CURVES) do
  curve[2].specular = 1
  local material = glint.material(curve[2])
  for _, seen in ipairs { true, false } do
    local points = {}
    for i = 0, POINTS do
      local angle = math.rad(88) * i / POINTS
      local height = HEIGHT * share(material, glint.cos(angle), seen)
      points[i + 1] = { left + WIDTH * i / POINTS, math.min(height, 2.2 * HEIGHT) }
    end
    draw(points, seen and 0.03 or 0.012, curve[1])
  end
end

return glint.animation { scene = scene, frames = 1, width = 960, height = 640, samples = 9 }
