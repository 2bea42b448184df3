// glint watch SCRIPT: renders at every save, in the terminal and on a page.
//
// A change is shown first as a small preview with one sample per pixel. If the full picture takes time, pictures with 1,
// 2, 4 ... samples follow. The last picture has full quality. Preview and full picture have renderers that live across
// runs, so that results which a change does not affect are reused; the steps between have a renderer without reuse.
#include <errno.h>
#include <math.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bindings/command/cli.h"
#include "bindings/run/carried.h"
#include "bindings/watch/watch.h"
#include "engine/glint_compare.h"

#define PREVIEW_SIDE 640
#define STEPS_BETWEEN_LOOKS 10000 // instructions of the script between two checks

static const char watch_track_lua[] = {
#include "bindings/watch/track.lua.h"
};

typedef enum quality { PREVIEW, FULL, QUALITIES } quality;

typedef struct watcher {
    cli_options *options;
    cli_output *output;
    glintL_run *run;
    cli_script script;
    watch_requests requests;
    watch_files *files;
    watch_server *server; // NULL: no page
    watch_terminal terminal;
    glint_renderer *renderers[QUALITIES]; // renderers by quality; the run owns the renderer in use
    glintL_set *given; // from the command line
    size_t given_count;
    quality now;
    bool shown; // this run has shown a picture
    bool has_begun; // the picture now shown was requested after the start
    bool differs; // the full picture differs from its preview
    double since_ms; // time of the current request; 0: the start
    int64_t pictures, frame, frames; // pictures: shown so far
    int64_t calls; // number of calls of scene:render in the script; the frames of its jobs have higher numbers
    int width, height;
    double ms;
    bool is_preview;
    double samples, own_samples, error; // the picture's samples per pixel, the script's, and the estimate; < 0: unknown
    bool is_doubtful; // the estimate is not to be trusted
    double render_ms, full_ms; // time to render the last picture, and the last full picture; 0: unknown
    glint_image *image; // the picture now shown; owned
    watch_picture *picture; // the same, for the terminal; owned
    char *params; // JSON from the last good run; owned
    char failure[GLINTL_MESSAGE_SIZE]; // "": the last run was good
    char warnings[GLINTL_MESSAGE_SIZE]; // warnings of the last run, one per line
} watcher;

// ---- Messages ----

// Returns the state in the format of the page.
static char *make_state(const watcher *w)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    glintL_json(out, "{\"script\":%s", w->run->script);
    fprintf(out,
            ",\"frame\":%" PRId64 ",\"frames\":%" PRId64 ",\"picture\":%" PRId64
            ",\"width\":%d,\"height\":%d,\"preview\":%s,\"samples\":%.0f,\"own_samples\":%.0f,\"ms\":%.3f,\"params\":%s",
            w->frame, w->frames, w->pictures, w->width, w->height, w->is_preview ? "true" : "false", w->samples,
            w->own_samples, w->ms, w->params ? w->params : "[]");
    if (w->error >= 0)
        fprintf(out, ",\"estimate\":%.3g,\"trusted\":%s", w->error, w->is_doubtful ? "false" : "true");
    if (*w->failure)
        glintL_json(out, ",\"error\":%s", w->failure);
    if (*w->warnings)
        glintL_json(out, ",\"warnings\":%s", w->warnings);
    fputc('}', out);
    return glintL_close_text(out, &text);
}

static void publish(watcher *w, watch_picture *picture)
{
    char *state = w->server ? make_state(w) : NULL;
    if (state)
        watch_server_publish(w->server, state, picture);
    free(state);
}

static void print_picture_event(watcher *w)
{
    FILE *out = w->output->data;
    fprintf(out, "{\"event\":\"picture\",\"index\":%" PRId64 ",\"width\":%d,\"height\":%d,\"preview\":%s,\"samples\":%.0f,\"ms\":%.3f}",
            w->frame, w->width, w->height, w->is_preview ? "true" : "false", w->samples, w->ms);
    cli_end_line(w->output);
}

static void tell_change(watcher *w, const char *path)
{
    if (!*path || !w->output->json)
        return;
    glintL_json(w->output->data, "{\"event\":\"change\",\"file\":%s}", path);
    cli_end_line(w->output);
}

