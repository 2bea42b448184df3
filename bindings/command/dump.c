// glint dump SCRIPT: writes the scene of one frame as a script. bindings/run/dump.lua makes the text, in the script's
// state.
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bindings/command/cli.h"
#include "bindings/run/carried.h"
#include "engine/glint_inspect.h"

typedef struct subject {
    glintL_run *run;
    glint_scene *scene;
    const glintL_render *render;
    char *text; // the script, owned; NULL: not made yet
    size_t size;
    const char *output; // the name of the script; NULL: standard output
} subject;

// ---- Functions for the module ----

// kind_of(userdata): returns "vector", "transform", "array", "pattern", "shader", "texture" or "object".
static int kind_of(lua_State *L)
{
    static const char *const types[] = { GLINTL_VECTOR_TYPE, "glint.transform", GLINTL_ARRAY, GLINTL_PATTERN, GLINTL_SHADER, GLINTL_TEXTURE };
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (luaL_testudata(L, 1, types[i])) {
            lua_pushstring(L, types[i] + sizeof "glint." - 1);
            return 1;
        }
    lua_pushliteral(L, "object");
    return 1;
}

// Adds number i of a list to the text, in lines of about 12 numbers.
static void add_number(luaL_Buffer *text, size_t i, double number)
{
    char out[40];
    glintL_format_number(out, number);
    luaL_addstring(text, i == 0 ? "" : i % 12 ? ", " : ",\n  ");
    luaL_addstring(text, out);
}

// join(array): returns the numbers of an array, row after row.
static int join(lua_State *L)
{
    const glintL_array *array = glintL_to_array(L, 1);
    luaL_Buffer text;
    luaL_buffinit(L, &text);
    for (size_t i = 0; array && i < array->count * array->width; i++)
        add_number(&text, i, array->is_whole ? (double)array->wholes[i] : array->numbers[i]);
    luaL_pushresult(&text);
    return 1;
}

// Divides by the length, in the order of the engine's own operations.
static void normalize(const double v[3], double out[3])
{
    const double length = sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
    for (int c = 0; c < 3; c++)
        out[c] = v[c] / length;
}

// Finds a multiple of a unit normal that has exactly this normal's direction, after the engine has normalised it.
static bool find_multiple(const double normal[3], double out[3])
{
    for (int i = 0; i < 4096; i++) {
        double back[3];
        for (int c = 0; c < 3; c++)
            out[c] = normal[c] * (1 + i / 1024.0);
        normalize(out, back);
        if (back[0] == normal[0] && back[1] == normal[1] && back[2] == normal[2])
            return true;
    }
    return false;
}

// join_normals(array): returns the numbers of normals that read back as the same bits; false and the row of a normal that
// has none.
static int join_normals(lua_State *L)
{
    const glintL_array *array = glintL_to_array(L, 1);
    luaL_Buffer text;
    luaL_buffinit(L, &text);
    for (size_t i = 0; array && i < array->count; i++) {
        double row[3];
        if (!find_multiple(array->numbers + 3 * i, row)) {
            lua_pushboolean(L, false);
            lua_pushinteger(L, (lua_Integer)i + 1);
            return 2;
        }
        for (size_t c = 0; c < 3; c++)
            add_number(&text, 3 * i + c, row[c]);
    }
    luaL_pushresult(&text);
    return 1;
}

// has_material(shape)
static int has_material(lua_State *L)
{
    const glint_shape *shape = glintL_test_object(L, 1, GLINTL_SHAPE);
    lua_pushboolean(L, shape && (glint_spheres_data(shape) || glint_shape_has_material(shape)));
    return 1;
}

// path(file): returns the absolute path of a file that exists.
static int absolute_path(lua_State *L)
{
    char *path = realpath(luaL_checkstring(L, 1), NULL);
    lua_pushstring(L, path ? path : lua_tostring(L, 1));
    free(path);
    return 1;
}

