#!/usr/bin/env bash
# The order in which the frames of a sweep are rendered: the cheapest axis changes most often, and nothing but the order of
# completion depends on it: not the numbers and bytes of files, not the film, not what shards and a second run do.
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

# order ARGUMENTS...: the numbers of the frames, as they are completed
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

# A value that cannot be: the frames before it are there, and the message has its number.
sed 's/{ 5, 50, 500, 5000 }/{ 5, 50, -1 }/' grid.lua >wrong.lua
exits 2 "a wrong value" wrong.lua -o 'wrong/%02d.png' -q
says "is named with its frame" 'frame 13: .*shininess: number >= 0 expected, got -1'
check "what came before is there" test "$(ls wrong | wc -l)" -eq 12
totals
