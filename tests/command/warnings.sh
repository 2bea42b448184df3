#!/usr/bin/env bash
# Warnings: each appears only where it applies, and only once; also as an event, and as an error on request.
. tests/command/prelude.sh
cd "$work" || exit 1

run() { "$glint" "$@" -t 1 -o none --quiet >out 2>err </dev/null; }

# scene LINE...: writes a script with a camera that looks at the origin, the lines, and `objects` to render
scene() {
    {
        echo 'local glint = require "glint"'
        echo 'local lamp = glint.point_light { position = { 0, 8, 4 }, name = "lamp" }'
        printf '%s\n' "$@"
        echo 'local view = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }'
        echo 'local scene = glint.scene { camera = view, ambient = 0.1, background = 0.1, lamp, table.unpack(objects or {}) }'
        echo 'return glint.animation { scene = scene, frames = 4, width = 32, height = 18, frame = frame or function() end }'
    } >scene.lua
}
# warns NAME PATTERN OPTION...: expects success with one warning, which matches
warns() {
    local name=$1 pattern=$2
    shift 2
    run scene.lua "$@" && [ "$(wc -l <err)" -eq 1 ] && grep -q "^glint: warning: $pattern" err
    result $? "$name"
}
# silent NAME OPTION...: expects no warnings
silent() {
    local name=$1
    shift
    run scene.lua "$@" && [ ! -s err ]
    result $? "$name"
}

# ---- Shininess without specular ----

scene 'local m = glint.material { shininess = 64 }'
warns "shininess without specular" 'scene.lua:3: material.shininess has no effect while specular is black; set specular, too'
scene 'for i = 1, 3 do' 'glint.material { shininess = i } end'
warns "once for many" 'scene.lua:4: material.shininess'
scene 'local m = glint.material { shininess = 64, specular = 0 }'
silent "a specular that is black on purpose"
scene 'local m = glint.material { shininess = 64 }; m.specular = 0.5; m.specular = 0'
silent "a specular that comes later"
scene 'local m = glint.material { shininess = 64 }' 'function frame(t) m.specular = t end'
silent "a specular that comes in a frame"
scene 'local m = glint.material { shininess = 64, model = "lambert" }'
silent "a model without highlights"

# ---- A shutter without motion ----

still='local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 }, shutter = 0.5 }, ambient = 1, glint.sphere { center = { 0, 0, 0 }, radius = 2 } }'
for job in 'scene' 'glint.sweep { scene = scene, over = { { scene.camera, "fov", { 40, 50 } } } }' \
    'scene:render { width = 9, height = 9 }'; do
    printf '%s\n' 'local glint = require "glint"' "$still" "return $job" >scene.lua
    case $job in scene:*) sed -i 's/^return //' scene.lua ;; esac
    warns "an open shutter: $job" 'camera.shutter: nothing moves while it is open; move objects in the frame function of a glint.animation'
done

# ---- Invisible text ----

ball='glint.sphere { center = { 0, 0, 0 }, radius = 2 }'
label() { scene "objects = { $ball, glint.label { $1 } }"; }
label 'text = "t", size = 5'
silent "a label that fits"
label 'text = "somewhere", position = { 500, 0 }'
warns "a label outside" "label 'somewhere': it lies outside the picture$"
label 'text = "gone", position = { 0, -90 }, name = "title"'
warns "a label by its name" "label 'title': it lies outside the picture$"
label 'text = "Donaudampfschifffahrt", size = 10'
warns "a word that is wider than the picture" "label 'Donaudampfschifffahrt': 'Donaudampfschifffahrt' is [0-9]* pixels wide, the picture 32; use a smaller size or a wider picture to show all of it$"
label 'text = "ab", position = { 30, 0 }, size = 5'
warns "a label that is cut" "label 'ab': it extends [0-9]* pixels beyond the border of the picture$"
label 'text = "x\u{10ffff}", size = 5'
warns "a letter that the font lacks" "label 'x.*': the font has no letter '.*' (U+10FFFF), so a box is drawn; set GLINT_FONT to the file of another font$"
scene 'objects = { glint.sphere { center = { 0, 0, 0 }, radius = 2 }, glint.colorbar { map = "magma", low = 0, high = 1, position = { 900, 0 } } }'
warns "a bar outside" "colorbar: it lies outside the picture$"

