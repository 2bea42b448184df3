-- Three ways to light a mesh: once per face, once per vertex, or once per sample. Each picture has a ball of a few
-- quadrangles on the left, and the sphere that it approximates on the right.
--
--     flat      one evaluation of lights, shadows and material at the middle of each face
--     Gouraud   one at each vertex, interpolated by barycentric coordinates
--     Phong     one for each sample, with a normal interpolated between the vertices
-- Above, the highlight is on a vertex: Gouraud shading spreads it over the adjacent faces, like a star. Below, the lamp
-- has moved by half a face: the highlight lies between the vertices, and Gouraud shading misses it. Phong shading shows
-- the sphere's highlight in both. The outline stays a polygon with any shading.
--     glint scripts/shading.lua                       shading_sheet.png, and each picture on its own
--     glint scripts/shading.lua --set segments=64     more vertices: the differences nearly vanish
local glint = require "glint"

local P = glint.params {
  segments = { 12, min = 4, max = 512, whole = true, doc = "faces around the equator; half as many from pole to pole" },
}

local clay = glint.material { diffuse = { 0.55, 0.3, 0.18 }, specular = 0.7, shininess = 40 }
local lamp = glint.directional_light { direction = { 0, 0, -1 }, shadows = false }
local ball = glint.sphere_mesh {
  center = { -1.3, 0, 0 }, radius = 1.15, segments = P.segments, material = clay, name = "ball",
}
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0, 10 }, at = { 0, 0, 0 }, projection = "orthographic", height = 2.8 },
  ambient = 0.12, background = "#202530",
  lamp, ball,
  glint.sphere { center = { 1.3, 0, 0 }, radius = 1.15, material = clay, name = "sphere" },
}

-- Lights the ball so that the highlight is `turn` faces around the pole and `fall` faces from it.
local function from(turn, fall)
  local around, down = 2 * math.pi * turn / P.segments, math.pi * fall / ((P.segments + 1) // 2)
  local n = { glint.sin(down) * glint.cos(around), glint.cos(down), glint.sin(down) * glint.sin(around) }
  return { -2 * n[3] * n[1], -2 * n[3] * n[2], 1 - 2 * n[3] * n[3] }
end

local column = P.segments // 4 + P.segments // 12
local row = (P.segments + 1) // 4 - P.segments // 12
local ON_A_VERTEX <const>, BETWEEN <const> = from(column, row), from(column - 0.5, row + 0.5)

return glint.sweep {
  scene = scene, width = 520, height = 280, samples = 16,
  over = { { ball, "shading", { "flat", "gouraud", "phong" } }, { lamp, "direction", { ON_A_VERTEX, BETWEEN } } },
  sheet = {
    title = "Lit once a face, once a vertex, once a sample",
    label = function(_, n)
      local shading = ({ "flat", "Gouraud", "Phong" })[(n - 1) % 3 + 1]
      return shading .. (n > 3 and ": the highlight is between vertices" or ": the highlight is on a vertex")
    end,
  },
}
