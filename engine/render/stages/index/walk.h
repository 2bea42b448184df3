// walk: finds the boxes of the index that a tile, a shaft or a ray may touch, sixteen at a time. All of this is float
// and conservative: a box is only rejected if it is certainly not touched, including rounding and NaN. Decisions
// about boxes never change a picture.
#ifndef GLINT_INDEX_WALK_H
#define GLINT_INDEX_WALK_H

#include "engine/render/stages/simd/elementary.h"

#define WALK_SLACK 0x1p-21f ///< error bound of a difference, relative to the operands, whose rounding errors are at
    ///< most 2^-24 each
#define WALK_STACK (GLINT_BVH_DEPTH * (GLINT_NODE_WIDTH - 1) + 1)

static inline float larger(float a, float b) { return a > b ? a : b; }
static inline float smaller(float a, float b) { return a < b ? a : b; }

/// Computes the middle and half width of boxes along one axis. The half width includes all rounding errors of `middle
/// - from`.
static inline void box_axis(const glint_node *node, int k, int i, float from, float slack, vf *middle, vf *half)
{
    const vf lower = f_load(node->lower[k] + i), upper = f_load(node->upper[k] + i);
    *middle = f_set(0.5f) * (lower + upper);
    vf reach = upper - *middle;
    *half = reach + (f_set(WALK_SLACK) * ((f_abs(*middle) + reach) + f_set(fabsf(from))) + f_set(slack));
    *middle = *middle - f_set(from);
}

static inline fm box_exists(const glint_node *node, int i)
{
    return f_le(f_load(node->lower[0] + i), f_load(node->upper[0] + i));
}

/// Computes the interval of dot(axis, x) over boxes.
static inline void box_along(const vf middle[3], const vf half[3], const float axis[3], vf *low, vf *high)
{
    vf at = (f_set(axis[0]) * middle[0] + f_set(axis[1]) * middle[1]) + f_set(axis[2]) * middle[2];
    vf reach = (f_set(fabsf(axis[0])) * half[0] + f_set(fabsf(axis[1])) * half[1]) + f_set(fabsf(axis[2])) * half[2];
    *low = at - reach;
    *high = at + reach;
}

/// Returns the slots that hold a primitive.
static inline unsigned prims_of_node(const glint_node *node)
{
    unsigned prims = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF)
        prims |= fm_bits(i_lt(i_load(node->child + i), i_set(0))) << i;
    return prims;
}

// ---- A shaft: all segments from a box of points to a light's box (for a point light, a point), or along one
// direction ----

/// Enlarges a box by the rounding error of its points and by `slack`.
static inline void loosen(float lower[3], float upper[3], float slack)
{
    for (int k = 0; k < 3; k++) {
        const float more = WALK_SLACK * larger(fabsf(lower[k]), fabsf(upper[k])) + slack;
        lower[k] -= more;
        upper[k] += more;
    }
}

/// The bounding box of a light, in the index's frame.
typedef struct light_bounds {
    float lower[3], upper[3]; ///< directional: both are the direction towards the light
    bool directional;
} light_bounds;

typedef struct light_shaft {
    float lower[3], upper[3]; ///< the bounding box of the shaft; infinite where it is unbounded
    int plane_count;
    int axis[6][2]; ///< for each plane, the two axes of the coordinate plane that its normal lies in
    float normal[6][2], bound[6]; ///< points inside the shaft have normal . x <= bound
} light_shaft;

static inline float reach_of(float x, float lower, float upper) { return larger(x * lower, x * upper); }

static inline float largest_of(float lower, float upper) { return larger(fabsf(lower), fabsf(upper)); }

/// Computes the extent of a rectangle along the normal (-ey, ex) of a line through (x, y).
static inline void distances_to_line(int a, int b, float x, float y, float ex, float ey, const float lower[3],
                                    const float upper[3], float *least, float *most)
{
    const float left_x = -ey * (lower[a] - x), right_x = -ey * (upper[a] - x);
    const float left_y = ex * (lower[b] - y), right_y = ex * (upper[b] - y);
    *most = larger(left_x, right_x) + larger(left_y, right_y);
    *least = smaller(left_x, right_x) + smaller(left_y, right_y);
}

