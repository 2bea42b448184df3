// Renders the frames of a list of jobs in any order, and provides the axes of the frames.
#include <stdio.h>
#include <string.h>

#include "bindings/run/carried.h"
#include "bindings/run/order.h"
#include "bindings/run/sheet.h"
#include "bindings/run/walk.h"

glintL_walk *glintL_push_walk(lua_State *L, int index, glintL_run *run)
{
    int list = lua_absindex(L, index);
    luaL_checkstack(L, 16, "jobs");
    glintL_walk *walk = lua_newuserdatauv(L, sizeof *walk, 0);
    memset(walk, 0, sizeof *walk);
    walk->L = L;
    walk->run = run;
    walk->list = list;
    glintL_give_cameras(L, list, run);
    return walk;
}

bool glintL_walk_make_sheet(glintL_walk *walk, int64_t first)
{
    const glintL_selection *request = &walk->run->request.selection;
    bool partial = request->range_count > 0 || request->shard_count > 1;
    if (!walk->naming.pattern || walk->run->no_sheets)
        return true;
    return glintL_sweep_make_sheet(walk->L, walk->job_index, &walk->naming, first, partial);
}

glint_plan *glintL_walk_probe(void *context, int64_t n)
{
    glintL_walk *walk = context;
    lua_State *L = walk->L;
    glint_error error;
    glint_plan *plan = NULL;
    glint_render_desc desc = walk->render.desc;
    walk->time = glintL_job_time(walk->job, n);
    lua_pushcfunction(L, glintL_walk_build);
    lua_pushvalue(L, walk->job_index);
    lua_pushinteger(L, n);
    lua_pushlightuserdata(L, walk);
    walk->run->in_frame = true;
    const bool good = lua_pcall(L, 3, 0, 0) == LUA_OK;
    walk->run->in_frame = false;
    lua_settop(L, walk->job_index);
    const glint_scene *scene = good ? glintL_walk_scene(walk) : NULL;
    desc.codes = true;
    desc.derivative_count = 0;
    desc.light_passes = NULL;
    return scene && glint_plan_create(scene, &desc, &plan, &error) == GLINT_OK ? plan : NULL;
}

void glintL_walk_add_axes(glintL_walk *walk, glintL_order *order)
{
    lua_State *L = walk->L;
    if (walk->job->kind != GLINTL_JOB_SWEEP) {
        glintL_order_axis *frames = glintL_order_add(order, walk->job->frames);
        frames->is_forward = true;
        snprintf(frames->name, sizeof frames->name, "frame");
        return;
    }
    lua_getiuservalue(L, walk->job_index, GLINTL_JOB_FRAME);
    const int axes = lua_gettop(L);
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, axes); i++) {
        lua_rawgeti(L, axes, i);
        lua_rawgeti(L, -1, 3); // the values
        glintL_order_axis *axis = glintL_order_add(order, (int64_t)lua_rawlen(L, -1));
        lua_pushvalue(L, axes);
        lua_pushinteger(L, i);
        glintL_call_own(L, "sweep", "title_of_axis", 2, 1);
        snprintf(axis->name, sizeof axis->name, "%s", lua_tostring(L, -1));
        lua_settop(L, axes);
    }
    lua_settop(L, walk->job_index);
}

// ---- Frames of a list, one at a time ----

// Makes the job that contains frame g of the list the current one. Returns the job's number; *n: the frame's number in
// the job.
static lua_Integer take_frame(glintL_walk *walk, int64_t g, int64_t *n)
{
    lua_Integer i = 1;
    for (*n = g; *n > glintL_walk_get_job(walk->L, walk->list, i)->frames; i++)
        *n -= glintL_walk_get_job(walk->L, walk->list, i)->frames;
    glintL_walk_begin(walk, i);
    return i;
}

// Restores the values that the current sweep changed. False: the run has failed.
static bool end_sweep(glintL_walk *walk, glintL_jobs_state *state)
{
    const lua_Integer i = state->sweeping;
    state->sweeping = 0;
    if (i == 0)
        return true;
    glintL_walk_begin(walk, i);
    const bool good = glintL_walk_call(walk, glintL_walk_restore, 0, 0);
    lua_settop(walk->L, walk->job_index - 1);
    return good;
}

// Takes the job that contains frame g, with the scene as the previous jobs leave it. False: the run has failed.
static bool reach(glintL_walk *walk, int64_t g, glintL_jobs_state *state, int64_t *n)
{
    const int top = lua_gettop(walk->L);
    lua_Integer i = take_frame(walk, g, n);
    if (state->sweeping != i) {
        lua_settop(walk->L, top);
        if (!end_sweep(walk, state))
            return false;
        take_frame(walk, g, n);
    }
    walk->settled = state->settled;
    const bool good = glintL_walk_settle(walk, i, walk->run->point_first + 1 + g - *n);
    state->settled = walk->settled;
    state->sweeping = walk->job->kind == GLINTL_JOB_SWEEP ? i : 0;
    return good;
}

bool glintL_jobs_frame(lua_State *L, int index, glintL_run *run, glintL_jobs_state *state, int64_t g)
{
    const int top = lua_gettop(L);
    int64_t n;
    glintL_walk *walk = glintL_push_walk(L, index, run);
    glintL_find_source(L, run);
    const bool good = reach(walk, g, state, &n) && glintL_walk_open_film(walk) && glintL_walk_render(walk, n, run->point_first + g);
    lua_settop(L, top);
    return good;
}

glint_plan *glintL_jobs_probe(lua_State *L, int index, glintL_run *run, glintL_jobs_state *state, int64_t g)
{
    const int top = lua_gettop(L);
    int64_t n;
    glintL_walk *walk = glintL_push_walk(L, index, run);
    glint_plan *plan = reach(walk, g, state, &n) ? glintL_walk_probe(walk, n) : NULL;
    lua_settop(L, top);
    return plan;
}

bool glintL_jobs_axes(lua_State *L, int index, glintL_run *run, int64_t i, glintL_order *order)
{
    const int top = lua_gettop(L);
    glintL_walk *walk = glintL_push_walk(L, index, run);
    if (i <= (int64_t)lua_rawlen(L, walk->list)) {
        glintL_walk_begin(walk, i);
        glintL_walk_add_axes(walk, order);
    }
    const bool in_order = walk->naming.pattern && glintL_name_is_special(walk->naming.pattern);
    lua_settop(L, top);
    return !in_order;
}

bool glintL_jobs_end(lua_State *L, int index, glintL_run *run, glintL_jobs_state *state)
{
    const int top = lua_gettop(L);
    glintL_walk *walk = glintL_push_walk(L, index, run);
    int64_t first = run->point_first + 1;
    bool good = end_sweep(walk, state);
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, walk->list) && good; i++) {
        glintL_walk_begin(walk, i);
        if (walk->job->kind == GLINTL_JOB_SWEEP)
            good = glintL_walk_make_sheet(walk, first);
        first += walk->job->frames;
        lua_settop(L, walk->job_index - 1);
    }
    lua_settop(L, top);
    return good;
}
