-- The vectors at a point of a ball: n away from the surface, l to the light, v to the viewer, r the mirrored light and
-- h halfway between l and v. The highlight on the ball is the one that the viewer at v would see.
local glint = require "glint"

local P = glint.params {
  light = { 35, min = 0, max = 90, unit = "°", doc = "angle between n and l" },
  viewer = { 55, min = 0, max = 90, unit = "°", doc = "angle between n and v, on the other side" },
  shininess = { 40, min = 1, max = 400, doc = "exponent of the highlight" },
  model = { "phong", choices = { "phong", "blinn_phong" }, doc = "(r.v)^n or (n.h)^n" },
}

local radius = 2
local function at_angle(degrees) -- returns a unit vector in the plane of the drawing, from straight up
  local a = math.rad(degrees)
  return glint.vector(glint.sin(a), glint.cos(a), 0)
end
local n, l, v, r = at_angle(0), at_angle(-P.light), at_angle(P.viewer), at_angle(P.light)
local h = at_angle((P.viewer - P.light) / 2)

-- The model as the fixed viewer at v sees it, since the camera of this figure is elsewhere.
local seen_from_v = glint.shader(function(s)
  local cosine = s.n:dot(s.l)
  local reflected = 2 * cosine * s.n - s.l
  local half = (s.l + v):unit()
  local highlight = P.model == "phong" and reflected:dot(v) or s.n:dot(half)
  return s.light * (s.kd * cosine + s.ks * glint.max(highlight, 0) ^ P.shininess)
end)
local clay = glint.material { diffuse = { 0.25, 0.35, 0.5 }, specular = 0.8, model = seen_from_v }

local scene = glint.scene {
  camera = glint.camera { eye = { 2.5, 5.5, 12 }, at = { 0, 1.6, 0 }, fov = 27 },
  ambient = 0.25, background = "#10141c",
  glint.directional_light { direction = -l, shadows = false },
  glint.sphere { center = { 0, 0, 0 }, radius = radius, material = clay },
}

local function arrow(direction, length, color)
  local from = radius * n
  local tip = from + length * direction
  local paint = glint.material { diffuse = 0, ambient = 4 * glint.vector(color) } -- times the scene's ambient, 1/4
  scene:add(glint.cylinder { base = from, top = from + (length - 0.3) * direction, radius = 0.04, material = paint })
  scene:add(glint.cone { base = from + (length - 0.3) * direction, top = tip, radius = 0.12, material = paint })
end
arrow(n, 1.9, { 0.9, 0.9, 0.9 })
arrow(l, 2.3, { 0.95, 0.75, 0.1 })
arrow(v, 2.3, { 0.2, 0.55, 0.95 })
if P.model == "phong" then
  arrow(r, 2.0, { 0.9, 0.2, 0.15 })
else
  arrow(h, 2.0, { 0.2, 0.75, 0.3 })
end
return glint.animation { scene = scene, frames = 1, width = 640, height = 400, samples = 4 }
