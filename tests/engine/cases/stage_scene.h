/// Scenes for the tests of the geometry stages: primitives placed where a hit is hard to decide, and the tables that
/// stages.h promises the kernels, built only from its specification. The index is the engine's BVH over boxes that
/// are made here.
#ifndef GLINT_STAGE_SCENE_H
#define GLINT_STAGE_SCENE_H

#include "engine/render/geometry/bvh.h"
#include "tests/engine/cases/stage_case.h"

enum { MOST_PRIMS = 3000, MOST_LINES = 256 };

/// A ray, or the segment from a point to a light. Primitives are placed around it.
typedef struct test_line {
    double origin[3];
    double direction[3]; ///< unit vector
    double length; ///< the length along which hits matter; for a segment, its whole length
} test_line;

/// The properties of a random scene.
typedef struct scene_plan {
    double middle[3], size; ///< the region for primitives that are not placed near a line
    double spread; ///< radii are smaller than `size` by up to this many powers of ten
    bool triangles, solids; ///< whether some primitives are triangles, solids
    uint32_t count; ///< number of primitives; 0: random
    uint32_t line_count;
    test_line lines[MOST_LINES];
} scene_plan;

typedef struct test_scene {
    glint_geometry_table table;
    glint_bvh bvh;
    glint_prim prims[MOST_PRIMS];
    glint_solid solids[MOST_PRIMS];
    glint_face faces[6 * MOST_PRIMS];
    uint32_t face_count;
    uint32_t unbounded[MOST_PRIMS];
    double corners[MOST_PRIMS][3][3];
} test_scene;

// ---- Primitives --------------------------------------------------------------------------------------------------

/// Storage for a primitive's corners or normal, reused after a few scenes.
static inline double (*corner_buffer(void))[3]
{
    static double buffer[8 * MOST_PRIMS][3][3];
    static uint32_t next;
    return buffer[next++ % (8 * MOST_PRIMS)];
}

static inline void set_sphere(glint_prim *prim, const double center[3], double radius)
{
    *prim = (glint_prim) { .kind = GLINT_PRIM_SPHERE, .radius = radius };
    memcpy(prim->center, center, sizeof prim->center);
}

static inline void set_plane(glint_prim *prim, const double point[3], const double normal[3])
{
    *prim = (glint_prim) { .kind = GLINT_PRIM_PLANE };
    memcpy(prim->center, point, sizeof prim->center);
    prim->normal = corner_buffer()[0];
    memcpy(prim->normal, normal, 3 * sizeof *normal);
    prim->normal[3] = 0;
}

/// Returns 0, or a random number between 1e-16 and 1 with either sign.
static inline double slight(void) { return one_in(5) ? 0 : either_sign(power_of_ten(-16, -1)); }

/// A sphere whose silhouette the line touches, or misses by 1e-16 .. 1e-1 radii.
static inline void set_grazing(glint_prim *prim, const test_line *line, double radius)
{
    double center[3], across[3];
    double distance = one_in(2) ? line->length * between(-0.2, 1.3) : line->length + radius * between(-2, 2);
    random_across(line->direction, across);
    along3(line->origin, distance, line->direction, center);
    if (one_in(4)) { // sideways, along an axis
        memset(across, 0, sizeof across);
        across[below(3)] = either_sign(1);
    }
    along3(center, radius * (1 + slight()), across, center);
    set_sphere(prim, center, radius);
}

/// A sphere whose surface contains the point at `distance` along the line, exactly or nearly.
static inline void set_touching(glint_prim *prim, const test_line *line, double distance, double radius)
{
    double place[3], center[3], outwards[3];
    along3(line->origin, distance, line->direction, place);
    random_unit(outwards);
    if (one_in(4)) { // exactly, along an axis
        memset(outwards, 0, sizeof outwards);
        outwards[below(3)] = either_sign(1);
    }
    along3(place, -radius * (1 + (one_in(2) ? 0 : slight())), outwards, center);
    set_sphere(prim, center, radius);
}

