// The reference of triangles, for one type of real; included by ref/real.h. It follows stages.h line by line.

static REAL NAME(largest)(NAME(vec3) v) { return NAME(max)(NAME(max)(NAME(abs)(v.x), NAME(abs)(v.y)), NAME(abs)(v.z)); }

typedef struct NAME(ray_edges) {
    REAL e[3], dz, depth, sum_of_sizes;
    REAL low[2], high[2]; ///< smallest and largest coordinate of the corners, along each axis
} NAME(ray_edges);

static int NAME(main_axis)(NAME(vec3) d)
{
    int z = NAME(abs)(d.y) > NAME(abs)(d.x) ? 1 : 0;
    return NAME(abs)(d.z) > NAME(abs)(NAME(component)(d, z)) ? 2 : z;
}

static NAME(ray_edges) NAME(make_ray_edges)(const NAME(vec3) corner[3], NAME(vec3) d)
{
    int z = NAME(main_axis)(d), x = (z + 1) % 3, y = (z + 2) % 3;
    REAL dx = NAME(component)(d, x), dy = NAME(component)(d, y), dz = NAME(component)(d, z);
    REAL px[3], py[3], pz[3];
    NAME(ray_edges) out = { .dz = dz };
    for (int j = 0; j < 3; j++) {
        pz[j] = NAME(component)(corner[j], z);
        px[j] = NAME(component)(corner[j], x) * dz - pz[j] * dx;
        py[j] = NAME(component)(corner[j], y) * dz - pz[j] * dy;
    }
    out.e[0] = px[2] * py[1] - py[2] * px[1];
    out.e[1] = px[0] * py[2] - py[0] * px[2];
    out.e[2] = px[1] * py[0] - py[1] * px[0];
    out.depth = (out.e[0] * pz[0] + out.e[1] * pz[1]) + out.e[2] * pz[2];
    out.low[0] = NAME(min)(NAME(min)(px[0], px[1]), px[2]);
    out.low[1] = NAME(min)(NAME(min)(py[0], py[1]), py[2]);
    out.high[0] = NAME(max)(NAME(max)(px[0], px[1]), px[2]);
    out.high[1] = NAME(max)(NAME(max)(py[0], py[1]), py[2]);
    out.sum_of_sizes = NAME(abs)(px[0]) + NAME(abs)(py[0]);
    for (int j = 1; j < 3; j++)
        out.sum_of_sizes = (out.sum_of_sizes + NAME(abs)(px[j])) + NAME(abs)(py[j]);
    return out;
}

static REAL NAME(sum_of_edges)(NAME(ray_edges) s) { return (s.e[0] + s.e[1]) + s.e[2]; }

static bool NAME(all_on_one_side)(NAME(ray_edges) s, REAL reach)
{
    REAL least = NAME(min)(NAME(min)(s.e[0], s.e[1]), s.e[2]), most = NAME(max)(NAME(max)(s.e[0], s.e[1]), s.e[2]);
    return least >= -reach || most <= reach;
}

static bool NAME(between_corners)(NAME(ray_edges) s, REAL reach)
{
    return s.low[0] <= reach && s.low[1] <= reach && s.high[0] >= -reach && s.high[1] >= -reach;
}

static bool NAME(passes)(NAME(ray_edges) s)
{
    REAL least = NAME(min)(NAME(min)(s.e[0], s.e[1]), s.e[2]), most = NAME(max)(NAME(max)(s.e[0], s.e[1]), s.e[2]);
    return least > 0 || most < 0 || ((least == 0 || most == 0) && NAME(between_corners)(s, 0));
}

static void NAME(relative_corners)(const glint_prim *prim, NAME(vec3) from, double scale, NAME(vec3) out[3])
{
    for (int j = 0; j < 3; j++)
        out[j] = NAME(times)(NAME(sub)(NAME(rounded)(prim->corner[j]), from), (REAL)scale);
}

/// Returns the distance at which a ray crosses the plane of a triangle: the plane of the triangle's corners, or a
/// plane that it shares with others.
static REAL NAME(plane_distance)(const glint_geometry_table *table, const glint_prim *prim, NAME(ray_edges) seen,
                                 NAME(vec3) origin, NAME(vec3) direction)
{
    const glint_face *face = prim->face ? &table->faces[prim->face - 1] : NULL;
    if (face)
        return -NAME(over_face)(face, origin) / NAME(rise)(face, direction);
    return seen.depth / ((NAME(sum_of_edges)(seen) * seen.dz) * (REAL)table->scale);
}


