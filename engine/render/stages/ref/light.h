// The reference of the light stage, and of lit surfaces: included by ref/real.h for each type of real.

/// Returns log2 of r.v (Phong) or n.h (Blinn-Phong).
static float NAME(highlight)(uint32_t kind, REAL least, REAL l2, REAL nl, NAME(vec3) l, NAME(vec3) normal,
                             NAME(vec3) direction)
{
    REAL a = NAME(length2)(direction);
    REAL x;
    if (kind == GLINT_HIGHLIGHT_PHONG) {
        REAL nv = -NAME(dot)(normal, direction);
        REAL lv = -NAME(dot)(l, direction);
        REAL rv = (2 * nl) * nv - lv;
        x = rv > 0 && !(rv * rv < least * (l2 * a)) ? NAME(min)((rv * rv) / (l2 * a), 1) : 0;
    } else {
        REAL w = NAME(square_root)(l2 * a);
        NAME(vec3) h = NAME(sub)(NAME(times)(l, a), NAME(times)(direction, w));
        REAL nh = NAME(dot)(normal, h), num = nh * nh, den = NAME(length2)(h);
        x = nh > 0 && den > 0 && !(num < least * den) ? NAME(min)(num / den, 1) : 0;
    }
    return x >= (REAL)0x1p-126 ? 0.5f * log2_of((float)x, (float)(x - 1)) : GLINT_NO_SPECULAR;
}

/// Returns lane i of three arrays of 16 doubles.
static NAME(vec3) NAME(lane_of)(const double array[3][GLINT_GROUP], uint32_t i)
{
    uint32_t lane = i % GLINT_GROUP;
    return NAME(vec)((REAL)array[0][lane], (REAL)array[1][lane], (REAL)array[2][lane]);
}

static bool NAME(is_cone)(const glint_light_sample *light_sample)
{
    return light_sample && light_sample->emission == GLINT_EMIT_CONE;
}

/// Returns the position for lane i in the cone in which the lane's point sees the ball.
static glint_cone_sample NAME(in_own_cone)(const glint_light_sample *light_sample, double scale,
                                           const void *const point[3], const void *const normal[3], uint32_t i)
{
    NAME(vec3) p = NAME(load)(point, i), n = NAME(load)(normal, i);
    const double at[3] = { p.x, p.y, p.z }, along[3] = { n.x, n.y, n.z };
    double slack = sizeof(REAL) == sizeof(double) ? GLINT_CONE_SLACK_DOUBLE : GLINT_CONE_SLACK_FLOAT;
    return glint_cone_at(light_sample, scale, slack, at, along, i % GLINT_GROUP);
}

static NAME(vec3) NAME(to_light)(const glint_light_args *args, uint32_t s, uint32_t i)
{
    const glint_light_sample *light_sample = args->light_sample[s];
    const double *center = args->positions[0] ? args->positions[s] : args->position;
    if (NAME(is_cone)(light_sample)) {
        glint_cone_sample sample = NAME(in_own_cone)(light_sample, args->scale, args->point, args->normal, i);
        return NAME(rounded)(sample.direction);
    }
    NAME(vec3) position = light_sample ? NAME(lane_of)(light_sample->position, i) : NAME(rounded)(center);
    return args->directional ? position
                             : NAME(times)(NAME(sub)(position, NAME(load)(args->point, i)), (REAL)args->scale);
}

static REAL NAME(spot_cosine)(const glint_spot *spot, NAME(vec3) l)
{
    return NAME(min)(-NAME(dot)(NAME(rounded)(spot->axis), l) / NAME(square_root)(NAME(length2)(l)), 1);
}

static REAL NAME(spot_x)(const glint_spot *spot, REAL c)
{
    return NAME(max)(NAME(min)((c - (REAL)spot->outer) * (REAL)spot->inverse, 1), 0);
}

static bool NAME(in_cone)(const glint_spot *spot, NAME(vec3) l)
{
    REAL c = NAME(spot_cosine)(spot, l);
    return NAME(spot_x)(spot, c) > 0 && (spot->exponent == 0 || c >= (REAL)0x1p-126);
}

static float NAME(cone)(const glint_spot *spot, NAME(vec3) l)
{
    REAL c = NAME(spot_cosine)(spot, l), x = NAME(spot_x)(spot, c);
    float step = (float)((x * x) * (3 - 2 * x));
    if (spot->exponent == 0)
        return step;
    return step * highlight_strength(spot->exponent, log2_of((float)c, (float)(c - 1)));
}

/// Returns the cosine at the light's surface times the distance: positive if the sample emits towards the point.
static REAL NAME(light_sample_cosine)(const glint_light_sample *light_sample, NAME(vec3) l, uint32_t i)
{
    REAL m = -NAME(dot)(NAME(lane_of)(light_sample->normal, i), l);
    return light_sample->emission == GLINT_EMIT_RADIANT_BOTH ? NAME(max)(m, -m) : m;
}

