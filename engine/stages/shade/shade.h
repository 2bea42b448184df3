// shade: the terms of each sample. A group is worked off material by material, so that colours and exponents are the
// same in every lane. Lights are added in their order, in double. Contract: stages.h.

#include "engine/stages/shade/phong.h"

#include "engine/stages/shade/microfacet_lobes.h"

/// The factors of a light whose samples have been summed up.
static inline void put_sums(const glint_shade_light *light, bool specular, size_t at, float diffuse[GLINT_GROUP],
                            float highlight[GLINT_GROUP])
{
    const unsigned lit = light->lit[at / GLINT_GROUP];
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(lit >> i & ((1u << VF) - 1));
        f_store(diffuse + i, f_select(mask, f_load(light->cosine + at + i), f_set(0)));
        if (specular)
            f_store(highlight + i, f_select(mask, f_load(light->highlight + at + i), f_set(0)));
    }
}

/// Those of the only light, of a material without highlights.
INNER void put_only_factors(const glint_shade_light *light, const glint_shade_material *material, uint32_t g,
                            light_factors *factors)
{
    factors->count = light->lit[g] ? 1 : 0;
    factors->shiny = 0;
    factors->light[0] = light;
    factors->number[0] = 0;
    if (factors->count)
        put_factors(light, material, NULL, false, (size_t)g * GLINT_GROUP, false, factors->diffuse[0], NULL);
}

static inline bool has_only_factors(const glint_shade_args *args, bool specular)
{
    return !specular && args->light_count == 1 && !args->lights->summed;
}

/// Those of the lights that reach a group, after what is there. `exponent`: see put_factors.
INNER void add_factors(const glint_shade_args *args, const glint_shade_material *material, const float *exponent,
                       bool specular, uint32_t g, light_factors *factors)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    const bool power = specular && material->lobe == GLINT_LOBE_POWER;
    bool begun = false; // a light that the next ones may be joined to
    for (uint32_t k = 0; k < args->light_count; k++) {
        const glint_shade_light *light = &args->lights[k];
        begun = begun && light->joined;
        if (!light->lit[g])
            continue;
        const uint32_t slot = begun ? factors->count - 1 : factors->count++;
        bool shiny = specular;
        if (light->summed)
            put_sums(light, specular, at, factors->diffuse[slot], factors->specular[slot]);
        else if (begun)
            shiny = put_factors(light, material, exponent, power, at, true, factors->diffuse[slot],
                                factors->specular[slot]);
        else
            shiny = put_factors(light, material, exponent, power, at, false, factors->diffuse[slot],
                                factors->specular[slot]);
        if (specular && !power && !light->summed) {
            put_lobe(args, light, material, at, begun, factors->specular[slot], factors->grazing[slot]);
            shiny = true;
        }
        factors->shiny |= (uint32_t)shiny << slot;
        factors->light[slot] = light;
        factors->number[slot] = (uint8_t)k;
        begun = true;
    }
}

INNER void find_factors(const glint_shade_args *args, const glint_shade_material *material, bool specular, uint32_t g,
                        light_factors *factors)
{
    factors->count = 0;
    factors->shiny = 0;
    if (has_only_factors(args, specular))
        put_only_factors(args->lights, material, g, factors);
    else
        add_factors(args, material, NULL, specular, g, factors);
}

/// What a material makes of a light's colour; finite, so that nothing of it is nothing.
static inline float share_color(double reflectance, double light)
{
    const double color = reflectance * light;
    return color < FLT_MAX ? (float)color : FLT_MAX;
}

/// A group's terms in float, before they are added up.
typedef struct group_terms {
    _Alignas(64) float term[GLINT_TERM_LOCAL][3][GLINT_GROUP];
} group_terms;

/// Writes `x` where the mask is set.
static inline void put_float(float *to, fm mask, vf x) { f_store(to, f_select(mask, x, f_load(to))); }

