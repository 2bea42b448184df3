-- A flight through an avenue of columns: eye, aim and lamp follow keys in time.
--     glint scripts/flight.lua -o flight.mp4
--     glint scripts/flight.lua --set ease=linear     # straight from key to key, with a corner at each
-- `ease = "spline"` passes through all keys with continuous speed. glint.ease moves a number smoothly.
local glint = require "glint"

local P = glint.params {
  frames = { 96, min = 2, max = 10000, whole = true, doc = "frames in the flight" },
  ease = { "spline", choices = { "spline", "smooth", "linear" }, doc = "how the camera goes from key to key" },
}

local stone = glint.material { diffuse = { 0.66, 0.62, 0.55 } }
local brass = glint.material { diffuse = { 0.5, 0.34, 0.12 }, specular = { 0.7, 0.55, 0.3 }, shininess = 60 }
local tiles = glint.pattern(function(p) return glint.mix(0.16, 0.42, glint.checker(p * 0.5)) end)
local floor = glint.material { diffuse = tiles }

-- ---- The flight: the eye's position and the point it looks at, for each time ----

local eye = glint.keys {
  { 0, { 0, 2, 22 } }, { 0.3, { -2.2, 1.2, 11 } }, { 0.55, { 2, 3.5, 3 } }, { 0.8, { -1, 2.6, -6 } },
  { 1, { 0, 5, -13 } }, ease = P.ease,
}
local at = glint.keys {
  { 0, { 0, 2.4, 0 } }, { 0.45, { 0, 2, -4 } }, { 0.75, { 0, 2.2, -16 } }, { 1, { 0, 2.5, -18 } }, ease = P.ease,
}

local lamp = glint.point_light { position = { 0, 6, 0 }, attenuation = { 1, 0, 0.006 } }
local camera = glint.camera { eye = eye(0), at = at(0), fov = 55 }
local scene = glint.scene {
  camera = camera, ambient = 0.12, background = { 0.05, 0.07, 0.12 }, lamp,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = floor },
  glint.sphere { center = { 0, 2.5, -18 }, radius = 2.5, material = brass },
}
for i = 0, 7 do
  for side = -1, 1, 2 do
    local x, z = 4 * side, 12 - 4 * i
    scene:add(glint.cylinder { base = { x, 0, z }, top = { x, 5, z }, radius = 0.55, material = stone })
    scene:add(glint.box { min = { x - 0.8, 5, z - 0.8 }, max = { x + 0.8, 5.6, z + 0.8 }, material = stone })
    scene:add(glint.sphere { center = { x, 6.1, z }, radius = 0.5, material = brass })
  end
end

return glint.animation {
  scene = scene, frames = P.frames, fps = 24,
  frame = function(t)
    camera.eye, camera.at = eye(t), at(t)
    local here = eye(t) -- the lamp flies ahead, with the ball
    lamp.position = { here.x * 0.5, 4.5, math.max(here.z - 5, -14) }
    lamp.intensity = glint.ease(t * 4) -- fades in during the first quarter
  end,
}
