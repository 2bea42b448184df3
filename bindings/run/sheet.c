// Contact sheets: reads the files, draws a sheet and writes a page, for the modules sheet.lua and the like, which choose
// its labels, columns and heads.
#include <errno.h>
#include <string.h>

#include "bindings/run/carried.h"
#include "bindings/run/sheet.h"
#include "bindings/run/system.h"
#include "engine/glint_figures.h"

#define PICTURE "glint.sheet picture"
#define PIECE 24576 // bytes of a file; a multiple of three, so that only the last piece of base64 is padded

static const char PAGE[] = {
#include "bindings/run/sheet.html.h"
};
static const char FORMULA[] = {
#include "bindings/web/pages/formula.js.h"
};

// Pushes the exit code of a status, and its message unless it is GLINT_OK.
static int push_outcome(lua_State *L, glint_status status, const glint_error *error)
{
    lua_pushinteger(L, glintL_run_exit_code(status));
    lua_pushstring(L, status ? error->message : NULL);
    return 2;
}

// ---- Reading ----

static int drop_picture(lua_State *L)
{
    glint_picture **picture = lua_touserdata(L, 1);
    glint_picture_destroy(*picture);
    *picture = NULL;
    return 0;
}

// read_picture(path): returns the size, the bits and the texts of a picture; nil, the exit code and a message if there
// is none.
static int read_picture(lua_State *L)
{
    static const char *const texts[] = { "sweep", "names", "params", "options", "pass", "frame" };
    char keyword[32];
    glint_error error;
    lua_settop(L, 1);
    lua_createtable(L, 0, 10);
    glint_picture **picture = glintL_push_owner(L, sizeof *picture, PICTURE, drop_picture);
    const glint_status status = glint_picture_read(luaL_checkstring(L, 1), false, picture, &error);
    if (status) {
        lua_pushnil(L);
        push_outcome(L, status, &error);
        if (glintL_other_kind(lua_tostring(L, 1))) {
            lua_pushinteger(L, GLINTL_EXIT_USAGE);
            lua_replace(L, -3);
        }
        return 3;
    }
    lua_setfield(L, 2, "picture");
    glintL_set_whole(L, "width", glint_picture_width(*picture));
    glintL_set_whole(L, "height", glint_picture_height(*picture));
    glintL_set_whole(L, "bits", glint_picture_bits(*picture));
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        snprintf(keyword, sizeof keyword, "glint:%s", texts[i]);
        glintL_set_text(L, texts[i], glint_picture_text(*picture, keyword));
    }
    return 1;
}

static const glint_picture *check_picture(lua_State *L, int index)
{
    lua_getfield(L, index, "picture");
    return *(glint_picture **)luaL_checkudata(L, -1, PICTURE);
}

// match_pictures(a, a_path, b, b_path): returns a message if the pictures come from different scripts.
static int match_pictures(lua_State *L)
{
    char message[GLINTL_MESSAGE_SIZE];
    const glint_picture *a = check_picture(L, 1), *b = check_picture(L, 3);
    if (glintL_provenance_match(a, luaL_checkstring(L, 2), b, luaL_checkstring(L, 4), false, message))
        return 0;
    lua_pushstring(L, message);
    return 1;
}

// ---- Drawing ----

// The values of a field of the table at 1; the table retains a text.
static double number_of(lua_State *L, const char *name)
{
    lua_getfield(L, 1, name);
    const double number = lua_tonumber(L, -1);
    lua_pop(L, 1);
    return number;
}

static const char *text_of(lua_State *L, const char *name)
{
    lua_getfield(L, 1, name);
    const char *text = lua_tostring(L, -1);
    lua_pop(L, 1);
    return text;
}

// Pushes a list of texts, which the field's list retains; NULL: there is no such field.
static const char **push_texts(lua_State *L, const char *name)
{
    luaL_checkstack(L, 4, "sheet");
    if (lua_getfield(L, 1, name) != LUA_TTABLE)
        return NULL;
    const size_t count = lua_rawlen(L, -1);
    const char **texts = lua_newuserdatauv(L, (count + 1) * sizeof *texts, 0);
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, -2, (lua_Integer)i + 1);
        texts[i] = lua_tostring(L, -1);
        lua_pop(L, 1);
    }
    return texts;
}

static const glint_overlay_desc *colorbar_of(lua_State *L)
{
    lua_getfield(L, 1, "colorbar");
    const glint_overlay *bar = glintL_test_object(L, -1, GLINTL_OVERLAY);
    const glint_overlay_desc *desc = bar ? glint_overlay_get(bar) : lua_islightuserdata(L, -1) ? lua_touserdata(L, -1) : NULL;
    lua_pop(L, 1);
    return desc;
}

