#!/usr/bin/env bash
# element.sh: tests the element <glint-figure> in headless Chromium, see element.mjs. Exits with 77 without a browser.
set -u
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || {
    echo "skip: Chromium is not installed; get it with:  apt-get install chromium"
    exit 77
}
cp tests/web/element.mjs "$BUILD/npm" # whose folder has the packages that it imports
CHROMIUM=$browser node "$BUILD/npm/element.mjs" "$PWD/$BUILD/web" "$GLINT" "$PWD/scripts" "$PWD/$BUILD/tests/element"
