// bounds: the box around a tile's points. Contract: stages.h.

static void R(bounds)(glint_bounds_args *args)
{
    for (int k = 0; k < 3; k++) {
        vr lower = r_set(HUGE_VAL), upper = r_set(-HUGE_VAL);
        for (uint32_t g = 0; g < args->group_count; g++) {
            if (!args->hits[g])
                continue;
            for (int i = 0; i < GLINT_GROUP; i += VR) {
                const rm hit = rm_from_bits(args->hits[g] >> i & ((1u << VR) - 1));
                vr x = r_load((const real *)args->point[k] + (size_t)g * GLINT_GROUP + i) + r_set(0.0);
                lower = r_select(hit, r_min(x, lower), lower);
                upper = r_select(hit, r_max(x, upper), upper);
            }
        }
        _Alignas(64) real low[VR], high[VR];
        r_store(low, lower);
        r_store(high, upper);
        for (int i = 1; i < VR; i++) {
            low[0] = low[i] < low[0] ? low[i] : low[0];
            high[0] = high[i] > high[0] ? high[i] : high[0];
        }
        args->lower[k] = low[0];
        args->upper[k] = high[0];
    }
}
