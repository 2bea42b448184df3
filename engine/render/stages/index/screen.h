// screen: the view of one eye, or of one light: boxes and surfaces of the index in front of a screen that is divided
// into cells. Rays from one eye form a bundle, and so do segments to one light. A primitive that rays or segments may
// hit is only tested in the cells at the primitive's position on the screen. All of this is float and conservative,
// like walk.h.
//
// The frame has two axes across the bundle, and one, w, along it. A point (a, b, w) is projected to a / k and b / k,
// with k = base + inverse w. For a camera's pixels k is w, so that screen positions are s and -t. For segments k is 1
// + w / distance, with w = 0 in the middle of the points and growing away from the light. For parallel light k is 1.
#ifndef GLINT_INDEX_SCREEN_H
#define GLINT_INDEX_SCREEN_H

#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/elementary.h"

#define SCREEN_ACROSS 16 ///< maximum number of columns
#define SCREEN_DOWN 20 ///< maximum number of rows

typedef struct screen_view {
    float origin[3], axis[3][3]; ///< origin and axes of the screen's frame, in the index's frame; the axes are
        ///< orthogonal within rounding
    double exact[3]; ///< the origin before it was rounded
    float unit[2]; ///< length of a unit of screen position at k = 1; the third axis is a unit vector
    float base, inverse; ///< coefficients of k
    float slack; ///< bound of a ray's rounding error, in addition to the error of a box's coordinates
    float first[2], last[2]; ///< bounds of the rays' screen positions
    float margin; ///< bound of the rounding error of these positions
    float cells[2]; ///< cells per unit of screen position
    int count[2]; ///< columns and rows
    float far; ///< maximum w of anything that can be visible
    float stretch; ///< upper bound of (length of a ray / its extent along w)^2
    float reach,
        reach_of_numbers; ///< error bound of a ray at a surface: `reach`, plus `reach_of_numbers` times the size of
            ///< the surface's coordinates
    float weight[2], area; ///< squares of `unit`, and the root of their product
    float root_stretch, spread; ///< root of `stretch`; upper bound of the length of a screen position, at k = 1
    float corner_slack, drift; ///< like slack, for corners relative to the exact origin: corner_slack holds
        ///< everywhere; drift is the bound at k = 1 and grows with k
} screen_view;

/// Computes the fields that follow from the others.
static void finish_screen(screen_view *view)
{
    const float stretch = view->root_stretch = sqrtf(view->stretch), numbers = 2 * GLINT_FILTER_SLACK * stretch;
    view->reach_of_numbers = numbers;
    view->reach =
        view->slack * stretch + numbers * ((fabsf(view->origin[0]) + fabsf(view->origin[1])) + fabsf(view->origin[2]));
    view->spread = 0;
    for (int j = 0; j < 2; j++) {
        view->weight[j] = view->unit[j] * view->unit[j];
        view->spread += larger(fabsf(view->first[j]), fabsf(view->last[j])) * view->unit[j];
    }
    view->area = view->unit[0] * view->unit[1];
}

/// Returns the cell of a position along an axis. The map is monotonic, so that a position between two others is in a
/// cell between their cells.
static inline vi screen_cell(const screen_view *view, int axis, vf position)
{
    const vf cell = (position - f_set(view->first[axis])) * f_set(view->cells[axis]);
    return i_from_f(f_min(f_max(cell, f_set(0)), f_set((float)(view->count[axis] - 1))));
}

/// A rectangle of cells: first and last column, first and last row, one byte each from the lowest.
typedef uint32_t screen_cells;

static inline int first_column(screen_cells cells) { return cells & 255; }
static inline int last_column(screen_cells cells) { return cells >> 8 & 255; }
static inline int first_row(screen_cells cells) { return cells >> 16 & 255; }
static inline int last_row(screen_cells cells) { return (int)(cells >> 24); }

