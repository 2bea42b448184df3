-- Adaptive sampling: every pixel equals the picture with all samples or the picture with one, as the rule chooses,
-- also across tile borders; and identical pictures in every configuration.
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
local glint = require "glint"

local WIDTH, HEIGHT = 75, 53 -- 3 x 3 tiles of 32 x 24, the last ones narrow
local PASSES = "beauty,background,ambient,diffuse,specular,mirror,indirect,depth,normal,object_id,alpha,refined"

local function scene_of(kind)
  local shiny = glint.material { diffuse = { 0.7, 0.3, 0.2 }, specular = 0.6, shininess = 60 }
  local scene = glint.scene {
    camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 0.8, 0 }, fov = 40 }, ambient = 0.1, background = { 0.2, 0.3, 0.5 },
    glint.point_light { position = { 4, 6, 5 } },
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } },
    glint.sphere { center = { -1, 1, 0 }, radius = 1, material = shiny },
    glint.box { min = { 0.6, 0, -1 }, max = { 1.8, 1.2, 0.4 }, transform = glint.rotate("y", 20) },
  }
  if kind == "mirror" then
    scene:add(glint.sphere { center = { 0.8, 0.6, 2 }, radius = 0.6,
      material = glint.material { diffuse = 0.1, mirror = 0.6, transmission = 0.2 } })
  elseif kind == "soft" then
    scene.indirect = { samples = 2, bounces = 1 }
    scene:add(glint.disk_light { position = { -3, 5, 3 }, normal = { 0, -1, 0 }, radius = 0.7, samples = 4, visible = true })
    scene:add(glint.sphere_mesh { center = { 0.2, 0.5, 2 }, radius = 0.5, segments = 9, shading = "gouraud" })
  elseif kind == "faded" then
    scene.depth_cue = { near = 5, far = 12, color = 1 }
  end
  return scene
end

local function render(scene, more)
  local options = { width = WIDTH, height = HEIGHT, samples = 5, output = "none", passes = PASSES }
  for name, value in pairs(more) do options[name] = value end
  return scene:render(options)
end

local function srgb(x)
  x = math.max(0, math.min(1, x))
  return x <= 0.0031308 and 12.92 * x or 1.055 * x ^ (1 / 2.4) - 0.055
end

-- Returns whether the rule chooses this pair of pixels; nil when the decision is too close.
local function chosen(image, x, y, x2, y2, threshold, alpha)
  local id, id2 = image:pixel(x, y, "object_id"), image:pixel(x2, y2, "object_id")
  if id ~= id2 then return true end
  local a, b, sum = { image:pixel(x, y) }, { image:pixel(x2, y2) }, 0
  for c = 1, 3 do sum = sum + math.abs(srgb(a[c]) - srgb(b[c])) end
  if alpha then sum = sum + math.abs(image:pixel(x, y, "alpha") - image:pixel(x2, y2, "alpha")) end
  local n, m = { image:pixel(x, y, "normal") }, { image:pixel(x2, y2, "normal") }
  local cosine = n[1] * m[1] + n[2] * m[2] + n[3] * m[3]
  if id > 0 and cosine < 0.9 - 1e-6 or sum > threshold + 1e-4 then return true end
  if id > 0 and cosine < 0.9 + 1e-6 or sum > threshold - 1e-4 then return nil end
  return false
end

local LIGHT = { "beauty", "background", "ambient", "diffuse", "specular", "mirror", "indirect", "alpha" }
local GEOMETRY = { "depth", "normal", "object_id" }
local function same(a, b, x, y, passes)
  for _, pass in ipairs(passes) do
    local p, q = { a:pixel(x, y, pass) }, { b:pixel(x, y, pass) }
    for c = 1, #p do if p[c] ~= q[c] then return false end end
  end
  return true
end

