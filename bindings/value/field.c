// Fields: one member of a description, with its name in a script and its offset in the engine's struct.
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/value/glintL.h"
#include "engine/glint.h"

#define PATH_SIZE 192 // longer paths are cut in messages
#define PI 0x1.921fb54442d18p+1

const glintL_field *glintL_find_field(const glintL_field *fields, const char *name)
{
    for (const glintL_field *field = fields; field->name; field++)
        if (strcmp(field->name, name) == 0)
            return field;
    return NULL;
}

static bool has_field(const void *fields, const char *name) { return glintL_find_field(fields, name) != NULL; }

const char *glintL_nearest(const char *name, const glintL_field *fields)
{
    const char *best = NULL;
    for (const glintL_field *field = fields; field->name; field++)
        best = glintL_nearer(name, best, field->name);
    return best ? best : glintL_meaning(name, has_field, fields);
}

// ---- One value in ----

static double read_finite(lua_State *L, int index, const char *path)
{
    double x = glintL_read_number(L, index, path);
    if (!isfinite(x))
        glintL_refuse(L, index, path, "finite number");
    return x;
}

// Reads a whole number; the engine checks its range.
static int64_t read_whole(lua_State *L, int index, const char *path, const glintL_field *field)
{
    char range[80];
    const double x = read_finite(L, index, path);
    snprintf(range, sizeof range, "whole number %.15g .. %.15g", field->low, field->high);
    if (fabs(x) > 0x1p62 || x != floor(x))
        glintL_refuse(L, index, path, field->expected ? field->expected : range);
    return (int64_t)x;
}

// Reads an enum, which the engine stores as an int, as GCC and Clang do.
static void read_enum(lua_State *L, int index, const char *path, const char *const *names, void *out)
{
    luaL_Buffer list;
    if (lua_type(L, index) == LUA_TSTRING) {
        const char *name = lua_tostring(L, index);
        for (unsigned value = 0; names[value]; value++) {
            if (strcmp(name, names[value]) == 0) {
                memcpy(out, &value, sizeof value);
                return;
            }
        }
    }
    const char *got = glintL_push_spelling(L, index);
    luaL_buffinit(L, &list);
    for (const char *const *name = names; *name; name++) {
        luaL_addstring(&list, name == names ? "\"" : name[1] ? "\", \"" : "\" or \"");
        luaL_addstring(&list, *name);
    }
    luaL_addchar(&list, '"');
    luaL_pushresult(&list);
    const char *near = NULL;
    for (const char *const *name = names; *name && lua_type(L, index) == LUA_TSTRING; name++)
        near = glintL_nearer(lua_tostring(L, index), near, *name);
    if (near)
        glintL_error(L, "%s: %s expected, got %s; did you mean \"%s\"?", path, lua_tostring(L, -1), got, near);
    glintL_error(L, "%s: %s expected, got %s", path, lua_tostring(L, -1), got);
}

static void read_string(lua_State *L, int index, const char *path, char out[GLINT_NAME_SIZE])
{
    size_t length;
    if (lua_type(L, index) != LUA_TSTRING)
        glintL_refuse(L, index, path, "string");
    const char *text = lua_tolstring(L, index, &length);
    if (length >= GLINT_NAME_SIZE)
        glintL_error(L, "%s: at most %d bytes expected, got %d", path, GLINT_NAME_SIZE - 1, (int)length);
    if (memchr(text, '\0', length))
        glintL_error(L, "%s: string without a zero byte expected", path);
    memset(out, 0, GLINT_NAME_SIZE);
    memcpy(out, text, length);
}

