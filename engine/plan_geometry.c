#include "engine/base/alloc.h"
#include "engine/base/math.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/plan.h"

#include <float.h>
#include <stdlib.h>

/// The view's axes. An `up` along the view gives way to the world axis least aligned with it.
static void view_axes(const glint_camera_desc *desc, double forward[3], double right[3], double up[3])
{
    if (desc->has_direction) {
        vec_normalize(forward, desc->direction);
    } else {
        vec_sub(forward, desc->at, desc->eye);
        vec_normalize(forward, forward);
    }
    double hint[3];
    vec_normalize(hint, desc->up);
    vec_cross(right, forward, hint);
    if (vec_dot(right, right) < 1e-24) {
        int least = 0;
        for (int c = 1; c < 3; c++)
            if (fabs(forward[c]) < fabs(forward[least]))
                least = c;
        double axis[3] = { least == 0, least == 1, least == 2 };
        vec_cross(right, forward, axis);
    }
    vec_normalize(right, right);
    vec_cross(up, right, forward);
}

void glint_plan_camera_init(glint_plan_camera *out, const glint_camera_desc *desc, const glint_render_desc *render)
{
    double right[3], up[3];
    *out = (glint_plan_camera) { .orthographic = desc->projection == GLINT_ORTHOGRAPHIC,
                                 .pixel_offset = desc->pixel_offset };
    vec_copy(out->eye, desc->eye);
    view_axes(desc, out->forward, right, up);
    const double half_height = out->orthographic ? 0.5 * desc->height : glint_tan_half(desc->fov_y_rad);
    vec_scale(out->right, right, half_height / render->height);
    vec_scale(out->up, up, half_height / render->height);
}

// ---- Primitives ----

/// a b = *high + *low exactly.
static void two_prod(double a, double b, double *high, double *low)
{
    *high = a * b;
    *low = fma(a, b, -*high);
}

static double two_sum(double a, double b, double *error)
{
    const double s = a + b, v = s - a;
    *error = (a - (s - v)) + (b - v);
    return s;
}

/// |f|^2 - (radius scale)^2 without cancellation: exact_c of stages.h.
static double exact_c(const double f[3], const glint_prim *prim)
{
    double p[3], e[3], xe, ye, ze;
    for (int i = 0; i < 3; i++)
        two_prod(f[i], f[i], &p[i], &e[i]);
    const double x = two_sum(p[0], p[1], &xe), y = two_sum(x, p[2], &ye), z = two_sum(y, -prim->r2, &ze);
    return z + (((xe + ye) + ze) + (((e[0] + e[1]) + e[2]) - prim->r2_low));
}

static float float_up(double x)
{
    const float f = (float)x;
    return (double)f < x ? nextafterf(f, HUGE_VALF) : f;
}

static void sphere_init(glint_prim *prim, const double center[3], double radius)
{
    prim->kind = GLINT_PRIM_SPHERE;
    for (int c = 0; c < 3; c++)
        prim->center[c] = center[c] + 0.0; // -0 and 0 are one place
    prim->radius = radius;
    prim->scale = power_of_two_scale(radius);
    two_prod(radius * prim->scale, radius * prim->scale, &prim->r2, &prim->r2_low);
}

static void plane_init(glint_prim *prim, const double point[3], const double normal[3])
{
    prim->kind = GLINT_PRIM_PLANE;
    for (int c = 0; c < 3; c++)
        prim->center[c] = point[c] + 0.0;
    vec_normalize(prim->normal, normal);
    prim->scale = 1;
}

/// The number of the shape's material in `materials`, which grows as new ones appear.
static glint_status material_number(glint_list *materials, glint_material *material, uint32_t *out, glint_error *error)
{
    size_t index = glint_list_find(materials, material);
    glint_status status = GLINT_OK;
    if (index == materials->count)
        status = glint_list_add(materials, material, error);
    *out = (uint32_t)index;
    return status;
}

