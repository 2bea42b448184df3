// beside: rays that leave a triangle by an edge or corner, and the triangles that they share it with. Rounding puts the
// ray's beginning to either side of those; what they have to do with the ray is decided by how the two lie. Contract: stages.h.

/// A triangle's plane, in the table's units, and what rounding may make of heights over it.
typedef struct R(flat) {
    real m[3], size[3], corner[3][3];
} R(flat);

static inline real R(size_of)(real x) { return x < 0 ? -x : x; }

static inline R(flat) R(flat_of)(const glint_prim *prim, double scale)
{
    R(flat) out;
    real f[3], g[3];
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            out.corner[j][k] = (real)prim->corner[j][k];
    for (int k = 0; k < 3; k++) {
        f[k] = (out.corner[1][k] - out.corner[0][k]) * (real)scale;
        g[k] = (out.corner[2][k] - out.corner[0][k]) * (real)scale;
    }
    for (int k = 0; k < 3; k++) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        const real a = f[x] * g[y], b = f[y] * g[x];
        out.m[k] = a - b;
        out.size[k] = R(size_of)(a) + R(size_of)(b);
    }
    return out;
}

/// The height of a place over the plane, and what rounding may make of it.
static inline real R(height_over)(const R(flat) * flat, const real at[3], real *rounding)
{
    real q[3];
    for (int k = 0; k < 3; k++)
        q[k] = at[k] - flat->corner[0][k];
    *rounding = (real)GLINT_POINT_SLACK * ((flat->size[0] * R(size_of)(q[0]) + flat->size[1] * R(size_of)(q[1])) +
                                           flat->size[2] * R(size_of)(q[2]));
    return DOT(flat->m, q);
}

static inline real R(spread_of)(const R(flat) * flat)
{
    return (R(size_of)(flat->m[0]) + R(size_of)(flat->m[1])) + R(size_of)(flat->m[2]);
}

/// Whether a corner of the triangle is for certain on the side of the plane that `way` points to; the corners too are rounded.
static inline bool R(reaches)(const R(flat) * flat, real way, const R(flat) * other)
{
    for (int j = 0; j < 3; j++) {
        real rounding, place = 0;
        const real h = R(height_over)(flat, other->corner[j], &rounding);
        for (int k = 0; k < 3; k++)
            place = place < R(size_of)(other->corner[j][k]) ? R(size_of)(other->corner[j][k]) : place;
        const real off = rounding + R(spread_of)(flat) * ((real)GLINT_POINT_SLACK * place);
        if (off < R(size_of)(h) && ((0 < way && 0 < h) || (way < 0 && h < 0)))
            return true;
    }
    return false;
}

/// What rounding may have moved a point of the triangle by, a component.
static inline real R(point_slack_of)(const R(flat) * flat, const real o[3])
{
    real f = 0, g = 0, p = 0;
    for (int k = 0; k < 3; k++) {
        const real a = R(size_of)(flat->corner[1][k] - flat->corner[0][k]),
                   b = R(size_of)(flat->corner[2][k] - flat->corner[0][k]), c = R(size_of)(o[k]);
        f = a < f ? f : a;
        g = b < g ? g : b;
        p = c < p ? p : c;
    }
    return (real)GLINT_POINT_SLACK * ((f + g) + p);
}

/// Whether the ray passes all edges on one side, give or take what its beginning is off by.
static inline bool R(passes_near)(const R(flat) * flat, const real o[3], const real d[3], real slack, double scale)
{
    vr p[3][3], direction[3];
    real r = 0;
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++) {
            const real from = (flat->corner[j][k] - o[k]) * (real)scale;
            r = r < R(size_of)(from) ? R(size_of)(from) : r;
            p[j][k] = r_set(from);
            direction[j] = r_set(d[j]);
        }
    const R(seen_edges) edges = R(see_edges)(p, direction, true);
    const vr move = R(abs)(edges.dz) * r_set(2 * (slack * (real)scale) + (real)GLINT_POINT_SLACK * r);
    return rm_bits(R(within)(&edges, move * (edges.reach + r_set(2) * move))) & 1;
}

/// Whether a ray that starts on `from`, in the plane of `other` as far as rounding lets us know, goes through `other`: it
/// reaches to the side that the ray goes to, and the ray leaves the side of it that `from` is on.
static inline bool R(goes_through)(const R(flat) * from, const R(flat) * other, const real o[3], const real d[3],
                                   real slack, double scale)
{
    return R(reaches)(from, DOT(from->m, d), other) && R(reaches)(other, -DOT(other->m, d), from) &&
           R(passes_near)(other, o, d, slack, scale);
}

/// Decides anew for the lanes that leave a triangle in the plane of this one. `at`: the first lane of the vector.
static inline rm R(meet_beside)(const glint_cast_args *args, size_t at, const vr o[3], const glint_prim *prim, rm hit,
                                vr *t)
{
    const glint_geometry_table *table = args->geometry;
    const R(flat) flat = R(flat_of)(prim, table->scale);
    const real *const m = flat.m;
    const real spread = R(spread_of)(&flat);
    const real far = (real)(2 * GLINT_POINT_SLACK * table->extent);
    // above every bound: points, corners and differences of them are at most 2 extents
    const real most = far * (5 * spread + 2 * ((flat.size[0] + flat.size[1]) + flat.size[2]));
    vr q[3];
    for (int k = 0; k < 3; k++)
        q[k] = o[k] - r_set(flat.corner[0][k]);
    const vr h = (r_set(m[0]) * q[0] + r_set(m[1]) * q[1]) + r_set(m[2]) * q[2];
    unsigned anew = 0, through = 0;
    for (unsigned left = ~rm_bits(r_lt(r_set(most), R(abs)(h))) & ((1u << VR) - 1); left; left &= left - 1) {
        const size_t i = at + (size_t)__builtin_ctz(left);
        const uint32_t from_id = args->leaving[i];
        if (from_id == GLINT_MISS || table->prims[from_id].kind != GLINT_PRIM_TRIANGLE)
            continue;
        real origin[3], d[3], rounding;
        for (int k = 0; k < 3; k++) {
            origin[k] = ((const real *)args->origin[k])[i];
            d[k] = ((const real *)args->direction[k])[i];
        }
        const R(flat) from = R(flat_of)(&table->prims[from_id], table->scale);
        const real slack = R(point_slack_of)(&from, origin), height = R(height_over)(&flat, origin, &rounding);
        if (spread * slack + rounding < R(size_of)(height))
            continue;
        anew |= left & -left;
        if (R(goes_through)(&from, &flat, origin, d, slack, table->scale))
            through |= left & -left;
    }
    *t = r_select(rm_from_bits(anew), r_set(GLINT_LEAST_WAY), *t);
    return rm_or(rm_andnot(hit, rm_from_bits(anew)), rm_from_bits(through));
}
