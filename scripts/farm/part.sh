#!/bin/bash
# Renders one part of a big frame, which is split into PARTS strips; see README.md next to this file.
#     sbatch --array=1-16 part.sh PARTS WxH FOLDER SCRIPT [options of glint]
#     parallel --retries 3 -N0 part.sh 16 7680x4320 FOLDER SCRIPT [options of glint] ::: $(seq 16)
#     PART=3 part.sh 16 7680x4320 FOLDER SCRIPT [options of glint]
# It writes FOLDER/FRAME/PART.png; when all parts exist: glint join 'FOLDER/0001/####.png' -o frame.png
#SBATCH --job-name=glint
#SBATCH --requeue
#SBATCH --open-mode=append
set -eu
part=${PART:-${SLURM_ARRAY_TASK_ID:-${PARALLEL_SEQ:-}}}
usage() {
    echo "usage: PART=1 part.sh PARTS WIDTHxHEIGHT FOLDER SCRIPT [options of glint]; PART comes from the job array or from parallel" >&2
    exit 2
}
[ $# -ge 4 ] && [ -n "$part" ] || usage
parts=$1 width=${2%x*} height=${2#*x} folder=$3
case $part$parts$width$height in *[!0-9]*) usage ;; esac
if [ "$part" -lt 1 ] || [ "$part" -gt "$parts" ] || [ "$parts" -gt "$height" ]; then
    echo "part.sh: expected a part from 1 to $parts (at most one for each of $height rows), got $part" >&2
    exit 2
fi
shift 3
top=$((height * (part - 1) / parts)) bottom=$((height * part / parts))
[ -z "${SLURM_CPUS_PER_TASK:-}" ] || set -- "$@" --threads "$SLURM_CPUS_PER_TASK"
exec "${GLINT:-glint}" "$@" --size "${width}x$height" --region "0,$top,$width,$((bottom - top))" \
    -o "$folder/%04d/$(printf %04d "$part").png"
