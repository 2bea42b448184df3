-- glint.colormap: published colours at the ends, in the middle and in between, Moreland's map by his formula, ranges,
-- and identical bits inside and outside a pattern.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

-- Returns the 8-bit sRGB value of linear light, with its fraction.
local function code(x) return 255 * (x <= 0.0031308 and 12.92 * x or 1.055 * x ^ (1 / 2.4) - 0.055) end
local function light(c) return c / 255 <= 0.04045 and c / 255 / 12.92 or ((c / 255 + 0.055) / 1.055) ^ 2.4 end

-- Entries 0, 64, 128, 192 and 255 of 256 colours, from the papers and their programs.
local PUBLISHED = {
  viridis = { "440154", "3b528b", "21918c", "5ec962", "fde725" },
  magma = { "000004", "51127c", "b73779", "fc8961", "fcfdbf" },
  cividis = { "00224e", "434e6c", "7d7c78", "bcae6c", "fee838" },
  turbo = { "30123b", "28bceb", "a4fc3c", "fb7e21", "7a0403" },
  coolwarm = { "3b4cc0", "8db0fe", "dddddd", "f49a7b", "b40426" },
}

local tests = {}

function tests.published_colours()
  for name, list in pairs(PUBLISHED) do
    local map = glint.colormap(name)
    for i, hex in ipairs(list) do
      local color = map((i - 1) / 4) -- between entries 63 and 64 ...
      for c = 1, 3 do
        near(code(color[c]), tonumber(hex:sub(2 * c - 1, 2 * c), 16), i % 2 == 1 and i ~= 3 and 1e-3 or 3,
          ("%s at %g, component %d"):format(name, (i - 1) / 4, c))
      end
    end
  end
end

-- K. Moreland: CIELAB in polar coordinates, over white;
-- Table and listing of "Diverging Color Maps for Scientific Visualization (Expanded)".
local function moreland(share)
  local function to_msh(r, g, b)
    r, g, b = light(r), light(g), light(b)
    local function f(t) return t > 0.008856 and t ^ (1 / 3) or 7.787 * t + 16 / 116 end
    local x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505)
    local y = f(0.2126 * r + 0.7152 * g + 0.0722 * b)
    local z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089)
    local l, s, t = 116 * y - 16, 500 * (x - y), 200 * (y - z)
    local m = math.sqrt(l * l + s * s + t * t)
    return { m, math.acos(l / m), math.atan(t, s) }
  end
  local function hue(color, m) -- for white, the hue that makes the path from the colour straight
    if color[1] >= m then return color[3] end
    local turn = color[2] * math.sqrt(m * m - color[1] ^ 2) / (color[1] * math.sin(color[2]))
    return color[3] > -math.pi / 3 and color[3] + turn or color[3] - turn
  end
  local blue, red = to_msh(59, 76, 192), to_msh(180, 4, 38)
  local m = math.max(blue[1], red[1], 88)
  local from, to, t = blue, { m, 0, hue(blue, m) }, 2 * share
  if share >= 0.5 then from, to, t = { m, 0, hue(red, m) }, red, 2 * share - 1 end
  local p = {}
  for i = 1, 3 do p[i] = from[i] + t * (to[i] - from[i]) end
  local l, a, b = p[1] * math.cos(p[2]), p[1] * math.sin(p[2]) * math.cos(p[3]), p[1] * math.sin(p[2]) * math.sin(p[3])
  local function inverse(v) return v ^ 3 > 0.008856 and v ^ 3 or (v - 16 / 116) / 7.787 end
  local y = (l + 16) / 116
  local x, z = 0.9505 * inverse(a / 500 + y), 1.089 * inverse(y - b / 200)
  y = inverse(y)
  return { 3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z, 0.0557 * x - 0.204 * y + 1.057 * z }
end

