/// Determines whether a mesh has an inside: along every edge, as many triangles run in one direction as in the other.
/// Corners at the same position count as one. A ray then enters as often as it leaves, whatever edges and corners it
/// hits.
#include "engine/base/hash.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/scene/objects.h"

#include <stdlib.h>
#include <string.h>

typedef struct edge {
    uint32_t low, high; ///< positions of the edge's ends; low + 1 == 0: a free slot
    uint32_t up, down; ///< number of triangles that run from low to high, and from high to low
} edge;

typedef struct seams {
    const glint_mesh *mesh;
    uint32_t *first_at; ///< for each vertex, the first vertex at the same position
    edge *edges; ///< hash table
    size_t slots; ///< number of slots, a power of two
} seams;

static size_t power_above(size_t count)
{
    size_t size = 16;
    while (size < count)
        size *= 2;
    return size;
}

static bool find_first_vertices(seams *s)
{
    const size_t count = s->mesh->vertex_count, size = power_above(2 * count);
    uint32_t *slots = calloc(size, sizeof *slots); // number + 1
    if (!slots)
        return false;
    for (size_t i = 0; i < count; i++) {
        double at[3], other[3];
        for (int c = 0; c < 3; c++)
            at[c] = s->mesh->vertices[i][c] + 0.0; // -0 and 0 are the same position
        size_t slot = glint_key_add((glint_key) { 0 }, at, sizeof at).low & (size - 1);
        for (; slots[slot]; slot = (slot + 1) & (size - 1)) {
            for (int c = 0; c < 3; c++)
                other[c] = s->mesh->vertices[slots[slot] - 1][c] + 0.0;
            if (memcmp(at, other, sizeof at) == 0)
                break;
        }
        if (!slots[slot])
            slots[slot] = (uint32_t)i + 1;
        s->first_at[i] = slots[slot] - 1;
    }
    free(slots);
    return true;
}

static edge *find_edge(const seams *s, uint32_t a, uint32_t b)
{
    const uint32_t ends[2] = { a < b ? a : b, a < b ? b : a };
    size_t slot = glint_key_add((glint_key) { 0 }, ends, sizeof ends).low & (s->slots - 1);
    edge *e = &s->edges[slot];
    while (e->low != UINT32_MAX && (e->low != ends[0] || e->high != ends[1])) {
        slot = (slot + 1) & (s->slots - 1);
        e = &s->edges[slot];
    }
    return e;
}

/// Writes the ends of the edge from corner j of a triangle to the next. False: the edge has no length.
static bool edge_ends(const seams *s, size_t triangle, int j, uint32_t ends[2])
{
    const uint32_t *at = s->mesh->triangles[triangle];
    ends[0] = s->first_at[at[j]];
    ends[1] = s->first_at[at[(j + 1) % 3]];
    return ends[0] != ends[1];
}

static void count_edges(seams *s)
{
    memset(s->edges, 0xff, s->slots * sizeof *s->edges);
    for (size_t i = 0; i < s->mesh->triangle_count; i++)
        for (int j = 0; j < 3; j++) {
            uint32_t ends[2];
            if (!edge_ends(s, i, j, ends))
                continue;
            edge *e = find_edge(s, ends[0], ends[1]);
            if (e->low == UINT32_MAX)
                *e = (edge) { ends[0] < ends[1] ? ends[0] : ends[1], ends[0] < ends[1] ? ends[1] : ends[0], 0, 0 };
            e->up += ends[0] < ends[1];
            e->down += ends[0] > ends[1];
        }
}

/// Stores the first open edge, in the order of the triangles.
static void find_open_edge(const seams *s, glint_closure *out)
{
    for (size_t i = 0; i < s->mesh->triangle_count; i++)
        for (int j = 0; j < 3; j++) {
            uint32_t ends[2];
            if (!edge_ends(s, i, j, ends))
                continue;
            const edge *e = find_edge(s, ends[0], ends[1]);
            if (e->up == e->down)
                continue;
            out->triangles = e->up + e->down;
            vec_copy(out->edge[0], s->mesh->vertices[ends[0]]);
            vec_copy(out->edge[1], s->mesh->vertices[ends[1]]);
            return;
        }
}

/// Returns six times the volume, in units of the largest extent; below 0 if the triangles are inside out.
static double volume_of(const glint_mesh *mesh)
{
    const double *from = mesh->vertices[mesh->triangles[0][0]];
    double largest = 0, sum = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int c = 0; c < 3; c++)
            largest = fmax(largest, fabs(0.5 * mesh->vertices[i][c] - 0.5 * from[c]));
    const double scale = 0.5 * power_of_two_scale(largest);
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        double side[3][3], cross[3];
        for (int j = 0; j < 3; j++)
            for (int c = 0; c < 3; c++)
                side[j][c] = mesh->vertices[mesh->triangles[i][j]][c] * scale - from[c] * scale;
        vec_cross(cross, side[1], side[2]);
        sum += vec_dot(side[0], cross);
    }
    return sum;
}

glint_status glint_mesh_find_closure(glint_mesh *mesh, glint_error *error)
{
    if (mesh->closure.computed)
        return GLINT_OK;
    seams s = { .mesh = mesh, .slots = power_above(4 * mesh->triangle_count) };
    s.first_at = malloc(mesh->vertex_count * sizeof *s.first_at);
    s.edges = malloc(s.slots * sizeof *s.edges);
    const bool allocated = s.first_at && s.edges && find_first_vertices(&s);
    if (allocated) {
        count_edges(&s);
        find_open_edge(&s, &mesh->closure);
        mesh->closure.inverted = volume_of(mesh) < 0;
        mesh->closure.computed = true;
    }
    free(s.first_at);
    free(s.edges);
    return allocated ? GLINT_OK : glint_fail_nomem(error);
}
