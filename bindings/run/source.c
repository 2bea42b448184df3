// What a script's text is known by: a hash over it and the Lua modules it has required, whatever their order and place.
// Frames of one film come from one text, which their keys alone, one for each frame, cannot tell.
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <xxhash.h>

#include "bindings/run/run.h"

// A sum does not depend on the order.
static void add_hash(XXH128_hash_t hash, XXH128_hash_t *sum)
{
    sum->low64 += hash.low64;
    sum->high64 += hash.high64;
}

// Adds a file under a name to the sum; one that cannot be read is left out.
static void add_file(const char *name, const char *path, XXH128_hash_t *sum)
{
    char bytes[8192];
    size_t size;
    FILE *file = fopen(path, "rb");
    XXH3_state_t *state = file ? XXH3_createState() : NULL;
    if (state && XXH3_128bits_reset(state) == XXH_OK) {
        XXH3_128bits_update(state, name, strlen(name) + 1);
        while ((size = fread(bytes, 1, sizeof bytes, file)) > 0)
            XXH3_128bits_update(state, bytes, size);
        add_hash(XXH3_128bits_digest(state), sum);
    }
    XXH3_freeState(state);
    if (file)
        fclose(file);
}

// Adds the modules in package.loaded that package.path finds.
static void add_modules(lua_State *L, XXH128_hash_t *sum)
{
    int package = lua_gettop(L);
    if (lua_getfield(L, package, "loaded") != LUA_TTABLE || lua_getfield(L, package, "path") != LUA_TSTRING ||
        lua_getfield(L, package, "searchpath") != LUA_TFUNCTION)
        return;
    lua_pushnil(L);
    while (lua_next(L, package + 1)) {
        lua_pop(L, 1);
        if (lua_type(L, -1) != LUA_TSTRING)
            continue;
        lua_pushvalue(L, package + 3);
        lua_pushvalue(L, -2);
        lua_pushvalue(L, package + 2);
        if (lua_pcall(L, 2, 1, 0) == LUA_OK && lua_type(L, -1) == LUA_TSTRING)
            add_file(lua_tostring(L, -2), lua_tostring(L, -1), sum);
        lua_pop(L, 1);
    }
}

void glintL_find_source(lua_State *L, glintL_run *run)
{
    XXH128_hash_t sum = { 0, 0 };
    if (*run->source)
        return;
    luaL_checkstack(L, 12, "source");
    int top = lua_gettop(L);
    if (lua_getglobal(L, "arg") == LUA_TTABLE && lua_rawgeti(L, -1, 0) == LUA_TSTRING)
        add_file("", lua_tostring(L, -1), &sum);
    if (lua_getglobal(L, "package") == LUA_TTABLE)
        add_modules(L, &sum);
    lua_settop(L, top);
    snprintf(run->source, sizeof run->source, "%016" PRIx64 "%016" PRIx64, (uint64_t)sum.high64, (uint64_t)sum.low64);
}
