#!/usr/bin/env bash
# make install into an empty folder: the command, the module, the manual page, the completions, and a C program built
# only against the installed files. make uninstall removes everything.
. tests/command/prelude.sh
prefix=$work/usr

quiet_make() { ${MAKE:-make} -s --no-print-directory BUILD="$build" "$@"; }

check "make install" quiet_make install PREFIX="$prefix"
check "the command" "$prefix/bin/glint" --version
check "the module, in plain Lua" env LUA_CPATH="$prefix/lib/lua/5.4/?.so" "${LUA:-lua5.4}" -e \
    'assert(require("glint").version)'
check "the modules in Lua" env LUA_CPATH="$prefix/lib/lua/5.4/?.so" LUA_PATH="$prefix/share/lua/5.4/?.lua" \
    "${LUA:-lua5.4}" -e 'assert(require("glint.particles").new and require("glint.xyz").frames)'
cat >"$work/own.lua" <<'END'
local particles, xyz = require "glint.particles", require "glint.xyz"
io.stderr:write(assert(package.searchpath("glint.particles", package.path)), "\n")
assert(particles.new and xyz.frames)
END
own() { # PREFIX: the command finds the modules of its own prefix, whether or not another glint is installed
    env -C "$work" -u LUA_PATH -u LUA_PATH_5_4 "$1/bin/glint" own.lua 2>&1 | head -n 1 | grep -Fq "$1/bin/../share/lua/5.4/glint/particles.lua"
}
check "the command finds its own modules" own "$prefix"
cp -r "$prefix" "$work/else where"
check "from any place" own "$work/else where"
found_by() { # PROGRAM: started by a name of another kind, it still lies in $prefix/bin
    env -C "$prefix/bin" -u LUA_PATH -u LUA_PATH_5_4 "$1" "$work/own.lua" 2>&1 | head -n 1 |
        grep -Fq "$prefix/bin/../share/lua/5.4/glint/particles.lua"
}
ln -s "$prefix/bin/glint" "$work/link"
check "found by PATH" env PATH="/nowhere:$prefix/bin:$PATH" bash -c "$(declare -f found_by); prefix='$prefix' work='$work' found_by glint"
check "found by an empty folder of PATH" env PATH=":$PATH" bash -c "$(declare -f found_by); prefix='$prefix' work='$work' found_by glint"
check "found by a path from here" found_by ./glint
check "found by a link" found_by "$work/link"
# Another version next to the first, with an incompatible engine and modules: each must use its own.
cp -r "$prefix" "$work/second"
echo 'error "a module of the second"' | tee "$work/second/share/lua/5.4/glint/"{particles,xyz}.lua >/dev/null
echo 'the engine of the second' >"$work/second/lib/lua/5.4/glint.so"
check "a second glint is no problem" eval '(export PATH=$work/second/bin:$PATH LUA_CPATH="$work/second/lib/lua/5.4/?.so;;"; own "$prefix")'
check "and has modules of its own" eval 'env -C "$work" -u LUA_PATH "$work/second/bin/glint" own.lua 2>&1 | grep -q "a module of the second"'
check "LUA_PATH comes first" eval '(cd "$work" && mkdir -p mine/glint && echo "return { new = true }" >mine/glint/particles.lua &&
    LUA_PATH="$work/mine/?.lua;;" "$prefix/bin/glint" own.lua 2>&1 | head -n 1 | grep -q mine/glint)'
check "its page names the examples where they are" eval '! grep -qE "glint( [a-z]+)? scripts/" "$prefix/share/doc/glint/"*.md'
check "and they run as it says" eval '(cd "$work" && PATH=$prefix/bin:$PATH &&
    $(grep -oE "glint [^ ]*/workshop\.lua --help" "$prefix/share/doc/glint/examples.md") | grep -q "shininess")'
check "an example, with its data" env -C "$work" "$prefix/bin/glint" "$prefix/share/glint/examples/molecule.lua" --size 32x24 -q
for name in $(sed -nE '/share\/glint\/examples/,/share\/doc/p' bindings/glint.1 | grep -oE '[a-z_]+\.lua'); do
    check "the example $name of the manual page" test -s "$prefix/share/glint/examples/$name"
done
for page in $(sed -nE '/share\/doc\/glint/,$p' bindings/glint.1 | grep -oE '[a-z\\-]+\.md' | tr -d '\\'); do
    check "the page $page" test -s "$prefix/share/doc/glint/$page"
