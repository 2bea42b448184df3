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
--   gr.cylinder(name)                                   radius 1 around gr.options.axis, from 0 to 1 along it, closed
--   gr.cone(name)                                       base of radius 1 at 0, apex at 1 of that axis, closed
--   gr.plane(name)                                      the square that gr.options.plane selects; lit on both sides
--   gr.plane(name, {corner}, {u}, {v}, width, height)   gr.plane(name, {middle}, {u}, {v}, edge)
--   gr.torus(name, tube, ring)                          around the z axis; radii; the ring's is 1 when left out
--   gr.nh_torus(name, {centre}, ring, tube)             the same
--   gr.union(name, a, b)  gr.intersection  gr.difference  one solid of two or more; csg_union, intersect, diff ...;
--                                                       the name is optional; add_child can add the parts
--   gr.csg(name, a, "+"|"*"|"-", b)  gr.csg(a, b, "diff")  gr.csg(name, "union")  gr.csg(name)  the same
--   csg:setCSGType("u"|"i"|"d")  csg:set_csg_children(a, b, "UNION"|"INTERSECT"|"DIFFERENCE")  node:add_children(a, b)
--   gr.material({kd}, {ks}, shininess)
--   gr.material({kd}, {ks}, shininess, r, t, n)         further forms are in the manual
--   gr.reflective_material(...)  gr.material_refl(...)  gr.material_refr(...)  gr.reflective()  gr.refractive(n)
--   gr.perlin_material({a}, {b}, {ks}, shininess)       two colours, mixed by noise
--   gr.texture(file, u, v)  gr.texture(file, {ks}, shininess)  gr.texture_material(...)  gr.texture_map(file)
--   gr.bump(file, height)  gr.bumpmap  gr.bump_map      gr.bump(material, file)
--   gr.normal_map(file, strength, u, v)  gr.perlin(...)
--   gr.light({position}, {colour}, {c0, c1, c2})        falls off by 1/(c0 + c1 r + c2 r^2); {1, 0, 0} when left out
--   gr.area_light({position}, {colour}, {c0, c1, c2}, radius, samples)                a ball; arealight, sphericallight
--   gr.area_light({middle}, {colour}, {c0, c1, c2}, {normal}, {up}, edge, samples)    a square
--   gr.area_light({corner}, {edge}, n, {edge}, m, {colour}, {c0, c1, c2})             n * m samples of a parallelogram
--   gr.rect_light({middle}, width, depth, {colour}, {c0, c1, c2}, samples)            along x and z
--   gr.render(root, file, width, height, {eye}, {view}, {up}, fov, {ambient}, {lights}, {lights} ...)
--   material:set_texture(t)  :set_bump(b)  :set_bumpmap(b)  :set_reflect(r)  :reflection(r)  :set_refract(n)
--   :set_ri(n)  :set_opacity(a, n)
--   node:set_texture(t)  :set_texture_map(t)  :set_bump(b)  :set_bumpmap(b)  :set_bump_map(b)  :set_normal(n)
--   :set_perlin(p)
--   node:add_child(n)  :set_material(m)  :scale(x, y, z)  :rotate("x"|"y"|"z", degrees)  :translate(x, y, z)
--
-- `gr` is the nodes' metatable: gr.scale(n, ...) is n:scale(...), and functions a scene adds to it are methods.
-- gr.options has the choices that the course left open (scripts/lib/gr/options.lua). By default cylinder and cone are
-- placed as in OpenGL's gluCylinder, a torus as in glutSolidTorus. A shape of radius or edge 0, or flattened by a scale
-- of 0, is never hit and does not show.
local check = require "gr.check"
check.own_source()
require "gr.lua5"()
local files = require "gr.files"
files.install()
local glint = require "glint"
local lamp = require "gr.lamp"
local mesh = require "gr.mesh"
local operations = require "gr.operations"
local options = require "gr.options"
local picture = require "gr.picture"
local surface = require "gr.surface"

local abs, lower, max, min, setmetatable, type = math.abs, string.lower, math.max, math.min, setmetatable, type
local pairs, select = pairs, select

local gr = { options = options }
gr.__index = gr

-- The data of the dialect's objects, by object: scenes only see empty tables.
local nodes, materials, lights, pictures, reliefs = {}, {}, {}, {}, {}
for _, kept in ipairs { nodes, materials, lights, pictures, reliefs } do setmetatable(kept, { __mode = "k" }) end

local IDENTITY = glint.translate(0, 0, 0)

-- ---- Nodes ----

-- Makes a node. kind: what picture.lua makes from it, nil for a group; call: the function that made it.
local function new_node(call, name, node)
  node.name, node.call, node.children, node.places = check.text(call, "name", name), call, {}, {}
  node.pre, node.post = IDENTITY, IDENTITY -- the transform in the order of each generation
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

