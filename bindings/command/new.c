// glint new NAME: writes a folder with a first scene and the type definitions for editors; NAME.lua: only the scene.
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bindings/command/cli.h"
#include "bindings/run/system.h"

static const char STARTER[] = {
#include "bindings/command/starter.lua.h"
};
static const unsigned char NEW_LUA[] = {
#include "bindings/command/new.lua.h"
};

// Pushes the exit code and the reason of a failure. No values for 0.
static int push_failure(lua_State *L, int why)
{
    lua_pushinteger(L, why == EEXIST                     ? GLINTL_EXIT_USAGE
                       : why == ENOSPC || why == EDQUOT ? GLINTL_EXIT_LATER
                                                        : GLINTL_EXIT_FAILED);
    lua_pushstring(L, why == EEXIST   ? "it exists already and was not changed"
                      : why == ENOENT ? "its folder does not exist; create it with mkdir"
                                      : strerror(why));
    return why ? 2 : 0;
}

// make_folder(path): makes a folder, unless it exists. Returns the exit code and the reason if it cannot.
static int make_folder(lua_State *L)
{
    return push_failure(L, mkdir(luaL_checkstring(L, 1), 0777) == 0 || errno == EEXIST ? 0 : errno);
}

// write(path, text): writes a new file. Returns the exit code and the reason if it cannot; 2: the file exists.
static int write_file(lua_State *L)
{
    const char *path = luaL_checkstring(L, 1);
    FILE *file = fopen(path, "wx");
    if (!file)
        return push_failure(L, errno);
    int why = fputs(luaL_checkstring(L, 2), file) < 0 ? EIO : 0;
    if (fclose(file) != 0)
        why = errno;
    if (why)
        unlink(path);
    return push_failure(L, why);
}

static int starter(lua_State *L)
{
    lua_pushlstring(L, STARTER, sizeof STARTER);
    return 1;
}

// types(): returns the folder of type definitions, PREFIX/share/glint or the folder next to a build, if it exists.
static int types(lua_State *L)
{
    static const char *const places[] = { "../share/glint", "meta" };
    char folder[GLINTL_PATH_SIZE], path[GLINTL_PATH_SIZE + 64], real[PATH_MAX];
    if (!glintL_program_folder(cli_task_of(L)->options->program, folder, sizeof folder))
        return 0;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        snprintf(path, sizeof path, "%s%s/glint.lua", folder, places[i]);
        if (access(path, R_OK) != 0)
            continue;
        path[strlen(path) - sizeof "/glint.lua" + 1] = '\0';
        lua_pushstring(L, realpath(path, real));
        return 1;
    }
    return 0;
}

int cli_new(cli_options *options, cli_output *output, glintL_run *run)
{
    static const luaL_Reg functions[] = {
        { "make_folder", make_folder }, { "write", write_file }, { "starter", starter }, { "types", types }, { NULL, NULL },
    };
    static const glintL_carried module = { "@new.lua", NEW_LUA, sizeof NEW_LUA };
    cli_task task = { .name = "new", .options = options, .output = output, .run = run, .functions = functions };
    return cli_run_module(&task, &module, 1);
}
