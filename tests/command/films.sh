#!/usr/bin/env bash
# Sheets, films, reproduce and new, on the command line. A stand-in for ffmpeg checks and counts its input;
# tests/command/real_films.sh (make check-films) uses the real ffmpeg.
. tests/command/prelude.sh

cd "$work" || exit 1

absent() { # NAME FILE...: none of these is there, nor any draft
    local name=$1
    shift
    if [ -z "$(ls -d "$@" 2>/dev/null; find . -name '.*.tmp')" ]; then pass; else fail "$name: $* or a draft is there"; fi
}

# ---- Scripts ----

cat >scene.lua <<'LUA'
local glint = require "glint"
local M = {}
M.red = glint.material { diffuse = { 0.8, 0.2, 0.2 }, specular = 0.5, shininess = 20, name = "red" }
M.lamp = glint.point_light { position = { 3, 6, 5 }, name = "lamp" }
M.scene = glint.scene {
  camera = glint.camera { eye = { 0, 2, 9 }, at = { 0, 0, 0 } }, ambient = 0.1, background = "#203040",
  M.lamp, glint.sphere { center = { 0, 0, 0 }, radius = 1.5, material = M.red },
}
return M
LUA
cat >turn.lua <<'LUA'
local glint = require "glint"
local S = require "scene"
local P = glint.params { radius = { 4, min = 1, max = 40 }, word = "a=b\nc" }
return glint.animation { scene = S.scene, frames = 6, fps = 12, cyclic = true, width = 40, height = 24, frame = function(t)
  S.lamp.position = { P.radius * glint.cos(2 * math.pi * t), 5, P.radius * glint.sin(2 * math.pi * t) }
end }
LUA
cat >grid.lua <<'LUA'
local glint = require "glint"
local S = require "scene"
return glint.sweep { scene = S.scene, size = { 40, 30 }, output = os.getenv "OUT" or "grid/%04d.png",
  over = { { S.red, "shininess", { 1, 4, 16 } }, { S.red, "specular", { 0.25, 1 / 3 } } },
  sheet = load("return " .. (os.getenv "SHEET" or "{}"))() }
LUA
cat >loop.lua <<'LUA'
local S = require "scene"
for i = 1, 3 do
  S.lamp.x = i
  S.scene:render { width = 40, height = 24 }
end
LUA
cat >slow.lua <<'LUA'
local glint = require "glint"
local S = require "scene"
return glint.animation { scene = S.scene, frames = 400, width = 320, height = 200, samples = 16, frame = function(t)
  S.lamp.x = 9 * t
end }
LUA

# ---- A stand-in for ffmpeg: writes its arguments and its input's size to the file that the last one names ----

