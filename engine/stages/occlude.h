// occlude: which points a light reaches. Always decided from the point towards the light, without a root or a
// division: the segment meets a sphere when one end is inside and the other outside, or when both are outside, the
// foot of the perpendicular lies between them and the discriminant is not negative. Contract: stages.h.
//
// A tile's segments are a bundle seen from the light: the index is walked once for all of them. Where too much lies
// between, each group walks with its own, thinner shaft.

#define GLINT_OCCLUDERS 12 ///< what a tile's list holds
#define GLINT_SHAFTS_TRIED 3 ///< groups in a row that may give up their shaft before no more is tried in the tile
#define GLINT_SHAFT_NODES 16 ///< what a group's shaft may see of the index before each lane walks by itself

/// A primitive between the tile and the light.
typedef struct R(occluder) {
    uint32_t id;
    int light_side;
} R(occluder);

/// What the groups of one call share.
typedef struct R(shadow_tile) {
    const glint_occlude_args *args;
    float light[3]; ///< position, or direction towards it, in the index's frame
    R(occluder) occluders[GLINT_OCCLUDERS];
    int count; ///< more than GLINT_OCCLUDERS: too many, groups walk by themselves
    _Alignas(64) float local[GLINT_TILE_GROUPS][3][GLINT_GROUP]; ///< the points of lit groups, in the index's frame
} R(shadow_tile);

/// A group's shadow rays; made as soon as one needs them.
typedef struct R(shadow_group) {
    size_t at;
    bool made;
    uint32_t last_blocker; ///< of the groups so far, or GLINT_MISS
    int shafts_failed; ///< of the last groups in a row
    _Alignas(64) real to_light[3][GLINT_GROUP]; ///< in the light's units
    R(ray_group) rays;
    uint32_t surface[GLINT_GROUP]; ///< the coincident of the primitive each ray leaves
} R(shadow_group);

/// On which side of the primitive the light is.
static int R(light_side)(const glint_occlude_args *args, const glint_prim *prim)
{
    double f[3], height;
    for (int k = 0; k < 3; k++)
        f[k] = args->position[k] - prim->center[k];
    if (prim->kind == GLINT_PRIM_PLANE) {
        height = args->directional ? DOT(prim->normal, args->position) : DOT(prim->normal, f);
    } else {
        for (int k = 0; k < 3; k++)
            f[k] *= prim->scale;
        const double length2 = DOT(f, f); // a few roundings off
        if (args->directional || !(length2 < prim->r2 * (1 + 1e-12)))
            return 1;
        if (length2 < prim->r2 * (1 - 1e-12))
            return -1;
        const vd v[3] = { d_set(f[0]), d_set(f[1]), d_set(f[2]) };
        _Alignas(64) double c[VD];
        d_store(c, exact_c_f64(v, prim));
        height = c[0];
    }
    return (height > 0) - (height < 0);
}

static inline void R(begin_group)(const R(shadow_tile) * tile, uint32_t g, R(shadow_group) * group)
{
    const glint_occlude_args *args = tile->args;
    group->at = (size_t)g * GLINT_GROUP;
    group->made = false;
    if (args->geometry->duplicates)
        for (unsigned lit = args->lit[g]; lit; lit &= lit - 1) {
            const int lane = __builtin_ctz(lit);
            group->surface[lane] = args->geometry->prims[args->prim[group->at + (size_t)lane]].coincident;
        }
}

static inline void R(make_shadow_rays)(const R(shadow_tile) * tile, R(shadow_group) * group)
{
    const glint_occlude_args *args = tile->args;
    const size_t at = group->at;
    for (int i = 0; i < GLINT_GROUP; i += VR)
        for (int k = 0; k < 3; k++) {
            vr d = r_set(args->position[k]);
            if (!args->directional)
                d = (d - r_load((const real *)args->point[k] + at + i)) * r_set(args->scale);
            r_store(group->to_light[k] + i, d);
            r_store_f(group->rays.direction[k] + i, d);
        }
    R(set_origins)(args->point, at, tile->local[at / GLINT_GROUP], &group->rays);
    group->made = true;
}

