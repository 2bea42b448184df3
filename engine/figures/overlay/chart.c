/// A chart: the title, curves over a grid, numbers and names along two axes, and each curve's label at its end.
#include "engine/figures/overlay/layout.h"
#include "engine/figures/overlay/marks.h"
#include "engine/glint_math.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define GAP 0.4 ///< gap between the curves' area and numbers or labels, in font sizes
#define SPACE 0.04 ///< space above and below the curves, as a share of their range
#define GRID 0.15 ///< opacity of the grid
#define WIDTH 0.14 ///< width of a curve that has no width, in font sizes
#define DOT 0.55 ///< diameter of a dot, in font sizes
#define INSIDE 1.25 ///< curves' labels are inside the area if the page enlarges letters by more than this factor
#define FAR 1e3 ///< farthest end of a stroke from the area of the curves, in sizes of the area

/// Colours of curves, 8-bit sRGB: M. Okabe and K. Ito, 2008, without yellow; then brown and violet.
static const uint32_t colors[] = { 0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00, 0x56b4e9, 0x8c564b, 0x6a3d9a };

typedef struct chart {
    const glint_layout *layout;
    glint_scale scales[2]; ///< of x and y
    glint_marks marks[2];
    glint_rect area; ///< the area of the curves
    int gap, line; ///< pixels
    double ends[GLINT_CURVES_MAX]; ///< middle of each curve's label, pixels from the top of the area; NaN: no label
} chart;

// ---- Measuring ----------------------------------------------------------------------------------------------------

/// Returns whether a point is inside the range of the other axis, so that it counts for the range of this one.
static bool counts(const glint_overlay_desc *desc, int other, double value)
{
    return !desc->has_range[other] || (value >= fmin(desc->range[other][0], desc->range[other][1]) &&
                                       value <= fmax(desc->range[other][0], desc->range[other][1]));
}

/// Finds the range of the values on an axis: 0 is x, 1 is y.
static void find_range(const glint_overlay_desc *desc, int axis, double out[2])
{
    const glint_curve *c;
    out[0] = INFINITY;
    out[1] = -INFINITY;
    for (size_t i = 0; (c = glint_chart_curve(desc->chart, i)) != NULL; i++)
        for (size_t k = 0; k < c->count; k++) {
            const double value = axis ? c->y[k] : c->x[k], other = axis ? c->x[k] : c->y[k];
            if (isnan(value) || isnan(other) || !counts(desc, 1 - axis, other))
                continue;
            out[0] = fmin(out[0], value);
            out[1] = fmax(out[1], value);
        }
    if (out[0] > out[1]) { // nothing is in the range of the other axis
        out[0] = desc->is_log_axis[axis];
        out[1] = out[0] + 1;
    }
}

/// Widens a range so that the two ends differ; on the y axis also by a little space. 0 stays the end of a range.
static void widen(double range[2], bool is_log, bool has_space)
{
    const double low = range[0], high = range[1];
    if (is_log) {
        const double factor = low == high ? 2 : has_space ? glint_pow(high, SPACE) / glint_pow(low, SPACE) : 1;
        range[0] = fmax(low / factor, DBL_MIN);
        range[1] = fmin(high * factor, DBL_MAX);
        return;
    }
    const double space = low == high ? fmax(fabs(low) / 2, 0.5) : has_space ? SPACE * high - SPACE * low : 0;
    range[0] = low == 0 && high > 0 ? 0 : low - space;
    range[1] = high == 0 && low < 0 ? 0 : high + space;
}

static glint_scale make_scale(const glint_layout *layout, int axis)
{
    const glint_overlay_desc *desc = layout->desc;
    double range[2];
    if (desc->has_range[axis]) {
        memcpy(range, desc->range[axis], sizeof range);
    } else {
        find_range(desc, axis, range);
        widen(range, desc->is_log_axis[axis], axis == 1);
    }
    return (glint_scale) { range[0], range[1], desc->is_log_axis[axis], axis == 0, 0, layout->em };
}