# ---- A light inside a closed sphere ----

inside='objects = { glint.sphere { center = { 0, 0, 0 }, radius = 2, name = "ball" } }'
scene "$inside" 'lamp.position = { 0, 1, 0 }'
warns "a light inside a sphere" "frame 1: a point_light 'lamp' is inside sphere 'ball', which lets none of its light out" -f 1
scene "$inside" 'lamp.position = { 0, 1, 0 }; lamp.shadows = false'
silent "its light goes through without shadows"
scene "$inside" 'lamp.position = { 0, 2, 0 }'
silent "on the surface is not inside"
scene 'objects = { glint.sphere { center = { 0, 0, 0 }, radius = 20 } }'
silent "with the eye inside, too, it is a room"
scene "$inside" 'lamp.position = { 0, 1, 0 }; objects[1].material = glint.material { opacity = glint.pattern(function(p) return p.x end) }'
silent "a sphere with holes lets light out"
scene "$inside" 'lamp.position = { 0, 1, 0 }; objects[1].material = glint.material { opacity = 0.6 }'
silent "a translucent sphere does, too"
scene "$inside" 'function frame(t, n) lamp.position = { 0, n == 3 and 1 or 9, 0 } end'
warns "in a frame of many" "frame 3: a point_light 'lamp'"

scene "$inside" 'lamp.position = { 0, 1, 0 }'
warns "once for all frames" "frame 1: a point_light 'lamp' is inside"
scene "$inside" 'function frame(t, n) objects[1].name = "ball " .. n; lamp.position = { 0, 1, 0 } end'
sed -i 's/frames = 4/frames = 120/' scene.lua
run scene.lua && [ "$(wc -l <err)" -eq 101 ] && tail -n 1 err | grep -q 'no more are shown'
result $? "a hundred warnings, and no more"

# ---- A lens ----

scene "objects = { glint.sphere { center = { 0, 0, 0 }, radius = 1 } }" 'function frame() view.aperture = 0.2 end'
sed -i 's/^local view/view/' scene.lua
warns "a lens and one sample" 'one sample a pixel shows the blur of a lens as a pattern of dots; set samples = 16'
silent "a lens and several" --samples 2
silent "a lens and one sample, by the command line" --samples 1
scene "objects = { glint.sphere { center = { 0, 0, 0 }, radius = 1 } }" 'function frame() view.focus = 8 end'
sed -i 's/^local view/view/' scene.lua
warns "a focus without an aperture" 'camera.focus and camera.blades change nothing while its aperture is 0'
scene "objects = { glint.sphere { center = { 0, 0, 0 }, radius = 1 } }" \
    'function frame(t) view.aperture, view.focus, view.blades = t, 8, 5 end'
sed -i 's/^local view/view/' scene.lua
silent "an aperture that opens" --samples 4
scene 'objects = { glint.sphere { center = { 4.5, 0, 0 }, radius = 0.1 } }' 'function frame() view.aperture = 1 view.focus = 3 end'
sed -i 's/^local view/view/' scene.lua
silent "what is outside the view may be blurred into it" --samples 4

# ---- Outside the view ----

scene 'objects = { glint.sphere { center = { 0, 0, 20 }, radius = 1, name = "ball" } }'
warns "behind the eye" "sphere 'ball' is outside the view in every frame, with its shadow"
silent "not when frames are chosen" -f 1
silent "nor in a shard" --shard 1/2
scene 'objects = {}; for i = 1, 3 do objects[i] = glint.sphere { center = { 30, 0, 9 + i }, radius = 1 } end'
warns "one line for many" "the sphere at {30, 0, 10} and 2 more are outside the view"
scene 'objects = { glint.sphere { center = { 0, 0, 20 }, radius = 1 } }' \
    'function frame(t, n) objects[1].center = { 0, 0, n == 4 and 0 or 20 } end'
silent "not one that comes in"
scene 'objects = { glint.sphere { center = { 0, 6, 2 }, radius = 0.5 } }'
silent "not one whose shadow falls into the view"

