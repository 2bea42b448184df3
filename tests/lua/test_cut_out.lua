-- Opacity that cuts: where opacity is below one half, surfaces vanish, as in the same scenes without the surfaces.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local WIDTH <const>, HEIGHT <const> = 40, 30
local PASSES <const> = { "beauty", "diffuse", "depth", "normal" }
local EYE <const>, LAMP <const> = { 1, 3, 8 }, { 1.5, 6, -3 }

local raises = tally.raises

-- A scene with an optional `pane` between the eye, the light, the floor and a ball.
local function scene_of(pane, fields)
  local scene = glint.scene {
    camera = glint.camera { eye = EYE, at = { 0, 0.8, 0 }, fov = 50 }, ambient = 0.1, background = { 0.2, 0.3, 0.5 },
    glint.point_light { position = LAMP },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { specular = 0.3 } },
    glint.sphere { center = { -1, 0.7, -1 }, radius = 0.7, material = glint.material { diffuse = "teal" } },
  }
  for name, value in pairs(fields or {}) do scene[name] = value end
  if pane then scene:add(pane) end
  return scene
end

local function render(scene, fields)
  local options = { width = WIDTH, height = HEIGHT, passes = PASSES }
  for name, value in pairs(fields or {}) do options[name] = value end
  return scene:render(options)
end

local function bits(image, pass, x, y)
  local r, g, b = image:pixel(x, y, pass) -- some passes have one number
  return ("%a %a %a"):format(r, g or 0, b or 0)
end

local function depth(image, x, y) return (image:pixel(x, y, "depth")) end

-- Counts the pixels of a pass that differ between two images.
local function differing(a, b, pass)
  local count = 0
  for y = 0, HEIGHT - 1 do
    for x = 0, WIDTH - 1 do
      if bits(a, pass, x, y) ~= bits(b, pass, x, y) then count = count + 1 end
    end
  end
  return count
end

local function ray(x, y)
  local w = (glint.vector(EYE) - { 0, 0.8, 0 }):unit()
  local u = glint.cross({ 0, 1, 0 }, w):unit()
  local half = math.tan(math.rad(25))
  return u * ((x + 0.5 - WIDTH / 2) / (HEIGHT / 2) * half) + w:cross(u) * ((HEIGHT / 2 - y - 0.5) / (HEIGHT / 2) * half) - w
end

local function shapes(material)
  return {
    quad = glint.mesh { vertices = { { -2, 0.2, 1 }, { 2, 0.2, 1 }, { 2, 2, 1.3 }, { -2, 2, 1.3 } }, faces = { { 1, 2, 3, 4 } }, material = material },
    sheet = glint.sphere_mesh { center = { 0, 1, 1 }, radius = 0.9, segments = 24, material = material },
    disk = glint.disk { center = { 0, 1, 2 }, normal = { 0.1, 0.2, 1 }, radius = 1.2, material = material },
    sphere = glint.sphere { center = { 0.3, 1.2, 1 }, radius = 1, material = material },
    box = glint.box { min = { -1, 0.3, 0 }, max = { 1, 1.5, 1 }, transform = glint.rotate("y", 20), material = material },
    cylinder = glint.cylinder { base = { 0, 0.2, 1 }, top = { 0.3, 2, 1 }, radius = 0.8, material = material },
    cone = glint.cone { base = { 0, 0.2, 1 }, top = { 0.3, 2.5, 1 }, radius = 1, capped = false, material = material },
    torus = glint.torus { center = { 0, 1, 1 }, axis = { 0.5, 1, 1 }, major = 0.9, minor = 0.35, material = material },
    egg = glint.sphere { center = { 0, 1, 1 }, radius = 0.5, transform = glint.scale(1.5, 1, 1), material = material },
    wall = glint.plane { point = { 0, 0, 3 }, normal = { 0, 0.1, 1 }, material = material },
  }
end

local tests = {}

