-- Builds one glint.spheres for any number of atoms or points, with one material for each kind.
--     local set = particles.new()
--     set:add_frame(xyz.frame "caffeine.xyz")        -- or set:add("C", x, y, z) by hand
--     scene:add(set:spheres())
-- A label is a kind in options.kinds, an element (color and radius from glint.elements; C13, Fe+3 and CB begin
-- with one), "type1" ... "type999" (a palette, radius 0.5: LAMMPS's reduced units) or "point" (grey, radius 0.5).
-- Other labels in a file, such as ghost atoms, form one kind, "ghost" (pink, radius 0.5), with one warning per
-- file.
--     local set = particles.new { color_by = { column = "speed", map = "viridis" } }     -- also low, high: its range
-- Memory: numbers are in arrays (glint.array), without a table for each sphere. A sphere takes 40 bytes, 48 with
-- color_by, and twice as much while spheres() joins the arrays. The engine then takes some 260 bytes per sphere from
-- the first picture on, and 380 while the index is built.
local glint = require "glint"
local boxes, elements, frames = require "glint.box", require "glint.elements", require "glint.frames"

local particles = {}

local CHUNK = 256 -- spheres packed at once
local LARGE = 100000 -- spheres; larger arrays are collected once the engine has its copy, which Lua does not count
local PALETTE = { "#4e79a7", "#f28e2b", "#59a14f", "#e15759", "#b07aa1", "#edc948", "#76b7b2", "#9c755f" }
local POINT, GHOST = { color = "#b8b8b8", radius = 0.5 }, { color = "#ff1493", radius = 0.5 }

local OPTIONS = { kinds = true, scale = true, radius = true, material = true, format = true, color_by = true }
local EXACT = 4096 -- colours of points, each with a material; more are rounded to 5 bits of red, green and blue
local STEPS = 256 -- colours for a column, each with a material

local warned = {} -- files with unknown labels

local set = {}
set.__index = set

-- Checks the option color_by; raises if something is wrong with it.
local function check_colors(given)
  local names = { column = "string", map = "string", low = "number", high = "number", missing = "string" }
  if type(given) ~= "table" then error("particles.color_by: { column = ... } expected, got " .. tostring(given), 3) end
  for name, value in pairs(given) do
    if not names[name] then
      error(("particles.color_by.%s: no such option; the options are column, map, low, high, missing"):format(name), 3)
    end
    if type(value) ~= names[name] or value ~= value then
      error(("particles.color_by.%s: %s expected, got %s"):format(name, names[name], tostring(value)), 3)
    end
  end
  if not given.column then error("particles.color_by.column: string expected, got nil", 3) end
  if given.low and given.high and given.low >= given.high then
    error(("particles.color_by.high: a number above low (%.14g) expected, got %.14g"):format(given.low, given.high), 3)
  end
  glint.colormap(given.map or "viridis") -- checks the name at once
  return given
end

--- Makes an empty set.
--- The options: kinds, { [label] = { color, radius } } before the known ones (radius 0.5 by default; `material` may
--- replace color); scale, a factor for the kinds' radii (default 1); radius, for every kind instead;
--- material, fields for each material such as { specular = 0.3 }; format, "f64" (default) or "f32", which rounds;
--- color_by, { column, map, low, high, missing }: spheres have the colour of their value in a map of glint.colormap
--- (default viridis) from low to high (default: the lowest and highest value there is), in 256 steps; a missing value
--- (nan, NA, an empty field) has the colour `missing` (default grey, "#808080"); labels give the radii.
---@param options? table
function particles.new(options)
  options = options or {}
  for name in pairs(options) do
    if not OPTIONS[name] then
      error(("particles.%s: no such option; the options are kinds, scale, radius, material, format, color_by")
        :format(name), 2)
    end
  end
  local format = options.format or "f64"
  if format ~= "f32" and format ~= "f64" then
    error(("particles.format: \"f32\" or \"f64\" expected, got %q"):format(format), 2)
  end
  return setmetatable({
    color_by = options.color_by and check_colors(options.color_by), values = {}, pending_values = {},
    lowest = math.huge, highest = -math.huge,
    colors = { count = 0 }, kind_of_place = {},
    count = 0, format = format, options = options, kinds = {}, materials = {}, counts = {},
    low = { math.huge, math.huge, math.huge }, high = { -math.huge, -math.huge, -math.huge },
    data = {}, index = {}, numbers = {}, places = {}, pending = 0,
  }, set)
end

--- Returns the lowest and the highest value of a column in all frames, for one range of colours over a film: low, high
--- = particles.range(xyz.frames "melt.xyz", "c_pe").
---@param list function  iterates over frames, as a reader's frames(path) does
---@param column string
function particles.range(list, column)
  local low, high = math.huge, -math.huge
  local function widen(least, most)
    if least == least then low, high = math.min(low, least), math.max(high, most) end -- not NaN
  end
  for frame in list do
    frame:begin { column }
    frame:bulk({ column }, "number", function(_, _, _, _, _, value)
      value = frames.value_of(value)
      if math.type(value) == nil or math.abs(value) == math.huge then
        frame:fail(("a finite number in the column %q"):format(column), tostring(value))
      end
      widen(value, value)
      return 0
    end, function(_, arrays) widen(arrays[1]:min(), arrays[1]:max()) end)
  end
  if low > high then error("particles.range: frames with atoms that have values expected, got none", 2) end
  return low, high
end

local function known(label)
  local number = math.tointeger(tonumber(label:match "^type([1-9]%d?%d?)$"))
  if number then return label, { color = PALETTE[(number - 1) % #PALETTE + 1], radius = 0.5 } end
  if label == "point" then return label, POINT end
  local symbol = elements.of_label(label)
  if symbol then return symbol, elements[symbol] end
end

-- Returns the kind of a file's unknown labels. Warns once per file.
local function ghost_of(self, frame, label)
  local path = frame.source.path
  if not warned[path] then
    local message = "%s:%d: %q is neither an element nor in the option kinds; such atoms get one colour and radius %g"
    local radius = self.options.radius or (self.options.scale or 1) * GHOST.radius
    glint._warn(message:format(path, frame.source.number, label, radius))
  end
  warned[path] = true
  return "ghost", GHOST
end

-- Finds or makes the kind of a label, with its radius. nil if the label is unknown, except in a frame of a
-- file.
local function kind_of(self, label, frame)
  local options = self.options
  local name, found = label, (options.kinds or {})[label]
  if not found then name, found = known(label) end
  if not found and frame then name, found = ghost_of(self, frame, label) end
  if not found then return nil end
  local kind = self.kinds[name]
  if not kind then
    local fields = { name = name, diffuse = found.color }
    for field, value in pairs(options.material or {}) do fields[field] = value end
    local is_own = options.kinds and found == options.kinds[label] and (found.material or found.color)
    kind = { name = name, fields = fields, material = found.material, is_own = is_own,
      radius = options.radius or (options.scale or 1) * (found.radius or POINT.radius) }
    self.kinds[name] = kind
    self.counts[name] = 0
  end
  self.kinds[label] = kind
  return kind
end

-- Returns the index of a kind's material, which is made when first needed.
local function place_of(self, kind)
  if not kind.place then
    self.materials[#self.materials + 1] = kind.material or glint.material(kind.fields)
    kind.place = #self.materials
  end
  return kind.place
end

-- Returns the index of the material of a colour, 0xrrggbb.
local function place_of_color(self, kind, code)
  local colors = self.colors
  if colors.count >= EXACT and not colors[code] then
    local rounded = 0
    for shift = 16, 0, -8 do rounded = rounded << 8 | ((code >> shift & 255) * 31 + 127) // 255 * 255 // 31 end
    code = rounded
  end
  if not colors[code] then
    local name = ("#%06x"):format(code)
    local fields = { name = name, diffuse = name }
    for field, value in pairs(self.options.material or {}) do fields[field] = value end
    self.materials[#self.materials + 1] = glint.material(fields)
    colors[code], colors.count = #self.materials, colors.count + 1
    self.kind_of_place[#self.materials] = kind
  end
  return colors[code]
end

-- Moves the pending spheres into arrays.
local function pack(self)
  local n = self.pending
  if n == 0 then return end
  if not self.data then error("particles: the spheres of this set have already been used", 0) end
  self.data[#self.data + 1] = glint.array(table.move(self.numbers, 1, 4 * n, 1, {}))
  self.index[#self.index + 1] = glint.array(table.move(self.places, 1, n, 1, {}), "integer")
  if self.color_by then self.values[#self.values + 1] = glint.array(table.move(self.pending_values, 1, n, 1, {})) end
  self.pending = 0
end

-- Extends the box of all spheres, along one axis.
local function stretch(self, axis, least, most)
  if least < self.low[axis] then self.low[axis] = least end
  if most > self.high[axis] then self.high[axis] = most end
end

-- Extends the range of all values. Ends that are NaN belong to missing values.
local function widen(self, least, most)
  if least == least then self.lowest, self.highest = math.min(self.lowest, least), math.max(self.highest, most) end
end

-- Adds a sphere. On failure, returns false, the expectation, and the actual value.
local function put(self, frame, label, x, y, z, radius, value, code)
  local kind = self.kinds[label] or kind_of(self, label, frame)
  if not kind then
    return false, "an element, its number, or one of the option kinds", label
  end
  radius = radius or kind.radius
  if radius <= 0 then return false, "a radius > 0", ("%.14g"):format(radius) end
  value = frames.value_of(value)
  if self.color_by and (math.type(value) == nil or math.abs(value) == math.huge) then
    return false, ("a finite number in the column %q"):format(self.color_by.column), tostring(value)
  end
  local numbers, at = self.numbers, 4 * self.pending
  numbers[at + 1], numbers[at + 2], numbers[at + 3], numbers[at + 4] = x, y, z, radius
  stretch(self, 1, x - radius, x + radius)
  stretch(self, 2, y - radius, y + radius)
  stretch(self, 3, z - radius, z + radius)
  self.pending = self.pending + 1
  local is_colored = code and not kind.is_own
  self.places[self.pending] = is_colored and place_of_color(self, kind, code) or place_of(self, kind)
  if self.color_by then
    self.pending_values[self.pending] = value
    widen(self, value, value)
  end
  self.count = self.count + 1
  self.counts[kind.name] = self.counts[kind.name] + 1
  if self.pending == CHUNK then pack(self) end
  return true
end

--- Adds one sphere.
---@param label string
---@param radius? number  Default: the radius of the kind
---@param value? number  the value that color_by shows
function set:add(label, x, y, z, radius, value)
  local done, expected, got = put(self, nil, label, x, y, z, radius, value)
  if not done then error(("%s expected, got %q"):format(expected, got), 2) end
end

-- Stores the box of all frames added; false if they have different boxes.
local function keep_box(self, box)
  local kept = self.box
  if kept == nil then self.box = box end
  if not kept then return end
  local same = kept.xy == box.xy and kept.xz == box.xz and kept.yz == box.yz
  for i = 1, 3 do
    same = same and kept.low[i] == box.low[i] and kept.size[i] == box.size[i] and kept.periodic[i] == box.periodic[i]
  end
  self.box = same and box
end

-- Returns the colour of a point, 0xrrggbb; nil for NaN.
local function code_of(frame, ...)
  local most, code = frame.color.most, 0
  for _, v in ipairs { ... } do
    if v ~= v then return nil end
    local level = math.type(v) and v >= 0 and v * (255 / most)
    if not level or level > 255 and (most ~= 1 or v > 16) then
      frame:fail(("red, green and blue 0 .. %d"):format(most), tostring(v))
    end
    code = code << 8 | math.floor(math.min(level, 255) + 0.5)
  end
  return code
end

-- Returns the colours of points in arrays, as whole numbers; nil if some need more care.
local function codes_of(frame, arrays)
  local codes, scale = 0, 255 / frame.color.most
  for i = 1, 3 do
    local v, sum = arrays[i], arrays[i]:sum()
    if sum ~= sum or v:min() < 0 or v:max() * scale > 255 then return nil end
    codes = codes * 256 + (v * scale + 0.5):floor()
  end
  return codes:bins(-0.5, 0xffffff + 0.5, 1 << 24)
end

-- Returns the materials of points: kinds by the numbers in `labels`, codes from codes_of.
local function places_of_colors(self, kinds, labels, codes)
  for i = 1, #codes do
    local kind = kinds[labels[i]]
    codes[i] = kind.is_own and place_of(self, kind) or place_of_color(self, kind, codes[i] - 1)
  end
  return codes
end

-- Adds n spheres in arrays. labels: the number of each one's kind in the list `kinds`. Returns false if they have
-- colours that need more care.
local function add_rows(self, frame, n, arrays, kinds, labels)
  local radii, places, index, values = {}, {}, nil, arrays[1]
  if frame.color and not self.color_by then
    values, index = nil, codes_of(frame, arrays)
    if not index then return false end
    places_of_colors(self, kinds, labels, index)
  end
  pack(self)
  local counts = labels:counts()
  for i, kind in ipairs(kinds) do
    radii[i], places[i] = kind.radius, kind.place
    self.counts[kind.name] = self.counts[kind.name] + (counts[i] or 0)
  end
  radii = arrays.radius or glint.array(radii):at(labels)
  local least, most = radii:min(), radii:max()
  for axis, name in ipairs { "x", "y", "z" } do
    local at = arrays[name]
    if least == most then
      stretch(self, axis, at:min() - least, at:max() + least)
    else
      stretch(self, axis, (at - radii):min(), (at + radii):max())
    end
  end
  self.data[#self.data + 1] = glint.array { arrays.x, arrays.y, arrays.z, radii }
  self.index[#self.index + 1] = index or glint.array(places, "integer"):at(labels)
  if values then
    self.values[#self.values + 1] = values
    widen(self, values:min(), values:max())
  end
  self.count = self.count + n
end

--- Adds the atoms of a frame from a reader; points of a coloured cloud keep their colours. An atom that cannot be added
--- is an error with file and line. The set stores the frame's box for glint.bonds.
---@return table set  the set itself
function set:add_frame(frame)
  if frame.box then keep_box(self, frame.box) end
  local is_colored = frame.color and not self.color_by
  local names = is_colored and { "red", "green", "blue" } or { self.color_by and self.color_by.column }
  local kinds, numbers, last = {}, {}, nil
  frame:begin(names)
  frame:bulk(names, "size", function(label, x, y, z, radius, value, ...)
    local code
    if is_colored then code, value = code_of(frame, value, ...), nil end
    local done, expected, got = put(self, frame, label, x, y, z, radius, value, code)
    if not done then frame:fail(expected, got) end
    local kind = self.kinds[label]
    if not numbers[kind] then kinds[#kinds + 1], numbers[kind] = kind, #kinds + 1 end
    last = numbers[kind]
    return last
  end, function(n, arrays)
    return add_rows(self, frame, n, arrays, kinds, arrays.label or glint.array(n, "integer") + last)
  end)
  return self
end

--- Returns the range of color_by: the numbers at the ends of its map.
---@return number low
---@return number high
function set:range()
  local by = self.color_by
  if not by then error("particles.range: a set with color_by expected", 2) end
  local low, high = by.low or self.lowest, by.high or self.highest
  if low > high then low, high = by.low or 0, by.high or 1 end -- no values
  if low < high then return low, high end
  return low, low + 1 -- all values are equal
end

-- Returns the materials for the values, and their index for each sphere.
local function color(self)
  local low, high = self:range()
  local map, materials = glint.colormap(self.color_by.map or "viridis"), {}
  for i = 1, STEPS do
    local fields = { diffuse = map((i - 1) / (STEPS - 1)) }
    for field, value in pairs(self.options.material or {}) do fields[field] = value end
    materials[i] = glint.material(fields)
  end
  local fields = { name = "missing", diffuse = self.color_by.missing or map(0 / 0) }
  for field, value in pairs(self.options.material or {}) do fields[field] = value end
  local index = glint._join(self.values, 1):bins(low, high, STEPS)
  materials[STEPS + 1] = self.count > 0 and index:max() > STEPS and glint.material(fields) or nil
  return materials, index
end

--- Returns the spheres as arrays: data (rows of x, y, z, radius), index (the material of each in the list materials),
--- and places (the material by its label, which differs from index in a set with color_by).
---@return table all
function set:arrays()
  pack(self)
  local done = self.done
  if done and done.count == self.count then return done end
  local places = glint._join(self.index, 1)
  local all = { count = self.count, places = places, index = places, materials = self.materials,
    data = glint._join(self.data, 4, self.format == "f32") }
  if self.color_by then all.materials, all.index = color(self) end
  self.data, self.index, self.done = { all.data }, { places }, all
  return all
end

--- Returns the spheres as one shape; an empty group if there are none, as in the first frame of some films. The set
--- gives up its arrays: call it once.
---@param fields? table  further fields of the shape, such as { name = "melt" }
function set:spheres(fields)
  if not self.data then error("particles: the spheres of this set have already been used", 0) end
  if self.count == 0 then
    self.data = nil
    return glint.group {}
  end
  local all = self:arrays()
  local given = { data = all.data, index = all.index, materials = all.materials }
  for name, value in pairs(fields or {}) do given[name] = value end
  local shape = glint.spheres(given)
  self.shape, self.data, self.values, given.data, given.index = shape, nil, nil, nil, nil
  self.done = { count = self.count, places = all.places, materials = all.materials, data = shape }
  if self.count >= LARGE then
    all.data, all.index = nil, nil
    collectgarbage()
  end
  return shape
end

--- Returns the centre of the box around all spheres, and half its diagonal. Without spheres it uses the frames'
--- box; without a box it returns the origin and 1.
---@return number[] center
---@return number radius
function set:extent()
  local low, high, center, squares = self.low, self.high, {}, 0
  if self.count == 0 and not self.box then return { 0, 0, 0 }, 1 end
  if self.count == 0 then low, high = table.unpack(boxes.corners(self.box)) end
  for i = 1, 3 do
    center[i] = (low[i] + high[i]) / 2
    squares = squares + ((high[i] - low[i]) / 2) ^ 2
  end
  return center, math.sqrt(squares)
end

local CAMERA = { from = true, margin = true, fov = true, up = true, name = true, projection = true }

local function check_camera(fields)
  if type(fields) ~= "table" then
    error(("particles.camera: { from = {x, y, z} } expected, got %s"):format(tostring(fields)), 3)
  end
  for name in pairs(fields) do
    if not CAMERA[name] then
      error(("particles.camera.%s: no such option; the options are from, margin, fov, projection, up, name")
        :format(name), 3)
    end
  end
  local from, square = fields.from, 0
  for i = 1, 3 do
    local v = type(from) == "table" and tonumber(from[i])
    if not v then error("particles.camera.from: three numbers {x, y, z} expected", 3) end
    square = square + v * v
  end
  if not (square > 0 and square < math.huge) then
    error("particles.camera.from: a direction that is not zero expected", 3)
  end
end

--- Returns a camera that has all spheres in view in a picture at least as wide as high.
---@param fields table  from: the direction from the centre to the eye, {x, y, z}; margin: a factor of the
--- distance at which the spheres just fit (default 1); and a camera's fov (default 30), up, name,
--- projection ("orthographic": the margin is a factor of its height)
function set:camera(fields)
  check_camera(fields)
  local center, radius = self:extent()
  local from, fov = fields.from, fields.fov or 30
  local length = math.sqrt(from[1] ^ 2 + from[2] ^ 2 + from[3] ^ 2)
  local is_flat = fields.projection == "orthographic"
  local margin = fields.margin or 1
  local distance = (is_flat and math.max(margin, 2) * radius or margin * radius / glint.sin(math.rad(fov) / 2)) / length
  local eye = {}
  for i = 1, 3 do eye[i] = center[i] + distance * from[i] end
  return glint.camera { eye = eye, at = center, fov = fov, projection = fields.projection,
    height = is_flat and 2 * margin * radius or nil, up = fields.up, name = fields.name }
end

--- Makes a depth cue for a camera that looks at the spheres: full light at the nearest; the share `lost` (0 .. 1,
--- default 0.7) is gone at the farthest.
---@param camera table
---@param lost? number
function set:depth_cue(camera, lost)
  local center, eye, way, square, deep = self:extent(), camera.eye, {}, 0, 0
  for i, axis in ipairs { "x", "y", "z" } do
    way[i] = center[i] - eye[axis]
    square = square + way[i] ^ 2
  end
  local distance = math.sqrt(square)
  for i = 1, 3 do -- half the depth of the box around the spheres
    deep = deep + math.abs(way[i]) / distance * (self.high[i] - self.low[i]) / 2
  end
  local near = math.max(distance - deep, 0)
  return { near = near, far = near + 2 * deep / (lost or 0.7) }
end

return particles
