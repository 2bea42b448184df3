-- Runs in the watched script's state before the script does, and tells the watcher which files it is about to read.
--   note(path, optional, module)   the file decides the picture; optional: only where its folder exists; module: the
--                                  part of the path that stands for the name of a module
--   skip(path)             the script writes the file itself
local note, skip = ...

local function noted(read)
  return function(path, ...)
    if type(path) == "string" then note(path) end
    return read(path, ...)
  end
end

-- The same for functions that raise errors themselves: the error belongs to the line of the script.
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

-- A module that is not found may appear in any of the places that were searched.
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
