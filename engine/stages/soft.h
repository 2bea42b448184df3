// soft: which points the samples of an area light reach. What the whole light's shaft settles costs no rays: groups that
// no occluder can come between, and groups that one occluder hides from all of it. Elsewhere each occluder is offered
// all samples of a group at once. Every decision is that of occlude.h.

/// What is left to test of a group.
typedef struct R(soft_group) {
    uint16_t near; ///< a bit an occluder of the tile's list
    bool hidden; ///< from the whole light
} R(soft_group);

#define SOFT_APART 0 // between no point of the group and no point of the light
#define SOFT_NEAR 1
#define SOFT_HIDES 2 // between all of them

/// Where a box, of the index's frame, lies along a plane's normal, in world units.
static inline void R(heights)(const glint_geometry_table *geometry, const glint_prim *plane, const float lower[3],
                              const float upper[3], double *low, double *high)
{
    double height = 0, reach = 0, size = 0;
    for (int k = 0; k < 3; k++) {
        const double middle = 0.5 * ((double)lower[k] + (double)upper[k]), half = (double)upper[k] - middle;
        const double x = middle / geometry->scale + geometry->reference[k];
        height += plane->normal[k] * (x - plane->center[k]);
        reach += fabs(plane->normal[k]) * (half / geometry->scale);
        size += fabs(x) + fabs(plane->center[k]);
    }
    reach += (GLINT_REAL == 64 ? 1e-12 : 1e-5) * size;
    *low = height - reach;
    *high = height + reach;
}

static int R(classify_plane)(const R(shadow_tile) * tile, const glint_prim *plane, const float lower[3],
                             const float upper[3])
{
    double low, high, light_low, light_high;
    R(heights)(tile->args->geometry, plane, lower, upper, &low, &high);
    R(heights)(tile->args->geometry, plane, tile->light.lower, tile->light.upper, &light_low, &light_high);
    if ((low > 0 && light_low > 0) || (high < 0 && light_high < 0))
        return SOFT_APART;
    return (low > 0 && light_high < 0) || (high < 0 && light_low > 0) ? SOFT_HIDES : SOFT_NEAR;
}

/// Whether every segment from the box to the light passes well within the sphere. At a share `along` of its way a segment
/// is no further from the middle one than (1 - along) times the points' reach plus along times the light's.
static bool R(sphere_hides)(const R(shadow_tile) * tile, const glint_prim *prim, const float lower[3],
                            const float upper[3])
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const glint_lamp *lamp = tile->args->lamp[0];
    float middle[3], way[3], e[3], along = 0, length2 = 0, half2 = 0, size = 0, apart2 = 0;
    for (int k = 0; k < 3; k++) {
        const float light = (float)((lamp->center[k] - geometry->reference[k]) * geometry->scale);
        middle[k] = 0.5f * (lower[k] + upper[k]);
        way[k] = light - middle[k];
        e[k] = middle[k] - prim->filter_center[k];
        along -= e[k] * way[k];
        length2 += way[k] * way[k];
        half2 += (upper[k] - middle[k]) * (upper[k] - middle[k]);
        apart2 += (light - prim->filter_center[k]) * (light - prim->filter_center[k]);
        size += (fabsf(middle[k]) + fabsf(prim->filter_center[k])) + fabsf(light);
    }
    along = smaller(larger(along / length2, 0), 1);
    for (int k = 0; k < 3; k++)
        e[k] += along * way[k];
    const float slack = 4 * GLINT_FILTER_SLACK * size + R(walk_slack)(geometry);
    const float light_reach = (float)(lamp->radius * geometry->scale) * 1.00001f + slack;
    const float radius = (float)(prim->radius * geometry->scale);
    if (!(sqrtf(apart2) > prim->filter_bound + (light_reach + slack))) // the whole light is outside
        return false;
    const float reach = (1 - along) * sqrtf(half2) + along * light_reach;
    return sqrtf(DOT(e, e)) + reach < radius * 0.99999f - slack;
}

