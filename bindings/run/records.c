// The life of a run: its renderer and writer, and the records of its frames in order.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/film.h"
#include "engine/glint_inspect.h"

// Limit for pictures waiting to be encoded, and for files waiting to be written. Two waiting pictures, the one being
// encoded and the one being rendered are the four pictures whose memory a renderer retains (render.c).
#define QUEUE_DEPTH 2
#define UNTRUSTED_REUSE_MEMORY ((size_t)1 << 30) // for a process with a memory limit

glintL_run *glintL_run_create(void)
{
    glintL_run *run = calloc(1, sizeof *run);
    if (run) {
        run->request.repeat = 1;
        run->since_ms = glintL_now_ms();
        glintL_places_forget(run);
    }
    return run;
}

static void destroy_record(glintL_record *record)
{
    for (int pass = 0; pass < record->slots; pass++)
        free(record->files[pass]);
    free(record->files);
    free(record->light_passes);
    free(record);
}

void glintL_run_destroy(glintL_run *run)
{
    if (!run)
        return;
    glint_writer_destroy(run->writer); // before the records, which hold its results
    glint_renderer_destroy(run->renderer);
    glint_renderer_destroy(run->other_renderer);
    glint_plan_destroy(run->explain_plan);
    free(run->explain_order);
    glint_plan_destroy(run->retained_neighbour);
    glint_scene_release(run->retained_scene);
    glintL_work_destroy(run->deferred);
    while (run->head) {
        glintL_record *next = run->head->next;
        destroy_record(run->head);
        run->head = next;
    }
    glintL_selection_clear(&run->request.selection);
    free(run->request.sets);
    free(run->request.folder);
    glintL_films_destroy(run->films);
    free(run->params_text);
    free(run->names_text);
    glintL_forget_warnings(run);
    glintL_places_forget(run);
    glintL_forget_folders(run);
    free(run);
}

void glintL_run_reset(glintL_run *run)
{
    glintL_run_collect(run, true);
    glint_plan_destroy(run->explain_plan);
    free(run->explain_order);
    glintL_work_destroy(run->deferred);
    glintL_films_destroy(run->films);
    glintL_forget_warnings(run);
    glintL_places_forget(run);
    free(run->params_text);
    free(run->names_text);
    run->explain_plan = NULL;
    run->explain_order = NULL;
    run->deferred = NULL;
    run->films = NULL;
    run->params_text = run->names_text = NULL;
    run->source[0] = '\0';
    run->count = run->call_count = run->selected_calls = 0;
    run->total = run->todo = run->done = run->kept = 0;
    run->clipped = run->pixels = run->nonfinite = 0;
    run->brightness = (glint_brightness) { 0 };
    run->earlier = run->failed_index = 0;
    run->is_stopped = run->in_frame = run->was_shrunk = run->has_light = run->told_of_view = false;
    run->black[0] = '\0';
    run->since_ms = glintL_now_ms();
    run->exit_code = GLINTL_EXIT_DONE;
    run->message[0] = '\0';
    for (size_t i = 0; i < run->request.set_count; i++)
        run->request.sets[i].is_known = false;
}

void glintL_run_keep_scene(lua_State *L, glintL_run *run, glint_scene *scene, const glintL_render *render)
{
    if (run->see_scene)
        run->see_scene(L, scene, render);
    if (!run->keeps_scene)
        return;
    run->retained_scene = glint_scene_retain(scene);
    run->retained_render = *render;
    run->retained_render.desc.derivatives = NULL; // the derivatives belong to the scene's next frame by now
    run->retained_render.desc.derivative_count = 0;
    run->retained_render.derivative_count = 0;
    run->retained_render.desc.light_passes = NULL; // the study measures the picture without them
    run->retained_render.light_passes[0] = '\0';
}

// ---- The run of plain Lua, which the state owns ----

static int collect_run(lua_State *L)
{
    glintL_run **box = lua_touserdata(L, 1);
    glintL_run_destroy(*box);
    *box = NULL;
    return 0;
}

