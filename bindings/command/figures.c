// glint sheet FILES -o SHEET and glint assemble FILES -o FILM: figures made from finished frames.
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"
#include "bindings/run/film.h"
#include "bindings/run/sheet.h"

static int refuse(cli_output *output, int code, const char *command, const char *message)
{
    char full[GLINTL_MESSAGE_SIZE + 32];
    snprintf(full, sizeof full, "%s: %s", command, message);
    return cli_report_error(output, 0, code, full);
}

static double dpi_of(const cli_options *options)
{
    const char *text = options->request.render_text[glintL_render_find("dpi")];
    return text ? strtod(text, NULL) : 0; // checked when the option was read
}

// Reads a number and the comma or end after it; NULL: there is no number.
static const char *read_end(const char *text, double *out)
{
    char *end;
    *out = strtod(text, &end);
    return end > text && (*end == ',' || *end == '\0') ? end : NULL;
}

// Finds the map with this name. False: there is none, and the message says so.
static bool find_map(const char *name, glint_colormap *out, char message[GLINTL_MESSAGE_SIZE])
{
    const char *near = NULL;
    for (int map = 0; map < GLINT_COLORMAP_COUNT; map++) {
        const char *known = glint_colormap_name((glint_colormap)map);
        *out = (glint_colormap)map;
        if (strcmp(known, name) == 0)
            return true;
        near = glintL_nearer(name, near, known);
    }
    return glintL_complain(message, "--colorbar: viridis, magma, cividis, turbo or coolwarm expected, got '%s'%s%s%s",
                           name, near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "");
}

// Reads MAP,LOW,HIGH or MAP,LOW,HIGH,TITLE. False: the text has neither form, and the message says so.
static bool read_colorbar(const char *text, glint_overlay_desc *bar, char message[GLINTL_MESSAGE_SIZE])
{
    char map[32];
    const size_t size = strcspn(text, ",");
    *bar = glint_overlay_desc_default(GLINT_OVERLAY_COLORBAR);
    snprintf(message, GLINTL_MESSAGE_SIZE, "--colorbar: MAP,LOW,HIGH or MAP,LOW,HIGH,TITLE expected, got '%.80s'", text);
    const char *low = text[size] ? read_end(text + size + 1, &bar->low) : NULL;
    const char *high = low && *low ? read_end(low + 1, &bar->high) : NULL;
    if (!high || size >= sizeof map)
        return false;
    snprintf(map, sizeof map, "%.*s", (int)size, text);
    if (!find_map(map, &bar->map, message))
        return false;
    if (strlen(high) > GLINT_OVERLAY_TEXT_SIZE)
        return glintL_complain(message, "--colorbar: expected a title of at most %d bytes",
                               GLINT_OVERLAY_TEXT_SIZE - 1);
    snprintf(bar->text, sizeof bar->text, "%s", *high ? high + 1 : "");
    return true;
}

// Turns "AXIS=TEXT,..." into lines, owned by the caller. A text without an axis is for all axes. NULL: out of memory.
static char *make_lines(const char *text, bool has_axis)
{
    char *lines = malloc(strlen(text) + 2);
    if (lines)
        sprintf(lines, "%s%s", has_axis ? "" : "=", text);
    for (char *at = lines; at && has_axis && *at; at++)
        if (*at == ',')
            *at = '\n';
    return lines;
}

static glintL_sheet describe_sheet(const cli_options *options, const glint_overlay_desc *bar, const char *names,
                                   const char *formats)
{
    return (glintL_sheet) {
        .path = options->output, .label = options->label, .names = names, .formats = formats, .title = options->title,
        .columns = options->columns, .difference = options->difference, .gain = options->gain, .size = options->label_size,
        .transparent = options->transparent, .colorbar = options->colorbar ? bar : NULL, .dpi = dpi_of(options),
        .mixes = options->request.force,
    };
}

