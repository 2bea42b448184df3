// A sheet as one HTML page: a slider for each axis, the pictures inside as data URIs. It needs nothing from elsewhere.
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/sheet.h"

static const char HEAD[] =
    "<style>\n"
    "body { margin: 2em auto; max-width: 70em; padding: 0 1em; font: 16px/1.4 system-ui, sans-serif; color: #222; "
    "background: #fff }\n"
    "h1 { font-size: 1.3em; font-weight: 600 }\n"
    ".stage { position: relative; display: inline-block; line-height: 0; background: #000 }\n"
    ".stage img { max-width: 100%; height: auto }\n"
    "#chosen { position: absolute; left: 0; top: 0; mix-blend-mode: difference; display: none }\n"
    ".difference #chosen { display: block }\n"
    "form { display: grid; grid-template-columns: max-content 1fr max-content; gap: .4em 1em; max-width: 40em; "
    "margin-top: 1em; align-items: center }\n"
    "form output { min-width: 6em; font-variant-numeric: tabular-nums }\n"
    "form .wide { grid-column: 1 / -1 }\n"
    "#label { color: #6a6a6a; white-space: pre-wrap; min-height: 1.4em }\n"
    "</style>\n";

static const char BODY[] =
    "<div class=\"stage\" id=\"stage\"><img id=\"picture\" alt=\"\"><img id=\"chosen\" alt=\"\"></div>\n"
    "<p id=\"label\"></p>\n"
    "<form id=\"sliders\"></form>\n"
    "<noscript>The sliders of this page need JavaScript.</noscript>\n";

static const char CODE[] =
    "const $ = id => document.getElementById(id);\n"
    "const inputs = sheet.axes.map((axis, i) => {\n"
    "  const name = document.createElement('label'), input = document.createElement('input');\n"
    "  const output = document.createElement('output');\n"
    "  name.textContent = axis.name; name.htmlFor = input.id = 'axis' + i;\n"
    "  Object.assign(input, { type: 'range', min: 0, max: axis.values.length - 1, step: 1, value: 0 });\n"
    "  input.addEventListener('input', show);\n"
    "  $('sliders').append(name, input, output);\n"
    "  return { input, output, axis };\n"
    "});\n"
    "let box;\n"
    "if (sheet.difference) {\n"
    "  const name = document.createElement('label');\n"
    "  box = document.createElement('input'); box.type = 'checkbox'; box.id = 'difference';\n"
    "  box.addEventListener('input', show);\n"
    "  name.className = 'wide';\n"
    "  name.append(box, ' difference from picture ' + sheet.difference + ', times ' + sheet.gain);\n"
    "  $('sliders').append(name);\n"
    "  $('chosen').src = sheet.pictures[sheet.difference - 1];\n"
    "}\n"
    "function show() {\n"
    "  let at = 0, stride = 1;\n"
    "  for (const { input, output, axis } of inputs) {\n"
    "    at += stride * input.value; stride *= axis.values.length;\n"
    "    output.textContent = axis.values[input.value];\n"
    "  }\n"
    "  $('picture').src = sheet.pictures[at];\n"
    "  $('label').textContent = sheet.labels[at];\n"
    "  $('stage').className = 'stage' + (box && box.checked ? ' difference' : '');\n"
    "  $('stage').style.filter = box && box.checked ? 'brightness(' + sheet.gain + ')' : '';\n"
    "}\n"
    "show();\n";

// ---- Text ----

// A string of JavaScript that cannot end the script it stands in; newlines become two spaces.
static void put_string(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            fprintf(out, "\\%c", *text);
        else if (*text == '<')
            fputs("\\u003c", out);
        else if (*text == '\n')
            fputs("  ", out);
        else
            fputc((unsigned char)*text < ' ' ? ' ' : *text, out);
    }
    fputc('"', out);
}

static void put_html(FILE *out, const char *text)
{
    for (; *text; text++) {
        if (*text == '<' || *text == '&')
            fputs(*text == '<' ? "&lt;" : "&amp;", out);
        else
            fputc(*text, out);
    }
}

static void put_axis(FILE *out, const char *name, char *const *values, size_t count)
{
    char spelt[64];
    fputs("  { name: ", out);
    put_string(out, name);
    fputs(", values: [", out);
    for (size_t i = 0; i < count; i++) {
        glintL_axis_spell(values[i], spelt);
        fputs(i ? ", " : "", out);
        put_string(out, spelt);
    }
    fputs("] },\n", out);
}

