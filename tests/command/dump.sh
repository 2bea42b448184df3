#!/usr/bin/env bash
# glint dump: the script of a frame renders the bits of the frame, for every kind of object and for scripts of the tree.
. tests/command/prelude.sh
cd "$work" || exit 1
small=(--size 48x36 --samples 2 --passes none)

# same NAME SCRIPT FRAME [OPTIONS]: dumps the frame, and compares the light of both
same() {
    local name=$1 script=$2 frame=$3
    shift 3
    rm -f dumped.lua first*.pfm second.pfm
    exits 0 "$name: dump" dump "$script" --frame "$frame" "${small[@]}" "$@" -o dumped.lua
    exits 0 "$name: its script" "$script" -f "$frame" "${small[@]}" "$@" --warnings none -q -o first%d.pfm
    exits 0 "$name: the dumped script" dumped.lua --warnings none -q -o second.pfm
    check "$name: the same light" cmp "first$frame.pfm" second.pfm
}
# refused NAME PATTERN SCRIPT: the dump must fail with this message, and write nothing
refused() {
    exits 1 "$1" dump "$3" -o refused.lua
    says "$1" "$2"
    check "$1: nothing is written" test ! -e refused.lua
}

cat >kinds.lua <<'LUA'
local glint = require "glint"
local gold = glint.material { model = "cook_torrance", roughness = 0.25, diffuse = { 0, 0, 0 }, f0 = { 1, 0.7, 0.3 }, name = "gold" }
local red = glint.material { diffuse = { 0.8, 0.1, 0.1 }, specular = 0.4, shininess = 33, name = "end" }
local glass = glint.material { diffuse = 0, transmission = 0.9, fresnel = true, absorption = { 0.1, 0.2, 0.3 } }
local wood = glint.material {
  diffuse = glint.pattern(function(p, s)
    local cell = glint.cell(p * 3)
    local v = glint.noise3(p * 2)
    return glint.mix({ 0.9, 0.6, 0.2 }, { 0.3, 0.1, v.x * v.x }, glint.fract(cell + 4 * glint.noise(p) + 0.1 * s.n.y * p.x * p.z))
  end),
  bump = glint.pattern(function(p) return 0.02 * glint.sin(30 * p.x) end),
  opacity = glint.pattern(function(p) return glint.select(glint.less(p.y, 2.5), 1, 0) end),
}
local toon = glint.material { model = glint.shader(function(s)
  return s.kd * s.light * glint.step(0.3, s.n:dot(s.l)), 0.2 * s.ks * glint.max(0, s.n:dot(s.v)) ^ s.shininess
end), diffuse = { 0.2, 0.5, 0.9 }, specular = 0.5 }
local shared = glint.torus { center = { 0, 0, 0 }, major = 0.7, minor = 0.2, axis = { 0, 1, 1 }, material = toon }
local corners = {}
for i = 1, 12 do corners[i] = { glint.sin(i * 1.7) + 0.1, glint.cos(i * 0.6), 0.3 + i / 12 } end
local third, lamp = 1 / 3, glint.sphere_light { position = { 3, 6, 4 }, radius = 1, samples = 4, name = "lamp", intensity = 0.4 }
local scene = glint.scene {
  camera = glint.camera { eye = { 1, 4, 14 }, at = { 0, 1, third }, fov = 37.123456789, name = "eye", aperture = 0.05, focus = { 0, 1, 0 } },
  ambient = { 0.1, 0.12, third }, background = { 0.2, 0.3, 0.4 },
  depth_cue = { color = { 0.3, 0.3, 0.4 }, near = 8, far = 60 },
  ambient_occlusion = { samples = 2, distance = 2 },
  glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0.01 }, material = glint.material { diffuse = 0.5, mirror = 0.2 } },
  glint.sphere { center = { -4, 0, 0 }, radius = third * 3.1, material = gold },
  glint.box { min = { -2.5, -1, -1 }, max = { -1, 0.5, 1 }, material = wood, transform = glint.rotate("y", 33.3) * glint.translate(third, 0, 0) },
  glint.disk { center = { 0, 0, -1 }, normal = { 0.1, 0.2, 1 }, radius = 0.8, material = red },
  glint.cylinder { base = { 1, -1, 0 }, top = { 1.5, 1, 0 }, radius = 0.3, capped = false, material = red },
  glint.cone { base = { 2.4, -1, 0 }, top = { 2.4, 1, 0 }, radius = 0.5, material = glass },
  glint.group { shared, transform = glint.translate(4, 0, 0), name = "ring" },
  glint.group { shared, glint.group { shared, transform = glint.scale(0.5) }, transform = glint.translate(-4, 2.5, 0) },
  glint.difference { glint.box { min = { 0, 2, -1 }, max = { 1.5, 3.5, 1 } }, glint.sphere { center = { 0.7, 3, 1 }, radius = 0.6, material = red },
    glint.union { glint.sphere { center = { 0, 2, 0 }, radius = 0.3 }, glint.sphere { center = { 0.2, 2, 0 }, radius = 0.3 } }, material = gold },
  glint.spheres { data = { -1, 2, 0, 0.3, 0, 2.5, 0, third, -0.6, 3, 0, 0.2 }, materials = { red, gold }, index = { 1, 2, 1 } },
  glint.cylinders { data = { -2, 2, 0, -2, 3, 0, 0.2, -2.5, 2, 0, -2.4, 3, 0.4, third }, capped = false, material = red },
  glint.mesh { vertices = corners, faces = { { 1, 2, 3, 4 }, { 5, 6, 7 }, { 8, 9, 10 } }, shading = "flat", transform = glint.translate(2, 2, 2),
    materials = { red, gold }, index = { 2, 1, 1 } },
  glint.mesh { vertices = corners, faces = { 1, 2, 3, 1, 4, 5, 6, 7, 8 }, shading = "gouraud", material = red, transform = glint.translate(-3, 2, 2) },
  glint.mesh { vertices = corners, faces = { 1, 2, 3, 1, 4, 5, 6, 7, 8 }, normals = { 0.3, 0.1, 1, 0.2, 0.1, 1, 0.17, 0.3, 1, 0.3, 0.1, 1, 0.2, 0.1, 1,
    0.11, 0.3, 1, 0.3, 0.1, 1, 0.2, 0.19, 1, 0.123, 0.3, 1 }, uv = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, third }, { 0, 0 }, { 1, 1 }, { 0, 0 }, { 1, 0 }, { 1, 1 } },
    material = glint.material { diffuse = glint.pattern(function(_, s) return { s.uv.x, s.uv.y, 0.2 } end) }, terminator = 0.5, transform = glint.translate(0, 4, 0) },
  glint.sphere_mesh { center = { 5, 3, 0 }, radius = 0.9, segments = 14, material = gold },
  lamp,
  glint.point_light { position = { 1, 9, 3 }, color = { 0.9, 0.8, 0.7 }, intensity = 0.1, attenuation = { 1, 0, 0.001 } },
  glint.directional_light { direction = { -1, -2, -1 }, intensity = 0.1, shadows = false },
  glint.spot_light { position = { 0, 8, 6 }, direction = { 0, -1, -0.7 }, inner = 11.1, outer = 23.45, intensity = 0.5 },
  glint.disk_light { position = { -3, 7, 2 }, normal = { 0.3, -1, 0 }, radius = 0.5, intensity = 0.2, samples = 2, group = "sky" },
  glint.polygon_light { vertices = { { 0, 7, 0 }, { 1, 7, 0 }, { 1, 7.5, 1 }, { 0, 7.5, 1 } }, intensity = 0.2, samples = 2 },
}
return { scene = scene, lamp = lamp, red = red }
LUA
cat >all.lua <<'LUA'
require("glint")
require("kinds").scene:render { width = 64, height = 48, samples = 3, exposure = 0.5, output = "all.npy" }
LUA
same "every kind of shape and light" all.lua 1
check "names stay" grep -q '^local gold = glint.material' dumped.lua
check "a word of Lua is no name" grep -q '^local _end = glint.material' dumped.lua
check "the kind of picture stays" grep -q 'output = "dumped.npy"' dumped.lua
check "a shared shape is written once" test "$(grep -c 'glint.torus' dumped.lua)" -eq 1
rm -f again.lua
exits 0 "a dump of a dump" dump dumped.lua -o again.lua
check "is the same script" diff <(sed 1d dumped.lua | sed 's/dumped/again/') <(sed 1d again.lua)

