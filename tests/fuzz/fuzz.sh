#!/usr/bin/env bash
# fuzz.sh NAME...: runs each fuzzer from its corpus for FUZZ_SECONDS (60) or FUZZ_RUNS inputs, with FUZZ_SEED, and
# prints a line of TAP for it. Failing inputs are stored in $FUZZ/found/NAME-*, and the fuzzer's report is printed
# above the line. New inputs that reach more code are stored in $FUZZ/corpus/NAME.
set -u
seconds=${FUZZ_SECONDS:-60}
bad=0
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1
mkdir -p "$FUZZ/found"
for name in "$@"; do
    mkdir -p "$FUZZ/corpus/$name"
    log=$FUZZ/found/$name.log
    dictionary=tests/fuzz/$name.dict
    if "$FUZZ/tests/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=4096 \
        ${FUZZ_RUNS:+-runs=$FUZZ_RUNS} ${FUZZ_SEED:+-seed=$FUZZ_SEED} \
        $([ -e "$dictionary" ] && echo "-dict=$dictionary") -artifact_prefix="$FUZZ/found/$name-" \
        "$FUZZ/corpus/$name" "tests/fuzz/corpus/$name" >"$log" 2>&1; then
        echo "ok - $name: $(grep -E '^Done ' "$log"), $(grep -oE 'cov: [0-9]+' "$log" | tail -n 1)"
    else
        grep -vE '^#[0-9]+|^INFO' "$log" | tail -n 60
        echo "not ok - $name: see $log"
        bad=1
    fi
done
exit $bad
