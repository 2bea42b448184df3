// vertex: interpolates light that was computed at the corners of a triangle, or once for its face, at each sample.
// Contract: contract.h.
#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/simd/real.h"

/// Adds the light of one lane's shading points; w: the weights of the corners.
static inline void R(add_shading_points)(const glint_vertex_args *args, const glint_shading_points *shading_points,
                                         unsigned back, const double w[3], size_t lane)
{
    const glint_shading_point_light *light = args->light[back];
    const glint_shading_point_light *a = &light[shading_points->at[0]], *b = &light[shading_points->at[1]],
                                    *c = &light[shading_points->at[2]];
    const bool face = a == b && a == c;
    for (int term = 0; term < (args->sum[1][0] ? 2 : 1); term++)
        for (int k = 0; k < 3; k++) {
            const double x = a->term[term][k], y = b->term[term][k], z = c->term[term][k];
            args->sum[term][k][lane] += face ? x : (w[0] * x + w[1] * y) + w[2] * z;
        }
}

/// Computes the lanes of a group that hit one triangle.
static inline void R(vertex_lanes)(const glint_vertex_args *args, const glint_prim *prim,
                                   R(group_directions) directions, size_t at, unsigned lanes)
{
    const glint_shading_points *shading_points = &args->shading_points[prim->shading_points];
    const bool face = shading_points->at[0] == shading_points->at[1] && shading_points->at[0] == shading_points->at[2];
    const unsigned back = args->back[at / GLINT_GROUP];
    _Alignas(64) real w[3][GLINT_GROUP];
    for (int i = 0; i < GLINT_GROUP && !face; i += VR) {
        if (!(lanes >> i & ((1u << VR) - 1)))
            continue;
        vr corner[3][3], from[3], d[3], weight[3], point[3], slack;
        R(corners_of)(prim, corner);
        R(load_direction)(directions, args->direction, at, i, d);
        for (int k = 0; k < 3; k++)
            from[k] = args->camera ? r_set(args->camera->eye[k]) : r_load((const real *)args->origin[k] + at + i);
        R(triangle_point)(corner, args->scale, from, d, weight, point, &slack);
        for (int j = 0; j < 3; j++)
            r_store(w[j] + i, weight[j]);
    }
    for (; lanes; lanes &= lanes - 1) {
        const unsigned lane = (unsigned)__builtin_ctz(lanes);
        const double weights[3] = { face ? 0 : (double)w[0][lane], face ? 0 : (double)w[1][lane],
                                    face ? 0 : (double)w[2][lane] };
        R(add_shading_points)(args, shading_points, back >> lane & 1, weights, at + lane);
    }
}

static void R(vertex)(const glint_vertex_args *args)
{
    for (R(group_cursor) cursor = { 0 }; cursor.g < args->group_count; R(next_group)(args->camera, &cursor)) {
        const size_t at = (size_t)cursor.g * GLINT_GROUP;
        const R(group_directions) directions = R(directions_of)(args->camera, cursor.x, cursor.y);
        unsigned rest = args->wanted[cursor.g];
        while (rest) {
            const uint32_t id = args->prim[at + (unsigned)__builtin_ctz(rest)];
            const unsigned lanes = lanes_equal(args->prim + at, id) & rest;
            R(vertex_lanes)(args, &args->prims[id], directions, at, lanes);
            rest &= ~lanes;
        }
    }
}

#if GLINT_WITH(VERTEX_SHADING)
KERNEL(vertex, glint_vertex_args)
#endif
