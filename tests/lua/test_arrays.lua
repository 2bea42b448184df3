-- glint.array: values, arithmetic, bounds, and what takes and gives arrays. Columns read in bulk have the numbers of C's
-- strtod, which Lua's tonumber calls, and the errors of rows that are read one by one.
local build = os.getenv "BUILD" or "build"
local tally = dofile "tests/lua/tally.lua"
local check, raises = tally.check, tally.raises
package.path = "scripts/lib/?.lua;" .. package.path
local glint = require "glint"
local lammps, particles, points, xyz = require "glint.lammps", require "glint.particles", require "glint.points", require "glint.xyz"
local pdb = require "glint.pdb"

local folder = build .. "/tests/arrays"
assert(os.execute(("rm -rf '%s' && mkdir -p '%s'"):format(folder, folder)))

local function write(name, text)
  local file = assert(io.open(folder .. "/" .. name, "wb"))
  assert(file:write(text))
  assert(file:close())
  return folder .. "/" .. name
end

local function same(array, list, what)
  local good = #array == #list
  for i, v in ipairs(list) do good = good and (array[i] == v and math.type(array[i]) == math.type(v) or v ~= v) end
  check(good, "%s: {%s} expected, got {%s}", what, table.concat(list, ", "), table.concat(array:table(), ", "))
end

local tests = {}

