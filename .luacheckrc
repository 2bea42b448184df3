std = "lua54"
max_line_length = 120
files["tests"] = { max_line_length = 160 } -- tables of cases
files["bindings/meta/glint.lua"] = { ignore = { "1", "2", "6" } } -- declarations without bodies, for editors
files["bindings/watch/track.lua"] = { globals = { "io", "loadfile", "dofile", "package" } } -- it stands in for them
files["scripts/lib/gr"] = { globals = { "io", "package" } } -- the dialect's scenes find files in more places
exclude_files = { "build/**", "build-*/**", "tests/gr/scenes/**", "scripts/gr_*.lua" } -- gr scenes live on globals
