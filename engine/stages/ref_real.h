// The reference of the geometry stages, for one type of real. ref.c includes this twice, with
//   REAL      the type: double or float
//   NAME(x)   x_double or x_float; ref.c defines square_root, exact_c and PLANE_GRAZING for each type
// Every function is one line of stages.h after the other, for one sample; the loops over samples come last.

typedef struct NAME(vec3) {
    REAL x, y, z;
} NAME(vec3);

static NAME(vec3) NAME(vec)(REAL x, REAL y, REAL z) { return (NAME(vec3)) { x, y, z }; }

static NAME(vec3) NAME(rounded)(const double v[3]) { return NAME(vec)((REAL)v[0], (REAL)v[1], (REAL)v[2]); }

static NAME(vec3) NAME(add)(NAME(vec3) a, NAME(vec3) b) { return NAME(vec)(a.x + b.x, a.y + b.y, a.z + b.z); }

static NAME(vec3) NAME(sub)(NAME(vec3) a, NAME(vec3) b) { return NAME(vec)(a.x - b.x, a.y - b.y, a.z - b.z); }

static NAME(vec3) NAME(times)(NAME(vec3) a, REAL k) { return NAME(vec)(a.x * k, a.y * k, a.z * k); }

static NAME(vec3) NAME(over)(NAME(vec3) a, REAL k) { return NAME(vec)(a.x / k, a.y / k, a.z / k); }

static NAME(vec3) NAME(negated)(NAME(vec3) a) { return NAME(vec)(-a.x, -a.y, -a.z); }

static REAL NAME(dot)(NAME(vec3) a, NAME(vec3) b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }

static REAL NAME(length2)(NAME(vec3) a) { return NAME(dot)(a, a); }

static REAL NAME(min)(REAL a, REAL b) { return a < b ? a : b; }

static REAL NAME(max)(REAL a, REAL b) { return a > b ? a : b; }

static NAME(vec3) NAME(cross)(NAME(vec3) f, NAME(vec3) d)
{
    return NAME(vec)(f.y * d.z - f.z * d.y, f.z * d.x - f.x * d.z, f.x * d.y - f.y * d.x);
}

static NAME(vec3) NAME(load)(const void *const array[3], uint32_t i)
{
    return NAME(vec)(((const REAL *)array[0])[i], ((const REAL *)array[1])[i], ((const REAL *)array[2])[i]);
}

static void NAME(store)(void *const array[3], uint32_t i, NAME(vec3) v)
{
    ((REAL *)array[0])[i] = v.x;
    ((REAL *)array[1])[i] = v.y;
    ((REAL *)array[2])[i] = v.z;
}

/// From a sphere's centre to a point, in units that bring the radius into [1, 2).
static NAME(vec3) NAME(from_center)(NAME(vec3) point, const glint_prim *prim)
{
    return NAME(times)(NAME(sub)(point, NAME(rounded)(prim->center)), (REAL)prim->scale);
}

// ---- camera ------------------------------------------------------------------------------------------------------

/// A column's or a row's share of a direction.
static void NAME(store_part)(void *parts, uint32_t group, uint32_t lane, NAME(vec3) v)
{
    REAL *at = (REAL *)parts + group * 3 * GLINT_GROUP + lane;
    at[0] = v.x;
    at[GLINT_GROUP] = v.y;
    at[2 * GLINT_GROUP] = v.z;
}

static NAME(vec3) NAME(load_part)(const void *parts, uint32_t group, uint32_t lane)
{
    const REAL *at = (const REAL *)parts + group * 3 * GLINT_GROUP + lane;
    return NAME(vec)(at[0], at[GLINT_GROUP], at[2 * GLINT_GROUP]);
}

static void NAME(camera_sample)(const glint_camera_args *args, uint32_t i)
{
    uint32_t lane = i % GLINT_GROUP, column = i / GLINT_GROUP % args->groups_across;
    uint32_t row = i / GLINT_GROUP / args->groups_across;
    double px = (args->x0 + 4 * column + lane % 4) + args->offset[0];
    double py = (args->y0 + 4 * row + lane / 4) + args->offset[1];
    REAL sx = (REAL)(2 * px - args->width);
    REAL sy = (REAL)(args->height - 2 * py);
    NAME(vec3) across = NAME(times)(NAME(rounded)(args->right), sx);
    NAME(vec3) upward = NAME(times)(NAME(rounded)(args->up), sy);
    NAME(vec3) forward = NAME(rounded)(args->forward);
    if (args->orthographic) {
        NAME(store)(args->origin, i, NAME(add)(NAME(add)(NAME(rounded)(args->eye), across), upward));
        NAME(store)(args->direction, i, forward);
    } else {
        NAME(store_part)(args->across, column, lane, NAME(add)(forward, across));
        NAME(store_part)(args->down, row, lane, upward);
    }
}

