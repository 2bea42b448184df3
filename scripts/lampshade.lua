-- Open cylinders and cones: with `capped = false` they have only a side, and the inside is visible.
--
-- The shade is an open cylinder around a bulb. Light leaves above and below, and lights the inside. The funnel is an
-- open cone, the mug an open cylinder with a disk as its bottom; the tin next to it is capped.
--     glint scripts/lampshade.lua
--     glint scripts/lampshade.lua --set capped=true        all of them closed: no light leaves the shade
local glint = require "glint"

local P = glint.params { capped = { false, doc = "whether shade, funnel and mug are closed" } }

local paper = glint.material { diffuse = { 0.85, 0.72, 0.5 } }
local clay = glint.material { diffuse = { 0.25, 0.42, 0.62 }, specular = 0.3, shininess = 40 }
local brass = glint.material { diffuse = { 0.6, 0.45, 0.2 }, specular = { 0.6, 0.5, 0.3 }, shininess = 80 }

local scene = glint.scene {
  camera = glint.camera { eye = { 1, 4.6, 9 }, at = { 0.35, 1.35, 0 }, fov = 32 },
  ambient = { 0.09, 0.1, 0.13 },
  glint.sphere_light { position = { -0.8, 2.5, 0 }, radius = 0.22, intensity = 1.3, attenuation = { 1, 0, 0.05 },
    color = { 1, 0.9, 0.75 }, samples = 16, visible = true },
  glint.directional_light { direction = { -2, -3, -2 }, intensity = 0.12, color = { 0.7, 0.8, 1 } },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.6 } },
  glint.plane { point = { 0, 0, -3 }, normal = { 0, 0, 1 },
    material = glint.material { diffuse = { 0.55, 0.5, 0.45 } } },
  -- the lamp: foot, pole and shade
  glint.cylinder { base = { -0.8, 0, 0 }, top = { -0.8, 2.25, 0 }, radius = 0.07, material = brass },
  glint.cylinder { base = { -0.8, 0, 0 }, top = { -0.8, 0.08, 0 }, radius = 0.5, material = brass },
  glint.cylinder { base = { -0.8, 2.05, 0 }, top = { -0.8, 3.05, 0 }, radius = 0.75, capped = P.capped,
    material = paper },
  -- a funnel, a mug and a tin
  glint.cone { base = { 1.0, 1.1, -0.9 }, top = { 1.0, 0, -0.9 }, radius = 0.7, capped = P.capped, material = clay },
  glint.cylinder { base = { 1.3, 0, 1 }, top = { 1.3, 1, 1 }, radius = 0.5, capped = P.capped, material = clay },
  glint.disk { center = { 1.3, 0.06, 1 }, normal = { 0, 1, 0 }, radius = 0.5, material = clay },
  glint.cylinder { base = { 2.5, 0, 0 }, top = { 2.5, 0.8, 0 }, radius = 0.5, material = clay },
}

scene:render { width = 720, height = 480, samples = 4, output = "lampshade.png" }
