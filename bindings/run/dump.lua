-- glint dump: the scene of a frame as the text of a script that renders the same bits.
local the = ...
local M = {}
local concat, sort, unpack = table.concat, table.sort, table.unpack
local format, gmatch, gsub, match, sub = string.format, string.gmatch, string.gsub, string.match, string.sub
local ipairs, pairs, tostring, type = ipairs, pairs, tostring, type

local LOCALS_MAX <const> = 150 -- a function of Lua has at most 200 local variables; further objects go into a table
local WORDS <const> = {}
for word in gmatch([[and break do else elseif end false for function goto if in local nil not or repeat return then true
  until while glint scene more p s r]], "%a+") do WORDS[word] = true end

local tools -- C functions of the command
local lines, names, taken, count, main -- the text so far; object -> its expression; names in use; the dumped scene

local function refuse(where, why) the.raise(format("dump: %s: %s", where, why)) end

-- ---- Values ----

local spell, ref

local function number(value)
  if value ~= value then return "0 / 0" end
  if value == 1 / 0 or value == -1 / 0 then return value > 0 and "math.huge" or "-math.huge" end
  if value == 0 and 1 / value < 0 then return "-0.0" end
  return the.spell_number(value) or tostring(value)
end

local function list(value, where)
  local out = {}
  for i = 1, #value do out[i] = spell(value[i], where) end
  return "{ " .. concat(out, ", ") .. " }"
end

