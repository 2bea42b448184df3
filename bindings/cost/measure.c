// One setting in the engine: its plan, its picture and its time.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bindings/cost/cost.h"

bool cost_fail(cost_study *study, const glint_error *error)
{
    if (error->status != GLINT_ERR_CANCELLED)
        glintL_run_fail(study->run, glintL_run_exit_code(error->status), 0, "%s", error->message);
    return false;
}

bool cost_is_stopped(const cost_study *study) { return study->run->interrupted || study->run->exit_code; }

// ---- Renderers ----

// Makes this the run's renderer, which a signal cancels.
static void use_renderer(cost_study *study, glint_renderer *renderer)
{
    study->run->renderer = renderer;
    if (study->run->interrupted)
        glint_renderer_cancel(renderer);
    if (study->output->progress)
        cli_progress_watch(study->output->progress, renderer);
}

bool cost_open_renderers(cost_study *study)
{
    glintL_run *run = study->run;
    glint_error error;
    for (int keeps = run->retained_neighbour ? 1 : 0; keeps >= 0; keeps--)
        for (int counts = 1; counts >= 0; counts--) {
            run->renderer = NULL;
            run->request.no_reuse = !keeps;
            run->counts_work = counts;
            if (!glintL_run_open(run, &error))
                return cost_fail(study, &error);
            study->renderers[keeps][counts] = run->renderer;
        }
    return true;
}

// ---- Plans ----

static glint_status apply_knobs(cost_study *study, const cost_case *c, cost_draft *draft, glint_error *error)
{
    glint_status status = GLINT_OK;
    for (int i = 0; i < cost_knob_count && !status; i++)
        if (c->choice[i] >= 0)
            status = cost_knob_apply(&cost_knobs[i], draft, study->values[i].value[c->choice[i]], error);
    return status;
}

static glint_status out_of_memory(glint_error *error)
{
    *error = (glint_error) { GLINT_ERR_NOMEM, "out of memory" };
    return GLINT_ERR_NOMEM;
}

// Applies the render options of a case. A shot may replace passes, samples and seed.
static glint_status apply_case(cost_study *study, const cost_case *c, const cost_shot *how, cost_draft *draft, glint_error *error)
{
    glint_render_desc *desc = &draft->render.desc;
    glint_status status = apply_knobs(study, c, draft, error);
    desc->passes = how->passes;
    desc->codes = how->codes;
    desc->samples = how->samples > 0 ? how->samples : desc->samples;
    desc->seed = how->seed >= 0 ? how->seed : desc->seed;
    desc->adaptive = how->is_exact ? 0 : desc->adaptive;
    desc->precision = how->is_exact ? GLINT_DOUBLE : desc->precision;
    return status;
}

// Plans the scene at one time of an open shutter, with the case's settings applied.
static glint_status plan_time(cost_study *study, const cost_case *c, const cost_shot *how, int times, int k, glint_plan **out,
                              glint_error *error)
{
    cost_scene scene;
    cost_draft *draft = malloc(sizeof *draft);
    glint_status status = cost_moments_enter(study->moments, study->scene.original, times, k, error);
    bool good = draft && !status && cost_scene_open(&scene, study->scene.original);
    if (!status && !good)
        status = out_of_memory(error);
    if (good) {
        *draft = (cost_draft) { .scene = &scene, .render = *study->own };
        status = apply_case(study, c, how, draft, error);
        const glint_render_desc desc = glint_shutter_desc(&draft->render.desc);
        if (!status)
            status = glint_plan_create(scene.scene, &desc, out, error);
        cost_scene_restore(&scene);
        cost_scene_close(&scene);
    }
    free(draft);
    return status;
}

