-- Makes pictures with other strengths and colours of their lights, or a page that mixes them (glint relight).
local the = ...

local CURVES <const> = { "clamp", "reinhard", "filmic" } -- by the number of a tone curve, from 1

-- ---- --light ----

-- Reads a strength or a colour.
local function take_value(my, light, value)
  local option, strength = "--light " .. light.name .. ": ", my.number(value)
  if strength then
    if light.strength or not (strength >= 0 and strength < math.huge) then
      my.fail(2, option .. "expected a finite strength >= 0, given only once, got '" .. value .. "'")
    end
    light.strength = strength
    return
  end
  local color = not light.color and my.color(value)
  if not color then
    my.fail(2, option .. "expected a strength such as 2 or a colour such as #ffd9a0 or orange, each given only once, "
      .. "got '" .. value .. "'")
  end
  light.color = color
end

-- Returns the lights that --light names, as a list and by their names.
local function read_lights(my)
  local lights = {}
  for _, text in ipairs(my.lights()) do
    local name, value = text:match "^(.*)=([^=]*)$"
    if not lights[name] then
      lights[name] = { name = name }
      lights[#lights + 1] = lights[name]
    end
    take_value(my, lights[name], value)
  end
  return lights
end

-- Fails if a file lacks a light that --light names.
local function check_lights(my, lights, names, other, path)
  for _, light in ipairs(lights) do
    local near, is_found, all = nil, false, {}
    for _, name in ipairs(names) do
      is_found, near = is_found or name == light.name, the.nearer(light.name, near, name)
      if name ~= other then all[#all + 1] = "'" .. name .. "'" end
    end
    if not is_found then
      my.fail(2, ("--light %s: %s has no light pass of that name; %s"):format(light.name, path,
        near and near ~= other and "did you mean '" .. near .. "'?" or "it has " .. table.concat(all, ", ")))
    end
  end
end

-- Reads a file's lights. Returns the image, which the caller closes, and the strength and colour of each light.
local function read(my, lights, path)
  local image, names, other = my.read(path)
  check_lights(my, lights, names, other, path)
  local mix = {}
  for i, name in ipairs(names) do
    local light = lights[name] or {}
    mix[i] = { name = name, strength = light.strength or 1, color = light.color or 0xffffff }
  end
  return image, mix
end

-- ---- The page: sliders and colours for the lights of one file ----

-- Returns the least light for each pixel value 1 .. 255, as the bits of a float, for each tone curve.
local function steps(my)
  local out = {}
  for i, curve in ipairs(CURVES) do out[i] = curve .. ": [" .. table.concat(my.steps(i), ",") .. "]" end
  return table.concat(out, ", ")
end

-- Returns the light for each sRGB value 0 .. 255.
local function decoded(my)
  local out = {}
  for i = 0, 255 do out[#out + 1] = ("%.17g"):format(my.decode(i / 255)) end
  return table.concat(out, ",")
end

local function list_lights(mix)
  local out = {}
  for i, light in ipairs(mix) do
    out[i] = ("{ name: %s, strength: %.17g, color: '#%06x' }"):format(the.json(light.name), light.strength, light.color)
  end
  return table.concat(out, ", ")
end

local function write_page(my, lights, files)
  if #files ~= 1 then my.fail(2, "a page shows one file; expected only one") end
  local image <close>, mix = read(my, lights, files[1])
  local exposure, curve, is_plain = my.tone()
  if not is_plain then
    my.fail(2, "-o " .. my.options.output .. ": the page always shows 8-bit sRGB, rounded to the nearest value; "
      .. "expected no --bits, --transfer, --rounding or --dither")
  end
  local template, version = my.page()
  local title = my.options.title or files[1]:match "[^/]*$"
  local values = {
    VERSION = version, TITLE = (title:gsub("[<&]", { ["<"] = "&lt;", ["&"] = "&amp;" })), FILE = the.json(files[1]),
    LIGHTS = list_lights(mix), STEPS = steps(my), DECODED = decoded(my), EXPOSURE = ("%.17g"):format(exposure),
    TONE = CURVES[curve],
  }
  local before, after = template:match "^(.*)@PIXELS@(.*)$"
  my.write_page((before:gsub("@(%u+)@", values)), image, (after:gsub("@(%u+)@", values)))
end

-- ---- The pictures ----

-- Returns whether the pictures get the numbers of their files, which must ascend. Otherwise they are counted from 1.
local function has_numbers(files)
  local last = -1
  for i = 1, #files do
    if files.numbers[i] <= last then return false end
    last = files.numbers[i]
  end
  return true
end

local function write_pictures(my, lights, files)
  do
    local _ <close> = read(my, lights, files[1]) -- fails before anything is written
  end
  local is_numbered = has_numbers(files)
  for i, path in ipairs(files) do
    local image <close>, mix = read(my, lights, path)
    my.write(image, is_numbered and files.numbers[i] or i, mix)
  end
  my.finish()
end

function the.run(my)
  local lights, output = read_lights(my), my.options.output
  local files = the.files(my)
  if not output or output == "none" then my.fail(2, "expected -o with a picture, a film or a page NAME.html") end
  if output:find ".%.html$" then return write_page(my, lights, files) end
  my.open(#files)
  write_pictures(my, lights, files)
end
