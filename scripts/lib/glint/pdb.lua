-- PDB: the ATOM and HETATM records of the Protein Data Bank's format 3.3, by columns. Each MODEL is a frame.
--     for label, x, y, z in pdb.frame "1crn.pdb":atoms() do ... end
-- The element comes from columns 77-78 or, if these are empty, from the atom's name (columns 13-16) and residue. If an
-- atom has alternate locations, the first one is read, whatever its code in column 17. Massless sites of water (EPW,
-- MW) are skipped. CRYST1 gives frame.cell = { origin, a, b, c } and frame.box (glint.box). Other records are skipped.
-- The other fields have names, frame:atoms("chain", "bfactor"): serial, name, resname, chain, resseq, occupancy,
-- bfactor, element, charge.
local glint = require "glint"
local elements = require "glint.elements"
local frames, lines = require "glint.frames", require "glint.lines"

local pdb = {}

local TAKEN = { ATOM = true, HETATM = true, MODEL = true, ENDMDL = true, END = true, CRYST = true }
local LAST_COLUMN = 54 -- last column of z

local function set_of(words)
  local set = {}
  for word in words:gmatch "%S+" do set[word] = true end
  return set
end

-- Residues that contain only H, C, N, O, P, S and Se, so that the first letter of a name is enough.
local BIOMOLECULES = set_of [[
ALA ARG ASN ASP CYS GLN GLU GLY HIS ILE LEU LYS MET PHE PRO SER THR TRP TYR VAL ASX GLX SEC PYL MSE SEP TPO PTR HYP
HID HIE HIP HSD HSE HSP CYX CYM ASH GLH LYN ACE NME NMA NH2
A C G U I T N DA DC DG DT DU DI RA RC RG RU A3 A5 C3 C5 G3 G5 U3 U5 RA3 RA5 RC3 RC5 RG3 RG5 RU3 RU5
DA3 DA5 DC3 DC5 DG3 DG5 DT3 DT5 ADE CYT GUA THY URA AMP ADP ATP GMP GDP GTP]]
local WATERS = set_of "HOH WAT DOD H2O SOL SPC TIP TIP3 TIP4 TIP5 TP3 TP4 TP5 T3P T4P T4E T5P TI3 TI4 OPC SWM"
-- Residues around a metal, where NA and NB are nitrogens and CA is a carbon, in any columns.
local PORPHYRINS = set_of "HEM HEA HEB HEC HDD HEME CLA CHL BCL SRM PP9"
-- CHARMM's names of ions.
local IONS = { SOD = "Na", CLA = "Cl", POT = "K", CAL = "Ca", CES = "Cs", LIT = "Li", RUB = "Rb", BAR = "Ba",
  CAD = "Cd" }
-- Symbols that never begin the name of an atom of another element, in any columns.
local SURE = set_of [[FE CL BR ZN MG MN SI AL LI SE NI CU MO RU RH PT AU AG IR AS GA GE TI ZR]]

-- Returns the element for a name, if no column gives it; nil: none, as for a water's massless sites. In format 3.3 a
-- symbol ends in column 14: " CA " is a carbon, "CA  " calcium. is_left: all names in this file begin in column 13.
local function element_of(name, residue, is_left)
  local text = name:match "^%s*%d*(.-)%s*$"
  local letters = (text:match "^%a+" or ""):upper()
  local first, two = letters:sub(1, 1), letters:sub(1, 2)
  if WATERS[residue] then return first:find "[OHD]" and elements.symbol(first) or nil end
  if BIOMOLECULES[residue] then return elements.symbol(two == "SE" and two or first) end
  if PORPHYRINS[residue] and #letters > 1 and not SURE[two] then return elements.symbol(first) end
  local ion = IONS[letters] or residue:match "^%a*" == letters and elements.symbol(letters)
  if ion then return ion end
  local is_placed = name:find "^%a%a" and not is_left and #text < 4 and (first ~= "H" or text == "HG")
  if SURE[two] or is_placed and elements.symbol(two) then return elements.symbol(two) end
  return elements.symbol(first) or elements.of_label(letters)
end

