-- A ball, a lamp that the reader can move, and a view that turns: for tests/web/element.mjs.
local glint = require "glint"
local P = glint.params {
  lamp = { { 1.5, 2, 2 }, drag = true, label = "Lamp", doc = "position of the lamp" },
  shininess = { 32, min = 1, max = 256, label = "$n$, exponent", doc = "larger: a smaller highlight of $(\\hat{r} \\cdot \\hat{v})^n$" },
  tilt = { 20, min = 0, max = 90, unit = "°", doc = "angle of the plate" },
  height = { 1, min = 0.5, max = 2, unit = "m" },
  model = { "phong", choices = { "phong", "blinn_phong" }, names = { blinn_phong = "Blinn-Phong" } },
  floor = { true, doc = "shows the floor" },
}
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 9 }, at = { 0, 0.5, 0 }, fov = 35 }, ambient = 0.2, background = "#203040",
  glint.point_light { position = P.lamp },
  glint.sphere { center = { 0, P.height, 0 }, radius = 1,
    material = glint.material { diffuse = { 0.7, 0.2, 0.2 }, specular = 0.6, shininess = P.shininess, model = P.model } },
  glint.box { min = { 1.5, 0, -0.5 }, max = { 2.5, 0.2, 0.5 }, transform = glint.rotate("z", P.tilt) },
}
if P.floor then scene:add(glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } }) end
return glint.animation { scene = scene, width = 320, height = 200, frames = 1, orbit = true }
