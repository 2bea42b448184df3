// planes: materials whose numbers differ from sample to sample, and are read from planes. Contract: stages.h, shade.

/// The product of a plane and a light's colour, as share_color makes it.
static inline vf plane_color(const float *plane, double light)
{
    vd halves[VF / VD];
    f_split(f_load(plane), halves);
    return f_min(f_join(halves[0] * d_set(light), halves[1] * d_set(light)), f_set(FLT_MAX));
}

/// One vector of a factor times its colour; plane NULL: that of the table.
static inline vf plane_product(const float *factor, const float *plane, double constant, double light)
{
    const vf color = plane ? plane_color(plane, constant * light) : f_set(share_color(constant, light));
    return f_load(factor) * color;
}

/// The plane of a material's reflectance in a channel; term 0: diffuse, else specular. NULL: it is the table's.
static inline const float *plane_of(const glint_shade_args *args, const glint_shade_material *material, int term, int c,
                                    size_t at)
{
    const bool has = material->planes & (term ? GLINT_PLANE_SPECULAR : GLINT_PLANE_DIFFUSE);
    return has ? (term ? args->planes->specular : args->planes->diffuse)[c] + at : NULL;
}

/// One light's share of a term in a channel.
static inline void plane_share(const glint_shade_args *args, const glint_shade_material *material,
                               const light_factors *factors, uint32_t k, int term, int c, size_t at,
                               float share[GLINT_GROUP])
{
    const glint_shade_light *light = factors->light[k];
    const bool specular = term > 0;
    const float *plane = plane_of(args, material, term, c, at);
    const double constant = (specular ? material->specular : material->diffuse)[c];
    const double strength = (specular ? light->specular : light->diffuse)[c];
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const float *lanes = plane ? plane + i : NULL;
        vf x = plane_product((specular ? factors->specular : factors->diffuse)[k] + i, lanes, constant, strength);
        if (specular && has_facets(material))
            x = x + plane_product(factors->grazing[k] + i, lanes, material->grazing[c], strength);
        f_store(share + i, x);
    }
}

/// The ambient term of a vector of lanes, in double.
static inline vd plane_ambient(const glint_shade_args *args, const glint_shade_material *material, int c, size_t at)
{
    const glint_shade_planes *planes = args->planes;
    if (material->planes & GLINT_PLANE_AMBIENT_IS_DIFFUSE)
        return d_load_f(planes->diffuse[c] + at) * d_set(planes->ambient_light[c]);
    if (material->planes & GLINT_PLANE_AMBIENT)
        return d_load_f(planes->ambient[c] + at) * d_set(planes->ambient_light[c]);
    return d_set(material->ambient[c]);
}

static inline void find_plane_factors(const glint_shade_args *args, const glint_shade_material *material, bool specular,
                                      uint32_t g, light_factors *factors)
{
    factors->count = 0;
    factors->shiny = 0;
    if (material->planes & GLINT_PLANE_SHADED)
        return;
    if (material->planes & GLINT_PLANE_SHININESS)
        add_factors(args, material, args->planes->shininess + (size_t)g * GLINT_GROUP, specular, g, factors);
    else
        add_factors(args, material, NULL, specular, g, factors);
}

/// As add_material.
static __attribute__((noinline)) void add_planes(const glint_shade_args *args, const glint_shade_material *material,
                                                 bool specular, uint32_t g, const group_sums *to, unsigned lanes)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    _Alignas(64) float share[GLINT_GROUP];
    light_factors factors;
    find_plane_factors(args, material, specular, g, &factors);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; args->first && i < GLINT_GROUP; i += VD)
            add_where(to->sum[GLINT_TERM_AMBIENT][c] + to->at, i, false, lanes,
                      plane_ambient(args, material, c, at + (size_t)i));
        for (int kind = 0; kind < (specular && factors.shiny ? 2 : 1); kind++)
            for (uint32_t k = 0; k < factors.count; k++) {
                plane_share(args, material, &factors, k, kind, c, at, share);
                for (int i = 0; i < GLINT_GROUP; i += VD)
                    add_where(to->sum[GLINT_TERM_DIFFUSE + kind][c] + to->at, i, false, lanes, d_load_f(share + i));
            }
    }
}

/// The sum of all lights' shares of a term, in double, rounded.
static inline void sum_plane_shares(const glint_shade_args *args, const glint_shade_material *material,
                                    const light_factors *factors, int term, int c, size_t at, float sum[GLINT_GROUP])
{
    _Alignas(64) float share[GLINT_GROUP];
    vd total[GLINT_GROUP / VD];
    plane_share(args, material, factors, 0, term, c, at, sum);
    if (factors->count == 1)
        return;
    for (int i = 0; i < GLINT_GROUP; i += VD)
        total[i / VD] = d_load_f(sum + i);
    for (uint32_t k = 1; k < factors->count; k++) {
        plane_share(args, material, factors, k, term, c, at, share);
        for (int i = 0; i < GLINT_GROUP; i += VD)
            total[i / VD] = total[i / VD] + d_load_f(share + i);
    }
    for (int i = 0; i < GLINT_GROUP; i += VD)
        d_store_f(sum + i, total[i / VD]);
}

