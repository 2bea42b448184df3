// cast: the nearest hit of each ray. A float test over a group rejects; the decision is real. Contract: stages.h.

/// |f|^2 - (radius scale)^2 without cancellation.
static inline vr R(exact_c)(const vr f[3], const glint_prim *prim)
{
#if GLINT_REAL == 64
    vd e0, e1, e2;
    vd p0 = d_two_prod(f[0], f[0], &e0), p1 = d_two_prod(f[1], f[1], &e1), p2 = d_two_prod(f[2], f[2], &e2);
    vd xe, ye, ze;
    vd x = d_two_sum(p0, p1, &xe), y = d_two_sum(x, p2, &ye), z = d_two_sum(y, d_set(-prim->r2), &ze);
    return z + (((xe + ye) + ze) + (((e0 + e1) + e2) - d_set(prim->r2_low)));
#else
    return DOT(f, f) - r_set(prim->r2);
#endif
}

/// The better of two discriminants: from within the sphere's width b^2 - a c, from afar a r^2 - |f x d|^2 (Haines,
/// Gunther, Akenine-Moller, Ray Tracing Gems ch. 7, gives the second; neither alone is accurate everywhere).
static inline vr R(discriminant)(const vr f[3], const vr d[3], vr a, vr b, vr c, vr r2)
{
    vr x = f[1] * d[2] - f[2] * d[1], y = f[2] * d[0] - f[0] * d[2], z = f[0] * d[1] - f[1] * d[0];
    vr bb = b * b, ar2 = a * r2;
    return r_select(r_lt(bb, ar2), bb - a * c, ar2 - ((x * x + y * y) + z * z));
}

static inline rm R(meet_sphere)(const vr f[3], const vr d[3], vr a, vr c, const glint_prim *prim, vr *t)
{
    const vr zero = r_set(0), r2 = r_set(prim->r2), scale = r_set(prim->scale);
    vr b = -DOT(f, d);
    vr disc = R(discriminant)(f, d, a, b, c, r2);
    vr s = r_sqrt(r_max(disc, zero));
    rm ahead = r_le(zero, b);
    vr q = r_select(ahead, b + s, b - s);
    rm far_root = rm_and(r_le(c, zero), ahead);
    *t = r_select(far_root, q, c) / (r_select(far_root, a, q) * scale);
    return rm_and(r_le(zero, disc), r_lt(zero, *t));
}

static inline rm R(meet_plane)(const vr d[3], vr a, vr h, const glint_prim *prim, vr *t)
{
    const vr n[3] = { r_set(prim->normal[0]), r_set(prim->normal[1]), r_set(prim->normal[2]) };
    vr nd = DOT(n, d);
    *t = -h / nd;
    return rm_and(r_le(r_set(GLINT_PARALLEL) * a, nd * nd), r_lt(r_set(0), *t));
}

/// Which lanes of a group come near the sphere, `f` from its centre to the ray's origin: the distance of the ray is
/// |f x d| / |d|. Written so that NaN and infinity keep the lane.
static inline unsigned R(near_lanes)(const vf f[3], const float *const direction_f[3], size_t at, vf limit2)
{
    vf d[3] = { f_load(direction_f[0] + at), f_load(direction_f[1] + at), f_load(direction_f[2] + at) };
    vf x[3] = { f[1] * d[2] - f[2] * d[1], f[2] * d[0] - f[0] * d[2], f[0] * d[1] - f[1] * d[0] };
    return ~fm_bits(f_lt(limit2 * DOT(d, d), DOT(x, x))) & ((1u << VF) - 1);
}

static unsigned R(near_bundle)(const glint_cast_args *args, const glint_bundle_prim *seen, size_t at)
{
    const vf f[3] = { f_set(seen->filter_f[0]), f_set(seen->filter_f[1]), f_set(seen->filter_f[2]) };
    const vf limit2 = f_set(seen->filter_limit2);
    unsigned near = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF)
        near |= R(near_lanes)(f, args->direction_f, at + i, limit2) << i;
    return near;
}

#if GLINT_REAL == 64
/// Origins of a group for the filter: around the reference, in its units; and, last, the bound 8 * 2^-24 |origin| (by
/// the sum of the components, which is larger).
static void R(filter_origins)(const void *const point[3], size_t at, const double reference[3], double filter_scale,
                              float (*local)[GLINT_GROUP])
{
    for (int i = 0; i < GLINT_GROUP; i += VR)
        for (int c = 0; c < 3; c++)
            r_store_f(local[c] + i,
                      (r_load((const real *)point[c] + at + i) - r_set(reference[c])) * r_set(filter_scale));
    for (int i = 0; i < GLINT_GROUP; i += VF)
        f_store(local[3] + i, f_set(8 * 0x1p-24f) * ((f_abs(f_load(local[0] + i)) + f_abs(f_load(local[1] + i))) +
                                                     f_abs(f_load(local[2] + i))));
}

static inline vf R(filter_limit)(const vf f[3], const float *bound, const glint_prim *prim)
{
    (void)f;
    return f_set(prim->filter_bound) + f_load(bound);
}

static inline vf R(filter_offset)(const float *origin, const glint_prim *prim, int c)
{
    return f_load(origin) - f_set(prim->filter_center[c]);
}
#else
/// Where float decides, the filter must see what it sees: the same f, with all its error.
static void R(filter_origins)(const void *const point[3], size_t at, const double reference[3], double filter_scale,
                              float (*local)[GLINT_GROUP])
{
    (void)reference, (void)filter_scale;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VF)
            f_store(local[c] + i, f_load((const float *)point[c] + at + i));
}

