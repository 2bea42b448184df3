-- Cameras given in pixels and by a matrix: projected points against projections that this test computes.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local tests = {}

-- A camera as OpenCV defines it maps a world point p to R p + t, and this to fx x / z + cx and fy y / z + cy.
local R = { { 0.8, 0, -0.6 }, { 0.36, 0.8, 0.48 }, { 0.48, -0.6, 0.64 } }
local T = { 0.3, -0.2, 7 }
local MATRIX = { { 0.8, 0, -0.6, 0.3 }, { 0.36, 0.8, 0.48, -0.2 }, { 0.48, -0.6, 0.64, 7 } }
local K = { fx = 90, fy = 75, cx = 21.25, cy = 40.5 }

local function seen(p)
  local q = {}
  for i = 1, 3 do q[i] = R[i][1] * p[1] + R[i][2] * p[2] + R[i][3] * p[3] + T[i] end
  return K.fx * q[1] / q[3] + K.cx, K.fy * q[2] / q[3] + K.cy, math.sqrt(q[1] ^ 2 + q[2] ^ 2 + q[3] ^ 2)
end

local function camera(more)
  local fields = { matrix = MATRIX, fx = K.fx, fy = K.fy, cx = K.cx, cy = K.cy }
  for name, value in pairs(more or {}) do fields[name] = value end
  return glint.camera(fields)
end

local POINTS = { { 0, 0, 0 }, { 1.2, 0.5, -0.3 }, { -1, -1.5, 0.4 }, { 0.2, -0.9, 2 }, { 2.5, 1, 1 } }

-- Returns the mean position of the pixels that show a small ball; nil when no pixel does.
local function middle(image)
  local sum, x_sum, y_sum = 0, 0, 0
  for y = 0, image.height - 1 do
    for x = 0, image.width - 1 do
      if image:pixel(x, y, "object_id") > 0 then sum, x_sum, y_sum = sum + 1, x_sum + x + 0.5, y_sum + y + 0.5 end
    end
  end
  if sum > 0 then return x_sum / sum, y_sum / sum end
end

function tests.balls_are_where_their_points_are()
  for scale = 1, 8, 7 do
    for _, p in ipairs(POINTS) do
      local x, y, distance = seen(p)
      local ball = glint.sphere { center = p, radius = 0.05 * distance / scale }
      local scene = glint.scene { camera = camera { w = 64, h = 48 }, ball }
      local image = scene:render { width = 64 * scale, height = 48 * scale, passes = "object_id" }
      local u, v = middle(image)
      local inside = x > 4 and x < 60 and y > 4 and y < 44
      check(not inside or u and math.abs(u - scale * x) < 0.4 and math.abs(v - scale * y) < 0.4,
        "(%g, %g, %g) at %g, %g, seen at %s, %s", p[1], p[2], p[3], scale * x, scale * y, u, v)
    end
  end
end

-- Compares camera:project with the projection that this test computes, at two sizes.
function tests.points_are_projected()
  for scale = 1, 8, 7 do
    for _, p in ipairs(POINTS) do
      local x, y, distance = seen(p)
      local u, v, depth = camera { w = 64, h = 48 }:project(p, 64 * scale, 48 * scale)
      check(math.abs(u - scale * x) < 1e-10 and math.abs(v - scale * y) < 1e-10 and math.abs(depth - distance) < 1e-12,
        "(%g, %g, %g) at %g, %g, %g, got %s, %s, %s", p[1], p[2], p[3], scale * x, scale * y, distance, u, v, depth)
    end
  end
end

-- Projects the hit at a pixel's centre: the result is that centre and the depth of the pass.
function tests.hits_are_projected_to_their_pixels()
  for _, fields in ipairs { {}, { projection = "orthographic", height = 5 }, { pixel_offset = 0.25 }, { aperture = 0.2, focus = 5 } } do
    fields.eye, fields.at = { 1, 2, 6 }, { 0, 0.5, 0 }
    local view = glint.camera(fields)
    local scene = glint.scene { camera = view, glint.sphere { center = { 0, 0, 0 }, radius = 1.5 } }
    local image = scene:render { width = 32, height = 24, passes = "depth", samples = fields.aperture and 4 or 1 }
    local forward = (view.at - view.eye):unit()
    for y = 2, 23, 3 do
      for x = 2, 31, 3 do
        local t = image:pixel(x, y, "depth")
        if t < math.huge then
          local right = forward:cross(view.up):unit()
          local up = right:cross(forward)
          local half = fields.projection and 2.5 or math.tan(math.rad(view.fov / 2))
          local offset = fields.pixel_offset or 0.5
          local a, b = (x + offset - 16) / 12 * half, (12 - y - offset) / 12 * half
          local point = fields.projection and view.eye + a * right + b * up + t * forward
            or view.eye + t * (forward + a * right + b * up):unit()
          local u, v, depth = view:project(point, 32, 24)
          check(math.abs(u - x - 0.5) < 1e-4 and math.abs(v - y - 0.5) < 1e-4 and math.abs(depth - t) < 1e-5,
            "%d, %d at %s: got %s, %s at %s", x, y, t, u, v, depth)
        end
      end
    end
  end
end

function tests.points_that_are_not_projected()
  local view = camera()
  check(glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }:project({ 0, 0, 6 }, 64, 48) == nil, "behind the eye")
  check(glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }:project({ 0, 0, 5 }, 64, 48) == nil, "in the eye")
  local function raises(want, ...)
    local good, message = pcall(view.project, ...)
    check(not good and tostring(message):find(want, 1, true), "%s expected, got %s", want, message)
  end
  raises("project.point: {x, y, z} expected, got no value", view)
  raises("project.point[2]: finite number expected", view, { 0, 0 / 0, 1 }, 4, 4)
  raises("project.width: number of pixels 1 .. 65535 expected, got 0", view, { 0, 0, 0 }, 0, 4)
  raises("project.height: number expected, got no value", view, { 0, 0, 0 }, 4)