/// Returns the width of the widest label of a curve.
static int widest_label(const glint_layout *layout)
{
    const glint_curve *c;
    int widest = 0, advance;
    for (size_t i = 0; (c = glint_chart_curve(layout->desc->chart, i)) != NULL; i++) {
        const int width = glint_layout_measure(layout, c->label, &advance);
        widest = width > widest ? width : widest;
    }
    return widest;
}

/// Returns whether the labels of curves are inside the area of the curves. Narrow pages have no space next to it.
static bool has_legend(const glint_layout *layout) { return layout->overlays->enlarged > INSIDE; }

/// Lays out a chart whose upper left corner is x, y. The numbers along y need space that shortens x, and so on; so y is
/// measured first.
static chart make_chart(const glint_layout *layout, int x, int y)
{
    const glint_overlay_desc *desc = layout->desc;
    const glint_typeface *typeface = &layout->typeface;
    chart c = { .layout = layout, .line = (int)fmax(layout->em / 16, 1), .gap = (int)ceil(GAP * layout->em) };
    int advance, names[2]; // distances from a text to the next element
    glint_layout_measure(layout, desc->text, &advance);
    for (int i = 0; i < 2; i++)
        glint_layout_measure(layout, desc->titles[i], &names[i]);
    const int label = has_legend(layout) ? 0 : widest_label(layout), title = advance + (advance ? 2 * c.gap : typeface->height / 2);
    const int bottom = c.gap + typeface->height + (names[0] ? names[0] + c.gap : 0);
    for (int i = 0; i < 2; i++)
        c.scales[i] = make_scale(layout, i);
    c.area.y = y + title;
    c.area.height = layout->height - title - bottom;
    c.scales[1].length = c.area.height > 1 ? c.area.height : 1;
    glint_marks_fit(&c.marks[1], typeface, &c.scales[1]);
    const int left = (names[1] ? names[1] + c.gap : 0) + c.marks[1].widest + c.gap;
    c.area.x = x + left;
    c.area.width = layout->width - left - (label ? label + 2 * c.gap : (int)((has_legend(layout) ? 1 : 2) * layout->em));
    c.scales[0].length = c.area.width > 1 ? c.area.width : 1;
    glint_marks_fit(&c.marks[0], typeface, &c.scales[0]);
    return c;
}

void glint_chart_measure(glint_layout *layout)
{
    const glint_overlay_desc *desc = layout->desc;
    layout->width = (int)layout->extent[0] - (desc->has_extent ? 0 : 2 * layout->padding);
    layout->height = (int)layout->extent[1] - (desc->has_extent ? 0 : 2 * layout->padding);
    const double growth = 1 - 1 / layout->overlays->enlarged;
    if (!desc->has_extent || growth <= 0)
        return;
    // Larger letters take space around the curves. The curves' area keeps its size.
    const chart c = make_chart(layout, 0, 0);
    const double most[2] = { layout->overlays->width - layout->em, layout->overlays->height - layout->em };
    layout->width = (int)fmax(layout->width, fmin(layout->width + growth * (layout->width - c.area.width), most[0]));
    layout->height = (int)fmax(layout->height, fmin(layout->height + growth * (layout->height - c.area.height), most[1]));
}

static bool has_area(const chart *c) { return c->area.width >= c->gap && c->area.height >= c->gap; }

bool glint_chart_fits(const glint_layout *layout)
{
    const chart c = make_chart(layout, 0, 0);
    return has_area(&c);
}

// ---- Drawing ------------------------------------------------------------------------------------------------------

static void curve_color(const glint_curve *curve, size_t i, double out[3])
{
    const uint32_t color = colors[i % (sizeof colors / sizeof *colors)];
    for (int k = 0; k < 3; k++)
        out[k] = curve->has_color ? curve->color[k] : glint_srgb_decode((color >> (16 - 8 * k) & 255) / 255.0);
}

