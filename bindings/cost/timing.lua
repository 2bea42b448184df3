-- Schedules the runs: one case at a time in random order, so that a slow phase of the machine affects all cases
-- equally.
local the = ...
the.round = 0 -- runs of the same round are near to each other in time
local PARTS <const> = { "render", "tone", "encode", "wall", "cpu" } -- cpu: of all threads

-- Returns the next number of SplitMix64: good enough for the order of runs, and the same on every machine.
function the.next_random(generator)
  generator.state = generator.state + 0x9e3779b97f4a7c15
  local z = generator.state
  z = (z ~ z >> 30) * 0xbf58476d1ce4e5b9
  z = (z ~ z >> 27) * 0x94d049bb133111eb
  return z ~ z >> 31
end

-- Returns the time left in the budget; infinite without a budget.
function the.left_ms(study) return study.deadline_ms - the.tools.now() end

-- Returns the time to run every case that is not left out once, as far as known.
function the.round_ms(study)
  local sum = 0.0
  for _, case in ipairs(study.cases) do
    if not case.left_out then sum = sum + case.estimate_ms end
  end
  return sum
end

-- Renders, encodes and times a case once, in memory.
function the.run(case)
  local start = the.tools.now()
  if case.is_first_alone then -- the first run warms everything up
    case.runs, case.is_first_alone = 0, false
  end
  local plan <close> = the.tools.plan(case.choice)
  local times, stats = the.tools.time(plan, case.batch)
  case.runs = case.runs + 1
  for _, part in ipairs(PARTS) do case.ms[part][case.runs] = times[part] end
  case.rounds[case.runs] = the.round
  case.rays, case.refined, case.render_ms = stats.rays, stats.refined, stats.render_ms
  case.estimate_ms = the.tools.now() - start
end

-- ---- Quartiles ----

function the.quartiles(ms, runs)
  local sorted = table.move(ms, 1, runs, 1, {})
  table.sort(sorted)
  local function quantile(share)
    local at = share * (runs - 1)
    local low = at // 1 | 0
    return sorted[low + 1] + (at - low) * (sorted[math.min(low + 2, runs)] - sorted[low + 1])
  end
  if runs == 0 then return { min = 0.0, q1 = 0.0, median = 0.0, q3 = 0.0 } end
  return { min = sorted[1], q1 = quantile(0.25), median = quantile(0.5), q3 = quantile(0.75) }
end

-- Computes the quartiles of the measured times. Rows are compared by `time`, the processor time, since other load on
-- the machine changes it little.
function the.summarize(study)
  for _, case in ipairs(study.cases) do
    case.time = the.quartiles(case.ms.cpu, case.runs)
    case.wall = the.quartiles(case.ms.wall, case.runs)
    case.quartile_range, case.frames = case.time.q3 - case.time.q1, case.is_first_alone and 1 or case.batch
    for i = 1, 3 do case[PARTS[i]] = the.quartiles(case.ms[PARTS[i]], case.runs).median end
  end
end

-- ---- The budget ----

local function fit_budget(study)
  local wanted = study.runs
  study.runs = math.max(math.min(the.left_ms(study) // the.round_ms(study), wanted), 1) | 0
  if study.runs < wanted then the.leave_out(study, "%d of %d runs of each setting", wanted - study.runs, wanted) end
end

-- ---- The runs ----

local function shuffle(study, cases)
  for i = #cases, 2, -1 do
    local z = the.next_random(study.random)
    local j = ((z >> 1) % i * 2 + (z & 1)) % i + 1 -- z as an unsigned number
    cases[i], cases[j] = cases[j], cases[i]
  end
end

-- Runs the cases, each `runs` times. A round runs each case once.
function the.run_rounds(study, cases, runs, what)
  local ms = 0.0
  for _, case in ipairs(cases) do ms = ms + case.estimate_ms end
  for round = 1, runs do
    the.round = the.round + 1
    shuffle(study, cases)
    for i, case in ipairs(cases) do
      the.tools.show(what, case.estimate_ms, ms * (runs - round + 1 - i / #cases))
      the.run(case)
    end
  end
end

-- Runs all cases, each `study.runs` times.
function the.time_cases(study)
  fit_budget(study)
  local cases = {}
  for _, case in ipairs(study.cases) do
    if not case.left_out and case.runs > 0 then cases[#cases + 1] = case end
  end
  the.run_rounds(study, cases, study.runs, "timing")
end