scene 'objects = { glint.box { min = { 30, 0, 0 }, max = { 31, 1, 1 } } }'
warns "a box" "the box at {30.5, 0.5, 0.5} is outside the view"
scene 'objects = { glint.spheres { data = { 29, 0, 0, 1, 33, 0, 0, 1 } } }'
warns "many spheres" "the set of spheres around {31, 0, 0} is outside the view"
scene 'objects = { glint.spheres { data = { 29, 0, 0, 1, -33, 0, 0, 1 } } }'
silent "not when the view is between them"
scene 'objects = { glint.mesh { vertices = { { 30, 0, 0 }, { 31, 0, 0 }, { 30, 1, 0 } }, faces = { { 1, 2, 3 } }, name = "roof" } }'
warns "a mesh" "mesh 'roof' is outside the view"
coarse='glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, name = "ball", segments ='
scene "objects = { $coarse 16 } }"
warns "a smooth mesh of few faces" "mesh 'ball': its smooth normals differ from its flat faces by up to 1[0-9] degrees"
scene "objects = { glint.group { $coarse 16 } } }"
warns "in a group" "mesh 'ball': its smooth normals differ from its flat faces"
scene "objects = { $coarse 64 } }"
silent "not one of many faces"
scene "objects = { $coarse 16, shading = \"faceted\" } }"
silent "nor one that is shaded as it is"
scene "objects = { $coarse 16 } }" 'lamp.shadows = false'
silent "nor without shadows"
scene 'objects = { glint.sphere_mesh { center = { 0, 0, 0 }, radius = 1, segments = 8, transform = glint.translate(0, 0, 20) } }'
warns "a mesh that its transform takes out" 'the mesh around {0, .*, 20} is outside the view'
scene 'objects = { glint.mesh { vertices = { { 30, 0, 0 }, { 31, 0, 0 }, { 0, 1, 0 } }, faces = { { 1, 2, 3 } } } }'
silent "not one that reaches in"
scene 'objects = { glint.group { glint.cylinder { base = { 0, 0, 0 }, top = { 0, 1, 0 }, radius = 1, name = "post" },
  transform = glint.translate(0, 0, 40) } }'
warns "in a group that is moved" "cylinder 'post' is outside the view"
scene 'local post = glint.cone { base = { 0, 0, 0 }, top = { 0, 1, 0 }, radius = 1 }
  objects = { glint.group { post, transform = glint.translate(0, 0, 40) }, glint.group { post } }'
silent "not one that another group shows"
scene 'objects = { glint.sphere { center = { 0, 0, 20 }, radius = 1, transform = glint.translate(0, 0, -20) } }'
silent "nor one that its transform brings in"
scene 'objects = { glint.sphere { center = { 0, 0, 0 }, radius = 1, transform = glint.translate(0, 0, 20), name = "ball" } }'
warns "but one that it takes out" "sphere 'ball' is outside the view"
scene 'objects = { glint.group { glint.sphere { center = { 0, 0, 20 }, radius = 1 }, glint.sphere { center = { 0, 0, 0 },
  radius = 1, material = glint.material { mirror = 0.5 } } } }'
silent "a mirror in a group may show it"
scene 'objects = { glint.group { glint.sphere { center = { 0, 0, 0 }, radius = 1, name = "ball" },
  transform = glint.rotate("y", 30) * glint.scale(2) } }' 'lamp.position = { 0, 1.5, 0 }'
warns "a light inside a sphere that a group makes larger" "frame 1: a point_light 'lamp' is inside sphere 'ball'" -f 1
scene 'objects = { glint.sphere { center = { 0, 0, 0 }, radius = 1, transform = glint.scale(3, 1, 1) } }' \
    'lamp.position = { 2, 1.5, 0 }'
silent "of an ellipsoid nothing is said"

# Random scenes, perspective and orthographic: when a warning says that a sphere is unseen, removing it must not
# change a pixel.
cat >random.lua <<'END'
local glint = require "glint"
local P = glint.params { seed = 1 }
local state = P.seed * 7919 % 65537
local function random(low, high)
  state = state * 75 % 65537
  return low + (high - low) * state / 65537
