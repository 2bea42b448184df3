-- Mesh files as real programs write them, beyond the formats' own examples: line ends, byte order marks, degenerate
-- faces and normals, colours, strips, unrelated statements, wrong lines in .mtl files, other formats.
local build = os.getenv "BUILD" or "build"
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local folder = build .. "/tests/mesh_variants"
assert(os.execute(("rm -rf '%s' && mkdir -p '%s/sub'"):format(folder, folder)))

local function write(name, ...)
  local path = folder .. "/" .. name
  local file = assert(io.open(path, "wb"))
  assert(file:write(...))
  assert(file:close())
  return path
end

-- Warnings come from the command: it loads the mesh, and a test compares its output without the path.
local function warnings_of(path)
  local script = write("try.lua", ("local glint = require 'glint' glint.mesh { file = %q }"):format(path))
  local pipe = assert(io.popen(("'%s' '%s' -o none 2>&1"):format(os.getenv "GLINT" or build .. "/glint", script)))
  local list = {}
  for line in pipe:lines() do
    local text = line:match "^glint: warning: (.*)$"
    if text then list[#list + 1] = (text:gsub("^" .. path:gsub("%p", "%%%0") .. ":( ?)", function(blank) return blank == "" and ":" or "" end)) end
  end
  pipe:close()
  return list
end

local function warns(want, path)
  local list = warnings_of(path)
  check(table.concat(list, "\n") == want, "<%s> expected, got <%s>", want, table.concat(list, "\n"))
end

local function load(name, ...) return glint.mesh { file = write(name, ...) } end

local function refuses(want, name, ...)
  local path = write(name, ...)
  local good, message = pcall(glint.mesh, { file = path })
  check(not good and message == path .. want, "<%s> expected, got <%s>", want, message)
end

local function is(v, r, g, b) return v[1] == r and v[2] == g and v[3] == b end

local tests = {}

local BOM <const> = "\xef\xbb\xbf"
local TRIANGLE <const> = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
local STL <const> = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
local HEAD <const> = "ply\nformat ascii 1.0\n"
local VERTEX <const> = "property float x\nproperty float y\nproperty float z\n"
local FACE <const> = "element face 1\nproperty list uchar int vertex_indices\n"
local PLY <const> = HEAD .. "element vertex 3\n" .. VERTEX .. FACE .. "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"

function tests.line_ends_and_marks()
  write("m.mtl", BOM .. "newmtl a\rKd 1 0 0\r")
  for _, ending in ipairs { "\n", "\r\n", "\r", "\r\r\n" } do
    for _, mark in ipairs { "", BOM } do
      local text = "mtllib m.mtl\n" .. TRIANGLE .. "# a comment\n\nusemtl a\nf 1 2 \\\n3\n"
      local mesh = load("a.obj", mark .. text:gsub("\n", ending))
      check(mesh.count == 1 and is(mesh.materials[1].diffuse, 1, 0, 0), "%q of .obj and .mtl", mark .. ending)
      check(load("a.stl", mark .. STL:gsub("\n", ending)).count == 1, "%q of .stl", mark .. ending)
      check(load("a.ply", mark .. PLY:gsub("\n", ending)).count == 1, "%q of .ply", mark .. ending)
      refuses(":5: a number expected, got 'zero 0'", "b.obj", mark .. (TRIANGLE .. "\nv 0 zero 0\n"):gsub("\n", ending))
    end
  end
  -- The data after the header may begin with any byte.
  for _, ending in ipairs { "\n", "\r\n", "\r" } do
    for _, first in ipairs { "\n", "\r", "\xef" } do
      local head = ("ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar kind\n" .. VERTEX .. FACE .. "end_header\n")
        :gsub("\n", ending)
      local mesh = load("b.ply", head, first, ("<fffBfffBfffBi4i4i4"):pack(0, 0, 0, 1, 1, 0, 0, 2, 0, 1, 0, 3, 0, 1, 2))
      check(mesh.count == 1 and mesh.max.y == 1, "%q before %q", ending, first)
    end
  end
end

function tests.faces_that_are_none()
  local path = write("f.obj", TRIANGLE .. "f 1 1 2\nf 1 2 3\nf 1 2\nf 3 2\nf 1\n")
  check(glint.mesh { file = path }.count == 1, "one triangle")
  warns("1 of 2 faces are left out: they have no area\n:6: a face of fewer than 3 corners is left out, and 2 more", path)
  refuses(": faces expected, got 3 vertices and none", "f.obj", TRIANGLE .. "f 1 2\n")
  for _, text in ipairs { "f 1//0 2//0 3//0", "f 1/0 2/0 3/0", "f 1// 2// 3//", "f 1/ 2/ 3/", "f 1/0/0 2/0/0 3/0/0",
    "fo 1 2 3" } do
    check(load("c.obj", TRIANGLE, text, "\n").count == 1, "%s", text)
    check(warnings_of(folder .. "/c.obj")[1] == nil, "%s: no warning", text)
  end
  for text, want in pairs { ["f 1 2 3//1"] = "normal 1", ["f 1//5 2//5 3//4"] = "normal 5", ["f 1/9 2/9 3/9"] = "texture coordinate 9",
    ["f 1/1/ 2/1/ 3/1/"] = "texture coordinate 1" } do
    path = write("none.obj", TRIANGLE, text, "\n")
    check(glint.mesh { file = path }.count == 1, "%s", text)
    warns((":4: %s is ignored: the file has none"):format(want), path)
  end
  check(load("late.obj", "f 1 2 3\n", TRIANGLE).count == 1, "faces before vertices")
  refuses(":4: a vertex number 1 .. 3 expected, got '4'", "far.obj", TRIANGLE .. "f 1 2 4\nf 1 2 3\n")
  refuses(":5: a normal number 1 .. 1 expected, got '2'", "far.obj", TRIANGLE .. "vn 0 0 1\nf 1//2 2//1 3//1\n")
  refuses(":4: a vertex number 1 .. 3 expected, got '0 1 2'", "far.obj", TRIANGLE .. "f 0 1 2\n")
  path = write("n.obj", TRIANGLE .. "vn 0 0 1\nvn 0 0 0\nvn nan 0 0\nf 1//1 2//2 3//1\n")
  local mesh = glint.mesh { file = path }
  check(mesh.count == 1 and mesh.shading == "phong", "a normal of 0 is none")
  warns(":5: a normal of length 0 is ignored, and 1 more", path)
  path = write("nan.obj", TRIANGLE .. "v nan 0 0\nv inf 0 0\nf 1 2 3\nf 1 2 4\nf 3 2 5\n")
  mesh = glint.mesh { file = path }
  check(mesh.count == 1 and mesh.max.x == 1, "faces of vertices that are not finite")
  warns("face 2 is left out: one of its vertices is not finite, and 1 more", path)
  path = write("cross.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 2 0\nf 1 2 3 4\nf 1 2 3\n")
  check(glint.mesh { file = path }.count == 3, "a polygon that crosses itself is a fan")
  warns("1 of 2 faces cross themselves: they are split into fans of triangles", path)
end

function tests.statements_of_other_uses()
  local path = write("s.obj", "cstype bspline\ndeg 3\n" .. TRIANGLE .. "curv 0 1 1 2 3\nend\nvp 0 1\nl 1 2\np 1\nsolid x\nweird\nf 1 2 3\n")
  check(glint.mesh { file = path }.count == 1, "the mesh is there")
  warns(":1: 'cstype' is ignored: free-form curves and surfaces are not read, and 3 more\n" ..
    ":11: 'solid' is ignored: not a statement of .obj files, and 1 more", path)
  refuses(": faces expected, got 0 vertices and none: is it a Wavefront .obj?", "text.obj", "Dear reader,\nthis is no mesh.\n")
end

function tests.numbers_as_programs_write_them()
  for _, one in ipairs { "1.0D+00", "1d0", "0.1D1", "10.-1", "1.0+000", "1e0", "+1.", "1.0E+000" } do
    check(load("n.obj", (TRIANGLE:gsub("1", one)), "f 1 2 3\n").max.x == 1, "%s of .obj", one)
    check(load("n.stl", (STL:gsub("vertex 1 0 0", "vertex " .. one .. " 0 0"))).max.x == 1, "%s of .stl", one)
    check(load("n.ply", (PLY:gsub("\n1 0 0", "\n" .. one .. " 0 0"))).max.x == 1, "%s of .ply", one)
    write("n.mtl", "newmtl a\nKd ", one, " 0 0\n")
    check(is(load("n.obj", "mtllib n.mtl\n", TRIANGLE, "usemtl a\nf 1 2 3\n").materials[1].diffuse, 1, 0, 0), "%s of .mtl", one)
  end
  for _, none in ipairs { "nan", "-1.#IND", "1.#QNAN", "1.#INF", "inf", "-nan(ind)" } do
    local path = write("n.obj", "v 0 0 ", none, "\n", TRIANGLE, "f 1 2 3\nf 2 3 4\n")
    check(glint.mesh { file = path }.count == 1, "%s of .obj", none)
    warns("face 1 is left out: one of its vertices is not finite", path)
    path = write("n.stl", "solid a\n", (STL:gsub("solid a\n", "", 1):gsub("vertex 1 0 0", "vertex " .. none .. " 0 0")), STL)
    check(glint.mesh { file = path }.count == 1, "%s of .stl", none)
    warns("face 1 is left out: one of its vertices is not finite", path)
  end
  for _, wrong in ipairs { "1.0D", "1.0DD0", "1.0-x", "1,0", "0x" } do
    refuses((":2: a number expected, got '%s 0'"):format(wrong), "n.obj", "v 0 0 0\nv 1 ", wrong, " 0\nv 0 1 0\nf 1 2 3\n")
  end
  refuses(":2: a number expected, got the end of the line", "n.obj", "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n")
  check(load("n.obj", "v 0 0 0# a\nv 1 0 0 #b\nv 0 1 0\nf 1 2 3# c\n").count == 1, "comments behind numbers")
end

function tests.messages_of_a_script()
  local mesh = write("bad.obj", TRIANGLE, "v x 0 0\n")
  local script = write("bad.lua", ("local function load(path)\n  return require 'glint'.mesh { file = path }, 1\nend\nload %q\n"):format(mesh))
  local pipe = assert(io.popen(("'%s' '%s' -o none 2>&1"):format(os.getenv "GLINT" or build .. "/glint", script)))
  local got = pipe:read "a"
  pipe:close()
  check(got == ("glint: error: %s:4: a number expected, got 'x 0 0'\n  called from %s:2\n  called from %s:4\n"):format(mesh, script, script),
    "the file's line first, then the script's: %s", got)
end

function tests.colours_of_vertices()
  local function color(text) return load("v.obj", text).materials[1].diffuse end
  check(is(color "v 0 0 0 1.002 0 0\nv 1 0 0 1 0 0\nv 0 1 0 0.99999 0 0\nf 1 2 3\n", 1, 0, 0), "a little above 1")
  check(is(color(TRIANGLE .. "#MRGB ff00ff00ff00ff00\n#MRGB ff00ff00\nf 1 2 3\n"), 0, 1, 0), "#MRGB of ZBrush")
  check(is(color "v 0 0 0 0 0 -1\nv 1 0 0 0 0 1\nv 0 1 0 0 1 0\nf 1 2 3\n", 0.8, 0.8, 0.8), "normals are no colours")
  warns(":1: the numbers after the coordinates are ignored: colours 0 .. 1 or 0 .. 255 expected", folder .. "/v.obj")
  check(is(color "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n", 1, 0, 0), "0 .. 1")
  check(is(color "v 0 0 0 0 255 0\nv 1 0 0 0 255 0\nv 0 1 0 0 255 0\nf 1 2 3\n", 0, 1, 0), "0 .. 255")
  check(is(color "v 0 0 0 0 0 1 1\nv 1 0 0 0 0 1 1\nv 0 1 0 0 0 1 1\nf 1 2 3\n", 0, 0, 1), "with alpha")
  check(is(color "v 0 0 0 1.0\nv 1 0 0 1.0\nv 0 1 0 1.0\nf 1 2 3\n", 0.8, 0.8, 0.8), "a weight is no colour")
  local mesh = load("v.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nv 5 0 0 0 0 1\nv 6 0 0 0 0 1\nv 5 1 0 0 0 1\nf 1 2 3\nf 4 5 6\n")
  check(#mesh.materials == 2 and mesh.materials[1].name == "#ff0000" and mesh.materials[2].name == "#0000ff", "a material a colour")
  check(#load("v.obj", TRIANGLE, "v 5 0 0 0 0 1\nf 1 2 3\nf 2 3 4\n").materials == 2, "vertices without a colour are grey")
  write("v.mtl", "newmtl a\nKd 0 1 0\n")
  local text = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nusemtl a\nf 1 2 3\n"
  check(is(color("mtllib v.mtl\n" .. text), 0, 1, 0), "materials come first")
  warns("the colours of its vertices are ignored: its faces have materials", folder .. "/v.obj")
  check(is(color(text), 1, 0, 0), "a material that no file has does not")
  check(is(glint.mesh { file = folder .. "/v.obj", material = glint.material { diffuse = 0.5 } }.material.diffuse, 0.5, 0.5, 0.5),
    "a material of the script comes first")
end

function tests.materials()
  local function material(text)
    write("t.mtl", text)
    return load("t.obj", "mtllib t.mtl\n", TRIANGLE, "vt 0 0\nusemtl a\nf 1/1 2/1 3/1\n").materials[1]
  end
  local path = folder .. "/t.obj"
  for _, text in ipairs { "d 1.0\nTr 1.0", "Tr 1.0\nd 1.0" } do
    local m = material("newmtl a\nKd 1 0 0\n" .. text .. "\n")
    check(is(m.diffuse, 1, 0, 0) and is(m.transmission, 0, 0, 0), "d counts where both stand")
    warns("", path)
  end
  check(is(material("newmtl a\nKd 1 0 0\nTr 1\n").transmission, 1, 1, 1), "Tr 1")
  warns("material 'a' cannot be seen: d 0, or Tr 1, lets all light through", path)
  check(is(material("newmtl a\nKd 255 0 0\n").diffuse, 255, 0, 0), "Kd 255 as it stands")
  warns("material 'a' has Kd 255 0 0: numbers 0 .. 1 expected; divide a colour of bytes by 255", path)
  material "newmtl a\nKd 1 1 1\nKs 200 200 1.5\n"
  warns("material 'a' has Ks 200 200 1.5: numbers 0 .. 1 expected; divide a colour of bytes by 255", path)
  local m = material "newmtl b\nNs -1\nnewmtl a\nKd 0.25 0.5 0.75\nKd 1 red 0\nNs 12\nKs spectral x.rfl\nd 2\nmap_Kd -clamp on\nNs 9\n"
  check(is(m.diffuse, 0.25, 0.5, 0.75) and m.shininess == 9 and is(m.specular, 0, 0, 0), "a bad line is one line")
  local mtl = folder .. "/t.mtl: "
  warns(folder .. "/t.mtl:2: a number >= 0 expected, got '-1'; the line is ignored, and 4 more", path)
  material "newmtl a\nKd 1 1 1 # white\nKe 0 0 0\nKe 2 0 0\nKa 1 1 1\nnorm n.png\nnorm m.png\nmap_Pr r.png\nPs 0\nNi 1.45\nTf 1 1 1\nwhatever\n"
  warns(mtl .. "Ke, norm, map_Pr, whatever are ignored: not a field of a material", path)
  m = material "newmtl a\nKd 1 0.5 0\nPr 0.25\nPm 1\nKs 0.5 0.5 0.5\nillum 3\n"
  check(m.model == "cook_torrance" and m.roughness == 0.25 and is(m.f0, 1, 0.5, 0) and is(m.diffuse, 0, 0, 0) and is(m.mirror, 1, 1, 1), "a metal")
  m = material "newmtl a\nKd 1 0.5 0\nPr 0.75\n"
  check(m.roughness == 0.75 and math.abs(m.f0[1] - 0.04) < 1e-15 and is(m.diffuse, 1, 0.5, 0) and is(m.specular, 1, 1, 1), "a rough plastic")
  for illum = 0, 10 do
    m = material(("newmtl a\nKd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nNi 1.4\nillum %d\n"):format(illum))
    local has_mirror, is_fresnel = illum >= 3 and illum <= 7, illum == 5 or illum == 7
    check(is(m.mirror, table.unpack(has_mirror and { 0.25, 0.25, 0.25 } or { 0, 0, 0 })) and m.fresnel == is_fresnel, "illum %d", illum)
    check(is(m.specular, table.unpack(illum < 2 and { 0, 0, 0 } or { 0.25, 0.25, 0.25 })), "illum %d: a highlight", illum)
    m = material(("newmtl a\nKd 0.5 0.5 0.5\nNi 1.4\nd 0.5\nillum %d\n"):format(illum))
    check(m.ior == ((illum == 6 or illum == 7) and 1.4 or 1) and is(m.transmission, 0.5, 0.5, 0.5), "illum %d: what is bent", illum)
  end
  material "newmtl a\nKd 1 1 1\nTf 0.5 1 1\nillum 11\nmap_d -mm 0 0.5 none.png\nmap_d -mm 0 1 -imfchan l none.png\n"
  warns(folder .. "/t.mtl:4: a number 0 .. 10 expected, got '11'; the line is ignored\n" ..
    mtl .. "Tf, -mm, -imfchan are ignored: not a field of a material\n" ..
    ("material 'a' has its d instead of its map_d: %s/none.png: No such file or directory"):format(folder), path)
  write("t.mtl", ("\xff\xfenewmtl a\n"):gsub("[%g\n]", "%0\0"))
  load("t.obj", "mtllib t.mtl # of Notepad\n", TRIANGLE, "usemtl a\nf 1 2 3\n")
  warns("some of its materials are missing: " .. folder .. "/t.mtl: is UTF-16, not UTF-8", path)
  write("my file.mtl", "newmtl a\nKd 0 0 1\n")
  check(is(load("q.obj", "mtllib \"my file.mtl\"\n", TRIANGLE, "usemtl a\nf 1 2 3\n").materials[1].diffuse, 0, 0, 1), "a name in quotes")
  write("base.mtl", "newmtl a\nKd 0 1 1\n")
  check(is(load("q.obj", "mtllib C:\\work\\base.mtl\n", TRIANGLE, "usemtl a\nf 1 2 3\n").materials[1].diffuse, 0, 1, 1),
    "a path of another machine: the file of that name beside the mesh")
end

function tests.stl()
  local one = { ("\0"):rep(80), ("<I4"):pack(1), ("<fff"):pack(0, 0, 1), ("<fff"):pack(0, 0, 0), ("<fff"):pack(1, 0, 0),
    ("<fff"):pack(0, 1, 0), "\0\0" }
  local binary = table.concat(one)
  one[1] = ("solid of CAD"):rep(7):sub(1, 80)
  for name, text in pairs { blank = " " .. STL, lines = "\n\t\n" .. STL, capitals = STL:upper(), two = STL .. "\n" .. STL, exact = binary } do
    check(load("a.stl", text).count == (name == "two" and 2 or 1), "%s", name)
    warns("", folder .. "/a.stl")
  end
  for extra = 1, 101, 50 do
    for _, text in ipairs { binary, table.concat(one) } do
      local path = write("long.stl", text, ("\0"):rep(extra))
      check(glint.mesh { file = path }.count == 1, "%d bytes more", extra)
      warns(("the data after the last triangle is ignored: bytes 134 .. %d"):format(133 + extra), path)
    end
  end
  one[1] = ("solid facet by CAD"):rep(9):sub(1, 80)
  check(load("facet.stl", table.concat(one), "\0\0").count == 1, "a head that has the words of a text")
  one[1] = "COLOR=\255\0\0\255" .. ("\0"):rep(70)
  check(load("color.stl", table.concat(one)).count == 1, "colours")
  warns("its colours are ignored: glint reads those of VisCAM's form, not of Magics'", folder .. "/color.stl")
  one[1] = "made by\0COLOR=\255\0\0\255" .. ("\0"):rep(62)
  check(load("color.stl", table.concat(one)).count == 1, "colours after a zero")
  warns("its colours are ignored: glint reads those of VisCAM's form, not of Magics'", folder .. "/color.stl")
  check(load("color.stl", (STL:gsub("solid a\n", "%0# made by hand\ncolor 1 0 0\n", 1))).count == 1, "lines between facets")
  warns(":2: this line, between facets, is ignored, and 1 more", folder .. "/color.stl")
  refuses(":1: the first word solid expected, got 'facet normal 0 0 1 outer loop vertex 0 0'", "no.stl", (STL:gsub("solid a\n", "", 1)))
  local path = write("end.stl", STL, "\26\nmade by hand\n", STL)
  check(glint.mesh { file = path }.count == 2, "words between solids")
  warns(":10: this line, after the solid, is ignored, and 1 more", path)
  refuses(": \"solid\" or 84 bytes and 50 for each of its 1 triangles expected, got 133 bytes", "short.stl", binary:sub(1, -2))
  check(load("stl.txt", STL).count == 1 and load("ply.txt", PLY).count == 1, "by the first bytes, where the name says nothing")
end

function tests.colours_of_ply()
  local function color(kind, a, b)
    local colors = ("property %s red\nproperty %s green\nproperty %s blue\n"):format(kind, kind, kind)
    local vertices = ("0 0 0 %s\n1 0 0 %s\n0 1 0 %s\n3 0 1 2\n"):format(a, b, a)
    return load("c.ply", HEAD, "element vertex 3\n", VERTEX, colors, FACE, "end_header\n", vertices).materials[1].name
  end
  for kind, codes in pairs { uchar = "255 0 51", float = "1 0 0.2", double = "1.0001 0 .2", float32 = "255 0 51", ushort = "65535 0 13107",
    int = "255 0 51", uint8 = "255 0 51", char = "127 0 51" } do
    check(color(kind, codes, codes) == (kind == "char" and "#7f0033" or "#ff0033"), "%s: %s", kind, color(kind, codes, codes))
  end
  check(color("float", "1 0 0", "-1 0 0") == "", "normals are no colours")
  warns("vertex 2: its colours are ignored: red, green and blue 0 .. 1 expected", folder .. "/c.ply")
  local mesh = load("c.ply", HEAD, "element vertex 3\n", VERTEX, FACE, "property float red\nproperty float green\nproperty float blue\n",
    "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0 1 0\n")
  check(mesh.materials[1].name == "#00ff00", "of faces")
end

function tests.ply()
  local vertices = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
  local strips = "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
  local mesh = load("s.ply", HEAD, "element vertex 4\n", VERTEX, strips, vertices, "4 0 1 2 3\n")
  check(mesh.count == 2, "a strip of two triangles")
  local scene = glint.scene { mesh }
  for _, at in ipairs { { 0.2, 0.2 }, { 0.9, 0.9 } } do
    check(scene:cast({ at[1], at[2], 5 }, { 0, 0, -1 }).normal.z == 1, "both are seen from the front")
  end
  mesh = load("s.ply", HEAD, "element vertex 4\n", VERTEX, strips, vertices, "6 0 1 2 2 2 3\n")
  check(mesh.count == 1 and not warnings_of(folder .. "/s.ply")[1], "corners named twice join two parts of a strip")
  mesh = load("s.ply", HEAD, "element vertex 4\n", VERTEX, strips, vertices, "11 0 1\n2 -1 1 3 2 -1\n0 1 -1\n")
  check(mesh.count == 2, "-1 ends a strip; a list goes over several lines")
  local binary = HEAD:gsub("ascii", "binary_big_endian")
  mesh = load("s.ply", binary, "element vertex 4\n", VERTEX, strips, (">fffffffffffff"):sub(1, 13):pack(0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0),
    (">i4i4i4i4i4"):pack(4, 0, 1, 2, 3))
  check(mesh.count == 2, "binary")
  refuses(":14: tristrips 1 of 1: a vertex number 0 .. 3 expected, got -2", "s.ply", HEAD, "element vertex 4\n", VERTEX, strips, vertices,
    "3 0 1 -2\n")
  check(load("l.ply", HEAD, "element vertex 3\n", VERTEX, FACE, "end_header\n0\n0 0\n1 0\n0\n\n0 1 0\n3 0\n1 2\n").count == 1,
    "a vertex over several lines")
  mesh = load("nan.ply", HEAD, "element vertex 4\n", VERTEX, FACE, "end_header\n0 0 0\n1 0 0\nnan nan nan\n0 1 0\n3 0 1 3\n")
  check(mesh.count == 1 and mesh.max.x == 1 and mesh.min.x == 0, "an unused vertex that is not finite")
  local path = write("two.ply", HEAD, "element vertex 3\n", VERTEX, "element face 3\nproperty list uchar int vertex_indices\n",
    "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n0 0 0\n1 0 0\n0 1 0\n2 0 1 255 0 0\n3 0 1 2 0 0 255\n1 0 0 0 0\n")
  mesh = glint.mesh { file = path }
  check(mesh.count == 1 and mesh.materials[1].name == "#0000ff", "faces of two corners, whose colours go with them")
  warns("face 1 of fewer than 3 corners is left out, and 1 more", path)
end

function tests.pictures_of_ply()
  glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1, background = { 0, 1, 0 },
    glint.plane { point = { 0, 0, 0 }, normal = { 1, 0, 0 }, material = glint.material { diffuse = { 1, 0, 0 } } },
  }:render { width = 8, height = 8 }:save(folder .. "/sub/green.png")
  local corners = "end_header\n-1 -1 0%s\n1 -1 0%s\n1 1 0%s\n"
  local by_vertex = HEAD .. "comment TextureFile sub/green.png\nelement vertex 3\n" .. VERTEX .. "property float s\nproperty float t\n" .. FACE ..
    corners:format(" 0 0", " 1 0", " 1 1") .. "3 0 1 2\n"
  local by_corner = HEAD .. "comment TextureFile sub/green.png\nelement vertex 3\n" .. VERTEX .. FACE ..
    "property list uchar float texcoord\n" .. corners:format("", "", "") .. "3 0 1 2 6 0 0 1 0 1 1\n"
  for _, text in ipairs { by_vertex, by_corner } do
    local path = write("p.ply", text)
    local image = glint.scene { camera = glint.camera { eye = { 0, 0, 4 }, at = { 0, 0, 0 } }, ambient = 1, glint.mesh { file = path } }
      :render { width = 16, height = 16 }
    local r, g, b = image:pixel(9, 9)
    check(r < 1e-6 and math.abs(g - 1) < 1e-6 and b < 1e-6, "the picture shows, got %g %g %g", r, g, b)
    warns("", path)
  end
  local path = write("p.ply", (PLY:gsub("element vertex", "comment TextureFile none.png\n%0", 1)))
  check(glint.mesh { file = path }.count == 1, "no coordinates")
  warns("its picture none.png is ignored: there are no texture coordinates (s, t)", path)
  path = write("p.ply", (by_corner:gsub("green.png", "none.png")))
  check(is(glint.mesh { file = path }.materials[1].diffuse, 0.8, 0.8, 0.8), "no picture")
  warns("its picture is ignored: " .. folder .. "/sub/none.png: No such file or directory", path)
end

function tests.formats_that_are_not_read()
  for _, case in ipairs { { "a.glb", "glTF\2\0\0\0", "glTF" }, { "a.gltf", "{}", "glTF" }, { "a.off", "OFF\n3 1 0\n", "OFF" },
    { "a.3mf", "PK\3\4", "a zip archive, as .3mf and .usdz are" }, { "b.3mf", "x", "3MF" }, { "a.cif", "data_x\n", "CIF" }, { "a.obj", "glTF\2", "glTF" },
    { "b.obj", "\xff\xfev\0 \0", "UTF-16, not UTF-8" }, { "a.fbx", "Kaydara FBX Binary", "FBX" }, { "a.step", "ISO-10303-21;", "STEP" },
    { "a.obj.gz", "\x1f\x8b\8", "compressed" }, { "a.dae", "<?xml", "XML" }, { "a.GLB", "", "glTF" } } do
    refuses(": is " .. case[3] .. "; glint reads .obj .stl .ply", case[1], case[2])
  end
end

-- Pictures of 8 x 8 pixels: one in the colour rgb(200, 40, 90), and one in grey, 128.
local JPEG <const> = "ffd8ffdb0043000201010101010201010102020202020403020202020504040304060506060605060606070908060709070606080b08090a0a0a0a0a" ..
  "06080b0c0b0a0c090a0a0affdb004301020202020202050303050a0706070a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a" ..
  "0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0affc00011080008000803012200021101031101ffc400150001010000000000000000000000000000" ..
  "0008ffc40014100100000000000000000000000000000000ffc4001501010100000000000000000000000000000409ffc40014110100000000000000" ..
  "000000000000000000ffda000c03010002110311003f009dc01d4c1fffd9"
local GREY <const> = "ffd8ffdb0043000201010101010201010102020202020403020202020504040304060506060605060606070908060709070606080b08090a0a0a0a0a" ..
  "06080b0c0b0a0c090a0a0affc0000b080008000801011100ffc40014000100000000000000000000000000000000ffc4001410010000000000000000" ..
  "0000000000000000ffda0008010100003f003fffd9"

local function bytes_of(hex)
  return (hex:gsub("%x%x", function(digits) return string.char(tonumber(digits, 16)) end))
end

-- A picture of 16 x 16 pixels in four parts: 0 and 85, below them 170 and 255.
local PARTS <const> = "ffd8ffe000104a46494600010100000100010000ffdb0043000101010101010101010101010101010101010101010101010101010101010101010101" ..
  "0101010101010101010101010101010101010101010101010101010101ffc0000b080010001001011100ffc400150001010000000000000000000000" ..
  "0000000a0bffc40014100100000000000000000000000000000000ffda0008010100003f009ff9541541543fffd9"

-- The displayed corners for each value of the Exif tag Orientation, where the stored corners are 1 2 / 3 4.
local TURNED <const> = { "1234", "2143", "4321", "3412", "1324", "3142", "4231", "2413" }

-- Returns a JPEG with an Exif block that has one tag, in either byte order.
local function turned(orientation, order)
  local tiff = ((order == "<" and "II" or "MM") .. (order .. "I2I4I2I2I2I4I2I2I4"):pack(42, 8, 1, 0x112, 3, 1, orientation, 0, 0))
  local block = "Exif\0\0" .. tiff
  local text = bytes_of(PARTS)
  return text:sub(1, 2) .. "\xff\xe1" .. (">I2"):pack(#block + 2) .. block .. text:sub(3)
end

function tests.pictures_that_are_turned()
  local path = write("t.jpg", bytes_of(PARTS))
  if not pcall(glint.texture, { file = path }) then return end -- this build is without libjpeg
  for orientation, corners in ipairs(TURNED) do
    for _, order in ipairs { "<", ">" } do
      local texture, got = glint.texture { file = write("t.jpg", turned(orientation, order)), transfer = "linear" }, ""
      for _, uv in ipairs { { 0.2, 0.8 }, { 0.8, 0.8 }, { 0.2, 0.2 }, { 0.8, 0.2 } } do
        got = got .. ("%d"):format(math.floor(texture:evaluate { uv = uv }.x * 3 + 1.5))
      end
      check(got == corners, "orientation %d, %s: %s expected, got %s", orientation, order, corners, got)
    end
  end
  for _, wrong in ipairs { 0, 9, 65535 } do
    check(glint.texture { file = write("t.jpg", turned(wrong, "<")) } ~= nil, "orientation %d is none", wrong)
  end
end

function tests.other_pictures()
  for text, kind in pairs { ["GIF89a"] = "GIF", ["BM\0\0"] = "BMP", ["II*\0"] = "TIFF", ["MM\0*"] = "TIFF", ["RIFF\0\0\0\0WEBP"] = "WebP",
    ["\0\0\0\12jP  "] = "JPEG 2000", ["<svg>"] = "SVG or another XML" } do
    local path = write("other.png", text .. ("\0"):rep(60))
    local good, message = pcall(glint.texture, { file = path })
    check(not good and message:find("other.png: is " .. kind .. "; textures are .png, .jpg, .hdr, .exr or .pfm", 1, true), "%s: %s", kind, message)
  end
end

function tests.jpeg()
  local path = write("c.jpg", bytes_of(JPEG))
  local good, texture = pcall(glint.texture, { file = path })
  if not good and tostring(texture):find("which this build of glint cannot read (libjpeg): save it as .png", 1, true) then return end
  check(good, "%s", texture)
  local color = texture:evaluate { uv = { 0.5, 0.5 } }
  for axis, code in pairs { x = 200, y = 40, z = 90 } do
    check(math.abs(color[axis] - ((code / 255 + 0.055) / 1.055) ^ 2.4) < 0.01, "%s: %g", axis, color[axis])
  end
  local grey = glint.texture { file = write("g.jpg", bytes_of(GREY)), transfer = "linear" }:evaluate { uv = { 0.5, 0.5 } }
  check(math.abs(grey.x - 128 / 255) < 1e-6 and grey.x == grey.z, "grey, got %g", grey.x)
  write("j.mtl", "newmtl a\nmap_Kd c.jpg\n")
  local mesh = load("j.obj", "mtllib j.mtl\n", TRIANGLE, "vt 0 0\nusemtl a\nf 1/1 2/1 3/1\n")
  warns("", folder .. "/j.obj")
  check(mesh.count == 1, "a picture of a material")
  local text = bytes_of(JPEG)
  for _, bad in ipairs { text:sub(1, 200), text:sub(1, -20), text:sub(1, 4), text:sub(1, 100) .. ("\255"):rep(100) } do
    local done, message = pcall(glint.texture, { file = write("bad.jpg", bad) })
    check(not done and message:find("bad.jpg: not a whole JPEG: ", 1, true), "a cut JPEG: %s", message)
  end
end

-- ---- Smoothing groups, colours of faces ----

-- Returns the values of a pass in a picture of a mesh, seen along -z.
local function look(path, pass, shading)
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0.4, 5 }, at = { 0, 0.4, 0 }, fov = 24 }, ambient = 0.1,
    glint.mesh { file = path, shading = shading }, glint.point_light { position = { 1, 2, 9 } } }
  return scene:render({ width = 33, height = 25, output = "none", passes = "beauty,normal,albedo" }):bytes(pass)
