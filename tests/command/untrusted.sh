#!/usr/bin/env bash
# --untrusted: attacks by hostile scripts, and their outcome.
. tests/command/prelude.sh
export ASAN_OPTIONS=${ASAN_OPTIONS:-}:detect_leaks=0 # the leak detector traces processes
cd "$work" || exit 1
seconds=20

# script LINE...: writes scene.lua, which runs the lines and then renders a small picture
script() {
    {
        printf '%s\n' "$@"
        echo 'local glint = require "glint"'
        echo 'local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1,'
        echo '  glint.sphere { center = { 0, 0, 0 }, radius = 2 } }'
        echo 'image = scene:render { width = 16, height = 16, output = name }'
        echo 'if after then after() end'
    } >scene.lua
}
run() { timeout 30 "$glint" scene.lua --untrusted="$seconds" "$@" -q >out 2>err </dev/null; }
# passes NAME: the script must succeed
passes() {
    run -o none
    result $? "$1"
}
# refused NAME PATTERN OPTION...: expects exit code 2 with one line that matches, and no new file
refused() {
    local name=$1 pattern=$2 before
    shift 2
    before=$(find . -type f | sort)
    run "$@"
    [ $? -eq 2 ] && grep -q "^glint: error: .*$pattern" err && [ "$(find . -type f | sort)" = "$before" ]
    result $? "$name"
}

script
run -o pictures/deep/a.png
if grep -q 'without libseccomp' err; then
    echo "1..0 # SKIP glint was built without libseccomp"
    exit 77
fi
[ $? -eq 0 ] && [ -s pictures/deep/a.png ]
result $? "a picture, in a folder that is made"
"$glint" scene.lua -o trusted.png -q && cmp -s trusted.png pictures/deep/a.png
result $? "the same bytes as of a trusted run"
script 'name = "plain.png"'
(cd pictures && timeout 30 "$glint" --untrusted ../scene.lua -q) >out 2>err && [ -s pictures/plain.png ]
result $? "without -o: into the working directory"
timeout 30 "$glint" explain scene.lua --untrusted >out 2>err && grep -q cast out
result $? "explain"

# ---- Available and missing functions ----

script 'for _, gone in ipairs { "io", "debug", "package", "dofile", "loadfile", "xpcall", "collectgarbage", "warn" } do' \
    'assert(_G[gone] == nil, gone) end' \
    'for _, gone in ipairs { "execute", "exit", "getenv", "remove", "rename", "setlocale", "tmpname" } do' \
    'assert(os[gone] == nil, gone) end' \
    'assert(string.dump == nil and ("").dump == nil)' \
    'assert(getmetatable("") == false and not pcall(setmetatable, "", {}))' \
    'assert(("x"):rep(3) == "xxx" and math.pi and table.concat and coroutine.wrap and utf8.char and os.time())'
passes "the names that a script has"
script 'assert(not load("\27Lua") and not load("\27Lua", "x", "b") and load("return 1", "x", "b")() == 1)' \
    'assert(load("return y", "x", "t", { y = 7 })() == 7 and load("return glint")() == nil)' \
    'assert(load(coroutine.wrap(function() coroutine.yield("return ") coroutine.yield("5") end))() == 5)'
passes "load takes text alone"
script 'assert(not pcall(setmetatable, {}, { __gc = true }) and not pcall(setmetatable, {}, { __gc = function() end }))' \
    'local late = setmetatable({}, {}); getmetatable(late).__gc = function() while true do end end; late = nil' \
    'local locked = setmetatable({}, { __metatable = 1 }); assert(not pcall(setmetatable, locked, nil))'
passes "no finalizers"
script 'assert(not pcall(require, "io") and not pcall(require, "lfs") and require "glint" == require "glint")'
passes "no modules"
script 'assert(getmetatable(require "glint".material {}) ~= nil and type(getmetatable(require "glint".material {})) ~= "table")'
passes "no metatables of the engine"

# ---- Time and memory ----

