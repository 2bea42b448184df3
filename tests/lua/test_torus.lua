-- glint.torus: hits of rays, self-shadowing, coordinates, and refused values.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local ROUNDING <const> = 1e-14
local tests = {}

local raises = tally.raises

local function ring(fields)
  local given = { center = { 0, 0, 0 }, major = 2, minor = 0.5 }
  for name, value in pairs(fields or {}) do given[name] = value end
  return glint.torus(given)
end

-- Compares hits of rays on the torus of radii 2 and 0.5 around the y axis, and the normals there.
function tests.what_rays_meet()
  local scene = glint.scene { ring() }
  local cases = { -- origin, direction, t, normal
    { { 5, 0, 0 }, { -1, 0, 0 }, 2.5, { 1, 0, 0 } }, -- hits the outside of the ring
    { { 0, 0, 0 }, { 0, 0, 2 }, 0.75, { 0, 0, -1 } }, -- hits the inside of the ring
    { { 2, 0, 0 }, { 1, 0, 0 }, 0.5, { 1, 0, 0 } }, -- starts inside the tube
    { { 2, 4, 0 }, { 0, -1, 0 }, 3.5, { 0, 1, 0 } }, -- hits the top
    { { 0, 5, 0 }, { 0, -1, 0 } }, -- passes along the axis, through the hole
    { { 5, 0.5000001, 0 }, { -1, 0, 0 } }, -- passes just above the ring
    { { 1.6, 0.3, 9 }, { 0, 0, -1 }, 9 - math.sqrt(2.4 ^ 2 - 1.6 ^ 2), { 1.6 / 3, 0.6, math.sqrt(2.4 ^ 2 - 1.6 ^ 2) / 3 } },
    { { 2.6, 0, -9 }, { 0, 0, 1 } }, -- passes next to the ring
  }
  for i, case in ipairs(cases) do
    local hit = scene:cast(case[1], case[2])
    check((hit ~= nil) == (case[3] ~= nil), "case %d: %s", i, hit and "hit" or "miss")
    if hit and case[3] then
      near(hit.t, case[3], ROUNDING * 10, ("case %d: t"):format(i))
      for c = 1, 3 do
        local want = i == 7 and c == 1 and 1.6 / 2.4 * 0.8 or i == 7 and c == 3 and math.sqrt(2.4 ^ 2 - 1.6 ^ 2) / 2.4 * 0.8
          or i == 7 and 0.6 or case[4][c]
        near(hit.normal[c], want, ROUNDING * 10, ("case %d: normal %d"):format(i, c))
      end
    end
  end
end

