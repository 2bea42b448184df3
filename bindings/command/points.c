// The points of --sweep. The script runs once for each point, in a separate Lua state. The frames of all points are
// rendered in the order that costs least: if a step of a swept parameter costs less than a step to the next frame, the
// runs advance together. A point whose script fails is reported, and the others continue.
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/command/points.h"
#include "bindings/run/order.h"
#include "bindings/run/system.h"

#define TOGETHER_MAX 64 // Lua states open at a time, at most

typedef struct point {
    int64_t number; // 1 ..; 0: this slot is free
    cli_script script;
    glintL_jobs_state jobs;
    char *params_text; // owned; exchanged with the run's text while the point is current
    bool has_frames; // the point has rendered frames
} point;

typedef struct points {
    cli_options *options;
    cli_output *output;
    glintL_run *run;
    point open[TOGETHER_MAX];
    int most; // number of slots of `open` in use, at most
    point *at_hand; // the point whose script runs; NULL: none
    int64_t frames; // number of frames of each point; 0: not known yet
    unsigned char *failed; // owned; for each point: its script has failed
    bool has_failed; // any point has failed
    bool together, in_order; // together: the runs of some job advance together; in_order: some frames go to a pipe
    int64_t job, frame; // position of the current job and frame in their lists, 1 ..
    glint_plan *plan; // plan of the current frame
    glintL_order order; // order of the current job
    int64_t *list; // owned; numbers of the frames to render, in order
    int64_t count;
} points;

// ---- The current point ----

static void exchange_text(points *p)
{
    char *text = p->run->params_text;
    p->run->params_text = p->at_hand->params_text;
    p->at_hand->params_text = text;
}

// Makes `next` the current point of the run; NULL: none.
static void take(points *p, point *next)
{
    if (p->at_hand == next)
        return;
    if (p->at_hand)
        exchange_text(p);
    p->at_hand = next;
    cli_set_state(next ? next->script.state : NULL);
    if (!next)
        return;
    exchange_text(p);
    p->run->point = next->number;
    p->run->point_first = (next->number - 1) * p->frames;
    cli_sweep_to(p->options, p->run, next->number);
}

// Returns whether a failure is a mistake in the script, which ends only its own point, and not in the command line.
static bool is_own(const glintL_run *run)
{
    return !run->interrupted && (run->exit_code == GLINTL_EXIT_DONE ||
                                 (run->exit_code == GLINTL_EXIT_USAGE && run->request.warnings != GLINTL_WARNINGS_ERROR &&
                                  strncmp(run->message, "--", 2) != 0));
}

static void report(points *p, int64_t number, const char *said)
{
    char message[GLINTL_MESSAGE_SIZE], values[200];
    cli_spell_point(p->options, number, values, sizeof values);
    snprintf(message, sizeof message, "--sweep %s: %.800s", values, said);
    cli_report_error(p->output, p->run->failed_index, GLINTL_EXIT_USAGE, message);
}

// Clears the run's failure and marks the point as failed.
static void set_aside(points *p, int64_t number)
{
    p->failed[number - 1] = 1;
    p->has_failed = true;
    p->run->exit_code = GLINTL_EXIT_DONE;
    p->run->failed_index = 0;
}

// Returns whether the run continues after the last call of a point's script.
static bool goes_on(points *p, int64_t number)
{
    if (!is_own(p->run))
        return false;
    if (p->run->exit_code == GLINTL_EXIT_DONE)
        return true;
    report(p, number, p->run->message);
    set_aside(p, number);
    return true;
}

static int report_protected(lua_State *L)
{
    const points *p = lua_touserdata(L, 1);
    glintL_report_observed(L, p->run, p->options->script);
    return 0;
}

static int end_protected(lua_State *L)
{
    points *p = lua_touserdata(L, 1);
    lua_rawgeti(L, LUA_REGISTRYINDEX, p->at_hand->script.jobs);
    glintL_jobs_end(L, 2, p->run, &p->at_hand->jobs);
    return 0;
}

// Calls a function in the current state. False: it raised, or the run has failed.
static bool call(points *p, lua_CFunction function)
{
    lua_State *L = p->at_hand->script.state;
    lua_settop(L, 0);
    lua_pushcfunction(L, glintL_message_handler);
    lua_pushcfunction(L, function);
    lua_pushlightuserdata(L, p);
    const int status = lua_pcall(L, 1, 0, 1);
    if (status != LUA_OK && !p->run->interrupted)
        glintL_run_fail(p->run, glintL_script_exit(p->run, status), 0, "%s", lua_tostring(L, -1));
    lua_settop(L, 0);
    return status == LUA_OK && !p->run->exit_code && !p->run->interrupted;
}

