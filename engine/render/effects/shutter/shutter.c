/// The mean of a frame's times, if more than lights differ between them. Each time is rendered as a frame of its own,
/// with reuse between them, and added up in double.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/film/tone.h"
#include "engine/render/effects/shutter/plan.h"
#include "engine/render/frame/render.h"

#include <stdlib.h>
#include <string.h>

/// A plane that is a mean.
typedef struct mean {
    double *sum;
    float *out;
    int pass, channel;
} mean;

#define DERIVATIVE_PASSES (((1u << GLINT_DERIVATIVES_MAX) - 1) << GLINT_PASS_DERIVATIVE)

typedef struct exposure {
    const glint_plan *plan;
    glint_extent extent;
    mean *means; ///< owned
    size_t mean_count;
    glint_image *image;
    const glint_image *part; ///< the image of one time
    double *sums; ///< sums of all means
    const float *beauty[3], *alpha; ///< the source of pixel values: planes of the image, or `own`
    float *own; ///< owned: planes that the image does not have
    const glint_tone_table *table;
    uint64_t (*counts)[2]; ///< pixels too bright and not finite, of each row
} exposure;

/// Returns the image row of item `index`. The following functions handle rows.
static size_t row_at(const exposure *e, size_t index)
{
    return ((size_t)e->extent.y + index) * (size_t)e->image->width;
}

/// Returns a time's plane of a mean; NULL: nothing depends on the derivative at this time, or the group has no lights.
static const float *plane_of(const exposure *e, const mean *m)
{
    if (m->pass < GLINT_PASS_DERIVATIVE)
        return e->part->plane[m->pass][m->channel];
    for (size_t i = 0; m->pass >= GLINT_PASS_LIGHT && i < e->part->light_count; i++)
        if (strcmp(e->part->light_name[i], e->image->light_name[m->pass - GLINT_PASS_LIGHT]) == 0)
            return e->part->light[i][m->channel];
    if (m->pass >= GLINT_PASS_LIGHT)
        return NULL;
    const char *name = e->image->derivative[m->pass - GLINT_PASS_DERIVATIVE];
    for (int i = 0; i < GLINT_DERIVATIVES_MAX; i++)
        if (strcmp(e->part->derivative[i], name) == 0)
            return e->part->plane[GLINT_PASS_DERIVATIVE + i][m->channel];
    return NULL;
}

static void add_row(void *context, size_t index, int worker)
{
    const exposure *e = context;
    const size_t row = row_at(e, index);
    (void)worker;
    for (size_t m = 0; m < e->mean_count; m++) {
        double *sum = e->means[m].sum + row;
        const float *from = plane_of(e, &e->means[m]);
        for (int x = e->extent.x; from && x < e->extent.x + e->extent.width; x++)
            sum[x] += from[row + (size_t)x];
    }
}

/// Sums the terms into beauty, as in a frame of one instant. All terms must be among the passes.
static void sum_terms(const exposure *e, size_t row)
{
    float *const *beauty = e->image->plane[GLINT_PASS_BEAUTY];
    for (int c = 0; c < 3; c++)
        for (int x = e->extent.x; x < e->extent.x + e->extent.width; x++) {
            float sum = e->image->plane[GLINT_PASS_BACKGROUND][c][row + (size_t)x];
            for (int pass = GLINT_PASS_AMBIENT; pass <= GLINT_PASS_TRANSMISSION; pass++)
                sum += e->image->plane[pass][c][row + (size_t)x];
            beauty[c][row + (size_t)x] = sum;
        }
}

static bool has_all_terms(const glint_image *image)
{
    bool all = image->plane[GLINT_PASS_BEAUTY][0] != NULL;
    for (int pass = GLINT_PASS_BACKGROUND; pass <= GLINT_PASS_TRANSMISSION; pass++)
        all = all && image->plane[pass][0];
    return all;
}

static void tone_row(const exposure *e, size_t row, uint64_t counts[2])
{
    const size_t at = row + (size_t)e->extent.x, width = (size_t)e->image->width;
    const float *const rgb[3] = { e->beauty[0] + at, e->beauty[1] + at, e->beauty[2] + at };
    const int first[2] = { (int)(at % width), (int)(at / width) };
    glint_tone_row(e->table, glint_tone_gain(&e->plan->desc.tone), rgb, e->plan->desc.alpha ? e->alpha + at : NULL, first,
                   (size_t)e->extent.width, (char *)e->image->codes + at * glint_image_pixel_bytes(e->image), counts);
}

static void finish_row(void *context, size_t index, int worker)
{
    const exposure *e = context;
    const size_t row = row_at(e, index);
    const double times = e->plan->shutter_times;
    (void)worker;
    for (size_t m = 0; m < e->mean_count; m++)
        for (int x = e->extent.x; x < e->extent.x + e->extent.width; x++)
            e->means[m].out[row + (size_t)x] = (float)(e->means[m].sum[row + (size_t)x] / times);
    if (has_all_terms(e->image))
        sum_terms(e, row);
    if (e->image->codes)
        tone_row(e, row, e->counts[index]);
}

