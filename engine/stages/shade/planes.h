// planes: materials whose numbers differ from sample to sample, and are read from planes. Contract: stages.h, shade.
#ifndef GLINT_SHADE_PLANES_H
#define GLINT_SHADE_PLANES_H

#include "engine/stages/program/exact.h"
#include "engine/stages/shade/group.h"
#include "engine/stages/shade/matt.h"
#include "engine/stages/shade/microfacet_lobes.h"
#include "engine/stages/shade/phong.h"
#include "engine/stages/simd/elementary.h"

/// The product of a plane and a light's colour, as share_color makes it.
static inline vf plane_color(const float *plane, double light)
{
    vd halves[VF / VD];
    f_split(f_load(plane), halves);
    return f_min(f_join(halves[0] * d_set(light), halves[1] * d_set(light)), f_set(FLT_MAX));
}

/// Computes one vector of a factor times its colour; plane NULL: the colour of the table.
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
    if (has_only_factors(args, specular))
        put_only_factors(args->lights, material, g, factors);
    else if (material->planes & GLINT_PLANE_SHININESS)
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

/// A vector of a plane, in double.
typedef struct wide_lanes {
    vd part[VF / VD];
} wide_lanes;

static inline wide_lanes wide_of(const float *plane)
{
    wide_lanes wide;
    f_split(f_load(plane), wide.part);
    return wide;
}

static inline vf narrow(const wide_lanes *wide, double number)
{
    return f_join(wide->part[0] * d_set(number), wide->part[1] * d_set(number));
}

/// Of one channel what planes are multiplied by, and the products where there are none: read once, as stores may change what
/// pointers lead to.
typedef struct channel_numbers {
    double ambient, diffuse, specular;
    float ambient_color, diffuse_color, specular_color;
} channel_numbers;

static inline channel_numbers numbers_of(const glint_shade_args *args, const glint_shade_material *material,
                                         const glint_shade_light *light, int c)
{
    const double diffuse = light ? light->diffuse[c] : 0, specular = light ? light->specular[c] : 0;
    return (channel_numbers) { args->planes->ambient_light[c],
                               material->diffuse[c] * diffuse,
                               material->specular[c] * specular,
                               (float)material->ambient[c],
                               share_color(material->diffuse[c], diffuse),
                               share_color(material->specular[c], specular) };
}

/// What reaches a group that shows one material in every lane, of one light at most. NULL, a constant: no factors are stored, as there
/// are no highlights.
typedef struct group_light {
    const light_factors *factors;
    const glint_shade_light *light; ///< NULL: none reaches it
    bool shines; ///< there are highlights
} group_light;

/// One vector of the light's diffuse factor.
INNER vf group_diffuse(const group_light *by, size_t at, int i)
{
    return by->factors ? f_load(by->factors->diffuse[0] + i) : diffuse_factor(by->light, at, i);
}

/// One channel of a group. `has`: the material's planes.
INNER void whole_channel(const glint_shade_args *args, const channel_numbers *by, unsigned has, const group_light *from, int c,
                         size_t at)
{
    const glint_shade_planes *planes = args->planes;
    const bool follows = has & GLINT_PLANE_AMBIENT_IS_DIFFUSE, painted = follows || has & GLINT_PLANE_DIFFUSE;
    const float *diffuse = painted ? planes->diffuse[c] + at : NULL,
                *ambient = has & GLINT_PLANE_AMBIENT ? planes->ambient[c] + at : NULL,
                *specular = has & GLINT_PLANE_SPECULAR ? planes->specular[c] + at : NULL;
    float *beauty = args->beauty[c] + at;
    const bool lit = from->light, shines = lit && from->shines;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        wide_lanes kd, other;
        vf sum = f_set(by->ambient_color), color = f_set(by->diffuse_color), shine = f_set(by->specular_color);
        if (diffuse)
            kd = wide_of(diffuse + i);
        if (follows) {
            sum = narrow(&kd, by->ambient);
        } else if (ambient) {
            other = wide_of(ambient + i);
            sum = narrow(&other, by->ambient);
        }
        if (has & GLINT_PLANE_DIFFUSE)
            color = f_min(narrow(&kd, by->diffuse), f_set(FLT_MAX));
        if (lit)
            sum = sum + group_diffuse(from, at, i) * color;
        if (shines && specular)
            shine = plane_color(specular + i, by->specular);
        if (shines)
            sum = sum + f_load(from->factors->specular[0] + i) * shine;
        f_store(beauty + i, sum);
    }
}

