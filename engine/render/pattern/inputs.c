#include "engine/render/pattern/inputs.h"
#include "engine/base/vec.h"
#include "engine/render/pattern/uv.h"
#include "engine/render/paths/batch.h"

#include <math.h>

#define BITS(first, count) (((1u << (count)) - 1) << (first))
#define READS_P BITS(GLINT_INPUT_P_X, 3)
#define READS_WORLD BITS(GLINT_INPUT_WORLD_X, 3)
#define READS_N BITS(GLINT_INPUT_N_X, 3)
#define READS_V BITS(GLINT_INPUT_V_X, 3)
#define READS_UV_FOOTPRINT GLINT_READS_UV_FOOTPRINT
#define READS_UV GLINT_READS_UV
#define READS_FOOTPRINT (BITS(GLINT_INPUT_FOOTPRINT, 1) | READS_UV_FOOTPRINT)
#define READS_GATHERED (READS_P | READS_WORLD | READS_N | READS_V | READS_UV | READS_FOOTPRINT)

#define WIDE 0x1p16 // width of a pixel where u or v grows without bound, in their units

/// The group of an entry: its position in the tile and in the rows.
typedef struct gathering {
    glint_pattern_inputs *inputs;
    const glint_tile_frame *frame;
    const glint_pattern_points *points;
    size_t at, to;
} gathering;

static double *row(const gathering *g, int input) { return g->inputs->row[input] + g->to; }

/// Loads sixteen numbers from an array of real.
static void load_group(const gathering *g, const void *array, double out[GLINT_GROUP])
{
    glint_reals_of(array, g->frame->plan->desc.precision, (uint32_t)(g->at / GLINT_GROUP), out);
}

// ---- Normals ----

/// Computes the geometric normal of a smoothly shaded triangle, on the viewer's side.
static void face_normal(const glint_prim *prim, double scale, bool back, double out[3])
{
    double f[3], h[3], n[3];
    vec_sub(f, prim->corner[1], prim->corner[0]);
    vec_sub(h, prim->corner[2], prim->corner[0]);
    vec_scale(f, f, scale);
    vec_scale(h, h, scale);
    vec_cross(n, f, h);
    const double length = sqrt(vec_dot(n, n));
    for (int c = 0; c < 3; c++)
        out[c] = (back ? -n[c] : n[c]) / length;
}

static bool is_smooth(const glint_prim *prim) { return prim->kind == GLINT_PRIM_TRIANGLE && prim->item != GLINT_MISS; }

static void gather_normals(const gathering *g, unsigned lanes)
{
    const glint_pattern_points *points = g->points;
    for (int c = 0; c < 3; c++)
        load_group(g, points->normal[c], row(g, GLINT_INPUT_N_X + c));
    if (!g->frame->geometry.corner_normals || points->shading)
        return;
    for (; lanes; lanes &= lanes - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(lanes);
        const glint_prim *prim = &g->frame->geometry.prims[points->prim[g->at + lane]];
        double n[3];
        if (!is_smooth(prim))
            continue;
        face_normal(prim, g->frame->geometry.scale, glint_has_lane(points->back, (uint32_t)g->at + lane), n);
        for (int c = 0; c < 3; c++)
            row(g, GLINT_INPUT_N_X + c)[lane] = n[c];
    }
}

// ---- The point in the shape's own space ----

/// Finds the lanes whose primitives belong to the same part as the first lane's. Returns the part's space.
static const glint_pattern_space *next_space(const gathering *g, unsigned pending, unsigned *lanes)
{
    const glint_geometry *geometry = g->frame->plan->geometry;
    const glint_prim *prims = g->frame->geometry.prims;
    const uint32_t *prim = g->points->prim + g->at;
    const uint32_t first = prim[__builtin_ctz(pending)], part = geometry->prim_part[prims[first].id];
    const bool one = glint_all_are(prim, first); // the common case
    *lanes = one ? pending : 0;
    for (unsigned rest = one ? 0 : pending; rest; rest &= rest - 1) {
        const uint32_t id = prim[__builtin_ctz(rest)];
        if (id == first || geometry->prim_part[prims[id].id] == part)
            *lanes |= rest & -rest;
    }
    return &g->frame->plan->patterns->spaces[part];
}

/// Returns the axis of the box face that a lane is on, from the normal in the shape's own space. *upper: it is the
/// face at `max`.
static int face_of(const gathering *g, const glint_pattern_space *space, uint32_t lane, bool *upper)
{
    const size_t i = g->at + lane;
    double n[3], own[3];
    int axis = 0;
    for (int c = 0; c < 3; c++)
        n[c] = glint_real_at(g->points->normal[c], g->frame->plan->desc.precision, (uint32_t)i);
    for (int c = 0; c < 3; c++) {
        own[c] = space->mapped
                     ? (space->forward[0][c] * n[0] + space->forward[1][c] * n[1]) + space->forward[2][c] * n[2]
                     : n[c];
        axis = fabs(own[c]) > fabs(own[axis]) ? c : axis;
    }
    *upper = (own[axis] > 0) != glint_has_lane(g->points->back, (uint32_t)i);
    return axis;
}

