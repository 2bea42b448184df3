// The constructor glint.spheres: many spheres from a flat table or a packed string.
#include <string.h>

#include "bindings/value/glintL.h"

#define SPHERES_MAX ((size_t)1 << 30)

typedef enum format { FORMAT_NONE, FORMAT_F32, FORMAT_F64 } format;

typedef struct arguments {
    glint_spheres_desc desc;
    format format;
    glint_transform transform;
} arguments;

static const char *const FORMATS[] = { "none", "f32", "f64", NULL };

static const glintL_field FIELDS[] = {
    { .name = "data", .kind = GLINTL_OTHER },
    { .name = "format", .kind = GLINTL_OTHER },
    { .name = "material", .kind = GLINTL_OTHER },
    { .name = "materials", .kind = GLINTL_OTHER },
    { .name = "index", .kind = GLINTL_OTHER },
    { .name = "transform", .kind = GLINTL_TRANSFORM, .offset = offsetof(arguments, transform) },
    { .name = "two_sided", .kind = GLINTL_BOOLEAN, .offset = offsetof(arguments, desc.two_sided) },
    { .name = "name", .kind = GLINTL_STRING, .offset = offsetof(arguments, desc.name) },
    { .name = NULL },
};

// The stack of the constructor: its argument, the box, then what the argument's fields hold and room for each.
enum { ARGUMENT = 1, BOX, DATA, DATA_BUFFER, FORMAT, INDEX, INDEX_BUFFER, MATERIAL, MATERIALS, POINTERS, KEPT };

// Moves a field of the argument to its place on the stack.
static void fetch(lua_State *L, const char *name, int place)
{
    lua_pushstring(L, name);
    lua_rawget(L, ARGUMENT);
    lua_replace(L, place);
}

static void read_format(lua_State *L, arguments *a)
{
    static const glintL_field field = {
        .name = "format",
        .kind = GLINTL_ENUM,
        .offset = offsetof(arguments, format),
        .names = FORMATS + 1,
    };
    fetch(L, "format", FORMAT);
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
    fetch(L, "data", DATA);
    if (lua_type(L, DATA) != LUA_TSTRING && !lua_istable(L, DATA))
        glintL_refuse(L, DATA, "spheres.data", "flat table or packed string of x, y, z, radius");
    read_format(L, a);
    if (lua_istable(L, DATA))
        read_list(L, a);
    else
        read_packed(L, a);
}

// One number of the index, counted from 1, at any Lua integer.
static uint32_t checked(lua_State *L, size_t i, lua_Integer number, size_t material_count)
{
    if (number < 1 || (size_t)number > material_count)
        glintL_error(L, "spheres.index[%I]: number 1 .. %I expected, got %I", (LUAI_UACINT)i + 1,
                     (LUAI_UACINT)material_count, (LUAI_UACINT)number);
    return (uint32_t)number - 1;
}

static void read_index_list(lua_State *L, size_t count, size_t material_count, uint32_t *out)
{
    for (size_t i = 0; i < count; i++) {
        int is_whole = 0;
        bool is_number = lua_rawgeti(L, INDEX, (lua_Integer)i + 1) == LUA_TNUMBER;
        lua_Integer number = lua_tointegerx(L, -1, &is_whole);
        if (!is_number || !is_whole) {
            const char *got = glintL_push_spelling(L, -1);
            glintL_error(L, "spheres.index[%I]: whole number expected, got %s", (LUAI_UACINT)i + 1, got);
        }
        out[i] = checked(L, i, number, material_count);
        lua_pop(L, 1);
    }
}

static void read_index_packed(lua_State *L, size_t count, size_t material_count, uint32_t *out)
{
    const char *packed = lua_tostring(L, INDEX);
    for (size_t i = 0; i < count; i++) {
        uint32_t number;
        memcpy(&number, packed + i * sizeof number, sizeof number);
        out[i] = checked(L, i, number, material_count);
    }
}

