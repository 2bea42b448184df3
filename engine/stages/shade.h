// shade: the terms of each sample. A group is worked off material by material, so that colours and exponents are the
// same in every lane. Lights are added in their order, in double. Contract: stages.h.

typedef struct shade_group {
    _Alignas(64) double sum[GLINT_TERM_COUNT][3][GLINT_GROUP];
    _Alignas(64) float diffuse[GLINT_GROUP], specular[GLINT_GROUP]; ///< of one light, without colours
} shade_group;

static inline dm lane_mask(unsigned lanes, int i) { return dm_from_bits(lanes >> i & ((1u << VD) - 1)); }

/// sum += value in the lanes given.
static inline void add_constant(double sum[3][GLINT_GROUP], const double value[3], unsigned lanes)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VD) {
            vd old = d_load(sum[c] + i);
            d_store(sum[c] + i, d_select(lane_mask(lanes, i), old + d_set(value[c]), old));
        }
}

/// sum += factor * (reflectance strength) in the lanes given.
static inline void add_light(double sum[3][GLINT_GROUP], const float *factor, const double reflectance[3],
                             const double strength[3], unsigned lanes)
{
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        const dm mask = lane_mask(lanes, i);
        const vd f = d_load_f(factor + i);
        for (int c = 0; c < 3; c++) {
            vd old = d_load(sum[c] + i);
            d_store(sum[c] + i, d_select(mask, old + f * d_set(reflectance[c] * strength[c]), old));
        }
    }
}

/// One light's geometric factors for a group: w (n.l), and w S for a material with a highlight.
static inline void light_factors(const glint_shade_light *light, const glint_shade_material *material, bool specular,
                                 size_t at, shade_group *group)
{
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf w = f_set(1);
        if (light->attenuation)
            w = w * f_load(light->attenuation + at + i);
        if (light->visible)
            w = w * f_load(light->visible + at + i);
        f_store(group->diffuse + i, w * f_load(light->cosine + at + i));
        if (specular) {
            vf log2 = f_load(light->log2_specular + at + i);
            vf s = w * f_exp2(f_set(material->shininess) * log2);
            f_store(group->specular + i, f_select(f_lt(f_set(GLINT_NO_SPECULAR), log2), s, f_set(0)));
        }
    }
}

static inline void shade_material(const glint_shade_args *args, uint32_t g, uint32_t index, unsigned lanes,
                                  shade_group *group)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    const glint_shade_material *material = &args->materials[index];
    const bool specular = args->has_specular && material->has_specular;
    if (args->first)
        add_constant(group->sum[GLINT_TERM_AMBIENT], material->ambient, lanes);
    for (uint32_t k = 0; k < args->light_count; k++) {
        const glint_shade_light *light = &args->lights[k];
        const unsigned lit = lanes & light->lit[g];
        if (!lit)
            continue;
        light_factors(light, material, specular, at, group);
        add_light(group->sum[GLINT_TERM_DIFFUSE], group->diffuse, material->diffuse, light->diffuse, lit);
        if (specular)
            add_light(group->sum[GLINT_TERM_SPECULAR], group->specular, material->specular, light->specular, lit);
    }
}

/// Rounds a group's terms to float, keeps those asked for, and adds them up.
static inline void resolve_group(double *sum[][3], vd samples, float *const film[][3],
                                 float *const beauty[3], size_t at)
{
    _Alignas(64) float term[GLINT_TERM_COUNT][GLINT_GROUP];
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < GLINT_TERM_COUNT; k++)
            for (int i = 0; i < GLINT_GROUP; i += VD)
                d_store_f(term[k] + i, d_load(sum[k][c] + i) / samples);
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            vf t[GLINT_TERM_COUNT];
            for (int k = 0; k < GLINT_TERM_COUNT; k++) {
                t[k] = f_load(term[k] + i);
                if (film[k][c])
                    f_store(film[k][c] + at + i, t[k]);
            }
            f_store(beauty[c] + at + i, ((t[0] + t[1]) + t[2]) + t[3]);
        }
    }
}

static void shade(const glint_shade_args *args)
{
    shade_group group;
    const bool direct = !args->sum[0][0];
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        for (int k = 0; k < GLINT_TERM_COUNT; k++)
            for (int c = 0; c < 3; c++)
                for (int i = 0; i < GLINT_GROUP; i += VD)
                    d_store(group.sum[k][c] + i, direct ? d_set(0) : d_load(args->sum[k][c] + at + i));
        unsigned left = args->hits[g];
        if (args->first)
            add_constant(group.sum[GLINT_TERM_BACKGROUND], args->background, args->active[g] & ~left);
        while (left) {
            const uint32_t index = args->material[at + (unsigned)__builtin_ctz(left)];
            unsigned lanes = 0;
            for (int i = 0; i < GLINT_GROUP; i += VF)
                lanes |= fm_bits(i_eq(i_load(args->material + at + i), i_set(index))) << i;
            lanes &= left;
            left &= ~lanes;
            shade_material(args, g, index, lanes, &group);
        }
        double *sum[GLINT_TERM_COUNT][3];
        for (int k = 0; k < GLINT_TERM_COUNT; k++)
            for (int c = 0; c < 3; c++) {
                sum[k][c] = group.sum[k][c];
                if (!direct)
                    for (int i = 0; i < GLINT_GROUP; i += VD)
                        d_store(args->sum[k][c] + at + i, d_load(sum[k][c] + i));
            }
        if (direct)
            resolve_group(sum, d_set(1), args->film, args->beauty, at);
    }
}
