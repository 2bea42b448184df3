// The identity of a script's text: a hash of the script and of the Lua modules that it has loaded, in any order and
// from any place. The frames of one film must come from one text. Their keys cannot show that, because they differ for
// each frame.
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

#include "bindings/run/run.h"

// Adds a hash. The sum does not depend on the order.
static void add_hash(XXH128_hash_t hash, XXH128_hash_t *sum)
{
    sum->low64 += hash.low64;
    sum->high64 += hash.high64;
}

// Adds a file under a name to the sum. Skips a file that cannot be read. False: out of memory.
static bool add_file(const char *name, const char *path, XXH128_hash_t *sum)
{
    char bytes[8192];
    ssize_t size = 0;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (file < 0)
        return true;
    XXH3_state_t *state = XXH3_createState();
    const bool good = state && XXH3_128bits_reset(state) == XXH_OK;
    if (good) {
        XXH3_128bits_update(state, name, strlen(name) + 1);
        while ((size = read(file, bytes, sizeof bytes)) > 0)
            XXH3_128bits_update(state, bytes, (size_t)size);
        if (size == 0)
            add_hash(XXH3_128bits_digest(state), sum);
    }
    XXH3_freeState(state);
    close(file);
    return good;
}

// Pushes the file that a template of package.path finds for a module, or nil. Unlike package.searchpath it reports lack
// of memory.
static void push_found(lua_State *L, const char *module, const char *templates)
{
    luaL_gsub(L, module, ".", "/");
    while (*templates) {
        const size_t length = strcspn(templates, ";");
        lua_pushlstring(L, templates, length);
        luaL_gsub(L, lua_tostring(L, -1), "?", lua_tostring(L, -2));
        if (access(lua_tostring(L, -1), R_OK) == 0) {
            lua_replace(L, -3);
            lua_pop(L, 1);
            return;
        }
        lua_pop(L, 2);
        templates += length + (templates[length] == ';');
    }
    lua_pop(L, 1);
    lua_pushnil(L);
}

// Adds the modules in package.loaded that package.path finds. False: out of memory.
static bool add_modules(lua_State *L, XXH128_hash_t *sum)
{
    bool good = true;
    int package = lua_gettop(L);
    if (lua_getfield(L, package, "loaded") != LUA_TTABLE || lua_getfield(L, package, "path") != LUA_TSTRING)
        return true;
    const char *templates = lua_tostring(L, package + 2);
    lua_pushnil(L);
    while (good && lua_next(L, package + 1)) {
        lua_pop(L, 1);
        if (lua_type(L, -1) != LUA_TSTRING)
            continue;
        push_found(L, lua_tostring(L, -1), templates);
        if (!lua_isnil(L, -1))
            good = add_file(lua_tostring(L, -2), lua_tostring(L, -1), sum);
        lua_pop(L, 1);
    }
    return good;
}

void glintL_find_source(lua_State *L, glintL_run *run)
{
    XXH128_hash_t sum = { 0, 0 };
    bool good = true;
    if (*run->source)
        return;
    luaL_checkstack(L, 12, "source");
    int top = lua_gettop(L);
    if (lua_getglobal(L, "arg") == LUA_TTABLE && lua_rawgeti(L, -1, 0) == LUA_TSTRING)
        good = add_file("", lua_tostring(L, -1), &sum);
    if (good && lua_getglobal(L, "package") == LUA_TTABLE)
        good = add_modules(L, &sum);
    if (!good)
        luaL_error(L, "out of memory");
    lua_settop(L, top);
    snprintf(run->source, sizeof run->source, "%016" PRIx64 "%016" PRIx64, (uint64_t)sum.high64, (uint64_t)sum.low64);
}

const char *glintL_push_file(lua_State *L, const char *name)
{
    luaL_checkstack(L, 4, "file");
    lua_pushstring(L, name);
    const int found = lua_gettop(L);
    if (*name == '/' || access(name, F_OK) == 0)
        return lua_tostring(L, found);
    if (lua_getglobal(L, "arg") == LUA_TTABLE && lua_rawgeti(L, -1, 0) == LUA_TSTRING) {
        const char *script = lua_tostring(L, -1), *slash = strrchr(script, '/');
        lua_pushlstring(L, script, slash ? (size_t)(slash - script) + 1 : 0);
        lua_pushvalue(L, found);
        lua_concat(L, 2);
        if (access(lua_tostring(L, -1), F_OK) == 0)
            lua_replace(L, found);
    }
    lua_settop(L, found);
    return lua_tostring(L, found);
}
