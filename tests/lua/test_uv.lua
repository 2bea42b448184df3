-- s.uv: coordinates of meshes from vt and uv, in patterns, textures and bumps, against values computed here.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local raises = tally.raises

local UV <const> = glint.pattern(function(_, s) return { s.uv.u, s.uv.v, 0 } end)
local PASSES <const> = { width = 40, height = 30, passes = { "beauty", "albedo", "normal" } }

local function scene_of(shape, eye)
  return glint.scene { camera = glint.camera { eye = eye or { 0.3, 0.2, 6 }, at = { 0, 0, 0 }, fov = 50 }, ambient = 1, shape }
end

-- Calls f(x, y, hit) for each pixel of PASSES that shows a surface.
local function each_hit(scene, f)
  local camera = scene.camera
  local w = (glint.vector(camera.eye) - camera.at):unit()
  local u = glint.cross({ 0, 1, 0 }, w):unit()
  local v, half, count = w:cross(u), math.tan(math.rad(camera.fov / 2)), 0
  for y = 0, 29 do
    for x = 0, 39 do
      local hit = scene:cast(camera.eye, u * ((x + 0.5 - 20) / 15 * half) + v * ((15 - y - 0.5) / 15 * half) - w)
      if hit then
        count = count + 1
        f(x, y, hit)
      end
    end
  end
  return count
end

local function quad(fields)
  fields.vertices = fields.vertices or { { -2, -1, 0 }, { 2, -1, 0 }, { 2, 1, 0 }, { -2, 1, 0 } }
  fields.faces = fields.faces or { { 1, 2, 3, 4 } }
  return glint.mesh(fields)
end

local function with_file(text, f)
  local name = os.tmpname() .. ".obj"
  local file <close> = assert(io.open(name, "w"))
  file:write(text)
  file:close()
  f(name)
  os.remove(name)
end

local tests = {}

-- Triangles under a general map, with their own coordinates: interpolated by the areas around the point.
function tests.between_corners_by_areas()
  local vertices = { { -2, -1.2, 0 }, { 1.5, -1, 0.4 }, { 1.8, 1.3, -0.3 }, { -1.6, 1.1, 0.5 } }
  local uv = { { 0.1, 0.2 }, { 0.9, 0.1 }, { 0.7, 0.8 }, { 0.3, 0.4 }, { 0.6, 0.9 }, { 0.2, 0.5 } }
  local faces = { { 1, 2, 3 }, { 1, 3, 4 } }
  local map = glint.translate(0.2, 0.1, 0) * glint.rotate("y", 20) * glint.scale(-1, 0.8, 1.2)
  local function placed(i) -- applies the map, step by step
    local v = glint.vector { -vertices[i][1], 0.8 * vertices[i][2], 1.2 * vertices[i][3] }
    local c, s = math.cos(math.rad(20)), math.sin(math.rad(20))
    return glint.vector { c * v.x + s * v.z + 0.2, v.y + 0.1, c * v.z - s * v.x }
  end
  for _, shading in ipairs { "faceted", "phong" } do
    local mesh = glint.mesh { vertices = vertices, faces = faces, uv = uv, shading = shading, transform = map,
      material = glint.material { diffuse = UV } }
    local scene = scene_of(mesh)
    local image = scene:render(PASSES)
    local count = each_hit(scene, function(x, y, hit)
      local corner, q, at = faces[hit.element], glint.vector(hit.point), {}
      local a, b, c = placed(corner[1]), placed(corner[2]), placed(corner[3])
      local whole = (b - a):cross(c - a)
      local share = { (b - q):cross(c - q):dot(whole), (c - q):cross(a - q):dot(whole), (a - q):cross(b - q):dot(whole) }
      for k = 1, 2 do
        local sum = 0
        for i = 1, 3 do sum = sum + share[i] / whole:dot(whole) * uv[3 * hit.element - 3 + i][k] end
        at[k] = sum
      end
      local got = { image:pixel(x, y, "albedo") }
      near(got[1], at[1], 1e-6, "u") near(got[2], at[2], 1e-6, "v")
    end)
    check(count > 150, "%d pixels", count)
  end
end

