#!/usr/bin/env bash
# --until and --seconds: the picture is the picture of --samples n, byte for byte, and its true error is at most 1.25
# times the error that glint states, whatever the seed.
. tests/command/prelude.sh
cd "$work" || exit 1

cat >scene.lua <<'E2'
local glint = require "glint"
local P = glint.params { what = { "soft", choices = { "soft", "indirect", "checks", "lens", "sharp", "flat" } } }
local lights = {
  soft = glint.sphere_light { position = { 3, 5, 4 }, radius = 1, samples = 4 },
  indirect = glint.disk_light { position = { 3, 5, 4 }, normal = { -3, -5, -4 }, radius = 1, samples = 4 },
}
local floor = glint.material { diffuse = P.what ~= "checks" and 0.8 or glint.pattern(function(p)
  return glint.select(glint.less((glint.floor(p.x) + glint.floor(p.z)) % 2, 0.5), 0.9, 0.1) end) }
local light = lights[P.what] or glint.point_light { position = { 3, 5, 4 } }
local camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 0.8, 0 }, fov = 40, aperture = P.what == "lens" and 0.2 or 0 }
local scene = glint.scene { camera = camera, ambient = 0.1, background = 0.3, light }
if P.what ~= "flat" then
  scene:add(glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = floor })
  scene:add(glint.box { min = { -2, 0, -1 }, max = { -0.7, 1.5, 0.3 } })
  scene:add(glint.sphere { center = { 0.8, 0.8, 0 }, radius = 0.8 })
end
if P.what == "indirect" then scene.indirect = { samples = 4, bounces = 2 } end
return glint.animation { scene = scene, frames = 2, width = 60, height = 40, samples = 3,
  frame = function(t) light.position = { 3 - t, 5, 4 } end }
E2

# number FIELD: of the last frame event
number() { sed -n "s/.*\"event\":\"frame\".*\"$1\":\([0-9.e-]*\).*/\1/p" out | tail -n 1; }

# ---- The picture ----

for until in 0.02 0.006; do
    exits 0 "until $until" scene.lua -f 1-2 --until $until --json -o 'a_%d.png' --passes depth,diffuse
    n=$(number samples)
    ! grep -q "another run" err
    result $? "until $until: no warning about its own steps"
    check "until $until: the error is below it" awk -v e="$(number error)" "BEGIN { exit !(e > 0 && e <= $until) }"
    exits 0 "samples $n" scene.lua -f 2 --samples "$n" -o 'b_%d.png' --passes depth,diffuse -q
    for pass in '' .depth .diffuse; do check "until $until: samples $n$pass" cmp a_2$pass.png b_2$pass.png; done
done
check "more samples for a smaller error" test "$n" -gt 2
exits 0 "an exr" scene.lua -f 2 --until 0.006 -o 'a_%d.exr' --passes normal -q
exits 0 "its samples" scene.lua -f 2 --samples "$n" -o 'b_%d.exr' --passes normal -q
check "an exr has the same bytes" cmp a_2.exr b_2.exr
exits 0 "reproduce" reproduce a_2.png scene.lua
exits 0 "a part" scene.lua -f 2 --until 0.006 --region 20,10,30,20 --json -o 'part_%d.png'
n=$(number samples)
exits 0 "the part's samples" scene.lua -f 2 --samples "$n" --region 20,10,30,20 -q -o 'whole_%d.png'
check "a part has the same bytes" cmp part_2.png whole_2.png
exits 0 "a film" scene.lua --until 0.02 --json -o film.apng
check "each frame of a film has its samples" test "$(grep -c '"samples":[0-9]*,"error":0.0' out)" -eq 2

cat >loop.lua <<'E2'
local glint = require "glint"
local ball = glint.sphere { center = { 0, 0, 0 }, radius = 1 }
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, ambient = 0.1, ball,
  glint.point_light { position = { 5, 5, 5 } } }
for i = 1, 2 do
  ball.radius = i
  print((scene:render { width = 30, height = 20, output = ("loop_%d.png"):format(i) }:pixel(10, 10)))
