#!/usr/bin/env bash
# elsewhere.sh: compares the pictures of a command built for another machine or C library with the goldens and with
# this machine's.
#   ELSEWHERE      its build folder
#   EMULATOR       the program that runs it; empty: it runs directly
#   ENCODERS=same  it has the same encoder libraries as this build
#   LACKS          an instruction set that it does not have; empty: none is known
set -u
native=$GLINT scratch=$ELSEWHERE/tests/elsewhere
rm -rf "$scratch"
mkdir -p "$scratch"
scratch=$(cd "$scratch" && pwd)
printf '#!/bin/sh\nexec %s %s/glint "$@"\n' "$EMULATOR" "$(cd "$ELSEWHERE" && pwd)" >"$scratch/glint"
chmod +x "$scratch/glint"
bad=0

# check NAME COMMAND...
check() {
    local name=$1
    shift
    if "$@"; then
        echo "ok - $name"
    else
        echo "not ok - $name"
        bad=1
    fi
}

sums() { (cd "$1" && sha256sum -- *); }

# both NAME SCRIPT OPTION...    Runs the same job here and there. NAME includes the extension of its files.
both() {
    local name=$1
    shift
    "$native" "$@" --quiet -o "$scratch/here/$name" || echo "no picture here"
    "$scratch/glint" "$@" --quiet -o "$scratch/there/$name" || echo "no picture there"
}

GLINT=$scratch/glint BUILD=$ELSEWHERE bash tests/command/golden.sh || bad=1

mkdir "$scratch/here" "$scratch/there"
both 'light_%04d.pfm' scripts/moving_light.lua -f 1-120:20 --size 96x54 --passes depth,normal,object_id
both 'sphere_%04d.pfm' scripts/mesh_and_sphere.lua -f 1 --size 96x54
both 'float_%04d.pfm' scripts/molecule.lua -f 1 --size 96x54 --precision float --samples 4
both 'indirect_%04d.pfm' scripts/indirect.lua --set samples=4 -f 1-2 --size 48x27
check "pictures of floats: the same bytes" test "$(sums "$scratch/here")" = "$(sums "$scratch/there")"
check "and all of them" test "$(find "$scratch/here" -name '*.pfm' | wc -l)" -ge 16

rm -rf "$scratch/here" "$scratch/there"
mkdir "$scratch/here" "$scratch/there"
if [ "${ENCODERS:-}" = same ]; then
    both 'small_%04d.png' scripts/moving_light.lua -f 1-3 --size 96x54 --encode small
    check "one encoder library: the same files" test "$(sums "$scratch/here")" = "$(sums "$scratch/there")"
fi
both 'fast_%04d.png' scripts/moving_light.lua -f 1-3 --size 96x54 --encode fast
for n in 1 2 3; do
    check "fast, frame $n: the same pixels" \
        "$native" compare "$scratch/here/fast_000$n.png" "$scratch/there/fast_000$n.png"
done
"$scratch/glint" scripts/moving_light.lua -f 1-3 --size 96x54 --json -o "$scratch/there/fast_%04d.png" >"$scratch/kept" 2>&1
check "a job goes on where it has stopped" test "$(grep -c '"status":"kept"' "$scratch/kept")" -eq 3
if [ "${ENCODERS:-}" = same ]; then
    "$scratch/glint" scripts/moving_light.lua -f 1-3 --size 96x54 --json -o "$scratch/here/fast_%04d.png" >"$scratch/kept" 2>&1
    check "and where another machine has stopped" test "$(grep -c '"status":"kept"' "$scratch/kept")" -eq 3
fi
[ -z "${LACKS:-}" ] || check "an instruction set of another machine is refused" \
    sh -c "GLINT_ISA=$LACKS '$scratch/glint' scripts/moving_light.lua -f 1 -o none 2>&1 | grep -q 'lacks .$LACKS'"
exit $bad