static void read_object(lua_State *L, int index, const char *path, const glintL_field *field, void *out)
{
    const char *type = field->names[0];
    void *object = NULL;
    if (!lua_isnil(L, index) || field->required) {
        const char *name = type + sizeof "glint." - 1;
        object = glintL_test_object(L, index, type);
        if (!object && lua_istable(L, index) && glintL_makes(L, name))
            glintL_error(L, "%s: %s expected, got table; write glint.%s { ... }", path, name, name);
        if (!object && lua_type(L, index) == LUA_TSTRING && lua_rawlen(L, index) < 30 && strcmp(name, "material") == 0)
            glintL_error(L, "%s: material expected, got string \"%s\"; write glint.material { diffuse = \"%s\" }", path,
                         lua_tostring(L, index), lua_tostring(L, index));
        if (!object)
            glintL_refuse(L, index, path, name);
    }
    memcpy(out, &object, sizeof object);
}

// Reads a list of points. The block belongs to Lua, which retains it until the next list is read; the engine copies it
// before that.
static void read_points(lua_State *L, int index, const char *path, void *out)
{
    static const char block; // address used as a registry key
    char element[PATH_SIZE + 24];
    if (!lua_istable(L, index))
        glintL_refuse(L, index, path, "list of {x, y, z}");
    const size_t count = glintL_check_list(L, index, path, false);
    double(*points)[3] = lua_newuserdatauv(L, (count + 1) * sizeof *points, 0);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &block);
    for (size_t i = 0; i < count; i++) {
        snprintf(element, sizeof element, "%s[%zu]", path, i + 1);
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        glintL_read_vector(L, -1, element, points[i]);
        lua_pop(L, 1);
    }
    memcpy(out, &points, sizeof points);
    memcpy((char *)out + sizeof points, &count, sizeof count);
}

static void read_transform(lua_State *L, int index, const char *path, glint_transform *out)
{
    const glint_transform *t = glintL_to_transform(L, index);
    if (!t && !lua_isnil(L, index))
        glintL_refuse(L, index, path, "transform");
    *out = t ? *t : glint_transform_identity();
}

static void read_distance(lua_State *L, int index, const char *path, glintL_distance *out)
{
    glintL_dual number;
    *out = (glintL_distance) { .number = 0 };
    if (lua_isnil(L, index))
        return;
    const bool is_number = glintL_read_dual(L, index, &number);
    if (is_number)
        out->number = number.value;
    else if (lua_istable(L, index) || glintL_to_vector(L, index))
        glintL_read_vector(L, index, path, out->point);
    else
        glintL_refuse(L, index, path, "number > 0 or {x, y, z}");
    out->has_point = !is_number;
    if (out->has_point || (out->number > 0 && isfinite(out->number)))
        return;
    lua_pushnumber(L, out->number);
    glintL_refuse(L, -1, path, "number > 0 or {x, y, z}");
}

void glintL_begin_table(const glintL_field *parts, void *desc)
{
    for (const glintL_field *f = parts; f->name; f++) {
        const int64_t whole = f->type == GLINT_TYPE_WHOLE ? (int64_t)f->initial[0] : 0;
        if (f->set_offset)
            ((bool *)desc)[f->set_offset] = false;
        else if (f->type == GLINT_TYPE_WHOLE)
            memcpy((char *)desc + f->offset, &whole, sizeof whole);
        else
            memcpy((char *)desc + f->offset, f->initial, sizeof *f->initial);
    }
}

// Reads a table pushed by push_nested, from the table behind it.
static void read_nested(lua_State *L, int index, const char *path, const glintL_field *field, void *desc)
{
    if (!lua_istable(L, index))
        glintL_refuse(L, index, path, "table");
    luaL_checkstack(L, 2, "table");
    const int top = lua_gettop(L);
    if (luaL_getmetafield(L, index, "__index") != LUA_TTABLE)
        lua_pushvalue(L, index);
    glintL_begin_table(field->parts, desc);
    glintL_read_table(L, -1, path, field->parts, desc, false);
    lua_settop(L, top);
}

