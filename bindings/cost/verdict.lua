-- What the spread of the errors allows to say: bias and noise of each setting, verdicts, effects that are lost.
local the = ...
local log, sqrt = math.log, math.sqrt

local DOUBT <const> = 0.05 -- probability that any verdict of a study is wrong
local LOOKS <const> = 8 -- the number of pictures is doubled so often, and the verdicts are repeated
local SAME <const> = log(1.05) -- errors that differ by less count as the same
local ENOUGH <const> = 9 -- pictures whose own spread is known well enough
local LOST <const> = 0.001 -- share of pixels that change by more than one 8-bit value
local TIME_SPREAD <const>, TIME_DOUBT <const> = 0.02, 2.5 -- spread of times between studies; standard errors

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

-- Returns the variance and its degrees of freedom. With few pictures, the variance is that of the knob's settings,
-- which mostly share it, if that is larger. sum: the knob's sum of squares and its freedom, or nil.
local function pooled(sum, variance, freedom)
  if freedom < ENOUGH - 1 and sum then return math.max(variance, sum[1] / sum[2]), math.max(freedom, sum[2]) end
  return variance, freedom
end

-- Returns the sums for `pooled`, by knob and of all settings. list_of(case): the numbers whose variance is pooled.
local function pool(study, list_of)
  local sums = {}
  for _, case in ipairs(study.cases) do
    if case ~= study.own and #case.squares > 0 then
      local list = list_of(case)
      local _, variance = moments(list)
      for _, knob in ipairs { case.knob, "all" } do
        local sum = sums[knob] or { 0, 0 }
        sums[knob] = { sum[1] + variance * (#list - 1), sum[2] + #list - 1 }
      end
    end
  end
  return sums
end

-- Returns the quantile at which no verdict of the study is wrong with the probability 1 - DOUBT. sides: 1 or 2.
local function quantile(study, sides, freedom) return student(DOUBT / (sides * LOOKS * #study.cases), freedom) end

-- ---- Bias and noise ----

-- Returns the products of errors relative to the mean square.
local function shares(case)
  local square, out = mean(case.squares), {}
  for i, product in ipairs(case.products) do out[i] = product / math.max(square, 1e-30) end
  return out
end

-- Computes the errors of a case without those of the reference: rmse of a picture, their spread, noise and bias. A
-- bias is stated if its interval excludes 0, for all settings together. Without bias, products are uncorrelated.
local function split_error(study, case)
  if #case.squares == 0 then return end
  local reference, errors = study.reference.square, {}
  for i, square in ipairs(case.squares) do errors[i] = sqrt(math.max(square - reference, 0)) end
  local share, variance = moments(shares(case))
  local freedom
  variance, freedom = pooled(study.share_sums[case.knob or "all"], variance, #case.squares - 1)
  local margin, square = quantile(study, 1, freedom) * sqrt(variance / #case.products), mean(case.squares)
  case.film.rmse = sqrt(math.max(square - reference, 0))
  case.film.bias = (share - margin) * square > reference and sqrt(share * square) or 0.0
  case.film.noise = sqrt(math.max(case.film.rmse ^ 2 - case.film.bias ^ 2, 0))
  case.film.spread = sqrt(select(2, moments(errors)))
end

-- ---- Verdicts ----

-- Returns numbers whose mean is the logarithm of the quotient of two cases' errors, one for each seed: the jackknife's
-- pseudo-values. What a seed does to both pictures does not count.
local function quotients(study, a, b)
  local out, n, sum_a, sum_b = {}, math.min(#a.squares, #b.squares), 0, 0
  local function light(square) return math.max(square - study.reference.square, square / 10, 1e-30) end
  for i = 1, n do sum_a, sum_b = sum_a + light(a.squares[i]), sum_b + light(b.squares[i]) end
  for i = 1, n do
    local rest = (sum_a - light(a.squares[i])) / (sum_b - light(b.squares[i]))
    out[i] = (n * log(sum_a / sum_b) - (n - 1) * log(rest)) / 2
  end
  return out
end

-- Splits all errors, and computes the spreads that settings of a knob share.
function the.pool_spread(study)
  study.share_sums = pool(study, shares)
  study.sums = pool(study, function(case) return quotients(study, case, study.own) end)
  for _, case in ipairs(study.cases) do split_error(study, case) end
end

-- Returns the logarithm of the quotient of two cases' errors, and how far it may be off: with the probability DOUBT any
-- verdict of the study is. The reference's error counts, too.
function the.compare(study, a, b)
  local list = quotients(study, a, b)
  local average, variance = moments(list)
  if average == 0 and variance == 0 then return 0, 0 end
  local freedom, own = #list - 1, 0
  for _, case in ipairs { a, b } do
    variance, freedom = pooled(study.sums[case.knob], variance, freedom)
    own = own + study.reference.square / math.max(mean(case.squares), 1e-30) / 2
  end
  return average, quantile(study, 2, freedom) * sqrt(variance / #list) + own
end

-- Returns whether a quotient is at most `most` (a logarithm): true, false, or nil if that is not decided.
function the.is_below(average, margin, most)
  if average + margin <= most then return true elseif average - margin > most then return false end
end

-- Returns the logarithm of the quotient of two cases' times, and how far it may be off. The times of a round are
-- compared with each other: a slow phase of the machine affects both.
function the.compare_times(a, b)
  local list, of_round = {}, {}
  if a == b then return 0, 0 end
  for i = 1, b.runs do of_round[b.rounds[i]] = b.ms.cpu[i] end
  for i = 1, a.runs do
    local other = of_round[a.rounds[i]]
    if other then list[#list + 1] = log(a.ms.cpu[i] / other) end
  end
  local q = the.quartiles(list, #list)
  local noise = #list < the.RUNS_LEAST and 0.1 or 0.93 * (q.q3 - q.q1) / sqrt(#list)
  return q.median, TIME_DOUBT * sqrt(TIME_SPREAD ^ 2 + noise ^ 2)
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
  row.verdict = row.loss and "effect lost" or math.abs(average) + margin <= SAME and "equal"
    or average + margin < 0 and "better" or average - margin > 0 and not row.is_truer and "worse" or "not decided"
  row.is_as_good = not row.loss and the.is_below(average, margin, SAME)
  if row.loss then row.is_as_good = false end
end
