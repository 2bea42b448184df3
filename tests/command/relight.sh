#!/usr/bin/env bash
# Light passes and glint relight: the files of passes and their names; a relit picture equals a rendered one; films
# and pages; wrong input, which must write nothing. mixer.sh tests the mixer's page.
. tests/command/prelude.sh
cd "$work" || exit 1

# Lights of all kinds, a mirror and glass; STRENGTH and COLOR multiply the key light.
cat >scene.lua <<'LUA'
local glint = require "glint"
local P = glint.params { strength = 1.0, color = "#ffffff", ambient = 0.1, frames = 1 }
local scene = glint.scene { camera = glint.camera { eye = { 0, 2, 9 }, at = { 0, 0.6, 0 } }, ambient = P.ambient, background = 0.2 * P.ambient,
  glint.point_light { name = "key", position = { 4, 6, 5 }, intensity = 0.7 * P.strength, color = P.color },
  glint.disk_light { name = "a", group = "window", position = { -5, 4, 2 }, normal = { 5, -4, -2 }, radius = 1, samples = 5, intensity = 0.5 },
  glint.directional_light { name = "b", group = "window", direction = { 1, -2, -1 }, intensity = 0.3, color = { 1, 0.8, 0.5 } },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.6, mirror = 0.2 } },
  glint.sphere { center = { -1, 1, 0 }, radius = 1, material = glint.material { diffuse = { 0.8, 0.2, 0.1 }, specular = 0.5 } },
  glint.sphere { center = { 1.2, 0.8, 0.5 }, radius = 0.8, material = glint.material { diffuse = 0, transmission = 0.9, fresnel = true } } }
return glint.animation { scene = scene, width = 96, height = 64, frames = P.frames, frame = function(t) scene.camera.eye = { t, 2, 9 } end }
LUA

# ---- Files of passes ----
exits 0 "passes as pictures" scene.lua -q --passes 'light:key,light:window,light:ambient,depth' -o a.png
check "their names" test -f a.png -a -f a.light.key.png -a -f a.light.window.png -a -f a.light.ambient.png -a -f a.depth.png
exits 0 "as arrays" scene.lua -q --passes 'light:*' -o a.pfm
check "of the contract's names" test -f a.light.key.pfm -a -f a.light.ambient.pfm
run scene.lua --json --passes 'light:*' -o a.png
prints "events name them" '"light:window":"a.light.window.png"'
prints "those that are there are kept" '"status":"kept"'
run scene.lua --json --set strength=2 --passes 'light:*' -o a.png
prints "others are not" '"status":"rendered"'
run reproduce a.light.window.png scene.lua
check "a pass is reproduced: $status $(cat out err)" test "$status" -eq 0
exits 0 "without passes" scene.lua -q -o plain.png --force
exits 0 "with passes" scene.lua -q -o passes.png --passes 'light:*' --force
check "the picture is the same" "$GLINT" compare plain.png passes.png --fail 0 --warn 0
exits 2 "a lamp that is not there" scene.lua -q -o wrong.png --passes light:kye
says "the nearest" "did you mean 'light:key'"
exits 2 "two files of one name" scene.lua -q -o wrong.png --passes 'light:'
check "nothing is written" bash -c '! ls wrong* 2>/dev/null'

# ---- Across frames ----
cat >moves.lua <<'LUA'
local glint = require "glint"
local P = glint.params { shutter = 0.0 }
local lamp = glint.sphere_light { name = "lamp", position = { 3, 5, 4 }, radius = 0.5, samples = 4, visible = true }
local sun = glint.directional_light { name = "sun", direction = { 1, -2, -1 }, intensity = 0.4, ambient = 0.1 }
local red = glint.material { diffuse = { 0.8, 0.2, 0.1 }, specular = 0.5, shininess = 20 }
local ball = glint.sphere { center = { 0, 1, 0 }, radius = 1, material = red }
local scene = glint.scene { camera = glint.camera { eye = { 0, 2, 9 }, at = { 0, 0.6, 0 }, shutter = P.shutter, shutter_times = 3 },
  ambient = 0.2, lamp, sun, ball, glint.sphere_mesh { center = { 2, 1, 0 }, radius = 0.8, segments = 12, shading = "gouraud", material = red },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.6, mirror = 0.2 } } }