function gr.cylinder(name) return new_node("cylinder", name, { kind = "cylinder", axis = options.axis }) end

function gr.cone(name) return new_node("cone", name, { kind = "cone", axis = options.axis }) end

local function radii_of(call, tube, ring)
  local node = { kind = "torus", tube = check.number(call, "tube", tube), ring = check.above(call, "ring", ring, 0) }
  if node.tube <= 0 or node.tube >= node.ring then
    check.refuse(call, "tube", ("number above 0 and below the ring's radius (%g)"):format(node.ring), tube)
  end
  return node
end

function gr.torus(name, tube, ring)
  local node = radii_of("torus", tube, ring == nil and 1 or ring)
  node.center = { 0, 0, 0 }
  return new_node("torus", name, node)
end

function gr.nh_torus(name, center, ring, tube)
  local node = radii_of("nh_torus", tube, ring)
  node.center = check.vector("nh_torus", "centre", center, 3)
  return new_node("nh_torus", name, node)
end

function gr.nh_sphere(name, center, radius)
  local node = { kind = "sphere", center = check.vector("nh_sphere", "centre", center, 3) }
  node.radius = abs(check.number("nh_sphere", "radius", radius)) -- the course squares the radius
  node.is_nothing, node.size = node.radius == 0, node.radius
  return new_node("nh_sphere", name, node)
end

function gr.nh_box(name, corner, edge)
  corner = check.vector("nh_box", "corner", corner, 3)
  edge = check.number("nh_box", "edge", edge)
  local node = { kind = "box", is_nothing = edge == 0, size = abs(edge), min = {}, max = {} }
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
    check.refuse("mesh", "vertices", "table or name of an .obj file", vertices)
  end
  return new_node("mesh", name, { kind = "mesh", model = model })
end

-- The unnumbered squares, by options.plane: the corner and the edges, left to right and upwards in a picture.
local PLANES = {
  ["xz"] = { { -0.5, 0, 0.5 }, { 1, 0, 0 }, { 0, 0, -1 } },
  ["xz-2"] = { { -1, 0, 1 }, { 2, 0, 0 }, { 0, 0, -2 } },
  ["xz-corner"] = { { 0, 0, 1 }, { 1, 0, 0 }, { 0, 0, -1 } },
  ["xy"] = { { -0.5, -0.5, 0 }, { 1, 0, 0 }, { 0, 1, 0 } },
  ["xy-2"] = { { -1, -1, 0 }, { 2, 0, 0 }, { 0, 2, 0 } },
  ["xy-corner"] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } },
}

local function plain_plane()
  if not options.plane then
    check.tell("plane", "gr.plane: other variants of the dialect have other squares; this one has edge 1, in the xz "
      .. "plane, with its middle at the origin. Choose one with --gr-plane: xz, xz-2, xz-corner, xy, xy-2, xy-corner")
  end
  local square = PLANES[options.plane or "xz"]
  return square[1], square[2], square[3]
end

-- Places a square from a corner with two lengths, or around a middle with one.
local function placed_plane(place, u, v, width, height)
  local name = height == nil and "middle" or "corner"
  local corner = check.vector("plane", name, place, 3)
  u, v = check.direction("plane", "u", u), check.direction("plane", "v", v)
  width = check.above("plane", height == nil and "edge" or "width", width, 0)
  height = height == nil and width or check.above("plane", "height", height, 0)
  for i = 1, 3 do
    u[i], v[i] = width * u[i], height * v[i]
    if name == "middle" then corner[i] = corner[i] - (u[i] + v[i]) / 2 end
  end
  return corner, u, v
end

function gr.plane(name, place, ...)
  local corner, u, v
  if type(place) == "table" then
    corner, u, v = placed_plane(place, ...)
  else
    check.left_out("plane", place, ...)
    corner, u, v = plain_plane()
  end
  local model = mesh.square(corner, u, v)
  if not model then check.raise "gr.plane: v: another direction than that of u expected" end
  return new_node("plane", name, { kind = "mesh", model = model })
end

-- ---- Combined solids ----

local function set_parts(call, node, ...)
  local count = select("#", ...)
  if count < 2 then check.raise("gr.%s: two nodes expected, got %d", call, count) end
  node.parts, node.is_open = {}, false
  for i = 1, count do node.parts[i] = node_of(call, "part " .. i, (select(i, ...))) end
end

-- Makes a combined solid. Without parts it is open: add_child then adds its parts.
local function new_combined(call, operation, name, ...)
  local object = new_node(call, name, { kind = "combined", operation = operation, parts = {}, is_open = true })
  if select("#", ...) > 0 then set_parts(call, nodes[object], ...) end
  return object
