-- Evaluates the measurements: the Pareto front of time and error.
local the = ...

local RESOLVED <const> = 3 -- times the reference's own error, which is taken out: larger errors are resolved

local function time_of(row) return row.case.time.median end

local function is_point(row) return not row.other_time and row.error ~= nil and row.case.runs > 0 end

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

local function judge_row(study, row)
  local case, own = row.case, study.own
  local difference = time_of(row) - own.time.median
  row.time, row.time_margin = the.compare_times(case, own)
  row.x_own = math.exp(row.time)
  row.resolved = row.error ~= nil and row.error.rmse >= RESOLVED * study.reference.rmse
  row.partial = not row.error or (not case.left_out and case.runs < study.runs) or case.is_first_alone
  row.difference = math.abs(difference) <= math.max(case.quartile_range, own.quartile_range) and 0
    or difference < 0 and -1 or 1 -- relative to the script's own time: -1 faster, 1 slower
  row.front = is_on_front(study, row)
end

-- Compares the rows and gives the advice.
function the.judge(study)
  the.summarize(study)
  if study.reference then the.pool_spread(study) end
  for i, row in ipairs(study.rows) do
    row.index, row.own_case, row.error = i - 1, study.own, row.is_of_file and row.case.file or row.case.film
    if row.case.runs > 0 then the.judge_error(study, row) end
  end
  for _, row in ipairs(study.rows) do
    if row.case.runs > 0 then judge_row(study, row) end
  end
  study.advice = the.advise(study)
end
