#!/usr/bin/env bash
# musl_libraries.sh FOLDER: what glint needs, as static libraries for musl, built from Debian's sources into FOLDER. The machine's own
# packages and lists stay as they are; needs apt-get and musl-gcc, not root.
set -eu
mkdir -p "$1/sources/lists/partial" "$1/lib/pkgconfig" "$1/include"
prefix=$(cd "$1" && pwd)
[ ! -e "$prefix/complete" ] || exit 0
cd "$prefix/sources"
. /etc/os-release
cat >debian.sources <<END
Types: deb-src
URIs: http://deb.debian.org/debian
Suites: $VERSION_CODENAME
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
END
: >status
fetch() {
    apt-get -qq -o APT::Sandbox::User=root -o Dir::Etc::sourcelist="$PWD/debian.sources" -o Dir::Etc::sourceparts=/dev/null \
        -o Dir::State="$PWD" -o Dir::State::lists="$PWD/lists" -o Dir::State::status="$PWD/status" -o Dir::Cache="$PWD" "$@"
}
fetch update
fetch source --download-only zlib libpng1.6 lua5.4 xxhash >/dev/null
for archive in *.orig.tar.*; do tar -xf "$archive"; done
unset MAKEFLAGS MAKEOVERRIDES # of the make that this is run by
export CC=musl-gcc
(cd zlib-* && ./configure --static --prefix="$prefix" && make install) >zlib.log 2>&1
(cd libpng-* && CPPFLAGS=-I"$prefix/include" LDFLAGS=-L"$prefix/lib" ./configure --disable-shared --prefix="$prefix" &&
    make install) >libpng.log 2>&1
(cd lua-* && make -C src CC=musl-gcc SYSCFLAGS=-DLUA_USE_LINUX liblua.a &&
    cp src/lua.h src/luaconf.h src/lauxlib.h src/lualib.h "$prefix/include" && cp src/liblua.a "$prefix/lib") >lua.log 2>&1
(cd xxHash-* && make CC=musl-gcc libxxhash.a && cp xxhash.h xxh3.h "$prefix/include" && cp libxxhash.a "$prefix/lib") >xxhash.log 2>&1
# The two that have no .pc of their own, or one for their own install.
for library in lua5.4:lua libxxhash:xxhash; do
    printf 'Name: %s\nDescription: for the test\nVersion: 5.4.0\nCflags: -I%s/include\nLibs: -L%s/lib -l%s\n' \
        "${library%:*}" "$prefix" "$prefix" "${library#*:}" >"$prefix/lib/pkgconfig/${library%:*}.pc"
done
rm -rf "$prefix/sources"
touch "$prefix/complete"
