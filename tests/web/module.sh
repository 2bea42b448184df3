#!/usr/bin/env bash
# module.sh: tests the module of `make web` in node, see module.mjs, and the sizes of live pictures, see renderer.mjs.
set -u
command -v node >/dev/null || {
    echo "node is not installed"
    exit 77
}
export OUT=$BUILD/tests/web WEB=$BUILD/web
rm -rf "$OUT"
mkdir -p "$OUT"
node tests/web/renderer.mjs || exit 1
# A crash in WebAssembly prints megabytes.
node tests/web/module.mjs 2> >(cut -c1-300 >&2)
