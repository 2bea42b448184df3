// The reference of cast and scan conversion: included by ref/real.h for each type of real.

/// Returns the hybrid discriminant: computed from the distance between line and centre if the origin is far away, as
/// b^2 - a c if it is close.
static REAL NAME(discriminant)(NAME(vec3) f, NAME(vec3) direction, REAL a, REAL b, REAL c, REAL r2)
{
    bool near = b * b < a * r2;
    return near ? b * b - a * c : a * r2 - NAME(length2)(NAME(cross)(f, direction));
}

/// Returns the distance at which a ray hits a sphere; 0: a miss.
static REAL NAME(sphere_t)(NAME(vec3) f, REAL c, NAME(vec3) direction, const glint_prim *prim)
{
    REAL scale = (REAL)glint_sphere_scale(prim);
    REAL a = NAME(length2)(direction);
    REAL b = -NAME(dot)(f, direction);
    REAL disc = NAME(discriminant)(f, direction, a, b, c, (REAL)glint_sphere_r2(prim));
    REAL s = NAME(square_root)(NAME(max)(disc, 0));
    REAL q = b >= 0 ? b + s : b - s;
    bool far_root = c <= 0 && b >= 0;
    REAL t = (far_root ? q : c) / (far_root ? a * scale : q * scale);
    return disc >= 0 && t > 0 ? t : 0;
}

/// Returns the height of a point over a plane. For a point on some surface, a height within the rounding error is
/// returned as 0.
static REAL NAME(over_plane)(const glint_prim *prim, NAME(vec3) point, bool on_surface)
{
    NAME(vec3) n = NAME(rounded)(prim->normal), q = NAME(sub)(point, NAME(rounded)(prim->center));
    REAL h = NAME(dot)(n, q);
    REAL sizes = (NAME(abs)(n.x * q.x) + NAME(abs)(n.y * q.y)) + NAME(abs)(n.z * q.z);
    return on_surface && prim->normal[3] > 0 ? NAME(zero_within)(h, NAME(ON_FACE) * (sizes + (REAL)prim->normal[3])) : h;
}

/// Returns the distance at which a ray hits a plane; 0: a miss. h: the height of the ray's origin over the plane.
static REAL NAME(plane_t)(REAL h, NAME(vec3) direction, const glint_prim *prim)
{
    REAL nd = NAME(dot)(NAME(rounded)(prim->normal), direction);
    REAL t = -h / nd;
    return nd * nd >= NAME(PLANE_GRAZING) * NAME(length2)(direction) && t > 0 ? t : 0;
}

#include "engine/render/stages/ref/combined.h"

/// Returns the distance at which a ray hits any primitive except a combined solid; 0: a miss.
static REAL NAME(prim_t)(const glint_geometry_table *geometry, const glint_prim *prim, NAME(vec3) origin,
                         NAME(vec3) direction, bool on_surface)
{
    if (prim->kind == GLINT_PRIM_TRIANGLE)
        return NAME(triangle_t)(geometry, prim, origin, direction, on_surface);
    if (prim->kind == GLINT_PRIM_SOLID)
        return NAME(solid_t)(&geometry->solids[prim->item], prim, origin, direction);
    if (prim->kind == GLINT_PRIM_PLANE)
        return NAME(plane_t)(NAME(over_plane)(prim, origin, on_surface), direction, prim);
    NAME(vec3) f = NAME(from_center)(origin, prim);
    return NAME(sphere_t)(f, NAME(exact_c)(f.x, f.y, f.z, prim), direction, prim);
}

