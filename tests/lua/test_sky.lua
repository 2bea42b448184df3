-- Skies with a small bright part, which indirect light samples by its brightness: closed forms of the light on a
-- plane, the shadow of a ball, many random directions, noise, a bound for every pixel, and identical pictures in every
-- configuration.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local tests = {}

local KD <const> = 0.5
local matt = glint.material { diffuse = KD }

-- The unit direction at an angle above the horizon.
local function at_height(angle)
  return glint.unit { 0.6 * math.cos(angle), math.sin(angle), -0.8 * math.cos(angle) }
end

-- A sky with a disk of the angular radius `radius` and brightness `bright` around a direction.
local function disk(direction, radius, bright, rest)
  return glint.pattern(function(d)
    return glint.select(glint.less(math.cos(radius), d:dot(direction)), bright, rest or 0)
  end)
end

local function floor() return glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = matt } end

-- Renders objects on a floor under a sky, seen from above.
local function look(sky, samples, more, options)
  local fields = {
    camera = glint.camera { eye = { 0, 9, 0 }, at = { 0, 0, 0 }, up = { 0, 0, -1 }, fov = 40 },
    background = sky, indirect = { samples = samples, bounces = 1 }, floor(),
  }
  for name, value in pairs(more or {}) do fields[type(name) == "number" and #fields + 1 or name] = value end
  local all = { width = 32, height = 24, output = "none", passes = "beauty,indirect" }
  for name, value in pairs(options or {}) do all[name] = value end
  return glint.scene(fields):render(all)
end

-- Returns the mean, the relative standard deviation and the largest value of the pass `indirect`.
local function statistics(image)
  local sum, square, most, count = 0, 0, 0, image.width * image.height
  for y = 0, image.height - 1 do
    for x = 0, image.width - 1 do
      local value = image:pixel(x, y, "indirect")
      sum, square, most = sum + value, square + value * value, math.max(most, value)
    end
  end
  local mean = sum / count
  return mean, math.sqrt(math.max(square / count - mean * mean, 0)) / mean, most
end

-- The irradiance of a disk above the horizon is pi sin^2(radius) sin(height) times its brightness.
function tests.disks_light_a_plane()
  for _, case in ipairs {
    { 0.8, 0.3, 0.05 }, { 0.8, 0.1, 0.06 }, { 0.2, 0.02, 0.12 }, { 1.5, 0.02, 0.12 }, { 0.8, 0.00465, 0.2 },
  } do
    local height, radius, noise = table.unpack(case)
    local want = KD * 1e4 * math.sin(radius) ^ 2 * math.sin(height)
    for _, precision in ipairs { "double", "float" } do
      local image = look(disk(at_height(height), radius, 1e4), 64, nil, { precision = precision })
      local mean, deviation, most = statistics(image)
      local name = ("a disk of %g at %g, %s"):format(radius, height, precision)
      near(mean / want, 1, 4 * noise / math.sqrt(32 * 24), name)
      check(deviation < noise, "%s: noise of %.3f", name, deviation)
      check(most < 2 * want, "%s: a pixel of %.3f of the mean", name, most / want)
    end
  end
end

-- Half of the sky is bright: by cosines alone the light is the same.
function tests.steps_light_a_plane()
  local half = glint.pattern(function(d) return glint.select(glint.less(0.5, d.y), 3, 0) end)
  local mean, deviation, most = statistics(look(half, 64))
  near(mean, KD * 3 * 0.75, 0.002, "a bright cap of 60 degrees")
  check(deviation < 0.03 and most < 1.3 * mean, "its noise: %.3f, %.3f", deviation, most)
end

-- A plain part around the disk adds its own light.
function tests.a_disk_in_a_grey_sky()
  local height, radius = 0.9, 0.02
  local want = KD * (0.25 + (2e3 - 0.25) * math.sin(radius) ^ 2 * math.sin(height))
  local mean, _, most = statistics(look(disk(at_height(height), radius, 2e3, 0.25), 256))
  near(mean / want, 1, 0.01, "a disk in a grey sky")
  check(most < 2 * want, "a pixel of %.3f of the mean", most / want)
end

-- Evenly spread directions of the disk, against a ball, for some points of its soft shadow.
function tests.a_ball_shades_the_plane()
  local height, radius, size, up = 0.8, 0.1, 0.5, 1.5
  local sun = at_height(height)
  local ball = glint.sphere { center = { 0, up, 0 }, radius = size, material = matt }
  local function share(x, z)
    local across = glint.unit { sun.z, 0, -sun.x }
    local beside, lit, count = sun:cross(across), 0, 4000
    for k = 1, count do
      local r, turn = math.sin(radius) * math.sqrt((k - 0.5) / count), 2 * math.pi * (k * 0.6180339887498949 % 1)
      local d = sun * math.sqrt(1 - r * r) + across * (r * math.cos(turn)) + beside * (r * math.sin(turn))
      local to = glint.vector(-x, up, -z)
      local along = to:dot(d)
      lit = lit + (to:dot(to) - along * along > size * size and d.y or 0)
    end
    return lit / count / sun.y
  end
  local image = look(disk(sun, radius, 1e3), 1024, { ball })
  local full, scale, seen = KD * 1e3 * math.sin(radius) ^ 2 * sun.y, 2 * 9 * math.tan(math.rad(20)) / 24, 0
  for y = 1, 23, 2 do
    for x = 1, 31, 2 do
      local px, pz = (x + 0.5 - 16) * scale, (y + 0.5 - 12) * scale
      if math.sqrt(px * px + pz * pz) > size * 9 / (9 - up) + 0.1 then -- the camera sees the floor
        local want = share(px, pz)
        near(image:pixel(x, y, "indirect") / full, want, 0.03, ("the floor at %g, %g"):format(px, pz))
        seen = seen + (want > 0.05 and want < 0.95 and 1 or 0)
      end
    end
  end
  check(seen >= 3, "%d points in the soft edge", seen)
end

-- ---- Identical pictures in every configuration ----------------------------------------------------------------------

local command = os.getenv "GLINT" or (os.getenv "BUILD" or "build") .. "/glint"

local function read(environment, script, options)
  local path = os.tmpname()
  local ok = os.execute(("%s %s %s --size 75x53 --quiet --force %s -o %s.pfm 2>%s"):format(environment, command, script,
    options, path, path))
  local file = ok and io.open(path .. "_0003.pfm", "rb")
  local bytes = file and file:read "a"
  if file then file:close() end
  local said = io.open(path):read "a"
  for n = 1, 3 do os.remove(("%s_%04d.pfm"):format(path, n)) end
  os.remove(path)
  return bytes, said
end

function tests.one_picture_by_every_way()
  local script = os.tmpname()
  local file = assert(io.open(script, "w"))
  file:write [[
local glint = require "glint"
local turn = 0
local matt = glint.material { diffuse = { 0.7, 0.3, 0.2 }, specular = 0.4 }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 1, 0 }, fov = 45 }, ambient = 0.2,
  background = glint.pattern(function(d) return glint.smoothstep(0.99, 1, d:dot(glint.unit { 1, 1 + turn, 1 })) * 300 + 0.1 end),
  indirect = { samples = 2, bounces = 3 },
  glint.sphere { center = { 0, 0, 0 }, radius = 1, material = matt },
  glint.sphere { center = { -2, 1, 0 }, radius = 1, material = glint.material { diffuse = 0.4, mirror = 0.3 } },
  glint.sphere { center = { 1.4, 0.7, 1.6 }, radius = 0.7, material = glint.material { diffuse = 0.1, transmission = 0.8,
    fresnel = true, absorption = 0.1 } },
  glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.6,
    bump = glint.pattern(function(p) return 0.05 * glint.sin(9 * p.x) end) } },
}
return glint.animation { scene = scene, frames = 3, samples = 2, frame = function(_, n) turn = n == 3 and 0.5 or 0 end }
]]
  file:close()
  for _, precision in ipairs { "double", "float" } do
    local usual, message = read("", script, "-f 1-3 --precision " .. precision)
    check(usual, "a picture: %s", message)
    for _, way in ipairs {
      { "", "-f 3 --threads 1" }, { "", "-f 1-3 --threads 7 --no-reuse" }, { "", "--shard 3/3" },
      { "", "-f 1-3 --reuse-memory 1M" }, { "GLINT_ISA=ref", "-f 3" }, { "GLINT_ISA=generic", "-f 3" },
      { "GLINT_ISA=avx2", "-f 3" }, { "GLINT_ISA=avx512", "-f 3" },
    } do
      local other, said = read(way[1], script, way[2] .. " --precision " .. precision)
      local name = ("%s %s %s"):format(precision, way[1], way[2])
      if not other and said:find("this machine lacks", 1, true) then
        print("# skip " .. name)
      else
        check(other == usual, "the same picture: %s %s", name, other and "" or said)
      end
    end
  end
  os.remove(script)
end

tally.run(tests)
tally.finish()
