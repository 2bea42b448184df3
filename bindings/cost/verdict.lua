-- What the spread of the errors allows to say: bias and noise of each setting, verdicts, effects that are lost.
local the = ...
local log, sqrt = math.log, math.sqrt

local DOUBT <const> = 0.05 -- probability that any verdict of a study is wrong
local LOOKS <const> = 4 -- verdicts are repeated as pictures are added
local SAME <const> = log(1.05) -- errors that differ by less count as the same
local ENOUGH <const> = 9 -- pictures whose own spread is known well enough
local CHANCE <const> = 0.005 -- probability that noise passes for bias
local LOST <const> = 0.001 -- share of pixels that change by more than one 8-bit value
local TIME_SPREAD <const>, TIME_DOUBT <const> = 0.03, 2 -- spread of times between studies; standard errors

local function mean(list)
  local sum = 0
  for _, value in ipairs(list) do sum = sum + value end
  return sum / #list
end

-- Returns the mean of the list, and its variance if it has several numbers.
local function moments(list)
  local average, sum = mean(list), 0
  for _, value in ipairs(list) do sum = sum + (value - average) ^ 2 end
  return average, sum / (#list - 1)
end

-- Returns p's quantile of Student's distribution in its upper tail. (M. Abramowitz, I. Stegun, 26.2.23, 26.7.5.)
local function student(p, freedom)
  if freedom < 4 then return (1 - 2 * p) / sqrt(2 * p * (1 - p)) end -- two degrees of freedom
  local t = sqrt(-2 * log(p))
  local z = t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)))
  return z + (z ^ 3 + z) / (4 * freedom) + (5 * z ^ 5 + 16 * z ^ 3 + 3 * z) / (96 * freedom ^ 2)
    + (3 * z ^ 7 + 19 * z ^ 5 + 17 * z ^ 3 - 15 * z) / (384 * freedom ^ 3)
end

-- ---- Bias and noise ----

-- Computes the errors of a case without those of the reference: rmse of a picture, their spread, noise and bias.
-- A bias that the spread could explain is 0.
function the.split_error(study, case)
  if #case.squares == 0 then return end
  local reference, errors = study.reference.square, {}
  for i, square in ipairs(case.squares) do errors[i] = sqrt(math.max(square - reference, 0)) end
  local bias, variance = moments(case.products)
  local own = math.max(student(CHANCE, #case.squares - 1) * sqrt(2 * variance / #case.products), reference)
  case.film.rmse = sqrt(math.max(mean(case.squares) - reference, 0))
  case.film.bias = bias > own and sqrt(bias) or 0.0
  case.film.noise = sqrt(math.max(case.film.rmse ^ 2 - case.film.bias ^ 2, 0))
  case.film.spread = sqrt(select(2, moments(errors)))
end

-- ---- Verdicts ----

-- Returns the logarithms of the quotients of the errors of two cases, seed by seed: what the seed does to both
-- pictures does not count.
local function quotients(study, a, b)
  local out = {}
  for i = 1, math.min(#a.squares, #b.squares) do
    local function light(square) return math.max(square - study.reference.square, square / 10, 1e-30) end
    out[i] = log(light(a.squares[i]) / light(b.squares[i])) / 2
  end
  return out
end

-- Computes the spread of the quotients to the script's own setting, from all settings of a knob: they mostly share it.
function the.pool_spread(study)
  local sums = {}
  for _, case in ipairs(study.cases) do
    if case ~= study.own and #case.squares > 0 then
      local _, variance = moments(quotients(study, case, study.own))
      local sum, freedom = sums[case.knob] or { 0, 0 }, #case.squares - 1
      sums[case.knob] = { sum[1] + variance * freedom, sum[2] + freedom }
    end
  end
  study.sums = sums
end

-- Returns the logarithm of the quotient of two cases' errors, and how far it may be off: with the probability DOUBT any
-- verdict of the study is. With few pictures, the spread is that of the knob if that is larger. The reference's error
-- counts, too.
function the.compare(study, a, b)
  local list = quotients(study, a, b)
  local average, variance = moments(list)
  if average == 0 and variance == 0 then return 0, 0 end
  local n, freedom, own = #list, #list - 1, 0
  for _, case in ipairs { a, b } do
    local sum = study.sums[case.knob] or { 0, 0 }
    if n < ENOUGH and sum[2] > 0 then
      variance, freedom = math.max(variance, sum[1] / sum[2]), math.max(freedom, sum[2])
    end
    own = own + study.reference.square / math.max(mean(case.squares), 1e-30) / 2
  end
  return average, student(DOUBT / (2 * LOOKS * #study.cases), freedom) * sqrt(variance / n) + own
end

-- Returns whether a quotient is at most `most` (a logarithm): true, false, or nil if that is not decided.
function the.is_below(average, margin, most)
  if average + margin <= most then return true elseif average - margin > most then return false end
end

-- Returns whether case a takes at most `share` of the time of case b; nil: not decided.
function the.is_faster(a, b, share)
  local square = TIME_SPREAD ^ 2
  for _, case in ipairs { a, b } do
    local noise = case.runs < the.RUNS_LEAST and 0.1 or 0.93 * case.quartile_range / case.time.median / sqrt(case.runs)
    square = square + noise ^ 2
  end
  return the.is_below(log(a.time.median / b.time.median), TIME_DOUBT * sqrt(square), log(share))
end

-- Judges a row against the script's own: "better", "worse", "equal" or "not decided" of its error, or "effect lost". A
-- setting nearer to the truth is never worse.
function the.judge_error(study, row)
  local case = row.case
  row.loss = row.may_lose and case.changed and case.changed > LOST and row.may_lose(study, row.value) or nil
  if #case.squares == 0 or row.is_of_file then return end
  if row.own then row.verdict = "equal" return end
  local average, margin = the.compare(study, case, study.own)
  row.average, row.margin = average, margin
  if row.is_truer and case.film.bias > study.own.film.bias then -- chance: it has no more bias
    case.film.bias = study.own.film.bias
    case.film.noise = sqrt(math.max(case.film.rmse ^ 2 - case.film.bias ^ 2, 0))
  end
  row.verdict = row.loss and "effect lost" or math.abs(average) + margin <= SAME and "equal"
    or average + margin < 0 and "better" or average - margin > 0 and not row.is_truer and "worse" or "not decided"
  row.is_as_good = not row.loss and the.is_below(average, margin, SAME)
  if row.loss then row.is_as_good = false end
end
