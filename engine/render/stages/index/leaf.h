// leaf: the triangles of a node as seen from an eye or a light, one per lane: bounds of their screen positions, their
// smallest depth, and their edge functions, which are linear over the screen. Float and conservative, in the frame of
// screen.h.
//
// A ray at position (u, v) is (u, v, 1) in the coordinates (a, b, k) of the screen. It hits a triangle with corners
// P_j there if its dot products with P_1 x P_2, P_2 x P_0 and P_0 x P_1 all have the same sign as the determinant of
// the corners.
#ifndef GLINT_INDEX_LEAF_H
#define GLINT_INDEX_LEAF_H

#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/elementary.h"

/// Relative error bound of a corner's screen position; the bound is twice this if float decides.
#define LEAF_SLACK 0x1p-20f

typedef struct leaf_on_screen {
    /// Input: the coordinates of each corner relative to the view's exact origin, in the index's units.
    _Alignas(64) float corner[3][3][GLINT_NODE_WIDTH];
    /// For each edge: hits have (edge[0] u + edge[1] v) + edge[2] >= 0. Infinite if the orientation of the corners is
    /// uncertain.
    _Alignas(64) float edge[3][3][GLINT_NODE_WIDTH];
    _Alignas(64) float near[GLINT_NODE_WIDTH]; ///< smallest w
    _Alignas(64) float least[2][GLINT_NODE_WIDTH], most[2][GLINT_NODE_WIDTH]; ///< bounds of the screen positions
    unsigned certain, negative; ///< slots with finite edge functions; of these, the slots with a negative determinant
} leaf_on_screen;

/// A vector of VF triangles in the coordinates of the screen.
typedef struct leaf_lanes {
    vf a[3], b[3], w[3], k[3];
    vf lowest, highest; ///< smallest k and largest |k| of the corners
    vf numbers, size; ///< bounds of the sum of the corners' components, and of the triangle's size
} leaf_lanes;

static inline leaf_lanes place_leaf(const leaf_on_screen *leaf, const screen_view *view, int i)
{
    leaf_lanes out = { .numbers = f_set(0), .size = f_set(0) };
    vf x[3][3];
    for (int j = 0; j < 3; j++) {
        for (int c = 0; c < 3; c++)
            x[j][c] = f_load(leaf->corner[j][c] + i);
        vf *const to[3] = { &out.a[j], &out.b[j], &out.w[j] };
        for (int n = 0; n < 3; n++)
            *to[n] = (f_set(view->axis[n][0]) * x[j][0] + f_set(view->axis[n][1]) * x[j][1]) +
                     f_set(view->axis[n][2]) * x[j][2];
        out.k[j] = f_set(view->base) + out.w[j] * f_set(view->inverse);
        out.numbers = f_max(out.numbers, (f_abs(x[j][0]) + f_abs(x[j][1])) + f_abs(x[j][2]));
    }
    for (int c = 0; c < 3; c++)
        out.size = out.size + (f_max(f_max(x[0][c], x[1][c]), x[2][c]) - f_min(f_min(x[0][c], x[1][c]), x[2][c]));
    out.lowest = f_min(f_min(out.k[0], out.k[1]), out.k[2]);
    out.highest = f_max(f_max(f_abs(out.k[0]), f_abs(out.k[1])), f_abs(out.k[2]));
    return out;
}

/// Returns an error bound of corners and rays, as a length perpendicular to the ray at the corners: 5 roundings of a
/// corner along each axis, scaled by the screen's stretch, a few of screen position and k, and the view's own bound.
static inline vf slack_of_leaf(const leaf_lanes *at, const screen_view *view, bool is_float)
{
    const float slack = is_float ? 2 * LEAF_SLACK : LEAF_SLACK;
    return f_set(view->root_stretch) * (f_set(slack) * at->numbers + f_set(view->corner_slack)) +
           f_set(0x1p-21f * view->spread + view->drift) * at->highest;
}

/// Computes bounds of the triangles' screen positions; the box's bounds if a triangle comes too close to the eye.
static inline void bound_leaf(const leaf_lanes *at, vf slack, const screen_view *view, int i, leaf_on_screen *leaf)
{
    const fm ahead = f_lt(f_set(4 * view->inverse) * slack, at->lowest);
    const vf nearest = f_set(1) / at->lowest;
    vf x[3], y[3];
    for (int j = 0; j < 3; j++) {
        const vf per_k = f_set(1) / at->k[j];
        x[j] = at->a[j] * per_k;
        y[j] = at->b[j] * per_k;
    }
    const vf *const place[2] = { x, y };
    for (int n = 0; n < 2; n++) {
        const vf *p = place[n];
        const vf low = f_min(f_min(p[0], p[1]), p[2]), high = f_max(f_max(p[0], p[1]), p[2]);
        const vf more = (slack * nearest) * f_set(2 / view->unit[n]) +
                        (f_set(view->margin) + f_set(0x1p-20f) * (f_abs(low) + f_abs(high)));
        f_store(leaf->least[n] + i, f_select(ahead, low - more, f_set(-HUGE_VALF)));
        f_store(leaf->most[n] + i, f_select(ahead, high + more, f_set(HUGE_VALF)));
    }
}

