-- Elongated solids in a BVH: each appears at the same pixels as in a scene with no other object.
local tally = dofile "tests/lua/tally.lua"
local glint = require "glint"

local SIZE = { width = 160, height = 90, passes = "object_id" }

-- Counts the pixels of each object, by the object's id.
local function count(image)
  local pixels = {}
  for y = 0, image.height - 1 do
    for x = 0, image.width - 1 do
      local id = image:pixel(x, y, "object_id")
      pixels[id] = (pixels[id] or 0) + 1
    end
  end
  return pixels
end

local tests = {}

function tests.twenty_cylinders()
  local pixels = count(dofile "tests/web/cylinders.lua":render(SIZE))
  tally.check(pixels[1] == 469 and pixels[2] == 469, "469 pixels each expected, got %s and %s", pixels[1], pixels[2])
  for i = 1, 19, 2 do tally.check(pixels[i] == pixels[i + 1], "cylinders %d and %d are mirror images", i, i + 1) end
end

function tests.the_first_without_the_others()
  local scene = glint.scene { camera = glint.camera { eye = { 0, 2, 22 }, at = { 0, 2.4, 0 }, fov = 55 } }
  scene:add(glint.cylinder { base = { -4, 0, 12 }, top = { -4, 5, 12 }, radius = 0.55 })
  local pixels = count(scene:render(SIZE))
  tally.check(pixels[1] == 469, "469 pixels expected, got %s", pixels[1])
end

tally.run(tests)
tally.finish()
