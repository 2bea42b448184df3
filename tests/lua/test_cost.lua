-- glint cost from the command line: its rows, their relations, and bad input.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local build = os.getenv "BUILD" or "build"
local glint = os.getenv "GLINT" or build .. "/glint"
local work = build .. "/tests/cost"
os.execute(("rm -rf %s && mkdir -p %s/once"):format(work, work))

local function write(name, text)
  local file <close> = assert(io.open(work .. "/" .. name, "w"))
  file:write(text)
  return work .. "/" .. name
end

local function read(name)
  local file <close> = assert(io.open(work .. "/" .. name, "rb"))
  return file:read "a"
end

-- ---- JSON, as far as glint prints it ----

local parse
local function skip(text, at) return text:match("^%s*()", at) end

local function parse_list(text, at, close)
  local out, key = {}, nil
  at = skip(text, at + 1)
  if text:sub(at, at) == close then return out, at + 1 end
  repeat
    if close == "}" then
      key, at = parse(text, at)
      at = skip(text, at)
      assert(text:sub(at, at) == ":", "a colon is missing")
      at = at + 1
    end
    local value
    value, at = parse(text, at)
    out[close == "}" and key or #out + 1] = value
    at = skip(text, at)
    local mark = text:sub(at, at)
    at = skip(text, at + 1)
    assert(mark == "," or mark == close, "a comma is missing")
  until mark == close
  return out, at
end

local null = setmetatable({}, { __name = "null" })
local words = { ["true"] = true, ["false"] = false, null = null }
function parse(text, at)
  at = skip(text, at)
  local c = text:sub(at, at)
  if c == "{" then return parse_list(text, at, "}") end
  if c == "[" then return parse_list(text, at, "]") end
  if c == '"' then
    local stop = at + 1
    while text:sub(stop, stop) ~= '"' do
      stop = stop + (text:sub(stop, stop) == "\\" and 2 or 1)
    end
    return text:sub(at + 1, stop - 1):gsub('\\"', '"'), stop + 1
  end
  local word = text:match("^%a+", at)
  if word then
    assert(words[word] ~= nil, word)
    return words[word], at + #word
  end
  local number = text:match("^-?[%d.]+[eE]?[+-]?%d*", at)
  return assert(tonumber(number), "a value is missing"), at + #number
end

-- ---- Running ----

-- Runs `glint cost ARGUMENTS`. Returns the exit code; the output is in the files out and err.
local function run(arguments, before, after)
  local _, _, code = os.execute(("%s %s cost %s >%s/out 2>%s/err </dev/null %s"):format(before or "", glint, arguments,
    work, work, after or ""))
  return code
end

local function says(pattern) return read("err"):find(pattern) ~= nil end

-- Returns rows and advice of the last run. Fails the test when a line is anything else.
local function rows_of(name)
  local rows, advice = {}, nil
  for line in read("out"):gmatch "[^\n]+" do
    local good, object = pcall(parse, line, 1)
    check(good and not advice, "%s: a row, or the advice at the end: %s", name, line)
    if good and object.event == "advice" then
      advice = object
    elseif good and object.event ~= "error" then
      rows[#rows + 1] = object
    end
  end
  check(advice and type(advice.text) == "string" and #advice.text > 5, "%s: advice", name)
  return rows, advice or {}
end

local function study(name, arguments)
  local code = run(arguments .. " --json --quick")
  check(code == 0, "%s: exit %s: %s", name, code, read "err")
  return rows_of(name)
end

local function find(rows, knob, value)
  for _, row in ipairs(rows) do
    if row.knob == knob and row.value == value then return row end
  end
  return error(("no row %s %s"):format(knob, value))
end

local function knobs_of(rows)
  local seen, list = {}, {}
  for _, row in ipairs(rows) do
    if not seen[row.knob] then list[#list + 1] = row.knob end
    seen[row.knob] = true
  end
  return table.concat(list, " ")
end

-- ---- Properties of the rows of every study ----

local fields = { knob = "string", ms = "table", cpu = "table", x_own = "number", rmse = "number", relmse = "number", max_code = "number",
  over1 = "number", over8 = "number", flip = "number", counters = "table",
  pictures = "number", pareto = "boolean", default = "boolean", resolved = "boolean", difference = "string", runs = "number",
  partial = "boolean" }

local function is_dominated(rows, row)
  for _, other in ipairs(rows) do
    local e, t = other.rmse, other.cpu.median
    if other.knob ~= "reuse" and e <= row.rmse and t <= row.cpu.median and (e < row.rmse or t < row.cpu.median) then
      return true
    end
  end
  return false
end

local function check_rows(name, rows, reference)
  local defaults, least = {}, math.huge
  for _, row in ipairs(rows) do
    local where = ("%s: %s %s"):format(name, row.knob, row.value)
    for field, kind in pairs(fields) do
      check(type(row[field]) == kind, "%s: %s is a %s", where, field, type(row[field]))
    end
    check(type(row.value) == "number" or type(row.value) == "string", "%s: value", where)
    for _, ms in ipairs { row.ms, row.cpu } do
      check(0 <= ms.min and ms.min <= ms.q1 and ms.q1 <= ms.median and ms.median <= ms.q3, "%s: quartiles", where)
    end
    check(row.rmse >= 0 and row.relmse >= 0 and row.flip >= 0 and row.flip <= 1, "%s: errors in range", where)
    check(row.over8 <= row.over1 and row.over1 <= 1, "%s: shares of pixels", where)
    check(row.runs >= 5 and not row.partial, "%s: %d runs", where, row.runs)
    check(row.pictures >= 3 and row.pictures % 3 == 0, "%s: %d pictures", where, row.pictures)
    if row.knob ~= "bits" then
      check(row.noise >= 0 and row.bias >= 0 and row.spread >= 0, "%s: noise and bias", where)
      check(math.abs(row.noise ^ 2 + row.bias ^ 2 - row.rmse ^ 2) <= 1e-4 * row.rmse ^ 2, "%s: their squares add up", where)
      check(({ better = 1, worse = 1, equal = 1, ["not decided"] = 1, ["effect lost"] = 1 })[row.verdict], "%s: verdict %s",
        where, row.verdict)
      check((row.loss ~= null) == (row.verdict == "effect lost"), "%s: %s, %s", where, row.loss, row.verdict)
    end
    if row.default and row.knob ~= "reuse" then check(row.x_own == 1, "%s: the script's own time", where) end
    if row.default then defaults[row.knob] = (defaults[row.knob] or 0) + 1 end
    if row.knob ~= "reuse" then least = math.min(least, row.rmse) end
    check(not (row.pareto and is_dominated(rows, row)), "%s: on the front, and another is better", where)
    check(not (row.pareto and row.knob == "reuse"), "%s: another sort of time", where)
  end
  for knob, count in pairs(defaults) do check(count == 1, "%s: %s has %d defaults", name, knob, count) end
  for knob in knobs_of(rows):gmatch "%S+" do check(defaults[knob], "%s: %s has no default", name, knob) end
  local best = false
  for _, row in ipairs(rows) do best = best or (row.pareto and row.rmse <= least + 3 * reference.rmse) end
  check(best, "%s: the least error, or one that the reference cannot tell from it, is on the front", name)
end

-- ---- Scenes ----

local film = write("film.lua", [[
local glint = require "glint"
local lamp = glint.point_light { position = { 3, 6, 4 } }
local scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 8 }, at = { 0, 0.5, 0 } }, ambient = 0.1, background = 0.2, lamp,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } },
  glint.sphere { center = { 0, 1, 0 }, radius = 1, material = glint.material { specular = 0.6, shininess = 40 } },
  glint.sphere { center = { 1.6, 0.6, 1 }, radius = 0.6, material = glint.material { diffuse = { 0.6, 0.1, 0.1 } } },
}
return glint.animation { scene = scene, frames = 3, width = 64, height = 48, samples = 4,
  frame = function(t) lamp.x = 3 + t end }
]])

