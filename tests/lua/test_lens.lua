-- Cameras with a lens: blur disks in closed form, sharp areas, rays used for shading, contents of passes, and errors.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local SIDE = 65 -- pixels per side, an odd number: the middle is the centre of a pixel
local EYE = 10 -- z of the eye, which is on the z axis

local function camera(more)
  local fields = { eye = { 0, 0, EYE }, at = { 0, 0, 0 }, fov = 20 }
  for name, value in pairs(more or {}) do fields[name] = value end
  return glint.camera(fields)
end

local function bright(color) return glint.material { diffuse = 0, ambient = color or 1 } end

local function render(scene, more)
  local fields = { width = SIDE, height = SIDE, output = "none" }
  for name, value in pairs(more or {}) do fields[name] = value end
  return scene:render(fields)
end

-- Calls `visit` for each pixel with x to the right and y up from the middle, and the pixel's light.
local function each(image, visit, pass)
  for row = 0, image.height - 1 do
    for column = 0, image.width - 1 do
      visit(column - (image.width - 1) / 2, (image.height - 1) / 2 - row, (image:pixel(column, row, pass or "beauty")))
    end
  end
end

-- Returns whether two pictures have the same bits in a pass.
local function same(a, b, pass)
  for row = 0, a.height - 1 do
    for column = 0, a.width - 1 do
      local p, q = { a:pixel(column, row, pass) }, { b:pixel(column, row, pass) }
      for c = 1, #p do if p[c] ~= q[c] then return false end end
    end
  end
  return true
end

-- Returns the width of a pixel at distance 1 from the eye.
local function pixel_width(fov) return 2 * math.tan(math.rad(fov or 20) / 2) / SIDE end

-- Returns the light of a small ball in the middle, seen through a lens: the sum, the mean square distance from the
-- middle and the largest distance of the light, in pixels.
local function blur_of(more, depth, radius, extra)
  local scene = glint.scene { camera = camera(more), ambient = 1,
    glint.sphere { center = { 0, 0, EYE - depth }, radius = radius, material = bright() } }
  for _, shape in ipairs(extra or {}) do scene:add(shape) end
  local sum, squares, farthest = 0, 0, 0
  each(render(scene, { samples = 1024 }), function(x, y, light)
    sum, squares = sum + light, squares + light * (x * x + y * y)
    if light > 0 then farthest = math.max(farthest, math.sqrt(x * x + y * y)) end
  end)
  return sum, squares / sum, farthest
end

local tests = {}

-- A point at depth d is a uniform disk of radius a |1 - d / f| in that plane: the mean square is half of radius^2.
function tests.blur_disk()
  for _, case in ipairs {
    { focus = 10, depth = 20, aperture = 0.9 }, { focus = 10, depth = 7, aperture = 1 }, { focus = 40, depth = 12, aperture = 0.7 },
    { focus = 6, depth = 9, aperture = 0.6 }, { focus = 1e7, depth = 10, aperture = 0.6 },
  } do
    for _, projection in ipairs { "perspective", "orthographic" } do
      local parallel = projection == "orthographic"
      local pixel = parallel and 4 / SIDE or case.depth * pixel_width()
      local radius, ball = case.aperture * math.abs(1 - case.depth / case.focus) / pixel, 1.2
      local sum, squares, farthest = blur_of({ aperture = case.aperture, focus = case.focus, projection = projection, height = 4 },
        case.depth, ball * pixel)
      local name = ("%s, focus %g, depth %g"):format(projection, case.focus, case.depth)
      near(sum, math.pi * ball * ball, 0.1, name .. ": as much light as without")
      near(squares, radius * radius / 2 + ball * ball / 2, 0.02 * radius * radius, name .. ": evenly over the disk")
      check(farthest < radius + ball + 0.8 and farthest > radius - 0.5, "%s: it ends at %.2f pixels, not at %.2f", name,
        farthest, radius)
    end
  end
end

-- Quarters and rings of equal area in the disk receive equal light.
function tests.even_disk()
  local scene = glint.scene { camera = camera { aperture = 1, focus = 5 }, ambient = 1,
    glint.sphere { center = { 0, 0, 0 }, radius = 0.06, material = bright() } }
  local radius, parts, total = 1 / (EYE * pixel_width()), { 0, 0, 0, 0, 0, 0, 0, 0 }, 0
  each(render(scene, { samples = 4096 }), function(x, y, light)
    local ring = math.min(math.floor(2 * (x * x + y * y) / (radius * radius)), 1)
    -- A pixel on an axis belongs half to each part.
    for _, part in ipairs { 1 + (x > 0 and 1 or 0) + (y > 0 and 2 or 0), 1 + (x >= 0 and 1 or 0) + (y >= 0 and 2 or 0) } do
      parts[part + 4 * ring] = parts[part + 4 * ring] + light / 2
    end
    total = total + light
  end)
  for i = 1, 8 do near(parts[i] / total, 1 / 8, 0.012, "part " .. i) end
