// The specification of shade in plain C: Phong, Blinn-Phong and microfacets, lights added in their order. Contract:
// stages.h.

/// Returns the material of a hit.
static uint32_t material_at(const glint_shade_args *args, uint32_t i)
{
    return args->only ? *args->only : args->material[i];
}

/// Returns a material's value at a sample: the plane's value if a plane replaces it, otherwise the material's own.
static float number_at(const glint_shade_material *material, unsigned which, float number, const float *plane,
                       uint32_t i)
{
    return material->planes & which ? plane[i] : number;
}

typedef struct terms {
    double value[GLINT_TERM_COUNT][3];
} terms; ///< the terms of one sample

/// Returns Smith's masking for Beckmann's distribution: x times Lambda at the cosine x.
static float beckmann_mask(float alpha, float x)
{
    float s = alpha * sqrtf(max_float(1 - x * x, 0));
    float q = x / s;
    return q < 1.6f ? (s * ((0.396f * q - 1.259f) * q + 1)) / (2.181f * q + 3.535f) : 0;
}

static float ggx(float alpha, float sine2, float l, float v)
{
    float aa = alpha * alpha, b = 1 - aa;
    float u = alpha / (sine2 + aa * (1 - sine2));
    float d = l * sqrtf(aa + b * (v * v)) + v * sqrtf(aa + b * (l * l));
    return (u * u) * ((0.5f * l) / max_float(d, FLT_MIN));
}

static float beckmann(float alpha, float sine2, float l, float v)
{
    float aa = alpha * alpha, c = max_float(1 - sine2, 0x1p-40f);
    float y = -((sine2 / c) * (GLINT_LOG2_E / aa));
    float e = y < GLINT_EXP2_LEAST ? 0 : exp2_of(y);
    float d = (l * v + v * beckmann_mask(alpha, l)) + l * beckmann_mask(alpha, v);
    return (((e / c) / c) * (1 / aa)) * ((0.25f * l) / max_float(d, FLT_MIN));
}

/// The factors of a light and of the lights joined to it: w (n.l), w S, and for microfacets w S (1 - v.h)^5.
typedef struct factors {
    float diffuse, specular, grazing;
} factors;

/// Adds w S of microfacets. Returns whether the half vector is defined.
static bool add_facets(const glint_shade_args *args, const glint_shade_light *light, float w, uint32_t i, factors *sum)
{
    const glint_shade_material *material = &args->materials[material_at(args, i)];
    float sine2 = light->sine2[i], l = light->cosine[i], v = args->facing[i];
    if (!(sine2 > GLINT_NO_SPECULAR))
        return false;
    float alpha = number_at(material, GLINT_PLANE_ALPHA, material->alpha, args->planes ? args->planes->alpha : NULL, i);
    float s = material->lobe == GLINT_LOBE_GGX ? ggx(alpha, sine2, l, v) : beckmann(alpha, sine2, l, v);
    float f = min_float(w * min_float(s, GLINT_ATTENUATION_MAX), GLINT_ATTENUATION_MAX);
    sum->specular += f;
    sum->grazing += f * light->schlick[i];
    return true;
}

/// Adds the factors of a light. Returns whether there is a highlight.
static bool add_factors(const glint_shade_args *args, const glint_shade_light *light, uint32_t i, factors *sum)
{
    const glint_shade_material *material = &args->materials[material_at(args, i)];
    if (light->summed) {
        bool shiny = args->highlights && material->highlight != GLINT_HIGHLIGHT_NONE;
        sum->diffuse = light->cosine[i];
        sum->specular = shiny ? light->highlight[i] : 0;
        return shiny;
    }
    float w = light->attenuation ? light->attenuation[i] : 1;
    sum->diffuse += w * light->cosine[i];
    if (!args->highlights || material->highlight == GLINT_HIGHLIGHT_NONE)
        return false;
    if (material->highlight == GLINT_HIGHLIGHT_FACETS)
        return add_facets(args, light, w, i, sum);
    if (!(light->log2_specular[i] > GLINT_NO_SPECULAR))
        return false;
    float exponent = number_at(material, GLINT_PLANE_SHININESS, material->shininess,
                               args->planes ? args->planes->shininess : NULL, i);
    float s = highlight_strength(exponent, light->log2_specular[i]);
    sum->specular += w * (material->lobe == GLINT_LOBE_POWER_COSINE ? s * light->cosine[i] : s);
    return true;
}

/// Returns a light's contribution to a term, as float; the term is a sum in double.
static float share_of(float factor, double color) { return factor * (color < FLT_MAX ? (float)color : FLT_MAX); }

/// Returns a reflectance at a sample: the table's value times the plane's value.
static double reflectance(const glint_shade_material *material, unsigned which, double table, const float *plane,
                          uint32_t i, double light)
{
    return material->planes & which ? (double)plane[i] * (table * light) : table * light;
}

