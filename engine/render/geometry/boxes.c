/// Boxes of primitives in the BVH's frame, and the bounding spheres that kernels use to reject primitives far from a
/// ray.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/geometry/geometry.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 8192 ///< primitives that a worker takes at a time

/// Returns the smallest float not below x. Branch-free, because half of all x are rounded down.
static inline float float_up(double x)
{
    float f = (float)x;
    int32_t bits;
    memcpy(&bits, &f, sizeof bits);
    bits += ((double)f < x) * (bits < 0 ? -1 : 1);
    memcpy(&f, &bits, sizeof bits);
    return f;
}

static inline float float_down(double x) { return -float_up(-x); }

/// Numbers beyond this count as infinite; differences of floats up to it are still finite.
#define BOX_MAX 0x1p120

/// A primitive's box in the BVH's frame: its centre, half its size, and half its size with the margin.
typedef struct placed_box {
    double center[3], half[3], loose[3];
} placed_box;

static inline placed_box place_sphere(const glint_geometry_table *table, const glint_prim *prim)
{
    placed_box box;
    for (int c = 0; c < 3; c++) {
        box.center[c] = (prim->center[c] - table->reference[c]) * table->scale;
        box.half[c] = prim->radius * table->scale;
        box.loose[c] = box.half[c] + 0x1p-50 * (fabs(box.center[c]) + box.half[c]);
    }
    return box;
}

/// Returns the margin of a box in the BVH's units. It covers rounding, the difference between a solid and its
/// inverse, and the distance by which a point may be off a triangle and still count as on it. This distance is at
/// most 13 times the slack of the scene's coordinates: twice the error bounds that the stage `surface` gives for the
/// point, for two edges and for a coordinate, plus one slack for the corners relative to the point.
static double box_slack(const glint_geometry_table *table, const glint_prim *prim, double center, double half)
{
    const double rounding = 0x1p-50 * (fabs(center) + half);
    if (prim->kind == GLINT_PRIM_SOLID)
        return rounding + 0x1p-30 * half;
    if (prim->kind == GLINT_PRIM_TRIANGLE)
        return rounding + 16 * GLINT_POINT_SLACK_DOUBLE * table->extent * table->scale;
    return rounding;
}

static inline placed_box place_box(const glint_geometry_table *table, const glint_prim *prim)
{
    placed_box box;
    double lower[3], upper[3];
    if (prim->kind == GLINT_PRIM_SPHERE)
        return place_sphere(table, prim);
    glint_prim_bounds(table->solids, prim, lower, upper);
    for (int c = 0; c < 3; c++) {
        box.center[c] = (0.5 * upper[c] + 0.5 * lower[c] - table->reference[c]) * table->scale;
        box.half[c] = (0.5 * upper[c] - 0.5 * lower[c]) * table->scale;
        box.loose[c] = box.half[c] + box_slack(table, prim, box.center[c], box.half[c]);
    }
    return box;
}

static inline void write_box(const placed_box *placed, uint32_t item, glint_box *box)
{
    for (int c = 0; c < 3; c++) {
        const double lower = placed->center[c] - placed->loose[c], upper = placed->center[c] + placed->loose[c];
        box->lower[c] = float_down(lower > -BOX_MAX ? lower : -BOX_MAX);
        box->upper[c] = float_up(upper < BOX_MAX ? upper : BOX_MAX);
    }
    box->item = item;
    box->unused = 0;
}

/// Returns the radius of a sphere around an ellipsoid or torus, in world units. The map M stretches no vector by more
/// than the square root of the largest row sum of |M^T M|, which is exact if the map preserves angles.
static double reach_of(const glint_solid *solid)
{
    const double unit = solid->form == GLINT_FORM_BALL ? 1 : solid->form == GLINT_FORM_TORUS ? 1 + solid->tube : HUGE_VAL;
    double most = 0;
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++)
            sum += fabs((solid->forward[0][i] * solid->forward[0][j] + solid->forward[1][i] * solid->forward[1][j]) +
                        solid->forward[2][i] * solid->forward[2][j]);
        most = fmax(most, sum);
    }
    return unit * sqrt(most);
}

