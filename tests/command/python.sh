#!/usr/bin/env bash
# Runs the blocks of scripts/python.md in order. Blocks whose Python modules are not installed are skipped with a
# message. Also checks that normals computed from a DiLiGenT set match the normals in the set.
. tests/command/prelude.sh
mkdir "$work/bin"
ln -s "$glint" "$work/bin/glint"
ln -s "$root/scripts" "$work/scripts"
cd "$work" || exit 1
export PATH="$work/bin:$PATH"
python=
for name in python3 /usr/bin/python3; do
    if [ -z "$python" ] && $name -c 'import numpy' 2>/dev/null; then python=$name; fi
done
awk '/^```(python|sh)$/ { name = sprintf("%02d.%s", ++n, substr($0, 4)); next } /^```/ { name = ""; next } name { print > name }' \
    "$root/scripts/python.md"
lacking() { # BLOCK: the first module that it imports and that is not there
    local module
    for module in $(sed -nE 's/^(import|from) ([a-zA-Z0-9_]+).*/\2/p' "$1"); do
        "$python" -c "import $module" 2>/dev/null || { echo "$module"; return; }
    done
}
check "the page's commands" bash -e 01.sh
for block in [0-9]*.python; do
    if [ -z "$python" ]; then
        skip "$block: no Python with numpy"
        continue
    fi
    module=$(lacking "$block")
    if [ -n "$module" ]; then skip "$block: no $module"; else check "$block of scripts/python.md" "$python" "$block"; fi
done

# ---- DiLiGenT ----

job=("$root/scripts/photometric.lua" --set layout=diligent --set objects=sphere,balls --set materials=matt --set size=96
    --set lights=20 --set spread=35 --set shadows=false --set vary=0.4 --set folder=set)
check "a set of two objects" "$glint" "${job[@]}" -q
rm set/balls_matt/00[3-5].png
check "goes on where it was interrupted" eval '"$glint" "${job[@]}" --json -q | grep -q "\"frames\":42,\"kept\":37,"'
check "a name that is none is answered" eval '! "$glint" "${job[@]}" --set materials=matt,silver 2>err &&
    grep -q "materials: .silver. is none of glossy, gold, matt, rough" err'
check "every object in every material" "$glint" "$root/scripts/photometric.lua" --set layout=diligent --set size=24 --set lights=2 \
    --set objects=balls,sphere,solids,dents --set materials=matt,glossy,rough,gold --set folder=all -q
check "has its folder" eval 'test "$(ls -d all/*/ | wc -l)" -eq 16 && test "$(ls all/dents_gold | wc -l)" -eq 10 &&
    test "$(wc -l <all/objects.txt)" -eq 16'
cat >solve.py <<'END'
import struct, sys, zlib
import numpy as np

def read_png(path):  # codes of a picture that is not interlaced
    data = open(path, "rb").read()
    at, stream = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            stream += body
        at += 12 + size
    channels = { 0: 1, 2: 3, 6: 4 }[color]
    pixel = channels * bits // 8
    raw, before = zlib.decompress(stream), bytearray(width * pixel)
    rows = []
    for y in range(height):
        line = raw[y * (width * pixel + 1):(y + 1) * (width * pixel + 1)]
        kind, row = line[0], bytearray(line[1:])
        for i in range(len(row)):
            a, b = row[i - pixel] if i >= pixel else 0, before[i]
            c = before[i - pixel] if i >= pixel else 0
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
        rows.append(bytes(row))
        before = row
    return np.frombuffer(b"".join(rows), ">u2" if bits == 16 else "u1").reshape(height, width, channels)

folder = sys.argv[1] + "/"
names = open(folder + "filenames.txt").read().split()
lights, strengths = np.loadtxt(folder + "light_directions.txt"), np.loadtxt(folder + "light_intensities.txt")
mask, truth = read_png(folder + "mask.png"), np.load(folder + "Normal_gt.npy").astype(float)
assert mask.shape[2] == 1 and len(names) == len(lights) == len(strengths)
assert ((mask[:, :, 0] == 255) == (truth != 0).any(axis=2)).all() and set(np.unique(mask)) == {0, 255}
assert np.abs(read_png(folder + "Normal_gt.png") / 65535 * 2 - 1 - truth)[mask[:, :, 0] == 255].max() < 2 / 65535
assert np.abs(np.linalg.norm(lights, axis=1) - 1).max() < 1e-12 and strengths.min() < 0.75
codes = np.stack([read_png(folder + name) for name in names]).astype(float)
lit = (mask[:, :, 0] == 255) & (codes > 0).all(axis=(0, 3))
shown = (codes / 65535 / strengths[:, None, None, :])[:, lit].sum(axis=2)
solved = np.linalg.lstsq(lights, shown, rcond=None)[0]
solved /= np.linalg.norm(solved, axis=0)
cosine, sine = (solved.T * truth[lit]).sum(axis=1), np.linalg.norm(np.cross(solved.T, truth[lit]), axis=1)
worst = np.degrees(np.arctan2(sine, cosine)).max()
print("%s: %d pixels, normals off by %.4f degrees at most" % (sys.argv[1], lit.sum(), worst))
assert lit.sum() > 500 and worst <= 0.01
END
for object in sphere_matt balls_matt; do
    if [ -z "$python" ]; then
        skip "normals of $object: no Python with numpy"
    else
        "$python" solve.py set/$object
        check "normals of $object are right to 0.01 degrees" "$python" solve.py set/$object
    fi
done
totals
