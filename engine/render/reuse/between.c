/// Tests balls against the volume of a tile's rays (a pyramid or bar), and against all segments from its points to a
/// light: first by one cylinder around the segments, then by slabs around the hull of light and points.
#include "engine/render/reuse/between.h"
#include "engine/base/vec.h"

#include <math.h>

/// Enlarges a ball by a margin far above all rounding.
static double loosened(double radius, double distance) { return radius * (1 + 1e-6) + 1e-6 * distance; }

static double length_of(const double v[3]) { return sqrt(vec_dot(v, v)); }

/// Computes the sides of a tile in half pixels, to the right (x) and up (y) from the point where `forward` is seen.
static void find_edges(const glint_plan *plan, uint32_t column, uint32_t row, double x[2], double y[2])
{
    const double width = plan->desc.width, height = plan->desc.height;
    const double *span = plan->camera.span;
    x[0] = 2.0 * column * GLINT_TILE_WIDTH - span[0];
    x[1] = 2.0 * fmin((column + 1.0) * GLINT_TILE_WIDTH, width) - span[0];
    y[0] = span[1] - 2 * fmin((row + 1.0) * GLINT_TILE_HEIGHT, height);
    y[1] = span[1] - 2.0 * row * GLINT_TILE_HEIGHT;
}

// ---- The volume that a tile shows ----

/// The planes around a tile's rays. A point is inside if inwards[k] . (point - eye) >= -offset[k]; length[k] is the
/// length of inwards[k].
typedef struct sides {
    double inwards[4][3], length[4], offset[4];
} sides;

/// Computes the sides of the pyramid, or of the bar if rays are parallel.
static void find_sides(const glint_plan *plan, uint32_t column, uint32_t row, sides *out)
{
    const glint_plan_camera *camera = &plan->camera;
    double x[2], y[2];
    find_edges(plan, column, row, x, y);
    for (int side = 0; side < 4; side++) {
        const double *across = side < 2 ? camera->right : camera->up, *along = side < 2 ? camera->up : camera->right;
        const double at = side < 2 ? x[side] : y[side - 2];
        double edge[3], normal[3];
        for (int k = 0; k < 3; k++)
            edge[k] = camera->forward[k] + (camera->orthographic ? 0 : at * across[k]);
        vec_cross(normal, edge, along);
        const double sign = (vec_dot(normal, across) < 0) == (side % 2 == 0) ? -1 : 1;
        for (int k = 0; k < 3; k++)
            out->inwards[side][k] = sign * normal[k];
        out->length[side] = length_of(normal);
        out->offset[side] = camera->orthographic ? -at * sign * vec_dot(normal, across) : 0;
    }
}

/// Returns the largest distance between the rays of a lens and the rays of a pinhole near a ball, whose centre is at
/// depth `along`.
static double margin(const glint_plan *plan, double along, double radius)
{
    const glint_plan_camera *camera = &plan->camera;
    if (!plan->lens)
        return 0;
    const double near = fabs(1 - (along - radius) / camera->focus), far = fabs(1 - (along + radius) / camera->focus);
    return camera->aperture * (fmax(near, far) * (1 + 1e-9) + 1e-9);
}

bool glint_may_show(const glint_plan *plan, const glint_ball *balls, uint32_t count, uint32_t column, uint32_t row)
{
    const glint_plan_camera *camera = &plan->camera;
    sides s;
    find_sides(plan, column, row, &s);
    for (uint32_t i = 0; i < count; i++) {
        double offset[3];
        vec_sub(offset, balls[i].center, camera->eye);
        const double own = loosened(balls[i].radius, length_of(offset));
        const double radius = own + margin(plan, vec_dot(offset, camera->forward), own);
        bool outside = false;
        for (int side = 0; side < 4; side++)
            outside = outside || vec_dot(s.inwards[side], offset) + s.offset[side] < -radius * s.length[side];
        if (!outside)
            return true;
    }
    return false;
}

