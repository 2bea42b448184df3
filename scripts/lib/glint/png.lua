-- Small pictures painted by a script, written as PNG without compression: for glint.texture.
--     local png = require "glint.png"
--     local picture = png.new(64, 32)
--     picture:set(x, y, { 0.5, 0.2, 0.1 })     -- from 0, 0 at the top left; linear, 0 .. 1
--     picture:save "picture.png"
--     local texture = picture:texture()
--     local mask = png.grey(64, 32)            -- one channel
--     mask:set(x, y, 1)
local glint = require "glint"
local png = {}
local picture = {}
picture.__index = picture

--- Makes a black picture.
function png.new(width, height)
  return setmetatable({ width = width, height = height, rows = {} }, picture)
end

--- Makes a black picture of one channel, such as a mask.
function png.grey(width, height)
  return setmetatable({ width = width, height = height, rows = {}, is_grey = true }, picture)
end

-- Returns the sRGB value, IEC 61966-2-1.
local function encode(x)
  x = math.min(math.max(x, 0), 1)
  x = x <= 0.0031308 and 12.92 * x or 1.055 * x ^ (1 / 2.4) - 0.055
  return math.floor(255 * x + 0.5)
end

--- Sets a pixel to a linear colour: a list of three, or a value with x, y and z; in one channel to a number.
function picture:set(x, y, color)
  local row = self.rows[y] or {}
  self.rows[y] = row
  if self.is_grey then
    row[x] = string.char(encode(color))
    return
  end
  row[x] = string.char(encode(color.x or color[1]), encode(color.y or color[2]), encode(color.z or color[3]))
end

local remainders = {} -- remainders of CRC-32, by byte
for byte = 0, 255 do
  local r = byte
  for _ = 1, 8 do r = r & 1 == 1 and 0xedb88320 ~ r >> 1 or r >> 1 end
  remainders[byte] = r
end

local function chunk(kind, data)
  local crc, text = 0xffffffff, kind .. data
  for i = 1, #text do crc = remainders[(crc ~ text:byte(i)) & 255] ~ crc >> 8 end
  return string.pack(">I4", #data) .. text .. string.pack(">I4", crc ~ 0xffffffff)
end

-- Returns a zlib stream of stored blocks.
local function store(data)
  local parts, a, b = { "\x78\x01" }, 1, 0
  for at = 1, #data, 65535 do
    local block = data:sub(at, at + 65534)
    parts[#parts + 1] = string.pack("<BI2I2", at + 65535 > #data and 1 or 0, #block, #block ~ 0xffff) .. block
  end
  for i = 1, #data do
    a = (a + data:byte(i)) % 65521
    b = (b + a) % 65521
  end
  return table.concat(parts) .. string.pack(">I2I2", b, a)
end

--- Writes the picture to a file; raises on failure.
function picture:save(path)
  local lines, black = {}, self.is_grey and "\0" or "\0\0\0"
  for y = 0, self.height - 1 do
    local row = self.rows[y] or {}
    lines[#lines + 1] = "\0"
    for x = 0, self.width - 1 do lines[#lines + 1] = row[x] or black end
  end
  local file = assert(io.open(path, "wb"))
  local head = string.pack(">I4I4BBBBB", self.width, self.height, 8, self.is_grey and 0 or 2, 0, 0, 0)
  assert(file:write("\x89PNG\r\n\x1a\n", chunk("IHDR", head), chunk("sRGB", "\0"),
    chunk("IDAT", store(table.concat(lines))), chunk("IEND", "")))
  assert(file:close())
end

--- Returns the picture as a texture, through a temporary file.
function picture:texture()
  local name = os.tmpname()
  self:save(name .. ".png")
  local texture = glint.texture { file = name .. ".png" }
  os.remove(name)
  os.remove(name .. ".png")
  return texture
end

return png
