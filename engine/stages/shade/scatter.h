// scatter: directions around normals, as dense as their cosine. Contract: stages.h.

/// The point of the unit disk that a point of the unit square stands for: the radius is sqrt(u), the angle 2 pi v.
static inline void R(disk_point)(vr u, vr v, vr *x, vr *y)
{
    const vr zero = r_set(0), one = r_set(1), magic = r_set(GLINT_ROUNDER);
    const vr a = r_set(4) * v, q = (a + magic) - magic, f = (a - q) * r_set(GLINT_HALF_PI), z = f * f;
    const vr s = f + (f * z) * (r_set(GLINT_SIN_1) +
                                z * (r_set(GLINT_SIN_2) + z * (r_set(GLINT_SIN_3) + z * r_set(GLINT_SIN_4))));
    const vr c =
        one +
        z * (r_set(GLINT_COS_1) +
             z * (r_set(GLINT_COS_2) + z * (r_set(GLINT_COS_3) + z * (r_set(GLINT_COS_4) + z * r_set(GLINT_COS_5)))));
    const rm first = r_eq(q, one), second = r_eq(q, r_set(2)), third = r_eq(q, r_set(3)), odd = rm_or(first, third);
    const vr cosine = r_select(odd, s, c), sine = r_select(odd, c, s), radius = r_sqrt(u);
    *x = radius * r_select(rm_or(first, second), zero - cosine, cosine);
    *y = radius * r_select(rm_or(second, third), zero - sine, sine);
}

static inline void R(scatter_lanes)(const glint_scatter_args *args, vr u, vr v, size_t at)
{
    const vr zero = r_set(0), one = r_set(1);
    vr n[3], x, y;
    R(load3)(args->normal, at, n);
    R(disk_point)(u, v, &x, &y);
    const vr h = r_sqrt(r_max(one - u, zero)), g = r_select(r_le(zero, n[2]), one, r_set(-1));
    const vr p = r_set(-1) / (g + n[2]), q = (n[0] * n[1]) * p;
    const vr tangent[3] = { one + g * ((n[0] * n[0]) * p), g * q, zero - g * n[0] };
    const vr bitangent[3] = { q, g + (n[1] * n[1]) * p, zero - n[1] };
    for (int k = 0; k < 3; k++)
        r_store((real *)args->direction[k] + at, (x * tangent[k] + y * bitangent[k]) + h * n[k]);
}

static void R(scatter)(const glint_scatter_args *args)
{
    _Alignas(64) double place[2][GLINT_GROUP];
    _Alignas(64) real square[2][GLINT_GROUP];
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        if (!args->wanted[g])
            continue;
        scrambled_group(args, at, place);
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < GLINT_GROUP; i++)
                square[k][i] = (real)place[k][i];
        for (int i = 0; i < GLINT_GROUP; i += VR)
            R(scatter_lanes)(args, r_load(square[0] + i), r_load(square[1] + i), at + (size_t)i);
    }
}
