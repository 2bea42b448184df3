-- Ambient occlusion against closed forms: walls, a ball on the floor, a limited distance, panes of glass; which part
-- of the ambient light it affects; its fields and errors.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local ROUNDING = 2 ^ -22
local SAMPLES = 16384
local NOISE = 0.002 -- allowed error for this many samples: half of the error of random sampling

local raises = tally.raises

local matt = glint.material { diffuse = 1 }
local function floor(material) return glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = material or matt } end

-- Renders a scene from very close, looking straight down at the point x, 0, z.
local function at(x, z, fields, more)
  fields.camera = glint.camera { eye = { x, 1e-3, z }, direction = { 0, -1, 0 }, up = { 0, 0, 1 }, fov = 1 }
  fields.ambient = fields.ambient or 1
  if fields.ambient_occlusion == nil then fields.ambient_occlusion = { samples = SAMPLES } end
  local options = { width = 1, height = 1, output = "none", passes = "beauty,ambient,diffuse,indirect,mirror" }
  for name, value in pairs(more or {}) do options[name] = value end
  return glint.scene(fields):render(options)
end
local function open_at(x, z, ...) return (at(x, z, ...):pixel(0, 0)) end

local tests = {}

function tests.all_and_nothing()
  for _, precision in ipairs { "double", "float" } do
    local image = at(0, 0, { ambient = { 0.5, 1, 0.25 }, background = { 3, 5, 7 }, ambient_occlusion = {}, floor() }, { precision = precision })
    local r, g, b = image:pixel(0, 0)
    near(r, 0.5, ROUNDING, "open sky") near(g, 1, ROUNDING, "open sky") near(b, 0.25, ROUNDING, "open sky")
    check(image:pixel(0, 0, "ambient") == 0 and image:pixel(0, 0, "indirect") == r, "its pass")
    check(open_at(0, 0, { floor(), glint.sphere { center = { 0, 0, 0 }, radius = 9 } }, { precision = precision }) == 0, "a closed one")
  end
  check(open_at(0, 0, { ambient = 0, floor() }) == 0, "no ambient light")
  local lit = at(0, 0, { ambient = 0, floor(), glint.point_light { position = { 0, 5, 0 }, ambient = 0.25 } })
  near(lit:pixel(0, 0, "indirect"), 0.25, ROUNDING, "the lights' own ambient light")
  near(lit:pixel(0, 0, "diffuse"), 1, ROUNDING, "beside their light")
end

-- Next to an infinite wall half of the sky is visible; next to one of height h, (1 + d / sqrt(d^2 + h^2)) / 2.
function tests.walls()
  local half_space = glint.plane { point = { 0, 0, 0 }, normal = { 1, 0, 0 }, material = matt }
  for _, d in ipairs { 0.01, 1, 100 } do near(open_at(d, 0, { floor(), half_space }), 0.5, NOISE, "a wall, " .. d) end
  local wall = glint.box { min = { -1, -1, -1e6 }, max = { 0, 2, 1e6 }, material = matt }
  for _, d in ipairs { 0.1, 1, 4 } do
    near(open_at(d, 0, { floor(), wall }), (1 + d / math.sqrt(d * d + 4)) / 2, NOISE, "a wall of height 2, " .. d)
  end
end

-- A ball on the floor: 1 - (r / D)^3, D to the ball's centre. A ball above the point: 1 - (r / height)^2.
function tests.balls()
  local ball = glint.sphere { center = { 0, 1, 0 }, radius = 1, material = matt }
  for _, x in ipairs { 0.4, 1, 2.5 } do
    near(open_at(x, 0, { floor(), ball }), 1 - (1 + x * x) ^ -1.5, NOISE, "a ball at rest, " .. x)
    near(open_at(x, 0, { floor(), ball }, { precision = "float" }), 1 - (1 + x * x) ^ -1.5, NOISE, "in float")
  end
  ball.center = { 0, 2.5, 0 }
  near(open_at(0, 0, { floor(), ball }), 1 - 1 / 2.5 ^ 2, NOISE, "a ball above")
end

