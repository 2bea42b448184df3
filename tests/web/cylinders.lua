-- Twenty cylinders in two rows in a BVH: the first two are mirror images.
local glint = require "glint"
local scene = glint.scene { camera = glint.camera { eye = { 0, 2, 22 }, at = { 0, 2.4, 0 }, fov = 55 }, ambient = 1 }
for i = 0, 19 do
  local x, z = 4 * (2 * (i % 2) - 1), 12 - 4 * (i // 2)
  scene:add(glint.cylinder { base = { x, 0, z }, top = { x, 5, z }, radius = 0.55 })
end
return scene
