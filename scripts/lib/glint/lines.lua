-- The lines of a text file one at a time, with errors that name the line: all readers of scripts/lib/glint use it.
--     local source = require "glint.lines".open(path)
--     for line in function() return source:next() end do ... end
-- An error reads FILE:LINE: WHAT expected, got WHAT. Memory: the current line and 64 KiB.
local glint = require "glint"
local lines = {}

local source = {}
source.__index = source

local LONGEST = 40 -- characters of a line shown in an error
local LINE_MAX = 1 << 20 -- bytes
local BLOCK = 1 << 20 -- bytes read at once
local AHEAD = 64 -- lines that are read in bulk after a line that was refused; then four times as many, and so on

-- Formats of other programs that no reader here accepts: by a file's extension, and by its first bytes.
local ENDINGS = {
  cif = "CIF", mmcif = "mmCIF", bcif = "BinaryCIF", mmtf = "MMTF", mol2 = "Tripos MOL2", sdf = "SDF",
  mol = "an MDL molfile", gro = "a GROMACS structure", g96 = "a GROMOS structure", cube = "a Gaussian cube",
  crd = "a CHARMM or AMBER structure",
  dcd = "a DCD trajectory", xtc = "a GROMACS trajectory", trr = "a GROMACS trajectory", nc = "NetCDF", cdf = "NetCDF",
  h5 = "HDF5", hdf5 = "HDF5", psf = "a CHARMM topology", las = "LAS", laz = "LAZ", e57 = "E57", ptx = "Leica PTX",
  obj = "a Wavefront mesh (glint.mesh)", stl = "an STL mesh (glint.mesh)", glb = "glTF", gltf = "glTF", off = "OFF",
  ["3mf"] = "3MF", fbx = "FBX", bz2 = "compressed by bzip2", xz = "compressed by xz",
  zip = "a zip archive", xlsx = "an Excel workbook",
}
local BEGINNINGS = {
  { "\xff\xfe", "UTF-16, not UTF-8" }, { "\xfe\xff", "UTF-16, not UTF-8" }, { "\x1f\x8b", "compressed by gzip" },
  { "PK\3\4", ENDINGS.zip }, { "data_", ENDINGS.cif }, { "glTF", "glTF" }, { "\x89HDF", "HDF5" }, { "CDF\1", "NetCDF" },
}
local READS = ".xyz .pdb .nff .csv .tsv .txt .pts .pcd .ply and LAMMPS dumps"

local function refuse_foreign(path, kind)
  error(("%s: is %s; glint reads %s"):format(path, kind, READS), 0)
end

local function shown(text)
  if text == nil then return "the end of the file" end
  return #text > LONGEST and ("%q..."):format(text:sub(1, LONGEST)) or ("%q"):format(text)
end

-- Raises if a path is a device, a pipe or a folder, which may have no end.
local function check_kind(path)
  local kind = path ~= "-" and glint._other_kind(path)
  if kind then error(("%s: a file expected, got a %s"):format(path, kind), 0) end
end

-- Compressed files: their first bytes, and the method.
local PACKED = { { "\x1f\x8b", "gzip" }, { "\x28\xb5\x2f\xfd", "zstd" } }

--- Opens a file for reading, also one compressed by gzip or zstd; nil and a message if it cannot be opened.
---@param path string
function lines.open_bytes(path)
  local file, message = io.open(path, "rb")
  if not file then return nil, message end
  local beginning = file:read(4) or ""
  for _, packed in ipairs(PACKED) do
    if beginning:find(packed[1], 1, true) == 1 then
      file:close()
      return glint._unpack(path, packed[2])
    end
  end
  file:seek("set", 0)
  return file
end

-- Opens a file; looks next to the script if it does not exist. Also returns the path.
local function open_file(path)
  local file, message = lines.open_bytes(path)
  local folder = type(arg) == "table" and type(arg[0]) == "string" and arg[0]:match "^.*/"
  if file or path:find "^/" or not folder then return file, file and path or message end
  check_kind(folder .. path)
  local other = lines.open_bytes(folder .. path)
  return other, other and folder .. path or message
end

--- Returns the ending of a path in small letters, "" if it has none; of a.xyz.gz and a.xyz.zst it is "xyz".
---@param path string
---@return string
function lines.ending(path)
  path = path:lower()
  return (path:match "^(.*)%.gz$" or path:match "^(.*)%.zst$" or path):match "%.(%w+)$" or ""
end

--- Opens a file, or standard input if the path is "-". Raises if it cannot be read, immediately for a device, a pipe or
--- a folder.
---@param path string
function lines.open(path)
  local foreign = ENDINGS[lines.ending(path)]
  check_kind(path)
  local file, found = io.stdin, path
  if path ~= "-" then file, found = open_file(path) end
  if not file then error(found, 0) end
  path = found
  if foreign then refuse_foreign(path, foreign) end
  return setmetatable({ path = path, number = 0, file = file, block = "", at = 1, base = 0, line_at = 0,
    ahead = AHEAD }, source)
end

