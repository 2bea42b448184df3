// What camera and cast share about rays. Included once for each precision.

/// unit = (float)direction, normalised, for one group.
static inline void R(unit)(const glint_camera_args *args, size_t at)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VR)
            r_store_f(args->unit[c] + at + i, r_load((const real *)args->direction[c] + at + i));
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf u[3] = { f_load(args->unit[0] + at + i), f_load(args->unit[1] + at + i), f_load(args->unit[2] + at + i) };
        vf inverse = f_set(1) / f_sqrt(DOT(u, u));
        for (int c = 0; c < 3; c++)
            f_store(args->unit[c] + at + i, u[c] * inverse);
    }
}

/// Makes lanes outside the image misses and writes the group's hit mask.
static inline void R(collect_hits)(const glint_cast_args *args, uint32_t g)
{
    real *t = (real *)args->t + (size_t)g * GLINT_GROUP;
    uint32_t *prim = args->prim + (size_t)g * GLINT_GROUP;
    unsigned misses = 0;
    for (int i = 0; i < GLINT_GROUP; i += VR)
        misses |= rm_bits(r_index_eq(r_load_index(prim + i), r_index(GLINT_MISS))) << i;
    for (unsigned outside = ~misses & ~(unsigned)args->active[g] & 0xffff; outside; outside &= outside - 1) {
        int i = __builtin_ctz(outside);
        t[i] = (real)HUGE_VAL;
        prim[i] = GLINT_MISS;
    }
    args->hits[g] = (uint16_t)(~misses & args->active[g]);
}
