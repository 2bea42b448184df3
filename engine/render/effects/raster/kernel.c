// raster: the nearest triangle of each ray of a tile, from a list of the triangles that the tile may show. Three edge
// functions, linear over the picture, reject pixels; the remaining pixels are decided as in cast. Contract: contract.h.
#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/shared_edge.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

static const _Alignas(64) float raster_s[GLINT_GROUP] = { 0, 2, 4, 6, 0, 2, 4, 6, 0, 2, 4, 6, 0, 2, 4, 6 };
static const _Alignas(64) float raster_t[GLINT_GROUP] = { 0, 0, 0, 0, -2, -2, -2, -2, -4, -4, -4, -4, -6, -6, -6, -6 };

/// Returns the pixels of group (x, y) within the entry's box.
static inline unsigned raster_box(const glint_raster_entry *entry, int x, int y)
{
    const int left = entry->x0 - 4 * x, right = entry->x1 - 4 * x, top = entry->y0 - 4 * y, bottom = entry->y1 - 4 * y;
    const unsigned columns = 15u << (left > 0 ? left : 0) & 15u >> (right < 3 ? 3 - right : 0);
    const unsigned rows = 0xffffu << (top > 0 ? 4 * top : 0) & 0xffffu >> (bottom < 3 ? 4 * (3 - bottom) : 0);
    return columns * 0x1111u & rows;
}

/// Data shared by the triangles of a tile.
typedef struct R(raster_tile) {
    const glint_raster_args *args;
    int across;
    double first[2]; ///< position of the tile's first pixel, in the camera's units of half a pixel
    _Alignas(64) float far[GLINT_TILE_GROUPS]; ///< as in tile_cast
    uint64_t stale;
} R(raster_tile);

/// One triangle in one tile.
typedef struct R(raster_triangle) {
    const glint_prim *prim;
    uint32_t id;
    bool filtered;
    real corner[3][3]; ///< the corners relative to the eye, in units of the table
    float base[3], along_s[3], along_t[3],
        limit; ///< edge functions, relative to the tile's first pixel; a pixel is inside if none is below -limit
} R(raster_triangle);

/// Computes the edge functions of a triangle as linear functions of the pixel. p: the corners relative to the eye.
/// Returns the orientation of the corners, or 0 if it is uncertain.
static int R(raster_edges)(const glint_camera_args *camera, double p[3][3], double base[3], double along_s[3],
                           double along_t[3], double rounding, double limit[3])
{
    double sum = 0, size = 0, longest = 1;
    const double beyond = fabs(camera->beyond[0]) + fabs(camera->beyond[1]);
    const double reach = (fabs(camera->width) + fabs(camera->height)) + 2 * beyond + 2;
    for (int j = 0; j < 3; j++) {
        size = fmax(size, (fabs(p[j][0]) + fabs(p[j][1])) + fabs(p[j][2]));
        longest = fmax(longest, reach * ((fabs(camera->right[j]) + fabs(camera->up[j])) + fabs(camera->forward[j])));
    }
    if (camera->orthographic)
        size += longest;
    for (int j = 0; j < 3; j++) {
        const double *a = p[(j + 1) % 3], *b = p[(j + 2) % 3];
        double n[3], c[3], r[3], u[3];
        for (int k = 0; k < 3; k++) {
            const int x = (k + 1) % 3, y = (k + 2) % 3;
            n[k] = a[x] * b[y] - a[y] * b[x];
            c[k] = b[k] - a[k];
        }
        base[j] = DOT(n, camera->forward);
        along_s[j] = DOT(n, camera->right);
        along_t[j] = DOT(n, camera->up);
        for (int k = 0; k < 3 && camera->orthographic; k++) {
            const int x = (k + 1) % 3, y = (k + 2) % 3;
            r[k] = camera->right[x] * c[y] - camera->right[y] * c[x];
            u[k] = camera->up[x] * c[y] - camera->up[y] * c[x];
        }
        if (camera->orthographic) {
            along_s[j] = -DOT(r, camera->forward);
            along_t[j] = -DOT(u, camera->forward);
        }
        limit[j] = rounding * size * size * longest;
        sum += camera->orthographic ? base[j] : DOT(p[j], n) / 3;
    }
    const double unsure = rounding * size * size * (camera->orthographic ? longest : size);
    return sum > unsure ? 1 : sum < -unsure ? -1 : 0;
}

static void R(make_raster_filter)(const R(raster_tile) * tile, R(raster_triangle) * triangle)
{
    const glint_camera_args *camera = tile->args->cast.camera;
    const double rounding = GLINT_REAL == 64 ? 0x1p-46 : 0x1p-17;
    double p[3][3], base[3], along_s[3], along_t[3], limit[3], most = 0;
    for (int j = 0; j < 9; j++)
        p[j / 3][j % 3] = triangle->corner[j / 3][j % 3];
    if (camera->orthographic) // an orthographic camera's rays are in world units
        for (int j = 0; j < 9; j++)
            p[j / 3][j % 3] /= tile->args->cast.geometry->scale;
    const int side = R(raster_edges)(camera, p, base, along_s, along_t, rounding, limit);
    for (int j = 0; j < 3; j++) {
        const double here = (base[j] + tile->first[0] * along_s[j]) + tile->first[1] * along_t[j];
        triangle->base[j] = (float)(side * here);
        triangle->along_s[j] = (float)(side * along_s[j]);
        triangle->along_t[j] = (float)(side * along_t[j]);
        const double spread = 2 * GLINT_TILE_WIDTH * (fabs(along_s[j]) + fabs(along_t[j]));
        most = fmax(most, 0x1p-20 * (fabs(here) + spread) + limit[j]);
    }
    triangle->limit = (float)(most * (1 + 0x1p-20)) + FLT_MIN;
    triangle->filtered = side != 0 && triangle->limit < FLT_MAX;
}

