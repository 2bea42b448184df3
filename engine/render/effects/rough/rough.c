/// Rough reflection and refraction: microfacets show their surroundings.
///
/// From each rough point, several rays leave in the directions of facets (facets.c). Each begins a path, which
/// effects/indirect follows. Lamps give a surface of cook_torrance their highlights, so its reflected rays do not see
/// them; the rays of other rough mirrors and of rough glass see the lamps that are visible.
#include "engine/base/vec.h"
#include "engine/render/effects/environment/plan.h"
#include "engine/render/effects/indirect/paths.h"
#include "engine/render/effects/rough/rough.h"

#include <stdlib.h>

#define SALT (UINT64_C(1) << 40) ///< beyond all numbers of depths
#define SHARP 1e-6 ///< width of a distribution within which all rays are one

struct glint_rough {
    struct glint_indirect *paths;
    bool mirrors[GLINT_TILE_SAMPLES], transmits[GLINT_TILE_SAMPLES]; ///< whether paths of each point are reflected, refracted
    // points that only reflect, from GGX's facets: the stage spread draws for all of them at once
    uint16_t plain[GLINT_TILE_GROUPS];
    _Alignas(64) double ray[3][GLINT_TILE_SAMPLES], alpha[GLINT_TILE_SAMPLES]; ///< real
    double weight[3][GLINT_TILE_SAMPLES], grazing[3][GLINT_TILE_SAMPLES]; ///< of a ray reflected straight back, and what
        ///< Schlick's reflectance adds at grazing angles
    glint_plan plan; ///< the frame's plan, with the numbers of samples and bounces of these paths
    glint_tile_frame frame;
};

static void *create(const glint_plan *plan)
{
    struct glint_rough *rough = aligned_alloc(_Alignof(struct glint_rough), sizeof *rough);
    if (!rough)
        return NULL;
    rough->paths = glint_indirect_create(plan);
    if (rough->paths)
        return rough;
    free(rough);
    return NULL;
}

static void destroy(void *memory)
{
    struct glint_rough *rough = memory;
    if (rough)
        glint_indirect_destroy(rough->paths);
    free(rough);
}

/// Returns whether the surface of sample i reflects or refracts rays in many directions.
static bool spreads(const glint_tile *seen, const glint_plan *plan, const glint_batch *from, uint32_t i)
{
    return glint_is_spreading(&plan->bouncing[seen->surface.material[i]]) && (!from || from->rays->depth[from->ray_of[i]] < plan->desc.max_depth);
}

