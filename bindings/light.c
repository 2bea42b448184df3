// glint.point_light, glint.directional_light
#include <string.h>

#include "bindings/glintL.h"

typedef glint_light_desc desc_type;
_Static_assert(sizeof(desc_type) <= GLINTL_DESC_SIZE, "GLINTL_DESC_SIZE");

#define AT(member) offsetof(desc_type, member)

// clang-format off
#define EVERY_LIGHT \
    {.name = "color", .kind = GLINTL_COLOR, .offset = AT(color)}, \
    {.name = "intensity", .kind = GLINTL_NUMBER, .offset = AT(intensity)}, \
    {.name = "ambient", .kind = GLINTL_COLOR, .offset = AT(ambient)}, \
    {.name = "diffuse", .kind = GLINTL_COLOR, .offset = AT(diffuse), .set_offset = AT(has_diffuse)}, \
    {.name = "specular", .kind = GLINTL_COLOR, .offset = AT(specular), .set_offset = AT(has_specular)}, \
    {.name = "attenuation", .kind = GLINTL_VECTOR, .offset = AT(attenuation)}, \
    {.name = "shadows", .kind = GLINTL_BOOLEAN, .offset = AT(shadows)}, \
    {.name = "visible", .kind = GLINTL_BOOLEAN, .offset = AT(visible)}, \
    {.name = "name", .kind = GLINTL_STRING, .offset = AT(name)}
// clang-format on

static const glintL_field POINT_FIELDS[] = {
    EVERY_LIGHT,
    { .name = "position", .kind = GLINTL_VECTOR, .offset = AT(position), .required = true },
    { .name = NULL },
};

static const glintL_field DIRECTIONAL_FIELDS[] = {
    EVERY_LIGHT,
    { .name = "direction", .kind = GLINTL_VECTOR, .offset = AT(direction), .required = true },
    { .name = NULL },
};

static const glintL_variant VARIANTS[] = {
    [GLINT_LIGHT_POINT] = { .name = "point_light", .fields = POINT_FIELDS, .place = "position" },
    [GLINT_LIGHT_DIRECTIONAL] = { .name = "directional_light", .fields = DIRECTIONAL_FIELDS },
};

static const glintL_variant *variant(const void *object) { return &VARIANTS[glint_light_get(object)->kind]; }

static void get(const void *object, void *desc) { memcpy(desc, glint_light_get(object), sizeof(desc_type)); }

static glint_status set(void *object, const void *desc, glint_error *error)
{
    return glint_light_set(object, desc, error);
}

static void *retain(void *object) { return glint_light_retain(object); }

static void release(void *object) { glint_light_release(object); }

static void follow(void *desc)
{
    desc_type *d = desc;
    if (!d->has_diffuse)
        memcpy(d->diffuse, d->color, sizeof d->diffuse);
    if (!d->has_specular)
        memcpy(d->specular, d->color, sizeof d->specular);
    d->has_diffuse = d->has_specular = true;
}

static const glintL_class CLASS = {
    .type = GLINTL_LIGHT,
    .variant = variant,
    .get = get,
    .set = set,
    .retain = retain,
    .release = release,
    .follow = follow,
};

static int new_light(lua_State *L, glint_light_kind kind)
{
    desc_type desc = glint_light_desc_default(kind);
    glint_light *light = NULL;
    glint_error error;
    lua_settop(L, 1);
    glintL_box *box = glintL_new_box(L, GLINTL_LIGHT);
    glintL_read_table(L, 1, VARIANTS[kind].name, VARIANTS[kind].fields, &desc, false);
    glintL_check_status(L, VARIANTS[kind].name, &error, glint_light_create(&desc, &light, &error));
    box->object = light;
    glintL_remember(L, light);
    return 1;
}

static int new_point_light(lua_State *L) { return new_light(L, GLINT_LIGHT_POINT); }

static int new_directional_light(lua_State *L) { return new_light(L, GLINT_LIGHT_DIRECTIONAL); }

void glintL_open_light(lua_State *L)
{
    static const luaL_Reg constructors[] = {
        { "point_light", new_point_light },
        { "directional_light", new_directional_light },
        { NULL, NULL },
    };
    glintL_open_class(L, &CLASS);
    for (size_t i = 0; i < sizeof VARIANTS / sizeof *VARIANTS; i++)
        glintL_list_object(L, &VARIANTS[i], &CLASS);
    luaL_setfuncs(L, constructors, 0);
}
