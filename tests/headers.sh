#!/bin/bash
# headers.sh FLAGS...: each header compiles alone. A stage's header is written in the vector vocabulary and is included
# by the isa_*.c files only; simd/avx2.h and simd/avx512.h need their instruction sets. Then: which machines are refused.
set -u
bad=0
for header in engine/*.h engine/*/*.h engine/stages/*/*.h engine/effects/*/*.h bindings/*/*.h; do
    flags=()
    case $header in
    *simd/avx2.h) flags=(-mavx2 -mfma) ;;
    *simd/avx512.h) flags=(-mavx512f -mavx512dq -mavx512vl -mavx512bw -mavx2 -mfma) ;;
    */simd/generic.h | engine/stages/stages.h | engine/stages/contract/*.h | */coefficients.h) ;;
    engine/stages/*/*.h) continue ;;
    esac
    # Twice: the guard holds.
    if ! printf '#include "%s"\n#include "%s"\nextern int not_empty;\n' "$header" "$header" |
        ${CC:-cc} "$@" "${flags[@]}" -Wno-unused-function -Wno-unused-const-variable -Werror -fsyntax-only -x c -; then
        echo "$header does not compile alone"
        bad=1
    fi
done

# refused SENTENCE FLAG...    A machine that the engine does not work on is refused with a sentence.
refused() {
    local sentence=$1 said
    shift
    if said=$(echo '#include "engine/base/machine.h"' | ${CC:-cc} -I. "$@" -fsyntax-only -x c - 2>&1) ||
        [[ $said != *"$sentence"* ]]; then
        printf '%s: "%s" expected, got: %s\n' "$*" "$sentence" "$said"
        bad=1
    fi
}
refused "little-endian machines" -U__BYTE_ORDER__ -D__BYTE_ORDER__=__ORDER_BIG_ENDIAN__
refused "without excess precision" -U__FLT_EVAL_METHOD__ -D__FLT_EVAL_METHOD__=2
refused "same bits" -ffast-math
# Of machines' own compilers, where they are there.
if echo | ${CC:-cc} -m32 -E - >/dev/null 2>&1; then
    refused "without excess precision" -m32 -mfpmath=387 -mno-sse
fi
if command -v s390x-linux-gnu-gcc >/dev/null; then
    CC=s390x-linux-gnu-gcc refused "little-endian machines"
fi
exit $bad
