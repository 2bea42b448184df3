// glint.camera
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bindings/value/glintL.h"

#define SQUARE 1e-3 // largest deviation of a matrix from a rotation: enough for numbers with four digits

// A camera looks at a point or along a direction; the unused field reads nil.
typedef struct desc_type {
    glint_camera_desc camera;
    bool has_eye, has_at;
    bool has_matrix; // whether the table being read has a matrix
    glintL_distance focus;
} desc_type;
_Static_assert(sizeof(desc_type) <= GLINTL_DESC_SIZE, "GLINTL_DESC_SIZE");

#define AT(member) offsetof(desc_type, camera.member)

static const char *const PROJECTIONS[] = { "perspective", "orthographic", NULL };

// ---- The matrix: maps a point of the world to x right, y down, z away from the eye ----

static double dot(const double a[3], const double b[3]) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

// Reads the row of four numbers on top, and pops it.
static void take_row(lua_State *L, const char *path, double rotation[3], double *shift)
{
    char element[96];
    if (!lua_istable(L, -1) || lua_rawlen(L, -1) != 4)
        glintL_refuse(L, -1, path, "row of four numbers");
    for (int k = 0; k < 4; k++) {
        snprintf(element, sizeof element, "%.80s[%d]", path, k + 1);
        lua_rawgeti(L, -1, k + 1);
        *(k < 3 ? &rotation[k] : shift) = glintL_read_number(L, -1, element);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

static void check_rotation(lua_State *L, const char *path, double row[3][3])
{
    double third[3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k <= i; k++)
            if (!(fabs(dot(row[i], row[k]) - (i == k)) < SQUARE))
                glintL_error(L, "%s: a rotation expected, whose rows have length 1 and are perpendicular, got %f for "
                                "the product of row %d and row %d", path,
                             dot(row[i], row[k]), i + 1, k + 1);
    cross(row[0], row[1], third);
    if (dot(third, row[2]) < 0)
        glintL_error(L, "%s: a rotation expected, got one that also mirrors; its rows are x to the right, y down, z "
                        "away from the eye", path);
}

static void read_matrix(lua_State *L, int index, const char *path, void *desc)
{
    desc_type *d = desc;
    double row[4][3], shift[4] = { 0, 0, 0, 1 };
    char element[96];
    index = lua_absindex(L, index);
    luaL_checkstack(L, 6, "matrix");
    const size_t rows = lua_istable(L, index) ? lua_rawlen(L, index) : 0;
    if (rows != 3 && rows != 4)
        glintL_refuse(L, index, path, "3 or 4 rows of four numbers");
    for (size_t i = 0; i < rows; i++) {
        snprintf(element, sizeof element, "%.50s[%zu]", path, i + 1);
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        take_row(L, element, row[i], &shift[i]);
    }
    if (rows == 4 && !(row[3][0] == 0 && row[3][1] == 0 && row[3][2] == 0 && shift[3] == 1))
        glintL_error(L, "%s[4]: { 0, 0, 0, 1 } expected", path);
    check_rotation(L, path, row);
    for (int c = 0; c < 3; c++) {
        d->camera.eye[c] = -((row[0][c] * shift[0] + row[1][c] * shift[1]) + row[2][c] * shift[2]);
        d->camera.direction[c] = row[2][c];
        d->camera.up[c] = -row[1][c];
    }
    d->has_eye = d->has_matrix = d->camera.has_direction = true;
    d->has_at = false;
}

static void normalize(double v[3])
{
    const double length = sqrt(dot(v, v));
    for (int c = 0; c < 3; c++)
        v[c] /= length;
}

// Pushes nil if the view is along `up`, since the engine then chooses its sides.
static void push_matrix(lua_State *L, const void *desc)
{
    const glint_camera_desc *camera = &((const desc_type *)desc)->camera;
    double row[3][3];
    for (int c = 0; c < 3; c++)
        row[2][c] = camera->has_direction ? camera->direction[c] : camera->at[c] - camera->eye[c];
    normalize(row[2]);
    cross(row[2], camera->up, row[0]);
    if (!(dot(row[0], row[0]) > 1e-24 * dot(camera->up, camera->up))) {
        lua_pushnil(L);
        return;
    }
    normalize(row[0]);
    cross(row[2], row[0], row[1]);
    lua_createtable(L, 3, 0);
    for (int i = 0; i < 3; i++) {
        lua_createtable(L, 4, 0);
        for (int c = 0; c < 3; c++) {
            lua_pushnumber(L, row[i][c]);
            lua_rawseti(L, -2, c + 1);
        }
        lua_pushnumber(L, -dot(row[i], camera->eye));
        lua_rawseti(L, -2, 4);
        lua_rawseti(L, -2, i + 1);
    }
}

// ---- The fields ----

static const glintL_field FIELDS[] = {
    { .name = "matrix", GLINTL_CUSTOM(read_matrix, push_matrix) },
    { .name = "eye", .type = GLINT_TYPE_VECTOR, .offset = AT(eye), .set_offset = offsetof(desc_type, has_eye), .takes = GLINT_TAKES_VARIABLE },
    { .name = "at", .type = GLINT_TYPE_VECTOR, .offset = AT(at), .set_offset = offsetof(desc_type, has_at), .takes = GLINT_TAKES_VARIABLE },
    { .name = "direction", .type = GLINT_TYPE_VECTOR, .offset = AT(direction), .set_offset = AT(has_direction), .takes = GLINT_TAKES_VARIABLE },
    { .name = "up", .type = GLINT_TYPE_VECTOR, .offset = AT(up), .takes = GLINT_TAKES_VARIABLE },
    { .name = "fov", .member = "fov_y_rad", .type = GLINT_TYPE_ANGLE, .offset = AT(fov_y_rad), .takes = GLINT_TAKES_VARIABLE },
    { .name = "fx", .type = GLINT_TYPE_NUMBER, .offset = AT(fx) },
    { .name = "fy", .type = GLINT_TYPE_NUMBER, .offset = AT(fy) },
    { .name = "cx", .type = GLINT_TYPE_NUMBER, .offset = AT(cx), .set_offset = AT(has_cx) },
    { .name = "cy", .type = GLINT_TYPE_NUMBER, .offset = AT(cy), .set_offset = AT(has_cy) },
    { .name = "w", .type = GLINT_TYPE_NUMBER, .offset = AT(w) },
    { .name = "h", .type = GLINT_TYPE_NUMBER, .offset = AT(h) },
    { .name = "projection", .type = GLINT_TYPE_CHOICE, .offset = AT(projection), .names = PROJECTIONS },
    { .name = "height", .type = GLINT_TYPE_NUMBER, .offset = AT(height), .takes = GLINT_TAKES_VARIABLE },
    { .name = "pixel_offset", .type = GLINT_TYPE_NUMBER, .offset = AT(pixel_offset) },
    { .name = "shutter", .type = GLINT_TYPE_NUMBER, .offset = AT(shutter) },
    { .name = "shutter_times", .type = GLINT_TYPE_NUMBER, .offset = AT(shutter_times) },
    { .name = "aperture", .type = GLINT_TYPE_NUMBER, .offset = AT(aperture), .takes = GLINT_TAKES_VARIABLE },
    { .name = "focus", .type = GLINT_TYPE_DISTANCE, .offset = offsetof(desc_type, focus), .takes = GLINT_TAKES_VARIABLE },
    { .name = "blades", .type = GLINT_TYPE_NUMBER, .offset = AT(blades) },
    { .name = "blade_rotation", .type = GLINT_TYPE_ANGLE, .offset = AT(blade_rotation_rad) },
    { .name = "name", .type = GLINT_TYPE_TEXT, .offset = AT(name) },
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
    d->has_eye = true;
    d->has_at = !d->camera.has_direction;
    d->focus = (glintL_distance) { .number = d->camera.focus, .has_point = d->camera.has_focus_point };
    memcpy(d->focus.point, d->camera.focus_point, sizeof d->focus.point);
}

// Returns the camera's description for the engine.
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

// Lets the last assignment decide between at and direction, and between fov and fx.
static void assigned(lua_State *L, const glintL_field *field, void *desc)
{
    desc_type *d = desc;
    if (field->offset == AT(at) && d->has_at)
        d->camera.has_direction = false;
    else if (field->offset == AT(direction) && d->camera.has_direction)
        d->has_at = false;
    else if (field->offset == AT(fov_y_rad))
        d->camera.fx = d->camera.fy = 0;
    if (!d->has_eye || (!d->has_at && !d->camera.has_direction))
        glintL_error(L, "camera.%s: {x, y, z} expected, got nil", field->name);
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

static const glintL_class CLASS = {
    .type = GLINTL_CAMERA,
    .methods = METHODS,
    .variant = variant,
    .get = get,
    .set = set,
    .retain = retain,
    .release = release,
    .assigned = assigned,
};

static int new_camera(lua_State *L)
{
    static const char *const placed[] = { "eye", "at", "direction", "up" };
    desc_type desc = { .camera = glint_camera_desc_default(), .has_at = false };
    glint_camera *camera = NULL;
    glint_error error;
    lua_settop(L, 1);
    glintL_box *box = glintL_new_box(L, GLINTL_CAMERA);
    desc.camera.has_direction = false;
    glintL_read_table(L, 1, "camera", FIELDS, &desc, false);
    for (int i = 0; i < 4 && desc.has_matrix; i++) {
        lua_pushstring(L, placed[i]);
        if (lua_rawget(L, 1) != LUA_TNIL)
            glintL_error(L, "camera: matrix or %s expected, got both", placed[i]);
        lua_pop(L, 1);
    }
    if (!desc.has_eye)
        glintL_error(L, "camera.eye: {x, y, z} expected, got nil");
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
