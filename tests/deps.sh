#!/bin/sh
# The Debian packages that glint needs.
#   deps.sh need          lists missing packages for the build, and fails if there are any; installs nothing
#   deps.sh WHAT ...      installs missing packages with apt: build, test, bench (speed comparisons), films (the test
#                         with ffmpeg and Chromium), rock (the test of the rockspec), farm (the test of scripts/farm),
#                         arm64 (the tests under qemu), musl (the tests of a static command), web (the module for
#                         browsers), fuzz (the fuzzers), package (the test of Debian's source package), ci (what only .ci/run uses)
set -eu

# package, and a test for its presence
build_required='
pkg-config      command:pkg-config
liblua5.4-dev   module:lua5.4|lua-5.4|lua54
libpng-dev      module:libpng
zlib1g-dev      module:zlib
libxxhash-dev   module:libxxhash
'
build_optional='
libisal-dev     module:libisal
libdeflate-dev  module:libdeflate
libopenexr-dev  module:OpenEXR
libfreetype-dev module:freetype2
fonts-dejavu-core file:/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
libcairo2-dev   module:cairo-ft
libjpeg-dev     module:libjpeg
libsixel-dev    module:libsixel
libseccomp-dev  module:libseccomp
libzstd-dev     module:libzstd
'
test_required='
libcmocka-dev   module:cmocka
libmpfr-dev     module:mpfr
lua5.4          command:lua5.4|lua-5.4|lua54
'
test_optional='
locales         file:/usr/share/i18n/locales/de_DE
librsvg2-bin    command:rsvg-convert
poppler-utils   command:pdftoppm
python3-numpy   file:/usr/lib/python3/dist-packages/numpy
lua-check       command:luacheck
cppcheck        command:cppcheck
povray          command:povray
cmake           command:cmake
'
films_optional='
ffmpeg          command:ffmpeg
chromium        command:chromium
'
rock_required='
luarocks        command:luarocks
zip             command:zip
'

bench_required='
lua5.4          command:lua5.4|lua-5.4|lua54
'
bench_optional='
libembree-dev   header:embree3/rtcore.h
povray          command:povray
cmake           command:cmake
tachyon         command:tachyon
'
farm_optional='
parallel        command:parallel
'
arm64_required='
gcc-aarch64-linux-gnu command:aarch64-linux-gnu-gcc
libc6-dev-arm64-cross file:/usr/aarch64-linux-gnu/include/stdio.h
qemu-user       command:qemu-aarch64
'
musl_required='
musl-tools      command:musl-gcc
'
web_required='
emscripten      command:emcc
nodejs          command:node
npm             command:npm
fonts-dejavu-core file:/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
python3-fonttools file:/usr/lib/python3/dist-packages/fontTools
'
package_optional='
dpkg-dev        command:dpkg-buildpackage
debhelper       command:dh
lintian         command:lintian
'
ci_optional='
ccache          command:ccache
'
fuzz_required='
clang           command:clang
'

# any NAME|NAME... COMMAND...    Whether the command accepts one of the names.
any() {
    names=$1
    shift
    for name in $(echo "$names" | tr '|' ' '); do
        "$@" "$name" >/dev/null 2>&1 && return 0
    done
    return 1
}

present() {
    case $1 in
    file:*) [ -e "${1#file:}" ] ;;
    command:*) any "${1#command:}" command -v ;;
    header:*) echo "#include <${1#header:}>" | "${CC:-cc}" -E - >/dev/null 2>&1 ;;
    module:*) any "${1#module:}" pkg-config --exists ;;
    esac
}

# Prints the missing packages of a list.
missing() {
    printf '%s' "$1" | while read -r package test; do
        [ -z "$package" ] || present "$test" || printf ' %s' "$package"
    done
}

# Installs packages. Fails when apt fails.
install() {
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "deps: no apt-get on this system; install the equivalents of:$*" >&2
        return 1
    fi
    sudo=
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null 2>&1; then
            echo "deps: neither root nor sudo here; ask someone who may:  apt-get install$*" >&2
            return 1
        fi
        sudo=sudo
    fi
    echo "deps: installing through apt:$*"
    # shellcheck disable=SC2086,SC2048
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends $* >&2 && return 0
    echo "deps: once more, after apt-get update"
    $sudo apt-get update -qq || true
    # shellcheck disable=SC2086,SC2048
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends $* >&2
}

require() {
    lacking=$(missing "$1")
    [ -n "$lacking" ] || return 0
    install "$lacking" || {
        echo "deps: cannot go on without:$lacking" >&2
        exit 1
    }
    lacking=$(missing "$1")
    [ -z "$lacking" ] || {
        echo "deps: installed, and still not found:$lacking" >&2
        exit 1
    }
}

prefer() {
    lacking=$(missing "$1")
    [ -n "$lacking" ] || return 0
    install "$lacking" || echo "deps: going on without:$lacking ($2)" >&2
}

for what in "$@"; do
    case $what in
    need)
        lacking=$(missing "$build_required")
        [ -z "$lacking" ] || {
            echo "glint cannot be built without:$lacking" >&2
            echo "Get it with:  make deps   (or: apt-get install$lacking)" >&2
            exit 1
        }
        ;;
    build)
        require "$build_required"
        prefer "$build_optional" "without libisal and libdeflate PNG files are written with zlib, without libopenexr there is no .exr, without libfreetype and a font text is of a bitmap font, without libcairo2 there is no .pdf, without libjpeg there are no JPEG textures, without libseccomp there is no --untrusted, without libzstd .zst files are not read"
        ;;
    test)
        require "$test_required"
        prefer "$test_optional" "the tests that need it will be skipped"
        ;;
    bench)
        require "$bench_required"
        prefer "$bench_optional" "their rows will be empty"
        ;;
    films) prefer "$films_optional" "the tests that need it will be skipped" ;;
    rock) require "$rock_required" ;;
    arm64) require "$arm64_required" ;;
    musl) require "$musl_required" ;;
    web) require "$web_required" ;;
    ci) prefer "$ci_optional" "equal objects will be compiled again" ;;
    package) prefer "$package_optional" "the test that needs it will be skipped" ;;
    fuzz) require "$fuzz_required" ;;
    farm) prefer "$farm_optional" "the test that needs it will be skipped" ;;
    *)
        echo "usage: deps.sh need | build | test | bench | films | rock | farm | arm64 | musl | web | fuzz | package | ci ..." >&2
        exit 2
        ;;
    esac
done
