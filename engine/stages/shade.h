// shade: the terms of each sample. A group is worked off material by material, so that colours and exponents are the
// same in every lane. Lights are added in their order, in double. Contract: stages.h.

/// The geometric factors of the lights that reach a group: w (n.l), and w S for one material's exponent. Lanes that a
/// light does not reach have 0.
typedef struct light_factors {
    _Alignas(64) float diffuse[GLINT_LIGHT_CHUNK][GLINT_GROUP], specular[GLINT_LIGHT_CHUNK][GLINT_GROUP];
    const glint_shade_light *light[GLINT_LIGHT_CHUNK];
    uint32_t count;
} light_factors;

static inline void find_factors(const glint_shade_args *args, const glint_shade_material *material, bool specular,
                                uint32_t g, light_factors *factors)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    factors->count = 0;
    for (uint32_t k = 0; k < args->light_count; k++) {
        const glint_shade_light *light = &args->lights[k];
        const unsigned lit = light->lit[g];
        if (!lit)
            continue;
        float *diffuse = factors->diffuse[factors->count], *highlight = factors->specular[factors->count];
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            vf w = f_set(1);
            if (light->attenuation)
                w = w * f_load(light->attenuation + at + i);
            const fm mask = fm_from_bits(lit >> i & ((1u << VF) - 1));
            f_store(diffuse + i, f_select(mask, w * f_load(light->cosine + at + i), f_set(0)));
            if (specular) {
                vf log2 = f_load(light->log2_specular + at + i);
                vf s = w * f_exp2(f_set(material->shininess) * log2);
                const fm shiny = fm_and(mask, f_lt(f_set(GLINT_NO_SPECULAR), log2));
                f_store(highlight + i, f_select(shiny, s, f_set(0)));
            }
        }
        factors->light[factors->count++] = light;
    }
}

/// Adds the lights to one vector of lanes.
static inline void add_lights(const light_factors *factors, const glint_shade_material *material, bool specular, int i,
                              vd diffuse[3], vd highlight[3])
{
    for (uint32_t k = 0; k < factors->count; k++) {
        const glint_shade_light *light = factors->light[k];
        const vd fd = d_load_f(factors->diffuse[k] + i);
        for (int c = 0; c < 3; c++)
            diffuse[c] = diffuse[c] + fd * d_set(material->diffuse[c] * light->diffuse[c]);
        if (!specular)
            continue;
        const vd fs = d_load_f(factors->specular[k] + i);
        for (int c = 0; c < 3; c++)
            highlight[c] = highlight[c] + fs * d_set(material->specular[c] * light->specular[c]);
    }
}

/// A group's terms in float, before they are added up.
typedef struct group_terms {
    _Alignas(64) float term[GLINT_TERM_COUNT][3][GLINT_GROUP];
} group_terms;

/// Writes `x` where the mask is set.
static inline void put_float(float *to, fm mask, vf x) { f_store(to, f_select(mask, x, f_load(to))); }

/// One material's lanes of a group whose terms are final: no sums in memory.
static inline void shade_direct(const glint_shade_material *material, bool specular, const light_factors *factors,
                                unsigned lanes, group_terms *terms)
{
    _Alignas(64) float light[2][3][GLINT_GROUP];
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        vd diffuse[3] = { d_set(0), d_set(0), d_set(0) }, highlight[3] = { d_set(0), d_set(0), d_set(0) };
        add_lights(factors, material, specular, i, diffuse, highlight);
        for (int c = 0; c < 3; c++) {
            d_store_f(light[0][c] + i, diffuse[c]);
            d_store_f(light[1][c] + i, highlight[c]);
        }
    }
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(lanes >> i & ((1u << VF) - 1));
        for (int c = 0; c < 3; c++) {
            put_float(terms->term[GLINT_TERM_AMBIENT][c] + i, mask, f_set((float)material->ambient[c]));
            put_float(terms->term[GLINT_TERM_DIFFUSE][c] + i, mask, f_load(light[0][c] + i));
            put_float(terms->term[GLINT_TERM_SPECULAR][c] + i, mask, f_load(light[1][c] + i));
        }
    }
}

