# The page of the modules, from their comments: make pages writes it to build/doc/data.md.
#     awk -f page.awk glint/xyz.lua ...
# A module's first comment says what the module is. A `---` comment before a function says what the function does, and
# describes its parameters.
function name_of(path) {
    sub(/^.*scripts\/lib\//, "", path)
    sub(/\.lua$/, "", path)
    gsub(/\//, ".", path)
    return path
}
function flush_text(    i) {
    for (i = 1; i <= count; i++)
        print text[i]
    count = 0
}
BEGIN {
    print "# Modules in Lua"
    print ""
    print "These modules read data and make scenes from it. A script loads a module with `local xyz = require \"glint.xyz\"`."
    print "The installed command finds the modules automatically. This page is generated from the comments of the modules."
}
FNR == 1 {
    print "\n## " name_of(FILENAME) "\n"
    head = 1
    count = code = 0
}
head && /^--( |$)/ {
    line = substr($0, 4)
    is_code = line ~ /^    /
    if (is_code != code)
        print ""
    code = is_code
    print line
    next
}
head { head = 0 }
/^---@(param|return)/ {
    kind = $0 ~ /@return/ ? "returns " : ""
    line = $0
    sub(/^---@(param|return) +/, "", line)
    if (count && text[count] !~ /^- /)
        text[++count] = ""
    text[++count] = "- " kind "`" line
    sub(/  /, "`: ", text[count])
    if (text[count] !~ /`: /)
        text[count] = text[count] "`"
    next
}
/^--- / { text[++count] = substr($0, 5); next }
/^function [a-z_0-9]+[.:][a-z_0-9]+\(/ && count {
    line = $0
    sub(/^function /, "", line)
    sub(/\).*/, ")", line)
    print "\n### `" line "`\n"
    flush_text()
    next
}
{ count = 0 }
