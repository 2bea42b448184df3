/// Arrows, lines, arcs, polylines and labels at points of the world.
#include "engine/figures/overlay/pointer.h"

#include "engine/base/vec.h"
#include "engine/figures/overlay/layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NEAREST 1e-6 ///< smallest depth that is drawn, as a fraction of the greatest depth of the curve
#define LINE 0.125 ///< default width of a line, in font sizes
#define HEAD_LENGTH 6.0 ///< length of an arrow's head, in widths of its line
#define HEAD_HALF 2.0 ///< half of the head's width, in widths of its line
#define DOT 3.0 ///< size of a dot, in widths of its line
#define DASH 3.0 ///< length of a dash, in widths of its line
#define PERIOD 7.0 ///< distance from the start of a dash to the start of the next, in widths of its line
#define RADIUS_SHARE 12.0 ///< the default radius of an arc is the picture's height divided by this
#define SPACE 0.3 ///< distance between a text and what it must not cover, in font sizes
#define FAR 1e6 ///< limit of the coordinates of a text's corner, pixels
#define RINGS 12 ///< distances at which a text looks for a free position, one font size apart

static double length_of(double x, double y) { return sqrt(x * x + y * y); }

// ---- Curves ----

/// Cuts the line from `from` to `from` + `offset` at the sides of a rectangle. Returns false if it lies outside.
/// range  in: start and end of the part to cut, 0 .. 1 along the line; out: start and end of the part inside.
static bool cut_to_rect(const double from[2], const double offset[2], const double low[2], const double high[2],
                        double range[2])
{
    for (int c = 0; c < 2; c++) {
        if (offset[c] == 0 && (from[c] < low[c] || from[c] > high[c]))
            return false;
        if (offset[c] == 0)
            continue;
        const double a = (low[c] - from[c]) / offset[c], b = (high[c] - from[c]) / offset[c];
        range[0] = fmax(range[0], fmin(a, b));
        range[1] = fmin(range[1], fmax(a, b));
    }
    return range[0] <= range[1];
}

/// Computes the pixels and depths of the points from `first` on. Returns false if one is behind the camera.
static bool project(const glint_overlays *overlays, glint_pointer *p, int first)
{
    double farthest = 0;
    bool there = true;
    for (int i = first; i < p->count; i++) {
        p->depth[i] = glint_cover_project(&overlays->camera, p->world[i], p->pixel[i]);
        farthest = fmax(farthest, p->depth[i]);
    }
    const double least = overlays->camera.orthographic ? 0 : NEAREST * farthest;
    for (int i = first; i < p->count; i++)
        there = there && farthest > 0 && p->depth[i] >= least && isfinite(p->pixel[i][0]) && isfinite(p->pixel[i][1]);
    return there;
}

/// If one end of the piece from point `first` is behind the camera, moves this end to the point where the piece comes
/// in front of the camera.
static void cut_to_camera(const glint_overlays *overlays, glint_pointer *p, int first, bool behind[2])
{
    double ends[2][3];
    const double *depth = p->depth + first;
    memcpy(ends, p->world[first], sizeof ends);
    const double least = overlays->camera.orthographic ? 0 : NEAREST * (1 + 1e-9) * fmax(depth[0], depth[1]);
    for (int i = 0; i < 2; i++) {
        behind[i] = !(depth[i] > 0);
        if (depth[i] >= least)
            continue;
        const double share = (least - depth[i]) / (depth[1 - i] - depth[i]);
        for (int c = 0; c < 3; c++)
            p->world[first + i][c] = ends[i][c] + share * (ends[1 - i][c] - ends[i][c]);
    }
}

bool glint_pointer_is_point(const glint_overlay_desc *desc)
{
    return desc->from[0] == desc->to[0] && desc->from[1] == desc->to[1] && desc->from[2] == desc->to[2];
}

/// Cuts piece `i` of a curve at a rectangle a little larger than the picture. Returns false if it lies outside.
/// range  in: start and end of the part to cut, 0 .. 1 along the piece; out: start and end of the part inside.
static bool cut_piece(const glint_overlays *overlays, const glint_pointer *p, int i, double range[2])
{
    const double sides[2] = { overlays->width, overlays->height }, margin = fmax(sides[0], sides[1]) / 4;
    const double low[2] = { -margin, -margin }, high[2] = { sides[0] + margin, sides[1] + margin };
    const double offset[2] = { p->pixel[i + 1][0] - p->pixel[i][0], p->pixel[i + 1][1] - p->pixel[i][1] };
    return cut_to_rect(p->pixel[i], offset, low, high, range);
}

