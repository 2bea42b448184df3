// glint.translate, glint.rotate, glint.scale, glint.matrix: affine maps, immutable values.
#include <math.h>
#include <string.h>

#include "bindings/value/glintL.h"
#include "engine/glint.h"

#define TRANSFORM "glint.transform"

void glintL_push_transform(lua_State *L, const glint_transform *t)
{
    glint_transform *out = lua_newuserdatauv(L, sizeof *out, 0);
    *out = *t;
    luaL_setmetatable(L, TRANSFORM);
}

const glint_transform *glintL_to_transform(lua_State *L, int index) { return luaL_testudata(L, index, TRANSFORM); }

static const glint_transform *check_operand(lua_State *L, int index)
{
    const glint_transform *t = glintL_to_transform(L, index);
    if (!t)
        glintL_refuse(L, index, "transform", "transform");
    return t;
}

// transform * transform is the product, transform * {x, y, z} the image of a point.
static int multiply(lua_State *L)
{
    const glint_transform *t = check_operand(L, 1);
    if (lua_istable(L, 2) || glintL_to_vector(L, 2)) {
        double p[3], image[3];
        glintL_read_vector(L, 2, "transform: point", p);
        for (int r = 0; r < 3; r++)
            image[r] = t->m[r][0] * p[0] + t->m[r][1] * p[1] + t->m[r][2] * p[2] + t->m[r][3];
        glintL_push_vector(L, image);
        return 1;
    }
    const glint_transform product = glint_transform_product(t, check_operand(L, 2));
    glintL_push_transform(L, &product);
    return 1;
}

static int equal(lua_State *L)
{
    const glint_transform *a = glintL_to_transform(L, 1), *b = glintL_to_transform(L, 2);
    bool same = a && b;
    for (int i = 0; i < 12 && same; i++)
        same = a->m[i / 4][i % 4] == b->m[i / 4][i % 4];
    lua_pushboolean(L, same);
    return 1;
}

static int to_string(lua_State *L)
{
    const glint_transform *t = check_operand(L, 1);
    luaL_Buffer text;
    luaL_buffinit(L, &text);
    luaL_addstring(&text, "matrix {");
    for (int i = 0; i < 12; i++) {
        lua_pushfstring(L, i ? ", %f" : "%f", t->m[i / 4][i % 4]);
        luaL_addvalue(&text);
    }
    luaL_addchar(&text, '}');
    luaL_pushresult(&text);
    return 1;
}

// The numbers of the map, row by row: t[1] to t[12].
static int read_field(lua_State *L)
{
    if (lua_isinteger(L, 2)) {
        const lua_Integer i = lua_tointeger(L, 2);
        if (i < 1 || i > 12)
            lua_pushnil(L);
        else
            lua_pushnumber(L, check_operand(L, 1)->m[(i - 1) / 4][(i - 1) % 4]);
        return 1;
    }
    if (lua_type(L, 2) != LUA_TSTRING)
        return glintL_bad_key(L, "transform", 2);
    return glintL_no_such_field(L, "transform", lua_tostring(L, 2), NULL);
}

static int count_numbers(lua_State *L)
{
    lua_pushinteger(L, 12);
    return 1;
}

static int write_field(lua_State *L)
{
    return glintL_error(L, "transform.%s: a transform cannot be changed; assign a new transform to the object's field",
                        luaL_tolstring(L, 2, NULL));
}

static double read_finite(lua_State *L, int index, const char *path)
{
    const double x = glintL_read_number(L, index, path);
    if (!isfinite(x))
        glintL_refuse(L, index, path, "finite number");
    return x;
}

static void expect_count(lua_State *L, int count, const char *usage)
{
    if (lua_gettop(L) != count)
        glintL_error(L, "%s expected, got %d arguments", usage, lua_gettop(L));
}

// Reads {x, y, z}, or x, y, z, or (if allowed) one number for all three.
static void read_three(lua_State *L, const char *path, const char *usage, bool allow_one, double out[3])
{
    if (lua_type(L, 1) != LUA_TNUMBER) {
        expect_count(L, 1, usage);
        glintL_read_vector(L, 1, path, out);
        return;
    }
    const bool one = allow_one && lua_gettop(L) == 1;
    expect_count(L, one ? 1 : 3, usage);
    for (int c = 0; c < 3; c++)
        out[c] = read_finite(L, one ? 1 : c + 1, path);
}

static int translate(lua_State *L)
{
    double by[3];
    read_three(L, "translate", "translate: x, y, z or {x, y, z}", false, by);
    const glint_transform t = glint_transform_translate(by);
    glintL_push_transform(L, &t);
    return 1;
}

static int scale(lua_State *L)
{
    double by[3];
    read_three(L, "scale", "scale: a number, x, y, z or {x, y, z}", true, by);
    for (int c = 0; c < 3; c++)
        if (by[c] == 0)
            glintL_error(L, "scale: numbers other than 0 expected, got {%f, %f, %f}", by[0], by[1], by[2]);
    const glint_transform t = glint_transform_scale(by);
    glintL_push_transform(L, &t);
    return 1;
}

static int rotate(lua_State *L)
{
    static const char *const letters = "xyz";
    double axis[3] = { 0, 0, 0 };
    expect_count(L, 2, "rotate: axis, degrees");
    if (lua_type(L, 1) == LUA_TSTRING) {
        const char *name = lua_tostring(L, 1), *letter = *name && !name[1] ? strchr(letters, *name) : NULL;
        if (!letter)
            glintL_refuse(L, 1, "rotate.axis", "\"x\", \"y\", \"z\" or {x, y, z}");
        else
            axis[letter - letters] = 1;
    } else {
        glintL_read_vector(L, 1, "rotate.axis", axis);
    }
    if (axis[0] == 0 && axis[1] == 0 && axis[2] == 0)
        glintL_error(L, "rotate.axis: vector that is not zero expected, got {0, 0, 0}");
    const glint_transform t = glint_transform_rotate_deg(axis, read_finite(L, 2, "rotate.degrees"));
    glintL_push_transform(L, &t);
    return 1;
}

static int matrix(lua_State *L)
{
    glint_transform t = glint_transform_identity();
    expect_count(L, 1, "matrix: a table");
    if (!lua_istable(L, 1))
        glintL_refuse(L, 1, "matrix", "table of 12 or 16 numbers, row by row");
    const size_t count = glintL_check_list(L, 1, "matrix", false);
    if (count != 12 && count != 16)
        glintL_error(L, "matrix: expected 12 or 16 numbers, row by row, got %d", (int)count);
    for (int i = 0; i < (int)count; i++) {
        lua_rawgeti(L, 1, i + 1);
        const double x = read_finite(L, -1, "matrix");
        if (i < 12)
            t.m[i / 4][i % 4] = x;
        else if (x != (i == 15 ? 1 : 0))
            glintL_error(L, "matrix: last row 0, 0, 0, 1 expected");
        lua_pop(L, 1);
    }
    glintL_push_transform(L, &t);
    return 1;
}

void glintL_open_transform(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__mul", multiply },         { "__eq", equal }, { "__tostring", to_string }, { "__index", read_field },
        { "__newindex", write_field }, { "__len", count_numbers }, { NULL, NULL },
    };
    static const luaL_Reg constructors[] = {
        { "translate", translate }, { "scale", scale }, { "rotate", rotate }, { "matrix", matrix }, { NULL, NULL },
    };
    glintL_new_type(L, TRANSFORM, meta);
    luaL_setfuncs(L, constructors, 0);
}
