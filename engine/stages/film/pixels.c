// Differences between pixels, and 8-bit pixel values.
#include "engine/stages/film/differ.h"
#include "engine/stages/film/tone.h"

KERNEL(tone, glint_tone_args)
#if GLINT_WITH_SAMPLES
KERNEL(estimate, glint_estimate_args)

void GLINT_ENTRY(range)(const glint_range_args *args, float out[2])
{
    range(args, out);
}

void GLINT_ENTRY(differ)(const glint_differ_args *args, glint_differences *out)
{
    differ(args, out);
}
#endif