// Plans all times. Afterwards the scene is at the frame's own instant. On success the caller owns the list.
static glint_status plan_times(cost_study *study, const cost_case *c, const cost_shot *how, int count, glint_plan ***out,
                               glint_error *error)
{
    glint_plan **times = calloc((size_t)count, sizeof *times);
    glint_status status = times ? GLINT_OK : out_of_memory(error);
    for (int k = 0; k < count && !status; k++)
        status = plan_time(study, c, how, count, k, &times[k], error);
    glint_error ignored;
    const glint_status back = cost_moments_enter(study->moments, study->scene.original, 0, 0, status ? &ignored : error);
    status = status ? status : back;
    for (int k = 0; times && status && k < count; k++)
        glint_plan_destroy(times[k]);
    if (status)
        free(times);
    else
        *out = times;
    return status;
}

// Plans a case. Afterwards the scene is restored. `draft` receives how to render and write the case.
static glint_status plan_case(cost_study *study, const cost_case *c, const cost_shot *how, cost_draft *draft,
                              glint_plan **out, glint_error *error)
{
    const cost_draft own = { .scene = &study->scene, .render = *study->own, .shutter_times = study->shutter_times };
    glint_plan **times = NULL;
    *draft = own;
    glint_status status = apply_case(study, c, how, draft, error);
    const int count = how->is_painted ? 0 : draft->shutter_times; // decisions are of the frame's own instant
    if (!status && count > 0) {
        cost_scene_restore(&study->scene);
        status = plan_times(study, c, how, count, &times, error);
        *draft = own;
        status = status ? status : apply_case(study, c, how, draft, error);
    }
    if (!status && how->is_painted)
        status = cost_scene_show_light(&study->scene, how->light, error);
    if (!status && times)
        status = glint_plan_create_exposed(study->scene.scene, &draft->render.desc, times, (size_t)count, out, error);
    else if (!status)
        status = glint_plan_create(study->scene.scene, &draft->render.desc, out, error);
    cost_scene_restore(&study->scene);
    return status;
}

bool cost_expect(cost_study *study, const cost_case *c, double *rays)
{
    const cost_shot how = { .passes = 1u << GLINT_PASS_BEAUTY, .seed = -1 };
    glint_plan *plan = NULL;
    glint_error error;
    cost_draft *draft = malloc(sizeof *draft);
    if (!draft)
        return glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    bool good = !plan_case(study, c, &how, draft, &plan, &error) || cost_fail(study, &error);
    if (good) {
        glint_ray_counts counts = glint_plan_expected_rays(plan);
        *rays = (double)counts.primary + (double)counts.shadow + (double)counts.mirror + (double)counts.refraction +
                (double)counts.indirect;
    }
    glint_plan_destroy(plan);
    free(draft);
    return good;
}

// ---- One run ----

double cost_cpu_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static glint_status encode_values(const glint_image *image, glint_error *error)
{
    const glint_write_desc desc = { .path = "frame.pfm" };
    uint8_t *data = NULL;
    size_t size;
    glint_status status = glint_image_to_bytes(image, &desc, &data, &size, error);
    free(data);
    return status;
}

// Encodes like the writer of a job, with its threads and its cache of the previous picture, but writes no file.
static glint_status encode(cost_study *study, const glintL_render *render, glint_image *image, double *ms,
                           glint_error *error)
{
    glint_write_desc desc = { .path = "/dev/null", .tone = render->desc.tone, .encode = render->encode };
    glint_write_result result;
    const double start = glintL_now_ms();
    glint_status status;
    if (!render->desc.codes) {
        status = encode_values(image, error);
        *ms = glintL_now_ms() - start;
        return status;
    }
    status = glint_writer_submit(study->run->writer, image, &desc, NULL, error);
    if (status || !glint_writer_collect(study->run->writer, true, &result))
        return status;
    *ms = result.encode_ms;
    if (result.status) {
        error->status = result.status;
        snprintf(error->message, sizeof error->message, "%s", result.message);
    }
    return result.status;
}

