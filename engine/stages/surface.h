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

static inline void R(sphere_surface)(const vr f[3], const vr d[3], vr t, const glint_prim *prim, vr n[3], vr p[3])
{
    const vr scale = r_set(prim->scale), radius = r_set(prim->radius);
    vr ts = t * scale, inverse = r_set((real)1 / ((real)prim->radius * (real)prim->scale));
    for (int k = 0; k < 3; k++)
        n[k] = (f[k] + ts * d[k]) * inverse;
    vr newton = r_set(1.5) - r_set(0.5) * DOT(n, n);
    for (int k = 0; k < 3; k++)
        n[k] = n[k] * newton;
    rm near = r_lt(DOT(f, f), r_set(0x1p40));
    if (rm_bits(near) != (1u << VR) - 1) {
        vr far[3];
        R(far_normal)(f, d, r_set(prim->r2), far);
        for (int k = 0; k < 3; k++)
            n[k] = r_select(near, n[k], far[k]);
    }
    for (int k = 0; k < 3; k++)
        p[k] = r_set(prim->center[k]) + radius * n[k];
}

/// Keeps `old` where the mask is not set; `whole` says that it is set everywhere.
static inline void R(put)(void *array, size_t at, bool whole, rm mask, vr x)
{
    real *to = (real *)array + at;
    r_store(to, whole ? x : r_select(mask, x, r_load(to)));
}

static inline void R(put_index)(uint32_t *to, bool whole, rm mask, vr x)
{
    r_store_index(to, whole ? x : r_select(mask, x, r_load_index(to)));
}

/// Works out one primitive in the lanes of `mask` (a vector's worth of them) and leaves the others as they are.
static inline void R(surface_lanes)(const glint_surface_args *args, uint32_t id, size_t at, rm mask)
{
    const glint_prim *prim = &args->prims[id];
    const bool whole = rm_bits(mask) == (1u << VR) - 1;
    vr d[3], n[3], p[3], from[3];
    for (int k = 0; k < 3; k++) {
        d[k] = r_load((const real *)args->direction[k] + at);
        if (args->bundle)
            from[k] = r_set(args->eye[k]);
        else
            from[k] = r_load((const real *)args->origin[k] + at);
    }
    const vr t = r_load((const real *)args->t + at);
    if (prim->kind == GLINT_PRIM_SPHERE) {
        vr f[3];
        for (int k = 0; k < 3; k++) {
            if (args->bundle)
                f[k] = r_set(args->bundle[id].f[k]);
            else
                f[k] = (from[k] - r_set(prim->center[k])) * r_set(prim->scale);
        }
        R(sphere_surface)(f, d, t, prim, n, p);
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
    const vr behind = r_index(prim->two_sided ? GLINT_SIDE_BACK : GLINT_SIDE_BACK | GLINT_SIDE_UNLIT);
    R(put_index)(args->side + at, whole, mask, r_select(back, behind, r_index(0)));
    R(put_index)(args->material + at, whole, mask, r_index(prim->material));
    R(put_index)(args->coincident + at, whole, mask, r_index(prim->coincident));
}

/// Zeroes the lanes of a group that is hit in part.
static inline void R(clear_surface)(const glint_surface_args *args, size_t at)
{
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        for (int k = 0; k < 3; k++) {
            r_store((real *)args->point[k] + at + i, r_set(0));
            r_store((real *)args->normal[k] + at + i, r_set(0));
        }
        r_store_index(args->side + at + i, r_index(0));
        r_store_index(args->material + at + i, r_index(0));
        r_store_index(args->coincident + at + i, r_index(0));
    }
}

static void R(surface)(const glint_surface_args *args)
{
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        unsigned left = args->hits[g];
        if (left && left != 0xffff)
            R(clear_surface)(args, at);
        while (left) {
            const uint32_t id = args->prim[at + (unsigned)__builtin_ctz(left)];
            for (int i = 0; i < GLINT_GROUP; i += VR) {
                rm mask = r_index_eq(r_load_index(args->prim + at + i), r_index(id));
                if (!rm_bits(mask))
                    continue;
                left &= ~(rm_bits(mask) << i);
                R(surface_lanes)(args, id, at + i, mask);
            }
        }
    }
}
