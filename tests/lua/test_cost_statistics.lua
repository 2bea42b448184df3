-- The statistics of glint cost on simulated studies, whose errors and times are known: verdicts and advice may be
-- wrong in 5 % of the studies, and advice must not depend on the seed.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local STUDIES <const> = 200

local the = { PICTURES = 3, PICTURES_MAX = 384, RUNS_LEAST = 3 }
for _, name in ipairs { "timing", "verdict", "advice" } do
  assert(loadfile(("bindings/cost/%s.lua"):format(name)))(the)
end

-- Returns a number with the normal distribution.
local function normal() return math.sqrt(-2 * math.log(1 - math.random())) * math.cos(2 * math.pi * math.random()) end

-- A frame with the true error and time of its case, and a spread from seed to seed, a part of which all cases share.
function the.replicate(study, case)
  for _ = 1, the.PICTURES do
    local i = #case.squares + 1
    study.shared[i] = study.shared[i] or normal()
    local size = case.error * math.exp(0.1 * study.shared[i] + case.spread * normal() - case.spread ^ 2)
    case.squares[i] = size ^ 2 + study.reference.square
    case.products[i] = case.bias ^ 2 + 0.05 * (case.error ^ 2 - case.bias ^ 2) * normal()
  end
end

-- A round of timed runs on a machine that other work slows down, more in some rounds than in others.
function the.run_rounds(_, cases, runs)
  for _ = 1, runs do
    the.round = the.round + 1
    local phase = 1 + 0.4 * math.random()
    for _, case in ipairs(cases) do
      case.runs = case.runs + 1
      case.rounds[case.runs], case.ms.cpu[case.runs] = the.round, case.ms_true * phase * math.exp(0.1 * normal())
    end
  end
end

function the.judge(study)
  the.pool_spread(study)
  for _, row in ipairs(study.rows) do
    the.judge_error(study, row)
    row.time, row.time_margin = the.compare_times(row.case, study.own)
    row.x_own = math.exp(row.time)
  end
  study.advice = the.advise(study)
end

-- cases: { knob, label, error, time, spread, bias }; the first is the script's own.
local function simulate(cases)
  local study = { cases = {}, rows = {}, shared = {}, reference = { square = 1e-6, rmse = 1e-3 }, complete = true }
  the.tools = { now = function() return study.clock or 0 end, show = function() end }
  for i, c in ipairs(cases) do
    local case = { knob = i > 1 and c[1] or nil, squares = {}, products = {}, film = {}, runs = 0, rounds = {}, ms = { cpu = {} },
      error = c[3], ms_true = c[4], spread = c[5], bias = c[6] or 0, frame_ms = 1, estimate_ms = 1 }
    study.cases[i] = case
    study.rows[i] = { knob = c[1], label = c[2], own_label = cases[1][2], case = case, own = i == 1, far = i - 1 }
    the.replicate(study, case)
  end
  study.own = study.cases[1]
  the.run_rounds(study, table.move(study.cases, 1, #study.cases, 1, {}), 5)
  the.decide(study, 4000)
  return study
end

local function is_wrong(row, case)
  local q = math.log(case[3])
  return row.verdict == "better" and q >= 0 or row.verdict == "worse" and q <= 0
    or row.verdict == "equal" and math.abs(q) > math.log(1.05) or false
end

local function try(name, cases, right)
  local decided, good, wrong, found, chance, hidden = 0, 0, 0, {}, 0, 0
  for _ = 1, STUDIES do
    local study, any, bias = simulate(cases), false, false
    for i, row in ipairs(study.rows) do
      any = any or (i > 1 and is_wrong(row, cases[i]))
      bias = bias or (row.case.film.bias > 0 and row.case.bias == 0)
      hidden = hidden + (row.case.film.bias == 0 and row.case.bias > 0 and 1 or 0)
    end
    local text = study.advice.text
    wrong, chance = wrong + (any and 1 or 0), chance + (bias and 1 or 0)
    if study.advice.decided then
      local step = text:match "^[^:]*"
      decided, good, found[step] = decided + 1, good + (step == right and 1 or 0), true
    end
  end
  check(wrong <= 0.05 * STUDIES, "%s: %d of %d studies have a wrong verdict", name, wrong, STUDIES)
  check(chance <= 0.05 * STUDIES, "%s: %d of %d studies find a bias by chance", name, chance, STUDIES)
  check(decided >= 0.6 * STUDIES, "%s: %d of %d studies are decided", name, decided, STUDIES)
  local names = {}
  for step in pairs(found) do names[#names + 1] = step end
  check(good >= 0.95 * decided, "%s: %d of %d say '%s': %s", name, good, decided, right, table.concat(names, "; "))
  return hidden
end

math.randomseed(47)
-- No setting saves time at the same error, and one step is worth more than the others.
try("a step", { { "samples", "4", 1, 1, 0.15 }, { "samples", "1", 3, 0.3, 0.1 }, { "samples", "16", 0.45, 3.3, 0.1 },
  { "samples", "64", 0.12, 12, 0.05 }, { "adaptive", "0.03", 1.01, 1.05, 0.1 }, { "adaptive", "0.3", 1.02, 1.1, 0.1 } },
  "samples 4 -> 16")
-- Two knobs save time: the faster one is advised if its error is the same. The third looks alike and is not.
try("a saving", { { "samples", "4", 1, 1, 0.1 }, { "adaptive", "0.1", 1.01, 0.7, 0.05 }, { "light_samples", "4", 1, 0.4, 0.05 },
  { "light_samples", "1", 1.3, 0.2, 0.05 } }, "light_samples 4 -> 4")
-- A saving of a seventh is less than a fifth, which a few runs cannot tell.
try("near a limit", { { "samples", "4", 1, 1, 0.05 }, { "adaptive", "0.1", 1, 0.86, 0.02 },
  { "samples", "16", 0.45, 3.3, 0.05 } }, "samples 4 -> 16")
-- Nothing helps.
try("nothing", { { "samples", "64", 1, 1, 0.1 }, { "adaptive", "0.1", 1.3, 0.95, 0.05 }, { "max_depth", "5", 1, 0.97, 0.02 } },
  "keep the script's setting")
-- A bias of most of the error is found with the first pictures; one that is not there is not.
local hidden = try("a bias", { { "samples", "4", 1, 1, 0.1 }, { "samples", "16", 0.5, 4, 0.1 },
  { "indirect_bounces", "0", 2, 0.5, 0.05, 1.9 }, { "indirect_bounces", "1", 1.5, 0.7, 0.05, 1.2 } }, "samples 4 -> 16")
check(hidden <= 0.1 * STUDIES, "%d of %d biases are hidden", hidden, 2 * STUDIES)
tally.finish()
