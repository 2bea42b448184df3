// glint.point_light, directional_light, spot_light, disk_light, polygon_light, sphere_light
#include <string.h>

#include "bindings/lua/lua.h"
#include "engine/glint.h"

typedef glint_light_desc desc_type;
static const glintL_variant VARIANTS[] = {
    [GLINT_LIGHT_POINT] = { .name = "point_light", .kind = GLINT_OBJECT_POINT_LIGHT, .place = "position" },
    [GLINT_LIGHT_DIRECTIONAL] = { .name = "directional_light", .kind = GLINT_OBJECT_DIRECTIONAL_LIGHT },
    [GLINT_LIGHT_SPOT] = { .name = "spot_light", .kind = GLINT_OBJECT_SPOT_LIGHT, .place = "position" },
    [GLINT_LIGHT_DISK] = { .name = "disk_light", .kind = GLINT_OBJECT_DISK_LIGHT, .place = "position" },
    [GLINT_LIGHT_POLYGON] = { .name = "polygon_light", .kind = GLINT_OBJECT_POLYGON_LIGHT },
    [GLINT_LIGHT_SPHERE] = { .name = "sphere_light", .kind = GLINT_OBJECT_SPHERE_LIGHT, .place = "position" },
};

static const glintL_variant *variant(const void *object) { return &VARIANTS[glint_light_get(object)->kind]; }

GLINTL_FUNCTIONS(light);

static void follow(void *desc)
{
    desc_type *d = desc;
    if (!d->has_diffuse)
        memcpy(d->diffuse, d->color, sizeof d->diffuse);
    if (!d->has_specular)
        memcpy(d->specular, d->color, sizeof d->specular);
    d->has_diffuse = d->has_specular = true;
}

static void begin(int kind, void *desc) { *(desc_type *)desc = glint_light_desc_default((glint_light_kind)kind); }

static const glintL_class CLASS = {
    .type = GLINTL_LIGHT,
    .variant = variant,
    GLINTL_FUNCTION_MEMBERS,
    .follow = follow,
    .begin = begin,
};

void glintL_open_light(lua_State *L) { glintL_open_objects(L, &CLASS, VARIANTS, sizeof VARIANTS / sizeof *VARIANTS); }
