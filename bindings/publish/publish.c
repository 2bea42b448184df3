// glint publish SCRIPT -o PAGE: one page with the engine, the script, the files it reads, its controls and a picture of
// the frame, shown until the engine has started. --live inserts the same figure into pages of other commands.
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bindings/command/cli.h"
#include "bindings/run/carried.h"
#include "bindings/run/system.h"

#define FILES_MAX 256
#define FILE_BYTES_MAX ((size_t)64 << 20) // limit of one file that the script reads

static const char TRACK_LUA[] = {
#include "bindings/watch/track.lua.h"
};
static const unsigned char PAGE_LUA[] = {
#include "bindings/publish/page.lua.h"
};
static const char PAGE_HTML[] = {
#include "bindings/publish/page.html.h"
};
static const glintL_carried MODULE = { "@page.lua", PAGE_LUA, sizeof PAGE_LUA };

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
    uint8_t *poster, *wasm, *engine; // owned
    size_t poster_size, wasm_size, engine_size;
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

static void note_file(void *context, const char *path) { add_file(context, path, path); }

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

static bool render(publication *p)
{
    glintL_run *run = p->run;
    glint_error error;
    run->request.force = true;
    run->request.render_text[glintL_render_find("output")] = "none";
    run->keeps_images = true;
    run->no_sheets = true;
    run->reporter = (glintL_reporter) { .context = p, .image = take_image, .prepare = prepare, .reads = note_file };
    glintL_selection_clear(&run->request.selection);
    if (!glintL_selection_add(&run->request.selection, (glintL_range) { p->options->frame, p->options->frame, 1 }))
        return glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
    if (!cli_run_script(&p->script, p->options, run) || !glintL_call_settle(run) || !glintL_run_collect(run, true))
        return false;
    if (!p->image)
        return glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "%s: the script has no frame %" PRId64, p->who,
                               p->options->frame);
    glint_write_desc desc = { .path = "poster.png", .pass = GLINT_PASS_BEAUTY, .tone = p->render.desc.tone };
    desc.tone.bits = 8;
    if (glint_image_to_bytes(p->image, &desc, &p->poster, &p->poster_size, &error) == GLINT_OK)
        return true;
    return glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "%s", error.message);
}

// ---- The engine for the page ----

// Reads a whole file. NULL: errno gives the reason.
static uint8_t *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rbe");
    struct stat info;
    if (!file)
        return NULL;
    uint8_t *bytes = NULL;
    errno = EFBIG;
    if (fstat(fileno(file), &info) == 0 && S_ISREG(info.st_mode) && (uintmax_t)info.st_size <= FILE_BYTES_MAX)
        bytes = malloc((size_t)info.st_size + 1);
    if (bytes && (*size = fread(bytes, 1, (size_t)info.st_size, file)) < (size_t)info.st_size) {
        free(bytes);
        bytes = NULL;
        errno = EIO;
    }
    fclose(file);
    return bytes;
}

// Reads a file of the folder made by `make web`: GLINT_WEB, web/ next to the command, or ../share/glint/web.
static uint8_t *read_part(const publication *p, const char *name, size_t *size)
{
    char folder[GLINTL_PATH_SIZE], path[GLINTL_PATH_SIZE + 64];
    const char *given = getenv("GLINT_WEB");
    if (given && *given) {
        snprintf(path, sizeof path, "%.4000s/%s", given, name);
        return read_file(path, size);
    }
    if (!glintL_program_folder(p->options->program, folder, sizeof folder))
        return NULL;
    snprintf(path, sizeof path, "%.4000sweb/%s", folder, name);
    uint8_t *bytes = read_file(path, size);
    if (bytes)
        return bytes;
    snprintf(path, sizeof path, "%.4000s../share/glint/web/%s", folder, name);
    return read_file(path, size);
}

static bool read_engine(publication *p)
{
    p->wasm = read_part(p, "glint.wasm.gz", &p->wasm_size);
    p->engine = p->wasm ? read_part(p, "publish.js", &p->engine_size) : NULL;
    return p->engine ||
           glintL_run_fail(p->run, GLINTL_EXIT_USAGE, 0,
                           "%s: the engine for pages is missing (glint.wasm.gz, publish.js). Build it with `make "
                           "web`, then run build/glint, or install glint again",
                           p->who);
}

// ---- The page ----

static void set_text(lua_State *L, const char *name, const void *bytes, size_t size)
{
    lua_pushlstring(L, bytes, size);
    lua_setfield(L, -2, name);
}