local function named(value, where)
  local keys, out = {}, {}
  for key in pairs(value) do keys[#keys + 1] = key end
  sort(keys)
  for i, key in ipairs(keys) do out[i] = format("%s = %s", key, spell(value[key], where .. "." .. key)) end
  return "{ " .. concat(out, ", ") .. " }"
end

function spell(value, where)
  local kind = type(value)
  if kind == "number" then return number(value) end
  if kind == "string" then return format("%q", value) end
  if kind == "table" then return (value[1] ~= nil and list or named)(value, where) end
  if kind ~= "userdata" then return tostring(value) end
  kind = tools.kind_of(value)
  if kind == "vector" then return list({ value[1], value[2], value[3] }) end
  if kind == "transform" then
    local out = {}
    for i = 1, 12 do out[i] = value[i] end
    return "glint.matrix " .. list(out)
  end
  return ref(value, where)
end

-- ---- Statements ----

-- Adds `local NAME = TEXT` for an object, which has this name from now on.
local function declare(object, name, text)
  name = gsub(name, "[^%w_]", "_")
  if not match(name, "^[%a_]") or WORDS[name] then name = "_" .. name end
  local base, i = name, 1
  while taken[name] do
    i = i + 1
    name = base .. i
  end
  taken[name] = true
  count = count + 1
  if count == LOCALS_MAX + 1 then lines[#lines + 1] = "local more = {}\n" end
  if count > LOCALS_MAX then name = "more." .. name end
  names[object] = name
  lines[#lines + 1] = format("%s%s = %s\n", count > LOCALS_MAX and "" or "local ", name, text)
  return name
end

-- Adds texts in lines of at most 120 characters.
local function wrap(opening, parts)
  local whole = opening .. " { " .. concat(parts, ", ") .. " }"
  if #parts == 0 then return opening .. " {}" end
  if #whole <= 100 then return whole end
  local out, line = { opening, " {\n" }, " "
  for _, part in ipairs(parts) do
    if #line + #part > 118 and #line > 1 then
      out[#out + 1] = line .. "\n"
      line = " "
    end
    line = line .. " " .. part .. ","
  end
  out[#out + 1] = line .. "\n}"
  return concat(out)
end

-- ---- Patterns and shaders: the listing of the program, an operation a statement ----

local FUSED <const> = { mulmul = "glint.mul(glint.mul(%s, %s), %s)",
  dot = "glint.add(glint.add(glint.mul(%s, %s), glint.mul(%s, %s)), glint.mul(%s, %s))" }
local INPUTS <const> = { r = "x", g = "y", b = "z", u = "x", v = "y" }

local function operand(word, is_pattern)
  local row = match(word, "^r(%d+)$")
  if row then return format("r[%d]", row) end
  if match(word, "^[-+]?%d") then return word == "-0" and "-0.0" or word end
  if match(word, "^[-+]?inf") then return sub(word, 1, 1) == "-" and "-math.huge" or "math.huge" end
  if match(word, "^[-+]?nan") then return "(0 / 0)" end
  local field, part = match(word, "^(%a+)%.?(%a*)$")
  if word == "uv.footprint" then return "s.uv_footprint" end
  if part == "" then return "s." .. field end
  return (field == "p" and is_pattern and "" or "s.") .. field .. "." .. (INPUTS[part] or part)
end

local function operation(line, is_pattern, where)
  local results, name, rest = match(line, "^(.-) ?= ([%w_]+) ?(.*)$")
  local rows, operands = {}, {}
  for row in gmatch(results, "r(%d+)") do rows[#rows + 1] = format("r[%d]", row) end
  if match(name, "^texel") then
    refuse(where, "a pattern that reads a texture has no text in Lua; assign the texture itself, "
      .. "or a pattern without it")
  end
  for word in gmatch(rest, "%S+") do operands[#operands + 1] = operand(word, is_pattern) end
  if FUSED[name] then return format("    %s = " .. FUSED[name] .. "\n", rows[1], unpack(operands)) end
  local call = format('%s(%s)', WORDS[name] and format('glint["%s"]', name) or "glint." .. name, concat(operands, ", "))
  if name ~= "noise3" then return format("    %s = %s\n", concat(rows, ", "), call) end
  return format("    local v = %s\n    %s = v.x, v.y, v.z\n", call, concat(rows, ", "))
end

local function program(value, kind, where)
  local is_pattern, out, result = kind == "pattern", {}, {}
  for line in gmatch(gsub(tostring(value), "^[^\n]*\n", "", 1), "[^\n]+") do
    local values = match(line, "^return(.*)")
    if not values then out[#out + 1] = operation(line, is_pattern, where) end
    for word in gmatch(values or "", "%S+") do result[#result + 1] = operand(word, is_pattern) end
  end
  local returned = #result == 1 and result[1] or format("{ %s }", concat(result, ", ", 1, 3))
  if #result == 6 then returned = format("%s, { %s }", returned, concat(result, ", ", 4, 6)) end
  return format("glint.%s(function(%s)\n%s%s    return %s\n  end)", kind, is_pattern and "p, s" or "s",
    #out > 0 and "    local r = {}\n" or "", concat(out), returned)
end

-- ---- Objects ----

local ALWAYS <const> = { eye = true, at = true, direction = true } -- cameras need them, even with the default

-- Returns the fields of an object that differ from their defaults, as texts.
local function fields(object, where, skipped)
  local out = {}
  for _, row in ipairs(the.fields(object)) do
    local name, value, default = row[1], row[2], row[3]
    if row[4] then
      refuse(where .. "." .. name, "a texture that the file of a mesh names has no text in Lua; assign glint.texture")
    end
    local is_curve_of_scene = name == "scene" and value == main
    if not skipped[name] and not is_curve_of_scene then
      local text = spell(value, where .. "." .. name)
      if default == nil or ALWAYS[name] or text ~= spell(default, where) then out[#out + 1] = name .. " = " .. text end
    end
  end
  return out
end

local SKIPPED <const> = { matrix = true, material = true }
local IDENTITY <const> = "transform = glint.matrix { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 }"

local function add_materials(out, shape, index, where)
  local materials, texts = shape.materials, {}
  for i, material in ipairs(materials) do texts[i] = ref(material, where .. ".material") end
  if #texts == 1 then
    out[#out + 1] = "material = " .. texts[1]
    return
  end
  out[#out + 1] = "materials = { " .. concat(texts, ", ") .. " }"
  out[#out + 1] = format("index = {\n  %s }", index or tools.join(shape.index))
end

local function add_mesh(out, mesh, where)
  local polygons, index = tools.polygons(mesh)
  if polygons == false then
    refuse(where .. ".faces", "flat shading of such faces of more than three corners has no text in Lua")
  end
  if tools.is_ambiguous(mesh) then
    refuse(where .. ".vertices", "as many as corners, so a list mistakes values of corners for values of vertices")
  end
  if polygons then out[1] = format("faces = {\n  %s }", polygons) end
  for _, name in ipairs(polygons and { "vertices", "uv" } or { "vertices", "faces", "uv" }) do
    local array = mesh[name]
    if array then out[#out + 1] = format("%s = {\n  %s }", name, tools.join(array)) end
  end
  local normals = mesh.normals
  if normals then
    local text, row = tools.join_normals(normals)
    if not text then refuse(where .. ".normals", format("a list cannot leave out normal %d, as the file does", row)) end
    out[#out + 1] = format("normals = {\n  %s }", text)
  end
  out[#out + 1] = format("shading = %q", mesh.shading)
  return index
end

local LISTS <const> = { group = true, union = true, intersection = true, difference = true, scene = true }

local function object_text(object, kind, where)
  local out = {}
  if LISTS[kind] then
    for i, child in ipairs(object:objects()) do out[i] = ref(child, where) end
  end
  local skipped = SKIPPED
  if kind == "lobe" then skipped = {} end
  if kind == "axes" and object.box then skipped = { at = true } end
  local index = kind == "mesh" and add_mesh(out, object, where) or nil
  if kind == "spheres" or kind == "cylinders" then out[1] = format("data = {\n  %s }", tools.join(object.data)) end
  if tools.has_material(object) then
    if kind == "mesh" or kind == "spheres" or kind == "cylinders" then
      add_materials(out, object, index, where)
    else
      out[#out + 1] = "material = " .. ref(object.material, where .. ".material")
    end
  end
  for _, text in ipairs(fields(object, where, skipped)) do
    if text ~= IDENTITY and not (kind == "mesh" and match(text, "^shading")) then out[#out + 1] = text end
  end
  return wrap("glint." .. kind, out)
end

-- Returns the expression of an object, and writes its statement the first time.
function ref(object, where)
  if names[object] then return names[object] end
  local kind = tools.kind_of(object)
  if kind == "pattern" or kind == "shader" then return declare(object, kind, program(object, kind, where)) end
  if kind == "texture" then
    return declare(object, "picture", format("glint.texture { file = %q, wrap = %q, filter = %q, transfer = %q }",
      tools.path(object.file), object.wrap, object.filter, object.transfer))
  end
  kind = object.kind
  local name
  for _, row in ipairs(the.fields(object)) do
    if row[1] == "name" and row[2] ~= "" then name = row[2] end
  end
  return declare(object, name or kind, object_text(object, kind, name or kind))
end

-- ---- The frame ----

local EXTENSIONS <const> = { png = true, svg = true, pdf = true, pfm = true, npy = true, exr = true }

-- Returns the name of the script's picture, with the extension of the frame's own picture.
local function picture_name(from, output)
  local extension = match(output or "", "%.(%w+)$")
  local base = gsub(gsub(from, ".*/", ""), "%.lua$", "")
  return base .. "." .. (EXTENSIONS[extension] and extension or "png")
end

-- Returns the script. `options`: fields of scene:render; `from`: script, frame, and output, the name of the new script.
function M.script(scene, options, functions, from)
  tools, lines, names, taken, count, main = functions, {}, {}, {}, 0, scene
  for _, pass in ipairs(options.passes) do
    if match(pass, "^d:") then
      refuse("passes", format("%q is a derivative, and the script has no variables; use --passes without it", pass))
    end
  end
  if #options.passes == 0 then options.passes = nil end
  options.output = picture_name(from.output or from.script, options.output)
  local text = object_text(scene, "scene", "scene")
  local head = format('-- Frame %d of %s, written by glint dump.\nlocal glint = require "glint"\n\n', from.frame,
    gsub(from.script, "%c", "?"))
  return format("%s%s\nlocal scene = %s\n\nscene:render %s\n", head, concat(lines), text, named(options, "render"))
end

return M
