-- Pictures in OpenEXR files as textures: pictures that glint wrote, and files made here byte by byte with every kind of channel, tile and window.
local tally = dofile "tests/lua/tally.lua"
local check, near = tally.check, tally.near
local glint = require "glint"

local tests = {}
local name = os.tmpname()

local function write(bytes)
  local file <close> = assert(io.open(name .. ".exr", "wb"))
  file:write(bytes)
  return name .. ".exr"
end

local function texture(bytes) return glint.texture { file = write(bytes) } end

-- A picture that glint wrote, whole and damaged.
function tests.openexr_pictures()
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } },
    background = glint.pattern(function(_, s) return { s.uv.u, 9 * s.uv.v, 0.25 } end) }
  local image = scene:render { width = 40, height = 20, output = "none" }
  local good, message = pcall(image.save, image, name .. ".exr")
  if not good then
    check(tostring(message):find("OpenEXR", 1, true), "without the library: %s", message)
    return
  end
  local again = glint.texture { file = name .. ".exr" }
  for y = 0, 19 do
    for x = 0, 39 do
      local color = again:evaluate { uv = { (x + 0.5) / 40, 1 - (y + 0.5) / 20 } }
      local r, g, b = image:pixel(x, y)
      near(color.x, r, 1e-6, "red of an .exr")
      near(color.y, g, 1e-5, "green of an .exr")
      near(color.z, b, 0, "blue of an .exr")
    end
  end
  local file <close> = assert(io.open(name .. ".exr", "rb"))
  local whole = file:read "a"
  for length = 4, #whole - 1, #whole // 40 do
    tally.raises(".exr: not a whole OpenEXR file", texture, whole:sub(1, length))
  end
  for _ = 1, 200 do
    local at = math.random(5, #whole)
    pcall(texture, whole:sub(1, at - 1) .. string.char(math.random(0, 255)) .. whole:sub(at + 1))
  end
end

-- Numbers that half stores exactly, with its bits.
local HALVES <const> = { { 0, 0 }, { 0.25, 0x3400 }, { 1, 0x3c00 }, { 1.5, 0x3e00 }, { 100, 0x5640 }, { 2 ^ -24, 1 } }

local UINT <const>, HALF <const>, FLOAT <const> = 0, 1, 2

-- An uncompressed OpenEXR file. The number of pixel x, y of the data window in channel c, all from 0, is row (c + x + 5 y) of HALVES.
-- channels: names in alphabetical order, or { name, type, sampling }; kind: the type of those that are names
-- tile: size of the tiles; nil: scan lines
-- data, shown: windows { x, y, width, height }; by default 5 x 4 pixels from 3, -2
local function openexr(channels, kind, tile, data, shown)
  data = data or { 3, -2, 5, 4 }
  local function attribute(key, type, bytes) return ("<zzs4"):pack(key, type, bytes) end
  local function box(window)
    return ("<i4i4i4i4"):pack(window[1], window[2], window[1] + window[3] - 1, window[2] + window[4] - 1)
  end
  local list, all, chunks, rest, last = {}, {}, {}, {}, 0
  for c, channel in ipairs(channels) do
    all[c] = type(channel) == "table" and channel or { channel, kind or FLOAT, 1 }
    list[c] = ("<zi4i4i4i4"):pack(all[c][1], all[c][2], 0, all[c][3], all[c][3])
  end
  local head = ("<I4I4"):pack(20000630, tile and 0x202 or 2) .. attribute("channels", "chlist", table.concat(list) .. "\0")
    .. attribute("compression", "compression", "\0") .. attribute("dataWindow", "box2i", box(data))
    .. attribute("displayWindow", "box2i", box(shown or data))
    .. attribute("lineOrder", "lineOrder", "\0") .. attribute("pixelAspectRatio", "float", ("<f"):pack(1))
    .. attribute("screenWindowCenter", "v2f", ("<ff"):pack(0, 0)) .. attribute("screenWindowWidth", "float", ("<f"):pack(1))
    .. (tile and attribute("tiles", "tiledesc", ("<I4I4B"):pack(tile, tile, 0)) or "") .. "\0"
  local wide, high = tile or data[3], tile or 1
  for y0 = 0, data[4] - 1, high do
    for x0 = 0, data[3] - 1, wide do
      local bytes = {}
      for y = y0, math.min(y0 + high, data[4]) - 1 do
        for c, channel in ipairs(all) do
          for x = x0, (y + data[2]) % channel[3] == 0 and math.min(x0 + wide, data[3]) - 1 or -1 do
            local number = HALVES[(c - 1 + x + 5 * y) % #HALVES + 1]
            if (x + data[1]) % channel[3] == 0 then
              bytes[#bytes + 1] = channel[2] == HALF and ("<I2"):pack(number[2]) or channel[2] == FLOAT and ("<f"):pack(number[1])
                or ("<I4"):pack(number[1] // 1 | 0)
            end
          end
        end
      end
      local at = tile and ("<i4i4i4i4"):pack(x0 // tile, y0 // tile, 0, 0) or ("<i4"):pack(y0 + data[2])
      chunks[#chunks + 1] = at .. ("<s4"):pack(table.concat(bytes))
    end
  end
  for k, chunk in ipairs(chunks) do
    rest[k] = ("<I8"):pack(#head + 8 * #chunks + last)
    last = last + #chunk
  end
  return head .. table.concat(rest) .. table.concat(chunks)
end

-- Checks the texels of a picture. from: the indices from 0 of the channels that red, green and blue come from.
-- whole: the channels hold whole numbers.
local function has_texels(picture, from, what, data, shown, whole)
  data = data or { 0, 0, 5, 4 }
  shown = shown or data
  for i = 0, shown[3] * shown[4] - 1 do
    local x, y = i % shown[3], i // shown[3]
    local color = picture:evaluate { uv = { (x + 0.5) / shown[3], 1 - (y + 0.5) / shown[4] } }
    x, y = x + shown[1] - data[1], y + shown[2] - data[2]
    local inside = x >= 0 and y >= 0 and x < data[3] and y < data[4]
    for c, value in ipairs { color.x, color.y, color.z } do
      local want = inside and HALVES[(from[c] + x + 5 * y) % #HALVES + 1][1] or 0
      near(value, whole and want // 1 or want, 1e-6, ("channel %d of %s at %d, %d"):format(c, what, x, y))
    end
  end
end

-- Scan lines and tiles, every type, layers and luminance. Channels are in alphabetical order, as in every file.
function tests.kinds()
  for _, kind in ipairs { -- the channels that red, green and blue come from
    { { "B", "G", "R" }, 2, 1, 0 }, { { "A", "B", "G", "R", "Z" }, 3, 2, 1 }, { { "Y" }, 0, 0, 0 },
    { { "A", "Y" }, 1, 1, 1 }, { { "A", "Y", "Z" }, 1, 1, 1 }, { { "A", "B", "Y", "Z" }, 2, 2, 2 },
    { { "B", "G", "R", "diffuse.B", "diffuse.G", "diffuse.R" }, 2, 1, 0 }, -- the picture, not its layer
    { { "a.B", "a.G", "a.R", "b.B", "b.G", "b.R" }, 2, 1, 0 }, -- the first of two layers
    { { "a.X", "a.Y", "a.Z", "b.c.B", "b.c.G", "b.c.R" }, 5, 4, 3 },
    { { "P.X", "P.Y", "P.Z", "Y" }, 3, 3, 3 }, { { "P.X", "P.Y", "P.Z", "a.Y" }, 3, 3, 3 }, -- a position is no luminance
  } do
    for way = 0, 11 do
      local tile, type = ({ [0] = nil, 2, 5, 64 })[way // 3], way % 3
      local got = texture(openexr(kind[1], type, tile))
      has_texels(got, { table.unpack(kind, 2) }, ("%s, way %d"):format(table.concat(kind[1], " "), way), nil, nil, type == UINT)
    end
  end
end

-- Channels of one file may have different types.
function tests.types_that_differ()
  local data = { 2, -2, 6, 4 }
  for type = UINT, FLOAT do
    local list = { { "A", UINT, 1 }, { "B", type, 1 }, { "G", HALF, 1 }, { "R", FLOAT, 1 }, { "RY", type, 1 }, { "Z", FLOAT, 1 } }
    local got = texture(openexr(list, nil, nil, data))
    local grey = texture(openexr({ { "A", type, 1 }, { "Y", HALF, 1 }, { "Z", FLOAT, 1 } }, nil, nil, data))
    has_texels(grey, { 1, 1, 1 }, "Y of types that differ", data)
    for i = 0, 23 do
      local color = got:evaluate { uv = { (i % 6 + 0.5) / 6, 1 - (i // 6 + 0.5) / 4 } }
      near(color.y, HALVES[(2 + i % 6 + 5 * (i // 6)) % #HALVES + 1][1], 1e-6, "green of types that differ")
      near(color.x, HALVES[(3 + i % 6 + 5 * (i // 6)) % #HALVES + 1][1], 1e-6, "red of types that differ")
    end
  end
end

-- The data window may be smaller or larger than the picture, or lie beside it.
function tests.windows()
  for _, data in ipairs { { 3, -2, 5, 4 }, { 0, 0, 5, 4 }, { -3, -1, 12, 9 }, { 4, 3, 9, 7 }, { -4, -5, 6, 7 }, { 20, 20, 2, 2 } } do
    for way = 0, 7 do
      local shown, tile = { 0, 0, 7, 5 }, ({ [0] = nil, 2, 5, 64 })[way // 2]
      local got = texture(openexr({ "A", "B", "G", "R" }, way % 2 + HALF, tile, data, shown))
      has_texels(got, { 3, 2, 1 }, ("a window from %d, %d, way %d"):format(data[1], data[2], way), data, shown)
    end
  end
end

function tests.refused()
  for _, case in ipairs {
    { { "R" }, "the channels R, G and B, or Y, expected, got R" }, { { "B", "G" }, "expected, got B, G" },
    { { "a.B", "b.G", "c.R" }, "expected, got a.B, b.G, c.R" }, { { "AB", "AG", "AR" }, "expected, got AB, AG, AR" },
    { { "X", "Y", "Z" }, "expected, got X, Y, Z" }, { { "Z" }, "expected, got Z" },
    { { { "BY", HALF, 2 }, { "RY", HALF, 2 }, { "Y", HALF, 1 } }, "luminance and chroma (Y and RY, BY); glint reads R, G and B, or Y" },
    { { "a.BY", "a.RY", "a.Y" }, "luminance and chroma (a.Y and RY, BY)" },
    { { "B", { "G", HALF, 2 }, "R" }, "channel G: a value for every pixel expected, got one for 2 x 2" },
    { { "B", "G", "R", { "Z", HALF, 2 } }, "channel Z: a value for every pixel expected, got one for 2 x 2" },
    { { { "Y", HALF, 2 } }, "channel Y: a value for every pixel expected, got one for 2 x 2" },
  } do
    tally.raises(case[2], texture, openexr(case[1], FLOAT, nil, { 0, 0, 6, 4 }))
  end
  tally.raises("a picture of at most 33554432 pixels expected, got 40000 x 40000", texture, openexr({ "Y" }, HALF, nil, { 0, 0, 1, 1 }, { 0, 0, 40000, 40000 }))
end

-- Random lists of channels: each file is read or refused.
function tests.any_channels()
  local names, read = { "A", "B", "BY", "G", "R", "RY", "X", "Y", "Z", "a.B", "a.G", "a.R", "b.Y", ("n"):rep(31), "u.V.w" }, 0
  for _ = 1, 2000 // tally.step do
    local channels, tile = {}, math.random(3) == 1 and math.random(1, 9) or nil
    for _, channel in ipairs(names) do
      if math.random(3) == 1 then channels[#channels + 1] = { channel, math.random(0, 2), tile and 1 or math.random(25) // 25 + 1 } end
    end
    local data = { 2 * math.random(-3, 3), 2 * math.random(-3, 3), 2 * math.random(6), 2 * math.random(20) }
    local good, message = pcall(texture, openexr(channels, nil, tile, data, math.random(2) == 1 and { 0, 0, 7, 5 } or nil))
    read = read + (good and 1 or 0)
    check(good or tostring(message):find "OpenEXR" or tostring(message):find "for every pixel expected", "%s", message)
  end
  check(read > 400 // tally.step, "%d files were read", read)
end

local good, message = pcall(texture, openexr { "B", "G", "R" })
if good then
  tally.run(tests)
else
  tally.raises("is OpenEXR, which this build of glint cannot read (libopenexr-dev)", error, message)
end
for _, extension in ipairs { "", ".exr" } do os.remove(name .. extension) end
tally.finish()
