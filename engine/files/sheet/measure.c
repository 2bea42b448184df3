/// The measures and the texts of a contact sheet.
#include "engine/files/sheet/layout.h"
#include "engine/glint_math.h"

#include "engine/figures/overlay/overlay.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define LARGE_PICTURE 900 // labels of pictures at least this wide are twice as large; pixels
#define PART_GAP 2 // gap between parts of a label on the same line, in letters
#define LETTER 8 // width of a letter in 13ths of its size
#define SIZE 13 // size of labels in pixels, unless the sheet sets it
#define LONGEST_DIFFERENCE "max 255\n0.0123 %"
#define BAR_MOST 20 // longest colour bar if it has no length of its own, in label sizes

void glint_sheet_linear(uint32_t color, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = glint_srgb_decode((color >> (16 - 8 * c) & 255) / 255.0);
}

// ---- Texts -------------------------------------------------------------------------------------------------------

int glint_sheet_pixels(const glint_sheet_layout *l, double units) { return (int)(units * l->unit + 0.5); }

int glint_sheet_line(const glint_sheet_layout *l) { return l->typeface.line + l->above + l->below - l->typeface.height; }

int glint_sheet_text_width(const glint_sheet_layout *l, const char *text, size_t size)
{
    glint_line line;
    glint_line_set(&l->typeface, text, size, &line);
    return line.width;
}

/// Extends the height of lines until the parts of a label fit.
static void fit_label(glint_sheet_layout *l, const char *label)
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
static int widest_part(const glint_sheet_layout *l, const char *label)
{
    int widest = 0;
    while (label && *label) {
        size_t size = strcspn(label, "\n");
        int width = glint_sheet_text_width(l, label, size);
        widest = width > widest ? width : widest;
        label += size + (label[size] == '\n');
    }
    return widest;
}

/// Returns the width of the widest of `count` texts; NULL: 0.
static int widest_of(const glint_sheet_layout *l, const char *const *texts, int count)
{
    int widest = 0;
    for (int i = 0; i < count && texts; i++) {
        const int width = widest_part(l, texts[i]);
        widest = width > widest ? width : widest;
    }
    return widest;
}

void glint_sheet_text(glint_sheet_layout *l, const glint_typeface *typeface, int x, int y, const char *text, size_t size, glint_turn turn,
                       uint32_t color)
{
    double linear[3];
    glint_line line;
    glint_sheet_linear(color, linear);
    glint_line_set(typeface, text, size, &line);
    if (typeface == &l->typeface && turn == GLINT_LEVEL) // one baseline for all parts of a line
        y += l->above - line.above;
    glint_ink_text(&l->ink, typeface, text, size, x, y, turn, linear);
}

int glint_sheet_label(glint_sheet_layout *l, const char *label, int space, bool draws, int x, int y)
{
    int lines = 0;
    while (label && *label) {
        const char *part = label;
        int width = 0, gap = glint_sheet_pixels(l, PART_GAP * LETTER);
        while (*part) { // counts the parts of this line
            size_t size = strcspn(part, "\n");
            int wider = (part > label ? width + gap : 0) + glint_sheet_text_width(l, part, size);
            if (part > label && wider > space)
                break;
            width = wider;
            part += size + (part[size] == '\n');
        }
        for (int at = x + (space - width) / 2; label < part;) {
            size_t size = strcspn(label, "\n");
            if (draws)
                glint_sheet_text(l, &l->typeface, at, y + lines * glint_sheet_line(l), label, size, GLINT_LEVEL, GLINT_SHEET_INK);
            at += glint_sheet_text_width(l, label, size) + gap;
            label += size + (label[size] == '\n');
        }
        lines++;
    }
    return lines;
}

// ---- Measuring ----------------------------------------------------------------------------------------------------

int64_t glint_sheet_grid(const glint_sheet_layout *l, bool across)
{
    return across ? (int64_t)l->desc->columns * (l->column + l->gap) - l->gap
                  : (int64_t)l->rows * l->band + (int64_t)l->blocks * l->block_head - l->gap;
}

/// Writes "name ->", the title of columns or rows.
void glint_sheet_axis(const char *name, char out[GLINT_SHEET_AXIS_BYTES + 8])
{
    snprintf(out, GLINT_SHEET_AXIS_BYTES + 8, "%s \xe2\x86\x92", name);
}

/// Returns the width of the title of columns or rows; NULL: 0.
int glint_sheet_axis_width(const glint_sheet_layout *l, const char *name)
{
    char text[GLINT_SHEET_AXIS_BYTES + 8];
    glint_sheet_axis(name ? name : "", text);
    return name ? glint_sheet_text_width(l, text, SIZE_MAX) : 0;
}