// Refuses a function or pattern if the field needs the other kind.
static void refuse_source(lua_State *L, int index, const char *path, bool is_shader)
{
    const bool is_other = glintL_get_tracing(L)->is_source(L, index, !is_shader);
    if (!is_other && !lua_isfunction(L, index))
        return;
    const char *got = glintL_push_spelling(L, index);
    if (is_shader)
        glintL_error(L, "%s: a name or a shader expected, got %s; write glint.shader(function(s) ... end)", path, got);
    if (is_other)
        glintL_error(L, "%s: a value or a pattern expected, got %s; a shader is a material's model, and this is "
                        "glint.pattern(function(p, s) ... end)",
                     path, got);
    glintL_error(L, "%s: a value or a pattern expected, got %s; write glint.pattern(function(p, s) ... end)", path, got);
}

// Reads a field. Only read_points may allocate here (and errors), so that no finalizer of the script can run and close
// an object whose pointer was read.
void glintL_read_field(lua_State *L, int index, const char *path, const glintL_field *field, void *desc)
{
    char full[PATH_SIZE];
    char *base = desc;
    void *out = base + field->offset;
    bool set = true;
    snprintf(full, sizeof full, "%s%s%s", path, *path ? "." : "", field->name);
    index = lua_absindex(L, index);
    if (field->program_offset) {
        glint_program *const none = NULL;
        memcpy(base + field->program_offset, &none, sizeof none);
        if (glintL_get_tracing(L)->is_source(L, index, field->type == GLINT_TYPE_CHOICE)) {
            if (field->set_offset)
                memcpy(base + field->set_offset, &set, sizeof set);
            return;
        }
        refuse_source(L, index, full, field->type == GLINT_TYPE_CHOICE);
    }
    if (lua_isnil(L, index) && field->unset_offset && base[field->unset_offset])
        return;
    if (field->set_offset && !field->required && lua_isnil(L, index)) {
        set = false;
        memcpy(base + field->set_offset, &set, sizeof set);
        return;
    }
    double x;
    int64_t whole;
    switch (field->type) {
    case GLINT_TYPE_WHOLE:
        whole = read_whole(L, index, full, field);
        memcpy(out, &whole, sizeof whole);
        break;
    case GLINT_TYPE_NUMBER:
    case GLINT_TYPE_ANGLE:
        if (!(field->takes & GLINT_TAKES_VARIABLE) || !glintL_read_duals(L, index, full, false, 1, &x))
            x = isinf(field->high) ? glintL_read_number(L, index, full) : read_finite(L, index, full);
        x = field->type == GLINT_TYPE_ANGLE ? x * PI / 180 : x;
        memcpy(out, &x, sizeof x);
        break;
    case GLINT_TYPE_FLAG:
        if (!lua_isboolean(L, index))
            glintL_refuse(L, index, full, "boolean");
        *(bool *)out = lua_toboolean(L, index);
        break;
    case GLINT_TYPE_VECTOR:
    case GLINT_TYPE_DIRECTION:
        if (!(field->takes & GLINT_TAKES_VARIABLE) || !glintL_read_duals(L, index, full, false, 3, out))
            glintL_read_vector(L, index, full, out);
        break;
    case GLINT_TYPE_COLOR:
        if (!(field->takes & GLINT_TAKES_VARIABLE) || !glintL_read_duals(L, index, full, true, 3, out))
            glintL_read_color(L, index, full, out);
        break;
    case GLINT_TYPE_CHOICE:
        read_enum(L, index, full, field->names, out);
        break;
    case GLINT_TYPE_TEXT:
        read_string(L, index, full, out);
        break;
    case GLINT_TYPE_OBJECT:
        read_object(L, index, full, field, out);
        break;
    case GLINT_TYPE_POINTS:
        read_points(L, index, full, out);
        break;
    case GLINT_TYPE_DISTANCE:
        read_distance(L, index, full, out);
        break;
    case GLINT_TYPE_TRANSFORM:
        read_transform(L, index, full, out);
        break;
    case GLINT_TYPE_POSE:
        glintL_read_pose(L, index, full, field->parts, desc);
        break;
    case GLINT_TYPE_TABLE:
        read_nested(L, index, full, field, desc);
        break;
    case GLINT_TYPE_PROGRAM:
        if (!lua_isnil(L, index))
            glintL_refuse(L, index, full, "pattern");
        break;
    case GLINT_TYPE_CUSTOM:
        ((const glintL_custom *)field->custom)->read(L, index, full, desc);
        break;
    case GLINT_TYPE_OTHER:
        break;
    }
    if (field->set_offset)
        memcpy(base + field->set_offset, &set, sizeof set);
    if (field->unset_offset)
        base[field->unset_offset] = false;
}

