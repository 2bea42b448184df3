/// A frame with an open shutter: the mean of its light at several times.
///
/// Light adds up. If only lights differ between the times, the frame is one plan, which contains a changing light
/// once for each time, with a share of its strength. No other work is repeated. If surfaces, materials or the camera
/// differ, each time is rendered, and effects/shutter/shutter.c takes the mean, also of derivatives.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/light_groups/plan.h"
#include "engine/render/effects/shutter/plan.h"

#include <stdlib.h>
#include <string.h>

#define ROWS_MAX 0x1p27 ///< maximum number of light rows for all times, and of light samples

void glint_shutter_desc(glint_render_desc *desc)
{
    if (!desc)
        return;
    desc->codes = false;
    desc->derivatives = NULL;
    desc->derivative_count = 0;
    desc->outline = GLINT_OUTLINE_NONE;
    desc->passes = (desc->passes & GLINT_LIGHT_PASSES) | 1u << GLINT_PASS_BEAUTY;
}

// ---- Whether only lights differ ----

static bool vec_equal(const double a[3], const double b[3]) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

/// Returns whether the data that only one stage reads is equal, for all stages that have such data.
static bool equal_own_data(const glint_plan *a, const glint_plan *b)
{
    const glint_key none = { 0 };
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        const glint_stage *stage = glint_stage_table[id];
        if (!a->own[id] != !b->own[id] || (a->own[id] && !glint_key_equal(stage->own(a, none), stage->own(b, none))))
            return false;
    }
    return true;
}

/// Returns whether two plans are equal except for lights and for the conversion to pixel values.
static bool differ_in_lights(const glint_plan *a, const glint_plan *b)
{
    static const glint_stage_id read[] = { GLINT_STAGE_SURFACE, GLINT_STAGE_PATTERN, GLINT_STAGE_MICROFACET_VIEW };
    for (size_t i = 0; i < sizeof read / sizeof *read; i++)
        if (!glint_key_equal(a->keys[read[i]], b->keys[read[i]]))
            return false;
    return glint_key_equal(a->all_materials_key, b->all_materials_key) &&
           glint_key_equal(a->background_key, b->background_key) && equal_own_data(a, b) &&
           vec_equal(a->ambient, b->ambient) && glint_light_groups_equal(a, b);
}

/// Returns whether a frame's plan and the plans of its times differ only in their lights, and whether the frame can
/// add up the light of all times.
static bool adds_up(const glint_plan *plan, glint_plan *const *times, size_t count)
{
    bool same = plan->base == NULL && !plan->runs[GLINT_STAGE_SHADER] && !plan->derivatives;
    for (size_t k = 0; k < count && same; k++)
        same = differ_in_lights(plan, times[k]) && times[k]->caps == plan->caps;
    return same;
}

// ---- The lights of all times ----

/// Returns the number of rows of the light that begins at row `first`.
static uint32_t rows_of(const glint_plan *plan, uint32_t first)
{
    uint32_t end = first + 1;
    while (end < plan->light_count && plan->lights[end].joined)
        end++;
    return end - first;
}

/// Returns whether a light is the same at all times.
static bool is_steady(glint_plan *const *times, size_t count, uint32_t first, uint32_t rows)
{
    for (size_t k = 1; k < count; k++)
        for (uint32_t i = first; i < first + rows; i++)
            if (!glint_key_equal(times[k]->lights[i].color_key, times[0]->lights[i].color_key))
                return false;
    return true;
}

/// Returns whether all times have the same lights in the same rows, regardless of positions and strengths.
static bool same_rows(glint_plan *const *times, size_t count)
{
    for (size_t k = 1; k < count; k++) {
        if (times[k]->light_count != times[0]->light_count)
            return false;
        for (uint32_t i = 0; i < times[0]->light_count; i++)
            if (times[k]->lights[i].joined != times[0]->lights[i].joined)
                return false;
    }
    return true;
}

/// Returns the number of light samples of a row.
static size_t samples_of(const glint_plan_light *light)
{
    return light->cap ? 1 : light->light_samples ? light->sample_set_count : 0;
}

/// The lights to be filled in.
typedef struct lights {
    glint_plan_light *rows;
    glint_light_sample *samples;
    uint32_t row_count;
    size_t sample_count;
} lights;

static void add_row(lights *to, const glint_plan_light *from, double share)
{
    glint_plan_light *row = &to->rows[to->row_count++];
    const size_t samples = samples_of(from);
    *row = *from;
    vec_scale(row->diffuse, row->diffuse, share);
    vec_scale(row->specular, row->specular, share);
    if (samples == 0)
        return;
    glint_light_sample *own = to->samples + to->sample_count;
    memcpy(own, from->cap ? from->cap : from->light_samples, samples * sizeof *own);
    row->cap = from->cap ? own : NULL;
    row->light_samples = from->cap ? NULL : own;
    to->sample_count += samples;
}

