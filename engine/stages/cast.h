// cast: the nearest hit of each ray from the eye. The tile walks the index once, nearest boxes first, and tests what it
// finds group by group. Contract: stages.h.

/// The only candidate of a group: what it does not hit, nothing does.
static inline void R(cast_alone)(const R(tile_cast) * tile, const R(candidate) * candidate, int x, int y, unsigned near)
{
    const glint_cast_args *args = tile->args;
    const uint32_t g = (uint32_t)(y * tile->across + x);
    const size_t at = (size_t)g * GLINT_GROUP;
    const vr f[3] = { r_set(candidate->f[0]), r_set(candidate->f[1]), r_set(candidate->f[2]) };
    const R(group_directions) directions = R(directions_of)(args->camera, (uint32_t)x, (uint32_t)y);
    unsigned hits = 0;
    near &= args->active[g];
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = near >> i & ((1u << VR) - 1);
        vr d[3], t = r_set(HUGE_VAL);
        rm hit = rm_from_bits(0);
        if (lanes) {
            R(load_direction)(directions, args->direction, 0, i, d);
            hit = rm_and(rm_from_bits(lanes), R(meet_candidate)(args, candidate, f, d, &t));
            hit = rm_and(hit, r_lt(t, r_set(HUGE_VAL)));
        }
        r_store((real *)args->t + at + i, r_select(hit, t, r_set(HUGE_VAL)));
        hits |= rm_bits(hit) << i;
    }
    for (int i = 0; i < GLINT_GROUP; i += VF)
        i_store(args->prim + at + i,
                f_bits(f_select(fm_from_bits(hits >> i & ((1u << VF) - 1)), f_from_bits(i_set(candidate->id)),
                                f_from_bits(i_set(GLINT_MISS)))));
    args->hits[g] = (uint16_t)hits;
}

/// One group and the first candidates of its tile.
static inline void R(begin_group_cast)(R(tile_cast) * tile, const R(candidate) * candidates, int count, int x, int y)
{
    const uint32_t g = (uint32_t)(y * tile->across + x);
    unsigned near[GLINT_FIRST_CANDIDATES];
    int order[GLINT_FIRST_CANDIDATES], found = 0;
    for (int k = 0; k < count; k++) {
        if (!(candidates[k].columns >> x & candidates[k].rows >> y & 1))
            continue;
        near[found] = R(near_pixels)(tile, &candidates[k], x, y);
        order[found] = k;
        found += near[found] != 0;
    }
    if (found == 1 && !tile->deep) {
        R(cast_alone)(tile, &candidates[order[0]], x, y, near[0]);
        return;
    }
    R(start_group)(tile->args, g);
    for (int k = 0; k < found; k++)
        if (R(decide_pixels)(tile, &candidates[order[k]], x, y, near[k]))
            tile->stale |= (uint64_t)1 << g;
    if (!tile->deep)
        R(finish_group)(tile->args, g);
}

/// Whether every group that the candidate may show in has hits in front of its box.
static bool R(hidden)(R(tile_cast) * tile, const R(candidate) * candidate)
{
    for (unsigned rows = candidate->rows; tile->deep && rows; rows &= rows - 1)
        for (unsigned columns = candidate->columns; columns; columns &= columns - 1) {
            const int g = __builtin_ctz(rows) * tile->across + __builtin_ctz(columns);
            if (!(R(far_of_group)(tile, g) < candidate->depth))
                return false;
        }
    return tile->deep;
}

/// Looks into one node: its primitives become candidates, its nodes go on the stack, the nearest on top. Returns how
/// many candidates.
static int R(open_node)(R(tile_cast) * tile, const glint_node *node, float far, R(candidate) * candidates,
                        walk_entry *stack, int *height)
{
    _Alignas(64) float depth[GLINT_NODE_WIDTH];
    int order[GLINT_NODE_WIDTH], found = 0;
    node_on_screen screen;
    const int count = sort_slots(boxes_in_tile(node, &tile->view, far, depth), depth, order);
    bool known = false;
    for (int i = 0; i < count; i++) {
        const uint32_t child = node->child[order[i]];
        if (!(child & GLINT_NODE_PRIM))
            continue;
        if (!known)
            boxes_on_screen(node, &tile->view, tile->across, tile->down, &screen);
        known = true;
        R(candidate) *candidate = &candidates[found];
        candidate->columns = bit_range((int)screen.first[0][order[i]], (int)screen.last[0][order[i]]);
        candidate->rows = bit_range((int)screen.first[1][order[i]], (int)screen.last[1][order[i]]);
        candidate->depth = depth[order[i]];
        if (!candidate->columns || !candidate->rows || R(hidden)(tile, candidate))
            continue;
        R(make_candidate)(tile, child & ~GLINT_NODE_PRIM, candidate);
        found++;
    }
    for (int i = count; i-- > 0;)
        if (!(node->child[order[i]] & GLINT_NODE_PRIM))
            stack[(*height)++] = (walk_entry) { node->child[order[i]], depth[order[i]] };
    return found;
}

/// Makes candidates of the planes from number *next on that are ahead, as many as there is room for.
static int R(open_planes)(R(tile_cast) * tile, uint32_t *next, R(candidate) * candidates, int room)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    int found = 0;
    for (; *next < geometry->unbounded_count && found < room; ++*next) {
        const uint32_t id = geometry->unbounded[*next];
        if (!R(plane_ahead)(tile->args->camera, &tile->view, &geometry->prims[id]))
            continue;
        candidates[found].columns = bit_range(0, tile->across - 1);
        candidates[found].rows = bit_range(0, tile->down - 1);
        candidates[found].depth = 0;
        R(make_candidate)(tile, id, &candidates[found++]);
    }
    return found;
}

static void R(cast_bundle)(const glint_cast_args *args)
{
    const glint_geometry_table *geometry = args->geometry;
    R(tile_cast) tile;
    R(candidate) candidates[GLINT_FIRST_CANDIDATES];
    walk_entry stack[WALK_STACK];
    int height = 0, count = 0;
    uint32_t planes = 0;
    R(begin_tile)(args, &tile);
    if (geometry->nodes)
        count = R(open_node)(&tile, geometry->nodes, HUGE_VALF, candidates, stack, &height);
    count += R(open_planes)(&tile, &planes, candidates + count, GLINT_FIRST_CANDIDATES - count);
    tile.deep = height > 0 || planes < geometry->unbounded_count;
    for (int y = 0; y < tile.down; y++) {
        R(begin_row)(&tile, candidates, count, y);
        for (int x = 0; x < tile.across; x++)
            R(begin_group_cast)(&tile, candidates, count, x, y);
    }
    if (!tile.deep)
        return;
    while ((count = R(open_planes)(&tile, &planes, candidates, GLINT_FIRST_CANDIDATES)) > 0)
        R(cast_candidates)(&tile, candidates, count);
    while (height > 0 && !is_stopped(args->stop)) {
        const walk_entry top = stack[--height];
        const float far = R(far_of_tile)(&tile);
        if (far < top.depth)
            continue;
        count = R(open_node)(&tile, &geometry->nodes[top.node], far, candidates, stack, &height);
        R(cast_candidates)(&tile, candidates, count);
    }
    for (uint32_t g = 0; g < args->group_count; g++)
        R(finish_group)(args, g);
}
