-- Meshes: the numbers from the scene, and the glint.mesh made from them. Faces without an area are never hit and are
-- dropped. A face that crosses itself becomes a fan from its first corner.
local check = require "gr.check"
local glint = require "glint"
local obj = require "gr.obj"
check.own_source()
local mesh = {}

local ipairs, pcall, rawget, rawlen, setmetatable, tonumber, type =
  ipairs, pcall, rawget, rawlen, setmetatable, tonumber, type
local floor = math.floor
local loaded = {} -- models by their names in the scene
local uv_of = setmetatable({}, { __mode = "k" }) -- texture coordinates of each face's corners

-- Returns twice the area vector of a polygon; corners are indices in the flat list of coordinates.
local function area(numbers, corners)
  local a = corners[1]
  local ax, ay, az = numbers[a], numbers[a + 1], numbers[a + 2]
  local x, y, z = 0, 0, 0
  local b = corners[2]
  local bx, by, bz = numbers[b] - ax, numbers[b + 1] - ay, numbers[b + 2] - az
  for i = 3, #corners do
    local c = corners[i]
    local cx, cy, cz = numbers[c] - ax, numbers[c + 1] - ay, numbers[c + 2] - az
    x, y, z = x + (by * cz - bz * cy), y + (bz * cx - bx * cz), z + (bx * cy - by * cx)
    bx, by, bz = cx, cy, cz
  end
  return x, y, z
end

local function has_area(numbers, corners)
  local x, y, z = area(numbers, corners)
  return x ~= 0 or y ~= 0 or z ~= 0
end

