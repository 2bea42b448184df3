-- The public headers document every type, function, field and constant: in a comment on its line, above it, or above its
-- group of lines. A test must call each function that takes a pointer with NULL.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check

-- Returns the declarations of the header, each with its first line and whether a comment documents it.
local function declarations(path)
  local list, explained, depth, open = {}, false, 0, nil
  local number = 0
  for line in io.lines(path) do
    number = number + 1
    local code = line:gsub("//.*", ""):gsub('^extern "C" {', ""):gsub("^} // extern.*", "")
    if line:match "^%s*$" then
      explained = false
    elseif line:match "^%s*///?[^/<]" and not line:match "^%s*///<" then
      explained = true
    elseif code:match "^#" or code:match "^%s*$" then
      explained = explained or line:match "///<" ~= nil
      if line:match "///<" and open then open.explained = true end
    else
      local noted = explained or line:match "///<" ~= nil
      if not open then
        open = { line = number, text = code, explained = noted }
        list[#list + 1] = open
      else
        open.text = open.text .. code
        open.explained = open.explained or noted
      end
      depth = depth + select(2, code:gsub("{", "")) - select(2, code:gsub("}", ""))
      if code:match "[;,{}]%s*$" and (code:match "[;{}]" or depth > 0) then open = nil end
      if code:match "{" or not code:match "^%s" then explained = depth == 0 and noted and not code:match "}" end
    end
  end
  return list
end

local function text_of(path)
  local file <close> = assert(io.open(path))
  return file:read "a"
end

local headers = {}
for _, name in ipairs { "", "_compare", "_data", "_figures", "_files", "_inspect", "_math", "_programs", "_types" } do
  headers[#headers + 1] = "engine/glint" .. name .. ".h"
end
local listed <close> = assert(io.popen "ls engine/glint*.h")
check(listed:read "a" == table.concat(headers, "\n") .. "\n", "the public headers are others")
local count = 0
for _, path in ipairs(headers) do
  for _, d in ipairs(declarations(path)) do
    if not d.text:match "^%s*}" then
      count = count + 1
      check(d.explained, "%s:%d: not explained: %s", path, d.line, d.text:match "^%s*(.-)%s*$")
    end
  end
end
check(count > 300, "%d declarations", count)
local lines = select(2, text_of("engine/glint.h"):gsub("\n", ""))
check(lines <= 900, "engine/glint.h has %d lines, at most 900 are wanted", lines)

-- The version as a text and as numbers.
local version = {}
for part in text_of("engine/glint.h"):gmatch "#define GLINT_VERSION_%u+ (%d+)" do version[#version + 1] = part end
check(table.concat(version, ".") == text_of("engine/glint.h"):match '#define GLINT_VERSION "([%d.]+)"', "the numbers of the version")

-- Every function that takes a pointer must be called with NULL.
local calls, functions = text_of "tests/engine/test_null.c", 0
for _, path in ipairs(headers) do
  for name, arguments in text_of(path):gsub("//[^\n]*", ""):gmatch "\n%w[%w_ *]-(glint_[%w_]+)(%b());" do
    if arguments:find "[*%[]" then
      functions = functions + 1
      check(calls:find(name .. "(", 1, true), "tests/engine/test_null.c does not call %s", name)
    end
  end
end
check(functions > 150, "%d functions that take a pointer", functions)
tally.finish()
