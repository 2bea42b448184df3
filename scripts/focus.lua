-- A focus pull: a lens focuses on the balls of a row one after the other, and blurs everything nearer or farther.
--
-- A point at depth d becomes a disk 2 aperture |1 - d / focus| wide at that depth. In the picture, the disks of points
-- behind the focus grow up to a limit, reached at infinity; the disks of points in front of it grow without limit.
-- Lights out of focus take the shape of the lens: with `blades` a polygon, like the iris of a camera. The lights here
-- are balls that glow.
--     glint scripts/focus.lua -o film.mp4                     the focus goes from the nearest ball to the lights
--     glint scripts/focus.lua -f 12 --set aperture=0.05       a small lens: more is sharp
--     glint scripts/focus.lua -f 4 --set blades=5             lights become pentagons
--     glint scripts/focus.lua -f 4 --adaptive 0.05 --passes refined   samples go where the blur is
local glint = require "glint"

local P = glint.params {
  aperture = { 0.16, min = 0, max = 1, doc = "radius of the lens, world units" },
  projection = { "perspective", choices = { "perspective", "orthographic" }, doc = "orthographic: one lens per ray" },
  blades = { 6, min = 0, max = 64, whole = true, doc = "corners of the lens; 0: round" },
}

local EYE = { -1.6, 1.5, 8 }
local camera = glint.camera { eye = EYE, at = { 0.2, 0.85, 0 }, fov = 30, projection = P.projection,
  height = 5, aperture = P.aperture, blades = P.blades }
local scene = glint.scene { camera = camera, ambient = 0.16, background = "#0d1420",
  glint.point_light { position = { -6, 9, 9 }, intensity = 0.75 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { mirror = 0.08,
    diffuse = glint.pattern(function(p, s)
      return glint.mix({ 0.16, 0.13, 0.11 }, { 0.42, 0.36, 0.3 }, glint.checker(p * 1.6, 1.6 * s.footprint))
    end) } } }

-- A row of balls leading away from the eye to the right.
local balls = {}
for i, color in ipairs { "#d9594c", "#e08a3c", "#edc458", "#7fb35a", "#5a9fce", "#8f74c4" } do
  balls[i] = glint.sphere { center = { -3.05 + 0.95 * i, 0.5, 5.3 - 1.5 * i }, radius = 0.5,
    material = glint.material { diffuse = color, specular = 0.5, shininess = 90 } }
  scene:add(balls[i])
end

-- Lights far behind the balls.
for i = 0, 40 do
  local x, glow = -13 + 0.68 * i, ({ { 1, 0.75, 0.4 }, { 1, 0.45, 0.35 }, { 0.5, 0.75, 1 } })[i % 3 + 1]
  scene:add(glint.sphere { center = { x, 2.6 + 0.9 * glint.cos(0.55 * i) + 0.5 * (i % 2), -16 }, radius = 0.17,
    material = glint.material { diffuse = 0, ambient = 24 * glint.vector(glow) } })
end

-- The focus moves from the first ball to the last, rests at each, and ends at the lights.
local stops = {}
for i, ball in ipairs(balls) do
  stops[#stops + 1] = { (i - 1) / #balls, ball.center }
  stops[#stops + 1] = { (i - 0.6) / #balls, ball.center }
end
stops[#stops + 1] = { 1, { 0, 2, -16 } }
local focus = glint.keys(stops)

return glint.animation { scene = scene, frames = 48, fps = 24, width = 640, height = 400, samples = 64,
  frame = function(t) camera.focus = focus(t) end }
