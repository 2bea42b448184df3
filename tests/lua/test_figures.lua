-- Arrows, lines, arcs and labels at points of the world: their pixels against camera:project, their hidden parts
-- against scene:cast, free positions for labels, and errors and warnings.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"
local vec = glint.vector

local WIDTH, HEIGHT = 240, 160

local raises = tally.raises

local CAMERAS = {
  perspective = glint.camera { eye = { 3, 2, 8 }, at = { 0.3, 0.2, 0 }, fov = 40 },
  orthographic = glint.camera { eye = { 3, 2, 8 }, at = { 0.3, 0.2, 0 }, projection = "orthographic", height = 5 },
}

local function scene_of(camera, objects)
  local scene = glint.scene { camera = camera }
  for _, object in ipairs(objects) do scene:add(object) end
  return scene
end

-- Returns the picture of a scene as written to a file, as a function of the pixel: green, 0 .. 1 linear, 0 outside.
local function draw(scene, options, render)
  local path, given = os.tmpname() .. ".png", { width = WIDTH, height = HEIGHT, output = "none" }
  for key, value in pairs(render or {}) do given[key] = value end
  assert(scene:render(given):save(path, options))
  local picture = glint.read_image(path)
  os.remove(path)
  return function(x, y)
    x, y = math.floor(x), math.floor(y)
    if x < 0 or y < 0 or x >= picture.width or y >= picture.height then return 0 end
    return (select(2, picture:pixel(x, y)))
  end, picture
end

-- Counts the pixels brighter than a limit, and their bounds.
local function lit(at, limit)
  local count, low, high = 0, { WIDTH, HEIGHT }, { -1, -1 }
  for y = 0, HEIGHT - 1 do
    for x = 0, WIDTH - 1 do
      if at(x, y) > (limit or 0) then
        count = count + 1
        low[1], low[2] = math.min(low[1], x), math.min(low[2], y)
        high[1], high[2] = math.max(high[1], x), math.max(high[2], y)
      end
    end
  end
  return count, low, high
end

local function project(camera, point)
  local x, y = camera:project(point, WIDTH, HEIGHT)
  return assert(x), y
end

local tests = {}

function tests.fields()
  local a = glint.arrow { from = { 0, 0, 0 }, to = { 1, 2, 3 } }
  check(a.from == vec(0, 0, 0) and a.to.z == 3 and a.label == "" and a.width == nil and a.hidden == "drawn", "defaults of an arrow")
  a.label, a.width, a.hidden, a.from = "n", 2, "dashed", { 1, 1, 1 }
  check(a.label == "n" and a.width == 2 and a.hidden == "dashed" and a.from.x == 1, "they can be set")
  local arc = glint.arc { at = { 1, 0, 0 }, from = { 2, 0, 0 }, to = { 0, 3, 0 }, name = "phi" }
  check(arc.at.x == 1 and arc.from.x == 2 and arc.radius == nil and tostring(arc) == "arc 'phi'", "of an arc")
  local l = glint.label { text = "a", at_point = { 1, 2, 3 } }
  check(l.at_point.y == 2 and l.at == nil and l.position == nil, "a label at a point")
  l.at = "top"
  check(l.at_point == nil and l.at == "top", "the place set last counts: at")
  l.at_point = { 0, 0, 1 }
  check(l.at_point.z == 1 and l.at == nil, "at_point")
  l.position = { 3, 4 }
  check(l.at_point == nil and l.position[1] == 3, "position")
  l.at_point = { 0, 0, 1 }
  check(l.position == nil, "and at_point again")
end