/// The boxes of a node on the screen.
typedef struct node_on_screen {
    _Alignas(64) float middle[3][GLINT_NODE_WIDTH]; ///< middle of each box in the frame
    _Alignas(64) float near[GLINT_NODE_WIDTH]; ///< smallest w of each box
    _Alignas(64) uint32_t cells[GLINT_NODE_WIDTH]; ///< the cells of each box, in the format of screen_cells
} node_on_screen;

/// Computes bounds of the positions of boxes whose k is between nearest and farthest. For a box that reaches the eye,
/// the bounds are infinite, except that the inner bound of a box to one side of the eye is the box's position at
/// `farthest`. That bound is only used if the lines of all rays also miss the box behind the eye, because for a
/// triangle seen edge-on, rounding may turn a hit behind the eye into a hit ahead. start, end: bounds of the screen's
/// positions.
static inline void project_boxes(vf low, vf high, vf nearest, vf farthest, vf start, vf end, vf *least, vf *most)
{
    const fm ahead = f_lt(f_set(0), nearest);
    const vf near = f_set(1) / nearest, far = f_set(1) / farthest, lowest = low * far, highest = high * far;
    const fm right = fm_and(f_lt(f_set(0), low), f_lt(low * near, start));
    const fm left = fm_and(f_lt(high, f_set(0)), f_lt(end, high * near));
    *least = f_select(ahead, f_min(low * near, lowest), f_select(right, lowest, f_set(-HUGE_VALF)));
    *most = f_select(ahead, f_max(high * near, highest), f_select(left, highest, f_set(HUGE_VALF)));
}

/// Rays that start on a lens around the eye. At depth w, they are at most `reach` |1 - per_focus w| away from the
/// eye's rays, along each axis, in screen units at k = 1.
typedef struct lens_on_screen {
    float reach[2], per_focus;
} lens_on_screen;

/// Returns a bound of |1 - per_focus w| over k, including rounding.
INNER vf lens_share(const lens_on_screen *lens, vf w, vf per_k)
{
    const vf focus_ratio = w * f_set(lens->per_focus);
    return (f_abs(f_set(1) - focus_ratio) + f_set(1e-6f) * (f_set(1) + f_abs(focus_ratio))) * f_abs(per_k);
}

/// Returns the boxes that may be hit before `far`. A box as wide as float's range gives NaN, and is in every cell.
/// `lens`: NULL, a constant: all rays start at the eye. Within a box, the offset by a lens is between the offsets at
/// both ends of the box.
INNER unsigned find_boxes(const glint_node *node, const screen_view *view, const bool parallel,
                          const lens_on_screen *lens, node_on_screen *out)
{
    unsigned inside = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        vf middle[3], half[3], low[3], high[3], least, most;
        for (int k = 0; k < 3; k++)
            box_axis(node, k, i, view->origin[k], view->slack, &middle[k], &half[k]);
        for (int j = 0; j < 3; j++) {
            box_along(middle, half, view->axis[j], &low[j], &high[j]);
            f_store(out->middle[j] + i, f_set(0.5f) * low[j] + f_set(0.5f) * high[j]);
        }
        const vf nearest = f_set(view->base) + low[2] * f_set(view->inverse);
        const vf farthest = f_set(view->base) + high[2] * f_set(view->inverse);
        vf moment = f_set(0), around = f_set(0);
        if (lens) {
            const fm ahead = f_lt(f_set(0), nearest);
            moment = f_select(
                ahead,
                f_max(lens_share(lens, low[2], f_set(1) / nearest), lens_share(lens, high[2], f_set(1) / farthest)),
                f_set(0));
            around = f_select(ahead, f_set(0),
                              f_max(lens_share(lens, low[2], f_set(1)), lens_share(lens, high[2], f_set(1))));
        }
        vi cells = i_set(0);
        fm away = fm_or(f_lt(f_set(view->far), low[2]), f_lt(farthest, f_set(0)));
        f_store(out->near + i, f_max(low[2], f_set(-FLT_MAX)));
        for (int j = 1; j >= 0; j--) {
            const vf start = f_set(view->first[j]), end = f_set(view->last[j]);
            vf margin = f_set(view->margin);
            if (lens) {
                margin = margin + f_set(lens->reach[j]) * moment;
                low[j] = low[j] - f_set(lens->reach[j]) * around;
                high[j] = high[j] + f_set(lens->reach[j]) * around;
            }
            if (!parallel)
                project_boxes(low[j], high[j], nearest, farthest, start - margin, end + margin, &low[j], &high[j]);
            least = low[j] - margin;
            most = high[j] + margin;
            away = fm_or(away, fm_or(f_lt(most, start), f_lt(end, least)));
            cells = i_or(i_shl(cells, 16), i_or(screen_cell(view, j, f_max(least, start)),
                                                i_shl(screen_cell(view, j, f_min(most, end)), 8)));
        }
        i_store(out->cells + i, cells);
        inside |= fm_bits(fm_andnot(box_exists(node, i), away)) << i;
    }
    return inside;
}

