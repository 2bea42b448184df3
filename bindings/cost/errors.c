// The distance of a setting from the truth: the reference and its own error, and decisions pixel by pixel.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

#define LIGHTS_MAX 8 // number of lights checked one by one
#define LIT 0x1p-10 // less than a quarter of an 8-bit step: a surface lit at grazing angles counts as dark
#define BATCH_MAX 1000 // frames in a run
#define TIMES 32 // samples of each reference part, relative to the script's
#define LEAST_TIMES 2 // minimum of TIMES if a budget forces fewer samples; with fewer the errors mean nothing

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
        const cost_shot how = { .passes = 1u << GLINT_PASS_OBJECT_ID | 1u << GLINT_PASS_DIFFUSE,
                                .samples = 1,
                                .seed = -1,
                                .is_exact = is_exact,
                                .is_painted = true,
                                .light = out->light_count == lights ? i : lights };
        glint_image *image = NULL;
        status = cost_take(study, c, &how, &image, NULL, error);
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

// Returns the samples of each part: 32 times the script's, or more, up to 32 times the most in any row if the allowance
// permits. A budget may force fewer; 0: no reference.
static double choose_samples(const cost_study *study, double allowance_ms)
{
    const int knob = cost_knob_find("samples", strlen("samples"));
    const double own = study->own->desc.samples, each = COST_REFERENCE_PARTS * study->cases[0].stats.render_ms / own;
    double most = own, samples = TIMES * own;
    for (int i = 0; i < study->values[knob].count; i++)
        most = fmax(most, study->values[knob].value[i].number);
    while (study->deadline_ms > 0 && samples >= LEAST_TIMES * own && each * samples > allowance_ms)
        samples /= 4;
    while (samples < TIMES * most && each * samples * 2 <= allowance_ms)
        samples *= 2;
    return samples < LEAST_TIMES * own ? 0 : fmin(samples, 65536);
}

// Returns the case of the reference: the script's settings, except for knobs that have a setting nearer to the truth.
static cost_case true_case(const cost_study *study)
{
    cost_case c = study->cases[0];
    for (int i = 0; i < cost_knob_count; i++)
        if (study->values[i].count > 0 && study->values[i].has_truth)
            c.choice[i] = study->values[i].truth;
    return c;
}

void cost_truth_name(const cost_study *study, char out[COST_LABEL_SIZE])
{
    size_t used = 0;
    out[0] = 0;
    for (int i = 0; i < cost_knob_count; i++) {
        const cost_values *values = &study->values[i];
        char text[32];
        if (values->count == 0 || !values->has_truth || used >= COST_LABEL_SIZE)
            continue;
        cost_value_text(values->value[values->truth], text);
        used += (size_t)snprintf(out + used, COST_LABEL_SIZE - used, ", with %s %s", cost_knobs[i].name, text);
    }
}

// Chooses independent seeds. Neighbouring seeds share a sequence, so their errors might cancel. Seeds are below 2^20,
// so that a seed's shift keeps all of its digits.
static void choose_seeds(cost_study *study)
{
    uint64_t state = (uint64_t)study->own->desc.seed;
    for (int i = 0; i < COST_REFERENCE_PARTS; i++) {
        bool fresh;
        do {
            uint64_t z = state += 0x9e3779b97f4a7c15u; // SplitMix64
            z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
            z = (z ^ z >> 27) * 0x94d049bb133111ebu;
            study->reference_seed[i] = (double)(1 + ((z ^ z >> 31) & 0xfffff));
            fresh = study->reference_seed[i] != study->own->desc.seed;
            for (int k = 0; k < i; k++)
                fresh = fresh && study->reference_seed[k] != study->reference_seed[i];
        } while (!fresh);
    }
}

static glint_status render_parts(cost_study *study, glint_image *parts[COST_REFERENCE_PARTS], glint_error *error)
{
    const cost_case c = true_case(study);
    const double part_ms = study->cases[0].stats.render_ms / study->own->desc.samples * study->reference_samples;
    glint_status status = GLINT_OK;
    for (int i = 0; i < COST_REFERENCE_PARTS && !status; i++) {
        const cost_shot how = { .passes = 1u << GLINT_PASS_BEAUTY,
                                .samples = study->reference_samples,
                                .seed = study->reference_seed[i],
                                .is_exact = true };
        cost_show(study, "reference", part_ms,
                  (COST_REFERENCE_PARTS - 1 - i) * part_ms + cost_round_ms(study) * (study->runs + 2));
        status = cost_take(study, &c, &how, &parts[i], NULL, error);
    }
    return status;
}

