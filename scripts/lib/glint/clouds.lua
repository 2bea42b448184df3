-- Point clouds with a header: .ply without faces (text or binary), .pcd (ascii, binary or binary_compressed).
-- glint.points calls this. Columns have the names in the file; red, green and blue are the colour of a point. Points
-- that are not finite, as in the gaps of a scan, are skipped.
local frames, lines = require "glint.frames", require "glint.lines"

local clouds = {}

local BLOCK = 1 << 16 -- bytes read at once
local CHUNK = 1 << 12 -- bytes joined at once
local PLY_TYPES = { char = "b", int8 = "b", uchar = "B", uint8 = "B", short = "h", int16 = "h", ushort = "H",
  uint16 = "H", int = "i4", int32 = "i4", uint = "I4", uint32 = "I4", float = "f", float32 = "f",
  double = "d", float64 = "d" }
local PCD_TYPES = { F4 = "f", F8 = "d", I1 = "b", I2 = "h", I4 = "i4", I8 = "i8", U1 = "B", U2 = "H", U4 = "I4",
  U8 = "I8" }
-- Names that other programs use for the same columns.
local SAME = { x = "x", y = "y", z = "z", r = "red", g = "green", b = "blue", diffuse_red = "red",
  diffuse_green = "green", diffuse_blue = "blue", scalar_radius = "radius" }

local function code_size(code) return ("<" .. code):packsize() end

