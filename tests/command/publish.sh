#!/usr/bin/env bash
# `glint publish` without a browser: the contents of the page, and input that the command refuses. tests/web/pages.mjs
# opens a page in a browser.
. tests/command/prelude.sh
cd "$work" || exit 1
mkdir web data other
printf 'module' | gzip -n >web/glint.wasm.gz
echo 'console.log("engine")' >web/publish.js
export GLINT_WEB=$work/web
cat >scene.lua <<'LUA'
local glint = require "glint"
local P = glint.params { size = { 1, min = 0, max = 2 }, label = { "</script>", doc = "of the ball" } }
local file <close> = assert(io.open((arg[0]:match "^.*/" or "") .. "data/shade.txt"))
return glint.animation { width = 8, height = 6, scene = glint.scene {
  camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, ambient = file:read "n",
  glint.sphere { center = { 0, 0, 0 }, radius = P.size } } }
LUA
echo 0.5 >data/shade.txt
has() { check "$1 has $2" grep -qF -- "$2" "$1"; } # FILE TEXT

# ---- Contents of the page ----

exits 0 "a page" publish scene.lua -o page.html --set size=1.5 --title 'A & B' --source
has page.html '<title>A &amp; B</title>'
has page.html "\"data/shade.txt\":\"$(base64 <data/shade.txt)\""
has page.html '"values":{"size":1.5}'
has page.html "$(base64 <web/glint.wasm.gz)"
has page.html 'console.log("engine")'
check "no text of the script ends an element" test "$(grep -c '</script>' page.html)" -eq 3
cd other || exit 1
exits 0 "a script in another folder" publish ../scene.lua -o ../far.html --controls size
cd ..
has far.html '"same":{"../data/shade.txt":"data/shade.txt"}'
has far.html 'controls="size"'

sed 's/width = 8/frames = 48, width = 8/' scene.lua >film.lua
exits 0 "a page of a film" publish film.lua -o film.html
says "a page of a film" 'page of 48 frames'

# ---- Refused input ----

exits 2 "no page" publish scene.lua
says "no page" 'publish: expected -o PAGE.html'
exits 2 "a picture" publish scene.lua -o wrong.png
exits 2 "an unknown control" publish scene.lua -o wrong.html --controls size,sizes
says "an unknown control" "the script has no parameter 'sizes'; its parameters are label, size"
exits 2 "an unknown parameter" publish scene.lua -o wrong.html --set sizes=1
exits 2 "an unknown frame" publish scene.lua -o wrong.html --frame 2
says "an unknown frame" 'the frames of the script are 1'
printf '\377\330\377\340' >photo.jpg
printf '\166\057\061\001' >sky.exr
for file in photo.jpg sky.exr; do
    cat >texture.lua <<LUA
local glint = require "glint"
local ok, photo = pcall(glint.texture, { file = "$file" }) -- not a whole file: only its first bytes count here
return glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1,
  glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { diffuse = ok and photo or 0.5 } } }
LUA
    exits 2 "a texture that pages cannot read" publish texture.lua -o wrong.html
    says "a texture that pages cannot read" "publish: $file is an? (JPEG|OpenEXR file), which pages cannot read: save it as"
done
exits 2 "no script" publish missing.lua -o wrong.html
exits 2 "an option of other commands" publish scene.lua -o wrong.html --samples 4
GLINT_WEB=$work/nowhere exits 2 "no engine for pages" publish scene.lua -o wrong.html
says "no engine for pages" 'make web'
check "nothing is left of a refused page" test ! -e wrong.html

# ---- The same figure in other pages ----

has_figure() { # PAGE
    has "$1" '<h2>Try it</h2>'
    has "$1" "\"data/shade.txt\":\"$(base64 <data/shade.txt)\""
    has "$1" "$(base64 <web/glint.wasm.gz)"
    check "$1 has one figure" test "$(grep -c '^<glint-figure ' "$1")" -eq 1
}
cat >sweep.lua <<'LUA'
local glint = require "glint"
local P = glint.params { size = { 1, min = 0, max = 2 } }
local file <close> = assert(io.open "data/shade.txt")
local ball = glint.sphere { center = { 0, 0, 0 }, radius = P.size }
return glint.sweep { width = 8, height = 6, output = "ball.png", over = { { ball, "radius", { 0.5, 1 } } }, sheet = { output = "sheet.html" },
  scene = glint.scene { camera = glint.camera { eye = { 0, 0, 5 }, at = { 0, 0, 0 } }, ambient = file:read "n", ball } }
LUA
exits 0 "a sweep with its sheet" sweep.lua --live --set size=1.5
has_figure sheet.html
has sheet.html '"values":{"size":1.5}'
exits 0 "a sheet of finished frames" sheet ball_0001.png ball_0002.png -o finished.html --live=sweep.lua
has_figure finished.html
exits 0 "the report of a study" cost scene.lua --report study --quick --knobs samples --live
has_figure study/index.html
exits 0 "pages without --live" sheet ball_0001.png ball_0002.png -o plain.html
check "they have no figure" test "$(grep -c glint-figure plain.html)" -eq 0

exits 2 "a sheet without its script" sheet ball_0001.png ball_0002.png -o wrong.html --live
says "a sheet without its script" 'expected --live=SCRIPT'
exits 2 "a script that is not there" sheet ball_0001.png ball_0002.png -o wrong.html --live=missing.lua
exits 2 "a study without a page" cost scene.lua --live
says "a study without a page" 'expected together with --report DIR'
GLINT_WEB=$work/nowhere exits 2 "no engine for a figure" sweep.lua --live --set size=1.2
says "no engine for a figure" '--live: the engine for pages is missing'
check "nothing is left of these" test ! -e wrong.html
totals