/// What a term takes from planes in a channel, read once a group: stores may change what pointers lead to.
typedef struct plane_factor {
    const float *plane; ///< NULL: `color` is all
    double number; ///< what the plane is multiplied by
    float color;
} plane_factor;

static inline plane_factor factor_of(const glint_shade_args *args, const glint_shade_material *material, int term, int c,
                                     double light, size_t at)
{
    const double constant = (term ? material->specular : material->diffuse)[c];
    const float *plane = plane_of(args, material, term, c, at);
    return (plane_factor) { plane, constant * light, plane ? 0 : share_color(constant, light) };
}

static inline vf factor_lanes(const plane_factor *factor, int i)
{
    return factor->plane ? plane_color(factor->plane + i, factor->number) : f_set(factor->color);
}

/// As shade_whole.
static __attribute__((noinline)) void whole_planes(const glint_shade_args *args, const glint_shade_material *material,
                                                   bool shines, const light_factors *factors, size_t at)
{
    const glint_shade_light *light = factors->count ? factors->light[0] : NULL;
    const bool follows = material->planes & GLINT_PLANE_AMBIENT_IS_DIFFUSE,
               made = follows || material->planes & GLINT_PLANE_AMBIENT;
    for (int c = 0; c < 3; c++) {
        const float *ambient = made ? (follows ? args->planes->diffuse : args->planes->ambient)[c] + at : NULL;
        const double strength = made ? args->planes->ambient_light[c] : material->ambient[c];
        const plane_factor diffuse = factor_of(args, material, 0, c, light ? light->diffuse[c] : 0, at),
                           specular = factor_of(args, material, 1, c, light ? light->specular[c] : 0, at);
        float *beauty = args->beauty[c] + at;
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            vf sum = made ? f_join(d_load_f(ambient + i) * d_set(strength), d_load_f(ambient + i + VD) * d_set(strength))
                          : f_set((float)strength);
            if (light)
                sum = sum + f_load(factors->diffuse[0] + i) * factor_lanes(&diffuse, i);
            if (light && shines)
                sum = sum + f_load(factors->specular[0] + i) * factor_lanes(&specular, i);
            f_store(beauty + i, sum);
        }
    }
}

/// As shade_direct.
static __attribute__((noinline)) void shade_planes(const glint_shade_args *args, const glint_shade_material *material,
                                                   bool specular, const light_factors *factors, size_t at,
                                                   unsigned lanes, group_terms *terms)
{
    _Alignas(64) float light[2][3][GLINT_GROUP], ambient[GLINT_GROUP];
    const int kinds = factors->count == 0 ? 0 : specular ? 2 : 1;
    for (int k = 0; k < kinds; k++)
        for (int c = 0; c < 3; c++)
            sum_plane_shares(args, material, factors, k, c, at, light[k][c]);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < GLINT_GROUP; i += VD)
            d_store_f(ambient + i, plane_ambient(args, material, c, at + (size_t)i));
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const fm mask = fm_from_bits(lanes >> i & ((1u << VF) - 1));
            put_float(terms->term[GLINT_TERM_AMBIENT][c] + i, mask, f_load(ambient + i));
            for (int k = 0; k < kinds; k++)
                put_float(terms->term[GLINT_TERM_DIFFUSE + k][c] + i, mask, f_load(light[k][c] + i));
        }
    }
}

/// As shade_whole, of a material whose light is in planes.
static __attribute__((noinline)) void whole_shaded(const glint_shade_args *args, const glint_shade_material *material,
                                                   size_t at)
{
    for (int c = 0; c < 3; c++) {
        const float *diffuse = args->planes->shaded[0][c], *specular = args->planes->shaded[1][c];
        for (size_t k = at; k < at + GLINT_GROUP; k += VF) {
            const vf ambient = f_join(plane_ambient(args, material, c, k), plane_ambient(args, material, c, k + VD));
            f_store(args->beauty[c] + k, (ambient + f_load(diffuse + k)) + f_load(specular + k));
        }
    }
}

/// As shade_direct.
static __attribute__((noinline)) void shade_shaded(const glint_shade_args *args, const glint_shade_material *material,
                                                   size_t at, unsigned lanes, group_terms *terms)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const size_t k = at + (size_t)i;
            const fm mask = fm_from_bits(lanes >> i & ((1u << VF) - 1));
            put_float(terms->term[GLINT_TERM_AMBIENT][c] + i, mask,
                      f_join(plane_ambient(args, material, c, k), plane_ambient(args, material, c, k + VD)));
            for (int term = 0; term < 2; term++)
                put_float(terms->term[GLINT_TERM_DIFFUSE + term][c] + i, mask,
                          f_load(args->planes->shaded[term][c] + k));
        }
}
