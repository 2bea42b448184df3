-- Annotations: a title, the time, a colour bar and the axes, drawn over the picture.
--     glint scripts/labels.lua -o film.mp4
--     glint scripts/labels.lua -f 1 --size 2400x1500 --dpi 300 --set size=9    letters of 9 points in print
--     glint scripts/labels.lua -f 1 --set map=coolwarm
-- A wave runs through a lattice of balls. The colour of each ball shows its displacement.
local glint = require "glint"

local P = glint.params {
  map = { "viridis", choices = { "viridis", "magma", "cividis", "turbo", "coolwarm" }, doc = "colour map" },
  size = { 0, min = 0, max = 100, doc = "size of the letters, points; 0: by the picture's height" },
  side = { 15, min = 2, max = 60, whole = true, doc = "balls along a side" },
}

local HEIGHT, COLORS = 1.2, 64
local size = P.size > 0 and P.size or nil
local heat = glint.colormap(P.map, -HEIGHT, HEIGHT)
local materials, index, balls = {}, {}, {}
for i = 1, COLORS do
  local share = (i - 0.5) / COLORS
  materials[i] = glint.material { diffuse = heat((2 * share - 1) * HEIGHT), specular = 0.3, shininess = 40 }
end

local camera = glint.camera { eye = { 0, 9, 0 }, at = { 0, -0.8, 0 }, fov = 34 }
local time = glint.label { text = "", at = "bottom right", size = size, background = "black", opacity = 0.35 }
local scene = glint.scene {
  camera = camera, ambient = 0.25, background = "#39424e",
  glint.directional_light { direction = { -1, -2, -1.4 }, intensity = 0.8 },
  glint.label { text = "u(r, t) = A sin(kr − ωt)", at = "top", size = size },
  time,
  glint.colorbar { map = P.map, low = -HEIGHT, high = HEIGHT, title = "u / µm", size = size },
  glint.axes { size = size },
}
local lattice

-- Places balls at the heights of the wave, with materials by height.
local function place(t)
  local middle, count = (P.side + 1) / 2, 0
  for z = 1, P.side do
    for x = 1, P.side do
      local far = math.sqrt((x - middle) ^ 2 + (z - middle) ^ 2)
      local y = HEIGHT * glint.sin(0.9 * far - 2 * math.pi * t) * glint.exp(-far / 9)
      local at = 4 * count
      balls[at + 1], balls[at + 2], balls[at + 3], balls[at + 4] = x - middle, y, z - middle, 0.46
      count = count + 1
      index[count] = math.min(COLORS, 1 + math.floor((y / HEIGHT + 1) / 2 * COLORS))
    end
  end
  if lattice then scene:remove(lattice) end
  lattice = scene:add(glint.spheres { data = balls, materials = materials, index = index })
end

return glint.animation { scene = scene, frames = 48, cyclic = true, fps = 24, width = 800, height = 500, samples = 4,
  frame = function(t)
    local turn, away = 0.6 + 0.5 * glint.sin(2 * math.pi * t), 1.7 * P.side
    camera.eye = { away * glint.sin(turn), 0.55 * away, away * glint.cos(turn) }
    time.text = ("t = %4.1f ns"):format(40 * t)
    place(t)
  end }
