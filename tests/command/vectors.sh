#!/usr/bin/env bash
# -o figure.svg and -o figure.pdf: the look of the .png, text that can be selected, equal bytes on each run, refusals.
set -u
root=$PWD
glint=${GLINT:-$PWD/${BUILD:-build}/glint}
case ${LUA_CPATH:-} in /*) ;; *) export LUA_CPATH="$root/${BUILD:-build}/?.so;;" ;; esac
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
bad=0 good=0

# check WHAT COMMAND...
check() {
    local what=$1
    shift
    if "$@" >said 2>&1; then
        good=$((good + 1))
    else
        echo "not ok - $what"
        sed 's/^/    /' said
        bad=$((bad + 1))
    fi
}
refuses() { # refuses TEXT ARGUMENT...
    local text=$1
    shift
    ! "$glint" -q "$@" 2>err && grep -qF -- "$text" err && ! ls none.* 2>/dev/null
}
has() { command -v "$1" >/dev/null || { echo "skip: no $1"; return 1; }; }

cat >figure.lua <<'LUA'
local glint = require "glint"
local P = glint.params { marks = true }
local scene = glint.scene { camera = glint.camera { eye = { 0, 2, 9 }, at = { 0, 0, 0 } }, ambient = 0.1, background = { 0.02, 0.03, 0.06 },
  glint.point_light { position = { 3, 8, 4 } },
  glint.sphere { center = { 0, 0, 0 }, radius = 2, material = glint.material { diffuse = { 0.6, 0.3, 0.2 } } } }
if P.marks then
  scene:add(glint.label { text = "Fläche <A & B>\nsecond\1 line", background = "black", opacity = 0.5, size = 14 })
  scene:add(glint.colorbar { map = "magma", low = 0, high = 1, title = "heat" })
  scene:add(glint.arrow { from = { -4, -1, 0 }, to = { 3, 2, 0 }, label = "ray", hidden = "dashed", color = "yellow" })
  scene:add(glint.arc { at = { 0, 0, 2 }, from = { 1, 0, 0 }, to = { 0, 1, 0 }, radius = 1, label = "φ" })
  scene:add(glint.axes {})
end
return glint.animation { scene = scene, frames = 1, width = 320, height = 240, frame = function() end }
LUA
font=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf # rsvg-convert has no bitmap font
[ -f $font ] && "$glint" --version --verbose | grep -q FreeType && export GLINT_FONT=$font
compare() { LD_PRELOAD=${PRELOAD:-} "${LUA:-lua5.4}" "$root/tests/command/vectors.lua" "$@"; }

"$glint" -q figure.lua -o a.png && "$glint" -q figure.lua -o plain.png -D marks=false || exit 1
"$glint" -q figure.lua -o a.svg && "$glint" -q figure.lua -o b.svg -t 1 || exit 1
check "an .svg: the same bytes again" cmp a.svg b.svg
check "text of an .svg" grep -qF '>Fläche &lt;A &amp; B&gt;</text>' a.svg
check "a control character of a text" grep -qF $'>second\xef\xbf\xbd line</text>' a.svg
check "a pixel is a point" grep -qF 'width="320pt" height="240pt" viewBox="0 0 320 240"' a.svg
"$glint" -q figure.lua -o dpi.svg --dpi 300 --size 100x50
check "72 / dpi points a pixel" grep -qF 'width="24pt" height="12pt" viewBox="0 0 100 50"' dpi.svg
"$glint" -q figure.lua -o part.svg --region 100,60,50,40
check "a part keeps the positions" grep -qF 'viewBox="100 60 50 40"' part.svg
LC_ALL=de_DE.UTF-8 "$glint" -q figure.lua -o locale.svg && check "any locale" cmp a.svg locale.svg
if has rsvg-convert; then
    rsvg-convert -w 320 -h 240 a.svg -o svg.png
    check "an .svg is well formed" test -s svg.png
    [ -z "${GLINT_FONT##*.ttf}" ] && check "an .svg looks like the .png" compare plain.png a.png svg.png
    "$glint" -q figure.lua -o plain16.png -D marks=false --bits 16 && "$glint" -q figure.lua -o deep.svg -D marks=false --bits 16
    sed -n 's/.*base64,\([^"]*\)".*/\1/p' deep.svg | base64 -d >embedded.png
    check "16 bits in an .svg" "$glint" compare plain16.png embedded.png
