#!/bin/sh
# Arrows point one way: scripts -> bindings -> engine -> engine/stages -> engine/base.
set -u
bad=0

# forbid FOLDER PATTERN WHY: no source below FOLDER has a line with PATTERN
forbid() {
    if grep -rnE --include='*.[ch]' "$2" "$1"; then
        echo "^ $1: $3"
        bad=1
    fi
}

scene='glint_(scene|material|light|camera|shape|plan|renderer|image)(_desc)?'
forbid engine '[<"](lua|lauxlib|lualib)\.h|\blua_State\b' 'the engine has never heard of Lua'
forbid engine '#include "(bindings|tests)/' 'the engine includes nothing above it'
forbid engine/stages "\\b$scene\\b" 'stages take plain arrays, not scenes'
forbid engine/stages '#include "engine/([a-z_]+\.h|image/)' 'stages include stages and base only'
forbid engine/base '#include "engine/(stages|image)/' 'base includes base and glint.h only'
forbid engine/base '#include "engine/(scene|plan|render|tile|geometry|bvh|material|light|camera|shape|reuse)' 'base is below the scene'
forbid bindings '#include "(engine/([^g]|g[^l]|[a-z]+/)|tests/)' 'bindings use the public API, engine/glint.h'
exit $bad