/// The lights whose share of a term may be other than 0, a bit each.
static inline uint32_t sharing_lights(const light_factors *factors, int term)
{
    return term ? factors->shiny : (1u << factors->count) - 1;
}

/// kd Id, ks Is and what microfacets add to these, of a material and all lights of a call: groups after each other often show one.
typedef struct light_colors {
    const glint_shade_args *of; ///< NULL: none yet
    const glint_shade_material *material;
    float color[2][GLINT_LIGHT_CHUNK][3], rise[GLINT_LIGHT_CHUNK][3]; ///< color: by term
} light_colors;

/// specular: its highlights are wanted.
static inline void color_lights(const glint_shade_args *args, const glint_shade_material *material, bool specular,
                                light_colors *colors)
{
    if (colors->of == args && colors->material == material)
        return;
    colors->of = args;
    colors->material = material;
    for (uint32_t k = 0; k < args->light_count; k++) {
        const glint_shade_light *light = &args->lights[k];
        for (int c = 0; c < 3; c++)
            colors->color[0][k][c] = share_color(material->diffuse[c], light->diffuse[c]);
        for (int c = 0; specular && c < 3; c++)
            colors->color[1][k][c] = share_color(material->specular[c], light->specular[c]);
        for (int c = 0; has_facets(material) && c < 3; c++)
            colors->rise[k][c] = share_color(material->grazing[c], light->specular[c]);
    }
}

/// One vector of the share of the light in `slot`, in each channel. `facets` is a constant.
INNER void share_channels(const light_factors *factors, const light_colors *colors, const bool facets, int term, uint32_t slot,
                          int i, vf share[3])
{
    const uint32_t number = factors->number[slot];
    const vf factor = f_load((term ? factors->specular : factors->diffuse)[slot] + i);
    for (int c = 0; c < 3; c++)
        share[c] = factor * f_set(colors->color[term][number][c]);
    for (int c = 0; facets && term && c < 3; c++)
        share[c] = share[c] + f_load(factors->grazing[slot] + i) * f_set(colors->rise[number][c]);
}

/// Adds the shares of `lights`, a bit a slot, in their order and in double. `facets` is a constant.
INNER void add_lights(const light_factors *factors, const light_colors *colors, const bool facets, int term, uint32_t lights,
                      int i, vd total[3][VF / VD])
{
    for (; lights; lights &= lights - 1) {
        vf share[3];
        share_channels(factors, colors, facets, term, (uint32_t)__builtin_ctz(lights), i, share);
        for (int c = 0; c < 3; c++) {
            vd next[VF / VD];
            f_split(share[c], next);
            for (int h = 0; h < VF / VD; h++)
                total[c][h] = total[c][h] + next[h];
        }
    }
}

/// One vector of the sum of all lights' shares, rounded. Of one light it is the share itself. `facets` is a constant.
INNER void sum_lights(const light_factors *factors, const light_colors *colors, const bool facets, int term, int i, vf sum[3])
{
    const uint32_t lights = sharing_lights(factors, term), more = lights & (lights - 1);
    vd total[3][VF / VD];
    share_channels(factors, colors, facets, term, lights ? (uint32_t)__builtin_ctz(lights) : 0, i, sum);
    if (!more)
        return;
    for (int c = 0; c < 3; c++)
        f_split(sum[c], total[c]);
    add_lights(factors, colors, facets, term, more, i, total);
    for (int c = 0; c < 3; c++)
        sum[c] = f_join(total[c][0], total[c][1]);
}

/// The same of a material, as bare powers or microfacets have it.
static inline void light_material(const glint_shade_material *material, const light_factors *factors, const light_colors *colors,
                                  int term, int i, vf sum[3])
{
    if (has_facets(material))
        sum_lights(factors, colors, true, term, i, sum);
    else
        sum_lights(factors, colors, false, term, i, sum);
}

/// How many of the terms of a material lights make: none, diffuse, and specular as well.
static inline int lit_kinds(const light_factors *factors, bool specular)
{
    return factors->count == 0 ? 0 : specular ? 2 : 1;
}

