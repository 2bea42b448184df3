#!/usr/bin/env bash
# libraries.sh FOLDER CC AR: builds zlib, libpng, Lua and xxHash as static libraries for another machine into FOLDER,
# with the compiler CC and the archiver AR. The sources come from Debian's source packages through this machine's apt.
# The machine's packages and lists stay unchanged. Needs apt-get, not root.
set -eu
mkdir -p "$1/sources/lists/partial" "$1/lib/pkgconfig" "$1/include"
prefix=$(cd "$1" && pwd)
export CC=$2 AR=$3 RANLIB="$3 s" CFLAGS=-O2
[ ! -e "$prefix/complete" ] || exit 0
cd "$prefix/sources"

# Turns this machine's apt lists for the release, without its updates, into source lists: both the paragraph and the
# line format.
. /etc/os-release
mkdir -p parts
for list in /etc/apt/sources.list.d/*.sources; do
    [ ! -e "$list" ] || awk -v RS= -v ORS='\n\n' -v release="$VERSION_CODENAME" '
        $0 ~ "Suites:([^\n]* )?" release "( |\n|$)" {
            gsub(/Types:[^\n]*/, "Types: deb-src"); gsub(/Suites:[^\n]*/, "Suites: " release); print }' "$list" >"parts/${list##*/}"
done
cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list 2>/dev/null |
    sed -nE "s/^deb (.* $VERSION_CODENAME .*)/deb-src \\1/p" >parts/lines.list || true

fetch() {
    apt-get -qq -o APT::Sandbox::User=root -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$PWD/parts" \
        -o Dir::State="$PWD" -o Dir::State::lists="$PWD/lists" -o Dir::State::status="$PWD/status" -o Dir::Cache="$PWD" "$@"
}
: >status
fetch update
fetch source --download-only zlib libpng1.6 lua5.4 xxhash >/dev/null
for archive in *.orig.tar.*; do tar -xf "$archive"; done
unset MAKEFLAGS MAKEOVERRIDES # of the make that this is run by

# configure's tests must not run programs of the other machine.
(cd zlib-* && CHOST=$($CC -dumpmachine) ./configure --static --prefix="$prefix" && make AR="$AR" ARFLAGS=rc RANLIB=true libz.a &&
    cp zlib.h zconf.h "$prefix/include" && cp libz.a "$prefix/lib" && cp zlib.pc "$prefix/lib/pkgconfig") >zlib.log 2>&1
(cd libpng-* && CPPFLAGS=-I"$prefix/include" LDFLAGS=-L"$prefix/lib" ./configure --host=none --disable-shared --enable-hardware-optimizations=no \
    --prefix="$prefix" && make install-libLTLIBRARIES install-pkgincludeHEADERS install-pkgconfigDATA \
    install-nodist_pkgincludeHEADERS install-header-links install-library-links install-libpng-pc) >libpng.log 2>&1
(cd lua-* && make -C src CC="$CC" AR="$AR rcu" RANLIB=true SYSCFLAGS=-DLUA_USE_POSIX liblua.a &&
    cp src/lua.h src/luaconf.h src/lauxlib.h src/lualib.h "$prefix/include" && cp src/liblua.a "$prefix/lib") >lua.log 2>&1
(cd xxHash-* && make CC="$CC" AR="$AR" libxxhash.a && cp xxhash.h xxh3.h "$prefix/include" && cp libxxhash.a "$prefix/lib") >xxhash.log 2>&1
# These two install no .pc file, or only by their own install rule.
for library in lua5.4:lua libxxhash:xxhash; do
    printf 'Name: %s\nDescription: for the test\nVersion: 5.4.0\nCflags: -I%s/include\nLibs: -L%s/lib -l%s\n' \
        "${library%:*}" "$prefix" "$prefix" "${library#*:}" >"$prefix/lib/pkgconfig/${library%:*}.pc"
done
rm -rf "$prefix/sources"
touch "$prefix/complete"