end

-- A polygon has a corner at the top. Behind the focus its image is upright, in front of the focus upside down.
function tests.blades()
  for _, case in ipairs { { 3, 0, 20 }, { 3, 0, 7 }, { 5, 0, 20 }, { 4, 45, 20 }, { 6, 30, 20 } } do
    local blades, rotation, depth = case[1], case[2], case[3]
    local pixel, focus = depth * pixel_width(), 10
    local radius, sign = math.abs(1 - depth / focus) / pixel, depth > focus and 1 or -1
    local scene = glint.scene { camera = camera { aperture = 1, focus = focus, blades = blades, blade_rotation = rotation },
      ambient = 1, glint.sphere { center = { 0, 0, EYE - depth }, radius = 0.8 * pixel, material = bright() } }
    local sum, squares, outside, corner = 0, 0, 0, {}
    for i = 1, blades do
      local angle = math.pi / 2 + math.rad(rotation) + 2 * math.pi * i / blades
      corner[i] = { sign * radius * math.cos(angle), sign * radius * math.sin(angle), 0 }
    end
    each(render(scene, { samples = 1024 }), function(x, y, light)
      local over = -math.huge -- signed distance of the pixel from the side that it is farthest beyond
      for i = 1, blades do
        local angle = math.pi / 2 + math.rad(rotation) + 2 * math.pi * (i + 0.5) / blades
        over = math.max(over, sign * (x * math.cos(angle) + y * math.sin(angle)) - radius * math.cos(math.pi / blades))
        local dx, dy = x - corner[i][1], y - corner[i][2]
        if dx * dx + dy * dy < 9 then corner[i][3] = corner[i][3] + light end
      end
      outside = math.max(outside, light > 0 and over or -math.huge)
      sum, squares = sum + light, squares + light * (x * x + y * y)
    end)
    local name = ("%d blades, depth %g"):format(blades, depth)
    check(outside < 1.7, "%s: %.2f pixels outside", name, outside)
    for i = 1, blades do check(corner[i][3] > 0, "%s: corner %d is dark", name, i) end
    -- The mean square distance of a regular polygon's points from the centre.
    local want = radius * radius * (2 + math.cos(2 * math.pi / blades)) / 6 + 0.32
    near(squares / sum, want, 0.03 * want, name .. ": evenly over the polygon")
  end
end

-- Makes a wall of boxes that is wider than the view.
local function tiles(shift)
  local list = {}
  for x = -7, 6 do
    for y = -7, 6 do
      list[#list + 1] = glint.box { min = { x * 0.4 + shift, y * 0.4 + shift, -1 }, max = { x * 0.4 + 0.4 + shift,
        y * 0.4 + 0.4 + shift, 0 }, material = glint.material { diffuse = (x + y) % 2 == 0 and { 0.9, 0.4, 0.1 } or 0.2 } }
    end
  end
  return list
end

-- Points in the plane of focus look the same from the whole lens, so they have the same bits as with a pinhole.
function tests.in_focus()
  for _, projection in ipairs { "perspective", "orthographic" } do
    for _, samples in ipairs { 1, 7, 16 } do
      local function picture(more)
        more.projection, more.height = projection, 3.5
        local scene = glint.scene { camera = camera(more), ambient = 0.1, background = 0.3,
          glint.directional_light { direction = { -1, -2, -3 } } }
        for _, box in ipairs(tiles(0.0123)) do scene:add(box) end
        return render(scene, { samples = samples })
      end
      local sharp = picture {}
      check(same(sharp, picture { aperture = 0.7 }, "beauty"), "%s, %d samples: focus at `at`", projection, samples)
      check(same(sharp, picture { aperture = 2, focus = 10, blades = 5 }, "beauty"), "%s: a distance", projection)
      check(same(sharp, picture { aperture = 0.7, focus = { 3, -2, 0 } }, "beauty"), "%s: a point", projection)
      check(not same(sharp, picture { aperture = 0.7, focus = { 3, -2, 1 } }, "beauty"), "%s: another point", projection)
    end
  end