static double piece_length(const glint_pointer *p, int i)
{
    const double *from = p->pixel[i], *to = p->pixel[i + 1];
    return length_of(to[0] - from[0], to[1] - from[1]);
}

double glint_pointer_piece(const glint_overlays *overlays, const glint_pointer *p, int i, double range[2])
{
    double share[2] = { fmax(p->range[0] - i, 0), fmin(p->range[1] - i, 1) };
    const bool inside = !p->starts[i + 1] && cut_piece(overlays, p, i, share);
    range[0] = i + share[0];
    range[1] = i + share[1];
    return inside ? (share[1] - share[0]) * piece_length(p, i) : -1;
}

static void find_line(const glint_overlays *overlays, const glint_overlay_desc *desc, glint_pointer *p)
{
    p->count = 2;
    vec_copy(p->world[0], desc->from);
    vec_copy(p->world[1], desc->to);
    if (!project(overlays, p, 0)) {
        cut_to_camera(overlays, p, 0, p->behind);
        if ((p->behind[0] && p->behind[1]) || !project(overlays, p, 0)) {
            p->count = 0;
            return;
        }
    }
    p->range[1] = 1;
    if (glint_pointer_is_point(desc) || !cut_piece(overlays, p, 0, p->range))
        p->count = 0;
}

/// Returns the unit direction halfway between two unit directions. If they are opposite, returns a direction
/// perpendicular to them and to the view, so that the arc faces the camera.
static void halve(const glint_overlays *overlays, const double a[3], const double b[3], double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a[c] + b[c];
    if (vec_dot(out, out) < 1e-18)
        vec_cross(out, a, overlays->view[2]);
    if (vec_dot(out, out) < 1e-18)
        vec_copy(out, overlays->view[1]);
    vec_normalize(out, out);
}

static void find_arc(const glint_overlays *overlays, const glint_overlay_desc *desc, glint_pointer *p)
{
    const glint_cover_camera *camera = &overlays->camera;
    const int last = GLINT_ARC_POINTS - 1;
    double middle[2];
    const double depth =
        glint_cover_project(camera, desc->point, middle) * !camera->orthographic + camera->orthographic;
    const double pixel = 2 * sqrt(vec_dot(camera->view[1], camera->view[1])) * depth;
    const double radius = desc->has_radius ? desc->radius : overlays->height / RADIUS_SHARE * pixel;
    vec_normalize(p->world[0], desc->from);
    vec_normalize(p->world[last], desc->to);
    for (int step = last; step > 1; step /= 2)
        for (int i = 0; i < last; i += step)
            halve(overlays, p->world[i], p->world[i + step], p->world[i + step / 2]);
    for (int i = 0; i <= last; i++)
        for (int c = 0; c < 3; c++)
            p->world[i][c] = desc->point[c] + radius * p->world[i][c];
    p->count = GLINT_ARC_POINTS;
    p->behind[0] = p->behind[1] = !(depth > 0) || !project(overlays, p, 0);
    p->count = p->behind[0] ? 0 : p->count;
    p->range[1] = last;
}

/// Adds piece `i` of a polyline, from its point i - 1 to its point i, or the part of it in front of the camera. joins:
/// the last point added is the start of the piece. Returns whether the whole piece is in front.
static bool add_piece(const glint_overlays *overlays, const glint_overlay_desc *desc, size_t i, bool joins, glint_pointer *p)
{
    const int first = p->count;
    bool behind[2] = { false, false };
    p->count = first + 2;
    vec_copy(p->world[first], desc->points[i - 1]);
    vec_copy(p->world[first + 1], desc->points[i]);
    const bool whole = project(overlays, p, first);
    if (whole && joins) {
        vec_copy(p->world[first], desc->points[i]);
        memcpy(p->pixel[first], p->pixel[first + 1], sizeof *p->pixel);
        p->depth[first] = p->depth[first + 1];
        p->count = first + 1;
    } else {
        p->starts[first] = true;
    }
    if (!whole) {
        cut_to_camera(overlays, p, first, behind);
        p->behind[behind[0] ? 0 : 1] = true;
        if ((behind[0] && behind[1]) || !project(overlays, p, first))
            p->count = first;
    }
    if (p->count > first)
        p->marked[p->count - 1] = desc->point_flags[i] & GLINT_POINT_MARKED && !behind[1];
    return whole;
}