mkdir -p bin none
cat >bin/ffmpeg <<'SH'
#!/bin/sh
for last; do :; done
file=${last#file:}
[ -z "${FFMPEG_FAILS:-}" ] || { echo "Unknown encoder 'libx264'" >&2; exit 8; }
[ -z "${FFMPEG_SLOW:-}" ] || sleep 1
[ -z "${FFMPEG_HANGS:-}" ] || { touch started; exec sleep 60; }
{ echo "$*"; wc -c; } >"$file"
SH
chmod +x bin/ffmpeg
for tool in sh touch sleep wc; do ln -s "$(command -v "$tool")" bin/; done
timeout=$(command -v timeout)
path_without=$work/none path_with=$work/bin
with() { # PATH WANT NAME ARGUMENTS...
    local path=$1 want=$2 name=$3 status
    shift 3
    env PATH="$path" "$timeout" 60 "$GLINT" "$@" >out 2>err </dev/null
    status=$?
    if [ "$status" -eq "$want" ]; then pass; else fail "$name: exit $status, not $want: $(head -n 3 err)"; fi
}

# ---- Sheets ----

exits 0 "a sweep with a sheet" grid.lua --json
prints "the sheet is an event" '"event":"sheet","file":"grid/sheet.png","frames":6'
check "the sheet is a picture" "$GLINT" compare grid/sheet.png grid/sheet.png
before=$(sha256sum <grid/sheet.png)
exits 0 "a kept sweep draws it again" grid.lua
[ "$before" = "$(sha256sum <grid/sheet.png)" ] && pass || fail "the sheet's bytes changed"
exits 0 "the same sheet of files" sheet grid/000*.png -o again.png
check "and the same picture" "$GLINT" compare grid/sheet.png again.png
exits 0 "the same sheet of a pattern" sheet 'grid/%04d.png' -o pattern.png
check "byte for byte" cmp again.png pattern.png
exits 0 "chosen frames of a pattern" sheet 'grid/%04d.png' -f 2-3 -o chosen.png --json
prints "are in it" '"file":"chosen.png","frames":2'
exits 2 "a pattern in quotes that is a shell's" sheet 'grid/000*.png' -o wrong.png
says "is told so" 'no such file; give the names without quotes'
before=$(sha256sum <grid/0002.png)
exits 2 "a frame's name for the sheet" sheet grid/0001.png grid/0002.png -o grid/../grid/0002.png
says "is refused" '-o: .* is one of the input pictures; give another file'
[ "$before" = "$(sha256sum <grid/0002.png)" ] && pass || fail "a frame was overwritten"
for columns in 1 2 4 5; do
    exits 2 "$columns columns of 3 x 2 pictures" sheet grid/000*.png -o wrong.png --columns $columns
    says "would have no axis" "columns: 3 or 6 expected, so that each column of the 3 .shininess. x 2 .specular. pictures has one value of shininess, got $columns"
done
exits 0 "columns" sheet grid/000*.png -o columns.png --columns 6
exits 3 "make another sheet" compare again.png columns.png
exits 0 "a title and no labels" sheet grid/000*.png -o titled.png --title "Glanz ä" --label none
exits 0 "labels by a template" sheet grid/000*.png -o label.png --label 'n = {shininess}, {file} {frame}'
exits 0 "other names and formats" sheet grid/000*.png -o names.png --names shininess=n,specular=ks --format 'shininess=%.0f,specular=%+.2f'
exits 3 "make another sheet" compare again.png names.png
exits 0 "a page of them" sheet grid/000*.png -o names.html --names shininess=n --format '%.1f'
check "has both" grep -q 'name: "n", values: \["1.0", "4.0", "16.0"\]' names.html
exits 0 "a single row" sheet grid/000[123].png -o row.png
cat >named.lua <<'LUA'
local glint = require "glint"
local P = glint.params { size = { 1, min = 0.5, max = 2, label = "Radius $r$" },
  tone = { "dark", choices = { "dark", "light" }, names = { dark = "Night", light = "Day" } } }
local red = glint.material { specular = 0.6 }
return glint.sweep { width = 16, height = 12, output = "named/%04d.png", over = { { red, "shininess", { 4, 64 } }, { red, "model", { "phong", "blinn_phong" } } },
  sheet = { output = "named/sheet.html", names = { shininess = "n", model = "Model", blinn_phong = "Blinn-Phong", ["64"] = "sharp" } },
  scene = glint.scene { camera = glint.camera { eye = { 0, 0, 8 }, at = { 0, 0, 0 } }, ambient = P.tone == "dark" and 0.1 or 0.9,
    glint.point_light { position = { 3, 5, 4 } }, glint.sphere { center = { 0, 0, 0 }, radius = P.size, material = red } } }
LUA
exits 0 "a sheet with names for values" named.lua
has_axes() { # PAGE AXIS...
    local page=$1
    shift
    for axis; do check "$page: $axis" grep -qF "$axis" "$page"; done
}
has_axes named/sheet.html 'name: "n", values: ["4", "sharp"]' 'name: "Model", values: ["phong", "Blinn-Phong"]'
exits 0 "files have the names" sheet 'named/%04d.png' -o later.html
has_axes later.html 'name: "n", values: ["4", "sharp"]' 'name: "Model", values: ["phong", "Blinn-Phong"]'
exits 0 "other names win" sheet 'named/%04d.png' -o renamed.html --names shininess=s,phong=Phong
has_axes renamed.html 'name: "s", values: ["4", "sharp"]' 'name: "Model", values: ["Phong", "Blinn-Phong"]'
exits 2 "a value that the sheet lacks" sheet 'named/%04d.png' -o wrong.html --names phon=Phong
says "a value that the sheet lacks" "names: the sheet has no axis or value 'phon'; did you mean 'phong'"
sed '/return/,$d' named.lua >swept.lua
cat >>swept.lua <<'LUA'
return glint.animation { frames = 1, width = 16, height = 12, scene = glint.scene { ambient = P.tone == "dark" and 0.1 or 0.9,
  camera = glint.camera { eye = { 0, 0, 8 }, at = { 0, 0, 0 } }, glint.sphere { center = { 0, 0, 0 }, radius = P.size } } }
LUA
exits 0 "parameters with labels" swept.lua --sweep tone=dark,light --sweep size=1:2:2 -o 'swept/%04d.png'
exits 0 "a sheet of them" sheet 'swept/%04d.png' -o labels.html
has_axes labels.html 'name: "tone", values: ["Night", "Day"]' 'name: "Radius $r$", values: ["1", "2"]'
cp swept/0001.png before.png
exits 0 "the same frames" swept.lua --sweep tone=dark,light --sweep size=1:2:2 -o 'swept/%04d.png' --force
check "have the same bytes" cmp before.png swept/0001.png
for wrong in "names shinines=n:names: the sheet has no axis or value .shinines.; did you mean .shininess." "names n:names: AXIS=TEXT expected, got 'n'" \
    "names shininess=:names: a name of 1 .. 100 bytes expected, got 0" "names shininess=$(printf '%0101d' 0):names: a name of 1 .. 100 bytes expected, got 101" \
    'format %d:format: .*such as %.2f' 'format %s:format: .*got .%s.' 'format %n:format:' 'format %f%f:format:' 'format %:format:' 'format x:format:' \
    'format %*f:format:' 'format %.999f:format:' 'format %lf:format:' 'format specula=%f:format: the sheet has no axis .specula.; did you mean .specular.'; do
    exits 2 "--${wrong%%:*}" sheet grid/000*.png -o wrong.png --${wrong%%:*}
    says "--${wrong%%:*}" "${wrong#*:}"
done
exits 2 "an unknown name in it" sheet grid/000*.png -o wrong.png --label '{shine}'
says "and which are known" '\{shininess\} \{specular\}'
absent "nothing is written then" wrong.png
exits 0 "a difference row" sheet grid/000*.png -o difference.png --difference 2 --gain 4
exits 0 "a sheet in points" sheet grid/000*.png -o points.png --dpi 144 --label-size 13
exits 0 "a sheet in pixels" sheet grid/000*.png -o pixels.png --label-size 26
check "as large at two pixels a point" "$GLINT" compare points.png pixels.png
check "its dpi" eval '[ "$(grep -c pHYs points.png)" -gt 0 ] && [ "$(grep -c pHYs pixels.png)" -eq 0 ]'
exits 3 "larger text, larger sheet" compare pixels.png again.png
exits 0 "no paper" sheet grid/000*.png -o clear.png --transparent
check "RGBA" eval '[ "$(od -An -tu1 -j25 -N1 clear.png)" -eq 6 ] && [ "$(od -An -tu1 -j25 -N1 again.png)" -eq 2 ]'
exits 2 "text of no size" sheet grid/000*.png -o wrong.png --label-size 0
says "is refused" 'label-size: points 1 .. 10000 expected'
exits 2 "a page without paper" sheet grid/000*.png -o wrong.html --transparent
says "has none to leave out" 'transparent: has no effect on a page'
exits 0 "a colour bar of all pictures" sheet grid/000*.png -o bar.png --colorbar 'viridis,0,2.5,T / K'
exits 3 "at the right of the others" compare bar.png again.png
exits 2 "of no map" sheet grid/000*.png -o wrong.png --colorbar jet,0,1
says "is refused" "colorbar: viridis, magma, cividis, turbo or coolwarm expected, got 'jet'"
exits 2 "of a misspelt one" sheet grid/000*.png -o wrong.png --colorbar magmo,0,1
says "is answered" "did you mean 'magma'?"
exits 2 "of a title without end" sheet grid/000*.png -o wrong.png --colorbar "magma,0,1,$(printf '%0400d' 0)"
says "is refused" 'colorbar: expected a title of at most 383 bytes'
exits 2 "without its last number" sheet grid/000*.png -o wrong.png --colorbar magma,0
says "is refused" 'colorbar: MAP,LOW,HIGH or'
exits 2 "of one number" sheet grid/000*.png -o wrong.png --colorbar magma,1,1
says "is refused" 'colorbar.high: another number than low'
exits 2 "on a page" sheet grid/000*.png -o wrong.html --colorbar magma,0,1
says "is refused" 'colorbar: has no effect on a page'
exits 2 "of a cell that is not there" sheet grid/000*.png -o wrong.png --difference 7
says "is refused by number" 'difference: .*1 \.\. 6'
exits 2 "no output" sheet grid/0001.png
exits 2 "another ending" sheet grid/0001.png -o sheet.jpg
exits 1 "a missing file" sheet grid/0001.png grid/none.png -o wrong.png
says "is named" 'grid/none.png: No such file'
exits 0 "a larger picture" turn.lua -f 1 --size 48x24 -o larger.png -q
exits 2 "of another size" sheet grid/0001.png larger_0001.png -o wrong.png
says "is named with both sizes" 'larger_0001.png: 40x30 .*got 48x24'
exits 0 "a picture of another script" turn.lua -f 1 --size 40x30 -o other.png -q
exits 0 "in one sheet" sheet grid/0001.png other_0001.png -o mixed.png
says "is named with both" 'warning: other_0001.png .*turn.lua.*grid/0001.png with script grid.lua; the sheet has file names as labels'
exits 0 "the same with given labels" sheet grid/0001.png other_0001.png -o files.png --label '{file}'
check "the labels are the files" cmp mixed.png files.png
exits 0 "--force takes it" sheet grid/0001.png other_0001.png -o forced.png --force
check "without a word" test "$(wc -l <err)" -le 1
sed 's/frames = [0-9]*/frames = 3/' turn.lua >turn_3.lua
mkdir -p old new
exits 0 "a version" turn_3.lua -f 1 --size 20x15 -o old/ball.png -q
exits 0 "a second version" turn.lua -f 1 --size 20x15 -o new/ball.png -q
exits 0 "files of one name" sheet old/ball_0001.png new/ball_0001.png -o two.html
check "have their folders as labels" grep -q '^"old/ball_0001.png",$' two.html
head -c 300 grid/0002.png >cut.png
exits 1 "a cut picture" sheet grid/0001.png cut.png -o wrong.png
says "is named" 'cut.png: not a whole PNG'
exits 0 "exact frames" grid.lua -o 'exact/%04d.pfm' -q
exits 0 "go on a sheet too" sheet exact/000*.pfm -o exact.png
absent "no failed sheet" wrong.png

export SHEET='{ label = function(v, n) return n .. ": " .. v.shininess end, columns = 3, output = "named.png" }'
exits 0 "a sheet with a label function" grid.lua
check "under its own name" test -s named.png
SHEET='{ label = function() error "no label today" end }' exits 2 "an error in it" grid.lua
says "is the script's" 'no label today'
for wrong in '{ lable = true }:did you mean .label' '{ columns = 0 }:columns: whole number' '{ gain = -1 }:gain: number' \
    '{ output = "x.jpg" }:output: .*\.html' '{ difference = 1.5 }:difference' \
    '{ difference = 7 }:difference: a picture 1 .. 6 expected, got 7' '{ gain = 2 }:gain: expected together with difference' \
    '{ output = "x.html", columns = 2 }:columns: not for pages; a page has one column for each value of its first axis' '{ label = "n {shine}" }:label: .shine.: the name of an axis' '{ title = 5 }:title: text' \
    '{ names = { shinines = "n" } }:names: the sheet has no axis or value .shinines.; did you mean .shininess.' '{ names = "n" }:names: table' '{ names = { shininess = 5 } }:names: table' \
    '{ format = "%d" }:format: .*got .%d.' '{ format = { specular = "%s" } }:format: .*got .%s.' '{ format = 3 }:format: text' '{ format = "%f\n%f" }:format: AXIS=TEXT' '{ passes = 1 }:passes: boolean' '{ size = 0 }:size: points' \
    '{ dpi = -1 }:dpi: number 0' '{ transparent = 1 }:transparent: boolean' '{ transparent = true, output = "x.html" }:transparent: has no effect' '{ colorbar = 5 }:colorbar: glint.colorbar expected' '5:sheet: table'; do
    SHEET=${wrong%%:*} exits 2 "sheet = ${wrong%%:*}" grid.lua
    says "sheet = ${wrong%%:*}" "${wrong#*:}"
done
SHEET='{ passes = true, names = { pass = "part" } }' exits 0 "a sheet of the passes" grid.lua --passes diffuse,specular -o 'parts/%04d.png' --json
prints "has a picture of each" '"event":"sheet","file":"parts/sheet.png","frames":18'
exits 0 "the same sheet of the files" sheet parts/000?.png parts/000?.diffuse.png parts/000?.specular.png -o by_pass.png --names pass=part
exits 0 "frame by frame" sheet $(for n in 1 2 3 4 5 6; do echo parts/000$n.png parts/000$n.diffuse.png parts/000$n.specular.png; done) -o by_frame.png --names pass=part
check "draws the same" "$GLINT" compare by_frame.png parts/sheet.png
SHEET='{ passes = true }' exits 2 "a sheet of all lights" grid.lua --passes 'light:*' -o 'lights/%04d.png'
says "names them" "sweep.sheet.passes: expected the names of lights in the passes light:NAME"
export SHEET='{}'
rm -r grid
exits 0 "a part of a sweep" grid.lua -f 1-2
says "has no sheet yet" 'grid/sheet.png: not drawn: frames between 3 and 6'
exits 0 "a shard" grid.lua --shard 1/2
exits 0 "and the other" grid.lua --shard 2/2
check "draw it when all is there" cmp grid/sheet.png <("$GLINT" sheet grid/000*.png -o whole.png 2>/dev/null; cat whole.png)
exits 0 "passes" turn.lua -f 2 --passes depth,normal -o pass.png -q
exits 0 "are an axis" sheet pass_0002.png pass_0002.depth.png pass_0002.normal.png -o passes.png --label '{pass}'
exits 0 "a sweep of the command line" turn.lua -f 1-18:6 --sweep radius=2:6:3 -o 'swept_%04d.png' -q
exits 0 "its frames on a sheet" sheet swept_*.png -o swept.png --label 'r {radius}'
exits 0 "files of -D" turn.lua -f 1 -D radius=9 -o nine.png -q
exits 0 "stand beside others" sheet other_0001.png other_0001.png -o same.png --label '{file}'

cat >two.lua <<'LUA'
local glint = require "glint"
local S = require "scene"
local function grid(object, name) return glint.sweep { scene = S.scene, size = { 20, 15 }, sheet = {},
  over = { { object, name, { 1, 2, 3 } } } } end
return { grid(S.lamp, "x"), grid(S.lamp, "y") }
LUA
exits 0 "two sweeps" two.lua -q
check "two sheets" test -s two_sheet.png -a -s two_sheet_0004.png
exits 0 "a page" sheet grid/000*.png -o page.html --difference 1 --title 'a < b & </script>'
check "without anything from elsewhere" bash -c '! grep -qE "src=\"|https?://|@import|url\(" page.html'
check "with every picture" test "$(grep -c '^"data:image/png;base64,' page.html)" -eq 6
check "the first being the file" cmp grid/0001.png <(sed -n 's/^"data:image\/png;base64,\(.*\)",$/\1/p' page.html | head -n 1 | base64 -d)
check "a slider for each axis" test "$(grep -cE '^ +\{ name: "(shininess|specular)"' page.html)" -eq 2
check "its title ends no script" test "$(grep -c '</script>' page.html)" -eq 1
cat >over.lua <<'LUA'
local glint = require "glint"
local P = glint.params { radius = 1 }
local ball = glint.sphere { center = { 0, 0, 0 }, radius = P.radius }
return glint.animation { frames = 4, width = 8, height = 6, frame = function(t) ball.x = t end,
  scene = glint.scene { ambient = 0.5, camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ball } }
LUA
exits 0 "a sweep over a film" over.lua --sweep radius=0.5,1,1.5 -o 'over_%04d.png' -q
exits 0 "its page" sheet 'over_%04d.png' -o over.html
check "has a slider for the frames" grep -q '{ name: "frame", values: \["1", "2", "3", "4"\] }' over.html
check "and one for the axis" grep -q '{ name: "radius", values: \["0.5", "1", "1.5"\] }' over.html
exits 0 "a page without a frame" sheet over_000[1-7].png -o part.html
check "has one slider" test "$(grep -cE '^ +\{ name: ' part.html)" -eq 1
exits 2 "a page of exact frames" sheet exact/000*.pfm -o exact.html

# ---- Animated PNG ----

chunks() { # FILE: its chunks' types, in order
    od -An -v -tx1 "$1" | tr -d ' \n' | awk '{
        for (at = 17; at < length($0); at += 24 + 2 * size) {
            size = 0; type = ""
            for (i = 0; i < 8; i++) size = size * 16 + index("123456789abcdef", substr($0, at + i, 1))
            for (i = 8; i < 16; i += 2) type = type sprintf("%c", 16 * index("123456789abcdef", substr($0, at + i, 1)) + index("123456789abcdef", substr($0, at + i + 1, 1)))
            printf "%s ", type
        } }'
}
exits 0 "an animated PNG" turn.lua -o film.png --apng --json
prints "is an event" '"event":"film","file":"film.png","frames":6'
[ "$(chunks film.png)" = "IHDR sRGB acTL fcTL IDAT fcTL fdAT fcTL fdAT fcTL fdAT fcTL fdAT fcTL fdAT IEND " ] &&
    pass || fail "its chunks: $(chunks film.png)"