end

-- A camera that looks at another point focuses there. A camera with a direction focuses along it.
function tests.focus_follows()
  local view = camera { aperture = 0.5 }
  local scene = glint.scene { camera = view, ambient = 1, background = 0.2,
    glint.sphere { center = { 0.3, 0, 3 }, radius = 0.5, material = bright() } }
  local function picture() return render(scene, { samples = 16 }) end
  local first = picture()
  view.focus = 10
  check(same(first, picture(), "beauty"), "`at` is 10 away")
  view.at, view.focus = { 0, 0, 3 }, nil
  local nearer = picture()
  view.focus = 7
  check(same(nearer, picture(), "beauty") and not same(first, nearer, "beauty"), "then 7 away")
  view.direction, view.focus = { 0, 0, -2 }, { 5, 5, 3 }
  check(same(nearer, picture(), "beauty"), "with a direction")
  check(view.focus.z == 3, "the field reads as it was set")
end

-- Depth, normal, object and outline belong to the ray through the lens's centre, as for a pinhole, with any samples.
function tests.geometry_of_the_middle()
  for _, more in ipairs { { samples = 1 }, { samples = 5 }, { samples = 16, adaptive = 0.1 } } do
    for _, projection in ipairs { "perspective", "orthographic" } do
      local function picture(aperture)
        local scene = glint.scene { camera = camera { aperture = aperture, focus = 6, projection = projection, height = 4 },
          ambient = 0.1, glint.point_light { position = { 3, 4, 9 } },
          glint.sphere_light { position = { 1.2, 1, 2 }, radius = 0.3, visible = true, radiance = 1 },
          glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 } },
          glint.sphere { center = { -0.6, 0, 2 }, radius = 0.8 }, glint.box { min = { 0, -1, -1 }, max = { 1, 0.3, 0 } } }
        more.passes = "depth,normal,object_id,outline,alpha"
        return render(scene, more)
      end
      local sharp, blurred = picture(0), picture(0.4)
      for _, pass in ipairs { "depth", "normal", "object_id", "outline" } do
        check(same(sharp, blurred, pass), "%s, %d samples: %s", projection, more.samples, pass)
      end
      check(not same(sharp, blurred, "beauty"), "%s: the light is blurred", projection)
    end
  end
end

-- A highlight is computed for each point of the lens: compares with the mean over a fine grid of lens points.
function tests.highlights()
  local shiny = glint.material { model = "phong", diffuse = 0, specular = 1, shininess = 40 }
  local lamp, aperture = { 1, 2, 6 }, 2
  local scene = glint.scene { camera = camera { aperture = aperture }, glint.point_light { position = lamp, shadows = false },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 0, 1 }, material = shiny } }
  local image, worst = render(scene, { samples = 1024, passes = "specular" }), 0
  for _, at in ipairs { { 32, 32 }, { 38, 20 }, { 20, 40 }, { 50, 10 }, { 36, 12 } } do
    local pixel, sum, count = EYE * pixel_width(), 0, 0
    local point = { (at[1] - 32) * pixel, (32 - at[2]) * pixel, 0 }
    for i = -20, 20 do
      for j = -20, 20 do
        if i * i + j * j <= 20.5 * 20.5 then
          local to_eye = { i / 20.5 * aperture - point[1], j / 20.5 * aperture - point[2], EYE }
          sum = sum + shiny:evaluate { normal = { 0, 0, 1 }, to_eye = to_eye,
            to_light = { lamp[1] - point[1], lamp[2] - point[2], lamp[3] } }.specular[1]
          count = count + 1
        end
      end
    end
    worst = math.max(worst, math.abs(image:pixel(at[1], at[2], "specular") / (sum / count) - 1))
  end
  check(worst < 0.01, "off by %.2g", worst)
end

-- The blur of a mirror image depends on the length of the whole path.
function tests.mirrors()
  local mirror = glint.plane { point = { 0, 0, EYE - 8 }, normal = { 0, 0, 1 },
    material = glint.material { diffuse = 0, ambient = 0, mirror = 1 } }
  local wall = glint.plane { point = { 0, 0, EYE + 5 }, normal = { 0, 0, -1 }, material = bright(0) }
  local aperture, focus = 0.8, 7
  local scene = glint.scene { camera = camera { aperture = aperture, focus = focus }, ambient = 1, mirror, wall,
    glint.sphere { center = { 1.2, 0, EYE - 3 }, radius = 0.12, material = bright() } }
  local depth = 8 + 5
  local middle = 1.2 / (depth * pixel_width())
  local sum, first, second = 0, 0, 0
  each(render(scene, { samples = 1024, passes = "mirror" }), function(x, y, light)
    if x > 2 then
      sum, first, second = sum + light, first + light * x, second + light * ((x - middle) ^ 2 + y * y)
    end
  end, "mirror")
  local pixel = depth * pixel_width()
  local radius, ball = aperture * math.abs(1 - depth / focus) / pixel, 0.12 / pixel
  near(first / sum, middle, 0.1, "where it is")
  near(second / sum, radius * radius / 2 + ball * ball / 2, 0.03 * radius * radius, "how wide it is")
