/// Visible lights: finds the rays that hit a light before any surface. For the following stages except `shade`, such
/// a ray misses; in `shade` the light replaces the background.
///
/// All of it is double, and the same code for every instruction set: few pixels see a light.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/light_groups/light_groups.h"
#include "engine/render/effects/visible_light/plan.h"
#include "engine/render/paths/batch.h"

#include <stdlib.h>
#include <string.h>

/// The largest distance by which rounding moves a point off a plane, relative to the lengths involved, by the
/// precision of hits.
static const double plane_slack[] = { [GLINT_PRECISION_DOUBLE] = 0x1p-46, [GLINT_PRECISION_FLOAT] = 0x1p-18 };

struct glint_visible_light {
    uint16_t seen[GLINT_TILE_GROUPS]; ///< lanes whose ray sees a light; first: see glint_tile_sees_light
    uint16_t unlit[GLINT_TILE_GROUPS]; ///< the other active lanes, for shade
    uint32_t *near; ///< the lights that the current rays may see
    uint32_t near_count;
    uint32_t which[GLINT_TILE_SAMPLES]; ///< the light that each ray sees
};

static void *create(const glint_plan *plan)
{
    (void)plan;
    return glint_alloc(1, sizeof(struct glint_visible_light));
}

static void destroy(void *memory)
{
    struct glint_visible_light *visible_light = memory;
    if (visible_light)
        free(visible_light->near);
    free(visible_light);
}

/// Makes space for the plan's lights.
static bool fit(void *memory, const glint_plan *plan)
{
    struct glint_visible_light *visible_light = memory;
    uint32_t *near = realloc(visible_light->near, glint_visible_lights_of(plan)->count * sizeof *near);
    if (near)
        visible_light->near = near;
    return near;
}

static struct glint_visible_light *own_of(const glint_tile *tile) { return tile->own[GLINT_STAGE_VISIBLE_LIGHT]; }

// ---- One ray and one light ----

typedef struct visible_light_ray {
    double origin[3], direction[3];
    double slack; ///< slack for the frame's precision
} visible_light_ray;

/// Returns the first hit of a ray with a sphere, or its exit if the ray begins inside; 0: none. The formula is that
/// of cast.
static double intersect_ball(const glint_plan_visible_light *visible_light, const visible_light_ray *ray)
{
    double f[3], x[3];
    const double scale = power_of_two_scale(visible_light->radius), r = visible_light->radius * scale, r2 = r * r;
    vec_sub(f, ray->origin, visible_light->center);
    vec_scale(f, f, scale);
    const double length = sqrt(vec_dot(f, f)), c = (length - r) * (length + r);
    const double a = vec_dot(ray->direction, ray->direction), b = -vec_dot(f, ray->direction);
    vec_cross(x, f, ray->direction);
    const double disc = b * b < a * r2 ? b * b - a * c : a * r2 - vec_dot(x, x);
    if (!(disc >= 0) || (c > 0 && !(b > 0)))
        return 0;
    const double q = b >= 0 ? b + sqrt(disc) : b - sqrt(disc);
    return (c <= 0 && b >= 0 ? q / a : c / q) / scale;
}

/// Returns the height of a point above the light's plane; 0 if rounding error may exceed the height.
static double height_over(const glint_plan_visible_light *visible_light, const double point[3], double lengths,
                          double slack)
{
    double away[3];
    vec_sub(away, point, visible_light->center);
    const double height = vec_dot(visible_light->normal, away);
    return fabs(height) <= slack * (lengths + vec_max_abs(point) + vec_max_abs(visible_light->center)) ? 0 : height;
}

static bool within(const glint_plan_visible_light *visible_light, const double p[3])
{
    double away[3];
    for (size_t i = 0; i < visible_light->edge_count; i++) {
        vec_sub(away, p, visible_light->edges[i].corner);
        if (!(vec_dot(visible_light->edges[i].inwards, away) >= 0))
            return false;
    }
    vec_sub(away, p, visible_light->center);
    return visible_light->edge_count > 0 || vec_dot(away, away) <= visible_light->radius * visible_light->radius;
}

/// Returns the hit of a ray with a shining side of a disk or polygon; 0: none. A ray in the light's plane has no hit.
static double intersect_flat(const glint_plan_visible_light *visible_light, const visible_light_ray *ray)
{
    double p[3];
    const double along = vec_dot(visible_light->normal, ray->direction);
    const double height = height_over(visible_light, ray->origin, 0, ray->slack);
    const double t = -height / along;
    if (!(t > 0 && t < HUGE_VAL) || (visible_light->one_sided && along > 0))
        return 0;
    for (int c = 0; c < 3; c++)
        p[c] = ray->origin[c] + t * ray->direction[c];
    return within(visible_light, p) ? t : 0;
}

/// Returns whether a surface at `t` lies in the light's plane, within rounding.
static bool is_inside(const glint_plan_visible_light *visible_light, const visible_light_ray *ray, double t)
{
    double p[3], offset[3];
    if (visible_light->ball || !(t < HUGE_VAL))
        return false;
    vec_scale(offset, ray->direction, t);
    for (int c = 0; c < 3; c++)
        p[c] = ray->origin[c] + offset[c];
    return height_over(visible_light, p, vec_max_abs(offset) + vec_max_abs(ray->origin), ray->slack) == 0;
}

