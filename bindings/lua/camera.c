// glint.camera
#include <string.h>

#include "bindings/value/glintL.h"

// A camera looks at a point or along a direction: the one it does not use reads nil.
typedef struct desc_type {
    glint_camera_desc camera;
    bool has_at;
    glintL_distance focus;
} desc_type;
_Static_assert(sizeof(desc_type) <= GLINTL_DESC_SIZE, "GLINTL_DESC_SIZE");

#define AT(member) offsetof(desc_type, camera.member)

static const char *const PROJECTIONS[] = { "perspective", "orthographic", NULL };

static const glintL_field FIELDS[] = {
    { .name = "eye", .kind = GLINTL_VECTOR, .offset = AT(eye), .required = true, .slopes = true },
    { .name = "at", .kind = GLINTL_VECTOR, .offset = AT(at), .set_offset = offsetof(desc_type, has_at), .slopes = true },
    { .name = "direction", .kind = GLINTL_VECTOR, .offset = AT(direction), .set_offset = AT(has_direction), .slopes = true },
    { .name = "up", .kind = GLINTL_VECTOR, .offset = AT(up), .slopes = true },
    { .name = "fov", .kind = GLINTL_DEGREES, .offset = AT(fov_y_rad), .slopes = true },
    { .name = "projection", .kind = GLINTL_ENUM, .offset = AT(projection), .names = PROJECTIONS },
    { .name = "height", .kind = GLINTL_NUMBER, .offset = AT(height), .slopes = true },
    { .name = "pixel_offset", .kind = GLINTL_NUMBER, .offset = AT(pixel_offset) },
    { .name = "shutter", .kind = GLINTL_NUMBER, .offset = AT(shutter) },
    { .name = "shutter_times", .kind = GLINTL_NUMBER, .offset = AT(shutter_times) },
    { .name = "aperture", .kind = GLINTL_NUMBER, .offset = AT(aperture), .slopes = true },
    { .name = "focus", .kind = GLINTL_DISTANCE, .offset = offsetof(desc_type, focus), .slopes = true },
    { .name = "blades", .kind = GLINTL_NUMBER, .offset = AT(blades) },
    { .name = "blade_rotation", .kind = GLINTL_DEGREES, .offset = AT(blade_rotation_rad) },
    { .name = "name", .kind = GLINTL_STRING, .offset = AT(name) },
    { .name = NULL },
};

static const glintL_variant CAMERA = { .name = "camera", .fields = FIELDS };

static const glintL_variant *variant(const void *object)
{
    (void)object;
    return &CAMERA;
}

static void get(const void *object, void *desc)
{
    desc_type *d = desc;
    d->camera = *glint_camera_get(object);
    d->has_at = !d->camera.has_direction;
    d->focus = (glintL_distance) { .number = d->camera.focus, .has_point = d->camera.has_focus_point };
    memcpy(d->focus.point, d->camera.focus_point, sizeof d->focus.point);
}

// What the engine takes.
static glint_camera_desc described(const desc_type *d)
{
    glint_camera_desc camera = d->camera;
    camera.focus = d->focus.number;
    camera.has_focus_point = d->focus.has_point;
    memcpy(camera.focus_point, d->focus.point, sizeof camera.focus_point);
    return camera;
}

static glint_status set(void *object, const void *desc, glint_error *error)
{
    const glint_camera_desc camera = described(desc);
    return glint_camera_set(object, &camera, error);
}

static void *retain(void *object) { return glint_camera_retain(object); }

static void release(void *object) { glint_camera_release(object); }

// The one of at and direction set last is the one used.
static void assigned(lua_State *L, const glintL_field *field, void *desc)
{
    desc_type *d = desc;
    if (field->offset == AT(at) && d->has_at)
        d->camera.has_direction = false;
    else if (field->offset == AT(direction) && d->camera.has_direction)
        d->has_at = false;
    if (!d->has_at && !d->camera.has_direction)
        glintL_error(L, "camera.%s: {x, y, z} expected, got nil", field->name);
}

static const glintL_class CLASS = {
    .type = GLINTL_CAMERA,
    .variant = variant,
    .get = get,
    .set = set,
    .retain = retain,
    .release = release,
    .assigned = assigned,
};

static int new_camera(lua_State *L)
{
    desc_type desc = { .camera = glint_camera_desc_default(), .has_at = false };
    glint_camera *camera = NULL;
    glint_error error;
    lua_settop(L, 1);
    glintL_box *box = glintL_new_box(L, GLINTL_CAMERA);
    desc.camera.has_direction = false;
    glintL_read_table(L, 1, "camera", FIELDS, &desc, false);
    if (desc.has_at == desc.camera.has_direction)
        glintL_error(L, "camera: at or direction expected, got %s", desc.has_at ? "both" : "neither");
    const glint_camera_desc read = described(&desc);
    glintL_check_status(L, "camera", &error, glint_camera_create(&read, &camera, &error));
    box->object = camera;
    glintL_remember(L, camera);
    glintL_keep_table_slopes(L, 2, 1, FIELDS);
    return 1;
}

void glintL_open_camera(lua_State *L)
{
    glintL_open_class(L, &CLASS);
    glintL_list_object(L, &CAMERA, &CLASS);
    lua_pushcfunction(L, new_camera);
    lua_setfield(L, -2, "camera");
}
