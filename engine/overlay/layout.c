#include "engine/overlay/layout.h"

#include "engine/base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEAST_SIZE 10.0 ///< default font size, at least; pixels
#define SIZE_SHARE 36.0 ///< the default font size is the picture's height divided by this
#define PIECE 64 ///< pixels of a line drawn at once
#define PADDING 0.35 ///< between the text and the border of its background, in font sizes

int glint_layout_measure(const glint_layout *layout, const char *text, int *lines)
{
    int widest = 0;
    for (*lines = 0; *text; ++*lines) {
        const size_t size = strcspn(text, "\n");
        const int width = glint_typeface_width(&layout->typeface, text, size);
        widest = width > widest ? width : widest;
        text += size + (text[size] == '\n');
    }
    return widest;
}

bool glint_layout_mask(const glint_layout *layout, int x, int y, int width, int height, glint_stamp *stamp)
{
    const int x0 = x > 0 ? x : 0, y0 = y > 0 ? y : 0;
    const int x1 = x + width < layout->overlays->width ? x + width : layout->overlays->width;
    const int y1 = y + height < layout->overlays->height ? y + height : layout->overlays->height;
    if (x0 >= x1 || y0 >= y1)
        return false;
    *stamp = (glint_stamp) { .x = x0, .y = y0, .width = x1 - x0, .height = y1 - y0, .opacity = 255 };
    stamp->coverage = calloc((size_t)stamp->width, (size_t)stamp->height);
    if (!stamp->coverage)
        layout->stamps->lost = true;
    return stamp->coverage != NULL;
}

void glint_layout_text(const glint_layout *layout, const char *text, int x, int y, int width, double align,
                       const double color[3])
{
    for (; *text; y += layout->typeface.line) {
        const size_t size = strcspn(text, "\n");
        const int wide = glint_typeface_width(&layout->typeface, text, size);
        const int at = x + (int)floor((width - wide) * align);
        glint_stamp stamp;
        if (glint_layout_mask(layout, at, y, wide, layout->typeface.height, &stamp)) {
            glint_mask mask = { stamp.width, stamp.height, stamp.coverage };
            glint_typeface_draw(&layout->typeface, text, size, at - stamp.x, y - stamp.y, &mask);
            glint_stamps_add(layout->stamps, stamp, color);
        }
        text += size + (text[size] == '\n');
    }
}

void glint_layout_fill(const glint_layout *layout, int x, int y, int width, int height, const double color[3],
                       double opacity)
{
    const int x1 = x + width, y1 = y + height, wide = layout->overlays->width, high = layout->overlays->height;
    glint_stamp stamp = { .x = x > 0 ? x : 0, .y = y > 0 ? y : 0, .opacity = (uint8_t)(opacity * 255 + 0.5) };
    stamp.width = (x1 < wide ? x1 : wide) - stamp.x;
    stamp.height = (y1 < high ? y1 : high) - stamp.y;
    if (stamp.width > 0 && stamp.height > 0)
        glint_stamps_add(layout->stamps, stamp, color);
}

/// Returns the distance of a point from the line from 0 to `end`.
static double distance_to(const double end[2], double x, double y)
{
    const double square = end[0] * end[0] + end[1] * end[1];
    const double along = square > 0 ? fmin(fmax((x * end[0] + y * end[1]) / square, 0), 1) : 0;
    const double dx = x - along * end[0], dy = y - along * end[1];
    return sqrt(dx * dx + dy * dy);
}

/// Draws the part of a line inside a rectangle.
static void draw_piece(const glint_layout *layout, const double from[2], const double offset[2], double half,
                       const double color[3], const int corner[2], const int size[2])
{
    glint_stamp stamp;
    if (!glint_layout_mask(layout, corner[0], corner[1], size[0], size[1], &stamp))
        return;
    for (int y = 0; y < stamp.height; y++)
        for (int x = 0; x < stamp.width; x++) {
            const double d = distance_to(offset, stamp.x + x + 0.5 - from[0], stamp.y + y + 0.5 - from[1]);
            const double covered = fmin(fmax(half + 0.5 - d, 0), 1);
            stamp.coverage[(size_t)y * (size_t)stamp.width + (size_t)x] = (uint8_t)(covered * 255 + 0.5);
        }
    glint_stamps_add(layout->stamps, stamp, color);
}

void glint_layout_line(const glint_layout *layout, const double from[2], const double offset[2], double half,
                       const double color[3])
{
    const int sides[2] = { layout->overlays->width, layout->overlays->height };
    const int along = fabs(offset[0]) < fabs(offset[1]), across = !along;
    const double slope = offset[along] != 0 ? offset[across] / offset[along] : 0,
                 wide = 1.5 * half + 2; // up to 45 degrees
    const double first = fmin(from[along], from[along] + offset[along]) - half - 1;
    const double last = fmax(from[along], from[along] + offset[along]) + half + 1;
    const int begin = (int)fmin(fmax(first, 0), sides[along]), end = (int)ceil(fmax(fmin(last, sides[along]), 0));
    for (int k = begin; k < end; k += PIECE) { // in pieces, since a slanted line fills little of its bounding rectangle
        const int length = end - k < PIECE ? end - k : PIECE;
        const double a = from[across] + (k - from[along]) * slope, b = a + length * slope;
        const double low = fmin(fmax(fmin(a, b) - wide, 0), sides[across]), high = fmin(fmax(fmax(a, b) + wide, 0), sides[across]);
        int corner[2], size[2];
        corner[along] = k;
        corner[across] = (int)floor(low);
        size[along] = length;
        size[across] = (int)ceil(high) - corner[across];
        draw_piece(layout, from, offset, half, color, corner, size);
    }
}

