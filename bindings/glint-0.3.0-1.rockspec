-- `luarocks --lua-version 5.4 make bindings/glint-0.3.0-1.rockspec` in a checkout builds and installs the module and the command. So does
-- `luarocks install` with the rock that `make dist` makes from this file and the archive of the sources.
-- The libraries come from the system: see tests/deps.sh for their Debian names.
rockspec_format = "3.0"
package = "glint"
version = "0.3.0-1"
source = { url = "glint-0.3.0.tar.gz", dir = "glint-0.3.0" } -- in the same rock
description = {
  summary = "Ray-tracing render engine: many pictures of one scene under changing light and material",
  license = "MIT",
}
supported_platforms = { "linux" }
dependencies = { "lua >= 5.4, < 5.5" }
external_dependencies = {
  PNG = { header = "png.h" },
  ZLIB = { header = "zlib.h" },
  XXHASH = { header = "xxhash.h" },
}
build = {
  type = "make",
  build_variables = { BUILD = "build/rock", CFLAGS = "$(CFLAGS)", LUA_CFLAGS = "-I$(LUA_INCDIR)" },
  install_target = "install-rock",
  install_variables = {
    BUILD = "build/rock", CFLAGS = "$(CFLAGS)", LUA_CFLAGS = "-I$(LUA_INCDIR)",
    bindir = "$(BINDIR)", luadir = "$(LIBDIR)", luasharedir = "$(LUADIR)",
  },
}
