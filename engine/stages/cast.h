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
    vr bb = b * b, ar2 = a * r2, inner = bb - a * c;
    const rm near = r_lt(bb, ar2);
    if (rm_bits(near) == (1u << VR) - 1) // a ground seen from above it: the cross product is not needed
        return inner;
    vr x = f[1] * d[2] - f[2] * d[1], y = f[2] * d[0] - f[0] * d[2], z = f[0] * d[1] - f[1] * d[0];
    return r_select(near, inner, ar2 - ((x * x + y * y) + z * z));
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

// ---- The filter of rays that have their own origins ----

/// Which lanes of a group come near the sphere, `f` from its centre to the ray's origin: the distance of the ray is
/// |f x d| / |d|. Written so that NaN and infinity keep the lane.
static inline unsigned R(near_lanes)(const vf f[3], const vf d[3], vf limit2)
{
    vf x[3] = { f[1] * d[2] - f[2] * d[1], f[2] * d[0] - f[0] * d[2], f[0] * d[1] - f[1] * d[0] };
    return ~fm_bits(f_lt(limit2 * DOT(d, d), DOT(x, x))) & ((1u << VF) - 1);
}

/// Points of a group in the index's frame.
static inline void R(index_frame)(const void *const point[3], size_t at, const glint_geometry_table *geometry,
                                  float (*local)[GLINT_GROUP])
{
    for (int i = 0; i < GLINT_GROUP; i += VR)
        for (int k = 0; k < 3; k++)
            r_store_f(local[k] + i, (r_load((const real *)point[k] + at + i) - r_set(geometry->reference[k])) *
                                        r_set(geometry->scale));
}

/// A group of rays as filter and walk see them.
typedef struct R(ray_group) {
    const float (*local)[GLINT_GROUP]; ///< origins, in the index's frame
    _Alignas(64) float direction[3][GLINT_GROUP];
    _Alignas(64) float bound[GLINT_GROUP]; ///< what the rounding of `local` may add to a distance
    const float *origin[3]; ///< --precision float: the origins themselves
} R(ray_group);

/// Fills all but `direction`. `local`: of these origins, by index_frame.
static inline void R(set_origins)(const void *const point[3], size_t at, const float (*local)[GLINT_GROUP],
                                  R(ray_group) * rays)
{
    rays->local = local;
    for (int i = 0; i < GLINT_GROUP; i += VF) // by the sum of the components, which is larger than the length
        f_store(rays->bound + i,
                f_set(GLINT_FILTER_SLACK) * ((f_abs(f_load(rays->local[0] + i)) + f_abs(f_load(rays->local[1] + i))) +
                                             f_abs(f_load(rays->local[2] + i))));
    for (int k = 0; k < 3; k++)
        rays->origin[k] = (const float *)point[k] + (GLINT_REAL == 32 ? at : 0);
}

/// From the sphere's centre to the rays' origins, and how near a ray may pass without being kept.
static inline vf R(filter_offset)(const R(ray_group) * rays, int i, const glint_prim *prim, vf f[3])
{
#if GLINT_REAL == 64
    for (int k = 0; k < 3; k++)
        f[k] = f_load(rays->local[k] + i) - f_set(prim->filter_center[k]);
    return f_set(prim->filter_bound) + f_load(rays->bound + i);
#else // where float decides, the filter must see what it sees: the same f, with all its error
    for (int k = 0; k < 3; k++)
        f[k] = f_load(rays->origin[k] + i);
    if (prim->kind != GLINT_PRIM_SPHERE)
        return f_set(HUGE_VALF);
    for (int k = 0; k < 3; k++)
        f[k] = (f[k] - f_set((float)prim->center[k])) * f_set((float)prim->scale);
    return f_set((float)(prim->radius * prim->scale * (1 + 2e-6))) +
           f_set(GLINT_FILTER_SLACK) * ((f_abs(f[0]) + f_abs(f[1])) + f_abs(f[2]));
#endif
}

/// Lanes of the group that pass near the primitive.
static unsigned R(near_rays)(const R(ray_group) * rays, const glint_prim *prim)
{
    unsigned near = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf f[3], d[3];
        for (int k = 0; k < 3; k++)
            d[k] = f_load(rays->direction[k] + i);
        const vf limit = R(filter_offset)(rays, i, prim, f);
        near |= R(near_lanes)(f, d, limit * limit) << i;
    }
    return near;
}

// ---- The decision ----

/// Of equal hits the one defined first stays; t = inf, where float overflows, is a miss's own and no hit. Returns the lanes of `tied` in which that is `id`.
static unsigned R(wins_tie)(const glint_prim *prims, uint32_t id, const uint32_t *best, unsigned tied)
{
    unsigned wins = 0;
    for (; tied; tied &= tied - 1) {
        const uint32_t old = best[__builtin_ctz(tied)];
        if (old != GLINT_MISS && prims[id].id < prims[old].id)
            wins |= tied & -tied;
    }
    return wins;
}

