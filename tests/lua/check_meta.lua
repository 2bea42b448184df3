-- bindings/meta/glint.lua describes exactly what the module registers: functions, objects, fields and methods.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"
local fill = dofile "bindings/meta/fill.lua"

local function filled(path)
  local text = fill(assert(io.open(path)):read "a")
  check(not text:find "@fields" and not text:find '\\" fields', "%s: fields are left out", path)
  return text
end

-- Reads the annotations: classes[name] = { parents, fields = {name -> line}, methods = {} }, and functions of `glint`.
local function read_meta(text)
  local classes, functions, owners, current = {}, {}, {}, nil
  local number = 0
  for line in text:gmatch "([^\n]*)\n" do
    number = number + 1
    local name, parents = line:match "^%-%-%-@class ([%w_.]+):?%s*(.*)$"
    local field = line:match "^%-%-%-@field ([%w_]+)%??%s+%S"
    local variable = line:match "^local ([%w_]+) = {}$"
    local word = line:match '^glint%["(%w+)"%] = function%(' -- a Lua keyword
    local owner, separator, member = line:match "^function ([%w_]+)([.:])([%w_]+)%("
    if name then
      current = { fields = {}, methods = {}, parents = {} }
      classes[name] = current
      for parent in parents:gmatch "[%w_.]+" do table.insert(current.parents, parent) end
    elseif field then
      check(current, "line %d: a field outside a class", number)
      check(not current.fields[field], "line %d: field %s is described twice", number, field)
      check(line:find "%S  %S" or line:find " glint%.", "line %d: field %s is not explained", number, field)
      current.fields[field] = number
    elseif variable then
      owners[variable] = current
    elseif word then
      functions[word] = number
    elseif owner == "glint" and separator == "." then
      functions[member] = number
    elseif owner then
      check(owners[owner] and separator == ":", "line %d: %s belongs to no class", number, owner)
      owners[owner].methods[member] = number
    elseif line ~= "" and not line:match "^%-%-" and line ~= "return glint" then
      check(false, "line %d is neither annotation nor function: %s", number, line)
    end
    if not line:match "^%-%-%-" then current = nil end
  end
  return classes, functions
end

-- Collects the members of one kind, "fields" or "methods", of a class and of its parents.
local function inherited(classes, name, kind, into)
  into = into or {}
  for member in pairs(classes[name][kind]) do into[member] = true end
  for _, parent in ipairs(classes[name].parents) do
    check(classes[parent], "class %s: no such parent %s", name, parent)
    if classes[parent] then inherited(classes, parent, kind, into) end
  end
  return into
end

local function all_fields(classes, name) return inherited(classes, name, "fields") end

local root = arg[0]:match "^(.*)/tests/[^/]*$" or "."
local classes, functions = read_meta(filled(root .. "/bindings/meta/glint.lua"))

-- Checks the module's table.
local values = all_fields(classes, "glint")
for name, value in pairs(glint) do
  if name:sub(1, 1) == "_" then
    check(true)
  elseif type(value) == "function" then
    check(functions[name], "glint.%s is registered, but not described", name)
  else
    check(values[name], "glint.%s is there, but not described", name)
  end
end
for name in pairs(functions) do
  check(type(glint[name]) == "function", "glint.%s is described, but not registered", name)
end
for name in pairs(values) do check(glint[name] ~= nil, "glint.%s is described, but not there", name) end

-- Checks the objects.
local registered = glint._fields()
for kind, members in pairs(registered) do
  local class = classes["glint." .. kind]
  check(class, "%s is registered, but has no class", kind)
  if class then
    local fields, methods = all_fields(classes, "glint." .. kind), inherited(classes, "glint." .. kind, "methods")
    for name, how in pairs(members) do
      if how == "field" then
        check(fields[name], "%s.%s is registered, but not described", kind, name)
      else
        check(methods[name], "%s:%s() is registered, but not described", kind, name)
      end
    end
    for name in pairs(fields) do
      check(members[name] == "field", "%s.%s is described, but not registered", kind, name)
    end
    for name in pairs(methods) do
      check(members[name] == "method", "%s:%s() is described, but not registered", kind, name)
    end
  end
end

-- The constructors take exactly the documented fields. The error for a wrong value shows whether a field is known.
local function is_known(make, field)
  local _, message = pcall(make, { [field] = print })
  return not tostring(message):find("no such field", 1, true)
end
for name in pairs(functions) do
  local fields = classes["glint." .. name .. "_fields"]
  if fields then
    for field in pairs(all_fields(classes, "glint." .. name .. "_fields")) do
      check(is_known(glint[name], field), "glint.%s does not know the described field '%s'", name, field)
    end
    for field, how in pairs(registered[name] or {}) do
      if how == "field" and is_known(glint[name], field) then
        check(all_fields(classes, "glint." .. name .. "_fields")[field],
          "glint.%s takes '%s', which is not described", name, field)
      end
    end
    check(not is_known(glint[name], "no_such_name"), "glint.%s takes any field", name)
  end
end

-- The manual page must name every object, field, method and function.
local page = filled(root .. "/bindings/glint.1")
local section = page:match "%.SH SCRIPTS\n(.-)\n%.SH "
check(section, "the manual page has a section SCRIPTS")
local named = {}
for word in (section or ""):gsub("%.BR? ", " "):gmatch "[%a_][%w_]*" do named[word] = true end
for name in pairs(functions) do check(named[name], "the manual page does not name glint.%s", name) end
for name, class in pairs(classes) do
  for field in pairs(class.fields) do check(named[field], "the manual page does not name %s.%s", name, field) end
  for method in pairs(class.methods) do check(named[method], "the manual page does not name %s:%s()", name, method) end
end

tally.finish()
