-- The hard cases that need a picture: scale and offset, ties, coverage, lights at difficult positions, unusual
-- cameras and sizes. Each is named by its id. Cases with one ray or one reflection are in hard_cases.c and
-- hard_shading.c, the largest numbers and counts in hard_limits.c, random scenes in hard_frames.c.
local glint = require "glint"

local tabular = arg and arg[1] == "--table" -- prints tables for `make hard`
if tabular then print "Whole scenes.\n\n| case | verdict |\n| --- | --- |" end
local count, wrong_count = 0, 0
local function check(ok, name, ...)
  count = count + 1
  wrong_count = wrong_count + (ok and 0 or 1)
  if tabular then
    print(("| %s | %s |"):format(name, ok and "right" or "**wrong**"))
  else
    print(("%sok %d - %s"):format(ok and "" or "not ", count, name))
  end
  if not ok then print("# " .. table.concat({ ... }, " ")) end
end

local function refused(name, pattern, make)
  local ok, message = pcall(make)
  check(not ok and tostring(message):find(pattern), name, "got:", tostring(message))
end

-- Compares the pixels of two images. Returns the number that differ, and the largest difference in 8-bit sRGB steps.
local function code(x)
  x = math.min(math.max(x, 0), 1)
  return math.floor(255 * (x <= 0.0031308 and 12.92 * x or 1.055 * x ^ (1 / 2.4) - 0.055) + 0.5)
end
local function difference(a, b)
  local differ, worst = 0, 0
  for y = 0, a.height - 1 do
    for x = 0, a.width - 1 do
      local p, q = { a:pixel(x, y) }, { b:pixel(x, y) }
      if p[1] ~= q[1] or p[2] ~= q[2] or p[3] ~= q[3] then differ = differ + 1 end
      for c = 1, 3 do worst = math.max(worst, math.abs(code(p[c]) - code(q[c]))) end
    end
  end
  return differ, worst
end

-- A still life with every length multiplied by s, then moved by m.
local function still_life(s, m)
  local function at(x, y, z) return { x * s + m[1], y * s + m[2], z * s + m[3] } end
  local shiny = glint.material { diffuse = { 0.7, 0.3, 0.2 }, specular = 0.5, shininess = 40 }
  local blinn = glint.material { model = "blinn_phong", diffuse = { 0.2, 0.5, 0.7 }, specular = 0.4, shininess = 90 }
  return glint.scene {
    camera = glint.camera { eye = at(0, 2, 12), at = at(0, 0.5, 0), fov = 45 },
    ambient = 0.1, background = { 0.02, 0.02, 0.05 },
    glint.point_light { position = at(4, 8, 6), intensity = 1.5, attenuation = { 1, 0.05 / s, 0.01 / (s * s) } },
    glint.directional_light { direction = { 1, -2, -1 }, intensity = 0.3 },
    glint.sphere { center = at(-1.5, 0.5, 0), radius = 1.5 * s, material = shiny },
    glint.sphere { center = at(1.75, 0.25, 1), radius = 1.25 * s, material = blinn },
    glint.plane { point = at(0, -1, 0), normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.6 } },
  }
end
local size = { width = 96, height = 72 }
local origin = { 0, 0, 0 }
local plain = still_life(1, origin):render(size)
for _, k in ipairs { -40, -20, 20, 40 } do
  local differ = difference(plain, still_life(2.0 ^ k, origin):render(size))
  check(differ == 0, ("S36: scale 2^%d gives the same bits"):format(k), differ .. " pixels differ")
end
-- A light next to the eye, closer than any length of the scene; and a light at the eye, in a scene of any size.
for _, c in ipairs { { 1e-19, 1 }, { 1e-25, 1 }, { 1e-300, 1 }, { 0, 1 }, { 0, 1e19 }, { 0, 1e-19 }, { 0, 1e60 } } do
  local x, s = c[1], c[2]
  local image = glint.scene {
    camera = glint.camera { eye = { 0, 0, 0 }, at = { 0, 0, -s }, fov = 30 },
    glint.point_light { position = { x, 0, 0 } },
    glint.sphere { center = { 0, 0, -5 * s }, radius = s, material = glint.material { diffuse = 1 } },
  }:render { width = 33, height = 33 }
  local lit = image:pixel(16, 16)
  check(math.abs(lit - 1) < 1e-6, ("L: a lamp %g from the eye, lengths times %g"):format(x, s), tostring(lit))
end
for _, s in ipairs { 1e6, 1e-6 } do
  local _, worst = difference(plain, still_life(s, origin):render(size))
  check(worst <= 1, ("S36: scale %g within one code"):format(s), worst .. " codes")
end
do
  local _, worst = difference(plain, still_life(1, { 1e7, 0, 1e7 }):render(size))
  check(worst <= 1, "S37: moved by 1e7 within one code", worst .. " codes")
end