done
for module in scripts/lib/glint/*.lua; do
    name=$(basename "$module" .lua)
    check "the page of glint.$name" grep -qx "## glint.$name" "$prefix/share/doc/glint/data.md"
    for f in $(grep -oE "^function $name[.:][a-z_]+" "$module" | sed 's/^function //'); do
        check "data.md has $f" grep -Fq "### \`$f(" "$prefix/share/doc/glint/data.md"
    done
done
check "links of the pages lead somewhere" eval '(cd "$prefix/share/doc/glint" &&
    for link in $(grep -ohE "\]\([a-zA-Z_/.-]+\.(md|lua|c)" *.md | cut -c 3-); do
        [ -e "$link" ] || { echo "$link"; exit 1; }; done)'
echo 'gr.render(gr.node "root", "empty", 8, 6, { 0, 0, 9 }, { 0, 0, -1 }, { 0, 1, 0 }, 50, { 0, 0, 0 }, {})' >"$work/gr.lua"
check "the dialect" env -C "$work" "$prefix/bin/glint" --dialect gr gr.lua
check "the dialect, in plain Lua" env -C "$work" LUA_CPATH="$prefix/lib/lua/5.4/?.so" \
    LUA_PATH="$prefix/share/lua/5.4/?.lua" "${LUA:-lua5.4}" -l gr gr.lua
check "the manual page" grep -q '^\.TH GLINT 1' "$prefix/share/man/man1/glint.1"
check "its version" grep -q "\"glint $("$prefix/bin/glint" --version | cut -d ' ' -f 2)\"" "$prefix/share/man/man1/glint.1"
for file in bash-completion/completions/glint zsh/site-functions/_glint fish/vendor_completions.d/glint.fish; do
    check "$file" grep -q reuse-memory "$prefix/share/$file"
done

# The C examples, from copies outside the checkout.
cp scripts/c_example.c scripts/c_pattern.c "$work/"
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
check "pkg-config knows it" pkg-config --exists --print-errors "glint = $("$prefix/bin/glint" --version | cut -d ' ' -f 2)"
compile() { # in the folder of the example
    cd "$work" && ${CC:-cc} -std=c11 -Wall -Wextra -Werror "$1.c" $(pkg-config --cflags --libs glint) -o "$1"
}
check "the C example compiles" eval '(compile c_example)'
check "and runs with the shared library" env -C "$work" LD_LIBRARY_PATH="$prefix/lib" ./c_example
check "the C example of patterns compiles" eval '(compile c_pattern)'
check "and runs" env -C "$work" LD_LIBRARY_PATH="$prefix/lib" ./c_pattern
if command -v cmake >/dev/null; then
    mkdir -p "$work/by_cmake"
    cat >"$work/by_cmake/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.13)
project(by_cmake C)
find_package(glint ${WANTED} REQUIRED)
add_executable(c_example ../c_example.c)
target_link_libraries(c_example glint::glint)
END
    by_cmake() { cmake -S "$work/by_cmake" -B "$work/by_cmake/$1" -DCMAKE_PREFIX_PATH="$prefix" -DWANTED="$1"; }
    version=$("$prefix/bin/glint" --version | sed 's/^glint //; s/ .*//')
    check "CMake finds it" eval 'by_cmake "$version" && cmake --build "$work/by_cmake/$version"'
    check "and the program runs" env -C "$work" "$work/by_cmake/$version/c_example"
    check "no other ABI" eval '! by_cmake 99.0'
else
    echo "skip: cmake is not installed"
fi
check "the library is named by its ABI" eval 'readelf -d "$work/c_example" | grep -qE "NEEDED.*libglint\.so\.[0-9]+(\.[0-9]+)?\]"'
check "and nothing of what it needs" eval '! readelf -d "$work/c_example" | grep -qE "NEEDED.*(png|deflate|isal|xxhash)"'
cat >"$work/kernels.c" <<'END'
#include <glint.h>
#include <stdio.h>
int main(void)
{
    static const char *const names[] = { "ref", "generic", "avx2", "avx512", NULL };
    printf("kernels:");
    for (int i = 0; i < 5; i++) {
        glint_renderer_desc desc = glint_renderer_desc_default();
        glint_renderer *renderer;
        desc.isa = names[i];
        if (glint_renderer_create(&desc, &renderer, NULL) != GLINT_OK)
            continue;
        printf(names[i] ? " %s" : "; in use: %s\n", glint_renderer_isa(renderer));
        glint_renderer_destroy(renderer);
    }
    return 0;
}
END
check "a program that tells its kernels" eval '(compile kernels)'
check "the shared library has the command's" eval \
    'test "$(LD_LIBRARY_PATH=$prefix/lib "$work/kernels")" = "$("$prefix/bin/glint" --version --verbose | sed -n "/^kernels/s/, .*//p")"'
# The commands of the pages; the last one of how-to.md links the archive.
grep -h '^    cc c_example\.c' "$prefix/share/doc/glint/engine.md" "$prefix/share/doc/glint/how-to.md" >"$work/commands"
check "the pages have three commands for C" test "$(wc -l <"$work/commands")" = 3
while read -r line; do
    check "$line" eval '(cd "$work" && rm -f c_example && LD_LIBRARY_PATH=$prefix/lib sh -c "$line")'
