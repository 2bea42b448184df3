// beam: the points of a tile as their light sees them. Segments to one light are a bundle, as rays from one eye are: each
// point has a place on a screen before the light, and a box of the index, or a surface, can come between the light and the
// points of a few cells of that screen alone. Float and conservative, as all of walk.h is.
//
// The frame: its origin is the middle of the points, its third axis runs away from the light. A segment through (a, b, w)
// is where a / k and b / k are, k = 1 + w / distance: its place where it crosses the plane w = 0. Of parallel light k is 1.

#define BEAM_ACROSS 16
#define BEAM_DOWN 32
#define BEAM_NEAREST 0.25f ///< least k of a point: nearer to the light a place is not worth much
#define BEAM_WIDEST 1.0f ///< largest tangent of an angle to the axis

typedef struct beam_view {
    float origin[3], axis[3][3]; ///< of the frame, in the index's; unit and at right angles but for rounding
    float inverse; ///< 1 / distance; 0: parallel
    float slack; ///< what rounding may have moved a point by
    float first[2], last[2], cells[2]; ///< of the points' places, and cells in a unit
    float far; ///< of the points: largest w
    float stretch; ///< how much longer a segment is than it is along the axis, at most, squared
} beam_view;

/// Sets the frame's axes: `away` from the light, and `along` as far as it is across it, which becomes the second. All
/// may have any length but 0.
static bool make_beam_axes(const double away[3], const double along[3], beam_view *view)
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

/// The cells of places: monotonic, so that what is between two places is between their cells.
static inline vi beam_cells(const beam_view *view, int axis, vf place)
{
    const vf cell = (place - f_set(view->first[axis])) * f_set(view->cells[axis]);
    return i_from_f(f_min(f_max(cell, f_set(0)), f_set(axis ? BEAM_DOWN - 1 : BEAM_ACROSS - 1)));
}

/// The cells between the places; NaN, of boxes as wide as float reaches, gives all.
static inline void cells_between(const beam_view *view, int axis, vf least, vf most, uint32_t *first, uint32_t *last)
{
    const vf start = f_set(view->first[axis]), end = f_set(view->last[axis]);
    i_store(first, beam_cells(view, axis, f_max(least, start)));
    i_store(last, beam_cells(view, axis, f_min(most, end)));
}

/// What the light sees of a node's boxes.
typedef struct node_in_beam {
    _Alignas(64) float middle[3][GLINT_NODE_WIDTH]; ///< in the frame
    _Alignas(64) float near[GLINT_NODE_WIDTH]; ///< least w
    _Alignas(64) uint32_t first[2][GLINT_NODE_WIDTH], last[2][GLINT_NODE_WIDTH]; ///< cells
} node_in_beam;

/// Places between which boxes are that reach from w = near to far, or the whole screen where they reach the light.
static inline void places_of_boxes(vf low, vf high, vf nearest, vf farthest, vf *least, vf *most)
{
    const fm ahead = f_lt(f_set(0), nearest);
    const vf near = f_set(1) / nearest, far = f_set(1) / farthest;
    *least = f_select(ahead, f_min(low * near, low * far), f_set(-HUGE_VALF));
    *most = f_select(ahead, f_max(high * near, high * far), f_set(HUGE_VALF));
}

/// Which boxes may stand between the light and a point.
static unsigned boxes_in_beam(const glint_node *node, const beam_view *view, node_in_beam *out)
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
        const vf nearest = f_set(1) + low[2] * f_set(view->inverse);
        const vf farthest = f_set(1) + high[2] * f_set(view->inverse);
        fm away = fm_or(f_lt(f_set(view->far), low[2]), f_lt(farthest, f_set(0)));
        f_store(out->near + i, f_max(low[2], f_set(-FLT_MAX)));
        for (int j = 0; j < 2; j++) {
            places_of_boxes(low[j], high[j], nearest, farthest, &least, &most);
            away = fm_or(away, fm_or(f_lt(most, f_set(view->first[j])), f_lt(f_set(view->last[j]), least)));
            cells_between(view, j, least, most, out->first[j] + i, out->last[j] + i);
        }
        inside |= fm_bits(fm_andnot(box_exists(node, i), away)) << i;
    }
    return inside;
}

/// A triangle in the frame, from the middle of its box.
typedef struct beam_triangle {
    float across[3], down[3], lean[3]; ///< of the corners; `lean`: w / distance
    float size; ///< bound of these
    int light; ///< on which side of it the light is: 1, -1, or 0 where float cannot tell
} beam_triangle;

/// middle: of its box, in the index's frame; seen: the same in the beam's, give or take `slack`.
static beam_triangle make_beam_triangle(const glint_prim *prim, const glint_geometry_table *geometry,
                                        const beam_view *view, const float middle[3], const float seen[3], float slack)
{
    beam_triangle out = { .size = 0 };
    float w[3], from[3];
    for (int j = 0; j < 3; j++) {
        float x[3];
        for (int k = 0; k < 3; k++)
            x[k] = (float)((prim->corner[j][k] - geometry->reference[k]) * geometry->scale - (double)middle[k]);
        out.across[j] = DOT(view->axis[0], x);
        out.down[j] = DOT(view->axis[1], x);
        w[j] = DOT(view->axis[2], x);
        out.lean[j] = w[j] * view->inverse;
        out.size = larger(out.size, (fabsf(x[0]) + fabsf(x[1])) + fabsf(x[2]));
    }
    // from a corner to the light, times the share `inverse` of the way where there is one
    for (int k = 0; k < 3; k++)
        from[k] = -view->inverse * (seen[k] + (k == 0 ? out.across[0] : k == 1 ? out.down[0] : w[0]));
    from[2] -= 1;
    const float f[3] = { out.across[1] - out.across[0], out.down[1] - out.down[0], w[1] - w[0] };
    const float g[3] = { out.across[2] - out.across[0], out.down[2] - out.down[0], w[2] - w[0] };
    float side = 0, size = 0;
    for (int k = 0; k < 3; k++) {
        const float a = f[(k + 1) % 3] * g[(k + 2) % 3], b = f[(k + 2) % 3] * g[(k + 1) % 3];
        side += (a - b) * from[k];
        size += fabsf(from[k]);
    }
    const float doubt = out.size * (out.size * (0x1p-16f * size + 16 * slack * view->inverse) + 16 * slack * size);
    out.light = side > doubt ? 1 : side < -doubt ? -1 : 0;
    return out;
}
