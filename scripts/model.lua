-- A mesh from a file: .obj with the materials that it names, .stl or .ply. The camera shows all of it.
--     glint scripts/model.lua                                      a cottage: model.png
--     glint scripts/model.lua --set file=part.stl --set from=1,2,1 --set up=0,0,1
--     glint scripts/model.lua --set file=bunny.ply --set shading=phong
-- Faces have the Kd, Ks, Ns, d and map_Kd of their material; files of other kinds are grey.
local glint = require "glint"

local P = glint.params {
  file = { (arg[0]:match "^.*/" or "") .. "data/cottage.obj", doc = "a file .obj, .stl or .ply" },
  from = { "0.45,0.35,1", doc = "the direction from the mesh to the eye, x,y,z" },
  up = { "0,1,0", doc = "the direction that is up in the picture, x,y,z" },
  shading = { "", choices = { "", "faceted", "phong", "flat", "gouraud" }, doc = "none: phong if there are normals" },
}

local function vector(name)
  local x, y, z = P[name]:match "^%s*([^,%s]+)%s*,%s*([^,%s]+)%s*,%s*([^,%s]+)%s*$"
  x, y, z = tonumber(x), tonumber(y), tonumber(z)
  if not (x and y and z) then error(("%s: x,y,z expected, got %q"):format(name, P[name]), 0) end
  return glint.vector(x, y, z)
end

local mesh = glint.mesh { file = P.file, shading = P.shading ~= "" and P.shading or nil }
local low, high = glint.vector(mesh.min), glint.vector(mesh.max)
local center, from, up = (low + high) * 0.5, vector "from":unit(), vector "up"
local side = glint.cross(up, from):unit()
local sky = glint.cross(from, side) -- the upward direction of the picture

-- Finds the distance from the centre at which all eight corners of the mesh's box are in view.
local half, distance = glint.tan(math.rad(12.5)), 0
for i = 0, 7 do
  local x, y, z = i & 1 > 0 and low.x or high.x, i & 2 > 0 and low.y or high.y, i & 4 > 0 and low.z or high.z
  local away = glint.vector(x, y, z) - center
  local wide = math.max(math.abs(away:dot(sky)), math.abs(away:dot(side)) / 1.5)
  distance = math.max(distance, away:dot(from) + 1.05 * wide / half)
end
local camera = glint.camera { eye = center + from * distance, at = center, up = up, fov = 25 }
local scene = glint.scene {
  camera = camera, ambient = 0.28, background = "#cfdbe6", mesh,
  glint.directional_light { direction = -(from + sky * 1.6 - side * 1.2), intensity = 0.78 },
  glint.directional_light { direction = -(from + side * 2 + sky * 0.3), intensity = 0.15, shadows = false },
}
scene:render { width = 960, height = 640, samples = 16, output = "model.png" }
