// glint relight FILE.exr: pictures with other strengths and colours of their lights, made from light passes, or a page
// that mixes them. The Lua module reads the options; this file reads, mixes and writes images.
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"
#include "bindings/run/film.h"

#define IMAGE "glint.lights"

static const unsigned char RELIGHT_LUA[] = {
#include "bindings/relight/relight.lua.h"
};
static const char PAGE[] = {
#include "bindings/relight/mixer.html.h"
};

typedef struct job {
    glintL_render render; // tone and encoding
    glintL_naming naming;
} job;

// Fails with the engine's message.
static int fail(lua_State *L, glint_status status, const glint_error *error)
{
    return cli_task_fail(L, glintL_run_exit_code(status), error->message);
}

// ---- Options ----

// lights(): returns the texts of --light.
static int lights(lua_State *L)
{
    const cli_options *options = cli_task_of(L)->options;
    lua_newtable(L);
    for (size_t i = 0; i < options->light_count; i++) {
        lua_pushstring(L, options->lights[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

// color(text): returns a colour as 0xRRGGBB; nothing if the text is none.
static int color(lua_State *L)
{
    size_t size;
    uint32_t value;
    const char *text = luaL_checklstring(L, 1, &size);
    if (!glintL_find_color(text, size, &value))
        return 0;
    lua_pushinteger(L, value);
    return 1;
}

// open(count): opens the output for this many pictures.
static int open_output(lua_State *L)
{
    const cli_task *task = cli_task_of(L);
    glintL_run *run = task->run;
    job *j = task->own;
    const char *path = task->options->output;
    char message[GLINTL_MESSAGE_SIZE];
    glintL_render_set_text(&j->render, glintL_render_find("output"), "none", message);
    if (glintL_film_kind_of(path, run->request.apng) == GLINTL_FILM_NONE && !glintL_name_check(path, message))
        return cli_task_fail(L, GLINTL_EXIT_USAGE, message);
    j->naming = (glintL_naming) { .pattern = path, .is_numbered = luaL_checkinteger(L, 1) > 1 };
    if (!glintL_film_open(run, path, &j->render, 24, message))
        return cli_task_fail(L, GLINTL_EXIT_USAGE, message);
    glintL_film_take(run, &j->naming);
    return 0;
}

// ---- Images ----

static int drop_image(lua_State *L)
{
    glint_image **image = lua_touserdata(L, 1);
    glint_image_release(*image);
    *image = NULL;
    return 0;
}

static const glint_image *check_image(lua_State *L, int index) { return *(glint_image **)luaL_checkudata(L, index, IMAGE); }

// read(path): returns a file's lights as an image, their names, and the name of the pass of all other lights.
static int read_image(lua_State *L)
{
    glint_error error;
    glint_image **image = glintL_push_owner(L, sizeof *image, IMAGE, drop_image);
    const glint_status status = glint_lights_read(luaL_checkstring(L, 1), image, &error);
    const char *name;
    if (status)
        return cli_task_fail(L, status == GLINT_ERR_NOMEM ? GLINTL_EXIT_FAILED : GLINTL_EXIT_USAGE, error.message);
    lua_newtable(L);
    for (size_t i = 0; (name = glint_image_light_pass(*image, i)); i++) {
        lua_pushstring(L, name);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_pushliteral(L, GLINT_LIGHT_OTHER);
    return 3;
}

// Returns the factors of the lights by `mix`, the strength and colour of each, at `index`.
static double (*push_factors(lua_State *L, int index))[3]
{
    const size_t count = (size_t)luaL_len(L, index);
    double(*factors)[3] = lua_newuserdatauv(L, (count + 1) * sizeof *factors, 0);
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        lua_getfield(L, -1, "strength");
        lua_getfield(L, -2, "color");
        const lua_Integer value = lua_tointeger(L, -1);
        for (int c = 0; c < 3; c++)
            factors[i][c] = lua_tonumber(L, -2) * glint_srgb_decode((value >> (16 - 8 * c) & 255) / 255.0);
        lua_pop(L, 3);
    }
    return factors;
}

// write(image, number, mix): writes a picture. Ends the module if a signal has stopped the run.
static int write_picture(lua_State *L)
{
    const cli_task *task = cli_task_of(L);
    const job *j = task->own;
    const lua_Integer number = luaL_checkinteger(L, 2);
    char path[GLINTL_PATH_SIZE];
    glint_error error;
    const glint_text text = { "Software", "glint " GLINT_VERSION };
    const glint_write_desc desc = { .struct_size = sizeof(glint_write_desc),
        .path = path, .pass = GLINT_PASS_BEAUTY, .tone = j->render.desc.tone, .encode = j->render.encode,
        .dpi = j->render.dpi, .text = &text, .text_count = 1,
    };
    if (!glintL_name_file(&j->naming, number, "beauty", path))
        return cli_task_fail(L, GLINTL_EXIT_USAGE, "-o: the file name is too long");
    const double(*factors)[3] = (const double(*)[3])push_factors(L, 3);
    glint_image **image = glintL_push_owner(L, sizeof *image, IMAGE, drop_image);
    glint_status status = glint_image_relight(check_image(L, 1), factors, image, &error);
    if (!status)
        status = glint_image_write(*image, &desc, &error);
    glint_image_release(*image);
    *image = NULL;
    if (status)
        return fail(L, status, &error);
    if (j->naming.film && !glintL_film_add(j->naming.film, number, path))
        return cli_task_fail(L, GLINTL_EXIT_FAILED, "out of memory");
    if (!j->naming.film)
        task->run->reporter.figure(task->run->reporter.context, "picture", path, 1);
    return task->run->interrupted ? cli_task_fail(L, 0, "interrupted") : 0;
}

// finish(): makes the film, if the output is one.
static int finish(lua_State *L)
{
    const cli_task *task = cli_task_of(L);
    if (!((const job *)task->own)->naming.film || glintL_films_finish(task->run))
        return 0;
    return cli_task_fail(L, task->run->exit_code, task->run->message);
}

// ---- The page ----

// tone(): returns the exposure and the number of the tone curve, and whether the rest is as the page shows it.
static int tone(lua_State *L)
{
    const glint_tone_desc *own = &((const job *)cli_task_of(L)->own)->render.desc.tone;
    const glint_tone_desc plain = glint_tone_desc_default();
    lua_pushnumber(L, own->exposure);
    lua_pushinteger(L, (lua_Integer)own->curve + 1);
    lua_pushboolean(L, own->bits == plain.bits && own->transfer == plain.transfer && own->rounding == plain.rounding && !own->dither);
    return 3;
}

// steps(curve): returns the least light for each pixel value 1 .. 255, as the bits of a float.
static int steps(lua_State *L)
{
    glint_tone_desc desc = glint_tone_desc_default();
    float least[255];
    desc.curve = (glint_tone_curve)(luaL_checkinteger(L, 1) - 1);
    glint_tone_steps(&desc, least);
    lua_createtable(L, 255, 0);
    for (int i = 0; i < 255; i++) {
        uint32_t bits;
        memcpy(&bits, &least[i], sizeof bits);
        lua_pushinteger(L, bits);
        lua_rawseti(L, -2, i + 1);
    }
    return 1;
}

// decode(value): returns the light of an sRGB value.
static int decode(lua_State *L)
{
    lua_pushnumber(L, glint_srgb_decode(luaL_checknumber(L, 1)));
    return 1;
}

// page(): returns the template and the version.
static int page(lua_State *L)
{
    lua_pushlstring(L, PAGE, sizeof PAGE);
    lua_pushliteral(L, GLINT_VERSION);
    return 2;
}

// Appends the light passes as an .exr of floats, in base64, piece by piece.
static glint_status append_pixels(lua_State *L, glint_draft *draft, const glint_image *image, glint_error *error)
{
    enum { PIECE = 3 << 18 };
    char *text = lua_newuserdatauv(L, PIECE / 3 * 4 + 4, 0);
    uint8_t *data = NULL;
    size_t size = 0;
    const glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = "lights.exr", .pass = GLINT_PASS_LIGHT, .tone = glint_tone_desc_default() };
    glint_status status = glint_image_to_bytes(image, &desc, &data, &size, error);
    for (size_t at = 0; at < size && !status; at += PIECE) {
        const size_t piece = size - at < PIECE ? size - at : PIECE;
        status = glint_draft_append(draft, text, glintL_base64(data + at, piece, text), error);
    }
    free(data);
    return status;
}

static int drop_draft(lua_State *L)
{
    glint_draft **draft = lua_touserdata(L, 1);
    glint_draft_destroy(*draft);
    *draft = NULL;
    return 0;
}

// write_page(before, image, after): writes the page, whose pixels are between these texts.
static int write_page(lua_State *L)
{
    size_t before, after;
    const char *head = luaL_checklstring(L, 1, &before), *tail = luaL_checklstring(L, 3, &after);
    glint_error error;
    glint_draft **draft = glintL_push_owner(L, sizeof *draft, "glint.draft", drop_draft);
    glint_status status = glint_draft_create(cli_task_of(L)->options->output, draft, &error);
    if (!status)
        status = glint_draft_append(*draft, head, before, &error);
    if (!status)
        status = append_pixels(L, *draft, check_image(L, 2), &error);
    if (!status)
        status = glint_draft_append(*draft, tail, after, &error);
    if (!status)
        status = glint_draft_finish(*draft, &error);
    return status ? fail(L, status, &error) : 0;
}

// ---- The command ----

int cli_relight(cli_options *options, cli_output *output, glintL_run *run)
{
    static const luaL_Reg functions[] = {
        { "lights", lights }, { "color", color },         { "open", open_output },  { "read", read_image },
        { "page", page },     { "write", write_picture }, { "finish", finish },     { "tone", tone },
        { "steps", steps },   { "decode", decode },       { "write_page", write_page }, { NULL, NULL },
    };
    const glintL_carried modules[] = { cli_files_module, { "@relight.lua", RELIGHT_LUA, sizeof RELIGHT_LUA } };
    job j = { .render = glintL_render_default() };
    cli_task task = { "relight", options, output, run, functions, &j, 0 };
    glintL_run_apply(run, &j.render);
    if (!output->quiet)
        output->progress = cli_progress_create(output->color);
    cli_run_module(&task, modules, 2);
    cli_progress_destroy(output->progress);
    output->progress = NULL;
    return task.code;
}
