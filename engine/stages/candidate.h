// candidate: a surface that some rays of a tile may hit, and what it is to all of them: their rays start at one eye, so
// that filters are linear over the picture. Contract: stages.h, cast.

#define GLINT_FIRST_CANDIDATES 24 ///< a node's worth and some planes

/// The tile's pixels as the filter sees them, and what is hit so far.
typedef struct R(tile_cast) {
    const glint_cast_args *args;
    tile_view view;
    int across, down;
    bool scaled; ///< the arrays below are filled
    bool deep; ///< more than the first candidates are in sight: worth knowing what hides what
    _Alignas(64) float s[GLINT_TILE_WIDTH / 4][GLINT_GROUP], t[GLINT_TILE_HEIGHT / 4][GLINT_GROUP];
    _Alignas(64) float ss[GLINT_TILE_WIDTH / 4][GLINT_GROUP], tt[GLINT_TILE_HEIGHT / 4][GLINT_GROUP];
    ///< |direction|^2 = ss + tt
    _Alignas(64) float far[GLINT_TILE_GROUPS]; ///< depth of the farthest hit of each group, in the index's units
    uint64_t stale; ///< groups whose `far` is not up to date, a bit each
    float far_of_all;
} R(tile_cast);

/// A primitive that some of the tile's rays may hit, and what it is to all of them.
typedef struct R(candidate) {
    const glint_prim *prim;
    uint32_t id;
    float depth; ///< where its box begins
    unsigned columns, rows; ///< of groups that it may show in, a bit each
    real f[3], c; ///< see R(offset) and R(offset_constant)
    float base[3], along_s[3], along_t[3]; ///< the filter: linear in s and t are f x d of a sphere, e of a triangle
    float limit; ///< sphere: square of how long f x d may be; triangle: how far below 0 e may be
    real corner[3][3]; ///< of a triangle, from the eye
    _Alignas(64) float row[3][GLINT_GROUP]; ///< base and along_t for the row of groups at hand
} R(candidate);

/// Which way the planes' corner rays run decides whether a ray between them can meet it.
static inline bool R(plane_ahead)(const glint_camera_args *camera, const tile_view *view, const glint_prim *prim)
{
    double e[3], away = 0;
    for (int k = 0; k < 3; k++) {
        e[k] = camera->eye[k] - prim->center[k];
        away = fmax(away, fabs(e[k]));
    }
    const double height = DOT(prim->normal, e);
    if (!(fabs(height) > (GLINT_REAL == 64 ? 1e-12 : 1e-5) * away))
        return true;
    for (int corner = 0; corner < 4; corner++) {
        const double s = view->s[corner & 1], t = view->t[corner >> 1];
        double d[3], size = 0;
        for (int k = 0; k < 3; k++) {
            d[k] = (camera->forward[k] + s * camera->right[k]) + t * camera->up[k];
            size += fabs(d[k]);
        }
        if (!(DOT(prim->normal, d) * (height > 0 ? 1 : -1) > 1e-5 * size))
            return true;
    }
    return false;
}

static void R(scale_tile)(R(tile_cast) * tile)
{
    const glint_camera_args *camera = tile->args->camera;
    const vf rr = f_set((float)DOT(camera->right, camera->right)), uu = f_set((float)DOT(camera->up, camera->up));
    for (int x = 0; x < tile->across; x++)
        for (int i = 0; i < GLINT_GROUP; i++)
            tile->s[x][i] = (float)(2 * ((camera->x0 + 4 * x + i % 4) + camera->offset[0]) - camera->width);
    for (int y = 0; y < tile->down; y++)
        for (int i = 0; i < GLINT_GROUP; i++)
            tile->t[y][i] = (float)(camera->height - 2 * ((camera->y0 + 4 * y + i / 4) + camera->offset[1]));
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        for (int x = 0; x < tile->across; x++)
            f_store(tile->ss[x] + i, f_load(tile->s[x] + i) * f_load(tile->s[x] + i) * rr);
        for (int y = 0; y < tile->down; y++)
            f_store(tile->tt[y] + i, f_set(1) + f_load(tile->t[y] + i) * f_load(tile->t[y] + i) * uu);
    }
    tile->scaled = true;
}

