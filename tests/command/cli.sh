#!/usr/bin/env bash
# The command line as a user sees it: names, selection, options, events, exit codes, and files that are either complete
# or absent.
# shellcheck disable=SC2016
. tests/command/prelude.sh

LUA=${LUA:-lua5.4}
SAN_EXIT=99
export ASAN_OPTIONS="${ASAN_OPTIONS:-}:exitcode=$SAN_EXIT" UBSAN_OPTIONS="${UBSAN_OPTIONS:-}:exitcode=$SAN_EXIT"
export TSAN_OPTIONS="${TSAN_OPTIONS:-}:exitcode=$SAN_EXIT"
mounted=
cleanup() {
    [ -z "$mounted" ] || umount "$mounted"
    chmod -R u+rwx "$work"
    rm -rf "$work" "$work.log"
}
trap cleanup EXIT
cd "$work" || exit 1

files() { # NAME FILE...: exactly these pictures are here; removes them
    local name=$1 have want
    shift
    have=$(find . -maxdepth 2 \( -name '*.png*' -o -name '*.pfm*' -o -name '.*.tmp*' \) | sort | sed 's|^\./||' | tr '\n' ' ')
    want=$(printf '%s\n' "$@" | sort | tr '\n' ' ')
    [ $# -gt 0 ] || want=
    if [ "$have" = "$want" ]; then pass; else fail "$name: files: $have, not: $want"; fi
    clean
}

clean() { find . -maxdepth 2 \( -name '*.png*' -o -name '*.pfm*' \) -delete; }
sums() { (cd "$1" && sha256sum -- *.png); }

# ---- Scripts ----

cat >scene.lua <<'END'
local glint = require "glint"
local M = {}
M.red = glint.material { diffuse = { 0.8, 0.2, 0.2 }, specular = 0.7, shininess = 20 }
M.lamp = glint.point_light { position = { 3, 6, 5 }, name = "lamp" }
M.scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 9 }, at = { 0, 0, 0 } }, ambient = 0.1, background = "#203040",
  M.lamp, glint.sphere { center = { 0, 0, 0 }, radius = 1.5, material = M.red },
  glint.sphere { center = { 1.6, 0.8, 1.5 }, radius = 0.5, material = M.red },
  glint.plane { point = { 0, -1.5, 0 }, normal = { 0, 1, 0 } },
}
return M
END

cat >ten.lua <<'END'
-- Ten frames of a lamp.
-- It circles.
local glint = require "glint"
local S = require "scene"
local P = glint.params {
  radius = { 4, min = 1, max = 40, doc = "orbit radius" },
  shiny = true,
  mode = { "day", choices = { "day", "night" } },
  plain = 1.5,
}
S.red.shininess = P.shiny and 20 or 5; assert(P.mode and P.plain) -- a parameter that is not read is warned about
return glint.animation { scene = S.scene, frames = 10, cyclic = true, width = 40, height = 24, frame = function(t, n)
  if os.getenv "TRACE" then io.stderr:write("frame ", n, " t ", t, "\n") end
  S.lamp.position = { P.radius * glint.cos(2 * math.pi * t), 5, P.radius * glint.sin(2 * math.pi * t) }
end }
END

cat >one.lua <<'END'
local S = require "scene"
return S.scene
END

cat >loop.lua <<'END'
local S = require "scene"
for i = 1, 5 do
  S.lamp.x = i
  local image, why = S.scene:render { width = 40, height = 24 }
  io.stderr:write(i, " ", image and image.width or why, "\n")
end
END

cat >pattern.lua <<'END'
local glint = require "glint"
local S = require "scene"
local tiles = glint.pattern(function(p) return glint.select(glint.checker(p), 0.9, { 0.1, 0.1, 0.2 }) end)
S.scene:add(glint.plane { point = { 0, -2, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = tiles } })
S.scene:render { width = 40, height = 24 }
END

cat >single.lua <<'END'
local S = require "scene"
local image = S.scene:render { width = 40, height = 24 }
if image and os.getenv "LOOK" then io.stderr:write(("%.6f\n"):format(image:pixel(20, 12))) end
END

cat >list.lua <<'END'
local glint = require "glint"
local S = require "scene"
local function part(frames)
  return glint.animation { scene = S.scene, frames = frames, width = 40, height = 24, frame = function(t)
    S.lamp.position = { 5 * t, 5, 5 }
  end }
end
return { part(2), glint.sweep { scene = S.scene, size = { 40, 24 },
  over = { { S.red, "shininess", { 1, 4, 16 } }, { S.lamp, "intensity", { 0.5, 1 } } } }, part(1) }
END

script() { printf '%s\n' "$2" >"$1.lua"; }
script empty 'local x = 1'
script syntax 'local = 3'
script number 'return 5'
script text 'print "hello" io.write "raw\n" return require("scene").scene'
script busy_frame 'local S = require "scene" return require("glint").animation { scene = S.scene, frames = 2, width = 40, height = 24,
  frame = function(_, n) local from = os.clock() while n == 2 and os.clock() < from + 0.05 do end end }'
script table_error 'error { code = 3 }'
script text_error 'error(setmetatable({}, { __tostring = function() return "my own words" end }))'
script nil_error 'error()'
script frame_error 'local g, S = require "glint", require "scene"
return g.animation { scene = S.scene, frames = 4, width = 40, height = 24, frame = function(t, n) if n == 3 then S.lamp.intensity = -1 end end }'
script no_camera 'local g = require "glint" return g.scene { g.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } } }'
script own_camera 'local g = require "glint" return g.animation { frames = 3,
  scene = g.scene { ambient = 1, g.sphere { center = { 0, 0, 0 }, radius = 1 } } }'
script endless 'while true do end'
script stubborn 'while true do pcall(function() while true do end end) end'
script slow 'local g, S = require "glint", require "scene"
return g.animation { scene = S.scene, frames = 400, width = 1600, height = 1200, samples = 64, frame = function(t) S.lamp.x = t end }'

# Every kind of light and surface. Frames depend on cached results of earlier ones: in the first half a light moves,
# in the second half a mesh.
cat >everything.lua <<'END'
local glint = require "glint"
local metal = glint.material { model = "cook_torrance", f0 = 0.8, roughness = 0.3, diffuse = 0.1 }
local clear = glint.material { transmission = 0.9, ior = 1.3, fresnel = true, absorption = 0.2, diffuse = 0 }
local ball = glint.sphere_mesh { center = { -1, 1, 0 }, radius = 1, segments = 16, shading = "gouraud", material = glint.material { diffuse = 0.7 } }
local lamp = glint.sphere_light { position = { 3, 6, 3 }, radius = 0.7, samples = 4, visible = true }
local scene = glint.scene { camera = glint.camera { eye = { 0, 3, 8 }, at = { 0, 1, 0 }, fov = 40 }, background = 0.3,
  indirect = { samples = 2, bounces = 2 }, lamp, ball,
  glint.point_light { position = { -4, 5, 4 }, intensity = 0.4 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.6, mirror = 0.3 } },
  glint.box { min = { 0.5, 0, -1 }, max = { 1.5, 1, 0 }, material = metal },
  glint.cylinder { base = { 2, 0, 1 }, top = { 2, 1.5, 1 }, radius = 0.5, material = clear },
  glint.sphere_mesh { center = { 0.3, 0.6, 1.5 }, radius = 0.6, segments = 16, material = clear } }
