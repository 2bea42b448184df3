#!/usr/bin/env bash
# glint completion: each installed shell reads its script, offers all of the command's options, and offers only option
# values that the command accepts.
. tests/command/prelude.sh

for shell in bash zsh fish; do
    check "glint completion $shell" "$glint" completion $shell
    "$glint" completion $shell >"$work/$shell"
    check "$shell: quotes in help are escaped" eval '! grep -q "[a-z]'"'"'[a-z]" "$work/$shell"'
done
"$glint" completion ksh >"$work/log" 2>&1
check "an unknown shell is an error" test $? -eq 2

# ---- bash ----

# offers WORDS...: prints the offers for the last word, one per line
offers() {
    COMP_WORDS=(glint "$@")
    COMP_CWORD=$#
    _glint 2>/dev/null
    printf '%s\n' "${COMPREPLY[@]}"
}
has() { grep -qx -- "$1" <(offers "${@:2}"); }
lacks() { ! has "$@"; }

# shellcheck source=/dev/null
source "$work/bash"
cd "$work" || exit 1
touch scene.lua picture.png
mkdir folder
check "bash: options of render" has --frames scene.lua --fr
check "bash: options of explain" has --frame explain scene.lua --fr
check "bash: not those of other commands" lacks --frames explain scene.lua --fr
check "bash: choices" has double scene.lua --precision d
check "bash: scripts" has scene.lua s
check "bash: folders" has folder f
check "bash: no pictures where a script belongs" lacks picture.png p
check "bash: pictures to compare" has picture.png compare p
check "bash: pictures of a sheet" has picture.png sheet p
check "bash: no scripts on a sheet" lacks scene.lua sheet s
check "bash: a picture to reproduce" has picture.png reproduce p
check "bash: and its script" has scene.lua reproduce picture.png s
check "bash: options of assemble" has --fps assemble picture.png --f
check "bash: a new name is nobody's to know" lacks picture.png new p
check "bash: commands" has explain exp
check "bash: shells" has fish completion f

# Every option that --help names is offered by some command, and vice versa.
cd - >/dev/null || exit 1
"$glint" --help | grep -oE -- '--[a-z][a-z-]*' | sort -u >"$work/helped"
grep -oE 'options="[^"]*"' "$work/bash" | grep -oE -- '--[a-z-]+' | sort -u >"$work/offered"
check "the options of --help" diff "$work/helped" "$work/offered"
# The manual page must have a heading for each option, with the same letter and text, and must list the same passes.
cat >"$work/heads.lua" <<'END'
local page = io.read "a"
local options = page:match "\n%.SH OPTIONS\n(.-)\n%.SH "
local said = options:match "\nAlso write these: (.-)%.[ \n]"
io.write("passes ", (said:gsub("%s+", " ")), "\n")
for line in options:gmatch "%f[^\n\0]%.TP\n%.BR? ([^\n]*)" do
  local head = line:gsub('"([^"]*)"', function(quoted) return (quoted:gsub(" ", "\1")) end):gsub(" ", "")
  head = head:gsub("\1", " "):gsub("\\f[IR]", ""):gsub("\\%-", "-")
  for letter, option in (", " .. head):gmatch ",? ?(%-?%a?),? ?(%-%-[^,]+)" do
    io.write(letter == "" and option or letter .. ", " .. option, "\n")
  end
end
END
{
    printf 'passes %s\n' "$("$glint" --help | tr -s ' \n' ' ' | sed -E 's/.*also write these: ([a-zA-Z_:, ]*[a-zA-Z]) --.*/\1/')"
    "$glint" --help | sed -nE 's/^  ((-., )?--[^ ]+( [^ ]+)?)(  .*)?$/\1/p'
} | sort >"$work/heads"
check "the options of the manual page" diff <("${LUA:-lua5.4}" "$work/heads.lua" <bindings/glint.1 | sort) "$work/heads"

# The command must accept every choice.
cat >"$work/scene.lua" <<'END'
local glint = require "glint"
return glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, background = 1 }
END
cat >"$work/gr.lua" <<'END'
gr.render(gr.node 'root', 'empty', 8, 8, { 0, 0, 9 }, { 0, 0, -1 }, { 0, 1, 0 }, 50, { 0, 0, 0 }, {})
END
grep -E -- '^ +--[a-z-]+.*compgen -W' "$work/bash" | sed -E 's/^ +--([a-z-]+).*compgen -W "([^"]*)".*/\1 \2/' >"$work/choices"
check "there are choices" test "$(wc -l <"$work/choices")" -ge 7
while read -r option words; do
    [ "$option" != terminal ] || continue # an option of `glint watch`, which runs until it is stopped
    scene=("$work/scene.lua")
    case $option in
    dialect) scene=("$work/gr.lua") ;;
    gr-*) scene=("$work/gr.lua" --dialect gr) ;;
    esac
    for word in $words; do
        check "--$option $word" "$glint" "${scene[@]}" --size 8x8 --quiet -o none "--$option" "$word"
    done
done <"$work/choices"

# ---- zsh and fish ----

if command -v zsh >/dev/null; then
    check "zsh reads it" zsh -n "$work/zsh"
    # _arguments gets its lines: options with descriptions and choices.
    # shellcheck disable=SC2016
    zsh -f -c '_arguments() { print -rl -- "$@"; }; words=(glint watch s.lua --te); CURRENT=4; source "$1"' - "$work/zsh" >"$work/specs"
    check "zsh: the options of watch" grep -q -- '^--terminal\[how to draw\]:terminal:(kitty sixel blocks text)$' "$work/specs"
    check "zsh: not those of render" test "$(grep -c -- '--frames' "$work/specs")" -eq 0
else
    skip "zsh is not installed"
fi
if command -v fish >/dev/null; then
    fish_offers() { HOME=$work fish --no-config -c "source $work/fish; complete -C '$1'" 2>&1; }
    check "fish: options" grep -q -- '^--frames' <(fish_offers "glint scene.lua --fr")
    check "fish: not those of other commands" test -z "$(fish_offers "glint explain scene.lua --frames")"
    check "fish: choices" grep -q '^linear' <(fish_offers "glint scene.lua --transfer ")
    check "fish: commands" grep -q '^watch' <(fish_offers "glint w")
else
    skip "fish is not installed"
fi
totals