cat >moving.lua <<'LUA'
local glint, S = require "glint", require "kinds"
local plain = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } } }
S.scene:add(glint.label { text = "a \"b\"\n\\c", at = "top left", size = 8 })
S.scene:add(glint.label { text = "x", position = { 3, 4 } })
S.scene:add(glint.label { text = "y", at_point = { 1, 2, 1 / 3 }, hidden = "none" })
S.scene:add(glint.axes { box = { { -1, -1, -1 }, { 1, 1, 1 } } })
S.scene:add(glint.axes { length = 1 })
S.scene:add(glint.arrow { from = { 0, 0, 0 }, to = { 1, 2, 0 }, label = "v" })
S.scene:add(glint.arc { at = { 0, 0, 0 }, from = { 1, 0, 0 }, to = { 0, 1, 0 }, radius = 1 })
S.scene:add(glint.polyline { points = { { 0, 0, 0 }, { 1, 1, 3 }, { 2, 0, 1 } }, color = "red" })
S.scene:add(glint.lobe { point = { 0, 0, 0 }, material = S.red, to_light = { 1, 1, 0 }, normal = { 0, 1, 0 } })
S.scene:add(glint.path { origin = { 0, 3, 9 }, direction = { 0, -0.3, -1 } })
S.scene:add(glint.frustum { camera = plain.camera, distance = 2 })
S.scene:add(glint.colorbar { map = "viridis", low = 0, high = 1, title = "t" })
S.scene:add(glint.colorbar { map = { "#102030", "#fedcba" }, low = 1, high = 100, scale = "log", at = "bottom" })
S.scene:add(glint.chart { series = { { label = "f", x = { 1, 2, 3 }, y = { 1, 4, 1 / 3 }, dots = true } }, at = "top right" })
return { glint.animation { scene = S.scene, frames = 3, frame = function(t) S.lamp.position = { 3 * t, 6, 4 } end },
  glint.sweep { scene = S.scene, over = { { S.lamp, "intensity", { 0.1, 0.7 } } } } }
