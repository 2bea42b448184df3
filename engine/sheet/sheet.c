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
#include "engine/base/status.h"
#include "engine/file/figure.h"
#include "engine/ink/ink.h"
#include "engine/overlay/overlay.h"

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
#define LONGEST_DIFFERENCE "max 255\n0.0123 %"
#define AXIS_BYTES 1000 // longest name of the columns or rows
#define BAR_MOST 20 // longest colour bar if it has no length of its own, in label sizes

/// The sheet's measures, in pixels.
typedef struct layout {
    const glint_sheet_desc *desc;
    int width, height; ///< of each picture
    glint_ink ink; ///< everything except the pixels of pictures. Owned
    glint_typeface typeface, title; ///< typeface of labels; typeface of the title, which is twice as large
    int above, below; ///< extents of a line of labels or heads from its baseline, as large as the largest formula needs
    int title_width, title_height; ///< 0 without a title
    double unit; ///< pixels in a 13th of the label size
    int rows, blocks;
    int column, label; ///< width of a column; height of the label below a picture
    int difference; ///< height of the text below a difference; 0: no differences
    int column_head, row_head, block_head; ///< height of the heads above columns, width of the heads
        ///< next to rows, height of the heads above blocks; 0: none
    int left, top; ///< position of the first picture, without the head of its block
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

static int line_height(const layout *l) { return l->typeface.line + l->above + l->below - l->typeface.height; }

static int text_width(const layout *l, const char *text, size_t size)
{
    glint_line line;
    glint_line_set(&l->typeface, text, size, &line);
    return line.width;
}

/// Extends the height of lines until the parts of a label fit.
static void fit_label(layout *l, const char *label)
{
    glint_line line;
    for (size_t size; label && *label; label += size + (label[size] == '\n')) {
        size = strcspn(label, "\n");
        glint_line_set(&l->typeface, label, size, &line);
        l->above = line.above > l->above ? line.above : l->above;
        l->below = line.below > l->below ? line.below : l->below;
    }
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

/// Returns the width of the widest of `count` texts; NULL: 0.
static int widest_of(const layout *l, const char *const *texts, int count)
{
    int widest = 0;
    for (int i = 0; i < count && texts; i++) {
        const int width = widest_part(l, texts[i]);
        widest = width > widest ? width : widest;
    }
    return widest;
}

static void write_text(layout *l, const glint_typeface *typeface, int x, int y, const char *text, size_t size, glint_turn turn,
                       uint32_t color)
{
    double linear[3];
    glint_line line;
    to_linear(color, linear);
    glint_line_set(typeface, text, size, &line);
    if (typeface == &l->typeface && turn == GLINT_LEVEL) // one baseline for all parts of a line
        y += l->above - line.above;
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
    return across ? (int64_t)l->desc->columns * (l->column + l->gap) - l->gap
                  : (int64_t)l->rows * l->band + (int64_t)l->blocks * l->block_head - l->gap;
}

/// Writes "name ->", the title of columns or rows.
static void write_axis(const char *name, char out[AXIS_BYTES + 8])
{
    snprintf(out, AXIS_BYTES + 8, "%s \xe2\x86\x92", name);
}

/// Returns the width of the title of columns or rows; NULL: 0.
static int axis_width(const layout *l, const char *name)
{
    char text[AXIS_BYTES + 8];
    write_axis(name ? name : "", text);
    return name ? text_width(l, text, SIZE_MAX) : 0;
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
    int64_t least[4] = { 0, 0, l->left + (int64_t)axis_width(l, desc->across) + l->gap,
                         l->left + (int64_t)widest_of(l, desc->block_heads, l->blocks) + l->gap };
    const int64_t least_height = l->top + (int64_t)axis_width(l, desc->down) + l->gap;
    l->sheet_width = (int64_t)l->left + grid_size(l, true) + l->gap;
    l->sheet_height = (int64_t)l->top + grid_size(l, false) + l->gap;
    if (desc->colorbar)
        measure_bar(l);
    if (desc->title)
        least[0] = l->left + (int64_t)l->title_width + l->gap;
    if (desc->difference) {
        snprintf(l->note, sizeof l->note,
                 "below each: |picture - cell %zu| x %g\nmax: the largest difference, of 255\n%%: pixels that differ",
                 desc->difference, desc->gain);
        least[1] = l->left + widest_part(l, l->note) + l->gap;
    }
    for (int i = 0; i < 4; i++)
        l->sheet_width = least[i] > l->sheet_width ? least[i] : l->sheet_width;
    l->sheet_height = least_height > l->sheet_height ? least_height : l->sheet_height;
    if (l->sheet_width <= GLINT_SIDE_MAX)
        l->note_lines = set_label(l, l->note, (int)l->sheet_width - l->left - l->gap, false, 0, 0);
    l->sheet_height += (int64_t)l->note_lines * line_height(l) + (l->note_lines ? l->gap / 2 : 0);
}

/// Measures the title and the height of lines.
static void measure_lines(layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    glint_line line;
    l->above = l->typeface.above;
    l->below = l->typeface.height - l->typeface.above;
    fit_label(l, desc->across);
    fit_label(l, desc->down);
    for (size_t i = 0; i < desc->cell_count; i++)
        fit_label(l, desc->cells[i].label);
    for (int i = 0; i < desc->columns && desc->column_heads; i++)
        fit_label(l, desc->column_heads[i]);
    for (int i = 0; i < l->rows && desc->row_heads; i++)
        fit_label(l, desc->row_heads[i]);
    for (int i = 0; i < l->blocks && desc->block_heads; i++)
        fit_label(l, desc->block_heads[i]);
    if (!desc->title)
        return;
    glint_line_set(&l->title, desc->title, SIZE_MAX, &line);
    l->title_width = line.width;
    l->title_height = l->title.line + line.above + line.below - l->title.height;
}

/// Measures the columns, then the labels and heads, which are broken into lines as wide as a column.
static void measure_labels(layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    const int space = pixels(l, 4);
    int lines = 0, head_lines = 0;
    l->column = widest_of(l, desc->column_heads, desc->columns);
    l->column = l->column > l->width ? l->column : l->width;
    for (size_t i = 0; i < desc->cell_count; i++) {
        const int widest = widest_part(l, desc->cells[i].label);
        l->column = widest > l->column ? widest : l->column;
    }
    for (size_t i = 0; i < desc->cell_count; i++) {
        const int count = set_label(l, desc->cells[i].label, l->column, false, 0, 0);
        lines = count > lines ? count : lines;
    }
    for (int i = 0; i < desc->columns && desc->column_heads; i++) {
        const int count = set_label(l, desc->column_heads[i], l->column, false, 0, 0);
        head_lines = count > head_lines ? count : head_lines;
    }
    l->label = lines * line_height(l) + (lines ? space : 0);
    if (desc->difference) {
        const int count = set_label(l, LONGEST_DIFFERENCE, l->column, false, 0, 0);
        l->difference = (count > lines ? count : lines) * line_height(l) + space;
    }
    l->column_head = head_lines * line_height(l) + (head_lines ? space : 0);
    l->row_head = desc->row_heads ? widest_of(l, desc->row_heads, l->rows) + l->gap / 2 : 0;
    l->block_head = desc->block_heads ? line_height(l) + space : 0;
}

/// Measures a sheet. Its description, the size of a picture and the ink are set.
static void measure(layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    const double size = desc->size > 0 ? desc->size * (desc->dpi > 0 ? desc->dpi / 72 : 1)
                                       : SIZE * (l->width >= LARGE_PICTURE ? 2 : 1);
    l->unit = (size < GLINT_SIDE_MAX / 2 ? size : GLINT_SIDE_MAX / 2) / SIZE;
    l->typeface = glint_typeface_open(l->ink.letters, SIZE * l->unit);
    l->title = glint_typeface_open(l->ink.letters, 2 * SIZE * l->unit);
    l->gap = pixels(l, 12);
    l->rows = (int)((desc->cell_count + (size_t)desc->columns - 1) / (size_t)desc->columns);
    l->blocks = desc->block_heads ? (l->rows + desc->block_rows - 1) / desc->block_rows : 0;
    measure_lines(l);
    measure_labels(l);
    l->left = l->gap + (desc->down ? line_height(l) + l->gap / 2 : 0) + l->row_head;
    l->top = l->gap + (desc->title ? l->title_height + l->gap : 0) + (desc->across ? line_height(l) + l->gap / 2 : 0) +
            l->column_head;
    l->band = l->height + l->label + l->gap + (desc->difference ? l->height + l->difference + l->gap : 0);
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
    *y = l->top + row * l->band + (l->block_head ? (row / l->desc->block_rows + 1) * l->block_head : 0);
}

/// Draws |a - b| times the gain below picture `a`, with a text. Both pictures are on the canvas already.
static void draw_difference(layout *l, canvas *paper, size_t a, size_t b)
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

/// Draws the heads above columns and blocks, and next to rows.
static void draw_heads(layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    const int columns = desc->column_heads ? desc->columns : 0;
    int x, y;
    for (int i = 0; i < columns; i++) {
        const int lines = set_label(l, desc->column_heads[i], l->column, false, 0, 0);
        set_label(l, desc->column_heads[i], l->column, true, l->left + i * (l->column + l->gap),
                  l->top - pixels(l, 4) - lines * line_height(l));
    }
    for (int row = 0; row < l->rows; row++) {
        place_cell(l, (size_t)row * (size_t)desc->columns, &x, &y);
        if (desc->row_heads)
            write_text(l, &l->typeface, l->left - l->gap / 2 - text_width(l, desc->row_heads[row], SIZE_MAX),
                       y + (l->height - line_height(l)) / 2, desc->row_heads[row], SIZE_MAX, GLINT_LEVEL, TEXT_COLOR);
        if (desc->block_heads && row % desc->block_rows == 0)
            write_text(l, &l->typeface, l->left, y - l->block_head, desc->block_heads[row / desc->block_rows],
                       SIZE_MAX, GLINT_LEVEL, TEXT_COLOR);
    }
}

/// Draws the sheet's title, then "name ->" centred above the columns, and centred next to the rows.
static void draw_titles(layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    char text[AXIS_BYTES + 8];
    if (desc->title)
        write_text(l, &l->title, l->left, l->gap, desc->title, SIZE_MAX, GLINT_LEVEL, TEXT_COLOR);
    if (desc->across) {
        const int space = (int)grid_size(l, true) - axis_width(l, desc->across);
        write_axis(desc->across, text);
        write_text(l, &l->typeface, l->left + (space > 0 ? space / 2 : 0),
                   l->top - l->column_head - line_height(l) - l->gap / 2, text, SIZE_MAX, GLINT_LEVEL, FAINT_COLOR);
    }
    if (desc->down) {
        const int space = (int)grid_size(l, false) - axis_width(l, desc->down);
        write_axis(desc->down, text);
        write_text(l, &l->typeface, l->gap, l->top + (space > 0 ? space / 2 : 0), text, SIZE_MAX, GLINT_DOWN, FAINT_COLOR);
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

/// Writes the pictures with the ink over them.
static glint_status write_sheet(const layout *l, const canvas *paper, const char *path, glint_error *error)
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

static glint_status check_axis(const char *name, const char *text, glint_error *error)
{
    if (!text || strlen(text) <= AXIS_BYTES)
        return text ? glint_line_check(name, text, error) : GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "%s: a name of at most %d bytes expected, got '%.40s...'", name, AXIS_BYTES,
                      text);
}

/// Checks the formulas of a text. NULL: no text.
static glint_status check_text(const char *kind, size_t number, const char *text, glint_error *error)
{
    char name[64];
    snprintf(name, sizeof name, "%s %zu", kind, number);
    return text ? glint_line_check(name, text, error) : GLINT_OK;
}

/// Checks the formulas of `count` heads. NULL: no heads.
static glint_status check_heads(const char *kind, const char *const *heads, size_t count, glint_error *error)
{
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < count && heads && !status; i++)
        status = check_text(kind, i + 1, heads[i], error);
    return status;
}

/// Checks the formulas of all texts of a sheet. `across` and `down` are checked already.
static glint_status check_texts(const glint_sheet_desc *desc, glint_error *error)
{
    const size_t columns = (size_t)desc->columns, rows = (desc->cell_count + columns - 1) / columns;
    const size_t block_rows = desc->block_heads ? (size_t)desc->block_rows : 1;
    glint_status status = desc->title ? glint_line_check("title", desc->title, error) : GLINT_OK;
    for (size_t i = 0; i < desc->cell_count && !status; i++)
        status = check_text("label of cell", i + 1, desc->cells[i].label, error);
    if (!status)
        status = check_heads("head of column", desc->column_heads, columns, error);
    if (!status)
        status = check_heads("head of row", desc->row_heads, rows, error);
    return status ? status : check_heads("head of block", desc->block_heads, (rows + block_rows - 1) / block_rows, error);
}

static glint_status check_desc(const glint_sheet_desc *desc, const char *path, glint_error *error)
{
    glint_file_kind kind;
    glint_status status = glint_file_kind_of(path, &kind, error);
    if (!status && kind != GLINT_FILE_PNG && !glint_file_is_vector(kind))
        status = glint_fail(error, GLINT_ERR_INVALID, "path: name ending in .png, .svg or .pdf expected, got '%.400s'", path);
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
    if (!status)
        status = check_axis("across", desc->across, error);
    if (!status)
        status = check_axis("down", desc->down, error);
    if (!status && desc->block_heads)
        status = glint_check_whole("block_rows", desc->block_rows, 1, GLINT_SIDE_MAX, error);
    if (!status)
        status = check_texts(desc, error);
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