function tests.errors()
  local from, to = { 0, 0, 0 }, { 1, 0, 0 }
  raises("arrow.from: {x, y, z} expected, got nil", glint.arrow, { to = to })
  raises("arrow.to[2]: number expected, got string", glint.arrow, { from = from, to = { 1, "x", 0 } })
  raises("arrow.to[1]: finite number expected, got inf", glint.arrow, { from = from, to = { math.huge, 0, 0 } })
  raises("line.from[3]: finite number expected, got nan", glint.line, { from = { 0, 0, 0 / 0 }, to = to })
  raises("line.to: ends at a finite distance expected, got -1e+308 to 1e+308 along y", glint.line, { from = { 0, -1e308, 0 }, to = { 0, 1e308, 0 } })
  raises("arrow.width: points 0 .. 10000 expected, got -1", glint.arrow, { from = from, to = to, width = -1 })
  raises("arrow.hidden: \"drawn\", \"dashed\" or \"none\" expected", glint.arrow, { from = from, to = to, hidden = "dotted" })
  raises("label.hidden: drawn or none expected for a label, got dashed", glint.label,
    { text = "a", at_point = from, hidden = "dashed" })
  raises("label.at_point[1]: finite number expected, got nan", glint.label, { text = "a", at_point = { 0 / 0, 0, 0 } })
  raises("arrow.lable: no such field; did you mean 'label'?", glint.arrow, { from = from, to = to, lable = "n" })
  raises("arrow.at: no such field", glint.arrow, { from = from, to = to, at = "top" })
  raises("arrow.label: at most 383 bytes expected, got 384", glint.arrow, { from = from, to = to, label = ("a"):rep(384) })
  raises("arrow.label: letters that run from left to right expected", glint.arrow, { from = from, to = to, label = "ש" })
  raises("arc.at: {x, y, z} expected, got nil", glint.arc, { from = to, to = to })
  raises("arc.to: ", glint.arc, { at = from, from = to, to = { 0, 0, 0 } })
  raises("arc.radius: number > 0 expected, got 0", glint.arc, { at = from, from = to, to = to, radius = 0 })
  raises("label.at_point[1]: finite number expected, got nan", glint.label, { text = "a", at_point = { 0 / 0, 0, 0 } })
  raises("label: at_point or at expected, got both", glint.label, { text = "a", at_point = from, at = "top" })
  raises("label: at_point or position expected, got both", glint.label, { text = "a", at_point = from, position = { 1, 1 } })
  local a = glint.arrow { from = from, to = to }
  raises("arrow.to[1]: finite number expected, got nan", function() a.to = { 0 / 0, 0, 0 } end)
  check(a.to.x == 1, "it is as it was")
end

-- A line covers the pixels within half its width of the line between the projected ends, and no others.
function tests.lines()
  local from, to = vec(-1.5, -0.7, 1), vec(1.2, 1.1, -2)
  for name, camera in pairs(CAMERAS) do
    local at = draw(scene_of(camera, { glint.line { from = from, to = to, width = 3 } }))
    local x0, y0 = project(camera, from)
    local x1, y1 = project(camera, to)
    local length, wrong = math.sqrt((x1 - x0) ^ 2 + (y1 - y0) ^ 2), 0
    for y = 0, HEIGHT - 1 do
      for x = 0, WIDTH - 1 do
        local px, py = x + 0.5 - x0, y + 0.5 - y0
        local along = math.max(0, math.min(1, (px * (x1 - x0) + py * (y1 - y0)) / length ^ 2))
        local away = math.sqrt((px - along * (x1 - x0)) ^ 2 + (py - along * (y1 - y0)) ^ 2)
        local value = at(x, y)
        if (away < 0.99 and value < 0.999) or (away > 2.01 and value > 0) then wrong = wrong + 1 end
      end
    end
    check(wrong == 0, "%s: %d pixels are wrong", name, wrong)
  end
end

