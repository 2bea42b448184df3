// The reference of the occlude stage: included by ref/real.h for each type of real.

static bool NAME(sphere_blocks)(const glint_occlude_args *args, const glint_prim *prim, int side, NAME(vec3) position,
                                NAME(vec3) point)
{
    NAME(vec3) d = args->directional ? position : NAME(times)(NAME(sub)(position, point), (REAL)args->scale);
    NAME(vec3) f = NAME(from_center)(point, prim);
    REAL c = NAME(exact_c)(f.x, f.y, f.z, prim);
    if (side < 0)
        return c > 0;
    if (c < 0)
        return side > 0;
    REAL a = NAME(length2)(d);
    REAL b = -NAME(dot)(f, d);
    REAL disc = NAME(discriminant)(f, d, a, b, c, (REAL)glint_sphere_r2(prim));
    return b > 0 && disc >= 0 && (args->directional || b * (REAL)args->scale < a * (REAL)glint_sphere_scale(prim));
}

static bool NAME(plane_blocks)(const glint_prim *prim, int side, NAME(vec3) point)
{
    REAL h = NAME(over_plane)(prim, point, true);
    return (side > 0 && h < 0) || (side < 0 && h > 0);
}

/// Returns whether the primitive blocks lane i. `position`: the light's position for this lane, in double.
static bool NAME(prim_blocks)(const glint_occlude_args *args, const glint_prim *prim, const double position[3],
                              uint32_t i)
{
    bool sphere = prim->kind == GLINT_PRIM_SPHERE;
    if (prim->kind == GLINT_PRIM_COMBINED)
        return NAME(combined_blocks)(args, prim, NAME(rounded)(position), i);
    int side = light_side(args->directional, position, prim, args->geometry->solids);
    bool own = args->prim[i] != GLINT_MISS && prim == &args->geometry->prims[args->prim[i]];
    bool back = args->back[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
    if (prim->kind == GLINT_PRIM_TRIANGLE) {
        NAME(parted) plane = NAME(part)(args, prim, NAME(rounded)(position));
        if (own)
            return back ? plane.light > 0 : plane.light < 0;
        return NAME(triangle_blocks)(args, prim, plane, NAME(rounded)(position), i);
    }
    bool solid = prim->kind == GLINT_PRIM_SOLID;
    uint32_t form = solid ? args->geometry->solids[prim->item].form : GLINT_FORM_BALL;
    bool open = form == GLINT_FORM_TUBE || form == GLINT_FORM_FUNNEL;
    if (form == GLINT_FORM_TORUS)
        return NAME(torus_blocks)(args, prim, NAME(rounded)(position), NAME(load)(args->point, i), side < 0, own, back);
    if (own && !open)
        return prim->kind != GLINT_PRIM_PLANE && form != GLINT_FORM_DISK && back && side > 0;
    if (solid)
        return (back || !own) &&
               NAME(solid_blocks)(args, prim, NAME(rounded)(position), NAME(load)(args->point, i), own);
    NAME(vec3) point = NAME(load)(args->point, i);
    return sphere ? NAME(sphere_blocks)(args, prim, side, NAME(rounded)(position), point)
                  : NAME(plane_blocks)(prim, side, point);
}

static void NAME(occlude_sample)(const glint_occlude_args *args, uint32_t s, uint32_t i)
{
    const glint_light_sample *light_sample = args->light_sample[s];
    double position[3];
    for (int k = 0; k < 3; k++)
        position[k] = light_sample ? light_sample->position[k][i % GLINT_GROUP] : args->position[k];
    if (NAME(is_cone)(light_sample) && args->lit[s][i / GLINT_GROUP] >> i % GLINT_GROUP & 1)
        memcpy(position, NAME(in_own_cone)(light_sample, args->scale, args->point, args->normal, i).position,
               sizeof position);
    bool blocked = !(args->lit[s][i / GLINT_GROUP] >> i % GLINT_GROUP & 1);
    if (!blocked)
        ++*args->rays;
    for (uint32_t k = 0; k < args->geometry->prim_count && !blocked; k++) {
        note_test(args->tests);
        blocked = NAME(prim_blocks)(args, &args->geometry->prims[k], position, i);
    }
    if (!blocked)
        args->unoccluded[s][i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
}

/// The reference tests and counts every lit lane, even where one test could decide the whole light.
#include "engine/render/stages/ref/caps.h"

static void NAME(occlude)(const glint_occlude_args *args)
{
    if (args->visible) {
        NAME(occlude_caps)(args);
        return;
    }
    for (uint32_t s = 0; s < args->sample_count; s++) {
        for (uint32_t g = 0; g < args->group_count; g++)
            args->unoccluded[s][g] = 0;
        for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
            NAME(occlude_sample)(args, s, i);
    }
}
