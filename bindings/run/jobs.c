// Frames of animations and sweeps: numbered through a list, selected, and rendered in the order that costs least.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/order.h"
#include "bindings/run/sheet.h"
#include "bindings/run/system.h"
#include "bindings/run/walk.h"
#include "engine/glint_figures.h"

#define WAITING_MAX 4096 // frames that may be planned before they are rendered

// ---- The results of a script ----

static bool push_expected(lua_State *L, int index)
{
    const char *got = glintL_push_spelling(L, index);
    lua_pushfstring(L, "the script returned %s; an animation, a sweep, a scene, a chart or a list of them is expected", got);
    return false;
}

bool glintL_push_chart_scene(lua_State *L, int index)
{
    const glint_overlay *chart = glintL_test_object(L, index, GLINTL_OVERLAY);
    if (!chart || glint_overlay_get(chart)->kind != GLINT_OVERLAY_CHART)
        return false;
    luaL_checkstack(L, 6, "chart");
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_getfield(L, -1, "glint");
    lua_getfield(L, -1, "scene");
    lua_createtable(L, 1, 1);
    lua_pushvalue(L, index);
    lua_rawseti(L, -2, 1);
    glintL_set_whole(L, "background", 1);
    lua_call(L, 1, 1);
    lua_replace(L, -3);
    lua_pop(L, 1);
    return true;
}

// Pushes the job for one value; false: it is not a job, and nothing is pushed. A scene or a chart becomes a still.
static bool push_one(lua_State *L, int index)
{
    index = lua_absindex(L, index);
    if (glintL_push_chart_scene(L, index)) {
        push_one(L, -1);
        lua_remove(L, -2);
        return true;
    }
    if (luaL_testudata(L, index, GLINTL_ANIMATION)) {
        lua_pushvalue(L, index);
        return true;
    }
    if (!glintL_test_object(L, index, GLINTL_SCENE))
        return false;
    glintL_push_job(L, GLINTL_JOB_ANIMATION);
    lua_pushvalue(L, index);
    lua_setiuservalue(L, -2, GLINTL_JOB_SCENE);
    return true;
}

bool glintL_push_jobs(lua_State *L, int index)
{
    index = lua_absindex(L, index);
    luaL_checkstack(L, 8, "jobs");
    lua_newtable(L);
    int list = lua_gettop(L);
    if (push_one(L, index)) {
        lua_rawseti(L, list, 1);
        return true;
    }
    if (!lua_istable(L, index))
        return push_expected(L, index);
    size_t count = glintL_check_list(L, index, "the list that the script returned", false);
    for (size_t i = 1; i <= count; i++) {
        lua_rawgeti(L, index, (lua_Integer)i);
        if (!push_one(L, -1))
            return push_expected(L, -1);
        lua_rawseti(L, list, (lua_Integer)i);
        lua_settop(L, list);
    }
    if (count == 0)
        lua_pushliteral(L, "the script returned an empty list; it renders nothing");
    return count > 0;
}

int64_t glintL_jobs_total(lua_State *L, int index)
{
    int64_t total = 0;
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, index); i++)
        total += glintL_walk_get_job(L, index, i)->frames;
    return total;
}

// ---- The list ----

// The frames to render: the selected frames at positions from .. to.
typedef struct part {
    int64_t from, to, position; // positions of the part; position: the last frame passed
} part;

static part open_part(glintL_run *run, int64_t frames)
{
    part p;
    const int64_t first = run->count + 1, last = run->count + frames;
    glintL_selection_part(&run->request.selection, first, last, &p.from, &p.to);
    p.position = glintL_selection_count(&run->request.selection, first, run->count);
    run->total = last;
    run->todo += p.to - p.from + 1; // the part may be empty: to = from - 1
    return p;
}

// Takes the next frame number, in the order of rendering. Returns whether this run renders the frame.
static bool takes(const glintL_run *run, part *p, int64_t number)
{
    if (!glintL_selection_has(&run->request.selection, number))
        return false;
    p->position++;
    return p->position >= p->from && p->position <= p->to;
}

