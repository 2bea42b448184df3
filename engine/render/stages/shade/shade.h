// shade: the terms of each sample. A group is processed material by material, so that colours and exponents are the
// same in every lane. Lights are added in their order, in double. Contract: stages.h.
#ifndef GLINT_SHADE_SHADE_H
#define GLINT_SHADE_SHADE_H

#include "engine/render/stages/shade/group.h"
#include "engine/render/stages/simd/elementary.h"

/// Shades a group of one sample, and adds the result to the sums.
static __attribute__((noinline)) void shade_sums(const glint_shade_args *args, uint32_t g, light_colors *colors,
                                                 const group_sums *to)
{
    const unsigned hits = args->hits[g], empty = args->active[g] & ~hits;
    material_lanes m;
    for (int c = 0; args->first && empty && c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VD) {
            double *sum = to->sum[GLINT_TERM_BACKGROUND][c] + to->at;
            put_double(sum, i, empty, d_load(sum + i) + d_set(args->background[c]));
        }
    for (unsigned rest = hits; rest; rest &= ~m.lanes) {
        begin_lanes(args, colors, (size_t)g * GLINT_GROUP, rest, &m);
        find_lights(&m);
        if (m.painted)
            add_lanes(&m, true, to);
        else
            add_lanes(&m, false, to);
    }
}

/// A group's terms in float, before they are added up.
typedef struct group_terms {
    _Alignas(64) float term[GLINT_TERM_LOCAL][3][GLINT_GROUP];
} group_terms;

/// Stores the terms that are needed, and adds all terms up.
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

/// Stores `color` in the given lanes, and 0 in the others.
static inline void store_even(const float color[3], unsigned lanes, float *const to[3], size_t at)
{
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(lanes >> i & ((1u << VF) - 1));
        for (int c = 0; c < 3; c++)
            f_store(to[c] + at + i, f_select(mask, f_set(color[c]), f_set(0)));
    }
}

static inline void store_background(const glint_shade_args *args, float *const to[3], size_t at, unsigned lanes)
{
    const float color[3] = { (float)args->background[0], (float)args->background[1], (float)args->background[2] };
    store_even(color, lanes, to, at);
}

/// Stores the background in lanes without a hit, and 0 in the other terms.
static inline void begin_terms(const glint_shade_args *args, unsigned empty, group_terms *terms)
{
    float *const to[3] = { terms->term[GLINT_TERM_BACKGROUND][0], terms->term[GLINT_TERM_BACKGROUND][1],
                           terms->term[GLINT_TERM_BACKGROUND][2] };
    memset(terms, 0, sizeof *terms);
    store_background(args, to, 0, empty);
}

/// Stores `x` in the lanes from i on.
static inline void put_float(float *to, unsigned lanes, int i, vf x)
{
    if (lanes != 0xffff)
        x = f_select(fm_from_bits(lanes >> i & ((1u << VF) - 1)), x, f_load(to + i));
    f_store(to + i, x);
}

/// Stores the sum of the terms of a material's lanes, in the common case: one light at most, no values from planes, no
/// microfacets. The function reads all numbers first, because the compiler must assume that stores change them.
INNER void finish_one(const material_lanes *m, const bool whole)
{
    const bool lit = m->factors.count, shiny = m->factors.shiny;
    const float(*color)[GLINT_LIGHT_CHUNK][3] = (const float(*)[GLINT_LIGHT_CHUNK][3])m->colors->color;
    const unsigned lanes = whole ? 0xffff : m->lanes;
    const uint32_t number = lit ? m->factors.number[0] : 0;
    vf ambient[3], diffuse[3], specular[3];
    float *beauty[3];
    for (int c = 0; c < 3; c++) {
        beauty[c] = m->args->beauty[c] + m->at;
        ambient[c] = f_set(0 + (float)m->material->ambient[c]);
        diffuse[c] = f_set(lit ? color[SHARE_DIFFUSE][number][c] : 0);
        specular[c] = f_set(shiny ? color[SHARE_SPECULAR][number][c] : 0);
    }
    for (int i = 0; i < GLINT_GROUP; i += VF)
        for (int c = 0; c < 3; c++) {
            vf sum = ambient[c];
            if (lit)
                sum = sum + f_load(m->factors.factor[SHARE_DIFFUSE][0] + i) * diffuse[c];
            if (shiny)
                sum = sum + f_load(m->factors.factor[SHARE_SPECULAR][0] + i) * specular[c];
            put_float(beauty[c], lanes, i, sum);
        }
}

