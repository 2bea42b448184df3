/// The contract of bounce: reflected and refracted rays. Begin with stages.h.
#ifndef GLINT_CONTRACT_BOUNCE_H
#define GLINT_CONTRACT_BOUNCE_H

#include "engine/render/stages/contract/hits.h"

typedef struct glint_bounce_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< one bit per lane
    const glint_camera_args *camera; ///< the rays of a perspective camera; NULL: the directions are in `direction`
    const void *direction[3], *normal[3]; ///< real; the normal as computed by surface
    const void *ratio; ///< real, > 0: refractive index on the ray's side divided by the index on the far side
    void *reflected[3], *refracted[3]; ///< out, real, of length 1 up to rounding
    void *reflectance; ///< out, real, 0 .. 1: reflectance of a dielectric for unpolarised light
    uint16_t *total; ///< out: the wanted lanes with total internal reflection. Their `refracted` is undefined
} glint_bounce_args;
// Outputs are written where wanted. Groups without a wanted lane only get total = 0. Other lanes are undefined. The
// arithmetic: ref.h, by Snell and Fresnel.

#endif