function tests.a_vertex_may_have_the_coordinates()
  local corners = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 0 }, { 1, 1 }, { 0, 1 } }
  local faces = { { 1, 2, 3 }, { 1, 3, 4 } }
  local material = glint.material { diffuse = UV }
  local function bytes(fields)
    fields.faces, fields.material = faces, material
    local image, text = scene_of(quad(fields)):render(PASSES), {}
    for y = 0, 29 do for x = 0, 39 do text[#text + 1] = ("%a %a %a"):format(image:pixel(x, y, "albedo")) end end
    return table.concat(text, ",")
  end
  local want, flat = bytes { uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } } }, { 0, 0, 1, 0, 1, 1, 0, 1 }
  check(bytes { uv = corners } == want, "one a corner")
  check(bytes { uv = flat } == want, "a flat table")
  for format, letter in pairs { f32 = "f", f64 = "d" } do
    check(bytes { uv = string.pack("<" .. letter:rep(8), table.unpack(flat)), format = format } == want, "%s", format)
  end
end

function tests.files_have_vt()
  local head = "v -2 -1 0\nv 2 -1 0\nv 2 1 0\nv -2 1 0\nvn 0 0 1\nvt 0 0 0.5\nvt 1\nvt 1 1 # the third\nvt 0 1\n"
  local material = glint.material { diffuse = UV }
  local want = scene_of(quad { uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, material = material }):render(PASSES)
  for _, faces in ipairs { "f 1/1 2/2 3/3 4/4\n", "f 1/1/1 2/2/1 3/3/1 4/4/1\n", "f -4/-4 -3/-3 -2/-2 -1/-1\n" } do
    with_file(head .. faces, function(name)
      local got = scene_of(glint.mesh { file = name, shading = "faceted", material = material }):render(PASSES)
      for _, x in ipairs { 12, 20, 29 } do
        local a, b = { want:pixel(x, 14, "albedo") }, { got:pixel(x, 14, "albedo") }
        check(a[1] == b[1] and a[2] == b[2] and a[1] > 0, "%s at %d", faces, x)
      end
    end)
  end
  with_file(head .. "f 1/1 2/2 3/5\n", function(name)
    raises(":10: a texture coordinate number 1 .. 4 expected, got '5'", glint.mesh, { file = name })
  end)
  with_file(head .. "f 1/x 2/2 3/5\n", function(name) raises("v/vt/vn expected", glint.mesh, { file = name }) end)
  with_file(head .. "vt a b\nf 1 2 3\n", function(name) raises(":10: a number expected, got 'a b'", glint.mesh, { file = name }) end)
  with_file(head .. "f 1/1 2/2 3/3\nf 1 3/3 4/4\n", function(name)
    local mesh = glint.mesh { file = name, name = "patchy", material = material }
    raises("s.uv: mesh 'patchy': faces[2] has no texture coordinates (vt)", function() scene_of(mesh):render(PASSES) end)
    mesh.material = glint.material {}
    check(scene_of(mesh):render(PASSES), "which is no matter where nothing reads them")
  end)
  with_file("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 3/3\n", function(name)
    check(glint.mesh { file = name }, "numbers of vt in a file that has none are ignored")
  end)
end

function tests.errors_name_the_field()
  raises("mesh.uv: one per vertex (4) or one per corner of a face (4) expected, got 3", quad, { uv = { { 0, 0 }, { 1, 0 }, { 1, 1 } } })
  raises("mesh.uv[2]: {u, v} expected", quad, { uv = { { 0, 0 }, { 1 }, { 1, 1 }, { 0, 1 } } })
  raises("mesh.uv[2]: {u, v} expected", quad, { uv = { { 0, 0 }, { 1, "0" }, { 1, 1 }, { 0, 1 } } })
  raises("mesh.uv: 2 numbers each expected, got 7 numbers", quad, { uv = { 0, 0, 1, 0, 1, 1, 0 } })
  raises("mesh.uv[3]: two finite numbers expected, got {1, inf}", quad, { uv = { { 0, 0 }, { 1, 0 }, { 1, math.huge }, { 0, 1 } } })
  raises("mesh.uv: list of {u, v}, array of such rows, flat table or packed string expected, got 3", quad, { uv = 3 })
  raises("mesh.uv: 16 bytes each (u, v in f64) expected, got 3 bytes", quad, { uv = "abc", format = "f64" })
  raises("mesh: file or uv expected, got both", glint.mesh, { file = "x.obj", uv = { 0, 0 } })
  for _, fields in ipairs { { diffuse = UV }, { bump = glint.pattern(function(_, s) return s.uv.u end) } } do
    local mesh = quad { name = "bare", material = glint.material(fields) }
    raises("s.uv: mesh 'bare' has no texture coordinates; set its uv, or add vt to its file",
      function() scene_of(mesh):render(PASSES) end)
  end
