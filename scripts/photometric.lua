-- A photometric set for photometric stereo and relighting: one view under many lights, with the ground truth.
--
-- Files, all linear, in the folder `photometric` (--set folder=...):
--     light_001.png ...    the scene under light 1, 2 ...: 16 bits, code = light * 65535; .pfm with --set exact=true
--     lights.csv           file, x, y, z (unit, from the scene to the light; x right, y up, z to the camera), intensity
--                          (the light's intensity times 2^exposure, as in the pixel values)
--     mask.png             1 where an object is, 0 elsewhere (16 bits)
--     normal.png           normal * 0.5 + 0.5 in the same axes (16 bits), and normal.pfm: exact, else 0
--     depth.png            nearest / distance (16 bits), and depth.pfm: the distance from the eye, else inf
-- Only the light changes. The engine caches the hits once a second frame has used the same ones. From image 3 on, a
-- picture costs only light and shading (and shadows, unless --set shadows=false): --json shows "cast":"reused".
--     glint scripts/photometric.lua --set lights=96 --set shadows=false
--     glint scripts/photometric.lua --set specular=0.4          surfaces that are not matt
-- --set layout=diligent writes what programs for the DiLiGenT benchmark read (B. Shi et al., "A Benchmark Dataset and
-- Evaluation for Non-Lambertian and Uncalibrated Photometric Stereo", PAMI 2019), a folder for each object in each
-- material:
--     001.png 002.png ...       16 bits, linear; filenames.txt has their names, one per line
--     light_directions.txt      x y z, one light per line, in the axes above
--     light_intensities.txt     its red, green and blue, times 2^exposure
--     Normal_gt.mat, .npy, .png the true normals, 0 in the background; depth_gt.npy
--     mask.png                  255 where the object is, 0 elsewhere; one channel
-- and objects.txt next to the folders, with their names.
--     glint scripts/photometric.lua --set layout=diligent --set objects=balls,solids --set materials=matt,gold
-- --size sets the size of the pictures. -o 'set/%03d.png' names them, and the other files go into the same folder. The
-- last picture, after the last light, is the scene in white ambient light.
-- Bright materials (gold, glossy) exceed white: --exposure auto finds an exposure for each folder that clips nothing,
-- and --exposure -1.5 sets one for all. The intensities in a folder are scaled to match.
-- An interrupted job continues when it is run again, and --shard divides it between several machines.
-- To use your own scene, add its shapes to `OBJECTS`; with a camera along -z the axes stay as above.
local glint = require "glint"
local mat = require "glint.mat"
local png = require "glint.png"

local P = glint.params {
  lights = { 24, min = 1, max = 999, whole = true, doc = "directions of light" },
  spread = { 65, min = 1, max = 85, doc = "degrees from the camera's axis to the outermost light" },
  shadows = { true, doc = "do objects cast shadows on each other?" },
  specular = { 0, min = 0, max = 1, doc = "strength of a highlight; 0: matt surfaces" },
  exact = { false, doc = "write .pfm (float32) instead of 16-bit .png" },
  folder = { "photometric", doc = "where the files go" },
  layout = { "glint", choices = { "glint", "diligent" }, doc = "names and formats of the files" },
  objects = { "balls", doc = "for diligent: balls, sphere, solids, dents, separated by commas" },
  materials = { "matt", doc = "for diligent: matt, glossy, rough, gold, separated by commas" },
  vary = { 0, min = 0, max = 0.9, doc = "for diligent: how much weaker a light may be, in each channel" },
  size = { 512, min = 8, max = 4096, whole = true, doc = "pixels per side, unless --size is given" },
}

local given = glint._output() -- the value of -o
if given and P.layout == "diligent" then
  error("-o: layout=diligent names the files itself; choose the folder with --set folder=...", 0)
end
local folder = given and (given:match "^(.*)/[^/]*$" or ".") or P.folder

-- Returns the file name of the k-th picture, if -o gives one.
local function given_name(k)
  local name = given:match "[^/]*$"
  if name:find "%%0?%d*d" then return (name:gsub("%%0?%d*d", function(place) return place:format(k) end, 1)) end
  if name:find "#+" then return (name:gsub("#+", function(place) return ("%0" .. #place .. "d"):format(k) end, 1)) end
  return (name:gsub("%.?[^.]*$", function(ending) return ("_%04d"):format(k) .. ending end, 1))
end

-- Materials by name, with the object's colour. ambient = 1 marks the objects, see below.
local MATERIALS = {
  matt = function(color) return { diffuse = color, specular = P.specular, shininess = 40 } end,
  glossy = function(color) return { diffuse = color, specular = 0.4, shininess = 80 } end,
  rough = function(color) return { diffuse = color, model = require "glint.models".oren_nayar { roughness = 0.5 } } end,
  gold = function()
    return { diffuse = 0.05, specular = 1, model = "cook_torrance", roughness = 0.35, f0 = { 1, 0.77, 0.34 },
      mirror = 0 } -- photometric stereo expects the lamps alone
  end,
}

local function ball(x, y, z, radius, material)
  return glint.sphere { center = { x, y, z }, radius = radius, material = material }
end

-- The shapes of an object. paint(color) returns the material.
local OBJECTS = {
  balls = function(paint)
    return { ball(0, 0, 0, 1.6, paint { 0.75, 0.72, 0.68 }), ball(1.5, 0.9, 0.9, 0.6, paint { 0.70, 0.25, 0.18 }),
      ball(-1.4, -0.8, 1.0, 0.7, paint { 0.22, 0.45, 0.65 }), ball(-0.7, 1.5, 0.6, 0.5, paint { 0.35, 0.55, 0.20 }) }
  end,
  sphere = function(paint) return { ball(0, 0, 0, 2, paint { 0.7, 0.7, 0.7 }) } end,
  solids = function(paint)
    return { glint.box { min = { -1.5, -1.5, -0.5 }, max = { 0.2, 0.2, 0.5 }, material = paint { 0.6, 0.4, 0.3 },
        transform = glint.rotate("x", 35) * glint.rotate("y", 40) },
      glint.cylinder { base = { 0.9, -1.8, 0 }, top = { 1.5, 0.2, 0.6 }, radius = 0.5,
        material = paint { 0.3, 0.5, 0.6 } },
      glint.cone { base = { -0.2, 0.4, 0 }, top = { 0.9, 2, 0.9 }, radius = 0.8, material = paint { 0.6, 0.6, 0.4 } } }
  end,
  dents = function(paint)
    local dented = paint { 0.7, 0.66, 0.6 }
    dented.bump = glint.pattern(function(p) return 0.12 * glint.noise(p * 2.5) end)
    return { ball(0, 0, 0, 2, dented) }
  end,
}

-- Returns the table's entries for the names listed in a text.
local function pick(text, entries, what)
  local list, known = {}, {}
  for name in pairs(entries) do known[#known + 1] = name end
  table.sort(known)
  for name in text:gmatch "[^,%s]+" do
    if not entries[name] then
      error(("--set %s: '%s' is none of %s"):format(what, name, table.concat(known, ", ")), 0)
    end
    list[#list + 1] = { name = name, make = entries[name] }
  end
  return list
end

-- Returns directions that cover a cap around the camera's axis evenly: a spiral of golden angles.
local function direction(k)
  local z = 1 - (k - 0.5) / P.lights * (1 - glint.cos(math.rad(P.spread)))
  local angle, r = k * math.pi * (3 - math.sqrt(5)), math.sqrt(1 - z * z)
  return r * glint.cos(angle), r * glint.sin(angle), z
end

local function write(path, lines)
  local file = assert(io.open(path, "w"))
  assert(file:write(table.concat(lines)))
  assert(file:close())
end

-- Renders one object under all lights, then without them: every material has ambient = 1, so that white ambient light
-- marks the objects. `look` is called with each light's number, direction and lamp, and returns the picture's file.
local function render(shapes, look)
  local lamp = glint.directional_light { direction = { 0, 0, -1 }, shadows = P.shadows }
  local scene = glint.scene {
    camera = glint.camera { eye = { 0, 0, 10 }, at = { 0, 0, 0 }, projection = "orthographic", height = 4.6 },
    lamp, table.unpack(shapes),
  }
  for k = 1, P.lights do
    local x, y, z = direction(k)
    lamp.direction = { -x, -y, -z }
    scene:render { width = P.size, height = P.size, bits = 16, transfer = "linear", output = look(k, x, y, z, lamp) }
  end
  scene:remove(lamp)
  scene.ambient = 1
  local truth = scene:render { width = P.size, height = P.size, passes = "normal,depth" }
  -- nil: another machine's part, or the first run of --exposure auto, which writes nothing
  return glint._exposure "" ~= false and truth or nil
end

local function painter(fields)
  return function(color)
    local all = fields(color)
    all.ambient = 1
    return glint.material(all)
  end
end

-- Returns the factor of --exposure for the pixel values of a picture. Files of numbers store unscaled light.
local function gain(path) return path:find "%.png$" and glint.pow(2, glint._exposure(path) or 0) or 1 end

local function write_glint()
  local lights, rows = {}, { "file,x,y,z,intensity\n" }
  local function path(name) return folder .. "/" .. name end
  local truth = render(OBJECTS.balls(painter(MATERIALS.matt)), function(k, x, y, z, lamp)
    local file = given and given ~= "none" and given_name(k) or ("light_%03d.%s"):format(k, P.exact and "pfm" or "png")
    lights[k] = { file, x, y, z, lamp.intensity }
    return path(file)
  end)
  if not truth or given == "none" then return end
  assert(truth:save(path "mask.png", { bits = 16, transfer = "linear" }))
  for _, pass in ipairs { "normal", "depth" } do
    assert(truth:save(path(pass .. ".png"), { bits = 16, pass = pass }))
    assert(truth:save(path(pass .. ".pfm"), { pass = pass }))
  end
  for k, light in ipairs(lights) do
    local file, x, y, z, intensity = table.unpack(light)
    rows[k + 1] = ("%s,%.17g,%.17g,%.17g,%.17g\n"):format(file, x, y, z, intensity * gain(path(file)))
  end
  write(path "lights.csv", rows)
end

local function write_diligent(object, material)
  local name = object.name .. "_" .. material.name
  local place = ("%s/%s/"):format(folder, name)
  local names, directions, colors, intensities = {}, {}, {}, {}
  local truth = render(object.make(painter(material.make)), function(k, x, y, z, lamp)
    local color = {}
    for c = 1, 3 do color[c] = 1 - P.vary * glint.hash(k, c, 0) end
    lamp.color = color
    names[k] = ("%03d.png\n"):format(k)
    directions[k] = ("%.17g %.17g %.17g\n"):format(x, y, z)
    colors[k] = color
    return place .. ("%03d.png"):format(k)
  end)
  if not truth then return name, false end
  local times = gain(place .. names[1]:sub(1, -2))
  for k, color in ipairs(colors) do
    intensities[k] = ("%.17g %.17g %.17g\n"):format(color[1] * times, color[2] * times, color[3] * times)
  end
  local width, height = truth.width, truth.height
  local mask, normals = png.grey(width, height), {}
  for y = 0, height - 1 do
    for x = 0, width - 1 do
      normals[y * width + x] = { truth:pixel(x, y, "normal") }
      if truth:pixel(x, y, "depth") < math.huge then mask:set(x, y, 1) end
    end
  end
  assert(truth:save(place .. "Normal_gt.npy", { pass = "normal" })) -- also makes the folder
  mat.write(place .. "Normal_gt.mat", "Normal_gt", { height, width, 3 }, function(row, column, c)
    return normals[(row - 1) * width + column - 1][c]
  end)
  assert(truth:save(place .. "Normal_gt.png", { bits = 16, pass = "normal" }))
  assert(truth:save(place .. "depth_gt.npy", { pass = "depth" }))
  mask:save(place .. "mask.png")
  write(place .. "filenames.txt", names)
  write(place .. "light_directions.txt", directions)
  write(place .. "light_intensities.txt", intensities)
  return name, true
end

if P.layout == "glint" then
  write_glint()
else
  local materials, names, any = pick(P.materials, MATERIALS, "materials"), {}, false
  for _, object in ipairs(pick(P.objects, OBJECTS, "objects")) do
    for _, material in ipairs(materials) do
      local name, is_whole = write_diligent(object, material)
      names[#names + 1], any = name .. "\n", any or is_whole
    end
  end
  if any then write(folder .. "/objects.txt", names) end
end
