// candidate: a surface that some rays of a tile may hit, with constants that are the same for all these rays. The
// rays start at one eye, so that filters are linear over the picture. Contract: stages.h, cast.
#ifndef GLINT_INDEX_CANDIDATE_H
#define GLINT_INDEX_CANDIDATE_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/combined.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/shared_edge.h"
#include "engine/render/stages/cast/solid.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

#define GLINT_FIRST_CANDIDATES 24 ///< maximum number of first candidates: the primitives of one node, and some planes
#define GLINT_PIXEL_CELL 2 ///< side of a cell in pixels, for gathered pixels

/// The lens that a tile's rays start on.
typedef struct R(tile_lens) {
    lens_on_screen seen;
    _Alignas(64) float across[2][GLINT_GROUP]; ///< the point on the lens where each lane's ray starts, in screen
        ///< units at k = 1
} R(tile_lens);

#define PIXEL_ROWS (GLINT_TILE_HEIGHT / GLINT_PIXEL_CELL)

/// Groups whose pixels can lie anywhere in a tile.
typedef struct R(pixel_groups) {
    _Alignas(64) float s[GLINT_TILE_GROUPS][GLINT_GROUP], t[GLINT_TILE_GROUPS][GLINT_GROUP]; ///< screen positions of
        ///< the rays
    uint64_t in_cell[PIXEL_ROWS][SCREEN_ACROSS]; ///< groups with a ray in the cell, one bit each
    _Alignas(64) uint32_t cell[GLINT_TILE_GROUPS][GLINT_GROUP]; ///< the cell of each ray: SCREEN_ACROSS times the row
        ///< of the cell, plus its column
    uint16_t starts[GLINT_TILE_GROUPS]; ///< bit mask of the lanes whose cell differs from the previous lane's cell,
        ///< including the first lane
    float far[GLINT_TILE_GROUPS]; ///< as for the groups of a tile
} R(pixel_groups);

/// The tile's pixels as the filter needs them, and the hits so far.
typedef struct R(tile_cast) {
    const glint_cast_args *args;
    screen_view view; ///< the screen; its cells are the groups
    int across, down;
    bool scaled; ///< true: the arrays below are filled
    bool parallel; ///< true: the rays do not start at one eye: they are parallel or start on a lens, and are read
        ///< from arrays
    const R(tile_lens) * lens; ///< NULL: no lens
    bool deep; ///< true: there are candidates in sight beyond the first ones, so that it pays to test which
        ///< candidates hide others
    R(pixel_groups) * pixels; ///< NULL: each group is a block of 4 x 4 pixels, and the cells are the groups
    float rr, uu; ///< squares of the lengths of right and up
    float longest; ///< maximum length of a direction
    float spread; ///< maximum difference between the length of a direction within a group and the length of the
        ///< direction in the middle of the group
    _Alignas(64) float s[GLINT_TILE_WIDTH / 4][GLINT_GROUP], t[GLINT_TILE_HEIGHT / 4][GLINT_GROUP];
    _Alignas(64) float ss[GLINT_TILE_WIDTH / 4][GLINT_GROUP], tt[GLINT_TILE_HEIGHT / 4][GLINT_GROUP];
    ///< |direction|^2 = ss + tt
    // only if `deep`: depth of each hit, in the index's units and rounded up; infinite without a hit
    _Alignas(64) float depth[GLINT_TILE_GROUPS][GLINT_GROUP];
    _Alignas(64) float far[GLINT_TILE_HEIGHT / GLINT_PIXEL_CELL][SCREEN_ACROSS]; ///< maximum depth of the hits in
        ///< each group, or in each cell
} R(tile_cast);

/// A primitive that some of the tile's rays may hit, with constants that are the same for all of the rays.
typedef struct R(candidate) {
    const glint_prim *prim;
    uint32_t id;
    real f[3], c; ///< computed by R(offset) and R(offset_constant)
    real scale, r2; ///< scale and squared radius of a sphere, see glint_sphere_scale
    float base[3], along_s[3],
        along_t[3]; ///< coefficients of the filter's function, which is linear in s and t: f x d for a sphere, e for
    ///< a triangle, the rate at which a ray approaches for a plane
    float limit; ///< sphere: square of the maximum length of f x d; triangle: error bound of e: a hit may have e down
        ///< to -limit
    union {
        real corner[3][3]; ///< the corners of a triangle, relative to the eye
        real height[6]; ///< for a solid: heights of the eye, see R(solid_start)
    };
    // data for cover.h
    float outer, inner; ///< round candidates: outer: maximum length of f x d for a hit; inner: length up to which
        ///< rays certainly hit; < 0: no hit is certain
    float axis_length[2]; ///< round candidates: lengths of along_s and along_t
    float around; ///< round candidates: maximum length of the change of f x d from a group's middle to its corner
    float ahead[3], sway; ///< sphere: ahead: coefficients of b as a linear function of s and t; sway: maximum change
        ///< of b within a group
    float power; ///< t of a hit is this number divided by a positive number that bounds_of_t computes; 0: unknown
    bool distant; ///< sphere: true: all hits use the discriminant for distant spheres
} R(candidate);