// Without a grid one slider runs through the pictures.
static void put_axes(FILE *out, const glintL_sheet *sheet, const glintL_axes *axes)
{
    fputs("axes: [\n", out);
    for (size_t a = 0; a < axes->count && axes->is_grid; a++)
        put_axis(out, axes->axis[a].name, axes->axis[a].values, axes->axis[a].count);
    if (!axes->is_grid) {
        fprintf(out, "  { name: \"picture\", values: Array.from({ length: %zu }, (_, i) => String(i + 1)) },\n",
                sheet->count);
    }
    fputs("],\n", out);
}

static void put_page(FILE *out, const glintL_sheet *sheet, const glintL_axes *axes, char *const *labels)
{
    const char *title = sheet->title ? sheet->title : "Contact sheet";
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta name=\"generator\" content=\"glint " GLINT_VERSION "\">\n<title>",
          out);
    put_html(out, title);
    fputs("</title>\n", out);
    fputs(HEAD, out);
    if (sheet->title) {
        fputs("<h1>", out);
        put_html(out, title);
        fputs("</h1>\n", out);
    }
    fputs(BODY, out);
    fprintf(out, "<script>\nconst sheet = {\ndifference: %lld, gain: %g,\n", (long long)sheet->difference,
            sheet->gain > 0 ? sheet->gain : 8.0);
    put_axes(out, sheet, axes);
    fputs("labels: [\n", out);
    for (size_t i = 0; i < sheet->count; i++) {
        put_string(out, labels[i]);
        fputs(",\n", out);
    }
    fputs("],\npictures: [\n", out);
}

// ---- Pictures ----

#define PIECE 24576 // bytes; three by three, so that only the last is padded

static size_t to_base64(const uint8_t *from, size_t size, char *out)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t used = 0;
    for (size_t i = 0; i < size; i += 3) {
        size_t rest = size - i;
        unsigned bits =
            (unsigned)from[i] << 16 | (rest > 1 ? (unsigned)from[i + 1] << 8 : 0) | (rest > 2 ? from[i + 2] : 0);
        for (size_t k = 0; k < 4; k++)
            out[used++] = (char)(k <= rest ? digits[bits >> (18 - 6 * k) & 63] : '=');
    }
    return used;
}

static glint_status append_text(glint_draft *draft, const char *text, glint_error *error)
{
    return glint_draft_append(draft, text, strlen(text), error);
}

// False: the file cannot be read; errno says why.
static bool append_file(glint_draft *draft, const char *path, glint_status *status, glint_error *error)
{
    uint8_t bytes[PIECE];
    char text[PIECE / 3 * 4];
    FILE *file = fopen(path, "rb");
    size_t size = 0;
    while (file && !*status && (size = fread(bytes, 1, PIECE, file)) > 0)
        *status = glint_draft_append(draft, text, to_base64(bytes, size, text), error);
    bool good = file && !ferror(file);
    if (file)
        fclose(file);
    return good;
}

static int fail(char *message, const char *path, const char *why)
{
    snprintf(message, GLINTL_MESSAGE_SIZE, "%.300s: %s", path, why);
    return GLINTL_EXIT_FAILED;
}

static int append_pictures(glint_draft *draft, const glintL_sheet *sheet, char *message)
{
    glint_error error;
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < sheet->count && !status; i++) {
        status = append_text(draft, "\"data:image/png;base64,", &error);
        if (!status && !append_file(draft, sheet->files[i], &status, &error))
            return fail(message, sheet->files[i], strerror(errno));
        if (!status)
            status = append_text(draft, "\",\n", &error);
    }
    if (!status)
        status = append_text(draft, "] };\n", &error);
    if (!status)
        status = append_text(draft, CODE, &error);
    if (!status)
        status = append_text(draft, "</script>\n</html>\n", &error);
    if (!status)
        status = glint_draft_finish(draft, &error);
    if (status)
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
    return glintL_run_exit_code(status);
}

int glintL_sheet_page(const glintL_sheet *sheet, const glintL_axes *axes, char *const *labels,
                      char message[GLINTL_MESSAGE_SIZE])
{
    glint_draft *draft = NULL;
    glint_error error;
    char *text = NULL;
    size_t size = 0;
    for (size_t i = 0; i < sheet->count; i++)
        if (glint_picture_bits(axes->pictures[i]) > 16) {
            fail(message, sheet->files[i], "a .png expected on a page");
            return GLINTL_EXIT_USAGE;
        }
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return fail(message, sheet->path, "out of memory");
    put_page(out, sheet, axes, labels);
    bool good = fclose(out) == 0;
    glint_status status = good ? glint_draft_create(sheet->path, &draft, &error) : GLINT_ERR_NOMEM;
    if (!status)
        status = glint_draft_append(draft, text, size, &error);
    free(text);
    int code = glintL_run_exit_code(status);
    if (status)
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", good ? error.message : "out of memory");
    else
        code = append_pictures(draft, sheet, message);
    glint_draft_destroy(draft);
    return code;
}
