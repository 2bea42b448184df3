-- An open shutter: the picture is the mean of stills at its times, however it is computed.
package.path = "tests/lua/?.lua;" .. package.path
local tally = require "tally"
local glint = require "glint"
local check = tally.check

local folder = os.tmpname()
os.remove(folder)
os.execute("mkdir -p " .. folder)

local WIDTH, HEIGHT = 45, 34 -- more than one tile, but not a whole number of tiles

-- Returns the floats of a .pfm, bottom row first.
local function read_pfm(path)
  local file = assert(io.open(path, "rb"))
  local kind, width, height = file:read("l", "n", "n")
  file:read "l"
  file:read "l"
  local data, values = file:read "a", {}
  file:close()
  local count = width * height * (kind == "PF" and 3 or 1)
  for i = 1, count do values[i] = string.unpack("<f", data, 4 * i - 3) end
  return values
end

local function float(x) return (string.unpack("<f", string.pack("<f", x))) end

-- Renders frame 2 of an animation of 3. Returns its values by pass.
local function expose(scene, frame, options)
  local fields = { scene = scene, frames = 3, frame = frame, width = WIDTH, height = HEIGHT,
    output = folder .. "/shutter_%04d.pfm" }
  for name, value in pairs(options or {}) do fields[name] = value end
  local passes = {}
  glint.animation(fields):run {}
  passes.beauty = read_pfm(folder .. "/shutter_0002.pfm")
  for name in (fields.passes or ""):gmatch "[^,]+" do
    passes[name] = read_pfm(folder .. "/shutter_0002." .. name:gsub(":", "_") .. ".pfm")
  end
  return passes
end

-- Returns the times of frame 2 of 3.
local function times_of(camera)
  local times, share, count = {}, camera.shutter, camera.shutter_times
  for k = 1, count do times[k] = (1 + share * ((k - 0.5) / count - 0.5)) / 2 end
  return times
end

-- Returns the mean of stills at the same times, each written to its own file.
local function mean_of_stills(scene, frame, options, pass)
  local camera = scene.camera
  local times, share = times_of(camera), camera.shutter
  local sum = {}
  camera.shutter = 0
  for _, t in ipairs(times) do
    frame(t, 2)
    local fields = { width = WIDTH, height = HEIGHT, output = folder .. "/still.pfm" }
    for name, value in pairs(options or {}) do fields[name] = value end
    scene:render(fields)
    local still = read_pfm(folder .. "/still" .. (pass and "." .. pass or "") .. ".pfm")
    for i, value in ipairs(still) do sum[i] = (sum[i] or 0) + value end
  end
  camera.shutter = share
  for i, value in ipairs(sum) do sum[i] = float(value / #times) end
  return sum
end

local function worst_of(got, want)
  local worst, differ = 0, 0
  for i, value in ipairs(want) do
    worst = math.max(worst, math.abs(got[i] - value) / math.max(1, math.abs(value)))
    differ = differ + (got[i] ~= value and 1 or 0)
  end
  return worst, differ
end

local CAMERA = { eye = { 0, 3, 12 }, at = { 0, 1, 0 }, shutter = 0.75, shutter_times = 5 }
local function with(more)
  local fields = {}
  for name, value in pairs(CAMERA) do fields[name] = value end
  for name, value in pairs(more or {}) do fields[name] = value end
  return glint.camera(fields)
end

-- Makes a small room lit by `light`, with more objects in it.
local function room(light, fields, ...)
  local parts = {
    red = glint.material { diffuse = { 0.8, 0.3, 0.2 }, specular = 0.5, shininess = 40 },
    floor = glint.material { diffuse = { 0.6, 0.6, 0.5 }, specular = 0.1 },
    camera = with(),
  }
  parts.ball = glint.sphere { center = { 0, 1, 0 }, radius = 1, material = parts.red }
  local scene = { camera = parts.camera, ambient = 0.1, background = { 0.1, 0.2, 0.3 }, light, parts.ball,
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = parts.floor },
    glint.sphere { center = { -2.5, 1, -1 }, radius = 1, material = parts.red }, ... }
  for name, value in pairs(fields or {}) do scene[name] = value end
  parts.scene = glint.scene(scene)
  return parts
end

local function circle(t, height) return { 6 * math.cos(4 * t), height or 6, 6 * math.sin(4 * t) } end

-- ---- Only lights move: their light is summed ----