done <"$work/commands"
check "the archive is in the program" eval '! readelf -d "$work/c_example" | grep -q "NEEDED.*libglint"'
nm -D --defined-only "$prefix/lib/libglint.so" | awk '$2 == "T" { sub(/@.*/, "", $3); print $3 }' | sort >"$work/exported"
check "the shared library has all of the public headers" eval \
    '(for f in $(grep -ohE "\bglint_[a-z0-9_]+\(" engine/glint*.h | tr -d "(" | sort -u); do grep -qx "$f" "$work/exported" || exit 1; done)'
check "and nothing else" eval 'test "$(wc -l <"$work/exported")" -gt 100 &&
    (for f in $(cat "$work/exported"); do grep -q "\b$f(" engine/glint*.h || exit 1; done)'
for file in bin/glint lib/libglint.so lib/lua/5.4/glint.so; do
    check "$file is stripped and hardened" eval \
        '! readelf -SW "$prefix/$file" | grep -q debug_info && readelf -dW "$prefix/$file" | grep -qE "BIND_NOW|NOW" &&
         readelf -lW "$prefix/$file" | grep -q GNU_RELRO && nm -D "$prefix/$file" | grep -q __stack_chk_fail'
done
# In optimized builds, calls of the C library with a known buffer size are checked.
fortified() { nm -D "$1" | grep -qE ' U __(mem|str|v?s?n?f?printf|f?read|f?gets)[a-z]*_chk'; }
for file in bin/glint lib/libglint.so lib/lua/5.4/glint.so; do
    if grep -q -- '-O[1-3s]' "$build/flags"; then
        check "$file is fortified" fortified "$prefix/$file"
    else
        skip "$file is not fortified: that takes an optimized build"
    fi
done
cat >"$work/same.lua" <<'END'
local glint = require "glint"
local function paint(r, g, b, ks) return glint.material { diffuse = { r, g, b }, specular = ks, shininess = 64 } end
glint.scene { camera = glint.camera { eye = { 0, 3, 8 }, at = { 0, 1, 0 } }, ambient = 0.125,
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = paint(0.5, 0.5, 0.5, 0) },
  glint.sphere { center = { 0, 1, 0 }, radius = 1, material = paint(0.75, 0.25, 0.125, 0.5) },
  glint.point_light { position = { 4, 8, 6 } },
}:render { width = 640, height = 360, samples = 4, output = "same.png" }
END
check "the same scene from Lua" eval '(cd "$work" && "$prefix/bin/glint" same.lua --quiet)'
check "has the same pixels" "$prefix/bin/glint" compare "$work/c_example.png" "$work/same.png" --fail 0 --warn 0

# Objects are identical wherever they are built: they do not contain the build folder, not even in debug information.
check "the folder of the build is in no object" eval '! grep -qF "$root/" "$build/glint" "$build/glint.so" "$build/libglint.a"'
objects="build/engine/base/pool.o build/engine/files/picture/png.o build/bindings/command/output.o build/libglint.map"
for folder in one another/folder; do
    mkdir -p "$work/$folder" && cp -r Makefile engine bindings scripts "$work/$folder/"
    mkdir "$work/$folder/tests" && cp tests/deps.sh "$work/$folder/tests/"
    check "objects built in $folder" ${MAKE:-make} -s --no-print-directory -C "$work/$folder" BUILD=build $objects
done
for object in $objects; do
    check "$object is the same from two folders" cmp "$work/one/$object" "$work/another/folder/$object"
done

check "make uninstall" quiet_make uninstall PREFIX="$prefix"
check "nothing is left" test -z "$(find "$prefix" -type f -o -type l)" -a ! -e "$prefix/share/glint" -a ! -e "$prefix/share/lua/5.4/glint" -a ! -e "$prefix/share/doc/glint"
check "DESTDIR goes before PREFIX" quiet_make install PREFIX=/opt/glint DESTDIR="$work/root"
multiarch=$(${CC:-cc} -print-multiarch 2>/dev/null)
check "as a system's own package" quiet_make install PREFIX=/usr DESTDIR="$work/system"
check "with the libraries of this architecture" test -s "$work/system/usr/lib${multiarch:+/$multiarch}/libglint.so"
check "into the root's folder, not the files" grep -qx 'prefix=${pcfiledir}/../..' "$work/root/opt/glint/lib/pkgconfig/glint.pc"
if command -v pkg-config >/dev/null; then
    mv "$work/root/opt/glint" "$work/moved"
    headers=$(PKG_CONFIG_PATH="$work/moved/lib/pkgconfig" pkg-config --variable=includedir glint)
    check "glint.pc finds the headers of a moved tree" test "$(realpath "$headers")" = "$(realpath "$work/moved/include")"
fi
totals
