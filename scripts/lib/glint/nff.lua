-- NFF, the Neutral File Format of Eric Haines' Standard Procedural Databases (SPD): v, b, l, f, s, p, pp.
--     local picture = nff.load "balls.nff"
--     return glint.animation { scene = picture.scene, width = picture.width, height = picture.height, ... }
-- What becomes of it: `angle` is the vertical field of view, `hither` is not needed; the colour of `f` times Kd is
-- diffuse, Ks the strength of a white highlight and Shine its exponent (no mirror); a light without a colour has the
-- intensity 1 / sqrt(number of lights). All spheres become one glint.spheres; the polygons of a material become one
-- glint.mesh, its patches (polygons with a normal a corner) another.
-- Refused with their line: cones and cylinders `c`, and T > 0 in `f`. With options.skip = { c = true } they are passed
-- over instead, and counted in picture.skipped.
local glint = require "glint"
local lines = require "glint.lines"
local particles = require "glint.particles"

local nff = {}

local VIEW = { { "from", 3 }, { "at", 3 }, { "up", 3 }, { "angle", 1 }, { "hither", 1 }, { "resolution", 2 } }

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

-- The polygons of the material at hand: `numbers` a corner, 3 without and 6 with a normal.
local function bunch_of(picture, name)
  local key = name .. picture.material
  local bunch = picture.bunches[key]
  if not bunch then
    bunch = {
      material = picture.kinds[picture.material].material,
      vertices = {}, normals = name == "pp" and {} or nil, faces = {}, lines = {}, corners = 0,
    }
    picture.bunches[key] = bunch
    picture.bunches[#picture.bunches + 1] = bunch
  end
  return bunch
end

local function read_polygon(picture, source, name, rest)
  if not picture.material then source:fail("f (a material) before the first primitive", name .. rest) end
  local count = source:whole(rest, "the number of corners of " .. name, 3)
  local bunch, face, line_number = bunch_of(picture, name), {}, source.number
  for corner = 1, count do
    local what = ("corner %d of %d"):format(corner, count)
    local line = next_line(source)
    if not line then source:fail(what, nil) end
    local list = numbers(source, line, what, bunch.normals and 6 or 3)
    bunch.corners = bunch.corners + 1
    bunch.vertices[bunch.corners] = ("ddd"):pack(list[1], list[2], list[3])
    if bunch.normals then bunch.normals[bunch.corners] = ("ddd"):pack(list[4], list[5], list[6]) end
    face[corner] = bunch.corners
  end
  bunch.faces[#bunch.faces + 1], bunch.lines[#bunch.lines + 1] = face, line_number
  picture.polygon_count = picture.polygon_count + 1
end

function read.p(picture, source, rest) read_polygon(picture, source, "p", rest) end
function read.pp(picture, source, rest) read_polygon(picture, source, "pp", rest) end

function read.c(picture, source, rest)
  if not picture.skip.c then
    source:fail("a primitive that glint reads (cones and cylinders are none; skip = { c = true } passes over them)",
      "c" .. rest)
  end
  for _ = 1, 2 do
    if not next_line(source) then source:fail("the two ends of c", nil) end
  end
  picture.skipped.c = (picture.skipped.c or 0) + 1
end

-- The engine looks at the shapes of polygons when it has all of them: its message names the face, ours the line.
local function add_meshes(picture, source)
  for _, bunch in ipairs(picture.bunches) do
    local ok, mesh = pcall(glint.mesh, {
      vertices = table.concat(bunch.vertices), normals = bunch.normals and table.concat(bunch.normals),
      format = "f64", faces = bunch.faces, material = bunch.material,
    })
    if not ok then
      local face, message = mesh:match "mesh%.faces%[(%d+)%]: (.*)"
      error(("%s:%d: %s"):format(source.path, bunch.lines[tonumber(face)] or bunch.lines[1], message or mesh), 0)
    end
    picture.scene:add(mesh)
  end
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
  add_meshes(picture, source)
  if picture.set.count > 0 then picture.scene:add(picture.set:spheres()) end
  return picture
end

--- Reads a file into a scene. Errors have file and line. Memory: see glint.particles.
---@param path string
---@param options? { skip: { c: boolean }, format: string }  format: of the spheres, "f64" (default) or "f32"
---@return table picture  scene, width, height, skipped, material_count, polygon_count, set (of
--- glint.particles, with its count)
function nff.load(path, options)
  local source = lines.open(path)
  local kinds = {}
  local picture = {
    view = {}, lights = {}, kinds = kinds, material_count = 0, polygon_count = 0, bunches = {},
    background = { 0, 0, 0 }, skipped = {},
    skip = options and options.skip or {},
    set = particles.new { kinds = kinds, format = options and options.format },
  }
  for line in next_line, source do
    local name, rest = line:match "^%s*(%a+)(.*)$"
    if read[name] then
      read[name](picture, source, rest)
    else
      source:fail("v, b, l, f, s, p, pp, c or #", line)
    end
  end
  return finish(picture, source)
end

return nff
