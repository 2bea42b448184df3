#!/usr/bin/env bash
# Clipped values are reported. --exposure auto and --colormap MAP:auto look at all pictures first, and every part of a
# job determines the same values.
. tests/command/prelude.sh
cd "$work" || exit 1
data=(--bits 16 --transfer linear)

# Frames of one colour: their light is 0.5, 1, 4 and 2.
cat >film.lua <<'E2'
local glint = require "glint"
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } } }
return glint.animation { scene = scene, frames = 4, width = 8, height = 6,
  frame = function(_, n) scene.background = ({ 0.5, 1, 4, 2 })[n] end }
E2
sed -e 's/^return.*/for n, light in ipairs { 0.5, 1, 4, 2 } do/' -e 's/^  frame = .*/  scene.background = light\
  scene:render { width = 8, height = 6, output = ("film_%04d.png"):format(n) } end\
scene.background = 9\
scene:render { width = 8, height = 6 } -- which is not written\
print "done"\
os.exit(true, true)/' film.lua >loop.lua
cat >light.lua <<'E2'
local glint = require "glint"
for _, path in ipairs(arg) do io.write((" %.4f"):format((glint.read_image(path):pixel(3, 3)))) end
os.exit(true)
E2
light() { "$glint" light.lua -q -- "$@" 2>&1; }
# lights NAME WANT FILE...
lights() {
    local name=$1 want=$2 got
    shift 2
    got=$(light "$@")
    if [ "$got" = "$want" ]; then pass; else fail "$name: light$got, not$want"; fi
}

# ---- Clipped values are reported ----

exits 0 "clipped" film.lua "${data[@]}" -q
says "clipped" '^glint: warning: 50 % of the 16-bit linear values are clipped at 65535: the brightest would be 4 times white; use --exposure -2.00 to keep all values, or --exposure auto '
[ "$(wc -l <err)" -eq 1 ]
result $? "one warning"
exits 0 "exposed" film.lua "${data[@]}" -q --exposure -2 --force
[ ! -s err ]
result $? "nothing is clipped then"
exits 0 "for the eye" film.lua -q --force --exposure -1
[ ! -s err ] || ! grep -q '16-bit' err
result $? "8 bits are for the eye"
exits 2 "an error on request" film.lua "${data[@]}" -q --force --warnings=error
cat >save.lua <<'E2'
local glint = require "glint"
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, background = 2 }
scene:render { width = 8, height = 6 }:save("saved.png", { bits = 16, transfer = "linear" })
E2
exits 0 "saved by the script" save.lua -q
says "saved by the script" '100 % of the 16-bit linear values .* 2 times white; use --exposure -1.00'

# ---- One exposure for all ----

rm -f film_*.png
exits 0 "auto" film.lua "${data[@]}" --exposure auto
says "auto" '^exposure -2.00: the brightest value of 4 pictures is 4$'
if grep -q warning err; then fail "auto warns: $(cat err)"; else pass; fi
lights "auto" " 0.1250 0.2500 1.0000 0.5000" film_000{1,2,3,4}.png
mkdir whole && mv film_*.png whole
for part in 1/2 2/2; do
    exits 0 "part $part" film.lua "${data[@]}" --exposure auto --shard "$part"
    says "part $part" '^exposure -2.00: the brightest value of 4 pictures is 4$'
done
for n in 1 2 3 4; do check "the parts' frame $n" cmp "whole/film_000$n.png" "film_000$n.png"; done
exits 0 "again" film.lua "${data[@]}" --exposure auto -f 2-4
says "again" '3 kept$'
rm -f film_*.png
exits 0 "by number" film.lua "${data[@]}" --exposure -2 -q
for n in 1 2 3 4; do check "by number, frame $n" cmp "whole/film_000$n.png" "film_000$n.png"; done

rm -f film_*.png
exits 0 "calls" loop.lua "${data[@]}" --exposure auto
says "calls" '^exposure -2.00: the brightest value of 4 pictures is 4$'
prints "what is printed" '^done$'
[ "$(wc -l <out)" -eq 1 ]
result $? "printed once"
lights "calls" " 0.1250 0.2500 1.0000 0.5000" film_000{1,2,3,4}.png
exits 0 "events" film.lua "${data[@]}" --exposure auto --json -o none
prints "events" '^\{"event":"exposure","stops":-2.00,"brightest":4,"frames":4\}$'
exits 0 "a region" film.lua "${data[@]}" --exposure auto --region 1,1,2,2 -f 1 -o part.png
says "a region" '^exposure -2.00: '
sed -i 's/{ 0.5, 1, 4, 2 }/{ 0.05, 0.1, 0.2, 0.25 }/' film.lua
exits 0 "dark" film.lua "${data[@]}" --exposure auto -o dark.png
says "dark" '^exposure 2.00: '
exits 2 "standard input" - --exposure auto
exits 2 "explain" explain film.lua --exposure auto
says "explain" '--exposure: auto works only with glint render'
exits 2 "no number" film.lua --exposure bright
says "no number" '--exposure: number -32 .. 32 or auto expected'
cat >swept.lua <<'E2'
local glint = require "glint"
local P = glint.params { light = { 1, min = 0, max = 9 } }
return glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, background = P.light }
E2
exits 0 "a sweep" swept.lua "${data[@]}" --sweep light=1,8,2 --exposure auto --size 8x6
says "a sweep" '^exposure -3.00: the brightest value of 3 pictures is 8$'
lights "a sweep" " 0.1250 1.0000 0.2500" swept_000{1,2,3}.png
printf '%s\n' 'error "no"' >bad.lua
exits 2 "an error" bad.lua --exposure auto
[ "$(grep -c 'bad.lua:1: no' err)" -eq 1 ]
result $? "an error once"