/// Places a plane through a point on a line or in the scene. Some planes contain the line.
static inline void set_random_plane(glint_prim *prim, const scene_plan *plan, const test_line *line)
{
    double point[3], normal[3];
    for (int c = 0; c < 3; c++)
        point[c] = plan->middle[c] + plan->size * between(-1, 1);
    random_unit(normal);
    if (one_in(3)) {
        memset(normal, 0, sizeof normal);
        normal[below(3)] = either_sign(1);
    }
    const uint32_t where = below(6);
    if (where < 2)
        along3(line->origin, where ? line->length : 0, line->direction, point);
    if (where == 2)
        random_across(line->direction, normal);
    set_plane(prim, point, normal);
}

/// Three corners around a point on the line or anywhere. Some triangles share an edge with the previous triangle, lie
/// in its plane or have an edge parallel to the line.
static inline void set_random_triangle(glint_prim *prim, const glint_prim *last, const test_line *line,
                                       const double center[3], double size)
{
    const bool joined = last && last->kind == GLINT_PRIM_TRIANGLE && one_in(3), near = one_in(2);
    double away[3], place[3];
    glint_prim out = {
        .kind = GLINT_PRIM_TRIANGLE, .corner = corner_buffer(), .item = GLINT_MISS, .shading_points = GLINT_MISS
    };
    along3(line->origin, line->length * between(-0.2, 1.2), line->direction, place);
    for (int j = 0; j < 3; j++) {
        random_unit(away);
        along3(near ? place : center, size * between(0.1, 2), away, out.corner[j]);
        if (joined && j < 2)
            memcpy(out.corner[j], last->corner[1 - j], sizeof out.corner[j]);
    }
    if (joined && one_in(2))
        for (int k = 0; k < 3; k++)
            out.corner[2][k] = last->corner[0][k] + (last->corner[1][k] - last->corner[2][k]);
    else if (one_in(6))
        along3(out.corner[0], size, line->direction, out.corner[1]);
    if (!joined && one_in(4)) // perpendicular to an axis
        for (int j = 0, c = (int)below(3); j < 3; j++)
            out.corner[j][c] = out.corner[0][c];
    *prim = out;
}

/// An affine image of a random unit shape: rotated, stretched and sheared. Some are thin; half have a round
/// cross-section perpendicular to the axis.
static inline void set_random_solid(test_scene *scene, uint32_t i, const double center[3], double size)
{
    glint_solid *solid = &scene->solids[i];
    const double thin = one_in(3) ? power_of_ten(-2, 0) : 1;
    const bool round = one_in(2);
    double column[3][3], det = 0;
    solid->form = below(GLINT_FORM_TORUS + 1);
    solid->tube = one_in(4) ? power_of_ten(-6, -1) : one_in(4) ? 1 - power_of_ten(-6, -1) : between(0.05, 0.95);
    do {
        for (int k = 0; k < 3; k++) {
            const double length = size * power_of_ten(-1, 0) * (k < 2 ? thin : 1);
            random_unit(column[k]);
            for (int c = 0; c < 3; c++)
                column[k][c] *= length;
        }
        if (round) {
            const double wide = length3(column[0]), tall = length3(column[2]);
            for (int c = 0; c < 3; c++)
                column[2][c] /= tall;
            random_across(column[2], column[0]);
            for (int c = 0; c < 3; c++)
                column[1][c] = wide * (column[2][(c + 1) % 3] * column[0][(c + 2) % 3] -
                                       column[2][(c + 2) % 3] * column[0][(c + 1) % 3]);
            for (int c = 0; c < 3; c++) {
                column[0][c] *= wide;
                column[2][c] *= tall;
            }
        }
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++)
                solid->forward[c][k] = column[k][c];
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++) {
                const double *a = column[(k + 1) % 3], *b = column[(k + 2) % 3];
                solid->inverse[k][c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
            }
        det = 0;
        for (int c = 0; c < 3; c++)
            det += column[0][c] * solid->inverse[0][c];
    } while (!(fabs(det) > 1e-4 * thin * thin * size * size * size));
    for (int c = 0; c < 9; c++)
        solid->inverse[c / 3][c % 3] /= det;
    scene->prims[i] = (glint_prim) { .kind = GLINT_PRIM_SOLID };
    scene->prims[i].item = i;
    memcpy(scene->prims[i].center, center, sizeof scene->prims[i].center);
}

