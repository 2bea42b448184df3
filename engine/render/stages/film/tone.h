// tone: converts float light to 8-bit pixel values, exactly for every float. If the instruction set has
// f_by_exponent, an estimate gives the value, and only vectors with an uncertain lane are looked up. Contract:
// stages.h.
#ifndef GLINT_FILM_TONE_H
#define GLINT_FILM_TONE_H

#include "engine/render/stages/shade/group.h"
#include "engine/render/stages/simd/elementary.h"

/// Looks up a value, with one comparison; x in 0 .. 1.
static inline vi tone_look_up(const uint32_t *table, vf x)
{
    const vi lowest = i_set(GLINT_TONE_FIRST << 16);
    fm dark = i_lt(f_bits(x), lowest);
    vi bits = f_bits(f_select(dark, f_from_bits(lowest), x));
    vi entry = i_gather(table, i_sub(i_shr(bits, 16), i_set(GLINT_TONE_FIRST)));
    fm below = i_lt(i_and(bits, i_set(0xffff)), i_shr(entry, 8));
    vi code = i_and(entry, i_set(255));
    code = f_bits(f_select(below, f_from_bits(code), f_from_bits(i_add(code, i_set(1)))));
    return f_bits(f_select(dark, f_set(0), f_from_bits(code)));
}

static inline vi tone_exact(const uint32_t *table, const vf x[3])
{
    vi rgb = tone_look_up(table, x[0]);
    rgb = i_or(rgb, i_shl(tone_look_up(table, x[1]), 8));
    return i_or(rgb, i_shl(tone_look_up(table, x[2]), 16));
}

/// The fit in registers. `table`: true: all values are looked up, because there is no fit or no instruction for it.
typedef struct tone_fit {
    bool table;
#ifdef f_by_exponent
    vf knee, slope, base, scale[F_EXPONENTS / VF], power[6], offset;
    vi doubt;
#endif
} tone_fit;

#ifdef f_by_exponent
static inline tone_fit tone_load_fit(const glint_tone_fit *fit)
{
    tone_fit f = { .table = !fit };
    if (!fit)
        return f;
    f.knee = f_set(fit->knee), f.slope = f_set(fit->slope), f.base = f_set(fit->base), f.offset = f_set(fit->offset);
    for (int i = 0; i < 6; i++)
        f.power[i] = f_set(fit->power[i]);
    for (int i = 0; i < F_EXPONENTS; i += VF)
        f.scale[i / VF] = f_load_any(fit->scale + i);
    f.doubt = i_set(fit->doubt);
    return f;
}

static inline vi tone_estimate(const tone_fit *fit, vf x)
{
    const vf *p = fit->power;
    const vf m = f_mantissa(x);
    vf v = f_fma(f_fma(f_fma(f_fma(f_fma(p[5], m, p[4]), m, p[3]), m, p[2]), m, p[1]), m, p[0]);
    v = f_fma(v, f_by_exponent(fit->scale, x), fit->offset);
    return f_bits(f_select(f_lt(x, fit->knee), f_fma(x, fit->slope, fit->base), v));
}

static inline vi tone_codes(const uint32_t *table, const tone_fit *fit, const vf x[3])
{
    if (fit->table)
        return tone_exact(table, x);
    const vi fraction = i_set(0x7fff);
    vi r = tone_estimate(fit, x[0]), g = tone_estimate(fit, x[1]), b = tone_estimate(fit, x[2]);
    vi least = i_min(i_min(i_and(r, fraction), i_and(g, fraction)), i_and(b, fraction));
    if (fm_bits(i_lt(least, fit->doubt)))
        return tone_exact(table, x);
    return i_merge(i_set(0xffff), i_merge(i_set(0xff), i_shr(r, 15), i_shr(g, 7)), i_shl(b, 1));
}
#else
static inline tone_fit tone_load_fit(const glint_tone_fit *fit)
{
    (void)fit;
    return (tone_fit) { true };
}

static inline vi tone_codes(const uint32_t *table, const tone_fit *fit, const vf x[3])
{
    (void)fit;
    return tone_exact(table, x);
}
#endif