function tests.coolwarm_is_morelands()
  local map = glint.colormap "coolwarm"
  for i = 0, 255 do
    local got, want = map(i / 255), moreland(i / 255)
    for c = 1, 3 do near(code(got[c]), code(want[c]), 0.75, ("colour %d, component %d"):format(i, c)) end
  end
end

function tests.light_between_two_colours()
  for name in pairs(PUBLISHED) do
    local map = glint.colormap(name)
    for i = 0, 254 do
      local a, b, middle = map(i / 255), map((i + 1) / 255), map((i + 0.5) / 255)
      for c = 1, 3 do
        near(middle[c], (a[c] + b[c]) / 2, 2e-7, ("%s between %d and the next, component %d"):format(name, i, c))
        check(math.abs(code(a[c]) - math.floor(code(a[c]) + 0.5)) < 2e-3, "%s: colour %d is a code", name, i)
      end
    end
  end
end

function tests.ranges()
  local map, back = glint.colormap("viridis", -3, 5), glint.colormap("viridis", 5, -3)
  local plain = glint.colormap "viridis"
  for _, x in ipairs { -3, -1, 0, 1, 4.5, 5 } do
    local want = plain((x + 3) / 8)
    for c = 1, 3 do
      check(map(x)[c] == want[c], "at %g", x)
      near(back(2 - x)[c], want[c], 1e-6, "turned round")
    end
  end
  for _, beyond in ipairs { -1e300, -1, -1 / 0 } do check(plain(beyond)[1] == plain(0)[1], "below is the lowest") end
  for _, beyond in ipairs { 1.001, 7, 1 / 0 } do check(plain(beyond)[3] == plain(1)[3], "above is the highest") end
  local color = plain(0 / 0)
  for c = 1, 3 do near(color[c], 0.21586050011389926, 1e-15, "a missing value is #808080") end
  local red = glint.colormap("viridis", -3, 5, "linear", "red")
  check(red(0 / 0)[1] == 1 and red(0 / 0)[2] == 0 and red(5)[1] == plain(1)[1], "or a colour of one's own")
end

