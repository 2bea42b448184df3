#!/usr/bin/env bash
# The renderer alone, without figures, files and comparison: a program of it and of C's library renders the workshop
# with the command's bits.
. tests/command/prelude.sh
alone=$(realpath "$build/tests/command/alone") || exit 1
cd "$work" || exit 1
"$glint" "$root/scripts/workshop.lua" --size 160x90 -q -o command.pfm
check "it runs" sh -c '"$1" 160 90 >alone.pfm' - "$alone"
check "the light is the command's" cmp command.pfm alone.pfm
if command -v ldd >/dev/null && ldd "$alone" >libraries 2>/dev/null; then
    check "it needs C's library alone" sh -c '! grep -vE "linux-vdso|ld-linux|lib(c|m|pthread|asan|ubsan|tsan|gcc_s|stdc\+\+|dl|rt)\.so|ld-musl" libraries'
fi
totals