-- Makes the model from the flat list of coordinates and the faces, lists of numbers from 0. Its faces count from 1, in
-- a flat list if all are triangles.
local function new_model(numbers, faces, generation)
  local model = { vertices = numbers, generation = generation, faces = {}, polygons = {}, uv = {} }
  local triangles, polygons = model.faces, model.polygons
  local places, n = {}, 0
  for i = 1, #faces do
    local face = faces[i]
    local size = #face
    for j = 1, size do places[j] = 3 * face[j] + 1 end
    for j = size + 1, #places do places[j] = nil end
    if not has_area(numbers, places) then goto next end
    if model.uv and not face.uv then model.uv = nil end
    if size == 3 then
      triangles[n + 1], triangles[n + 2], triangles[n + 3] = face[1] + 1, face[2] + 1, face[3] + 1
      for j = 1, model.uv and 3 or 0 do model.uv[n + j] = face.uv[j] end
      n = n + 3
    else
      local corners = {}
      uv_of[corners] = face.uv
      for j = 1, size do corners[j] = face[j] + 1 end
      polygons[#polygons + 1] = corners
    end
    ::next::
  end
  return model
end

local function read_vertex(vertex, i)
  if type(vertex) ~= "table" or rawlen(vertex) ~= 3 then
    check.refuse("mesh", "vertices[" .. i .. "]", "table of 3 numbers", vertex)
  end
  local x, y, z = rawget(vertex, 1), rawget(vertex, 2), rawget(vertex, 3)
  if type(x) ~= "number" or type(y) ~= "number" or type(z) ~= "number" or x - x ~= 0 or y - y ~= 0 or z - z ~= 0 then
    local read = check.vector("mesh", "vertices[" .. i .. "]", vertex, 3)
    return read[1], read[2], read[3]
  end
  return x, y, z
end

local function read_face(face, i, count)
  local name = "faces[" .. i .. "]"
  check.list("mesh", name, face)
  local size = rawlen(face)
  if size < 3 then check.refuse("mesh", name, "table of 3 numbers or more", face) end
  local out = {}
  for j = 1, size do
    local number = tonumber(rawget(face, j))
    local vertex = number and floor(number)
    if not vertex or not (vertex >= 0 and vertex < count) then
      check.refuse("mesh", name .. "[" .. j .. "]", "vertex 0 .. " .. count - 1, rawget(face, j))
    end
    out[j] = vertex
  end
  return out
end

--- Returns a parallelogram with texture coordinates, lit on both sides; nil if it has no area. It does not affect the
--- detection of the scene's generation.
function mesh.square(corner, u, v)
  local numbers = {}
  for i = 1, 3 do
    local a, b, c = corner[i], u[i], v[i]
    numbers[i], numbers[3 + i], numbers[6 + i], numbers[9 + i] = a, a + b, a + b + c, a + c
  end
  local lower = { 0, 1, 2, uv = { { 0, 0 }, { 1, 0 }, { 1, 1 } } }
  local upper = { 0, 2, 3, uv = { { 0, 0 }, { 1, 1 }, { 0, 1 } } }
  local model = new_model(numbers, { lower, upper })
  model.two_sided = true
  return #model.faces == 6 and model or nil
end

--- Returns a model from tables, as in the first generation.
function mesh.of_tables(vertices, faces)
  check.list("mesh", "vertices", vertices)
  check.list("mesh", "faces", faces)
  local numbers, read, count = {}, {}, rawlen(vertices)
  if count < 1 then check.refuse("mesh", "vertices", "1 vertex or more", vertices) end
  if rawlen(faces) < 1 then check.refuse("mesh", "faces", "1 face or more", faces) end
  for i = 1, count do
    numbers[3 * i - 2], numbers[3 * i - 1], numbers[3 * i] = read_vertex(rawget(vertices, i), i)
  end
  for i = 1, rawlen(faces) do read[i] = read_face(rawget(faces, i), i, count) end
  return new_model(numbers, read, 1)
end

--- Returns a model from a file, as in the second generation; reads it only once.
function mesh.of_file(path)
  if not loaded[path] then
    local numbers = {}
    local faces = obj.read("gr.mesh", path, function(i, x, y, z)
      numbers[3 * i - 2], numbers[3 * i - 1], numbers[3 * i] = x, y, z
    end)
    loaded[path] = new_model(numbers, faces, 2)
  end
  return loaded[path]
end

local function try(vertices, faces, name, uv, two_sided)
  return pcall(glint.mesh,
    { vertices = vertices, faces = faces, uv = uv, shading = "faceted", two_sided = two_sided or false, name = name })
end

local function add_fan(faces, corners, numbers)
  local uv = uv_of[corners]
  for i = 2, #corners - 1 do
    local a, b, c = corners[1], corners[i], corners[i + 1]
    if has_area(numbers, { 3 * a - 2, 3 * b - 2, 3 * c - 2 }) then
      local face = { a, b, c }
      faces[#faces + 1] = face
      uv_of[face] = uv and { uv[1], uv[i], uv[i + 1] }
    end
  end
end

-- Returns whether the polygon crosses itself, by the engine's own test.
local function is_crossed(numbers, corners)
  local own, face = {}, {}
  for i, corner in ipairs(corners) do
    for c = 1, 3 do own[3 * i - 3 + c] = numbers[3 * corner - 3 + c] end
    face[i] = i
  end
  return not try(own, { face }, "")
end

-- Returns triangles and polygons in one list; with `fans`, self-crossing ones become fans.
local function all_faces(model, fans)
  local faces, flat, uv = {}, model.faces, model.uv
  for i = 1, #flat, 3 do
    local face = { flat[i], flat[i + 1], flat[i + 2] }
    faces[#faces + 1] = face
    uv_of[face] = uv and { uv[i], uv[i + 1], uv[i + 2] }
  end
  for _, corners in ipairs(model.polygons) do
    if fans and is_crossed(model.vertices, corners) then
      add_fan(faces, corners, model.vertices)
    else
      faces[#faces + 1] = corners
    end
  end
  return faces
end

-- Returns texture coordinates, a pair for each corner in the order of the faces; nil if a face has none.
local function coordinates_of(model, faces)
  local uv = {}
  if not model.uv then return nil end
  if faces == model.faces then return model.uv end
  for _, face in ipairs(faces) do
    for i = 1, #face do uv[#uv + 1] = uv_of[face][i] end
  end
  return uv
end

--- Returns whether the mesh can have a texture.
function mesh.has_coordinates(model) return model.uv ~= nil end

--- Returns a new glint.mesh, or nil if no face has an area.
function mesh.shape(model, name)
  local flat = #model.polygons == 0
  local faces = flat and model.faces or all_faces(model, false)
  if #faces == 0 then return nil end
  local good, shape = try(model.vertices, faces, name, coordinates_of(model, faces), model.two_sided)
  if not good and not flat and shape:find "cross itself" then
    faces = all_faces(model, true)
    good, shape = try(model.vertices, faces, name, coordinates_of(model, faces))
  end
  if not good then check.raise("gr.mesh: '%s': %s", name, (shape:gsub("^.-mesh%.", ""))) end
  return shape
end

return mesh
