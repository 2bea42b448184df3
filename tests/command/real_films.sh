#!/usr/bin/env bash
# Films with the real ffmpeg, and animated PNGs and sheets as pages in Chromium: make check-films. Checks whose
# program is not installed are skipped with a message. Prints each failed check, then "N passed, N failed, N skipped".
. tests/command/prelude.sh

scripts=$PWD/scripts
cd "$work" || exit 1

same() { if [ "$2" = "$3" ]; then pass; else fail "$1: '$2', not '$3'"; fi; } # NAME GOT WANT

check "frames" "$GLINT" "$scripts/moving_light.lua" --size 161x91 -f 1-24 -o 'frame_%04d.png' -q

cat >plain.lua <<'LUA'
local glint = require "glint"
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 1 }, at = { 0, 0, 0 } } }
local colors = { "#c02030", "#30b040", "#3048d0" }
return glint.animation { scene = scene, frames = 3, width = 64, height = 48, frame = function(_, n)
  scene.background = colors[n]
end }
LUA
check "plain colours" "$GLINT" plain.lua -o 'plain_%d.png' -q

# ---- ffmpeg ----

probe() { ffprobe -v error -count_frames -select_streams v -show_entries "stream=$2" -of csv=p=0 "$1" | tr -d '\n'; }

films() {
    local kind film
    for kind in mp4 webm gif; do
        film=film.$kind
        check "$film" "$GLINT" "$scripts/moving_light.lua" --size 161x91 -f 1-24 -o $film
        check "$film of finished frames" "$GLINT" assemble 'frame_%04d.png' -o again.$kind --fps 24
        check "$film is the same film" cmp $film again.$kind
        check "$film decodes" ffmpeg -v error -xerror -i $film -f null -
        check "$film of plain colours" "$GLINT" plain.lua -o plain.$kind
        check "$film as pictures" ffmpeg -v error -y -i plain.$kind -vf format=rgb24 plain_${kind}_%d.png
        for n in 1 2 3; do # with a wrong matrix or range, colours would be off by at least 0.05
            check "colour $n of $film" "$GLINT" compare plain_$n.png plain_${kind}_$n.png --fail 0.02 --warn 0.02
        done
        [ ! -d $film.frames ] && pass || fail "$film.frames is there"
    done
    same "mp4" "$(probe film.mp4 codec_name,width,height,pix_fmt,color_range,color_space,r_frame_rate,nb_read_frames)" \
        "h264,162,92,yuv420p,tv,bt709,24/1,24"
    same "webm" "$(probe film.webm codec_name,width,height,pix_fmt,nb_read_frames)" "vp9,162,92,yuv420p,24"
    same "gif" "$(probe film.gif codec_name,width,height,nb_read_frames)" "gif,161,91,24"
    check "an APNG" "$GLINT" assemble 'frame_%04d.png' -o film.png
    same "ffmpeg reads the APNG" "$(ffprobe -v error -f apng -count_frames -show_entries stream=width,height,nb_read_frames \
        -of csv=p=0 film.png)" "161,91,24"
    for n in 1 7 24; do # APNG is lossless
        check "its frame $n" ffmpeg -v error -y -f apng -i film.png -vf "select=eq(n\\,$((n - 1)))" -frames:v 1 shown.png
        check "is the frame" "$GLINT" compare "$(printf 'frame_%04d.png' $n)" shown.png
    done
    check "too large for the encoder" bash -c "! '$GLINT' '$scripts/moving_light.lua' --size 20000x2 -f 1-2 -o large.mp4 2>err"
    check "is in its own words" grep -q 'large.mp4: ffmpeg failed with exit code [0-9]*: ' err
    [ ! -e large.mp4 ] && pass || fail "large.mp4 is there"
}
if command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null; then films; else skip "ffmpeg is not installed"; fi

# ---- Chromium ----

uri() { # VARIABLE FILE: a line of JavaScript
    printf 'const %s = Uint8Array.from(atob("%s"), c => c.charCodeAt(0));\n' "$1" "$(base64 -w 0 "$2")"
}
dump() { # PAGE: prints the contents of the element "result" after a while
    timeout 120 chromium --headless --no-sandbox --disable-gpu --user-data-dir="$work/profile" --virtual-time-budget=20000 \
        --dump-dom "file://$work/$1" 2>log </dev/null | sed -n 's/.*<pre id="result">\(.*\)<\/pre>.*/\1/p'
}

