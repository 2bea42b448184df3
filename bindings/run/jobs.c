// Frames of animations and sweeps: numbered through a list of them, selected, rendered in the order that costs least.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/film.h"
#include "bindings/run/order.h"
#include "bindings/run/sheet.h"

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

static const glintL_job *get_job(lua_State *L, int index, lua_Integer i)
{
    lua_rawgeti(L, index, i);
    const glintL_job *job = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return job;
}

int64_t glintL_jobs_total(lua_State *L, int index)
{
    int64_t total = 0;
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, index); i++)
        total += get_job(L, index, i)->frames;
    return total;
}

// ---- One job of the list ----

typedef struct job_walk {
    lua_State *L;
    glintL_run *run;
    int list, job_index; // on the stack; the job is on top of it
    lua_Integer settled; // jobs of the list that left the scene as they leave it
    const glintL_job *job;
    glintL_render render; // with what the command line says
    double time; // of the moment that is built
    char pattern[GLINTL_PATH_SIZE];
    glintL_naming naming;
} job_walk;

// A picture of the run's preview size: quick, and of the same shape.
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
    if (run->preview_side > 0)
        shrink(run, &render->desc);
}

void glintL_run_default_name(const glintL_run *run, char pattern[GLINTL_PATH_SIZE])
{
    size_t length = strlen(run->script);
    if (length > 4 && strcmp(run->script + length - 4, ".lua") == 0)
        length -= 4;
    snprintf(pattern, GLINTL_PATH_SIZE, "%.*s.png", length ? (int)length : 5, length ? run->script : "frame");
}

// What the job's pictures are called, by the command line or else by the script.
static const char *output_of(const glintL_run *run, const glintL_job *job)
{
    const char *text = run->request.render_text[glintL_render_find("output")];
    return text ? text : job->render.output;
}

// Whether several frames of the whole script go to this job's pattern. Allocates nothing: its answer is a name.
static bool is_shared(const job_walk *walk)
{
    const char *output = output_of(walk->run, walk->job);
    int64_t frames = 0;
    if (walk->run->call_count > 0 || walk->run->point_count > 1)
        return true;
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(walk->L, walk->list); i++) {
        const glintL_job *job = get_job(walk->L, walk->list, i);
        if (strcmp(output_of(walk->run, job), output) == 0)
            frames += job->frames;
    }
    return frames > 1 || walk->run->earlier > 0;
}

// The job on top of the stack becomes the one at hand.
static void take_job(job_walk *walk, lua_Integer i)
{
    lua_rawgeti(walk->L, walk->list, i);
    walk->job_index = lua_gettop(walk->L);
    walk->job = lua_touserdata(walk->L, -1);
}

static void begin_job(job_walk *walk, lua_Integer i)
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

// Prepares the film the job's frames go into, if any. False: the run has failed.
static bool open_film(job_walk *walk)
{
    char message[GLINTL_MESSAGE_SIZE];
    const char *path = walk->naming.pattern ? walk->naming.pattern : "none";
    if (!glintL_film_open(walk->run, path, &walk->render, walk->job->fps, message))
        return glintL_run_fail(walk->run, GLINTL_EXIT_USAGE, 0, "%s", message);
    glintL_film_take(walk->run, &walk->naming);
    return true;
}

static int build(lua_State *L)
{
    const job_walk *walk = lua_touserdata(L, 3);
    glintL_job_build(L, 1, lua_tointeger(L, 2), walk->time);
    return 0;
}

// Finds the slopes of the job's scene as it has just been built, and leaves it on the stack.
static int derive(lua_State *L)
{
    job_walk *walk = lua_touserdata(L, 3);
    lua_getiuservalue(L, 1, GLINTL_JOB_SCENE);
    const glint_scene *scene = glintL_test_object(L, -1, GLINTL_SCENE);
    if (scene)
        glintL_find_derivatives(L, scene, &walk->render);
    return 0;
}

// Looks at the job's scene, which frame n has just been built in.
static int observe(lua_State *L)
{
    job_walk *walk = lua_touserdata(L, 3);
    derive(L);
    glintL_observe_frame(L, walk->run, -1, &walk->render.desc, lua_tointeger(L, 2));
    return 0;
}

