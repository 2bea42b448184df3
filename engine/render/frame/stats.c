/// Statistics of a frame: from the counts of its tiles, and merged from several parts.
#include "engine/render/frame/render.h"
#include "engine/render/frame/renderer.h"

#include <string.h>
#include <time.h>

double glint_frame_now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

// ---- Tiles ----

static void add_counts(glint_tile_counts *to, const glint_tile_counts *more)
{
    for (int k = 0; k < GLINT_STAGE_COUNT; k++) {
        to->ns[k] += more->ns[k];
        to->runs[k] += more->runs[k];
        to->reuses[k] += more->reuses[k];
    }
    to->tile_ns += more->tile_ns;
    to->primary += more->primary;
    to->shadow += more->shadow;
    to->mirror += more->mirror;
    to->refraction += more->refraction;
    to->indirect += more->indirect;
    to->clipped += more->clipped;
    to->nonfinite += more->nonfinite;
    glint_work_add(&to->work, &more->work);
    glint_odd_patterns_add(&to->odd, &more->odd);
}

static void name_odd(const glint_odd_pattern *odd, const glint_plan *plan, glint_odd *out)
{
    if (!odd->count)
        return;
    out->count = odd->count;
    out->field = glint_field_name(odd->field);
    if (odd->field != GLINT_FIELD_BACKGROUND)
        memcpy(out->material, plan->patterns->of[odd->material].desc.name, sizeof out->material);
    memcpy(out->point, odd->point, sizeof out->point);
}

static void list_stages(const glint_tile_counts *sum, const glint_plan *plan, bool timed, glint_frame_stats *out)
{
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        if (!plan->runs[id] || !glint_stage_table[id]->name)
            continue;
        const uint64_t calls = sum->runs[id] + sum->reuses[id];
        const int i = out->stage_count++;
        out->stage_name[i] = glint_stage_table[id]->name;
        out->stage_ms[i] = timed ? (double)sum->ns[id] * 1e-6 : 0;
        out->stage_reused[i] = calls ? (double)sum->reuses[id] / (double)calls : sum->reuses[GLINT_STAGE_CAST] > 0;
    }
}

void glint_renderer_collect(const glint_renderer *renderer, const glint_plan *plan, const glint_extent *extent, double wall_ms,
                            glint_frame_stats *out)
{
    glint_tile_counts sum = { 0 };
    const int threads = glint_pool_threads(renderer->pool);
    for (int i = 0; i < threads; i++)
        add_counts(&sum, &renderer->tiles[i]->counts);
    sum.ns[GLINT_STAGE_CAST] += (uint64_t)(renderer->cast_ms * 1e6) * (uint64_t)threads;
    const double toned = sum.tile_ns ? (double)sum.ns[GLINT_STAGE_TONE] / (double)sum.tile_ns : 0;
    *out = (glint_frame_stats) { .render_ms = wall_ms * (1 - toned),
                                 .tone_ms = wall_ms * toned,
                                 .rays = { .primary = sum.primary,
                                           .shadow = sum.shadow,
                                           .mirror = sum.mirror,
                                           .refraction = sum.refraction,
                                           .indirect = sum.indirect },
                                 .work = sum.work,
                                 .pixels = (uint64_t)extent->width * (uint64_t)extent->height,
                                 .clipped = sum.clipped,
                                 .nonfinite = sum.nonfinite };
    for (int kind = 0; kind < GLINT_ODD_COUNT; kind++)
        name_odd(&sum.odd.of[kind], plan, &out->odd[kind]);
    list_stages(&sum, plan, renderer->time_stages, out);
}

static inline bool is_shifted(uint32_t own, uint32_t before, uint32_t after, uint32_t up, uint32_t down)
{
    return (own == 0) | (((own ^ before) | (own ^ after) | (own ^ up) | (own ^ down)) != 0);
}

/// Counts the pixels of a row where the set of occluded lights differs from a neighbour's, or between samples. `up`
/// and `down`: the neighbouring rows; at an edge the row itself.
static uint64_t count_row(const uint32_t *at, const uint32_t *up, const uint32_t *down, int width)
{
    const int last = width - 1;
    uint32_t count = is_shifted(at[0], at[0], at[last > 0], up[0], down[0]);
    for (int x = 1; x < last; x++)
        count += is_shifted(at[x], at[x - 1], at[x + 1], up[x], down[x]);
    if (last > 0)
        count += is_shifted(at[last], at[last - 1], at[last], up[last], down[last]);
    return count;
}

uint64_t glint_count_shifted(const glint_image *image, const glint_extent *extent)
{
    uint64_t count = 0;
    const int end = extent->y + extent->height;
    for (int y = extent->y; y < end; y++) {
        const uint32_t *row = image->shadows + (size_t)y * (size_t)image->width + (size_t)extent->x;
        const uint32_t *up = y > extent->y ? row - image->width : row, *down = y + 1 < end ? row + image->width : row;
        count += count_row(row, up, down, extent->width);
    }
    return count;
}

// ---- Several parts ----

static void add_odd(glint_odd *to, const glint_odd *more)
{
    const uint64_t count = to->count + more->count;
    if (!to->count)
        *to = *more;
    to->count = count;
}

void glint_frame_stats_add(glint_frame_stats *to, const glint_frame_stats *more, double share)
{
    to->build_ms += more->build_ms;
    to->render_ms += more->render_ms + more->tone_ms;
    to->rays.primary += more->rays.primary;
    to->rays.shadow += more->rays.shadow;
    to->rays.mirror += more->rays.mirror;
    to->rays.refraction += more->rays.refraction;
    to->rays.indirect += more->rays.indirect;
    glint_work_add(&to->work, &more->work);
    for (int kind = 0; kind < GLINT_ODD_COUNT; kind++)
        add_odd(&to->odd[kind], &more->odd[kind]);
    for (int i = 0; i < to->stage_count; i++)
        for (int k = 0; k < more->stage_count; k++) {
            if (to->stage_name[i] != more->stage_name[k] || to->stage_name[i] == glint_stage_table[GLINT_STAGE_TONE]->name)
                continue;
            to->stage_ms[i] += more->stage_ms[k];
            to->stage_reused[i] += share * (more->stage_reused[k] - to->stage_reused[i]);
        }
}
