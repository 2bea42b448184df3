#!/usr/bin/env bash
# element.sh: tests the element <glint-figure> in headless Chromium, see element.mjs and reader.mjs. Exits with 77 without a
# browser.
set -u
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || {
    echo "skip: Chromium is not installed; get it with:  apt-get install chromium"
    exit 77
}
cp tests/web/{browser,element,reader}.mjs "$BUILD/npm" # whose folder has the packages that they import
bad=0
for name in element reader; do
    CHROMIUM=$browser node "$BUILD/npm/$name.mjs" "$PWD/$BUILD/web" "$GLINT" "$PWD/scripts" "$PWD/$BUILD/tests/$name" || bad=1
done
exit $bad
