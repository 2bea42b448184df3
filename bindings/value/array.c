// glint.array: a block of numbers. Its rows have one number or several.
#include <stdint.h>
#include <string.h>

#include "bindings/value/array.h"

#define NUMBERS_MAX ((uint64_t)1 << 36) // half a terabyte: a request for more is a mistake

glintL_array *glintL_to_array(lua_State *L, int index) { return luaL_testudata(L, index, GLINTL_ARRAY); }

glintL_array *glintL_push_array(lua_State *L, size_t count, size_t width, bool is_whole)
{
    const uint64_t space = (SIZE_MAX / 2 - sizeof(glintL_array)) / sizeof(double);
    if (count > (space < NUMBERS_MAX ? space : NUMBERS_MAX) / width)
        glintL_error(L, "array: out of memory");
    luaL_checkstack(L, 2, "array");
    glintL_array *a = lua_newuserdatauv(L, sizeof *a + count * width * sizeof *a->numbers, 0);
    a->count = count;
    a->width = (uint32_t)width;
    a->is_whole = is_whole;
    a->numbers = (double *)(a + 1);
    a->wholes = (int64_t *)(a + 1);
    luaL_setmetatable(L, GLINTL_ARRAY);
    return a;
}

glintL_array *glintL_check_array(lua_State *L)
{
    glintL_array *a = glintL_to_array(L, 1);
    if (!a) {
        const char *got = glintL_push_spelling(L, 1);
        glintL_error(L, "array expected, got %s%s", got, glintL_push_colon_cure(L, 1));
    }
    return a;
}

// ---- Making ----

// Reads the number on top of the stack into number i, and pops it. Messages name it path[row].
static void take_number(lua_State *L, glintL_array *a, size_t i, const char *path, size_t row, const char *what)
{
    int is_whole = lua_type(L, -1) == LUA_TNUMBER;
    if (is_whole && a->is_whole)
        a->wholes[i] = lua_tointegerx(L, -1, &is_whole);
    else if (is_whole)
        a->numbers[i] = lua_tonumber(L, -1);
    if (!is_whole) {
        const int index = lua_gettop(L);
        const char *full = lua_pushfstring(L, "%s[%I]", path, (LUAI_UACINT)row + 1);
        if (!a->is_whole)
            glintL_read_number(L, index, full); // has a message for numbers with derivatives
        glintL_refuse(L, index, full, what);
    }
    lua_pop(L, 1);
}

static const char *name_of(bool is_whole) { return is_whole ? "whole number" : "number"; }

glintL_array *glintL_take_list(lua_State *L, int index, const glintL_numbers *numbers, size_t count)
{
    glintL_array *a = glintL_push_array(L, count, 1, numbers->is_whole);
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        take_number(L, a, i, numbers->path, numbers->per ? i / numbers->per : i,
                    numbers->what ? numbers->what : name_of(a->is_whole));
    }
    lua_replace(L, index);
    return a;
}

glintL_array *glintL_take_packed(lua_State *L, int index, char format)
{
    size_t bytes;
    const char *at = lua_tolstring(L, index, &bytes);
    const size_t size = format == 'd' ? sizeof(double) : sizeof(float);
    glintL_array *a = glintL_push_array(L, bytes / size, 1, format == 'u');
    for (size_t i = 0; i < a->count; i++, at += size) {
        float f;
        uint32_t u;
        memcpy(format == 'd' ? (void *)&a->numbers[i] : format == 'f' ? (void *)&f : (void *)&u, at, size);
        if (format == 'f')
            a->numbers[i] = f;
        else if (format == 'u')
            a->wholes[i] = u;
    }
    lua_replace(L, index);
    return a;
}

// Reads a row of several numbers on top of the stack, and pops it: a vector, or a list.
static void take_row(lua_State *L, glintL_array *a, size_t row)
{
    const double *v = glintL_to_vector(L, -1);
    if (!(v && a->width == 3) && !(lua_istable(L, -1) && lua_rawlen(L, -1) == a->width)) {
        const char *got = glintL_push_spelling(L, -1);
        glintL_error(L, "array[%I]: %I numbers expected, got %s", (LUAI_UACINT)row + 1, (LUAI_UACINT)a->width, got);
    }
    for (lua_Integer c = 0; c < a->width; c++) {
        if (v)
            lua_pushnumber(L, v[c]);
        else
            lua_rawgeti(L, -1, c + 1);
        take_number(L, a, row * a->width + (size_t)c, "array", row, name_of(a->is_whole));
    }
    lua_pop(L, 1);
}

