#include "engine/cull.h"
#include "engine/base/vec.h"

#define SLACK 1e-9 ///< far above the rounding of these few operations, far below what matters

/// The plane coordinates of the tile's edges: forward + s right + t up.
static void tile_edges(const glint_plan *plan, const double x[2], const double y[2], double s[2], double t[2])
{
    for (int i = 0; i < 2; i++) {
        s[i] = 2 * x[i] - plan->desc.width;
        t[i] = plan->desc.height - 2 * y[i];
    }
}

static void ray_towards(const glint_plan *plan, double s, double t, double out[3])
{
    const glint_plan_camera *c = &plan->camera;
    for (int k = 0; k < 3; k++)
        out[k] = (c->forward[k] + s * c->right[k]) + t * c->up[k];
}

/// A plane is met when some corner ray runs towards it: the rays between are combinations of the corners'.
static bool plane_ahead(const glint_prim *prim, double height, double corner[4][3])
{
    for (int i = 0; i < 4; i++)
        if (vec_dot(prim->normal, corner[i]) * height <= SLACK * fabs(height))
            return true;
    return false;
}

static uint32_t cull_perspective(const glint_plan *plan, const double s[2], const double t[2], uint32_t *out)
{
    double corner[4][3], axis[3];
    ray_towards(plan, 0.5 * (s[0] + s[1]), 0.5 * (t[0] + t[1]), axis);
    vec_normalize(axis, axis);
    double cosine = 1;
    for (int i = 0; i < 4; i++) {
        double unit[3];
        ray_towards(plan, s[i & 1], t[i >> 1], corner[i]);
        vec_normalize(unit, corner[i]);
        cosine = fmin(cosine, vec_dot(unit, axis));
    }
    const double sine = sqrt(fmax(1 - cosine * cosine, 0));
    uint32_t count = 0;
    for (uint32_t i = 0; i < plan->prim_count; i++) {
        const glint_cone *cone = &plan->cones[i];
        bool keep;
        if (plan->prims[i].kind == GLINT_PRIM_PLANE)
            keep = plane_ahead(&plan->prims[i], plan->bundle[i].c, corner);
        else // the angle between the axes is at most the sum of the half angles
            keep = cone->cosine < 0 || cosine < 0 ||
                   vec_dot(axis, cone->axis) >= cosine * cone->cosine - sine * cone->sine - SLACK;
        if (keep)
            out[count++] = i;
    }
    return count;
}

static uint32_t cull_orthographic(const glint_plan *plan, const double s[2], const double t[2], uint32_t *out)
{
    const glint_plan_camera *camera = &plan->camera;
    const double width = sqrt(vec_dot(camera->right, camera->right)), height = sqrt(vec_dot(camera->up, camera->up));
    uint32_t count = 0;
    for (uint32_t i = 0; i < plan->prim_count; i++) {
        const glint_prim *prim = &plan->prims[i];
        double from[3];
        vec_sub(from, prim->center, camera->eye);
        const double slack = SLACK * (vec_max_abs(prim->center) + vec_max_abs(camera->eye) + prim->radius);
        const double across = vec_dot(from, camera->right) / width, along = vec_dot(from, camera->up) / height;
        const double reach = prim->radius + slack;
        const bool apart = across + reach < fmin(s[0], s[1]) * width || across - reach > fmax(s[0], s[1]) * width ||
                           along + reach < fmin(t[0], t[1]) * height || along - reach > fmax(t[0], t[1]) * height;
        if (prim->kind == GLINT_PRIM_PLANE || !apart)
            out[count++] = i;
    }
    return count;
}

uint32_t glint_cull_primary(const glint_plan *plan, const double x[2], const double y[2], uint32_t *out)
{
    double s[2], t[2];
    tile_edges(plan, x, y, s, t);
    return plan->camera.orthographic ? cull_orthographic(plan, s, t, out) : cull_perspective(plan, s, t, out);
}

/// Distance of a point from the segment (or, directional, the ray) from `from` along `way`.
static double distance_to_way(const double point[3], const double from[3], const double way[3], bool endless)
{
    double e[3];
    vec_sub(e, point, from);
    const double length2 = vec_dot(way, way);
    double along = length2 > 0 ? fmax(vec_dot(e, way) / length2, 0) : 0;
    if (!endless)
        along = fmin(along, 1);
    for (int k = 0; k < 3; k++)
        e[k] -= along * way[k];
    return sqrt(vec_dot(e, e));
}

uint32_t glint_cull_shadow(const glint_plan *plan, const glint_plan_light *light, const double lower[3],
                           const double upper[3], uint32_t *out)
{
    double middle[3], half[3], way[3];
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * lower[k] + 0.5 * upper[k];
        half[k] = 0.5 * upper[k] - 0.5 * lower[k];
        way[k] = light->directional ? light->position[k] : light->position[k] - middle[k];
    }
    const double radius = sqrt(vec_dot(half, half));
    uint32_t count = 0;
    for (uint32_t i = 0; i < plan->prim_count; i++) {
        const glint_prim *prim = &plan->prims[i];
        const int side = light->light_side[i];
        bool apart; // written so that NaN and overflow keep the primitive
        if (prim->kind == GLINT_PRIM_PLANE) {
            double e[3];
            vec_sub(e, middle, prim->center);
            apart = side == 0 || vec_dot(prim->normal, e) * side > radius + SLACK * (radius + vec_max_abs(e));
        } else {
            const double reach = (radius + prim->radius) * (1 + SLACK) +
                                 SLACK * (vec_max_abs(middle) + vec_max_abs(prim->center) + vec_max_abs(way));
            apart = side >= 0 && distance_to_way(prim->center, middle, way, light->directional) > reach;
        }
        if (!apart)
            out[count++] = i;
    }
    return count;
}
