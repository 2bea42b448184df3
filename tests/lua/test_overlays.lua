-- Labels, colour bars and axes: fields and errors, frames that set them, extreme positions and sizes. For their
-- pixels see tests/engine/test_overlays.c.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local raises = tally.raises

local function bar(fields)
  local t = { map = "magma", low = 0, high = 1 }
  for key, value in pairs(fields) do t[key] = value end
  return glint.colorbar(t)
end

local function scene_of(...)
  return glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 0.5, background = 0.2,
    glint.sphere { center = { 0, 0, 0 }, radius = 1 }, ... }
end

local function bytes_of(image, options)
  local path = os.tmpname() .. ".png"
  assert(image:save(path, options))
  local file = assert(io.open(path, "rb"))
  local bytes = file:read "a"
  file:close()
  os.remove(path)
  os.remove((path:gsub("%.png$", "")))
  return bytes
end

local tests = {}

function tests.fields()
  local l = glint.label { text = "a", name = "time" }
  check(l.text == "a" and l.at == "top left" and l.position == nil and l.size == nil and l.background == nil and l.opacity == 1, "defaults")
  check(tostring(l) == "label 'time'", "its name")
  l.at = "bottom right"
  check(l.at == "bottom right", "a corner")
  l.at = { 0.5, 0.25 }
  check(l.at[1] == 0.5 and l.at[2] == 0.25 and #l.at == 2, "shares")
  raises("at: assign a whole table; its fields are read-only", function() l.at[1] = 0 end)
  l.position = { 3, -4 }
  check(l.position[2] == -4 and l.at == nil, "a position in its place")
  l.at = "top"
  check(l.at == "top" and l.position == nil, "the one set last counts")
  l.size, l.background, l.margin = 12, "red", 3
  check(l.size == 12 and l.margin == 3, "points")
  l.size, l.background, l.margin = nil, nil, nil
  check(l.size == nil and l.background == nil and l.margin == nil, "and back")
  local b = bar { ticks = { 0, 0.5 }, title = "T" }
  check(b.map == "magma" and b.ticks[2] == 0.5 and b.title == "T" and b.at == "right" and b.orientation == "vertical", "of a colour bar")
  b.ticks = nil
  check(b.ticks == nil, "round numbers again")
  local a = glint.axes {}
  check(a.labels[3] == "z" and a.at == "bottom left" and a.length == nil, "of axes")
  a.labels = { "a", "b", "c" }
  check(table.concat({ a.labels[1], a.labels[2], a.labels[3] }) == "abc", "names")
  check(a.box == nil and a.values == nil, "no box")
  a.box = { { 0, 0, 0 }, { 4, 0, 6 } }
  a.values = { { 1, 0, 0 }, { -1, 0, 2 } }
  check(a.box[2].z == 6 and a.values[1][1] == 1 and #a.box == 2, "a box, flat in one direction, and numbers that fall")
  raises("box: assign a whole table; its fields are read-only", function() a.box[1] = 0 end)
  raises("values: expected together with a box", function() a.box = nil end)
  a.values = nil
  a.box = nil
  check(a.box == nil and a.at == "bottom left", "and back")
end

function tests.errors()
  raises("label.text: string expected, got nil", glint.label, {})
  raises("label.text: string expected, got 5", glint.label, { text = 5 })
  raises("label.text: at most 383 bytes expected, got 384", glint.label, { text = ("a"):rep(384) })
  raises("label.text: string without a zero byte expected", glint.label, { text = "a\0b" })
  raises("label.txet: no such field; did you mean 'text'?", glint.label, { txet = "a" })
  raises("label.at: \"top left\", ", glint.label, { text = "a", at = "top middle" })
  raises("label.at: \"top left\", ", glint.label, { text = "a", at = { 1, 2, 3 } })
  raises("label.at: shares 0 .. 1 expected, got 2", glint.label, { text = "a", at = { 0, 2 } })
  raises("label.at: number expected, got string \"x\"", glint.label, { text = "a", at = { "x", 2 } })
  raises("label.position: {x, y} in pixels expected, got 5", glint.label, { text = "a", position = 5 })
  raises("label: at or position expected, got both", glint.label, { text = "a", position = { 1, 1 }, at = "top" })
  raises("label.size: points 1 .. 10000 expected, got 0", glint.label, { text = "a", size = 0 })
  raises("label.margin: points 0 .. 10000 expected, got -1", glint.label, { text = "a", margin = -1 })
  raises("label.opacity: number 0 .. 1 expected, got 1.5", glint.label, { text = "a", opacity = 1.5 })
  raises("label.background: colour >= 0 expected", glint.label, { text = "a", background = { 0, 0, -1 } })
  raises("colorbar.map: \"viridis\", \"magma\", \"cividis\", \"turbo\" or \"coolwarm\" expected, got string \"virids\"; did you mean \"viridis\"?",
    bar, { map = "virids" })
  raises("colorbar.low: number expected, got nil", glint.colorbar, { map = "magma", high = 1 })
  raises("colorbar.high: another number than low (0) expected, got 0", bar, { high = 0 })
  raises("colorbar.high: number at a finite distance from low (-1e+308) expected, got 1e+308", bar, { low = -1e308, high = 1e308 })
  raises("colorbar.ticks[2]: number 0 .. 1 expected, got 2", bar, { ticks = { 0, 2 } })
  raises("colorbar.ticks: 1 .. 16 numbers expected, got 0", bar, { ticks = {} })
  raises("colorbar.ticks: list of numbers expected, got 4", bar, { ticks = 4 })
  raises("colorbar.orientation: \"vertical\" or \"horizontal\" expected", bar, { orientation = "up" })
  raises("axes.labels: list of three strings expected", glint.axes, { labels = { "a", "b" } })
  raises("axes.labels: at most 63 bytes expected, got 64", glint.axes, { labels = { ("a"):rep(64), "b", "c" } })
  local unit = { { 0, 0, 0 }, { 1, 1, 1 } }
  raises("axes.box: two corners {{x, y, z}, {x, y, z}} expected, got 3", glint.axes, { box = 3 })
  raises("axes.box: two corners {{x, y, z}, {x, y, z}} expected", glint.axes, { box = { { 0, 0, 0 } } })
  raises("axes.box[2][3]: number expected, got nil", glint.axes, { box = { { 0, 0, 0 }, { 1, 1 } } })
  raises("axes.box[1][1]: finite number expected, got -inf", glint.axes, { box = { { -math.huge, 0, 0 }, { 1, 1, 1 } } })
  raises("axes.box: its lowest and its highest corner expected, got 2 to 1 along y", glint.axes, { box = { { 0, 2, 0 }, { 1, 1, 1 } } })
  raises("axes.box: ends at a finite distance expected, got -1e+308 to 1e+308 along z", glint.axes, { box = { { 0, 0, -1e308 }, { 1, 1, 1e308 } } })
  raises("axes.box: two corners expected, got one point", glint.axes, { box = { { 1, 2, 3 }, { 1, 2, 3 } } })
  raises("axes.values: expected together with a box, whose corners they describe", glint.axes, { values = unit })
  raises("axes.values: ends at a finite distance expected, got -1e+308 to 1e+308 along y", glint.axes,
    { box = unit, values = { { 0, -1e308, 0 }, { 1, 1e308, 1 } } })
  raises("axes.values: two numbers for the ends of z expected, got 5 twice", glint.axes, { box = unit, values = { { 0, 0, 5 }, { 1, 1, 5 } } })
  raises("axes.position: only for axes without a box; axes with a box lie along its edges", glint.axes, { box = unit, position = { 1, 1 } })
  raises("axes.length: only for axes without a box", glint.axes, { box = unit, length = 10 })
  raises("axes: at or box expected, got both", glint.axes, { box = unit, at = "top" })
  raises("axes.bxo: no such field; did you mean 'box'?", glint.axes, { bxo = unit })
  raises("label.box: no such field", glint.label, { text = "a", box = unit })
  local boxed = glint.axes { box = unit }
  raises("axes.at: only for axes without a box; axes with a box lie along its edges", function() boxed.at = "top" end)
  local l = glint.label { text = "a" }
  raises("label.size: finite number expected, got inf", function() l.size = math.huge end)
  check(l.size == nil, "it is as it was")
  local scene = scene_of(l)
  raises("scene.overlay: already in the scene", scene.add, scene, l)
  scene:remove(l)
  raises("scene.overlay: not in the scene", scene.remove, scene, l)
end

-- A logarithmic bar has powers of ten at equal distances.
-- A list of the user's own colours spreads evenly along the bar.
function tests.bars_of_ones_own()
  local function picture(fields)
    local given = { map = "viridis", low = 0.01, high = 100, size = 10, length = 100, ticks = { 0.1, 1, 10 }, position = { 5, 5 } }
    for name, value in pairs(fields) do given[name] = value end
    local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, glint.colorbar(given) }
    return scene:render { width = 80, height = 140 }
  end
  local function same(a, b)
    local path, texts = os.tmpname(), {}
    for i, image in ipairs { a, b } do
      assert(image:save(path .. ".png"))
      texts[i] = assert(io.open(path .. ".png", "rb")):read "a"
    end
    os.remove(path)
    os.remove(path .. ".png")
    return texts[1]:match "IDAT.*" == texts[2]:match "IDAT.*"
  end
  check(same(picture { scale = "log" }, picture { scale = "log", ticks = { 10, 0.1, 1 } }) == true, "ticks have places")
  check(not same(picture { scale = "log" }, picture {}), "logarithmic marks are elsewhere")
  check(same(picture { scale = "log", ticks = { 1 }, low = 0.01, high = 100 }, picture { ticks = { 1 }, low = -1, high = 3 }),
    "the middle of four decades is half way")
  local own = picture { map = { "red", "blue" } }
  check(not same(own, picture {}), "own colours are others")
  check(same(own, picture { map = glint.colorbar { map = { "red", "blue" }, low = 0, high = 1 }.map }), "they read as they are")
  check(glint.colorbar { map = "magma", low = 1, high = 2 }.scale == "linear" and picture { scale = "log", ticks = nil })
  for want, fields in pairs { ["colorbar.low: numbers above 0 at both ends"] = { low = 0, scale = "log" },
    ["colorbar.map: a list of at least two colours expected, got 1"] = { map = { "red" } },
    ["colorbar.scale: \"linear\" or \"log\" expected"] = { scale = "cubic" },
    ["colorbar.map: the function's result: {r, g, b}, a number or a colour name expected"] = { map = function() end } } do
    local good, message = pcall(picture, fields)
    check(not good and tostring(message):find(want, 1, true), "%s expected, got %s", want, message)
  end
end

function tests.pictures()
  local l = glint.label { text = "t = 0" }
  local scene = scene_of()
  local options = { width = 64, height = 40, output = "none" }
  local bare = scene:render(options)
  scene:add(l)
  local first = scene:render(options)
  l.text = "t = 1"
  local second = scene:render(options)
  l.text = ""
  local none = scene:render(options)
  scene:remove(l)
  check(bytes_of(bare) ~= bytes_of(first) and bytes_of(first) ~= bytes_of(second), "each text has its file")
  check(bytes_of(bare) == bytes_of(none) and bytes_of(bare) == bytes_of(scene:render(options)), "no text: the picture")
  check(bytes_of(first, { bits = 16 }) ~= bytes_of(bare, { bits = 16 }), "of another tone as well")
  for y = 0, 39, 7 do
    for x = 0, 63, 5 do check(first:pixel(x, y) == bare:pixel(x, y), "light at %d, %d", x, y) end
  end
end

-- ---- A cell, wrapped lines, letters ----

-- Writes a scene with one overlay to a file: 200 x 200 pixels, 50 per unit, with (1, 0.75) in the middle.
local function file_with(overlay, width)
  local camera = glint.camera { eye = { 1, 0.75, 10 }, direction = { 0, 0, -1 }, projection = "orthographic", height = 4 }
  local scene = glint.scene { camera = camera, overlay }
  local path = os.tmpname() .. ".png"
  assert(scene:render { width = width or 200, height = 200, output = "none" }:save(path))
  local picture, bytes = glint.read_image(path), assert(io.open(path, "rb")):read "a"
  os.remove(path)
  return picture, bytes:match "IDAT.*"
end

-- Counts how many of 21 points between two world positions are bright in a picture, within a pixel.
local function count_bright(picture, from, to)
  local count = 0
  for i = 0, 20 do
    local x, y = from[1] + (to[1] - from[1]) * i / 20, from[2] + (to[2] - from[2]) * i / 20
    local column, row, most = (x - 1) * 50 + 100, (0.75 - y) * 50 + 100, 0
    for dx = -1, 0 do
      for dy = -1, 0 do most = math.max(most, (picture:pixel(math.floor(column + 0.5) + dx, math.floor(row + 0.5) + dy))) end
    end
    count = count + (most > 0.05 and 1 or 0)
  end
  return count
end

function tests.axes_of_a_cell()
  local cell = { origin = { 0, 0, 0 }, a = { 2, 0, 0 }, b = { 1, 1.5, 0 }, c = { 0, 0, 1 } }
  local picture, bytes = file_with(glint.axes { box = cell })
  check(count_bright(picture, { 0, 0 }, { 1, 1.5 }) == 21, "b lies along the cell's side")
  check(count_bright(picture, { 0, 0 }, { 2, 0 }) == 21, "and a along its own")
  local upright = file_with(glint.axes { box = { { 0, 0, 0 }, { 3, 1.5, 1 } } })
  check(count_bright(upright, { 0, 0 }, { 1, 1.5 }) < 21, "of the box around it they do not")
  local _, measured = file_with(glint.axes { box = cell, values = { { 0, 0, 0 }, { 2, math.sqrt(1 + 1.5 ^ 2), 1 } } })
  check(bytes == measured, "numbers are lengths along the sides")
  local _, sized = file_with(glint.axes { box = { low = { 0, 0, 0 }, size = { 2, 1.5, 1 }, xy = 1, xz = 0, yz = 0 } })
  check(bytes == sized, "a box as readers give it")
  local _, left = file_with(glint.axes { box = { origin = { 0, 0, 1 }, a = { 2, 0, 0 }, b = { 1, 1.5, 0 }, c = { 0, 0, -1 } } })
  check(bytes == left, "a cell turned inside out")
  local _, straight = file_with(glint.axes { box = { origin = { 0, 0, 0 }, a = { 2, 0, 0 }, b = { 0, 1, 0 }, c = { 0, 0, 1 } },
    labels = { "x", "y", "z" } })
  local _, corners = file_with(glint.axes { box = { { 0, 0, 0 }, { 2, 1, 1 } } })
  check(straight == corners, "an upright cell is a box")
  local _, low = file_with(glint.axes { box = { low = { 0, 0, 0 }, size = { 2, 1, 1 } } })
  check(low == corners, "and an upright box with a size")
  picture = file_with(glint.axes { box = { a = { 2, 0, 0 }, b = { 1, 1.5, 0 } } })
  check(count_bright(picture, { 0, 0 }, { 1, 1.5 }) == 21, "a flat cell")
  local axes = glint.axes { box = cell }
  check(axes.labels[2] == "b" and axes.box.b[2] == 1.5 and axes.box.origin.x == 0, "it reads as it is")
  axes.box = { { 0, 0, 0 }, { 1, 1, 1 } }
  check(axes.labels[2] == "y" and axes.box[2].y == 1, "and becomes a box")
  raises("axes.box: expected sides a, b and c that span at least a plane", glint.axes, { box = { a = { 1, 0, 0 }, b = { 2, 0, 0 } } })
  raises("axes.box.b[2]: number expected, got nil", glint.axes, { box = { a = { 1, 0, 0 }, b = { 2 } } })
end

function tests.wide_lines_are_broken()
  for _, at in ipairs { "top left", "bottom", "right" } do
    local _, whole = file_with(glint.label { text = "alpha beta gamma", at = at, size = 13 }, 60)
    local _, lines = file_with(glint.label { text = "alpha\nbeta\ngamma", at = at, size = 13 }, 60)
    check(whole == lines, "at blanks, at %s", at)
    _, whole = file_with(glint.label { text = "alpha beta", at = at, size = 13 })
    _, lines = file_with(glint.label { text = "alpha\nbeta", at = at, size = 13 })
    check(whole ~= lines, "and not where they fit")
  end
  local _, placed = file_with(glint.label { text = "alpha beta gamma", position = { 2, 2 }, size = 13 }, 60)
  local _, lines = file_with(glint.label { text = "alpha\nbeta\ngamma", position = { 2, 2 }, size = 13 }, 60)
  check(placed ~= lines, "a label with a position is as it is")
end

-- Parts between two dollar signs are formulas in every text. A formula with a mistake is refused and changes nothing.
function tests.formulas()
  local label = glint.label { text = [[$\hat n\cdot\hat l$]] }
  raises([[label.text: expected a command that formulas have, got \foo at character 3]], function() label.text = [[a$\foo$]] end)
  check(label.text == [[$\hat n\cdot\hat l$]], "the text is unchanged")
  raises([[label.text: expected a } for the {, got none at character 2]], glint.label, { text = "${x$" })
  raises([[label.text: expected a formula between dollar signs (\$ is a dollar sign), got none at character 3]], glint.label, { text = "a $$" })
  raises([[label.text: expected at most 10 nested parts, got more at character 22]], glint.label,
    { text = "$" .. ("^{"):rep(20) .. "x" .. ("}"):rep(20) .. "$" })
  raises([[colorbar.title: expected a sign or {...} after \frac at character 2]], bar, { title = [[$\frac{a}$]] })
  raises([[axes.labels[2]: expected a { for each }, got a } at character 3]], glint.axes, { labels = { "x", "$y}$", "z" } })
  raises([[arrow.label: expected at most one ^ at a sign, got another at character 5]], glint.arrow,
    { from = { 0, 0, 0 }, to = { 1, 1, 1 }, label = "$x^2^3$" })
  local function same(a, b)
    local _, first = file_with(glint.label { text = a, size = 13 })
    local _, second = file_with(glint.label { text = b, size = 13 })
    return first == second
  end
  check(same([[\$5]], "$5"), "a lone dollar sign is a dollar sign")
  check(same([[\$5 and \$10]], "$5 and $10"), "two prices are no formula")
  check(same("$x$", "x"), "one letter in the bitmap font")
  check(same([[$\alpha\le β$]], [[$α≤\beta$]]), "characters beyond ASCII")
  check(not same("$x^2$", "x^2") and not same("$x^2$", "$x_2$"), "scripts")
  check(not same([[$\frac{a}{b}$]], "$a/b$"), "a fraction")