/// Returns the light that a ray hits before its surface at `*t`; GLINT_MISS: none. At equal distances, returns the
/// light defined first.
static uint32_t see(const struct glint_visible_light *visible_light, const glint_plan *plan,
                    const visible_light_ray *ray, double *t)
{
    const glint_visible_lights *lights = glint_visible_lights_of(plan);
    const double surface = *t;
    uint32_t best = GLINT_MISS;
    for (uint32_t i = 0; i < visible_light->near_count; i++) {
        const glint_plan_visible_light *light = &lights->of[visible_light->near[i]];
        const double at = light->ball ? intersect_ball(light, ray) : intersect_flat(light, ray);
        const double bound = best == GLINT_MISS && at >= surface && is_inside(light, ray, surface) ? HUGE_VAL : *t;
        if (!(at > 0 && at < bound))
            continue;
        *t = at;
        best = visible_light->near[i];
    }
    return best;
}

// ---- The lights of a tile ----

/// Returns whether a ball is outside one side of a pyramid of rays. a, b: the two edges that span the side.
static bool beyond_side(const double a[3], const double b[3], const double middle[3], const double away[3],
                        double radius)
{
    double n[3];
    vec_cross(n, a, b);
    if (vec_dot(n, middle) > 0)
        vec_scale(n, n, -1);
    return vec_dot(n, away) > sqrt(vec_dot(n, n)) * (radius * (1 + 1e-9) + 1e-9 * vec_max_abs(away));
}

/// Lists the lights that a tile of a perspective camera may show.
static void find_near(struct glint_visible_light *visible_light, const glint_tile *tile, const glint_plan *plan)
{
    const glint_camera_args *camera = &tile->camera;
    double corner[4][3], middle[3] = { 0 };
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++) {
            const double px = camera->x0 + (k == 1 || k == 2 ? tile->width : 0);
            const double py = camera->y0 + (k >= 2 ? tile->height : 0);
            corner[k][c] = (camera->forward[c] + (2 * px - camera->width) * camera->right[c]) +
                           (camera->height - 2 * py) * camera->up[c];
            middle[c] += corner[k][c];
        }
    const glint_visible_lights *lights = glint_visible_lights_of(plan);
    visible_light->near_count = 0;
    for (uint32_t i = 0; i < lights->count; i++) {
        const glint_plan_visible_light *light = &lights->of[i];
        double away[3];
        bool outside = false;
        vec_sub(away, light->center, camera->eye);
        for (int k = 0; k < 4 && !outside; k++)
            outside = beyond_side(corner[k], corner[(k + 1) & 3], middle, away, light->radius);
        if (!outside)
            visible_light->near[visible_light->near_count++] = i;
    }
}

/// Clears the lights seen. Returns false if no ray of the tile can see a light.
static bool in_sight(glint_tile *tile, const glint_tile_frame *frame)
{
    struct glint_visible_light *visible_light = own_of(tile);
    memset(visible_light->seen, 0, sizeof visible_light->seen);
    if (!glint_tile_rays_of(tile)) {
        visible_light->near_count = glint_visible_lights_of(frame->plan)->count;
        for (uint32_t i = 0; i < visible_light->near_count; i++)
            visible_light->near[i] = i;
    } else {
        find_near(visible_light, tile, frame->plan);
    }
    return visible_light->near_count > 0;
}

/// Copies the sample's hits into the tile's own memory if they are in the cache.
static void own_hits(glint_tile *tile, glint_precision precision)
{
    const size_t count = tile->group_count * GLINT_GROUP;
    if (tile->at.hits == tile->hit.mask)
        return;
    memcpy(tile->hit.t, tile->at.t, count * (precision == GLINT_PRECISION_FLOAT ? sizeof(float) : sizeof(double)));
    memcpy(tile->hit.prim, tile->at.prim, count * sizeof *tile->hit.prim);
    memcpy(tile->hit.mask, tile->at.hits, tile->group_count * sizeof *tile->hit.mask);
    tile->at.t = tile->hit.t;
    tile->at.prim = tile->hit.prim;
    tile->at.hits = tile->hit.mask;
    tile->at.sampled = tile->hit.mask;
}

static void see_lane(glint_tile *tile, const glint_tile_frame *frame, uint32_t i)
{
    const glint_precision precision = frame->plan->desc.precision;
    const uint16_t bit = (uint16_t)(1u << i % GLINT_GROUP);
    uint16_t *hits = &tile->at.hits[i / GLINT_GROUP];
    visible_light_ray ray = { .slack = plane_slack[precision] };
    for (int c = 0; c < 3; c++) {
        ray.origin[c] =
            glint_tile_rays_of(tile) ? tile->camera.eye[c] : glint_real_at(tile->rays.origin[c], precision, i);
        ray.direction[c] = glint_tile_direction(tile, precision, c, i);
    }
    double t = *hits & bit ? glint_real_at(tile->at.t, precision, i) : HUGE_VAL;
    const uint32_t which = see(own_of(tile), frame->plan, &ray, &t);
    if (which == GLINT_MISS)
        return;
    own_of(tile)->seen[i / GLINT_GROUP] |= bit;
    own_of(tile)->which[i] = which;
    tile->counts.work.lights_seen += frame->count_work;
    *hits = (uint16_t)(*hits & ~bit);
    tile->at.prim[i] = GLINT_MISS;
    glint_real_put(tile->at.t, precision, i, t);
}

