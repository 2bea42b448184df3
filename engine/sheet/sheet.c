/// Contact sheets: finished pictures in rows, each with its label, on white.
///
///     title
///               across ->
///     d    [ picture ] [ picture ]
///     o      label       label
///     w    [difference][difference]    on request
///     n      label       label
///
/// A colour bar for all pictures is at the right, or below.
#include "engine/base/status.h"
#include "engine/ink/stamps.h"
#include "engine/overlay/overlay.h"
#include "engine/file/file.h"
#include "engine/file/png.h"
#include "engine/file/write.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXT_COLOR 0x222222
#define FAINT_COLOR 0x6a6a6a
#define FRAME_COLOR 0xd9594c // of the frame around the chosen cell
#define LARGE_PICTURE 900 // labels of pictures at least this wide are twice as large; pixels
#define AREA_MAX ((int64_t)400000000) // most pixels of a sheet: 1.2 GB while the sheet is drawn
#define PART_GAP 2 // gap between parts of a label on the same line, in letters
#define LETTER 8 // width of a letter in 13ths of its size
#define SIZE 13 // size of labels in pixels, unless the sheet sets it
#define BAR_MOST 20 // longest colour bar if it has no length of its own, in label sizes

/// The sheet's measures, in pixels.
typedef struct layout {
    const glint_sheet_desc *desc;
    int width, height; ///< of each picture
    glint_ink ink; ///< everything except the pixels of pictures. Owned
    glint_typeface typeface, title; ///< typeface of labels; typeface of the title, which is twice as large
    double unit; ///< pixels in a 13th of the label size
    int rows;
    int column, label; ///< width of a column; height of the label below a picture
    int left, top; ///< position of the first picture
    int band; ///< height of a row of pictures together with its row of differences
    int gap;
    int note_lines; ///< at the bottom
    char note[160]; ///< text that explains the rows of differences, in parts
    glint_overlay_desc bar; ///< the sheet's colour bar, with lengths in pixels
    int bar_size[2];
    int64_t sheet_width, sheet_height;
} layout;

/// The pixels of a sheet's pictures, on white or transparent paper.
typedef struct canvas {
    int width, height;
    int channels; ///< 3 or 4
    uint8_t *pixels; ///< channels * width * height values, top row first. Owned
} canvas;

/// Converts a colour 0xRRGGBB to linear.
static void to_linear(uint32_t color, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = glint_srgb_decode((color >> (16 - 8 * c) & 255) / 255.0);
}

// ---- Labels -------------------------------------------------------------------------------------------------------

static int pixels(const layout *l, double units) { return (int)(units * l->unit + 0.5); }

static int line_height(const layout *l) { return l->typeface.line; }

static int text_width(const layout *l, const char *text, size_t size)
{
    return glint_typeface_width(&l->typeface, text, size);
}

/// Returns the width of the longest part of a label.
static int widest_part(const layout *l, const char *label)
{
    int widest = 0;
    while (label && *label) {
        size_t size = strcspn(label, "\n");
        int width = text_width(l, label, size);
        widest = width > widest ? width : widest;
        label += size + (label[size] == '\n');
    }
    return widest;
}

static void write_text(layout *l, const glint_typeface *typeface, int x, int y, const char *text, size_t size, glint_turn turn,
                       uint32_t color)
{
    double linear[3];
    to_linear(color, linear);
    glint_ink_text(&l->ink, typeface, text, size, x, y, turn, linear);
}

/// Breaks `label` into lines at most `space` wide; parts share a line if they fit. If `draws`, draws the lines
/// from `y` down, centred between `x` and `x` + `space`. Returns the number of lines.
static int set_label(layout *l, const char *label, int space, bool draws, int x, int y)
{
    int lines = 0;
    while (label && *label) {
        const char *part = label;
        int width = 0, gap = pixels(l, PART_GAP * LETTER);
        while (*part) { // counts the parts of this line
            size_t size = strcspn(part, "\n");
            int wider = (part > label ? width + gap : 0) + text_width(l, part, size);
            if (part > label && wider > space)
                break;
            width = wider;
            part += size + (part[size] == '\n');
        }
        for (int at = x + (space - width) / 2; label < part;) {
            size_t size = strcspn(label, "\n");
            if (draws)
                write_text(l, &l->typeface, at, y + lines * line_height(l), label, size, GLINT_LEVEL, TEXT_COLOR);
            at += text_width(l, label, size) + gap;
            label += size + (label[size] == '\n');
        }
        lines++;
    }
    return lines;
}

