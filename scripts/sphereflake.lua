-- The sphereflake of the Standard Procedural Databases: 7381 spheres at size 4, 66430 at 5, 597871 at 6.
--     glint scripts/sphereflake.lua                              size 4: sphereflake.png
--     glint scripts/sphereflake.lua --set size=2 --set nff=balls.nff        and writes it as an NFF file
-- View, lights and colours are the published ones; the floor is a plane here, a polygon in the file.
local glint = require "glint"
local particles, sphereflake = require "glint.particles", require "glint.sphereflake"

local P = glint.params {
  size = { 4, min = 0, max = 7, whole = true, doc = "generations of smaller spheres on the first one" },
  nff = { "", doc = "an NFF file to write as well" },
}
local gold = glint.material { diffuse = { 0.5, 0.45, 0.35 }, specular = 0.5, shininess = 5 }
local set = particles.new { kinds = { ball = { material = gold } } }
sphereflake.each(P.size, function(x, y, z, radius) set:add("ball", x, y, z, radius) end)
if P.nff ~= "" then sphereflake.write_nff(P.nff, P.size, true) end
local scene = glint.scene { background = { 0.078, 0.361, 0.753 },
  camera = glint.camera { eye = { 2.1, 1.3, 1.7 }, at = { 0, 0, 0 }, up = { 0, 0, 1 }, fov = 45 } }
scene:add(glint.plane { point = { 0, 0, -0.5 }, normal = { 0, 0, 1 },
  material = glint.material { diffuse = { 0.8, 0.6, 0.264 } } })
scene:add(set:spheres())
for _, p in ipairs { { 4, 3, 2 }, { 1, -4, 4 }, { -3, 1, 5 } } do
  scene:add(glint.point_light { position = p, intensity = 1 / math.sqrt(3) })
end
scene:render { width = 512, height = 512, samples = 4, output = "sphereflake.png" }