static void read_index(lua_State *L, arguments *a)
{
    size_t count, expected = a->desc.count;
    fetch(L, "index", INDEX);
    if (lua_isnil(L, INDEX) && a->desc.material_count < 2)
        return;
    if (a->desc.material_count == 0)
        glintL_error(L, "spheres.index: materials expected with an index");
    if (lua_istable(L, INDEX)) {
        count = glintL_check_list(L, INDEX, "spheres.index", false);
        if (count != expected)
            glintL_error(L, "spheres.index: %I numbers (one a sphere) expected, got %I", (LUAI_UACINT)expected,
                         (LUAI_UACINT)count);
    } else if (lua_type(L, INDEX) == LUA_TSTRING) {
        count = lua_rawlen(L, INDEX);
        if (count % sizeof(uint32_t) != 0 || count / sizeof(uint32_t) != expected)
            glintL_error(L, "spheres.index: %I bytes (a u32 a sphere) expected, got %I bytes",
                         (LUAI_UACINT)(expected * sizeof(uint32_t)), (LUAI_UACINT)count);
    } else {
        glintL_refuse(L, INDEX, "spheres.index", "table or packed string of numbers");
    }
    uint32_t *out = lua_newuserdatauv(L, expected * sizeof *out, 0);
    lua_replace(L, INDEX_BUFFER);
    if (lua_istable(L, INDEX))
        read_index_list(L, expected, a->desc.material_count, out);
    else
        read_index_packed(L, expected, a->desc.material_count, out);
    a->desc.material_index = out;
}

// Counts the materials and makes room for their pointers, and the list that keeps them alive.
static void *prepare_materials(lua_State *L, arguments *a)
{
    fetch(L, "material", MATERIAL);
    fetch(L, "materials", MATERIALS);
    if (!lua_isnil(L, MATERIAL) && !lua_isnil(L, MATERIALS))
        glintL_error(L, "spheres: material or materials expected, got both");
    if (lua_isnil(L, MATERIAL) && lua_isnil(L, MATERIALS))
        return NULL;
    lua_newtable(L);
    lua_replace(L, KEPT);
    if (!lua_isnil(L, MATERIAL)) {
        a->desc.material_count = 1;
        lua_pushvalue(L, MATERIAL);
        lua_rawseti(L, KEPT, 1);
    } else if (!lua_istable(L, MATERIALS)) {
        glintL_refuse(L, MATERIALS, "spheres.materials", "list of materials");
    } else {
        a->desc.material_count = glintL_check_list(L, MATERIALS, "spheres.materials", false);
        if (a->desc.material_count == 0)
            glintL_error(L, "spheres.materials: list of materials expected, got an empty table");
    }
    for (size_t i = 1; !lua_isnil(L, MATERIALS) && i <= a->desc.material_count; i++) {
        lua_rawgeti(L, MATERIALS, (lua_Integer)i);
        lua_rawseti(L, KEPT, (lua_Integer)i);
    }
    void *pointers = lua_newuserdatauv(L, a->desc.material_count * sizeof(glint_material *), 0);
    lua_replace(L, POINTERS);
    return pointers;
}

// Last before the engine is called, and without allocating: until then a finalizer could close a material.
static void read_materials(lua_State *L, const arguments *a, glint_material **pointers)
{
    for (size_t i = 0; i < a->desc.material_count; i++) {
        lua_rawgeti(L, KEPT, (lua_Integer)i + 1);
        pointers[i] = glintL_test_object(L, -1, GLINTL_MATERIAL);
        if (!pointers[i] && !lua_isnil(L, MATERIAL))
            glintL_refuse(L, -1, "spheres.material", "material");
        if (!pointers[i]) {
            const char *got = glintL_push_spelling(L, -1);
            glintL_error(L, "spheres.materials[%I]: material expected, got %s", (LUAI_UACINT)i + 1, got);
        }
        lua_pop(L, 1);
    }
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
    glint_material **pointers = prepare_materials(L, &a);
    read_data(L, &a);
    read_index(L, &a);
    read_materials(L, &a, pointers);
    a.desc.materials = pointers;
    glintL_check_status(L, "spheres", &error, glint_spheres_create(&a.desc, &shape, &error));
    box->object = shape;
    glint_shape_desc placed = *glint_shape_get(shape);
    placed.transform = a.transform;
    glintL_check_status(L, "spheres", &error, glint_shape_set(shape, &placed, &error));
    if (!lua_isnil(L, MATERIAL))
        glintL_keep(L, BOX, "material", MATERIAL);
    else if (!lua_isnil(L, MATERIALS))
        glintL_keep(L, BOX, "materials", KEPT);
    lua_settop(L, BOX);
    glintL_remember(L, shape);
    glintL_charge(L, a.desc.count * 4 * sizeof(double));
    return 1;
}
