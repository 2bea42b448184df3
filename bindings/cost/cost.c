// glint cost SCRIPT: what accuracy costs in time, for one frame of the user's own scene.
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

#define RUNS 11 // timed runs of each setting, not counting the first
#define RUNS_QUICK 5
#define MORE_RUNS 3 // factor of runs for settings whose quartile range overlaps a neighbour's
#define RUN_MS 30.0 // short frames are repeated until a run takes this long
#define RUN_QUICK_MS 5.0
#define ALLOWANCE_MS 45e3 // time for the reference, in addition to the minimum number of samples
#define ALLOWANCE_QUICK_MS 5e3
#define BUDGET_SHARE 0.3 // share of a budget for the reference
#define BASE_FRAMES 3 // frames: one that is dropped, one that counts the work, one that is timed
#define LONG_MS 120e3 // a longer study is announced

// ---- The scene ----

static bool read_scene(cli_options *options, glintL_run *run, cost_moments **moments)
{
    cli_script script;
    *moments = cost_moments_open(&run->moments);
    if (!*moments)
        return glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
    run->mode = GLINTL_MODE_EXPLAIN;
    run->explain_frame = options->frame;
    run->keeps_scene = true;
    glintL_selection_clear(&run->request.selection); // here --frame is not a selection
    cli_run_script(&script, options, run);
    cli_close_script(&script);
    if (!run->exit_code && !run->interrupted && !run->retained_scene)
        glintL_run_fail(run, GLINTL_EXIT_USAGE, 0,
                        "--frame: expected a frame of the script, 1 .. %" PRId64 ", got '%" PRId64 "'", run->count,
                        options->frame);
    return !run->exit_code && !run->interrupted;
}

static void say_frame(const cost_study *study)
{
    const glintL_run *run = study->run;
    const glint_render_desc *desc = &study->own->desc;
    char total[32] = "";
    if (run->call_count == 0)
        snprintf(total, sizeof total, " of %" PRId64, run->count);
    if (study->output->quiet)
        return;
    fprintf(stderr, "%s, frame %" PRId64 "%s%s: %.0f x %.0f, %.0f sample%s a pixel\n", run->script, run->explain_frame,
            total, run->call_count == 0 && run->count == 1 ? "" : " (choose another with --frame N)", desc->width,
            desc->height, desc->samples, desc->samples == 1 ? "" : "s");
}

// ---- The phases ----

// Guesses the time of a case from its number of rays, before its first run.
static bool guess(cost_study *study, int index)
{
    cost_case *c = &study->cases[index];
    double rays = 0, base_rays = 0;
    if (!cost_expect(study, c, &rays) || !cost_expect(study, &study->cases[0], &base_rays))
        return false;
    const cost_case *base = &study->cases[0];
    const double frame_ms = base->guess_ms > 0 ? base->guess_ms : base->estimate_ms;
    c->estimate_ms = fmax(frame_ms * (base_rays > 0 ? fmax(rays / base_rays, 0.2) : 1), study->run_ms);
    return true;
}

static bool guess_all(cost_study *study, int from)
{
    for (int i = from; i < study->case_count; i++)
        if (!guess(study, i))
            return false;
    return true;
}

static void warn_long(const cost_study *study)
{
    double ms = cost_round_ms(study) * (study->runs + 2);
    if (study->deadline_ms > 0 || ms < LONG_MS || study->output->quiet)
        return;
    cli_progress *progress = study->output->progress;
    if (progress)
        cli_progress_clear(progress);
    fprintf(stderr,
            "glint: this will take about %.0f minutes; use --quick, --budget SECONDS, --knobs LIST or --size to "
            "shorten it, or press Ctrl-C to see the results so far\n",
            ceil(ms / 60e3));
}

// Returns the time to measure a case: one run, its errors, and the least number of further runs.
static double price(const cost_study *study, const cost_case *c)
{
    return study->overhead_ms + c->estimate_ms * (1 + COST_RUNS_LEAST);
}