static inline dm lane_mask(unsigned lanes, int i) { return dm_from_bits(lanes >> i & ((1u << VD) - 1)); }

static inline void add_where(double *to, dm mask, vd x)
{
    vd old = d_load(to);
    d_store(to, d_select(mask, old + x, old));
}

/// One material's lanes of a group, added to sums over samples and lights.
static inline void shade_sums(const glint_shade_args *args, const glint_shade_material *material, bool specular,
                              const light_factors *factors, size_t at, unsigned lanes)
{
    const int kinds = specular ? 2 : 1;
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        const dm mask = lane_mask(lanes, i);
        vd old[2][3], sum[2][3];
        for (int c = 0; c < 3; c++) {
            if (args->first)
                add_where(args->sum[GLINT_TERM_AMBIENT][c] + at + i, mask, d_set(material->ambient[c]));
            for (int k = 0; k < kinds; k++)
                old[k][c] = sum[k][c] = d_load(args->sum[GLINT_TERM_DIFFUSE + k][c] + at + i);
        }
        add_lights(factors, material, specular, i, sum[0], sum[1]);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < kinds; k++)
                d_store(args->sum[GLINT_TERM_DIFFUSE + k][c] + at + i, d_select(mask, sum[k][c], old[k][c]));
    }
}

/// Keeps the terms asked for and adds them up.
static inline void finish_terms(const group_terms *terms, float *const film[][3], float *const beauty[3], size_t at)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            vf t[GLINT_TERM_COUNT];
            for (int k = 0; k < GLINT_TERM_COUNT; k++) {
                t[k] = f_load(terms->term[k][c] + i);
                if (film[k][c])
                    f_store(film[k][c] + at + i, t[k]);
            }
            f_store(beauty[c] + at + i, ((t[0] + t[1]) + t[2]) + t[3]);
        }
}

/// What no surface makes: the background where nothing is hit, and 0 for the rest.
static inline void start_direct(const glint_shade_args *args, uint32_t g, group_terms *terms)
{
    const unsigned empty = args->active[g] & ~(unsigned)args->hits[g];
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(empty >> i & ((1u << VF) - 1));
        for (int c = 0; c < 3; c++) {
            f_store(terms->term[GLINT_TERM_BACKGROUND][c] + i,
                    f_select(mask, f_set((float)args->background[c]), f_set(0)));
            for (int k = GLINT_TERM_AMBIENT; k < GLINT_TERM_COUNT; k++)
                f_store(terms->term[k][c] + i, f_set(0));
        }
    }
}

static inline void shade_groups(const glint_shade_args *args, bool direct)
{
    light_factors factors;
    group_terms terms;
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        unsigned left = args->hits[g];
        if (direct)
            start_direct(args, g, &terms);
        else if (args->first)
            for (int c = 0; c < 3; c++)
                for (int i = 0; i < GLINT_GROUP; i += VD)
                    add_where(args->sum[GLINT_TERM_BACKGROUND][c] + at + i, lane_mask(args->active[g] & ~left, i),
                              d_set(args->background[c]));
        while (left) {
            const uint32_t index = args->material[at + (unsigned)__builtin_ctz(left)];
            const glint_shade_material *material = &args->materials[index];
            const bool specular = args->has_specular && material->has_specular;
            const unsigned lanes = lanes_equal(args->material + at, index) & left;
            left &= ~lanes;
            find_factors(args, material, specular, g, &factors);
            if (direct)
                shade_direct(material, specular, &factors, lanes, &terms);
            else
                shade_sums(args, material, specular, &factors, at, lanes);
        }
        if (direct)
            finish_terms(&terms, args->film, args->beauty, at);
    }
}

/// Each way is compiled for its constant.
static void shade(const glint_shade_args *args)
{
    if (args->sum[0][0])
        shade_groups(args, false);
    else
        shade_groups(args, true);
}