/// Lanes of `lit` that leave the primitive's surface.
static inline unsigned R(own_lanes)(const glint_occlude_args *args, const R(shadow_group) * group,
                                    const glint_prim *prim, uint32_t id, unsigned lit)
{
    if (!args->geometry->duplicates)
        return lanes_equal(args->prim + group->at, id) & lit;
    unsigned own = 0;
    for (unsigned left = lit; left; left &= left - 1)
        if (group->surface[__builtin_ctz(left)] == prim->coincident)
            own |= left & -left;
    return own;
}

static inline rm R(sphere_blocks)(const glint_occlude_args *args, const glint_prim *prim, int light_side,
                                  const R(shadow_group) * group, int i)
{
    const vr zero = r_set(0), scale = r_set(prim->scale);
    vr p[3], f[3], d[3];
    R(load3)(args->point, group->at + i, p);
    R(offset)(p, prim, f);
    for (int k = 0; k < 3; k++)
        d[k] = r_load(group->to_light[k] + i);
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

static inline rm R(plane_blocks)(const glint_occlude_args *args, const glint_prim *prim, int light_side,
                                 const R(shadow_group) * group, int i)
{
    vr p[3], e[3];
    R(load3)(args->point, group->at + i, p);
    R(offset)(p, prim, e);
    const vr n[3] = { r_set(prim->normal[0]), r_set(prim->normal[1]), r_set(prim->normal[2]) };
    vr h = DOT(n, e);
    if (light_side > 0)
        return r_lt(h, r_set(0));
    return light_side < 0 ? r_lt(r_set(0), h) : rm_from_bits(0);
}

/// The lanes of `wanted` that the primitive blocks.
static inline unsigned R(blocked_by)(const R(shadow_tile) * tile, R(occluder) occluder, R(shadow_group) * group,
                                     unsigned wanted)
{
    const glint_occlude_args *args = tile->args;
    const glint_prim *prim = &args->geometry->prims[occluder.id];
    const bool sphere = prim->kind == GLINT_PRIM_SPHERE;
    const unsigned own = R(own_lanes)(args, group, prim, occluder.id, wanted);
    unsigned blocked = 0;
    if (own && sphere && occluder.light_side > 0)
        blocked = own & args->back[group->at / GLINT_GROUP];
    wanted &= ~own;
    if (!wanted)
        return blocked;
    if (!group->made)
        R(make_shadow_rays)(tile, group);
    if (occluder.light_side >= 0) // with the light inside, being outside is enough: no distance is asked
        wanted &= R(near_rays)(&group->rays, prim);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = wanted >> i & ((1u << VR) - 1);
        if (!lanes)
            continue;
        rm hit = sphere ? R(sphere_blocks)(args, prim, occluder.light_side, group, i)
                        : R(plane_blocks)(args, prim, occluder.light_side, group, i);
        blocked |= (rm_bits(hit) & lanes) << i;
    }
    return blocked;
}

// ---- What lies between the tile and the light ----

/// Whether a plane that touches the sphere keeps the whole shaft on its other side: then it blocks nothing.
static bool R(sphere_apart)(const glint_prim *prim, const float lower[3], const float upper[3], const float light[3],
                            bool directional)
{
    float middle[3], half[3], way[3], e[3], along = 0, length2 = 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5f * (lower[k] + upper[k]);
        half[k] = upper[k] - middle[k];
        way[k] = directional ? light[k] : light[k] - middle[k];
        e[k] = middle[k] - prim->filter_center[k];
        along -= e[k] * way[k];
        length2 += way[k] * way[k];
    }
    along = larger(along / length2, 0);
    if (!directional)
        along = smaller(along, 1);
    for (int k = 0; k < 3; k++)
        e[k] += along * way[k];
    // e: from the centre to the nearest point of the middle segment
    float size = 0, at_points = 0, at_light = 0;
    for (int k = 0; k < 3; k++) {
        size += (fabsf(middle[k]) + fabsf(prim->filter_center[k])) + fabsf(light[k]);
        at_points += e[k] * (middle[k] - prim->filter_center[k]) - fabsf(e[k]) * half[k];
        at_light += directional ? e[k] * light[k] : e[k] * (light[k] - prim->filter_center[k]);
    }
    const float length = sqrtf(DOT(e, e)), slack = 4 * WALK_SLACK * size * length;
    const float bound = prim->filter_bound * length + slack;
    return at_points > bound && at_light > (directional ? slack : bound);
}