static void find_polyline(const glint_overlays *overlays, const glint_overlay_desc *desc, glint_pointer *p)
{
    bool joins = false;
    p->count = 0;
    for (size_t i = 1; i < desc->point_count; i++)
        joins = !(desc->point_flags[i] & GLINT_POINT_BEGINS) && add_piece(overlays, desc, i, joins, p);
    p->range[1] = fmax(p->count - 1, 0);
}

void glint_pointer_find(const glint_overlays *overlays, const glint_overlay_desc *desc, glint_pointer *out)
{
    *out = (glint_pointer) { .count = 1 };
    if (desc->kind == GLINT_OVERLAY_ARC) {
        find_arc(overlays, desc, out);
    } else if (desc->kind == GLINT_OVERLAY_LABEL) {
        vec_copy(out->world[0], desc->point);
        out->behind[0] = out->behind[1] = !project(overlays, out, 0);
        out->count = !out->behind[0];
    } else if (desc->kind >= GLINT_OVERLAY_POLYLINE) {
        find_polyline(overlays, desc, out);
    } else {
        find_line(overlays, desc, out);
    }
}

/// Returns the index of the curve's point before a parameter, and the share of the step to the next point.
static int piece_at(const glint_pointer *p, double at, double *share)
{
    const int i = (int)fmin(fmax(at, 0), p->count - 2);
    *share = at - i;
    return i;
}

void glint_pointer_at(const glint_pointer *p, bool orthographic, double at, double world[3])
{
    double share;
    if (p->count == 1) {
        vec_copy(world, p->world[0]);
        return;
    }
    const int i = piece_at(p, at, &share);
    if (!orthographic) // even steps in the picture are not even in the world
        share = share * p->depth[i] / (share * p->depth[i] + (1 - share) * p->depth[i + 1]);
    for (int c = 0; c < 3; c++)
        world[c] = p->world[i][c] + share * (p->world[i + 1][c] - p->world[i][c]);
}

void glint_pointer_pixel(const glint_pointer *p, double at, double pixel[2])
{
    double share;
    const int i = piece_at(p, at, &share);
    for (int c = 0; c < 2; c++)
        pixel[c] = p->pixel[i][c] + share * (p->pixel[i + 1][c] - p->pixel[i][c]);
}

// ---- Drawing ----

static void add_part(glint_strokes *strokes, const glint_pointer *p, double first, double last)
{
    double from[2], to[2];
    glint_pointer_pixel(p, first, from);
    for (double next = floor(first) + 1; first < last; next++) {
        const bool is_gap = p->starts[(int)next];
        first = fmin(next, last);
        glint_pointer_pixel(p, first, to);
        if (!is_gap)
            glint_strokes_add(strokes, from, to);
        memcpy(from, to, sizeof from);
    }
}

/// Returns the parameter at a distance, in pixels along the curve, from a parameter.
static double advance(const glint_pointer *p, double at, double distance)
{
    double share;
    int i = piece_at(p, at, &share);
    for (; i < p->count - 2; i++, at = i) {
        const double rest = p->starts[i + 1] ? 0 : (i + 1 - at) * piece_length(p, i);
        if (distance <= rest)
            break;
        distance -= rest;
    }
    return at + distance / piece_length(p, i);
}

/// Adds the dashes of a hidden part of the curve, or nothing if hidden parts are not drawn.
static void add_hidden(glint_strokes *strokes, const glint_layout *layout, const glint_pointer *p, const double part[2],
                       double last)
{
    const double end = fmin(part[1], last), width = 2 * strokes->half, period = PERIOD * width;
    if (layout->desc->hidden == GLINT_HIDDEN_NONE)
        return;
    double at = advance(p, part[0], period - DASH * width);
    for (double next; at < end && (next = advance(p, at, period)) > at; at = next)
        add_part(strokes, p, at, fmin(advance(p, at, DASH * width), end));
}

/// Adds the strokes of the curve up to a parameter.
static void add_curve(glint_strokes *strokes, const glint_layout *layout, const glint_pointer *p, double last)
{
    double at = p->range[0];
    for (size_t i = 0; layout->hidden && i < layout->hidden->count; i++) {
        const double *part = layout->hidden->of[i];
        add_part(strokes, p, at, fmin(part[0], last));
        add_hidden(strokes, layout, p, part, last);
        at = part[1];
    }
    add_part(strokes, p, at, last);
}

