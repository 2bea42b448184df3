#!/usr/bin/env bash
# Runs every script and every command of README.md: the ```lua blocks by glint at a small size, the ```sh blocks line
# by line, with the build's glint first in the path. The two indented make commands are what this runs under.
set -u
root=$PWD
build=${BUILD:-build}
glint=${GLINT:-$root/$build/glint}
work=$root/$build/tests/readme
rm -rf "$work"
mkdir -p "$work/bin"
ln -s "$glint" "$work/bin/glint"
ln -s "$root/scripts" "$work/scripts"

# Each fenced block becomes a file: 01.lua, 02.sh ...
awk -v folder="$work" '
    /^```(lua|sh)$/ { kind = substr($0, 4); name = sprintf("%s/%02d.%s", folder, ++blocks, kind); next }
    /^```/ { if (name) close(name); name = ""; next }
    name { print > name }' README.md

bad=0
export PATH="$work/bin:$PATH"
cd "$work" || exit 1

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

for block in [0-9]*.lua; do
    run "$block" glint "$block" --size 64x36 --quiet
done
for block in [0-9]*.sh; do
    while read -r line; do
        run "${line%%#*}" bash -c "$line" </dev/null
    done <"$block"
done

# The study's plot is drawn as the one in README, by today's hand: the same but for what is measured.
style() { sed -n '1,/<\/style>/p' "$1"; }
plot=$root/scripts/pictures/cost.svg
if [ -s price/plot.svg ] && cmp -s <(style price/plot.svg) <(style "$plot") && grep -q "='samples 64: " price/plot.svg; then
    echo "ok - the plot of README"
else
    echo "not ok - price/plot.svg is not there, or drawn in another way than $plot: copy it there, and its advice to README"
    bad=1
fi

# Paths that README names must be there.
for path in $(grep -oE '`(engine|bindings|scripts|tests)/[a-z_/.0-9]+`' "$root/README.md" | tr -d '`' | sort -u); do
    [ -e "$root/$path" ] || { echo "not ok - README names $path, which is not there"; bad=1; }
done
[ -e "$root/scripts/pictures/readme.png" ] || { echo "not ok - README's picture is not there"; bad=1; }
exit $bad
