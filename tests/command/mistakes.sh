#!/usr/bin/env bash
# Mistakes that the command sees: what it adds to Lua's own messages, prints of a pattern, loops without an end.
. tests/command/prelude.sh
cd "$work" || exit 1

# scene NAME CODE: a script whose ball has the pattern `f` that the code defines
scene() {
    printf '%s\n' 'local glint = require "glint"' "$2" 'return glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } },
  glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { ambient = glint.pattern(f) } } }' >"$1.lua"
}
# wrong NAME PATTERN CODE
wrong() {
    scene "$1" "$3"
    exits 2 "$1" "$1.lua" --size 4x4 -o none
    says "$1" "$2"
}

table="; a table is no vector: write glint\.vector"
wrong table_by_number "table.lua:2: .*$table|$table" 'local red = { 0.8, 0.2, 0.2 } local f = red * 0.5'
wrong number_by_table "$table" 'local f = function(p) return p.x * { 1, 0, 0 } end'
check "a cure is given once" test "$(grep -o 'a table is no vector' err | wc -l)" -eq 1
wrong a_global_of_glint "is it glint\.sphere\?" 'local f = sphere { radius = 1 }'
wrong a_global_of_math "is it math\.random\?" 'local f = random()'
wrong a_sine "is it glint\.sin\?" 'local f = function(p) return sin(p.x) end'
wrong endless "endless.lua:2: pattern: its function has not returned after 200 million steps" \
    'local f = function(p) while true do end return p.x end'

scene prints 'local f = function(p) print("here", p.x) return glint.select(glint.less(p.x, 0), 0.2, 0.4) end'
exits 0 "a pattern that prints" prints.lua --size 4x4 -o none
check "a pattern prints once" test "$(cat out)" = "$(printf 'here\tsymbol')"
scene prints_again 'local f = function(p) return p.x end
assert(#glint.pattern(f) >= 0)
print "after"'
exits 0 "print is there again" prints_again.lua --size 4x4 -o none
check "print is there again" grep -qx after out

totals