// ---- Measuring ----------------------------------------------------------------------------------------------------

/// Returns the width or height of the grid of pictures.
static int64_t grid_size(const layout *l, bool across)
{
    return across ? (int64_t)l->desc->columns * (l->column + l->gap) - l->gap : (int64_t)l->rows * l->band - l->gap;
}

/// Lays out the colour bar, and reserves its space next to the grid, which is measured already.
static void measure_bar(layout *l)
{
    const double size = SIZE * l->unit, dpi = l->desc->dpi;
    const bool across = l->desc->colorbar->orientation == GLINT_HORIZONTAL;
    l->bar = *l->desc->colorbar;
    l->bar.length = l->bar.has_length ? l->bar.length * (dpi > 0 ? dpi / 72 : 1) : fmin((double)grid_size(l, across), BAR_MOST * size);
    l->bar.size = size;
    l->bar.has_length = l->bar.has_size = true;
    to_linear(TEXT_COLOR, l->bar.color);
    glint_colorbar_measure_alone(&l->bar, &l->ink, l->bar_size);
    const int64_t least[2] = { l->left + (int64_t)l->bar_size[0] + l->gap, l->top + (int64_t)l->bar_size[1] + l->gap };
    l->sheet_width += across ? 0 : l->bar_size[0] + l->gap;
    l->sheet_height += across ? l->bar_size[1] + l->gap : 0;
    l->sheet_width = least[0] > l->sheet_width ? least[0] : l->sheet_width;
    l->sheet_height = least[1] > l->sheet_height ? least[1] : l->sheet_height;
}

/// Computes the size of the whole sheet: the grid and everything around it.
static void measure_sheet(layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    int64_t least[2] = { 0, 0 };
    l->sheet_width = (int64_t)l->left + (int64_t)desc->columns * (l->column + l->gap);
    l->sheet_height = (int64_t)l->top + (int64_t)l->rows * l->band;
    if (desc->colorbar)
        measure_bar(l);
    if (desc->title)
        least[0] = l->left + (int64_t)glint_typeface_width(&l->title, desc->title, SIZE_MAX) + l->gap;
    if (desc->difference) {
        snprintf(l->note, sizeof l->note,
                 "below each: |picture - cell %zu| x %g\nmax: the largest difference, of 255\n%%: pixels that differ",
                 desc->difference, desc->gain);
        least[1] = l->left + widest_part(l, l->note) + l->gap;
    }
    for (int i = 0; i < 2; i++)
        l->sheet_width = least[i] > l->sheet_width ? least[i] : l->sheet_width;
    if (l->sheet_width <= GLINT_SIDE_MAX)
        l->note_lines = set_label(l, l->note, (int)l->sheet_width - l->left - l->gap, false, 0, 0);
    l->sheet_height += (int64_t)l->note_lines * line_height(l) + (l->note_lines ? l->gap / 2 : 0);
}

/// Measures a sheet. Its description, the size of a picture and the ink are set.
static void measure(layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    int lines = 0;
    bool differs = desc->difference > 0;
    const double size = desc->size > 0 ? desc->size * (desc->dpi > 0 ? desc->dpi / 72 : 1)
                                       : SIZE * (l->width >= LARGE_PICTURE ? 2 : 1);
    l->unit = (size < GLINT_SIDE_MAX / 2 ? size : GLINT_SIDE_MAX / 2) / SIZE;
    l->typeface = glint_typeface_open(l->ink.letters, SIZE * l->unit);
    l->title = glint_typeface_open(l->ink.letters, 2 * SIZE * l->unit);
    l->gap = pixels(l, 12);
    l->rows = (int)((desc->cell_count + (size_t)desc->columns - 1) / (size_t)desc->columns);
    l->column = l->width;
    for (size_t i = 0; i < desc->cell_count; i++) {
        int widest = widest_part(l, desc->cells[i].label);
        l->column = widest > l->column ? widest : l->column;
    }
    for (size_t i = 0; i < desc->cell_count; i++) {
        int count = set_label(l, desc->cells[i].label, l->column, false, 0, 0);
        lines = count > lines ? count : lines;
    }
    lines = differs && lines < 1 ? 1 : lines;
    l->label = lines * line_height(l) + (lines ? pixels(l, 4) : 0);
    l->left = l->gap + (desc->down ? line_height(l) + l->gap / 2 : 0);
    l->top = l->gap + (desc->title ? l->title.line + l->gap : 0) + (desc->across ? line_height(l) + l->gap / 2 : 0);
    l->band = (differs ? 2 : 1) * (l->height + l->label + l->gap);
    measure_sheet(l);
}