end

local ROOF <const> = "v 0 0 0\nv 1 0 -1\nv 0 1 0\nv -3 0 -1\n" -- two faces of different slopes that meet in a ridge

-- The same faces with normals computed by hand: their areas as vectors are (1, 0, 1) / 2 and (-1, 0, 3) / 2.
local function with_normals(ridge_1, ridge_2)
  return ROOF .. "vn 1 0 1\nvn -1 0 3\nvn 0 0 1\n" ..
    ("f 1//%d 2//1 3//%d\nf 1//%d 3//%d 4//2\n"):format(ridge_1, ridge_1, ridge_2, ridge_2)
end

function tests.smoothing_groups()
  local smooth, flat = write("smooth.obj", with_normals(3, 3)), write("flat.obj", ROOF .. "f 1 2 3\nf 1 3 4\n")
  for _, shading in ipairs { "phong", "gouraud", "flat", "faceted" } do
    local want = look(smooth, "beauty", shading)
    for _, group in ipairs { "s 1", "s 7", "s\t1 # one", "s 4294967294" } do
      local path = write("s.obj", ROOF .. group .. "\nf 1 2 3\ng other\nf 1 3 4\n")
      check(look(path, "beauty", shading) == want, "%s, %s", group, shading)
      check(look(path, "normal") == look(smooth, "normal"), "normals of %s", group)
      warns("", path)
    end
  end
  check(look(smooth, "normal") ~= look(flat, "normal"), "smooth and flat differ")
  for _, text in ipairs { "s off\nf 1 2 3\nf 1 3 4\n", "s 0\nf 1 2 3\nf 1 3 4\n", "f 1 2 3\nf 1 3 4\n", "s 1\ns off\nf 1 2 3\nf 1 3 4\ns 1\n" } do
    check(look(write("s.obj", ROOF .. text), "beauty") == look(flat, "beauty"), "%s", text)
  end
  local apart = look(write("apart.obj", with_normals(1, 2)), "beauty")
  for _, text in ipairs { "s 1\nf 1 2 3\ns 2\nf 1 3 4\n", "s 1\nf 1 2 3\ns off\nf 1 3 4\n" } do
    check(look(write("s.obj", ROOF .. text), "beauty") == apart, "groups share no normals: %s", text)
  end
  -- Normals of the file come first, and a polygon counts by its area.
  local own = ROOF .. "vn 0 1 1\ns 1\nf 1//1 2//1 3//1\nf 1 3 4\n"
  check(look(write("s.obj", own), "normal") ==
    look(write("own.obj", ROOF .. "vn 0 1 1\nvn 0 0 1\nvn -1 0 3\nf 1//1 2//1 3//1\nf 1//2 3//2 4//3\n"), "normal"), "a file with some normals")
  local quad = "v 0 0 0\nv 1 0 -1\nv 1 1 -1\nv 0 1 0\nv -2 0 -1\n" -- areas (1, 0, 1) and (-1, 0, 2) / 2
  check(look(write("s.obj", quad .. "s 3\nf 1 2 3 4\nf 1 4 5\n"), "normal") ==
    look(write("quad.obj", quad .. "vn 1 0 1\nvn 1 0 4\nvn -1 0 2\nf 1//2 2//1 3//1 4//2\nf 1//2 4//2 5//3\n"), "normal"), "a polygon and a triangle")
  -- Two faces back to back have no mean normal, and stay flat.
  check(look(write("s.obj", ROOF .. "s 1\nf 1 2 3\nf 3 2 1\n"), "normal") == look(write("f.obj", ROOF .. "f 1 2 3\nf 3 2 1\n"), "normal"), "back to back")
  check(load("s.obj", ROOF .. "s 1\nf 1//9 2//9 3//9\n").shading == "phong", "indices of normals that are missing")
  for _, text in ipairs { "on", "", "-1", "1.5", "99999999999" } do
    local path = write("s.obj", ROOF .. "s " .. text .. "\nf 1 2 3\n")
    check(glint.mesh { file = path }.shading == "faceted", "s %s", text)
    warns((":5: 's %s' is ignored: the number of a smoothing group, or off, expected"):format(text), path)
  end
