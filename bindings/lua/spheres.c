// The constructor glint.spheres: many spheres from a flat table or a packed string.
#include <string.h>

#include "bindings/lua/many.h"

#define SPHERES_MAX ((size_t)1 << 30)

typedef enum format { FORMAT_NONE, FORMAT_F32, FORMAT_F64 } format;

typedef struct arguments {
    glint_spheres_desc desc;
    format format;
    glint_transform transform;
} arguments;

static const char *const FORMATS[] = { "none", "f32", "f64", NULL };

static const glintL_field FIELDS[] = {
    { .name = "data", .type = GLINT_TYPE_OTHER },
    { .name = "format", .type = GLINT_TYPE_OTHER },
    { .name = "material", .type = GLINT_TYPE_OTHER },
    { .name = "materials", .type = GLINT_TYPE_OTHER },
    { .name = "index", .type = GLINT_TYPE_OTHER },
    { .name = "transform", .type = GLINT_TYPE_TRANSFORM, .offset = offsetof(arguments, transform) },
    { .name = "two_sided", .type = GLINT_TYPE_FLAG, .offset = offsetof(arguments, desc.two_sided) },
    { .name = "name", .type = GLINT_TYPE_TEXT, .offset = offsetof(arguments, desc.name) },
    { .name = NULL },
};

// Stack positions of the constructor: the argument, the box, then the argument's fields and a buffer for each.
enum { ARGUMENT = 1, BOX, DATA, DATA_BUFFER, FORMAT, INDEX, INDEX_BUFFER, MATERIAL, MATERIALS, POINTERS, KEPT };

static const glintL_many MANY = { .object = "spheres",
                                  .each = "sphere",
                                  .material = MATERIAL,
                                  .materials = MATERIALS,
                                  .index = INDEX,
                                  .index_buffer = INDEX_BUFFER,
                                  .pointers = POINTERS,
                                  .kept = KEPT };

static void read_format(lua_State *L, arguments *a)
{
    static const glintL_field field = {
        .name = "format",
        .type = GLINT_TYPE_CHOICE,
        .offset = offsetof(arguments, format),
        .names = FORMATS + 1,
    };
    glintL_many_fetch(L, "format", FORMAT);
    if (lua_isstring(L, DATA)) {
        glintL_read_field(L, FORMAT, "spheres", &field, a);
        a->format = a->format == 0 ? FORMAT_F32 : FORMAT_F64;
    } else if (!lua_isnil(L, FORMAT)) {
        glintL_error(L, "spheres.format: only packed data has a format");
    }
}

static void read_packed(lua_State *L, arguments *a)
{
    size_t bytes, record = 4 * (a->format == FORMAT_F32 ? sizeof(float) : sizeof(double));
    a->desc.data = lua_tolstring(L, DATA, &bytes);
    if (bytes % record != 0 || bytes == 0)
        glintL_error(L, "spheres.data: %d bytes a sphere (x, y, z, radius in %s) expected, got %I bytes", (int)record,
                     FORMATS[a->format], (LUAI_UACINT)bytes);
    a->desc.count = bytes / record;
    a->desc.is_float = a->format == FORMAT_F32;
}

static void read_list(lua_State *L, arguments *a)
{
    size_t count = glintL_check_list(L, DATA, "spheres.data", false);
    if (count % 4 != 0 || count == 0 || count / 4 > SPHERES_MAX)
        glintL_error(L, "spheres.data: 4 numbers a sphere (x, y, z, radius) expected, got %I numbers",
                     (LUAI_UACINT)count);
    double *out = lua_newuserdatauv(L, count * sizeof *out, 0);
    lua_replace(L, DATA_BUFFER);
    for (size_t i = 0; i < count; i++) {
        if (lua_rawgeti(L, DATA, (lua_Integer)i + 1) != LUA_TNUMBER) {
            const char *got = glintL_push_spelling(L, -1);
            glintL_error(L, "spheres.data[%I]: number expected, got %s", (LUAI_UACINT)i + 1, got);
        }
        out[i] = lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    a->desc.data = out;
    a->desc.count = count / 4;
}

static void read_data(lua_State *L, arguments *a)
{
    glintL_many_fetch(L, "data", DATA);
    if (lua_type(L, DATA) != LUA_TSTRING && !lua_istable(L, DATA))
        glintL_refuse(L, DATA, "spheres.data", "flat table or packed string of x, y, z, radius");
    read_format(L, a);
    if (lua_istable(L, DATA))
        read_list(L, a);
    else
        read_packed(L, a);
}

int glintL_new_spheres(lua_State *L)
{
    arguments a = { .desc = { .two_sided = true }, .transform = glint_transform_identity() };
    glint_shape *shape = NULL;
    glint_error error;
    lua_settop(L, 1);
    glintL_box *box = glintL_new_box(L, GLINTL_SHAPE);
    lua_settop(L, KEPT);
    glintL_read_table(L, ARGUMENT, "spheres", FIELDS, &a, false);
    glint_material **pointers = glintL_many_prepare(L, &MANY, &a.desc.material_count);
    read_data(L, &a);
    a.desc.material_index = glintL_many_index(L, &MANY, a.desc.count, a.desc.material_count);
    glintL_many_read(L, &MANY, a.desc.material_count, pointers);
    a.desc.materials = pointers;
    glintL_check_status(L, "spheres", &error, glint_spheres_create(&a.desc, &shape, &error));
    box->object = shape;
    glint_shape_desc placed = *glint_shape_get(shape);
    placed.transform = a.transform;
    glintL_check_status(L, "spheres", &error, glint_shape_set(shape, &placed, &error));
    glintL_many_keep(L, &MANY, BOX);
    lua_settop(L, BOX);
    glintL_remember(L, shape);
    glintL_charge(L, a.desc.count * 4 * sizeof(double));
    return 1;
}