// ---- Drawing ------------------------------------------------------------------------------------------------------

static uint8_t *row_at(canvas *paper, int x, int y)
{
    return paper->pixels + ((size_t)y * (size_t)paper->width + (size_t)x) * (size_t)paper->channels;
}

/// Computes the upper left corner of the picture of cell `i`, from 0.
static void place_cell(const layout *l, size_t i, int *x, int *y)
{
    int column = (int)(i % (size_t)l->desc->columns), row = (int)(i / (size_t)l->desc->columns);
    *x = l->left + column * (l->column + l->gap) + (l->column - l->width) / 2;
    *y = l->top + row * l->band;
}

/// Draws |a - b| times the gain below picture `a`, with a text. Both pictures are on the canvas already.
static void draw_difference(layout *l, canvas *paper, size_t a, size_t b)
{
    int ax, ay, bx, by, most = 0;
    int64_t count = 0;
    char label[96];
    place_cell(l, a, &ax, &ay);
    place_cell(l, b, &bx, &by);
    int y = ay + l->band / 2;
    for (int row = 0; row < l->height; row++) {
        const uint8_t *from = row_at(paper, ax, ay + row), *to = row_at(paper, bx, by + row);
        uint8_t *out = row_at(paper, ax, y + row);
        for (int x = 0; x < l->width; x++) {
            const int at = x * paper->channels;
            int largest = 0;
            for (int c = 0; c < 3; c++) {
                int difference = abs(from[at + c] - to[at + c]);
                double shown = difference * l->desc->gain + 0.5;
                out[at + c] = (uint8_t)(shown < 255 ? shown : 255);
                largest = difference > largest ? difference : largest;
            }
            if (paper->channels == 4)
                out[at + 3] = 255;
            most = largest > most ? largest : most;
            count += largest > 0;
        }
    }
    if (a == b)
        snprintf(label, sizeof label, "cell %zu", b + 1);
    else
        snprintf(label, sizeof label, "max %d\n%.3g %%", most, 100.0 * (double)count / ((double)l->width * l->height));
    set_label(l, label, l->column, true, ax - (l->column - l->width) / 2, y + l->height + pixels(l, 4));
}

/// Draws a frame just outside a picture.
static void draw_frame(layout *l, int x, int y)
{
    const int t = pixels(l, 3);
    double color[3];
    to_linear(FRAME_COLOR, color);
    glint_ink_fill(&l->ink, x - t, y - t, l->width + 2 * t, t, color, 1);
    glint_ink_fill(&l->ink, x - t, y + l->height, l->width + 2 * t, t, color, 1);
    glint_ink_fill(&l->ink, x - t, y, t, l->height, color, 1);
    glint_ink_fill(&l->ink, x + l->width, y, t, l->height, color, 1);
}

static void draw_differences(layout *l, canvas *paper)
{
    size_t chosen = l->desc->difference - 1;
    int x, y;
    for (size_t i = 0; i < l->desc->cell_count; i++)
        draw_difference(l, paper, i, chosen);
    place_cell(l, chosen, &x, &y);
    draw_frame(l, x, y);
    y = (int)l->sheet_height - l->note_lines * line_height(l) - l->gap / 2;
    set_label(l, l->note, (int)l->sheet_width - l->left - l->gap, true, l->left, y);
}

/// Draws the colour bar in the middle of the grid's right side, or below the grid.
static void draw_bar(layout *l)
{
    const bool across = l->bar.orientation == GLINT_HORIZONTAL;
    const int space = (int)grid_size(l, across) - l->bar_size[across ? 0 : 1], shift = space > 0 ? space / 2 : 0;
    const int beyond = (int)grid_size(l, !across) + l->gap;
    glint_colorbar_draw_alone(&l->bar, &l->ink, l->left + (across ? shift : beyond), l->top + (across ? beyond : shift));
}