static int R(classify)(const R(shadow_tile) * tile, const glint_prim *prim, const float lower[3], const float upper[3])
{
    if (prim->kind == GLINT_PRIM_PLANE)
        return R(classify_plane)(tile, prim, lower, upper);
    if (R(sphere_apart)(prim, lower, upper, &tile->light))
        return SOFT_APART;
    return prim->kind == GLINT_PRIM_SPHERE && R(sphere_hides)(tile, prim, lower, upper) ? SOFT_HIDES : SOFT_NEAR;
}

/// Which occluders of the tile matter to a group of which some sample lights `lit`.
static R(soft_group) R(sort_group)(const R(shadow_tile) * tile, R(shadow_group) * group, uint32_t g, unsigned lit)
{
    const glint_occlude_args *args = tile->args;
    R(soft_group) out = { 0 };
    float lower[3], upper[3];
    R(group_box)(tile, group, lit, lower, upper);
    for (int k = 0; k < tile->count && !out.hidden; k++) {
        const uint32_t id = tile->occluders[k].id;
        const glint_prim *prim = &args->geometry->prims[id];
        const unsigned own = lanes_equal(args->prim + group->at, id) & lit;
        const bool passes_own =
            prim->kind == GLINT_PRIM_PLANE || (prim->kind != GLINT_PRIM_TRIANGLE && !(own & args->back[g]));
        if (own == lit && passes_own)
            continue; // it is what all of them leave
        const int class = own ? SOFT_NEAR : R(classify)(tile, prim, lower, upper);
        out.hidden = class == SOFT_HIDES;
        out.near |= (uint16_t)((class == SOFT_NEAR) << k);
    }
    return out;
}

/// What the samples of one call share.
typedef struct R(soft_samples) {
    _Alignas(64) real position[GLINT_LIGHT_CHUNK][3][GLINT_GROUP];
    R(light_sides) sides[GLINT_OCCLUDERS][GLINT_LIGHT_CHUNK];
    unsigned open[GLINT_LIGHT_CHUNK]; ///< of the group at hand
} R(soft_samples);

static void R(prepare_samples)(const R(shadow_tile) * tile, R(soft_samples) * samples)
{
    const glint_occlude_args *args = tile->args;
    for (uint32_t s = 0; s < args->sample_count; s++) {
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < GLINT_GROUP; i++)
                samples->position[s][k][i] = (real)args->lamp[s]->position[k][i];
        for (int k = 0; k < tile->count; k++)
            samples->sides[k][s] = R(seen_sides)(tile, args->lamp[s], &args->geometry->prims[tile->occluders[k].id]);
    }
}

/// Takes out of every sample's open lanes what the tile's occluder k blocks.
static inline void R(block_samples)(const R(shadow_tile) * tile, int k, R(shadow_group) * group,
                                    R(soft_samples) * samples)
{
    const glint_occlude_args *args = tile->args;
    const uint32_t id = tile->occluders[k].id;
    const glint_prim *prim = &args->geometry->prims[id];
    const bool sphere = prim->kind == GLINT_PRIM_SPHERE;
    const unsigned all = (1u << VR) - 1, back = sphere ? args->back[group->at / GLINT_GROUP] : 0;
    unsigned any = 0;
    for (uint32_t s = 0; s < args->sample_count; s++)
        any |= samples->open[s];
    const unsigned own = lanes_equal(args->prim + group->at, id) & any;
    if (prim->kind == GLINT_PRIM_TRIANGLE) {
        for (uint32_t s = 0; s < args->sample_count; s++)
            samples->open[s] &= ~R(blocked_by_triangle)(args, prim, (const real(*)[GLINT_GROUP])samples->position[s],
                                                        group->at, own & samples->open[s], samples->open[s]);
        return;
    }
    if (prim->kind == GLINT_PRIM_SOLID) {
        for (uint32_t s = 0; s < args->sample_count; s++)
            samples->open[s] &=
                ~R(blocked_by_solid)(args, prim, (const real(*)[GLINT_GROUP])samples->position[s], group->at,
                                     own & samples->open[s], samples->open[s], samples->sides[k][s].outside);
        return;
    }
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned others = any & ~own;
        vr c = r_set(0), p[3], d[3], f[3] = { c, c, c };
        if (others >> i & all) {
            R(load3)(args->point, group->at + i, p);
            R(offset)(p, prim, f);
            c = R(offset_constant)(f, prim);
        }
        for (uint32_t s = 0; s < args->sample_count; s++) {
            const R(light_sides) sides = samples->sides[k][s];
            const unsigned lanes = samples->open[s] & ~own, outside = sides.outside >> i & all,
                           inside = sides.inside >> i & all;
            unsigned blocked = (samples->open[s] & own & back & sides.outside) >> i & all;
            if (lanes >> i & all) {
                R(directions_to)(args, (const real(*)[GLINT_GROUP])samples->position[s], group->at, i, d);
                const rm hit = sphere ? R(sphere_blocks)(args, prim, outside, inside, f, c, d)
                                      : R(plane_blocks)(outside, inside, c);
                blocked |= rm_bits(hit) & lanes >> i & all;
            }
            samples->open[s] &= ~(blocked << i);
        }
    }
}

