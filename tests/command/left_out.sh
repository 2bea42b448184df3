#!/usr/bin/env bash
# A build without effects: the core renders spheres and planes with the bits of the full build, and a scene that asks
# for an effect gets an error that names it.
. tests/command/prelude.sh
GLINT=$(realpath "$build/without/effects/glint") || exit 1
cd "$work" || exit 1

# same NAME SCRIPT OPTIONS...: the first frame is the full build's
same() {
    local name=$1
    shift
    exits 0 "$name" "$@" -f 1 -q -o a.pfm
    mv a*.pfm core.pfm
    "$glint" "$@" -f 1 -q -o a.pfm
    check "$name is the full build's" cmp core.pfm a*.pfm
    rm -f ./*.pfm
}
same "the workshop" "$root/scripts/workshop.lua" --size 160x90
same "several samples" "$root/scripts/moving_light.lua" --size 96x64 --samples 4
same "adaptive sampling" "$root/scripts/workshop.lua" --size 96x64 --samples 4 --adaptive 1
same "an area light" "$root/scripts/soft_shadows.lua" --size 96x64
same "float" "$root/scripts/workshop.lua" --size 96x64 --precision float
same "a pattern" "$root/scripts/wood_and_marble.lua" --size 96x64

# refused EFFECT NAME SCENE MATERIAL OPTIONS...: the fields SCENE of the scene or MATERIAL of its ball ask for it
refused() {
    local effect=$1 what=$2 scene=$3 material=$4
    shift 4
    cat >scene.lua <<LUA
local glint = require "glint"
local ball = glint.material { $material }
return glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, $scene
  glint.point_light { position = { 1, 2, 5 } }, glint.sphere { center = { 0, 0, 0 }, radius = 1, material = ball } }
LUA
    exits 2 "$effect" scene.lua --size 32x24 -o a.png "$@"
    says "$effect" "this build has no $what.* \\(WITHOUT=$effect\\)"
    check "$effect is in the full build" "$glint" scene.lua --size 32x24 -q -o a.png "$@"
    rm -f ./*.png
}
refused bounce mirrors '' 'mirror = 0.5'
refused bounce 'mirrors and transparent' '' 'transmission = 0.5'
refused bounce mirrors '' 'opacity = 0.5'
refused bump bumps '' 'bump = glint.pattern(function(p) return p.x end)'
refused cut_out cut-outs '' 'opacity = glint.pattern(function(p) return p.x end)'
refused depth_cue 'light that fades' 'depth_cue = { near = 1, far = 9 },' ''
refused environment 'pattern or texture' 'background = glint.pattern(function(p) return glint.abs(p.x) end),' ''
refused indirect 'indirect light' 'indirect = { samples = 4, bounces = 1 },' ''
refused indirect 'indirect light' 'ambient = 1, ambient_occlusion = { samples = 4 },' ''
refused microfacet microfacets '' 'model = "cook_torrance", specular = 1'
refused outline outlines '' '' --outline black
refused raster 'scan conversion' '' '' --visibility scan
refused vertex_shading 'flat and Gouraud' 'glint.sphere_mesh { center = { 0, 2, 0 }, radius = 1, segments = 8, shading = "flat" },' ''
refused visible_light 'visible lights' 'glint.sphere_light { position = { 0, 2, 0 }, radius = 0.5, visible = true },' ''

cat >scene.lua <<'LUA'
local glint = require "glint"
local P = glint.params { glow = { 0.5, min = 0, max = 1 } }
return glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, ambient = P.glow,
  glint.sphere { center = { 0, 0, 0 }, radius = 1 } }
LUA
exits 2 "derivative" scene.lua --size 32x24 -o a.png --passes d:glow
says "derivative" 'this build has no derivatives \(WITHOUT=derivative\)'
cat >rays.lua <<'LUA'
local glint = require "glint"
local gold = glint.material { model = "cook_torrance", f0 = { 1, 0.8, 0.3 } }
local seen = gold:evaluate { normal = { 0, 0, 1 }, to_light = { 0, 1, 1 }, to_eye = { 0, 0, 1 } }
return glint.scene { camera = glint.camera { eye = { 0, 3, 5 }, at = { 0, 0, 0 } }, background = seen.specular,
  glint.point_light { position = { 1, 2, 5 } }, glint.sphere { center = { 0, 0, 0 }, radius = 1 },
  glint.path { origin = { -4, 0.5, 1 }, direction = { 4, -0.5, -1 } } }
LUA
exits 0 "a path and a metal's highlight" rays.lua --size 96x64 -q -o core.png
"$glint" rays.lua --size 96x64 -q -o full.png
check "a path and a metal's highlight are the full build's" "$glint" compare core.png full.png --fail 0 --warn 0
exits 2 "shutter" "$root/scripts/shutter.lua" --size 32x24 -f 1 -o a.png --set moves=lamp
says "shutter" 'this build has no shutter \(WITHOUT=shutter\)'
totals