-- A material with the constant and one with the pattern give identical bits.
function tests.in_patterns()
  for name in pairs(PUBLISHED) do
    local map, k = glint.colormap(name, 0.5, 2.5), 0
    local pattern = glint.pattern(function(p) return map(p.x * p.x) end)
    local constant = glint.pattern(function() return map(k) end)
    for i = 0, 20 do
      local x = i / 12
      k = x * x
      local got, want, also = pattern:evaluate { p = { x, 0, 0 } }, map(k), constant:evaluate { p = { 0, 0, 0 } }
      for c = 1, 3 do
        check(got[c] == want[c] and also[c] == want[c], "%s at %g, component %d: %a, %a, %a", name, k, c, want[c], got[c], also[c])
      end
    end
    check(#pattern <= 6, "%s is short, got %d instructions", name, #pattern)
    local material = glint.material { diffuse = map(1.25) }
    check(material.diffuse[2] == map(1.25)[2], "a field takes what it gives")
  end
end

function tests.refused()
  local function raises(want, ...)
    local good, message = pcall(...)
    check(not good and tostring(message):find(want, 1, true), "<%s> expected, got %s", want, message)
  end
  raises('did you mean "viridis"?', glint.colormap, "virdis")
  raises("colormap.name: ", glint.colormap)
  raises("colormap.name: ", glint.colormap, 3)
  raises("colormap.high: another number than low (1.0) expected, got 1.0", glint.colormap, "turbo", 1)
  raises("colormap.missing", glint.colormap, "viridis", 0, 1, nil, {})
  raises("colormap.low: finite number expected, got ", glint.colormap, "turbo", 0 / 0)
  raises("colormap.high: ", glint.colormap, "turbo", 0, "2")
  raises("colormap.high: another number than low", glint.colormap, "turbo", -1e308, 1e308)
  local map = glint.colormap "magma"
  raises("colormap: number, symbol or vector expected, got nil", map, nil)
  raises("colormap: ", map, { 1, 2, 3 })
  raises("colormap: one number or symbol expected, got 2 values", map, 1, 2)
end

-- Returns the pixel values of a .png, as one string.
local build = os.getenv "BUILD" or "build"
local function codes_of(image, options)
  local path = os.tmpname()
  check(image:save(path .. ".png", options), "saved")
  local pipe <close> = assert(io.popen(("'%s/tests/gr/codes' '%s.png'"):format(build, path)))
  pipe:read("n", "n")
  pipe:read(1)
  local codes = pipe:read "a"
  os.remove(path)
  os.remove(path .. ".png")
  return codes
end

-- Each colour is the map's colour for the pixel's grey value without a map. The background of depth is black.
function tests.passes_in_colours()
  local x = glint.variable("x", 1)
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 0.1,
    glint.point_light { position = { 5, x * 5, 5 } }, glint.sphere { center = { 0, 0, 0 }, radius = 2 },
    glint.sphere { center = { 3, 0, -40 }, radius = 9 } }
  local image = scene:render { width = 48, height = 32, passes = "depth,d:x,alpha" }
  for _, map in ipairs { "viridis", "coolwarm" } do
    local colors = glint.colormap(map, 0, 255)
    for _, pass in ipairs { "depth", "d:x" } do
      local grey, mapped, seen = codes_of(image, { pass = pass }), codes_of(image, { pass = pass, colormap = map }), {}
      check(#grey == 3 * 48 * 32 and #mapped == #grey, "their sizes")
      for i = 1, #grey, 3 do
        local level = grey:byte(i)
        local color = (pass ~= "depth" or level > 0) and colors(level) or { 0, 0, 0 }
        seen[level] = true
        for c = 1, 3 do near(mapped:byte(i - 1 + c), code(color[c]), 0.501, ("%s of %s, grey %d"):format(map, pass, level)) end
      end
      local levels = 0
      for _ in pairs(seen) do levels = levels + 1 end
      check(levels > 20, "%s has %d levels", pass, levels)
    end
    for _, pass in ipairs { "beauty", "alpha" } do
      check(codes_of(image, { pass = pass, colormap = map }) == codes_of(image, { pass = pass }), "%s is as ever", pass)
    end
  end
  check(codes_of(image, { pass = "depth", colormap = "none" }) == codes_of(image, { pass = "depth" }), "none is grey")
  local good, message = pcall(image.save, image, "x.png", { colormap = "jet" })
  local want = 'save.colormap: "none", "viridis", "magma", "cividis", "turbo" or "coolwarm" expected, got string "jet"'
  check(not good and message:find(want, 1, true), "<%s> expected, got %s", want, message)
end

-- A list of colours spans low to high evenly; between two colours the pixel values are interpolated.
function tests.maps_of_ones_own()
  local own = glint.colormap({ "#000000", "#ff0000", { 1, 1, 1 } }, 10, 20)
  check(own(10) == glint.vector(0, 0, 0) and own(20) == glint.vector(1, 1, 1) and own(5) == own(10) and own(99) == own(20))
  check(math.abs(own(15).r - 1) < 0.01 and own(15).g < 0.01)
  local grey = glint.colormap({ "black", "white" })
  local function encoded(x) return x <= 0.0031308 and 12.92 * x or 1.055 * x ^ (1 / 2.4) - 0.055 end
  for i = 0, 20 do check(math.abs(encoded(grey(i / 20).x) - i / 20) < 0.004, "grey %d", i) end
  local calls = 0
  local made = glint.colormap(function(share)
    calls = calls + 1
    return { share, 0, 1 - share }
  end)
  check(calls == 256 and made(0) == glint.vector(0, 0, 1) and made(1) == glint.vector(1, 0, 0))
  check(math.abs(made(0.5).r - 0.5) < 0.01)
  check(glint.pattern(function(p) return own(p.x) end):evaluate { p = { 15, 0, 0 } } == own(15))
  for want, map in pairs { ["a list of at least two colours expected, got 1"] = { "red" }, ["colormap[2]: colour name"] = { "red", "rde" },
    ["colormap: the function's result: {r, g, b}, a number or a colour name expected, got nil"] = function() end } do
    local good, message = pcall(glint.colormap, map)
    check(not good and tostring(message):find(want, 1, true), "%s expected, got %s", want, message)
  end
end

-- A colour bar calls the function once, when it is created, and stores the colours as a list.
function tests.bars_of_ones_own()
  local function map(share) return { share, 0, 1 - share } end
  local bar = glint.colorbar { map = map, low = 1, high = 1000, scale = "log" }
  local colors, made = bar.map, glint.colormap(map)
  check(#colors == 256 and colors[1] == "#0000ff" and colors[256] == "#ff0000", "%s and %s", colors[1], colors[256])
  for _, i in ipairs { 1, 52, 103, 256 } do
    check((glint.colormap(colors)((i - 1) / 255) - made((i - 1) / 255)):length() < 1e-6, "colour %d", i)
  end
  local good, message = pcall(function() bar.map = map end)
  check(not good and tostring(message):find("only glint.colorbar { ... } takes a function", 1, true), "a bar that is there: %s", message)
  good, message = pcall(glint.colorbar, { map = function() return 1, 2 end, low = 0, high = 1 })
  check(good, "a grey: %s", message)
  good, message = pcall(glint.colorbar, { map = function() end, low = 0, high = 1 })
  check(not good and tostring(message):find("colorbar.map: the function's result: ", 1, true), "no colour: %s", message)
end

-- With a range, every picture of depth has the same colour for the same distance.
function tests.ranges_of_passes()
  local wall = glint.plane { point = { 0, 0, 0 }, normal = { 0, 0, 1 } }
  local scene = glint.scene { ambient = 1, wall,
    camera = glint.camera { eye = { 0, 0, 8 }, at = { 0, 0, 0 }, projection = "orthographic", height = 2 } }
  local image = scene:render { width = 2, height = 2, passes = "depth" }
  local map = glint.colormap("viridis", 0, 10)
  image:save("range.png", { pass = "depth", colormap = "viridis:0:10" })
  local seen = glint.read_image "range.png"
  for c, value in ipairs { seen:pixel(0, 0) } do
    check(math.abs(value - map(8)[({ "r", "g", "b" })[c]]) < 0.01, "channel %d: %g", c, value)
  end
  os.remove "range.png"
  local good, message = pcall(image.save, image, "x.png", { colormap = "viridis:1:1" })
  check(not good and tostring(message):find("save.colormap: NAME:LOW:HIGH with two numbers that differ", 1, true), "%s", message)
  good, message = pcall(scene.render, scene, { width = 2, height = 2, colormap = "viridis:a:1" })
  check(not good and tostring(message):find("colormap: NAME:LOW:HIGH with two numbers that differ", 1, true), "%s", message)
end

function tests.logarithmic_scales()
  local linear, log = glint.colormap "viridis", glint.colormap("viridis", 0.01, 100, "log")
  for i = -2, 2 do
    local a, b = log(10.0 ^ i), linear((i + 2) / 4)
    check((a - b):length() < 1e-6, "10 ^ %d: %s, not %s", i, a, b)
  end
  check(log(1e-9) == linear(0) and log(1e9) == linear(1) and log(0) == linear(0))
  check(not pcall(glint.colormap, "viridis", 0, 1, "log") and not pcall(glint.colormap, "viridis", 1, 2, "cubic"))
  check((glint.pattern(function(p) return log(p.x) end):evaluate { p = { 3, 0, 0 } } - log(3)):length() == 0)
end

tally.run(tests)
tally.finish()
