// glint.point_light, directional_light, spot_light, disk_light, polygon_light, sphere_light
#include <string.h>

#include "bindings/value/glintL.h"

typedef glint_light_desc desc_type;
_Static_assert(sizeof(desc_type) <= GLINTL_DESC_SIZE, "GLINTL_DESC_SIZE");

#define AT(member) offsetof(desc_type, member)

static const char *const SHADOWS[] = { "rays", "hard", "caps", NULL };

// clang-format off
#define EVERY_LIGHT \
    {.name = "color", .kind = GLINTL_COLOR, .offset = AT(color), .slopes = true}, \
    {.name = "intensity", .kind = GLINTL_NUMBER, .offset = AT(intensity), .slopes = true}, \
    {.name = "ambient", .kind = GLINTL_COLOR, .offset = AT(ambient), .slopes = true}, \
    {.name = "diffuse", .kind = GLINTL_COLOR, .offset = AT(diffuse), .set_offset = AT(has_diffuse), .slopes = true}, \
    {.name = "specular", .kind = GLINTL_COLOR, .offset = AT(specular), .set_offset = AT(has_specular), .slopes = true}, \
    {.name = "attenuation", .kind = GLINTL_VECTOR, .offset = AT(attenuation), .slopes = true}, \
    {.name = "shadows", .kind = GLINTL_BOOLEAN, .offset = AT(shadows)}, \
    {.name = "visible", .kind = GLINTL_BOOLEAN, .offset = AT(visible)}, \
    {.name = "name", .kind = GLINTL_STRING, .offset = AT(name)}, \
    {.name = "group", .kind = GLINTL_STRING, .offset = AT(group)}

#define EVERY_AREA_LIGHT \
    EVERY_LIGHT, \
    {.name = "samples", .kind = GLINTL_NUMBER, .offset = AT(samples)}, \
    {.name = "shadow", .kind = GLINTL_ENUM, .offset = AT(shadow), .names = SHADOWS}, \
    {.name = "radiance", .kind = GLINTL_NUMBER, .offset = AT(radiance), .set_offset = AT(has_radiance), .slopes = true}

#define PLACE {.name = "position", .kind = GLINTL_VECTOR, .offset = AT(position), .required = true, .slopes = true}
#define RADIUS {.name = "radius", .kind = GLINTL_NUMBER, .offset = AT(radius), .required = true}
// clang-format on

static const glintL_field POINT_FIELDS[] = {
    EVERY_LIGHT,
    PLACE,
    { .name = NULL },
};

static const glintL_field DIRECTIONAL_FIELDS[] = {
    EVERY_LIGHT,
    { .name = "direction", .kind = GLINTL_VECTOR, .offset = AT(direction), .required = true, .slopes = true },
    { .name = NULL },
};

static const glintL_field SPOT_FIELDS[] = {
    EVERY_LIGHT,
    PLACE,
    { .name = "direction", .kind = GLINTL_VECTOR, .offset = AT(direction), .required = true, .slopes = true },
    { .name = "inner", .kind = GLINTL_DEGREES, .offset = AT(inner_rad), .required = true, .slopes = true },
    { .name = "outer", .kind = GLINTL_DEGREES, .offset = AT(outer_rad), .required = true, .slopes = true },
    { .name = "exponent", .kind = GLINTL_NUMBER, .offset = AT(exponent), .slopes = true },
    { .name = NULL },
};

static const glintL_field DISK_FIELDS[] = {
    EVERY_AREA_LIGHT,
    PLACE,
    { .name = "normal", .kind = GLINTL_VECTOR, .offset = AT(normal), .required = true },
    RADIUS,
    { .name = NULL },
};

static const glintL_field POLYGON_FIELDS[] = {
    EVERY_AREA_LIGHT,
    { .name = "vertices", .kind = GLINTL_POINTS, .offset = AT(vertices), .required = true },
    { .name = "two_sided", .kind = GLINTL_BOOLEAN, .offset = AT(two_sided) },
    { .name = NULL },
};

static const glintL_field SPHERE_FIELDS[] = {
    EVERY_AREA_LIGHT, { .name = "shadow", .kind = GLINTL_ENUM, .offset = AT(shadow), .names = SHADOWS }, PLACE, RADIUS,
    { .name = NULL },
};

_Static_assert(AT(vertex_count) == AT(vertices) + sizeof(void *), "GLINTL_POINTS");

static const glintL_variant VARIANTS[] = {
    [GLINT_LIGHT_POINT] = { .name = "point_light", .fields = POINT_FIELDS, .place = "position" },
    [GLINT_LIGHT_DIRECTIONAL] = { .name = "directional_light", .fields = DIRECTIONAL_FIELDS },
    [GLINT_LIGHT_SPOT] = { .name = "spot_light", .fields = SPOT_FIELDS, .place = "position" },
    [GLINT_LIGHT_DISK] = { .name = "disk_light", .fields = DISK_FIELDS, .place = "position" },
    [GLINT_LIGHT_POLYGON] = { .name = "polygon_light", .fields = POLYGON_FIELDS },
    [GLINT_LIGHT_SPHERE] = { .name = "sphere_light", .fields = SPHERE_FIELDS, .place = "position" },
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
    glintL_keep_table_slopes(L, 2, 1, VARIANTS[kind].fields);
    return 1;
}

static int new_point_light(lua_State *L) { return new_light(L, GLINT_LIGHT_POINT); }

static int new_directional_light(lua_State *L) { return new_light(L, GLINT_LIGHT_DIRECTIONAL); }

static int new_spot_light(lua_State *L) { return new_light(L, GLINT_LIGHT_SPOT); }

static int new_disk_light(lua_State *L) { return new_light(L, GLINT_LIGHT_DISK); }

static int new_polygon_light(lua_State *L) { return new_light(L, GLINT_LIGHT_POLYGON); }

static int new_sphere_light(lua_State *L) { return new_light(L, GLINT_LIGHT_SPHERE); }

void glintL_open_light(lua_State *L)
{
    static const luaL_Reg constructors[] = {
        { "point_light", new_point_light },
        { "directional_light", new_directional_light },
        { "spot_light", new_spot_light },
        { "disk_light", new_disk_light },
        { "polygon_light", new_polygon_light },
        { "sphere_light", new_sphere_light },
        { NULL, NULL },
    };
    glintL_open_class(L, &CLASS);
    for (size_t i = 0; i < sizeof VARIANTS / sizeof *VARIANTS; i++)
        glintL_list_object(L, &VARIANTS[i], &CLASS);
    luaL_setfuncs(L, constructors, 0);
}