absent "its frames are gone" film.png.frames
exits 0 "frames" turn.lua -o 'f/%02d.png' -q
exits 0 "the first frame is the picture" compare film.png f/01.png
exits 0 "assembled from frames" assemble 'f/%02d.png' -o assembled.png --fps 12
check "it is the same film" cmp film.png assembled.png
exits 2 "a frame's name for the film" assemble f/01.png f/02.png -o f/02.png
says "is refused, too" '-o: .* is one of the input pictures; give another file'
exits 0 "of one frame" assemble f/01.png -o one.png
[ "$(chunks one.png)" = "IHDR sRGB acTL fcTL IDAT IEND " ] && pass || fail "chunks of one frame: $(chunks one.png)"
exits 0 "of 16 bits, linear" turn.lua -f 1-2 --bits 16 --transfer linear -o deep.png --apng
exits 0 "of a loop" loop.lua -o loop.png --apng
check "of its calls" test "$(chunks loop.png | grep -o fcTL | wc -l)" -eq 3
exits 2 "--fps for pictures" turn.lua -o frame.png --fps 12
exits 2 "--apng for another kind" turn.lua -o film.mp4 --apng

# ---- Films by ffmpeg ----

with "$path_with" 0 "a film" turn.lua -o film.mp4
check "fed with every pixel" grep -qx $((40 * 24 * 3 * 6)) film.mp4
check "at the animation's rate" grep -q -- '-video_size 40x24 -framerate 12 ' film.mp4
absent "its frames are gone" film.mp4.frames
if command -v script >/dev/null; then
    PATH=$path_with:$PATH TERM=xterm FFMPEG_SLOW=1 timeout 20 script -qec "$GLINT turn.lua -o slow.mp4" typescript >/dev/null </dev/null
    check "a terminal shows that the film is made" grep -qaE "(making|finishing) slow.mp4" typescript
    PATH=$path_with:$PATH TERM=xterm FFMPEG_SLOW=1 timeout 20 script -qec "stty cols 22; $GLINT turn.lua -o slow.mp4 --force" typescript >/dev/null </dev/null
    check "in one line of a narrow one" awk 'BEGIN { RS = "[\r\n]" } { gsub(/\033\[[0-9]*[mK]/, "") }
        /(making|finishing) slow/ { seen = 1; if (length($0) > 21) exit 1 } END { exit !seen }' typescript
