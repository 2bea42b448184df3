-- A board from one line: glint.checker of the point, seen under a lamp that circles above it.
--
-- The squares are a pattern, a function of the point that glint.pattern turns into a program: no quads, and no picture.
-- Towards the horizon a pixel is wider than a square; with the pixel's footprint as the checker's last argument the
-- squares fade to their mean there, at one sample a pixel. `--set filtered=false` leaves them sharp. Only the lamp
-- moves: `glint scripts/chessboard.lua --json` shows that the stage `pattern` runs only in the first frame.
--     glint scripts/chessboard.lua -o board.mp4
local glint = require "glint"

local P = glint.params {
  filtered = { true, doc = "show the mean of the squares that a pixel covers" },
  square = { 1, min = 0.1, max = 4, doc = "side of a square, world units" },
}

local light, dark <const> = { 0.85, 0.78, 0.62 }, { 0.12, 0.07, 0.05 }

local squares = glint.pattern(function(p, s)
  return glint.mix(light, dark, glint.checker(p / P.square, P.filtered and s.footprint / P.square or 0))
end)

-- Rings around the feet of the pieces: bands of the height, which move with each piece.
local function rings(color)
  return glint.pattern(function(p) return glint.mix(color, dark, glint.smoothstep(0.8, 1, glint.sin(14 * p.y))) end)
end

local board = glint.material { diffuse = squares, specular = 0.15, shininess = 60, name = "board" }
local white = glint.material { diffuse = rings { 0.9, 0.87, 0.78 }, specular = 0.4, shininess = 80 }
local black = glint.material { diffuse = rings { 0.16, 0.1, 0.09 }, specular = 0.5, shininess = 80 }

-- A pawn on the square whose corner is at x, z. Its material's pattern is in the pawn's own space.
local function pawn(x, z, material)
  return glint.group {
    transform = glint.translate(x + 0.5, 0, z + 0.5),
    glint.cone { base = { 0, 0, 0 }, top = { 0, 1.1, 0 }, radius = 0.36, material = material },
    glint.sphere { center = { 0, 0.95, 0 }, radius = 0.24, material = material },
    glint.cylinder { base = { 0, 0, 0 }, top = { 0, 0.14, 0 }, radius = 0.4, material = material },
  }
end

local lamp = glint.point_light { position = { 0, 3, 0 }, attenuation = { 0.4, 0.05, 0.03 }, intensity = 1.6 }

local scene = glint.scene {
  camera = glint.camera { eye = { -5.5, 3.4, 8.5 }, at = { 0, 0.2, -1 }, fov = 42 },
  ambient = 0.12, background = "#0d1016", depth_cue = { near = 12, far = 60 },
  lamp,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = board },
  pawn(-2, 1, white), pawn(0, 2, white), pawn(3, 0, white), pawn(-1, -2, black), pawn(1, -3, black), pawn(3, -2, black),
}

return glint.animation {
  scene = scene, frames = 96, fps = 24, cyclic = true, width = 1280, height = 720,
  frame = function(t) lamp.position = { 4 * glint.cos(2 * math.pi * t), 3, 4 * glint.sin(2 * math.pi * t) } end,
}
