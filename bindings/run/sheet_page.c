// A sheet as one HTML page: a slider for each axis, with the pictures as data URIs. It needs no other files.
#include <errno.h>
#include <string.h>

#include "bindings/run/carried.h"
#include "bindings/run/sheet.h"

static const char PAGE[] = {
#include "bindings/run/sheet.html.h"
};
static const unsigned char SHEET_LUA[] = {
#include "bindings/run/sheet.lua.h"
};
static const glintL_carried MODULE = { "@sheet.lua", SHEET_LUA, sizeof SHEET_LUA };

// ---- The data of the page, for the Lua module ----

typedef struct content {
    const glintL_sheet *sheet;
    const glintL_axes *axes;
    char *const *labels;
} content;

static void push_axis(lua_State *L, const glintL_sheet *sheet, const glintL_axis *axis)
{
    char spelt[GLINTL_AXIS_SIZE];
    glintL_axis_title(sheet, axis, spelt);
    lua_createtable(L, 0, 2);
    glintL_set_text(L, "name", spelt);
    lua_newtable(L);
    for (size_t i = 0; i < axis->count; i++) {
        glintL_axis_spell(sheet, axis, i, spelt);
        lua_pushstring(L, spelt);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "values");
}

static void push_content(lua_State *L, const void *context)
{
    const content *page_content = context;
    const glintL_sheet *sheet = page_content->sheet;
    lua_newtable(L);
    lua_pushlstring(L, PAGE, sizeof PAGE);
    lua_setfield(L, -2, "page");
    glintL_set_text(L, "version", GLINT_VERSION);
    glintL_set_text(L, "title", sheet->title);
    glintL_set_text(L, "live", sheet->live);
    glintL_set_whole(L, "difference", sheet->difference);
    glintL_set_number(L, "gain", sheet->gain > 0 ? sheet->gain : 8);
    if (page_content->axes->is_grid) {
        lua_newtable(L);
        for (size_t a = 0; a < page_content->axes->count; a++) {
            push_axis(L, sheet, &page_content->axes->axis[a]);
            lua_rawseti(L, -2, (lua_Integer)a + 1);
        }
        lua_setfield(L, -2, "axes");
    }
    lua_newtable(L);
    for (size_t i = 0; i < sheet->count; i++) {
        lua_pushstring(L, page_content->labels[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "labels");
}

// ---- Pictures ----

#define PIECE 24576 // bytes; a multiple of three, so that only the last piece is padded

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
    glint_status status = GLINT_OK;
    while (file && !status && (size = fread(bytes, 1, PIECE, file)) > 0)
        status = glint_draft_append(draft, text, glintL_base64(bytes, size, text), error);
    if (!file || (!status && ferror(file))) {
        snprintf(error->message, sizeof error->message, "%.300s: %s", path, strerror(errno));
        status = GLINT_ERR_IO;
    }
    if (file)
        fclose(file);
    return status;
}

// Writes the page, with the pictures at its zero byte.
static glint_status append_page(glint_draft *draft, const glintL_sheet *sheet, const glintL_made_text *page,
                                glint_error *error)
{
    const size_t head = strlen(page->text);
    glint_status status = glint_draft_append(draft, page->text, head, error);
    for (size_t i = 0; i < sheet->count && !status; i++) {
        status = append_text(draft, "\"data:image/png;base64,", error);
        if (!status)
            status = append_file(draft, sheet->files[i], error);
        if (!status)
            status = append_text(draft, "\",\n", error);
    }
    if (!status)
        status = glint_draft_append(draft, page->text + head + 1, page->size - head - 1, error);
    return status ? status : glint_draft_finish(draft, error);
}

int glintL_sheet_page(const glintL_sheet *sheet, const glintL_axes *axes, char *const *labels,
                      char message[GLINTL_MESSAGE_SIZE])
{
    glint_draft *draft = NULL;
    glint_error error;
    glintL_made_text page;
    content page_content = { sheet, axes, labels };
    for (size_t i = 0; i < sheet->count; i++)
        if (glint_picture_bits(axes->pictures[i]) > 16) {
            snprintf(message, GLINTL_MESSAGE_SIZE, "%.300s: a page shows only .png files", sheet->files[i]);
            return GLINTL_EXIT_USAGE;
        }
    glint_status status = GLINT_ERR_NOMEM;
    if (glintL_make_text(&MODULE, 1, "sheet", push_content, &page_content, &page, message)) {
        status = glint_draft_create(sheet->path, &draft, &error);
        if (!status)
            status = append_page(draft, sheet, &page, &error);
        if (status)
            snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
    }
    glint_draft_destroy(draft);
    glintL_drop_text(&page);
    return glintL_run_exit_code(status);
}
