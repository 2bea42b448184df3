-- Choices that the course left open, as fields of gr.options. They are checked when they are set.
--
--   order       "pre" or "post": how transforms are multiplied; nil, the default: by the scene's generation
--   pixel       the ray's position in its pixel, 0 (the corner) or 0.5
--   specular    "phong" or "blinn"
--   plane       the square of gr.plane(name): "xz" or "xy" of edge 1 around the origin, "xz-2" or "xy-2" of edge 2,
--               "xz-corner" or "xy-corner" of edge 1 from the origin on; nil, the default: "xz", with a warning
--   axis        "x", "y" or "z": for gr.cylinder and gr.cone
--   background  {r, g, b} from 0 on, "r,g,b", or "#rrggbb", the pixel values of the picture
local check = require "gr.check"
check.own_source()

local pairs, tonumber, type = pairs, tonumber, type
local values = { pixel = 0.5, specular = "phong", axis = "z", background = { 0, 0, 0 } }

local PLANES = { "xz", "xz-2", "xz-corner", "xy", "xy-2", "xy-corner",
  text = '"xz", "xz-2", "xz-corner", "xy", "xy-2" or "xy-corner"' }

local function read_background(value)
  if type(value) == "table" then return check.vector("options.background", "colour", value, 3, 0) end
  local text = type(value) == "string" and value or ""
  local r, g, b = text:match "^#(%x%x)(%x%x)(%x%x)$"
  if r then -- the middle of a step, because values are truncated
    return { (tonumber(r, 16) + 0.5) / 255, (tonumber(g, 16) + 0.5) / 255, (tonumber(b, 16) + 0.5) / 255 }
  end
  local parts = { text:match "^([^,]+),([^,]+),([^,]+)$" }
  if #parts ~= 3 then
    check.raise('gr.options.background: "r,g,b" or "#rrggbb" expected, got %s', check.spelling(value))
  end
  return check.vector("options.background", "colour", parts, 3, 0)
end

local readers = {
  order = function(value)
    return value and check.choice("order", { "pre", "post", text = '"pre" or "post"' }, value)
  end,
  pixel = function(value) return check.choice("pixel", { 0, 0.5, text = "0 or 0.5" }, tonumber(value) or value) end,
  specular = function(value)
    return check.choice("specular", { "phong", "blinn", text = '"phong" or "blinn"' }, value)
  end,
  plane = function(value) return value and check.choice("plane", PLANES, value) end,
  axis = function(value) return check.choice("axis", { "x", "y", "z", text = '"x", "y" or "z"' }, value) end,
  background = read_background,
}

local function no_such(name)
  local names = {}
  for known in pairs(readers) do names[#names + 1] = known end
  table.sort(names)
  check.raise("gr.options: %s expected, got %s", table.concat(names, ", "), check.spelling(name))
end

return setmetatable({}, {
  __index = function(_, name)
    if not readers[name] then no_such(name) end
    return values[name]
  end,
  __newindex = function(_, name, value)
    if not readers[name] then no_such(name) end
    values[name] = readers[name](value)
  end,
})