local function still(name, inside, options)
  return write(name, ([[
local glint = require "glint"
return glint.animation { scene = glint.scene { camera = glint.camera { eye = { 0, 2, 8 }, at = { 0, 0.5, 0 } }, background = 0.25,
  %s }, frames = 1, width = 64, height = 48, %s frame = function() end }]]):format(inside, options or ""))
end

-- ---- A scene with all knobs ----

local rows, advice = study("film", film .. " --frame 2")
check_rows("film", rows, advice.reference)
check(knobs_of(rows) == "samples adaptive shadows precision model bits encode reuse", "film responds to: %s", knobs_of(rows))
check(says "frame 2 of 3 %(choose another with %-%-frame N%)", "which frame is taken: %s", read "err")
check(#advice.left_out == 0 and advice.complete and advice.machine:find "thread", "advice: what was measured where")

local own = find(rows, "samples", 4)
local before = math.huge
for _, samples in ipairs { 1, 4, 16, 64 } do
  local row = find(rows, "samples", samples)
  check(row.rmse < before, "error falls with the samples: %d: %g, before %g", samples, row.rmse, before)
  check(row.counters.primary == 64 * 48 * samples, "%d samples: %d rays", samples, row.counters.primary)
  check(row.counters.powers > 0 and row.counters.powers < row.counters.light_samples
    and row.counters.light_samples <= row.counters.primary, "%d samples: work", samples)
  check(row.counters.tests >= row.counters.light_samples
    and row.counters.tests < 4 * (row.counters.primary + row.counters.shadow), "%d samples: %d tests", samples,
    row.counters.tests)
  check(row.loss == null and row.changed == null, "%d samples lose no effect", samples)
  check(row.default == (samples == 4), "%d samples: default", samples)
  before = row.rmse
end
check(own.resolved and own.rmse >= 10 * advice.reference.rmse, "the reference resolves the script's own error")
check(advice.reference.samples >= 64 * 4, "reference of %g samples", advice.reference.samples)

for _, same in ipairs { { "encode", "small" }, { "encode", "fast" }, { "reuse", "on" }, { "reuse", "off" },
  { "precision", "double" }, { "model", "phong" }, { "shadows", "hard" } } do
  local row = find(rows, same[1], same[2])
  check(row.verdict == "equal" and row.flip == own.flip, "%s %s: the same picture", same[1], same[2])
end
check(find(rows, "reuse", "on").counters.primary == 0, "a kept cast casts no rays")
check(find(rows, "reuse", "on").counters.tests < own.counters.tests, "nor does it test them")
check(find(rows, "reuse", "on").default and not find(rows, "reuse", "off").default, "reuse is on by default")
local off = find(rows, "shadows", "off")
check(off.changed > 20 / (64 * 48) and off.loss == "without shadows" and off.counters.shadow == 0 and off.bias > own.bias,
  "no shadows: %g changed, bias %g", off.changed, off.bias)
check(find(rows, "model", "matched_blinn_phong").rmse < find(rows, "model", "blinn_phong").rmse,
  "four times the exponent is nearer")
local eight, sixteen = find(rows, "bits", 8), find(rows, "bits", 16)
check(eight.default and sixteen.rmse <= eight.rmse and sixteen.flip < eight.flip, "16 bits keep more than 8")

-- ---- The error, from files that the renderer writes and this test reads ----

local function pfm(name, options)
  assert(os.execute(("%s %s -f 2 -q -o %s/%s_####.pfm %s"):format(glint, film, work, name, options)))
  local text = read(name .. "_0002.pfm")
  local at = text:match "^PF\n64 48\n%S+\n()"
  local out = {}
  for i = 1, 64 * 48 * 3 do out[i], at = string.unpack("<f", text, at) end
  return out
end

check(#advice.seeds == own.pictures, "%d seeds of %d pictures", #advice.seeds, own.pictures)
local pictures = {}
for i = 1, own.pictures do
  local seed = advice.seeds[i]
  pictures[i] = pfm("picture", "--seed " .. seed)
  for _, other in ipairs(advice.reference.seeds) do check(seed ~= other and seed ~= 0, "seed %d twice", seed) end
end
local mine = pictures[1]
local seeds, parts = advice.reference.seeds, {}
check(#seeds >= 4, "the reference has %d seeds", #seeds)
for i, seed in ipairs(seeds) do
  parts[i] = pfm("part" .. i, ("--samples %d --seed %d"):format(advice.reference.samples, seed))
  for k = 1, i - 1 do check(seeds[k] ~= seed and seed ~= 0, "seed %d twice", seed) end
end
local squares, relative, apart = 0, 0, 0
for i = 1, #mine do
  local r = 0
  for _, part in ipairs(parts) do r = r + part[i] / #parts end
  squares = squares + (mine[i] - r) ^ 2
  relative = relative + (mine[i] - r) ^ 2 / (r ^ 2 + 0.01)
  for _, part in ipairs(parts) do apart = apart + (part[i] - r) ^ 2 / (#parts * (#parts - 1)) end
end
local function near(got, want) return math.abs(got - want) <= 1e-5 * want end
local function mean_square(a, b)
  local sum = 0
  for i = 1, #a do sum = sum + (a[i] - b[i]) ^ 2 end
  return sum / #a
end
local truth, hand, product, pairs_count, reference_square = {}, 0, 0, 0, apart / #mine
for i = 1, #mine do
  truth[i] = 0
  for _, part in ipairs(parts) do truth[i] = truth[i] + part[i] / #parts end
end
for i, picture in ipairs(pictures) do
  hand = hand + mean_square(picture, truth) / #pictures
  for k = (i - 1) // 3 * 3 + 1, i - 1 do -- the pictures come by threes
    for at = 1, #mine do product = product + (picture[at] - truth[at]) * (pictures[k][at] - truth[at]) / #mine end
    pairs_count = pairs_count + 1
  end
end
local by_hand = (hand - reference_square) ^ 0.5
check(near(own.rmse, by_hand), "RMSE %g, by hand %g", own.rmse, by_hand)
local bias = product / pairs_count - reference_square
check(own.bias == 0 or near(own.bias, bias ^ 0.5), "bias %g, by hand %g", own.bias, bias)
check(near(own.relmse, relative / #mine), "relMSE %g, by hand %g", own.relmse, relative / #mine)
check(near(advice.reference.rmse, (apart / #mine) ^ 0.5), "the reference's own error %g, by hand %g",
  advice.reference.rmse, (apart / #mine) ^ 0.5)

-- ---- Only effects that the scene needs ----

local matt = [[glint.sphere { center = { 0, 1, 0 }, radius = 1 }, ]]
local plain, plain_advice = study("plain", still("plain.lua", matt .. "glint.point_light { position = { 0, 9, 9 }, shadows = false }"))
check_rows("plain", plain, plain_advice.reference)
check(knobs_of(plain) == "samples precision bits encode", "matt, without shadows: %s", knobs_of(plain))
local counted = find(plain, "samples", 1).counters
check(counted.tests >= counted.light_samples and counted.tests <= counted.primary, "one sphere: %d tests", counted.tests)
check(counted.powers == 0 and counted.shadow == 0 and counted.light_samples > 100, "matt: %d powers", counted.powers)
local bare, bare_advice = study("bare", still("bare.lua", ""))
check_rows("bare", bare, bare_advice.reference)
check(knobs_of(bare) == "bits encode", "nothing to be seen: %s", knobs_of(bare))
local floats = study("pfm", still("pfm.lua", matt, [[output = "x.pfm",]]))
check(knobs_of(floats) == "samples precision", "no codes in a .pfm: %s", knobs_of(floats))
local odd = study("odd", still("odd.lua", matt, [[samples = 9, precision = "float",]]) .. " --knobs samples,precision")
check(find(odd, "samples", 9).default and find(odd, "samples", 16) and find(odd, "precision", "float").default,
  "the script's own values are in their places")

-- Samples also sample the lens: few of them do not show its blur.
local lens = study("lens", write("lens.lua", (read "film.lua":gsub("at = { 0, 0.5, 0 }", "%0, aperture = 0.6, focus = 3")))
  .. " --knobs samples")
check(find(lens, "samples", 1).rmse > 3 * find(lens, "samples", 16).rmse
  and find(lens, "samples", 16).rmse > 1.5 * find(lens, "samples", 64).rmse, "a lens converges: %g, %g, %g",
  find(lens, "samples", 1).rmse, find(lens, "samples", 16).rmse, find(lens, "samples", 64).rmse)

-- A limit of the light of paths is a bias: in a ball whose walls glow with 4, each path brings 2.
local limited = study("limited", still("limited.lua", [[ambient = 8, indirect = { samples = 2, bounces = 1 },
  glint.sphere { center = { 0, 0, 0 }, radius = 50, material = glint.material { diffuse = 0.5 } } ]], "exposure = -2,") .. " --knobs clamp")
check(find(limited, "clamp", 0).default and math.abs(find(limited, "clamp", 1).bias - 1) < 1e-3
  and find(limited, "clamp", 1).loss == "with limited light of random paths", "clamp 1: bias %g", find(limited, "clamp", 1).bias)
check(find(limited, "clamp", 4).bias == 0 and find(limited, "clamp", 4).rmse < 1e-4, "clamp 4 takes no light")

-- A shutter: the frame function runs at the shutter's times, with all its movements, also under another knob.
local exposed = [[local glint = require "glint"
local lamp = glint.point_light { position = { 0, 4, 4 } }
local ball = glint.sphere { center = { 0, 1, 0 }, radius = 1, material = glint.material { specular = 0.5 } }
local camera = glint.camera { eye = { 0, 1, 6 }, at = { 0, 1, 0 }, shutter = 1, shutter_times = TIMES }
local scene = glint.scene { camera = camera, ambient = 0.1, lamp, glint.group { ball },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } } }
return glint.animation { scene = scene, frames = 3, width = 64, height = 48, output = "none", frame = function(t)
  ball.center, lamp.position, ball.material.diffuse = { 4 * t - 2, 1, 0 }, { 4 * t, 4, 4 }, { t, 0.5, 0.5 }
end }]]
local shutter, shutter_advice = study("shutter", write("shutter.lua", (exposed:gsub("TIMES", "8"))) .. " --frame 2 --knobs shutter_times,samples")
check_rows("shutter", shutter, shutter_advice.reference)
check(knobs_of(shutter) == "samples shutter_times" and find(shutter, "shutter_times", 8).default, "a shutter: %s", knobs_of(shutter))
local worse = math.huge
for _, times in ipairs { 1, 2, 4, 8, 16, 32 } do
  local row = find(shutter, "shutter_times", times)
  check(row.bias <= worse and row.counters.primary == 64 * 48 * times, "%d times: %g off, before %g; %d rays", times, row.bias,
    worse, row.counters.primary)
  check(times < 8 or row.verdict ~= "worse" and row.loss == null, "%d times: %s", times, row.verdict)
  worse = row.bias > 0 and row.bias or worse -- 0: the noise hides it
end
check(find(shutter, "samples", 16).counters.primary == 64 * 48 * 16 * 8, "16 samples at each of 8 times")
local nine = study("nine", write("nine.lua", (exposed:gsub("TIMES", "9"))) .. " --frame 2 --knobs shutter_times")
check(find(nine, "shutter_times", 9).default and find(nine, "shutter_times", 16), "the script's own among them")
local _, anew = study("anew", write("anew.lua", (exposed:gsub("TIMES", "8"):gsub("frame = function%(t%)",
  "%0 scene.camera = glint.camera { eye = { t, 1, 6 }, at = { 0, 1, 0 }, shutter = 1 }"))) .. " --knobs samples")
check(table.concat(anew.left_out):find("the open shutter: the frame function creates new objects", 1, true), "said of an instant: %s",
  table.concat(anew.left_out))

-- Area lights, by intensity and by radiance, both of which a knob must leave unchanged; and a cone.
local soft = study("soft", still("soft.lua", matt .. [[glint.polygon_light { vertices = { { -1, 5, -1 }, { 1, 5, -1 }, { 1, 5, 1 }, { -1, 5, 1 } },
  radiance = 4, samples = 4 }, glint.sphere_light { position = { 3, 6, 4 }, radius = 0.5, intensity = 0.4, samples = 4 },
  glint.spot_light { position = { -3, 6, 4 }, direction = { 3, -6, -4 }, inner = 10, outer = 40, intensity = 0.3 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } } ]]))
check(knobs_of(soft) == "samples shadows light_samples precision bits encode", "soft shadows: %s", knobs_of(soft))
local soft_own, soft_off = find(soft, "shadows", "soft"), find(soft, "shadows", "off")
check(soft_own and soft_own.default, "shadows of lights with a surface are called soft")
check(soft_off.changed > 20 / (64 * 48) and soft_off.rmse > soft_own.rmse, "without them: %g changed", soft_off.changed)
check(soft_own.counters.light_samples > 8 * 100 and soft_own.counters.light_samples % 9 == 0,
  "each sample of a light is looked at: %d", soft_own.counters.light_samples)
check(find(soft, "encode", "small").flip == soft_own.flip, "another encoder after other lights: the same picture")
check(find(soft, "samples", 64).rmse < soft_own.rmse / 4, "soft shadows converge")
local hard = find(soft, "shadows", "hard")
check(hard.rmse > soft_own.rmse and hard.rmse < soft_off.rmse,
  "hard ones are between: %g of %g and %g", hard.rmse, soft_own.rmse, soft_off.rmse)
local ones, many = find(soft, "light_samples", 1), find(soft, "light_samples", 256)
check(ones.counters.light_samples * 171 == many.counters.light_samples and ones.rmse > 1.3 * many.rmse,
  "samples of a light: %g with 1, %g with 256", ones.rmse, many.rmse)
check(find(soft, "light_samples", 4).default, "its own among them")
local caps = study("caps", still("caps.lua", matt .. [[glint.sphere_light { position = { 2, 5, 3 }, radius = 0.8, samples = 4,
  radiance = 12, shadow = "caps" }, glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } } ]], "samples = 4,") .. " --knobs shadows,light_samples")
local closed, sampled = find(caps, "shadows", "caps"), find(caps, "shadows", "soft")
check(knobs_of(caps) == "shadows" and closed.default and sampled and find(caps, "shadows", "hard"), "caps: %s", knobs_of(caps))
check(closed.counters.shadow == 0 and closed.counters.overlaps > 0 and sampled.counters.overlaps == 0, "caps cast no rays")
check(closed.rmse < find(caps, "shadows", "hard").rmse, "and are nearer to samples than a ray to the middle")

local mixed = study("mixed", still("mixed.lua", [[glint.directional_light { direction = { 0, -1, -1 } },
  glint.sphere { center = { 0, 1, 0 }, radius = 1, material = glint.material { specular = 1 } },
  glint.sphere { center = { 2, 1, 0 }, radius = 1, material = glint.material { specular = 1, model = "blinn_phong" } }]])
  .. " --knobs model")
check(find(mixed, "model", "mixed").default and find(mixed, "model", "blinn_phong").rmse > 0, "highlights of both sorts")

-- ---- Meshes: against the sphere that they approximate, under several lights ----

local globe = study("globe", still("globe.lua", [[glint.directional_light { direction = { -1, -1, -2 }, shadows = false },
  glint.group { glint.sphere_mesh { center = { 0, 1, 0 }, radius = 1, segments = 24, name = "globe",
    material = glint.material { specular = 0.6 } }, transform = glint.translate(0.3, 0, 0),
    glint.sphere_mesh { center = { 0, 1, 0 }, radius = 0.1, segments = 24 }, -- the three are too many for 1024 segments
    glint.sphere_mesh { center = { 0, 1, 0 }, radius = 0.2, segments = 24 } } ]], "samples = 16,") .. " --knobs segments,shading")
check(knobs_of(globe) == "segments shading", "a sphere of triangles: %s", knobs_of(globe))
local ball, exact = find(globe, "segments", 24), find(globe, "segments", "exact")
check(ball.default and find(globe, "shading", "phong").default and ball.rmse == find(globe, "shading", "phong").rmse, "its own")
check(find(globe, "segments", 16).rmse > ball.rmse and ball.rmse > exact.rmse and find(globe, "segments", 16).loss == "with coarser spheres"
  and exact.loss == null, "the exact sphere is the truth: %g, %g", ball.rmse, exact.rmse)
check(math.abs(find(globe, "segments", 256).rmse - exact.rmse) < exact.rmse / 10, "256 segments are as good as the sphere")
check(not pcall(find, globe, "segments", 1024), "and 1024 have too many triangles")
local flat, gouraud = find(globe, "shading", "flat"), find(globe, "shading", "gouraud")
check(flat.rmse > gouraud.rmse and gouraud.rmse > ball.rmse, "flat %g, gouraud %g, phong %g", flat.rmse, gouraud.rmse, ball.rmse)
check(flat.counters.sites > 50 and gouraud.counters.sites > 50 and ball.counters.sites == 0, "faces and vertices lit")
local sheets = study("sheets", still("sheets.lua", [[glint.directional_light { direction = { 0, -1, -1 } },
  glint.mesh { vertices = { -2, 0, 0, 2, 0, 0, 0, 3, 0 }, faces = { { 1, 2, 3 } } }, glint.mesh { vertices = { -2, 0, 1, 2, 0, 1, 0, 1, 1 },
  faces = { { 1, 2, 3 } }, shading = "flat" } ]]) .. " --knobs shading,samples")
check(find(sheets, "shading", "mixed").default and find(sheets, "shading", "phong"), "meshes of both sorts")

-- ---- Precision: errors of float above a ground of radius 1e7 ----

local ground = study("ground", still("ground.lua", matt .. [[glint.point_light { position = { 3, 6, 4 } },
  glint.sphere { center = { 0, -1e7, 0 }, radius = 1e7 }]]) .. " --knobs precision --size 160x120")
local float, double = find(ground, "precision", "float"), find(ground, "precision", "double")
check(float.changed > 0 and float.rmse > double.rmse, "float on a huge ground: no pixel wrong")
check(double.default and double.changed == null, "double is the script's own")

-- ---- Inside groups ----

local grouped = study("grouped", still("grouped.lua", [[glint.point_light { position = { 0, 6, 3 } },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } }, glint.group { glint.group { glint.sphere {
  center = { 0, 1, 0 }, radius = 1, material = glint.material { specular = 1, shininess = 9 } } } }]])
  .. " --size 24x18 --knobs model")
check(find(grouped, "model", "phong").default and find(grouped, "model", "blinn_phong").rmse > 0,
  "materials of a group are among what changes")

-- ---- Mirrors and glass ----

local hall = [[glint.directional_light { direction = { -1, -1, -2 } }, glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } },
  glint.sphere { center = { -1, 1, 0 }, radius = 1, material = glint.material { diffuse = 0.1, mirror = 0.85 } },
  glint.sphere { center = { 1, 1, 0 }, radius = 1, material = glint.material { diffuse = 0.1, %s } } ]]
local mirrors = study("mirrors", still("mirrors.lua", hall:format "mirror = 0.85", "max_depth = 3,") .. " --size 32x24 --knobs max_depth")
check(find(mirrors, "max_depth", 3).default and #mirrors == 6, "the script's own depth among the others: %d", #mirrors)
local nearer = math.huge
for _, depth in ipairs { 0, 1, 2, 3 } do
  local row = find(mirrors, "max_depth", depth)
  check(row.rmse < nearer, "error falls with the depth: %d: %g, before %g", depth, row.rmse, nearer)
  nearer = row.rmse
end
check(find(mirrors, "max_depth", 10).verdict ~= "worse", "the deepest is never worse")
local first, second = find(mirrors, "max_depth", 1).counters, find(mirrors, "max_depth", 2).counters
check(find(mirrors, "max_depth", 0).counters.mirror == 0 and first.mirror > 50 and second.mirror > first.mirror,
  "mirrored rays: %d at depth 1, %d at 2", first.mirror, second.mirror)
local shut = study("shut", still("shut.lua", hall:format "transmission = 0.8", "max_depth = 0,") .. " --size 32x24 --knobs max_depth")
check(find(shut, "max_depth", 0).default and find(shut, "max_depth", 10).counters.refraction > 50,
  "a script that follows no ray is told what that costs it")
local _, dull = study("dull", still("dull.lua", matt .. "glint.point_light { position = { 0, 9, 9 } }") .. " --size 32x24 --knobs max_depth,bits")
check(#dull.left_out == 1 and dull.left_out[1]:find "max_depth: .* a mirror or glass", "matt: %s", dull.left_out[1])

-- ---- Indirect light ----

local sent = study("sent", still("sent.lua", [[indirect = { samples = 2, bounces = 1 },
  glint.point_light { position = { 0, 6, 3 } }, glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } },
  glint.sphere { center = { 0, 1, 0 }, radius = 1 }]]) .. " --size 24x18 --knobs indirect_samples,indirect_bounces")
check(knobs_of(sent) == "indirect_samples indirect_bounces", "indirect light has knobs: %s", knobs_of(sent))
check(find(sent, "indirect_samples", 2).default and find(sent, "indirect_bounces", 1).default, "its own among the values")
check(find(sent, "indirect_samples", 64).rmse < find(sent, "indirect_samples", 1).rmse, "error falls with the ways")
check(find(sent, "indirect_bounces", 0).counters.indirect == 0, "0 bounces: no ways")
local single = find(sent, "indirect_bounces", 1)
for _, bounces in ipairs { 2, 4, 8 } do
  local row = find(sent, "indirect_bounces", bounces)
  check(row.bias <= single.bias and row.verdict ~= "worse" and row.loss == null, "%d bounces: bias %g after %g, %s", bounces,
    row.bias, single.bias, row.verdict)
end
check(find(sent, "indirect_bounces", 0).loss == "without indirect light", "a lost effect has its name")
check(find(sent, "indirect_samples", 16).counters.indirect == 8 * find(sent, "indirect_samples", 2).counters.indirect,
  "16 ways are 8 times 2")

local open = study("open", still("open.lua", [[ambient = 0.5, glint.ambient_occlusion { samples = 2 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } }, glint.sphere { center = { 0, 1, 0 }, radius = 1 }]]) ..
  " --size 24x18 --knobs indirect_samples,ambient_occlusion_samples")