-- An invisible surface changes no bit of the surfaces behind it or of their light.
function tests.what_is_not_there_changes_nothing()
  local gone = glint.pattern(function(p) return glint.select(glint.less(p.y, 1e9), 0, 1) end)
  local lights = {
    point = function() return glint.point_light { position = LAMP } end,
    sun = function() return glint.directional_light { direction = { -1, -2, 0.3 } } end,
    ball = function() return glint.sphere_light { position = LAMP, radius = 1, samples = 4 } end,
    hard = function() return glint.disk_light { position = LAMP, normal = { -1, -2, 0 }, radius = 1, samples = 3, shadow = "hard" } end,
    panel = function() return glint.polygon_light { vertices = { { 2, 6, 1 }, { 3, 6, 1 }, { 3, 6, 2 } }, samples = 5, radiance = 9 } end,
  }
  local plain = render(scene_of())
  for name, shape in pairs(shapes(glint.material { opacity = gone })) do
    local image = render(scene_of(shape))
    for _, pass in ipairs(PASSES) do check(differing(image, plain, pass) == 0, "%s: %s", name, pass) end
  end
  for name, make in pairs(lights) do
    local with, without = scene_of(shapes(glint.material { opacity = gone }).quad), scene_of()
    with:add(make()) without:add(make())
    for _, samples in ipairs { 1, 3 } do
      local a, b = render(with, { samples = samples }), render(without, { samples = samples })
      check(differing(a, b, "beauty") == 0, "%s, %d samples", name, samples)
    end
  end
  local view = { camera = glint.camera { eye = EYE, at = { 0, 0.8, 0 }, projection = "orthographic", height = 6 } }
  for name, shape in pairs(shapes(glint.material { opacity = gone })) do
    check(differing(render(scene_of(shape, view)), render(scene_of(nil, view)), "beauty") == 0, "%s, orthographic", name)
  end
  for _, fields in ipairs { { visibility = "scan" }, { precision = "float" } } do
    local a = render(scene_of(shapes(glint.material { opacity = 0.4, opacity_mode = "cut" }).sheet), fields)
    check(differing(a, render(scene_of(nil), { precision = fields.precision }), "beauty") == 0, "%s", next(fields))
  end
end

-- A surface seen through a hole can be a part of a CSG shape, which rays do not hit as a primitive of its own.
function tests.combined_solids_are_seen_through_holes()
  local red, grey = glint.material { diffuse = "red" }, glint.material { diffuse = "grey" }
  local parts = {
    sphere = function() return glint.sphere { center = { 0, 1, 0 }, radius = 1, material = red } end,
    box = function() return glint.box { min = { -0.8, 0.3, -0.8 }, max = { 0.8, 1.8, 0.8 }, material = red } end,
    cylinder = function() return glint.cylinder { base = { -1, 0.8, 0 }, top = { 1, 1.2, 0 }, radius = 0.6, material = red } end,
    cone = function() return glint.cone { base = { 0, 0.2, 0 }, top = { 0.2, 2.2, 0 }, radius = 1, material = red } end,
    torus = function() return glint.torus { center = { 0, 1, 0 }, axis = { 0.3, 1, 1 }, major = 0.8, minor = 0.3, material = red } end,
    half = function() return glint.plane { point = { 0, 1.2, 0 }, normal = { 0.1, 1, 0.2 }, material = red } end,
    mesh = function() return glint.sphere_mesh { center = { 0, 1, 0 }, radius = 1, segments = 8, shading = "faceted", material = red } end,
  }
  local function cutter() return glint.sphere { center = { 0.6, 1.4, 0.6 }, radius = 0.8, material = grey } end
  local kinds = { glint.union, glint.intersection, glint.difference }
  local ends = { eye = { 0, 1.5, 4 }, background = { 0.3, 0.6, -4 } } -- before the background, or before a mirror
  for name, part in pairs(parts) do
    for _, kind in ipairs(kinds) do
      for _, precision in ipairs { "double", "float" } do
        local solid, plain = kind { part(), cutter() }, scene_of()
        plain:add(solid)
        plain:add(glint.plane { point = { 0, 0, -4 }, normal = { 0, 0, 1 }, material = glint.material { mirror = 0.5 } })
        local without = render(plain, { precision = precision })
        for place, center in pairs(ends) do
          local pane = glint.sphere { center = center, radius = 1.5, material = glint.material { opacity = 0 } }
          plain:add(pane)
          local with = render(plain, { precision = precision })
          for _, pass in ipairs { "diffuse", "depth", "normal" } do
            check(differing(with, without, pass) == 0, "%s, %s, %s: %s", name, precision, place, pass)
          end
          plain:remove(pane)
        end
      end
    end
  end
