/// Writes .svg. The text is in `text` elements, so that readers can select and search it; cairo's SVG has the outlines
/// of letters only. Therefore this file needs only the libraries that a PNG needs.
#include "engine/base/number.h"
#include "engine/files/vector/figure.h"

#include "engine/base/status.h"
#include "engine/figures/ink/stamps.h"
#include "engine/figures/text/font.h"
#include "engine/figures/text/line.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#define BITMAP_FAMILY "DejaVu Sans Mono, Menlo, Consolas, monospace" ///< fonts of the bitmap font's proportions

typedef struct svg {
    glint_bytes *out;
    const glint_ink *ink; ///< the marks
    glint_transfer transfer; ///< of the colours' codes
    glint_rect clip; ///< clip rectangle of the open group
    int clips; ///< number of clip paths so far
    bool lost; ///< out of memory
} svg;

// ---- Elements of the syntax ---------------------------------------------------------------------------------------

static void put_bytes(svg *s, const void *bytes, size_t size)
{
    s->lost = !glint_bytes_append(s->out, bytes, size) || s->lost;
}

static void put_string(svg *s, const char *string) { put_bytes(s, string, strlen(string)); }

__attribute__((format(printf, 2, 3))) static void put(svg *s, const char *format, ...)
{
    char text[512];
    va_list list;
    va_start(list, format);
    glint_print_list(text, sizeof text, format, list);
    va_end(list);
    put_string(s, text);
}

/// Puts a number rounded to thousandths, whatever the locale's decimal point is.
static void put_number(svg *s, double value)
{
    const int64_t n = llround(fmin(fmax(value, -1e12), 1e12) * 1000), size = n < 0 ? -n : n;
    char text[40];
    int length = snprintf(text, sizeof text, "%s%" PRId64 ".%03d", n < 0 ? "-" : "", size / 1000, (int)(size % 1000));
    while (text[length - 1] == '0')
        length--;
    put_bytes(s, text, (size_t)(text[length - 1] == '.' ? length - 1 : length));
}

static void put_attribute(svg *s, const char *name, double value)
{
    put(s, " %s=\"", name);
    put_number(s, value);
    put_string(s, "\"");
}

static void put_point(svg *s, char command, double x, double y)
{
    put_bytes(s, &command, 1);
    put_number(s, x);
    put_string(s, " ");
    put_number(s, y);
}

/// Puts ` name="#rrggbb"`: the code of the colour in the picture.
static void put_color(svg *s, const char *name, const double color[3])
{
    unsigned code = 0;
    for (int c = 0; c < 3; c++)
        code = code << 8 | glint_ink_code(color[c], s->transfer, 8);
    put(s, " %s=\"#%06x\"", name, code);
}

/// Puts text, at most `size` bytes, with the characters that XML reserves escaped. Characters that XML forbids become
/// U+FFFD.
static void put_escaped(svg *s, const char *text, size_t size)
{
    const char *end = text + strnlen(text, size);
    char utf8[4];
    while (text < end) {
        const uint32_t code = glint_font_code(&text);
        if (code == '&' || code == '<' || code == '>' || code == '"')
            put_string(s, code == '&' ? "&amp;" : code == '<' ? "&lt;" : code == '>' ? "&gt;" : "&quot;");
        else
            put_bytes(s, utf8, glint_font_encode(code, utf8));
    }
}

/// Puts bytes in base64.
static void put_base64(svg *s, const uint8_t *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (!glint_bytes_reserve(s->out, size / 3 * 4 + 4)) {
        s->lost = true;
        return;
    }
    uint8_t *to = s->out->data + s->out->size;
    for (size_t i = 0; i < size; i += 3) {
        const uint32_t second = i + 1 < size ? bytes[i + 1] : 0, third = i + 2 < size ? bytes[i + 2] : 0;
        const uint32_t word = (uint32_t)bytes[i] << 16 | second << 8 | third;
        for (int k = 0; k < 4; k++)
            *to++ = (uint8_t)(i + (size_t)k > size ? '=' : digits[word >> (18 - 6 * k) & 63]);
    }
    s->out->size = (size_t)(to - s->out->data);
}

// ---- Marks --------------------------------------------------------------------------------------------------------

static void put_fill(svg *s, const glint_ink_mark *mark)
{
    put(s, "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"", mark->box.x, mark->box.y, mark->box.width,
        mark->box.height);
    put_color(s, "fill", mark->color);
    if (mark->opacity < 1)
        put_attribute(s, "fill-opacity", mark->opacity);
    put_string(s, " shape-rendering=\"crispEdges\"/>\n");
}

