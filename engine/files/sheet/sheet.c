/// Contact sheets: finished pictures in rows, each with its label, on white.
///
///     title
///                   across ->
///                 head        head
///           block
///     d    [head] [ picture ] [ picture ]
///     o             label       label
///     w           [difference][difference]    on request
///     n             label       label
///
/// A colour bar for all pictures is at the right, or below.
#include "engine/base/number.h"
#include "engine/base/status.h"
#include "engine/figures/overlay/overlay.h"
#include "engine/files/vector/figure.h"
#include "engine/files/sheet/layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FAINT_COLOR 0x6a6a6a
#define FRAME_COLOR 0xd9594c // of the frame around the chosen cell

/// The pixels of a sheet's pictures, on white or transparent paper.
typedef struct canvas {
    int width, height;
    int channels; ///< 3 or 4
    uint8_t *pixels; ///< channels * width * height values, top row first. Owned
} canvas;

// ---- Drawing ------------------------------------------------------------------------------------------------------

static uint8_t *row_at(canvas *paper, int x, int y)
{
    return paper->pixels + ((size_t)y * (size_t)paper->width + (size_t)x) * (size_t)paper->channels;
}

/// Computes the upper left corner of the picture of cell `i`, from 0.
static void place_cell(const glint_sheet_layout *l, size_t i, int *x, int *y)
{
    int column = (int)(i % (size_t)l->desc->columns), row = (int)(i / (size_t)l->desc->columns);
    *x = l->left + column * (l->column + l->gap) + (l->column - l->width) / 2;
    *y = l->top + row * l->band + (l->block_head ? (row / l->desc->block_rows + 1) * l->block_head : 0);
}

/// Draws |a - b| times the gain below picture `a`, with a text. Both pictures are on the canvas already.
static void draw_difference(glint_sheet_layout *l, canvas *paper, size_t a, size_t b)
{
    int ax, ay, bx, by, most = 0;
    int64_t count = 0;
    char label[96];
    place_cell(l, a, &ax, &ay);
    place_cell(l, b, &bx, &by);
    int y = ay + l->height + l->label + l->gap;
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
        glint_print(label, sizeof label, "max %d\n%.3g %%", most, 100.0 * (double)count / ((double)l->width * l->height));
    glint_sheet_label(l, label, l->column, true, ax - (l->column - l->width) / 2, y + l->height + glint_sheet_pixels(l, 4));
}

/// Draws a frame just outside a picture.
static void draw_frame(glint_sheet_layout *l, int x, int y)
{
    const int t = glint_sheet_pixels(l, 3);
    double color[3];
    glint_sheet_linear(FRAME_COLOR, color);
    glint_ink_fill(&l->ink, x - t, y - t, l->width + 2 * t, t, color, 1);
    glint_ink_fill(&l->ink, x - t, y + l->height, l->width + 2 * t, t, color, 1);
    glint_ink_fill(&l->ink, x - t, y, t, l->height, color, 1);
    glint_ink_fill(&l->ink, x + l->width, y, t, l->height, color, 1);
}

static void draw_differences(glint_sheet_layout *l, canvas *paper)
{
    size_t chosen = l->desc->difference - 1;
    int x, y;
    for (size_t i = 0; i < l->desc->cell_count; i++)
        draw_difference(l, paper, i, chosen);
    place_cell(l, chosen, &x, &y);
    draw_frame(l, x, y);
    y = (int)l->sheet_height - l->note_lines * glint_sheet_line(l) - l->gap / 2;
    glint_sheet_label(l, l->note, (int)l->sheet_width - l->left - l->gap, true, l->left, y);
}

/// Draws the colour bar in the middle of the grid's right side, or below the grid.
static void draw_bar(glint_sheet_layout *l)
{
    const bool across = l->bar.orientation == GLINT_ORIENTATION_HORIZONTAL;
    const int space = (int)glint_sheet_grid(l, across) - l->bar_size[across ? 0 : 1], shift = space > 0 ? space / 2 : 0;
    const int beyond = (int)glint_sheet_grid(l, !across) + l->gap;
    glint_colorbar_draw_alone(&l->bar, &l->ink, l->left + (across ? shift : beyond), l->top + (across ? beyond : shift));
}

/// Draws the heads above columns and blocks, and next to rows.
static void draw_heads(glint_sheet_layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    const int columns = desc->column_heads ? desc->columns : 0;
    int x, y;
    for (int i = 0; i < columns; i++) {
        const int lines = glint_sheet_label(l, desc->column_heads[i], l->column, false, 0, 0);
        glint_sheet_label(l, desc->column_heads[i], l->column, true, l->left + i * (l->column + l->gap),
                  l->top - glint_sheet_pixels(l, 4) - lines * glint_sheet_line(l));
    }
    for (int row = 0; row < l->rows; row++) {
        place_cell(l, (size_t)row * (size_t)desc->columns, &x, &y);
        if (desc->row_heads)
            glint_sheet_text(l, &l->typeface, l->left - l->gap / 2 - glint_sheet_text_width(l, desc->row_heads[row], SIZE_MAX),
                       y + (l->height - glint_sheet_line(l)) / 2, desc->row_heads[row], SIZE_MAX, GLINT_LEVEL, GLINT_SHEET_INK);
        if (desc->block_heads && row % desc->block_rows == 0)
            glint_sheet_text(l, &l->typeface, l->left, y - l->block_head, desc->block_heads[row / desc->block_rows],
                       SIZE_MAX, GLINT_LEVEL, GLINT_SHEET_INK);
    }
}