fi
with "$path_with" 0 "another rate" turn.lua -o film.webm --fps 30
check "beats the script's" grep -q -- '-framerate 30 .*libvpx-vp9' film.webm
with "$path_with" 0 "odd sides" turn.lua -o odd.mp4 --size 41x25 -f 1-2
check "are filled up" grep -qx $((42 * 26 * 3 * 2)) odd.mp4
says "and it says how" '42x26 .*last column and row are repeated'
with "$path_with" 0 "a GIF takes odd sides" turn.lua -o odd.gif --size 41x25 -f 1-2
check "as they are" grep -qx $((41 * 25 * 3 * 2)) odd.gif
with "$path_with" 2 "too fast for a GIF" turn.lua -o fast.gif --fps 60
with "$path_with" 2 "shards" turn.lua -o film.mp4 --shard 1/2
with "$path_with" 2 "passes" turn.lua -o film.mp4 --passes depth
with "$path_with" 2 "a number in the name" turn.lua -o 'film_%04d.mp4'
with "$path_with" 0 "assemble" assemble 'f/%02d.png' -o film.mp4
check "at 24 a second" grep -q -- '-framerate 24 ' film.mp4

rm -f film.mp4
with "$path_without" 1 "without ffmpeg" turn.lua -o film.mp4
says "what to do" "not installed.*glint assemble 'film.mp4.frames/%04d.png' -o 'film.mp4' --fps 12"
absent "there is no film" film.mp4
check "but its frames" test "$(ls film.mp4.frames | wc -l)" -eq 6
with "$path_with" 0 "what it said to do" assemble 'film.mp4.frames/%04d.png' -o film.mp4 --fps 12
with "$path_with" 0 "or the same again" turn.lua -o film.mp4 --json
prints "keeps the frames" '"frames":6,"kept":6'
absent "and removes them" film.mp4.frames
echo old >kept.mp4
FFMPEG_FAILS=1 with "$path_with" 1 "a failing ffmpeg" turn.lua -o kept.mp4
says "is quoted" "kept.mp4: ffmpeg failed with exit code 8: Unknown encoder 'libx264'"
says "and the frames are kept" '6 finished frames of kept.mp4 are in kept.mp4.frames'
check "the old film too" grep -qx old kept.mp4
FFMPEG_FAILS=1 with "$path_with" 1 "and under assemble" assemble 'f/%02d.png' -o kept.mp4
absent "no draft stays" nothing