-- The head is wide behind the tip and ends at the tip. The width is in points.
function tests.arrows()
  local camera = CAMERAS.orthographic
  local from, to = vec(-1.5, 0, 0), vec(1.5, 0.4, 0)
  local arrow = glint.arrow { from = from, to = to, width = 2 }
  local scene = scene_of(camera, { arrow })
  local at = draw(scene)
  local x0, y0 = project(camera, from)
  local x1, y1 = project(camera, to)
  local length = math.sqrt((x1 - x0) ^ 2 + (y1 - y0) ^ 2)
  local dx, dy = (x1 - x0) / length, (y1 - y0) / length
  local function value(along, across) return at(x1 - along * dx - across * dy, y1 - along * dy + across * dx) end
  check(value(-1.5, 0) == 0 and value(2.5, 0) > 0.9, "the tip")
  check(value(9, 2) > 0.9 and value(9, -2) > 0.9 and value(9, 5) == 0 and value(9, -5) == 0, "the head")
  check(value(20, 0) > 0.9 and value(20, 2.5) == 0 and value(20, -2.5) == 0, "the shaft")
  local small = lit(at)
  local large = lit((draw(scene, { dpi = 144 })))
  check(large > 1.7 * small and large < 2.3 * small, "at 144 dpi a point has two pixels: %d, %d", small, large)
  arrow.from, arrow.to = { 0, 0, 0 }, 0.2 * camera.eye
  local dots, low, high = lit((draw(scene_of(glint.camera { eye = camera.eye, at = { 0, 0, 0 } }, { arrow }))))
  check(dots > 0 and high[1] - low[1] < 4 and high[2] - low[2] < 4, "an arrow that points at the eye is a dot")
end

-- The points of an arc are at its radius, between the two directions.
function tests.arcs()
  local corner, radius = vec(0.2, 0.1, 0.3), 1.3
  for name, camera in pairs(CAMERAS) do
    for _, ends in ipairs { { vec(1, 0, 0), vec(0, 2, 0.5) }, { vec(1, 1, 0), vec(-1, 0.2, 1) } } do
      local a, b = ends[1]:unit(), ends[2]:unit()
      local at = draw(scene_of(camera, { glint.arc { at = corner, from = ends[1], to = ends[2], radius = radius, width = 3 } }))
      local angle, missing = math.acos(a:dot(b)), 0
      local across = (b - a:dot(b) * a):unit()
      for i = 0, 50 do
        local turn = angle * i / 50
        local x, y = project(camera, corner + radius * (math.cos(turn) * a + math.sin(turn) * across))
        if at(x, y) < 0.8 then missing = missing + 1 end
      end
      check(missing == 0, "%s: %d points are missing", name, missing)
      local x, y = project(camera, corner + radius * (math.cos(1.1 * angle) * a + math.sin(1.1 * angle) * across))
      check(at(x, y) == 0, "%s: nothing beyond its end", name)
      check(at(project(camera, corner)) == 0, "%s: nothing in the corner", name)
    end
    local at = draw(scene_of(camera, { glint.arc { at = corner, from = { 1, 0, 0 }, to = { -1, 0, 0 } } }))
    check(lit(at) > 20, "%s: opposite directions have a half circle", name)
    local _, low, high = lit((draw(scene_of(camera, { glint.arc { at = corner, from = { 1, 0, 0 }, to = { 0, 1, 0 } } }))))
    check(high[1] - low[1] < 20 and high[2] - low[2] < 20 and high[2] - low[2] > 8, "%s: a twelfth of the height", name)
  end
end

-- The label of a point begins next to the projected point.
function tests.labels()
  local point = vec(0.4, -0.3, 1)
  for name, camera in pairs(CAMERAS) do
    local x, y = project(camera, point)
    local _, low, high = lit((draw(scene_of(camera, { glint.label { text = "M", at_point = point, size = 13, margin = 4 } }))))
    check(low[1] > x and low[1] < x + 8 and high[2] < y and high[2] > y - 12, "%s: above and to the right of %g, %g", name, x, y)
  end
end

