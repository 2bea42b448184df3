-- orbit: pictures of a turned view are those of a camera at the place computed here; limits, other cameras and errors.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local WIDTH, HEIGHT = 48, 32
local AT <const> = { 1, 0.5, -2 }

-- Returns the eye at an angle to the right of the z axis, at an elevation, seen from AT.
local function eye_at(yaw, elevation, distance)
  local a, e = math.rad(yaw), math.rad(elevation)
  return { AT[1] + distance * math.cos(e) * math.sin(a), AT[2] + distance * math.sin(e), AT[3] + distance * math.cos(e) * math.cos(a) }
end

local function scene_of(camera)
  local scene = glint.scene { camera = glint.camera(camera), ambient = 0.2, glint.point_light { position = { 3, 6, 5 } } }
  for i = 1, 5 do scene:add(glint.sphere { center = { AT[1] + i - 3, AT[2] + 0.3 * i - 1, AT[3] + i % 2 }, radius = 0.4 }) end
  return scene
end

local function depths(camera, orbit)
  local image = scene_of(camera):render { width = WIDTH, height = HEIGHT, passes = "depth", output = "none", orbit = orbit }
  local out = {}
  for row = 0, HEIGHT - 1 do
    for column = 0, WIDTH - 1 do out[#out + 1] = image:pixel(column, row, "depth") end
  end
  return out
end

-- Returns how many depths differ by more than rounding does. At outlines, rounding may turn a hit into a miss.
local function differing(a, b)
  local count = 0
  for i = 1, #a do
    if not (a[i] == b[i] or math.abs(a[i] - b[i]) < 1e-4) then count = count + 1 end
  end
  return count
end

local tests = {}

function tests.turns()
  for _, turn in ipairs { { 30, 0, 1 }, { -75, 20, 1 }, { 200, -50, 1 }, { 10, 15, 1.5 } } do
    local yaw, pitch, zoom = turn[1], turn[2], turn[3]
    local text = ("%g,%g,%g"):format(yaw, pitch, zoom)
    local turned = depths({ eye = eye_at(0, 25, 7), at = AT }, text)
    local placed = depths({ eye = eye_at(yaw, 25 + pitch, 7 / zoom), at = AT })
    check(differing(turned, placed) <= 2, "%s: %d depths differ", text, differing(turned, placed))
    check(differing(turned, depths { eye = eye_at(0, 25, 7), at = AT }) > 50, "%s: the view turns", text)
  end
end

-- The elevation stops at 89 degrees.
function tests.limits()
  local turned, placed = depths({ eye = eye_at(0, 25, 7), at = AT }, "0,500"), depths { eye = eye_at(0, 89, 7), at = AT }
  check(differing(turned, placed) <= 2, "from above: %d depths differ", differing(turned, placed))
  turned, placed = depths({ eye = eye_at(0, 25, 7), at = AT }, "15,-120"), depths { eye = eye_at(15, -89, 7), at = AT }
  check(differing(turned, placed) <= 2, "from below: %d depths differ", differing(turned, placed))
end

function tests.shifts()
  local eye, height = eye_at(0, 0, 7), 2 * 7 * math.tan(math.rad(20)) -- of the picture at the target
  local function moved(v) return { v[1] - 0.25 * height, v[2] - 0.125 * height, v[3] } end
  local turned, placed = depths({ eye = eye, at = AT }, "0,0,1,0.25,0.125"), depths { eye = moved(eye), at = moved(AT) }
  check(differing(turned, placed) <= 2, "%d depths differ", differing(turned, placed))
end

function tests.other_cameras()
  local flat = { eye = eye_at(0, 0, 7), at = AT, projection = "orthographic", height = 4 }
  local turned = depths(flat, "40,10,2")
  local placed = depths { eye = eye_at(40, 10, 3.5), at = AT, projection = "orthographic", height = 2 }
  check(differing(turned, placed) <= 2, "orthographic: %d depths differ", differing(turned, placed))
  -- A camera with a direction turns around the point of its axis that is nearest to the middle of the shapes.
  local camera = { eye = eye_at(0, 0, 7), direction = { 0, 0, -1 } }
  local ahead = depths(camera, "90,0")
  local seen = 0
  for _, depth in ipairs(ahead) do seen = seen + (depth < 20 and 1 or 0) end
  check(seen > 20, "a direction: %d pixels show a shape", seen)
end

-- Without a turn not one bit changes, and the camera of the scene is as before.
function tests.nothing_else()
  local camera = { eye = eye_at(20, 10, 7), at = AT }
  local plain = depths(camera)
  for _, orbit in ipairs { true, false, "0,0", "0,0,1,0,0" } do
    local other, same = depths(camera, orbit), true
    for i = 1, #plain do same = same and plain[i] == other[i] end
    check(same, "orbit = %s changes bits", tostring(orbit))
  end
  local scene = scene_of(camera)
  scene:render { width = 8, height = 8, output = "none", orbit = "30,30,2,0.1,0.1" }
  near(scene.camera.eye.x, camera.eye[1], 0, "the eye is as before")
  local job = glint.animation { scene = scene, orbit = true }
  check(job.orbit == true, "an animation has the field")
end

function tests.errors()
  local scene = scene_of { eye = { 0, 0, 7 }, at = AT }
  for _, wrong in ipairs { "1", "1,2,3,4", "1,2,0", "1,,2", "1,2 ", "x", "1,2,3,4,5,6", "nan,0" } do
    local good, message = pcall(scene.render, scene, { width = 8, height = 8, output = "none", orbit = wrong })
    check(not good and message:find("scene:render: orbit: true, false or YAW,PITCH,ZOOM,RIGHT,UP", 1, true), "%s: %s", wrong, message)
  end
  local good, message = pcall(scene.render, scene, { width = 8, height = 8, output = "none", orbit = 3 })
  check(not good and message:find("orbit", 1, true), "a number: %s", tostring(message))
end

tally.run(tests)
tally.finish()