check(knobs_of(open) == "ambient_occlusion_samples", "ambient occlusion has its own: %s", knobs_of(open))
check(find(open, "ambient_occlusion_samples", 2).default, "its own among the values")
check(find(open, "ambient_occlusion_samples", 64).rmse < find(open, "ambient_occlusion_samples", 1).rmse,
  "error falls with the rays")

local gold = study("gold", still("gold.lua", [[reflection_samples = 2, background = 0.5,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } }, glint.sphere { center = { 0, 1, 0 }, radius = 1,
  material = glint.material { model = "cook_torrance", f0 = 0.8, roughness = 0.6 } }]]) .. " --size 24x18 --knobs reflection_samples")
check(find(gold, "reflection_samples", 2).default, "a rough surface has a knob")
check(find(gold, "reflection_samples", 64).rmse < find(gold, "reflection_samples", 1).rmse, "error falls with its rays")

-- ---- Output for people; the report ----

check(run(film .. " --quick --knobs samples,encode --report " .. work .. "/a/b") == 0, "report: %s", read "err")
local table_text = read "out"
check(table_text:find "\nsamples\n" and table_text:find " %*4 " and table_text:find "reference:", "the table:\n%s", table_text)
check(not table_text:find "nan" and not table_text:find "inf", "numbers in the table")
local page, plot = read "a/b/index.html", read "a/b/plot.svg"
check(page:find "^<!DOCTYPE html>" and page:find "</html>%s*$" and not page:find "@%u+@", "the page is whole")
check(not page:gsub("http://www.w3.org/2000/svg", ""):find "https?:", "the page needs no network")
check(page:find("<svg", 1, true) and page:find("data:image/png;base64,iVBOR", 1, true), "plot and pictures are in the page")
check(plot:find "^<svg" and plot:find "</svg>%s*$" and plot:find "samples 16", "the plot is a file of its own")
check(table_text:match "([^\n]+)\n*$" == page:match 'class="advice">([^<]+)<':gsub("&gt;", ">"), "the same advice")
local left_behind = io.popen("ls -A " .. work .. "/a/b"):read "a"
check(left_behind == "index.html\nplot.svg\n", "the report's folder has: %s", left_behind)