/// One material's lanes of a group whose terms are final: no sums in memory.
static __attribute__((noinline)) void shade_direct(const glint_shade_args *args, const glint_shade_material *material,
                                                   bool specular, const light_factors *factors, light_colors *colors,
                                                   unsigned lanes, group_terms *terms)
{
    const int kinds = lit_kinds(factors, specular);
    color_lights(args, material, specular, colors);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(lanes >> i & ((1u << VF) - 1));
        for (int c = 0; c < 3; c++)
            put_float(terms->term[GLINT_TERM_AMBIENT][c] + i, mask, f_set((float)material->ambient[c]));
        for (int k = 0; k < kinds; k++) {
            vf light[3];
            light_material(material, factors, colors, k, i, light);
            for (int c = 0; c < 3; c++)
                put_float(terms->term[GLINT_TERM_DIFFUSE + k][c] + i, mask, light[c]);
        }
    }
}

static inline dm lane_mask(unsigned lanes, int i) { return dm_from_bits(lanes >> i & ((1u << VD) - 1)); }

/// Stores one vector of a sum in the lanes given; `whole`: these are all, of the group.
static inline void put_where(double *sum, int i, bool whole, unsigned lanes, vd x)
{
    d_store(sum + i, whole ? x : d_select(lane_mask(lanes, i), x, d_load(sum + i)));
}

/// Adds to one vector of a sum.
static inline void add_where(double *sum, int i, bool whole, unsigned lanes, vd x)
{
    put_where(sum, i, whole, lanes, d_load(sum + i) + x);
}

/// Sums in double over samples and lights; `at`: where in them a group is.
typedef struct group_sums {
    double *const (*sum)[3];
    size_t at;
} group_sums;

/// One vector of a material's lanes, added to the sums of a term. `whole`, a constant: all lanes.
static inline void add_term(const glint_shade_material *material, const light_factors *factors, const light_colors *colors,
                            const group_sums *to, bool whole, unsigned lanes, int term, int i)
{
    const uint32_t lights = sharing_lights(factors, term);
    vd total[3][VF / VD];
    for (int c = 0; c < 3; c++)
        for (int h = 0; h < VF / VD; h++)
            total[c][h] = d_load(to->sum[GLINT_TERM_DIFFUSE + term][c] + to->at + i + h * VD);
    if (has_facets(material))
        add_lights(factors, colors, true, term, lights, i, total);
    else
        add_lights(factors, colors, false, term, lights, i, total);
    for (int c = 0; c < 3; c++)
        for (int h = 0; h < VF / VD; h++)
            put_where(to->sum[GLINT_TERM_DIFFUSE + term][c] + to->at, i + h * VD, whole, lanes, total[c][h]);
}

/// One material's lanes of a group, added to sums. `whole`, a constant: all lanes.
static inline void add_material(const glint_shade_args *args, const glint_shade_material *material, bool specular,
                                const light_factors *factors, light_colors *colors, const group_sums *to, bool whole, unsigned lanes)
{
    for (int c = 0; args->first && c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VD)
            add_where(to->sum[GLINT_TERM_AMBIENT][c] + to->at, i, whole, lanes, d_set(material->ambient[c]));
    color_lights(args, material, specular, colors);
    for (int term = 0; factors->count && term < (specular && factors->shiny ? 2 : 1); term++)
        for (int i = 0; i < GLINT_GROUP; i += VF)
            add_term(material, factors, colors, to, whole, lanes, term, i);
}

/// The material of the first of some lanes of a group, and which of them have it.
static inline const glint_shade_material *material_of(const glint_shade_args *args, size_t at, unsigned *lanes)
{
    const uint32_t index = args->only ? *args->only : args->material[at + (unsigned)__builtin_ctz(*lanes)];
    if (!args->only)
        *lanes &= lanes_equal(args->material + at, index);
    return &args->materials[index];
}