/// Clamps three vectors that are not all in 0 .. top, and counts their clipped and non-finite pixels. active: mask of
/// these vectors' lanes; beauty: the light before exposure.
static inline void tone_clamp(const glint_tone_args *args, const vf beauty[3], vf x[3], unsigned active)
{
    const vf zero = f_set(0), infinity = f_set(HUGE_VALF), white = f_set(args->white), top = f_set(args->top);
    fm over = f_lt(infinity, zero), sound = f_lt(zero, infinity);
    for (int c = 0; c < 3; c++) {
        over = fm_or(over, f_lt(white, x[c]));
        sound = fm_and(sound, f_lt(f_abs(beauty[c]), infinity));
        x[c] = f_min(f_max(x[c], zero), top);
    }
    *args->clipped += (unsigned)__builtin_popcount(fm_bits(over) & active);
    *args->nonfinite += (unsigned)__builtin_popcount(~fm_bits(sound) & active);
}

/// Returns whether any lane is negative (or -0), above top, or NaN. The bits of such a float, as an unsigned number,
/// are above the bits of top.
static inline bool tone_is_outside(const vf x[3], vf top)
{
    return fm_bits(i_any_above(f_bits(x[0]), f_bits(x[1]), f_bits(x[2]), f_bits(top))) != 0;
}

static void tone_store_some(uint8_t *to, size_t stride, vi rgb, unsigned active)
{
    _Alignas(64) uint32_t word[VF];
    i_store(word, rgb);
    for (size_t i = 0; i < VF; i++)
        for (size_t c = 0; c < 3; c++)
            if (active >> i & 1)
                to[i / 4 * stride + i % 4 * 3 + c] = (uint8_t)(word[i] >> 8 * c);
}

static inline bool tone_is_same(const vf a[3], const vf b[3])
{
    return fm_bits(fm_and(fm_and(f_eq(a[0], b[0]), f_eq(a[1], b[1])), f_eq(a[2], b[2]))) == (1u << VF) - 1;
}

/// Converts all groups. Consecutive groups with the same light, as in backgrounds and uniform shadows, reuse the
/// previous values.
static inline void tone_groups(const glint_tone_args *args, bool exposed)
{
    const vf gain = f_set(args->gain), top = f_set(args->top);
    const unsigned all = (1u << VF) - 1;
    const tone_fit fit = tone_load_fit(args->fit);
    uint32_t column = 0;
    uint8_t *codes = args->codes;
    vf seen[3] = { f_set(NAN), f_set(NAN), f_set(NAN) }; // NaN: never reuses clamped vectors, because each of them
        // must be counted
    vi rgb = i_set(0);
    for (uint32_t g = 0; g < args->group_count; g++) {
        const bool last = ++column == args->groups_across;
        const bool spill = !last && args->active[g + 1] == 0xffff; // the next group overwrites the spill
        for (int i = 0; i < GLINT_GROUP && args->active[g]; i += VF) {
            const unsigned active = args->active[g] >> i & all;
            vf beauty[3], x[3];
            for (int c = 0; c < 3; c++) {
                x[c] = beauty[c] = f_load(args->beauty[c] + (size_t)g * GLINT_GROUP + i);
                if (exposed)
                    x[c] = gain * beauty[c];
            }
            if (!tone_is_same(x, seen)) {
                for (int c = 0; c < 3; c++)
                    seen[c] = x[c];
                if (tone_is_outside(x, top)) {
                    seen[0] = f_set(NAN);
                    tone_clamp(args, beauty, x, active);
                }
                rgb = tone_codes(args->table, &fit, x);
            }
            if (active == all)
                i_store_rgb(codes + (size_t)(i / 4) * args->stride, args->stride, rgb, spill);
            else
                tone_store_some(codes + (size_t)(i / 4) * args->stride, args->stride, rgb, active);
        }
        codes += last ? 4 * args->stride - 12 * (size_t)(args->groups_across - 1) : 12;
        column = last ? 0 : column;
    }
}

/// Compiles one copy of the kernel for each constant.
static void tone(const glint_tone_args *args)
{
    if (args->gain != 1)
        tone_groups(args, true);
    else
        tone_groups(args, false);
}

#endif