do -- S38
  local function twins(first, second)
    local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = origin, fov = 30 }, ambient = 1 }
    for _, color in ipairs { first, second } do
      scene:add(glint.sphere { center = origin, radius = 1, material = glint.material { diffuse = color } })
    end
    return scene:render { width = 40, height = 40 }
  end
  for _, case in ipairs { { "red", { 1, 0, 0 }, { 0, 1, 0 }, 1, 2 }, { "green", { 0, 1, 0 }, { 1, 0, 0 }, 2, 1 } } do
    local image, wrong, seen = twins(case[2], case[3]), 0, 0
    for y = 0, 39 do
      for x = 0, 39 do
        local p = { image:pixel(x, y) }
        if p[case[4]] > 0 then seen = seen + 1 end
        if p[case[5]] > 0 then wrong = wrong + 1 end
      end
    end
    check(seen > 400 and wrong == 0, "S38: of two equal spheres the first wins: " .. case[1], seen, wrong)
  end
end

for W, want in pairs { [16] = 12, [64] = 140, [101] = 341, [256] = 2136, [512] = 8564 } do
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = origin, fov = 90 }, ambient = 1,
    glint.sphere { center = origin, radius = 1, material = glint.material { diffuse = 1 } } }
  local image, got = scene:render { width = W, height = W }, 0
  for y = 0, W - 1 do
    for x = 0, W - 1 do
      if image:pixel(x, y) > 0 then got = got + 1 end
    end
  end
  check(got == want, ("S40: %d pixels covered at %d x %d"):format(want, W, W), "got " .. got)
end

-- Calls f with every value of an image's first channel.
local function each(image, f)
  for y = 0, image.height - 1 do
    for x = 0, image.width - 1 do f(image:pixel(x, y)) end
  end
end
local function all(image, test)
  local ok = true
  each(image, function(r, g, b) ok = ok and test(r, g, b) end)
  return ok
end
local function inside_out(light, eye)
  return glint.scene { camera = glint.camera { eye = eye, direction = { 0, 0, -1 }, fov = 60 }, ambient = 0.25, light,
    glint.sphere { center = origin, radius = 1, material = glint.material { diffuse = 0.5, specular = 0.3 } } }
end
local small = { width = 31, height = 23 }
local ambient_only = function(r) return r == 0 or r == 0.125 end

do -- L1
  local floor = glint.plane { point = origin, normal = { 0, 1, 0 } , material = glint.material { diffuse = 0.5, specular = 1 } }
  local scene = glint.scene { camera = glint.camera { eye = { 0, 4, 0 }, at = origin, up = { 0, 0, -1 } }, ambient = 0.25,
    glint.point_light { position = origin, attenuation = { 0, 0, 1 } }, floor }
  check(scene:render { width = 1, height = 1 }:pixel(0, 0) == 0.125, "L1: a light at the shaded point adds 0")
  scene:remove(floor)
  scene:add(glint.plane { point = origin, normal = { 0, 1, 0 }, material = floor.material })
  local near = glint.scene { camera = scene.camera, floor, glint.point_light { position = { 0, 1e-30, 0 }, attenuation = { 0, 0, 1 } } }
  local r = near:render { width = 1, height = 1 }:pixel(0, 0)
  check(r > 1 and r < math.huge, "L5: a light 1e-30 away, inverse square, is finite and white", tostring(r))
end
check(all(inside_out(glint.point_light { position = { 0, 0.25, 0 } }, { 0, 0, 3 }):render(small), ambient_only),
  "L2: light inside an opaque sphere, camera outside: ambient only")
check(all(inside_out(glint.point_light { position = { 0, 3, 0 } }, origin):render(small), ambient_only),
  "L3b: camera inside, light outside: ambient only")
check(all(inside_out(glint.directional_light { direction = { 0, 0, -1 } }, origin):render(small), ambient_only),
  "L3b: camera inside, directional light: ambient only")
do
  local scene = inside_out(glint.point_light { position = origin }, { 0, 0.5, 0 })
  local image = scene:render { width = 31, height = 23, passes = "diffuse" }
  local ok = true
  for y = 0, 22 do
    for x = 0, 30 do ok = ok and math.abs(image:pixel(x, y, "diffuse") - 0.5) < 1e-6 end
  end
  check(ok, "L3: camera and light inside, light at the centre: n.l = 1 everywhere")
end
do
  local function lit(light)
    local scene = still_life(1, origin)
    scene:add(light)
    return scene:render(size)
  end
  local sun = lit(glint.directional_light { direction = { -1, -2, 0 }, intensity = 0.5 })
  for _, far in ipairs { 1e30, 1e155, 8e307 } do
    local _, worst = difference(lit(glint.point_light { position = { far, 2 * far, 0 }, intensity = 0.5 }), sun)
    check(worst <= 1, ("L4: a light at %g equals a directional light"):format(far), worst .. " codes")
  end
end
do
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 2 }, at = origin },
    glint.plane { point = origin, normal = { 0, 0, 1 }, material = glint.material { diffuse = { 1, 0, 1 } } } }
  for _ = 1, 1000 do
    scene:add(glint.directional_light { direction = { 0, 0, -1 }, intensity = 1e36, shadows = false })
  end
  local r, g, b = scene:render { width = 1, height = 1 }:pixel(0, 0)
  check(r > 1 and b > 1 and g == 0, "L14: 1000 lights of 1e36: white, and 0 where the material is 0", r, g, b)