end

-- With a pane in front, the hole in a flat part is no longer the first hole of its ray.
function tests.flat_parts_have_holes()
  local red, gone = glint.material { diffuse = "red" }, glint.material { opacity = 0 }
  local function half(z) return glint.plane { point = { 0, 1, 0.3 }, normal = { 0.2, 0.1, z }, material = gone } end
  local function mesh() return glint.sphere_mesh { center = { 0.3, 1.2, 0.6 }, radius = 0.8, segments = 6, shading = "faceted", material = gone } end
  local function ball() return glint.sphere { center = { 0, 1, 0 }, radius = 1, material = red } end
  local solids = {
    glint.difference { ball(), half(-1) }, glint.intersection { ball(), half(1) }, glint.difference { ball(), mesh() },
    glint.union { glint.difference { ball(), half(-1) }, glint.plane { point = { 0, 0.2, 0 }, normal = { 0, 1, 0 }, material = red } },
  }
  for i, solid in ipairs(solids) do
    local scene = scene_of()
    scene:add(solid)
    local without = render(scene)
    scene:add(glint.sphere { center = { 0, 1.5, 4 }, radius = 1.8, material = gone })
    local with = render(scene)
    for _, pass in ipairs { "diffuse", "depth", "normal" } do check(differing(with, without, pass) == 0, "solid %d: %s", i, pass) end
  end
end

function tests.a_number_is_the_same_everywhere()
  local plain = render(scene_of())
  for opacity, gone in pairs { [0] = true, [0.49] = true, [0.5] = false, [1] = false } do
    local pane = shapes(glint.material { opacity = opacity, opacity_mode = "cut" }).quad
    local count = differing(render(scene_of(pane)), plain, "depth")
    check((count == 0) == gone, "%g: %d pixels", opacity, count)
  end
  local folded = glint.material { opacity = glint.pattern(function() return 0.25 end) }
  check(differing(render(scene_of(shapes(folded).disk)), plain, "beauty") == 0, "a pattern of a number")
end

local function rings(p) return glint.fract(3 * glint.sqrt(p.x * p.x + (p.y - 1) * (p.y - 1)) + 0.2 * p.z) end

-- Each pixel shows the pane, at the whole pane's depth, or the scene behind, at the depth without the pane.
function tests.eyes_see_through_holes()
  for _, name in ipairs { "disk", "quad", "wall" } do
    local cut = scene_of(shapes(glint.material { opacity = glint.pattern(rings) })[name])
    local pane = shapes(glint.material {})[name]
    local solid = scene_of(pane)
    local a, whole, without, seen = render(cut), render(solid), render(scene_of()), { 0, 0 }
    for y = 0, HEIGHT - 1 do
      for x = 0, WIDTH - 1 do
        local hit = solid:cast(EYE, ray(x, y))
        if hit and hit.object == pane then
          local value = rings(glint.vector(hit.point))
          local want = value >= 0.5 and whole or without
          if math.abs(value - 0.5) > 1e-9 then
            check(depth(a, x, y) == depth(want, x, y), "%s: depth at %d, %d", name, x, y)
            check(bits(a, "normal", x, y) == bits(want, "normal", x, y), "%s: normal at %d, %d", name, x, y)
            seen[value >= 0.5 and 1 or 2] = seen[value >= 0.5 and 1 or 2] + 1
          end
        end
      end
    end
    check(seen[1] > 40 and seen[2] > 40, "%s: %d there, %d holes", name, seen[1], seen[2])
  end
end

