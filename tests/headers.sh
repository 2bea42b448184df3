#!/bin/bash
# headers.sh FLAGS...: each header compiles on its own; kernel headers compile for double and for float. simd/avx2.h
# and simd/avx512.h need their instruction sets. Then tests that unsupported machines are refused.
set -u
bad=0

# alone HEADER FLAG...: includes it twice, to test the guard.
alone() {
    local header=$1
    shift
    if ! printf '#include "%s"\n#include "%s"\nextern int not_empty;\n' "$header" "$header" |
        ${CC:-cc} "$@" -Wno-unused-function -Wno-unused-const-variable -Werror -fsyntax-only -x c -; then
        echo "$header does not compile alone"
        bad=1
    fi
}

for header in $(find engine bindings -name "*.h"); do
    case $header in
    */simd/avx2.h) alone "$header" "$@" -mavx2 -mfma ;;
    */simd/avx512.h) alone "$header" "$@" -mavx512f -mavx512dq -mavx512vl -mavx512bw -mavx2 -mfma ;;
    # generic.h includes neon.h on ARM and wasm.h on WebAssembly; ref.c includes its headers for double and for float
    */simd/neon.h | */simd/wasm.h | engine/render/stages/ref/*.h | engine/render/*/ref.h | engine/render/*/ref_*.h) ;;
    engine/render/stages/contract/*.h) alone "$header" "$@" ;;
    engine/render/stages/*/*.h | engine/render/*/kernel_*.h)
        alone "$header" "$@" -DGLINT_ISA=generic -DGLINT_REAL=64
        alone "$header" "$@" -DGLINT_ISA=generic -DGLINT_REAL=32 ;;
    *) alone "$header" "$@" ;;
    esac
done

# A kernel is not compiled again when the description of a scene gets another field.
for kernel in engine/render/stages/[^rs]*/*.c engine/render/*/kernel*.c engine/render/effects/*/kernel*.c; do
    if ${CC:-cc} "$@" -DGLINT_ISA=generic -DGLINT_REAL=64 -MM "$kernel" | grep -qw 'engine/glint\.h'; then
        echo "$kernel depends on engine/glint.h"
        bad=1
    fi
done

# The public headers work in C++, with C linkage.
if command -v c++ >/dev/null && ! { printf '#include "%s"\n' engine/glint*.h && echo 'int main() { return glint_sin(0) != 0 || !glint_pass_name(GLINT_PASS_DEPTH); }'; } |
    c++ -I. -Wall -Wextra -Werror -x c++ -S -o - - | grep -q '[^0-9]glint_sin'; then
    echo "the public headers do not compile as C++"
    bad=1
fi

# refused SENTENCE FLAG...    Compiling for an unsupported machine must fail with this sentence.
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
# Unsupported machines, if the compiler supports them.
if echo | ${CC:-cc} -m32 -E - >/dev/null 2>&1; then
    refused "without excess precision" -m32 -mfpmath=387 -mno-sse
fi
if command -v s390x-linux-gnu-gcc >/dev/null; then
    CC=s390x-linux-gnu-gcc refused "little-endian machines"
fi
exit $bad
