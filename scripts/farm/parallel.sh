#!/bin/bash
# Runs the shards of a job with GNU parallel, one at a time on each machine; see README.md next to this file.
#     parallel.sh SHARDS SCRIPT [options of glint]
#     PARALLEL="-S node1,node2 --workdir ." parallel.sh 40 SCRIPT [options of glint]
set -eu
if [ $# -lt 2 ]; then
    echo "usage: parallel.sh SHARDS SCRIPT [options of glint]" >&2
    exit 2
fi
shards=$1
shift
# A shard that fails is tried twice more. A shard of a lost machine is run again by another machine.
exec parallel --jobs "${JOBS:-1}" --tag --line-buffer --retries 3 --quote \
    "${GLINT:-glint}" "$@" --shard "{}/$shards" ::: $(seq "$shards")
