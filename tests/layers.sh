#!/bin/sh
# Dependencies go one way: scripts -> bindings -> engine -> engine/stages -> engine/base. Each folder includes its own
# headers and the headers of the folders named here. All may include the renderer's public headers; the other public
# headers are named. The kernels of an effect, with their contract and reference, follow the rules of engine/stages.
set -u
bad=0

# forbid FOLDERS PATTERN WHY: no source below these folders has a line with PATTERN
forbid() {
    # shellcheck disable=SC2086
    if grep -rnE --include='*.[ch]' "$2" $1; then
        echo "^ $3"
        bad=1
    fi
}

# includes FILES FOLDER...: the files may include only headers of these folders, or these headers
includes() {
    files=$1
    shift
    allowed="engine/glint(_math|_programs|_inspect)?\.h"
    for name in "$@"; do allowed="$allowed|$name"; done
    # shellcheck disable=SC2086
    if grep -nE '^#include "' $files /dev/null | grep -vE "#include \"($allowed)(/[^/]*)?\""; then
        echo "^ includes $* and the public headers only"
        bad=1
    fi
}

# layer FOLDER FOLDER...: sources of the first folder may include headers of all these folders
layer() {
    includes "$1/*.[ch]" "$@"
}

base=engine/base
stages='engine/stages engine/stages/simd'
layer engine/base
layer engine/data engine/glint_data.h $base
layer engine/scene 'engine/glint_(files|figures).h' engine/data engine/stages $base
layer engine/geometry engine/scene engine/stages $base
layer engine/text $base
figures=engine/glint_figures.h
layer engine/ink $figures engine/text $base
layer engine/overlay $figures engine/ink engine/text $base
layer engine/film engine/glint_files.h engine/overlay engine/stages $base
layer engine/program engine/file $stages $base
# An effect's plan.h belongs to the plan; its other headers belong to tile rendering and to the frame around it.
effects='engine/effects/[a-z_]*'
for files in 'engine/plan/*.[ch]' 'engine/effects/*/plan*.[ch]' 'engine/effects/derivative/slopes.h'; do
    includes "$files" engine/glint_files.h engine/plan engine/effects "$effects/(plan|slopes).h" engine/program engine/geometry engine/scene engine/overlay engine/film $stages $base
done
layer engine/reuse "$effects/plan.h" engine/program engine/plan engine/film $stages $base
layer engine/tile "$effects" engine/program engine/reuse engine/plan engine/film $stages engine/stages/light $base
layer engine/frame "$effects" engine/program engine/tile engine/reuse engine/plan engine/overlay engine/film $base
kernels=$(find engine/effects -name 'kernel*.[ch]' -o -name contract.h -o -name ref.h -o -name 'ref_*.h')
includes "engine/stages/*.h engine/stages/*/*.[ch] $kernels" 'engine/stages(/[a-z]*)?' "$effects/(contract|kernel_[a-z]*|ref|ref_[a-z]*).h" $base
includes "$(find engine/effects/*/ -name '*.[ch]' | grep -vxF "$kernels")" "$effects" engine/effects engine/frame engine/tile engine/program \
    engine/reuse engine/plan engine/geometry engine/scene engine/film $stages engine/stages/light $base
layer engine/file engine/glint_files.h engine/ink engine/text engine/overlay engine/film engine/stages $base
layer engine/compare 'engine/glint_(files|compare).h' engine/file engine/film $base
layer engine/sheet $figures engine/ink engine/text engine/overlay engine/file $base

public='engine/glint_(files|figures|compare|data).h'
layer bindings/value "$public"
layer bindings/run "$public" bindings/value
layer bindings/pattern "$public" bindings/run bindings/value
layer bindings/lua "$public" bindings/run bindings/value
layer bindings/command "$public" bindings/run bindings/value scripts/lib scripts/lib/gr
layer bindings/cost "$public" bindings/command bindings/run
layer bindings/watch "$public" bindings/command bindings/run
layer bindings/relight "$public" bindings/command bindings/run

scene='glint_(scene|material|light|camera|shape|plan|renderer|image)(_desc)?'
forbid engine '[<"](lua|lauxlib|lualib)\.h|\blua_State\b' 'the engine has never heard of Lua'
forbid "engine/stages $kernels" "\\b$scene\\b" 'kernels take plain arrays, not scenes'
forbid "engine/stages $kernels" '#include "engine/glint[^_]' 'kernels know nothing of the public interface but glint_math.h'
exit $bad