-- Returns the rectangle of a solid background of one label.
local function box_of(objects, color, render)
  local _, picture = draw(scene_of(CAMERAS.orthographic, objects), nil, render)
  local low, high = { math.huge, math.huge }, { -1, -1 }
  for y = 0, picture.height - 1 do
    for x = 0, picture.width - 1 do
      local values = { picture:pixel(x, y) }
      if values[color] > 0.9 and values[color % 3 + 1] < 0.1 then
        low[1], low[2] = math.min(low[1], x), math.min(low[2], y)
        high[1], high[2] = math.max(high[1], x), math.max(high[2], y)
      end
    end
  end
  return low, high
end

function tests.free_places()
  local function label(color, point) return glint.label { text = "MMM", at_point = point or { 0.3, 0.2, 0 }, size = 13, color = color, background = color } end
  local red, green, blue = label "red", label "lime", label "blue"
  local boxes = { { box_of({ red, green, blue }, 1) }, { box_of({ red, green, blue }, 2) }, { box_of({ red, green, blue }, 3) } }
  for i = 1, 3 do
    check(boxes[i][2][1] - boxes[i][1][1] >= 23 and boxes[i][2][2] - boxes[i][1][2] >= 12, "label %d is whole", i)
    for k = 1, i - 1 do
      local a, b = boxes[i], boxes[k]
      check(a[2][1] < b[1][1] or b[2][1] < a[1][1] or a[2][2] < b[1][2] or b[2][2] < a[1][2], "labels %d and %d overlap", k, i)
    end
  end
  local low = box_of({ red }, 1)
  local line = glint.line { from = { 0.31, 0.2, 0 }, to = { 1.5, 1.4, 0 } }
  local moved = box_of({ red, line }, 1)
  check(moved[1] ~= low[1] or moved[2] ~= low[2], "a label goes out of a line's way")
  -- A point at the right border has its label at its left.
  local camera, edge = CAMERAS.orthographic, nil
  for i = 0, 400 do
    local point = vec(0.3 + i / 100, 0.2, 0)
    if project(camera, point) < WIDTH - 2 then edge = point end
  end
  local inner, outer = box_of({ label("red", edge) }, 1)
  check(outer[1] < WIDTH and outer[1] - inner[1] >= 23, "inside the picture: %g .. %g", inner[1], outer[1])
end

-- Whether two rectangles, each { low, high }, have a pixel in common.
local function overlap(a, b)
  return a[1][1] <= b[2][1] and b[1][1] <= a[2][1] and a[1][2] <= b[2][2] and b[1][2] <= a[2][2]
end

-- Fourteen labels at one point cover neither each other nor a title that is added after them.
function tests.crowds()
  local objects, boxes = {}, {}
  for i = 1, 14 do
    objects[i] = glint.label { text = "M" .. i, at_point = { 0.3, 0.2, 0 }, size = 13, color = "blue", background = "blue" }
  end
  objects[15] = glint.label { text = "TITLE", at = "center", size = 13, color = "blue", background = "blue" }
  for i, object in ipairs(objects) do
    object.color, object.background = "red", "red"
    boxes[i] = { box_of(objects, 1) }
    object.color, object.background = "blue", "blue"
    check(boxes[i][2][1] - boxes[i][1][1] >= 15 and boxes[i][2][2] - boxes[i][1][2] >= 12, "label %d is whole", i)
    for k = 1, i - 1 do check(not overlap(boxes[i], boxes[k]), "labels %d and %d overlap", k, i) end
  end
end

