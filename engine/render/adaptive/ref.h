// The reference of estimate and differ, one number or one pair at a time.

static void estimate(const glint_estimate_args *args)
{
    for (uint32_t i = 0; i < args->count; i++) {
        const float x = min_float(max_float(args->gain * args->light[i], 0), 1);
        const float second = sqrtf(x), fourth = sqrtf(second), eighth = sqrtf(fourth);
        const float dark = (float)(65535 * 12.92) * x;
        const float bright = (((float)(65535 * 0.5723742167) * second + (float)(65535 * 0.8301947475) * fourth) -
                              (float)(65535 * 0.4193434603) * eighth) +
                             (float)(65535 * 0.01599656894);
        args->code[i] = dark <= (float)(65535 * 12.92 * 0.0031308) ? dark : bright;
    }
}

/// Compares pixel i of one line and pixel k of another, and stores the result in bit `bit`.
static void differ_pair(const glint_differ_args *args, const float *const *p, uint32_t i, const float *const *q, uint32_t k,
                        uint32_t bit, uint32_t *sure, uint32_t *undecided)
{
    const float *const *n = p + GLINT_DIFFER_NORMAL, *const *m = q + GLINT_DIFFER_NORMAL;
    const float cosine = (n[0][i] * m[0][k] + n[1][i] * m[1][k]) + n[2][i] * m[2][k];
    float sum = 0;
    for (int c = 0; c < (args->alpha ? 4 : 3); c++) {
        const float apart = fabsf(p[GLINT_DIFFER_CODE + c][i] - q[GLINT_DIFFER_CODE + c][k]);
        sum = c ? sum + apart : apart;
    }
    const bool other = p[GLINT_DIFFER_ID][i] != q[GLINT_DIFFER_ID][k];
    if (other || (p[GLINT_DIFFER_ID][i] > 0 && cosine < args->cosine) || sum > args->high)
        *sure |= 1u << bit;
    if (sum > args->low)
        *undecided |= 1u << bit;
}

static void differ(const glint_differ_args *args, glint_differences *out)
{
    *out = (glint_differences) { .sure = { 0 } };
    for (uint32_t i = 0; i < args->ahead && args->along; i++)
        differ_pair(args, args->p, i, args->p, i + 1, i, &out->sure[GLINT_DIFFER_ALONG],
                    &out->undecided[GLINT_DIFFER_ALONG]);
    for (uint32_t i = 0; i < args->count && args->q; i++)
        differ_pair(args, args->p, i, args->q, i, i, &out->sure[GLINT_DIFFER_ACROSS],
                    &out->undecided[GLINT_DIFFER_ACROSS]);
    for (uint32_t i = 0; i < args->ahead && args->q; i++) {
        differ_pair(args, args->p, i, args->q, i + 1, i, &out->sure[GLINT_DIFFER_FALLING],
                    &out->undecided[GLINT_DIFFER_FALLING]);
        differ_pair(args, args->p, i + 1, args->q, i, i, &out->sure[GLINT_DIFFER_RISING],
                    &out->undecided[GLINT_DIFFER_RISING]);
    }
}
