-- Three spheres on a plane, and a lamp that goes around them.
--
--     glint @NAME@                      every frame, as pictures
--     glint @NAME@ --frames 1           only the first one
--     glint @NAME@ --set radius=4       another value of a parameter
--     glint @NAME@ -o film.png --apng   a film; .mp4, .webm and .gif need ffmpeg
local glint = require "glint"

-- Parameters can be set from the command line; --help lists them.
local P = glint.params {
  radius = { 8, min = 1, max = 40, doc = "radius of the lamp's orbit, world units" },
  frames = { 48, min = 1, max = 1000, doc = "frames in one turn of the lamp" },
}

-- Colours are {r, g, b} or one number, linear; or "#rrggbb" and CSS names.
local red = glint.material { diffuse = "#d9594c", specular = 0.6, shininess = 64 }
local blue = glint.material { diffuse = "#5a9fce", specular = 0.3, shininess = 16, model = "blinn_phong" }
local chalk = glint.material { diffuse = 0.75 }

local lamp = glint.point_light { position = { 0, 8, 8 }, name = "lamp" }

local scene = glint.scene {
  camera = glint.camera { eye = { 0, 4, 14 }, at = { 0, 1.4, 0 }, fov = 35 },
  ambient = 0.12,
  background = "#202838",
  lamp,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = chalk },
  glint.sphere { center = { 0, 2, 0 }, radius = 2, material = red },
  glint.sphere { center = { 3.4, 1.2, 1 }, radius = 1.2, material = blue },
  glint.sphere { center = { -3, 1, 1.6 }, radius = 1, material = chalk },
}

-- `frame` sets the scene to one moment: t goes from 0 to 1, here around once.
return glint.animation {
  scene = scene, frames = P.frames, fps = 24, cyclic = true, width = 640, height = 360, samples = 4,
  frame = function(t)
    local angle = 2 * math.pi * t
    lamp.position = { P.radius * glint.sin(angle), 8, P.radius * glint.cos(angle) }
  end,
}