/// Adds the lights of all times one after the other, and steady lights once.
static void add_all(lights *to, glint_plan *const *times, size_t count)
{
    const bool comparable = same_rows(times, count);
    for (size_t k = 0; k < count; k++) {
        const glint_plan *time = times[k];
        for (uint32_t first = 0, rows; first < time->light_count; first += rows) {
            rows = rows_of(time, first);
            const bool steady = comparable && is_steady(times, count, first, rows);
            for (uint32_t i = 0; i < rows && (k == 0 || !steady); i++)
                add_row(to, &time->lights[first + i], steady ? 1 : 1 / (double)count);
        }
    }
}

static glint_status ensure_capacity(lights *to, glint_plan *const *times, size_t count, glint_error *error)
{
    double rows = 0, samples = 0;
    for (size_t k = 0; k < count; k++) {
        rows += times[k]->light_count;
        for (uint32_t i = 0; i < times[k]->light_count; i++)
            samples += (double)samples_of(&times[k]->lights[i]);
    }
    if (rows > ROWS_MAX || samples > ROWS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "shutter_times: at most %.0f samples of lights in all times expected, got %.0f", ROWS_MAX,
                          rows > samples ? rows : samples);
    to->rows = glint_alloc((size_t)rows, sizeof *to->rows);
    to->samples = glint_alloc((size_t)samples, sizeof *to->samples);
    return to->rows && to->samples ? GLINT_OK : glint_fail_nomem(error);
}

glint_status glint_shutter_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    glint_plan *const *times = from->times;
    const size_t count = from->shutter_times;
    lights all = { 0 };
    if (!times)
        return GLINT_OK;
    glint_status status = ensure_capacity(&all, times, count, error);
    if (status) {
        free(all.rows);
        free(all.samples);
        return status;
    }
    add_all(&all, times, count);
    free(plan->lights);
    free(plan->light_samples);
    plan->lights = all.rows;
    plan->light_samples = all.samples;
    plan->light_count = all.row_count;
    plan->powers = plan->facets = false;
    for (size_t k = 0; k < count; k++) {
        plan->powers = plan->powers || times[k]->powers;
        plan->facets = plan->facets || times[k]->facets;
    }
    plan->highlights = plan->powers || plan->facets;
    glint_plan_count_lights(plan);
    return GLINT_OK;
}

// ---- Plans ----

/// Frees the plans and the list.
static void free_times(glint_plan **times, size_t count)
{
    for (size_t k = 0; k < count; k++)
        glint_plan_destroy(times[k]);
    free(times);
}

void glint_shutter_release(glint_plan *plan)
{
    if (plan->times)
        free_times(plan->times, plan->shutter_times);
}

/// Returns whether a time has derivatives that the whole frame lacks.
static bool derives_more(const glint_plan *time, const glint_render_desc *frame)
{
    bool more = false;
    for (size_t i = 0; time->derivatives && i < time->derivatives->count; i++) {
        bool found = false;
        for (size_t k = 0; k < frame->derivative_count; k++)
            found = found || strcmp(time->derivatives->of[i].name, frame->derivatives[k].name) == 0;
        more = more || !found;
    }
    return more;
}

static glint_status check_times(glint_plan *const *times, size_t count, const glint_render_desc *desc,
                                glint_error *error)
{
    glint_render_desc expected = *desc;
    glint_shutter_desc(&expected);
    if (count < 1 || count > GLINT_SHUTTER_TIMES_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "times: 1 .. %d expected, got %zu", GLINT_SHUTTER_TIMES_MAX, count);
    for (size_t k = 0; k < count; k++) {
        const glint_render_desc *d = &times[k]->desc;
        if (d->width != expected.width || d->height != expected.height || d->codes ||
            (d->passes & expected.passes) != expected.passes || memcmp(d->region, expected.region, sizeof d->region))
            return glint_fail(error, GLINT_ERR_INVALID, "times: a plan by glint_shutter_desc of the frame expected");
        if (derives_more(times[k], desc))
            return glint_fail(error, GLINT_ERR_INVALID, "times: expected the derivatives of the frame, and no others");
    }
    return GLINT_OK;
}

glint_status glint_plan_create_exposed(const glint_scene *scene, const glint_render_desc *given, glint_plan **times,
                                       size_t count, glint_plan **out, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_REFUSE_NULL(times, error);
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_render_desc, glint_render_desc_default());
    glint_plan_input from = { .scene = scene, .desc = desc, .shutter_times = (uint32_t)count };
    glint_plan *plan = NULL, *all = NULL;
    status = check_times(times, count, desc, error);
    if (!status)
        status = glint_plan_make(&from, &plan, error);
    from.times = times;
    if (!status && adds_up(plan, times, count))
        status = glint_plan_make(&from, &all, error);
    if (all || status)
        glint_plan_destroy(plan);
    if (status)
        return status;
    if (all)
        free_times(times, count);
    else
        plan->times = times;
    *out = all ? all : plan;
    return GLINT_OK;
}