/// Products of the last group, which the next group often shares.
typedef struct plane_numbers {
    const glint_shade_material *material; ///< NULL: none yet
    const glint_shade_light *light; ///< NULL: none reaches it
    bool grey; ///< its diffuse reflectance and the light's colour are the same in all channels, which share a plane
    bool level; ///< of a grey one: so is ambient light
    bool white; ///< of a grey one: it is the plane
    channel_numbers channel[3];
} plane_numbers;

static void read_numbers(const glint_shade_args *args, const glint_shade_material *material,
                         const glint_shade_light *light, plane_numbers *numbers)
{
    const float *const *diffuse = args->planes->diffuse;
    numbers->material = material;
    numbers->light = light;
    for (int c = 0; c < 3; c++)
        numbers->channel[c] = numbers_of(args, material, light, c);
    numbers->grey = numbers->level = true;
    for (int c = 1; c < 3; c++) {
        numbers->grey = numbers->grey && diffuse[c] == diffuse[0] &&
                        numbers->channel[c].diffuse == numbers->channel[0].diffuse;
        numbers->level = numbers->level && numbers->channel[c].ambient == numbers->channel[0].ambient;
    }
    numbers->white = numbers->channel[0].diffuse == 1;
}

/// All channels of a group whose diffuse light is grey; the ambient reflectance is the diffuse one.
INNER void whole_grey(const glint_shade_args *args, const plane_numbers *numbers, const group_light *from, size_t at)
{
    const float *diffuse = args->planes->diffuse[0] + at;
    float *const beauty[3] = { args->beauty[0] + at, args->beauty[1] + at, args->beauty[2] + at };
    const bool lit = from->light, shines = lit && from->shines;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const vf plane = f_load(diffuse + i);
        const wide_lanes kd = wide_of(diffuse + i);
        vf light = f_set(0), ambient = narrow(&kd, numbers->channel[0].ambient);
        if (lit && numbers->white) // a reflectance, and so finite
            light = group_diffuse(from, at, i) * plane;
        else if (lit)
            light = group_diffuse(from, at, i) * f_min(narrow(&kd, numbers->channel[0].diffuse), f_set(FLT_MAX));
        if (numbers->level && !shines) {
            if (lit)
                ambient = ambient + light;
            for (int c = 0; c < 3; c++)
                f_store(beauty[c] + i, ambient);
            continue;
        }
        for (int c = 0; c < 3; c++) {
            if (c > 0 && !numbers->level)
                ambient = narrow(&kd, numbers->channel[c].ambient);
            vf sum = ambient;
            if (lit)
                sum = sum + light;
            if (shines)
                sum = sum + f_load(from->factors->specular[0] + i) * f_set(numbers->channel[c].specular_color);
            f_store(beauty[c] + i, sum);
        }
    }
}

/// All of it. Diffuse reflectances that are the ambient ones, too, are the common case.
INNER void whole_painted(const glint_shade_args *args, const glint_shade_material *material, const group_light *from, size_t at,
                         plane_numbers *numbers)
{
    const unsigned painted = GLINT_PLANE_DIFFUSE | GLINT_PLANE_AMBIENT_IS_DIFFUSE, has = material->planes;
    const bool usual = (has & ~(unsigned)GLINT_PLANE_SHININESS) == painted;
    if (numbers->material != material || numbers->light != from->light)
        read_numbers(args, material, from->light, numbers);
    if (usual && numbers->grey) {
        whole_grey(args, numbers, from, at);
        return;
    }
    for (int c = 0; c < 3; c++) {
        if (usual)
            whole_channel(args, &numbers->channel[c], painted, from, c, at);
        else
            whole_channel(args, &numbers->channel[c], has, from, c, at);
    }
}