end

-- A visible light is blurred like a ball of its size. Cut-out or clear surfaces change nothing, up to rounding.
function tests.what_rays_go_through()
  local view = camera { aperture = 0.8, focus = 6 }
  local function picture(...)
    return render(glint.scene { camera = view, ambient = 1, background = 0.1, ... }, { samples = 64 })
  end
  local function ball() return glint.sphere { center = { 0.2, 0.1, 0 }, radius = 0.3, material = bright() } end
  local plain, worst = picture(ball()), 0
  local lamp = picture(glint.sphere_light { position = { 0.2, 0.1, 0 }, radius = 0.3, radiance = 1 / math.pi, visible = true })
  local clear = glint.material { diffuse = 0, ambient = 0, transmission = 1, ior = 1 }
  local through = picture(ball(), glint.sphere { center = { 0, 0, 4 }, radius = 0.5, material = clear })
  local cut = picture(ball(), glint.sphere { center = { 0, 0, 4 }, radius = 0.5, material = glint.material { opacity = 0 } })
  each(plain, function(x, y, light)
    local column, row = x + 32, 32 - y
    worst = math.max(worst, math.abs(light - lamp:pixel(column, row)), math.abs(light - through:pixel(column, row)))
  end)
  check(worst < 1e-6, "off by %.2g", worst)
  check(same(plain, cut, "beauty"), "a surface that is not there")
end

-- An aperture larger than the distance to the nearest ball, an eye next to a ball, a focus next to the eye and close
-- to infinity: all light comes from the object, and none is lost.
function tests.hard_places()
  for _, case in ipairs {
    { { aperture = 3, focus = 12 }, { 0, 0, EYE - 2.5 }, 0.5 }, { { aperture = 1, focus = 5 }, { 0, 0, EYE - 0.50001 }, 0.5 },
    { { aperture = 0.01, focus = 1e-6 }, { 0, 0, 4 }, 1 }, { { aperture = 0.01, focus = 1e7 }, { 0, 0, 4 }, 1 },
    { { aperture = 2, focus = 3 }, { 1.2, 0, EYE }, 0.5 }, -- the ball is inside the lens
  } do
    for _, precision in ipairs { "double", "float" } do
      local scene = glint.scene { camera = camera(case[1]), ambient = 1, background = 0.25,
        glint.sphere { center = case[2], radius = case[3], material = bright(0.75) } }
      local image, low, high = render(scene, { samples = 16, passes = "alpha", precision = precision }), math.huge, 0
      local off = 0
      each(image, function(x, y, light)
        local alpha = image:pixel(x + 32, 32 - y, "alpha")
        low, high = math.min(low, light), math.max(high, light)
        off = math.max(off, math.abs(light - (0.75 * alpha + 0.25 * (1 - alpha))))
      end)
      check(off < 1e-6 and low >= 0.25 and high <= 0.75, "focus %g, %s: off by %g", case[1].focus, precision, off)
    end
  end
end

-- More samples are taken where the blur is visible, and none inside sharp areas.
function tests.adaptive()
  local function scene(aperture)
    local s = glint.scene { camera = camera { aperture = aperture, focus = 10 }, ambient = 0.2,
      glint.directional_light { direction = { -1, -2, -3 }, shadows = false },
      glint.box { min = { -1.2, -1.2, -1 }, max = { 1.2, 1.2, 0 }, material = glint.material { diffuse = 0.7 } },
      glint.sphere { center = { 1.4, 1.4, 4 }, radius = 0.3, material = glint.material { diffuse = { 0.9, 0.1, 0.1 } } } }
    return render(s, { samples = 16, adaptive = 0.05, passes = "refined" }), render(s, { samples = 16 })
  end
  local blurred, whole = scene(0.6)
  local wrong, inside, count = 0, 0, 0
  each(blurred, function(x, y, light)
    local taken = blurred:pixel(x + 32, 32 - y, "refined") == 1
    local other = whole:pixel(x + 32, 32 - y)
    count = count + (taken and 1 or 0)
    if taken and light ~= other then wrong = wrong + 1 end
    if taken and math.max(math.abs(x + 4), math.abs(y + 4)) < 12 then inside = inside + 1 end
    if not taken and math.abs(light - other) > 0.02 then wrong = wrong + 1 end
  end)
  check(wrong == 0, "%d pixels are not those of all samples", wrong)
  check(inside == 0, "%d pixels inside of what is sharp were sampled", inside)
  check(count > 300 and count < SIDE * SIDE / 2, "%d pixels were sampled", count)
