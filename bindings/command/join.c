// glint join PARTS -o PICTURE: joins pictures rendered with --region into the whole frame, byte for byte.
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "bindings/command/cli.h"

typedef struct join {
    cli_file_list list;
    glint_picture **pictures; // owned
    glint_picture_part *parts;
    glintL_render render; // render options of the whole frame, from the first part's options
    char *options; // text of the options in the whole frame's file; owned
    char *message;
} join;

// ---- The texts of a part ----

static bool take_region(const char *options, double region[4])
{
    glintL_render scratch = glintL_render_default();
    char text[64], message[GLINTL_MESSAGE_SIZE];
    size_t length = 0;
    const char *line = glintL_find_line(options, "region", 6, &length);
    if (!line || length - 7 >= sizeof text)
        return false;
    snprintf(text, sizeof text, "%.*s", (int)(length - 7), line + 7);
    if (!glintL_render_set_text(&scratch, glintL_render_find("region"), text, message))
        return false;
    memcpy(region, scratch.desc.region, sizeof scratch.desc.region);
    return true;
}

// Reads the options of the whole frame: the options of a part without its region.
static bool take_options(join *j, const char *options)
{
    size_t used = 0;
    j->render = glintL_render_default();
    j->options = malloc(strlen(options) + 1);
    if (!j->options)
        return false;
    for (const char *line = options; *line;) {
        char name[64], value[128], message[GLINTL_MESSAGE_SIZE];
        const size_t size = strcspn(line, "\n"), before = strcspn(line, "=\n");
        snprintf(name, sizeof name, "%.*s", (int)before, line);
        snprintf(value, sizeof value, "%.*s", before < size ? (int)(size - before - 1) : 0, line + before + 1);
        if (strcmp(name, "region") != 0) {
            used += (size_t)sprintf(j->options + used, "%s%.*s", used ? "\n" : "", (int)size, line);
            const int field = glintL_render_find(name);
            if (field >= 0)
                glintL_render_set_text(&j->render, field, value, message);
        }
        line += size + (line[size] == '\n');
    }
    j->options[used] = '\0';
    return true;
}

static bool complain(join *j, const char *path, const char *what)
{
    snprintf(j->message, GLINTL_MESSAGE_SIZE, "%.400s: %s", path, what);
    return false;
}

// Reads part number i and its position.
static bool read_part(join *j, size_t i)
{
    glint_error error;
    double region[4];
    const char *path = j->list.files[i];
    if (glint_picture_read(path, true, &j->pictures[i], &error)) {
        snprintf(j->message, GLINTL_MESSAGE_SIZE, "%s", error.message);
        return false;
    }
    const glint_picture *picture = j->pictures[i];
    const char *options = glint_picture_text(picture, "glint:options"),
               *whole = glint_picture_text(picture, "glint:whole");
    if (!whole || !options || !take_region(options, region))
        return complain(j, path, "expected a .png rendered with --region");
    if (strcmp(whole, glint_picture_text(j->pictures[0], "glint:whole")) != 0) {
        snprintf(j->message, GLINTL_MESSAGE_SIZE,
                 "%.300s and %.300s are parts of different frames: scene, frame, options, version or encoder differ",
                 path, j->list.files[0]);
        return false;
    }
    if (glint_picture_width(picture) != (int)region[2] || glint_picture_height(picture) != (int)region[3])
        return complain(j, path, "its size differs from the region that is recorded in it");
    j->parts[i] = (glint_picture_part) { picture, (int)region[0], (int)region[1] };
    return true;
}

// ---- The whole ----

// Lists the text entries of the whole frame's file, in the order of the file.
static size_t list_texts(const join *j, glint_text texts[GLINTL_TEXT_COUNT])
{
    static const char *const keywords[] = { "Software",     "glint:key",    "glint:script", "glint:source",
                                            "glint:params", "glint:frame",  "glint:pass",   "glint:options",
                                            "glint:sweep",  "glint:encoder" };
    size_t count = 0;
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++) {
        const bool is_key = strcmp(keywords[i], "glint:key") == 0, is_list = strcmp(keywords[i], "glint:options") == 0;
        const char *value = glint_picture_text(j->pictures[0], is_key ? "glint:whole" : keywords[i]);
        if (value)
            texts[count++] = (glint_text) { keywords[i], is_list ? j->options : value };
    }
    return count;
}

