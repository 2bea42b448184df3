-- In every mode, the passes depth, normal, object_id, albedo and outline belong to the ray through the pixel's centre.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local PASSES = { "depth", "normal", "object_id", "albedo", "outline" }
local WIDTH, HEIGHT = 70, 50

local function scene_of(camera)
  local lamp = glint.point_light { position = { 3, 5, 6 } }
  camera.eye, camera.at = { 0, 1, 8 }, { 0, 0, 0 }
  return glint.scene {
    camera = glint.camera(camera), ambient = 0.2, lamp,
    glint.sphere { center = { 0, 0, 0 }, radius = 1.5,
      material = glint.material { diffuse = glint.pattern(function(p) return glint.checker(3 * p) end) } },
    glint.plane { point = { 0, -1.5, 0 }, normal = { 0, 1, 0 } },
    glint.box { min = { 1.2, -1, -1 }, max = { 3, 1, 1 } },
    glint.sphere_mesh { center = { -2.5, 0, 0 }, radius = 1, segments = 24, shading = "phong" },
    glint.sphere_mesh { center = { -2.5, 2, 0 }, radius = 1, segments = 80, shading = "flat" },
  }, lamp
end

local function values(scene, options)
  local all, fields = {}, { width = WIDTH, height = HEIGHT, passes = table.concat(PASSES, ",") }
  for name, value in pairs(options) do fields[name] = value end
  local image = scene:render(fields)
  for y = 0, HEIGHT - 1 do
    for x = 0, WIDTH - 1 do
      for _, pass in ipairs(PASSES) do
        local a, b, c = image:pixel(x, y, pass)
        all[#all + 1] = ("%a %a %a"):format(a, b or 0, c or 0)
      end
    end
  end
  return all
end

local function others(a, b)
  local count = 0
  for i = 1, #a do count = count + (a[i] == b[i] and 0 or 1) end
  return count
end

local MODES = {
  { samples = 4 }, { samples = 16 }, { samples = 64, seed = 3 }, { samples = 1, seed = 5 }, { samples = 16, adaptive = 0.1 },
  { samples = 16, adaptive = 0.1, seed = 4 }, { samples = 16, visibility = "cast" }, { samples = 16, visibility = "scan" },
}
for _, camera in ipairs { {}, { pixel_offset = 0.2 }, { projection = "orthographic", height = 6 } } do
  local function copy(more)
    for name, value in pairs(camera) do more[name] = value end
    return more
  end
  local want = values(scene_of(copy {}), { samples = 1 })
  for _, mode in ipairs(MODES) do
    local scene, lamp = scene_of(copy {})
    for frame = 1, 2 do -- the second one reuses the first one's results
      check(others(want, values(scene, mode)) == 0, "samples %d, seed %s, adaptive %s, frame %d", mode.samples, mode.seed, mode.adaptive, frame)
      lamp.x = -3
    end
    if not camera.projection then
      check(others(want, values(scene_of(copy { aperture = 0.3, focus = 8 }), mode)) == 0, "a lens with %d samples", mode.samples)
    end
  end
end

-- With an open shutter, these passes show the frame's own time.
local function contents(path)
  local file = assert(io.open(path, "rb"))
  local text = file:read "a"
  file:close()
  os.remove(path)
  return text
end
do
  local scene = scene_of {}
  local ball = glint.sphere { center = { 0, 2, 0 }, radius = 0.5 }
  local name = os.tmpname()
  scene:add(ball)
  for n = 1, 3 do
    ball.center = { n, 2, 0 }
    scene:render { width = WIDTH, height = HEIGHT, passes = "depth,albedo", output = ("%s_%d_want.pfm"):format(name, n) }
  end
  scene.camera.shutter, scene.camera.shutter_times = 0.5, 4
  glint.animation { scene = scene, frames = 3, width = WIDTH, height = HEIGHT, samples = 4, passes = "depth,albedo",
    frame = function(t) ball.center = { 1 + 2 * t, 2, 0 } end }:run { output = name .. "_%d.pfm" }
  for n = 1, 3 do
    for _, pass in ipairs { "depth", "albedo" } do
      check(contents(("%s_%d.%s.pfm"):format(name, n, pass)) == contents(("%s_%d_want.%s.pfm"):format(name, n, pass)),
        "%s of frame %d while the shutter is open", pass, n)
    end
    check(contents(("%s_%d.pfm"):format(name, n)) ~= contents(("%s_%d_want.pfm"):format(name, n)), "the ball of frame %d moves", n)
  end
  os.remove(name)
end

-- A ball of radius 1 at 0.1 units per pixel: the x of the normal equals the x of the pixel's centre.
local ball = glint.scene { ambient = 1, glint.sphere { center = { 0, 0, 0 }, radius = 1 }, camera = glint.camera {
  eye = { 0, 0, 10 }, direction = { 0, 0, -1 }, projection = "orthographic", height = 2.2 } }
for _, mode in ipairs(MODES) do
  local image, off = ball:render { width = 22, height = 22, samples = mode.samples, seed = mode.seed, adaptive = mode.adaptive, passes = "normal" }, 0
  for x = 3, 18 do off = math.max(off, math.abs(image:pixel(x, 10, "normal") - (x - 10.5) / 10)) end
  check(off < 1e-7, "normals of a ball, samples %d: off by %g", mode.samples, off)
end

tally.finish()
