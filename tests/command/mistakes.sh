#!/usr/bin/env bash
# Mistakes in scripts that the command detects: additions to Lua's own messages, printing in a pattern, endless loops.
. tests/command/prelude.sh
cd "$work" || exit 1

# scene NAME CODE: writes a script whose ball has the pattern `f` that the code defines
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

table="; a table is not a vector: write glint\.vector"
wrong table_by_number "table.lua:2: .*$table|$table" 'local red = { 0.8, 0.2, 0.2 } local f = red * 0.5'
wrong number_by_table "$table" 'local f = function(p) return p.x * { 1, 0, 0 } end'
check "a cure is given once" test "$(grep -o 'a table is not a vector' err | wc -l)" -eq 1
wrong pattern_by_number "pattern_by_number.lua:2: .*a pattern is not a number: compute inside its function, glint\.pattern\(" \
    'local red = glint.pattern(function(p) return p end) local f = red * 0.5'
wrong number_by_pattern "a pattern is not a number: compute inside its function" \
    'local f = 1 - glint.pattern(function(p) return p.x end)'
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

# Numbers that a pattern must not give: each kind has a message.
scene odd 'local f = function(p) return { glint.sqrt(p.x), 1, 1 } end'
exits 0 "NaN" odd.lua --size 16x16 -o none
says "NaN" "frame 1: material\.ambient: the pattern is NaN at [0-9]+ points, such as .*; glint uses 0 there; look for 0 / 0"
[ "$(grep -c 'the pattern is' err)" -eq 1 ]
result $? "one warning"
scene odd 'local f = function(p) return { 1, 1, p.x } end'
exits 0 "negative" odd.lua --size 16x16 -o none
says "negative" "material\.ambient: the pattern is below 0 at .*; glint uses 0 there; write glint\.max\(0, x\)"
[ "$(grep -c 'the pattern is' err)" -eq 1 ]
result $? "one warning"
scene odd 'local f = function(p) return 1e300 * (p.x * p.x + 1) end'
exits 0 "huge" odd.lua --size 16x16 -o none
says "huge" "material\.ambient: the pattern is above 2\^100 at .*; glint uses 2\^100 there"
scene odd 'local f = function(p) return glint.select(glint.less(p.x, 0), -1, glint.sqrt(-p.x)) end'
exits 0 "two kinds" odd.lua --size 16x16 -o none
[ "$(grep -c 'the pattern is' err)" -eq 2 ]
result $? "two kinds, two messages"

# Patterns made only by glint are in range, and give no warning.
for f in 'glint.checker(4 * p, 4 * s.footprint)' 'glint.checker(p)' 'glint.stripe(7 * p.x, 7 * s.footprint)' 'glint.stripe(p.x)' \
    '(glint.cell(9 * p))' 'glint.hash(9 * p)' 'glint.parity(3 * p)' 'glint.brick(5 * p, 0.1, 5 * s.footprint)' 'glint.brick(5 * p, 0.1)' 'glint.colormap("turbo")(9 * p.x)' \
    'glint.smoothstep(0, 1, p.x)' 'glint.clamp(p.x, 0, 1)'; do
    scene own "local f = function(p, s) return $f end"
    exits 0 "$f" own.lua --size 96x96 -o none --samples 4
    if grep -q 'the pattern is' err; then fail "$f: $(cat err)"; else pass; fi
done

totals
