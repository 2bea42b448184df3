// The fields of glint.polyline, glint.lobe, glint.path and glint.frustum.
#include <string.h>

#include "bindings/lua/overlay.h"

static void read_points(lua_State *L, int index, const char *path, void *desc)
{
    desc_type *d = desc;
    if (!lua_istable(L, index))
        glintL_refuse(L, index, path, "list of points");
    const size_t count = glintL_check_list(L, index, path, false);
    if (count < 2 || count > GLINT_OVERLAY_POINTS_MAX)
        glintL_error(L, "%s: 2 .. %d points expected, got %d", path, GLINT_OVERLAY_POINTS_MAX, (int)count);
    luaL_checkstack(L, 2, "points");
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        const char *element = lua_pushfstring(L, "%s[%d]", path, (int)i + 1);
        glintL_read_three(L, lua_gettop(L) - 1, element, "{x, y, z}", d->points[i]);
        lua_pop(L, 2);
    }
    d->point_count = count;
}

static void push_points(lua_State *L, const void *desc)
{
    const desc_type *d = desc;
    lua_createtable(L, (int)d->point_count, 0);
    for (size_t i = 0; i < d->point_count; i++) {
        glintL_push_vector(L, d->points[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    glintL_freeze(L, "points");
}

// Returns the points computed for the last frame, as a list of lists: one for each stroke.
static int strokes(lua_State *L)
{
    const desc_type desc = *glint_overlay_get(glintL_check_object(L, 1, GLINTL_OVERLAY));
    lua_newtable(L);
    for (size_t i = 0; i < desc.point_count; i++) {
        if (desc.point_flags[i] & GLINT_POINT_BEGINS) {
            lua_settop(L, 2);
            lua_newtable(L);
            lua_pushvalue(L, 3);
            lua_rawseti(L, 2, (lua_Integer)lua_rawlen(L, 2) + 1);
        }
        glintL_push_vector(L, desc.points[i]);
        lua_rawseti(L, 3, (lua_Integer)lua_rawlen(L, 3) + 1);
    }
    lua_settop(L, 2);
    return 1;
}

const luaL_Reg glintL_curve_getters[] = { { "strokes", strokes }, { NULL, NULL } };

// ---- Objects that an overlay is computed from, stored with its userdata ----

static void read_owner(lua_State *L, int index, const char *path, const char *type)
{
    if (!glintL_test_object(L, index, type))
        glintL_refuse(L, index, path, type + sizeof "glint." - 1);
}

// Pushes the object stored with the userdata at 1, whose field is read.
static void push_owner(lua_State *L, const char *name)
{
    if (!glintL_push_kept(L, 1, name))
        lua_pushnil(L);
}

static void read_material(lua_State *L, int index, const char *path, void *desc)
{
    (void)desc;
    read_owner(L, index, path, GLINTL_MATERIAL);
}

static void push_material(lua_State *L, const void *desc)
{
    (void)desc;
    push_owner(L, "material");
}

static void read_camera(lua_State *L, int index, const char *path, void *desc)
{
    (void)desc;
    read_owner(L, index, path, GLINTL_CAMERA);
}

static void push_camera(lua_State *L, const void *desc)
{
    (void)desc;
    push_owner(L, "camera");
}

static void read_scene(lua_State *L, int index, const char *path, void *desc)
{
    (void)desc;
    if (!lua_isnil(L, index))
        read_owner(L, index, path, GLINTL_SCENE);
}

static void push_scene(lua_State *L, const void *desc)
{
    (void)desc;
    push_owner(L, "scene");
}

// ---- The tables ----

const glintL_field glintL_polyline_fields[] = {
    { .name = "points", GLINTL_CUSTOM(read_points, push_points), .required = true },
    CURVE,
    LOOKS,
    { .name = NULL },
};

const glintL_field glintL_lobe_fields[] = {
    { .name = "point", .type = GLINT_TYPE_VECTOR, .offset = AT(point), .required = true },
    { .name = "material", GLINTL_CUSTOM(read_material, push_material), .required = true },
    { .name = "to_light", .type = GLINT_TYPE_DIRECTION, .offset = AT(to), .required = true },
    { .name = "normal", .type = GLINT_TYPE_DIRECTION, .offset = AT(from), .set_offset = AT(has_normal) },
    { .name = "scale", .type = GLINT_TYPE_NUMBER, .offset = AT(radius), .set_offset = AT(has_radius) },
    CURVE,
    LOOKS,
    { .name = NULL },
};

const glintL_field glintL_path_fields[] = {
    { .name = "scene", GLINTL_CUSTOM(read_scene, push_scene) },
    { .name = "origin", .type = GLINT_TYPE_VECTOR, .offset = AT(from), .required = true },
    { .name = "direction", .type = GLINT_TYPE_DIRECTION, .offset = AT(to), .required = true },
    { .name = "depth", .type = GLINT_TYPE_WHOLE, .offset = AT(depth), .low = 0, .high = 63 },
    { .name = "reach", .type = GLINT_TYPE_NUMBER, .offset = AT(radius), .set_offset = AT(has_radius) },
    CURVE,
    LOOKS,
    { .name = NULL },
};

const glintL_field glintL_frustum_fields[] = {
    { .name = "camera", GLINTL_CUSTOM(read_camera, push_camera), .required = true },
    { .name = "distance", .type = GLINT_TYPE_NUMBER, .offset = AT(radius), .set_offset = AT(has_radius) },
    { .name = "aspect", .type = GLINT_TYPE_NUMBER, .offset = AT(aspect) },
    CURVE,
    LOOKS,
    { .name = NULL },
};

static const char *const OWNERS[] = { "material", "scene", "camera", NULL };

// Stores an assigned object, the value at 3, with the userdata at 1.
void glintL_curve_accepted(lua_State *L, const glintL_field *field, const void *desc)
{
    (void)desc;
    for (int i = 0; OWNERS[i]; i++)
        if (strcmp(field->name, OWNERS[i]) == 0)
            glintL_keep(L, 1, field->name, 3);
}

// Stores the objects of the constructor's table, at 1, with the userdata at 2.
void glintL_curve_made(lua_State *L, const void *desc)
{
    (void)desc;
    for (int i = 0; OWNERS[i]; i++) {
        lua_pushstring(L, OWNERS[i]);
        if (lua_rawget(L, 1) != LUA_TNIL)
            glintL_keep(L, 2, OWNERS[i], lua_gettop(L));
        lua_pop(L, 1);
    }
}
