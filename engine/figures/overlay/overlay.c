#include "engine/figures/overlay/overlay.h"

#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/figures/text/font.h"
#include "engine/figures/text/line.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct described {
    glint_overlay base;
    glint_overlay_desc desc;
} described;

#define POINTS_MAX 10000.0
#define DEPTH_MAX 63 ///< largest depth of a path

const char *const glint_overlay_kinds[] = { "label", "colorbar", "axes", "arrow", "line", "arc",
                                           "polyline", "lobe", "path", "frustum", "chart" };

static glint_overlay_desc defaults(glint_overlay_kind kind)
{
    glint_overlay_desc desc = { .kind = kind, .color = { 1, 1, 1 }, .opacity = 1, .high = 1, .names = { "x", "y", "z" },
                                .depth = 4, .aspect = 16.0 / 9 };
    const bool has_directions = kind == GLINT_OVERLAY_ARC || kind == GLINT_OVERLAY_LOBE;
    desc.from[0] = has_directions;
    desc.to[has_directions] = 1;
    if (kind == GLINT_OVERLAY_COLORBAR) {
        desc.at[0] = 1;
        desc.at[1] = 0.5;
    }
    if (kind == GLINT_OVERLAY_AXES)
        desc.at[1] = 1;
    desc.has_background = kind == GLINT_OVERLAY_CHART;
    for (int i = 0; i < 3 && kind == GLINT_OVERLAY_CHART; i++) {
        desc.at[i > 0] = 0.5;
        desc.color[i] = 0.02;
        desc.background[i] = 1;
    }
    return desc;
}

void glint_overlay_desc_init(glint_overlay_desc *desc, size_t size, glint_overlay_kind kind)
{
    const glint_overlay_desc full = defaults(kind);
    glint_desc_write(desc, size, &full, sizeof full);
}

/// Returns whether a letter is written from right to left: Hebrew, Arabic, Syriac, Thaana, N'Ko and related scripts.
static bool runs_left(uint32_t code)
{
    return (code >= 0x590 && code <= 0x8ff) || (code >= 0xfb1d && code <= 0xfdff) || (code >= 0xfe70 && code <= 0xfefc) ||
           (code >= 0x10800 && code <= 0x10fff) || (code >= 0x1e800 && code <= 0x1efff);
}

static glint_status check_text(const char *name, const char *text, size_t size, glint_error *error)
{
    if (memchr(text, '\0', size))
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "%s: at most %zu bytes expected", name, size - 1);
}

/// Checks a text to draw, letter by letter from left to right, and its formulas.
static glint_status check_drawn(const char *name, const char *text, size_t size, glint_error *error)
{
    glint_status status = check_text(name, text, size, error);
    for (const char *at = text, *letter = at; !status && *at; letter = at) {
        const uint32_t code = glint_font_code(&at);
        if (runs_left(code))
            return glint_fail(error, GLINT_ERR_INVALID,
                              "%s: letters that run from left to right expected, got '%.*s' (U+%04X), which runs from right to left",
                              name, (int)(at - letter), letter, (unsigned)code);
    }
    return status ? status : glint_line_check(name, text, error);
}

static glint_status check_position(const glint_overlay_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    for (int i = 0; i < 2 && !status; i++)
        status = glint_check_range("at", desc->at[i], 0, 1, "shares 0 .. 1", error);
    for (int i = 0; i < 2 && !status && desc->has_position; i++)
        status = glint_check_range("position", desc->position[i], -1e6, 1e6, "pixels -1000000 .. 1000000", error);
    if (!status && desc->has_size)
        status = glint_check_range("size", desc->size, 1, POINTS_MAX, "points 1 .. 10000", error);
    if (!status && desc->has_margin)
        status = glint_check_range("margin", desc->margin, 0, POINTS_MAX, "points 0 .. 10000", error);
    if (!status && desc->has_length)
        status = glint_check_range("length", desc->length, 1, POINTS_MAX, "points 1 .. 10000", error);
    return status;
}

