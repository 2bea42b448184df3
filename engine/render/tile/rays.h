/// Rays that start on surfaces, in arrays: at most a tile's samples. Internal.
#ifndef GLINT_TILE_RAYS_H
#define GLINT_TILE_RAYS_H

#include "engine/render/tile/tile.h"

/// One ray, outside of the arrays.
typedef struct glint_ray {
    double origin[3], direction[3], weight[3]; ///< the direction has length 1 within rounding
    uint32_t leaving; ///< the primitive that the ray starts on
    uint32_t pixel; ///< index of the ray's sample in the tile
    uint32_t point; ///< starting point of a path of indirect light
    uint32_t depth; ///< mirrors and refractions on its path so far
    uint32_t passes; ///< translucent surfaces that its path went straight through
    uint32_t scatters; ///< scatterings on its path so far
    double path_length; ///< length of the path from the eye to the origin; only in frames with programs
    double least; ///< the weight below which a path of indirect light ends
    uint16_t term; ///< the term that the ray's light is added to
    bool inward;
    bool sight; ///< true if the path has no reflection: the eye sees straight through the surfaces
    bool blind; ///< does not see lamps, because the surface where it starts has their light already
    glint_media media; ///< media around the ray; only in frames with transparent materials
} glint_ray;

struct glint_ray_slope;

typedef struct glint_rays {
    _Alignas(64) double origin[3][GLINT_TILE_SAMPLES], direction[3][GLINT_TILE_SAMPLES]; ///< real
    _Alignas(64) double weight[3][GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t leaving[GLINT_TILE_SAMPLES];
    double path_length[GLINT_TILE_SAMPLES], least[GLINT_TILE_SAMPLES];
    uint32_t pixel[GLINT_TILE_SAMPLES], point[GLINT_TILE_SAMPLES];
    uint32_t depth[GLINT_TILE_SAMPLES], passes[GLINT_TILE_SAMPLES], scatters[GLINT_TILE_SAMPLES];
    uint16_t term[GLINT_TILE_SAMPLES];
    uint32_t group_count;
    bool sight[GLINT_TILE_SAMPLES]; ///< only in frames that need coverage or have translucent surfaces
    uint16_t active[GLINT_TILE_GROUPS], inward[GLINT_TILE_GROUPS], blind[GLINT_TILE_GROUPS]; ///< lanes without a ray
        ///< are undefined
    glint_media media[GLINT_TILE_SAMPLES];
    struct glint_ray_slope *slopes; ///< one per ray and derivative, in frames with derivatives; otherwise undefined
} glint_rays;

/// Makes `rays` an empty set of groups.
void glint_rays_clear(glint_rays *rays, uint32_t group_count);
/// Puts a ray into lane i, which becomes active.
void glint_rays_put(glint_rays *rays, const glint_plan *plan, uint32_t i, const glint_ray *ray);

#endif