return glint.animation { scene = scene, frames = 7, width = 48, height = 32, samples = 4, adaptive = 0.1,
  frame = function(_, n)
    lamp.position = { 3 - math.min(n, 4), 6, 3 }
    if n >= 4 then ball.transform = glint.translate { 0, 0.1 * (n - 4), 0 } end
  end }
END

# ---- Names of files ----

names() {
    exits 0 "a scene is a still" one.lua --size 40x24
    files "default of a still" one.png
    exits 0 "default of several" ten.lua -f 1-2
    files "default of several, part selected" ten_0001.png ten_0002.png
    exits 0 "one of several" ten.lua -f 7
    files "one selected of several keeps its number" ten_0007.png
    exits 0 "%04d" ten.lua -f 3 -o 'a_%04d.png'
    files "%04d" a_0003.png
    exits 0 "%d" ten.lua -f 3 -o 'a%d.png'
    files "%d" a3.png
    exits 0 "####" ten.lua -f 3 -o 'b####.png'
    files "####" b0003.png
    exits 0 "no place" ten.lua -f 3 -o c.png
    files "number before the ending" c_0003.png
    exits 0 "a still under -o" one.lua --size 40x24 -o d.png
    files "a still under -o" d.png
    exits 0 "%%" one.lua --size 40x24 -o '5%%.png'
    files "per cent sign" '5%.png'
    exits 0 "folders are made" one.lua --size 40x24 -o new/e.png
    files "folders are made" new/e.png
    exits 0 "pfm" ten.lua -f 2 -o f.pfm
    files "pfm" f_0002.pfm
    exits 0 "passes" ten.lua -f 2 --passes ambient,depth -o g.png
    files "passes" g_0002.png g_0002.ambient.png g_0002.depth.png
    exits 0 "-o none" ten.lua -o none
    files "-o none writes nothing"
    exits 0 "a list" list.lua
    files "frames of a list are numbered through" list_000{1,2,3,4,5,6,7,8,9}.png
    mkdir odd
    cp one.lua 'odd/100%#1.lua'
    cp scene.lua odd/
    exits 0 "odd script name" 'odd/100%#1.lua' --size 40x24
    files "a script's name is no pattern" '100%#1.png'
    script outputs 'local S = require "scene"
for _, name in ipairs { "x.png", "y.png" } do S.scene:render { width = 40, height = 24, output = name } end'
    exits 0 "named calls" outputs.lua
    files "a call's own name is its name" x.png y.png
    same_name
    exits 0 "loop without output" loop.lua
    files "a loop writes nothing by itself"
    exits 0 "loop under -o" loop.lua -o l.png
    files "loop under -o" l_0001.png l_0002.png l_0003.png l_0004.png l_0005.png
    exits 0 "single call under -o" single.lua -o s.png
    files "single call under -o" s.png
}