// Leaves out the slowest cases, from index `from` on, until the others fit the budget.
static void fit_cases(cost_study *study, int from)
{
    for (;;) {
        double sum = from == 1 ? study->cases[0].estimate_ms * COST_RUNS_LEAST : 0;
        int slowest = 0;
        for (int i = 1; i < study->case_count; i++) {
            const cost_case *c = &study->cases[i];
            if (c->is_left_out)
                continue;
            sum += i < from ? c->estimate_ms * COST_RUNS_LEAST : price(study, c);
            if (i >= from && (slowest == 0 || price(study, c) >= price(study, &study->cases[slowest])))
                slowest = i;
        }
        if (slowest == 0 || sum <= cost_left_ms(study))
            return;
        study->cases[slowest].is_left_out = true;
    }
}

// Runs the cases from index `from` on once and measures their errors. Cases that do not fit the budget are left out.
static bool measure_cases(cost_study *study, int from)
{
    fit_cases(study, from);
    for (int i = from; i < study->case_count; i++) {
        cost_case *c = &study->cases[i];
        if (c->is_left_out)
            continue;
        double remaining_ms = cost_round_ms(study) * study->runs;
        for (int later = i + 1; later < study->case_count; later++)
            remaining_ms += study->cases[later].is_left_out ? 0 : study->overhead_ms + study->cases[later].estimate_ms;
        cost_show(study, "errors", study->overhead_ms + c->estimate_ms, remaining_ms);
        if (cost_is_stopped(study) || !cost_measure(study, c))
            return false;
    }
    return true;
}

// Measures the script's own setting, which is never left out, and the time that it takes to find an error.
static bool measure_base(cost_study *study)
{
    double start = glintL_now_ms();
    cost_show(study, "errors", study->cases[0].estimate_ms, cost_round_ms(study) * (study->runs + 2));
    bool good = cost_measure(study, &study->cases[0]);
    study->overhead_ms = fmax(glintL_now_ms() - start - study->cases[0].guess_ms, 0);
    return good && guess_all(study, 1);
}

static bool name_unmeasured(cost_study *study)
{
    char name[COST_LABEL_SIZE];
    for (int i = 0; i < study->row_count; i++) {
        if (study->cases[study->rows[i].measured].run_count > 0)
            continue;
        cost_row_name(&study->rows[i], name);
        if (!cost_leave_out(study, "%s: not measured: the budget leaves no time for it", name))
            return false;
    }
    return true;
}

// Returns whether the budget has time to measure the script's own setting, which takes BASE_FRAMES frames after the
// first.
static bool has_capacity(const cost_study *study)
{
    return cost_left_ms(study) >= BASE_FRAMES * study->cases[0].estimate_ms;
}

static bool stop_after_first(cost_study *study)
{
    study->runs = 1;
    return cost_leave_out(study, "every error, and all runs except the first frame: the budget leaves no time for "
                                 "more") &&
           name_unmeasured(study);
}

static bool run_study(cost_study *study)
{
    const double quick = study->options->quick ? ALLOWANCE_QUICK_MS : ALLOWANCE_MS;
    cost_show(study, "first frame", 1, 0);
    if (!cost_open_renderers(study) || !cost_run(study, &study->cases[0]))
        return false;
    study->cases[0].is_first_alone = true;
    if (!has_capacity(study))
        return stop_after_first(study);
    if (!guess_all(study, 1))
        return false;
    warn_long(study);
    if (!cost_make_reference(study, study->deadline_ms > 0 ? BUDGET_SHARE * cost_left_ms(study) : quick) ||
        !measure_base(study) || !measure_cases(study, 1))
        return false;
    const int alone = study->case_count;
    if (!cost_add_combinations(study) || !guess_all(study, alone) || !measure_cases(study, alone) ||
        !name_unmeasured(study))
        return false;
    return cost_time_cases(study);
}

// ---- The study ----

static void close_study(cost_study *study)
{
    for (int keeps = 0; keeps < 2; keeps++)
        for (int counts = 0; counts < 2; counts++)
            if (study->renderers[keeps][counts] != study->run->renderer)
                glint_renderer_destroy(study->renderers[keeps][counts]);
    for (int i = 0; i < study->case_count; i++) {
        free(study->cases[i].picture);
        free(study->cases[i].difference);
    }
    cost_moments_close(study->moments);
    for (int i = 0; i < study->left_out_count; i++)
        free(study->left_out[i]);
    free(study->left_out);
    free(study->live);
    free(study->cases);
    free(study->rows);
    free(study->truth.object);
    free(study->truth.lit);
    glint_reference_destroy(study->reference);
    cost_scene_close(&study->scene);
    free(study);
}

