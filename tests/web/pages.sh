#!/usr/bin/env bash
# pages.sh: tests the pages of `make web` in headless Chromium, see pages.mjs. Exits with 77 without a browser.
set -u
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || {
    echo "skip: Chromium is not installed; get it with:  apt-get install chromium"
    exit 77
}
cp tests/web/pages.mjs "$BUILD/npm" # whose folder has the packages that it imports
CHROMIUM=$browser node "$BUILD/npm/pages.mjs" "$PWD/$BUILD/web" "$GLINT" "$PWD/scripts" "$PWD/$BUILD/tests/pages"
