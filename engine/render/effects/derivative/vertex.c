/// Derivatives of light that is computed once per face or vertex. Each has its slopes next to its light, and a sample
/// interpolates between those of its triangle, with weights that change as the sample moves. See
/// effects/vertex_shading/vertex.c.
#include "engine/base/vec.h"
#include "engine/render/effects/derivative/work.h"
#include "engine/render/effects/vertex_shading/shading_points.h"

/// Returns the cached values of a face or vertex: its light, then its slopes for each derivative.
static double *stored_slopes(const glint_tile_frame *frame, uint32_t side, uint32_t number)
{
    const glint_shading_points_cached *all = glint_shading_points_of(frame);
    return all->slopes + ((size_t)side * all->blocks * GLINT_SHADING_POINT_BLOCK + number) * 3 * (all->slope_count + 1);
}

void glint_derive_store_block(const glint_tile *tile, const glint_tile_frame *frame, uint32_t block)
{
    const glint_derivative_work *work = glint_derivative_of(tile);
    const bool weighs = glint_derivatives_read_light(tile, frame->plan);
    for (uint32_t i = 0; i < GLINT_SHADING_POINT_BLOCK; i++) {
        double *to = stored_slopes(frame, 0, block * GLINT_SHADING_POINT_BLOCK + i); // the backs' blocks follow
        for (int c = 0; c < 3; c++) {
            to[c] = weighs ? work->light[c][i] : 0;
            for (size_t k = 0; k < frame->plan->derivatives->count; k++)
                to[3 * (k + 1) + (size_t)c] = work->sum[k][c][i];
        }
    }
}

/// Computes the weights of a triangle's corners at sample i.
static void find_share(const glint_tile_frame *frame, const glint_prim *prim, const glint_derivative_points *points, uint32_t i,
                       double out[3])
{
    double from[3];
    for (int c = 0; c < 3; c++)
        from[c] = points->point[c][i % GLINT_GROUP] - prim->corner[0][c];
    glint_bend_shares(frame->geometry.scale, prim, from, out);
    out[0] += 1;
}

/// Adds the value interpolated between three corners. change: the slopes of their weights; NULL: the sample does not
/// move.
static void spread(const glint_tile *tile, double *const at[3], const double share[3],
                   const double *change, size_t index, uint32_t i)
{
    for (int c = 0; c < 3; c++) {
        double slope = 0;
        for (int j = 0; j < 3; j++)
            slope += share[j] * at[j][3 * (index + 1) + (size_t)c] + (change ? change[j] * at[j][c] : 0);
        glint_derivative_of(tile)->sum[index][c][i] += slope;
    }
}

static void derive_sample(const glint_tile *tile, const glint_tile_frame *frame, uint32_t i)
{
    static const double whole[3] = { 1, 0, 0 };
    const glint_prim *prim = &frame->geometry.prims[tile->at.prim[i]];
    const uint32_t *number = frame->geometry.shading_points[prim->shading_points].at;
    glint_derivative_points points;
    glint_derivative_find_points(tile, frame, i / GLINT_GROUP, &points);
    const bool flat = number[0] == number[1] && number[0] == number[2];
    double *at[3], share[3];
    for (int j = 0; j < 3; j++)
        at[j] = stored_slopes(frame, glint_has_lane(tile->hit.back, i), number[j]);
    find_share(frame, prim, &points, i, share);
    if (flat)
        vec_copy(share, whole);
    for (int c = 0; c < 3 && glint_derivatives_read_light(tile, frame->plan); c++)
        glint_derivative_of(tile)->light[c][i] += (share[0] * at[0][c] + share[1] * at[1][c]) + share[2] * at[2][c];
    for (size_t k = 0; k < frame->plan->derivatives->count; k++) {
        glint_bend bend;
        double change[3];
        const bool bends = !flat && frame->plan->derivatives->of[k].bends && glint_bend_sample(tile, frame, k, i, &points, &bend);
        if (bends)
            glint_bend_shares(frame->geometry.scale, prim, bend.point, change);
        spread(tile, at, share, bends ? change : NULL, k, i);
    }
}

void glint_derive_vertex(const glint_tile *tile, const glint_tile_frame *frame, const uint16_t *wanted)
{
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = wanted[g] & tile->active[g]; bits; bits &= bits - 1)
            derive_sample(tile, frame, g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits));
}
