// cast_rays: the nearest hit of rays that start anywhere. A lone ray walks the index; parallel ones walk it a group at a
// time. Contract: stages.h.

/// Decides the lanes of `own`, which start on this very primitive: only the inside of a sphere is met again.
static inline rm R(meet_own)(const glint_cast_args *args, unsigned own, size_t at, const vr f[3], const vr d[3],
                             const glint_prim *prim, rm hit, vr *t)
{
    const rm mask = rm_from_bits(own);
    const unsigned inward = args->inward[at / GLINT_GROUP] >> at % GLINT_GROUP & own;
    if (prim->kind == GLINT_PRIM_SOLID) {
        const glint_solid *solid = &args->geometry->solids[prim->item];
        vr e[3];
        R(to_unit)(solid, d, e);
        const R(span) span = R(span_of)(solid, f, e);
        const rm leaves = rm_and(rm_and(span.hit, span.second), r_lt(r_set(0), span.t[1]));
        *t = r_select(mask, span.t[1], *t);
        return rm_or(rm_andnot(hit, mask), rm_and(rm_from_bits(solid->form == GLINT_FORM_DISK ? 0 : inward), leaves));
    }
    if (prim->kind != GLINT_PRIM_SPHERE)
        return rm_andnot(hit, mask);
    const vr zero = r_set(0), a = DOT(d, d), b = -DOT(f, d), across = (b + b) / (a * r_set(prim->scale));
    const rm meets = r_le(zero, R(discriminant)(f, d, a, b, R(exact_c)(f, prim), r_set(prim->r2)));
    const rm ahead = rm_and(r_lt(zero, b), r_lt(zero, across));
    const rm again = rm_and(rm_from_bits(inward), rm_and(meets, ahead));
    *t = r_select(mask, across, *t);
    return rm_or(rm_andnot(hit, mask), again);
}

/// Tests one primitive against all rays of a group.
static inline void R(cast_on_group)(const glint_cast_args *args, uint32_t g, const R(ray_group) * rays, uint32_t id)
{
    const glint_prim *prim = &args->geometry->prims[id];
    const size_t at = (size_t)g * GLINT_GROUP;
    const unsigned near = R(near_rays)(rays, prim);
    const unsigned leave = args->leaving ? lanes_equal(args->leaving + at, id) : 0;
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned own = leave >> i & ((1u << VR) - 1);
        if (!(near >> i & ((1u << VR) - 1)))
            continue;
        vr o[3], d[3], f[3], p[3][3], t;
        R(load3)(args->origin, at + i, o);
        R(load3)(args->direction, at + i, d);
        rm hit;
        if (prim->kind == GLINT_PRIM_TRIANGLE) {
            R(corners_from)(o, prim, args->geometry->scale, p);
            hit = R(meet_triangle)(p, d, r_set(args->geometry->scale), &t);
        } else if (prim->kind == GLINT_PRIM_SOLID) {
            const glint_solid *solid = &args->geometry->solids[prim->item];
            R(unit_offset)(solid, prim, o, f);
            hit = R(meet_solid)(solid, f, d, &t);
        } else {
            R(offset)(o, prim, f);
            hit = R(meet)(f, R(offset_constant)(f, prim), d, prim, &t);
        }
        if (own)
            hit = R(meet_own)(args, own, at + (size_t)i, f, d, prim, hit, &t);
        if (rm_bits(hit))
            R(keep_nearest)(args, at + i, id, hit, t);
    }
}

/// Walks the index with one ray; what it may meet is tested against its whole group, whose rays are often alike.
static void R(walk_ray)(const glint_cast_args *args, uint32_t g, const R(ray_group) * rays, int lane)
{
    const glint_geometry_table *geometry = args->geometry;
    const real *t = (const real *)args->t + (size_t)g * GLINT_GROUP + lane;
    ray_view ray = { .slack = R(walk_slack)(geometry) };
    for (int k = 0; k < 3; k++) {
        ray.origin[k] = rays->local[k][lane];
        ray.inverse[k] = 1 / rays->direction[k][lane];
    }
    walk_entry stack[WALK_STACK];
    int height = 0;
    stack[height++] = (walk_entry) { 0, 0 };
    while (height > 0) {
        const walk_entry top = stack[--height];
        const float far = (float)(*t * (real)geometry->scale) * (1 + 0x1p-22f);
        if (far < top.depth)
            continue;
        _Alignas(64) float depth[GLINT_NODE_WIDTH];
        int order[GLINT_NODE_WIDTH];
        const glint_node *node = &geometry->nodes[top.node];
        const int count = sort_slots(boxes_on_ray(node, &ray, far, depth), depth, order);
        for (int i = 0; i < count; i++)
            if (node->child[order[i]] & GLINT_NODE_PRIM)
                R(cast_on_group)(args, g, rays, node->child[order[i]] & ~GLINT_NODE_PRIM);
        for (int i = count; i-- > 0;)
            if (!(node->child[order[i]] & GLINT_NODE_PRIM))
                stack[height++] = (walk_entry) { node->child[order[i]], depth[order[i]] };
    }
}

/// Walks the index once for a group of parallel rays.
static void R(walk_parallel)(const glint_cast_args *args, uint32_t g, const R(ray_group) * rays)
{
    const glint_geometry_table *geometry = args->geometry;
    float lower[3], upper[3];
    light_place ahead = { .directional = true };
    light_shaft shaft;
    for (int k = 0; k < 3; k++) {
        vf least = f_set(HUGE_VALF), most = f_set(-HUGE_VALF);
        widen(rays->local[k], args->active[g], &least, &most);
        ahead.lower[k] = ahead.upper[k] = rays->direction[k][0];
        lower[k] = f_min_all(least);
        upper[k] = f_max_all(most);
    }
    loosen(lower, upper, R(walk_slack)(geometry));
    make_shaft(lower, upper, &ahead, &shaft);
    uint32_t stack[WALK_STACK];
    int height = 0;
    stack[height++] = 0;
    while (height > 0) {
        const glint_node *node = &geometry->nodes[stack[--height]];
        for (unsigned mask = boxes_in_shaft(node, &shaft); mask; mask &= mask - 1) {
            const uint32_t child = node->child[__builtin_ctz(mask)];
            if (child & GLINT_NODE_PRIM)
                R(cast_on_group)(args, g, rays, child & ~GLINT_NODE_PRIM);
            else
                stack[height++] = child;
        }
    }
}

static void R(cast_rays)(const glint_cast_args *args)
{
    const glint_geometry_table *geometry = args->geometry;
    _Alignas(64) float local[3][GLINT_GROUP];
    R(ray_group) rays;
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        R(start_group)(args, g);
        R(index_frame)((const void *const *)args->origin, at, geometry, local);
        R(set_origins)((const void *const *)args->origin, at, (const float(*)[GLINT_GROUP])local, &rays);
        for (int k = 0; k < 3; k++)
            R(narrow)((const real *)args->direction[k] + at, rays.direction[k]);
        for (uint32_t i = 0; i < geometry->unbounded_count; i++)
            R(cast_on_group)(args, g, &rays, geometry->unbounded[i]);
        if (geometry->nodes && args->parallel)
            R(walk_parallel)(args, g, &rays);
        else if (geometry->nodes)
            for (unsigned lanes = args->active[g]; lanes; lanes &= lanes - 1)
                R(walk_ray)(args, g, &rays, __builtin_ctz(lanes));
        R(finish_group)(args, g);
    }
}