-- Finds all surfaces on a line in turn: each search starts at the previous hit.
function tests.four_crossings()
  local scene = glint.scene { ring { axis = { 0, 0, 3 } } }
  local from, met = -5, {}
  for i = 1, 5 do
    local hit = scene:cast({ from, 0, 0 }, { 1, 0, 0 })
    met[i] = hit and from + hit.t
    if not hit then break end
    from = met[i] + 1e-9
  end
  check(#met == 4, "%d crossings", #met)
  for i, want in ipairs { -2.5, -1.5, 1.5, 2.5 } do near(met[i], want, 1e-8, "crossing " .. i) end
end

-- A transform moves a torus exactly as its own fields do. A stretched torus is hit as in its own space.
function tests.transforms()
  local own = glint.scene { ring { center = { 1, 2, 3 }, axis = { 0, 0, 1 }, major = 4, minor = 1 } }
  local moved = glint.scene { ring { transform = glint.translate(1, 2, 3) * glint.rotate("x", 90) * glint.scale(2) } }
  local plain, wide = glint.scene { ring() }, glint.scene { ring { transform = glint.scale(2, 1, 1) } }
  local hits = 0
  for k = 1, 400 do
    local a, b = k * 2.4, math.cos(k * 1.7)
    local o = { 8 * math.cos(a), 8 * b, 8 * math.sin(a) }
    local d = { -o[1] + 3 * math.sin(k), -o[2] + 3 * math.cos(3 * k), -o[3] + math.sin(5 * k) }
    local one, other = own:cast(o, d), moved:cast(o, d)
    check((one ~= nil) == (other ~= nil), "ray %d: met by one of two", k)
    if one and other then
      hits = hits + 1
      near(one.t, other.t, 1e-13, "t of ray " .. k)
      for c = 1, 3 do near(one.normal[c], other.normal[c], 1e-12, "normal of ray " .. k) end
    end
    local round, far = plain:cast(o, d), wide:cast({ 2 * o[1], o[2], o[3] }, { 2 * d[1], d[2], d[3] })
    check((round ~= nil) == (far ~= nil), "ray %d: met by one of two that are one", k)
    if round and far then near(round.t, far.t, 1e-13, "t of ray " .. k) end
  end
  check(hits > 100, "%d hits", hits)
end

-- A point is lit exactly if a ray from the light to the point hits nothing before the point.
function tests.shadows_of_itself()
  local lamp, eye = { 7, 0.8, 2 }, { 1.5, 3, 5 }
  local size = { width = 96, height = 64, passes = { "diffuse", "depth" } }
  for _, given in ipairs { {}, { minor = 1.7 }, { axis = { 1, 1, 0.2 } }, { minor = 0.05 }, { transform = glint.scale(1, 2, 0.7) } } do
    local scene = glint.scene { camera = glint.camera { eye = eye, at = { 0, 0, 0 }, fov = 50 },
      glint.point_light { position = lamp }, ring(given) }
    local image = scene:render(size)
    local w = (glint.vector(eye) - { 0, 0, 0 }):unit()
    local u = glint.cross({ 0, 1, 0 }, w):unit()
    local v, half, lit, own = w:cross(u), math.tan(math.rad(25)), 0, 0
    for y = 0, size.height - 1 do
      for x = 0, size.width - 1 do
        local d = u * ((x + 0.5 - 48) / 32 * half) + v * ((32 - y - 0.5) / 32 * half) - w
        local hit = scene:cast(eye, d)
        local away = hit and (glint.vector(lamp) - hit.point)
        local facing = hit and hit.normal:dot(away:unit())
        if hit and facing > 0.02 then
          local back = scene:cast(lamp, away * -1)
          local open = back and math.abs(back.t - 1) < 1e-9
          check((image:pixel(x, y, "diffuse") > 0) == open, "pixel %d, %d: lit %s", x, y, tostring(not open))
          lit, own = lit + (open and 1 or 0), own + (open and 0 or 1)
        end
      end
    end
    check(lit > 30 and own > (next(given) and -1 or 20), "%d lit, %d in the torus's own shadow", lit, own)
  end
end

-- Straight through glass of index 1 the background is visible through four surfaces, dimmed once per surface.
function tests.glass_is_crossed_four_times()
  local wall = glint.box { min = { -9, -9, -9 }, max = { 9, 9, -8 }, material = glint.material { ambient = 1, diffuse = 0 } }
  local glass = glint.material { diffuse = 0, transmission = 0.5, ior = 1 }
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 7 }, at = { 0, 0, 0 }, fov = 40 }, ambient = 1, wall,
    ring { material = glass } }
  local image = scene:render { width = 61, height = 61 }
  near(image:pixel(30, 30), 0.5 ^ 4, 1e-6, "through both sides of the ring")
  near(image:pixel(0, 0), 1, 1e-6, "past it")
  local on_end = glint.scene { camera = glint.camera { eye = { 0, 0, 7 }, at = { 0, 0, 0 }, fov = 40 }, ambient = 1, wall,
    ring { axis = { 0, 0, 1 }, material = glass } }
  near(on_end:render({ width = 61, height = 61 }):pixel(30, 30), 1, 1e-6, "through its hole")
end

-- A mirror reflects itself: the ray from the inside of the ring hits the opposite side.
function tests.a_mirror_shows_itself()
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 0 }, direction = { 1, 0, 0 }, fov = 1 }, background = 0.25, ambient = 1,
    ring { material = glint.material { ambient = 0.5, diffuse = 0, mirror = 0.5 } } }
  for depth, want in pairs { [0] = 0.5, [1] = 0.5 + 0.25, [2] = 0.5 + 0.5 * (0.5 + 0.25) } do
    near(scene:render({ width = 1, height = 1, max_depth = depth }):pixel(0, 0), want, 1e-6, depth .. " mirrors deep")
  end
