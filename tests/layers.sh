#!/bin/sh
# Arrows point one way: scripts -> bindings -> engine -> engine/stages -> engine/base. Each folder includes its own headers, and
# those of the folders named here.
set -u
bad=0

# forbid FOLDER PATTERN WHY: no source below FOLDER has a line with PATTERN
forbid() {
    if grep -rnE --include='*.[ch]' "$2" "$1"; then
        echo "^ $1: $3"
        bad=1
    fi
}

# layer FOLDER FOLDER...: what the sources of the first include
layer() {
    folder=$1
    shift
    allowed=$folder
    for below in "$@"; do allowed="$allowed|$below"; done
    if grep -nE '^#include "' "$folder"/*.[ch] | grep -vE "#include \"(engine/glint\.h|($allowed)/[^/]*)\""; then
        echo "^ $folder: includes $folder, $* and engine/glint.h only"
        bad=1
    fi
}

base=engine/base
stages='engine/stages engine/stages/simd'
layer engine/base
layer engine/scene engine/stages $base
layer engine/geometry engine/scene engine/stages $base
layer engine/text $base
layer engine/overlay engine/text $base
layer engine/film engine/overlay engine/stages $base
layer engine/program engine/file $stages $base
layer engine/plan engine/program engine/geometry engine/scene engine/overlay engine/film $stages $base
layer engine/reuse engine/program engine/plan engine/film $stages $base
for room in engine/tile engine/tile/pattern engine/tile/derivative engine/tile/indirect; do
    layer $room engine/tile engine/tile/pattern engine/tile/derivative engine/tile/indirect engine/program engine/reuse engine/plan engine/film $stages \
        engine/stages/light $base
done
layer engine/frame engine/program engine/tile engine/reuse engine/plan engine/film $base
layer engine/file engine/text engine/overlay engine/film engine/stages $base
layer engine/compare engine/file engine/film $base
layer engine/sheet engine/text engine/overlay engine/file $base

layer bindings/value
layer bindings/run bindings/value
layer bindings/pattern bindings/run bindings/value
layer bindings/lua bindings/run bindings/value
layer bindings/command bindings/run bindings/value scripts/lib scripts/lib/gr
layer bindings/cost bindings/command bindings/run
layer bindings/watch bindings/command bindings/run

scene='glint_(scene|material|light|camera|shape|plan|renderer|image)(_desc)?'
forbid engine '[<"](lua|lauxlib|lualib)\.h|\blua_State\b' 'the engine has never heard of Lua'
forbid engine/stages "\\b$scene\\b" 'stages take plain arrays, not scenes'
forbid engine/stages '#include "engine/(glint|[ac-rt-z][a-z]*/|s[a-su-z][a-z]*/)' 'stages include stages and base only'
exit $bad
