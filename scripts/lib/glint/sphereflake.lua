-- The sphereflake of Eric Haines' Standard Procedural Databases (SPD, "balls"; IEEE Computer Graphics and Applications
-- 7(11), 1987): a sphere of radius 1/2 with nine spheres of a third of its radius on it, and so on, `size` times.
--     sphereflake.each(4, function(x, y, z, radius) ... end)     -- 1 + 9 + ... + 9^4 = 7381 spheres
-- The nine stand in the directions (1,1,0), (1,0,-1) and (0,1,-1), turned about (1,-1,0) by asin(2 / sqrt 6), and each
-- of these turned by 0, 120 and 240 degrees about z; +z is then turned to the parent's direction. This needs only
-- roots, so that the spheres are the same on every machine.
local sphereflake = {}

local SHARE = 1 / 3 -- radius relative to the parent's
local HALF = math.sqrt(2) / 2

-- Turns v about a unit axis by the angle with this cosine and sine (Rodrigues).
local function turn(v, axis, cosine, sine)
  local ax, ay, az = axis[1], axis[2], axis[3]
  local x, y, z = v[1], v[2], v[3]
  local along = (1 - cosine) * (ax * x + ay * y + az * z)
  return {
    x * cosine + (ay * z - az * y) * sine + ax * along,
    y * cosine + (az * x - ax * z) * sine + ay * along,
    z * cosine + (ax * y - ay * x) * sine + az * along,
  }
end

-- Returns the nine directions around +z.
local function make_directions()
  local list = {}
  local axis, up = { HALF, -HALF, 0 }, { 0, 0, 1 }
  local triangle = { { HALF, HALF, 0 }, { HALF, 0, -HALF }, { 0, HALF, -HALF } }
  for i = 0, 2 do
    for _, v in ipairs(triangle) do
      local upright = turn(v, axis, 1 / math.sqrt(3), math.sqrt(2 / 3))
      list[#list + 1] = turn(upright, up, i == 0 and 1 or -0.5, ({ 0, 1, -1 })[i + 1] * math.sqrt(3) / 2)
    end
  end
  return list
end

-- Turns v from +z to the unit vector `to`.
local function tilt(v, to)
  local sine = math.sqrt(to[1] ^ 2 + to[2] ^ 2)
  if sine == 0 then return to[3] > 0 and v or { -v[1], v[2], -v[3] } end -- half a turn about y
  return turn(v, { -to[2] / sine, to[1] / sine, 0 }, to[3], sine)
end

local directions = make_directions()

local function visit(depth, x, y, z, radius, to, f)
  f(x, y, z, radius)
  if depth == 0 then return end
  local reach = radius * (1 + SHARE)
  for _, direction in ipairs(directions) do
    local v = tilt(direction, to)
    visit(depth - 1, x + v[1] * reach, y + v[2] * reach, z + v[3] * reach, radius * SHARE, v, f)
  end
end

--- Calls f(x, y, z, radius) for each sphere, parents first.
---@param size integer  0 .. 8
---@param f function
function sphereflake.each(size, f)
  visit(size, 0, 0, 0, 0.5, { 0, 0, 1 }, f)
end

--- The published view, background and lights, and the two materials as "f" lines.
sphereflake.NFF_HEADER = [[
v
from 2.1 1.3 1.7
at 0 0 0
up 0 0 1
angle 45
hither 0.01
resolution 512 512
b 0.078 0.361 0.753
l 4 3 2
l 1 -4 4
l -3 1 5
]]
sphereflake.NFF_FLOOR = [[
f 1 0.75 0.33 0.8 0 0 0 0
p 4
12 12 -0.5
-12 12 -0.5
-12 -12 -0.5
12 -12 -0.5
]]
sphereflake.NFF_SPHERES = "f 1 0.9 0.7 0.5 0.5 5 0 0\n"

--- Writes an NFF file. Raises on failure.
---@param path string
---@param size integer  0 .. 8
---@param with_floor boolean  the polygon under the spheres
function sphereflake.write_nff(path, size, with_floor)
  local file = assert(io.open(path, "w"))
  file:write(sphereflake.NFF_HEADER, with_floor and sphereflake.NFF_FLOOR or "", sphereflake.NFF_SPHERES)
  sphereflake.each(size, function(x, y, z, radius)
    file:write(("s %.17g %.17g %.17g %.17g\n"):format(x, y, z, radius))
  end)
  assert(file:close())
end

return sphereflake
