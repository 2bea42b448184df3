// glint publish SCRIPT -o PAGE: one page with the engine, the script, the files it reads, its controls and a picture of
// the frame, shown until the engine has started. --live inserts the same figure into pages of other commands.
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bindings/command/cli.h"
#include "bindings/run/carried.h"
#include "bindings/run/system.h"

#define FILES_MAX 256
#define SAMPLES 4 // as glint-figure.js has at least
#define LETTERS 12 // smallest letters, CSS pixels
#define PHONE 356 // width of the page's text on a phone of 390 CSS pixels

static const char TRACK_LUA[] = {
#include "bindings/watch/track.lua.h"
};
static const unsigned char PAGE_LUA[] = {
#include "bindings/publish/page.lua.h"
};
static const char PAGE_HTML[] = {
#include "bindings/publish/page.html.h"
};
static const unsigned char DESCRIBE_LUA[] = {
#include "bindings/command/describe.lua.h"
};
static const glintL_carried MODULES[] = {
    { "@describe.lua", DESCRIBE_LUA, sizeof DESCRIBE_LUA },
    { "@page.lua", PAGE_LUA, sizeof PAGE_LUA },
};

typedef struct publication {
    const cli_options *options;
    const char *who; // publish or --live, for messages
    glintL_run *run;
    cli_script script;
    struct {
        char *path, *name; // path of a file that the script reads, and its name in the page; owned
    } files[FILES_MAX];
    size_t file_count;
    glint_image *image; // picture of the frame
    glintL_render render;
    int64_t frame;
    uint8_t *poster; // the picture without overlays; owned
    size_t poster_size;
    char *marks[2]; // SVG of its overlays, for the picture's own size and for a phone; NULL: none; owned
} publication;

// ---- The files of the script ----

static void add_file(publication *p, const char *path, const char *name)
{
    struct stat info;
    for (size_t i = 0; i < p->file_count; i++)
        if (strcmp(p->files[i].path, path) == 0)
            return;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode)) // the script itself reports a missing file
        return;
    if (p->file_count == FILES_MAX) {
        glintL_run_fail(p->run, GLINTL_EXIT_USAGE, 0, "%s: the script reads more than %d files", p->who, FILES_MAX);
        return;
    }
    p->files[p->file_count].path = strdup(path);
    p->files[p->file_count].name = strdup(name);
    if (!p->files[p->file_count].path || !p->files[p->file_count].name)
        glintL_run_fail(p->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    p->file_count++;
}

// Returns what a page cannot read about a file, and the formats that it can read; NULL: nothing.
static const char *refused_kind(const char *path)
{
    unsigned char first[4] = { 0 };
    FILE *file = fopen(path, "rb");
    if (!file || fread(first, sizeof first, 1, file) != 1)
        memset(first, 0, sizeof first);
    if (file)
        fclose(file);
    return memcmp(first, "\xff\xd8\xff", 3) == 0        ? "a JPEG, which pages cannot read: save it as .png"
           : memcmp(first, "\x76\x2f\x31\x01", 4) == 0 ? "an OpenEXR file, which pages cannot read: save it as .hdr or .pfm"
                                                       : NULL;
}

static void note_file(void *context, const char *path)
{
    publication *p = context;
    const char *kind = refused_kind(path);
    if (kind)
        glintL_run_fail(p->run, GLINTL_EXIT_USAGE, 0, "%s: %.200s is %s", p->who, path, kind);
    add_file(p, path, path);
}

// note(path, optional, module): adds a file, except glint's own modules, which the page has already.
static int note(lua_State *L)
{
    publication *p = lua_touserdata(L, lua_upvalueindex(1));
    const char *path = luaL_checkstring(L, 1), *module = lua_tostring(L, 3);
    if (!module)
        add_file(p, path, path);
    else if (strncmp(module, "glint/", 6) != 0)
        add_file(p, path, lua_pushfstring(L, "%s.lua", module));
    return 0;
}

static int skip(lua_State *L)
{
    (void)L; // skip(path): the script writes the file
    return 0;
}

