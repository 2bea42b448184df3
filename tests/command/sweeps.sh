#!/usr/bin/env bash
# The order in which a sweep's frames are rendered: the cheapest axis changes most often. The order must not affect
# the numbers and bytes of files, the film, shards, or a second run.
. tests/command/prelude.sh
cd "$work" || exit 1

cat >S.lua <<'LUA'
local glint = require "glint"
local S = {}
S.red = glint.material { diffuse = { 0.8, 0.2, 0.2 }, specular = 0.7, shininess = 20, name = "red" }
S.lamp = glint.sphere_light { position = { 0, 9, 0 }, radius = 1, samples = 4, name = "lamp" }
S.camera = glint.camera { eye = { 0, 3, 10 }, at = { 0, 1, 0 }, fov = 40 }
S.scene = glint.scene { camera = S.camera, ambient = 0.1, S.lamp,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } },
  glint.sphere { center = { 0, 1, 0 }, radius = 1, material = S.red } }
return S
LUA
cat >grid.lua <<'LUA'
local glint, S = require "glint", require "S"
return glint.sweep { scene = S.scene, width = 48, height = 32, output = "grid/%02d.png", sheet = {}, over = {
  { S.camera, "fov", { 40, 50 } }, { S.lamp, "position", { { -3, 9, 1 }, { 0, 9, 1 }, { 3, 9, 1 } } },
  { S.red, "shininess", { 5, 50, 500, 5000 } } } }
LUA

# order ARGUMENTS...: prints the numbers of the frames in the order of completion
order() { "$GLINT" "$@" --json -q -t 1 2>err | sed -n 's/.*"event":"frame","index":\([0-9]*\),.*/\1/p' | tr '\n' ' '; }
same() { # NAME FOLDER: holds the pictures of the whole, and no others
    check "$1" diff -r plain "$2"
    rm -rf "$2"
}
mkdir plain
for n in $(seq 24); do "$GLINT" grid.lua -f "$n" --no-reuse -o 'plain/%02d.png' -q 2>err || fail "frame $n: $(cat err)"; done
rm -f plain/sheet.png

check "the cheapest axis changes most often, and each step is on one axis" test "$(order grid.lua --warnings none)" = \
    "1 7 13 19 21 15 9 3 5 11 17 23 24 18 12 6 4 10 16 22 20 14 8 2 "
check "the sheet is there" test -s grid/sheet.png
rm grid/sheet.png
check "a second run keeps them" test "$("$GLINT" grid.lua --json -q | grep -c '"event":"frame".*"status":"kept"')" -eq 24
cat >bare.lua <<'LUA'
local sweep = dofile "grid.lua"
for name in pairs(string) do string[name] = nil end
for name in pairs(table) do table[name] = nil end
ipairs, next, rawget, rawlen, tostring, type, math = nil
return sweep
LUA
"$GLINT" bare.lua -o 'bare/%02d.png' -q 2>err || fail "a script without Lua's functions: $(cat err)"
check "a script that removes Lua's functions gets the same sheet" cmp grid/sheet.png bare/sheet.png
rm -rf bare
rm grid/sheet.png
same "the pictures of single frames" grid
check "without reuse the order is the same" test "$(order grid.lua --no-reuse -f 1-12 -o 'none/%02d.png')" = "1 7 9 3 5 11 12 6 4 10 8 2 "
rm -r none
for shard in 2 3 1; do check "shard $shard of 3" "$GLINT" grid.lua --shard $shard/3 -o 'parts/%02d.png' -q; done
rm -f parts/sheet.png
same "shards have every frame once" parts
check "a shard is a block of the order" test "$(order grid.lua --shard 2/3 -o none)" = "5 11 17 23 24 18 12 6 "
check "two frames are rendered as numbered" test "$(order grid.lua -f 2,19 -o none)" = "2 19 "
mkfifo pipe
exec 3<>pipe
check "a pipe gets frames as numbered" test "$(order grid.lua -f 1-6 -o pipe)" = "1 2 3 4 5 6 "
exec 3>&-

check "a film has its frames as numbered" "$GLINT" grid.lua -o film.apng -q
"$GLINT" assemble 'plain/%02d.png' -o plain.apng -q 2>err
check "byte for byte" cmp film.apng plain.apng

"$GLINT" explain grid.lua >out
prints "explain says what an axis runs" 'lamp.position runs light, occlude, shade; red.shininess runs shade; '
prints "and the order" 'order: red.shininess, lamp.position, fov$'
"$GLINT" explain grid.lua --json >out
prints "for programs, too" '"sweep":\{"axes":\[\{"name":"fov","stages":"camera, cast, .*"order":\["red.shininess","lamp.position","fov"\]\}'

# Both axes of the material run `shade`. A highlight covers fewer pixels than a colour.
sed -e '/^  { S.camera/d' -e 's/{ S.red, "shininess".*/{ S.red, "diffuse", { 0.2, 0.8 } }, { S.red, "shininess", { 5, 50 } },/' \
    -e '$a{ S.lamp, "position", { { -3, 9, 1 }, { 3, 9, 1 } } } } }' grid.lua >paint.lua
