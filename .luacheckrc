std = "lua54"
max_line_length = 120
files["tests"] = { max_line_length = 160 } -- tables of cases
files["bindings/meta/glint.lua"] = { ignore = { "1", "2", "6" } } -- declarations without bodies, for editors
exclude_files = { "build/**", "build-*/**" }
