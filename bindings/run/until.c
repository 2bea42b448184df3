// --until, --until-light and --seconds: renders a frame with 2, 4, 8 ... samples a pixel until its error is small enough,
// or the time is over.
//
// Each picture is the picture of --samples n, bit for bit. A second picture with another seed and more samples, the
// partner, tells its error (glint_estimate_error).
//
// The files of a step stay until the next step replaces them, so that whatever ends the run leaves the best picture so
// far. Their key says that they are unfinished, and the next run goes on from there.
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bindings/run/run.h"
#include "engine/glint_compare.h"
#include "engine/glint_files.h"

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
    int number; // of the last step, from 1
    bool may_leave; // no finished picture would be lost
    bool replaces; // the last step has files that the next one can replace
    glintL_work *left; // the last work whose files were left; only its names and numbers are read. NULL: none
} ladder;

static double target(const glintL_request *request) { return fmax(request->until, request->until_light); }

bool glintL_run_refines(const glintL_run *run) { return target(&run->request) > 0 || run->request.seconds > 0; }

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

// Names the work's files. Returns whether there are any, and all of them can be replaced.
static bool has_files(const ladder *l, glintL_work *work)
{
    if (!l->planner->name(l->planner->context, work) || work->file_count == 0)
        return false;
    for (int i = 0; i < work->file_count; i++)
        if (glintL_name_is_special(work->files[i].path))
            return false;
    return true;
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
    l->replaces = has_files(l, work); // planning the partner changes the frame's names
    glintL_render_be_partner(&render);
    snprintf(render.output, sizeof render.output, "partner.pfm"); // without pixel values; no file is written
    glintL_work *partner = draw(l, &render);
    const glint_tone_desc *tone = l->run->request.until_light > 0 ? NULL : &work->render.desc.tone;
    const bool good = partner && (glint_estimate_error(work->image, partner->image, tone, &work->error, &error) == GLINT_OK ||
                                  fail_render(l, NULL, &error));
    l->pixels = good ? glint_estimate_pixels(work->image, partner->image, tone) : 0;
    glintL_work_destroy(partner);
    l->step_ms = glintL_now_ms() - start;
    if (!good) {
        glintL_work_destroy(work);
        return NULL;
    }
    l->errors[2] = l->errors[1];
    l->errors[1] = l->errors[0];
    l->errors[0] = work->error;
    l->number++;
    if (l->run->reporter.step)
        l->run->reporter.step(l->run->reporter.context,
                              &(glintL_step) { l->index, l->number, samples, l->step_ms, work->error });
    return work;
}

// ---- Unfinished pictures ----

static void mark_unfinished(const ladder *l, glintL_work *work)
{
    snprintf(work->unfinished, sizeof work->unfinished, "%" PRId64 " samples, error %.9g", work->render.desc.samples, l->errors[0]);
}

// Returns whether a work's file is the unfinished picture of its samples.
static bool is_left(const glintL_work *work)
{
    char key[GLINTL_KEY_SIZE];
    GLINTL_SPELL_KEY(key, work->files[0].key, true);
    return *work->files[0].key && glint_file_has_key(work->files[0].path, key);
}

// Leaves the work's files, and destroys its picture. False: the run has failed.
static bool leave(ladder *l, glintL_work *work)
{
    bool good = true;
    if (l->may_leave && l->replaces) {
        mark_unfinished(l, work);
        good = glintL_work_leave(l->run, work);
    }
    if (!good || !*work->unfinished || (l->run->interrupted && !is_left(work))) { // a signal may have stopped the writer
        glintL_work_destroy(work);
        return good;
    }
    glintL_work_destroy(l->left);
    glint_image_release(work->image);
    work->image = NULL;
    l->left = work;
    return true;
}

