// resolve: the mean of several samples. Contract: stages.h.

/// Adds one term that shade does not make.
static inline void resolve_further(const glint_resolve_args *args, int term, size_t at)
{
    const vd samples = d_set(args->samples);
    _Alignas(64) float mean[GLINT_GROUP];
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < GLINT_GROUP; i += VD)
            d_store_f(mean + i, d_load(args->sum[term][c] + at + i) / samples);
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const vf x = f_load(mean + i);
            if (args->film[term][c])
                f_store(args->film[term][c] + at + i, x);
            f_store(args->beauty[c] + at + i, f_load(args->beauty[c] + at + i) + x);
        }
    }
}

static void resolve(const glint_resolve_args *args)
{
    const vd samples = d_set(args->samples);
    group_terms terms;
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        for (int k = 0; k < GLINT_TERM_LOCAL; k++)
            for (int c = 0; c < 3; c++)
                for (int i = 0; i < GLINT_GROUP; i += VD)
                    d_store_f(terms.term[k][c] + i, d_load(args->sum[k][c] + at + i) / samples);
        finish_terms(&terms, args->film, args->beauty, at);
        for (int k = GLINT_TERM_LOCAL; k < GLINT_TERM_COUNT; k++)
            if (args->sum[k][0])
                resolve_further(args, k, at);
    }
}