static void R(occlude_listed)(const R(shadow_tile) * tile, const uint16_t *lit)
{
    const glint_occlude_args *args = tile->args;
    R(shadow_group) group = { .last_blocker = GLINT_MISS };
    R(soft_samples) samples;
    R(prepare_samples)(tile, &samples);
    for (uint32_t g = 0; g < args->group_count; g++) {
        R(soft_group) sorted = { 0 };
        if (lit[g]) {
            R(begin_group)(g, &group);
            sorted = R(sort_group)(tile, &group, g, lit[g]);
        }
        for (uint32_t s = 0; s < args->sample_count; s++) {
            samples.open[s] = sorted.hidden ? 0 : args->lit[s][g];
            if (sorted.near && !sorted.hidden)
                *args->rays += (unsigned)__builtin_popcount(samples.open[s]);
        }
        for (unsigned near = sorted.hidden ? 0 : sorted.near; near; near &= near - 1)
            R(block_samples)(tile, __builtin_ctz(near), &group, &samples);
        for (uint32_t s = 0; s < args->sample_count; s++)
            args->open[s][g] = (uint16_t)samples.open[s];
    }
}

/// Too many occluders for a list: every group walks for every sample.
static void R(occlude_walking)(R(shadow_tile) * tile)
{
    const glint_occlude_args *args = tile->args;
    for (uint32_t s = 0; s < args->sample_count; s++) {
        R(shadow_group) group = { .last_blocker = GLINT_MISS };
        R(aim_at)(tile, args->lamp[s]);
        for (uint32_t g = 0; g < args->group_count; g++) {
            unsigned open = args->lit[s][g];
            *args->rays += (unsigned)__builtin_popcount(open);
            if (open) {
                R(begin_group)(g, &group);
                open = R(test_unbounded)(tile, args->lamp[s], &group, open);
                open = R(walk_group)(tile, args->lamp[s], &group, open);
            }
            args->open[s][g] = (uint16_t)open;
        }
    }
}

static void R(occlude_lamp)(const glint_occlude_args *args)
{
    R(shadow_tile) tile;
    uint16_t lit[GLINT_TILE_GROUPS];
    for (uint32_t g = 0; g < args->group_count; g++) {
        lit[g] = 0;
        for (uint32_t s = 0; s < args->sample_count; s++)
            lit[g] |= args->lit[s][g];
    }
    R(begin_shadows)(args, lit, &tile);
    if (tile.count > GLINT_OCCLUDERS)
        R(occlude_walking)(&tile);
    else
        R(occlude_listed)(&tile, lit);
}

static void R(occlude)(const glint_occlude_args *args)
{
    if (GLINT_WITH_CAPS && args->visible)
        R(occlude_caps)(args);
    else if (GLINT_WITH_LAMP && args->lamp[0])
        R(occlude_lamp)(args);
    else
        R(occlude_point)(args);
}
