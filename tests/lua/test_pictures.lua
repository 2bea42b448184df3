-- Pictures as numbers: image:bytes, glint.read_image; contents of a scene; the default camera of a scene.
package.path = "scripts/lib/?.lua;" .. package.path
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local tests = {}
local FOLDER = os.getenv "BUILD" and os.getenv "BUILD" .. "/tests" or "build/tests"

local function ball(x, y, z, radius)
  return glint.sphere { center = { x, y, z }, radius = radius, material = glint.material { diffuse = { 0.8, 0.4, 0.1 } } }
end

local function make()
  return glint.scene {
    camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, ambient = 0.2, background = { 0.1, 0.2, 0.3 },
    glint.point_light { position = { 3, 4, 5 } }, ball(0, 0, 0, 1),
  }
end

function tests.bytes_are_the_pixels()
  local image = make():render { width = 7, height = 5, passes = "depth" }
  for pass, channels in pairs { beauty = 3, depth = 1 } do
    local bytes, at = image:bytes(pass), 1
    check(#bytes == 7 * 5 * channels * 4, "%s: %d bytes", pass, #bytes)
    for y = 0, 4 do
      for x = 0, 6 do
        for _, want in ipairs { image:pixel(x, y, pass) } do
          local got
          got, at = ("<f"):unpack(bytes, at)
          check(got == want, "%s: %d, %d: %g, not %g", pass, x, y, got, want)
        end
      end
    end
  end
  check(image:bytes() == image:bytes "beauty")
  check(not pcall(image.bytes, image, "normal"), "of a pass that was not kept there are none")
end

function tests.files_read_as_they_were_written()
  local image = make():render { width = 9, height = 6 }
  local exact, coarse = FOLDER .. "/read_image.pfm", FOLDER .. "/read_image.png"
  assert(image:save(exact) and image:save(coarse, { bits = 16 }))
  local read = glint.read_image(exact)
  check(read.width == 9 and read.height == 6 and read:bytes() == image:bytes())
  local near = glint.read_image(coarse)
  for y = 0, 5 do
    for x = 0, 8 do
      local a, b = { near:pixel(x, y) }, { image:pixel(x, y) }
      for c = 1, 3 do check(math.abs(a[c] - b[c]) < 2e-5, "%d, %d: %g, not %g", x, y, a[c], b[c]) end
    end
  end
  assert(image:save(coarse, { bits = 8, transfer = "linear" }))
  check(math.abs(select(2, glint.read_image(coarse):pixel(0, 0)) - 0.2) < 1 / 255, "linear codes are shares")
  local good, message = pcall(glint.read_image, FOLDER .. "/no_such.png")
  check(not good and tostring(message):find("no_such.png: No such file", 1, true), "%s", message)
  check(not pcall(glint.read_image) and not pcall(glint.read_image, 5) and not pcall(near.pixel, near, 9, 0))
  check(not pcall(function() near.width = 3 end) and not pcall(function() return near.size end))
  os.remove(exact)
  os.remove(coarse)
end

function tests.a_scene_lists_its_objects()
  local a, b, lamp = ball(0, 0, 0, 1), ball(2, 0, 0, 1), glint.point_light { position = { 0, 5, 0 } }
  local label = glint.label { text = "x" }
  local scene = glint.scene { lamp, a, label, b }
  local list = scene:objects()
  check(#scene == 4 and #list == 4 and list[1] == a and list[2] == b and list[3] == lamp and list[4] == label)
  scene:remove(a)
  check(#scene == 3 and scene:objects()[1] == b and #glint.scene {} == 0 and #glint.scene {}:objects() == 0)
end

-- Every pixel at the picture's edge shows background, and each shape is visible in some pixel.
function tests.a_scene_without_a_camera_gets_one()
  local scene = glint.scene { ball(3, 1, -2, 1), glint.group { ball(0, 0, 0, 0.5), transform = glint.translate(-4, 0, 0) },
    glint.plane { point = { 0, -50, 0 }, normal = { 0, 1, 0 } }, ambient = 1 }
  local image = scene:render { width = 32, height = 32, passes = "object_id,depth" }
  check(scene.camera, "it is the scene's")
  local seen = {}
  for y = 0, 31 do
    for x = 0, 31 do
      local id = image:pixel(x, y, "object_id")
      seen[id] = true
      if x == 0 or y == 0 or x == 31 or y == 31 then check(id == 0 or id == 3, "%d, %d: shape %d", x, y, id) end
    end
  end
  check(seen[1] and seen[2], "both are in view")
  check(not pcall(function() glint.scene {}:render { width = 2, height = 2 } end), "of nothing there is no view")
end

function tests.particles_have_a_flat_camera()
  local particles = require "glint.particles"
  local set = particles.new()
  set:add("C", 0, 0, 0, 1)
  set:add("C", 4, 0, 0, 1)
  local camera = set:camera { from = { 0, 0, 1 }, projection = "orthographic" }
  check(camera.projection == "orthographic" and camera.height >= 6 and camera.eye.z > 3)
end

tally.run(tests)
tally.finish()