end

-- A formula is not broken between lines, and its height counts.
function tests.sizes_of_formulas()
  for _, text in ipairs { [[alpha $\sqrt{a + b}$ beta]], [[$\frac{a + b}{c}$]], "one\n$x_{y_z}$\ntwo" } do
    local camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }
    local scene = glint.scene { camera = camera, background = 0, glint.label { text = text, size = 13, at = "bottom" } }
    local picture = scene:render { width = 60, height = 100, output = "none" }
    check(#bytes_of(picture) > 0, "%s", text)
  end
  local _, whole = file_with(glint.label { text = "alpha $a + b$", size = 13 }, 60)
  local _, lines = file_with(glint.label { text = "alpha\n$a + b$", size = 13 }, 60)
  check(whole == lines, "broken before the formula")
end

function tests.letters_that_run_left()
  for letter, code in pairs { ["ש"] = "U+05E9", ["م"] = "U+0645", ["ܐ"] = "U+0710", ["ﷺ"] = "U+FDFA" } do
    local want = ("letters that run from left to right expected, got '%s' (%s), which runs from right to left"):format(letter, code)
    raises("label.text: " .. want, glint.label, { text = "t = 1 " .. letter })
    raises("axes.labels[1]: " .. want, glint.axes, { labels = { letter, "y", "z" } })
    raises("colorbar.title: " .. want, glint.colorbar, { map = "magma", low = 0, high = 1, title = letter })
  end
  check(glint.label { text = "αβ Ж 中 →" }.text == "αβ Ж 中 →", "others are drawn")
end

-- Every size and position gives a picture.
function tests.extremes()
  local scene = scene_of()
  local names = { "top left", "top", "top right", "left", "center", "right", "bottom left", "bottom", "bottom right" }
  local made = {}
  for _, at in ipairs(names) do
    for _, size in ipairs { 1, 13, 40, 10000 } do
      made[#made + 1] = glint.label { text = "Wide\nγ\n\n", at = at, size = size, background = "red", opacity = 0.3 }
      made[#made + 1] = bar { at = at, size = size, orientation = size > 20 and "horizontal" or nil, title = "long title", high = size * 1e-9 }
      made[#made + 1] = glint.axes { at = at, size = size, background = 0 }
    end
  end
  for _, position in ipairs { { -1e6, 0 }, { 1e6, 1e6 }, { -3, -3 }, { 63.9, 39.9 } } do
    made[#made + 1] = glint.label { text = "a", position = position, size = 10000, background = 1 }
    made[#made + 1] = bar { position = position, length = 10000 }
  end
  for _, range in ipairs { { -1e308, 1e307 }, { 0, 5e-324 }, { 1, 1 + 2 ^ -52 }, { 5, -5 }, { 1e300, 2e300 }, { -1e-300, 1e-300 } } do
    made[#made + 1] = bar { low = range[1], high = range[2] }
  end
  for _, box in ipairs { { { -1, -1, -1 }, { 1, 1, 1 } }, { { -20, -20, -20 }, { 20, 20, 20 } }, { { -2, 0, -30 }, { 2, 0, 30 } },
    { { 0, 0, 0 }, { 1e300, 1e-300, 1 } }, { { -1e300, -1e300, -1e300 }, { 1e300, 1e300, 0 } }, { { 0, 0, 20 }, { 1, 1, 30 } },
    { { 0, 0, 0 }, { 5e-324, 0, 0 } }, { { 0, 0, 8.99 }, { 1, 1, 9 } } } do
    made[#made + 1] = glint.axes { box = box }
    made[#made + 1] = glint.axes { box = box, size = 3, labels = { "", "long name", "x\ny" }, values = { { 1, 1e307, 0 }, { 0, -1e307, 1e-300 } } }
  end
  for _, object in ipairs(made) do
    scene:add(object)
    check(#bytes_of(scene:render { width = 64, height = 40, output = "none" }, { dpi = 1e6 }) > 0, "%s", tostring(object))
    check(#bytes_of(scene:render { width = 1, height = 1, output = "none" }) > 0, "%s in one pixel", tostring(object))
    scene:remove(object)
  end
end

tally.run(tests)
tally.finish()
