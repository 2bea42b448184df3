--- Random functions for patterns, against the same functions run by plain Lua.
---   dofile "tests/lua/random_functions.lua"(random)    `random` needs these two forms of math.random:
---                                                      () for 0 .. 1, (n) or (a, b) for an integer
local glint = require "glint"
local V = glint.vector

return function(random)
  local function bits(x) return x ~= x and "nan" or string.pack("<d", x) end

  local function any(list) return list[random(#list)] end

  local UNARY = { "abs", "sqrt", "floor", "ceil", "round", "fract", "sign", "not", "sin", "cos", "exp2", "log2", "acos" }
  local BINARY = { "add", "sub", "mul", "div", "mod", "min", "max", "less", "lesseq", "equal", "and", "or", "step", "pow",
    "atan2", "highlight" }
  local TERNARY = { "muladd", "submul", "mulsub", "mix", "select", "smoothstep", "clamp" }
  local OPERATORS = { "+", "-", "*", "/", "%", "//" }
  local LEAVES = { "p.x", "p.y", "p.z", "s.n.x", "s.v.z", "s.uv.u", "s.uv.v", "s.footprint", "s.world.y", "upvalue" }
  local NUMBERS = { "0.0", "1.0", "-1.0", "0.5", "2.0", "3.25", "-7.1", "1e-3", "1e7", "0.1" }

  local scalar, vector

  function scalar(depth)
    local kind = depth > 0 and random(11) or random(2)
    local function next_scalar() return scalar(depth - 1) end
    if kind == 1 then return any(NUMBERS)
    elseif kind == 2 then return any(LEAVES)
    elseif kind <= 4 then return ("(%s %s %s)"):format(next_scalar(), any(OPERATORS), next_scalar())
    elseif kind == 5 then return ("(- %s)"):format(next_scalar())
    elseif kind == 6 then return ("(%s) ^ 2"):format(next_scalar())
    elseif kind == 7 then return ("glint['%s'](%s)"):format(any(UNARY), next_scalar())
    elseif kind == 8 then return ("glint['%s'](%s, %s)"):format(any(BINARY), next_scalar(), next_scalar())
    elseif kind == 9 then return ("glint.%s(%s, %s, %s)"):format(any(TERNARY), next_scalar(), next_scalar(), next_scalar())
    elseif kind == 10 then
      return (any { "glint.noise(%s)", "glint.hash(%s)", "glint.parity(%s)", "glint.checker(%s, 0.3)", "glint.brick(%s, 0.1, 0.01)",
        "%s.y", "%s:length()", "(glint.cell(%s))", "(select(2, glint.cell(%s)))" }):format(vector(depth - 1))
    end
    return ("%s:dot(%s)"):format(vector(depth - 1), vector(depth - 1))
  end

  function vector(depth)
    local kind = depth > 0 and random(8) or 1
    if kind == 1 then return any { "p", "s.n", "s.world", "V(1.0, 2.0, 3.0)" }
    elseif kind == 2 then return ("V(%s, %s, %s)"):format(scalar(depth - 1), scalar(depth - 1), scalar(depth - 1))
    elseif kind == 3 then return ("(%s %s %s)"):format(vector(depth - 1), any(OPERATORS), scalar(depth - 1))
    elseif kind == 4 then return ("(%s %s %s)"):format(scalar(depth - 1), any(OPERATORS), vector(depth - 1))
    elseif kind == 5 then return ("glint.mix(%s, { 0.25, 1.5, %s }, %s)"):format(vector(depth - 1), scalar(depth - 1), scalar(depth - 1))
    elseif kind == 6 then return ("glint.noise3(%s)"):format(vector(depth - 1))
    elseif kind == 7 then return ("%s:cross(%s)"):format(vector(depth - 1), vector(depth - 1))
    end
    return ("%s:unit()"):format(vector(depth - 1))
  end

  local function make_function()
    local text = random() < 0.5 and scalar(5) or vector(5)
    return assert(load("local p, s = ...; return " .. text, text, "t", { glint = glint, V = V, upvalue = 0.75, select = select })), text
  end

  local function random_vector(size)
    return V(size * (2 * random() - 1), size * (2 * random() - 1), size * (2 * random() - 1))
  end

  local SIZES = { 1, 20, 1e3, 1e7 }

  local function random_point()
    local size = any(SIZES)
    local p = random() < 0.2 and V(random(-9, 9) + 0.0, 0.0, random(-9, 9) + 0.0) or random_vector(size)
    return { p = p, world = random_vector(size), n = random_vector(1):unit(), v = random_vector(1):unit(),
      uv = V(random(), random(), 0), footprint = random() / 10 }
  end

  -- Converts a number or a vector to three components.
  local function parts(value)
    if type(value) == "number" then return { value, value, value } end
    return { value.x, value.y, value.z }
  end

  --- Compares the pattern with f at a random point. Returns the value, or nil and a message.
  local function compare(f, text)
    local pattern = glint.pattern(function(p, s) return f(p, s) end)
    local point = random_point()
    local good, got = pcall(pattern.evaluate, pattern, point)
    if not good then return nil, ("%s: %s"):format(text, got) end
    local want = parts(f(point.p, point))
    for i = 1, 3 do
      if bits(got[i]) ~= bits(want[i]) then
        return nil, ("%s\n  at %s, s.world %s: plain Lua %.17g, the program %.17g"):format(text, point.p, point.world, want[i], got[i])
      end
    end
    return got
  end

  return { make = make_function, compare = compare, vector = random_vector, any = any }
end
