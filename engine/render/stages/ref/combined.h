// The reference of combined solids, for one type of real; included by ref/cast.h. It follows stages.h line by line.

/// The interval of a ray inside a part: in < out, or empty.
typedef struct NAME(stretch) {
    REAL in, out;
} NAME(stretch);

/// The primitive that a ray starts on, and whether the ray goes into the whole there.
typedef struct NAME(start) {
    uint32_t on; ///< index in prims, or GLINT_MISS
    bool inward;
} NAME(start);

static NAME(stretch) NAME(nowhere)(void) { return (NAME(stretch)) { INFINITY, -INFINITY }; }

static NAME(stretch) NAME(behind_plane)(const glint_prim *plane, NAME(vec3) origin, NAME(vec3) direction)
{
    REAL h = NAME(over_plane)(plane, origin, true), nd = NAME(dot)(NAME(rounded)(plane->normal), direction);
    if (!(nd * nd >= NAME(PLANE_GRAZING) * NAME(length2)(direction)))
        return h <= 0 ? (NAME(stretch)) { -INFINITY, INFINITY } : NAME(nowhere)();
    REAL t = -h / nd;
    return nd > 0 ? (NAME(stretch)) { -INFINITY, t } : (NAME(stretch)) { t, INFINITY };
}

static NAME(stretch) NAME(within_part)(const glint_geometry_table *geometry, const glint_prim *part,
                                       NAME(vec3) origin, NAME(vec3) direction)
{
    if (part->kind == GLINT_PRIM_PLANE)
        return NAME(behind_plane)(part, origin, direction);
    NAME(passage) p = NAME(pass_prim)(&geometry->solids[part->item], part, origin, direction);
    return p.hit ? (NAME(stretch)) { p.in.t, p.out.t } : NAME(nowhere)();
}

/// Returns the interval of a ray that starts on the part: up to the part's other side, or empty.
static NAME(stretch) NAME(from_part)(const glint_geometry_table *geometry, const glint_prim *part, NAME(vec3) origin,
                                     NAME(vec3) direction, bool inward)
{
    if (inward == (part->inverted != 0))
        return NAME(nowhere)();
    if (part->kind == GLINT_PRIM_PLANE)
        return (NAME(stretch)) { -INFINITY, INFINITY };
    NAME(passage) p = NAME(pass_prim)(&geometry->solids[part->item], part, origin, direction);
    return (NAME(stretch)) { -INFINITY, NAME(max)(p.out.t, (REAL)GLINT_LEAST_T) };
}

/// Returns one of the two intervals in which a ray may be inside a torus.
static NAME(stretch) NAME(within_torus)(const glint_geometry_table *geometry, const glint_prim *part, NAME(vec3) origin,
                                        NAME(vec3) direction, bool own, bool inward)
{
    const glint_solid *solid = &geometry->solids[part->item];
    REAL ends[4];
    NAME(torus_ends)(solid, NAME(unit_point)(solid, part, origin), NAME(into_unit)(solid, direction), own,
                     inward != (part->inverted != 0), ends);
    return (NAME(stretch)) { ends[2 * (part->face - 1)], ends[2 * (part->face - 1) + 1] };
}

#include "engine/render/stages/ref/hull.h"

static NAME(stretch) NAME(stretch_of)(const glint_geometry_table *geometry, uint32_t index, NAME(vec3) origin,
                                      NAME(vec3) direction, NAME(start) start)
{
    const glint_prim *part = &geometry->prims[index];
    if (part->kind == GLINT_PRIM_HULL)
        return NAME(nowhere)(); // a mesh can have many intervals: see ref/hull.h
    if (part->kind == GLINT_PRIM_SOLID && part->face)
        return NAME(within_torus)(geometry, part, origin, direction,
                                  start.on == index || start.on == (part->face == 1 ? index + 1 : index - 1), start.inward);
    return start.on == index ? NAME(from_part)(geometry, part, origin, direction, start.inward)
                             : NAME(within_part)(geometry, part, origin, direction);
}

/// Whether the ray is inside a set just before and just after a position on the ray.
typedef struct NAME(change) {
    bool before, after; ///< the ray is inside just before the position, and just after it
    uint32_t part; ///< if the ray enters or leaves the set there: the part on whose surface it does
} NAME(change);

static NAME(change) NAME(combine)(uint8_t operation, NAME(change) a, NAME(change) b)
{
    NAME(change) out;
    if (operation == GLINT_COMBINE_DIFFERENCE) {
        b.before = !b.before;
        b.after = !b.after;
    }
    if (operation == GLINT_COMBINE_UNION) {
        out.before = a.before || b.before;
        out.after = a.after || b.after;
    } else {
        out.before = a.before && b.before;
        out.after = a.after && b.after;
    }
    out.part = a.before == out.before && a.after == out.after ? a.part : b.part;
    return out;
}