function tests.values()
  local a, i = glint.array { 3, 1, 2 }, glint.array({ 5, -2, 7 }, "integer")
  same(a, { 3.0, 1.0, 2.0 }, "numbers")
  same(i, { 5, -2, 7 }, "integers")
  same(glint.array(2), { 0.0, 0.0 }, "a count")
  a[2] = 8
  same(a, { 3.0, 8.0, 2.0 }, "an assignment")
  same(a + 1, { 4.0, 9.0, 3.0 }, "array + number")
  same(1 - a, { -2.0, -7.0, -1.0 }, "number - array")
  same(a * a, { 9.0, 64.0, 4.0 }, "array * array")
  same(i / 2, { 2.5, -1.0, 3.5 }, "integers / number")
  same(i * 3 - i, { 10, -4, 14 }, "integers stay integers")
  same(i + 0.5, { 5.5, -1.5, 7.5 }, "integers + fraction")
  same(-i, { -5, 2, -7 }, "minus")
  same((a / 4):floor(), { 0.0, 2.0, 0.0 }, "floor")
  same(a:slice(2), { 8.0, 2.0 }, "a slice to the end")
  same(a:slice(1, 3, 2), { 3.0, 2.0 }, "a slice with a step")
  same(a:slice(-2, -1), { 8.0, 2.0 }, "a slice from the end")
  same(a:slice(2, 1), {}, "an empty slice")
  same(a:at(glint.array({ 3, 3, 1 }, "integer")), { 2.0, 2.0, 3.0 }, "rows by number")
  same(a:bins(0, 10, 5), { 2, 5, 2 }, "bins")
  same(glint.array { 0 / 0, -1, 99 }:bins(0, 10, 5), { 6, 1, 5 }, "bins of values beyond")
  check(i:counts()[7] == 1 and i:counts()[3] == nil, "counts")
  check(a:min() == 2 and a:max() == 8 and a:sum() == 13 and a:mean() == 13 / 3, "min, max, sum, mean")
  check(glint.array { 0 / 0, 2 }:min() == 2 and glint.array { 1, 0 / 0 }:max() == 1, "extremes without NaN")
  check(glint.array { 1, 1e100, 1, -1e100 }:sum() == 2, "a sum without lost terms")
  local n = 0
  for k, v in ipairs(a) do n = n + k * v end
  check(n == 3 + 16 + 6 and #a == 3 and tostring(a) == "array of 3 x 1 numbers", "ipairs, length, text")
end

function tests.rows()
  local p = glint.array { { 1, 2, 3 }, { 4, 5, 6 } }
  check(p.width == 3 and #p == 2 and p[2].y == 5, "rows are vectors")
  same(p.y, { 2.0, 5.0 }, "a column by letter")
  same(p:column(3), { 3.0, 6.0 }, "a column by number")
  for name, shifted in pairs { list = p + { 10, 20, 30 }, vector = p[1] * 0 + (p + p[1]) + { 9, 18, 27 } } do
    check(shifted[2] == glint.array { { 14, 25, 36 } }[1], "%s: rows + a row", name)
  end
  check((p[1] - p)[2].x == -3, "a vector - rows")
  check(p:mean()[2] == 3.5 and p:min().z == 3, "mean and min of columns")
  local joined = glint.array { p.x, p.y, p.z, glint.array { 7, 8 } }
  check(joined.width == 4 and joined[2][4] == 8, "columns as rows")
  p[1] = { 0, 0, 1 }
  check(p[1].z == 1, "a row is assigned")
end

function tests.maps()
  local a = glint.array { -2, 0.25, 3 }
  same(a:map(function(x) return x * x - 1 end), { 3.0, -0.9375, 8.0 }, "a function of numbers")
  local p = glint.array { { 3, 4, 0 }, { 0, 0, 2 } }
  same(p:map(function(q) return q:length() end), { 5.0, 2.0 }, "a function of rows")
  check(p:map(glint.pattern(function(q) return q * 2 end))[1].y == 8, "a pattern")
  local map = glint.colormap("viridis", -2, 3)
  local colors = map(a)
  for i, v in ipairs(a) do check(colors[i] == map(v), "colour %d", i) end
  check(map(glint.array { 0 / 0 })[1] == map(0 / 0), "the colour of a missing value")
end

function tests.refusals()
  local a = glint.array { 1, 2 }
  for index, got in pairs { [0] = "0", [4] = "4", [-1] = "-1", [1.5] = "1.5" } do
    raises("array: row 1 .. 2 expected, got " .. got, function() return a[index] end)
  end
  check(a[3] == nil, "one beyond the end is nil, for ipairs")
  raises("array: row 1 .. 2 expected, got 3", function() a[3] = 1 end)
  raises('array[1]: number expected, got string "x"', function() a[1] = "x" end)
  raises("array[2]: whole number expected, got 0.5", glint.array, { 1, 0.5 }, "integer")
  raises("array[2]: 3 numbers expected", glint.array, { { 1, 2, 3 }, { 1, 2 } })
  raises("a + b: arrays of the same size expected, got 2 x 1 and 3 x 1", function() return a + glint.array(3) end)
  raises("a * b: array or number expected", function() return a * "2" end)
  raises("array.slice: rows 1 .. 2", a.slice, a, 1, 3)
  raises("array.at: row 1 .. 2 expected, got 3", a.at, a, glint.array({ 3 }, "integer"))
  raises("array.mean: array with at least one row expected", glint.array(0).mean, glint.array(0))
  raises("array.bins: low below high", a.bins, a, 1, 1, 3)
  raises("array.men: no such field; did you mean 'm", function() return a.men end)
  raises("array: list of numbers, rows or arrays", glint.array, "x")
  raises("memory", glint.array, math.maxinteger // 16)
  raises("spheres.data: array of 4 numbers a row (x, y, z, radius) expected, got 3 numbers", glint.spheres, { data = glint.array { { 1, 2, 3 } } })
  raises("spheres.index: array of whole numbers expected", glint.spheres,
    { data = glint.array { { 0, 0, 0, 1 } }, index = a, materials = { glint.material {}, glint.material {} } })
  raises("cylinders.data: cylinder 2: a top other than the base expected, got {1, 1, 1}", glint.cylinders,
    { data = { 0, 0, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1 } })
  raises("cylinders.data: cylinder 1: radius > 0 expected, got 0", glint.cylinders, { data = { 0, 0, 0, 1, 0, 0, 0 } })
  raises("cylinders.data: 7 numbers a cylinder (base, top, radius) expected, got 6 numbers", glint.cylinders, { data = { 1, 2, 3, 4, 5, 6 } })
end

local function pictures(...)
  local scene = glint.scene { ambient = 0.2, camera = glint.camera { eye = { 1, 2, 9 }, at = { 0, 0, 0 } },
    glint.directional_light { direction = { -1, -2, -2 } }, ... }
  local image = scene:render { width = 48, height = 36, samples = 2, passes = { "depth", "object_id" } }
  return image:bytes() .. image:bytes "depth" .. image:bytes "object_id", image
end

function tests.shapes()
  local red, blue = glint.material { diffuse = "red" }, glint.material { diffuse = "blue", specular = 0.5 }
  local list, rows, single, flat, index = {}, {}, {}, {}, {}
  for i = 0, 19 do
    local x, y, z, r = i % 5 - 2, i // 5 - 1.5, math.sin(i), 0.2 + 0.01 * i
    table.move({ x, y, z, r }, 1, 4, #list + 1, list)
    index[i + 1] = i % 2 + 1
    rows[i + 1] = { x, y, z, x + 0.5, y + 0.1 * i, z + 0.3, 0.1 + 0.005 * i }
    table.move(rows[i + 1], 1, 7, #flat + 1, flat)
    local c = rows[i + 1]
    single[i + 1] = glint.cylinder { base = { c[1], c[2], c[3] }, top = { c[4], c[5], c[6] }, radius = c[7],
      material = ({ red, blue })[i % 2 + 1], capped = false }
  end
  local given = { index = glint.array(index, "integer"), materials = { red, blue } }
  local want, image = pictures(glint.spheres { data = list, index = index, materials = { red, blue } })
  given.data = glint.array(list)
  check(pictures(glint.spheres(given)) == want, "spheres from an array")
  local all = image:array "depth"
  check(#all == 48 * 36 and all[18 * 48 + 25] == image:pixel(24, 18, "depth"), "a pass as an array")
  check(image:array()[18 * 48 + 25].y == select(2, image:pixel(24, 18)), "beauty as an array")
  raises("array.pass: 'd:x' is not stored in this image", image.array, image, "d:x")
  want = pictures(glint.group(single))
  given.capped = false
  for _, data in ipairs { rows, flat } do
    given.data = data == flat and flat or glint.array(rows)
    check(pictures(glint.cylinders(given)) == want, "cylinders have the bits of single ones")
  end
  local many = glint.cylinders(given)
  many.capped = true
  check(many.count == 20 and pictures(many) ~= want and many.min.y < -1.5, "caps, count and box of cylinders")
  raises("s.uv: cylinders have no texture coordinates", pictures, glint.cylinders { data = flat,
    material = glint.material { diffuse = glint.pattern(function(_, s) return s.uv.u end) } })
  local corners = glint.array { { -1, -1, 0 }, { 1, -1, 0 }, { 0, 1, 0 } }
  check(pictures(glint.mesh { vertices = corners, faces = { { 1, 2, 3 } } }) ==
    pictures(glint.mesh { vertices = corners:table(), faces = { { 1, 2, 3 } } }), "vertices of a mesh")
  local square, faces = glint.array { { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 } }, { { 1, 2, 3 }, { 1, 3, 4 } }
  local face_index = { index = { 1, 2 }, materials = { red, blue } }
  local function mesh(given_faces)
    return glint.mesh { vertices = square, faces = given_faces, index = face_index.index, materials = face_index.materials }
  end
  want = pictures(mesh(faces))
  check(want == pictures(mesh(glint.array(faces, "integer"))), "faces of a mesh in an array")
  check(want == pictures(mesh(glint.array({ 1, 2, 3, 1, 3, 4 }, "integer"))), "faces of a mesh in a flat array")
  face_index.index = glint.array({ 1, 2 }, "integer")
  check(want == pictures(mesh(faces)), "materials of faces in an array")
  local cut = mesh(faces)
  check(tostring(cut.index) == tostring(face_index.index) and cut.count == 2, "materials of faces")
  local polygon = { { 1, 2, 3, 4 } }
  local quad = glint.mesh { vertices = square, faces = polygon, normals = { 0, 0, 5, 0, 3, 4, 0, 0, 1, 1, 0, 0 }, uv = { 0, 0, 1, 0, 1, 1, 0, 0.25 } }
  local function spell(array)
    local out = {}
    for i = 1, #array do
      for j = 1, array.width do out[#out + 1] = ("%g"):format(array[i][j]) end
    end
    return table.concat(out, " ")
  end
  check(spell(quad.faces) == "1 2 3 1 3 4" and #quad.vertices == 4, "triangles of a face of four corners")
  check(spell(quad.normals) == "0 0 1 0 0.6 0.8 0 0 1 1 0 0", "normals have length 1: " .. spell(quad.normals))
  check(spell(quad.uv) == "0 0 1 0 1 1 0 0.25" and not quad.index, "texture coordinates")
  local corner = glint.mesh { vertices = square, faces = { 1, 2, 3, 1, 3, 4 }, normals = { 0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, -1, 0, -1, 0, -1, 0, 0 } }
  check(spell(corner.normals) == "0 0 1 0 1 0 1 0 0 0 0 -1 0 -1 0 -1 0 0" and not corner.uv, "a normal a corner")
  local smooth = glint.mesh { vertices = square, faces = polygon, shading = "phong" }
  check(not smooth.normals, "computed normals are not given ones")
  local rod = glint.cylinders { data = { 0, 0, 0, 1, 0, 0, 0.5 } }
  check(spell(rod.data) == "0 0 0 1 0 0 0.5" and spell(glint.spheres { data = { 1, 2, 3, 4 } }.data) == "1 2 3 4", "numbers of many shapes")
  raises("mesh.vertices: this field is read-only", function() quad.vertices = square end)
  local view = glint.camera { eye = { 0, 0, 1 }, at = { 0, 0, 0 } }
  for i = 1, 2000 do -- degrees that read back as the same radians
    view.fov = 1 + 170 * (i * 0.618033988749895 % 1)
    local twin = glint.camera { eye = { 0, 0, 1 }, at = { 0, 0, 0 }, fov = view.fov }
    local x, y = view:project({ 0.1, 0.37, 0 }, 1000, 999)
    local u, v = twin:project({ 0.1, 0.37, 0 }, 1000, 999)
    if x ~= u or y ~= v then check(false, "fov reads back: " .. view.fov) end
  end
  raises("mesh.faces[2]: vertex 1 .. 4 expected, got 5", mesh, glint.array({ { 1, 2, 3 }, { 1, 3, 5 } }, "integer"))
  raises("mesh.faces: list of faces, array of three integers a row", mesh, glint.array(faces))
  raises("mesh.faces: 3 numbers a triangle expected, got 4 numbers", mesh, glint.array({ 1, 2, 3, 4 }, "integer"))
  raises("mesh.faces[2]: number of a vertex expected, got 0.5", mesh, { 1, 2, 3, 0.5, 2, 3 })
  raises("mesh.index: array of whole numbers expected", glint.mesh,
    { vertices = square, faces = faces, index = glint.array { 1, 2 }, materials = { red, blue } })
  local path = folder .. "/picture.png"
  assert(image:save(path))
  local read = glint.read_image(path)
  local pixels, off = read:array(), 0
  for i = 0, #pixels - 1 do
    local x, y, z = read:pixel(i % 48, i // 48)
    local row = pixels[i + 1]
    off = off + ((row.x == x and row.y == y and row.z == z) and 0 or 1)
  end
  check(off == 0 and pixels:max().x > 0.1, "a picture as an array: %d pixels differ", off)
end

-- Colours of a cloud, one material each; a row that is refused has its line, also after comments.
function tests.colored_points()
  local rows = { "label,x,y,z,red,green,blue" }
  local function name_of(i) return ("#%02x%02x%02x"):format(i % 3 * 100, i % 5 * 50, i * 7 % 256) end
  for i = 1, 900 do
    rows[#rows + 1] = i % 100 == 0 and "# a comment\n\n" or nil
    rows[#rows + 1] = ("%s,%d,0,%d,%d,%d,%d"):format(i % 4 == 0 and "own" or "C", i, -i, i % 3 * 100, i % 5 * 50, i * 7 % 256)
  end
  local function read(text)
    local set = particles.new { kinds = { own = { color = "red", radius = 2 } }, radius = nil }
    return set:add_frame(points.frame(write("colors.csv", text)))
  end
  local set, off = read(table.concat(rows, "\n") .. "\n"), 0
  local all = set:arrays()
  for i = 1, 900 do
    local row, material = all.data[i], all.materials[all.index[i]]
    local want = i % 4 == 0 and "own" or name_of(i)
    off = off + ((row[1] == i and row[3] == -i and material.name == want) and 0 or 1)
  end
  check(off == 0 and set.counts.own == 225 and set.counts.C == 675, "%d points of 900 differ", off)
  check(all.data[4][4] == 2 and all.data[5][4] < 2 and set.low[1] < 1 and set.high[1] == 902, "their radii and box")
  rows[700] = rows[700]:gsub("%d+$", "256")
  raises("colors.csv:712: red, green and blue 0 .. 255 expected, got \"256\"", read, table.concat(rows, "\n"))
end

-- Rows in fixed columns: 300 residues of 4 atoms. Of residue 200, a CA without a code comes first, then one with the
-- code A, which is the same atom; of residue 250, code A is read and B is not.
function tests.records_of_pdb()
  local rows, names = {}, { "N ", "CA", "C ", "O " }
  local function add(name, code, residue, x, element)
    rows[#rows + 1] = ("ATOM  %5d  %s %sALA A%4d    %8.3f%8.3f%8.3f%6.2f%6.2f          %2s"):format(#rows, name, code,
      residue, x, -x, x / 4, 1, residue / 10, element)
  end
  for residue = 1, 300 do
    for i, name in ipairs(names) do
      local code = residue == 250 and name == "CA" and "A" or " "
      add(name, code, residue, residue + i / 8, name:sub(1, 1))
    end
    if residue == 200 then add("CA", "A", residue, 999, "C") end
    if residue == 250 then add("CA", "B", residue, 999, "C") end
    if residue % 50 == 0 then rows[#rows + 1] = "TER" end
  end
  local frame = pdb.frame(write("fixed.pdb", table.concat(rows, "\n") .. "\nEND\n"))
  local all, factor = frame:arrays "bfactor"
  local off = 0
  for i = 1, #all.positions do
    local residue, at = (i - 1) // 4 + 1, all.positions[i]
    local x = residue + ((i - 1) % 4 + 1) / 8
    off = off + ((at.x == x and at.y == -x and math.abs(at.z - x / 4) < 6e-4 and factor[i] == residue / 10 and
      all.labels[all.kinds[i]] == names[(i - 1) % 4 + 1]:sub(1, 1)) and 0 or 1)
  end
  check(#all.positions == 1200 and off == 0, "%d of %d atoms differ", off, #all.positions)
  local function read() return particles.new():add_frame(pdb.frame(folder .. "/fixed.pdb")) end
  check(read().counts.C == 600 and read().counts.N == 300, "kinds of a .pdb")
  local number = 700
  rows[number] = rows[number]:sub(1, 40) .. "x" .. rows[number]:sub(42)
  write("fixed.pdb", table.concat(rows, "\n"))
  raises("fixed.pdb:700: y, columns 39-46, (a finite number) expected", read)
  rows[number] = rows[number]:sub(1, 20) .. "\t" .. rows[number]:sub(22)
  write("fixed.pdb", table.concat(rows, "\n"))
  raises("fixed.pdb:700: a record in columns without tabs expected", read)
end

-- Numbers that are hard to round, and forms of each. The seed is fixed.
local function spellings()
  local list = { "0", "-0.0", "1", "+2.5", ".5", "5.", "1e22", "1e23", "8.5e-5", "9007199254740993", "1.7976931348623157e308",
    "2.2250738585072014e-308", "4.9e-324", "1e-400", "0.1", "123456789012345678901234567890", "1.00000000000000011102230246251565",
    "1.00000000000000011102230246251566", "7.2057594037927933e16", "0.000000000000000000000000000000000000123456789" }
  math.randomseed(7)
  for _ = 1, 4000 do
    local x = string.unpack("d", string.pack("i8", math.random(0)))
    if x - x == 0 then list[#list + 1] = ("%.17g"):format(x) end
    list[#list + 1] = ("%." .. math.random(0, 25) .. "f"):format((math.random() - 0.5) * 10 ^ math.random(-3, 6))
    list[#list + 1] = ("%.16e"):format(math.random() * 2 ^ math.random(-80, 80))
    list[#list + 1] = ("%d"):format(math.random(0))
  end
  return list
end

function tests.numbers()
  local list, lines = spellings(), {}
  for i, text in ipairs(list) do lines[i] = ("%d 1 %s 0 0 %s"):format(i, text, text) end
  local head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n" .. #list .. "\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS id type x y z q\n"
  local dump = write("numbers.dump", head .. table.concat(lines, "\n") .. "\n")
  local csv = { "x,y,z,q" }
  for i, text in ipairs(list) do csv[i + 1] = ("%s,0,0,\"%s\""):format(text, text) end
  local frame = { dump = lammps.frame(dump), csv = points.frame(write("numbers.csv", table.concat(csv, "\r\n"))) }
  for name, found in pairs(frame) do
    local all, q = found:arrays "q"
    local wrong
    for i, text in ipairs(list) do
      local want = tonumber(text) + 0.0
      if all.positions[i].x ~= want or q[i] ~= want then wrong = wrong or ("%s gives %.17g"):format(text, q[i]) end
    end
    check(#q == #list and not wrong, "%s: %s", name, tostring(wrong))
  end
  local all, q = xyz.frame(write("fortran.xyz", "2\n\nC 1.5D+03 1.5-103 -2d1 \nO 1 2 3\n")):arrays()
  check(q == nil and all.positions[1] == glint.array { { 1.5e3, 1.5e-103, -20 } }[1] and all.labels[2] == "O", "Fortran's exponents")
  same(all.kinds, { 1, 2 }, "kinds")
  all, q = points.frame(write("gaps.csv", "x,y,z,q,radius,label\n1,2,3,NA,2,a\n4,5,6,,3,\"b c\"\n# no row\n\n7,8,9,nan,4,a\n1,1,1,-1,5,a\n")):arrays "q"
  check(q[1] ~= q[1] and q[2] ~= q[2] and q[3] ~= q[3] and q[4] == -1, "missing values")
  same(all.radii, { 2.0, 3.0, 4.0, 5.0 }, "radii")
  check(table.concat(all.labels, "|") == "a|b c" and all.kinds[4] == 1, "labels")
end

-- A wrong row is the same error, with the same line, whether it is read alone, in bulk, or skipped.
function tests.errors()
  local good = {}
  for i = 1, 900 do good[i] = ("%d %s %d 2 3 0.5 -1"):format(i, i % 2 == 0 and "C" or "O", i) end
  for bad, want in pairs {
    ["700 C 1 2x 3 0.5 -1"] = 'bad.dump:709: y (a finite number) expected, got "2x"',
    ["700 C 1 2 3 0.5"] = "bad.dump:709: atom 700 of 900, with 7 columns expected",
    ["700 C 1 2 nan 0.5 -1"] = 'z (a finite number) expected, got "nan"', ["700 C 1 2 3 0.5 -1 9"] = "with 7 columns expected",
    ["700 C 1 2 3 1e999 -1"] = 'radius (a finite number) expected, got "1e999"', [""] = "atom 700 of 900, with 7 columns",
    ["700 C 0x10 2 3 0.5 -1"] = 'x (a finite number) expected, got "0x10"' } do
    local rows = table.move(good, 1, 900, 1, {})
    rows[700] = bad
    local path = write("bad.dump", "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n900\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n" ..
      "ITEM: ATOMS id element x y z radius q\n" .. table.concat(rows, "\n") .. "\n")
    raises(want, function() for _ in lammps.frame(path):atoms() do end end)
    raises(want, function() lammps.frame(path):arrays "q" end)
    raises(want, function() particles.new():add_frame(lammps.frame(path)) end)
    raises(want, function() lammps.film(path):length() end)
  end
  local csv = write("bad.csv", "x,y,z,radius,mass\n1,2,3,1,5\n1,2,3,1,2020-01\n")
  raises('bad.csv:3: a number in the column "mass" expected, got "2020-01"', function() points.frame(csv):arrays "mass" end)
  csv = write("flat.csv", "x,y,z,radius\n1,2,3,1\n\n1,2,3,-1\n")
  raises('flat.csv:4: a radius > 0 expected, got "-1"', function() particles.new():add_frame(points.frame(csv)) end)
  same(points.frame(csv):arrays().radii, { 1.0, -1.0 }, "any radius in an array")
end

-- A set of many rows has the same picture as one filled atom by atom.
function tests.bulk()
  local rows = { "2000", 'Lattice="9 0 0 0 9 0 0 0 9" Properties=species:S:1:pos:R:3:q:R:1' }
  for i = 1, 2000 do
    rows[#rows + 1] = ("%s %.4f %.5g %.3f %g"):format(({ "C", "O", "Xx", "13C" })[i % 4 + 1], i % 9, i * 0.37 % 9, i * 0.011 % 9, i % 13)
  end
  local path = write("many.xyz", table.concat(rows, "\n"))
  for _, by in ipairs { false, { column = "q", map = "magma" } } do
    local one, many = particles.new { scale = 0.3, color_by = by or nil }, particles.new { scale = 0.3, color_by = by or nil }
    many:add_frame(xyz.frame(path))
    local frame = xyz.frame(path)
    for label, x, y, z, radius, q in frame:atoms "q" do
      one:add(label == "Xx" and "type1" or label, x, y, z, label == "Xx" and 0.15 or radius, q)
    end
    local low, high = many:camera { from = { 1, 1, 1 } }.eye, one:camera { from = { 1, 1, 1 } }.eye
    check(low == high and many.count == one.count and many.counts.C == 1000 and many.counts.ghost == 500, "extent and counts")
    if by then check(pictures(many:spheres()) == pictures(one:spheres()), "the same picture") end
  end
end

tally.run(tests)
tally.finish()
