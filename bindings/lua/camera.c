// glint.camera
#include <string.h>

#include "bindings/lua/lua.h"
#include "engine/glint.h"

typedef glint_camera_desc desc_type;

#define AT(member) offsetof(desc_type, member)

static const glintL_variant CAMERA = { .name = "camera", .kind = GLINT_OBJECT_CAMERA };

static const glintL_variant *variant(const void *object)
{
    (void)object;
    return &CAMERA;
}

GLINTL_FUNCTIONS(camera);

// Lets the last assignment decide between fov and fx. A camera that looks along a direction must be given another
// direction, or a point to look at.
static void assigned(lua_State *L, const glintL_field *field, void *desc)
{
    desc_type *d = desc;
    if (field->offset == AT(fov_y_rad))
        d->fx = d->fy = 0;
    const desc_type *old = glint_camera_get(glintL_check_object(L, 1, GLINTL_CAMERA));
    if (field->offset == AT(direction) && old->has_direction && !d->has_direction)
        glintL_error(L, "camera.direction: {x, y, z} expected, got nil");
}

static double read_side(lua_State *L, int index, const char *path)
{
    const double side = glintL_read_number(L, index, path);
    if (!(side >= 1 && side <= GLINT_SIDE_MAX))
        glintL_refuse(L, index, path, "number of pixels 1 .. 65535");
    return side;
}

// camera:project(point, width, height): returns x, y and depth, or nil.
static int project(lua_State *L)
{
    double point[3], pixel[2], depth;
    glintL_check_object(L, 1, GLINTL_CAMERA);
    glintL_read_vector(L, 2, "project.point", point);
    const double width = read_side(L, 3, "project.width"), height = read_side(L, 4, "project.height");
    const glint_camera_desc *desc = glint_camera_get(glintL_check_object(L, 1, GLINTL_CAMERA));
    if (!glint_camera_project(desc, width, height, point, pixel, &depth)) {
        lua_pushnil(L);
        return 1;
    }
    lua_pushnumber(L, pixel[0]);
    lua_pushnumber(L, pixel[1]);
    lua_pushnumber(L, depth);
    return 3;
}

static const luaL_Reg METHODS[] = { { "project", project }, { NULL, NULL } };

static void begin(int kind, void *desc)
{
    (void)kind;
    *(desc_type *)desc = glint_camera_desc_default();
}

// Checks that the table sets the view, and in only one way: by a matrix, by `at`, or by `direction`.
static void given(lua_State *L, const glintL_variant *variant, const void *desc)
{
    static const char *const placed[] = { "eye", "at", "direction", "up" };
    const bool has_matrix = glintL_is_given(L, "matrix");
    const bool has_at = glintL_is_given(L, "at"), has_direction = glintL_is_given(L, "direction");
    (void)variant, (void)desc;
    for (int i = 0; i < 4 && has_matrix; i++)
        if (glintL_is_given(L, placed[i]))
            glintL_error(L, "camera: matrix or %s expected, got both", placed[i]);
    if (has_matrix)
        return;
    if (!glintL_is_given(L, "eye"))
        glintL_error(L, "camera.eye: {x, y, z} expected, got nil");
    if (has_at == has_direction)
        glintL_error(L, "camera: at or direction expected, got %s", has_at ? "both" : "neither");
}

static const glintL_class CLASS = {
    .type = GLINTL_CAMERA,
    .variant = variant,
    GLINTL_FUNCTION_MEMBERS,
    .assigned = assigned,
    .methods = METHODS,
    .begin = begin,
    .given = given,
};

void glintL_open_camera(lua_State *L) { glintL_open_objects(L, &CLASS, &CAMERA, 1); }
