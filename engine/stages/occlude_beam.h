// occlude_beam: where much lies between a tile and its light, the index is walked once with the tile's beam (beam.h), and
// what may block a segment is asked about the points in its cells alone. Contract: stages.h, occlude.

// ---- The decision ----

/// Nothing is between this point and the light any more that matters.
static inline void R(close_point)(R(beam) * beam, uint32_t i)
{
    const uint32_t at = beam->at[i], cell = beam->cell[i];
    float far = -HUGE_VALF;
    beam->tile->args->open[0][at / GLINT_GROUP] &= (uint16_t) ~(1u << at % GLINT_GROUP);
    beam->w[i] = -HUGE_VALF;
    beam->open--;
    for (uint32_t j = beam->begin[cell]; j < beam->begin[cell + 1]; j++)
        far = larger(far, beam->w[j]);
    beam->far[cell / SCREEN_ACROSS][cell % SCREEN_ACROSS] = far;
}

static unsigned R(batch_blocked)(const R(beam) * beam, const glint_prim *prim, unsigned wanted)
{
    const R(beam_batch) *batch = &beam->batch;
    const R(shadow_tile) *tile = beam->tile;
    const unsigned own = batch->own;
    if (prim->kind == GLINT_PRIM_TRIANGLE)
        return R(blocked_by_triangle)(&batch->args, prim, tile->position, 0, own, wanted);
    const R(light_sides) sides = R(seen_sides)(tile, NULL, prim);
    if (prim->kind == GLINT_PRIM_SOLID)
        return R(blocked_by_solid)(&batch->args, prim, tile->position, 0, own, wanted, sides.outside);
    unsigned blocked = own & batch->back & sides.outside;
    wanted &= ~own;
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = wanted >> i & ((1u << VR) - 1);
        vr d[3];
        if (!lanes)
            continue;
        R(directions_to)(&batch->args, tile->position, 0, i, d);
        blocked |= (R(lanes_blocked)(&batch->args, prim, sides, 0, i, d) & lanes) << i;
    }
    return blocked;
}

static void R(decide_batch)(R(beam) * beam, const glint_prim *prim)
{
    R(beam_batch) *batch = &beam->batch;
    if (!batch->count)
        return;
    for (unsigned blocked = R(batch_blocked)(beam, prim, (1u << batch->count) - 1); blocked; blocked &= blocked - 1)
        R(close_point)(beam, batch->from[__builtin_ctz(blocked)]);
    batch->count = 0;
    batch->own = 0;
    batch->back = 0;
}

static inline void R(add_to_batch)(R(beam) * beam, const glint_prim *prim, uint32_t i, bool own, bool back)
{
    const glint_occlude_args *args = beam->tile->args;
    R(beam_batch) *batch = &beam->batch;
    const uint32_t at = beam->at[i], g = at / GLINT_GROUP, lane = at % GLINT_GROUP;
    const int n = batch->count++;
    batch->from[n] = (uint16_t)i;
    batch->own |= (unsigned)own << n;
    batch->back |= (uint16_t)((unsigned)back << n);
    for (int k = 0; k < 3; k++)
        batch->point[k][n] = ((const real *)args->point[k])[at];
    if (prim->kind == GLINT_PRIM_TRIANGLE) {
        const uint32_t across = args->camera ? args->camera->groups_across : 1;
        const R(group_directions) viewing = R(directions_of)(args->camera, g % across, g / across);
        batch->slack[n] = ((const real *)args->slack)[at];
        for (int k = 0; k < 3; k++)
            batch->direction[k][n] = viewing.across
                                         ? viewing.across[k * GLINT_GROUP + lane] + viewing.down[k * GLINT_GROUP + lane]
                                         : ((const real *)args->direction[k])[at];
    }
    if (batch->count == GLINT_GROUP)
        R(decide_batch)(beam, prim);
}

// ---- The filter ----

/// What stands between points and light, perhaps.
typedef struct R(beam_blocker) {
    const glint_prim *prim;
    uint32_t id;
    float near; ///< least w of its box
    shape_on_screen shape;
    int light; ///< of a triangle: side_of_light
} R(beam_blocker);

/// Whether a point on the surface itself may be dark for that: what it is decided by in blocked.h, where float can tell.
static inline bool R(own_matters)(const R(beam_blocker) * b, bool back)
{
    return b->shape.is_triangle ? b->light != (back ? -1 : 1) : back;
}

/// Tests the points from `i` on and before `end`.
static void R(block_run)(R(beam) * beam, const R(beam_blocker) * b, uint32_t i, uint32_t end)
{
    const uint16_t *backs = beam->tile->args->back;
    for (; i < end; i += VF) {
        const vf u = f_load_any(beam->place[0] + i), v = f_load_any(beam->place[1] + i), w = f_load_any(beam->w + i);
        const unsigned in_run = end - i < VF ? (1u << (end - i)) - 1 : (1u << VF) - 1;
        const unsigned behind = fm_bits(f_le(f_set(b->near), w)) & in_run;
        if (!behind)
            continue;
        const unsigned own = behind & fm_bits(i_eq(f_bits(f_load_any((const float *)(beam->prim + i))), i_set(b->id)));
        unsigned near = near_shape(&b->shape, u, v, behind, own);
        for (; near; near &= near - 1) {
            const unsigned lane = (unsigned)__builtin_ctz(near);
            const uint32_t at = beam->at[i + lane];
            const bool is_own = own >> lane & 1, back = backs[at / GLINT_GROUP] >> at % GLINT_GROUP & 1;
            if (!is_own || R(own_matters)(b, back))
                R(add_to_batch)(beam, b->prim, i + lane, is_own, back);
        }
    }
}