interrupt() { # NAME FILE-TO-WAIT-FOR ARGUMENTS...
    local name=$1 wait_for=$2 status
    shift 2
    env PATH="$path_with" "$GLINT" "$@" >out 2>err </dev/null &
    local process=$!
    for _ in $(seq 200); do
        [ -e "$wait_for" ] && break
        sleep 0.02
    done
    kill -TERM $process
    wait $process
    status=$?
    if [ $status -eq 143 ]; then pass; else fail "$name: exit $status, not 143: $(head -n 3 err)"; fi
}
FFMPEG_HANGS=1 interrupt "a signal while ffmpeg works" started assemble 'f/%02d.png' -o stopped.mp4
absent "leaves no film" stopped.mp4
interrupt "a signal while frames render" stopped.mp4.frames/0001.png slow.lua -o stopped.mp4
absent "leaves no film either" stopped.mp4
says "but the frames" 'finished frames of stopped.mp4 are in stopped.mp4.frames'

rm f/03.png f/05.png
exits 2 "a gap" assemble 'f/%02d.png' -o gap.png
says "is named" 'these frames are missing: 3, 5$'
exits 0 "frames without it" assemble 'f/%02d.png' -o part.png -f 1-2
exits 2 "frames with it" assemble 'f/%02d.png' -o gap.png -f 1-6:2
exits 0 "a stale frame" turn.lua -f 3,5 -D radius=5 -o 'f/%02d.png' -q
exits 2 "is found" assemble 'f/%02d.png' -o stale.png
says "and named" 'f/03.png was rendered with radius=5, but f/01.png with radius=4'
exits 0 "one of other options" turn.lua -f 3,5 --samples 4 -o 'f/%02d.png' -q
exits 2 "is found too" assemble 'f/%02d.png' -o stale.png
says "and named too" 'f/03.png was rendered with samples=4'
exits 0 "--force takes them" assemble 'f/%02d.png' -o stale.png --force
exits 0 "one of another size" turn.lua -f 3,5 --size 20x10 -o 'f/%02d.png' -q
exits 2 "is not taken" assemble 'f/%02d.png' -o size.png --force
says "and named with its size" 'f/03.png: 40x24 .*got 20x10'
exits 0 "a frame of an earlier text" turn.lua -f 1-6 -o 'e/%d.png' -q
sed -i 's/0.8, 0.2/0.8, 0.3/' scene.lua
exits 0 "and of the edited one" turn.lua -f 4-6 -o 'e/%d.png' -q
exits 2 "mixed" assemble 'e/%d.png' -o mixed.png
says "are named" 'e/4.png was rendered with script text [0-9a-f]+, but e/1.png with script text'
exits 0 "after a run of all" turn.lua -o 'e/%d.png' -q
exits 0 "they go together" assemble 'e/%d.png' -o mixed.png
sed -i 's/0.8, 0.3/0.8, 0.2/' scene.lua
exits 0 "frames of a --sweep" assemble 'swept_%04d.png' -f 1,7,13 -o swept_film.png
exits 2 "a pass among frames" assemble pass_0002.png pass_0002.depth.png -o passes_film.png
says "is named" 'pass_0002.depth.png.*(pass depth|transfer)'
exits 2 "no frames" assemble 'nothing_%04d.png' -o none.png
exits 2 "no film" assemble f/01.png
absent "nothing was made of these" gap.png size.png none.png

