// Functions for files.lua, which lists the files that a command's words name.
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>

#include "bindings/command/cli.h"

static const unsigned char FILES_LUA[] = {
#include "bindings/command/files.lua.h"
};
const glintL_carried cli_files_module = { "@files.lua", FILES_LUA, sizeof FILES_LUA };

// Returns the selection of --frames, which a run takes over from the command line.
static const glintL_selection *selection_of(lua_State *L)
{
    const cli_task *task = cli_task_of(L);
    return task->run ? &task->run->request.selection : &task->options->request.selection;
}

static int close_folder(lua_State *L)
{
    DIR **folder = lua_touserdata(L, 1);
    if (*folder)
        closedir(*folder);
    *folder = NULL;
    return 0;
}

// entries(folder): returns the names in a folder; nil and the reason if it cannot be read.
static int entries(lua_State *L)
{
    const char *path = luaL_checkstring(L, 1);
    DIR **folder = glintL_push_owner(L, sizeof *folder, "glint.folder", close_folder);
    lua_newtable(L);
    *folder = opendir(path);
    if (!*folder) {
        lua_pushnil(L);
        lua_pushstring(L, strerror(errno));
        return 2;
    }
    lua_Integer count = 0;
    for (struct dirent *entry; (entry = readdir(*folder));) {
        lua_pushstring(L, entry->d_name);
        lua_rawseti(L, -2, ++count);
    }
    return 1;
}

// name_file(pattern, number): returns the name of a frame's file; nil if it has none.
static int name_file(lua_State *L)
{
    char path[GLINTL_PATH_SIZE];
    const glintL_naming naming = { .pattern = luaL_checkstring(L, 1) };
    const lua_Integer number = luaL_checkinteger(L, 2);
    if (number > GLINTL_FRAMES_MAX || !glintL_name_file(&naming, number, "beauty", path))
        return 0;
    lua_pushstring(L, path);
    return 1;
}

// is_pattern(word): returns whether the word has a number pattern.
static int is_pattern(lua_State *L)
{
    char message[GLINTL_MESSAGE_SIZE];
    const char *word = luaL_checkstring(L, 1);
    lua_pushboolean(L, glintL_name_check(word, message) && !glintL_name_is_special(word) && glintL_name_has_number(word));
    return 1;
}

// identify(path): returns a text that identifies the file, and whether it is a regular file; nil if it does not exist.
static int identify(lua_State *L)
{
    struct stat info;
    if (!lua_isstring(L, 1) || stat(lua_tostring(L, 1), &info) != 0)
        return 0;
    lua_pushfstring(L, "%I:%I", (LUAI_UACINT)info.st_dev, (LUAI_UACINT)info.st_ino);
    lua_pushboolean(L, S_ISREG(info.st_mode));
    return 2;
}

// ranges(): returns the ranges of --frames, and the highest number of a frame.
static int ranges(lua_State *L)
{
    const glintL_selection *selection = selection_of(L);
    lua_newtable(L);
    for (size_t i = 0; i < selection->range_count; i++) {
        lua_newtable(L);
        glintL_set_whole(L, "first", selection->ranges[i].first);
        glintL_set_whole(L, "last", selection->ranges[i].last);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_pushinteger(L, GLINTL_FRAMES_MAX);
    return 2;
}

static int is_selected(lua_State *L)
{
    lua_pushboolean(L, glintL_selection_has(selection_of(L), luaL_checkinteger(L, 1)));
    return 1;
}

const luaL_Reg cli_files_functions[] = {
    { "entries", entries }, { "name_file", name_file }, { "is_pattern", is_pattern },   { "identify", identify },
    { "ranges", ranges },   { "is_selected", is_selected }, { NULL, NULL },
};

char **cli_push_files(lua_State *L, int index, size_t *count)
{
    index = lua_absindex(L, index);
    *count = (size_t)luaL_len(L, index);
    char **files = lua_newuserdatauv(L, (*count + 1) * sizeof *files, 0);
    for (size_t i = 0; i < *count; i++) {
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        files[i] = (char *)(uintptr_t)luaL_checkstring(L, -1); // read only
        lua_pop(L, 1);
    }
    return files;
}

static int close_picture(lua_State *L)
{
    glint_picture **picture = lua_touserdata(L, 1);
    glint_picture_destroy(*picture);
    *picture = NULL;
    return 0;
}

glint_picture *cli_push_picture(lua_State *L, const char *path, bool has_pixels, glint_error *error)
{
    glint_picture **picture = glintL_push_owner(L, sizeof *picture, "glint.picture", close_picture);
    return glint_picture_read(path, has_pixels, picture, error) ? NULL : *picture;
}

// text(picture, keyword): returns a text entry of a picture, or nil.
int cli_picture_text(lua_State *L)
{
    glint_picture *const *picture = luaL_checkudata(L, 1, "glint.picture");
    lua_pushstring(L, glint_picture_text(*picture, luaL_checkstring(L, 2)));
    return 1;
}
