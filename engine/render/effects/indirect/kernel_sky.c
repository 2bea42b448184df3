// sky: the background seen by rays that miss. Contract: contract.h.
#include "engine/render/stages/shade/group.h"
#include "engine/render/stages/simd/elementary.h"

static void sky(const glint_sky_args *args)
{
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        const unsigned missed = args->missed[g];
        for (int c = 0; missed && c < 3; c++)
            for (int i = 0; i < GLINT_GROUP; i += VD) {
                double *sum = args->sum[c] + at + i;
                const vd old = d_load(sum), now = old + d_load(args->weight[c] + at + i) * d_set(args->background[c]);
                d_store(sum, d_select(dm_from_bits(missed >> i & ((1u << VD) - 1)), now, old));
            }
    }
}

#if GLINT_WITH(INDIRECT)
KERNEL(sky, glint_sky_args)
#endif
