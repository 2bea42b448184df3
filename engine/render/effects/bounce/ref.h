// The reference of bounce, for one type of real; included by ref.c after ref/real.h.

/// Returns the reflected share of unpolarised light for a dielectric; here, beyond: cosines of the angles on the
/// ray's side and on the far side.
static REAL NAME(fresnel)(REAL ratio, REAL here, REAL beyond)
{
    REAL across = (ratio * here - beyond) / (ratio * here + beyond);
    REAL along = (here - ratio * beyond) / (here + ratio * beyond);
    return (REAL)0.5 * (across * across + along * along);
}

/// Returns whether the ray is totally reflected.
static bool NAME(bounce_sample)(const glint_bounce_args *args, uint32_t i)
{
    NAME(vec3) d = NAME(direction_of)(args->camera, args->direction, i), n = NAME(load)(args->normal, i);
    NAME(vec3) u = NAME(over)(d, NAME(square_root)(NAME(length2)(d)));
    REAL ratio = ((const REAL *)args->ratio)[i], c = NAME(min)(NAME(max)(-NAME(dot)(n, u), 0), 1);
    REAL k = 1 - (ratio * ratio) * (1 - c * c);
    REAL beyond = ratio == 1 ? c : NAME(square_root)(NAME(max)(k, 0));
    bool total = ratio != 1 && !(k > 0);
    NAME(store)(args->reflected, i, NAME(add)(u, NAME(times)(n, 2 * c)));
    NAME(store)(args->refracted, i, NAME(add)(NAME(times)(u, ratio), NAME(times)(n, ratio * c - beyond)));
    ((REAL *)args->reflectance)[i] = ratio == 1 ? 0 : total ? 1 : NAME(fresnel)(ratio, c, beyond);
    return total;
}

static void NAME(bounce)(const glint_bounce_args *args)
{
    for (uint32_t g = 0; g < args->group_count; g++)
        args->total[g] = 0;
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        if (args->wanted[i / GLINT_GROUP] >> i % GLINT_GROUP & 1 && NAME(bounce_sample)(args, i))
            args->total[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
}