seconds=1 late='the script took longer than 1 s'
script 'while true do end'
refused "an endless loop" "$late" -o a.png
script 'while true do pcall(function() while true do end end) end'
refused "an endless loop that catches its errors" "$late" -o a.png
script 'while true do pcall(coroutine.wrap(function() for i = 1, 4e5 do end end)) end'
refused "coroutines that are each short" "$late" -o a.png
script 'while true do coroutine.wrap(function() for i = 1, 100 do end end)() end'
refused "coroutines that no hook sees" "$late" -o a.png
script 'local _ = #require "glint".pattern(function(p) while true do pcall(function() return p.x + 1 end) end end)'
refused "a traced function without an end" "$late" -o a.png
script 'local kept, glint = {}, require "glint"' \
    'local _ = #glint.pattern(function(p) for i = 1, 1e9 do pcall(function() kept[i] = glint.noise(p + i) end) end end)'
refused "a traced function that only grows" "$late" -o a.png
# Inside C no hook notices the end of the time: the process is killed.
slack_ms=1000
ldd "$glint" | grep -qE 'lib[at]san' && slack_ms=4000
# in_time MS COMMAND...: runs the command and sets `took` to its milliseconds. The machine may stall for a second, so a
# late run is repeated: three late runs in a row are the program's fault.
in_time() {
    local most_ms=$1 begun
    shift
    for _ in 1 2 3; do
        begun=$(date +%s%N)
        "$@"
        took=$((($(date +%s%N) - begun) / 1000000))
        [ $took -gt "$most_ms" ] || return 0
    done
    return 1
}
stopped() { # NAME [OPTION...]
    local name=$1
    shift
    in_time $((1000 * seconds + slack_ms)) refused "$name" "$late" "$@"
    result $? "$name: after $took ms"
}
endless='setmetatable({}, { __len = function() return 2147483646 end, __index = rawlen, __newindex = rawlen })'
for line in 'string.rep("a", 40):find(string.rep("a-", 40) .. "b")' 'string.rep("a", 40):gsub(string.rep("a*", 40) .. "b", "")' \
    '("x"):rep(3e7):find(".-.-.-b")' '("").rep("", 1 << 60)' 'table.move({}, 1, 1 << 60, 2, {})' "table.insert($endless, 1, 0)" \
    "table.sort($endless)" 'pcall(pcall, string.rep, "", 1 << 60)' 'coroutine.wrap(string.rep)("", 1 << 60)'; do
    script "$line"
    stopped "$line" -o a.png
done
seconds=20
script 'local kilobyte = ("x"):rep(1000)' \
    'table.concat(setmetatable({}, { __len = function() return 1 << 31 end, __index = function() return kilobyte end }))'
refused "table.concat of what has no end" "not enough memory" -o a.png
script "require 'glint'.mesh { vertices = $endless, faces = $endless }"
refused "a mesh of what has no end" "mesh.vertices: .* expected, got 0" -o a.png
script 'error(setmetatable({}, { __tostring = function() while true do end end }))'
refused "an error that is spelt for ever" "(error object is a table value)" -o a.png
script 'local t = {}; for i = 1, 1e9 do t[i] = ("x"):rep(1e5) .. i end'
refused "memory" "not enough memory" -o a.png
script 'local function grow() local t = "x" while true do t = t .. t end end' \
    'do return require "glint".animation { scene = require "glint".scene {}, frame = grow } end'
refused "memory in a frame" "not enough memory" -o a.png
script 'local t = {}; for i = 1, 1e9 do t[i] = require "glint".array(100000) end'
refused "memory of arrays" "not enough memory" -o a.png
script 'local a = require "glint".array(1 << 20); while true do a = require "glint".array { a, a, a }.x + a * 2; a = require "glint"._join({ a, a }, 1) end'
refused "an array that doubles" "not enough memory" -o a.png
script 'require "glint".array(1 << 59)'
refused "an array larger than memory" "memory" -o a.png
script 'local t = { ("x"):rep(6e7) }; t[2] = ("y"):rep(6e7)'
refused "memory in two strings" "not enough memory" -o a.png
if [ $slack_ms -eq 1000 ]; then # a sanitizer maps terabytes, so its builds have no memory limit
    script
    refused "memory for a picture" "out of memory" -o a.png --size 40000x40000
