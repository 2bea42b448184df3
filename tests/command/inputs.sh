#!/usr/bin/env bash
# Hostile inputs: endless files, files that block their reader, and files that claim a larger size than they have.
# glint must refuse them quickly and with little memory, everywhere it reads a file.
. tests/command/prelude.sh
cd "$work" || exit 1
seconds=5
memory_kib=400000 # limit of address space: far more than a picture needs, far less than the files below claim

mkfifo pipe pipe.png pipe.pfm pipe.obj pipe.stl pipe.ply
mkdir folder folder.png folder.pfm folder.obj folder.stl folder.ply
for kind in png pfm obj stl ply; do
    ln -s /dev/zero device.$kind
    truncate -s 20G huge.$kind
done
truncate -s 20G huge.xyz
cat >scene.lua <<'LUA'
local glint = require "glint"
return glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1,
  glint.sphere { center = { 0, 0, 0 }, radius = 2 } }
LUA
"$glint" scene.lua --size 8x8 -o good.png -q && "$glint" scene.lua --size 8x8 -o good.pfm -q
head -c 60 good.png >begun.png && truncate -s 15G begun.png
head -c 12 good.pfm >begun.pfm && truncate -s 15G begun.pfm
ply='ply\nformat binary_little_endian 1.0\nelement vertex %s\nproperty float x\nproperty float y\nproperty float z\nelement face 2'
ply="$ply\nproperty list uchar int vertex_indices\nend_header\n"
# shellcheck disable=SC2059 # the format is the head of the file
printf "$ply" 1000000000 >begun.ply && truncate -s 15G begun.ply
# shellcheck disable=SC2059
printf "$ply" 4000000000 >claims.ply
{ head -c 80 /dev/zero && printf '\1\2\3\4'; } >claims.stl

# Limits the memory of a run, except under a sanitizer, which maps terabytes.
limited() {
    if [[ $build = *-asan ]]; then "$@"; else (ulimit -v $memory_kib && exec "$@"); fi
}
# refused NAME PATTERN ARGUMENTS...: expects an error that matches, within a time limit
refused() {
    local name=$1 pattern=$2
    shift 2
    limited timeout $seconds "$glint" "$@" >out 2>err </dev/null
    local code=$?
    [ $code -gt 0 ] && [ $code -lt 100 ] && grep -qE -- "$pattern" err
    result $? "$name: exit $code"
}
# script NAME PATTERN LINE...: runs a script with these lines
script() {
    local name=$1 pattern=$2
    shift 2
    printf '%s\n' "$@" >try.lua
    refused "$name" "$pattern" try.lua -o none
}

for kind in png pfm; do
    refused "compare with a device, .$kind" "device.$kind: a file expected, got a device" compare good.$kind device.$kind
    refused "compare with a pipe, .$kind" "pipe.$kind: a file expected, got a pipe" compare pipe.$kind good.$kind
    refused "compare with a folder, .$kind" "folder.$kind: Is a directory" compare good.$kind folder.$kind
    refused "compare with a huge file, .$kind" "huge.$kind: not a " compare good.$kind huge.$kind
    refused "compare with what only begins as a picture, .$kind" "begun.$kind: larger than [0-9]+ bytes" compare begun.$kind good.$kind
done
for bad in device pipe folder huge begun; do
    refused "a sheet of a $bad" "$bad.png: " sheet good.png $bad.png -o sheet.png
    refused "a page of a $bad" "$bad.png: " sheet good.png $bad.png -o sheet.html
    refused "a film of a $bad" "$bad.png: " assemble good.png $bad.png -o film.apng
    refused "reproduce of a $bad" "$bad.png: " reproduce $bad.png scene.lua
    script "a texture of a $bad" "$bad.png: " 'local glint = require "glint"' "return glint.texture { file = '$bad.png' }"
done
if "$glint" --version --verbose | grep -q OpenEXR; then
    for bad in device.png pipe folder; do
        refused "relight $bad" "relight: $bad: (a file expected, got a (pipe|device)|Is a directory)" relight $bad -o lit.png
    done
    exits 2 "relight a pipe" relight pipe -o lit.png
else
    echo "skip: relight without OpenEXR"
fi
exits 2 "a sheet of a pipe" sheet good.png pipe.png -o sheet.png
if "$glint" --version --verbose | grep -q FreeType; then
    GLINT_FONT=pipe.png refused "a font that is a pipe" "GLINT_FONT: expected the file of a scalable font" "$root/scripts/labels.lua" -o none
else
    echo "skip: fonts without FreeType"
fi
for bad in device pipe folder huge; do
    for kind in obj stl ply; do
        script "a mesh of a $bad, .$kind" "$bad.$kind:(1:)? " 'local glint = require "glint"' "return glint.mesh { file = '$bad.$kind' }"
    done
done
for kind in stl ply; do
    script "a mesh that is not as large as it says, .$kind" "claims.$kind: .*expected, got" 'require("glint").mesh { file = "claims.'$kind'" }'
