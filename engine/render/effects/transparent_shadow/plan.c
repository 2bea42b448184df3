#include "engine/render/effects/transparent_shadow/plan.h"
#include "engine/base/vec.h"
#include "engine/render/effects/bounce/plan.h"

#include <math.h>

/// Bound of the error of a point on a ray, in either precision, relative to the lengths that the point is computed
/// from, with a margin for the rounding of the test below.
#define SLACK 0x1p-20

// ---- Balls ----

static bool transmits_light(const glint_bounce_material *m) { return m->transmits || m->clears; }

static bool transmits(const glint_plan *plan, const glint_geometry_table *table, const glint_prim *prim)
{
    if (prim->kind != GLINT_PRIM_COMBINED)
        return transmits_light(&plan->bouncing[prim->material]);
    const glint_combined *combined = &table->combined[prim->item];
    for (uint32_t i = 0; i < combined->count; i++)
        if (transmits_light(&plan->bouncing[table->prims[table->prim_count + combined->first + i].material]))
            return true;
    return false;
}

/// A box around primitives. `only`: the single primitive in the box; NULL: there are several.
typedef struct tint_box {
    double lower[3], upper[3];
    const glint_prim *only;
    uint32_t count;
} tint_box;

static void add_prim(tint_box *box, const glint_geometry_table *table, const glint_prim *prim)
{
    double lower[3], upper[3];
    glint_prim_bounds(table->solids, prim, lower, upper);
    for (int c = 0; c < 3; c++) {
        box->lower[c] = box->count ? fmin(box->lower[c], lower[c]) : lower[c];
        box->upper[c] = box->count ? fmax(box->upper[c], upper[c]) : upper[c];
    }
    box->only = box->count ? NULL : prim;
    box->count++;
}

/// Adds the ball around a box, or the only sphere in it, and empties the box.
static void add_ball(glint_tints *tints, tint_box *box)
{
    glint_ball *ball = &tints->of[tints->count++];
    double half[3];
    for (int c = 0; c < 3; c++) {
        half[c] = 0.5 * box->upper[c] - 0.5 * box->lower[c];
        ball->center[c] = box->lower[c] + half[c];
    }
    ball->radius = sqrt(vec_dot(half, half));
    if (box->only && box->only->kind == GLINT_PRIM_SPHERE) {
        vec_copy(ball->center, box->only->center);
        ball->radius = box->only->radius;
    }
    box->count = 0;
}

void glint_tints_find(glint_tints *tints, const glint_plan *plan, const glint_geometry_table *table)
{
    uint32_t all = 0;
    tint_box box = { .count = 0 };
    *tints = (glint_tints) { .extent = table->extent };
    for (uint32_t i = 0; i < table->prim_count; i++) {
        if (!transmits(plan, table, &table->prims[i]))
            continue;
        tints->everywhere = tints->everywhere || !glint_prim_bounded(&table->prims[i]);
        all++;
    }
    const uint32_t together = (all + GLINT_TINTS_MAX - 1) / GLINT_TINTS_MAX;
    for (uint32_t i = 0; i < table->prim_count && !tints->everywhere; i++) {
        if (!transmits(plan, table, &table->prims[i]))
            continue;
        add_prim(&box, table, &table->prims[i]);
        if (box.count == together)
            add_ball(tints, &box);
    }
    if (box.count)
        add_ball(tints, &box);
}

// ---- Rays ----

/// Returns a bound of the rounding error along the segments from some points to a light, at its largest distance.
static double slack_of(const glint_tints *tints, double points, const glint_tint_light *light)
{
    const double far =
        light->directional ? tints->extent : sqrt(vec_dot(light->position, light->position)) + light->radius;
    return SLACK * (4 * tints->extent + points + far);
}

/// Returns whether rays from a ball of points around p to the light's ball certainly miss the ball q. The squared
/// distance of p + t d from q minus the radii is c + 2 b t + a t^2. It must be above 0 for all t in 0 .. 1, or, for a
/// directional light, for all t >= 0.
static inline int is_clear(const double p[3], double points, const glint_ball *q, double slack,
                           const glint_tint_light *light)
{
    double m[3], d[3];
    const double radius = q->radius + points + slack, rise = light->directional ? 0 : light->radius - points;
    for (int k = 0; k < 3; k++) {
        m[k] = q->center[k] - p[k];
        d[k] = light->directional ? light->position[k] : light->position[k] - p[k];
    }
    const double a = vec_dot(d, d) - rise * rise, b = -vec_dot(m, d) - radius * rise, c = vec_dot(m, m) - radius * radius;
    const int past = (a > 0) & ((b >= 0) | (b * b < a * c));
    const int beyond = !light->directional & (a + 2 * b + c > 0) & ((b >= 0) | (-b > a));
    return (c > 0) & (past | beyond);
}

uint32_t glint_tints_choose(const glint_tints *tints, const glint_ball *points, const glint_tint_light *light,
                            uint16_t chosen[GLINT_TINTS_MAX])
{
    const double slack = slack_of(tints, sqrt(vec_dot(points->center, points->center)) + points->radius, light);
    uint32_t count = 0;
    for (uint32_t i = 0; i < tints->count; i++)
        if (!is_clear(points->center, points->radius, &tints->of[i], slack, light))
            chosen[count++] = (uint16_t)i;
    return count;
}

uint16_t glint_tints_lanes(const glint_tints *tints, const uint16_t *chosen, uint32_t count,
                           const double point[3][GLINT_GROUP], uint16_t lanes, const glint_tint_light *light)
{
    unsigned opaque = 0;
    double most = 0;
    for (int i = 0; i < GLINT_GROUP; i++)
        most = fmax(most, fabs(point[0][i]) + fabs(point[1][i]) + fabs(point[2][i]));
    const double slack = slack_of(tints, most, light);
    for (uint32_t k = 0; k < count && (opaque & lanes) != lanes; k++) {
        int clear[GLINT_GROUP];
        for (int i = 0; i < GLINT_GROUP; i++)
            clear[i] = is_clear((const double[3]) { point[0][i], point[1][i], point[2][i] }, 0, &tints->of[chosen[k]],
                                slack, light);
        for (int i = 0; i < GLINT_GROUP; i++)
            opaque |= (unsigned)!clear[i] << i;
    }
    return (uint16_t)(opaque & lanes);
}
