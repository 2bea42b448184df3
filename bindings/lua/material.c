// glint.material
#include <math.h>
#include <string.h>

#include "bindings/lua/lua.h"

typedef glint_material_desc desc_type;

#define AT(member) offsetof(desc_type, member)

static const glintL_variant MATERIAL = { .name = "material", .kind = GLINT_OBJECT_MATERIAL };

static const glintL_variant *variant(const void *object)
{
    (void)object;
    return &MATERIAL;
}

GLINTL_FUNCTIONS(material);

static void assigned(lua_State *L, const glintL_field *field, void *desc)
{
    desc_type *d = desc;
    (void)L;
    if (field->offset == AT(specular) && !d->has_specular) // a specular that was set to nil
        memset(d->specular, 0, sizeof d->specular);
}

static void follow(void *desc) { glint_material_desc_resolve(desc); }

static const char WARNED; // address used as a registry key; the value true means that the script was warned

static bool is_first(lua_State *L)
{
    luaL_checkstack(L, 2, "warning");
    bool first = lua_rawgetp(L, LUA_REGISTRYINDEX, &WARNED) == LUA_TNIL;
    lua_pushboolean(L, true);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &WARNED);
    lua_pop(L, 1);
    return first;
}

// Warns once about kd above 1, which is allowed.
static void accepted(lua_State *L, const glintL_field *field, const void *desc)
{
    if (field->offset == AT(specular))
        glintL_note_specular(L, 1);
    const double *kd = ((const desc_type *)desc)->diffuse;
    const double most = fmax(fmax(kd[0], kd[1]), kd[2]);
    if (field->offset == AT(diffuse) && most > 1 && is_first(L))
        glintL_warn(L, most > 2 ? "material.diffuse above 1: the surface reflects more light than it receives; use "
                                  "numbers from 0 to 1, or \"#rrggbb\""
                                : "material.diffuse above 1: the surface reflects more light than it receives");
}

// Returns the name by which the table at 2 gives a direction: the long one, or the short one of shaders.
static const char *name_in(lua_State *L, const char *long_name, const char *short_name)
{
    if (!lua_istable(L, 2))
        return long_name;
    lua_pushstring(L, short_name);
    const bool is_short = lua_rawget(L, 2) != LUA_TNIL;
    lua_pushstring(L, long_name);
    if (lua_rawget(L, 2) != LUA_TNIL && is_short)
        glintL_error(L, "evaluate: %s and %s are the same direction; give only one of them", short_name, long_name);
    lua_pop(L, 2);
    return is_short ? short_name : long_name;
}

static int evaluate(lua_State *L)
{
    typedef glintL_geometry geometry;
    const glintL_field fields[] = {
        { .name = name_in(L, "normal", "n"), .type = GLINT_TYPE_VECTOR, .offset = offsetof(geometry, normal), .required = true },
        { .name = name_in(L, "to_light", "l"), .type = GLINT_TYPE_VECTOR, .offset = offsetof(geometry, to_light), .required = true },
        { .name = name_in(L, "to_eye", "v"), .type = GLINT_TYPE_VECTOR, .offset = offsetof(geometry, to_eye), .required = true },
        { .name = "p", .type = GLINT_TYPE_VECTOR, .offset = offsetof(geometry, p) },
        { .name = NULL },
    };
    geometry at = { .p = { 0 } };
    glint_reflection out;
    glint_error error;
    glintL_check_object(L, 1, GLINTL_MATERIAL);
    glintL_read_table(L, 2, "evaluate", fields, &at, false);
    glintL_trace_material(L, 1);
    const glint_material *material = glintL_check_object(L, 1, GLINTL_MATERIAL); // again: reading may run finalizers
    glintL_check_status(L, "evaluate", &error, glintL_evaluate_material(material, &at, &out, &error));
    lua_createtable(L, 0, 2);
    glintL_push_vector(L, out.diffuse);
    lua_setfield(L, -2, "diffuse");
    glintL_push_vector(L, out.specular);
    lua_setfield(L, -2, "specular");
    return 1;
}

static const luaL_Reg METHODS[] = { { "evaluate", evaluate }, { NULL, NULL } };

static void begin(int kind, void *desc)
{
    (void)kind;
    *(desc_type *)desc = glint_material_desc_default();
}

static void made(lua_State *L, const void *desc)
{
    const desc_type *d = desc;
    accepted(L, glintL_find_field(glintL_fields_of(&MATERIAL), "diffuse"), d);
    glintL_note_material(L, 2,
                         (d->model == GLINT_MODEL_PHONG || d->model == GLINT_MODEL_BLINN_PHONG) && glintL_is_given(L, "shininess") &&
                             !glintL_is_given(L, "specular"));
}

static const glintL_class CLASS = {
    .type = GLINTL_MATERIAL,
    .variant = variant,
    GLINTL_FUNCTION_MEMBERS,
    .assigned = assigned,
    .follow = follow,
    .accepted = accepted,
    .methods = METHODS,
    .begin = begin,
    .made = made,
};

void glintL_open_material(lua_State *L) { glintL_open_objects(L, &CLASS, &MATERIAL, 1); }
