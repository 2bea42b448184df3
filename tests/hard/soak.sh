#!/bin/sh
# The long form of the hard cases: two processes, each with half of the rays and its own seed.
#   soak.sh FOLDER RAYS    FOLDER holds the programs
set -u
folder=$1
half=$(awk "BEGIN { printf \"%.0f\", $2 / 2 }")

# Casts half of the rays. Its output ends with the totals.
soak() {
    bad=0
    for program in hard_fuzz hard_frames hard_pictures hard_solids hard_torus hard_combined hard_leaving hard_glass hard_area hard_meshes hard_seams hard_shading hard_facets hard_rough hard_limits; do
        "$folder/$program" --table --rays "$half" --seed "$1" || bad=1
    done
    BUILD=${folder%/tests/hard} lua5.4 tests/hard/hard_faces.lua --table --rays "$(awk "BEGIN { printf \"%.0f\", $half / 500 }")" --seed "$1" || bad=1
    return $bad
}

other=$(mktemp)
trap 'rm -f "$other"' EXIT
soak 1001 >"$other" 2>&1 &
status=0
soak 2002 || status=1
wait $! || status=1
cat "$other"
[ $status -eq 0 ] && echo "soak: nothing wrong in $2 rays" || echo "soak: see above" >&2
exit $status
