-- A photometric set: one view under many lights, with the truth beside it, for photometric stereo and relighting.
--
-- Files, all linear, in the folder `photometric` (--set folder=...):
--     light_001.png ...    the scene under light 1, 2 ...: 16 bits, code = light * 65535; .pfm with --set exact=true
--     lights.csv           file, x, y, z (unit, from the scene to the light; x right, y up, z to the camera), intensity
--     mask.png             1 where an object is, 0 elsewhere (16 bits)
--     normal.png           normal * 0.5 + 0.5 in the same axes (16 bits), and normal.pfm: exact, 0 where nothing is
--     depth.png            nearest / distance (16 bits), and depth.pfm: the distance from the eye, inf where nothing is
-- Only the light changes. The engine keeps the hits when a second frame has read the same, so that from image 3 on a
-- picture costs light and shading (and shadows, unless --set shadows=false): --json shows "cast":"reused".
--     glint scripts/photometric.lua --set lights=96 --set shadows=false
--     glint scripts/photometric.lua --set specular=0.4          surfaces that are not matt
-- For a scene of your own put its shapes in place of `objects`; a camera along -z keeps the axes.
local glint = require "glint"

local P = glint.params {
  lights = { 24, min = 1, max = 999, doc = "directions of light" },
  spread = { 65, min = 1, max = 85, doc = "degrees from the camera's axis to the outermost light" },
  shadows = { true, doc = "do objects cast shadows on each other?" },
  specular = { 0, min = 0, max = 1, doc = "strength of a highlight; 0: matt surfaces" },
  exact = { false, doc = "write .pfm (float32) in place of 16-bit .png" },
  folder = { "photometric", doc = "where the files go" },
}

local function ball(x, y, z, radius, color)
  local paint = glint.material { diffuse = color, specular = P.specular, shininess = 40, ambient = 1 }
  return glint.sphere { center = { x, y, z }, radius = radius, material = paint }
end

local objects = {
  ball(0, 0, 0, 1.6, { 0.75, 0.72, 0.68 }), ball(1.5, 0.9, 0.9, 0.6, { 0.70, 0.25, 0.18 }),
  ball(-1.4, -0.8, 1.0, 0.7, { 0.22, 0.45, 0.65 }), ball(-0.7, 1.5, 0.6, 0.5, { 0.35, 0.55, 0.20 }),
}
local lamp = glint.directional_light { direction = { 0, 0, -1 }, shadows = P.shadows }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0, 10 }, at = { 0, 0, 0 }, projection = "orthographic", height = 4.6 },
  lamp, table.unpack(objects),
}
local SIZE = { width = 512, height = 512, bits = 16, transfer = "linear" }

-- Directions that cover a cap around the camera's axis evenly: a spiral of golden angles.
local function direction(k)
  local z = 1 - (k - 0.5) / P.lights * (1 - glint.cos(math.rad(P.spread)))
  local angle, r = k * math.pi * (3 - math.sqrt(5)), math.sqrt(1 - z * z)
  return r * glint.cos(angle), r * glint.sin(angle), z
end

local function path(name) return P.folder .. "/" .. name end

local rows = { "file,x,y,z,intensity\n" }
for k = 1, P.lights do
  local x, y, z = direction(k)
  local file = ("light_%03d.%s"):format(k, P.exact and "pfm" or "png")
  lamp.direction = { -x, -y, -z }
  SIZE.output = path(file)
  scene:render(SIZE)
  rows[#rows + 1] = ("%s,%.17g,%.17g,%.17g,%.17g\n"):format(file, x, y, z, lamp.intensity)
end

-- The truth: every material has ambient = 1, so that white ambient light alone shows where objects are.
scene:remove(lamp)
scene.ambient = 1
local truth = scene:render { width = SIZE.width, height = SIZE.height, passes = "normal,depth" }
if truth then -- not on a machine that has another part of the job
  assert(truth:save(path "mask.png", { bits = 16, transfer = "linear" }))
  for _, pass in ipairs { "normal", "depth" } do
    assert(truth:save(path(pass .. ".png"), { bits = 16, pass = pass }))
    assert(truth:save(path(pass .. ".pfm"), { pass = pass }))
  end
  local csv = assert(io.open(path "lights.csv", "w"))
  assert(csv:write(table.concat(rows)))
  assert(csv:close())
end
