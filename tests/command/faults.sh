#!/usr/bin/env bash
# Makes each allocation and each write of some twenty commands fail, one per run. The run must succeed with the same
# bytes, or print the reason and leave no partial files (tests/faults/every.c). Tests every seventh one; STEP=1 tests
# all (make soak). Prints TAP.
set -u
root=$PWD
glint=${GLINT:-$PWD/${BUILD:-build}/glint}
if [ -n "${PRELOAD:-}" ] || ldd "$glint" | grep -qE "lib[at]san"; then
    echo "skip: a sanitizer has an allocator of its own"
    exit 77
fi
ldd "$glint" | grep -q 'libc\.so\.6' || { echo "skip: the library that fails is written for glibc"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
mkdir out
bad=0
command -v cc >/dev/null || { echo "skip: no compiler here"; exit 77; }
cc -O1 -shared -fPIC "$root/tests/faults/fail.c" -o fail.so -ldl && cc -O1 "$root/tests/faults/every.c" -o every || exit 1

# Uses a font file where there is one: FreeType continues without the parts for which it has no memory.
unset GLINT_FONT
cat >helper.lua <<'LUA'
local glint = require "glint"
local lamp = glint.point_light { position = { 3, 8, 4 } }
local gold = glint.material { diffuse = 0.6, specular = 0.4, shininess = 20 }
return { lamp = lamp, gold = gold, scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 9 }, at = { 0, 0, 0 } }, ambient = 0.1, lamp,
  glint.sphere { center = { 0, 0, 0 }, radius = 2, material = gold },
  glint.plane { point = { 0, -2, 0 }, normal = { 0, 1, 0 } } } }
LUA
cat >film.lua <<'LUA'
local glint, S = require "glint", require "helper"
local P = glint.params { tall = { 8, min = 1, max = 40, doc = "height of the lamp" } }
return glint.animation { scene = S.scene, frames = 3, width = 16, height = 12, frame = function(t)
  S.lamp.position = { 3, P.tall, 4 - t }
end }
LUA
cat >still.lua <<'LUA'
local glint, S = require "glint", require "helper"
S.scene:add(glint.label { text = "A\nB", background = "red" })
S.scene:add(glint.colorbar { map = "magma", low = 0, high = 1, title = "C" })
S.scene:add(glint.arrow { from = { -3, -1, -3 }, to = { 3, 1, -3 }, label = "D", hidden = "dashed" })
S.scene:add(glint.axes {})
S.scene:add(glint.ambient_occlusion { samples = 1 })
return glint.animation { scene = S.scene, frames = 1, width = 16, height = 12, frame = function() end }
LUA
cat >loop.lua <<'LUA'
local S = require "helper"
for i = 1, 2 do
  S.lamp.x = i
  local image = S.scene:render { width = 16, height = 12, output = "out/loop" .. i .. ".png" }
  assert(image:save("out/saved" .. i .. ".pfm"))
end
LUA
cat >sweep.lua <<'LUA'
local glint, S = require "glint", require "helper"
return glint.sweep { scene = S.scene, over = { { S.gold, "shininess", { 1, 20 } }, { S.lamp, "x", { 0, 3 } } },
  size = { 16, 12 }, sheet = { label = true } }
LUA
cat >open.lua <<'LUA'
local glint, S = require "glint", require "helper"
local P = glint.params { moves = "lamp", glow = 1 }
local camera = S.scene.camera
camera.shutter, camera.shutter_times, camera.aperture = 0.5, 2, P.moves == "lamp" and 0 or 0.1
S.scene:add(glint.difference { glint.box { min = { 2, -1, 1 }, max = { 3, 0, 2 } }, glint.torus { center = { 2, 0, 1 }, major = 0.5, minor = 0.1 } })
return glint.animation { scene = S.scene, frames = 1, width = 16, height = 12, frame = function(t)
  S.lamp.position, S.gold.specular = { 3, 8, 4 - t }, P.moves == "lamp" and 0.4 or t
end }
LUA
cat >slope.lua <<'LUA'
local glint, S = require "glint", require "helper"
local P = glint.params { glow = 1.5 }
S.lamp.intensity, S.lamp.position = P.glow, { P.glow, 8, 4 }
return S.scene
LUA
cat >knob.lua <<'LUA'
local glint, S = require "glint", require "helper"
return glint.animation { scene = S.scene, frames = 4, width = 16, height = 12, frame = function(_, n)
  S.gold.diffuse = glint.pattern(function(p) return glint.select(glint.checker(p), 0.2 * n, 0.1) end)
end }
LUA
cat >mesh.lua <<'LUA'
local glint, S = require "glint", require "helper"
S.scene:add(glint.mesh { file = "m.obj", material = glint.material { diffuse = glint.texture { file = "f_1.png" } } })
return glint.animation { scene = S.scene, frames = 1, width = 16, height = 12, frame = function() end }
LUA
printf 'v 0 0 3\nv 1 0 3\nv 0 1 3\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' >m.obj
cat >room.lua <<'LUA'
local ball = gr.nh_sphere("ball", { 0, 0, -4 }, 1)
ball:set_material(gr.material({ 0.7, 1, 0.7 }, { 0.5, 0.7, 0.5 }, 25))
local root = gr.node "root"
root:add_child(ball)
gr.render(root, "out/room.png", 8, 6, { 0, 0, 5 }, { 0, 0, -1 }, { 0, 1, 0 }, 50, { 0.3, 0.3, 0.3 },
  { gr.light({ 3, 4, 5 }, { 1, 1, 1 }, { 1, 0, 0 }) })
