#!/usr/bin/env bash
# libraries.sh FOLDER CC AR [freetype]: builds zlib, libpng, Lua and xxHash, and if asked for FreeType, as static
# libraries for another machine into FOLDER, with the compiler CC and the archiver AR. The sources come from Debian's
# source packages through this machine's apt. The machine's packages and lists stay unchanged. Needs apt-get, not root.
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
fetch source --download-only zlib libpng1.6 lua5.4 xxhash ${4-} >/dev/null
for archive in *.orig.tar.*; do tar -xf "$archive"; done
unset MAKEFLAGS MAKEOVERRIDES # of the make that this is run by

# The configure scripts of zlib and libpng take longer than all of their compilation, and they run or link programs.
(cd zlib-* && sed -i 's/^#ifdef HAVE_UNISTD_H/#if 1/' zconf.h && $CC $CFLAGS -c adler32.c compress.c crc32.c deflate.c gz*.c infback.c inffast.c inflate.c \
    inftrees.c trees.c uncompr.c zutil.c && $AR rc libz.a *.o && cp zlib.h zconf.h "$prefix/include" && cp libz.a "$prefix/lib") >zlib.log 2>&1
(cd libpng-* && cp scripts/pnglibconf.h.prebuilt pnglibconf.h && rm example.c pngtest.c && $CC $CFLAGS -DPNG_ARM_NEON_OPT=0 -I"$prefix/include" -c *.c &&
    $AR rc libpng.a *.o && cp libpng.a "$prefix/lib" && cp png.h pngconf.h pnglibconf.h "$prefix/include") >libpng.log 2>&1
(cd lua-* && make -C src CC="$CC" AR="$AR rcu" RANLIB=true SYSCFLAGS=-DLUA_USE_POSIX liblua.a &&
    cp src/lua.h src/luaconf.h src/lauxlib.h src/lualib.h "$prefix/include" && cp src/liblua.a "$prefix/lib") >lua.log 2>&1
(cd xxHash-* && make CC="$CC" AR="$AR" libxxhash.a && cp xxhash.h xxh3.h "$prefix/include" && cp libxxhash.a "$prefix/lib") >xxhash.log 2>&1
# FreeType for outlines of TrueType fonts without hints, and their pixels.
[ -z "${4-}" ] || (cd freetype-* && cd include/freetype/config &&
    sed -i -E 's@^#define (TT_CONFIG_OPTION_[A-Z_]*|TT_SUPPORT_COLRV1|TT_USE_BYTECODE_INTERPRETER|FT_CONFIG_OPTION_(USE_[A-Z]*|MAC_FONTS|POSTSCRIPT_NAMES|ADOBE_GLYPH_LIST|INCREMENTAL|SVG|ENVIRONMENT_PROPERTIES|GUESSING_EMBEDDED_RFORK))@// \1@' ftoption.h &&
    echo 'FT_USE_MODULE( FT_Driver_ClassRec, tt_driver_class )
        FT_USE_MODULE( FT_Module_Class, sfnt_module_class )
        FT_USE_MODULE( FT_Renderer_Class, ft_smooth_renderer_class )' >ftmodule.h && cd ../../.. &&
    $CC $CFLAGS -DFT2_BUILD_LIBRARY -Iinclude -c src/base/ftsystem.c src/base/ftinit.c src/base/ftbase.c src/base/ftdebug.c src/truetype/truetype.c src/sfnt/sfnt.c src/smooth/smooth.c &&
    $AR rc libfreetype.a *.o && cp libfreetype.a "$prefix/lib" && cp -r include/freetype include/ft2build.h "$prefix/include") >freetype.log 2>&1
# Their .pc files.
for library in zlib:z lua5.4:lua libxxhash:xxhash libpng:png ${4:+freetype2:freetype}; do
    printf 'Name: %s\nDescription: for the test\nVersion: 5.4.0\nCflags: -I%s/include\nLibs: -L%s/lib -l%s\n' \
        "${library%:*}" "$prefix" "$prefix" "${library#*:}" >"$prefix/lib/pkgconfig/${library%:*}.pc"
done
rm -rf "$prefix/sources"
touch "$prefix/complete"
