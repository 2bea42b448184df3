// The module for browsers and Node: one job in the memory of WebAssembly. worker.mjs calls the functions here.
//
// The job's files are in a file system in memory. The script runs once for each set of parameters. Its frames are
// rendered as by glint watch, with a renderer that reuses unchanged parts and one for steps.
#include <emscripten.h>
#include <inttypes.h>
#include <lualib.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/command/points.h"
#include "bindings/command/untrusted.h"
#include "bindings/run/carried.h"
#include "bindings/run/film.h"
#include "engine/glint_compare.h"

#define INSTRUCTIONS 1000 // instructions of the script between two checks of the clock
#define REUSE_MEMORY ((size_t)256 << 20)
#define SETS_MAX 256
#define WARNINGS_SIZE 8192

typedef struct web_job {
    cli_options options;
    cli_script script;
    glintL_run *run;
    glintL_set sets[SETS_MAX]; // their strings are owned
    double seconds, until_ms; // time limit of the script in one call; the deadline
    double render_ms; // start of the current render
    int64_t calls; // number of calls of scene:render in the script; the frames of its jobs have higher numbers
    int64_t frames;
    double width, height, samples; // size of the first frame, and samples of its pixels
    double fps; // frame rate of the first animation; 24 for calls of scene:render
    char *params, *plan, *handles; // JSON; owned
    glint_image *image; // picture of the last frame
    glintL_render render;
    glint_camera_desc camera; // camera of the last frame
    double sample_ms; // time that a sample of the last picture took; 0: unknown
    double pixel_ms; // time that the last picture took for its pixels
    double casts; // primary rays that the last picture cast
    double error; // estimate for the last picture; < 0: unknown
    bool is_doubtful; // the estimate is not to be trusted
    uint8_t *bytes; // result of the last request; owned
    char *marks; // SVG of the last picture's overlays; owned
    char warnings[WARNINGS_SIZE]; // warnings of the last call, one per line
} web_job;

static web_job job;

#include "bindings/web/library.h" // LIBRARY

static const unsigned char PRELUDE[] = {
#include "bindings/web/prelude.lua.h"
};

// ---- Parts of the command that are missing here ----

bool glintL_has_ffmpeg(void) { return false; }

int glintL_film_pipe(glintL_run *run, const glintL_film *film, char message[GLINTL_MESSAGE_SIZE])
{
    (void)run, (void)film;
    snprintf(message, GLINTL_MESSAGE_SIZE, "a page cannot make films");
    return GLINTL_EXIT_USAGE;
}

void cli_carry_dialect(lua_State *L) { (void)L; }

void cli_open_dialect(lua_State *L, const cli_options *options) { (void)L, (void)options; }

int64_t cli_sweep_points(const cli_options *options)
{
    (void)options;
    return 0; // there is no --sweep
}

void cli_sweep_to(cli_options *options, glintL_run *run, int64_t point) { (void)options, (void)run, (void)point; }

bool cli_order_points(cli_options *options, cli_output *output, glintL_run *run)
{
    (void)options, (void)output, (void)run;
    return true;
}

void cli_hush_script(lua_State *L) { (void)L; } // there is no --exposure auto, which would run a script twice

// ---- The script's Lua ----

// Raises when the script's time is over. Once this hook has raised, each further instruction raises again, so that no
// pcall can continue.
static void look(lua_State *L, lua_Debug *where)
{
    (void)where;
    if (glintL_now_ms() < job.until_ms)
        return;
    lua_sethook(L, look, LUA_MASKCOUNT, 1);
    luaL_where(L, 0);
    lua_pushfstring(L, "%sthe script took longer than %f s", lua_tostring(L, -1), (lua_Number)job.seconds);
    lua_error(L);
}

// Pushes the text of the module with a name, or nil.
static int carried_text(lua_State *L)
{
    const char *name = luaL_checkstring(L, 1);
    for (size_t i = 0; i < sizeof LIBRARY / sizeof *LIBRARY; i++)
        if (strcmp(LIBRARY[i].name, name) == 0) {
            lua_pushlstring(L, (const char *)LIBRARY[i].text, LIBRARY[i].size);
            return 1;
        }
    return 0;
}

static int collect_garbage(lua_State *L)
{
    lua_gc(L, LUA_GCCOLLECT);
    return 0;
}