// Makes an array whose columns are the arrays in the list at 1.
static void join_columns(lua_State *L, size_t width)
{
    size_t count = 0;
    bool is_whole = true;
    for (size_t c = 0; c < width; c++, lua_pop(L, 1)) {
        lua_rawgeti(L, 1, (lua_Integer)c + 1);
        const glintL_array *next = glintL_to_array(L, -1);
        if (!next || next->width != 1 || (c > 0 && next->count != count)) {
            const char *got = glintL_push_spelling(L, -1);
            glintL_error(L, "array[%I]: array of one column and as many rows as the first expected, got %s",
                         (LUAI_UACINT)c + 1, got);
        } else {
            count = next->count;
            is_whole = is_whole && next->is_whole;
        }
    }
    if (width > WIDTH_MAX)
        glintL_error(L, "array: at most %d columns expected, got %I", WIDTH_MAX, (LUAI_UACINT)width);
    glintL_array *a = glintL_push_array(L, count, width, is_whole);
    for (size_t c = 0; c < width; c++, lua_pop(L, 1)) {
        lua_rawgeti(L, 1, (lua_Integer)c + 1);
        const glintL_array *column = glintL_to_array(L, -1);
        for (size_t i = 0; i < count; i++) {
            if (is_whole)
                a->wholes[i * width + c] = column->wholes[i];
            else
                a->numbers[i * width + c] = number_at(column, i);
        }
    }
}

static void read_list(lua_State *L, bool is_whole)
{
    const size_t count = glintL_check_list(L, 1, "array", false);
    size_t width = 1;
    if (count > 0) {
        lua_rawgeti(L, 1, 1);
        if (glintL_to_array(L, -1)) {
            join_columns(L, count);
            return;
        }
        width = glintL_to_vector(L, -1) ? 3 : lua_istable(L, -1) ? lua_rawlen(L, -1) : 1;
        lua_pop(L, 1);
    }
    if (width < 1 || width > WIDTH_MAX)
        glintL_error(L, "array[1]: 1 to %d numbers expected, got %I", WIDTH_MAX, (LUAI_UACINT)width);
    if (width == 1) {
        glintL_take_list(L, 1, &(glintL_numbers) { .path = "array", .is_whole = is_whole }, count);
        lua_settop(L, 1);
        return;
    }
    glintL_array *a = glintL_push_array(L, count, width, is_whole);
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, 1, (lua_Integer)i + 1);
        take_row(L, a, i);
    }
}

// glint.array(list | count, kind): count rows of 0.
static int new_array(lua_State *L)
{
    static const char *const kinds[] = { "number", "integer", NULL };
    static const glintL_field field = { .name = "kind", .type = GLINT_TYPE_CHOICE, .names = kinds };
    unsigned kind = 0;
    lua_settop(L, 2);
    if (!lua_isnil(L, 2))
        glintL_read_field(L, 2, "array", &field, &kind);
    if (lua_istable(L, 1)) {
        read_list(L, kind == 1);
    } else if (lua_isinteger(L, 1) && lua_tointeger(L, 1) >= 0) {
        glintL_array *a = glintL_push_array(L, (size_t)lua_tointeger(L, 1), 1, kind == 1);
        memset(a->numbers, 0, a->count * sizeof *a->numbers);
    } else
        glintL_refuse(L, 1, "array", "list of numbers, rows or arrays, or a whole number >= 0,");
    return 1;
}

// _join(list, width, single): the numbers of all arrays of the list, one after the other, in rows of `width`; rounded to
// single precision if `single`. Only for scripts/lib.
static int join(lua_State *L)
{
    size_t count = 0, at = 0;
    bool is_whole = false;
    luaL_checktype(L, 1, LUA_TTABLE);
    const lua_Integer parts = (lua_Integer)lua_rawlen(L, 1), width = luaL_checkinteger(L, 2);
    const bool is_single = lua_toboolean(L, 3);
    for (lua_Integer i = 1; i <= parts; i++, lua_pop(L, 1)) {
        lua_rawgeti(L, 1, i);
        const glintL_array *part = glintL_to_array(L, -1);
        luaL_argcheck(L, part && (i == 1 || part->is_whole == is_whole), 1, "arrays of one kind");
        count += part->count * part->width;
        is_whole = part->is_whole;
    }
    luaL_argcheck(L, width > 0 && count % (size_t)width == 0, 2, "width of the rows");
    glintL_array *a = glintL_push_array(L, count / (size_t)width, (size_t)width, is_whole);
    for (lua_Integer i = 1; i <= parts; i++, lua_pop(L, 1)) {
        lua_rawgeti(L, 1, i);
        const glintL_array *part = glintL_to_array(L, -1);
        memcpy(a->numbers + at, part->numbers, part->count * part->width * sizeof *a->numbers);
        at += part->count * part->width;
    }
    for (size_t i = 0; i < count && is_single; i++)
        a->numbers[i] = (double)(float)a->numbers[i];
    return 1;
}

