-- Names for the operations of combined solids in the variants of the dialect.
local check = require "gr.check"
check.own_source()
local operations = {}

local lower, pairs, type = string.lower, pairs, type

local NAMES = {}
for operation, words in pairs {
  union = { "+", "u", "union" },
  intersection = { "*", "i", "inter", "intersect", "intersection", "conjunction" },
  difference = { "-", "d", "diff", "difference", "subtract", "subtraction" },
} do
  for _, word in pairs(words) do NAMES[word] = operation end
end

--- Returns "union", "intersection" or "difference" for one of the words, in any case.
function operations.of(call, word)
  return type(word) == "string" and NAMES[lower(word)]
    or check.refuse(call, "operation", '"+", "*", "-", "union", "intersection" or "difference"', word)
end

-- Names of functions, and the operations that they mean.
operations.calls = {}
for word, operation in pairs(NAMES) do
  if #word > 1 then
    operations.calls[word], operations.calls["csg_" .. word] = operation, operation
  end
end

return operations