/// Aims the screen along the tile's rays.
static void R(aim_screen)(const glint_camera_args *camera, const glint_geometry_table *geometry, screen_view *view)
{
    const uint32_t rows = (camera->group_count + camera->groups_across - 1) / camera->groups_across;
    const double rr = DOT(camera->right, camera->right), uu = DOT(camera->up, camera->up);
    for (int k = 0; k < 3; k++) {
        view->exact[k] = (camera->eye[k] - geometry->reference[k]) * geometry->scale;
        view->origin[k] = (float)view->exact[k];
        view->axis[0][k] = (float)(camera->right[k] / rr);
        view->axis[1][k] = (float)(-camera->up[k] / uu);
        view->axis[2][k] = (float)camera->forward[k];
    }
    const double first[2] = { 2 * camera->x0 - camera->width, 2 * camera->y0 - camera->height };
    const double last[2] = { first[0] + 8 * camera->groups_across, first[1] + 8 * rows };
    double wide[2];
    for (int j = 0; j < 2; j++) {
        view->first[j] = (float)first[j];
        view->last[j] = (float)last[j];
        view->cells[j] = 0.125f;
        wide[j] = fmax(fabs(first[j]), fabs(last[j]));
    }
    view->count[0] = (int)camera->groups_across;
    view->count[1] = (int)rows;
    view->unit[0] = (float)sqrt(rr);
    view->unit[1] = (float)sqrt(uu);
    view->base = 0;
    view->inverse = 1;
    view->slack = view->corner_slack = R(walk_slack)(geometry);
    view->drift = 0;
    view->margin = (float)(0.01 + 1e-5 * (wide[0] + wide[1])); // in half pixels; this is far above the rounding error
    view->far = HUGE_VALF;
    view->stretch = (float)(1.00001 * (1 + rr * wide[0] * wide[0] + uu * wide[1] * wide[1]));
    finish_screen(view);
}

/// Returns whether a ray from the eye, or from the lens around it, can hit a plane, by the directions of the corner
/// rays. Always true for other unbounded primitives.
static inline bool R(plane_ahead)(const glint_camera_args *camera, const screen_view *view, const glint_prim *prim)
{
    const double aside = camera->lens ? camera->lens->radius : 0, bend = aside > 0 ? aside * camera->lens->per_focus : 0;
    double e[3], away = aside;
    if (prim->kind != GLINT_PRIM_PLANE)
        return true;
    for (int k = 0; k < 3; k++) {
        e[k] = camera->eye[k] - prim->center[k];
        away = fmax(away, fabs(e[k]));
    }
    const double height = DOT(prim->normal, e);
    if (!(fabs(height) > 1.000001 * aside + (GLINT_REAL == 64 ? 1e-12 : 1e-5) * away))
        return true;
    for (int corner = 0; corner < 4; corner++) {
        const double s = corner & 1 ? view->last[0] : view->first[0];
        const double t = -(corner & 2 ? view->last[1] : view->first[1]);
        double d[3], size = bend;
        for (int k = 0; k < 3; k++) {
            d[k] = (camera->forward[k] + s * camera->right[k]) + t * camera->up[k];
            size += fabs(d[k]);
        }
        if (!(DOT(prim->normal, d) * (height > 0 ? 1 : -1) > 1.000001 * bend + 1e-5 * size))
            return true;
    }
    return false;
}

