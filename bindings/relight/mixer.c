// The mixer: a page in one file with a picture's light passes, and a slider and a colour for each.
#include <stdlib.h>
#include <string.h>

#include "bindings/relight/relight.h"
#include "bindings/run/carried.h"

static const char PAGE[] = {
#include "bindings/relight/mixer.html.h"
};

static const char *const CURVES[] = { "clamp", "reinhard", "filmic" };

// ---- The values of the page ----

// Prints the least light for each pixel value 1 .. 255, as the bits of a float, for each tone curve.
static void print_steps(FILE *out)
{
    for (unsigned curve = 0; curve < sizeof CURVES / sizeof *CURVES; curve++) {
        glint_tone_desc tone = glint_tone_desc_default();
        float least[255];
        tone.curve = (glint_tone_curve)curve;
        glint_tone_steps(&tone, least);
        fprintf(out, "%s%s: [", curve ? ", " : "", CURVES[curve]);
        for (int i = 0; i < 255; i++) {
            uint32_t bits;
            memcpy(&bits, &least[i], sizeof bits);
            fprintf(out, "%s%u", i ? "," : "", bits);
        }
        fputc(']', out);
    }
}

// Prints the light for each sRGB value 0 .. 255.
static void print_decoded(FILE *out)
{
    for (int i = 0; i < 256; i++)
        fprintf(out, "%s%.17g", i ? "," : "", glint_srgb_decode(i / 255.0));
}

static void print_lights(FILE *out, const relight_mix *mix, const glint_image *image)
{
    const char *name;
    for (size_t i = 0; (name = glint_image_light_pass(image, i)); i++) {
        const relight_light light = relight_light_at(mix, image, i);
        fputs(i ? ", { name: " : "{ name: ", out);
        glintL_json_string(out, name);
        fprintf(out, ", strength: %.17g, color: '#%06x' }", light.strength, (unsigned)light.color);
    }
}

static void print_title(FILE *out, const char *text)
{
    for (; *text; text++)
        if (*text == '<' || *text == '&')
            fputs(*text == '<' ? "&lt;" : "&amp;", out);
        else
            fputc(*text, out);
}

// Prints the replacement of @NAME@ in the page, except for the pixels.
static void print_value(FILE *out, const char *name, const cli_options *options, const relight_mix *mix,
                        const char *file, const glint_image *image)
{
    const char *title = options->title ? options->title : glintL_base_name(file);
    if (strncmp(name, "VERSION", 7) == 0)
        fputs(GLINT_VERSION, out);
    else if (strncmp(name, "TITLE", 5) == 0)
        print_title(out, title);
    else if (strncmp(name, "FILE", 4) == 0)
        glintL_json_string(out, file);
    else if (strncmp(name, "LIGHTS", 6) == 0)
        print_lights(out, mix, image);
    else if (strncmp(name, "STEPS", 5) == 0)
        print_steps(out);
    else if (strncmp(name, "DECODED", 7) == 0)
        print_decoded(out);
    else if (strncmp(name, "EXPOSURE", 8) == 0)
        fprintf(out, "%.17g", mix->tone.exposure);
    else if (strncmp(name, "TONE", 4) == 0)
        fputs(CURVES[mix->tone.curve], out);
}

// ---- The file ----

static glint_status append(glint_draft *draft, const void *bytes, size_t size, glint_error *error)
{
    return size ? glint_draft_append(draft, bytes, size, error) : GLINT_OK;
}

static glint_status no_memory(glint_error *error)
{
    error->status = GLINT_ERR_NOMEM;
    snprintf(error->message, sizeof error->message, "out of memory");
    return GLINT_ERR_NOMEM;
}

// Writes the light passes as an .exr of floats, in base64, piece by piece.
static glint_status append_pixels(glint_draft *draft, const glint_image *image, glint_error *error)
{
    enum { PIECE = 3 << 18 };
    uint8_t *data = NULL;
    size_t size = 0;
    const glint_write_desc desc = { .path = "lights.exr", .pass = GLINT_PASS_LIGHT, .tone = glint_tone_desc_default() };
    char *text = malloc(PIECE / 3 * 4 + 4);
    glint_status status = text ? glint_image_to_bytes(image, &desc, &data, &size, error) : no_memory(error);
    for (size_t at = 0; at < size && !status; at += PIECE) {
        const size_t piece = size - at < PIECE ? size - at : PIECE;
        status = append(draft, text, glintL_base64(data + at, piece, text), error);
    }
    free(data);
    free(text);
    return status;
}

static glint_status append_page(glint_draft *draft, const cli_options *options, const relight_mix *mix,
                                const char *file, const glint_image *image, glint_error *error)
{
    const char *at = PAGE, *end = PAGE + sizeof PAGE;
    glint_status status = GLINT_OK;
    while (!status && at < end) {
        const char *mark = memchr(at, '@', (size_t)(end - at));
        const char *after = mark ? memchr(mark + 1, '@', (size_t)(end - mark - 1)) : NULL;
        status = append(draft, at, (size_t)((mark ? mark : end) - at), error);
        if (!mark || status)
            break;
        if (strncmp(mark + 1, "PIXELS", 6) == 0) {
            status = append_pixels(draft, image, error);
        } else {
            char *text = NULL;
            size_t size = 0;
            FILE *out = open_memstream(&text, &size);
            if (out)
                print_value(out, mark + 1, options, mix, file, image);
            if (!out || !glintL_close_text(out, &text))
                return no_memory(error);
            status = append(draft, text, size, error);
            free(text);
        }
        at = after + 1;
    }
    return status ? status : glint_draft_finish(draft, error);
}

int relight_write_page(const cli_options *options, const relight_mix *mix, const char *file, const glint_image *image,
                       char message[GLINTL_MESSAGE_SIZE])
{
    glint_draft *draft = NULL;
    glint_error error;
    const glint_tone_desc plain = glint_tone_desc_default();
    if (mix->tone.bits != plain.bits || mix->tone.transfer != plain.transfer || mix->tone.rounding != plain.rounding) {
        snprintf(message, GLINTL_MESSAGE_SIZE,
                 "-o %.200s: the page always shows 8-bit sRGB, rounded to the nearest value; expected no --bits, "
                 "--transfer or --rounding",
                 options->output);
        return GLINTL_EXIT_USAGE;
    }
    glint_status status = glint_draft_create(options->output, &draft, &error);
    if (!status)
        status = append_page(draft, options, mix, file, image, &error);
    glint_draft_destroy(draft);
    if (status)
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
    return glintL_run_exit_code(status);
}
