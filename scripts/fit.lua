-- Inverse rendering: where is the lamp, how bright is it, and how shiny is the ball? From a picture alone, by
-- Gauss-Newton: the passes d:NAME of each step say how fast every pixel changes with the five numbers, and the next
-- step goes where the picture would then be nearest to the target; Levenberg's and Marquardt's damping shortens steps
-- that lead astray.
--
--     glint scripts/fit.lua -o 'fit/%02d.png'; glint sheet 'fit/##.png' -o fit.png --difference 1
--
-- The target is made from hidden numbers, or file=... is a .pfm of this scene at the same size. Frame 1 is the target,
-- the others are the steps, and the numbers found are printed.
local glint = require "glint"

local P = glint.params {
  file = { "", doc = "picture to fit, a .pfm; none: one is made from hidden numbers" },
  steps = { 20, min = 1, max = 100, doc = "steps at most" },
}

local NAMES = { "lamp_x", "lamp_y", "lamp_z", "intensity", "shininess" }
local HIDDEN = { 3.2, 4.1, 2.4, 1.6, 45 }
local START = { -1, 3, 5, 1, 12 }
local LEAST = { -20, 0.5, -20, 0.01, 1 } -- a lamp under the floor lights nothing, and has no slope
local WIDTH, HEIGHT = 160, 120

local lamp = glint.point_light { position = { 0, 1, 0 }, attenuation = { 1, 0, 0.02 } }
local shiny = glint.material { diffuse = { 0.5, 0.25, 0.1 }, specular = 0.6 }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 0.2, 0 }, fov = 32 }, ambient = 0.05, lamp,
  glint.sphere { center = { 0, 0, 0 }, radius = 1, material = shiny },
  glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.6 } },
}

-- The picture of five numbers, variables or plain.
local function render(v, passes)
  lamp.position, lamp.intensity, shiny.shininess = { v[1], v[2], v[3] }, v[4], v[5]
  local image = scene:render { width = WIDTH, height = HEIGHT, passes = passes }
  if not image then error("fit.lua: every frame is needed: no --frames or --shard, please", 0) end
  return image
end

-- All numbers of a pass, pixel by pixel.
local function read(image, pass)
  local list = {}
  for y = 0, image.height - 1 do
    for x = 0, image.width - 1 do
      local r, g, b = image:pixel(x, y, pass)
      local n = #list
      list[n + 1], list[n + 2], list[n + 3] = r, g, b
    end
  end
  return list
end

local HEAD = 100 -- bytes of a .pfm before its pixels, at most

-- The same of a .pfm in colour, whose rows begin at the bottom.
local function read_pfm(path, size)
  local file = assert(io.open(path, "rb"))
  local text = file:read(HEAD + 12 * size.width * size.height) or "" -- of what is longer no more
  file:close()
  local width, height, scale, first = text:match "^PF%s+(%d+)%s+(%d+)%s+([-+.%deE]+)%s()"
  width, height = tonumber(width), tonumber(height)
  if width ~= size.width or height ~= size.height then
    error(("%s: a colour .pfm of %d x %d expected"):format(path, size.width, size.height), 0)
  end
  local format, list = tonumber(scale) < 0 and "<fff" or ">fff", {}
  for y = height - 1, 0, -1 do
    for x = 0, width - 1 do
      local r, g, b = format:unpack(text, first + 12 * (y * width + x))
      local n = #list
      list[n + 1], list[n + 2], list[n + 3] = r, g, b
    end
  end
  return list
end

-- Solves a x = b for a symmetric matrix, by elimination with pivots.
local function solve(a, b)
  local n = #b
  for i = 1, n do
    local best = i
    for k = i + 1, n do best = math.abs(a[k][i]) > math.abs(a[best][i]) and k or best end
    a[i], a[best], b[i], b[best] = a[best], a[i], b[best], b[i]
    for k = i + 1, n do
      local f = a[k][i] / a[i][i]
      for j = i, n do a[k][j] = a[k][j] - f * a[i][j] end
      b[k] = b[k] - f * b[i]
    end
  end
  for i = n, 1, -1 do
    for j = i + 1, n do b[i] = b[i] - a[i][j] * b[j] end
    b[i] = b[i] / a[i][i]
  end
  return b
end

-- What is between a picture and the target, squared and summed; with slopes also their products, the normal equations.
local function equations(image, target)
  local got, slopes, sum, n = read(image), {}, 0, #NAMES
  for i, name in ipairs(NAMES) do slopes[i] = read(image, "d:" .. name) end
  local a, b = {}, {}
  for i = 1, n do
    a[i], b[i] = {}, 0
    for j = 1, n do a[i][j] = 0 end
  end
  for k = 1, #target do
    local rest = target[k] - got[k]
    sum = sum + rest * rest
    for i = 1, n do
      local s = slopes[i][k]
      b[i] = b[i] + s * rest
      for j = i, n do a[i][j] = a[i][j] + s * slopes[j][k] end
    end
  end
  for i = 1, n do
    for j = 1, i - 1 do a[i][j] = a[j][i] end
  end
  return { a = a, b = b, error = math.sqrt(sum / #target) }
end

-- The next numbers: a damped step.
local function step(v, e, damping)
  local a, b, next = {}, {}, {}
  for i = 1, #v do
    a[i], b[i] = { table.unpack(e.a[i]) }, e.b[i]
    a[i][i] = a[i][i] * (1 + damping)
  end
  local by = solve(a, b)
  for i = 1, #v do next[i] = math.max(v[i] + by[i], LEAST[i], v[i] > 0 and v[i] / 4 or -math.huge) end
  return next
end

local function report(k, v, e, damping)
  local words = {}
  for i, name in ipairs(NAMES) do words[i] = ("%s %.6g"):format(name, v[i]) end
  io.stderr:write(("step %2d: error %.2e, damping %.0e: %s\n"):format(k, e.error, damping, table.concat(words, ", ")))
end

local function slopes_at(v)
  local variables = {}
  for i, name in ipairs(NAMES) do variables[i] = glint.variable(name, v[i]) end
  return render(variables, "d:" .. table.concat(NAMES, ",d:"))
end

local made = render(HIDDEN, "none")
local target = P.file ~= "" and read_pfm(P.file, made) or read(made)
local v, damping = START, 1e-2
local e = equations(slopes_at(v), target)
report(0, v, e, damping)
for k = 1, P.steps do
  local tried = step(v, e, damping)
  local there = equations(slopes_at(tried), target)
  if there.error < e.error then
    v, e, damping = tried, there, damping / 10
  else
    damping = damping * 10
  end
  report(k, v, e, damping)
  if e.error < 1e-7 then break end
end
for i, name in ipairs(NAMES) do print(("%s %.9g"):format(name, v[i])) end
