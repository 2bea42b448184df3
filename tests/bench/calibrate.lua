-- How often `--until-light` and the advice of `glint cost` are right, against brute force: lua5.4 calibrate.lua SCENES SEEDS
-- SIZE. Prints a row for each scene. A test that loads it gets the function, which returns the counts.
local build = os.getenv "BUILD" or "build"
local glint = os.getenv "GLINT" or build .. "/glint"
local folder = build .. "/tests/calibrate"
local SCENES <const> = { "roughness", "workshop", "soft_shadows", "chessboard", "mirror_and_glass", "wood_and_marble", "caps",
  "occlusion", "penumbra", "lampshade", "bricks", "highlight_angles" }
local KNOBS <const> = { samples = "--samples", adaptive = "--adaptive" }
local TRUTH <const>, BRUTE <const> = { 90001, 90002 }, { 7001, 7002, 7003, 7004, 7005, 7006 }

local function run(scene, options)
  local pipe <close> = io.popen(("%s scripts/%s.lua -f 1 -q --warnings none %s 2>/dev/null"):format(glint, scene, options))
  return pipe:read "a"
end

local function render(scene, size, options)
  run(scene, ("--size %s %s --passes beauty -o %s/p_%%d.pfm"):format(size, options, folder))
  local file <close> = assert(io.open(folder .. "/p_1.pfm", "rb"))
  local text = file:read "a"
  os.remove(folder .. "/p_1.pfm")
  local width, height, at = text:match "^PF\n(%d+) (%d+)\n%S+\n()"
  local out = {}
  for i = 1, width * height * 3 do out[i], at = string.unpack("<f", text, at) end
  return out
end

local function square(a, b)
  local sum = 0
  for i = 1, #a do sum = sum + (a[i] - b[i]) ^ 2 end
  return sum / #a
end

-- Returns the mean of pictures with many samples.
local function truth_of(scene, size)
  local sum
  for _, seed in ipairs(TRUTH) do
    local part = render(scene, size, "--samples 2048 --seed " .. seed)
    for i = 1, #part do part[i] = part[i] / #TRUTH + (sum and sum[i] or 0) end
    sum = part
  end
  return sum
end

-- Returns the true error of a setting over several seeds.
local function brute(scene, size, option, truth)
  local sum = 0
  for _, seed in ipairs(BRUTE) do
    sum = sum + square(render(scene, size, ("%s --seed %d"):format(option, seed)), truth) / #BRUTE
  end
  return sum ^ 0.5
end

-- Compares the error that --until-light states with the true one.
local function check_until(scene, size, seed, limit, truth, found)
  local event = run(scene, ("--size %s --until-light %g --samples 256 --seed %d --json -o none"):format(size, limit, seed))
  local samples, stated = event:match '"samples":(%d+),"error":([%d.e-]+)'
  assert(stated, "glint --until-light has failed")
  if tonumber(stated) == 0 then return end
  local error = square(render(scene, size, ("--samples %s --seed %d"):format(samples, seed)), truth) ^ 0.5
  found.quotients[#found.quotients + 1] = tonumber(stated) / error
  found.held = found.held + (error <= 1.25 * tonumber(stated) and 1 or 0)
end

-- Compares the advice with the true errors of the two settings.
local function check_advice(scene, size, seed, truth, found)
  local pipe <close> = io.popen(("%s cost scripts/%s.lua --size %s --quick --quiet --json --knobs samples,adaptive --seed %d "
    .. "2>/dev/null"):format(glint, scene, size, seed))
  local out = pipe:read "a":match '"text":"([^"]*)","decided"' or error "glint cost has failed"
  local knob, own, value = out:match "^(%S+) (%S+) %-> (%S+):"
  found.advice[out:match "^[^:]*"] = true
  if not knob then found.undecided = found.undecided + 1 return end
  local a = brute(scene, size, KNOBS[knob] .. " " .. own, truth)
  local b = brute(scene, size, KNOBS[knob] .. " " .. value, truth)
  local words = { ["the same"] = 1, ["half the"] = 1 / 2, ["a third of the"] = 1 / 3, ["two thirds of the"] = 2 / 3,
    ["a quarter of the"] = 1 / 4, ["three quarters of the"] = 3 / 4, ["a fifth of the"] = 1 / 5, ["a tenth of the"] = 1 / 10 }
  local said = out:match ", ([^,]*) error$"
  local share = words[said] or tonumber(said:match "^[%d.]+")
  found.decided = found.decided + 1
  found.right = found.right + (math.abs(math.log(b / a / share)) < math.log(1.4) and (b < a) == (share < 1) and 1
    or said == "the same" and math.abs(math.log(b / a)) < math.log(1.1) and 1 or 0)
end

local function calibrate(scenes, seeds, size)
  os.execute("mkdir -p " .. folder)
  local all = { quotients = {}, held = 0, decided = 0, right = 0, undecided = 0 }
  for s = 1, scenes do
    local scene, found = SCENES[s], { quotients = {}, advice = {}, held = 0, decided = 0, right = 0, undecided = 0 }
    local truth = truth_of(scene, size)
    local limit = brute(scene, size, "--samples 8", truth)
    for seed = 1, seeds do
      check_until(scene, size, seed, limit, truth, found)
      check_advice(scene, size, seed, truth, found)
    end
    for _, q in ipairs(found.quotients) do all.quotients[#all.quotients + 1] = q end
    table.sort(found.quotients)
    for _, key in ipairs { "held", "decided", "right", "undecided" } do all[key] = all[key] + found[key] end
    print(("| %s | %d of %d | %.2f | %d of %d | %d |"):format(scene, found.held, #found.quotients,
      found.quotients[(#found.quotients + 1) // 2] or 0, found.right, found.decided, found.undecided))
  end
  table.sort(all.quotients)
  all.median = all.quotients[(#all.quotients + 1) // 2]
  print(("| all | %d of %d | %.2f | %d of %d | %d |"):format(all.held, #all.quotients, all.median, all.right, all.decided,
    all.undecided))
  return all
end

if arg and arg[0] and arg[0]:find "calibrate.lua$" and not arg[0]:find "test_" then
  print "| scene | --until-light held | median of stated / true | advice right | not decided |\n| --- | --- | --- | --- | --- |"
  calibrate(tonumber(arg[1]), tonumber(arg[2]), arg[3])
end
return calibrate
