// resolve: the mean of several samples. Contract: stages.h.

static void resolve(const glint_resolve_args *args)
{
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        double *sum[GLINT_TERM_COUNT][3];
        for (int k = 0; k < GLINT_TERM_COUNT; k++)
            for (int c = 0; c < 3; c++)
                sum[k][c] = args->sum[k][c] + at;
        resolve_group(sum, d_set(args->samples), args->film, args->beauty, at);
    }
}