// Estimates the error of the mean from the differences between n independent parts and their mean: the sum of their
// squares over n (n - 1) is the variance of the mean.
static glint_status measure_parts(cost_study *study, glint_image *const parts[COST_REFERENCE_PARTS], glint_error *error)
{
    const double n = COST_REFERENCE_PARTS;
    const glint_image *list[COST_REFERENCE_PARTS];
    glint_picture_error *sum = &study->reference_error;
    for (int i = 0; i < COST_REFERENCE_PARTS; i++)
        list[i] = parts[i];
    *sum = (glint_picture_error) { .rmse = 0 };
    glint_status status =
        glint_reference_create(list, COST_REFERENCE_PARTS, &study->own->desc.tone, &study->reference, error);
    for (int i = 0; i < COST_REFERENCE_PARTS && !status; i++) {
        glint_picture_error part;
        status = glint_reference_measure(study->reference, parts[i], 0, &part, error);
        if (status)
            break;
        sum->rmse += part.rmse * part.rmse / (n * (n - 1));
        sum->relmse += part.relmse / (n * (n - 1));
        sum->max_code = fmax(sum->max_code, part.max_code);
        sum->flip += part.flip / n;
    }
    sum->rmse = sqrt(sum->rmse);
    return status;
}

bool cost_make_reference(cost_study *study, double allowance_ms)
{
    const double own = study->own->desc.samples;
    const cost_case truth = true_case(study);
    glint_image *parts[COST_REFERENCE_PARTS] = { NULL };
    glint_error error;
    study->reference_samples = choose_samples(study, allowance_ms);
    if (study->reference_samples == 0)
        return cost_leave_out(study, "every error: the budget leaves no time for a reference");
    if (study->reference_samples < TIMES * own)
        cost_leave_out(study, "a full reference: %.0f samples instead of %.0f",
                       COST_REFERENCE_PARTS * study->reference_samples, COST_REFERENCE_PARTS * TIMES * own);
    choose_seeds(study);
    glint_status status = render_parts(study, parts, &error);
    if (!status)
        status = measure_parts(study, parts, &error);
    if (!status)
        status = decide(study, &truth, true, &study->truth, &error);
    for (int i = 0; i < COST_REFERENCE_PARTS; i++)
        glint_image_release(parts[i]);
    return status ? cost_fail(study, &error) : true;
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

// Returns whether only the samples differ from the base.
static bool is_of_samples(const cost_case *c)
{
    const int samples = cost_knob_find("samples", strlen("samples"));
    for (int i = 0; i < cost_knob_count; i++)
        if (i != samples && c->choice[i] >= 0)
            return false;
    return true;
}

// Estimates the error of a picture without the reference, as --until does, for cases that differ in their samples.
static glint_status estimate(cost_study *study, cost_case *c, const glint_image *image, glint_error *error)
{
    const int knob = cost_knob_find("samples", strlen("samples"));
    glint_render_desc desc = study->own->desc;
    glint_image *partner = NULL;
    if (c->choice[knob] >= 0)
        desc.samples = study->values[knob].value[c->choice[knob]].number;
    if (desc.samples < 2 || !is_of_samples(c))
        return GLINT_OK;
    const cost_shot how = { .passes = 1u << GLINT_PASS_BEAUTY, .samples = desc.samples, .seed = glint_partner_seed(&desc) };
    glint_status status = cost_take(study, c, &how, &partner, NULL, error);
    if (!status)
        status = glint_estimate_error(image, partner, &c->estimate, error);
    glint_image_release(partner);
    return status;
}

// Measures errors against the reference.
static glint_status find_errors(cost_study *study, cost_case *c, const glint_image *image, glint_error *error)
{
    glint_status status = glint_reference_measure(study->reference, image, 0, &c->film, error);
    if (!status && c->needs_file)
        status = glint_reference_measure(study->reference, image, c->bits, &c->file, error);
    if (!status)
        status = estimate(study, c, image, error);
    if (!status)
        status = count_decisions(study, c, error);
    if (!status && study->options->report)
        status = keep_pictures(study, c, image, error);
    c->has_error = !status;
    return status;
}

bool cost_measure(cost_study *study, cost_case *c)
{
    cost_shot how = cost_own_shot(study);
    glint_frame_stats stats;
    glint_image *image = NULL;
    glint_error error;
    c->is_first_alone = false;
    c->run_count = c->batch = 0;
    if (!cost_run(study, c))
        return false;
    c->is_first_alone = true;
    how.passes |= 1u << GLINT_PASS_BEAUTY;
    const double cpu = cost_cpu_ms();
    glint_status status = cost_take(study, c, &how, &image, &stats, &error);
    c->guess_cpu_ms = fmin(c->ms[COST_CPU][0], cost_cpu_ms() - cpu);
    c->is_counted = !status;
    if (!status) {
        c->work = stats.work;
        c->guess_ms = fmin(c->ms[COST_TOTAL][0], stats.render_ms + stats.tone_ms + c->ms[COST_ENCODE][0]);
        // The untimed costs of the frames may make a run longer, but at most 3 run_ms.
        double frames = fmin(study->run_ms / fmax(c->guess_ms, 1e-3), 3 * study->run_ms / c->estimate_ms);
        c->batch = (int)fmin(fmax(ceil(frames), 1), BATCH_MAX);
        c->estimate_ms *= c->batch;
    }
    if (!status && study->reference)
        status = find_errors(study, c, image, &error);
    glint_image_release(image);
    return status ? cost_fail(study, &error) : true;
}
