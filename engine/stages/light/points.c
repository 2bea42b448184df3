// Computes the light that reaches points, before shadows.
#include "engine/stages/light/lit_balls.h"
#include "engine/stages/light/lit_surface.h"
#include "engine/stages/light/plain.h"

/// Calls it with copies, so that values gathered over consecutive groups stay in registers.
INNER bool R(try_balls)(const glint_surface_args *surface, const glint_light_args *light, R(surface_walk) * walk,
                        bool normals, R(group_cursor) cursor, R(point_box) * box, R(lit_point) * point, vf *brightest)
{
    R(point_box) around = *box;
    vf most = *brightest;
    const bool done = R(light_balls)(surface, light, walk, normals, cursor, &around, point, &most);
    *box = around;
    *brightest = most;
    return done;
}

/// Processes all groups of a call. mixed, normals: constants.
INNER void R(lit_surfaces)(const glint_surface_args *surface, const glint_light_args *light, const bool mixed,
                           const bool normals)
{
    R(lit_call) call;
    R(point_box) box;
    R(lit_point) point = { 0 };
    R(lit_group) group;
    R(begin_walk)(surface, &call.walk);
    R(empty_box)(&box);
    for (int k = 0; k < 3; k++) {
        call.position[k] = (real)light->position[k];
    }
    call.scale = (real)light->scale;
    call.scaled = !light->directional && light->scale != 1;
    group.brightest = f_set(GLINT_NO_SPECULAR);
    for (R(group_cursor) cursor = { 0 }; cursor.g < surface->group_count; R(next_group)(surface->camera, &cursor)) {
        const uint32_t g = cursor.g;
        if (!surface->hits[g]) {
            surface->back[g] = surface->dark[g] = 0;
            light->lit[0][g] = 0;
        } else if (R(light_whole)(surface, light, &call, mixed, normals, cursor, &box, &group.brightest) ||
                   (!mixed &&
                    R(try_balls)(surface, light, &call.walk, normals, cursor, &box, &point, &group.brightest))) {
            continue;
        } else {
            R(surface_group)(surface, &call.walk, &box, cursor, mixed ? R(MIXED) : R(BALLS_AND_PLANES));
            R(light_group)(light, LIGHT_PLAIN, 1, NULL, cursor, &point, &group);
            light->lit[0][g] = (uint16_t)group.lit;
            if (group.lit)
                R(finish_light)(light, LIGHT_PLAIN, 0, (size_t)g * GLINT_GROUP, &group);
        }
    }
    R(end_walk)(surface, &call.walk, &box);
    R(say_brightest)(light, 0, group.brightest);
}

/// A separate function, so that it takes no registers from the code for spheres and planes.
static __attribute__((noinline)) void R(lit_mixed)(const glint_surface_args *surface, const glint_light_args *light)
{
    R(lit_surfaces)(surface, light, true, true);
}

static void R(lit_surface)(const glint_surface_args *surface, const glint_light_args *light)
{
    if (surface->mixed)
        R(lit_mixed)(surface, light);
    else if (surface->all_normals)
        R(lit_surfaces)(surface, light, false, true);
    else
        R(lit_surfaces)(surface, light, false, false);
}

KERNEL(light, glint_light_args)

void GLINT_ENTRY(R(lit_surface))(const glint_surface_args *surface, const glint_light_args *light)
{
    R(lit_surface)(surface, light);
}