/// Computes the position of a point in the picture. False: the point is a gap.
static bool place(const chart *c, const glint_curve *curve, size_t k, double out[2])
{
    const double share[2] = { glint_scale_share(&c->scales[0], curve->x[k]), 1 - glint_scale_share(&c->scales[1], curve->y[k]) };
    out[0] = c->area.x + fmin(fmax(share[0], -FAR), FAR) * c->area.width;
    out[1] = c->area.y + fmin(fmax(share[1], -FAR), FAR) * c->area.height;
    return !isnan(share[0]) && !isnan(share[1]);
}

static void draw_curve(const chart *c, const glint_curve *curve, size_t i)
{
    const double em = c->layout->em, width = curve->has_width ? glint_layout_pixels(curve->width, c->layout->dpi) : WIDTH * em;
    glint_strokes line = { .half = fmax(width, 1) / 2 }, dots = { .half = fmax(DOT * em, width) / 2 };
    double color[3], from[2], to[2];
    bool has_from = false;
    curve_color(curve, i, color);
    for (size_t k = 0; k < curve->count; k++) {
        const bool has_to = place(c, curve, k, to);
        const bool is_alone = has_to && !has_from && (k + 1 == curve->count || !place(c, curve, k + 1, from));
        if (has_from && has_to && !(curve->has_width && width == 0))
            glint_strokes_add(&line, from, to);
        if (has_to && (curve->has_dots || is_alone))
            glint_strokes_add(&dots, to, to);
        memcpy(from, to, sizeof from);
        has_from = has_to;
    }
    if (line.count || line.lost)
        glint_layout_strokes(c->layout, &line, color);
    if (dots.count || dots.lost)
        glint_layout_strokes(c->layout, &dots, color);
    free(line.of);
    free(dots.of);
}

/// Draws the grid, the numbers and the names of both axes.
static void draw_axes(const chart *c, int x, int y)
{
    const glint_layout *layout = c->layout;
    const glint_overlay_desc *desc = layout->desc;
    const glint_typeface *typeface = &layout->typeface;
    const glint_rect *a = &c->area;
    const int bottom = a->y + a->height;
    for (int i = 0; i < c->marks[0].count; i++) {
        const glint_mark *m = &c->marks[0].of[i];
        const int at = a->x + (int)(m->share * a->width + 0.5);
        glint_layout_fill(layout, at, a->y, c->line, a->height, desc->color, GRID);
        glint_layout_text(layout, m->text, at - m->width / 2, bottom + c->gap, m->width, 0, desc->color);
    }
    for (int i = 0; i < c->marks[1].count; i++) {
        const glint_mark *m = &c->marks[1].of[i];
        const int at = bottom - (int)(m->share * a->height + 0.5);
        glint_layout_fill(layout, a->x, at, a->width, c->line, desc->color, GRID);
        glint_layout_text(layout, m->text, a->x - c->gap - m->width, at - typeface->height / 2, m->width, 0, desc->color);
    }
    glint_layout_fill(layout, a->x, a->y, c->line, a->height, desc->color, 1);
    glint_layout_fill(layout, a->x, bottom, a->width, c->line, desc->color, 1);
    int height, across;
    glint_layout_line_size(layout, desc->titles[0], SIZE_MAX, &height);
    glint_layout_text(layout, desc->titles[0], a->x, y + layout->height - height, a->width, 0.5, desc->color);
    const int length = glint_layout_line_size(layout, desc->titles[1], SIZE_MAX, &across);
    glint_ink_text(layout->ink, typeface, desc->titles[1], SIZE_MAX, x, a->y + (a->height - length) / 2, GLINT_UP, desc->color);
    glint_layout_text(layout, desc->text, a->x, y, a->width, 0.5, desc->color);
}