fi
if [ $slack_ms -eq 1000 ] && [ -x /usr/bin/time ]; then
    script # renders no picture: measures the memory of the run itself
    /usr/bin/time -o used -f %M "$glint" --untrusted scene.lua -o none -q >out 2>err
    most=$((65536 * 110 / 100 + $(tail -n 1 used)))
    for line in 'for i = 1, 1e9 do t[i] = {} end' 'for i = 1, 1e9 do t[i] = "s" .. i end' 'for i = 1, 1e9 do t = { t } end' \
        'for i = 1, 1e9 do t[i % 1000] = ("x"):rep(math.random(1, 1e5)) t[1000 + i // 50] = ("y"):rep(3000) end'; do
        script "local t = {} $line"
        /usr/bin/time -o used -f %M "$glint" --untrusted scene.lua -o none -q >out 2>err
        [ "$(tail -n 1 used)" -le $most ] && grep -q 'not enough memory' err
        result $? "64 MiB of Lua within 10 %: $(tail -n 1 used) of $most KiB: $line"
    done
else
    skip "memory is measured without a sanitizer, by /usr/bin/time"
fi
if [ $slack_ms -eq 1000 ] && [ -x /usr/bin/time ]; then # as RLIMIT_AS counts it, so that the limit may be a tenth of the real one
    limit=$((200 << 10))
    for line in 'for i = 1, 1e9 do pcall(function() t[i] = glint.sphere_mesh { center = { i, 0, 0 }, radius = 1, segments = 300 } end) end' \
        'local d = ("\\0\\0\\0\\63"):rep(8e5) for i = 1, 1e9 do t[i] = glint.spheres { data = d, format = "f32" } end' \
        'for i = 1, 1e9 do ball.radius = 1 + i * 1e-4 t[i] = scene:render { width = 700, height = 700 } end' \
        'scene:render { width = 30000, height = 30000 }'; do
        {
            echo 'local glint, t = require "glint", {} local ball = glint.sphere { center = { 0, 0, 0 }, radius = 2 }'
            echo 'local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1, ball }'
            echo "$line"
        } >scene.lua
        (ulimit -v $limit && exec /usr/bin/time -q -o used -f %M "$glint" --untrusted=3 scene.lua -o none -q) >out 2>err
        code=$?
        case $line in *pcall*) said="the script took longer" ;; *) said="out of memory" ;; esac
        [ $code -eq 2 ] && grep -q "$said" err && [ "$(tail -n 1 used)" -le $limit ]
        result $? "memory of the process, $(tail -n 1 used) of $limit KiB, $code, $(tail -n 1 err): $line"
    done
    script
    for threads in 256 1024; do
        run -o none --threads $threads
        result $? "$threads threads have room beneath the limit: $(cat err)"
    done
fi
script 'local function deep(n) return 1 + deep(n + 1) end deep(1)'
refused "a deep stack" "\(stack overflow\|not enough memory\)" -o a.png # both limits are close to each other
script 'local function deep() return ("x"):gsub("x", deep) end deep()'
refused "a deep stack of C" "stack overflow" -o a.png

# ---- Files ----

mkdir -p inside
echo kept >outside.png
ln -s ../outside.png inside/link.png
for name in ../a.png /tmp/a.png .hidden.png a/b.png 'a\tb.png' "$(printf 'a%.0s' {1..300}).png" 'a.png\0.txt'; do
    script "name = \"$name\""
    refused "a picture called ${name:0:20}" "expected, got" # without -o, into the working directory
    script "function after() image:save(\"$name\") end"
    refused "image:save of ${name:0:20}" "save.path: .*expected, got" -o none