/// Chooses a random point on the unit torus.
static inline void place_on_torus(double tube, double k[3])
{
    const double around = between(-4, 4), across = one_in(4) ? 1.5707963267948966 : between(-4, 4);
    const double from_axis = 1 + tube * cos(across);
    k[0] = from_axis * cos(around);
    k[1] = from_axis * sin(around);
    k[2] = tube * sin(across);
}

/// Chooses a random point on a solid, in world space.
static inline void place_on_solid(const test_scene *scene, const glint_prim *prim, double point[3])
{
    const glint_solid *solid = &scene->solids[prim->item];
    double k[3];
    random_unit(k);
    const double round = sqrt(k[0] * k[0] + k[1] * k[1]), z = between(0, 1);
    const bool cone = solid->form == GLINT_FORM_CONE || solid->form == GLINT_FORM_FUNNEL;
    for (int c = 0; c < 3 && solid->form == GLINT_FORM_BOX; c++)
        k[c] = between(-1, 1);
    if (solid->form == GLINT_FORM_BOX)
        k[below(3)] = either_sign(1);
    else if (solid->form == GLINT_FORM_TORUS)
        place_on_torus(solid->tube, k);
    else if (solid->form == GLINT_FORM_DISK)
        k[2] = 0;
    else if (solid->form != GLINT_FORM_BALL)
        for (int c = 0; c < 3; c++)
            k[c] = c < 2 ? k[c] / round * (cone ? z : 1) : cone ? z : 2 * z - 1;
    for (int c = 0; c < 3; c++)
        point[c] =
            prim->center[c] + (solid->forward[c][0] * k[0] + solid->forward[c][1] * k[1] + solid->forward[c][2] * k[2]);
}

/// Moves a solid so that the line touches its silhouette,
/// or misses it by 1e-16 .. 1e-1 of its radius, if it is a cylinder.
static inline void graze_solid(const test_scene *scene, glint_prim *prim, const test_line *line)
{
    const glint_solid *solid = &scene->solids[prim->item];
    double d[3], place[3];
    for (int i = 0; i < 3; i++)
        d[i] = solid->inverse[i][0] * line->direction[0] + solid->inverse[i][1] * line->direction[1] +
               solid->inverse[i][2] * line->direction[2];
    const double across = hypot(d[0], d[1]), off = 1 + slight();
    if (!(across > 0))
        return;
    const double k[3] = { -d[1] / across * off, d[0] / across * off, between(0, 1) };
    along3(line->origin, line->length * between(-0.2, 1.3), line->direction, place);
    for (int c = 0; c < 3; c++)
        prim->center[c] = place[c] - (solid->forward[c][0] * k[0] + solid->forward[c][1] * k[1] + solid->forward[c][2] * k[2]);
}

static inline void random_prim(const scene_plan *plan, test_scene *scene, uint32_t i, uint32_t count)
{
    glint_prim *prim = &scene->prims[i];
    const test_line *line = &plan->lines[below(plan->line_count)];
    // with many primitives most are small; otherwise all rays would hit the nearest few
    double radius = plan->size * power_of_ten(-plan->spread, 0.2) / (one_in(50) ? 1 : cbrt(count));
    double center[3];
    for (int c = 0; c < 3; c++)
        center[c] = plan->middle[c] + plan->size * between(-1, 1);
    const uint32_t kind = below(20);
    const double largest = plan->size * 1e15; // keeps volumes within the range of double
    if (plan->triangles && one_in(2))
        set_random_triangle(prim, i ? prim - 1 : NULL, line, center, radius);
    else if (plan->solids && one_in(2) && largest < 1e60 && largest > 1e-30) {
        set_random_solid(scene, i, center, radius);
        if (one_in(2))
            graze_solid(scene, prim, line);
    } else if (kind < 6)
        set_grazing(prim, line, radius);
    else if (kind == 6)
        set_touching(prim, line, 0, radius);
    else if (kind == 7)
        set_touching(prim, line, line->length, radius);
    else if (kind == 8) // makes several hits at the same distance
        set_touching(prim, line, line->length - plan->size / 4, radius);
    else if (kind == 9 && i > 0 && scene->prims[i - 1].kind == GLINT_PRIM_SPHERE)
        *prim = scene->prims[i - 1];
    else if (kind == 9 && i > 0 && !plan->triangles && !plan->solids)
        *prim = scene->prims[below(i)];
    else if (kind == 10 && (count < 30 || one_in(count / 10)))
        set_random_plane(prim, plan, line);
    else
        set_sphere(prim, center, radius);
}