done
# This file has all the vertices that it claims, all at one point. Reading ends when the memory limit is reached, which
# takes seconds in a build without optimization. A sanitizer's build has no memory limit.
[[ $build = *-asan ]] || seconds=60 script "a mesh that only begins" "begun.ply: |out of memory" 'require("glint").mesh { file = "begun.ply" }'
printf 'mtllib %s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n' device.png >named.obj
printf 'mtllib good.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n' >painted.obj
for bad in device.png pipe folder huge.png; do
    sed "s/device.png/$bad/" named.obj >mesh.obj
    script "a mesh with materials in $bad" "mesh.obj: some of its materials are missing: $bad:(1:)? " 'require("glint").mesh { file = "mesh.obj" }' \
        'error "read"'
    printf 'newmtl a\nmap_Kd %s\n' "$bad" >good.mtl
    script "a mesh with the picture $bad" "painted.obj: material 'a' has its Kd instead of its map_Kd: $bad: " \
        'require("glint").mesh { file = "painted.obj" }' 'error "read"'
done
export LUA_PATH="$root/scripts/lib/?.lua;;"
for reader in xyz pdb lammps points; do
    for bad in pipe folder /dev/zero; do
        script "glint.$reader of $bad" "$bad: a file expected, got a (pipe|folder|device)" "require 'glint.$reader'.frame('$bad')"
    done
    script "glint.$reader of a huge file" 'huge.xyz:1: a line of at most 1048576 bytes expected' \
        "for _ in require 'glint.$reader'.frame('huge.xyz'):atoms() do end"
done
script "glint.nff of a pipe" "pipe: a file expected, got a pipe" "require 'glint.nff'.load 'pipe'"
for bad in pipe device.obj folder.obj huge.obj; do
    echo "gr.mesh('m', '$bad')" >course.lua
    refused "a course's scene with the model $bad" "'$bad': no such file|huge.obj: a model of at most" --dialect gr course.lua
done

# ---- The script itself ----

for bad in pipe folder /dev/zero huge.xyz; do
    for command in render explain describe cost; do
        refused "$command $bad" "(a script expected, got a (pipe|folder|device)|unexpected symbol)" $command "$bad"
    done
done
refused "a picture for a script" "good.png: a script expected, got a PNG .glint reproduce good.png renders it again" good.png
printf '\033Lua' >compiled.lua
refused "compiled Lua for a script" "compiled.lua: a script expected, got compiled Lua$" compiled.lua
echo 'x = = 1' | "$glint" - >out 2>err
[ $? -eq 2 ] && grep -qx "glint: error: stdin:1: unexpected symbol near '='" err
result $? "a wrong script on standard input"
refused "reproduce with a pipe for a script" "pipe: a script expected, got a pipe" reproduce good.png pipe
refused "fit.lua to a folder" "name ending in .png or .pfm expected, got .folder" "$root/scripts/fit.lua" -D file=folder -o none
refused "fit.lua to another size" "fit: the target is [0-9]+ x [0-9]+, the picture 160 x 120" "$root/scripts/fit.lua" -D file=good.pfm -o none
refused "fit.lua to a device" "read_image: device.pfm" "$root/scripts/fit.lua" -D file=device.pfm -o none
refused "fit.lua to a huge file" "read_image: huge.pfm" "$root/scripts/fit.lua" -D file=huge.pfm -o none
limited timeout $seconds "$glint" - --size 8x8 -o piped.png -q <scene.lua >out 2>err && "$glint" compare piped.png good.png >out
result $? "a script from standard input"
refused "which is there once" "only render and explain read a script from standard input" - --sweep a=1:2:2 -o none
refused "and has no folder" "only render and explain read a script from standard input" describe -
printf '1\nfrom stdin\nH 1 2 3\n' >atom.xyz
printf '%s\n' 'local frame = require "glint.xyz".frame "-"' 'local label, x = frame:atoms()()' 'assert(label == "H" and x == 1)' \
    'return dofile "scene.lua"' >try.lua
limited timeout $seconds "$glint" try.lua --size 8x8 -o none -q <atom.xyz >out 2>err
result $? "atoms from standard input"
mkdir beside
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >beside/mesh.obj
printf '2\n\nC 0 0 0\nC 0 x 0\n' >beside/bad.xyz
cp good.png beside/photo.png
printf '%s\n' 'local glint = require "glint"' 'local mesh = glint.mesh { file = "mesh.obj" }' 'assert(mesh.count == 1)' \
    'glint.texture { file = "photo.png" }' 'return dofile "scene.lua"' >beside/own.lua
limited timeout $seconds "$glint" beside/own.lua --size 8x8 -o none -q >out 2>err
result $? "a mesh and a picture beside the script"
printf '%s\n' 'local function load(path) require "glint.particles".new():add_frame(require "glint.xyz".frame(path)) end' \
    'load "bad.xyz"' >beside/bad.lua
limited timeout $seconds "$glint" beside/bad.lua -o none -q >out 2>err
head -n 1 err | grep -q '^glint: error: beside/bad.xyz:4: y (a finite number) expected, got "x"$'
result $? "a reader's error has the file and the line"
test "$(sed -n '2,$p' err)" = "  called from beside/bad.lua:1
  called from beside/bad.lua:2"
result $? "and the script's own lines"
totals