/// Sets the coordinate of points on axis-aligned faces to the exact coordinate of the face. Otherwise rounding would
/// decide on which side of an integer a pattern sees the point.
static void put_exact(const gathering *g, const glint_pattern_space *space, unsigned lanes)
{
    if (space->kind == GLINT_SHAPE_BOX) {
        for (; lanes; lanes &= lanes - 1) {
            const uint32_t lane = (uint32_t)__builtin_ctz(lanes);
            bool upper;
            const int axis = face_of(g, space, lane, &upper);
            row(g, GLINT_INPUT_P_X + axis)[lane] = upper ? space->upper[axis] : space->lower[axis];
        }
        return;
    }
    for (int i = 0; lanes == 0xffff && space->axis >= 0 && i < GLINT_GROUP; i++)
        row(g, GLINT_INPUT_P_X + space->axis)[i] = space->face;
    for (; lanes != 0xffff && lanes && space->axis >= 0; lanes &= lanes - 1)
        row(g, GLINT_INPUT_P_X + space->axis)[__builtin_ctz(lanes)] = space->face;
}

/// Maps a group's points, which are in the rows, from world space to the shape's own space.
static void map_points(const gathering *g, const glint_pattern_space *space, unsigned lanes)
{
    double own[3][GLINT_GROUP];
    for (int c = 0; c < 3; c++) {
        const double *m = space->inverse[c], *x = row(g, GLINT_INPUT_P_X), *y = row(g, GLINT_INPUT_P_Y),
                     *z = row(g, GLINT_INPUT_P_Z);
        for (int i = 0; i < GLINT_GROUP; i++)
            own[c][i] = ((m[0] * x[i] + m[1] * y[i]) + m[2] * z[i]) + m[3];
    }
    for (int c = 0; c < 3; c++) {
        double *to = row(g, GLINT_INPUT_P_X + c);
        for (int i = 0; i < GLINT_GROUP; i++)
            to[i] = lanes >> i & 1 ? own[c][i] : to[i];
    }
}

static void gather_points(const gathering *g, unsigned lanes)
{
    for (int c = 0; c < 3; c++)
        load_group(g, g->points->point[c], row(g, GLINT_INPUT_P_X + c));
    for (unsigned rest = lanes, here; rest; rest &= ~here) {
        const glint_pattern_space *space = next_space(g, rest, &here);
        if (space->mapped)
            map_points(g, space, here);
        put_exact(g, space, here);
    }
}

// ---- The viewer ----

/// Returns the camera of the rays if the stage `unit` can compute the directions; NULL: load_directions_to_eye computes
/// them.
static const glint_camera_args *camera_of(const glint_tile_frame *frame, const glint_pattern_points *points)
{
    return points->direction[0] || frame->plan->desc.precision != GLINT_PRECISION_DOUBLE ? NULL : glint_tile_rays_of(points->tile);
}

/// Loads a component of the directions back along the group's rays, not normalised: see glint_tile_direction.
static void load_directions_to_eye(const gathering *g, int c, double *restrict out)
{
    const glint_tile *tile = g->points->tile;
    if (g->points->direction[c] || glint_tile_has_arrays(tile)) {
        load_group(g, g->points->direction[c] ? g->points->direction[c] : tile->rays.direction[c], out);
        for (int i = 0; i < GLINT_GROUP; i++)
            out[i] = -out[i];
        return;
    }
    const uint32_t group = (uint32_t)(g->at / GLINT_GROUP), columns = tile->groups_across;
    const float *across = (const float *)tile->camera.across + (3 * (group % columns) + (uint32_t)c) * GLINT_GROUP;
    const float *down = (const float *)tile->camera.down + (3 * (group / columns) + (uint32_t)c) * GLINT_GROUP;
    for (int i = 0; i < GLINT_GROUP; i++)
        out[i] = -(double)(across[i] + down[i]);
}

static void make_views(glint_pattern_inputs *inputs, const glint_tile_frame *frame, const glint_pattern_points *points,
                       const glint_pattern_lanes *entries, uint32_t count)
{
    uint32_t groups[GLINT_PROGRAM_GROUPS];
    glint_unit_args args = { .group_count = count, .camera = camera_of(frame, points), .groups = groups };
    for (uint32_t k = 0; k < count; k++)
        groups[k] = entries[k].group;
    for (int c = 0; c < 3; c++) {
        args.to[c] = inputs->row[GLINT_INPUT_V_X + c];
        args.unit[c] = inputs->row[GLINT_INPUT_V_X + c];
    }
    frame->stages->unit(&args);
}