local function place(light) return function(t) light.position = circle(t) end end
local glass = glint.sphere { center = { 2.5, 1, 1 }, radius = 0.9, material = glint.material { diffuse = 0.1, transmission = 0.8, mirror = 0.1 } }
local lit = {
  point = { glint.point_light { position = { 5, 6, 5 } }, place },
  spot = { glint.spot_light { position = { 5, 6, 5 }, direction = { -1, -1, -1 }, inner = 10, outer = 30 },
    function(light) return function(t) light.direction = { -1, -1 - t, -1 + t } end end },
  sphere = { glint.sphere_light { position = { 5, 6, 5 }, radius = 0.7, samples = 7 }, place },
  radiance = { glint.sphere_light { position = { 5, 6, 5 }, radius = 0.7, radiance = 9, samples = 7 }, place },
  caps = { glint.sphere_light { position = { 5, 6, 5 }, radius = 0.7, shadow = "caps" }, place },
  disk = { glint.disk_light { position = { 5, 6, 5 }, normal = { -1, -1, -1 }, radius = 1, samples = 4 }, place },
  sun = { glint.directional_light { direction = { -1, -1, -1 } },
    function(light) return function(t) light.direction = { -1, -1 - t, -1 + t } end end },
  flicker = { glint.point_light { position = { 5, 6, 5 } },
    function(light) return function(t) light.intensity = t < 0.45 and 0 or 1 + 3 * t end end },
  glass = { glint.point_light { position = { 5, 6, 5 } }, place, {}, glass },
  indirect = { glint.point_light { position = { 5, 6, 5 } }, place, { indirect = { samples = 3, bounces = 2 } } },
}
for name, case in pairs(lit) do
  local parts = room(case[1], case[3], glint.point_light { position = { -4, 7, 3 }, intensity = 0.2 }, case[4])
  local frame = case[2](case[1])
  for _, samples in ipairs { 1, 3 } do
    local got = expose(parts.scene, frame, { samples = samples }).beauty
    local want = mean_of_stills(parts.scene, frame, { samples = samples })
    local worst = worst_of(got, want)
    check(worst < 4e-7, "%s, %d samples: %g off the mean of stills", name, samples, worst)
  end
  local open = expose(parts.scene, frame).beauty
  parts.camera.shutter = 0
  local _, differ = worst_of(open, expose(parts.scene, frame).beauty)
  check(differ > 20, "%s: it moves", name) -- the pictures differ without the shutter, so the checks above could fail
end

do -- a static light counts once: nothing moves, and not a bit differs
  local parts = room(glint.point_light { position = { 5, 6, 5 } })
  local got = expose(parts.scene, function() end).beauty
  parts.camera.shutter = 0
  local _, differ = worst_of(got, expose(parts.scene, function() end).beauty)
  check(differ == 0, "nothing moves: %d values differ", differ)
end

-- ---- Other motion: the mean of pictures, bit for bit ----

local moved = {
  ball = function(parts) return function(t) parts.ball.center = { 3 * t, 1 + t, t } end end,
  camera = function(parts) return function(t) parts.camera.eye = { 3 * t, 3, 12 } end end,
  material = function(parts) return function(t) parts.red.shininess, parts.red.diffuse = 1 + 90 * t, { t, 0.3, 1 - t } end end,
  background = function(parts) return function(t) parts.scene.background = { t, 0, 1 - t } end end,
  ambient = function(parts) return function(t) parts.scene.ambient = t end end,
  all = function(parts, light)
    return function(t)
      parts.ball.center, light.position, parts.camera.at = { 2 * t, 1, 0 }, circle(t), { t, 1, 0 }
    end
  end,
}
for name, make in pairs(moved) do
  for _, options in ipairs { {}, { samples = 4, adaptive = 0.1 }, { precision = "float" } } do
    local light = glint.point_light { position = { 5, 6, 5 } }
    local parts = room(light)
    local frame = make(parts, light)
    local got = expose(parts.scene, frame, options).beauty
    local worst, differ = worst_of(got, mean_of_stills(parts.scene, frame, options))
    check(differ == 0, "%s: %d values differ from the mean of stills, %g at most", name, differ, worst)
  end
end

do -- with a visible light, a user's shader or emission, the engine also averages pictures
  local shader = glint.shader(function(s) return glint.max(s.n:dot(s.l), 0) ^ 2, 0 end)
  for name, case in pairs {
    seen = { glint.sphere_light { position = { 0, 4, 0 }, radius = 0.5, samples = 4, visible = true } },
    ambient = { glint.point_light { position = { 0, 4, 0 }, ambient = 0.2 }, "intensity" },
    shader = { glint.point_light { position = { 0, 4, 0 } }, "position", glint.sphere { center = { 2.5, 1, 1 }, radius = 1,
      material = glint.material { model = shader } } },
  } do
    local parts = room(case[1], {}, case[3])
    local frame = case[2] == "intensity" and function(t) case[1].intensity = 1 + t end
      or function(t) case[1].position = circle(t, 4) end
    local _, differ = worst_of(expose(parts.scene, frame).beauty, mean_of_stills(parts.scene, frame))
    check(differ == 0, "%s: %d values differ", name, differ)
  end
end

-- ---- Passes ----