# ---- Plain Lua ----

cat >plain.lua <<'LUA'
local glint = require "glint"
local S = require "scene"
local turn = glint.animation { scene = S.scene, frames = 4, fps = 10, width = 40, height = 24, frame = function(t)
  S.lamp.x = 5 * t
end }
assert(turn:run { output = "plain.apng" }.frames == 4)
assert(turn:run { output = "plain.apng", frames = "2-3" }.frames == 2)
assert(not pcall(S.scene.render, S.scene, { output = "none.apng", width = 40, height = 24 }))
assert(not pcall(turn.run, turn, { output = "none.apng", shard = "1/2" }))
local grid = glint.sweep { scene = S.scene, over = { { S.lamp, "x", { 1, 2 } } }, size = { 40, 24 }, output = "p/%d.png",
  sheet = { label = false } }
grid:run()
assert(grid.sheet.label == false)
grid.sheet = { label = function(values, n) return ("%d: x is %g"):format(n, values.x) end, output = "plain.html" }
grid:run()
assert(not pcall(function() grid.sheet = { difference = 3 } end))
grid.sheet = { label = function() error "stop" end }
local good, message = pcall(grid.run, grid)
assert(not good and message:find "stop")
LUA
export LUA_CPATH=${LUA_CPATH:-$(dirname "$GLINT")/?.so;;}
check "plain Lua makes films and sheets" env LD_PRELOAD="${PRELOAD:-}" "${LUA:-lua5.4}" plain.lua
check "the second film of two frames" test "$(chunks plain.apng | grep -o fcTL | wc -l)" -eq 2
check "the sheet" test -s p/sheet.png
check "the page with the function's labels" grep -q '"2: x is 2"' plain.html
absent "and no more" none.apng none.apng.frames plain.apng.frames

