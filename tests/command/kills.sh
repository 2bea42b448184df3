#!/usr/bin/env bash
# A killed run leaves hidden files. The next run that writes into the folder must remove them, and nothing else.
# KILLS=300 sets the number of kills. Prints TAP.
set -u
glint=${GLINT:-$PWD/${BUILD:-build}/glint}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
bad=0 kills=${KILLS:-60}
export TMPDIR=$work/tmp
mkdir tmp

result() { # STATUS NAME
    if [ "$1" -eq 0 ]; then echo "ok - $2"; else
        echo "not ok - $2"
        bad=1
    fi
}
cat >scene.lua <<'LUA'
local glint = require "glint"
local lamp = glint.point_light { position = { 3, 8, 4 } }
local scene = glint.scene { camera = glint.camera { eye = { 0, 2, 9 }, at = { 0, 0, 0 } }, ambient = 0.1, lamp,
  glint.sphere { center = { 0, 0, 0 }, radius = 2 } }
return glint.animation { scene = scene, frames = 6, width = 320, height = 240, frame = function(t) lamp.x = 9 * t end }
LUA
"$glint" scene.lua -o 'f_%d.png' -q || exit 1

hidden() { find . -name '.*.tmp' -o -path './tmp/glint*'; }

# killed SIGNAL COMMAND...: ends the command at a random time in its first 60 ms
killed() {
    local signal=$1 pid
    shift
    "$glint" "$@" >/dev/null 2>&1 </dev/null &
    pid=$!
    sleep "0.0$((RANDOM % 60 + 10))"
    kill -s "$signal" $pid 2>/dev/null
    wait $pid 2>/dev/null
}
left=0
mkdir out
for ((i = 0; i < kills; i++)); do
    case $((i % 5)) in
    0) killed KILL scene.lua -o 'out/g_%d.png' --force -q ;;
    1) killed KILL sheet f_1.png f_2.png f_3.png f_4.png f_5.png f_6.png -o out/sheet.png -q ;;
    2) killed KILL assemble f_1.png f_2.png f_3.png f_4.png f_5.png f_6.png -o out/film.apng -q ;;
    3) killed KILL reproduce f_3.png scene.lua ;;
    4) killed KILL sheet f_1.png f_2.png f_3.png -o out/sheet.html -q ;;
    esac
    left=$((left + $(hidden | wc -l)))
    "$glint" scene.lua -f 1 -o out/next.png --force -q && "$glint" reproduce f_1.png scene.lua >/dev/null || bad=1
    if [ -n "$(hidden)" ]; then
        echo "# left after the next run:" "$(hidden)"
        bad=1
    fi
done 2>/dev/null
result $bad "$kills kills left $left hidden files, and the next run none"

# Other files stay: files of a running process, recent files of another host, and files with other names.
host=$(uname -n)
sleep 60 &
alive=$!
dead=$(sh -c 'echo $$')
touch "out/.a.png.$host.$alive.0.tmp" "out/.a.png.elsewhere.$dead.0.tmp" "out/.a.png.$host.x.0.tmp" "out/.a.$host.tmp"
touch -d '2 days ago' "out/.old.png.elsewhere.$dead.3.tmp"
touch "out/.b.png.$host.$dead.12.tmp"
"$glint" scene.lua -f 1 -o out/next.png --force -q
kill $alive
[ "$(find out -name '.*' | wc -l)" -eq 4 ] && [ ! -e "out/.b.png.$host.$dead.12.tmp" ] && [ ! -e "out/.old.png.elsewhere.$dead.3.tmp" ]
result $? "files of living processes, of other hosts and of other names stay"
rm -f out/.*.tmp

# A run with nothing left to write also removes them, and the folder of a film's frames.
"$glint" scene.lua -o 'kept/k_%d.png' -q
mkdir f.apng.frames
cp kept/k_1.png "kept/.k_1.png.$host.$dead.0.tmp"
"$glint" scene.lua -o 'kept/k_%d.png' --json 2>err | grep -q '"kept":6' && [ -z "$(hidden)" ]
result $? "a run that finds all of its pictures"
for ((i = 1; i <= 6; i++)); do cp "kept/k_$i.png" "f.apng.frames/000$i.png"; done
cp kept/k_1.png "f.apng.frames/.0001.png.$host.$dead.7.tmp"
"$glint" scene.lua -o f.apng --json 2>err | grep -q '"kept":6' && [ -e f.apng ] && [ ! -e f.apng.frames ]
result $? "a film whose frames are all there"

# Catchable signals leave nothing behind at any time.
bad_before=$bad
for ((i = 0; i < kills; i++)); do
    signal=TERM
    [ $((i % 3)) -eq 0 ] && signal=HUP
    case $((i % 4)) in
    0) killed $signal sheet f_1.png f_2.png f_3.png f_4.png f_5.png f_6.png -o out/sheet.png -q ;;
    1) killed $signal assemble f_1.png f_2.png f_3.png f_4.png f_5.png f_6.png -o out/film.apng -q ;;
    2) killed $signal reproduce f_3.png scene.lua ;;
    3) killed $signal sheet f_1.png f_2.png f_3.png -o out/sheet.html -q ;;
    esac
    if [ -n "$(hidden)" ]; then
        echo "# left by SIG$signal, command $((i % 4)):" "$(hidden)"
        bad=1
        rm -rf tmp/glint* out/.*.tmp
    fi
done 2>/dev/null
result $((bad - bad_before)) "$kills signals left nothing"
exit $bad
