#!/usr/bin/env bash
# The blocks of scripts/python.md, in their order, by a Python that has what they import; blocks whose module is missing are
# skipped, and say so.
. tests/command/prelude.sh
mkdir "$work/bin"
ln -s "$glint" "$work/bin/glint"
ln -s "$root/scripts" "$work/scripts"
cd "$work" || exit 1
export PATH="$work/bin:$PATH"
python=
for name in python3 /usr/bin/python3; do
    if [ -z "$python" ] && $name -c 'import numpy' 2>/dev/null; then python=$name; fi
done
awk '/^```(python|sh)$/ { name = sprintf("%02d.%s", ++n, substr($0, 4)); next } /^```/ { name = ""; next } name { print > name }' \
    "$root/scripts/python.md"
lacking() { # BLOCK: the first module that it imports and that is not there
    local module
    for module in $(sed -nE 's/^(import|from) ([a-zA-Z0-9_]+).*/\2/p' "$1"); do
        "$python" -c "import $module" 2>/dev/null || { echo "$module"; return; }
    done
}
check "the page's commands" bash -e 01.sh
for block in [0-9]*.python; do
    if [ -z "$python" ]; then
        skip "$block: no Python with numpy"
        continue
    fi
    module=$(lacking "$block")
    if [ -n "$module" ]; then skip "$block: no $module"; else check "$block of scripts/python.md" "$python" "$block"; fi
done
totals