static void tell_error(watcher *w, const char *message)
{
    snprintf(w->failure, sizeof w->failure, "%s", message);
    publish(w, NULL);
    watch_terminal_error(&w->terminal, message);
    if (!w->output->json)
        return;
    glintL_json(w->output->data, "{\"event\":\"error\",\"message\":%s}", message);
    cli_end_line(w->output);
}

// ---- The run's reporter ----

// Draws the picture with a line about it. On a terminal without graphics there are only lines, about full pictures.
static void draw(watcher *w)
{
    char line[GLINTL_MESSAGE_SIZE + 512], of[32] = "", samples[96] = ""; // a loop counts its calls only while it runs
    if (w->output->quiet || (w->is_preview && w->terminal.graphics == WATCH_TEXT))
        return;
    if (w->calls == 0 && w->frames > 0 && w->script.has_jobs)
        snprintf(of, sizeof of, " of %" PRId64, w->frames);
    if (w->own_samples > 1)
        snprintf(samples, sizeof samples, w->error >= 0 ? ", %.0f of %.0f samples, estimated error %.2g%s" : ", %.0f of %.0f samples",
                 w->samples, w->own_samples, w->error, w->is_doubtful ? " (not to be trusted)" : "");
    snprintf(line, sizeof line, "%.255s, frame %" PRId64 "%s: %d x %d%s%s, %.0f ms after the %s%s%s", w->run->script,
             w->frame, of, w->width, w->height, w->is_preview ? ", preview" : "", samples, w->ms,
             w->has_begun ? "change" : "start", *w->warnings ? "\n" : "", w->warnings);
    watch_terminal_draw(&w->terminal, w->picture, line);
}

// Shows the estimated error of the picture now shown, from its partner.
static void show_error(watcher *w, const glint_image *partner)
{
    glint_error error;
    if (glint_estimate_error(w->image, partner, NULL, &w->error, &error)) {
        glintL_run_fail(w->run, GLINTL_EXIT_FAILED, w->frame, "%s", error.message);
        return;
    }
    w->is_doubtful = glint_estimate_pixels(w->image, partner, NULL) < GLINTL_ESTIMATE_PIXELS;
    publish(w, NULL);
    if (w->output->json) {
        fprintf(w->output->data, "{\"event\":\"estimate\",\"index\":%" PRId64 ",\"samples\":%.0f,\"error\":%.6g,\"trusted\":%s}",
                w->frame, w->samples, w->error, w->is_doubtful ? "false" : "true");
        cli_end_line(w->output);
    }
    draw(w);
}

// Takes over the picture.
static void keep_picture(watcher *w, watch_picture *picture, glint_image *image)
{
    watch_picture_release(w->picture);
    glint_image_release(w->image);
    w->picture = picture;
    w->image = image;
}

static void show(void *context, const glintL_run *run, const glintL_work *work)
{
    watcher *w = context;
    glint_error error;
    w->shown = true;
    if (run->renders_partner) {
        show_error(w, work->image);
        return;
    }
    watch_picture *picture = watch_picture_create(work->image, &work->render, &error);
    if (!picture) {
        glintL_run_fail(w->run, GLINTL_EXIT_FAILED, work->index, "%s", error.message);
        return;
    }
    keep_picture(w, picture, glint_image_retain(work->image));
    w->is_preview = run->most_samples > 0 || (w->now == PREVIEW && run->was_shrunk);
    w->frame = work->index;
    w->frames = w->frames > work->index ? w->frames : work->index;
    w->width = glint_image_width(work->image);
    w->height = glint_image_height(work->image);
    w->samples = work->render.desc.samples;
    w->own_samples = work->render.own_samples;
    w->error = -1;
    w->render_ms = work->stats.render_ms;
    w->ms = glintL_now_ms() - w->since_ms;
    w->pictures++;
    w->failure[0] = '\0';
    publish(w, picture);
    if (w->output->json)
        print_picture_event(w);
    draw(w);
}

static void around_render(void *context, const glintL_run *run, bool begins)
{
    watcher *w = context;
    if (begins) {
        watch_requests_begin_render(&w->requests, run->renderer, w->now == PREVIEW);
    } else if (watch_requests_end_render(&w->requests)) { // a cancelled renderer cannot be used again
        glint_renderer_destroy(w->run->renderer);
        w->run->renderer = NULL;
    }
}

