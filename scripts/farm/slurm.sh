#!/bin/bash
# Renders one shard of a job as a task of a Slurm array; see README.md next to this file.
#     sbatch --array=1-40 slurm.sh 40 SCRIPT [options of glint]
# The first argument is the number of shards, whatever the array contains: --array=7,12 renders two of the 40 again.
#SBATCH --job-name=glint
#SBATCH --requeue
#SBATCH --open-mode=append
set -eu
if [ $# -lt 2 ] || [ -z "${SLURM_ARRAY_TASK_ID:-}" ]; then
    echo "usage: sbatch --array=1-SHARDS slurm.sh SHARDS SCRIPT [options of glint]" >&2
    exit 2
fi
shards=$1
shift
[ -z "${SLURM_CPUS_PER_TASK:-}" ] || set -- "$@" --threads "$SLURM_CPUS_PER_TASK"
echo "shard $SLURM_ARRAY_TASK_ID/$shards on ${SLURMD_NODENAME:-$(hostname)}, restart ${SLURM_RESTART_COUNT:-0}" >&2
exec "${GLINT:-glint}" "$@" --shard "$SLURM_ARRAY_TASK_ID/$shards"
