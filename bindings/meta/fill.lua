-- Inserts the fields of objects from the engine's tables into the API for editors and into the manual page, at each
-- line `---@fields OBJECT` or `.\" fields OBJECT...`. A field of several objects is named once. Run as a script of
-- glint with FROM=FILE in the environment, it prints the whole text.
local glint = require "glint"

local function number(x) return ("%.14g"):format(x) end

-- Returns a default as text; nil if there is none worth printing, or the documentation says so.
local function default(row)
  local value, doc = row.default, row.doc or ""
  if row.required or value == nil or doc:find "Default nil" or doc:find "No default" then return nil end
  if type(value) == "userdata" then
    local x, y, z = value:unpack()
    return x == y and y == z and number(x) or ("{%s, %s, %s}"):format(number(x), number(y), number(z))
  end
  return type(value) == "number" and number(value) or tostring(value)
end

-- Returns the editors' type of a row.
local function type_of(row)
  if not row.parts then return row.type end
  local parts = {}
  for i, part in ipairs(row.parts) do parts[i] = part.name .. ": " .. part.type .. (part.required and "" or "?") end
  return "{ " .. table.concat(parts, ", ") .. " }"
end

-- Returns "---@field shininess? number|glint.pattern  exponent >= 0 of the highlight. Default 32".
local function annotation(row)
  local text, value = row.doc .. (row.unit and ", " .. row.unit or ""), default(row)
  if row.follows then
    text = ("%s. Follows `%s` until set; nil: follows again"):format(text, row.follows)
  elseif value and not text:find "Default" then
    text = text .. ". Default " .. (type(row.default) == "string" and ("%q"):format(value) or value)
  end
  return ("---@field %s%s %s  %s"):format(row.name, row.required and "" or "?", type_of(row), text)
end

-- Returns "shininess (32)", "model (phong, blinn_phong)", "ambient (as diffuse)", "indirect {samples (16), ...}".
local item
function item(row)
  local names, value = {}, default(row)
  if row.parts then
    for i, part in ipairs(row.parts) do names[i] = item(part) end
    return ("%s {%s}"):format(row.name, table.concat(names, ", "))
  end
  for name in row.type:gmatch '"([^"]+)"' do names[#names + 1] = name end
  local note = #names > 0 and table.concat(names, ", ") or row.follows and "as " .. row.follows
    or value and value ~= "" and value ~= "false" and value
  return row.name .. (note and " (" .. note .. ")" or "")
end

local function fill(text)
  text = text:gsub("%-%-%-@fields ([%w_]+)", function(object)
    local lines = {}
    for i, row in ipairs(glint._rows(object)) do lines[i] = annotation(row) end
    return table.concat(lines, "\n")
  end)
  return (text:gsub('%.\\" fields ([%w_ ]+)', function(objects)
    local items, known = {}, {}
    for object in objects:gmatch "[%w_]+" do
      for _, row in ipairs(glint._rows(object)) do
        items[#items + 1] = not known[row.name] and item(row) or nil
        known[row.name] = true
      end
    end
    return table.concat(items, ",\n")
  end))
end

local from = os.getenv "FROM"
if from then
  io.write(fill(assert(io.open(from)):read "a"))
  os.exit(true)
end
return fill
