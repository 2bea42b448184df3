-- A globe from a picture that the script paints itself.
--
-- The continents are noise on a sphere, computed point by point in plain Lua: the operations of patterns also take
-- numbers. The script writes the picture to a PNG file, glint.texture reads it, and the ball's uv maps it. The sea
-- shines and land does not, because the highlight is a pattern of the same picture. The clouds are a noise pattern,
-- evaluated while the frame is rendered. `--set file=globe.png` uses your own picture.
--     glint scripts/earth.lua -o earth.mp4
local glint = require "glint"
local png = require "glint.png"

local P = glint.params {
  file = { "", doc = "a picture of the globe instead of the painted one" },
  width = { 384, min = 16, max = 4096, whole = true, doc = "width of the painted picture, pixels" },
}

local function height(p)
  local sum, scale = 0.06, 1.4
  for _ = 1, 5 do
    sum = sum + 0.8 * glint.noise(p * scale + 7) / scale
    scale = 2 * scale
  end
  return sum
end

local function color(p)
  local h, cold = height(p), glint.abs(p.y) + 0.15 * glint.noise(p * 6)
  if cold > 0.9 then return { 0.9, 0.92, 0.95 } end
  if h < 0 then return glint.mix({ 0.02, 0.08, 0.25 }, { 0.05, 0.25, 0.45 }, glint.smoothstep(-0.3, 0, h)) end
  local land = glint.mix({ 0.16, 0.32, 0.1 }, { 0.62, 0.52, 0.3 }, glint.smoothstep(0.35, 0.1, glint.abs(cold - 0.35)))
  return glint.mix(land, { 0.4, 0.33, 0.28 }, glint.smoothstep(0.15, 0.45, h))
end

-- Paints the picture. Each pixel is a point of the unit sphere, by the engine's uv.
local function paint(width)
  local picture = png.new(width, width // 2)
  for y = 0, picture.height - 1 do
    local latitude = math.pi * (0.5 - (y + 0.5) / picture.height)
    for x = 0, width - 1 do
      local longitude = 2 * math.pi * (x + 0.5) / width
      local c = glint.cos(latitude)
      picture:set(x, y, color(glint.vector(c * glint.cos(longitude), glint.sin(latitude), c * glint.sin(longitude))))
    end
  end
  return picture
end

local map = P.file == "" and paint(P.width):texture() or glint.texture { file = P.file }

local turn = 0
local function clouds(p)
  local q = p * 2.2 + { turn, 0, 0 }
  local sum = glint.noise(q + 0.5 * glint.noise3(q)) + 0.5 * glint.noise(q * 2.3) + 0.25 * glint.noise(q * 5)
  return glint.smoothstep(0.1, 0.7, sum)
end

local ground = glint.material {
  diffuse = glint.pattern(function(p, s) return glint.mix(map(s.uv, s.uv_footprint), 0.95, clouds(p)) end),
  specular = glint.pattern(function(p, s)
    local c = map(s.uv, s.uv_footprint)
    return 0.6 * glint.less(2 * c.r, c.b) * (1 - clouds(p))
  end),
  shininess = 30, name = "globe",
}

local globe = glint.sphere { center = { 0, 0, 0 }, radius = 1, material = ground }

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0.5, 4.2 }, at = { 0, 0, 0 }, fov = 34 },
  ambient = 0.03, background = "#05060a",
  glint.directional_light { direction = { -1, -0.45, -0.9 } },
  globe,
}

return glint.animation {
  scene = scene, frames = 120, fps = 24, cyclic = true, width = 1280, height = 720, samples = 4,
  frame = function(t)
    turn = 0.8 * t
    globe.transform = glint.rotate({ 0, 0, 1 }, -23.4) * glint.rotate({ 0, 1, 0 }, 360 * t)
  end,
}
