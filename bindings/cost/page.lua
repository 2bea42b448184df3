-- The page of glint cost: page.html with its @NAMES@ replaced, and the plot and pictures embedded. It needs no network.
local the = ...
local format = string.format

local function all_rays(case)
  local rays = case.rays
  return 0.0 + rays.primary + rays.shadow + rays.mirror + rays.refraction + rays.indirect
end
the.all_rays = all_rays

local function cell(value, how, shown)
  if not value or value ~= value or math.abs(value) == math.huge then return "<td data-v=''>&ndash;</td>" end
  return format("<td data-v='%.9g'>", value) .. format(how, shown or value) .. "</td>"
end

-- Returns the tooltip of the row's point.
local function text_of(row)
  local time, error, case = row.case.time, row.error, row.case
  local text = format("%s: %.4g ms of processor time (%.4g to %.4g), %.4g ms by the clock, %.3g times the script&#39;s",
    the.html(row.own and "the script's own setting" or row.name), time.median, time.q1, time.q3, case.wall.median,
    row.x_own)
  if error then
    text = text .. format("; RMSE %.2g", error.rmse) .. (error.noise and format(" +- %.1g (noise %.2g, bias %s)",
      error.spread, error.noise, the.bias_of(error)) or "")
      .. format(", FLIP %.2g, %.2g %% of the pixels off by more than one 8-bit value",
        error.flip, 100 * error.over1)
  end
  return text .. the.html(the.remarks_of(row))
end
the.text_of = text_of

local function errors_of(row)
  local e = row.error or {}
  return cell(e.rmse, "%.2g") .. cell(e.spread, "%.1g") .. cell(e.noise, "%.2g")
    .. cell(e.bias, "%s", e.bias and the.bias_of(e)) .. cell(e.over1, "%.2g %%", 100 * (e.over1 or 0))
    .. cell(e.flip, "%.2g")
end

local function row_of(row)
  local time, remarks = row.case.time, the.remarks_of(row)
  return format("<tr id='row-%d' data-text='%s'><td data-v='%03d'><span class='%s'>%s</span></td>", row.index,
    text_of(row), row.index, row.default and "own" or row.front and "best" or "", the.html(row.name))
    .. cell(time.median, "%.4g") .. cell(row.x_own, "%.3g") .. errors_of(row)
    .. format("<td class='remark' data-v='%s'>%s</td></tr>\n", the.html(remarks), the.html(remarks:sub(3)))
end

-- Returns the picture's URL: embedded in the page, or a separate file if the page would become too large.
local function picture(study, name, what, bytes)
  local source = study.is_light and "data:image/png;base64," .. the.base64(bytes) or name .. ".png"
  return format("<img loading='lazy' width='%.0f' height='%.0f' alt='%s' src='", study.width, study.height, what)
    .. source .. "'>"
end

local function pictures_of(study)
  if not study.reference or #study.pictures == 0 then return "" end
  local out = { "<h2>The pictures, and their errors times 16</h2>\n<div class='pictures'>\n" }
  for _, shown in ipairs(study.pictures) do
    out[#out + 1] = "<figure><div class='pair'>" .. picture(study, shown.file, "the picture", shown.picture)
      .. picture(study, shown.file .. "_error", "its error times 16", shown.difference)
      .. "</div><figcaption class='small'>" .. the.html(shown.title) .. "</figcaption></figure>\n"
  end
  return table.concat(out) .. "</div>\n"
end

local function lead_of(study)
  return format("Frame %d, %.0f &times; %.0f pixels, %.0f sample%s per pixel, each setting timed %d times in random "
    .. "order",
      study.frame, study.width, study.height, study.samples, study.samples == 1 and "" or "s", study.runs)
    .. (study.complete and " on " or " (interrupted: part of the study only) on ") .. the.html(study.machine) .. "."
end

local function reference_of(study)
  local reference = study.reference
  if not reference then return "No reference was rendered, so no error is known." end
  return format("Each setting was rendered with %d or more seeds, none of them the script's. Errors are against the "
    .. "mean of %d pictures of %.0f samples a pixel, decided in double precision, with seeds %s%s. Their difference "
    .. "shows that this mean itself has an error of about %.2g RMSE, which is taken out; errors below three times that "
    .. "value are marked as not resolved.", the.PICTURES, #reference.seeds, reference.samples,
    the.spell_seeds(reference.seeds), study.truth, reference.rmse)
end

local function left_out_of(study)
  if #study.left_out == 0 then return "" end
  local out = {}
  for i, line in ipairs(study.left_out) do out[i] = "<li>" .. the.html(line) .. "</li>\n" end
  return "<h2>Left out</h2>\n<ul>\n" .. table.concat(out) .. "</ul>\n"
end

function the.page(study)
  local rows, apart = {}, {}
  for _, row in ipairs(study.rows) do
    local list = row.other_time and apart or rows
    list[#list + 1] = row_of(row)
  end
  local parts = { SCRIPT = the.html(study.script), LEAD = lead_of(study), REFERENCE = reference_of(study),
    PLOT = the.plot(study) or "", ROWS = table.concat(rows), LEFT_OUT = left_out_of(study),
    APART = #apart > 0 and "<tr><td class='apart'>an unchanged frame after its neighbour</td></tr>\n"
      .. table.concat(apart) or "", PICTURES = pictures_of(study), ADVICE = the.html(study.advice.text),
    LIVE = study.live and "<h2>Try it</h2>\n" .. study.live or "" }
  return (study.page:gsub("@(%u[%u_]*)@", parts))
end
