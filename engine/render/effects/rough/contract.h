/// The contract of spread: rays that the facets of GGX's distribution reflect. Begin with stages.h.
#ifndef GLINT_CONTRACT_ROUGH_H
#define GLINT_CONTRACT_ROUGH_H

#include "engine/render/stages/contract/film.h"

typedef struct glint_spread_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< one bit per lane
    const void *normal[3], *ray[3]; ///< real, unit; ray: the direction of the arriving ray
    const void *alpha; ///< real, above 0: width of the distribution
    const void *disk[2]; ///< real: a point of the unit disk
    void *direction[3]; ///< out, real, of length 1 up to rounding; may be the arrays of `disk`
    double *grazing; ///< out: (1 - cosine)^5, where `cosine` is that of the angle between ray and facet
    double *weight; ///< out: G2 / G1, the probability that no other facet is in the way; 0 below the surface
    const double *head_on[3]; ///< weight of a ray that is reflected straight back, before the factor `weight`
    const double *added[3]; ///< increase of that weight at `grazing` = 1
    double *ray_weight[3]; ///< out: weight * (head_on + added * grazing), at most GLINT_WEIGHT_MAX; NULL: not wanted
} glint_spread_args;
// Groups without a wanted lane are not written. In other groups, lanes that are not wanted are undefined. The
// arithmetic: ref.h: a point of the disk becomes a cap of the hemisphere of directions from which the facet is
// seen (J. Dupuy and A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023), in the basis of
// scatter; G2 is height-correlated.

#endif
