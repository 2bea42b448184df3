-- The gr dialect's surface variants: textures and bump maps, mirrors and glass. Equivalent forms must give the same
-- pixel values, which are known in closed form. Meaningless arguments give one warning.
local build = os.getenv "BUILD" or "build"
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
package.path = "scripts/lib/?.lua;" .. package.path
local png = require "glint.png"
local tests = {}

local function output_of(command)
  local pipe <close> = assert(io.popen(command))
  return pipe:read "a"
end

local here = output_of "pwd":gsub("\n", "")
local folder = here .. "/" .. build .. "/tests/gr/surfaces"
assert(os.execute(("rm -rf '%s' && mkdir -p '%s'"):format(folder, folder)))

local function write(name, text)
  local file <close> = assert(io.open(folder .. "/" .. name, "wb"))
  file:write(text)
end

-- Runs a scene with this text. Returns its output and its exit code.
local function run(text, options)
  write("scene.lua", text)
  local said = output_of(("cd '%s' && { '%s/%s/glint' --dialect gr scene.lua --quiet -t 1 %s; } 2>&1 </dev/null; echo \" exit $?\"")
    :format(folder, here, build, options or ""))
  return said, tonumber(said:match "exit (%d+)\n$")
end

-- Renders the shape `s` of the text, which is 1 wide, seen along -z in ambient light only.
local SIZE <const> = 16
local function look(text, options)
  local said, code = run(text .. [[

    if not has_no_material then s:set_material(m) end
    gr.render(s, 'out', 16, 16, {0, 0, 100}, {0, 0, -1}, {0, 1, 0}, 2 * math.deg(math.atan(0.5, 99.5)), {1, 1, 1}, lights or {})]],
    "--warnings=none " .. (options or ""))
  check(code == 0, "%s: %s", text, said)
  local pipe <close> = assert(io.popen(("'%s/tests/gr/codes' '%s/out.png'"):format(build, folder)))
  local width, height = pipe:read("n", "n")
  check(width == SIZE and height == SIZE)
  pipe:read(1)
  local codes = pipe:read "a"
  return function(x, y) return codes:byte(3 * (SIZE * y + x) + 1, 3 * (SIZE * y + x) + 3) end, codes
end

local function is(pixel, x, y, want, name)
  local got = table.concat({ pixel(x, y) }, ",")
  check(got == want, "%s: pixel %d, %d: %s expected, got %s", name, x, y, want, got)
end

-- Checks that all texts give the same pixel values.
local function same(texts, options)
  local first
  for _, text in ipairs(texts) do
    local pixel, codes = look(text, options)
    if first then check(codes == first, "%s: another picture than %s", text, texts[1]) end
    first = first or codes
    if text == texts[1] then texts.pixel = pixel end
  end
  return texts.pixel
end

