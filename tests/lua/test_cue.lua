-- Depth cueing: every term by its formula, for every sample; unaffected passes; wrong values.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local raises = tally.raises

local terms = { "ambient", "diffuse", "specular", "mirror", "transmission" }
local passes = "beauty,background,depth,alpha," .. table.concat(terms, ",")

local function make(projection, opaque)
  local mirror = glint.material { diffuse = { 0.3, 0.4, 0.5 }, specular = 0.5, mirror = 0.3 }
  local glass = glint.material { diffuse = 0.1, transmission = opaque and 0 or 0.6, ior = 1.3 }
  return glint.scene {
    camera = glint.camera { eye = { 1, 2, 9 }, at = { 0, 0, 0 }, projection = projection, height = 8 },
    ambient = 0.2, background = { 0.2, 0.5, 0.8 },
    glint.point_light { position = { 5, 8, 6 } },
    glint.plane { point = { 0, -1.5, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = { 0.8, 0.7, 0.6 } } },
    glint.sphere { center = { -1.5, 0, 0 }, radius = 1.5, material = mirror },
    glint.sphere { center = { 1.7, 0, 1 }, radius = 1.2, material = glass },
    glint.disk_light { position = { 0, 4, -6 }, normal = { 0, -1, 1 }, radius = 1.5, samples = 4, visible = true },
  }
end

local function render(scene, options)
  options = options or {}
  options.width, options.height, options.output, options.passes = 48, 36, "none", passes
  return scene:render(options)
end

local function sum(image, x, y)
  local all = { image:pixel(x, y, "background") }
  for _, term in ipairs(terms) do
    local part = { image:pixel(x, y, term) }
    for c = 1, 3 do all[c] = string.unpack("f", string.pack("f", all[c] + part[c])) end
  end
  return all
end

-- One sample: compares with the formula, applied to the picture without depth cueing.
local near, far, color = 8, 14, { 0.9, 0.1, 0.3 }
for _, projection in ipairs { "perspective", "orthographic" } do
  for _, precision in ipairs { "double", "float" } do
    local scene = make(projection)
    local plain = render(scene, { precision = precision })
    scene.depth_cue = { color = color, near = near, far = far }
    local cued = render(scene, { precision = precision })
    local worst, partly, exact = 0, 0, true
    for y = 0, 35 do
      for x = 0, 47 do
        local depth = plain:pixel(x, y, "depth")
        local f = depth < math.huge and math.max(0, math.min(1, (depth - near) / (far - near))) or 0
        partly = partly + (f > 0 and f < 1 and 1 or 0)
        local behind, there = { plain:pixel(x, y, "background") }, { cued:pixel(x, y, "background") }
        for c = 1, 3 do worst = math.max(worst, math.abs(there[c] - (behind[c] * (1 - f) + f * color[c]))) end
        for _, term in ipairs(terms) do
          local before, after = { plain:pixel(x, y, term) }, { cued:pixel(x, y, term) }
          for c = 1, 3 do worst = math.max(worst, math.abs(after[c] - before[c] * (1 - f))) end
        end
        local whole, beauty = sum(cued, x, y), { cued:pixel(x, y) }
        for c = 1, 3 do exact = exact and whole[c] == beauty[c] end
        exact = exact and cued:pixel(x, y, "depth") == depth and cued:pixel(x, y, "alpha") == plain:pixel(x, y, "alpha")
      end
    end
    check(worst < 2e-6, "%s, %s: off by %g", projection, precision, worst)
    check(partly > 300, "%s, %s: %d pixels fade", projection, precision, partly)
    check(exact, "%s, %s: passes sum to the picture; depth and alpha are left alone", projection, precision)
  end
end

-- Several samples: each sample fades by its own depth. In a uniform scene with one light the mean is between the
-- extremes of the fade. A cue at a large distance changes nothing.
local scene = make "perspective"
local plain = render(scene, { samples = 4 })
scene.depth_cue = { near = 1e12, far = 2e12 }
local distant = render(scene, { samples = 4 })
scene.depth_cue = { color = color, near = 1e-3, far = 2e-3 }
local full, opaque = render(scene, { samples = 4 }), render(make("perspective", true), { samples = 4 })
local same, covered = true, true
for y = 0, 35 do
  for x = 0, 47 do
    local a, b, share = { plain:pixel(x, y) }, { distant:pixel(x, y) }, opaque:pixel(x, y, "alpha")
    local got, sky = { full:pixel(x, y) }, { 0.2, 0.5, 0.8 }
    for c = 1, 3 do
      same = same and math.abs(a[c] - b[c]) <= 2 ^ -21 * a[c] -- samples are summed in another order
      covered = covered and math.abs(got[c] - (share * color[c] + (1 - share) * sky[c])) < 1e-6
    end
  end
end
check(same, "a cue beyond everything changes nothing")
check(covered, "a cue before everything leaves its colour, and the background where nothing is hit")

-- By default the cue has the colour of the background. With alpha, the background is black, but the cue stays.
scene = make "perspective"
scene.depth_cue = { near = near, far = far }
local follows = render(scene)
scene.depth_cue = { color = { 0.2, 0.5, 0.8 }, near = near, far = far }
local given = render(scene)
local clear = render(scene, { alpha = true })
same = true
local without = true
for y = 0, 35 do
  for x = 0, 47 do
    for c = 1, 3 do
      same = same and select(c, follows:pixel(x, y)) == select(c, given:pixel(x, y))
      local alpha = clear:pixel(x, y, "alpha") -- alpha is between 0 and 1 where glass shows the background
      without = without and (alpha > 0 and alpha < 1 or select(c, clear:pixel(x, y)) == (alpha == 1 and select(c, given:pixel(x, y)) or 0))
    end
  end
end
check(same, "without a colour it is the background's")
check(without, "with alpha, what is hit keeps its cue")

-- Tests the field depth_cue.
local cue = scene.depth_cue
check(cue.near == near and cue.far == far and cue.color.z == 0.8, "it reads back")
scene.depth_cue = { far = 3 }
check(scene.depth_cue.near == 0 and scene.depth_cue.color == nil, "defaults")
scene.depth_cue = nil
check(scene.depth_cue == nil, "nil turns it off")
local function set(value) scene.depth_cue = value end
raises("scene.depth_cue: table expected, got 3", set, 3)
raises("scene.depth_cue.fat: no such field; did you mean 'far'?", set, { near = 1, fat = 2 })
raises("far", set, { near = 1 })
raises("scene.depth_cue.far: expected a finite number above near (2), got 2", set, { near = 2, far = 2 })
raises("scene.depth_cue.near: finite number >= 0 expected, got -1", set, { near = -1, far = 2 })
raises("scene.depth_cue.far: finite number expected, got inf", set, { near = 1, far = math.huge })
raises("scene.depth_cue.color", set, { near = 1, far = 2, color = { -1, 0, 0 } })
check(scene.depth_cue == nil, "what is refused changes nothing")

tally.finish()
