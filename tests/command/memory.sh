#!/usr/bin/env bash
# Memory leaks: the memory of a run must not grow with the number of scenes, meshes and frames that it has released. A
# script reads the resident bytes of its own process after a full collection. The test compares the minimum of the
# second tenth of the rounds with the minimum of the last tenth (memory cached by malloc varies
# by a megabyte). Prints TAP.
set -u
glint=${GLINT:-$PWD/${BUILD:-build}/glint}
if [ -n "${PRELOAD:-}" ] || ldd "$glint" | grep -qE "lib[at]san"; then
    echo "skip: a sanitizer keeps what was freed"
    exit 77
fi
[ -r /proc/self/statm ] || { echo "skip: no /proc/self/statm"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
bad=0

# grows NAME MOST OPTION...: scene.lua prints its growth in bytes; more than MOST is a failure
grows() {
    local name=$1 most=$2 grown
    shift 2
    grown=$("$glint" scene.lua -t 1 -q "$@" 2>err </dev/null)
    if [ "${grown:-none}" != none ] && [ "$grown" -le "$most" ]; then echo "ok - $name ($grown bytes more)"; else
        echo "not ok - $name: at most $most bytes more expected, got '$grown'"
        cat err
        bad=1
    fi
}
# script COUNT LINE...: writes a script of COUNT rounds with the measuring code, then the lines
script() {
    cat >scene.lua <<LUA
local glint = require "glint"
local rounds = $1
local step, early, late = math.max(rounds // 100, 1), math.huge, math.huge
local function measure(i)
  local first, last = i > rounds // 10 and i <= rounds // 5, i > rounds - rounds // 10
  if not (first or last) or i % step ~= 0 then return end
  collectgarbage() collectgarbage()
  local file = io.open "/proc/self/statm"
  local _, pages = file:read("n", "n")
  file:close()
  if first then early = math.min(early, pages) else late = math.min(late, pages) end
  if i == rounds then print((late - early) * 4096) end
end
LUA
    shift
    printf '%s\n' "$@" >>scene.lua
}

# Materials without a highlight, shapes that no frame shows, groups: everything that warnings track.
script 20000 'for i = 1, rounds do' \
    '  local dull = glint.material { diffuse = 0.5, shininess = 64 }' \
    '  local box = glint.box { min = { 0, 0, 0 }, max = { 1, 1, 1 }, material = dull }' \
    '  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 0.1,' \
    '    glint.point_light { position = { 0, 8, 4 } }, glint.sphere { center = { i, 0, 30 }, radius = 1 },' \
    '    glint.sphere { center = { 0, 0, i % 7 }, radius = 1, material = dull }, glint.group { box } }' \
    '  scene:render { width = 4, height = 4 }' '  measure(i)' 'end'
grows "20,000 scenes" 1000000 -o none
grows "20,000 scenes without warnings" 1000000 -o none --warnings none

script 60 'for i = 1, rounds do' \
    '  local ball = glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 128, shading = "phong" }' \
    '  local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 0.1, ball }' \
    '  scene:render { width = 16, height = 16 }' '  measure(i)' 'end'
grows "60 meshes" 8000000 -o none

script 20000 'local lamp = glint.point_light { position = { 0, 8, 4 } }' \
    'local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 0.1, lamp,' \
    '  glint.sphere { center = { 0, 0, 0 }, radius = 1 } }' \
    'return glint.animation { scene = scene, frames = rounds, width = 4, height = 4, frame = function(t, n)' \
    '  lamp.position = { 9 * glint.cos(6 * t), t - 0.5, 4 }' '  measure(n)' 'end }'
grows "20,000 frames" 1000000 -o none

# The cache between frames takes at most --reuse-memory. The script chooses among a few values at random, so that values
# return. Its peak memory is compared with the peak of a run without reuse. 24 MB are less than the hits and lights of
# three pictures. A fixed mmap threshold makes glibc return freed blocks to the system: without it, fragmentation adds 0
# to 8 MB to the peak, by chance.
cat >walk.lua <<'LUA'
local glint = require "glint"
local state = 7
local function draw(n) state = state * 48271 % 0x7fffffff; return state % n end
local red = glint.material { diffuse = { 0.8, 0.2, 0.2 }, specular = 0.5 }
local lamp, eye = glint.point_light { position = { 0, 9, 3 } }, glint.camera { eye = { 0, 3, 10 }, at = { 0, 0, 0 } }
local scene = glint.scene { camera = eye, lamp, glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 } } }
for i = 1, 200 do scene:add(glint.sphere { center = { i % 20 - 10, 0, -(i // 20) }, radius = 0.4, material = red }) end
for _ = 1, 60 do
  local what = draw(4)
  if what == 0 then eye.fov = 40 + draw(3) elseif what == 1 then lamp.x = draw(4) else red.shininess = 5 + draw(3) end
  scene:render { width = 640, height = 480 }
end
local file = io.open "/proc/self/status"
print(1024 * file:read "a":match "VmHWM:%s*(%d+)")
LUA
export GLIBC_TUNABLES=glibc.malloc.mmap_threshold=65536
fresh=$("$glint" walk.lua -t 1 -q -o none --no-reuse)
for most in 24 48; do
    peak=$("$glint" walk.lua -t 1 -q -o none --reuse-memory ${most}M)
    if [ $((peak - fresh)) -le $((most << 20)) ]; then echo "ok - $most MB for later frames ($((peak - fresh)) bytes more)"; else
        echo "not ok - $most MB for later frames: $((peak - fresh)) bytes more"
        bad=1
    fi
done
unset GLIBC_TUNABLES

# Spheres given as data, four doubles each, take at most six times that at the peak of a run, compared with a run with
# one sphere: with their BVH, and with the grid that a light has in a large picture.
cat >write.lua <<'LUA'
local glint = require "glint"
local file, state = io.open("spheres", "wb"), 1
local function random()
  state = state * 48271 % 0x7fffffff
  return state / 0x7fffffff
end
for _ = 1, 300000 do
  file:write(string.pack("<dddd", 67 * random(), 67 * random(), 67 * random(), 0.2 + 0.2 * random()))
end
file:close()
glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } } }:render { width = 4, height = 4 }
LUA
cat >read.lua <<'LUA'
local glint = require "glint"
local P = glint.params { count = { 1, min = 1, max = 300000, doc = "spheres" }, width = { 64, min = 64, max = 1600, doc = "pixels" } }
local scene = glint.scene { camera = glint.camera { eye = { -30, 80, 130 }, at = { 33, 22, 33 } }, ambient = 0.1,
  glint.point_light { position = { 13, 134, 80 } }, glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 } } }
do
  local file = io.open("spheres", "rb")
  scene:add(glint.spheres { data = file:read(32 * P.count), format = "f64" })
  file:close()
end
collectgarbage() collectgarbage()
scene:render { width = P.width, height = P.width * 9 // 16 }
LUA
# peak COUNT WIDTH: the peak memory, in bytes, of a run with COUNT spheres
peak() { "$glint" read.lua --set count="$1" --set width="$2" -t 1 --json -o none 2>err </dev/null | grep -o '"peak_bytes":[0-9]*' | cut -d: -f2; }
"$glint" write.lua -t 1 -q -o none
for width in 64 1600; do
    one=$(peak 1 "$width")
    all=$(peak 300000 "$width")
    if [ -n "$one" ] && [ -n "$all" ] && [ $((all - one)) -le $((6 * 32 * 300000)) ]; then
        echo "ok - 300,000 spheres take $((all - one)) bytes at the peak of a picture of width $width"
    else
        echo "not ok - 300,000 spheres, width $width: at most $((6 * 32 * 300000)) bytes at the peak expected," \
            "got '$one' for one and '$all' for all"
        cat err
        bad=1
    fi
done
exit $bad
