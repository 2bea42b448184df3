# Shared by the tests of the command. Each test sources this file first, from the top of the checkout, and ends with
# `totals`. The file sets root, build, glint and GLINT (the command) and work (a temporary folder, removed at the end),
# and counts checks.
# shellcheck shell=bash disable=SC2034
set -u
root=$PWD build=${BUILD:-build}
glint=$(realpath "${GLINT:-$build/glint}")
export GLINT=$glint
work=$(mktemp -d /tmp/glint-test.XXXXXX)
trap 'rm -rf "$work" "$work.log"' EXIT
passed=0 failed=0 skipped=0

pass() { passed=$((passed + 1)); }
fail() {
    failed=$((failed + 1))
    echo "not ok - $*"
}
skip() {
    skipped=$((skipped + 1))
    echo "skip: $*"
}
totals() {
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" -eq 0 ]
}

# check NAME COMMAND...: the command must succeed; its output is shown if it fails
check() {
    local name=$1
    shift
    if "$@" >"$work.log" 2>&1; then pass; else
        fail "$name"
        tail -n 20 "$work.log"
    fi
}
# result STATUS NAME: reports success for 0, otherwise shows out and err
result() {
    if [ "$1" -eq 0 ]; then pass; else
        fail "$2"
        cat out err 2>/dev/null
    fi
}

# run ARGUMENTS...: runs the command with its streams in out and err, and its exit code in $status
run() {
    timeout 120 "$GLINT" "$@" >out 2>err </dev/null
    status=$?
}
# exits WANT NAME ARGUMENTS...: the command must exit with WANT
exits() {
    local want=$1 name=$2
    shift 2
    run "$@"
    if [ "$status" -eq "$want" ]; then pass; else fail "$name: exit $status, not $want: $(head -n 3 err)"; fi
}
says() { if grep -qE -- "$2" err; then pass; else fail "$1: stderr says: $(head -n 3 err)"; fi; }    # NAME PATTERN
prints() { if grep -qE -- "$2" out; then pass; else fail "$1: stdout says: $(head -n 3 out)"; fi; } # NAME PATTERN
