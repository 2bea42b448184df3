#!/usr/bin/env bash
# The recipe for Open Image Denoise: its passes are as the denoiser expects them, and where oidnDenoise is installed, its
# commands make a picture that is nearer to the truth.
. tests/command/prelude.sh
page=$root/bindings/docs/how-to.md
cd "$work" || exit 1
ln -s "$root/scripts" scripts
mkdir bin
ln -s "$glint" bin/glint
export PATH="$work/bin:$PATH"
recipe() { sed -n "/^## Remove noise/,/^## Render/p" "$page" | sed -n "s/^ *\($1.*\)/\1/p" | sed "s/160x90/80x50/"; } # smaller, to save time

check "the noisy picture" bash -c "$(recipe 'glint scripts')"
cat >range.lua <<'E2'
local glint = require "glint"
local albedo, normal = glint.read_image "noisy_2.albedo.pfm", glint.read_image "noisy_2.normal.pfm"
local beauty, bright = glint.read_image "noisy_2.pfm", 0
assert(albedo.width == beauty.width and normal.height == beauty.height)
for y = 0, beauty.height - 1 do
  for x = 0, beauty.width - 1 do
    local r, g, b = albedo:pixel(x, y)
    assert(math.min(r, g, b) >= 0 and math.max(r, g, b) <= 1, "albedo 0 .. 1")
    local length = glint.length(glint.vector { normal:pixel(x, y) })
    assert(length == 0 or math.abs(length - 1) < 1e-5, "unit vectors, 0 in the background")
    bright = math.max(bright, r)
  end
end
assert(bright > 0.5, "some surface reflects")
os.exit(true)
E2
exits 0 "albedo and normal" range.lua -q

if command -v oidnDenoise >/dev/null 2>&1; then
    check "oidnDenoise" bash -c "$(recipe oidnDenoise)"
    check "the sheet of both" bash -c "$(recipe 'glint sheet')"
    exits 0 "the truth" scripts/indirect.lua --size 80x50 -f 2 --samples 64 -q -o 'true_%d.pfm'
    error() { "$glint" compare "$1" true_2.pfm --json | sed -n 's/.*"rms_error":\([0-9.e-]*\).*/\1/p'; }
    check "its error is smaller" awk -v a="$(error clean.pfm)" -v b="$(error noisy_2.pfm)" 'BEGIN { exit !(a > 0 && a < b) }'
else
    skip "oidnDenoise is not installed"
fi
totals