fi
check "other passes" "$glint" -q figure.lua -o passes.svg --passes depth
check "a pass in a file of its own" test -s passes.depth.svg

for i in 1 2 3; do cp a.png cell_$i.png; done
check "a sheet" "$glint" -q sheet cell_1.png cell_2.png cell_3.png -o sheet.svg --title 'Δs & n°' --colorbar magma,0,1,T
check "a sheet's title" grep -qF '>Δs &amp; n°</text>' sheet.svg
"$glint" -q sheet cell_1.png cell_2.png -o once.svg --transparent && "$glint" -q sheet cell_1.png cell_2.png -o twice.svg --transparent
check "a transparent sheet, again" cmp once.svg twice.svg
check "another ending" refuses '.svg, .pdf' figure.lua -o none.ps

cat >chart.lua <<'LUA'
return require("glint").chart { title = "Powers", x_label = "$x$ / m", x = { 1, 2, 3 },
  series = { { y = { 1, 4, 9 }, label = "$x^2$" }, { y = { 1, 8, 27 }, label = "cube" } } }
LUA
"$glint" -q chart.lua -o chart.svg
check "a chart by itself" grep -q '>Powers<' chart.svg
check "a formula names an axis" grep -q '> */ m<' chart.svg
echo 'local c = dofile "chart.lua" return { c, c }' >two.lua
"$glint" -q two.lua -o 'two_%d.svg'
check "a chart in a list" cmp <(grep '<text' two_2.svg) <(grep '<text' chart.svg)
cat >accents.lua <<'LUA'
local glint = require "glint"
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } } }
scene:add(glint.label { text = "$\\vec n \\hat n \\dot n \\ddot n \\tilde n$", size = 40 })
return scene
LUA
"$glint" -q accents.lua -o accents.svg --size 320x100
check "no combining sign stands alone" bash -c '! grep -q "$(printf "\342\203\227")" accents.svg'
if [ -n "${GLINT_FONT:-}" ]; then
    check "accents are paths" test "$(grep -c '<path d="M' accents.svg)" -eq 5
    "$glint" -q accents.lua -o accents.png --size 320x100
    drawn_accents() {
        rsvg-convert -w 320 -h 100 accents.svg -o drawn.png && "$glint" compare accents.png drawn.png --json | "${LUA:-lua5.4}" -e '
            local rms = tonumber(io.read("a"):match "\"rms_error\":([%d.e-]+)")
            assert(rms and rms < 0.05, rms)'
    }
    has rsvg-convert && check "an .svg with accents looks like its .png" drawn_accents
fi
refuse_overlay() { echo 'return require("glint").label { text = "a" }' >label.lua && refuses 'a scene, a chart or a list' label.lua -o none.svg; }
check "another overlay is refused" refuse_overlay