static glint_status check_bar(const glint_overlay_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    if ((unsigned)desc->map >= GLINT_COLORMAP_COUNT)
        return glint_fail(error, GLINT_ERR_INVALID, "map: no such colour map");
    if ((unsigned)desc->orientation > GLINT_ORIENTATION_HORIZONTAL)
        return glint_fail(error, GLINT_ERR_INVALID, "orientation: vertical or horizontal expected");
    if (!isfinite(desc->low))
        return glint_fail(error, GLINT_ERR_INVALID, "low: finite number expected, got %g", desc->low);
    if (desc->low == desc->high)
        return glint_fail(error, GLINT_ERR_INVALID, "high: another number than low (%.15g) expected, got %.15g",
                          desc->low, desc->high);
    if (!isfinite(desc->high - desc->low))
        return glint_fail(error, GLINT_ERR_INVALID, "high: number at a finite distance from low (%.15g) expected, got %.15g",
                          desc->low, desc->high);
    if (desc->is_log && !(desc->low > 0 && desc->high > 0))
        return glint_fail(error, GLINT_ERR_INVALID, "low: numbers above 0 at both ends of a logarithmic bar expected, got %.15g and %.15g",
                          desc->low, desc->high);
    if (desc->tick_count > GLINT_OVERLAY_TICKS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "ticks: at most %d numbers expected, got %zu",
                          GLINT_OVERLAY_TICKS_MAX, desc->tick_count);
    const double low = fmin(desc->low, desc->high), high = fmax(desc->low, desc->high);
    for (size_t i = 0; i < desc->tick_count && !status; i++)
        if (!(desc->ticks[i] >= low && desc->ticks[i] <= high))
            status = glint_fail(error, GLINT_ERR_INVALID, "ticks[%zu]: number %.15g .. %.15g expected, got %.15g", i + 1,
                                low, high, desc->ticks[i]);
    return status;
}

/// Refuses fields that axes at a box do not have, because the box determines their position.
static glint_status check_unplaced(const glint_overlay_desc *desc, glint_error *error)
{
    const struct {
        const char *name;
        bool is_set;
    } fields[] = { { "position", desc->has_position },
                   { "margin", desc->has_margin },
                   { "length", desc->has_length },
                   { "background", desc->has_background } };
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (fields[i].is_set)
            return glint_fail(error, GLINT_ERR_INVALID, "%s: only for axes without a box; axes with a box lie along its edges", fields[i].name);
    return GLINT_OK;
}

static glint_status check_span(const char *field, const double from[3], const double to[3], int i, glint_error *error)
{
    if (isfinite(to[i] - from[i]))
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "%s: ends at a finite distance expected, got %.15g to %.15g along %c", field, from[i],
                      to[i], 'x' + i);
}

/// Checks the corner, the sides and the numbers of a cell.
static glint_status check_cell(const glint_overlay_desc *desc, glint_error *error)
{
    static const char *const names[] = { "box.a", "box.b", "box.c" };
    double widest = 0;
    glint_status status = check_unplaced(desc, error);
    if (!status)
        status = glint_check_vector("box.origin", desc->box[0], error);
    for (int i = 0; i < 3 && !status; i++) {
        double across[3];
        status = glint_check_vector(names[i], desc->sides[i], error);
        vec_cross(across, desc->sides[i], desc->sides[(i + 1) % 3]);
        widest = fmax(widest, vec_max_abs(across));
        if (!status && desc->has_values && desc->values[0][i] == desc->values[1][i] && vec_max_abs(desc->sides[i]) > 0)
            status = glint_fail(error, GLINT_ERR_INVALID, "values: two numbers for the ends of %c expected, got %.15g twice", 'a' + i,
                                desc->values[0][i]);
    }
    if (!status && !(widest > 0 && isfinite(widest)))
        status = glint_fail(error, GLINT_ERR_INVALID, "box: expected sides a, b and c that span at least a plane");
    return status;
}