// Makes the sheet of these files. Returns the exit code; the message says what is wrong.
static int make_sheet(const cli_options *options, const cli_file_list *list, const glint_overlay_desc *bar,
                      char message[GLINTL_MESSAGE_SIZE])
{
    const char *format = options->format;
    char *names = options->names ? make_lines(options->names, true) : NULL;
    char *formats = format ? make_lines(format, strcspn(format, "=") < strcspn(format, "%")) : NULL;
    glintL_sheet sheet = describe_sheet(options, bar, names, formats);
    int code = GLINTL_EXIT_FAILED;
    char *live = options->is_live ? cli_live(options, &options->request, &code, message) : NULL;
    sheet.files = list->files;
    sheet.count = list->count;
    sheet.live = live;
    if ((options->names && !names) || (format && !formats))
        snprintf(message, GLINTL_MESSAGE_SIZE, "out of memory");
    else if (live || !options->is_live)
        code = glintL_sheet_make(&sheet, message);
    free(live);
    free(names);
    free(formats);
    return code;
}

int cli_sheet(const cli_options *options, cli_output *output)
{
    char message[GLINTL_MESSAGE_SIZE];
    cli_file_list list;
    glint_overlay_desc bar;
    int code = GLINTL_EXIT_USAGE;
    if (!options->output)
        return refuse(output, code, "sheet", "expected -o NAME.png, .svg, .pdf or .html");
    if (options->is_live && !options->live_script)
        return refuse(output, code, "sheet", "expected --live=SCRIPT with the script of the pictures");
    if (options->colorbar && !read_colorbar(options->colorbar, &bar, message))
        return refuse(output, code, "sheet", message);
    if (cli_list_files(options, &options->request.selection, &list, message))
        code = make_sheet(options, &list, &bar, message);
    if (code)
        refuse(output, code, "sheet", message);
    else
        cli_reporter(output).figure(output, "sheet", options->output, (int64_t)list.count);
    cli_free_list(&list);
    return code;
}

// Returns what is wrong with the film, before its frames are read; NULL: nothing.
static const char *check_film(const cli_options *options, const glintL_film *film)
{
    if (!options->output || film->kind == GLINTL_FILM_NONE)
        return "-o: expected the name of a film, ending in .mp4, .webm, .gif, .png or .apng";
    if (options->request.apng && film->kind != GLINTL_FILM_APNG)
        return "--apng: expected -o with a name ending in .png";
    if (film->kind == GLINTL_FILM_GIF && film->fps > 50)
        return "a GIF has at most 50 frames a second; --fps 50 or less expected";
    return NULL;
}

int cli_assemble(cli_options *options, cli_output *output, glintL_run *run)
{
    char message[GLINTL_MESSAGE_SIZE];
    cli_file_list list = { 0 };
    char *path = (char *)(uintptr_t)options->output; // read only
    glintL_film film = { .path = path, .fps = run->request.fps > 0 ? run->request.fps : 24 };
    int code = GLINTL_EXIT_USAGE;
    film.kind = path ? glintL_film_kind_of(path, true) : GLINTL_FILM_NONE;
    const char *wrong = check_film(options, &film);
    if (wrong)
        return refuse(output, code, "assemble", wrong);
    if (!output->quiet)
        output->progress = cli_progress_create(output->color);
    if (cli_list_files(options, &run->request.selection, &list, message)) {
        film.files = list.files;
        film.count = list.count;
        if (glintL_film_check_files(&film, !run->request.force, message))
            code = glintL_film_make(run, &film, message);
    }
    if (run->interrupted)
        cli_report_error(output, 0, 128 + (int)run->interrupted, "interrupted");
    else if (code)
        refuse(output, code, "assemble", message);
    else
        run->reporter.figure(run->reporter.context, "film", path, (int64_t)film.count);
    cli_progress_destroy(output->progress);
    output->progress = NULL;
    cli_free_list(&list);
    return code;
}