-- For an infinite wall at distance d, the part within L: the part of the unit disk beyond c = d / L.
function tests.distance()
  local half_space = glint.plane { point = { 0, 0, 0 }, normal = { 1, 0, 0 }, material = matt }
  for _, c in ipairs { 0.1, 0.5, 0.9 } do
    local closed = (math.acos(c) - c * math.sqrt(1 - c * c)) / math.pi
    for _, precision in ipairs { "double", "float" } do
      local image = at(3 * c, 0, { floor(), half_space, ambient_occlusion = { samples = SAMPLES, distance = 3 } }, { precision = precision })
      near(image:pixel(0, 0), 1 - closed, NOISE, "within 3, c = " .. c)
    end
  end
  near(open_at(3, 0, { floor(), half_space, ambient_occlusion = { distance = 2.9 } }), 1, ROUNDING, "nothing so near")
  local holes = glint.plane { point = { 0, 0, 0 }, normal = { 1, 0, 0 }, material = glint.material { opacity = 0 } }
  near(open_at(1, 0, { floor(), holes }), 1, ROUNDING, "what is not there closes nothing")
  local half_holes = glint.material { opacity = glint.pattern(function(p) return glint.select(glint.less(p.y, 1), 1, 0) end) }
  holes.material = half_holes
  near(open_at(1, 0, { floor(), holes }), (1 + 1 / math.sqrt(2)) / 2, NOISE, "a wall whose upper part is cut out")
  near(open_at(1, 0, { floor(), holes, ambient_occlusion = { samples = SAMPLES, distance = 0.9 } }), 1, ROUNDING, "and far")
end

-- Non-refracting glass tints once per pane. An opaque wall behind it occludes.
function tests.glass()
  local function pane(y, transmission)
    return glint.plane { point = { 0, y, 0 }, normal = { 0, 1, 0 },
      material = glint.material { diffuse = 0, transmission = transmission or { 0.5, 0.8, 0.2 }, ior = 1 } }
  end
  local r, g, b = at(0, 0, { floor(), pane(1) }):pixel(0, 0)
  near(r, 0.5, ROUNDING, "red") near(g, 0.8, ROUNDING, "green") near(b, 0.2, ROUNDING, "blue")
  r, g, b = at(0, 0, { floor(), pane(1), pane(2) }):pixel(0, 0)
  near(r, 0.25, ROUNDING, "two panes") near(g, 0.64, ROUNDING, "green") near(b, 0.04, ROUNDING, "blue")
  local half_space = glint.plane { point = { 0, 0, 0 }, normal = { 1, 0, 0 }, material = matt }
  near(open_at(1, 0, { floor(), pane(0.5), half_space }), 0.25, NOISE, "a wall beyond")
  check(open_at(0, 0, { floor(), pane(1) }, { max_depth = 0 }) == 0, "no deeper than max_depth")
  local halves = pane(1, glint.pattern(function(p) return glint.select(glint.less(p.x, 0), 1, { 0.5, 0.25, 0 }) end))
  r, g, b = at(0, 0, { floor(), halves }):pixel(0, 0)
  near(r, 0.75, NOISE, "a painted pane") near(g, 0.625, NOISE, "green") near(b, 0.5, NOISE, "blue")
  r, g, b = at(0, 0, { floor(), halves, pane(2) }):pixel(0, 0)
  near(r, 0.375, NOISE, "and a plain one") near(g, 0.5, NOISE, "green") near(b, 0.1, NOISE, "blue")
end

-- Occlusion applies to min(ka, kd) Ia. The excess of `ambient` is the surface's emission.
function tests.materials()
  local half_space = glint.plane { point = { 0, 0, 0 }, normal = { 1, 0, 0 }, material = matt }
  local image = at(1, 0, { ambient = 0.5, floor(glint.material { diffuse = { 0.8, 0.4, 0.6 }, ambient = { 0.3, 1, 0.6 } }), half_space })
  local r, g, b = image:pixel(0, 0, "indirect")
  near(r, 0.075, NOISE, "of less ambient") near(g, 0.1, NOISE, "of more") near(b, 0.15, NOISE, "of the same")
  r, g, b = image:pixel(0, 0, "ambient")
  near(r, 0, ROUNDING, "nothing") near(g, 0.3, ROUNDING, "its own") near(b, 0, ROUNDING, "nothing")
  local painted = glint.material { diffuse = glint.pattern(function(p) return { 0.5, p.x * 0.25, 0.125 } end) }
  r, g, b = at(1, 0, { floor(painted), half_space }):pixel(0, 0)
  near(r, 0.25, NOISE, "of a pattern") near(g, 0.125, NOISE, "green") near(b, 0.0625, NOISE, "blue")
  check(open_at(1, 0, { floor(glint.material { diffuse = 0.5, ambient = 0 }) }) == 0, "no ambient light of the material")
end

