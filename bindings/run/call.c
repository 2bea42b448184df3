// scene:render{...}: one frame of a plain loop.
//
// Calls are numbered. Frame selection and shards skip the others. Under the command, files are written in the
// background while the script continues; in plain Lua a call returns when its file is written.
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "bindings/run/film.h"

#define PATH "scene:render: "
#define DEFAULT_FPS 24.0

int glintL_stop_script(lua_State *L)
{
    glintL_get_run(L)->is_stopped = true;
    lua_pushliteral(L, "the script ends here: nothing is rendered");
    return lua_error(L);
}

void glintL_check_may_render(lua_State *L, const glintL_run *run)
{
    if (run->mode == GLINTL_MODE_WATCH && run->point > 1)
        glintL_error(L, "--sweep: the script must return its frames at every value or at none, and must not fail at "
                        "the first value");
}

static void read_fields(lua_State *L, int index, glintL_render *render)
{
    *render = glintL_render_default();
    if (lua_isnoneornil(L, index))
        return;
    if (!lua_istable(L, index))
        glintL_refuse(L, index, "scene:render", "table");
    lua_pushnil(L);
    while (lua_next(L, index)) {
        if (lua_type(L, -2) != LUA_TSTRING)
            glintL_bad_key(L, "scene:render", -2);
        const char *name = lua_tostring(L, -2);
        int field = glintL_render_find(name);
        if (field < 0) {
            const char *near = glintL_nearest(name, glintL_render_fields);
            glintL_error(L, PATH "%s: no such field%s%s%s", name, near ? "; did you mean '" : "", near ? near : "",
                         near ? "'?" : "");
        }
        glintL_render_read(L, -1, PATH, field, render);
        lua_pop(L, 1);
    }
}

// Returns whether the numbered call is to be rendered. Shards take every Nth call, because the number of calls is not
// known.
static bool is_selected(glintL_run *run)
{
    const glintL_selection *selection = &run->request.selection;
    if (!glintL_selection_has(selection, run->count))
        return false;
    int64_t place = run->selected_calls++;
    return selection->shard_count == 0 || place % selection->shard_count == selection->shard - 1;
}

// ---- The name of the first call ----
//
// If the name in -o has no place for the number, it is used as it is when the script makes one call, and numbered when
// it makes several. The second call or the end of the script decides.

static bool is_open(const glintL_run *run, const glintL_render *render)
{
    return run->request.render_text[glintL_render_find("output")] && strcmp(render->output, "none") != 0 &&
           run->count == 1 && run->point_count <= 1 && !glintL_name_has_number(render->output) &&
           glintL_film_kind_of(render->output, run->request.apng) == GLINTL_FILM_NONE;
}

bool glintL_call_settle(glintL_run *run)
{
    glint_error error;
    glintL_work *work = run->deferred;
    if (!work)
        return true;
    run->deferred = NULL;
    glintL_naming naming = { .pattern = work->render.output, .is_numbered = run->count > 1 };
    bool good = glintL_work_name(work, &naming, &error) == GLINT_OK;
    if (!good)
        glintL_run_fail(run, GLINTL_EXIT_USAGE, work->index, "%s", error.message);
    else if (!run->request.force && run->request.repeat == 1 && glintL_work_is_kept(run, work))
        good = glintL_work_finish(run, work, true);
    else if (work->image)
        good = glintL_work_finish(run, work, false);
    else
        good = glintL_work_run(run, work, true);
    glintL_work_destroy(work);
    return good;
}

// ---- Rendering a call ----

static glintL_naming naming_of(const glintL_run *run, const glintL_render *render, bool is_numbered)
{
    bool writes = *render->output && strcmp(render->output, "none") != 0;
    bool request = run->request.render_text[glintL_render_find("output")] != NULL;
    // A name from the script belongs to its one call; a name from the command line is used for all calls.
    glintL_naming naming = { .pattern = writes ? render->output : NULL, .is_numbered = request && is_numbered };
    glintL_film_take(run, &naming);
    return naming;
}