-- A label with hidden = "none" is drawn exactly if a ray from the eye reaches its point.
function tests.hidden_labels()
  local ball = glint.sphere { center = { 0.3, 0.2, 0.5 }, radius = 0.8, material = glint.material { diffuse = 0 } }
  for name, camera in pairs(CAMERAS) do
    local label = glint.label { text = "M", at_point = { 0, 0, 0 }, hidden = "none" }
    local scene, counts = scene_of(camera, { ball, label }), { 0, 0 }
    local forward = (vec(0.3, 0.2, 0) - camera.eye):unit()
    for i = -6, 6 do
      local point = vec(0.3 + i / 4, 0.2 + i / 9, -0.4)
      local way = camera.projection == "orthographic" and forward * (point - camera.eye):dot(forward) or point - camera.eye
      local hit = scene:cast(point - way, way)
      local hides = hit ~= nil and hit.t < 1
      label.at_point = point
      counts[hides and 1 or 2] = counts[hides and 1 or 2] + 1
      check((lit((draw(scene))) == 0) == hides, "%s: the label at %s", name, tostring(point))
    end
    check(counts[1] > 3 and counts[2] > 3, "%s: %d points are hidden, %d are not", name, counts[1], counts[2])
    label.hidden, label.at_point = "drawn", { 0.3, 0.2, -0.4 }
    check(lit((draw(scene))) > 0, "%s: drawn through by default", name)
  end
  local on = glint.label { text = "M", at_point = { 0.3, 0.2, 1.3 }, hidden = "none" }
  check(lit((draw(scene_of(CAMERAS.perspective, { ball, on })))) > 0, "a surface does not hide a point that lies on it")
end

-- A point of a line is drawn exactly if a ray from the eye reaches the point.
function tests.hidden_parts()
  local shapes = {
    glint.sphere { center = { 0.3, 0.2, 0.5 }, radius = 0.8, material = glint.material { diffuse = 0, specular = 0 } },
    glint.box { min = { -1.6, -1, -0.2 }, max = { -1, 1, 0.6 }, material = glint.material { diffuse = 0, specular = 0 } },
  }
  local from, to = vec(-2.4, -0.9, -0.8), vec(2.2, 1.1, -0.3)
  for name, camera in pairs(CAMERAS) do
    local line = glint.line { from = from, to = to, width = 3, hidden = "none" }
    local scene = scene_of(camera, shapes)
    scene:add(line)
    local forward = (vec(0.3, 0.2, 0) - camera.eye):unit()
    local function is_hidden(point)
      local way = point - camera.eye
      if camera.projection == "orthographic" then way = forward * way:dot(forward) end
      local hit = scene:cast(point - way, way)
      return hit ~= nil and hit.t < 1 - 1e-9
    end
    local at, flags, wrong, hidden, shown = draw(scene), {}, 0, 0, 0
    for i = 0, 800 do flags[i] = is_hidden(from + i / 800 * (to - from)) end
    for i = 20, 780 do
      local uniform = true
      for k = i - 20, i + 20 do uniform = uniform and flags[k] == flags[i] end
      local value = at(project(camera, from + i / 800 * (to - from)))
      if uniform and (flags[i] and value > 0 or not flags[i] and value < 0.9) then wrong = wrong + 1 end
      if uniform and flags[i] then hidden = hidden + 1 elseif uniform then shown = shown + 1 end
    end
    check(wrong == 0 and hidden > 50 and shown > 50, "%s: %d points are wrong of %d hidden, %d shown", name, wrong, hidden, shown)
    local hide = lit(at)
    line.hidden = "drawn"
    local all = lit((draw(scene)))
    line.hidden = "dashed"
    local dashed = lit((draw(scene)))
    check(hide < dashed and dashed < all, "%s: %d pixels, %d with dashes, %d in all", name, hide, dashed, all)
  end
end

-- Casts rays only to the parts of a curve in or near the picture: 1e8 pixels of an arc would take minutes.
function tests.parts_outside_the_picture()
  local scene = scene_of(CAMERAS.perspective, { glint.sphere { center = { 0, 0, 0 }, radius = 1 } })
  for _, radius in ipairs { 1e7, 1e20, 1e300 } do
    scene:add(glint.arc { at = { 0, 0, -1 }, from = { 1, 0, 0 }, to = { 0, 1, 0 }, radius = radius, hidden = "dashed" })
  end
  local start = os.clock()
  draw(scene)
  check(os.clock() - start < 20, "%g s", os.clock() - start)
end

