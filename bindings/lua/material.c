// glint.material
#include <math.h>
#include <string.h>

#include "bindings/run/run.h"

typedef glint_material_desc desc_type;
_Static_assert(sizeof(desc_type) <= GLINTL_DESC_SIZE, "GLINTL_DESC_SIZE");

#define AT(member) offsetof(desc_type, member)

static const char *const MODELS[] = { "phong", "blinn_phong", "lambert", "cook_torrance", NULL };
static const char *const DISTRIBUTIONS[] = { "ggx", "beckmann", NULL };
static const char *const OPACITY_MODES[] = { "auto", "cut", "blend", NULL };

static const glintL_field FIELDS[] = {
    { .name = "model",
      .kind = GLINTL_ENUM,
      .offset = AT(model),
      .names = MODELS,
      .program_offset = AT(program.shader) },
    { .name = "ambient",
      .kind = GLINTL_COLOR,
      .offset = AT(ambient),
      .set_offset = AT(has_ambient),
      .program_offset = AT(program.ambient),
      .follows = "diffuse", .slopes = true },
    { .name = "diffuse", .kind = GLINTL_COLOR, .offset = AT(diffuse), .program_offset = AT(program.diffuse), .slopes = true },
    { .name = "specular",
      .kind = GLINTL_COLOR,
      .offset = AT(specular),
      .set_offset = AT(has_specular),
      .program_offset = AT(program.specular), .slopes = true },
    { .name = "shininess", .kind = GLINTL_NUMBER, .offset = AT(shininess), .program_offset = AT(program.shininess), .slopes = true },
    { .name = "mirror",
      .kind = GLINTL_COLOR,
      .offset = AT(mirror),
      .set_offset = AT(has_mirror),
      .program_offset = AT(program.mirror), .slopes = true },
    { .name = "transmission",
      .kind = GLINTL_COLOR,
      .offset = AT(transmission),
      .program_offset = AT(program.transmission), .slopes = true },
    { .name = "ior", .kind = GLINTL_NUMBER, .offset = AT(ior), .slopes = true },
    { .name = "fresnel", .kind = GLINTL_BOOLEAN, .offset = AT(fresnel) },
    { .name = "absorption", .kind = GLINTL_COLOR, .offset = AT(absorption), .slopes = true },
    { .name = "normalized", .kind = GLINTL_BOOLEAN, .offset = AT(normalized) },
    { .name = "matched", .kind = GLINTL_BOOLEAN, .offset = AT(matched) },
    { .name = "roughness", .kind = GLINTL_NUMBER, .offset = AT(roughness), .program_offset = AT(program.roughness), .slopes = true },
    { .name = "distribution", .kind = GLINTL_ENUM, .offset = AT(distribution), .names = DISTRIBUTIONS },
    { .name = "f0", .kind = GLINTL_COLOR, .offset = AT(f0), .set_offset = AT(has_f0), .slopes = true },
    { .name = "opacity", .kind = GLINTL_NUMBER, .offset = AT(opacity), .program_offset = AT(program.opacity), .slopes = true },
    { .name = "opacity_mode", .kind = GLINTL_ENUM, .offset = AT(opacity_mode), .names = OPACITY_MODES },
    { .name = "bump", .kind = GLINTL_PROGRAM, .program_offset = AT(program.bump) },
    { .name = "name", .kind = GLINTL_STRING, .offset = AT(name) },
    { .name = NULL },
};

static const glintL_variant MATERIAL = { .name = "material", .fields = FIELDS };

static const glintL_variant *variant(const void *object)
{
    (void)object;
    return &MATERIAL;
}

static void get(const void *object, void *desc) { memcpy(desc, glint_material_get(object), sizeof(desc_type)); }

static glint_status set(void *object, const void *desc, glint_error *error)
{
    desc_type d;
    memcpy(&d, desc, sizeof d);
    if (!d.has_specular) // it was set to nil
        memset(d.specular, 0, sizeof d.specular);
    return glint_material_set(object, &d, error);
}

static void *retain(void *object) { return glint_material_retain(object); }

static void release(void *object) { glint_material_release(object); }

static void follow(void *desc) { glint_material_desc_resolve(desc); }

static const char WARNED; // its address is the registry's key: true once the script was warned