# ---- Two runs at once ----

# Each script runs the command a second time while it makes its own first frame.
cat >twice.lua <<'LUA'
local glint = require "glint"
local P = glint.params { command = "", light = 0.5 }
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, background = P.light }
return glint.animation { scene = scene, frames = 2, width = 8, height = 6, frame = function(_, n)
  if n == 1 and P.command ~= "" then os.execute(P.command) end
end }
LUA
exits 0 "a film while another run makes it" twice.lua -o two.apng -q --set command="'$GLINT' twice.lua -o two.apng 2>second; echo \$? >code"
check "the second run ends with 2" test "$(cat code)" -eq 2
check "and says why" grep -q "output: 'two.apng' is a film: another run is making it now" second
check "the first has all frames" test "$(chunks two.apng | grep -o fcTL | wc -l)" -eq 2
absent "and no folder" two.apng.frames
exits 0 "a film after the other" twice.lua -o two.apng -q
exits 0 "a film elsewhere" twice.lua -o new/deep/two.apng -q --set command="'$GLINT' twice.lua -o two.apng -q 2>second; echo \$? >code"
check "is no other film's" test "$(cat code)" -eq 0
exits 0 "a job while another one writes its files" twice.lua -o 'same_%d.png' -q --set command="'$GLINT' twice.lua -o 'same_%d.png' -q --set light=0.25"
says "a job while another one writes its files" "warning: frame 1: output: 'same_1.png' was written by another run after this one began, and that picture is lost"
check "is said once" test "$(grep -c warning err)" -eq 1
exits 0 "the same job" twice.lua -o 'equal_%d.png' -q --set command="'$GLINT' twice.lua -o 'equal_%d.png' -q"
exits 0 "a later job" twice.lua -o 'same_%d.png' -q --set light=0.75
check "nothing is said then" test ! -s err

# ---- Transparent background ----