// Shows a warning below the picture. Later runs do not repeat the warnings of the preview.
static void warn(void *context, const char *message)
{
    watcher *w = context;
    size_t used = strlen(w->warnings);
    if (w->now != PREVIEW)
        return;
    snprintf(w->warnings + used, sizeof w->warnings - used, "%swarning: %s", used ? "\n" : "", message);
    cli_warning_event(w->output, message);
}

static void note_mesh(void *context, const char *path)
{
    watcher *w = context;
    watch_files_add(w->files, path, false);
}

static int note_file(lua_State *L)
{
    watcher *w = lua_touserdata(L, lua_upvalueindex(1));
    watch_files_add(w->files, luaL_checkstring(L, 1), lua_toboolean(L, 2));
    return 0;
}

static int skip_file(lua_State *L)
{
    watcher *w = lua_touserdata(L, lua_upvalueindex(1));
    watch_files_skip(w->files, luaL_checkstring(L, 1));
    return 0;
}

static watcher *current; // for the hook, whose only argument is the state

// Ends a script that was changed in the meantime, even one that would never end by itself.
static void look(lua_State *L, lua_Debug *where)
{
    (void)where;
    if (atomic_load(&current->requests.supersedes))
        luaL_error(L, "changed meanwhile");
}

static void prepare(void *context, lua_State *L)
{
    watcher *w = context;
    if (luaL_loadbufferx(L, watch_track_lua, sizeof watch_track_lua, "=watch", "t") != LUA_OK)
        lua_error(L);
    lua_pushlightuserdata(L, w);
    lua_pushcclosure(L, note_file, 1);
    lua_pushlightuserdata(L, w);
    lua_pushcclosure(L, skip_file, 1);
    lua_call(L, 2, 0);
    lua_sethook(L, look, LUA_MASKCOUNT, STEPS_BETWEEN_LOOKS);
}

// ---- One run ----

// Selects `frame`, if the script has it; w->shown tells.
static void select_frame(watcher *w, int64_t frame)
{
    glintL_selection_clear(&w->run->request.selection);
    if (!glintL_selection_add(&w->run->request.selection, (glintL_range) { frame, frame, 1 }))
        glintL_run_fail(w->run, GLINTL_EXIT_FAILED, 0, "out of memory");
}

// Gives the renderer of this quality to the run, and takes the run's previous renderer back.
static void take_renderer(watcher *w, quality now)
{
    glintL_run *run = w->run;
    if (now == w->now)
        return;
    w->renderers[w->now] = run->renderer;
    run->renderer = w->renderers[now];
    run->renderer_threads = run->request.threads;
    w->renderers[now] = NULL;
    w->now = now;
}

// Returns the number in a field of the table at `spec`; `missing` if there is none.
static double number_or(lua_State *L, int spec, const char *name, double missing)
{
    const double number = lua_getfield(L, spec, name) == LUA_TNUMBER ? lua_tonumber(L, -1) : missing;
    lua_pop(L, 1);
    return number;
}

// Prints the parameters as JSON. Returns the list for watch_requests.
static int params_protected(lua_State *L)
{
    cli_print_params(L, lua_touserdata(L, 1));
    glintL_push_params(L); // 2
    lua_pushliteral(L, "\n"); // 3: the list
    for (lua_Integer i = 1, count = luaL_len(L, 2); i <= count; i++) {
        lua_rawgeti(L, 2, i); // 4
        lua_getfield(L, 4, "name");
        lua_getfield(L, 4, "type");
        lua_getfield(L, 4, "whole");
        const char *type = lua_tostring(L, 6);
        const bool chooses = lua_getfield(L, 4, "choices") == LUA_TTABLE;
        char range[64];
        snprintf(range, sizeof range, "%c%.17g %.17g", *type == 's' && chooses ? 'c' : *type == 'n' && lua_toboolean(L, 7) ? 'w' : *type, number_or(L, 4, "min", -HUGE_VAL),
                 number_or(L, 4, "max", HUGE_VAL));
        lua_pushfstring(L, "%s%s=%s=%s\n", lua_tostring(L, 3), lua_tostring(L, 5), range, glintL_push_allowed(L, 4));
        lua_replace(L, 3);
        lua_settop(L, 3);
    }
    return 1;
}

static void keep_params(watcher *w)
{
    char *text = NULL;
    size_t size = 0;
    lua_State *L = w->script.state;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return;
    lua_pushcfunction(L, params_protected);
    lua_pushlightuserdata(L, out);
    const bool good = lua_pcall(L, 1, 1, 0) == LUA_OK;
    char *names = good ? strdup(lua_tostring(L, -1)) : NULL;
    lua_pop(L, 1);
    text = glintL_close_text(out, &text);
    if (text && names) {
        free(w->params);
        w->params = text;
        watch_requests_know(&w->requests, names);
    } else {
        free(text);
        free(names);
    }
}