-- ---- Bad input ----

local function refuses(name, arguments, pattern)
  local code = run(arguments)
  check(code == 2 and says(pattern), "%s: exit %s: %s", name, code, read "err")
  check(read "out" == "", "%s: stdout", name)
end
refuses("nothing", write("nothing.lua", "local x = 1"), "rendered nothing")
refuses("an empty list", write("empty.lua", "return {}"), "renders nothing")
refuses("a frame beyond the end", film .. " --frame 4", "expected a frame of the script, 1 .. 3, got '4'")
refuses("no such knob", film .. " --knobs sample", "did you mean 'samples'")
refuses("no knob", film .. " --knobs ''", "samples, adaptive, shutter_times, shadows, light_samples, precision")
refuses("no knob that the scene has", still("bare.lua", "") .. " --knobs shadows,model",
  "expected a knob that changes this scene %(bits, encode%), got 'shadows,model'")
refuses("a file for a folder", film .. " --report " .. film .. "/x", "a folder to write to expected")
refuses("a folder that cannot be", film .. " --report /proc/glint", "/proc/glint")
refuses("a budget of nothing", film .. " --budget 0", "%-%-budget: seconds")
refuses("a budget in words", film .. " --budget soon", "got 'soon'")
check(run(film .. " --quick --json --knobs model,reuse --frame 1 --quiet") == 0 and read "err" == "", "--quiet: %s", read "err")
refuses("an option of another command", film .. " --force", "this command does not have this option")