static NAME(vec3) NAME(flat_normal)(const glint_prim *prim, double scale)
{
    double f[3], g[3], m[3];
    for (int k = 0; k < 3; k++) {
        f[k] = (prim->corner[1][k] - prim->corner[0][k]) * scale;
        g[k] = (prim->corner[2][k] - prim->corner[0][k]) * scale;
    }
    m[0] = f[1] * g[2] - f[2] * g[1];
    m[1] = f[2] * g[0] - f[0] * g[2];
    m[2] = f[0] * g[1] - f[1] * g[0];
    double length = sqrt(dot_of(m, m));
    return NAME(vec)((REAL)(m[0] / length), (REAL)(m[1] / length), (REAL)(m[2] / length));
}

/// Computes the hit point, the weights of the corners there, and an error bound of the point.
static NAME(vec3) NAME(triangle_point)(const glint_surface_args *args, const glint_prim *prim, NAME(vec3) origin,
                                       NAME(vec3) direction, REAL weight[3], REAL *slack)
{
    NAME(vec3) corner[3], v0 = NAME(rounded)(prim->corner[0]);
    NAME(relative_corners)(prim, origin, args->scale, corner);
    NAME(ray_edges) seen = NAME(make_ray_edges)(corner, direction);
    REAL inverse = 1 / NAME(sum_of_edges)(seen);
    for (int j = 0; j < 3; j++)
        weight[j] = seen.e[j] * inverse;
    NAME(vec3) f = NAME(sub)(NAME(rounded)(prim->corner[1]), v0), g = NAME(sub)(NAME(rounded)(prim->corner[2]), v0);
    NAME(vec3) point = NAME(add)(v0, NAME(add)(NAME(times)(f, weight[1]), NAME(times)(g, weight[2])));
    *slack = NAME(POINT_SLACK) * ((NAME(largest)(f) + NAME(largest)(g)) + NAME(largest)(point));
    return point;
}

static NAME(vec3)
    NAME(smooth_normal)(const glint_corner_normals *corners, const REAL weight[3], NAME(vec3) flat, bool back)
{
    NAME(vec3) s = NAME(times)(NAME(rounded)(corners->normal[0]), weight[0]);
    s = NAME(add)(s, NAME(times)(NAME(rounded)(corners->normal[1]), weight[1]));
    s = NAME(add)(s, NAME(times)(NAME(rounded)(corners->normal[2]), weight[2]));
    REAL l = NAME(length2)(s);
    s = l > 0 ? NAME(over)(s, NAME(square_root)(l)) : flat;
    return NAME(dot)(s, back ? NAME(negated)(flat) : flat) < 0 ? NAME(negated)(s) : s;
}

/// Moves a point towards the surface that the normals at the corners describe (J. Hanika, "Hacking the Shadow
/// Terminator", Ray Tracing Gems II, 2021).
static NAME(vec3) NAME(toward_curve)(const glint_prim *prim, const glint_corner_normals *corners, const REAL weight[3],
                                     NAME(vec3) flat, bool back, NAME(vec3) point)
{
    NAME(vec3) n[3], sum = NAME(vec)(0, 0, 0);
    for (int j = 0; j < 3; j++)
        n[j] = NAME(rounded)(corners->normal[j]);
    NAME(vec3) curved = NAME(add)(NAME(add)(NAME(times)(n[0], weight[0]), NAME(times)(n[1], weight[1])),
                                  NAME(times)(n[2], weight[2]));
    bool away = NAME(dot)(curved, back ? NAME(negated)(flat) : flat) < 0;
    for (int j = 0; j < 3; j++) {
        NAME(vec3) q = NAME(sub)(point, NAME(rounded)(prim->corner[j]));
        REAL l = NAME(length2)(n[j]), h = NAME(dot)(n[j], q), below = NAME(min)(away ? -h : h, 0);
        REAL move = l > 0 ? (weight[j] * (away ? -below : below)) / l : 0;
        sum = NAME(add)(sum, NAME(times)(n[j], move));
    }
    return NAME(sub)(point, NAME(times)(sum, (REAL)corners->terminator));
}

// ---- occlude ----

typedef struct NAME(parted) {
    NAME(vec3) m, sizes;
    REAL light;
} NAME(parted);

static NAME(parted) NAME(part)(const glint_occlude_args *args, const glint_prim *prim, NAME(vec3) position)
{
    REAL scale = (REAL)args->geometry->scale;
    NAME(vec3) v0 = NAME(rounded)(prim->corner[0]);
    NAME(vec3) f = NAME(times)(NAME(sub)(NAME(rounded)(prim->corner[1]), v0), scale);
    NAME(vec3) g = NAME(times)(NAME(sub)(NAME(rounded)(prim->corner[2]), v0), scale);
    NAME(parted) out = { .m = NAME(cross)(f, g) };
    out.sizes = NAME(vec)(NAME(abs)(f.y * g.z) + NAME(abs)(f.z * g.y), NAME(abs)(f.z * g.x) + NAME(abs)(f.x * g.z),
                          NAME(abs)(f.x * g.y) + NAME(abs)(f.y * g.x));
    out.light = NAME(dot)(out.m, args->directional ? position : NAME(sub)(position, v0));
    return out;
}

