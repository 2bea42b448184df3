#!/usr/bin/env bash
# The Debian source package of .github/debian, from the committed files: dpkg-source must build it, and lintian must not
# complain. Prints TAP lines. Exits with 77 if git, dpkg-dev or lintian is not installed.
set -u
for tool in git dpkg-buildpackage dh lintian; do
    command -v $tool >/dev/null 2>&1 || {
        echo "skip: $tool is not installed"
        exit 77
    }
done
git rev-parse --git-dir >/dev/null 2>&1 || {
    echo "skip: no git checkout"
    exit 77
}
version=$(sed -n 's/^.define GLINT_VERSION "\(.*\)"/\1/p' engine/glint.h)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
source=$work/glint-$version
bad=0
check() { # NAME COMMAND...
    local name=$1
    shift
    if "$@" >"$work/log" 2>&1; then echo "ok - $name"; else
        echo "not ok - $name"
        cat "$work/log"
        bad=1
    fi
}
mkdir "$source"
git archive HEAD | tar -x -C "$source"
cp -r .github/debian "$source/debian"
check "the changelog has the version" grep -q "^glint ($version)" "$source/debian/changelog"
check "the package has the ABI's name" grep -q "^Package: libglint${version%.*}$" "$source/debian/control"
check "the source package" env -C "$source" dpkg-buildpackage -S -us -uc -d
check "lintian accepts it" lintian --allow-root --fail-on error,warning "$work/glint_$version.dsc"
cp "$work"/glint_"$version".* "${OUT:-$work}/" 2>/dev/null
exit $bad