void glint_prim_place_sphere(const glint_geometry_table *table, glint_prim *prim)
{
    const placed_box box = place_box(table, prim);
    double radius = prim->kind == GLINT_PRIM_SPHERE ? box.half[0] : sqrt(vec_dot(box.loose, box.loose));
    if (prim->kind == GLINT_PRIM_SOLID)
        radius = fmin(radius, reach_of(&table->solids[prim->item]) * table->scale * (1 + 0x1p-20));
    for (int c = 0; c < 3; c++)
        prim->filter_center[c] = (float)box.center[c];
    prim->filter_bound = float_up(radius * (1 + 2e-6) + GLINT_FILTER_SLACK * sqrt(vec_dot(box.center, box.center)) + FLT_MIN);
}

/// The map turns a unit circle into an ellipse. Half of the ellipse's length is the square root of the larger
/// eigenvalue of the matrix of the dot products of the map's columns.
void glint_prim_place_axis(const glint_geometry_table *table, const glint_prim *prim, glint_solid *solid)
{
    const bool about_axis = solid->form == GLINT_FORM_CYLINDER || solid->form == GLINT_FORM_TUBE ||
                            solid->form == GLINT_FORM_CONE || solid->form == GLINT_FORM_FUNNEL;
    double column[3][3];
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            column[i][c] = solid->forward[c][i] * table->scale;
    const double xx = vec_dot(column[0], column[0]), yy = vec_dot(column[1], column[1]),
                 xy = vec_dot(column[0], column[1]), length = sqrt(vec_dot(column[2], column[2]));
    const double thick = sqrt(0.5 * ((xx + yy) + sqrt((xx - yy) * (xx - yy) + 4 * (xy * xy))));
    for (int c = 0; c < 3; c++)
        solid->axis[c] = (float)(column[2][c] / length);
    solid->thick = about_axis && thick < 0.5 * prim->filter_bound && thick > FLT_MIN ? float_up(thick) : HUGE_VALF;
}

void glint_prim_place_box(const glint_geometry_table *table, const glint_prim *prim, uint32_t item, glint_box *box)
{
    const placed_box placed = place_box(table, prim);
    write_box(&placed, item, box);
}

// ---- All boxes ----

typedef struct box_work {
    const glint_geometry *geometry;
    glint_box *boxes;
    uint32_t *first; ///< first box of each chunk; before that is known, the number of its boxes
    bool solids;
} box_work;

static inline bool has_box(const box_work *work, const glint_prim *prim)
{
    return glint_prim_in_tree(prim) && !(work->solids && prim->kind == GLINT_PRIM_TRIANGLE);
}

static uint32_t chunk_end(const box_work *work, size_t chunk)
{
    const size_t end = (chunk + 1) * CHUNK, count = work->geometry->table.prim_count;
    return (uint32_t)(end < count ? end : count);
}

static void count_chunk(void *context, size_t index, int worker)
{
    (void)worker;
    box_work *work = context;
    uint32_t count = 0;
    for (uint32_t i = (uint32_t)index * CHUNK; i < chunk_end(work, index); i++)
        count += has_box(work, &work->geometry->prims[i]);
    work->first[index] = count;
}

static void fill_chunk(void *context, size_t index, int worker)
{
    (void)worker;
    const box_work *work = context;
    glint_box *box = work->boxes + work->first[index];
    for (uint32_t i = (uint32_t)index * CHUNK; i < chunk_end(work, index); i++)
        if (has_box(work, &work->geometry->prims[i]))
            glint_prim_place_box(&work->geometry->table, &work->geometry->prims[i], i, box++);
}

glint_box *glint_geometry_boxes(const glint_geometry *geometry, uint32_t count, bool solids, glint_pool *pool)
{
    const size_t chunks = ((size_t)geometry->table.prim_count + CHUNK - 1) / CHUNK;
    box_work work = { geometry, glint_boxes_alloc(count), glint_alloc(chunks, sizeof *work.first), solids };
    uint32_t next = 0;
    if (!work.boxes || !work.first) {
        if (work.boxes)
            glint_boxes_free(work.boxes, count);
        free(work.first);
        return NULL;
    }
    glint_run_items(pool, chunks, count_chunk, &work);
    for (size_t i = 0; i < chunks; i++) {
        const uint32_t boxes = work.first[i];
        work.first[i] = next;
        next += boxes;
    }
    glint_run_items(pool, chunks, fill_chunk, &work);
    free(work.first);
    return work.boxes;
}