static bool is_hidden(const glint_layout *layout, double at)
{
    bool is = false;
    for (size_t i = 0; layout->hidden && i < layout->hidden->count; i++)
        is = is || (at >= layout->hidden->of[i][0] && at <= layout->hidden->of[i][1]);
    return is;
}

/// Adds the head of an arrow whose tip is in the picture. Returns the parameter at which the line ends.
static double add_head(glint_strokes *strokes, const glint_layout *layout, const glint_pointer *p)
{
    const double *tip = p->pixel[1], whole[2] = { tip[0] - p->pixel[0][0], tip[1] - p->pixel[0][1] };
    const double length = length_of(whole[0], whole[1]), size = fmin(HEAD_LENGTH * 2 * strokes->half, length);
    const bool shown = layout->desc->hidden != GLINT_HIDDEN_NONE || !is_hidden(layout, 1);
    if (p->range[1] < 1 || p->behind[1] || !shown || !(length > 0))
        return p->range[1];
    const double offset[2] = { whole[0] / length, whole[1] / length }, half = size * HEAD_HALF / HEAD_LENGTH;
    for (int c = 0; c < 2; c++) {
        const double across = c ? offset[0] : -offset[1], base = tip[c] - size * offset[c];
        strokes->head[0][c] = tip[c];
        strokes->head[1][c] = base + half * across;
        strokes->head[2][c] = base - half * across;
    }
    strokes->has_head = true;
    return fmin(fmax(1 - (size - strokes->half) / length, p->range[0]), p->range[1]);
}

/// Draws the dots of a polyline, except those that are hidden and left out.
static void draw_marks(const glint_layout *layout, const glint_pointer *p, double half)
{
    glint_strokes dots = { .half = DOT * half };
    for (int i = 0; i < p->count; i++)
        if (p->marked[i] && !(layout->desc->hidden == GLINT_HIDDEN_NONE && is_hidden(layout, i)))
            glint_strokes_add(&dots, p->pixel[i], p->pixel[i]);
    glint_layout_strokes(layout, &dots, layout->desc->color);
    free(dots.of);
}

void glint_pointer_draw(const glint_layout *layout, double dpi)
{
    const glint_overlay_desc *desc = layout->desc;
    const glint_pointer *p = &layout->place->pointer;
    const double width = desc->has_width ? glint_layout_pixels(desc->width, dpi) : LINE * layout->em;
    glint_strokes strokes = { .half = fmax(width / 2, 0.5) };
    if (p->count < 2)
        return;
    const double last = desc->kind == GLINT_OVERLAY_ARROW ? add_head(&strokes, layout, p) : p->range[1];
    add_curve(&strokes, layout, p, last);
    glint_layout_strokes(layout, &strokes, desc->color);
    free(strokes.of);
    if (desc->kind >= GLINT_OVERLAY_POLYLINE)
        draw_marks(layout, p, strokes.half);
}

// ---- Texts ----

/// Returns the parameter of the curve's point that the text is next to: the tip of an arrow, the start of a path, the
/// eye of a frustum, the middle of other curves.
static double anchor_at(const glint_overlay_desc *desc, const glint_pointer *p)
{
    if (desc->kind >= GLINT_OVERLAY_PATH)
        return 0;
    if (desc->kind >= GLINT_OVERLAY_POLYLINE)
        return p->count / 2;
    return desc->kind == GLINT_OVERLAY_ARROW ? 1 : (p->range[0] + p->range[1]) / 2;
}

bool glint_pointer_shows_text(const glint_layout *layout)
{
    const glint_overlay_desc *desc = layout->desc;
    const glint_pointer *p = &layout->place->pointer;
    const bool is_cut = desc->kind == GLINT_OVERLAY_ARROW && p->behind[1];
    const bool hides = desc->hidden == GLINT_HIDDEN_NONE;
    return p->count && !is_cut && desc->text[0] && !(hides && is_hidden(layout, anchor_at(desc, p)));
}

