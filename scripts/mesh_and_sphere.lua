-- A sphere made of triangles: the exact sphere on the left, then meshes of 8, 16 and 64 segments. The upper row has the
-- sphere's normals at the vertices ("phong"), the lower row has one normal per face ("faceted"). Smooth normals hide
-- the facets inside the outline, but the outline stays a polygon.
local glint = require "glint"

local clay = glint.material { diffuse = { 0.75, 0.45, 0.3 }, specular = 0.5, shininess = 60 }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0, 30 }, at = { 0, 0, 0 }, projection = "orthographic", height = 6 },
  ambient = 0.15, background = "#202530",
  glint.point_light { position = { -12, 16, 30 }, shadows = false },
}

for row, shading in ipairs { "phong", "faceted" } do
  local y = row == 1 and 1.45 or -1.45
  scene:add(glint.sphere { center = { -4.2, y, 0 }, radius = 1.25, material = clay })
  for i, segments in ipairs { 8, 16, 64 } do
    scene:add(glint.sphere_mesh {
      center = { 2.8 * i - 4.2, y, 0 }, radius = 1.25, segments = segments, shading = shading, material = clay,
      name = shading .. " " .. segments,
    })
  end
end

return glint.animation { scene = scene, frames = 1, width = 1280, height = 640, samples = 16 }