// ---- The volume between points and a light ----

/// The emitting part of a light.
typedef struct source {
    bool directional;
    double to[3]; ///< centre of the light; for a directional light, its direction
    double radius; ///< radius of a ball around the light
} source;

static source source_of(const glint_plan_light *light)
{
    const glint_light_sample *light_sample = light->cap ? light->cap : light->light_samples;
    source s = { .directional = light->directional, .radius = light_sample ? light_sample->radius : 0 };
    vec_copy(s.to, light_sample ? light_sample->center : light->position);
    return s;
}

/// Returns whether a ball's distance from the line between the centres of light and box exceeds the sum of all three
/// radii.
static bool is_far_off(const source *light, const glint_point_box *box, const glint_ball *ball)
{
    double from[3], half[3], line[3], offset[3], across[3];
    for (int k = 0; k < 3; k++) {
        from[k] = 0.5 * box->lower[k] + 0.5 * box->upper[k];
        half[k] = 0.5 * box->upper[k] - 0.5 * box->lower[k];
    }
    const double wide = fmax(light->radius, length_of(half));
    vec_copy(line, light->to);
    if (!light->directional)
        vec_sub(line, light->to, from);
    const double length2 = vec_dot(line, line);
    vec_sub(offset, ball->center, from);
    double along = length2 > 0 ? fmax(vec_dot(offset, line) / length2, 0) : 0;
    along = light->directional ? along : fmin(along, 1);
    for (int k = 0; k < 3; k++)
        across[k] = offset[k] - along * line[k];
    const double far = length_of(offset) + sqrt(length2) + length_of(from);
    return length_of(across) > loosened(ball->radius + wide, far);
}

/// The segments from the eight corners of a body to a light, bounded by slabs: along each of these normals, all
/// segments lie between two heights.
typedef struct slabs {
    int count;
    double origin[3]; ///< origin of the heights: the light's centre or, for parallel light, a corner
    double size; ///< bound of the coordinates, for rounding: the corners' distances from this origin, plus the
        ///< origin's distance from the world's origin
    double normal[18][3], length[18], low[18], high[18];
} slabs;

/// Return the corners of edge 0 .. 11 of a body, whose indices differ in one bit.
static int edge_begin(int edge) { return edge / 4 == 0 ? 2 * (edge % 4) : edge / 4 == 1 ? edge % 2 + edge % 4 / 2 * 4 : edge % 4; }
static int edge_end(int edge) { return edge_begin(edge) + (1 << edge / 4); }

/// Adds a slab. corner: the corners relative to the origin. away: the light is parallel and not perpendicular to the
/// normal, so that the slab is unbounded on one side.
static void add_slab(slabs *s, double (*corner)[3], const source *light, const double normal[3], bool away)
{
    const double length = length_of(normal), ahead = away ? vec_dot(normal, light->to) : 0;
    double low = light->directional ? HUGE_VAL : -light->radius * length;
    double high = -low;
    for (int k = 0; k < 8; k++) {
        low = fmin(low, vec_dot(normal, corner[k]));
        high = fmax(high, vec_dot(normal, corner[k]));
    }
    vec_copy(s->normal[s->count], normal);
    s->length[s->count] = length;
    s->low[s->count] = ahead < 0 ? -HUGE_VAL : low;
    s->high[s->count++] = ahead > 0 ? HUGE_VAL : high;
}

