-- One sentence of advice, or what is not decided. Every comparison is decided with the confidence of the study or not
-- at all, so studies with other seeds give the same advice or none.
local the = ...
local format, log = string.format, math.log

local SAVING <const> = 0.8 -- a saving is advised if it takes at most this share of the time
local GAIN <const> = log(0.8) -- a step to more accuracy is advised if it leaves at most this share of the error
local CLEARLY <const> = log(1.25) -- a step must be worth so much more than the first
local SAME <const>, HOUR_MS <const> = log(1.05), 3600e3

local SHARES <const> = { { 1 / 2, "half the" }, { 1 / 3, "a third of the" }, { 2 / 3, "two thirds of the" },
  { 1 / 4, "a quarter of the" }, { 3 / 4, "three quarters of the" }, { 1 / 5, "a fifth of the" },
  { 1 / 10, "a tenth of the" } }

local function spell_share(share)
  for _, known in ipairs(SHARES) do
    if math.abs(share / known[1] - 1) < 0.06 then return known[2] end
  end
  return format(share < 0.1 and "%.1g of the" or "%.2g times the", share)
end

local function step_of(row) return row.knob .. " " .. row.own_label .. " -> " .. row.label end

local function sentence(study, row)
  return format("%s: %s time, %s error", step_of(row), spell_share(row.case.time.median / study.own.time.median),
    row.verdict == "equal" and "the same" or spell_share(row.case.film.rmse / study.own.film.rmse))
end

-- ---- The choice ----

-- Returns the row that no other beats; of rows that are about as good, the first. beats(a, b): nil if not decided,
-- which adds to the doubts. candidates: { row, is_certain }.
local function choose(candidates, beats, doubts)
  local best
  for _, candidate in ipairs(candidates) do
    if candidate[2] then
      local wins = not best or beats(candidate[1], best)
      if wins == nil then doubts[#doubts + 1] = candidate[1] end
      if wins then best = candidate[1] end
    end
  end
  for _, candidate in ipairs(candidates) do
    if not candidate[2] and (not best or beats(candidate[1], best) ~= false) then doubts[#doubts + 1] = candidate[1] end
  end
  return best
end

local function both(a, b)
  if a == false or b == false then return false end
  return a and b
end

local function list(rows, test)
  local out = {}
  for _, row in ipairs(rows) do
    local is = test(row)
    if is ~= false then out[#out + 1] = { row, is == true } end
  end
  return out
end

-- Returns the nearest of each knob's candidates: the one that changes the time least.
local function nearest(candidates)
  local out, at = {}, {}
  for _, candidate in ipairs(candidates) do
    local row, i = candidate[1], at[candidate[1].knob]
    local far = math.abs(log(row.case.time.median / row.own_case.time.median))
    if not i or far < out[i].far then
      i = i or #out + 1
      out[i], at[row.knob] = { row, candidate[2], far = far }, i
    end
  end
  return out
end

-- Returns the accuracy gained for the time, and how far its logarithm may be off.
local function worth(row)
  local cost = math.max(log(row.case.time.median / row.own_case.time.median), 0.1)
  return math.max(-row.average, 1e-3) / cost, row.margin / math.max(-row.average, 1e-3) + 0.03 / cost
end

local function is_worth_more(a, b)
  local of_a, doubt_a = worth(a)
  local of_b, doubt_b = worth(b)
  return the.is_below(log(of_b / of_a), math.sqrt(doubt_a ^ 2 + doubt_b ^ 2), -CLEARLY)
end

-- Returns the advised row, or the rows whose order is not decided.
local function advised(study, rows)
  local own, doubts = study.own, {}
  local function saves(row) return the.is_faster(row.case, own, SAVING) end
  local row = choose(list(rows, function(r) return both(r.is_as_good, saves(r)) end),
    function(a, b) return the.is_faster(a.case, b.case, SAVING) end, doubts)
  if #doubts > 0 or row then return row, doubts end
  row = choose(nearest(list(rows, function(r) return not r.loss and the.is_below(r.average, r.margin, GAIN) end)),
    is_worth_more, doubts)
  if #doubts > 0 or row then return row, doubts end
  row = choose(nearest(list(rows, function(r) return not r.loss and saves(r) end)), function(a, b)
    local average, margin = the.compare(study, a.case, b.case)
    return the.is_below(average, margin, -CLEARLY)
  end, doubts)
  return row, doubts
end

-- ---- What is missing ----

local function spell_ms(ms)
  if ms > HOUR_MS then return "more than an hour" end
  return ms < 120e3 and format("about %.0f s", math.ceil(ms / 1e3))
    or format("about %.0f minutes", math.ceil(ms / 60e3))
end

-- Returns the time that pictures would take until the rows' errors are decided. The margin falls with the root of
-- their number.
local function deciding_ms(study, doubts)
  local sum = 0
  for _, row in ipairs(doubts) do
    local off = math.max(math.min(math.abs(row.average - SAME), math.abs(row.average - GAIN)), 1e-3)
    local more = #row.case.squares * (math.max(row.margin / off, 1.5) ^ 2 - 1)
    sum = sum + more * (row.case.frame_ms + study.own.frame_ms)
  end
  return sum
end

local function names_of(rows)
  local out = {}
  for i, row in ipairs(rows) do out[i] = step_of(row) end
  return table.concat(out, ", ", 1, math.min(#out, 3)) .. (#out > 3 and format(" and %d more", #out - 3) or "")
end

-- Returns the advice: its text, whether it is decided, and the rows in doubt.
function the.advise(study)
  local rows, missing = {}, 0
  for _, row in ipairs(study.rows) do
    local counts = row.knob and not row.own and not row.other_time and not row.is_of_file
    if #row.case.squares == 0 or row.case.runs < the.RUNS_LEAST then missing = missing + 1 end
    if counts then rows[#rows + 1] = row end
  end
  if not study.complete then return { text = "not decided: the study was interrupted", doubts = {} } end
  if missing > 0 then
    return { doubts = {}, text = format("not decided: the budget left no time for %d of %d settings; --budget %.0f "
      .. "measures all", missing, #study.rows, math.ceil(the.whole_ms(study) / 1e3)) }
  end
  local row, doubts = advised(study, rows)
  if #doubts > 0 then
    return { doubts = doubts, text = format("not decided: %s: too close after %d pictures of each; deciding would "
      .. "take %s more", names_of(doubts), #doubts[1].case.squares, spell_ms(deciding_ms(study, doubts))) }
  end
  return { doubts = {}, decided = true, row = row, text = row and sentence(study, row)
    or "keep the script's setting: no setting here saves a fifth of the time or a fifth of the error" }
end

-- Renders and times the settings in doubt again, until the advice is decided or the time is over.
function the.decide(study, until_ms)
  while true do
    the.judge(study)
    local cases, ms, seen = {}, 0, {}
    for _, row in ipairs(study.advice.doubts) do
      for _, case in ipairs { study.own, row.case } do
        if not seen[case] and #case.squares < the.PICTURES_MAX then
          cases[#cases + 1], seen[case], ms = case, true, ms + the.PICTURES * case.frame_ms + case.estimate_ms
        end
      end
    end
    if #cases == 0 or the.tools.now() + ms > until_ms then return end
    for _, case in ipairs(cases) do
      the.tools.show("deciding", ms, 0)
      the.replicate(study, case)
      the.run(case)
    end
  end
end
