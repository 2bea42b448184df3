#!/bin/sh
# Runs luacheck on the Lua files and cppcheck on the C files, and looks for phrases that make comments and pages hard to
# read. A tool that is not installed is skipped with a message.
set -u
bad=0
if command -v luacheck >/dev/null 2>&1; then
    luacheck --quiet --no-color scripts tests bindings || bad=1
else
    echo "skip: luacheck is not installed"
fi
if command -v cppcheck >/dev/null 2>&1; then
    cppcheck --quiet --std=c11 --language=c -j 2 -I. --enable=warning,portability --inline-suppr \
        --suppress=missingIncludeSystem --suppress=unknownMacro --suppress=invalidPointerCast --error-exitcode=1 -D__x86_64__ -U__cplusplus \
        -D__BYTE_ORDER__=1234 -D__ORDER_LITTLE_ENDIAN__=1234 \
        --template='{file}:{line}: {severity}: {message} [{id}]' $(printf ' -i %s' engine/render/*/kernel*.c engine/render/effects/*/kernel*.c) \
        $(find engine -mindepth 1 -maxdepth 2 -type d | grep -vE "/(render|stages)$") bindings || bad=1
else
    echo "skip: cppcheck is not installed"
fi
${LUA:-lua5.4} tests/english.lua Makefile README.md .github/*.md $(find engine bindings scripts tests -name '*.[ch]' -o -name '*.lua' \
    -o -name '*.sh' -o -name '*.md' -o -name '*.js' -o -name '*.mjs') || bad=1
exit $bad