done
script 'function after() assert(image:save("saved.png")) end'
run -o inside/a.png && [ -s inside/saved.png ] && [ ! -e saved.png ]
result $? "image:save goes where -o goes"
script 'function after() local good, why = image:save("link.png"); assert(not good, why) end'
run -o inside/b.png && [ "$(cat outside.png)" = kept ]
result $? "a symbolic link leads nowhere"
script 'local good, why = pcall(require "glint".mesh, { file = "/etc/passwd" }); assert(not good and why:find "reads no files", why)'
passes "no file is read"
seconds=1
mkfifo pipe.png pipe.lua
script 'name = "pipe.png"'
stopped "a picture into a pipe that is not read"
seconds=20
script 'function after() image:save("pipe.png") end'
refused "image:save into a pipe" "save.path: regular file (not a pipe or device) expected" -o a.png
timeout 5 "$glint" --untrusted pipe.lua -o none >out 2>err </dev/null
[ $? -eq 2 ] && grep -q "a script expected, got a pipe" err
result $? "a script that is a pipe"
script
refused "a film" "only pictures can be written; expected" -o a.mp4
refused "a device" "expected a regular file" -o /dev/null
refused "a folder with a number" "expected a folder without a frame number" -o '%d/a.png'
run -o /proc/nowhere/a.png
[ $? -eq 1 ] && grep -q '^glint: error: --untrusted: /proc/nowhere: ' err
result $? "a folder that cannot be made"
timeout 30 "$glint" scene.lua --untrusted=0 -o none >out 2>err </dev/null
[ $? -eq 2 ] && grep -q -e "--untrusted: whole number 1 .. 1000000 expected, got '0'" err
result $? "seconds"

# ---- Signals ----

script 'while true do end'
for signal in INT TERM; do
    "$glint" --untrusted scene.lua -o a.png >out 2>err </dev/null &
    pid=$!
    sleep 0.5
    kill -s $signal $pid # a background job of a shell ignores INT, so the signal is sent to the process itself
    [ $signal = INT ] && sleep 0.3 && kill -s TERM $pid 2>/dev/null
    wait $pid
    [ $? -ge 130 ] && ! pgrep -P $pid >/dev/null
    result $? "SIG$signal ends it"
done
script '("").rep("", 1 << 60)' # which hears no signal
signalled() { # SIGNAL; code: how it ended
    "$glint" --untrusted scene.lua -o a.png >out 2>err </dev/null &
    pid=$!
    sleep 0.5
    kill -s "$1" $pid
    { wait $pid; } 2>bash.err # the shell reports the signal here
    code=$?
}
for signal in TERM HUP; do
    in_time $((500 + slack_ms)) signalled $signal && [ $code -eq $((128 + $(kill -l $signal))) ] && [ ! -s err ]
    result $? "one SIG$signal in C ends it with $code after $((took - 500)) ms"
done
left=inside/.0001.png.$(uname -n).$pid.0.tmp # a hidden file of a process that has ended
touch "$left"
seconds=1
run -o inside/c.png
[ $? -eq 2 ] && grep -q "$late" err && [ ! -e "$left" ]
result $? "what a killed script left half written is removed"

# ---- Output files ----