// Runs prelude.lua in the reduced Lua of --untrusted, which cli_run_script has opened.
static void prepare(void *context, lua_State *L)
{
    (void)context;
    if (luaL_loadbufferx(L, (const char *)PRELUDE, sizeof PRELUDE, "=prelude", "t") != LUA_OK)
        lua_error(L);
    lua_pushcfunction(L, carried_text);
    lua_pushcfunction(L, collect_garbage);
    lua_pushcfunction(L, luaopen_io);
    lua_call(L, 0, 1);
    lua_pushcfunction(L, luaopen_os);
    lua_call(L, 0, 1);
    lua_call(L, 4, 0);
    lua_settop(L, 0);
    lua_sethook(L, look, LUA_MASKCOUNT, INSTRUCTIONS);
}

// ---- The run's reporter ----

EM_JS(void, tell_rendering, (int begins), {
    if (Module["rendering"])
        Module["rendering"](!!begins);
})

// Excludes the time of a render from the script's time.
static void around_render(void *context, const glintL_run *run, bool begins)
{
    (void)context, (void)run;
    if (begins)
        job.render_ms = glintL_now_ms();
    else
        job.until_ms += glintL_now_ms() - job.render_ms;
    tell_rendering(begins);
}

// Returns the number of samples of a picture.
static double samples_of(const glint_render_desc *desc) { return desc->width * desc->height * desc->samples; }

static void take_image(void *context, const glintL_run *run, const glintL_work *work)
{
    glint_error error;
    (void)context;
    if (run->renders_partner) {
        if (glint_estimate_error(job.image, work->image, NULL, &job.error, &error))
            glintL_run_fail(job.run, GLINTL_EXIT_FAILED, work->index, "%s", error.message);
        job.is_doubtful = glint_estimate_pixels(job.image, work->image, NULL) < GLINTL_ESTIMATE_PIXELS;
        return;
    }
    glint_image_release(job.image);
    job.image = glint_image_retain(work->image);
    job.render = work->render;
    job.camera = work->camera;
    job.pixel_ms = work->stats.render_ms + work->stats.tone_ms; // a browser's clock is too coarse to tell them apart
    job.sample_ms = job.pixel_ms / samples_of(&job.render.desc);
    job.casts = (double)work->stats.rays.primary;
}

static void warn(void *context, const char *message)
{
    (void)context;
    const size_t used = strlen(job.warnings);
    snprintf(job.warnings + used, sizeof job.warnings - used, "%s%s", used ? "\n" : "", message);
}

static void ignore_frame(void *context, const glintL_run *run, const glintL_record *record)
{
    (void)context, (void)run, (void)record;
}

static void ignore_figure(void *context, const char *kind, const char *path, int64_t count)
{
    (void)context, (void)kind, (void)path, (void)count;
}

// ---- One run ----

static void begin_run(void)
{
    glintL_run_reset(job.run);
    job.run->mode = GLINTL_MODE_WATCH;
    job.until_ms = glintL_now_ms() + 1e3 * job.seconds;
}

// Runs the script and renders the call of scene:render that is the frame; 0: none.
static bool run_script(int64_t frame)
{
    glintL_selection *selection = &job.run->request.selection;
    const int64_t number = frame ? frame : INT64_MAX;
    cli_close_script(&job.script);
    begin_run();
    glintL_selection_clear(selection);
    if (!glintL_selection_add(selection, (glintL_range) { number, number, 1 }))
        return glintL_run_fail(job.run, GLINTL_EXIT_FAILED, 0, "out of memory");
    return cli_run_script(&job.script, &job.options, job.run);
}