/// Draws the sheet's title, then "name ->" centred above the columns, and centred next to the rows.
static void draw_titles(glint_sheet_layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    char text[GLINT_SHEET_AXIS_BYTES + 8];
    if (desc->title)
        glint_sheet_text(l, &l->title, l->left, l->gap, desc->title, SIZE_MAX, GLINT_LEVEL, GLINT_SHEET_INK);
    if (desc->across) {
        const int space = (int)glint_sheet_grid(l, true) - glint_sheet_axis_width(l, desc->across);
        glint_sheet_axis(desc->across, text);
        glint_sheet_text(l, &l->typeface, l->left + (space > 0 ? space / 2 : 0),
                   l->top - l->column_head - glint_sheet_line(l) - l->gap / 2, text, SIZE_MAX, GLINT_LEVEL, FAINT_COLOR);
    }
    if (desc->down) {
        const int space = (int)glint_sheet_grid(l, false) - glint_sheet_axis_width(l, desc->down);
        glint_sheet_axis(desc->down, text);
        glint_sheet_text(l, &l->typeface, l->gap, l->top + (space > 0 ? space / 2 : 0), text, SIZE_MAX, GLINT_DOWN, FAINT_COLOR);
    }
}

static glint_status check_size(const glint_sheet_layout *l, const glint_picture *picture, const char *path, glint_error *error)
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

static glint_status draw_cell(glint_sheet_layout *l, canvas *paper, size_t i, glint_error *error)
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
    glint_sheet_label(l, cell->label, l->column, true, x - (l->column - l->width) / 2, y + l->height + glint_sheet_pixels(l, 4));
    return status;
}

static const void *row_of_canvas(const void *user, int y, void *scratch)
{
    const canvas *paper = user;
    (void)scratch;
    return paper->pixels + (size_t)y * (size_t)paper->width * (size_t)paper->channels;
}

/// Writes the pictures with the ink over them.
static glint_status write_sheet(const glint_sheet_layout *l, const canvas *paper, const char *path, glint_error *error)
{
    glint_text text = { "Software", "glint " GLINT_VERSION };
    glint_png_source source = { .width = paper->width, .height = paper->height, .row = row_of_canvas, .user = paper };
    const glint_figure figure = { .source = &source, .ink = &l->ink };
    const glint_png_desc png = { .encode = GLINT_ENCODE_SMALL, .text = &text, .text_count = 1, .dpi = l->desc->dpi };
    source.tone = glint_tone_desc_default();
    source.alpha = paper->channels == 4;
    return glint_figure_write(&figure, path, &png, error);
}

/// Fills the paper with white; with alpha, with transparency. False: out of memory.
static bool make_paper(const glint_sheet_layout *l, canvas *out)
{
    const bool alpha = l->desc->transparent;
    const int channels = alpha ? 4 : 3;
    const size_t size = (size_t)l->sheet_width * (size_t)l->sheet_height * (size_t)channels;
    *out = (canvas) { (int)l->sheet_width, (int)l->sheet_height, channels, malloc(size) };
    if (out->pixels)
        memset(out->pixels, alpha ? 0 : 255, size);
    return out->pixels != NULL;
}

static glint_status draw_sheet(glint_sheet_layout *l, const char *path, glint_error *error)
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
    draw_heads(l);
    if (l->desc->colorbar)
        draw_bar(l);
    if (!status)
        status = glint_ink_check(&l->ink, error);
    if (!status)
        status = write_sheet(l, &paper, path, error);
    free(paper.pixels);
    return status;
}

glint_status glint_sheet_write(const glint_sheet_desc *given, const char *path, glint_error *error)
{
    GLINT_REFUSE_NULL(path, error);
    GLINT_TAKE_DESC(glint_sheet_desc, { 0 });
    glint_picture *first = NULL;
    glint_sheet_layout l = { .desc = desc };
    status = glint_sheet_check(desc, path, error);
    if (!status)
        status = glint_picture_read(desc->cells[0].path, false, &first, error);
    if (!status)
        status = glint_ink_open(GLINT_SIDE_MAX, GLINT_SIDE_MAX, &l.ink, error);
    if (!status) {
        l.width = glint_picture_width(first);
        l.height = glint_picture_height(first);
        glint_sheet_measure(&l);
        status = glint_sheet_check_sides(&l, error);
    }
    if (!status) {
        glint_ink_resize(&l.ink, (int)l.sheet_width, (int)l.sheet_height);
        status = draw_sheet(&l, path, error);
    }
    glint_ink_close(&l.ink);
    glint_picture_destroy(first);
    return status;
}
