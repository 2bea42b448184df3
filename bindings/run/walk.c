// One frame of a list of jobs: builds its scene, plans it at its times, and renders it.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/film.h"
#include "bindings/run/walk.h"

const glintL_job *glintL_walk_get_job(lua_State *L, int index, lua_Integer i)
{
    lua_rawgeti(L, index, i);
    const glintL_job *job = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return job;
}

// Reduces the picture to the run's preview size and shape, for speed.
static void shrink(glintL_run *run, glint_render_desc *desc)
{
    double longest = desc->width > desc->height ? desc->width : desc->height;
    double scale = longest > run->preview_side ? run->preview_side / longest : 1;
    run->was_shrunk = run->was_shrunk || scale < 1 || desc->samples > 1;
    desc->samples = 1;
    memset(desc->region, 0, sizeof desc->region);
    desc->width = scale < 1 ? fmax(1, floor(desc->width * scale + 0.5)) : desc->width;
    desc->height = scale < 1 ? fmax(1, floor(desc->height * scale + 0.5)) : desc->height;
}

void glintL_run_apply(glintL_run *run, glintL_render *render)
{
    char message[GLINTL_MESSAGE_SIZE];
    for (int field = 0; field < GLINTL_RENDER_FIELDS; field++)
        if (run->request.render_text[field]) // it was checked when it was read
            glintL_render_set_text(render, field, run->request.render_text[field], message);
    const glintL_folder_light *folder = *render->output ? glintL_find_folder(run, render->output) : NULL;
    if (folder && *folder->stops)
        glintL_render_set_text(render, glintL_render_find("exposure"), folder->stops, message);
    render->own_samples = render->desc.samples;
    if (run->preview_side > 0)
        shrink(run, &render->desc);
    render->desc.samples = fmax(render->desc.samples, run->least_samples);
    if (run->most_samples > 0)
        render->desc.samples = fmin(render->desc.samples, run->most_samples);
    if (run->renders_partner)
        glintL_render_be_partner(render);
    if (run->measures)
        memset(render->desc.region, 0, sizeof render->desc.region);
}

void glintL_run_default_name(const glintL_run *run, char pattern[GLINTL_PATH_SIZE])
{
    size_t length = strlen(run->script);
    if (length > 4 && strcmp(run->script + length - 4, ".lua") == 0)
        length -= 4;
    snprintf(pattern, GLINTL_PATH_SIZE, "%.*s.png", length ? (int)length : 5, length ? run->script : "frame");
}

// Returns the name pattern of the job's pictures, from the command line, otherwise from the script.
static const char *output_of(const glintL_run *run, const glintL_job *job)
{
    const char *text = run->request.render_text[glintL_render_find("output")];
    return text ? text : job->render.output;
}

// Returns whether several frames of the whole script use this job's name pattern. Allocates nothing: the result decides
// a name.
static bool is_shared(const glintL_walk *walk)
{
    const char *output = output_of(walk->run, walk->job);
    int64_t frames = 0;
    if (walk->run->call_count > 0 || walk->run->point_count > 1)
        return true;
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(walk->L, walk->list); i++) {
        const glintL_job *job = glintL_walk_get_job(walk->L, walk->list, i);
        if (strcmp(output_of(walk->run, job), output) == 0)
            frames += job->frames;
    }
    return frames > 1 || walk->run->earlier > 0;
}

// Makes job i of the list the current one and leaves it on top of the stack.
static void take_job(glintL_walk *walk, lua_Integer i)
{
    lua_rawgeti(walk->L, walk->list, i);
    walk->job_index = lua_gettop(walk->L);
    walk->job = lua_touserdata(walk->L, -1);
}

void glintL_walk_begin(glintL_walk *walk, lua_Integer i)
{
    take_job(walk, i);
    walk->render = walk->job->render;
    glintL_run_apply(walk->run, &walk->render);
    walk->naming = (glintL_naming) { .pattern = walk->render.output, .is_numbered = is_shared(walk) };
    if (strcmp(walk->render.output, "none") == 0) {
        walk->naming.pattern = NULL;
    } else if (!*walk->render.output) {
        glintL_run_default_name(walk->run, walk->pattern);
        walk->naming.pattern = walk->pattern;
        walk->naming.is_plain = true;
    }
}