mkdir much
cat >scene.lua <<'LUA'
local glint = require "glint"
local ball = glint.sphere { center = { 0, 0, 0 }, radius = 2 }
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1, ball }
return glint.animation { scene = scene, frames = 100000, width = 64, height = 64, frame = function(t) ball.radius = 1 + t end }
LUA
(ulimit -f 200 && exec "$glint" --untrusted=20 scene.lua -o much/%06d.pfm -q) >out 2>err </dev/null
[ $? -eq 2 ] && grep -q "the script wrote more than 819200 bytes" err && [ "$(find much | wc -l)" -lt 50000 ]
result $? "bytes in all: four times what one file may have"
rm -r much && mkdir much # each picture has some 70 bytes and takes a block of the disk
(ulimit -f 200 && exec "$glint" --untrusted=20 scene.lua -o much/%06d.png --size 4x4 -q) >out 2>err </dev/null
[ $? -eq 2 ] && grep -q "the script wrote more than 819200 bytes" err && [ "$(find much -type f | wc -l)" -lt 1000 ]
result $? "many small files: $(find much -type f | wc -l), $(cat err)"
rm -r much && mkdir much # pictures of 1.2 MB, written as fast as possible
(ulimit -f 20000 && exec "$glint" --untrusted=60 scene.lua -o much/%06d.pfm --size 320x320 -q) >out 2>err </dev/null
[ $? -eq 2 ] && grep -q "the script wrote more than 81920000 bytes" err
result $? "bytes in all: $(cat err)"
most=$((81920000 / 100 * 110)) there=$(du -sb much | cut -f 1)
[ "$there" -le $most ]
result $? "bytes in all, within a tenth: $there of $most"
rm -r much
(ulimit -f 20 && exec "$glint" --untrusted=20 scene.lua -o much/one.pfm -f 1 -q) >out 2>err </dev/null
[ $? -eq 1 ] && grep -q "File too large" err
result $? "bytes of a file"

# ---- Names that are options, and messages that control a terminal ----

for name in -rf.png -x --checkpoint-action=exec=sh.png; do
    printf '%s\n' 'local glint = require "glint"' 'local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } } }' \
        "scene:render { width = 8, height = 8, output = '$name' }" >dash.lua
    "$glint" --untrusted dash.lua -q >out 2>err
    [ $? -eq 2 ] && grep -q "no leading '\.' or '-'.* expected, got '$name'" err && [ ! -e "./$name" ]
    result $? "a picture named $name"
    printf '%s\n' 'local glint = require "glint"' 'local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } } }' \
        "scene:render { width = 8, height = 8, output = 'none' }:save('$name')" >dash.lua
    "$glint" --untrusted dash.lua -q >out 2>err
    [ $? -eq 2 ] && grep -q "no leading '\.' or '-'.* expected, got string \"$name\"" err && [ ! -e "./$name" ]
    result $? "an image saved as $name"
done

printf -- '-- Help \033]52;c;aGVsbG8=\007 of it\n' >control.lua
cat >>control.lua <<'END'
local glint = require "glint"
local P = glint.params { size = { 1, doc = "a\27[31m b\7" } }
print("A\27]0;pwned\7\27[31mred\127", "caf\u{e9} \u{9b}31m \u{202e}x", "\x9b", 1, nil)
if P.size > 1 then error("B\27]52;c;aGVsbG8=\7\nglint: error: fake\rglint: error: fake") end
glint.scene { glint.sphere { center = { 0, 0, 0 }, radius = 1, name = "x\27[2J" } }:render { width = 8, height = 8, output = "ab.png" }
END
raw() { LC_ALL=C grep -qP '[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80\xae' "$@"; } # bytes that a terminal obeys
for options in "--untrusted" "--untrusted --set size=2" "--untrusted --help" "--help" "--set size=2" "--untrusted -o none"; do
    # shellcheck disable=SC2086
    "$glint" control.lua $options >out 2>err
    case $options in --set* | --help) files=err ;; *) files="out err" ;; esac # a trusted script may write what it likes
    # shellcheck disable=SC2086
    ! raw $files
    result $? "no control characters with $options"
