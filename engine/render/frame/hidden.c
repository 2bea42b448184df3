/// Which points of the world surfaces hide, found by casting rays from the eye.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/frame/render.h"

#include <stdlib.h>

#define MARGIN 1e-6 ///< a surface hides a point that is farther away than the surface by this fraction

typedef struct rays {
    _Alignas(64) double origin[3][GLINT_GROUP], direction[3][GLINT_GROUP], t[GLINT_GROUP];
    _Alignas(64) uint32_t prim[GLINT_GROUP];
    double scale[GLINT_GROUP]; ///< factor of the ray's direction; the point is at t = 1 / scale
    uint16_t active, hits;
} rays;

/// Sets a ray that ends at a point.
static void aim(const glint_cover_camera *camera, const double point[3], rays *r, int lane)
{
    double to_point[3], origin[3], scaled[3];
    vec_copy(origin, camera->eye);
    vec_sub(to_point, point, origin);
    if (camera->orthographic) {
        const double depth = vec_dot(to_point, camera->view[2]);
        vec_scale(to_point, camera->view[2], depth);
        vec_sub(origin, point, to_point);
    }
    r->scale[lane] = vec_rescale(scaled, to_point);
    for (int c = 0; c < 3; c++) {
        r->origin[c][lane] = origin[c];
        r->direction[c][lane] = scaled[c];
    }
}

typedef struct caster {
    const glint_stages *stages;
    const glint_plan *plan;
    rays *rays; ///< NULL until the first question
    glint_geometry_table table;
    glint_status status;
    glint_error *error;
} caster;

/// Makes the index of the plan's geometry. Returns whether rays can be cast.
static bool begin(caster *c)
{
    if (c->rays || c->status)
        return !c->status;
    c->rays = glint_alloc(1, sizeof *c->rays);
    c->status = c->rays ? glint_geometry_index(c->plan->geometry, NULL, &c->table, c->error) : glint_fail_nomem(c->error);
    return !c->status;
}

static uint32_t hidden(void *context, const glint_cover_camera *camera, const double (*points)[3], size_t count)
{
    caster *c = context;
    uint32_t found = 0;
    if (!begin(c))
        return 0;
    rays *r = c->rays;
    glint_cast_args cast = {
        .group_count = 1, .active = &r->active, .geometry = &c->table, .t = r->t, .prim = r->prim, .hits = &r->hits
    };
    for (int k = 0; k < 3; k++) {
        cast.origin[k] = r->origin[k];
        cast.direction[k] = r->direction[k];
    }
    for (size_t lane = 0; lane < GLINT_GROUP; lane++)
        aim(camera, points[lane < count ? lane : count - 1], r, (int)lane);
    r->active = (uint16_t)((1u << count) - 1);
    r->hits = 0;
    c->stages->geometry[GLINT_PRECISION_DOUBLE].cast_rays(&cast);
    for (size_t lane = 0; lane < count; lane++)
        if ((r->hits >> lane & 1) && r->t[lane] * r->scale[lane] < 1 - MARGIN)
            found |= 1u << lane;
    return found;
}

glint_status glint_cover_hide(const glint_stages *stages, const glint_plan *plan, glint_cover **out, glint_error *error)
{
    caster c = { .stages = stages, .plan = plan, .error = error };
    const glint_sights sights = { hidden, &c };
    *out = NULL;
    glint_status status = plan->cover->maker->hide(plan->cover, &sights, out, error);
    free(c.rays);
    return status ? status : c.status;
}