check "highlights change more often than colours" test "$(order paint.lua -o none)" = "1 3 4 2 6 8 7 5 "

# An invalid value: the earlier frames are written, and the message names the frame's number.
sed 's/{ 5, 50, 500, 5000 }/{ 5, 50, -1 }/' grid.lua >wrong.lua
exits 2 "a wrong value" wrong.lua -o 'wrong/%02d.png' -q
says "is named with its frame" 'frame 13: .*shininess: number >= 0 expected, got -1'
check "what came before is there" test "$(ls wrong | wc -l)" -eq 12

# ---- --sweep: the script's runs advance together where that is cheaper ----

cat >film.lua <<'LUA'
local glint, S = require "glint", require "S"
local P = glint.params { shininess = 20, radius = { 3, min = 1, max = 9 }, frames = 3, broken = { 0, doc = "frame that fails" } }
S.red.shininess = P.shininess
local function film(output) return glint.animation { scene = S.scene, frames = P.frames, width = 48, height = 32, output = output,
  frame = function(t, n) S.lamp.position = { P.radius * t, 9, 1 }; if n == P.broken then S.lamp.intensity = -1 end end } end
if P.frames > 3 then return { film "a_%02d.png", film "b_%02d.png" } end
return film "film_%02d.png"
LUA
rm -rf plain
for n in $(seq 12); do
    "$GLINT" film.lua -f "$n" --sweep shininess=5,50,500,5000 --no-reuse -o 'plain/%02d.png' -q 2>err || fail "frame $n: $(cat err)"
done
sweep=(film.lua --sweep shininess=5,50,500,5000)
check "frame 1 of every value, then frame 2" test "$(order "${sweep[@]}" -o 'film/%02d.png')" = "1 4 7 10 11 8 5 2 3 6 9 12 "
same "the pictures of single frames" film
for shard in 3 1 2; do check "shard $shard of 3" "$GLINT" "${sweep[@]}" --shard $shard/3 -o 'parts/%02d.png' -q; done
same "shards have every frame once" parts
check "a second run keeps them" test "$("$GLINT" "${sweep[@]}" --json -q -o 'plain/%02d.png' | grep -c '"status":"kept"')" -eq 12
check "little memory has groups of values" test "$(order "${sweep[@]}" -o 'film/%02d.png' --reuse-memory 20M | wc -w)" -eq 12
same "with the same pictures" film
check "a swept place of the lamp waits for its frames" test "$(order film.lua --sweep radius=2,3,4 -o none)" = "1 2 3 4 5 6 7 8 9 "
check "two parameters" test "$(order film.lua --sweep shininess=5,50 --sweep radius=2,4 -f 1-11:2 -o none | wc -w)" -eq 6
check "two jobs in a list" test "$(order film.lua --set frames=4 --sweep shininess=5,50)" = "1 9 10 2 3 11 12 4 5 13 14 6 7 15 16 8 "

"$GLINT" explain film.lua --sweep shininess=5,50 --frame 5 >out 2>err
prints "explain plans a frame of the second value" '^film.lua, frame 5: '
prints "and shows what a value costs" 'axes: frame runs light, occlude, shade; shininess runs shade; order: shininess, frame$'
"$GLINT" explain film.lua --sweep shininess=5,50 --json >out
prints "for programs, too" '"name":"shininess","stages":"shade"\}\],"order":\["shininess","frame"\]'
"$GLINT" explain grid.lua --sweep unknown=1,2 >out 2>err && fail "an unknown parameter"
says "an unknown parameter" 'unknown'
"$GLINT" explain film.lua --sweep shininess=5,50 --frame 7 >out 2>err && fail "a frame after the last"
says "a frame after the last" 'expected a frame of the script, 1 .. 6, got .7.'
"$GLINT" explain film.lua --sweep shininess=5,-1 --frame 1 >out 2>err && fail "a wrong value"
says "a wrong value" '--sweep shininess=-1: .*number >= 0 expected'

# If the script fails for one value, only that value fails.
exits 2 "a wrong value" film.lua --sweep shininess=5,-1,50 -o 'some/%02d.png' -q
says "is named" '^glint: error: --sweep shininess=-1: .*shininess: number >= 0 expected, got -1'
check "the others are there" test "$(ls some | tr '\n' ' ')" = "01.png 02.png 03.png 07.png 08.png 09.png "
rm -r some
exits 2 "the first value" film.lua --sweep shininess=-1,5 -o 'some/%02d.png' -q
check "also fails alone" test "$(ls some | tr '\n' ' ')" = "04.png 05.png 06.png "
rm -r some
exits 2 "a frame of one value" film.lua --sweep broken=0,2,3 -o 'some/%02d.png' -q
check "ends that value" test "$(ls some | tr '\n' ' ')" = "01.png 02.png 03.png 04.png 07.png 08.png "
says "with its message" '--sweep broken=2: frame 5: .*intensity'
rm -r some
echo 'local = 3' >syntax.lua
exits 2 "a script that fails at every value" syntax.lua --sweep n=1:100:100 -q
check "says so once" test "$(wc -l <err)" -eq 1

# ---- A list of animations of one scene: frame 1 of each, then frame 2, where that is cheaper ----

