// The numbers of spheres, cylinders and meshes, read as arrays.
#include <string.h>

#include "bindings/lua/many.h"
#include "engine/glint.h"
#include "engine/glint_inspect.h"

// Allocating an array may run a finalizer of the script, so that the shape is read again afterwards.
static const glint_shape *shape_of(lua_State *L) { return glintL_check_object(L, 1, GLINTL_SHAPE); }

int glintL_get_data(lua_State *L)
{
    const size_t width = glint_shape_get(shape_of(L))->kind == GLINT_SHAPE_SPHERES ? 4 : 7, count = glint_spheres_count(shape_of(L));
    glintL_array *out = glintL_push_array(L, count, width, false);
    memcpy(out->numbers, glint_spheres_data(shape_of(L)), count * width * sizeof *out->numbers);
    return 1;
}

// Pushes an array of numbers that count from 1; nil: there are none.
static int push_wholes(lua_State *L, const uint32_t *(*get)(const glint_shape *shape), size_t width)
{
    const size_t count = glint_spheres_count(shape_of(L));
    if (!get(shape_of(L))) {
        lua_pushnil(L);
        return 1;
    }
    glintL_array *out = glintL_push_array(L, count, width, true);
    const uint32_t *from = get(shape_of(L));
    for (size_t i = 0; i < count * width; i++)
        out->wholes[i] = (int64_t)from[i] + 1;
    return 1;
}

static const uint32_t *triangles_of(const glint_shape *shape)
{
    glint_mesh_data data;
    return glint_mesh_get(shape, &data) ? data.triangles : NULL;
}

int glintL_get_index(lua_State *L) { return push_wholes(L, glint_spheres_index, 1); }
int glintL_get_faces(lua_State *L) { return push_wholes(L, triangles_of, 3); }

typedef struct part { // numbers of a mesh
    const double *rows; // NULL: there are none
    const uint32_t *corners; // row of each corner of a triangle; NULL: a row a vertex
    size_t count;
} part;

static part part_of(lua_State *L, char which)
{
    glint_mesh_data data;
    if (!glint_mesh_get(shape_of(L), &data))
        return (part) { NULL, NULL, 0 };
    if (which == 'v')
        return (part) { data.vertices, NULL, data.vertex_count };
    const uint32_t *corners = which == 'n' ? data.normal_corners : data.uv_corners;
    return (part) { which == 'n' ? data.normals : data.uv, corners, corners ? 3 * data.triangle_count : data.vertex_count };
}

static int push_part(lua_State *L, char which, size_t width)
{
    part from = part_of(L, which);
    if (!from.rows) {
        lua_pushnil(L);
        return 1;
    }
    glintL_array *out = glintL_push_array(L, from.count, width, false);
    from = part_of(L, which);
    for (size_t i = 0; i < from.count; i++)
        memcpy(out->numbers + width * i, from.rows + width * (from.corners ? from.corners[i] : i), width * sizeof *out->numbers);
    return 1;
}

int glintL_get_vertices(lua_State *L) { return push_part(L, 'v', 3); }
int glintL_get_normals(lua_State *L) { return push_part(L, 'n', 3); }
int glintL_get_uv(lua_State *L) { return push_part(L, 'u', 2); }
