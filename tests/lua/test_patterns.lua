-- Patterns and shaders: functions traced to programs, against the same functions run by plain Lua.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"
local V = glint.vector

local function bits(x) return x ~= x and "nan" or string.pack("<d", x) end

local random = dofile "tests/lua/random_functions.lua"(math.random)

local function compare(f, text)
  local got, wrong = random.compare(f, text)
  check(got, "%s", wrong)
  return got
end

-- A child process with another instruction set runs this and must print the same text.
if arg[1] == "digest" then
  math.randomseed(7)
  local sums = {}
  for _ = 1, 500, tally.step do
    local f, text = random.make()
    local got = compare(f, text)
    if got then sums[#sums + 1] = bits(got.x) .. bits(got.y) .. bits(got.z) end
  end
  for _, sum in ipairs(sums) do
    io.write((sum:gsub(".", function(c) return ("%02x"):format(c:byte()) end)), "\n")
  end
  os.exit(tally.failed == 0)
end

local tests = {}

function tests.random_functions_have_the_bits_of_plain_lua()
  math.randomseed(14)
  for _ = 1, 10000, tally.step do
    local f, text = random.make()
    compare(f, text)
  end
end

function tests.instruction_sets_agree()
  local results = {}
  for _, name in ipairs(tally.instruction_sets) do
    local pipe = assert(io.popen(("GLINT_ISA=%s %s %s digest 2>&1"):format(name, arg[-1] or "lua5.4", arg[0])))
    local text = pipe:read "a"
    pipe:close()
    if not text:find("GLINT_ISA", 1, true) then
      results[#results + 1] = name
      results[name] = text
      check(#text * tally.step > 500 * 9, "%s: %s", name, text:sub(1, 300))
      check(text == results.ref, "%s and ref give the same bits", name)
    end
  end
  check(#results >= 2, "some instruction sets were compared")
end

-- ---- Operations on numbers and vectors ----

function tests.operations_take_plain_numbers()
  check(glint.floor(2.5) == 2 and glint.ceil(2.5) == 3 and glint.round(-2.5) == -3 and glint.fract(2.25) == 0.25)
  check(glint.mod(-7, 3) == 2 and glint.mod(5.5, -2) == 5.5 % -2 and glint.sign(-3) == -1 and glint.abs(-0.0) == 0)
  check(glint.mix(2, 4, 0.25) == 2.5 and glint.clamp(7, 0, 1) == 1 and glint.smoothstep(0, 1, 0.5) == 0.5)
  check(glint.select(glint.less(1, 2), 5, 6) == 5 and glint.select(0, 5, 6) == 6 and glint.step(1, 0.5) == 0)
  check(glint["and"](1, 0) == 0 and glint["or"](1, 0) == 1 and glint["not"](0) == 1)
  check(glint.muladd(2, 3, 4) == 10 and glint.submul(10, 2, 3) == 4 and glint.mulsub(2, 3, 4) == 2)
  check(math.abs(glint.sin(0.5) - math.sin(0.5)) < 1e-8 and math.abs(glint.atan2(1, -1) - 3 * math.pi / 4) < 1e-8)
  check(glint.pow(2, 10) == 1024 and math.abs(glint.log2(8) - 3) < 1e-8 and math.abs(glint.acos(0) - math.pi / 2) < 1e-8)
  check(glint.noise(1, 2, 3) == 0 and glint.noise({ 1, 2, 3 }) == 0 and glint.noise { x = 0.5, y = 0.25, z = 0.125 } ~= 0)
  check(glint.noise3(V(0.3, 0.4, 0.5)).x ~= glint.noise3(V(0.3, 0.4, 0.5)).y)
  local first, second = glint.cell(V(0.3, 0.4, 0.5))
  check(first >= 0 and second >= first)
  check(glint.hash(1, 2, 3) ~= glint.hash(1, 2, 4) and glint.hash(1, 2, 3) == glint.hash { 1, 2, 3 })
end

-- These operations take symbols while a pattern is traced, and plain numbers when it runs at the 64 test points.
function tests.exp_log_tan_min_and_max_take_symbols()
  local at = { p = { 0.3, 1.2, -0.7 } }
  local function value(f) return glint.pattern(f):evaluate(at).x end
  check(math.abs(value(function(p) return glint.exp(p.x) end) - math.exp(0.3)) < 1e-7)
  check(math.abs(value(function(p) return glint.log(p.y) end) - math.log(1.2)) < 1e-7)
  check(math.abs(value(function(p) return glint.tan(p.z) end) - math.tan(-0.7)) < 1e-7)
  check(value(function(p) return glint.min(p.x, p.y, p.z, 5) end) == -0.7)
  check(value(function(p) return glint.max(p.x, 0, p.y) end) == 1.2)
  check(glint.max(1, 7, 3, 5) == 7 and glint.min(V(1, 5, 3), 4, 2) == V(1, 2, 2))
  check(glint.exp(0.5) == glint.exp(0.5) and math.abs(glint.exp(V(0, 1, 2)).z - math.exp(2)) < 1e-6)
end

function tests.evaluate_takes_both_names()
  local shade = glint.shader(function(s) return s.n:dot(s.l) + s.v.z end)
  local short = shade:evaluate { n = { 0, 0, 1 }, l = { 0, 0.6, 0.8 }, v = { 0.6, 0, 0.8 } }.diffuse
  check(short == shade:evaluate { normal = { 0, 0, 1 }, to_light = { 0, 0.6, 0.8 }, to_eye = { 0.6, 0, 0.8 } }.diffuse)
  check(math.abs(short.x - 1.6) < 1e-12)
  local matt = glint.material { diffuse = 0.5 }
  check(matt:evaluate { n = { 0, 0, 1 }, l = { 0, 0, 1 }, v = { 0, 0, 1 } }.diffuse
    == matt:evaluate { normal = { 0, 0, 1 }, to_light = { 0, 0, 1 }, to_eye = { 0, 0, 1 } }.diffuse)
  check(glint.shader(function(s) return s.normal.z end):evaluate { n = { 0, 0, 1 } }.diffuse.x == 1)
end

function tests.operations_take_vectors()
  local v = glint.mix({ 1, 2, 3 }, V(3, 2, 1), 0.5)
  check(v.x == 2 and v.y == 2 and v.z == 2)
  check(glint.max(V(1, 5, 3), 2) == V(2, 5, 3))
  check(glint.select(1, 0.9, { 0.1, 0.1, 0.2 }) == V(0.9, 0.9, 0.9))
  check(glint.mix("black", "white", 0.5) == V(0.5, 0.5, 0.5))
  local a, b = V(1, 2, 3), { 4, 5, 6 }
  check(a:dot(b) == 32 and glint.dot(a, b) == 32 and a:cross(b) == V(-3, 6, -3))
  check(V(3, 0, 4):length() == 5 and V(0, 0, 2):unit() == V(0, 0, 1))
  check(glint.reflect({ 1, -1, 0 }, { 0, 1, 0 }) == V(1, 1, 0))
  check(a + 1 == V(2, 3, 4) and 2 * a == V(2, 4, 6) and a * b == V(4, 10, 18) and -a == V(-1, -2, -3))
  check(b - a == V(3, 3, 3) and a % 2 == V(1, 0, 1) and a // 2 == V(0, 1, 1) and a ^ 2 == V(1, 4, 9))
  check(a.r == 1 and a.g == 2 and a.b == 3 and a.u == 1 and a.v == 2 and a[1] == 1 and a[3] == 3 and a[4] == nil and #a == 3)
  check(select("#", a:unpack()) == 3 and tostring(V(1, 2.5, 3)) == "{1, 2.5, 3}")
  local center = glint.sphere { center = { 1, 2, 3 }, radius = 1 }.center
  check(center + a == V(2, 4, 6) and a * center == V(1, 4, 9) and center:dot(a) == 14 and center:unit():dot(center:unit()) > 0.99)
  local ball = glint.sphere { center = a, radius = 1 }
  check(ball.center.y == 2, "a vector of numbers is taken where {x, y, z} is")
end

function tests.checker_is_the_parity_of_floors()
  math.randomseed(3)
  for _ = 1, 1000 do
    local p = random.vector(random.any { 1, 20, 1e3, 1e7 })
    check(glint.checker(p) == (math.floor(p.x) + math.floor(p.y) + math.floor(p.z)) % 2)
    check(glint.stripe(p.x) == math.floor(p.x) % 2)
  end
end

-- Compares with sums over the footprint, a box in x and y. All points have one z: cells next to it in z do not count.
function tests.footprints_are_box_integrals()
  math.randomseed(5)
  for _ = 1, 100 do
    local x, y, w = 10 * math.random() - 5, 10 * math.random() - 5, 3 * math.random() + 0.01
    local n, stripe, brick_x, brick_y = 400, 0, 0, 0
    local odd = math.floor(y) % 2
    for i = 1, n do
      local xi, yi = x + w * ((i - 0.5) / n - 0.5), y + w * ((i - 0.5) / n - 0.5)
      stripe = stripe + math.floor(xi) % 2 / n
      brick_x = brick_x + ((xi + odd / 2 - 0.1) % 1 < 0.9 and 1 or 0) / n
      brick_y = brick_y + ((yi - 0.1) % 1 < 0.9 and 1 or 0) / n
    end
    local stripe_y = 0
    for i = 1, n do stripe_y = stripe_y + math.floor(y + w * ((i - 0.5) / n - 0.5)) % 2 / n end
    local checker = (1 - (1 - 2 * stripe) * (1 - 2 * stripe_y)) / 2
    tally.near(glint.stripe(x, w), stripe, 0.02, "stripe")
    tally.near(glint.checker(V(x, y, 0), w), checker, 0.02, "checker")
    tally.near(glint.brick(V(x, y, 0), 0.1, w), brick_x * brick_y, 0.02, "brick")
  end
  check(glint.checker(V(0.5, 1.5, 0), 0) == 1 and glint.stripe(1.5, 0) == 1, "no footprint: as it is")
  local far = V(1e7 + 0.5, 0, 0.5)
  tally.near(glint.checker(far, 0.125), glint.checker(far), 0, "far from the origin")
end

-- ---- The traced function ----

function tests.a_pattern_of_numbers_is_a_constant()
  local pattern = glint.pattern(function() return 0.8 end)
  check(#pattern == 0 and pattern:evaluate { p = { 1, 2, 3 } }.x == 0.8)
  check(#glint.pattern(function() return glint.mix(0.5, { 1, 2, 3 }, glint.noise(0.5, 0.1, 0.2)) end) == 0)
end

function tests.upvalues_are_seen_again()
  local factor = 2
  local pattern = glint.pattern(function(p) return factor * p.x end)
  check(pattern:evaluate { p = { 3, 0, 0 } }.x == 6)
  factor = 5
  check(pattern:evaluate { p = { 3, 0, 0 } }.x == 15)
end

function tests.what_is_the_same_is_computed_once()
  check(#glint.pattern(function(p) return glint.sqrt(p.x) + glint.sqrt(p.x) end) == 2)
  local text = tostring(glint.pattern(function(p) return glint.noise(p * 3) end))
  check(text:find "^pattern of %d+ instructions?\n" and text:find "noise", "%s", text)
end

function tests.patterns_can_be_called_within_others()
  local inner = glint.pattern(function(p) return p.x + 1 end)
  local outer = glint.pattern(function(p, s) return 2 * inner(p * 10, s) end)
  check(outer:evaluate { p = { 1, 0, 0 } }.x == 22 and inner(V(4, 0, 0)) == 5)
end

function tests.shaders_have_the_light()
  local shader = glint.shader(function(s)
    return s.kd * s.light * s.n:dot(s.l), s.ks * glint.highlight(glint.reflect(-s.l, s.n):dot(s.v), s.shininess)
  end)
  local got = shader:evaluate { n = { 0, 0, 1 }, l = { 0, 0.6, 0.8 }, v = { 0, -0.6, 0.8 }, light = { 2, 1, 0 }, kd = 0.5, ks = { 1, 0, 1 }, shininess = 8 }
  check(got.diffuse.r == 0.5 * 2 * 0.8 and got.diffuse.g == 0.5 * 0.8 and got.diffuse.b == 0)
  check(got.specular.r > 0.99 and got.specular.g == 0)
  local toon = glint.shader(function(s) return s.kd * s.light * glint.select(glint.less(0.4, s.n:dot(s.l)), 1, 0.3) end)
  check(toon:evaluate { kd = 1, l = { 0, 0.6, 0.8 } }.diffuse.x == 1 and toon:evaluate { kd = 1, l = { 0, 1, 0 } }.diffuse.x == 0.3)
end

-- ---- Errors ----

local HERE = "test_patterns.lua"

-- Checks that the message names this file and the line of f (`line` after that of `make`) and that it contains `want`.
local function raises(want, make, call)
  local line = debug.getinfo(make, "S").linedefined
  local last = debug.getinfo(make, "S").lastlinedefined
  local good, message = pcall(call or function() return #glint.pattern(make) end)
  message = tostring(message)
  local at = tonumber(message:match(HERE:gsub("%.", "%%.") .. ":(%d+): "))
  check(not good and message:find(want, 1, true), "'%s' expected, got %s", want, message)
  check(at and at >= line and at <= last, "line %d .. %d expected, got %s", line, last, message)
end

function tests.errors_tell_the_place_and_the_cure()
  raises("glint.select(glint.less(a, b), x, y)", function(p) if p.x < 0 then return 1 end return 0 end)
  raises("glint.select(glint.less(a, b), x, y)", function(p) return p.x > p.y and 1 or 0 end)
  raises("glint.select(glint.lesseq(a, b), x, y)", function(p) return 3 >= p.x and 1 or 0 end)
  raises("glint.select(glint.equal(a, b), x, y)", function(p) return p.x == p.y and 1 or 0 end)
  raises("glint.select(glint.equal(a.x, b.x), x, y)", function(p, s) return p == s.n and 1 or 0 end)
  raises("it cannot become text", function(p) return p.x .. "" end)
  raises("it cannot become text", function(p) return "a" .. p end)
  raises("glint.length(v)", function(p) return #p.x end)
  raises("a symbol has no value yet; write glint.", function(p) local x = math.sin(p.x) return x end)
  raises("a symbol has no value yet; write glint.", function(p) return math.sin(p.x) end)
  raises("a symbol has no value yet; write glint.", function(p) return math.abs(p) end)
  raises("a symbol has no value yet; write glint.", function(p) return math.floor(p.x) + 1 end)
  raises("vector.w: no such field", function(p) return p.w end)
  raises("vector.lenght: no such field; did you mean 'length'?", function(p) return p:lenght() end)
  raises("s.norml: no such field", function(_, s) return s.norml end)
  raises("s.light: a pattern has no light", function(_, s) return s.light end)
  raises("is a variable or a field not set?", function(p) return p.x + rawget(p, "q") end)
  raises("is a variable or a field not set?", function(p) return glint.mix(p.x, nil, 1) end)
  raises("symbol.x: a symbol is one number", function(p) return p.x.x end)
  raises("it is a number, not a function", function(p) return p.x(3) end)
  raises("it is not an integer", function(p) return p.x & 1 end)
  local own
  own = glint.pattern(function() return #own end)
  local _, message = pcall(function() return #own end)
  check(select(2, message:gsub("endlessly", "")) == 1, "a pattern of itself has one cure, got %s", message)
  raises("functions call each other endlessly", function(p)
    local round
    round = glint.pattern(function(q) return round(q) end)
    return round(p)
  end)
  raises("a loop needs plain numbers", function(p) local t = 0 for i = 1, p.x do t = t + i end return t end)
  raises("a + b: number, symbol or vector expected, got string \"1\"", function(p) return p.x + "1" end)
  raises("noise: expected a vector, or x, y and z", function(p) return glint.noise(p.x) end)
  raises("mix: 3 arguments expected, got 2", function(p) return glint.mix(p.x, 1) end)
  raises("is a return missing,", function(p) local _ = p.x end)
  raises("or \"#rrggbb\" expected, got string \"hello\"", function() return "hello" end)
  raises("a vector of three, got a table that is not a vector", function(p) return { p.x, 2 } end)
  raises("pattern: the function must return one value, got 3; a colour is glint.vector", function(p) return p.x, p.y, p.z end)
  raises("math.min of a symbol: its value is not known, because the function runs once for all points; write glint.min",
    function(p) return math.min(p.x, 1) end)
  raises("a symbol has no value yet; write glint.exp", function(p) return math.exp(p.x) end)
  raises("a symbol has no value yet; write a % b", function(p) return math.fmod(p.x, 1) end)
  raises("a table cannot be indexed by a value that depends on the point; use glint.select", function(p)
    local list = { 0.1, 0.2 }
    return list[glint.floor(p.x)] * 2
  end)
  raises("or a table indexed by a value of the point?", function(p) return ({ 1 })[glint.floor(p.x)] end)
  raises("got s, the values of the point", function(x, y) return x + y end)
  raises("is a loop endless? In Lua, a comparison", function(p)
    local x = p.x
    while glint.less(x, 4) do x = x + 1 end
    return x
  end)
  raises("length: a vector expected, got no value; a method takes a colon: v:length()", function(p) return p.length() end)
  raises("a pattern must not change objects", function(p)
    local m = glint.material {}
    m.diffuse = 1
    return p.x
  end)
end

function tests.programs_are_limited()
  raises("4096", function(p)
    local sum = p.x
    for i = 1, 5000 do sum = sum + p.y * i end
    return sum
  end)
end

function tests.symbols_do_not_outlive_their_call()
  local kept
  local first = glint.pattern(function(p) kept = kept or p.x return 1 end)
  check(#first == 0)
  local second = glint.pattern(function(p) return p.x + kept end)
  local good, message = pcall(function() return #second end)
  check(not good and tostring(message):find "a symbol of another call", "%s", message)
  check(not pcall(function() return kept + 1 end))
end

-- ---- The 64 test points ----

local function is_found(f)
  local line = debug.getinfo(f, "S").linedefined
  local good, message = pcall(function() return #glint.pattern(f) end)
  local says = "the Lua function gives [-%d.e+]+, the compiled program [-%d.e+]+ at %(.*%): does the function have an `if`, `and` or `or`"
  check(not good and tostring(message):find(says), "%s", message)
  check(tostring(message):find(HERE .. ":" .. line .. ": ", 1, true), "line %d: %s", line, message)
end

function tests.the_64_points_find_branches()
  is_found(function(p) if p.x // 1 % 2 == 0 then return 1 end return 0 end)
  is_found(function(p) return glint.less(p.x, 0) == 1 and p.y or p.z end)
  is_found(function(p) return glint.checker(p) ~= 0 and 0.9 or 0.1 end)
  is_found(function(p) return p.x + math.random() end)
  is_found(function() return math.random() end)
  is_found(function(p) return type(p.x) == "number" and p.x or p.y end)
  local calls = 0
  is_found(function(p) calls = calls + 1 return p.x + calls end)
end

-- In Lua both 0 and symbols are true, so none of the 64 test points reveals these mistakes.
local function is_refused(f)
  raises("an `if`, `and` or `or` on this value", f)
end

function tests.branches_on_choices_are_refused()
  local less, select = glint.less, glint.select
  is_refused(function(p) if less(p.x, 0) then return 1 end return 0 end)
  is_refused(function(p) if less(p.x, 0) then return 1 end end)
  is_refused(function(p) return glint.checker(p) and p.y or p.z end)
  is_refused(function(p) if not glint.stripe(p.x) then return 1 end return p.y end)
  is_refused(function(p) return glint.brick(p) and 1 end)
  is_refused(function(p) if glint.parity(p) then return 1 end return 0 end)
  is_refused(function(p) if select(less(p.x, 1), 1, 0) and glint.step(p.x, 0) then return 1 end return 0 end)
  is_refused(function(p)
    local used = less(p.y, 2)
    if used and glint["or"](less(p.x, 0), used) then return used end
    return p.x
  end)
  is_refused(function(p) local n = 0 while less(p.x, n) and n < 3 do n = n + 1 end return n end)
  local good, message = pcall(function()
    return #glint.shader(function(s) if less(0.4, s.n:dot(s.l)) then return s.light end return s.light * 0.3 end)
  end)
  check(not good and tostring(message):find("on this value", 1, true), "%s", message)
end

function tests.choices_that_nothing_hangs_on_are_let_pass()
  local less, select, masked = glint.less, glint.select, true
  check(#glint.pattern(function(p) local _ = less(p.x, 0) return p.x end) == 0, "one that nothing uses")
  check(#glint.pattern(function(p) local _ = less(p.x, 0) * 2 + 1 return p.x end) == 0, "what is made of one, either")
  check(#glint.pattern(function(p) return select(masked and less(p.x, 0) or 1, p.y, p.z) end) == 2, "a default")
  check(#glint.pattern(function(p) return { less(p.x, 0), 0, glint.checker(p) } end) == 2, "in a vector")
  check(#glint.pattern(function(p) if less(1, 2) == 1 then return p.x end return p.y end) == 0, "of numbers")
  check(#glint.pattern(function(p)
    local sum = 0
    for i = 1, 1500 do sum = sum + less(p.x, i) end
    return sum
  end) > 1500, "many")
end

function tests.the_64_points_are_looked_at_once_a_structure()
  local calls, factor, extra = 0, 2, false
  local pattern = glint.pattern(function(p)
    calls = calls + 1
    return extra and p.x * factor + 1 or p.x * factor
  end)
  check(#pattern == 1 and calls == 65, "%d calls", calls)
  factor = 3
  check(#pattern == 1 and calls == 66, "another number: %d calls", calls)
  extra = true
  check(#pattern > 0 and calls == 66 + 65, "another operation: %d calls", calls)
end

function tests.powers_are_let_pass()
  for _, e in ipairs { 3, 4, 0.5, -1, -2, 1.7, 5, 20 } do
    local pattern = glint.pattern(function(p) return glint.abs(p.x) ^ e + p.y ^ 3 end)
    local got = pattern:evaluate { p = { 1.5, 2, 0 } }.x
    tally.near(got, 1.5 ^ e + 8, 1e-6 * 1.5 ^ e, "power " .. e)
  end
end

-- Regression: rounding moved means below 0 and above 1 by 1e-15.
function tests.means_of_tilings_stay_in_range()
  local least, most = math.huge, -math.huge
  math.randomseed(5)
  for _ = 1, 3000 do
    local p = V(math.random() * 20 - 10, math.random() * 20 - 10, math.random() * 20 - 10)
    local w = 10 ^ (3 * math.random() - 2.5)
    for _, value in ipairs { glint.checker(p, w), glint.stripe(p.x, w), glint.brick(p, 0.1, w), glint.brick(p, 0, w), glint.brick(p, 1, w) } do
      least, most = math.min(least, value), math.max(most, value)
    end
  end
  check(least >= 0 and most <= 1, "0 .. 1 expected, got %g .. 1 + %g", least, most - 1)
end

tests.run = nil
tally.run(tests)
tally.finish()