/// Fills the arguments of spread for point i, and the parts of its rays that are equal for all paths.
static void note_plain(struct glint_rough *rough, const glint_tile *seen, const glint_bounce_material *m, uint32_t i,
                       uint32_t paths)
{
    const glint_precision precision = rough->plan.desc.precision;
    glint_rays *first = &rough->paths->first;
    double direction[3];
    for (int c = 0; c < 3; c++)
        direction[c] = glint_tile_direction(seen, precision, c, i);
    vec_normalize(direction, direction);
    for (int c = 0; c < 3; c++) {
        glint_real_put(rough->ray[c], precision, i, direction[c]);
        const double most = first->throughput[c][i] / paths * (m->mirror[c] * m->specular[c]), f0 = m->schlick ? m->f0[c] : 1;
        rough->weight[c][i] = most * f0;
        rough->grazing[c][i] = most * (1 - f0);
    }
    glint_real_put(rough->alpha, precision, i, m->alpha);
    rough->plain[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
    first->depth[i]++;
    first->camera_path[i] = false;
    glint_rays_mark(first->inward, i, glint_has_lane(seen->hit.back, i));
    glint_rays_mark(first->skip_emitters, i, m->facets || first->scatters[i] > 0);
}

/// Begins the paths of point i. Returns their number.
static uint32_t begin_point(struct glint_rough *rough, const glint_tile *to, const glint_tile *seen,
                            const glint_batch *from, uint32_t i, glint_pixel_block *block)
{
    static const double whole[3] = { 1, 1, 1 };
    const glint_plan *plan = &rough->plan;
    glint_bounce_material buffer;
    const glint_bounce_material *m = glint_tile_bouncing(seen, plan, i, &buffer);
    glint_rays *first = &rough->paths->first;
    rough->mirrors[i] = m->mirrors && vec_dot(m->mirror, m->specular) > 0;
    rough->transmits[i] = m->transmits;
    if (!rough->mirrors[i] && !rough->transmits[i])
        return 0;
    const bool both = rough->mirrors[i] && rough->transmits[i];
    const uint32_t paths = m->alpha < SHARP && !both ? 1 : glint_indirect_paths_of(plan, from, i);
    glint_ray_begin(from ? from : &rough->paths->batch, seen, &rough->frame, i, first, i);
    if (!from)
        first->term[i] = GLINT_TERM_MIRROR;
    if (glint_is_plain(plan, seen->surface.material[i]))
        note_plain(rough, seen, m, i, paths);
    glint_indirect_begin_point(rough->paths, to, plan, i, paths, whole, block);
    return paths;
}

/// Finds the points and their numbers of paths. Returns the largest number.
static uint32_t find_points(struct glint_rough *rough, const glint_tile *to, const glint_tile *seen, const glint_batch *from)
{
    struct glint_indirect *paths = rough->paths;
    glint_pixel_block block = { .known = false };
    uint32_t most = 0;
    paths->fewest = UINT32_MAX;
    glint_rays_clear(&paths->first, seen->group_count);
    for (uint32_t g = 0; g < seen->group_count; g++) {
        rough->plain[g] = 0;
        for (unsigned bits = seen->at.hits[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            const uint32_t count = spreads(seen, &rough->plan, from, i) ? begin_point(rough, to, seen, from, i, &block) : 0;
            most = count > most ? count : most;
        }
        paths->matt[g] = paths->first.active[g];
    }
    return most;
}

/// Draws the event of path `number` of point i at the facet of a point of the disk. Returns its probability.
static double sample_event(const struct glint_rough *rough, const glint_batch *batch, const glint_tile *seen, uint32_t i,
                          uint64_t number, const double disk[2], glint_event *event)
{
    double lot[2], share[2];
    *event = rough->mirrors[i] ? GLINT_EVENT_MIRROR : GLINT_EVENT_REFRACT;
    if (!rough->mirrors[i] || !rough->transmits[i])
        return 1;
    glint_rough_shares(batch, seen, &rough->frame, i, disk, share);
    glint_indirect_draw(rough->paths, i, number, 1, lot);
    const double mirrored = share[GLINT_EVENT_MIRROR] / (share[0] + share[1]);
    *event = lot[0] < mirrored ? GLINT_EVENT_MIRROR : GLINT_EVENT_REFRACT;
    return lot[0] < mirrored ? mirrored : 1 - mirrored;
}

/// Makes the first ray of path `number` of point i. disk: a point of the unit disk.
static void begin_path(struct glint_rough *rough, const glint_tile *seen, const glint_batch *from, uint32_t i,
                       uint64_t number, const double disk[2], uint32_t path)
{
    struct glint_indirect *paths = rough->paths;
    const glint_batch *batch = from ? from : &paths->batch;
    glint_event event;
    const double pdf = sample_event(rough, batch, seen, i, number, disk, &event);
    glint_rays *first = &paths->first;
    const double least = first->min_throughput[i];
    double cube[3], lot[2];
    glint_ray_begin(batch, seen, &rough->frame, i, first, i);
    first->point[i] = i;
    first->min_throughput[i] = least;
    for (int c = 0; c < 3; c++)
        first->throughput[c][i] = glint_clamp_throughput(paths->weight[c][i] / pdf);
    glint_indirect_square(&paths->first_draws, i, path, cube);
    if (rough->plan.sky)
        glint_indirect_draw(paths, i, number, 1, lot); // sample_event takes the first of them
    cube[2] = rough->plan.sky ? lot[1] : 0;
    event = glint_rough_leave(batch, seen, &rough->frame, i, disk, cube, event, first, i);
    if (!from)
        first->term[i] = event == GLINT_EVENT_MIRROR ? GLINT_TERM_MIRROR : GLINT_TERM_TRANSMISSION;
}

/// Makes the first rays of the points in `wanted` that the stage spread serves.
static void begin_plain(struct glint_rough *rough, const glint_tile *seen, const uint16_t *wanted)
{
    glint_spread_args args = { .group_count = seen->group_count, .wanted = wanted, .alpha = rough->alpha,
                               .grazing = rough->paths->grazing, .weight = rough->paths->unmasked,
                               .disk = { rough->paths->direction[0], rough->paths->direction[1] } };
    for (int c = 0; c < 3; c++) {
        args.head_on[c] = rough->weight[c];
        args.added[c] = rough->grazing[c];
        args.ray_weight[c] = rough->paths->first.throughput[c];
        args.normal[c] = seen->surface.normal[c];
        args.ray[c] = rough->ray[c];
        args.direction[c] = rough->paths->first.direction[c];
    }
    rough->frame.stages->geometry[rough->plan.desc.precision].spread(&args);
}

/// Makes the first rays of path number `path` of every point. Returns whether there are any.
static bool begin_paths(struct glint_rough *rough, const glint_tile *seen, const glint_batch *from, uint32_t path, uint64_t number)
{
    struct glint_indirect *paths = rough->paths;
    const void *const up[] = { paths->up[0], paths->up[1], paths->up[2] };
    if (!glint_indirect_choose_points(paths, &rough->plan, path, number))
        return false;
    glint_indirect_scatter(&rough->frame, seen->group_count, up, paths->first.active, &paths->first_draws, path, paths->direction);
    uint16_t plain[GLINT_TILE_GROUPS];
    for (uint32_t g = 0; g < seen->group_count; g++)
        plain[g] = paths->first.active[g] & rough->plain[g];
    begin_plain(rough, seen, plain);
    for (uint32_t g = 0; g < seen->group_count; g++)
        for (unsigned bits = paths->first.active[g] & ~(unsigned)rough->plain[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            double disk[2];
            for (int c = 0; c < 2; c++)
                disk[c] = glint_real_at(paths->direction[c], rough->plan.desc.precision, i);
            begin_path(rough, seen, from, i, number, disk, path);
        }
    return true;
}

/// Ambient occlusion ends at the first surface: what rough surfaces show has the whole ambient light.
static void begin_tile(struct glint_rough *rough, const glint_tile_frame *frame)
{
    rough->plan = *frame->plan;
    rough->plan.derivatives = NULL; // this light is held constant
    glint_plan_drop(&rough->plan, GLINT_STAGE_DERIVATIVE);
    rough->plan.indirect.samples = frame->plan->rough_samples;
    if (frame->plan->indirect.is_sky)
        rough->plan.indirect.bounces = 0;
    rough->plan.indirect.is_sky = false;
    rough->frame = *frame;
    rough->frame.plan = &rough->plan;
    rough->paths->salt = SALT;
    glint_indirect_begin(rough->paths, &rough->frame);
}

static void gather(glint_tile *tile, const glint_tile_frame *frame, const glint_tile *seen, const glint_batch *from)
{
    struct glint_rough *rough = tile->own[GLINT_STAGE_ROUGH];
    struct glint_indirect *paths = rough->paths;
    begin_tile(rough, frame);
    const uint32_t count = find_points(rough, tile, seen, from);
    if (count == 0)
        return;
    paths->term = GLINT_TERM_MIRROR;
    for (uint32_t g = 0; g < seen->group_count; g++)
        if (from || paths->matt[g] & ~rough->plain[g])
            paths->term = GLINT_TERM_COUNT;
    glint_batch_begin(&paths->batch, tile, &rough->frame, GLINT_WALK_ROUGH);
    paths->batch.ordered = from != NULL; // rays may share pixels
    for (uint32_t path = 0; path < count && !glint_tile_cancelled(frame); path++) {
        const uint64_t number = (uint64_t)tile->sample * rough->plan.indirect.samples + path;
        paths->batch.tile.sample = (uint32_t)number;
        if (begin_paths(rough, seen, from, path, number))
            glint_indirect_follow(paths, &rough->frame, tile, number);
    }
    glint_batch_end(&paths->batch, tile);
}

static glint_key own_key(const glint_plan *plan, glint_key key)
{
    GLINT_KEY_ADD(key, plan->rough_samples);
    GLINT_KEY_ADD(key, plan->desc.clamp);
    return glint_bounce_key(plan, key);
}

static glint_status prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    (void)from;
    if (!plan->rough_samples)
        return GLINT_OK;
    const glint_status status = glint_indirect_find_light_rows(plan, error);
    return status ? status : glint_sky_find(plan, error);
}

static bool called(const glint_plan *plan)
{
    return plan->rough_samples > 0 && plan->desc.max_depth > 0 && plan->geometry->table.prim_count > 0;
}

static bool adds(const glint_tile *tile, const glint_tile_frame *frame, bool any)
{
    return any && glint_tile_shows(tile, frame, glint_is_spreading);
}

/// Adds the light that rough surfaces reflect and refract.
static void add(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (!walk->any || tile->direct || !glint_tile_shows(tile, frame, glint_is_spreading))
        return;
    glint_tile_need_points(tile, frame, walk);
    gather(tile, frame, tile, NULL);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_ROUGH, false);
}

/// Adds this light at the hits of secondary rays.
static void add_sent(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (walk->any)
        gather(tile, frame, &walk->batch->tile, walk->batch);
}

const glint_stage glint_stage_rough = {
    .name = "rough",
    .doc = "rays that rough surfaces reflect and refract, and the light of these rays",
    .calls = "bounce environment indirect",
    .prepare = prepare,
    .called = called,
    .own = own_key,
    .reads = GLINT_READS_OWN(ROUGH) | GLINT_READS_OWN(INDIRECT),
    .walks = true,
    .sums = true,
    .normals = true,
    .remote = true,
    .adds = adds,
    .step = { [GLINT_AFTER_LIGHTS] = add, [GLINT_AFTER_SECONDARY] = add_sent },
    .create = create,
    .destroy = destroy,
    .sized = true,
};