/// The ground that many scenes stand on: a sphere so large that it is almost a plane.
static inline void set_ground(const scene_plan *plan, glint_prim *prim)
{
    double center[3] = { plan->middle[0], plan->middle[1] - plan->size * (1 + 1e7), plan->middle[2] };
    set_sphere(prim, center, 1e7 * plan->size);
}

// ---- Tables ------------------------------------------------------------------------------------------------------

static inline float rounded_up(long double x)
{
    float rounded = (float)x;
    return (long double)rounded < x ? nextafterf(rounded, INFINITY) : rounded;
}

static inline float rounded_down(long double x) { return -rounded_up(-x); }

static inline bool is_torus(const test_scene *scene, const glint_prim *prim)
{
    return prim->kind == GLINT_PRIM_SOLID && scene->solids[prim->item].form == GLINT_FORM_TORUS;
}

/// Computes the bounds of a bounded primitive, in world space.
static inline void ends_of(const test_scene *scene, const glint_prim *prim, long double lower[3], long double upper[3])
{
    for (int c = 0; c < 3; c++) {
        const double *m = scene->solids[prim->kind == GLINT_PRIM_SOLID ? prim->item : 0].forward[c];
        const bool torus = is_torus(scene, prim); // the torus reaches 1 + tube, which is below 2
        const long double reach =
            prim->kind == GLINT_PRIM_SOLID ? (torus ? 2 : 1) * ((fabsl(m[0]) + fabsl(m[1])) + fabsl(m[2])) : prim->radius;
        lower[c] = (long double)prim->center[c] - reach;
        upper[c] = (long double)prim->center[c] + reach;
        if (prim->kind == GLINT_PRIM_TRIANGLE) {
            lower[c] = fmin(prim->corner[0][c], fmin(prim->corner[1][c], prim->corner[2][c]));
            upper[c] = fmax(prim->corner[0][c], fmax(prim->corner[1][c], prim->corner[2][c]));
        }
    }
}

/// Chooses the frame of reference. Any frame is valid; most frames are around the scene, in the scene's own units.
static inline void choose_frame(const scene_plan *plan, test_scene *scene)
{
    glint_geometry_table *table = &scene->table;
    const glint_prim *some = &scene->prims[below(table->prim_count)];
    const uint32_t kind = below(5);
    double largest = DBL_MIN;
    for (int c = 0; c < 3; c++)
        table->reference[c] = kind == 0                                        ? 0
                              : kind == 1 && some->kind == GLINT_PRIM_TRIANGLE ? some->corner[0][c]
                              : kind == 1                                      ? some->center[c]
                                                                               : plan->middle[c];
    table->extent = 0;
    for (uint32_t i = 0; i < table->prim_count; i++)
        for (int c = 0; c < 3; c++) {
            const glint_prim *prim = &scene->prims[i];
            long double lower[3], upper[3];
            ends_of(scene, prim, lower, upper);
            if (prim->kind == GLINT_PRIM_SPHERE)
                largest = fmax(largest, fabs(prim->center[c] - table->reference[c]) + prim->radius);
            else if (prim->kind != GLINT_PRIM_PLANE)
                largest = fmax(largest, (double)fmaxl(fabsl(lower[c] - table->reference[c]),
                                                      fabsl(upper[c] - table->reference[c])));
            if (prim->kind == GLINT_PRIM_TRIANGLE || prim->kind == GLINT_PRIM_SOLID)
                table->extent = fmax(table->extent, (double)fmaxl(fabsl(lower[c]), fabsl(upper[c])) * (1 + 1e-15));
            else
                table->extent = fmax(table->extent, fmax(fabs(prim->center[c]), prim->radius));
        }
    const int exponent = -ilogb(largest) + (one_in(3) ? (int)below(17) - 8 : 0);
    table->scale = ldexp(1, exponent > 1000 ? 1000 : exponent);
}

