-- The gr dialect: pictures against tests/gr/witness.lua pixel by pixel, both generations and their detection,
-- features of old Lua versions, search paths of files, the command's options, wrong input.
local build = os.getenv "BUILD" or "build"
local tally = dofile "tests/lua/tally.lua"
local check = tally.check
package.path = "scripts/lib/?.lua;tests/gr/?.lua;" .. package.path
local random_scene, witness = require "random_scene", require "witness"

local function output_of(command)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  pipe:close()
  return text
end

local here = output_of "pwd":gsub("\n", "")
local glint = here .. "/" .. build .. "/glint"
local folder = here .. "/" .. build .. "/tests/gr/out"
assert(os.execute(("rm -rf '%s' && mkdir -p '%s/deep/scenes'"):format(folder, folder)))

local function write(name, text)
  local file = assert(io.open(folder .. "/" .. name, "wb"))
  file:write(text)
  file:close()
end

-- Runs a shell command in the folder. Returns its combined output and its exit code.
local function run(line)
  local text = output_of(("cd '%s' && { %s; } 2>&1 </dev/null; echo \" exit $?\""):format(folder, line))
  return text, tonumber(text:match "exit (%d+)\n$")
end

-- Runs a scene with this text.
local function scene(text, options)
  write("scene.lua", text)
  return run(("'%s' --dialect gr scene.lua --quiet -t 1 %s"):format(glint, options or ""))
end

local function read_codes(path)
  local pipe = assert(io.popen(("'%s/tests/gr/codes' '%s'"):format(build, path)))
  local width, height = pipe:read("n", "n")
  pipe:read(1)
  local codes = pipe:read "a"
  pipe:close()
  return width, height, codes
end

-- ---- Pictures against the witness ----

local TIE = 1e-5 -- in pixels; if so small a shift explains a difference, two surfaces tie, or a shadow's edge is there

local function largest_difference(want, codes, at)
  local largest = 0
  for c = 1, 3 do largest = math.max(largest, math.abs(want[c] - codes:byte(at + c))) end
  return largest
end

local function is_tie(picture, x, y, codes, at)
  for _, move in ipairs { { TIE, 0 }, { -TIE, 0 }, { 0, TIE }, { 0, -TIE } } do
    if largest_difference(picture:codes(x, y, move[1], move[2]), codes, at) <= 1 then return true end
  end
  return false
end

local total = { same = 0, near = 0, ties = 0, off = 0 }

local function compare_pixels(picture, name)
  local path = picture.file:lower():find "%.png$" and picture.file or picture.file .. ".png"
  local width, height, codes = read_codes(folder .. "/" .. path)
  local count = { same = 0, near = 0, ties = 0, off = 0 }
  check(width == picture.width and height == picture.height, "%s: %s: size", name, path)
  for y = 0, picture.height - 1, tally.step do
    for x = 0, picture.width - 1 do
      local at = 3 * (y * picture.width + x)
      local difference = largest_difference(picture:codes(x, y, 0, 0), codes, at)
      local kind = difference == 0 and "same" or difference == 1 and "near"
        or is_tie(picture, x, y, codes, at) and "ties" or "off"
      count[kind] = count[kind] + 1
    end
  end
  local pixels = picture.width * math.ceil(picture.height / tally.step)
  check(count.off == 0, "%s: %s: %d pixels are off", name, path, count.off)
  check(count.near <= 0.01 * pixels and count.ties <= 0.002 * pixels, "%s: %s: %d pixels by one code, %d ties", name,
    path, count.near, count.ties)
  for kind, number in pairs(count) do total[kind] = total[kind] + number end
end

local function path_against_witness(path, name, order, line, options)
  local said, code = run(("rm -f *.png; '%s' %s --dialect gr '%s' --quiet --warnings=none -t 1"):format(glint, line, path))
  check(code == 0, "%s: %s", name, said)
  if code ~= 0 then return end
  for _, picture in ipairs(witness.run(path, order, options)) do compare_pixels(picture, name) end
end

local function against_witness(name, order, line, options)
  path_against_witness(("%s/tests/gr/scenes/%s.lua"):format(here, name), name, order, line or "", options or {})
end

against_witness("spheres", "pre")
against_witness("spheres", "pre", "--gr-pixel 0", { pixel = 0 })
against_witness("shapes", "pre")
against_witness("shapes", "pre", "--gr-specular blinn --gr-background '#204080'",
  { specular = "blinn", background = { 0x20, 0x40, 0x80 } })
