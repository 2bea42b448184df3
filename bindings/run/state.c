// The run of a Lua state, and its first failure.
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "bindings/run/run.h"

#define CALLERS_MAX 8 // lines of a traceback, at most
#define LEVELS_MAX 200 // levels of the stack that are searched, since endless recursion fills the stack

static const char RUN; // address used as the registry key for the run

double glintL_now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

size_t glintL_run_reuse_bytes(const glintL_run *run)
{
    const size_t machine = (size_t)sysconf(_SC_PHYS_PAGES) / 4 * (size_t)sysconf(_SC_PAGESIZE);
    return run->request.reuse_memory ? run->request.reuse_memory : machine;
}

glintL_run **glintL_new_run_box(lua_State *L, lua_CFunction collect)
{
    luaL_checkstack(L, 4, "run");
    glintL_run **box = lua_newuserdatauv(L, sizeof *box, 0);
    *box = NULL;
    if (collect) {
        lua_createtable(L, 0, 1);
        glintL_set_function(L, "__gc", collect);
        lua_setmetatable(L, -2);
    }
    lua_rawsetp(L, LUA_REGISTRYINDEX, &RUN);
    return box;
}

void glintL_attach_run(lua_State *L, glintL_run *run) { *glintL_new_run_box(L, NULL) = run; }

glintL_run *glintL_get_run(lua_State *L)
{
    luaL_checkstack(L, 2, "run");
    lua_rawgetp(L, LUA_REGISTRYINDEX, &RUN);
    glintL_run **box = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return box ? *box : NULL;
}

// Returns whether a chunk is one of glint's own modules, in a folder glint. Its lines mean nothing to users.
static bool is_own_module(lua_State *L, const char *source)
{
    static const char folder[] = "glint/";
    const size_t before = sizeof folder - 1;
    const char *slash = strrchr(source, '/'), *dot = slash ? strrchr(slash, '.') : NULL;
    if (!dot || (size_t)(slash - source) < before || strncmp(slash + 1 - before, folder, before) != 0)
        return false;
    luaL_checkstack(L, 3, "message");
    lua_getfield(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_pushliteral(L, "glint.");
    lua_pushlstring(L, slash + 1, (size_t)(dot - slash - 1));
    lua_concat(L, 2);
    const bool is_loaded = lua_rawget(L, -2) != LUA_TNIL;
    lua_pop(L, 2);
    return is_loaded;
}

// Appends the lines of the script that led to the error to the message on top.
static int add_callers(lua_State *L)
{
    lua_Debug where;
    int shown = 0;
    luaL_checkstack(L, 4, "message");
    for (int level = 0; shown < CALLERS_MAX && level < LEVELS_MAX && lua_getstack(L, level, &where); level++) {
        lua_getinfo(L, "Sl", &where);
        if (where.currentline <= 0 || is_own_module(L, where.source))
            continue;
        const char *line = lua_pushfstring(L, "%s:%d", where.short_src, where.currentline);
        const char *said = strstr(lua_tostring(L, -2), line);
        const char after = said ? said[strlen(line)] : ' ';
        if (said && (after < '0' || after > '9')) { // skips a line that the message has already
            lua_pop(L, 1);
            continue;
        }
        lua_pushfstring(L, "%s\n  called from %s", lua_tostring(L, -2), line);
        lua_replace(L, -3);
        lua_pop(L, 1);
        shown++;
    }
    return 1;
}

int glintL_message_handler(lua_State *L)
{
    if (lua_type(L, 1) == LUA_TSTRING) {
        static const char stripped[] = "?:-1: "; // a place in one of glint's own modules
        if (strncmp(lua_tostring(L, 1), stripped, sizeof stripped - 1) == 0) {
            lua_pushstring(L, lua_tostring(L, 1) + sizeof stripped - 1);
            lua_replace(L, 1);
        }
        const char *cure = glintL_push_lua_cure(L, lua_tostring(L, 1));
        if (cure && !strstr(lua_tostring(L, 1), cure)) {
            lua_pushfstring(L, "%s%s", lua_tostring(L, 1), cure);
            lua_replace(L, 1);
        }
        lua_settop(L, 1);
        return add_callers(L);
    }
    // __tostring could run forever, because the hooks that stop an untrusted script may be off here.
    if (!glintL_get_run(L)->request.is_untrusted && luaL_callmeta(L, 1, "__tostring") && lua_type(L, -1) == LUA_TSTRING)
        return 1;
    if (lua_type(L, 1) == LUA_TNUMBER)
        luaL_tolstring(L, 1, NULL);
    else
        lua_pushfstring(L, "(error object is a %s value)", luaL_typename(L, 1));
    return 1;
}

// ---- Failure ----

bool glintL_run_fail(glintL_run *run, int exit_code, int64_t index, const char *format, ...)
{
    if (run->exit_code)
        return false;
    va_list args;
    va_start(args, format);
    vsnprintf(run->message, sizeof run->message, format, args);
    va_end(args);
    // An untrusted script has a memory limit, so exceeding it is a mistake of the script.
    const bool is_short = run->request.is_untrusted && strstr(run->message, "out of memory");
    run->exit_code = is_short ? GLINTL_EXIT_USAGE : exit_code;
    run->failed_index = index;
    return false;
}

bool glintL_complain(char message[GLINTL_MESSAGE_SIZE], const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(message, GLINTL_MESSAGE_SIZE, format, args);
    va_end(args);
    return false;
}

int glintL_run_exit_code(glint_status status)
{
    switch (status) {
    case GLINT_OK:
        return GLINTL_EXIT_DONE;
    case GLINT_ERR_NO_SPACE:
        return GLINTL_EXIT_LATER;
    case GLINT_ERR_INVALID:
    case GLINT_ERR_UNSUPPORTED:
        return GLINTL_EXIT_USAGE;
    default:
        return GLINTL_EXIT_FAILED;
    }
}
