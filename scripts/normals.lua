-- Three ways to shade a mesh, as a figure: flat shading has one normal a face, Gouraud shading lights the corners and
-- blends the light, Phong shading blends the normals and lights each point.
--     glint scripts/normals.lua -o normals.png
--     glint scripts/normals.lua -o fine.png --set faces=12
local glint = require "glint"

local P = glint.params {
  faces = { 4, min = 2, max = 24, whole = true, doc = "of each arch" },
  shininess = { 60, min = 1, max = 200, doc = "of the highlight" },
}

local ink, warm, pale = "#1d2228", "#b8420f", "#d99a78"
local SPAN, DEPTH, APART, ARROW = 54, 0.8, 2.5, 0.42
local clay = glint.material { model = "blinn_phong", diffuse = { 0.30, 0.42, 0.55 }, specular = 0.7,
  shininess = P.shininess }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 5.1, 12 }, at = { 0, 0.6, 0 }, projection = "orthographic", height = 2.9 },
  ambient = 0.25, background = "#f7f5f0",
  glint.directional_light { direction = { 0.45, -1, 1.2 }, intensity = 0.9, shadows = false },
}

-- Returns the unit normal of the round arch that the faces approximate, at a fraction of its span.
local function normal_at(share)
  local a = math.rad((2 * share - 1) * SPAN)
  return glint.vector(glint.sin(a), glint.cos(a), 0)
end

local function arch(x, shading)
  local vertices, normals, faces = {}, {}, {}
  for i = 0, P.faces do
    local n = normal_at(i / P.faces)
    for _, z in ipairs { -DEPTH, DEPTH } do
      vertices[#vertices + 1] = { x + n.x, n.y, z }
      normals[#normals + 1] = { n.x, n.y, 0 }
    end
    local k = 2 * i
    if i > 0 then faces[#faces + 1] = { k - 1, k, k + 2, k + 1 } end
  end
  scene:add(glint.mesh { vertices = vertices, normals = normals, faces = faces, shading = shading, material = clay })
end

-- Draws the normal of the share of an arch at x; the point is on the face below.
local function normal(x, share, n, color, length)
  local at, i = share * P.faces, math.min(math.floor(share * P.faces), P.faces - 1)
  local a, b = normal_at(i / P.faces), normal_at((i + 1) / P.faces)
  local p = glint.vector(x, 0, 0) + a + (at - i) * (b - a)
  scene:add(glint.arrow { from = p, to = p + length * n, color = color })
end

local function title(x, text)
  local left, right = { x - 0.9, -0.1, DEPTH }, { x + 0.9, -0.1, DEPTH }
  scene:add(glint.line { from = left, to = right, label = text, color = ink, width = 0.5 })
end

arch(-APART, "flat")
arch(0, "gouraud")
arch(APART, "phong")
for i = 0, P.faces do
  local share, middle = i / P.faces, (i + 0.5) / P.faces
  if i < P.faces then
    normal(-APART, middle, normal_at(middle), warm, ARROW)
    for k = 1, 2 do normal(APART, (i + k / 3) / P.faces, normal_at((i + k / 3) / P.faces), pale, 0.75 * ARROW) end
  end
  normal(0, share, normal_at(share), warm, ARROW)
  normal(APART, share, normal_at(share), warm, ARROW)
end
title(-APART, "flat: each face")
title(0, "Gouraud: each corner")
title(APART, "Phong: each point")

return glint.animation { scene = scene, frames = 1, width = 640, height = 240, samples = 16 }