static void prepare(void *context, lua_State *L)
{
    if (luaL_loadbufferx(L, TRACK_LUA, sizeof TRACK_LUA, "=publish", "t") != LUA_OK)
        lua_error(L);
    lua_pushlightuserdata(L, context);
    lua_pushcclosure(L, note, 1);
    lua_pushcfunction(L, skip);
    lua_call(L, 2, 0);
}

// ---- The picture ----

static void take_image(void *context, const glintL_run *run, const glintL_work *work)
{
    publication *p = context;
    (void)run;
    if (p->image)
        return;
    p->image = glint_image_retain(work->image);
    p->render = work->render;
    p->frame = work->index;
}

// Makes the overlays for the page's two widths.
static bool make_marks(publication *p)
{
    glint_error error;
    const int width = glint_image_width(p->image), height = glint_image_height(p->image);
    for (int i = 0; i < 2; i++) {
        const double scale = i ? fmin(1, (double)PHONE / width) : 1;
        const glint_page page = { .width = (int)(width * scale + 0.5), .height = (int)fmax(1, height * scale + 0.5), .scale = scale,
                                  .dpi = p->render.dpi, .least = LETTERS, .transfer = p->render.desc.tone.transfer };
        if (glint_image_overlays_svg(p->image, &page, &p->marks[i], &error))
            return glintL_run_fail(p->run, GLINTL_EXIT_FAILED, 0, "%s", error.message);
    }
    return true;
}

static bool render(publication *p)
{
    glintL_run *run = p->run;
    glint_error error;
    run->request.force = true;
    run->request.render_text[glintL_render_find("output")] = "none";
    run->keeps_images = true;
    run->no_sheets = true;
    run->least_samples = SAMPLES;
    run->reporter = (glintL_reporter) { .context = p, .image = take_image, .prepare = prepare, .reads = note_file };
    glintL_selection_clear(&run->request.selection);
    if (!glintL_selection_add(&run->request.selection, (glintL_range) { p->options->frame, p->options->frame, 1 }))
        return glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
    if (!cli_run_script(&p->script, p->options, run) || !glintL_call_settle(run) || !glintL_run_collect(run, true))
        return false;
    if (!p->image)
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "%s: the script has no frame %" PRId64, p->who,
                               p->options->frame);
    glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = "poster.png", .pass = GLINT_PASS_BEAUTY, .tone = p->render.desc.tone };
    desc.tone.bits = 8;
    if (glint_image_to_bytes(glint_image_without_overlays(p->image), &desc, &p->poster, &p->poster_size, &error) == GLINT_OK)
        return make_marks(p);
    return glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "%s", error.message);
}

// ---- The page ----

// Pushes the values of the parameters; raises if --set names an unknown one.
static int push_params(lua_State *L)
{
    if (glintL_push_unknown_set(L))
        return lua_error(L);
    glintL_push_params(L);
    return 1;
}

// Runs the script, and leaves its parameters on top of its stack. False: the run has failed.
static bool run_script(publication *p)
{
    if (!render(p))
        return false;
    lua_State *L = p->script.state;
    lua_settop(L, 0);
    lua_pushcfunction(L, push_params);
    return lua_pcall(L, 0, 1, 0) == LUA_OK || glintL_run_fail(p->run, GLINTL_EXIT_USAGE, 0, "%s", lua_tostring(L, -1));
}

static void add_files(lua_State *L, const publication *p)
{
    lua_newtable(L);
    for (size_t i = 0; i < p->file_count; i++) {
        lua_pushstring(L, p->files[i].path);
        lua_setfield(L, -2, p->files[i].name);
    }
    lua_setfield(L, -2, "files");
}

