#!/usr/bin/env bash
# golden.sh [check|update]: compares small pictures of the scripts with tests/golden/, as decoded pixels, with
# tolerance 0: the engine guarantees the same pixels on every machine. A failure leaves both pictures in the build
# folder. `update` writes new goldens and prints the differences; the commit must say why they changed.
set -u
export GLINT_FONT=bitmap # text has the same pixels on every machine
build=${BUILD:-build}
glint=${GLINT:-$build/glint}
out=$build/tests/golden
mode=${1:-check}
bad=0

# picture NAME SCRIPT OPTION...    A four-digit number at the end of NAME is the frame number that glint adds.
picture() {
    local name=$1 pattern=${1%_[0-9][0-9][0-9][0-9]}
    shift
    "$glint" "$@" --size 64x48 --quiet --force -o "$out/$pattern.png" || {
        echo "not ok - $name: no picture"
        bad=1
        return
    }
    local golden=tests/golden/$name.png report status
    report=$("$glint" compare "$golden" "$out/$name.png" 2>&1)
    status=$?
    if [ "$mode" = update ]; then
        [ $status -eq 0 ] || printf '%s: %s\n' "$name" "${report:-new}"
        [ $status -eq 0 ] || cp "$out/$name.png" "$golden"
    elif [ $status -eq 0 ]; then
        echo "ok - $name"
    else
        printf 'not ok - %s: got %s, golden %s\n%s\n' "$name" "$out/$name.png" "$golden" "$report"
        bad=1
    fi
}

mkdir -p "$out" tests/golden
for step in ambient diffuse specular all; do
    picture "workshop_$step" scripts/workshop.lua --set step=$step
done
picture workshop_16 scripts/workshop.lua --samples 16
picture workshop_linear_16bit scripts/workshop.lua --bits 16 --transfer linear
picture moving_light_0031 scripts/moving_light.lua -f 31
picture shininess_sweep_0005 scripts/shininess_sweep.lua -f 5
picture phong_and_blinn_0004 scripts/phong_and_blinn.lua -f 4
picture mirror_and_glass scripts/mirror_and_glass.lua
picture mirror_and_glass_float scripts/mirror_and_glass.lua --precision float
picture soft_shadows_0011 scripts/soft_shadows.lua -f 11
picture soft_shadows_window_0009 scripts/soft_shadows.lua --set lamp=window -f 9
picture labels_0013 scripts/labels.lua -f 13
picture lamps scripts/lamps.lua
picture lampshade scripts/lampshade.lua
picture lights scripts/lights.lua
picture translucent scripts/translucent.lua
picture metals scripts/metals.lua --set rays=2
picture combined scripts/combined.lua
picture rings_0009 scripts/rings.lua -f 9
picture caps_0006 scripts/caps.lua -f 6
picture indirect_0003 scripts/indirect.lua --set samples=8 -f 3
picture occlusion_0003 scripts/occlusion.lua --set samples=4 --set side=12 -f 3
picture adaptive_0004 scripts/adaptive.lua -f 4
picture spotlights scripts/spotlights.lua
picture lobes scripts/lobes.lua
picture roughness scripts/roughness.lua
picture shading_0001 scripts/shading.lua -f 1
picture shading_0005 scripts/shading.lua -f 5
picture chessboard_0001 scripts/chessboard.lua -f 1
picture wood_and_marble scripts/wood_and_marble.lua
picture bricks_0001 scripts/bricks.lua -f 1
picture shaders scripts/shaders.lua
picture toon_teapot_0001 scripts/toon_teapot.lua -f 1
picture lantern_0001 scripts/lantern.lua -f 1
picture focus_0016 scripts/focus.lua -f 16
picture focus_orthographic_0016 scripts/focus.lua -f 16 --set blades=0 --set projection=orthographic --samples 8
picture shutter_0001 scripts/shutter.lua -f 1
picture shutter_lamp_0001 scripts/shutter.lua -f 1 --set moves=lamp
picture gr_scene scripts/gr_scene.lua --dialect gr
picture gr_room scripts/gr_room.lua --dialect gr
exit $bad
