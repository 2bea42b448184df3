/// Axes at a box or a cell: for each direction one edge, with marks, numbers and a name.
///
/// An overlay has no depth, so the edge is one on the box's outline in the picture: between a face turned to the eye
/// and one turned away. Nothing inside the box appears beyond this edge, so the axis hides nothing and its numbers are
/// outside.
#include "engine/figures/overlay/layout.h"
#include "engine/figures/overlay/marks.h"

#include "engine/base/vec.h"

#include <math.h>
#include <string.h>

#define LINE 0.08 ///< thickness of an axis's line, in font sizes
#define TICK 0.35 ///< length of a mark, in font sizes
#define GAP 0.35 ///< gap between a mark and its number, and between numbers and the name, in font sizes
#define SHORTEST 1.5 ///< shortest axis that has numbers, in font sizes
#define WANTED 5 ///< smallest number of steps between round numbers, if the numbers fit
#define NEAREST 1e-6 ///< smallest depth drawn, relative to the depth of the box's farthest corner
#define TEXTS_MAX (3 * (GLINT_OVERLAY_TICKS_MAX + 1))

typedef struct rect {
    double low[2], high[2];
} rect;

typedef struct edge {
    double ends[2][3]; ///< in the world
    double shares[2]; ///< the part of the edge in front of the eye: its start and end, 0 .. 1 between `ends`
    double at[2][2]; ///< ends of that part in the picture, pixels
    double out[2]; ///< unit vector in the picture, perpendicular to the edge and away from the box
} edge;

typedef struct box_axes {
    const glint_layout *layout;
    double nearest; ///< smallest depth drawn
    rect texts[TEXTS_MAX]; ///< rectangles of the texts drawn so far
    int count;
} box_axes;

static double depth_of(const box_axes *axes, const double p[3])
{
    double d[3];
    vec_sub(d, p, axes->layout->overlays->camera.eye);
    return vec_dot(d, axes->layout->overlays->camera.view[2]);
}

/// Projects a point to the picture; false: the camera cannot see the point.
static bool project(const box_axes *axes, const double p[3], double out[2])
{
    const double depth = glint_cover_project(&axes->layout->overlays->camera, p, out);
    return depth >= axes->nearest && isfinite(out[0]) && isfinite(out[1]);
}

// ---- The box, or the cell ----

/// Returns a corner of the box. `at` chooses the low (0) or high (1) end of each side.
static void corner_of(const glint_overlay_desc *d, const int at[3], double out[3])
{
    for (int c = 0; c < 3; c++) {
        out[c] = d->box[d->has_sides ? 0 : at[c]][c];
        for (int i = 0; i < 3 && d->has_sides; i++)
            out[c] += at[i] * d->sides[i][c];
    }
}

static double length_of(const glint_overlay_desc *d, int direction)
{
    return d->has_sides ? sqrt(vec_dot(d->sides[direction], d->sides[direction])) : d->box[1][direction] - d->box[0][direction];
}

/// Returns a side of a cell. For a side of length 0, returns a direction perpendicular to the other two sides.
static void side_of(const glint_overlay_desc *d, int i, double out[3])
{
    vec_copy(out, d->sides[i]);
    if (vec_max_abs(out) == 0)
        vec_cross(out, d->sides[(i + 1) % 3], d->sides[(i + 2) % 3]);
}

/// Returns the outward normal of a cell's face at the high end of a side.
static void find_outward(const glint_overlay_desc *d, int direction, double out[3])
{
    double along[3], u[3], v[3];
    side_of(d, direction, along);
    side_of(d, (direction + 1) % 3, u);
    side_of(d, (direction + 2) % 3, v);
    vec_cross(out, u, v);
    vec_normalize(out, out);
    if (vec_dot(out, along) < 0)
        vec_scale(out, out, -1);
}

static bool is_face_seen(const box_axes *axes, int direction, int end)
{
    const glint_cover_camera *c = &axes->layout->overlays->camera;
    const int at[3] = { end * (direction == 0), end * (direction == 1), end * (direction == 2) };
    double out[3], corner[3], eye[3];
    find_outward(axes->layout->desc, direction, out);
    corner_of(axes->layout->desc, at, corner);
    vec_sub(eye, c->eye, corner);
    const double sign = end ? 1 : -1;
    return c->orthographic ? sign * vec_dot(out, c->view[2]) < -1e-9 : sign * vec_dot(out, eye) > 0;
}

/// Returns whether this direction is the most upright one in the picture.
static bool is_upright(const box_axes *axes, int direction)
{
    const glint_overlay_desc *d = axes->layout->desc;
    const double *up = axes->layout->overlays->view[1];
    double most = 0, own = 0;
    if (!d->has_sides)
        return fabs(up[direction]) >= vec_max_abs(up);
    for (int i = 0; i < 3; i++) {
        const double length = length_of(d, i), share = length > 0 ? fabs(vec_dot(up, d->sides[i])) / length : 0;
        most = fmax(most, share);
        own = i == direction ? share : own;
    }
    return own >= most;
}