-- Floor points are lit as without the pane where light passes through a hole, otherwise as behind a whole pane.
function tests.light_goes_through_holes()
  for _, name in ipairs { "disk", "quad" } do
    local cut = scene_of(shapes(glint.material { opacity = glint.pattern(rings) })[name])
    local pane = shapes(glint.material {})[name]
    local solid, plain = scene_of(pane), scene_of()
    local a, whole, without, seen = render(cut), render(solid), render(plain), { 0, 0 }
    for y = 0, HEIGHT - 1 do
      for x = 0, WIDTH - 1 do
        local hit = solid:cast(EYE, ray(x, y))
        if hit and hit.object ~= pane and hit.point.y < 1e-9 then
          local way = solid:cast(hit.point, glint.vector(LAMP) - hit.point)
          if way and way.object == pane then
            local value = rings(glint.vector(way.point))
            local want = value >= 0.5 and whole or without
            if math.abs(value - 0.5) > 1e-9 then
              check(bits(a, "diffuse", x, y) == bits(want, "diffuse", x, y), "%s: light at %d, %d", name, x, y)
              seen[value >= 0.5 and 1 or 2] = seen[value >= 0.5 and 1 or 2] + 1
            end
          end
        end
      end
    end
    check(seen[1] > 10 and seen[2] > 10, "%s: %d in shadow, %d lit", name, seen[1], seen[2])
  end
end

-- Holes in the front of a ball show its back, except where the back has holes too.
function tests.the_inside_is_seen()
  local function bands(p) return glint.fract(4 * p.y + 0.7 * p.x) end
  local centre <const>, radius <const> = glint.vector { 0.3, 1.2, 1 }, 1
  local cut = render(scene_of(shapes(glint.material { opacity = glint.pattern(bands) }).sphere))
  local without, seen = render(scene_of()), { 0, 0, 0 }
  for y = 0, HEIGHT - 1 do
    for x = 0, WIDTH - 1 do
      local d, f = ray(x, y):unit(), glint.vector(EYE) - centre
      local b, root = -f:dot(d), f:dot(d) ^ 2 - (f:dot(f) - radius * radius)
      if root > 0.01 then
        local front, back = glint.vector(EYE) + d * (b - root ^ 0.5), glint.vector(EYE) + d * (b + root ^ 0.5)
        local which = bands(front) >= 0.5 and 1 or bands(back) >= 0.5 and 2 or 3
        local want = which == 1 and b - root ^ 0.5 or which == 2 and b + root ^ 0.5 or depth(without, x, y)
        if math.abs(bands(front) - 0.5) > 1e-6 and math.abs(bands(back) - 0.5) > 1e-6 and bands(front) > 1e-6 and bands(back) > 1e-6 then
          near(depth(cut, x, y), want, 1e-5, ("depth at %d, %d"):format(x, y))
          seen[which] = seen[which] + 1
        end
      end
    end
  end
  check(seen[1] > 20 and seen[2] > 10 and seen[3] > 10, "%d front, %d back, %d beyond", seen[1], seen[2], seen[3])
end

-- A surface coplanar with a hole is visible in the hole.
function tests.a_label_shows_its_wall()
  local wall = glint.mesh { vertices = { { -3, 0, 0 }, { 3, 0, 0 }, { 3, 3, 0 }, { -3, 3, 0 } }, faces = { { 1, 2, 3, 4 } },
    material = glint.material { diffuse = "red" } }
  local label = glint.mesh { vertices = { { -1, 0.5, 0 }, { 1, 0.5, 0 }, { 1, 2, 0 }, { -1, 2, 0 } }, faces = { { 1, 2, 3, 4 } },
    material = glint.material { diffuse = "blue", opacity = glint.pattern(rings) } }
  local function scene(...) return glint.scene { camera = glint.camera { eye = EYE, at = { 0, 0.8, 0 }, fov = 50 }, ambient = 1, ... } end
  local image, alone, seen = render(scene(label, wall)), render(scene(wall)), { red = 0, blue = 0 }
  for y = 0, HEIGHT - 1 do
    for x = 0, WIDTH - 1 do
      local r, _, b = image:pixel(x, y)
      if (alone:pixel(x, y)) > 0 then
        check(r + b > 0.5, "something at %d, %d", x, y)
        seen[r > b and "red" or "blue"] = seen[r > b and "red" or "blue"] + 1
      end
    end
  end
  check(seen.red > 50 and seen.blue > 10, "%d red, %d blue", seen.red, seen.blue)