// Adds the corners of a face, of which triangle `first` is the first, as a list. Returns the number of triangles; 0: they
// are not a fan.
static size_t add_face(luaL_Buffer *text, const glint_mesh_data *data, size_t first)
{
    const uint32_t *at = data->triangles + 3 * first;
    size_t count = 1;
    char number[16];
    luaL_addstring(text, first == 0 ? "{ " : first % 4 ? ", { " : ",\n  { ");
    for (int c = 0; c < 3; c++) {
        snprintf(number, sizeof number, c ? ", %" PRIu32 : "%" PRIu32, at[c] + 1);
        luaL_addstring(text, number);
    }
    for (; first + count < data->triangle_count && data->faces[first + count] == data->faces[first]; count++) {
        const uint32_t *next = at + 3 * count;
        if (next[0] != at[0] || next[1] != next[-1])
            return 0;
        snprintf(number, sizeof number, ", %" PRIu32, next[2] + 1);
        luaL_addstring(text, number);
    }
    luaL_addstring(text, " }");
    return count;
}

// polygons(mesh): for a mesh with a light for each face, returns the faces as lists of corners, and the materials of the
// faces; nothing for another mesh, false if the faces cannot be found from their triangles.
static int polygons(lua_State *L)
{
    const glint_shape *shape = glintL_test_object(L, 1, GLINTL_SHAPE);
    glint_mesh_data data;
    luaL_Buffer text;
    if (!glint_mesh_get(shape, &data) || !data.faces || glint_shape_get(shape)->shading != GLINT_SHADING_FLAT)
        return 0;
    const uint32_t *index = glint_spheres_index(shape);
    bool good = !data.normal_corners && !data.uv_corners;
    luaL_buffinit(L, &text);
    for (size_t i = 0, count; i < data.triangle_count && good; i += count) {
        count = add_face(&text, &data, i);
        good = count > 0;
    }
    luaL_pushresult(&text);
    if (!good) {
        lua_pushboolean(L, false);
        return 1;
    }
    luaL_buffinit(L, &text);
    for (size_t i = 0, n = 0; index && i < data.triangle_count; i++)
        if (i == 0 || data.faces[i] != data.faces[i - 1])
            add_number(&text, n++, index[i] + 1);
    luaL_pushresult(&text);
    return 2;
}

// is_ambiguous(mesh): returns whether a list of values of the corners would be read as values of the vertices.
static int is_ambiguous(lua_State *L)
{
    glint_mesh_data data;
    bool in_order = true;
    if (!glint_mesh_get(glintL_test_object(L, 1, GLINTL_SHAPE), &data))
        return 0;
    for (size_t i = 0; i < 3 * data.triangle_count && in_order; i++)
        in_order = data.triangles[i] == i;
    lua_pushboolean(L, (data.normal_corners || data.uv_corners) && data.vertex_count == 3 * data.triangle_count && !in_order);
    return 1;
}

static void push_options(lua_State *L, const glintL_render *render)
{
    const glintL_render plain = glintL_render_default();
    lua_newtable(L);
    for (int i = 0; i < GLINTL_RENDER_FIELDS; i++) {
        char own[96] = "", usual[96] = "";
        glintL_render_spell(render, i, own);
        glintL_render_spell(&plain, i, usual);
        const bool is_listed = strcmp(glintL_render_fields[i].name, "passes") == 0 || strcmp(glintL_render_fields[i].name, "output") == 0;
        if (!is_listed && strcmp(own, usual) == 0)
            continue;
        glintL_render_push(L, i, render);
        lua_setfield(L, -2, glintL_render_fields[i].name);
    }
}

static int make_text(lua_State *L)
{
    static const luaL_Reg tools[] = {
        { "kind_of", kind_of }, { "join", join }, { "join_normals", join_normals },
        { "has_material", has_material }, { "path", absolute_path }, { "polygons", polygons }, { "is_ambiguous", is_ambiguous }, { NULL, NULL },
    };
    subject *what = lua_touserdata(L, 1);
    const glintL_run *run = glintL_get_run(L);
    size_t size;
    glintL_push_object(L, GLINTL_SCENE, what->scene);
    push_options(L, what->render);
    luaL_newlib(L, tools);
    lua_createtable(L, 0, 3);
    glintL_set_text(L, "script", run->script);
    glintL_set_text(L, "output", what->output);
    glintL_set_whole(L, "frame", run->explain_frame);
    glintL_call_own(L, "dump", "script", 4, 1);
    const char *text = lua_tolstring(L, -1, &size);
    what->text = malloc(size + 1);
    if (!what->text)
        return luaL_error(L, "out of memory");
    memcpy(what->text, text, size + 1);
    what->size = size;
    return 0;
}

