-- vectors.lua PLAIN MARKED DRAWN: compares a drawn vector figure with the .png that it should look like. PLAIN is the
-- picture without overlays. Prints "the same" if
--   - pixels that are more than two pixels away from any overlay are equal,
--   - the other pixels look as in the .png, up to different antialiasing and hinting,
--   - and no shift of the overlays by a pixel fits better.
local glint = require "glint"
local plain, marked, drawn = glint.read_image(arg[1]), glint.read_image(arg[2]), glint.read_image(arg[3])
local width, height = marked.width, marked.height
assert(drawn.width == width and drawn.height == height, ("sizes: %dx%d expected, got %dx%d"):format(width, height, drawn.width, drawn.height))

local function read(picture)
  local values = {}
  for y = 0, height - 1 do
    for x = 0, width - 1 do
      local r, g, b = picture:pixel(x, y)
      values[y * width + x] = { r, g, b }
    end
  end
  return values
end

local P, M, D = read(plain), read(marked), read(drawn)
local function apart(a, b) return math.abs(a[1] - b[1]) + math.abs(a[2] - b[2]) + math.abs(a[3] - b[3]) end

local near = {}
for y = 0, height - 1 do
  for x = 0, width - 1 do
    if apart(P[y * width + x], M[y * width + x]) > 0 then
      for v = math.max(y - 2, 0), math.min(y + 2, height - 1) do
        for u = math.max(x - 2, 0), math.min(x + 2, width - 1) do near[v * width + u] = true end
      end
    end
  end
end

-- Returns the sum of differences near overlays after a shift of the drawn figure by dx, dy pixels.
local function differ(dx, dy)
  local sum = 0
  for i in pairs(near) do
    local x, y = i % width + dx, i // width + dy
    if x >= 0 and x < width and y >= 0 and y < height then sum = sum + apart(M[i], D[y * width + x]) end
  end
  return sum
end

for i = 0, width * height - 1 do
  assert(near[i] or apart(P[i], D[i]) == 0, ("the picture differs at %d, %d"):format(i % width, i // width))
end
local ink, here = 0, differ(0, 0)
for i in pairs(near) do ink = ink + apart(P[i], M[i]) end
assert(ink > 0, "no overlays")
assert(here < 0.25 * ink, ("the overlays differ by %.3f of their ink"):format(here / ink))
for dy = -1, 1 do
  for dx = -1, 1 do
    assert((dx == 0 and dy == 0) or differ(dx, dy) > here, ("the overlays fit better at %d, %d"):format(dx, dy))
  end
end
print "the same"
io.stderr:write(("%.3f of the ink\n"):format(here / ink))