static void R(scale_tile)(R(tile_cast) * tile)
{
    static const _Alignas(64) float column[GLINT_GROUP] = { 0, 2, 4, 6, 0, 2, 4, 6, 0, 2, 4, 6, 0, 2, 4, 6 };
    static const _Alignas(64) float row[GLINT_GROUP] = { 0, 0, 0, 0, 2, 2, 2, 2, 4, 4, 4, 4, 6, 6, 6, 6 };
    const glint_camera_args *camera = tile->args->camera;
    const float left = (float)(2 * (camera->x0 + camera->offset[0]) - camera->width);
    const float top = (float)(camera->height - 2 * (camera->y0 + camera->offset[1]));
    const vf rr = f_set(tile->rr), uu = f_set(tile->uu);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        for (int x = 0; x < tile->across; x++) {
            const vf s = f_set(left + (float)(8 * x)) + f_load(column + i);
            f_store(tile->s[x] + i, s);
            f_store(tile->ss[x] + i, s * s * rr);
        }
        for (int y = 0; y < tile->down; y++) {
            const vf t = f_set(top - (float)(8 * y)) - f_load(row + i);
            f_store(tile->t[y] + i, t);
            f_store(tile->tt[y] + i, f_set(1) + t * t * uu);
        }
    }
    tile->scaled = true;
}

/// Makes the filter of a sphere. f, radius: vector from the centre to the eye, and radius, of the sphere or of a
/// solid's bounding sphere, in any unit.
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

/// Makes the filter of a triangle. A ray hits it if it passes all edges on the side of `volume`, with the corners
/// relative to the eye. The edge functions are linear in s and t.
static void R(make_triangle_filter)(const R(tile_cast) * tile, R(candidate) * candidate)
{
    const glint_camera_args *camera = tile->args->camera;
    const double *axis[3] = { camera->forward, camera->right, camera->up };
    const double s = fmax(fabs(tile->view.first[0]), fabs(tile->view.last[0])) + 2;
    const double t = fmax(fabs(tile->view.first[1]), fabs(tile->view.last[1])) + 2;
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

/// Makes the filter of a solid's bounding sphere. If float decides, nothing is rejected.
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

/// Makes the filter of a plane: a ray hits the plane if it approaches the plane.
static inline void R(make_plane_filter)(const R(tile_cast) * tile, R(candidate) * candidate)
{
    const glint_camera_args *camera = tile->args->camera;
    const double *normal = candidate->prim->normal, side = candidate->c < 0 ? 1 : -1;
    for (int j = 0; j < 3; j++) {
        candidate->base[j] = (float)(side * DOT(normal, camera->forward));
        candidate->along_s[j] = (float)(side * DOT(normal, camera->right));
        candidate->along_t[j] = (float)(side * DOT(normal, camera->up));
    }
    candidate->limit = 1e-5f * tile->longest;
}

/// Computes the constants that the decision needs.
static void R(place_candidate)(const glint_cast_args *args, uint32_t id, R(candidate) * candidate)
{
    const glint_prim *prim = candidate->prim = &args->geometry->prims[id];
    const double *eye = args->camera->eye;
    const vr origin[3] = { r_set(eye[0]), r_set(eye[1]), r_set(eye[2]) };
    vr f[3];
    candidate->id = id;
    if (prim->kind == GLINT_PRIM_TRIANGLE) {
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                candidate->corner[j][k] = ((real)prim->corner[j][k] - (real)eye[k]) * (real)args->geometry->scale;
        return;
    }
    if (prim->kind == GLINT_PRIM_SOLID) {
        R(start_at_eye)(&args->geometry->solids[prim->item], prim, eye, candidate->f, candidate->height);
        return;
    }
    if (prim->kind == GLINT_PRIM_COMBINED) {
        candidate->f[0] = candidate->f[1] = candidate->f[2] = candidate->c = 0; // a combined solid has no such
            // constants, but its parts do
        return;
    }
    candidate->scale = (real)(prim->kind == GLINT_PRIM_SPHERE ? glint_sphere_scale(prim) : 1);
    candidate->r2 = (real)(prim->kind == GLINT_PRIM_SPHERE ? glint_sphere_r2(prim) : 0);
    R(offset)(origin, prim, f);
    for (int k = 0; k < 3; k++)
        candidate->f[k] = R(first_lane)(f[k]);
    candidate->c = R(first_lane)(R(offset_constant)(f, prim));
}

/// Computes the constants that the decision and the filter need.
static void R(make_candidate)(const R(tile_cast) * tile, uint32_t id, R(candidate) * candidate)
{
    const glint_cast_args *args = tile->args;
    R(place_candidate)(args, id, candidate);
    const glint_prim *prim = candidate->prim;
    if (prim->kind == GLINT_PRIM_PLANE) {
        R(make_plane_filter)(tile, candidate);
    } else if (prim->kind == GLINT_PRIM_TRIANGLE) {
        R(make_triangle_filter)(tile, candidate);
    } else if (prim->kind == GLINT_PRIM_SOLID || prim->kind == GLINT_PRIM_COMBINED) {
        R(make_solid_filter)(args, candidate);
    } else {
        const double from[3] = { candidate->f[0], candidate->f[1], candidate->f[2] };
        R(make_filter)(args->camera, from, prim->radius * glint_sphere_scale(prim), candidate);
    }
}

/// Returns the lanes whose rays, at screen positions s and t, pass near the candidate; length2: |direction|^2.
INNER unsigned R(near_positions)(const R(candidate) * candidate, vf s, vf t, vf length2)
{
    vf v[3];
    for (int k = 0; k < 3; k++)
        v[k] = (f_set(candidate->base[k]) + t * f_set(candidate->along_t[k])) + s * f_set(candidate->along_s[k]);
    if (candidate->prim->kind == GLINT_PRIM_TRIANGLE || candidate->prim->kind == GLINT_PRIM_PLANE)
        return ~fm_bits(f_lt(f_min(f_min(v[0], v[1]), v[2]), f_set(-candidate->limit))) & ((1u << VF) - 1);
    return ~fm_bits(f_lt(f_set(candidate->limit) * length2, DOT(v, v))) & ((1u << VF) - 1);
}

/// Returns the lanes of group (x, y) whose rays pass near the candidate.
INNER unsigned R(near_pixels)(const R(tile_cast) * tile, const R(candidate) * candidate, int x, int y)
{
    unsigned near = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF)
        near |= R(near_positions)(candidate, f_load(tile->s[x] + i), f_load(tile->t[y] + i),
                                  f_load(tile->ss[x] + i) + f_load(tile->tt[y] + i))
                << i;
    return near;
}

