-- Snell's law, as a figure: the path of a ray through a slab of glass, mirrored and refracted, as glint casts it.
--     glint scripts/snell.lua -o snell.png
--     glint scripts/snell.lua -o diamond.png --set ior=2.4
--     glint scripts/snell.lua -o inside.png --set side=inside --set angle=45    total reflection
local glint = require "glint"

local P = glint.params {
  angle = { 50, min = 1, max = 89, doc = "of the ray from the normal, degrees" },
  ior = { 1.5, min = 1, max = 4, doc = "index of refraction of the slab: water 1.33, glass 1.5, diamond 2.4" },
  side = { "outside", choices = { "outside", "inside" }, doc = "from where the ray comes" },
  depth = { 4, min = 1, max = 10, whole = true, doc = "number of surfaces at which a ray goes on" },
}

local ink, warm, cool = "#1d2228", "#b8420f", "#0b5fa5"
local glass = glint.material { model = "lambert", diffuse = 0, ambient = { 0.02, 0.05, 0.09 },
  transmission = { 0.72, 0.86, 0.94 }, fresnel = true, ior = P.ior }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, -0.35, 20 }, at = { 0, -0.35, 0 }, projection = "orthographic", height = 5 },
  ambient = 1, background = "#f7f5f0",
  glint.box { min = { -3.6, -1.5, -1 }, max = { 3.6, 0, 1 }, material = glass },
}

local outside = P.side == "outside"
local side, from, to = outside and 1 or -1, outside and 1 or P.ior, outside and P.ior or 1
local p, n = glint.vector(-1.2, 0, 0), glint.vector(0, side, 0)
local a = math.rad(P.angle)
local l = glint.vector(-glint.sin(a), side * glint.cos(a), 0)
local start = outside and 2.4 or 1.2
scene:add(glint.path { origin = p + start * l, direction = -l, depth = P.depth, reach = 2, width = 1.8, color = warm })
local function head(first, last) scene:add(glint.arrow { from = first, to = last, width = 1.8, color = warm }) end
head(p + start * l, p + 0.5 * start * l)
head(p, p + 1.1 * (-l):reflect(n))
scene:add(glint.line { from = p - 1.3 * n, to = p + 1.7 * n, color = ink, width = 1 })
scene:add(glint.arc { at = p, from = l, to = n, radius = 0.75, label = [[$\alpha$]], color = cool })
local law = outside and [[$\sin\alpha = n\,\sin\beta$]] or [[$n\,\sin\alpha = \sin\beta$]]
local sine = from / to * glint.sin(a)
if sine < 1 then
  local refracted = glint.vector(sine, -side * math.sqrt(1 - sine * sine), 0)
  head(p, p + 1.1 * refracted)
  scene:add(glint.arc { at = p, from = -n, to = refracted, radius = 0.75, label = [[$\beta$]], color = cool })
else
  law = "total reflection"
end
scene:add(glint.label { text = law, at = { 0.94, 0.08 }, color = ink })
scene:add(glint.label { text = ("$n = %g$"):format(P.ior), at_point = { -3.3, -0.5, 0 }, color = ink })

return glint.animation { scene = scene, frames = 1, width = 640, height = 360, samples = 1 }
