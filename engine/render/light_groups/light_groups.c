#include "engine/render/light_groups/light_groups.h"
#include "engine/base/alloc.h"
#include "engine/render/effects/visible_light/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// A rest below this share of a pixel's light is rounding, and counts as 0.
#define ROUNDING 0x1p-40
#define ROUNDING_OF_POINTS 0x1p-22

enum { DIFFUSE, SPECULAR, OTHER, SUMS = GLINT_GROUP_SUMS }; ///< OTHER: everything except light of lamps on the tile's own hits

struct glint_group_sums {
    glint_group_terms *sum; ///< sums of each group; first: see glint_group_sum
    _Alignas(64) double local[GLINT_TERM_LOCAL][3][GLINT_TILE_SAMPLES]; ///< terms of one call of shade without lights
    uint32_t count, pass_count;
    double (*faded)[3][GLINT_TILE_SAMPLES]; ///< for each group, over the finished samples; NULL: nothing fades
    float (*mean)[3][GLINT_TILE_SAMPLES]; ///< mean light of each pass
    struct glint_group_sums *batch,
        *points; ///< sums of rays that left surfaces, and of faces and vertices; owned by the tile's sums
};

// ---- Memory ----

static struct glint_group_sums *create(uint32_t count)
{
    struct glint_group_sums *sums = glint_alloc(1, sizeof *sums);
    if (sums)
        sums->sum = glint_alloc(count, sizeof *sums->sum);
    if (sums && !sums->sum) {
        free(sums);
        return NULL;
    }
    if (sums)
        sums->count = count;
    return sums;
}

static void destroy(void *memory)
{
    struct glint_group_sums *sums = memory;
    if (!sums)
        return;
    if (sums->batch)
        sums->batch->points = NULL; // the tile's sums own them
    destroy(sums->batch);
    destroy(sums->points);
    free(sums->sum);
    free(sums->faded);
    free(sums->mean);
    free(sums);
}

static void *create_for(const glint_plan *plan)
{
    const struct glint_light_groups *groups = plan->light_groups;
    struct glint_group_sums *sums = create(groups->count);
    if (!sums)
        return NULL;
    sums->pass_count = groups->pass_count;
    bool good = (sums->mean = glint_alloc(groups->pass_count, sizeof *sums->mean)) != NULL;
    if (plan->runs[GLINT_STAGE_DEPTH_CUE])
        good = (sums->faded = glint_alloc(groups->count, sizeof *sums->faded)) && good;
    if (glint_plan_sends_rays(plan))
        good = (sums->batch = create(groups->count)) && good;
    if (plan->runs[GLINT_STAGE_VERTEX_SHADING])
        good = (sums->points = create(groups->count)) && good;
    if (sums->batch)
        sums->batch->points = sums->points; // batches use `points`, too
    if (good)
        return sums;
    destroy(sums);
    return NULL;
}

static struct glint_group_sums *own_of(const glint_tile *tile) { return tile->own[GLINT_STAGE_LIGHT_GROUPS]; }

struct glint_group_sums *glint_group_sums_of(const glint_tile *to, bool points)
{
    const struct glint_group_sums *own = own_of(to);
    return !own ? NULL : points ? own->points : own->batch;
}

// ---- A sample ----

/// Returns the light of a group in a sample.
static double sum_of(const struct glint_group_sums *sums, uint32_t group, int c, uint32_t i)
{
    double(*sum)[3][GLINT_TILE_SAMPLES] = sums->sum[group];
    return (sum[DIFFUSE][c][i] + sum[SPECULAR][c][i]) + sum[OTHER][c][i];
}

/// Clears the sums before the first call of shade for the eye's hits, or for a batch.
static void begin(glint_tile *tile, const glint_tile_frame *frame, glint_shade_args *args, glint_shade_light *lights,
                  uint32_t from, uint32_t count)
{
    const size_t size = tile->group_count * GLINT_GROUP * sizeof(double);
    (void)frame, (void)args, (void)lights, (void)count;
    if (from > 0 || (!tile->batch && tile->sample > 0))
        return;
    for (uint32_t g = 0; g < own_of(tile)->count; g++)
        for (int k = 0; k < SUMS; k++)
            for (int c = 0; c < 3; c++)
                memset(own_of(tile)->sum[g][k][c], 0, size);
}

void glint_groups_add(const glint_tile *tile, uint32_t group, uint32_t i, const double light[3])
{
    for (int c = 0; own_of(tile) && group != GLINT_NO_GROUP && c < 3; c++)
        own_of(tile)->sum[group][OTHER][c][i] += light[c];
}

