-- scripts/lib/glint: files as real programs write them, beyond the formats' own examples: line ends, byte order
-- marks, names without an element, alternate locations, Fortran numbers, boxes from old and new programs, empty frames.
local build = os.getenv "BUILD" or "build"
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
package.path = "scripts/lib/?.lua;" .. package.path
local glint = require "glint"
local elements, particles, xyz = require "glint.elements", require "glint.particles", require "glint.xyz"
local pdb, lammps, points = require "glint.pdb", require "glint.lammps", require "glint.points"
local bonds, boxes = require "glint.bonds", require "glint.box"

local folder = build .. "/tests/data_variants"
assert(os.execute(("rm -rf '%s' && mkdir -p '%s'"):format(folder, folder)))

local function write(name, text)
  local path = folder .. "/" .. name
  local file = assert(io.open(path, "wb"))
  assert(file:write(text))
  assert(file:close())
  return path
end

-- Returns all atoms of a frame as text: "C 1 2 3; H 4 5 6".
local function spell(frame)
  local list = {}
  for label, x, y, z, radius in frame:atoms() do
    list[#list + 1] = ("%s %.14g %.14g %.14g%s"):format(label, x, y, z, radius and (" %.14g"):format(radius) or "")
  end
  return table.concat(list, "; ")
end

local function is(got, want, what) check(got == want, "%s: <%s> expected, got <%s>", what or "atoms", want, got) end

local raises = tally.raises

-- Calls f and returns the warnings, as a list.
local function warnings_of(f)
  local list, warn = {}, glint._warn
  glint._warn = function(message) list[#list + 1] = message end
  local ok, message = pcall(f)
  glint._warn = warn
  check(ok, "%s", message)
  return list
end

local function dump(bounds, columns, ...)
  local rows = { ... }
  return ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS%s\nITEM: ATOMS %s\n%s"):format(#rows, bounds, columns,
    table.concat(rows, "\n") .. (#rows > 0 and "\n" or ""))
end

local tests = {}

local BOM <const> = "\xef\xbb\xbf"
local RECORD <const> = "%-6s%5d %-4s%1s%-3s %1s%4d    %8.3f%8.3f%8.3f%6.2f%6.2f          %2s\n"

local function atom(name, alternate, residue, number, x, element)
  return RECORD:format("ATOM", number, name, alternate, residue, "A", number, x, 0, 0, 1, 0, element or "")
end

function tests.line_ends_and_marks()
  local texts = {
    { xyz, "2\nwater\nO 1 2 3\nH 4 5 6\n1\n\nC 7 8 9\n", "O 1 2 3; H 4 5 6", "C 7 8 9" },
    { pdb, "MODEL        1\n" .. atom(" CA ", " ", "ALA", 1, 1) .. "ENDMDL\nMODEL        2\n" .. atom(" N  ", " ", "ALA", 1, 2) ..
      "ENDMDL\n", "C 1 0 0", "N 2 0 0" },
    { lammps, dump(" pp pp pp\n0 9\n0 9\n0 9", "id type x y z", "1 1 1 2 3") .. dump(" pp pp pp\n0 9\n0 9\n0 9", "type x y z",
      "2 4 5 6"), "type1 1 2 3", "type2 4 5 6" },
  }
  for _, case in ipairs(texts) do
    for _, ending in ipairs { "\n", "\r\n", "\r", "\r\r\n" } do
      for _, mark in ipairs { "", BOM } do
        local path = write("a.txt", mark .. case[2]:gsub("\n", ending))
        is(spell(case[1].frame(path)), case[3], ("%q"):format(mark .. ending))
        local film = case[1].film(path)
        is(spell(film:frame(2)), case[4])
        is(spell(film:frame(1)), case[3], "again")
        check(film:length() == 2, "two frames, got %d", film:length())
      end
    end
  end
  for _, ending in ipairs { "\n", "\r\n", "\r" } do
    is(spell(points.frame(write("p.csv", BOM .. ("x,y,z,radius\n1,2,3,1\n4,5,6,2"):gsub("\n", ending)))), "point 1 2 3 1; point 4 5 6 2")
  end
  raises("a.txt:3: x (a finite number) expected, got \"one\"", function() spell(xyz.frame(write("a.txt", "1\r\rC one 2 3\r"))) end)
  -- Tests line ends that cross the border of two blocks.
  for size = 262128, 262148 do
    local path = write("long.xyz", "2\r\n" .. ("x"):rep(size) .. "\r\nC 1 2 3\r\nO 4 5 6\r\n")
    is(spell(xyz.frame(path)), "C 1 2 3; O 4 5 6", "a long comment of " .. size)
    path = write("long.xyz", "2\r" .. ("x"):rep(size) .. "\rC 1 2 3\rO 4 5 6")
    is(spell(xyz.frame(path)), "C 1 2 3; O 4 5 6", "a long comment of " .. size)
  end
end

function tests.formats_that_are_not_read()
  for _, case in ipairs { { "a.cif", "data_1ABC\n", "CIF" }, { "a.pdb", "data_1ABC\n_cell.length_a 10\n", "CIF" },
    { "a.gro", "water\n", "a GROMACS structure" }, { "a.gro.gz", "water\n", "a GROMACS structure" }, { "a.mol2", "@<TRIPOS>", "Tripos MOL2" },
    { "b.xyz", "\xff\xfe1\0\n\0", "UTF-16, not UTF-8" }, { "a.glb", "glTF", "glTF" } } do
    raises(("%s/%s: is %s; glint reads .xyz .pdb"):format(folder, case[1], case[3]), function()
      spell((case[1]:find "pdb" and pdb or xyz).frame(write(case[1], case[2])))
    end)
  end
  raises("none.cif: No such file or directory", xyz.frame, folder .. "/none.cif")
end

-- Returns a frame of zstd with the text as one block that is not compressed.
local function zstd(text)
  return "\x28\xb5\x2f\xfd\xa0" .. ("<I4I3"):pack(#text, #text << 3 | 1) .. text
end

function tests.compressed()
  local text = "2\nfirst\nC 1 2 3\nO 4 5 6\n2\nsecond\nC 7 8 9\nO 1 1 1\n"
  local path = write("film.xyz", text)
  assert(os.execute(("gzip -kf '%s'"):format(path)))
  local files = { path .. ".gz" }
  local ok, message = pcall(xyz.frame, write("film.xyz.zst", zstd(text)))
  if ok then files[2] = folder .. "/film.xyz.zst" else
    check(message:find("is compressed by zstd, which this build does not read", 1, true), "a build without zstd: %s", message)
  end
  for _, name in ipairs(files) do
    local film = xyz.film(name)
    is(spell(film:frame(2)), "C 7 8 9; O 1 1 1", name)
    is(spell(film:frame(1)), "C 1 2 3; O 4 5 6", name .. ": back to the first frame")
    check(film:length() == 2 and xyz.frame(name, 2):arrays().positions[2].x == 1, "%s: its length", name)
    local file = assert(io.open(name, "rb"))
    local whole = file:read "a"
    file:close()
    local cut = name:gsub("film", "cut")
    write(cut:match "[^/]+$", whole:sub(1, -12))
    raises(name:find "gz" and "gzip, and broken" or "zstd, and broken", function() for _ in xyz.frames(cut) do end end)
  end
  is(spell(points.frame(write("a.pts", "0 0 0 2\n"))), "point 0 0 0", "an intensity")
  assert(os.execute(("gzip -kf '%s/a.pts'"):format(folder)))
  is(spell(points.frame(folder .. "/a.pts.gz")), "point 0 0 0", "the ending before .gz counts")
end

function tests.alternate_locations()
  local function read(...) return spell(pdb.frame(write("a.pdb", table.concat { ... }))) end
  is(read(atom(" CA ", " ", "SER", 1, 0, "C"), atom(" CB ", "1", "SER", 1, 1.5, "C"), atom(" CB ", "2", "SER", 1, 1.6, "C"),
    atom(" N  ", " ", "GLY", 2, 3, "N")), "C 0 0 0; C 1.5 0 0; N 3 0 0", "1 and 2")
  is(read(atom(" CA ", "B", "SER", 1, 0, "C"), atom(" CB ", "B", "SER", 1, 1, "C")), "C 0 0 0; C 1 0 0", "B alone")
  is(read(atom(" CA ", "A", "SER", 1, 0, "C"), atom(" CB ", "A", "SER", 1, 1, "C"), atom(" CA ", "B", "SER", 1, 2, "C"),
    atom(" CB ", "B", "SER", 1, 3, "C"), atom(" OG ", "B", "SER", 1, 4, "O")), "C 0 0 0; C 1 0 0; O 4 0 0", "block after block")
  is(read(atom(" CA ", "B", "SER", 1, 0, "C"), atom(" CA ", "A", "SER", 1, 1, "C"), atom(" CA ", "A", "SER", 2, 2, "C"),
    atom(" CA ", "B", "SER", 2, 3, "C")), "C 0 0 0; C 2 0 0", "each residue has its first")
  is(read(atom(" N  ", " ", "SER", 1, 0, "N"), atom(" CA ", "A", "SER", 1, 1, "C"), atom(" CA ", "B", "THR", 1, 2, "C"),
    atom(" CG2", "B", "THR", 1, 3, "C")), "N 0 0 0; C 1 0 0", "one of two kinds of residue")
  is(read(atom(" CA ", " ", "SER", 1, 0, "C"), atom(" CA ", "B", "SER", 1, 1, "C")), "C 0 0 0", "blank, then B")
  is(read(atom(" CA ", "A", "SER", 1, 0, "C"), atom(" CA ", "A", "SER", 2, 1, "C"), atom(" CA ", "B", "SER", 1, 2, "C"),
    atom(" CA ", "B", "SER", 2, 3, "C")), "C 0 0 0; C 1 0 0", "a chain, then its other places")
  local path = write("two.pdb", ("MODEL        1\n" .. atom(" CA ", "A", "SER", 1, 0, "C") .. "ENDMDL\nMODEL        2\n" ..
    atom(" CA ", "B", "SER", 1, 1, "C") .. "ENDMDL\n"))
  is(spell(pdb.frame(path, 2)), "C 1 0 0", "each model anew")
  raises("tabs.pdb:1: a record in columns without tabs expected", function()
    spell(pdb.frame(write("tabs.pdb", "ATOM\t1\tCA\tALA\tA\t1\t0.000\t0.000\t0.000\t1.00\t0.00\tC\n" .. (" "):rep(60))))
  end)
end

function tests.names_without_an_element()
  local function element(name, residue)
    return (spell(pdb.frame(write("n.pdb", RECORD:format("HETATM", 1, name, " ", residue, "A", 1, 0, 0, 0, 1, 0, ""))))
      :match "^%S*")
  end
  for _, case in ipairs { { "HO2'", "G", "H" }, { "HO3'", "A", "H" }, { "HO5'", "DA", "H" }, { "HE2", "HIS", "H" }, { " HE2", "HIS", "H" },
    { "CA", "ALA", "C" }, { " CA ", "ALA", "C" }, { "NE2", "HIS", "N" }, { "CD1", "LEU", "C" }, { "SG", "CYS", "S" }, { "SD", "MET", "S" },
    { "SE", "MSE", "Se" }, { "HG11", "VAL", "H" }, { "1HB", "ALA", "H" }, { "OXT", "ALA", "O" }, { "P", "DG", "P" }, { "OP1", "DG", "O" },
    { " FE ", "HEM", "Fe" }, { "FE", "HEM", "Fe" }, { " NA ", "HEM", "N" }, { " CHA", "HEM", "C" }, { "CA", "CA", "Ca" }, { "NA", "NA", "Na" },
    { "Na+", "Na+", "Na" }, { "CL", "CL", "Cl" }, { " CL1", "LIG", "Cl" }, { "BR12", "LIG", "Br" }, { "ZN", "ZN2", "Zn" }, { "HG", "HG", "Hg" },
    { "SOD", "SOD", "Na" }, { "CLA", "CLA", "Cl" }, { "K", "K", "K" }, { "MG", "MG", "Mg" }, { "CO", "B12", "Co" }, { " CO ", "LIG", "C" },
    { "OH2", "TIP", "O" }, { "HW1", "SOL", "H" }, { "OW", "SOL", "O" }, { "EPW", "WAT", "" }, { "MW", "SOL", "" }, { "C10A", "LIG", "C" } } do
    is(element(case[1], case[2]), case[3], ("%q of %s"):format(case[1], case[2]))
  end
  is(spell(pdb.frame(write("left.pdb", atom("C1", " ", "LIG", 1, 0) .. atom("CD", " ", "LIG", 1, 1) .. atom("CL2", " ", "LIG", 1, 2)))),
    "C 0 0 0; C 1 0 0; Cl 2 0 0", "all names at the left")
  is(spell(pdb.frame(write("e.pdb", atom(" CA ", " ", "LIG", 1, 0, "CA") .. atom("D1", " ", "DOD", 1, 1, "D")))), "Ca 0 0 0; H 1 0 0",
    "the column of elements decides")
end

function tests.cell_of_pdb()
  local cell = "CRYST1   10.000   20.000   30.000  90.00  90.00 120.00 P 1           1\n"
  local frame = pdb.frame(write("c.pdb", "HEADER\n" .. cell .. atom(" CA ", " ", "ALA", 1, 1)))
  check(frame.cell.a[1] == 10 and frame.cell.b[1] == -10 and math.abs(frame.cell.b[2] - 17.320508075688775) < 1e-13 and frame.cell.c[3] == 30,
    "sides")
  check(frame.box.xy == -10 and frame.box.size[3] == 30 and frame.box.periodic[1], "box")
  check(boxes.edges(frame.box).count == 20, "edges")
  check(pdb.frame(write("c.pdb", "CRYST1    1.000    1.000    1.000  90.00  90.00  90.00 P 1           1\n" ..
    atom(" CA ", " ", "ALA", 1, 1))).box == nil, "no crystal, no cell")
  local models = {}
  for n = 1, 3 do
    models[n] = ("CRYST1%9.3f%9.3f%9.3f%7.2f%7.2f%7.2f P 1\nMODEL %8d\n%sENDMDL\n"):format(10 * n, 10, 10, 90, 90, 90, n,
      atom(" CA ", " ", "ALA", 1, n))
  end
  models[3] = models[3]:gsub("^.-\n", "")
  local film = pdb.film(write("film.pdb", table.concat(models)))
  for _, n in ipairs { 3, 1, 2, 3, 2, 1 } do
    local found = film:frame(n)
    check(found.box.size[1] == 10 * math.min(n, 2) and found.model == n, "frame %d has its cell, or that before it", n)
    is(spell(found), ("C %d 0 0"):format(n))
  end
  for _, angles in ipairs { "120.00 120.00 150.00", "  0.00   0.00   0.00", " 90.00  90.00   ****" } do
    local list = warnings_of(function()
      frame = pdb.frame(write("c.pdb", ("CRYST1   10.000   20.000   30.000 %s P 1\n"):format(angles) .. atom(" CA ", " ", "ALA", 1, 1)))
    end)
    check(frame.box == nil and #list == 1 and list[1]:find("c.pdb:1: no cell: six numbers of one expected", 1, true), "got %s", list[1])
    is(spell(frame), "C 1 0 0")
  end
end

function tests.metals_in_rings()
  local function read(name, residue) return (spell(pdb.frame(write("r.pdb", atom(name, " ", residue, 1, 1)))):match "%a+") end
  for _, residue in ipairs { "HEM", "HEC", "CLA", "BCL" } do
    for name, want in pairs { ["NA  "] = "N", NB = "N", ["CHA "] = "C", CMA = "C", O1A = "O", HHA = "H", ["MG  "] = "Mg", FE = "Fe" } do
      is(read(name, residue), want, name .. " of " .. residue)
    end
  end
  is(read("NA  ", "NA"), "Na", "of an ion")
  local list = warnings_of(function()
    pdb.frame(write("c.pdb", "CRYST1 10.0 10.0 10.0 90 90 90 P 1\n" .. atom(" CA ", " ", "ALA", 1, 1)))
  end)
  check(#list == 1 and list[1]:find("c.pdb:1: no cell: six numbers of one expected", 1, true), "numbers in other columns: %s", list[1])
end

function tests.radii_of_xyz()
  for properties, row in pairs { ["species:S:1:pos:R:3:radius:R:1"] = "C 0 0 0 %g\nC 1 2 3 %g\n",
    ["radius:R:1:species:S:1:pos:R:3"] = "%g C 0 0 0\n%g C 1 2 3\n",
    ["pos:R:3:v:R:3:Radius:R:1:species:S:1"] = "0 0 0 9 9 9 %g C\n1 2 3 9 9 9 %g C\n" } do
    local path = write("r.xyz", "2\nProperties=" .. properties .. "\n" .. row:format(0.25, 0.75))
    is(spell(xyz.frame(path)), "C 0 0 0 0.25; C 1 2 3 0.75", properties)
    local set = particles.new():add_frame(xyz.frame(path))
    local low, high = set.low[1], set.high[3]
    check(low == -0.25 and high == 3.75, "spheres of these radii: %g, %g", low, high)
    path = write("d.xyz", "2\nProperties=" .. properties:gsub("[rR]adius", "diameter") .. "\n" .. row:format(0.5, 1.5))
    is(spell(xyz.frame(path)), "C 0 0 0 0.25; C 1 2 3 0.75", "half of a diameter")
  end
  raises('r.xyz:3: radius (a finite number) expected, got "x"', spell, xyz.frame(write("r.xyz", "1\nProperties=species:S:1:pos:R:3:radius:R:1\nC 0 0 0 x\n")))
  local wide = write("w.xyz", "1\nProperties=species:S:1:pos:R:3:f:R:90:radius:R:1\nC 0 0 0" .. (" 1"):rep(91) .. "\n")
  raises("radius among the first 90 columns", xyz.frame, wide)
end

function tests.keys_of_xyz()
  local function box_of(comment)
    return xyz.frame(write("k.xyz", "1\n" .. comment .. "\nC 1 2 3\n")).box
  end
  local lattice = 'Lattice="4 0 0 0 5 0 0 0 6" '
  for text, want in pairs { ["pbc='F F F'"] = "FFF", ['pbc="F T F"'] = "FTF", ["pbc=[T, F, T]"] = "TFT", ["pbc={1 0 1}"] = "TFT", ["pbc=F"] = "FFF",
    ["pbc=[true,false,true]"] = "TFT", ["pbc = 'F F T'"] = "FFT", ["PBC=\"F F T\""] = "FFT", [""] = "TTT",
    ["note='pbc=\"F F F\" here' pbc='T T F'"] = "TTF", ["don't pbc='F T T'"] = "FTT", ["title=\"it's\" pbc='T F F'"] = "TFF",
    ["my_pbc='F F F'"] = "TTT", ["empty='' flag pbc=\"T F T\""] = "TFT",
    ["pbc=TFT"] = "TFT", ['pbc="[T, F, T]"'] = "TFT", ["pbc=101"] = "TFT" } do
    local got = ""
    for _, is_periodic in ipairs(box_of(lattice .. text).periodic) do got = got .. (is_periodic and "T" or "F") end
    is(got, want, text)
  end
  for _, text in ipairs { "Lattice='4 0 0 0 5 0 0 0 6'", "Lattice=[[4,0,0],[0,5,0],[0,0,6]]", "Lattice={4 0 0 0 5 0 0 0 6}",
    "name=\"Lattice=none\" Lattice=[4, 0, 0, 0, 5, 0, 0, 0, 6]", "lattice = \"4 0 0 0 5.0D+00 0 0 0 6\"",
    "Lattice=\"4, 0, 0, 0, 5, 0, 0, 0, 6\"", "Lattice=\"[[4 0 0] [0 5 0] [0 0 6]]\"" } do
    local box = box_of(text)
    check(box and box.size[1] == 4 and box.size[2] == 5 and box.size[3] == 6, "%s", text)
  end
  local frame = xyz.frame(write("k.xyz", "1\nProperties='species:S:1:pos:R:3' title=\"a \\\"b\\\" Properties=x\" energy=-1.5\nC 1 2 3\n"))
  check(frame.keys.energy == "-1.5" and frame.keys.title == 'a \\"b\\" Properties=x', "keys: %s", frame.keys.title)
  is(spell(frame), "C 1 2 3")
  is(spell(xyz.frame(write("k.xyz", "2\nProperties=type:I:1:pos:R:3\n1 1 2 3\n26 0 0 0\n"))), "type1 1 2 3; type26 0 0 0", "types are no elements")
  is(spell(xyz.frame(write("k.xyz", "1\nProperties=Z:I:1:pos:R:3\n26 1 2 3\n"))), "26 1 2 3", "numbers of elements are")
  raises("k.xyz:2: three words T or F of pbc expected", box_of, lattice .. "pbc='T T'")
  raises('k.xyz:2: T or F of pbc expected, got "yes"', box_of, lattice .. "pbc=yes")
end

function tests.numbers_and_labels()
  is(spell(xyz.frame(write("f.xyz", "2\n\nC 1.5D+01 -2d0 0.3-1\nO 1E0 .5 -.25D-1\n"))), "C 15 -2 0.03; O 1 0.5 -0.025", "Fortran")
  for label, want in pairs { C13 = "C", ["Fe+3"] = "Fe", ["Fe3+"] = "Fe", ["O2-"] = "O", CA = "Ca", Ca = "Ca", CB = "C", HG1 = "H", CD2 = "C",
    Cl1 = "Cl", CL1 = "Cl", ["13C"] = "C", OW = "O", HW2 = "H", C_R = "C", ["C.ar"] = "C", ["O.3"] = "O", Si4 = "Si", D = "H", NE2 = "N", He1 = "He" } do
    is(elements.of_label(label), want, label)
  end
  for _, label in ipairs { "X", "Xx", "XX", "Bq", "BQ", "H-Bq", "Gh", "Du", "DU", "LP", "EP", "EPW", "MW", "Q", "O:", "*", "0", "Tv", "Vac",
    "Solvent" } do
    check(elements.of_label(label) == nil, "%s is no element", label)
  end
  local path = write("ghosts.xyz", "4\n\nC13 0 0 0\nBq 3 0 0\nXx 6 0 0\nFe+3 9 0 0\n")
  local set = particles.new()
  local list = warnings_of(function()
    set:add_frame(xyz.frame(path))
    set:add_frame(xyz.frame(path))
  end)
  check(#list == 1 and list[1]:find('ghosts.xyz:4: "Bq" is neither an element nor in the option kinds', 1, true), "one warning a file, got %d: %s",
    #list, list[1])
  check(set.counts.ghost == 4 and set.counts.C == 2 and set.counts.Fe == 2, "one kind of ghosts")
  local _, count = bonds.new(set, { distance = 100, box = false })
  check(count == 4, "ghosts have no bonds: two C and two Fe, got %d", count)
  check(set:spheres().count == 8, "all are spheres")
  local own = particles.new { kinds = { Bq = { color = "red", radius = 2 } } }
  check(#warnings_of(function() own:add_frame(xyz.frame(write("own.xyz", "1\n\nBq 0 0 0\n"))) end) == 0 and own.counts.Bq == 1,
    "a kind of one's own has its name")
end

function tests.dumps()
  local function read(...) return lammps.frame(write("d.dump", dump(...))) end
  local frame = read("\n0 10\n0 10\n-0.5 0.5", "id type x y z", "1 1 1 2 0")
  check(frame.box.periodic[1] and frame.box.size[3] == 1, "bounds without kinds repeat, as LAMMPS's do")
  is(spell(frame), "type1 1 2 0")
  check(read(" xy xz yz\n0 5 1\n0 4 0\n0 4 0", "id type x y z", "1 1 1 2 0").box.xy == 1, "tilted, without kinds")
  is(spell(read(" pp pp pp\n0 9\n0 9\n0 9", "id x y z", "1 1 2 3")), "point 1 2 3", "no type")
  is(spell(read(" pp pp pp\n0 9\n0 9\n0 9", "id type typelabel x y z", "1 1 Na+ 1 2 3")), "Na+ 1 2 3", "typelabel")
  frame = read(" abc origin pp pp fs\n4 0 0 -1\n1 5 0 -2\n0 0.5 6 -3", "type x y z", "1 1 2 3")
  check(frame.box.size[2] == 5 and frame.box.xy == 1 and frame.box.yz == 0.5 and frame.box.low[3] == -3 and not frame.box.periodic[3], "abc origin")
  frame = read(" abc origin pp pp pp\n0 4 0 0\n-4 0 0 0\n0 0 4 0", "type x y z", "1 1 2 3")
  check(frame.box == nil and frame.cell.b[1] == -4 and boxes.edges(frame.cell).count == 20, "a turned cell is a cell alone")
  is(spell(frame), "type1 1 2 3")
  frame = read(" pp pp pp\n0 10\n0 10\n2 2", "type x y z", "1 11 2 2")
  check(frame.box.size[3] == 0 and not frame.box.periodic[3], "a flat box")
  check(boxes.edges(frame.box).count == 16, "eight corners, eight sides, got %d", boxes.edges(frame.box).count)
  is(spell(lammps.frame(folder .. "/d.dump", 1, { wrap = true })), "type1 1 2 2", "wrapped in a flat box")
  local text = dump(" pp pp pp\n0 9\n0 9\n0 9", "type x y z", "1 1 2 3")
  is(spell(lammps.frame(write("u.dump", (text:gsub("ITEM: NUMBER", "ITEM: SOMETHING NEW\n1 2 3\n4\n%0"))))), "type1 1 2 3", "an item of a later version")
  raises("u.dump:9: a line ITEM: ... expected", function() lammps.frame(write("u.dump", (text:gsub("ITEM: ATOMS type", "LATER %0")))) end)
  raises("ITEM: ATOMS of dump atom or dump custom expected", lammps.frame,
    write("l.dump", "ITEM: TIMESTEP\n0\nITEM: ENTRIES index c_1\n1 2\n"))
end

-- Tests films whose first frames are empty.
function tests.labels_and_shares_of_dumps()
  is(spell(lammps.frame(write("l.dump", dump(" pp pp pp\n0 10\n0 10\n0 10", "id type x y z", "1 C 1 2 3", "2 Fe 4 5 6")))), "C 1 2 3; Fe 4 5 6",
    "dump_modify types labels")
  -- A box with sides (0, 10, 0), (20, 0, 0), (0, 0, 5) from (1, 2, 3); the point has the fractions 0.5, 0.25, 0.2.
  is(spell(lammps.frame(write("l.dump", dump(" abc origin pp pp pp\n0 10 0 1\n20 0 0 2\n0 0 5 3", "id xs ys zs", "1 0.5 0.25 0.2")))), "point 6 7 4",
    "shares of a cell that lies anyhow")
end

function tests.empty_frames()
  local empty, one = dump(" pp pp pp\n0 10\n0 10\n0 10", "id type x y z"), dump(" pp pp pp\n0 10\n0 10\n0 10", "id type x y z", "1 1 1 2 3")
  for _, case in ipairs { { lammps, empty .. one }, { xyz, '0\nLattice="10 0 0 0 10 0 0 0 10"\n1\n\nC 1 2 3\n' } } do
    local film = case[1].film(write("film.txt", case[2]))
    check(film:length() == 2, "two frames, got %d", film:length())
    local set = particles.new { color_by = { column = "x" } }
    set:add_frame(film:frame(1))
    local center, radius = set:extent()
    check(center[1] == 5 and math.abs(radius - 5 * 3 ^ 0.5) < 1e-12, "what a camera sees is the box")
    local low, high = set:range()
    check(low == 0 and high == 1, "a range without values")
    local none, zero = bonds.new(set)
    check(none == nil and zero == 0, "no bonds")
    local scene = glint.scene { ambient = 1, background = "white", camera = set:camera { from = { 1, 1, 1 } } }
    local shown = scene:add(set:spheres())
    check(scene:render { width = 4, height = 4 }:pixel(1, 1) == 1, "nothing but background")
    scene:remove(shown)
    set = particles.new()
    set:add_frame(film:frame(2))
    scene:add(set:spheres())
  end
  local center, radius = particles.new():extent()
  check(center[1] == 0 and radius == 1, "without a box")
end

-- ---- Point clouds ----

-- Returns the points of a file as spheres: centre, radius and the name of their material, "1 2 3 0.5 #ff0000; ...".
local function colored(name, text, options)
  local set = particles.new(options or { radius = 0.25 })
  set:add_frame(points.frame(write(name, text)))
  local all, list = set:arrays(), {}
  for i, row in ipairs(all.data) do
    list[i] = ("%.9g %.9g %.9g %s"):format(row[1], row[2], row[3], all.materials[all.index[i]].name)
  end
  return table.concat(list, "; ")
end

local RED_GREEN <const> = "0 0 0 #ff0000; 1 0 0 #00ff00"

function tests.columns_of_colours()
  for name, text in pairs { ["a.xyz"] = "0 0 0 255 0 0\n1 0 0 0 255 0\n", ["b.xyz"] = "0 0 0 1.0 0.0 0.0\n1 0 0 0.0 1.0 0.0\n",
    ["c.xyzrgb"] = "0 0 0 1 0 0\n1 0 0 0 1 0\n", ["d.pts"] = "2\n0 0 0 -1200 255 0 0\n1 0 0 -900 0 255 0\n", ["e.pts"] = "0 0 0 255 0 0\n1 0 0 0 255 0\n",
    ["f.csv"] = "//X,Y,Z,R,G,B\n0,0,0,255,0,0\n1,0,0,0,255,0\n", ["g.csv"] = "red,green,blue,x,y,z,mass\n1,0,0,0,0,0,7\n0,1,0,1,0,0,7\n",
    ["h.txt"] = "0 0 0 255 0 0 0.6 0.8 0\n1 0 0 0 255 0 0 0 -1\n", ["i.txt"] = "0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n" } do
    is(colored(name, text), RED_GREEN, name)
  end
  is(colored("half.xyz", "0 0 0 0.5 0.25 1\n1 0 0 0.9 0.25 1\n"), "0 0 0 #8040ff; 1 0 0 #e640ff", "red is no radius")
  for name, text in pairs { ["n.xyz"] = "0 0 0 0.6 0.8 0\n1 0 0 0 0 -1\n", ["n.xyzn"] = "0 0 0 1 0 0\n1 0 0 0 1 0\n" } do
    local frame = points.frame(write(name, text))
    check(table.concat(frame.columns, " ") == "x y z nx ny nz" and not frame.color, "normals: %s", table.concat(frame.columns, " "))
    is(spell(frame), "point 0 0 0; point 1 0 0", name)
  end
  is(spell(points.frame(write("r.txt", "0 0 0 2\n1 0 0 3\n"))), "point 0 0 0 2; point 1 0 0 3", "four are a radius")
  is(spell(points.frame(write("r.pts", "0 0 0 200\n1 0 0 3\n"))), "point 0 0 0; point 1 0 0", "of .pts an intensity")
  is(spell(points.frame(write("o.txt", "0 0 0 2 300 7\n"))), "point 0 0 0 2", "neither a colour nor a normal")
  is(colored("own.csv", "x,y,z,r,g,b\n0,0,0,255,0,0\n", { kinds = { point = { color = "blue", radius = 1 } } }), "0 0 0 point",
    "a colour of the script comes first")
  raises('bad.csv:3: red, green and blue 0 .. 255 expected, got "-1"', colored, "bad.csv", "x,y,z,r,g,b\n0,0,0,255,0,0\n0,0,0,-1,0,0\n")
  local many = {}
  for i = 0, 9999 do many[#many + 1] = ("%d 0 0 %d %d 7"):format(i, i // 100, i % 100 + 150) end
  local set = particles.new { radius = 1 }
  set:add_frame(points.frame(write("many.xyz", table.concat(many, "\n"))))
  check(#set.materials > 4096 and #set.materials < 4500, "colours after the first 4096 are rounded, got %d materials", #set.materials)
end

function tests.clouds()
  local head = "ply\nformat %s 1.0\ncomment by hand\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n" ..
    "property uchar red\nproperty uchar green\nproperty uchar blue\n%send_header\n"
  is(colored("a.ply", head:format("ascii", "") .. "0 0 0 255 0 0\n1 0 0 0 255 0\n"), RED_GREEN, "text")
  local faces = "element face 0\nproperty list uchar int vertex_indices\n"
  for name, order in pairs { binary_little_endian = "<", binary_big_endian = ">" } do
    local row = order .. "fffBBB"
    is(colored("b.ply", head:format(name, faces) .. row:pack(0, 0, 0, 255, 0, 0) .. row:pack(1, 0, 0, 0, 255, 0)), RED_GREEN, name)
    raises("b.ply: point 2 of 2 expected, got the end of the file", colored, "b.ply", head:format(name, "") .. row:pack(0, 0, 0, 13, 10, 0))
  end
  is(colored("n.ply", head:format("ascii", "") .. "nan nan nan 1 1 1\n1 0 0 0 255 0\n"), "1 0 0 #00ff00", "gaps")
  is(colored("f.ply", (head:gsub("uchar", "float"):format("ascii", "")) .. "0 0 0 1 0 0\n1 0 0 0 1 0\n"), RED_GREEN, "colours 0 .. 1")
  is(colored("g.ply", (head:gsub("uchar", "float"):format("ascii", "")) .. "0 0 0 255 0 0\n1 0 0 0 255 0\n"), RED_GREEN, "colours 0 .. 255 as floats")
  raises("c.ply:13: point 2 of 2 with 6 numbers expected, got the end of the file", colored, "c.ply", head:format("ascii", "") .. "0 0 0 1 0 0\n")
  local pcd = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F %s\nCOUNT 1 1 1 1\n" ..
    "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA %s\n"
  is(colored("a.pcd", pcd:format("U", "ascii") .. "0 0 0 16711680\n1 0 0 65280\n"), RED_GREEN, ".pcd")
  is(colored("f.pcd", pcd:format("F", "ascii") .. "0 0 0 2.34180515e-38\n1 0 0 9.14767637e-41\n"), RED_GREEN, "colours as the bits of a float")
  is(colored("b.pcd", pcd:format("F", "binary") .. ("<fffI4fffI4"):pack(0, 0, 0, 0xff0000, 1, 0, 0, 0x00ff00)), RED_GREEN, "binary")
  is(colored("v.pcd", (pcd:gsub("^.-\n", ""):format("U", "ascii")) .. "0 0 0 16711680\n1 0 0 65280\n"), RED_GREEN, "without a first comment")
  is(colored("o.pcd", (pcd:gsub("FIELDS", "COLUMNS"):gsub("0%.7", ".5"):format("U", "ASCII")) .. "0 0 0 16711680\n1 0 0 65280\n"), RED_GREEN, "version .5")
  for type, size in pairs { F = 4, ["F "] = 8, I = 4, U = 4 } do
    local kind = pcd:gsub("4\nTYPE", size .. "\nTYPE"):format(type, "ascii")
    is(colored("w.pcd", kind .. "0 0 0 16711680\n1 0 0 65280\n"), RED_GREEN, "packed whole numbers of type " .. type)
    is(colored("w.pcd", kind .. "0 0 0 660510\n1 0 0 30\n"), "0 0 0 #0a141e; 1 0 0 #00001e", "dark ones of type " .. type)
  end
  is(colored("w.pcd", pcd:format("F", "ascii") .. "0 0 0 1.671168e+07\n1 0 0 65280.0\n"), RED_GREEN, "whole numbers with a point")
  is(colored("w.pcd", pcd:format("F", "ascii") .. "0 0 0 4.2949017e+09\n1 0 0 4.2782554e+09\n"), RED_GREEN, "and alpha, in eight digits")
  is(colored("w.pcd", pcd:format("F", "binary") .. ("<ffffffff"):pack(0, 0, 0, 0xff0000, 1, 0, 0, 0xff00)), RED_GREEN, "binary whole numbers")
  is(colored("s.pcd", pcd:gsub("rgb", "r g b"):gsub("4 4 4 4", "4 4 4 4 4 4"):gsub("1 1 1 1", "1 1 1 1 1 1"):format("F F F", "ascii") ..
    "0 0 0 255 0 0\n1 0 0 0 255 0\n"), RED_GREEN, "three fields of whole numbers")
  is(colored("n.pcd", pcd:format("F", "ascii") .. "0 0 0 nan\n1 0 0 9.14767637e-41\n"), "0 0 0 point; 1 0 0 #00ff00", "a colour that a text lost")
  is(colored("m.ply", (head:format("ascii", "")) .. "0 0\n0 255 0 0\n1 0 0\n0\n255 0\n"), RED_GREEN, "a point over several lines")
end

-- Bytes packed by hand. Control bytes below 32 precede 1 .. 32 literal bytes; other control bytes copy earlier bytes.
function tests.packed_clouds()
  local head = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n" ..
    "DATA binary_compressed\n"
  local plain = ("<ffffffI4I4"):pack(0, 1, 0, 0, 0, 0, 0xff0000, 0x00ff00)
  local function cloud(packed, size) return head .. ("<I4I4"):pack(#packed, size or 32) .. packed end
  is(colored("c.pcd", cloud("\31" .. plain)), RED_GREEN, "as they are")
  -- A zero, 5 copies of it, 80 3f 00, 17 copies of the last zero, ff 00 00 ff 00 00.
  is(colored("c.pcd", cloud("\0\0" .. "\96\0" .. "\2\128\63\0" .. "\224\8\0" .. "\5\255\0\0\255\0\0")), RED_GREEN, "copies")
  raises("c.pcd: valid LZF data expected", colored, "c.pcd", cloud("\32\9" .. plain))
  raises("c.pcd: valid LZF data expected", colored, "c.pcd", cloud("\31" .. plain .. "\0\0"))
  raises("c.pcd: valid LZF data expected", colored, "c.pcd", cloud("\30" .. plain:sub(2)))
  raises("c.pcd: 32 unpacked bytes expected, got 33", colored, "c.pcd", cloud("\31" .. plain, 33))
  raises("c.pcd: 33 packed bytes expected, got 32", colored, "c.pcd", cloud("\31" .. plain):sub(1, -2))
  raises('d.pcd:10: DATA ascii, binary or binary_compressed expected, got "zip"', colored, "d.pcd", (head:gsub("binary_compressed", "zip")))
end

function tests.counts_and_ranges_of_points()
  is(colored("two.pts", "1\n0 0 0 10 255 0 0\n1\n1 0 0 10 0 255 0\n"), RED_GREEN, "two scans in one file")
  raises("few.pts:4: point 3 of 3 expected, got the end of the file", colored, "few.pts", "3\n0 0 0 10 255 0 0\n1 0 0 10 0 255 0\n")
  is(colored("over.xyzrgb", "0 0 0 1.0004 0 0\n1 0 0 0 0.9999 0\n"), RED_GREEN, "a little above 1")
end

tally.run(tests)
tally.finish()
