// box: where rays from the eye meet a box, face by face: what a face is to all of them is found once. Contract: stages.h, surface.
#ifndef GLINT_SURFACE_BOX_H
#define GLINT_SURFACE_BOX_H

#include "engine/stages/cast/box.h"
#include "engine/stages/cast/face.h"
#include "engine/stages/cast/solid.h"
#include "engine/stages/cast/triangle.h"
#include "engine/stages/simd/real.h"

/// A box as all rays of a camera see it.
typedef struct R(box_view) {
    real height[6]; ///< of the eye over the faces
    real near[6]; ///< what is no higher is on a face
    bool level; ///< it is along the axes of the world
    real within[3]; ///< level: what is less far from the centre along an axis, where the box is the unit one, is on no face across it
} R(box_view);

/// A share of the eye's height over a face, of which nothing but rounding is left there.
#define BOX_ON (GLINT_REAL == 64 ? 0x1p-40 : 0x1p-14)

/// Fills the rest; of another solid it is not level. f: from the centre to the eye, where it is the unit one.
static void R(view_box)(const glint_solid *solid, const real f[3], R(box_view) * view)
{
    view->level = solid->form == GLINT_FORM_BOX;
    if (!view->level)
        return;
    for (int i = 0; i < 6; i++)
        view->near[i] = (real)BOX_ON * (view->height[i] < 0 ? -view->height[i] : view->height[i]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            view->level = view->level && (i == k || (solid->inverse[i][k] == 0 && solid->forward[i][k] == 0));
    for (int i = 0; i < 6; i++)
        view->level = view->level && solid->faces[i].axis == (uint32_t)i / 2;
    for (int k = 0; k < 3; k++) { // what `near` lets a place be off, and several times what rounding does
        const glint_face *low = &solid->faces[2 * k];
        const real across = R(size)(view->height[2 * k] - view->height[2 * k + 1]);
        const real places = (real)(low[0].places + low[1].places) / across;
        view->within[k] = 1 - 4 * (real)BOX_ON * ((1 + R(size)(f[k])) + 2 * places);
    }
}

/// Sorts rays by the face that they are on at t. Returns whether each of `lanes` is on only one: the face that t was
/// made of. level: view->level, a constant.
INNER bool R(lanes_on_faces)(const glint_solid *solid, const R(box_view) * view, const bool level, const vr d[3], vr t,
                             unsigned lanes, unsigned on[6])
{
    unsigned once = 0, twice = 0;
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        const glint_face *low = solid->faces + 2 * axis;
        vr rise = r_set(low->normal[axis]) * d[axis];
        if (!level)
            rise = R(face_rise)(low, d);
        const vr moved = t * rise;
#pragma GCC unroll 2
        for (int i = 2 * axis; i < 2 * axis + 2; i++) {
            on[i] = rm_bits(r_le(R(abs)(r_set(view->height[i]) + moved), r_set(view->near[i])));
            twice |= once & on[i];
            once |= on[i];
        }
    }
    once &= rm_bits(r_lt(r_set(0x1p-100), t)) & ~twice; // not at GLINT_LEAST_WAY
    return (lanes & ~once) == 0;
}

/// Where rays are that meet a level box at t. k: where it is the unit one.
INNER void R(place_in_level)(const glint_solid *solid, const glint_prim *prim, const real f[3], const vr d[3], vr t, vr k[3],
                             vr p[3])
{
    for (int c = 0; c < 3; c++) { // what the other columns of the maps add is 0
        k[c] = r_set(f[c]) + t * (r_set(solid->inverse[c][c]) * d[c]);
        p[c] = r_set(prim->center[c]) + r_set(solid->forward[c][c]) * k[c];
    }
}

/// Points of a box before those on faces that are square to an axis of the world are put there. on: lanes of each face.
INNER void R(place_on_box)(const glint_solid *solid, const glint_prim *prim, const real f[3], const bool level,
                           const vr d[3], vr t, const unsigned on[6], vr p[3])
{
    vr e[3], k[3];
    if (level) {
        R(place_in_level)(solid, prim, f, d, t, k, p);
        return;
    }
    R(to_unit)(solid, d, e);
    for (int c = 0; c < 3; c++) {
        k[c] = r_set(f[c]) + t * e[c];
        k[c] = r_select(rm_from_bits(on[2 * c]), r_set(-1), r_select(rm_from_bits(on[2 * c + 1]), r_set(1), k[c]));
    }
    for (int c = 0; c < 3; c++)
        p[c] = r_set(prim->center[c]) + ((r_set(solid->forward[c][0]) * k[0] + r_set(solid->forward[c][1]) * k[1]) +
                                         r_set(solid->forward[c][2]) * k[2]);
}