local function compare(name, scene, threshold, more)
  local options = { adaptive = threshold }
  for key, value in pairs(more or {}) do options[key] = value end
  local picture = render(scene, options)
  options.adaptive = 0
  local all = render(scene, options)
  options.samples = 1
  local one = render(scene, options)
  local wrong, refined, geometry, bad = 0, 0, 0, 0
  for y = 0, HEIGHT - 1 do
    for x = 0, WIDTH - 1 do
      local is_refined = picture:pixel(x, y, "refined") == 1
      refined = refined + (is_refined and 1 or 0)
      wrong = wrong + (same(picture, is_refined and all or one, x, y, LIGHT) and 0 or 1)
      geometry = geometry + (same(picture, one, x, y, GEOMETRY) and 0 or 1)
      local want = false
      for y2 = math.max(y - 1, 0), math.min(y + 1, HEIGHT - 1) do
        for x2 = math.max(x - 1, 0), math.min(x + 1, WIDTH - 1) do
          local pair = (x ~= x2 or y ~= y2) and chosen(one, x, y, x2, y2, threshold, options.alpha)
          if pair then want = true elseif pair == nil and not want then want = nil end
          if want then break end
        end
        if want then break end
      end
      if want ~= nil and want ~= is_refined then bad = bad + 1 end
    end
  end
  check(wrong == 0, "%s: %d pixels are neither", name, wrong)
  check(geometry == 0, "%s: %d pixels with another geometry than the first sample's", name, geometry)
  check(bad == 0, "%s: %d pixels chosen against the rule", name, bad)
  return refined, picture, all
end

for _, kind in ipairs { "plain", "mirror", "soft", "faded" } do
  local scene, before = scene_of(kind), 0
  for _, threshold in ipairs { 3, 0.3, 0.05, 0.01 } do
    local refined = compare(("%s, %g"):format(kind, threshold), scene, threshold)
    check(refined >= before and refined > 100, "%s: %d pixels at %g, %d before", kind, refined, threshold, before)
    before = refined
  end
end
compare("alpha", scene_of "plain", 0.1, { alpha = true })
compare("filmic, two stops up", scene_of "plain", 3, { samples = 3, precision = "float" })
local more = render(scene_of "plain", { adaptive = 0.3, exposure = -6 })
local fewer = render(scene_of "plain", { adaptive = 0.3, exposure = 0 })
local brighter, darker = 0, 0
for y = 0, HEIGHT - 1 do
  for x = 0, WIDTH - 1 do
    darker, brighter = darker + more:pixel(x, y, "refined"), brighter + fewer:pixel(x, y, "refined")
  end
end
check(darker < brighter, "what is shown dark differs less: %d and %d pixels", darker, brighter)

-- With a tiny threshold, pixels with differing neighbours take all samples. The other pixels look the same anyway.
do
  local _, picture, all = compare("next to nothing", scene_of "plain", 1e-9)
  local differ = 0
  for y = 0, HEIGHT - 1 do
    for x = 0, WIDTH - 1 do
      if picture:pixel(x, y, "refined") == 0 then
        for c, value in ipairs { picture:pixel(x, y) } do
          if math.abs(srgb(value) - srgb(({ all:pixel(x, y) })[c])) > 2 / 65535 then differ = differ + 1 end
        end
      end
    end
  end
  check(differ == 0, "next to nothing: %d channels differ by more than a step of 16 bits", differ)
end

-- ---- Edges between tiles --------------------------------------------------------------------------------------------

-- Two objects that meet at a tile border: at x = 32 or 64, and at y = 24 or 48.
for _, edge in ipairs { { 32, 0 }, { 64, 0 }, { 0, 24 }, { 0, 48 }, { 32, 24 } } do
  local left, top = edge[1], edge[2]
  local function unit(x, y) return (x - WIDTH / 2), (HEIGHT / 2 - y) end
  local x, y = unit(left > 0 and left or WIDTH + 5, top > 0 and top or HEIGHT + 5)
  local scene = glint.scene {
    camera = glint.camera { eye = { 0, 0, 10 }, direction = { 0, 0, -1 }, projection = "orthographic", height = HEIGHT },
    ambient = 0.5, glint.plane { point = { 0, 0, -1 }, normal = { 0, 0, 1 } },
    glint.box { min = { -500, y, 0 }, max = { x, 500, 1 }, material = glint.material { diffuse = 0.8 } },
  }
  local picture, wrong = render(scene, { adaptive = 0.5, passes = "refined" }), 0
  for py = 0, HEIGHT - 1 do
    for px = 0, WIDTH - 1 do
      local lane = left > 0 and (px == left - 1 or px == left) and (top == 0 or py <= top)
        or top > 0 and (py == top - 1 or py == top) and (left == 0 or px <= left)
      if picture:pixel(px, py, "refined") ~= (lane and 1 or 0) then wrong = wrong + 1 end
    end
  end
  check(wrong == 0, "an edge at %d, %d: %d pixels", left, top, wrong)
