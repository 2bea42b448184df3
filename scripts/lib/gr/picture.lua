-- gr.render: makes a glint scene and its picture from the graph of nodes.
--
-- The graph is traversed at every call, so that changes to a shared node appear under all its parents. Each place where
-- a shape appears is a separate glint shape that lives as long as the node. A picture with the same places as the
-- previous one uses the same glint scene, with the changes applied.
local check = require "gr.check"
local generation = require "gr.generation"
local glint = require "glint"
local mesh = require "gr.mesh"
local options = require "gr.options"
local surface = require "gr.surface"
check.own_source()
local picture = {}

local error, ipairs, pairs, pcall, select, type, utf8 = error, ipairs, pairs, pcall, select, type, utf8
local floor, unpack = math.floor, table.unpack

local MOST_SHAPES = 1 << 22

-- ---- The places of shapes ----

local OPEN = -1

-- A combined solid is one shape; its parts are only checked for cycles and meshes.
local function below(node)
  if not node.parts then return node.children end
  local list = {}
  for _, part in ipairs(node.parts) do list[#list + 1] = part end
  for _, child in ipairs(node.children) do list[#list + 1] = child end
  return list
end

-- Counts how often a shape appears under each node. Raises if a node contains itself.
local function count_shapes(root)
  local count, stack = {}, { root }
  while #stack > 0 do
    local node = stack[#stack]
    if not count[node] then
      count[node] = OPEN
      for _, child in ipairs(below(node)) do
        if count[child] == OPEN then check.raise("gr.render: node '%s' contains itself", child.name) end
        if not count[child] then stack[#stack + 1] = child end
      end
    else
      if count[node] == OPEN then
        local sum = node.kind and 1 or 0
        for _, child in ipairs(node.children) do sum = sum + count[child] end
        count[node] = sum
      end
      stack[#stack] = nil
    end
  end
  if count[root] > MOST_SHAPES then
    check.raise("gr.render: at most %d shapes expected, got %.14g, counting each place of a shape",
      MOST_SHAPES, count[root])
  end
  return count
end

-- Returns 1 or 2 by the kind of the graph's meshes, nil without meshes.
local function generation_of_meshes(count)
  local found
  for node in pairs(count) do
    if node.kind == "mesh" and node.model.generation then
      if found and found ~= node.model.generation then return nil end
      found = node.model.generation
    end
  end
  return found
end

-- Calls visit(node, map) for each place of a shape, in the order of a traversal from the root.
local function walk(root, order, count, visit)
  local nodes, maps, top = { root }, { false }, 1
  while top > 0 do
    local node, map = nodes[top], maps[top]
    nodes[top], maps[top], top = nil, nil, top - 1
    map = map and map * node[order] or node[order]
    if node.kind then visit(node, map) end
    for i = #node.children, 1, -1 do
      local child = node.children[i]
      if count[child] > 0 then
        top = top + 1
        nodes[top], maps[top] = child, map
      end
    end
  end
end

-- ---- glint shapes ----

local function cut_name(name)
  while #name > 63 or not utf8.len(name) do name = name:sub(1, -2) end
  return (name:gsub("%c", " "))
end

local AXES = { x = { 1, 0, 0 }, y = { 0, 1, 0 }, z = { 0, 0, 1 } }

-- Shapes that become a glint shape with its own transform.
local makers = {
  sphere = function(fields, node)
    fields.center, fields.radius = node.center, node.radius
    return glint.sphere(fields)
  end,
  box = function(fields, node)
    fields.min, fields.max = node.min, node.max
    return glint.box(fields)
  end,
  cylinder = function(fields, node)
    fields.base, fields.top, fields.radius = { 0, 0, 0 }, AXES[node.axis], 1
    return glint.cylinder(fields)
  end,
  cone = function(fields, node)
    fields.base, fields.top, fields.radius = { 0, 0, 0 }, AXES[node.axis], 1
    return glint.cone(fields)
  end,
  torus = function(fields, node)
    fields.center, fields.axis, fields.major, fields.minor = node.center, { 0, 0, 1 }, node.ring, node.tube
    return glint.torus(fields)
  end,
}

-- Raises errors of the engine as errors of the scene.
local function fail(message)
  if type(message) ~= "string" then error(message, 0) end
  check.raise("gr.render: %s", (message:gsub("^[^:]*:%d+: ", "")))
end

local function engine(call, ...)
  local good, result = pcall(call, ...)
  return good and result or good or fail(result)
end

-- Makes or changes a shape; nil if the map flattens space: flat shapes cannot be hit.
local function try(change, ...)
  local good, result = pcall(change, ...)
  if good then return result end
  if type(result) ~= "string" or not result:find "flattens space" then fail(result) end
end

-- Returns the material of a place: the node's, with the layers of the shape.
local function shade_of(node, map)
  local bare = node.kind == "mesh" and not mesh.has_coordinates(node.model)
  local record = node.material or surface.plain(node.picture)
  node.material = record
  if bare and (node.picture or node.relief or record.relief or record.picture and record.picture.photo) then
    check.tell(node, "gr.render: mesh '%s' has no texture coordinates (vt, in all faces of its file), "
      .. "so it shows no picture", node.name)
  end
  return surface.shade(record, node, map, bare)
end

local function make_shape(node, map)
  local fields = { material = shade_of(node, map), two_sided = false, name = cut_name(node.name), transform = map }
  return makers[node.kind](fields, node)
end

-- Makes a group with the transform, because all places of a mesh share its shape.
local function make_mesh_place(node, map) return glint.group { node.mesh_shape, transform = map } end

-- Returns whether the mesh has anything to hit.
local function has_mesh(node)
  if node.mesh_shape == nil then node.mesh_shape = mesh.shape(node.model, cut_name(node.name)) or false end
  return node.mesh_shape ~= false
end

local function set_map(shape, map)
  if shape.transform ~= map then shape.transform = map end
  return shape
end

-- Returns the shape of the n-th place of the node; nil if there is nothing to hit.
local function place_of(node, n, map)
  local is_mesh = node.kind == "mesh"
  if node.is_nothing or is_mesh and not has_mesh(node) then return nil end
  local shape = node.places[n]
  if shape then
    shape = try(set_map, shape, map)
  else
    shape = try(is_mesh and make_mesh_place or make_shape, node, map)
    node.places[n] = shape
  end
  local painted = is_mesh and node.mesh_shape or shape
  local shade = painted and (not is_mesh or n == 1) and shade_of(node, map)
  if shade and painted.material ~= shade then painted.material = shade end
  return shape
end

-- ---- Combined solids ----

local function need_material(node)
  if not node.material and not node.picture then
    check.raise("gr.render: %s '%s' has no material; set_material gives it one", node.call, node.name)
  end
end

local combine

-- Returns a shape in a combined solid; nil if it is empty. dressed: the solid has a material.
local function part_of(node, order, count, map, dressed)
  if node.kind == "combined" then return combine(node, order, count, map, dressed) end
  if node.is_nothing then return nil end
  if not dressed then need_material(node) end
  local plain = not node.material and not node.picture
  if node.kind == "mesh" then
    if not has_mesh(node) then return nil end
    node.mesh_shape.material = not plain and shade_of(node, map) or nil
    return try(make_mesh_place, node, map)
  end
  local fields = { material = not plain and shade_of(node, map) or nil, name = cut_name(node.name), transform = map }
  return try(makers[node.kind], fields, node)
end

local function check_parts(node)
  if not node.operation then
    check.raise("gr.render: csg '%s' has no operation; setCSGType and set_csg_children give it one", node.name)
  elseif #node.parts < 2 then
    check.raise("gr.render: %s '%s' has %d of its two parts; add_child gives it more", node.call, node.name,
      #node.parts)
  end
end

-- Makes one solid from the shapes under each of the node's parts.
function combine(node, order, count, map, dressed)
  check_parts(node)
  local own = node.material or node.picture
  local fields = { two_sided = false, name = cut_name(node.name), transform = map }
  if own then fields.material = shade_of(node, map) end
  for i, part in ipairs(node.parts) do
    local list = {}
    if count[part] > 0 then
      walk(part, order, count, function(n, at)
        list[#list + 1] = part_of(n, order, count, at, dressed or own)
      end)
    end
    fields[i] = #list == 1 and list[1] or engine(glint.group, list)
  end
  return try(glint[node.operation], fields)
end

-- ---- The scene ----

local last = { members = {} } -- the scene of the previous picture, and its objects

local function has_members(members)
  if not last.scene or #members ~= #last.members then return false end
  for i = 1, #members do
    if members[i] ~= last.members[i] then return false end
  end
  return true
end

local function members_of(root, order, count, lights)
  local members, seen = {}, {}
  walk(root, order, count, function(node, map)
    if node.kind == "combined" then -- combined solids are made again for each picture
      members[#members + 1] = combine(node, order, count, map)
      return
    end
    need_material(node)
    seen[node] = (seen[node] or 0) + 1
    members[#members + 1] = place_of(node, seen[node], map)
  end)
  local had = {}
  for _, light in ipairs(lights) do
    members[#members + 1] = had[light] and light.again(had[light]) or light.shine
    had[light] = (had[light] or 0) + 1
  end
  return members
end

local function scene_of(root, lights)
  local count = count_shapes(root)
  local order = options.order or generation.order(generation_of_meshes(count))
  local members = members_of(root, order, count, lights)
  if not has_members(members) then
    last.scene = engine(glint.scene, members)
    last.members = members
  end
  return last.scene
end

-- ---- The arguments ----

local function read_side(name, value)
  local side = check.number("render", name, value)
  side = floor(side)
  if side < 1 or side > 65535 then check.refuse("render", name, "pixels 1 .. 65535", value) end
  return side
end

local function read_direction(name, value)
  local direction = check.vector("render", name, value, 3)
  if direction[1] == 0 and direction[2] == 0 and direction[3] == 0 then
    check.raise("gr.render: %s: a direction other than {0, 0, 0} expected", name)
  end
  return direction
end

local function read_fov(value)
  local fov = check.number("render", "fov", value)
  if not (fov > 0 and fov < 180) then check.refuse("render", "fov", "degrees between 0 and 180", value) end
  return fov
end

-- Reads the name of the file, and escapes what would be a place for a number.
local function read_file(value)
  local name = check.text("render", "file", value)
  if name == "" or name:find "/$" then check.refuse("render", "file", "name of a file", value) end
  if not name:lower():find "%.png$" then name = name .. ".png" end
  return (name:gsub("%%", "%%%%"):gsub("#", "%%#"))
end

-- Adds a list of lights to `lights`.
local function read_lights(lights, value, to_light)
  check.list("render", "lights", value)
  for i = 1, #value do
    local light = to_light(value[i])
    if not light then check.refuse("render", "lights[" .. i .. "]", "light", value[i]) end
    lights[#lights + 1] = light
  end
end

-- In variants area lights have a separate list, and further numbers.
local function read_more(lights, to_light, ...)
  local others, count = {}, 0
  for i = 1, select("#", ...) do
    local value = select(i, ...)
    if type(value) == "table" and to_light(value[1]) then
      read_lights(lights, value, to_light)
    else
      count = count + 1
      others[count] = value
    end
  end
  check.left_out("render", unpack(others, 1, count))
end

--- gr.render. to_light: returns the light made by gr.light for a value, or nil.
function picture.render(root, to_light, file, width, height, eye, view, up, fov, ambient, lights, ...)
  local options_of_picture = { transfer = "none", rounding = "truncate" }
  options_of_picture.output = read_file(file)
  options_of_picture.width = read_side("width", width)
  options_of_picture.height = read_side("height", height)
  local camera = { pixel_offset = options.pixel }
  camera.eye = check.vector("render", "eye", eye, 3)
  camera.direction = read_direction("view", view)
  camera.up = read_direction("up", up)
  camera.fov = read_fov(fov)
  ambient = check.vector("render", "ambient", ambient, 3, 0)
  local shining = {}
  read_lights(shining, lights, to_light)
  read_more(shining, to_light, ...)
  local scene = scene_of(root, shining)
  scene.camera = engine(glint.camera, camera)
  scene.ambient = ambient
  scene.background = options.background
  engine(scene.render, scene, options_of_picture)
end

return picture