end

-- Projects the hit of a pixel's ray on a plane: the result is the pixel's centre.
function tests.rays_go_through_their_pixels()
  local scene = glint.scene { camera = camera(), glint.plane { point = { 0, 0, -1 }, normal = { 0, 0, 1 } } }
  local image = scene:render { width = 64, height = 48, passes = "depth" }
  for y = 0, 47, 5 do
    for x = 0, 63, 7 do
      local a, b = (x + 0.5 - K.cx) / K.fx, (y + 0.5 - K.cy) / K.fy
      local eye, way, size = {}, {}, math.sqrt(a * a + b * b + 1)
      for c = 1, 3 do
        eye[c] = -(R[1][c] * T[1] + R[2][c] * T[2] + R[3][c] * T[3])
        way[c] = (a * R[1][c] + b * R[2][c] + R[3][c]) / size
      end
      local distance = (-1 - eye[3]) / way[3]
      local depth = image:pixel(x, y, "depth")
      if distance > 0 then
        check(math.abs(depth - distance) < 1e-6 * distance, "depth %.9g at %d, %d, not %.9g", depth, x, y, distance)
      else
        check(depth == math.huge, "no hit at %d, %d", x, y)
      end
    end
  end
end

-- Every visibility method and instruction set gives the same picture, for any principal point.
function tests.meshes_are_seen_as_by_rays()
  local ball = glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1.2, segments = 24 }
  for _, more in ipairs { {}, { cx = -30, cy = 80 }, { cx = 90.5, cy = -7.25 }, { cx = 200 } } do
    local scene = glint.scene { camera = camera(more), glint.point_light { position = { 4, 5, -9 } }, ball,
      glint.sphere { center = { 0.9, 1, 0.6 }, radius = 0.5 } }
    local one = scene:render { width = 160, height = 120, visibility = "cast" }
    local two = scene:render { width = 160, height = 120, visibility = "scan" }
    check(one:bytes() == two:bytes(), "scan and cast at cx = %s", more.cx)
  end
end

-- A camera with the fx of a field of view, and a centred principal point, equals the camera with that field of view.
function tests.the_same_camera_by_angle()
  local f = 24 / math.tan(math.rad(20))
  local function picture(fields)
    fields.eye, fields.at = { 1, 2, 5 }, { 0, 0, 0 }
    local scene = glint.scene { camera = glint.camera(fields), ambient = 1, glint.box { min = { -1, -1, -1 }, max = { 1, 1, 1 } } }
    return scene:render { width = 64, height = 48, passes = "depth" }
  end
  local one, two, three = picture { fov = 40 }, picture { fx = f }, picture { fx = 2 * f, fy = 2 * f, cx = 64, cy = 48, w = 128, h = 96 }
  for y = 0, 47 do
    for x = 0, 63 do
      local a, b, c = one:pixel(x, y, "depth"), two:pixel(x, y, "depth"), three:pixel(x, y, "depth")
      check(a == b or math.abs(a - b) < 1e-5, "fx: %g and %g", a, b)
      check(b == c, "scaled: %g and %g", b, c)
    end
  end
end

function tests.matrices_read_as_they_were_written()
  local view = camera()
  for i, row in ipairs(view.matrix) do
    for k, value in ipairs(row) do check(math.abs(value - MATRIX[i][k]) < 1e-15, "matrix[%d][%d]: %.17g", i, k, value) end
  end
  check(view.at == nil and math.abs(view.direction.z - 0.64) < 1e-15, "it has a direction")
  view.matrix = { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 5 }, { 0, 0, 0, 1 } }
  check(view.eye == glint.vector(0, 0, -5) and view.up == glint.vector(0, -1, 0), "a matrix that is set")
  view.fov = 30
  check(view.fx == 0 and view.fov == 30, "fov takes the place of fx")
end

function tests.what_is_no_camera()
  local function wrong(want, fields)
    local good, message = pcall(camera, fields)
    check(not good and message:find(want, 1, true), "%s: %s", want, message)
  end
  wrong("camera.matrix: 3 or 4 rows of four numbers expected, got table", { matrix = { { 1, 0, 0, 0 } } })
  wrong("camera.matrix[2]: row of four numbers expected", { matrix = { { 1, 0, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1, 0 } } })
  wrong("camera.matrix: a rotation expected, whose rows have length 1", { matrix = { { 2, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 0 } } })
  wrong("camera.matrix: a rotation expected, got one that also mirrors", { matrix = { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, -1, 0 } } })
  wrong("camera.matrix[4]: { 0, 0, 0, 1 } expected",
    { matrix = { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 0 }, { 0, 0, 0, 2 } } })
  wrong("camera: matrix or eye expected, got both", { eye = { 0, 0, 1 } })
  wrong("camera: matrix or at expected, got both", { at = { 0, 0, 1 } })
  wrong("camera.fx: pixels > 0 expected, got -1", { fx = -1 })
  wrong("camera.fx: expected pixels > 0, because fy is set, got 0", { fx = 0 })
  wrong("camera.w: w and h expected", { w = 640 })
  wrong("camera.fx: a perspective camera expected", { projection = "orthographic" })
  check(not pcall(glint.camera, { at = { 0, 0, 0 } }), "an eye is needed")
end

tally.run(tests)
tally.finish()