/// Finds the point that a text is next to, and the direction from this point in which the text is tried first: the
/// direction of an arrow, above a line, outside an arc, away from the first point of a polyline or a lobe, away from the
/// other points of a path or a frustum, above and to the right of a point.
static void find_anchor(const glint_layout *layout, double anchor[2], double out[2])
{
    const glint_overlay_desc *desc = layout->desc;
    const glint_pointer *p = &layout->place->pointer;
    if (p->count == 1) {
        memcpy(anchor, p->pixel[0], sizeof p->pixel[0]);
    } else {
        glint_pointer_pixel(p, anchor_at(desc, p), anchor);
        out[0] = p->pixel[1][0] - p->pixel[0][0];
        out[1] = p->pixel[1][1] - p->pixel[0][1];
    }
    if (desc->kind == GLINT_OVERLAY_LINE) {
        const double turn = out[0] < 0 ? -1 : 1, across = out[0];
        out[0] = turn * out[1];
        out[1] = -turn * across;
    } else if (desc->kind == GLINT_OVERLAY_ARC) {
        double middle[2];
        glint_cover_project(&layout->overlays->camera, desc->point, middle);
        out[0] = anchor[0] - middle[0];
        out[1] = anchor[1] - middle[1];
    } else if (desc->kind >= GLINT_OVERLAY_POLYLINE) {
        const double *from = p->pixel[desc->kind >= GLINT_OVERLAY_PATH];
        out[0] = anchor[0] - from[0];
        out[1] = anchor[1] - from[1];
    }
    const double length = length_of(out[0], out[1]);
    out[0] = length > 0 ? out[0] / length : sqrt(0.5);
    out[1] = length > 0 ? out[1] / length : -sqrt(0.5);
}

/// Returns whether the curve of an overlay crosses a rectangle.
static bool crosses(const glint_pointer *p, const double low[2], const double high[2])
{
    bool does = false;
    for (int i = 0; i + 1 < p->count && !does; i++) {
        if (p->starts[i + 1])
            continue;
        const double offset[2] = { p->pixel[i + 1][0] - p->pixel[i][0], p->pixel[i + 1][1] - p->pixel[i][1] };
        double range[2] = { 0, 1 };
        does = cut_to_rect(p->pixel[i], offset, low, high, range);
    }
    return does;
}

/// Rates a rectangle for a text: 0 if it is not allowed there, 1 if it would cover a line, otherwise 2.
static int rate(const glint_layout *layout, const double corner[2])
{
    const double sides[2] = { layout->overlays->width, layout->overlays->height }, margin = SPACE * layout->em;
    const double low[2] = { corner[0] - margin, corner[1] - margin };
    const double high[2] = { corner[0] + layout->size[0] + margin, corner[1] + layout->size[1] + margin };
    int rating = 2;
    for (int c = 0; c < 2; c++)
        if (corner[c] < 0 || corner[c] + layout->size[c] > sides[c])
            return 0;
    for (size_t i = 0; i < layout->overlays->count; i++) {
        const glint_place *other = &layout->places[i];
        if (other->has_rect && other->low[0] < high[0] && low[0] < other->high[0] && other->low[1] < high[1] &&
            low[1] < other->high[1])
            return 0;
        if (crosses(&other->pointer, low, high))
            rating = 1;
    }
    return rating;
}

/// Tries the eight positions at a distance from the anchor, in pixels. Returns the best rating, and moves the layout to
/// its position if the rating is above `least`.
static int try_ring(glint_layout *layout, const double anchor[2], const double first[2], double distance, int least)
{
    // eighths of a circle, sorted by their angle from the first direction
    static const int turns[8] = { 0, 1, 7, 2, 6, 3, 5, 4 };
    static const double r = 0.70710678118654752;
    static const double cosines[8] = { 1, r, 0, -r, -1, -r, 0, r };
    int best = least;
    for (int i = 0; i < 8 && best < 2; i++) {
        const double c = cosines[turns[i]], s = cosines[(turns[i] + 6) % 8];
        const double out[2] = { c * first[0] - s * first[1], s * first[0] + c * first[1] };
        const double away = distance + (fabs(out[0]) * layout->size[0] + fabs(out[1]) * layout->size[1]) / 2;
        double corner[2];
        for (int k = 0; k < 2; k++)
            corner[k] = floor(fmin(fmax(anchor[k] + away * out[k] - layout->size[k] / 2.0, -FAR), FAR) + 0.5);
        const int rating = rate(layout, corner);
        if (rating <= best)
            continue;
        best = rating;
        layout->corner[0] = (int)corner[0];
        layout->corner[1] = (int)corner[1];
    }
    return best;
}

void glint_pointer_place(glint_layout *layout, double margin)
{
    double anchor[2], first[2] = { 0, 0 };
    if (!layout->place->pointer.count || !layout->desc->text[0])
        return;
    find_anchor(layout, anchor, first);
    int best = try_ring(layout, anchor, first, margin, -1);
    for (int ring = 1; ring < RINGS && best < 1; ring++)
        best = try_ring(layout, anchor, first, margin + ring * layout->em, 0);
}