end

-- If all corners of a face agree, all its points have that exact value. No point leaves the range of the corners.
function tests.rounding_stays_within_the_corners()
  local level = glint.pattern(function(_, s) return { glint.equal(s.uv.u, 0.3), glint.lesseq(s.uv.v, 0.7), glint.lesseq(0.1, s.uv.v) } end)
  local vertices, faces, uv, n = {}, {}, {}, 12
  for j = 0, n do
    for i = 0, n do vertices[#vertices + 1] = { -2 + 4 * i / n, -1.3 + 2.6 * j / n, 0.3 * math.sin(i) * math.cos(j) } end
  end
  for j = 0, n - 1 do
    for i = 0, n - 1 do
      local a = j * (n + 1) + i + 1
      faces[#faces + 1], faces[#faces + 2] = { a, a + 1, a + n + 2 }, { a, a + n + 2, a + n + 1 }
      for _, v in ipairs { 0.1, 0.1, 0.7, 0.1, 0.7, 0.7 } do uv[#uv + 1] = { 0.3, v } end
    end
  end
  local scene = scene_of(glint.mesh { vertices = vertices, faces = faces, uv = uv, material = glint.material { diffuse = level } })
  local image = scene:render(PASSES)
  local count = each_hit(scene, function(x, y)
    local a, b, c = image:pixel(x, y, "albedo")
    check(a == 1 and b == 1 and c == 1, "at %d, %d", x, y)
  end)
  check(count > 300, "%d pixels", count)
end

-- The footprint of a pixel in uv uses the faster growing one of u and v: here v, half as wide as in the world.
function tests.the_footprint_is_that_of_the_steeper_one()
  local ratio = glint.pattern(function(_, s) return s.uv_footprint / s.footprint end)
  local scene = scene_of(quad { uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, material = glint.material { diffuse = ratio } })
  near((scene:render(PASSES):pixel(20, 15, "albedo")), 0.5, 1e-6, "footprint")
end

-- ---- Pictures that are not square ------------------------------------------------------------------------------

-- A texture of w x h texels, lit(x, y) from the top left.
local function picture(w, h, lit)
  local name, texels = os.tmpname(), {}
  for y = h - 1, 0, -1 do
    for x = 0, w - 1 do texels[#texels + 1] = ("<f"):pack(lit(x, y)) end
  end
  local file = assert(io.open(name .. ".pfm", "wb"))
  file:write(("Pf\n%d %d\n-1.0\n"):format(w, h), table.concat(texels))
  file:close()
  local texture = glint.texture { file = name .. ".pfm" }
  os.remove(name)
  os.remove(name .. ".pfm")
  return texture
end

-- A picture over W x H world units, with `across` and `down` pixels, and several samples a pixel.
local function front_of(texture, W, H, across, down, samples)
  local mesh = quad { vertices = { { 0, 0, 0 }, { W, 0, 0 }, { W, H, 0 }, { 0, H, 0 } },
    uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, material = glint.material { diffuse = texture } }
  local camera = glint.camera { eye = { W / 2, H / 2, 5 }, at = { W / 2, H / 2, 0 }, projection = "orthographic", height = H }
  return glint.scene { camera = camera, ambient = 1, mesh }:render { width = across, height = down, samples = samples, output = "none" }
end

-- One white texel has the same peak in each shape of picture: at one pixel a texel it is the texel, at four pixels a texel the nearest pixel
-- centre is an eighth of a texel away on each axis, and bilinear filtering gives (7/8)^2.
function tests.a_texel_keeps_its_peak()
  for _, size in ipairs { { 8, 8 }, { 16, 8 }, { 64, 8 }, { 8, 64 }, { 24, 5 } } do
    local w, h = size[1], size[2]
    local dot = picture(w, h, function(x, y) return x == w // 2 and y == h // 2 and 1 or 0 end)
    for scale, want in pairs { [1] = 1, [4] = 49 / 64 } do
      local image, most = front_of(dot, w, h, w * scale, h * scale), 0
      for y = 0, h * scale - 1 do
        for x = 0, w * scale - 1 do most = math.max(most, (image:pixel(x, y))) end
      end
      near(most, want, 1e-6, ("the peak of %d x %d at %d pixels a texel"):format(w, h, scale))
    end
  end
end

-- Texels that are not square: a pixel covers several of them along one axis. The mean of 256 samples of the picture at full size is the witness.
function tests.each_axis_has_its_own_filter()
  math.randomseed(3)
  for _, case in ipairs { { 64, 8, 8, 8 }, { 8, 64, 8, 8 }, { 64, 8, 16, 16 }, { 96, 8, 8, 32 }, { 12, 48, 24, 12 } } do
    local w, h, across, down = table.unpack(case)
    local values = {}
    for i = 0, w * h - 1 do values[i] = math.random() end
    local noise = picture(w, h, function(x, y) return values[y * w + x] end)
    local got, sum, most = front_of(noise, 1, 1, across, down), 0, 0
    local uv = glint.pattern(function(_, s) return noise(s.uv) end) -- without a footprint
    local want = front_of(uv, 1, 1, across, down, 256)
    for y = 0, down - 1 do
      for x = 0, across - 1 do
        local off = math.abs((got:pixel(x, y)) - (want:pixel(x, y)))
        sum, most = sum + off / (across * down), math.max(most, off)
      end
    end
    check(sum < 0.05 and most < 0.25, "%d x %d on %d x %d pixels: off by %.3f, at most %.3f", w, h, across, down, sum, most)
  end
end

-- A map of stripes, twice as wide as high, has the same contrast on a ball as the mean of 256 samples has.
function tests.a_map_on_a_ball()
  local w, h = 128, 64
  for what, lit in pairs { meridians = function(x) return x % 2 end, circles = function(_, y) return y % 2 end } do
    local map = picture(w, h, lit)
    local plain = glint.pattern(function(_, s) return map(s.uv) end)
    local function contrast(diffuse, samples)
      -- 1.5 pixels a texel at the middle: half a turn is 64 texels over pi radii
      local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 }, projection = "orthographic", height = 0.5 },
        ambient = 1, glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { diffuse = diffuse } } }
      local side = math.floor(0.5 * 1.5 * 64 / math.pi + 0.5)
      local image, low, high = scene:render { width = side, height = side, samples = samples, output = "none" }, 1, 0
      for y = side // 2 - 4, side // 2 + 4 do
        for x = side // 2 - 4, side // 2 + 4 do
          local v = image:pixel(x, y)
          low, high = math.min(low, v), math.max(high, v)
        end
      end
      return high - low
    end
    local want, got = contrast(plain, 256), contrast(map)
    check(want > 0.5 and got > want - 0.02, "%s: contrast %.3f, and %.3f of 256 samples", what, got, want)
  end
end

-- A picture on a quad, seen from the front, looks like the picture: upright and not mirrored.
function tests.a_texture_lies_on_a_mesh()
  local name = os.tmpname() .. ".png"
  local camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 }, projection = "orthographic", height = 2 }
  local function front(diffuse)
    local mesh = quad { vertices = { { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 } },
      uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, material = glint.material { diffuse = diffuse } }
    return glint.scene { camera = camera, ambient = 1, mesh }:render { width = 8, height = 8 }
  end
  local drawn = front(glint.pattern(function(p) return { (p.x + 1) / 2, (p.y + 1) / 2, glint.parity(p.x * 4, p.y * 4, 0) } end))
  drawn:save(name)
  for _, filter in ipairs { "nearest", "bilinear" } do
    local shown = front(glint.texture { file = name, wrap = "clamp", filter = filter })
    for _, at in ipairs { { 1, 1 }, { 6, 1 }, { 1, 6 }, { 5, 2 } } do
      local a, b = { drawn:pixel(at[1], at[2]) }, { shown:pixel(at[1], at[2]) }
      for c = 1, 3 do near(b[c], a[c], 0.006, ("%s at %d, %d"):format(filter, at[1], at[2])) end
    end
  end
  os.remove(name)
