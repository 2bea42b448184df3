#!/bin/sh
# Dependencies go one way: scripts -> bindings -> engine. In the engine, base and film are known to all; the renderer
# (engine/render) knows only them. Figures, files and comparison know the renderer by its public headers alone; files
# draw figures; nobody knows files but the comparison. Each folder includes its own headers and the headers of the
# folders named here. The kernels of an effect, with their contract and reference, follow the rules of the stages.
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
    allowed="engine/glint(_types|_math|_programs|_inspect)?\.h"
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
film=engine/film
render=engine/render
stages="$render/stages $render/stages/simd"
layer $base
layer $film $base

# ---- The renderer ----
layer $render/scene $render/stages $base
layer $render/geometry $render/scene $render/stages $base
layer $render/program $film $stages $base
effects="$render/effects/[a-z_]*"
below="$render/program $render/reuse $render/plan $film $stages $render/stages/light $base"
plans="$render/[a-z_]*/plan.h $effects/plan.h"
# plan.h of a folder belongs to the plan: the plan and other folders read its tables.
for files in "$render/plan/*.[ch]" "$render/*/plan*.[ch] $render/effects/*/plan*.[ch]" $render/effects/derivative/slopes.h; do
    # shellcheck disable=SC2086
    includes "$files" $render/plan $render/effects $plans "$effects/slopes.h" $render/program $render/geometry $render/scene $film $stages $base
done
# shellcheck disable=SC2086
{
    layer $render/reuse $plans $below
    layer $render/tile $plans $render/pattern $render/adaptive $below
    layer $render/paths $plans $render/tile $render/pattern $render/light_groups $below
    layer $render/frame $plans $render/tile $render/adaptive $below
}
kernels=$(find $render -name 'kernel*.[ch]' -o -name contract.h -o -name ref.h -o -name 'ref_*.h')
includes "$render/stages/*.h $render/stages/*/*.[ch] $kernels" "$render/stages(/[a-z]*)?" "$render/([a-z_]*|effects/[a-z_]*)/(contract|kernel_[a-z]*|ref|ref_[a-z]*).h" $film/codes.h $base
# An effect knows the core, and the other effects that its declaration names. Apart from calls, derivatives read what
# faces, vertices and the depth cue have stored.
for folder in "$render/pattern" "$render/adaptive" "$render/light_groups" "$render"/effects/*/; do
    folder=${folder%/}
    others=$(sed -n 's/.*\.calls = "\(.*\)",.*/\1/p' "$folder"/*.c)
    [ "$folder" = $render/effects/derivative ] && others="depth_cue vertex_shading"
    set -- "$folder"
    for other in $others; do set -- "$@" "$render/effects/$other"; done
    # shellcheck disable=SC2086
    includes "$(find "$folder" -name '*.[ch]' | grep -vxF "$kernels")" "$@" $plans $render/effects $render/frame $render/paths $render/tile \
        $render/pattern $render/adaptive $render/light_groups $render/geometry $render/scene $below
done

# ---- Around it ----
figures='engine/glint_figures.h'
layer engine/figures/text "$figures" $base
layer engine/figures/ink $figures engine/figures/text $film $base
layer engine/figures/overlay $figures engine/figures/ink engine/figures/text $film $base
layer engine/files/data engine/glint_data.h $base
layer engine/files/mesh engine/glint_files.h $base
layer engine/files/picture engine/glint_files.h engine/figures/ink engine/figures/text engine/figures/overlay engine/files/vector $film $base
layer engine/files/vector engine/figures/ink engine/figures/text engine/figures/overlay engine/files/picture $film $base
layer engine/files/sheet engine/glint_files.h engine/figures/ink engine/figures/text engine/figures/overlay engine/files/picture engine/files/vector $base
layer engine/compare 'engine/glint_(files|compare).h' engine/files/picture $film $base

public='engine/glint_(files|figures|compare|data).h'
layer bindings/value "$public"
layer bindings/run "$public" bindings/pattern bindings/value bindings/web/pages
layer bindings/pattern "$public" bindings/value
layer bindings/lua "$public" bindings/run bindings/pattern bindings/value
layer bindings/command "$public" bindings/run bindings/value scripts/lib scripts/lib/gr
layer bindings/cost "$public" bindings/command bindings/run
layer bindings/watch "$public" bindings/command bindings/run
layer bindings/relight "$public" bindings/command bindings/run

scene='glint_(scene|material|light|camera|shape|plan|renderer|image)(_desc)?'
forbid engine '[<"](lua|lauxlib|lualib)\.h|\blua_State\b' 'the engine has never heard of Lua'
forbid "$render/stages $kernels" "\\b$scene\\b" 'kernels take plain arrays, not scenes'
forbid "$render/stages $kernels" '#include "engine/glint[^_]' 'kernels know nothing of the public interface but glint_math.h'
exit $bad