end
for _ = 1, 5 do random(0, 1) end
local at, radius = { random(-9, 9), random(-9, 9), random(-9, 9) }, random(0.2, 2)
local ball = glint.sphere { center = at, radius = radius }
if P.seed % 4 == 1 then ball = glint.box { min = at, max = { at[1] + radius, at[2] + 2 * radius, at[3] + 1 } } end
if P.seed % 4 == 2 then ball = glint.cylinder { base = at, top = { at[1] + 1, at[2] - 2, at[3] + 1 }, radius = radius } end
if P.seed % 16 == 5 then ball = glint.sphere_mesh { center = at, radius = radius, segments = 12 } end
if P.seed % 16 == 7 then ball = glint.spheres { data = { at[1], at[2], at[3], radius, at[1] + 1, at[2], at[3], radius } } end
if P.seed % 8 == 3 then ball.transform = glint.translate(1, 2, 3) * glint.rotate("z", 40) * glint.scale(1, 0.5, 0.7) end
if P.seed % 8 > 5 then ball = glint.group { ball, transform = glint.rotate("x", 70) * glint.scale(0.8) } end
local light = P.seed % 3 == 0 and glint.directional_light { direction = { random(-1, 1), random(-1, 1), random(-1, 1) } }
  or glint.point_light { position = { random(-9, 9), random(-9, 9), random(-9, 9) } }
local scene = glint.scene {
  camera = glint.camera { eye = { random(-4, 4), random(-4, 4), random(-4, 4) }, at = { 0, 0, 0 }, fov = random(10, 90),
    projection = P.seed % 2 == 0 and "orthographic" or "perspective", height = random(1, 6) },
  ambient = 0.1, light, ball,
  glint.plane { point = { 0, -5, 0 }, normal = { 0, 1, 0 } }, glint.plane { point = { 0, 0, -7 }, normal = { 0, 0, 1 } },
}
local with = scene:render { width = 32, height = 18, samples = 4 }
scene:remove(ball)
local without = scene:render { width = 32, height = 18, samples = 4 }
for y = 0, 17 do
  for x = 0, 31 do
    local a, b, c = with:pixel(x, y)
    local d, e, f = without:pixel(x, y)
    if a ~= d or b ~= e or c ~= f then print "differs" return end
  end
end
END
said=0 wrong=0 unsaid=0 step=${GLINT_CASE_STEP:-1}
for seed in $(seq 1 "$step" 100); do
    "$glint" random.lua -t 1 --quiet --set seed="$seed" >out 2>err
    if grep -q 'outside the view' err; then
        said=$((said + 1))
        ! grep -q differs out || wrong=$((wrong + 1))
    else
        grep -q differs out || unsaid=$((unsaid + 1))
    fi
done
echo "# of $((99 / step + 1)) scenes: $said said to be unseen, $wrong of them wrong, $unsaid unseen and not said"
[ $wrong -eq 0 ] && [ $((said * step)) -ge 30 ]
result $? "no warning of an unseen sphere is wrong"

# ---- Parameters ----

scene 'local P = glint.params { lost = 1 }'
warns "a parameter that is never read" 'params.lost: the script never reads this parameter'
scene 'local P = glint.params { used = 1 }' 'if P.used > 2 then print(P.used) end'
silent "one that is read"
scene 'local P = glint.params { a = 1, b = 2 }' 'for name, value in pairs(P) do assert(name and value) end'
silent "all are read by pairs"
scene 'local P = glint.params { step = "all", depth = 1 }' 'if P.step == "some" then print(P.depth) end'
silent "one that is read under a condition"
warns "unless it is set, and changes nothing" '--set depth: the script did not read this parameter with these settings' --set depth=3

# ---- Clipping ----

scene 'objects = { glint.sphere { center = { 0, 0, 0 }, radius = 3, material = glint.material { ambient = 30 } } }'
warns "a clipped picture" '[0-9]* % of the pixels are brighter than white'

# ---- Options for warnings ----

