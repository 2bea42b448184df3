-- tests/povray.sh renders this and compares it with POV-Ray's picture of the same numbers.
local glint = require "glint"
local P = glint.params {
  model = { "phong", choices = { "phong", "blinn_phong" } },
  light = { "point", choices = { "point", "directional" } },
  projection = { "perspective", choices = { "perspective", "orthographic" } },
}
local w = dofile "tests/povray/workshop.lua"

local light
if P.light == "point" then
  light = glint.point_light { position = w.light.position, color = w.light.color }
else
  light = glint.directional_light { direction = w.light.direction, color = w.light.color }
end

local camera = { eye = w.eye, at = w.at, projection = P.projection }
if P.projection == "perspective" then
  camera.fov = w.fov
else
  camera.height = w.height
end

local scene = glint.scene { camera = glint.camera(camera), ambient = 1, background = w.background, light }
for _, sphere in ipairs(w.spheres) do
  local center, radius, c = sphere[1], sphere[2], sphere[3]
  scene:add(glint.sphere {
    center = center, radius = radius,
    material = glint.material {
      model = P.model, shininess = w.shininess, specular = w.specular,
      ambient = { w.ambient * c[1], w.ambient * c[2], w.ambient * c[3] },
      diffuse = { w.diffuse * c[1], w.diffuse * c[2], w.diffuse * c[3] },
    },
  })
end
scene:render { width = 1280, height = 720, bits = 16, transfer = "linear" }