cat >list.lua <<'LUA'
local glint, S = require "glint", require "S"
local P = glint.params { broken = 0, frames = 3 }
local list = {}
for i, shininess in ipairs { 5, 50, 500 } do
  list[i] = glint.animation { scene = S.scene, frames = i < 3 and 3 or P.frames, width = 48, height = 32, frame = function(t, n)
    if i == 1 then S.lamp.intensity = 1 - n / 9 end -- the last frame's value is that of all later animations
    S.lamp.position, S.red.shininess = { 3 * t, 9, 1 }, shininess
    if 3 * i - 3 + n == P.broken then error "broken" end
  end }
end
return list
LUA
rm -rf plain
for n in $(seq 9); do "$GLINT" list.lua -f "$n" --no-reuse -o 'plain/%02d.png' -q 2>err || fail "frame $n: $(cat err)"; done
check "frame 1 of each animation, then frame 2" test "$(order list.lua -o 'list/%02d.png')" = "1 4 7 2 5 8 3 6 9 "
same "the pictures of single frames" list
for shard in 3 1 2; do check "shard $shard of 3" "$GLINT" list.lua --shard $shard/3 -o 'parts/%02d.png' -q; done
same "shards have every frame once" parts
check "a second run keeps them" test "$("$GLINT" list.lua --json -q -o 'plain/%02d.png' | grep -c '"status":"kept"')" -eq 9
exec 3<>pipe
check "a pipe gets frames as numbered" test "$(order list.lua -o pipe)" = "1 2 3 4 5 6 7 8 9 "
exec 3>&-
check "little memory" "$GLINT" list.lua -o 'list/%02d.png' --reuse-memory 1K -q
same "has the same pictures" list
check "animations of different lengths" test "$(order list.lua --set frames=2 -o none)" = "1 4 2 5 3 6 7 8 "
exits 2 "a frame that fails" list.lua --set broken=6 -o 'some/%02d.png' -q
says "is named" 'frame 6: .*broken'
check "the frames before it are there" test "$(ls some | tr '\n' ' ')" = "01.png 02.png 03.png 04.png 05.png "

# ---- Random sweeps over three axes, in lists, in shards, and resumed after a kill, give the same as without reuse ----

cat >random.lua <<'LUA'
local glint, S = require "glint", require "S"
local P = glint.params { seed = 1, strength = 1 }
local state = P.seed * 7919 + 13
local function draw(n) state = state * 48271 % 0x7fffffff; return state % n end
for i = 1, 150 * draw(3) do S.scene:add(glint.sphere { center = { i * 0.02 - 2, 0.1, draw(9) * 0.3 - 1 }, radius = 0.05, material = S.red }) end
local AXES = {
  { S.lamp, "position", { { -3, 9, 1 }, { 0, 9, 1 }, { 3, 9, 1 } } }, { S.red, "shininess", { 5, 50 } }, { S.camera, "fov", { 40, 50 } },
  { S.red, "diffuse", { { 0.2, 0.8, 0.2 }, { 0.8, 0.2, 0.2 } } }, { S.red, "mirror", { 0, 0.3 } }, { S.scene, "ambient", { 0, 0.2 } } }
local function sweep(name)
  local over = {}
  for i = 1, 3 do over[i] = table.remove(AXES, draw(#AXES) + 1) end
  for i = 1, 3 do AXES[#AXES + 1] = over[i] end
  return glint.sweep { scene = S.scene, width = 48, height = 32, over = over }
end
S.lamp.intensity = P.strength
local function film(shininess)
  return glint.animation { scene = S.scene, width = 48, height = 32, frames = 6, cyclic = true, frame = function(t, n)
    if shininess == 5 then S.camera.fov = 40 + n % 2 end
    S.red.shininess = n % 2 + shininess
    S.lamp.x = n % 3
  end }
end
return { sweep(), film(5), film(50), film(500), sweep() }
LUA
for seed in 1 2 3; do
    random=(random.lua --set "seed=$seed" --sweep strength=1,0.5 -q)
    rm -rf fresh
    check "seed $seed" "$GLINT" "${random[@]}" --no-reuse -o 'fresh/%03d.png'
    for memory in 1G 300K; do
        check "seed $seed with $memory" "$GLINT" "${random[@]}" --reuse-memory "$memory" -o 'reused/%03d.png'
        check "is the same" diff -r fresh reused
        rm -rf reused
    done
    for shard in 2 3 1; do check "seed $seed, shard $shard of 3" "$GLINT" "${random[@]}" --shard $shard/3 -o 'reused/%03d.png'; done
    check "is the same" diff -r fresh reused
    rm -rf reused
    "$GLINT" "${random[@]}" -t 1 -o 'reused/%03d.png' 2>/dev/null &
    killed=$!
    for _ in $(seq 500); do [ -e reused/001.png ] && break || sleep 0.01; done
    kill -9 $killed
    wait $killed 2>/dev/null
    check "seed $seed, resumed after a kill" "$GLINT" "${random[@]}" -o 'reused/%03d.png'
    check "is the same" diff -r fresh reused
    rm -rf reused
done
totals
