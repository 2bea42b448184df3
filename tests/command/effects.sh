#!/usr/bin/env bash
# Effects that a scene does not use cost nothing: they cast no rays, run no stage and call no function.
# `make bench-effects` also compares instruction counts.
if ! command -v valgrind >/dev/null; then
    echo "valgrind is not there"
    exit 77
fi
if [ -n "${PRELOAD:-}" ] || ldd "$BUILD/glint" | grep -qE "lib[at]san"; then
    echo "valgrind does not run what a sanitizer has compiled"
    exit 77
fi
exec "${LUA:-lua5.4}" tests/effects/table.lua check "$BUILD"
