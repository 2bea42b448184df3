-- Additions to the Lua of --untrusted for scripts in a browser: files in memory, glint's modules and given modules.
local carried, collect, io, os = ...
local _G, loaded, glint = _G, {}, require "glint"
local load, error, type, rawget = load, error, type, rawget
local open = io.open

_G.io = {
  open = open, lines = io.lines, type = io.type, write = io.write,
  stdin = io.stdin, stdout = io.stdout, stderr = io.stderr,
}
_G.collectgarbage = collect -- always collects at once, whatever the option
_G.os.remove, _G.os.rename, _G.os.tmpname = os.remove, os.rename, os.tmpname

-- Returns the text of a file given to the script, or nil.
local function given(path)
  local file = open(path, "rb")
  local text = file and file:read "a"
  if file then file:close() end
  return text
end

local function text_of(name)
  local own = carried(name)
  if own then return own, "=" .. name end
  local path = name:gsub("%.", "/") .. ".lua"
  for _, place in _G.ipairs { path, "lib/" .. path } do
    local text = given(place)
    if text then return text, "@" .. place end
  end
end

function _G.require(name)
  if type(name) ~= "string" then
    error("bad argument #1 to 'require' (string expected, got " .. type(name) .. ")", 2)
  end
  if name == "glint" then return glint end
  if rawget(loaded, name) == nil then
    local text, chunk = text_of(name)
    if not text then
      error(("module '%s' not found: no file '%s.lua' was given"):format(name, (name:gsub("%.", "/"))), 2)
    end
    local run, message = load(text, chunk)
    if not run then error(("error loading module '%s':\n\t%s"):format(name, message), 2) end
    local value = run(name)
    loaded[name] = value == nil or value
  end
  return loaded[name]
end
