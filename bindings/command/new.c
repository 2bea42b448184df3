// glint new NAME: writes a folder with a first scene and the type definitions for editors; NAME.lua: only the scene.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bindings/command/cli.h"
#include "bindings/run/system.h"

static const char STARTER[] =
    "-- Three spheres on a plane, and a lamp that goes around them.\n"
    "--\n"
    "--     glint %s                      every frame, as pictures\n"
    "--     glint %s --frames 1           only the first one\n"
    "--     glint %s --set radius=4       another value of a parameter\n"
    "--     glint %s -o film.png --apng   a film; .mp4, .webm and .gif need ffmpeg\n"
    "local glint = require \"glint\"\n"
    "\n"
    "-- Parameters can be set from the command line; --help lists them.\n"
    "local P = glint.params {\n"
    "  radius = { 8, min = 1, max = 40, doc = \"radius of the lamp's orbit, world units\" },\n"
    "  frames = { 48, min = 1, max = 1000, doc = \"frames in one turn of the lamp\" },\n"
    "}\n"
    "\n"
    "-- Colours are {r, g, b} or one number, linear; or \"#rrggbb\" and CSS names.\n"
    "local red = glint.material { diffuse = \"#d9594c\", specular = 0.6, shininess = 64 }\n"
    "local blue = glint.material { diffuse = \"#5a9fce\", specular = 0.3, shininess = 16, model = \"blinn_phong\" }\n"
    "local chalk = glint.material { diffuse = 0.75 }\n"
    "\n"
    "local lamp = glint.point_light { position = { 0, 8, 8 }, name = \"lamp\" }\n"
    "\n"
    "local scene = glint.scene {\n"
    "  camera = glint.camera { eye = { 0, 4, 14 }, at = { 0, 1.4, 0 }, fov = 35 },\n"
    "  ambient = 0.12,\n"
    "  background = \"#202838\",\n"
    "  lamp,\n"
    "  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = chalk },\n"
    "  glint.sphere { center = { 0, 2, 0 }, radius = 2, material = red },\n"
    "  glint.sphere { center = { 3.4, 1.2, 1 }, radius = 1.2, material = blue },\n"
    "  glint.sphere { center = { -3, 1, 1.6 }, radius = 1, material = chalk },\n"
    "}\n"
    "\n"
    "-- `frame` sets the scene to one moment: t goes from 0 to 1, here around once.\n"
    "return glint.animation {\n"
    "  scene = scene, frames = P.frames, fps = 24, cyclic = true, width = 640, height = 360, samples = 4,\n"
    "  frame = function(t)\n"
    "    local angle = 2 * math.pi * t\n"
    "    lamp.position = { P.radius * glint.sin(angle), 8, P.radius * glint.cos(angle) }\n"
    "  end,\n"
    "}\n";

static bool ends_in_lua(const char *path)
{
    size_t length = strlen(path);
    return length > 4 && path[length - 5] != '/' && strcmp(path + length - 4, ".lua") == 0;
}

static int refuse(cli_output *output, int code, const char *path, const char *why)
{
    char message[GLINTL_MESSAGE_SIZE];
    snprintf(message, sizeof message, "new: %.400s%s%s", path, *path ? ": " : "", why);
    return cli_report_error(output, 0, code, message);
}

// Closes a new file, and removes it if it is incomplete. Returns 0 or an errno.
static int finish(FILE *file, const char *path)
{
    int code = ferror(file) ? EIO : 0;
    if (fclose(file) != 0 && !code)
        code = errno;
    if (code)
        unlink(path);
    return code;
}

// Writes the script unless the file exists. Returns 0 or an errno.
static int write_script(const char *path)
{
    const char *name = glintL_base_name(path);
    FILE *file = fopen(path, "wx");
    if (!file)
        return errno;
    fprintf(file, STARTER, name, name, name, name);
    return finish(file, path);
}

// Finds the folder of type definitions: PREFIX/share/glint, or the folder next to a build. False: not found.
static bool find_types(const char *program, char out[GLINTL_PATH_SIZE])
{
    static const char *const places[] = { "../share/glint", "meta" };
    char folder[GLINTL_PATH_SIZE], path[GLINTL_PATH_SIZE + 64];
    if (!glintL_program_folder(program, folder, sizeof folder))
        return false;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        snprintf(path, sizeof path, "%s%s/glint.lua", folder, places[i]);
        if (access(path, R_OK) != 0)
            continue;
        path[strlen(path) - sizeof "/glint.lua" + 1] = '\0';
        char *real = realpath(path, NULL);
        snprintf(out, GLINTL_PATH_SIZE, "%s", real ? real : "");
        free(real);
        return *out != '\0';
    }
    return false;
}

// Writes the settings of the Lua language server, unless the file exists. Returns 0 or an errno.
static int write_settings(const char *path, const char *program)
{
    char types[GLINTL_PATH_SIZE];
    FILE *file = fopen(path, "wx");
    if (!file)
        return errno == EEXIST ? 0 : errno;
    fputs("{\n  \"runtime.version\": \"Lua 5.4\"", file);
    if (find_types(program, types)) {
        fputs(",\n  \"workspace.library\": [", file);
        glintL_json_string(file, types);
        fputs("]", file);
    }
    fputs("\n}\n", file);
    return finish(file, path);
}

static int write_all(const char *path, const char *settings, const char *program)
{
    int code = write_script(path);
    return code || !*settings ? code : write_settings(settings, program);
}

int cli_new(const cli_options *options, cli_output *output)
{
    char path[2 * GLINTL_PATH_SIZE], settings[GLINTL_PATH_SIZE + 16] = "";
    if (options->argument_count != 1)
        return refuse(output, GLINTL_EXIT_USAGE, "", "one name expected");
    const char *name = options->arguments[0];
    size_t length = strlen(name);
    if (length == 0 || name[length - 1] == '/' || length > GLINTL_PATH_SIZE - 8 || *glintL_base_name(name) == '.')
        return refuse(output, GLINTL_EXIT_USAGE, name, "expected the name of a folder or of a .lua script");
    snprintf(path, sizeof path, "%s", name);
    int code = 0;
    if (!ends_in_lua(name)) {
        snprintf(path, sizeof path, "%s/%s.lua", name, glintL_base_name(name));
        snprintf(settings, sizeof settings, "%s/.luarc.json", name);
        code = mkdir(name, 0777) == 0 || errno == EEXIST ? 0 : errno;
    }
    code = code ? code : write_all(path, settings, options->program);
    if (code == EEXIST)
        return refuse(output, GLINTL_EXIT_USAGE, path, "it exists already and was not changed");
    if (code == ENOENT)
        return refuse(output, GLINTL_EXIT_FAILED, path, "its folder does not exist; create it with mkdir");
    if (code)
        return refuse(output, code == ENOSPC || code == EDQUOT ? GLINTL_EXIT_LATER : GLINTL_EXIT_FAILED, path,
                      strerror(code));
    if (output->json) {
        glintL_json(output->data, "{\"event\":\"new\",\"file\":%s}\n", path);
    } else if (!output->quiet) {
        fprintf(stderr, "%s: a scene to start from; render it with:  glint %s\n", path, path);
    }
    return GLINTL_EXIT_DONE;
}