LUA
same "a frame of an animation" moving.lua 2
same "a frame of a sweep" moving.lua 5
cat >overlays.lua <<'LUA'
local jobs = require "moving"
return jobs[1]
LUA
exits 0 "overlays: dump" dump overlays.lua --frame 3 --size 160x120 -o figures.lua
exits 0 "overlays: the script" overlays.lua -f 3 --size 160x120 --warnings none -q -o one%d.png
exits 0 "overlays: the dumped script" figures.lua --warnings none -q -o two.png
exits 0 "overlays: the same pixels" compare one3.png two.png

cat >many.lua <<'LUA'
local glint = require "glint"
local x = glint.variable("x", 0.3)
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 40 }, at = { 0, 0, 0 } }, background = glint.pattern(function(p) return 0.3 + 0.2 * p.y end),
  glint.directional_light { direction = { -1, -1, -1 } } }
for i = 1, 300 do
  scene:add(glint.sphere { center = { i % 20 - 10, i // 20 - 7, 0 }, radius = 0.4, material = glint.material { diffuse = { x, i / 300, 0 } } })
end
scene:render { width = 48, height = 36, passes = arg[1] and { arg[1] } or {} }
LUA
same "more objects than local variables, numbers with derivatives" many.lua 1
same "options of the frame" all.lua 1 --max-depth 2 --clamp 3 --seed 7
run dump many.lua
cp out printed.lua
exits 0 "a dump on standard output is a script" printed.lua --size 8x6 -q -o printed.png

for item in lights:1 combined:1 wood_and_marble:1 shading:1 labels:1 molecule:1 toon_teapot:1 vectors:1; do
    same "scripts/${item%:*}.lua" "$root/scripts/${item%:*}.lua" "${item#*:}"
done
same "a dialect" "$root/scripts/gr_scene.lua" 1 --dialect gr 2>/dev/null

# Every message names the object and the field.
cat >textures.lua <<'LUA'
local glint = require "glint"
local photo = glint.texture { file = "photo.png", wrap = "clamp", filter = "nearest" }
local ball = glint.material { name = "ball", diffuse = arg[1] and glint.pattern(function(_, s) return photo(s.uv) end) or photo }
glint.scene { camera = glint.camera { eye = { 0, 0, 4 }, at = { 0, 0, 0 } }, ambient = 1, background = photo,
  glint.sphere { center = { 0, 0, 0 }, radius = 1, material = ball } }:render { width = 8, height = 8 }
LUA
exits 0 "a picture" many.lua --size 16x8 -q -o photo.png
same "textures" textures.lua 1
exits 1 "a texture in a pattern" dump textures.lua -o no.lua -- pattern
says "a texture in a pattern" 'textures\.lua:[45]: dump: ball\.diffuse: a pattern that reads a texture has no text in Lua'
exits 1 "a derivative" dump many.lua -o no.lua -- d:x
says "a derivative" 'dump: passes: "d:x" is a derivative, and the script has no variables; use --passes without it'
refused "a texture of a mesh's file" 'tiles\.diffuse: a texture that the file of a mesh names has no text' "$root/scripts/model.lua"
cat >blurred.lua <<'LUA'
local glint = require "glint"
local ball = glint.sphere { center = { 0, 0, 0 }, radius = 1 }
return glint.animation { frames = 2, scene = glint.scene { ball, camera = glint.camera { eye = { 0, 0, 4 }, at = { 0, 0, 0 }, shutter = 0.5 } },
  frame = function(t) ball.center = { t, 0, 0 } end }
LUA
refused "an open shutter" 'camera\.shutter: the frame shows several moments' blurred.lua

exits 2 "no script" dump
says "no script" 'script'
exits 2 "a script that does not exist" dump none.lua
exits 2 "no such frame" dump moving.lua --frame 6 -o no.lua
says "no such frame" "--frame: expected a frame of the script, 1 \.\. 5, got '6'"
exits 2 "several frames" dump moving.lua -f 1-2
says "several frames" '--frames: expected one frame, such as -f 7'
run dump moving.lua --frame 5
cp out by_frame
exits 0 "a frame by its letter" dump moving.lua -f 5
check "is the same" cmp out by_frame
exits 2 "a frame that is no number" dump moving.lua --frame x
exits 2 "a file that exists" dump all.lua -o again.lua
says "a file that exists" 'again\.lua: it exists already and was not changed'
exits 2 "a picture's name" dump all.lua -o x.png
says "a picture's name" "--output: expected the name of a \.lua script, got 'x\.png'"
mkdir -p folder.lua
exits 2 "a folder" dump all.lua -o folder.lua
exits 1 "a file as a folder" dump all.lua -o all.lua/x.lua
exits 2 "events without a file" dump all.lua --json
exits 0 "events" dump all.lua --json -o events.lua
prints "events" '^\{"event":"dump","script":"all\.lua","file":"events\.lua"\}$'
check "nothing else is written" test ! -e no.lua
totals
