-- A lamp circles over five spheres: watch the highlights wander and the shadows swing round.
--
-- An animation is a scene and a function of time. For each frame `frame(t)` sets what has changed, here one position,
-- and the engine renders the scene as it then is. t runs from 0 up to, but not including, 1 because the animation is
-- cyclic: frame 120 is one step before frame 1, so the film loops without a jerk.
--     glint scripts/moving_light.lua                      120 pictures, moving_light_0001.png ...
--     glint scripts/moving_light.lua --set radius=6       a tighter orbit
--     glint scripts/moving_light.lua -f 1-120:10          every tenth frame
--     glint scripts/moving_light.lua --shard 1/2          the first half; run 2/2 on another machine
-- Stop it at any time: the next run does not render finished frames again.
local glint = require "glint"

local P = glint.params {
  radius = { 13, min = 1, max = 40, doc = "orbit radius, world units" },
  height = { 15, min = 5, max = 60, doc = "height of the lamp over the ground" },
  frames = { 120, min = 1, max = 10000, whole = true, doc = "pictures in one turn" },
}

local function paint(r, g, b)
  return glint.material { diffuse = { r, g, b }, specular = 0.6, shininess = 90 }
end

local function ball(x, z, radius, material)
  return glint.sphere { center = { x, radius, z }, radius = radius, material = material }
end

local lamp = glint.point_light { position = { P.radius, P.height, 0 }, intensity = 0.95, color = { 1, 0.96, 0.88 } }

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 8.5, 22 }, at = { 0, 2.6, 0 }, fov = 38 },
  ambient = { 0.10, 0.11, 0.14 },
  background = "#1b2333",
  lamp,
  glint.plane {
    point = { 0, 0, 0 }, normal = { 0, 1, 0 },
    material = glint.material { diffuse = { 0.46, 0.44, 0.42 } },
  },
  ball(0, 0, 3.2, paint(0.72, 0.12, 0.10)),
  ball(6.2, 1.5, 1.9, paint(0.90, 0.60, 0.12)),
  ball(-6.0, 2.2, 2.2, paint(0.10, 0.36, 0.66)),
  ball(2.6, 6.0, 1.2, paint(0.20, 0.55, 0.24)),
  ball(-4.6, -7, 2.6, paint(0.52, 0.30, 0.62)),
}

-- glint.cos and glint.sin return the same bits on every machine, so that farms of different machines agree.
return glint.animation {
  orbit = true, -- the reader of a live figure may turn the view
  scene = scene, frames = P.frames, fps = 24, cyclic = true, width = 1280, height = 720, samples = 4,
  frame = function(t)
    local angle = 2 * math.pi * t
    lamp.position = { P.radius * glint.cos(angle), P.height, P.radius * glint.sin(angle) }
  end,
}