end

for call, operation in pairs(operations.calls) do
  gr[call] = function(name, ...)
    if nodes[name] then return new_combined(call, operation, call, name, ...) end
    return new_combined(call, operation, name, ...)
  end
end

-- A further argument, the radius of a bounding ball, is ignored.
function gr.csg(name, a, sign, b)
  if nodes[name] then return new_combined("csg", operations.of("csg", sign), "csg", name, a) end
  if a == nil then return new_combined("csg", nil, name) end
  if not nodes[a] then return new_combined("csg", operations.of("csg", a), name) end
  return new_combined("csg", operations.of("csg", sign), name, a, b)
end

local function combined_of(call, self)
  local node = node_of(call, "self", self)
  if node.kind ~= "combined" then check.refuse(call, "self", "combined solid", self) end
  return node
end

function gr.setCSGType(self, word) combined_of("setCSGType", self).operation = operations.of("setCSGType", word) end

function gr.set_csg_children(self, a, b, word)
  local node = combined_of("set_csg_children", self)
  node.operation = operations.of("set_csg_children", word)
  set_parts("set_csg_children", node, a, b)
end

-- ---- Methods ----

local function add_child(call, self, child)
  local node = node_of(call, "self", self)
  local list = node.is_open and node.parts or node.children
  list[#list + 1] = node_of(call, "child", child)
end

function gr.add_child(self, child) add_child("add_child", self, child) end

function gr.add_children(self, ...)
  for i = 1, select("#", ...) do add_child("add_children", self, (select(i, ...))) end
end

local function shape_of(call, self)
  local node = node_of(call, "self", self)
  if not node.kind then
    check.raise("gr.%s: a shape expected, got the %s '%s', which has no surface", call, node.call, node.name)
  end
  return node
end

function gr.set_material(self, material)
  local node = shape_of("set_material", self)
  node.material = materials[material] or check.refuse("set_material", "material", "material", material)
end

-- Returns a picture from a result of gr.texture or the name of a file. across, down: repetitions.
local function picture_of(call, value, across, down)
  local known = pictures[value]
  if known and across == nil then return known end
  if not known and type(value) ~= "string" then
    check.refuse(call, "texture", "texture or name of a file", value)
  end
  return surface.picture(call, known and known.name or value, across, down)
end

local function relief_of(call, value, height)
  local known = reliefs[value]
  if known and height == nil then return known end
  if not known and type(value) ~= "string" then check.refuse(call, "bump", "bump or name of a file", value) end
  return surface.relief(call, known and known.name or value, height)
end

for _, call in pairs { "set_texture", "set_texture_map" } do
  gr[call] = function(self, texture, across, down)
    shape_of(call, self).picture = picture_of(call, texture, across, down)
  end
end

for _, call in pairs { "set_bump", "set_bumpmap", "set_bump_map" } do
  gr[call] = function(self, bump, height) shape_of(call, self).relief = relief_of(call, bump, height) end
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

-- Objects have no methods in the course's dialect, and few in its variants. Any other method is a function that raises
-- an error.
local function with_methods(kind, methods)
  return { __index = function(_, name)
    if type(name) ~= "string" or name:sub(1, 2) == "__" then return nil end
    return methods[name] or function()
      check.raise("%s:%s: this method is not part of the dialect that glint runs", kind, name)
    end
  end }
end

-- Makes a method of materials, which changes a field of the record.
local function changing(change)
  return function(self, ...)
    local record = materials[self] or check.refuse("material", "self", "material", self)
    change(record, ...)
    surface.changed(record)
  end
end

local material_methods = {}
material_methods.set_texture = changing(function(record, texture, across, down)
  record.picture = picture_of("set_texture", texture, across, down)
end)
for _, call in pairs { "set_bump", "set_bumpmap" } do
  material_methods[call] = changing(function(record, bump, height) record.relief = relief_of(call, bump, height) end)
end
for _, call in pairs { "set_reflect", "reflection" } do
  material_methods[call] = changing(function(record, share) surface.mirror(record, call, share) end)
end
material_methods.set_opacity = changing(function(record, ...) surface.hide(record, "set_opacity", ...) end)
for _, call in pairs { "set_refract", "set_ri" } do
  material_methods[call] = changing(function(record, index) surface.glass(record, call, index) end)
end

local MATERIAL, LIGHT = with_methods("material", material_methods), with_methods("light", {})

local function new_material(record, name)
  local material = setmetatable({}, MATERIAL)
  materials[material] = record
  check.name_object(material, name or "material")
  return material
end

function gr.material(kd, ks, shininess, ...)
  return new_material(surface.record("material", kd, ks, shininess, ...))
end

local function reflective(call)
  return function(kd, ks, shininess, share)
    local record = surface.record(call, kd, ks, shininess)
    surface.mirror(record, call, share)
    return new_material(record)
  end
end
gr.reflective_material, gr.material_refl = reflective "reflective_material", reflective "material_refl"

function gr.material_refr(kd, ks, shininess, share, index)
  local record = surface.record("material_refr", kd, ks, shininess)
  surface.glass(record, "material_refr", index)
  record.transmission, record.fresnel = check.at_least("material_refr", "transparency", share, 0), nil
  return new_material(record)
end

local BLACK = { 0, 0, 0 }

function gr.reflective()
  local record = surface.record("reflective", BLACK, BLACK, 0)
  surface.mirror(record, "reflective", 1)
  return new_material(record)
end

function gr.refractive(index)
  local record = surface.record("refractive", BLACK, BLACK, 0)
  surface.glass(record, "refractive", index)
  return new_material(record)
end

function gr.perlin_material(...) return new_material(surface.noisy("perlin_material", ...)) end

-- A picture may be a material, if it is given a highlight, or lie on a shape that has another material.
local function texture(call)
  return function(file, ks, ...)
    local record
    if ks and type(ks) ~= "boolean" and type(ks) ~= "number" then
      record = surface.pictured(call, file, ks, ...)
    else
      record = surface.plain(surface.picture(call, file, type(ks) == "number" and ks or nil, ...))
    end
    local object = new_material(record, "texture")
    pictures[object] = record.picture
    record.picture.name = file
    return object
  end
end
gr.texture, gr.texture_map, gr.texture_material = texture "texture", texture "texture_map", texture "texture_material"

-- gr.bump(file) makes a relief; gr.bump(material, file) adds one to the material.
local function bump(call)
  return function(file, height, more)
    local record = materials[file]
    if record and not pictures[file] then
      record.relief = relief_of(call, height, more)
      return surface.changed(record)
    end
    local object = setmetatable({}, with_methods("bump", {}))
    reliefs[object] = surface.relief(call, file, height)
    reliefs[object].name = file
    check.name_object(object, "bump")
    return object
  end
end
gr.bump, gr.bumpmap, gr.bump_map, gr.load_bumpmap = bump "bump", bump "bumpmap", bump "bump_map", bump "load_bumpmap"

require "gr.layers"(gr, shape_of, function(kind) return with_methods(kind, {}) end)

-- kind: the function of glint that makes the light.
local function new_light(kind, fields)
  local record = { shine = glint[kind](fields) }
  local more = {} -- for lists that contain it several times
  function record.again(n)
    more[n] = more[n] or glint[kind](fields)
    return more[n]
  end
  local light = setmetatable({}, LIGHT)
  lights[light] = record
  check.name_object(light, "light")
  return light
end

function gr.light(position, colour, falloff, extra)
  if type(position) ~= "table" or type(extra) == "table" then
    check.raise("gr.light: {position}, {colour}, {fall-off} expected, got %s first and %s fourth: this is another "
      .. "variant of the dialect", check.spelling(position), check.spelling(extra))
  end
  local fields = { position = check.vector("light", "position", position, 3) }
  lamp.shine("light", fields, colour, falloff)
  return new_light("point_light", fields)
end

for _, call in pairs { "area_light", "arealight", "sphericallight" } do
  gr[call] = function(...) return new_light(lamp.area(call, ...)) end
end

function gr.rect_light(...) return new_light(lamp.rectangle("rect_light", ...)) end

local function to_light(value) return lights[value] end

function gr.render(root, ...) picture.render(node_of("render", "root", root), to_light, ...) end

-- ---- Extra arguments ----

-- The number of arguments that each call reads.
local READ = {
  node = 1, joint = 3, sphere = 1, cube = 1, cylinder = 1, cone = 1, torus = 3, nh_torus = 4, nh_sphere = 3,
  nh_box = 3, mesh = 3, light = 3, add_child = 2, set_material = 2, translate = 4, scale = 4, rotate = 3,
}
for call, count in pairs(READ) do
  local made = gr[call]
  gr[call] = function(...)
    if select("#", ...) > count then check.left_out(call, select(count + 1, ...)) end
    return made(...)
  end
end

-- ---- Unknown names ----

-- Returns a function that raises an error when called, for names outside the dialect.
local function missing(_, name)
  if type(name) ~= "string" or name:sub(1, 2) == "__" then return nil end
  return function()
    check.raise("gr.%s: this function is not part of the dialect that glint runs", name)
  end
end

return setmetatable(gr, { __index = missing })