end

-- Pictures have the same bits with any region and any number of threads, with or without reuse.
function tests.parts()
  local view = camera { aperture = 0.5, focus = 7, blades = 6 }
  local ball = glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { specular = 0.5 } }
  local scene = glint.scene { camera = view, ambient = 0.1, glint.point_light { position = { 3, 4, 9 } }, ball,
    glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 } } }
  local whole = render(scene, { samples = 9, adaptive = 0.05 })
  local part, differ = render(scene, { samples = 9, adaptive = 0.05, region = { 20, 24, 10, 9 } }), 0
  for x = 20, 29 do
    for y = 24, 32 do differ = differ + (part:pixel(x - 20, y - 24) == whole:pixel(x, y) and 0 or 1) end
  end
  check(differ == 0, "%d pixels of a region differ", differ)
  for _ = 1, 3 do render(scene, { samples = 9 }) end
  view.aperture = 0.2
  local smaller = render(scene, { samples = 9 })
  view.aperture = 0.5
  for _ = 1, 3 do render(scene, { samples = 9 }) end
  view.aperture = 0.2
  check(same(smaller, render(scene, { samples = 9 }), "beauty"), "a lens that was stopped down and opened")
end

-- The plan names the reason for the lens and its focus distance. Without an aperture there is no lens.
function tests.explained()
  local command = os.getenv "GLINT" or (os.getenv "BUILD" or "build") .. "/glint"
  local function lens_of(options)
    local pipe <close> = assert(io.popen(("%s explain scripts/focus.lua --frame 1 %s"):format(command, options)))
    return pipe:read("a"):match "\n%s*(lens[^\n]*)"
  end
  local line = lens_of ""
  check(line and line:find "camera.aperture = 0.16, focus %d+%.%d+ away", "explain: '%s'", line)
  check(not lens_of "--set aperture=0", "no aperture, no lens")
end

local function raises(message, fields, more)
  local ok, got = pcall(function()
    local scene = glint.scene { camera = camera(fields), glint.sphere { center = { 0, 0, 0 }, radius = 1 } }
    if more then for name, value in pairs(more) do scene.camera[name] = value end end
    render(scene)
  end)
  check(not ok and got:find(message, 1, true), "'%s' expected, got '%s'", message, got)
end

function tests.errors()
  raises("camera.aperture: number >= 0 expected, got -1", { aperture = -1 })
  raises("camera.aperture: finite number expected, got nan", { aperture = 0 / 0 })
  raises("camera.aperture: number expected, got true", { aperture = true })
  raises("camera.focus: number > 0 or {x, y, z} expected, got 0", { focus = 0 })
  raises("camera.focus: number > 0 or {x, y, z} expected, got -2", { focus = -2 })
  raises("camera.focus: number > 0 or {x, y, z} expected, got nan", {}, { focus = 0 / 0 })
  raises('camera.focus: number > 0 or {x, y, z} expected, got string "near"', { focus = "near" })
  raises("camera.focus: a point in front of the eye expected, got {0, 0, 12}", { aperture = 1, focus = { 0, 0, 12 } })
  raises("camera.focus: a camera with an aperture and a direction needs a focus: a number > 0, or {x, y, z}", { aperture = 1 }, { direction = { 0, 0, -1 } })
  raises("camera.aperture: expected a number <= 10 (1e+12 times the focus), got 11", { aperture = 11, focus = 1e-11 })
  for _, blades in ipairs { 1, 2, 4.5, -3, 65 } do
    raises(("camera.blades: 0 or a whole number 3 .. 64 expected, got %g"):format(blades), { blades = blades })
  end
  raises("camera.apature: no such field; did you mean 'aperture'?", { apature = 1 })
  raises("camera.focal_point: no such field; did you mean 'focus'?", { focal_point = 1 })
end

tally.run(tests)
tally.finish()