/// Returns whether a point is within a triangle's bounds, enlarged by `loose`.
static bool NAME(in_box)(const NAME(vec3) corner[3], NAME(vec3) point, REAL loose)
{
    for (int k = 0; k < 3; k++) {
        REAL a = NAME(component)(corner[0], k), b = NAME(component)(corner[1], k), c = NAME(component)(corner[2], k);
        REAL at = NAME(component)(point, k);
        if (!(NAME(min)(NAME(min)(a, b), c) <= at + loose && NAME(max)(NAME(max)(a, b), c) >= at - loose))
            return false;
    }
    return true;
}

static bool NAME(touched_triangle_blocks)(const glint_occlude_args *args, NAME(parted) plane, NAME(ray_edges) seen,
                                          const NAME(vec3) corner[3], REAL slack, NAME(vec3) ray)
{
    REAL r = 0;
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            r = NAME(max)(r, NAME(abs)(NAME(component)(corner[j], k)));
    REAL loose = 2 * (slack * (REAL)args->geometry->scale) + NAME(POINT_SLACK) * r;
    REAL move = NAME(abs)(seen.dz) * loose;
    REAL reach = move * (seen.sum_of_sizes + 2 * move);
    REAL away = NAME(dot)(plane.m, ray);
    bool other_side = (away < 0 && plane.light < 0) || (away > 0 && plane.light > 0);
    return other_side && NAME(all_on_one_side)(seen, reach) && NAME(between_corners)(seen, move) &&
           NAME(in_box)(corner, NAME(vec)(0, 0, 0), loose);
}

/// Returns whether the triangle blocks sample i, which is on another surface.
static bool NAME(triangle_blocks)(const glint_occlude_args *args, const glint_prim *prim, NAME(parted) plane,
                                  NAME(vec3) position, uint32_t i)
{
    NAME(vec3) point = NAME(load)(args->point, i);
    NAME(vec3) d = args->directional ? position : NAME(times)(NAME(sub)(position, point), (REAL)args->scale);
    NAME(vec3) ray = NAME(direction_of)(args->camera, args->direction, i);
    REAL slack = ((const REAL *)args->slack)[i];
    NAME(vec3) corner[3], q = NAME(sub)(point, NAME(rounded)(prim->corner[0])), m = plane.m, sizes = plane.sizes;
    NAME(relative_corners)(prim, point, args->geometry->scale, corner);
    NAME(ray_edges) seen = NAME(make_ray_edges)(corner, d);
    REAL h = NAME(dot)(m, q);
    REAL rounding = NAME(dot)(sizes, NAME(vec)(NAME(abs)(q.x), NAME(abs)(q.y), NAME(abs)(q.z)));
    REAL bound = ((NAME(abs)(m.x) + NAME(abs)(m.y)) + NAME(abs)(m.z)) * NAME(abs)(slack) + NAME(POINT_SLACK) * rounding;
    if (NAME(abs)(h) <= bound)
        return slack > 0 && NAME(touched_triangle_blocks)(args, plane, seen, corner, slack, ray);
    bool crosses = (h < 0 && plane.light > 0) || (h > 0 && plane.light < 0);
    REAL det = NAME(sum_of_edges)(seen);
    return crosses && NAME(passes)(seen) && (det < 0 || det > 0);
}

// ---- cast ----

/// Computes the height of a point over a triangle's plane, and the rounding error of the height.
static REAL NAME(height)(NAME(parted) plane, const glint_prim *prim, NAME(vec3) at, REAL *rounding)
{
    NAME(vec3) q = NAME(sub)(at, NAME(rounded)(prim->corner[0]));
    NAME(vec3) sizes = NAME(vec)(NAME(abs)(q.x), NAME(abs)(q.y), NAME(abs)(q.z));
    *rounding = NAME(POINT_SLACK) * NAME(dot)(plane.sizes, sizes);
    return NAME(dot)(plane.m, q);
}

static REAL NAME(plane_spread)(NAME(parted) plane)
{
    return (NAME(abs)(plane.m.x) + NAME(abs)(plane.m.y)) + NAME(abs)(plane.m.z);
}

