/// Rays that start on surfaces, in arrays: at most a tile's samples. Internal.
#ifndef GLINT_PATHS_RAY_H
#define GLINT_PATHS_RAY_H

#include "engine/render/tile/tile.h"

struct glint_ray_slope;

typedef struct glint_rays {
    _Alignas(64) double origin[3][GLINT_TILE_SAMPLES], direction[3][GLINT_TILE_SAMPLES]; ///< real; directions have length 1
        ///< within rounding
    _Alignas(64) double throughput[3][GLINT_TILE_SAMPLES]; ///< factor of the light along the ray
    _Alignas(64) uint32_t origin_prim[GLINT_TILE_SAMPLES]; ///< the primitive that the ray starts on
    double path_length[GLINT_TILE_SAMPLES]; ///< length of the path from the eye to the origin; only in frames with programs
    double min_throughput[GLINT_TILE_SAMPLES]; ///< below it a path of indirect light ends
    uint32_t pixel[GLINT_TILE_SAMPLES]; ///< index of the ray's sample in the tile
    uint32_t point[GLINT_TILE_SAMPLES]; ///< starting point of a path of indirect light
    uint32_t depth[GLINT_TILE_SAMPLES]; ///< mirrors and refractions on its path so far
    uint32_t straight_count[GLINT_TILE_SAMPLES]; ///< translucent surfaces that its path went straight through
    uint32_t scatters[GLINT_TILE_SAMPLES]; ///< scatterings on its path so far
    uint16_t term[GLINT_TILE_SAMPLES]; ///< the term that the ray's light is added to
    uint32_t group_count;
    bool camera_path[GLINT_TILE_SAMPLES]; ///< the path has no reflection: the eye sees straight through the surfaces
    uint16_t active[GLINT_TILE_GROUPS]; ///< lanes without a ray are undefined
    uint16_t inward[GLINT_TILE_GROUPS]; ///< rays that start into the back of their surface
    uint16_t skip_emitters[GLINT_TILE_GROUPS]; ///< rays that do not see lamps: the surface where they start has their light
    glint_media media[GLINT_TILE_SAMPLES]; ///< around the ray; only in frames with transparent materials
    struct glint_ray_slope *slopes; ///< one per ray and derivative, in frames with derivatives; otherwise undefined
} glint_rays;

/// Makes `rays` an empty set of groups.
void glint_rays_clear(glint_rays *rays, uint32_t group_count);

/// Sets or clears the bit of ray i in `active`, `inward` or `skip_emitters`.
static inline void glint_rays_mark(uint16_t *bits, uint32_t i, bool set)
{
    const unsigned bit = 1u << i % GLINT_GROUP;
    bits[i / GLINT_GROUP] = (uint16_t)(set ? bits[i / GLINT_GROUP] | bit : bits[i / GLINT_GROUP] & ~bit);
}

#endif