-- A surface does not hide a line that begins on it and leaves it. A hidden tip has neither head nor label.
function tests.ends_on_surfaces()
  local camera = CAMERAS.perspective
  local black = glint.material { diffuse = 0, specular = 0 }
  local function count(center, from, to, hidden)
    return lit((draw(scene_of(camera, { glint.sphere { center = center, radius = 1, material = black },
      glint.arrow { from = from, to = to, label = "n", hidden = hidden } }))))
  end
  local up = vec(0, 0.6, 0.8)
  check(count({ 0, 0, 0 }, up, 2 * up, "none") == count({ 0, 0, 0 }, up, 2 * up, "drawn"), "a normal is visible")
  check(count({ 0, 0, 0 }, { 0, 0, -1.5 }, { 0.1, 0, -1.6 }, "none") == 0, "an arrow behind the sphere")
  check(count({ 0, 0, 0 }, { 0, 0, -1.5 }, { 0.1, 0, -1.6 }, "drawn") > 0, "drawn through")
end

-- A moved camera or shape gives the same picture as a new scene, also with refined edges.
function tests.changes()
  local function make(x, eye)
    local ball = glint.sphere { center = { x, 0, 1 }, radius = 0.7 }
    local line = glint.line { from = { -2, -0.5, 0 }, to = { 2, 0.5, 0 }, hidden = "none", label = "a", width = 3 }
    local camera = glint.camera { eye = eye, at = { 0, 0, 0 } }
    return glint.scene { camera = camera, ambient = 0.3, ball, line }, ball, line, camera
  end
  for _, options in ipairs { {}, { samples = 4, adaptive = 0.05 } } do
    local scene, ball, line, camera = make(0, { 0, 0, 9 })
    local before = draw(scene, nil, options)
    ball.center, camera.eye = { 1, 0, 1 }, { 1, 1, 8 }
    local after, fresh = draw(scene, nil, options), draw(make(1, { 1, 1, 8 }), nil, options)
    line.hidden = "drawn"
    local through, wrong, moved, drawn = draw(scene, nil, options), 0, 0, 0
    for y = 0, HEIGHT - 1 do
      for x = 0, WIDTH - 1 do
        if after(x, y) ~= fresh(x, y) then wrong = wrong + 1 end
        if after(x, y) ~= before(x, y) then moved = moved + 1 end
        if after(x, y) ~= through(x, y) then drawn = drawn + 1 end
      end
    end
    check(wrong == 0 and moved > 100 and drawn > 50, "%d pixels are wrong, %d moved, %d drawn through", wrong, moved, drawn)
  end
end

-- A region shows its part of the picture.
function tests.regions()
  local camera = CAMERAS.perspective
  local scene = scene_of(camera, { glint.sphere { center = { 0, 0, 0 }, radius = 1 },
    glint.arrow { from = { -2, -1, -1 }, to = { 2, 1, -1 }, label = "a", hidden = "dashed" }, glint.label { text = "b", at_point = { 0, 1, 0 } } })
  local whole = draw(scene)
  local part = draw(scene, nil, { region = { 70, 40, 100, 60 } })
  local wrong = 0
  for y = 0, 59 do
    for x = 0, 99 do
      if part(x, y) ~= whole(x + 70, y + 40) then wrong = wrong + 1 end
    end
  end
  check(wrong == 0, "%d pixels of the region are wrong", wrong)
end

-- ---- Warnings ----

-- Returns the warnings of a frame.
local function warnings_of(object, camera)
  local script, out = os.tmpname(), os.tmpname()
  local file = assert(io.open(script, "w"))
  file:write(('local glint = require "glint"\nreturn glint.animation { frames = 1, width = 60, height = 40, scene = glint.scene {\n' ..
    'camera = glint.camera { %s }, glint.%s } }\n'):format(camera or "eye = { 0, 0, 9 }, at = { 0, 0, 0 }", object))
  file:close()
  os.execute(("%s %s -o %s.png > %s 2>&1"):format(os.getenv "GLINT" or "build/glint", script, out, out))
  local text = assert(io.open(out)):read "a"
  for _, path in ipairs { script, out, out .. ".png" } do os.remove(path) end
  return text
