-- Lights: the course's point lights, and its variants' area lights. Each point of an area light shines like a point
-- light, in all directions, and the lamp is their mean.
local check = require "gr.check"
check.own_source()
local lamp = {}

local floor, max, min = math.floor, math.max, math.min
local ipairs, type = ipairs, type

local SAMPLES_LEAST, SAMPLES_MOST = 16, 65536 -- fewer, as in some scenes, would show as dots

-- In the course a falloff of 0 divides by 0; after clipping this looks the same.
local NO_FALLOFF = { 1e-30, 0, 0 }

--- Sets colour and falloff in the fields of a light.
function lamp.shine(call, fields, colour, falloff)
  fields.color = check.vector(call, "colour", colour, 3, 0)
  if falloff == nil then return end
  local c = check.vector(call, "fall-off", falloff, 3, 0)
  fields.attenuation = max(c[1], c[2], c[3]) == 0 and NO_FALLOFF or c
end

local function read_samples(call, argument, count)
  return check.at_least(call, argument, count == nil and 1 or count, 1)
end

local function clamp_samples(count) return floor(max(SAMPLES_LEAST, min(count, SAMPLES_MOST))) end

local function ball(call, position, colour, falloff, radius, samples, ...)
  local fields = { position = check.vector(call, "position", position, 3) }
  lamp.shine(call, fields, colour, falloff)
  fields.radius = check.at_least(call, "radius", radius, 0)
  fields.samples = clamp_samples(read_samples(call, "samples", samples))
  check.left_out(call, ...)
  return "sphere_light", fields
end

-- Returns the fields of a parallelogram.
local function polygon(corner, a, b, samples)
  local corners = {}
  for i, at in ipairs { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } } do
    corners[i] = {}
    for k = 1, 3 do corners[i][k] = corner[k] + at[1] * a[k] + at[2] * b[k] end
  end
  return { vertices = corners, two_sided = true, samples = clamp_samples(samples) }
end

-- Returns the fields of a parallelogram around a middle.
local function around(middle, a, b, samples)
  local corner = {}
  for k = 1, 3 do corner[k] = middle[k] - (a[k] + b[k]) / 2 end
  return polygon(corner, a, b, samples)
end

local function cross(a, b)
  return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

local function square(call, middle, colour, falloff, normal, up, edge, samples, ...)
  middle = check.vector(call, "middle", middle, 3)
  normal, up = check.direction(call, "normal", normal), check.direction(call, "up", up)
  local across = cross(up, normal)
  if across[1] == 0 and across[2] == 0 and across[3] == 0 then
    check.raise("gr.%s: up: another direction than that of the normal expected", call)
  end
  across = check.direction(call, "up", across)
  local down = cross(across, normal)
  edge = check.above(call, "edge", edge, 0)
  for k = 1, 3 do across[k], down[k] = edge * across[k], edge * down[k] end
  local fields = around(middle, across, down, read_samples(call, "samples", samples))
  lamp.shine(call, fields, colour, falloff)
  check.left_out(call, ...)
  return "polygon_light", fields
end

local function parallelogram(call, corner, a, n, b, m, colour, falloff, ...)
  corner = check.vector(call, "corner", corner, 3)
  a, b = check.vector(call, "edge", a, 3), check.vector(call, "edge", b, 3)
  local area = cross(check.direction(call, "edge", a), check.direction(call, "edge", b))
  if area[1] == 0 and area[2] == 0 and area[3] == 0 then
    check.raise("gr.%s: edge: two edges of different directions expected", call)
  end
  local fields = polygon(corner, a, b, read_samples(call, "n", n) * read_samples(call, "m", m))
  lamp.shine(call, fields, colour, falloff)
  check.left_out(call, ...)
  return "polygon_light", fields
end

--- Turns the arguments of gr.area_light into the name of a function of glint, and its fields.
function lamp.area(call, place, second, third, fourth, ...)
  if type(place) ~= "table" then
    check.raise("gr.%s: {position}, {colour}, {fall-off}, radius expected, got %s first: this is another variant of "
      .. "the dialect", call, check.spelling(place))
  end
  if type(third) ~= "table" then return parallelogram(call, place, second, third, fourth, ...) end
  if type(fourth) == "table" then return square(call, place, second, third, fourth, ...) end
  return ball(call, place, second, third, fourth, ...)
end

--- Turns the arguments of gr.rect_light into such a name and fields.
function lamp.rectangle(call, middle, width, depth, colour, falloff, samples, ...)
  middle = check.vector(call, "middle", middle, 3)
  width, depth = check.above(call, "width", width, 0), check.above(call, "depth", depth, 0)
  local fields = around(middle, { width, 0, 0 }, { 0, 0, depth }, read_samples(call, "samples", samples))
  lamp.shine(call, fields, colour, falloff)
  check.left_out(call, ...)
  return "polygon_light", fields
end

return lamp