/// Returns the lanes whose rays hit the candidate. f: the field of the candidate, copied into every lane.
INNER rm R(intersect_candidate)(const glint_cast_args *args, const R(candidate) * candidate, const vr f[3],
                                const vr d[3], vr *t)
{
    const glint_geometry_table *table = args->geometry;
    const double *eye = args->camera->eye;
    vr corner[3][3];
    if (candidate->prim->kind == GLINT_PRIM_SOLID) {
        const glint_solid *solid = &table->solids[candidate->prim->item];
        const R(solid_start) start = { .f = { f[0], f[1], f[2] }, .height = candidate->height };
        return R(intersect_solid)(solid, &start, d, t);
    }
    if (candidate->prim->kind == GLINT_PRIM_SPHERE)
        return R(intersect_ball)(f, d, DOT(d, d), r_set(candidate->c), r_set(candidate->r2), r_set(candidate->scale),
                                 t);
    if (candidate->prim->kind != GLINT_PRIM_TRIANGLE)
        return R(intersect)(f, r_set(candidate->c), d, candidate->prim, t);
    for (int j = 0; j < 9; j++)
        corner[j / 3][j % 3] = r_set(candidate->corner[j / 3][j % 3]);
    const vr o[3] = { r_set(eye[0]), r_set(eye[1]), r_set(eye[2]) };
    const rm hit = R(intersect_triangle)(corner, o, d, r_set(table->scale), R(face_of)(table, candidate->prim), t);
    return R(unless_begun_on)(table, candidate->prim, NULL, o, hit, *t);
}

/// Decides one candidate for the lanes `near` of group (x, y). Returns whether any hit was stored.
INNER bool R(decide_pixels)(const R(tile_cast) * tile, const R(candidate) * candidate, int x, int y, unsigned near)
{
    const glint_cast_args *args = tile->args;
    const size_t at = (size_t)(y * tile->across + x) * GLINT_GROUP;
    const vr f[3] = { r_set(candidate->f[0]), r_set(candidate->f[1]), r_set(candidate->f[2]) };
    const R(group_directions) directions = R(directions_of)(args->camera, (uint32_t)x, (uint32_t)y);
    bool any = false;
    if (candidate->prim->kind == GLINT_PRIM_COMBINED)
        return R(cast_combined_pixels)(args, candidate->prim, x, y, at, near);
    count_tests(args->tests, near);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = near >> i & ((1u << VR) - 1);
        if (!lanes)
            continue;
        vr d[3], t;
        R(load_direction)(directions, args->direction, 0, i, d);
        const rm hit = R(intersect_candidate)(args, candidate, f, d, &t);
        if (!rm_bits(hit))
            continue;
        R(update_nearest)(args, at + i, candidate->id, hit, t);
        any = true;
    }
    return any;
}