static int restore(lua_State *L)
{
    glintL_sweep_restore(L, 1);
    return 0;
}

// Calls `function` with the job and n. False: it raised, and the run has failed.
static bool call(job_walk *walk, lua_CFunction function, int64_t n, int64_t number)
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

// Sets the scene to frame n at its own time. False: the run has failed.
static bool build_frame(job_walk *walk, int64_t n, int64_t number)
{
    walk->time = glintL_job_time(walk->job, n);
    return call(walk, build, n, number);
}

// A job begins with the scene as the jobs before it leave it, whichever of their frames are rendered here: an animation
// after its last frame, a sweep as it found it. So a shard's pictures are those of the whole. False: the run has
// failed.
static bool settle_before(job_walk *walk, lua_Integer i, int64_t first)
{
    const glintL_job *job = walk->job;
    int job_index = walk->job_index;
    bool good = true;
    int64_t last = first - 1; // number of the last frame before this job
    for (lua_Integer j = i - 1; j > walk->settled; j--)
        last -= get_job(walk->L, walk->list, j)->frames;
    for (; walk->settled < i - 1 && good; walk->settled++) {
        take_job(walk, walk->settled + 1);
        last += walk->job->frames;
        if (walk->job->kind == GLINTL_JOB_ANIMATION)
            good = build_frame(walk, walk->job->frames, last);
        lua_settop(walk->L, job_index);
    }
    walk->job = job;
    walk->job_index = job_index;
    return good;
}

// Notes a sweep's place with the work. False: out of memory; the work is gone, and the run has failed.
static bool keep_place(job_walk *walk, glintL_work *work)
{
    if (walk->job->kind != GLINTL_JOB_SWEEP)
        return true;
    lua_getiuservalue(walk->L, walk->job_index, GLINTL_JOB_PLACE);
    const char *place = lua_tostring(walk->L, -1);
    work->sweep = strdup(place ? place : "");
    lua_pop(walk->L, 1);
    if (work->sweep)
        return true;
    glintL_run_fail(walk->run, GLINTL_EXIT_FAILED, work->index, "out of memory");
    glintL_work_destroy(work);
    return false;
}

static glint_scene *scene_of(job_walk *walk)
{
    lua_getiuservalue(walk->L, walk->job_index, GLINTL_JOB_SCENE);
    glint_scene *scene = glintL_test_object(walk->L, -1, GLINTL_SCENE);
    lua_pop(walk->L, 1);
    return scene;
}

// Keeps an engine's failure at a frame. False.
static bool fail_at(job_walk *walk, int64_t number, const glint_error *error)
{
    return glintL_run_fail(walk->run, glintL_run_exit_code(error->status), number, "frame %" PRId64 ": %s", number,
                           error->message);
}

// The same, where it is still open. NULL: the run has failed.
static glint_scene *open_scene(job_walk *walk, int64_t number)
{
    glint_scene *scene = scene_of(walk);
    if (!scene)
        glintL_run_fail(walk->run, GLINTL_EXIT_USAGE, number, "frame %" PRId64 ": the scene is closed", number);
    return scene;
}

// ---- While the shutter is open ----

// Derivatives of a time: those that anything depends on then.
static void take_derivatives(const glint_render_desc *from, glint_derivative of[GLINT_DERIVATIVES_MAX], glint_render_desc *to)
{
    to->derivatives = of;
    to->derivative_count = 0;
    for (size_t i = 0; i < from->derivative_count; i++)
        if (from->derivatives[i].slope_count > 0)
            of[to->derivative_count++] = from->derivatives[i];
}

// Plans frame n at each time that the shutter looks. False: the run has failed; what is planned is in the list.
static bool plan_times(job_walk *walk, glintL_work *work, int64_t n, const glint_camera_desc *camera,
                       glint_plan **plans)
{
    glint_error error;
    glint_render_desc desc = glint_shutter_desc(&work->render.desc);
    glint_derivative derivatives[GLINT_DERIVATIVES_MAX];
    double share = camera->shutter;
    int times = (int)camera->shutter_times;
    for (int k = 0; k < times; k++) {
        walk->time = glintL_job_shutter_time(walk->job, n, share, k, times);
        const glint_scene *scene = call(walk, build, n, work->index) ? open_scene(walk, work->index) : NULL;
        if (!scene || !call(walk, derive, n, work->index))
            return false;
        take_derivatives(&walk->render.desc, derivatives, &desc);
        if (glint_plan_create(scene, &desc, &plans[k], &error))
            return fail_at(walk, work->index, &error);
    }
    if (!build_frame(walk, n, work->index) || !open_scene(walk, work->index) || !call(walk, derive, n, work->index))
        return false;
    work->render.desc.derivatives = walk->render.desc.derivatives;
    return true;
}