// Ends a point: makes its sheets and prints its summary. Returns false when the run failed.
static bool close_point(points *p, point *which)
{
    const int64_t number = which->number;
    bool good = true;
    if (!number)
        return true;
    take(p, which);
    if (which->has_frames && !p->failed[number - 1])
        good = (call(p, end_protected) && call(p, report_protected)) || goes_on(p, number);
    take(p, NULL);
    cli_close_script(&which->script);
    free(which->params_text);
    memset(which, 0, sizeof *which);
    return good;
}

// ---- Opening ----

// Checks that a script returned jobs if and only if the other points did. False: the run has failed.
static bool check_jobs(points *p, const point *which)
{
    glintL_run *run = p->run;
    const int64_t frames = which->script.frames;
    if (run->count > run->point_first)
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, 0,
                               "--sweep: the script both calls scene:render and returns frames; expected only one of "
                               "the two");
    if (frames > GLINTL_FRAMES_MAX / run->point_count)
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "--sweep: expected at most %d frames in total", GLINTL_FRAMES_MAX);
    if (!which->script.has_jobs || (p->frames && frames != p->frames))
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "--sweep: the script must have the same number of frames at every value");
    return true;
}

static point *find_open(points *p, int64_t number)
{
    for (int i = 0; i < TOGETHER_MAX; i++)
        if (p->open[i].number == number)
            return &p->open[i];
    return NULL;
}

// Runs the script for a point in a free slot; its frames are rendered later. NULL: the run has failed.
static point *open_point(points *p, int64_t number)
{
    glintL_run *run = p->run;
    point *which = find_open(p, 0);
    take(p, NULL);
    which->number = number;
    take(p, which);
    run->count = run->point_first;
    run->mode = GLINTL_MODE_WATCH;
    bool good = cli_run_script(&which->script, p->options, run);
    run->mode = GLINTL_MODE_RENDER;
    const bool renders = !which->script.has_jobs && number == 1; // the script renders by calls, in its own order
    if (good && (renders || check_jobs(p, which))) {
        p->frames = which->script.frames;
        run->point_first = (number - 1) * p->frames;
        return which;
    }
    take(p, NULL);
    cli_close_script(&which->script);
    free(which->params_text);
    memset(which, 0, sizeof *which);
    return NULL;
}

// Returns a point, after opening it if necessary and closing points of other groups if there is no free slot. NULL: the
// point has failed; *good: the run can continue.
static point *reach(points *p, int64_t number, bool *good)
{
    *good = true;
    point *which = p->failed[number - 1] ? NULL : find_open(p, number);
    if (which || p->failed[number - 1])
        return which;
    int used = 0;
    for (int i = 0; i < TOGETHER_MAX; i++)
        used += p->open[i].number > 0;
    for (int i = 0; i < TOGETHER_MAX && used >= p->most && *good; i++)
        if (p->open[i].number && (p->open[i].number - 1) / p->most != (number - 1) / p->most)
            *good = close_point(p, &p->open[i]);
    which = *good && find_open(p, 0) ? open_point(p, number) : NULL;
    *good = *good && (which || goes_on(p, number));
    return which;
}

// Opens the first point whose script runs. If the script fails with the same message at two values, or while it
// renders, the whole run fails. NULL: the run has failed, or all failures are reported.
static point *open_first(points *p)
{
    glintL_run *run = p->run;
    char said[GLINTL_MESSAGE_SIZE] = "";
    for (int64_t number = 1; number <= run->point_count; number++) {
        point *which = open_point(p, number);
        const bool whole = !which && (!is_own(run) || run->point_count == 1 || run->count > 0 || strcmp(said, run->message) == 0);
        if (whole)
            return NULL;
        if (number > 1)
            report(p, number - 1, said);
        if (which)
            return which;
        snprintf(said, sizeof said, "%s", run->message);
        set_aside(p, number);
    }
    report(p, run->point_count, said);
    return NULL;
}

// ---- The order ----

typedef struct job { // one job in every point's list of jobs
    points *p;
    int64_t before, frames; // number of frames in the list before this job, and in this job
    bool good; // the run has not failed
} job;

static int probe_protected(lua_State *L)
{
    points *p = lua_touserdata(L, 1);
    lua_rawgeti(L, LUA_REGISTRYINDEX, p->at_hand->script.jobs);
    p->plan = glintL_jobs_probe(L, 2, p->run, &p->at_hand->jobs, p->frame);
    return 0;
}

// Plans frame x of a job's order; x is n + (k - 1) * frames for frame n at point k.
static glint_plan *plan_frame(void *context, int64_t x)
{
    job *of = context;
    points *p = of->p;
    point *which = of->good ? reach(p, (x - 1) / of->frames + 1, &of->good) : NULL;
    if (!which)
        return NULL;
    take(p, which);
    p->frame = of->before + (x - 1) % of->frames + 1;
    p->plan = NULL;
    call(p, probe_protected);
    if (!p->run->interrupted) // rendering the frame will report the failure
        p->run->exit_code = GLINTL_EXIT_DONE;
    return p->plan;
}

