// The reference of the geometry stages, for one type of real. ref.c includes this twice, with
//   REAL: the type, double or float
//   NAME(x): x_double or x_float; ref.c defines square_root, exact_c and PLANE_GRAZING for each type
// Every function follows stages.h line by line, for one sample. The loops over samples come last. The larger stages
// have their own files, which are included here.

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

static REAL NAME(abs)(REAL x) { return NAME(max)(x, -x); }

static REAL NAME(component)(NAME(vec3) v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

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

/// Returns the vector from a sphere's centre to a point, in units that bring the radius into [1, 2).
static NAME(vec3) NAME(from_center)(NAME(vec3) point, const glint_prim *prim)
{
    return NAME(times)(NAME(sub)(point, NAME(rounded)(prim->center)), (REAL)glint_sphere_scale(prim));
}

// ---- camera ------------------------------------------------------------------------------------------------------

/// Stores the vector of a column or of a row, one of the two summands of a direction.
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
    double px = (args->pixel[0] ? args->pixel[0][i] : args->x0 + 4 * column + lane % 4) + args->offset[0];
    double py = (args->pixel[1] ? args->pixel[1][i] : args->y0 + 4 * row + lane / 4) + args->offset[1];
    REAL sx = (REAL)(2 * px - args->width);
    REAL sy = (REAL)(args->height - 2 * py);
    NAME(vec3) across = NAME(times)(NAME(rounded)(args->right), sx);
    NAME(vec3) upward = NAME(times)(NAME(rounded)(args->up), sy);
    NAME(vec3) origin = NAME(rounded)(args->eye), direction = NAME(rounded)(args->forward);
    if (args->orthographic) {
        origin = NAME(add)(NAME(add)(origin, across), upward);
    } else if (args->pixel[0]) {
        NAME(store_part)(args->across, 0, lane, NAME(vec)(-(REAL)0, -(REAL)0, -(REAL)0));
        NAME(store_part)(args->down, row, lane, NAME(add)(NAME(add)(direction, across), upward));
    } else {
        NAME(store_part)(args->across, column, lane, NAME(add)(direction, across));
        NAME(store_part)(args->down, row, lane, upward);
        direction = NAME(add)(NAME(add)(direction, across), upward);
    }
    if (args->lens) {
        const double(*shift)[GLINT_GROUP] = args->lens->shift, (*bend)[GLINT_GROUP] = args->lens->bend;
        origin = NAME(add)(origin, NAME(vec)((REAL)shift[0][lane], (REAL)shift[1][lane], (REAL)shift[2][lane]));
        direction = NAME(sub)(direction, NAME(vec)((REAL)bend[0][lane], (REAL)bend[1][lane], (REAL)bend[2][lane]));
    }
    if (args->lens || args->orthographic) {
        NAME(store)(args->origin, i, origin);
        NAME(store)(args->direction, i, direction);
    }
}

static void NAME(camera)(const glint_camera_args *args)
{
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        NAME(camera_sample)(args, i);
}

/// Returns the direction of ray i, from the camera or from arrays.
static NAME(vec3) NAME(direction_of)(const glint_camera_args *camera, const void *const direction[3], uint32_t i)
{
    if (!camera)
        return NAME(load)(direction, i);
    uint32_t lane = i % GLINT_GROUP, group = i / GLINT_GROUP;
    return NAME(add)(NAME(load_part)(camera->across, group % camera->groups_across, lane),
                     NAME(load_part)(camera->down, group / camera->groups_across, lane));
}

#include "engine/render/stages/ref/torus.h"
#include "engine/render/stages/ref/solid.h"
#include "engine/render/stages/ref/triangle.h"
#include "engine/render/stages/ref/cast.h"

// ---- surface -----------------------------------------------------------------------------------------------------

/// Returns the outward normal where f + ts direction loses too many digits to cancellation. It is computed from the
/// point of the ray closest to the centre.
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
    REAL ff = NAME(length2)(f);
    if (!(ff < (REAL)GLINT_SPHERE_NEAR))
        return NAME(far_normal)(f, direction, (REAL)glint_sphere_r2(prim));
    REAL ts = t * (REAL)glint_sphere_scale(prim);
    REAL r = (REAL)prim->radius * (REAL)glint_sphere_scale(prim);
    NAME(vec3) n = NAME(add)(f, NAME(times)(direction, ts));
    n = NAME(times)(n, 1 / r);
    if (ff < NAME(SPHERE_CLOSE))
        return n;
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
        const double *level = prim->normal;
        point = NAME(add)(origin, NAME(times)(direction, t));
        if (level[1] == 0 && level[2] == 0)
            point.x = (REAL)prim->center[0];
        else if (level[0] == 0 && level[2] == 0)
            point.y = (REAL)prim->center[1];
        else if (level[0] == 0 && level[1] == 0)
            point.z = (REAL)prim->center[2];
        else
            point = NAME(sub)(point, NAME(times)(n, NAME(dot)(n, NAME(sub)(point, NAME(rounded)(prim->center)))));
    }
    if (prim->inverted)
        n = NAME(negated)(n);
    if (prim->kind != GLINT_PRIM_TRIANGLE)
        slack = -NAME(POINT_SLACK) * NAME(largest)(point);
    bool back = NAME(dot)(n, direction) > 0;
    if (prim->kind == GLINT_PRIM_TRIANGLE && args->corner_normals && prim->item != GLINT_MISS) {
        const glint_corner_normals *corners = &args->corner_normals[prim->item];
        if (corners->terminator > 0)
            point = NAME(toward_curve)(prim, corners, weight, n, back, point), slack = -slack;
        n = NAME(smooth_normal)(corners, weight, n, back);
    } else if (back)
        n = NAME(negated)(n);
    NAME(store)(args->point, i, point);
    if (args->normal[0])
        NAME(store)(args->normal, i, n);
    if (args->slack)
        ((REAL *)args->slack)[i] = slack;
    if (args->normal[0])
        args->material[i] = prim->material;
    return back;
}

static void NAME(surface_miss)(const glint_surface_args *args, uint32_t i)
{
    NAME(store)(args->point, i, NAME(vec)(0, 0, 0));
    if (args->normal[0])
        NAME(store)(args->normal, i, NAME(vec)(0, 0, 0));
    if (args->slack)
        ((REAL *)args->slack)[i] = 0;
    if (args->normal[0])
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
    if (!args->normal[0])
        return;
    args->back[group] = (uint16_t)back;
    args->dark[group] = (uint16_t)dark;
}

/// Computes the box around all hits' points, ignoring NaN.
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

#include "engine/render/stages/ref/light.h"

#include "engine/render/stages/ref/occlude.h"