-- Occlusion also applies in a mirror.
function tests.mirror()
  local mirror = glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0, mirror = 0.5 } }
  local ceiling = glint.plane { point = { 0, 4, 0 }, normal = { 0, -1, 0 }, material = matt }
  local image = at(0, 0, { mirror, ceiling })
  near(image:pixel(0, 0), 0, ROUNDING, "the mirror closes all of the ceiling's sky")
  local disk = glint.disk { center = { 0, 4, 0 }, normal = { 0, -1, 0 }, radius = 1, material = matt }
  mirror = glint.disk { center = { 0, 0, 0 }, normal = { 0, 1, 0 }, radius = 1, material = mirror.material }
  near(open_at(0, 0, { mirror, disk }), 0.5 * (1 - 1 / (1 + 16)), NOISE, "a disk of radius 1, at 4: 1 - 1 / 17 of the sky")
end

-- Any number of threads, with or without reuse, gives the same pixels. A region equals that part of the picture.
function tests.ways()
  local ball = glint.sphere { center = { 0, 1, 0 }, radius = 1 }
  local scene = glint.scene { camera = glint.camera { eye = { 0, 3, 8 }, at = { 0, 1, 0 } }, ambient = 1, floor(), ball,
    glint.ambient_occlusion { samples = 3, distance = 5 } }
  local function render(more)
    local options = { width = 70, height = 50, samples = 2, output = "none", passes = "beauty" }
    for name, value in pairs(more or {}) do options[name] = value end
    return scene:render(options)
  end
  local whole = render()
  for _ = 1, 3 do
    local again, part = render(), render { region = { 30, 20, 9, 9 } }
    for i = 0, 8 do
      check(again:pixel(30 + i, 20 + i) == whole:pixel(30 + i, 20 + i), "again")
      check(part:pixel(i, i) == whole:pixel(30 + i, 20 + i), "a part")
    end
  end
  ball.x = 0.5
  local moved = render()
  ball.x = 0
  local back = render()
  local same, other = 0, 0
  for y = 0, 49 do
    for x = 0, 69 do
      same = same + (back:pixel(x, y) == whole:pixel(x, y) and 1 or 0)
      other = other + (moved:pixel(x, y) ~= whole:pixel(x, y) and 1 or 0)
    end
  end
  check(same == 3500 and other > 100, "a ball that moved and came back: %d, %d", same, other)
end

function tests.fields()
  local scene = glint.scene { floor() }
  check(scene.ambient_occlusion == nil, "off")
  scene.ambient_occlusion = {}
  check(scene.ambient_occlusion.samples == 16 and scene.ambient_occlusion.distance == math.huge, "defaults")
  raises("ambient_occlusion: assign a whole table", function() scene.ambient_occlusion.samples = 4 end)
  scene.ambient_occlusion = nil
  local some = glint.ambient_occlusion { samples = 4, distance = 2 }
  check(some.samples == 4 and some.distance == 2, "as a value")
  scene:add(some)
  check(scene.ambient_occlusion.samples == 4 and scene.ambient_occlusion.distance == 2, "added")
  scene:remove(some)
  check(scene.ambient_occlusion == nil, "removed")
  check(glint.scene { floor(), some }.ambient_occlusion.samples == 4, "among the objects")
  check(glint.scene { floor(), ambient_occlusion = some }.ambient_occlusion.distance == 2, "as the field")
  raises("ambient_occlusion.samples: whole number 1 .. 65536 expected, got 0", glint.ambient_occlusion, { samples = 0 })
  raises("ambient_occlusion.samples: whole number 1 .. 65536 expected, got 1.5", glint.ambient_occlusion, { samples = 1.5 })
  raises("ambient_occlusion.distance: number > 0 expected, got 0", glint.ambient_occlusion, { distance = 0 })
  raises("ambient_occlusion.distance: number > 0 expected, got -nan", glint.ambient_occlusion, { distance = 0 / 0 })
  raises("ambient_occlusion.distance: number expected, got string \"far\"", glint.ambient_occlusion, { distance = "far" })
  raises("ambient_occlusion.sample: no such field; did you mean 'samples'?", glint.ambient_occlusion, { sample = 4 })
  raises("ambient_occlusion: table expected, got nil", glint.ambient_occlusion)
  raises("scene.ambient_occlusion: either this or indirect expected", glint.scene, { ambient_occlusion = {}, indirect = {} })
  raises("scene.ambient_occlusion.samples: whole number", function() scene.ambient_occlusion = { samples = -1 } end)
end

tally.run(tests)
tally.finish()
