// glint relight FILE.exr: a picture with other strengths and colours of its lights, made from its light passes.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/relight/relight.h"
#include "bindings/run/film.h"

typedef struct job {
    const cli_options *options;
    glintL_run *run;
    relight_mix mix;
    glintL_render render; // tone and encoding
    cli_file_list files;
    glintL_naming naming;
} job;

static int fail(char *message, int code, const char *path, const char *text)
{
    snprintf(message, GLINTL_MESSAGE_SIZE, "%.300s%s%.600s", path, *path ? ": " : "", text);
    return code;
}

// ---- --light ----

// Reads a strength or a colour. False: it is neither, or the light has one already.
static bool take_value(relight_light *light, const char *value, char *message)
{
    char *end;
    const double strength = strtod(value, &end);
    if (end > value && *end == '\0') {
        snprintf(message, GLINTL_MESSAGE_SIZE, "--light %.*s: expected a finite strength >= 0, given only once, got "
                                               "'%.80s'",
                 (int)light->length, light->name, value);
        const bool good = !light->has_strength && strength >= 0 && strength < HUGE_VAL;
        light->has_strength = true;
        light->strength = strength;
        return good;
    }
    snprintf(
        message, GLINTL_MESSAGE_SIZE,
        "--light %.*s: expected a strength such as 2 or a colour such as #ffd9a0 or orange, each given only once, "
        "got '%.80s'",
        (int)light->length, light->name, value);
    const bool good = !light->has_color && glintL_find_color(value, strlen(value), &light->color);
    light->has_color = true;
    return good;
}

static relight_light *find(const relight_mix *mix, const char *name, size_t length)
{
    for (size_t i = 0; i < mix->count; i++)
        if (mix->lights[i].length == length && memcmp(mix->lights[i].name, name, length) == 0)
            return &mix->lights[i];
    return NULL;
}

static bool read_lights(relight_mix *mix, const cli_options *options, char *message)
{
    mix->lights = calloc(options->light_count + 1, sizeof *mix->lights);
    if (!mix->lights)
        return !fail(message, 1, "", "out of memory");
    for (size_t i = 0; i < options->light_count; i++) {
        const char *text = options->lights[i], *equals = strrchr(text, '=');
        relight_light *light = find(mix, text, (size_t)(equals - text));
        if (!light) {
            light = &mix->lights[mix->count++];
            *light =
                (relight_light) { .name = text, .length = (size_t)(equals - text), .strength = 1, .color = 0xffffff };
        }
        if (!take_value(light, equals + 1, message))
            return false;
    }
    return true;
}

relight_light relight_light_at(const relight_mix *mix, const glint_image *image, size_t index)
{
    const char *name = glint_image_light_pass(image, index);
    const relight_light *light = find(mix, name, strlen(name));
    return light ? *light : (relight_light) { .strength = 1, .color = 0xffffff };
}

// Checks that a file has all lights that --light names.
static bool check_lights(const relight_mix *mix, const glint_image *image, const char *path, char *message)
{
    for (size_t i = 0; i < mix->count; i++) {
        char wanted[GLINT_NAME_SIZE + 16], all[400] = "";
        const char *near = NULL, *name;
        bool found = false;
        snprintf(wanted, sizeof wanted, "%.*s", (int)mix->lights[i].length, mix->lights[i].name);
        for (size_t k = 0; (name = glint_image_light_pass(image, k)); k++) {
            const size_t used = strlen(all);
            found = found || strcmp(name, wanted) == 0;
            near = glintL_nearer(wanted, near, name);
            if (used < 300 && strcmp(name, GLINT_LIGHT_OTHER) != 0)
                snprintf(all + used, sizeof all - used, "%s'%s'", used ? ", " : "", name);
        }
        if (found)
            continue;
        if (near && strcmp(near, GLINT_LIGHT_OTHER) != 0)
            snprintf(message, GLINTL_MESSAGE_SIZE,
                     "--light %s: %.200s has no light pass of that name; did you mean '%s'?", wanted, path, near);
        else
            snprintf(message, GLINTL_MESSAGE_SIZE, "--light %s: %.200s has no light pass of that name; it has %s",
                     wanted, path, all);
        return false;
    }
    return true;
}

// ---- Files ----

// Reads a file's lights. NULL: `*code` and the message give the reason.
static glint_image *read_file(const job *j, const char *path, int *code, char *message)
{
    glint_image *image = NULL;
    glint_error error;
    const glint_status status = glint_lights_read(path, &image, &error);
    if (status) {
        *code = status == GLINT_ERR_NOMEM ? GLINTL_EXIT_FAILED : GLINTL_EXIT_USAGE;
        fail(message, *code, "", error.message);
        return NULL;
    }
    if (check_lights(&j->mix, image, path, message))
        return image;
    *code = GLINTL_EXIT_USAGE;
    glint_image_release(image);
    return NULL;
}

static glint_status mix_image(const job *j, const glint_image *lights, glint_image **out, glint_error *error)
{
    size_t count = 0;
    while (glint_image_light_pass(lights, count))
        count++;
    double(*factors)[3] = malloc((count + 1) * sizeof *factors);
    if (!factors) {
        error->status = GLINT_ERR_NOMEM;
        snprintf(error->message, sizeof error->message, "out of memory");
        return GLINT_ERR_NOMEM;
    }
    for (size_t i = 0; i < count; i++) {
        const relight_light light = relight_light_at(&j->mix, lights, i);
        for (int c = 0; c < 3; c++)
            factors[i][c] = light.strength * glint_srgb_decode((light.color >> (16 - 8 * c) & 255) / 255.0);
    }
    const glint_status status = glint_image_relight(lights, (const double(*)[3])factors, out, error);
    free(factors);
    return status;
}