// Returns whether the run renders several frames of the current job, whose first frame has that number, and may render
// them in any order.
static bool may_reorder(const glintL_walk *walk, int64_t first, const part *p)
{
    const int64_t last = first + walk->job->frames - 1;
    const int64_t count = glintL_selection_count(&walk->run->request.selection, first, last);
    const char *pattern = walk->naming.pattern;
    return count > 2 && p->position < p->to && p->position + count >= p->from &&
           !(pattern && glintL_name_is_special(pattern));
}

static bool run_job(glintL_walk *walk, lua_Integer i, part *p)
{
    glintL_run *run = walk->run;
    glintL_order order;
    const int64_t first = run->count + 1;
    glintL_walk_begin(walk, i);
    bool good = glintL_walk_open_film(walk);
    glintL_order_init(&order);
    glintL_walk_add_axes(walk, &order);
    if (good && glintL_order_is_grid(&order) && may_reorder(walk, first, p)) {
        good = glintL_walk_settle(walk, i, first);
        if (good)
            glintL_order_find(&order, glintL_walk_probe, walk);
    }
    for (int64_t position = 0; position < walk->job->frames && good; position++) {
        const int64_t n = glintL_order_frame(&order, position), number = first + n - 1;
        if (!takes(run, p, number))
            continue;
        good = !run->interrupted && glintL_walk_settle(walk, i, first) && glintL_walk_render(walk, n, number);
        if (n == walk->job->frames)
            walk->settled = i;
    }
    run->count += walk->job->frames;
    if (walk->job->kind == GLINTL_JOB_SWEEP)
        good = glintL_walk_call(walk, glintL_walk_restore, 0, run->count) && good;
    if (walk->job->kind == GLINTL_JOB_SWEEP && good && !run->interrupted)
        good = glintL_walk_make_sheet(walk, first);
    lua_settop(walk->L, walk->job_index - 1);
    return good;
}

// ---- Animations of one scene, such as one for each shininess ----

// Frames that are planned and not yet rendered. A plan is a snapshot, so the script builds all frames in the order of
// their numbers, and the frames are rendered in the order that costs least.
typedef struct waiting {
    glintL_work **works; // owned; NULL: rendered, or not selected
    int64_t frames, count; // number of frames of each job, and of all jobs
    bool has_rendered; // some frame has been rendered
    bool in_order; // frames no longer wait
    long long most_bytes; // memory limit of the process while frames wait
} waiting;

// Returns how many jobs from job i on are animations of the same scene with the same number of frames, and may wait
// together.
static lua_Integer count_together(const glintL_walk *walk, lua_Integer i)
{
    lua_State *L = walk->L;
    const int top = lua_gettop(L);
    const glintL_job *first = glintL_walk_get_job(L, walk->list, i);
    lua_Integer j = i;
    lua_rawgeti(L, walk->list, i);
    lua_getiuservalue(L, top + 1, GLINTL_JOB_SCENE);
    for (bool same = true; same; lua_settop(L, top + 2)) {
        const glintL_job *job = lua_rawgeti(L, walk->list, ++j) == LUA_TNIL ? NULL : lua_touserdata(L, -1);
        same = job && job->kind == GLINTL_JOB_ANIMATION && first->kind == job->kind && job->frames == first->frames;
        if (same)
            lua_getiuservalue(L, top + 3, GLINTL_JOB_SCENE);
        same = same && lua_rawequal(L, top + 2, -1);
    }
    lua_settop(L, top);
    return (j - i) * first->frames <= WAITING_MAX ? j - i : 1;
}

// Returns whether frames of the current job may be rendered after frames of later jobs.
static bool may_wait(const glintL_walk *walk)
{
    const glintL_run *run = walk->run;
    const char *pattern = walk->naming.pattern;
    return !run->measures && !run->keeps_images && run->request.repeat == 1 && walk->render.derivative_count == 0 &&
           !walk->naming.film && !(pattern && glintL_name_is_special(pattern));
}

// Returns whether the step to the same frame of the next job costs less than the step to the next frame.
static bool costs_less_between_jobs(const waiting *w)
{
    double cost[2] = { 0, 0 };
    int64_t steps[2] = { 0, 0 };
    uint64_t stages;
    for (int64_t at = 1; at < w->count; at++)
        for (int between_jobs = 0; between_jobs < 2; between_jobs++) {
            const int64_t before = at - (between_jobs ? w->frames : 1);
            if (before < 0 || (!between_jobs && at % w->frames == 0) || !w->works[at] || !w->works[before])
                continue;
            cost[between_jobs] += glint_plan_work_after(w->works[at]->plan, w->works[before]->plan, &stages);
            steps[between_jobs]++;
        }
    return steps[0] > 0 && steps[1] > 0 && cost[1] / (double)steps[1] < cost[0] / (double)steps[0];
}

