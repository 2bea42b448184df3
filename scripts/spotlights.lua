-- Spot lights: point lights within a cone.
--
--     within `inner` of the axis     the whole light
--     between `inner` and `outer`    a smooth step, in the cosine of the angle
--     outside `outer`                none
-- and `exponent` makes the middle brighter than the rest: times cos^exponent of the angle, as the lobe of a real lamp.
-- The left spot has a hard edge (inner = outer), the middle one a soft edge, the right one an exponent. Where colours
-- overlap they add up, and the ball's shadows show each colour's absence: cyan, magenta, yellow.
--     glint scripts/spotlights.lua
--     glint scripts/spotlights.lua --set outer=16 --set exponent=200
--     glint scripts/spotlights.lua --set frames=48         the three swing over the floor
local glint = require "glint"

local P = glint.params {
  outer = { 13, min = 1, max = 60, doc = "half angle of the cones, degrees" },
  exponent = { 120, min = 0, max = 5000, doc = "exponent of the right spot" },
  frames = { 1, min = 1, max = 1000, whole = true, doc = "1 is a still; with more frames, the lights swing" },
}

local function spot(x, color, inner, exponent)
  return glint.spot_light {
    position = { x, 7, 2 }, direction = { -0.7 * x, -7, -2 }, color = color,
    inner = inner, outer = P.outer, exponent = exponent, name = color,
  }
end

local spots = {
  spot(-3.2, "red", P.outer, 0),
  spot(0, "lime", 0.4 * P.outer, 0),
  spot(3.2, "blue", P.outer, P.exponent),
}

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 5.2, 7.5 }, at = { 0, 0.2, -0.2 }, fov = 30 },
  ambient = 0.012,
  spots[1], spots[2], spots[3],
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.9 } },
  glint.sphere {
    center = { 0, 0.5, 0 }, radius = 0.5,
    material = glint.material { diffuse = 0.8, specular = 0.4, shininess = 80 },
  },
}

return glint.animation {
  scene = scene, frames = P.frames, cyclic = true, width = 1280, height = 720, samples = 4,
  frame = function(t)
    for i, light in ipairs(spots) do
      local swing = P.frames == 1 and 0 or 1.5 * glint.sin(2 * math.pi * (t + i / 3))
      light.direction = { -0.7 * light.x + swing, -7, -2 }
    end
  end,
}