end
E2
exits 0 "a loop of calls" loop.lua --until 0.01 -q
mv out light
mkdir until && mv loop_?.png until
exits 0 "the loop's samples" loop.lua -q --samples "$(sed -n 's/^samples=//p' <(strings until/loop_1.png) | head -n 1)"
check "a call has the bytes of its samples" cmp until/loop_1.png loop_1.png
check "the script sees the same picture" cmp <(head -n 1 light) <(head -n 1 out)
exits 0 "a loop with numbered names" loop.lua --until 0.01 -o named.png --json
check "both calls have a name" test -e named_0001.png -a -e named_0002.png
exits 0 "a shutter" "$root/scripts/shutter.lua" -f 2 --size 60x40 --until 0.02 --json -o 'open_%d.png'
n=$(number samples)
exits 0 "a shutter's samples" "$root/scripts/shutter.lua" -f 2 --size 60x40 --samples "$n" -q -o 'shut_%d.png'
check "a shutter's picture" cmp open_2.png shut_2.png
exits 0 "a sweep" scene.lua --sweep what=soft,flat -f 1,3 --until 0.02 --json -o 'sweep_%d.png'
check "a picture without noise has the least samples" test "$(number samples)" -eq 2

# ---- The error ----

cat >rmse.lua <<'E2' # the root of the mean squared difference between a file and the mean of other files
local glint = require "glint"
local seen = os.getenv "SEEN" -- as people see the picture: Reinhard's curve at half the light, in sRGB
local function code(light)
  local x = light / 2 / (1 + light / 2)
  return x <= 0.0031308 and 12.92 * x or 1.055 * x ^ (1 / 2.4) - 0.055
