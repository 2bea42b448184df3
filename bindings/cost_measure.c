// One setting: its picture in time, its errors against the reference, its decisions pixel by pixel.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bindings/cost.h"

#define LIGHTS_MAX 8 // looked at one by one
#define LIT 0x1p-10 // less than a quarter of a code: a surface that a light grazes counts as dark
#define TIMES 64 // samples of a half of the reference for each of the script's
#define LEAST_TIMES 4 // where a budget forces fewer; below it no error would be worth showing

// How a case is to be planned, where that is not its own way.
typedef struct shot {
    uint32_t passes;
    bool codes;
    double samples; // 0: the case's
    double seed; // < 0: the case's
    bool is_exact; // decided in double
    bool is_painted; // matt white under light number `light`
    size_t light;
} shot;

static bool fail(cost_study *study, const glint_error *error)
{
    if (error->status != GLINT_ERR_CANCELLED)
        glintL_run_fail(study->run, glintL_run_exit_code(error->status), 0, "%s", error->message);
    return false;
}

bool cost_is_stopped(const cost_study *study) { return study->run->interrupted || study->run->exit_code; }

// ---- Renderers ----

// The run's renderer is the one a signal cancels.
static void use_renderer(cost_study *study, glint_renderer *renderer)
{
    study->run->renderer = renderer;
    if (study->run->interrupted)
        glint_renderer_cancel(renderer);
}

