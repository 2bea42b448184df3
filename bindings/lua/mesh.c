// The constructors glint.mesh and glint.sphere_mesh.
#include <stdio.h>
#include <string.h>

#include "bindings/lua/many.h"
#include "bindings/lua/lua.h"

typedef struct arguments {
    glint_mesh_desc desc;
    unsigned format; // format of packed numbers: 0 not packed, 1 f32, 2 f64
    double center[3], radius;
    int64_t segments;
} arguments;

static const char *const SHADINGS[] = { "faceted", "phong", "flat", "gouraud", NULL };
static const char *const FORMATS[] = { "f32", "f64", NULL };

#define AT(member) offsetof(arguments, member)

#define EVERY_MESH \
    {.name = "shading", .type = GLINT_TYPE_CHOICE, .offset = AT(desc.shading), .set_offset = AT(desc.has_shading), \
     .names = SHADINGS}, \
    {.name = "terminator", .type = GLINT_TYPE_NUMBER, .offset = AT(desc.terminator)}, \
    {.name = "material", .type = GLINT_TYPE_OTHER}, \
    {.name = "transform", .type = GLINT_TYPE_TRANSFORM, .offset = AT(desc.transform)}, \
    {.name = "two_sided", .type = GLINT_TYPE_FLAG, .offset = AT(desc.two_sided)}, \
    {.name = "name", .type = GLINT_TYPE_TEXT, .offset = AT(desc.name)}

static const glintL_field FIELDS[] = {
    { .name = "file", .type = GLINT_TYPE_OTHER },
    { .name = "vertices", .type = GLINT_TYPE_OTHER },
    { .name = "faces", .type = GLINT_TYPE_OTHER },
    { .name = "normals", .type = GLINT_TYPE_OTHER },
    { .name = "uv", .type = GLINT_TYPE_OTHER },
    { .name = "format", .type = GLINT_TYPE_OTHER },
    { .name = "materials", .type = GLINT_TYPE_OTHER },
    { .name = "index", .type = GLINT_TYPE_OTHER },
    EVERY_MESH,
    { .name = NULL },
};

static const glintL_field SPHERE_FIELDS[] = {
    { .name = "center", .type = GLINT_TYPE_VECTOR, .offset = AT(center), .required = true },
    { .name = "radius", .type = GLINT_TYPE_NUMBER, .offset = AT(radius), .required = true },
    { .name = "segments", .type = GLINT_TYPE_WHOLE, .offset = AT(segments), .low = 3, .high = 16384, .required = true },
    EVERY_MESH,
    { .name = NULL },
};

// Stack positions of the constructors: the argument, the box, then the argument's fields and a buffer for each.
enum {
    ARGUMENT = 1,
    BOX,
    VERTICES,
    FACES,
    NORMALS,
    UV,
    OTHER,
    MATERIAL,
    MATERIALS,
    INDEX,
    INDEX_BUFFER,
    POINTERS,
    KEPT,
    CORNER_BUFFER,
    SIZE_BUFFER,
    NUMBER_BUFFER,
    UV_NUMBER_BUFFER
};

static const glintL_many MANY = { .object = "mesh",
                                  .each = "face",
                                  .material = MATERIAL,
                                  .materials = MATERIALS,
                                  .index = INDEX,
                                  .index_buffer = INDEX_BUFFER,
                                  .pointers = POINTERS,
                                  .kept = KEPT };

// ---- Vertices, normals and coordinates ----

// The form of a list's entries: x, y, z, or u, v.
typedef struct entry_kind {
    const char *name, *form;
    int size;
} entry_kind;

static const entry_kind VERTEX = { "vertices", "{x, y, z}", 3 }, NORMAL = { "normals", "{x, y, z}", 3 },
                        PAIR = { "uv", "{u, v}", 2 };

