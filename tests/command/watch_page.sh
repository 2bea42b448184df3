#!/usr/bin/env bash
# The page of glint watch in headless Chromium, controlled over its debugging pipe (messages end in a zero byte). The
# picture appears, a save replaces it, an error covers it until it is fixed, a warning appears below, frames can be
# scrubbed, sliders set parameters, and a value out of range is reported.
# Without Chromium the test is skipped with a message.
set -u
glint=${GLINT:-$PWD/${BUILD:-build}/glint}
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || {
    echo "skip: chromium is not installed"
    exit 77
}
work=$(mktemp -d)
pids=()
trap 'for p in "${pids[@]}"; do kill "$p" 2>/dev/null; done; wait 2>/dev/null; rm -rf "$work"' EXIT
cd "$work" || exit 1
bad=0 last_id=0

check() { # NAME COMMAND...
    local name=$1
    shift
    if "$@"; then echo "ok - $name"; else
        echo "not ok - $name"
        bad=1
    fi
}

save() { # [SHADE [EXTRA]]
    cat >new.lua <<END
local glint = require "glint"
local P = glint.params { shade = { ${1:-0.5}, min = 0, max = 1, doc = "how bright" }, model = { "phong", choices = { "phong", "lambert" } } }
${2:-}
local ball = glint.sphere { center = { 0, 0, 0 }, radius = 2, material = glint.material { ambient = P.shade, diffuse = 0.5 } }
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1, ball }
return glint.animation { scene = scene, frames = 12, width = 640, height = 360, frame = function(t) ball.center = { t, 0, 0 } end }
END
    mv new.lua scene.lua
}
save
"$glint" watch scene.lua --http --json >events 2>err </dev/null &
pids+=($!)
for _ in $(seq 500); do grep -qs '"url"' events && break || sleep 0.01; done
url=$(sed -n 's/.*"url":"\([^"]*\)".*/\1/p' events)

mkfifo to from
"$chromium" --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run --user-data-dir="$work/profile" \
    --window-size=1000,600 --remote-debugging-pipe about:blank 3<to 4>from 2>chromium.log &
pids+=($!)
exec 8>to 9<from

# send METHOD PARAMS [SESSION]: puts the reply's text into `reply`
send() {
    last_id=$((last_id + 1))
    printf '{"id":%d,"method":"%s","params":%s%s}\0' $last_id "$1" "$2" "${3:+,\"sessionId\":\"$3\"}" >&8
    while IFS= read -r -t 20 -d '' reply <&9; do
        case $reply in *"\"id\":$last_id,"*) return 0 ;; esac
    done
    echo "# no answer to $1"
    tail -n 3 chromium.log
    return 1
}
field() { printf '%s' "$reply" | sed -n "s/.*\"$1\":\"\([^\"]*\)\".*/\1/p"; }

send Target.createTarget "{\"url\":\"$url\"}" || exit 1
send Target.attachToTarget "{\"targetId\":\"$(field targetId)\",\"flatten\":true}" || exit 1
session=$(field sessionId)

# becomes EXPRESSION: waits up to 8 s until the JavaScript expression is true
becomes() {
    for _ in $(seq 160); do
        send Runtime.evaluate "{\"expression\":\"!!($1)\"}" "$session" || return 1
        case $reply in *'"value":true'*) return 0 ;; esac
        sleep 0.05
    done
    send Runtime.evaluate '{"expression":"document.body.innerText + get(\"picture\").src"}' "$session"
    echo "# $reply"
    return 1
}
now() {
    send Runtime.evaluate "{\"expression\":\"String($1)\"}" "$session"
    field value
}
run() { send Runtime.evaluate "{\"expression\":\"$1\"}" "$session"; }

check "the picture shows" becomes "document.images[0].naturalWidth === 640 && document.images[0].complete"
check "the script's name and size" becomes "document.body.innerText.includes('scene.lua') && get('note').textContent.includes('640 x 360')"
before=$(now "get('picture').src")
save 0.7
check "a save replaces it" becomes "get('picture').src !== '$before' && document.images[0].naturalWidth === 640"
check "no error covers it" becomes "get('error').hidden"
save 0.7 "local x = = 1"
check "an error covers the picture and says where" becomes "!get('error').hidden && get('error').textContent.includes('scene.lua:3: unexpected symbol')"
check "the last good one stays" becomes "document.images[0].naturalWidth === 640"
save 0.7 'error "<b id=hacked>"'
check "an error is text, not markup" becomes "get('error').textContent.includes('<b id=hacked>') && !get('hacked')"
save 0.7 "local bright = glint.material { diffuse = 2 }"
check "an error goes with the next good save" becomes "get('error').hidden && !get('note').textContent.includes('last good')"
check "a warning stands below" becomes "!get('warnings').hidden && get('warnings').textContent.includes('diffuse above 1')"
save 0.6
check "and goes" becomes "get('warnings').hidden"
check "the error goes" becomes "get('error').hidden"

check "a slider for a number with limits" becomes "document.querySelector('[name=shade]').type === 'range' && document.querySelector('[name=shade]').value === '0.6'"
check "a choice for words" becomes "document.querySelector('[name=model]').tagName === 'SELECT'"
before=$(now "get('picture').src")
run "{ const s = document.querySelector('[name=shade]'); s.value = 0.9; s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change')); }"
check "the slider renders" becomes "get('picture').src !== '$before' && state.params.find(p => p.name === 'shade').value === 0.9"
before=$(now "get('picture').src")
run "order('set', 'shade=7')" # which the slider itself does not let through
check "a parameter out of range is refused with the reason" becomes "get('note').textContent.startsWith('shade: number 0 .. 1 expected, got ')"
check "and the picture stays" becomes "get('error').hidden && get('picture').src === '$before' && document.images[0].naturalWidth === 640"
check "whose controls stay" becomes "document.querySelector('[name=shade]').type === 'range' && document.querySelector('[name=model]')"
run "{ const s = document.querySelector('[name=shade]'); s.value = 0.3; s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change')); }"
check "the slider puts it right" becomes "get('error').hidden && get('picture').src !== '$before' && state.params.find(p => p.name === 'shade').value === 0.3"
before=$(now "get('picture').src")
run "fetch('set', { method: 'POST', body: 'shadow=1' }).then(r => document.title = r.status)"
check "a name that is no parameter is refused" becomes "document.title === '404'"
check "and changes nothing" becomes "get('error').hidden && get('picture').src === '$before'"
run "get('reset').click()"
check "reset puts it back" becomes "document.querySelector('[name=shade]').value === '0.6'"
run "{ const s = get('slider'); s.value = 7; s.dispatchEvent(new Event('input')); }"
check "frames scrub" becomes "get('frame').textContent === 'frame 7 of 12' && state.frame === 7"
# A drag of a hundred steps ends at its last value, and no command is lost.
run "for (let i = 1; i <= 100; i++) { const s = document.querySelector('[name=shade]'); s.value = i / 100 * 0.8; s.dispatchEvent(new Event('input')); }"
check "a drag ends where it ended" becomes "state.params.find(p => p.name === 'shade').value === 0.8"
if [ -n "${SHOT:-}" ]; then # saves a screenshot of the page, for people
    send Page.captureScreenshot '{}' "$session" && field data | base64 -d >"$SHOT"
fi
exit $bad