/// f, radius: of the sphere, or of one around the solid, in any unit.
static inline void R(make_filter)(const glint_camera_args *camera, const double f[3], double radius,
                                  R(candidate) * candidate)
{
    double x[3][3];
    const double *axis[3] = { camera->forward, camera->right, camera->up };
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            x[j][k] = f[(k + 1) % 3] * axis[j][(k + 2) % 3] - f[(k + 2) % 3] * axis[j][(k + 1) % 3];
    for (int k = 0; k < 3; k++) {
        candidate->base[k] = (float)x[0][k];
        candidate->along_s[k] = (float)x[1][k];
        candidate->along_t[k] = (float)x[2][k];
    }
    const double limit = radius * (1 + 2e-6) + GLINT_FILTER_SLACK * sqrt(DOT(f, f));
    candidate->limit = (float)(limit * limit * (1 + 1e-6));
}

/// A ray meets the triangle where it passes all edges on the side of `volume`, the corners seen from the eye; each is
/// linear in s and t.
static void R(make_triangle_filter)(const R(tile_cast) * tile, R(candidate) * candidate)
{
    const glint_camera_args *camera = tile->args->camera;
    const double *axis[3] = { camera->forward, camera->right, camera->up };
    const double s = fmax(fabs(tile->view.s[0]), fabs(tile->view.s[1])) + 2;
    const double t = fmax(fabs(tile->view.t[0]), fabs(tile->view.t[1])) + 2;
    double p[3][3], n[3][3], size[3], limit = 0, rays = 0;
    for (int j = 0; j < 3; j++) {
        for (int k = 0; k < 3; k++)
            p[j][k] = candidate->corner[j][k];
        size[j] = (fabs(p[j][0]) + fabs(p[j][1])) + fabs(p[j][2]);
        rays += (fabs(axis[0][j]) + s * fabs(axis[1][j])) + t * fabs(axis[2][j]);
    }
    for (int j = 0; j < 3; j++) {
        const double *a = p[(j + 1) % 3], *b = p[(j + 2) % 3];
        for (int k = 0; k < 3; k++)
            n[j][k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
    const double rounding = GLINT_REAL == 64 ? 0x1p-46 : 0x1p-17, volume = DOT(p[0], n[0]);
    const double side = volume < 0 ? -1 : 1;
    for (int j = 0; j < 3; j++) {
        const double base = DOT(n[j], axis[0]), along_s = DOT(n[j], axis[1]), along_t = DOT(n[j], axis[2]);
        candidate->base[j] = (float)(side * base);
        candidate->along_s[j] = (float)(side * along_s);
        candidate->along_t[j] = (float)(side * along_t);
        limit = fmax(limit, 0x1p-20 * ((fabs(base) + s * fabs(along_s)) + t * fabs(along_t)) +
                                rounding * size[(j + 1) % 3] * size[(j + 2) % 3] * rays);
    }
    const bool edge_on = !(fabs(volume) > rounding * size[0] * size[1] * size[2]);
    candidate->limit = edge_on ? HUGE_VALF : (float)limit + FLT_MIN;
}

/// By the sphere around it. Where float decides, nothing is kept from it.
static inline void R(make_solid_filter)(const glint_cast_args *args, R(candidate) * candidate)
{
    const glint_geometry_table *geometry = args->geometry;
    const glint_prim *prim = candidate->prim;
    double from[3];
    for (int k = 0; k < 3; k++)
        from[k] = (args->camera->eye[k] - geometry->reference[k]) * geometry->scale - prim->filter_center[k];
    R(make_filter)(args->camera, from, prim->filter_bound, candidate);
    if (GLINT_REAL == 32)
        candidate->limit = HUGE_VALF;
}

static void R(make_candidate)(R(tile_cast) * tile, uint32_t id, R(candidate) * candidate)
{
    const glint_cast_args *args = tile->args;
    const glint_prim *prim = candidate->prim = &args->geometry->prims[id];
    const double *eye = args->camera->eye;
    const vr origin[3] = { r_set(eye[0]), r_set(eye[1]), r_set(eye[2]) };
    _Alignas(64) real lanes[VR];
    vr f[3];
    candidate->id = id;
    if (prim->kind != GLINT_PRIM_PLANE && !tile->scaled)
        R(scale_tile)(tile);
    if (prim->kind == GLINT_PRIM_TRIANGLE) {
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                candidate->corner[j][k] = ((real)prim->corner[j][k] - (real)eye[k]) * (real)args->geometry->scale;
        R(make_triangle_filter)(tile, candidate);
        return;
    }
    if (prim->kind == GLINT_PRIM_SOLID)
        R(unit_offset)(&args->geometry->solids[prim->item], prim, origin, f);
    else
        R(offset)(origin, prim, f);
    for (int k = 0; k < 3; k++) {
        r_store(lanes, f[k]);
        candidate->f[k] = lanes[0];
    }
    if (prim->kind == GLINT_PRIM_SOLID) {
        R(make_solid_filter)(args, candidate);
        return;
    }
    r_store(lanes, R(offset_constant)(f, prim));
    candidate->c = lanes[0];
    if (prim->kind == GLINT_PRIM_SPHERE) {
        const double from[3] = { candidate->f[0], candidate->f[1], candidate->f[2] };
        R(make_filter)(args->camera, from, prim->radius * prim->scale, candidate);
    }
}

/// Lanes of group (x, y) that pass near the candidate.
static inline unsigned R(near_pixels)(const R(tile_cast) * tile, const R(candidate) * candidate, int x, int y)
{
    if (candidate->prim->kind == GLINT_PRIM_PLANE)
        return 0xffff;
    const bool triangle = candidate->prim->kind == GLINT_PRIM_TRIANGLE;
    unsigned near = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const vf s = f_load(tile->s[x] + i);
        vf v[3];
        for (int k = 0; k < 3; k++)
            v[k] = f_load(candidate->row[k] + i) + s * f_set(candidate->along_s[k]);
        if (triangle) {
            near |= (~fm_bits(f_lt(f_min(f_min(v[0], v[1]), v[2]), f_set(-candidate->limit))) & ((1u << VF) - 1)) << i;
            continue;
        }
        const vf reach2 = f_set(candidate->limit) * (f_load(tile->ss[x] + i) + f_load(tile->tt[y] + i));
        near |= (~fm_bits(f_lt(reach2, DOT(v, v))) & ((1u << VF) - 1)) << i;
    }
    return near;
}

/// f: the candidate's, in every lane.
static inline rm R(meet_candidate)(const glint_cast_args *args, const R(candidate) * candidate, const vr f[3],
                                   const vr d[3], vr *t)
{
    vr corner[3][3];
    if (candidate->prim->kind == GLINT_PRIM_SOLID)
        return R(meet_solid)(&args->geometry->solids[candidate->prim->item], f, d, t);
    if (candidate->prim->kind != GLINT_PRIM_TRIANGLE)
        return R(meet)(f, r_set(candidate->c), d, candidate->prim, t);
    for (int j = 0; j < 9; j++)
        corner[j / 3][j % 3] = r_set(candidate->corner[j / 3][j % 3]);
    return R(meet_triangle)(corner, d, r_set(args->geometry->scale), t);
}

/// Decides one candidate for the lanes of group (x, y) in `near`. Returns whether any hit was kept.
static inline bool R(decide_pixels)(const R(tile_cast) * tile, const R(candidate) * candidate, int x, int y,
                                    unsigned near)
{
    const glint_cast_args *args = tile->args;
    const size_t at = (size_t)(y * tile->across + x) * GLINT_GROUP;
    const vr f[3] = { r_set(candidate->f[0]), r_set(candidate->f[1]), r_set(candidate->f[2]) };
    const R(group_directions) directions = R(directions_of)(args->camera, (uint32_t)x, (uint32_t)y);
    bool any = false;
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        if (!(near >> i & ((1u << VR) - 1)))
            continue;
        vr d[3], t;
        R(load_direction)(directions, args->direction, 0, i, d);
        const rm hit = R(meet_candidate)(args, candidate, f, d, &t);
        if (!rm_bits(hit))
            continue;
        R(keep_nearest)(args, at + i, candidate->id, hit, t);
        any = true;
    }
    return any;
}