/// Draws "name ->" centred above the columns, and centred next to the rows.
static void draw_titles(layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    char text[256];
    if (desc->title)
        write_text(l, &l->title, l->left, l->gap, desc->title, SIZE_MAX, GLINT_LEVEL, TEXT_COLOR);
    if (desc->across) {
        int grid = (int)grid_size(l, true);
        snprintf(text, sizeof text, "%.240s \xe2\x86\x92", desc->across);
        write_text(l, &l->typeface, l->left + (grid - text_width(l, text, SIZE_MAX)) / 2,
                   l->top - line_height(l) - l->gap / 2, text, SIZE_MAX, GLINT_LEVEL, FAINT_COLOR);
    }
    if (desc->down) {
        int grid = (int)grid_size(l, false);
        snprintf(text, sizeof text, "%.240s \xe2\x86\x92", desc->down);
        int y = l->top + (grid - text_width(l, text, SIZE_MAX)) / 2;
        write_text(l, &l->typeface, l->gap, y > 0 ? y : 0, text, SIZE_MAX, GLINT_DOWN, FAINT_COLOR);
    }
}

static glint_status check_size(const layout *l, const glint_picture *picture, const char *path, glint_error *error)
{
    int width = glint_picture_width(picture), height = glint_picture_height(picture);
    if (width == l->width && height == l->height)
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "%.200s: %dx%d pixels expected, as in %.200s, got %dx%d", path,
                      l->width, l->height, l->desc->cells[0].path, width, height);
}

static void put_row(const glint_picture *picture, int row, const canvas *paper, uint8_t *out)
{
    glint_picture_row(picture, row, 255, out);
    for (int x = glint_picture_width(picture) - 1; x >= 0 && paper->channels == 4; x--) { // backwards, in place
        memmove(out + 4 * x, out + 3 * x, 3);
        out[4 * x + 3] = 255;
    }
}

static glint_status draw_cell(layout *l, canvas *paper, size_t i, glint_error *error)
{
    const glint_sheet_cell *cell = &l->desc->cells[i];
    glint_picture *picture = NULL;
    int x, y;
    place_cell(l, i, &x, &y);
    glint_status status = glint_picture_read(cell->path, true, &picture, error);
    if (!status)
        status = check_size(l, picture, cell->path, error);
    for (int row = 0; row < l->height && !status; row++)
        put_row(picture, row, paper, row_at(paper, x, y + row));
    glint_picture_destroy(picture);
    set_label(l, cell->label, l->column, true, x - (l->column - l->width) / 2, y + l->height + pixels(l, 4));
    return status;
}

static const void *row_of_canvas(const void *user, int y, void *scratch)
{
    const canvas *paper = user;
    (void)scratch;
    return paper->pixels + (size_t)y * (size_t)paper->width * (size_t)paper->channels;
}

static glint_status write_canvas(const canvas *paper, double dpi, const char *path, glint_error *error)
{
    glint_text text = { "Software", "glint " GLINT_VERSION };
    glint_png_source source = {
        .width = paper->width, .height = paper->height, .row = row_of_canvas, .user = paper
    };
    glint_png_desc png = { .encode = GLINT_ENCODE_SMALL, .text = &text, .text_count = 1, .dpi = dpi };
    glint_bytes bytes = { 0 };
    source.tone = glint_tone_desc_default();
    source.alpha = paper->channels == 4;
    glint_status status = glint_png_encode(NULL, &source, &png, &bytes, NULL, error);
    if (!status)
        status = glint_file_write(path, bytes.data, bytes.size, error);
    free(bytes.data);
    return status;
}

/// Fills the paper with white; with alpha, with transparency. False: out of memory.
static bool make_paper(const layout *l, canvas *out)
{
    const bool alpha = l->desc->transparent;
    const int channels = alpha ? 4 : 3;
    const size_t size = (size_t)l->sheet_width * (size_t)l->sheet_height * (size_t)channels;
    *out = (canvas) { (int)l->sheet_width, (int)l->sheet_height, channels, malloc(size) };
    if (out->pixels)
        memset(out->pixels, alpha ? 0 : 255, size);
    return out->pixels != NULL;
}

