// One setting in the engine: its plan, its picture and its time. Functions for the modules.
#include <stdlib.h>
#include <time.h>

#include "bindings/cost/cost.h"

#define PLAN "cost.plan"
#define IMAGE "cost.image"

typedef struct planned {
    glint_plan *plan; // owned
    cost_setting setting;
} planned;

// ---- Renderers ----

// Makes this the run's renderer, which a signal cancels.
static void use_renderer(cost_study *study, glint_renderer *renderer)
{
    study->run->renderer = renderer;
    if (study->run->interrupted)
        glint_renderer_cancel(renderer);
    if (study->output->progress)
        cli_progress_watch(study->output->progress, renderer);
}

bool cost_open_renderers(cost_study *study, glint_error *error)
{
    glintL_run *run = study->run;
    for (int keeps = run->retained_neighbour ? 1 : 0; keeps >= 0; keeps--)
        for (int counts = 1; counts >= 0; counts--) {
            run->renderer = NULL;
            run->request.no_reuse = !keeps;
            run->counts_work = counts;
            if (!glintL_run_open(run, error))
                return false;
            study->renderers[keeps][counts] = run->renderer;
        }
    return true;
}

// ---- Plans ----

static glint_status out_of_memory(glint_error *error)
{
    *error = (glint_error) { GLINT_ERR_NOMEM, "out of memory" };
    return GLINT_ERR_NOMEM;
}

// Restores the scene. Returns `status`, or the restoration's if that is GLINT_OK.
static glint_status restore(cost_scene *scene, glint_status status, glint_error *error)
{
    const glint_status restored = cost_scene_restore(scene, status ? NULL : error);
    return status ? status : restored;
}

// Plans the scene at one time of an open shutter.
static glint_status plan_time(const cost_study *study, const cost_setting *setting, int k, glint_plan **out,
                              glint_error *error)
{
    cost_scene *scene;
    glint_render_desc desc = setting->render.desc;
    glint_shutter_desc(&desc);
    glint_status status = cost_moments_enter(study->moments, setting->shutter_times, k, &scene, error);
    if (!status)
        status = cost_setting_apply(setting, scene, error);
    if (!status)
        status = glint_plan_create(scene->scene, &desc, out, error);
    status = restore(scene, status, error);
    cost_scene_close_meshes(scene);
    return status;
}

static void drop_times(glint_plan **times, int count)
{
    for (int k = 0; times && k < count; k++)
        glint_plan_destroy(times[k]);
    free(times);
}

// Plans all times. Afterwards the scene is at the frame's own instant. On success the caller owns the list.
static glint_status plan_times(const cost_study *study, const cost_setting *setting, int count, glint_plan ***out,
                               glint_error *error)
{
    glint_plan **times = calloc((size_t)count, sizeof *times);
    glint_status status = times ? GLINT_OK : out_of_memory(error);
    for (int k = 0; k < count && !status; k++)
        status = plan_time(study, setting, k, &times[k], error);
    cost_scene *own;
    const glint_status back = cost_moments_enter(study->moments, 0, 0, &own, status ? NULL : error);
    status = status ? status : back;
    if (status)
        drop_times(times, count);
    else
        *out = times;
    return status;
}

// Plans a setting. Afterwards the scene is restored.
static glint_status plan_setting(cost_study *study, const cost_setting *setting, glint_plan **out, glint_error *error)
{
    cost_scene *scene = &study->scene;
    glint_plan **times = NULL;
    const int count = setting->shutter_times;
    glint_status status = count > 0 ? plan_times(study, setting, count, &times, error) : GLINT_OK;
    if (!status)
        status = cost_setting_apply(setting, scene, error);
    if (!status && times)
        status = glint_plan_create_exposed(scene->scene, &setting->render.desc, times, (size_t)count, out, error);
    else if (!status)
        status = glint_plan_create(scene->scene, &setting->render.desc, out, error);
    if (status)
        drop_times(times, count);
    return restore(scene, status, error);
}