/// Returns whether a point is in the plane within rounding; on_surface: whether the point was computed on some
/// surface, and has the rounding error of such points.
static bool NAME(in_plane)(NAME(parted) plane, const glint_prim *prim, NAME(vec3) point, bool on_surface)
{
    REAL rounding, h = NAME(height)(plane, prim, point, &rounding);
    if (on_surface)
        rounding = rounding + NAME(plane_spread)(plane) * (NAME(POINT_SLACK) * NAME(largest)(point));
    return NAME(abs)(h) <= rounding;
}

/// Returns the distance at which a ray hits a triangle; 0: a miss.
static REAL NAME(triangle_t)(const glint_geometry_table *table, const glint_prim *prim, NAME(vec3) origin,
                             NAME(vec3) direction, bool on_surface)
{
    const glint_occlude_args plane_of = { .geometry = table, .directional = true };
    NAME(vec3) corner[3];
    NAME(relative_corners)(prim, origin, table->scale, corner);
    NAME(ray_edges) seen = NAME(make_ray_edges)(corner, direction);
    REAL t = NAME(plane_distance)(table, prim, seen, origin, direction);
    if (!NAME(passes)(seen) || !(t > 0))
        return 0;
    bool begins = !prim->face && t <= (REAL)(GLINT_NEAR_SHARED_EDGE * table->extent) &&
                  NAME(in_plane)(NAME(part)(&plane_of, prim, direction), prim, origin, on_surface);
    return begins ? 0 : t;
}

/// Returns whether a corner of `other` is certainly on the side of the plane that `side` points to.
static bool NAME(has_corner)(NAME(parted) plane, const glint_prim *prim, REAL side, const glint_prim *other)
{
    for (int j = 0; j < 3; j++) {
        NAME(vec3) corner = NAME(rounded)(other->corner[j]);
        REAL rounding, h = NAME(height)(plane, prim, corner, &rounding);
        if (NAME(abs)(h) > rounding + NAME(plane_spread)(plane) * (NAME(POINT_SLACK) * NAME(largest)(corner)) &&
            ((h > 0 && side > 0) || (h < 0 && side < 0)))
            return true;
    }
    return false;
}

/// Returns whether the ray, which starts on triangle `from`, lies in the planes of both triangles within rounding. If
/// so, *t is the distance at which it passes through `prim`, or 0.
static bool NAME(is_shared_edge)(const glint_geometry_table *table, const glint_prim *from, const glint_prim *prim,
                                 NAME(vec3) origin, NAME(vec3) direction, REAL *t)
{
    if (from->kind != GLINT_PRIM_TRIANGLE || prim->kind != GLINT_PRIM_TRIANGLE)
        return false;
    const glint_occlude_args plane_of = { .geometry = table, .directional = true };
    NAME(parted) here = NAME(part)(&plane_of, prim, direction), there = NAME(part)(&plane_of, from, direction);
    NAME(vec3) v0 = NAME(rounded)(from->corner[0]), corner[3];
    REAL slack = NAME(POINT_SLACK) * ((NAME(largest)(NAME(sub)(NAME(rounded)(from->corner[1]), v0)) +
                                       NAME(largest)(NAME(sub)(NAME(rounded)(from->corner[2]), v0))) +
                                      NAME(largest)(origin));
    REAL rounding, h = NAME(height)(here, prim, origin, &rounding);
    bool begins = !(NAME(abs)(h) > NAME(plane_spread)(here) * slack + rounding);
    NAME(relative_corners)(prim, origin, table->scale, corner);
    NAME(ray_edges) seen = NAME(make_ray_edges)(corner, direction);
    REAL distance = NAME(plane_distance)(table, prim, seen, origin, direction);
    bool soon = distance > 0 && distance <= (REAL)(GLINT_NEAR_SHARED_EDGE * table->extent);
    bool still_on = distance * NAME(abs)(there.light) <= NAME(plane_spread)(there) * slack;
    bool by_edge = distance > 0 && !NAME(passes)(seen);
    if (!begins && !(soon && still_on) && !by_edge)
        return false;
    REAL r = 0;
    for (int j = 0; j < 3; j++)
        r = NAME(max)(r, NAME(largest)(corner[j]));
    REAL loose = 2 * (slack * (REAL)table->scale) + NAME(POINT_SLACK) * r;
    REAL move = NAME(abs)(seen.dz) * loose, reach = move * (seen.sum_of_sizes + 2 * move);
    NAME(vec3) at = NAME(times)(NAME(times)(direction, begins ? 0 : distance), (REAL)table->scale);
    bool through = NAME(has_corner)(there, from, there.light, prim) &&
                   NAME(has_corner)(here, prim, -here.light, from) && NAME(in_box)(corner, at, loose) &&
                   NAME(all_on_one_side)(seen, reach) && NAME(between_corners)(seen, move);
    *t = !through ? 0 : begins ? (REAL)GLINT_LEAST_T : distance;
    return true;
}