/// Draws the ink on the paper.
static glint_status draw_ink(const layout *l, canvas *paper, glint_error *error)
{
    glint_stamps stamps;
    const glint_status status = glint_stamps_make(&l->ink, GLINT_TRANSFER_SRGB, 8, &stamps, error);
    for (int y = 0; y < paper->height && !status; y++)
        glint_stamps_row(&stamps, 0, y, paper->width, paper->channels, row_at(paper, 0, y));
    glint_stamps_free(&stamps);
    return status;
}

static glint_status draw_sheet(layout *l, const char *path, glint_error *error)
{
    canvas paper;
    if (!make_paper(l, &paper))
        return glint_fail_nomem(error);
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < l->desc->cell_count && !status; i++)
        status = draw_cell(l, &paper, i, error);
    if (!status && l->desc->difference)
        draw_differences(l, &paper);
    draw_titles(l);
    if (l->desc->colorbar)
        draw_bar(l);
    if (!status)
        status = draw_ink(l, &paper, error);
    if (!status)
        status = write_canvas(&paper, l->desc->dpi, path, error);
    free(paper.pixels);
    return status;
}

static glint_status check_bar(const glint_overlay_desc *desc, glint_error *error)
{
    glint_overlay *bar = NULL;
    glint_error wrong;
    if (desc->kind != GLINT_OVERLAY_COLORBAR)
        return glint_fail(error, GLINT_ERR_INVALID, "colorbar: an overlay of that kind expected");
    const glint_status status = glint_overlay_create(desc, &bar, &wrong);
    glint_overlay_release(bar);
    return status ? glint_fail(error, status, "colorbar.%.400s", wrong.message) : GLINT_OK;
}

static glint_status check_desc(const glint_sheet_desc *desc, const char *path, glint_error *error)
{
    glint_file_kind kind;
    glint_status status = glint_file_kind_of(path, &kind, error);
    if (!status && kind != GLINT_FILE_PNG)
        status = glint_fail(error, GLINT_ERR_INVALID, "path: name ending in .png expected, got '%.400s'", path);
    if (!status)
        status = glint_check_whole("cell_count", (double)desc->cell_count, 1, 1e6, error);
    if (!status)
        status = glint_check_whole("columns", desc->columns, 1, GLINT_SIDE_MAX, error);
    if (!status)
        status = glint_check_whole("difference", (double)desc->difference, 0, (double)desc->cell_count, error);
    if (!status && desc->difference)
        status = glint_check_range("gain", desc->gain, 1e-3, 1e6, "number 0.001 .. 1000000", error);
    if (!status)
        status = glint_check_range("dpi", desc->dpi, 0, 1e6, "number 0 .. 1000000", error);
    if (!status)
        status = glint_check_range("size", desc->size, 0, 10000, "points 0 .. 10000", error);
    return status || !desc->colorbar ? status : check_bar(desc->colorbar, error);
}

static glint_status check_sides(const layout *l, glint_error *error)
{
    const long long width = l->sheet_width, height = l->sheet_height;
    if (width > GLINT_SIDE_MAX || height > GLINT_SIDE_MAX)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "sheet: sides of at most %d pixels expected, got %lldx%lld; use other columns or smaller "
                          "pictures",
                          GLINT_SIDE_MAX, width, height);
    if (width * height > AREA_MAX)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "sheet: at most %lld pixels expected, got %lldx%lld; use smaller or fewer pictures",
                          (long long)AREA_MAX, width, height);
    return GLINT_OK;
}

glint_status glint_sheet_write(const glint_sheet_desc *desc, const char *path, glint_error *error)
{
    GLINT_REFUSE_NULL(desc, error);
    GLINT_REFUSE_NULL(path, error);
    glint_picture *first = NULL;
    layout l = { .desc = desc };
    glint_status status = check_desc(desc, path, error);
    if (!status)
        status = glint_picture_read(desc->cells[0].path, false, &first, error);
    if (!status)
        status = glint_ink_open(GLINT_SIDE_MAX, GLINT_SIDE_MAX, &l.ink, error);
    if (!status) {
        l.width = glint_picture_width(first);
        l.height = glint_picture_height(first);
        measure(&l);
        status = check_sides(&l, error);
    }
    if (!status) {
        glint_ink_resize(&l.ink, (int)l.sheet_width, (int)l.sheet_height);
        status = draw_sheet(&l, path, error);
    }
    glint_ink_close(&l.ink);
    glint_picture_destroy(first);
    return status;
}
