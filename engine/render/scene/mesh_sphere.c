/// A sphere made of triangles, for comparison with the exact one.
#include "engine/base/math.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/glint_inspect.h"
#include "engine/render/scene/objects.h"

#include <stdlib.h>

#define PI 0x1.921fb54442d18p+1

typedef struct globe {
    uint32_t across, down; ///< number of segments around the axis, and from pole to pole
    size_t vertex_count, face_count;
    double *vertices, *normals;
    uint32_t *corners, *sizes;
} globe;

/// Computes the direction of a point on ring y (0 is the north pole, along +y) and segment x.
static void globe_direction(const globe *g, uint32_t x, uint32_t y, double out[3])
{
    const double around = 2 * PI * x / g->across, down = PI * y / g->down;
    out[0] = glint_sin(down) * glint_cos(around);
    out[1] = glint_cos(down);
    out[2] = glint_sin(down) * glint_sin(around);
}

static void add_vertex(globe *g, const double center[3], double radius, uint32_t x, uint32_t y)
{
    double *normal = g->normals + 3 * g->vertex_count, *vertex = g->vertices + 3 * g->vertex_count;
    globe_direction(g, x, y, normal);
    if (y == 0 || y == g->down) {
        normal[0] = normal[2] = 0;
        normal[1] = y == 0 ? 1 : -1;
    }
    for (int c = 0; c < 3; c++)
        vertex[c] = center[c] + radius * normal[c];
    g->vertex_count++;
}

/// Returns the index of a vertex. The vertices are one pole, then ring after ring, then the other pole.
static uint32_t vertex_at(const globe *g, uint32_t x, uint32_t y)
{
    if (y == 0)
        return 0;
    return y == g->down ? 1 + (g->down - 1) * g->across : 1 + (y - 1) * g->across + x % g->across;
}

static void add_face(globe *g, uint32_t x, uint32_t y, size_t *corner)
{
    const uint32_t at[4] = { vertex_at(g, x, y), vertex_at(g, x + 1, y), vertex_at(g, x + 1, y + 1),
                             vertex_at(g, x, y + 1) };
    uint32_t size = 0;
    for (int i = 0; i < 4; i++) { // two corners of a face at a pole coincide
        if ((i == 1 && at[1] == at[0]) || (i == 3 && at[3] == at[2]))
            continue;
        g->corners[*corner + size] = at[i];
        size++;
    }
    *corner += size;
    g->sizes[g->face_count++] = size;
}

static void make_globe(globe *g, const double center[3], double radius)
{
    size_t corner = 0;
    add_vertex(g, center, radius, 0, 0);
    for (uint32_t y = 1; y < g->down; y++)
        for (uint32_t x = 0; x < g->across; x++)
            add_vertex(g, center, radius, x, y);
    add_vertex(g, center, radius, 0, g->down);
    for (uint32_t y = 0; y < g->down; y++)
        for (uint32_t x = 0; x < g->across; x++)
            add_face(g, x, y, &corner);
}

glint_status glint_sphere_mesh_create(const double center[3], double radius, int64_t segments,
                                      const glint_mesh_desc *given, glint_shape **out, glint_error *error)
{
    GLINT_REFUSE_NULL(center, error);
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_mesh_desc, glint_mesh_desc_default());
    status = glint_check_vector("center", center, error);
    if (!status && !(radius > 0 && isfinite(radius)))
        status = glint_fail(error, GLINT_ERR_INVALID, "radius: number > 0 expected, got %.15g", radius);
    if (!status)
        status = glint_check_whole("segments", segments, 3, 16384, error);
    if (status)
        return status;
    globe g = { .across = (uint32_t)segments, .down = ((uint32_t)segments + 1) / 2 };
    const size_t cells = (size_t)g.across * g.down, points = cells - g.across + 2;
    g.vertices = malloc(points * 3 * sizeof *g.vertices);
    g.normals = malloc(points * 3 * sizeof *g.normals);
    g.corners = malloc(cells * 4 * sizeof *g.corners);
    g.sizes = malloc(cells * sizeof *g.sizes);
    if (!g.vertices || !g.normals || !g.corners || !g.sizes) {
        status = glint_fail_nomem(error);
    } else {
        make_globe(&g, center, radius);
        glint_mesh_desc mesh = *desc;
        mesh.struct_size = sizeof mesh;
        mesh.vertices = g.vertices;
        mesh.vertex_count = mesh.normal_count = g.vertex_count;
        mesh.normals = g.normals;
        mesh.normal_corners = NULL;
        mesh.corners = g.corners;
        mesh.face_sizes = g.sizes;
        mesh.face_count = g.face_count;
        status = glint_mesh_create(&mesh, out, error);
    }
    if (!status) {
        vec_copy((*out)->mesh->center, center);
        (*out)->mesh->radius = radius;
        (*out)->mesh->segments = segments;
    }
    free(g.vertices);
    free(g.normals);
    free(g.corners);
    free(g.sizes);
    return status;
}

bool glint_sphere_mesh_get(const glint_shape *shape, double center[3], double *radius, int64_t *segments)
{
    if (!shape || !center || !radius || !segments)
        return false;
    if (!shape->mesh || shape->mesh->segments == 0)
        return false;
    vec_copy(center, shape->mesh->center);
    *radius = shape->mesh->radius;
    *segments = shape->mesh->segments;
    return true;
}
