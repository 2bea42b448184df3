-- Inverse rendering: where is the lamp, how bright is it, and how shiny is the ball? glint.fit finds the five numbers
-- from a picture by Gauss-Newton steps. The passes d:NAME of each step are the derivatives of every pixel.
--
--     glint scripts/fit.lua -o 'fit/%02d.png'; glint sheet 'fit/##.png' -o fit.png --difference 1
--
-- The target is rendered from hidden numbers, or file=... names a .png or .pfm of this scene at the same size. Frame 1
-- is the target, the other frames are the steps. The script prints each number it finds with its uncertainty.
local glint = require "glint"
local fit = require "glint.fit"

local P = glint.params {
  file = { "", doc = "picture to fit, a .png or .pfm; none: a picture rendered from hidden numbers" },
  steps = { 20, min = 1, max = 100, whole = true, doc = "maximum number of steps" },
}

local NAMES = { "lamp_x", "lamp_y", "lamp_z", "intensity", "shininess" }
local HIDDEN = { 3.2, 4.1, 2.4, 1.6, 45 }
local START = { -- a lamp under the floor lights nothing, so its slopes would be 0
  { "lamp_x", -1, least = -20 }, { "lamp_y", 3, least = 0.5 }, { "lamp_z", 5, least = -20 },
  { "intensity", 1, least = 0.01 }, { "shininess", 12, least = 1 },
}
local WIDTH, HEIGHT = 160, 120

local lamp = glint.point_light { position = { 0, 1, 0 }, attenuation = { 1, 0, 0.02 } }
local shiny = glint.material { diffuse = { 0.5, 0.25, 0.1 }, specular = 0.6 }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 0.2, 0 }, fov = 32 }, ambient = 0.05, lamp,
  glint.sphere { center = { 0, 0, 0 }, radius = 1, material = shiny },
  glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.6 } },
}

-- Renders the picture for five numbers, variables or plain.
local function render(v, passes)
  lamp.position, lamp.intensity, shiny.shininess = { v.lamp_x, v.lamp_y, v.lamp_z }, v.intensity, v.shininess
  return scene:render { width = WIDTH, height = HEIGHT, passes = passes }
end

local function report(k, v, difference, damping)
  local words = {}
  for i, name in ipairs(NAMES) do words[i] = ("%s %.6g"):format(name, v[name]) end
  local line = "step %2d: error %.2e, damping %.0e: %s\n"
  io.stderr:write(line:format(k, difference, damping, table.concat(words, ", ")))
end

local hidden = {}
for i, name in ipairs(NAMES) do hidden[name] = HIDDEN[i] end
local made = render(hidden, "none")
if not made then error("fit.lua: do not use --frames or --shard, as all frames are needed", 0) end
local found = fit.run {
  target = P.file ~= "" and P.file or made, start = START, steps = P.steps, render = render, report = report,
}
for _, name in ipairs(NAMES) do
  print(("%s %.9g +- %.2g"):format(name, found.values[name], found.uncertainty[name]))
end