// ---- Reading and writing ----

void glintL_push_element(lua_State *L, const glintL_array *a, size_t i)
{
    if (a->is_whole)
        lua_pushinteger(L, a->wholes[i]);
    else
        lua_pushnumber(L, a->numbers[i]);
}

static void push_row(lua_State *L, const glintL_array *a, size_t row)
{
    if (a->width == 3 && !a->is_whole) {
        glintL_push_vector(L, a->numbers + 3 * row);
        return;
    }
    if (a->width > 1)
        lua_createtable(L, (int)a->width, 0);
    for (size_t c = 0; c < a->width; c++) {
        glintL_push_element(L, a, row * a->width + c);
        if (a->width > 1)
            lua_rawseti(L, -2, (lua_Integer)c + 1);
    }
}

// Returns the row that is named at `index`, from 0. One beyond the last is allowed if `ends`.
static size_t check_row(lua_State *L, const glintL_array *a, int index, bool ends)
{
    const lua_Integer i = lua_tointeger(L, index);
    if (!lua_isinteger(L, index) || i < 1 || (size_t)i > a->count + ends) {
        const char *got = glintL_push_spelling(L, index);
        glintL_error(L, "array: row 1 .. %I expected, got %s", (LUAI_UACINT)a->count, got);
    }
    return (size_t)i - 1;
}

static void push_column(lua_State *L, const glintL_array *a, size_t column)
{
    glintL_array *out = glintL_push_array(L, a->count, 1, a->is_whole);
    for (size_t i = 0; i < a->count; i++)
        memcpy(out->numbers + i, a->numbers + i * a->width + column, sizeof *a->numbers);
}

static int column(lua_State *L)
{
    const glintL_array *a = glintL_check_array(L);
    const lua_Integer c = lua_tointeger(L, 2);
    if (!lua_isinteger(L, 2) || c < 1 || (size_t)c > a->width)
        glintL_error(L, "array.column: number 1 .. %I expected, got %s", (LUAI_UACINT)a->width, glintL_push_spelling(L, 2));
    push_column(L, a, (size_t)c - 1);
    return 1;
}

static int read_member(lua_State *L)
{
    const glintL_array *a = glintL_check_array(L);
    if (lua_type(L, 2) != LUA_TSTRING) {
        const size_t row = check_row(L, a, 2, true);
        if (row == a->count)
            lua_pushnil(L); // ends ipairs
        else
            push_row(L, a, row);
        return 1;
    }
    static const char letters[] = "xyzrgb";
    const char *name = lua_tostring(L, 2), *letter = *name && !name[1] ? strchr(letters, *name) : NULL;
    if (letter && a->width > 1 && (size_t)(letter - letters) % 3 < a->width) {
        push_column(L, a, (size_t)(letter - letters) % 3);
        return 1;
    }
    if (strcmp(name, "width") == 0) {
        lua_pushinteger(L, a->width);
        return 1;
    }
    luaL_getmetafield(L, 1, "methods");
    lua_pushvalue(L, 2);
    if (lua_rawget(L, -2) != LUA_TNIL)
        return 1;
    const char *near = glintL_nearer(name, NULL, "width");
    for (lua_pop(L, 1), lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1))
        near = glintL_nearer(name, near, lua_tostring(L, -2));
    return glintL_no_such_field(L, "array", name, near);
}

static int write_member(lua_State *L)
{
    glintL_array *a = glintL_check_array(L);
    const size_t row = check_row(L, a, 2, false);
    lua_settop(L, 3);
    if (a->width == 1)
        take_number(L, a, row, "array", row, name_of(a->is_whole));
    else
        take_row(L, a, row);
    return 0;
}

