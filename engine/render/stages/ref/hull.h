// The reference of closed meshes that are parts of combined solids; included by ref/combined.h. It follows stages.h
// line by line.

/// Returns the orientation of the triangle as seen along a ray: 1 or -1 if the ray passes through the triangle,
/// otherwise 0. A ray through an edge or corner is treated as if it were shifted along the two perpendicular axes,
/// along the second infinitely more than along the first. So the ray passes through exactly one of the triangles that
/// share the edge or corner, or none.
static int NAME(orientation)(const NAME(vec3) corner[3], NAME(vec3) d)
{
    int z = NAME(main_axis)(d), x = (z + 1) % 3, y = (z + 2) % 3, orientation = 0;
    REAL dx = NAME(component)(d, x), dy = NAME(component)(d, y), dz = NAME(component)(d, z), px[3], py[3];
    for (int j = 0; j < 3; j++) {
        REAL pz = NAME(component)(corner[j], z);
        px[j] = NAME(component)(corner[j], x) * dz - pz * dx;
        py[j] = NAME(component)(corner[j], y) * dz - pz * dy;
    }
    for (int j = 0; j < 3; j++) {
        int k = (j + 1) % 3;
        REAL side = px[j] * py[k] - py[j] * px[k];
        if (py[j] <= 0 && py[k] > 0 && side > 0)
            orientation++;
        if (py[k] <= 0 && py[j] > 0 && side < 0)
            orientation--;
    }
    return dz > 0 ? orientation : -orientation;
}

static bool NAME(starts_on_hull)(const glint_geometry_table *table, const glint_hull *hull, NAME(start) start)
{
    const uint32_t first = table->prim_count + hull->first;
    return start.on != GLINT_MISS && start.on >= first && start.on - first < hull->count;
}

/// Returns whether the ray starts in the triangle's plane, within rounding. For a plane that triangles share, t = 0
/// decides, except for a ray that starts on the mesh, which may start at an edge.
static bool NAME(begins_on)(const glint_geometry_table *table, const glint_prim *prim, NAME(vec3) origin,
                            NAME(vec3) direction, bool on_surface, bool on_hull, REAL t)
{
    const glint_occlude_args plane_of = { .geometry = table, .directional = true };
    REAL near = (REAL)(GLINT_NEAR_SHARED_EDGE * table->extent);
    return (!prim->face || on_hull) && t <= near && -near <= t &&
           NAME(in_plane)(NAME(part)(&plane_of, prim, direction), prim, origin, on_surface);
}

/// Returns how the ray crosses triangle k of the mesh: 1: it leaves, -1: it enters, 0: no crossing; *t: the distance
/// of the crossing, within the triangle's range of depth.
static int NAME(crossing_sign)(const glint_geometry_table *table, const glint_prim *part, uint32_t k, NAME(vec3) origin,
                               NAME(vec3) direction, REAL *t)
{
    const glint_prim *prim = &table->prims[table->prim_count + table->hulls[part->item].first + k];
    NAME(vec3) corner[3];
    NAME(relative_corners)(prim, origin, table->scale, corner);
    int orientation = NAME(orientation)(corner, direction), z = NAME(main_axis)(direction);
    if (!orientation)
        return 0;
    NAME(ray_edges) seen = NAME(make_ray_edges)(corner, direction);
    *t = NAME(plane_distance)(table, prim, seen, origin, direction);
    if (!prim->face) {
        REAL w[3];
        for (int j = 0; j < 3; j++)
            w[j] = NAME(component)(corner[j], z) / (seen.dz * (REAL)table->scale);
        *t = NAME(min)(NAME(max)(*t, NAME(min)(NAME(min)(w[0], w[1]), w[2])), NAME(max)(NAME(max)(w[0], w[1]), w[2]));
    }
    return part->inverted ? -orientation : orientation;
}

