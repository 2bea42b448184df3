-- glint.ease and glint.keys: values in closed form, ends, vectors and lists, cycles, splines, and refused values.
package.path = "tests/lua/?.lua;" .. package.path
local glint = require "glint"
local tally = require "tally"
local check = tally.check
local ease, keys = glint.ease, glint.keys

-- ---- ease ----

check(ease(0.25) == 0.15625 and ease(0.25, "smooth") == 0.15625, "3/16 - 1/32: %.17g", ease(0.25))
check(ease(0.5, "smoother") == 0.5 and ease(0.25, "smoother") == 0.103515625, "%.17g", ease(0.25, "smoother"))
check(ease(0.25, "in") == 0.0625 and ease(0.25, "out") == 0.4375 and ease(0.25, "linear") == 0.25, "quadratic and linear")
for _, kind in ipairs { "linear", "smooth", "smoother", "in", "out" } do
  check(ease(0, kind) == 0 and ease(1, kind) == 1, "%s: its ends", kind)
  check(ease(-3, kind) == 0 and ease(7, kind) == 1 and ease(math.huge, kind) == 1, "%s: beyond them", kind)
  local before = 0
  for i = 1, 100 do
    check(ease(i / 100, kind) >= before, "%s rises at %g", kind, i / 100)
    before = ease(i / 100, kind)
  end
end

-- ---- keys ----

local ramp = keys { { 0, 10 }, { 1, 20 }, { 3, 0 }, ease = "linear" }
check(ramp(0) == 10 and ramp(0.5) == 15 and ramp(1) == 20 and ramp(2) == 10 and ramp(3) == 0, "numbers, one stretch after the other")
check(ramp(-1) == 10 and ramp(99) == 0, "before the first and after the last")
check(keys { { 0, 0 }, { 2, 8 } } (0.5) == 8 * 0.15625, "smooth where nothing is said")

local path = keys { { 0, { 1, 2, 3 } }, { 1, { 3, 2, 1 } }, ease = "linear" }
local middle = path(0.5)
check(middle.x == 2 and middle.y == 2 and middle.z == 2, "a vector: %s", tostring(middle))
check(path(0.5) == glint.camera { eye = { 2, 2, 2 }, at = { 0, 0, 0 } }.eye, "of the kind that objects have")
check(keys { { 0, path(0) }, { 1, path(1) } } (0).z == 3, "vectors as values")
local pair = keys { { 0, { 1, 10 } }, { 2, { 3, 30 } }, ease = "linear" } (1)
check(#pair == 2 and pair[1] == 2 and pair[2] == 20, "a list of two")

local round = keys { { 0, 0 }, { 1, 5 }, { 4, 0 }, ease = "linear", cyclic = true }
check(round(4) == 0 and round(5) == 5 and round(-3) == 5 and round(400.5) == 2.5, "a cycle: %g %g %g", round(5), round(-3), round(400.5))

-- ---- Splines ----

local line = keys { { 0, 1 }, { 0.5, 2 }, { 2, 5 }, { 3, 7 }, ease = "spline" }
for i = 0, 30 do check(math.abs(line(i / 10) - (1 + 2 * i / 10)) < 1e-14, "what is straight stays straight: %.17g", line(i / 10)) end
local hill = keys { { 0, 0 }, { 1, 1 }, { 2, 0 }, { 3, 1 }, ease = "spline" }
check(hill(1) == 1 and hill(2) == 0 and hill(1.5) == 0.5, "through its keys")
-- Hermite's form at 1/2: (a + b)/2 + (m0 - m1)/8, with slopes 1 at the end and 0 at the key.
check(hill(0.5) == 0.5 + 1 / 8, "slopes of the neighbours: %.17g", hill(0.5))
local step = 2 ^ -20
for _, at in ipairs { 1, 2 } do
  check(math.abs((hill(at + step) - hill(at)) - (hill(at) - hill(at - step))) < 1e-9, "no corner at %g", at)
end
local wheel = keys { { 0, 0 }, { 1, 1 }, { 2, 0 }, { 3, -1 }, { 4, 0 }, ease = "spline", cyclic = true }
check(math.abs((wheel(4 + step) - wheel(4)) - (wheel(4) - wheel(4 - step))) < 1e-9, "nor where the cycle begins again")

-- ---- Refused values ----

local function refuses(message, call, ...)
  local ok, got = pcall(call, ...)
  check(not ok and tostring(got):find(message, 1, true), "%q expected, got %s", message, tostring(got))
end

refuses("ease: number expected, got string \"a\"", ease, "a")
refuses("ease: number that is not NaN expected", ease, 0 / 0)
refuses("ease: kind: one of 'linear', 'smooth', 'smoother', 'in', 'out' expected, got string \"bounce\"", ease, 0, "bounce")
refuses("keys: list of {time, value} expected", keys, 5)
refuses("keys: two keys or more expected, got 1", keys, { { 0, 1 } })
refuses("keys[2]: {time, value} expected, got 7", keys, { { 0, 1 }, 7 })
refuses("keys[2]: {time, value} expected", keys, { { 0, 1 }, { 1, 2, 3 } })
refuses("keys[2]: a time after 0.5 expected, got 0.25", keys, { { 0.5, 1 }, { 0.25, 2 } })
refuses("keys[2]: expected a value of the same type and length as the first key's", keys, { { 0, 1 }, { 1, { 1, 2, 3 } } })
refuses("keys[1]: number, vector or list of up to 16 numbers expected", keys, { { 0, "red" }, { 1, "blue" } })
refuses("keys[2]: finite number expected, got inf", keys, { { 0, 1 }, { 1, math.huge } })
refuses("keys.eases: no such field; did you mean 'ease'?", keys, { { 0, 1 }, { 1, 2 }, eases = "in" })
refuses("keys.ease: one of", keys, { { 0, 1 }, { 1, 2 }, ease = "bounce" })
refuses("keys.cyclic: boolean expected, got 1", keys, { { 0, 1 }, { 1, 2 }, cyclic = 1 })
refuses("keys: number that is not NaN expected", ramp, 0 / 0)

tally.finish()