return glint.animation { scene = scene, width = 90, height = 60, frames = 9, frame = function(t, n)
  lamp.x = n > 6 and 3 + t or 3
  red.shininess = n > 3 and 40 * t + 1 or 20
  lamp.group = n == 6 and "both" or ""
  sun.group = n == 6 and "both" or ""
  ball.center = { n > 7 and t or 0, 1, 0 }
end }
LUA
same() { # NAME A B OPTION...: two runs of the animation, one with the options, give the same files
    local name=$1
    shift
    check "$name: a run" "$GLINT" moves.lua -q --passes 'light:*' -o 'one/%d.pfm' $1
    check "$name: another" "$GLINT" moves.lua -q --passes 'light:*' -o 'two/%d.pfm' $1 $2
    check "$name: the same files" diff -r one two
    rm -rf one two
}
same "what is kept" "" --no-reuse
same "threads" "-t 1" "-t 3"
same "several samples" "--samples 3" --no-reuse
same "an open shutter" "--set shutter=0.5" --no-reuse
same "adaptive sampling" "--samples 4 --adaptive 0.1" --no-reuse
exits 0 "a region" moves.lua -q -f 9 --passes 'light:*' --region 10,20,50,30 -o part.pfm
exits 0 "the whole" moves.lua -q -f 9 --passes 'light:*' -o whole.pfm
check "has the whole's passes" python3 - <<'PY'
import struct
def read(name):
    kind, size, scale, data = open(name, "rb").read().split(b"\n", 3)
    w, h = map(int, size.split())
    return w, h, data
w, h, whole = read("whole_0009.light.lamp.pfm")
pw, ph, part = read("part_0009.light.lamp.pfm")
rows = [whole[12 * ((h - 1 - y) * w + 10):][:12 * 50] for y in range(49, 19, -1)]
assert (pw, ph) == (50, 30) and b"".join(rows) == part
PY

if ! "$GLINT" --version --verbose | grep -q OpenEXR; then
    exits 2 "without OpenEXR" relight a.exr -o wrong.png
    skip "relight: this build has no OpenEXR"
    totals
    exit
fi

# ---- A relit picture equals the rendered one ----
exits 0 "a file of layers" scene.lua -q --passes 'light:*' -o a.exr
exits 0 "as it is" relight a.exr -q -o same.png
check "is the picture" "$GLINT" compare plain.png same.png --fail 0 --warn 0
exits 0 "as numbers" relight a.exr -q -o same.pfm
exits 0 "rendered numbers" scene.lua -q -o plain.pfm
check "within 2^-19" "$GLINT" compare plain.pfm same.pfm --fail 2e-6 --warn 2e-6
exits 0 "another strength and colour, rendered" scene.lua -q --set strength=2.5 --set color='#ffd9a0' --set ambient=0.3 -o want.pfm
exits 0 "and relit" relight a.exr -q --light key=2.5 --light key=#ffd9a0 --light ambient=3 -o got.pfm
check "are the same within 2^-18" "$GLINT" compare want.pfm got.pfm --fail 4e-6 --warn 4e-6
exits 0 "codes" scene.lua -q --set strength=2.5 --set color='#ffd9a0' --set ambient=0.3 --exposure 0.5 --tone filmic --bits 16 -o want.png
exits 0 "of another exposure and curve" relight a.exr -q --light key=2.5 --light key=#ffd9a0 --light ambient=3 --exposure 0.5 --tone filmic --bits 16 -o got.png
check "are the same but for a step of 16 bits" "$GLINT" compare want.png got.png --fail 2e-5 --warn 2e-5
exits 0 "transparent" scene.lua -q --alpha --passes 'light:*' -o alpha.exr
exits 0 "rendered" scene.lua -q --alpha -o alpha.png
exits 0 "relit" relight alpha.exr -q -o again.png
check "keeps its alpha" "$GLINT" compare alpha.png again.png --fail 0 --warn 0
exits 0 "half of the lamps" scene.lua -q --passes light:key -o some.exr
exits 0 "one is turned off" relight some.exr -q --light key=0 -o off.pfm
exits 0 "in the script" scene.lua -q --set strength=0 -o want.pfm
check "the other light stays" "$GLINT" compare want.pfm off.pfm --fail 4e-6 --warn 4e-6
sed -e "s/\"key\"/(\"k\"):rep(60)/" scene.lua >long.lua
exits 0 "a long name" long.lua -q --passes 'light:*' -o long.exr
exits 0 "is read again" relight long.exr -q --light "$(printf 'k%.0s' {1..60})=1" -o long.png
check "its picture" "$GLINT" compare plain.png long.png --fail 0 --warn 0
exits 0 "16 bits" scene.lua -q --bits 16 --passes 'light:*' -o half.exr
exits 0 "relit of 16 bits" relight half.exr -q -o half.png
check "is nearly the picture" "$GLINT" compare plain.png half.png --fail 0.02 --warn 0.02