static int write_picture(job *j, const char *file, int64_t number, char *message)
{
    char path[GLINTL_PATH_SIZE];
    glint_image *image = NULL;
    glint_error error;
    int code = 0;
    const glint_text text = { "Software", "glint " GLINT_VERSION };
    glint_write_desc desc = { .path = path, .pass = GLINT_PASS_BEAUTY, .tone = j->render.desc.tone };
    desc.encode = j->render.encode;
    desc.dpi = j->render.dpi;
    desc.text = &text;
    desc.text_count = 1;
    glint_image *lights = read_file(j, file, &code, message);
    if (!lights)
        return code;
    if (!glintL_name_file(&j->naming, number, "beauty", path)) {
        glint_image_release(lights);
        return fail(message, GLINTL_EXIT_USAGE, "-o", "the file name is too long");
    }
    glint_status status = mix_image(j, lights, &image, &error);
    glint_image_release(lights);
    if (!status)
        status = glint_image_write(image, &desc, &error);
    glint_image_release(image);
    if (status)
        return fail(message, glintL_run_exit_code(status), "", error.message);
    if (j->naming.film && !glintL_film_add(j->naming.film, number, path))
        return fail(message, GLINTL_EXIT_FAILED, "", "out of memory");
    if (!j->naming.film && j->run->reporter.figure)
        j->run->reporter.figure(j->run->reporter.context, "picture", path, 1);
    return 0;
}

// Returns whether the pictures get the numbers of their files, which must ascend. Otherwise they are counted from 1.
static bool has_numbers(const cli_file_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        if (list->numbers[i] < 0 || (i > 0 && list->numbers[i] <= list->numbers[i - 1]))
            return false;
    return true;
}

static int write_all(job *j, char *message)
{
    const bool numbered = has_numbers(&j->files);
    int code = 0;
    for (size_t i = 0; i < j->files.count && !code && !j->run->interrupted; i++)
        code = write_picture(j, j->files.files[i], numbered ? j->files.numbers[i] : (int64_t)i + 1, message);
    if (code || j->run->interrupted || !j->naming.film)
        return code;
    if (glintL_films_finish(j->run))
        return 0;
    fail(message, 0, "", j->run->message);
    return j->run->exit_code;
}

// Checks the lights of one file before anything is written.
static int check_files(const job *j, char *message)
{
    int code = 0;
    glint_image *image = read_file(j, j->files.files[0], &code, message);
    glint_image_release(image);
    return code;
}

static int write_page(const job *j, char *message)
{
    int code = 0;
    if (j->files.count != 1)
        return fail(message, GLINTL_EXIT_USAGE, "", "a page shows one file; expected only one");
    glint_image *image = read_file(j, j->files.files[0], &code, message);
    if (image)
        code = relight_write_page(j->options, &j->mix, j->files.files[0], image, message);
    glint_image_release(image);
    return code;
}

// ---- The command ----

static bool is_page(const char *path)
{
    const size_t length = strlen(path);
    return length > 5 && strcmp(path + length - 5, ".html") == 0;
}

// Reads the name in -o. False: the message says what is wrong.
static bool open_output(job *j, char *message)
{
    const char *path = j->options->output;
    glintL_render_set_text(&j->render, glintL_render_find("output"), "none", message);
    if (!path || strcmp(path, "none") == 0)
        return !fail(message, 1, "", "expected -o with a picture, a film or a page NAME.html");
    if (is_page(path))
        return true;
    if (glintL_film_kind_of(path, j->run->request.apng) == GLINTL_FILM_NONE && !glintL_name_check(path, message))
        return false;
    j->naming = (glintL_naming) { .pattern = path, .is_numbered = j->files.count > 1 };
    if (!glintL_film_open(j->run, path, &j->render, 24, message))
        return false;
    glintL_film_take(j->run, &j->naming);
    return true;
}

static int relight(job *j, char *message)
{
    if (!read_lights(&j->mix, j->options, message))
        return GLINTL_EXIT_USAGE;
    if (!cli_list_files(j->options, &j->run->request.selection, &j->files, message) || !open_output(j, message))
        return GLINTL_EXIT_USAGE;
    if (is_page(j->options->output))
        return write_page(j, message);
    const int code = check_files(j, message);
    return code ? code : write_all(j, message);
}

int cli_relight(cli_options *options, cli_output *output, glintL_run *run)
{
    char message[GLINTL_MESSAGE_SIZE] = "", full[GLINTL_MESSAGE_SIZE + 32];
    job j = { .options = options, .run = run, .render = glintL_render_default() };
    glintL_run_apply(run, &j.render);
    j.mix.tone = j.render.desc.tone;
    if (!output->quiet)
        output->progress = cli_progress_create(output->color);
    const int code = relight(&j, message);
    cli_progress_destroy(output->progress);
    output->progress = NULL;
    if (code && !run->interrupted) {
        snprintf(full, sizeof full, "relight: %s", message);
        cli_report_error(output, 0, code, full);
    } else if (run->interrupted) {
        cli_report_error(output, 0, 128 + (int)run->interrupted, "interrupted");
    }
    cli_free_list(&j.files);
    free(j.mix.lights);
    return code;
}