/// Finds the height of each curve's label: next to the curve's last point, moved so that labels are a line apart.
static void find_ends(chart *c)
{
    const glint_curve *curve;
    size_t order[GLINT_CURVES_MAX] = { 0 }, count = 0;
    const double line = c->layout->typeface.line;
    for (size_t i = 0; (curve = glint_chart_curve(c->layout->desc->chart, i)) != NULL; i++) {
        double at[2] = { 0, 0 };
        size_t k = curve->count;
        while (k > 0 && !place(c, curve, k - 1, at))
            k--;
        c->ends[i] = fmin(fmax(at[1] - c->area.y, 0), c->area.height);
        if (!curve->label[0])
            continue;
        size_t before = count++;
        for (; before > 0 && c->ends[order[before - 1]] > c->ends[i]; before--)
            order[before] = order[before - 1];
        order[before] = i;
    }
    for (size_t i = 1; i < count; i++) // downwards
        c->ends[order[i]] = fmax(c->ends[order[i]], c->ends[order[i - 1]] + line);
    for (size_t i = count; i-- > 0;) { // and upwards again from the bottom
        const double most = i + 1 < count ? c->ends[order[i + 1]] - line : c->area.height;
        c->ends[order[i]] = fmin(c->ends[order[i]], most);
    }
}

/// Stacks the labels of the curves inside the area: at the top or bottom, and at the left, right or middle, where the
/// labels hide the fewest points of curves. Returns the left end of the labels.
static int find_legend(chart *c)
{
    const glint_curve *curve;
    const int wide = widest_label(c->layout), space = c->area.width - wide - 2 * c->gap;
    const int lefts[] = { c->area.x + c->gap + space, c->area.x + c->gap, c->area.x + c->gap + space / 2 };
    double high = 0, at[2];
    size_t hidden[6] = { 0 }, best = 0; // three positions at the top and three at the bottom
    for (size_t i = 0; (curve = glint_chart_curve(c->layout->desc->chart, i)) != NULL; i++) {
        c->ends[i] = curve->label[0] ? high + c->layout->typeface.line / 2.0 : NAN;
        high += curve->label[0] ? c->layout->typeface.line : 0;
    }
    for (size_t i = 0; (curve = glint_chart_curve(c->layout->desc->chart, i)) != NULL; i++)
        for (size_t k = 0; k < curve->count; k++)
            for (int n = 0; n < 6 && place(c, curve, k, at); n++) {
                const double x = at[0] - lefts[n % 3], y = n < 3 ? at[1] - c->area.y : c->area.y + c->area.height - at[1];
                hidden[n] += x > -c->gap && x < wide + c->gap && y < high;
            }
    for (size_t n = 1; n < 6; n++)
        best = hidden[n] < hidden[best] ? n : best;
    for (size_t i = 0; best >= 3 && glint_chart_curve(c->layout->desc->chart, i); i++)
        c->ends[i] += c->area.height - high;
    return lefts[best % 3];
}

void glint_chart_draw(const glint_layout *layout, int x, int y)
{
    const glint_curve *curve;
    chart c = make_chart(layout, x, y);
    if (!has_area(&c))
        return;
    draw_axes(&c, x, y);
    const int labels = has_legend(layout) ? find_legend(&c) : c.area.x + c.area.width + c.gap;
    if (!has_legend(layout))
        find_ends(&c);
    const int over = (int)ceil(DOT * layout->em / 2); // lines and dots on the border are whole
    const glint_rect clip = { c.area.x - over, c.area.y - over, c.area.width + 2 * over, c.area.height + 2 * over };
    glint_ink_clip(layout->ink, &clip);
    for (size_t i = 0; (curve = glint_chart_curve(layout->desc->chart, i)) != NULL; i++)
        draw_curve(&c, curve, i);
    glint_ink_clip(layout->ink, NULL);
    for (size_t i = 0; (curve = glint_chart_curve(layout->desc->chart, i)) != NULL; i++) {
        double color[3];
        int height;
        curve_color(curve, i, color);
        glint_layout_line_size(layout, curve->label, strcspn(curve->label, "\n"), &height);
        if (curve->label[0])
            glint_layout_text(layout, curve->label, labels, c.area.y + (int)c.ends[i] - height / 2, 0, 0, color);
    }
}
