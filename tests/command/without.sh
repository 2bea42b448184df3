#!/usr/bin/env bash
# A build without pattern programs: a scene that needs one gives an error with the script's line. All other scenes give
# the same pictures as the full build.
. tests/command/prelude.sh
GLINT=$(realpath "$build/without/PROGRAM/glint") || exit 1
cd "$work" || exit 1

# script NAME FIELD VALUE: writes a scene whose ball has that field, on line 3
script() {
    printf 'local glint = require "glint"\nlocal ball = glint.material {}\nball.%s = %s\n' "$1" "$2" >scene.lua
    printf 'return glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, %s }\n' \
        'glint.point_light { position = { 1, 2, 5 } }, glint.sphere { center = { 0, 0, 0 }, radius = 1, material = ball }' \
        >>scene.lua
}
missing='scene.lua:[0-9]+: (pattern|shader): .*built without .*\(WITHOUT=PROGRAM\)'

for field in diffuse specular mirror transmission shininess bump opacity; do
    script $field 'glint.pattern(function(p) return p.x end)'
    exits 2 "a pattern as $field" scene.lua --size 32x24 -o a.png
    says "a pattern as $field" "$missing"
done
script model 'glint.shader(function(s) return s.kd * s.light end)'
exits 2 "a shader" scene.lua --size 32x24 -o a.png
says "a shader" "$missing"
exits 2 "a background" "$root/scripts/sky.lua" --size 32x24 -f 1 -o a.png
says "a background" 'texture: .*WITHOUT=PROGRAM'
exits 2 "a texture" "$root/scripts/earth.lua" --size 32x24 -f 1 -o a.png
says "a texture" 'earth.lua:[0-9]+: .*WITHOUT=PROGRAM'
echo 'print(require("glint").pattern(function(p) return p.x end):evaluate { p = { 1, 2, 3 } })' >scene.lua
exits 2 "evaluate" scene.lua
says "evaluate" "$missing"
echo 'print(require("glint").sin(0.5), require("glint").noise(1.3, 2, 3))' >scene.lua
run scene.lua
prints "functions of numbers" '0.4794255386042'

script diffuse '"teal"'
exits 0 "a scene without programs" scene.lua --size 32x24 -o a.png
"$glint" scene.lua --size 32x24 -q -o b.png
check "is the whole build's" cmp a.png b.png
totals
