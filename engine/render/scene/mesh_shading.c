/// Data of a mesh for smooth shading: vertex normals, and the points at which light is computed once for several
/// faces.
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/glint_inspect.h"
#include "engine/render/scene/objects.h"

#include <stdlib.h>

static bool is_zero(const double v[3]) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

/// Computes vertex normals as the area-weighted mean of the faces around each vertex.
static glint_status make_normals(glint_mesh *mesh, glint_error *error)
{
    double(*normals)[3] = calloc(mesh->vertex_count, sizeof *normals);
    if (!normals)
        return glint_fail_nomem(error);
    double largest = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int c = 1; c < 3; c++) {
            double side[3];
            vec_sub(side, mesh->vertices[mesh->triangles[i][c]], mesh->vertices[mesh->triangles[i][0]]);
            largest = fmax(largest, vec_max_abs(side));
        }
    const double scale = power_of_two_scale(largest);
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *at = mesh->triangles[i];
        double f[3], g[3], cross[3];
        vec_sub(f, mesh->vertices[at[1]], mesh->vertices[at[0]]);
        vec_sub(g, mesh->vertices[at[2]], mesh->vertices[at[0]]);
        vec_scale(f, f, scale);
        vec_scale(g, g, scale);
        vec_cross(cross, f, g);
        for (int c = 0; c < 9; c++)
            normals[at[c / 3]][c % 3] += cross[c % 3];
    }
    for (size_t i = 0; i < mesh->vertex_count; i++)
        if (!is_zero(normals[i]))
            vec_normalize(normals[i], normals[i]);
    mesh->normals = normals;
    mesh->averaged = true;
    return GLINT_OK;
}

/// The shading points of each vertex, as linked lists: one for each combination of normal and material.
typedef struct chains {
    uint32_t *first; ///< first shading point of each vertex; GLINT_NO_NORMAL: none
    uint32_t *next, *normal; ///< for each shading point, the next one of the same vertex; its normal
    uint32_t *material; ///< material of each shading point; NULL: all have the same material
} chains;

/// Returns the shading point of a vertex with a given normal and material, and makes it if needed. A corner without a
/// normal uses the face's normal and gets a shading point of its own.
static uint32_t shading_point_of(const glint_mesh *mesh, chains *c, uint32_t vertex, uint32_t normal, uint32_t material,
                                 size_t *count)
{
    const bool alone = is_zero(mesh->normals[normal]);
    uint32_t at = alone ? GLINT_NO_NORMAL : c->first[vertex];
    while (at != GLINT_NO_NORMAL && (c->normal[at] != normal || (c->material && c->material[at] != material)))
        at = c->next[at];
    if (at != GLINT_NO_NORMAL)
        return at;
    at = (uint32_t)(*count)++;
    if (!alone) {
        c->normal[at] = normal;
        if (c->material)
            c->material[at] = material;
        c->next[at] = c->first[vertex];
        c->first[vertex] = at;
    }
    return at;
}

static void link_corners(glint_mesh *mesh, const uint32_t *index, chains *c)
{
    uint32_t(*normals)[3] = mesh->triangle_normals ? mesh->triangle_normals : mesh->triangles;
    memset(c->first, 0xff, mesh->vertex_count * sizeof *c->first);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int j = 0; j < 3; j++)
            mesh->shading_points[i][j] = shading_point_of(mesh, c, mesh->triangles[i][j], normals[i][j],
                                                          index ? index[i] : 0, &mesh->shading_point_count);
}

static glint_status number_shading_points(glint_mesh *mesh, const uint32_t *index, glint_error *error)
{
    const size_t corners = 3 * mesh->triangle_count;
    if (!mesh->triangle_normals && !index) {
        mesh->shading_point_count = mesh->vertex_count;
        return GLINT_OK;
    }
    if (corners >= GLINT_NO_NORMAL)
        return glint_fail(error, GLINT_ERR_INVALID, "shading: gouraud allows at most %u triangles, got %zu",
                          GLINT_NO_NORMAL / 3, mesh->triangle_count);
    chains c = { malloc(mesh->vertex_count * sizeof *c.first), malloc(corners * sizeof *c.next),
                 malloc(corners * sizeof *c.normal), index ? malloc(corners * sizeof *c.material) : NULL };
    mesh->shading_points = malloc(mesh->triangle_count * sizeof *mesh->shading_points);
    const bool allocated = c.first && c.next && c.normal && (c.material || !index) && mesh->shading_points;
    if (allocated)
        link_corners(mesh, index, &c);
    free(c.first);
    free(c.next);
    free(c.normal);
    free(c.material);
    if (allocated)
        return GLINT_OK;
    free(mesh->shading_points);
    mesh->shading_points = NULL;
    return glint_fail_nomem(error);
}

glint_status glint_mesh_prepare(glint_mesh *mesh, const uint32_t *index, glint_shading shading, glint_error *error)
{
    glint_status status = GLINT_OK;
    if ((shading == GLINT_SHADING_PHONG || shading == GLINT_SHADING_GOURAUD) && !mesh->normals)
        status = make_normals(mesh, error);
    if (!status && shading == GLINT_SHADING_GOURAUD && !mesh->shading_point_count)
        status = number_shading_points(mesh, index, error);
    return status;
}

/// Returns the smallest cosine of an angle between the normal of a triangle's face and the normal of one of its
/// corners.
static double least_cosine(const glint_mesh *mesh, size_t i)
{
    const uint32_t *at = mesh->triangles[i], *normal = mesh->triangle_normals ? mesh->triangle_normals[i] : at;
    double f[3], g[3], n[3], least = 1;
    vec_sub(f, mesh->vertices[at[1]], mesh->vertices[at[0]]);
    vec_sub(g, mesh->vertices[at[2]], mesh->vertices[at[0]]);
    const double scale = power_of_two_scale(fmax(vec_max_abs(f), vec_max_abs(g)));
    vec_scale(f, f, scale);
    vec_scale(g, g, scale);
    vec_cross(n, f, g);
    if (!(vec_max_abs(n) > 0))
        return 1;
    vec_normalize(n, n);
    for (int j = 0; j < 3; j++)
        if (!is_zero(mesh->normals[normal[j]]))
            least = fmin(least, fabs(vec_dot(n, mesh->normals[normal[j]])));
    return least;
}

double glint_mesh_bend(const glint_shape *shape)
{
    if (!shape)
        return 0;
    glint_mesh *mesh = shape->mesh;
    double least = 1;
    if (!mesh || !mesh->normals || shape->desc.shading != GLINT_SHADING_PHONG)
        return 0;
    for (size_t i = 0; mesh->bend == 0 && i < mesh->triangle_count; i++)
        least = fmin(least, least_cosine(mesh, i));
    if (mesh->bend == 0)
        mesh->bend = acos(fmin(least, 1));
    return mesh->bend;
}

bool glint_mesh_get(const glint_shape *shape, glint_mesh_data *out)
{
    const glint_mesh *mesh = shape && out ? shape->mesh : NULL;
    if (!mesh)
        return false;
    *out = (glint_mesh_data) {
        .vertices = *mesh->vertices,
        .vertex_count = mesh->vertex_count,
        .triangles = *mesh->triangles,
        .triangle_count = mesh->triangle_count,
        .normals = mesh->normals && !mesh->averaged ? *mesh->normals : NULL,
        .normal_corners = mesh->triangle_normals ? *mesh->triangle_normals : NULL,
        .uv = mesh->uv ? *mesh->uv : NULL,
        .uv_corners = mesh->triangle_uv ? *mesh->triangle_uv : NULL,
        .faces = mesh->faces,
    };
    return true;
}
