-- The `gr` dialect: Lua scenes of a graphics course, run unchanged. `glint --dialect gr SCENE.lua` runs one; under
-- plain Lua `lua5.4 -l gr SCENE.lua` does, or a script that sets the global: gr = require "gr"; dofile "SCENE.lua".
--
--   gr.node(name)  gr.joint(name, {3}, {3})             groups
--   gr.sphere(name)                                     radius 1 around the origin
--   gr.cube(name)                                       from (0,0,0) to (1,1,1)
--   gr.nh_sphere(name, {centre}, radius)
--   gr.nh_box(name, {corner}, edge)                     the corner of the smallest coordinates
--   gr.mesh(name, {vertices}, {faces})                  faces are lists of numbers from 0
--   gr.mesh(name, "model.obj")
--   gr.cylinder(name)                                   radius 1 around the z axis, from z = 0 to z = 1, closed
--   gr.cone(name)                                       base of radius 1 at z = 0, apex at z = 1, closed
--   gr.material({kd}, {ks}, shininess)
--   gr.light({position}, {colour}, {c0, c1, c2})        falls off by 1/(c0 + c1 r + c2 r^2); {1, 0, 0} when left out
--   gr.render(root, file, width, height, {eye}, {view}, {up}, fov, {ambient}, {lights})
--   node:add_child(n)  :set_material(m)  :scale(x, y, z)  :rotate("x"|"y"|"z", degrees)  :translate(x, y, z)
--
-- `gr` is the nodes' metatable: gr.scale(n, ...) is n:scale(...), and functions a scene adds to it are methods.
-- gr.options has what the course left open (scripts/lib/gr/options.lua); cylinder and cone stand as OpenGL's
-- gluCylinder does. A shape of radius or edge 0 and one that a
-- scale of 0 flattens have nothing to hit and do not show.
local check = require "gr.check"
check.own_source()
require "gr.lua5"()
local files = require "gr.files"
files.install()
local glint = require "glint"
local mesh = require "gr.mesh"
local options = require "gr.options"
local picture = require "gr.picture"

local abs, lower, max, min, setmetatable, type = math.abs, string.lower, math.max, math.min, setmetatable, type

local gr = { options = options }
gr.__index = gr

-- What the dialect's objects hold, by the objects: scenes see tables with nothing in them.
local nodes, materials, lights = {}, {}, {}
for _, kept in ipairs { nodes, materials, lights } do setmetatable(kept, { __mode = "k" }) end

local IDENTITY = glint.translate(0, 0, 0)

-- ---- Nodes ----

-- kind: what picture.lua makes of it, nil for a group; call: the function that made it.
local function new_node(call, name, node)
  node.name, node.call, node.children, node.places = check.text(call, "name", name), call, {}, {}
  node.pre, node.post = IDENTITY, IDENTITY -- the transform by either generation's order
  local object = setmetatable({}, gr)
  nodes[object] = node
  check.name_object(object, "node '" .. node.name .. "'")
  return object
end

local function node_of(call, argument, value)
  return nodes[value] or check.refuse(call, argument, "node", value)
end

function gr.node(name) return new_node("node", name, {}) end

function gr.joint(name, x, y)
  check.vector("joint", "x", x, 3)
  check.vector("joint", "y", y, 3)
  return new_node("joint", name, {})
end

function gr.sphere(name) return new_node("sphere", name, { kind = "sphere", center = { 0, 0, 0 }, radius = 1 }) end

function gr.cube(name) return new_node("cube", name, { kind = "box", min = { 0, 0, 0 }, max = { 1, 1, 1 } }) end

function gr.cylinder(name) return new_node("cylinder", name, { kind = "cylinder" }) end

function gr.cone(name) return new_node("cone", name, { kind = "cone" }) end

function gr.nh_sphere(name, center, radius)
  local node = { kind = "sphere", center = check.vector("nh_sphere", "centre", center, 3) }
  node.radius = abs(check.number("nh_sphere", "radius", radius)) -- the course squares it
  node.is_nothing = node.radius == 0
  return new_node("nh_sphere", name, node)
end

function gr.nh_box(name, corner, edge)
  corner = check.vector("nh_box", "corner", corner, 3)
  edge = check.number("nh_box", "edge", edge)
  local node = { kind = "box", is_nothing = edge == 0, min = {}, max = {} }
  for i = 1, 3 do
    node.min[i], node.max[i] = min(corner[i], corner[i] + edge), max(corner[i], corner[i] + edge)
  end
  return new_node("nh_box", name, node)
end

