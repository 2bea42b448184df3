/// Smoothing groups of .obj files: corners without a normal get the area-weighted mean of the normals of the faces
/// around their vertex that are in the same group.
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/files/mesh/file.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/// A vertex in a smoothing group. glint_mesh_find compares the first two members.
typedef struct smooth_vertex {
    uint32_t vertex, group;
    double sum[3]; ///< of the areas of the group's faces, as vectors
} smooth_vertex;

glint_status glint_mesh_read_group(glint_mesh_reader *r, const char *at)
{
    char *end;
    at = glint_skip_blanks(at);
    errno = 0;
    const unsigned long group = strtoul(at, &end, 10);
    if (glint_mesh_is_word(at, "off")) {
        r->group = 0;
    } else if (end != at && *at != '-' && !errno && group < UINT32_MAX && glint_ends_number(*end)) {
        r->group = (uint32_t)group;
    } else {
        glint_mesh_note_that(r, GLINT_MESH_NOTE_GROUP, r->text.number, "'s %.40s' is ignored: the number of a smoothing group, or off, expected", at);
    }
    return GLINT_OK;
}

/// Adds twice the area of a face as a vector, scaled: the sum of the cross products of its fan.
static void add_area(const double *vertices, const uint32_t *corners, uint32_t size, double scale, double sum[3])
{
    const double *first = vertices + 3 * (size_t)corners[0];
    for (uint32_t i = 1; i + 1 < size; i++) {
        double f[3], g[3], cross[3];
        vec_sub(f, vertices + 3 * (size_t)corners[i], first);
        vec_sub(g, vertices + 3 * (size_t)corners[i + 1], first);
        vec_scale(f, f, scale);
        vec_scale(g, g, scale);
        vec_cross(cross, f, g);
        for (int c = 0; c < 3; c++)
            sum[c] += cross[c];
    }
}

static double scale_of(const glint_mesh_reader *r)
{
    const double *v = r->vertices.items;
    double largest = 0;
    for (size_t i = 0; i < 3 * r->vertices.count; i++)
        largest = isfinite(v[i]) ? fmax(largest, fabs(v[i])) : largest;
    return power_of_two_scale(largest);
}

/// Collects the vertices of all groups, and for each corner without a normal the index of its vertex among them.
static glint_status collect(glint_mesh_reader *r, glint_mesh_array *found, uint32_t *index)
{
    const uint32_t *corners = r->corners.items, *sizes = r->sizes.items, *groups = r->groups.items;
    const double scale = scale_of(r);
    glint_mesh_set set = { 0 };
    glint_status status = GLINT_OK;
    size_t first = 0;
    for (size_t i = 0; i < r->sizes.count && !status; first += sizes[i++]) {
        double area[3] = { 0 };
        if (groups[i])
            add_area(r->vertices.items, corners + first, sizes[i], scale, area);
        for (size_t k = first; k < first + sizes[i] && !status; k++) {
            const smooth_vertex item = { .vertex = corners[k], .group = groups[i] };
            index[k] = GLINT_NO_NORMAL;
            if (!groups[i])
                continue;
            status = glint_mesh_find(&set, found, &item, 2 * sizeof(uint32_t), &index[k], r->error);
            for (int c = 0; c < 3 && !status; c++)
                ((smooth_vertex *)found->items)[index[k]].sum[c] += area[c];
        }
    }
    free(set.slots);
    return status;
}

/// Appends the normals of the vertices of groups, and gives them to the corners without a normal.
static glint_status assign(glint_mesh_reader *r, const glint_mesh_array *found, const uint32_t *index)
{
    static const double up[3] = { 0, 0, 1 }; // not used: its corners have the normals of their faces
    uint32_t *normals = r->corner_normals.items;
    const smooth_vertex *vertices = found->items;
    const size_t base = r->normals.count;
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < found->count && !status; i++) {
        const double *sum = vertices[i].sum, most = vec_max_abs(sum);
        double n[3];
        vec_copy(n, up);
        if (most > 0 && isfinite(most))
            vec_normalize(n, sum);
        status = glint_mesh_append(&r->normals, n, r->error);
    }
    for (size_t k = 0; k < r->corners.count && !status; k++) {
        const double most = index[k] == GLINT_NO_NORMAL ? 0 : vec_max_abs(vertices[index[k]].sum);
        if (normals[k] == GLINT_NO_NORMAL && most > 0 && isfinite(most)) {
            normals[k] = (uint32_t)(base + index[k]);
            r->has_normals = true;
        }
    }
    return status;
}

glint_status glint_mesh_smooth(glint_mesh_reader *r)
{
    glint_mesh_array found = { .size = sizeof(smooth_vertex) };
    uint32_t *normals = r->corner_normals.items;
    bool needed = false;
    for (size_t i = 0, k = 0; i < r->sizes.count; i++)
        for (const size_t end = k + ((const uint32_t *)r->sizes.items)[i]; k < end; k++)
            needed = needed || (((const uint32_t *)r->groups.items)[i] && (!r->has_normals || normals[k] == GLINT_NO_NORMAL));
    if (!needed)
        return GLINT_OK;
    uint32_t *index = malloc(r->corners.count * sizeof *index);
    if (!index)
        return glint_fail_nomem(r->error);
    if (!r->has_normals) { // the indices may refer to normals that the file does not have
        memset(normals, 0xff, r->corners.count * sizeof *normals);
        r->normals.count = 0;
    }
    glint_status status = collect(r, &found, index);
    if (!status && r->normals.count + found.count >= GLINT_NO_NORMAL)
        status = glint_fail(r->error, GLINT_ERR_FORMAT, "%s: too many normals", r->text.path);
    if (!status)
        status = assign(r, &found, index);
    free(index);
    free(found.items);
    return status;
}