/// Copies the passes that belong to the frame's own instant from its picture.
static glint_status take_instant(exposure *e, glint_renderer *renderer, glint_frame_stats *stats, glint_error *error)
{
    glint_image *instant = NULL;
    const size_t bytes = (size_t)e->image->width * (size_t)e->image->height * sizeof(float);
    if (!(e->plan->desc.passes & ~(GLINT_LIGHT_PASSES | DERIVATIVE_PASSES)))
        return GLINT_OK;
    glint_status status = glint_render_instant(renderer, e->plan, &instant, stats, error);
    for (int pass = 0; pass < GLINT_PASS_COUNT && !status; pass++)
        for (int c = 0; c < 3; c++)
            if (!(GLINT_LIGHT_PASSES >> pass & 1) && e->image->plane[pass][c])
                memcpy(e->image->plane[pass][c], instant->plane[pass][c], bytes);
    glint_image_release(instant);
    return status;
}

/// Makes the means of the image's planes, and of the planes for pixel values.
static glint_status make_means(exposure *e, glint_error *error)
{
    const size_t pixels = (size_t)e->image->width * (size_t)e->image->height;
    const uint32_t passes = (e->plan->desc.passes & GLINT_LIGHT_PASSES) | 1u << GLINT_PASS_BEAUTY |
                            (uint32_t)e->plan->desc.alpha << GLINT_PASS_ALPHA | (e->plan->desc.passes & DERIVATIVE_PASSES);
    const int count = GLINT_PLANE_COUNT + (int)e->image->light_count;
    if (!(e->means = glint_alloc((size_t)count, 3 * sizeof *e->means)))
        return glint_fail_nomem(error);
    for (int pass = 0; pass < count; pass++)
        for (int c = 0; c < glint_pass_channels((glint_pass)pass) && (pass >= GLINT_PASS_LIGHT || passes >> pass & 1); c++)
            e->means[e->mean_count++] =
                (mean) { .out = glint_image_planes(e->image, (glint_pass)pass)[c], .pass = pass, .channel = c };
    e->sums = glint_alloc(e->mean_count * pixels, sizeof *e->sums);
    e->counts = glint_alloc((size_t)e->extent.height, sizeof *e->counts);
    e->own = glint_alloc(4 * pixels, sizeof *e->own);
    if (!e->sums || !e->counts || !e->own)
        return glint_fail_nomem(error);
    for (size_t m = 0; m < e->mean_count; m++) {
        mean *to = &e->means[m];
        const bool alpha = to->pass == GLINT_PASS_ALPHA;
        to->sum = e->sums + m * pixels;
        if (!to->out)
            to->out = e->own + (size_t)(alpha ? 3 : to->channel) * pixels;
        if (alpha)
            e->alpha = to->out;
        if (to->pass == GLINT_PASS_BEAUTY)
            e->beauty[to->channel] = to->out;
    }
    return e->plan->desc.codes ? glint_tone_table_shared(&e->plan->desc.tone, &e->table, error) : GLINT_OK;
}

static glint_status render_all(exposure *e, glint_renderer *renderer, glint_frame_stats *stats, glint_error *error)
{
    const size_t rows = (size_t)e->extent.height;
    glint_pool *pool = glint_renderer_pool(renderer);
    glint_frame_stats one = { 0 };
    uint64_t shifted = 0;
    glint_status status = take_instant(e, renderer, stats, error);
    for (uint32_t k = 0; k < e->plan->shutter_times && !status; k++) {
        glint_image *part = NULL;
        status = glint_render_instant(renderer, e->plan->times[k], &part, &one, error);
        if (status)
            break;
        e->part = part;
        glint_pool_run(pool, rows, add_row, e);
        glint_image_release(part);
        if (k == 0 && stats->stage_count == 0)
            *stats = one;
        else
            glint_frame_stats_add(stats, &one, 1 / (k + 1.0));
        shifted = one.shifted > shifted ? one.shifted : shifted;
    }
    if (status)
        return status;
    glint_pool_run(pool, rows, finish_row, e);
    stats->clipped = stats->nonfinite = 0;
    stats->shifted = shifted;
    for (size_t row = 0; row < rows; row++) {
        stats->clipped += e->counts[row][0];
        stats->nonfinite += e->counts[row][1];
    }
    return GLINT_OK;
}

static glint_status render(glint_renderer *renderer, const glint_plan *plan, glint_image **out,
                           glint_frame_stats *stats, glint_error *error)
{
    exposure e = { .plan = plan, .extent = glint_plan_extent(&plan->desc) };
    glint_frame_stats counted = { 0 };
    glint_status status = glint_image_create_for(&plan->desc, &e.image, error);
    for (size_t i = 0; !status && plan->derivatives && i < plan->derivatives->count; i++)
        memcpy(e.image->derivative[i], plan->derivatives->of[i].name, sizeof e.image->derivative[i]);
    if (!status)
        status = make_means(&e, error);
    if (!status)
        status = render_all(&e, renderer, &counted, error);
    free(e.means);
    free(e.sums);
    free(e.own);
    free(e.counts);
    if (status) {
        glint_image_release(e.image);
        return status;
    }
    if (stats)
        *stats = counted;
    *out = e.image;
    return GLINT_OK;
}

static bool called(const glint_plan *plan) { return plan->times; }

/// Renders whole frames in place of the core.
const glint_stage glint_stage_shutter = {
    .prepare = glint_shutter_prepare,
    .release = glint_shutter_release,
    .called = called,
    .render = render,
};