/// Wraps the lines of a label at spaces if they are wider than the picture less its margins. A word wider than that
/// stays whole.
static void wrap(glint_layout *layout, double margin)
{
    const int most = layout->overlays->width - 2 * layout->padding, space = most - 2 * (int)ceil(margin);
    const glint_typeface *typeface = &layout->typeface;
    for (char *line = layout->text; *line;) {
        const size_t size = strcspn(line, "\n");
        char *end = line + size, *fits = NULL;
        bool is_wide = glint_typeface_width(typeface, line, size) > most;
        for (char *blank = line; is_wide && (blank = memchr(blank, ' ', (size_t)(end - blank))) != NULL; blank++) {
            if (fits && glint_typeface_width(typeface, line, (size_t)(blank - line)) > space)
                break;
            fits = blank;
        }
        if (fits && (fits > line))
            *fits = '\n';
        line = fits ? fits + 1 : end + (*end == '\n');
    }
}

static void measure_label(glint_layout *layout)
{
    int lines;
    layout->width = glint_layout_measure(layout, layout->text, &lines);
    layout->height = (lines - 1) * layout->typeface.line + layout->typeface.height;
}

static void draw_label(const glint_layout *layout, int x, int y)
{
    const glint_overlay_desc *desc = layout->desc;
    glint_layout_text(layout, layout->text, x, y, layout->width, desc->has_position ? 0 : desc->at[0], desc->color);
}

/// Converts a length in points to pixels, at most the largest side of a picture.
static double pixels_of(double points, double dpi) { return fmin(points * (dpi > 0 ? dpi / 72 : 1), GLINT_SIDE_MAX); }

glint_layout glint_layout_begin(const glint_overlays *overlays, const glint_overlay_desc *desc, double dpi, glint_letters *letters,
                                glint_stamps *stamps)
{
    static const double lengths[] = { [GLINT_OVERLAY_COLORBAR] = 10, [GLINT_OVERLAY_AXES] = 2.5 };
    glint_layout layout = { .overlays = overlays, .desc = desc, .stamps = stamps };
    layout.em = desc->has_size ? pixels_of(desc->size, dpi) : fmax(overlays->height / SIZE_SHARE, LEAST_SIZE);
    layout.typeface = glint_typeface_open(letters, layout.em);
    if (desc->kind != GLINT_OVERLAY_LABEL)
        layout.length = desc->has_length ? pixels_of(desc->length, dpi) : lengths[desc->kind] * layout.em;
    layout.padding = desc->has_background ? (int)ceil(PADDING * layout.em) : 0;
    memcpy(layout.text, desc->text, sizeof layout.text);
    return layout;
}

void glint_layout_place(glint_layout *layout, double dpi)
{
    static void (*const measures[])(glint_layout *) = { measure_label, glint_colorbar_measure, glint_axes_measure };
    const glint_overlay_desc *desc = layout->desc;
    const double margin = desc->has_margin ? pixels_of(desc->margin, dpi) : layout->em / 2;
    const int sides[2] = { layout->overlays->width, layout->overlays->height };
    if (desc->kind == GLINT_OVERLAY_LABEL && !desc->has_position)
        wrap(layout, margin);
    measures[desc->kind](layout);
    layout->size[0] = layout->width + 2 * layout->padding;
    layout->size[1] = layout->height + 2 * layout->padding;
    for (int i = 0; i < 2; i++)
        layout->corner[i] = (int)floor(desc->has_position ? desc->position[i]
                                                          : margin + (sides[i] - 2 * margin - layout->size[i]) * desc->at[i]);
}

static void draw(glint_layout *layout, double dpi)
{
    static void (*const draws[])(const glint_layout *, int, int) = { draw_label, glint_colorbar_draw, glint_axes_draw };
    const glint_overlay_desc *desc = layout->desc;
    const int *corner = layout->corner, *size = layout->size;
    if (desc->kind == GLINT_OVERLAY_AXES && desc->has_box) {
        glint_box_axes_draw(layout);
        return;
    }
    glint_layout_place(layout, dpi);
    if (desc->has_background)
        glint_layout_fill(layout, corner[0], corner[1], size[0], size[1], desc->background, desc->opacity);
    draws[desc->kind](layout, corner[0] + layout->padding, corner[1] + layout->padding);
}

glint_status glint_overlays_draw(const glint_overlays *overlays, double dpi, glint_transfer transfer, int bits,
                                 glint_stamps *out, glint_error *error)
{
    glint_letters *letters;
    *out = (glint_stamps) { .transfer = transfer, .bits = bits };
    glint_status status = glint_letters_open(&letters, error);
    if (status)
        return status;
    for (size_t i = 0; i < overlays->count; i++) {
        glint_layout layout = glint_layout_begin(overlays, &overlays->of[i], dpi, letters, out);
        draw(&layout, dpi);
    }
    out->lost = out->lost || glint_letters_lost(letters);
    glint_letters_close(letters);
    if (!out->lost)
        return GLINT_OK;
    glint_stamps_free(out);
    return glint_fail_nomem(error);
}

void glint_colorbar_alone(const glint_overlay_desc *desc, glint_letters *letters, const int sides[2], int x, int y,
                          glint_stamps *stamps, int size[2])
{
    const glint_overlays overlays = { .width = sides[0], .height = sides[1] };
    glint_layout layout = glint_layout_begin(&overlays, desc, 0, letters, stamps);
    glint_colorbar_measure(&layout);
    size[0] = layout.width;
    size[1] = layout.height;
    if (stamps)
        glint_colorbar_draw(&layout, x, y);
}