/// Computes the width of a pixel at each point, also after mirrors: the width that the pixel's ray has there.
static void gather_footprints(const gathering *g, unsigned lanes)
{
    const glint_plan_patterns *patterns = g->frame->plan->patterns;
    const glint_tile *tile = g->points->tile;
    for (; lanes; lanes &= lanes - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(lanes), i = (uint32_t)g->at + lane;
        const double t = g->points->t ? glint_real_at(g->points->t, g->frame->plan->desc.precision, i) : 0;
        const double far =
            t + (g->points->t && tile->batch ? tile->batch->rays->path_length[tile->batch->ray_of[i]] : 0);
        row(g, GLINT_INPUT_FOOTPRINT)[lane] = !g->points->t ? 0 : patterns->pixel * (patterns->parallel ? 1 : far);
    }
}

// ---- Coordinates on the surface ----

/// Returns the input of the surface coordinates for one lane. The point in the shape's own space must be known.
static glint_uv_point uv_point_of(const gathering *g, const glint_pattern_space *space, uint32_t lane)
{
    const glint_prim *prim = &g->frame->geometry.prims[g->points->prim[g->at + lane]];
    glint_uv_point point = { .triangle = prim->id - space->first_prim };
    double d[3];
    for (int c = 0; c < 3; c++)
        point.p[c] = row(g, GLINT_INPUT_P_X + c)[lane];
    if (space->kind == GLINT_SHAPE_BOX)
        point.axis = face_of(g, space, lane, &point.upper);
    if (space->kind != GLINT_SHAPE_SPHERE && space->kind != GLINT_SHAPE_SPHERES)
        return point;
    for (int c = 0; c < 3; c++)
        d[c] = glint_real_at(g->points->point[c], g->frame->plan->desc.precision, (uint32_t)g->at + lane) -
               prim->center[c];
    for (int c = 0; c < 3; c++)
        point.from_center[c] = space->mapped ? vec_dot(space->inverse[c], d) : d[c];
    return point;
}

static void gather_uv(const gathering *g, uint32_t reads, unsigned lanes)
{
    for (; lanes; lanes &= lanes - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(lanes);
        unsigned one;
        const glint_pattern_space *space = next_space(g, lanes & -lanes, &one);
        const glint_uv_point point = uv_point_of(g, space, lane);
        glint_surface_uv uv;
        glint_surface_uv_at(space, &point, &uv);
        row(g, GLINT_INPUT_UV_U)[lane] = uv.at[0];
        row(g, GLINT_INPUT_UV_V)[lane] = uv.at[1];
        for (int k = 0; k < 6; k++)
            g->inputs->uv_slope[k / 3][k % 3][g->to + lane] = uv.slope[k / 3][k % 3];
        const double width = reads & READS_UV_FOOTPRINT ? row(g, GLINT_INPUT_FOOTPRINT)[lane] * space->shrink : 0;
        if (reads & BITS(GLINT_INPUT_UV_FOOTPRINT, 1))
            row(g, GLINT_INPUT_UV_FOOTPRINT)[lane] = width / uv.unit;
        for (int k = 0; k < 2; k++)
            if (reads & BITS(GLINT_INPUT_UV_FOOTPRINT_U + k, 1))
                row(g, GLINT_INPUT_UV_FOOTPRINT_U + k)[lane] = fmin(width * sqrt(vec_dot(uv.slope[k], uv.slope[k])), WIDE);
    }
}

// ---- All of a call ----

double *glint_pattern_row(glint_pattern_inputs *inputs, glint_input input)
{
    inputs->from[input] = inputs->row[input];
    inputs->used |= 1u << input;
    inputs->same &= ~(1u << input);
    return inputs->row[input];
}

void glint_pattern_put_number(glint_pattern_inputs *inputs, glint_input input, double number)
{
    double *to = inputs->row[input];
    const uint32_t bit = 1u << input;
    if (inputs->used & inputs->same & bit && inputs->from[input] == to && memcmp(to, &number, sizeof number) == 0)
        return;
    glint_pattern_row(inputs, input);
    for (int i = 0; i < GLINT_GROUP; i++)
        to[i] = number;
    inputs->same |= bit;
}

/// Returns whether the entries' groups are consecutive in arrays of doubles, so that the arrays can be read directly.
static bool are_in_order(const glint_tile_frame *frame, const glint_pattern_lanes *entries, uint32_t count)
{
    if (frame->plan->desc.precision != GLINT_PRECISION_DOUBLE)
        return false;
    for (uint32_t k = 1; k < count; k++)
        if (entries[k].group != entries[0].group + k)
            return false;
    return true;
}

