-- A teapot as a cartoon: a mesh that is turned on a lathe, painted in three bands of light. `--outline black` inks it.
--
-- The bands are a shader of a few lines: how much of the light a cartoonist would paint, by n.l. The glaze is a pattern
-- in the pot's own space, so that it turns with the pot.
--     glint scripts/toon_teapot.lua -o teapot.mp4
local glint = require "glint"
local models = require "glint.models"

local P = glint.params {
  edge = { 0.01, min = 0, max = 0.5, doc = "how soft the edges of the bands are" },
  around = { 48, min = 8, max = 256, whole = true, doc = "faces around the pot" },
}

local glaze = glint.pattern(function(p)
  local wave = p.y - 0.06 * glint.sin(8 * glint.atan2(p.z, p.x))
  return glint.mix({ 0.78, 0.74, 0.6 }, { 0.1, 0.35, 0.6 }, glint.smoothstep(0.78, 0.8, wave))
end)

local china = glint.material { diffuse = glaze, specular = 0.6, shininess = 60, model = models.toon { edge = P.edge } }

-- Makes rings of points at(t, angle), t = 0 .. 1, joined by faces.
local function tube(rings, at)
  local vertices, faces, n = {}, {}, P.around
  for i = 0, rings do
    for k = 0, n - 1 do table.move(at(i / rings, 2 * math.pi * k / n), 1, 3, #vertices + 1, vertices) end
  end
  for i = 0, rings - 1 do
    for k = 0, n - 1 do
      local a, b = i * n + k + 1, i * n + (k + 1) % n + 1
      faces[#faces + 1] = { a, a + n, b + n, b }
    end
  end
  return glint.mesh { vertices = vertices, faces = faces, shading = "phong", material = china }
end

-- Radius and height of the body and its lid, from the foot to the knob.
local PROFILE <const> = {
  { 0.45, 0 }, { 0.5, 0.04 }, { 0.75, 0.25 }, { 0.88, 0.5 }, { 0.86, 0.75 }, { 0.7, 1 }, { 0.5, 1.12 }, { 0.46, 1.16 },
  { 0.4, 1.2 }, { 0.25, 1.27 }, { 0.1, 1.31 }, { 0.08, 1.36 }, { 0.13, 1.42 }, { 0.11, 1.5 }, { 0.001, 1.53 },
}

-- A Catmull-Rom curve through points.
local function curve(points, t)
  local x = t * (#points - 1)
  local i = math.min(math.floor(x), #points - 2)
  local f, out = x - i, {}
  local function point(k) return points[math.min(math.max(k, 1), #points)] end
  local a, b, c, d = point(i), point(i + 1), point(i + 2), point(i + 3)
  for k = 1, #b do
    local slope, bend, twist = c[k] - a[k], 2 * a[k] - 5 * b[k] + 4 * c[k] - d[k], 3 * (b[k] - c[k]) + d[k] - a[k]
    out[k] = b[k] + f / 2 * (slope + f * (bend + f * twist))
  end
  return out
end

local body = tube(96, function(t, angle)
  local at = curve(PROFILE, t)
  return { at[1] * glint.cos(angle), at[2], at[1] * glint.sin(angle) }
end)

-- Makes a pipe along a curve in the plane z = 0: x, y and radius of its points.
local function pipe(points, rings)
  return tube(rings, function(t, angle)
    local at = curve(points, t)
    local ahead, behind = curve(points, math.min(t + 1e-3, 1)), curve(points, math.max(t - 1e-3, 0))
    local side = glint.unit { behind[2] - ahead[2], ahead[1] - behind[1], 0 }
    local c, z = at[3] * glint.cos(angle), at[3] * glint.sin(angle)
    return { at[1] + c * side.x, at[2] + c * side.y, z }
  end)
end

local spout = pipe({ { 0.7, 0.4, 0.2 }, { 1.0, 0.5, 0.17 }, { 1.2, 0.8, 0.12 }, { 1.4, 1.1, 0.09 } }, 32)
local handle = pipe({
  { -0.72, 0.95, 0.08 }, { -1.1, 1, 0.08 }, { -1.35, 0.75, 0.08 }, { -1.15, 0.4, 0.08 }, { -0.8, 0.3, 0.08 },
}, 40)

local pot = glint.group { body, spout, handle }

local scene = glint.scene {
  camera = glint.camera { eye = { 0.6, 2.1, 5.2 }, at = { 0, 0.7, 0 }, fov = 34 },
  ambient = 0.2, background = "#f2ead8",
  glint.directional_light { direction = { -1, -1.6, -1.3 } },
  pot,
  glint.plane {
    point = { 0, 0, 0 }, normal = { 0, 1, 0 },
    material = glint.material { diffuse = { 0.72, 0.62, 0.45 }, model = models.toon {} },
  },
}

return glint.animation {
  scene = scene, frames = 96, fps = 24, cyclic = true, width = 1280, height = 720, samples = 9,
  frame = function(t) pot.transform = glint.rotate({ 0, 1, 0 }, 30 + 360 * t) end,
}
