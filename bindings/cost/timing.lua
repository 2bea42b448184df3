-- Schedules the runs: one case at a time in random order, so that a slow phase of the machine affects all cases
-- equally.
local the = ...
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
  case.rays, case.refined, case.render_ms = stats.rays, stats.refined, stats.render_ms
  case.estimate_ms = the.tools.now() - start
end

-- ---- Quartiles ----

local function quartiles(ms, runs)
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
    case.time, case.wall = quartiles(case.ms.cpu, case.runs), quartiles(case.ms.wall, case.runs)
    case.quartile_range, case.frames = case.time.q3 - case.time.q1, case.is_first_alone and 1 or case.batch
    for _, part in ipairs { "render", "tone", "encode" } do case[part] = quartiles(case.ms[part], case.runs).median end
  end
end

-- Returns whether a case's quartile range overlaps neither neighbour's in the order of times.
function the.is_apart(study, case)
  local below, above
  for _, other in ipairs(study.cases) do
    local ms = other.time.median
    if other ~= case and not other.left_out and other.runs > 0 then
      if ms <= case.time.median and (not below or ms > below.median) then below = other.time end
      if ms >= case.time.median and (not above or ms < above.median) then above = other.time end
    end
  end
  return (not below or below.q3 < case.time.q1) and (not above or above.q1 > case.time.q3)
end

-- ---- The budget ----

-- Drops the slowest case except the script's own. Returns nil if there is no other.
local function drop_slowest(study)
  local slowest
  for i, case in ipairs(study.cases) do
    if i > 1 and not case.left_out and case.runs > 0 and (not slowest or case.estimate_ms > slowest.estimate_ms) then
      slowest = case
    end
  end
  if not slowest then return end
  slowest.left_out = true
  the.leave_out(study, "%s: timed once: the budget leaves no time for %d runs", slowest.name, the.RUNS_LEAST)
  return slowest
end

local function fit_budget(study)
  local wanted = study.runs
  while the.round_ms(study) * the.RUNS_LEAST > the.left_ms(study) and drop_slowest(study) do end
  local fitting = the.left_ms(study) // the.round_ms(study)
  if fitting < wanted then study.runs = math.max(fitting, 1) | 0 end
  if study.runs < wanted then
    the.leave_out(study, "%d of %d runs of each setting", wanted - study.runs, wanted)
  end
end

-- ---- The runs ----

local function shuffle(study, cases)
  for i = #cases, 2, -1 do
    local z = the.next_random(study.random)
    local j = ((z >> 1) % i * 2 + (z & 1)) % i + 1 -- z as an unsigned number
    cases[i], cases[j] = cases[j], cases[i]
  end
end

local function run_round(study, cases, remaining_ms)
  shuffle(study, cases)
  for _, case in ipairs(cases) do
    remaining_ms = remaining_ms - case.estimate_ms
    the.tools.show("timing", case.estimate_ms, remaining_ms)
    the.run(case)
  end
end

-- Returns the timed cases and the time of a round. may_repeat: only the cases for which it returns true.
local function list_cases(study, may_repeat)
  local cases, ms = {}, 0.0
  for _, case in ipairs(study.cases) do
    if not case.left_out and case.runs > 0 and (not may_repeat or may_repeat(case)) then
      cases[#cases + 1], ms = case, ms + case.estimate_ms
    end
  end
  return cases, ms
end

-- Runs all cases; then repeats those whose quartile range overlaps a neighbour's, up to the most runs or the budget's
-- end. If the ranges always overlap, the two cost the same.
function the.time_cases(study)
  fit_budget(study)
  local cases, ms = list_cases(study)
  for round = 0, study.runs - 1 do run_round(study, cases, ms * (study.runs - round)) end
  while study.runs >= the.RUNS_LEAST do
    the.summarize(study)
    cases, ms = list_cases(study, function(case)
      return case.runs < study.most_runs and not the.is_apart(study, case)
    end)
    if #cases == 0 then return end
    if ms > the.left_ms(study) then
      return the.leave_out(study, "more runs of %d settings whose times still overlap: the budget leaves no time",
        #cases)
    end
    run_round(study, cases, ms)
  end
end
