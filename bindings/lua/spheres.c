// The constructors glint.spheres and glint.cylinders: many of them from an array, a flat table or a packed string.
#include <stdio.h>

#include "bindings/lua/many.h"
#include "engine/glint.h"

#define ITEMS_MAX ((size_t)1 << 30)

typedef enum format { FORMAT_NONE, FORMAT_F32, FORMAT_F64 } format;

typedef struct arguments {
    glint_spheres_desc desc;
    format format;
    glint_transform transform;
    bool capped;
    const glintL_many *many;
    size_t numbers; // of each sphere or cylinder
    const char *names; // of these numbers
} arguments;

static const char *const FORMATS[] = { "none", "f32", "f64", NULL };

// The first one is a field of cylinders only.
static const glintL_field FIELDS[] = {
    { .name = "capped", .type = GLINT_TYPE_FLAG, .offset = offsetof(arguments, capped) },
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
enum { ARGUMENT = 1, BOX, DATA, FORMAT, INDEX, INDEX_BUFFER, MATERIAL, MATERIALS, POINTERS, KEPT };

#define PLACES \
    .material = MATERIAL, .materials = MATERIALS, .index = INDEX, .index_buffer = INDEX_BUFFER, .pointers = POINTERS, .kept = KEPT
static const glintL_many SPHERES = { .object = "spheres", .each = "sphere", PLACES };
static const glintL_many CYLINDERS = { .object = "cylinders", .each = "cylinder", PLACES };

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
        glintL_read_field(L, FORMAT, a->many->object, &field, a);
        a->format = a->format == 0 ? FORMAT_F32 : FORMAT_F64;
    } else if (!lua_isnil(L, FORMAT)) {
        glintL_error(L, "%s.format: only packed data has a format", a->many->object);
    }
}

static void read_data(lua_State *L, arguments *a)
{
    char path[32], expected[96];
    const char *each = a->many->each;
    glintL_many_fetch(L, "data", DATA);
    const glintL_array *array = glintL_to_array(L, DATA);
    const size_t bytes = lua_type(L, DATA) == LUA_TSTRING ? lua_rawlen(L, DATA) : 0;
    snprintf(path, sizeof path, "%s.data", a->many->object);
    snprintf(expected, sizeof expected, "array, flat table or packed string of %s", a->names);
    if (lua_type(L, DATA) != LUA_TSTRING && !lua_istable(L, DATA) && !array)
        glintL_refuse(L, DATA, path, expected);
    read_format(L, a);
    const size_t record = a->numbers * (a->format == FORMAT_F32 ? sizeof(float) : sizeof(double));
    if (a->format && (bytes % record != 0 || bytes == 0))
        glintL_error(L, "%s: %d bytes a %s (%s in %s) expected, got %I bytes", path, (int)record, each, a->names,
                     FORMATS[a->format], (LUAI_UACINT)bytes);
    if (array && (array->is_whole || (array->width != 1 && array->width != a->numbers)))
        glintL_error(L, "%s: array of %d numbers a row (%s) expected, got %I %s", path, (int)a->numbers, a->names,
                     (LUAI_UACINT)array->width, array->is_whole ? "integers" : "numbers");
    if (a->format) { // the engine reads packed numbers without another copy
        a->desc.data = lua_tostring(L, DATA);
        a->desc.count = bytes / record;
        a->desc.is_float = a->format == FORMAT_F32;
        return;
    }
    if (!array)
        array = glintL_take_list(L, DATA, &(glintL_numbers) { .path = path }, glintL_check_list(L, DATA, path, false));
    const size_t count = array->count * array->width;
    if (count % a->numbers != 0 || count == 0 || count / a->numbers > ITEMS_MAX)
        glintL_error(L, "%s: %d numbers a %s (%s) expected, got %I numbers", path, (int)a->numbers, each, a->names,
                     (LUAI_UACINT)count);
    a->desc.data = array->numbers;
    a->desc.count = count / a->numbers;
}

static int make(lua_State *L, arguments *a, const glintL_field *fields,
                glint_status (*create)(const glint_spheres_desc *desc, glint_shape **out, glint_error *error))
{
    const glintL_many *many = a->many;
    glint_shape *shape = NULL;
    glint_error error;
    lua_settop(L, 1);
    glintL_box *box = glintL_new_box(L, GLINTL_SHAPE);
    lua_settop(L, KEPT);
    a->desc.two_sided = a->capped = true;
    a->transform = glint_transform_identity();
    glintL_read_table(L, ARGUMENT, many->object, fields, a, false);
    glint_material **pointers = glintL_many_prepare(L, many, &a->desc.material_count);
    read_data(L, a);
    a->desc.material_index = glintL_many_index(L, many, a->desc.count, a->desc.material_count);
    glintL_many_read(L, many, a->desc.material_count, pointers);
    a->desc.materials = pointers;
    glintL_check_status(L, many->object, &error, create(&a->desc, &shape, &error));
    box->object = shape;
    glint_shape_desc placed = *glint_shape_get(shape);
    placed.struct_size = sizeof placed;
    placed.transform = a->transform;
    placed.capped = a->capped;
    glintL_check_status(L, many->object, &error, glint_shape_set(shape, &placed, &error));
    glintL_many_keep(L, many, BOX);
    lua_settop(L, BOX);
    glintL_remember(L, shape);
    glintL_charge(L, a->desc.count * a->numbers * sizeof(double));
    return 1;
}

int glintL_new_spheres(lua_State *L)
{
    arguments a = { .desc.struct_size = sizeof a.desc, .many = &SPHERES, .numbers = 4, .names = "x, y, z, radius" };
    return make(L, &a, FIELDS + 1, glint_spheres_create);
}

int glintL_new_cylinders(lua_State *L)
{
    arguments a = { .desc.struct_size = sizeof a.desc, .many = &CYLINDERS, .numbers = 7, .names = "base, top, radius" };
    return make(L, &a, FIELDS, glint_cylinders_create);
}