bool glintL_walk_open_film(glintL_walk *walk)
{
    char message[GLINTL_MESSAGE_SIZE];
    const char *path = walk->naming.pattern ? walk->naming.pattern : "none";
    if (!glintL_film_open(walk->run, path, &walk->render, walk->job->fps, message))
        return glintL_run_fail(walk->run, GLINTL_EXIT_USAGE, 0, "%s", message);
    glintL_film_take(walk->run, &walk->naming);
    return true;
}

int glintL_walk_build(lua_State *L)
{
    const glintL_walk *walk = lua_touserdata(L, 3);
    glintL_job_build(L, 1, lua_tointeger(L, 2), walk->time);
    return 0;
}

// Finds the slopes of the job's scene, which was just built, and leaves the scene on the stack.
static int derive(lua_State *L)
{
    glintL_walk *walk = lua_touserdata(L, 3);
    lua_getiuservalue(L, 1, GLINTL_JOB_SCENE);
    const glint_scene *scene = glintL_test_object(L, -1, GLINTL_SCENE);
    if (scene)
        glintL_find_derivatives(L, scene, &walk->render);
    return 0;
}

// Checks the job's scene for warnings, just after frame n was built.
static int observe(lua_State *L)
{
    glintL_walk *walk = lua_touserdata(L, 3);
    derive(L);
    glintL_observe_frame(L, walk->run, -1, &walk->render.desc, lua_tointeger(L, 2));
    return 0;
}

int glintL_walk_restore(lua_State *L)
{
    glintL_sweep_restore(L, 1);
    return 0;
}

bool glintL_walk_call(glintL_walk *walk, lua_CFunction function, int64_t n, int64_t number)
{
    lua_State *L = walk->L;
    lua_pushcfunction(L, glintL_message_handler);
    lua_pushcfunction(L, function);
    lua_pushvalue(L, walk->job_index);
    lua_pushinteger(L, n);
    lua_pushlightuserdata(L, walk);
    walk->run->in_frame = true;
    int status = lua_pcall(L, 3, 0, -5);
    walk->run->in_frame = false;
    if (status != LUA_OK)
        glintL_run_fail(walk->run, glintL_script_exit(walk->run, status), number, "frame %" PRId64 ": %s", number,
                        lua_tostring(L, -1));
    lua_settop(L, walk->job_index);
    return status == LUA_OK;
}

bool glintL_walk_build_frame(glintL_walk *walk, int64_t n, int64_t number)
{
    walk->time = glintL_job_time(walk->job, n);
    return glintL_walk_call(walk, glintL_walk_build, n, number);
}

bool glintL_walk_settle(glintL_walk *walk, lua_Integer i, int64_t first)
{
    const glintL_job *job = walk->job;
    int job_index = walk->job_index;
    bool good = true;
    int64_t last = first - 1; // number of the last frame before this job
    for (lua_Integer j = i - 1; j > walk->settled; j--)
        last -= glintL_walk_get_job(walk->L, walk->list, j)->frames;
    for (; walk->settled < i - 1 && good; walk->settled++) {
        take_job(walk, walk->settled + 1);
        last += walk->job->frames;
        if (walk->job->kind == GLINTL_JOB_ANIMATION)
            good = glintL_walk_build_frame(walk, walk->job->frames, last);
        lua_settop(walk->L, job_index);
    }
    walk->job = job;
    walk->job_index = job_index;
    return good;
}

// Stores a sweep's place in the work. False: out of memory; the work is destroyed, and the run has failed.
static bool keep_place(glintL_walk *walk, glintL_work *work)
{
    if (walk->job->kind != GLINTL_JOB_SWEEP)
        return true;
    lua_getiuservalue(walk->L, walk->job_index, GLINTL_JOB_PLACE);
    const char *place = lua_tostring(walk->L, -1);
    work->sweep = strdup(place ? place : "");
    lua_getiuservalue(walk->L, walk->job_index, GLINTL_JOB_NAMES);
    const char *names = lua_tostring(walk->L, -1);
    work->names = strdup(names ? names : "");
    lua_pop(walk->L, 2);
    if (work->sweep && work->names)
        return true;
    glintL_run_fail(walk->run, GLINTL_EXIT_FAILED, work->index, "out of memory");
    glintL_work_destroy(work);
    return false;
}

