// glint join PARTS -o PICTURE: joins pictures rendered with --region into the whole frame. The Lua module checks the
// parts' texts.
#include "bindings/command/cli.h"

static const unsigned char JOIN_LUA[] = {
#include "bindings/command/join.lua.h"
};

// read(path): returns a part's picture, with its width and height.
static int read_picture(lua_State *L)
{
    glint_error error;
    const glint_picture *picture = cli_push_picture(L, luaL_checkstring(L, 1), true, &error);
    if (!picture)
        return cli_task_fail(L, GLINTL_EXIT_USAGE, error.message);
    lua_pushinteger(L, glint_picture_width(picture));
    lua_pushinteger(L, glint_picture_height(picture));
    return 3;
}

// region(text): returns x, y, width and height; nothing if the text is not a region.
static int region(lua_State *L)
{
    glintL_render scratch = glintL_render_default();
    char message[GLINTL_MESSAGE_SIZE];
    if (!glintL_render_set_text(&scratch, glintL_render_find("region"), luaL_checkstring(L, 1), message))
        return 0;
    for (int i = 0; i < 4; i++)
        lua_pushinteger(L, (lua_Integer)scratch.desc.region[i]);
    return 4;
}

// set_option(name, text): sets a render option of the whole frame. Options without effect here are ignored.
static int set_option(lua_State *L)
{
    char message[GLINTL_MESSAGE_SIZE];
    const int field = glintL_render_find(luaL_checkstring(L, 1));
    if (field >= 0)
        glintL_render_set_text(cli_task_of(L)->own, field, luaL_checkstring(L, 2), message);
    return 0;
}

static glint_picture_part *push_parts(lua_State *L, size_t count)
{
    glint_picture_part *parts = lua_newuserdatauv(L, count * sizeof *parts, 0);
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, 1, (lua_Integer)i + 1);
        lua_getfield(L, -1, "picture");
        lua_getfield(L, -2, "x");
        lua_getfield(L, -3, "y");
        parts[i] = (glint_picture_part) { *(glint_picture **)lua_touserdata(L, -3), (int)lua_tointeger(L, -2),
                                          (int)lua_tointeger(L, -1) };
        lua_pop(L, 4);
    }
    return parts;
}

static glint_text *push_texts(lua_State *L, size_t count)
{
    glint_text *texts = lua_newuserdatauv(L, count * sizeof *texts, 0);
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, 2, (lua_Integer)i + 1);
        lua_rawgeti(L, -1, 1);
        lua_rawgeti(L, -2, 2);
        texts[i] = (glint_text) { lua_tostring(L, -2), lua_tostring(L, -1) };
        lua_pop(L, 3);
    }
    return texts;
}

// join(parts, texts, is_linear): writes the whole frame. Returns the exit code and the reason if it cannot.
static int join(lua_State *L)
{
    const cli_task *task = cli_task_of(L);
    const glintL_render *render = task->own;
    const size_t count = (size_t)luaL_len(L, 1), text_count = (size_t)luaL_len(L, 2);
    glint_error error;
    glint_write_desc desc = { .struct_size = sizeof(glint_write_desc),
        .path = task->options->output, .encode = render->encode, .dpi = render->dpi, .tone = render->desc.tone,
        .text = push_texts(L, text_count), .text_count = text_count,
    };
    if (lua_toboolean(L, 3))
        desc.tone.transfer = GLINT_TRANSFER_LINEAR;
    const glint_status status = glint_picture_join(push_parts(L, count), count, (int)render->desc.width,
                                                   (int)render->desc.height, &desc, &error);
    if (!status)
        return 0;
    lua_pushinteger(L, glintL_run_exit_code(status));
    lua_pushstring(L, error.message);
    return 2;
}

int cli_join(cli_options *options, cli_output *output, glintL_run *run)
{
    static const luaL_Reg functions[] = {
        { "read", read_picture },       { "text", cli_picture_text }, { "region", region },
        { "set_option", set_option }, { "join", join },             { NULL, NULL },
    };
    const glintL_carried modules[] = { cli_files_module, { "@join.lua", JOIN_LUA, sizeof JOIN_LUA } };
    glintL_render render = glintL_render_default();
    cli_task task = { "join", options, output, run, functions, &render, 0 };
    return cli_run_module(&task, modules, 2);
}
