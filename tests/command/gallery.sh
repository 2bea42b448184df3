#!/usr/bin/env bash
# gallery.sh [check|update]: compares the pictures of scripts/README.md, pixel by pixel, with the scripts' output.
# Each script must have a picture, and the page must name it. `update` (make gallery) writes the pictures that differ.
set -u
build=${BUILD:-build}
glint=${GLINT:-$build/glint}
out=$build/tests/gallery page=scripts/README.md
mode=${1:-check}
bad=0
. tests/command/font.sh

say() { # STATUS NAME
    echo "$1 - $2"
    [ "$1" = ok ] || bad=1
}

# picture NAME OPTION...: renders scripts/NAME.lua; with several frames, --frames chooses one.
picture() {
    local name=$1 made
    shift
    rm -f "$out/$name"*.png
    "$glint" "scripts/$name.lua" --size 320x200 "$@" --encode small --quiet --force -o "$out/$name.png" || {
        say "not ok" "$name: no picture"
        return
    }
    made=$(ls "$out/$name.png" "$out/$name"_[0-9]*[0-9].png 2>/dev/null | head -n 1)
    keep "$name" "$made"
}

# steps NAME OPTION...: puts all pictures of scripts/NAME.lua on a sheet, with their differences from the first.
steps() {
    local name=$1
    shift
    rm -f "$out/$name"*.png
    if "$glint" "scripts/$name.lua" "$@" --quiet --force -o "$out/$name.%02d.png" 2>/dev/null >&2 &&
        "$glint" sheet "$out/$name.##.png" --columns 5 --difference 1 -o "$out/$name.png" >/dev/null 2>&1; then
        keep "$name" "$out/$name.png" text
    else
        say "not ok" "$name: no picture"
    fi
}

# keep NAME FILE [text]: compares or updates a script's picture. text: it has text although its script adds none.
keep() {
    local name=$1 kept=scripts/pictures/$1.png made=$2
    if "$glint" compare "$kept" "$made" --fail 0 --warn 0 >/dev/null 2>&1; then
        say ok "$name is current"
    elif [ ! "$pinned" ] && { [ -n "${3-}" ] || grep -qE '(glint\.|[a-z]:)(label|arrow|line|chart|axes|colorbar)' "scripts/$name.lua"; }; then
        say ok "$name is not compared, because its letters are of another font"
    elif [ "$mode" = update ]; then
        cp "$made" "$kept"
        echo "$kept: written"
    else
        say "not ok" "$name: $kept is not what the script renders; make gallery writes it anew"
    fi
}

mkdir -p "$out"
picture adaptive --frames 3
picture bricks --frames 1
picture caps --frames 6
picture chessboard --frames 1
picture combined --samples 4
steps fit
picture flight --frames 30
picture cosine --size 640x360
picture earth --frames 1
picture focus --frames 16
picture furnace
picture gr_room --dialect gr --samples 4
picture gr_scene --dialect gr
picture highlight_angles --size 640x300
picture indirect --set samples=32 --frames 3 --samples 4
picture labels --frames 13
picture lamps
picture lampshade
picture lantern --frames 1
picture lights
picture lobes --size 400x160
picture mesh_and_sphere --size 400x200
picture mirror_and_glass --size 320x180 --samples 9
picture model
picture molecule --set style=sticks
picture moving_light --frames 31 --samples 4
"$glint" scripts/sphereflake.lua --set size=3 --set nff="$out/flake.nff" -o none --quiet
picture nff --set file="$out/flake.nff"
picture normals --size 640x240
picture occlusion --frames 2
picture particle_box --samples 9
picture penumbra --size 640x360
picture phong_and_blinn --frames 4 --samples 4
picture photometric --set lights=8 --set folder="$out/photometric" --frames 3 --samples 4 --bits 8 --transfer srgb
picture protein --size 320x180
picture rings --frames 9 --samples 4
picture roughness --size 400x160
picture scan --set file="$out/scan.ply"
picture shaders --samples 4
picture shading --size 400x200 --frames 5
picture shininess_sweep --frames 5 --samples 4
picture shutter --frames 5
picture sky --frames 1 --set samples=64
picture snell --size 640x360
picture soft_shadows --frames 11 --samples 4
picture sphereflake --samples 4
picture spotlights --size 320x180
picture toon_teapot --frames 1
picture trajectory --frames 9
picture translucent --samples 4
picture metals
picture vectors
picture wood_and_marble
picture workshop --samples 9

for script in scripts/*.lua; do
    name=$(basename "$script" .lua)
    if [ -e "scripts/pictures/$name.png" ] && grep -q "(pictures/$name.png)" "$page" && grep -q "($name.lua)" "$page"; then
        say ok "$name is on the page"
    else
        say "not ok" "$name is not on the page: $page and tests/command/gallery.sh list every script"
    fi
done
while read -r file; do
    if [ -e "scripts/$file" ]; then say ok "$file is there"; else say "not ok" "$page: $file is not there"; fi
done < <(grep -o '([A-Za-z_./]*)' "$page" | tr -d '()' | sort -u)
exit $bad