// Whether the job's scene is another at another time: an animation with a frame function.
static bool moves(job_walk *walk)
{
    bool is_function = lua_getiuservalue(walk->L, walk->job_index, GLINTL_JOB_FRAME) == LUA_TFUNCTION;
    lua_pop(walk->L, 1);
    return is_function && walk->job->kind == GLINTL_JOB_ANIMATION;
}

// Makes of a planned frame the mean of the times that the camera's shutter is open, if it is. False: the run has failed.
static bool expose(job_walk *walk, glintL_work *work, int64_t n)
{
    glint_error error;
    const glint_camera_desc camera = *glint_camera_get(glint_scene_get(scene_of(walk))->camera);
    size_t count = (size_t)camera.shutter_times;
    if (camera.shutter == 0)
        return true;
    if (!moves(walk)) {
        glintL_warn_of_shutter(walk->run);
        return walk->run->exit_code == 0;
    }
    glint_plan **plans = calloc(count, sizeof *plans);
    if (!plans)
        return glintL_run_fail(walk->run, GLINTL_EXIT_FAILED, work->index, "out of memory");
    if (!plan_times(walk, work, n, &camera, plans)) {
        for (size_t k = 0; k < count; k++)
            glint_plan_destroy(plans[k]);
        free(plans);
        return false;
    }
    return glintL_work_expose(work, scene_of(walk), plans, count, &error) == GLINT_OK ||
           fail_at(walk, work->index, &error);
}

// Sets the scene to frame n and plans what is seen in an instant. NULL: the run has failed.
static glintL_work *plan_instant(job_walk *walk, int64_t n, int64_t number)
{
    glint_error error;
    glintL_work *work = NULL;
    if (!build_frame(walk, n, number) || !call(walk, observe, number, number) || walk->run->exit_code)
        return NULL;
    const glint_scene *scene = open_scene(walk, number);
    if (!scene)
        return NULL;
    glint_status status = glintL_work_create(scene, &walk->render, number, walk->naming.pattern != NULL,
                                             walk->run->keeps_images, &work, &error);
    if (status)
        fail_at(walk, number, &error);
    return !status && keep_place(walk, work) ? work : NULL;
}

// The same of what is seen while the shutter is open.
static glintL_work *plan_frame(job_walk *walk, int64_t n, int64_t number)
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

static bool run_frame(job_walk *walk, int64_t n, int64_t number)
{
    glint_error error;
    glintL_work *work = plan_frame(walk, n, number);
    if (!work)
        return false;
    bool good = glintL_work_name(work, &walk->naming, &error) == GLINT_OK;
    if (!good)
        glintL_run_fail(walk->run, GLINTL_EXIT_USAGE, number, "%s", error.message);
    good = good && glintL_work_run(walk->run, work, walk->run->request.force);
    if (good)
        glintL_look_for_black(walk->run, scene_of(walk), work);
    glintL_work_destroy(work);
    return good;
}

// ---- The list ----

// Which frames to render: those selected from first to last, of these the ones at places from .. to.
typedef struct part {
    int64_t from, to, place; // place: of the last frame passed
} part;

static part open_part(glintL_run *run, int64_t frames)
{
    part p;
    int64_t first = run->point_count ? 1 : run->count + 1;
    int64_t last = run->point_count ? frames * run->point_count : run->count + frames;
    glintL_selection_part(&run->request.selection, first, last, &p.from, &p.to);
    p.place = glintL_selection_count(&run->request.selection, first, run->count);
    run->total = last;
    run->todo = (run->point_count ? 0 : run->todo) + p.to - p.from + 1; // the part may be empty: to = from - 1
    return p;
}