// ---- One value out ----

// Converts to degrees that give the same radians, with few digits, so that 40 reads back as 40.
static double to_degrees(double radians)
{
    char text[32];
    double degrees = radians * 180 / PI;
    snprintf(text, sizeof text, "%.15g", degrees);
    double tidy = strtod(text, NULL);
    for (int i = 0; i < 8 && tidy * PI / 180 != radians; i++) // 4 neighbours on each side
        tidy = i < 4 ? nextafter(i ? tidy : degrees, HUGE_VAL) : nextafter(i > 4 ? tidy : degrees, -HUGE_VAL);
    return tidy * PI / 180 == radians ? tidy : degrees;
}

static void push_points(lua_State *L, const void *in)
{
    const double(*points)[3];
    size_t count;
    memcpy(&points, in, sizeof points);
    memcpy(&count, (const char *)in + sizeof points, sizeof count);
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        glintL_push_vector(L, points[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

static void push_distance(lua_State *L, const glintL_distance *in)
{
    if (in->has_point)
        glintL_push_vector(L, in->point);
    else if (in->number > 0)
        lua_pushnumber(L, in->number);
    else
        lua_pushnil(L);
}

static int refuse_part(lua_State *L)
{
    return glintL_error(L, "%s: assign a whole table; its fields are read-only", lua_tostring(L, lua_upvalueindex(1)));
}

static int each_part(lua_State *L)
{
    lua_getglobal(L, "next");
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_pushnil(L);
    return 3;
}

static int count_parts(lua_State *L)
{
    lua_pushinteger(L, (lua_Integer)lua_rawlen(L, lua_upvalueindex(1)));
    return 1;
}

void glintL_freeze(lua_State *L, const char *name)
{
    luaL_checkstack(L, 4, "field");
    lua_newtable(L);
    lua_newtable(L); // the new table's metatable
    lua_pushvalue(L, -3);
    lua_pushcclosure(L, each_part, 1);
    lua_setfield(L, -2, "__pairs");
    lua_pushvalue(L, -3);
    lua_pushcclosure(L, count_parts, 1);
    lua_setfield(L, -2, "__len");
    lua_pushvalue(L, -3);
    lua_setfield(L, -2, "__index");
    lua_pushstring(L, name);
    lua_pushcclosure(L, refuse_part, 1);
    lua_setfield(L, -2, "__newindex");
    lua_setmetatable(L, -2);
    lua_remove(L, -2);
}

static void push_nested(lua_State *L, const glintL_field *field, const void *desc)
{
    luaL_checkstack(L, 2, "field");
    lua_newtable(L);
    for (const glintL_field *f = field->parts; f->name; f++) {
        glintL_push_field(L, f, desc);
        lua_setfield(L, -2, f->name);
    }
    glintL_freeze(L, field->name);
}

void glintL_push_field(lua_State *L, const glintL_field *field, const void *desc)
{
    const char *base = desc;
    const void *in = base + field->offset;
    unsigned value;
    void *object;
    luaL_checkstack(L, 4, "field");
    if ((field->set_offset && !base[field->set_offset]) || (field->unset_offset && base[field->unset_offset])) {
        lua_pushnil(L);
        return;
    }
    switch (field->type) {
    case GLINT_TYPE_NUMBER:
        lua_pushnumber(L, *(const double *)in);
        break;
    case GLINT_TYPE_WHOLE:
        lua_pushnumber(L, (lua_Number)*(const int64_t *)in);
        break;
    case GLINT_TYPE_ANGLE:
        lua_pushnumber(L, to_degrees(*(const double *)in));
        break;
    case GLINT_TYPE_FLAG:
        lua_pushboolean(L, *(const bool *)in);
        break;
    case GLINT_TYPE_VECTOR:
    case GLINT_TYPE_DIRECTION:
    case GLINT_TYPE_COLOR:
        glintL_push_vector(L, in);
        break;
    case GLINT_TYPE_CHOICE:
        memcpy(&value, in, sizeof value);
        lua_pushstring(L, field->names[value]);
        break;
    case GLINT_TYPE_TEXT:
        lua_pushstring(L, in);
        break;
    case GLINT_TYPE_OBJECT:
        memcpy(&object, in, sizeof object);
        glintL_push_remembered(L, object);
        break;
    case GLINT_TYPE_POINTS:
        push_points(L, in);
        break;
    case GLINT_TYPE_DISTANCE:
        push_distance(L, in);
        break;
    case GLINT_TYPE_TRANSFORM:
        glintL_push_transform(L, in);
        break;
    case GLINT_TYPE_POSE:
        glintL_push_pose(L, field->parts, desc);
        break;
    case GLINT_TYPE_TABLE:
        push_nested(L, field, desc);
        break;
    case GLINT_TYPE_CUSTOM:
        ((const glintL_custom *)field->custom)->push(L, desc);
        break;
    case GLINT_TYPE_PROGRAM: // the caller reads the source from the userdata before
    case GLINT_TYPE_OTHER:
        lua_pushnil(L);
        break;
    }
}

// ---- Whole tables ----

static const char *first_required(const glintL_field *fields)
{
    for (const glintL_field *field = fields; field->name; field++)
        if (field->required)
            return field->name;
    return fields->name;
}

static void check_keys(lua_State *L, int index, const char *path, const glintL_field *fields, bool allow_array)
{
    lua_pushnil(L);
    while (lua_next(L, index)) {
        lua_pop(L, 1);
        if (lua_type(L, -1) == LUA_TSTRING) {
            size_t length;
            const char *name = lua_tolstring(L, -1, &length);
            if (!glintL_find_field(fields, name) || strlen(name) != length)
                glintL_no_such_field(L, path, name, glintL_nearest(name, fields));
        } else if (!allow_array && lua_isinteger(L, -1)) {
            glintL_error(L, "%s: a name for each value expected, %s { %s = ... }, got a value without a name", path, path,
                         first_required(fields));
        } else if (!lua_isinteger(L, -1)) {
            glintL_bad_key(L, path, -1);
        }
    }
}

void glintL_read_table(lua_State *L, int index, const char *path, const glintL_field *fields, void *desc,
                       bool allow_array)
{
    index = lua_absindex(L, index);
    if (!lua_istable(L, index))
        glintL_refuse(L, index, path, "table");
    if (glintL_is_module(L, index))
        glintL_error(L, "%s: write glint.%s { ... } with a dot, not with a colon", path, path);
    luaL_checkstack(L, 6, "table");
    check_keys(L, index, path, fields, allow_array);
    // Objects last: see glintL_read_field.
    for (int objects = 0; objects < 2; objects++) {
        for (const glintL_field *field = fields; field->name; field++) {
            if ((field->type == GLINT_TYPE_OBJECT) != objects)
                continue;
            lua_pushstring(L, field->name);
            lua_rawget(L, index);
            if (field->required || !lua_isnil(L, -1))
                glintL_read_field(L, -1, path, field, desc);
            lua_pop(L, 1);
        }
    }
}
