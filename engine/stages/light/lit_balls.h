// lit_balls: surface and light of one plain light in one pass, for groups that only show spheres, in some or all
// lanes. All lanes are processed together, each with its own sphere. The arithmetic is the same as in surface.h and
// plain.h. Contract: stages.h.
#ifndef GLINT_LIGHT_LIT_BALLS_H
#define GLINT_LIGHT_LIT_BALLS_H

#include "engine/stages/cast/camera.h"
#include "engine/stages/light/light.h"
#include "engine/stages/light/lit_surface.h"
#include "engine/stages/light/plain.h"
#include "engine/stages/simd/real.h"
#include "engine/stages/surface/surface.h"

/// The spheres of a group, one per lane; all fields are 0 in lanes without a hit.
typedef struct R(ball_lanes) {
    vr center[3][LIT_PARTS], radius[LIT_PARTS], scale[LIT_PARTS], inverse_radius[LIT_PARTS];
} R(ball_lanes);

INNER R(ball_lanes) R(no_balls)(void)
{
    R(ball_lanes) out;
    for (int j = 0; j < LIT_PARTS; j++) {
        for (int k = 0; k < 3; k++)
            out.center[k][j] = r_set(0);
        out.radius[j] = out.scale[j] = out.inverse_radius[j] = r_set(0);
    }
    return out;
}

INNER void R(put_ball)(const glint_prim *prim, unsigned lanes, R(ball_lanes) * balls)
{
    const real scale = (real)glint_sphere_scale(prim), inverse_radius = (real)1 / ((real)prim->radius * scale);
#pragma GCC unroll 8
    for (int j = 0; j < LIT_PARTS; j++) {
        const rm mask = rm_from_bits(lanes >> j * VR & ((1u << VR) - 1));
        for (int k = 0; k < 3; k++)
            balls->center[k][j] = r_select(mask, r_set(prim->center[k]), balls->center[k][j]);
        balls->radius[j] = r_select(mask, r_set(prim->radius), balls->radius[j]);
        balls->scale[j] = r_select(mask, r_set(scale), balls->scale[j]);
        balls->inverse_radius[j] = r_select(mask, r_set(inverse_radius), balls->inverse_radius[j]);
    }
}

/// Looks up the spheres of the lanes in `hits`, and the constants of these spheres. Returns false if some hit is on
/// another kind of primitive.
INNER bool R(find_balls)(const glint_surface_args *surface, const glint_light_args *light, size_t at, unsigned hits,
                         R(surface_walk) * walk, R(ball_lanes) * balls, R(lit_point) * point)
{
    point->phong = point->blinn = 0;
    if (hits != 0xffff)
        lanes_put(surface->material + at, 0xffff, 0);
    for (unsigned rest = hits, lanes; rest; rest &= ~lanes) {
        const uint32_t id = surface->prim[at + (unsigned)__builtin_ctz(rest)];
        const glint_prim *prim = &surface->prims[id];
        lanes = lanes_equal(surface->prim + at, id) & rest;
        if (prim->kind != GLINT_PRIM_SPHERE || !prim->two_sided)
            return false;
        R(put_ball)(prim, lanes, balls);
        lanes_put(surface->material + at, lanes, prim->material);
        if (light->highlights)
            R(sort_lanes)(light, &light->materials[prim->material], lanes, point);
        walk->several = walk->several || (walk->only != GLINT_MISS && walk->only != id);
        walk->only = id;
    }
    return true;
}

