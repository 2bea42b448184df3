-- The second half of test_api.lua, which loads it: shapes, scenes, rays, images, lifetimes.
local glint, tools, tests = ...
local check, raises, is, with = tools.check, tools.raises, tools.is, tools.with
local SPHERE, LAMP, CAMERA = tools.SPHERE, tools.LAMP, tools.CAMERA

function tests.sphere_and_plane()
  local red = glint.material { diffuse = "red", name = "red" }
  local s = glint.sphere(with(SPHERE, "material", red))
  check(is(s.center, 0, 0, 0) and s.radius == 1 and s.two_sided == true and s.name == "", "defaults")
  check(rawequal(s.material, red), "the material is the same userdata")
  s.x, s.y, s.z, s.radius, s.two_sided, s.name = 1, 2, 3, 4, false, "ball"
  check(is(s.center, 1, 2, 3) and s.x == 1 and s.radius == 4 and not s.two_sided and tostring(s) == "sphere 'ball'", "set")
  local blue = glint.material { diffuse = "blue" }
  s.material = blue
  check(s.material == blue and s.material ~= red, "another material")
  s.material = nil
  check(s.material ~= blue and s.material.shininess == 32, "nil: one with default fields")
  s.material.shininess = 7
  check(s.material.shininess == 7, "which can be changed")
  raises("sphere.raduis: no such field; did you mean 'radius'?", function() glint.sphere(with(SPHERE, "raduis", 2)) end)
  raises("sphere.radius: number expected, got nil", function() glint.sphere { center = { 0, 0, 0 } } end)
  raises("sphere.center: {x, y, z} expected, got nil", function() glint.sphere { radius = 1 } end)
  for _, radius in ipairs { 0, -1 } do
    raises("sphere.radius: number > 0 expected, got " .. radius, function() s.radius = radius end)
    raises("sphere.radius: number > 0 expected, got " .. radius, function() glint.sphere(with(SPHERE, "radius", radius)) end)
  end
  raises("sphere.radius: finite number expected, got nan", function() s.radius = 0 / 0 end)
  raises("sphere.radius: finite number expected, got inf", function() s.radius = 1 / 0 end)
  raises("sphere.material: material expected, got 5", function() s.material = 5 end)
  raises("sphere.material: material expected, got sphere", function() s.material = s end)
  raises("sphere.two_sided: boolean expected, got string \"no\"", function() s.two_sided = "no" end)
  raises("sphere.centre: no such field; did you mean 'center'?", function() return s.centre end)
  check(s.radius == 4, "the sphere is as it was")
  local p = glint.plane { point = { 0, -1, 0 }, normal = { 0, 2, 0 }, material = red, name = "floor" }
  check(is(p.point, 0, -1, 0) and is(p.normal, 0, 2, 0) and p.material == red and tostring(p) == "plane 'floor'", "plane")
  raises("plane.normal: vector that is not zero expected, got {0, 0, 0}", function() p.normal = { 0, 0, 0 } end)
  raises("plane.point: {x, y, z} expected, got nil", function() glint.plane { normal = { 0, 1, 0 } } end)
  raises("plane.x: no such field", function() p.x = 1 end)
  raises("plane.radius: no such field", function() p.radius = 1 end)
end

-- The error message contains `expected`.
local function refused(expected, f)
  local ok, message = pcall(f)
  check(not ok and tostring(message):find(expected, 1, true), "expected an error with <" .. expected .. ">, got " .. tostring(message))
end