-- Returns the block with lines that end in LF or CRLF. Carriage returns without an LF after them become line ends, and
-- several before one LF become one line end. All other bytes stay.
local function end_lines(block)
  local at = 0
  repeat at = block:find("\r", at + 1, true) until not at or block:byte(at + 1) ~= 10
  if not at or at == #block then return block end
  return (block:gsub("(\r+)()", function(run, after)
    return block:byte(after) == 10 and (" "):rep(#run - 1) .. "\r" or ("\n"):rep(#run)
  end))
end

-- Returns the next block; nil after the last. It ends in a carriage return only at the end of the file.
local function read_block(self)
  local block
  repeat
    local more, message = self.file:read(BLOCK)
    if message then error(("%s: %s"):format(self.path, message), 0) end
    block = more and (block or "") .. more or block
  until not more or more:byte(-1) ~= 13
  return block and end_lines(block)
end

-- Skips a byte order mark at the beginning of the file, and refuses files that are not text or have another format.
local function begin_file(self)
  if self.block:sub(1, 3) == "\xef\xbb\xbf" then self.at = 4 end
  for _, beginning in ipairs(BEGINNINGS) do
    if self.block:find(beginning[1], self.at, true) == self.at then refuse_foreign(self.path, beginning[2]) end
  end
end

-- Returns the end of the current line, after extending the block to contain it. At the end of the file: its end.
local function line_end(self)
  while self.file do
    local rest = self.block:sub(self.at)
    if #rest > LINE_MAX then
      self.number = self.number + 1
      self:fail(("a line of at most %d bytes"):format(LINE_MAX), "a longer line")
    end
    local more = read_block(self)
    if not more then self:close() end
    self.base = self.base + self.at - 1
    self.block, self.at = rest .. (more or ""), 1
    if self.base == 0 and self.number == 0 and rest == "" then begin_file(self) end
    local to = self.block:find("\n", #rest + 1, true)
    if to then return to end
  end
  return #self.block + 1
end

--- Returns the next line without its end (LF, CRLF or CR), nil after the last.
function source:next()
  local to = self.block:find("\n", self.at, true) or line_end(self)
  if not self.file and self.at > #self.block then return nil end
  local line = self.block:sub(self.at, to - 1)
  self.line_at = self.base + self.at - 1
  self.at, self.number = to + 1, self.number + 1
  return line:byte(-1) == 13 and line:sub(1, -2) or line
end

--- Returns the next line that is neither blank nor a comment (#), nil after the last.
function source:next_full()
  for line in function() return self:next() end do
    if line:find "%S" and not line:find "^%s*#" then return line end
  end
end

--- Puts the last line back: the next call of next() returns it again.
function source:back()
  self.at = self.line_at - self.base + 1
  self.number = self.number - 1
end

--- Reads up to `most` rows with a reader of glint._row_reader. Stops before a line that the reader does not accept;
--- next() returns that line. Calls rows(n, ...) for every block of n rows, with the reader's arrays; if it returns
--- false, the block is left to next().
---@param reader userdata
---@param most integer
---@param rows function
---@return integer count
---@return boolean? left  rows returned false
function source:rows(reader, most, rows)
  local total, is_refused = 0, false
  local function take(at, n, passed, refused, ...)
    is_refused = refused
    if n > 0 and rows(n, ...) == false then return true end
    if n > 0 and self.note then self.note(self.block:sub(self.at, at - 1)) end
    self.at, self.number, total = at, self.number + passed, total + n
    self.ahead = refused and AHEAD or math.min(4 * self.ahead, BLOCK)
  end
  while total < most and not is_refused do
    local wanted = math.min(most - total, self.ahead)
    if take(reader:read(self.block, math.min(self.at, #self.block + 1), wanted)) then return total, true end
    if not is_refused and not self.block:find("\n", self.at, true) then
      if not self.file then break end
      line_end(self)
    end
  end
  return total
end

--- Raises an error at the last line read, or after it when `got` is nil: the file ended.
---@param expected string
---@param got string?
function source:fail(expected, got)
  error(("%s:%d: %s expected, got %s"):format(self.path, self.number + (got and 0 or 1), expected, shown(got)), 0)
end

--- Returns the number that a text spells in decimal, also with Fortran's exponents: 1.5D+03, 1.5-103. nil: none.
---@param text string
function lines.number(text)
  if text:find "[xX]" then return nil end
  return tonumber(text) or tonumber((text:gsub("^(%s*[+-]?[%d.]+)[dD]?([+-]?%d+%s*)$", "%1e%2")))
end

--- Returns a field as a number if it is one, otherwise as text.
---@param text string
function lines.value(text)
  return tonumber(text) or text:find(".", 1, true) and lines.number(text) or text
end

--- Returns the finite decimal number that a text spells. Otherwise raises an error that names `what` was expected.
---@param text string?
---@param what string
---@return number
function source:number_of(text, what)
  local value = text and lines.number(text)
  if not value or value - value ~= 0 then
    self:fail(what .. " (a finite number)", text or "nothing")
  end
  return value
end

--- Returns the whole number >= `least` that a text spells. Otherwise raises an error that names `what` was expected.
---@param text string?
---@param what string
---@param least integer
---@return integer
function source:whole(text, what, least)
  local value = text and text:match "^%s*[+-]?%d+%s*$" and math.tointeger(tonumber(text))
  if not value or value < least then
    self:fail(("%s (a whole number >= %d)"):format(what, least), text or "nothing")
  end
  return value
end

--- Returns the position of the next line: its offset in the file, bytes, and the number of lines before it.
---@return integer place
---@return integer number
function source:tell()
  return self.base + self.at - 1, self.number
end

--- Continues from a position of tell(). The file may have been read to its end, but cannot be standard input.
---@param place integer
---@param number integer
function source:go(place, number)
  if self.path == "-" then error("standard input can be read only once: a file, or a later frame expected", 0) end
  if not self.file then self.file = lines.open(self.path).file end
  self.file:seek("set", place)
  self.base, self.number, self.block, self.at = place, number, "", 1
end

--- Closes the file before its end.
function source:close()
  if self.file and self.file ~= io.stdin then self.file:close() end
  self.base = self.base + self.at - 1
  self.file, self.block, self.at = nil, "", 1
end

return lines