against_witness("shapes", "post", "--gr-order post --gr-background 0.1,0.2,2", { background = { 25, 51, 255 } })
against_witness("instances", "pre")
against_witness("first", "post")
against_witness("first", "pre", "--gr-order=pre")
against_witness("second", "pre")
against_witness("behind", "post")
against_witness("lamps", "pre")
against_witness("lamps", "pre", "--gr-specular blinn", { specular = "blinn" })
against_witness("frames", "pre")
against_witness("frames", "pre", "--no-reuse")
-- Scenes as students write them, each unusual in a different way.
for name, order in pairs {
  both = "pre", cameras = "pre", carried = "post", classes = "pre", comments = "pre", deep = "pre", dents = "post",
  family = "pre", film = "pre", globals = "pre", helpers = "post", lights = "pre", mirrored = "pre", nested = "post",
  nothing = "pre", paths = "pre", seeded = "pre", sheared = "pre", shine = "pre", strings = "pre",
} do
  against_witness("odd/" .. name, order)
end
-- Random scenes. GLINT_SEED=N selects others, GLINT_SCENES=N sets their number.
local seed, scenes = tonumber(os.getenv "GLINT_SEED" or 1), tonumber(os.getenv "GLINT_SCENES" or 30)
for i = seed * 1000 + 1, seed * 1000 + scenes, tally.step do
  local text, order = random_scene(i, here .. "/tests/gr/scenes/models")
  write("random.lua", text)
  path_against_witness(folder .. "/random.lua", "random scene " .. i, order, "", {})
end

print(("# %d pixels the same, %d by one code, %d ties, %d off"):format(total.same, total.near, total.ties, total.off))
check(total.same * tally.step > 100000 and total.same > 200 * (total.near + total.ties), "nearly all pixels are the same")

-- ---- The command ----

local function files()
  local text = run "ls *.png 2>/dev/null | tr '\\n' ' '"
  return (text:gsub(" exit.*", ""))
end

local SMALL = [[
  for i = 1, 4 do
    gr.render(gr.node('r'), 'small' .. i, 8, 6, {0,0,1}, {0,0,-1}, {0,1,0}, 50, {0,0,0}, {})
  end]]
run "rm -f *.png"
scene(SMALL, "--frames 2-3")
check(files() == "small2.png small3.png ", "--frames counts the calls: %s", files())
run "rm -f *.png"
scene(SMALL, "--shard 2/2")
check(files() == "small2.png small4.png ", "--shard counts the calls: %s", files())
run "rm -f *.png"
scene(SMALL, "-o other.png --size 5x4")
check(files() == "other_0001.png other_0002.png other_0003.png other_0004.png ", "-o beats the names: %s", files())
check(read_codes(folder .. "/other_0003.png") == 5, "--size beats the script's")
local said, code = run(("'%s' -o none scene.lua --quiet --dialect=gr && rm -f *.png && '%s' scene.lua --dialect gr --json"
  .. " | grep -c rendered; '%s' --dialect gr scene.lua --json | grep -c '\"kept\"'"):format(glint, glint, glint))
check(code == 0 and said:find "^4\n[45]\n", "any order of words; finished pictures are kept: %s", said)
said = run(("'%s' explain --dialect gr scene.lua; '%s' reproduce small2.png scene.lua --dialect gr"):format(glint, glint))
check(said:find "decided in double" and said:find "the same, byte for byte", "explain and reproduce know the dialect: %s", said)
said, code = scene("x = 1")
check(code == 2 and said:find "scene.lua rendered nothing; expected it to call gr.render", "no picture: %s", said)
said, code = run(("'%s' scene.lua --gr-pixel 0"):format(glint))
check(code == 2 and said:find "%-%-gr%-pixel: expected together with %-%-dialect gr", "%s", said)
for _, wrong in ipairs { "--dialect grr", "--gr-order up", "--gr-pixel 0.25", "--gr-specular none", "--gr-background red",
  "--gr-background 1,2", "--gr-background 1,x,0", "--gr-background=-1,0,0", "--gr-background '#12345'" } do
  said, code = scene(SMALL, wrong)
  check(code == 2 and said:find("glint: error: " .. wrong:match "%-%-[%w-]+", 1, true) and not said:find "gr%.options",
    "%s: %s", wrong, said)
end
write("bare.lua", "local n = gr.node('n')")
said, code = run(("'%s' bare.lua"):format(glint))
check(code == 2 and said:find "is it a scene for %-%-dialect gr%?", "a scene without the option: %s", said)

-- Pixel values are linear without a gamma chunk, as in the course; --transfer linear adds the chunk.
local function bytes_of(name)
  local file = assert(io.open(folder .. "/" .. name, "rb"))
  local bytes = file:read "a"
  file:close()
  return bytes
end
local BALL = [[local s = gr.sphere('s') s:set_material(gr.material({0.6, 0.4, 0.2}, {0, 0, 0}, 0))
  gr.render(s, 'ball', 16, 16, {0, 0, 4}, {0, 0, -1}, {0, 1, 0}, 50, {1, 1, 1}, {})]]