end

function tests.mirrors_and_shadows_see_them()
  local clear = glint.pattern(function(_, s) return { s.uv.u, s.uv.v, 0 } end)
  local pane = quad { uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } },
    material = glint.material { diffuse = 0, transmission = clear, ior = 1 } }
  local scene = glint.scene { camera = glint.camera { eye = { 0, 3, 4 }, at = { 0, 0, -3 } },
    glint.directional_light { direction = { 0, 0, -1 } }, pane,
    glint.plane { point = { 0, 0, -3 }, normal = { 0, 0, 1 }, material = glint.material { diffuse = 1 } } }
  local image, seen = scene:render { width = 40, height = 30, passes = "beauty,diffuse" }, 0
  local w = glint.unit { 0, 3, 7 }
  local u, v, half = glint.vector { 1, 0, 0 }, glint.vector { 0, w.z, -w.y }, math.tan(math.rad(scene.camera.fov / 2))
  for y = 0, 29 do
    for x = 0, 39 do
      local d = u * ((x + 0.5 - 20) / 15 * half) + v * ((15 - y - 0.5) / 15 * half) - w
      local hit = scene:cast({ 0, 3, 4 }, d)
      local p = hit and hit.object ~= pane and hit.point
      if p and math.abs(p.x) < 1.99 and math.abs(p.y) < 0.99 then
        local r, g, b = image:pixel(x, y, "diffuse")
        near(r, (p.x + 2) / 4, 2e-6, "red light") near(g, (p.y + 1) / 2, 2e-6, "green light") check(b == 0)
        seen = seen + 1
      end
    end
  end
  check(seen > 20, "%d pixels of the shadow", seen)