static glint_status check_box(const glint_overlay_desc *desc, glint_error *error)
{
    const double *low = desc->box[0], *high = desc->box[1];
    if (desc->has_sides)
        return check_cell(desc, error);
    glint_status status = check_unplaced(desc, error);
    bool has_side = false;
    if (!status)
        status = glint_check_vector("box[1]", low, error);
    if (!status)
        status = glint_check_vector("box[2]", high, error);
    for (int i = 0; i < 3 && !status; i++) {
        const bool is_side = high[i] > low[i];
        has_side = has_side || is_side;
        status = check_span("box", low, high, i, error);
        if (!status && desc->has_values)
            status = check_span("values", desc->values[0], desc->values[1], i, error);
        if (status)
            break;
        if (high[i] < low[i])
            status = glint_fail(error, GLINT_ERR_INVALID, "box: its lowest and its highest corner expected, got %.15g to %.15g along %c",
                                low[i], high[i], 'x' + i);
        else if (desc->has_values && is_side && desc->values[0][i] == desc->values[1][i])
            status = glint_fail(error, GLINT_ERR_INVALID, "values: two numbers for the ends of %c expected, got %.15g twice", 'x' + i,
                                desc->values[0][i]);
    }
    if (!status && !has_side)
        status = glint_fail(error, GLINT_ERR_INVALID, "box: two corners expected, got one point");
    return status;
}

static glint_status check_radius(const char *name, const glint_overlay_desc *desc, glint_error *error)
{
    if (!desc->has_radius || (desc->radius > 0 && isfinite(desc->radius)))
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "%s: number > 0 expected, got %.15g", name, desc->radius);
}

static glint_status check_line(const glint_overlay_desc *desc, glint_error *error)
{
    glint_status status = glint_check_vector("from", desc->from, error);
    if (!status)
        status = glint_check_vector("to", desc->to, error);
    for (int i = 0; i < 3 && !status; i++)
        status = check_span("to", desc->from, desc->to, i, error);
    return status;
}

static glint_status check_arc(const glint_overlay_desc *desc, glint_error *error)
{
    glint_status status = glint_check_vector("at", desc->point, error);
    if (!status)
        status = glint_check_direction("from", desc->from, error);
    if (!status)
        status = glint_check_direction("to", desc->to, error);
    return status ? status : check_radius("radius", desc, error);
}

static glint_status check_points(const glint_overlay_desc *desc, glint_error *error)
{
    const size_t least = desc->kind == GLINT_OVERLAY_POLYLINE ? 2 : 0;
    glint_status status = GLINT_OK;
    if (desc->point_count < least || desc->point_count > GLINT_OVERLAY_POINTS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "points: %zu .. %d points expected, got %zu", least,
                          GLINT_OVERLAY_POINTS_MAX, desc->point_count);
    for (size_t i = 0; i < desc->point_count && !status; i++) {
        char name[32];
        snprintf(name, sizeof name, "points[%zu]", i + 1);
        status = glint_check_vector(name, desc->points[i], error);
        for (int c = 0; c < 3 && !status && i > 0; c++)
            status = check_span(name, desc->points[i - 1], desc->points[i], c, error);
    }
    return status;
}

/// Checks the fields from which the points of a lobe, a path or a frustum are computed.
static glint_status check_source(const glint_overlay_desc *desc, glint_error *error)
{
    static const char *const radius[] = { "scale", "reach", "distance" };
    glint_status status = check_radius(radius[desc->kind - GLINT_OVERLAY_LOBE], desc, error);
    if (!status && desc->kind == GLINT_OVERLAY_LOBE) {
        status = glint_check_vector("point", desc->point, error);
        if (!status && desc->has_normal)
            status = glint_check_direction("normal", desc->from, error);
        if (!status)
            status = glint_check_direction("to_light", desc->to, error);
    } else if (!status && desc->kind == GLINT_OVERLAY_PATH) {
        status = glint_check_vector("origin", desc->from, error);
        if (!status)
            status = glint_check_direction("direction", desc->to, error);
        if (!status)
            status = glint_check_whole("depth", desc->depth, 0, DEPTH_MAX, error);
    } else if (!status && !(desc->aspect > 0 && isfinite(desc->aspect))) {
        status = glint_fail(error, GLINT_ERR_INVALID, "aspect: number > 0 expected, got %.15g", desc->aspect);
    }
    return status;
}

