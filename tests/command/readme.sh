#!/usr/bin/env bash
# Runs every script and every command of the pages: the ```lua blocks by glint at a small size, the ```sh blocks line
# by line, with the build's glint first in the path, each page in its own folder. A block that begins "-- NAME.lua:"
# is saved under that name for later commands, and ```python blocks run where NumPy is installed. Files that pages
# name must exist, and the pictures of bindings/docs must equal those that its commands make: `readme.sh update`
# writes those that differ. The two indented make commands of README.md are not run: this test is part of them.
set -u
mode=${1:-check}
root=$PWD
build=${BUILD:-build}
glint=${GLINT:-$root/$build/glint}
. tests/command/font.sh
work=$root/$build/tests/readme
rm -rf "$work"
mkdir -p "$work/bin"
ln -s "$glint" "$work/bin/glint"
export PATH="$work/bin:$PATH"
export LUA_PATH="$root/scripts/lib/?.lua;;" # where an installed command has its own
bad=0

# run NAME COMMAND...
run() {
    local name=$1
    shift
    if "$@" >out 2>err; then
        echo "ok - $name"
    else
        echo "not ok - $name: exit $?"
        cat out err
        bad=1
    fi
}

python= # a Python with NumPy, or empty; tests/command/python.sh runs the blocks of scripts/python.md
for name in python3 /usr/bin/python3; do
    if [ -z "$python" ] && $name -c 'import numpy' 2>/dev/null; then python=$name; fi
done

# Runs the blocks of a page: each becomes a file, 01.lua, 02.sh ...
run_page() {
    local folder=$work/${1//\//_} block line saved
    mkdir -p "$folder"
    ln -s "$root/scripts" "$folder/scripts"
    awk -v folder="$folder" '
        /^```(lua|sh|python)$/ { kind = substr($0, 4); name = sprintf("%s/%02d.%s", folder, ++blocks, kind); next }
        /^```/ { if (name) close(name); name = ""; next }
        name { print > name }' "$root/$1"
    cd "$folder" || exit 1
    for block in [0-9]*.*; do
        case $block in
        *.lua)
            saved=$(sed -nE '1s/^-- ([a-z_]+\.lua):.*/\1/p' "$block")
            if [ -n "$saved" ]; then cp "$block" "$saved"; else run "$1: $block" glint "$block" --size 64x36 --quiet; fi
            ;;
        *.python) if [ -n "$python" ] && [ "$1" != scripts/python.md ]; then run "$1: $block" "$python" "$block"; fi ;;
        *.sh) while read -r line; do run "${line%%#*}" bash -c "$line" </dev/null; done <"$block" ;;
        esac
    done
}

# The pictures of a page of bindings/docs equal those that its commands made; light_01.png is light/01.png.
check_pictures() {
    local folder=$work/${1//\//_} shown=$root/bindings/docs/pictures path made
    for path in $(grep -oE '\]\(pictures/[a-zA-Z_/.0-9]+\)' "$root/$1" | sed -E 's/^..pictures.(.*)\)$/\1/' | sort -u); do
        made=$folder/$path
        [ -e "$made" ] || made=$folder/${path/_//}
        if glint compare "$made" "$shown/$path" --fail 0 --warn 0 >/dev/null 2>&1; then
            echo "ok - $1: the picture $path"
        elif [ ! "$pinned" ]; then
            echo "ok - $1: $path is not compared, because its letters may be of another font"
        elif [ "$mode" = update ]; then
            cp "$made" "$shown/$path"
            echo "$shown/$path: written"
        else
            echo "not ok - $1: its picture $path is not what its commands make: make gallery writes it"
            bad=1
        fi
    done
}

# Files in backquotes are relative to the root, the page's folder or a folder below it;
# links are relative to the page's folder.
check_paths() {
    local folder path
    folder=$root/$(dirname "$1")
    for path in $(grep -oE '`[a-z_/.0-9]+\.(c|h|lua|sh|md|csv|png|1)`' "$root/$1" | tr -d '`' | sort -u); do
        case $path in *_.* | */.* | *.so.*) continue ;; esac # patterns of names, and files that the build makes
        [ -e "$root/$path" ] || [ -e "$folder/$path" ] || git -C "$root" ls-files | grep -q "/$path\$" ||
            { echo "not ok - $1 names $path, which is not there"; bad=1; }
    done
    for path in $(grep -oE '\]\([a-zA-Z_/.0-9]+\)' "$root/$1" | tr -d '])(' | sort -u); do
        [ -e "$folder/$path" ] || { echo "not ok - $1 links to $path, which is not there"; bad=1; }
    done
}

for page in README.md bindings/README.md engine/README.md engine/*/README.md engine/render/stages/README.md tests/README.md scripts/README.md \
    scripts/python.md scripts/particles.md .github/CONTRIBUTING.md bindings/docs/*.md; do
    run_page "$page"
    case $page in bindings/docs/*) check_pictures "$page" ;; esac
    check_paths "$page"
done
lines=$(wc -l <"$root/README.md")
[ "$lines" -le 200 ] || { echo "not ok - README.md has $lines lines, more than a first look takes (200)"; bad=1; }
cd "$work/README.md" || exit 1

# The study's plot has the same style as the one in README: only the measured values differ.
style() { sed -n '1,/<\/style>/p' "$1"; }
plot=$root/scripts/pictures/cost.svg
if [ -s price/plot.svg ] && cmp -s <(style price/plot.svg) <(style "$plot") && grep -q "='samples 64: " price/plot.svg; then
    echo "ok - the plot of README"
else
    echo "not ok - price/plot.svg is not there, or drawn in another way than $plot: copy it there, and its advice to README"
    bad=1
fi

[ -e "$root/scripts/pictures/readme.png" ] || { echo "not ok - README's picture is not there"; bad=1; }
exit $bad