do
  local light = glint.point_light { position = { 5, 6, 5 } }
  local parts = room(light, {}, glass)
  local TERMS = "background,ambient,diffuse,specular,indirect,mirror,transmission"
  local frame = moved.all(parts, light)
  local options = { passes = TERMS .. ",depth,normal,object_id,alpha,albedo" }
  local got = expose(parts.scene, frame, options)
  local off = 0
  for i, value in ipairs(got.beauty) do
    local sum
    for name in TERMS:gmatch "[^,]+" do sum = sum and float(sum + got[name][i]) or got[name][i] end
    off = off + (sum == value and 0 or 1)
  end
  check(off == 0, "the terms sum to beauty: %d values are off", off)
  for _, pass in ipairs { "diffuse", "specular", "mirror", "transmission", "alpha" } do
    local _, differ = worst_of(got[pass], mean_of_stills(parts.scene, frame, options, pass))
    check(differ == 0, "%s: %d values differ from the mean", pass, differ)
  end
  parts.camera.shutter = 0
  local instant = expose(parts.scene, frame, options)
  for _, pass in ipairs { "depth", "normal", "object_id", "albedo" } do
    local _, differ = worst_of(got[pass], instant[pass])
    check(differ == 0, "%s is of the frame's own instant: %d values differ", pass, differ)
  end
end

-- ---- Derivatives: the derivative of the mean is the mean of the times' derivatives ----

do
  local v = glint.variable("v", 1.25)
  local light = glint.point_light { position = { 5, 6, 5 } }
  local parts = room(light)
  local function is_gone(t) return t > 0.1 and t < 0.4 end
  local frames = { -- cases: only lights move, which are summed; a ball moves; some times lack the parameter
    light = function(t) light.position = { 6 * v * (t + 0.1), 6, 5 } end,
    ball = function(t) parts.ball.center = { v * (t + 0.1), 1, 0 } end,
    gone = function(t) light.intensity = is_gone(t) and 1 or v * (t + 0.1) end,
  }
  for name, frame in pairs(frames) do
    local got = expose(parts.scene, frame, { passes = "d:v" })["d:v"]
    local sum, most = {}, 0
    local share, times = parts.camera.shutter, times_of(parts.camera)
    parts.camera.shutter = 0
    for _, t in ipairs(times) do
      frame(t)
      if name ~= "gone" or not is_gone(t) then
        local image = parts.scene:render { width = WIDTH, height = HEIGHT, passes = "d:v", output = "none" }
        for y = 0, HEIGHT - 1 do
          for x = 0, WIDTH - 1 do
            for c, value in ipairs { image:pixel(x, y, "d:v") } do
              local i = 3 * ((HEIGHT - 1 - y) * WIDTH + x) + c
              sum[i] = (sum[i] or 0) + value
            end
          end
        end
      end
    end
    parts.camera.shutter = share
    for i, value in ipairs(sum) do sum[i], most = float(value / #times), math.max(most, math.abs(value)) end
    local _, differ = worst_of(got, sum)
    check(differ == 0 and most > 0.1, "%s: %d slopes differ from the mean of the times', %g at most", name, differ, most)
    light.position, light.intensity, parts.ball.center = { 5, 6, 5 }, 1, { 0, 1, 0 }
  end
end

-- ---- Calls of the frame function ----

local function calls_of(fields, camera)
  local calls = {}
  fields.scene = glint.scene { camera = with(camera), glint.sphere { center = { 0, 0, 0 }, radius = 1 } }
  fields.width, fields.height, fields.output = 8, 8, "none"
  fields.frame = function(t, n)
    calls[n] = calls[n] or {}
    table.insert(calls[n], t)
  end
  glint.animation(fields):run {}
  return calls
end
local function told(list)
  local words = {}
  for i, t in ipairs(list) do words[i] = ("%.6g"):format(t) end
  return table.concat(words, " ")
end
-- Each frame is built once, then rendered at its shutter times, and finally set to its own time again.
local open = calls_of({ frames = 3 }, { shutter = 0.5, shutter_times = 2 })
check(told(open[1]) == "0 0 0.0625 0", "the first of three: %s", told(open[1]))
check(told(open[2]) == "0.5 0.4375 0.5625 0.5", "the second: %s", told(open[2]))
check(told(open[3]) == "1 0.9375 1 1", "the last: %s", told(open[3]))
local cyclic = calls_of({ frames = 4, cyclic = true }, { shutter = 1, shutter_times = 2 })
check(told(cyclic[1]) == "0 0.9375 0.0625 0", "cyclic: %s", told(cyclic[1]))
local single = calls_of({ frames = 1 }, { shutter = 0.5, shutter_times = 2 })
check(told(single[1]) == "0 0.125 0.375 0", "a single frame: %s", told(single[1]))
check(told(calls_of({ frames = 2 }, { shutter = 0 })[2]) == "1", "closed: one call")

-- ---- Errors ----

do
  local parts = room(glint.point_light { position = { 5, 6, 5 } })
  local ok, message = pcall(expose, parts.scene, function(t)
    if t ~= 0 and t < 0.5 then error "no such time" end
  end)
  check(not ok and message:find("frame 1: .*no such time"), "an error at one of the times: %s", message)
end

os.execute("rm -rf " .. folder)
tally.finish()