/// Checks the points and directions of the world that an overlay has.
static glint_status check_pointer(const glint_overlay_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (desc->kind == GLINT_OVERLAY_LABEL) {
        status = glint_check_vector("at_point", desc->point, error);
        if (!status && desc->hidden == GLINT_HIDDEN_DASHED)
            status = glint_fail(error, GLINT_ERR_INVALID, "hidden: drawn or none expected for a label, got dashed");
        return status;
    }
    status = desc->kind == GLINT_OVERLAY_ARC        ? check_arc(desc, error)
             : desc->kind < GLINT_OVERLAY_POLYLINE ? check_line(desc, error)
                                                    : check_points(desc, error);
    if (!status && desc->kind > GLINT_OVERLAY_POLYLINE)
        status = check_source(desc, error);
    if (!status && desc->has_width)
        status = glint_check_range("width", desc->width, 0, POINTS_MAX, "points 0 .. 10000", error);
    if (!status && (unsigned)desc->hidden > GLINT_HIDDEN_NONE)
        status = glint_fail(error, GLINT_ERR_INVALID, "hidden: drawn, dashed or none expected");
    return status;
}

/// Checks that all numbers of an axis of a chart fit its scale. axis: 0 is x, 1 is y.
static glint_status check_axis(const glint_overlay_desc *desc, int axis, glint_error *error)
{
    static const char *const ranges[] = { "x_range", "y_range" };
    const double *range = desc->range[axis];
    const glint_curve *c;
    if (desc->has_range[axis] && !(isfinite(range[1] - range[0]) && range[0] != range[1]))
        return glint_fail(error, GLINT_ERR_INVALID, "%s: two different numbers expected, got %.15g and %.15g", ranges[axis], range[0],
                          range[1]);
    if (!desc->is_log_axis[axis])
        return GLINT_OK;
    if (desc->has_range[axis] && !(range[0] > 0 && range[1] > 0))
        return glint_fail(error, GLINT_ERR_INVALID, "%s: numbers above 0 for a logarithmic axis expected, got %.15g and %.15g",
                          ranges[axis], range[0], range[1]);
    for (size_t i = 0; (c = glint_chart_curve(desc->chart, i)) != NULL; i++)
        for (size_t k = 0; k < c->count; k++)
            if ((axis ? c->y : c->x)[k] <= 0)
                return glint_fail(error, GLINT_ERR_INVALID,
                                  "series[%zu].%c[%zu]: number above 0, or NaN for a gap, for a logarithmic axis expected, got %.15g",
                                  i + 1, 'x' + axis, k + 1, (axis ? c->y : c->x)[k]);
    return GLINT_OK;
}

static glint_status check_chart(const glint_overlay_desc *desc, glint_error *error)
{
    static const char *const names[] = { "x_label", "y_label" };
    const glint_curve *c;
    glint_status status = GLINT_OK;
    if (!desc->chart)
        return glint_fail(error, GLINT_ERR_INVALID, "series: curves expected, got NULL");
    for (int i = 0; i < 2 && !status; i++) {
        status = check_drawn(names[i], desc->titles[i], sizeof desc->titles[i], error);
        if (!status)
            status = check_axis(desc, i, error);
        if (!status && desc->has_extent)
            status = glint_check_range("extent", desc->extent[i], 1, POINTS_MAX, "points 1 .. 10000", error);
    }
    for (size_t i = 0; (c = glint_chart_curve(desc->chart, i)) != NULL && !status; i++) {
        char name[32];
        snprintf(name, sizeof name, "series[%zu].label", i + 1);
        status = check_drawn(name, c->label, GLINT_CHART_TEXT_SIZE, error);
    }
    return status;
}

