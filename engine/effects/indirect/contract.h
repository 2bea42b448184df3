/// The contract of sky: the background seen by rays that miss. Begin with stages.h.
#ifndef GLINT_CONTRACT_INDIRECT_H
#define GLINT_CONTRACT_INDIRECT_H

#include "engine/stages/contract/tables.h"

typedef struct glint_sky_args {
    uint32_t group_count;
    const uint16_t *missed; ///< one bit per lane
    const double *weight[3];
    double background[3];
    double *sum[3]; ///< in and out: weight times background is added where missed
} glint_sky_args;

#endif
