-- Lights have a grid of the spheres in front of them when a frame is large enough to benefit. Small regions of a
-- picture, which have no grid, must equal the whole bit for bit.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local WIDTH <const>, HEIGHT <const> = 480, 360
local PARTS <const> = { { 160, 100, 24, 16 }, { 225, 165, 24, 16 }, { 90, 225, 24, 16 }, { 330, 255, 24, 16 } }

-- Number and radius of small balls above a floor, with a few large balls among them: so many that adjacent pixels use
-- different cells, or fewer and larger balls.
local MANY <const>, FEW <const> = { 8000, 0.045 }, { 900, 0.15 }

local function scene_of(lights, balls)
  local data, state = {}, 7
  local function random()
    state = (state * 1103515245 + 12345) % 2147483648
    return state / 2147483648
  end
  for _ = 1, balls[1] do
    local radius = balls[2] * (0.44 + 1.12 * random())
    table.move({ 8 * random() - 4, 3 * random(), 8 * random() - 4, radius }, 1, 4, #data + 1, data)
  end
  local scene = glint.scene {
    camera = glint.camera { eye = { 0, 5, 11 }, at = { 0, 1, 0 }, fov = 40 }, ambient = 0.1,
    glint.spheres { data = data },
    glint.sphere { center = { 1, 1, 1 }, radius = 1 },
    glint.sphere { center = { 0, -200, 0 }, radius = 200 },
    glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 } },
  }
  for _, light in ipairs(lights) do scene:add(light) end
  return scene
end

local function pixel(image, x, y) return ("%a %a %a"):format(image:pixel(x, y)) end

local function check_parts(name, lights, balls)
  local scene, parts = scene_of(lights, balls or MANY), {}
  for i, region in ipairs(PARTS) do
    parts[i] = scene:render { width = WIDTH, height = HEIGHT, region = region }
  end
  local camera = scene.camera
  scene.camera = glint.camera { eye = { 0, 5, 11 }, at = { 0, 1, 0 }, fov = 41 }
  scene:render { width = WIDTH, height = HEIGHT } -- with several threads the engine builds the grid in the second frame
  scene.camera = camera
  local whole, differ, dark = scene:render { width = WIDTH, height = HEIGHT }, 0, 0
  for i, r in ipairs(PARTS) do
    for y = 0, r[4] - 1 do
      for x = 0, r[3] - 1 do
        if pixel(whole, r[1] + x, r[2] + y) ~= pixel(parts[i], x, y) then differ = differ + 1 end
        if whole:pixel(r[1] + x, r[2] + y) < 0.15 then dark = dark + 1 end
      end
    end
  end
  check(differ == 0, "%s: %d pixels differ", name, differ)
  check(dark > 50, "%s: %d pixels in shadow", name, dark)
end

local tests = {}

function tests.above() check_parts("above", { glint.point_light { position = { 2, 12, 3 } } }) end

function tests.few() check_parts("few", { glint.point_light { position = { 2, 12, 3 } } }, FEW) end

function tests.few_afar() check_parts("few, afar", { glint.directional_light { direction = { -1, -2, -0.5 } } }, FEW) end

function tests.afar() check_parts("afar", { glint.directional_light { direction = { -1, -2, -0.5 } } }) end

-- A light among the spheres has no grid, a light next to the spheres has one.
function tests.several()
  check_parts("several", { glint.point_light { position = { 0, 1.5, 0 }, intensity = 0.5 },
    glint.point_light { position = { -9, 6, 0 }, intensity = 0.5 } })
end

tally.run(tests)
tally.finish()
