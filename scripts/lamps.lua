-- Visible lamps. A light is invisible unless `visible = true`; then the eye, mirrors and glass see its surface.
--
-- They see its radiance. With `radiance` L a lamp shows pi L color, the same as a white matt surface that is surrounded
-- by such a lamp. With `intensity` I it shows color I A(D), where D is its radius. A lamp that falls off as 1/d^2 then
-- has the brightness that matches its light from afar; a lamp without falloff is as bright as the white surface that
-- it lights. A lamp casts no shadow. A one-sided lamp is visible only from that side.
--     glint scripts/lamps.lua                              a ball, a panel and a window, in a mirror and through glass
--     glint scripts/lamps.lua --set visible=false          the same light, from nowhere
--     glint scripts/lamps.lua --passes background,mirror   lamps seen directly are in background, others in mirror
local glint = require "glint"

local P = glint.params { visible = { true, doc = "whether the lamps are seen" } }

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2.6, 11 }, at = { 0, 1.75, 0 }, fov = 33 },
  ambient = 0.12, background = "#0b0d12",
  -- A ball of radiance 0.4: it shows 0.4 pi = 1.26 times its colour.
  glint.sphere_light { position = { -2.3, 2.6, 1.2 }, radius = 0.35, radiance = 0.4, color = { 1, 0.85, 0.6 },
    samples = 9, visible = P.visible, name = "ball" },
  -- A panel that shines to one side. It is equally bright from all directions there, and invisible from behind.
  glint.disk_light { position = { 3.3, 3.2, -0.4 }, normal = { -1, -0.6, 0.5 }, radius = 0.7, radiance = 0.45,
    color = { 0.55, 0.75, 1 }, samples = 9, visible = P.visible, name = "panel" },
  -- A window in the plane of the back wall, set by intensity without falloff: it shows 0.3 times its colour.
  glint.polygon_light { vertices = { { -0.6, 2.3, -4 }, { 0.6, 2.3, -4 }, { 0.6, 3.7, -4 }, { -0.6, 3.7, -4 } },
    intensity = 0.3, color = { 1, 0.95, 0.85 }, samples = 9, visible = P.visible, name = "window" },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.5, mirror = 0.12 } },
  glint.plane { point = { 0, 0, -4 }, normal = { 0, 0, 1 },
    material = glint.material { diffuse = { 0.5, 0.44, 0.4 } } },
  glint.sphere { center = { 0.2, 1, -0.9 }, radius = 1, material = glint.material { diffuse = 0.05, mirror = 0.85 } },
  glint.sphere { center = { 2.1, 0.8, 0.9 }, radius = 0.8,
    material = glint.material { diffuse = 0, fresnel = true, transmission = 1, ior = 1.5 } },
  glint.sphere { center = { -2.2, 0.7, -0.8 }, radius = 0.7,
    material = glint.material { diffuse = { 0.75, 0.3, 0.16 }, specular = 0.3, shininess = 60 } },
}

scene:render { width = 720, height = 480, samples = 4, output = "lamps.png" }
