-- Lobes, paths, frustums and polylines: their points against closed forms, their pixels against camera:project, and how
-- they follow the scene.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"
local vec = glint.vector

local WIDTH, HEIGHT = 240, 135
local CAMERA = glint.camera { eye = { 1, 2, 9 }, at = { 0, 0, 0 }, fov = 40 }

local raises = tally.raises

local function near(a, b, limit) return (a - b):length() <= limit end

local function scene_of(...) return glint.scene { camera = CAMERA, ... } end

-- Returns the picture of a scene as written to a file, as a function of the pixel: green, 0 .. 1 linear, 0 outside.
local function draw(scene, options)
  local path, given = os.tmpname() .. ".png", { width = WIDTH, height = HEIGHT, output = "none" }
  for key, value in pairs(options or {}) do given[key] = value end
  assert(scene:render(given):save(path))
  local picture = glint.read_image(path)
  os.remove(path)
  return function(x, y)
    x, y = math.floor(x), math.floor(y)
    if x < 0 or y < 0 or x >= picture.width or y >= picture.height then return 0 end
    return (select(2, picture:pixel(x, y)))
  end
end

local function differing(a, b)
  local count = 0
  for y = 0, HEIGHT - 1 do
    for x = 0, WIDTH - 1 do
      if a(x, y) ~= b(x, y) then count = count + 1 end
    end
  end
  return count
end

local function lit(at) return differing(at, function() return 0 end) end

local tests = {}

