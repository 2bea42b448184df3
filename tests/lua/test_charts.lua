-- glint.chart: fields, errors, and frames that set them. For positions see tests/engine/test_charts.c.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"
local NAN <const> = 0 / 0

local raises = tally.raises

local function chart_of(series, fields)
  local t = { series = { series } }
  for key, value in pairs(fields or {}) do t[key] = value end
  return glint.chart(t)
end

-- Returns the bytes of a picture with only this chart.
local function bytes_of(chart, width, height)
  local path = os.tmpname() .. ".png"
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 1 }, at = { 0, 0, 0 } }, background = "white", chart }
  assert(scene:render({ width = width or 160, height = height or 100 }):save(path))
  local file = assert(io.open(path, "rb"))
  local bytes = file:read "a"
  file:close()
  os.remove(path)
  os.remove((path:gsub("%.png$", "")))
  return bytes
end

local tests = {}

function tests.fields()
  local c = glint.chart { x = { 1, 2, 3 }, title = "T", x_label = "x / m", y_scale = "log", x_range = { 0, 4 },
    series = { { label = "square", y = function(x) return x * x end }, { x = { 5 }, y = { 6 }, dots = true, color = "red", width = 0 } } }
  local one, two = c.series[1], c.series[2]
  check(#c.series == 2 and one.label == "square" and #one.x == 3 and one.y[3] == 9 and one.color == nil and not one.dots, "a function of x")
  check(two.x[1] == 5 and two.y[1] == 6 and two.dots and two.width == 0 and two.color.x == 1, "its own x and look")
  check(c.x_label == "x / m" and c.y_label == "" and c.x_scale == "linear" and c.y_scale == "log" and c.x_range[2] == 4, "axes")
  check(c.y_range == nil and c.extent == nil and c.at == "center" and c.title == "T", "defaults")
  c.series = { { y = { 4, NAN, 5 } } }
  check(#c.series == 1 and c.series[1].x[3] == 3 and c.series[1].y[2] ~= c.series[1].y[2] and c.y_scale == "log", "x is 1, 2, 3; a gap")
  c.series = { { x = glint.array({ 1, 2 }, "integer"), y = glint.array { 0.5, NAN } } }
  check(c.series[1].x[2] == 2 and c.series[1].y[1] == 0.5 and c.series[1].y[2] ~= c.series[1].y[2], "arrays")
  c.series = { { x = glint.array { 1, 3 }, y = function(x) return 2 * x end } }
  check(c.series[1].y[2] == 6, "a function of an array")
  c.series = { { y = { 4, NAN, 5 } } }
  c.x_range, c.extent = nil, { 90, 60 }
  check(c.x_range == nil and c.extent[2] == 60, "nil and back")
  collectgarbage()
  check(c.series[1].y[1] == 4, "the chart owns its curves")
end

function tests.refused()
  raises("chart.series", glint.chart, {})
  raises("chart.series: list of series expected, got 5", glint.chart, { series = 5 })
  raises("chart.series: 1 .. 16 series expected, got 0", glint.chart, { series = {} })
  raises("chart.series[1].y", chart_of, {})
  raises("chart.series[1].y: as many numbers as in x expected: 3, got 2", chart_of, { x = { 1, 2, 3 }, y = { 1, 2 } })
  raises("chart.series[1].y: as many numbers as in x expected: 1, got 2", chart_of, { y = { 1, 2 } }, { x = { 1 } })
  raises("chart.series[1].x: list of the numbers at which y is called expected", chart_of, { y = math.sin })
  raises("chart.series[1]: 1 .. 1000000 points expected, got 0", chart_of, { y = {} })
  raises("chart.series[1]: at least one point that is not NaN expected", chart_of, { y = { NAN } })
  raises("chart.series[1].y[2]: finite number, or NaN for a gap, expected, got inf", chart_of, { y = { 1, math.huge } })
  raises("chart.series[1].y[2]: number expected, got string \"two\"", chart_of, { y = { 1, "two" } })
  raises("chart.series[1].y: list or array of numbers, or function of x expected", chart_of, { y = glint.array { { 1, 2 } } })
  raises("chart.series[1].y: as many numbers as in x expected: 1, got 2", chart_of, { x = { 1 }, y = glint.array { 1, 2 } })
  raises("chart.series[1].y[1]: this has no derivative", chart_of, { y = { glint.variable("v", 1) } })
  raises("chart.series[1].y(2.0)", chart_of, { x = { 2 }, y = function() end })
  raises("no y today", chart_of, { x = { 2 }, y = function() error "no y today" end })
  raises("did you mean 'label'", chart_of, { y = { 1 }, lable = "a" })
  raises("chart.series[1].label: at most 127 bytes", chart_of, { y = { 1 }, label = ("a"):rep(128) })
  raises("chart.series[1].width: points 0 .. 1000 expected, got -1", chart_of, { y = { 1 }, width = -1 })
  raises("chart.series[1].y[2]: number above 0, or NaN for a gap, for a logarithmic axis expected, got 0", chart_of, { y = { 1, 0 } },
    { y_scale = "log" })
  raises("chart.series[1].x[1]: number above 0", chart_of, { x = { -1 }, y = { 1 } }, { x_scale = "log" })
  raises("chart.x_range: two different numbers expected, got 1 and 1", chart_of, { y = { 1 } }, { x_range = { 1, 1 } })
  raises("chart.y_range: numbers above 0 for a logarithmic axis", chart_of, { y = { 1 } }, { y_scale = "log", y_range = { 0, 1 } })
  raises("chart.y_scale", chart_of, { y = { 1 } }, { y_scale = "logarithmic" })
  raises("chart.extent: points 1 .. 10000 expected, got 0", chart_of, { y = { 1 } }, { extent = { 0, 10 } })
  local c = chart_of { y = { 1, -1 } }
  raises("number above 0", function() c.y_scale = "log" end)
  check(c.y_scale == "linear", "a refused field is unchanged")
  raises("only glint.chart { ... } takes x", function() c.x = { 1 } end)
end

function tests.pictures()
  local c = chart_of { y = { 1, 3, 2 }, label = "a" }
  local before = bytes_of(c)
  check(before == bytes_of(chart_of { y = { 1, 3, 2 }, label = "a" }), "the same chart, the same bytes")
  c.series = { { y = { 1, 3, 2.5 }, label = "a" } }
  check(before ~= bytes_of(c), "another chart")
  c.series = { { y = { 1, 3, 2 }, label = "a" } }
  check(before == bytes_of(c), "and back")
  for _, size in ipairs { { 1, 1 }, { 20, 300 }, { 300, 12 }, { 64, 36 } } do check(#bytes_of(c, size[1], size[2]) > 0, "%d x %d", size[1], size[2]) end
  for _, y in ipairs { { 5 }, { 0, 0 }, { -1e300, 1e300 }, { 1e-300, 2e-300 }, { 1, NAN, 2, NAN, NAN, 3 } } do
    check(#bytes_of(chart_of({ y = y, dots = true })) > 0, "values from %g", y[1])
  end
  check(#bytes_of(chart_of({ y = { 1e-300, 1e300 } }, { y_scale = "log" })) > 0, "600 powers of ten")
  check(#bytes_of(chart_of({ x = { 0, 1e9 }, y = { 0, 1e9 } }, { x_range = { 1, 2 }, y_range = { 2, 1 } })) > 0, "far outside, downwards")
end

function tests.without_a_camera()
  local c = chart_of { y = { 1, 3, 2 } }
  local path = os.tmpname() .. ".png"
  local picture = glint.scene { background = "white", c }:render { width = 160, height = 100 }
  assert(picture:save(path))
  local file = assert(io.open(path, "rb"))
  check(file:read "a" == bytes_of(c), "a chart needs no camera, and no camera changes it")
  file:close()
  os.remove(path)
  os.remove((path:gsub("%.png$", "")))
  raises("camera: the scene has none", function() glint.scene { glint.label { text = "a" } }:render {} end)
end

function tests.one_curve()
  local x, y = { 1, 2, 3 }, { 4, 9, 1 }
  local whole = glint.chart { series = { { x = x, y = y, label = "a" } } }
  local short = glint.chart { x = x, y = y, labels = { "a" } }
  collectgarbage()
  check(bytes_of(short) == bytes_of(whole), "y is a single series, and labels name the series")
  raises("chart: series or y expected, got both", glint.chart, { y = y, series = { { y = y } } })
  raises("chart.series: list of series expected, got nil", glint.chart, { x = x })
  raises("chart.series[1].y: as many numbers as in x expected: 2, got 3", glint.chart, { x = { 1, 2 }, y = y })
  raises("chart.labels[1]: string expected, got 3", glint.chart, { y = y, labels = { 3 } })
  raises("chart.labels: list of texts, one for each series expected, got string \"a\"", glint.chart, { y = y, labels = "a" })
  raises("only glint.chart { ... } takes y", function() whole.y = y end)
end

function tests.save()
  local c, path = chart_of { y = { 1, 3, 2 } }, os.tmpname()
  check(c:save(path .. ".png", { width = 160, height = 100 }), "saved")
  local file = assert(io.open(path .. ".png", "rb"))
  check(file:read "a" == bytes_of(c), "save writes what a scene with the chart renders")
  file:close()
  check(c:save(path .. ".svg") and io.open(path .. ".svg"):read "a":find "<svg", "an .svg")
  check(select("#", c:save "/proc/none/a.png") == 2, "nil and a message where there is no folder")
  raises("save.path: name ending in .png", c.save, c, "a.xyz")
  raises("save.widht: no such field; did you mean 'width'?", c.save, c, "a.png", { widht = 1 })
  raises("width: whole number", c.save, c, "a.png", { width = 0.5 })
  for _, ending in ipairs { "", ".png", ".svg" } do os.remove(path .. ending) end
end

tally.run(tests)
tally.finish()