static void free_run_sets(watcher *w)
{
    watch_free_sets(w->run->request.sets, w->run->request.set_count);
    w->run->request.sets = NULL;
    w->run->request.set_count = 0;
}

static void begin_run(watcher *w, quality now)
{
    glintL_run *run = w->run;
    take_renderer(w, now);
    glintL_run_reset(run);
    run->mode = GLINTL_MODE_WATCH;
    run->preview_side = now == PREVIEW ? PREVIEW_SIDE : 0;
    w->shown = false;
    if (now == PREVIEW)
        w->warnings[0] = '\0';
}

// Runs the script from the beginning. Its calls of scene:render render immediately.
static bool run_script(watcher *w, quality now)
{
    glintL_run *run = w->run;
    cli_close_script(&w->script);
    free_run_sets(w);
    begin_run(w, now);
    select_frame(w, watch_requests_frame(&w->requests, 0));
    if (!watch_requests_sets(&w->requests, w->given, w->given_count, &run->request.sets, &run->request.set_count))
        return glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
    watch_files_begin(w->files);
    watch_files_add(w->files, w->options->script, false);
    if (access(w->options->script, F_OK) != 0 && errno == ENOENT)
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "%s is missing; glint renders it again as soon as it exists",
                               w->options->script);
    return cli_run_script(&w->script, w->options, run);
}

// Runs the jobs that the script returned.
static bool run_jobs(watcher *w)
{
    w->frames = w->calls + w->script.frames;
    w->run->count = w->calls;
    select_frame(w, watch_requests_frame(&w->requests, w->frames));
    return cli_run_jobs(&w->script, w->run);
}

// Runs a script with a loop of calls, which counts them as it runs. If it has fewer calls than the requested frame,
// shows its last one.
static bool run_calls(watcher *w, quality now)
{
    w->frames = w->run->count;
    if (w->shown || w->frames == 0)
        return true;
    watch_requests_frame(&w->requests, w->frames);
    return run_script(w, now);
}

// Shows the wanted frame at one quality. False: an error, or a newer request.
static bool render(watcher *w, quality now, bool run_again)
{
    bool good = true, has_jobs = w->script.state && w->script.has_jobs;
    if (run_again || !has_jobs || w->calls > 0) {
        good = run_script(w, now);
        has_jobs = good && w->script.has_jobs;
        w->calls = w->run->count;
        if (good) // otherwise the page keeps the controls needed to correct the mistake
            keep_params(w);
    } else {
        begin_run(w, now);
    }
    w->differs = w->differs || w->run->was_shrunk;
    if (good)
        good = has_jobs ? run_jobs(w) : run_calls(w, now);
    if (run_again)
        watch_files_end(w->files, good);
    w->differs = w->differs || w->run->was_shrunk;
    return glintL_run_collect(w->run, true) && good;
}

static bool is_superseded(watcher *w) { return watch_requests_waiting(&w->requests) || w->run->interrupted; }

// Renders the frame of jobs with at most `samples`, or its partner. False: an error, or a newer request.
static bool render_step(watcher *w, double samples, bool is_partner)
{
    glintL_run_limit(w->run, samples, is_partner);
    const bool good = !is_superseded(w) && render(w, FULL, false);
    glintL_run_limit(w->run, 0, false);
    return good;
}

// Shows pictures with 1, 2, 4 ... samples, below the script's own number, and their errors. False: an error, or a newer
// request.
static bool show_steps(watcher *w)
{
    double samples = glintL_next_samples(0, w->own_samples, w->full_ms);
    while (samples < w->own_samples) {
        if (!render_step(w, samples, false) || (samples > 1 && !render_step(w, samples, true)))
            return false;
        samples = glintL_next_samples(samples, w->own_samples, w->render_ms / samples * w->own_samples);
    }
    return true;
}

// Shows the full picture, with steps before it and its error after it if the frame is a job's. A loop of calls would
// run as a whole for each picture. False: an error, or a newer request.
static bool show_full(watcher *w)
{
    const bool is_job = w->script.has_jobs && w->calls == 0;
    take_renderer(w, FULL);
    if ((is_job && !show_steps(w)) || is_superseded(w) || !render(w, FULL, false))
        return false;
    w->full_ms = w->render_ms;
    return !is_job || w->samples < 2 || render_step(w, w->samples, true);
}