// ---- The command ----

static void see_scene(lua_State *L, glint_scene *scene, const glintL_render *render)
{
    luaL_checkstack(L, 4, "dump");
    subject *what = glintL_get_run(L)->moments.data;
    what->scene = scene;
    what->render = render;
    lua_pushcfunction(L, make_text);
    lua_pushlightuserdata(L, what);
    if (lua_pcall(L, 1, 0, 0) == LUA_OK)
        return;
    const char *message = lua_tostring(L, -1);
    glintL_run_fail(what->run, GLINTL_EXIT_FAILED, 0, "%s", message ? message : "dump");
    lua_pop(L, 1);
}

// A frame of several moments has no single scene.
static bool see_moment(void *data, glint_scene *scene, int times, int k)
{
    (void)scene, (void)times, (void)k;
    return glintL_run_fail(((subject *)data)->run, GLINTL_EXIT_FAILED, 0,
                           "camera.shutter: the frame shows several moments, which one scene cannot; dump it with shutter = 0");
}

// Returns 0 if the file can be written, otherwise the exit code; then `message` is written.
static int check_name(const char *output, char message[GLINTL_MESSAGE_SIZE])
{
    const size_t length = strlen(output);
    if (length < 5 || strcmp(output + length - 4, ".lua") != 0)
        snprintf(message, GLINTL_MESSAGE_SIZE, "--output: expected the name of a .lua script, got '%.400s'", output);
    else if (access(output, F_OK) == 0)
        snprintf(message, GLINTL_MESSAGE_SIZE, "%.400s: it exists already and was not changed", output);
    else
        return 0;
    return GLINTL_EXIT_USAGE;
}

static int write_script(const cli_options *options, cli_output *output, const glintL_run *run, const subject *what)
{
    glint_error error;
    if (!options->output) {
        fwrite(what->text, 1, what->size, output->data);
        return GLINTL_EXIT_DONE;
    }
    const glint_status status = glintL_write_text(options->output, what->text, what->size, &error);
    if (status)
        return cli_report_error(output, 0, glintL_run_exit_code(status), error.message);
    if (options->json)
        glintL_json(output->data, "{\"event\":\"dump\",\"script\":%s,\"file\":%s}\n", run->script, options->output);
    else if (!output->quiet)
        fprintf(stderr, "%s: frame %" PRId64 " of %s\n", options->output, run->explain_frame, run->script);
    return GLINTL_EXIT_DONE;
}

int cli_dump(cli_options *options, cli_output *output, glintL_run *run)
{
    char message[GLINTL_MESSAGE_SIZE];
    subject what = { .run = run, .output = options->output };
    cli_script script;
    const int refused = options->output ? check_name(options->output, message) : 0;
    if (refused)
        return cli_report_error(output, 0, refused, message);
    const glintL_selection *selection = &run->request.selection;
    if (selection->range_count > 1 || (selection->range_count && selection->ranges->first != selection->ranges->last))
        return cli_report_error(output, 0, GLINTL_EXIT_USAGE, "--frames: expected one frame, such as -f 7");
    if (options->json && !options->output)
        return cli_report_error(output, 0, GLINTL_EXIT_USAGE, "--json: expected together with -o FILE.lua; without it, the script is printed");
    run->mode = GLINTL_MODE_EXPLAIN;
    run->explain_frame = selection->range_count ? selection->ranges->first : 1;
    run->see_scene = see_scene;
    run->moments.see = see_moment;
    run->moments.data = &what;
    glintL_selection_clear(&run->request.selection); // it has been read as the frame
    cli_run_script(&script, options, run);
    cli_close_script(&script);
    if (!run->exit_code && !run->interrupted && !what.text)
        glintL_run_fail(run, GLINTL_EXIT_USAGE, 0,
                        "--frame: expected a frame of the script, 1 .. %" PRId64 ", got '%" PRId64 "'", run->count,
                        run->explain_frame);
    int code = GLINTL_EXIT_FAILED;
    if (run->exit_code)
        code = cli_report_error(output, run->failed_index, run->exit_code, run->message);
    else if (!run->interrupted)
        code = write_script(options, output, run, &what);
    free(what.text);
    return code;
}