/// Computes the ambient term of all hits, of which each light has a share.
static void shade_ambient(const glint_tile *tile, const glint_tile_frame *frame, const glint_shade_args *args)
{
    const struct glint_light_groups *groups = frame->plan->light_groups;
    double(*local)[3][GLINT_TILE_SAMPLES] = own_of(tile)->local;
    glint_shade_args ambient = *args;
    memset(local, 0, sizeof own_of(tile)->local);
    ambient.light_count = 0;
    for (int k = 0; k < GLINT_TERM_LOCAL; k++)
        for (int c = 0; c < 3; c++)
            ambient.sum[k][c] = local[k][c];
    frame->stages->shade(&ambient);
    for (uint32_t g = 0; g < groups->count; g++)
        for (int c = 0; c < 3; c++)
            for (uint32_t i = 0; groups->ambient[g][c] > 0 && i < tile->group_count * GLINT_GROUP; i++)
                own_of(tile)->sum[g][OTHER][c][i] += groups->ambient[g][c] * local[GLINT_TERM_AMBIENT][c][i];
}

void glint_groups_shade_one(glint_tile *tile, const glint_tile_frame *frame, const glint_shade_args *args,
                            uint32_t group)
{
    glint_shade_args own = *args;
    if (!frame->plan->light_groups || group == GLINT_NO_GROUP || args->light_count == 0)
        return;
    own.first = false;
    for (int term = 0; term < 2; term++)
        for (int c = 0; c < 3; c++)
            own.sum[GLINT_TERM_DIFFUSE + term][c] =
                args->sum[GLINT_TERM_DIFFUSE + term][c] ? own_of(tile)->sum[group][DIFFUSE + term][c] : NULL;
    frame->stages->shade(&own);
}

/// Selects the lights of a call that belong to a group, and finds the next group. If the sum of a light's samples is
/// stored in its first row, its other rows are not in the call.
static uint32_t choose_lights(const glint_tile *tile, const glint_plan_light *rows, uint32_t count,
                              const glint_shade_light *lights, uint32_t group, glint_shade_light *chosen,
                              uint32_t *next)
{
    uint32_t chosen_count = 0, at = 0;
    *next = GLINT_NO_GROUP;
    for (uint32_t i = 0; i < count; i++) {
        if (tile->at.light[i].summed && rows[i].joined && i > 0)
            continue;
        if (rows[i].group == group)
            chosen[chosen_count++] = lights[at];
        else if (rows[i].group > group && rows[i].group < *next)
            *next = rows[i].group;
        at++;
    }
    return chosen_count;
}

/// Adds the light of a call of shade, and the lights' share of ambient light if it has `first`.
static void shade(glint_tile *tile, const glint_tile_frame *frame, const glint_shade_args *args, uint32_t from, uint32_t count)
{
    glint_shade_light lights[GLINT_LIGHT_CHUNK];
    glint_shade_args own = *args;
    own.lights = lights;
    for (uint32_t group = 0, next; group < frame->plan->light_groups->count; group = next) {
        own.light_count = choose_lights(tile, &frame->plan->lights[from], count, args->lights, group, lights, &next);
        glint_groups_shade_one(tile, frame, &own, group);
    }
    if (args->first && frame->plan->light_groups->has_ambient)
        shade_ambient(tile, frame, args);
}

void glint_groups_collect(const glint_batch *batch, const glint_plan *plan, glint_tile *to, uint32_t at, uint32_t pixel,
                          const double weight[3])
{
    for (uint32_t g = 0; g < plan->light_groups->count; g++) {
        for (int c = 0; c < 3; c++)
            own_of(to)->sum[g][OTHER][c][pixel] += weight[c] * sum_of(own_of(&batch->tile), g, c, at);
    }
}

void glint_groups_add_ambient(const glint_tile *to, const glint_plan *plan, uint32_t pixel, int c, double light)
{
    const struct glint_light_groups *groups = plan->light_groups;
    for (uint32_t g = 0; groups->has_ambient && g < groups->count; g++)
        own_of(to)->sum[g][OTHER][c][pixel] += groups->ambient[g][c] * light;
}