/// Computes points and normals of part j. Returns the lanes in which the camera is near enough to the sphere; *back:
/// the lanes of these that are seen from behind.
INNER unsigned R(find_ball_part)(const glint_surface_args *surface, const R(ball_lanes) * balls,
                                 R(group_directions) directions, size_t at, int j, R(plain_part) * part, unsigned *back)
{
    const size_t i = at + (size_t)(j * VR);
    const vr ts = r_load((const real *)surface->t + i) * balls->scale[j];
    vr f[3], n[3], *d = part->direction;
    R(load_direction)(directions, surface->direction, at, j * VR, d);
    for (int k = 0; k < 3; k++) {
        const vr from = surface->camera ? r_set(surface->camera->eye[k]) : r_load((const real *)surface->origin[k] + i);
        f[k] = (from - balls->center[k][j]) * balls->scale[j];
        n[k] = (f[k] + ts * d[k]) * balls->inverse_radius[j];
    }
    const vr ff = DOT(f, f), newton = r_set(1.5) - r_set(0.5) * DOT(n, n);
    const rm close = r_lt(ff, r_set(GLINT_SPHERE_CLOSE));
    for (int k = 0; k < 3; k++) {
        n[k] = r_select(close, n[k], n[k] * newton);
        part->point[k] = balls->center[k][j] + balls->radius[j] * n[k];
    }
    const vr away = DOT(n, d);
    const rm behind = r_lt(r_set(0), away);
    for (int k = 0; k < 3; k++)
        part->normal[k] = r_select(behind, -n[k], n[k]);
    part->a = DOT(d, d);
    part->nv = r_select(behind, away, -away);
    *back = rm_bits(behind);
    return rm_bits(r_lt(ff, r_set(GLINT_SPHERE_NEAR)));
}

/// Computes the parts of a group. Returns whether the camera is near enough to the spheres of all lanes in `hits`;
/// *back: the lanes of `hits` that are seen from behind.
INNER bool R(find_ball_parts)(const glint_surface_args *surface, const R(ball_lanes) * balls, R(group_cursor) cursor,
                              unsigned hits, R(plain_part) * parts, unsigned *back)
{
    const R(group_directions) directions = R(directions_of)(surface->camera, cursor.x, cursor.y);
    unsigned near = 0;
    *back = 0;
#pragma GCC unroll 8
    for (int j = 0; j < LIT_PARTS; j++) {
        unsigned behind;
        near |= R(find_ball_part)(surface, balls, directions, (size_t)cursor.g * GLINT_GROUP, j, &parts[j], &behind)
                << j * VR;
        *back |= behind << j * VR;
    }
    *back &= hits;
    return !(hits & ~near);
}

/// Stores the parts, with 0 in lanes without a hit.
INNER void R(store_ball_parts)(const glint_surface_args *surface, const R(plain_part) * parts, size_t at, unsigned hits,
                               bool normals, R(point_box) * box)
{
#pragma GCC unroll 8
    for (int j = 0; j < LIT_PARTS; j++) {
        const rm mask = rm_from_bits(hits >> j * VR & ((1u << VR) - 1));
        const size_t i = at + (size_t)(j * VR);
        for (int k = 0; k < 3; k++) {
            r_store((real *)surface->point[k] + i, r_select(mask, parts[j].point[k], r_set(0)));
            if (normals)
                r_store((real *)surface->normal[k] + i, r_select(mask, parts[j].normal[k], r_set(0)));
        }
        if (surface->box)
            R(enclose)(box, parts[j].point, false, mask);
    }
}

static __attribute__((noinline)) bool R(light_balls)(const glint_surface_args *surface, const glint_light_args *light,
                                                     R(surface_walk) * walk, bool normals, R(group_cursor) cursor,
                                                     R(point_box) * box, R(lit_point) * point, vf *brightest)
{
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    const unsigned hits = surface->hits[cursor.g];
    const int kind = light->directional ? R(PLAIN_AFAR) : R(PLAIN_SCALED);
    R(ball_lanes) balls = R(no_balls)();
    R(plain_part) parts[LIT_PARTS];
    unsigned back;
    if (!R(find_balls)(surface, light, at, hits, walk, &balls, point) ||
        !R(find_ball_parts)(surface, &balls, cursor, hits, parts, &back))
        return false;
    R(store_ball_parts)(surface, parts, at, hits, normals, box);
    surface->back[cursor.g] = (uint16_t)back;
    surface->dark[cursor.g] = 0;
    walk->any_back = walk->any_back || back;
    R(plain_light)(light, kind, true, cursor, point, parts, hits & light->hits[cursor.g], 0, brightest);
    return true;
}

#endif