// draw_sheet(drawing): draws a sheet from the fields of glint_sheet_desc. Returns the exit code and a message.
static int draw_sheet(lua_State *L)
{
    glint_error error;
    const char **files = push_texts(L, "files"), **labels = push_texts(L, "labels");
    lua_getfield(L, 1, "files");
    const size_t count = lua_rawlen(L, -1);
    glint_sheet_cell *cells = lua_newuserdatauv(L, count * sizeof *cells, 0);
    for (size_t i = 0; i < count; i++)
        cells[i] = (glint_sheet_cell) { files[i], labels[i] };
    lua_getfield(L, 1, "transparent");
    const bool is_transparent = lua_toboolean(L, -1);
    const glint_sheet_desc desc = { .struct_size = sizeof(glint_sheet_desc),
        .cells = cells, .cell_count = count, .columns = (int)number_of(L, "columns"), .title = text_of(L, "title"),
        .across = text_of(L, "across"), .down = text_of(L, "down"), .column_heads = push_texts(L, "column_heads"),
        .row_heads = push_texts(L, "row_heads"), .block_heads = push_texts(L, "block_heads"),
        .block_rows = (int)number_of(L, "block_rows"), .difference = (size_t)number_of(L, "difference"),
        .gain = number_of(L, "gain"), .size = number_of(L, "size"), .dpi = number_of(L, "dpi"),
        .transparent = is_transparent, .colorbar = colorbar_of(L),
    };
    return push_outcome(L, glint_sheet_write(&desc, text_of(L, "path"), &error), &error);
}

// ---- The page ----

static int page_of_sheets(lua_State *L)
{
    lua_pushlstring(L, PAGE, sizeof PAGE);
    return 1;
}

static int formula_source(lua_State *L)
{
    lua_pushlstring(L, FORMULA, sizeof FORMULA);
    return 1;
}

// formula_commands(): returns a list of { name, text, kind } for the commands of formulas.
static int formula_commands(lua_State *L)
{
    const char *name, *text, *kind;
    lua_newtable(L);
    for (size_t i = 0; (name = glint_formula_command(i, &text, &kind)) != NULL; i++) {
        lua_createtable(L, 0, 3);
        glintL_set_text(L, "name", name);
        glintL_set_text(L, "text", text);
        glintL_set_text(L, "kind", kind);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

static glint_status append_text(glint_draft *draft, const char *text, glint_error *error)
{
    return glint_draft_append(draft, text, strlen(text), error);
}

static glint_status append_file(glint_draft *draft, const char *path, glint_error *error)
{
    uint8_t bytes[PIECE];
    char text[PIECE / 3 * 4];
    FILE *file = fopen(path, "rb");
    size_t size = 0;
    glint_status status = append_text(draft, "\"data:image/png;base64,", error);
    while (file && !status && (size = fread(bytes, 1, PIECE, file)) > 0)
        status = glint_draft_append(draft, text, glintL_base64(bytes, size, text), error);
    if (!file || (!status && ferror(file))) {
        snprintf(error->message, sizeof error->message, "%.300s: %s", path, strerror(errno));
        status = GLINT_ERR_IO;
    }
    if (file)
        fclose(file);
    return status ? status : append_text(draft, "\",\n", error);
}

// write_page(path, head, files, tail): writes a page with the pictures between two texts. Returns the exit code and a
// message.
static int write_page(lua_State *L)
{
    glint_draft *draft = NULL;
    glint_error error;
    glint_status status = glint_draft_create(luaL_checkstring(L, 1), &draft, &error);
    if (!status)
        status = append_text(draft, lua_tostring(L, 2), &error);
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, 3) && !status; i++) {
        lua_rawgeti(L, 3, i);
        status = append_file(draft, lua_tostring(L, -1), &error);
        lua_pop(L, 1);
    }
    if (!status)
        status = append_text(draft, lua_tostring(L, 4), &error);
    if (!status)
        status = glint_draft_finish(draft, &error);
    glint_draft_destroy(draft);
    return push_outcome(L, status, &error);
}

const luaL_Reg glintL_sheet_functions[] = {
    { "read_picture", read_picture }, { "match_pictures", match_pictures }, { "draw_sheet", draw_sheet },
    { "page_of_sheets", page_of_sheets }, { "write_page", write_page },
    { "formula_source", formula_source }, { "formula_commands", formula_commands }, { NULL, NULL },
};

int glintL_sheet_make(lua_State *L, char message[GLINTL_MESSAGE_SIZE])
{
    glintL_add_own(L, glintL_sheet_functions);
    glintL_call_own(L, "sheet", "make", 1, 2);
    const int code = (int)lua_tointeger(L, -2);
    snprintf(message, GLINTL_MESSAGE_SIZE, "%s", lua_isnil(L, -1) ? "" : lua_tostring(L, -1));
    lua_pop(L, 2);
    return code;
}
