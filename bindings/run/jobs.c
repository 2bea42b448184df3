// Frames of animations and sweeps: numbered through a list of them, selected, rendered in the order that costs least.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/order.h"
#include "bindings/run/sheet.h"
#include "bindings/run/walk.h"

// ---- What a script returned ----

static bool push_expected(lua_State *L, int index)
{
    const char *got = glintL_push_spelling(L, index);
    lua_pushfstring(L, "the script returned %s; an animation, a sweep, a scene or a list of them is expected", got);
    return false;
}

// Pushes the job that one value stands for; false: it is none, and nothing is pushed. A scene is a still.
static bool push_one(lua_State *L, int index)
{
    index = lua_absindex(L, index);
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

// Which frames to render: those selected from first to last, of these the ones at places from .. to.
typedef struct part {
    int64_t from, to, place; // place: of the last frame passed
} part;

static part open_part(glintL_run *run, int64_t frames)
{
    part p;
    const int64_t first = run->count + 1, last = run->count + frames;
    glintL_selection_part(&run->request.selection, first, last, &p.from, &p.to);
    p.place = glintL_selection_count(&run->request.selection, first, run->count);
    run->total = last;
    run->todo += p.to - p.from + 1; // the part may be empty: to = from - 1
    return p;
}

// Whether the run renders several frames of the job at hand, whose first frame has that number, and may do so in any order.
static bool may_reorder(const glintL_walk *walk, int64_t first, const part *p)
{
    const int64_t last = first + walk->job->frames - 1;
    const int64_t count = glintL_selection_count(&walk->run->request.selection, first, last);
    const char *pattern = walk->naming.pattern;
    return count > 2 && p->place < p->to && p->place + count >= p->from && !(pattern && glintL_name_is_special(pattern));
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
    for (int64_t place = 0; place < walk->job->frames && good; place++) {
        const int64_t n = glintL_order_frame(&order, place), number = first + n - 1;
        if (!glintL_selection_has(&run->request.selection, number))
            continue;
        p->place++;
        if (p->place < p->from || p->place > p->to)
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
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, walk->list) && good; i++)
        good = run_job(walk, i, &p);
    run->earlier += good ? 1 : 0;
    lua_settop(L, top);
    return good;
}

// Shows the scene at the times of a shutter that looks so often. False: the run has failed.
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

// The same of each shutter that the run is to see, where it is open. False: the run has failed.
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

// Plans frame n of the job at hand, and keeps its scene and the plan of a frame next to it when the run is to.
static void explain_frame(glintL_walk *walk, int64_t n)
{
    glintL_run *run = walk->run;
    const bool keeps = run->keeps_scene && walk->job->frames > 1;
    glintL_work *next = keeps ? glintL_walk_plan(walk, n > 1 ? n - 1 : 2, run->explain_frame) : NULL;
    glintL_work *work = keeps && !next ? NULL : glintL_walk_plan(walk, n, run->explain_frame);
    if (work && walk->job->kind == GLINTL_JOB_SWEEP && !run->keeps_scene) {
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
        glintL_run_keep_scene(run, glintL_walk_scene(walk), &walk->render);
    }
    if (next) {
        run->kept_neighbour = next->plan;
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