static int axes_protected(lua_State *L)
{
    points *p = lua_touserdata(L, 1);
    lua_rawgeti(L, LUA_REGISTRYINDEX, p->at_hand->script.jobs);
    p->in_order = !glintL_jobs_axes(L, 2, p->run, p->job, &p->order) || p->in_order;
    return 0;
}

// Adds the axes of --sweep to the order of a job. Returns how many axes the job has itself.
static int add_sweeps(points *p)
{
    const int own = p->order.axis_count;
    for (size_t i = 0; i < p->options->sweep_count; i++) {
        glintL_order_axis *axis = glintL_order_add(&p->order, p->options->sweeps[i].count);
        axis->may_fail = true;
        snprintf(axis->name, sizeof axis->name, "%s", p->options->sweeps[i].name);
        axis->middle = 0; // this middle value keeps the fewest states open
    }
    return own;
}

// Returns whether points change more often than some of the job's own axes.
static bool changes_points_first(const glintL_order *order, int own)
{
    bool has_point = false;
    for (int i = 0; i < order->axis_count; i++) {
        const int axis = order->by_work[i];
        if (has_point && axis < own && order->axes[axis].count > 1)
            return true;
        has_point = has_point || (axis >= own && order->axes[axis].count > 1);
    }
    return false;
}

// Lists the selected frames of a job in its order.
static void list_job(points *p, const job *of)
{
    for (int64_t position = 0; position < p->order.frames; position++) {
        const int64_t x = glintL_order_frame(&p->order, position) - 1;
        const int64_t number = x / of->frames * p->frames + of->before + x % of->frames + 1;
        if (glintL_selection_has(&p->run->request.selection, number))
            p->list[p->count++] = number;
    }
}

// Finds the order of the current job. False: the run has failed.
static bool order_job(points *p, point *first, job *of)
{
    glintL_order *order = &p->order;
    glintL_order_init(order);
    take(p, find_open(p, 1) ? find_open(p, 1) : first);
    if (!call(p, axes_protected))
        return false;
    of->frames = order->frames;
    if (p->options->sweep_count > GLINTL_ORDER_AXES / 2) {
        glintL_order_add(order, p->run->point_count);
        return true;
    }
    const int own = add_sweeps(p);
    if (p->most > 1 && !p->in_order && glintL_order_is_grid(order) && glintL_order_find(order, plan_frame, of))
        p->together = changes_points_first(order, own) || p->together;
    return of->good;
}

// Lists all jobs. False: the run has failed.
static bool list_jobs(points *p, point *first)
{
    job of = { .p = p, .good = true };
    for (p->job = 1; of.before < p->frames; p->job++, of.before += of.frames) {
        if (!order_job(p, first, &of))
            return false;
        list_job(p, &of);
    }
    return true;
}

// Groups the frames of every `most` points. Within a group the order stays. False: out of memory.
static bool group(points *p, int64_t most)
{
    const int64_t groups = (p->run->point_count - 1) / most + 1;
    int64_t *sorted = malloc(((size_t)p->count + 1) * sizeof *sorted), *at = calloc((size_t)groups + 1, sizeof *at);
    if (sorted && at) {
        for (int64_t i = 0; i < p->count; i++)
            at[(p->list[i] - 1) / p->frames / most + 1]++;
        for (int64_t i = 0; i < groups; i++)
            at[i + 1] += at[i];
        for (int64_t i = 0; i < p->count; i++)
            sorted[at[(p->list[i] - 1) / p->frames / most]++] = p->list[i];
        free(p->list);
        p->list = sorted;
        sorted = NULL;
    }
    const bool good = !sorted && at;
    free(sorted);
    free(at);
    return good;
}

// Selects the frames of this shard, in order. False: out of memory.
static bool choose(points *p)
{
    int64_t from, to;
    if (!p->together && !group(p, 1))
        return false;
    glintL_selection_part(&p->run->request.selection, 1, p->run->total, &from, &to);
    p->count = to - from + 1;
    memmove(p->list, p->list + from - 1, (size_t)p->count * sizeof *p->list);
    p->most = p->together ? p->most : 1;
    return group(p, p->most);
}

// Returns how many states may be open. An eighth of the reuse memory must hold twice the memory of each script with its
// scene, measured as the growth of the process when the first state was opened.
static int most_together(const points *p, size_t first_bytes)
{
    const size_t count = glintL_run_reuse_bytes(p->run) / 8 / (2 * first_bytes + 1);
    return p->options->untrusted_s > 0 || count < 1 ? 1 : count < TOGETHER_MAX ? (int)count : TOGETHER_MAX;
}