end

-- ---- Off, wrong input -----------------------------------------------------------------------------------------------

local plain = scene_of "plain"
local off, one = render(plain, {}), render(plain, { samples = 1, adaptive = 0.1 })
check(off:pixel(5, 5, "refined") == 1 and one:pixel(5, 5, "refined") == 1, "off: every pixel has all there are")
for _, wrong in ipairs { -1, 3.01, 0 / 0, math.huge } do
  local ok, message = pcall(render, plain, { adaptive = wrong })
  check(not ok and tostring(message):find("adaptive: number 0 .. 3 expected", 1, true), "%s: %s", wrong, message)
end
check(not pcall(render, plain, { adaptive = "0.1" }), "a string is no number")

-- ---- Identical pictures in every configuration ----------------------------------------------------------------------

local command = os.getenv "GLINT" or (os.getenv "BUILD" or "build") .. "/glint"
local function read(path)
  local file = io.open(path, "rb")
  local bytes = file and file:read "a"
  if file then file:close() end
  os.remove(path)
  return bytes
end
local function picture(environment, options, ending)
  local path = os.tmpname()
  local line = ("%s %s scripts/moving_light.lua -f 1-31:10 --samples 6 --adaptive 0.04 --size %dx%d --quiet --force %s -o %s_%%04d.%s 2>%s")
    :format(environment, command, tally.side(90), tally.side(60), options, path, ending, path)
  os.execute(line)
  local said = read(path)
  local all = {}
  for frame = 1, 31, 10 do all[#all + 1] = read(("%s_%04d.%s"):format(path, frame, ending)) end
  return all, said
end
for ending, options in pairs {
  pfm = "", png = "--bits 16 --alpha", ["0.png"] = "--outline black", ["all.pfm"] = "--adaptive 0",
} do
  local usual = picture("", options, ending)
  check(#usual == 4, "%d pictures", #usual)
  for _, way in ipairs(tally.with_sets({
    { "", "--threads 1" }, { "", "--threads 7 --no-reuse" }, { "", "--reuse-memory 1M" },
  }, "")) do
    local other, said = picture(way[1], options .. " " .. way[2], ending)
    if #other == 0 and said:find("this machine lacks", 1, true) then
      print("# skip " .. way[1])
    else
      local same_all = #other == 4
      for i = 1, 4 do same_all = same_all and other[i] == usual[i] end
      check(same_all, "the same pictures: %s %s %s %s", ending, way[1], way[2], #other == 4 and "" or said)
    end
  end
end

-- ---- Holes in gathered pixels ---------------------------------------------------------------------------------------

-- The chosen pixels are gathered only if the picture has no pass of light. Their rays see the same holes either way.
local function lantern(options)
  local path = os.tmpname()
  os.execute(("%s scripts/lantern.lua -f 1 --samples 3 --adaptive 1 --size 96x64 --quiet --force %s -o %s_%%04d.png 2>%s")
    :format(command, options, path, path))
  os.remove(path .. "_0001.diffuse.png")
  return read(path .. "_0001.png"), read(path)
end
for _, precision in ipairs { "double", "float" } do
  local want, said = lantern("--threads 1 --passes diffuse --precision " .. precision)
  check(want, "a lantern: %s", said)
  for _, threads in ipairs { 1, 2, 7 } do
    local gathered = lantern(("--threads %d --precision %s"):format(threads, precision))
    check(gathered == want, "holes in gathered pixels: %s precision, %d threads", precision, threads)
  end
end

tally.finish()
