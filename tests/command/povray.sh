#!/usr/bin/env bash
# Comparison with POV-Ray. Every pixel of the workshop scene at 1280x720, 16-bit linear, must be within 1/65535 of
# POV-Ray's pixel, except at most 0.01 % of the pixels (ties at shadow edges and silhouettes), which the test prints.
# With a lens both pictures have noise: blocks of 4 x 4 pixels must agree within 0.0015 of full scale (root mean
# square). A lens that is a tenth wider differs by 0.0026, a lens that is a tenth narrower by 0.0016.
# The mapping is in povray/pov.lua.
set -u
build=${BUILD:-build}
glint=${GLINT:-$build/glint}
out=$build/tests/povray
width=1280 height=720

if ! command -v povray >/dev/null 2>&1; then
    if [ -n "${CI:-}" ]; then
        echo "povray is not installed, and CI must have it"
        exit 1
    fi
    echo "povray is not installed (make deps gets it)"
    exit 77
fi

bad=0
# compare MODEL LIGHT PROJECTION [SURFACES [SAMPLES MOST blocks]]
compare() {
    local surfaces=${4:-plain}
    local name=$1_$2_$3_$surfaces
    ${LUA:-lua5.4} tests/povray/pov.lua "$1" "$2" "$3" $width $height "$surfaces" "$out/sky.png" >"$out/$name.pov" &&
        povray "+I$out/$name.pov" "+O$out/$name.pov.png" +W$width +H$height +FN16 File_Gamma=1.0 -A -D \
            >"$out/$name.log" 2>&1 || {
        tail -n 20 "$out/$name.log"
        echo "not ok - POV-Ray rendered $name"
        bad=1
        return
    }
    "$glint" tests/povray/scene.lua --set "model=$1" --set "light=$2" --set "projection=$3" --set "surfaces=$surfaces" --set "sky=$out/sky.png" --size ${width}x$height \
        --quiet --force --samples "${5:-1}" -o "$out/$name.png" &&
        "$build/tests/compare16" "$out/$name.png" "$out/$name.pov.png" ${6:-0.0001} ${7:-} || {
        echo "not ok - $name"
        bad=1
        return
    }
    echo "ok - $name"
}

mkdir -p "$out"
${LUA:-lua5.4} tests/povray/sky.lua "$out/sky.png" || bad=1
for model in phong blinn_phong; do
    for light in point directional; do
        compare $model $light perspective
    done
done
for light in spot fade area; do
    compare phong $light perspective
done
for surfaces in mirror glass absorbing inside fresnel solids combined open rings faceted smooth stretched prism nested checker sky translucent; do
    compare phong point perspective $surfaces
done
compare phong point orthographic
compare blinn_phong directional orthographic
width=640 height=360
compare phong point perspective lens 64 0.0015 blocks
exit $bad