static unsigned boxes_on_screen(const glint_node *node, const screen_view *view, node_on_screen *out)
{
    if (view->inverse == 0 && view->base == 1)
        return find_boxes(node, view, true, NULL, out);
    return find_boxes(node, view, false, NULL, out);
}

static unsigned boxes_through_lens(const glint_node *node, const screen_view *view, const lens_on_screen *lens,
                                   node_on_screen *out)
{
    return find_boxes(node, view, false, lens, out);
}

/// A node that is still to be opened, and its position on the screen.
typedef struct screen_entry {
    uint32_t node;
    float near;
    screen_cells cells;
} screen_entry;

static inline screen_entry entry_of(const glint_node *node, const node_on_screen *seen, int slot)
{
    return (screen_entry) { node->child[slot], seen->near[slot], seen->cells[slot] };
}

static inline screen_entry entry_of_root(const screen_view *view)
{
    const uint32_t columns = (uint32_t)view->count[0] - 1, rows = (uint32_t)view->count[1] - 1;
    return (screen_entry) { 0, -FLT_MAX, columns << 8 | rows << 24 };
}

/// Returns a mask of the bits first .. last.
static inline unsigned bit_range(int first, int last) { return last < first ? 0 : (2u << last) - (1u << first); }

/// Returns the columns of a row in which a surface at the distance `near` may still be visible.
static inline unsigned behind_in_row(const float (*far)[SCREEN_ACROSS], int row, float near, unsigned columns)
{
    unsigned behind = 0;
    for (int i = 0; i < SCREEN_ACROSS; i += VF)
        behind |= fm_bits(f_le(f_set(near), f_load(far[row] + i))) << i;
    return behind & columns;
}

/// Returns whether a surface at the distance `near` may still be visible in any of the cells. far: maximum w of each.
static inline bool any_behind(const float (*far)[SCREEN_ACROSS], float near, screen_cells cells)
{
    const unsigned columns = bit_range(first_column(cells), last_column(cells));
    const int last = last_row(cells);
    for (int row = first_row(cells); row <= last; row += 2) // repeating the last row costs less than a branch
        if (behind_in_row(far, row, near, columns) | behind_in_row(far, row < last ? row + 1 : last, near, columns))
            return true;
    return false;
}

/// For each row, the columns in which a node may still be visible; 0 in rows that the node does not cover.
typedef struct rows_behind {
    uint16_t columns[SCREEN_DOWN + 3];
} rows_behind;

/// Computes the rows of an entry. Returns whether any column is left. far: as in any_behind.
static inline bool find_behind(const float (*far)[SCREEN_ACROSS], screen_entry entry, rows_behind *out)
{
    const unsigned columns = bit_range(first_column(entry.cells), last_column(entry.cells));
    unsigned any = 0;
    memset(out, 0, sizeof *out);
    for (int row = first_row(entry.cells), last = last_row(entry.cells); row <= last; row++) {
        out->columns[row] = (uint16_t)behind_in_row(far, row, entry.near, columns);
        any |= out->columns[row];
    }
    return any;
}

