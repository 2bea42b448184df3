-- Runs in the watched script's state before the script, and reports the files that it is about to read to the watcher.
--   note(path, optional, module)   the picture depends on the file; optional: only if its folder exists; module: the
--                                  part of the path that is the module's name
--   skip(path)             the script itself writes the file
local note, skip = ...

local function noted(read)
  return function(path, ...)
    if type(path) == "string" then note(path) end
    return read(path, ...)
  end
end

-- Wraps functions that raise errors themselves: the error gets the position of the script's line.
local function placed(read)
  read = noted(read)
  return function(...)
    local results = table.pack(pcall(read, ...))
    if not results[1] then error(results[2], 2) end
    return table.unpack(results, 2, results.n)
  end
end

io.lines, io.input, loadfile, dofile = placed(io.lines), placed(io.input), noted(loadfile), noted(dofile)

local open = io.open
function io.open(path, ...)
  local mode = ...
  if type(path) == "string" then
    local tell = type(mode) == "string" and mode:find "[wa+]" and skip or note
    tell(path)
  end
  return open(path, ...)
end

-- A module that is not found may later appear in any of the places searched.
local search = package.searchers[2]
package.searchers[2] = function(name)
  if type(package.path) == "string" then
    local found = package.searchpath(name, package.path)
    local part = name:gsub("%.", "/")
    for template in package.path:gmatch "[^;]+" do
      local path = template:gsub("%?", function() return part end)
      note(path, true, part)
      if path == found then break end
    end
  end
  return search(name)
end