static glint_status check(const glint_overlay_desc *desc, glint_error *error)
{
    if ((unsigned)desc->kind > GLINT_OVERLAY_CHART)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: no such overlay");
    static const char *const texts[] = { "text", "title", "text", "label", "label", "label", "label", "label", "label", "label", "title" };
    static const char *const names[] = { "labels[1]", "labels[2]", "labels[3]" };
    glint_status status = check_drawn(texts[desc->kind], desc->text, sizeof desc->text, error);
    for (int i = 0; i < 3 && !status; i++)
        status = check_drawn(names[i], desc->names[i], sizeof desc->names[i], error);
    if (!status)
        status = check_text("name", desc->name, sizeof desc->name, error);
    if (!status)
        status = check_position(desc, error);
    if (!status)
        status = glint_check_color("color", desc->color, error);
    if (!status && desc->has_background)
        status = glint_check_color("background", desc->background, error);
    if (!status)
        status = glint_check_range("opacity", desc->opacity, 0, 1, "number 0 .. 1", error);
    if (!status && desc->kind == GLINT_OVERLAY_COLORBAR)
        status = check_bar(desc, error);
    if (!status && desc->kind == GLINT_OVERLAY_AXES && desc->has_values && !desc->has_box)
        status = glint_fail(error, GLINT_ERR_INVALID, "values: expected together with a box, whose corners they "
                                                      "describe");
    if (!status && desc->kind == GLINT_OVERLAY_AXES && desc->has_box)
        status = check_box(desc, error);
    if (!status && desc->kind == GLINT_OVERLAY_CHART)
        status = check_chart(desc, error);
    if (!status && glint_overlay_points(desc))
        status = check_pointer(desc, error);
    return status;
}

glint_status glint_overlay_create(const glint_overlay_desc *given, glint_overlay **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_overlay_desc, defaults(given->kind));
    status = check(desc, error);
    if (status)
        return status;
    described *overlay = malloc(sizeof *overlay);
    if (!overlay)
        return glint_fail_nomem(error);
    *overlay = (described) { .base = { .maker = &glint_overlay_maker, .references = 1 }, .desc = *desc };
    glint_chart_retain(desc->chart);
    *out = &overlay->base;
    return GLINT_OK;
}

glint_status glint_overlay_set(glint_overlay *overlay, const glint_overlay_desc *given, glint_error *error)
{
    GLINT_REFUSE_NULL(overlay, error);
    GLINT_TAKE_DESC(glint_overlay_desc, defaults(given->kind));
    glint_overlay_desc *own = &((described *)overlay)->desc;
    if (desc->kind != own->kind)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: an overlay cannot become one of another kind");
    status = check(desc, error);
    if (status)
        return status;
    glint_chart_retain(desc->chart);
    glint_chart_release(own->chart);
    *own = *desc;
    return GLINT_OK;
}

const glint_overlay_desc *glint_overlay_get(const glint_overlay *overlay)
{
    return overlay ? &((const described *)overlay)->desc : NULL;
}

// ---- What the renderer calls ----

static void destroy(glint_overlay *overlay)
{
    glint_chart_release(((described *)overlay)->desc.chart);
    free(overlay);
}

static const char *kind_of(const glint_overlay *overlay) { return glint_overlay_kinds[glint_overlay_get(overlay)->kind]; }

static const char *name_of(const glint_overlay *overlay) { return glint_overlay_get(overlay)->name; }

const glint_cover_maker glint_overlay_maker = {
    .destroy = destroy, .kind = kind_of, .name = name_of, .take = glint_overlays_take, .hide = glint_overlays_hide,
    .check = glint_overlays_check, .key = glint_overlays_key, .free = glint_overlays_free
};