scene 'local m = glint.material { shininess = 64 }' 'local P = glint.params { lost = 1 }'
run scene.lua --json
test $? -eq 0 && [ "$(grep -c '"event":"warning","message":"' out)" -eq 2 ] && grep -q '"event":"end"' out
result $? "events"
run scene.lua --warnings=none
test $? -eq 0 -a ! -s err
result $? "none"
run scene.lua --warnings error --json
test $? -eq 2 && grep -q '"event":"error","message":"scene.lua:3: material.shininess.*(--warnings=error)","exit":2' out
result $? "an error on request"
scene "$inside" 'lamp.position = { 0, 1, 0 }'
"$glint" scene.lua -o 'no%d.png' --warnings=error --quiet 2>err
test $? -eq 2 -a ! -e no1.png
result $? "before anything is rendered"
scene 'local bright = glint.material { diffuse = 2 }'
run scene.lua --warnings=error
test $? -eq 2 && grep -q 'scene.lua:3: material.diffuse above 1.*(--warnings=error)' err
result $? "the other warnings, too"
scene 'function frame(t) if t > 0.5 then glint.material { diffuse = 2 } end end'
"$glint" scene.lua -o film.apng --warnings=error --quiet 2>err
test $? -eq 2 && grep -q 'finished frames of film.apng are in film.apng.frames' err && [ -e film.apng.frames/0001.png ]
result $? "the frames of a film that it ends are kept, and it says where"
cat >sweep.lua <<'END'
local glint = require "glint"
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, background = 1 }
return glint.sweep { scene = scene, over = { { scene, "ambient", { 0.1, 0.2 } } }, width = 8, height = 8, sheet = {},
                     output = "sweep_%04d.png" }
END
"$glint" sweep.lua --shard 1/2 --warnings=error --quiet 2>err
test $? -eq 0 && grep -q 'not drawn: frame 2 is not rendered yet' err
result $? "a sheet that waits for other shards is no mistake"
run scene.lua --warnings=loud
test $? -eq 2 && grep -q "show, error or none expected, got 'loud'" err
result $? "wrong use"

cat >caps.lua <<'END'
local glint = require "glint"
local scene = glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, glint.box { min = { -1, -1, -1 }, max = { 1, 1, 1 } },
  glint.sphere_light { position = { 0, 5, 5 }, radius = 1, shadow = "caps", name = "bulb" } }
scene:render { width = 8, height = 8, output = "caps.png" }
scene:render { width = 8, height = 8, output = "again.png", seed = 1 }
END
"$glint" caps.lua --quiet 2>err
test "$(grep -c "sphere_light 'bulb'.shadow: only scenes of opaque spheres and planes have shadow caps" err)" -eq 1
result $? "caps that are rays, once"

# ---- Meshes from files ----

# mesh LINES MATERIALS: writes m.obj with one triangle after these statements, and m.mtl
mesh() {
    # shellcheck disable=SC2059 # they have line ends
    printf "$1v -1 0 0\nv 1 0 0\nv 0 1 0\n" >m.obj
    grep -q 'usemtl b' m.obj && printf 'usemtl a\nf 1 2 3\nusemtl b\n' >>m.obj
    echo 'f 1 2 3' >>m.obj
    # shellcheck disable=SC2059
    printf "$2" >m.mtl
}
scene 'objects = { glint.mesh { file = "m.obj" } }'
mesh 'mtllib m.mtl\nusemtl a\n' 'newmtl a\nKd 1 0 0\n'
silent "materials that are there"
mesh 'mtllib m.mtl\nusemtl a\n' 'newmtl a\nKd 1 0 0\nanything else\n'
warns "a statement that no material has" "m.obj: m.mtl: anything is ignored: not a field of a material$"
mesh 'mtllib m.mtl\nusemtl b\n' 'newmtl a\nbump b.png\nnewmtl b\nmap_bump -bm 0.1 b.png\nmap_Bump -bm none b.png\n'
warns "reliefs without a height" "m.obj: material 'a' and 1 more: no relief: map_Bump has no -bm, which gives its height in world units$"
for height in x nan 1e400 0; do
    mesh 'mtllib m.mtl\nusemtl a\n' "newmtl a\nmap_Bump -bm $height b.png\n"
    warns "$height for a height" "m.obj: material 'a': no relief: -bm of map_Bump: a height in world units other than 0 expected, got '$height'$"