static inline float R(far_of_group)(R(tile_cast) * tile, int g)
{
    if (tile->stale >> g & 1)
        tile->far[g] = R(farthest)(tile->args, (size_t)g * GLINT_GROUP);
    tile->stale &= ~((uint64_t)1 << g);
    return tile->far[g];
}

static inline float R(far_of_tile)(R(tile_cast) * tile)
{
    if (!tile->stale)
        return tile->far_of_all;
    while (tile->stale)
        R(far_of_group)(tile, __builtin_ctzll(tile->stale));
    vf far = f_set(0);
    for (int g = 0; g < GLINT_TILE_GROUPS; g += VF)
        far = f_max(far, f_load(tile->far + g));
    return tile->far_of_all = f_max_all(far);
}

static inline void R(begin_row)(const R(tile_cast) * tile, R(candidate) * candidates, int count, int y)
{
    for (int j = 0; j < count && tile->scaled; j++)
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < GLINT_GROUP; i += VF)
                f_store(candidates[j].row[k] + i,
                        f_set(candidates[j].base[k]) + f_load(tile->t[y] + i) * f_set(candidates[j].along_t[k]));
}

/// Tests candidates, group by group.
static void R(cast_candidates)(R(tile_cast) * tile, R(candidate) * candidates, int count)
{
    unsigned columns = 0, rows = 0;
    for (int k = 0; k < count; k++) {
        columns |= candidates[k].columns;
        rows |= candidates[k].rows;
    }
    for (; rows; rows &= rows - 1) {
        const int y = __builtin_ctz(rows);
        R(begin_row)(tile, candidates, count, y);
        for (unsigned left = columns; left; left &= left - 1) {
            const int x = __builtin_ctz(left), g = y * tile->across + x;
            for (int k = 0; k < count; k++) {
                const R(candidate) *candidate = &candidates[k];
                if (!(candidate->columns >> x & candidate->rows >> y & 1) ||
                    R(far_of_group)(tile, g) < candidate->depth)
                    continue;
                const unsigned near = R(near_pixels)(tile, candidate, x, y);
                if (near && R(decide_pixels)(tile, candidate, x, y, near))
                    tile->stale |= (uint64_t)1 << g;
            }
        }
    }
}

static void R(begin_tile)(const glint_cast_args *args, R(tile_cast) * tile)
{
    tile->args = args;
    tile->scaled = false;
    tile->stale = 0;
    tile->far_of_all = HUGE_VALF;
    for (uint32_t g = 0; g < GLINT_TILE_GROUPS; g++)
        tile->far[g] = g < args->group_count ? HUGE_VALF : 0;
    tile->deep = false;
    tile->across = (int)args->camera->groups_across;
    tile->down = (int)args->group_count / tile->across;
    make_tile_view(args->camera, args->geometry, R(walk_slack)(args->geometry), &tile->view);
}

static bool R(in_sight)(const glint_cast_args *args)
{
    const glint_geometry_table *geometry = args->geometry;
    _Alignas(64) float depth[GLINT_NODE_WIDTH];
    tile_view view;
    make_tile_view(args->camera, geometry, R(walk_slack)(geometry), &view);
    for (uint32_t i = 0; i < geometry->unbounded_count; i++)
        if (R(plane_ahead)(args->camera, &view, &geometry->prims[geometry->unbounded[i]]))
            return true;
    return geometry->nodes && boxes_in_tile(geometry->nodes, &view, HUGE_VALF, depth);
}