/// Notes an occluder of the tile; false: there is no more room.
static inline bool R(note_occluder)(R(shadow_tile) * tile, uint32_t id)
{
    if (tile->count++ >= GLINT_OCCLUDERS)
        return false;
    const glint_prim *prim = &tile->args->geometry->prims[id];
    tile->occluders[tile->count - 1] = (R(occluder)) { id, R(light_side)(tile->args, prim) };
    return true;
}

static void R(find_occluders)(R(shadow_tile) * tile, float lower[3], float upper[3])
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const bool directional = tile->args->directional;
    uint32_t stack[WALK_STACK];
    int height = 0;
    light_shaft shaft;
    for (uint32_t i = 0; i < geometry->unbounded_count; i++)
        if (!R(note_occluder)(tile, geometry->unbounded[i]))
            return;
    if (!geometry->nodes)
        return;
    loosen(lower, upper, R(walk_slack)(geometry));
    make_shaft(lower, upper, tile->light, directional, &shaft);
    stack[height++] = 0;
    while (height > 0) {
        const glint_node *node = &geometry->nodes[stack[--height]];
        for (unsigned mask = boxes_in_shaft(node, &shaft); mask; mask &= mask - 1) {
            const uint32_t child = node->child[__builtin_ctz(mask)], id = child & ~GLINT_NODE_PRIM;
            if (!(child & GLINT_NODE_PRIM))
                stack[height++] = child;
            else if (!R(sphere_apart)(&geometry->prims[id], lower, upper, tile->light, directional) &&
                     !R(note_occluder)(tile, id))
                return;
        }
    }
}

/// Whether the light is outside the sphere for certain, by what the filter knows.
static inline bool R(light_outside)(const R(shadow_tile) * tile, const glint_prim *prim)
{
    float distance2 = 0, size = 0;
    if (prim->kind != GLINT_PRIM_SPHERE || tile->args->directional)
        return prim->kind == GLINT_PRIM_SPHERE;
    for (int k = 0; k < 3; k++) {
        const float d = tile->light[k] - prim->filter_center[k];
        distance2 += d * d;
        size += fabsf(tile->light[k]);
    }
    const float reach = prim->filter_bound + WALK_SLACK * size;
    return distance2 > reach * reach * (1 + 1e-5f);
}

/// Tests a primitive that a walk came upon. Returns the lanes that are still open.
static inline unsigned R(test_occluder)(const R(shadow_tile) * tile, R(shadow_group) * group, uint32_t id,
                                        unsigned open)
{
    const glint_prim *prim = &tile->args->geometry->prims[id];
    const R(occluder) occluder = { id, R(light_outside)(tile, prim) ? 1 : R(light_side)(tile->args, prim) };
    const unsigned blocked = R(blocked_by)(tile, occluder, group, open);
    if (blocked)
        group->last_blocker = id;
    return open & ~blocked;
}

/// Walks with the shaft of a group, and gives up where it has many nodes to see: *done tells.
static unsigned R(walk_shaft)(const R(shadow_tile) * tile, R(shadow_group) * group, unsigned open, bool *done)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const float(*local)[GLINT_GROUP] = tile->local[group->at / GLINT_GROUP];
    float lower[3], upper[3];
    uint32_t stack[WALK_STACK];
    int height = 0;
    light_shaft shaft;
    for (int k = 0; k < 3; k++) {
        vf least = f_set(HUGE_VALF), most = f_set(-HUGE_VALF);
        widen(local[k], open, &least, &most);
        lower[k] = f_min_all(least);
        upper[k] = f_max_all(most);
    }
    loosen(lower, upper, R(walk_slack)(geometry));
    make_shaft(lower, upper, tile->light, tile->args->directional, &shaft);
    stack[height++] = 0;
    for (int nodes = 0; height > 0 && open; nodes++) {
        if (nodes == GLINT_SHAFT_NODES) {
            *done = false;
            return open;
        }
        const glint_node *node = &geometry->nodes[stack[--height]];
        for (unsigned mask = boxes_in_shaft(node, &shaft); mask && open; mask &= mask - 1) {
            const uint32_t child = node->child[__builtin_ctz(mask)];
            if (child & GLINT_NODE_PRIM)
                open = R(test_occluder)(tile, group, child & ~GLINT_NODE_PRIM, open);
            else
                stack[height++] = child;
        }
    }
    *done = true;
    return open;
}

