#!/usr/bin/env bash
# Tests the Makefile for macOS and BSDs on this machine: runs `make install` with these systems' names for the
# compiler's target and for Lua, and with stand-ins for their tools that refuse GNU-only options. No built program
# runs: only a real machine can test that.
. tests/command/prelude.sh
tools=$work/tools
mkdir "$tools"

# tool NAME PATTERN REAL    Makes a tool that refuses arguments like PATTERN, and otherwise runs REAL.
tool() {
    printf '#!/bin/sh\nfor a; do case $a in %s) echo "%s: what is $a?" >&2; exit 64 ;; esac; done\nexec %s "$@"\n' \
        "$2" "$1" "$3" >"$tools/$1"
    chmod +x "$tools/$1"
}
tool install '-D|-t|--*' "$(command -v install)"
tool sed '--*|*"\\|"*|*"\\+"*' "$(command -v sed) --posix" # which knows nothing of GNU's
tool ln '-*[rTt]*' "$(command -v ln)"

# The compiler: prints its machine, logs its arguments, and creates its output; programs are scripts that run.
cat >"$tools/cc" <<'END'
#!/bin/sh
case $1 in
-dumpmachine) echo "$MACHINE"; exit ;;
-dumpfullversion | -print-multiarch) exit 1 ;;
esac
echo "$*" >>"$CALLS"
while [ $# -gt 1 ]; do
    [ "$1" != -o ] || { printf '#!/bin/sh\necho "$*"\n' >"$2"; chmod +x "$2"; }
    shift
done
END
printf '#!/bin/sh\n: >"$2"\n' >"$tools/ar" # qcs ARCHIVE
printf '#!/bin/sh\necho "strip $*" >>"$CALLS"\n' >"$tools/strip"
# Packages under these systems' names: Lua's own name, and only the other libraries that glint requires.
cat >"$tools/pkg-config" <<'END'
#!/bin/sh
for a; do case $a in -*) ;; *)
    case " $LUA_IS libpng zlib libxxhash " in *" $a "*) ;; *) exit 1 ;; esac
    case $1 in --libs) echo "-l$a" ;; --cflags) echo "-I/opt/$a" ;; esac ;;
esac; done
END
chmod +x "$tools"/*

# system NAME MACHINE LUA    Installs for that system into $there. $calls has the compiler's arguments, one call per
# line.
system() {
    there=$work/$1 calls=$work/$1.calls name=$1
    check "$1: make install" env -i PATH="$tools:$PATH" HOME="$HOME" MACHINE="$2" LUA_IS="$3" CALLS="$calls" \
        "${MAKE:-make}" -s --no-print-directory install CC=cc AR=ar BUILD="$work/$1.build" PREFIX=/opt/glint DESTDIR="$there"
}
made() { grep -E -- "-o [^ ]*/$1\$" "$calls"; } # FILE: how it was made
has() { made "$1" | grep -qE -- "$2"; }       # FILE PATTERN
links() { # FILE LINK...: each is one to it
    for link in "${@:2}"; do [ "$(readlink "$there/opt/glint/lib/$link")" = "$1" ] || return 1; done
}
kernels() { sed -n 's/.* -DGLINT_ISA=\([a-z0-9]*\) .*/\1/p' "$calls" | sort -u | tr '\n' ' '; }
all_c11() { [ "$(grep -c -- '-c ' "$calls")" -gt 300 ] && ! grep -- '-c ' "$calls" | grep -vq -- '-std=c11 .*-ffp-contract=off'; }
everywhere() {
    check "$name: every file is compiled by the rules of bits" all_c11
    check "$name: the command, the module, the archive, the header" env -C "$there/opt/glint" test -x bin/glint -a -s lib/lua/5.4/glint.so -a \
        -e lib/libglint.a -a -s include/glint.h -a -s include/glint_programs.h -a -s lib/pkgconfig/glint.pc -a -s share/lua/5.4/gr.lua -a -s share/doc/glint/engine.md
    check "$name: links of pages lead to pages" eval '! grep -nE "]\((\.\./)*(bindings|engine|scripts|tests)/|]\([a-z_]*\.(lua|c)\)" "$there"/opt/glint/share/doc/glint/*.md'
    check "$name: Lua in the command, by its name there" has glint "-l$lua "
    check "$name: no Lua in the module" eval '! has glint.so "-llua"'
}

lua=lua5.4
system macos arm64-apple-darwin23.1.0 $lua
everywhere
check "macos: generic kernels" test "$(kernels)" = "generic "
check "macos: the library's name" has libglint.0.3.0.dylib '-dynamiclib -Wl,-install_name,/opt/glint/lib/libglint\.0\.3\.dylib'
check "macos: links to it" links libglint.0.3.0.dylib libglint.dylib libglint.0.3.dylib
check "macos: a bundle" has glint.so '-bundle -undefined dynamic_lookup'
check "macos: nothing of ELF" eval '! grep -E -- "-soname|-z,|version-script|as-needed|-Wl,-E|-ldl|-shared" "$calls"'
check "macos: what is exported, by Apple's names" eval 'test "$(grep -c "^_glint_[a-z0-9_]*$" "$work/macos.build/libglint.map")" -gt 100 &&
    ! grep -v "^_glint_" "$work/macos.build/libglint.map"'
check "macos: strip knows these" eval '[ "$(grep -c "^strip -S -x .*/\(glint\|glint.so\|libglint.0.3.0.dylib\)$" "$calls")" = 3 ] &&
    grep -q "^strip -S .*/libglint.a$" "$calls" && ! grep "^strip.* --" "$calls"'
system macos_intel x86_64-apple-darwin22.6.0 $lua
check "macos: on Intel's processors all kernels" test "$(kernels | wc -w)" = 3

for row in "freebsd x86_64-unknown-freebsd14.0 lua-5.4" "openbsd amd64-unknown-openbsd7.4 lua54" "netbsd x86_64--netbsd lua-5.4"; do
    read -r name machine lua <<<"$row"
    system "$name" "$machine" "$lua"
    everywhere
    check "$name: the kernels of x86-64" test "$(kernels)" = "avx2 avx512 generic "
    check "$name: a shared library of ELF" has libglint.so.0.3.0 '-shared -Wl,-soname,libglint\.so\.0\.3 +-Wl,--version-script'
    check "$name: links to it" links libglint.so.0.3.0 libglint.so libglint.so.0.3
    check "$name: no libdl, which Linux has" eval '! grep -- "-ldl" "$calls"'
    check "$name: relro and now" has glint '-Wl,-z,relro -Wl,-z,now'
done
totals
