-- Detects from a scene's text to which of the course's two generations it belongs. In the first (Lua 5.0 and 5.1)
-- transforms were multiplied on the right, "post"; in the second (from about 2015) on the left, "pre".
--
-- The arguments of gr.mesh decide first: tables mean the first, a file name the second. Then table.unpack, which only
-- the second has; then a bare `unpack(` or a `require`, which only the first needed. Otherwise it is the second.
local check = require "gr.check"
local files = require "gr.files"
check.own_source()
local generation = {}

local ipairs, concat, pack = ipairs, table.concat, table.pack
local opinions = {} -- results by path

-- Returns the text with comments replaced by spaces and strings by "", except the names of our own modules.
local function bare(text)
  local out, at = {}, 1
  while at <= #text do
    local from = text:find("[%-\"'%[]", at)
    if not from then break end
    out[#out + 1] = text:sub(at, from - 1)
    local comment = text:match("^%-%-()", from)
    local level, body = text:match("^%[(=*)%[()", comment or from)
    local quote = text:match("^[\"']", from)
    if level then
      local _, stop = text:find("]" .. level .. "]", body, true)
      out[#out + 1] = comment and " " or '""'
      at = (stop or #text) + 1
    elseif comment then
      at = text:match("^[^\n]*()", comment)
    elseif quote then
      local stop = from + 1
      while stop <= #text and not text:find("^[" .. quote .. "\n]", stop) do
        stop = stop + (text:sub(stop, stop) == "\\" and 2 or 1)
      end
      local content = text:sub(from + 1, stop - 1)
      out[#out + 1] = (content == "gr" or content:find "^glint") and '"' .. content .. '"' or '""'
      at = stop + 1
    else
      out[#out + 1] = text:sub(from, from)
      at = from + 1
    end
  end
  out[#out + 1] = text:sub(at)
  return concat(out)
end

-- Returns the start of the second argument of the call whose parenthesis opens before `at`.
local function second_argument(text, at)
  local depth = 0
  while at <= #text do
    local c = text:sub(at, at)
    if c == "(" or c == "{" or c == "[" then
      depth = depth + 1
    elseif c == ")" or c == "}" or c == "]" then
      depth = depth - 1
      if depth < 0 then return nil end
    elseif c == "," and depth == 0 then
      return text:match("^%s*(.)", at + 1)
    end
    at = at + 1
  end
end

local function by_meshes(text)
  local tables, names = false, false
  for at in text:gmatch "gr%s*%.%s*mesh%s*%(()" do
    local first = second_argument(text, at)
    tables = tables or first == "{"
    names = names or first == '"'
  end
  return tables ~= names and (tables and 1 or 2) or nil
end

local function says_unpack(text)
  for at in text:gmatch "()%f[%w_.:]unpack%s*[%({\"]" do
    if not text:sub(at > 20 and at - 20 or 1, at - 1):find "function%s+$" then return true end
  end
  return false
end

local function requires(text)
  for after in text:gmatch "%f[%w_.:]require%f[^%w_]%s*(%(?%s*\"?%w*)" do
    if not after:find '"gr$' and not after:find '"glint' then return true end
  end
  return false
end

local function by_words(whole)
  local text = whole:gsub("unpack%s*or%s*table%s*%.%s*unpack", ""):gsub("table%s*%.%s*unpack%s*or%s*unpack", "")
  if text:find "table%s*%.%s*unpack" then return 2 end
  local serves_both = text ~= whole -- then a bare `unpack(` does not mean the first
  local modern = text:find "require%s*%(?%s*\"gr\"" -- written for this module, so its `require`s mean nothing
  return (not serves_both and says_unpack(text) or not modern and requires(text)) and 1 or nil
end

--- Returns the generation by meshes and by words: each 1, 2 or nil.
function generation.of_text(source)
  local text = bare(source)
  return by_meshes(text), by_words(text)
end

local function of_file(path)
  if not opinions[path] then
    local text = files.text(path)
    opinions[path] = text and pack(generation.of_text(text)) or {}
  end
  return opinions[path]
end

-- Returns 1 or 2, from the text of the calling file and of the files that run it, and from the picture's meshes.
local function of_caller(meshes)
  local paths, running = { check.caller() }, files.running()
  for i = #running, 1, -1 do paths[#paths + 1] = running[i] end
  local words
  for _, path in ipairs(paths) do
    local opinion = of_file(path)
    if opinion[1] then return opinion[1] end
    words = words or opinion[2]
  end
  return meshes or words or 2
end

--- Returns "post" or "pre". meshes: the generation by the picture's meshes: 1, 2 or nil.
function generation.order(meshes) return of_caller(meshes) == 1 and "post" or "pre" end

return generation