// render(): renders the frame. Returns the page's values. Raises nil if the run has failed.
static int push_page(lua_State *L)
{
    publication *p = lua_touserdata(L, lua_upvalueindex(1));
    if (!run_script(p)) {
        lua_pushnil(L);
        return lua_error(L);
    }
    lua_newtable(L);
    glintL_copy_value(p->script.state, -1, L);
    lua_setfield(L, -2, "params");
    glintL_set_text(L, "script", p->run->script);
    glintL_set_text(L, "path", p->options->script);
    glintL_set_text(L, "title", p->options->title);
    glintL_set_text(L, "controls", p->options->controls);
    glintL_set_flag(L, "shows_source", p->options->shows_source);
    glintL_set_text(L, "version", GLINT_VERSION);
    glintL_set_whole(L, "width", glint_image_width(p->image));
    glintL_set_whole(L, "height", glint_image_height(p->image));
    glintL_set_whole(L, "frame", p->frame);
    lua_pushlstring(L, PAGE_HTML, sizeof PAGE_HTML);
    lua_setfield(L, -2, "template");
    lua_pushlstring(L, (const char *)p->poster, p->poster_size);
    lua_setfield(L, -2, "poster");
    glintL_set_text(L, "wide", p->marks[0]);
    glintL_set_text(L, "narrow", p->marks[1]);
    add_files(L, p);
    return 1;
}

// Pushes the argument of the functions of page.lua.
static void push_tools(lua_State *L, const void *context)
{
    const publication *p = context;
    char folder[GLINTL_PATH_SIZE];
    lua_newtable(L);
    lua_pushlightuserdata(L, (void *)p);
    lua_pushcclosure(L, push_page, 1);
    lua_setfield(L, -2, "render");
    glintL_set_text(L, "who", p->who);
    if (glintL_program_folder(p->options->program, folder, sizeof folder))
        glintL_set_text(L, "program", folder);
}

// Runs the script and makes the page, or only its figure ("live"). The caller drops the text, on failure too.
static bool make(publication *p, const char *what, glintL_made_text *text)
{
    char message[GLINTL_MESSAGE_SIZE];
    if (glintL_make_text(MODULES, 2, what, push_tools, p, text, message))
        return true;
    if (!p->run->exit_code && !p->run->interrupted)
        glintL_run_fail(p->run, GLINTL_EXIT_USAGE, 0, "%s", message);
    return false;
}

static void destroy(publication *p)
{
    cli_close_script(&p->script);
    glint_image_release(p->image);
    for (size_t i = 0; i < p->file_count; i++) {
        free(p->files[i].path);
        free(p->files[i].name);
    }
    free(p->poster);
    free(p->marks[0]);
    free(p->marks[1]);
}

int cli_publish(cli_options *options, cli_output *output, glintL_run *run)
{
    publication p = { .options = options, .who = "publish", .run = run };
    glintL_made_text page = { .state = NULL };
    glint_error error;
    const char *ending = options->output ? strrchr(options->output, '.') : NULL;
    if (!ending || strcmp(ending, ".html") != 0)
        return cli_report_error(output, 0, GLINTL_EXIT_USAGE, "publish: expected -o PAGE.html");
    if (make(&p, "publish", &page) && glintL_write_text(options->output, page.text, page.size, &error) != GLINT_OK)
        glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "%s", error.message);
    glintL_drop_text(&page);
    destroy(&p);
    if (run->exit_code)
        cli_report_error(output, 0, run->exit_code, run->message);
    else
        cli_reporter(output).figure(output, "page", options->output, run->total > 0 ? run->total : run->count);
    return run->exit_code;
}

char *cli_live(const cli_options *options, const glintL_request *request, int *code, char message[GLINTL_MESSAGE_SIZE])
{
    cli_options own = *options;
    publication p = { .options = &own, .who = "--live", .run = glintL_run_create() };
    glintL_made_text figure = { .state = NULL };
    char *text = NULL;
    *code = GLINTL_EXIT_FAILED;
    snprintf(message, GLINTL_MESSAGE_SIZE, "--live: out of memory");
    if (!p.run)
        return NULL;
    if (options->live_script)
        own.script = options->live_script;
    p.run->is_command = true;
    snprintf(p.run->script, sizeof p.run->script, "%s", glintL_base_name(own.script));
    p.run->request.sets = request->sets;
    p.run->request.set_count = request->set_count;
    if (make(&p, "live", &figure))
        text = strdup(figure.text);
    if (p.run->exit_code) {
        *code = p.run->exit_code;
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", p.run->message);
    }
    glintL_drop_text(&figure);
    destroy(&p);
    p.run->request.sets = NULL;
    glintL_run_destroy(p.run);
    return text;
}
