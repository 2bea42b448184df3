-- Prints the leading comment of a script and its parameters, for people or as JSON (glint describe).
local the = ...
local json = the.json

-- Returns the leading comment of the file without its dashes.
local function comment_of(path)
  local file <close> = assert(io.open(path)) -- the script has run, so it exists
  local out, is_block = {}, false
  for line in file:lines() do
    line = line:gsub("\r+$", "")
    local opens = #out == 0 and line:sub(1, 4) == "--[["
    if is_block or opens then
      is_block = true
      line = opens and line:sub(5) or line
      local last = line:match "^(.-)%]%]"
      out[#out + 1] = last or line
      if last then break end
    elseif line:sub(1, 2) == "--" then
      out[#out + 1] = line:match "^%-%- ?(.*)"
    elseif #out > 0 or line:sub(1, 1) ~= "#" then -- a line for the shell
      break
    end
  end
  return table.concat(out, "\n"):match "^(.-)\n*$"
end

local function listed(values, spell, between)
  local out = {}
  for i, value in ipairs(values) do out[i] = spell(value) end
  return table.concat(out, between)
end

local FIELDS <const> = { "name", "type", "default", "value", "min", "max", "whole", "drag", "unit", "label", "doc" }

-- Returns the parameters as a JSON list.
function the.params(params)
  local list = {}
  for i, spec in ipairs(params) do
    local out = {}
    for _, name in ipairs(FIELDS) do
      local value = spec[name]
      if value ~= nil then
        local is_list = spec.type == "point" and (name == "default" or name == "value")
        out[#out + 1] = json(name) .. ":" .. (is_list and "[" .. value .. "]" or json(value))
      end
    end
    if spec.choices then out[#out + 1] = '"choices":[' .. listed(spec.choices, json, ",") .. "]" end
    if spec.names then out[#out + 1] = '"names":[' .. listed(spec.names, json, ",") .. "]" end
    list[i] = "{" .. table.concat(out, ",") .. "}"
  end
  return "[" .. table.concat(list, ",") .. "]"
end

function the.event(what)
  return '{"event":"description","script":' .. json(what.script) .. ',"doc":' .. json(comment_of(what.path))
    .. ',"params":' .. the.params(what.params) .. "}\n"
end

function the.people(what)
  local comment = comment_of(what.path)
  local out = { comment ~= "" and comment .. "\n\n" or "",
    #what.params > 0 and "Parameters, set by --set name=value:\n" or what.script .. " has no parameters.\n" }
  for _, spec in ipairs(what.params) do
    local range = (spec.min or spec.max) and ("  %s .. %s"):format(spec.min or "", spec.max or "") or ""
    if spec.whole then range = range .. "  whole" end
    if spec.unit then range = range .. "  " .. spec.unit end
    out[#out + 1] = ("  %-22s%s%s%s\n"):format(spec.name .. "=" .. tostring(spec.value), range,
      spec.choices and "  " .. listed(spec.choices, tostring, "|") or "", spec.doc and "  " .. spec.doc or "")
  end
  return table.concat(out)
end
