// One parameter of glint.params: its default and limits, and its value from --set.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bindings/lua/lua.h"

const char *glintL_push_allowed(lua_State *L, int spec)
{
    luaL_Buffer out;
    luaL_checkstack(L, 12, "params");
    if (lua_getfield(L, spec, "choices") == LUA_TTABLE) {
        int choices = lua_gettop(L);
        luaL_buffinit(L, &out);
        lua_Integer count = luaL_len(L, choices);
        for (lua_Integer i = 1; i <= count; i++) {
            luaL_addstring(&out, i == 1 ? "" : i < count ? ", " : " or ");
            lua_rawgeti(L, choices, i);
            luaL_tolstring(L, -1, NULL);
            lua_remove(L, -2);
            luaL_addvalue(&out);
        }
        luaL_pushresult(&out);
    } else {
        const bool whole = lua_getfield(L, spec, "whole") == LUA_TBOOLEAN && lua_toboolean(L, -1);
        lua_getfield(L, spec, "type");
        const char *type = whole ? "whole number" : lua_tostring(L, -1);
        bool min = lua_getfield(L, spec, "min") != LUA_TNIL, max = lua_getfield(L, spec, "max") != LUA_TNIL;
        const char *low = luaL_tolstring(L, -2, NULL), *high = luaL_tolstring(L, -2, NULL);
        if (min && max)
            lua_pushfstring(L, "%s %s .. %s", type, low, high);
        else if (min || max)
            lua_pushfstring(L, "%s %s %s", type, min ? ">=" : "<=", min ? low : high);
        else if (strcmp(type, "boolean") == 0)
            lua_pushliteral(L, "true or false");
        else if (strcmp(type, "point") == 0)
            lua_pushliteral(L, "point X,Y,Z");
        else
            lua_pushstring(L, type);
    }
    return lua_tostring(L, -1);
}

static bool is_choice(lua_State *L, int choices, int value)
{
    lua_Integer count = luaL_len(L, choices);
    bool found = false;
    for (lua_Integer i = 1; i <= count && !found; i++) {
        lua_rawgeti(L, choices, i);
        found = lua_rawequal(L, -1, value);
        lua_pop(L, 1);
    }
    return found;
}

// Returns whether the value at `value`, which has the right type, is within the limits of the spec at `spec`. Both are
// absolute.
static bool is_allowed(lua_State *L, int spec, int value)
{
    luaL_checkstack(L, 6, "params");
    lua_getfield(L, spec, "whole");
    bool good = !lua_toboolean(L, -1) || lua_isinteger(L, value);
    lua_pop(L, 1);
    if (lua_getfield(L, spec, "choices") == LUA_TTABLE)
        good = good && is_choice(L, lua_gettop(L), value);
    if (lua_getfield(L, spec, "min") != LUA_TNIL)
        good = good && lua_compare(L, -1, value, LUA_OPLE);
    if (lua_getfield(L, spec, "max") != LUA_TNIL)
        good = good && lua_compare(L, value, -1, LUA_OPLE);
    lua_pop(L, 3);
    return good;
}

static void push_point_text(lua_State *L, const double point[3])
{
    char numbers[3][32];
    for (int i = 0; i < 3; i++)
        glintL_format_number(numbers[i], point[i]);
    lua_pushfstring(L, "%s,%s,%s", numbers[0], numbers[1], numbers[2]);
}

// Reads "X,Y,Z". False: the text has other than three finite numbers.
static bool read_point(lua_State *L, const char *text, double point[3])
{
    for (int i = 0; i < 3; i++) {
        const size_t length = strcspn(text, ",");
        const bool is_number = text[length] == (i < 2 ? ',' : '\0') && lua_stringtonumber(L, lua_pushlstring(L, text, length));
        point[i] = is_number ? lua_tonumber(L, -1) : NAN;
        lua_pop(L, is_number ? 2 : 1);
        if (!isfinite(point[i]))
            return false;
        text += length + 1;
    }
    return true;
}

void glintL_push_param_value(lua_State *L, int spec)
{
    double point[3];
    lua_getfield(L, spec, "value");
    if (lua_getfield(L, spec, "type") == LUA_TSTRING && strcmp(lua_tostring(L, -1), "point") == 0 &&
        read_point(L, lua_tostring(L, -2), point)) {
        glintL_push_vector(L, point);
        lua_replace(L, -3);
    }
    lua_pop(L, 1);
}