// Renders the waiting frames. False: the run has failed.
static bool render_waiting(glintL_walk *walk, waiting *w, const glint_scene *scene)
{
    glintL_run *run = walk->run;
    const int64_t jobs = w->count / w->frames;
    const bool transposed = costs_less_between_jobs(w);
    const int failed = run->exit_code; // a later frame could not be planned: the frames before it are rendered all the same
    bool good = !run->interrupted;
    run->exit_code = GLINTL_EXIT_DONE;
    for (int64_t i = 0; i < w->count; i++) {
        glintL_work **work = &w->works[transposed ? i % jobs * w->frames + i / jobs : i];
        good = good && (!*work || (!run->interrupted && glintL_work_run(run, *work, run->request.force)));
        if (good && *work && scene)
            glintL_look_for_black(run, scene, *work);
        glintL_work_destroy(*work);
        *work = NULL;
    }
    run->exit_code = run->exit_code ? run->exit_code : failed;
    return good && !failed;
}

// Plans frame n of the current job, and renders it unless it can wait. The first frame never waits. False: the run has
// failed.
static bool plan_waiting(glintL_walk *walk, waiting *w, int64_t at, int64_t n, int64_t number)
{
    if (w->has_rendered && !w->in_order && (!may_wait(walk) || glintL_peak_bytes() > w->most_bytes)) {
        w->in_order = true;
        if (!render_waiting(walk, w, glintL_walk_scene(walk)))
            return false;
    }
    if (w->has_rendered && !w->in_order)
        return (w->works[at] = glintL_walk_prepare(walk, n, number)) != NULL;
    w->has_rendered = true;
    const bool good = glintL_walk_render(walk, n, number);
    w->most_bytes = w->most_bytes ? w->most_bytes : glintL_peak_bytes() + (long long)(glintL_run_reuse_bytes(walk->run) / 8);
    return good;
}

// Renders `jobs` animations of one scene, from job i on. False: the run has failed.
static bool run_together(glintL_walk *walk, lua_Integer i, lua_Integer jobs, part *p)
{
    glintL_run *run = walk->run;
    const glint_scene *scene = NULL;
    waiting w = { .frames = glintL_walk_get_job(walk->L, walk->list, i)->frames };
    w.count = (int64_t)jobs * w.frames;
    w.works = calloc((size_t)w.count, sizeof(glintL_work *));
    bool good = w.works || glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
    for (lua_Integer j = 0; j < jobs && good; j++) {
        const int64_t first = run->count + 1;
        glintL_walk_begin(walk, i + j);
        good = glintL_walk_open_film(walk);
        for (int64_t n = 1; n <= w.frames && good; n++) {
            if (!takes(run, p, first + n - 1))
                continue;
            good = !run->interrupted && glintL_walk_settle(walk, i + j, first) &&
                   plan_waiting(walk, &w, j * w.frames + n - 1, n, first + n - 1);
            if (n == w.frames)
                walk->settled = i + j;
        }
        run->count += w.frames;
        scene = glintL_walk_scene(walk);
        lua_settop(walk->L, walk->job_index - 1);
    }
    good = w.works && render_waiting(walk, &w, scene) && good;
    free(w.works);
    return good;
}

bool glintL_jobs_run(lua_State *L, int index, glintL_run *run)
{
    glint_error error;
    int top = lua_gettop(L);
    glintL_walk *walk = glintL_push_walk(L, index, run);
    part p = open_part(run, glintL_jobs_total(L, walk->list));
    glintL_find_source(L, run);
    bool good = !run->exit_code && glintL_run_open(run, &error);
    if (!good && !run->exit_code)
        glintL_run_fail(run, glintL_run_exit_code(error.status), 0, "%s", error.message);
    for (lua_Integer i = 1, jobs = 1; i <= (lua_Integer)lua_rawlen(L, walk->list) && good; i += jobs) {
        jobs = count_together(walk, i);
        good = jobs > 1 ? run_together(walk, i, jobs, &p) : run_job(walk, i, &p);
    }
    run->earlier += good ? 1 : 0;
    lua_settop(L, top);
    return good;
}