end
local function read(path, as_is)
  local floats, values = glint.read_image(path), {}
  for y = 0, floats.height - 1 do for x = 0, floats.width - 1 do
    for _, v in ipairs { floats:pixel(x, y) } do values[#values + 1] = (seen and not as_is) and code(v) or v end
  end end
  return values
end
local picture, sum, references = read(arg[1]), 0, {}
for i = 2, #arg do references[i - 1] = read(arg[i], true) end
for k = 1, #picture do
  local mean = 0
  for _, reference in ipairs(references) do mean = mean + reference[k] / #references end
  if seen then mean = code(mean) end
  sum = sum + (picture[k] - mean) ^ 2
end
print(("%.7f"):format((sum / #picture) ^ 0.5))
os.exit(true)
E2
quotients=()
for what in soft indirect checks lens sharp; do
    for seed in 5 6 7; do
        exits 0 "$what: reference" scene.lua -f 2 --set what=$what --samples 512 --seed $((seed * 1000)) -q -o "ref_${seed}_%d.pfm"
    done
    for most in 2 4 8 16 32; do
        exits 0 "$what $most" scene.lua -f 2 --set what=$what --until-light 1e-9 --samples $most --seed $((most / 8)) --json -o 'p_%d.pfm'
        says "$what $most" "frame 2: --until-light: the error is [0-9.]*, above 1e-09, after $most samples, the most; use more --samples"
        stated=$(number error)
        true=$("$glint" rmse.lua -q -- p_2.pfm ref_{5,6,7}_2.pfm)
        check "$what, $most samples: the error is $true, glint says $stated" \
            awk -v s="$stated" -v t="$true" 'BEGIN { exit !(t < 1.25 * s) }'
        quotients+=("$(awk -v s="$stated" -v t="$true" 'BEGIN { printf "%.4f\n", s / t }')")
    done
done
for seed in 5 6 7; do
    exits 0 "seen: reference" scene.lua -f 2 --set what=indirect --samples 512 --seed $((seed * 1000)) -q -o "ref_${seed}_%d.pfm"
done
for most in 4 16; do
    exits 0 "seen $most" scene.lua -f 2 --set what=indirect --until 1e-9 --samples $most --tone reinhard --exposure -1 --json -o 'p_%d.pfm'
    stated=$(number error)
    true=$(SEEN=1 "$glint" rmse.lua -q -- p_2.pfm ref_{5,6,7}_2.pfm)
    check "$most samples: as seen, the error is $true, glint says $stated" \
        awk -v s="$stated" -v t="$true" 'BEGIN { exit !(t < 1.25 * s && t > 0.7 * s) }'
done
median=$(printf '%s\n' "${quotients[@]}" | sort -n | sed -n 13p)
check "the median of stated and true error is $median" awk -v q="$median" 'BEGIN { exit !(q > 0.8 && q < 1.2) }'
! grep -q 'not to be trusted' err
result $? "a picture with many edges is trusted"

# A small bright source that few paths find.
cat >rare.lua <<'E2'
local glint = require "glint"
return glint.animation { scene = glint.scene { camera = glint.camera { eye = { 0, 2, 7 }, at = { 0, 1, 0 } }, background = 0.01, ambient = 1,
  indirect = { samples = 1, bounces = 3 }, glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } },
  glint.sphere { center = { 1, 4, 1 }, radius = 0.1, material = glint.material { diffuse = 0, ambient = 300 } },
  glint.sphere { center = { 0, 1, 0 }, radius = 1, material = glint.material { ambient = 0 } } },
  frames = 1, width = 60, height = 40, frame = function() end }
E2
for seed in 1 2 3; do
    exits 0 "rare light, seed $seed" rare.lua --until-light 1e-9 --samples 4 --seed $seed -q -o rare.pfm
    says "rare light, seed $seed" 'frame 1: the estimated error, [0-9.]*, is not to be trusted: most of it is in [0-9] pixel.*, and the last doubling of the samples moved it from [0-9.]*; rare bright paths may be missing'
done

# ---- Time ----

began=$(date +%s%N)
exits 0 "seconds" scene.lua -f 2 --set what=indirect --size 120x80 --seconds 5 --json -o 'time_%d.png'
ms=$((($(date +%s%N) - began) / 1000000)) n=$(number samples)
check "more samples than the first picture has" test "$n" -ge 4
check "no step is begun that cannot end in time: $ms ms" test "$ms" -lt 20000 # the machine may be busy
exits 0 "the samples of the time" scene.lua -f 2 --set what=indirect --size 120x80 --samples "$n" -q -o 'n_%d.png'
check "the picture of the time has the bytes of its samples" cmp time_2.png n_2.png
exits 0 "a time for a picture without noise" scene.lua -f 2 --set what=flat --seconds 100 --json -o 'flat_%d.png'
check "a picture without noise takes no more samples" test "$(number samples)" -eq 2
exits 0 "an error and a time" scene.lua -f 2 --until 1e-9 --seconds 0.05 -o 'both_%d.png'
says "an error and a time" 'frame 2: --until: the error is .* after [0-9]* samples, the most in 0.05 seconds'
says "the line of a frame" '^frame 2: both_2.png, .* ms, [0-9]* samples, error 0\.[0-9]*$'

exits 0 "noise in pixels with one sample" scene.lua -f 2 --until 1e-9 --adaptive 3 --json -o 'stuck_%d.png'
says "noise in pixels with one sample" 'after 16 samples, and more samples do not reduce it; use a smaller --adaptive'

# ---- Unfinished pictures ----

# stopped NAME SIGNAL: runs the frame until it has left a picture, and stops it.
stopped() {
    rm -f "$1"_*
    "$glint" scene.lua -f 2 --set what=indirect --size 160x100 --until 1e-9 -o "$1_%d.$3" 2>err &
    pid=$!
    for _ in $(seq 600); do
        grep -q 'step 3' err && break
        sleep 0.1
    done
    kill "-$2" $pid
    wait $pid 2>/dev/null
}

for signal in TERM INT KILL; do
    stopped int $signal png
    code=$?
    check "$signal: exit $code" test "$code" -eq $((128 + $(kill -l $signal)))
    [ $signal = KILL ] || says "$signal" 'warning: frame 2: int_2.png has the picture of [0-9]* samples, error 0.[0-9]*; the same command goes on from there'
    check "$signal: the key says that the picture is not finished" grep -aq 'glint:key.[0-9a-f]\{32\}-unfinished' int_2.png
    had=$(strings int_2.png | sed -n 's/^samples=//p')
    exits 0 "$signal: the samples of the file" scene.lua -f 2 --set what=indirect --size 160x100 --samples "$had" -q -o 'plain_%d.png'
    ! cmp -s plain_2.png int_2.png
    result $? "$signal: the files differ by their text"
    exits 0 "$signal: the pixels" compare plain_2.png int_2.png
    cp int_2.png left_2.png
    exits 0 "$signal: goes on" scene.lua -f 2 --set what=indirect --size 160x100 --until 1e-9 --samples $((2 * had)) --json -o 'int_%d.png'
    check "$signal: goes on with twice the samples" test "$(grep -c '"event":"step"' out)" -eq 1 -a "$(number samples)" -eq $((2 * had))
    exits 0 "$signal: as if it had not been stopped" scene.lua -f 2 --set what=indirect --size 160x100 --samples $((2 * had)) -q -o 'plain_%d.png'
    check "$signal: the same bytes" cmp plain_2.png int_2.png
done
cp left_2.png int_2.png
exits 0 "another scene" scene.lua -f 2 --set what=soft --size 160x100 --until 0.05 --json -o 'int_%d.png'
check "another scene begins anew" test "$(number samples)" -eq 2
cp left_2.png int_2.png
exits 0 "--force" scene.lua -f 2 --set what=indirect --size 160x100 --until 0.9 --force --json -o 'int_%d.png'
check "--force begins anew" test "$(number samples)" -eq 2
exits 0 "a finished picture" scene.lua -f 2 --set what=indirect --size 160x100 --samples 8 -q -o 'done_%d.png'
cp done_2.png before.png
"$glint" scene.lua -f 2 --set what=indirect --size 160x100 --until 1e-9 -o 'done_%d.png' 2>err &
pid=$!
sleep 1
kill -TERM $pid
wait $pid 2>/dev/null
check "a finished picture is not replaced by an unfinished one" cmp done_2.png before.png
stopped lin TERM pfm
says "a format without a key" 'lin_2.pfm has the picture of [0-9]* samples, error 0.[0-9]*$'
check "it has the picture" test -s lin_2.pfm
exits 0 "a limit of time" scene.lua -f 2 --set what=indirect --until 1e-9 --seconds 0.05 --json -o 'limit_%d.png'
had=$(number samples)
exits 0 "a limit of time" scene.lua -f 2 --set what=indirect --until 1e-9 --seconds 0.05 --json -o 'limit_%d.png'
check "the next run goes on" test "$(number samples)" -gt "$had"

exits 0 "plain lines" scene.lua -f 2 --until 0.02 -o 'a_%d.png'
says "plain lines" '^frame 2: step 1, 2 samples, [0-9.]* s, error 0.[0-9]*$'
exits 0 "quiet" scene.lua -f 2 --until 0.02 -o 'a_%d.png' -q
check "quiet" test ! -s err

# ---- Refusals ----

exits 2 "repeat" scene.lua --until 0.01 --repeat 2
says "repeat" '--until: not with --repeat'
exits 2 "auto" scene.lua --seconds 2 --exposure auto
says "auto" '--seconds: not with --exposure auto, which measures pictures with other samples; expected a number of stops'
exits 2 "colours" scene.lua --until 0.1 --colormap viridis:auto
says "colours" '--until: not with --colormap auto.*expected NAME:LOW:HIGH'
exits 2 "one sample" scene.lua --until 0.1 --samples 1
says "one sample" "--samples: expected at least 2 with --until, got '1'"
exits 2 "two errors" scene.lua --until 0.1 --until-light 0.1
says "two errors" '--until-light: not with --until; expected one of the two'
for value in 0 -1 x; do
    exits 2 "until $value" scene.lua --until $value
    says "until $value" "--until: error, in fractions of white, > 0 expected, got '$value'"
    exits 2 "until-light $value" scene.lua --until-light $value
    says "until-light $value" "--until-light: error of linear light > 0 expected, got '$value'"
    exits 2 "seconds $value" scene.lua --seconds $value
done
exits 2 "another command" explain scene.lua --until 0.1

totals