end

-- Cameras and sizes
local function view(camera, w, h)
  return glint.scene { camera = camera, ambient = 1,
    glint.sphere { center = origin, radius = 1, material = glint.material { diffuse = 0.5 } } }:render { width = w or 9, height = h or 9 }
end
local finite = function(r) return r == r and math.abs(r) < math.huge end
local up = view(glint.camera { eye = { 0, 5, 0 }, at = origin, up = { 0, 1, 0 } })
check(all(up, finite) and up:pixel(4, 4) == 0.5, "C1: up along the view falls back to another axis")
refused("C1: up = 0 is refused", "camera%.up", function() glint.camera { eye = { 0, 0, 5 }, at = origin, up = { 0, 0, 0 } } end)
for _, fov in ipairs { 0, 180, -1, 0 / 0 } do
  refused("C2: fov " .. tostring(fov) .. " is refused", "camera%.fov", function() glint.camera { eye = { 0, 0, 5 }, at = origin, fov = fov } end)
end
do -- half the picture's height is tan(fov / 2): a sphere of radius 1 at distance 2 covers little of it
  local image = view(glint.camera { eye = { 0, 0, 2 }, at = origin, fov = 179.9 }, 101, 101)
  check(all(image, finite) and image:pixel(50, 50) == 0.5, "C2: fov 179.9")
end
do
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = origin }, ambient = 1,
    glint.sphere { center = origin, radius = 1 } }
  local one = scene:render { width = 1, height = 1, passes = { "depth" } }
  check(one:pixel(0, 0, "depth") == 4, "C3: the ray of a 1 x 1 image goes through its exact centre")
  for _, s in ipairs { { 1, 10000 }, { 10000, 1 } } do
    local image = scene:render { width = s[1], height = s[2] }
    check(image.width == s[1] and image.height == s[2] and all(image, finite), ("C3: %d x %d"):format(s[1], s[2]))
  end
  for _, s in ipairs { { 65536, 65536 }, { 46341, 46341 }, { 1.5, 2 }, { 0 / 0, 2 }, { -1, 5 }, { math.huge, 2 } } do
    refused(("I4: %s x %s is refused"):format(s[1], s[2]), "expected, got", function()
      scene:render { width = s[1], height = s[2] }
    end)
  end
  refused("I4: height 0 is refused", "height", function() scene:render { width = 1, height = 0 } end)
end
do
  local scene = glint.scene { glint.plane { point = origin, normal = { 0, 1, 0 } } }
  check(scene:cast({ 0, 0, 0 }, { 1, 0, 0 }) == nil, "G1: a ray in the plane misses")
  check(scene:cast({ 0, 1, 0 }, { 1, 0, 3 }) == nil, "G1: a ray parallel to the plane misses")
  check(scene:cast({ 0, 1, 0 }, { 1, -1e-31, 0 }) == nil, "G1: so does one that is parallel within 1e-30")
  local hit = scene:cast({ 0, 1, 0 }, { 0, -2, 0 })
  check(hit and hit.t == 0.5 and hit.normal.y == 1, "G1: others hit")
end

do -- passes
  local image = still_life(1, origin):render { width = 96, height = 72, samples = 4,
    passes = "beauty,background,ambient,diffuse,specular,depth,normal,object_id" }
  local wrong = 0
  local function f32(x) return (string.unpack("f", string.pack("f", x))) end
  for y = 0, 71 do
    for x = 0, 95 do
      local sum = { image:pixel(x, y, "background") }
      for _, pass in ipairs { "ambient", "diffuse", "specular" } do
        local p = { image:pixel(x, y, pass) }
        for c = 1, 3 do sum[c] = f32(sum[c] + p[c]) end
      end
      local p = { image:pixel(x, y) }
      for c = 1, 3 do if p[c] ~= sum[c] then wrong = wrong + 1 end end
    end
  end
  check(wrong == 0, "passes sum to the beauty exactly", wrong .. " channels differ")
  local ids = {}
  for y = 0, 71 do for x = 0, 95 do ids[image:pixel(x, y, "object_id")] = true end end
  check(ids[0] and ids[1] and ids[2] and ids[3], "object_id counts from 1 in order of definition, 0 is background")
  check(image:pixel(0, 0, "depth") == math.huge, "depth is inf in the background")
end
do
  local empty = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = origin }, background = { 0.25, 0.5, 1 } }:render { width = 5, height = 4 }
  check(all(empty, function(r, g, b) return r == 0.25 and g == 0.5 and b == 1 end), "B1: an empty scene is its background")
end
if tabular then
  print(("\n%d passed, %d failed, 0 skipped"):format(count - wrong_count, wrong_count))
else
  print("1.." .. count)
end
os.exit(not tabular or wrong_count == 0, true)