-- ---- Truncated runs ----

check(run(film .. " --size 640x480 --json --budget 0.5") == 0, "--budget: %s", read "err")
local short, short_advice = rows_of "budget"
check(#short_advice.left_out > 0 and #short > 0 and short_advice.seconds < 10, "a budget leaves out: %d, in %g s",
  #short_advice.left_out, short_advice.seconds)

write("once/plot.svg", "of an earlier study")
check(run(film .. " --size 640x480 --json --budget 0.001 --report " .. work .. "/once") == 0, "one frame: %s", read "err")
local once, once_advice = rows_of "one frame"
check(#once > 0 and once_advice.left_out[1]:find "leaves no time for more", "a frame over the budget: %s", once_advice.left_out[1])
for _, row in ipairs(once) do
  check(row.default == (row.knob ~= "reuse") and row.partial and row.runs == 1 and row.counters.primary == 640 * 480 * 4, "%s: the first frame alone", row.knob)
end
check(run(("%s --size 640x480 --json --budget %g"):format(film, 0.004 * once[1].ms.median)) == 0, "four frames: %s", read "err")
local some, some_advice = rows_of "four frames"
check(#some > 0 and some_advice.reference == null and some_advice.left_out[1]:find "^every error", "four frames allow no reference: %s",
  some_advice.left_out[1])
local alone = io.popen("ls -A " .. work .. "/once"):read "a"
check(alone == "index.html\n", "without an error there is a page and no plot: %s", alone)

-- Interrupted when some settings have been measured, also in a slow build.
run(film .. " --size 800x600 --json", ("sh -c 'exec \"$@\" & p=$!; sleep %.1f; kill -INT $p; wait $p; echo $? >%s/code' sh")
  :format(math.max(1.5, 0.015 * once[1].ms.median), work))
check(read "code" == "130\n", "SIGINT: exit %s", read "code")
local cut = {}
for line in read("out"):gmatch "[^\n]+" do
  local object = parse(line, 1)
  if object.knob then cut[#cut + 1] = object end
end
check(#cut > 0 and says "interrupted", "SIGINT: %d rows", #cut)
for _, row in ipairs(cut) do check(row.partial and row.ms.median > 0, "SIGINT: %s is partial", row.knob) end

tally.finish()