// Draws the sheet of a sweep whose first frame has that number, when it has one. False: the run has failed.
static bool make_sheet(job_walk *walk, int64_t first)
{
    const glintL_selection *request = &walk->run->request.selection;
    bool partial = request->range_count > 0 || request->shard_count > 1;
    if (!walk->naming.pattern || walk->run->no_sheets)
        return true;
    return glintL_sweep_make_sheet(walk->L, walk->job_index, &walk->naming, first, partial);
}

// Plans frame n of the job at hand with what decides its keys. NULL: it cannot be planned, of which the run says nothing.
static glint_plan *probe(void *context, int64_t n)
{
    job_walk *walk = context;
    lua_State *L = walk->L;
    glint_error error;
    glint_plan *plan = NULL;
    glint_render_desc desc = walk->render.desc;
    lua_pushcfunction(L, build);
    lua_pushvalue(L, walk->job_index);
    lua_pushinteger(L, n);
    lua_pushlightuserdata(L, walk);
    walk->run->in_frame = true;
    const bool good = lua_pcall(L, 3, 0, 0) == LUA_OK;
    walk->run->in_frame = false;
    lua_settop(L, walk->job_index);
    const glint_scene *scene = good ? scene_of(walk) : NULL;
    desc.codes = true;
    desc.derivative_count = 0;
    return scene && glint_plan_create(scene, &desc, &plan, &error) == GLINT_OK ? plan : NULL;
}

// The order of the job's frames: as they are numbered, but where a sweep of several axes has another that costs less. A
// frame that cannot be planned, and a pipe that takes the frames, leave them as numbered.
static void find_order(job_walk *walk, bool search, glintL_order *order)
{
    lua_State *L = walk->L;
    glintL_order_init(order);
    if (walk->job->kind != GLINTL_JOB_SWEEP || !search) {
        glintL_order_add(order, walk->job->frames);
        return;
    }
    lua_getiuservalue(L, walk->job_index, GLINTL_JOB_FRAME);
    const int axes = lua_gettop(L);
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, axes); i++) {
        const int object = glintL_sweep_push_axis(L, axes, i);
        glintL_order_axis *axis = glintL_order_add(order, (int64_t)lua_rawlen(L, object + 2));
        glintL_sweep_push_title(L, axes, i);
        snprintf(axis->name, sizeof axis->name, "%s", lua_tostring(L, -1));
        lua_settop(L, axes);
    }
    lua_settop(L, walk->job_index);
    glintL_order_find(order, probe, walk);
}

// Whether several axes of the sweep at hand have several values.
static bool is_grid(job_walk *walk)
{
    int several = 0;
    lua_getiuservalue(walk->L, walk->job_index, GLINTL_JOB_FRAME);
    const int axes = lua_gettop(walk->L);
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(walk->L, axes); i++) {
        const int object = glintL_sweep_push_axis(walk->L, axes, i);
        several += lua_rawlen(walk->L, object + 2) > 1;
        lua_settop(walk->L, axes);
    }
    lua_settop(walk->L, walk->job_index);
    return several > 1;
}

// Whether the run renders several frames of the job at hand, whose first frame has that number, and may do so in any order.
static bool may_reorder(job_walk *walk, int64_t first, const part *p)
{
    if (walk->job->kind != GLINTL_JOB_SWEEP || !is_grid(walk))
        return false;
    const int64_t last = first + walk->job->frames - 1;
    const int64_t count = glintL_selection_count(&walk->run->request.selection, first, last);
    const char *pattern = walk->naming.pattern;
    return count > 2 && p->place < p->to && p->place + count >= p->from && !(pattern && glintL_name_is_special(pattern));
}

