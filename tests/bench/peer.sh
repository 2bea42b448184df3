#!/bin/sh
# Renders a scene with POV-Ray or Tachyon, and prints results in the driver's format: name, unit, value.
#   peer.sh povray|tachyon frame [scene=...] [threads=N] [samples=4] [shadows=0] [area=1] [lamps=N]
#           [adaptive=1] [lens=1]
#       setup (parsing, bounding) and render (tracing) by the program's own clock; wall: everything; cpu: processor
#       time, for POV-Ray of tracing only, as it reports it, for Tachyon of everything
#   peer.sh povray job change=light|shininess [threads=N]
#       seconds for the job's 60 frames: renders the first FRAMES of them and scales the time; also scales cpu
set -eu
FRAMES=6
program=$1 mode=$2
shift 2
threads=1 samples=1 adaptive=0 lens=0 shade=-fullshade
for word in "$@"; do
    case $word in
    threads=*) threads=${word#*=} ;;
    samples=*) samples=${word#*=} ;;
    adaptive=*) adaptive=${word#*=} ;;
    lens=*) lens=${word#*=} ;;
    shadows=0) shade=-mediumshade ;;
    esac
done

folder=$(mktemp -d "${TMPDIR:-/tmp}/glint-bench-peer-XXXXXX")
trap 'rm -rf "$folder"' EXIT
"${BUILD:-build}/tests/bench/peers" "$program" "$@" >"$folder/scene"

case $program in
povray)
    set -- "+I$folder/scene" "+O$folder/out.png" +W1920 +H1080 +FN8 -D "+WT$threads"
    # method 1: R x R samples where neighbours differ by more than the threshold; a lens has its own samples
    if [ "$adaptive" = 1 ]; then set -- "$@" +AM1 +A0.1 +R4 -J; elif [ "$samples" -gt 1 ] && [ "$lens" = 0 ]; then set -- "$@" +AM1 +A0.0 +R2 -J; else set -- "$@" -A; fi
    if [ "$mode" = job ]; then set -- "$@" +KFI1 "+KFF$FRAMES"; fi
    ;;
tachyon)
    mv "$folder/scene" "$folder/scene.dat"
    set -- "$folder/scene.dat" -numthreads "$threads" "$shade" -shade_phong -format PNG -o "$folder/out.png"
    ;;
*)
    echo "usage: peer.sh povray|tachyon frame|job ..." >&2
    exit 2
    ;;
esac

times >"$folder/before"
begin=$(date +%s%N)
"$program" "$@" >"$folder/log" 2>&1 </dev/null || {
    tail -n 5 "$folder/log" >&2
    exit 1
}
end=$(date +%s%N)
times >"$folder/after"
# The second line has the children's times: "0m0.60s 0m0.01s", user and system.
cpu=$(awk 'FNR == 2 { sign = FILENAME ~ /after$/ ? 1 : -1
    for (i = 1; i <= 2; i++) { split($i, part, "m"); sum += sign * (60 * part[1] + part[2]) } }
    END { print sum }' "$folder/before" "$folder/after")

if [ "$mode" = job ]; then
    awk -v ns=$((end - begin)) -v cpu="$cpu" -v frames=$FRAMES 'BEGIN {
        print "job s", ns / 1e9 * 60 / frames; print "cpu s", cpu * 60 / frames }'
    exit
fi
# POV-Ray prints "Trace Time: 0 hours 0 minutes 0 seconds (0.603 seconds)" and "using 1 thread(s) with 0.600 CPU-seconds
# total". Tachyon prints "Ray Tracing Time: 0.1595 seconds".
tr '\r' '\n' <"$folder/log" | awk -v ns=$((end - begin)) -v cpu="$cpu" '
    /CPU-seconds total/ { cpu = substr($0, index($0, "with ") + 5) + 0 }
    match($0, /[0-9.]+ seconds\)?$/) { seconds = substr($0, RSTART) + 0 }
    /Parse Time|Bounding Time|Parsing Time|Preprocessing Time/ { setup += seconds }
    /Trace Time|Ray Tracing Time/ { render = seconds }
    END { print "setup ms", setup * 1e3; print "render ms", render * 1e3; print "wall ms", ns / 1e6
          print "cpu ms", cpu * 1e3 }'