// Returns the job of a frame, which the script's list of jobs has, and its options.
static const glintL_job *job_of(int64_t frame, glintL_render *render)
{
    lua_State *L = job.script.state;
    const glintL_job *found = NULL;
    lua_rawgeti(L, LUA_REGISTRYINDEX, job.script.jobs);
    for (lua_Integer i = 1; frame > 0; i++) {
        lua_rawgeti(L, -1, i);
        found = lua_touserdata(L, -1);
        frame -= found->frames;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    *render = found->render;
    glintL_run_apply(job.run, render);
    return found;
}

// Stores the size and samples of the list's first frame, and the frame rate.
static void measure_job(void)
{
    glintL_render render;
    job.fps = job_of(1, &render)->fps;
    job.width = render.desc.width;
    job.height = render.desc.height;
    job.samples = render.desc.samples;
}

// Plans a frame in a separate run of the script. The run owns the plan.
static bool explain(int64_t frame)
{
    cli_script script;
    begin_run();
    job.run->mode = GLINTL_MODE_EXPLAIN;
    job.run->explain_frame = frame;
    glintL_selection_clear(&job.run->request.selection);
    cli_run_script(&script, &job.options, job.run);
    cli_close_script(&script);
    return job.run->explain_plan != NULL;
}

// Stores the size and samples of the first call of scene:render.
static bool measure_call(void)
{
    if (!explain(1))
        return false;
    const glint_render_desc *desc = glint_plan_render_desc(job.run->explain_plan);
    job.width = desc->width;
    job.height = desc->height;
    job.samples = desc->samples;
    return true;
}

// Writes the handle of a point: its place in the picture, as fractions of width and height, and the vectors that one
// width to the right and one height down move it in the plane through it that faces the camera.
static void print_handle(FILE *out, const char *name, const double point[3])
{
    const double width = job.render.desc.width, height = job.render.desc.height;
    double pixel[2], depth, near[3], far[3], along = 0, square = 0, moved[2][3];
    if (!glint_camera_project(&job.camera, width, height, point, pixel, &depth))
        return;
    glint_camera_point(&job.camera, width, height, pixel, 0, near);
    glint_camera_point(&job.camera, width, height, pixel, 1, far);
    for (int i = 0; i < 3; i++) {
        along += (point[i] - near[i]) * (far[i] - near[i]);
        square += (far[i] - near[i]) * (far[i] - near[i]);
    }
    for (int axis = 0; axis < 2; axis++)
        glint_camera_point(&job.camera, width, height,
                           (const double[]) { pixel[0] + (axis == 0 ? width : 0), pixel[1] + (axis == 1 ? height : 0) },
                           along / square, moved[axis]);
    fputs(ftell(out) > 1 ? ",{\"name\":" : "{\"name\":", out);
    glintL_json_string(out, name);
    fprintf(out, ",\"x\":%.9g,\"y\":%.9g", pixel[0] / width, pixel[1] / height);
    for (int axis = 0; axis < 2; axis++)
        fprintf(out, ",\"%s\":[%.17g,%.17g,%.17g]", axis == 0 ? "right" : "down", moved[axis][0] - point[0],
                moved[axis][1] - point[1], moved[axis][2] - point[2]);
    fputc('}', out);
}

static int print_handles(lua_State *L)
{
    FILE *out = lua_touserdata(L, 1);
    glintL_push_params(L);
    const lua_Integer count = luaL_len(L, 2);
    fputc('[', out);
    for (lua_Integer i = 1; i <= count; i++) {
        lua_settop(L, 2);
        lua_rawgeti(L, 2, i);
        lua_getfield(L, 3, "drag");
        glintL_push_param_value(L, 3);
        const double *point = lua_toboolean(L, 4) ? glintL_to_vector(L, 5) : NULL;
        if (point && lua_getfield(L, 3, "name") == LUA_TSTRING)
            print_handle(out, lua_tostring(L, -1), point);
    }
    fputc(']', out);
    return 0;
}

static int print_params(lua_State *L)
{
    cli_print_params(L, lua_touserdata(L, 1));
    return 0;
}

// Stores what a function prints about the script.
static bool keep_text(lua_CFunction print, char **kept)
{
    char *text = NULL;
    size_t size = 0;
    lua_State *L = job.script.state;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return glintL_run_fail(job.run, GLINTL_EXIT_FAILED, 0, "out of memory");
    lua_pushcfunction(L, print);
    lua_pushlightuserdata(L, out);
    const bool good = lua_pcall(L, 1, 0, 0) == LUA_OK;
    free(*kept);
    *kept = glintL_close_text(out, &text);
    return (good && *kept) || glintL_run_fail(job.run, GLINTL_EXIT_FAILED, 0, "out of memory");
}

// ---- Functions for worker.mjs. They return true on success; on failure false, NULL or 0 ----

/// Begins the job of a script in the file system. seconds: time limit of the script in one call.
EMSCRIPTEN_KEEPALIVE bool web_open(const char *path, double seconds)
{
    job.run = glintL_run_create();
    char *script = strdup(path);
    if (!job.run || !script)
        return false;
    job.seconds = seconds;
    job.options = (cli_options) { .command = CLI_WATCH, .json = true, .script = script, .untrusted_s = seconds };
    snprintf(job.run->script, sizeof job.run->script, "%s", glintL_base_name(script));
    job.run->is_command = true;
    job.run->request.sets = job.sets;
    job.run->request.force = true;
    job.run->request.reuse_memory = REUSE_MEMORY;
    job.run->request.render_text[glintL_render_find("output")] = "none";
    job.run->reporter = (glintL_reporter) {
        .rendering = around_render, .frame = ignore_frame, .warn = warn, .figure = ignore_figure, .image = take_image, .prepare = prepare
    };
    return true;
}

EMSCRIPTEN_KEEPALIVE void web_clear_sets(void)
{
    for (; job.run->request.set_count > 0; job.run->request.set_count--) {
        glintL_set *set = &job.sets[job.run->request.set_count - 1];
        free((char *)(uintptr_t)set->name);
        free((char *)(uintptr_t)set->text);
    }
}

/// Sets a parameter for later runs, as --set name=text.
EMSCRIPTEN_KEEPALIVE bool web_set(const char *name, const char *text)
{
    glintL_set set = { .name = strdup(name), .text = strdup(text) };
    if (!set.name || !set.text || job.run->request.set_count == SETS_MAX)
        return glintL_run_fail(job.run, GLINTL_EXIT_FAILED, 0, "set: at most %d parameters expected", SETS_MAX);
    job.sets[job.run->request.set_count++] = set;
    return true;
}

/// Sets a field of scene:render{} for later frames, as text; NULL: uses the script's value.
EMSCRIPTEN_KEEPALIVE bool web_option(const char *name, const char *text)
{
    char message[GLINTL_MESSAGE_SIZE];
    glintL_render render = glintL_render_default();
    const int field = glintL_render_find(name);
    glintL_run_reset(job.run);
    if (field < 0)
        return glintL_run_fail(job.run, GLINTL_EXIT_USAGE, 0, "render: %s: no such field", name);
    if (text && !glintL_render_set_text(&render, field, text, message))
        return glintL_run_fail(job.run, GLINTL_EXIT_USAGE, 0, "%s: %s", name, message);
    free((char *)(uintptr_t)job.run->request.render_text[field]);
    job.run->request.render_text[field] = text ? strdup(text) : NULL;
    return true;
}

/// Runs the script with the parameters set so far, and finds its frames, size and parameters.
EMSCRIPTEN_KEEPALIVE bool web_run(void)
{
    job.warnings[0] = '\0';
    if (!run_script(0))
        return false;
    job.calls = job.run->count;
    job.fps = 24;
    job.frames = job.calls + (job.script.has_jobs ? job.script.frames : 0);
    if (!keep_text(print_params, &job.params))
        return false;
    if (job.calls == 0)
        measure_job();
    return job.calls == 0 || measure_call();
}

EMSCRIPTEN_KEEPALIVE double web_frames(void) { return (double)job.frames; }
EMSCRIPTEN_KEEPALIVE double web_width(void) { return job.width; }
EMSCRIPTEN_KEEPALIVE double web_height(void) { return job.height; }
EMSCRIPTEN_KEEPALIVE double web_first_samples(void) { return job.samples; }
EMSCRIPTEN_KEEPALIVE double web_fps(void) { return job.fps; }
EMSCRIPTEN_KEEPALIVE const char *web_params(void) { return job.params; }
EMSCRIPTEN_KEEPALIVE const char *web_warnings(void) { return job.warnings; }
EMSCRIPTEN_KEEPALIVE const char *web_message(void) { return job.run && *job.run->message ? job.run->message : "out of memory"; }

// Runs a script with calls of scene:render again; otherwise runs its jobs.
static bool render(int64_t frame)
{
    glintL_run *run = job.run;
    if (job.calls > 0 || !job.script.state) {
        if (!run_script(frame))
            return false;
    } else {
        begin_run();
        glintL_selection_clear(&run->request.selection);
        if (!glintL_selection_add(&run->request.selection, (glintL_range) { frame, frame, 1 }))
            return glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
    }
    run->count = job.calls;
    return !job.script.has_jobs || cli_run_jobs(&job.script, run);
}

/// Returns the frame's samples a pixel. Returns 0 if it cannot be shown in steps: for a call of scene:render, the whole
/// script would run for each step.
EMSCRIPTEN_KEEPALIVE double web_own_samples(double frame)
{
    glintL_render render;
    if (job.calls > 0 || !job.script.state || !(frame >= 1 && frame <= (double)job.frames))
        return 0;
    job_of((int64_t)frame, &render);
    return render.desc.samples;
}

/// Returns the limit of samples of the next step; 0 if the next picture is the full one. samples: of the picture now
/// shown, 0 if there is none.
EMSCRIPTEN_KEEPALIVE double web_next_samples(double frame, double samples)
{
    glintL_render render;
    job_of((int64_t)frame, &render);
    const double next = glintL_next_samples(samples, render.desc.samples, job.sample_ms * samples_of(&render.desc));
    return next < render.desc.samples ? next : 0;
}

/// Renders a frame. keeps: the image stores its float32 numbers; otherwise only pixel values, which are cached tile by
/// tile. samples: the most samples of a pixel; 0: no limit.
EMSCRIPTEN_KEEPALIVE bool web_render(double frame, bool keeps, double samples)
{
    job.run->keeps_images = keeps;
    job.warnings[0] = '\0';
    glint_image_release(job.image);
    job.image = NULL;
    if (!(frame >= 1 && frame <= (double)job.frames) || frame != floor(frame)) {
        glintL_run_reset(job.run);
        return glintL_run_fail(job.run, GLINTL_EXIT_USAGE, 0,
                               "frame: expected a frame of the script, 1 .. %" PRId64 ", got '%g'", job.frames, frame);
    }
    glintL_run_limit(job.run, samples, false);
    const bool good = render((int64_t)frame);
    glintL_run_limit(job.run, 0, false);
    if (!glintL_run_collect(job.run, true) || !good)
        return false;
    return job.image || glintL_run_fail(job.run, GLINTL_EXIT_FAILED, 0, "frame %g was not rendered", frame);
}

/// Estimates the error of the last picture, which must show this frame and have float32 values. Returns a negative number
/// on failure.
EMSCRIPTEN_KEEPALIVE double web_estimate(double frame)
{
    job.error = -1;
    job.run->keeps_images = true;
    glintL_run_limit(job.run, job.render.desc.samples, true);
    const bool good = render((int64_t)frame);
    glintL_run_limit(job.run, 0, false);
    return glintL_run_collect(job.run, true) && good ? job.error : -1;
}

/// Returns whether the last estimate is to be trusted.
EMSCRIPTEN_KEEPALIVE bool web_is_trusted(void) { return !job.is_doubtful; }

EMSCRIPTEN_KEEPALIVE double web_samples(void) { return job.render.desc.samples; }
EMSCRIPTEN_KEEPALIVE double web_pixel_ms(void) { return job.pixel_ms; }
EMSCRIPTEN_KEEPALIVE double web_casts(void) { return job.casts; }
EMSCRIPTEN_KEEPALIVE int web_image_width(void) { return glint_image_width(job.image); }
EMSCRIPTEN_KEEPALIVE int web_image_height(void) { return glint_image_height(job.image); }

/// Returns whether the view of the last frame may be turned.
EMSCRIPTEN_KEEPALIVE bool web_orbit(void) { return job.render.orbit.is_allowed; }

/// Returns the handles of the points that the reader may move in the last frame, as JSON.
EMSCRIPTEN_KEEPALIVE const char *web_handles(void)
{
    return job.script.state && keep_text(print_handles, &job.handles) ? job.handles : "[]";
}

// Returns the number of the pass with that name in the last frame, or -1.
static int find_pass(const char *name)
{
    const char *of = strncmp(name, "d:", 2) == 0 ? name + 2 : strncmp(name, "light:", 6) == 0 ? name + 6 : NULL, *other;
    const bool is_light = of && name[0] == 'l';
    for (int pass = 0; pass < GLINT_PASS_COUNT && !of; pass++)
        if (strcmp(glint_pass_name((glint_pass)pass), name) == 0)
            return glint_image_has_pass(job.image, (glint_pass)pass) ? pass : -1;
    for (size_t i = 0; of && (other = is_light ? glint_image_light_pass(job.image, i) : glint_image_derivative(job.image, i)); i++)
        if (strcmp(other, of) == 0)
            return (int)(i + (is_light ? GLINT_PASS_LIGHT : GLINT_PASS_DERIVATIVE));
    return -1;
}

// Returns the 8-bit values of a pass of the last frame, as in its .png: RGBA, top row first. is_plain: without overlays.
EMSCRIPTEN_KEEPALIVE const uint8_t *web_rgba(const char *view, bool is_plain)
{
    const glint_image *image = is_plain ? glint_image_without_overlays(job.image) : job.image;
    glint_error error;
    const int pass = strcmp(view, "beauty") == 0 ? GLINT_PASS_BEAUTY : find_pass(view);
    glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .pass = (glint_pass)pass, .tone = job.render.desc.tone, .dpi = job.render.dpi };
    if (pass < 0) {
        glintL_run_fail(job.run, GLINTL_EXIT_USAGE, 0, "view: no pass '%s'", view);
        return NULL;
    }
    desc.tone.bits = 8; // a screen shows no more
    free(job.bytes);
    job.bytes = malloc(4 * (size_t)web_image_width() * (size_t)web_image_height());
    if (job.bytes && glint_image_rgba(image, &desc, job.bytes, &error) == GLINT_OK)
        return job.bytes;
    glintL_run_fail(job.run, GLINTL_EXIT_FAILED, 0, "%s", job.bytes ? error.message : "out of memory");
    return NULL;
}