function tests.meshes()
  local corners = { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 } }
  local flat = { 0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0 }
  local function square(t)
    t.vertices = t.vertices or corners
    t.faces = t.faces or { { 1, 2, 3, 4 } }
    return glint.mesh(t)
  end
  local red = glint.material { name = "red" }
  local blue = glint.material { name = "blue" }
  local pair = glint.mesh { vertices = corners, faces = { { 1, 2, 3 }, { 1, 3, 4 } }, materials = { red, blue }, index = { 1, 2 } }
  check(#pair.materials == 2 and pair.materials[1] == red and pair.materials[2] == blue, "a material a face")
  local view = glint.scene { camera = glint.camera { eye = { 1, 1, 3 }, at = { 1, 1, 0 }, fov = 30 }, ambient = 1, pair }
  red.diffuse, blue.diffuse = { 1, 0, 0 }, { 0, 0, 1 }
  local seen = view:render { width = 8, height = 8, output = "none" }
  check(seen:pixel(6, 6) == 1 and select(3, seen:pixel(6, 6)) == 0 and select(3, seen:pixel(1, 1)) == 1, "each has its own")
  local packed = glint.mesh { vertices = corners, faces = { 1, 2, 3, 1, 3, 4 }, materials = { red, blue }, index = ("I4I4"):pack(2, 1) }
  check(packed.materials[2] == blue, "packed numbers")
  raises("mesh.material: this mesh has a list of materials; change the fields of the materials in the list", function() pair.material = red end)
  raises("mesh.index: 2 numbers (one a face) expected, got 1", function()
    glint.mesh { vertices = corners, faces = { { 1, 2, 3 }, { 1, 3, 4 } }, materials = { red }, index = { 1 } }
  end)
  raises("mesh.index[1]: number 1 .. 2 expected, got 3", function() square { materials = { red, blue }, index = { 3 } } end)
  raises("mesh.index: array, table or packed string of numbers expected, got nil", function() square { materials = { red, blue } } end)
  raises("mesh.index: an index needs materials; set materials, too", function() square { index = { 1 } } end)
  raises("mesh.materials[2]: material expected, got 5", function() square { materials = { red, 5 }, index = { 1 } } end)
  raises("mesh: material or materials expected, got both", function() square { material = red, materials = { red } } end)
  raises("mesh: file or materials expected, got both", function() glint.mesh { file = "x.obj", materials = { red } } end)
  local m = square { material = red, name = "tile", two_sided = false }
  check(m.count == 2 and m.material == red and m.shading == "faceted" and not m.two_sided and tostring(m) == "mesh 'tile'", "fields")
  for _, t in ipairs {
    {}, { vertices = flat }, { faces = { 1, 2, 3, 1, 3, 4 } }, { faces = { { 1, 2.0, 3 }, { 1, 3, 4 } } },
    { vertices = string.pack("=" .. ("f"):rep(12), table.unpack(flat)), format = "f32" },
    { vertices = string.pack("=" .. ("d"):rep(12), table.unpack(flat)), format = "f64" },
    { faces = string.pack("=I4I4I4I4I4I4", 1, 2, 3, 1, 3, 4) },
  } do
    local h = glint.scene { square(t) }:cast({ 0.5, 1.5, 9 }, { 0, 0, -1 })
    check(h and h.t == 9 and h.element == 2 and is(h.normal, 0, 0, 1) and is(h.point, 0.5, 1.5, 0), "the second is hit")
  end
  local up = { { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 1 } }
  check(square { normals = up }.shading == "phong" and square { normals = up, shading = "flat" }.shading == "flat", "shading")
  local six = { { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 1 } }
  check(square { normals = six, faces = { { 1, 2, 3 }, { 1, 3, 4 } } }.shading == "phong", "one a corner")
  m.shading = "phong"
  check(m.shading == "phong", "smooth now")
  check(glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 16 }.count == 16 * 14, "a sphere of triangles")
  for _, shading in ipairs { "flat", "gouraud", "faceted" } do
    m.shading = shading
    check(m.shading == shading and square { shading = shading }.shading == shading, "%s", shading)
  end
  refused('mesh.shading: "faceted", "phong", "flat" or "gouraud" expected, got string "smooth"', function() m.shading = "smooth" end)
  refused("mesh.count: this field is read-only", function() m.count = 3 end)
  refused("mesh.faces[1]: vertex 1 .. 4 expected, got 5", function() square { faces = { { 1, 2, 5 } } } end)
  refused("mesh.faces[2]: vertex 1 .. 4 expected, got 0", function() square { faces = { 1, 2, 3, 1, 2, 0 } } end)
  refused("mesh.faces[1]: 3 vertices or more expected, got 2", function() square { faces = { { 1, 2 } } } end)
  refused("mesh.faces[1]: number of a vertex expected, got 1.5", function() square { faces = { { 1.5, 2, 3 } } } end)
  refused("mesh.faces: 1 .. 2147483646 expected, got 0", function() square { faces = {} } end)
  refused("mesh.vertices: 3 .. 2147483646 expected, got 0", function() square { vertices = {}, faces = {} } end)
  refused("mesh.faces[1]: a face with an area expected", function() square { faces = { { 1, 2, 2 } } } end)
  refused("mesh.vertices[2][3]: finite number expected, got nan",
    function() square { vertices = { { 0, 0, 0 }, { 1, 0, 0 / 0 }, { 0, 1, 0 } }, faces = { { 1, 2, 3 } } } end)
  refused("mesh.vertices[2]: three finite numbers expected, got {1, 0, inf}",
    function() square { vertices = { 0, 0, 0, 1, 0, 1 / 0, 0, 1, 0 }, faces = { { 1, 2, 3 } } } end)
  refused("mesh.normals[3]: expected three finite numbers, not all 0",
    function() square { normals = { { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 0 }, { 0, 0, 1 } } } end)
  refused("mesh.normals: one per vertex (4) or one per corner of a face (4) expected, got 1", function() square { normals = { { 0, 0, 1 } } } end)
  refused("mesh: file or faces expected, got both", function() glint.mesh { file = "x.obj", faces = {} } end)
  refused("none.obj: No such file or directory", function() glint.mesh { file = "none.obj" } end)
  refused("mesh.vertices: list of {x, y, z}, array of such rows, flat table or packed string expected, got nil", function() glint.mesh {} end)
  refused("mesh.format: only packed numbers have a format", function() square { format = "f32" } end)
  refused("sphere_mesh.segments: whole number", function() glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 2 } end)
  refused("sphere_mesh.radius: number > 0 expected, got 0",
    function() glint.sphere_mesh { center = { 0, 0, 0 }, radius = 0, segments = 8 } end)