function gr.mesh(name, vertices, faces)
  local model
  if type(vertices) == "string" then
    model = mesh.of_file(vertices)
  elseif type(vertices) == "table" then
    model = mesh.of_tables(vertices, faces)
  else
    check.refuse("mesh", "vertices", "table, or the name of an .obj file,", vertices)
  end
  return new_node("mesh", name, { kind = "mesh", model = model })
end

-- ---- Methods ----

function gr.add_child(self, child)
  local node = node_of("add_child", "self", self)
  node.children[#node.children + 1] = node_of("add_child", "child", child)
end

function gr.set_material(self, material)
  local node = node_of("set_material", "self", self)
  if not node.kind then
    check.raise("gr.set_material: a shape expected, got the %s '%s', which has no surface", node.call, node.name)
  end
  node.material = materials[material] or check.refuse("set_material", "material", "material", material)
end

local function transform(node, map)
  node.pre, node.post = map * node.pre, node.post * map
end

local function read_three(call, x, y, z)
  return check.number(call, "x", x), check.number(call, "y", y), check.number(call, "z", z)
end

function gr.translate(self, x, y, z)
  transform(node_of("translate", "self", self), glint.translate(read_three("translate", x, y, z)))
end

function gr.scale(self, x, y, z)
  local node = node_of("scale", "self", self)
  x, y, z = read_three("scale", x, y, z)
  transform(node, glint.matrix { x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0 }) -- any of them may be 0
end

function gr.rotate(self, axis, degrees)
  local node = node_of("rotate", "self", self)
  local letter = type(axis) == "string" and lower(axis)
  if letter ~= "x" and letter ~= "y" and letter ~= "z" then
    check.refuse("rotate", "axis", '"x", "y" or "z"', axis)
  end
  transform(node, glint.rotate(letter, check.number("rotate", "degrees", degrees)))
end

-- ---- Materials, lights, pictures ----

-- Neither has methods in the dialect: one that a scene calls is a function that says so.
local function without_methods(kind)
  return { __index = function(_, name)
    if type(name) ~= "string" or name:sub(1, 2) == "__" then return nil end
    return function()
      check.raise("%s:%s: this method is not part of the dialect that glint runs", kind, name)
    end
  end }
end

local MATERIAL, LIGHT = without_methods "material", without_methods "light"

-- The model of the highlight. An exponent of 0 makes it 1 wherever a light reaches, as n.h > 0 has it; r.v is not
-- above 0 everywhere.
local function model_of(shininess)
  return (options.specular == "blinn" or shininess == 0) and "blinn_phong" or "phong"
end

function gr.material(kd, ks, shininess)
  kd, ks = check.vector("material", "kd", kd, 3, 0), check.vector("material", "ks", ks, 3, 0)
  local fields = { diffuse = kd, model = "lambert" }
  shininess = check.at_least("material", "shininess", shininess, 0)
  if max(ks[1], ks[2], ks[3]) > 0 then
    fields.model = model_of(shininess)
    fields.specular, fields.shininess = ks, shininess
  end
  local material = setmetatable({}, MATERIAL)
  materials[material] = { shade = glint.material(fields) }
  check.name_object(material, "material")
  return material
end

local function new_light(fields)
  local light = { shine = glint.point_light(fields) }
  local more = {} -- for lists that have it several times
  function light.again(n)
    more[n] = more[n] or glint.point_light(fields)
    return more[n]
  end
  return light
end

-- A fall-off of 0 everywhere divides by 0 in the course; this is as good as that once cut to codes.
local NO_FALLOFF = { 1e-30, 0, 0 }

function gr.light(position, colour, falloff, extra)
  if type(position) ~= "table" or type(extra) == "table" then
    check.raise("gr.light: {position}, {colour}, {fall-off} expected, got %s first and %s fourth: this is another "
      .. "variant of the dialect", check.spelling(position), check.spelling(extra))
  end
  local fields = { position = check.vector("light", "position", position, 3) }
  fields.color = check.vector("light", "colour", colour, 3, 0)
  if falloff ~= nil then
    fields.attenuation = check.vector("light", "fall-off", falloff, 3, 0)
    if max(fields.attenuation[1], fields.attenuation[2], fields.attenuation[3]) == 0 then
      fields.attenuation = NO_FALLOFF
    end
  end
  local light = setmetatable({}, LIGHT)
  lights[light] = new_light(fields)
  check.name_object(light, "light")
  return light
end

local function to_light(value) return lights[value] end

function gr.render(root, ...) picture.render(node_of("render", "root", root), to_light, ...) end

-- ---- What is not there ----

-- A name that is not the dialect's is a function that says so when it is called.
local function missing(_, name)
  if type(name) ~= "string" or name:sub(1, 2) == "__" then return nil end
  return function()
    check.raise("gr.%s: this function is not part of the dialect that glint runs", name)
  end
end

return setmetatable(gr, { __index = missing })
