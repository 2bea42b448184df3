// pixels: the hits of a camera's rays through pixels given one by one, as adaptive sampling selects them. If there
// are few primitives, each is tested against every ray. If there are many, the rays traverse the index together like
// the rays of a tile, over a screen of smaller cells. Each cell has a list of the groups with a ray in the cell.
// Contract: stages.h.
#ifndef GLINT_ADAPTIVE_KERNEL_PIXELS_H
#define GLINT_ADAPTIVE_KERNEL_PIXELS_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/cast.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/index/candidate.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/view.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

/// Decides a sphere for all lanes of a group of pixels at any position.
INNER void R(decide_ball)(const glint_cast_args *args, const R(candidate) * ball, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    const vr f[3] = { r_set(ball->f[0]), r_set(ball->f[1]), r_set(ball->f[2]) };
    const R(group_directions) directions = R(directions_of)(args->camera, 0, g);
    count_tests(args->tests, args->active[g]);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        vr d[3], t;
        R(load_direction)(directions, args->direction, 0, i, d);
        const vr a = DOT(d, d), b = -DOT(f, d);
        if (!rm_bits(r_le(r_set(0), R(discriminant)(f, d, a, b, r_set(ball->c), r_set(ball->r2)))))
            continue;
        const rm hit = R(intersect_ball)(f, d, a, r_set(ball->c), r_set(ball->r2), r_set(ball->scale), &t);
        if (rm_bits(hit))
            R(update_nearest)(args, at + (size_t)i, ball->id, hit, t);
    }
}

// ---- Few primitives ----

#define PIXEL_CANDIDATES 16 ///< maximum number of primitives that are tested against every ray

/// Decides a candidate for all rays of pixels at any position.
static void R(cast_to_pixels)(R(tile_cast) * tile, const R(candidate) * candidate)
{
    const glint_cast_args *args = tile->args;
    for (uint32_t g = 0; g < args->group_count; g++)
        if (candidate->prim->kind == GLINT_PRIM_SPHERE)
            R(decide_ball)(args, candidate, g);
        else
            R(decide_pixels)(tile, candidate, 0, (int)g, args->active[g]);
}

/// Casts in a scene with few primitives.
static void R(cast_few_to_pixels)(const glint_cast_args *args, const R(cast_view) * view, const glint_camera_args *around)
{
    const R(candidate) * list[GLINT_FIRST_CANDIDATES];
    R(tile_cast) tile;
    const int count = R(candidates_in)(view, around, list, view->count);
    tile.args = args;
    tile.across = 1;
    for (uint32_t g = 0; g < args->group_count; g++)
        R(start_group)(args, g);
    for (int k = 0; k < count; k++)
        R(cast_to_pixels)(&tile, list[k]);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(finish_group)(args, g);
}

// ---- Many primitives ----

_Static_assert(SCREEN_ACROSS == 1 << 4, "place_pixels makes numbers of cells of it");

/// Computes the screen positions of the rays of a group. Lanes without a ray get the cell of another lane.
static void R(place_pixels)(const R(tile_cast) * tile, uint32_t g)
{
    const glint_camera_args *camera = tile->args->camera;
    R(pixel_groups) *pixels = tile->pixels;
    _Alignas(64) real s[GLINT_GROUP], t[GLINT_GROUP];
    R(pixel_axis)(0, camera->pixel[0] + (size_t)g * GLINT_GROUP, camera->offset[0], camera->width, false, s);
    R(pixel_axis)(0, camera->pixel[1] + (size_t)g * GLINT_GROUP, camera->offset[1], camera->height, true, t);
    R(narrow)(s, pixels->s[g]);
    R(narrow)(t, pixels->t[g]);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const vi column = screen_cell(&tile->view, 0, f_load(pixels->s[g] + i));
        const vi row = screen_cell(&tile->view, 1, -f_load(pixels->t[g] + i));
        i_store(pixels->cell[g] + i, i_or(i_shl(row, 4), column));
    }
    pixels->starts[g] = 1;
    for (int i = 1; i < GLINT_GROUP; i++)
        pixels->starts[g] |= (uint16_t)((pixels->cell[g][i] != pixels->cell[g][i - 1]) << i);
    for (unsigned starts = pixels->starts[g]; starts; starts &= starts - 1)
        (&pixels->in_cell[0][0])[pixels->cell[g][__builtin_ctz(starts)]] |= (uint64_t)1 << g;
}