/// Keeps the nearest of what was and `t` in the lanes of `hit`.
static inline void R(keep_nearest)(const glint_cast_args *args, size_t at, uint32_t id, rm hit, vr t)
{
    real *best_t = (real *)args->t + at;
    uint32_t *best_id = args->prim + at;
    const vr old_t = r_load(best_t);
    const rm tie = rm_and(rm_and(hit, r_eq(t, old_t)), r_lt(t, r_set(HUGE_VAL))); // at infinity there is no hit to tie
    hit = rm_and(hit, r_lt(t, old_t));
    if (rm_bits(tie))
        hit = rm_or(hit, rm_from_bits(R(wins_tie)(args->geometry->prims, id, best_id, rm_bits(tie))));
    r_store(best_t, r_select(hit, t, old_t));
    r_put_index(best_id, hit, id);
}

/// From the ray's origin to the primitive: f of a sphere, scaled; of a plane, not.
static inline void R(offset)(const vr origin[3], const glint_prim *prim, vr f[3])
{
    for (int k = 0; k < 3; k++) {
        f[k] = origin[k] - r_set(prim->center[k]);
        if (prim->kind == GLINT_PRIM_SPHERE)
            f[k] = f[k] * r_set(prim->scale);
    }
}

/// What all rays from one origin know of a primitive: f, and c of a sphere or the height over a plane.
static inline vr R(offset_constant)(const vr f[3], const glint_prim *prim)
{
    if (prim->kind == GLINT_PRIM_SPHERE)
        return R(exact_c)(f, prim);
    const vr n[3] = { r_set(prim->normal[0]), r_set(prim->normal[1]), r_set(prim->normal[2]) };
    return DOT(n, f);
}

static inline rm R(meet)(const vr f[3], vr c, const vr d[3], const glint_prim *prim, vr *t)
{
    const vr a = DOT(d, d);
    if (prim->kind == GLINT_PRIM_SPHERE)
        return R(meet_sphere)(f, d, a, c, prim, t);
    return R(meet_plane)(d, a, c, prim, t);
}

/// Starts a group: nothing hit; and nothing that could be nearer where no pixel is.
static inline void R(start_group)(const glint_cast_args *args, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const rm active = rm_from_bits(args->active[g] >> i & ((1u << VR) - 1));
        r_store((real *)args->t + at + i, r_select(active, r_set(HUGE_VAL), r_set(-HUGE_VAL)));
    }
    for (int i = 0; i < GLINT_GROUP; i += VF)
        i_store(args->prim + at + i, i_set(GLINT_MISS));
}

/// Writes the group's hit mask, and makes lanes outside the image misses like all others.
static inline void R(finish_group)(const glint_cast_args *args, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    args->hits[g] = (uint16_t)~lanes_equal(args->prim + at, GLINT_MISS);
    for (int i = 0; args->active[g] != 0xffff && i < GLINT_GROUP; i += VR) {
        const rm active = rm_from_bits(args->active[g] >> i & ((1u << VR) - 1));
        real *t = (real *)args->t + at + i;
        r_store(t, r_select(active, r_load(t), r_set(HUGE_VAL)));
    }
}

/// The farthest hit of a group in the index's units, rounded up; infinite while a ray has none.
static inline float R(farthest)(const glint_cast_args *args, size_t at)
{
    _Alignas(64) float t[GLINT_GROUP];
    for (int i = 0; i < GLINT_GROUP; i += VR)
        r_store_f(t + i, r_load((const real *)args->t + at + i) * r_set(args->geometry->scale));
    return group_highest(t) * (1 + 0x1p-22f);
}

/// What float arithmetic adds to the rounding of the walk, in the index's units.
static inline float R(walk_slack)(const glint_geometry_table *geometry)
{
#if GLINT_REAL == 64
    (void)geometry;
    return 0;
#else
    return (float)(GLINT_FILTER_SLACK * geometry->extent * geometry->scale);
#endif
}

// ---- Rays from the eye: the tile walks the index once, nearest boxes first ----

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

// ---- Rays of their own ----

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
        const rm leaves = rm_and(span.hit, r_lt(r_set(0), span.t[1]));
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
    const unsigned leave = args->leaving ? lanes_equal(args->leaving + at, prim->coincident) : 0;
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
            for (int i = 0; i < GLINT_GROUP; i += VR)
                r_store_f(rays.direction[k] + i, r_load((const real *)args->direction[k] + at + i));
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
