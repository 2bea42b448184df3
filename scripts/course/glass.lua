-- A ball of glass over a chessboard: what refraction makes of a picture.
local glint = require "glint"

local P = glint.params {
  ior = { 1.5, min = 1, max = 2.5, doc = "index of refraction" },
  fresnel = { true, doc = "share the light between mirror and glass by Fresnel's formula" },
}

local board = glint.pattern(function(p, s)
  return glint.mix({ 0.85, 0.8, 0.7 }, { 0.2, 0.12, 0.1 }, glint.checker(p, s.footprint))
end)
local glass = glint.material { diffuse = 0.02, specular = 0.5, shininess = 300, transmission = 1, ior = P.ior }
local red, blue = glint.material { diffuse = { 0.8, 0.2, 0.15 } }, glint.material { diffuse = { 0.15, 0.4, 0.75 } }
if P.fresnel then
  glass.fresnel, glass.mirror = true, 1
end
return glint.animation {
  orbit = true,
  scene = glint.scene {
    camera = glint.camera { eye = { 0, 2.6, 8 }, at = { 0, 0.9, 0 }, fov = 32 },
    ambient = 0.25, background = "#7f9fc0",
    glint.point_light { position = { 5, 9, 6 }, intensity = 0.8 },
    glint.plane { point = { 0, -0.001, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = board } },
    glint.sphere { center = { 0, 1.2, 0 }, radius = 1.2, material = glass },
    glint.sphere { center = { -2.4, 0.7, -1.5 }, radius = 0.7, material = red },
    glint.sphere { center = { 2.2, 0.6, -2 }, radius = 0.6, material = blue },
  },
  frames = 1, width = 640, height = 360, samples = 4,
}