# ---- Films ----
exits 0 "frames" scene.lua -q --set frames=3 --passes 'light:*' -o 'f/%04d.exr'
exits 0 "numbered pictures" relight 'f/%04d.exr' -q --light key=2 -o 'g/%02d.png'
check "three of them" test -f g/01.png -a -f g/03.png
exits 0 "named ones" relight f/0002.exr f/0003.exr -q --light key=2 -o 'n/%02d.png'
check "have the numbers of their files" test "$(cd n && echo *)" = "02.png 03.png"
check "and their pictures" cmp g/02.png n/02.png
exits 0 "selected ones" relight 'f/%04d.exr' -f 3 -q --light key=2 -o 'o/%02d.png'
check "too" test "$(cd o && echo *)" = 03.png
exits 0 "in another order" relight f/0003.exr f/0002.exr -q --light key=2 -o 'p/%02d.png'
check "they are counted" cmp g/03.png p/01.png
exits 0 "a film" relight 'f/%04d.exr' -q --light key=2 -o film.apng
check "is there, and its frames are gone" test -f film.apng -a ! -e film.apng.frames
exits 0 "its frames" scene.lua -q --set frames=3 --set strength=2 -o 'h/%02d.png'
check "are the rendered ones" "$GLINT" compare g/02.png h/02.png --fail 0.004 --warn 0.004

# ---- The page ----
exits 0 "a mixer" relight a.exr -q --light key=2 -o mixer.html
check "of one file that needs no other" bash -c '! grep -E "(src|href)=|https?://" mixer.html'

# ---- Wrong input ----
wrong() { # NAME PATTERN ARGUMENTS...
    local name=$1 pattern=$2
    shift 2
    exits 2 "$name" relight "$@"
    says "$name" "$pattern"
    check "$name: nothing is written" bash -c '! ls wrong* 2>/dev/null'
}
wrong "a name that is not there" "did you mean 'window'" a.exr --light widnow=2 -o wrong.png
wrong "another one" "it has 'ambient', 'key', 'window'" a.exr --light moon=2 -o wrong.png
wrong "no value" "NAME=STRENGTH or NAME=COLOUR" a.exr --light key -o wrong.png
wrong "a negative strength" "finite strength >= 0" a.exr --light key=-1 -o wrong.png
wrong "no colour" "such as #ffd9a0" a.exr --light key=redd -o wrong.png
wrong "twice" "once" a.exr --light key=1 --light key=2 -o wrong.png
wrong "no output" "-o with a picture, a film or a page" a.exr
wrong "no file" "none.exr: No such file or directory" none.exr -o wrong.png
wrong "no files" "expected finished pictures" -o wrong.png
wrong "no OpenEXR file" "OpenEXR file expected" plain.png -o wrong.png
exits 0 "a file without passes" scene.lua -q -o beauty.exr
wrong "a file without passes" "no light passes" beauty.exr -o wrong.png
head -c 9000 a.exr >cut.exr
wrong "a cut file" "whole OpenEXR file" cut.exr -o wrong.png
wrong "a page of two files" "a page shows one file" a.exr alpha.exr -o wrong.html
wrong "a page of 16 bits" "the page always shows 8-bit sRGB" a.exr --bits 16 -o wrong.html
wrong "another name" "ending in .png" a.exr -o wrong.jpg
wrong "its own file" "is one of the input pictures" a.exr -o a.exr
check "which is whole" "$GLINT" relight a.exr -q -o after.png
exits 2 "an option of other commands" relight a.exr -o wrong.png --samples 4

totals