// Renders the neighbouring frame first, if the case is measured after it.
static glint_status prepare(cost_study *study, const cost_draft *draft, bool counts, glint_error *error)
{
    glint_image *before = NULL;
    double ms;
    use_renderer(study, study->renderers[draft->reuses][counts]);
    if (!draft->reuses)
        return GLINT_OK;
    glint_status status = glint_render(study->run->renderer, study->run->retained_neighbour, &before, NULL, error);
    if (!status && draft->render.desc.codes)
        status = encode(study, &draft->render, before, &ms, error);
    glint_image_release(before);
    return status;
}

// Renders and encodes a frame; adds its times to `sum`.
static glint_status time_frame(cost_study *study, cost_case *c, const glint_plan *plan, const cost_draft *draft,
                               double sum[COST_PART_COUNT], glint_error *error)
{
    glint_image *image = NULL;
    double encode_ms = 0;
    glint_status status = prepare(study, draft, false, error);
    const double cpu = cost_cpu_ms();
    if (!status)
        status = glint_render(study->run->renderer, plan, &image, &c->stats, error);
    if (!status)
        status = encode(study, &draft->render, image, &encode_ms, error);
    glint_image_release(image);
    if (status)
        return status;
    sum[COST_RENDER] += c->stats.render_ms;
    sum[COST_TONE] += c->stats.tone_ms;
    sum[COST_ENCODE] += encode_ms;
    sum[COST_TOTAL] += c->stats.render_ms + c->stats.tone_ms + encode_ms;
    sum[COST_CPU] += cost_cpu_ms() - cpu;
    return GLINT_OK;
}

static glint_status time_run(cost_study *study, cost_case *c, const glint_plan *plan, const cost_draft *draft,
                             glint_error *error)
{
    double sum[COST_PART_COUNT] = { 0 };
    const int frames = c->batch > 0 ? c->batch : 1;
    for (int i = 0; i < frames; i++) {
        glint_status status = time_frame(study, c, plan, draft, sum, error);
        if (status)
            return status;
    }
    for (int part = 0; part < COST_PART_COUNT; part++)
        c->ms[part][c->run_count] = sum[part] / frames;
    c->run_count++;
    return GLINT_OK;
}

// Returns how a case is rendered for timing.
cost_shot cost_own_shot(const cost_study *study)
{
    const bool codes = !glintL_name_is_linear(study->own->output);
    return (cost_shot) { .passes = codes ? 0 : 1u << GLINT_PASS_BEAUTY, .codes = codes, .seed = -1 };
}

bool cost_run(cost_study *study, cost_case *c)
{
    const cost_shot how = cost_own_shot(study);
    glint_plan *plan = NULL;
    glint_error error;
    double start = glintL_now_ms();
    cost_draft *draft = malloc(sizeof *draft);
    if (!draft)
        return glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    if (c->is_first_alone) { // the first run warms everything up
        c->run_count = 0;
        c->is_first_alone = false;
    }
    glint_status status = plan_case(study, c, &how, draft, &plan, &error);
    c->bits = draft->render.desc.tone.bits;
    if (!status)
        status = time_run(study, c, plan, draft, &error);
    glint_plan_destroy(plan);
    free(draft);
    c->estimate_ms = glintL_now_ms() - start;
    return status ? cost_fail(study, &error) : true;
}

glint_status cost_take(cost_study *study, const cost_case *c, const cost_shot *how, glint_image **out,
                       glint_frame_stats *stats, glint_error *error)
{
    glint_plan *plan = NULL;
    cost_draft *draft = malloc(sizeof *draft);
    if (!draft)
        return out_of_memory(error);
    glint_status status = plan_case(study, c, how, draft, &plan, error);
    // A renderer caches from the second frame on, so the work of the third frame is counted.
    for (int frames = stats && draft->reuses ? 2 : 1; frames > 0 && !status; frames--) {
        glint_image_release(*out);
        *out = NULL;
        status = prepare(study, draft, stats != NULL, error);
        if (!status)
            status = glint_render(study->run->renderer, plan, out, stats, error);
    }
    glint_plan_destroy(plan);
    free(draft);
    return status;
}