static inline glint_box place_sphere(const glint_geometry_table *table, glint_prim *prim)
{
    glint_box box = { .unused = 0 };
    const long double radius = (long double)prim->radius * table->scale;
    double away[3];
    for (int c = 0; c < 3; c++) {
        const long double center = ((long double)prim->center[c] - table->reference[c]) * table->scale;
        const long double slack = 0x1p-60L * (fabsl((long double)prim->center[c] * table->scale) + radius);
        away[c] = (double)center;
        prim->filter_center[c] = (float)center;
        box.lower[c] = rounded_down(center - radius - slack);
        box.upper[c] = rounded_up(center + radius + slack);
    }
    prim->filter_bound = rounded_up(radius * (1 + 2e-6L) + 16 * 0x1p-24L * length3(away) * (1 + 0x1p-40L));
    return box;
}

/// Like place_sphere, for primitives without a radius.
static inline glint_box place_corners_of(const test_scene *scene, glint_prim *prim)
{
    const glint_geometry_table *table = &scene->table;
    glint_box box = { .unused = 0 };
    long double lower[3], upper[3], radius2 = 0;
    double away[3];
    ends_of(scene, prim, lower, upper);
    for (int c = 0; c < 3; c++) {
        const long double low = (lower[c] - table->reference[c]) * table->scale,
                          high = (upper[c] - table->reference[c]) * table->scale;
        const long double off = prim->kind == GLINT_PRIM_TRIANGLE ? 13 * GLINT_POINT_SLACK_DOUBLE * table->extent * table->scale : 0;
        const long double slack = 0x1p-60L * (fabsl(lower[c]) + fabsl(upper[c])) * table->scale + off,
                          half = (high - low) / 2;
        away[c] = (double)((low + high) / 2);
        prim->filter_center[c] = (float)away[c];
        box.lower[c] = rounded_down(low - slack);
        box.upper[c] = rounded_up(high + slack);
        radius2 += (half + slack) * (half + slack);
    }
    prim->filter_bound = rounded_up(sqrtl(radius2) * (1 + 2e-6L) + 16 * 0x1p-24L * length3(away) * (1 + 0x1p-40L));
    return box;
}

/// Computes the axis of a solid, if it has one, and the largest distance of its surface from the axis: the
/// perpendicular parts of the other two columns.
static inline void place_axis(const glint_geometry_table *table, glint_solid *solid)
{
    const bool has_axis = solid->form == GLINT_FORM_CYLINDER || solid->form == GLINT_FORM_TUBE || solid->form == GLINT_FORM_CONE ||
                          solid->form == GLINT_FORM_FUNNEL;
    long double axis[3], across[2][3], gram[3] = { 0 }, length2 = 0;
    for (int c = 0; c < 3; c++)
        length2 += (long double)solid->forward[c][2] * solid->forward[c][2];
    for (int c = 0; c < 3; c++)
        axis[c] = solid->forward[c][2] / sqrtl(length2);
    for (int k = 0; k < 2; k++) {
        long double along = 0;
        for (int c = 0; c < 3; c++)
            along += axis[c] * solid->forward[c][k];
        for (int c = 0; c < 3; c++)
            across[k][c] = solid->forward[c][k] - along * axis[c];
    }
    for (int c = 0; c < 3; c++) {
        gram[0] += across[0][c] * across[0][c];
        gram[1] += across[1][c] * across[1][c];
        gram[2] += across[0][c] * across[1][c];
        solid->axis[c] = (float)axis[c];
    }
    const long double half = (gram[0] - gram[1]) / 2;
    const long double thick = sqrtl((gram[0] + gram[1]) / 2 + sqrtl(half * half + gram[2] * gram[2]));
    solid->thick = has_axis && !one_in(4) ? rounded_up(thick * (1 + 1e-15L) * table->scale) : INFINITY;
}

