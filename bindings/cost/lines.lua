-- Prints the study: a table for people, or JSON lines for programs, with the advice last.
local the = ...
local format, json = string.format, the.json

-- Returns the first `count` seeds, or all, as text: "3, 14 and 15", or with another word before the last.
function the.spell_seeds(seeds, last, count)
  local out = {}
  for i = 1, count or #seeds do out[i] = format("%.0f", seeds[i]) end
  return table.concat(out, ", ", 1, #out - 1) .. (last or " and ") .. out[#out]
end

-- Returns what the row loses and how it compares with the script's own setting, for people.
function the.remarks_of(row)
  local loss = row.loss and format(", %s: %.2g %% of the pixels change by more than one value", row.loss,
    100 * row.case.changed) or row.verdict and not row.own and ", error " .. row.verdict or ""
  return (row.front and ", front" or "") .. loss
    .. (row.error and not row.resolved and ", error not resolved" or "")
    .. ((row.partial or row.case.left_out) and ", partial" or "")
end

-- Returns the bias as text: "0" if the noise hides it.
function the.bias_of(error)
  return not error.bias and "-" or error.bias > 0 and format("%.2g", error.bias) or "0"
end

-- ---- For people ----

local function head_of(study)
  local reference = study.reference
  return study.machine .. "\n"
    .. (reference and format("reference: the mean of %d pictures of %.0f samples a pixel, decided in double "
      .. "precision, seeds %s%s; its own error, estimated from their difference, %.2g RMSE\n", #reference.seeds,
      reference.samples, the.spell_seeds(reference.seeds), study.truth, reference.rmse) or "")
    .. format("\n%-24s %8s %6s %8s %7s %7s %7s %6s %6s\n", "", "ms", "times", "error", "+-", "noise", "bias", ">1",
      "FLIP")
end

local function errors_for_people(row)
  local e = row.error
  if not e then return format(" %8s %7s %7s %7s %6s %6s", "-", "-", "-", "-", "-", "-") end
  return format(" %8.2g %7s %7s %7s %5.2g%% %6.2g", e.rmse, e.spread and format("%.1g", e.spread) or "-",
    e.noise and format("%.2g", e.noise) or "-", the.bias_of(e), 100 * e.over1, e.flip)
end

local function row_for_people(row)
  local mark = row.default and " *" or "  "
  return format("%s%-22s %8.4g %6.3g", mark, row.label, row.case.time.median, row.x_own) .. errors_for_people(row)
    .. the.remarks_of(row):gsub("^,", " ") .. "\n"
end

function the.table(study)
  local out, knob = { head_of(study) }, nil
  for _, row in ipairs(study.rows) do
    local heading = row.other_time and "\nan unchanged frame after its neighbour: reuse" or row.knob
    if heading ~= knob then out[#out + 1] = heading .. "\n" end
    knob = heading
    out[#out + 1] = row_for_people(row)
  end
  out[#out + 1] = format([[

* the script's own setting. ms: processor time of rendering, tone mapping and encoding a whole frame, median of %d
runs. times: ms divided by that of the script's setting. error: RMSE of linear light, mean over %d or more seeds; +-:
its spread from seed to seed. noise falls with more samples, bias does not; 0: the noise hides it. >1: pixels off by
more than one 8-bit value. "better", "worse" and "equal" (within 5 %%) hold for all rows together in 95 of 100 studies.
]], study.runs, the.PICTURES)
  if #study.left_out > 0 then out[#out + 1] = "left out:\n" end
  for _, line in ipairs(study.left_out) do out[#out + 1] = "  " .. line .. "\n" end
  return table.concat(out) .. "\n" .. study.advice.text .. "\n"
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

local function quartiles_for_programs(name, time)
  return format(',"%s":{"min":%.4f,"q1":%.4f,"median":%.4f,"q3":%.4f}', name, time.min, time.q1, time.median, time.q3)
end

local function row_for_programs(row)
  local case, e = row.case, row.error or {}
  return '{"knob":' .. json(row.knob) .. ',"value":' .. json(row.value)
    .. quartiles_for_programs("ms", case.wall) .. quartiles_for_programs("cpu", case.time)
    .. format(',"x_own":%.4f,', row.x_own)
    .. members(e, "rmse", "spread", "noise", "bias", "relmse", "max_code", "over1", "over8", "flip") .. ","
    .. members(row, "verdict", "loss") .. "," .. members(case, "changed") .. format(',"pictures":%d,', #case.squares)
    .. '"counters":{' .. counters_of(case) .. '},'
    .. format('"pareto":%s,"default":%s,"resolved":%s,"difference":"%s",', row.front, row.default, row.resolved,
      ({ "faster", "no difference", "slower" })[row.difference + 2])
    .. format('"runs":%d,"frames_a_run":%d,"partial":%s,', case.runs, case.frames, row.partial)
    .. format('"parts":{"render":%.4f,"tone":%.4f,"encode":%.4f},"cpu_ms":%.4f', case.render, case.tone, case.encode,
      case.time.median) .. "}\n"
end

local function reference_for_programs(reference)
  if not reference then return "null" end
  return format('{"samples":%.0f,"seeds":[%s],', reference.samples, the.spell_seeds(reference.seeds, ", "))
    .. members(reference, "rmse") .. "}"
end

function the.events(study)
  local out, left_out = {}, {}
  for i, row in ipairs(study.rows) do out[i] = row_for_programs(row) end
  for i, line in ipairs(study.left_out) do left_out[i] = json(line) end
  return table.concat(out) .. '{"event":"advice","text":' .. json(study.advice.text)
    .. format(',"decided":%s,"reference":', study.advice.decided or false) .. reference_for_programs(study.reference)
    .. (study.reference and ',"seeds":[' .. the.spell_seeds(study.seeds, ", ", #study.own.squares) .. "]" or "")
    .. ',"left_out":[' .. table.concat(left_out, ",") .. '],"machine":'
    .. json(study.machine) .. format(',"width":%.0f,"height":%.0f,"seconds":%.3f,"complete":%s}\n', study.width,
      study.height, study.seconds, study.complete)
end