/// Returns the slots of `mask` whose boxes are in front of any of these cells; the first row is in the lowest bits of
/// `four`. Boxes taller than four rows are always included.
static inline unsigned slots_before(const rows_behind *rows, const node_on_screen *seen, unsigned mask)
{
    unsigned before = 0;
    for (; mask; mask &= mask - 1) {
        const int slot = __builtin_ctz(mask);
        const screen_cells cells = seen->cells[slot];
        const int more = last_row(cells) - first_row(cells);
        uint64_t four;
        memcpy(&four, rows->columns + first_row(cells), sizeof four);
        four &= bit_range(first_column(cells), last_column(cells)) * (uint64_t)0x0001000100010001;
        four &= ~(uint64_t)0 >> (more < 3 ? 48 - 16 * more : 0);
        before |= (unsigned)((four != 0) | (more > 3)) << slot;
    }
    return before;
}

/// Returns the slots of `mask` that hold triangles. All slots of `mask` must hold primitives.
static inline unsigned triangles_in(const glint_geometry_table *geometry, const glint_node *node, unsigned mask)
{
    unsigned found = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) // indices of primitives are negative as signed numbers
        found |= fm_bits(i_lt(i_load(node->child + i), i_set(GLINT_NODE_PRIM | geometry->triangles))) << i;
    return found & mask;
}

/// Prefetches the memory of primitives (for triangles, their corners), and of the next two nodes. Inlined, because
/// GCC removes a call that does nothing except prefetch.
INNER void prefetch_prims(const glint_geometry_table *geometry, const glint_node *node, unsigned mask)
{
    const unsigned triangles = triangles_in(geometry, node, mask);
    for (; mask; mask &= mask - 1) {
        const uint32_t index = node->child[__builtin_ctz(mask)] & ~GLINT_NODE_PRIM;
        const char *first = mask & -mask & triangles ? (const char *)geometry->corners[index] : (const char *)&geometry->prims[index];
        __builtin_prefetch(first);
        __builtin_prefetch(first + 64);
    }
}

INNER void prefetch_nodes(const glint_geometry_table *geometry, const screen_entry *stack, int height)
{
    for (int entry = height > 2 ? height - 2 : 0; entry < height; entry++)
        for (size_t i = 0; i < sizeof(glint_node); i += 64)
            __builtin_prefetch((const char *)&geometry->nodes[stack[entry].node] + i);
}

// ---- Surfaces ----

/// A surface's bounding ball, as the filter needs it.
typedef struct shape_on_screen {
    float middle[2], k; ///< k: k of the middle; at this depth, a ray is at its screen position times k
    float weight[2], reach2; ///< weights of the squared length of a position; square of the maximum distance of a ray
        ///< from the middle
} shape_on_screen;

static inline shape_on_screen shape_of(const glint_node *node, const node_on_screen *seen, int slot,
                                       const glint_prim *prim, const screen_view *view)
{
    shape_on_screen out;
    float numbers = 0;
    for (int k = 0; k < 3; k++)
        numbers += fabsf(0.5f * (node->lower[k][slot] + node->upper[k][slot]));
    const float reach = prim->filter_bound + (view->reach + view->reach_of_numbers * numbers);
    out.k = view->base + seen->middle[2][slot] * view->inverse;
    for (int j = 0; j < 2; j++) {
        out.middle[j] = seen->middle[j][slot];
        out.weight[j] = view->weight[j];
    }
    out.reach2 = reach * reach * view->stretch;
    return out;
}

/// Returns the lanes whose rays may hit the shape; u, v: their screen positions times k, at the depth of its middle.
static inline unsigned shape_at(const shape_on_screen *shape, vf u, vf v)
{
    const vf across = u - f_set(shape->middle[0]), down = v - f_set(shape->middle[1]);
    const vf distance2 = f_set(shape->weight[0]) * (across * across) + f_set(shape->weight[1]) * (down * down);
    return ~fm_bits(f_lt(f_set(shape->reach2), distance2)) & ((1u << VF) - 1);
}