if "$glint" --version --verbose | grep -q '\.pdf'; then
    "$glint" -q figure.lua -o a.pdf && "$glint" -q figure.lua -o b.pdf -t 1
    check "a .pdf: the same bytes again" cmp a.pdf b.pdf
    check "no dates" bash -c '! grep -qa "CreationDate\|ModDate" a.pdf'
    check "16 bits are refused" refuses 'bits: 8 expected for a .pdf, got 16' figure.lua -o none.pdf --bits 16
    check "linear values are refused" refuses 'transfer: srgb expected for a .pdf' figure.lua -o none.pdf --transfer linear
    check "a sheet as .pdf" "$glint" -q sheet cell_1.png cell_2.png -o sheet.pdf --title 'Δs & n°'
    "$glint" -q figure.lua -o clear.pdf --alpha -D marks=false
    check "a chart as .pdf" "$glint" -q chart.lua -o chart.pdf
    if has pdftotext; then
        check "text of a chart" bash -c 'pdftotext chart.pdf - | grep -qxF Powers'
        check "text of a .pdf" bash -c 'pdftotext a.pdf - | grep -qxF "Fläche <A & B>"'
        check "text of a sheet" bash -c 'pdftotext sheet.pdf - | grep -qxF "Δs & n°"'
        GLINT_FONT=bitmap "$glint" -q figure.lua -o bitmap.pdf
        check "text of the bitmap font" bash -c 'pdftotext bitmap.pdf - | grep -qxF "Fläche <A & B>"'
        check "alpha" bash -c 'pdfimages -list clear.pdf | grep -qw smask'
        pdfimages -png a.pdf a
        check "the picture has the same values" "$glint" compare plain.png a-000.png
        pdftocairo -png -singlefile -r 72 a.pdf pdf
        check "a .pdf looks like the .png" compare plain.png a.png pdf.png
    fi
else
    check "no cairo" refuses 'this build has no cairo' figure.lua -o none.pdf
fi

# A program that has called setlocale: numbers have points in every file that is read and written. The locale is made here
# from the sources of Debian's package `locales`.
if localedef -i de_DE -f UTF-8 "$work/de_DE.UTF-8" 2>/dev/null; then
    cat >numbers.lua <<'LUA'
local glint = require "glint"
local name, place = arg[1], arg[2]
assert(place == "C" or os.setlocale "de_DE.UTF-8", "no locale")
assert(place == "C" or not tostring(1.5):find("1.5", 1, true), "the locale has commas")
local function write(path, text) assert(io.open(path, "wb")):write(text):close() end
write("half.obj", "mtllib half.mtl\nv -1.5 0 0\nv 1.5 0.5 0\nv 0 1.25 0\nusemtl a\nf 1 2 3\n")
write("half.mtl", "newmtl a\nKd 0.5 0.25 0.125\n")
write("half.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=0.5\n\n-Y 1 +X 1\n\128\128\128\129")
write("half.pfm", "Pf\n1 1\n-0.5\n" .. string.pack("<f", 0.5))
local half = { diffuse = glint.texture { file = "half.hdr" }, specular = glint.texture { file = "half.pfm" } }
local scene = glint.scene { camera = glint.camera { eye = { 0, 0.5, 9 }, at = { 0, 0.5, 0 } }, ambient = 0.5,
  glint.mesh { file = "half.obj" },
  glint.sphere { center = { 0.5, 2, 0 }, radius = 0.75, material = glint.material(half) },
  glint.axes { box = { { -1.5, 0, -0.5 }, { 1.5, 1.25, 0.5 } } }, glint.colorbar { map = "magma", low = -0.5, high = 0.25 } }
local message = select(2, pcall(glint.sphere, { center = { 0, 0, 0 }, radius = -0.5 }))
assert(message:find("got -0.5", 1, true), message)
local patterns = tostring(glint.pattern(function(p) return p.x * 0.1 end))
assert(not patterns:find "0,1", patterns)
for _, ending in ipairs { "png", "svg", "pdf", "pfm" } do
  if ending ~= "pdf" or pcall(scene.render, scene, { width = 8, height = 8, output = "try.pdf" }) then
    scene:render { width = 160, height = 120, output = name .. "." .. ending }
  end
end
assert(place == "C" or not tostring(1.5):find("1.5", 1, true), "the program's locale is as it was")
os.exit(true) -- without unloading cairo, whose caches would be reported as leaks
LUA
    for place in C de_DE.UTF-8; do
        check "numbers in the locale $place" env LOCPATH="$work" LC_ALL=C LD_PRELOAD="${PRELOAD:-}" "${LUA:-lua5.4}" numbers.lua "$place" "$place"
    done
    for file in C.*; do check "the same ${file#C.} in a locale with commas" cmp "$file" "de_DE.UTF-8.${file#C.}"; done
else
    echo "skip: no sources of locales (Debian: locales)"
fi
echo "$good passed, $bad failed"
[ "$bad" -eq 0 ]
