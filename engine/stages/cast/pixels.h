// pixels: what rays of a camera meet whose pixels are given one by one, as adaptive sampling gathers them. Where primitives are few,
// each is tested against every ray; else the rays walk the index together as those of a tile do, over a screen of smaller cells, each
// of which knows the groups that have a ray in it. Contract: stages.h.

/// Decides a sphere for all lanes of a group of pixels wherever they are.
INNER void R(decide_ball)(const glint_cast_args *args, const R(candidate) * ball, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    const vr f[3] = { r_set(ball->f[0]), r_set(ball->f[1]), r_set(ball->f[2]) };
    const R(group_directions) directions = R(directions_of)(args->camera, 0, g);
    count_tests(args->tests, args->active[g]);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        vr d[3], t;
        R(load_direction)(directions, args->direction, 0, i, d);
        const vr a = DOT(d, d), b = -DOT(f, d);
        if (!rm_bits(r_le(r_set(0), R(discriminant)(f, d, a, b, r_set(ball->c), r_set(ball->r2)))))
            continue;
        const rm hit = R(meet_ball)(f, d, a, r_set(ball->c), r_set(ball->r2), r_set(ball->scale), &t);
        if (rm_bits(hit))
            R(keep_nearest)(args, at + (size_t)i, ball->id, hit, t);
    }
}

// ---- Of few primitives ----

#define PIXEL_CANDIDATES 16 ///< more are not tested against every ray

/// Decides a candidate for all rays of pixels wherever they are.
static void R(cast_to_pixels)(R(tile_cast) * tile, const R(candidate) * candidate)
{
    const glint_cast_args *args = tile->args;
    for (uint32_t g = 0; g < args->group_count; g++)
        if (candidate->prim->kind == GLINT_PRIM_SPHERE)
            R(decide_ball)(args, candidate, g);
        else
            R(decide_pixels)(tile, candidate, 0, (int)g, args->active[g]);
}

/// Of a scene with few primitives.
static void R(cast_few_to_pixels)(const glint_cast_args *args, const R(cast_view) * view, const glint_camera_args *around)
{
    const R(candidate) * list[GLINT_FIRST_CANDIDATES];
    R(tile_cast) tile;
    const int count = R(candidates_in)(view, around, list, view->count);
    tile.args = args;
    tile.across = 1;
    for (uint32_t g = 0; g < args->group_count; g++)
        R(start_group)(args, g);
    for (int k = 0; k < count; k++)
        R(cast_to_pixels)(&tile, list[k]);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(finish_group)(args, g);
}

// ---- Of many primitives ----

#define PIXEL_ROWS (GLINT_TILE_HEIGHT / GLINT_PIXEL_CELL)

_Static_assert(SCREEN_ACROSS == 1 << 4, "place_pixels makes numbers of cells of it");

/// Groups whose pixels lie anywhere in a tile.
typedef struct R(pixel_groups) {
    _Alignas(64) float s[GLINT_TILE_GROUPS][GLINT_GROUP], t[GLINT_TILE_GROUPS][GLINT_GROUP]; ///< places of the rays
    uint64_t in_cell[PIXEL_ROWS][SCREEN_ACROSS]; ///< groups with a ray in it, a bit each
    _Alignas(64) uint32_t cell[GLINT_TILE_GROUPS][GLINT_GROUP]; ///< of each ray: SCREEN_ACROSS times the row, and the column
    uint16_t turns[GLINT_TILE_GROUPS]; ///< lanes whose cell is another than that of the lane before; the first is
    float far[GLINT_TILE_GROUPS]; ///< as of a tile's groups
} R(pixel_groups);

