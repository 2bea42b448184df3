-- Skies with a small bright part, which indirect light samples by its brightness, and the files that hold such skies: closed forms of the light on a
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

-- Returns the mean, the relative standard deviation and the largest value of a pass.
local function statistics(image, pass)
  local sum, square, most, count = 0, 0, 0, image.width * image.height
  for y = 0, image.height - 1 do
    for x = 0, image.width - 1 do
      local value = image:pixel(x, y, pass or "indirect")
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
    local beside, lit, count = sun:cross(across), 0, 4000 // tally.step
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

-- ---- Files of floats ------------------------------------------------------------------------------------------------

local name = os.tmpname()

local function write(extension, bytes)
  local file <close> = assert(io.open(name .. extension, "wb"))
  file:write(bytes)
  return name .. extension
end

-- The texel of column x and row y, 0 at the top left, of a picture of 8 x 4 texels.
local function texel(texture, x, y)
  local color = texture:evaluate { uv = { (x + 0.5) / 8, 1 - (y + 0.5) / 4 } }
  return color.x, color.y, color.z
end

-- Four bytes of a texel: red (x + 16) / 256 * 2^y, green 0.5 * 2^y, blue 0.
local function rgbe(x, y) return x + 16, 128, 0, 128 + y end

local HEAD <const> = "#?RADIANCE\n# made by a test\nFORMAT=32-bit_rle_rgbe\n"

