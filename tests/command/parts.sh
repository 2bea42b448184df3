#!/usr/bin/env bash
# --region and glint join: the joined parts are byte-identical to the whole frame, also with effects that read
# neighbouring pixels and with caches between frames. Wrong input gives a clear message.
. tests/command/prelude.sh
cd "$work" || exit 1
scene=$root/scripts/mirror_and_glass.lua
size=201x133
regions="0,0,70,50 70,0,131,50 0,50,201,33 0,83,50,50 50,83,151,50" # some edges coincide with tile borders

# joined NAME PASSES OPTION...: compares the whole frame with five joined parts
joined() {
    local name=$1 passes=$2 n=0 region pass
    shift 2
    rm -rf whole parts
    "$glint" "$scene" --size $size -q -o whole/a.png "$@" || return 1
    for region in $regions; do
        n=$((n + 1))
        "$glint" "$scene" --size $size -q -o "parts/$n.png" --region "$region" "$@" || return 1
    done
    "$glint" join parts/[0-9].png -o parts/a.png -q && cmp whole/a.png parts/a.png || return 1
    for pass in $passes; do
        "$glint" join parts/[0-9]."$pass".png -o "parts/a.$pass.png" -q && cmp "whole/a.$pass.png" "parts/a.$pass.png" ||
            return 1
    done
}
check "plain" joined plain ""
check "16 bits, and passes" joined passes "normal diffuse object_id" --bits 16 --transfer linear --passes normal,diffuse,object_id
check "outlines look at neighbours" joined outline "outline" --outline black --passes outline
check "adaptive sampling does" joined adaptive "refined" --samples 8 --adaptive 0.05 --passes refined
check "alpha, lines and small files" joined alpha "alpha" --alpha --outline white --encode small --passes alpha
check "by another instruction set and number of threads" env GLINT_ISA=generic "$glint" "$scene" --size $size -q -t 3 \
    --alpha --outline white --encode small --region 0,0,70,50 -o other.png
check "a part has the same bytes" cmp other.png parts/1.png
check "a part is kept" eval '"$glint" "$scene" --size $size --alpha --outline white --encode small --region 0,0,70,50 -o other.png \
    --json -q | grep -q "\"kept\":1"'
check "the whole is kept where join put it" eval '"$glint" "$scene" --size $size --alpha --outline white --encode small \
    --passes alpha -o parts/a.png --json -q | grep -q "\"kept\":1"'

# A moving light: parts use the caches between frames, too.
frames="scripts/moving_light.lua --size 150x90 -q -f 1-3"
check "frames of a film" "$glint" $root/$frames -o 'film/%d.png'
for region in 0,0,150,41 0,41,77,49 77,41,73,49; do
    check "their part $region" "$glint" $root/$frames --region $region -o "film/${region//,/_}_%d.png"
done
for n in 1 2 3; do
    check "frame $n of parts" "$glint" join film/*_$n.png -o film/joined.png -q
    check "is frame $n" cmp film/joined.png film/$n.png
done
# An open shutter with moving lights, then with moving objects.
# A file is not rendered again while the shutter is unchanged.
scene=$root/scripts/shutter.lua
for moves in lamp all; do
    options="-f 2 --set moves=$moves --set times=3 -o f.png --alpha --bits 16"
    check "$moves: the whole" eval '"$glint" "$scene" --size 150x90 -q $options && mv f_0002.png whole.png'
    check "$moves: other threads, kernels and nothing kept" eval 'GLINT_ISA=generic "$glint" "$scene" --size 150x90 -q $options \
        --no-reuse -t 3 && cmp f_0002.png whole.png'
    check "$moves: its parts" eval '"$glint" "$scene" --size 150x90 -q -f 2 --set moves=$moves --set times=3 --alpha --bits 16 --region 0,0,70,90 -o l.png &&
        "$glint" "$scene" --size 150x90 -q -f 2 --set moves=$moves --set times=3 --alpha --bits 16 --region 70,0,80,90 -o r.png &&
        "$glint" join l_0002.png r_0002.png -o both.png -q && cmp both.png whole.png'
    check "$moves: it is kept" eval '"$glint" "$scene" --size 150x90 -q $options --json | grep -q "\"kept\":1"'
    check "$moves: not with another shutter" eval '"$glint" "$scene" --size 150x90 -q $options --set shutter=0.7 --json |
        grep -q "\"kept\":0"'
done
check "a shutter is explained" eval '"$glint" explain "$scene" --set times=3 | grep -q "shutter  *camera: mean of 3 times"'
scene=$root/scripts/labels.lua
check "labels: their parts" eval '"$glint" "$scene" --size 160x100 -f 3 -q -o a.png && "$glint" "$scene" --size 160x100 -f 3 -q \
    --region 0,0,160,37 -o t.png && "$glint" "$scene" --size 160x100 -f 3 -q --region 0,37,160,63 -o u.png &&
    "$glint" join t_0003.png u_0003.png -o v.png -q && cmp a_0003.png v.png'
scene=$root/scripts/mirror_and_glass.lua
check "floats of a part are those of the whole" eval '"$glint" "$scene" --size 40x30 -q -o w.pfm --passes depth &&
    "$glint" "$scene" --size 40x30 -q -o p.pfm --passes depth --region 0,0,40,30 && cmp w.pfm p.pfm && cmp w.depth.pfm p.depth.pfm'
cat >say.lua <<'END'
local glint = require "glint"
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1, glint.sphere { center = { 0, 0, 0 }, radius = 2 } }
local image = scene:render { width = 40, height = 30, region = { 10, 5, 7, 3 } }
print(image.width, image.height)
END
exits 0 "a region in a script" say.lua
prints "its image" '^7	3$'

# ---- Wrong input ----

exits 2 "a hole" join parts/[1-4].png -o hole.png
says "a hole is named" 'join: parts: no part has pixel 50, 83 of 201 x 133'
check "and nothing is written" test ! -e hole.png
exits 2 "a whole picture" join parts/1.png whole/a.png -o hole.png
says "is no part" 'whole/a.png: expected a .png rendered with --region'
"$glint" "$scene" --size $size -q --region 0,0,9,9 -o stranger.png
exits 2 "a part of another picture" join parts/1.png stranger.png -o hole.png
says "is named" 'stranger.png and parts/1.png are parts of different frames'
exits 2 "no parts" join -o hole.png
exits 2 "no output" join parts/1.png
says "output expected" 'join: -o NAME.png expected'
exits 2 "one of the parts" join parts/[1-5].png -o parts/1.png
exits 2 "a region outside" "$scene" --size $size --region 200,0,2,1 -o none
says "the frame is named" 'region: whole numbers x, y, width and height within the frame of 201 x 133 expected, got 200, 0, 2, 1'
for wrong in 1,2,3 1,2,3,4,5 -1,0,2,2 0,0,0,1 0,0,1.5,1 a 0,0,1,1x; do
    exits 2 "--region $wrong" "$scene" --region "$wrong" -o none
done
says "what is expected" "--region: region X,Y,WIDTH,HEIGHT in whole pixels from the top left expected, got '0,0,1,1x'"
exits 2 "a scaled depth" "$scene" --size $size --region 0,0,9,9 --passes depth -o d.png
says "why" 'depth in a .png is scaled'
exits 2 "--region of another command" join parts/1.png --region 0,0,1,1 -o x.png
totals