static void read_array(glint_pattern_inputs *inputs, int input, const void *array, uint32_t group)
{
    inputs->from[input] = (const double *)array + (size_t)group * GLINT_GROUP;
}

/// Returns the space of the entry's shape if its own space is world space, except for a coordinate that all its points
/// share. NULL: there is none, or there are several.
static const glint_pattern_space *plain_space(const glint_tile_frame *frame, const glint_pattern_points *points,
                                              const glint_pattern_lanes *entry)
{
    const gathering g = { NULL, frame, points, (size_t)entry->group * GLINT_GROUP, 0 };
    unsigned here;
    const glint_pattern_space *space = next_space(&g, entry->lanes, &here);
    return space->mapped || space->kind == GLINT_SHAPE_BOX || here != entry->lanes ? NULL : space;
}

/// Reads the points directly from the tile if all entries show one such shape.
static bool read_points(glint_pattern_inputs *inputs, const glint_tile_frame *frame, const glint_pattern_points *points,
                        const glint_pattern_lanes *entries, uint32_t count)
{
    const glint_pattern_space *space = plain_space(frame, points, &entries[0]);
    if (!space)
        return false;
    const uint32_t prim = points->prim[entries[0].group * GLINT_GROUP + (uint32_t)__builtin_ctz(entries[0].lanes)];
    for (uint32_t k = 1; k < count && !points->only; k++)
        if (!glint_all_are(points->prim + (size_t)entries[k].group * GLINT_GROUP, prim) &&
            plain_space(frame, points, &entries[k]) != space)
            return false;
    for (int c = 0; c < 3; c++)
        read_array(inputs, GLINT_INPUT_P_X + c, points->point[c], entries[0].group);
    if (space->axis >= 0)
        glint_pattern_put_number(inputs, (glint_input)(GLINT_INPUT_P_X + space->axis), space->face);
    return true;
}

/// Sets the inputs that can be read directly from the tile. Returns the remaining ones.
static uint32_t read_in_place(glint_pattern_inputs *inputs, const glint_tile_frame *frame,
                              const glint_pattern_points *points, uint32_t reads, const glint_pattern_lanes *entries,
                              uint32_t count)
{
    if (!are_in_order(frame, entries, count))
        return reads;
    for (int c = 0; c < 3 && reads & READS_WORLD; c++)
        read_array(inputs, GLINT_INPUT_WORLD_X + c, points->point[c], entries[0].group);
    const bool normals = reads & READS_N && (points->shading || !frame->geometry.corner_normals);
    for (int c = 0; c < 3 && normals; c++)
        read_array(inputs, GLINT_INPUT_N_X + c, points->normal[c], entries[0].group);
    const bool own = reads & READS_P && !(reads & READS_UV) && read_points(inputs, frame, points, entries, count);
    return reads & ~(READS_WORLD | (normals ? READS_N : 0) | (own ? READS_P : 0));
}

/// Gathers the rows of one entry.
static void gather_group(const gathering *g, uint32_t reads, unsigned lanes)
{
    if (reads & (READS_P | READS_UV))
        gather_points(g, lanes);
    for (int c = 0; c < 3 && reads & READS_WORLD; c++)
        load_group(g, g->points->point[c], row(g, GLINT_INPUT_WORLD_X + c));
    if (reads & READS_N)
        gather_normals(g, lanes);
    for (int c = 0; c < 3 && reads & READS_V; c++)
        load_directions_to_eye(g, c, row(g, GLINT_INPUT_V_X + c));
    if (reads & READS_FOOTPRINT)
        gather_footprints(g, lanes);
    if (reads & READS_UV)
        gather_uv(g, reads, lanes);
}

void glint_pattern_gather(glint_pattern_inputs *inputs, const glint_tile_frame *frame,
                          const glint_pattern_points *points, uint32_t reads, const glint_pattern_lanes *entries,
                          uint32_t count)
{
    inputs->used &= inputs->same; // constant inputs stay
    for (uint32_t rest = reads; rest; rest &= rest - 1)
        glint_pattern_row(inputs, (glint_input)__builtin_ctz(rest));
    uint32_t unread = read_in_place(inputs, frame, points, reads, entries, count);
    unread &= camera_of(frame, points) ? READS_GATHERED & ~READS_V : READS_GATHERED;
    for (uint32_t k = 0; unread && k < count; k++) {
        const gathering g = { inputs, frame, points, (size_t)entries[k].group * GLINT_GROUP, (size_t)k * GLINT_GROUP };
        gather_group(&g, unread, entries[k].lanes);
    }
    if (reads & READS_V)
        make_views(inputs, frame, points, entries, count);
}