exits 0 "frames with alpha" turn.lua --alpha --samples 4 -f 1-3 -o 'clear_%04d.png' --json
exits 0 "are kept" turn.lua --alpha --samples 4 -f 1-3 -o 'clear_%04d.png' --json
check "all of them" test "$(grep -c '"status":"kept"' out)" -eq 3
exits 0 "but not without alpha" turn.lua --samples 4 -f 1 -o 'clear_%04d.png' --json
prints "it is another picture" '"status":"rendered"'
exits 0 "and back" turn.lua --alpha --samples 4 -f 1 -o 'clear_%04d.png' -q
exits 3 "one of each do not compare" compare clear_0001.png swept_0007.png
exits 0 "alpha is reproduced" reproduce clear_0002.png turn.lua
exits 0 "a sheet shows the grey behind it" sheet 'clear_%04d.png' -o clear_sheet.png
exits 0 "an animated PNG has alpha" turn.lua --alpha -f 1-3 -o clear.apng
check "and says so" test "$(head -c 26 clear.apng | tail -c 1 | od -An -tu1 | tr -d ' ')" -eq 6
exits 0 "assembled as well" assemble 'clear_%04d.png' -o assembled.png --apng
exits 2 "other films have no room for it" turn.lua --alpha -f 1-3 -o clear.mp4
says "what has" "this format cannot hold alpha; an animated PNG can"
exits 2 "frames that have it" assemble 'clear_%04d.png' -o clear.gif
says "are named" "clear_0001.png: has alpha, which clear.gif cannot hold"
absent "nothing was begun" clear.mp4 clear.gif clear.mp4.frames

# ---- Reproduce ----

mkdir temporary
export TMPDIR=$work/temporary

exits 0 "a frame" turn.lua -f 4 -D radius=7.25 --samples 4 --bits 16 --passes depth -o made.png -q
exits 0 "is made again" reproduce made_0004.png turn.lua
prints "byte for byte" 'the same, byte for byte'
exits 0 "its pass, too" reproduce made_0004.depth.png turn.lua
exits 0 "a sweep's frame" reproduce grid/0005.png grid.lua
exits 0 "a --sweep's frame" reproduce swept_0007.png turn.lua
exits 0 "a call's frame" loop.lua -o 'call_%02d.png' -q
exits 0 "is made again" reproduce call_02.png loop.lua --json
prints "as an event" '"event":"reproduce","file":"call_02.png","script":"loop.lua","frame":2,"result":"same"'
sed 's/0.8, 0.2/0.7, 0.2/' scene.lua >scene2.lua
mkdir edited && cp scene2.lua edited/scene.lua && cp turn.lua loop.lua edited/
exits 4 "an edited module" reproduce made_0004.png edited/turn.lua
prints "is said to be that" 'different, by at most .*another script: its text has changed$'
cp turn.lua scene.lua edited/
echo '-- a remark' >>edited/turn.lua
exits 3 "a remark in the script" reproduce made_0004.png edited/turn.lua
prints "is told from that" 'same pixels, other bytes: .*but not the parts that this frame depends on'
cp turn.lua renamed.lua
exits 3 "a renamed script" reproduce made_0004.png renamed.lua
prints "is said to be that" "same pixels, other bytes: another script: 'turn.lua' then, 'renamed.lua' now"
exits 2 "a script without the parameter" reproduce made_0004.png loop.lua
says "names it" "no parameter 'radius'"
exits 2 "a script that is not there" reproduce made_0004.png none.lua
exits 2 "no script" reproduce made_0004.png
says "and what is expected" 'a finished picture and its script expected'
exits 5 "no file" reproduce none.png turn.lua
exits 5 "a file without a key" reproduce difference.png grid.lua
exits 5 "a cut file" reproduce cut.png grid.lua
check "no folder is left behind" rmdir "$TMPDIR"
unset TMPDIR

# ---- New ----

exits 0 "a new folder" new first
check "with a script and what editors read" test -s first/first.lua -a -s first/.luarc.json
check "which names the types" eval 'test -s "$(grep -o "/[^\"]*" first/.luarc.json)/glint.lua"'
exits 0 "it renders" first/first.lua -f 1 --size 64x36 -q -o none
exits 2 "a folder's script stays" new first
says "and it says so" 'first/first.lua: it exists already'
exits 0 "a new script" new start.lua
exits 0 "renders" start.lua -f 1 --size 64x36 -q -o start.png
exits 0 "and shows its parameters" start.lua --help
prints "with what they mean" 'radius=8 .*orbit'
before=$(sha256sum <start.lua)
exits 2 "is not written over" new start.lua
says "and it says so" 'start.lua: it exists already'
[ "$before" = "$(sha256sum <start.lua)" ] && pass || fail "start.lua changed"
exits 2 "no name" new
exits 2 "a name that ends in a slash" new x/
exits 1 "a folder that is not there" new none/x/y
says "and what makes it" 'none/x/y/y.lua: its folder does not exist'
exits 2 "a script without its ending" start
says "names the file" 'did you mean start.lua'
exits 2 "a word that is neither command nor script" stort
says "says both" 'cannot open stort: .*there is no command of this name'
command -v luacheck >/dev/null && check "and is clean Lua" luacheck -q start.lua

totals