// ---- Rendering ----

static int frame_protected(lua_State *L)
{
    points *p = lua_touserdata(L, 1);
    lua_rawgeti(L, LUA_REGISTRYINDEX, p->at_hand->script.jobs);
    glintL_jobs_frame(L, 2, p->run, &p->at_hand->jobs, p->frame);
    return 0;
}

static bool render_list(points *p)
{
    bool good = true;
    for (int64_t i = 0; i < p->count && good; i++) {
        const int64_t number = (p->list[i] - 1) / p->frames + 1;
        point *which = reach(p, number, &good);
        if (!which)
            continue;
        take(p, which);
        p->frame = (p->list[i] - 1) % p->frames + 1;
        which->has_frames = true;
        good = call(p, frame_protected) || goes_on(p, number);
    }
    for (int i = 0; i < TOGETHER_MAX; i++)
        good = close_point(p, &p->open[i]) && good;
    return good;
}

// Renders the frames of all points; the first is open. False: the run has failed.
static bool render_points(points *p, point *first)
{
    glintL_run *run = p->run;
    glint_error error;
    run->total = p->frames * run->point_count;
    if (!glintL_selection_settle(run, 1, run->total))
        return false;
    p->list = malloc(((size_t)run->total + 1) * sizeof *p->list);
    if (!p->list)
        return glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
    if (!list_jobs(p, first))
        return false;
    if (!choose(p))
        return glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
    for (int i = 0; i < TOGETHER_MAX && p->job > 2; i++) // plans of later jobs have changed shared scenes
        if (!close_point(p, &p->open[i]))
            return false;
    run->todo = p->count;
    if (!glintL_run_open(run, &error))
        return glintL_run_fail(run, glintL_run_exit_code(error.status), 0, "%s", error.message);
    const bool good = render_list(p);
    run->count = run->total;
    return good;
}

// Runs a script that renders by calls, point after point; the first has run already.
static bool run_calls(points *p, point *first)
{
    glintL_run *run = p->run;
    cli_script script;
    bool good = call(p, report_protected) && glintL_call_settle(run);
    first->has_frames = false;
    close_point(p, first);
    for (int64_t number = 2; number <= run->point_count && good; number++) {
        run->point = number;
        run->point_first = run->count;
        cli_sweep_to(p->options, run, number);
        good = cli_run_script(&script, p->options, run) && glintL_call_settle(run);
        cli_close_script(&script);
    }
    return good;
}

// Allocates the points and opens the first. NULL: out of memory, and the run has failed.
static points *create(cli_options *options, cli_output *output, glintL_run *run, point **first)
{
    points *p = calloc(1, sizeof *p);
    run->point_count = cli_sweep_points(options);
    unsigned char *failed = calloc((size_t)run->point_count, 1);
    if (!p || !failed) {
        free(p);
        free(failed);
        glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
        return NULL;
    }
    *p = (points) { .options = options, .output = output, .run = run, .failed = failed };
    const long long before = glintL_peak_bytes();
    *first = open_first(p);
    p->most = most_together(p, (size_t)(glintL_peak_bytes() - before));
    return p;
}

static void destroy(points *p)
{
    take(p, NULL);
    for (int i = 0; i < TOGETHER_MAX; i++) { // points that are still open after a failure
        p->open[i].has_frames = false;
        close_point(p, &p->open[i]);
    }
    free(p->list);
    free(p->failed);
    free(p);
}

bool cli_run_points(cli_options *options, cli_output *output, glintL_run *run, bool *reported)
{
    point *first;
    points *p = create(options, output, run, &first);
    bool good = p && first && (first->script.has_jobs ? render_points(p, first) : run_calls(p, first));
    if (!p)
        return false;
    *reported = p->has_failed && !run->exit_code && !run->interrupted;
    run->exit_code = *reported ? GLINTL_EXIT_USAGE : run->exit_code;
    good = good && !p->has_failed;
    destroy(p);
    return good;
}

bool cli_order_points(cli_options *options, cli_output *output, glintL_run *run)
{
    point *first;
    points *p = create(options, output, run, &first);
    if (!p)
        return false;
    const int64_t n = first ? (run->explain_frame - 1) % p->frames + 1 : 0;
    job of = { .p = p, .good = first != NULL };
    bool good = of.good;
    for (p->job = 1; good && of.before < n; p->job++, of.before += of.frames)
        good = order_job(p, first, &of);
    free(run->explain_order);
    run->explain_order = good ? malloc(sizeof p->order) : NULL;
    if (run->explain_order)
        *run->explain_order = p->order;
    good = !p->has_failed;
    destroy(p);
    return good;
}
