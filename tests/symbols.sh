#!/bin/sh
# symbols.sh MODULE OBJECT...: kernel objects define only the entry points and the table of their instruction set, and
# have no hardening; the module exports one function. A shared inline function compiled for AVX and chosen by the
# linker would fail on a processor without AVX.
set -u
module=$1
shift
bad=0
for object in "$@"; do
    isa=$(basename "$object" .o | cut -s -d . -f 2) # avx2 for points.avx2.f64.o; empty for ref.o
    if nm -g --defined-only "$object" | awk '{ print $3 }' | grep -vE "^glint_(stages_${isa:-ref}${isa:+|${isa}_[a-z0-9_]+})$"; then
        echo "^ $object: globals of ${isa:-ref} expected"
        bad=1
    fi
    if nm "$object" | grep -qE ' [wWuvV] [^_]'; then
        echo "$object: weak symbols:" "$(nm "$object" | grep -E ' [wWuvV] ')"
        bad=1
    fi
done
# Kernels have no run-time checks, whatever flags a package adds: every instruction counts.
for object in "$@"; do
    if nm -u "$object" | grep -q '_chk'; then
        echo "$object: hardened:" $(nm -u "$object" | grep '_chk')
        bad=1
    fi
done
exported=$(nm -D --defined-only "$module" | awk '{ print $3 }')
if [ "$exported" != luaopen_glint ]; then
    echo "$module: luaopen_glint alone expected, got:" $exported
    bad=1
fi
exit $bad