local COLUMNS = { "serial", "name", "resname", "chain", "resseq", "occupancy", "bfactor", "element", "charge" }
local WHERE = { serial = { 7, 11 }, name = { 13, 16 }, resname = { 18, 20 }, chain = { 22, 22 }, resseq = { 23, 26 },
  occupancy = { 55, 60 }, bfactor = { 61, 66 }, element = { 77, 78 }, charge = { 79, 80 } }

-- Returns a function that extracts the wanted fields of a record, without the spaces around them.
local function pick(wanted)
  return function(line)
    local found = {}
    for i, name in ipairs(wanted) do
      local text = line:sub(WHERE[name][1], WHERE[name][2]):match "^%s*(.-)%s*$"
      found[i] = lines.value(text)
    end
    return table.unpack(found, 1, #wanted)
  end
end

-- Reads an atom; nil for a massless site.
local function read_atom(source, fields, line)
  fields.line = line
  if #line < LAST_COLUMN then source:fail("a record of at least 54 columns (z is in 47-54)", line) end
  local name, residue = line:sub(13, 16), line:sub(18, 21):match("^%s*(.-)%s*$"):upper()
  fields.is_left = fields.is_left or name:find "^[CNO]%d* +$" ~= nil
  local given = line:sub(77, 78):match "%a+"
  local label = given and elements.symbol(given) or element_of(name, residue, fields.is_left)
  if not label and WATERS[residue] then return nil end
  label = label or given or name:match "%S+"
  if not label then source:fail("an element in columns 77-78 or an atom's name in 13-16", line) end
  return label, source:number_of(line:sub(31, 38), "x, columns 31-38,"),
    source:number_of(line:sub(39, 46), "y, columns 39-46,"), source:number_of(line:sub(47, 54), "z, columns 47-54,")
end

-- For rows read in bulk: the record, the name with the code of an alternate location, and the element. Such rows have
-- no alternate locations.
local LAYOUT = { label = WHERE.element, x = { 31, 38 }, y = { 39, 46 }, z = { 47, 54 },
  words = { { 1, 6 }, { 13, 17 } },
  words_of = function(line)
    local given = line:sub(77, 78)
    if line:sub(17, 17) ~= " " or not elements.symbol(given:match "%a+" or "") then return {} end
    return { line:sub(1, 6), line:sub(13, 17), given }
  end }

local function residue_of(line) return line:sub(22, 27) .. line:sub(73, 76) end

-- Stores lines without alternate locations for is_first: those of the last residue, at least.
local function note(fields, text)
  local first, last = residue_of(text), residue_of(text:sub(-1000):match ".*\n([^\n]+)\n?$" or text)
  fields.recent = first == last and first == fields.recent_place and fields.recent or {}
  fields.recent[#fields.recent + 1], fields.recent_place = text, last
end

-- Returns whether to read an atom. Only the first of alternate locations is read, and of a residue with several kinds
-- only the first kind. Only the current residue, and all atoms with alternate locations, are stored.
local function is_first(fields, line)
  local name, alternate, kind = line:sub(13, 16), line:sub(17, 17), line:sub(18, 20)
  local place, recent = residue_of(line), fields.recent
  if recent and alternate == " " then
    note(fields, line)
    return true
  end
  fields.recent = nil
  for _, text in ipairs(recent or {}) do
    for other in text:gmatch "[^\n]+" do is_first(fields, other) end
  end
  if fields.place ~= place then fields.place, fields.kind, fields.names = place, kind, {} end
  if alternate == " " then
    fields.names[name] = true
    return true
  end
  local kinds, chosen, atom = fields.kinds, fields.chosen, place .. name
  kinds[place] = kinds[place] or fields.kind
  if fields.names[name] or kinds[place] ~= kind then return false end
  chosen[atom] = chosen[atom] or alternate
  return chosen[atom] == alternate
end

-- Returns the name and line of the next record that is needed.
local function next_record(source)
  for line in function() return source:next() end do
    local name = line:sub(1, 6):match "^%u+"
    if TAKEN[name] then return name, line end
  end
end

local function cosine(degrees)
  return ({ [60] = 0.5, [90] = 0, [120] = -0.5 })[degrees] or glint.cos(math.rad(degrees))
end

-- Returns the cell and box of a CRYST1 record; nil for 1 1 1, as in files that are no crystal.
local function cell_of(source, line)
  local v, is_whole, is_read = {}, true, true
  for i, columns in ipairs { { 7, 15 }, { 16, 24 }, { 25, 33 }, { 34, 40 }, { 41, 47 }, { 48, 54 } } do
    local text = line:sub(columns[1], columns[2])
    v[i] = i > 3 and not text:find "%S" and 90 or lines.number(text) or 0
    is_read = is_read and (not text:find "%S" or lines.number(text))
    is_whole = is_whole and v[i] > 0 and v[i] < (i > 3 and 180 or math.huge)
  end
  local a, b, c = v[1], v[2], v[3]
  if is_read and math.max(a, b, c) <= 1 then return nil end
  local cos_a, cos_b, cos_c = cosine(v[4]), cosine(v[5]), cosine(v[6])
  local sin_c = math.sqrt(1 - cos_c * cos_c)
  local y = (cos_a - cos_b * cos_c) / sin_c
  local square = 1 - cos_b * cos_b - y * y
  if not is_whole or square <= 0 then
    local message = "%s:%d: no cell: six numbers of one expected in CRYST1, got %q"
    glint._warn(message:format(source.path, source.number, line))
    return nil
  end
  local box = { low = { 0, 0, 0 }, size = { a, b * sin_c, c * math.sqrt(square) }, periodic = { true, true, true },
    xy = b * cos_c, xz = c * cos_b, yz = c * y }
  local sides = { { a, 0, 0 }, { box.xy, box.size[2], 0 }, { box.xz, box.yz, box.size[3] } }
  return { origin = box.low, a = sides[1], b = sides[2], c = sides[3] }, box
end

-- Reads the records before a frame's atoms: its model, and its cell or the previous frame's. Puts back the first record
-- that is neither.
local function read_head(source, number, fields)
  local cells = source.cells or {}
  source.cells = cells
  cells[number] = cells[number] or cells[number - 1]
  local name, line = next_record(source)
  while name == "END" or name == "ENDMDL" or name == "CRYST" or name == "MODEL" and not fields.is_model do
    if name == "MODEL" then
      fields.is_model, fields.model = true, source:whole(line:sub(7), "the number of the model", 0)
    elseif name == "CRYST" then
      cells[number] = { cell_of(source, line) }
    elseif fields.is_model then
      break -- no atoms
    end
    name, line = next_record(source)
  end
  if name then source:back(line) end
  fields.cell, fields.box = table.unpack(cells[number] or {}, 1, 2)
  return name
end

local function start(source, number, options)
  local fields = { kinds = {}, chosen = {} }
  local name, line = read_head(source, number, fields), nil
  if not name and number > 1 then return nil end
  if not name then source:fail("an ATOM or HETATM record", nil) end
  local is_model = fields.is_model
  frames.name_columns(fields, COLUMNS, pick)
  fields.places, fields.layout = WHERE, LAYOUT
  source.note = function(text) note(fields, text) end
  return fields, function()
    while true do
      name, line = next_record(source)
      if not name and is_model then source:fail("ENDMDL", nil) end
      if name == "MODEL" then source:fail(is_model and "ENDMDL" or "ATOM, HETATM or END", line) end
      if name ~= "ATOM" and name ~= "HETATM" and name ~= "CRYST" then return nil end
      if line:sub(1, LAST_COLUMN):find("\t", 1, true) then
        source:fail("a record in columns without tabs", line)
      end
      if name == "ATOM" or name == "HETATM" and options.hetatm ~= false then
        local label, x, y, z = read_atom(source, fields, line)
        if label and is_first(fields, line) then return label, x, y, z end
      end
    end
  end
end

--- Iterates over the frames of a file: number, model, and frame:atoms() -> label, x, y, z (angstroms).
---@param path string
---@param options? { hetatm: boolean }  hetatm = false: ATOM records only
function pdb.frames(path, options)
  return frames.each(path, function(source, number) return start(source, number, options or {}) end)
end

--- Returns one frame, from 1. Default 1.
---@param path string
---@param number? integer
---@param options? { hetatm: boolean }
function pdb.frame(path, number, options)
  return frames.pick(path, pdb.frames(path, options), number)
end

--- Returns the frames of a file in any order: film:frame(n), film:length().
---@param path string
---@param options? { hetatm: boolean }
function pdb.film(path, options)
  return frames.film(path, function(source, number) return start(source, number, options or {}) end)
end

return pdb
