// screen: what one eye sees, or one light: boxes and surfaces of the index in front of a screen that is divided into cells.
// Rays from one eye are a bundle, and so are segments to one light: what may meet them is tested against the cells of its place
// on the screen alone. Float and conservative, as all of walk.h is.
//
// The frame: two axes across the way of the bundle, and one, w, along it. What is at (a, b, w) has its place at a / k and b / k,
// with k = base + inverse w: of a camera's pixels k is w, so that places are s and -t; of segments k is 1 + w / distance, w
// running away from the light from 0 in the middle of the points; of parallel light k is 1.
#ifndef GLINT_INDEX_SCREEN_H
#define GLINT_INDEX_SCREEN_H

#include "engine/stages/index/walk.h"
#include "engine/stages/simd/elementary.h"

#define SCREEN_ACROSS 16 ///< most columns
#define SCREEN_DOWN 20 ///< and rows

typedef struct screen_view {
    float origin[3], axis[3][3]; ///< of the frame, in the index's; at right angles but for rounding
    double exact[3]; ///< what origin was rounded from
    float unit[2]; ///< length of a unit of place where k is 1; the third axis is unit
    float base, inverse; ///< of k
    float slack; ///< what rounding may have moved a ray by, besides what the numbers of a box give
    float first[2], last[2]; ///< places between which there are rays
    float margin; ///< rounding of these
    float cells[2]; ///< cells in a unit of place
    int count[2]; ///< columns and rows
    float far; ///< largest w that matters
    float stretch; ///< at most how much longer a ray is than it is along w, squared
    float reach,
        reach_of_numbers; ///< what a ray may be off by at a surface: the first, and the second times its numbers
    float weight[2], area; ///< squares of `unit`, and their product's root
    float root_stretch, spread; ///< of `stretch`; bound of the lengths of places, where k is 1
    float corner_slack, drift; ///< as slack, for corners from the exact origin: anywhere, and where k is 1, with k
} screen_view;

/// Fills what follows from the rest.
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

/// The cell of a place along an axis: monotonic, so that what is between two places is between their cells.
static inline vi cell_of_place(const screen_view *view, int axis, vf place)
{
    const vf cell = (place - f_set(view->first[axis])) * f_set(view->cells[axis]);
    return i_from_f(f_min(f_max(cell, f_set(0)), f_set((float)(view->count[axis] - 1))));
}

/// A rectangle of cells: first and last column, first and last row, a byte each from the lowest.
typedef uint32_t screen_cells;

static inline int first_column(screen_cells cells) { return cells & 255; }
static inline int last_column(screen_cells cells) { return cells >> 8 & 255; }
static inline int first_row(screen_cells cells) { return cells >> 16 & 255; }
static inline int last_row(screen_cells cells) { return (int)(cells >> 24); }

/// The boxes of a node on the screen.
typedef struct node_on_screen {
    _Alignas(64) float middle[3][GLINT_NODE_WIDTH]; ///< in the frame
    _Alignas(64) float near[GLINT_NODE_WIDTH]; ///< least w
    _Alignas(64) uint32_t cells[GLINT_NODE_WIDTH]; ///< see screen_cells
} node_on_screen;

/// Places between which boxes are whose k is between nearest and farthest. Of those that reach the eye: anywhere, or, where they lie
/// to one side of it, from where they are farthest on. There the lines of all rays must miss them behind the eye, too, for where a
/// triangle is seen edge-on, rounding may turn what is met behind into what is met ahead. start, end: of the screen's places.
static inline void places_of_boxes(vf low, vf high, vf nearest, vf farthest, vf start, vf end, vf *least, vf *most)
{
    const fm ahead = f_lt(f_set(0), nearest);
    const vf near = f_set(1) / nearest, far = f_set(1) / farthest, lowest = low * far, highest = high * far;
    const fm right = fm_and(f_lt(f_set(0), low), f_lt(low * near, start));
    const fm left = fm_and(f_lt(high, f_set(0)), f_lt(end, high * near));
    *least = f_select(ahead, f_min(low * near, lowest), f_select(right, lowest, f_set(-HUGE_VALF)));
    *most = f_select(ahead, f_max(high * near, highest), f_select(left, highest, f_set(HUGE_VALF)));
}

