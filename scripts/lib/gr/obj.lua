-- Models: reads the `v`, `vt` and `f` lines of .obj files, as the course's programs do, with textures. Normals
-- and all other lines are ignored. `require "readobj"` provides the course's function if the scene has no such
-- file.
local check = require "gr.check"
local files = require "gr.files"
check.own_source()
local obj = {}

local lines, open, tonumber = io.lines, io.open, tonumber
local raise, tointeger = check.raise, math.tointeger

local MODEL_MAX = 1 << 30

local function find(call, path)
  local found, places = files.find(path)
  if not found then raise("%s: '%s': no such file; looked for %s", call, path, places) end
  local file <close> = open(found, "rb")
  if file and file:seek "end" > MODEL_MAX then
    raise("%s: %s: a model of at most %d bytes expected", call, found, MODEL_MAX)
  end
  return found
end

local function read_vertex(text, place)
  local x, y, z = text:match "^(%S+)%s+(%S+)%s+(%S+)"
  x, y, z = tonumber(x), tonumber(y), tonumber(z)
  if not (x and y and z) or x - x ~= 0 or y - y ~= 0 or z - z ~= 0 then
    raise("%s: three numbers expected, got '%s'", place, text)
  end
  return x, y, z
end

local function read_coordinates(text, place)
  local u, v = text:match "^(%S+)%s*(%S*)"
  u, v = tonumber(u), v == "" and 0 or tonumber(v)
  if not (u and v) or u - u ~= 0 or v - v ~= 0 then raise("%s: two numbers expected, got '%s'", place, text) end
  return { u, v }
end

-- Reads a face as a list of vertex numbers from 0. In the file they count from 1, or backwards from the last vertex if
-- negative. face.uv has the texture coordinates of each corner, if all have some.
local function read_face(text, count, coordinates, place)
  local face, n, uv = {}, 0, #coordinates > 0 and {} or nil
  for word in text:gmatch "%S+" do
    local number = tointeger(tonumber(word:match "^[^/]*"))
    local vertex = number and (number < 0 and count + number or number - 1)
    if not vertex or number == 0 or vertex < 0 then
      raise("%s: numbers of vertices from 1 expected, got '%s'", place, text)
    end
    n = n + 1
    face[n] = vertex
    if uv then
      local which = tointeger(tonumber(word:match "^[^/]*/([^/]+)"))
      uv[n] = which and coordinates[which < 0 and #coordinates + 1 + which or which]
      if not uv[n] then uv = nil end
    end
  end
  face.uv = uv
  if n < 3 then raise("%s: 3 vertices or more expected, got '%s'", place, text) end
  return face
end

local function check_faces(faces, numbers, count, path)
  for i = 1, #faces do
    local face = faces[i]
    for j = 1, #face do
      if face[j] >= count then
        raise("%s: line %d: vertex 1 .. %d expected, got %d", path, numbers[i], count, face[j] + 1)
      end
    end
  end
end

--- Calls vertex(i, x, y, z) for each vertex; returns the faces, lists of numbers from 0.
function obj.read(call, path, vertex)
  local found = find(call, path)
  local faces, numbers, count, number, coordinates = {}, {}, 0, 0, {}
  for line in lines(found) do
    number = number + 1
    local word, text = line:match "^%s*([vf]t?)%s+([^#]-)%s*%f[#\0]"
    if word == "v" then
      count = count + 1
      vertex(count, read_vertex(text, found .. ": line " .. number))
    elseif word == "f" then
      faces[#faces + 1] = read_face(text, count, coordinates, found .. ": line " .. number)
      numbers[#faces] = number
    elseif word == "vt" then
      coordinates[#coordinates + 1] = read_coordinates(text, found .. ": line " .. number)
    end
  end
  check_faces(faces, numbers, count, found)
  if #faces == 0 then raise("%s: %s: faces expected, got %d vertices and none", call, found, count) end
  return faces
end

--- The course's readobj(file): returns a list of vertices and a list of faces, for gr.mesh.
function obj.readobj(path)
  local vertices = {}
  local faces = obj.read("readobj", check.text("readobj", "file", path), function(i, x, y, z)
    vertices[i] = { x, y, z }
  end)
  return vertices, faces
end

package.searchers[#package.searchers + 1] = function(name)
  if name ~= "readobj" then return nil end
  return function()
    _G.readobj = obj.readobj -- luacheck: ignore 122
    return obj.readobj
  end
end

return obj