static void NAME(camera)(const glint_camera_args *args)
{
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        NAME(camera_sample)(args, i);
}

/// The direction of ray i: of the camera, or from arrays.
static NAME(vec3) NAME(direction_of)(const glint_camera_args *camera, const void *const direction[3], uint32_t i)
{
    if (!camera)
        return NAME(load)(direction, i);
    uint32_t lane = i % GLINT_GROUP, group = i / GLINT_GROUP;
    return NAME(add)(NAME(load_part)(camera->across, group % camera->groups_across, lane),
                     NAME(load_part)(camera->down, group / camera->groups_across, lane));
}

#include "engine/stages/ref_triangle.h"
#include "engine/stages/ref_solid.h"

// ---- cast --------------------------------------------------------------------------------------------------------

/// The hybrid discriminant: from afar by the distance of the line from the centre, close by as b^2 - a c.
static REAL NAME(discriminant)(NAME(vec3) f, NAME(vec3) direction, REAL a, REAL b, REAL c, REAL r2)
{
    bool near = b * b < a * r2;
    return near ? b * b - a * c : a * r2 - NAME(length2)(NAME(cross)(f, direction));
}

/// The distance at which a ray meets a sphere; 0 stands for a miss.
static REAL NAME(sphere_t)(NAME(vec3) f, REAL c, NAME(vec3) direction, const glint_prim *prim)
{
    REAL scale = (REAL)prim->scale;
    REAL a = NAME(length2)(direction);
    REAL b = -NAME(dot)(f, direction);
    REAL disc = NAME(discriminant)(f, direction, a, b, c, (REAL)prim->r2);
    REAL s = NAME(square_root)(NAME(max)(disc, 0));
    REAL q = b >= 0 ? b + s : b - s;
    bool far_root = c <= 0 && b >= 0;
    REAL t = (far_root ? q : c) / (far_root ? a * scale : q * scale);
    return disc >= 0 && t > 0 ? t : 0;
}

/// The distance at which a ray meets a plane, h being the height of its origin; 0 stands for a miss.
static REAL NAME(plane_t)(REAL h, NAME(vec3) direction, const glint_prim *prim)
{
    REAL nd = NAME(dot)(NAME(rounded)(prim->normal), direction);
    REAL t = -h / nd;
    return nd * nd >= NAME(PLANE_GRAZING) * NAME(length2)(direction) && t > 0 ? t : 0;
}

/// Likewise for any primitive.
static REAL NAME(prim_t)(const glint_geometry_table *geometry, const glint_prim *prim, NAME(vec3) origin,
                         NAME(vec3) direction)
{
    if (prim->kind == GLINT_PRIM_TRIANGLE)
        return NAME(triangle_t)(prim, geometry->scale, origin, direction);
    if (prim->kind == GLINT_PRIM_SOLID)
        return NAME(solid_t)(&geometry->solids[prim->item], prim, origin, direction);
    if (prim->kind == GLINT_PRIM_PLANE) {
        NAME(vec3) away = NAME(sub)(origin, NAME(rounded)(prim->center));
        return NAME(plane_t)(NAME(dot)(NAME(rounded)(prim->normal), away), direction, prim);
    }
    NAME(vec3) f = NAME(from_center)(origin, prim);
    return NAME(sphere_t)(f, NAME(exact_c)(f.x, f.y, f.z, prim), direction, prim);
}