/// A ray and the combined solid that it is tested against.
typedef struct NAME(passing) {
    const glint_geometry_table *geometry;
    const glint_combined *whole;
    NAME(vec3) origin, direction;
    NAME(start) start;
    NAME(stretch) part[GLINT_PARTS_MAX];
} NAME(passing);

static NAME(change) NAME(change_of_part)(const NAME(passing) * ray, uint32_t j, REAL t)
{
    const uint32_t index = ray->geometry->prim_count + ray->whole->first + j;
    const glint_prim *part = &ray->geometry->prims[index];
    if (part->kind == GLINT_PRIM_HULL && part->face == 1) {
        NAME(hull_change)
        change = NAME(hull_change_at)(ray->geometry, part, ray->origin, ray->direction, ray->start, t);
        return (NAME(change)) { change.before, change.after, change.triangle };
    }
    return (NAME(change)) { ray->part[j].in < t && t <= ray->part[j].out, ray->part[j].in <= t && t < ray->part[j].out, index };
}

static NAME(change) NAME(change_at)(const NAME(passing) * ray, REAL t)
{
    NAME(change) stack[GLINT_PARTS_MAX];
    int top = 0;
    for (uint32_t k = 0; k < ray->whole->length; k++) {
        uint8_t p = ray->whole->program[k];
        if (p == GLINT_COMBINE_NOTHING) {
            stack[top++] = (NAME(change)) { false, false, 0 };
        } else if (p < GLINT_PARTS_MAX) {
            stack[top++] = NAME(change_of_part)(ray, p, t);
        } else {
            top--;
            stack[top - 1] = NAME(combine)(p, stack[top - 1], stack[top]);
        }
    }
    return stack[0];
}

/// Takes the change at t if it is nearer than the best one so far.
static void NAME(consider)(const NAME(passing) * ray, REAL t, REAL *best, uint32_t *hit_prim)
{
    if (!(t > 0 && t < *best))
        return;
    NAME(change) change = NAME(change_at)(ray, t);
    if (change.before == change.after)
        return;
    *best = t;
    *hit_prim = change.part;
}

/// Returns the distance at which a ray hits a combined solid; 0: a miss. *hit_prim: the index in prims of the part,
/// or of the part's triangle.
static REAL NAME(combined_t)(const glint_geometry_table *geometry, const glint_prim *prim, NAME(vec3) origin,
                             NAME(vec3) direction, NAME(start) start, uint32_t *hit_prim)
{
    NAME(passing) ray = { geometry, &geometry->combined[prim->item], origin, direction, start, { { 0, 0 } } };
    const uint32_t first = geometry->prim_count + ray.whole->first;
    REAL best = INFINITY, t;
    for (uint32_t j = 0; j < ray.whole->count; j++)
        ray.part[j] = NAME(stretch_of)(geometry, first + j, origin, direction, start);
    for (uint32_t j = 0; j < ray.whole->count; j++) {
        const glint_prim *part = &geometry->prims[first + j];
        NAME(consider)(&ray, ray.part[j].in, &best, hit_prim);
        NAME(consider)(&ray, ray.part[j].out, &best, hit_prim);
        if (part->kind != GLINT_PRIM_HULL || part->face != 1)
            continue;
        for (uint32_t k = 0; k < geometry->hulls[part->item].count; k++)
            if (NAME(hull_crossing)(geometry, part, k, origin, direction, start, &t))
                NAME(consider)(&ray, t, &best, hit_prim);
        NAME(consider)(&ray, (REAL)GLINT_LEAST_T, &best, hit_prim); // for rays that start on the solid
    }
    return best < INFINITY ? best : 0;
}

/// Returns whether a segment from a surface point to the light is blocked.
static bool NAME(combined_blocks)(const glint_occlude_args *args, const glint_prim *prim, NAME(vec3) position,
                                  uint32_t i)
{
    NAME(vec3) point = NAME(load)(args->point, i);
    NAME(vec3) d = args->directional ? position : NAME(times)(NAME(sub)(position, point), (REAL)args->scale);
    NAME(start) start = { args->prim[i], args->back[i / GLINT_GROUP] >> i % GLINT_GROUP & 1 };
    uint32_t hit_prim;
    REAL t = NAME(combined_t)(args->geometry, prim, point, d, start, &hit_prim);
    return t > 0 && (args->directional || t * (REAL)args->scale < 1);
}
