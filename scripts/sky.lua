-- Things under a sky that is a picture.
--
-- The script paints a picture of all directions, with clouds and hills, and sets it as the scene's background. The eye,
-- the mirror and the glass see it, and it lights matt surfaces. A PNG holds no light above white, so the sun is a lamp.
-- `--set file=sky.hdr` uses your own picture, twice as wide as high, with the horizon in the middle; it may hold a sun.
--     glint scripts/sky.lua -o sky.mp4
local glint = require "glint"
local png = require "glint.png"

local P = glint.params {
  file = { "", doc = "a picture of all directions instead of the painted one" },
  width = { 512, min = 16, max = 8192, whole = true, doc = "width of the painted picture, pixels" },
  samples = { 16, min = 1, max = 4096, whole = true, doc = "light paths from each point" },
}

local SUN <const> = glint.unit { -0.5, 0.45, -1 }

local function clouds(d)
  local sum, scale = 0, 1.5
  for _ = 1, 5 do
    sum = sum + glint.noise(glint.vector(d.x / (d.y + 0.15), 7, d.z / (d.y + 0.15)) * scale) / scale
    scale = 2 * scale
  end
  return glint.smoothstep(0, 0.5, sum)
end

local function sky(d)
  local blue = glint.mix({ 0.75, 0.8, 0.85 }, { 0.12, 0.3, 0.7 }, glint.sqrt(d.y))
  local near = d:dot(SUN)
  if near > 0.995 then return { 1, 1, 1 } end
  return glint.mix(glint.mix(blue, 0.95, 0.85 * clouds(d)), { 1, 0.9, 0.7 }, glint.smoothstep(0.75, 1, near))
end

local function hills(turn)
  local x, z = glint.sin(turn), glint.cos(turn)
  return 0.05 + 0.07 * glint.noise { 4 * x, 0, 4 * z } + 0.02 * glint.noise { 15 * x, 3, 15 * z }
end

-- Column x and row y of a picture of all directions: -z in the middle, +x to the right, up at the top.
local function paint(width)
  local picture = png.new(width, width // 2)
  for x = 0, width - 1 do
    local turn = 2 * math.pi * ((x + 0.5) / width - 0.5)
    local horizon = hills(turn)
    for y = 0, picture.height - 1 do
      local up = math.pi * (0.5 - (y + 0.5) / picture.height)
      local d = glint.vector(glint.cos(up) * glint.sin(turn), glint.sin(up), -glint.cos(up) * glint.cos(turn))
      local ground = glint.mix({ 0.1, 0.16, 0.06 }, { 0.2, 0.2, 0.12 }, glint.smoothstep(-0.3, 0.1, d.y))
      local above = glint.clamp((d.y - horizon) * width / (2 * math.pi) + 0.5, 0, 1) -- share of the pixel
      picture:set(x, y, above > 0 and glint.mix(ground, sky(d), above) or ground)
    end
  end
  return picture
end

local picture = P.file == "" and paint(P.width):texture() or glint.texture { file = P.file }

local camera = glint.camera { eye = { 0, 1.7, 7.2 }, at = { 0, 0.75, 0 }, fov = 38 }
local function matt(diffuse) return glint.material { diffuse = diffuse } end

return glint.animation {
  scene = glint.scene {
    camera = camera, background = picture, indirect = { samples = P.samples, bounces = 2 },
    glint.directional_light { direction = -SUN, color = { 1, 0.9, 0.7 }, intensity = 0.8 },
    glint.disk { center = { 0, 0, 0 }, normal = { 0, 1, 0 }, radius = 4, material = matt { 0.6, 0.55, 0.5 } },
    glint.sphere { center = { -1.7, 1, -0.3 }, radius = 1, material = glint.material { diffuse = 0, mirror = 0.95 } },
    glint.sphere { center = { 1.7, 1, -0.3 }, radius = 1,
      material = glint.material { diffuse = 0, transmission = 1, ior = 1.5, fresnel = true } },
    glint.sphere { center = { 0, 0.6, 1.3 }, radius = 0.6, material = matt { 0.8, 0.35, 0.25 } },
    glint.sphere { center = { 0, 0.8, -1.8 }, radius = 0.8, material = matt(0.8) },
  },
  frames = 120, fps = 24, cyclic = true, width = 1280, height = 720, samples = 4,
  frame = function(t)
    local turned = 2 * math.pi * t
    camera.eye = { 7.2 * glint.sin(turned), 1.7, 7.2 * glint.cos(turned) }
  end,
}
