/// Passes bytes to the function that the Lua file DRIVER returns. An error in the driver is a finding.
#include "bindings/value/glintL.h"
#include "tests/fuzz/fuzz.h"

#include <lualib.h>
#include <string.h>

int luaopen_glint(lua_State *L);

static lua_State *state;

static void open_state(void)
{
    state = luaL_newstate();
    FUZZ_CHECK(state, "out of memory");
    luaL_openlibs(state);
    luaL_requiref(state, "glint", luaopen_glint, 0);
    lua_settop(state, 0);
    FUZZ_CHECK(!luaL_dofile(state, DRIVER), "%s", lua_tostring(state, -1));
}

/// Collects garbage after each input, so that leaks and growth appear early.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!state)
        open_state();
    lua_pushvalue(state, 1);
    lua_pushlstring(state, (const char *)data, size);
    FUZZ_CHECK(!lua_pcall(state, 1, 0, 0), "%s", lua_tostring(state, -1));
    lua_gc(state, LUA_GCCOLLECT);
    return 0;
}