static inline void build_index(test_scene *scene)
{
    glint_geometry_table *table = &scene->table;
    uint32_t count = 0, next = 0;
    table->unbounded_count = 0;
    for (uint32_t i = 0; i < table->prim_count; i++)
        count += scene->prims[i].kind != GLINT_PRIM_PLANE;
    glint_box *boxes = glint_boxes_alloc(count);
    assert_non_null(boxes);
    for (uint32_t i = 0; i < table->prim_count; i++) {
        glint_prim *prim = &scene->prims[i];
        prim->filter_bound = INFINITY;
        if (prim->kind == GLINT_PRIM_PLANE) {
            scene->unbounded[table->unbounded_count++] = i;
            continue;
        }
        boxes[next] = prim->kind == GLINT_PRIM_SPHERE ? place_sphere(table, prim) : place_corners_of(scene, prim);
        for (int c = 0; c < 3 && prim->kind == GLINT_PRIM_SOLID; c++) {
            scene->solids[prim->item].lower[c] = boxes[next].lower[c];
            scene->solids[prim->item].upper[c] = boxes[next].upper[c];
        }
        if (prim->kind == GLINT_PRIM_SOLID)
            place_axis(table, &scene->solids[prim->item]);
        boxes[next++].item = i;
    }
    glint_error error;
    assert_int_equal(glint_bvh_build(boxes, count, NULL, &scene->bvh, &error), GLINT_OK);
    table->nodes = scene->bvh.nodes;
    table->unbounded = scene->unbounded;
    table->prims = scene->prims;
    table->solids = scene->solids;
}

/// Sets the plane of a flat primitive. `reach` is the distance up to which the primitive extends from `center`.
static inline void set_face(glint_face *face, const double normal[3], const double at[3], const double center[3],
                            double reach)
{
    const double length = length3(normal);
    face->magnitude = 0;
    for (int c = 0; c < 3; c++) {
        face->normal[c] = normal[c] / length;
        face->at[c] = at[c];
        face->magnitude += fabs(face->normal[c]) * ((fabs(center[c]) + reach) + fabs(at[c]));
    }
    face->axis = (uint32_t)glint_axis_along(face->normal);
}

static inline void set_solid_faces(test_scene *scene, const glint_prim *prim)
{
    glint_solid *solid = &scene->solids[prim->item];
    const bool cone = solid->form == GLINT_FORM_CONE || solid->form == GLINT_FORM_FUNNEL;
    const int slabs = glint_slab_count(solid->form);
    double reach = 0;
    solid->faces = scene->faces + scene->face_count;
    solid->magnitude = 1;
    for (int i = 0; i < 9; i++)
        reach += (solid->form == GLINT_FORM_TORUS ? 2 : 1) * fabs(solid->forward[i / 3][i % 3]);
    for (int i = 0; i < 9; i++)
        solid->magnitude += 2 * fabs(solid->inverse[i / 3][i % 3]) * (reach + 2 * fabs(prim->center[i % 3]));
    for (int i = 0; i < 2 * slabs; i++) {
        const int k = slabs == 1 ? 2 : i / 2;
        const double low = solid->form == GLINT_FORM_DISK || cone ? 0 : -1, high = solid->form == GLINT_FORM_DISK ? 0 : 1;
        double at[3];
        for (int c = 0; c < 3; c++)
            at[c] = prim->center[c] + (i % 2 ? high : low) * solid->forward[c][k];
        set_face(&scene->faces[scene->face_count++], solid->inverse[k], at, prim->center, reach);
    }
}

/// Gives some triangles a plane. Triangles perpendicular to an axis get an exact normal.
static inline void set_triangle_face(test_scene *scene, glint_prim *prim)
{
    double f[3], g[3], n[3];
    along3(prim->corner[1], -1, prim->corner[0], f);
    along3(prim->corner[2], -1, prim->corner[0], g);
    cross3(f, g, n);
    for (int c = 0; c < 3; c++)
        if (f[c] == 0 && g[c] == 0)
            for (int k = 0; k < 3; k++)
                n[k] = k == c ? n[k] : 0;
    if (!(length3(n) > 0) || !isfinite(length3(n)))
        return;
    set_face(&scene->faces[scene->face_count++], n, prim->corner[0], prim->corner[0], length3(f) + length3(g));
    prim->face = scene->face_count;
}

/// Computes the planes of flat primitives, once all have their positions.
static inline void set_faces(test_scene *scene)
{
    scene->face_count = 0;
    for (uint32_t i = 0; i < scene->table.prim_count; i++) {
        glint_prim *prim = &scene->prims[i];
        if (prim->kind == GLINT_PRIM_SOLID)
            set_solid_faces(scene, prim);
        if (prim->kind == GLINT_PRIM_TRIANGLE && one_in(3))
            set_triangle_face(scene, prim);
        for (int c = 0; c < 3 && prim->kind == GLINT_PRIM_PLANE && glint_axis_along(prim->normal) == 3; c++)
            prim->normal[3] += 2 * fabs(prim->normal[c] * prim->center[c]) + DBL_MIN;
    }
    scene->table.faces = scene->faces;
}