static int drop_plan(lua_State *L)
{
    planned *p = lua_touserdata(L, 1);
    glint_plan_destroy(p->plan);
    p->plan = NULL;
    return 0;
}

// plan(choice, shot, samples, seed, exact): plans the frame with the values of knobs in the table. shot: "file" (the
// default) as the script's frame is written; "both": with the linear picture too; "beauty": this picture only. exact:
// decided in double.
static int plan(lua_State *L)
{
    lua_settop(L, 5);
    cost_study *study = cost_study_of(L);
    planned *p = glintL_push_owner(L, sizeof *p, PLAN, drop_plan);
    glint_error error;
    cost_setting_read(L, study, &p->setting);
    return plan_setting(study, &p->setting, &p->plan, &error) ? cost_fail(L, &error) : 1;
}

// rays(plan): returns the number of rays that the plan expects.
static int rays(lua_State *L)
{
    const planned *p = luaL_checkudata(L, 1, PLAN);
    const glint_ray_counts counts = glint_plan_expected_rays(p->plan);
    lua_pushnumber(L, (double)counts.primary + (double)counts.shadow + (double)counts.mirror +
                          (double)counts.refraction + (double)counts.indirect);
    return 1;
}

// ---- One run ----

static double cpu_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static glint_status encode_values(const glint_image *image, glint_error *error)
{
    const glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = "frame.pfm" };
    uint8_t *data = NULL;
    size_t size;
    glint_status status = glint_image_to_bytes(image, &desc, &data, &size, error);
    free(data);
    return status;
}

// Encodes like the writer of a job, with its threads and its cache of the previous picture, but writes no file.
static glint_status encode(cost_study *study, const glintL_render *render, glint_image *image, double *ms,
                           glint_error *error)
{
    glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = "/dev/null", .tone = render->desc.tone, .encode = render->encode };
    glint_write_result result;
    const double start = glintL_now_ms();
    glint_status status;
    if (!render->desc.codes) {
        status = encode_values(image, error);
        *ms = glintL_now_ms() - start;
        return status;
    }
    status = glint_writer_submit(study->run->writer, image, &desc, NULL, error);
    if (status || !glint_writer_collect(study->run->writer, true, &result))
        return status;
    *ms = result.encode_ms;
    if (result.status) {
        error->status = result.status;
        snprintf(error->message, sizeof error->message, "%s", result.message);
    }
    return result.status;
}

// Renders the neighbouring frame first, if the setting is measured after it.
static glint_status prepare(cost_study *study, const cost_setting *setting, bool counts, glint_error *error)
{
    glint_image *before = NULL;
    double ms;
    use_renderer(study, study->renderers[setting->reuses][counts]);
    if (!setting->reuses)
        return GLINT_OK;
    glint_status status = glint_render(study->run->renderer, study->run->retained_neighbour, &before, NULL, error);
    if (!status && setting->render.desc.codes)
        status = encode(study, &setting->render, before, &ms, error);
    glint_image_release(before);
    return status;
}

typedef struct times {
    double render, tone, encode, wall, cpu;
} times;

// Renders and encodes a frame; adds its times to `sum`.
static glint_status time_frame(cost_study *study, const planned *p, times *sum, glint_frame_stats *stats,
                               glint_error *error)
{
    glint_image *image = NULL;
    double encode_ms = 0;
    glint_status status = prepare(study, &p->setting, false, error);
    const double start = cpu_ms();
    if (!status)
        status = glint_render(study->run->renderer, p->plan, &image, stats, error);
    if (!status)
        status = encode(study, &p->setting.render, image, &encode_ms, error);
    glint_image_release(image);
    if (status)
        return status;
    sum->render += stats->render_ms;
    sum->tone += stats->tone_ms;
    sum->encode += encode_ms;
    sum->wall += stats->render_ms + stats->tone_ms + encode_ms;
    sum->cpu += cpu_ms() - start;
    return GLINT_OK;
}

