#!/bin/sh
# Counts the pixels in which a side's picture differs by more than two 8-bit steps from glint's (which the tests check).
#   unlike.sh hand|embree|glint_side WORDS...     prints: differ pixels COUNT
set -eu
programs=${BUILD:-build}/tests/bench
side=$1
shift
folder=$(mktemp -d "${TMPDIR:-/tmp}/glint-bench-unlike-XXXXXX")
trap 'rm -rf "$folder"' EXIT
scene=scene=workshop
for word in "$@"; do
    case $word in scene=*) scene=$word ;; esac
done
"$programs/glint_side" picture "out=$folder/glint.png" "$scene"
"$programs/$side" picture "out=$folder/side.png" "$@"
"$programs/glint_side" compare "out=$folder/glint.png" "with=$folder/side.png"
