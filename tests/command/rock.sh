#!/usr/bin/env bash
# Installs the rock of `make dist` into an empty folder; without git and zip, the result of `luarocks make`. The module
# must load in plain Lua and render, the command must run, and removing the rock must remove both.
. tests/command/prelude.sh
rocks() { HOME=$work MAKEFLAGS="-j2 -- KERNELS=native FLOAT= KERNEL_CFLAGS=-O1" luarocks --lua-version 5.4 --tree "$work/tree" "$@"; }

command -v luarocks >/dev/null || {
    echo "skip: luarocks is not installed"
    exit 77
}
version=$(sed -n 's/^.define GLINT_VERSION "\(.*\)"/\1/p' engine/glint.h)
rockspec=bindings/glint-$version-1.rockspec
check "the rockspec has the engine's version" grep -qx "version = \"$version-1\"" "$rockspec"
unset LUA_PATH LUA_CPATH MAKEFLAGS MFLAGS
if command -v zip >/dev/null && git rev-parse --git-dir >/dev/null 2>&1; then
    check "make dist" make -s BUILD="$work/build" dist
    check "the archive is the same again" eval 'sum=$(cksum <"$work/build/dist/glint-$version.tar.gz") &&
        make -s BUILD="$work/build" dist && [ "$(cksum <"$work/build/dist/glint-$version.tar.gz")" = "$sum" ]'
    check "luarocks install" rocks install "$work/build/dist/glint-$version-1.src.rock"
else
    check "luarocks make" rocks make "$rockspec"
fi
check "the rock is there" grep -q "$version-1 (installed)" <(rocks list --porcelain 2>/dev/null | sed 's/\t/ /g; s/ installed / (installed) /')

cat >"$work/scene.lua" <<'END'
local glint = require "glint"
glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1,
  glint.sphere { center = { 0, 0, 0 }, radius = 2 } }:render { width = 32, height = 18, output = arg[1] }
END
check "the module renders in plain Lua" env LUA_CPATH="$work/tree/lib/lua/5.4/?.so" "${LUA:-lua5.4}" "$work/scene.lua" "$work/plain.png"
check "the command renders" "$work/tree/bin/glint" "$work/scene.lua" --quiet -- "$work/command.png"
check "both alike" "$work/tree/bin/glint" compare "$work/plain.png" "$work/command.png" --fail 0 --warn 0
check "float without its kernels" "$work/tree/bin/glint" scripts/mirror_and_glass.lua --precision float --size 64x48 -q -o "$work/float.png"
check "has the golden's pixels" "$work/tree/bin/glint" compare "$work/float.png" tests/golden/mirror_and_glass_float.png
check "luarocks remove" rocks remove glint
check "nothing is left" test -z "$(find "$work/tree" -name 'glint*' -type f)"
totals
