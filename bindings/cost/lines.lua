-- Prints the study: a table for people, or JSON lines for programs, with the advice last.
local the = ...
local format, json = string.format, the.json

-- Returns the seeds of the pictures whose mean is the reference: "3, 14 and 15".
function the.seeds_of(reference)
  local out = {}
  for i, seed in ipairs(reference.seeds) do out[i] = format("%.0f", seed) end
  return table.concat(out, ", ", 1, #out - 1) .. " and " .. out[#out]
end

-- Returns a sentence about the errors that --until and glint watch would state; "" if there is no such row.
function the.estimates_of(study)
  local out, worst = {}, 1
  for _, row in ipairs(study.rows) do
    local stated, error = row.case.estimate, row.error
    if row.knob == "samples" and stated and error and error.rmse > 0 then
      out[#out + 1] = format("%.2g for %.2g at %.0f samples", stated, error.rmse, row.value)
      worst = math.max(worst, stated / error.rmse, error.rmse / stated)
    end
  end
  if #out == 0 then return "" end
  return "Without a reference, --until and glint watch estimate an RMSE of " .. table.concat(out, ", ")
    .. format("; they are off by a factor of %.3g at most.", worst)
end

-- ---- For people ----

local function head_of(study)
  local reference = study.reference
  return study.machine .. "\n"
    .. (reference and format("reference: the mean of %d pictures of %.0f samples a pixel, decided in double "
      .. "precision, seeds %s%s; its own error, estimated from their difference, %.2g RMSE\n", #reference.seeds,
      reference.samples, the.seeds_of(reference), study.truth, reference.rmse) or "")
    .. format("\n%-24s %8s %8s %7s %6s %8s %8s %6s %6s %6s %7s %6s %6s %6s\n", "", "wall ms", "CPU ms", "+-", "x",
      "rmse",
      "relmse", "codes", ">1", ">8", "FLIP", "object", "shadow", "Mrays")
end

local function errors_for_people(row)
  local e, case = row.error, row.case
  if not e then return format(" %8s %8s %6s %6s %6s %7s %6s %6s", "-", "-", "-", "-", "-", "-", "-", "-") end
  return format(" %8.2g %8.2g %6.3g %5.2g%% %5.2g%% %7.2g %6d %6d", e.rmse, e.relmse, e.max_code, 100 * e.over1,
    100 * e.over8, e.flip, case.wrong_object, case.wrong_shadow)
end

local function row_for_people(row)
  local case = row.case
  local mark = row.default and " *" or "  "
  local label = #row.label > 22 and format("%s%s\n  %22s", mark, row.label, "") or format("%s%-22s", mark, row.label)
  return label
    .. format(" %8.4g %8.4g %7.2g %6.3g", case.wall.median, case.time.median, case.quartile_range / 2, row.x_fastest)
    .. errors_for_people(row) .. format(" %6.3g", the.all_rays(case) * 1e-6) .. (row.front and "  front" or "")
    .. (not row.own and not row.partial and row.difference == 0 and "  no difference in time" or "")
    .. (row.error and not row.resolved and "  error not resolved" or "")
    .. ((row.partial or case.left_out) and format("  partial, %d run%s", case.runs,
      case.runs == 1 and "" or "s") or "") .. "\n"
end

-- Returns a line about the rows whose times overlap the next row's.
local function rows_together(study)
  local together, runs = 0, 0
  for _, row in ipairs(study.rows) do
    together = together + (row.apart and 0 or 1)
    runs = math.max(runs, row.case.runs)
  end
  return together == 0 and "" or format("%d of %d rows take about as long as the row next to them: after up to %d "
    .. "runs their times still overlap.\n",
    together, #study.rows, runs)
end

function the.table(study)
  local out, knob = { head_of(study) }, nil
  for _, row in ipairs(study.rows) do
    local heading = row.knob or "combinations"
    if heading ~= knob then out[#out + 1] = heading .. "\n" end
    knob = heading
    out[#out + 1] = row_for_people(row)
  end
  out[#out + 1] = format("\n* the script's own setting. wall ms, CPU ms: medians of at least %d runs of rendering, "
    .. "tone mapping and encoding a\nwhole frame, by the clock and on all processors. +-: half the quartile range of "
    .. "the CPU time. x: the CPU time divided\nby that of the fastest setting; all comparisons use CPU time. codes: "
    .. "the largest error, in 8-bit steps. >1, >8: the\nfraction of pixels with a larger error. object, shadow: the "
    .. "number of pixels with a wrong object or a wrong shadow.\n", study.runs)
  out[#out + 1] = rows_together(study)
  local estimates = the.estimates_of(study)
  if estimates ~= "" then out[#out + 1] = estimates .. "\n" end
  if #study.left_out > 0 then out[#out + 1] = "left out:\n" end
  for _, line in ipairs(study.left_out) do out[#out + 1] = "  " .. line .. "\n" end
  return table.concat(out) .. "\n" .. study.advice .. "\n"
end

-- ---- For programs ----

-- Returns "name":value for each name, in order.
local function members(values, ...)
  local out = {}
  for i, name in ipairs { ... } do out[i] = json(name) .. ":" .. json(values[name]) end
  return table.concat(out, ",")
end

local RAYS <const> = { "primary", "shadow", "mirror", "refraction", "indirect" }

local function counters_of(case)
  return members(case.rays, table.unpack(RAYS)) .. "," .. members(case, "refined") .. ","
    .. members(case.work or {}, "tests", "light_samples", "powers", "sites", "overlaps", "lights_seen")
end

local function settings_of(row)
  local out = {}
  for i, setting in ipairs(row.case.settings) do out[i] = json(setting.knob) .. ":" .. json(setting.value) end
  return ',"settings":{' .. table.concat(out, ",") .. "}"
end

local function quartiles_for_programs(name, time)
  return format(',"%s":{"min":%.4f,"q1":%.4f,"median":%.4f,"q3":%.4f}', name, time.min, time.q1, time.median, time.q3)
end

local function row_for_programs(row)
  local case, e = row.case, row.error or {}
  local wrong = row.error and case or {}
  return '{"knob":' .. json(row.knob or "combination") .. ',"value":' .. json(row.value)
    .. quartiles_for_programs("ms", case.wall) .. quartiles_for_programs("cpu", case.time)
    .. format(',"x_fastest":%.4f,', row.x_fastest)
    .. members(e, "rmse", "relmse", "max_code", "over1", "over8", "flip") .. "," .. members(case, "estimate") .. ","
    .. members(wrong, "wrong_object", "wrong_shadow") .. ',"counters":{' .. counters_of(case) .. '},'
    .. format('"pareto":%s,"default":%s,"resolved":%s,"difference":"%s",', row.front, row.default, row.resolved,
      ({ "faster", "no difference", "slower" })[row.difference + 2])
    .. format('"runs":%d,"frames_a_run":%d,"partial":%s,"apart":%s,', case.runs, case.frames, row.partial, row.apart)
    .. format('"parts":{"render":%.4f,"tone":%.4f,"encode":%.4f},"cpu_ms":%.4f', case.render, case.tone, case.encode,
      case.time.median)
    .. (row.knob and "" or settings_of(row)) .. "}\n"
end

local function reference_for_programs(reference)
  if not reference then return "null" end
  return format('{"samples":%.0f,"seeds":[%s],', reference.samples, (the.seeds_of(reference):gsub(" and ", ",")))
    .. members(reference, "rmse", "relmse", "max_code", "flip") .. "}"
end

function the.events(study)
  local out, left_out = {}, {}
  for i, row in ipairs(study.rows) do out[i] = row_for_programs(row) end
  for i, line in ipairs(study.left_out) do left_out[i] = json(line) end
  return table.concat(out) .. '{"event":"advice","text":' .. json(study.advice) .. ',"reference":'
    .. reference_for_programs(study.reference) .. ',"left_out":[' .. table.concat(left_out, ",") .. '],"machine":'
    .. json(study.machine) .. format(',"width":%.0f,"height":%.0f,"seconds":%.3f,"complete":%s}\n', study.width,
      study.height, study.seconds, study.complete)
end
