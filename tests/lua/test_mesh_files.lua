-- Meshes from files: every format gives the same triangles; materials of .obj files by face; errors are reported
-- wherever a file ends.
local build = os.getenv "BUILD" or "build"
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local folder = build .. "/tests/mesh_files"
assert(os.execute(("rm -rf '%s' && mkdir -p '%s'"):format(folder, folder)))

local function write(name, ...)
  local path = folder .. "/" .. name
  local file = assert(io.open(path, "wb"))
  assert(file:write(...))
  assert(file:close())
  return path
end

local function load(name, ...) return glint.mesh { file = write(name, ...) } end

local function is(v, x, y, z) return v[1] == x and v[2] == y and v[3] == z end

local function refuses(want, name, ...)
  local path = write(name, ...)
  local good, message = pcall(glint.mesh, { file = path })
  check(not good and message == path .. want, "<%s> expected, got <%s>", want, message)
end

-- ---- A box with six faces in every format ----

local CORNERS, FACES = {}, { { 0, 1, 3, 2 }, { 4, 6, 7, 5 }, { 0, 4, 5, 1 }, { 2, 3, 7, 6 }, { 0, 2, 6, 4 }, { 1, 5, 7, 3 } }
for i = 0, 7 do CORNERS[i] = { 2 * (i // 4) - 1, 1.25 * (i // 2 % 2), 3 * (i % 2) - 0.5 } end

local function obj()
  local text = {}
  for i = 0, 7 do text[#text + 1] = ("v %g %g %g\n"):format(table.unpack(CORNERS[i])) end
  for _, f in ipairs(FACES) do text[#text + 1] = ("f %d %d %d %d\n"):format(f[1] + 1, f[2] + 1, f[3] + 1, f[4] + 1) end
  return table.concat(text)
end

local function triangles()
  local list = {}
  for _, f in ipairs(FACES) do
    list[#list + 1] = { f[1], f[2], f[3] }
    list[#list + 1] = { f[1], f[3], f[4] }
  end
  return list
end

local function text_stl()
  local text = { "solid a box\n" }
  for _, t in ipairs(triangles()) do
    text[#text + 1] = " facet normal 0 0 0\n  outer loop\n"
    for _, i in ipairs(t) do text[#text + 1] = ("   VERTEX %e %e %e\r\n"):format(table.unpack(CORNERS[i])) end
    text[#text + 1] = "  endloop\n endfacet\n\n"
  end
  return table.concat(text) .. "endsolid a box\n"
end

local function binary_stl()
  local text = { ("solid, yet binary"):rep(5):sub(1, 80), ("<I4"):pack(12) }
  for _, t in ipairs(triangles()) do
    text[#text + 1] = ("<fff"):pack(0, 0, 0)
    for _, i in ipairs(t) do text[#text + 1] = ("<fff"):pack(table.unpack(CORNERS[i])) end
    text[#text + 1] = "\0\0"
  end
  return table.concat(text)
end

-- Writes a .ply with properties that a mesh does not use, before, between and after the others.
local function ply(format, before, after)
  local text = { "ply\nformat ", format, " 1.0\ncomment of a test\nobj_info x\nelement note 1\nproperty list uint16 int8 words\n",
    "element vertex 8\n", before or "", "property double x\nproperty float y\nproperty float32 z\nproperty ushort kind\n",
    after or "", "element face 6\nproperty int8 flag\nproperty list uchar int vertex_indices\n", "end_header\n" }
  local order = format:find "big" and ">" or "<"
  local function row(kinds, ...)
    text[#text + 1] = format == "ascii" and (("%g "):rep(select("#", ...))):format(...) .. "\n" or (order .. kinds):pack(...)
  end
  row("I2i1i1i1", 3, 1, -2, 3)
  for i = 0, 7 do
    local v = CORNERS[i]
    if before then row("ddd", v[1], v[2] - 0.5, v[3]) text[#text] = text[#text]:gsub("\n$", "") end
    row("dffI2", v[1], v[2], v[3], 7)
    if after then text[#text] = text[#text]:gsub("\n$", "") row("ff", v[1], v[2]) end
  end
  for _, f in ipairs(FACES) do row("i1I1i4i4i4i4", -1, 4, table.unpack(f)) end
  return table.concat(text)
end

local CAMERA <const> = glint.camera { eye = { 5, 4, 7 }, at = { 0, 0.5, 1 } }

local function pixels(mesh, materials)
  local scene = glint.scene { camera = CAMERA, ambient = 0.1, glint.point_light { position = { 2, 9, 5 } }, mesh }
  local image, list = scene:render { width = 24, height = 18, passes = "beauty,depth,normal" }, {}
  for y = 0, 17 do
    for x = 0, 23 do
      for _, pass in ipairs { "beauty", "depth", "normal" } do
        for _, v in ipairs { image:pixel(x, y, pass) } do list[#list + 1] = ("%a"):format(v) end
      end
    end
  end
  check(materials == nil or #mesh.materials == materials, "%s materials expected, got %d", materials, #mesh.materials)
  return table.concat(list, "\n")
end

local tests = {}

function tests.every_kind_of_file_gives_the_same_picture()
  for _, shading in ipairs { "faceted", "phong", "gouraud" } do
    local want
    for _, file in ipairs { { "box.obj", obj() }, { "text.stl", text_stl() }, { "binary.STL", binary_stl() },
      { "text.ply", ply "ascii" }, { "little.ply", ply "binary_little_endian" }, { "big.Ply", ply "binary_big_endian" } } do
      local mesh = glint.mesh { file = write(file[1], file[2]), shading = shading }
      check(mesh.count == 12, "%s: 12 triangles expected, got %d", file[1], mesh.count)
      check(is(mesh.min, -1, 0, -0.5) and is(mesh.max, 1, 1.25, 2.5), "%s: its box", file[1])
      local got = pixels(mesh, 1)
      want = want or got
      check(got == want, "%s, %s: another picture than that of box.obj", file[1], shading)
    end
  end
end

function tests.normals_and_coordinates_of_ply()
  local normals = "property double nx\nproperty double ny\nproperty double nz\n"
  local want
  for _, format in ipairs { "ascii", "binary_little_endian", "binary_big_endian" } do
    local mesh = load("n.ply", ply(format, normals, "property float s\nproperty float t\n"))
    check(mesh.shading == "phong", "normals make shading phong, got %s", mesh.shading)
    mesh.material.diffuse = glint.pattern(function(_, s) return { s.uv.u * s.uv.u, s.uv.v, 0 } end)
    local got = pixels(mesh)
    want = want or got
    check(got == want, "%s: another picture", format)
  end
  local flat = pixels(load("box.obj", obj()))
  check(want ~= flat, "normals and coordinates show")
  -- A normal of 0 is ignored: that corner has its face's normal.
  local head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
  local mesh = load("zero.ply", head, normals, "element face 1\nproperty list uchar int vertex_index\nend_header\n",
    "0 0 0 0 0 0\n1 0 0 1 0 1\n0 1 0 0 nan 0\n3 0 1 2\n")
  check(mesh.count == 1 and mesh.shading == "phong", "zero normals are left out")
end

function tests.faces_without_an_area_are_left_out()
  local facet = "facet normal 0 0 0\nouter loop\nvertex %s\nvertex %s\nvertex %s\nendloop\nendfacet\n"
  local one, none = facet:format("0 0 0", "1 0 0", "0 1 0"), facet:format("0 0 0", "1 0 0", "2 0 0")
  check(load("some.stl", "solid\n", none, one, none, one, "endsolid\n").count == 2, "two facets stay")
  refuses(": faces: one with an area expected, got 1 without", "none.stl", "solid\n", none, "endsolid\n")
end

-- ---- Materials ----

local PLATES = [[
mtllib some file.mtl
v -2 -1 0
v 0 -1 0
v 0 1 0
v -2 1 0
v 2 -1 0
v 2 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl left of it
f 1 2 3 4
usemtl right
f 2/1 5/2 6/3 3/4
]]

local MATERIALS = [[
# two
newmtl right
Kd 0.25 0.5 1
map_Kd -s 1 1 1 -clamp on sub\pic.png
newmtl left of it
  Ka 1 1 1
Kd 0.5 0.25 0.125
Ks 0.75
Ns 12.5
Ke 1 1 1
map_Bump -bm 0.2 nothing.png
]]

function tests.colours_by_face()
  os.execute("mkdir -p " .. folder .. "/sub")
  glint.scene { camera = glint.camera { eye = { 0, 1, 9 }, at = { 0, 1, 0 } }, ambient = 1, background = { 0, 1, 0 },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = { 1, 0, 0.5 } } },
  }:render { width = 8, height = 8, transfer = "linear", bits = 16 }:save(folder .. "/sub/pic.png",
    { transfer = "linear", bits = 16 })
  write("some file.mtl", MATERIALS)
  local kept = { load("plates.obj", PLATES) }
  local list = kept[1].materials
  check(#list == 2 and list[1].name == "left of it" and list[2].name == "right", "materials by name, in the faces' order")
  check(is(list[1].diffuse, 0.5, 0.25, 0.125) and is(list[1].specular, 0.75, 0.75, 0.75), "Kd, Ks")
  check(list[1].shininess == 12.5 and is(list[1].ambient, 0.5, 0.25, 0.125), "Ns; ambient follows Kd")
  check(is(list[2].specular, 0, 0, 0) and is(list[2].transmission, 0, 0, 0), "no Ks, no d")
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1, kept[1] }
  local image = scene:render { width = 64, height = 36 }
  local r, g, b = image:pixel(28, 18)
  check(r == 0.5 and g == 0.25 and b == 0.125, "the left plate is Kd, got %g %g %g", r, g, b)
  r, g, b = image:pixel(36, 14) -- pixel above: the sky of the picture, times Kd
  check(r == 0 and math.abs(g - 0.5) < 1e-4 and b == 0, "the right plate above is 0 0.5 0, got %g %g %g", r, g, b)
  r, g, b = image:pixel(36, 21)
  check(math.abs(r - 0.25) < 1e-4 and g == 0 and math.abs(b - 0.5) < 1e-4, "and below 0.25 0 0.5, got %g %g %g", r, g, b)
  list[1].diffuse = glint.pattern(function(p) return p.x + 2 end)
  list[1], kept[1] = nil, nil
  collectgarbage()
  collectgarbage()
  near((scene:render { width = 64, height = 36 }:pixel(28, 18)), 2 - (32 - 28.5) / 18 * 9 * math.tan(math.rad(20)), 1e-6,
    "a pattern in place of Kd stays with the scene")
end

-- The right plate's upper half is cut out, and its highlight comes from the picture: red, and half of the blue below.
function tests.pictures_of_highlights_and_holes()
  os.execute("mkdir -p " .. folder .. "/sub")
  local function halves(name, upper, lower) -- these textures have linear pixel values
    glint.scene { camera = glint.camera { eye = { 0, 1, 9 }, at = { 0, 1, 0 } }, ambient = 1, background = upper,
      glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = lower } },
    }:render { width = 8, height = 8, transfer = "linear", bits = 16 }:save(folder .. "/sub/" .. name,
      { transfer = "linear", bits = 16 })
  end
  halves("hole.png", 0, { 1, 0, 0 })
  halves("shine.png", { 0, 1, 0 }, { 1, 0, 0.5 })
  local function render(text)
    write("some file.mtl", text)
    local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 }, fov = 40 }, background = { 0, 0, 1 },
      glint.directional_light { direction = { 0, 0, -1 }, ambient = 0 }, (load("plates.obj", PLATES)) }
    return scene:render { width = 64, height = 36, passes = "specular" }
  end
  local image = render "newmtl left of it\nKd 1 1 1\nnewmtl right\nKd 0.5 0.5 0.5\nmap_d -clamp on sub/hole.png\n"
  local r, g, b = image:pixel(36, 14)
  check(r == 0 and g == 0 and b == 1, "what is behind the hole, got %g %g %g", r, g, b)
  r, g, b = image:pixel(36, 21)
  check(r == 0.5 and g == 0.5 and b == 0.5, "what is there, got %g %g %g", r, g, b)
  for _, ks in ipairs { "", "Ks 0.5 0.5 0.5\n" } do
    image = render("newmtl left of it\nKd 1 1 1\nnewmtl right\nKd 0 0 0\nNs 0\n" .. ks .. "map_Ks -clamp on sub/shine.png\n")
    local part = ks == "" and 1 or 0.5
    r, g, b = image:pixel(36, 21, "specular")
    near(r, part, 1e-4, "Ns 0: the picture times Ks") near(g, 0, 0, "green") near(b, part / 2, 1e-4, "blue")
    r, g = image:pixel(36, 14, "specular")
    check(r == 0 and math.abs(g - part) < 1e-4, "above, got %g %g", r, g)
  end
  image = render "newmtl left of it\nKd 1 1 1\nnewmtl right\nKd 0 0 0\nNs 0\nillum 1\nmap_Ks -clamp on sub/shine.png\n"
  check(image:pixel(36, 21, "specular") == 0, "illum 1 has no highlight")
end

-- A bump map, in any spelling and with the height of -bm, equals the bump pattern that a script would write.
function tests.reliefs()
  os.execute("mkdir -p " .. folder .. "/sub")
  glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1,
    glint.sphere { center = { 0, 0, 0 }, radius = 2, material = glint.material {
      diffuse = glint.pattern(function(p) return 0.5 + 0.2 * p.x end) } } }
    :render { width = 16, height = 16, transfer = "linear" }:save(folder .. "/sub/hill.png", { transfer = "linear" })
  local photo = glint.texture { file = folder .. "/sub/hill.png", transfer = "linear" }
  local function render(statement, own)
    write("some file.mtl", "newmtl left of it\nKd 1 1 1\nnewmtl right\nKd 0.5 0.5 0.5\n" .. statement .. "\n")
    local mesh = load("plates.obj", PLATES)
    if own then mesh.materials[2].bump = own end
    local image = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } },
      glint.directional_light { direction = { -1, -0.5, -1 } }, mesh }:render { width = 64, height = 36 }
    local light = {}
    for x = 0, 63 do light[#light + 1] = ("%a"):format((image:pixel(x, 14))) end
    return table.concat(light, " ")
  end
  local flat = render ""
  local function height(of) return glint.pattern(function(_, s) return of * photo(s.uv, s.uv_footprint).r end) end
  local high, low = render("", height(0.3)), render("", height(0.1))
  check(high ~= flat and high ~= low, "a relief shows")
  for _, word in ipairs { "map_Bump", "map_bump", "bump" } do
    check(render(word .. " -bm 0.3 sub/hill.png") == high, "%s", word)
  end
  check(render "bump -bm 0.1 -s 1 1 1 sub/hill.png" == low, "-bm is the height")
  check(render "bump -bm 0.1 sub/hill.png\nmap_Bump -bm 0.3 sub/hill.png" == high, "the last counts")
  check(render "bump sub/hill.png" == flat and render "bump -bm 0 sub/hill.png" == flat, "no height, no relief")
end

function tests.a_material_of_the_script_comes_first()
  write("some file.mtl", MATERIALS)
  local own = glint.material { diffuse = 0.5 }
  local mesh = glint.mesh { file = write("plates.obj", PLATES), material = own }
  check(#mesh.materials == 1 and mesh.materials[1] == own and mesh.material == own, "the script's")
  mesh = load("plates.obj", PLATES)
  local good, message = pcall(function() mesh.material = own end)
  check(not good and message:find("mesh.material: this mesh has a list of materials; change the fields of the materials in the list", 1, true),
    "got %s", message)
  mesh = load("box.obj", obj())
  mesh.material = own
  check(mesh.materials[1] == own, "a mesh of one material takes another")
end

function tests.what_lets_light_through()
  write("some file.mtl", "newmtl right\nKd 1 1 1\nKs 1 1 1\nTr 0.25\nnewmtl left of it\nKd 1 0.5 0\nillum 1\nKs 1 1 1\nd 0.75\n")
  local mesh = load("plates.obj", PLATES)
  local left, right = mesh.materials[1], mesh.materials[2]
  check(is(left.diffuse, 0.75, 0.375, 0) and is(left.transmission, 0.25, 0.25, 0.25), "d")
  check(left.ior == 1 and is(left.specular, 0, 0, 0), "not bent; illum 1 has no highlight")
  check(is(right.specular, 0.75, 0.75, 0.75) and is(right.transmission, 0.25, 0.25, 0.25), "Tr is 1 - d")
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1, background = 0.5, mesh }
  local _, got = scene:render { width = 64, height = 36 }:pixel(28, 18)
  near(got, 0.375 + 0.25 * 0.5, 1e-6, "Kd d + behind (1 - d)")
end

-- Vertices shared by faces of two materials are lit once for each material.
function tests.materials_meet_in_vertices()
  local text = "mtllib m.mtl\nv -2 -1 0\nv 0 -1 0\nv 0 1 0\nv -2 1 0\nv 2 -1 0\nv 2 1 0\nusemtl a\nf 1 2 3 4\nusemtl b\nf 2 5 6 3\n"
  write("m.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 0 1\n")
  for _, shading in ipairs { "faceted", "phong", "flat", "gouraud" } do
    local mesh = glint.mesh { file = write("m.obj", text), shading = shading }
    local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } },
      glint.directional_light { direction = { 0, 0, -1 } }, mesh }
    for _, visibility in ipairs { "cast", "scan" } do
      local image = scene:render { width = 64, height = 36, visibility = visibility }
      for x, want in pairs { [31] = { 1, 0, 0 }, [32] = { 0, 0, 1 } } do
        local got = { image:pixel(x, 18) }
        for c = 1, 3 do
          near(got[c], want[c], 1e-6, ("%s, %s, x %d, component %d"):format(shading, visibility, x, c))
        end
      end
    end
  end
end

-- ---- Colours of .ply ----

-- Renders two adjacent triangles with colours of corners, of faces or of both; nil: no colours.
local function colored(format, corners, faces)
  local names = "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
  local text = { "ply\nformat ", format, " 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n",
    corners and names or "", "element face 2\nproperty list uchar int vertex_indices\n", faces and names or "", "end_header\n" }
  local order = format:find "big" and ">" or "<"
  local function row(kinds, list)
    text[#text + 1] = format == "ascii" and table.concat(list, " ") .. "\n" or (order .. kinds):pack(table.unpack(list))
  end
  local function add(list, color)
    if color then table.move({ color[1], color[2], color[3], 7 }, 1, 4, #list + 1, list) end
    return list
  end
  for i, p in ipairs { { -3, -2, 0 }, { 0, -2, 0 }, { 0, 2, 0 }, { 0, -2, 0 }, { 3, -2, 0 }, { 0, 2, 0 } } do
    row(corners and "fffBBBB" or "fff", add(p, corners and corners[i]))
  end
  for i, f in ipairs { { 3, 0, 1, 2 }, { 3, 3, 4, 5 } } do row(faces and "Bi4i4i4BBBB" or "Bi4i4i4", add(f, faces and faces[i])) end
  return table.concat(text)
end

local function light_of(code)
  local v = code / 255
  return v <= 0.04045 and v / 12.92 or ((v + 0.055) / 1.055) ^ 2.4
end

function tests.colours_of_ply()
  local RED <const>, BLUE <const>, SKY <const> = { 255, 0, 0 }, { 0, 0, 255 }, { 16, 128, 240 }
  local function shows(name, text, left, right)
    local mesh = load(name, text)
    local image = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1, mesh }:render { width = 64, height = 36 }
    for x, want in pairs { [29] = left, [34] = right } do
      local got = { image:pixel(x, 24) }
      for c = 1, 3 do near(got[c], light_of(want[c]), 1e-7, ("%s, x %d, component %d"):format(name, x, c)) end
    end
    return mesh
  end
  for _, format in ipairs { "ascii", "binary_little_endian", "binary_big_endian" } do
    local mesh = shows("faces.ply", colored(format, nil, { RED, SKY }), RED, SKY)
    check(#mesh.materials == 2 and mesh.materials[1].name == "#ff0000" and mesh.materials[2].name == "#1080f0", "materials by name")
    check(is(mesh.materials[1].specular, 0, 0, 0), "without a highlight")
    mesh = shows("corners.ply", colored(format, { SKY, SKY, SKY, RED, RED, RED }), SKY, RED)
    check(#mesh.materials == 2, "corners that agree")
    shows("both.ply", colored(format, { RED, RED, RED, RED, RED, RED }, { SKY, BLUE }), SKY, BLUE)
    -- The mean in linear light, rounded to a pixel value: two thirds red, one third blue.
    local r, b = 0, 0
    while light_of(r + 0.5) < 2 / 3 do r = r + 1 end
    while light_of(b + 0.5) < 1 / 3 do b = b + 1 end
    shows("mean.ply", colored(format, { RED, BLUE, RED, SKY, SKY, SKY }), { r, 0, b }, SKY)
  end
  check(#load("one.ply", colored("ascii", nil, { SKY, SKY })).materials == 1, "one colour is one material")
  local own = glint.material { diffuse = 0.5 }
  local mesh = glint.mesh { file = write("own.ply", colored("ascii", nil, { RED, SKY })), material = own }
  check(#mesh.materials == 1 and mesh.material == own, "a material of the script comes first")
  refuses(":15: vertex 2 of 6: a colour value 0 .. 255 expected, got 256", "a.ply",
    colored("ascii", { RED, { 0, 256, 0 }, RED, RED, RED, RED }))
  refuses(":20: face 1 of 2: a colour value 0 .. 255 expected, got 0.5", "a.ply", colored("ascii", nil, { { 0, 0, 0.5 }, RED }))
end

-- ---- Invalid files ----

function tests.refused()
  local head = "ply\nformat ascii 1.0\n"
  local vertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
  local face = "element face 1\nproperty list uchar int vertex_indices\n"
  refuses(":1: ply expected, got 'plyx'", "a.ply", "plyx\n")
  refuses(":1: ply expected, got the end of the line", "a.ply", "")
  refuses(":2: format ascii, binary_little_endian or binary_big_endian expected, got 'utf8'", "a.ply", "ply\nformat utf8 1.0\n")
  refuses(":3: one of the types char, uchar, short, ushort, int, uint, float and double expected, got 'flaot'", "a.ply",
    "ply\nelement vertex 3\nproperty flaot x\n")
  refuses(":3: property TYPE NAME or property list TYPE TYPE NAME expected, got 'property'", "a.ply",
    "ply\nelement face 3\nproperty list float int vertex_indices\n")
  refuses(":7: a property once expected, got 'x'", "a.ply", head .. vertex .. "property int x\n")
  refuses(":7: an element once expected, got 'vertex'", "a.ply", head .. vertex .. vertex)
  refuses(":3: element NAME COUNT expected, got 'element'", "a.ply", head .. "element vertex -1\n")
  refuses(":2: format, comment, element, property or end_header expected, got 'property'", "a.ply", "ply\nproperty float x\n")
  refuses(":7: end_header expected, got 'the end of the file'", "a.ply", head .. vertex)
  refuses(":2: format above end_header expected, got 'end_header'", "a.ply", "ply\nend_header\n")
  refuses(": an element vertex with x, y and z expected", "a.ply", head .. face .. "end_header\n3 0 1 2\n")
  refuses(": an element face with a list vertex_indices expected, got 3 vertices and no face; " ..
    "glint.points reads point clouds", "a.ply",
    head .. vertex .. "end_header\n0 0 0\n1 0 0\n0 1 0\n")
  refuses(": element vertex: rows that fit into the file expected, got 1000000000000", "a.ply",
    head .. "element vertex 1000000000000\nproperty int x\nproperty int y\nproperty int z\n" .. face .. "end_header\n")
  refuses(": element dust: rows that fit into the file expected, got 9", "a.ply", head .. "element dust 9\n" .. vertex .. face ..
    "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
  local body = head .. vertex .. face .. "end_header\n0 0 0\n1 0 0\n0 1 0\n"
  refuses(":13: face 1 of 1: a vertex number 0 .. 2 expected, got 3", "a.ply", body .. "3 0 1 3\n")
  refuses(":13: face 1 of 1: a vertex number 0 .. 2 expected, got -1", "a.ply", body .. "3 0 1 -1\n")
  refuses(":13: face 1 of 1: a vertex number 0 .. 2 expected, got 1.5", "a.ply", body .. "3 0 1 1.5\n")
  refuses(": a face of 3 corners or more expected, got none", "a.ply", body .. "2 0 1\n")
  refuses(":14: face 1 of 1: a line expected, got the end of the file", "a.ply", body .. "3 0 1\n")
  refuses(":13: face 1 of 1: the end of the line expected, got more numbers", "a.ply", body .. "3 0 1 2 2\n")
  refuses(":13: face 1 of 1: a line expected, got the end of the file", "a.ply", body)
  refuses(":12: vertex 3 of 3: a number expected, got 'red 0'", "a.ply", head .. vertex .. face .. "end_header\n0 0 0\n1 0 0\n0 red 0\n3 0 1 2\n")
  refuses(":2: facet or endsolid expected, got 'faces'", "a.stl", "solid x\nfaces\n")
  refuses(":3: outer expected, got 'vertex 0 0 0'", "a.stl", "solid x\nfacet normal 0 0 1\nvertex 0 0 0\n")
  refuses(":4: outer expected, got 'the end of the file'", "a.stl", "solid x\nfacet normal 0 0 1\n\n")
  refuses(": triangles expected, got none", "a.stl", "solid x\nendsolid x\n")
  refuses(":1: the first word solid expected, got '12345'", "a.stl", "12345")
  refuses(": \"solid\" or 84 bytes and 50 for each of its 0 triangles expected, got 5 bytes", "a.stl", "1234\0")
  refuses(": faces expected, got only faces with a vertex that is not finite", "a.stl", ("\0"):rep(80) .. "\1\0\0\0" .. ("<f"):pack(0 / 0):rep(12) .. "\0\0")
end

-- The result is a mesh or a message, wherever a file is truncated and whatever value a byte is changed to.
function tests.cut_short_and_changed()
  write("some file.mtl", MATERIALS)
  local files = { { "cut.obj", PLATES }, { "cut.stl", text_stl() }, { "bin.stl", binary_stl() }, { "cut.ply", ply "ascii" },
    { "little.ply", ply "binary_little_endian" }, { "big.ply", ply "binary_big_endian" },
    { "color.ply", colored("ascii", nil, { { 1, 2, 3 }, { 4, 5, 6 } }) } }
  for _, file in ipairs(files) do
    local name, text, bad = file[1], file[2], 0
    for i = 0, #text - 1 do
      for _, try in ipairs { text:sub(1, i), text:sub(1, i) .. string.char((text:byte(i + 1) + 77 * i + 1) % 256) .. text:sub(i + 2) } do
        local good, message = pcall(glint.mesh, { file = write(name, try) })
        bad = bad + (good and 0 or 1)
        if not good then check(message:find("^" .. (folder .. "/" .. name):gsub("%p", "%%%0") .. ":[%d ]"), "byte %d of %s: %s", i, name, message) end
      end
    end
    check(bad > #text / 2, "%s: %d of %d were refused", name, bad, 2 * #text)
  end
end

tests.colours_by_face_again = tests.colours_by_face -- runs once more, after the files of the other tests
tally.run(tests)
tally.finish()
