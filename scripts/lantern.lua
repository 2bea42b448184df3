-- A lantern that turns: light through holes that a function cuts.
--
-- The shell is one sphere. Where its material's opacity is below one half, the sphere is cut out. The eye looks
-- through the holes at the far side of the shell, and the lamp in the middle shines through them on the floor and the
-- walls. The function uses s.uv to lay staggered rows of dots, except near the poles, where circles of latitude
-- shrink. `--set dots=40 --set rows=21` makes small holes.
--     glint scripts/lantern.lua -o lantern.mp4
local glint = require "glint"

local P = glint.params {
  dots = { 20, min = 4, max = 60, whole = true, doc = "dots around the lantern" },
  rows = { 11, min = 3, max = 31, whole = true, doc = "rows from pole to pole" },
  size = { 0.36, min = 0.05, max = 0.5, doc = "radius of a dot, in rows" },
  frames = { 24, min = 1, max = 240, whole = true, doc = "frames of a turn" },
}

local shell = glint.pattern(function(_, s)
  local across, up = s.uv.u * P.dots, s.uv.v * P.rows
  across = across + 0.5 * glint.mod(glint.floor(up), 2) -- shifts every other row by half a dot
  local x, y = glint.fract(across) - 0.5, glint.fract(up) - 0.5
  local around = glint.sin(math.pi * s.uv.v) -- circumference relative to the equator
  x = x * around * (2 * P.rows / P.dots)
  local hole = glint.less(x * x + y * y, P.size * P.size)
  return 1 - hole * glint.less(0.45, around)
end)

local lantern = glint.sphere {
  center = { 0, 0, 0 }, radius = 1,
  material = glint.material { diffuse = { 0.75, 0.3, 0.12 }, specular = 0.3, shininess = 40, opacity = shell },
}
local brass = glint.material { diffuse = { 0.5, 0.35, 0.12 }, specular = 0.6, shininess = 60 }
local white = glint.material { diffuse = { 0.85, 0.8, 0.72 } }
local warm <const> = { 1, 0.8, 0.55 }

local scene = glint.scene {
  camera = glint.camera { eye = { 1.2, 2.6, 7.5 }, at = { 0, 1.35, 0 }, fov = 38 },
  ambient = { 0.05, 0.05, 0.07 },
  glint.point_light { position = { 0, 1.4, 0 }, color = warm, intensity = 1.4, attenuation = { 0.4, 0, 0.06 } },
  glint.directional_light { direction = { -1, -2, -2 }, color = { 0.5, 0.6, 0.9 }, intensity = 0.12 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = white },
  glint.plane { point = { 0, 0, -3 }, normal = { 0, 0, 1 }, material = white },
  glint.plane { point = { -4, 0, 0 }, normal = { 1, 0, 0 }, material = white },
  glint.cylinder { base = { 0, 0, 0 }, top = { 0, 0.42, 0 }, radius = 0.35, material = brass },
}
local turning = glint.group { lantern }
scene:add(turning)

return glint.animation {
  scene = scene, frames = P.frames, cyclic = true, samples = 4, output = "lantern_%04d.png",
  frame = function(t) turning.transform = glint.translate(0, 1.4, 0) * glint.rotate("y", 360 / P.dots * t) end,
}
