-- Surfaces: materials with the additions of the dialect's variants, and pictures and reliefs on them. A record stores
-- them in plain fields; surface.shade makes the glint.material of a record at one place of a shape.
local check = require "gr.check"
local files = require "gr.files"
local glint = require "glint"
local normal_map = require "gr.normal_map"
local options = require "gr.options"
check.own_source()
local surface = {}

local pcall, select, setmetatable, tonumber, tostring, type = pcall, select, setmetatable, tonumber, tostring, type
local abs, concat, max, min, unpack = math.abs, table.concat, math.max, math.min, table.unpack

local INDEX_MAX = 4 -- larger numbers are no index of refraction: variants use them for opaque materials
local HEIGHT = 0.05 -- height of a relief's white above its black, relative to the shape's size before its transforms

-- ---- Pictures ----

local photos = {} -- by their names in the scene

-- Reads a picture whose pixel values are linear colours, as in the dialect's own pictures.
local function read_photo(call, name)
  name = check.text(call, "file", name)
  if photos[name] then return photos[name] end
  local found, places = files.find(name)
  if not found then check.raise("gr.%s: '%s': no such file; looked for %s", call, name, places) end
  local good, photo = pcall(glint.texture, { file = found, transfer = "linear" })
  if not good then check.raise("gr.%s: %s", call, (photo:gsub("^[^:]*:%d+: ", ""):gsub("^texture: ", ""))) end
  photos[name] = photo
  return photo
end

--- Makes a picture on a surface, repeated `across` and `down`.
function surface.picture(call, name, across, down)
  local photo = read_photo(call, name)
  across = check.number(call, "across", across == nil and 1 or across)
  down = check.number(call, "down", down == nil and across or down)
  local wide, high = abs(across), abs(down)
  local pattern = glint.pattern(function(_, s)
    return photo(s.uv.u * across, s.uv.v * down, s.uv_footprint * wide, s.uv_footprint * high)
  end)
  return { photo = photo, across = across, down = down, wide = wide, high = high, pattern = pattern }
end

--- Makes a normal map whose normals lean `strength` times as far, repeated `across` and `down`.
function surface.normals(call, name, strength, across, down)
  strength = check.above(call, "strength", strength == nil and 1 or strength, 0)
  local picture = surface.picture(call, name, across, down)
  return { photo = picture.photo, picture = picture, strength = strength }
end

--- Makes a relief from the brightness of a picture.
function surface.relief(call, name, height)
  return { photo = read_photo(call, name), height = check.number(call, "height", height == nil and HEIGHT or height) }
end

-- ---- Additions to the course's materials ----

local function leave_out(call, values, why)
  local texts = {}
  for i = 1, #values do texts[i] = check.spelling(values[i]) end
  check.tell(call, "gr.%s: left out after the shininess: %s; %s", call, concat(texts, ", "), why)
end

local function is_share(x) return x >= 0 and x <= 1 end
local function is_index(x) return x > 1 and x <= INDEX_MAX end

-- Makes glass from only its index, which determines its reflectance.
local function make_glass(record, index) record.transmission, record.ior, record.fresnel = 1, index, true end

-- One number: a reflectivity or an index of refraction. In some scenes every opaque material has a 1.
local readers = {
  function(record, a)
    local kd = record.kd
    if a == 1 and max(kd[1], kd[2], kd[3]) > 0 then
      return "1 means a mirror only where kd is {0, 0, 0}; elsewhere it may mean that the material is opaque"
    end
    if is_share(a) then record.mirror = a
    elseif is_index(a) then make_glass(record, a)
    else return "a reflectivity 0 .. 1 or an index up to 4 expected" end
  end,
  function(record, a, b)
    if is_share(a) and is_share(b) then
      record.mirror, record.transmission, record.ior = a, b, 1
    elseif is_share(a) and is_index(b) then
      make_glass(record, b)
      if a > 0 then return "the refractive index determines how much glass reflects", { a } end
    elseif is_index(a) and is_share(b) then
      record.transmission, record.ior = b, a
    else
      return "expected a reflectivity and a transparency 0 .. 1, or an index up to 4"
    end
  end,
  function(record, a, b, c)
    if not (is_share(a) and is_share(b) and (is_index(c) or c == 1 or b == 0 and c == 0)) then
      return "a reflectivity, a transparency and an index expected"
    end
    record.mirror, record.transmission, record.ior = a, b, c == 0 and 1 or c
  end,
  function(record, gloss, a, b, c) -- the blur of the mirror comes first
    record.mirror, record.transmission, record.ior = a, b, c
    if gloss ~= 0 then return "glint's mirrors are always sharp", { gloss } end
  end,
}