end

-- ---- Bumps ----

-- Calls f with the cosine of the angle between the normals with and without the bump, at each pixel.
local function each_tilt(make, bump, f)
  local plain, bumped = scene_of(make(glint.material {})), scene_of(make(glint.material { bump = bump }))
  local a, b = plain:render(PASSES), bumped:render(PASSES)
  return each_hit(plain, function(x, y, hit)
    local n, m = glint.vector { a:pixel(x, y, "normal") }, glint.vector { b:pixel(x, y, "normal") }
    f(n:dot(m), n, m, hit)
  end)
end

-- A height of a u or a v has the closed-form slope everywhere.
function tests.bumps_follow_the_surface()
  local TURN <const>, a <const> = 2 * math.pi, 0.7
  local cases = {
    { "u", a, function(m) return glint.plane { point = { 0, 0, 0 }, normal = { 0.2, 0.3, 1 }, material = m } end },
    { "v", a, function(m) return glint.disk { center = { 0, 0, 0 }, normal = { 0.2, 0.3, 1 }, radius = 2, material = m } end },
    { "u", a / 4, function(m) return glint.box { min = { -2, -1, -1 }, max = { 2, 1, 0 }, material = m } end, { 0, 0, 1 } },
    { "v", a / 2, function(m) return glint.box { min = { -2, -1, -1 }, max = { 2, 1, 0 }, material = m } end, { 0, 0, 1 } },
    { "v", a / (1.5 * TURN / 2), function(m) return glint.sphere { center = { 0, 0, 0 }, radius = 1.5, material = m } end },
    { "u", a / (1.5 * TURN), function(m)
      return glint.cylinder { base = { -2, 0, 0 }, top = { 2, 0.5, 0 }, radius = 1.5, capped = false, material = m }
    end },
    { "u", a / 4, function(m) return quad { uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, material = m } end },
    { "v", a / 2, function(m) return quad { uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, material = m } end },
    { "v", a / 4, function(m)
      return quad { uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, transform = glint.rotate("x", 20) * glint.scale(1, 2, 1), material = m }
    end },
  }
  for i, case in ipairs(cases) do
    local bump = glint.pattern(function(_, s) return a * s.uv[case[1]] end)
    local count = each_tilt(case[3], bump, function(cosine, n)
      if not case[4] or n:dot(case[4]) > 0.99 then near(cosine, 1 / math.sqrt(1 + case[2] ^ 2), 1e-6, "case " .. i) end
    end)
    check(count > 150, "case %d: %d pixels", i, count)
  end