// Reads the script's name, which plain Lua stores in arg[0].
static void read_script_name(lua_State *L, glintL_run *run)
{
    if (lua_getglobal(L, "arg") == LUA_TTABLE) {
        if (lua_rawgeti(L, -1, 0) == LUA_TSTRING)
            snprintf(run->script, sizeof run->script, "%s", glintL_base_name(lua_tostring(L, -1)));
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

void glintL_open_run(lua_State *L)
{
    if (glintL_get_run(L))
        return;
    glintL_run **box = glintL_new_run_box(L, collect_run);
    *box = glintL_run_create();
    if (!*box)
        luaL_error(L, "out of memory");
    read_script_name(L, *box);
}

// ---- Renderer and writer ----

static glint_status open_renderer(glintL_run *run, glint_error *error)
{
    glint_renderer_desc desc = glint_renderer_desc_default();
    glint_renderer *renderer = NULL;
    desc.threads = run->request.threads;
    desc.time_stages = run->times_stages;
    desc.count_work = run->counts_work;
    // repeats measure whole frames
    desc.no_reuse = run->request.no_reuse || run->request.repeat > 1 || run->most_samples > 0;
    desc.reuse_memory = run->request.reuse_memory;
    if (run->request.is_untrusted && !desc.reuse_memory)
        desc.reuse_memory = UNTRUSTED_REUSE_MEMORY;
    glint_status status = glint_renderer_create(&desc, &renderer, error);
    if (status)
        return status;
    run->renderer_threads = run->request.threads;
    if (run->mode == GLINTL_MODE_WATCH)
        glint_renderer_cache_hits(renderer);
    run->renderer = renderer; // from now on a signal can cancel it
    if (run->interrupted)
        glint_renderer_cancel(renderer);
    return GLINT_OK;
}

bool glintL_run_open(glintL_run *run, glint_error *error)
{
    glint_status status = GLINT_OK;
    sigset_t stops, before;
    if (run->renderer && run->renderer_threads != run->request.threads) {
        glint_renderer_destroy(run->renderer);
        run->renderer = NULL;
        glintL_run_collect(run, true); // the writer may be destroyed only when it has no files left
        glint_writer_destroy(run->writer);
        run->writer = NULL;
    }
    const bool writes = run->mode != GLINTL_MODE_WATCH; // in this mode no picture is written
    if (run->renderer && (run->writer || !writes))
        return true;
    sigemptyset(&stops); // only the script's thread handles them: threads made here inherit the mask
    sigaddset(&stops, SIGINT);
    sigaddset(&stops, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &stops, &before);
    if (!run->renderer)
        status = open_renderer(run, error);
    if (status == GLINT_OK && writes && !run->writer)
        status = glint_writer_create(QUEUE_DEPTH, run->request.threads, &run->writer, error);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return status == GLINT_OK;
}

// ---- Records, reported in the order of frames ----

glintL_record *glintL_run_add(glintL_run *run, const glintL_work *work)
{
    glintL_record *record = calloc(1, sizeof *record);
    if (!record)
        goto no_memory;
    record->index = work->index;
    record->build_ms = work->build_ms;
    record->stats = work->stats;
    record->samples = glintL_run_refines(run) ? work->render.desc.samples : 0;
    record->error = work->error;
    record->film = work->film;
    memcpy(record->derivative, work->render.derivative, sizeof record->derivative);
    record->pixel_count = (double)work->stats.pixels; // kept frames have no pixels to count
    const char *lights = glint_plan_render_desc(work->plan)->light_passes;
    size_t light_count = 0;
    while (glint_plan_light_pass(work->plan, light_count))
        light_count++;
    if (lights && !(record->light_passes = strdup(lights)))
        goto no_memory;
    if (!(record->files = calloc(GLINTL_PASSES_MAX + light_count, sizeof *record->files)))
        goto no_memory;
    record->slots = GLINTL_PASSES_MAX + (int)light_count;
    for (int i = 0; i < work->file_count; i++) {
        char *copy = strdup(work->files[i].path);
        if (!copy)
            goto no_memory;
        record->files[work->files[i].pass] = copy;
    }
    if (run->tail)
        run->tail->next = record;
    else
        run->head = record;
    run->tail = record;
    return record;
no_memory:
    if (record)
        destroy_record(record);
    glintL_run_fail(run, GLINTL_EXIT_FAILED, work->index, "out of memory");
    return NULL;
}

static void count_record(glintL_run *run, const glintL_record *record)
{
    run->done++;
    run->kept += record->kept;
    if (!record->kept) {
        run->clipped += record->stats.clipped;
        run->nonfinite += record->stats.nonfinite;
        run->pixels += (uint64_t)record->pixel_count;
    }
}

// Reports and removes the records at the head whose files are all written.
static void flush_records(glintL_run *run)
{
    while (run->head && run->head->files_left == 0) {
        glintL_record *record = run->head;
        if (!record->failed && !record->is_step) {
            if (record->is_last)
                count_record(run, record);
            if (record->is_last && record->film && !glintL_film_add(record->film, record->index, record->files[GLINT_PASS_BEAUTY]))
                glintL_run_fail(run, GLINTL_EXIT_FAILED, record->index, "out of memory");
            if (run->reporter.frame)
                run->reporter.frame(run->reporter.context, run, record);
        }
        run->head = record->next;
        if (!run->head)
            run->tail = NULL;
        destroy_record(record);
    }
}

bool glintL_run_collect(glintL_run *run, bool wait)
{
    glint_write_result result;
    if (run->interrupted && run->writer)
        glint_writer_cancel(run->writer);
    flush_records(run);
    while (run->files_pending > 0 && glint_writer_collect(run->writer, wait, &result)) {
        glintL_record *record = result.user;
        run->files_pending--;
        record->files_left--;
        record->encode_ms += result.encode_ms;
        record->write_ms += result.write_ms;
        if (result.status != GLINT_OK) {
            record->failed = true;
            if (result.status != GLINT_ERR_CANCELLED)
                glintL_run_fail(run, glintL_run_exit_code(result.status), record->index, "%s", result.message);
            glint_writer_cancel(run->writer); // the other queued files would fail in the same way
        }
        flush_records(run);
    }
    return run->exit_code == GLINTL_EXIT_DONE;
}