/// Walks with the segment of one lane. What it comes upon is tested against all lanes that are open.
static unsigned R(walk_lane)(const R(shadow_tile) * tile, R(shadow_group) * group, int lane, unsigned open)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const float(*local)[GLINT_GROUP] = tile->local[group->at / GLINT_GROUP];
    const float far = tile->args->directional ? HUGE_VALF : 1;
    ray_view ray = { .slack = R(walk_slack)(geometry) };
    uint32_t stack[WALK_STACK];
    int height = 0;
    for (int k = 0; k < 3; k++) {
        ray.origin[k] = local[k][lane];
        ray.inverse[k] = 1 / (tile->args->directional ? tile->light[k] : tile->light[k] - local[k][lane]);
        // the light's own rounding: as if the box were that much larger
        ray.slack = larger(ray.slack, WALK_SLACK * fabsf(tile->light[k]));
    }
    stack[height++] = 0;
    while (height > 0) {
        _Alignas(64) float depth[GLINT_NODE_WIDTH];
        const glint_node *node = &geometry->nodes[stack[--height]];
        for (unsigned mask = boxes_on_ray(node, &ray, far, depth); mask; mask &= mask - 1) {
            const uint32_t child = node->child[__builtin_ctz(mask)];
            if (!(child & GLINT_NODE_PRIM)) {
                stack[height++] = child;
                continue;
            }
            open = R(test_occluder)(tile, group, child & ~GLINT_NODE_PRIM, open);
            if (!(open >> lane & 1))
                return open;
        }
    }
    return open;
}

/// The lanes of `open` that nothing blocks, for a group that walks by itself.
static unsigned R(walk_group)(const R(shadow_tile) * tile, R(shadow_group) * group, unsigned open)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    bool done = !geometry->nodes;
    if (group->last_blocker != GLINT_MISS) // often in the way of the next group too
        open = R(test_occluder)(tile, group, group->last_blocker, open);
    for (uint32_t i = 0; i < geometry->unbounded_count && open; i++)
        open = R(test_occluder)(tile, group, geometry->unbounded[i], open);
    if (open && !done && group->shafts_failed < GLINT_SHAFTS_TRIED) {
        open = R(walk_shaft)(tile, group, open, &done);
        group->shafts_failed = done ? 0 : group->shafts_failed + 1;
    }
    for (unsigned left = open; left && !done; left &= (left - 1) & open)
        open = R(walk_lane)(tile, group, __builtin_ctz(left), open);
    return open;
}

static void R(begin_shadows)(const glint_occlude_args *args, R(shadow_tile) * tile)
{
    const glint_geometry_table *geometry = args->geometry;
    vf least[3], most[3];
    float lower[3], upper[3];
    bool any = false;
    tile->args = args;
    tile->count = 0;
    for (int k = 0; k < 3; k++) {
        least[k] = f_set(HUGE_VALF);
        most[k] = f_set(-HUGE_VALF);
        tile->light[k] = (float)(args->directional ? args->position[k]
                                                   : (args->position[k] - geometry->reference[k]) * geometry->scale);
    }
    for (uint32_t g = 0; g < args->group_count; g++) {
        if (!args->lit[g])
            continue;
        R(index_frame)(args->point, (size_t)g * GLINT_GROUP, geometry, tile->local[g]);
        for (int k = 0; k < 3; k++)
            widen(tile->local[g][k], args->lit[g], &least[k], &most[k]);
        any = true;
    }
    if (!any)
        return;
    for (int k = 0; k < 3; k++) {
        lower[k] = f_min_all(least[k]);
        upper[k] = f_max_all(most[k]);
    }
    R(find_occluders)(tile, lower, upper);
}

static void R(occlude)(const glint_occlude_args *args)
{
    R(shadow_tile) tile;
    R(shadow_group) group = { .last_blocker = GLINT_MISS };
    R(begin_shadows)(args, &tile);
    for (uint32_t g = 0; g < args->group_count; g++) {
        unsigned open = args->lit[g];
        *args->rays += (unsigned)__builtin_popcount(open);
        if (open && tile.count) {
            R(begin_group)(&tile, g, &group);
            if (tile.count > GLINT_OCCLUDERS)
                open = R(walk_group)(&tile, &group, open);
            else
                for (int k = 0; k < tile.count && open; k++)
                    open &= ~R(blocked_by)(&tile, tile.occluders[k], &group, open);
        }
        args->open[g] = (uint16_t)open;
    }
}
