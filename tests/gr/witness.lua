-- A plain renderer of the gr dialect, written only from its formulas: one ray per pixel, tested against every shape.
-- It shares no code with glint and checks no arguments. tests/lua/test_gr.lua compares its pictures with the engine's.
--
--   witness.run(path, order, options) -> list of pictures { file, width, height, codes = function(x, y, dx, dy) }
--   order "pre"|"post"; options.pixel, options.specular, options.background (three 8-bit values)
local witness = {}

local EPSILON = 1e-7 -- minimum distance of a hit, as a share of the length of a shadow or eye ray

-- ---- Matrices: rows of 4, the last row is 0 0 0 1 ----

local function product(a, b)
  local out = {}
  for i = 1, 3 do
    out[i] = {}
    for j = 1, 4 do
      out[i][j] = a[i][1] * b[1][j] + a[i][2] * b[2][j] + a[i][3] * b[3][j] + (j == 4 and a[i][4] or 0)
    end
  end
  return out
end

local function identity() return { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 0 } } end

-- Inverts a matrix by Gauss-Jordan elimination. Returns nil for a singular matrix.
local function inverse(m)
  local rows = {}
  for i = 1, 3 do
    rows[i] = { m[i][1], m[i][2], m[i][3], i == 1 and 1 or 0, i == 2 and 1 or 0, i == 3 and 1 or 0 }
  end
  for column = 1, 3 do
    local pivot = column
    for i = column + 1, 3 do
      if math.abs(rows[i][column]) > math.abs(rows[pivot][column]) then pivot = i end
    end
    rows[column], rows[pivot] = rows[pivot], rows[column]
    local p = rows[column][column]
    if math.abs(p) < 1e-300 then return nil end
    for j = 1, 6 do rows[column][j] = rows[column][j] / p end
    for i = 1, 3 do
      local factor = rows[i][column]
      if i ~= column then
        for j = 1, 6 do rows[i][j] = rows[i][j] - factor * rows[column][j] end
      end
    end
  end
  local out = {}
  for i = 1, 3 do
    local a, b, c = rows[i][4], rows[i][5], rows[i][6]
    out[i] = { a, b, c, -(a * m[1][4] + b * m[2][4] + c * m[3][4]) }
  end
  return out
end

-- ---- Vectors ----

local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
local function minus(a, b) return { a[1] - b[1], a[2] - b[2], a[3] - b[3] } end
local function along(p, d, t) return { p[1] + t * d[1], p[2] + t * d[2], p[3] + t * d[3] } end
local function cross(a, b)
  return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end
local function unit(a)
  local length = math.sqrt(dot(a, a))
  return { a[1] / length, a[2] / length, a[3] / length }
end

-- ---- Shapes in their own space: hits(p, d, found) calls found(t, normal) for every hit ----

local function sphere(center, radius)
  return function(p, d, found)
    local o = minus(p, center)
    local a, b, c = dot(d, d), dot(o, d), dot(o, o) - radius * radius
    local under = b * b - a * c
    if under < 0 then return end
    local root = math.sqrt(under)
    for _, t in ipairs { (-b - root) / a, (-b + root) / a } do found(t, along(o, d, t)) end
  end
end

local function box(low, high)
  return function(p, d, found)
    for axis = 1, 3 do
      for side, bound in ipairs { low[axis], high[axis] } do
        local t = (bound - p[axis]) / d[axis]
        local q, j, k = along(p, d, t), axis % 3 + 1, (axis + 1) % 3 + 1
        if q[j] >= low[j] and q[j] <= high[j] and q[k] >= low[k] and q[k] <= high[k] then
          local normal = { 0, 0, 0 }
          normal[axis] = side == 1 and -1 or 1
          found(t, normal)
        end
      end
    end
  end
end

local function disk(z, normal, p, d, found)
  local t = (z - p[3]) / d[3]
  local q = along(p, d, t)
  if q[1] * q[1] + q[2] * q[2] <= 1 then found(t, normal) end
end

