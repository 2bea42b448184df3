// tone: float light to 8-bit codes by one look-up and one comparison, exact for every float. Contract: stages.h.

static void tone(const glint_tone_args *args)
{
    const vf zero = f_set(0), one = f_set(1), infinity = f_set(HUGE_VALF);
    const vi lowest = i_set(GLINT_TONE_FIRST << 16);
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        unsigned above = 0, finite = 0;
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            vi rgb = i_set(0);
            fm over = f_lt(one, zero), sound = f_lt(zero, one);
            for (int c = 0; c < 3; c++) {
                vf x = f_load(args->beauty[c] + at + i);
                over = fm_or(over, f_lt(one, x));
                sound = fm_and(sound, f_lt(f_abs(x), infinity));
                vi bits = f_bits(f_min(f_max(x, zero), one));
                fm dark = i_lt(bits, lowest);
                bits = f_bits(f_select(dark, f_from_bits(lowest), f_from_bits(bits)));
                vi entry = i_gather(args->table, i_sub(i_shr(bits, 16), i_set(GLINT_TONE_FIRST)));
                fm below = i_lt(i_and(bits, i_set(0xffff)), i_shr(entry, 8));
                vi code = i_and(entry, i_set(255));
                code = f_bits(f_select(below, f_from_bits(code), f_from_bits(i_add(code, i_set(1)))));
                code = f_bits(f_select(dark, zero, f_from_bits(code)));
                rgb = i_or(rgb, c == 0 ? code : c == 1 ? i_shl(code, 8) : i_shl(code, 16));
            }
            i_store(args->rgb + at + i, rgb);
            above |= fm_bits(over) << i;
            finite |= fm_bits(sound) << i;
        }
        *args->clipped += (unsigned)__builtin_popcount(above & args->active[g]);
        *args->nonfinite += (unsigned)__builtin_popcount(~finite & args->active[g]);
    }
}