static bool reaches(const glint_shade_light *light, uint32_t i)
{
    return light->lit[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
}

/// Adds light k and the lights joined to it. Returns the next light that is not joined.
static uint32_t add_lights(const glint_shade_args *args, uint32_t k, uint32_t i, terms *sum)
{
    const glint_shade_light *light = &args->lights[k];
    factors total = { 0, 0, 0 };
    bool any = false, shiny = false;
    do {
        if (reaches(&args->lights[k], i)) {
            shiny = add_factors(args, &args->lights[k], i, &total) || shiny;
            any = true;
        }
        k++;
    } while (k < args->light_count && args->lights[k].joined);
    const glint_shade_material *material = &args->materials[material_at(args, i)];
    for (int c = 0; c < 3 && any; c++) {
        const float *kd = args->planes ? args->planes->diffuse[c] : NULL;
        const float *ks = args->planes ? args->planes->specular[c] : NULL;
        double color = reflectance(material, GLINT_PLANE_DIFFUSE, material->diffuse[c], kd, i, light->diffuse[c]);
        float share = share_of(total.diffuse, color);
        sum->value[GLINT_TERM_DIFFUSE][c] += (double)share;
        color = reflectance(material, GLINT_PLANE_SPECULAR, material->specular[c], ks, i, light->specular[c]);
        share = share_of(total.specular, color);
        color = reflectance(material, GLINT_PLANE_SPECULAR, material->grazing[c], ks, i, light->specular[c]);
        if (material->highlight == GLINT_HIGHLIGHT_FACETS)
            share += share_of(total.grazing, color);
        if (shiny)
            sum->value[GLINT_TERM_SPECULAR][c] += (double)share;
    }
    return k;
}

/// Rounds the terms into the film, and adds them up into beauty. further: the non-local terms that the frame has, one
/// bit each.
static void write_film(const terms *sum, unsigned further, float *const film[GLINT_TERM_COUNT][3],
                       float *const beauty[3], uint32_t i)
{
    for (int c = 0; c < 3; c++) {
        float rounded[GLINT_TERM_COUNT];
        for (int term = 0; term < GLINT_TERM_COUNT; term++) {
            rounded[term] = (float)sum->value[term][c];
            if (film[term][c] && (term < GLINT_TERM_LOCAL || further >> term & 1))
                film[term][c][i] = rounded[term];
        }
        beauty[c][i] = ((rounded[GLINT_TERM_BACKGROUND] + rounded[GLINT_TERM_AMBIENT]) + rounded[GLINT_TERM_DIFFUSE]) +
                       rounded[GLINT_TERM_SPECULAR];
        for (int term = GLINT_TERM_LOCAL; term < GLINT_TERM_COUNT; term++)
            if (further >> term & 1)
                beauty[c][i] = beauty[c][i] + rounded[term];
    }
}

static terms load_sums(double *const sum[GLINT_TERM_COUNT][3], uint32_t i)
{
    terms loaded;
    for (int term = 0; term < GLINT_TERM_COUNT; term++)
        for (int c = 0; c < 3; c++)
            loaded.value[term][c] = sum[term][c] ? sum[term][c][i] : 0;
    return loaded;
}

static void store_sums(const terms *total, double *const sum[GLINT_TERM_COUNT][3], uint32_t i)
{
    for (int term = 0; term < GLINT_TERM_COUNT; term++)
        for (int c = 0; c < 3; c++)
            if (sum[term][c])
                sum[term][c][i] = total->value[term][c];
}

static double ambient_at(const glint_shade_args *args, uint32_t i, int c)
{
    const glint_shade_material *material = &args->materials[material_at(args, i)];
    if (material->planes & GLINT_PLANE_AMBIENT_IS_DIFFUSE)
        return (double)args->planes->diffuse[c][i] * args->planes->ambient_light[c];
    if (material->planes & GLINT_PLANE_AMBIENT)
        return (double)args->planes->ambient[c][i] * args->planes->ambient_light[c];
    return material->ambient[c];
}

/// Adds the terms of one sample.
static void add_sample(const glint_shade_args *args, uint32_t i, terms *sum)
{
    uint32_t group = i / GLINT_GROUP, lane = i % GLINT_GROUP;
    bool active = args->active[group] >> lane & 1, hit = args->hits[group] >> lane & 1;
    for (int c = 0; c < 3 && args->first; c++) {
        if (active && !hit)
            sum->value[GLINT_TERM_BACKGROUND][c] += args->background[c];
        if (hit)
            sum->value[GLINT_TERM_AMBIENT][c] += ambient_at(args, i, c);
    }
    const glint_shade_material *material = hit ? &args->materials[material_at(args, i)] : NULL;
    const bool shaded = material && material->planes & GLINT_PLANE_SHADED;
    bool lit = false;
    for (uint32_t k = 0; k < args->light_count; k++)
        lit = lit || args->lights[k].lit[group] >> lane & 1;
    for (int k = 0; k < 2 && shaded && lit && !args->sum[0][0]; k++)
        for (int c = 0; c < 3 && args->planes->shaded[k][c]; c++)
            sum->value[GLINT_TERM_DIFFUSE + k][c] = (double)args->planes->shaded[k][c][i];
    for (uint32_t k = 0; !shaded && k < args->light_count;)
        k = add_lights(args, k, i, sum);
}

static void shade_sample(const glint_shade_args *args, uint32_t i)
{
    terms sum = load_sums(args->sum, i);
    add_sample(args, i, &sum);
    if (args->sum[GLINT_TERM_BACKGROUND][0])
        store_sums(&sum, args->sum, i);
    else
        write_film(&sum, 0, args->film, args->beauty, i);
}

static void shade(const glint_shade_args *args)
{
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++)
        shade_sample(args, i);
}