/// Tests the planes and all other unbounded primitives.
static void R(cast_planes_to_pixels)(R(tile_cast) * tile)
{
    const R(pixel_groups) *pixels = tile->pixels;
    R(candidate) candidate;
    uint32_t next = 0;
    while (R(open_planes)(tile, &next, &candidate, 1))
        for (uint32_t g = 0; g < tile->args->group_count; g++) {
            unsigned near = 0;
            for (int i = 0; i < GLINT_GROUP; i += VF) {
                const vf s = f_load(pixels->s[g] + i), t = f_load(pixels->t[g] + i);
                const vf length2 = s * s * f_set(tile->rr) + (f_set(1) + t * t * f_set(tile->uu));
                near |= R(near_positions)(&candidate, s, t, length2) << i;
            }
            near &= tile->args->active[g];
            if (near)
                R(decide_pixels)(tile, &candidate, 0, (int)g, near);
        }
}

/// Aims the screen, and chooses its cells so that they cover all pixels.
static void R(aim_pixels)(const glint_cast_args *args, const glint_camera_args *around, R(tile_cast) * tile)
{
    glint_cast_args whole = *args;
    whole.camera = around;
    R(aim_tile)(&whole, tile);
    tile->args = args;
    tile->across = 1; // one group per row; the directions are in arrays
    tile->scaled = tile->deep = true;
    for (int j = 0; j < 2; j++) {
        const double first = j ? around->y0 : around->x0, end = args->camera->end[j];
        tile->view.count[j] = (int)(end - first + GLINT_PIXEL_CELL - 1) / GLINT_PIXEL_CELL;
        tile->view.cells[j] = 0.5f / GLINT_PIXEL_CELL;
        tile->view.last[j] = (float)(2 * end - (j ? around->height : around->width));
    }
    for (int y = 0; y < tile->view.count[1]; y++)
        for (int x = 0; x < SCREEN_ACROSS; x++)
            tile->far[y][x] = -HUGE_VALF;
}

/// Casts in a scene with many primitives. around: the camera of a rectangle that holds all pixels.
static void R(cast_many_to_pixels)(const glint_cast_args *args, const glint_camera_args *around)
{
    R(tile_cast) tile;
    R(pixel_groups) pixels;
    screen_entry stack[WALK_STACK];
    R(aim_pixels)(args, around, &tile);
    tile.pixels = &pixels;
    memset(pixels.in_cell, 0, sizeof pixels.in_cell);
    for (uint32_t g = 0; g < args->group_count; g++) {
        R(place_pixels)(&tile, g);
        R(start_group)(args, g);
    }
    R(cast_planes_to_pixels)(&tile);
    for (uint32_t g = 0; g < args->group_count; g++)
        pixels.far[g] = R(depth_of_group)(&tile, (int)g);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(note_cells)(&tile, (int)g, pixels.far[g]);
    stack[0] = entry_of_root(&tile.view);
    if (args->geometry->nodes)
        R(walk_tile)(&tile, stack, 1);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(finish_group)(args, g);
}

// ---- Any number ----

/// Casts for pixels at any position.
static void R(cast_pixels)(const glint_cast_args *args)
{
    const glint_camera_args *camera = args->camera;
    glint_camera_args around = *camera;
    glint_cast_args tile_args = *args;
    glint_cast_view own;
    own.made = false;
    around.groups_across = (uint32_t)(camera->end[0] - camera->x0 + 3) / 4;
    around.group_count = around.groups_across * ((uint32_t)(camera->end[1] - camera->y0 + 3) / 4);
    tile_args.camera = &around;
    const R(cast_view) *view = R(view_of)(&tile_args, &own);
    if (view->few && view->count <= PIXEL_CANDIDATES)
        R(cast_few_to_pixels)(args, view, &around);
    else
        R(cast_many_to_pixels)(args, &around);
}

#endif
