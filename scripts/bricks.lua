-- A flat wall that looks like a relief of bricks: a bump is a height that affects only the shading.
--
-- One function lays the bricks. The colour uses it to place the mortar, and the bump uses it as a height. The engine
-- differentiates the height's program, without a step size, and tilts the normals like the normals of a real relief.
-- The silhouette and the shadows stay flat: look along the edge. `--set height=0` shows the wall without the bump.
--     glint scripts/bricks.lua -o bricks.mp4
local glint = require "glint"

local P = glint.params {
  height = { 0.05, min = 0, max = 0.3, doc = "height of the bricks over the mortar, world units" },
  mortar = { 0.05, min = 0.005, max = 0.2, doc = "width of a joint, world units" },
}

local WIDTH <const>, HEIGHT <const> = 0.8, 0.3 -- size of a brick including its joint, world units

-- Returns the distance of a point from the middle of the nearest joint, and the brick that contains the point.
local function lay(p)
  local y = p.y / HEIGHT
  local x = p.x / WIDTH + 0.5 * glint.stripe(y)
  local u, v = glint.fract(x), glint.fract(y)
  local across, up = WIDTH * glint.min(u, 1 - u), HEIGHT * glint.min(v, 1 - v)
  return glint.min(across, up), glint.hash(glint.floor(x), glint.floor(y), 0)
end

local function is_brick(p)
  local distance, number = lay(p)
  local ragged = distance + 0.012 * glint.noise(p * 14)
  return glint.smoothstep(0.4 * P.mortar, 0.8 * P.mortar, ragged), number
end

local color = glint.pattern(function(p)
  local brick, number = is_brick(p)
  local fired = glint.mix({ 0.55, 0.2, 0.12 }, { 0.35, 0.13, 0.1 }, number) * (1 + 0.25 * glint.noise(p * 9))
  return glint.mix({ 0.6, 0.58, 0.52 }, fired, brick)
end)

local relief = glint.pattern(function(p)
  local brick, number = is_brick(p)
  return P.height * (brick * (0.7 + 0.3 * number) + 0.12 * glint.noise(p * 11) + 0.06 * glint.noise(p * 25))
end)

local lamp = glint.point_light { position = { 0, 2.4, 1.2 }, intensity = 1.5, attenuation = { 0.6, 0.05, 0.06 } }

local ripples = glint.pattern(function(p) return 0.012 * glint.sin(26 * glint.length(p)) end)

local scene = glint.scene {
  camera = glint.camera { eye = { -2.2, 1.5, 4.4 }, at = { 0.1, 1, 0 }, fov = 40 },
  ambient = 0.1, background = "#14161b",
  lamp,
  glint.box {
    min = { -4, 0, -0.4 }, max = { 4, 2.6, 0 }, material = glint.material { diffuse = color, bump = relief },
  },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.35 } },
  glint.sphere {
    center = { 0, 0, 0 }, radius = 0.55, transform = glint.translate(1.2, 0.55, 1),
    material = glint.material {
      diffuse = { 0.1, 0.3, 0.35 }, specular = 0.8, shininess = 120, mirror = 0.2, bump = ripples,
    },
  },
}

return glint.animation {
  scene = scene, frames = 72, fps = 24, cyclic = true, width = 1280, height = 720, samples = 4,
  frame = function(t) lamp.position = { 2 * glint.sin(2 * math.pi * t), 1.9, 1.3 } end,
}
