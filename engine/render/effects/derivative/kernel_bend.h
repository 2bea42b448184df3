// Computes how fast visible hits on one sphere or plane move. Contract: contract.h. For single hits on any
// kind of primitive, see bend.c of effects/derivative.
#ifndef GLINT_DERIVATIVE_KERNEL_BEND_H
#define GLINT_DERIVATIVE_KERNEL_BEND_H

#include "engine/render/effects/derivative/kernel_sloped.h"
#include "engine/render/pattern/kernel_exact.h"
#include "engine/render/stages/simd/elementary.h"

/// The rays of VD hits: directions of any length, slopes of origin and direction, and the distances of the hits.
typedef struct bent_rays {
    vd direction[3], moved[3], turned[3], far;
} bent_rays;

INNER bent_rays see_from_point(const glint_bend_args *args, int i)
{
    const glint_derivative_view *view = args->view;
    const glint_bend_camera *camera = args->camera;
    const glint_derivative_points *points = args->points;
    bent_rays out = { .far = d_set(1) };
    for (int c = 0; c < 3; c++) {
        out.direction[c] =
            d_either(view->moves, d_load(points->point[c] + i) - d_set(camera->eye[c]), -d_load(points->eye[c] + i));
        out.moved[c] = d_set(view->eye[c]);
    }
    for (int c = 0; c < 3; c++) {
        const vd turn[3] = { d_set(camera->turn[c][0]), d_set(camera->turn[c][1]), d_set(camera->turn[c][2]) };
        out.turned[c] = DOT(turn, out.direction);
    }
    return out;
}

/// Returns the rays of a camera that is orthographic or has a lens.
INNER bent_rays see_along(const glint_bend_args *args, const bool parallel, int i)
{
    const glint_derivative_view *view = args->view;
    const glint_bend_camera *camera = args->camera;
    const vd x = d_load(args->screen[0] + i), y = d_load(args->screen[1] + i), zero = d_set(0),
             near = d_set(camera->near);
    bent_rays out;
    vd seen[3];
    for (int c = 0; c < 3; c++) {
        const vd across = x * d_set(camera->right[c]) + y * d_set(camera->up[c]);
        const vd changed = x * d_set(view->right[c]) + y * d_set(view->up[c]);
        const vd at = d_load(args->shift[c] + i), slope = d_load(args->shift_slope[c] + i);
        seen[c] = d_load(args->points->point[c] + i) - (d_set(camera->eye[c]) + (d_either(parallel, across, zero) + at));
        out.direction[c] = d_set(camera->forward[c]) + (d_either(parallel, zero, across) - at * near);
        out.moved[c] = d_set(view->eye[c]) + (d_either(parallel, changed, zero) + slope);
        out.turned[c] = d_set(view->forward[c]) + (d_either(parallel, zero, changed) - (slope * near + at * d_set(view->nearer)));
    }
    out.far = DOT(seen, out.direction) / DOT(out.direction, out.direction);
    return out;
}

/// Computes slopes of points, normals and eye vectors, into `out`. The point stays on the tangent plane, which moves
/// like the surface at that point.
INNER void hold_lanes(const glint_bend_args *args, const bent_rays *rays, const bool round, int i, vd out[3][3])
{
    const glint_prim *prim = args->prim;
    const glint_derivative_part *part = args->part;
    const glint_derivative_points *points = args->points;
    vd gradient[3], off[3], carried[3], normal[3], eye[3], rest = d_set(0);
    for (int c = 0; c < 3; c++) {
        const vd point = d_load(points->point[c] + i);
        eye[c] = d_load(points->eye[c] + i);
        normal[c] = d_load(points->normal[c] + i);
        off[c] = point - d_set(prim->center[c]);
        gradient[c] = d_either(round, off[c], d_set(round ? 0 : prim->normal[c]));
        carried[c] = rays->moved[c] + rays->far * rays->turned[c];
        rest = rest + gradient[c] * ((d_set(part->position[c]) - carried[c]) + d_set(part->growth) * off[c]);
        if (!round)
            rest = rest - d_set(part->normal[c]) * (point - d_set(part->pivot[c]));
    }
    const vd further = rest / DOT(gradient, rays->direction);
    const vd side = d_select(d_lt(DOT(gradient, normal), d_set(0)), d_set(-1), d_set(1));
    const vd shorter = d_set(-1) / DOT(rays->direction, eye),
             away = DOT(rays->turned, eye); // the vector eye is opposite to the ray
    const vd curved = side * d_set(round ? 1 / prim->radius : 1);
    for (int c = 0; c < 3; c++) {
        const vd moved = carried[c] + further * rays->direction[c];
        const vd offset = (moved - d_set(part->position[c])) - off[c] * d_set(part->growth);
        out[0][c] = moved;
        out[1][c] = d_either(round, offset * curved, side * d_set(part->normal[c]));
        out[2][c] = (away * eye[c] - rays->turned[c]) * shorter;
    }
}

INNER void bend_group(const glint_bend_args *args, const bool along, const bool parallel, const bool round)
{
    const glint_bend_args call = *args; // a copy, because stores might change it
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        const bent_rays rays = along ? see_along(&call, parallel, i) : see_from_point(&call, i);
        vd slope[3][3];
        hold_lanes(&call, &rays, round, i, slope);
        for (int k = 0; k < 9; k++)
            d_store(call.slope[k / 3][k % 3] + i, slope[k / 3][k % 3]);
    }
}

static void bend(const glint_bend_args *args)
{
    const bool along = args->screen[0], parallel = along && args->camera->orthographic;
    const bool round = args->prim->kind == GLINT_PRIM_SPHERE;
    if (parallel && round)
        bend_group(args, true, true, true);
    else if (parallel)
        bend_group(args, true, true, false);
    else if (along && round)
        bend_group(args, true, false, true);
    else if (along)
        bend_group(args, true, false, false);
    else if (round)
        bend_group(args, false, false, true);
    else
        bend_group(args, false, false, false);
}

#endif