done
"$glint" control.lua --untrusted --set size=2 >out 2>err
grep -qF 'A\x1b]0;pwned\x07\x1b[31mred\x7f	café \u009b31m \u202ex	\x9b	1	nil' out
result $? "they are shown escaped"
grep -qF 'B\x1b]52;c;aGVsbG8=\x07' err && [ "$(grep -c '^glint: error' err)" -eq 1 ]
result $? "one error, whatever it says"
"$glint" explain control.lua --untrusted >out 2>err && ! raw out err
result $? "no control characters in a plan"
"$glint" $'none\e[31m.lua' >out 2>err
[ $? -eq 2 ] && grep -qF 'none\x1b[31m.lua' err
result $? "names of files are shown escaped"
printf 'return require("glint").scene { camera = require("glint").camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } } }\n' >empty.lua
"$glint" empty.lua -o $'e\e[2J.png' --size 4x4 >out 2>err && "$glint" compare $'e\e[2J.png' $'e\e[2J.png' >out 2>>err && ! raw out err
result $? "names of pictures are shown escaped"

# ---- The same pictures as without the sandbox ----

mkdir same
for path in "$root"/scripts/*.lua; do
    grep -qE 'require *[("]* *"(glint\.|gr)|io\.|file *=|dofile|read_image' "$path" && continue
    name=$(basename "$path" .lua)
    "$glint" "$path" -f 1 --size 24x16 -q -o "same/$name.open.png" >out 2>err || continue
    "$glint" "$path" -f 1 --size 24x16 -q --untrusted=60 -o "same/$name.closed.png" >out 2>err
    for open in same/"$name".open*; do
        cmp -s "$open" "${open/.open/.closed}"
        result $? "$name: $(basename "$open")"
    done
done
# So do the examples of the pages, unless they need other files or folders, or are parts of a script.
mkdir blocks
for page in $(cd "$root" && ls README.md bindings/README.md bindings/docs/*.md scripts/README.md scripts/particles.md); do
    (cd "$root" && awk -v to="$work/blocks/${page//\//_}" '
        /^```lua$/ { name = sprintf("%s_%02d.lua", to, ++blocks); next }
        /^```/ { if (name) close(name); name = ""; next }
        name { print > name }' $page)
done
compared=0
for path in blocks/*.lua; do
    grep -qE 'require *[("]* *"(glint\.|gr)|io\.|file *=|dofile|read_image|output = "[^"]*/' "$path" && continue
    name=$(basename "$path" .lua)
    mkdir open closed
    (cd open && "$glint" "../$path" -f 1 --size 64x36 --quiet -o picture.png) >out 2>open.err || { rm -r open closed; continue; }
    (cd closed && "$glint" "../$path" -f 1 --size 64x36 --quiet -o picture.png --untrusted=60) >out 2>closed.err
    result $? "the example $name: ends as without --untrusted: $(cat closed.err)"
    diff -r open closed >out
    result $? "the example $name: the same files"
    compared=$((compared + $(find open -type f | wc -l)))
    rm -r open closed
done
[ $compared -ge 10 ]
result $? "examples of the pages: $compared files compared"
printf '%s\n' 'local glint = require "glint"' 'return glint.scene { ambient = 1, glint.sphere { center = { 0, 0, 0 }, radius = 1 } }' >plain.lua
"$glint" plain.lua -o open.png --size 16x16 2>open.err && "$glint" plain.lua --untrusted -o closed.png --size 16x16 2>closed.err &&
    cmp open.png closed.png && grep -q "the scene has no camera" closed.err
result $? "a scene without a camera"
printf '%s\n' 'local glint = require "glint"' 'return glint.chart { x = { 0, 1 }, y = { 0, 1 } }' >chart.lua
"$glint" chart.lua -o open.png --size 160x120 -q 2>open.err
code=$?
"$glint" chart.lua --untrusted -o closed.png --size 160x120 -q 2>closed.err
[ $? -eq $code ] && cmp open.err closed.err && { [ $code -ne 0 ] || cmp open.png closed.png; }
result $? "a chart alone"

# ---- The sandbox, attacked by a process that runs arbitrary code ----

mkdir walls
(cd walls && "$root/$build/tests/command/walls") >attacks 2>&1
result $? "the walls stand: $(grep -v '^ok' attacks)"
passed=$((passed + $(grep -c '^ok' attacks)))
[ -z "$(find . -name '*.tmp')" ]
result $? "nothing half written is left"
totals
