// surface: the point, the normal and the material of each hit. A group is worked off object by object: most groups
// show one, whose numbers are then the same in every lane. Contract: stages.h.

/// The normal as seen from so far that origin and sphere have no digits in common but the foot of the perpendicular.
static inline void R(far_normal)(const vr f[3], const vr d[3], vr r2, vr n[3])
{
    const vr zero = r_set(0);
    vr a = DOT(d, d), b = -DOT(f, d), w = b / a;
    vr l[3] = { f[0] + w * d[0], f[1] + w * d[1], f[2] + w * d[2] };
    vr c = DOT(f, f) - r2;
    vr h = r_sqrt(r_max(r2 - DOT(l, l), zero) / a);
    rm entering = rm_and(r_le(zero, b), r_le(zero, c));
    for (int k = 0; k < 3; k++)
        n[k] = r_select(entering, l[k] - h * d[k], l[k] + h * d[k]);
    vr m = DOT(n, n), length = r_sqrt(m), ray = r_sqrt(a);
    rm defined = r_lt(zero, m);
    for (int k = 0; k < 3; k++)
        n[k] = r_select(defined, n[k] / length, -d[k] / ray);
}

/// `near`: the origin is known to be within 2^20 radii in every lane.
static inline void R(sphere_surface)(const vr f[3], const vr d[3], vr t, const glint_prim *prim, bool near, vr n[3],
                                     vr p[3])
{
    const vr scale = r_set(prim->scale), radius = r_set(prim->radius);
    vr ts = t * scale, inverse = r_set((real)1 / ((real)prim->radius * (real)prim->scale));
    for (int k = 0; k < 3; k++)
        n[k] = (f[k] + ts * d[k]) * inverse;
    vr newton = r_set(1.5) - r_set(0.5) * DOT(n, n);
    for (int k = 0; k < 3; k++)
        n[k] = n[k] * newton;
    if (!near) {
        const rm close = r_lt(DOT(f, f), r_set(0x1p40));
        vr far[3];
        R(far_normal)(f, d, r_set(prim->r2), far);
        for (int k = 0; k < 3; k++)
            n[k] = r_select(close, n[k], far[k]);
    }
    for (int k = 0; k < 3; k++)
        p[k] = r_set(prim->center[k]) + radius * n[k];
}

/// Writes `x` in the lanes of `mask`; `whole` says that these are all.
static inline void R(put)(void *array, size_t at, bool whole, rm mask, vr x)
{
    real *to = (real *)array + at;
    if (!whole)
        x = r_select(mask, x, r_load(to));
    r_store(to, x);
}

/// Works out one primitive in some lanes of a vector and leaves the others as they are. Returns the lanes in which it
/// is seen from behind.
static __attribute__((always_inline)) inline unsigned R(surface_lanes)(const glint_surface_args *args, uint32_t id,
                                                                       uint32_t g, int i, unsigned lanes)
{
    const size_t at = (size_t)g * GLINT_GROUP + (size_t)i;
    const glint_prim *prim = &args->prims[id];
    const bool whole = lanes == (1u << VR) - 1;
    const rm mask = rm_from_bits(lanes);
    vr d[3], n[3], p[3], from[3];
    R(ray_direction)(args->camera, args->direction, g, i, d);
    if (args->camera)
        for (int k = 0; k < 3; k++)
            from[k] = r_set(args->camera->eye[k]);
    else
        R(load3)(args->origin, at, from);
    const vr t = r_load((const real *)args->t + at);
    if (prim->kind == GLINT_PRIM_SPHERE) {
        vr f[3];
        bool near = false;
        if (args->camera) {
            real e[3];
            for (int k = 0; k < 3; k++)
                e[k] = ((real)args->camera->eye[k] - (real)prim->center[k]) * (real)prim->scale;
            near = (e[0] * e[0] + e[1] * e[1]) + e[2] * e[2] < (real)0x1p40;
        }
        R(offset)(from, prim, f);
        R(sphere_surface)(f, d, t, prim, near, n, p);
    } else {
        for (int k = 0; k < 3; k++) {
            n[k] = r_set(prim->normal[k]);
            p[k] = from[k] + t * d[k];
        }
    }
    rm back = r_lt(r_set(0), DOT(n, d));
    for (int k = 0; k < 3; k++) {
        R(put)(args->point[k], at, whole, mask, p[k]);
        R(put)(args->normal[k], at, whole, mask, r_select(back, -n[k], n[k]));
    }
    return rm_bits(back) & lanes;
}

/// Zeroes the lanes of a group that is hit in part.
static inline void R(clear_surface)(const glint_surface_args *args, size_t at)
{
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            r_store((real *)args->point[k] + at + i, r_set(0));
            r_store((real *)args->normal[k] + at + i, r_set(0));
        }
    lanes_put(args->material + at, 0xffff, 0);
}

static void R(surface)(const glint_surface_args *args)
{
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        unsigned left = args->hits[g], back = 0, dark = 0;
        if (left && left != 0xffff)
            R(clear_surface)(args, at);
        while (left) {
            const uint32_t id = args->prim[at + (unsigned)__builtin_ctz(left)];
            const glint_prim *prim = &args->prims[id];
            const unsigned lanes = lanes_equal(args->prim + at, id);
            unsigned behind = 0;
            for (int i = 0; i < GLINT_GROUP; i += VR)
                if (lanes >> i & ((1u << VR) - 1))
                    behind |= R(surface_lanes)(args, id, g, i, lanes >> i & ((1u << VR) - 1)) << i;
            lanes_put(args->material + at, lanes, prim->material);
            back |= behind;
            if (!prim->two_sided)
                dark |= behind;
            left &= ~lanes;
        }
        args->back[g] = (uint16_t)back;
        args->dark[g] = (uint16_t)dark;
    }
}