static void answer(watcher *w, bool run_again)
{
    w->differs = false;
    bool good = render(w, PREVIEW, run_again);
    if (good && w->differs && !is_superseded(w))
        good = show_full(w);
    if (good && *w->failure) { // the error is fixed, with nothing new to show
        w->failure[0] = '\0';
        publish(w, NULL);
    }
    if (!good && !is_superseded(w))
        tell_error(w, w->run->message);
}

// ---- The command ----

static bool open_watcher(watcher *w, char message[GLINTL_MESSAGE_SIZE])
{
    glintL_run *run = w->run;
    if (!watch_requests_open(&w->requests, message))
        return false;
    w->files = watch_files_create(watch_requests_change, &w->requests, message);
    if (!w->files)
        return false;
    if (w->options->http_port >= 0) {
        watch_orders orders = watch_requests_orders(&w->requests);
        w->server = watch_server_create(w->options->http_port, &orders, message);
        if (!w->server)
            return false;
    }
    watch_terminal_open(&w->terminal, w->options->terminal, w->output->color && !w->output->quiet);
    w->given = run->request.sets; // the run gets new sets for each run
    w->given_count = run->request.set_count;
    run->request.sets = NULL;
    run->request.set_count = 0;
    run->request.force = true;
    run->request.render_text[glintL_render_find("output")] = "none";
    run->keeps_images = true;
    run->reporter = (glintL_reporter) {
        .context = w, .rendering = around_render, .warn = warn, .image = show, .prepare = prepare, .reads = note_mesh
    };
    w->requests.wanted = w->options->frame;
    return true;
}

static void close_watcher(watcher *w)
{
    cli_close_script(&w->script);
    free_run_sets(w);
    watch_files_destroy(w->files);
    watch_server_destroy(w->server);
    watch_requests_close(&w->requests);
    watch_terminal_close(&w->terminal);
    for (int i = 0; i < QUALITIES; i++)
        glint_renderer_destroy(w->renderers[i]);
    keep_picture(w, NULL, NULL);
    free(w->given);
    free(w->params);
}

// Prints the address of the page, and that watching has begun.
static void tell_start(watcher *w)
{
    if (w->server)
        fprintf(stderr, "glint: watching at %s\n", watch_server_url(w->server));
    if (!w->output->json)
        return;
    glintL_json(w->output->data, "{\"event\":\"watch\",\"script\":%s", w->run->script);
    if (w->server)
        glintL_json(w->output->data, ",\"url\":%s", watch_server_url(w->server));
    fputc('}', w->output->data);
    cli_end_line(w->output);
}

static bool take_request(watcher *w, watch_request *request)
{
    bool good = watch_requests_take(&w->requests, w->run, request);
    w->since_ms = good ? request->since_ms : 0;
    return good;
}

int cli_watch(cli_options *options, cli_output *output, glintL_run *run)
{
    watcher w = { .options = options, .output = output, .run = run };
    char message[GLINTL_MESSAGE_SIZE];
    watch_request request = { .run_again = true };
    const char *other = glintL_other_kind(options->script);
    const bool is_folder = other && strcmp(other, "folder") == 0;
    if (other || access(options->script, R_OK) != 0) {
        snprintf(message, sizeof message, "%.900s: %s%s", options->script, other && !is_folder ? "a script expected, got a " : "",
                 is_folder ? strerror(EISDIR) : other ? other : strerror(errno));
        return cli_report_error(output, 0, GLINTL_EXIT_USAGE, message);
    }
    bool good = open_watcher(&w, message);
    if (good) {
        current = &w;
        w.since_ms = glintL_now_ms();
        tell_start(&w);
        do {
            tell_change(&w, request.changed);
            answer(&w, request.run_again);
            w.has_begun = true;
        } while (!output->data_failed && !run->interrupted && take_request(&w, &request));
    }
    close_watcher(&w);
    if (!good)
        cli_report_error(output, 0, GLINTL_EXIT_USAGE, message);
    return good && !output->data_failed ? GLINTL_EXIT_DONE
           : output->data_failed        ? GLINTL_EXIT_FAILED
                                        : GLINTL_EXIT_USAGE;
}