static glint_status add_shape(glint_plan *plan, const glint_shape *shape, uint32_t number, glint_list *materials,
                              glint_error *error)
{
    const glint_shape_desc *desc = &shape->desc;
    for (size_t i = 0; i < shape->count; i++) {
        glint_prim *prim = &plan->prims[plan->prim_count];
        if (desc->kind == GLINT_SHAPE_SPHERES)
            sphere_init(prim, shape->spheres[i], shape->spheres[i][3]);
        else if (desc->kind == GLINT_SHAPE_SPHERE)
            sphere_init(prim, desc->center, desc->radius);
        else
            plane_init(prim, desc->point, desc->normal);
        prim->two_sided = desc->two_sided;
        glint_material *material = shape->materials[shape->index ? shape->index[i] : 0];
        glint_status status = material_number(materials, material, &prim->material, error);
        if (status)
            return status;
        plan->prim_shape[plan->prim_count++] = number;
    }
    return GLINT_OK;
}

void glint_prim_place(const glint_prim *prim, double out[8])
{
    out[0] = prim->kind;
    vec_copy(out + 1, prim->center);
    vec_copy(out + 4, prim->normal);
    out[7] = prim->radius;
}

static glint_key place_key(const glint_prim *prim)
{
    double place[8];
    glint_prim_place(prim, place);
    return glint_key_add((glint_key) { 0 }, place, sizeof place);
}

/// Finds, for each primitive, the first one with bit-equal geometry.
static glint_status find_coincident(glint_plan *plan, glint_error *error)
{
    size_t size = 16;
    while (size < 2 * (size_t)plan->prim_count)
        size *= 2;
    struct slot {
        glint_key key;
        uint32_t prim; ///< index + 1
    } *slots = calloc(size, sizeof *slots);
    if (!slots)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < plan->prim_count; i++) {
        const glint_key key = place_key(&plan->prims[i]);
        size_t at = key.low & (size - 1);
        while (slots[at].prim && (slots[at].key.low != key.low || slots[at].key.high != key.high))
            at = (at + 1) & (size - 1);
        if (!slots[at].prim)
            slots[at] = (struct slot) { key, i + 1 };
        plan->prims[i].coincident = slots[at].prim - 1;
    }
    free(slots);
    return GLINT_OK;
}

/// The frame of the float filter: around the eye, in units of the largest length, so that floats suffice.
static void filter_frame(glint_plan *plan)
{
    double largest = 0;
    vec_copy(plan->reference, plan->camera.eye);
    for (uint32_t i = 0; i < plan->prim_count; i++) {
        const glint_prim *prim = &plan->prims[i];
        double offset[3];
        vec_sub(offset, prim->center, plan->reference);
        largest = fmax(largest, fmax(vec_max_abs(offset), prim->radius));
    }
    plan->filter_scale = largest > 0 && isfinite(largest) ? power_of_two_scale(largest) : 1;
    for (uint32_t i = 0; i < plan->prim_count; i++) {
        glint_prim *prim = &plan->prims[i];
        prim->filter_bound = HUGE_VALF;
        if (prim->kind != GLINT_PRIM_SPHERE)
            continue;
        double offset[3];
        vec_sub(offset, prim->center, plan->reference);
        vec_scale(offset, offset, plan->filter_scale);
        for (int c = 0; c < 3; c++)
            prim->filter_center[c] = (float)offset[c];
        const double distance = sqrt(vec_dot(offset, offset));
        prim->filter_bound =
            float_up(prim->radius * plan->filter_scale * (1 + 1e-6) + 8 * 0x1p-24 * distance + FLT_MIN);
    }
}