/// Puts triangles first, with their corners in consecutive memory.
static inline void order_prims(test_scene *scene)
{
    static glint_prim others[MOST_PRIMS];
    uint32_t other_count = 0, count = 0;
    for (uint32_t i = 0; i < scene->table.prim_count; i++) {
        glint_prim *prim = &scene->prims[i];
        if (prim->kind != GLINT_PRIM_TRIANGLE) {
            others[other_count++] = *prim;
            continue;
        }
        memcpy(scene->corners[count], prim->corner, sizeof scene->corners[count]);
        scene->prims[count] = *prim;
        scene->prims[count].corner = scene->corners[count];
        count++;
    }
    memcpy(scene->prims + count, others, other_count * sizeof *others);
    scene->table.triangles = count;
    scene->table.corners = (const double(*)[3][3])scene->corners;
}

/// Numbers the primitives in the array's order, or in any other order of definition.
static inline void number_prims(test_scene *scene)
{
    const bool shuffled = one_in(2);
    for (uint32_t i = 0; i < scene->table.prim_count; i++) {
        const uint32_t at = shuffled ? below(i + 1) : i;
        scene->prims[i].id = scene->prims[at].id;
        scene->prims[at].id = i;
    }
}

/// Derives the other fields from kind, centre, normal and radius of the primitives. prim_count is set.
static inline void finish_scene(const scene_plan *plan, test_scene *scene)
{
    order_prims(scene);
    number_prims(scene);
    set_faces(scene);
    scene->table.tori = false;
    for (uint32_t i = 0; i < scene->table.prim_count; i++)
        scene->table.tori = scene->table.tori || is_torus(scene, &scene->prims[i]);
    for (uint32_t i = 0; i < scene->table.prim_count; i++) {
        scene->prims[i].material = below(4);
        scene->prims[i].two_sided = one_in(2);
    }
    choose_frame(plan, scene);
    build_index(scene);
}

static inline uint32_t random_count(void)
{
    return 1 + below(one_in(8) ? MOST_PRIMS : one_in(3) ? 300 : one_in(2) ? 40 : 8);
}

/// Builds a scene around the lines of the plan. The caller frees it with free_scene.
static inline test_scene *random_scene(const scene_plan *plan)
{
    static test_scene scene;
    const uint32_t count = scene.table.prim_count = plan->count ? plan->count : random_count();
    for (uint32_t i = 0; i < count; i++)
        random_prim(plan, &scene, i, count);
    if (one_in(6))
        set_ground(plan, &scene.prims[below(count)]);
    finish_scene(plan, &scene);
    return &scene;
}

static inline void free_scene(test_scene *scene) { glint_bvh_free(&scene->bvh); }

// ---- Positions of scenes -----------------------------------------------------------------------------------------

/// Ordinary sizes, at the origin or up to 1e7 away. Some sizes have squares outside the range of float; with
/// `beyond`, some sizes are themselves outside that range.
static inline void random_place(scene_plan *plan, bool beyond)
{
    const bool extreme = one_in(6);
    const double offset = one_in(2) ? 0 : one_in(3) ? 1e7 : power_of_ten(-3, 6), exponent = beyond ? 60 : 25;
    plan->size = extreme ? power_of_ten(-exponent, exponent) : power_of_ten(-3, 5);
    plan->spread = one_in(4) ? 6 : one_in(2) ? 2 : 0.5;
    for (int c = 0; c < 3; c++)
        plan->middle[c] = (extreme ? plan->size : 1) * either_sign(offset) * between(0.5, 1);
    plan->triangles = plan->solids = false;
    plan->count = 0;
    plan->line_count = 0;
}

static inline void add_line(scene_plan *plan, const double origin[3], const double direction[3], double length)
{
    test_line *line = &plan->lines[plan->line_count++];
    const double size = length3(direction);
    *line = (test_line) { .length = length };
    for (int c = 0; c < 3; c++) {
        line->origin[c] = origin[c];
        line->direction[c] = direction[c] / size;
    }
}

#endif