static bool is_color(const char *pass)
{
    static const char *const others[] = { "depth", "normal", "object_id", "alpha", "outline", "refined" };
    for (size_t i = 0; pass && i < sizeof others / sizeof *others; i++)
        if (strcmp(pass, others[i]) == 0)
            return false;
    return true;
}

static int write_whole(join *j, const char *path)
{
    glint_text texts[GLINTL_TEXT_COUNT];
    glint_error error;
    glint_write_desc desc = {
        .path = path, .encode = j->render.encode, .dpi = j->render.dpi, .tone = j->render.desc.tone, .text = texts
    };
    desc.text_count = list_texts(j, texts);
    if (!is_color(glint_picture_text(j->pictures[0], "glint:pass")))
        desc.tone.transfer = GLINT_TRANSFER_LINEAR;
    const glint_status status = glint_picture_join(j->parts, j->list.count, (int)j->render.desc.width,
                                                   (int)j->render.desc.height, &desc, &error);
    size_t number = 0;
    if (!status)
        return GLINTL_EXIT_DONE;
    if (sscanf(error.message, "parts[%zu]", &number) == 1 && number >= 1 && number <= j->list.count)
        complain(j, j->list.files[number - 1], strchr(error.message, ':') + 2);
    else
        snprintf(j->message, GLINTL_MESSAGE_SIZE, "%s", error.message);
    return glintL_run_exit_code(status);
}

static int make(join *j, const cli_options *options)
{
    const char *dot = options->output ? strrchr(options->output, '.') : NULL;
    if (!dot || strcasecmp(dot, ".png") != 0) {
        snprintf(j->message, GLINTL_MESSAGE_SIZE, "-o NAME.png expected");
        return GLINTL_EXIT_USAGE;
    }
    if (!cli_list_files(options, &options->request.selection, &j->list, j->message))
        return GLINTL_EXIT_USAGE;
    j->pictures = calloc(j->list.count, sizeof *j->pictures);
    j->parts = calloc(j->list.count, sizeof *j->parts);
    if (!j->pictures || !j->parts) {
        snprintf(j->message, GLINTL_MESSAGE_SIZE, "out of memory");
        return GLINTL_EXIT_FAILED;
    }
    for (size_t i = 0; i < j->list.count; i++)
        if (!read_part(j, i))
            return GLINTL_EXIT_USAGE;
    if (!take_options(j, glint_picture_text(j->pictures[0], "glint:options"))) {
        snprintf(j->message, GLINTL_MESSAGE_SIZE, "out of memory");
        return GLINTL_EXIT_FAILED;
    }
    return write_whole(j, options->output);
}

static void report(cli_output *output, const char *path, size_t count)
{
    if (output->json) {
        glintL_json(output->data, "{\"event\":\"joined\",\"file\":%s", path);
        fprintf(output->data, ",\"parts\":%zu}", count);
        cli_end_line(output);
    } else if (!output->quiet) {
        fprintf(stderr, "%s: joined from %zu part%s\n", path, count, count == 1 ? "" : "s");
    }
}

int cli_join(const cli_options *options, cli_output *output)
{
    char message[GLINTL_MESSAGE_SIZE] = "", full[GLINTL_MESSAGE_SIZE + 32];
    join j = { .message = message };
    const int code = make(&j, options);
    if (code) {
        snprintf(full, sizeof full, "join: %s", message);
        cli_report_error(output, 0, code, full);
    } else {
        report(output, options->output, j.list.count);
    }
    for (size_t i = 0; j.pictures && i < j.list.count; i++)
        glint_picture_destroy(j.pictures[i]);
    free(j.pictures);
    free(j.parts);
    free(j.options);
    cli_free_list(&j.list);
    return code;
}