/// Shades a material's lanes of a group whose terms are final, without sums in memory. Constants: painted;
/// simple: only the sum of the terms is stored, and `terms` is not used.
INNER void finish_lanes(const material_lanes *m, const bool painted, const bool simple, group_terms *terms)
{
    const int kinds = m->shaded ? 2 : m->factors.count == 0 ? 0 : m->factors.shiny ? 2 : 1;
    float ambient[3];
    for (int c = 0; c < 3; c++)
        ambient[c] = (float)m->material->ambient[c];
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf sum[3], light[3];
        for (int c = 0; c < 3; c++) {
            sum[c] = f_set(ambient[c]);
            if (painted)
                sum[c] = f_join(ambient_of(m, true, c, i), ambient_of(m, true, c, i + VD));
            if (!simple)
                put_float(terms->term[GLINT_TERM_AMBIENT][c], m->lanes, i, sum[c]);
            sum[c] = f_set(0) + sum[c]; // in the order of finish_terms, whose first term is 0 here
        }
        for (int k = 0; k < kinds; k++) {
            sum_lights(m, painted, k, i, light);
            for (int c = 0; c < 3; c++) {
                sum[c] = sum[c] + light[c];
                if (!simple)
                    put_float(terms->term[GLINT_TERM_DIFFUSE + k][c], m->lanes, i, light[c]);
            }
        }
        for (int c = 0; simple && c < 3; c++)
            put_float(m->args->beauty[c] + m->at, m->lanes, i, sum[c]);
    }
}

static __attribute__((noinline)) void finish_painted(material_lanes *m, bool simple, group_terms *terms)
{
    const glint_shade_args *args = m->args;
    m->shaded = m->material->planes & GLINT_PLANE_SHADED && args->planes->shaded[0][0];
    m->reached = 0;
    for (uint32_t k = 0; m->shaded && k < args->light_count; k++)
        m->reached |= args->lights[k].lit[m->at / GLINT_GROUP];
    if (simple)
        finish_lanes(m, true, true, terms);
    else
        finish_lanes(m, true, false, terms);
}

static inline bool wants_terms(const glint_shade_args *args)
{
    for (int k = 0; k < GLINT_TERM_LOCAL; k++)
        if (args->film[k][0])
            return true;
    return false;
}

/// Shades a group whose terms are final, because this call has all lights and one sample; `simple` is a constant.
INNER void shade_group(const glint_shade_args *args, const bool simple, uint32_t g, light_colors *colors)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    const unsigned hits = args->hits[g];
    group_terms terms;
    material_lanes m;
    if (simple && hits != 0xffff)
        store_background(args, args->beauty, at, args->active[g] & ~hits);
    if (!simple)
        begin_terms(args, args->active[g] & ~hits, &terms);
    for (unsigned rest = hits; rest; rest &= ~m.lanes) {
        begin_lanes(args, colors, at, rest, &m);
        find_lights(&m);
        if (GLINT_WITH(PROGRAM) && m.painted)
            finish_painted(&m, simple, &terms);
        else if (simple && m.factors.count <= 1 && !has_facets(m.material) && m.lanes == 0xffff)
            finish_one(&m, true);
        else if (simple && m.factors.count <= 1 && !has_facets(m.material))
            finish_one(&m, false);
        else
            finish_lanes(&m, false, simple, &terms);
    }
    if (!simple)
        finish_terms(&terms, args->film, args->beauty, at);
}

static void shade(const glint_shade_args *args)
{
    const bool simple = !wants_terms(args);
    light_colors colors;
    colors.of = NULL;
    for (uint32_t g = 0; g < args->group_count; g++)
        if (GLINT_WITH(SAMPLES) && args->sum[0][0]) {
            const group_sums sums = { args->sum, (size_t)g * GLINT_GROUP };
            shade_sums(args, g, &colors, &sums);
        } else if (simple)
            shade_group(args, true, g, &colors);
        else
            shade_group(args, false, g, &colors);
}

#endif
