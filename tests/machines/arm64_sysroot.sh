#!/bin/sh
# arm64_sysroot.sh FOLDER: unpacks Debian's arm64 libraries and headers into FOLDER as a root file system to compile
# and run against. The machine's own packages and architectures stay unchanged; needs apt-get and dpkg, not root.
set -eu
mkdir -p "$1/apt/lists/partial" "$1/apt/cache/archives/partial" "$1/usr/lib"
root=$(cd "$1" && pwd)
[ ! -e "$root/complete" ] || exit 0
: >"$root/apt/status"
fetch() {
    apt-get -qq -o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o APT::Sandbox::User=root \
        -o Dir::State="$root/apt" -o Dir::State::status="$root/apt/status" -o Dir::Cache="$root/apt/cache" "$@"
}
fetch update
fetch install -y --download-only --no-install-recommends liblua5.4-dev libpng-dev zlib1g-dev libxxhash-dev \
    libisal-dev libdeflate-dev libcmocka-dev libmpfr-dev >/dev/null
ln -sfn usr/lib "$root/lib"
for package in "$root"/apt/cache/archives/lib*.deb "$root"/apt/cache/archives/*zlib1g*.deb \
    "$root"/apt/cache/archives/linux-libc-dev*.deb; do
    dpkg-deb -x "$package" "$root"
done
# A link to /lib/... is relative to the root of that file system.
find "$root" -type l -lname '/*' | while read -r link; do
    ln -sfn "$root$(readlink "$link")" "$link"
done
rm -rf "$root/apt"
touch "$root/complete"
