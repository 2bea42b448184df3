-- NFF, the Neutral File Format of Eric Haines' Standard Procedural Databases (SPD): v, b, l, f, s, p, pp, c.
--     local picture = nff.load "balls.nff"
--     return glint.animation { scene = picture.scene, width = picture.width, height = picture.height, ... }
-- The entries: `angle` is the vertical field of view, `hither` is ignored; the colour of `f` times Kd is diffuse, Ks is
-- the strength of a white highlight with the exponent Shine, and of the mirror; T, with the index of refraction, is
-- transmission; options.mirrors = false omits mirror and transmission. A light without a colour has the intensity 1 /
-- sqrt(number of lights). All spheres become one glint.spheres. The polygons of each material become one glint.mesh,
-- its patches (polygons with normals) another. Cones and cylinders are open; a truncated cone is a mesh of 128 sides
-- with smooth normals.
local glint = require "glint"
local lines = require "glint.lines"
local particles = require "glint.particles"

local nff = {}

local SIDES = 128 -- sides of a truncated cone

local VIEW = { { "from", 3 }, { "at", 3 }, { "up", 3 }, { "angle", 1 }, { "hither", 1 }, { "resolution", 2 } }

-- Reads the numbers of a text, between `least` and `most` of them.
local function numbers(source, text, what, least, most)
  local list = {}
  for word in text:gmatch "%S+" do list[#list + 1] = source:number_of(word, what) end
  if #list < least or #list > (most or least) then
    source:fail(("%s: %s numbers"):format(what, most and least .. " to " .. most or least), text)
  end
  return list
end

local read = {} -- by the first word of a line: function(picture, source, the rest of the line)

function read.v(picture, source, rest)
  if rest:find "%S" then source:fail("nothing after v in its line", rest) end
  for _, item in ipairs(VIEW) do
    local name, count = item[1], item[2]
    local line = source:next_full()
    local text = (line or ""):match("^%s*" .. name .. "%s(.*)")
    if not text then source:fail(("%s: %d numbers"):format(name, count), line) end
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
  local r, g, b, kd, ks, shine, t, ior = table.unpack(numbers(source, rest, "f (r g b Kd Ks Shine T index)", 8))
  if math.min(r, g, b, kd, ks, shine, t) < 0 then source:fail("no negative number in f", rest) end
  if t > 0 and ior <= 0 then source:fail("an index of refraction > 0 where T is above 0", rest) end
  local label = "f" .. picture.material_count + 1
  picture.material_count = picture.material_count + 1
  local fields = { diffuse = { r * kd, g * kd, b * kd }, specular = ks, shininess = shine }
  if picture.mirrors then
    fields.mirror, fields.transmission, fields.ior = ks, t, t > 0 and ior or nil
  end
  picture.kinds[label] = { radius = 1, material = glint.material(fields) }
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

-- Returns the polygons of the current material: `numbers` for each corner, 3 without and 6 with a normal.
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
    local line = source:next_full()
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

local function unit(x, y, z)
  local length = math.sqrt(x * x + y * y + z * z)
  return { x / length, y / length, z / length }, length
end

local function cross(a, b)
  return unit(a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1])
end

-- Makes the side of a truncated cone, from ring a to ring b, each { x, y, z, radius }: quads with the cone's normals.
local function cut_cone(a, b, material)
  local w, length = unit(b[1] - a[1], b[2] - a[2], b[3] - a[3])
  local u = cross(w, math.abs(w[1]) < 0.6 and { 1, 0, 0 } or { 0, 1, 0 })
  local v, slope = cross(w, u), (a[4] - b[4]) / length
  local vertices, normals, faces = {}, {}, {}
  for k = 0, SIDES - 1 do
    local angle, out = 2 * math.pi * k / SIDES, {}
    for i = 1, 3 do out[i] = u[i] * glint.cos(angle) + v[i] * glint.sin(angle) end
    for _, ring in ipairs { a, b } do
      local n = #vertices + 1
      vertices[n], normals[n] = {}, {}
      for i = 1, 3 do
        vertices[n][i] = ring[i] + ring[4] * out[i]
        normals[n][i] = out[i] + slope * w[i]
      end
    end
    local here, after = 2 * k + 1, 2 * ((k + 1) % SIDES) + 1
    faces[k + 1] = { here, after, after + 1, here + 1 }
  end
  return glint.mesh { vertices = vertices, normals = normals, faces = faces, shading = "phong", material = material }
end

function read.c(picture, source, rest)
  if rest:find "%S" then source:fail("nothing after c in its line", rest) end
  if not picture.material then source:fail("f (a material) before the first primitive", "c") end
  local ends = {}
  for i, what in ipairs { "the base of c, x y z radius", "the apex of c, x y z radius" } do
    local line = source:next_full()
    if not line then source:fail(what, nil) end
    ends[i] = numbers(source, line, what, 4)
    if ends[i][4] < 0 then source:fail("a radius >= 0", line) end
  end
  local base, apex = ends[1], ends[2]
  if base[4] == 0 and apex[4] == 0 then source:fail("a radius > 0 at one of the ends of c", "0") end
  if base[1] == apex[1] and base[2] == apex[2] and base[3] == apex[3] then
    source:fail("an apex of c that differs from its base", "the same")
  end
  if base[4] < apex[4] then base, apex = apex, base end
  local material, shape = picture.kinds[picture.material].material
  local fields = { base = { base[1], base[2], base[3] }, top = { apex[1], apex[2], apex[3] }, radius = base[4],
    capped = false, material = material }
  if base[4] == apex[4] then
    shape = glint.cylinder(fields)
  elseif apex[4] == 0 then
    shape = glint.cone(fields)
  else
    shape = cut_cone(base, apex, material)
  end
  picture.cones[#picture.cones + 1] = shape
end

-- Adds the meshes. The engine checks polygons when it has all of them: its message names the face, ours the line.
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
  if #picture.cones > 0 then picture.scene:add(glint.group(picture.cones)) end
  if picture.set.count > 0 then picture.scene:add(picture.set:spheres()) end
  return picture
end

--- Reads a file into a scene. Errors have file and line. Memory: see glint.particles.
---@param path string
---@param options? { mirrors: boolean, format: string }  mirrors: reads mirrors and glass, default true; format: of
--- the spheres, "f64" (default) or "f32"
---@return table picture  scene, width, height, material_count, polygon_count, cones (a list of shapes), set (of
--- glint.particles, with its count)
function nff.load(path, options)
  local source = lines.open(path)
  local kinds = {}
  local picture = {
    view = {}, lights = {}, kinds = kinds, material_count = 0, polygon_count = 0, bunches = {},
    background = { 0, 0, 0 }, cones = {}, mirrors = not (options and options.mirrors == false),
    set = particles.new { kinds = kinds, format = options and options.format },
  }
  for line in source.next_full, source do
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
