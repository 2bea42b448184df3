-- Writes a folder with a scene to start from and the settings of editors, or only the scene (glint new).
local the = ...

local function settings(types)
  return '{\n  "runtime.version": "Lua 5.4"'
    .. (types and ',\n  "workspace.library": [' .. the.json(types) .. "]" or "") .. "\n}\n"
end

function the.run(my)
  if #my.arguments ~= 1 then my.fail(2, "one name expected") end
  local name = my.arguments[1]
  local base = name:match "[^/]*$"
  if not base:find "^[^.]" then
    my.fail(2, (name ~= "" and name .. ": " or "") .. "expected the name of a folder or of a .lua script")
  end
  local path, is_folder = name, not base:find ".%.lua$"
  local code, why
  if is_folder then
    path = name .. "/" .. base .. ".lua"
    code, why = my.make_folder(name)
  end
  if not code then code, why = my.write(path, (my.starter():gsub("@NAME@", path:match "[^/]*$"))) end
  if not code and is_folder then
    code, why = my.write(name .. "/.luarc.json", settings(my.types()))
    if code == 2 then code = nil end -- settings that exist already stay
  end
  if code then my.fail(code, path .. ": " .. why) end
  if my.options.json then
    my.print('{"event":"new","file":' .. the.json(path) .. "}\n")
  else
    my.say(("%s: a scene to start from; render it with:  glint %s\n"):format(path, path))
  end
end