# Two pictures with one name give a warning. One picture written twice is complete.
same_name() {
    local name
    for name in same.png same.pfm ././same.png; do
        script same 'local S = require "scene"
for i = 1, 3 do S.scene.ambient = i / 3 S.scene:render { width = 8, height = 8, output = i == 2 and "'"$name"'" or "'"${name##*/}"'" } end'
        exits 0 "one name for three pictures" same.lua
        says "one name for three pictures" "warning: frame 2: output: '$name' is also the file of frame 1, .*same_%04d"
        exits 2 "one name is an error" same.lua --warnings=error
        exits 0 "numbered by -o" same.lua -o same.png
        check "no warning of numbered names" test -z "$(grep "also the file" err)"
        clean
    done
    script again 'local S = require "scene"
for i = 1, 3 do S.scene:render { width = 8, height = 8, output = "again.png" } end'
    exits 0 "one picture thrice" again.lua --warnings=error
    script passes 'local S = require "scene"
S.scene:render { width = 8, height = 8, output = "a.png", passes = "depth" }
S.scene:render { width = 9, height = 8, output = "a.depth.png" }'
    exits 2 "the name of a pass" passes.lua --warnings=error
    clean
    for name in "-o a.png -o b.npy" "-f 1 -f 2" "--shard 1/2 --shard 2/2" "--passes depth --passes normal"; do
        exits 2 "twice: $name" ten.lua $name
        says "twice: $name" 'given twice'
    done
    files "nothing written" # either name may have been meant
}

# ---- Which frames ----

traced() { # NAME WANT ARGUMENTS...: the frame function is called for these frames
    local name=$1 want=$2 have
    shift 2
    TRACE=1 run ten.lua -o none "$@"
    have=$(sed -n 's/^frame \([0-9]*\) t .*/\1/p' err | tr '\n' ' ')
    if [ "$have" = "$want" ] && [ "$status" -eq 0 ]; then pass; else fail "$name: frames $have, exit $status"; fi
}

# A selection without frames is an error; a shard without frames is not.
left_nothing() {
    local options
    for options in "-f 11" "-s 11" "-f 0" "-f 0-1:5" "-f 11-20,30-" "-j 3 -s 12" "-f 11 --shard 1/2"; do
        TRACE=1 exits 2 "nothing left by $options" ten.lua -o none $options
        says "nothing left by $options" 'error: frames: no frame is selected: .*1 \.\. 10$'
        check "no frame is built by $options" test -z "$(grep "^frame" err)"
        exits 2 "nothing left of a loop by $options" loop.lua -o none $options
    done
    exits 2 "nothing left of a sweep" ten.lua -o none --sweep radius=2:4:2 -f 21
    says "nothing left of a sweep" '1 \.\. 20$'
    script leaves 'local S = require "scene"
for i = 1, 3 do S.scene:render { width = 8, height = 8 } end
os.exit(0)'
    exits 2 "nothing left before os.exit" leaves.lua -o none -f 4
    script own 'local S = require "scene"
local a = require("glint").animation { scene = S.scene, frames = 3, width = 8, height = 8, output = "none", frame = print }
a:run { frames = "4-" }'
    exits 2 "nothing left by a run of the script" own.lua
    says "nothing left by a run of the script" "frames of the script are 1 .. 3"
    exits 0 "an empty shard" loop.lua -o none -f 1 --shard 2/2
}

selection() {
    traced "all" "1 2 3 4 5 6 7 8 9 10 "
    traced "ranges" "1 2 3 5 7 9 " -f 1-3,5,7-9:2
    traced "order and doubles" "2 3 " -f 3,2,2-3
    traced "open range" "9 10 " --frames 9-
    traced "-s -e -j" "2 5 8 " -s 2 -e 9 -j 3
    traced "cut" "10 " -f 10-30
    says "cut warns" 'warning: .*1 \.\. 10'
    left_nothing
    traced "shard 1/3" "1 2 3 " --shard 1/3
    traced "shard 2/3" "4 5 6 " --shard 2/3
    traced "shard 3/3" "7 8 9 10 " --shard 3/3
    traced "shard of a selection" "4 5 " -f 2-5 --shard 2/2
    traced "more shards than frames" "" -f 1 --shard 1/2
    TRACE=1 run ten.lua -o none -f 1,10
    says "cyclic t of the first" '^frame 1 t 0$'
    says "cyclic t of the last" '^frame 10 t 0\.9$'
    run loop.lua -f 2,4 --quiet
    check "a loop skips" test "$(tr '\n' ' ' <err | grep -o '1 skipped 2 40 3 skipped 4 40 5 skipped')"
    run loop.lua --shard 2/2 --quiet
    check "every Nth call" test "$(tr '\n' ' ' <err | grep -o '1 skipped 2 40 3 skipped 4 40 5 skipped')"
    run loop.lua -f 4-9 --quiet
    says "a loop's cut warns" 'warning: .*1 \.\. 5'
    exits 0 "-f of a list" list.lua -f 3,9
    files "numbers of a list" list_0003.png list_0009.png
}

# ---- Parameters ----

parameters() {
    exits 0 "-D number" ten.lua -o none -f 1 -D radius=7
    exits 0 "-D before the script" -D radius=7 --set shiny=false -o none ten.lua --set mode=night
    exits 2 "-D below min" ten.lua -D radius=0.5
    says "-D below min" 'radius: number 1 \.\. 40 expected, got .0\.5'
    exits 2 "-D not a number" ten.lua -D radius=math.pi
    script whole 'local glint = require "glint" io.stderr:write(math.type(glint.params { n = { 4, min = 1, max = 9, whole = true } }.n), " ") return require("scene").scene'
    for value in 2.5 x nan 1e30 10.0; do
        exits 2 "a parameter of whole numbers, $value" whole.lua -D "n=$value"
        says "a parameter of whole numbers, $value" "^glint: error: --set n: whole number 1 \\.\\. 9 expected, got '$value'"
    done
    exits 2 "a sweep of whole numbers" whole.lua -o none --sweep n=1:2:3
    says "a sweep of whole numbers" "^glint: error: --sweep n: whole number 1 \\.\\. 9 expected, got '1\.5'"
    exits 0 "a whole number with a point" whole.lua -o none --size 8x8 -D n=7.0
    says "a whole number with a point" integer
    script half 'require("glint").params { n = { 4.5, whole = true } }'
    exits 2 "a default that is not whole" half.lua
    says "a default that is not whole" '^glint: error: half\.lua:1: params\.n: whole number expected, got 4\.5'
    exits 2 "-D boolean" ten.lua -D shiny=1
    says "-D boolean" 'true or false'
    exits 2 "-D choice" ten.lua -D mode=dusk
    exits 2 "-D unknown" ten.lua -D raduis=3
    says "-D unknown names the nearest" "did you mean 'radius'"
    exits 2 "-D in a loop without parameters" loop.lua -D x=1
    exits 2 "-D without value" ten.lua -D radius
    files "nothing written" # but names of earlier checks
    script assign 'local P = require("glint").params { a = 1 } P.a = 2'
    exits 2 "assigning raises" assign.lua
    script unknown 'local P = require("glint").params { radius = 1 } print(P.raduis)'
    exits 2 "reading an unknown one raises" unknown.lua
    says "reading an unknown one" "did you mean 'radius'"
    script types 'local P = require("glint").params { a = 15, b = 1.0, s = "x" }
io.stderr:write(math.type(P.a), " ", math.type(P.b), " ", P.s, "\n") return require("scene").scene'
    run types.lua -o none -D a=20.0 -D b=3 -D 's=os.exit(7)' --size 8x8
    says "literals have the default's type" '^integer float os\.exit\(7\)$'
    exits 0 "--sweep" ten.lua --sweep radius=2:4:2 -f 10-11
    files "--sweep numbers through" ten_0010.png ten_0011.png
    exits 0 "--sweep shard" ten.lua --sweep radius=2:4:3 --sweep plain=0:1:2 --shard 12/12 -o 'w%02d.png'
    files "--sweep shard" w28.png w29.png w30.png w59.png w60.png # both values of `plain`, which has no effect
    exits 0 "--sweep of a still" one.lua --size 40x24 -o none
    exits 2 "--sweep of an unknown one" ten.lua --sweep raduis=1:2:3
    exits 2 "--sweep out of range" ten.lua --sweep radius=1:50:3 -o none
    for wrong in radius radius=1 radius=1:2 radius=1:2:0 radius=a:2:3 =1:2:3 radius=1:2:3x; do
        exits 2 "--sweep $wrong" ten.lua --sweep "$wrong"
    done
    script steps 'local glint = require "glint" io.stderr:write(glint.params { n = 1.0 }.n, " ") return require("scene").scene'
    run steps.lua --sweep n=1:50:50 -o none --size 1x1 -q
    check "--sweep has whole steps" test "$(cat err)" = "$(seq -s ' ' 50) "
    run steps.lua --sweep n=0.1:0.9:9 -o none --size 1x1 -q
    says "--sweep has short steps" '^0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 $'
    run steps.lua --sweep n=-1e308:1e308:5 -o none --size 1x1 -q
    says "--sweep over all numbers" '^-1e\+308 -5e\+307 0 5e\+307 1e\+308 $'
    run steps.lua --sweep n=0:0:3 -o none --size 1x1 -q
    says "--sweep over one number" '^0 0 0 $'
    check "--sweep has exact ends" eval 'run steps.lua --sweep n=0.30000000000000004:0.7000000000000001:3 -o e%d.png --size 1x1 -q &&
        grep -aq "n=0.30000000000000004" e1.png && grep -aq "n=0.7000000000000001" e3.png'
    rm -f e[123].png
    run steps.lua --sweep n=1:256:*9 -o none --size 1x1 -q
    says "--sweep by factors" '^1 2 4 8 16 32 64 128 256 $'
    run steps.lua --sweep n=-100:-0.01:*5 -o none --size 1x1 -q
    says "--sweep by factors below 1" '^-100 -10 -1 -0\.1 -0\.01 $'
    exits 2 "--sweep by factors from 0" steps.lua --sweep n=0:4:*3 -o none
    says "--sweep by factors from 0" '^glint: error: --sweep: n: expected two ends of the same sign'
    run steps.lua --sweep n=7,-2,1e3 -o none --size 1x1 -q
    says "--sweep of a list" '^7 -2 1000 $'
    exits 2 "--sweep of a list with a gap" steps.lua --sweep n=7,,3
    says "--sweep of a list with a gap" 'a value expected before and after each comma'
    script kinds 'local P = require("glint").params { shiny = false, mode = { "day", choices = { "day", "night" } } }
io.stderr:write(P.mode, " ", tostring(P.shiny), ", ") return require("scene").scene'
    run kinds.lua --sweep mode=night,day --sweep shiny=true,false -o none --size 1x1 -q
    says "--sweep of choices and booleans" '^night true, day true, night false, day false, $'
    exits 2 "--sweep checks values first" ten.lua --sweep radius=2,3,500 -o 'first_%d.png'
    says "--sweep checks values first" '^glint: error: --sweep radius: number 1 \.\. 40 expected, got .500'
    files "--sweep checks values first: no picture"
    exits 2 "--sweep of a wrong choice" kinds.lua --sweep mode=day,dusk
    says "--sweep of a wrong choice" '--sweep mode: day or night expected, got .dusk'
    exits 2 "--sweep of an unknown one names itself" ten.lua --sweep raduis=1,2
    says "--sweep of an unknown one names itself" "--sweep raduis: no such parameter; did you mean 'radius'"
    exits 0 "--sweep beside --help" ten.lua --sweep radius=2:4:2 --help
    prints "--sweep beside --help" '^  radius=4 +1 \.\. 40'
    exits 2 "--sweep and --set of one" ten.lua --sweep radius=1:2:3 --set radius=2
    exits 0 "--passes all" one.lua --size 8x8 --passes all -o all.png
    check "--passes all" eval 'test -s all.depth.png && test -s all.refined.png && test -s all.mirror.png'
    clean
    for verb in render explain dump describe compare sheet assemble join reproduce new cost watch completion; do
        exits 0 "$verb --help" $verb --help
        prints "$verb --help" "^usage: glint $verb "
        mv out by_option
        run help $verb
        check "help $verb" cmp out by_option
    done
    run compare --help
    prints "a command has its own options" '--fail X'
    check "a command has no others" eval '! grep -q -e --samples out'
    exits 2 "help of an unknown command" help compre
    says "help of an unknown command" "help: compre: no such command; did you mean 'compare'"
    exits 0 "help alone" help
    prints "help alone" '^usage: glint \[render\] SCRIPT'
    run ten.lua --help
    check "--help exits 0" test "$status" -eq 0
    prints "--help has the comment" '^It circles\.$'
    prints "--help has a parameter" '^  radius=4 +1 \.\. 40 +orbit radius'
    prints "--help has choices" 'mode=day +day\|night'
    run describe --json ten.lua
    prints "describe" '"name":"radius","type":"number","default":4,"value":4,"min":1,"max":40,"doc":"orbit radius"'
    prints "describe has choices" '"choices":\["day","night"\]'
    check "describe is one line" test "$(wc -l <out)" -eq 1
    cat >point.lua <<'LUA'
local glint = require "glint"
local P = glint.params {
  lamp = { { 3, 5, 2.5 }, drag = true, label = "The $lamp$", doc = "its place" }, n = { 16, min = 1, max = 99, unit = "cm" },
  model = { "phong", choices = { "phong", "blinn_phong" }, names = { blinn_phong = "Blinn-Phong" } } }
print(P.lamp.x, P.lamp.y, P.lamp.z)
LUA
    run describe --json point.lua
    prints "describe has points" '"name":"lamp","type":"point","default":\[3,5,2.5\],"value":\[3,5,2.5\],"drag":true,"label":"The \$lamp\$"'
    prints "describe has names for choices" '"choices":\["phong","blinn_phong"\],"names":\["phong","Blinn-Phong"\]'
    prints "describe has units" '"unit":"cm"'
    run describe --json point.lua --set lamp=-1,2e1,.5
    prints "a point is set" '"value":\[-1,20,0.5\]'
    for wrong in 1,2 1,2,3,4 1,2,x 1,2,inf '' 1,,2; do
        exits 2 "the point '$wrong'" describe point.lua --set "lamp=$wrong"
        says "the point '$wrong'" "--set lamp: point X,Y,Z expected, got '$wrong'"
    done
    while IFS='|' read -r field message; do
        echo "require 'glint'.params { $field }" >wrong.lua
        exits 2 "params { $field }" describe wrong.lua
        says "params { $field }" "wrong.lua:1: params\.a$message"
    done <<'END'
a = { { 1, 2, 3 }, min = 1 }|.min: a point has no min
a = { { 1, 2 } }|\[3\]: number expected, got nil
a = { 1, drag = true }|.drag: a number has no drag
a = { "x", unit = "m" }|.unit: a string has no unit
a = { "x", choices = { "x" }, names = { z = "Z" } }|.names: 'z' is none of the choices
a = { "x", names = { x = "X" } }|.names: expected together with choices
a = { "x", choices = { "x" }, names = { x = 1 } }|.names: text for each choice expected, got 1
a = { { 1, 2, 3 }, choices = { { 1, 2, 3 } } }|.choices: a point has no choices
a = { 1, label = 3 }|.label: string expected, got 3
a = { 1, lable = "x" }|.lable: no such field; did you mean 'label'
END
    exits 0 "describe of a loop renders nothing" describe loop.lua --json
    files "describe writes nothing"
}

# ---- Options ----

options() {
    exits 0 "--version" --version
    prints "--version" '^glint [0-9]'
    exits 0 "--help" --help
    exits 2 "no script" --json
    exits 0 "--max-depth" ten.lua -f 1 -o none --max-depth 0
    exits 2 "--max-depth" ten.lua -o none --max-depth -1
    says "--max-depth" 'max-depth: whole number 0 \.\. 2147483648 expected, got .-1'
    exits 2 "unknown option" ten.lua --thraeds 2
    says "unknown option names the nearest" "did you mean '--threads'"
    exits 2 "an option by another program's name" ten.lua --widht 300
    says "names what it is called here" "--widht: no such option; did you mean '--size'"
    exits 2 "a pass that is none" ten.lua --passes diffuse,normals
    says "names it and the nearest" "^glint: error: --passes: 'normals' is not a pass; did you mean 'normal'\\?$"
    exits 2 "a misspelt word" ten.lua --colormap magmo
    says "names the nearest" "^glint: error: --colormap: .* expected, got 'magmo'; did you mean 'magma'\\?$"
    exits 2 "a pass like none" ten.lua --passes diffuse,xyzzy
    says "names it and all" "'xyzzy' is not a pass; list of beauty, .*, albedo, d:NAME, light:NAME, all expected$"
    exits 0 "--version --verbose" --version --verbose
    prints "libraries" '^libraries: Lua 5\.4.*libpng [0-9].*xxhash [0-9]'
    prints "kernels" '^kernels: ref generic.*; in use: [a-z0-9]+, [0-9]+ threads$'
    prints "limits" '^limits: 65535 pixels a side'
    exits 2 "--verbose alone" ten.lua --verbose
    exits 0 "one frame of ten, under a name without a number" ten.lua -f 1 -o terms.png
    says "says its name" '^-o terms.png: writing 10 numbered files, terms_####.png; to make a film, use -o terms.mp4, .webm, .gif or .apng$'
    check "which is stable" test -e terms_0001.png
    exits 0 "a name with a number" ten.lua -f 1 -o 'terms_%04d.png'
    check "has nothing said of it" eval '! grep -q "names 10" err'
    exits 0 "a still" one.lua -o still.png
    check "neither" eval '! grep -q "names" err'
    rm -f terms_0001.png still.png
    script deep 'local function inner() return nil + 1 end
local function outer() inner() end
outer()'
    exits 2 "an error in a function" deep.lua
    check "has the lines that led there" test "$(sed -n 2,9p err)" = "  called from deep.lua:2
  called from deep.lua:3"
    says "and where it is" '^glint: error: deep.lua:1: attempt to perform arithmetic'
    script called 'local glint = require "glint"
local function paint(c) return glint.material { diffuse = c } end
paint "rde"'
    exits 2 "a wrong value in a function" called.lua
    says "is where it was given" "^glint: error: called.lua:2: .*did you mean 'red'"
    says "and called" '^  called from called.lua:3$'
    exits 2 "unknown letter" ten.lua -Z
    exits 2 "unknown command" explian ten.lua
    says "unknown command names the nearest" "did you mean 'explain'"
    exits 2 "two scripts" ten.lua one.lua
    local wrong
    for wrong in '-f x' '-f 3-1' '-f 1,' '-f -3' '-f 1-5:0' '-s 0' '-e x' '-j 0' '-s 5 -e 4' '-f 1 -s 1' '--shard 0/2' \
        '--shard 3/2' '--shard 1' '-o x.jpg' '-o %s.png' '-o .png' '-o x' '--size 40' '--size 0x4' '--size 40x24x' \
        '--size 65536x1' '--samples 0' '--samples 1.5' '--samples nan' '--precision half' '--bits 9' '--transfer foo' \
        '--rounding up' '--tone foo' '--exposure x' '--exposure nan' '--exposure 33' '--adaptive x' '--adaptive -1' '--adaptive 3.5' '--adaptive nan' '--passes foo' '--passes depth,' '--encode foo' '--clamp x' '--clamp -1' '--clamp nan' '--clamp 1e10' '--rays -1' '--rays 1.5' '--rays 65537' '--rays x' '--dpi x' '--dpi -1' '--dpi 1e7' '--colormap veridis' '-t 0' '-t x' '-t 1025' '--seed -1' \
        '--seed 1.5' '--reuse-memory x' '--repeat 0' '--repeat x' '--json=1' '--alpha=true' '--samples' '--fail 1'; do
        # shellcheck disable=SC2086
        exits 2 "wrong: $wrong" ten.lua $wrong
    done
    files "wrong options write nothing"
    exits 0 "every option" --precision float --bits 16 --transfer linear ten.lua --rounding truncate --dither --clamp 2 --rays 3 --tone filmic --exposure -0.5 \
        --encode small --dpi 300 -t 2 --seed 5 --no-reuse --reuse-memory 64M --samples 4 --quiet --size 20x12 -f 1 -o q.png
    check "--quiet is quiet" test ! -s err
    exits 0 "the picture is as asked" compare q_0001.png q_0001.png --json
    prints "size on the command line wins" '"width":20,"height":12'
    check "300 pixels an inch are 11811 a meter" grep -qaP 'pHYs\x00\x00\x2e\x23\x00\x00\x2e\x23\x01' q_0001.png
    exits 0 "the same without" ten.lua --precision float --size 20x12 -f 1 -o plain.png
    check "no dpi, none said" test "$(grep -c pHYs plain_0001.png)" -eq 0
    exits 0 "another dpi is another file" ten.lua --precision float --size 20x12 -f 1 -o plain.png --dpi 72 --json
    prints "rendered again" '"status":"rendered"'
    exits 0 "the script's, said by the file" reproduce plain_0001.png ten.lua
    exits 0 "a colour map, and no pass to show" ten.lua --size 20x12 -f 1 -o map.png --colormap viridis
    check "is told of" grep -q 'colormap: colours only the passes depth and d:NAME, and none of them is written' err
    exits 0 "a colour map, and a file of numbers" ten.lua --size 20x12 -f 1,2 -o map.pfm --passes depth --colormap viridis
    check "is told of once" test "$(grep -c 'colormap has no effect on .pfm, .npy and .exr' err)" -eq 1
    exits 0 "no colour map, and a file of numbers" ten.lua --size 20x12 -f 1 -o map.pfm --passes depth
    check "is told nothing" test "$(grep -c colormap err)" -eq 0
    rm map_000?.*
    for map in none viridis magma; do
        exits 0 "depth in $map" ten.lua --size 20x12 -f 1 -o map.png --passes depth --colormap $map --json
        prints "is another file" '"status":"rendered"'
        cp map_0001.depth.png depth_$map.png
    done
    exits 0 "the same again" ten.lua --size 20x12 -f 1 -o map.png --passes depth --colormap magma --json
    prints "is kept" '"status":"kept"'
    check "three pictures" test "$(cat depth_none.png | cksum)" != "$(cat depth_viridis.png | cksum)" -a "$(cat depth_magma.png | cksum)" != "$(cat depth_viridis.png | cksum)"
    clean
    script fields 'local S = require "scene" S.scene:render { widht = 3 }'
    exits 2 "unknown field" fields.lua
    says "unknown field" "fields.lua:1: scene:render: widht: .*did you mean 'width'"
    script fields 'local S = require "scene" S.scene:render { width = -1 }'
    exits 2 "wrong field" fields.lua
    says "wrong field" 'scene:render: width: whole number 1 \.\. 65535 expected, got -1'
    for wrong in 'width=1.5' 'height=0/0' 'samples="4"' 'bits=9' 'transfer="x"' 'tone=1' 'tone="filmik"' 'exposure=-33' 'exposure="1"' 'adaptive=-0.1' 'adaptive=4' 'adaptive=true' 'precision=true' 'rounding="up"' \
        'outline="red"' 'outline=true' 'alpha=1' 'alpha="true"' 'passes={"x"}' 'passes={1}' 'passes=3' 'seed=-1' 'max_depth=-1' 'visibility="x"' 'clamp=-1' 'clamp="1"' 'clamp=0/0' 'clamp=1/0' 'rays=-1' 'rays=1.5' 'rays="2"' 'rays=65537' 'dither=1' 'encode="x"' 'dpi=-1' 'dpi="300"' 'colormap=1' 'colormap="jet"' 'output="x.jpg"' 'output=3' '[1]=2'; do
        script fields "local S = require 'scene' S.scene:render { $wrong }"
        exits 2 "wrong field $wrong" fields.lua
    done
    script jobs 'local g, S = require "glint", require "scene" return g.animation { scene = S.scene, frame = print, fraems = 3 }'
    exits 2 "unknown field of an animation" jobs.lua
    says "unknown field of an animation" "animation.fraems: .*did you mean 'frames'"
    script words 'io.stderr:write(table.concat(arg, "+"), " ", arg[0], "\n") return require("scene").scene'
    run words.lua -o none --size 8x8 -- -f 3 x
    says "arguments of the script" '^-f\+3\+x words.lua$'
}

# ---- Events ----

cat >parse.lua <<'END' # Reads JSON lines strictly enough; prints each path=value.
local function value(s, i, path)
  local c = s:sub(i, i)
  if c == "{" or c == "[" then
    local close, n = c == "{" and "}" or "]", 0
    i = i + 1
    while s:sub(i, i) ~= close do
      if n > 0 then assert(s:sub(i, i) == ",", "comma") i = i + 1 end
      n = n + 1
      local key = n
      if c == "{" then
        key = assert(s:match('^"([%w_]+)":', i), "key")
        i = i + #key + 3
      end
      i = value(s, i, path .. "." .. key)
    end
    return i + 1
  end
  if c == '"' then
    local j = i + 1
    while s:sub(j, j) ~= '"' do
      assert(j <= #s and s:byte(j) >= 32, "string")
      j = j + (s:sub(j, j) == "\\" and 2 or 1)
    end
    print(path .. "=" .. s:sub(i + 1, j - 1))
    return j + 1
  end
  local word = assert(s:match("^[%w%.+-]+", i), "value at " .. i)
  assert(word == "null" or word == "true" or word == "false" or tonumber(word), word)
  print(path .. "=" .. word)
  return i + #word
end
for line in io.lines() do assert(value(line, 1, "") == #line + 1, "rest") end
END

parsed() { # NAME: the last run's events are JSON; their values are in values
    if "$LUA" parse.lua <out >values 2>err2; then pass; else fail "$1: $(head -n 1 err2): $(head -c 300 out)"; fi
}
valued() { # NAME PATTERN
    if grep -qE -- "$2" values; then pass; else fail "$1: no $2 among the values"; fi
}

events() {
    exits 0 "--json" ten.lua --json -f 2-4
    parsed "--json"
    check "a line for each frame and the end" test "$(wc -l <out)" -eq 4
    check "frames in order" test "$(sed -n 's/^\.index=//p' values | tr '\n' ' ')" = "2 3 4 "
    for want in 'event=frame' 'file=ten_0003.png' 'status=rendered' 'ms.build=[0-9.]+' 'ms.render=[0-9.]+' 'ms.tone=[0-9.]+' \
        'ms.encode=[0-9.]+' 'ms.stages.cast=[0-9.]+' 'stages.cast=(run|reused)' 'rays.primary=[0-9]+' 'rays.shadow=[0-9]+' \
        'rays.mirror=0' 'rays.refraction=0' 'rays.indirect=0' 'refined=0' 'clipped=[0-9.e-]+' 'nonfinite=0' 'event=end' 'frames=3' \
        'kept=0' 'seconds=[0-9.]+'; do
        valued "event has $want" "^\.$want\$"
    done
    run ten.lua --json -f 2-4
    parsed "kept"
    check "kept" test "$(grep -c '^\.status=kept$' values)" -eq 3
    valued "the end counts kept" '^\.kept=3$'
    clean
    exits 0 "text goes to stderr" text.lua --json --size 40x24
    parsed "text"
    says "print under --json" '^hello$'
    says "io.write under --json" '^raw$'
    clean
    exits 2 "an error is an event" frame_error.lua --json
    parsed "error"
    valued "error event" '^\.event=error$'
    valued "error's frame" '^\.index=3$'
    clean
    exits 2 "a usage error is an event" ten.lua --json --nonsense
    parsed "usage error"
    printf 'error "q\\"b\\\\ t\\t u\\u{e9} x\\xff"' >quote.lua
    exits 2 "strings are escaped" quote.lua --json
    parsed "strings"
    exits 0 "--repeat" ten.lua --json -f 1 --repeat 3 -o none
    parsed "--repeat"
    check "--repeat reports each" test "$(sed -n 's/^\.repeat=//p' values | tr '\n' ' ')" = "1 2 3 "
    valued "--repeat is one frame" '^\.frames=1$'
    exits 0 "explain --json" explain ten.lua --json --frame 4
    parsed "explain"
    valued "explain has effects" '^\.effects\.[0-9]+\.caller=.*lamp'
    valued "explain has stages" '^\.stages\.[0-9]+\.name=cast$'
    valued "explain has rays" '^\.rays\.primary=960$'
    cat >glossy.lua <<'END'
local glint = require "glint"
return glint.scene { camera = glint.camera { eye = { 0, 3, 9 }, at = { 0, 0, 0 } }, reflection_samples = 8,
  glint.disk_light { position = { 3, 6, 3 }, normal = { -1, -2, -1 }, radius = 1, samples = 16 },
  glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = glint.material { mirror = 0.4, roughness = 0.2 } } }
END
    exits 0 "explain a glossy floor" explain glossy.lua --size 10x8 --samples 4 # 320 samples, 8 rays each, 16 shadow rays each
    prints "explain a glossy floor: samples" 'samples = 4$'
    prints "explain a glossy floor: shadows" '^  shadow     40960 more at most where these rays hit first$'
    prints "explain a glossy floor: each" 'for each sample of a pixel: 8 rays beyond the surface x 16 shadow rays\. Fewer by reflection_samples'
    exits 0 "explain a glossy floor, --json" explain glossy.lua --size 10x8 --samples 4 --json
    parsed "explain a glossy floor"
    valued "explain a glossy floor, --json" '^\.shadow_beyond=40960$'
    exits 0 "explain --programs" explain pattern.lua --json --programs
    parsed "explain --programs"
    valued "a pattern's length" '^\.programs\.[0-9]+\.instructions=[1-9]'
    valued "a pattern's instructions" '^\.programs\.[0-9]+\.listing=.*parity'
    valued "whose pattern it is" '^\.effects\.[0-9]+\.effect=pattern: diffuse'
    exits 0 "explain of a loop" explain loop.lua --json --frame 3
    exits 2 "explain beyond the end" explain ten.lua --frame 11
    exits 0 "explain for people" explain ten.lua
    prints "explain names who called" "point_light 'lamp'"
    files "explain writes nothing"
    "$GLINT" ten.lua --json -o none >/dev/full 2>err
    check "stdout is full" test $? -eq 75
    says "stdout is full" 'stdout: No space'
    "$GLINT" cost one.lua --size 40x24 --quick --json >/dev/full 2>err
    check "stdout is full for a study" test $? -eq 75
    says "stdout is full for a study" 'stdout: No space'
    for file in index.html plot.svg; do
        mkdir report
        ln -s /dev/full report/$file
        exits 75 "a report whose $file has no space" cost one.lua --size 40x24 --quick --report report -q
        says "a report whose $file has no space" "--report: report/$file: No space left on device"
        rm -r report
    done
    "$GLINT" --version >/dev/full 2>err
    check "stdout is full for --version" test $? -eq 75
    "$GLINT" ten.lua --json -o none 2>err | true
    check "the reader has gone" test "${PIPESTATUS[0]}" -le 1
    check "no SIGPIPE" test "${PIPESTATUS[0]}" -ne 141
}

# ---- Errors of scripts ----

errors() {
    exits 0 "a slow script" busy_frame.lua -o none
    says "a line with the script's time" '^frame 2: script 0\.[0-9]+ s, render 0\.[0-9]+ s$'
    exits 2 "no such script" nothing.lua
    exits 2 "a folder" .
    exits 2 "syntax" syntax.lua
    says "syntax" 'syntax.lua:1:'
    exits 2 "returns nothing" empty.lua
    says "returns nothing" 'returned nothing'
    exits 2 "returns a number" number.lua
    exits 2 "table as error" table_error.lua
    says "table as error" '\(error object is a table value\)'
    exits 2 "table with __tostring" text_error.lua
    says "table with __tostring" 'my own words'
    exits 2 "nil as error" nil_error.lua
    exits 2 "error in frame" frame_error.lua
    says "error in frame" 'frame 3: frame_error.lua:2: point_light.intensity: '
    files "what was done stays" frame_error_0001.png frame_error_0002.png
    exits 2 "no camera" no_camera.lua
    says "no camera" 'camera'
    exits 0 "a camera that frames the scene" own_camera.lua --size 8x8
    says "a camera that frames the scene" 'the scene has no camera; glint uses one that shows the whole scene: glint\.camera \{ eye'
    check "it says so once" test "$(grep -c 'has no camera' err)" -eq 1
    clean
    "$LUA" -e 'io.open("code.lua", "wb"):write(string.dump(function() end))'
    exits 2 "bytecode" code.lua
    GLINT_ISA=foo run ten.lua -o none
    check "GLINT_ISA=foo" test "$status" -eq 2
    says "GLINT_ISA=foo" 'GLINT_ISA: ref, generic, avx2 or avx512 expected'
    script results 'local s = require("scene").scene return s, s'
    exits 2 "two results" results.lua
    script exits 'local S = require "scene"
S.scene:render { width = 40, height = 24, output = "x.png" } os.exit(7)'
    exits 7 "os.exit" exits.lua --json
    prints "os.exit ends with the event" '"event":"end","frames":1'
    prints "the event tells the memory" '"peak_bytes":[1-9][0-9]{6}'
    files "os.exit leaves no picture behind" x.png
    script nested 'local g, S = require "glint", require "scene"
return g.animation { scene = S.scene, frame = function() S.scene:render() end }'
    exits 2 "render inside frame" nested.lua
    files "errors write nothing"
}

# ---- Files: kept, forced, whole or absent ----

whole() {
    run ten.lua -f 1-2
    local before after
    before=$(stat -c %y.%i ten_0001.png)
    run ten.lua -f 1-2
    after=$(stat -c %y.%i ten_0001.png)
    check "a kept file is not touched" test "$before" = "$after"
    cp ten_0001.png whole.bin
    truncate -s -8 ten_0001.png
    run ten.lua -f 1-2 --json
    check "a truncated file is rendered again" grep -q '"index":1.*"status":"rendered"' out
    check "and only that" grep -q '"index":2.*"status":"kept"' out
    check "to the same bytes" cmp ten_0001.png whole.bin
    run ten.lua -f 1 --json -D radius=5
    check "another scene is rendered" grep -q '"status":"rendered"' out
    run ten.lua -f 1 --json
    run ten.lua -f 1 --json --force
    check "--force renders" grep -q '"status":"rendered"' out
    run ten.lua -f 1 --json --transfer linear
    check "another transfer is rendered" grep -q '"status":"rendered"' out
    echo 'local glint = require "glint"
    local P = glint.params { light = { 0.1 } }
    local paint = glint.material { diffuse = glint.pattern(function(p) return glint.fract(p.x) end) }
    return glint.scene { camera = glint.camera { eye = { 0, 2, 9 }, at = { 0, 0, 0 } }, ambient = P.light,
      glint.sphere { center = { 0, 0, 0 }, radius = 1, material = paint } }' >painted.lua
    run painted.lua -o painted.png
    run painted.lua -o painted.png --json --set light=0.8
    check "another ambient light on a pattern is rendered" grep -q '"status":"rendered"' out
    run ten.lua -f 1 --passes depth
    run ten.lua -f 1 --passes depth --json
    check "passes are kept" grep -q '"status":"kept"' out
    rm ten_0001.depth.png
    run ten.lua -f 1 --passes depth --json
    check "a missing pass is rendered" grep -q '"status":"rendered"' out
    clean
    run single.lua -o s.png
    LOOK=1 run single.lua -o s.png --json
    check "a kept call" grep -q '"status":"kept"' out
    says "a kept call still has its picture" '^[0-9.]+$'
    run loop.lua -o l.png
    run loop.lua -o l.png --json
    check "kept calls" test "$(grep -c '"status":"kept"' out)" -eq 5
    says "kept calls return images" '^3 40$'
    clean
    ln -s /dev/full full.png
    exits 75 "a full device" one.lua --size 40x24 -o full.png
    check "the link is still there" test -L full.png
    exits 75 "a full device by its name" one.lua --size 40x24 -o /dev/full
    check "and the device" test -c /dev/full
    rm -f full.png
    mkfifo pipe.png
    cat pipe.png >piped.bin &
    exits 0 "a pipe" one.lua --size 40x24 -o pipe.png
    wait $!
    check "a pipe is written in place" test -p pipe.png -a -s piped.bin
    exits 1 "a pipe without a reader" one.lua --size 40x24 -o pipe.png
    rm -f pipe.png
    if [ "$(id -u)" -ne 0 ]; then
        mkdir locked
        chmod a-w locked
        exits 1 "a locked folder" one.lua --size 40x24 -o locked/x.png
    fi
    exits 1 "a folder that cannot be" one.lua --size 40x24 -o /proc/nothing/x.png
    echo text >plain
    exits 1 "a file where a folder should be" one.lua --size 40x24 -o plain/x.png
    (ulimit -f 1 && "$GLINT" one.lua --size 400x300 -o big.png) >out 2>err
    check "a limit on file size" test $? -eq 1 -o $? -eq 75
    files "nothing partial"
}

small_disk() {
    mkdir small
    if ! mount -t tmpfs -o size=64k tmpfs small 2>/dev/null; then
        echo "skip: a small disk needs permission to mount"
        return
    fi
    mounted=$work/small
    exits 75 "disk full" ten.lua --size 200x150 --bits 16 -o 'small/%04d.png'
    says "disk full names the file" 'small/[0-9]+\.png'
    local file
    for file in small/*; do
        [ -e "$file" ] || continue
        check "whole after disk full: $file" "$GLINT" compare "$file" "$file"
    done
    check "no temporary is left" test -z "$(find small -name '.*' -type f; find small -name '*tmp*')"
    umount small
    mounted=
}

# ---- Signals ----

signalled() { # NAME SIGNAL WANT SCRIPT ARGUMENTS...
    local name=$1 signal=$2 want=$3 pid begin
    shift 3
    "$GLINT" "$@" >out 2>err </dev/null &
    pid=$!
    sleep 0.5
    begin=$(date +%s%N)
    kill -s "$signal" $pid
    wait $pid
    status=$?
    if [ $status -eq "$want" ]; then pass; else fail "$name: exit $status, not $want"; fi
    check "$name: within 2 s" test $((($(date +%s%N) - begin) / 1000000)) -lt 2000
    check "$name: no temporary is left" test -z "$(find . -name '*tmp*'; find . -name '.*' -type f)"
    local file
    for file in *.png; do
        [ -e "$file" ] || continue
        check "$name: whole: $file" "$GLINT" compare "$file" "$file"
    done
    clean
}

signals() {
    signalled SIGINT INT 130 slow.lua
    signalled SIGTERM TERM 143 slow.lua --json
    check "SIGTERM is an event" grep -q '"message":"interrupted"' out
    case ${PRELOAD:-} in
    *tsan*) echo "skip: ThreadSanitizer holds signals back from a loop that makes no system call" ;;
    *)
        signalled "SIGINT in a loop" INT 130 endless.lua
        signalled "SIGINT in a loop that catches errors" INT 130 stubborn.lua
        ;;
    esac
    # A script that waits for a pipe inside C ends by the first signal, whether or not the pipe has a writer.
    mkfifo waits
    exec 9<>waits
    echo 'while true do io.open("waits"):read(1) end' >reading.lua
    signalled "SIGTERM while reading a pipe" TERM 143 reading.lua
    "$GLINT" - -o none <waits >out 2>err &
    local waiting=$!
    sleep 0.5
    kill -s TERM $waiting
    wait $waiting
    check "SIGTERM while reading a script" test $? -eq 143
    exec 9>&-
    echo 'while true do io.open "waits" end' >waiting.lua
    signalled "SIGTERM while waiting for a pipe" TERM 143 waiting.lua
    rm waits reading.lua waiting.lua
    local begin=$SECONDS
    "$GLINT" slow.lua -o 'many%d.png' --size 60x40 --samples 1 >out 2>err </dev/null &
    local pid=$!
    sleep 0.05
    kill -s KILL $pid
    wait $pid 2>/dev/null
    local file
    for file in many*.png; do
        [ -e "$file" ] || continue
        "$GLINT" compare "$file" "$file" >/dev/null || fail "partial after SIGKILL: $file"
    done
    check "SIGKILL" test $((SECONDS - begin)) -lt 60
    find . -name '*many*' -delete
}

# ---- Identical pictures ----

same_bits() {
    mkdir -p base
    run ten.lua -o 'base/%04d.png' -t 1 --passes depth
    local want isa threads
    want=$(sums base)
    for threads in 2 7; do
        mkdir -p other
        run ten.lua -o 'other/%04d.png' -t $threads --passes depth --no-reuse
        check "$threads threads" test "$(sums other)" = "$want"
        rm -rf other
    done
    GLINT_ISA=sse2 run --version --verbose
    check "GLINT_ISA=sse2 means generic" grep -q "in use: generic" out
    for isa in ref generic avx2 avx512; do
        mkdir -p other
        GLINT_ISA=$isa run ten.lua -o 'other/%04d.png' --passes depth
        if [ "$status" -eq 2 ] && grep -q "$isa" err; then
            echo "skip: this machine has no $isa"
        else
            check "GLINT_ISA=$isa" test "$(sums other)" = "$want"
        fi
        rm -rf other
    done
    mkdir -p other
    for shard in 3 1 2; do run ten.lua --shard $shard/3 -o 'other/%04d.png' --passes depth; done
    check "3 shards are the whole" test "$(sums other)" = "$want"
    rm -rf other base
    run everything.lua -o 'a%d.pfm'
    for shard in 3 1 2; do run everything.lua --shard $shard/3 -t $shard -o 'b%d.pfm'; done
    local n
    for n in 1 2 3 4 5 6 7; do check "shards of every kind of light and surface: $n" cmp a$n.pfm b$n.pfm; done
    rm -f a*.pfm b*.pfm
    run list.lua -o 'a%d.png'
    for shard in 1 2 3 4; do run list.lua --shard $shard/4 -o 'b%d.png'; done
    for n in 1 2 3 4 5 6 7 8 9; do check "shards of a list: $n" cmp a$n.png b$n.png; done
    clean
}

# ---- compare, and plain Lua ----

comparing() {
    run ten.lua -f 1-2
    run one.lua --size 41x24
    exits 0 "compare same" compare ten_0001.png ten_0001.png
    exits 2 "compare differ" compare ten_0001.png ten_0002.png
    check "compare says a line once" test -z "$(sort out | uniq -d)"
    check "and how many pixels" test "$(grep -c 'pixels (' out)" -eq 1
    exits 1 "compare warn" compare ten_0001.png ten_0002.png --fail 1 --warn 0.001
    cat >dark.lua <<'END'
local glint = require "glint"
for _, value in ipairs { 99, 100, 102 } do
  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, background = value / 255 }
  scene:render { width = 4, height = 4, transfer = "linear", output = ("dark_%d.png"):format(value) }
end
END
    run dark.lua
    exits 2 "compare: one step apart" compare dark_99.png dark_100.png
    exits 2 "compare: half a step allowed" compare dark_99.png dark_100.png --tolerance 0.5
    exits 1 "compare: one step allowed" compare dark_99.png dark_100.png --tolerance 1
    exits 2 "compare: of three steps, two allowed" compare dark_99.png dark_102.png --tolerance 2
    exits 1 "compare: three steps allowed" compare dark_99.png dark_102.png --tolerance 3
    exits 0 "compare: nothing to tolerate" compare dark_99.png dark_99.png --tolerance 3
    exits 2 "compare: two limits" compare dark_99.png dark_100.png --tolerance 3 --fail 1
    says "compare: which limits" "--tolerance: the same limit as --fail, in steps of 8 bits; give one of them"
    exits 2 "compare: a tolerance below 0" compare dark_99.png dark_100.png --tolerance -1
    exits 3 "compare size" compare ten_0001.png one.png
    exits 4 "compare no file" compare ten_0001.png nothing.png
    exits 4 "compare no picture" compare ten_0001.png ten.lua
    exits 2 "compare one file" compare ten_0001.png
    for other in ten_0001.png ten_0002.png one.png nothing.png; do
        run compare --json ten_0001.png $other
        parsed "compare --json $other"
    done
    clean
}

# Two numbers of a pattern change separately and together, and the camera moves away and returns. Results cached while
# one number changed are used again after memory was too small for results with two changing numbers.
little_stack() {
    [[ ${PRELOAD:-}$build = *san* ]] && { echo "skip: a sanitizer needs a larger stack"; return; }
    # The deepest recursion that Lua allows in C.
    echo 'local function deep(s) return (s:gsub(".", deep)) end
assert(select(2, pcall(deep, "a")):find "stack overflow")
os.exit(7)' >deep.lua
    (ulimit -s 64 && exec "$GLINT" deep.lua >out 2>err)
    check "64 KiB of stack is an error" test $? -eq 1
    says "a small stack" "the stack is limited to 64 KiB; glint needs 80 KiB .ulimit -s 80."
    local kib
    for kib in 80 128 256 1024; do
        (ulimit -s $kib && exec "$GLINT" deep.lua -q >out 2>err)
        check "$kib KiB of stack: deep.lua" test $? -eq 7
        (ulimit -s $kib && exec "$GLINT" "$root/scripts/particle_box.lua" --size 48x36 -e 1 -o small.png -q >out 2>err)
        check "$kib KiB of stack: particle_box.lua" test $? -eq 0
    done
    (ulimit -s 80 && exec "$GLINT" endless.lua -q >out 2>err) &
    local pid=$!
    sleep 0.5
    kill -s TERM $pid
    wait $pid
    check "SIGTERM with 80 KiB of stack" test $? -eq 143
}

little_memory() {
    script knobs 'local glint = require "glint"
local a, b = { x = 0.5 }, { x = 0.3 }
local camera = glint.camera { eye = { 0, 2, 6 }, at = { 0, 0.5, 0 } }
local stone = glint.material { diffuse = glint.pattern(function(p)
  return (glint.noise(p * 3) * 0.4 + 0.5 + (glint.noise(p * 7 + 2) * 0.4 + 0.5) * b.x) * a.x
end) }
local scene = glint.scene { camera = camera, glint.point_light { position = { 3, 5, 4 } },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = stone },
  glint.sphere { center = { 0, 1, 0 }, radius = 1, material = stone } }
return glint.animation { scene = scene, width = 256, height = 192, frames = 16, frame = function(_, n)
  camera.eye = { n == 10 and 0.5 or 0, 2, 6 }
  a.x, b.x = 0.5 + 0.02 * (n < 10 and n or n - 1), n > 5 and n < 10 and 0.2 + 0.02 * n or 0.3
end }'
    mkdir -p base
    run knobs.lua -o 'base/%04d.png' -t 1 --no-reuse
    local want memory
    want=$(sums base)
    for memory in 300K 700K 1100K 1500K 1900K 2300K 4M; do
        mkdir -p other
        run knobs.lua -o 'other/%04d.png' -t 1 --reuse-memory $memory
        check "$memory for what is kept" test "$status $(sums other)" = "0 $want"
        rm -rf other
    done
    rm -rf base
}

plain_lua() {
    local module=${GLINT%/*}/glint.so
    [ -e "$module" ] || { echo "skip: no glint.so beside the command"; return; }
    export LUA_CPATH="${GLINT%/*}/?.so;;"
    script plain 'local a = dofile "ten.lua"
local r = a:run { frames = "2-3", output = "p%d.png", threads = 2 }
assert(r.frames == 2 and r.kept == 0)
assert(a:run { frames = 2, output = "p%d.png" }.kept == 1)
assert(not pcall(a.run, a, { frames = "x" }) and not pcall(a.run, a, { thread = 2 }))
assert(select(2, pcall(a.run, a, { frames = "11-" })):find "frames: no frame is selected")
assert(not pcall(a.run, a, { output = "/proc/nothing/x.png", frames = 1 }))
local image = a.scene:render { width = 8, height = 8, output = "q.png" }
assert(image.width == 8 and io.open "q.png")
assert(a.frames == 10 and a.cyclic and a.width == 40)'
    if LD_PRELOAD=${PRELOAD:-} "$LUA" plain.lua >out 2>err; then pass; else fail "plain Lua: $(head -n 3 err)"; fi
    run ten.lua -f 2 -o 'c%d.png'
    mv p3.png q.png plain_rest 2>/dev/null
    check "the same picture" "$GLINT" compare p2.png c2.png
    clean
}

for part in names selection parameters options events errors whole small_disk signals same_bits little_stack little_memory comparing plain_lua; do
    $part
    clean
done
totals
