// balls: a sphere against all groups of a tile that it may show in. Which vectors of lanes it comes near is found for all of them
// before the first is decided, and decided without a question in between: no vector waits for what another says. Contract: stages.h,
// cast.

/// VR lanes of a group that a sphere comes near.
typedef struct R(near_part) {
    uint16_t at; ///< the first of them, in the tile
    uint16_t across, down; ///< where the parts of their directions are, see group_directions
} R(near_part);

/// What of a tile a sphere comes near.
typedef struct R(near_ball) {
    int groups, parts;
    unsigned lanes;
    uint8_t column[GLINT_TILE_GROUPS], row[GLINT_TILE_GROUPS]; ///< of each group
    R(near_part) part[GLINT_TILE_SAMPLES / VR];
} R(near_ball);

/// Groups of some cells in which something as far away as `near` still matters.
static inline uint64_t R(groups_behind)(const R(tile_cast) * tile, screen_cells cells, float near)
{
    const unsigned columns = bit_range(first_column(cells), last_column(cells));
    uint64_t groups = 0;
    for (int y = first_row(cells); y <= last_row(cells); y++)
        groups |= (uint64_t)behind_in_row((const float(*)[SCREEN_ACROSS])tile->far, y, near, columns) << y * COVER_ACROSS;
    return groups;
}

/// Lanes of group (x, y) that may meet the shape before what they have met, from its box on, whose depth is `near`.
INNER unsigned R(lanes_near_shape)(const R(tile_cast) * tile, const shape_on_screen *shape, float near, int x, int y)
{
    unsigned lanes = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const unsigned open = fm_bits(f_le(f_set(near), f_load(tile->depth[y * tile->across + x] + i)));
        lanes |= (open & near_shape(shape, f_load(tile->s[x] + i), -f_load(tile->t[y] + i))) << i;
    }
    return lanes;
}

/// Of the groups whose cells its box shows in, `depth` far away, those in which it may be seen.
INNER void R(find_near_ball)(const R(tile_cast) * tile, const glint_node *node, const node_on_screen *seen, int slot,
                             R(near_ball) * near)
{
    const float depth = seen->near[slot];
    const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
    near->groups = near->parts = 0;
    near->lanes = 0;
    uint64_t groups = R(groups_behind)(tile, seen->cells[slot], depth);
    if (!groups)
        return;
    const shape_on_screen shape = shape_of(node, seen, slot, &tile->args->geometry->prims[id], &tile->view);
    for (; groups; groups &= groups - 1) {
        const int place = __builtin_ctzll(groups), x = place % COVER_ACROSS, y = place / COVER_ACROSS, g = y * tile->across + x;
        const unsigned lanes = R(lanes_near_shape)(tile, &shape, depth, x, y);
        near->column[near->groups] = (uint8_t)x;
        near->row[near->groups] = (uint8_t)y;
        near->groups += lanes != 0;
        near->lanes += (unsigned)__builtin_popcount(lanes);
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            near->part[near->parts] = (R(near_part)) { (uint16_t)(g * GLINT_GROUP + i), (uint16_t)(x * 3 * GLINT_GROUP + i),
                                                       (uint16_t)(y * 3 * GLINT_GROUP + i) };
            near->parts += (lanes >> i & ((1u << VR) - 1)) != 0;
        }
    }
}

/// Decides it for rays from one eye.
INNER void R(decide_ball_of_eye)(const R(tile_cast) * tile, uint32_t id, const R(near_ball) * near)
{
    const glint_cast_args *args = tile->args;
    R(candidate) ball;
    R(place_candidate)(args, id, &ball);
    const vr f[3] = { r_set(ball.f[0]), r_set(ball.f[1]), r_set(ball.f[2]) };
    const vr c = r_set(ball.c), r2 = r_set(ball.r2), scale = r_set(ball.scale);
    for (int n = 0; n < near->parts; n++) {
        const R(near_part) part = near->part[n];
        const real *across = (const real *)args->camera->across + part.across, *down = (const real *)args->camera->down + part.down;
        vr d[3], t;
        for (int k = 0; k < 3; k++)
            d[k] = r_load(across + k * GLINT_GROUP) + r_load(down + k * GLINT_GROUP);
        const rm hit = R(meet_ball)(f, d, DOT(d, d), c, r2, scale, &t);
        R(keep_nearest)(args, part.at, id, hit, t);
    }
}

/// Decides it for parallel rays.
INNER void R(decide_ball_of_parallels)(const R(tile_cast) * tile, uint32_t id, const R(near_ball) * near)
{
    const glint_cast_args *args = tile->args;
    const glint_prim *prim = &args->geometry->prims[id];
    const R(ball) ball = R(ball_of)(prim);
    vr center[3], d[3];
    for (int k = 0; k < 3; k++) {
        center[k] = r_set(prim->center[k]);
        d[k] = r_set(args->camera->forward[k]);
    }
    const vr a = DOT(d, d);
    for (int n = 0; n < near->parts; n++) {
        const size_t at = near->part[n].at;
        vr f[3], t;
        for (int k = 0; k < 3; k++)
            f[k] = (r_load((const real *)args->origin[k] + at) - center[k]) * ball.scale;
        const vr c = R(exact_power)(f, ball.r2, ball.r2_low);
        const rm hit = R(meet_ball)(f, d, a, c, ball.r2, ball.scale, &t);
        R(keep_nearest)(args, at, id, hit, t);
    }
}

/// Casts the sphere in a slot of a node. The rays do not start on a lens.
static void R(cast_ball)(R(tile_cast) * tile, const glint_node *node, const node_on_screen *seen, int slot)
{
    const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
    R(near_ball) near;
    R(find_near_ball)(tile, node, seen, slot, &near);
    if (!near.groups)
        return;
    if (tile->args->tests)
        *tile->args->tests += near.lanes;
    if (tile->parallel)
        R(decide_ball_of_parallels)(tile, id, &near);
    else
        R(decide_ball_of_eye)(tile, id, &near);
    for (int n = 0; n < near.groups; n++)
        R(note_depth)(tile, near.column[n], near.row[n]);
}