-- Lines of texels: `at(i, k)` gives column and row of texel i in line k.
local function flat(lines, texels, at)
  local out = {}
  for k = 0, lines - 1 do
    for i = 0, texels - 1 do out[#out + 1] = string.char(rgbe(at(i, k))) end
  end
  return table.concat(out)
end

-- The same with the runs of Radiance 2.0: literals of red, runs of the other bytes.
local function runs()
  local out = {}
  for y = 0, 3 do
    out[#out + 1] = "\2\2\0\8\8"
    for x = 0, 7 do out[#out + 1] = string.char(x + 16) end
    out[#out + 1] = string.char(128 + 8, 128, 128 + 3, 0, 5, 0, 0, 0, 0, 0, 128 + 8, 128 + y)
  end
  return table.concat(out)
end

local function is_ramp(path, factor, what)
  local good, texture = pcall(glint.texture, { file = path })
  check(good, "%s: %s", what, texture)
  for y = 0, good and 3 or -1 do
    for x = 0, 7 do
      local r, g, b = texel(texture, x, y)
      check(r == factor * (x + 16) / 256 * 2 ^ y and g == factor * 0.5 * 2 ^ y and b == 0, "%s: texel %d, %d: %g, %g, %g",
        what, x, y, r, g, b)
    end
  end
end

-- A sun in a rough mirror, seen from above: D G2 / 4 times the sun's irradiance, with GGX's distribution D and Smith's
-- height-correlated G2. Few rays suffice, because they are drawn by the sky where the mirror shows the sun.
function tests.a_sun_in_rough_mirrors()
  for _, case in ipairs { { 0.25, 0 }, { 0.25, 0.4 }, { 0.5, 0 }, { 0.5, 0.9 }, { 0.9, 1.2 } } do
    local roughness, turn = table.unpack(case)
    local alpha, radius, bright = roughness ^ 2, 0.02, 1e4
    local cosine, half = math.cos(turn), math.cos(turn / 2)
    local d = alpha ^ 2 / (math.pi * (half ^ 2 * (alpha ^ 2 - 1) + 1) ^ 2)
    local g2 = 2 / (1 + math.sqrt(1 + alpha ^ 2 * (1 / cosine ^ 2 - 1)))
    local want = d * g2 / 4 * math.pi * math.sin(radius) ^ 2 * bright
    local image = glint.scene {
      camera = glint.camera { eye = { 0, 9, 0 }, at = { 0, 0, 0 }, up = { 0, 0, -1 }, projection = "orthographic", height = 1 },
      background = disk(at_height(math.pi / 2 - turn), radius, bright), reflection_samples = 16,
      glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0, mirror = 1, roughness = roughness } },
    }:render { width = 32, height = 24, output = "none", passes = "beauty,mirror" }
    local mean, deviation = statistics(image, "mirror")
    near(mean, want, 0.05 * want, ("roughness %g, the sun %g from the zenith"):format(roughness, turn))
    check(deviation < 0.25, "roughness %g, the sun %g from the zenith: relative noise %g", roughness, turn, deviation)
  end
end

-- A sun seen from inside rough glass, upwards through its top: (1 - F) D G1 (v.h) (o.h) / (ior v.h - o.h)^2 times the
-- sun's irradiance on a surface that faces it (B. Walter et al., EGSR 2007), with o towards the sun and v towards the eye.
function tests.a_sun_in_rough_glass()
  for _, case in ipairs { { 0.3, 0.2 }, { 0.3, 0.3, true }, { 0.5, 0, true }, { 0.5, 0.5 }, { 0.9, 0.6, true } } do
    local roughness, turn, fresnel = table.unpack(case)
    local alpha, ior, radius, bright = roughness ^ 2, 1.5, 0.02, 1e4
    local along, across = ior - math.cos(turn), math.sin(turn) -- of v.h and o.h, both positive
    local length = math.sqrt(along ^ 2 + across ^ 2)
    local eye = along / length
    local out = ior * eye - length
    local d = alpha ^ 2 / (math.pi * (eye ^ 2 * (alpha ^ 2 - 1) + 1) ^ 2)
    local g1 = 2 / (1 + math.sqrt(1 + (alpha * math.tan(turn)) ^ 2))
    local p, q = (ior * eye - out) / (ior * eye + out), (eye - ior * out) / (eye + ior * out)
    local passed = fresnel and 1 - (p ^ 2 + q ^ 2) / 2 or 1
    local want = passed * d * g1 * eye * out / length ^ 2 * math.pi * math.sin(radius) ^ 2 * bright
    local image = glint.scene {
      camera = glint.camera { eye = { 0, -9, 0 }, at = { 0, 0, 0 }, up = { 0, 0, -1 }, projection = "orthographic", height = 1 },
      background = disk(at_height(math.pi / 2 - turn), radius, bright), reflection_samples = 16,
      glint.box { min = { -99, -99, -99 }, max = { 99, 0, 99 },
        material = glint.material { diffuse = 0, transmission = 1, mirror = fresnel and 1 or 0, fresnel = fresnel, ior = ior, roughness = roughness } },
    }:render { width = 32, height = 24, output = "none", passes = "beauty,transmission", max_depth = 1 }
    local mean, deviation = statistics(image, "transmission")
    near(mean, want, 0.05 * want, ("rough glass of %g, the sun %g from the zenith"):format(roughness, turn))
    check(deviation < 0.25, "rough glass of %g, the sun %g from the zenith: relative noise %g", roughness, turn, deviation)
  end
end

function tests.radiance_pictures()
  local function plain(i, k) return i, k end
  is_ramp(write(".hdr", HEAD .. "\n-Y 4 +X 8\n" .. flat(4, 8, plain)), 1, "flat")
  is_ramp(write(".hdr", HEAD .. "\n-Y 4 +X 8\n" .. runs()), 1, "runs")
  is_ramp(write(".hdr", HEAD .. "EXPOSURE=4\nEXPOSURE=2.0\nCOLORCORR=0.5 0.5 0.5\n\n-Y 4 +X 8\n" .. runs()), 0.25, "EXPOSURE")
  for _, length in ipairs { 254, 255, 256, 257, 1400, 70000 } do
    local comment = "# " .. ("x"):rep(length - 2) .. "\n"
    is_ramp(write(".hdr", HEAD .. comment .. "EXPOSURE=4\n\n-Y 4 +X 8\n" .. runs()), 0.25, "a line of " .. length .. " bytes")
  end
  for size, at in pairs {
    ["+Y 4 +X 8"] = function(i, k) return i, 3 - k end, ["-Y 4 -X 8"] = function(i, k) return 7 - i, k end,
    ["+X 8 -Y 4"] = function(i, k) return k, i end, ["-X 8 +Y 4"] = function(i, k) return 7 - k, 3 - i end,
  } do
    local lines = size:find "^.X" and 8 or 4
    is_ramp(write(".hdr", HEAD .. "\n" .. size .. "\n" .. flat(lines, 32 // lines, at)), 1, size)
  end
  local old = glint.texture { file = write(".hdr", "#?RGBE\n\n-Y 1 +X 8\n\64\0\0\128\1\1\1\6\0\64\0\128") }
  check(texel(old, 6, 0) == 0.25 and select(2, texel(old, 7, 0)) == 0.25, "a run of the first kind")
  local long = glint.texture { file = write(".hdr", "#?RGBE\n\n-Y 1 +X 601\n\64\0\0\128\1\1\1\88\1\1\1\2") }
  check(long:evaluate({ uv = { 0.99, 0.5 } }).x == 0.25, "a run of two digits")
end

function tests.broken_radiance_pictures()
  local whole = HEAD .. "\n-Y 4 +X 8\n" .. runs()
  for length = 2, #whole - 1, 3 do
    tally.raises(".hdr: ", glint.texture, { file = write(".hdr", whole:sub(1, length)) })
  end
  for bytes, message in pairs {
    ["#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234"] = "FORMAT: 32-bit_rle_rgbe expected, got 32-bit_rle_xyze",
    ["#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n1234"] = "EXPOSURE and COLORCORR: numbers > 0 expected",
    ["#?RADIANCE\n\n-Y 65535 +X 65535\n1234"] = "a picture of at most 33554432 pixels expected, got 65535 x 65535",
    ["#?RADIANCE\n\n-Y 0 +X 5\n1234"] = "a size such as -Y 512 +X 1024 expected, got -Y 0 +X 5",
    ["#?RADIANCE\n\n-Y 2 +Y 5\n1234"] = "a size such as -Y 512 +X 1024 expected, got -Y 2 +Y 5",
    ["#?RADIANCE\n\n-Y 1 +X 2\n\1\1\1\1\1\2\3\4"] = "line 1 of 1 cannot be read",
    ["#?RADIANCE\n\n-Y 1 +X 2\n\3\2\1\128\1\1\1\9"] = "line 1 of 1 cannot be read",
    ["#?RADIANCE\n\n-Y 1 +X 8\n\2\2\0\8\137\1"] = "line 1 of 1 cannot be read",
    ["#?RADIANCE\n\n-Y 1 +X 8\n\2\2\0\8\0\1"] = "line 1 of 1 cannot be read",
    ["#?RADIANCE\nEXPOSURE=1e-30\n\n-Y 1 +X 1\n\255\0\0\255"] = "pixel 0, 0: light of 0 .. 1e30 expected, got inf",
  } do
    tally.raises(".hdr: ", glint.texture, { file = write(".hdr", bytes) })
    tally.raises(message, glint.texture, { file = write(".hdr", bytes) })
  end
  math.randomseed(7)
  for _ = 1, 300 do -- no damage may crash
    local at = math.random(#whole)
    pcall(glint.texture, { file = write(".hdr", whole:sub(1, at - 1) .. string.char(math.random(0, 255)) .. whole:sub(at + 1)) })
  end
end

function tests.float_maps()
  local floats = {}
  for y = 3, 0, -1 do
    for x = 0, 7 do floats[#floats + 1] = ("<fff"):pack((x + 16) / 256 * 2 ^ y, 0.5 * 2 ^ y, 0) end
  end
  local pixels = table.concat(floats)
  for _, head in ipairs { "PF\n8 4\n-1.0\n", "PF\n# made by hand\n8 4\n-1.0\n", "PF # a\n8 # b\r\n#\n4\n# " .. ("c"):rep(5000) .. "\n-1.0\n" } do
    is_ramp(write(".pfm", head .. pixels), 1, ".pfm")
  end
  for _, head in ipairs { "PF\n8 4\n0\n", "PF\n# 8 4\n-1.0\n", "PF4\n8 4\n-1.0\n", "PF\n8 x\n-1.0\n", "Pf\n" } do
    tally.raises(".pfm: not a PFM: PF or Pf, width, height and scale expected", glint.texture, { file = write(".pfm", head .. pixels) })
  end
  tally.raises(".ppm: is PPM; textures are .png, .jpg, .hdr, .exr or .pfm", glint.texture, { file = write(".ppm", "P6\n1 1\n255\n123") })
  for _, wrong in ipairs { -1, 0 / 0, math.huge, 2e30 } do
    local bad = pixels:sub(1, 12 * 10) .. ("<f"):pack(wrong) .. pixels:sub(12 * 10 + 5)
    tally.raises(".pfm: pixel 2, 2: light of 0 .. 1e30 expected, got ", glint.texture, { file = write(".pfm", "PF\n8 4\n-1.0\n" .. bad) })
  end
end

-- A black sky with one texel of 10^4: the tent of the texel is two texels wide.
function tests.one_texel_lights_a_plane()
  local w, h, x, y = 64, 32, 20, 9
  local black = ("\0"):rep(4)
  local bytes = black:rep(y * w + x) .. string.char(156, 156, 156, 142) .. black:rep((h - y) * w - x - 1)
  local sky = glint.texture { file = write(".hdr", HEAD .. ("\n-Y %d +X %d\n"):format(h, w) .. bytes) }
  local bright, a, sum = 156 * 2 ^ 6, math.pi / h, 0
  for k = 1, 2000 do
    local from = (k - 0.5) / 1000 - 1 -- texels from the middle
    local angle = (y + 0.5 + from) * a
    sum = sum + (1 - math.abs(from)) * math.sin(angle) * math.cos(angle) * a / 1000
  end
  local want = KD * bright * 2 / w * sum
  local mean, deviation, most = statistics(look(sky, 64))
  near(mean / want, 1, 0.01, "a texel's light")
  check(deviation < 0.05, "its noise: %.3f", deviation)
  check(most < 1.2 * want, "a pixel of %.3f of the mean", most / want)
end

-- ---- Identical pictures in every configuration ----------------------------------------------------------------------

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
  dofile "tests/lua/everywhere.lua"(tally, script, 3, 3)
  os.remove(script)
end

tally.run(tests)
for _, extension in ipairs { "", ".hdr", ".pfm", ".ppm" } do os.remove(name .. extension) end
tally.finish()