/// Adds the plane that, seen in the axes a and b, is the line through (x, y) along (ex, ey), if all points and the
/// light are on one side of the plane. `wide`: whether the light is larger than a point.
static inline void add_shaft_plane(light_shaft *shaft, int a, int b, float x, float y, float ex, float ey,
                                   const float lower[3], const float upper[3], const light_bounds *light, bool wide)
{
    float least, most, light_least = 0, light_most = 0;
    distances_to_line(a, b, x, y, ex, ey, lower, upper, &least, &most);
    if (wide)
        distances_to_line(a, b, x, y, ex, ey, light->lower, light->upper, &light_least, &light_most);
    const bool left = most <= 0 && light_most <= 0;
    if (!(left || (least >= 0 && light_least >= 0)) || shaft->plane_count == 6)
        return;
    const float sign = left ? 1 : -1, nx = -ey * sign, ny = ex * sign;
    const int p = shaft->plane_count++;
    shaft->axis[p][0] = a;
    shaft->axis[p][1] = b;
    shaft->normal[p][0] = nx;
    shaft->normal[p][1] = ny;
    const float size = fabsf(nx) * largest_of(lower[a], upper[a]) + fabsf(ny) * largest_of(lower[b], upper[b]);
    float bound = reach_of(nx, lower[a], upper[a]) + reach_of(ny, lower[b], upper[b]), far = 0;
    if (!light->directional) // the light touches the line only within a rounding error, which grows with the distance
        far = fabsf(nx) * largest_of(light->lower[a], light->upper[a]) +
              fabsf(ny) * largest_of(light->lower[b], light->upper[b]);
    if (wide)
        bound = larger(bound,
                       reach_of(nx, light->lower[a], light->upper[a]) + reach_of(ny, light->lower[b], light->upper[b]));
    shaft->bound[p] = bound + WALK_SLACK * (size + far);
}

/// Adds the planes of one pair of axes: the lines that touch the rectangles of the points and of the light.
static inline void add_shaft_planes(light_shaft *shaft, int a, int b, const float lower[3], const float upper[3],
                                    const light_bounds *light)
{
    const int last_a = light->lower[a] != light->upper[a], last_b = light->lower[b] != light->upper[b];
    for (int corner = 0; corner < 4; corner++) {
        const float x = corner & 1 ? upper[a] : lower[a], y = corner & 2 ? upper[b] : lower[b];
        for (int i = 0; i <= last_a; i++)
            for (int j = 0; j <= last_b; j++) {
                const float lx = i ? light->upper[a] : light->lower[a], ly = j ? light->upper[b] : light->lower[b];
                add_shaft_plane(shaft, a, b, x, y, light->directional ? lx : lx - x, light->directional ? ly : ly - y,
                                lower, upper, light, last_a || last_b);
            }
    }
}

/// Makes a shaft. lower, upper: corners of the points' box, in the index's frame.
static void make_shaft(const float lower[3], const float upper[3], const light_bounds *light, light_shaft *shaft)
{
    shaft->plane_count = 0;
    for (int k = 0; k < 3; k++) {
        const float low = light->lower[k], high = light->upper[k];
        shaft->lower[k] =
            light->directional ? (low < 0 ? -HUGE_VALF : lower[k]) : smaller(lower[k], low - WALK_SLACK * fabsf(low));
        shaft->upper[k] =
            light->directional ? (high > 0 ? HUGE_VALF : upper[k]) : larger(upper[k], high + WALK_SLACK * fabsf(high));
    }
    for (int a = 0; a < 2; a++)
        for (int b = a + 1; b < 3; b++)
            add_shaft_planes(shaft, a, b, lower, upper, light);
}

static unsigned boxes_in_shaft(const glint_node *node, const light_shaft *shaft)
{
    unsigned inside = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        vf middle[3], half[3];
        fm out = f_lt(f_set(1), f_set(0));
        for (int k = 0; k < 3; k++) {
            box_axis(node, k, i, 0, 0, &middle[k], &half[k]);
            out = fm_or(out, fm_or(f_lt(f_set(shaft->upper[k]), middle[k] - half[k]),
                                   f_lt(middle[k] + half[k], f_set(shaft->lower[k]))));
        }
        for (int p = 0; p < shaft->plane_count; p++) {
            const int a = shaft->axis[p][0], b = shaft->axis[p][1];
            const float x = shaft->normal[p][0], y = shaft->normal[p][1];
            vf low =
                (f_set(x) * middle[a] + f_set(y) * middle[b]) - (f_set(fabsf(x)) * half[a] + f_set(fabsf(y)) * half[b]);
            out = fm_or(out, f_lt(f_set(shaft->bound[p]), low));
        }
        inside |= fm_bits(fm_andnot(box_exists(node, i), out)) << i;
    }
    return inside;
}

/// A traversal of the index by a shaft.
typedef struct shaft_walk {
    const glint_node *nodes;
    light_shaft shaft;
    int height;
    uint32_t stack[WALK_STACK];
} shaft_walk;

/// Starts at the root. lower, upper: as for make_shaft.
static void begin_shaft_walk(shaft_walk *walk, const glint_node *nodes, const float lower[3], const float upper[3],
                             const light_bounds *light)
{
    walk->nodes = nodes;
    walk->height = nodes != NULL;
    walk->stack[0] = 0;
    make_shaft(lower, upper, light, &walk->shaft);
}

