-- Finds a scene's files. Some scenes expect the working directory to be their own folder, others its parent. Files that
-- a scene requires, runs or loads as a model are searched in its folder, the folder above, and the working directory;
-- files that it reads through io, in the working directory first.
local check = require "gr.check"
local glint = require "glint"
check.own_source()
local files = {}

local pairs, rawget, type = pairs, rawget, type
local open, concat, insert, remove = io.open, table.concat, table.insert, table.remove
local dofile, loadfile, raise = dofile, loadfile, check.raise

local running = {} -- paths of the scene and of files that it runs by dofile, innermost last
local folders = {} -- folders of these paths: "" or ending in a slash

local function folder_of(path) return path:match "^(.*/)" or "" end

local function add_folder(folder)
  for _, known in pairs(folders) do
    if known == folder then return end
  end
  insert(folders, folder)
  if not folder:find "[;?]" then
    package.path = ("%s?.lua;%s../?.lua;./?.lua;%s"):format(folder == "" and "./" or folder, folder, package.path)
  end
end

--- Makes the script at `path` the scene.
function files.begin(path)
  insert(running, path)
  add_folder(folder_of(path))
end

--- Returns the scene's paths, outermost first.
function files.running() return running end

local function can_read(path)
  if glint._other_kind(path) then return false end -- opening a pipe would block
  local file = open(path, "rb")
  local readable = file and file:read(0) ~= nil or file and file:seek "end" == 0 -- a folder can also be opened
  if file then file:close() end
  return readable
end

--- Returns the file's path, or nil and the places searched. here_first: searches the working directory first.
function files.find(path, here_first)
  local places = {}
  if here_first or path:sub(1, 1) == "/" then insert(places, path) end
  if path:sub(1, 1) ~= "/" then
    for i = #folders, 1, -1 do
      insert(places, folders[i] .. path)
      insert(places, folders[i] .. "../" .. path)
    end
    if not here_first then insert(places, path) end
  end
  for _, place in pairs(places) do
    if can_read(place) then return place end
  end
  return nil, concat(places, ", ")
end

--- Returns the whole text of a file, or nil.
function files.text(path)
  local file = open(path, "rb")
  local text = file and file:read "a"
  if file then file:close() end
  return text
end

local function run(path)
  local found = type(path) == "string" and files.find(path) or path
  if type(found) ~= "string" then return dofile(found) end
  local chunk, message = loadfile(found)
  if not chunk then raise("%s", message) end
  insert(running, found)
  add_folder(folder_of(found))
  local function leave(...)
    remove(running)
    return ...
  end
  return leave(chunk())
end

-- Searches the scene's folders when a file is not found for reading.
local function found_for_reading(path)
  return type(path) == "string" and files.find(path, true) or path
end

-- In Lua 5.0 `require "models/cow.lua"` named a file.
local function search_file(name)
  local found = name:find "%.lua$" and files.find(name)
  if not found then return nil end
  local chunk, message = loadfile(found)
  if not chunk then raise("%s", message) end
  return chunk, found
end

--- Adds the search to the functions that take file names.
function files.install()
  local io, lines, input = io, io.lines, io.input
  -- luacheck: push ignore 122
  _G.dofile = run
  _G.loadfile = function(path, ...) return loadfile(type(path) == "string" and files.find(path) or path, ...) end
  io.open = function(path, mode)
    local reads = mode == nil or type(mode) == "string" and not mode:find "[wa+]"
    return open(reads and found_for_reading(path) or path, mode)
  end
  io.lines = function(path, ...)
    if path == nil then return lines() end
    return lines(found_for_reading(path), ...)
  end
  io.input = function(path) return input(found_for_reading(path)) end
  -- luacheck: pop
  insert(package.searchers, search_file)
  local script = rawget(_G, "arg")
  if type(script) == "table" and type(script[0]) == "string" then files.begin(script[0]) end
end

return files