scene(BALL)
scene(BALL, "--transfer linear -o linear.png")
check(not bytes_of "ball.png":find "gAMA" and not bytes_of "ball.png":find "sRGB", "the file says nothing of a gamma")
check(bytes_of "linear.png":find "gAMA", "a linear file says so")
local _, _, ball = read_codes(folder .. "/ball.png")
local _, _, linear = read_codes(folder .. "/linear.png")
check(ball == linear and ball:byte(3 * (16 * 8 + 8) + 1) == 153, "the codes are the same")

-- Names are literal: % and # in a name are not placeholders for a number.
run "rm -f *.png"
scene [[for _, name in ipairs { 'a#1.png', '50%.PNG', '%d', 'x/y', 'dot.jpg', 7 } do
  gr.render(gr.node('r'), name, 4, 4, {0,0,1}, {0,0,-1}, {0,1,0}, 50, {0,0,0}, {})
end]]
said = run "ls -d *.* x/* | tr '\\n' ' '"
for _, name in ipairs { "%d.png", "50%.PNG", "7.png", "a#1.png", "dot.jpg.png", "x/y.png" } do
  check(said:find(name, 1, true), "a name that says what it is: %s: %s", name, said)
end

-- ---- Plain Lua, and from any folder ----

local lua = ("LUA_PATH='%s/scripts/lib/?.lua;;' LUA_CPATH='%s/%s/?.so' '%s'"):format(here, here, build,
  os.getenv "LUA" or "lua5.4")
run "rm -f *.png"
local first = ("%s/tests/gr/scenes/first.lua"):format(here)
local compare = ("'%s' compare first.png plain.png"):format(glint)
said, code = run(("%s -l gr '%s' && mv first.png plain.png && '%s' --dialect gr '%s' --quiet --warnings=none && %s")
  :format(lua, first, glint, first, compare))
check(code == 0, "lua -l gr makes the same picture: %s", said)
write("driver.lua", ("gr = require 'gr'\ndofile '%s'"):format(first))
said, code = run(("%s driver.lua && %s"):format(lua, compare))
check(code == 0, "a script that runs the scene: %s", said)
said, code = run(("cd '%s/tests/gr/scenes' && '%s' first.lua --dialect gr --quiet --warnings=none -o '%s/there.png' && cd models && "
  .. "'%s' ../first.lua --dialect gr -o '%s/below.png' --quiet --warnings=none; cd '%s'; cmp there.png first.png && "
  .. "cmp below.png first.png"):format(here, glint, folder, glint, folder, folder))
check(code == 0, "from the scene's folder and from another: %s", said)