# ---- Photometric sets ----

set=("$root/scripts/photometric.lua" --set layout=diligent --set objects=sphere --set materials=gold --set lights=3 --size 32x32 -q)
exits 0 "gold" "${set[@]}" --set folder=plain
says "gold" '16-bit linear values are clipped'
exits 0 "exposed gold" "${set[@]}" --set folder=auto --exposure auto
[ ! -s err ]
result $? "nothing of the set is clipped: $(cat err)"
cat >follow.lua <<'E2'
local glint = require "glint"
local times = tonumber(io.open "auto/sphere_gold/light_intensities.txt":read "n")
assert(times < 1 and math.abs(math.log(times, 2) * 100 - math.floor(math.log(times, 2) * 100 + 0.5)) < 1e-9, "hundredths of a stop")
for k = 1, 3 do
  local one = glint.read_image(("plain/sphere_gold/%03d.png"):format(k))
  local two = glint.read_image(("auto/sphere_gold/%03d.png"):format(k))
  for y = 0, 31 do for x = 0, 31 do
    local a, b = one:pixel(x, y), two:pixel(x, y)
    assert(a >= 1 or math.abs(a * times - b) < 1.6e-5, ("%g and %g"):format(a, b))
  end end
end
os.exit(true)
E2
exits 0 "intensities follow" follow.lua -q
# An exposure for each object's folder: the brightest value of each is just below white.
two=("$root/scripts/photometric.lua" --set layout=diligent --set objects=sphere --set materials=matt,gold --set lights=3 --size 32x32)
exits 0 "two objects" "${two[@]}" --set folder=two --exposure auto
says "two objects: gold" '^exposure -[0-9.]+ in two/sphere_gold/: the brightest value of 3 pictures is '
says "two objects: matt" '^exposure 0\.[0-9]+ in two/sphere_matt/: the brightest value of 3 pictures is '
cat >each.lua <<'E2'
local glint = require "glint"
for _, name in ipairs { "matt", "gold" } do
  local times, most = tonumber(io.open(("two/sphere_%s/light_intensities.txt"):format(name)):read "n"), 0
  for k = 1, 3 do
    local image = glint.read_image(("two/sphere_%s/%03d.png"):format(name, k))
    for y = 0, 31 do for x = 0, 31 do most = math.max(most, image:pixel(x, y)) end end
  end
  assert(most <= 1 and most > 2 ^ -0.02, ("%s: %g"):format(name, most))
  assert((times > 1) == (name == "matt"), name)
  for line in io.lines(("two/sphere_%s/light_intensities.txt"):format(name)) do assert(tonumber(line:match "^%S+") == times) end
end
os.exit(true)
E2
exits 0 "each folder has its exposure" each.lua -q
mv two all
for part in 1/3 2/3 3/3; do exits 0 "two objects, part $part" "${two[@]}" --set folder=two --exposure auto -q --shard "$part"; done
for file in matt/001.png gold/003.png gold/light_intensities.txt matt/light_intensities.txt; do
    check "the parts' $file" cmp "all/sphere_$file" "two/sphere_$file"
done
exits 0 "two objects again" "${two[@]}" --set folder=two --exposure auto
says "two objects again" '6 kept$'
exits 0 "one exposure on request" "${two[@]}" --set folder=one --exposure -3 -q
grep -q '^0.125 0.125 0.125$' one/sphere_matt/light_intensities.txt
result $? "one exposure for all: $(head -n 1 one/sphere_matt/light_intensities.txt)"
exits 0 "the other layout" "$root/scripts/photometric.lua" --set lights=2 --size 16x16 -q --exposure -1
grep -q ',0\.5$' photometric/lights.csv
result $? "lights.csv: $(cat photometric/lights.csv)"

# ---- One range of colours ----

cat >depth.lua <<'E2'
local glint = require "glint"
local P = glint.params { far = { 0 } }
local wall = glint.plane { point = { 0, 0, 0 }, normal = { 0, 0, 1 } }
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 10 }, at = { 0, 0, 0 }, projection = "orthographic", height = 4 },
  ambient = 1, wall, glint.directional_light { direction = { 0, 0, -1 }, intensity = 1 + P.far } }
return glint.animation { scene = scene, frames = 3, width = 4, height = 4, passes = "depth",
  frame = function(_, n) wall.point = { 0, 0, 10 - ({ 2, 4, 10 })[n] } end }
E2
exits 0 "a range" depth.lua -q --colormap none:0:10
lights "a range" " 0.2000 0.4000 1.0000" depth_000{1,2,3}.depth.png
exits 0 "a range of all" depth.lua --colormap none:auto
says "a range of all" '^colours from 2 to 10$'
lights "a range of all" " 0.0000 0.2510 1.0000" depth_000{1,2,3}.depth.png
cp depth_0002.depth.png two.png
exits 0 "a part" depth.lua -q --colormap none:auto --force -f 2
check "a part has the same range" cmp two.png depth_0002.depth.png
exits 2 "no range" depth.lua --colormap viridis:3
says "no range" '--colormap: NAME:LOW:HIGH with two numbers that differ expected'
exits 2 "two passes" depth.lua --colormap viridis:auto --passes depth,d:far
says "two passes" 'auto works for exactly one of the passes depth and d:NAME, got 2'

totals