// Shows the scene at the times of a shutter with `times` moments. False: the run has failed.
static bool show_times(glintL_walk *walk, int64_t n, double share, int times)
{
    glintL_run *run = walk->run;
    for (int k = 0; k < times; k++) {
        walk->time = glintL_job_shutter_time(walk->job, n, share, k, times);
        glint_scene *scene = glintL_walk_call(walk, glintL_walk_build, n, run->explain_frame) ? glintL_walk_open_scene(walk, run->explain_frame) : NULL;
        if (!scene)
            return false;
        if (!run->moments.see(run->moments.data, scene, times, k))
            return glintL_run_fail(run, GLINTL_EXIT_FAILED, run->explain_frame, "out of memory");
    }
    return true;
}

// Shows the scene for every number of moments that the run asks for, if the shutter is open. False: the run has failed.
static bool show_moments(glintL_walk *walk, int64_t n)
{
    glintL_run *run = walk->run;
    const glint_camera_desc camera = *glint_camera_get(glint_scene_get(glintL_walk_scene(walk))->camera);
    if (!run->moments.see || camera.shutter == 0 || !glintL_walk_moves(walk))
        return true;
    bool good = show_times(walk, n, camera.shutter, (int)camera.shutter_times);
    for (size_t i = 0; i < run->moments.count && good; i++)
        good = run->moments.counts[i] == (int)camera.shutter_times || show_times(walk, n, camera.shutter, run->moments.counts[i]);
    if (!good || !glintL_walk_build_frame(walk, n, run->explain_frame) || !glintL_walk_open_scene(walk, run->explain_frame))
        return false;
    return run->moments.see(run->moments.data, glintL_walk_scene(walk), 0, 0) ||
           glintL_run_fail(run, GLINTL_EXIT_FAILED, run->explain_frame, "out of memory");
}

// Plans frame n of the current job. Stores its scene and the plan of a neighbouring frame if the run requests them.
static void explain_frame(glintL_walk *walk, int64_t n)
{
    glintL_run *run = walk->run;
    const bool keeps = run->keeps_scene && walk->job->frames > 1;
    glintL_work *next = keeps ? glintL_walk_plan(walk, n > 1 ? n - 1 : 2, run->explain_frame) : NULL;
    glintL_work *work = keeps && !next ? NULL : glintL_walk_plan(walk, n, run->explain_frame);
    if (work && walk->job->kind == GLINTL_JOB_SWEEP && !run->keeps_scene && !run->see_scene) {
        run->explain_order = malloc(sizeof *run->explain_order);
        if (run->explain_order) {
            glintL_order_init(run->explain_order);
            glintL_walk_add_axes(walk, run->explain_order);
            glintL_order_find(run->explain_order, glintL_walk_probe, walk);
        }
    }
    if (work && show_moments(walk, n)) {
        run->explain_plan = work->plan;
        work->plan = NULL;
        glintL_run_keep_scene(walk->L, run, glintL_walk_scene(walk), &walk->render);
    }
    if (next) {
        run->retained_neighbour = next->plan;
        next->plan = NULL;
    }
    glintL_work_destroy(work);
    glintL_work_destroy(next);
}

bool glintL_jobs_explain(lua_State *L, int index, glintL_run *run)
{
    int top = lua_gettop(L);
    glintL_walk *walk = glintL_push_walk(L, index, run);
    int64_t n = run->explain_frame - run->count, total = glintL_jobs_total(L, walk->list);
    for (lua_Integer i = 1; n >= 1 && n <= total; i++) {
        glintL_walk_begin(walk, i);
        if (n <= walk->job->frames) {
            if (glintL_walk_settle(walk, i, run->explain_frame - n + 1))
                explain_frame(walk, n);
            break;
        }
        n -= walk->job->frames;
        lua_settop(L, walk->job_index - 1);
    }
    lua_settop(L, top);
    run->count += total;
    return run->explain_plan != NULL;
}