done
mesh 'mtllib m.mtl\nusemtl a\n' 'newmtl a\nmap_Bump b.png -bm 0.1\n'
warns "a height after the picture" "m.obj: material 'a' has no relief instead of its map_Bump: some of its faces have no texture coordinates (vt)$"
mesh 'mtllib m.mtl\nusemtl a\n' 'newmtl a\nmap_Kd -texture b.png\n'
warns "an option that no map has" "m.obj: m.mtl:2: an option of a map or the name of a picture expected, got '-texture b.png'; the line is ignored$"
mesh 'mtllib m.mtl\nusemtl a\n' 'newmtl a\nKd 1 0 0\nTf 0.5 0.5 0.5\nKe 1 1 1\n'
warns "statements that mean nothing here" "m.obj: m.mtl: Tf, Ke are ignored: not a field of a material$"
mesh 'mtllib m.mtl\nusemtl a\n' 'newmtl a\nbump -bm 0.1 b.png\n'
warns "a relief without coordinates" "m.obj: material 'a' has no relief instead of its map_Bump: some of its faces have no texture coordinates (vt)$"
printf 'v -1 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nmtllib m.mtl\nusemtl a\nf 1/1 2/2 3/3\n' >m.obj
warns "a relief that is not there" "m.obj: material 'a' has no relief instead of its map_Bump: .*b.png: No such file or directory$"
cat >normals.lua <<'END'
local glint = require "glint"
glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, background = { 0.5, 0.5, 1 } }:render { width = 8, height = 8, output = "b.png" }
END
"$glint" normals.lua --quiet 2>/dev/null
warns "a picture of normals" "m.obj: material 'a' has no relief instead of its map_Bump: heights in grey expected, got a picture with colours"
mesh 'usemtl a\n' ''
warns "no file of materials" "m.obj: material 'a': the mesh names no material file (mtllib)$"
mesh 'mtllib m.mtl\nusemtl b\n' 'newmtl c\n'
warns "materials that the file has not" "m.obj: material 'a' and 1 more: not in m.mtl$"
mesh 'mtllib gone.mtl\nusemtl b\n' ''
warns "a file of materials that is not there" "m.obj: some of its materials are missing: gone.mtl: No such file or directory$"
mesh 'mtllib m.mtl\nusemtl a\n' 'newmtl a\nKd 1 0\nKd 1 0 x\n'
warns "a colour that is none" "m.obj: m.mtl:3: a number expected, got 'x'; the line is ignored$"
mesh 'mtllib m.mtl\nusemtl a\n' 'newmtl a\nmap_Kd wood.png\n'
warns "a picture without coordinates" "m.obj: material 'a' has its Kd instead of its map_Kd: some of its faces have no texture coordinates (vt)$"
scene 'objects = { glint.mesh { file = "m.obj", material = glint.material {} } }'
silent "a material of the script: the file's are not looked at"
printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n' >m.ply
printf 'element face 1\nproperty list uchar int vertex_indices\nend_header\n-1 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2\n' >>m.ply
scene 'objects = { glint.mesh { file = "m.ply" }, glint.mesh { file = "m.ply" } }'
warns "colours of vertices, once" "m.ply: its colours are ignored: red, green and blue of one type expected$"
printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n' >m.ply
printf 'property uchar %s\n' red green blue >>m.ply
printf 'property list uchar int vertex_indices\nend_header\n-1 0 0\n1 0 0\n0 1 0\n9 9 9 3 0 1 2\n' >>m.ply
silent "colours that are there"
{
    echo 'solid x'
    for corner in '0 0 0' '0 1 0'; do
        printf 'facet normal 0 0 0\nouter loop\nvertex -1 0 0\nvertex 1 0 0\nvertex %s\nendloop\nendfacet\n' "$corner"
    done
} >m.stl
scene 'objects = { glint.mesh { file = "m.stl" } }'
warns "faces without an area" "m.stl: 1 of 2 faces are left out: they have no area$"

# ---- The project's own scripts give no warnings ----