static void R(note_cells)(R(tile_cast) * tile, int g, float far)
{
    R(pixel_groups) *pixels = tile->pixels;
    pixels->far[g] = far;
    for (unsigned turns = pixels->turns[g]; turns; turns &= turns - 1) {
        const uint32_t cell = pixels->cell[g][__builtin_ctz(turns)];
        float most = -HUGE_VALF;
        for (uint64_t left = (&pixels->in_cell[0][0])[cell]; left; left &= left - 1)
            most = larger(most, pixels->far[__builtin_ctzll(left)]);
        tile->far[cell / SCREEN_ACROSS][cell % SCREEN_ACROSS] = most;
    }
}

/// Where the rays of a group are. Lanes without one have the cell of another.
static void R(place_pixels)(const R(tile_cast) * tile, uint32_t g)
{
    const glint_camera_args *camera = tile->args->camera;
    R(pixel_groups) *pixels = tile->pixels;
    _Alignas(64) real s[GLINT_GROUP], t[GLINT_GROUP];
    R(pixel_axis)(0, camera->pixel[0] + (size_t)g * GLINT_GROUP, camera->offset[0], camera->width, false, s);
    R(pixel_axis)(0, camera->pixel[1] + (size_t)g * GLINT_GROUP, camera->offset[1], camera->height, true, t);
    R(narrow)(s, pixels->s[g]);
    R(narrow)(t, pixels->t[g]);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const vi column = cell_of_place(&tile->view, 0, f_load(pixels->s[g] + i));
        const vi row = cell_of_place(&tile->view, 1, -f_load(pixels->t[g] + i));
        i_store(pixels->cell[g] + i, i_or(i_shl(row, 4), column));
    }
    pixels->turns[g] = 1;
    for (int i = 1; i < GLINT_GROUP; i++)
        pixels->turns[g] |= (uint16_t)((pixels->cell[g][i] != pixels->cell[g][i - 1]) << i);
    for (unsigned turns = pixels->turns[g]; turns; turns &= turns - 1)
        (&pixels->in_cell[0][0])[pixels->cell[g][__builtin_ctz(turns)]] |= (uint64_t)1 << g;
}

/// The groups that have a ray in some of the cells, and there something as far away as `near` still matters.
static inline uint64_t R(pixels_behind)(const R(tile_cast) * tile, screen_cells cells, float near)
{
    const unsigned columns = bit_range(first_column(cells), last_column(cells));
    uint64_t groups = 0;
    for (int y = first_row(cells); y <= last_row(cells); y++)
        for (unsigned left = behind_in_row((const float(*)[SCREEN_ACROSS])tile->far, y, near, columns); left; left &= left - 1)
            groups |= tile->pixels->in_cell[y][__builtin_ctz(left)];
    return groups;
}

/// Lanes of a group that have met nothing before `near`.
INNER unsigned R(open_lanes)(const R(tile_cast) * tile, int g, int i, float near)
{
    return fm_bits(f_le(f_set(near), f_load(tile->depth[g] + i)));
}

/// As cast_slot_as.
INNER void R(cast_slot_to_pixels)(R(tile_cast) * tile, const glint_node *node, const node_on_screen *seen, int slot, const bool boxed,
                                  R(eye_parts) * parts, eye_box *box)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const R(pixel_groups) *pixels = tile->pixels;
    const float depth = seen->near[slot];
    const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
    uint64_t groups = R(pixels_behind)(tile, seen->cells[slot], depth);
    bool placed = false;
    R(candidate) candidate;
    if (!groups)
        return;
    const shape_on_screen shape = shape_of(node, seen, slot, &geometry->prims[id], &tile->view);
    if (boxed)
        *box = see_box(tile->args->camera, &tile->view, node, slot);
    for (; groups; groups &= groups - 1) {
        const int g = __builtin_ctzll(groups);
        unsigned near = 0;
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const vf s = f_load(pixels->s[g] + i), t = f_load(pixels->t[g] + i);
            unsigned lanes = R(open_lanes)(tile, g, i, depth) & near_shape(&shape, s, -t);
            if (boxed && lanes)
                lanes &= lanes_in_box(box, s, t);
            near |= lanes << i;
        }
        if (!near)
            continue;
        if (!placed)
            R(place_candidate)(tile->args, id, &candidate);
        if (boxed && !placed)
            R(see_candidate)(tile->args, &candidate, parts);
        placed = true;
        if (R(decide_pixels)(tile, &candidate, 0, g, near))
            R(note_cells)(tile, g, R(depth_of_group)(tile, g));
    }
}

