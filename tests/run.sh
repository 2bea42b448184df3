#!/usr/bin/env bash
# Runs JOBS tests at a time. Prints a line when a test ends, and finally the totals: 'N passed, N failed, N skipped'.
#   run.sh ITEM...    an item is a C test program, a .lua file, a .sh file, make:TARGET, or fuzz:NAME
# From the environment: BUILD (the build folder), T (runs only items whose name contains it), JOBS (default: the
# number of processors), PRELOAD (a sanitizer's runtime, for the Lua tests), LUA, MAKE, EMULATOR (the program that
# runs C tests), TEST_LIMIT_S (for one item). A test exits with 0 when it passes and with 77 when it cannot run here.
# Its output goes to BUILD/tests/log/NAME and is shown when it fails. Cases are counted from a line of totals like the
# last line of run.sh, from cmocka's lines or from TAP; a test that prints none of these counts as one. Tests run in
# parallel, so each test keeps its files in its own folder.
set -u

BUILD=${BUILD:-build}
export BUILD GLINT="$PWD/$BUILD/glint" LUA_CPATH="$PWD/$BUILD/?.so;;"
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1} UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
export GLINT_FONT=bitmap # text has the same pixels, whatever fonts this machine has
export LSAN_OPTIONS=${LSAN_OPTIONS:-print_suppressions=0}
log_folder=$BUILD/tests/log
limit_s=${TEST_LIMIT_S:-300}

run_item() {
    case $1 in
    fuzz:*) bash tests/fuzz/fuzz.sh "${1#fuzz:}" ;;
    make:*) ${MAKE:-make} --no-print-directory "${1#make:}" ;;
    *.lua) LD_PRELOAD=${PRELOAD:-} timeout "$limit_s" "${LUA:-lua5.4}" "$1" ;;
    *.sh) timeout "$limit_s" bash "$1" ;;
    *) timeout "$limit_s" ${EMULATOR:-} "$1" ;;
    esac
}

count() { grep -cE "$1" "$2" || true; }

# Sets good, bad and skips from a test's log: its final line of totals, otherwise cmocka's lines and TAP.
read_cases() {
    local totals
    totals=$(grep -E '^[0-9]+ passed, [0-9]+ failed(, [0-9]+ skipped)?$' "$1" | tail -n 1 | tr -dc '0-9 ')
    if [ -n "$totals" ]; then
        read -r good bad skips _ <<<"$totals 0"
        return
    fi
    skips=$(count '^(\[  SKIPPED \] [a-zA-Z_]+$|ok .*# (skip|SKIP))' "$1")
    good=$(($(count '^(\[       OK \]|ok )' "$1") - $(count '^ok .*# (skip|SKIP)' "$1")))
    bad=$(count '^(\[  FAILED  \] [a-zA-Z_0-9]+$|not ok )' "$1")
}

# Prints the line of one finished test; sets good, bad and skips.
tell() {
    local name=$1 status=$2 log=$3 seconds=$4
    good=0 bad=0 skips=1
    if [ "$status" -eq 77 ]; then
        printf 'skip  %-24s %s\n' "$name" "$(tail -n 1 "$log")"
        return
    fi
    read_cases "$log"
    if [ "$status" -eq 0 ] && [ "$bad" -eq 0 ]; then
        [ "$good" -gt 0 ] || good=1
        printf 'ok    %-24s %5d %-6s %6.1f s\n' "$name" "$good" "$([ "$good" -eq 1 ] && echo case || echo cases)" "$seconds"
    else
        [ "$bad" -gt 0 ] || bad=1
        sed 's/^/    | /' "$log" | tail -n 60
        [ "$status" -ne 124 ] || echo "    | stopped after $limit_s s"
        printf 'FAIL  %-24s %5d failed, exit %d, all of it in %s\n' "$name" "$bad" "$status" "$log"
    fi
    grep -E '(^|# )(skip|SKIP|skipped|\[  SKIPPED \] [a-zA-Z_]+)( |:|$)' "$log" | sort -u | sed 's/^/        /'
}

# Runs one item. Prints its lines together, and writes its totals to NAME.count.
if [ "${1:-}" = --one ]; then
    name=$(basename "${2#*:}")
    log=$log_folder/$name
    start=$(date +%s%N)
    run_item "$2" >"$log" 2>&1 </dev/null
    status=$?
    tell "$name" "$status" "$log" "$(awk "BEGIN { print ($(date +%s%N) - $start) / 1e9 }")" >"$log.told"
    echo "$good $bad $skips" >"$log.count"
    cat "$log.told"
    rm -f "$log.told"
    exit 0
fi

mkdir -p "$log_folder"
items=() counts=()
for item in "$@"; do
    name=$(basename "${item#*:}")
    case $name in *"${T:-}"*) ;; *) continue ;; esac
    items+=("$item")
    counts+=("$log_folder/$name.count")
    echo "0 1 0" >"$log_folder/$name.count" # until it has ended
done
if [ ${#items[@]} -eq 0 ]; then
    echo "no test has '${T:-}' in its name" >&2
    exit 2
fi
printf '%s\0' "${items[@]}" | xargs -0 -n 1 -P "${JOBS:-$(getconf _NPROCESSORS_ONLN)}" bash "$0" --one
echo
awk '{ good += $1; bad += $2; skips += $3 }
     END { printf "%d passed, %d failed, %d skipped\n", good, bad, skips; exit bad > 0 }' "${counts[@]}"