end

-- u is around the axis, v around the tube: 0.5 outside, 0.75 at the top, with a seam inside.
function tests.coordinates()
  local UV <const> = glint.pattern(function(_, s) return { s.uv.u, s.uv.v, 0 } end)
  local material = glint.material { ambient = UV, diffuse = 0 }
  local function at(eye, to)
    local scene = glint.scene { camera = glint.camera { eye = eye, at = to, fov = 1e-3, up = { 0.1, 1, 0.2 } }, ambient = 1, ring { material = material } }
    return scene:render({ width = 1, height = 1 }):pixel(0, 0)
  end
  local u, v = at({ 6, 0, 0 }, { 0, 0, 0 })
  near(v, 0.5, 1e-5, "v outside")
  near(select(2, at({ 2, 3, 0 }, { 2, 0, 0 })), 0.75, 1e-5, "v on top")
  near(select(2, at({ 2, -3, 0 }, { 2, 0, 0 })), 0.25, 1e-5, "v below")
  near(select(2, at({ 0, 0.02, 0 }, { 2, 0.02, 0 })), 1, 0.02, "v inside, above the seam")
  near(select(2, at({ 0, -0.02, 0 }, { 2, -0.02, 0 })), 0, 0.02, "v inside, below it")
  local quarter = at({ 0, 0, 6 }, { 0, 0, 0 })
  near(math.abs(quarter - u) % 0.5, 0.25, 1e-5, "u a quarter on")
end

-- Close up: a height of v has the closed-form slope everywhere, except at the seam.
function tests.bumps_follow_the_tube()
  local size = { width = 40, height = 30, passes = { "normal" } }
  local function normals(material)
    return glint.scene { camera = glint.camera { eye = { 0, 4, 5 }, at = { 0, 0, 0 }, fov = 50 }, ring { material = material } }:render(size)
  end
  local slope = 0.1 / (2 * math.pi * 0.5)
  local plain = normals(glint.material {})
  local bumped = normals(glint.material { bump = glint.pattern(function(_, s) return 0.1 * s.uv.v end) })
  local count = 0
  for y = 0, 29 do
    for x = 0, 39 do
      local n, m = glint.vector { plain:pixel(x, y, "normal") }, glint.vector { bumped:pixel(x, y, "normal") }
      if n:length() > 0.5 then
        near(n:dot(m), 1 / math.sqrt(1 + slope ^ 2), 1e-6, ("pixel %d, %d"):format(x, y))
        count = count + 1
      end
    end
  end
  check(count > 150, "%d pixels", count)
end

function tests.fields()
  local t = ring()
  check(t.major == 2 and t.minor == 0.5 and t.axis.y == 1 and t.axis.x == 0, "its fields")
  t.x, t.axis, t.minor = 4, { 1, 1, 0 }, 1.999
  check(t.center.x == 4 and t.axis.x == 1 and t.minor == 1.999, "as changed")
  raises("torus.minor: number > 0 and below major (2) expected, got 2", function() t.minor = 2 end)
  raises("torus.minor: number > 0 and below major (2) expected, got 0", function() t.minor = 0 end)
  raises("torus.minor: finite number expected, got nan", function() t.minor = 0 / 0 end)
  raises("torus.major: finite number expected, got inf", function() t.major = 1 / 0 end)
  raises("torus.axis", function() t.axis = { 0, 0, 0 } end)
  raises("torus.axis", function() t.axis = { 0, 0 / 0, 1 } end)
  raises("torus.center", ring, { center = { 0, 1 / 0, 0 } })
  raises("torus.major: number > 0 expected, got 0", ring, { major = 0 })
  raises("torus.major", glint.torus, { center = { 0, 0, 0 }, minor = 1 })
  raises("'major'", ring, { mayor = 1 })
  raises("torus", function() return glint.donut end)
  check(t.minor == 1.999 and t.major == 2, "refused, and as it was")
end

tally.run(tests)
tally.finish()
