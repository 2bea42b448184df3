// resolve: the mean of several samples. Contract: stages.h.

static void resolve(const glint_resolve_args *args)
{
    const vd samples = d_set(args->samples);
    group_terms terms;
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        for (int k = 0; k < GLINT_TERM_COUNT; k++)
            for (int c = 0; c < 3; c++)
                for (int i = 0; i < GLINT_GROUP; i += VD)
                    d_store_f(terms.term[k][c] + i, d_load(args->sum[k][c] + at + i) / samples);
        finish_terms(&terms, args->film, args->beauty, at);
    }
}
