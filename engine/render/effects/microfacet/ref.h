// The reference of view and facet, for one type of real; included by ref.c after ref/real.h.

static void NAME(view)(const glint_view_args *args)
{
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++) {
        if (!args->hits[i / GLINT_GROUP])
            continue;
        NAME(vec3) direction = NAME(direction_of)(args->camera, args->direction, i);
        float q = (float)NAME(length2)(direction);
        float m = (float)-NAME(dot)(NAME(load)(args->normal, i), direction);
        args->facing[i] = min_float(max_float(m / sqrtf(q), 0), 1);
    }
}

/// Returns whether the group has a lit lane with microfacets.
static bool NAME(facet_group)(const glint_facet_args *args, uint32_t s, uint32_t group)
{
    for (uint32_t lane = 0; lane < GLINT_GROUP; lane++)
        if (args->lit[s][group] >> lane & 1 &&
            args->materials[args->material[group * GLINT_GROUP + lane]].highlight == GLINT_HIGHLIGHT_FACETS)
            return true;
    return false;
}

static void NAME(facet_sample)(const glint_facet_args *args, uint32_t s, uint32_t i)
{
    const glint_light_sample *light_sample = args->light_sample[s];
    NAME(vec3) l = light_sample ? NAME(lane_of)(light_sample->position, i) : NAME(rounded)(args->position);
    if (NAME(is_cone)(light_sample))
        l = NAME(rounded)(NAME(in_own_cone)(light_sample, args->scale, args->point, args->normal, i).direction);
    else if (!args->directional)
        l = NAME(times)(NAME(sub)(l, NAME(load)(args->point, i)), (REAL)args->scale);
    NAME(vec3) n = NAME(load)(args->normal, i), d = NAME(direction_of)(args->camera, args->direction, i);
    REAL p = NAME(square_root)(NAME(length2)(l)), r = NAME(square_root)(NAME(length2)(d)), w = p * r;
    NAME(vec3) h = NAME(sub)(NAME(times)(l, r), NAME(times)(d, p));
    NAME(vec3) k = NAME(vec)(n.y * h.z - n.z * h.y, n.z * h.x - n.x * h.z, n.x * h.y - n.y * h.x);
    REAL h2 = NAME(length2)(h);
    args->sine2[s][i] = GLINT_NO_SPECULAR;
    args->schlick[s][i] = 0;
    if (!(args->lit[s][i / GLINT_GROUP] >> i % GLINT_GROUP & 1) || !(h2 > 0))
        return;
    args->sine2[s][i] = (float)NAME(min)(NAME(length2)(k) / h2, 1);
    float z = (float)NAME(max)(NAME(min)((w - NAME(dot)(l, d)) / (2 * w), 1), 0);
    float m = 1 - sqrtf(z);
    args->schlick[s][i] = ((m * m) * (m * m)) * m;
}

static void NAME(facet)(const glint_facet_args *args)
{
    for (uint32_t s = 0; s < args->sample_count; s++)
        for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
            if (NAME(facet_group)(args, s, i / GLINT_GROUP))
                NAME(facet_sample)(args, s, i);
}