// Pushes the bytes of a file. May raise.
static void push_file(lua_State *L, const char *path)
{
    size_t size = 0;
    uint8_t *bytes = read_file(path, &size);
    if (!bytes)
        luaL_error(L, "%s: %s", path, strerror(errno));
    lua_pushlstring(L, (const char *)bytes, size);
    free(bytes);
}

static void push_page(lua_State *L, const void *context)
{
    const publication *p = context;
    lua_newtable(L);
    glintL_copy_value(p->script.state, -1, L);
    lua_setfield(L, -2, "params");
    glintL_set_text(L, "script", p->run->script);
    lua_pushlstring(L, p->options->script, (size_t)(glintL_base_name(p->options->script) - p->options->script));
    lua_setfield(L, -2, "folder");
    push_file(L, p->options->script);
    lua_setfield(L, -2, "source");
    glintL_set_text(L, "title", p->options->title ? p->options->title : p->run->script);
    glintL_set_text(L, "controls", p->options->controls);
    glintL_set_flag(L, "shows_source", p->options->shows_source);
    lua_pushliteral(L, GLINT_VERSION);
    lua_setfield(L, -2, "version");
    glintL_set_whole(L, "width", glint_image_width(p->image));
    glintL_set_whole(L, "height", glint_image_height(p->image));
    glintL_set_whole(L, "frame", p->frame);
    set_text(L, "template", PAGE_HTML, sizeof PAGE_HTML);
    set_text(L, "poster", p->poster, p->poster_size);
    set_text(L, "wasm", p->wasm, p->wasm_size);
    set_text(L, "engine", p->engine, p->engine_size);
    lua_newtable(L);
    for (size_t i = 0; i < p->file_count; i++) {
        push_file(L, p->files[i].path);
        lua_setfield(L, -2, p->files[i].name);
    }
    lua_setfield(L, -2, "files");
}

typedef struct making {
    const publication *of;
    const char *what; // the function of page.lua: publish or live
    glintL_made_text text;
} making;

static int make_text(lua_State *L)
{
    making *job = lua_touserdata(L, 1);
    char message[GLINTL_MESSAGE_SIZE];
    if (glintL_push_unknown_set(L))
        return lua_error(L);
    glintL_push_params(L);
    const bool is_made = glintL_make_text(&MODULE, 1, job->what, push_page, job->of, &job->text, message);
    return is_made ? 0 : luaL_error(L, "%s", message);
}

// Runs the script and makes the page, or only its figure. The caller drops the text, on failure too.
static bool make(publication *p, making *job)
{
    if (!read_engine(p) || !render(p))
        return false;
    lua_State *L = p->script.state;
    lua_settop(L, 0);
    lua_pushcfunction(L, make_text);
    lua_pushlightuserdata(L, job);
    return lua_pcall(L, 1, 0, 0) == LUA_OK || glintL_run_fail(p->run, GLINTL_EXIT_USAGE, 0, "%s", lua_tostring(L, -1));
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
    free(p->wasm);
    free(p->engine);
}

int cli_publish(cli_options *options, cli_output *output, glintL_run *run)
{
    publication p = { .options = options, .who = "publish", .run = run };
    making page = { .of = &p, .what = "publish" };
    glint_error error;
    const char *ending = options->output ? strrchr(options->output, '.') : NULL;
    if (!ending || strcmp(ending, ".html") != 0)
        return cli_report_error(output, 0, GLINTL_EXIT_USAGE, "publish: expected -o PAGE.html");
    if (make(&p, &page) && glintL_write_text(options->output, page.text.text, page.text.size, &error) != GLINT_OK)
        glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "%s", error.message);
    glintL_drop_text(&page.text);
    destroy(&p);
    if (run->exit_code)
        cli_report_error(output, 0, run->exit_code, run->message);
    else
        cli_reporter(output).figure(output, "page", options->output, 1);
    return run->exit_code;
}

char *cli_live(const cli_options *options, const glintL_request *request, int *code, char message[GLINTL_MESSAGE_SIZE])
{
    cli_options own = *options;
    publication p = { .options = &own, .who = "--live", .run = glintL_run_create() };
    making figure = { .of = &p, .what = "live" };
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
    if (make(&p, &figure))
        text = strdup(figure.text.text);
    if (p.run->exit_code) {
        *code = p.run->exit_code;
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", p.run->message);
    }
    glintL_drop_text(&figure.text);
    destroy(&p);
    p.run->request.sets = NULL;
    glintL_run_destroy(p.run);
    return text;
}
