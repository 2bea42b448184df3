// The reference of scatter, for one type of real; included by ref.c after ref/real.h.

/// Computes sin and cos of `quarters` times pi / 2, for quarters in 0 .. 4.
static void NAME(turn)(REAL quarters, REAL *sine, REAL *cosine)
{
    REAL nearest = (quarters + (REAL)ROUNDER) - (REAL)ROUNDER;
    REAL f = (quarters - nearest) * (REAL)GLINT_HALF_PI, z = f * f;
    REAL sp = (REAL)GLINT_SIN_4;
    sp = (REAL)GLINT_SIN_3 + z * sp;
    sp = (REAL)GLINT_SIN_2 + z * sp;
    sp = (REAL)GLINT_SIN_1 + z * sp;
    REAL cp = (REAL)GLINT_COS_5;
    cp = (REAL)GLINT_COS_4 + z * cp;
    cp = (REAL)GLINT_COS_3 + z * cp;
    cp = (REAL)GLINT_COS_2 + z * cp;
    cp = (REAL)GLINT_COS_1 + z * cp;
    REAL s = f + (f * z) * sp, c = 1 + z * cp;
    *cosine = nearest == 1 ? 0 - s : nearest == 2 ? 0 - c : nearest == 3 ? s : c;
    *sine = nearest == 1 ? c : nearest == 2 ? 0 - s : nearest == 3 ? 0 - c : s;
}

/// Computes two tangents to a normal (T. Duff et al., JCGT 6(1), 2017).
static void NAME(tangents_of)(NAME(vec3) n, NAME(vec3) *tangent, NAME(vec3) *bitangent)
{
    REAL g = n.z >= 0 ? 1 : -1, p = -1 / (g + n.z), q = (n.x * n.y) * p;
    *tangent = NAME(vec)(1 + g * ((n.x * n.x) * p), g * q, 0 - g * n.x);
    *bitangent = NAME(vec)(q, g + (n.y * n.y) * p, 0 - n.y);
}

static void NAME(scatter_sample)(const glint_scatter_args *args, uint32_t i)
{
    double square[2];
    const glint_sequence_seed seed = { args->order[i], { args->digits[0][i], args->digits[1][i] } };
    glint_sequence_flipped(args->number[i] + args->further, &seed, square);
    REAL u = (REAL)square[0], v = (REAL)square[1], sine, cosine;
    NAME(vec3) n = NAME(load)(args->normal, i);
    NAME(turn)(4 * v, &sine, &cosine);
    REAL r = NAME(square_root)(u), h = NAME(square_root)(NAME(max)(1 - u, 0)), x = r * cosine, y = r * sine;
    NAME(vec3) tangent, bitangent;
    NAME(tangents_of)(n, &tangent, &bitangent);
    ((REAL *)args->direction[0])[i] = (x * tangent.x + y * bitangent.x) + h * n.x;
    ((REAL *)args->direction[1])[i] = (x * tangent.y + y * bitangent.y) + h * n.y;
    ((REAL *)args->direction[2])[i] = (x * tangent.z + y * bitangent.z) + h * n.z;
}

static void NAME(scatter)(const glint_scatter_args *args)
{
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        if (args->wanted[i / GLINT_GROUP])
            NAME(scatter_sample)(args, i);
}