// Returns whether the work's files exist, under either of the names that the first call could get.
static bool is_kept(glintL_run *run, glintL_work *work, bool open)
{
    glint_error error;
    if (run->request.force || run->request.repeat > 1)
        return false;
    for (int numbered = 0; numbered <= (open ? 1 : 0); numbered++) {
        glintL_naming naming = naming_of(run, &work->render, open ? numbered : true);
        if (glintL_work_name(work, &naming, &error) == GLINT_OK && glintL_work_is_kept(run, work))
            return true;
    }
    return false;
}

typedef struct called {
    const glint_scene *scene;
    int64_t number;
    bool writes, open;
    glintL_run *run;
} called;

static glintL_work *plan_again(void *context, const glintL_render *render)
{
    const called *call = context;
    glint_error error;
    glintL_work *work = NULL;
    if (glintL_work_create(call->scene, render, call->number, call->writes, true, &work, &error))
        glintL_run_fail(call->run, glintL_run_exit_code(error.status), call->number, "%s", error.message);
    return work;
}

static bool name_again(void *context, glintL_work *work)
{
    const called *call = context;
    glint_error error;
    glintL_naming naming = naming_of(call->run, &work->render, true);
    return !call->open && !naming.film && glintL_work_name(work, &naming, &error) == GLINT_OK;
}

// Replaces a planned work by one that is rendered with the samples that it needs. False: the run has failed.
static bool refine(glintL_run *run, const glint_scene *scene, bool open, glintL_work **work)
{
    called call = { scene, (*work)->index, *(*work)->render.output && strcmp((*work)->render.output, "none") != 0, open, run };
    const glintL_render render = (*work)->render;
    const glintL_frame_planner planner = { &render, plan_again, name_again, &call };
    glintL_work *refined = glintL_refine(run, &planner, call.number);
    if (!refined)
        return false;
    refined->build_ms = (*work)->build_ms;
    glintL_work_destroy(*work);
    *work = refined;
    return true;
}

// Renders and reports one call unless it is rendered, or finds its files, in which case the work has no picture. A first call with an
// undecided name is reported when the name is decided.
static bool render_call(glintL_run *run, glintL_work *work, bool open)
{
    glint_error error;
    if (run->measures)
        return glintL_work_measure(run, work);
    bool kept = is_kept(run, work, open);
    glintL_naming naming = naming_of(run, &work->render, true);
    if (glintL_work_name(work, &naming, &error))
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, work->index, "%s", error.message);
    const bool is_done = kept || work->image;
    if (!open)
        return is_done ? glintL_work_finish(run, work, kept) : glintL_work_run(run, work, true);
    if (!is_done && glintL_work_render(run, work, &error))
        return glintL_run_fail(run, glintL_run_exit_code(error.status), work->index, "%s", error.message);
    return true;
}

static int raise_failure(lua_State *L, glintL_run *run)
{
    return glintL_error(L, PATH "%s", run->interrupted ? "interrupted" : run->message);
}

// Gives the rendered image to the handle at `first`. If the file exists, gives the plan to the handle at `first` + 1
// instead. Leaves the handle that it filled on top. Does not raise.
static glint_status fill_handle(lua_State *L, int first, const glint_scene *scene, glintL_work *work, bool open,
                                glint_error *error)
{
    glint_plan *plan = work->plan;
    if (work->image) {
        ((glintL_box *)lua_touserdata(L, first))->object = glint_image_retain(work->image);
        lua_settop(L, first);
        return GLINT_OK;
    }
    if (open) { // the work needs its own plan later
        glint_status status = glintL_orbit_plan(scene, &work->render.orbit, &work->render.desc, NULL, &plan, error);
        if (status)
            return status;
    } else {
        work->plan = NULL;
    }
    glintL_set_kept_plan(L, first + 1, plan);
    return GLINT_OK;
}

// Opens the film for the call's frame, if there is one.
static void open_film(lua_State *L, glintL_run *run, const glintL_render *render)
{
    char message[GLINTL_MESSAGE_SIZE];
    const char *path = *render->output ? render->output : "none";
    if (!run->is_command && glintL_film_kind_of(path, false) != GLINTL_FILM_NONE)
        glintL_error(L, PATH "output: '%s' is a film; to make a film, use animation:run or the glint command", path);
    if (!glintL_film_open(run, path, render, DEFAULT_FPS, message))
        glintL_error(L, PATH "%s", message);
}

