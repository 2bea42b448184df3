// The reference of sky.

static void sky(const glint_sky_args *args)
{
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        for (int c = 0; c < 3 && args->missed[i / GLINT_GROUP] >> i % GLINT_GROUP & 1; c++)
            args->sum[c][i] += args->weight[c][i] * args->background[c];
}
