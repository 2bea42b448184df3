-- scripts/lib/glint: the readers on good and bad files, elements, builder; and the scripts that make figures from data.
local build = os.getenv "BUILD" or "build"
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
package.path = "scripts/lib/?.lua;" .. package.path
local glint = require "glint"
local elements, particles, xyz = require "glint.elements", require "glint.particles", require "glint.xyz"
local pdb, lammps, points = require "glint.pdb", require "glint.lammps", require "glint.points"
local bonds, png = require "glint.bonds", require "glint.png"
local nff, helix, sphereflake = require "glint.nff", require "glint.helix", require "glint.sphereflake"

local function near(got, want, tolerance, what)
  check(math.abs(got - want) <= tolerance, "%s: %.17g expected, got %.17g", what, want, got)
end

local folder = build .. "/tests/data"
assert(os.execute(("rm -rf '%s' && mkdir -p '%s'"):format(folder, folder)))

local function write(name, text)
  local path = folder .. "/" .. name
  local file = assert(io.open(path, "wb"))
  assert(file:write(text))
  assert(file:close())
  return path
end

local function slurp(path)
  local file = assert(io.open(path, "rb"))
  local text = file:read "a"
  file:close()
  return text
end

-- All atoms of a frame, as a list of { label, x, y, z, radius }.
local function all(frame)
  local list = {}
  for label, x, y, z, radius in frame:atoms() do list[#list + 1] = { label, x, y, z, radius } end
  return list
end

local function is(atom, ...)
  local want = { ... }
  for i = 1, 5 do
    if atom[i] ~= want[i] then return false end
  end
  return true
end

-- Reading a file with this text must raise exactly "FILE:LINE: message".
local function refuses(text, line, message, f)
  local path = write("bad", text)
  local ok, got = pcall(f, path)
  local want = ("%s:%d: %s"):format(path, line, message)
  check(not ok and got == want, "<%s> expected, got <%s>", want, tostring(got))
end

local function read_all(each)
  for frame in each do all(frame) end
end
local function read_xyz(path) read_all(xyz.frames(path)) end
local function read_pdb(path) read_all(pdb.frames(path)) end
local function read_lammps(path) read_all(lammps.frames(path)) end
local function read_points(path) all(points.frame(path)) end

local tests = {}

function tests.elements()
  check(elements.H.number == 1 and elements.C.number == 6 and elements.U.number == 92 and elements.Mt.number == 109,
    "numbers")
  check(elements.C.color == "#909090" and elements.O.color == "#ff0d0d" and elements.Au.color == "#ffd123" and
    elements.Mt.color == "#eb0026", "colours")
  check(elements.H.radius == 1.2 and elements.C.radius == 1.7 and elements.I.radius == 1.98 and
    elements.Fe.radius == 2 and elements.Fe.guessed and not elements.C.guessed, "radii")
  check(elements.symbol "CL" == "Cl" and elements.symbol "8" == "O" and elements.symbol "d" == "H", "symbols")
  check(not elements.symbol "Xx" and not elements.symbol "0" and not elements.symbol "110" and
    not elements.symbol "Symbol" and not elements.symbol "6.5", "no symbols")
  local count = 0
  for _, element in pairs(elements) do
    if type(element) == "table" then
      count = count + 1
      check(element.color:match "^#%x%x%x%x%x%x$" and element.radius > 0, "element %d", element.number)
    end
  end
  check(count == 109, "109 elements, got %d", count)
end

-- Bonds are the pairs of atoms that are closer than the longest bond of their elements.
function tests.caffeine()
  local frame = xyz.frame "scripts/data/caffeine.xyz"
  local atoms, formula, joins = all(frame), {}, {}
  check(frame.count == 24 and #atoms == 24, "24 atoms, got %d", #atoms)
  for i, a in ipairs(atoms) do
    formula[a[1]] = (formula[a[1]] or 0) + 1
    for j = 1, i - 1 do
      local b = atoms[j]
      local distance = math.sqrt((a[2] - b[2]) ^ 2 + (a[3] - b[3]) ^ 2 + (a[4] - b[4]) ^ 2)
      check(distance > 1, "atoms %d and %d are %g apart", i, j, distance)
      if distance < ((a[1] == "H" or b[1] == "H") and 1.25 or 1.65) then joins[#joins + 1] = { i, j } end
    end
  end
  check(formula.C == 8 and formula.H == 10 and formula.N == 4 and formula.O == 2, "C8H10N4O2")
  check(#joins == 25, "25 bonds (24 atoms, two rings), got %d", #joins)
end

function tests.xyz()
  local path = write("two.xyz", "2\nfirst\nO 0 0.5 -1e1\r\nh 1 2 3 extra 7\n\n1\n\n 8 +4 5. .5\n")
  local seen = {}
  for frame in xyz.frames(path) do seen[#seen + 1] = { frame.number, frame.count, frame.comment, all(frame) } end
  check(#seen == 2 and seen[1][1] == 1 and seen[1][2] == 2 and seen[1][3] == "first" and seen[2][3] == "", "frames")
  check(is(seen[1][4][1], "O", 0, 0.5, -10) and is(seen[1][4][2], "h", 1, 2, 3), "frame 1")
  check(#seen[2][4] == 1 and is(seen[2][4][1], "8", 4, 5, 0.5), "frame 2")
  check(is(all(xyz.frame(path, 2))[1], "8", 4, 5, 0.5), "frame 2 alone; the atoms of frame 1 are read over")
  check(select(2, pcall(xyz.frame, path, 3)) == path .. ": frame 3 expected, got a file of 2", "frame 3")
  check(select(2, pcall(xyz.frame, folder .. "/none")) == folder .. "/none: No such file or directory", "no file")
  local frame = xyz.frame(path)
  all(frame)
  check(not pcall(frame.atoms, frame), "atoms are read once")
  local whole = "the number of atoms"
  refuses("", 1, whole .. " expected, got the end of the file", read_xyz)
  refuses("two\n\n", 1, whole .. ' expected, got "two"', read_xyz)
  refuses("1", 2, "a line of comment expected, got the end of the file", read_xyz)
  refuses("2\n\nC 0 0 0\n", 4, "atom 2 of 2 expected, got the end of the file", read_xyz)
  refuses("2\n\nC 0 0 0\nC 0 0\n", 4, 'atom 2 of 2 (element x y z) expected, got "C 0 0"', read_xyz)
  refuses("1\n\nC 0 zero 0\n", 3, 'y (a finite number) expected, got "zero"', read_xyz)
  refuses("1\n\nC 0 0 nan\n", 3, 'z (a finite number) expected, got "nan"', read_xyz)
  refuses("1\n\nC 1e999 0 0\n", 3, 'x (a finite number) expected, got "1e999"', read_xyz)
  refuses("1\n\nC 0x10 0 0\n", 3, 'x (a finite number) expected, got "0x10"', read_xyz)
  refuses("1\n\nC 0 0 0\nC 0 0 1\n", 4,
    'the number of atoms of frame 2 (the frame before it is complete) expected, got "C 0 0 1"', read_xyz)
  refuses(("x"):rep(100), 1, whole .. ' expected, got "' .. ("x"):rep(40) .. '"...', read_xyz)
end

local ATOM = "ATOM      1  CA  ALA A   1      11.104  -6.134   0.500  1.00  0.00           C\n"
local CALCIUM = "HETATM    2 CA    CA A   2       1.000   2.000   3.000\n"

function tests.pdb()
  local atoms = all(pdb.frame(write("a.pdb", "HEADER\n" .. ATOM .. "TER\n" .. CALCIUM .. "END\n")))
  check(#atoms == 2 and is(atoms[1], "C", 11.104, -6.134, 0.5) and is(atoms[2], "Ca", 1, 2, 3), "atoms")
  check(#all(pdb.frame(folder .. "/a.pdb", 1, { hetatm = false })) == 1, "ATOM alone")
  local two = write("b.pdb", "MODEL        1\n" .. ATOM .. "ENDMDL\nMODEL        2\n" .. CALCIUM .. ATOM .. "ENDMDL\nEND\n")
  check(pdb.frame(two, 2).model == 2 and #all(pdb.frame(two, 2)) == 2, "models")
  local other = ATOM:sub(1, 16) .. "B" .. ATOM:sub(18)
  check(#all(pdb.frame(write("c.pdb", ATOM .. other))) == 1, "alternate locations: the first alone")
  local nameless = ATOM:sub(1, 12) .. "HG11" .. ATOM:sub(17, 60) .. "\n"
  check(is(all(pdb.frame(write("d.pdb", nameless)))[1], "H", 11.104, -6.134, 0.5), "a hydrogen by its name")
  refuses("HEADER\n", 2, "an ATOM or HETATM record expected, got the end of the file", read_pdb)
  refuses(ATOM:sub(1, 50), 1, "a record of at least 54 columns (z is in 47-54) expected, got \"" .. ATOM:sub(1, 40) ..
    '"...', read_pdb)
  refuses((ATOM:gsub("%-6.134", "*6.134")), 1, 'y, columns 39-46, (a finite number) expected, got "  *6.134"', read_pdb)
  refuses("MODEL        1\n" .. ATOM, 3, "ENDMDL expected, got the end of the file", read_pdb)
  refuses("MODEL        1\n" .. ATOM .. "MODEL        2\n", 3, 'ENDMDL expected, got "MODEL        2"', read_pdb)
  refuses("MODEL      one\n", 1, 'the number of the model (a whole number >= 0) expected, got "     one"', read_pdb)
end

local function dump(step, count, bounds, columns, body)
  return ("ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS %s\nITEM: ATOMS %s\n%s"):format(step, count,
    bounds, columns, body)
end
local BOX = "pp pp ff\n-1 3\n0 2\n0 10"
local TILTED = "xy xz yz pp pp pp\n0 5 1\n0 4 0\n0 4 0"

function tests.lammps()
  local path = write("a.dump", dump(100, 2, BOX, "id type xs ys zs", "1 1 0.25 0.5 0.1\n2 3 1.25 0 1.5\n") ..
    dump(200, 1, BOX, "type id z y x diameter", "2 1 9 8 7 3\n"))
  local frame = lammps.frame(path)
  local atoms = all(frame)
  check(frame.step == 100 and frame.count == 2 and frame.box.size[1] == 4 and frame.box.periodic[2] and
    not frame.box.periodic[3], "header")
  check(is(atoms[1], "type1", 0, 1, 1) and is(atoms[2], "type3", 4, 0, 15), "scaled")
  check(is(all(lammps.frame(path, 1, { wrap = true }))[2], "type3", 0, 0, 15), "wrapped where the box is periodic")
  check(is(all(lammps.frame(path, 2))[1], "type2", 7, 8, 9, 1.5), "frame 2: unscaled, columns in another order")
  check(is(all(lammps.frame(path, 2, { types = { "Na", "Cl", "Ar" } }))[1], "Cl", 7, 8, 9, 1.5), "types")
  local tilted = write("b.dump", dump(0, 2, TILTED, "element xsu ysu zsu", "Ar 0.5 0.5 0.5\nAr 0.5 1.5 0.5\n"))
  local box = lammps.frame(tilted).box
  check(box.low[1] == 0 and box.high[1] == 4 and box.xy == 1, "a tilted box: what is around it is longer by its tilt")
  check(is(all(lammps.frame(tilted))[1], "Ar", 2.5, 2, 2), "scaled and tilted")
  check(is(all(lammps.frame(tilted, 1, { wrap = true }))[2], "Ar", 2.5, 2, 2), "wrapped and tilted")
  local unwrapped = write("c.dump", dump(0, 1, TILTED, "element xu yu zu", "Ar 7.5 6 2\n"))
  check(is(all(lammps.frame(unwrapped, 1, { wrap = true }))[1], "Ar", 2.5, 2, 2), "unscaled, wrapped and tilted")
  refuses("", 1, "ITEM: TIMESTEP expected, got the end of the file", read_lammps)
  refuses("LAMMPS\n", 1, 'ITEM: TIMESTEP expected, got "LAMMPS"', read_lammps)
  refuses("ITEM: TIMESTEP\nlate\n", 2, 'the time step (a whole number >= 0) expected, got "late"', read_lammps)
  refuses("ITEM: ATOMS id\n", 1, 'the step of the frame above ITEM: ATOMS expected, got "ITEM: ATOMS"', read_lammps)
  refuses(dump(0, 2, BOX, "type x y z", "1 0 0 0\n"), 11, "atom 2 of 2 expected, got the end of the file", read_lammps)
  refuses(dump(0, 1, BOX, "type x y z", "1 0 0\n"), 10, 'atom 1 of 1, with 4 columns expected, got "1 0 0"', read_lammps)
  refuses(dump(0, 1, BOX, "type x y", ""), 9,
    'columns x y z, xs ys zs, xu yu zu or xsu ysu zsu expected, got " type x y"', read_lammps)
  refuses(dump(0, 1, "pp pp\n0 1\n", "type x y z", ""), 5, "ITEM: BOX BOUNDS with three boundary kinds such as " ..
    'pp pp pp, after xy xz yz when tilted expected, got " pp pp"', read_lammps)
  refuses(dump(0, 1, "pp pp pp\n3 1\n0 1\n0 1", "type x y z", ""), 6,
    'x bounds of the box, the lower one first expected, got "3 1"', read_lammps)
  refuses(dump(0, 1, BOX, "type x y z", "1 0 0 0\n1 0 0 1\n"), 11,
    'ITEM: ... of frame 2 (the frame before it is complete) expected, got "1 0 0 1"', read_lammps)
  refuses(dump(0, 1, BOX, "type x y z", "3 0 0 0\n"), 10, 'a type among the 2 of the option types expected, got "3"',
    function(bad) read_all(lammps.frames(bad, { types = { "Na", "Cl" } })) end)
end

function tests.points()
  local list = all(points.frame(write("a.csv", "# stars\nName,X,Z,Y,radius,Label\n\"a \"\"b\"\", c\",1,3,2,0.5,\"C\"\n\nd,4,6,5,1,O\n")))
  check(#list == 2 and is(list[1], "C", 1, 2, 3, 0.5) and is(list[2], "O", 4, 5, 6, 1), "named columns, quotes")
  check(is(all(points.frame(write("c.txt", " 1 2  3\n")))[1], "point", 1, 2, 3), "blanks")
  check(is(all(points.frame(write("d.tsv", "1\t2\t3\t4\n")))[1], "point", 1, 2, 3, 4), "tabs, a radius")
  check(is(all(points.frame(write("e.csv", "1;2;3;C\n"), { columns = { "z", "y", "x", "label" } }))[1], "C", 3, 2, 1),
    "columns by options")
  refuses("# nothing\n", 2, "a line of points expected, got the end of the file", read_points)
  refuses("x,y,w\n", 1, 'a column named z expected, got "x,y,w"', read_points)
  refuses("1,2\n", 1, 'a column named z expected, got "1,2"', read_points)
  refuses("x,y,z\n1,2\n", 2, '3 columns (as in the first line) expected, got "1,2"', read_points)
  refuses("x,y,z\n1,2,three\n", 2, 'z (a finite number) expected, got "three"', read_points)
  refuses("x,1,2\n", 1, 'numbers, or the names of the columns expected, got "x,1,2"', read_points)
  refuses("x,y,z\n1,2,\"3\n", 2, 'a closing quote in this line expected, got "1,2,\\"3"', read_points)
end

-- Returns the results of frame:atoms(...) after the radius, for all atoms.
local function columns_of(frame, ...)
  local list = {}
  for _, _, _, _, _, a, b, c in frame:atoms(...) do list[#list + 1] = { a, b, c } end
  return list
end

local EXTENDED = '2\nLattice="4 0 0 1 5 0 0 0.5 6" Properties=vel:R:3:pos:R:3:species:S:1:q:R:1:s:R:2 pbc="T F T" Origin="-1 0 2"\n' ..
  "1 2 3 0.5 0.25 0.125 Na -1 7 8\n4 5 6 1.5 1.25 1.125 Cl 1e0 x 9\n"

function tests.columns_by_name()
  local path = write("e.xyz", EXTENDED .. EXTENDED)
  local frame = xyz.frame(path)
  check(table.concat(frame.columns, " ") == "vel_x vel_y vel_z x y z species q s_1 s_2", "names: %s",
    table.concat(frame.columns, " "))
  local atoms = {}
  for label, x, y, z, radius, q, v in frame:atoms("q", "vel_y") do atoms[#atoms + 1] = { label, x, y, z, radius, q, v } end
  check(#atoms == 2 and atoms[1][1] == "Na" and atoms[1][3] == 0.25 and atoms[2][4] == 1.125 and not atoms[1][5],
    "species after pos")
  check(atoms[1][6] == -1 and atoms[1][7] == 2 and atoms[2][6] == 1 and atoms[2][7] == 5, "charge and velocity")
  local odd = columns_of(xyz.frame(path, 2), "s_1", "species", "vel_x")
  check(odd[1][1] == 7 and odd[2][1] == "x" and odd[1][2] == "Na" and odd[2][3] == 4, "text stays text")
  local message = select(2, pcall(function() return xyz.frame(path):atoms "speed" end))
  check(message:find(path .. ': a column among vel_x, vel_y, vel_z, x, y, z, species, q, s_1, s_2 expected, got "speed"', 1, true),
    "got %s", message)
  local plain = write("p.xyz", "1\n\nC 1 2 3 4.5 six\n")
  local list = columns_of(xyz.frame(plain), "5", "6", "x")
  check(list[1][1] == 4.5 and list[1][2] == "six" and list[1][3] == 1, "by number")
  check(not pcall(function() return xyz.frame(plain):atoms "q" end), "and by no other name")
  check(columns_of(xyz.frame(plain), "7")[1][1] == nil, "a number that the line does not have is nothing")
  local dumped = write("q.dump", dump(7, 1, BOX, "id type xs ys zs vx c_pe", "9 1 0 0 0 -2.5 1e3\n"))
  list = columns_of(lammps.frame(dumped), "c_pe", "id", "vx")
  check(list[1][1] == 1000 and list[1][2] == 9 and list[1][3] == -2.5, "of a dump")
  local csv = write("m.csv", 'x,"the mass",y,z,name\n1,2.5,3,4,"a, b"\n')
  list = columns_of(points.frame(csv), "name", "the mass")
  check(list[1][1] == "a, b" and list[1][2] == 2.5, "of CSV")
  local record = write("b.pdb", ATOM)
  list = columns_of(pdb.frame(record), "name", "resname", "bfactor")
  check(list[1][1] == "CA" and list[1][2] == "ALA" and list[1][3] == 0, "of PDB")
  refuses("1\nProperties=pos:R:3\nC 0 0 0\n", 2, 'species and pos among the Properties expected, got "Properties=pos:R:3"', read_xyz)
  refuses("1\nProperties=species:S\nC 0 0 0\n", 2, 'Properties=name:type:count:... expected, got "Properties=species:S"', read_xyz)
  local wide = "1\nProperties=f:R:95:species:S:1:pos:R:3:q:R:1\n" .. ("1 "):rep(95) .. "C 1 2 3 4\n"
  refuses(wide, 2, 'species and pos among the first 90 columns expected, got "' .. wide:sub(3, 42) .. '"...', read_xyz)
  wide = write("wide.xyz", "1\nProperties=species:S:1:pos:R:3:f:R:95\nC 1 2 3 " .. ("1 "):rep(95) .. "\n")
  check(columns_of(xyz.frame(wide), "f_86")[1][1] == 1, "number 90")
  check(not pcall(columns_of, xyz.frame(wide), "f_87"), "not number 91")
  refuses(dump(0, 1, BOX, "type x y z" .. (" f"):rep(87), ""), 9, 'at most 90 columns expected, got " type x y z' ..
    (" f"):rep(14) .. ' "...', read_lammps)
  refuses('1\nLattice="1 0 0"\nC 0 0 0\n', 2, '9 numbers for Lattice expected, got "Lattice=\\"1 0 0\\""', read_xyz)
  refuses('1\nLattice="1 0 0 0 a 0 0 0 1"\nC 0 0 0\n', 2, 'Lattice (a finite number) expected, got "a"', read_xyz)
end

function tests.cell_of_xyz()
  local frame = xyz.frame(write("e.xyz", EXTENDED))
  local cell, box = frame.cell, frame.box
  check(cell.origin[1] == -1 and cell.b[1] == 1 and cell.c[2] == 0.5 and cell.c[3] == 6, "sides")
  check(box.low[3] == 2 and box.size[2] == 5 and box.xy == 1 and box.xz == 0 and box.yz == 0.5, "box")
  check(box.periodic[1] and not box.periodic[2] and box.periodic[3], "pbc")
  local turned = xyz.frame(write("t.xyz", '1\nLattice="0 4 0 4 0 0 0 0 4"\nC 0 0 0\n'))
  check(turned.cell.a[2] == 4 and turned.box == nil, "sides that lie otherwise are a cell alone")
  check(xyz.frame("scripts/data/caffeine.xyz").cell == nil, "none")
end

function tests.edges()
  local boxes = require "glint.box"
  local group = boxes.edges({ size = { 4, 5, 6 }, low = { -1, 0, 2 }, xy = 1, yz = 0.5 }, { radius = 0.25 })
  check(group.count == 8 + 12, "eight corners, twelve edges, got %d", group.count)
  local scene = glint.scene { group }
  near(scene:cast({ 1, 9, 2 }, { 0, -1, 0 }).point.y, 5.25, 1e-9, "the top of the far edge along a")
  local hit = scene:cast({ -0.5, 3, 9 }, { 0, 0, -1 }) -- b: (-1, 0) to (0, 5); above b, c is shifted by 0.5 in y
  near(hit.point.z, 8.25, 1e-9, "the top of the upper edge along b")
  local cell = boxes.edges { origin = { 0, 0, 0 }, a = { 0, 4, 0 }, b = { 4, 0, 0 }, c = { 0, 0, 4 } }
  near(glint.scene { cell }:cast({ 2, 9, 0 }, { 0, -1, 0 }).t, 5 - math.sqrt(48) / 250, 1e-9, "a cell; the radius is 1/250")
  local corners = boxes.corners { size = { 4, 5, 6 }, low = { -1, 0, 2 }, xy = -1, yz = 0.5 }
  check(table.concat(corners[1], " ") == "-2 0 2" and table.concat(corners[2], " ") == "3 5.5 8", "the upright box around a tilted one, got %s, %s",
    table.concat(corners[1], " "), table.concat(corners[2], " "))
  check(select(2, pcall(boxes.corners, { size = { 1, 1 } })):find("box.size: three finite numbers expected", 1, true), "no box, no corners")
  check(select(2, pcall(boxes.edges, { size = { 1, 1 } })):find("box.size: three finite numbers expected", 1, true), "no box")
  check(select(2, pcall(boxes.edges, { size = { 1, 1, 1 } }, { raduis = 1 })):find("box.raduis: no such option", 1, true), "options")
end

-- Reading frames in any order gives the same as reading in sequence. The file is read once.
function tests.films()
  local texts = { xyz = {}, pdb = {}, lammps = {} }
  for n = 1, 9 do
    local rows, records, list = {}, {}, {}
    for i = 1, n do
      rows[i] = ("Ar %d %d %d"):format(i, n, i * n)
      records[i] = ("ATOM  %5d AR   AR  A%4d    %8.3f%8.3f%8.3f\n"):format(i, i, i, n, i * n)
      list[i] = ("%d 1 %d %d %d\n"):format(i, i, n, i * n)
    end
    texts.xyz[n] = ("%d\nframe %d\n%s\n"):format(n, n, table.concat(rows, "\n")) .. (n % 3 == 0 and "\n" or "")
    texts.pdb[n] = ("MODEL %8d\n%sENDMDL\n"):format(n, table.concat(records))
    texts.lammps[n] = dump(n, n, BOX, "id type x y z", table.concat(list))
  end
  for name, reader in pairs { xyz = xyz, pdb = pdb, lammps = lammps } do
    for _, ending in ipairs { "", "cut" } do
      local text = table.concat(texts[name])
      local film = reader.film(write("film." .. name, ending == "" and text or text:sub(1, -2)))
      for _, n in ipairs { 3, 1, 3, 9, 2, 9, 4, 4, 5, 6 } do
        local frame = film:frame(n)
        local partly = n == 4 and frame:atoms()
        if partly then partly() end -- the next call skips the rest of this frame
        local list = n ~= 4 and all(frame) or {}
        check(frame.number == n and (n == 4 or #list == n and list[n][2] == n and list[n][3] == n and list[n][4] == n * n),
          "%s: frame %d", name, n)
      end
      check(film:length() == 9, "%s: nine frames, got %d", name, film:length())
      check(#all(film:frame(2)) == 2, "%s: after the end is known", name)
      local message = select(2, pcall(film.frame, film, 10))
      check(message:find("film." .. name .. ": frame 10 expected, got a file of 9", 1, true), "got %s", message)
      check(not pcall(film.frame, film, 0) and not pcall(film.frame, film, 1.5), "no such number")
      film:close()
      check(#all(film:frame(7)) == 7, "%s: after it was closed", name)
    end
  end
  refuses("1\n\nC 0 0 0\n2\n\nC 0 0 0\n", 7, "atom 2 of 2 expected, got the end of the file", function(path)
    xyz.film(path):length()
  end)
  local large = {} -- sequential reading reads each block once: the last frames take no longer than the first
  for n = 1, 400 do large[n] = ("50\n%d\n"):format(n) .. ("C 1 2 3\n"):rep(50) end
  local film, reads = xyz.film(write("large.xyz", table.concat(large))), 0
  local file = film.source.file
  film.source.file = setmetatable({}, { __index = function(_, name)
    return function(_, ...)
      reads = reads + (name == "read" and 1 or 0)
      return file[name](file, ...)
    end
  end })
  for n = 1, 400 do check(film:frame(n).comment == tostring(n), "frame %d", n) end
  check(reads <= 5, "a file of 165 KB is read in blocks of 64, each once, got %d", reads)
end

function tests.colours_by_a_column()
  local path = write("c.xyz", '3\nProperties=species:S:1:pos:R:3:q:R:1\nC 0 0 0 -1\nO 5 0 0 0\nC 9 0 0 1\n')
  local set = particles.new { color_by = { column = "q", map = "coolwarm" }, radius = 1, material = { specular = 0.25 } }
  set:add_frame(xyz.frame(path))
  local low, high = set:range()
  check(low == -1 and high == 1, "the range is that of the values")
  local spheres, map = set:spheres(), glint.colormap "coolwarm"
  local scene = glint.scene { spheres, ambient = 1, camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } } }
  check(#spheres.materials == 256 and spheres.materials[3].specular.r == 0.25, "a material a step")
  for x, value in pairs { [0] = 0, [5] = 0.5, [9] = 1 } do
    scene.camera = glint.camera { eye = { x, 0, 9 }, at = { x, 0, 0 } }
    local got, want = { scene:render { width = 3, height = 3 }:pixel(1, 1) }, map(value)
    for c = 1, 3 do near(got[c], want[c], 0.01, ("value %g, component %d"):format(value, c)) end
  end
  set = particles.new { color_by = { column = "q", low = 0, high = 2 }, format = "f32" }
  for i = 1, 1000 do set:add("C", i, 0, 0, nil, i / 400) end
  check(set:range() == 0 and set:spheres().count == 1000, "a range of one's own; what is beyond has its ends")
  local function raises(want, f, ...)
    local ok, message = pcall(f, ...)
    check(not ok and tostring(message):find(want, 1, true), "<%s> expected, got %s", want, message)
  end
  local gaps = write("gaps.xyz", '4\nProperties=species:S:1:pos:R:3:q:R:1\nC 0 0 0 nan\nO 5 0 0 -2\nC 9 0 0 6\nC 1 0 0 NaN\n')
  for missing, want in pairs { [""] = { 0.21586050011389926, 0.21586050011389926 }, red = { 1, 0 } } do
    set = particles.new { color_by = { column = "q", missing = missing ~= "" and missing or nil }, radius = 1 }
    set:add_frame(xyz.frame(gaps))
    low, high = set:range()
    check(low == -2 and high == 6, "missing values have no part in the range")
    spheres = set:spheres()
    local grey = spheres.materials[257].diffuse
    check(#spheres.materials == 257 and grey[1] == want[1] and grey[2] == want[2] and spheres.materials[257].name == "missing", "their colour")
    scene = glint.scene { spheres, ambient = 1, camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } } }
    near((scene:render { width = 3, height = 3 }:pixel(1, 1)), want[1], 1e-6, "is seen")
  end
  low, high = particles.range(xyz.frames(gaps), "q")
  check(low == -2 and high == 6, "nor in that of all frames")
  raises('a finite number in the column "q" expected, got "nil"', set.add, particles.new { color_by = { column = "q" } }, "C", 0, 0, 0)
  raises("a column among species, x, y, z, q expected, got \"p\"", function()
    particles.new { color_by = { column = "p" } }:add_frame(xyz.frame(path))
  end)
  raises('c.xyz:3: a finite number in the column "species" expected, got "C"', function()
    particles.new { color_by = { column = "species" } }:add_frame(xyz.frame(path))
  end)
  raises("particles.color_by.column: string expected, got nil", particles.new, { color_by = {} })
  raises("particles.color_by.colunm: no such option", particles.new, { color_by = { colunm = "q" } })
  raises("particles.color_by: { column = ... } expected, got q", particles.new, { color_by = "q" })
  raises("particles.color_by.high: a number above low (2) expected, got 1", particles.new, { color_by = { column = "q", low = 2, high = 1 } })
  raises('did you mean "magma"', particles.new, { color_by = { column = "q", map = "magna" } })
  raises("a set with color_by expected", particles.new().range, particles.new())
end

function tests.particles()
  for _, format in ipairs { "f64", "f32" } do
    local set = particles.new { format = format, scale = 2, material = { specular = 0.25 }, kinds = {
      A = { color = "red", radius = 3 }, B = { material = glint.material { name = "mine" } } } }
    for i = 0, 999 do set:add(({ "C", "o", "A", "8", "type2" })[i % 5 + 1], 10 * i, 0.5, -1) end
    set:add("B", -5, 0, 0, 0.25)
    check(set.count == 1001 and set.counts.O == 400 and set.counts.A == 200 and set.counts.B == 1, "%s: counts", format)
    check(set.low[1] == -5.25 and set.high[1] == 9990 + 1 and set.high[2] == 0.5 + 6, "%s: extent", format)
    local spheres = set:spheres { name = "all" }
    check(spheres.count == 1001 and spheres.name == "all" and #spheres.materials == 5, "%s: a material a kind", format)
    check(spheres.materials[2].name == "O" and spheres.materials[2].specular.r == 0.25, "%s: the material of O", format)
    check(spheres.materials[5].name == "mine", "%s: a material of one's own", format)
    local hit = glint.scene { spheres }:cast({ 6020, 50, -1 }, { 0, -1, 0 })
    near(hit.point.y, 6.5, 1e-6, format .. ": the top of an A")
    check(hit.element == 603, "%s: the 603rd, got %d", format, hit.element)
    check(not pcall(set.spheres, set), "%s: the spheres are taken once", format)
  end
  local ok, message = pcall(particles.new, { colour = "red" })
  check(not ok and message:find("particles.colour: no such option", 1, true), "unknown option: %s", message)
  check(not pcall(particles.new, { format = "f16" }), "unknown format")
  local set = particles.new()
  check(select(2, pcall(set.add, set, "Xx", 0, 0, 0)):find(
    'an element, its number, or one of the option kinds expected, got "Xx"', 1, true), "unknown element")
  check(not pcall(set.add, set, "C", 0, 0, 0, 0) and set.count == 0, "no radius")
  check(set:spheres().count == 0 and not pcall(set.spheres, set), "no spheres: an empty group, taken once")
  refuses("x,y,z,radius\n0,0,0,-1\n", 2, 'a radius > 0 expected, got "-1"',
    function(path) particles.new():add_frame(points.frame(path)) end)
end

-- Memory per atom after reading: 36 bytes, not a table.
function tests.memory()
  local path = write("large.xyz", "50000\n" .. ("\nC 1 2.5 0"):rep(50000))
  collectgarbage()
  collectgarbage() -- objects with finalizers are freed in the second collection
  local before, set = collectgarbage "count", particles.new()
  set:add_frame(xyz.frame(path))
  collectgarbage()
  collectgarbage()
  local bytes = (collectgarbage "count" - before) * 1024 / 50000
  check(set.count == 50000 and bytes > 30 and bytes < 45, "36 bytes an atom and little more, got %g", bytes)
end

-- The camera of a set shows the whole bounding box.
function tests.camera()
  local set = particles.new { radius = 0.1 }
  for _, x in ipairs { -3, 5 } do set:add("C", x, 2 * x, 1) end
  local center, radius = set:extent()
  near(center[1], 1, 1e-12, "centre")
  near(radius, math.sqrt(4.1 ^ 2 + 8.1 ^ 2 + 0.1 ^ 2), 1e-12, "radius")
  check(select(2, pcall(set.camera, set, { from = { 0, 0, 2 }, distance = 2 })):find("particles.camera.distance: no such option", 1, true),
    "a camera's options")
  check(select(2, pcall(set.camera, set, {})):find("particles.camera.from: three numbers {x, y, z} expected", 1, true), "from where")
  check(select(2, pcall(set.camera, set, { from = { 0, 0, 0 } })):find("particles.camera.from: a direction that is not zero expected", 1, true), "no direction")
  local camera = set:camera { from = { 0, 0, 2 }, fov = 60, up = { 1, 0, 0 } }
  near(camera.eye.z - 1, 2 * radius, 1e-9, "distance for 60 degrees")
  check(camera.fov == 60 and camera.up.x == 1 and camera.at.x == center[1], "camera")
end

function tests.helix()
  local place, count = {}, 0
  helix.each(2, 12, function(atom, x, y, z, residue, chain)
    count = count + 1
    place[atom .. residue .. "/" .. chain] = { x, y, z }
  end)
  check(count == 2 * 12 * 5, "atoms: %d", count)
  local function distance(a, b)
    a, b = place[a], place[b]
    return math.sqrt((a[1] - b[1]) ^ 2 + (a[2] - b[2]) ^ 2 + (a[3] - b[3]) ^ 2)
  end
  for _, bond in ipairs { { "N3/1", "CA3/1", 1.458 }, { "CA3/1", "C3/1", 1.525 }, { "C3/1", "N4/1", 1.329 },
    { "C3/1", "O3/1", 1.231 }, { "CA3/2", "CB3/2", 1.53 }, { "O3/2", "N7/2", 2.9 } } do
    near(distance(bond[1], bond[2]), bond[3], 0.03, bond[1] .. " to " .. bond[2])
  end
  near(distance("CA3/1", "CB3/1"), distance("CA9/1", "CB9/1"), 1e-9, "every residue alike")
  local path = folder .. "/chain.pdb"
  helix.write_pdb(path, 2, 12)
  local atoms = all(pdb.frame(path))
  check(#atoms == count and atoms[1][1] == "N" and atoms[5][1] == "C", "what is written is read")
  near(atoms[5][2], place["CB1/1"][1], 0.0005, "x of CB 1")
end

function tests.bonds()
  local set = particles.new()
  set:add_frame(xyz.frame "scripts/data/caffeine.xyz")
  local arrays = set:arrays()
  local cylinders, count = bonds.new(set)
  local scene, expected = glint.scene { cylinders }, 0
  local function covalent(i) return elements[set.materials[arrays.index[i]].name].covalent + 0.225 end
  for i, a in ipairs(arrays.data) do
    for j = 1, i - 1 do
      local b, square, toward = arrays.data[j], 0, {}
      for c = 1, 3 do square, toward[c] = square + (a[c] - b[c]) ^ 2, b[c] - a[c] end
      local d = math.sqrt(square)
      if d <= covalent(i) + covalent(j) and d > 0.4 then
        expected = expected + 1
        for share, atom in pairs { [0.25] = i, [0.75] = j } do -- a ray to a point on the axis, perpendicular to it
          local at, side = {}, { -toward[2], toward[1], 0 }
          local length = math.sqrt(side[1] ^ 2 + side[2] ^ 2)
          for c = 1, 3 do
            side[c] = side[c] / length
            at[c] = a[c] + share * toward[c] + 0.2 * side[c]
          end
          local hit = scene:cast(at, { -side[1], -side[2], -side[3] })
          near(hit and hit.t or 0, 0.05, 1e-9, ("bond of %d and %d near %d"):format(i, j, atom))
        end
      end
    end
  end
  check(count == 25 and expected == 25 and cylinders.count == 50, "caffeine has 25 bonds, got %d", count)
  set = particles.new { format = "f32" } -- a grid of 13 x 13 x 13, in shuffled order
  for n = 0, 13 ^ 3 - 1 do
    local i = n * 1000 % 2197
    set:add("point", i % 13 - 50, i // 13 % 13 + 1e3, i // 169)
  end
  local _, joined = bonds.new(set, { distance = 1.1 })
  check(joined == 3 * 12 * 13 * 13, "bonds of a grid: %d", joined)
  local ok, message = pcall(bonds.new, set)
  check(not ok and message:find('"point" is not an element and has no covalent radius', 1, true), "%s", message)
  ok, message = pcall(bonds.new, set, { raduis = 1 })
  check(not ok and message:find("bonds.raduis: no such option", 1, true), "%s", message)
  check(not pcall(bonds.new, set, { radius = 0 }) and not pcall(bonds.new, set, { radius = "1" }), "wrong radius")
  local alone = particles.new()
  alone:add("He", 0, 0, 0)
  local none, zero = bonds.new(alone)
  check(none == nil and zero == 0, "no bonds, no group")
  check(elements.C.covalent == 0.76 and elements.Cm.covalent == 1.69 and elements.Hs.covalent == 1.7, "covalent radii")
  local cue = set:depth_cue(set:camera { from = { 0, 0, 1 } }, 0.5)
  near(cue.far - cue.near, 2 * 13, 1e-9, "a depth cue over the depth of all spheres")
  set:spheres()
  check(select(2, bonds.new(set, { distance = 1.1 })) == joined, "after spheres()")
  check(not pcall(function() for _ = 1, 1000 do set:add("C", 0, 0, 0) end end), "no more atoms after spheres()")
end

-- A pixel on each half of a bond has the colour of its atom in a set with color_by, or one colour for all.
function tests.colours_of_bonds()
  local path = write("pair.dump", dump(0, 2, "ff ff ff\n0 10\n0 10\n0 10", "element x y z q", "C 4 5 5 0\nO 5.4 5 5 1\n"))
  for case = 1, 3 do
    local set = particles.new { scale = 0.1, color_by = { column = "q", map = "viridis" } }
    set:add_frame(lammps.frame(path))
    local spheres = case == 2 and set:spheres()
    local one = case == 3 and glint.material { diffuse = "red" }
    local cylinders = bonds.new(set, { material = one or nil })
    spheres = spheres or set:spheres()
    local scene = glint.scene { ambient = 1, cylinders, spheres,
      camera = glint.camera { eye = { 4.7, 5, 9 }, at = { 4.7, 5, 5 }, projection = "orthographic", height = 1.5 } }
    local image, map = scene:render { width = 60, height = 60 }, glint.colormap "viridis"
    for x, value in pairs { [17] = 0, [42] = 1 } do -- at x = 4.41 and 5.06
      local want, got = one and { 1, 0, 0 } or map(value), { image:pixel(x, 30) }
      for c = 1, 3 do near(got[c], want[c], 1e-6, ("case %d, value %g, channel %d"):format(case, value, c)) end
    end
  end
end

-- Counts the bonds in a periodic box, by a test of every pair and every periodic image.
local function count_across(box, atoms, longest)
  local count, s = 0, box.size
  for i, a in ipairs(atoms) do
    for j = 1, i do
      for p = -3, 3 do
        for q = -3, 3 do
          for r = -3, 3 do
            local x, y = a[1] - atoms[j][1] + p * s[1] + q * box.xy + r * box.xz, a[2] - atoms[j][2] + q * s[2] + r * box.yz
            local d = math.sqrt(x * x + y * y + (a[3] - atoms[j][3] + r * s[3]) ^ 2)
            if d > 0 and d <= longest then count = count + (i == j and 0.5 or 1) end
          end
        end
      end
    end
  end
  return count
end

function tests.periodic_bonds()
  local path = write("wall.dump", dump(0, 2, "pp pp pp\n0 10\n0 10\n0 10", "element x y z", "C 0.5 5 5\nO 9.5 5 5\n"))
  local function load() return particles.new():add_frame(lammps.frame(path)) end
  local _, group, count
  group, count = bonds.new(load())
  check(count == 1 and group.count == 2, "one bond across a face, got %d", count)
  local scene = glint.scene { group }
  for _, case in ipairs { { 0.25, "C" }, { -0.1, nil }, { 9.75, "O" }, { 10.1, nil }, { 5, nil } } do
    local hit = scene:cast({ case[1], 5, 20 }, { 0, 0, -1 })
    check((hit and hit.object.materials[hit.element].name) == case[2], "at x = %g: %s", case[1], tostring(case[2]))
  end
  check(select(2, bonds.new(load(), { box = false })) == 0, "none across a face on request")
  check(select(2, bonds.new(load(), { box = { size = { 12, 10, 10 } } })) == 0, "another box")
  local set = particles.new()
  set:add("C", 0.5, 5, 5)
  set:add("C", -9.5 + 10 * 7, 5, 5) -- an atom with unwrapped coordinates, seven periods away
  _, count = bonds.new(set, { box = { size = { 10, 10, 10 }, periodic = { true, false, false } } })
  check(count == 0, "the same place, not a bond: %d", count)
  set = particles.new()
  set:add("C", 0.5, 5, 5)
  set:add("C", -9.5 + 10 * 7 + 1.2, 5, 5)
  group, count = bonds.new(set, { box = { size = { 10, 10, 10 } } })
  check(count == 1 and glint.scene { group }:cast({ 61.5, 5, 20 }, { 0, 0, -1 }), "halves set out from where the atoms are")
  local state = 7
  local function draw(size)
    state = state * 48271 % 0x7fffffff
    return state / 0x7fffffff * size
  end
  for _, tilt in ipairs { { 0, 0, 0 }, { 1.5, -1, 0.7 }, { -2, 1.9, -1.5 } } do
    for _, size in ipairs { { 4, 4, 4 }, { 9, 4, 5 }, { 1.3, 3, 4 } } do
      local box = { size = size, low = { -3, 1, 2 }, periodic = { true, true, true }, xy = tilt[1], xz = tilt[2], yz = tilt[3] }
      local atoms = {}
      set = particles.new()
      for i = 1, 12 do
        local u, v, w = draw(1), draw(1), draw(1)
        local x, y, z = -3 + u * size[1] + v * box.xy + w * box.xz, 1 + v * size[2] + w * box.yz, 2 + w * size[3]
        atoms[i] = { x, y, z }
        set:add("point", x, y, z)
      end
      _, count = bonds.new(set, { distance = 1.25, box = box })
      local want = count_across(box, atoms, 1.25)
      check(count == want and want > 0, "a box of %g, %g, %g: %g bonds, got %d", size[1], size[2], size[3], want, count)
    end
  end
  set = particles.new()
  set:add("point", 0, 0, 0) -- a crystal with one atom: one bond along each side
  _, count = bonds.new(set, { distance = 1.1, box = { size = { 1, 1, 1 } } })
  check(count == 3, "a simple cubic crystal has three bonds an atom, got %d", count)
  for given, message in pairs {
    [3] = "bonds.box: a box expected, got 3", [{}] = "bonds.box.size: three finite numbers expected, got nil",
    [{ size = { 1, 0, 1 } }] = "bonds.box.size: numbers > 0 expected, got 0",
    [{ size = { 0.1, 1, 1 } }] = "bonds: a periodic box of at least 1/8 of the longest bond expected, got 0.1 for a bond of 1.1",
    [{ size = { 1, 1, 1 }, periodic = { 1, 2, 3 } }] = "bonds.box.periodic: three booleans expected, got 1 at 1",
  } do
    local ok, got = pcall(bonds.new, set, { distance = 1.1, box = given })
    check(not ok and got:find(message, 1, true), "<%s> expected, got <%s>", message, tostring(got))
  end
  set = load()
  set:add_frame(lammps.frame(write("other.dump", dump(0, 1, "pp pp pp\n0 11\n0 10\n0 10", "element x y z", "C 3 5 5\n"))))
  local ok, message = pcall(bonds.new, set)
  check(not ok and message:find("different boxes; set box", 1, true), "two boxes: %s", tostring(message))
end

function tests.sphereflake()
  local list = {}
  sphereflake.each(2, function(x, y, z, radius) list[#list + 1] = { x, y, z, radius } end)
  check(#list == 91, "1 + 9 + 81 spheres, got %d", #list)
  for i = 2, #list do -- each sphere touches its parent: in the first ring, the parent is the first sphere
    local s = list[i]
    if s[4] > 0.1 then near(math.sqrt(s[1] ^ 2 + s[2] ^ 2 + s[3] ^ 2), 2 / 3, 1e-12, "distance of a child") end
  end
  near(list[2][1], math.sqrt(2 / 27), 1e-12, "x of the first child, as published: 0.272166")
  near(list[2][3], math.sqrt(8 / 27), 1e-12, "z of the first child, as published: 0.544331")
  near(list[12][1], 0.643951, 5e-7, "x of the second child, as published")
  near(list[12][2], 0.172546, 5e-7, "y of the second child, as published")
end

function tests.nff()
  local path = folder .. "/flake.nff"
  sphereflake.write_nff(path, 2)
  local picture = nff.load(path)
  check(picture.width == 512 and picture.height == 512 and picture.set.count == 91 and picture.material_count == 1, "size")
  check(picture.scene.camera.fov == 45 and picture.scene.camera.up.z == 1 and picture.scene.background.b == 0.753, "view")
  local hit = picture.scene:cast({ 0, 0, -5 }, { 0, 0, 1 })
  near(hit.point.z, -0.5, 1e-12, "the first sphere from below")
  check(hit.object.materials[1].diffuse.g == 0.45 and hit.object.materials[1].shininess == 5, "material")
  sphereflake.write_nff(path, 0, true)
  picture = nff.load(path)
  hit = picture.scene:cast({ 3, 2, 5 }, { 0, 0, -1 })
  check(hit and hit.t == 5.5 and hit.object.count == 2, "the floor is a mesh of two triangles")
  near(hit.object.material.diffuse.g, 0.6, 1e-15, "its material")
  check(picture.polygon_count == 1 and picture.set.count == 1 and picture.material_count == 2, "counts")
  local head, f = sphereflake.NFF_HEADER, sphereflake.NFF_SPHERES
  refuses("b 0 0 0\n", 2, "v (a view) expected, got the end of the file", nff.load)
  refuses("v\nfrom 0 0 1\nup 0 1 0\n", 3, 'at: 3 numbers expected, got "up 0 1 0"', nff.load)
  refuses("v\nfrom 0 0\n", 2, 'from: 3 numbers expected, got "0 0"', nff.load)
  refuses((head:gsub("angle 45", "angle 180")), 7, 'an angle between 0 and 180 expected, got "180"', nff.load)
  refuses((head:gsub("512 512", "512 0")), 7, 'resolution (a whole number >= 1) expected, got "0"', nff.load)
  refuses(head .. "l 1 2\n", 12, 'l (a light, x y z, or x y z r g b): 3 to 6 numbers expected, got " 1 2"', nff.load)
  refuses(head .. "l 1 2 3 4\n", 12, '3 or 6 numbers of a light expected, got " 1 2 3 4"', nff.load)
  refuses(head .. "s 0 0 0 1\n", 12, 'f (a material) before the first primitive expected, got "s 0 0 0 1"', nff.load)
  refuses(head .. f .. "s 0 0 0\n", 13, 's (a sphere, x y z radius) expected, got " 0 0 0"', nff.load)
  refuses(head .. f .. "s 0 0 0 0\n", 13, 'a radius > 0 expected, got "0"', nff.load)
  refuses(head .. f .. "s 0 0 z 1\n", 13, 'z (a finite number) expected, got "z"', nff.load)
  refuses(head .. "f 1 1 1 1 0 0 0.5 0\n", 12,
    'an index of refraction > 0 where T is above 0 expected, got " 1 1 1 1 0 0 0.5 0"', nff.load)
  refuses(head .. "f 1 1 1 1 0 0 -0.5 1\n", 12, 'no negative number in f expected, got " 1 1 1 1 0 0 -0.5 1"', nff.load)
  local glass = write("glass.nff", head .. "f 1 1 1 0.5 0.25 9 0.5 1.5\ns 0 0 0 1\n")
  local look = nff.load(glass).scene:cast({ 0, 0, -5 }, { 0, 0, 1 }).object.materials[1]
  check(look.mirror.r == 0.25 and look.transmission.r == 0.5 and look.ior == 1.5, "mirror and transmission of f")
  look = nff.load(glass, { mirrors = false }).scene:cast({ 0, 0, -5 }, { 0, 0, 1 }).object.materials[1]
  check(look.mirror.r == 0 and look.transmission.r == 0, "left out on request")
  refuses(head .. "f 1 1 1\n", 12, 'f (r g b Kd Ks Shine T index): 8 numbers expected, got " 1 1 1"', nff.load)
  local patch = write("patch.nff", head .. f .. "pp 3\n0 0 0 0 0.6 0.8\n1 0 0 0 0.6 0.8\n0 1 0 0 0.6 0.8\n")
  hit = nff.load(patch).scene:cast({ 0.2, 0.2, 1 }, { 0, 0, -1 })
  near(hit.normal.z, 1, 1e-12, "the geometric normal of a patch")
  check(hit.object.shading == "phong", "a patch has normals of its own")
  refuses(head .. "p 3\n0 0 0\n", 12, 'f (a material) before the first primitive expected, got "p 3"', nff.load)
  refuses(head .. f .. "p 2\n", 13, 'the number of corners of p (a whole number >= 3) expected, got " 2"', nff.load)
  refuses(head .. f .. "p 3\n0 0 0\n1 0 0\n", 16, "corner 3 of 3 expected, got the end of the file", nff.load)
  refuses(head .. f .. "p 3\n0 0 0\n1 0 0 1\n", 15, 'corner 2 of 3: 3 numbers expected, got "1 0 0 1"', nff.load)
  refuses(head .. f .. "pp 3\n0 0 0\n", 14, 'corner 1 of 3: 6 numbers expected, got "0 0 0"', nff.load)
  refuses(head .. f .. "p 3\n0 0 0\n1 0 0\n0 1 0\np 3\n0 0 0\n1 0 0\n2 0 0\n", 17,
    "a face with an area expected: its vertices 4, 5, 6 are on one line", nff.load)
  refuses(head .. "c\n0 0 0 1\n0 0 1 1\n", 12, 'f (a material) before the first primitive expected, got "c"', nff.load)
  refuses(head .. f .. "c\n0 0 0 1\n", 15, "the apex of c, x y z radius expected, got the end of the file", nff.load)
  refuses(head .. f .. "c\n0 0 0\n0 0 1 1\n", 14, 'the base of c, x y z radius: 4 numbers expected, got "0 0 0"', nff.load)
  refuses(head .. f .. "c\n0 0 0 -1\n0 0 1 1\n", 14, 'a radius >= 0 expected, got "0 0 0 -1"', nff.load)
  refuses(head .. f .. "c\n0 0 0 0\n0 0 1 0\n", 15, 'a radius > 0 at one of the ends of c expected, got "0"', nff.load)
  refuses(head .. f .. "c\n0 0 1 1\n0 0 1 2\n", 15, 'an apex of c that differs from its base expected, got "the same"', nff.load)
  picture = nff.load(write("cone.nff", head .. f .. "c\n0 0 0 1\n0 0 2 1\nc\n5 0 2 0\n5 0 0 1\nc\n9 0 0 2\n9 0 2 1\n"))
  check(#picture.cones == 3, "cones")
  local scene = picture.scene
  near(scene:cast({ 0, -9, 1 }, { 0, 1, 0 }).t, 8, 1e-12, "a cylinder")
  check(not scene:cast({ 0, 0, 9 }, { 0, 0, -1 }), "is open")
  near(scene:cast({ 5, -9, 1 }, { 0, 1, 0 }).t, 8.5, 1e-12, "a cone, its point first")
  near(scene:cast({ 9, -9, 1 }, { 0, 1, 0 }).t, 7.5, 1e-3, "a cut cone")
  near(scene:cast({ 9, -9, 1 }, { 0, 1, 0 }).point.z, 1, 1e-12, "at its middle")
  check(not scene:cast({ 9, 0, 9 }, { 0, 0, -1 }), "is open, too")
  refuses(head .. "torus 1 2\n", 12, 'v, b, l, f, s, p, pp, c or # expected, got "torus 1 2"', nff.load)
end

-- Runs a script through the command, in another folder. Returns its output.
local root = assert(io.popen "pwd"):read "l"
local command = os.getenv "GLINT" or root .. "/" .. build .. "/glint"
local function run(arguments)
  local pipe = assert(io.popen(("cd '%s' && '%s' %s 2>&1"):format(folder, command, arguments)))
  local text = pipe:read "a"
  local ok = pipe:close()
  return ok, text
end

-- Returns the contents of a .pfm: width, height, and a function of x, y (from the top left) and channel.
local function read_pfm(path)
  local text = slurp(path)
  local kind, width, height, start = text:match "^(P[Ff])%s(%d+)%s(%d+)%s%-[%d.]+%s()"
  local channels = kind == "PF" and 3 or 1
  width, height = tonumber(width), tonumber(height)
  return width, height, function(x, y, channel)
    return (("<f"):unpack(text, start + 4 * (((height - 1 - y) * width + x) * channels + channel - 1)))
  end
end

-- Counts the different colours of a picture, sampled on a grid.
local function colors_of(path)
  local width, height, at = read_pfm(path)
  local seen, count = {}, 0
  for y = 0, height - 1, 2 do
    for x = 0, width - 1, 2 do
      local key = ("%.3f %.3f %.3f"):format(at(x, y, 1), at(x, y, 2), at(x, y, 3))
      if not seen[key] then
        seen[key] = true
        count = count + 1
      end
    end
  end
  return count
end

function tests.pictures()
  for _, case in ipairs { "molecule", "protein --set residues=20", "sphereflake --set size=2 --set nff=balls.nff",
    "particle_box --set count=4000", "nff --set file=balls.nff --set mirrors=false" } do
    local name = case:match "^%S+"
    local ok, text = run(("%s/scripts/%s.lua %s --size 96x72 --samples 1 -o %s.pfm --quiet"):format(root, name,
      case:sub(#name + 1), name))
    check(ok, "%s: %s", name, text)
    if ok then
      local count = colors_of(folder .. "/" .. name .. ".pfm")
      check(count > 60, "%s: a picture of more than 60 colours, got %d", name, count)
    end
  end
  local same, difference = run "compare sphereflake.pfm nff.pfm --fail 0 --warn 0"
  check(same, "the sphereflake and what is read of its file: %s", difference)
  local ok, text = run(("%s/scripts/molecule.lua --set file=nothing.xyz"):format(root))
  check(not ok and text:find("nothing.xyz: No such file", 1, true), "no file: %s", text)
end

-- From the third light on, frames reuse the hits and cast no rays. Pictures equal albedo times n.l of the normal map.
function tests.photometric()
  local ok, text = run(root .. "/scripts/photometric.lua --json --size 64x64 --set lights=7 --set shadows=false " ..
    "--set spread=30 --set exact=true")
  check(ok, "photometric: %s", text)
  local frames, reused = 0, 0
  for line in text:gmatch '[^\n]*"event":"frame"[^\n]*' do
    frames = frames + 1
    local is_reused = line:find('"cast":"reused"', 1, true) and line:find('"primary":0,"shadow":0', 1, true)
    if is_reused then reused = reused + 1 end
  end
  check(frames == 8 and reused == 5, "7 lights and the truth, 5 with kept hits; got %d and %d", frames, reused)
  local set, lights = folder .. "/photometric/", {}
  for file, x, y, z, intensity in slurp(set .. "lights.csv"):gmatch "(light_%d+.pfm),([^,]+),([^,]+),([^,]+),([^\n]+)" do
    local _, _, at = read_pfm(set .. file)
    lights[#lights + 1] = { tonumber(x), tonumber(y), tonumber(z), at = at }
    near(x ^ 2 + y ^ 2 + z ^ 2, 1, 1e-12, "unit direction")
    check(tonumber(intensity) == 1, "intensity")
  end
  check(#lights == 7, "lights.csv: 7 lights, got %d", #lights)
  local _, _, normal = read_pfm(set .. "normal.pfm")
  local _, _, depth = read_pfm(set .. "depth.pfm")
  check(normal(0, 0, 3) == 0 and depth(0, 0, 1) == math.huge, "nothing in the corner")
  near(normal(32, 32, 3), 1, 1e-3, "the middle faces the camera")
  near(depth(32, 32, 1), 8.4, 1e-2, "and is 8.4 away")
  for _, p in ipairs { { 32, 32 }, { 26, 34 }, { 38, 40 } } do
    local x, y = p[1], p[2]
    for k = 1, 7 do -- the red value is 0.75 (n.l) on the large ball
      local l = lights[k]
      local n_l = normal(x, y, 1) * l[1] + normal(x, y, 2) * l[2] + normal(x, y, 3) * l[3]
      near(l.at(x, y, 1), 0.75 * n_l, 1e-6, ("light %d at %d, %d"):format(k, x, y))
    end
  end
  local mask = png.grey(3, 2)
  mask:set(2, 1, 1)
  mask:save(folder .. "/grey.png")
  local written = slurp(folder .. "/grey.png")
  check(written:sub(17, 26) == "\0\0\0\3\0\0\0\2\8\0", "a grey picture: size, 8 bits, one channel")
  check(written:find("\0\0\0\0\0\0\0\255", 1, true), "its rows")
  for _, name in ipairs { "mask.png", "normal.png", "depth.png" } do
    check(slurp(set .. name):sub(25, 25):byte() == 16, "%s has 16 bits", name)
  end
end

function tests.one_range_over_all_frames()
  local head = "1\nProperties=species:S:1:pos:R:3:q:R:1\n"
  local path = write("film.xyz", head .. "C 0 0 0 3\n" .. head .. "C 0 0 0 -2.5\n" .. head .. "C 0 0 0 7\n")
  local low, high = particles.range(xyz.frames(path), "q")
  check(low == -2.5 and high == 7, "range: %s to %s", low, high)
  check(not pcall(particles.range, xyz.frames(path), "speed") and not pcall(particles.range, function() end, "q"))
end

-- --size and -o apply, and Normal_gt.mat has the numbers of Normal_gt.npy, column by column.
function tests.photometric_obeys_the_command_line()
  local script = root .. "/scripts/photometric.lua -q --set lights=2 --size 24x16 "
  local ok, text = run(script .. "--set layout=diligent --set objects=sphere --set folder=wide")
  check(ok, "photometric: %s", text)
  check(slurp(folder .. "/wide/objects.txt") == "sphere_matt\n", "objects.txt")
  local matrix = slurp(folder .. "/wide/sphere_matt/Normal_gt.mat")
  local arrays = slurp(folder .. "/wide/sphere_matt/Normal_gt.npy")
  check(matrix:sub(1, 6) == "MATLAB" and matrix:sub(125, 128) == "\0\1IM" and ("<I4I4"):unpack(matrix, 129) == 14, "its head")
  local rows, columns, layers = ("<i4i4i4"):unpack(matrix, 161)
  check(rows == 16 and columns == 24 and layers == 3, "%d x %d x %d", rows, columns, layers)
  local numbers, truth = #matrix - 8 * 16 * 24 * 3 + 1, #arrays - 4 * 16 * 24 * 3 + 1
  for y = 0, 15 do
    for x = 0, 23 do
      for c = 0, 2 do
        local a = ("<d"):unpack(matrix, numbers + 8 * (c * 16 * 24 + x * 16 + y))
        local b = ("<f"):unpack(arrays, truth + 4 * ((y * 24 + x) * 3 + c))
        check(a == b, "%d, %d, %d: %g, not %g", y, x, c, a, b)
      end
    end
  end
  ok, text = run(script .. "-o 'own/shot_%02d.png'")
  check(ok, "photometric -o: %s", text)
  check(slurp(folder .. "/own/lights.csv"):match "\n(shot_01.png),[^\n]*\n(shot_02.png)," and slurp(folder .. "/own/shot_02.png") ~= "",
    "the names of -o")
  check(slurp(folder .. "/own/mask.png"):sub(17, 24) == "\0\0\0\24\0\0\0\16", "the truth is beside them")
end

tally.run(tests)
tally.finish()