# Decodes an animated PNG as <img> does, and compares each frame with its source picture.
play() { # FILM PICTURE...
    local film=$1 n=0
    shift
    {
        echo '<!DOCTYPE html><pre id="result"></pre><script>'
        uri film "$film"
        echo 'const pictures = [];'
        for picture; do
            n=$((n + 1))
            uri "p$n" "$picture"
            echo "pictures.push(p$n);"
        done
        cat <<'JS'
async function codes(image, width, height) {
  const context = new OffscreenCanvas(width, height).getContext('2d');
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, width, height).data;
}
async function run() {
  const decoder = new ImageDecoder({ data: film, type: 'image/png' });
  await decoder.tracks.ready; await decoder.completed;
  const track = decoder.tracks.selectedTrack;
  let off = 0, durations = new Set();
  for (let i = 0; i < track.frameCount; i++) {
    const { image } = await decoder.decode({ frameIndex: i });
    const picture = await createImageBitmap(new Blob([pictures[i]], { type: 'image/png' }));
    const got = await codes(image, picture.width, picture.height), want = await codes(picture, picture.width, picture.height);
    for (let k = 0; k < want.length; k++) off = Math.max(off, Math.abs(got[k] - want[k]));
    durations.add(image.duration);
  }
  return [track.frameCount, track.animated ? 'animated' : 'still', 'off ' + off, [...durations].join(' ') + ' us'].join(', ');
}
// The browser's clock runs ahead of its decoders: each tick of it is made to cost some time.
let spins = 0;
const brake = setInterval(() => { for (let i = 0; i < 2e6; i++) spins += i % 7; }, 10);
run().then(text => text, error => String(error)).then(text => { document.getElementById('result').textContent = text; clearInterval(brake); });
JS
        echo '</script>'
    } >play.html
    dump play.html
}

# Moves the sliders of a page and reads the display.
move() { # PAGE STEPS: a slider's number and value each
    sed 's|</html>||' "$1" >moved.html
    cat >>moved.html <<JS
<pre id="result"></pre>
<script>
for (const [axis, value] of $2) {
  const input = document.getElementById('axis' + axis);
  input.value = value;
  input.dispatchEvent(new Event('input'));
}
const shown = document.getElementById('picture');
shown.decode().then(() => {
  document.getElementById('result').textContent = sheet.pictures.indexOf(shown.src) + 1 + ', ' + shown.naturalWidth + 'x' +
    shown.naturalHeight + ', ' + document.getElementById('label').textContent;
});
</script>
JS
    dump moved.html
}

# Clicks the picture at this position of the grid, and reads the grid and the page.
press() { # PAGE PLACE
    sed 's|</html>||' "$1" >pressed.html
    cat >>pressed.html <<JS
<pre id="result"></pre>
<script>
const grid = document.getElementById('grid'), buttons = Array.from(grid.querySelectorAll('button'));
buttons[$2].click();
const table = grid.querySelector('table');
const texts = list => Array.from(list, element => element.textContent.replaceAll('\n', ' and ')).join('|');
document.getElementById('result').textContent = [
  buttons.length, table ? texts(table.tHead.rows[0].cells) + ': ' + texts(table.tHead.rows[1].cells) : 'no table',
  table ? texts(table.querySelectorAll('tbody th')) : '', buttons[$2].textContent,
  buttons.every(b => b.querySelector('img').complete && b.querySelector('img').naturalWidth === 80),
  buttons.findIndex(b => b.getAttribute('aria-current')), document.querySelectorAll('[aria-current]').length,
  sheet.pictures.indexOf(document.getElementById('picture').src),
  Array.from(document.querySelectorAll('input[type=range]'), input => input.value).join(' '),
].join('; ');
</script>
JS
    dump pressed.html
}

# Notes whether the picture and the grid show differences from the chosen picture, before and after the page's box
# "difference" is ticked.
differ() { # PAGE
    sed 's|</html>||' "$1" >differing.html
    cat >>differing.html <<'JS'
<pre id="result"></pre>
<script>
const shown = () => Array.from(document.querySelectorAll('.pair img + img'), i => getComputedStyle(i).display).join(' ') + ' ' +
  getComputedStyle(document.querySelector('#grid .pair')).filter;
const notes = [shown()];
document.getElementById('difference').click();
notes.push(shown());
document.getElementById('result').textContent = notes.join('; ');
</script>
JS
    dump differing.html
}

browser() {
    local frames
    frames=(frame_000[1-6].png)
    check "an APNG" "$GLINT" assemble "${frames[@]}" -o film.png --fps 25
    same "Chromium plays it" "$(play film.png "${frames[@]}")" "6, animated, off 0, 40000 us"
    check "an APNG of one frame" "$GLINT" assemble frame_0001.png -o one.png
    same "Chromium shows it" "$(play one.png frame_0001.png | cut -d, -f 1,3)" "1, off 0"
    check "a page" "$GLINT" "$scripts/shininess_sweep.lua" --size 80x60 -q -o 's_%04d.png'
    check "of a sweep" "$GLINT" sheet 's_%04d.png' -o page.html
    same "its first picture" "$(move page.html '[]')" "1, 80x60, specular = 0.25  shininess = 3"
    same "another place on both axes" "$(move page.html '[[0, 2], [1, 1]]')" "6, 80x60, specular = 0.75  shininess = 9"
    same "the grid with its axes, and a picture of it that is pressed" "$(press page.html 5)" \
        "9; |specular: shininess|0.25|0.5|0.75; 3|9|200; ; true; 5; 1; 5; 2 1"
    check "a page of chosen pictures" "$GLINT" sheet s_0002.png s_0004.png -o two.html --difference 1
    same "in a row, with one slider" "$(press two.html 1)" "2; no table; ; specular = 0.25  shininess = 9; true; 1; 1; 1; 1"
    same "differences, in the grid as well" "$(differ two.html)" "none none none none; block block block brightness(8)"
}
if command -v chromium >/dev/null; then browser; else skip "chromium is not installed"; fi

totals