LUA
for part in 1 2; do "$glint" film.lua -f 1 -o part.png --region $((8 * part - 8)),0,8,12 -t 1 -q && mv part_0001.png part_$part.png; done
"$glint" open.lua -o o.png -t 1 -q --warnings none
"$glint" film.lua -o 'f_%d.png' -t 1 -q && "$glint" film.lua -o 'g_%d.png' -D tall=9 -t 1 -q || exit 1

# each KIND NAME ARGUMENT...
each() {
    local kind=$1 name=$2 said
    shift 2
    if said=$(EVERY_STEP=${STEP:-7} ./every "$kind" "$work/fail.so" "$work" "$glint" "$@"); then
        echo "ok - $kind: $name: $said"
    else
        echo "not ok - $kind: $name"
        echo "$said"
        bad=1
    fi
}
for kind in alloc write; do
    each $kind "a still" still.lua -o out/w.png -t 1 -q
    each $kind "frames and passes" film.lua -o 'out/f_%d.png' --passes diffuse,depth -t 1 -q
    each $kind "a pattern's number" knob.lua -o 'out/k_%d.png' -t 1 -q
    each $kind "a sweep with its sheet" sweep.lua -o 'out/s_%d.png' -t 1 -q
    each $kind "a shutter, a torus out of a box" open.lua -o out/o.png -t 1 -q
    each $kind "a shutter and a lens" open.lua -D moves=all -o out/o.png -t 1 -q --passes depth
    each $kind "a derivative" slope.lua -o out/d.png -t 1 -q --passes d:glow
    each $kind "a film" film.lua -o out/film.apng -t 1 -q
    each $kind "a sheet" sheet f_1.png f_2.png f_3.png -o out/sheet.png -q
    each $kind "a page" sheet f_1.png f_2.png f_3.png -o out/sheet.html -q
    each $kind "assemble" assemble f_1.png f_2.png f_3.png -o out/film.apng -q
done
for kind in alloc write; do
    each $kind "a sheet's colour bar" sheet f_1.png f_2.png -o out/sheet.png -q --colorbar magma,0,1,T
    each $kind "parts joined" join part_1.png part_2.png -o out/joined.png -q
    each $kind "a mesh, a texture" mesh.lua -o out/m.png -t 1 -q
    STEP=$((7 * ${STEP:-7})) each $kind "the dialect" --dialect gr room.lua -t 1 -q # each run compiles it again
    each $kind "an array" film.lua -f 1 -o out/n.npy -t 1 -q
    each $kind "vectors" still.lua -o out/w.svg -t 1 -q
    if "$glint" --version --verbose | grep -q cairo; then
        each $kind "letters of a page" still.lua -o out/w.pdf -t 1 -q
        each $kind "a sheet's page" sheet f_1.png f_2.png -o out/sheet.pdf -q --title 'a $\hat n$'
    fi
    if "$glint" --version --verbose | grep -q '\.exr'; then
        each $kind "channels" film.lua -f 1 -o out/c.exr --passes depth -t 1 -q
    fi
done
each alloc "kernels" --version --verbose
each alloc "a shutter again" reproduce o.png open.lua
each write "reproduce" reproduce f_2.png film.lua
each alloc "a loop, and pictures that it saves" loop.lua -t 1 -q
each alloc "reproduce" reproduce f_2.png film.lua
each alloc "explain" explain film.lua --json
each alloc "describe" describe film.lua --json
each alloc "compare" compare f_2.png f_2.png --json
exit $bad