/// Returns the pixels of group (x, y) that the edges do not reject.
static inline unsigned R(raster_inside)(const R(raster_triangle) * triangle, int x, int y)
{
    const vf limit = f_set(-triangle->limit);
    unsigned inside = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const vf s = f_set((float)(8 * x)) + f_load(raster_s + i), t = f_set((float)(-8 * y)) + f_load(raster_t + i);
        fm out = fm_from_bits(0);
        for (int j = 0; j < 3; j++) {
            const vf e = (f_set(triangle->base[j]) + s * f_set(triangle->along_s[j])) + t * f_set(triangle->along_t[j]);
            out = fm_or(out, f_lt(e, limit));
        }
        inside |= (~fm_bits(out) & ((1u << VF) - 1)) << i;
    }
    return inside;
}

/// Decides a triangle for lanes of a group.
static inline bool R(decide_raster)(const R(raster_tile) * tile, const R(raster_triangle) * triangle, int x, int y,
                                    unsigned lanes)
{
    const glint_cast_args *args = &tile->args->cast;
    const glint_geometry_table *table = args->geometry;
    const bool bundle = !args->camera->orthographic;
    const size_t at = (size_t)(y * tile->across + x) * GLINT_GROUP;
    const R(group_directions) directions = R(directions_of)(bundle ? args->camera : NULL, (uint32_t)x, (uint32_t)y);
    bool any = false;
    count_tests(args->tests, lanes);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        if (!(lanes >> i & ((1u << VR) - 1)))
            continue;
        vr d[3], p[3][3], t;
        vr from[3] = { r_set(args->camera->eye[0]), r_set(args->camera->eye[1]), r_set(args->camera->eye[2]) };
        R(load_direction)(directions, args->direction, at, i, d);
        if (bundle) {
            for (int j = 0; j < 9; j++)
                p[j / 3][j % 3] = r_set(triangle->corner[j / 3][j % 3]);
        } else {
            R(load3)(args->origin, at + (size_t)i, from);
            R(corners_from)(from, triangle->prim, table->scale, p);
        }
        rm hit = R(intersect_triangle)(p, from, d, r_set(table->scale), R(face_of)(table, triangle->prim), &t);
        hit = R(unless_begun_on)(table, triangle->prim, NULL, from, hit, t);
        if (!rm_bits(hit))
            continue;
        R(update_nearest)(args, at + (size_t)i, triangle->id, hit, t);
        any = true;
    }
    return any;
}

static void R(raster_entry)(R(raster_tile) * tile, const glint_raster_entry *entry)
{
    const glint_cast_args *args = &tile->args->cast;
    R(raster_triangle) triangle = { .prim = &args->geometry->prims[entry->prim], .id = entry->prim };
    const int x0 = entry->x0 / 4, x1 = entry->x1 / 4, y0 = entry->y0 / 4, y1 = entry->y1 / 4;
    bool made = false;
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            const uint32_t g = (uint32_t)(y * tile->across + x);
            if (tile->stale >> g & 1) {
                tile->far[g] = R(farthest)(args, (size_t)g * GLINT_GROUP);
                tile->stale &= ~((uint64_t)1 << g);
            }
            if (tile->far[g] < entry->depth)
                continue;
            if (!made) {
                for (int j = 0; j < 9; j++)
                    triangle.corner[j / 3][j % 3] =
                        ((real)triangle.prim->corner[j / 3][j % 3] - (real)args->camera->eye[j % 3]) *
                        (real)args->geometry->scale;
                if ((x1 - x0 + 1) * (y1 - y0 + 1) > 2)
                    R(make_raster_filter)(tile, &triangle);
                made = true;
            }
            unsigned lanes = raster_box(entry, x, y) & args->active[g];
            if (lanes && triangle.filtered)
                lanes &= R(raster_inside)(&triangle, x, y);
            if (lanes && R(decide_raster)(tile, &triangle, x, y, lanes))
                tile->stale |= (uint64_t)1 << g;
        }
}

static void R(raster)(const glint_raster_args *args)
{
    const glint_cast_args *cast = &args->cast;
    const glint_camera_args *camera = cast->camera;
    R(raster_tile) tile = { .args = args, .across = (int)camera->groups_across };
    tile.first[0] = 2 * (camera->x0 + camera->offset[0]) - camera->width;
    tile.first[1] = camera->height - 2 * (camera->y0 + camera->offset[1]);
    for (uint32_t g = 0; g < cast->group_count; g++) {
        R(start_group)(cast, g);
        tile.far[g] = HUGE_VALF;
    }
    for (uint32_t i = 0; i < args->entry_count && !(i % 64 == 0 && is_stopped(cast->stop)); i++)
        R(raster_entry)(&tile, &args->entries[i]);
    for (uint32_t g = 0; g < cast->group_count; g++)
        R(finish_group)(cast, g);
}

#if GLINT_WITH(RASTER)
KERNEL(raster, glint_raster_args)
#endif