// Reads the entry on top of the stack.
static void read_entry(lua_State *L, const char *path, const entry_kind *kind, double *out)
{
    const int entry = lua_gettop(L);
    if (kind->size == 3) {
        glintL_read_three(L, entry, path, kind->form, out);
        return;
    }
    for (int i = 0; i < 2; i++) {
        if (!lua_istable(L, entry) || lua_rawlen(L, entry) != 2 || lua_rawgeti(L, entry, i + 1) != LUA_TNUMBER)
            glintL_refuse(L, entry, path, kind->form);
        out[i] = lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
}

// Replaces the list of rows at `index` by an array.
static const glintL_array *take_rows(lua_State *L, int index, const entry_kind *kind, size_t count)
{
    char path[64];
    glintL_array *out = glintL_push_array(L, count, (size_t)kind->size, false);
    for (size_t i = 0; i < count; i++) {
        strncpy(path, lua_pushfstring(L, "mesh.%s[%I]", kind->name, (LUAI_UACINT)i + 1), sizeof path - 1);
        path[sizeof path - 1] = 0;
        lua_pop(L, 1);
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        read_entry(L, path, kind, out->numbers + (size_t)kind->size * i);
        lua_pop(L, 1);
    }
    lua_replace(L, index);
    return out;
}

static bool is_flat(lua_State *L, int index)
{
    const bool flat = lua_rawgeti(L, index, 1) == LUA_TNUMBER;
    lua_pop(L, 1);
    return flat;
}

// The array at `index` has the numbers, and replaces a list or string there.
static const double *read_points(lua_State *L, const arguments *a, int index, const entry_kind *kind, size_t *count)
{
    char path[32], expected[80];
    const glintL_array *array = glintL_to_array(L, index);
    const size_t size = (size_t)kind->size, each = size * (a->format == 1 ? sizeof(float) : sizeof(double));
    snprintf(path, sizeof path, "mesh.%s", kind->name);
    snprintf(expected, sizeof expected, "list of %s, array of such rows, flat table or packed string", kind->form);
    if (lua_istable(L, index)) {
        const size_t entries = glintL_check_list(L, index, kind->name, false);
        const bool flat = is_flat(L, index);
        if (flat && entries % size != 0)
            glintL_error(L, "%s: %d numbers each expected, got %I numbers", path, kind->size, (LUAI_UACINT)entries);
        array = flat ? glintL_take_list(L, index, &(glintL_numbers) { .path = path }, entries)
                     : take_rows(L, index, kind, entries);
    } else if (lua_type(L, index) == LUA_TSTRING) {
        if (lua_rawlen(L, index) % each != 0)
            glintL_error(L, "%s: %d bytes each (%s in %s) expected, got %I bytes", path, (int)each,
                         size == 3 ? "x, y, z" : "u, v", FORMATS[a->format - 1], (LUAI_UACINT)lua_rawlen(L, index));
        array = glintL_take_packed(L, index, a->format == 1 ? 'f' : 'd');
    } else if (!array || array->is_whole || array->width != size) {
        glintL_refuse(L, index, path, expected);
        return NULL;
    }
    *count = array->count * array->width / size;
    return array->numbers;
}

static void read_format(lua_State *L, arguments *a)
{
    static const glintL_field field = { .name = "format", .type = GLINT_TYPE_CHOICE, .offset = AT(format), .names = FORMATS };
    bool packed = false;
    for (int index = VERTICES; index <= UV; index++)
        packed = packed || (index != FACES && lua_type(L, index) == LUA_TSTRING);
    glintL_many_fetch(L, "format", OTHER);
    if (packed) {
        glintL_read_field(L, OTHER, "mesh", &field, a);
        a->format++;
    } else if (!lua_isnil(L, OTHER)) {
        glintL_error(L, "mesh.format: only packed numbers have a format");
    }
}

// ---- Faces ----

// Checks one vertex number of a face, counted from 1.
static uint32_t checked_vertex(lua_State *L, const arguments *a, size_t face, lua_Integer number)
{
    if (number < 1 || (size_t)number > a->desc.vertex_count)
        glintL_error(L, "mesh.faces[%I]: vertex 1 .. %I expected, got %I", (LUAI_UACINT)face,
                     (LUAI_UACINT)a->desc.vertex_count, (LUAI_UACINT)number);
    return (uint32_t)number - 1;
}

// Reads the i-th entry of the list on top of the stack.
static uint32_t read_vertex_number(lua_State *L, const arguments *a, size_t face, size_t i)
{
    lua_rawgeti(L, -1, (lua_Integer)i);
    int whole;
    const lua_Integer number = lua_tointegerx(L, -1, &whole);
    if (!whole || lua_type(L, -1) != LUA_TNUMBER) {
        const char *got = glintL_push_spelling(L, -1);
        glintL_error(L, "mesh.faces[%I]: number of a vertex expected, got %s", (LUAI_UACINT)face, got);
    }
    const uint32_t vertex = checked_vertex(L, a, face, number);
    lua_pop(L, 1);
    return vertex;
}

static uint32_t *new_indices(lua_State *L, size_t count, int buffer)
{
    uint32_t *out = lua_newuserdatauv(L, (count ? count : 1) * sizeof *out, 0);
    lua_replace(L, buffer);
    return out;
}

// Reads triangles from the array at FACES.
static void read_triangles(lua_State *L, arguments *a, const glintL_array *array)
{
    const size_t numbers = array->count * array->width;
    if (numbers % 3 != 0)
        glintL_error(L, "mesh.faces: 3 numbers a triangle expected, got %I numbers", (LUAI_UACINT)numbers);
    a->desc.face_count = numbers / 3;
    uint32_t *sizes = new_indices(L, a->desc.face_count, SIZE_BUFFER), *out = new_indices(L, numbers, CORNER_BUFFER);
    for (size_t i = 0; i < numbers; i++) {
        sizes[i / 3] = 3;
        out[i] = checked_vertex(L, a, i / 3 + 1, array->wholes[i]);
    }
    a->desc.face_sizes = sizes;
    a->desc.corners = out;
}

static void read_polygons(lua_State *L, arguments *a, size_t faces)
{
    char path[48];
    size_t corners = 0;
    uint32_t *sizes = new_indices(L, faces, SIZE_BUFFER);
    for (size_t i = 0; i < faces; i++) {
        lua_rawgeti(L, FACES, (lua_Integer)i + 1);
        strncpy(path, lua_pushfstring(L, "mesh.faces[%I]", (LUAI_UACINT)i + 1), sizeof path - 1);
        path[sizeof path - 1] = 0;
        lua_pop(L, 1);
        if (!lua_istable(L, -1))
            glintL_refuse(L, -1, path, "list of numbers of vertices");
        const size_t size = glintL_check_list(L, -1, path, false);
        if (size < 3 || size > INT32_MAX)
            glintL_error(L, "%s: 3 vertices or more expected, got %I", path, (LUAI_UACINT)size);
        sizes[i] = (uint32_t)size;
        corners += size;
        lua_pop(L, 1);
    }
    uint32_t *out = new_indices(L, corners, CORNER_BUFFER);
    a->desc.corners = out;
    a->desc.face_sizes = sizes;
    a->desc.face_count = faces;
    for (size_t i = 0; i < faces; i++) {
        lua_rawgeti(L, FACES, (lua_Integer)i + 1);
        for (size_t j = 0; j < sizes[i]; j++)
            *out++ = read_vertex_number(L, a, i + 1, j + 1);
        lua_pop(L, 1);
    }
}

static void read_faces(lua_State *L, arguments *a)
{
    static const glintL_numbers numbers = { "mesh.faces", "number of a vertex", 3, true };
    const glintL_array *array = glintL_to_array(L, FACES);
    if (lua_type(L, FACES) == LUA_TSTRING) {
        if (lua_rawlen(L, FACES) % sizeof(uint32_t) != 0)
            glintL_error(L, "mesh.faces: 12 bytes a triangle (three u32) expected, got %I bytes",
                         (LUAI_UACINT)lua_rawlen(L, FACES));
        array = glintL_take_packed(L, FACES, 'u');
    } else if (lua_istable(L, FACES)) {
        const size_t entries = glintL_check_list(L, FACES, "mesh.faces", false);
        if (!is_flat(L, FACES)) {
            read_polygons(L, a, entries);
            return;
        }
        array = glintL_take_list(L, FACES, &numbers, entries);
    } else if (!array || !array->is_whole || (array->width != 1 && array->width != 3)) {
        glintL_refuse(L, FACES, "mesh.faces",
                      "list of faces, array of three integers a row, flat table of triangles or packed string of u32");
        return;
    }
    read_triangles(L, a, array);
}

// ---- Normals and coordinates: one per vertex, or one per corner in the order of the faces ----

// Returns the numbers 0, 1, 2 ... if entries belong to corners; NULL: they belong to vertices.
static const uint32_t *number_corners(lua_State *L, const arguments *a, const char *name, size_t count, int buffer)
{
    size_t corners = 0;
    for (size_t i = 0; i < a->desc.face_count; i++)
        corners += a->desc.face_sizes[i];
    if (count == a->desc.vertex_count)
        return NULL;
    if (count != corners)
        glintL_error(L, "mesh.%s: one per vertex (%I) or one per corner of a face (%I) expected, got %I", name,
                     (LUAI_UACINT)a->desc.vertex_count, (LUAI_UACINT)corners, (LUAI_UACINT)count);
    uint32_t *numbers = new_indices(L, corners, buffer);
    for (size_t i = 0; i < corners; i++)
        numbers[i] = (uint32_t)i;
    return numbers;
}

static void read_arrays(lua_State *L, arguments *a)
{
    glintL_many_fetch(L, "vertices", VERTICES);
    glintL_many_fetch(L, "faces", FACES);
    glintL_many_fetch(L, "normals", NORMALS);
    glintL_many_fetch(L, "uv", UV);
    read_format(L, a);
    a->desc.vertices = read_points(L, a, VERTICES, &VERTEX, &a->desc.vertex_count);
    read_faces(L, a);
    if (!lua_isnil(L, NORMALS)) {
        a->desc.normals = read_points(L, a, NORMALS, &NORMAL, &a->desc.normal_count);
        a->desc.normal_corners = number_corners(L, a, "normals", a->desc.normal_count, NUMBER_BUFFER);
    }
    if (!lua_isnil(L, UV)) {
        a->desc.uv = read_points(L, a, UV, &PAIR, &a->desc.uv_count);
        a->desc.uv_corners = number_corners(L, a, "uv", a->desc.uv_count, UV_NUMBER_BUFFER);
    }
}

// ---- Objects ----

// Reads the material. Call it right before the engine, with no allocation in between: a finalizer could close the
// material.
static void read_material(lua_State *L, const char *path, arguments *a)
{
    a->desc.material = glintL_test_object(L, MATERIAL, GLINTL_MATERIAL);
    if (!a->desc.material && !lua_isnil(L, MATERIAL))
        glintL_refuse(L, MATERIAL, path, "material");
}

static glintL_box *begin(lua_State *L)
{
    lua_settop(L, 1);
    glintL_box *box = glintL_new_box(L, GLINTL_SHAPE);
    lua_settop(L, UV_NUMBER_BUFFER);
    return box;
}

// Retains the materials of a file with the mesh, so that the script's changes to their fields persist.
static void keep_materials(lua_State *L, const glint_shape *shape)
{
    glint_material *const *list;
    const size_t count = glint_shape_materials(shape, &list);
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        glintL_push_object(L, GLINTL_MATERIAL, list[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    if (count == 1)
        lua_rawgeti(L, -1, 1);
    glintL_keep(L, BOX, count == 1 ? "material" : "materials", -1);
}

static int finish(lua_State *L, glintL_box *box, glint_shape *shape)
{
    box->object = shape;
    lua_settop(L, KEPT);
    glintL_many_keep(L, &MANY, BOX);
    if (lua_isnil(L, MATERIAL) && !lua_isnil(L, OTHER))
        keep_materials(L, shape);
    lua_settop(L, BOX);
    glintL_remember(L, shape);
    glintL_charge(L, glint_spheres_count(shape) * 6 * sizeof(double));
    return 1;
}

static void note_read(void *context, const char *path)
{
    const glintL_reporter *reporter = &((const glintL_run *)context)->reporter;
    if (reporter->reads)
        reporter->reads(reporter->context, path);
}

static void note_warning(void *context, const char *message) { glintL_run_warn(context, "%s", message); }

static glint_status load(lua_State *L, arguments *a, glint_shape **shape, glint_error *error)
{
    static const char *const arrays[] = { "vertices", "faces", "normals", "uv", "format", "materials", "index" };
    if (lua_type(L, OTHER) != LUA_TSTRING)
        glintL_refuse(L, OTHER, "mesh.file", "name of a file");
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        glintL_many_fetch(L, arrays[i], VERTICES);
        if (!lua_isnil(L, VERTICES))
            glintL_error(L, "mesh: file or %s expected, got both", arrays[i]);
    }
    const char *path = lua_tostring(L, OTHER);
    if (strlen(path) != lua_rawlen(L, OTHER))
        glintL_error(L, "mesh.file: string without a zero byte expected");
    read_material(L, "mesh.material", a);
    glintL_run *run = glintL_get_run(L);
    if (run->request.is_untrusted) // the answers would tell an untrusted script which files exist
        glintL_error(L, "mesh.file: an untrusted script reads no files");
    a->desc.reads = note_read;
    a->desc.warns = note_warning;
    a->desc.context = run;
    path = glintL_push_file(L, path);
    lua_replace(L, OTHER);
    return glint_mesh_load(path, &a->desc, shape, error);
}

// Raises an error in the file whose path is at OTHER as "FILE:LINE: what", like the readers in Lua, and without the
// script's position. The traceback of the script follows.
static void check_loaded(lua_State *L, const glint_error *error, glint_status status)
{
    const char *path = lua_tostring(L, OTHER);
    if (status && strncmp(error->message, path, strlen(path)) == 0) {
        lua_pushstring(L, error->message);
        lua_error(L);
    }
    glintL_check_status(L, "mesh", error, status);
}

int glintL_new_mesh(lua_State *L)
{
    arguments a = { .desc = glint_mesh_desc_default() };
    glint_shape *shape = NULL;
    glint_error error;
    glintL_box *box = begin(L);
    glintL_read_table(L, ARGUMENT, "mesh", FIELDS, &a, false);
    glintL_many_fetch(L, "material", MATERIAL);
    glintL_many_fetch(L, "file", OTHER);
    if (!lua_isnil(L, OTHER)) {
        check_loaded(L, &error, load(L, &a, &shape, &error));
    } else {
        glint_material **pointers = glintL_many_prepare(L, &MANY, &a.desc.material_count);
        read_arrays(L, &a);
        a.desc.material_index = glintL_many_index(L, &MANY, a.desc.face_count, a.desc.material_count);
        glintL_many_read(L, &MANY, a.desc.material_count, pointers);
        a.desc.materials = pointers;
        glintL_check_status(L, "mesh", &error, glint_mesh_create(&a.desc, &shape, &error));
    }
    return finish(L, box, shape);
}

int glintL_new_sphere_mesh(lua_State *L)
{
    arguments a = { .desc = glint_mesh_desc_default() };
    glint_shape *shape = NULL;
    glint_error error;
    glintL_box *box = begin(L);
    glintL_read_table(L, ARGUMENT, "sphere_mesh", SPHERE_FIELDS, &a, false);
    glintL_many_fetch(L, "material", MATERIAL);
    read_material(L, "sphere_mesh.material", &a);
    glintL_check_status(L, "sphere_mesh", &error,
                        glint_sphere_mesh_create(a.center, a.radius, a.segments, &a.desc, &shape, &error));
    return finish(L, box, shape);
}
