// occlude: which points a light reaches. Always decided from the point towards the light, without a root or a
// division: the segment meets a sphere when one end is inside and the other outside, or when both are outside, the
// foot of the perpendicular lies between them and the discriminant is not negative. Contract: stages.h.

/// A group's shadow rays.
typedef struct R(shadow_group) {
    _Alignas(64) real to_light[3][GLINT_GROUP];
    _Alignas(64) float to_light_f[3][GLINT_GROUP]; ///< in the light's units, for the filter
    _Alignas(64) float local[4][GLINT_GROUP]; ///< origins for the filter, and its bound
} R(shadow_group);

static inline void R(shadow_rays)(const glint_occlude_args *args, size_t at, R(shadow_group) * rays)
{
    for (int i = 0; i < GLINT_GROUP; i += VR)
        for (int k = 0; k < 3; k++) {
            vr d = r_set(args->position[k]);
            if (!args->directional)
                d = (d - r_load((const real *)args->point[k] + at + i)) * r_set(args->scale);
            r_store(rays->to_light[k] + i, d);
            r_store_f(rays->to_light_f[k] + i, d);
        }
    R(filter_origins)(args->point, at, args->reference, args->filter_scale, rays->local);
}

static inline rm R(sphere_blocks)(const glint_occlude_args *args, const glint_prim *prim, int light_side, size_t at,
                                  const R(shadow_group) * rays, int i)
{
    const vr zero = r_set(0), scale = r_set(prim->scale);
    vr f[3], d[3];
    for (int k = 0; k < 3; k++) {
        f[k] = (r_load((const real *)args->point[k] + at + i) - r_set(prim->center[k])) * scale;
        d[k] = r_load(rays->to_light[k] + i);
    }
    vr c = R(exact_c)(f, prim);
    if (light_side < 0)
        return r_lt(zero, c);
    vr a = DOT(d, d), b = -DOT(f, d);
    rm blocked = rm_and(r_lt(zero, b), r_le(zero, R(discriminant)(f, d, a, b, c, r_set(prim->r2))));
    if (!args->directional)
        blocked = rm_and(blocked, r_lt(b * r_set(args->scale), a * scale));
    const rm inside = r_lt(c, zero);
    return light_side > 0 ? rm_or(inside, blocked) : rm_andnot(blocked, inside);
}

static inline rm R(plane_blocks)(const glint_occlude_args *args, const glint_prim *prim, int light_side, size_t at,
                                 int i)
{
    vr n[3], e[3];
    for (int k = 0; k < 3; k++) {
        n[k] = r_set(prim->normal[k]);
        e[k] = r_load((const real *)args->point[k] + at + i) - r_set(prim->center[k]);
    }
    vr h = DOT(n, e);
    if (light_side > 0)
        return r_lt(h, r_set(0));
    return light_side < 0 ? r_lt(r_set(0), h) : rm_from_bits(0);
}

/// The lanes of `wanted` that the primitive blocks.
static inline unsigned R(blocked_by)(const glint_occlude_args *args, uint32_t id, size_t at,
                                     const R(shadow_group) * rays, unsigned wanted)
{
    const glint_prim *prim = &args->prims[id];
    const bool sphere = prim->kind == GLINT_PRIM_SPHERE;
    const int light_side = args->light_side[id];
    const unsigned own = lanes_equal(args->coincident + at, prim->coincident);
    unsigned blocked = 0;
    if (own && sphere && light_side > 0)
        blocked = own & lanes_with(args->side + at, GLINT_SIDE_BACK);
    wanted &= ~own;
    if (!wanted)
        return blocked;
    const float *const way[3] = { rays->to_light_f[0], rays->to_light_f[1], rays->to_light_f[2] };
    if (light_side >= 0) // with the light inside, being outside is enough: no distance is asked
        wanted &= R(near_rays)(way, 0, rays->local, prim);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = wanted >> i & ((1u << VR) - 1);
        if (!lanes)
            continue;
        rm hit = sphere ? R(sphere_blocks)(args, prim, light_side, at, rays, i)
                        : R(plane_blocks)(args, prim, light_side, at, i);
        blocked |= (rm_bits(hit) & lanes) << i;
    }
    return blocked;
}

static void R(occlude)(const glint_occlude_args *args)
{
    R(shadow_group) rays;
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        unsigned open = args->lit[g];
        args->open[g] = 0;
        if (!open)
            continue;
        *args->rays += (unsigned)__builtin_popcount(open);
        if (args->candidate_count)
            R(shadow_rays)(args, at, &rays);
        for (uint32_t k = 0; k < args->candidate_count && open; k++)
            open &= ~R(blocked_by)(args, args->candidates[k], at, &rays, open);
        args->open[g] = (uint16_t)open;
    }
}
