-- Motion blur by an open shutter: balls on three orbits, the inner ones faster, and a lamp that circles above.
--     glint scripts/shutter.lua -o shutter.mp4
--     glint scripts/shutter.lua -f 1 --set shutter=0                # an instant
--     glint scripts/shutter.lua -f 1 --set shutter=1 --set times=64 # a whole frame's time, finely
--     glint scripts/shutter.lua -f 1 --set moves=lamp               # blurs only shadows: the rest is computed once
-- `camera.shutter` is a share of the time from one frame to the next. The engine calls `frame(t)` at `shutter_times`
-- times within it, and the picture is the mean of their light.
local glint = require "glint"

local P = glint.params {
  frames = { 40, min = 1, max = 10000, whole = true, doc = "frames in one turn of the outer ball" },
  shutter = { 0.8, min = 0, max = 1, doc = "how long the shutter is open, as a share of a frame's time" },
  times = { 16, min = 1, max = 1024, whole = true, doc = "times shown while the shutter is open" },
  moves = { "all", choices = { "all", "lamp" }, doc = "what moves" },
}

local camera = glint.camera {
  eye = { 0, 6.6, 11 }, at = { 0, 0.7, 0 }, fov = 46, shutter = P.shutter, shutter_times = P.times,
}
local lamp = glint.sphere_light {
  position = { 0, 6, 0 }, radius = 0.16, intensity = 0.9, color = { 1, 0.93, 0.8 }, shadow = "hard",
  attenuation = { 1, 0, 0.004 }, visible = P.moves == "all",
}
local scene = glint.scene {
  camera = camera, ambient = 0.12, background = { 0.02, 0.025, 0.04 }, lamp,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 },
    material = glint.material { diffuse = { 0.55, 0.52, 0.48 } } },
  glint.sphere { center = { 0, 1.1, 0 }, radius = 1.1,
    material = glint.material { diffuse = { 0.62, 0.6, 0.56 }, specular = 0.5, shininess = 90 } },
}

-- For each ball: the orbit's radius, the turns per turn of the outer ball, the ball's radius and colour.
local orbits = {
  { 2.3, 3, 0.45, { 0.78, 0.2, 0.14 } },
  { 3.6, 2, 0.55, { 0.85, 0.6, 0.12 } },
  { 5.1, 1, 0.7, { 0.14, 0.36, 0.7 } },
}
local balls = {}
for i, orbit in ipairs(orbits) do
  balls[i] = glint.sphere { center = { orbit[1], orbit[3], 0 }, radius = orbit[3],
    material = glint.material { diffuse = orbit[4], specular = 0.6, shininess = 80 } }
  scene:add(balls[i])
end

local function place(radius, height, turns, t)
  local angle = 2 * math.pi * turns * t
  return { radius * glint.cos(angle), height, radius * glint.sin(angle) }
end

return glint.animation {
  scene = scene, frames = P.frames, fps = 24, cyclic = true,
  frame = function(t)
    lamp.position = place(3, 4.6, -2, t + 0.92)
    for i, orbit in ipairs(orbits) do
      balls[i].center = place(orbit[1], orbit[3], orbit[2], P.moves == "all" and t + 0.3 * i or 0.3 * i)
    end
  end,
}
