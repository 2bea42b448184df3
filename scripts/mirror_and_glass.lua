-- Mirrors and glass add two terms to the local colour of a surface: mirror times the light along the mirrored ray, and
-- transmission times the light along the refracted ray.
--
--   glint scripts/mirror_and_glass.lua                        # a mirror, clear glass, green glass, and polished paint
--   glint scripts/mirror_and_glass.lua --set ior=1            # no bending, no reflection: the glass is hardly there
--   glint scripts/mirror_and_glass.lua --set max_depth=1      # glass is black where a ray ends inside it
--   glint scripts/mirror_and_glass.lua --passes mirror,transmission        # only the two terms
--   glint explain scripts/mirror_and_glass.lua                # the objects that use them
--
-- Look at: the world upside down in the clear ball, because it is a lens; its rim, which mirrors everything (Fresnel);
-- the coloured shadows of the glass, without the caustics of real glass; the green ball, darker where the path through
-- it is longer; the paint, which mirrors at grazing angles like glass.
local glint = require "glint"
local P = glint.params {
  ior = { 1.5, min = 1, max = 3, doc = "refractive index of the glass: water 1.33, glass 1.5, diamond 2.42" },
  max_depth = { 8, min = 0, max = 31, whole = true, doc = "longest chain of mirrors and refractions" },
  fresnel = { true, doc = "split the light at the glass as a dielectric does; false: let all of it through" },
}

local mirror = glint.material { name = "mirror", diffuse = 0.05, mirror = { 0.85, 0.86, 0.88 } }
local clear = glint.material {
  name = "clear glass", diffuse = 0, specular = 0.5, shininess = 400,
  transmission = 1, ior = P.ior, fresnel = P.fresnel,
}
local green = glint.material {
  name = "green glass", diffuse = 0, specular = 0.5, shininess = 400,
  transmission = 1, ior = P.ior, fresnel = P.fresnel, absorption = { 0.9, 0.15, 0.6 },
}
local paint = glint.material { name = "paint", diffuse = { 0.75, 0.09, 0.07 }, fresnel = true, ior = 1.6 }
local floor = glint.material { name = "floor", diffuse = { 0.62, 0.6, 0.56 }, ambient = 0.5 }

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2.6, 11 }, at = { 0, 0.85, 0 }, fov = 30 },
  ambient = 0.2,
  background = { 0.34, 0.45, 0.62 },
  glint.point_light { position = { -6, 9, 7 }, intensity = 0.75 },
  glint.directional_light { direction = { -0.7, -1, -0.2 }, intensity = 0.3 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = floor },
  glint.sphere { center = { -2.9, 1.2, -0.6 }, radius = 1.2, material = mirror },
  glint.sphere { center = { 0, 1.1, 1.6 }, radius = 1.1, material = clear },
  glint.sphere { center = { 2.5, 0.9, 1.1 }, radius = 0.9, material = green },
  glint.sphere { center = { 3.2, 1.3, -2.4 }, radius = 1.3, material = paint },
}
local function hue(angle) return 0.5 + 0.45 * glint.cos(angle) end
for i = 0, 11 do -- objects to see in them
  local angle = 2 * math.pi * i / 12
  scene:add(glint.sphere {
    center = { 5.2 * glint.cos(angle), 0.35, 5.2 * glint.sin(angle) - 1 },
    radius = 0.35,
    material = glint.material {
      diffuse = { hue(angle), hue(angle - 2.1), hue(angle + 2.1) },
      specular = 0.4,
    },
  })
end

scene:render { width = 960, height = 540, samples = 4, max_depth = P.max_depth, output = "mirror_and_glass.png" }
