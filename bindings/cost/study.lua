-- The phases of a study in order: the settings to measure, each once, and the rows of the table that show them; their
-- measurement; the output.
local the = ...
local format = string.format

local RUNS <const>, RUNS_QUICK <const> = 11, 5 -- timed runs of each setting, not counting the first
local RUN_MS <const>, RUN_QUICK_MS <const> = 30.0, 5.0 -- short frames are repeated until a run takes this long
local ALLOWANCE_MS <const>, ALLOWANCE_QUICK_MS <const> = 45e3, 5e3 -- time for the reference without a budget
local BUDGET_SHARE <const> = 0.3 -- share of a budget for the reference
local BASE_FRAMES <const> = 3 -- frames: one that is dropped, one that counts the work, one that is timed
local DECIDING_SHARE <const> = 0.6 -- time to decide without a budget, relative to that of the timed runs
local LONG_MS <const> = 120e3 -- a longer study is announced
local PAGE_MAX <const> = 12000000 -- bytes of pictures embedded in the page
the.RUNS_LEAST = 3 -- quartiles of fewer runs mean nothing

-- Returns a value as text.
function the.spell(value) return type(value) == "number" and the.json(value) or value end

-- Notes what the budget or the scene excludes.
function the.leave_out(study, ...) study.left_out[#study.left_out + 1] = format(...) end

-- ---- Cases and rows ----

-- Adds a setting to measure. choice: the value of each knob that differs from the base.
local function add_case(study, choice, name)
  local case = { choice = choice, name = name, knob = next(choice), runs = 0, batch = 1, estimate_ms = 0.0,
    left_out = false, is_first_alone = false, squares = {}, products = {}, -- of the errors of pictures, see replicate
    rounds = {}, -- of the runs
    ms = { render = {}, tone = {}, encode = {}, wall = {}, cpu = {} } }
  study.cases[#study.cases + 1] = case
  return case
end

-- Varies one knob around the base.
local function add_knob(study, knob)
  local values = study.values[knob.name] or {}
  local base = values.base or values.own
  for i, value in ipairs(values) do
    local label = the.spell(value)
    local name = knob.name .. " " .. label
    local case = i == base and study.own or add_case(study, { [knob.name] = value }, name)
    study.rows[#study.rows + 1] = { knob = knob.name, value = value, label = label, name = name, case = case,
      own = case == study.own, far = math.abs(i - base),
      own_label = the.spell(values[values.own]), default = i == values.own, is_of_file = knob.is_of_file,
      other_time = knob.is_other_time or false, may_lose = knob.loses,
      is_truer = values.truth and values.own < i and i <= values.truth }
    case.needs_file = case.needs_file or knob.is_of_file
    case.may_lose = knob.loses and case ~= study.own and not study.rows[#study.rows].is_truer
  end
end

local function list_cases(study)
  local found, changing = false, {}
  local request = study.knobs and "," .. study.knobs .. ","
  for _, knob in ipairs(the.knobs) do
    local values = knob.list(study) or nil
    if values then changing[#changing + 1] = knob.name end
    if not request or request:find("," .. knob.name .. ",", 1, true) then
      study.values[knob.name], found = values, found or values
      if request and not values then
        the.leave_out(study, "%s: changes nothing in this scene; it would need %s", knob.name, knob.needs)
      end
    end
  end
  if not found then
    the.tools.refuse(format("--knobs: expected a knob that changes this scene (%s), got '%s'",
      table.concat(changing, ", "), (study.knobs or ""):sub(1, 200)))
  end
  study.own = add_case(study, {})
  for _, knob in ipairs(the.knobs) do add_knob(study, knob) end
  if study.lack then
    the.leave_out(study, "the open shutter: %s; the frame is measured at one instant, without motion blur", study.lack)
  end
end

-- ---- Measuring ----

-- Guesses the times of the cases from their number of rays, before their first run.
local function guess(study)
  local function rays_of(case)
    local plan <close> = the.tools.plan(case.choice, "beauty")
    return the.tools.rays(plan)
  end
  local own, own_rays = study.own, rays_of(study.own)
  for i = 2, #study.cases do
    local case = study.cases[i]
    local share = own_rays > 0 and math.max(rays_of(case) / own_rays, 0.2) or 1
    case.frame_ms = (own.guess_ms or own.estimate_ms) * share
    case.estimate_ms = math.max(case.frame_ms, study.run_ms)
  end
end

local function warn_long(study)
  local ms = the.round_ms(study) * (study.runs + 2)
  if study.deadline_ms < math.huge or ms < LONG_MS then return end
  the.tools.say(format("glint: this will take about %.0f minutes; use --quick, --budget SECONDS, --knobs LIST or "
    .. "--size to shorten it, or press Ctrl-C to see the results so far\n", math.ceil(ms / 60e3)))
end

-- Returns the time to measure a case: one run, its errors, its pictures, and the least number of further runs.
function the.price_of(study, case)
  return study.overhead_ms + case.estimate_ms * (1 + the.RUNS_LEAST) + case.frame_ms * the.PICTURES
end

-- Returns the time of a whole study: what it has taken, and what was left out for want of time.
function the.whole_ms(study)
  local own, sum = study.own, the.tools.now() - study.start_ms
  if not own.frame_ms then study.overhead_ms, own.frame_ms = 2 * own.estimate_ms, own.estimate_ms end
  if not study.reference then sum = sum + the.reference_ms(study) end
  for _, case in ipairs(study.cases) do
    if case.runs < the.RUNS_LEAST and case.frame_ms then sum = sum + the.price_of(study, case) end
  end
  return 1.5 * sum
end

-- Leaves out the slowest cases if not all fit the budget.
local function fit_cases(study)
  local cases, sum = table.move(study.cases, 2, #study.cases, 1, {}), study.own.estimate_ms * the.RUNS_LEAST
  table.sort(cases, function(a, b) return a.estimate_ms < b.estimate_ms end)
  for _, case in ipairs(cases) do
    sum = sum + the.price_of(study, case)
    case.left_out = sum > the.left_ms(study)
  end
end

-- Runs the cases once and measures their errors. Cases that do not fit the budget are left out.
local function measure_cases(study)
  fit_cases(study)
  for i = 2, #study.cases do
    local case, remaining_ms = study.cases[i], the.round_ms(study) * study.runs
    for later = i + 1, #study.cases do
      local other = study.cases[later]
      remaining_ms = remaining_ms + (other.left_out and 0 or study.overhead_ms + other.estimate_ms)
    end
    if not case.left_out then
      the.tools.show("errors", study.overhead_ms + case.estimate_ms, remaining_ms)
      the.measure(study, case)
    end
  end
end

local function name_unmeasured(study)
  for _, row in ipairs(study.rows) do
    if row.case.runs == 0 then
      the.leave_out(study, "%s: not measured: the budget leaves no time for it", row.name)
    end
  end
end

-- Measures the script's own setting, which is never left out, and the time that it takes to find an error.
local function measure_own(study)
  local start, own = the.tools.now(), study.own
  the.tools.show("errors", own.estimate_ms, the.round_ms(study) * (study.runs + 2))
  the.measure(study, own)
  study.overhead_ms = math.max(the.tools.now() - start - (1 + the.PICTURES) * own.guess_ms, 0)
end

local function run_study(study)
  local own = study.own
  the.tools.show("first frame", 1, 0)
  the.run(own)
  own.is_first_alone = true
  guess(study)
  if the.left_ms(study) < BASE_FRAMES * own.estimate_ms then
    study.runs = 1
    the.leave_out(study, "every error, and all runs except the first frame: the budget leaves no time for more")
    return name_unmeasured(study)
  end
  warn_long(study)
  the.make_reference(study, study.deadline_ms < math.huge and BUDGET_SHARE * the.left_ms(study)
    or study.quick and ALLOWANCE_QUICK_MS or ALLOWANCE_MS)
  measure_own(study)
  guess(study)
  measure_cases(study)
  name_unmeasured(study)
  the.time_cases(study)
  if study.reference then
    the.decide(study, study.deadline_ms < math.huge and study.deadline_ms
      or the.tools.now() + DECIDING_SHARE * study.runs * the.round_ms(study))
  end
end

-- ---- Output ----

-- Lists the pictures worth showing: not those that equal the script's own (with another encoder, for example). They
-- are separate files if the page would become too large.
local function list_pictures(study)
  local sum = 0
  study.pictures = {}
  for _, case in ipairs(study.own.picture and study.cases or {}) do
    local is_own = case == study.own
    if case.picture and (is_own or case.picture ~= study.own.picture) then
      sum = sum + #case.picture + #case.difference
      study.pictures[#study.pictures + 1] = { title = is_own and "the script's own setting" or case.name,
        file = is_own and "own" or case.name:gsub("[ =]", "_"), picture = case.picture, difference = case.difference }
    end
  end
  study.is_light = sum <= PAGE_MAX
end

-- Writes the page, its plot as a separate file, and the pictures if the page does not contain them.
local function write_report(study)
  local write = the.tools.write
  list_pictures(study)
  local plot, page = the.plot(study), the.page(study)
  for _, shown in ipairs(study.is_light and {} or study.pictures) do
    write(shown.file .. ".png", shown.picture)
    write(shown.file .. "_error.png", shown.difference)
  end
  write("plot.svg", plot) -- nil: this study has no errors to draw, and the plot of an earlier one is removed
  write("index.html", page)
end

local function say_frame(study)
  the.tools.say(format("%s, frame %d%s%s: %.0f x %.0f, %.0f sample%s a pixel\n", study.script, study.frame,
    study.total and " of " .. study.total or "", study.total == 1 and "" or " (choose another with --frame N)",
    study.width, study.height, study.samples, study.samples == 1 and "" or "s"))
end

local function keep_measured(study)
  local rows = {}
  for _, row in ipairs(study.rows) do
    if row.case.runs > 0 then rows[#rows + 1] = row end
  end
  study.rows = rows
end

function the.study(tools)
  the.tools = tools
  if tools.knobs then the.check_knobs(tools.knobs) end
  local study = tools.open()
  study.cases, study.rows, study.values, study.left_out = {}, {}, {}, {}
  study.random, study.deadline_ms = { state = 0 }, study.deadline_ms or math.huge
  study.runs = study.quick and RUNS_QUICK or RUNS
  study.run_ms = study.quick and RUN_QUICK_MS or RUN_MS
  list_cases(study)
  study.live = tools.live()
  say_frame(study)
  study.complete = true
  local good, message = pcall(function()
    study.machine = tools.begin()
    run_study(study)
  end)
  if not good and message then error(message, 0) end -- without a message the run has failed or was interrupted
  study.complete = good
  if not tools.finish() then return end
  the.judge(study)
  keep_measured(study)
  if #study.rows == 0 then return end
  study.seconds = (tools.now() - study.start_ms) * 1e-3
  tools.print(study.json and the.events(study) or the.table(study))
  if study.report then write_report(study) end
end