end

-- Mirrors, glass and indirect light: rays pass a hole as if nothing were there, except for rounding.
function tests.other_rays_go_through_holes()
  local gone = glint.material { opacity = glint.pattern(function(p) return glint.select(glint.less(p.y, 1e9), 0, 1) end) }
  local changes = {
    mirror = function(scene) scene:add(glint.plane { point = { 0, 0, -3 }, normal = { 0, 0, 1 }, material = glint.material { mirror = 0.8 } }) end,
    glass = function(scene) scene:add(glint.sphere { center = { 0.5, 1, 3 }, radius = 0.8, material = glint.material { diffuse = 0, transmission = 0.9 } }) end,
    indirect = function(scene) scene.indirect = { samples = 8, bounces = 1 } end,
  }
  for name, change in pairs(changes) do
    for kind, pane in pairs { quad = shapes(gone).quad, sphere = shapes(gone).sphere } do
      local with, without = scene_of(pane), scene_of()
      change(with) change(without)
      local a, b, off = render(with), render(without), 0
      for y = 0, HEIGHT - 1 do
        for x = 0, WIDTH - 1 do
          local r, g, bl = a:pixel(x, y)
          local r2, g2, bl2 = b:pixel(x, y)
          if math.abs(r - r2) + math.abs(g - g2) + math.abs(bl - bl2) > 1e-5 then off = off + 1 end
        end
      end
      check(off <= 2, "%s, %s: %d pixels are off", name, kind, off)
    end
  end
end

-- Coloured glass with holes: light is unchanged through a hole, and tinted by the glass elsewhere.
function tests.glass_may_have_holes()
  local function pane(opacity)
    return shapes(glint.material { diffuse = 0, transmission = { 0.9, 0.2, 0.1 }, ior = 1, opacity = opacity }).quad
  end
  local cut, glass, plain = render(scene_of(pane(glint.pattern(rings)))), render(scene_of(pane(1))), render(scene_of())
  local seen = { 0, 0 }
  for y = 0, HEIGHT - 1 do
    for x = 0, WIDTH - 1 do
      local c, g, p = bits(cut, "diffuse", x, y), bits(glass, "diffuse", x, y), bits(plain, "diffuse", x, y)
      if g ~= p then
        check(c == g or c == p, "at %d, %d", x, y)
        seen[c == g and 1 or 2] = seen[c == g and 1 or 2] + 1
      end
    end
  end
  check(seen[1] > 10 and seen[2] > 10, "%d glass, %d holes", seen[1], seen[2])
end

function tests.errors_name_the_field()
  raises("material.opacity: number 0 .. 1 expected, got 2", glint.material, { opacity = 2 })
  raises("opacity: a pattern of one number expected, got one of 3", function()
    render(scene_of(shapes(glint.material { opacity = glint.pattern(function(p) return p end) }).disk))
  end)
  raises("expected, got shader", glint.material, { opacity = glint.shader(function(s) return s.kd end) })
  raises("mesh 'bare' has no texture coordinates", function()
    local pane = shapes(glint.material { opacity = glint.pattern(function(_, s) return s.uv.u end) }).quad
    pane.name = "bare"
    render(scene_of(pane))
  end)
  local odd = glint.material { opacity = glint.pattern(function(p) return glint.sqrt(-1 - p.y * p.y) end) }
  check(differing(render(scene_of(shapes(odd).disk)), render(scene_of()), "depth") == 0, "NaN is nothing")
  check(glint.material {}.opacity == 1 and glint.material { opacity = 0.25 }.opacity == 0.25)
end

tally.run(tests)
tally.finish()