/// Returns the next node, or NULL at the end. *prims: the slots of the primitives that the shaft may touch.
static const glint_node *next_in_shaft(shaft_walk *walk, unsigned *prims)
{
    if (!walk->height)
        return NULL;
    const glint_node *node = &walk->nodes[walk->stack[--walk->height]];
    const unsigned inside = boxes_in_shaft(node, &walk->shaft);
    *prims = inside & prims_of_node(node);
    for (unsigned bits = inside & ~*prims; bits; bits &= bits - 1)
        walk->stack[walk->height++] = node->child[__builtin_ctz(bits)];
    return node;
}

// ---- One ray ----

typedef struct ray_view {
    float origin[3], slack; ///< in the index's frame
    float inverse[3]; ///< 1 / direction, infinite if a component is 0, because with any finite number the ray would
        ///< drift off its line
} ray_view;

/// Returns the boxes that the ray may enter before `far` (in lengths of the ray's direction), and computes the
/// distance at which the ray enters each box.
static unsigned boxes_on_ray(const glint_node *node, const ray_view *ray, float far, float depth[GLINT_NODE_WIDTH])
{
    unsigned inside = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        vf enter = f_set(0), leave = f_set(far);
        for (int k = 0; k < 3; k++) {
            vf middle, half;
            box_axis(node, k, i, ray->origin[k], ray->slack, &middle, &half);
            vf x = (middle - half) * f_set(ray->inverse[k]), y = (middle + half) * f_set(ray->inverse[k]);
            enter = f_max(f_min(x, y), enter); // NaN, from 0 times infinity, keeps the previous value
            leave = f_min(f_max(x, y), leave);
        }
        f_store(depth + i, enter);
        const fm out = f_lt(leave * f_set(1 + WALK_SLACK), enter);
        inside |= fm_bits(fm_andnot(box_exists(node, i), out)) << i;
    }
    return inside;
}

/// Sorts the slots of `mask` into `order`, nearest first. Returns the number of slots.
static inline int sort_slots(unsigned mask, const float depth[GLINT_NODE_WIDTH], int order[GLINT_NODE_WIDTH])
{
    int count = 0;
    for (; mask; mask &= mask - 1) {
        const int slot = __builtin_ctz(mask);
        int at = count++;
        for (; at > 0 && depth[slot] < depth[order[at - 1]]; at--)
            order[at] = order[at - 1];
        order[at] = slot;
    }
    return count;
}

/// A traversal of the index by one ray.
typedef struct ray_walk {
    const glint_node *nodes;
    ray_view ray;
    int height;
    struct {
        uint32_t node;
        float depth; ///< distance at which the ray enters the node
    } stack[WALK_STACK];
} ray_walk;

/// Starts at the root.
static void begin_ray_walk(ray_walk *walk, const glint_node *nodes)
{
    walk->nodes = nodes;
    walk->height = 1;
    walk->stack[0].node = 0;
    walk->stack[0].depth = 0;
}

/// Returns the nearest node that the ray may enter before `far`, or NULL at the end. *prims: the slots of the
/// primitives whose boxes the ray may enter before `far`.
static const glint_node *next_on_ray(ray_walk *walk, float far, unsigned *prims)
{
    _Alignas(64) float depth[GLINT_NODE_WIDTH];
    int order[GLINT_NODE_WIDTH];
    do {
        if (!walk->height)
            return NULL;
        walk->height--;
    } while (far < walk->stack[walk->height].depth);
    const glint_node *node = &walk->nodes[walk->stack[walk->height].node];
    const unsigned inside = boxes_on_ray(node, &walk->ray, far, depth);
    *prims = inside & prims_of_node(node);
    for (int i = sort_slots(inside & ~*prims, depth, order); i-- > 0; walk->height++) {
        walk->stack[walk->height].node = node->child[order[i]];
        walk->stack[walk->height].depth = depth[order[i]];
    }
    return node;
}

/// Returns whether the call should stop. Long traversals check this from time to time.
static inline bool is_stopped(const atomic_bool *stop)
{
    return stop && atomic_load_explicit(stop, memory_order_relaxed);
}

/// Adds the number of lanes for which a primitive is decided.
static inline void count_tests(uint64_t *tests, unsigned lanes)
{
    if (tests)
        *tests += (unsigned)__builtin_popcount(lanes);
}

// ---- Solids ----

/// Returns whether the solid is only a side, without an inside.
static inline bool is_open(const glint_solid *solid)
{
    return solid->form == GLINT_FORM_TUBE || solid->form == GLINT_FORM_FUNNEL;
}

/// Returns whether a ray that leaves the solid outwards may hit it again, so that the solid casts a shadow on itself.
/// Only a torus does.
static inline bool is_torus(const glint_geometry_table *table, const glint_prim *prim)
{
    return prim->kind == GLINT_PRIM_SOLID && table->solids[prim->item].form == GLINT_FORM_TORUS;
}

#endif
