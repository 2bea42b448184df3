-- PDB: the ATOM and HETATM records of the Protein Data Bank's format 3.3, by columns. Each MODEL is a frame.
--     for label, x, y, z in pdb.frame "1crn.pdb":atoms() do ... end
-- The element is that of columns 77-78, and where these are empty that of the atom's name (columns 13-16). Of atoms at
-- alternate locations the first (blank or A, column 17) is taken. Other records are passed over. The other
-- fields are there by name, frame:atoms("chain", "bfactor"): serial, name, resname, chain, resseq, occupancy, bfactor,
-- element, charge.
local elements = require "glint.elements"
local frames = require "glint.frames"

local pdb = {}

local TAKEN = { ATOM = true, HETATM = true, MODEL = true, ENDMDL = true, END = true }
local LAST_COLUMN = 54 -- of z

-- Names are set so that the element's symbol ends in column 14: " CA " is a carbon, "CA  " calcium. Names of four
-- letters ("HG11") begin in column 13 and are hydrogens.
local function element_of(name)
  local two = name:sub(1, 2)
  if two:find "^%a%a" and not name:find "^H%w%w%w$" and elements.symbol(two) then return two end
  return name:match "%a"
end

local COLUMNS = { "serial", "name", "resname", "chain", "resseq", "occupancy", "bfactor", "element", "charge" }
local WHERE = { serial = { 7, 11 }, name = { 13, 16 }, resname = { 18, 20 }, chain = { 22, 22 }, resseq = { 23, 26 },
  occupancy = { 55, 60 }, bfactor = { 61, 66 }, element = { 77, 78 }, charge = { 79, 80 } }

-- A function that takes the wanted fields out of a record, without the blanks around them.
local function pick(wanted)
  return function(line)
    local found = {}
    for i, name in ipairs(wanted) do
      local text = line:sub(WHERE[name][1], WHERE[name][2]):match "^%s*(.-)%s*$"
      found[i] = tonumber(text) or text
    end
    return table.unpack(found, 1, #wanted)
  end
end

local function read_atom(source, fields, line)
  fields.line = line
  if #line < LAST_COLUMN then source:fail("a record of at least 54 columns (z is in 47-54)", line) end
  local label = line:sub(77, 78):match "%a+" or element_of(line:sub(13, 16))
  if not label then source:fail("an element in columns 77-78 or an atom's name in 13-16", line) end
  return label, source:number_of(line:sub(31, 38), "x, columns 31-38,"),
    source:number_of(line:sub(39, 46), "y, columns 39-46,"), source:number_of(line:sub(47, 54), "z, columns 47-54,")
end

-- The next record that counts: its name and line.
local function next_record(source)
  for line in function() return source:next() end do
    local name = line:sub(1, 6):match "^%u+"
    if TAKEN[name] then return name, line end
  end
end

local function start(source, number, options)
  local name, line = next_record(source)
  while name == "END" or name == "ENDMDL" do name, line = next_record(source) end
  if not name and number > 1 then return nil end
  if not name then source:fail("an ATOM or HETATM record", nil) end
  local is_model = name == "MODEL"
  if not is_model then source:back(line) end
  local fields = { model = is_model and source:whole(line:sub(7), "the number of the model", 0) or nil }
  frames.name_columns(fields, COLUMNS, pick)
  return fields, function()
    while true do
      name, line = next_record(source)
      if not name and is_model then source:fail("ENDMDL", nil) end
      if name == "MODEL" then source:fail(is_model and "ENDMDL" or "ATOM, HETATM or END", line) end
      if name ~= "ATOM" and name ~= "HETATM" then return nil end
      local alternate = line:sub(17, 17)
      if (name == "ATOM" or options.hetatm ~= false) and (alternate == " " or alternate == "A" or alternate == "") then
        return read_atom(source, fields, line)
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

--- One frame, from 1. Default 1.
---@param path string
---@param number? integer
---@param options? { hetatm: boolean }
function pdb.frame(path, number, options)
  return frames.pick(path, pdb.frames(path, options), number)
end

--- The frames of a file in any order: film:frame(n), film:length().
---@param path string
---@param options? { hetatm: boolean }
function pdb.film(path, options)
  return frames.film(path, function(source, number) return start(source, number, options or {}) end)
end

return pdb