void glint_groups_fade(const glint_tile *tile, const glint_plan *plan,
                       const double (*transmittance)[GLINT_TILE_SAMPLES])
{
    struct glint_group_sums *sums = own_of(tile);
    for (uint32_t g = 0; plan->light_groups && g < sums->count; g++)
        for (int c = 0; c < 3; c++)
            for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
                const double before = tile->sample == 0 ? 0 : sums->faded[g][c][i];
                sums->faded[g][c][i] =
                    before + (transmittance[c][i] > 0 ? sum_of(sums, g, c, i) * transmittance[c][i] : 0);
                for (int k = 0; k < SUMS; k++)
                    sums->sum[g][k][c][i] = 0;
            }
}

// ---- The picture ----

/// Loads the light of a group for `count` pixels over all samples, in one channel.
static void take_light(const struct glint_group_sums *sums, uint32_t group, int c, uint32_t count,
                       double *restrict light)
{
    const double *diffuse = sums->sum[group][DIFFUSE][c], *specular = sums->sum[group][SPECULAR][c],
                 *other = sums->sum[group][OTHER][c];
    if (sums->faded) {
        memcpy(light, sums->faded[group][c], count * sizeof *light);
        return;
    }
    for (uint32_t i = 0; i < count; i++)
        light[i] = (diffuse[i] + specular[i]) + other[i];
}

/// Adds this light to the light of all lamps. mean: the plane of the group's pass; NULL: the group has no pass.
static void add_light(const double *restrict light, uint32_t count, double samples, double *restrict lamps,
                      float *restrict mean)
{
    for (uint32_t i = 0; i < count; i++)
        lamps[i] += light[i];
    for (uint32_t i = 0; mean && i < count; i++)
        mean[i] = (float)(light[i] / samples);
}

/// Computes the mean of the light without a lamp, in one channel. lamps: the sums of all groups.
static void find_rest(const glint_tile *tile, const glint_plan *plan, int c, const double *lamps, float *mean)
{
    const double rounding = plan->runs[GLINT_STAGE_VERTEX_SHADING] ? ROUNDING_OF_POINTS : ROUNDING;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        double all = 0;
        for (int k = 0; k < GLINT_TERM_COUNT; k++)
            if (glint_plan_has_term(plan, (glint_term)k))
                all += tile->film.sum[k][c][i];
        const double rest = all - lamps[i];
        mean[i] = (float)((fabs(rest) <= rounding * all ? 0 : rest) / plan->desc.samples);
    }
}

/// Averages all samples.
static void resolve(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    (void)walk;
    const struct glint_light_groups *groups = frame->plan->light_groups;
    const double samples = frame->plan->desc.samples;
    const uint32_t count = tile->group_count * GLINT_GROUP;
    for (int c = 0; c < 3; c++) {
        double lamps[GLINT_TILE_SAMPLES] = { 0 };
        for (uint32_t g = 0; g < groups->count; g++) {
            double light[GLINT_TILE_SAMPLES];
            if (g == groups->rest)
                continue;
            take_light(own_of(tile), g, c, count, light);
            add_light(light, count, samples, lamps, g < groups->pass_count ? own_of(tile)->mean[g][c] : NULL);
        }
        if (groups->rest != GLINT_NO_GROUP)
            find_rest(tile, frame->plan, c, lamps, own_of(tile)->mean[groups->rest][c]);
    }
}

/// Copies the means of the base for the pixels that are not refined.
static void take_base(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    (void)walk;
    for (size_t g = 0; frame->base && g < frame->image->light_count; g++)
        for (int c = 0; c < 3; c++)
            glint_tile_take_plane(tile, frame, frame->base->light[g][c], own_of(tile)->mean[g][c]);
}

static void store(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    (void)walk;
    for (size_t g = 0; g < frame->image->light_count; g++)
        for (int c = 0; c < 3; c++)
            glint_tile_store_plane(tile, own_of(tile)->mean[g][c], frame->image->light[g][c], frame->image->width);
}

static bool called(const glint_plan *plan) { return plan->light_groups; }

/// Runs as a part of all stages that add light.
const glint_stage glint_stage_light_groups = {
    .prepare = glint_light_groups_prepare,
    .release = glint_light_groups_release,
    .called = called,
    .own = glint_light_groups_key,
    .pass_key = glint_light_pass_key,
    .passes = true,
    .sums = true,
    .remote = true,
    .step = { [GLINT_AT_DONE] = resolve, [GLINT_AT_STORE] = take_base, [GLINT_AT_STORE_LIGHT] = store },
    .before_shade = begin,
    .after_shade = shade,
    .adds = glint_tile_adds_anywhere,
    .create = create_for,
    .destroy = destroy,
    .sized = true,
};