static int render_selected(lua_State *L, glintL_run *run, const glint_scene *scene, const glintL_render *render)
{
    glint_error error;
    glintL_work *work = NULL;
    double build_ms = glintL_now_ms() - run->since_ms;
    open_film(L, run, render);
    glintL_find_source(L, run);
    bool writes = naming_of(run, render, true).pattern != NULL;
    glintL_observe_frame(L, run, 1, &render->desc, run->count);
    if (run->exit_code)
        return raise_failure(L, run);
    int first = lua_gettop(L) + 1; // handles are made before the objects, so that nothing leaks
    glintL_new_box(L, GLINTL_IMAGE);
    glintL_push_kept_image(L);
    if (!glintL_run_open(run, &error) || glintL_work_create(scene, render, run->count, writes, true, &work, &error))
        return glintL_error(L, PATH "%s", error.message);
    work->build_ms = build_ms;
    if (glint_camera_get(glint_scene_get(scene)->camera)->shutter > 0)
        glintL_warn_of_shutter(run);
    bool open = !run->measures && is_open(run, render);
    bool good = (!glintL_run_refines(run) || refine(run, scene, open, &work)) && render_call(run, work, open);
    if (good)
        glintL_look_for_black(run, scene, work);
    if (good && fill_handle(L, first, scene, work, open, &error))
        good = glintL_run_fail(run, GLINTL_EXIT_FAILED, run->count, "%s", error.message);
    if (good && open)
        run->deferred = work;
    else
        glintL_work_destroy(work);
    if (!run->is_command)
        good = glintL_run_collect(run, true) && good;
    run->since_ms = glintL_now_ms();
    if (!good)
        return raise_failure(L, run);
    glintL_charge(L, (size_t)render->desc.width * (size_t)render->desc.height * 16);
    return 1;
}

int glintL_render_call(lua_State *L, glint_scene *scene, int index)
{
    glintL_run *run = glintL_get_run(L);
    glintL_render render;
    luaL_checkstack(L, 16, "render");
    if (run->mode == GLINTL_MODE_DESCRIBE)
        return glintL_stop_script(L);
    if (run->in_frame)
        return glintL_error(L, PATH "not inside the frame function of an animation");
    glintL_check_may_render(L, run);
    if (!run->is_command)
        run->exit_code = 0;
    else if (run->exit_code)
        return raise_failure(L, run);
    if (glintL_push_unknown_set(L))
        return lua_error(L);
    read_fields(L, lua_absindex(L, index), &render);
    glintL_run_apply(run, &render);
    run->count++;
    run->call_count++;
    if (run->deferred && !glintL_call_settle(run))
        return raise_failure(L, run);
    glintL_trace_scene(L, scene);
    glintL_update_curves(L, scene);
    glintL_find_derivatives(L, scene, &render);
    glintL_render_point(&render);
    if (run->mode == GLINTL_MODE_EXPLAIN && run->count == run->explain_frame) {
        glint_error error;
        if (glintL_orbit_plan(scene, &render.orbit, &render.desc, NULL, &run->explain_plan, &error))
            return glintL_error(L, PATH "%s", error.message);
        glintL_run_keep_scene(L, run, scene, &render);
        return glintL_stop_script(L);
    }
    if (run->keeps_scene && run->count == run->explain_frame - 1) {
        glint_error error;
        glint_render_desc desc = render.desc;
        desc.codes = !glintL_name_is_linear(render.output);
        desc.passes = desc.codes ? 0 : 1u << GLINT_PASS_BEAUTY;
        desc.derivative_count = 0;
        desc.light_passes = NULL;
        if (glint_plan_create(scene, &desc, &run->retained_neighbour, &error))
            return glintL_error(L, PATH "%s", error.message);
    }
    if (run->mode == GLINTL_MODE_EXPLAIN || !is_selected(run)) {
        run->since_ms = glintL_now_ms();
        lua_pushnil(L);
        lua_pushliteral(L, "skipped");
        return 2;
    }
    return render_selected(L, run, scene, &render);
}
