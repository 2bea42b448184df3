// glint._row_reader: reads rows of text into arrays. Only for scripts/lib.
#include <string.h>

#include "bindings/lua/lua.h"
#include "engine/glint_data.h"

#define READER "glint.rows"
#define COLUMNS_MAX 64

typedef struct reader {
    glint_rows_desc desc;
    glint_words *words; // of all columns of words
    bool checks; // the fields are only checked
    size_t count;
    glint_column columns[COLUMNS_MAX];
} reader;

static int close_reader(lua_State *L)
{
    reader *r = lua_touserdata(L, 1);
    glint_words_destroy(r->words);
    r->words = NULL;
    return 0;
}

static lua_Integer field_of(lua_State *L, int index, const char *name)
{
    lua_getfield(L, index, name);
    const lua_Integer value = luaL_optinteger(L, -1, 0);
    lua_pop(L, 1);
    return value;
}

static bool flag_of(lua_State *L, int index, const char *name)
{
    lua_getfield(L, index, name);
    const bool value = lua_toboolean(L, -1);
    lua_pop(L, 1);
    return value;
}

static void add_column(lua_State *L, reader *r)
{
    static const char *const kinds[] = { "number", "size", "value", "word", NULL };
    luaL_checktype(L, -1, LUA_TTABLE);
    const lua_Integer field = field_of(L, -1, "field"), width = field_of(L, -1, "width");
    r->desc.is_fixed = width > 0;
    lua_getfield(L, -1, "kind");
    const int kind = luaL_checkoption(L, -1, NULL, kinds);
    lua_pop(L, 1);
    luaL_argcheck(L, r->count < COLUMNS_MAX, 1, "too many columns");
    luaL_argcheck(L, field >= 1 && (r->count == 0 || (size_t)field > r->columns[r->count - 1].field), 1, "columns in order");
    r->columns[r->count++] =
        (glint_column) { .field = (size_t)field - 1, .width = (size_t)width, .kind = (glint_column_kind)kind, .words = r->words };
}

// With a width, a column has a fixed position: field is its first byte.
// _row_reader { columns = { { field = 1, kind = "word" }, ... }, fields = 6, separator = ",", skips = true, checks = true }
static int new_reader(lua_State *L)
{
    glint_error error;
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_settop(L, 1);
    reader *r = lua_newuserdatauv(L, sizeof *r, 0);
    *r = (reader) { .checks = flag_of(L, 1, "checks") };
    luaL_setmetatable(L, READER);
    glintL_check_status(L, "rows", &error, glint_words_create(&r->words, &error));
    lua_getfield(L, 1, "separator");
    const char *separator = lua_tostring(L, -1);
    r->desc = (glint_rows_desc) { .separator = (char)(separator && *separator != ' ' ? *separator : 0),
                                  .field_count = (size_t)field_of(L, 1, "fields"), .skips = flag_of(L, 1, "skips"),
                                  .columns = r->columns, .threads = glintL_get_run(L)->request.threads };
    lua_getfield(L, 1, "columns");
    luaL_checktype(L, -1, LUA_TTABLE);
    for (lua_Integer i = 1; lua_rawgeti(L, -1, i) != LUA_TNIL; i++, lua_pop(L, 1))
        add_column(L, r);
    r->desc.column_count = r->count;
    lua_settop(L, 2);
    return 1;
}

// learn(word, number): from now on, the word is read as this number.
static int learn(lua_State *L)
{
    size_t length;
    glint_error error;
    reader *r = luaL_checkudata(L, 1, READER);
    const char *word = luaL_checklstring(L, 2, &length);
    const lua_Integer number = luaL_checkinteger(L, 3);
    luaL_argcheck(L, number >= 0 && number <= UINT32_MAX, 3, "number of a word");
    lua_pushboolean(L, glint_words_add(r->words, word, length, (uint32_t)number, &error) == GLINT_OK);
    return 1;
}

// Returns the number of lines, at most `most`, and the bytes that they take.
static size_t count_lines(const char *text, size_t length, size_t most, size_t *bytes)
{
    const char *at = text, *newline;
    size_t count = 0;
    while (count < most && (newline = memchr(at, '\n', length - (size_t)(at - text)))) {
        count++;
        at = newline + 1;
    }
    *bytes = (size_t)(at - text);
    return count;
}

// read(text, at, most): returns the position after the rows, their number, the number of lines, whether the next line
// was refused, and an array for each column. Reads at most `most` lines.
static int read_rows(lua_State *L)
{
    size_t length, used, lines, bytes;
    reader *r = luaL_checkudata(L, 1, READER);
    const char *text = luaL_checklstring(L, 2, &length);
    const lua_Integer at = luaL_checkinteger(L, 3), most = luaL_checkinteger(L, 4);
    luaL_argcheck(L, at >= 1 && (size_t)at <= length + 1, 3, "position in the text");
    lua_settop(L, 3);
    text += at - 1;
    length -= (size_t)at - 1;
    const size_t rows_max = count_lines(text, length, most > 0 ? (size_t)most : 0, &bytes);
    luaL_checkstack(L, COLUMNS_MAX + 4, "columns");
    for (size_t c = 0; c < r->count && !r->checks; c++) {
        const bool is_word = r->columns[c].kind == GLINT_COLUMN_WORD;
        const glintL_array *array = glintL_push_array(L, rows_max, 1, is_word);
        r->columns[c].numbers = array->numbers;
        r->columns[c].indices = is_word ? array->wholes : NULL;
    }
    const size_t rows = glint_rows_read(&r->desc, text, bytes, rows_max, &used, &lines);
    for (size_t c = 0; c < r->count && !r->checks; c++)
        glintL_to_array(L, 4 + (int)c)->count = rows;
    lua_pushinteger(L, at + (lua_Integer)used);
    lua_pushinteger(L, (lua_Integer)rows);
    lua_pushinteger(L, (lua_Integer)lines);
    lua_pushboolean(L, used < bytes);
    lua_rotate(L, 4, 4);
    return lua_gettop(L) - 3;
}

void glintL_open_rows(lua_State *L)
{
    static const luaL_Reg methods[] = { { "learn", learn }, { "read", read_rows }, { NULL, NULL } };
    luaL_newmetatable(L, READER);
    glintL_set_function(L, "__gc", close_reader);
    luaL_newlib(L, methods);
    lua_setfield(L, -2, "__index");
    lua_pop(L, 1);
    glintL_set_function(L, "_row_reader", new_reader);
}
