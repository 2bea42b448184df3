-- One sentence of advice, or what is not decided. Every comparison is decided with the confidence of the study or not
-- at all, so studies with other seeds give the same advice or none.
local the = ...
local format, log = string.format, math.log

local SAVING <const> = log(0.8) -- a saving is advised if it takes at most this share of the time
local GAIN <const> = log(0.8) -- a step to more accuracy is advised if it leaves at most this share of the error
local CLEARLY <const> = 1.25 -- a step must be worth so many times as much as the first
local RUNS_MAX <const>, LEAST_SHARE <const> = 1000, 0.25 -- runs of a setting; of a doubling that is worth its time
local EXACTLY <const> = log(1.25) -- the stated share of the error may be off by so much
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

local function sentence(row)
  return format("%s: %s time, %s error", step_of(row), spell_share(row.x_own),
    row.verdict == "equal" and "the same" or spell_share(math.exp(row.average)))
end

-- ---- The choice ----

-- Lists the rows that pass the test: { row, is_certain }. is_nearest: only the nearest of each knob.
local function list(rows, test, is_nearest)
  local out, at = {}, {}
  for _, row in ipairs(rows) do
    local passes, i = test(row), is_nearest and at[row.knob] or #out + 1
    if passes ~= false and (not out[i] or row.far < out[i][1].far) then
      out[i], at[row.knob] = { row, passes == true }, i
    end
  end
  return out
end

-- Returns the row that no other beats; of rows that are about as good, the first. beats(a, b): nil if not decided,
-- which makes them rivals: both are in doubt.
local function choose(candidates, beats, doubts)
  local best
  local function doubt(row, is_rival)
    if not doubts[row] then doubts[#doubts + 1], doubts[row], row.is_rival = row, true, false end
    row.is_rival = row.is_rival or is_rival
  end
  for _, is_certain in ipairs { true, false } do
    for _, candidate in ipairs(candidates) do
      local row, wins = candidate[1], not best
      if candidate[2] == is_certain then
        if best then wins = beats(row, best) end
        if wins == nil then doubt(best, true) end
        if wins == nil or (wins and not is_certain) then doubt(row, wins == nil) end
        if wins and is_certain then best = row end
      end
    end
  end
  return best
end

-- Returns the least and the most accuracy that is gained for the time.
local function worth(row)
  local function cost(margin) return math.max(row.time + margin, 0.1) end
  return math.max(-row.average - row.margin, 1e-3) / cost(row.time_margin),
    math.max(-row.average + row.margin, 1e-3) / cost(-row.time_margin)
end

local function is_worth_more(a, b)
  local least_a, most_a = worth(a)
  local least_b, most_b = worth(b)
  if least_a >= CLEARLY * most_b then return true elseif most_a < CLEARLY * least_b then return false end
end

local function saves(row) return the.is_below(row.time, row.time_margin, SAVING) end

-- Returns the advised row, or the rows whose order is not decided: a saving, or else a step to more accuracy, or else
-- the saving that costs the least accuracy.
local function advised(study, rows)
  local doubts = {}
  local function saves_alike(row) return row.is_as_good ~= false and saves(row) and row.is_as_good end
  local function gains(row) return not row.loss and the.is_below(row.average, row.margin, GAIN) end
  local row = choose(list(rows, saves_alike), function(a, b)
    local time, margin = the.compare_times(a.case, b.case)
    return the.is_below(time, margin, SAVING)
  end, doubts)
  if #doubts > 0 or row then return row, doubts end
  row = choose(list(rows, gains, true), is_worth_more, doubts)
  if #doubts > 0 or row then return row, doubts end
  row = choose(list(rows, function(r) return not r.loss and saves(r) end, true), function(a, b)
    local average, margin = the.compare(study, a.case, b.case)
    return the.is_below(average, margin, -log(CLEARLY))
  end, doubts)
  return row, doubts
end

-- ---- What is missing ----

local function spell_ms(ms)
  if ms > HOUR_MS then return "more than an hour" end
  return ms < 120e3 and format("about %.0f s", math.ceil(ms / 1e3))
    or format("about %.0f minutes", math.ceil(ms / 60e3))
end

-- Returns whether pictures and whether timed runs can decide about the row: what is near to a limit; both for rivals.
local function wants(row)
  local time = saves(row) == nil
  local error = the.is_below(row.average, row.margin, SAME) == nil or the.is_below(row.average, row.margin, GAIN) == nil
  return error or row.is_rival or not time, time or row.is_rival or not error
end

-- Returns the time until the rows are decided. Margins fall with the root of the number of pictures and runs.
local function deciding_ms(study, doubts)
  local sum = 0
  local function times(margin, off) return math.max(margin / math.max(off, 1e-3), 1.5) ^ 2 - 1 end
  for _, row in ipairs(doubts) do
    local case, pictures, runs = row.case, wants(row)
    local off = math.min(math.abs(row.average - SAME), math.abs(row.average - GAIN))
    sum = sum + (pictures and #case.squares * times(row.margin, off) * (case.frame_ms + study.own.frame_ms) or 0)
      + (runs and case.runs * times(row.time_margin, math.abs(row.time - SAVING))
        * (case.estimate_ms + study.own.estimate_ms) or 0)
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
    return { doubts = doubts, text = format("not decided: %s: too close after %d pictures and %d runs of each; "
      .. "deciding would take %s more", names_of(doubts), #doubts[1].case.squares, doubts[1].case.runs,
      spell_ms(deciding_ms(study, doubts))) }
  end
  return { doubts = {}, decided = true, row = row, text = row and sentence(row)
    or "keep the script's setting: no setting here saves a fifth of the time or a fifth of the error" }
end

-- Renders the case with more seeds: `share` of those up to `count`.
local function add_pictures(study, case, count, share)
  for _ = 1, (count - #case.squares) * share // the.PICTURES do
    the.tools.show("deciding", case.frame_ms, 0)
    the.replicate(study, case)
  end
end

-- Doubles the pictures or the timed runs of the settings in doubt, or adds what there is time for, until the advice is
-- decided, and its share of the error is known.
function the.decide(study, until_ms)
  while true do
    the.judge(study)
    local advice, own, timed, pictures, most, ms = study.advice, study.own, {}, {}, 0, 0
    local best = advice.row
    for _, row in ipairs(best and best.margin > EXACTLY and { best } or advice.doubts) do
      local case, is_error, is_time = row.case, wants(row)
      local count = 2 * #case.squares
      if (best or is_error) and count <= the.PICTURES_MAX then
        pictures[case], most, ms = count, math.max(most, count), ms + #case.squares * case.frame_ms
      end
      if not best and is_time and case.runs < RUNS_MAX then
        timed[#timed + 1], ms = case, ms + case.runs * case.estimate_ms
      end
    end
    if most > #own.squares then pictures[own], ms = most, ms + (most - #own.squares) * own.frame_ms end
    if #timed > 0 then timed[#timed + 1], ms = own, ms + timed[1].runs * own.estimate_ms end
    local share = math.min((until_ms - the.tools.now()) / ms, 1)
    if ms == 0 or share < LEAST_SHARE then return end
    for case, count in pairs(pictures) do add_pictures(study, case, count, share) end
    if #timed > 0 then the.run_rounds(study, timed, math.ceil(timed[1].runs * share), "deciding") end
  end
end
