-- The workshop: five spheres, one lamp, and the lighting equation one term at a time.
--
-- Every pixel is the sum of three terms:
--     ambient    what a surface shows where no lamp reaches it:  ka * Ia
--     diffuse    matt light, by the angle between normal n and the direction to the lamp l:  kd * Id * (n.l)
--     specular   the highlight, by the angle between the mirrored light r and the eye v:  ks * Is * (r.v)^shininess
-- Look at a single term, then at their sum:
--     glint scripts/workshop.lua --set step=ambient
--     glint scripts/workshop.lua --set step=diffuse
--     glint scripts/workshop.lua --set step=specular
--     glint scripts/workshop.lua
--     glint scripts/workshop.lua --set frames=48
--     glint scripts/workshop.lua --set radius=2
-- A term is switched off by black reflectances, and the engine then does not compute it at all: see `glint explain`.
local glint = require "glint"

local P = glint.params {
  step = { "all", choices = { "ambient", "diffuse", "specular", "all" }, doc = "which term of the lighting to show" },
  shininess = { 128, min = 0, max = 2000, doc = "exponent of the highlight: higher is smaller and sharper" },
  shadows = { true, doc = "does the lamp cast shadows?" },
  radius = { 0, min = 0, max = 5, doc = "radius of the lamp: 0 is a point with hard shadows, 2 gives soft shadows" },
  frames = { 1, min = 1, max = 10000, whole = true,
    doc = "1 is a still; with more frames, the lamp swings from side to side" },
}

-- Returns 1 if the term is part of the chosen step, else 0.
local function shown(term)
  return (P.step == "all" or P.step == term) and 1 or 0
end

local function paint(r, g, b, gloss)
  local diffuse, specular = shown "diffuse", shown "specular" * gloss
  local ambient = shown "ambient"
  return glint.material {
    ambient = { r * ambient, g * ambient, b * ambient },
    diffuse = { r * diffuse, g * diffuse, b * diffuse },
    specular = { specular, specular, specular },
    shininess = P.shininess,
  }
end

-- Makes a ball that rests on the ground, at (x, z).
local function ball(x, z, radius, material)
  return glint.sphere { center = { x, radius, z }, radius = radius, material = material }
end

local lamp = glint.sphere_light { position = { 0, 20, 0 }, radius = P.radius, shadows = P.shadows, name = "lamp" }

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 6.2, 20.5 }, at = { 0, 3.8, 0 }, fov = 42 },
  ambient = { 0.16, 0.17, 0.20 },
  background = P.step == "all" and "#8fb3d9" or 0, -- a single term is easier to judge on black
  lamp,
  glint.sphere { center = { 0, -10000, 0 }, radius = 10000, material = paint(0.42, 0.40, 0.37, 0), name = "ground" },
  ball(-1.0, -4.5, 4.0, paint(0.70, 0.10, 0.08, 0.7)),
  ball(5.8, -1.0, 3.0, paint(0.85, 0.55, 0.10, 0.7)),
  ball(-6.6, 0.5, 2.5, paint(0.10, 0.35, 0.62, 0.7)),
  ball(0.6, 4.2, 2.0, paint(0.16, 0.48, 0.20, 0.7)),
}

return glint.animation {
  scene = scene, frames = P.frames, cyclic = true, width = 1920, height = 1080, samples = 4,
  frame = function(t)
    lamp.x = 8 * glint.sin(2 * math.pi * t) -- 0 in the still: straight above
  end,
}
