// surface_mesh: points and normals of groups that show several triangles, computed a vector at a time, with a
// different triangle in each lane. The arithmetic is the same as in triangle.h. Contract: stages.h, surface.
#ifndef GLINT_SURFACE_MESH_H
#define GLINT_SURFACE_MESH_H

#include "engine/render/stages/simd/real.h"

/// The triangles of a group, one per lane.
typedef struct R(mesh_group) {
    _Alignas(64) double corner[3][3][GLINT_GROUP];
    _Alignas(64) double normal[3][GLINT_GROUP]; ///< geometric unit normals
    _Alignas(64) double corner_normal[3][3][GLINT_GROUP]; ///< normals at the three corners, in the lanes of `smooth`
    _Alignas(64) double terminator[GLINT_GROUP]; ///< set with `corner_normal`; 0 in lanes outside of `smooth`
    unsigned smooth;
    bool moves; ///< whether some `terminator` is above 0
} R(mesh_group);

/// Loads VR doubles, rounded.
static inline vr R(load_rounded)(const double *p)
{
#if GLINT_REAL == 64
    return d_load(p);
#else
    return f_join(d_load(p), d_load(p + VD));
#endif
}

INNER void R(load_corners)(double corner[3][3][GLINT_GROUP], int i, vr out[3][3])
{
    for (int j = 0; j < 9; j++)
        out[j / 3][j % 3] = R(load_rounded)(corner[j / 3][j % 3] + i);
}

/// Returns the lanes of `hits` that show triangles, provided that `hits` show more than one primitive.
static inline unsigned R(mesh_lanes)(const glint_surface_args *args, size_t at, unsigned hits)
{
    const uint32_t *prim = args->prim + at;
    unsigned found = 0;
    if (!(hits & ~lanes_equal(prim, prim[__builtin_ctz(hits)])))
        return 0;
    for (unsigned same; hits; hits &= ~same) {
        const uint32_t id = prim[__builtin_ctz(hits)];
        same = lanes_equal(prim, id) & hits;
        found |= args->prims[id].kind == GLINT_PRIM_TRIANGLE ? same : 0;
    }
    return found;
}

/// Stores the materials of the given lanes. Returns the lanes whose surface is one-sided.
static inline unsigned R(put_materials)(const glint_surface_args *args, size_t at, unsigned lanes)
{
    unsigned one_sided = 0;
    for (unsigned same; lanes; lanes &= ~same) {
        const uint32_t id = args->prim[at + (size_t)__builtin_ctz(lanes)];
        same = lanes_equal(args->prim + at, id) & lanes;
        lanes_put(args->material + at, same, args->prims[id].material);
        one_sided |= args->prims[id].two_sided ? 0 : same;
    }
    return one_sided;
}

static inline void R(load_corner_normals)(const glint_surface_args *args, size_t at, unsigned lanes,
                                          R(mesh_group) * mesh)
{
    mesh->smooth = 0;
    mesh->moves = false;
    for (; args->corner_normals && lanes; lanes &= lanes - 1) {
        const int lane = __builtin_ctz(lanes);
        const uint32_t item = args->prims[args->prim[at + (size_t)lane]].item;
        if (item == GLINT_MISS)
            continue;
        if (!mesh->smooth) {
            memset(mesh->corner_normal, 0, sizeof mesh->corner_normal);
            memset(mesh->terminator, 0, sizeof mesh->terminator);
        }
        mesh->smooth |= 1u << lane;
        mesh->terminator[lane] = args->corner_normals[item].terminator;
        mesh->moves = mesh->moves || mesh->terminator[lane] > 0;
        for (int j = 0; j < 9; j++)
            mesh->corner_normal[j / 3][j % 3][lane] = args->corner_normals[item].normal[j / 3][j % 3];
    }
}

/// Loads the triangles of `lanes`, and puts harmless numbers into the other lanes.
static void R(load_mesh)(const glint_surface_args *args, size_t at, unsigned lanes, R(mesh_group) * mesh)
{
    const uint32_t some = args->prim[at + (size_t)__builtin_ctz(lanes)];
    for (int i = 0; i < GLINT_GROUP; i++) {
        const glint_prim *prim = &args->prims[lanes >> i & 1 ? args->prim[at + (size_t)i] : some];
        for (int j = 0; j < 9; j++)
            mesh->corner[j / 3][j % 3][i] = prim->corner[j / 3][j % 3];
    }
    R(load_corner_normals)(args, at, lanes, mesh);
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        vd f[3], g[3], n[3];
        for (int k = 0; k < 3; k++) {
            const vd base = d_load(mesh->corner[0][k] + i);
            f[k] = (d_load(mesh->corner[1][k] + i) - base) * d_set(args->scale);
            g[k] = (d_load(mesh->corner[2][k] + i) - base) * d_set(args->scale);
        }
        for (int k = 0; k < 3; k++)
            n[k] = f[(k + 1) % 3] * g[(k + 2) % 3] - f[(k + 2) % 3] * g[(k + 1) % 3];
        const vd length = d_sqrt(DOT(n, n));
        for (int k = 0; k < 3; k++)
            d_store(mesh->normal[k] + i, n[k] / length);
    }
}

#endif
