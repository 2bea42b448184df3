-- Measures the distance of a setting from the truth: the reference and its own error, and pictures with
-- several seeds.
local the = ...

local PARTS <const> = 4 -- the reference is the mean of this many pictures with different seeds
local TIMES <const> = 32 -- samples of each part, relative to the script's
local LEAST_TIMES <const> = 2 -- minimum of TIMES if a budget forces fewer; with fewer the errors mean nothing
local BATCH_MAX <const> = 1000 -- frames in a run
the.PICTURES = 3 -- pictures of each setting, with different seeds; as many more at a time, up to
the.PICTURES_MAX = 384

-- ---- The reference ----

-- Returns the time of a full reference.
function the.reference_ms(study) return PARTS * TIMES * study.own.render_ms end

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

-- Chooses the seeds of the reference, and those of the pictures of each setting. Seeds are below 2^20, so that a
-- seed's shift keeps all of its digits. None is the script's: seed 0 suits powers of two better than other seeds do.
local function choose_seeds(study)
  local generator, seeds, taken = { state = study.seed }, {}, { [study.seed] = true }
  while #seeds < PARTS + the.PICTURES_MAX do
    local seed = 1 + (the.next_random(generator) & 0xfffff)
    if not taken[seed] then seeds[#seeds + 1], taken[seed] = seed, true end
  end
  study.seeds = table.move(seeds, PARTS + 1, #seeds, 1, {})
  return table.move(seeds, 1, PARTS, 1, {})
end

-- Returns the error of the mean of independent parts: the sum of their squared distances from it over n (n - 1) is the
-- variance of the mean.
local function measure_parts(parts)
  local n, sum = PARTS, 0
  for _, part in ipairs(parts) do sum = sum + the.tools.distance(part) end
  return { square = sum / (n * (n - 1)), rmse = math.sqrt(sum / (n * (n - 1))) }
end

-- Makes the reference and finds its own error. `allowance_ms` is the time for all parts.
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
  the.tools.reference(false, table.unpack(parts))
  local reference = measure_parts(parts)
  for _, part in ipairs(parts) do the.tools.close(part) end
  reference.samples, reference.seeds = samples, seeds
  study.reference = reference
end

-- ---- A case ----

-- Renders the case with the next seeds and adds the pictures' errors. `image`: the first of them, if it is rendered.
--
-- Two pictures have the errors b + x and b + y, where b is the bias and x and y are independent noise. The product of
-- the errors has the mean b^2; their squares and the square of x - y, the pictures' distance, tell it.
function the.replicate(study, case, image)
  local images, squares, before = { image }, case.squares, #case.squares
  for i = #images + 1, the.PICTURES do
    local plan <close> = the.tools.plan(case.choice, "beauty", nil, study.seeds[before + i])
    images[i] = the.tools.picture(plan)
  end
  for i, picture in ipairs(images) do
    squares[before + i] = the.tools.distance(picture)
    for k = 1, i - 1 do
      local apart = the.tools.distance(picture, images[k])
      case.products[#case.products + 1] = (squares[before + i] + squares[before + k] - apart) / 2
        - study.reference.square
    end
  end
  for i = image and 2 or 1, #images do the.tools.close(images[i]) end
end

local function find_errors(study, case, image)
  case.film = the.tools.errors(image, 0)
  case.file = case.needs_file and the.tools.errors(image, case.choice.bits or study.bits) or nil
  if case == study.own then the.tools.reference(true, image) end
  case.changed = case.may_lose and the.tools.errors(image, 0, true).over1 or nil
  if study.report then
    local difference <close> = the.tools.difference(image)
    case.picture, case.difference = the.tools.png(image), the.tools.png(difference)
  end
  the.replicate(study, case, image)
end

-- Runs a case once; measures its work and errors; makes the pictures for the report.
function the.measure(study, case)
  case.is_first_alone, case.runs, case.batch = false, 0, 1
  the.run(case)
  case.is_first_alone = true
  local own, is_repeat = study.own, case.choice.reuse -- a frame after its neighbour, which has the script's seed
  local seed = study.reference and not is_repeat and study.seeds[1] or nil
  local plan <close> = the.tools.plan(case.choice, "both", nil, seed)
  local image <close>, stats = the.tools.picture(plan, true)
  case.guess_ms = math.min(case.ms.wall[1], stats.render_ms + stats.tone_ms + case.ms.encode[1])
  case.work = stats.work
  -- The untimed costs of the frames may make a run longer, but at most 3 run_ms.
  local frames = math.min(study.run_ms / math.max(case.guess_ms, 1e-3), 3 * study.run_ms / case.estimate_ms)
  case.frame_ms = case.estimate_ms
  case.batch = math.ceil(math.min(math.max(frames, 1), BATCH_MAX))
  case.estimate_ms = case.estimate_ms * case.batch
  if is_repeat and own.film then -- the picture is the same, bit for bit
    case.film, case.squares, case.products = own.film, own.squares, own.products
  elseif study.reference then
    find_errors(study, case, image)
  end
end
