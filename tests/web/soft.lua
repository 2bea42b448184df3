-- A soft shadow and indirect light: each sample of a pixel differs.
local glint = require "glint"
local P = glint.params { height = { 8, min = 4, max = 12 } }
return glint.animation { width = 320, height = 180, samples = 6, frames = 1, scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 0.8, 0 } }, ambient = 0.1, indirect = { samples = 6 },
  glint.sphere_light { position = { 3, P.height, 4 }, radius = 1, samples = 8 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } }, glint.sphere { center = { 0, 1, 0 }, radius = 1 } } }