// Warns that a frame with an open shutter is measured as an instant, because its times are not known.
static bool warn_of_instant(cost_study *study)
{
    const char *lack = cost_moments_lack(study->moments);
    return !lack || cost_leave_out(study, "the open shutter: %s; the frame is measured at one instant, without "
                                          "motion blur", lack);
}

// Opens a study, which takes over the moments, on failure too.
static cost_study *open_study(cli_options *options, cli_output *output, glintL_run *run, cost_moments *moments)
{
    cost_study *study = calloc(1, sizeof *study);
    double times[COST_VALUES_MAX];
    if (!study) {
        cost_moments_close(moments);
        glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
        return NULL;
    }
    study->output = output;
    study->run = run;
    study->options = options;
    study->moments = moments;
    study->shutter_times = cost_moments_counts(moments, times) > 0 ? (int)times[0] : 0;
    study->own = &run->retained_render;
    study->runs = options->quick ? RUNS_QUICK : RUNS;
    study->most_runs = MORE_RUNS * study->runs < COST_RUNS_MAX ? MORE_RUNS * study->runs : COST_RUNS_MAX;
    study->run_ms = options->quick ? RUN_QUICK_MS : RUN_MS;
    study->start_ms = output->start_ms;
    study->deadline_ms = options->budget_s > 0 ? output->start_ms + options->budget_s * 1e3 : 0;
    cost_subject subject = { .plan = run->explain_plan,
                             .render = study->own,
                             .scene = &study->scene,
                             .moments = moments,
                             .has_neighbour = run->retained_neighbour != NULL,
                             .is_pfm = glintL_name_is_linear(study->own->output) };
    if (!cost_scene_open(&study->scene, run->retained_scene))
        glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
    else if (cost_list_cases(study, &subject))
        warn_of_instant(study);
    return study;
}

// Returns whether there are rows to show.
static bool has_rows(const cost_study *study)
{
    for (int i = 0; i < study->row_count; i++)
        if (study->cases[study->rows[i].measured].run_count > 0)
            return true;
    return false;
}

static void present(cost_study *study)
{
    char message[GLINTL_MESSAGE_SIZE];
    cost_judge(study);
    if (!cost_print(study, study->output->data, message))
        glintL_run_fail(study->run, GLINTL_EXIT_FAILED, 0, "%s", message);
    const int code = study->options->report ? cost_report_write(study, study->options->report, message) : 0;
    if (code)
        glintL_run_fail(study->run, code, 0, "--report: %s", message);
}

// Checks the names of the knobs. Whether the scene responds to them is checked later.
static bool check_options(const cli_options *options, glintL_run *run)
{
    char message[GLINTL_MESSAGE_SIZE];
    if (options->knobs && !cost_knobs_check(options->knobs, message))
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "--knobs: %s", message);
    if (options->is_live && !options->report)
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "--live: expected together with --report DIR, whose page "
                                                          "shows the live figure");
    if (options->report && !cost_report_check(options->report, message))
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "--report: %s", message);
    return true;
}

static bool add_live(cost_study *study)
{
    char message[GLINTL_MESSAGE_SIZE];
    int code = 0;
    study->live = cli_live(study->options, &study->run->request, &code, message);
    return study->live || glintL_run_fail(study->run, code, 0, "%s", message);
}

int cli_cost(cli_options *options, cli_output *output, glintL_run *run)
{
    cost_moments *moments = NULL;
    cost_study *study = NULL;
    if (check_options(options, run) && read_scene(options, run, &moments))
        study = open_study(options, output, run, moments);
    else
        cost_moments_close(moments);
    if (study && !run->exit_code && (!options->is_live || add_live(study))) {
        say_frame(study);
        if (!output->quiet)
            output->progress = cli_progress_create(output->color);
        study->is_complete = run_study(study);
        cli_progress_destroy(output->progress);
        output->progress = NULL;
        if (!run->exit_code && has_rows(study))
            present(study);
    }
    if (run->interrupted)
        cli_report_error(output, 0, 128 + (int)run->interrupted, "interrupted");
    else if (run->exit_code)
        cli_report_error(output, 0, run->exit_code, run->message);
    if (study)
        close_study(study);
    return run->exit_code;
}