end

function tests.warnings()
  local function warns(want, object, camera)
    local text = warnings_of(object, camera)
    check(text:find(want, 1, true), "%s: %s expected, got %s", object, want, text)
  end
  warns("arrow 'n': to: expected a point other than from {1, 2, 3}; it is not drawn", 'arrow { from = { 1, 2, 3 }, to = { 1, 2, 3 }, name = "n" }')
  warns("line: from: expected a point in front of the camera; the part behind it is not drawn", "line { from = { 0, 0, 20 }, to = { 1, 0, 0 } }")
  warns("arrow 'v': to: expected a point in front of the camera; the part behind it is not drawn",
    'arrow { from = { 1, 0, 0 }, to = { 0, 0, 20 }, label = "v" }')
  warns("arrow: from: expected a point in front of the camera; it is not drawn", "arrow { from = { 0, 0, 20 }, to = { 1, 0, 30 } }")
  warns("arc: at: expected a point in front of the camera; it is not drawn",
    "arc { at = { 0, 0, 20 }, from = { 1, 0, 0 }, to = { 0, 1, 0 } }")
  warns("label 'a': at_point: expected a point in front of the camera; it is not drawn", 'label { text = "a", at_point = { 0, 0, 9 } }')
  warns("line: it lies outside the picture", "line { from = { 900, 0, 0 }, to = { 900, 1, 0 } }")
  warns("line: from: expected a point in front of the camera", "line { from = { 0, 0, 20 }, to = { 1, 0, 0 } }",
    'eye = { 0, 0, 9 }, at = { 0, 0, 0 }, projection = "orthographic", height = 9')
  check(not warnings_of("arrow { from = { 0, 0, 0 }, to = { 1, 1, 0 } }"):find "arrow", "none of an arrow in the picture")
end

-- Every position of the ends, every size and every width gives a picture.
function tests.extremes()
  local places = { { 0, 0, 0 }, { 1e300, 0, 0 }, { 0, -1e300, 1e300 }, { 0, 0, 9 }, { 0, 0, 8.999999 }, { 5e-324, 0, 0 }, { 0, 0, 1e300 }, { 3, 2, 8 } }
  local curves = {}
  for i, from in ipairs(places) do
    for k, to in ipairs(places) do
      for _, hidden in ipairs { "drawn", "dashed", "none" } do
        local made = i % 2 == 0 and glint.line or glint.arrow
        curves[#curves + 1] = made { from = from, to = to, hidden = hidden, width = ({ 0, 1, 10000 })[k % 3 + 1], label = "a",
          size = k % 2 == 0 and 10000 or nil }
      end
    end
    curves[#curves + 1] = glint.label { text = "Wide\nγ\n\n", at_point = from, margin = i % 2 == 0 and 10000 or 0, background = 1 }
    for _, radius in ipairs { 1e-300, 1, 1e300 } do
      curves[#curves + 1] = glint.arc { at = from, from = { 1e-300, 0, 0 }, to = { -1e300, 0, 0 }, radius = radius, hidden = "dashed", label = "a" }
      curves[#curves + 1] = glint.arc { at = from, from = { 0, 0, 1 }, to = { 0, 0, 1 }, label = "a" }
    end
  end
  for name, camera in pairs(CAMERAS) do
    local scene = scene_of(camera, { glint.sphere { center = { 0, 0, 0 }, radius = 1 } })
    for _, curve in ipairs(curves) do
      scene:add(curve)
      check(draw(scene, nil, { width = 40, height = 30 }), "%s: %s", name, tostring(curve))
      scene:remove(curve)
    end
  end
end

tally.run(tests)
tally.finish()
