// --until and --seconds: renders a frame with 2, 4, 8 ... samples a pixel until its error is small enough, or the time
// is over.
//
// Each picture is the picture of --samples n, bit for bit. A second picture with another seed and more samples, the
// partner, tells its error (glint_estimate_error).
#include <inttypes.h>
#include <math.h>

#include "bindings/run/run.h"
#include "engine/glint_compare.h"

#define STUCK 0.9 // four times the samples reduce most errors to a half or less
#define RISE 1.3 // estimates of ordinary pictures fall with each doubling of the samples, or rise by less
#define PARTNER_SAMPLES 4 // relative to the picture's

typedef struct ladder {
    glintL_run *run;
    const glintL_frame_planner *planner;
    int64_t index; // the frame's number
    double most; // samples, at most
    double start_ms, step_ms; // step_ms: time of the last picture and its partner
    double errors[3]; // of the last pictures, the newest first; 0: none
    double pixels; // see glint_estimate_pixels
} ladder;

bool glintL_run_refines(const glintL_run *run) { return run->request.until > 0 || run->request.seconds > 0; }

void glintL_render_be_partner(glintL_render *render)
{
    render->desc.seed = glint_partner_seed(&render->desc);
    render->desc.samples = fmin(PARTNER_SAMPLES * render->desc.samples, GLINTL_SAMPLES_MAX);
    render->file_passes = 0;
    render->derivative_count = 0;
    render->desc.derivatives = NULL;
    render->desc.derivative_count = 0;
    render->light_passes[0] = '\0';
    render->desc.light_passes = NULL;
    render->desc.outline = GLINT_OUTLINE_NONE;
}

static glintL_work *fail_render(ladder *l, glintL_work *work, const glint_error *error)
{
    const bool stopped = error->status == GLINT_ERR_CANCELLED;
    glintL_run_fail(l->run, stopped ? GLINTL_EXIT_FAILED : glintL_run_exit_code(error->status), l->index, "%s",
                    stopped ? "interrupted" : error->message);
    glintL_work_destroy(work);
    return NULL;
}

// Renders the frame. NULL: the run has failed.
static glintL_work *draw(ladder *l, const glintL_render *render)
{
    glint_error error;
    glintL_work *work = l->planner->plan(l->planner->context, render);
    return !work || glintL_work_draw(l->run, work, &error) == GLINT_OK ? work : fail_render(l, work, &error);
}

// Renders the frame and its partner. NULL: the run has failed.
static glintL_work *step(ladder *l, double samples)
{
    glint_error error;
    glintL_render render = *l->planner->render;
    const double start = glintL_now_ms();
    render.desc.samples = samples;
    glintL_work *work = draw(l, &render);
    if (!work)
        return NULL;
    glintL_render_be_partner(&render);
    snprintf(render.output, sizeof render.output, "partner.pfm"); // without pixel values; no file is written
    glintL_work *partner = draw(l, &render);
    const bool good = partner && (glint_estimate_error(work->image, partner->image, &work->error, &error) == GLINT_OK ||
                                  fail_render(l, NULL, &error));
    l->pixels = good ? glint_estimate_pixels(work->image, partner->image) : 0;
    glintL_work_destroy(partner);
    l->step_ms = glintL_now_ms() - start;
    if (!good) {
        glintL_work_destroy(work);
        return NULL;
    }
    l->errors[2] = l->errors[1];
    l->errors[1] = l->errors[0];
    l->errors[0] = work->error;
    return work;
}

// Returns whether the next step, which takes as long as its share of samples says, ends in time.
static bool has_time(const ladder *l, double factor)
{
    const double limit = l->run->request.seconds * 1e3;
    return limit == 0 || glintL_now_ms() - l->start_ms + factor * l->step_ms <= limit;
}

static bool has_risen(const ladder *l)
{
    return (l->errors[1] > 0 && l->errors[0] > RISE * l->errors[1]) ||
           (l->errors[2] > 0 && l->errors[1] > RISE * l->errors[2]);
}

static bool is_doubtful(const ladder *l) { return l->pixels < GLINTL_ESTIMATE_PIXELS || has_risen(l); }

// Returns whether more samples hardly reduce the error. With `adaptive`, pixels that keep one sample keep its noise.
static bool is_stuck(const ladder *l)
{
    return l->errors[2] > 0 && l->errors[0] > STUCK * l->errors[2] && !is_doubtful(l);
}

static void warn_of_doubt(const ladder *l)
{
    char moved[80] = "", held[80] = "";
    if (!is_doubtful(l))
        return;
    if (l->pixels < GLINTL_ESTIMATE_PIXELS)
        snprintf(held, sizeof held, ": most of it is in %.0f pixel%s", fmax(l->pixels, 1), l->pixels < 1.5 ? "" : "s");
    if (l->errors[1] > 0)
        snprintf(moved, sizeof moved, "%s the last %s of the samples moved it from %.3g", *held ? ", and" : ":",
                 l->errors[2] > 0 ? "two doublings" : "doubling", l->errors[2] > 0 ? l->errors[2] : l->errors[1]);
    glintL_run_warn(l->run, "frame %" PRId64 ": the estimated error, %.3g, is not to be trusted%s%s; rare bright paths may be "
                    "missing from it", l->index, l->errors[0], held, moved);
}

static void warn_of_rest(const ladder *l, const glintL_work *work)
{
    const glintL_request *request = &l->run->request;
    const double samples = work->render.desc.samples;
    if (request->until == 0 || work->error <= request->until)
        return;
    if (is_stuck(l))
        glintL_run_warn(l->run, "frame %" PRId64 ": --until: the error is %.3g, above %g, after %.0f samples, and more samples do not "
                        "reduce it; use a smaller --adaptive, or more samples of lights", l->index, work->error, request->until, samples);
    else if (samples == l->most)
        glintL_run_warn(l->run, "frame %" PRId64 ": --until: the error is %.3g, above %g, after %.0f samples, the most%s",
                        l->index, work->error, request->until, samples,
                        l->most < GLINTL_SAMPLES_MAX ? "; use more --samples" : "");
    else
        glintL_run_warn(l->run, "frame %" PRId64 ": --until: the error is %.3g, above %g, after %.0f samples, the most in %g seconds",
                        l->index, work->error, request->until, samples, request->seconds);
}

glintL_work *glintL_refine(glintL_run *run, const glintL_frame_planner *planner, int64_t index)
{
    ladder l = { .run = run, .planner = planner, .index = index, .most = GLINTL_SAMPLES_MAX, .start_ms = glintL_now_ms() };
    if (run->request.render_text[glintL_render_find("samples")])
        l.most = planner->render->desc.samples;
    double samples = 2;
    glintL_work *work = step(&l, samples);
    while (work && samples < l.most && work->error > run->request.until) {
        const double more = fmin(2 * samples, l.most);
        if (run->reporter.step)
            run->reporter.step(run->reporter.context, samples, work->error);
        if (is_stuck(&l) || !has_time(&l, more / samples))
            break;
        samples = more;
        glintL_work_destroy(work);
        work = step(&l, samples);
    }
    glint_error error;
    if (!work)
        return NULL;
    if (glintL_work_warn(run, work, &error))
        return fail_render(&l, work, &error);
    warn_of_rest(&l, work);
    warn_of_doubt(&l);
    glintL_work_show(run, work);
    return work;
}