#include "engine/stages/shade/matt.h"
#include "engine/stages/shade/mixed.h"
#include "engine/stages/shade/planes.h"

/// A group of one sample, added to sums. plain: has_plain_lights(args), or false.
static __attribute__((noinline)) void shade_sums(const glint_shade_args *args, bool plain, uint32_t g, light_colors *colors,
                                                 const group_sums *to)
{
    const unsigned hits = args->hits[g], empty = args->active[g] & ~hits;
    light_factors factors;
    for (int c = 0; args->first && empty && c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VD)
            add_where(to->sum[GLINT_TERM_BACKGROUND][c] + to->at, i, false, empty, d_set(args->background[c]));
    for (unsigned left = hits, lanes; left; left &= ~lanes) {
        lanes = left;
        const glint_shade_material *material = material_of(args, (size_t)g * GLINT_GROUP, &lanes);
        const bool specular = args->highlights && material->highlight;
        if (GLINT_WITH_PROGRAM && material->planes) {
            add_planes(args, material, specular, g, to, lanes);
            continue;
        }
        if (plain && !specular && lanes == 0xffff) {
            add_matt(args, material, g, colors, to);
            return;
        }
        find_factors(args, material, specular, g, &factors);
        if (lanes == 0xffff)
            add_material(args, material, specular, &factors, colors, to, true, lanes);
        else
            add_material(args, material, specular, &factors, colors, to, false, lanes);
    }
}

/// Keeps the terms that are needed and adds them up.
static inline void finish_terms(const group_terms *terms, float *const film[][3], float *const beauty[3], size_t at)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            vf t[GLINT_TERM_LOCAL];
            for (int k = 0; k < GLINT_TERM_LOCAL; k++) {
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
            for (int k = GLINT_TERM_AMBIENT; k < GLINT_TERM_LOCAL; k++)
                f_store(terms->term[k][c] + i, f_set(0));
        }
    }
}

/// A group of one colour: without any surface, or any light.
static inline void store_even(const glint_shade_args *args, const float color[3], size_t at)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VF)
            f_store(args->beauty[c] + at + i, f_set(color[c]));
}

/// A group that shows one material in every lane, whose numbers are given, where there is one light at most and no term is kept:
/// the common case, in registers.
INNER void shade_whole(const glint_shade_args *args, const glint_shade_material *material, const float *number, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    _Alignas(64) float diffuse[GLINT_GROUP], highlight[GLINT_GROUP] = { 0 };
    bool shiny = args->highlights && material->highlight;
    if (!args->light_count || !args->lights->lit[g]) {
        store_even(args, number + MIXED_AMBIENT, at);
        return;
    }
    if (shiny)
        shiny = put_factors(args->lights, material, NULL, true, at, false, diffuse, highlight);
    else
        put_factors(args->lights, material, NULL, false, at, false, diffuse, NULL);
    for (int i = 0; i < GLINT_GROUP; i += VF)
        for (int c = 0; c < 3; c++) {
            vf sum = f_set(number[MIXED_AMBIENT + c]) + f_load(diffuse + i) * f_set(number[MIXED_DIFFUSE + c]);
            if (shiny)
                sum = sum + f_load(highlight + i) * f_set(number[MIXED_SPECULAR + c]);
            f_store(args->beauty[c] + at + i, sum);
        }
}

/// The same of any material and any lights.
static __attribute__((noinline)) void shade_lit(const glint_shade_args *args, const glint_shade_material *material,
                                                bool specular, const light_factors *factors, light_colors *colors, size_t at)
{
    const int kinds = lit_kinds(factors, specular);
    color_lights(args, material, specular, colors);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf light[2][3] = { { f_set(0), f_set(0), f_set(0) }, { f_set(0), f_set(0), f_set(0) } };
        for (int k = 0; k < kinds; k++)
            light_material(material, factors, colors, k, i, light[k]);
        for (int c = 0; c < 3; c++) // as finish_terms adds them
            f_store(args->beauty[c] + at + i, (f_set(0 + (float)material->ambient[c]) + light[0][c]) + light[1][c]);
    }
}

