// The colours of samples, and the sums over samples.
#include "engine/render/stages/film/resolve.h"
#include "engine/render/stages/shade/shade.h"

KERNEL(shade, glint_shade_args)
#if GLINT_WITH(SAMPLES)
KERNEL(resolve, glint_resolve_args)

void GLINT_ENTRY(resolve_samples)(const glint_shade_args *sample, uint32_t count)
{
    resolve_samples(sample, count);
}
#endif