end

function tests.spheres()
  local red, blue = glint.material { name = "red" }, glint.material { name = "blue" }
  local rows = { 0, 0, 0, 1, 5, 0, 0, 1 }
  local function packed(format) return string.pack("=" .. format:rep(8), table.unpack(rows)) end
  local s = glint.spheres { data = rows, material = red, name = "two", two_sided = false }
  check(s.count == 2 and s.material == red and not s.two_sided and tostring(s) == "spheres 'two'", "from a table")
  check(#s.materials == 1 and rawequal(s.materials[1], red), "a list of one material")
  s.material = blue
  check(s.material == blue and s.materials[1] == blue, "another material")
  check(glint.spheres { data = packed "f", format = "f32" }.count == 2, "f32")
  check(glint.spheres { data = packed "d", format = "f64" }.count == 2, "f64")
  local function hit(t) return glint.scene { glint.spheres(t) }:cast({ 5, 0, 9 }, { 0, 0, -1 }) end
  for _, t in ipairs { { data = rows }, { data = packed "f", format = "f32" }, { data = packed "d", format = "f64" } } do
    local h = hit(t)
    check(h and h.t == 8 and h.element == 2, "the second is hit")
  end
  for _, index in ipairs { { 2, 1 }, { 2.0, 1 }, string.pack("=I4I4", 2, 1) } do
    s = glint.spheres { data = rows, materials = { red, blue }, index = index }
    check(s.material == red and #s.materials == 2 and s.materials[2] == blue, "several materials")
  end
  check(glint.spheres { data = rows, materials = { blue } }.material == blue, "one in a list needs no index")
  raises("spheres.material: these spheres have a list of materials; change the fields of the materials in the list",
    function() s.material = red end)
  raises("spheres.count: this field is read-only", function() s.count = 5 end)
  raises("spheres.points: no such field", function() return s.points end)
  local function wrong(expected, t) raises("spheres" .. expected, function() glint.spheres(t) end) end
  wrong(".data: array, flat table or packed string of x, y, z, radius expected, got nil", {})
  wrong(".data: array, flat table or packed string of x, y, z, radius expected, got 5", { data = 5 })
  wrong(".data: 4 numbers a sphere (x, y, z, radius) expected, got 0 numbers", { data = {} })
  wrong(".data: 4 numbers a sphere (x, y, z, radius) expected, got 3 numbers", { data = { 1, 2, 3 } })
  wrong(".data[2]: a list without holes expected, got nil", { data = { 0, nil, 0, 1 } })
  wrong(".data[4]: number expected, got string \"1\"", { data = { 0, 0, 0, "1" } })
  wrong(".data: a list expected, got a table with the key string \"n\"", { data = { 0, 0, 0, 1, n = 4 } })
  wrong(".data: sphere 2: radius > 0 expected, got -1", { data = { 0, 0, 0, 1, 0, 0, 0, -1 } })
  wrong(".data: sphere 1: finite centre expected, got {inf, 0, 0}", { data = { 1 / 0, 0, 0, 1 } })
  wrong(".format: \"f32\" or \"f64\" expected, got nil", { data = packed "f" })
  wrong(".format: \"f32\" or \"f64\" expected, got string \"f16\"", { data = packed "f", format = "f16" })
  wrong(".format: only packed data has a format", { data = rows, format = "f32" })
  wrong(".data: 16 bytes a sphere (x, y, z, radius in f32) expected, got 33 bytes",
    { data = packed "f" .. "x", format = "f32" })
  wrong(".data: 32 bytes a sphere (x, y, z, radius in f64) expected, got 0 bytes", { data = "", format = "f64" })
  wrong(": material or materials expected, got both", { data = rows, material = red, materials = { red } })
  wrong(".material: material expected, got 5", { data = rows, material = 5 })
  wrong(".materials: list of materials expected, got material", { data = rows, materials = red })
  wrong(".materials: list of materials expected, got an empty table", { data = rows, materials = {} })
  wrong(".materials[2]: material expected, got 5", { data = rows, materials = { red, 5 }, index = { 1, 1 } })
  wrong(".index: array, table or packed string of numbers expected, got nil", { data = rows, materials = { red, blue } })
  wrong(".index: an index needs materials; set materials, too", { data = rows, index = { 1, 1 } })
  wrong(".index[2]: number 1 .. 2 expected, got 3", { data = rows, materials = { red, blue }, index = { 1, 3 } })
  wrong(".index[1]: number 1 .. 2 expected, got 0",
    { data = rows, materials = { red, blue }, index = string.pack("=I4I4", 0, 1) })
  wrong(".index[1]: whole number expected, got 1.5", { data = rows, materials = { red, blue }, index = { 1.5, 1 } })
  wrong(".index: 2 numbers (one a sphere) expected, got 1", { data = rows, materials = { red, blue }, index = { 1 } })
  wrong(".index: 8 bytes (a u32 a sphere) expected, got 7 bytes",
    { data = rows, materials = { red, blue }, index = "1234567" })
  wrong(".centre: no such field", { data = rows, centre = 1 })
end

-- The numbers of a transform, and the images of points by paper.
function tests.transform_numbers()
  local turn = glint.translate(1, 2, 3) * glint.rotate("y", 90) * glint.scale(2)
  local p = turn * { 1, 10, 100 }
  check(is(p, 201, 22, 1), "scaled, turned (x to -z, z to x), moved: %s", p)
  check(is(turn * glint.sphere(SPHERE).center, (turn * { SPHERE.center[1], SPHERE.center[2], SPHERE.center[3] }):unpack()), "a vector")
  local numbers = {}
  for i, x in ipairs(turn) do numbers[i] = x end
  check(#turn == 12 and #numbers == 12 and numbers[4] == 1 and numbers[3] == 2 and numbers[9] == -2, "its numbers")
  check(glint.matrix(numbers) == turn and turn[0] == nil and turn[13] == nil, "they make it again")
  raises("transform: point[3]: number expected, got nil", function() return turn * { 1, 2 } end)
  raises("transform: transform expected, got 3", function() return turn * 3 end)
  raises("transform.1: a transform cannot be changed; assign a new transform to the object's field", function() turn[1] = 3 end)
end

-- Every list is read by number, by ipairs and by objects(), and every object tells its kind.
function tests.walking()
  local lamp, label = glint.point_light(LAMP), glint.label { text = "a" }
  local ball, box = glint.sphere(SPHERE), glint.box { min = { 0, 0, 0 }, max = { 1, 1, 1 } }
  local group = glint.group { ball, glint.union { ball, box } }
  local scene = glint.scene { lamp, label, ball, group, ambient = 0.25, camera = glint.camera(CAMERA) }
  local function walk(list, as)
    local words = {}
    for i, object in ipairs(list) do
      words[i] = object.kind
      check(rawequal(object, list[i]) and rawequal(object, list:objects()[i]), "%s %d", as, i)
    end
    check(#list == #words and #list:objects() == #words and list[0] == nil and list[#words + 1] == nil and list[-1] == nil,
      "ends of %s", as)
    return table.concat(words, " ")
  end
  check(walk(scene, "scene") == "sphere group point_light label", "kinds of a scene")
  check(walk(group, "group") == "sphere union" and walk(group[2], "union") == "sphere box", "kinds of a group")
  check(rawequal(scene[1], ball) and rawequal(scene[2][1], ball), "a shape in two places is one object")
  check(scene.kind == "scene" and scene.camera.kind == "camera" and glint.material {}.kind == "material", "other kinds")
  check(glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 4 }.kind == "mesh", "a sphere mesh is a mesh")
  local names, count = {}, 0
  for name, value in pairs(scene) do
    count = count + 1
    if count <= 4 then check(name == count and rawequal(value, scene[count]), "pairs: object %d", count) end
    names[name] = value
  end
  check(is(names.ambient, 0.25, 0.25, 0.25) and rawequal(names.camera, scene.camera) and names.indirect == nil, "pairs: fields")
  names = {}
  for name, value in pairs(ball) do names[#names + 1], names[name] = name, value end
  check(names[1] == "center" and names.radius == ball.radius and names.kind == nil and names.x == nil, "pairs of a sphere")
  local copy = { center = names.center, radius = names.radius, material = names.material, transform = names.transform }
  check(is(glint.sphere(copy).center, ball.center.x, ball.center.y, ball.center.z), "its fields make a sphere again")
  local list = scene:objects()
  scene:remove(ball)
  check(#list == 4 and #scene == 3 and rawequal(scene[1], group), "a list stays as it is")
  raises("sphere: name of a field expected, got 1", function() return ball[1] end)
  raises("sphere.kind: this field is read-only", function() ball.kind = "box" end)
  raises("sphere.objects: no such field", function() return ball:objects() end)
  raises("scene or group expected, got sphere", function() return scene.objects(ball) end)
  raises("scene or group expected, got 3", function() return scene.objects(3) end)
  raises("scene: name of a field expected, got 3", function() scene[3] = ball end)
  local step = pairs(ball)
  raises("object expected, got 1", function() step(1) end)
  scene:close()
  raises("scene is closed", function() return scene[1] end)
end

function tests.scene()
  local red = glint.material {}
  local camera, lamp = glint.camera(CAMERA), glint.point_light(LAMP)
  local near = glint.sphere { center = { 0, 0, 2 }, radius = 1, material = red }
  local far = glint.sphere(SPHERE)
  local scene = glint.scene { camera = camera, ambient = 0.1, background = "white", lamp, far }
  check(rawequal(scene.camera, camera) and is(scene.ambient, 0.1, 0.1, 0.1) and is(scene.background, 1, 1, 1), "fields")
  check(rawequal(scene:add(near), near), "add returns the object")
  local h = scene:cast({ 0, 0, 9 }, { 0, 0, -2 })
  check(h.t == 3 and is(h.point, 0, 0, 3) and is(h.normal, 0, 0, 1) and rawequal(h.object, near) and h.element == nil, "cast")
  check(rawequal(h.object.material, red), "from the hit to the material")
  check(scene:remove(near) == nil and scene:cast({ 0, 0, 9 }, { 0, 0, -1 }).object == far, "remove")
  far.z = 1
  check(scene:cast({ 0, 0, 9 }, { 0, 0, -1 }).t == 7, "a changed object")
  scene:remove(far)
  scene:remove(lamp)
  check(scene:cast({ 0, 0, 9 }, { 0, 0, -1 }) == nil, "nothing left")
  local other = glint.scene { far, lamp }
  scene:add(far)
  check(other:cast({ 0, 0, 9 }, { 0, 0, -1 }).object == scene:cast({ 0, 0, 9 }, { 0, 0, -1 }).object, "in two scenes")
  scene.camera, scene.ambient, scene.background = nil, { 0, 0, 1 }, 0
  check(scene.camera == nil and is(scene.ambient, 0, 0, 1), "fields set")
  scene.camera = camera
  raises("scene.shape: already in the scene", function() scene:add(far) end)
  raises("scene.light: not in the scene", function() scene:remove(lamp) end)
  raises("scene.shape: already in the scene", function() glint.scene { far, far } end)
  raises("scene.add: shape, light or overlay expected, got nil", function() scene:add() end)
  raises("scene.add: shape, light or overlay expected, got material", function() scene:add(red) end)
  raises("scene.remove: shape, light or overlay expected, got 1", function() scene:remove(1) end)
  raises("scene[2]: shape, light or overlay expected, got camera", function() glint.scene { lamp, camera } end)
  raises("scene[1]: shape, light or overlay expected, got a list; put its objects into the scene directly, or into a glint.group",
    function() glint.scene { { lamp } } end)
  raises("scene[2]: a list without holes expected, got nil", function() glint.scene { lamp, nil, far } end)
  raises("scene[1]: a list without holes expected, got nil", function() glint.scene { nil, far } end)
  raises("scene: a list expected, got a table with the key 0", function() glint.scene { [0] = lamp } end)
  raises("scene: name of a field expected, got 1.5", function() glint.scene { [1.5] = lamp } end)
  raises("scene.cam: no such field; did you mean 'camera'?", function() glint.scene { cam = camera } end)
  raises("scene.camera: camera expected, got point_light", function() scene.camera = lamp end)
  raises("scene.background: colour >= 0 expected, got {-1, -1, -1}", function() scene.background = -1 end)
  raises("scene.rendr: no such field; did you mean 'render'?", function() scene:rendr {} end)
  raises("cast.origin: {x, y, z} expected, got no value", function() scene:cast() end)
  raises("cast.direction: vector that is not zero expected, got {0, 0, 0}",
    function() scene:cast({ 0, 0, 0 }, { 0, 0, 0 }) end)
  raises("cast.direction[1]: finite number expected, got nan", function() scene:cast({ 0, 0, 0 }, { 0 / 0, 0, 0 }) end)
  raises("scene expected, got sphere; a method takes a colon: object:cast(...)", function() scene.cast(far, { 0, 0, 0 }, { 0, 0, 1 }) end)
end

function tests.image()
  local scene = glint.scene {
    camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 }, fov = 40 },
    ambient = 0.25, background = { 0, 0, 1 },
    glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { diffuse = { 1, 0.5, 0 } } },
  }
  local image = scene:render { width = 64, height = 48, passes = { "depth", "object_id", "normal" } }
  check(image.width == 64 and image.height == 48, "size")
  local r, g, b = image:pixel(32, 24)
  check(r == 0.25 and g == 0.125 and b == 0, "the sphere: %g %g %g", r, g, b)
  r, g, b = image:pixel(0, 0)
  check(r == 0 and g == 0 and b == 1, "the background: %g %g %g", r, g, b)
  local depth = table.pack(image:pixel(0, 0, "depth"))
  check(depth.n == 1 and depth[1] == math.huge and math.abs(image:pixel(32, 24, "depth") - 4) < 1e-2, "depth")
  check(image:pixel(0, 0, "object_id") == 0 and image:pixel(31, 24, "object_id") == 1, "object_id")
  check(select(3, image:pixel(32, 24, "normal")) > 0.99, "normal")
  local there = {}
  for _, pass in ipairs(image.passes) do there[pass] = true end
  check(there.beauty and there.depth and there.object_id and there.normal, "passes")
  raises("pixel.x: whole number 0 .. 63 expected, got 64", function() image:pixel(64, 0) end)
  raises("pixel.x: whole number 0 .. 63 expected, got -1", function() image:pixel(-1, 0) end)
  raises("pixel.y: whole number 0 .. 47 expected, got 1.5", function() image:pixel(0, 1.5) end)
  raises("pixel.y: whole number 0 .. 47 expected, got nan", function() image:pixel(0, 0 / 0) end)
  raises("pixel.y: number expected, got no value", function() image:pixel(0) end)
  raises('pixel.pass: name of a pass expected, got string "depht"', function() image:pixel(0, 0, "depht") end)
  raises("image.width: this field is read-only", function() image.width = 5 end)
  raises("image.with: no such field; did you mean 'width'?", function() return image.with end)
  raises("image.pixel: a method cannot be assigned", function() image.pixel = print end)
  raises("save.path: file name expected, got nil", function() image:save(nil) end)
  raises('save.path: file name without zero bytes expected, got string ""', function() image:save "" end)
  raises("save.bits: 8 or 16 expected, got 9.0", function() image:save("x.png", { bits = 9 }) end)
  raises("save.bit: no such field; did you mean 'bits'?", function() image:save("x.png", { bit = 8 }) end)
  raises('save.transfer: "srgb", "linear" or "none" expected, got string "gamma"',
    function() image:save("x.png", { transfer = "gamma" }) end)
  raises('save.pass: name of a pass expected, got string "shadow"', function() image:save("x.png", { pass = "shadow" }) end)
  local done, message = image:save "/proc/no such folder/x.png"
  check(done == nil and type(message) == "string", "a file that cannot be written: nil and a message")
  local path = os.tmpname()
  for _, ending in ipairs { ".png", ".pfm" } do
    local name = path .. ending
    done, message = image:save(name, { pass = "depth", bits = 16, encode = "small", transfer = "linear" })
    check(done == true, "saved %s: %s", name, tostring(message))
    local file = io.open(name, "rb")
    local start = file and file:read(4) or ""
    if file then file:close() end
    check(start == (ending == ".png" and "\137PNG" or "Pf\n6"), "%s starts with %q", name, start)
    os.remove(name)
  end
  os.remove(path)
  image:close()
  raises("image is closed", function() image:pixel(0, 0) end)
end

function tests.lifetimes()
  local m = glint.material { shininess = 5 }
  local s = glint.sphere(with(SPHERE, "material", m))
  local scene = glint.scene { camera = glint.camera(CAMERA), s }
  m:close()
  m:close()
  raises("material is closed", function() m.shininess = 1 end)
  raises("material is closed", function() return m.shininess end)
  raises("material is closed", function() m:evaluate {} end)
  raises("sphere.material: material expected, got closed material", function() s.material = m end)
  check(tostring(m) == "closed material" and m == m and m ~= s.material, "closed")
  check(s.material.shininess == 5 and s.material == s.material, "the sphere keeps its material")
  do
    local made <close> = glint.sphere(SPHERE)
    check(made.radius == 1, "to be closed")
  end
  s:close()
  raises("shape is closed", function() s.x = 1 end)
  raises("scene.add: shape, light or overlay expected, got closed shape", function() scene:add(s) end)
  collectgarbage()
  local h = scene:cast({ 0, 0, 9 }, { 0, 0, -1 })
  check(h and h.object.material.shininess == 5, "the scene keeps its shapes")
  check(scene.camera.fov == 40, "and its camera")
  scene:close()
  raises("scene is closed", function() scene:cast({ 0, 0, 9 }, { 0, 0, -1 }) end)
  raises("scene is closed", function() scene:render {} end)
  -- Userdata keep their identity as long as anything retains them.
  local marks = setmetatable({}, { __mode = "k" })
  local held = glint.scene {}
  for i = 1, 50 do
    local ball = glint.sphere { center = { 3 * i, 0, 0 }, radius = 1, material = glint.material {} }
    marks[ball], marks[ball.material] = i, -i
    held:add(ball)
  end
  collectgarbage()
  for i = 1, 50 do
    local object = held:cast({ 3 * i, 0, 9 }, { 0, 0, -1 }).object
    check(marks[object] == i and marks[object.material] == -i, "object %d is the same userdata", i)
  end
  for _ = 1, 200 do -- dropped objects are freed, and their addresses are used again
    glint.scene { glint.sphere(with(SPHERE, "material", glint.material {})), glint.point_light(LAMP) }
  end
  collectgarbage()
  check(getmetatable(held) == false and not pcall(setmetatable, held, {}), "the metatable is out of reach")
end

-- A finalizer closes objects while they are in use.
function tests.hostile_finalizers()
  local function later(f) setmetatable({}, { __gc = f }) end
  local at = { normal = { 0, 0, 1 }, to_light = { 0, 0, 1 }, to_eye = { 0, 0, 1 } }
  for _ = 1, 300 do
    local m = glint.material {}
    local t = with(SPHERE, "material", m)
    later(function() m:close() end)
    local ok, ball = pcall(glint.sphere, t)
    check(ok or tostring(ball):find "closed", "sphere: %s", tostring(ball))
    local material = ok and ball.material or glint.material {}
    later(function() material:close() end)
    pcall(material.evaluate, material, at)
    local scene = glint.scene { glint.sphere(SPHERE) }
    scene:cast({ 0, 0, 9 }, { 0, 0, -1 }).object:close()
    later(function() scene:close() end)
    pcall(scene.cast, scene, { 0, 0, 9 }, { 0, 0, -1 })
    pcall(scene.add, scene, glint.sphere(SPHERE))
  end
end

function tests.functions()
  check(glint.version:find "^%d+%.%d+%.%d+$", "version")
  for name, kinds in pairs { sin = ", symbol or vector", cos = ", symbol or vector", tan = "", exp = "" } do
    check(math.abs(glint[name](0.5) - math[name](0.5)) < 1e-15, name)
    raises(("%s: number%s expected, got string \"1\""):format(name, kinds), function() glint[name] "1" end)
  end
  check(math.abs(glint.log(10) - math.log(10)) < 1e-15 and glint.pow(2, 10) == 1024 and glint.sin(0) == 0, "log, pow")
  check(glint.log(0) == -math.huge and glint.exp(math.huge) == math.huge, "the ends")
  raises("pow: 2 arguments expected, got 1", function() glint.pow(2) end)
  raises("log: one number expected; for another base, divide by glint.log(base)", function() glint.log(8, 2) end)
end

-- A diffuse above 1 is allowed, with one warning per process.
function tests.warning()
  local interpreter = arg[-1] or "lua5.4"
  local script = [[package.cpath = %q
    local glint = require 'glint'
    local m = glint.material {diffuse = 1}
    m.specular = 3
    m.diffuse = {0.5, 1.5, 0}
    m.diffuse = 2
    glint.material {diffuse = 7}]]
  local path = os.tmpname()
  local file = assert(io.open(path, "w"))
  file:write(script:format(package.cpath))
  file:close()
  local pipe = assert(io.popen(("%s %s 2>&1"):format(interpreter, path)))
  local got = pipe:read "a"
  pipe:close()
  os.remove(path)
  local expected = "glint: warning: " .. path .. ":5: material.diffuse above 1: the surface reflects more light than it receives\n"
  check(got == expected, "one warning expected, got <%s>", got)
end