// Sets the field `name` of the table on top of the stack to a table of the counts.
static void set_counts(lua_State *L, const char *name, const char *const *names, const uint64_t *counts)
{
    lua_newtable(L);
    for (size_t i = 0; names[i]; i++)
        glintL_set_whole(L, names[i], (lua_Integer)counts[i]);
    lua_setfield(L, -2, name);
}

static void push_stats(lua_State *L, const glint_frame_stats *stats)
{
    static const char *const RAYS[] = { "primary", "shadow", "mirror", "refraction", "indirect", NULL };
    static const char *const WORK[] = { "tests", "light_samples", "powers", "sites", "overlaps", "lights_seen", NULL };
    const glint_ray_counts *r = &stats->rays;
    const glint_work *w = &stats->work;
    lua_newtable(L);
    glintL_set_number(L, "render_ms", stats->render_ms);
    glintL_set_number(L, "tone_ms", stats->tone_ms);
    glintL_set_whole(L, "refined", (lua_Integer)stats->refined);
    set_counts(L, "rays", RAYS, (uint64_t[]) { r->primary, r->shadow, r->mirror, r->refraction, r->indirect });
    set_counts(L, "work", WORK,
               (uint64_t[]) { w->tests, w->light_samples, w->powers, w->sites, w->overlaps, w->lights_seen });
}

// time(plan, frames): renders, encodes and times the frame, in memory. Returns the times of one, and its statistics.
static int time_run(lua_State *L)
{
    const planned *p = luaL_checkudata(L, 1, PLAN);
    const lua_Integer frames = luaL_checkinteger(L, 2);
    times sum = { 0 };
    glint_frame_stats stats = { 0 };
    glint_error error;
    for (lua_Integer i = 0; i < frames; i++)
        if (time_frame(cost_study_of(L), p, &sum, &stats, &error))
            return cost_fail(L, &error);
    lua_newtable(L);
    glintL_set_number(L, "render", sum.render / (double)frames);
    glintL_set_number(L, "tone", sum.tone / (double)frames);
    glintL_set_number(L, "encode", sum.encode / (double)frames);
    glintL_set_number(L, "wall", sum.wall / (double)frames);
    glintL_set_number(L, "cpu", sum.cpu / (double)frames);
    push_stats(L, &stats);
    return 2;
}

// ---- A picture ----

// close(image): releases a picture.
static int drop_image(lua_State *L)
{
    glint_image **image = luaL_checkudata(L, 1, IMAGE);
    glint_image_release(*image);
    *image = NULL;
    return 0;
}

glint_image **cost_push_image(lua_State *L) { return glintL_push_owner(L, sizeof(glint_image *), IMAGE, drop_image); }

const glint_image *cost_image_at(lua_State *L, int index)
{
    glint_image **image = luaL_checkudata(L, index, IMAGE);
    return *image;
}

// picture(plan, counts): renders a picture, outside the timed runs. Returns it and its statistics. counts: its work is
// counted.
static int picture(lua_State *L)
{
    cost_study *study = cost_study_of(L);
    const planned *p = luaL_checkudata(L, 1, PLAN);
    const bool counts = lua_toboolean(L, 2);
    glint_image **image = cost_push_image(L);
    glint_frame_stats stats = { 0 };
    glint_error error;
    // A renderer caches from the second frame on, so the work of the third frame is counted.
    for (int frames = counts && p->setting.reuses ? 2 : 1; frames > 0; frames--) {
        glint_image_release(*image);
        *image = NULL;
        if (prepare(study, &p->setting, counts, &error) ||
            glint_render(study->run->renderer, p->plan, image, &stats, &error))
            return cost_fail(L, &error);
    }
    push_stats(L, &stats);
    return 2;
}

const luaL_Reg cost_measure_functions[] = {
    { "plan", plan },       { "rays", rays },        { "time", time_run },
    { "picture", picture }, { "close", drop_image }, { NULL, NULL },
};