/// Rays that do not start at one eye but on a lens around it: at w they are up to `reach` |1 - per_focus w| beside those of the
/// eye, along each axis, in units of place where k is 1.
typedef struct lens_on_screen {
    float reach[2], per_focus;
} lens_on_screen;

/// A bound of |1 - per_focus w| over k, rounding included.
INNER vf lens_share(const lens_on_screen *lens, vf w, vf per_k)
{
    const vf way = w * f_set(lens->per_focus);
    return (f_abs(f_set(1) - way) + f_set(1e-6f) * (f_set(1) + f_abs(way))) * f_abs(per_k);
}

/// Which boxes may be met before `far`. NaN, of boxes as wide as float reaches, gives every cell. `lens`: NULL, a constant: all
/// rays start at the eye. What it does is between what it does at both ends of a box.
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
        vf beside = f_set(0), around = f_set(0);
        if (lens) {
            const fm ahead = f_lt(f_set(0), nearest);
            beside = f_select(
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
                margin = margin + f_set(lens->reach[j]) * beside;
                low[j] = low[j] - f_set(lens->reach[j]) * around;
                high[j] = high[j] + f_set(lens->reach[j]) * around;
            }
            if (!parallel)
                places_of_boxes(low[j], high[j], nearest, farthest, start - margin, end + margin, &low[j], &high[j]);
            least = low[j] - margin;
            most = high[j] + margin;
            away = fm_or(away, fm_or(f_lt(most, start), f_lt(end, least)));
            cells = i_or(i_shl(cells, 16), i_or(cell_of_place(view, j, f_max(least, start)),
                                                i_shl(cell_of_place(view, j, f_min(most, end)), 8)));
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

/// A node to be looked into, and where it is.
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

/// Bits first .. last.
static inline unsigned bit_range(int first, int last) { return last < first ? 0 : (2u << last) - (1u << first); }

/// Returns the columns of a row in which something at the distance `near` still matters.
static inline unsigned behind_in_row(const float (*far)[SCREEN_ACROSS], int row, float near, unsigned columns)
{
    unsigned behind = 0;
    for (int i = 0; i < SCREEN_ACROSS; i += VF)
        behind |= fm_bits(f_le(f_set(near), f_load(far[row] + i))) << i;
    return behind & columns;
}

/// Whether in some of the cells something as far away as `near` still matters; far: largest such w of each cell.
static inline bool any_behind(const float (*far)[SCREEN_ACROSS], float near, screen_cells cells)
{
    const unsigned columns = bit_range(first_column(cells), last_column(cells));
    const int last = last_row(cells);
    for (int row = first_row(cells); row <= last; row += 2) // one row twice costs less than a branch
        if (behind_in_row(far, row, near, columns) | behind_in_row(far, row < last ? row + 1 : last, near, columns))
            return true;
    return false;
}

/// Finds, for each row, the columns in which something at the distance of a node still matters; none where the node does not show.
typedef struct rows_behind {
    uint16_t columns[SCREEN_DOWN + 3];
} rows_behind;

/// Returns whether there are any. far: as in any_behind.
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

/// The slots of `mask` whose boxes may have any of these behind them: of the lowest bits of `four`, those of the first row.
/// Taller boxes are not tested.
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

/// The slots that hold a primitive.
static inline unsigned prims_of_node(const glint_node *node)
{
    unsigned prims = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF)
        prims |= fm_bits(i_lt(i_load(node->child + i), i_set(0))) << i;
    return prims;
}