glint_status glint_plan_prims(glint_plan *plan, const glint_scene *scene, glint_list *materials, glint_error *error)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->shapes.count; i++)
        count += glint_scene_shape(scene, i)->count;
    if (count >= INT32_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "scene: fewer than 2147483647 surfaces expected, got %zu", count);
    plan->prims = glint_alloc(count, sizeof *plan->prims);
    plan->prim_shape = glint_alloc(count, sizeof *plan->prim_shape);
    if (!plan->prims || !plan->prim_shape)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < scene->shapes.count; i++) {
        glint_status status = add_shape(plan, glint_scene_shape(scene, i), (uint32_t)i, materials, error);
        if (status)
            return status;
    }
    filter_frame(plan);
    return find_coincident(plan, error);
}

// ---- From one origin ----

static void cone_init(glint_cone *cone, const glint_bundle_prim *seen, const glint_prim *prim)
{
    const double distance = sqrt(vec_dot(seen->f, seen->f)), radius = prim->radius * prim->scale;
    *cone = (glint_cone) { .cosine = -1 };
    if (prim->kind != GLINT_PRIM_SPHERE || !(seen->c > 0) || !(distance < DBL_MAX))
        return;
    for (int c = 0; c < 3; c++)
        cone->axis[c] = -seen->f[c] / distance;
    cone->sine = fmin(radius / distance, 1);
    cone->cosine = sqrt(fmax(1 - cone->sine * cone->sine, 0));
}

static void bundle_init(glint_bundle_prim *seen, const glint_prim *prim, const double origin[3], bool in_float)
{
    for (int c = 0; c < 3; c++)
        seen->f[c] = in_float ? (float)((float)origin[c] - (float)prim->center[c]) * (float)prim->scale
                              : (origin[c] - prim->center[c]) * prim->scale;
    const double *f = seen->f;
    if (prim->kind == GLINT_PRIM_PLANE) {
        seen->c = vec_dot(prim->normal, f);
        seen->filter_limit2 = HUGE_VALF;
        return;
    }
    seen->c = exact_c(f, prim);
    if (in_float) {
        const float x = (float)f[0], y = (float)f[1], z = (float)f[2];
        seen->c = (float)((float)(x * x + y * y) + z * z) - (float)prim->r2;
    }
    for (int c = 0; c < 3; c++)
        seen->filter_f[c] = (float)f[c];
    const double limit = prim->radius * prim->scale * (1 + 1e-6) + 8 * 0x1p-24 * sqrt(vec_dot(f, f));
    seen->filter_limit2 = float_up(limit * limit * (1 + 1e-6));
}

void glint_plan_bundle(const glint_plan *plan, const double origin[3], glint_bundle_prim *bundle, glint_cone *cones)
{
    const bool in_float = plan->desc.precision == GLINT_FLOAT;
    for (uint32_t i = 0; i < plan->prim_count; i++) {
        glint_bundle_prim seen = { .c = 0 };
        bundle_init(&seen, &plan->prims[i], origin, in_float);
        if (bundle)
            bundle[i] = seen;
        if (cones)
            cone_init(&cones[i], &seen, &plan->prims[i]);
    }
}

static int8_t sign(double x) { return (int8_t)((x > 0) - (x < 0)); }

glint_status glint_plan_light_sides(const glint_plan *plan, glint_plan_light *light, glint_error *error)
{
    light->light_side = glint_alloc(plan->prim_count, sizeof *light->light_side);
    if (!light->light_side)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < plan->prim_count; i++) {
        const glint_prim *prim = &plan->prims[i];
        double f[3];
        vec_sub(f, light->position, prim->center);
        if (prim->kind == GLINT_PRIM_PLANE) {
            light->light_side[i] = sign(vec_dot(prim->normal, light->directional ? light->position : f));
        } else {
            vec_scale(f, f, prim->scale);
            const bool beyond = !(vec_dot(f, f) < HUGE_VAL); // its square is: outside for certain
            light->light_side[i] = light->directional || beyond ? 1 : sign(exact_c(f, prim));
        }
    }
    return GLINT_OK;
}