/// Lanes of a group by where they are in a level box: within, along each axis, and on the lower side of its centre.
typedef struct R(level_lanes) {
    unsigned within[3], low[3];
    unsigned ahead; ///< not at GLINT_LEAST_WAY
} R(level_lanes);

/// Sorts lanes i .. of it.
INNER void R(sort_in_level)(const R(box_view) * view, const vr k[3], vr t, int i, R(level_lanes) * lanes)
{
    for (int c = 0; c < 3; c++) {
        lanes->within[c] |= rm_bits(r_lt(R(abs)(k[c]), r_set(view->within[c]))) << i;
        lanes->low[c] |= rm_bits(r_lt(k[c], r_set(0))) << i;
    }
    lanes->ahead |= rm_bits(r_lt(r_set(0x1p-100), t)) << i;
}

/// The face that all lanes meet away from its edges: that is the one that each t was made of. 6: there is none such.
static inline unsigned R(face_of_level)(const R(level_lanes) * lanes)
{
    for (unsigned c = 0; c < 3; c++)
        if (!lanes->within[c] && (lanes->within[(c + 1) % 3] & lanes->within[(c + 2) % 3] & lanes->ahead) == 0xffff)
            return lanes->low[c] == 0xffff ? 2 * c : lanes->low[c] == 0 ? 2 * c + 1 : 6;
    return 6;
}

/// Its normal, and the points of lanes that are on it.
INNER void R(normal_of_face)(const glint_solid *solid, unsigned face, R(box_faces) * faces, vr n[3])
{
    if (!(faces->known >> face & 1))
        R(learn_face)(solid, (int)face, faces);
    for (int c = 0; c < 3; c++)
        n[c] = r_set(faces->normal[face][c]);
}

INNER void R(put_on_face)(const glint_solid *solid, unsigned face, vr p[3])
{
    for (unsigned c = 0; c < 3; c++)
        if (face / 2 == c)
            p[c] = r_set(solid->faces[face].at[c]);
}

/// As below; level: view->level, a constant.
INNER bool R(find_on_box)(const glint_solid *solid, const glint_prim *prim, const real f[3], const R(box_view) * view,
                          const bool level, const vr d[3], vr t, unsigned lanes, R(box_faces) * faces, vr n[3], vr p[3])
{
    unsigned on[6], met = 0;
    if (!R(lanes_on_faces)(solid, view, level, d, t, lanes, on))
        return false;
    R(place_on_box)(solid, prim, f, level, d, t, on, p);
    for (unsigned i = 0; i < 6; i++)
        met |= (unsigned)((on[i] & lanes) != 0) << i;
    for (unsigned left = met; left; left &= left - 1) {
        const int i = __builtin_ctz(left);
        const glint_face *face = &solid->faces[i];
        const rm mine = rm_from_bits(on[i]);
        if (!(faces->known >> i & 1))
            R(learn_face)(solid, i, faces);
        for (int c = 0; c < 3; c++) {
            n[c] = left == met ? r_set(faces->normal[i][c]) : r_select(mine, r_set(faces->normal[i][c]), n[c]);
            if (face->axis == (uint32_t)c)
                p[c] = r_select(mine, r_set(face->at[c]), p[c]);
        }
    }
    return true;
}

/// Outward normals and points of `lanes`, which meet a box at t; f: from its centre to the eye, where it is the unit one.
/// Returns whether it was that easy; else nothing is done.
static bool R(box_surface)(const glint_solid *solid, const glint_prim *prim, const real f[3], const R(box_view) * view,
                           const vr d[3], vr t, unsigned lanes, R(box_faces) * faces, vr n[3], vr p[3])
{
    return view->level ? R(find_on_box)(solid, prim, f, view, true, d, t, lanes, faces, n, p)
                       : R(find_on_box)(solid, prim, f, view, false, d, t, lanes, faces, n, p);
}

#endif