-- The round surface x^2 + y^2 = (r0 + slope z)^2 between z = 0 and z = 1.
local function round(r0, slope)
  return function(p, d, found)
    local r = r0 + slope * p[3]
    local a = d[1] * d[1] + d[2] * d[2] - slope * slope * d[3] * d[3]
    local b = p[1] * d[1] + p[2] * d[2] - r * slope * d[3]
    local c = p[1] * p[1] + p[2] * p[2] - r * r
    local under = b * b - a * c
    if under >= 0 and a ~= 0 then
      for _, sign in ipairs { -1, 1 } do
        local t = (-b + sign * math.sqrt(under)) / a
        local q = along(p, d, t)
        if q[3] >= 0 and q[3] <= 1 then found(t, { q[1], q[2], -slope * (r0 + slope * q[3]) }) end
      end
    end
    disk(0, { 0, 0, -1 }, p, d, found)
    if slope == 0 then disk(1, { 0, 0, 1 }, p, d, found) end
  end
end

-- A tube around the circle of radius `ring`. Takes steps along the ray, and bisects where the sign changes.
local function torus(tube, ring)
  local function off(q)
    local away = math.sqrt(q[1] * q[1] + q[2] * q[2]) - ring
    return away * away + q[3] * q[3] - tube * tube
  end
  return function(p, d, found)
    local length2 = d[1] * d[1] + d[2] * d[2] + d[3] * d[3]
    local middle = -(p[1] * d[1] + p[2] * d[2] + p[3] * d[3]) / length2
    local step = (ring + tube) / math.sqrt(length2) / 400
    for i = -400, 399 do
      local low, high = middle + i * step, middle + (i + 1) * step
      local outside = off(along(p, d, low)) > 0
      if outside ~= (off(along(p, d, high)) > 0) then
        for _ = 1, 60 do
          local half = (low + high) / 2
          if (off(along(p, d, half)) > 0) == outside then low = half else high = half end
        end
        local q = along(p, d, low)
        local inwards = ring / math.sqrt(q[1] * q[1] + q[2] * q[2])
        found(low, { q[1] - q[1] * inwards, q[2] - q[2] * inwards, q[3] })
      end
    end
  end
end