/// Updates the maximum depth of a group's hits, and returns it.
static inline float R(depth_of_group)(R(tile_cast) * tile, int g)
{
    const real scale = (real)tile->args->geometry->scale;
    _Alignas(64) real t[GLINT_GROUP];
    for (int i = 0; i < GLINT_GROUP; i += VR)
        r_store(t + i, r_load((const real *)tile->args->t + (size_t)g * GLINT_GROUP + i) * r_set(scale));
    R(narrow)(t, tile->depth[g]);
    for (int i = 0; i < GLINT_GROUP; i += VF)
        f_store(tile->depth[g] + i, f_load(tile->depth[g] + i) * f_set(1 + 0x1p-22f));
    return group_highest(tile->depth[g]);
}

/// Does the same for group (x, y).
static inline void R(note_depth)(R(tile_cast) * tile, int x, int y)
{
    tile->far[y][x] = R(depth_of_group)(tile, y * tile->across + x);
}

/// Does the same for the cells of a group with pixels at any position; far: the group's maximum depth.
static void R(note_cells)(R(tile_cast) * tile, int g, float far)
{
    R(pixel_groups) *pixels = tile->pixels;
    pixels->far[g] = far;
    for (unsigned starts = pixels->starts[g]; starts; starts &= starts - 1) {
        const uint32_t cell = pixels->cell[g][__builtin_ctz(starts)];
        float most = -HUGE_VALF;
        for (uint64_t bits = (&pixels->in_cell[0][0])[cell]; bits; bits &= bits - 1)
            most = larger(most, pixels->far[__builtin_ctzll(bits)]);
        tile->far[cell / SCREEN_ACROSS][cell % SCREEN_ACROSS] = most;
    }
}

/// Tests candidates, group by group.
static void R(cast_candidates)(R(tile_cast) * tile, const R(candidate) * candidates, int count)
{
    if (!tile->scaled)
        R(scale_tile)(tile);
    for (int y = 0; y < tile->down; y++)
        for (int x = 0; x < tile->across; x++)
            for (int k = 0; k < count; k++) {
                const unsigned near = R(near_pixels)(tile, &candidates[k], x, y);
                if (near && R(decide_pixels)(tile, &candidates[k], x, y, near))
                    R(note_depth)(tile, x, y);
            }
}

/// Prepares the tile's rays for make_candidate and make_cover.
static void R(aim_tile)(const glint_cast_args *args, R(tile_cast) * tile)
{
    tile->args = args;
    tile->scaled = tile->deep = tile->parallel = false;
    tile->lens = NULL;
    tile->pixels = NULL;
    R(aim_screen)(args->camera, args->geometry, &tile->view);
    tile->rr = (float)DOT(args->camera->right, args->camera->right);
    tile->uu = (float)DOT(args->camera->up, args->camera->up);
    tile->longest = sqrtf(tile->view.stretch);
    tile->spread = 4.00001f * sqrtf(tile->rr + tile->uu);
    tile->across = tile->view.count[0];
    tile->down = tile->view.count[1];
}

static void R(begin_tile)(const glint_cast_args *args, R(tile_cast) * tile)
{
    R(aim_tile)(args, tile);
    for (int y = 0; y < tile->down; y++)
        for (int x = 0; x < SCREEN_ACROSS; x++)
            tile->far[y][x] = x < tile->across ? HUGE_VALF : -HUGE_VALF;
}

/// Returns the lanes of a group whose rays may hit a shape before their current hits. The test uses the distance
/// between the lens rays and the eye's rays at the depth of the shape's middle. The shape's box begins at `near`.
static inline unsigned R(lanes_through_lens)(const R(tile_cast) * tile, const shape_on_screen *shape, float middle,
                                             float near, int x, int y)
{
    const R(tile_lens) *lens = tile->lens;
    const vf share = f_set(1 - middle * lens->seen.per_focus), k = f_set(shape->k);
    unsigned lanes = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const unsigned open = fm_bits(f_le(f_set(near), f_load(tile->depth[y * tile->across + x] + i)));
        if (!open)
            continue;
        const vf u = f_load(tile->s[x] + i) * k + f_load(lens->across[0] + i) * share;
        const vf v = f_load(lens->across[1] + i) * share - f_load(tile->t[y] + i) * k;
        lanes |= (open & shape_at(shape, u, v)) << i;
    }
    return lanes;
}

#endif