/// As shade_whole.
static __attribute__((noinline)) void whole_planes(const glint_shade_args *args, const glint_shade_material *material,
                                                   bool shines, const light_factors *factors, size_t at,
                                                   plane_numbers *numbers)
{
    const group_light from = { factors, factors->count ? factors->light[0] : NULL, shines };
    whole_painted(args, material, &from, at, numbers);
}

/// Whether whole_matt_planes can shade it.
static inline bool is_matt_painted(const glint_shade_args *args, const glint_shade_material *material, bool specular)
{
    return has_only_factors(args, specular) && !(material->planes & GLINT_PLANE_SHADED) && !has_facets(material);
}

/// The same of a material without highlights.
static __attribute__((noinline)) void whole_matt_planes(const glint_shade_args *args, const glint_shade_material *material,
                                                        size_t at, plane_numbers *numbers)
{
    const group_light from = { NULL, args->lights->lit[at / GLINT_GROUP] ? args->lights : NULL, false };
    whole_painted(args, material, &from, at, numbers);
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

/// The lanes of a group that any light reaches.
static inline unsigned lanes_reached(const glint_shade_args *args, uint32_t g)
{
    unsigned lit = 0;
    for (uint32_t k = 0; k < args->light_count; k++)
        lit |= args->lights[k].lit[g];
    return lit;
}

/// Where any light reaches, of a group.
typedef struct reached_lanes {
    fm part[GLINT_GROUP / VF];
} reached_lanes;

static inline reached_lanes find_reached(unsigned lit)
{
    reached_lanes reached;
    for (int i = 0; i < GLINT_GROUP; i += VF)
        reached.part[i / VF] = fm_from_bits(lit >> i & ((1u << VF) - 1));
    return reached;
}

/// One channel of whole_shaded. `whole`, a constant: light reaches every lane.
INNER void channel_shaded(const glint_shade_args *args, const glint_shade_material *material, int c, size_t at,
                          const bool whole, const reached_lanes *reached)
{
    const bool painted = material->planes & (GLINT_PLANE_AMBIENT | GLINT_PLANE_AMBIENT_IS_DIFFUSE);
    const float *diffuse = args->planes->shaded[0][c] + at, *specular = args->planes->shaded[1][c] + at;
    float *beauty = args->beauty[c] + at;
    vf ambient = f_set((float)material->ambient[c]);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const size_t k = at + (size_t)i;
        vf kd = f_load(diffuse + i), ks = f_load(specular + i);
        if (painted)
            ambient = f_join(plane_ambient(args, material, c, k), plane_ambient(args, material, c, k + VD));
        if (!whole) {
            kd = f_select(reached->part[i / VF], kd, f_set(0));
            ks = f_select(reached->part[i / VF], ks, f_set(0));
        }
        f_store(beauty + i, (ambient + kd) + ks);
    }
}

/// As shade_whole, of a material whose light is in planes.
static __attribute__((noinline)) void whole_shaded(const glint_shade_args *args, const glint_shade_material *material,
                                                   uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    const unsigned lit = lanes_reached(args, g);
    if (lit == 0xffff) {
        for (int c = 0; c < 3; c++)
            channel_shaded(args, material, c, at, true, NULL);
        return;
    }
    const reached_lanes reached = find_reached(lit);
    for (int c = 0; c < 3; c++)
        channel_shaded(args, material, c, at, false, &reached);
}

/// As shade_direct.
static __attribute__((noinline)) void shade_shaded(const glint_shade_args *args, const glint_shade_material *material,
                                                   uint32_t g, unsigned lanes, group_terms *terms)
{
    const reached_lanes reached = find_reached(lanes_reached(args, g));
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const size_t k = (size_t)g * GLINT_GROUP + (size_t)i;
            const fm mask = fm_from_bits(lanes >> i & ((1u << VF) - 1));
            put_float(terms->term[GLINT_TERM_AMBIENT][c] + i, mask,
                      f_join(plane_ambient(args, material, c, k), plane_ambient(args, material, c, k + VD)));
            for (int term = 0; term < 2; term++)
                put_float(terms->term[GLINT_TERM_DIFFUSE + term][c] + i, mask,
                          f_select(reached.part[i / VF], f_load(args->planes->shaded[term][c] + k), f_set(0)));
        }
}

#endif