static inline vf R(filter_limit)(const vf f[3], const float *bound, const glint_prim *prim)
{
    (void)bound;
    if (prim->kind != GLINT_PRIM_SPHERE)
        return f_set(HUGE_VALF);
    const vf reach = f_set((float)(prim->radius * prim->scale * (1 + 1e-6)));
    return reach + f_set(8 * 0x1p-24f) * ((f_abs(f[0]) + f_abs(f[1])) + f_abs(f[2]));
}

static inline vf R(filter_offset)(const float *origin, const glint_prim *prim, int c)
{
    return (f_load(origin) - f_set((float)prim->center[c])) * f_set((float)prim->scale);
}
#endif

/// The filter of rays that have their own origins, `local` of them by filter_origins.
static unsigned R(near_rays)(const float *const direction_f[3], size_t at, const float (*local)[GLINT_GROUP],
                             const glint_prim *prim)
{
    unsigned near = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf f[3];
        for (int c = 0; c < 3; c++)
            f[c] = R(filter_offset)(local[c] + i, prim, c);
        const vf limit = R(filter_limit)(f, local[3] + i, prim);
        near |= R(near_lanes)(f, direction_f, at + i, limit * limit) << i;
    }
    return near;
}

/// Decides one candidate for the lanes of a group in `near`, and keeps the nearest.
static inline void R(decide)(const glint_cast_args *args, size_t at, uint32_t id, unsigned near, bool bundle)
{
    const glint_prim *prim = &args->prims[id];
    real *best_t = (real *)args->t + at;
    uint32_t *best_id = args->prim + at;
    const vr index = r_index(id);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        if (!(near >> i & ((1u << VR) - 1)))
            continue;
        const vr d[3] = { r_load((const real *)args->direction[0] + at + i),
                          r_load((const real *)args->direction[1] + at + i),
                          r_load((const real *)args->direction[2] + at + i) };
        const vr a = DOT(d, d);
        const bool sphere = prim->kind == GLINT_PRIM_SPHERE;
        vr f[3], c, t;
        if (bundle) {
            const glint_bundle_prim *seen = &args->bundle[id];
            for (int k = 0; k < 3; k++)
                f[k] = r_set(seen->f[k]);
            c = r_set(seen->c);
        } else {
            for (int k = 0; k < 3; k++) {
                f[k] = r_load((const real *)args->origin[k] + at + i) - r_set(prim->center[k]);
                if (sphere)
                    f[k] = f[k] * r_set(prim->scale);
            }
            const vr n[3] = { r_set(prim->normal[0]), r_set(prim->normal[1]), r_set(prim->normal[2]) };
            c = DOT(n, f);
            if (sphere)
                c = R(exact_c)(f, prim);
        }
        rm hit = sphere ? R(meet_sphere)(f, d, a, c, prim, &t) : R(meet_plane)(d, a, c, prim, &t);
        const vr old_t = r_load(best_t + i), old_id = r_load_index(best_id + i);
        rm tie = rm_and(r_eq(t, old_t), r_index_lt(index, old_id));
        hit = rm_and(hit, rm_or(r_lt(t, old_t), tie));
        if (!rm_bits(hit))
            continue;
        r_store(best_t + i, r_select(hit, t, old_t));
        r_store_index(best_id + i, r_select(hit, index, old_id));
    }
}

/// Makes lanes outside the image misses and writes the group's hit mask.
static inline void R(collect_hits)(const glint_cast_args *args, uint32_t g)
{
    real *t = (real *)args->t + (size_t)g * GLINT_GROUP;
    uint32_t *prim = args->prim + (size_t)g * GLINT_GROUP;
    unsigned misses = 0;
    for (int i = 0; i < GLINT_GROUP; i += VR)
        misses |= rm_bits(r_index_eq(r_load_index(prim + i), r_index(GLINT_MISS))) << i;
    for (unsigned outside = ~misses & ~(unsigned)args->active[g] & 0xffff; outside; outside &= outside - 1) {
        int i = __builtin_ctz(outside);
        t[i] = (real)HUGE_VAL;
        prim[i] = GLINT_MISS;
    }
    args->hits[g] = (uint16_t)(~misses & args->active[g]);
}

static inline void R(cast)(const glint_cast_args *args, bool bundle)
{
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        _Alignas(64) float local[4][GLINT_GROUP];
        if (!bundle)
            R(filter_origins)((const void *const *)args->origin, at, args->reference, args->filter_scale, local);
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            r_store((real *)args->t + at + i, r_set(HUGE_VAL));
            r_store_index(args->prim + at + i, r_index(GLINT_MISS));
        }
        const unsigned active = args->active[g];
        for (uint32_t k = 0; k < args->candidate_count; k++) {
            const uint32_t id = args->candidates[k];
            unsigned near = active & (bundle ? R(near_bundle)(args, &args->bundle[id], at)
                                             : R(near_rays)(args->direction_f, at, (const float(*)[GLINT_GROUP])local,
                                                            &args->prims[id]));
            if (near)
                R(decide)(args, at, id, near, bundle);
        }
        R(collect_hits)(args, g);
    }
}

static void R(cast_bundle)(const glint_cast_args *args) { R(cast)(args, true); }
static void R(cast_rays)(const glint_cast_args *args) { R(cast)(args, false); }