static void put_strokes(svg *s, const glint_ink_mark *mark)
{
    const glint_strokes *strokes = &mark->strokes;
    const double *end = NULL;
    double ends[2];
    put_string(s, "<path d=\"");
    for (size_t i = 0; i < strokes->count; i++) {
        const double *from = strokes->of[i].from, *offset = strokes->of[i].offset;
        if (!end || fabs(end[0] - from[0]) + fabs(end[1] - from[1]) > 1e-6)
            put_point(s, 'M', from[0], from[1]);
        ends[0] = from[0] + offset[0];
        ends[1] = from[1] + offset[1];
        put_point(s, 'L', ends[0], ends[1]);
        end = ends;
    }
    put_string(s, "\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\"");
    put_attribute(s, "stroke-width", 2 * strokes->half);
    put_color(s, "stroke", mark->color);
    put_string(s, "/>\n");
    if (!strokes->has_head)
        return;
    put_string(s, "<path d=\"");
    for (int i = 0; i < 3; i++)
        put_point(s, i ? 'L' : 'M', strokes->head[i][0], strokes->head[i][1]);
    put_string(s, "Z\"");
    put_color(s, "fill", mark->color);
    put_string(s, "/>\n");
}

/// Puts the font's attributes. The letters of the bitmap font become letters of a font with the same widths.
static void put_font(svg *s, const glint_letters *letters, const glint_run *run)
{
    if (!letters) {
        put_string(s, " font-family=\"" BITMAP_FAMILY "\"");
        put_attribute(s, "font-size", GLINT_FONT_HEIGHT * glint_typeface_scale(run->em));
        return;
    }
    const glint_font_name name = glint_letters_name(letters);
    put_string(s, " font-family=\"");
    put_escaped(s, name.family, SIZE_MAX);
    put_string(s, ", Verdana, sans-serif\"");
    put_attribute(s, "font-size", run->em);
    put(s, "%s%s", name.bold ? " font-weight=\"bold\"" : "", name.italic ? " font-style=\"italic\"" : "");
}

/// Puts the position of a run, whose line begins at x, y. Bold letters grow to the right and upwards.
static void put_position(svg *s, const glint_run *run, double x, double y)
{
    const double growth = glint_letters_growth(run) / 2;
    x += run->x + growth;
    y += run->y - growth;
    if (run->slant == 0 && run->stretch == 1) {
        put_attribute(s, "x", x);
        put_attribute(s, "y", y);
        return;
    }
    const double matrix[] = { 1, 0, -run->slant, run->stretch, x, y };
    put_string(s, " transform=\"matrix(");
    for (int i = 0; i < 6; i++) {
        put_string(s, i ? " " : "");
        put_number(s, matrix[i]);
    }
    put_string(s, ")\"");
}

static void put_outline(void *context, char command, int count, const double points[3][2])
{
    svg *s = context;
    put_point(s, command, points[0][0], points[0][1]);
    for (int i = 1; i < count; i++)
        put_point(s, ' ', points[i][0], points[i][1]);
}

static void put_accent(svg *s, const glint_ink_mark *mark, const glint_run *accent, double x, double y)
{
    glint_run run = *accent;
    run.x += x;
    run.y += y;
    put_string(s, "<path d=\"");
    glint_letters_outline(mark->typeface.letters, &run, put_outline, s);
    put_string(s, "\"");
    put_color(s, "fill", mark->color);
    put_string(s, "/>\n");
}

/// Puts a run. With another font than glint's, the reader's program fits it into the same width.
static void put_run(svg *s, const glint_ink_mark *mark, const glint_run *run, double x, double y)
{
    const glint_letters *letters = mark->typeface.letters;
    if (run->is_accent && letters) {
        put_accent(s, mark, run, x, y);
        return;
    }
    put_string(s, "<text");
    put_position(s, run, x, y);
    put_font(s, letters, run);
    put_attribute(s, "textLength", glint_typeface_advance(&mark->typeface, run));
    put_string(s, " lengthAdjust=\"spacingAndGlyphs\"");
    put_color(s, "fill", mark->color);
    if (run->bold) {
        put_color(s, "stroke", mark->color);
        put_attribute(s, "stroke-width", glint_letters_growth(run));
    }
    put_string(s, ">");
    put_escaped(s, run->text, run->size);
    put_string(s, "</text>\n");
}

static void put_rule(svg *s, const glint_ink_mark *mark, const glint_rule *rule, double x, double y)
{
    put_string(s, "<rect");
    put_attribute(s, "x", x + rule->x);
    put_attribute(s, "y", y + rule->y);
    put_attribute(s, "width", rule->width);
    put_attribute(s, "height", rule->height);
    put_color(s, "fill", mark->color);
    put_string(s, "/>\n");
}