-- Models in the scene's folder, its parent folder, and the working directory.
local TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
write("deep/above.obj", TRIANGLE)
write("deep/scenes/beside.obj", TRIANGLE)
write("where.obj", TRIANGLE)
write("deep/helper.lua", "helped = (helped or 0) + 1")
write("deep/scenes/find.lua", [[
  for _, name in ipairs { 'above', 'beside', 'where' } do gr.mesh(name, name .. '.obj') end
  require 'helper' dofile 'helper.lua' assert(loadfile 'helper.lua')() require 'helper.lua'
  assert(helped == 4)
  require 'readobj'
  local verts, faces = readobj('above.obj')
  assert(#verts == 3 and verts[2][1] == 1 and faces[1][1] == 0)
  assert(io.open 'beside.obj' and io.lines 'above.obj' () == 'v 0 0 0')
  assert(not io.open 'nowhere.obj' and not io.open('no/folder', 'w'))
  local good, message = pcall(gr.mesh, 'x', 'nowhere.obj')
  assert(not good and message:find "find.lua:%d+: gr.mesh: 'nowhere.obj': no such file; looked for", message)]] .. SMALL)
said, code = run(("'%s' --dialect gr deep/scenes/find.lua -o none --quiet"):format(glint))
check(code == 0, "where files are found: %s", said)
write("deep/scenes/readobj.lua", "function readobj() return 'the scene has its own' end")
write("own.lua", "require 'readobj' assert(readobj() == 'the scene has its own')" .. SMALL)
said, code = run(("cp own.lua deep/scenes; '%s' --dialect gr deep/scenes/own.lua -o none --quiet"):format(glint))
check(code == 0, "a readobj of the scene's own: %s", said)

-- ---- Features of old Lua versions ----

write("old.lua", "module('old', package.seeall)\npi = math.pi\nfunction twice(x) return 2 * x end\n")
said, code = scene([[
  assert(select('#', unpack({1, 2, 3})) == 3 and loadstring('return 5')() == 5)
  assert(table.getn({7, 8}) == 2 and table.maxn({[9] = 1}) == 9)
  table.setn({}, 0)
  local sum = 0
  table.foreach({a = 1, b = 2}, function(_, v) sum = sum + v end)
  table.foreachi({10, 20}, function(_, v) sum = sum + v end)
  assert(sum == 33)
  assert(math.pow(2, 10) == 1024 and math.mod(7, 3) == 1 and math.log10(1000) > 2.999)
  assert(math.abs(math.sinh(1) - 1.1752011936438) < 1e-12 and math.abs(math.cosh(1) - 1.5430806348152) < 1e-12)
  assert(math.abs(math.tanh(-1) + 0.76159415595576) < 1e-12 and math.ldexp(0.75, 3) == 6)
  local m, e = math.frexp(-6)
  assert(m == -0.75 and e == 3)
  assert(string.format('%d|%5.1f|%s|%u|%%|%03d|%x', 3.7, 2.25, 'x', 4.2, -2.5, 255.9) == '3|  2.2|x|4|%|-02|ff')
  assert(('%d'):format('8.9') == '8')
  math.randomseed(0.5)
  assert(math.random(2.5) <= 2 and math.random(3.5, 4.5) <= 4 and math.random() < 1)
  for word in string.gfind('a b', '%a') do sum = sum .. word end
  assert(sum == '33ab')
  require 'old'
  assert(old.twice(4) == 8 and twice == nil and old.pi == math.pi)
  table, string, math, io, type, error, pairs, ipairs, require, tonumber, setmetatable = gr.node('table') -- all are gone
  local s = gr.mesh('s', {{0, 0, 0}, {'1', 0, 0}, {0, 1, 0}}, {{0, 1, 2}})
  s:set_material(gr.material({1, 1, 1}, {0, 0, 0}, 0))
  table:add_child(s)
  table:rotate('y', 10)
  gr.render(table, 'old', 8, 8, {0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 50, {1, 1, 1}, {})
]], "-o none")
check(code == 0, "what Lua 5.0 to 5.3 had: %s", said)

-- ---- The generations ----

local generation = require "gr.generation"
local function says(text, meshes, words)
  local m, w = generation.of_text(text)
  check(m == meshes and w == words, "%s: meshes %s, words %s", text, m, w)
end
says("n:translate(unpack(p))", nil, 1)
says("n:translate( table.unpack(p) )", nil, 2)
says("local unpack = unpack or table.unpack", nil, nil)
says("local unpack = table.unpack or unpack\nn:translate(unpack(p))", nil, nil)
says("unpack = unpack or table.unpack; require 'cow'; n:translate(unpack(p))", nil, 1)
says("require('cow')", nil, 1)
says("require 'cow'", nil, 1)
says("local gr = require 'gr' require('other') glint = require \"glint\"", nil, nil)
says("-- require 'cow'\n--[[ unpack(p)\n ]] --[==[ x ]] unpack( ]==] print 'unpack(' print([[require]])", nil, nil)
says("x = 'it\\'s' .. \"-- \" require 'y'", nil, 1)
says("gr.mesh('a', { {0,0,0} }, { {0} })", 1, nil)
says("gr.mesh('a' .. f(1, {2}), 'a.obj') require 'x'", 2, 1)
says("gr.mesh( name, [[a.obj]])", 2, nil)
says("gr.mesh(name, verts, faces)", nil, nil)
says("gr.mesh('a', {}, {}) gr.mesh('b', 'b.obj')", nil, nil)
says("function unpack(t) end my.unpack(t) t:unpack(1) unrequire(x) x.require(y)", nil, nil)
says("n:rotate('x', 1)", nil, nil)

-- ---- CSG shapes ----

-- Returns the pixel values of a scene with `text` added. The shapes have flat faces or round sides, not spheres.
local function combined_codes(text)
  local output, status = scene([[
red = gr.material({0.8, 0.2, 0.1}, {0.4, 0.4, 0.4}, 20)
blue = gr.material({0.1, 0.2, 0.8}, {0.4, 0.4, 0.4}, 20)
local function dressed(shape, material) shape:set_material(material) return shape end
box = dressed(gr.nh_box('box', {-1, -1, -1}, 2), red)
far = dressed(gr.nh_box('far', {90, 0, 0}, 1), blue)
all = gr.nh_box('all', {-50, -50, -50}, 100)
post = dressed(gr.cylinder('post'), blue)
post:scale(0.5, 0.5, 3)
root = gr.node('root')
root:rotate('x', 25)
root:rotate('y', 30)
]] .. text .. [[

gr.render(root, 'combined.png', 64, 48, {0, 0, 8}, {0, 0, -1}, {0, 1, 0}, 50, {0.3, 0.3, 0.3}, {gr.light({5, 9, 9}, {0.9, 0.9, 0.9}, {1, 0, 0})})]])
  check(status == 0, "a scene of combined solids: %s", output)
  local _, _, codes = read_codes(folder .. "/combined.png")
  return codes
end

local both = combined_codes "root:add_child(box) root:add_child(post)"
-- Tests forms that set the operation and the parts later.
local function later(text) return "(function() local c = " .. text .. " return c end)()" end
for _, text in ipairs { "gr.union('u', box, post)", "gr.union(box, post)", "gr.csg_union('u', box, post)",
  "gr.csg('u', box, '+', post, 2)", "gr.csg(box, post, 'union')", later "gr.union('u') c:add_children(box, post)",
  later "gr.csg('u', 'union') c:add_child(box) c:add_child(post)",
  later "gr.csg('u') c:setCSGType('u') c:add_child(box) c:add_child(post)",
  later "gr.csg('u') c:set_csg_children(box, post, 'UNION')",
  later "gr.diff('u') c:add_child(post) c:set_csg_children(box, post, 'union')" } do
  check(combined_codes("root:add_child(" .. text .. ")") == both, "%s is both", text)
end
local alone = combined_codes "box:translate(0.5, 0, 0) root:add_child(box)"
for _, text in ipairs { "gr.difference('d', box, far)", "gr.csg('d', box, '-', far)", "gr.csg_difference('d', box, far, gr.node('none'))",
  "gr.difference(gr.intersection('i', box, dressed(all, blue)), far)", "gr.diff('d', gr.intersect(box, dressed(all, blue)), far)",
  "gr.subtraction('d', gr.conjunction('c', box, dressed(all, blue)), far)", "gr.csg(gr.csg(box, dressed(all, blue), 'intersection'), far, 'diff')",
  later "gr.csg('d') c:setCSGType('d') c:add_child(box) c:add_child(far)" } do
  check(combined_codes("a = " .. text .. " a:translate(0.5, 0, 0) root:add_child(a)") == alone, "%s is the box", text)
end
local crate = "crate = gr.mesh('crate', {{0,0,0}, {1,0,0}, {0,1,0}, {1,1,0}, {0,0,1}, {1,0,1}, {0,1,1}, {1,1,1}}, {{0,2,3,1}, {4,5,7,6}, " ..
  "{0,1,5,4}, {2,6,7,3}, {0,4,6,2}, {1,3,7,5}}) mark = dressed(gr.mesh('mark', {{0,0,900}, {1,0,900}, {0,1,900}}, {{0,1,2}}), red) " ..
  "root:add_child(mark) " -- the mesh is behind the eye; a mesh decides the order of transforms
local cut = combined_codes(crate .. "root:add_child(gr.difference('d', dressed(gr.nh_box('b', {0, 0, 0}, 1), red), post))")
check(combined_codes(crate .. "root:add_child(gr.difference('d', dressed(crate, red), post))") == cut, "a mesh is a part")
check(combined_codes(crate .. "d = gr.csg('d', crate, '-', post) d:set_material(red) root:add_child(d)") ~= "", "one without a material")
check(combined_codes "root:add_child(dressed(gr.nh_torus('t', {0.5, 0, 0}, 1, 0.25), red))" ==
  combined_codes "t = dressed(gr.torus('t', 0.25), red) t:translate(0.5, 0, 0) root:add_child(t)", "a torus with a place")
check(combined_codes "c = gr.union(box, post) c:add_child(far) root:add_child(c)" == both, "a child of a whole solid is beside it")
check(combined_codes "root:add_child(gr.difference('d', box, box))" == combined_codes "", "a box less itself is nothing")
check(combined_codes "n = gr.node('n') n:add_child(far) n:add_child(post) root:add_child(gr.difference('d', box, n))" ~= both,
  "a node takes away what is in it")
for text, message in pairs {
  ["d = gr.difference('d', box, gr.nh_box('bare', {0, 0, 0}, 1))"] = "nh_box 'bare' has no material",
  ["d = gr.union('d', box, dressed(gr.mesh('m', {{0,0,0}, {1,0,0}, {0,1,0}}, {{0,1,2}}), red))"] =
    "a closed mesh, got mesh 'm': its edge from {0, 0, 0} to {1, 0, 0} has 1 triangle",
  ["d = gr.union('d', box, post) post:add_child(d)"] = "contains itself",
  ["d = gr.csg('d') d:add_child(d)"] = "contains itself",
  ["d = gr.csg('d') d:add_child(box)"] = "gr.render: csg 'd' has no operation; setCSGType and set_csg_children give it one",
  ["d = gr.csg('d', 'diff') d:add_child(box)"] = "gr.render: csg 'd' has 1 of its two parts; add_child gives it more",
  ["d = gr.union('d')"] = "gr.render: union 'd' has 0 of its two parts; add_child gives it more",
} do
  local output = scene("red = gr.material({1, 0, 0}, {0, 0, 0}, 1) local function dressed(s, m) s:set_material(m) return s end"
    .. " box = dressed(gr.nh_box('box', {0, 0, 0}, 1), red) post = dressed(gr.cylinder('post'), red) " .. text
    .. " root = gr.node('r') root:add_child(d) gr.render(root, 'e', 8, 8, {0, 0, 8}, {0, 0, -1}, {0, 1, 0}, 50, {1, 1, 1}, {})")
  check(output:find(message, 1, true), "%s expected, got %s", message, output)
end

-- ---- Wrong input: the message names the function, the argument and the value, at the scene's line ----

local function refuses(text, message, options)
  local got, exit = scene("local gr, kd, ks = gr, {1, 1, 1}, {0, 0, 0}\n" .. text, options)
  check(exit == 2 and got:find("scene.lua:2: " .. message, 1, true), "%s: %s", text, got)
end
refuses("gr.hyperboloid('t', 1)", "gr.hyperboloid: this function is not part of the dialect")
refuses("gr.torus('t')", "gr.torus: tube: number expected, got nil")
refuses("gr.torus('t', 1)", "gr.torus: tube: number above 0 and below the ring's radius (1) expected, got 1")
refuses("gr.torus('t', 1.2, 0.5)", "gr.torus: tube: number above 0 and below the ring's radius (0.5) expected, got 1.2")
refuses("gr.torus('t', 1, -2)", "gr.torus: ring: number above 0 expected, got -2")
refuses("gr.union('u', gr.sphere('s'))", "gr.union: two nodes expected, got 1")
refuses("gr.difference('u', gr.sphere('s'), 3)", "gr.difference: part 2: node expected, got 3")
local words = '"+", "*", "-", "union", "intersection" or "difference" expected, got '
refuses("gr.csg('c', gr.sphere('s'), '/', gr.sphere('s'))", "gr.csg: operation: " .. words .. '"/"')
refuses("gr.csg('c', 'smooth')", "gr.csg: operation: " .. words .. '"smooth"')
refuses("gr.csg('c'):setCSGType(1)", "gr.setCSGType: operation: " .. words .. "1")
refuses("gr.node('c'):setCSGType('u')", "gr.setCSGType: self: combined solid expected, got node 'c'")
refuses("gr.csg('c'):set_csg_children(gr.sphere('s'), nil, 'UNION')", "gr.set_csg_children: part 2: node expected, got nil")
refuses("gr.csg('c'):add_children(gr.sphere('s'), 3)", "gr.add_children: child: node expected, got 3")
refuses("gr.nh_torus('t', {0, 0, 0}, 2)", "gr.nh_torus: tube: number expected, got nil")
refuses("gr.nh_torus('t', {0, 0}, 2, 1)", "gr.nh_torus: centre: table of 3 numbers expected, got table of 2")
refuses("gr.csg_merge('c', gr.sphere('s'), gr.sphere('s'))", "gr.csg_merge: this function is not part of the dialect")
refuses("gr.sphere('s'):set_ramp('x.png')", "gr.set_ramp: this function is not part of the dialect")
refuses("gr.material({1,1,1}, {0,0,0}, 1):set_glossiness(0, 1.5)",
  "material:set_glossiness: this method is not part of the dialect")
refuses("gr.light({1,1,1}, {1,1,1}):set_radius(2)", "light:set_radius: this method is not part of the dialect")
refuses("gr.sphere()", "gr.sphere: name: string expected, got nil")
refuses("gr.joint('j', {1, 2}, {0, 0, 0})", "gr.joint: x: table of 3 numbers expected, got table of 2")
refuses("gr.nh_sphere('s', {0, 0, 0})", "gr.nh_sphere: radius: number expected, got nil")
refuses("gr.nh_sphere('s', {0, 0, 'one'}, 1)", "gr.nh_sphere: centre[3]: number expected, got \"one\"")
refuses("gr.nh_box('s', {0, 0, 0, 0}, 1)", "gr.nh_box: corner: table of 3 numbers expected, got table of 4")
refuses("gr.nh_box('s', {0, 0, 0}, {0, 1, 0}, 2)", "gr.nh_box: edge: number expected, got table of 3")
refuses("gr.material({1, -1, 1}, ks, 1)", "gr.material: kd[2]: number >= 0 expected, got -1")
refuses("gr.material(kd, ks)", "gr.material: shininess: number expected, got nil")
refuses("gr.material(kd, ks, -1)", "gr.material: shininess: number >= 0 expected, got -1")
refuses("gr.material(kd, 1, 1)", "gr.material: ks: table expected, got 1")
refuses("gr.light(5, kd, kd)", "gr.light: {position}, {colour}, {fall-off} expected, got 5 first")
refuses("gr.light(kd, kd, kd, kd)", "gr.light: {position}, {colour}, {fall-off} expected, got table of 3 first and table of 3 fourth")
refuses("gr.light(kd, {1, 1}, kd)", "gr.light: colour: table of 3 numbers expected, got table of 2")
refuses("gr.light(kd, kd, {1, 0, -1})", "gr.light: fall-off[3]: number >= 0 expected, got -1")
refuses("gr.node('n'):set_material(gr.material(kd, ks, 1))",
  "gr.set_material: a shape expected, got the node 'n', which has no surface")
refuses("gr.sphere('n'):set_material(gr.light(kd, kd, kd))", "gr.set_material: material: material expected, got light")
refuses("gr.node('n'):add_child({})", "gr.add_child: child: node expected, got table of 0")
refuses("gr.add_child(5, gr.node('n'))", "gr.add_child: self: node expected, got 5")
refuses("gr.node('n'):rotate('w', 5)", "gr.rotate: axis: \"x\", \"y\" or \"z\" expected, got \"w\"")
refuses("gr.node('n'):rotate('x', 1/0)", "gr.rotate: degrees: finite number expected, got inf")
refuses("gr.node('n'):translate({1, 2, 3})", "gr.translate: x: number expected, got table of 3")
refuses("gr.node('n'):scale(1, 2)", "gr.scale: z: number expected, got nil")
refuses("gr.node('n'):scale(0/0, 2, 1)", "gr.scale: x: finite number expected, got nan")
refuses("gr.mesh('m')", "gr.mesh: vertices: table or name of an .obj file expected, got nil")
refuses("gr.mesh('m', {kd})", "gr.mesh: faces: table expected, got nil")
refuses("gr.mesh('m', {}, {})", "gr.mesh: vertices: 1 vertex or more expected, got table of 0")
refuses("gr.mesh('m', {kd, {1, 2}}, {{0, 1, 0}})", "gr.mesh: vertices[2]: table of 3 numbers expected, got table of 2")
refuses("gr.mesh('m', {kd}, {{0, 1, 0}})", "gr.mesh: faces[1][2]: vertex 0 .. 0 expected, got 1")
refuses("gr.mesh('m', {kd}, {{0, 0}})", "gr.mesh: faces[1]: table of 3 numbers or more expected, got table of 2")
local VIEW = "8, 6, {0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 50, {0, 0, 0}, {}"
refuses("gr.render('x', 'f', " .. VIEW .. ")", "gr.render: root: node expected, got \"x\"")
refuses("gr.render(gr.node('n'), '', " .. VIEW .. ")", "gr.render: file: name of a file expected, got \"\"")
for _, case in ipairs {
  { "0.5, 6, {0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 50, {0, 0, 0}, {}", "width: pixels 1 .. 65535 expected, got 0.5" },
  { "8, 1e9, {0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 50, {0, 0, 0}, {}", "height: pixels 1 .. 65535 expected, got 1000000000" },
  { "8, 6, gr.node('camera')", "eye: table expected, got node 'camera'" },
  { "8, 6, {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 50, {0, 0, 0}, {}", "view: a direction other than {0, 0, 0} expected" },
  { "8, 6, {0, 0, 5}, {0, 0, 1}, {0, 0, 0}, 50, {0, 0, 0}, {}", "up: a direction other than {0, 0, 0} expected" },
  { "8, 6, {0, 0, 5}, {0, 0, 1}, {0, 1, 0}, 180, {0, 0, 0}, {}", "fov: degrees between 0 and 180 expected, got 180" },
  { "8, 6, {0, 0, 5}, {0, 0, 1}, {0, 1, 0}, 50, {0, -1, 0}, {}", "ambient[2]: number >= 0 expected, got -1" },
  { "8, 6, {0, 0, 5}, {0, 0, 1}, {0, 1, 0}, 50, {0, 0, 0}", "lights: table expected, got nil" },
  { "8, 6, {0, 0, 5}, {0, 0, 1}, {0, 1, 0}, 50, {0, 0, 0}, {kd}", "lights[1]: light expected, got table of 3" },
} do
  refuses("gr.render(gr.node('n'), 'f', " .. case[1] .. ")", "gr.render: " .. case[2])
end
refuses("local n, s = gr.node('n'), gr.cube('bare') n:add_child(s) gr.render(n, 'f', " .. VIEW .. ")",
  "gr.render: cube 'bare' has no material; set_material gives it one")
refuses("local n, m = gr.node('n'), gr.node('m') n:add_child(m) m:add_child(n) gr.render(n, 'f', " .. VIEW .. ")",
  "gr.render: node 'n' contains itself")
refuses("local n = gr.sphere('n') n:set_material(gr.material(kd, ks, 1)) for i = 1, 40 do local m = gr.node('m') m:add_child(n) " ..
  "m:add_child(n) n = m end gr.render(n, 'f', " .. VIEW .. ")", "gr.render: at most 4194304 shapes expected, got 1099511627776")
refuses("local s = gr.sphere('s') s:set_material(gr.material(kd, ks, 1)) s:scale(1e200, 1, 1) s:scale(1e200, 1, 1) " ..
  "gr.render(s, 'f', " .. VIEW .. ")", "gr.render: sphere.transform: finite numbers expected, got inf")
for name, case in pairs {
  words = { "v 1 2 x\n", "line 1: three numbers expected, got '1 2 x'" },
  zero = { TRIANGLE .. "f 0 1 2\n", "line 5: numbers of vertices from 1 expected, got '0 1 2'" },
  many = { TRIANGLE .. "\nf 1 2 4\n", "line 6: vertex 1 .. 3 expected, got 4" },
  few = { TRIANGLE .. "f 1 2\n", "line 5: 3 vertices or more expected, got '1 2'" },
  none = { "v 1 2 3\n", "faces expected, got 1 vertices and none" },
} do
  write(name .. ".obj", case[1])
  local got, exit = scene(("gr.mesh('m', '%s.obj')"):format(name))
  check(exit == 2 and got:find("scene.lua:1: ", 1, true) and got:find(case[2], 1, true), "%s: %s", name, got)
end

-- Tests options of the module itself.
local gr = require "gr"
for name, wrong in pairs { order = "up", pixel = 0.3, specular = 1, background = "red", size = 4 } do
  local good, message = pcall(function() gr.options[name] = wrong end)
  check(not good and message:find "test_gr.lua:%d+: gr.options", "gr.options.%s: %s", name, message)
end
gr.options.background, gr.options.pixel = "#102030", "0"
check(gr.options.pixel == 0 and math.floor(255 * gr.options.background[1]) == 0x10, "gr.options are read back")
check(gr.missing and not rawget(gr, "missing") and gr.__gc == nil and gr[1] == nil, "names that are not there")

-- ---- Valid input at the limits of the rules ----

said, code = scene([[
  local m = gr.material({1, 1, 1}, {1, 1, 1}, 1e300)
  local bow = gr.mesh('crossed', {{-1,-1,0}, {1,1,0}, {1,-1,0}, {-1,1,0}, {0,3,0}}, {{0, 1, 2, 3}, {3, 1, 4}, {1, 1, 2}, {0, 1, 1, 0}})
  local none = gr.mesh(5, {{0, 0, 0}}, {{0, 0, 0}})
  local long = gr.cylinder(('n\n\xc3\xa9'):rep(50))
  for _, s in ipairs { bow, none, long } do s:set_material(m) end
  local deep = gr.node('0')
  local root = deep
  for i = 1, 20000 do local n = gr.node(i) deep:add_child(n) n:translate(1e-6, 0, 0) deep = n end
  deep:add_child(bow) deep:add_child(none) deep:add_child(long)
  local l = gr.light({0, 0, 5}, {1, 1, 1}, {0, 0, 0})
  for _, up in ipairs { {0, 1, 0}, {0, 0, 1} } do
    gr.render(root, 'f', 16, '16', {0, 0, 9}, {0, 0, -1e-9}, up, '50', {0, 0, 0}, {l, l, nil})
  end]], "--warnings=none -o edge.png")
check(code == 0, "edges of the rules: %s", said)
local _, _, codes = read_codes(folder .. "/edge_0001.png")
check(codes:byte(3 * (16 * 4 + 8) + 1) == 255, "a fall-off of 0 is as bright as can be")

-- ---- Large scenes ----

local start = os.time()
said, code = scene([[
  local verts, faces, n = {}, {}, 224
  for i = 0, n - 1 do for j = 0, n - 1 do verts[#verts + 1] = {i / n - 0.5, math.sin(i / 9) * math.cos(j / 7) / 9, j / n - 0.5} end end
  for i = 0, n - 2 do for j = 0, n - 2 do
    local k = i * n + j
    faces[#faces + 1] = {k, k + 1, k + n}
    faces[#faces + 1] = {k + 1, k + n + 1, k + n}
  end end
  local m = gr.material({0.7, 0.7, 0.7}, {0.3, 0.3, 0.3}, 20)
  local root, hill = gr.node('root'), gr.mesh('hill', verts, faces)
  hill:set_material(m)
  root:add_child(hill)
  for i = 1, 10000 do
    local s = gr.sphere('s' .. i)
    s:set_material(m)
    s:scale(0.002, 0.004, 0.002)
    s:translate(i % 100 / 100 - 0.5, 0.2, i // 100 / 100 - 0.5)
    root:add_child(s)
  end
  gr.render(root, 'large', 64, 64, {0, 2, 2}, {0, -1, -1}, {0, 1, 0}, 50, {0.1, 0.1, 0.1}, {gr.light({0, 9, 9}, {1, 1, 1}, {1, 0, 0})})
]], "-o none")
check(code == 0 and os.time() - start <= 15, "100,000 faces and 10,000 nodes in %d s: %s", os.time() - start, said)

tally.finish()