run "$root/scripts/sphereflake.lua" --size 8x8 --set size=1 --set nff=balls.nff # the file that nff.lua reads
for script in "$root"/scripts/*.lua; do
    name=$(basename "$script") options='' size=64x36
    [[ $name != gr_* ]] || options=--dialect=gr
    [ "$name" != furnace.lua ] || options="--set steps=8" # the sums of 40 take half a minute
    one=
    [[ $name != @(sky|toon_teapot).lua ]] || one="-f 1-96:19" # all frames would take a minute
    [ -z "${PRELOAD:-}" ] || one="-f 1"    # with a sanitizer, all frames would take minutes
    [ "$name" != fit.lua ] || one=         # fit.lua needs all of its frames
    [ "$name" != lobes.lua ] || size=64x25 # a narrower picture would cut off the ends
    case $name in # letters of 10 pixels must fit
        cosine.lua | furnace.lua | highlight_angles.lua | labels.lua | normals.lua | penumbra.lua | snell.lua | vectors.lua)
            size=320x180 ;;
    esac
    run "$script" --size $size --samples 1 --warnings=error $options $one
    result $? "$name"
done
# ---- Black pictures ----

black() { # LINE: the objects, and changes of the rest
    {
        echo 'local glint = require "glint"'
        echo 'local camera, ambient = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, 0'
        echo 'local function ball(x, y, z, r, name) return glint.sphere { center = { x, y, z }, radius = r, name = name } end'
        echo 'local function lamp(x, y, z, i) return glint.point_light { position = { x, y, z }, intensity = i } end'
        echo "local objects = { $1 }"
        echo 'local scene = glint.scene { camera = camera, ambient = ambient, table.unpack(objects) }'
        echo 'return glint.animation { scene = scene, frames = 3, width = 32, height = 18, frame = function(_, n) if change then change(objects, n) end end }'
    } >scene.lua
}
black ''
warns "black: no shape" "frame 1: the picture is black: the scene has no shape; add one"
black 'ball(0, 0, 0, 1)'
warns "black: no light" "frame 1: the picture is black: the scene has no light, and its ambient is 0; add glint.point_light"
black 'ball(0, 0, 0, 1), lamp(0, 0, 9, 0)'
warns "black: dark lights" "frame 1: the picture is black: no light of the scene is brighter than 0"
black "ball(0, 0, 0, 20, 'room'), lamp(0, 0, 40, 1)"
warns "black: the eye inside a sphere" "frame 1: the picture is black: the camera's eye is inside 'room', which no light reaches"
black 'ball(0, 0, 40, 1), lamp(0, 0, 20, 1)'
warns "black: the camera looks away" "frame 2: the picture is black: the camera looks past all shapes" -f 2
black 'ball(0, 0, 0, 1), lamp(0, 0, -9, 1)'
warns "black: lit from behind" "frame 1: the picture is black: no light reaches the visible surfaces"
for ball in 'ball(0.02, 0.03, 0, 0.001)' 'glint.group { ball(0.05, 0.05, 0, 0.04) }'; do
    black "$ball"
    sed -i 's/^local camera, ambient = \(.*\), 0$/local camera, ambient = \1, 1/' scene.lua
    warns "black: $ball between pixels" "frame 1: the picture is black: the shapes in view are so small or thin that none covers the centre of a pixel"
done
black 'glint.sphere { center = { 0, 0, 0 }, radius = 1, material = glint.material { diffuse = 0 } }'
sed -i 's/^local camera, ambient = \(.*\), 0$/local camera, ambient = \1, 1/' scene.lua
warns "black: nothing reflects the ambient light" "frame 1: the picture is black: no light leaves the visible surfaces: their materials reflect none of the scene's ambient light"
black 'ball(0, 0, 0, 1), lamp(0, 0, 9, 1)'
silent "not a picture with light"
sed -i '1i function change(objects, n) objects[2].intensity = n - 1 end' scene.lua
silent "nor a film that fades in"
echo 'local glint = require "glint"
glint.scene { camera = glint.camera { eye = { 0, 0, 9 }, at = { 0, 0, 0 } }, ambient = 1 }:render { width = 9, height = 9 }' >scene.lua
warns "black: of a loop" "frame 1: the picture is black: the scene has no shape"
run scene.lua --warnings=error
[ $? -eq 2 ]
result $? "black: an error on request"

for step in ambient diffuse specular; do
    run "$root/scripts/workshop.lua" --size 64x36 --samples 1 --warnings=error --set step=$step
    result $? "workshop.lua, step $step"
done
totals