static int length(lua_State *L)
{
    lua_pushinteger(L, (lua_Integer)glintL_check_array(L)->count);
    return 1;
}

// slice(first, last, step): a copy of these rows. Negative numbers count from the end.
static int slice(lua_State *L)
{
    const glintL_array *a = glintL_check_array(L);
    const lua_Integer count = (lua_Integer)a->count;
    lua_Integer first = luaL_optinteger(L, 2, 1), last = luaL_optinteger(L, 3, count), step = luaL_optinteger(L, 4, 1);
    first += first < 0 ? count + 1 : 0;
    last += last < 0 ? count + 1 : 0;
    if (first < 1 || last > count || step < 1)
        return glintL_error(L, "array.slice: rows 1 .. %I and a step >= 1 expected, got %I .. %I and %I", (LUAI_UACINT)count,
                            (LUAI_UACINT)first, (LUAI_UACINT)last, (LUAI_UACINT)step);
    const size_t rows = last < first ? 0 : (size_t)((last - first) / step) + 1, row = a->width * sizeof *a->numbers;
    glintL_array *out = glintL_push_array(L, rows, a->width, a->is_whole);
    for (size_t i = 0; i < rows; i++)
        memcpy(out->numbers + i * a->width, a->numbers + ((size_t)(first - 1) + i * (size_t)step) * a->width, row);
    return 1;
}

// at(rows): the rows with these numbers.
static int at(lua_State *L)
{
    const glintL_array *a = glintL_check_array(L), *rows = glintL_to_array(L, 2);
    if (!rows || !rows->is_whole || rows->width != 1)
        return glintL_refuse(L, 2, "array.at", "array of whole numbers");
    glintL_array *out = glintL_push_array(L, rows->count, a->width, a->is_whole);
    for (size_t i = 0; i < rows->count; i++) {
        const int64_t row = rows->wholes[i];
        if (row < 1 || (uint64_t)row > a->count)
            return glintL_error(L, "array.at: row 1 .. %I expected, got %I", (LUAI_UACINT)a->count, (LUAI_UACINT)row);
        memcpy(out->numbers + i * a->width, a->numbers + (size_t)(row - 1) * a->width, a->width * sizeof *a->numbers);
    }
    return 1;
}

static int to_table(lua_State *L)
{
    const glintL_array *a = glintL_check_array(L);
    lua_createtable(L, a->count < INT32_MAX ? (int)a->count : INT32_MAX, 0);
    for (size_t i = 0; i < a->count; i++) {
        push_row(L, a, i);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

static int to_string(lua_State *L)
{
    const glintL_array *a = glintL_check_array(L);
    lua_pushfstring(L, "array of %I x %I %s", (LUAI_UACINT)a->count, (LUAI_UACINT)a->width,
                    a->is_whole ? "integers" : "numbers");
    return 1;
}

void glintL_open_array(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__index", read_member }, { "__newindex", write_member }, { "__len", length },   { "__tostring", to_string },
        { "__add", glintL_array_add },           { "__sub", glintL_array_subtract },          { "__mul", glintL_array_multiply }, { "__div", glintL_array_divide },
        { "__unm", glintL_array_negate },        { NULL, NULL },
    };
    const luaL_Reg methods[] = {
        { "at", at },   { "bins", glintL_array_bins },   { "column", column }, { "counts", glintL_array_counts }, { "floor", glintL_array_floor }, { "map", glintL_get_tracing(L)->map_array },
        { "max", glintL_array_max }, { "mean", glintL_array_mean },   { "min", glintL_array_min },       { "slice", slice },     { "sum", glintL_array_sum },
        { "table", to_table }, { NULL, NULL },
    };
    static const glintL_field fields[] = { { .name = "width" }, { .name = "x" }, { .name = "y" }, { .name = "z" },
                                           { .name = "r" }, { .name = "g" }, { .name = "b" }, { .name = NULL } };
    static const glintL_variant variant = { .name = "array", .fields = fields };
    glintL_new_type(L, GLINTL_ARRAY, meta);
    luaL_getmetatable(L, GLINTL_ARRAY);
    lua_newtable(L);
    luaL_setfuncs(L, methods, 0);
    lua_setfield(L, -2, "methods");
    lua_pop(L, 1);
    glintL_list_variant(L, &variant, methods);
    glintL_set_function(L, "array", new_array);
    glintL_set_function(L, "_join", join);
}