bool cost_open_renderers(cost_study *study)
{
    glintL_run *run = study->run;
    glint_error error;
    for (int keeps = run->kept_neighbour ? 1 : 0; keeps >= 0; keeps--)
        for (int counts = 1; counts >= 0; counts--) {
            run->renderer = NULL;
            run->asked.no_reuse = !keeps;
            run->counts_work = counts;
            if (!glintL_run_open(run, &error))
                return fail(study, &error);
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
            status = cost_knobs[i].apply(draft, study->values[i].value[c->choice[i]], error);
    return status;
}

// The scene is as the script left it afterwards. `draft` says how the case is rendered and written.
static glint_status plan_case(cost_study *study, const cost_case *c, const shot *how, cost_draft *draft,
                              glint_plan **out, glint_error *error)
{
    *draft = (cost_draft) { .scene = &study->scene, .render = *study->own };
    glint_render_desc *desc = &draft->render.desc;
    glint_status status = apply_knobs(study, c, draft, error);
    desc->passes = how->passes;
    desc->codes = how->codes;
    desc->samples = how->samples > 0 ? how->samples : desc->samples;
    desc->seed = how->seed >= 0 ? how->seed : desc->seed;
    desc->precision = how->is_exact ? GLINT_DOUBLE : desc->precision;
    if (!status && how->is_painted)
        status = cost_scene_show_light(&study->scene, how->light, error);
    if (!status)
        status = glint_plan_create(study->scene.scene, desc, out, error);
    cost_scene_restore(&study->scene);
    return status;
}

bool cost_expect(cost_study *study, const cost_case *c, double *rays)
{
    const shot how = { .passes = 1u << GLINT_PASS_BEAUTY, .seed = -1 };
    glint_plan *plan = NULL;
    glint_error error;
    cost_draft *draft = malloc(sizeof *draft);
    if (!draft)
        return glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    bool good = !plan_case(study, c, &how, draft, &plan, &error) || fail(study, &error);
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

static double cpu_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static glint_status encode(const cost_draft *draft, const glint_image *image, uint8_t **data, size_t *size,
                           glint_error *error)
{
    glint_write_desc desc = { .path = draft->render.desc.codes ? "frame.png" : "frame.pfm",
                              .tone = draft->render.desc.tone,
                              .encode = draft->render.encode };
    return glint_image_to_bytes(image, &desc, data, size, error);
}

// Renders a plan, after the neighbouring frame where the case is measured so.
static glint_status render(cost_study *study, const cost_draft *draft, bool counts, const glint_plan *plan,
                           glint_image **out, glint_frame_stats *stats, glint_error *error)
{
    glint_image *before = NULL;
    glint_status status = GLINT_OK;
    use_renderer(study, study->renderers[draft->reuses][counts]);
    if (draft->reuses)
        status = glint_render(study->run->renderer, study->run->kept_neighbour, &before, NULL, error);
    glint_image_release(before);
    return status ? status : glint_render(study->run->renderer, plan, out, stats, error);
}

static void note_run(cost_case *c, double encode_ms, double cpu)
{
    const double times[COST_PART_COUNT] = { c->stats.render_ms, c->stats.tone_ms, encode_ms,
                                            c->stats.render_ms + c->stats.tone_ms + encode_ms, cpu };
    for (int part = 0; part < COST_PART_COUNT; part++)
        c->ms[part][c->run_count] = times[part];
    c->run_count++;
}

static glint_status time_plan(cost_study *study, cost_case *c, const glint_plan *plan, const cost_draft *draft,
                              glint_error *error)
{
    uint8_t *bytes = NULL;
    size_t size;
    glint_image *image = NULL;
    double cpu = cpu_ms();
    glint_status status = render(study, draft, false, plan, &image, &c->stats, error);
    double start = glintL_now_ms();
    if (!status)
        status = encode(draft, image, &bytes, &size, error);
    if (!status)
        note_run(c, glintL_now_ms() - start, cpu_ms() - cpu);
    free(bytes);
    glint_image_release(image);
    return status;
}

// How a case is rendered when it is timed.
static shot own_shot(const cost_study *study)
{
    const bool codes = !glintL_name_is_pfm(study->own->output);
    return (shot) { .passes = codes ? 0 : 1u << GLINT_PASS_BEAUTY, .codes = codes, .seed = -1 };
}

bool cost_run(cost_study *study, cost_case *c)
{
    const shot how = own_shot(study);
    glint_plan *plan = NULL;
    glint_error error;
    double start = glintL_now_ms();
    cost_draft *draft = malloc(sizeof *draft);
    if (!draft)
        return glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    if (c->is_first_alone) { // which had everything to warm up
        c->run_count = 0;
        c->is_first_alone = false;
    }
    glint_status status = plan_case(study, c, &how, draft, &plan, &error);
    c->bits = draft->render.desc.tone.bits;
    if (!status)
        status = time_plan(study, c, plan, draft, &error);
    glint_plan_destroy(plan);
    free(draft);
    c->estimate_ms = glintL_now_ms() - start;
    return status ? fail(study, &error) : true;
}

// A picture for the study itself, not timed. `work`: NULL, or what it took.
static glint_status take(cost_study *study, const cost_case *c, const shot *how, glint_image **out, glint_work *work,
                         glint_error *error)
{
    glint_frame_stats stats;
    glint_plan *plan = NULL;
    cost_draft *draft = malloc(sizeof *draft);
    if (!draft) {
        *error = (glint_error) { GLINT_ERR_NOMEM, "out of memory" };
        return GLINT_ERR_NOMEM;
    }
    glint_status status = plan_case(study, c, how, draft, &plan, error);
    if (!status)
        status = render(study, draft, work != NULL, plan, out, &stats, error);
    if (!status && work)
        *work = stats.work;
    glint_plan_destroy(plan);
    free(draft);
    return status;
}

// ---- Decisions ----

static void read_plane(const glint_image *image, glint_pass pass, float *objects, uint8_t *lit)
{
    float v[3] = { 0 };
    size_t at = 0;
    for (int y = 0; y < glint_image_height(image); y++)
        for (int x = 0; x < glint_image_width(image); x++, at++) {
            glint_image_pixel(image, pass, x, y, v, NULL);
            if (objects)
                objects[at] = v[0];
            else
                lit[at] = v[0] > LIT || v[1] > LIT || v[2] > LIT;
        }
}

static void free_decisions(cost_decisions *decisions)
{
    free(decisions->object);
    free(decisions->lit);
    memset(decisions, 0, sizeof *decisions);
}

static glint_status decide(cost_study *study, const cost_case *c, bool is_exact, cost_decisions *out,
                           glint_error *error)
{
    const size_t lights = study->scene.light_count, pixels = (size_t)(study->own->desc.width * study->own->desc.height);
    glint_status status = GLINT_OK;
    *out = (cost_decisions) { .light_count = lights >= 1 && lights <= LIGHTS_MAX ? lights : 1 };
    out->object = malloc(pixels * sizeof *out->object);
    out->lit = malloc(pixels * out->light_count);
    if (!out->object || !out->lit) {
        *error = (glint_error) { GLINT_ERR_NOMEM, "out of memory" };
        status = GLINT_ERR_NOMEM;
    }
    for (size_t i = 0; i < out->light_count && !status; i++) {
        const shot how = { .passes = 1u << GLINT_PASS_OBJECT_ID | 1u << GLINT_PASS_DIFFUSE,
                           .samples = 1,
                           .seed = -1,
                           .is_exact = is_exact,
                           .is_painted = true,
                           .light = out->light_count == lights ? i : lights };
        glint_image *image = NULL;
        status = take(study, c, &how, &image, NULL, error);
        if (status)
            break;
        if (i == 0)
            read_plane(image, GLINT_PASS_OBJECT_ID, out->object, NULL);
        read_plane(image, GLINT_PASS_DIFFUSE, NULL, out->lit + i * pixels);
        glint_image_release(image);
    }
    if (status)
        free_decisions(out);
    return status;
}

static glint_status count_decisions(cost_study *study, cost_case *c, glint_error *error)
{
    const size_t pixels = (size_t)(study->own->desc.width * study->own->desc.height);
    const cost_decisions *truth = &study->truth;
    cost_decisions mine;
    glint_status status = decide(study, c, false, &mine, error);
    if (status)
        return status;
    c->wrong_object = c->wrong_shadow = 0;
    for (size_t i = 0; i < pixels; i++) {
        bool shadow = false;
        for (size_t k = 0; k < truth->light_count; k++)
            shadow = shadow || mine.lit[k * pixels + i] != truth->lit[k * pixels + i];
        if (mine.object[i] != truth->object[i])
            c->wrong_object++;
        else
            c->wrong_shadow += shadow;
    }
    free_decisions(&mine);
    return GLINT_OK;
}

// ---- The reference ----

// Samples of each half: 64 times the script's, and as near to 64 times the most that is shown as the allowance goes. A
// budget may force fewer; 0: none at all.
static double choose_samples(const cost_study *study, double allowance_ms)
{
    const int knob = cost_knob_find("samples", strlen("samples"));
    const double own = study->own->desc.samples, each = 2 * study->cases[0].stats.render_ms / own;
    double most = own, samples = TIMES * own;
    for (int i = 0; i < study->values[knob].count; i++)
        most = fmax(most, study->values[knob].value[i].number);
    while (study->deadline_ms > 0 && samples >= LEAST_TIMES * own && each * samples > allowance_ms)
        samples /= 4;
    while (samples < TIMES * most && each * samples * 2 <= allowance_ms)
        samples *= 2;
    return samples < LEAST_TIMES * own ? 0 : fmin(samples, 65536);
}

static glint_status render_halves(cost_study *study, glint_image *halves[2], glint_error *error)
{
    const double half_ms = study->cases[0].stats.render_ms / study->own->desc.samples * study->reference_samples;
    glint_status status = GLINT_OK;
    for (int i = 0; i < 2 && !status; i++) {
        const shot how = { .passes = 1u << GLINT_PASS_BEAUTY,
                           .samples = study->reference_samples,
                           .seed = study->reference_seed[i],
                           .is_exact = true };
        use_renderer(study, study->renderers[false][false]);
        cost_show(study, "reference", half_ms, (1 - i) * half_ms + cost_round_ms(study) * (study->runs + 2));
        status = take(study, &study->cases[0], &how, &halves[i], NULL, error);
    }
    return status;
}

// How far the halves are from each other says how far their mean is from the truth: half as far.
static glint_status measure_halves(cost_study *study, glint_image *const halves[2], glint_error *error)
{
    const glint_tone_desc *tone = &study->own->desc.tone;
    const glint_image *const list[2] = { halves[0], halves[1] };
    glint_reference *first = NULL;
    glint_status status = glint_reference_create(list, 1, tone, &first, error);
    if (!status)
        status = glint_reference_measure(first, halves[1], 0, &study->reference_error, error);
    glint_reference_destroy(first);
    study->reference_error.rmse /= 2;
    study->reference_error.relmse /= 4;
    return status ? status : glint_reference_create(list, 2, tone, &study->reference, error);
}

bool cost_make_reference(cost_study *study, double allowance_ms)
{
    const double own = study->own->desc.samples, seed = study->own->desc.seed;
    glint_image *halves[2] = { NULL, NULL };
    glint_error error;
    study->reference_samples = choose_samples(study, allowance_ms);
    if (study->reference_samples == 0)
        return cost_leave_out(study, "every error: the budget leaves no time for a reference");
    if (study->reference_samples < TIMES * own)
        cost_leave_out(study, "a full reference: %.0f samples instead of %.0f", study->reference_samples, TIMES * own);
    for (int i = 0; i < 2; i++)
        study->reference_seed[i] = seed + 1 + i <= 0x1p53 ? seed + 1 + i : 1 + i;
    glint_status status = render_halves(study, halves, &error);
    if (!status)
        status = measure_halves(study, halves, &error);
    if (!status)
        status = decide(study, &study->cases[0], true, &study->truth, &error);
    glint_image_release(halves[0]);
    glint_image_release(halves[1]);
    return status ? fail(study, &error) : true;
}

// ---- A case ----

static glint_status keep_pictures(cost_study *study, cost_case *c, const glint_image *image, glint_error *error)
{
    glint_image *difference = NULL;
    glint_write_desc desc = { .path = "picture.png", .tone = study->own->desc.tone, .encode = GLINT_ENCODE_SMALL };
    desc.tone.bits = 8;
    glint_status status = glint_image_to_bytes(image, &desc, &c->picture, &c->picture_size, error);
    if (!status)
        status = glint_reference_difference(study->reference, image, 16, &difference, error);
    if (!status)
        status = glint_image_to_bytes(difference, &desc, &c->difference, &c->difference_size, error);
    glint_image_release(difference);
    return status;
}

// Against the reference.
static glint_status find_errors(cost_study *study, cost_case *c, const glint_image *image, glint_error *error)
{
    glint_status status = glint_reference_measure(study->reference, image, 0, &c->film, error);
    if (!status && c->needs_file)
        status = glint_reference_measure(study->reference, image, c->bits, &c->file, error);
    if (!status)
        status = count_decisions(study, c, error);
    if (!status && study->options->report)
        status = keep_pictures(study, c, image, error);
    c->has_error = !status;
    return status;
}

bool cost_measure(cost_study *study, cost_case *c)
{
    shot how = own_shot(study);
    glint_image *image = NULL;
    glint_error error;
    c->is_first_alone = false;
    c->run_count = 0;
    if (!cost_run(study, c))
        return false;
    c->is_first_alone = true;
    how.passes |= 1u << GLINT_PASS_BEAUTY;
    glint_status status = take(study, c, &how, &image, &c->work, &error);
    c->is_counted = !status;
    if (!status && study->reference)
        status = find_errors(study, c, image, &error);
    glint_image_release(image);
    return status ? fail(study, &error) : true;
}