/// Returns whether a sample emits towards the point.
static bool NAME(shines)(const glint_light_sample *light_sample, NAME(vec3) l, uint32_t i)
{
    return !light_sample || light_sample->emission == GLINT_EMIT_ALL || NAME(is_cone)(light_sample) ||
           NAME(light_sample_cosine)(light_sample, l, i) > 0;
}

static bool NAME(is_lit)(const glint_light_args *args, uint32_t s, uint32_t i)
{
    const glint_light_sample *light_sample = args->light_sample[s];
    uint32_t group = i / GLINT_GROUP, lane = i % GLINT_GROUP;
    if (!(args->hits[group] >> lane & 1) || args->dark[group] >> lane & 1)
        return false;
    NAME(vec3) l = NAME(to_light)(args, s, i);
    if (args->spot && !light_sample && !NAME(in_cone)(args->spot, l))
        return false;
    return NAME(shines)(light_sample, l, i) && NAME(dot)(NAME(load)(args->normal, i), l) > 0;
}

static float NAME(attenuation)(const glint_light_args *args, const glint_light_sample *light_sample, NAME(vec3) l,
                               uint32_t i)
{
    NAME(vec3) k = NAME(rounded)(args->coefficients);
    REAL l2 = NAME(length2)(l);
    glint_cone_sample own = { .far = 0 };
    if (NAME(is_cone)(light_sample))
        own = NAME(in_own_cone)(light_sample, args->scale, args->point, args->normal, i);
    REAL d = NAME(is_cone)(light_sample) ? (REAL)own.far : NAME(square_root)(l2) / (REAL)args->scale;
    REAL a = 1 / (k.x + (k.y * d + k.z * (d * d)));
    if (NAME(is_cone)(light_sample)) {
        a = a * (REAL)own.weight;
    } else if (light_sample && light_sample->emission >= GLINT_EMIT_RADIANT_FRONT) {
        REAL m = NAME(light_sample_cosine)(light_sample, l, i);
        a = a * (m / (l2 * NAME(square_root)(l2)));
    }
    float w = min_float((float)a, GLINT_ATTENUATION_MAX);
    return args->spot && !light_sample ? w * NAME(cone)(args->spot, l) : w;
}

static void NAME(light_sample)(const glint_light_args *args, uint32_t s, uint32_t i)
{
    const glint_light_sample *light_sample = args->light_sample[s];
    NAME(vec3) normal = NAME(load)(args->normal, i);
    NAME(vec3) l = NAME(to_light)(args, s, i);
    REAL l2 = NAME(length2)(l), nl = NAME(dot)(normal, l);
    if (args->directional) {
        args->cosine[s][i] = min_float((float)nl, 1);
    } else {
        float q = (float)l2, m = (float)nl;
        args->cosine[s][i] = min_float(m / sqrtf(q), 1);
    }
    if (args->attenuated)
        args->attenuation[s][i] = NAME(attenuation)(args, light_sample, l, i);
    if (args->highlights) {
        const glint_shade_material *material = &args->materials[args->material[i]];
        uint32_t kind = material->highlight;
        REAL least = args->sparing ? (REAL)material->least : 0;
        args->log2_specular[s][i] =
            kind == GLINT_HIGHLIGHT_NONE || kind == GLINT_HIGHLIGHT_FACETS
                ? GLINT_NO_SPECULAR
                : NAME(highlight)(kind, least, l2, nl, l, normal, NAME(direction_of)(args->camera, args->direction, i));
    }
}

static void NAME(light_group)(const glint_light_args *args, uint32_t s, uint32_t group)
{
    uint32_t first = group * GLINT_GROUP, lit = 0;
    for (uint32_t lane = 0; lane < GLINT_GROUP; lane++)
        lit |= (uint32_t)NAME(is_lit)(args, s, first + lane) << lane;
    args->lit[s][group] = (uint16_t)lit;
    for (uint32_t lane = 0; lit && lane < GLINT_GROUP; lane++) {
        uint32_t i = first + lane;
        if (lit >> lane & 1) {
            NAME(light_sample)(args, s, i);
            continue;
        }
        args->cosine[s][i] = 0;
        if (args->attenuated)
            args->attenuation[s][i] = 0;
        if (args->highlights)
            args->log2_specular[s][i] = GLINT_NO_SPECULAR;
    }
}

static float NAME(brightest)(const glint_light_args *args, uint32_t s)
{
    float brightest = GLINT_NO_SPECULAR;
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        if (args->lit[s][i / GLINT_GROUP] && args->log2_specular[s][i] > brightest)
            brightest = args->log2_specular[s][i];
    return brightest;
}

static void NAME(light)(const glint_light_args *args)
{
    for (uint32_t s = 0; s < args->sample_count; s++) {
        for (uint32_t group = 0; group < args->group_count; group++)
            NAME(light_group)(args, s, group);
        if (args->highlights && args->brightest[s])
            *args->brightest[s] = NAME(brightest)(args, s);
    }
}

static void NAME(lit_surface)(const glint_surface_args *surface, const glint_light_args *light)
{
    NAME(surface)(surface);
    NAME(light)(light);
}
