-- NFF, the Neutral File Format of Eric Haines' Standard Procedural Databases (SPD): v, b, l, f, s.
--     local picture = nff.load "balls.nff"
--     return glint.animation { scene = picture.scene, width = picture.width, height = picture.height, ... }
-- What becomes of it: `angle` is the vertical field of view, `hither` is not needed; the colour of `f` times Kd is
-- diffuse, Ks the strength of a white highlight and Shine its exponent (no mirror); a light without a colour has the
-- intensity 1 / sqrt(number of lights). All spheres become one glint.spheres.
-- Refused with their line: cones and cylinders `c`, polygons `p`, patches `pp`, and T > 0 in `f`. With
-- options.skip = { p = true } a kind of primitive is passed over instead, and counted in picture.skipped.
local glint = require "glint"
local lines = require "glint.lines"
local particles = require "glint.particles"

local nff = {}

local VIEW = { { "from", 3 }, { "at", 3 }, { "up", 3 }, { "angle", 1 }, { "hither", 1 }, { "resolution", 2 } }
local NAMES = { p = "polygons", pp = "polygonal patches", c = "cones and cylinders" }

-- The numbers of a text, between `least` and `most` of them.
local function numbers(source, text, what, least, most)
  local list = {}
  for word in text:gmatch "%S+" do list[#list + 1] = source:number_of(word, what) end
  if #list < least or #list > (most or least) then
    source:fail(("%s, %s numbers,"):format(what, most and least .. " to " .. most or least), text)
  end
  return list
end

local function next_line(source)
  for line in function() return source:next() end do
    if line:find "%S" and not line:find "^%s*#" then return line end
  end
end

local read = {} -- by the first word of a line: (picture, source, the rest of the line)

function read.v(picture, source, rest)
  if rest:find "%S" then source:fail("nothing after v in its line", rest) end
  for _, item in ipairs(VIEW) do
    local name, count = item[1], item[2]
    local line = next_line(source)
    local text = (line or ""):match("^%s*" .. name .. "%s(.*)")
    if not text then source:fail(("%s, %d numbers,"):format(name, count), line) end
    picture.view[name] = numbers(source, text, name, count)
  end
  local angle, size = picture.view.angle[1], picture.view.resolution
  if angle <= 0 or angle >= 180 then source:fail("an angle between 0 and 180", tostring(angle)) end
  for i = 1, 2 do
    size[i] = source:whole(("%.14g"):format(size[i]), "resolution", 1)
  end
end

function read.b(picture, source, rest)
  picture.background = numbers(source, rest, "b (a background, r g b)", 3)
end

function read.l(picture, source, rest)
  local list = numbers(source, rest, "l (a light, x y z, or x y z r g b)", 3, 6)
  if #list ~= 3 and #list ~= 6 then source:fail("3 or 6 numbers of a light", rest) end
  picture.lights[#picture.lights + 1] = list
end

function read.f(picture, source, rest)
  local r, g, b, kd, ks, shine, t = table.unpack(numbers(source, rest, "f (r g b Kd Ks Shine T index)", 8))
  if t ~= 0 then source:fail("T = 0 (glint does not read transparent surfaces yet)", rest) end
  if math.min(r, g, b, kd, ks, shine) < 0 then source:fail("no negative number in f", rest) end
  local label = "f" .. picture.material_count + 1
  picture.material_count = picture.material_count + 1
  picture.kinds[label] = {
    radius = 1, material = glint.material { diffuse = { r * kd, g * kd, b * kd }, specular = ks, shininess = shine },
  }
  picture.material = label
end

function read.s(picture, source, rest)
  local x, y, z, radius = rest:match "^%s*(%S+)%s+(%S+)%s+(%S+)%s+(%S+)%s*$"
  if not x then source:fail("s (a sphere, x y z radius)", rest) end
  if not picture.material then source:fail("f (a material) before the first primitive", "s" .. rest) end
  local size = source:number_of(radius, "radius")
  if size <= 0 then source:fail("a radius > 0", radius) end
  picture.set:add(picture.material, source:number_of(x, "x"), source:number_of(y, "y"), source:number_of(z, "z"), size)
end

-- How many lines belong to a primitive below its own.
local function lines_below(source, name, rest)
  if name == "c" then return 2 end
  return source:whole(rest, ("the number of corners of %s"):format(name), 3)
end

local function pass_over(picture, source, name, rest)
  if not picture.skip[name] then
    source:fail(("a primitive that glint has (%s are none; skip = { %s = true } passes over them)"):format(
      NAMES[name], name), name .. rest)
  end
  for _ = 1, lines_below(source, name, rest) do
    if not next_line(source) then source:fail(("a line of %s"):format(name), nil) end
  end
  picture.skipped[name] = (picture.skipped[name] or 0) + 1
end

local function add_lights(picture)
  local share = 1 / math.sqrt(#picture.lights)
  for _, l in ipairs(picture.lights) do
    picture.scene:add(glint.point_light {
      position = { l[1], l[2], l[3] }, color = l[4] and { l[4], l[5], l[6] } or share,
    })
  end
end

local function finish(picture, source)
  local view = picture.view
  if not view.from then source:fail("v (a view)", nil) end
  picture.scene = glint.scene {
    camera = glint.camera { eye = view.from, at = view.at, up = view.up, fov = view.angle[1] },
    background = picture.background,
  }
  picture.width, picture.height = view.resolution[1], view.resolution[2]
  add_lights(picture)
  if picture.set.count > 0 then picture.scene:add(picture.set:spheres()) end
  return picture
end

--- Reads a file into a scene. Errors have file and line. Memory: see glint.particles.
---@param path string
---@param options? { skip: table<string, boolean>, format: string }  skip: p, pp, c; format: of the spheres
---@return table picture  scene, width, height, skipped, material_count, set (of glint.particles, with its count)
function nff.load(path, options)
  local source = lines.open(path)
  local kinds = {}
  local picture = {
    view = {}, lights = {}, kinds = kinds, material_count = 0, background = { 0, 0, 0 }, skipped = {},
    skip = options and options.skip or {},
    set = particles.new { kinds = kinds, format = options and options.format },
  }
  for line in next_line, source do
    local name, rest = line:match "^%s*(%a+)(.*)$"
    if read[name] then
      read[name](picture, source, rest)
    elseif NAMES[name] then
      pass_over(picture, source, name, rest)
    else
      source:fail("v, b, l, f, s, p, pp, c or #", line)
    end
  end
  return finish(picture, source)
end

return nff