/// Lays out the colour bar, and reserves its space next to the grid, which is measured already.
static void measure_bar(glint_sheet_layout *l)
{
    const double size = SIZE * l->unit, dpi = l->desc->dpi;
    const bool across = l->desc->colorbar->orientation == GLINT_ORIENTATION_HORIZONTAL;
    l->bar = *l->desc->colorbar;
    l->bar.length = l->bar.has_length ? l->bar.length * (dpi > 0 ? dpi / 72 : 1) : fmin((double)glint_sheet_grid(l, across), BAR_MOST * size);
    l->bar.size = size;
    l->bar.has_length = l->bar.has_size = true;
    glint_sheet_linear(GLINT_SHEET_INK, l->bar.color);
    glint_colorbar_measure_alone(&l->bar, &l->ink, l->bar_size);
    const int64_t least[2] = { l->left + (int64_t)l->bar_size[0] + l->gap, l->top + (int64_t)l->bar_size[1] + l->gap };
    l->sheet_width += across ? 0 : l->bar_size[0] + l->gap;
    l->sheet_height += across ? l->bar_size[1] + l->gap : 0;
    l->sheet_width = least[0] > l->sheet_width ? least[0] : l->sheet_width;
    l->sheet_height = least[1] > l->sheet_height ? least[1] : l->sheet_height;
}

/// Computes the size of the whole sheet: the grid and everything around it.
static void measure_sheet(glint_sheet_layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    int64_t least[4] = { 0, 0, l->left + (int64_t)glint_sheet_axis_width(l, desc->across) + l->gap,
                         l->left + (int64_t)widest_of(l, desc->block_heads, l->blocks) + l->gap };
    const int64_t least_height = l->top + (int64_t)glint_sheet_axis_width(l, desc->down) + l->gap;
    l->sheet_width = (int64_t)l->left + glint_sheet_grid(l, true) + l->gap;
    l->sheet_height = (int64_t)l->top + glint_sheet_grid(l, false) + l->gap;
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
        l->note_lines = glint_sheet_label(l, l->note, (int)l->sheet_width - l->left - l->gap, false, 0, 0);
    l->sheet_height += (int64_t)l->note_lines * glint_sheet_line(l) + (l->note_lines ? l->gap / 2 : 0);
}

/// Measures the title and the height of lines.
static void measure_lines(glint_sheet_layout *l)
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
static void measure_labels(glint_sheet_layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    const int space = glint_sheet_pixels(l, 4);
    int lines = 0, head_lines = 0;
    l->column = widest_of(l, desc->column_heads, desc->columns);
    l->column = l->column > l->width ? l->column : l->width;
    for (size_t i = 0; i < desc->cell_count; i++) {
        const int widest = widest_part(l, desc->cells[i].label);
        l->column = widest > l->column ? widest : l->column;
    }
    for (size_t i = 0; i < desc->cell_count; i++) {
        const int count = glint_sheet_label(l, desc->cells[i].label, l->column, false, 0, 0);
        lines = count > lines ? count : lines;
    }
    for (int i = 0; i < desc->columns && desc->column_heads; i++) {
        const int count = glint_sheet_label(l, desc->column_heads[i], l->column, false, 0, 0);
        head_lines = count > head_lines ? count : head_lines;
    }
    l->label = lines * glint_sheet_line(l) + (lines ? space : 0);
    if (desc->difference) {
        const int count = glint_sheet_label(l, LONGEST_DIFFERENCE, l->column, false, 0, 0);
        l->difference = (count > lines ? count : lines) * glint_sheet_line(l) + space;
    }
    l->column_head = head_lines * glint_sheet_line(l) + (head_lines ? space : 0);
    l->row_head = desc->row_heads ? widest_of(l, desc->row_heads, l->rows) + l->gap / 2 : 0;
    l->block_head = desc->block_heads ? glint_sheet_line(l) + space : 0;
}

/// Measures a sheet. Its description, the size of a picture and the ink are set.
void glint_sheet_measure(glint_sheet_layout *l)
{
    const glint_sheet_desc *desc = l->desc;
    const double size = desc->size > 0 ? desc->size * (desc->dpi > 0 ? desc->dpi / 72 : 1)
                                       : SIZE * (l->width >= LARGE_PICTURE ? 2 : 1);
    l->unit = (size < GLINT_SIDE_MAX / 2 ? size : GLINT_SIDE_MAX / 2) / SIZE;
    l->typeface = glint_typeface_open(l->ink.letters, SIZE * l->unit);
    l->title = glint_typeface_open(l->ink.letters, 2 * SIZE * l->unit);
    l->gap = glint_sheet_pixels(l, 12);
    l->rows = (int)((desc->cell_count + (size_t)desc->columns - 1) / (size_t)desc->columns);
    l->blocks = desc->block_heads ? (l->rows + desc->block_rows - 1) / desc->block_rows : 0;
    measure_lines(l);
    measure_labels(l);
    l->left = l->gap + (desc->down ? glint_sheet_line(l) + l->gap / 2 : 0) + l->row_head;
    l->top = l->gap + (desc->title ? l->title_height + l->gap : 0) + (desc->across ? glint_sheet_line(l) + l->gap / 2 : 0) +
            l->column_head;
    l->band = l->height + l->label + l->gap + (desc->difference ? l->height + l->difference + l->gap : 0);
    measure_sheet(l);
}