static inline bool wants_terms(const glint_shade_args *args)
{
    for (int k = 0; k < GLINT_TERM_LOCAL; k++)
        if (args->film[k][0])
            return true;
    return false;
}

/// A group whose terms are final; `simple` is a constant. plain: has_plain_lights(args).
INNER void shade_group(const glint_shade_args *args, const bool simple, bool plain, uint32_t g, plane_numbers *numbers,
                       light_colors *colors, mixed_table *mixed)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    unsigned left = args->hits[g];
    light_factors factors;
    group_terms terms;
    if (simple && !left && args->active[g] == 0xffff) {
        const float background[3] = { (float)args->background[0], (float)args->background[1],
                                      (float)args->background[2] };
        store_even(args, background, at);
        return;
    }
    bool begun = false;
    for (unsigned lanes; left; left &= ~lanes) {
        lanes = left;
        const glint_shade_material *material = material_of(args, at, &lanes);
        if (simple && lanes != 0xffff && !begun && shade_mixed(args, g, mixed))
            return;
        const bool specular = args->highlights && material->highlight;
        const bool planes = GLINT_WITH_PROGRAM && material->planes;
        const bool shaded = planes && material->planes & GLINT_PLANE_SHADED && args->planes->shaded[0][0];
        if (shaded && simple && lanes == 0xffff) {
            whole_shaded(args, material, g);
            return;
        }
        if (plain && !specular && !planes && simple && lanes == 0xffff) {
            shade_matt(args, material, colors, at);
            return;
        }
        if (planes && simple && lanes == 0xffff && is_matt_painted(args, material, specular)) {
            whole_matt_planes(args, material, at, numbers);
            return;
        }
        if (simple && lanes == 0xffff && mixed->usable && is_plain_material(material)) {
            shade_whole(args, material, mixed_numbers_of(args, material, mixed), g);
            return;
        }
        if (planes)
            find_plane_factors(args, material, specular, g, &factors);
        else
            find_factors(args, material, specular, g, &factors);
        if (planes && !shaded && simple && lanes == 0xffff && factors.count <= 1 && !has_facets(material)) {
            whole_planes(args, material, specular && factors.shiny, &factors, at, numbers);
            return;
        }
        if (!planes && simple && lanes == 0xffff) {
            shade_lit(args, material, specular, &factors, colors, at);
            return;
        }
        if (!begun)
            start_direct(args, g, &terms);
        begun = true;
        if (shaded)
            shade_shaded(args, material, g, lanes, &terms);
        else if (planes)
            shade_planes(args, material, specular, &factors, at, lanes, &terms);
        else
            shade_direct(args, material, specular, &factors, colors, lanes, &terms);
    }
    if (!begun)
        start_direct(args, g, &terms);
    finish_terms(&terms, args->film, args->beauty, at);
}

static void shade(const glint_shade_args *args)
{
    const bool simple = !wants_terms(args), plain = has_plain_lights(args);
    plane_numbers numbers = { 0 };
    light_colors colors;
    mixed_table mixed;
    colors.of = NULL;
    begin_mixed(args, &mixed);
    if (GLINT_WITH_SAMPLES && args->sum[0][0]) {
        for (uint32_t g = 0; g < args->group_count; g++) {
            const group_sums sums = { args->sum, (size_t)g * GLINT_GROUP };
            shade_sums(args, plain, g, &colors, &sums);
        }
    } else if (simple) {
        for (uint32_t g = 0; g < args->group_count; g++)
            shade_group(args, true, plain, g, &numbers, &colors, &mixed);
    } else {
        for (uint32_t g = 0; g < args->group_count; g++)
            shade_group(args, false, plain, g, &numbers, &colors, &mixed);
    }
}