/// Apart, as cast_boxed_slot is.
static __attribute__((noinline)) void R(cast_boxed_to_pixels)(R(tile_cast) * tile, const glint_node *node,
                                                              const node_on_screen *seen, int slot)
{
    R(eye_parts) parts;
    eye_box box;
    R(cast_slot_to_pixels)(tile, node, seen, slot, true, &parts, &box);
}

/// The cells that a triangle may show in: seen edge-on, those of its box. False: it shows in none.
static inline bool R(cells_of_triangle)(const R(tile_cast) * tile, const R(cast_leaf) * leaf, const node_on_screen *seen, int slot,
                                        screen_cells *out)
{
    const screen_view *view = &tile->view;
    *out = seen->cells[slot];
    if (!(leaf->shown.certain >> slot & 1))
        return true;
    for (int n = 0; n < 2; n++) {
        const float least = leaf->shown.least[n][slot], most = leaf->shown.most[n][slot], end = (float)(view->count[n] - 1);
        if (most < view->first[n] || view->last[n] < least)
            return false;
        const uint32_t first = (uint32_t)smaller(larger((least - view->first[n]) * view->cells[n], 0), end);
        const float behind = (most - view->first[n]) * view->cells[n];
        const uint32_t last = (uint32_t)(behind < end ? larger(behind, 0) : end);
        *out = (*out & (n ? 0xffffu : 0xffff0000u)) | (first | last << 8) << 16 * n;
    }
    return true;
}

/// As cast_triangle.
static void R(cast_triangle_to_pixels)(R(tile_cast) * tile, R(cast_leaf) * leaf, const node_on_screen *seen, int slot)
{
    const R(pixel_groups) *pixels = tile->pixels;
    const float near = leaf->shown.near[slot];
    screen_cells cells;
    if (!R(cells_of_triangle)(tile, leaf, seen, slot, &cells))
        return;
    for (uint64_t groups = R(pixels_behind)(tile, cells, near); groups; groups &= groups - 1) {
        const int g = __builtin_ctzll(groups);
        unsigned lanes = 0;
        for (int i = 0; i < GLINT_GROUP; i += VF)
            lanes |= (R(open_lanes)(tile, g, i, near) &
                      between_edges(&leaf->shown, slot, f_load(pixels->s[g] + i), -f_load(pixels->t[g] + i)))
                     << i;
        if (lanes)
            R(add_pairs)(tile, leaf, slot, 0, g, lanes);
    }
}

/// As cast_prims.
static void R(cast_prims_to_pixels)(R(tile_cast) * tile, R(cast_leaf) * leaf, const glint_node *node, const node_on_screen *seen,
                                    unsigned mask)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    unsigned triangles = triangles_in(geometry, node, mask);
    int order[GLINT_NODE_WIDTH];
    const int count = sort_slots(mask & ~triangles, seen->near, order);
    for (int i = 0; i < count; i++) {
        const uint32_t kind = geometry->prims[node->child[order[i]] & ~GLINT_NODE_PRIM].kind;
        if (GLINT_REAL == 64 && (kind == GLINT_PRIM_SOLID || kind == GLINT_PRIM_COMBINED))
            R(cast_boxed_to_pixels)(tile, node, seen, order[i]);
        else
            R(cast_slot_to_pixels)(tile, node, seen, order[i], false, NULL, NULL);
    }
    if (!triangles)
        return;
    leaf->node = node;
    R(load_leaf)(tile->args, triangles, leaf);
    show_leaf(&tile->view, seen, GLINT_REAL == 32, &leaf->shown);
    for (; triangles; triangles &= triangles - 1)
        R(cast_triangle_to_pixels)(tile, leaf, seen, __builtin_ctz(triangles));
    R(decide_pairs)(tile, leaf);
}