/// Returns the overlays of the last frame as an SVG element, "" if it has none. width, height: size on the page, in its
/// pixels. scale: pixels of the page per pixel of the script's own picture. least: smallest size of letters, pixels.
EMSCRIPTEN_KEEPALIVE const char *web_marks(int width, int height, double scale, double least)
{
    glint_error error;
    const glint_page page = {
        .width = width, .height = height, .scale = scale, .dpi = job.render.dpi, .least = least, .transfer = job.render.desc.tone.transfer
    };
    free(job.marks);
    job.marks = NULL;
    if (glint_image_overlays_svg(job.image, &page, &job.marks, &error) == GLINT_OK)
        return job.marks ? job.marks : "";
    glintL_run_fail(job.run, GLINTL_EXIT_FAILED, 0, "%s", error.message);
    return NULL;
}

/// Returns the name of light pass number `index` of the last frame, without "light:"; NULL: there are fewer.
EMSCRIPTEN_KEEPALIVE const char *web_light_pass(int index) { return glint_image_light_pass(job.image, (size_t)index); }

/// Returns the float32 numbers of a pass of the last frame as an .npy file, with its size in *size; valid until the
/// next call.
EMSCRIPTEN_KEEPALIVE const uint8_t *web_plane(const char *name, size_t *size)
{
    glint_error error;
    const int pass = find_pass(name);
    const glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = "plane.npy", .pass = (glint_pass)pass, .tone = job.render.desc.tone };
    free(job.bytes);
    job.bytes = NULL;
    if (pass < 0) {
        glintL_run_fail(job.run, GLINTL_EXIT_USAGE, 0, "passes: '%s' was not rendered", name);
        return NULL;
    }
    if (glint_image_to_bytes(job.image, &desc, &job.bytes, size, &error) == GLINT_OK)
        return job.bytes;
    glintL_run_fail(job.run, GLINTL_EXIT_FAILED, 0, "%s", error.message);
    return NULL;
}

/// Returns the output of `glint explain --json` for a frame; valid until the next call.
EMSCRIPTEN_KEEPALIVE const char *web_explain(double frame)
{
    char *text = NULL;
    size_t size = 0;
    cli_output output = { .data = open_memstream(&text, &size), .json = true, .quiet = true };
    job.warnings[0] = '\0';
    if (!output.data)
        return NULL;
    begin_run();
    job.options.frame = (int64_t)frame;
    const char **path = &job.run->request.render_text[glintL_render_find("output")]; // the plan of a file
    *path = NULL;
    job.run->keeps_images = false;
    cli_explain(&job.options, &output, job.run);
    *path = "none";
    free(job.plan);
    job.plan = glintL_close_text(output.data, &text);
    return job.run->exit_code ? NULL : job.plan;
}