-- A polyline has the pixels of the lines between its points.
function tests.polylines()
  local points = { vec(-3, -1, 0), vec(-1, 1, 1), vec(0, -1, -1), vec(2, 1, 0) }
  local line = glint.polyline { points = points, width = 3 }
  local at, missing = draw(scene_of(line)), 0
  for i = 1, 3 do
    for k = 0, 40 do
      local x, y = CAMERA:project(points[i] + k / 40 * (points[i + 1] - points[i]), WIDTH, HEIGHT)
      if at(x, y) < 0.8 then missing = missing + 1 end
    end
  end
  check(missing == 0, "%d points are missing", missing)
  local lines = {}
  for i = 1, 3 do lines[i] = glint.line { from = points[i], to = points[i + 1], width = 3 } end
  check(math.abs(lit(at) - lit(draw(scene_of(table.unpack(lines))))) < 10, "as many pixels as three lines have")
  check(#line.points == 4 and line.points[2] == points[2], "the points can be read")
  line.points = { { 0, 0, 0 }, { 1, 0, 0 } }
  check(#line.points == 2, "and set")
end

-- A straight polyline of many pieces hides the same parts as a single line.
function tests.hidden_pieces()
  local ball = glint.sphere { center = { 0, 0, 1 }, radius = 1, material = glint.material { diffuse = 0 } }
  local from, to, points = vec(-3, -0.5, -1), vec(3, 0.6, -1), {}
  for i = 0, 60 do points[i + 1] = from + i / 60 * (to - from) end
  for _, hidden in ipairs { "none", "dashed", "drawn" } do
    local line = draw(scene_of(ball, glint.line { from = from, to = to, hidden = hidden, width = 2 }))
    local pieces = draw(scene_of(ball, glint.polyline { points = points, hidden = hidden, width = 2 }))
    check(differing(line, pieces) < 0.15 * lit(line), "%s: %d of %d pixels differ", hidden, differing(line, pieces), lit(line))
  end
end

-- The part behind the camera is omitted. The rest stays in its place.
function tests.behind_the_camera()
  local at = draw(scene_of(glint.polyline { points = { { -1, 0, 0 }, { 1, 0, 0 }, { 1, 0, 40 }, { -1, 0, 40 }, { -1, 0, 0 } },
    width = 3 }))
  local x, y = CAMERA:project(vec(0, 0, 0), WIDTH, HEIGHT)
  check(at(x, y) > 0.5, "the piece in front")
  for _, side in ipairs { -1, 1 } do
    x, y = CAMERA:project(vec(side, 0, 1.5), WIDTH, HEIGHT)
    check(at(x, y) > 0.5, "the pieces that go behind the camera, %d: %g, %g", side, x, y)
  end
end

-- In each direction a lobe is as long as the specular light of material:evaluate.
function tests.lobes()
  local n, l = vec(0.2, 0.9, 0.3):unit(), vec(-1, 1, 0.5):unit()
  local p, mirrored = vec(0.3, 0.2, 0.1), (-l):reflect(n)
  for _, fields in ipairs { { specular = 0.7, shininess = 24 }, { specular = { 0.9, 0.6, 0.3 }, shininess = 3 },
    { model = "blinn_phong", specular = 0.5, shininess = 80 }, { model = "cook_torrance", roughness = 0.4 } } do
    local material = glint.material(fields)
    local lobe = glint.lobe { point = p, material = material, to_light = 3 * l, normal = 2 * n, scale = 2 }
    draw(scene_of(lobe))
    local strokes, wrong, longest = lobe.strokes, 0, 0
    local points = strokes[1]
    check(#strokes == 1 and near(points[1], p, 0) and near(points[#points], p, 0), "it begins and ends at its point")
    for i = 2, #points - 1 do
      local to_eye = points[i] - p
      local light = material:evaluate({ normal = n, to_light = l, to_eye = to_eye:length() > 0 and to_eye or n }).specular
      local want = 2 * (light.r + light.g + light.b) / 3
      if to_eye:length() > 1e-6 and math.abs(to_eye:length() - want) > 1e-5 * want then wrong = wrong + 1 end
      if math.abs(to_eye:dot(n:cross(l))) > 1e-9 then wrong = wrong + 1 end
      longest = math.max(longest, to_eye:length())
    end
    check(wrong == 0 and longest > 0.1, "%s: %d points are wrong, the longest is %g", fields.model, wrong, longest)
    local tip, light = points[(#points + 1) // 2] - p, material:evaluate({ normal = n, to_light = l, to_eye = mirrored }).specular
    check(math.abs(tip:length() - 2 * (light.r + light.g + light.b) / 3) < 1e-6 and near(tip:unit(), mirrored, 1e-6),
      "%s: its middle is in the mirrored direction", fields.model)
  end
end

-- The next frame shows a changed material and a changed light. Without a normal, the lobe has the surface's normal.
function tests.lobes_follow()
  local material = glint.material { specular = 1, shininess = 4 }
  local ball = glint.sphere { center = { 0, 0, 0 }, radius = 1, material = material }
  local lobe = glint.lobe { point = { 0, 1, 0 }, material = material, to_light = { 1, 1, 0 } }
  local scene = scene_of(ball, lobe)
  local function area()
    local sum, points = 0, lobe.strokes[1] or {}
    for i = 1, #points - 1 do sum = sum + (points[i] - vec(0, 1, 0)):cross(points[i + 1] - vec(0, 1, 0)):length() / 2 end
    return sum
  end
  local before = draw(scene)
  local wide = area()
  check(lobe.normal == nil and #lobe.strokes[1] > 50, "the normal of the ball")
  material.shininess = 40
  local after = draw(scene)
  check(differing(before, after) > 20 and area() < 0.5 * wide, "a narrower highlight: %g of %g", area(), wide)
  check(differing(after, draw(scene, { seed = 1 })) == 0, "a fresh frame has the same pixels")
  lobe.to_light = { 0, -1, 0 }
  draw(scene)
  check(#lobe.strokes == 0, "no highlight of a light behind the surface")
  lobe.to_light = { 0, 1, 0 }
  draw(scene)
  check(area() > 0, "a light along the normal")
  lobe.point = { 0, 5, 0 }
  raises("lobe.normal: {x, y, z} expected, because no surface is at the point {0", function() draw(scene) end)
  lobe.normal = { 0, 1, 0 }
  draw(scene)
  check(lobe.normal == vec(0, 1, 0), "the script's own normal")
end

-- A slab of glass: the angles are Snell's, and the ray leaves parallel to itself.
function tests.paths_by_snell()
  local ior = 1.5
  local glass = glint.material { transmission = 1, ior = ior }
  local slab = glint.box { min = { -9, -1, -9 }, max = { 9, 0, 9 }, material = glass }
  for _, degrees in ipairs { 0, 20, 50, 80 } do
    local sine, cosine = math.sin(math.rad(degrees)), math.cos(math.rad(degrees))
    local d = vec(sine, -cosine, 0)
    local path = glint.path { origin = vec(0, 0, 0) - 2 * d, direction = 5 * d }
    draw(scene_of(slab, path))
    local strokes = path.strokes
    check(#strokes == 3, "%g degrees: three segments expected, got %d", degrees, #strokes)
    check(near(strokes[1][2], vec(0, 0, 0), 1e-12), "it hits the upper side")
    local inner = sine / ior
    local shift = inner / math.sqrt(1 - inner * inner)
    check(near(strokes[2][2], vec(shift, -1, 0), 1e-12), "%g degrees: it hits the lower side at x = %g", degrees, shift)
    check(near((strokes[3][2] - strokes[3][1]):unit(), d, 1e-12), "%g degrees: it leaves parallel to itself", degrees)
    check(math.abs((strokes[3][2] - strokes[3][1]):length() - 2) < 1e-12, "as long as the first segment")
  end
end

-- Total reflection, mirrors, the two rays of Fresnel glass, and the three ends of a path: its depth, its reach, a weak ray.
function tests.paths_by_surfaces()
  local glass = glint.material { transmission = 1, ior = 1.5 }
  local slab = glint.box { min = { -9, -1, -9 }, max = { 9, 0, 9 }, material = glass }
  local scene = scene_of(slab)
  local path = scene:add(glint.path { scene = scene, origin = { 0, -0.5, 0 }, direction = { 1, 0.5, 0 }, depth = 3 })
  draw(scene)
  check(#path.strokes == 4, "from inside, beyond the critical angle: %d segments", #path.strokes)
  check(near(path.strokes[2][2], vec(3, -1, 0), 1e-12) and near(path.strokes[3][2], vec(5, 0, 0), 1e-12), "it stays inside")
  glass.fresnel, path.origin, path.direction, path.depth = true, { 0, 1, 0 }, { 0, -1, 0 }, 1
  draw(scene)
  check(#path.strokes == 3, "a refracted and a mirrored ray, got %d", #path.strokes - 1)
  check(near(path.strokes[2][2], vec(0, -1, 0), 1e-12) and near(path.strokes[3][2], vec(0, 1, 0), 1e-12), "along the normal")
  path.depth = 20
  draw(scene)
  check(#path.strokes == 6, "0.04 x 0.96 of the light is followed, 0.04 x 0.04 is not, got %d", #path.strokes)
  path.depth = 0
  draw(scene)
  check(#path.strokes == 1, "no depth, one segment")
  path.direction, path.reach = { 0, 1, 0 }, 7
  draw(scene)
  check(near(path.strokes[1][2], vec(0, 8, 0), 1e-12), "reach")
  local mirror = glint.material { diffuse = 0, mirror = 1 }
  local other = scene_of(glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = mirror },
    glint.plane { point = { 0, 1, 0 }, normal = { 0, -1, 0 }, material = mirror })
  local zigzag = other:add(glint.path { origin = { 0, 0.5, 0 }, direction = { 1, 1, 0 }, depth = 63 })
  draw(other)
  check(#zigzag.strokes == 64 and near(zigzag.strokes[64][1], vec(62.5, 1, 0), 1e-9), "63 mirrors: %s",
    tostring(zigzag.strokes[64] and zigzag.strokes[64][1]))
end

-- A path changes with its scene, and shows the rays of another scene when its field `scene` is set.
function tests.paths_follow()
  local mirror = glint.material { mirror = 1 }
  local ball = glint.sphere { center = { 2, 0, 0 }, radius = 1, material = mirror }
  local scene = scene_of(ball)
  local path = scene:add(glint.path { origin = { -2, 0, 0 }, direction = { 1, 0, 0 } })
  draw(scene)
  check(near(path.strokes[1][2], vec(1, 0, 0), 1e-12), "the first frame")
  ball.center = { 1, 0, 0 }
  draw(scene)
  check(near(path.strokes[1][2], vec(0, 0, 0), 1e-12), "the next frame")
  local other = scene_of(glint.sphere { center = { 0, 0, 0 }, radius = 1, material = mirror })
  path.scene = other
  draw(scene)
  check(path.scene == other and near(path.strokes[1][2], vec(-1, 0, 0), 1e-12), "another scene")
end

-- The corners of a frustum are the corners of the camera's picture, for every kind of camera.
function tests.frustums()
  for name, fields in pairs { perspective = { fov = 30 }, offset = { fov = 30, pixel_offset = 0 }, up = { fov = 60, up = { 1, 1, 0 } },
    orthographic = { projection = "orthographic", height = 2 }, calibrated = { fx = 500, fy = 600, cx = 300, cy = 250, w = 640, h = 480 } } do
    fields.eye, fields.at = { 2, 1, 3 }, { 0, 0, 0 }
    local camera = glint.camera(fields)
    local width, height = fields.w or 1280, fields.h or 720
    local frustum = glint.frustum { camera = camera, distance = 2.5 }
    draw(scene_of(frustum))
    local edges = frustum.strokes
    local corners = { { 0, 0 }, { width, 0 }, { width, height }, { 0, height } }
    for i, corner in ipairs(corners) do
      local x, y = camera:project(edges[i][2], width, height)
      check(x and math.abs(x - corner[1]) < 1e-9 and math.abs(y - corner[2]) < 1e-9, "%s, corner %d: %s, %s", name, i, tostring(x), tostring(y))
      local forward = (vec(0, 0, 0) - camera.eye):unit()
      check(math.abs((edges[i][2] - camera.eye):dot(forward) - 2.5) < 1e-9, "%s, corner %d: its distance", name, i)
      check(name == "orthographic" or near(edges[i][1], camera.eye, 1e-12), "%s: it begins at the eye", name)
    end
    check(#edges == (name == "orthographic" and 6 or 5) and #edges[5] == 5, "%s: %d strokes", name, #edges)
    frustum.distance = nil
    camera.eye = { 0, 0, 4 }
    draw(scene_of(frustum))
    check(math.abs(frustum.strokes[1][2].z) < 1e-9, "%s: it moves with the camera, to the point that the camera looks at", name)
  end
end

function tests.errors()
  local material, origin, up = glint.material {}, { 0, 0, 0 }, { 0, 1, 0 }
  raises("polyline.points: list of points expected, got 1", glint.polyline, { points = 1 })
  raises("polyline.points: 2 .. 128 points expected, got 1", glint.polyline, { points = { origin } })
  raises("polyline.points[2]", glint.polyline, { points = { origin, { 0, 0 / 0, 0 } } })
  raises("polyline.points[2]: ends at a finite distance expected", glint.polyline, { points = { { -1e308, 0, 0 }, { 1e308, 0, 0 } } })
  raises("lobe.material: material expected, got nil", glint.lobe, { point = origin, to_light = up })
  raises("lobe.material: material expected, got camera", glint.lobe, { point = origin, to_light = up, material = CAMERA })
  raises("lobe.to_light", glint.lobe, { point = origin, to_light = origin, material = material })
  raises("lobe.scale: number > 0 expected, got 0", glint.lobe, { point = origin, to_light = up, material = material, scale = 0 })
  raises("lobe.point[1]: finite number expected, got nan", glint.lobe, { point = { 0 / 0, 0, 0 }, to_light = up, material = material })
  raises("path.direction", glint.path, { origin = origin, direction = origin })
  raises("path.depth: whole number 0 .. 63 expected, got 1.5", glint.path, { origin = origin, direction = up, depth = 1.5 })
  raises("path.reach: number > 0 expected, got -1", glint.path, { origin = origin, direction = up, reach = -1 })
  raises("frustum.camera: camera expected, got nil", glint.frustum, {})
  raises("frustum.aspect: number > 0 expected, got 0", glint.frustum, { camera = CAMERA, aspect = 0 })
  raises("frustum.strokes: this field is read-only", function() glint.frustum({ camera = CAMERA }).strokes = {} end)
  local lobe = glint.lobe { point = origin, to_light = up, normal = up, material = material }
  check(lobe.material == material and glint.frustum({ camera = CAMERA }).camera == CAMERA, "the objects can be read")
  raises("lobe.material: material expected, got nil", function() lobe.material = nil end)
  local scene = scene_of(lobe)
  material:close()
  raises("material is closed", function() draw(scene) end)
end

-- Every position of the ends gives a picture.
function tests.extremes()
  local places = { { 0, 0, 0 }, { 1e300, 0, 0 }, { 0, -1e300, 1e300 }, { 1, 2, 9 }, { 5e-324, 0, 0 }, { 0, 0, 1e300 }, { 3, 2, 8 } }
  local ball = glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { mirror = 1 } }
  for _, hidden in ipairs { "drawn", "dashed", "none" } do
    local line = glint.polyline { points = places, hidden = hidden, label = "a", width = 100 }
    check(draw(scene_of(ball, line)), "%s", hidden)
  end
  for _, scale in ipairs { 1e-300, 1e300 } do
    local camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }
    check(draw(scene_of(ball, glint.frustum { camera = camera, distance = scale, hidden = "dashed" },
      glint.path { origin = { -3, 0, 0 }, direction = { 1, 0.2, 0 }, reach = scale, hidden = "dashed" },
      glint.lobe { point = { 0, 1, 0 }, to_light = { 1, 1, 0 }, scale = scale, hidden = "none", material = glint.material { specular = 1 } })),
      "%g", scale)
  end
end

tally.run(tests)
tally.finish()