/// Returns whether ray i starts on the primitive, or starts on another triangle whose plane it may not have left when
/// it reaches this triangle's plane. If so, *t is the distance of the hit, or 0.
static bool NAME(leaves)(const glint_cast_args *args, uint32_t index, NAME(vec3) origin, NAME(vec3) direction,
                         uint32_t i, REAL *t)
{
    const glint_prim *prim = &args->geometry->prims[index];
    if (!args->leaving || args->leaving[i] == GLINT_MISS)
        return false;
    if (args->leaving[i] != index)
        return NAME(is_shared_edge)(args->geometry, &args->geometry->prims[args->leaving[i]], prim, origin, direction,
                                    t);
    *t = 0;
    bool inward = args->inward[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
    if (prim->kind == GLINT_PRIM_SOLID && args->geometry->solids[prim->item].form == GLINT_FORM_TORUS) {
        const glint_solid *solid = &args->geometry->solids[prim->item];
        *t = NAME(torus_t)(solid, NAME(unit_point)(solid, prim, origin), NAME(into_unit)(solid, direction), true,
                           inward);
    } else if (prim->kind == GLINT_PRIM_SOLID && inward) {
        const glint_solid *solid = &args->geometry->solids[prim->item];
        NAME(passage) p = NAME(pass_prim)(solid, prim, origin, direction);
        const bool open = solid->form == GLINT_FORM_TUBE || solid->form == GLINT_FORM_FUNNEL;
        *t = solid->form != GLINT_FORM_DISK ? NAME(max)(p.out.t, (REAL)GLINT_LEAST_T) : 0;
        if (open)
            *t = p.hit && !p.ends && p.out.t > 0 ? p.out.t : 0;
    }
    if (prim->kind != GLINT_PRIM_SPHERE || !inward)
        return true;
    NAME(vec3) f = NAME(from_center)(origin, prim);
    REAL b = -NAME(dot)(f, direction);
    *t = NAME(max)((b + b) / (NAME(length2)(direction) * (REAL)glint_sphere_scale(prim)), (REAL)GLINT_LEAST_T);
    return true;
}

/// Returns t where ray i hits a primitive; 0: a miss. *hit_prim: the primitive. eye: whether the rays start at the
/// eye, so that no ray starts on a surface.
static REAL NAME(hit_t)(const glint_cast_args *args, bool eye, uint32_t index, NAME(vec3) origin, NAME(vec3) direction,
                        uint32_t i, uint32_t *hit_prim)
{
    const glint_prim *prim = &args->geometry->prims[index];
    const bool starts_on = !eye && args->leaving && args->leaving[i] != GLINT_MISS;
    REAL t;
    *hit_prim = index;
    if (prim->kind == GLINT_PRIM_COMBINED) {
        NAME(start) start = { starts_on ? args->leaving[i] : GLINT_MISS, false };
        start.inward = starts_on && args->inward[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
        return NAME(combined_t)(args->geometry, prim, origin, direction, start, hit_prim);
    }
    if (eye || !NAME(leaves)(args, index, origin, direction, i, &t))
        t = NAME(prim_t)(args->geometry, prim, origin, direction, starts_on);
    return t;
}

/// Casts ray i. `eye`: the origin of all rays; NULL: each has its own.
static void NAME(cast_sample)(const glint_cast_args *args, const double *eye, uint32_t i)
{
    REAL best = INFINITY;
    uint32_t best_prim = GLINT_MISS;
    if (args->active[i / GLINT_GROUP] >> i % GLINT_GROUP & 1) {
        NAME(vec3) direction = NAME(direction_of)(eye ? args->camera : NULL, args->direction, i);
        NAME(vec3) origin = eye ? NAME(rounded)(eye) : NAME(load)(args->origin, i);
        for (uint32_t index = 0; index < args->geometry->prim_count; index++) {
            uint32_t hit_prim;
            note_test(args->tests);
            REAL t = NAME(hit_t)(args, eye != NULL, index, origin, direction, i, &hit_prim);
            bool first = t == best && best_prim != GLINT_MISS &&
                         args->geometry->prims[hit_prim].id < args->geometry->prims[best_prim].id;
            if (t > 0 && t < INFINITY && (t < best || first)) {
                best = t;
                best_prim = hit_prim;
            }
        }
    }
    ((REAL *)args->t)[i] = best;
    args->prim[i] = best_prim;
    if (best_prim != GLINT_MISS)
        args->hits[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
}

static void NAME(cast)(const glint_cast_args *args, const double *eye)
{
    for (uint32_t group = 0; group < args->group_count; group++)
        args->hits[group] = 0;
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        NAME(cast_sample)(args, eye, i);
}

/// Returns whether a ray can hit anything: always true in the reference if there are primitives.
static bool NAME(in_sight)(const glint_cast_args *args) { return args->geometry->prim_count > 0; }

static void NAME(cast_bundle)(const glint_cast_args *args) { NAME(cast)(args, args->camera->eye); }

static void NAME(cast_rays)(const glint_cast_args *args) { NAME(cast)(args, NULL); }