static bool is_first(lua_State *L)
{
    luaL_checkstack(L, 2, "warning");
    bool first = lua_rawgetp(L, LUA_REGISTRYINDEX, &WARNED) == LUA_TNIL;
    lua_pushboolean(L, true);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &WARNED);
    lua_pop(L, 1);
    return first;
}

// kd ranges over 0 .. 1; more is allowed, and warned about once.
static void accepted(lua_State *L, const glintL_field *field, const void *desc)
{
    if (field->offset == AT(specular))
        glintL_note_specular(L, 1);
    const double *kd = ((const desc_type *)desc)->diffuse;
    const double most = fmax(fmax(kd[0], kd[1]), kd[2]);
    if (field->offset == AT(diffuse) && most > 1 && is_first(L))
        glintL_warn(L, most > 2 ? "material.diffuse above 1: the surface gives off more light than it gets; colours are numbers "
                                  "from 0 to 1, or \"#rrggbb\""
                                : "material.diffuse above 1: the surface gives off more light than it gets");
}

// Whether the table at 2 says n, l and v, as shaders do.
static bool has_short_name(lua_State *L)
{
    bool has = false;
    for (const char *name = "n\0l\0v\0"; *name && !has && lua_istable(L, 2); name += 2) {
        lua_pushstring(L, name);
        has = lua_rawget(L, 2) != LUA_TNIL;
        lua_pop(L, 1);
    }
    return has;
}

static int evaluate(lua_State *L)
{
    typedef glintL_geometry geometry;
#define DIRECTIONS(n, l, v)                                                                                               \
    {                                                                                                                     \
        { .name = (n), .kind = GLINTL_VECTOR, .offset = offsetof(geometry, normal), .required = true },                   \
        { .name = (l), .kind = GLINTL_VECTOR, .offset = offsetof(geometry, to_light), .required = true },                 \
        { .name = (v), .kind = GLINTL_VECTOR, .offset = offsetof(geometry, to_eye), .required = true },                   \
        { .name = "p", .kind = GLINTL_VECTOR, .offset = offsetof(geometry, p) },                                          \
        { .name = NULL },                                                                                                 \
    }
    static const glintL_field long_names[] = DIRECTIONS("normal", "to_light", "to_eye"), short_names[] = DIRECTIONS("n", "l", "v");
#undef DIRECTIONS
    geometry at = { .p = { 0 } };
    glint_reflection out;
    glint_error error;
    glintL_check_object(L, 1, GLINTL_MATERIAL);
    glintL_read_table(L, 2, "evaluate", has_short_name(L) ? short_names : long_names, &at, false);
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

static const glintL_class CLASS = {
    .type = GLINTL_MATERIAL,
    .variant = variant,
    .get = get,
    .set = set,
    .retain = retain,
    .release = release,
    .follow = follow,
    .accepted = accepted,
    .methods = METHODS,
};

// Whether the constructor's table, at 1, has the field.
static bool is_given(lua_State *L, const char *name)
{
    lua_pushstring(L, name);
    bool given = lua_rawget(L, 1) != LUA_TNIL;
    lua_pop(L, 1);
    return given;
}

static int new_material(lua_State *L)
{
    desc_type desc = glint_material_desc_default();
    glint_material *material = NULL;
    glint_error error;
    lua_settop(L, 1);
    glintL_box *box = glintL_new_box(L, GLINTL_MATERIAL);
    glintL_read_table(L, 1, "material", FIELDS, &desc, false);
    glintL_check_status(L, "material", &error, glint_material_create(&desc, &material, &error));
    box->object = material;
    glintL_remember(L, material);
    glintL_keep_sources(L, 2, 1, FIELDS);
    glintL_keep_table_slopes(L, 2, 1, FIELDS);
    accepted(L, glintL_find_field(FIELDS, "diffuse"), &desc);
    glintL_note_material(L, 2,
                         (desc.model == GLINT_MODEL_PHONG || desc.model == GLINT_MODEL_BLINN_PHONG) &&
                             is_given(L, "shininess") && !is_given(L, "specular"));
    return 1;
}

void glintL_open_material(lua_State *L)
{
    glintL_open_class(L, &CLASS);
    glintL_list_object(L, &MATERIAL, &CLASS);
    lua_pushcfunction(L, new_material);
    lua_setfield(L, -2, "material");
}