/// Computes the edge functions relative to a ray near the triangle's middle, which saves digits; x and y are
/// perpendicular to that ray.
///
/// An edge function is the product (x_p y_q - x_q y_p) as seen from the ray it is evaluated for. A ray that hits the
/// triangle is within `wide / 2` of each corner, and each of these distances has an error of at most `off`. The sums
/// below add up to 22 roundings of products of k, position and x, and 12 of x and y. The volume is the sum of the
/// edge functions times k, as seen from the middle.
static inline void edges_of_leaf(const leaf_lanes *at, vf slack, const screen_view *view, int i, leaf_on_screen *leaf)
{
    const vf depth = (at->k[0] + at->k[1]) + at->k[2];
    const vf per_k = f_select(f_lt(f_set(0), depth), f_set(1) / depth, f_set(0));
    const vf sum[2] = { (at->a[0] + at->a[1]) + at->a[2], (at->b[0] + at->b[1]) + at->b[2] };
    vf middle[2], x[3], y[3], n[3][3], most = f_set(0), volume = f_set(0);
    for (int c = 0; c < 2; c++)
        middle[c] = f_min(f_max(sum[c] * per_k, f_set(view->first[c])), f_set(view->last[c]));
    for (int j = 0; j < 3; j++) {
        x[j] = at->a[j] - middle[0] * at->k[j];
        y[j] = at->b[j] - middle[1] * at->k[j];
        most = f_max(most, f_max(f_abs(x[j]) * f_set(view->unit[0]), f_abs(y[j]) * f_set(view->unit[1])));
    }
    for (int j = 0; j < 3; j++) {
        const int p = (j + 1) % 3, q = (j + 2) % 3;
        n[j][0] = at->k[q] * y[p] - at->k[p] * y[q];
        n[j][1] = x[q] * at->k[p] - x[p] * at->k[q];
        n[j][2] = x[p] * y[q] - x[q] * y[p];
        volume = volume + at->k[j] * n[j][2];
        n[j][2] = n[j][2] - (n[j][0] * middle[0] + n[j][1] * middle[1]);
    }
    const vf wide = f_set(2 * view->root_stretch) * at->size, off = slack + f_set(0x1p-22f) * most, most2 = most * most,
             per_area = f_set(1 / view->area);
    const vf sums = f_set(0x1p-19f * view->spread) * (at->highest * most) + f_set(0x1p-20f) * most2;
    const vf doubt = (off * (wide + off) + sums) * per_area + f_set(16 * FLT_MIN);
    const vf turn = off * (f_set(9) * most + f_set(3) * off) + f_set(0x1p-19f) * most2;
    const vf unsure = (at->highest * turn + f_set(2 * view->inverse) * (most2 * off)) * per_area + f_set(16 * FLT_MIN);
    const fm certain = fm_and(f_lt(unsure, f_abs(volume)), f_lt(unsure + doubt, f_set(0x1p100f)));
    const fm negative = fm_and(certain, f_lt(volume, f_set(0)));
    for (int j = 0; j < 3; j++)
        for (int c = 0; c < 3; c++) {
            const vf edge = f_select(negative, -n[j][c], n[j][c]);
            f_store(leaf->edge[j][c] + i,
                    c < 2 ? f_select(certain, edge, f_set(0)) : f_select(certain, edge + doubt, f_set(HUGE_VALF)));
        }
    leaf->certain |= fm_bits(certain) << i;
    leaf->negative |= fm_bits(negative) << i;
}

/// Computes everything that follows from the corners. `near` is the smallest w of the box if rounding may put a hit
/// anywhere on the ray: for a triangle seen edge-on, or if float decides.
static void show_leaf(const screen_view *view, const node_on_screen *seen, bool is_float, leaf_on_screen *leaf)
{
    leaf->certain = leaf->negative = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        const leaf_lanes at = place_leaf(leaf, view, i);
        const vf slack = slack_of_leaf(&at, view, is_float);
        bound_leaf(&at, slack, view, i, leaf);
        edges_of_leaf(&at, slack, view, i, leaf);
        const vf near = f_min(f_min(at.w[0], at.w[1]), at.w[2]) - slack, box = f_load(seen->near + i);
        const fm known = fm_from_bits(is_float ? 0 : leaf->certain >> i & ((1u << VF) - 1));
        f_store(leaf->near + i, f_select(known, f_max(near, box), box));
    }
}

