-- A mesh with the colours of a scan. The script writes a binary .ply whose vertices have red, green and blue, and shows
-- it. The colour of a face is the mean of its corners' colours.
--     glint scripts/scan.lua                                       a boulder with moss: scan.png, and scan.ply
--     glint scripts/scan.lua --set rows=160                        smaller faces
local glint = require "glint"

local P = glint.params {
  rows = { 80, min = 3, max = 1000, whole = true, doc = "faces from pole to pole" },
  file = { "scan.ply", doc = "the .ply file to write" },
}

-- Returns the distance of the surface in a direction, and its colour there.
local shape = glint.pattern(function(p)
  return 1 + 0.16 * glint.noise(p * 2.1) + 0.06 * glint.noise(p * 5.3) + 0.02 * glint.noise(p * 13)
end)
local paint = glint.pattern(function(p)
  local stone = glint.mix({ 0.30, 0.27, 0.25 }, { 0.62, 0.58, 0.52 }, glint.clamp(0.5 + 1.2 * glint.noise(p * 6), 0, 1))
  local moss = glint.mix({ 0.09, 0.20, 0.04 }, { 0.30, 0.42, 0.08 }, glint.clamp(0.5 + glint.noise(p * 17), 0, 1))
  return glint.mix(stone, moss, glint.smoothstep(0.05, 0.45, p.y * 0.9 + 0.6 * glint.noise(p * 3)))
end)

local function code(light) -- sRGB, as scanners write it
  local v = light <= 0.0031308 and 12.92 * light or 1.055 * light ^ (1 / 2.4) - 0.055
  return math.floor(255 * math.min(math.max(v, 0), 1) + 0.5)
end

local rows, columns = P.rows, 2 * P.rows
local vertices, faces = {}, {}
for row = 0, rows do
  for column = 0, columns - 1 do
    local up, around = math.pi * (row / rows - 0.5), 2 * math.pi * column / columns
    local d = glint.vector(math.cos(up) * math.sin(around), math.sin(up), math.cos(up) * math.cos(around))
    local p = d * shape:evaluate { p = d }
    local color = glint.vector(paint:evaluate { p = p })
    vertices[#vertices + 1] = ("<fffBBB"):pack(p.x, p.y, p.z, code(color.x), code(color.y), code(color.z))
  end
end
for row = 0, rows - 1 do
  for column = 0, columns - 1 do
    local a, b = row * columns + column, row * columns + (column + 1) % columns
    if row > 0 then faces[#faces + 1] = ("<BI4I4I4"):pack(3, a, b, b + columns) end
    if row < rows - 1 then faces[#faces + 1] = ("<BI4I4I4"):pack(3, a, b + columns, a + columns) end
  end
end

local out <close> = assert(io.open(P.file, "wb"))
assert(out:write("ply\nformat binary_little_endian 1.0\nelement vertex ", #vertices,
  "\nproperty float x\nproperty float y\nproperty float z\n",
  "property uchar red\nproperty uchar green\nproperty uchar blue\n",
  "element face ", #faces, "\nproperty list uchar uint vertex_indices\nend_header\n",
  table.concat(vertices), table.concat(faces)))
assert(out:flush())

local scene = glint.scene {
  camera = glint.camera { eye = { 1.2, 1.5, 3.6 }, at = { 0, 0.02, 0 }, fov = 32 },
  ambient = 0.22, background = "#a9c0d2",
  glint.directional_light { direction = { -1, -1.3, -0.6 }, intensity = 0.95 },
  glint.plane { point = { 0, -0.85, 0 }, normal = { 0, 1, 0 },
    material = glint.material { diffuse = { 0.42, 0.36, 0.27 } } },
  glint.mesh { file = P.file, shading = "phong" },
}
scene:render { width = 640, height = 400, samples = 16, output = "scan.png" }