end

function tests.colours_of_stl()
  local function stl(head, colors)
    local out = { (head .. ("\0"):rep(80)):sub(1, 80), ("<I4"):pack(#colors) }
    for i, bits in ipairs(colors) do
      local y = i - 1
      out[#out + 1] = ("<ffffffffffffI2"):pack(0, 0, 1, -1, y, 0, 1, y, 0, 0, y + 0.9, 0, bits)
    end
    return table.concat(out)
  end
  local function color(path, x, y)
    local scene = glint.scene { camera = glint.camera { eye = { x, y, 5 }, at = { x, y, 0 }, fov = 1 }, glint.mesh { file = path } }
    local image = scene:render { width = 1, height = 1, output = "none", passes = "beauty,albedo" }
    return { image:pixel(0, 0, "albedo") }
  end
  local path = write("viscam.stl", stl("made by hand", { 0xfc00, 0x83e0, 0x801f, 0x8000, 0x8421, 0x7fff, 0xffff }))
  local DARK <const> = 8 / 255 / 12.92 -- 1 of 31, as the 8-bit value 8
  for i, want in ipairs { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 0, 0, 0 }, { DARK, DARK, DARK }, { 0.8, 0.8, 0.8 }, { 1, 1, 1 } } do
    local got = color(path, 0, i - 0.8)
    for c = 1, 3 do tally.near(got[c], want[c], 0.002, ("channel %d of face %d"):format(c, i)) end
  end
  warns("", path)
  local dark = write("dark.stl", stl("", { 0x8421 }))
  tally.near(color(dark, 0, 0.2)[1], DARK, 1e-6, "a file of dark colours only")
  check(look(write("plain.stl", stl("", { 0, 0x7fff })), "albedo") == look(write("plain2.stl", stl("", { 0, 0 })), "albedo"), "bit 15 is not set")
  local own = glint.mesh { file = path, material = glint.material { diffuse = 0.5 } }
  check(own.material.diffuse[1] == 0.5, "the script's material comes first")
end

tally.run(tests)
tally.finish()
