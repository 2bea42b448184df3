// glint.sphere, plane, box, disk, cylinder, cone, torus, group, union, intersection and difference; also the fields of
// glint.spheres, glint.cylinders and glint.mesh, whose constructors are in spheres.c and mesh.c
#include <string.h>

#include "bindings/lua/many.h"
#include "engine/glint.h"

typedef glint_shape_desc desc_type;

static const luaL_Reg GROUP_GETTERS[] = { { "count", glintL_count_objects }, { NULL, NULL } };
static const luaL_Reg GROUP_METHODS[] = { { "add", glintL_group_add },
                                          { "remove", glintL_group_remove },
                                          { "objects", glintL_list_objects },
                                          { NULL, NULL } };

// Pushes the list of materials of glint.spheres { materials = ... } or of a mesh's file; nil for other shapes.
static void push_kept_list(lua_State *L)
{
    if (lua_getiuservalue(L, 1, 1) == LUA_TTABLE) {
        lua_getfield(L, -1, "materials");
        lua_remove(L, -2);
    } else {
        lua_pop(L, 1);
        lua_pushnil(L);
    }
}

static int get_count(lua_State *L)
{
    lua_pushinteger(L, (lua_Integer)glint_spheres_count(glintL_check_object(L, 1, GLINTL_SHAPE)));
    return 1;
}

static int get_materials(lua_State *L)
{
    push_kept_list(L);
    bool several = lua_istable(L, -1);
    lua_Integer count = several ? (lua_Integer)lua_rawlen(L, -1) : 1;
    lua_newtable(L);
    for (lua_Integer i = 1; i <= count; i++) {
        if (several)
            lua_rawgeti(L, -2, i);
        else
            lua_getfield(L, 1, "material");
        lua_rawseti(L, -2, i);
    }
    return 1;
}

static int push_corner(lua_State *L, bool upper)
{
    double corners[2][3];
    glint_shape_bounds(glintL_check_object(L, 1, GLINTL_SHAPE), corners[0], corners[1]);
    glintL_push_vector(L, corners[upper]);
    return 1;
}

static int get_min(lua_State *L) { return push_corner(L, false); }
static int get_max(lua_State *L) { return push_corner(L, true); }

#define EVERY_MANY \
    { "count", get_count }, { "index", glintL_get_index }, { "materials", get_materials }, { "min", get_min }, { "max", get_max }, \
        { NULL, NULL }

static const luaL_Reg MANY_GETTERS[] = { { "data", glintL_get_data }, EVERY_MANY };
static const luaL_Reg MESH_GETTERS[] = { { "vertices", glintL_get_vertices },
                                         { "faces", glintL_get_faces },
                                         { "normals", glintL_get_normals },
                                         { "uv", glintL_get_uv },
                                         EVERY_MANY };

#define COLLECTION .is_list = true, .getters = GROUP_GETTERS, .methods = GROUP_METHODS

static const glintL_variant VARIANTS[] = {
    [GLINT_SHAPE_SPHERE] = { .name = "sphere", .kind = GLINT_OBJECT_SPHERE, .place = "center" },
    [GLINT_SHAPE_PLANE] = { .name = "plane", .kind = GLINT_OBJECT_PLANE },
    [GLINT_SHAPE_SPHERES] = { .name = "spheres", .kind = GLINT_OBJECT_SPHERES, .getters = MANY_GETTERS },
    [GLINT_SHAPE_MESH] = { .name = "mesh", .kind = GLINT_OBJECT_MESH, .getters = MESH_GETTERS },
    [GLINT_SHAPE_BOX] = { .name = "box", .kind = GLINT_OBJECT_BOX },
    [GLINT_SHAPE_DISK] = { .name = "disk", .kind = GLINT_OBJECT_DISK, .place = "center" },
    [GLINT_SHAPE_CYLINDER] = { .name = "cylinder", .kind = GLINT_OBJECT_CYLINDER },
    [GLINT_SHAPE_CONE] = { .name = "cone", .kind = GLINT_OBJECT_CONE },
    [GLINT_SHAPE_TORUS] = { .name = "torus", .kind = GLINT_OBJECT_TORUS, .place = "center" },
    [GLINT_SHAPE_CYLINDERS] = { .name = "cylinders", .kind = GLINT_OBJECT_CYLINDERS, .getters = MANY_GETTERS },
    [GLINT_SHAPE_GROUP] = { .name = "group", .kind = GLINT_OBJECT_GROUP, COLLECTION },
    [GLINT_SHAPE_UNION] = { .name = "union", .kind = GLINT_OBJECT_UNION, COLLECTION },
    [GLINT_SHAPE_INTERSECTION] = { .name = "intersection", .kind = GLINT_OBJECT_INTERSECTION, COLLECTION },
    [GLINT_SHAPE_DIFFERENCE] = { .name = "difference", .kind = GLINT_OBJECT_DIFFERENCE, COLLECTION },
};

static lua_Integer count(const void *object)
{
    return glint_shape_get(object)->kind < GLINT_SHAPE_GROUP ? -1 : (lua_Integer)glint_group_count(object);
}

static const glintL_variant *variant(const void *object) { return &VARIANTS[glint_shape_get(object)->kind]; }

GLINTL_FUNCTIONS(shape);

static void assigned(lua_State *L, const glintL_field *field, void *desc)
{
    (void)desc;
    if (field->type != GLINT_TYPE_OBJECT)
        return;
    const char *name = variant(glintL_check_object(L, 1, GLINTL_SHAPE))->name;
    const bool is_mesh = strcmp(name, "mesh") == 0;
    push_kept_list(L);
    if (!lua_isnil(L, -1))
        glintL_error(L, "%s.material: %s %s a list of materials; change the fields of the materials in the list", name,
                     is_mesh ? "this mesh" : lua_pushfstring(L, "these %s", name), is_mesh ? "has" : "have");
    lua_pop(L, 1);
}

static void begin(int kind, void *desc) { *(desc_type *)desc = glint_shape_desc_default((glint_shape_kind)kind); }

static void made(lua_State *L, const void *desc)
{
    const desc_type *d = desc;
    if (d->material) {
        lua_pushliteral(L, "material");
        lua_rawget(L, 1);
        glintL_keep(L, 2, "material", -1);
        lua_pop(L, 1);
    }
    if (VARIANTS[d->kind].is_list)
        glintL_group_fill(L, 1, 2, VARIANTS[d->kind].name);
}

static const glintL_class CLASS = {
    .type = GLINTL_SHAPE,
    .variant = variant,
    GLINTL_FUNCTION_MEMBERS,
    .assigned = assigned,
    .begin = begin,
    .made = made,
    .count = count,
    .push_at = glintL_group_push_at,
};

void glintL_open_shape(lua_State *L)
{
    static const luaL_Reg others[] = {
        { "spheres", glintL_new_spheres },
        { "cylinders", glintL_new_cylinders },
        { "_bonds", glintL_new_bonds },
        { "mesh", glintL_new_mesh },
        { "sphere_mesh", glintL_new_sphere_mesh },
        { NULL, NULL },
    };
    glintL_open_objects(L, &CLASS, VARIANTS, sizeof VARIANTS / sizeof *VARIANTS);
    luaL_setfuncs(L, others, 0);
}
