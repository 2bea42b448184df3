-- A ball with vectors, of which one starts behind it. `marks=false` leaves the overlays away.
local glint = require "glint"
local P = glint.params { marks = true, shininess = { 32, min = 1, max = 256 } }
local red = glint.material { diffuse = { 0.7, 0.2, 0.15 }, specular = 0.6, shininess = P.shininess }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0.5, 8 }, at = { 0, 0.5, 0 }, fov = 36 }, background = "#f4f1ea", ambient = 0.1,
  glint.point_light { position = { 5, 8, 5 } },
  glint.sphere { center = { 0, 0, 0 }, radius = 1, material = red },
}
if P.marks then
  scene:add(glint.arrow { hidden = "none", from = { 0, 0, -2 }, to = { 0, 2.5, -2 }, label = [[$\hat n$]], color = "#1d2228" })
  scene:add(glint.label { text = [[size 16, $k_s\,(\hat r\cdot\hat v)^n$]], at = { 0, 0 }, size = 16, color = "black" })
  scene:add(glint.lobe { point = { 0, 1, 0 }, normal = { 0, 1, 0 }, to_light = { 1, 1, 0 }, material = red, scale = 1.1 })
end
return glint.animation { scene = scene, frames = 1, width = 640, height = 400 }