/// Turns rays in `lanes` that see a light into misses at its distance. Rays and hits must be known.
static void see_lights(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *lanes)
{
    own_hits(tile, frame->plan->desc.precision);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = lanes[g]; bits; bits &= bits - 1)
            see_lane(tile, frame, g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits));
}

// ---- Their brightness ----

static void normal_of(const glint_tile *tile, const glint_tile_frame *frame, uint32_t i, double normal[3])
{
    const glint_precision precision = frame->plan->desc.precision;
    const glint_plan_visible_light *light = &glint_visible_lights_of(frame->plan)->of[own_of(tile)->which[i]];
    double d[3];
    for (int c = 0; c < 3; c++) {
        const double from =
            glint_tile_rays_of(tile) ? tile->camera.eye[c] : glint_real_at(tile->rays.origin[c], precision, i);
        d[c] = glint_tile_direction(tile, precision, c, i);
        normal[c] =
            light->ball ? from + glint_real_at(tile->at.t, precision, i) * d[c] - light->center[c] : light->normal[c];
    }
    vec_normalize(normal, normal);
    if (vec_dot(normal, d) > 0)
        vec_scale(normal, normal, -1);
}

/// Leaves the background to the rays that see no light.
static void mask_background(glint_tile *tile, const glint_tile_frame *frame, glint_shade_args *args, glint_shade_light *lights,
                            uint32_t from, uint32_t count)
{
    struct glint_visible_light *own = own_of(tile);
    (void)frame, (void)lights, (void)from, (void)count;
    for (uint32_t g = 0; g < tile->group_count && args->first; g++)
        own->unlit[g] = (uint16_t)(tile->active[g] & ~own->seen[g]);
    args->active = args->first ? own->unlit : args->active;
}

/// Adds the brightness of visible lights to the sums, as background.
static void add_brightness(glint_tile *tile, const glint_tile_frame *frame, const glint_shade_args *args, uint32_t from,
                           uint32_t count)
{
    (void)from, (void)count;
    for (uint32_t g = 0; g < tile->group_count && args->first; g++)
        for (unsigned bits = own_of(tile)->seen[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            const glint_plan_visible_light *light = &glint_visible_lights_of(frame->plan)->of[own_of(tile)->which[i]];
            for (int c = 0; c < 3; c++)
                tile->film.sum[GLINT_TERM_BACKGROUND][c][i] += light->shown[c];
            glint_groups_add(tile, light->group, i, light->shown);
        }
}

static glint_key position_key(const glint_plan_visible_light *visible_light, glint_key key)
{
    const double kind[] = { visible_light->ball, visible_light->one_sided, visible_light->radius,
                            (double)visible_light->edge_count };
    GLINT_KEY_ADD(key, kind);
    GLINT_KEY_ADD(key, visible_light->center);
    GLINT_KEY_ADD(key, visible_light->normal);
    return glint_key_add(key, visible_light->edges, visible_light->edge_count * sizeof *visible_light->edges);
}

/// Hashes the positions of visible lights. The key of the background includes their brightness.
static glint_key positions_key(const glint_plan *plan, glint_key key)
{
    const glint_visible_lights *lights = glint_visible_lights_of(plan);
    for (uint32_t i = 0; i < lights->count; i++)
        key = position_key(&lights->of[i], key);
    return key;
}

static bool called(const glint_plan *plan) { return plan->own[GLINT_STAGE_VISIBLE_LIGHT]; }

static void look(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    uint16_t lanes[GLINT_TILE_GROUPS];
    if (in_sight(tile, frame)) {
        glint_tile_need_rays(tile, frame, walk);
        for (uint32_t g = 0; g < tile->group_count; g++)
            lanes[g] = (uint16_t)(tile->active[g] & ~(tile->batch ? tile->batch->rays->skip_emitters[g] : 0));
        see_lights(tile, frame, lanes);
    }
    glint_tile_count_stage(tile, frame, GLINT_STAGE_VISIBLE_LIGHT, false);
}

const glint_stage glint_stage_visible_light = {
    .name = "visible_lights",
    .doc = "which rays see a light before any object",
    .prepare = glint_visible_lights_prepare,
    .called = called,
    .own = positions_key,
    .reads = GLINT_READS_OWN(VISIBLE_LIGHT),
    .sums = true,
    .remote = true,
    .step[GLINT_AT_HITS] = look,
    .before_shade = mask_background,
    .after_shade = add_brightness,
    .adds = glint_tile_adds_anywhere,
    .normal = normal_of,
    .create = create,
    .destroy = destroy,
    .fit = fit,
    .shared = true,
};