static void point_at(const edge *e, double share, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = e->ends[0][c] + share * (e->ends[1][c] - e->ends[0][c]);
}

/// Returns whether the face of the box at the low (0) or high (1) end of a direction is turned to the eye.
static bool is_seen(const box_axes *axes, int direction, int end)
{
    const glint_cover_camera *c = &axes->layout->overlays->camera;
    if (axes->layout->desc->has_sides)
        return is_face_seen(axes, direction, end);
    const double out = end ? 1 : -1, position = axes->layout->desc->box[end][direction];
    return c->orthographic ? out * c->view[2][direction] < -1e-9 : out * (c->eye[direction] - position) > 0;
}

/// Clips an edge to the part in front of the eye; false: there is no such part.
static bool cut(const box_axes *axes, edge *e)
{
    const double a = depth_of(axes, e->ends[0]), b = depth_of(axes, e->ends[1]), least = axes->nearest * (1 + 1e-9);
    e->shares[0] = a < least ? (least - a) / (b - a) : 0;
    e->shares[1] = b < least ? (least - a) / (b - a) : 1;
    bool there = a >= least || b >= least;
    for (int i = 0; i < 2 && there; i++) {
        double p[3];
        point_at(e, e->shares[i], p);
        there = project(axes, p, e->at[i]);
    }
    return there;
}

/// Returns how far an edge lies to the side where its axis belongs: to the left for the upright direction, down for
/// the others. A small share of the other coordinate decides between edges that are equally far to that side.
static double reach_of(const box_axes *axes, const edge *e, int direction)
{
    const double left = -(e->at[0][0] + e->at[1][0]), down = e->at[0][1] + e->at[1][1];
    return is_upright(axes, direction) ? left + 1e-3 * down : down + 1e-3 * left;
}

static edge edge_of(const box_axes *axes, int direction, int at_u, int at_v)
{
    edge e = { 0 };
    for (int k = 0; k < 2; k++) {
        int at[3];
        at[direction] = k;
        at[(direction + 1) % 3] = at_u;
        at[(direction + 2) % 3] = at_v;
        corner_of(axes->layout->desc, at, e.ends[k]);
    }
    return e;
}

/// Chooses the edge of a direction for its axis; false: no edge is on the outline of the box.
static bool find_edge(const box_axes *axes, int direction, edge *out)
{
    bool found = false;
    for (int i = 0; i < 4 && length_of(axes->layout->desc, direction) > 0; i++) {
        const int at_u = i & 1, at_v = i >> 1;
        edge e = edge_of(axes, direction, at_u, at_v);
        if (is_seen(axes, (direction + 1) % 3, at_u) == is_seen(axes, (direction + 2) % 3, at_v) || !cut(axes, &e))
            continue;
        if (!found || reach_of(axes, &e, direction) > reach_of(axes, out, direction))
            *out = e;
        found = true;
    }
    return found;
}

/// Finds the direction in the picture that leads away from the box at the edge. False: the edge is too short.
static bool find_side(const box_axes *axes, edge *e)
{
    const glint_overlays *o = axes->layout->overlays;
    const double offset[2] = { e->at[1][0] - e->at[0][0], e->at[1][1] - e->at[0][1] };
    const double length = sqrt(offset[0] * offset[0] + offset[1] * offset[1]);
    double middle[3], low[3], high[3], at[2];
    corner_of(axes->layout->desc, (const int[3]) { 0, 0, 0 }, low);
    corner_of(axes->layout->desc, (const int[3]) { 1, 1, 1 }, high);
    for (int c = 0; c < 3; c++)
        middle[c] = low[c] / 2 + high[c] / 2;
    if (!project(axes, middle, at)) {
        at[0] = o->width / 2.0;
        at[1] = o->height / 2.0;
    }
    e->out[0] = offset[1] / length;
    e->out[1] = -offset[0] / length;
    if (e->out[0] * (at[0] - e->at[0][0]) + e->out[1] * (at[1] - e->at[0][1]) > 0) {
        e->out[0] = -e->out[0];
        e->out[1] = -e->out[1];
    }
    return isfinite(length) && length >= SHORTEST * axes->layout->em;
}

/// Returns the rectangle of a text that begins `away` pixels outside a point of the edge.
static rect place_text(const edge *e, const double at[2], double away, int width, int height)
{
    const double size[2] = { width, height };
    const double far = away + (fabs(e->out[0]) * size[0] + fabs(e->out[1]) * size[1]) / 2;
    rect r;
    for (int i = 0; i < 2; i++) {
        r.low[i] = at[i] + e->out[i] * far - size[i] / 2;
        r.high[i] = r.low[i] + size[i];
    }
    return r;
}