glint_scene *glintL_walk_scene(glintL_walk *walk)
{
    lua_getiuservalue(walk->L, walk->job_index, GLINTL_JOB_SCENE);
    glint_scene *scene = glintL_test_object(walk->L, -1, GLINTL_SCENE);
    lua_pop(walk->L, 1);
    return scene;
}

// Reports an engine's failure at a frame. Returns false.
static bool fail_at(glintL_walk *walk, int64_t number, const glint_error *error)
{
    return glintL_run_fail(walk->run, glintL_run_exit_code(error->status), number, "frame %" PRId64 ": %s", number,
                           error->message);
}

glint_scene *glintL_walk_open_scene(glintL_walk *walk, int64_t number)
{
    glint_scene *scene = glintL_walk_scene(walk);
    if (!scene)
        glintL_run_fail(walk->run, GLINTL_EXIT_USAGE, number, "frame %" PRId64 ": the scene is closed", number);
    return scene;
}

// ---- While the shutter is open ----

// Copies the derivatives of one time, except those that nothing depends on.
static void take_derivatives(const glint_render_desc *from, glint_derivative of[GLINT_DERIVATIVES_MAX], glint_render_desc *to)
{
    to->derivatives = of;
    to->derivative_count = 0;
    for (size_t i = 0; i < from->derivative_count; i++)
        if (from->derivatives[i].slope_count > 0)
            of[to->derivative_count++] = from->derivatives[i];
}

// Plans frame n at each of the shutter's times. False: the run has failed; the plans made so far are in the list.
static bool plan_times(glintL_walk *walk, glintL_work *work, int64_t n, const glint_camera_desc *camera,
                       glint_plan **plans)
{
    glint_error error;
    glint_render_desc desc = work->render.desc;
    glint_shutter_desc(&desc);
    glint_derivative derivatives[GLINT_DERIVATIVES_MAX];
    double share = camera->shutter;
    int times = (int)camera->shutter_times;
    for (int k = 0; k < times; k++) {
        walk->time = glintL_job_shutter_time(walk->job, n, share, k, times);
        const glint_scene *scene = glintL_walk_call(walk, glintL_walk_build, n, work->index) ? glintL_walk_open_scene(walk, work->index) : NULL;
        if (!scene || !glintL_walk_call(walk, derive, n, work->index))
            return false;
        take_derivatives(&walk->render.desc, derivatives, &desc);
        if (glintL_orbit_plan(scene, &work->render.orbit, &desc, NULL, &plans[k], &error))
            return fail_at(walk, work->index, &error);
    }
    if (!glintL_walk_build_frame(walk, n, work->index) || !glintL_walk_open_scene(walk, work->index) || !glintL_walk_call(walk, derive, n, work->index))
        return false;
    work->render.desc.derivatives = walk->render.desc.derivatives;
    return true;
}

bool glintL_walk_moves(glintL_walk *walk)
{
    bool is_function = lua_getiuservalue(walk->L, walk->job_index, GLINTL_JOB_FRAME) == LUA_TFUNCTION;
    lua_pop(walk->L, 1);
    return is_function && walk->job->kind == GLINTL_JOB_ANIMATION;
}

