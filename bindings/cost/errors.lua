-- Measures the distance of a setting from the truth: the reference and its own error, decisions pixel by pixel.
local the = ...

local PARTS <const> = 4 -- the reference is the mean of this many pictures with different seeds
local TIMES <const> = 32 -- samples of each part, relative to the script's
local LEAST_TIMES <const> = 2 -- minimum of TIMES if a budget forces fewer; with fewer the errors mean nothing
local LIGHTS_MAX <const> = 8 -- number of lights checked one by one
local BATCH_MAX <const> = 1000 -- frames in a run

-- Returns the visible object and the lights that reach it, at the sample in the middle of each pixel.
local function decide(study, choice, is_exact)
  local planes, count = {}, #study.lights
  for light = 1, count <= LIGHTS_MAX and math.max(count, 1) or 1 do
    local plan <close> = the.tools.plan(choice, "decisions", 1, nil, is_exact, count <= LIGHTS_MAX and light or nil)
    local image <close> = the.tools.picture(plan)
    local lit, objects = the.tools.decisions(image, light == 1)
    planes[1], planes[light + 1] = planes[1] or objects, lit
  end
  return planes
end

-- ---- The reference ----

-- Returns the samples of each part: 32 times the script's, or more, up to 32 times the most in any row if the allowance
-- permits. A budget may force fewer; nil: no reference.
local function choose_samples(study, allowance_ms)
  local own = study.samples
  local each, most, samples = PARTS * study.own.render_ms / own, own, TIMES * own
  for _, value in ipairs(study.values.samples or {}) do most = math.max(most, value) end
  while study.deadline_ms < math.huge and samples >= LEAST_TIMES * own and each * samples > allowance_ms do
    samples = samples / 4
  end
  while samples < TIMES * most and each * samples * 2 <= allowance_ms do samples = samples * 2 end
  return samples >= LEAST_TIMES * own and math.min(samples, 65536) or nil
end

-- Returns the script's settings, except for knobs that have a setting nearer to the truth, and their description.
local function choose_truth(study)
  local choice, name = {}, ""
  for _, knob in ipairs(the.knobs) do
    local values = study.values[knob.name]
    local value = values and values[values.truth]
    if value then
      choice[knob.name], name = value, name .. ", with " .. knob.name .. " " .. the.spell(value)
    end
  end
  return choice, name
end

-- Chooses independent seeds. Neighbouring seeds share a sequence, so their errors might cancel. Seeds are below 2^20,
-- so that a seed's shift keeps all of its digits.
local function choose_seeds(study)
  local generator, seeds, taken = { state = study.seed }, {}, { [study.seed] = true }
  while #seeds < PARTS do
    local seed = 1 + (the.next_random(generator) & 0xfffff)
    if not taken[seed] then seeds[#seeds + 1], taken[seed] = seed, true end
  end
  return seeds
end

-- Estimates the error of the mean from the differences between n independent parts and their mean: the sum of their
-- squares over n (n - 1) is the variance of the mean.
local function measure_parts(parts)
  local n, sum = PARTS, { rmse = 0.0, relmse = 0.0, max_code = 0.0, over1 = 0.0, over8 = 0.0, flip = 0.0 }
  for _, part in ipairs(parts) do
    local error = the.tools.errors(part, 0)
    sum.rmse = sum.rmse + error.rmse * error.rmse / (n * (n - 1))
    sum.relmse = sum.relmse + error.relmse / (n * (n - 1))
    sum.max_code = math.max(sum.max_code, error.max_code)
    sum.flip = sum.flip + error.flip / n
  end
  sum.rmse = math.sqrt(sum.rmse)
  return sum
end

-- Makes the reference, its own error and the true decisions. `allowance_ms` is the time for all parts.
function the.make_reference(study, allowance_ms)
  local choice
  local samples, own = choose_samples(study, allowance_ms), study.samples
  choice, study.truth = choose_truth(study)
  if not samples then
    return the.leave_out(study, "every error: the budget leaves no time for a reference")
  elseif samples < TIMES * own then
    the.leave_out(study, "a full reference: %.0f samples instead of %.0f", PARTS * samples, PARTS * TIMES * own)
  end
  local parts, seeds, part_ms = {}, choose_seeds(study), study.own.render_ms / own * samples
  for i, seed in ipairs(seeds) do
    the.tools.show("reference", part_ms, (PARTS - i) * part_ms + the.round_ms(study) * (study.runs + 2))
    local plan <close> = the.tools.plan(choice, "beauty", samples, seed, true)
    parts[i] = the.tools.picture(plan)
  end
  the.tools.reference(table.unpack(parts))
  local reference = measure_parts(parts)
  for _, part in ipairs(parts) do the.tools.close(part) end
  reference.samples, reference.seeds, study.decisions = samples, seeds, decide(study, choice, true)
  study.reference = reference
end

-- ---- A case ----

-- Estimates the error of a picture without the reference, as --until does, for cases that differ in their samples.
local function estimate(study, case, image)
  local samples = case.choice.samples or study.samples
  if samples < 2 or #case.settings > (case.choice.samples and 1 or 0) then return end
  local plan <close> = the.tools.plan(case.choice, "beauty", 4 * samples, the.tools.partner_seed(samples))
  local partner <close> = the.tools.picture(plan)
  local stated = the.tools.estimate(image, partner)
  return stated > 0 and stated or nil
end

local function find_errors(study, case, image)
  local film = the.tools.errors(image, 0)
  local file = case.needs_file and the.tools.errors(image, case.choice.bits or study.bits) or nil
  case.estimate = estimate(study, case, image)
  case.wrong_object, case.wrong_shadow = the.tools.differ(decide(study, case.choice), study.decisions)
  if study.report then
    local difference <close> = the.tools.difference(image)
    case.picture, case.difference = the.tools.png(image), the.tools.png(difference)
  end
  case.film, case.file = film, file
end

-- Runs a case once; measures its work, errors and decisions; makes the pictures for the report.
function the.measure(study, case)
  case.is_first_alone, case.runs, case.batch = false, 0, 1
  the.run(case)
  case.is_first_alone = true
  local cpu = the.tools.cpu()
  local plan <close> = the.tools.plan(case.choice, "both")
  local image <close>, stats = the.tools.picture(plan, true)
  case.guess_cpu_ms = math.min(case.ms.cpu[1], the.tools.cpu() - cpu)
  case.guess_ms = math.min(case.ms.wall[1], stats.render_ms + stats.tone_ms + case.ms.encode[1])
  case.work = stats.work
  -- The untimed costs of the frames may make a run longer, but at most 3 run_ms.
  local frames = math.min(study.run_ms / math.max(case.guess_ms, 1e-3), 3 * study.run_ms / case.estimate_ms)
  case.batch = math.ceil(math.min(math.max(frames, 1), BATCH_MAX))
  case.estimate_ms = case.estimate_ms * case.batch
  if study.reference then find_errors(study, case, image) end
end