/// Returns the lanes whose rays, at positions u, v, may pass between the edges of the triangle in a slot.
static inline unsigned between_edges(const leaf_on_screen *leaf, int slot, vf u, vf v)
{
    vf e[3];
    for (int j = 0; j < 3; j++)
        e[j] = (f_set(leaf->edge[j][0][slot]) * u + f_set(leaf->edge[j][1][slot]) * v) + f_set(leaf->edge[j][2][slot]);
    return ~fm_bits(f_lt(f_min(f_min(e[0], e[1]), e[2]), f_set(0))) & ((1u << VF) - 1);
}

// ---- Rays that start on a lens ----

/// The triangles of a node. At the depth of corner j, a ray passes at x = a - (u k + l c) from it, and likewise y,
/// where u is the ray's screen position and l its origin on the lens. It hits the triangle if all three x_p y_q - x_q
/// y_p have one sign.
typedef struct leaf_through_lens {
    _Alignas(64) float a[3][GLINT_NODE_WIDTH], b[3][GLINT_NODE_WIDTH], k[3][GLINT_NODE_WIDTH], c[3][GLINT_NODE_WIDTH];
    _Alignas(64) float doubt[GLINT_NODE_WIDTH]; ///< bound of the rounding error of such a difference for rays that hit
        ///< the triangle
} leaf_through_lens;

static inline vf reach_of_three(const vf v[3])
{
    return f_max(f_max(v[0], v[1]), v[2]) - f_min(f_min(v[0], v[1]), v[2]);
}

/// Returns the maximum distance between a corner and a ray that hits the triangle, along axis j; at: the corners'
/// coordinates.
static inline vf width_through_lens(const leaf_lanes *lanes, const vf at[3], const screen_view *view,
                                    const lens_on_screen *lens, int j)
{
    const float place = larger(fabsf(view->first[j]), fabsf(view->last[j])) + 2;
    return reach_of_three(at) + f_set(place) * reach_of_three(lanes->k) +
           f_set(lens->reach[j] * lens->per_focus) * reach_of_three(lanes->w);
}

/// Computes the triangles for rays from a lens. `corners`: as in leaf_on_screen.
static void show_through_lens(const leaf_on_screen *corners, const screen_view *view, const lens_on_screen *lens,
                              bool is_float, leaf_through_lens *out)
{
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        const leaf_lanes at = place_leaf(corners, view, i);
        vf deepest = f_set(0), off[2], wide[2];
        for (int j = 0; j < 3; j++) {
            const vf focus_ratio = at.w[j] * f_set(lens->per_focus);
            f_store(out->a[j] + i, at.a[j]);
            f_store(out->b[j] + i, at.b[j]);
            f_store(out->k[j] + i, at.k[j]);
            f_store(out->c[j] + i, f_set(1) - focus_ratio);
            deepest = f_max(deepest, f_abs(focus_ratio));
        }
        const vf slack = slack_of_leaf(&at, view, is_float);
        for (int j = 0; j < 2; j++) { // the rounding error of l c, including the error of c
            wide[j] = width_through_lens(&at, j ? at.b : at.a, view, lens, j);
            off[j] = slack * f_set(2 / view->unit[j]) + f_set(0x1p-20f * lens->reach[j]) * (f_set(1) + deepest);
        }
        const vf doubt = f_set(3) * (off[0] * (wide[1] + off[1]) + off[1] * (wide[0] + off[0])) +
                         f_set(0x1p-20f) * (wide[0] * wide[1]) + f_set(16 * FLT_MIN);
        f_store(out->doubt + i, doubt);
    }
}

/// Returns the lanes whose rays, at positions u, v, start at (across, down) on the lens and may hit the triangle in a
/// slot.
INNER unsigned hits_through_lens(const leaf_through_lens *leaf, int slot, vf u, vf v, vf across, vf down)
{
    vf x[3], y[3], e[3];
    for (int j = 0; j < 3; j++) {
        const vf k = f_set(leaf->k[j][slot]), c = f_set(leaf->c[j][slot]);
        x[j] = f_set(leaf->a[j][slot]) - (u * k + across * c);
        y[j] = f_set(leaf->b[j][slot]) - (v * k + down * c);
    }
    for (int j = 0; j < 3; j++)
        e[j] = x[(j + 1) % 3] * y[(j + 2) % 3] - x[(j + 2) % 3] * y[(j + 1) % 3];
    const fm under = f_lt(f_min(f_min(e[0], e[1]), e[2]), f_set(-leaf->doubt[slot]));
    const fm over = f_lt(f_set(leaf->doubt[slot]), f_max(f_max(e[0], e[1]), e[2]));
    return ~fm_bits(fm_and(under, over)) & ((1u << VF) - 1);
}

#endif
