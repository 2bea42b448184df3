-- The shape of a highlight: how cos^i narrows for i = 1, 2, 4, 8, 16, 32, drawn from material:evaluate.
--
-- Above, Phong's (r.v)^i; below, Blinn-Phong's (n.h)^i. Each curve is a lobe: its distance from the point at the bottom
-- is the share of the light, arriving along the thin line, that leaves in that direction. For the same exponent
-- Blinn-Phong's lobes are wider, because the angle between n and h is half of the angle between r and v.
-- `--set matched=true` multiplies their exponents by four; the rows look alike while all vectors lie in one plane.
--     glint scripts/lobes.lua                      6 + 6 lobes, light 40 degrees from the normal
--     glint scripts/lobes.lua --set angle=75       at a low light Phong's lobes are cut off at the surface
--     glint scripts/lobes.lua --set model=toon     a shader of scripts/lib/glint/models.lua in the lower row
local glint = require "glint"
local models = require "glint.models"

local P = glint.params {
  angle = { 40, min = 0, max = 85, doc = "between light and normal, degrees" },
  model = { "blinn_phong", choices = { "blinn_phong", "ward", "toon" }, doc = "of the lower row" },
  matched = { false, doc = "Blinn-Phong with four times the exponent" },
}

local EXPONENTS <const> = { 1, 2, 4, 8, 16, 32 }
local COLORS <const> = { "#4cc9f0", "#4895ef", "#7b6cf6", "#b5179e", "#f72585", "#ff9f1c" }
local SIZE <const>, DOT <const>, STEPS <const> = 1.2, 0.02, 720

local a = math.rad(P.angle)
local to_light = { -glint.sin(a), glint.cos(a), 0 }

local function bright(color) return glint.material { model = "lambert", diffuse = 0, ambient = color } end

local ink = bright("#5c6370")

-- Adds spheres along the line from one point to another.
local function line(data, x0, y0, x1, y1, radius)
  local n = math.max(1, math.ceil(math.sqrt((x1 - x0) ^ 2 + (y1 - y0) ^ 2) / radius))
  for i = 0, n do
    local t = i / n
    table.move({ x0 + t * (x1 - x0), y0 + t * (y1 - y0), 0, radius }, 1, 4, #data + 1, data)
  end
end

-- Draws the lobe of a material: a ray in each direction, as long as the light reflected there.
local function lobe(material, x, y, data)
  local last_x, last_y = x, y
  for i = 0, STEPS do
    local b = math.pi * (i / STEPS - 0.5)
    local to_eye = { glint.sin(b), math.max(glint.cos(b), 1e-9), 0 }
    local s = material:evaluate({ normal = { 0, 1, 0 }, to_light = to_light, to_eye = to_eye }).specular.x * SIZE
    local next_x, next_y = x + s * to_eye[1], y + s * to_eye[2]
    line(data, last_x, last_y, next_x, next_y, DOT)
    last_x, last_y = next_x, next_y
  end
end

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0, 9 }, direction = { 0, 0, -1 }, projection = "orthographic", height = 4.2 },
  ambient = 1, background = "#14161b",
}

for row, model in ipairs { "phong", P.model } do
  local y = row == 1 and 0.35 or -1.55
  for i, exponent in ipairs(EXPONENTS) do
    local x, data, axes = 1.75 * (i - 3.5) - 0.08, {}, {}
    local shader = row == 2 and model ~= "blinn_phong" and models[model] {}
    local material = glint.material { model = shader or model, specular = 1, shininess = exponent, matched = P.matched }
    lobe(material, x, y, data)
    scene:add(glint.spheres { data = data, material = bright(COLORS[i]), name = model .. " " .. exponent })
    line(axes, x - 0.85, y, x + 0.85, y, 0.012)
    line(axes, x, y, x + 0.9 * to_light[1], y + 0.9 * to_light[2], 0.008)
    scene:add(glint.spheres { data = axes, material = ink })
  end
end

return glint.animation { scene = scene, frames = 1, width = 1280, height = 500, samples = 9 }
