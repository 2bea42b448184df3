-- Shadows through transparent shapes: a shadow ray is traced only if the shapes' bounds allow a hit. A transparent
-- plane under the opaque floor, which no ray hits but which has no bounds, forces tracing all rays: identical pictures.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local state = 1
local function random(low, high)
  state = (state * 48271) % 2147483647
  return low + (high - low) * state / 2147483647
end

local matt = glint.material { diffuse = { 0.7, 0.5, 0.3 }, specular = 0.3, shininess = 20 }
local black = glint.material { diffuse = 0, transmission = { 0.9, 0.6, 0.8 }, ior = 1.5 }
local shiny = glint.material { diffuse = 0.1, specular = 0.4, transmission = { 0.5, 0.9, 0.7 }, ior = 1.3 }
local smoke = glint.material { diffuse = 0.05, transmission = 0.95, absorption = { 0.1, 0.4, 0.8 }, ior = 1.2 }

local function balls(count, radius, of)
  local all = {}
  for i = 1, count do
    local center = { random(-6, 6), random(radius, 4), random(-6, 3) }
    all[i] = glint.sphere { center = center, radius = radius, material = i % 3 == 0 and matt or of }
  end
  return glint.group(all)
end
local function cube(of)
  return glint.box { min = { -1, 0, -1 }, max = { 1, 2, 1 }, material = of, transform = glint.rotate("y", 30) }
end

local shapes = {
  ["a ball"] = function()
    return glint.group { glint.sphere { center = { 1, 2, 0 }, radius = 1.2, material = black },
      glint.sphere { center = { -3, 1, 0 }, radius = 1, material = matt } }
  end,
  ["balls"] = function() return balls(12, 0.8, shiny) end,
  ["more balls than bounds"] = function() return balls(150, 0.3, shiny) end,
  ["absorbing balls"] = function() return balls(12, 0.8, smoke) end,
  ["a box and a cone"] = function()
    return glint.group { cube(shiny), glint.cone { base = { 3, 0, 0 }, top = { 3, 3, 1 }, radius = 1, material = black } }
  end,
  ["a mesh"] = function()
    return glint.mesh { vertices = { { -1, 1, 0 }, { 2, 1, 0 }, { 0, 1, 2 }, { 0, 3, 0 } },
      faces = { { 1, 2, 3 }, { 1, 4, 2 }, { 2, 4, 3 }, { 3, 4, 1 } }, material = shiny }
  end,
  ["a part of a combined solid"] = function()
    return glint.union { glint.sphere { center = { 0, 1.5, 0 }, radius = 1.2, material = matt },
      glint.sphere { center = { 1.2, 1.8, 0 }, radius = 1.2, material = black } }
  end,
}
local place = { 1, 9, 2 }
local lights = {
  point = function() return { glint.point_light { position = place } } end,
  directional = function() return { glint.directional_light { direction = { 0.4, -1, -0.3 } } } end,
  among = function() return { glint.point_light { position = { 0.5, 2, 0.8 } } } end,
  sphere = function() return { glint.sphere_light { position = place, radius = 1.5, samples = 20 } } end,
  cone = function() return { glint.sphere_light { position = place, radius = 1, samples = 5, radiance = 12 } } end,
  several = function()
    return { glint.disk_light { position = place, normal = { 0, -1, 0 }, radius = 1, samples = 4, intensity = 0.5 },
      glint.point_light { position = { -5, 6, 4 }, intensity = 0.3 }, glint.point_light { position = { -5, 6, 5 }, intensity = 0.3 } }
  end,
}

local function render(shape, lamps, settings, everywhere)
  state = 7
  local scene = glint.scene {
    camera = glint.camera { eye = settings.eye or { 0, 5, 12 }, at = { 0, 1, 0 }, fov = 40 }, ambient = 0.1, background = 0.3,
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.6 } },
    shape(),
  }
  for _, lamp in ipairs(lamps()) do scene:add(lamp) end
  if everywhere then
    scene:add(glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = black })
  end
  return scene:render { width = 48, height = 36, output = "none", samples = settings.samples, precision = settings.precision }
end

-- Counts the pixels that differ between two images.
local function differences(a, b)
  local count = 0
  for y = 0, 35 do
    for x = 0, 47 do
      local ar, ag, ab = a:pixel(x, y)
      local br, bg, bb = b:pixel(x, y)
      if ar ~= br or ag ~= bg or ab ~= bb then count = count + 1 end
    end
  end
  return count
end

local settings = {
  {}, { samples = 2 }, { precision = "float" },
  { eye = { 1, 2.2, 0.3 } }, -- an eye inside the ball
}
for name, shape in pairs(shapes) do
  for kind, lamps in pairs(lights) do
    for i, setting in ipairs(settings) do
      local picture = render(shape, lamps, setting)
      local title = ("%s, %s light, setting %d"):format(name, kind, i)
      check(differences(picture, render(shape, lamps, setting, true)) == 0, title)
    end
  end
end

do -- checks that the shapes transmit some light at all
  local function ball(transmission)
    return function()
      return glint.sphere { center = { 1, 2, 0 }, radius = 1.2,
        material = glint.material { diffuse = 0.5, transmission = transmission, ior = 1 } }
    end
  end
  for _, kind in ipairs { "point", "directional", "sphere", "cone", "several" } do
    check(differences(render(ball(0.4), lights[kind], {}), render(ball(0), lights[kind], {})) > 20, "%s light goes through", kind)
  end
end

tally.finish()
