/// A colour bar: the title above, the bar, and next to it or below it the numbers with their marks.
#include "engine/figures/overlay/layout.h"
#include "engine/figures/overlay/marks.h"
#include "engine/glint_math.h"

#include <math.h>

#define BAR 0.9 ///< thickness of the bar, in font sizes
#define TICK 0.3 ///< length of a mark, in font sizes
#define GAP 0.3 ///< gap between a mark and its number, in font sizes
#define COLORS 256

typedef struct bar {
    glint_marks marks;
    int thick, tick, gap, line, length; ///< pixels
    int title_width, title_height;
} bar;

static bool is_horizontal(const glint_layout *layout) { return layout->desc->orientation == GLINT_ORIENTATION_HORIZONTAL; }

static void find_marks(const glint_layout *layout, bar *b)
{
    const glint_overlay_desc *desc = layout->desc;
    const glint_scale scale = { desc->low, desc->high, desc->is_log, is_horizontal(layout), layout->length, layout->em };
    if (!desc->tick_count)
        glint_marks_fit(&b->marks, &layout->typeface, &scale);
    for (size_t i = 0; i < desc->tick_count; i++)
        glint_marks_add(&b->marks, &layout->typeface, &scale, desc->ticks[i], -1);
}

static bar make_bar(const glint_layout *layout)
{
    bar b = { .line = (int)(layout->em / 16) > 1 ? (int)(layout->em / 16) : 1 };
    int advance;
    find_marks(layout, &b);
    b.thick = (int)ceil(BAR * layout->em);
    b.tick = (int)ceil(TICK * layout->em);
    b.gap = (int)ceil(GAP * layout->em);
    b.length = (int)layout->length > 2 ? (int)layout->length : 2;
    b.title_width = glint_layout_measure(layout, layout->desc->text, &advance);
    b.title_height = advance + (advance ? b.gap : 0);
    return b;
}

/// Returns how many pixels the numbers extend beyond each end of the bar.
static int overhang(const glint_layout *layout, const bar *b)
{
    return (is_horizontal(layout) ? b->marks.widest : layout->typeface.height) / 2;
}

void glint_colorbar_measure(glint_layout *layout)
{
    const bar b = make_bar(layout);
    const int along = b.length + 2 * overhang(layout, &b);
    const int extent = b.thick + (b.marks.count ? b.tick + b.gap : 0);
    if (is_horizontal(layout)) {
        layout->width = along;
        layout->height = b.title_height + extent + (b.marks.count ? layout->typeface.height : 0);
    } else {
        layout->width = extent + b.marks.widest;
        layout->height = b.title_height + along;
    }
    layout->width = b.title_width > layout->width ? b.title_width : layout->width;
}

/// Draws the colours into a rectangle whose upper left corner is x, y. The first colour is at the left or at the
/// bottom. Each colour reaches a pixel below the next one, so that no seam shows between them where a figure of vectors
/// is drawn at another size.
static void draw_colors(const glint_layout *layout, const bar *b, int x, int y)
{
    const uint32_t *table = layout->desc->has_colors ? layout->desc->colors : glint_colormap_table(layout->desc->map);
    int from = 0;
    for (int i = 0; i < COLORS; i++) {
        const int to = (int)((int64_t)b->length * (i + 1) / COLORS), end = to < b->length && to > from ? to + 1 : to;
        double color[3];
        for (int c = 0; c < 3; c++)
            color[c] = glint_srgb_decode((table[i] >> (16 - 8 * c) & 255) / 255.0);
        if (is_horizontal(layout))
            glint_layout_fill(layout, x + from, y, end - from, b->thick, color, 1);
        else
            glint_layout_fill(layout, x, y + b->length - end, b->thick, end - from, color, 1);
        from = to;
    }
}

static void draw_frame(const glint_layout *layout, const bar *b, int x, int y)
{
    const bool across = is_horizontal(layout);
    const int width = across ? b->length : b->thick, height = across ? b->thick : b->length, t = b->line;
    const double *ink = layout->desc->color;
    glint_layout_fill(layout, x - t, y - t, width + 2 * t, t, ink, 1);
    glint_layout_fill(layout, x - t, y + height, width + 2 * t, t, ink, 1);
    glint_layout_fill(layout, x - t, y, t, height, ink, 1);
    glint_layout_fill(layout, x + width, y, t, height, ink, 1);
}

static void draw_marks(const glint_layout *layout, const bar *b, int x, int y)
{
    const double *ink = layout->desc->color;
    for (int i = 0; i < b->marks.count; i++) {
        const glint_mark *m = &b->marks.of[i];
        const double share = is_horizontal(layout) ? m->share : 1 - m->share;
        const int along = (int)floor(share * b->length + 0.5), line = along - b->line / 2;
        if (is_horizontal(layout)) {
            glint_layout_fill(layout, x + line, y + b->thick, b->line, b->tick, ink, 1);
            glint_layout_text(layout, m->text, x + along - m->width / 2, y + b->thick + b->tick + b->gap, m->width, 0,
                              ink);
        } else {
            glint_layout_fill(layout, x + b->thick, y + line, b->tick, b->line, ink, 1);
            glint_layout_text(layout, m->text, x + b->thick + b->tick + b->gap, y + along - layout->typeface.height / 2,
                              m->width, 0, ink);
        }
    }
}

void glint_colorbar_draw(const glint_layout *layout, int x, int y)
{
    const bar b = make_bar(layout);
    const glint_overlay_desc *desc = layout->desc;
    const int over = overhang(layout, &b);
    glint_layout_text(layout, desc->text, x, y, layout->width, is_horizontal(layout) ? 0.5 : 0, desc->color);
    y += b.title_height;
    if (is_horizontal(layout))
        x += (layout->width - b.length) / 2;
    else
        y += over;
    draw_frame(layout, &b, x, y);
    draw_colors(layout, &b, x, y);
    draw_marks(layout, &b, x, y);
}
