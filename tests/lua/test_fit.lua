-- glint.fit: parameters of a scene recovered from a picture of it, with their uncertainty.
package.path = "scripts/lib/?.lua;" .. package.path
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"
local fit = require "glint.fit"

local tests = {}
local PATH = (os.getenv "BUILD" or "build") .. "/tests/fit_photo.png"
local lamp = glint.point_light { position = { 0, 1, 0 } }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 0, 6 }, at = { 0, 0, 0 }, fov = 30 }, lamp, ambient = 0.02,
  glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { diffuse = { 0.7, 0.5, 0.3 } } },
}

local function render(v, passes)
  lamp.position, lamp.intensity = { v.x, v.y, 3 }, v.power
  return scene:render { width = 40, height = 30, passes = passes }
end

local TRUE = { x = 2, y = 1.5, power = 1.2 }
local START = { { "x", 0 }, { "y", 0.5 }, { "power", 0.5, least = 0.01 } }

local function near(found, tolerance, what)
  for name, want in pairs(TRUE) do
    check(math.abs(found.values[name] - want) < tolerance, "%s: %s is %.9g, not %g", what, name, found.values[name], want)
  end
end

function tests.an_image_gives_its_numbers()
  local found = fit.run { target = render(TRUE), start = START, render = render }
  near(found, 1e-5, "image")
  check(found.converged and found.steps < 15 and found.error < 1e-6, "%d steps, error %g", found.steps, found.error)
end

-- The light of the ball is power x diffuse, or the sum of two lamps at one place: the picture cannot tell them apart.
function tests.numbers_that_a_picture_cannot_tell_apart()
  local matt = glint.material { diffuse = 0.5, ambient = 0 }
  local second = glint.point_light { position = { 2, 1.5, 3 } }
  local ball = glint.scene { lamp, second, glint.sphere { center = { 0, 0, 0 }, radius = 1, material = matt },
    camera = glint.camera { eye = { 0, 0, 6 }, at = { 0, 0, 0 }, fov = 30 } }
  local function look(v, passes)
    lamp.position, lamp.intensity, second.intensity = { v.x or 2, 1.5, 3 }, v.power or 1, v.second or 0
    matt.diffuse = v.diffuse or 0.5
    return ball:render { width = 40, height = 30, passes = passes }
  end
  local cases = {
    { "only the product of power and diffuse", { { "power", 1.5 }, { "diffuse", 0.7 } }, { power = 1.2, diffuse = 0.6 } },
    { "only the product of power and diffuse", { { "power", 1.5 }, { "x", 1 }, { "diffuse", 0.7 } },
      { power = 1.2, diffuse = 0.6, x = 2 }, "x" },
    { "only the sum of power and second", { { "power", 1.5 }, { "second", 0.4 } }, { power = 1.2, second = 0.6 } },
    { "only a combination of power and diffuse; only the sum of power and second", { { "power", 1.5 }, { "diffuse", 0.7 }, { "second", 0.4 } },
      { power = 1.2, diffuse = 0.6, second = 0.7 } },
    { nil, { { "power", 1.5 }, { "x", 1 } }, { power = 1.2, x = 2 }, "x" },
  }
  for _, case in ipairs(cases) do
    local want, start, truth, known = table.unpack(case, 1, 4)
    local found = fit.run { target = look(truth), start = start, render = look }
    local as = want or "all numbers"
    check(found.error < 1e-5, "%s: error %g", as, found.error)
    local got = table.concat(found.undetermined, "; ")
    check(got == (want or ""), "%s: got %s", as, got)
    check(found.converged == (want == nil), "%s: converged is %s", as, found.converged)
    for name, uncertainty in pairs(found.uncertainty) do
      check((uncertainty == math.huge) == (want ~= nil and name ~= known), "%s: the uncertainty of %s is %g", as, name,
        uncertainty)
    end
    if known then check(math.abs(found.values[known] - truth[known]) < 1e-4, "%s: %s is %.9g", as, known, found.values[known]) end
  end
end

-- An 8-bit photo is coarse: the parameters are approximate, and the iteration stops on its own.
function tests.a_photo_gives_them()
  assert(render(TRUE):save(PATH))
  local calls = 0
  local found = fit.run { target = PATH, start = START, render = render, steps = 50, report = function() calls = calls + 1 end }
  near(found, 0.02, "photo")
  check(found.converged and found.steps < 30 and calls == found.steps + 1, "%d steps, %d reports", found.steps, calls)
  os.remove(PATH)
end

-- With noise of 0.01 on every value, the errors match the standard deviations, which shrink with the noise.
function tests.the_uncertainty_is_that_of_the_noise()
  math.randomseed(7)
  local image, sigma = render(TRUE), {}
  for _, noise in ipairs { 0.01, 0.001 } do
    local rows = {}
    local function normal() return math.sqrt(-2 * math.log(1 - math.random())) * math.cos(2 * math.pi * math.random()) end
    for i = 1, image.width * image.height do rows[i] = { normal(), normal(), normal() } end
    local noisy = image:array() + noise * glint.array(rows)
    local found = fit.run { target = noisy, start = START, render = render, steps = 40 }
    check(found.converged and math.abs(found.error / noise - 1) < 0.1, "what is left is the noise, not %g", found.error)
    for name, want in pairs(TRUE) do
      local off = math.abs(found.values[name] - want)
      check(off < 4 * found.uncertainty[name], "%s: %g off, uncertainty %g", name, off, found.uncertainty[name])
      if sigma[name] then
        check(math.abs(sigma[name] / found.uncertainty[name] - 10) < 1, "%s: uncertainty %g", name, found.uncertainty[name])
      end
      sigma[name] = found.uncertainty[name]
    end
  end
end

-- Full white in a photo can be any light: the fit converges even when the light overexposes the ball.
function tests.clipped_values_do_not_count()
  TRUE.power = 2.2
  assert(render(TRUE):save(PATH, { bits = 16 }))
  near(fit.run { target = PATH, start = START, render = render, steps = 40 }, 0.01, "clipped")
  TRUE.power = 1.2
  os.remove(PATH)
end

local function raises(want, options)
  local good, message = pcall(fit.run, options)
  check(not good and tostring(message):find(want, 1, true), "%s expected, got %s", want, message)
end

function tests.mistakes_have_messages()
  raises("fit: a table { target, start, render } expected, got nil")
  raises("fit: target: a file name, a picture, an image or an array expected, got nil", { start = START, render = render })
  raises("fit: render: function(values, passes) expected, got nil", { target = PATH, start = START })
  raises("fit: start[1]: { name, number } expected", { target = PATH, start = { { "x" } }, render = render })
  raises("fit: stat: no such option", { target = PATH, stat = {} })
  raises("no_photo.png: No such file", { target = "no_photo.png", start = START, render = render })
  raises("fit: the target is 4 x 4, the picture 40 x 30",
    { target = scene:render { width = 4, height = 4 }, start = START, render = render })
  raises("fit: the target is array of 16 x 3 numbers, the picture 40 x 30",
    { target = scene:render { width = 4, height = 4 }:array(), start = START, render = render })
  raises("fit: the picture does not change with q", { target = render(TRUE), start = { { "q", 1 } }, render = function(v, passes)
    lamp.intensity = 1 + 0 * v.q
    return scene:render { width = 40, height = 30, passes = passes }
  end })
end

tally.run(tests)
tally.finish()
