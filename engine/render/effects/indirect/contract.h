/// The contract of the stages of indirect light: scatter, sky. Begin with stages.h.
#ifndef GLINT_CONTRACT_INDIRECT_H
#define GLINT_CONTRACT_INDIRECT_H

#include "engine/render/stages/contract/tables.h"

// ---- scatter: cosine-distributed directions around normals ----

typedef struct glint_scatter_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< one bit per lane
    const void *normal[3]; ///< real, unit
    const uint32_t *number, *order, *digits[2]; ///< for each ray: the number of a point of a sequence, and the seeds
        ///< of that sequence
    uint32_t further; ///< offset that is added to the `number` of every ray
    void *direction[3]; ///< out, real, of length 1 up to rounding and 2e-9
} glint_scatter_args;
// Groups without a wanted lane are not written. In other groups, lanes that are not wanted are undefined. The point
// (u, v) of the unit square is computed by glint_sequence_flipped, in double. Equal areas of the square get equal
// shares of the light of a uniform sky. The arithmetic: ref.h: the square is mapped to a disk, and the disk is
// projected up onto the hemisphere, which gives a cosine distribution, in the orthonormal basis of T. Duff et al.,
// JCGT 6(1), 2017.

// ---- sky: the background seen by rays that miss ----

typedef struct glint_sky_args {
    uint32_t group_count;
    const uint16_t *missed; ///< one bit per lane
    const double *weight[3];
    double background[3];
    double *sum[3]; ///< in and out: weight times background is added where missed
} glint_sky_args;

#endif