/// The slots of `mask`, which hold primitives, that hold triangles.
static inline unsigned triangles_in(const glint_geometry_table *geometry, const glint_node *node, unsigned mask)
{
    unsigned found = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) // all are negative numbers
        found |= fm_bits(i_lt(i_load(node->child + i), i_set(GLINT_NODE_PRIM | geometry->triangles))) << i;
    return found & mask;
}

/// Has the memory of primitives, and of the two nodes to be looked into next, on its way; of triangles, that of their corners. Inlined:
/// GCC takes a call that prefetches alone for one that does nothing.
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

/// A surface as the filter sees it: a ball around it.
typedef struct shape_on_screen {
    float middle[2], k; ///< places of rays times k are where they pass the middle
    float weight[2], reach2; ///< square of how far from it they may pass, and what makes lengths of places
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

/// Lanes whose rays may meet the shape; u, v: their places where they pass its middle, times k.
static inline unsigned shape_at(const shape_on_screen *shape, vf u, vf v)
{
    const vf across = u - f_set(shape->middle[0]), down = v - f_set(shape->middle[1]);
    const vf distance2 = f_set(shape->weight[0]) * (across * across) + f_set(shape->weight[1]) * (down * down);
    return ~fm_bits(f_lt(f_set(shape->reach2), distance2)) & ((1u << VF) - 1);
}

/// The same of rays at places u, v.
static inline unsigned near_shape(const shape_on_screen *shape, vf u, vf v)
{
    return shape_at(shape, u * f_set(shape->k), v * f_set(shape->k));
}

/// A solid that is longer than wide, as the filter sees it: all around its axis. With d along a ray, e along the axis and c from the
/// one line to the other these pass each other at |n . c| / |n|, n = d x e; what follows of a ray's place is linear in that.
typedef struct rod_on_screen {
    float beside[3]; ///< n . c: coefficients of 1, u, v
    float n[3][2]; ///< n: of 1 and v; of 1 and u; of u and v
    float reach2, margin; ///< square of how far off the lines may pass; more than what rounding does to n . c and n reach
    bool is; ///< false: nothing else is set
} rod_on_screen;

/// Sees a primitive as a rod. Not returned by value: clang 14 for WebAssembly then loses `n`.
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
    out->beside[0] = c[1] * e[0] - c[0] * e[1];
    out->beside[1] = du * (c[2] * e[1] - c[1] * e[2]) + view->unit[0] * (base * e[1]);
    out->beside[2] = dv * (c[0] * e[2] - c[2] * e[0]) - view->unit[1] * (base * e[0]);
    memcpy(out->n, (const float[3][2]) { { -e[1], dv * e[2] }, { e[0], -(du * e[2]) }, { du * e[1], -(dv * e[0]) } }, sizeof out->n);
    const float reach = 1.00001f * solid->thick + (view->reach + view->reach_of_numbers * numbers);
    const float sizes = (fabsf(c[0]) + fabsf(c[1])) + (fabsf(c[2]) + base * view->spread) + (numbers + reach);
    out->reach2 = reach * reach;
    out->margin = 0x1p-19f * sizes * (1 + inverse * view->spread);
}

/// Lanes whose rays, at places u, v, may meet it.
static inline unsigned near_rod(const rod_on_screen *rod, vf u, vf v)
{
    const vf beside = (f_set(rod->beside[0]) + u * f_set(rod->beside[1])) + v * f_set(rod->beside[2]);
    const vf n[3] = { f_set(rod->n[0][0]) + v * f_set(rod->n[0][1]), f_set(rod->n[1][0]) + u * f_set(rod->n[1][1]),
                      u * f_set(rod->n[2][0]) + v * f_set(rod->n[2][1]) };
    const vf least = f_max(f_abs(beside) - f_set(rod->margin), f_set(0));
    return ~fm_bits(f_lt(f_set(rod->reach2) * DOT(n, n), least * least)) & ((1u << VF) - 1);
}

#endif