/// The planes, and whatever else has no end.
static void R(cast_planes_to_pixels)(R(tile_cast) * tile)
{
    const R(pixel_groups) *pixels = tile->pixels;
    R(candidate) candidate;
    uint32_t next = 0;
    while (R(open_planes)(tile, &next, &candidate, 1))
        for (uint32_t g = 0; g < tile->args->group_count; g++) {
            unsigned near = 0;
            for (int i = 0; i < GLINT_GROUP; i += VF) {
                const vf s = f_load(pixels->s[g] + i), t = f_load(pixels->t[g] + i);
                const vf length2 = s * s * f_set(tile->rr) + (f_set(1) + t * t * f_set(tile->uu));
                near |= R(near_places)(&candidate, s, t, length2) << i;
            }
            near &= tile->args->active[g];
            if (near)
                R(decide_pixels)(tile, &candidate, 0, (int)g, near);
        }
}

/// The screen: cells for all pixels from the first to the last.
static void R(aim_pixels)(const glint_cast_args *args, const glint_camera_args *around, R(tile_cast) * tile)
{
    glint_cast_args whole = *args;
    whole.camera = around;
    R(aim_tile)(&whole, tile);
    tile->args = args;
    tile->across = 1; // a group a row, in arrays
    tile->scaled = tile->deep = true;
    for (int j = 0; j < 2; j++) {
        const double first = j ? around->y0 : around->x0, end = args->camera->end[j];
        tile->view.count[j] = (int)(end - first + GLINT_PIXEL_CELL - 1) / GLINT_PIXEL_CELL;
        tile->view.cells[j] = 0.5f / GLINT_PIXEL_CELL;
        tile->view.last[j] = (float)(2 * end - (j ? around->height : around->width));
    }
    for (int y = 0; y < tile->view.count[1]; y++)
        for (int x = 0; x < SCREEN_ACROSS; x++)
            tile->far[y][x] = -HUGE_VALF;
}

/// Of a scene with many primitives. around: the camera, were its pixels all those from the first to the last.
static void R(cast_many_to_pixels)(const glint_cast_args *args, const glint_camera_args *around)
{
    R(tile_cast) tile;
    R(pixel_groups) pixels;
    screen_entry stack[WALK_STACK];
    R(aim_pixels)(args, around, &tile);
    tile.pixels = &pixels;
    memset(pixels.in_cell, 0, sizeof pixels.in_cell);
    for (uint32_t g = 0; g < args->group_count; g++) {
        R(place_pixels)(&tile, g);
        R(start_group)(args, g);
    }
    R(cast_planes_to_pixels)(&tile);
    for (uint32_t g = 0; g < args->group_count; g++)
        pixels.far[g] = R(depth_of_group)(&tile, (int)g);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(note_cells)(&tile, (int)g, pixels.far[g]);
    stack[0] = entry_of_root(&tile.view);
    if (args->geometry->nodes)
        R(walk_tile)(&tile, stack, 1);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(finish_group)(args, g);
}

// ---- Of any number ----

/// Of pixels wherever they are.
static void R(cast_pixels)(const glint_cast_args *args)
{
    const glint_camera_args *camera = args->camera;
    glint_camera_args around = *camera;
    glint_cast_args tile_args = *args;
    glint_cast_view own;
    own.made = false;
    around.groups_across = (uint32_t)(camera->end[0] - camera->x0 + 3) / 4;
    around.group_count = around.groups_across * ((uint32_t)(camera->end[1] - camera->y0 + 3) / 4);
    tile_args.camera = &around;
    const R(cast_view) *view = R(view_of)(&tile_args, &own);
    if (view->few && view->count <= PIXEL_CANDIDATES)
        R(cast_few_to_pixels)(args, view, &around);
    else
        R(cast_many_to_pixels)(args, &around);
}