/// Does the same for rays at screen positions u, v.
static inline unsigned near_shape(const shape_on_screen *shape, vf u, vf v)
{
    return shape_at(shape, u * f_set(shape->k), v * f_set(shape->k));
}

/// A solid that is longer than wide, bounded by a cylinder around its axis. Let d be the direction of a ray, e the
/// direction of the axis, and c a vector from one line to the other. The distance of the two lines is |n . c| / |n|,
/// with n = d x e. All terms are linear in the ray's screen position.
typedef struct rod_on_screen {
    float moment[3]; ///< n . c as a linear function: coefficients of 1, u, v
    float n[3][2]; ///< the components of n as linear functions: coefficients of 1 and v; of 1 and u; of u and v
    float reach2, margin; ///< square of the maximum distance of the lines; margin: above the rounding errors of n . c
        ///< and of n times reach
    bool is; ///< false: there is no rod, and the other fields are not set
} rod_on_screen;

/// Computes a primitive's rod. Not returned by value, because clang 14 for WebAssembly then loses `n`.
static inline void see_rod(const glint_geometry_table *geometry, const glint_prim *prim, const screen_view *view, rod_on_screen *out)
{
    const glint_solid *solid = prim->kind == GLINT_PRIM_SOLID ? &geometry->solids[prim->item] : NULL;
    const float inverse = view->inverse, base = view->base;
    float numbers = 2 * prim->filter_bound, c[3] = { 0 }, e[3] = { 0 };
    out->is = solid && solid->thick < HUGE_VALF;
    if (!out->is)
        return;
    for (int k = 0; k < 3; k++) {
        const float from = (float)((prim->center[k] - geometry->reference[k]) * geometry->scale - view->exact[k]);
        numbers += fabsf(prim->filter_center[k]);
        for (int j = 0; j < 3; j++) {
            const float axis = view->axis[j][k] * (j < 2 ? view->unit[j] : 1);
            c[j] += axis * from;
            e[j] += axis * solid->axis[k];
        }
    }
    const float du = view->unit[0] * inverse, dv = view->unit[1] * inverse;
    out->moment[0] = c[1] * e[0] - c[0] * e[1];
    out->moment[1] = du * (c[2] * e[1] - c[1] * e[2]) + view->unit[0] * (base * e[1]);
    out->moment[2] = dv * (c[0] * e[2] - c[2] * e[0]) - view->unit[1] * (base * e[0]);
    memcpy(out->n, (const float[3][2]) { { -e[1], dv * e[2] }, { e[0], -(du * e[2]) }, { du * e[1], -(dv * e[0]) } }, sizeof out->n);
    const float reach = 1.00001f * solid->thick + (view->reach + view->reach_of_numbers * numbers);
    const float sizes = (fabsf(c[0]) + fabsf(c[1])) + (fabsf(c[2]) + base * view->spread) + (numbers + reach);
    out->reach2 = reach * reach;
    out->margin = 0x1p-19f * sizes * (1 + inverse * view->spread);
}

/// Returns the lanes whose rays, at screen positions u, v, may hit the rod.
static inline unsigned near_rod(const rod_on_screen *rod, vf u, vf v)
{
    const vf moment = (f_set(rod->moment[0]) + u * f_set(rod->moment[1])) + v * f_set(rod->moment[2]);
    const vf n[3] = { f_set(rod->n[0][0]) + v * f_set(rod->n[0][1]), f_set(rod->n[1][0]) + u * f_set(rod->n[1][1]),
                      u * f_set(rod->n[2][0]) + v * f_set(rod->n[2][1]) };
    const vf least = f_max(f_abs(moment) - f_set(rod->margin), f_set(0));
    return ~fm_bits(f_lt(f_set(rod->reach2) * DOT(n, n), least * least)) & ((1u << VF) - 1);
}

#endif
