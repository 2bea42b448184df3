/// Finds the transparent objects that contain the eye. Spheres, planes and solids have an inside. The eye is inside a
/// mesh if a ray along the view leaves through more faces than it enters; for a closed mesh, this holds for any ray.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/effects/bounce/plan.h"
#include "engine/render/plan/plan.h"

#include <stdlib.h>
#include <string.h>

/// Media from the outermost to the innermost. The innermost medium is the one with the smallest object or, among
/// objects of equal size, the one defined last.
typedef struct around {
    uint32_t count;
    struct holder {
        double size; ///< diagonal of the bounding box of its object
        uint32_t id, material;
    } in[GLINT_MEDIA_MAX];
} around;

/// Data collected from the triangles of one part.
typedef struct hull {
    int exits; ///< exits minus entries
    uint32_t id, material; ///< the first triangle's
    double lower[3], upper[3];
} hull;

static bool holds(const glint_geometry *geometry, const glint_prim *prim, const double point[3])
{
    double e[3];
    vec_sub(e, point, prim->center);
    if (prim->kind == GLINT_PRIM_SOLID)
        return glint_solid_holds(&geometry->solids[prim->item], prim->center, point);
    if (prim->kind == GLINT_PRIM_COMBINED)
        return glint_combined_holds(geometry, &geometry->combined[prim->item], point);
    if (prim->kind == GLINT_PRIM_PLANE)
        return vec_dot(prim->normal, e) < 0;
    return sqrt(vec_dot(e, e)) < prim->radius;
}

static bool is_outside(const struct holder *a, const struct holder *b)
{
    return a->size > b->size || (a->size == b->size && a->id < b->id);
}

static void add_holder(around *eye, double size, uint32_t id, uint32_t material)
{
    const struct holder holder = { size, id, material };
    if (eye->count == GLINT_MEDIA_MAX) {
        if (is_outside(&holder, &eye->in[0]))
            return;
        memmove(eye->in, eye->in + 1, --eye->count * sizeof *eye->in);
    }
    uint32_t at = eye->count++;
    for (; at > 0 && is_outside(&holder, &eye->in[at - 1]); at--)
        eye->in[at] = eye->in[at - 1];
    eye->in[at] = holder;
}

static double diagonal(const double lower[3], const double upper[3])
{
    double across[3];
    vec_sub(across, upper, lower);
    return sqrt(vec_dot(across, across));
}

static double size_of(const glint_geometry *geometry, const glint_prim *prim)
{
    double lower[3], upper[3];
    if (!glint_prim_bounded(prim))
        return HUGE_VAL;
    if (prim->kind == GLINT_PRIM_SPHERE)
        return 2 * sqrt(3) * prim->radius;
    glint_prim_bounds(geometry->solids, prim, lower, upper);
    return diagonal(lower, upper);
}

static void add_triangle(hull *part, const glint_plan *plan, const glint_prim *prim)
{
    double lower[3], upper[3];
    const bool first = part->lower[0] > part->upper[0];
    glint_prim_bounds(NULL, prim, lower, upper);
    for (int c = 0; c < 3; c++) {
        part->lower[c] = fmin(part->lower[c], lower[c]);
        part->upper[c] = fmax(part->upper[c], upper[c]);
    }
    if (first || prim->id < part->id) {
        part->id = prim->id;
        part->material = prim->material;
    }
    part->exits += glint_prim_crossing(prim, plan->camera.eye, plan->camera.forward);
}

/// Collects the media around the eye. hulls: one entry per part, or NULL if there are no triangles. A renderer may be
/// arranging the primitives at the same time.
static void find_media(const glint_plan *plan, hull *hulls, around *eye)
{
    const glint_geometry *geometry = plan->geometry;
    const uint32_t hull_count = geometry->table.triangles ? geometry->part_count : 0;
    for (uint32_t i = 0; i < hull_count; i++)
        hulls[i] = (hull) { .lower = { HUGE_VAL, HUGE_VAL, HUGE_VAL }, .upper = { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL } };
    pthread_mutex_lock(&geometry->index->lock);
    for (uint32_t i = 0; i < geometry->table.prim_count; i++) {
        const glint_prim *prim = &geometry->prims[i];
        if (!plan->bouncing[prim->material].transmits)
            continue;
        if (prim->kind == GLINT_PRIM_TRIANGLE)
            add_triangle(&hulls[geometry->prim_part[prim->id]], plan, prim);
        else if (holds(geometry, prim, plan->camera.eye))
            add_holder(eye, size_of(geometry, prim), prim->id, prim->medium);
    }
    pthread_mutex_unlock(&geometry->index->lock);
    for (uint32_t i = 0; i < hull_count; i++)
        for (int k = 0; k < hulls[i].exits && k < GLINT_MEDIA_MAX; k++)
            add_holder(eye, diagonal(hulls[i].lower, hulls[i].upper), hulls[i].id, hulls[i].material);
}

glint_status glint_plan_eye(glint_plan *plan, glint_error *error)
{
    around eye = { 0 };
    const uint32_t triangles = plan->geometry->table.triangles;
    hull *hulls = triangles ? glint_alloc(plan->geometry->part_count, sizeof *hulls) : NULL;
    if (triangles && !hulls)
        return glint_fail_nomem(error);
    find_media(plan, hulls, &eye);
    free(hulls);
    for (uint32_t i = 0; i < eye.count; i++)
        glint_media_enter(&plan->eye_media, eye.in[i].material);
    if (eye.count == 0)
        return GLINT_OK;
    const glint_bounce_material *m = &plan->bouncing[glint_media_top(&plan->eye_media)];
    plan->eye_medium.on = m->absorption[0] > 0 || m->absorption[1] > 0 || m->absorption[2] > 0;
    plan->eye_medium.material = glint_media_top(&plan->eye_media);
    vec_copy(plan->eye_medium.absorption, m->absorption);
    return GLINT_OK;
}