// Returns the samples of the unfinished picture in a work's file, and its error; 0: there is none.
static double samples_left(const glintL_work *work, double *stated)
{
    glint_picture *picture = NULL;
    if (!*work->files[0].key || glint_picture_read(work->files[0].path, false, &picture, NULL))
        return 0;
    const char *text = glint_picture_text(picture, "glint:unfinished"), *error = text ? strstr(text, "error ") : NULL;
    const double samples = text ? strtod(text, NULL) : 0;
    *stated = error ? strtod(error + strlen("error "), NULL) : 0;
    glint_picture_destroy(picture);
    return samples >= 2 && samples <= GLINTL_SAMPLES_MAX && samples == floor(samples) ? samples : 0;
}

// Returns the samples of the first step: twice those of an unfinished picture of this frame, or 2. 0: the run has failed.
static double first_samples(ladder *l)
{
    glintL_render render = *l->planner->render;
    double samples = 2, found = 0, stated = 0;
    for (int k = 0; k < 2 && samples > 0; k++) {
        render.desc.samples = samples;
        glintL_work *work = l->planner->plan(l->planner->context, &render);
        if (!work)
            return 0;
        if (k == 0 && has_files(l, work)) {
            found = samples_left(work, &stated);
            l->may_leave = found > 0 || access(work->files[0].path, F_OK) != 0;
            found = l->run->request.starts_anew ? 0 : found;
        } else if (k > 0 && has_files(l, work) && is_left(work) && 2 * samples <= l->most) {
            for (double n = 2; n <= samples; n *= 2)
                l->number++;
            l->errors[0] = stated;
            glintL_work_destroy(work);
            return 2 * samples;
        }
        glintL_work_destroy(work);
        samples = found;
    }
    return 2;
}

// ---- Ends ----

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

static void finish(const ladder *l, glintL_work *work)
{
    const glintL_request *request = &l->run->request;
    const double samples = work->render.desc.samples, until = target(request);
    const char *name = request->until_light > 0 ? "until-light" : "until";
    if (until == 0 || work->error <= until)
        return;
    if (is_stuck(l))
        glintL_run_warn(l->run, "frame %" PRId64 ": --%s: the error is %.3g, above %g, after %.0f samples, and more samples do not "
                        "reduce it; use a smaller --adaptive, or more samples of lights", l->index, name, work->error, until, samples);
    else if (samples == l->most)
        glintL_run_warn(l->run, "frame %" PRId64 ": --%s: the error is %.3g, above %g, after %.0f samples, the most%s",
                        l->index, name, work->error, until, samples,
                        l->most < GLINTL_SAMPLES_MAX ? "; use more --samples" : "");
    else
        glintL_run_warn(l->run, "frame %" PRId64 ": --%s: the error is %.3g, above %g, after %.0f samples, the most in %g seconds",
                        l->index, name, work->error, until, samples, request->seconds);
    if (!is_stuck(l) && samples < l->most)
        mark_unfinished(l, work);
}

glintL_work *glintL_refine(glintL_run *run, const glintL_frame_planner *planner, int64_t index)
{
    ladder l = { .run = run, .planner = planner, .index = index, .most = GLINTL_SAMPLES_MAX, .start_ms = glintL_now_ms() };
    if (run->request.render_text[glintL_render_find("samples")])
        l.most = planner->render->desc.samples;
    double samples = fmin(first_samples(&l), l.most);
    glintL_work *work = samples > 0 ? step(&l, samples) : NULL;
    while (work && samples < l.most && work->error > target(&run->request)) {
        const double more = fmin(2 * samples, l.most);
        if (is_stuck(&l) || !has_time(&l, more / samples))
            break;
        work = leave(&l, work) ? step(&l, more) : NULL;
        samples = more;
    }
    if (!work && l.left)
        glintL_run_warn(run, "frame %" PRId64 ": %s has the picture of %" PRId64 " samples, error %.3g%s", index, l.left->files[0].path,
                        l.left->render.desc.samples, l.left->error, *l.left->files[0].key ? "; the same command goes on from there" : "");
    if (work)
        work->follows_step = l.left != NULL;
    glintL_work_destroy(l.left);
    glint_error error;
    if (!work)
        return NULL;
    if (glintL_work_warn(run, work, &error))
        return fail_render(&l, work, &error);
    finish(&l, work);
    warn_of_doubt(&l);
    glintL_work_show(run, work);
    return work;
}