/// Computes the slabs of the body's faces, and the slabs of the planes through one of its edges and the light.
static void find_slabs(slabs *s, double (*corner)[3], const source *light)
{
    s->count = 0;
    vec_copy(s->origin, light->directional ? corner[0] : light->to);
    s->size = 0;
    for (int k = 0; k < 8; k++) {
        vec_sub(corner[k], corner[k], s->origin);
        s->size = fmax(s->size, length_of(corner[k]));
    }
    s->size += length_of(s->origin);
    for (int edge = 0; edge < 12; edge++) {
        const double *from = corner[edge_begin(edge)];
        double along[3], normal[3];
        vec_sub(along, corner[edge_end(edge)], from);
        vec_cross(normal, along, light->directional ? light->to : from);
        add_slab(s, corner, light, normal, false);
    }
    for (int face = 0; face < 6; face++) {
        const int bit = face / 2, first = (face % 2) << bit;
        double a[3], b[3], normal[3];
        vec_sub(a, corner[first + (1 << (bit + 1) % 3)], corner[first]);
        vec_sub(b, corner[first + (1 << (bit + 2) % 3)], corner[first]);
        vec_cross(normal, a, b);
        add_slab(s, corner, light, normal, light->directional);
    }
}

/// Returns whether a ball is outside one slab and therefore clear of all segments. A normal of length 0 excludes
/// nothing.
static bool is_clear_of(const slabs *s, const glint_ball *ball)
{
    double offset[3];
    vec_sub(offset, ball->center, s->origin);
    const double radius = loosened(ball->radius, length_of(offset) + s->size);
    for (int i = 0; i < s->count; i++) {
        const double height = vec_dot(s->normal[i], offset), reach = radius * s->length[i];
        if (height - reach > s->high[i] || height + reach < s->low[i])
            return true;
    }
    return false;
}

static void find_box_corners(const glint_point_box *box, double corner[8][3])
{
    for (int k = 0; k < 8; k++)
        for (int c = 0; c < 3; c++)
            corner[k][c] = (k >> c & 1 ? box->upper : box->lower)[c];
}

/// Computes the corners of the part of a tile's pyramid or bar at the depths of the box. This part is much smaller
/// than the box if the box is deep and oblique to the axes.
static void find_beam_corners(const glint_plan *plan, const glint_point_box *box, uint32_t column, uint32_t row,
                              double corner[8][3])
{
    const glint_plan_camera *camera = &plan->camera;
    double x[2], y[2], depth[2] = { 0, 0 };
    find_edges(plan, column, row, x, y);
    for (int c = 0; c < 3; c++) {
        const double a = camera->forward[c] * (box->lower[c] - camera->eye[c]);
        const double b = camera->forward[c] * (box->upper[c] - camera->eye[c]);
        depth[0] += fmin(a, b);
        depth[1] += fmax(a, b);
    }
    for (int k = 0; k < 8; k++) {
        const double along = camera->orthographic ? depth[k >> 2] : fmax(depth[k >> 2], 0);
        const double wide = camera->orthographic ? 1 : along;
        for (int c = 0; c < 3; c++)
            corner[k][c] = camera->eye[c] + along * camera->forward[c] +
                           wide * (x[k & 1] * camera->right[c] + y[k >> 1 & 1] * camera->up[c]);
    }
}

bool glint_may_shade(const glint_plan *plan, const glint_plan_light *light, const glint_point_box *box,
                     const glint_ball *balls, uint32_t count, uint32_t column, uint32_t row)
{
    const source from = source_of(light);
    const bool has_points = box->lower[0] <= box->upper[0] && box->lower[1] <= box->upper[1] && box->lower[2] <= box->upper[2];
    // the rays of a lens are not limited to the tile's pyramid
    const int bodies = plan->lens || (from.directional && from.radius > 0) ? 1 : 2;
    slabs around[2];
    bool found = false;
    for (uint32_t i = 0; i < count; i++) {
        bool clear = is_far_off(&from, box, &balls[i]);
        if (!clear && has_points && !found) {
            double corner[8][3];
            find_box_corners(box, corner);
            find_slabs(&around[0], corner, &from);
            if (bodies > 1)
                find_beam_corners(plan, box, column, row, corner);
            if (bodies > 1)
                find_slabs(&around[1], corner, &from);
            found = true;
        }
        for (int k = 0; k < bodies && found && !clear; k++)
            clear = is_clear_of(&around[k], &balls[i]);
        if (!clear)
            return true;
    }
    return false;
}