-- Tests by the crossing number, in the coordinate plane perpendicular to the normal's largest component.
local function inside(corners, q, j, k)
  local within, last = false, corners[#corners]
  for _, corner in ipairs(corners) do
    if (corner[k] > q[k]) ~= (last[k] > q[k]) and
      q[j] < corner[j] + (q[k] - corner[k]) / (last[k] - corner[k]) * (last[j] - corner[j]) then
      within = not within
    end
    last = corner
  end
  return within
end

local function polygons(vertices, faces)
  local list = {}
  for _, face in ipairs(faces) do
    local corners, normal = {}, { 0, 0, 0 }
    for i, number in ipairs(face) do
      local vertex = vertices[math.floor(tonumber(number)) + 1]
      corners[i] = { tonumber(vertex[1]), tonumber(vertex[2]), tonumber(vertex[3]) }
    end
    for i = 2, #corners - 1 do
      normal = along(normal, cross(minus(corners[i], corners[1]), minus(corners[i + 1], corners[1])), 1)
    end
    local largest = 1
    for axis = 2, 3 do
      if math.abs(normal[axis]) > math.abs(normal[largest]) then largest = axis end
    end
    if normal[largest] ~= 0 then list[#list + 1] = { corners, normal, largest % 3 + 1, (largest + 1) % 3 + 1 } end
  end
  return function(p, d, found)
    for _, face in ipairs(list) do
      local corners, normal = face[1], face[2]
      local t = dot(minus(corners[1], p), normal) / dot(d, normal)
      if t == t and inside(corners, along(p, d, t), face[3], face[4]) then found(t, normal) end
    end
  end
end

-- ---- Files ----

local function find(folder, name)
  for _, place in ipairs { folder .. name, folder .. "../" .. name, name } do
    local file = io.open(place)
    if file then
      file:close()
      return place
    end
  end
  error(name .. ": not found")
end

local function read_obj(path)
  local vertices, faces = {}, {}
  for line in io.lines(path) do
    line = line:gsub("#.*", "")
    local word = line:match "^%s*(%S+)"
    if word == "v" or word == "f" then
      local numbers = {}
      for part in line:match("^%s*%S+(.*)"):gmatch "%S+" do
        numbers[#numbers + 1] = tonumber((part:gsub("/.*", "")))
      end
      if word == "f" then
        for i, number in ipairs(numbers) do numbers[i] = number < 0 and #vertices + number or number - 1 end
        faces[#faces + 1] = numbers
      else
        vertices[#vertices + 1] = numbers
      end
    end
  end
  return vertices, faces
end

-- ---- A picture ----

-- Collects the shapes in world space: hits, inverse map, material.
local function collect(node, map, order, out)
  map = product(map, order == "pre" and node.pre or node.post)
  local back = inverse(map)
  if node.hits and back then out[#out + 1] = { hits = node.hits, back = back, material = node.material } end
  for _, child in ipairs(node.children) do collect(child, map, order, out) end
  return out
end

local function each_hit(shapes, p, d, found)
  for _, shape in ipairs(shapes) do
    local b, q, e = shape.back, {}, {}
    for i = 1, 3 do
      q[i] = b[i][1] * p[1] + b[i][2] * p[2] + b[i][3] * p[3] + b[i][4]
      e[i] = b[i][1] * d[1] + b[i][2] * d[2] + b[i][3] * d[3]
    end
    shape.hits(q, e, function(t, normal) found(t, normal, shape) end)
  end
end

local function nearest(shapes, p, d)
  local best, normal, shape = math.huge, nil, nil
  each_hit(shapes, p, d, function(t, n, s)
    if t > EPSILON and t < best then best, normal, shape = t, n, s end
  end)
  return shape and best, normal, shape
end

local function is_dark(shapes, point, light)
  local dark = false
  each_hit(shapes, point, minus(light.position, point), function(t) dark = dark or t > EPSILON and t < 1 end)
  return dark
end

local function highlight(kind, n, l, v, shininess)
  if kind == "blinn" then return math.max(0, dot(n, unit(along(l, v, 1)))) ^ shininess end
  local r = minus({ 2 * dot(n, l) * n[1], 2 * dot(n, l) * n[2], 2 * dot(n, l) * n[3] }, l)
  return math.max(0, dot(r, v)) ^ shininess
end

local function shade(picture, p, d)
  local t, normal, shape = nearest(picture.shapes, p, d)
  if not t then return picture.background end
  local b, material, color = shape.back, shape.material, {}
  local n = {} -- the normal is mapped by the transposed inverse
  for i = 1, 3 do n[i] = b[1][i] * normal[1] + b[2][i] * normal[2] + b[3][i] * normal[3] end
  n = unit(n)
  local point, v = along(p, d, t), unit { -d[1], -d[2], -d[3] }
  for c = 1, 3 do color[c] = picture.ambient[c] * material.kd[c] end
  if dot(n, v) > 0 then
    for _, light in ipairs(picture.lights) do
      local way = minus(light.position, point)
      local r, l = math.sqrt(dot(way, way)), unit(way)
      local cosine = dot(n, l)
      if cosine > 0 and not is_dark(picture.shapes, point, light) then
        local f = light.falloff
        local strength = 1 / (f[1] + f[2] * r + f[3] * r * r)
        local s = highlight(picture.specular, n, l, v, material.shininess)
        for c = 1, 3 do
          color[c] = color[c] + light.colour[c] * strength * (material.kd[c] * cosine + material.ks[c] * s)
        end
      end
    end
  end
  for c = 1, 3 do color[c] = math.floor(math.max(0, math.min(1, color[c])) * 255) end
  return color
end

-- Returns the 8-bit values of a pixel. dx and dy shift its ray by fractions of a pixel.
local function codes(picture, x, y, dx, dy)
  local size = math.tan(math.rad(picture.fov) / 2)
  local a = (2 * (x + picture.pixel + dx) / picture.width - 1) * size * picture.width / picture.height
  local b = (1 - 2 * (y + picture.pixel + dy) / picture.height) * size
  return shade(picture, picture.eye, along(along(picture.w, picture.u, a), picture.v, b))
end

-- ---- The dialect ----

local function numbers(list)
  local out = {}
  for i, entry in ipairs(list) do out[i] = tonumber(entry) end
  return out
end

local function new_gr(folder, order, options, pictures)
  local gr = {}
  gr.__index = gr
  local function node(hits) return setmetatable({ hits = hits, children = {}, pre = identity(), post = identity() }, gr) end
  local function move(n, map) n.pre, n.post = product(map, n.pre), product(n.post, map) end
  gr.node, gr.joint = function() return node() end, function() return node() end
  function gr.sphere() return node(sphere({ 0, 0, 0 }, 1)) end
  function gr.cube() return node(box({ 0, 0, 0 }, { 1, 1, 1 })) end
  function gr.cylinder() return node(round(1, 0)) end
  function gr.cone() return node(round(1, -1)) end
  function gr.torus(_, tube, ring) return node(torus(tonumber(tube), tonumber(ring or 1))) end
  function gr.nh_sphere(_, center, radius) return node(sphere(numbers(center), tonumber(radius))) end
  function gr.nh_box(_, corner, edge)
    local low = numbers(corner)
    return node(box(low, { low[1] + edge, low[2] + edge, low[3] + edge }))
  end
  function gr.mesh(_, vertices, faces)
    if type(vertices) == "string" then vertices, faces = read_obj(find(folder, vertices)) end
    return node(polygons(vertices, faces))
  end
  function gr.add_child(n, child) n.children[#n.children + 1] = child end
  function gr.set_material(n, material) n.material = material end
  function gr.translate(n, x, y, z)
    move(n, { { 1, 0, 0, tonumber(x) }, { 0, 1, 0, tonumber(y) }, { 0, 0, 1, tonumber(z) } })
  end
  function gr.scale(n, x, y, z)
    move(n, { { tonumber(x), 0, 0, 0 }, { 0, tonumber(y), 0, 0 }, { 0, 0, tonumber(z), 0 } })
  end
  function gr.rotate(n, axis, degrees)
    local c, s, m = math.cos(math.rad(degrees)), math.sin(math.rad(degrees)), identity()
    local i = ("xyz"):find(axis:lower())
    local j, k = i % 3 + 1, (i + 1) % 3 + 1
    m[j][j], m[j][k], m[k][j], m[k][k] = c, -s, s, c
    move(n, m)
  end
  function gr.material(kd, ks, shininess)
    return { kd = numbers(kd), ks = numbers(ks), shininess = tonumber(shininess) }
  end
  function gr.light(position, colour, falloff)
    return { position = numbers(position), colour = numbers(colour), falloff = numbers(falloff or { 1, 0, 0 }) }
  end
  function gr.render(root, file, width, height, eye, view, up, fov, ambient, lights)
    local picture = { file = file, width = math.floor(width), height = math.floor(height), lights = {} }
    for i, light in ipairs(lights) do picture.lights[i] = light end
    picture.eye, picture.fov, picture.ambient = numbers(eye), tonumber(fov), numbers(ambient)
    picture.w = unit(numbers(view))
    picture.u = unit(cross(picture.w, numbers(up)))
    picture.v = cross(picture.u, picture.w)
    picture.pixel, picture.specular = options.pixel or 0.5, options.specular or "phong"
    picture.background = options.background or { 0, 0, 0 }
    picture.shapes = collect(root, identity(), order, {})
    picture.codes = codes
    pictures[#pictures + 1] = picture
  end
  return gr
end

--- Runs a scene, with the library functions of Lua 5.0 to 5.3.
function witness.run(path, order, options)
  local folder, pictures = path:match "^(.*/)", {}
  local env = setmetatable({}, { __index = _G })
  env.gr, env.unpack = new_gr(folder, order, options, pictures), table.unpack
  env.table = setmetatable({ getn = function(list) return #list end }, { __index = table })
  env.math = setmetatable({
    pow = function(a, b) return a ^ b end, mod = math.fmod,
    random = function(...)
      local limits = { ... }
      for i, limit in ipairs(limits) do limits[i] = limit // 1 | 0 end
      return math.random(table.unpack(limits))
    end,
    randomseed = function(seed) math.randomseed(seed // 1 | 0) end,
  }, { __index = math })
  env.string = setmetatable({ gfind = string.gmatch, format = function(pattern, ...)
    local values = { ... }
    for i, value in ipairs(values) do values[i] = type(value) == "number" and value // 1 | 0 or value end
    return string.format(pattern, table.unpack(values))
  end }, { __index = string })
  function env.dofile(name) return assert(loadfile(find(folder, name), "t", env))() end
  function env.require(name)
    if name == "readobj" then
      env.readobj = function(file) return read_obj(find(folder, file)) end
    else
      env.dofile(name:gsub("%.lua$", "") .. ".lua")
    end
  end
  assert(loadfile(path, "t", env))()
  return pictures
end

return witness
