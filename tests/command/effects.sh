#!/usr/bin/env bash
# Only what is called for: an effect that a scene does not call for has no rays, no stage and no function called.
# `make bench-effects` compares instructions too.
if ! command -v valgrind >/dev/null; then
    echo "valgrind is not there"
    exit 77
fi
if [ -n "${PRELOAD:-}" ] || ldd "$BUILD/glint" | grep -qE "lib[at]san"; then
    echo "valgrind does not run what a sanitizer has compiled"
    exit 77
fi
exec "${LUA:-lua5.4}" tests/effects/table.lua check "$BUILD"