local function read_numbers(record, call, numbers)
  while numbers[#numbers] == 0 do numbers[#numbers] = nil end -- trailing zeros have no effect
  if #numbers == 0 then return end
  local has_gloss = #numbers == 4 and is_share(numbers[2]) and is_share(numbers[3]) and is_index(numbers[4])
  local count = has_gloss and 4 or min(#numbers, 3)
  local why, which = readers[count](record, unpack(numbers, 1, count))
  if why then return leave_out(call, which or numbers, why) end
  if #numbers > count then leave_out(call, { unpack(numbers, count + 1) }, "only three numbers are used") end
end

-- Reads numbers and names of pictures: the first name that is not "" is the picture on the surface.
local function read_more(record, call, ...)
  local numbers, others = {}, {}
  for i = 1, select("#", ...) do
    local value = select(i, ...)
    if type(value) == "number" then
      numbers[#numbers + 1] = value
    elseif type(value) == "string" and value:find "%.%a+$" and not record.picture then
      record.picture = surface.picture(call, value)
    elseif i == 1 and type(value) == "table" and #value == 3 then
      local mirror = check.vector(call, "reflectivity", value, 3, 0)
      if max(unpack(mirror)) > 1 then
        leave_out(call, { value }, "a reflectivity of three numbers 0 .. 1 expected")
      else
        record.mirror = mirror
      end
    elseif value and value ~= "" then
      others[#others + 1] = value
    end
  end
  read_numbers(record, call, numbers)
  if #others > 0 then leave_out(call, others, "expected numbers and the name of a picture") end
end

-- Returns the model of the highlight. An exponent of 0 makes it 1 wherever light arrives, as n.h > 0 there, while r.v
-- is not above 0 everywhere.
local function model_of(shininess)
  return (options.specular == "blinn" or shininess == 0) and "blinn_phong" or "phong"
end

--- Makes a record from the course's three arguments, and those after them.
function surface.record(call, kd, ks, shininess, ...)
  local record = { kd = check.vector(call, "kd", kd, 3, 0), ks = check.vector(call, "ks", ks, 3, 0) }
  record.shininess = check.at_least(call, "shininess", shininess, 0)
  record.model = model_of(record.shininess)
  read_more(record, call, ...)
  return record
end

--- Makes a record with a picture instead of kd.
function surface.pictured(call, file, ks, shininess, ...)
  local record = surface.record(call, { 1, 1, 1 }, ks, shininess, ...)
  record.picture = surface.picture(call, file)
  return record
end

--- Makes a surface with only a picture.
function surface.plain(picture) return { kd = { 1, 1, 1 }, ks = { 0, 0, 0 }, shininess = 0, picture = picture } end

function surface.mirror(record, call, share) record.mirror = check.at_least(call, "reflectivity", share, 0) end

function surface.glass(record, call, index)
  index = check.number(call, "index", index)
  if index <= 0 then check.refuse(call, "index", "number > 0", index) end
  make_glass(record, index)
end

--- Sets the opacity, the share of the light from behind that the surface hides; index: index of refraction.
function surface.hide(record, call, share, index)
  record.opacity = check.at_least(call, "opacity", share, 0)
  if record.opacity > 1 then check.refuse(call, "opacity", "number 0 .. 1", share) end
  record.ior = index == nil and 1 or check.above(call, "index", index, 0)
  record.transmission, record.fresnel = 1 - record.opacity, nil
end

--- Makes two colours, mixed by noise.
function surface.noisy(call, a, b, ks, shininess, ...)
  local record = surface.record(call, a, ks, shininess)
  local other = check.vector(call, "the other colour", b, 3, 0)
  record.picture = { pattern = glint.pattern(function(p)
    local sum = glint.noise(p * 4) + glint.noise(p * 8) / 2 + glint.noise(p * 16) / 4
    return glint.mix(record.kd, other, glint.clamp(0.5 + 0.5 * sum, 0, 1))
  end) }
  if select("#", ...) > 0 then leave_out(call, { ... }, "glint uses its own noise") end
  return record
end

-- ---- glint materials ----

local function bump_of(relief, picture, scale)
  local photo, height = relief.photo, relief.height * scale / 3
  local across, down, wide, high = 1, 1, 1, 1
  if picture and picture.across then
    across, down, wide, high = picture.across, picture.down, picture.wide, picture.high
  end
  return glint.pattern(function(_, s)
    local c = photo(s.uv.u * across, s.uv.v * down, s.uv_footprint * wide, s.uv_footprint * high)
    return height * (c.r + c.g + c.b)
  end)
end

local function is_above_0(share)
  if type(share) == "table" then return max(share[1], share[2], share[3]) > 0 end
  return (share or 0) > 0
end

-- Returns the diffuse reflectance. Grains darken it: at most to 0, on average by half.
local function diffuse_of(record, picture, grain)
  local color, share = picture and picture.pattern or record.kd, record.opacity or 1
  if not grain and share == 1 then return color end
  return glint.pattern(function(p, s)
    local base = share * (picture and color(p, s) or glint.vector(color))
    if not grain then return base end
    return base * glint.clamp(0.5 + 0.5 * (glint.noise(p * 4) + glint.noise(p * 8) / 2 + glint.noise(p * 16) / 4), 0, 1)
  end)
end

local function make(record, picture, grain, bump)
  local fields = { diffuse = diffuse_of(record, picture, grain), model = "lambert" }
  if max(record.ks[1], record.ks[2], record.ks[3]) > 0 then
    fields.model = record.model
    fields.specular, fields.shininess = glint.vector(record.ks) * (record.opacity or 1), record.shininess
  end
  if is_above_0(record.mirror) then fields.mirror = record.mirror end
  if is_above_0(record.transmission) then fields.transmission, fields.ior = record.transmission, record.ior end
  fields.fresnel, fields.bump = record.fresnel, bump
  return glint.material(fields)
end

-- Returns the mean factor by which a map lengthens vectors.
local function scale_of(map)
  local m, n = {}, 0
  for number in tostring(map):gmatch "[-+%w.]+" do
    if tonumber(number) then
      n = n + 1
      m[n] = tonumber(number)
    end
  end
  local determinant = m[1] * (m[6] * m[11] - m[7] * m[10]) - m[2] * (m[5] * m[11] - m[7] * m[9])
    + m[3] * (m[5] * m[10] - m[6] * m[9])
  return abs(determinant) ^ (1 / 3)
end

local kept = setmetatable({}, { __mode = "k" }) -- materials, by record and by the layers of the shape
local NONE = {}

local function part(all, key)
  all[key] = all[key] or {}
  return all[key]
end

-- Returns the key and the maker of a bump: with normals it depends on shape and map, with a relief on its size.
local function bump_on(relief, picture, node, map)
  local normals = node.normals
  if normals then return tostring(map), function() return normal_map.bump(normals, node, map) end end
  local scale = relief and scale_of(map) * (node.size or 1) or 0
  return scale, function() return relief and bump_of(relief, picture, scale) end
end

--- Returns the glint.material of a record on a node's shape, with the layers of only this shape, at its place.
-- bare: the shape has no coordinates for pictures and reliefs.
function surface.shade(record, node, map, bare)
  local picture, relief = node.picture or record.picture, node.relief or record.relief
  if bare then picture, relief = picture and picture.photo == nil and picture or nil, nil end
  local key, bump = bump_on(relief, picture, node, map)
  local all = part(part(kept, record), picture or NONE)
  local relieved = part(part(all, relief or NONE), node.normals or NONE)
  local made = part(part(relieved, node.normals and node or NONE), node.grain or NONE)
  made[key] = made[key] or make(record, picture, node.grain, bump())
  return made[key]
end

--- Call it after changing a record's fields.
function surface.changed(record) kept[record] = nil end

return surface
