-- Shared by the Lua tests: sets the module's path, counts checks, and prints the totals that run.sh reads.
package.cpath = (os.getenv "BUILD" or "build") .. "/?.so;" .. package.cpath

local tally = { passed = 0, failed = 0 }
tally.instruction_sets = { "ref", "generic", "avx2", "avx512" } -- a machine or a build may lack the last ones

-- Tests of random cases run every step-th case. step is 1, or GLINT_CASE_STEP under a sanitizer, which looks for faults
-- of memory and arithmetic instead of wrong statistics.
tally.step = tonumber(os.getenv "GLINT_CASE_STEP" or 1)

-- Returns the side of a picture in pixels: n, or with a step so much less that the picture has n * n / step pixels.
function tally.side(n) return math.ceil(n / math.sqrt(tally.step)) end

-- Appends { "GLINT_ISA=NAME", options } for each instruction set to a list of runs, and returns the list.
function tally.with_sets(runs, options)
  for _, name in ipairs(tally.instruction_sets) do runs[#runs + 1] = { "GLINT_ISA=" .. name, options } end
  return runs
end

-- Counts a check. A failed check prints the formatted message and the line of the caller's caller.
local function count(ok, format, ...)
  if ok then
    tally.passed = tally.passed + 1
  else
    tally.failed = tally.failed + 1
    print(("not ok - %s (line %d)"):format(format:format(...), debug.getinfo(3, "l").currentline))
  end
end

-- Counts a check. A failed check prints the formatted message and the check's line.
function tally.check(ok, format, ...)
  count(ok, format, ...)
end

function tally.near(got, want, tolerance, name)
  tally.check(math.abs(got - want) <= tolerance, "%s: %.9g expected within %.2g, got %.9g", name, want, tolerance, got)
end

-- Checks that a call raises an error whose message contains `want`.
function tally.raises(want, call, ...)
  local good, message = pcall(call, ...)
  count(not good and tostring(message):find(want, 1, true), "'%s' expected, got %s", want, tostring(message))
end

-- Runs the functions of a table in the order of their names. An error counts as a failed check.
function tally.run(tests)
  local names = {}
  for name in pairs(tests) do names[#names + 1] = name end
  table.sort(names)
  for _, name in ipairs(names) do
    local ok, message = xpcall(tests[name], debug.traceback)
    tally.check(ok, "%s stopped: %s", name, message)
  end
end

-- Prints the totals and ends the process with 0 when nothing failed. Closes the Lua state, which unloads the module:
-- under AddressSanitizer, memory that only the module still references is then reported as a leak.
function tally.finish()
  print(("%d passed, %d failed"):format(tally.passed, tally.failed))
  os.exit(tally.failed == 0, true)
end

return tally
