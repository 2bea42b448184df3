-- Evaluates the measurements: the Pareto front of time and error, combinations worth measuring, and one sentence of
-- advice.
local the = ...
local format = string.format

local RESOLVED <const> = 10 -- times the reference's own error: larger errors are resolved
local CANDIDATES_MAX <const>, COMBINATIONS_MAX <const> = 4096, 8
local CLEARLY <const> = 0.95 -- a knob is combined with others if it has less than this share of the time or error
local CHEAPER <const> = 0.8 -- a step that loses accuracy is advised if it takes less than this share of the time
local STEEP <const> = 0.8 -- among steps worth at least this share of the best one, the fastest is advised

-- ---- Combinations of good settings ----

-- Combines every candidate so far with each useful value of one more knob: one that is clearly faster than the
-- script's own, or clearly more accurate. Times multiply; errors are independent, so their squares add.
local function extend(study, knob, list)
  local own, before = study.own, #list
  for _, row in ipairs(study.rows) do
    local case = row.case
    if row.knob == knob.name and not row.own and case.film and case.runs > 0
      and (case.guess_cpu_ms < CLEARLY * own.guess_cpu_ms or case.film.rmse < CLEARLY * own.film.rmse) then
      for i = 1, math.min(before, CANDIDATES_MAX - #list) do
        local from, choice = list[i], { [knob.name] = row.value }
        for name, value in pairs(from.choice) do choice[name] = value end
        local square = from.error * from.error + case.film.rmse * case.film.rmse - own.film.rmse * own.film.rmse
        list[#list + 1] = { choice = choice, knobs = from.knobs + 1, index = #list,
          ms = from.ms * (case.guess_cpu_ms / own.guess_cpu_ms), error = math.sqrt(math.max(square, 0)) }
      end
    end
  end
end

-- Adds the combinations that are likely to be on the front, judging from the effect of each knob on its own.
function the.add_combinations(study)
  if not study.own.film then return end
  local list = { { choice = {}, knobs = 0, index = 0, ms = study.own.guess_cpu_ms, error = study.own.film.rmse } }
  for _, knob in ipairs(the.knobs) do
    if not knob.is_alone then extend(study, knob, list) end
  end
  table.sort(list, function(a, b)
    if a.ms ~= b.ms then return a.ms < b.ms end
    if a.error ~= b.error then return a.error < b.error end
    return a.index < b.index
  end)
  local chosen, least = {}, list[1]
  for _, candidate in ipairs(list) do
    if candidate.error < least.error then least = candidate end
    if candidate.error == least.error and candidate.ms == least.ms and candidate.knobs > 1 then
      chosen[#chosen + 1] = candidate
    end
  end
  local wanted = math.min(#chosen, COMBINATIONS_MAX)
  for i = 0, wanted - 1 do -- evenly spread over the front
    the.add_combination(study, chosen[wanted > 1 and i * (#chosen - 1) // (wanted - 1) + 1 or 1].choice)
  end
end

-- ---- Comparing rows ----

local function time_of(row) return row.case.time.median end

local function is_point(row) return not row.other_time and row.error ~= nil end

-- Returns whether row a beats row b: a is more accurate and not slower, or as accurate and faster. Times differ only if
-- by more than the smaller of the two quartile ranges, so that a disturbed row does not pass for fast; with equal
-- errors any difference counts. As accurate: within the reference's own error.
local function beats(study, a, b)
  local ea, eb, ta, tb = a.error.rmse, b.error.rmse, time_of(a), time_of(b)
  local noise = math.min(a.case.quartile_range, b.case.quartile_range)
  return (ea < eb and ta <= tb + noise) or (ea == eb and ta < tb)
    or (ea <= eb + study.reference.rmse and ta < tb - noise)
end

local function is_on_front(study, row)
  if not is_point(row) then return false end
  for _, other in ipairs(study.rows) do
    if is_point(other) and beats(study, other, row) then return false end
  end
  return true
end

local function judge_row(study, row, fastest)
  local case, own = row.case, study.own
  local difference = time_of(row) - own.time.median
  row.x_fastest = time_of(row) / fastest
  row.resolved = row.error ~= nil and row.error.rmse >= RESOLVED * study.reference.rmse
  row.partial = not row.error or (not case.left_out and case.runs < study.runs) or case.is_first_alone
  row.difference = math.abs(difference) <= math.max(case.quartile_range, own.quartile_range) and 0
    or difference < 0 and -1 or 1 -- relative to the script's own time: -1 faster, 1 slower
  row.apart = the.is_apart(study, case)
  row.front = is_on_front(study, row)
end

-- ---- The advice ----

local SHARES <const> = { { 1 / 2, "half the" }, { 1 / 3, "a third of the" }, { 2 / 3, "two thirds of the" },
  { 1 / 4, "a quarter of the" }, { 3 / 4, "three quarters of the" }, { 1 / 5, "a fifth of the" },
  { 1 / 10, "a tenth of the" }, { 1, "the same" } }

local function spell_share(share)
  for _, known in ipairs(SHARES) do
    if math.abs(share / known[1] - 1) < 0.06 then return known[2] end
  end
  return format(share < 0.1 and "%.1g of the" or "%.2g times the", share)
end

-- Returns whether a row may be advised: only if it decides no more pixels wrongly than the script's own setting.
local function is_eligible(study, row)
  local case, own = row.case, study.own
  return not row.own and is_point(row) and case.wrong_object + case.wrong_shadow <= own.wrong_object + own.wrong_shadow
end

-- Returns the value of a step: accuracy gained for its time, or time saved for the same picture; 0: not advised.
local function worth(study, row)
  if not is_eligible(study, row) then return 0 end
  local e, t = study.own.film.rmse / row.error.rmse, time_of(row) / study.own.time.median
  if e >= 0.98 and row.difference < 0 then return 1e3 / t end -- as accurate or better, and faster
  if e >= 1.5 then -- 1e3: at no cost
    return row.difference == 0 and 1e3 * e or math.log(e) / math.log(math.max(t, 1.01))
  end
  return 0
end

-- Returns the fastest step among those with nearly the best value; nil: no step is advised.
local function find_step(study)
  local best, step = 0, nil
  for _, row in ipairs(study.rows) do best = math.max(best, worth(study, row)) end
  for _, row in ipairs(study.rows) do
    if best > 0 and worth(study, row) >= STEEP * best and (not step or row.x_fastest < step.x_fastest) then
      step = row
    end
  end
  return step
end

-- Returns the row with the least error among those that save much time. Used when no setting is more accurate than the
-- script's.
local function find_cheaper(study)
  local best
  for _, row in ipairs(study.rows) do
    if is_eligible(study, row) and row.resolved and row.difference < 0
      and time_of(row) / study.own.time.median < CHEAPER and (not best or row.error.rmse < best.error.rmse) then
      best = row
    end
  end
  return best
end

local function advice_of(study)
  local own = study.own
  if not own.film or own.runs == 0 then
    return "no advice: " .. (study.complete and "the budget left no time for another setting"
      or "the study was interrupted too early")
  end
  local row = find_step(study) or find_cheaper(study)
  if not row then return "keep the script's setting: no setting here is faster or more accurate" end
  return format("%s: %s time, %s error%s", row.knob and row.knob .. " " .. row.own_label .. " -> " .. row.label
      or row.label .. " instead of the script's setting",
    row.difference == 0 and "no difference in the" or spell_share(time_of(row) / own.time.median),
    spell_share(row.error.rmse / own.film.rmse),
    row.resolved and "" or " or less (too small to resolve against the reference)")
end

-- Keeps the measured rows, compares them, and gives the advice.
function the.judge(study)
  local rows, fastest = {}, math.huge
  the.summarize(study)
  for i, row in ipairs(study.rows) do
    if row.case.runs > 0 then
      rows[#rows + 1], row.index = row, i - 1
      row.error = row.is_of_file and row.case.file or row.case.film
      fastest = math.min(fastest, time_of(row))
    end
  end
  study.rows = rows
  for _, row in ipairs(rows) do judge_row(study, row, fastest) end
  study.advice = advice_of(study)
end
