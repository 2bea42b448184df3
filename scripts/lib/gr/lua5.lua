-- Functions of Lua 5.0 to 5.3 that scenes of those years use. A name is only defined if it does not exist.
local check = require "gr.check"
check.own_source()

local floor, fmod, exp, log, mathtype, tointeger = math.floor, math.fmod, math.exp, math.log, math.type, math.tointeger
local format, next, pairs, rawget, select, tonumber, type = string.format, next, pairs, rawget, select, tonumber, type
local getinfo, getupvalue, upvaluejoin, setmetatable = debug.getinfo, debug.getupvalue, debug.upvaluejoin, setmetatable

local function largest_index(list)
  local largest = 0
  for key in pairs(list) do
    if type(key) == "number" and key > largest then largest = key end
  end
  return largest
end

local function foreach(list, call)
  for key, value in pairs(list) do
    local result = call(key, value)
    if result ~= nil then return result end
  end
end

local function foreachi(list, call)
  for i = 1, #list do
    local result = call(i, list[i])
    if result ~= nil then return result end
  end
end

-- x = m * 2^e with 0.5 <= |m| < 1.
local function frexp(x)
  if x == 0 or x ~= x or x == x + x then return x, 0 end
  local m, e = x, 0
  while m >= 1 or m <= -1 do m, e = m / 2, e + 1 end
  while m < 0.5 and m > -0.5 do m, e = m * 2, e - 1 end
  return m, e
end

-- As in Lua 5.1: from here on the calling file's definitions go into a table of this name.
local function module(name, ...)
  local space = package.loaded[name]
  if type(space) ~= "table" then
    space = rawget(_G, name)
    if type(space) ~= "table" then space = {} end
  end
  space._NAME, space._M, package.loaded[name] = name, space, space
  local place, parent = _G, name:match "^(.*)%."
  for part in (parent or ""):gmatch "[^.]+" do
    if type(place[part]) ~= "table" then place[part] = {} end
    place = place[part]
  end
  place[name:match "[^.]*$"] = space
  for i = 1, select("#", ...) do (select(i, ...))(space) end
  local caller, i = getinfo(2, "f").func, 1
  while true do
    local upvalue = getupvalue(caller, i)
    if not upvalue then return end
    if upvalue == "_ENV" then break end
    i = i + 1
  end
  local environment = space
  upvaluejoin(caller, i, function() return environment end, 1)
end

local function seeall(space) return setmetatable(space, { __index = _G }) end

local ALIASES = {
  [_G] = { unpack = table.unpack, loadstring = load, module = module, table = table, math = math, string = string },
  [string] = { gfind = string.gmatch },
  [table] = {
    getn = function(list) return #list end,
    setn = function() end,
    maxn = largest_index,
    foreach = foreach,
    foreachi = foreachi,
  },
  [math] = {
    pow = function(x, y) return x ^ y end,
    mod = fmod,
    log10 = function(x) return log(x, 10) end,
    cosh = function(x) return (exp(x) + exp(-x)) / 2 end,
    sinh = function(x) return (exp(x) - exp(-x)) / 2 end,
    tanh = function(x)
      local e = exp(-2 * (x < 0 and -x or x))
      return (1 - e) / (1 + e) * (x < 0 and -1 or 1)
    end,
    frexp = frexp,
    ldexp = function(m, e) return m * 2.0 ^ e end,
  },
  [package] = { seeall = seeall },
}

-- Numbers were truncated where whole numbers are expected.
local function whole(value)
  local number = tonumber(value)
  if not number or mathtype(number) == "integer" or number ~= number then return value end
  return tointeger(number < 0 and -floor(-number) or floor(number)) or value
end

-- "%d" accepts any number, and "%u" exists.
local function lenient_format(pattern, ...)
  if type(pattern) ~= "string" or not pattern:find "%%[^%a%%]*[dicuoxX]" then return format(pattern, ...) end
  local values, place = { n = select("#", ...), ... }, 0
  pattern = pattern:gsub("(%%[-+ #0-9.]*)(.)", function(start, letter)
    if letter == "%" then return nil end
    place = place + 1
    if letter:find "[dicuoxX]" then values[place] = whole(values[place]) end
    return letter == "u" and start .. "d" or nil
  end)
  return format(pattern, table.unpack(values, 1, values.n))
end

local function install_numbers()
  local random, randomseed, unpack = math.random, math.randomseed, table.unpack
  local function cut(...)
    local values = { n = select("#", ...), ... }
    for i = 1, values.n do values[i] = whole(values[i]) end
    return unpack(values, 1, values.n)
  end
  -- luacheck: push ignore 122
  math.random = function(...) return random(cut(...)) end
  math.randomseed = function(...) return randomseed(cut(...)) end
  string.format = lenient_format
  -- luacheck: pop
end

--- Adds these functions to the globals and the libraries.
return function()
  for library, names in next, ALIASES do
    for name, value in pairs(names) do
      if rawget(library, name) == nil then library[name] = value end
    end
  end
  install_numbers()
end
