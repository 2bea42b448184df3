/// A colour bar: the title above, the bar, and next to it or below it the numbers with their marks.
#include "engine/overlay/layout.h"
#include "engine/overlay/marks.h"

#include <math.h>

#define BAR 0.9 ///< thickness of the bar, in font sizes
#define TICK 0.3 ///< length of a mark, in font sizes
#define GAP 0.3 ///< gap between a mark and its number, in font sizes
#define WANTED 4 ///< smallest number of steps between round numbers
#define COLORS 256

typedef struct bar {
    glint_marks marks;
    int thick, tick, gap, line, length; ///< pixels
    int title_width, title_height;
} bar;

static bool is_horizontal(const glint_layout *layout) { return layout->desc->orientation == GLINT_HORIZONTAL; }

/// Returns the smallest distance between the middles of neighbouring numbers, in pixels.
static double pitch(const glint_layout *layout, const bar *b)
{
    return is_horizontal(layout) ? b->marks.widest + layout->em : layout->typeface.height * 1.25;
}

/// Adds a number to the marks if the number lies on the bar.
static void add_mark(const glint_layout *layout, bar *b, double value)
{
    const glint_overlay_desc *desc = layout->desc;
    const int before = b->marks.count;
    glint_marks_add(&b->marks, &layout->typeface, desc->low, desc->high, value, -1);
    if (desc->is_log && b->marks.count > before)
        b->marks.of[before].share = glint_log(value / desc->low) / glint_log(desc->high / desc->low);
}

/// Marks the powers of ten. If there are few of them, also marks two and five times each; if there are many, marks
/// only every second, third and so on; if there are none, marks the ends of the bar.
static void find_powers(const glint_layout *layout, bar *b)
{
    static const double factors[] = { 1, 2, 5 };
    const glint_overlay_desc *desc = layout->desc;
    const double low = fmin(desc->low, desc->high), high = fmax(desc->low, desc->high), ten = glint_log(10);
    const int first = (int)ceil(glint_log(low) / ten - 1e-9), last = (int)floor(glint_log(high) / ten + 1e-9);
    const double decades = glint_log(high / low) / ten;
    const int factor_count = last - first < 2 ? 3 : 1;
    int step = (last - first) / (GLINT_OVERLAY_TICKS_MAX - 1) + 1;
    b->marks.widest = glint_typeface_width(&layout->typeface, "1e+00", 5);
    while (step < last - first && step / decades * layout->length < pitch(layout, b))
        step++;
    b->marks.widest = 0;
    for (int e = first - 1; e <= last; e += factor_count == 3 || e < first ? 1 : step)
        for (int i = 0; i < factor_count; i++) {
            const double value = factors[i] * glint_pow(10, e);
            if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9))
                add_mark(layout, b, value);
        }
    if (b->marks.count)
        return;
    add_mark(layout, b, desc->low);
    add_mark(layout, b, desc->high);
}

static void find_marks(const glint_layout *layout, bar *b)
{
    const glint_overlay_desc *desc = layout->desc;
    double steps = WANTED, share = 1;
    for (size_t i = 0; i < desc->tick_count; i++)
        add_mark(layout, b, desc->ticks[i]);
    if (desc->tick_count)
        return;
    if (desc->is_log) {
        find_powers(layout, b);
        return;
    }
    do {
        share = glint_marks_round(&b->marks, &layout->typeface, desc->low, desc->high, steps);
        steps /= 2;
    } while (share * layout->length < pitch(layout, b) && steps > 0.5);
}

static bar make_bar(const glint_layout *layout)
{
    bar b = { .line = (int)(layout->em / 16) > 1 ? (int)(layout->em / 16) : 1 };
    int lines;
    find_marks(layout, &b);
    b.thick = (int)ceil(BAR * layout->em);
    b.tick = (int)ceil(TICK * layout->em);
    b.gap = (int)ceil(GAP * layout->em);
    b.length = (int)layout->length > 2 ? (int)layout->length : 2;
    b.title_width = glint_layout_measure(layout, layout->desc->text, &lines);
    b.title_height = lines * layout->typeface.line + (lines ? b.gap : 0);
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
/// bottom.
static void draw_colors(const glint_layout *layout, const bar *b, int x, int y)
{
    const uint32_t *table = layout->desc->has_colors ? layout->desc->colors : glint_colormap_table(layout->desc->map);
    int from = 0;
    for (int i = 0; i < COLORS; i++) {
        const int to = (int)((int64_t)b->length * (i + 1) / COLORS);
        double color[3];
        for (int c = 0; c < 3; c++)
            color[c] = glint_srgb_decode((table[i] >> (16 - 8 * c) & 255) / 255.0);
        if (is_horizontal(layout))
            glint_layout_fill(layout, x + from, y, to - from, b->thick, color, 1);
        else
            glint_layout_fill(layout, x, y + b->length - to, b->thick, to - from, color, 1);
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