/// Whether ray i starts on the primitive, or on a triangle in whose plane this one is; then *t is where it meets it, or 0.
static bool NAME(leaves)(const glint_cast_args *args, uint32_t index, NAME(vec3) origin, NAME(vec3) direction,
                         uint32_t i, REAL *t)
{
    const glint_prim *prim = &args->geometry->prims[index];
    if (!args->leaving || args->leaving[i] == GLINT_MISS)
        return false;
    if (args->leaving[i] != index)
        return NAME(starts_beside)(args->geometry, &args->geometry->prims[args->leaving[i]], prim, origin, direction,
                                   t);
    *t = 0;
    bool inward = args->inward[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
    if (prim->kind == GLINT_PRIM_SOLID && inward) {
        const glint_solid *solid = &args->geometry->solids[prim->item];
        NAME(passage) p = NAME(pass_prim)(solid, prim, origin, direction);
        const bool open = solid->form == GLINT_FORM_TUBE || solid->form == GLINT_FORM_FUNNEL;
        *t = solid->form != GLINT_FORM_DISK ? NAME(max)(p.out.t, (REAL)GLINT_LEAST_WAY) : 0;
        if (open)
            *t = p.hit && !p.ends && p.out.t > 0 ? p.out.t : 0;
    }
    if (prim->kind != GLINT_PRIM_SPHERE || !inward)
        return true;
    NAME(vec3) f = NAME(from_center)(origin, prim);
    REAL b = -NAME(dot)(f, direction);
    *t = NAME(max)((b + b) / (NAME(length2)(direction) * (REAL)prim->scale), (REAL)GLINT_LEAST_WAY);
    return true;
}

/// `eye`: where all rays start; NULL: each has its own origin.
static void NAME(cast_sample)(const glint_cast_args *args, const double *eye, uint32_t i)
{
    REAL best = INFINITY;
    uint32_t best_prim = GLINT_MISS;
    if (args->active[i / GLINT_GROUP] >> i % GLINT_GROUP & 1) {
        NAME(vec3) direction = NAME(direction_of)(eye ? args->camera : NULL, args->direction, i);
        NAME(vec3) origin = eye ? NAME(rounded)(eye) : NAME(load)(args->origin, i);
        for (uint32_t index = 0; index < args->geometry->prim_count; index++) {
            REAL t;
            if (eye || !NAME(leaves)(args, index, origin, direction, i, &t))
                t = NAME(prim_t)(args->geometry, &args->geometry->prims[index], origin, direction);
            bool first = t == best && best_prim != GLINT_MISS &&
                         args->geometry->prims[index].id < args->geometry->prims[best_prim].id;
            if (t > 0 && t < INFINITY && (t < best || first)) {
                best = t;
                best_prim = index;
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

static void NAME(scan)(const glint_scan_args *args)
{
    const glint_cast_args *cast = &args->cast;
    const glint_prim *prims = cast->geometry->prims;
    bool eye = !cast->camera->orthographic;
    for (uint32_t group = 0; group < cast->group_count; group++)
        cast->hits[group] = 0;
    for (uint32_t i = 0; i < cast->group_count * GLINT_GROUP; i++) {
        REAL best = INFINITY;
        uint32_t best_prim = GLINT_MISS;
        bool active = cast->active[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
        NAME(vec3) direction = NAME(direction_of)(eye ? cast->camera : NULL, cast->direction, i);
        NAME(vec3) origin = eye ? NAME(rounded)(cast->camera->eye) : NAME(load)(cast->origin, i);
        for (uint32_t k = 0; active && k < args->entry_count; k++) {
            uint32_t prim = args->entries[k].prim;
            REAL t = NAME(triangle_t)(&prims[prim], cast->geometry->scale, origin, direction);
            bool first = t == best && best_prim != GLINT_MISS && prims[prim].id < prims[best_prim].id;
            if (t > 0 && t < INFINITY && (t < best || first)) {
                best = t;
                best_prim = prim;
            }
        }
        ((REAL *)cast->t)[i] = best;
        cast->prim[i] = best_prim;
        if (best_prim != GLINT_MISS)
            cast->hits[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
    }
}

/// The reference never rules a tile out but where there is nothing at all.
static bool NAME(in_sight)(const glint_cast_args *args) { return args->geometry->prim_count > 0; }

static void NAME(cast_bundle)(const glint_cast_args *args) { NAME(cast)(args, args->camera->eye); }

static void NAME(cast_rays)(const glint_cast_args *args) { NAME(cast)(args, NULL); }

// ---- surface -----------------------------------------------------------------------------------------------------

/// The outward normal where f + ts direction cancels too much: from the point of the ray closest to the centre.
static NAME(vec3) NAME(far_normal)(NAME(vec3) f, NAME(vec3) direction, REAL r2)
{
    REAL a = NAME(length2)(direction);
    REAL b = -NAME(dot)(f, direction);
    REAL w = b / a;
    NAME(vec3) l = NAME(add)(f, NAME(times)(direction, w));
    REAL h = NAME(square_root)(NAME(max)(r2 - NAME(length2)(l), 0) / a);
    REAL c = NAME(length2)(f) - r2;
    NAME(vec3) step = NAME(times)(direction, h);
    NAME(vec3) n = b >= 0 && c >= 0 ? NAME(sub)(l, step) : NAME(add)(l, step);
    REAL m = NAME(length2)(n);
    if (!(m > 0))
        return NAME(over)(NAME(negated)(direction), NAME(square_root)(a));
    return NAME(over)(n, NAME(square_root)(m));
}

static NAME(vec3) NAME(sphere_normal)(NAME(vec3) f, NAME(vec3) direction, REAL t, const glint_prim *prim)
{
    if (!(NAME(length2)(f) < (REAL)0x1p40))
        return NAME(far_normal)(f, direction, (REAL)prim->r2);
    REAL ts = t * (REAL)prim->scale;
    REAL r = (REAL)prim->radius * (REAL)prim->scale;
    NAME(vec3) n = NAME(add)(f, NAME(times)(direction, ts));
    n = NAME(times)(n, 1 / r);
    return NAME(times)(n, (REAL)1.5 - (REAL)0.5 * NAME(length2)(n));
}

/// Returns whether the surface is seen from behind.
static bool NAME(surface_hit)(const glint_surface_args *args, uint32_t i)
{
    const glint_prim *prim = &args->prims[args->prim[i]];
    NAME(vec3) direction = NAME(direction_of)(args->camera, args->direction, i);
    NAME(vec3) origin = args->camera ? NAME(rounded)(args->camera->eye) : NAME(load)(args->origin, i);
    REAL t = ((const REAL *)args->t)[i];
    NAME(vec3) n, point;
    REAL weight[3] = { 0 }, slack = 0;
    if (prim->kind == GLINT_PRIM_SPHERE) {
        n = NAME(sphere_normal)(NAME(from_center)(origin, prim), direction, t, prim);
        point = NAME(add)(NAME(rounded)(prim->center), NAME(times)(n, (REAL)prim->radius));
    } else if (prim->kind == GLINT_PRIM_TRIANGLE) {
        n = NAME(flat_normal)(prim, args->scale);
        point = NAME(triangle_point)(args, prim, origin, direction, weight, &slack);
    } else if (prim->kind == GLINT_PRIM_SOLID) {
        point = NAME(solid_point)(&args->solids[prim->item], prim, origin, direction, t, &n);
    } else {
        n = NAME(rounded)(prim->normal);
        point = NAME(add)(origin, NAME(times)(direction, t));
    }
    bool back = NAME(dot)(n, direction) > 0;
    if (prim->kind == GLINT_PRIM_TRIANGLE && args->corner_normals && prim->item != GLINT_MISS)
        n = NAME(smooth_normal)(&args->corner_normals[prim->item], weight, n, back);
    else if (back)
        n = NAME(negated)(n);
    NAME(store)(args->point, i, point);
    NAME(store)(args->normal, i, n);
    if (args->slack)
        ((REAL *)args->slack)[i] = slack;
    args->material[i] = prim->material;
    return back;
}

static void NAME(surface_miss)(const glint_surface_args *args, uint32_t i)
{
    NAME(store)(args->point, i, NAME(vec)(0, 0, 0));
    NAME(store)(args->normal, i, NAME(vec)(0, 0, 0));
    if (args->slack)
        ((REAL *)args->slack)[i] = 0;
    args->material[i] = 0;
}

static void NAME(surface_group)(const glint_surface_args *args, uint32_t group)
{
    uint32_t hits = args->hits[group], back = 0, dark = 0;
    for (uint32_t lane = 0; hits && lane < GLINT_GROUP; lane++) {
        uint32_t i = group * GLINT_GROUP + lane;
        if (!(hits >> lane & 1)) {
            NAME(surface_miss)(args, i);
        } else if (NAME(surface_hit)(args, i)) {
            back |= 1u << lane;
            if (!args->prims[args->prim[i]].two_sided)
                dark |= 1u << lane;
        }
    }
    args->back[group] = (uint16_t)back;
    args->dark[group] = (uint16_t)dark;
}

/// Around every hit's point; what is not a number stays outside.
static void NAME(surface_box)(const glint_surface_args *args)
{
    glint_point_box box = { { HUGE_VAL, HUGE_VAL, HUGE_VAL }, { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL }, GLINT_MISS };
    bool several = false;
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++) {
        if (!(args->hits[i / GLINT_GROUP] >> i % GLINT_GROUP & 1))
            continue;
        several = several || args->back[i / GLINT_GROUP] || (box.only != GLINT_MISS && box.only != args->prim[i]);
        box.only = args->prim[i];
        for (int k = 0; k < 3; k++) {
            double x = (double)((const REAL *)args->point[k])[i];
            box.lower[k] = x < box.lower[k] ? x : box.lower[k];
            box.upper[k] = x > box.upper[k] ? x : box.upper[k];
        }
    }
    if (several)
        box.only = GLINT_MISS;
    *args->box = box;
}

static void NAME(surface)(const glint_surface_args *args)
{
    for (uint32_t group = 0; group < args->group_count; group++)
        NAME(surface_group)(args, group);
    if (args->box)
        NAME(surface_box)(args);
}

// ---- light -------------------------------------------------------------------------------------------------------

/// log2 of r.v (Phong) or n.h (Blinn-Phong).
static float NAME(highlight)(uint32_t kind, REAL l2, REAL nl, NAME(vec3) l, NAME(vec3) normal, NAME(vec3) direction)
{
    REAL a = NAME(length2)(direction);
    REAL nv = -NAME(dot)(normal, direction);
    REAL lv = -NAME(dot)(l, direction);
    REAL x;
    if (kind == GLINT_HIGHLIGHT_PHONG) {
        REAL rv = (2 * nl) * nv - lv;
        x = rv > 0 ? NAME(min)((rv * rv) / (l2 * a), 1) : 0;
    } else {
        REAL w = NAME(square_root)(l2 * a);
        REAL num = ((nl * nl) * a + (nv * nv) * l2) + ((2 * nl) * nv) * w;
        REAL den = (2 * w) * (w + lv);
        x = num > 0 && den > 0 ? NAME(min)(num / den, 1) : 0;
    }
    return x >= (REAL)0x1p-126 ? 0.5f * log2_of((float)x, (float)(x - 1)) : GLINT_NO_SPECULAR;
}

/// Lane i of three arrays of 16 doubles.
static NAME(vec3) NAME(lane_of)(const double array[3][GLINT_GROUP], uint32_t i)
{
    uint32_t lane = i % GLINT_GROUP;
    return NAME(vec)((REAL)array[0][lane], (REAL)array[1][lane], (REAL)array[2][lane]);
}

static NAME(vec3) NAME(to_light)(const glint_light_args *args, const glint_lamp *lamp, uint32_t i)
{
    NAME(vec3) position = lamp ? NAME(lane_of)(lamp->position, i) : NAME(rounded)(args->position);
    return args->directional ? position
                             : NAME(times)(NAME(sub)(position, NAME(load)(args->point, i)), (REAL)args->scale);
}

static REAL NAME(spot_cosine)(const glint_spot *spot, NAME(vec3) l)
{
    return NAME(min)(-NAME(dot)(NAME(rounded)(spot->axis), l) / NAME(square_root)(NAME(length2)(l)), 1);
}

static REAL NAME(spot_x)(const glint_spot *spot, REAL c)
{
    return NAME(max)(NAME(min)((c - (REAL)spot->outer) * (REAL)spot->inverse, 1), 0);
}

static bool NAME(in_cone)(const glint_spot *spot, NAME(vec3) l)
{
    REAL c = NAME(spot_cosine)(spot, l);
    return NAME(spot_x)(spot, c) > 0 && (spot->exponent == 0 || c >= (REAL)0x1p-126);
}

static float NAME(cone)(const glint_spot *spot, NAME(vec3) l)
{
    REAL c = NAME(spot_cosine)(spot, l), x = NAME(spot_x)(spot, c);
    float step = (float)((x * x) * (3 - 2 * x));
    if (spot->exponent == 0)
        return step;
    return step * highlight_strength(spot->exponent, log2_of((float)c, (float)(c - 1)));
}

/// The cosine at the lamp times the distance: positive where the sample shines at the point.
static REAL NAME(lamp_cosine)(const glint_lamp *lamp, NAME(vec3) l, NAME(vec3) point, uint32_t i)
{
    REAL m = -NAME(dot)(NAME(lane_of)(lamp->normal, i), l);
    bool both = lamp->emission == GLINT_EMIT_RADIANT_BOTH;
    if (lamp->emission == GLINT_EMIT_RADIANT_BALL) {
        NAME(vec3) away = NAME(sub)(point, NAME(rounded)(lamp->center));
        REAL radius = (REAL)lamp->radius;
        both = NAME(length2)(away) < radius * radius;
    }
    return both ? NAME(max)(m, -m) : m;
}

static bool NAME(is_lit)(const glint_light_args *args, const glint_lamp *lamp, uint32_t i)
{
    uint32_t group = i / GLINT_GROUP, lane = i % GLINT_GROUP;
    if (!(args->hits[group] >> lane & 1) || args->dark[group] >> lane & 1)
        return false;
    NAME(vec3) l = NAME(to_light)(args, lamp, i);
    if (args->spot && !lamp && !NAME(in_cone)(args->spot, l))
        return false;
    if (lamp && lamp->emission != GLINT_EMIT_ALL && !(NAME(lamp_cosine)(lamp, l, NAME(load)(args->point, i), i) > 0))
        return false;
    return NAME(dot)(NAME(load)(args->normal, i), l) > 0;
}

static float NAME(attenuation)(const glint_light_args *args, const glint_lamp *lamp, NAME(vec3) l, uint32_t i)
{
    NAME(vec3) k = NAME(rounded)(args->coefficients);
    REAL l2 = NAME(length2)(l);
    REAL d = NAME(square_root)(l2) / (REAL)args->scale;
    REAL a = 1 / (k.x + (k.y * d + k.z * (d * d)));
    if (lamp && lamp->emission >= GLINT_EMIT_RADIANT_FRONT) {
        REAL m = NAME(lamp_cosine)(lamp, l, NAME(load)(args->point, i), i);
        a = a * (m / (l2 * NAME(square_root)(l2)));
    }
    float w = min_float((float)a, GLINT_ATTENUATION_MAX);
    return args->spot && !lamp ? w * NAME(cone)(args->spot, l) : w;
}

static void NAME(light_sample)(const glint_light_args *args, uint32_t s, uint32_t i)
{
    const glint_lamp *lamp = args->lamp[s];
    NAME(vec3) normal = NAME(load)(args->normal, i);
    NAME(vec3) l = NAME(to_light)(args, lamp, i);
    REAL l2 = NAME(length2)(l), nl = NAME(dot)(normal, l);
    if (args->directional) {
        args->cosine[s][i] = min_float((float)nl, 1);
    } else {
        float q = (float)l2, m = (float)nl;
        args->cosine[s][i] = min_float(m / sqrtf(q), 1);
    }
    if (args->attenuated)
        args->attenuation[s][i] = NAME(attenuation)(args, lamp, l, i);
    if (args->highlights) {
        uint32_t kind = args->materials[args->material[i]].highlight;
        args->log2_specular[s][i] =
            kind == GLINT_HIGHLIGHT_NONE || kind == GLINT_HIGHLIGHT_FACETS
                ? GLINT_NO_SPECULAR
                : NAME(highlight)(kind, l2, nl, l, normal, NAME(direction_of)(args->camera, args->direction, i));
    }
}

static void NAME(light_group)(const glint_light_args *args, uint32_t s, uint32_t group)
{
    uint32_t first = group * GLINT_GROUP, lit = 0;
    for (uint32_t lane = 0; lane < GLINT_GROUP; lane++)
        lit |= (uint32_t)NAME(is_lit)(args, args->lamp[s], first + lane) << lane;
    args->lit[s][group] = (uint16_t)lit;
    for (uint32_t lane = 0; lit && lane < GLINT_GROUP; lane++) {
        uint32_t i = first + lane;
        if (lit >> lane & 1) {
            NAME(light_sample)(args, s, i);
            continue;
        }
        args->cosine[s][i] = 0;
        if (args->attenuated)
            args->attenuation[s][i] = 0;
        if (args->highlights)
            args->log2_specular[s][i] = GLINT_NO_SPECULAR;
    }
}

static float NAME(brightest)(const glint_light_args *args, uint32_t s)
{
    float brightest = GLINT_NO_SPECULAR;
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        if (args->lit[s][i / GLINT_GROUP] && args->log2_specular[s][i] > brightest)
            brightest = args->log2_specular[s][i];
    return brightest;
}

static void NAME(light)(const glint_light_args *args)
{
    for (uint32_t s = 0; s < args->sample_count; s++) {
        for (uint32_t group = 0; group < args->group_count; group++)
            NAME(light_group)(args, s, group);
        if (args->highlights && args->brightest[s])
            *args->brightest[s] = NAME(brightest)(args, s);
    }
}

static void NAME(lit_surface)(const glint_surface_args *surface, const glint_light_args *light)
{
    NAME(surface)(surface);
    NAME(light)(light);
}

// ---- occlude -----------------------------------------------------------------------------------------------------

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
    REAL disc = NAME(discriminant)(f, d, a, b, c, (REAL)prim->r2);
    return b > 0 && disc >= 0 && (args->directional || b * (REAL)args->scale < a * (REAL)prim->scale);
}

static bool NAME(plane_blocks)(const glint_prim *prim, int side, NAME(vec3) point)
{
    REAL h = NAME(dot)(NAME(rounded)(prim->normal), NAME(sub)(point, NAME(rounded)(prim->center)));
    return (side > 0 && h < 0) || (side < 0 && h > 0);
}

/// `position`: of the light for this lane, in double.
static bool NAME(prim_blocks)(const glint_occlude_args *args, const glint_prim *prim, const double position[3],
                              uint32_t i)
{
    bool sphere = prim->kind == GLINT_PRIM_SPHERE;
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
    const glint_lamp *lamp = args->lamp[s];
    double position[3];
    for (int k = 0; k < 3; k++)
        position[k] = lamp ? lamp->position[k][i % GLINT_GROUP] : args->position[k];
    bool blocked = !(args->lit[s][i / GLINT_GROUP] >> i % GLINT_GROUP & 1);
    if (!blocked)
        ++*args->rays;
    for (uint32_t k = 0; k < args->geometry->prim_count && !blocked; k++)
        blocked = NAME(prim_blocks)(args, &args->geometry->prims[k], position, i);
    if (!blocked)
        args->open[s][i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
}

/// The reference tests every lit lane, and counts it, where a whole light might have been settled at once.
#include "engine/stages/ref_caps.h"

static void NAME(occlude)(const glint_occlude_args *args)
{
    if (args->visible) {
        NAME(occlude_caps)(args);
        return;
    }
    for (uint32_t s = 0; s < args->sample_count; s++) {
        for (uint32_t g = 0; g < args->group_count; g++)
            args->open[s][g] = 0;
        for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
            NAME(occlude_sample)(args, s, i);
    }
}

// ---- bounce ------------------------------------------------------------------------------------------------------

/// Share of unpolarised light that a dielectric mirrors; cosines of the angles on both sides.
static REAL NAME(fresnel)(REAL ratio, REAL here, REAL beyond)
{
    REAL across = (ratio * here - beyond) / (ratio * here + beyond);
    REAL along = (here - ratio * beyond) / (here + ratio * beyond);
    return (REAL)0.5 * (across * across + along * along);
}

/// Returns whether the ray is totally reflected.
static bool NAME(bounce_sample)(const glint_bounce_args *args, uint32_t i)
{
    NAME(vec3) d = NAME(direction_of)(args->camera, args->direction, i), n = NAME(load)(args->normal, i);
    NAME(vec3) u = NAME(over)(d, NAME(square_root)(NAME(length2)(d)));
    REAL ratio = ((const REAL *)args->ratio)[i], c = NAME(min)(NAME(max)(-NAME(dot)(n, u), 0), 1);
    REAL k = 1 - (ratio * ratio) * (1 - c * c);
    REAL beyond = ratio == 1 ? c : NAME(square_root)(NAME(max)(k, 0));
    bool total = ratio != 1 && !(k > 0);
    NAME(store)(args->reflected, i, NAME(add)(u, NAME(times)(n, 2 * c)));
    NAME(store)(args->refracted, i, NAME(add)(NAME(times)(u, ratio), NAME(times)(n, ratio * c - beyond)));
    ((REAL *)args->reflectance)[i] = ratio == 1 ? 0 : total ? 1 : NAME(fresnel)(ratio, c, beyond);
    return total;
}

static void NAME(bounce)(const glint_bounce_args *args)
{
    for (uint32_t g = 0; g < args->group_count; g++)
        args->total[g] = 0;
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        if (args->wanted[i / GLINT_GROUP] >> i % GLINT_GROUP & 1 && NAME(bounce_sample)(args, i))
            args->total[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
}