/// Returns the same for crossings ahead of the ray's origin, without the triangle that the ray starts on, and without
/// other triangles in whose plane it starts.
static int NAME(hull_crossing)(const glint_geometry_table *table, const glint_prim *part, uint32_t k, NAME(vec3) origin,
                          NAME(vec3) direction, NAME(start) start, REAL *t)
{
    const uint32_t index = table->prim_count + table->hulls[part->item].first + k;
    const bool on_hull = NAME(starts_on_hull)(table, &table->hulls[part->item], start);
    int winding = start.on == index ? 0 : NAME(crossing_sign)(table, part, k, origin, direction, t);
    if (!winding || !(*t > 0) ||
        NAME(begins_on)(table, &table->prims[index], origin, direction, start.on != GLINT_MISS, on_hull, *t))
        return 0;
    return winding;
}

/// For a ray that starts on the mesh, it is known whether it goes inside. If the crossings ahead disagree, an exit or
/// entry at the origin is added. Returns the direction of the added crossing, times the number of crossings that are
/// needed. *triangle: the first triangle that the ray crosses in that direction at its origin; if there is none, the
/// triangle that the ray starts on.
static int NAME(hull_crossing_at_start)(const glint_geometry_table *table, const glint_prim *part, NAME(vec3) origin,
                                   NAME(vec3) direction, NAME(start) start, uint32_t *triangle)
{
    const glint_hull *hull = &table->hulls[part->item];
    const uint32_t first = table->prim_count + hull->first;
    int ahead = 0;
    REAL t;
    if (!NAME(starts_on_hull)(table, hull, start))
        return 0;
    for (uint32_t k = 0; k < hull->count; k++)
        ahead += NAME(hull_crossing)(table, part, k, origin, direction, start, &t);
    const bool inside = start.inward != (part->inverted != 0);
    *triangle = start.on;
    if (inside == (ahead > 0))
        return 0;
    const int winding = (inside ? 1 : 0) - ahead;
    for (uint32_t k = hull->count; k-- > 0;) {
        int through = first + k == start.on ? 0 : NAME(crossing_sign)(table, part, k, origin, direction, &t);
        if (through * winding > 0 &&
            (t == 0 || NAME(begins_on)(table, &table->prims[first + k], origin, direction, true, true, t)))
            *triangle = first + k;
    }
    return winding;
}

/// Whether the ray is inside the mesh just before and just after a point: it is inside if there are more exits than
/// entries ahead.
typedef struct NAME(hull_change) {
    bool before, after;
    uint32_t triangle; ///< the first triangle that the ray crosses there in the direction of the change
} NAME(hull_change);

static void NAME(note_crossing)(int winding, bool here, bool later, uint32_t triangle, int remaining[2],
                                uint32_t found[2])
{
    remaining[0] += here || later ? winding : 0;
    remaining[1] += later ? winding : 0;
    if (here && winding && found[winding > 0] == GLINT_MISS)
        found[winding > 0] = triangle;
}

static NAME(hull_change) NAME(hull_change_at)(const glint_geometry_table *table, const glint_prim *part, NAME(vec3) origin,
                                              NAME(vec3) direction, NAME(start) start, REAL t)
{
    const glint_hull *hull = &table->hulls[part->item];
    const REAL least = (REAL)GLINT_LEAST_T;
    int remaining[2] = { 0, 0 };
    uint32_t found[2] = { GLINT_MISS, GLINT_MISS }, triangle = GLINT_MISS;
    int winding = NAME(hull_crossing_at_start)(table, part, origin, direction, start, &triangle);
    NAME(note_crossing)(winding, t == least, t < least, triangle, remaining, found);
    for (uint32_t k = 0; k < hull->count; k++) {
        REAL at;
        winding = NAME(hull_crossing)(table, part, k, origin, direction, start, &at);
        if (winding)
            NAME(note_crossing)(winding, at == t, at > t, table->prim_count + hull->first + k, remaining, found);
    }
    return (NAME(hull_change)) { remaining[0] > 0, remaining[1] > 0, found[remaining[0] > 0] };
}