// Turns a planned frame into the mean over the open shutter's times, if the shutter is open. False: the run has failed.
static bool expose(glintL_walk *walk, glintL_work *work, int64_t n)
{
    glint_error error;
    const glint_camera_desc camera = *glint_camera_get(glint_scene_get(glintL_walk_scene(walk))->camera);
    size_t count = (size_t)camera.shutter_times;
    if (camera.shutter == 0)
        return true;
    if (!glintL_walk_moves(walk)) {
        glintL_warn_of_shutter(walk->run);
        return walk->run->exit_code == 0;
    }
    glint_plan **plans = calloc(count, sizeof *plans);
    if (!plans)
        return glintL_run_fail(walk->run, GLINTL_EXIT_FAILED, work->index, "out of memory");
    const bool planned = plan_times(walk, work, n, &camera, plans);
    if (planned && glintL_work_expose(work, glintL_walk_scene(walk), plans, count, &error) == GLINT_OK)
        return true;
    for (size_t k = 0; k < count; k++)
        glint_plan_destroy(plans[k]);
    free(plans);
    return planned && fail_at(walk, work->index, &error);
}

// Sets the scene to frame n and plans it without a shutter. NULL: the run has failed.
static glintL_work *plan_instant(glintL_walk *walk, int64_t n, int64_t number)
{
    glint_error error;
    glintL_work *work = NULL;
    if (!glintL_walk_build_frame(walk, n, number) || !glintL_walk_call(walk, observe, number, number) || walk->run->exit_code)
        return NULL;
    const glint_scene *scene = glintL_walk_open_scene(walk, number);
    if (!scene)
        return NULL;
    glint_status status = glintL_work_create(scene, &walk->render, number, walk->naming.pattern != NULL,
                                             walk->run->keeps_images, &work, &error);
    if (status)
        fail_at(walk, number, &error);
    return !status && keep_place(walk, work) ? work : NULL;
}

glintL_work *glintL_walk_plan(glintL_walk *walk, int64_t n, int64_t number)
{
    double start = glintL_now_ms();
    glintL_work *work = plan_instant(walk, n, number);
    if (work && !expose(walk, work, n)) {
        glintL_work_destroy(work);
        return NULL;
    }
    if (work)
        work->build_ms = glintL_now_ms() - start;
    return work;
}

// Names the files of a work. NULL: the run has failed, and the work is destroyed.
static glintL_work *name_files(glintL_walk *walk, glintL_work *work)
{
    glint_error error;
    if (glintL_work_name(work, &walk->naming, &error) == GLINT_OK)
        return work;
    glintL_run_fail(walk->run, GLINTL_EXIT_USAGE, work->index, "%s", error.message);
    glintL_work_destroy(work);
    return NULL;
}

glintL_work *glintL_walk_prepare(glintL_walk *walk, int64_t n, int64_t number)
{
    glintL_work *work = glintL_walk_plan(walk, n, number);
    return work ? name_files(walk, work) : NULL;
}

typedef struct planned {
    glintL_walk *walk;
    int64_t n, number;
} planned;

static glintL_work *plan_again(void *context, const glintL_render *render)
{
    const planned *frame = context;
    frame->walk->render = *render;
    return glintL_walk_plan(frame->walk, frame->n, frame->number);
}

static bool name_again(void *context, glintL_work *work)
{
    const planned *frame = context;
    glint_error error;
    return !frame->walk->naming.film && glintL_work_name(work, &frame->walk->naming, &error) == GLINT_OK;
}

// Renders frame n with the samples that it needs. Returns it named; NULL: the run has failed.
static glintL_work *refine(glintL_walk *walk, int64_t n, int64_t number)
{
    planned frame = { walk, n, number };
    const glintL_render render = walk->render;
    const glintL_frame_planner planner = { &render, plan_again, name_again, &frame };
    glintL_work *work = glintL_refine(walk->run, &planner, number);
    walk->render = render;
    return work ? name_files(walk, work) : NULL;
}

bool glintL_walk_render(glintL_walk *walk, int64_t n, int64_t number)
{
    glintL_run *run = walk->run;
    const bool refines = glintL_run_refines(run);
    glintL_work *work = refines ? refine(walk, n, number) : glintL_walk_prepare(walk, n, number);
    const bool good = work && (refines ? glintL_work_finish(run, work, false) : glintL_work_run(run, work, run->request.force));
    if (good)
        glintL_look_for_black(run, glintL_walk_scene(walk), work);
    glintL_work_destroy(work);
    return good;
}