static bool overlap(const rect *a, const rect *b, double gap)
{
    return a->low[0] < b->high[0] + gap && b->low[0] < a->high[0] + gap && a->low[1] < b->high[1] &&
           b->low[1] < a->high[1];
}

/// Draws a text unless it would overlap another one or leave the picture.
static void draw_text(box_axes *axes, const char *text, rect r)
{
    const glint_layout *layout = axes->layout;
    const double gap = GAP * layout->em;
    bool fits = r.high[0] > 0 && r.high[1] > 0 && r.low[0] < layout->overlays->width && r.low[1] < layout->overlays->height;
    for (int i = 0; i < axes->count && fits; i++)
        fits = !overlap(&r, &axes->texts[i], gap);
    if (!fits)
        return;
    axes->texts[axes->count++] = r;
    glint_layout_text(layout, text, (int)floor(r.low[0] + 0.5), (int)floor(r.low[1] + 0.5), 0, 0, layout->desc->color);
}

/// Computes the positions of an edge's numbers in the picture; false: some numbers overlap. A mark behind the eye is
/// NaN.
static bool place_marks(const box_axes *axes, const edge *e, const glint_marks *marks, double at[][2])
{
    const double gap = GAP * axes->layout->em;
    const int height = axes->layout->typeface.height;
    bool clear = true;
    int before = -1;
    for (int i = 0; i < marks->count; i++) {
        double p[3];
        point_at(e, marks->of[i].share, p);
        if (!project(axes, p, at[i])) {
            at[i][0] = NAN;
            continue;
        }
        if (before >= 0) {
            const rect a = place_text(e, at[before], 0, marks->of[before].width, height);
            const rect b = place_text(e, at[i], 0, marks->of[i].width, height);
            clear = clear && !overlap(&a, &b, gap);
        }
        before = i;
    }
    return clear;
}

static void draw_axis(box_axes *axes, int direction, const edge *e)
{
    const glint_layout *layout = axes->layout;
    const glint_overlay_desc *desc = layout->desc;
    const double(*values)[3] = desc->has_values ? desc->values : desc->box;
    const bool is_measured = desc->has_sides && !desc->has_values;
    const double first = is_measured ? 0 : values[0][direction];
    const double last = is_measured ? length_of(desc, direction) : values[1][direction];
    const double half = fmax(LINE * layout->em / 2, 0.5), tick = TICK * layout->em, gap = GAP * layout->em;
    const double offset[2] = { e->at[1][0] - e->at[0][0], e->at[1][1] - e->at[0][1] };
    double at[GLINT_OVERLAY_TICKS_MAX][2], steps = WANTED;
    glint_marks marks = { .count = 0 };
    do {
        glint_marks_round(&marks, &layout->typeface, first, last, steps);
        steps *= 0.8;
    } while (!place_marks(axes, e, &marks, at) && steps > 0.5);
    glint_layout_line(layout, e->at[0], offset, half, desc->color);
    double reach = tick + gap; // distance from the edge to the outer side of the numbers
    for (int i = 0; i < marks.count; i++) {
        const double mark[2] = { e->out[0] * tick, e->out[1] * tick };
        if (isnan(at[i][0]))
            continue;
        glint_layout_line(layout, at[i], mark, half, desc->color);
        draw_text(axes, marks.of[i].text, place_text(e, at[i], tick + gap, marks.of[i].width, layout->typeface.height));
        reach = fmax(reach,
                     tick + 2 * gap + fabs(e->out[0]) * marks.of[i].width + fabs(e->out[1]) * layout->typeface.height);
    }
    const char *name = desc->names[direction];
    const double middle[2] = { (e->at[0][0] + e->at[1][0]) / 2, (e->at[0][1] + e->at[1][1]) / 2 };
    int height;
    const int width = glint_layout_line_size(layout, name, SIZE_MAX, &height);
    draw_text(axes, name, place_text(e, middle, reach, width, height));
}

void glint_box_axes_draw(const glint_layout *layout)
{
    box_axes axes = { .layout = layout };
    double farthest = 0;
    for (int i = 0; i < 8; i++) {
        double corner[3];
        corner_of(layout->desc, (const int[3]) { i & 1, i >> 1 & 1, i >> 2 }, corner);
        farthest = fmax(farthest, depth_of(&axes, corner));
    }
    if (!layout->overlays->camera.orthographic)
        axes.nearest = NEAREST * farthest;
    for (int direction = 0; direction < 3 && farthest > 0; direction++) {
        edge e;
        if (find_edge(&axes, direction, &e) && find_side(&axes, &e))
            draw_axis(&axes, direction, &e);
    }
}
