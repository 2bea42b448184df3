/// A colour bar: its title above, the bar, and beside or below it the numbers with a mark each.
#include "engine/overlay/layout.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define BAR 0.9 ///< how thick the bar is, in sizes of letters
#define TICK 0.3 ///< how long a mark is, likewise
#define ROOM 0.3 ///< between a mark and its number, likewise
#define WANTED 4 ///< steps between round numbers, at least
#define COLORS 256
#define MARKS_MAX GLINT_OVERLAY_TICKS_MAX

typedef struct mark {
    double share; ///< of the way along the bar
    char text[32];
    int width; ///< of the text, pixels
} mark;

typedef struct bar {
    mark marks[MARKS_MAX];
    int count;
    int widest; ///< of their texts
    int thick, tick, room, line, length; ///< pixels
    int title_width, title_height;
} bar;

/// The largest of 1, 2, 2.5 and 5 times a power of ten that is no larger than `most`, > 0 and finite; *decimals are those that
/// its multiples need.
static double round_step(double most, int *decimals)
{
    static const double steps[] = { 5, 2.5, 2, 1 };
    int exponent = (int)floor(glint_log(most) / 2.302585092994046 + 1e-9), i = 0;
    const double power = glint_pow(10, exponent);
    while (i < 3 && steps[i] * power > most * (1 + 1e-9))
        i++;
    *decimals = (steps[i] == 2.5) - exponent;
    *decimals = *decimals < 0 ? 0 : *decimals;
    return steps[i] * power;
}

static bool is_horizontal(const glint_layout *layout) { return layout->desc->orientation == GLINT_HORIZONTAL; }

static void add_mark(const glint_layout *layout, bar *b, double value, int decimals)
{
    const glint_overlay_desc *desc = layout->desc;
    mark *m = &b->marks[b->count];
    if (b->count == MARKS_MAX)
        return;
    m->share = (value - desc->low) / (desc->high - desc->low);
    value = value == 0 ? 0 : value; // no -0
    if (decimals < 0 || decimals > 6 || fabs(value) >= 1e7)
        snprintf(m->text, sizeof m->text, "%.6g", value);
    else
        snprintf(m->text, sizeof m->text, "%.*f", decimals, value);
    m->width = glint_typeface_width(&layout->typeface, m->text, strlen(m->text));
    b->widest = m->width > b->widest ? m->width : b->widest;
    b->count++;
}

/// Pixels that the numbers need, from the middle of one to the next.
static double pitch(const glint_layout *layout, const bar *b)
{
    return is_horizontal(layout) ? b->widest + layout->em : layout->typeface.height * 1.25;
}

/// Round numbers, as many as there is room for.
static void find_round_marks(const glint_layout *layout, bar *b)
{
    const double low = fmin(layout->desc->low, layout->desc->high), high = fmax(layout->desc->low, layout->desc->high);
    for (double steps = WANTED; steps > 0.5; steps /= 2) {
        int decimals;
        const double step = round_step((high - low) / steps, &decimals);
        b->count = b->widest = 0;
        for (double n = ceil(low / step - 1e-9); n * step <= high + 1e-9 * step && n + 1 > n && b->count < MARKS_MAX; n++)
            add_mark(layout, b, fmin(fmax(n * step, low), high), decimals);
        if (step / (high - low) * layout->length >= pitch(layout, b))
            return;
    }
}

static void find_marks(const glint_layout *layout, bar *b)
{
    const glint_overlay_desc *desc = layout->desc;
    for (size_t i = 0; i < desc->tick_count; i++)
        add_mark(layout, b, desc->ticks[i], -1);
    if (desc->tick_count)
        return;
    if (fabs(desc->high - desc->low) > 1e-290) {
        find_round_marks(layout, b);
    } else { // steps have no powers of ten there
        add_mark(layout, b, desc->low, -1);
        add_mark(layout, b, desc->high, -1);
    }
}

static bar make_bar(const glint_layout *layout)
{
    bar b = { .line = (int)(layout->em / 16) > 1 ? (int)(layout->em / 16) : 1 };
    int lines;
    find_marks(layout, &b);
    b.thick = (int)ceil(BAR * layout->em);
    b.tick = (int)ceil(TICK * layout->em);
    b.room = (int)ceil(ROOM * layout->em);
    b.length = (int)layout->length > 2 ? (int)layout->length : 2;
    b.title_width = glint_layout_measure(layout, layout->desc->text, &lines);
    b.title_height = lines * layout->typeface.line + (lines ? b.room : 0);
    return b;
}

/// How far numbers reach beyond each end of the bar.
static int overhang(const glint_layout *layout, const bar *b)
{
    return (is_horizontal(layout) ? b->widest : layout->typeface.height) / 2;
}

void glint_colorbar_measure(glint_layout *layout)
{
    const bar b = make_bar(layout);
    const int along = b.length + 2 * overhang(layout, &b);
    const int beside = b.thick + (b.count ? b.tick + b.room : 0);
    if (is_horizontal(layout)) {
        layout->width = along;
        layout->height = b.title_height + beside + (b.count ? layout->typeface.height : 0);
    } else {
        layout->width = beside + b.widest;
        layout->height = b.title_height + along;
    }
    layout->width = b.title_width > layout->width ? b.title_width : layout->width;
}

/// The colours, from x, y on: the first at the left or at the bottom.
static void draw_colors(const glint_layout *layout, const bar *b, int x, int y)
{
    const uint32_t *table = glint_colormap_table(layout->desc->map);
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
    for (int i = 0; i < b->count; i++) {
        const mark *m = &b->marks[i];
        const double share = is_horizontal(layout) ? m->share : 1 - m->share;
        const int along = (int)floor(share * b->length + 0.5), line = along - b->line / 2;
        if (is_horizontal(layout)) {
            glint_layout_fill(layout, x + line, y + b->thick, b->line, b->tick, ink, 1);
            glint_layout_text(layout, m->text, x + along - m->width / 2, y + b->thick + b->tick + b->room, m->width, 0, ink);
        } else {
            glint_layout_fill(layout, x + b->thick, y + line, b->tick, b->line, ink, 1);
            glint_layout_text(layout, m->text, x + b->thick + b->tick + b->room, y + along - layout->typeface.height / 2,
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