local function words(line)
  local list = {}
  for word in (line or ""):gmatch "%S+" do list[#list + 1] = word end
  return list
end

local PROBED = 50 -- rows that are examined for the value of full colour

-- Returns the value of full colour: 65535 for 16 bits, and 1 for numbers with fractions; otherwise 255. Then a function
-- that returns the same rows.
local function most_of(code, place, rows)
  if code ~= "f" and code ~= "d" then return code == "H" and 65535 or 255, rows end
  local ahead, at, most, is_whole = {}, 0, 0, true
  for i = 1, PROBED do
    ahead[i] = rows()
    if not ahead[i] then break end
    for _, name in ipairs { "red", "green", "blue" } do
      local v = ahead[i][place[name]]
      if v == v then most, is_whole = math.max(most, v), is_whole and v == math.floor(v) end
    end
  end
  return most > (is_whole and 1 or 16) and 255 or 1, function()
    at = at + 1
    local list = ahead[at]
    ahead[at] = nil
    if list or at <= PROBED then return list end
    return rows()
  end
end

-- ---- Rows ----

-- Returns a function that returns the rows of a text as lists of numbers; nil after the last.
local function text_rows(source, layout)
  local done, width = 0, #layout.codes
  return function()
    if done == layout.count then return nil end
    done = done + 1
    local line = source:next_full()
    local list = words(line)
    while line and #list < width do
      line = source:next_full()
      for _, word in ipairs(words(line)) do list[#list + 1] = word end
    end
    if #list ~= width then
      source:fail(("point %d of %d with %d numbers"):format(done, layout.count, width), line)
    end
    for i, word in ipairs(list) do
      list[i] = tonumber(word) or word:lower():find "nan" and 0 / 0 or source:number_of(word, layout.names[i])
    end
    return list
  end
end

-- Returns such a function for binary data.
local function binary_rows(source, layout)
  if source.path == "-" then error("standard input: a cloud of points as text expected, got a binary one", 0) end
  local file = assert(lines.open_bytes(source.path))
  file:seek("set", (source:tell()) + (layout.skipped or 0))
  local format = layout.order .. table.concat(layout.codes)
  local size, done, block, at = format:packsize(), 0, "", 1
  return function()
    if done == layout.count then
      file:close()
      return nil
    end
    if at + size > #block + 1 then
      block, at = file:read(math.max(BLOCK // size, 1) * size) or "", 1
    end
    done = done + 1
    if #block - at + 1 < size then
      error(("%s: point %d of %d expected, got the end of the file"):format(source.path, done, layout.count), 0)
    end
    local list = { format:unpack(block, at) }
    at = list[#list]
    list[#list] = nil
    return list
  end
end

-- Unpacks `size` bytes from LZF: runs of up to 32 literal bytes, and copies of at most 264 bytes from at most 8192
-- bytes back. nil: the data are invalid.
local function unpack_lzf(packed, size)
  local out, n, at, parts = {}, 0, 1, {}
  while at <= #packed do
    local code = packed:byte(at)
    local length = code >> 5
    at = at + 1
    if length == 0 then
      length = code + 1
      if at + length - 1 > #packed or n + length > size then return nil end
      for i = 0, length - 1 do out[n + 1 + i] = packed:byte(at + i) end
      at = at + length
    else
      if length == 7 then length, at = 7 + (packed:byte(at) or 0), at + 1 end
      length = length + 2
      local from = n - ((code & 31) << 8 | (packed:byte(at) or 0))
      at = at + 1
      if from < 1 or at > #packed + 1 or n + length > size then return nil end
      for i = 0, length - 1 do out[n + 1 + i] = out[from + i] end
    end
    n = n + length
  end
  if n ~= size then return nil end
  for i = 1, n, CHUNK do parts[#parts + 1] = string.char(table.unpack(out, i, math.min(i + CHUNK - 1, n))) end
  return table.concat(parts)
end

-- Returns such a function for LZF data, which have the first field of all points, then the second one, and so on.
local function packed_rows(source, layout)
  local function fail(what) error(("%s: %s"):format(source.path, what), 0) end
  if source.path == "-" then fail "a cloud of points as text expected, got a binary one" end
  local file = assert(lines.open_bytes(source.path))
  file:seek("set", (source:tell()) + (layout.skipped or 0))
  local sizes = file:read(8) or ""
  local packed, size = (#sizes == 8 and sizes or ("\0"):rep(8)):match "^(....)(....)$"
  packed, size = ("<I4"):unpack(packed), ("<I4"):unpack(size)
  local data = file:read(packed) or ""
  file:close()
  if #data < packed then fail(("%d packed bytes expected, got %d"):format(packed, #data)) end
  local starts, width = {}, 0
  for i, code in ipairs(layout.codes) do
    local same = layout.field[i] == layout.field[i - 1]
    starts[i] = same and starts[i - 1] + code_size(code) or width * layout.count
    width = width + code_size(code)
  end
  if size ~= width * layout.count then
    fail(("%d unpacked bytes expected, got %d"):format(width * layout.count, size))
  end
  data = unpack_lzf(data, size)
  if not data then fail "valid LZF data expected" end
  local done = 0
  return function()
    if done == layout.count then return nil end
    local list = {}
    for i, code in ipairs(layout.codes) do
      list[i] = ("<" .. code):unpack(data, starts[i] + done * layout.strides[i] + 1)
    end
    done = done + 1
    return list
  end
end

-- ---- Heads ----

-- Reads the header of a .ply file, after its first line.
local function read_ply(source)
  local layout, element, elements = { names = {}, codes = {} }, nil, 0
  while true do
    local line = source:next()
    local list = words(line)
    if not line then source:fail("end_header", nil) end
    if list[1] == "format" then
      layout.order = ({ ascii = "", binary_little_endian = "<", binary_big_endian = ">" })[list[2]]
      if not layout.order then source:fail("format ascii, binary_little_endian or binary_big_endian", line) end
    elseif list[1] == "element" then
      element, elements = list[2], elements + 1
      if element == "vertex" then
        layout.count = source:whole(list[3], "the number of points", 0)
        if elements > 1 then source:fail("element vertex before others", line) end
      end
    elseif list[1] == "property" and element == "vertex" then
      local code = PLY_TYPES[list[2]]
      if not code or not list[3] then source:fail("property TYPE NAME", line) end
      layout.names[#layout.names + 1] = list[3]
      layout.codes[#layout.codes + 1] = code
    elseif list[1] == "end_header" then
      if not layout.order or not layout.count then source:fail("format and element vertex above end_header", line) end
      return layout
    end
  end
end

-- Reads the header of a .pcd file, from its first line.
local function read_pcd(source)
  local layout, head = { names = {}, codes = {}, field = {}, strides = {} }, {}
  repeat
    local line = source:next_full()
    local list = words(line)
    if not line then source:fail("DATA", nil) end
    head[list[1]:upper()] = list
  until head.DATA
  head.FIELDS = head.FIELDS or head.COLUMNS -- in version .5
  local kind = (head.DATA[2] or ""):lower()
  for _, name in ipairs { "FIELDS", "SIZE", "TYPE" } do
    local list = head[name]
    if not list or #list ~= #head.FIELDS then source:fail(name .. " for each field", "DATA") end
  end
  for i = 2, #head.FIELDS do
    local code = PCD_TYPES[head.TYPE[i]:upper() .. head.SIZE[i]]
    local count = source:whole(head.COUNT and head.COUNT[i] or "1", "COUNT of a field", 0)
    if not code then source:fail("TYPE F, I or U and SIZE 1, 2, 4 or 8 of a field", head.TYPE[i] .. head.SIZE[i]) end
    for k = 1, count do
      layout.names[#layout.names + 1] = count == 1 and head.FIELDS[i] or head.FIELDS[i] .. "_" .. k
      layout.codes[#layout.codes + 1] = code
      layout.field[#layout.codes], layout.strides[#layout.codes] = i, count * code_size(code)
    end
  end
  if kind ~= "ascii" and kind ~= "binary" and kind ~= "binary_compressed" then
    source:fail("DATA ascii, binary or binary_compressed", kind)
  end
  layout.is_packed = kind == "binary_compressed"
  layout.order = kind == "ascii" and "" or "<"
  local function whole(name, default) return source:whole(head[name] and head[name][2] or default, name, 0) end
  layout.count = head.POINTS and whole "POINTS" or whole "WIDTH" * whole("HEIGHT", "1")
  return layout
end

-- ---- Frames ----

-- Adds red, green and blue from a field that packs all three, as the bits of a float or as a whole number.
local function unpack_color(layout, place)
  local rgb, n = place.rgb or place.rgba, #layout.names
  if not rgb then return nil end
  for i, name in ipairs { "red", "green", "blue" } do layout.names[n + i] = name end
  local is_float = layout.codes[rgb] == "f" or layout.codes[rgb] == "d"
  return function(list)
    local code = list[rgb]
    if code ~= code then -- NaN: as text, some colours' bits are not a number
      list[n + 1], list[n + 2], list[n + 3] = code, code, code
      return
    end
    if layout.codes[rgb] == "f" then code = ("<f"):unpack(("<f"):pack(code)) end -- the digits of a text may be few
    local whole = math.tointeger(code) -- as bits of a float, red, green and blue are below 4e-38
    code = whole and whole & 0xffffffff or is_float and ("<I4"):unpack(("<f"):pack(code)) or 0
    list[n + 1], list[n + 2], list[n + 3] = code >> 16 & 255, code >> 8 & 255, code & 255
  end
end

local function pick(wanted, place)
  return function(list)
    local found = {}
    for i, name in ipairs(wanted) do found[i] = list[place[name]] end
    return table.unpack(found, 1, #wanted)
  end
end

--- Begins the frame of a file whose first line has been read. Returns fields and a function that returns a point, as in
--- the readers of glint.frames; nil if the line does not begin such a file.
---@param source table
---@param line string
function clouds.start(source, line)
  local layout
  if line:find "^ply%s*$" then
    layout = read_ply(source)
  elseif line:find "^#%s*%.PCD" or line:find "^VERSION%s" then
    if line:find "^VERSION" then source:back(line) end
    layout = read_pcd(source)
  else
    return nil
  end
  local place = {}
  for i, name in ipairs(layout.names) do
    layout.names[i] = SAME[name:lower()] or name
    place[layout.names[i]] = i
  end
  for _, name in ipairs { "x", "y", "z" } do
    if not place[name] then source:fail(("a property or field %s of points"):format(name), line) end
  end
  local rows = (layout.order == "" and text_rows or layout.is_packed and packed_rows or binary_rows)(source, layout)
  local color = unpack_color(layout, place)
  local fields = { count = layout.count }
  frames.name_columns(fields, layout.names, function(wanted) return pick(wanted, fields.places) end)
  place = fields.places
  if place.red and place.green and place.blue then
    local most = 255
    if not color then most, rows = most_of(layout.codes[place.red], place, rows) end
    fields.color = { most = most }
  end
  return fields, function()
    for list in rows do
      if color then color(list) end
      fields.line = list
      local x, y, z = list[place.x], list[place.y], list[place.z]
      if x - x == 0 and y - y == 0 and z - z == 0 then
        return "point", x, y, z, place.radius and list[place.radius] or nil
      end
    end
  end
end

return clouds