// Pushes the value that `text` spells for a parameter with the default at `index`. False: it is not a valid literal.
static bool push_literal(lua_State *L, const char *text, bool is_point, int index)
{
    lua_Integer whole;
    double point[3];
    int is_whole;
    switch (lua_type(L, index)) {
    case LUA_TSTRING:
        if (is_point) {
            if (!read_point(L, text, point))
                return false;
            push_point_text(L, point);
            return true;
        }
        lua_pushstring(L, text);
        return true;
    case LUA_TBOOLEAN:
        lua_pushboolean(L, strcmp(text, "true") == 0);
        return strcmp(text, "true") == 0 || strcmp(text, "false") == 0;
    default:
        if (lua_stringtonumber(L, text) == 0 || !isfinite(lua_tonumber(L, -1)))
            return false;
        // The user may write 20 or 20.0. The script gets the number type of the default, if the conversion is exact.
        whole = lua_tointegerx(L, -1, &is_whole);
        if (!lua_isinteger(L, index))
            lua_pushnumber(L, lua_tonumber(L, -1));
        else if (is_whole)
            lua_pushinteger(L, whole);
        return true;
    }
}

// ---- Reading one parameter ----

static glintL_set *find_set(glintL_run *run, const char *name)
{
    glintL_set *found = NULL;
    for (size_t i = 0; i < run->request.set_count; i++)
        if (strcmp(run->request.sets[i].name, name) == 0)
            (found = &run->request.sets[i])->is_known = true; // the last one wins
    return found;
}

// Checks the default at `index`, and replaces a point by its text. Returns the type's name.
static const char *read_default(lua_State *L, int index, const char *path)
{
    const int type = lua_type(L, index);
    double point[3];
    if (type == LUA_TTABLE || type == LUA_TUSERDATA) {
        glintL_read_vector(L, index, path, point);
        push_point_text(L, point);
        lua_replace(L, index);
        return "point";
    }
    if (type != LUA_TSTRING && type != LUA_TBOOLEAN && type != LUA_TNUMBER)
        glintL_refuse(L, index, path, "number, boolean, string or point {x, y, z}");
    if (type == LUA_TNUMBER && !isfinite(lua_tonumber(L, index)))
        glintL_refuse(L, index, path, "finite number");
    return luaL_typename(L, index);
}

// The fields of a parameter beside its default.
static const struct {
    const char *name, *only; // only: the types of parameters that have the field; NULL: all
    int type;
    const char *expected;
} PARTS[] = {
    { "min", "number", LUA_TNUMBER, "finite number" }, { "max", "number", LUA_TNUMBER, "finite number" },
    { "whole", "number", LUA_TBOOLEAN, "boolean" },    { "drag", "point", LUA_TBOOLEAN, "boolean" },
    { "unit", "number or point", LUA_TSTRING, "string" },       { "label", NULL, LUA_TSTRING, "string" },
    { "doc", NULL, LUA_TSTRING, "string" },            { "choices", NULL, LUA_TTABLE, "list of values" },
    { "names", NULL, LUA_TTABLE, "table { choice = text }" },
};
#define PART_COUNT (sizeof PARTS / sizeof *PARTS)

static void check_choices(lua_State *L, int index, const char *path, const char *type)
{
    if (strcmp(type, "point") == 0)
        glintL_error(L, "%s: a point has no choices", path);
    if (glintL_check_list(L, index, path, false) == 0)
        glintL_refuse(L, index, path, "list of values");
    for (lua_Integer c = luaL_len(L, index); c >= 1; c--) {
        lua_rawgeti(L, index, c);
        if (strcmp(luaL_typename(L, -1), type) != 0)
            glintL_refuse(L, -1, path, type);
        lua_pop(L, 1);
    }
}

// Turns the table { choice = text } on top into a list of the texts of the choices, in their order.
static void list_names(lua_State *L, int spec, const char *path)
{
    const int names = lua_gettop(L);
    if (lua_getfield(L, spec, "choices") != LUA_TTABLE)
        glintL_error(L, "%s: expected together with choices", path);
    for (lua_pushnil(L); lua_next(L, names); lua_pop(L, 1)) {
        if (lua_type(L, -1) != LUA_TSTRING)
            glintL_refuse(L, -1, path, "text for each choice");
        if (!is_choice(L, names + 1, lua_gettop(L) - 1))
            glintL_error(L, "%s: '%s' is none of the choices", path, luaL_tolstring(L, -2, NULL));
    }
    const lua_Integer count = luaL_len(L, names + 1);
    lua_createtable(L, (int)count, 0);
    for (lua_Integer c = 1; c <= count; c++) {
        lua_rawgeti(L, names + 1, c);
        lua_pushvalue(L, -1);
        if (lua_gettable(L, names) == LUA_TNIL) {
            luaL_tolstring(L, -2, NULL);
            lua_replace(L, -2);
        }
        lua_rawseti(L, -3, c);
        lua_pop(L, 1);
    }
    lua_replace(L, names);
    lua_settop(L, names);
}