static bool run_job(job_walk *walk, lua_Integer i, part *p)
{
    glintL_run *run = walk->run;
    glintL_order order;
    const int64_t first = run->count + 1;
    begin_job(walk, i);
    bool good = open_film(walk);
    const bool search = good && may_reorder(walk, first, p);
    good = good && (!search || settle_before(walk, i, first));
    find_order(walk, good && search, &order);
    for (int64_t place = 0; place < walk->job->frames && good; place++) {
        const int64_t n = glintL_order_frame(&order, place), number = first + n - 1;
        if (!glintL_selection_has(&run->request.selection, number))
            continue;
        p->place++;
        if (p->place < p->from || p->place > p->to)
            continue;
        good = !run->interrupted && settle_before(walk, i, first) && run_frame(walk, n, number);
        if (n == walk->job->frames)
            walk->settled = i;
    }
    run->count += walk->job->frames;
    if (walk->job->kind == GLINTL_JOB_SWEEP)
        good = call(walk, restore, 0, run->count) && good;
    if (walk->job->kind == GLINTL_JOB_SWEEP && good && !run->interrupted)
        good = make_sheet(walk, first);
    lua_settop(walk->L, walk->job_index - 1);
    return good;
}

// Pushes a walk over the list at `index`: the collector's, so that it is freed whatever happens.
static job_walk *push_walk(lua_State *L, int index, glintL_run *run)
{
    int list = lua_absindex(L, index);
    luaL_checkstack(L, 16, "jobs");
    job_walk *walk = lua_newuserdatauv(L, sizeof *walk, 0);
    memset(walk, 0, sizeof *walk);
    walk->L = L;
    walk->run = run;
    walk->list = list;
    return walk;
}

bool glintL_jobs_run(lua_State *L, int index, glintL_run *run)
{
    glint_error error;
    int top = lua_gettop(L);
    job_walk *walk = push_walk(L, index, run);
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
static bool show_times(job_walk *walk, int64_t n, double share, int times)
{
    glintL_run *run = walk->run;
    for (int k = 0; k < times; k++) {
        walk->time = glintL_job_shutter_time(walk->job, n, share, k, times);
        glint_scene *scene = call(walk, build, n, run->explain_frame) ? open_scene(walk, run->explain_frame) : NULL;
        if (!scene)
            return false;
        if (!run->moments.see(run->moments.data, scene, times, k))
            return glintL_run_fail(run, GLINTL_EXIT_FAILED, run->explain_frame, "out of memory");
    }
    return true;
}

// The same of each shutter that the run is to see, where it is open. False: the run has failed.
static bool show_moments(job_walk *walk, int64_t n)
{
    glintL_run *run = walk->run;
    const glint_camera_desc camera = *glint_camera_get(glint_scene_get(scene_of(walk))->camera);
    if (!run->moments.see || camera.shutter == 0 || !moves(walk))
        return true;
    bool good = show_times(walk, n, camera.shutter, (int)camera.shutter_times);
    for (size_t i = 0; i < run->moments.count && good; i++)
        good = run->moments.counts[i] == (int)camera.shutter_times || show_times(walk, n, camera.shutter, run->moments.counts[i]);
    if (!good || !build_frame(walk, n, run->explain_frame) || !open_scene(walk, run->explain_frame))
        return false;
    return run->moments.see(run->moments.data, scene_of(walk), 0, 0) ||
           glintL_run_fail(run, GLINTL_EXIT_FAILED, run->explain_frame, "out of memory");
}

// Plans frame n of the job at hand, and keeps its scene and the plan of a frame next to it when the run is to.
static void explain_frame(job_walk *walk, int64_t n)
{
    glintL_run *run = walk->run;
    const bool keeps = run->keeps_scene && walk->job->frames > 1;
    glintL_work *next = keeps ? plan_frame(walk, n > 1 ? n - 1 : 2, run->explain_frame) : NULL;
    glintL_work *work = keeps && !next ? NULL : plan_frame(walk, n, run->explain_frame);
    if (work && walk->job->kind == GLINTL_JOB_SWEEP && !run->keeps_scene) {
        run->explain_order = malloc(sizeof *run->explain_order);
        if (run->explain_order)
            find_order(walk, true, run->explain_order);
    }
    if (work && show_moments(walk, n)) {
        run->explain_plan = work->plan;
        work->plan = NULL;
        glintL_run_keep_scene(run, scene_of(walk), &walk->render);
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
    job_walk *walk = push_walk(L, index, run);
    int64_t n = run->explain_frame - run->count, total = glintL_jobs_total(L, walk->list);
    for (lua_Integer i = 1; n >= 1 && n <= total; i++) {
        begin_job(walk, i);
        if (n <= walk->job->frames) {
            if (settle_before(walk, i, run->explain_frame - n + 1))
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
