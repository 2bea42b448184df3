// estimate and differ: find the neighbouring pixels that differ. Contract: contract.h.
#include "engine/render/stages/shade/group.h"
#include "engine/render/stages/simd/elementary.h"

static void estimate(const glint_estimate_args *args)
{
    const vf gain = f_set(args->gain), top = f_set((float)(65535 * 12.92 * 0.0031308));
    for (uint32_t i = 0; i < args->count; i += VF) {
        const vf x = f_min(f_max(gain * f_load(args->light + i), f_set(0)), f_set(1));
        const vf second = f_sqrt(x), fourth = f_sqrt(second), eighth = f_sqrt(fourth);
        const vf dark = f_set((float)(65535 * 12.92)) * x;
        const vf bright = ((f_set((float)(65535 * 0.5723742167)) * second + f_set((float)(65535 * 0.8301947475)) * fourth) -
                           f_set((float)(65535 * 0.4193434603)) * eighth) +
                          f_set((float)(65535 * 0.01599656894));
        f_store(args->code + i, f_select(f_le(dark, top), dark, bright));
    }
}

/// Returns the differences of one value for VF pairs, from pixel i of one line and pixel k of another line on.
static inline vf apart_in(const float *const *p, int value, uint32_t i, const float *const *q, uint32_t k)
{
    return f_abs(f_load_any(p[value] + i) - f_load_any(q[value] + k));
}

/// Compares VF pairs, from pixel i of one line and pixel k of another line on.
static inline void differ_pairs(const glint_differ_args *args, const float *const *p, uint32_t i, const float *const *q,
                                uint32_t k, uint32_t bit, uint32_t *sure, uint32_t *undecided)
{
    vf cosine = f_load_any(p[GLINT_DIFFER_NORMAL] + i) * f_load_any(q[GLINT_DIFFER_NORMAL] + k);
    for (int c = 1; c < 3; c++)
        cosine = cosine + f_load_any(p[GLINT_DIFFER_NORMAL + c] + i) * f_load_any(q[GLINT_DIFFER_NORMAL + c] + k);
    vf sum = apart_in(p, GLINT_DIFFER_CODE, i, q, k);
    for (int c = 1; c < (args->alpha ? 4 : 3); c++)
        sum = sum + apart_in(p, GLINT_DIFFER_CODE + c, i, q, k);
    const vf id = f_load_any(p[GLINT_DIFFER_ID] + i);
    const fm same = f_eq(id, f_load_any(q[GLINT_DIFFER_ID] + k));
    const fm bent = fm_and(f_lt(f_set(0), id), f_lt(cosine, f_set(args->cosine)));
    const unsigned all = (1u << VF) - 1;
    *sure |= ((~fm_bits(same) & all) | fm_bits(fm_or(bent, f_lt(f_set(args->high), sum)))) << bit;
    *undecided |= fm_bits(f_lt(f_set(args->low), sum)) << bit;
}

/// Returns a mask of the lowest `count` bits; count is at most 32.
static inline uint32_t first_bits(uint32_t count) { return count < 32 ? (1u << count) - 1 : UINT32_MAX; }

static inline void differ_lines(const glint_differ_args *args, bool along, bool across, glint_differences *out)
{
    *out = (glint_differences) { .sure = { 0 } };
    for (uint32_t i = 0; i < args->count; i += VF) {
        if (along)
            differ_pairs(args, args->p, i, args->p, i + 1, i, &out->sure[GLINT_DIFFER_ALONG],
                         &out->undecided[GLINT_DIFFER_ALONG]);
        if (!across)
            continue;
        differ_pairs(args, args->p, i, args->q, i, i, &out->sure[GLINT_DIFFER_ACROSS],
                     &out->undecided[GLINT_DIFFER_ACROSS]);
        differ_pairs(args, args->p, i, args->q, i + 1, i, &out->sure[GLINT_DIFFER_FALLING],
                     &out->undecided[GLINT_DIFFER_FALLING]);
        differ_pairs(args, args->p, i + 1, args->q, i, i, &out->sure[GLINT_DIFFER_RISING],
                     &out->undecided[GLINT_DIFFER_RISING]);
    }
    for (int direction = 0; direction < GLINT_DIFFER_DIRECTIONS; direction++) {
        const uint32_t pairs = first_bits(direction == GLINT_DIFFER_ACROSS ? args->count : args->ahead);
        out->sure[direction] &= pairs;
        out->undecided[direction] &= pairs;
    }
}

/// Compiles one copy of the kernel for each constant.
static void differ(const glint_differ_args *args, glint_differences *out)
{
    if (args->along && args->q)
        differ_lines(args, true, true, out);
    else
        differ_lines(args, args->along, args->q != NULL, out);
}

#if GLINT_WITH(SAMPLES)
KERNEL(estimate, glint_estimate_args)

void GLINT_ENTRY(differ)(const glint_differ_args *args, glint_differences *out)
{
    differ(args, out);
}
#endif