static void put_text(svg *s, const glint_ink_mark *mark)
{
    const glint_rect *box = &mark->box;
    glint_line line;
    glint_line_set(&mark->typeface, mark->text, SIZE_MAX, &line);
    double x = line.pad, y = line.above;
    if (mark->turn == GLINT_LEVEL) {
        x += box->x;
        y += box->y;
    } else if (mark->turn == GLINT_DOWN) {
        put(s, "<g transform=\"translate(%d %d) rotate(90)\">\n", box->x + box->width, box->y);
    } else {
        put(s, "<g transform=\"translate(%d %d) rotate(-90)\">\n", box->x, box->y + box->height);
    }
    for (int i = 0; i < line.run_count; i++)
        put_run(s, mark, &line.runs[i], x, y);
    for (int i = 0; i < line.rule_count; i++)
        put_rule(s, mark, &line.rules[i], x, y);
    put_string(s, mark->turn ? "</g>\n" : "");
}

static bool is_page(const svg *s, const glint_rect *clip)
{
    return clip->x == 0 && clip->y == 0 && clip->width == s->ink->width && clip->height == s->ink->height;
}

/// Ends the group of the last clip rectangle, and begins a group for another one.
static void put_clip(svg *s, const glint_rect *clip)
{
    if (!memcmp(&s->clip, clip, sizeof *clip))
        return;
    if (!is_page(s, &s->clip))
        put_string(s, "</g>\n");
    s->clip = *clip;
    if (is_page(s, clip))
        return;
    s->clips++;
    put(s, "<clipPath id=\"clip%d\"><rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/></clipPath>\n", s->clips,
        clip->x, clip->y, clip->width, clip->height);
    put(s, "<g clip-path=\"url(#clip%d)\">\n", s->clips);
}

static void put_marks(svg *s)
{
    static void (*const puts_mark[])(svg *, const glint_ink_mark *) = { put_fill, put_text, put_strokes };
    const glint_ink *ink = s->ink;
    const glint_rect page = { 0, 0, ink->width, ink->height };
    s->clip = page;
    for (size_t i = 0; i < ink->count; i++) {
        put_clip(s, &ink->of[i].clip);
        puts_mark[ink->of[i].kind](s, &ink->of[i]);
    }
    put_clip(s, &page);
}

// ---- The file -----------------------------------------------------------------------------------------------------

static void put_head(svg *s, const glint_figure *figure, const glint_png_desc *desc)
{
    const glint_png_source *source = figure->source;
    const double unit = glint_figure_unit(desc);
    put_string(s, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
                  "xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"");
    put_number(s, source->width * unit);
    put_string(s, "pt\" height=\"");
    put_number(s, source->height * unit);
    put(s, "pt\" viewBox=\"%d %d %d %d\" xml:space=\"preserve\">\n", figure->x, figure->y, source->width, source->height);
}

glint_status glint_svg_encode(const glint_figure *figure, const glint_png_desc *desc, glint_bytes *out,
                              glint_error *error)
{
    const glint_png_source *source = figure->source;
    glint_bytes png = { 0 };
    svg s = { .out = out, .ink = figure->ink, .transfer = source->tone.transfer };
    const glint_status status = glint_png_encode(NULL, source, desc, &png, NULL, error);
    if (!status) {
        put_head(&s, figure, desc);
        put(&s, "<image x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" xlink:href=\"data:image/png;base64,", figure->x,
            figure->y, source->width, source->height);
        put_base64(&s, png.data, png.size);
        put_string(&s, "\"/>\n");
        if (figure->ink)
            put_marks(&s);
        put_string(&s, "</svg>\n");
    }
    free(png.data);
    return s.lost && !status ? glint_fail_nomem(error) : status;
}

glint_status glint_svg_encode_marks(const glint_ink *ink, const double box[4], glint_transfer transfer, glint_bytes *out,
                                    glint_error *error)
{
    svg s = { .out = out, .ink = ink, .transfer = transfer };
    put_string(&s, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"");
    for (int i = 0; i < 4; i++) {
        put_string(&s, i ? " " : "");
        put_number(&s, box[i]);
    }
    put_string(&s, "\" preserveAspectRatio=\"none\" xml:space=\"preserve\">\n");
    put_marks(&s);
    put_string(&s, "</svg>\n");
    return s.lost ? glint_fail_nomem(error) : GLINT_OK;
}
