// view: the primitives of a small scene as seen by one camera anywhere in its picture: candidates for all tiles. For
// each tile, one test per candidate decides whether the candidate may be visible in the tile. Contract: stages.h,
// cast.
#ifndef GLINT_INDEX_VIEW_H
#define GLINT_INDEX_VIEW_H

#include "engine/render/stages/index/candidate.h"
#include "engine/render/stages/index/cover.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

/// The contents of `scratch` in glint_cast_view.
typedef struct R(cast_view) {
    bool few; ///< true: all primitives are candidates; false: the other fields are not set
    int count;
    float rr, uu, spread; ///< as in tile_cast
    R(candidate) candidates[GLINT_FIRST_CANDIDATES];
} R(cast_view);

_Static_assert(sizeof(R(cast_view)) <= sizeof(((glint_cast_view *)0)->scratch), "the candidates fit");

/// Returns the camera of the whole picture, including the tile, as if it were one tile.
static glint_camera_args R(whole_picture)(const glint_camera_args *camera)
{
    const double across = 4.0 * camera->groups_across;
    const double down = 4.0 * (camera->group_count / camera->groups_across);
    const double right = fmax(camera->width + camera->beyond[0], camera->x0 + across);
    const double bottom = fmax(camera->height + camera->beyond[1], camera->y0 + down);
    glint_camera_args whole = *camera;
    whole.x0 = fmin(camera->x0, 0);
    whole.y0 = fmin(camera->y0, 0);
    whole.groups_across = (uint32_t)((right - whole.x0 + 3) / 4);
    whole.group_count = whole.groups_across * (uint32_t)((bottom - whole.y0 + 3) / 4);
    return whole;
}

static void R(make_view)(const glint_cast_args *args, R(cast_view) * view)
{
    const glint_geometry_table *geometry = args->geometry;
    const glint_node *root = geometry->nodes;
    unsigned nodes = 0, prims = 0;
    for (int i = 0; root && i < GLINT_NODE_WIDTH; i += VF)
        nodes |= fm_bits(box_exists(root, i)) << i;
    if (root)
        prims = nodes & prims_of_node(root);
    view->few =
        nodes == prims && (uint32_t)__builtin_popcount(prims) + geometry->unbounded_count <= GLINT_FIRST_CANDIDATES;
    view->count = 0;
    if (!view->few)
        return;
    const glint_camera_args whole = R(whole_picture)(args->camera);
    glint_cast_args shared = *args;
    R(tile_cast) picture;
    shared.camera = &whole;
    R(aim_tile)(&shared, &picture);
    for (; prims; prims &= prims - 1)
        R(make_candidate)
        (&picture, root->child[__builtin_ctz(prims)] & ~GLINT_NODE_PRIM, &view->candidates[view->count++]);
    for (uint32_t i = 0; i < geometry->unbounded_count; i++)
        R(make_candidate)(&picture, geometry->unbounded[i], &view->candidates[view->count++]);
    for (int k = 0; k < view->count; k++)
        R(make_cover)(&picture, &view->candidates[k]);
    view->rr = picture.rr;
    view->uu = picture.uu;
    view->spread = picture.spread;
}

/// Returns the existing view, or makes a new one in `own` and returns it.
static const R(cast_view) * R(view_of)(const glint_cast_args *args, glint_cast_view *own)
{
    glint_cast_view *view = args->view ? args->view : own;
    R(cast_view) *made = (R(cast_view) *)(void *)view->scratch;
    if (!view->made)
        R(make_view)(args, made);
    view->made = true;
    return made;
}

/// Returns whether the candidate may be visible in a rectangle of the picture, given by its middle, the length of the
/// direction there, and its half sizes.
static inline bool R(may_show)(const R(candidate) * candidate, const float middle[2], const float half[2], float length,
                               float spread)
{
    float v[3], sway[3];
    for (int k = 0; k < 3; k++) {
        v[k] = (candidate->base[k] + middle[0] * candidate->along_s[k]) + middle[1] * candidate->along_t[k];
        sway[k] = half[0] * fabsf(candidate->along_s[k]) + half[1] * fabsf(candidate->along_t[k]);
    }
    if (!R(is_round)(candidate))
        return !(v[0] + sway[0] < -candidate->limit || v[1] + sway[1] < -candidate->limit ||
                 v[2] + sway[2] < -candidate->limit);
    const float around = half[0] * candidate->axis_length[0] + half[1] * candidate->axis_length[1];
    const float reach = candidate->outer * (length + spread) + around * 1.00001f;
    return !(reach * reach < DOT(v, v));
}

/// Lists at most `most` candidates that a tile may show. Returns their number.
static int R(candidates_in)(const R(cast_view) * view, const glint_camera_args *camera, const R(candidate) * *list, int most)
{
    const double down = camera->group_count / camera->groups_across;
    const float half[2] = { 4 * (float)camera->groups_across, 4 * (float)down };
    const float middle[2] = { (float)(2 * camera->x0 - camera->width) + half[0],
                              (float)(camera->height - 2 * camera->y0) - half[1] };
    const float length = sqrtf((1 + middle[0] * middle[0] * view->rr) + middle[1] * middle[1] * view->uu);
    const float spread = 1.00001f * sqrtf(half[0] * half[0] * view->rr + half[1] * half[1] * view->uu);
    int found = 0;
    for (int k = 0; k < view->count && found < most; k++)
        if (R(may_show)(&view->candidates[k], middle, half, length, spread))
            list[found++] = &view->candidates[k];
    return found;
}

#endif