static void R(block_cells)(R(beam) * beam, const glint_node *node, const node_on_screen *seen, int slot)
{
    const glint_geometry_table *geometry = beam->tile->args->geometry;
    const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
    const screen_cells cells = seen->cells[slot];
    R(beam_blocker) b = { .prim = &geometry->prims[id], .id = id, .near = seen->near[slot] };
    if (!any_behind((const float(*)[SCREEN_ACROSS])beam->far, b.near, cells))
        return;
    b.shape = shape_of(node, seen, slot, b.prim, geometry, &beam->view);
    if (b.shape.is_triangle)
        b.light = side_of_light(
            &b.shape, (const float[3]) { b.shape.middle[0], b.shape.middle[1], seen->middle[2][slot] }, &beam->view);
    const uint16_t *top = beam->begin + first_row(cells) * SCREEN_ACROSS;
    const uint16_t *bottom = beam->begin + last_row(cells) * SCREEN_ACROSS;
    const int first = first_column(cells), end = last_column(cells) + 1;
    if (end - first == SCREEN_ACROSS)
        R(block_run)(beam, &b, *top, bottom[SCREEN_ACROSS]);
    else
        for (; top <= bottom; top += SCREEN_ACROSS)
            R(block_run)(beam, &b, top[first], top[end]);
    R(decide_batch)(beam, b.prim);
}

// ---- The walk ----

static void R(walk_beam)(R(beam) * beam)
{
    const glint_geometry_table *geometry = beam->tile->args->geometry;
    screen_entry stack[WALK_STACK];
    node_on_screen seen;
    int height = 0;
    stack[height++] = entry_of_root(&beam->view);
    while (height > 0 && beam->open && !is_stopped(beam->tile->args->stop)) {
        const screen_entry top = stack[--height];
        if (!any_behind((const float(*)[SCREEN_ACROSS])beam->far, top.near, top.cells))
            continue;
        const glint_node *node = &geometry->nodes[top.node];
        const unsigned mask = boxes_on_screen(node, &beam->view, &seen);
        prefetch_prims(geometry, node, mask & prims_of_node(node));
        for (unsigned left = mask; left; left &= left - 1)
            if (!(node->child[__builtin_ctz(left)] & GLINT_NODE_PRIM))
                stack[height++] = entry_of(node, &seen, __builtin_ctz(left));
        if (height > 0)
            prefetch_node(&geometry->nodes[stack[height - 1].node]);
        for (unsigned left = mask; left; left &= left - 1)
            if (node->child[__builtin_ctz(left)] & GLINT_NODE_PRIM)
                R(block_cells)(beam, node, &seen, __builtin_ctz(left));
    }
}

static void R(begin_batch)(const glint_occlude_args *args, R(beam_batch) * batch)
{
    batch->count = 0;
    batch->own = 0;
    batch->back = 0;
    batch->args = *args;
    batch->args.camera = NULL;
    batch->args.back = &batch->back;
    batch->args.slack = batch->slack;
    for (int k = 0; k < 3; k++) {
        batch->args.point[k] = batch->point[k];
        batch->args.direction[k] = batch->direction[k];
    }
    for (int i = 0; i < GLINT_GROUP; i++) // lanes without a point are computed too
        for (int k = 0; k < 3; k++)
            batch->point[k][i] = batch->direction[k][i] = batch->slack[i] = 0;
}

/// Takes out of args->open what the index blocks. False: no beam can be made of these points, and nothing is done.
static bool R(occlude_beam)(const R(shadow_tile) * tile)
{
    const glint_occlude_args *args = tile->args;
    R(beam_places) places;
    R(beam) beam;
    beam.tile = tile;
    if (!R(aim_beam)(tile, &beam.view))
        return false;
    if (!R(project_points)(tile, args->open[0], &beam.view, &places))
        return false;
    R(sort_points)(&beam, args->open[0], &places);
    R(begin_batch)(args, &beam.batch);
    R(walk_beam)(&beam);
    return true;
}

// ---- One light without size ----

/// Where there are too many occluders for a list.
static void R(occlude_many)(const R(shadow_tile) * tile, R(shadow_group) * group)
{
    const glint_occlude_args *args = tile->args;
    uint16_t *open = args->open[0];
    for (uint32_t g = 0; g < args->group_count; g++) {
        R(begin_group)(g, group);
        open[g] = (uint16_t)R(test_unbounded)(tile, NULL, group, open[g]);
    }
    if (!args->geometry->nodes || R(occlude_beam)(tile))
        return;
    group->last_blocker = GLINT_MISS;
    for (uint32_t g = 0; g < args->group_count; g++)
        if (open[g]) {
            R(begin_group)(g, group);
            open[g] = (uint16_t)R(walk_group)(tile, NULL, group, open[g]);
        }
}

static void R(occlude_point)(const glint_occlude_args *args)
{
    uint16_t *out = args->open[0];
    R(shadow_tile) tile;
    R(shadow_group) group = { .last_blocker = GLINT_MISS };
    R(begin_shadows)(args, args->lit[0], &tile);
    for (uint32_t g = 0; g < args->group_count; g++) {
        out[g] = args->lit[0][g];
        *args->rays += (unsigned)__builtin_popcount(out[g]);
    }
    if (!tile.count)
        return;
    R(aim_at)(&tile, NULL);
    if (tile.count > GLINT_OCCLUDERS) {
        R(occlude_many)(&tile, &group);
        return;
    }
    for (uint32_t g = 0; g < args->group_count; g++) {
        unsigned open = out[g];
        R(begin_group)(g, &group);
        for (int k = 0; k < tile.count && open; k++)
            open &= ~R(blocked_by)(&tile, tile.occluders[k], &group, open);
        out[g] = (uint16_t)open;
    }
}
