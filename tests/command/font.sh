# shellcheck shell=bash disable=SC2034,SC2154
# Chooses the font of the pictures that pages show: DejaVu Sans. Sets `pinned` where both the font and FreeType are
# from Debian 12, so that text has the pixels of these pictures. Elsewhere the bitmap font is used, and pictures with text are
# not compared. `glint` is the command.
export GLINT_FONT=bitmap
pinned=
dejavu=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
if "$glint" --version --verbose | grep -q "FreeType 2\.12\.1" &&
    sha256sum $dejavu 2>/dev/null | grep -q "^abdc775b21b1bc470d50c97e790d276f2054b7504e56e5bd3e64f48d68582322 "; then
    GLINT_FONT=$dejavu pinned=yes
fi