end

-- On a ball the slope in u grows towards the poles. A height in u and v equals the same height computed from the point.
function tests.a_bump_by_uv_is_one_by_the_point()
  local function ball(m) return glint.sphere { center = { 0, 0, 0 }, radius = 1.5, material = m } end
  local by_uv = glint.pattern(function(_, s) return 0.1 * glint.sin(40 * s.uv.v) + 0.3 * s.uv.u end)
  local by_point = glint.pattern(function(p)
    local r = glint.sqrt(p.x * p.x + p.y * p.y + p.z * p.z)
    return 0.1 * glint.sin(40 / math.pi * glint.acos(-p.y / r)) + 0.3 / (2 * math.pi) * glint.atan2(p.x, p.z)
  end)
  local a, b = scene_of(ball(glint.material { bump = by_uv })), scene_of(ball(glint.material { bump = by_point }))
  local first, second = a:render(PASSES), b:render(PASSES)
  local count = each_hit(a, function(x, y)
    local n, m = { first:pixel(x, y, "normal") }, { second:pixel(x, y, "normal") }
    for c = 1, 3 do near(n[c], m[c], 2e-6, "normal") end
  end)
  check(count > 150, "%d pixels", count)
end

-- A bump from a texture against differences of its own values.
function tests.bumps_by_texture()
  local name = os.tmpname() .. ".png"
  glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 }, projection = "orthographic", height = 2 }, ambient = 1,
    quad { material = glint.material { diffuse = glint.pattern(function(p) return 0.5 + 0.4 * glint.sin(2 * p.x) * glint.cos(3 * p.y) end) } },
  }:render { width = 16, height = 8 }:save(name)
  local photo = glint.texture { file = name, wrap = "clamp" }
  local bump = glint.pattern(function(_, s) return 0.5 * photo(s.uv).r end)
  local function height(u, v) return 0.5 * photo:evaluate { uv = { u, v } }.x end
  local seen = 0
  each_tilt(function(m) return quad { uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, material = m } end, bump, function(_, _, m, hit)
    local u, v, step = (hit.point.x + 2) / 4, (hit.point.y + 1) / 2, 1e-5
    local x, y = (u * 16 - 0.5) % 1, (v * 8 - 0.5) % 1
    if x < 0.01 or x > 0.99 or y < 0.01 or y > 0.99 or u < 0.04 or u > 0.96 or v < 0.07 or v > 0.93 then return end
    local want = glint.unit { -(height(u + step, v) - height(u - step, v)) / (2 * step) / 4,
      -(height(u, v + step) - height(u, v - step)) / (2 * step) / 2, 1 }
    for c = 1, 3 do near(m[c], want[c], 1e-6, "normal") end
    seen = seen + 1
  end)
  check(seen > 150, "%d pixels", seen)
  os.remove(name)
end

-- A footprint for each axis: stripes along v keep their values whatever the width along v, and become grey along u.
function tests.two_footprints()
  local photo = picture(8, 8, function(x) return (x + 1) % 2 end)
  local function look(u, v, ...)
    local widths = { ... }
    return glint.pattern(function(_, s) return photo(s.uv, table.unpack(widths)) end):evaluate { uv = { u, v } }.x
  end
  for x = 0, 7 do
    local u, stripe = (x + 0.5) / 8, (x + 1) % 2
    near(look(u, 0.4), stripe, 1e-6, "no footprint")
    near(look(u, 0.4, 0, 0.5), stripe, 1e-6, "wide along v")
    near(look(u, 0.4, 0.25, 0), 0.5, 0.05, "wide along u")
    near(look(u, 0.4, 0.25), 0.5, 0.05, "wide along both")
    check(look(u, 0.4, 0.25) == look(u, 0.4, 0.25, 0.25), "one width is both")
  end
  raises("expected u, v and one or two footprints", function() photo(0.5, 0.5, 0, 0, 0) end)
end

tally.run(tests)
tally.finish()