-- A picture: red and green above blue and white.
local four, COLORS = png.new(SIZE, SIZE), { [0] = { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 1, 1 } }
for y = 0, SIZE - 1 do
  for x = 0, SIZE - 1 do four:set(x, y, COLORS[2 * (2 * y // SIZE) + 2 * x // SIZE]) end
end
four:save(folder .. "/four.png")

local CUBE <const> = "s = gr.cube('s') s:translate(-0.5, -0.5, -1) "
local PLAIN <const> = "m = gr.material({1, 1, 1}, {0, 0, 0}, 0) "

function tests.a_picture_lies_on_a_face_in_every_form()
  local pixel = same {
    CUBE .. PLAIN .. "s:set_texture(gr.texture('four.png'))",
    CUBE .. PLAIN .. "s:set_texture('four.png')",
    CUBE .. "s:set_texture('four.png') has_no_material = true",
    CUBE .. "m = gr.texture('four.png')",
    CUBE .. "m = gr.texture('four.png', {0, 0, 0}, 1)",
    CUBE .. "m = gr.texture('four.png', {0, 0, 0}, 25, 0)",
    CUBE .. "m = gr.texture('four.png', false)",
    CUBE .. "m = gr.texture('four.png', 1, 1)",
    CUBE .. "m = gr.texture_material('four.png', {0, 0, 0}, 25, 1)",
    CUBE .. "m = gr.material({0.3, 0, 0}, {0, 0, 0}, 0) m:set_texture('four.png')",
    CUBE .. "m = gr.material({0.3, 0, 0}, {0, 0, 0}, 0) m:set_texture(gr.texture 'four.png')",
    CUBE .. "m = gr.material({0.3, 0, 0}, {0, 0, 0}, 0, 0, 0, 'four.png')",
    CUBE .. "m = gr.material({0.3, 0, 0}, {0, 0, 0}, 0, 0, 0, 'four.png', '')",
    CUBE .. PLAIN .. "s:set_texture_map(gr.texture_map('four.png'))",
    CUBE .. PLAIN .. "gr.set_texture(s, gr.texture('four.png'), 1)",
  }
  is(pixel, 2, 2, "255,0,0", "upper left") is(pixel, 13, 2, "0,255,0", "upper right")
  is(pixel, 2, 13, "0,0,255", "lower left") is(pixel, 13, 13, "255,255,255", "lower right")
end

function tests.it_repeats()
  local pixel = same {
    CUBE .. "m = gr.texture('four.png', 2, 2)", CUBE .. PLAIN .. "s:set_texture(gr.texture('four.png', 2))",
    CUBE .. PLAIN .. "s:set_texture(gr.texture 'four.png', 2, 2)", CUBE .. PLAIN .. "s:set_texture('four.png', 2, 2)",
  }
  for _, x in ipairs { 2, 10 } do
    for _, y in ipairs { 2, 10 } do is(pixel, x, y, "255,0,0", "each repetition begins anew") end
  end
end

-- Pixel values are used directly: 128 of 255 stays 128.
function tests.codes_are_not_decoded()
  local grey = png.grey(1, 1)
  grey:set(0, 0, ((128 / 255 + 0.055) / 1.055) ^ 2.4)
  grey:save(folder .. "/grey.png")
  local r = look(CUBE .. "m = gr.texture 'grey.png'")(8, 8)
  check(r == 128 or r == 127, "128 expected, got %d", r)
end

-- A white texture is lit like a white material, with the same highlight.
function tests.it_is_lit_as_its_colour()
  write("white.txt", "")
  local white = png.new(1, 1)
  white:set(0, 0, { 1, 1, 1 })
  white:save(folder .. "/white.png")
  local LAMP <const> = "lights = { gr.light({0, 9, 9}, {0.3, 0.2, 0.1}, {1, 0, 0}) } s = gr.sphere('s') s:scale(0.5, 0.5, 0.5) "
  same({
    LAMP .. "m = gr.material({1, 1, 1}, {0.5, 0.5, 0.5}, 10)",
    LAMP .. "m = gr.texture('white.png', {0.5, 0.5, 0.5}, 10)",
    LAMP .. "m = gr.texture_material('white.png', {0.5, 0.5, 0.5}, 10)",
    LAMP .. "m = gr.material({0, 0, 0}, {0.5, 0.5, 0.5}, 10) s:set_texture('white.png')",
  }, "--gr-specular blinn")
end

local QUAD <const> = "v -.5 -.5 0\nv .5 -.5 0\nv .5 .5 0\nv -.5 .5 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1 0\n"
function tests.meshes_have_coordinates_of_their_own()
  write("quad.obj", QUAD .. "f 1/1 2/2 3/3 4/4\n")
  write("triangles.obj", QUAD .. "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1/-4/1 -2/-2/1 -1/-1/1\n")
  write("crossed.obj", QUAD .. "f 1/1 2/2 3/3 4/4\nv 5 5 0\nv 6 6 0\nv 6 5 0\nv 5 6 0\nf 5/1 6/2 7/3 8/4\n")
  local pixel = same {
    CUBE .. "m = gr.texture 'four.png'", "s = gr.mesh('s', 'quad.obj') m = gr.texture 'four.png'",
    "s = gr.mesh('s', 'triangles.obj') m = gr.texture 'four.png'", "s = gr.mesh('s', 'crossed.obj') m = gr.texture 'four.png'",
  }
  is(pixel, 2, 2, "255,0,0", "a mesh")
  write("bare.obj", QUAD .. "f 1/1 2/2 3/3\nf 1 3 4\n")
  local text = [[
    for i = 1, 3 do
      local s = gr.mesh('bare', 'bare.obj')
      s:set_material(gr.material({0, 1, 0}, {0, 0, 0}, 0))
      s:set_texture('four.png')
      for _ = 1, 2 do gr.render(s, 'out', 8, 8, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, 30, {1, 1, 1}, {}) end
      if i == 2 then break end
    end]]
  local said, code = run(text)
  local _, count = said:gsub("mesh 'bare' has no texture coordinates", "")
  check(code == 0 and count == 1, "told of once: %s", said)
  is(look "s = gr.mesh('s', 'bare.obj') m = gr.material({0, 1, 0}, {0, 0, 0}, 0) s:set_texture('four.png')", 8, 8, "0,255,0", "its own colour")
  for text_of, message in pairs { ["vt x 1\n"] = "line 9: two numbers expected, got 'x 1'" } do
    write("wrong.obj", QUAD .. text_of .. "f 1 2 3\n")
    said, code = run("gr.mesh('m', 'wrong.obj')")
    check(code == 2 and said:find(message, 1, true), "%s: %s", message, said)
  end
end

function tests.reliefs_turn_normals()
  local hill = png.grey(8, 8)
  for y = 0, 7 do
    for x = 0, 7 do hill:set(x, y, (x % 4) / 3) end
  end
  hill:save(folder .. "/hill.png")
  local LAMP <const> = "lights = { gr.light({0, 30, 90}, {0.8, 0.7, 0.6}, {1, 0, 0}) } m = gr.material({0.5, 0.5, 0.5}, {0, 0, 0}, 0) "
  local BALL <const> = LAMP .. "s = gr.sphere('s') s:scale(0.5, 0.5, 0.5) "
  local _, flat = look(BALL)
  same {
    BALL .. "s:set_bump(gr.bump 'hill.png')", BALL .. "s:set_bump('hill.png')", BALL .. "s:set_bumpmap('hill.png', 0.05)",
    BALL .. "s:set_bump_map(gr.bump_map('hill.png'))", BALL .. "m:set_bump('hill.png')", BALL .. "m:set_bumpmap(gr.bumpmap('hill.png'))",
    BALL .. "gr.bump(m, 'hill.png')", BALL .. "gr.load_bumpmap(m, 'hill.png')", BALL .. "s:set_bump(gr.bump('hill.png', 0.05))",
    -- The height scales with the shape: a ball of another radius, under another scale.
    LAMP .. "s = gr.nh_sphere('s', {0, 0, 0}, 20) s:scale(1 / 40, 1 / 40, 1 / 40) s:set_bump('hill.png')",
  }
  local _, bumped = look(BALL .. "s:set_bump('hill.png')")
  check(bumped ~= flat, "it shows")
  local _, none = look(BALL .. "s:set_bump('hill.png', 0)")
  check(none == flat, "a relief without height does not")
end

-- A face towards the eye mirrors the space behind the eye: only the background.
function tests.mirrors_add_their_share()
  local options = "--gr-background 0.2,0.4,0.6"
  local KD <const> = "m = gr.material({0.2, 0, 0.11}, {0, 0, 0}, 0"
  local pixel = same({
    CUBE .. KD .. ", 0.5)", CUBE .. KD .. ", 0.5, 0)", CUBE .. KD .. ", 0.5, 0, 0)", CUBE .. KD .. ", 0.5, 0, 1.5)",
    CUBE .. KD .. ") m:set_reflect(0.5)", CUBE .. KD .. ") m:reflection(0.5)",
    CUBE .. "m = gr.reflective_material({0.2, 0, 0.11}, {0, 0, 0}, 0, 0.5)", CUBE .. "m = gr.material_refl({0.2, 0, 0.11}, {0, 0, 0}, 0, 0.5)",
  }, options)
  is(pixel, 8, 8, "76,51,104", "kd + half of the background") -- 0.3, 0.2, 0.41 times 255, truncated
  pixel = same({ CUBE .. "m = gr.material({0, 0, 0}, {1, 1, 1}, 5, 1)", CUBE .. "m = gr.reflective()",
    CUBE .. "m = gr.material({0, 0, 0}, {0, 0, 0}, 0, 1.0)" }, options)
  is(pixel, 8, 8, "51,102,153", "all of it")
  is(look(CUBE .. KD .. ", 1)", options), 8, 8, "51,0,28", "where 1 may mean opaque")
  is(look(CUBE .. KD .. ", 0.5) m:set_reflect(0)", options), 8, 8, "51,0,28", "a field that is changed")
end

function tests.glass_is_seen_through()
  local options = "--gr-background 0.4,0.8,0.6"
  local KD <const> = "m = gr.material({0, 0, 0}, {0, 0, 0}, 0"
  is(look(CUBE .. KD .. ", 0, 0.5)", options), 8, 8, "25,51,38", "0.5 at each of two faces")
  is(look(CUBE .. KD .. ", 0.25, 0.5)", options), 8, 8, "59,118,89", "and 0.25 mirrored: 1/4 + 1/4 (1 + 1/4 + 1/16 ...) of it")
  same({
    CUBE .. KD .. ", 1.5)", CUBE .. KD .. ", 0, 1.5)", CUBE .. KD .. ", 0.7, 1.5)", CUBE .. "m = gr.refractive(1.5)",
    CUBE .. KD .. ") m:set_refract(1.5)", CUBE .. KD .. ") m:set_ri(1.5)",
  }, options)
  same({ CUBE .. KD .. ", 0, 0.8, 1.33)", CUBE .. KD .. ", 1.33, 0.8)", CUBE .. KD .. ", 0, 0, 0.8, 1.33)",
    CUBE .. "m = gr.material_refr({0, 0, 0}, {0, 0, 0}, 0, 0.8, 1.33)" }, options)
  -- All light is either reflected or transmitted: in front of a uniform background a glass ball looks like the
  -- background, except for light still inside after 5 surfaces.
  local r = look("s = gr.sphere('s') s:scale(0.5, 0.5, 0.5) " .. KD .. ", 1.5)", options)(8, 8)
  check(r >= 101 and r <= 102, "glass before an even background: 102 expected, got %d", r)
end

function tests.what_means_nothing_is_told_of_once()
  local text = [[
    for i = 1, 3 do gr.material({1, 1, 1}, {0, 0, 0}, 1, %s) end
    gr.render(gr.node('n'), 'out', 4, 4, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, 30, {1, 1, 1}, {})]]
  for extra, message in pairs {
    ["10000000"] = "10000000; a reflectivity 0 .. 1 or an index up to 4 expected",
    ["1"] = "1; 1 means a mirror only where kd is {0, 0, 0}",
    ["0.3, 1.5"] = "0.3; the refractive index determines how much glass reflects",
    ["0.05, 100"] = "0.05, 100; expected a reflectivity and a transparency 0 .. 1, or an index up to 4",
    ["1.3, 0, 0.6"] = "1.3, 0, 0.6; a reflectivity, a transparency and an index expected",
    ["0.5, 0.2, 1.33, 0.15"] = "0.15; only three numbers are used",
    ["2, 0.5, 0.2, 1.33"] = "2; glint's mirrors are always sharp",
    ["2, 0.5, 0.2, 9"] = "2, 0.5, 0.2, 9; a reflectivity, a transparency and an index expected",
    ["0.2, 0.5, 1, 7"] = "7; only three numbers are used",
    ["{3, 0, 0}"] = "table of 3; a reflectivity of three numbers 0 .. 1 expected",
    ["{1, 2}"] = "table of 2; expected numbers and the name of a picture",
    ["'soft'"] = '"soft"; expected numbers and the name of a picture',
  } do
    local said, code = run(text:format(extra))
    local _, count = said:gsub("left out after the shininess", "")
    check(code == 0 and count == 1 and said:find("scene.lua:1: gr.material: left out after the shininess: " .. message, 1, true), "%s: %s", extra, said)
  end
  for _, extra in ipairs { "0", "0, 0", "0, 0, 0, 0", "0, 0, ''", "nil", "false", "0.5", "0, 1.5", "0.5, 0.2, 1.33" } do
    local said, code = run(text:format(extra))
    check(code == 0 and said == " exit 0\n", "%s says nothing: %s", extra, said)
  end
  local said, code = run(text:format "7", "--warnings=error")
  check(code == 2 and said:find "left out", "a warning may be an error: %s", said)
end

function tests.noise_mixes_two_colours()
  local pixel = look("s = gr.sphere('s') s:scale(0.5, 0.5, 0.5) m = gr.perlin_material({1, 0, 0}, {0, 0, 1}, {0, 0, 0}, 5, 0, 0.0)")
  local least, most = 255, 0
  for x = 4, 11 do
    for y = 4, 11 do
      local r, g, b = pixel(x, y)
      check(g == 0 and r + b >= 253, "a mixture: %d, %d, %d", r, g, b)
      least, most = math.min(least, r), math.max(most, r)
    end
  end
  check(most - least > 60, "it varies: %d .. %d", least, most)
end

local PAINT <const> = PLAIN .. "m:set_texture('four.png') "

-- Squares of every form, seen from their front and from behind, show the texture like a cube's face.
function tests.planes_are_squares()
  same {
    CUBE .. PAINT,
    PAINT .. "gr.options.plane = 'xy' s = gr.plane('s')",
    PAINT .. "gr.options.plane = 'xy-2' s = gr.plane('s') s:scale(0.5, 0.5, 0.5)",
    PAINT .. "gr.options.plane = 'xy-corner' s = gr.plane('s') s:translate(-0.5, -0.5, 0)",
    PAINT .. "s = gr.plane('s') s:rotate('x', 90)",
    PAINT .. "gr.options.plane = 'xz-2' s = gr.plane('s', nil) s:rotate('x', 90) s:scale(0.5, 0.5, 0.5)",
    PAINT .. "gr.options.plane = 'xz-corner' s = gr.plane('s') s:rotate('x', 90) s:translate(-0.5, 0.5, 0)",
    PAINT .. "s = gr.plane('s', {-0.5, -0.5, 0}, {1, 0, 0}, {0, 2, 0}, 1, 1)",
    PAINT .. "s = gr.plane('s', {0, 0, 0}, {3, 0, 0}, {0, 1, 0}, 1)",
    PAINT .. "s = gr.plane('s', {0, 0, 0}, {-1, 0, 0}, {0, 1, 0}, 1) s:rotate('y', 180)",
  }
  local pixel = same { PAINT .. "s = gr.plane('s', {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.5, 0.5)", PAINT
    .. "gr.options.plane = 'xy-corner' s = gr.plane('s') s:scale(0.5, 0.5, 0.5)" }
  is(pixel, 4, 4, "0,0,0", "a corner at the origin: nothing to the left") is(pixel, 9, 2, "255,0,0", "above and right of it")
  -- The square is lit from the eye's side, whichever way it faces.
  local LIT <const> = PLAIN .. "lights = { gr.light({0, 0, 9}, {0.5, 0.4, 0.3}, {1, 0, 0}) } "
  same { LIT .. "s = gr.plane('s', {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1)", LIT .. "s = gr.plane('s', {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 1)" }
end

function tests.an_unsaid_plane_is_told_of_once()
  local TEXT <const> = "for i = 1, 2 do gr.plane('p' .. i) end gr.render(gr.node('n'), 'out', 4, 4, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, 30, {1, 1, 1}, {})"
  local said, code = run(TEXT)
  local _, count = said:gsub("variants of the dialect have other squares", "")
  check(code == 0 and count == 1 and said:find "Choose one with %-%-gr%-plane: xz, xz%-2, xz%-corner, xy", "%s", said)
  said, code = run(TEXT, "--gr-plane xz")
  check(code == 0 and said == " exit 0\n", "an option that says it is enough: %s", said)
  said, code = run(TEXT, "--gr-plane yz")
  check(code == 2 and said:find('--gr-plane: "xz", "xz-2", "xz-corner", "xy", "xy-2" or "xy-corner" expected, got "yz"', 1, true), "%s", said)
end

-- A solid about another axis equals the rotated one.
function tests.round_solids_have_an_axis()
  for _, shape in ipairs { "cylinder", "cone" } do
    local TURNED <const> = PLAIN .. "lights = { gr.light({5, 9, 9}, {0.5, 0.4, 0.3}, {1, 0, 0}) } "
    local SMALL <const> = " s:scale(0.4, 0.4, 0.4)"
    local function by(axis, turn) return TURNED .. ("gr.options.axis = '%s' s = gr.%s('s') "):format(axis, shape) .. turn .. SMALL end
    same { by("z", "s:rotate('x', -90)"), by("y", "") }
    same { by("z", "s:rotate('y', 90)"), by("x", "") }
    local said, code = run("gr.options.axis = 'w'")
    check(code == 2 and said:find('gr.options.axis: "x", "y" or "z" expected, got "w"', 1, true), "%s", said)
  end
end

-- A floor under a ball, and a light above it.
local FLOOR <const> = "m = gr.material({0.4, 0.4, 0.4}, {0, 0, 0}, 0) s = gr.plane('s', {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1) "
  .. "b = gr.nh_sphere('b', {-0.2, 0, 0.2}, 0.1) b:set_material(m) s:add_child(b) lights = { %s }"

function tests.lamps_have_a_surface()
  local point = FLOOR:format "gr.light({0.3, 0, 1}, {1, 0.8, 0.6}, {1, 0.1, 0})"
  same {
    point, FLOOR:format "gr.area_light({0.3, 0, 1}, {1, 0.8, 0.6}, {1, 0.1, 0}, 0)",
    FLOOR:format "gr.arealight({0.3, 0, 1}, {1, 0.8, 0.6}, {1, 0.1, 0}, 0, 40)", FLOOR:format "gr.sphericallight({0.3, 0, 1}, {1, 0.8, 0.6}, {1, 0.1, 0}, 0)",
  }
  local _, sharp = look(point)
  for _, form in ipairs { -- small lights equal points, large lights have soft shadows
    "gr.area_light({0.3, 0, 1}, {1, 0.8, 0.6}, {1, 0.1, 0}, %g / 2, 20)",
    "gr.area_light({0.3, 0, 1}, {1, 0.8, 0.6}, {1, 0.1, 0}, {0, 0, -1}, {0, 1, 0}, %g, 30)",
    "gr.area_light({0.3 - %g / 2, -%g / 2, 1}, {%g, 0, 0}, 5, {0, %g, 0}, 8, {1, 0.8, 0.6}, {1, 0.1, 0})",
    "gr.rect_light({0.3, 0, 1}, %g, %g, {1, 0.8, 0.6}, {1, 0.1, 0}, 5)",
  } do
    local _, small = look(FLOOR:format(form:gsub("%%g", "1e-7")))
    local _, large = look(FLOOR:format(form:gsub("%%g", "0.4")))
    local apart, soft = 0, 0
    for i = 1, #sharp do
      apart = math.max(apart, math.abs(small:byte(i) - sharp:byte(i)))
      soft = math.max(soft, math.abs(large:byte(i) - sharp:byte(i)))
    end
    check(apart <= 1 and soft > 20, "%s: %d codes from a point's, %d when large", form, apart, soft)
  end
end

-- Different forms give the same light. An additional list of lights is appended to the first.
function tests.lamps_of_several_forms_are_one()
  same {
    FLOOR:format "gr.rect_light({0.3, 0, 1}, 0.4, 0.2, {0.5, 0.4, 0.3}, {1, 0, 0}, 40)",
    FLOOR:format "gr.area_light({0.1, 0, 0.9}, {0.4, 0, 0}, 5, {0, 0, 0.2}, 8, {0.5, 0.4, 0.3}, {1, 0, 0})",
  }
  local END <const> = " s:set_material(m) gr.render(s, 'out', 16, 16, {0, 0, 100}, {0, 0, -1}, {0, 1, 0}, 0.5, {1, 1, 1}, %s) os.exit()"
  local BOTH <const> = FLOOR:format "" .. "a, b = gr.light({0.3, 0, 1}, {0.1, 0, 0}), gr.area_light({0, 0, 1}, {0.1, 0, 0.1}, {1, 0, 0}, 0.1)" .. END
  same { BOTH:format "{a, b}", BOTH:format "{a}, {b}" }
end

function tests.what_is_too_much_is_told_of_once()
  local END <const> = " gr.render(gr.node('n'), 'out', 4, 4, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, 30, {1, 1, 1}, {}%s)"
  for text, message in pairs {
    ["gr.light({0, 0, 0}, {1, 1, 1}, {1, 0, 0}, 1.5)"] = "gr.light: left out: 1.5",
    ["gr.cylinder('c', 0.25)"] = "gr.cylinder: left out: 0.25",
    ["gr.plane('p', 10)"] = "gr.plane: left out: 10",
    ["gr.node('n'):scale(1, 1, 1, {1})"] = "gr.scale: left out: table of 1",
    ["gr.area_light({0, 0, 0}, {1, 1, 1}, {1, 0, 0}, 1, 4, 'soft')"] = 'gr.area_light: left out: "soft"',
  } do
    local said, code = run(("for i = 1, 3 do %s end"):format(text) .. END:format "", "--gr-plane xz")
    check(code == 0 and said == "glint: warning: scene.lua:1: " .. message .. "\n exit 0\n", "%s: %s", text, said)
  end
  local said, code = run(END:format ", 16, 0, {}, nil, 'x'")
  check(code == 0 and said:find('gr.render: left out: 16, 0, table of 0, nil, "x"', 1, true), "%s", said)
  said, code = run("gr.light({0, 0, 0}, {1, 1, 1}, {1, 0, 0}, 0, 0) gr.cylinder('c', nil)" .. END:format ", 0")
  check(code == 0 and said == " exit 0\n", "what says nothing: %s", said)
end

function tests.errors_name_the_call()
  write("text.png", "no picture")
  local function refuses(text, message)
    local said, code = run("local s, m = gr.sphere('s'), gr.material({1, 1, 1}, {0, 0, 0}, 1)\n" .. text)
    check(code == 2 and said:find("scene.lua:2: " .. message, 1, true), "%s: %s", text, said)
  end
  refuses("gr.texture('none.png')", "gr.texture: 'none.png': no such file; looked for ")
  refuses("gr.texture('text.png')", "gr.texture: text.png: ")
  refuses("gr.texture()", "gr.texture: file: string expected, got nil")
  refuses("gr.texture('four.png', 'x')", "gr.texture: ks: table expected, got \"x\"")
  refuses("gr.texture('four.png', {1, 2}, 3)", "gr.texture: ks: table of 3 numbers expected, got table of 2")
  refuses("gr.texture('four.png', {1, 2, 3})", "gr.texture: shininess: number expected, got nil")
  refuses("s:set_texture()", "gr.set_texture: texture: texture or name of a file expected, got nil")
  refuses("s:set_texture(m)", "gr.set_texture: texture: texture or name of a file expected, got material")
  refuses("gr.node('n'):set_texture('four.png')", "gr.set_texture: a shape expected, got the node 'n', which has no surface")
  refuses("s:set_bump('none.png')", "gr.set_bump: 'none.png': no such file")
  refuses("s:set_bump('four.png', 'high')", "gr.set_bump: height: number expected, got \"high\"")
  refuses("s:set_bump(gr.texture 'four.png')", "gr.set_bump: bump: bump or name of a file expected, got texture")
  refuses("m:set_reflect(-1)", "gr.set_reflect: reflectivity: number >= 0 expected, got -1")
  refuses("m:set_ri(0)", "gr.set_ri: index: number > 0 expected, got 0")
  refuses("gr.refractive()", "gr.refractive: index: number expected, got nil")
  refuses("gr.reflective_material({1, 1, 1}, {0, 0, 0}, 1)", "gr.reflective_material: reflectivity: number expected, got nil")
  refuses("gr.plane('p', {0, 0}, {1, 0, 0}, {0, 1, 0}, 1)", "gr.plane: middle: table of 3 numbers expected, got table of 2")
  refuses("gr.plane('p', {0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 1)", "gr.plane: u: a direction other than {0, 0, 0} expected")
  refuses("gr.plane('p', {0, 0, 0}, {1, 0, 0}, {0, 1, 0})", "gr.plane: edge: number expected, got nil")
  refuses("gr.plane('p', {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 0)", "gr.plane: height: number above 0 expected, got 0")
  refuses("gr.plane('p', {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, 1)", "gr.plane: v: another direction than that of u expected")
  refuses("gr.area_light(0.45, {0, 0, 0}, {1, 1, 1}, {1, 0, 0})", "gr.area_light: {position}, {colour}, {fall-off}, radius expected, got 0.45 first")
  refuses("gr.area_light({0, 0, 0}, {1, 1, 1}, {1, 0, 0})", "gr.area_light: radius: number expected, got nil")
  refuses("gr.area_light({0, 0, 0}, {1, 1, 1}, {1, 0, 0}, -1)", "gr.area_light: radius: number >= 0 expected, got -1")
  refuses("gr.arealight({0, 0, 0}, {1, 1, 1}, {1, 0, 0}, 1, 0.5)", "gr.arealight: samples: number >= 1 expected, got 0.5")
  refuses("gr.area_light({0, 0, 0}, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 2, 0}, 1)", "gr.area_light: up: another direction than that of the normal")
  refuses("gr.area_light({0, 0, 0}, {1, 0, 0}, 4, {2, 0, 0}, 4, {1, 1, 1})", "gr.area_light: edge: two edges of different directions expected")
  refuses("gr.rect_light({0, 0, 0}, 0, 1, {1, 1, 1})", "gr.rect_light: width: number above 0 expected, got 0")
  refuses("gr.rect_light({0, 0, 0}, 1, 1, {1, -1, 1})", "gr.rect_light: colour[2]: number >= 0 expected, got -1")
  refuses("gr.normal_map('four.png', 0)", "gr.normal_map: strength: number above 0 expected, got 0")
  refuses("gr.sphere('s'):set_normal(1)", "gr.set_normal: map: normal map or name of a file expected, got 1")
  refuses("gr.sphere('s'):set_perlin('x')", "gr.set_perlin: kind: number expected, got \"x\"")
  refuses("gr.material({1, 1, 1}, {0, 0, 0}, 1):set_opacity(1.5)", "gr.set_opacity: opacity: number 0 .. 1 expected, got 1.5")
  refuses("gr.material({1, 1, 1}, {0, 0, 0}, 1, {1, 2, -1})", "gr.material: reflectivity[3]: number >= 0 expected, got -1")
  refuses("gr.bump('four.png'):remap(1)", "bump:remap: this method is not part of the dialect")
end

-- A material changed after a picture, and shapes under several maps, give the same picture as a fresh scene.
function tests.later_changes_show()
  local pixel = look(CUBE .. PLAIN .. [[
    s:set_material(m)
    gr.render(s, 'first', 8, 8, {0, 0, 9}, {0, 0, -1}, {0, 1, 0}, 10, {1, 1, 1}, {})
    m:set_texture('four.png')
    gr.render(s, 'second', 8, 8, {0, 0, 9}, {0, 0, -1}, {0, 1, 0}, 10, {1, 1, 1}, {})]])
  is(pixel, 2, 2, "255,0,0", "after two pictures")
end

-- ---- Translucency, coloured mirrors, noise ----

-- A red wall with a brightness of 0.5.
local WALL <const> = [[
  m = gr.material({0.5, 0, 0}, {0, 0, 0}, 0)
  wall = gr.nh_box('w', {-5, -5, -20}, 10) wall:set_material(m) ]]

function tests.what_hides_a_share()
  local pane = "s = gr.cube('s') s:translate(-0.5, -0.5, -1) s:add_child(wall) m = gr.material({0.4, 0.8, 0}, {0, 0, 0}, 0) "
  is(look(WALL .. pane .. "m:set_opacity(1)"), 8, 8, "102,204,0", "all")
  is(look(WALL .. pane .. "m:set_opacity(0.75)"), 8, 8, "103,191,0", "by both of its faces") -- 0.75 x + 0.25 (0.75 x + 0.25 red)
  is(look(WALL .. pane .. "m:set_opacity(0, 1)"), 8, 8, "127,0,0", "nothing")
end

function tests.a_reflectivity_has_colours()
  is(look(CUBE .. "gr.options.background = {0.5, 0.5, 0.5} m = gr.material({0.25, 0, 0}, {0, 0, 0}, 0, {0.5, 0, 1})"), 8, 8,
    "127,0,127", "of the background")
end

function tests.noise_lies_on_shapes()
  for _, text in ipairs { "s:set_perlin(1)", "s:set_perlin(1, 0)", "s:set_perlin(gr.perlin(0.01, 4, 1000, 1000))" } do
    local pixel, least, most = look(CUBE .. PLAIN .. text), 255, 0
    for x = 0, SIZE - 1 do
      for y = 0, SIZE - 1 do least, most = math.min(least, (pixel(x, y))), math.max(most, (pixel(x, y))) end
    end
    check(least < 100 and most > 150, "%s: %d .. %d", text, least, most)
  end
end

-- ---- Normals ----

-- Returns the value of a matt grey with normal n, in ambient light of 1 and one light from l.
local function shade_of(n, l)
  local function unit(v) return (v[1] * v[1] + v[2] * v[2] + v[3] * v[3]) ^ 0.5 end
  local cosine = (n[1] * l[1] + n[2] * l[2] + n[3] * l[3]) / (unit(n) * unit(l))
  return 255 * 0.4 * (1 + math.max(cosine, 0))
end

local function decode(x) return ((x + 0.055) / 1.055) ^ 2.4 end

local LEAN <const> = { 204 / 255, 153 / 255, 1 } -- a normal of 0.6 along u, 0.2 along v, 1 along the geometric normal
local function lit(text, l)
  local lean = png.new(1, 1)
  lean:set(0, 0, { decode(LEAN[1]), decode(LEAN[2]), 1 })
  lean:save(folder .. "/lean.png")
  return look(("m = gr.material({0.4, 0.4, 0.4}, {0, 0, 0}, 0) lights = {gr.light({%g, %g, %g}, {1, 1, 1}, {1, 0, 0})} %s")
    :format(1e6 * l[1], 1e6 * l[2], 1e6 * l[3], text))
end

local function leans(text, x, y, n, name)
  for _, l in ipairs { { 1, 0.5, 2 }, { -1, 0.3, 1 }, { 0, -1, 1 } } do
    local code, want = lit(text, l)(x, y), shade_of(n, l)
    check(math.abs(code + 0.5 - want) <= 1, "%s: %.2f expected, got %d", name, want, code)
  end
end

function tests.normals_lie_on_faces()
  local map = " s:set_normal(gr.normal_map 'lean.png')"
  for _, turn in ipairs { "", "s:rotate('y', 90)", "s:rotate('y', 180)", "s:rotate('y', -90)", "s:rotate('x', 90)",
    "s:rotate('x', -90)" } do
    leans("s = gr.nh_box('s', {-0.5, -0.5, -0.5}, 1) " .. turn .. map, 5, 9, { 0.6, 0.2, 1 }, "a face of a box, " .. turn)
  end
  local box = "s = gr.nh_box('s', {-0.5, -0.5, -0.5}, 1) "
  leans(box .. "s:scale(-1, 1, 1)" .. map, 5, 9, { -0.6, 0.2, 1 }, "mirrored")
  leans(box .. "s:scale(1, 2, 3)" .. map, 5, 9, { 0.6, 0.2, 1 }, "stretched")
  leans(box .. "s:set_normal_map('lean.png')", 5, 9, { 0.6, 0.2, 1 }, "by the file's name")
  leans(box .. "s:set_normal(gr.normal_map('lean.png', 0.5, 3, 4))", 5, 9, { 0.3, 0.1, 1 }, "weaker")
  leans(box .. "map = gr.normal_map 'lean.png' s:set_normal(map) ball = gr.nh_sphere('b', {-30, 0, -1}, 1) ball:set_material(m) "
    .. "ball:set_normal(map) root = gr.node('r') root:add_child(ball) root:add_child(s) s:set_material(m) s, has_no_material = root, true",
    5, 9, { 0.6, 0.2, 1 }, "beside a ball with the same map")
end

-- Normals tilted up by 0.6 on a cube of index 1.3 bend a level ray down at both faces, to (0, -0.395, -0.919).
function tests.normals_lean_alike_from_within()
  local up = png.new(1, 1)
  up:set(0, 0, { decode(128 / 255), decode(204 / 255), 1 })
  up:save(folder .. "/up.png")
  local scene = [[
    red, blue = gr.material({1, 0, 0}, {0, 0, 0}, 0), gr.material({0, 0, 1}, {0, 0, 0}, 0)
    low, middle = gr.nh_box('low', {-7, -15, -40}, 14), gr.nh_box('middle', {-2, -0.9, -40}, 4)
    low:set_material(red) middle:set_material(blue)
    s = gr.nh_box('s', {-0.5, -0.5, -0.5}, 1) s:add_child(low) s:add_child(middle)
    m = gr.material({0, 0, 0}, {0, 0, 0}, 0, 0, 1, 1.3) ]]
  is(look(scene), 8, 8, "0,0,255", "straight through")
  is(look(scene .. "s:set_normal(gr.normal_map 'up.png')"), 8, 8, "255,0,0", "down")
end

function tests.normals_lie_on_balls()
  local map = " s:set_normal(gr.normal_map 'lean.png')"
  local x, y = (2 * 10 + 1 - SIZE) / SIZE, (SIZE - 2 * 4 - 1) / SIZE -- near pixel 10, 4: the eye is far away
  local z = math.sqrt(1 - x * x - y * y)
  local round = math.sqrt(x * x + z * z)
  local u = { z / round, 0, -x / round }
  local v = { y * u[3], z * u[1] - x * u[3], -y * u[1] }
  local n = {}
  for i, d in ipairs { x, y, z } do n[i] = d + 0.6 * u[i] + 0.2 * v[i] end
  leans("s = gr.sphere('s') s:scale(0.5, 0.5, 0.5)" .. map, 10, 4, n, "a ball")
  leans("s = gr.nh_sphere('s', {1, 0, 0}, 2) s:translate(-1, 0, 0) s:scale(0.25, 0.25, 0.25)" .. map, 10, 4, n, "placed")
  leans("gr.options.axis = 'y' s = gr.cylinder('s') s:translate(0, -0.5, 0) s:scale(0.5, 2, 0.5)" .. map, 10, 4,
    { x + 0.6 * math.sqrt(1 - x * x), 0.2, math.sqrt(1 - x * x) - 0.6 * x }, "a cylinder")
end

tally.run(tests)
tally.finish()
