// beam: the points of a tile projected onto a screen (screen.h) as seen from the light. The segments from the points
// to one light form a bundle, like a camera's rays.
#ifndef GLINT_OCCLUDE_BEAM_H
#define GLINT_OCCLUDE_BEAM_H

#include "engine/render/stages/index/leaf.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/simd/elementary.h"

#define BEAM_DOWN SCREEN_DOWN ///< maximum number of rows of cells
#define BEAM_NEAREST 0.25f ///< smallest k of a point: a screen position of a point closer to the light is not
    ///< accurate enough
#define BEAM_WIDEST 1.0f ///< largest tangent of the angle between a segment and the axis
#define BEAM_BACK 0x80000000u ///< flag next to the number of a point's primitive: the primitive is seen from behind

/// Sets the frame's axes: `away` from the light, and the component of `along` perpendicular to it as the second axis.
/// Both may have any length except 0.
static bool make_beam_axes(const double away[3], const double along[3], screen_view *view)
{
    const double length = sqrt(DOT(away, away)), share = DOT(along, away) / (length * length);
    double down[3], across[3];
    for (int k = 0; k < 3; k++)
        down[k] = along[k] - share * away[k];
    const double width = sqrt(DOT(down, down));
    if (!(width > 1e-3 * sqrt(DOT(along, along))) || !(length > 0) || !(length < HUGE_VAL))
        return false;
    for (int k = 0; k < 3; k++)
        across[k] = (down[(k + 1) % 3] * away[(k + 2) % 3] - down[(k + 2) % 3] * away[(k + 1) % 3]) / (width * length);
    for (int k = 0; k < 3; k++) {
        view->axis[0][k] = (float)across[k];
        view->axis[1][k] = (float)(down[k] / width);
        view->axis[2][k] = (float)(away[k] / length);
    }
    return true;
}

// ---- Triangles ----

/// Computes the cells in which each triangle may be visible; for a triangle seen edge-on, the cells of its box.
/// Returns the slots of `mask` that may be visible in any cell.
static unsigned cells_of_leaf(const screen_view *view, const node_on_screen *seen, const leaf_on_screen *shown,
                              unsigned mask, uint32_t cells[GLINT_NODE_WIDTH])
{
    const unsigned edge_on = mask & ~shown->certain;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        vi in = i_set(0);
        fm away = fm_from_bits(0);
        for (int n = 1; n >= 0; n--) {
            const vf start = f_set(view->first[n]), end = f_set(view->last[n]);
            const vf least = f_load(shown->least[n] + i), most = f_load(shown->most[n] + i);
            away = fm_or(away, fm_or(f_lt(most, start), f_lt(end, least)));
            in = i_or(i_shl(in, 16), i_or(screen_cell(view, n, f_max(least, start)),
                                          i_shl(screen_cell(view, n, f_min(most, end)), 8)));
        }
        i_store(cells + i, in);
        mask &= ~(fm_bits(away) << i);
    }
    for (unsigned bits = edge_on; bits; bits &= bits - 1)
        cells[__builtin_ctz(bits)] = seen->cells[__builtin_ctz(bits)];
    return mask | edge_on;
}

/// The side from which a point must be seen so that the point's own triangle blocks the light.
typedef struct own_side {
    uint32_t id; ///< the triangle
    uint32_t side; ///< BEAM_BACK: from behind; 0: from the front
    bool any; ///< true: float cannot decide on which side the light is
} own_side;

#endif