// Copies the fields of the table at `from` into the spec on top. The default is at spec.default.
static void read_limits(lua_State *L, int from, int spec, const char *path, const char *type)
{
    char full[160];
    for (size_t i = 0; i < PART_COUNT; i++) {
        snprintf(full, sizeof full, "%s.%s", path, PARTS[i].name);
        const int found = lua_getfield(L, from, PARTS[i].name);
        if (found == LUA_TNIL) {
            lua_pop(L, 1);
            continue;
        }
        if (PARTS[i].only && !strstr(PARTS[i].only, type))
            glintL_error(L, "%s: a %s has no %s", full, type, PARTS[i].name);
        if (found != PARTS[i].type || (found == LUA_TNUMBER && !isfinite(lua_tonumber(L, -1))))
            glintL_refuse(L, -1, full, PARTS[i].expected);
        if (strcmp(PARTS[i].name, "choices") == 0)
            check_choices(L, lua_gettop(L), full, type);
        if (strcmp(PARTS[i].name, "names") == 0)
            list_names(L, spec, full);
        lua_setfield(L, spec, PARTS[i].name);
    }
}

static void check_keys(lua_State *L, int index, const char *path)
{
    for (lua_pushnil(L); lua_next(L, index);) {
        lua_pop(L, 1);
        if (lua_type(L, -1) == LUA_TSTRING) {
            const char *key = lua_tostring(L, -1), *near = NULL;
            bool is_known = false;
            for (size_t i = 0; i < PART_COUNT; i++) {
                is_known = is_known || strcmp(PARTS[i].name, key) == 0;
                near = glintL_nearer(key, near, PARTS[i].name);
            }
            if (!is_known)
                glintL_no_such_field(L, path, key, near);
        } else if (!lua_isinteger(L, -1) || lua_tointeger(L, -1) != 1) {
            glintL_bad_key(L, path, -1);
        }
    }
}

// Pushes the value that the command line's text gives the parameter; raises if the parameter does not allow it.
static void push_given(lua_State *L, const glintL_set *set, const char *text, int spec)
{
    lua_getfield(L, spec, "type");
    const bool is_point = strcmp(lua_tostring(L, -1), "point") == 0;
    lua_getfield(L, spec, "default");
    bool good = push_literal(L, text, is_point, lua_gettop(L));
    if (!good || !is_allowed(L, spec, lua_gettop(L))) {
        lua_pushfstring(L, "--%s %s: %s expected, got '%s'", set->values ? "sweep" : "set", set->name, glintL_push_allowed(L, spec), text);
        lua_error(L);
    }
}

// Stores the value of --set or --sweep for this parameter, if there is one, in spec.value.
static void apply_set(lua_State *L, glintL_run *run, const char *name, int spec)
{
    glintL_set *set = find_set(run, name);
    if (!set)
        return;
    if (set->values && run->point <= 1) // checks all values before the first picture
        for (int64_t i = 0; i < set->value_count; i++) {
            push_given(L, set, set->values[i], spec);
            lua_settop(L, spec);
        }
    push_given(L, set, set->text, spec);
    lua_setfield(L, spec, "value");
    lua_settop(L, spec);
}

void glintL_push_param_spec(lua_State *L, glintL_run *run, const char *name, int entry)
{
    char path[128];
    snprintf(path, sizeof path, "params.%s", name);
    luaL_checkstack(L, 12, "params");
    lua_newtable(L);
    int spec = lua_gettop(L);
    if (lua_istable(L, entry)) {
        check_keys(L, entry, path);
        lua_rawgeti(L, entry, 1);
    } else {
        lua_pushvalue(L, entry);
    }
    int value = lua_gettop(L);
    const char *type = read_default(L, value, path);
    lua_pushstring(L, type);
    lua_setfield(L, spec, "type");
    lua_pushstring(L, name);
    lua_setfield(L, spec, "name");
    if (lua_istable(L, entry))
        read_limits(L, entry, spec, path, type);
    if (!is_allowed(L, spec, value))
        glintL_refuse(L, value, path, glintL_push_allowed(L, spec));
    lua_pushvalue(L, value);
    lua_setfield(L, spec, "default");
    lua_pushvalue(L, value);
    lua_setfield(L, spec, "value");
    apply_set(L, run, name, spec);
    lua_settop(L, spec);
}
