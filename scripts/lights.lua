-- A still life under three lamps and a window, whose strengths and colours are chosen after it is rendered.
--
-- A light pass holds the contribution of one lamp to the picture, including mirrors and glass. Light is additive, so
-- other strengths and colours need no new rays: `glint relight` scales the passes and adds them. The window and the
-- sunlight through it are one group.
--     glint scripts/lights.lua --passes 'light:*' -o lights.exr       one file with all passes
--     glint relight lights.exr -o evening.png --light key=0 --light window=0.6 --light window=#ff9a4a --light rim=2
--     glint relight lights.exr -o mixer.html                          a page with a slider and a colour for each
local glint = require "glint"

local P = glint.params {
  lamp_samples = { 16, min = 1, max = 256, whole = true, doc = "sample points on each lamp with a surface" },
}

local function matt(color) return glint.material { diffuse = color } end
local function glossy(color) return glint.material { diffuse = color, specular = 0.5, shininess = 90 } end

local WALL <const>, FLOOR <const> = { 0.62, 0.6, 0.57 }, { 0.45, 0.36, 0.28 }
-- The window is a hole in the left wall, which consists of four boxes.
local function wall(min, max) return glint.box { min = min, max = max, material = matt(WALL) } end

local scene = glint.scene {
  camera = glint.camera { eye = { 1.2, 2.4, 9.5 }, at = { 0, 1.15, 0 }, fov = 32 },
  ambient = 0.05, background = "#10131a",
  -- The lamps of a portrait: the key from the right, the fill next to the camera, the rim light from behind.
  glint.disk_light { name = "key", position = { 4, 4.6, 3.4 }, normal = { -4, -3.4, -3.2 }, radius = 0.7,
    intensity = 0.75, color = { 1, 0.93, 0.82 }, samples = P.lamp_samples },
  glint.point_light { name = "fill", position = { -2, 3, 9 }, intensity = 0.14, color = { 0.8, 0.88, 1 },
    shadows = false },
  glint.spot_light { name = "rim", position = { 1.6, 4.8, -2.4 }, direction = { -1.4, -4, 2.2 }, inner = 20, outer = 40,
    intensity = 0.7 },
  -- The window: the sky in it, and the sunlight that enters.
  glint.polygon_light { name = "sky", group = "window", intensity = 0.35, color = { 0.62, 0.78, 1 }, visible = true,
    vertices = { { -3.6, 1.2, -0.9 }, { -3.6, 2.9, -0.9 }, { -3.6, 2.9, 1.1 }, { -3.6, 1.2, 1.1 } },
    samples = P.lamp_samples },
  glint.directional_light { name = "sun", group = "window", direction = { 1, -0.62, -0.18 }, intensity = 0.8,
    color = { 1, 0.86, 0.62 } },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 },
    material = glint.material { diffuse = FLOOR, mirror = 0.06 } },
  wall({ -8, 0, -3.2 }, { 8, 6, -3 }),
  wall({ -3.8, 0, -3 }, { -3.6, 1.2, 9 }), wall({ -3.8, 2.9, -3 }, { -3.6, 30, 9 }),
  wall({ -3.8, 1.2, -3 }, { -3.6, 2.9, -0.9 }), wall({ -3.8, 1.2, 1.1 }, { -3.6, 2.9, 9 }),
  glint.cylinder { base = { 0, 0, 0 }, top = { 0, 0.5, 0 }, radius = 1.25, material = matt { 0.7, 0.68, 0.64 } },
  glint.sphere { center = { 0, 1.3, 0 }, radius = 0.8, material = glossy { 0.72, 0.2, 0.14 } },
  glint.sphere { center = { -1.9, 0.6, 0.9 }, radius = 0.6,
    material = glint.material { diffuse = 0.04, mirror = 0.85 } },
  glint.sphere { center = { 1.6, 0.45, 1.5 }, radius = 0.45,
    material = glint.material { diffuse = 0, fresnel = true, transmission = { 0.95, 1, 0.97 }, ior = 1.5 } },
  glint.torus { center = { 2.2, 0.28, -0.7 }, axis = { 0, 1, 0 }, major = 0.62, minor = 0.28,
    material = glossy { 0.18, 0.42, 0.38 } },
}

scene:render { width = 1280, height = 720, samples = 4, output = "lights.png" }
