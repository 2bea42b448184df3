#!/usr/bin/env bash
# scripts/farm: GNU parallel runs the shards of a job, and so does a Slurm array on two nodes, one of which dies
# halfway. The pictures must be complete and byte-identical to a run on one machine. SLURM_CLUSTER names a program
# that sets up a Slurm of two nodes on this machine (start, kill, stop). Without it the Slurm part is skipped.
. tests/command/prelude.sh
slurm=$work/slurm
frames=32 shards=8
finish() {
    [ ! -d "$slurm" ] || "$SLURM_CLUSTER" stop "$slurm" >"$work/stop.log" 2>&1
    rm -rf "$work" "$work.log"
}
trap finish EXIT

cd "$work" || exit 1
mkdir logs
# FARM_PACE: seconds per frame, so that a job can be killed halfway.
cat >film.lua <<END
local glint = require "glint"
local pace = os.getenv "FARM_PACE"
local lamp = glint.point_light { position = { 5, 5, 5 } }
local scene = glint.scene { camera = glint.camera { eye = { 0, 3, 9 }, at = { 0, 1, 0 } }, ambient = 0.125,
  lamp, glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 } }, glint.sphere { center = { 0, 1, 0 }, radius = 1 } }
return glint.animation { scene = scene, frames = $frames, width = 160, height = 90, samples = 4, cyclic = true,
  frame = function(t)
    if pace then os.execute("sleep " .. pace) end
    lamp.position = { 5 * glint.cos(2 * math.pi * t), 5, 5 * glint.sin(2 * math.pi * t) }
  end }
END
check "one machine" "$GLINT" film.lua -o 'one/%04d.png' --quiet

# same FOLDER: checks that it is complete and byte-identical to the run on one machine
same() {
    [ "$(ls "$1"/*.png | wc -l)" -eq $frames ] || { echo "$(ls "$1"/*.png | wc -l) of $frames frames"; return 1; }
    for file in one/*.png; do cmp "$file" "$1/${file#one/}" || return 1; done
}
# all_kept FOLDER: a run of the whole job finds nothing to do
all_kept() {
    "$GLINT" film.lua -o "$1/%04d.png" --json --quiet | grep -q "\"event\":\"end\",\"frames\":$frames,\"kept\":$frames,"
}

# ---- GNU parallel ----

if command -v parallel >/dev/null; then
    check "GNU parallel: $shards shards" env JOBS=2 "$root/scripts/farm/parallel.sh" $shards film.lua -o 'parallel/%04d.png'
    check "GNU parallel: the pictures of one machine" same parallel
    check "GNU parallel: the whole job keeps them" all_kept parallel
    check "GNU parallel: a name with blanks" "$root/scripts/farm/parallel.sh" 2 film.lua -f 1-2 -o 'two words/%04d.png'
    check "GNU parallel: and its files" test -s 'two words/0002.png'
    check "GNU parallel: a failure shows" eval "! '$root/scripts/farm/parallel.sh' 2 nowhere.lua"
    # One large frame; one part is killed and run again.
    export GLINT
    check "GNU parallel: one frame in 6 parts" parallel --jobs 2 -N0 "$root/scripts/farm/part.sh" 6 160x90 parts film.lua -f 3 \
        ::: 1 2 3 4 5 6
    rm parts/0003/0004.png
    FARM_PACE=5 PART=4 "$root/scripts/farm/part.sh" 6 160x90 parts film.lua -f 3 2>/dev/null &
    victim=$!
    sleep 0.5
    kill -KILL $victim
    wait $victim 2>/dev/null
    check "a killed part has left nothing" test ! -e parts/0003/0004.png
    check "join names it" eval "! '$GLINT' join 'parts/0003/####.png' -o joined.png 2>why && grep -q 'missing: 4' why"
    check "the part again" env PART=4 "$root/scripts/farm/part.sh" 6 160x90 parts film.lua -f 3
    check "the parts join" "$GLINT" join 'parts/0003/####.png' -o joined.png
    check "the frame of one machine" cmp one/0003.png joined.png
else
    skip "GNU parallel is not installed"
fi
for wrong in '0 6' '7 6' '1 99' 'x 6'; do
    check "part.sh refuses part and parts $wrong" eval \
        "! PART=${wrong% *} '$root/scripts/farm/part.sh' ${wrong#* } 160x90 parts film.lua 2>/dev/null"
done

# ---- Slurm ----

skip_slurm() {
    skip "$1"
    totals
    exit
}
"$root/scripts/farm/slurm.sh" 8 film.lua 2>"$work/usage"
check "the task alone says how it is used" grep -q "usage: sbatch" "$work/usage"
[ -n "${SLURM_CLUSTER:-}" ] || skip_slurm "SLURM_CLUSTER names no program that starts a cluster"
timeout 200 "$SLURM_CLUSTER" start "$slurm" --install >"$work/start.log" 2>&1 ||
    skip_slurm "no Slurm here: $(tail -n 1 "$work/start.log")"
export SLURM_CONF=$slurm/slurm.conf

submit() { # PACE ARRAY FOLDER
    FARM_PACE=$1 sbatch --parsable --array="$2" --output="$work/logs/%A-%a.txt" "$root/scripts/farm/slurm.sh" \
        $shards film.lua -o "$3/%04d.png"
}
ended() { # ID: waits up to 120 s for the end of an array
    for _ in $(seq 600); do
        [ -n "$(squeue -h -j "$1" 2>/dev/null)" ] || return 0
        sleep 0.2
    done
    squeue
    return 1
}
count() { ls film/*.png 2>/dev/null | wc -l; }
on_node() { squeue -h -j "$id" -t R -w "$1" -o %K | head -n 1; }
part_begun() { # of the task on node1: more than none, less than all
    local task first=0 done=0
    task=$(on_node node1)
    [ -n "$task" ] || return 1
    first=$(((task - 1) * frames / shards + 1))
    for n in $(seq $first $((first + frames / shards - 1))); do
        [ ! -e "$(printf film/%04d.png "$n")" ] || done=$((done + 1))
    done
    [ $done -ge 1 ] && [ $done -lt $((frames / shards)) ] && killed=$task
}

id=$(submit 0.5 1-$shards film)
check "an array of $shards shards" test -n "$id"
killed=
for _ in $(seq 400); do
    if [ "$(count)" -ge 6 ] && part_begun; then break; fi
    sleep 0.05
done
check "a task of node1 is in its middle" test -n "$killed"
check "node1 dies" "$SLURM_CLUSTER" kill "$slurm" node1
check "the array ends" ended "$id"
check "the task was requeued" grep -q "shard $killed/$shards on node2, restart 1" "$work/logs/$id-$killed.txt"
check "and kept what was finished" grep -Eq '^frames? [0-9-]+: kept' "$work/logs/$id-$killed.txt"
check "the pictures of one machine, complete" same film
check "the whole job keeps them" all_kept film

# One large frame as an array.
parts=$(sbatch --parsable --array=1-6 --output="$work/logs/%A-%a.txt" "$root/scripts/farm/part.sh" 6 160x90 array film.lua -f 3)
check "the parts of a frame end" ended "$parts"
check "they join" "$GLINT" join 'array/0003/####.png' -o array.png
check "to the frame of one machine" cmp one/0003.png array.png

# Runs one shard again, as the page says.
rm film/0009.png
again=$(submit 0 3 film)
check "one shard again" ended "$again"
check "the pictures are complete again" same film
totals
