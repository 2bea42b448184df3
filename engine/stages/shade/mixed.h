// mixed: groups that show several materials, or nothing in some lanes, with at most one light and no terms to store.
// The lanes are shaded together, each with the values of its own material. Contract: stages.h, shade.
#ifndef GLINT_SHADE_MIXED_H
#define GLINT_SHADE_MIXED_H

#include "engine/stages/shade/group.h"
#include "engine/stages/shade/phong.h"
#include "engine/stages/simd/elementary.h"

#define MIXED_MATERIALS 16 ///< number of cached materials

/// The values of a material under the light, with colours as in share_color; 0 for values that it does not have.
enum { MIXED_AMBIENT, MIXED_DIFFUSE = 3, MIXED_SPECULAR = 6, MIXED_EXPONENT = 9, MIXED_COUNT };

typedef struct mixed_numbers {
    const glint_shade_material *of; ///< NULL: no material is cached yet
    float number[MIXED_COUNT];
} mixed_numbers;

/// The cached values of materials that previous groups showed.
typedef struct mixed_table {
    bool usable; ///< true: there is at most one light, and its samples are not summed up
    mixed_numbers materials[MIXED_MATERIALS];
} mixed_table;

static void begin_mixed(const glint_shade_args *args, mixed_table *table)
{
    table->usable = args->light_count == 0 || (args->light_count == 1 && !args->lights->summed);
    for (int i = 0; i < MIXED_MATERIALS && table->usable; i++)
        table->materials[i].of = NULL;
}

static inline const float *mixed_numbers_of(const glint_shade_args *args, const glint_shade_material *material,
                                            mixed_table *table)
{
    mixed_numbers *out = &table->materials[(size_t)(material - args->materials) % MIXED_MATERIALS];
    if (out->of == material)
        return out->number;
    const bool specular = args->highlights && material->highlight;
    *out = (mixed_numbers) { .of = material };
    for (int c = 0; c < 3; c++) {
        out->number[MIXED_AMBIENT + c] = (float)material->ambient[c];
        if (args->light_count)
            out->number[MIXED_DIFFUSE + c] = share_color(material->diffuse[c], args->lights->diffuse[c]);
        if (args->light_count && specular)
            out->number[MIXED_SPECULAR + c] = share_color(material->specular[c], args->lights->specular[c]);
    }
    if (specular)
        out->number[MIXED_EXPONENT] = material->shininess;
    return out->number;
}

/// Returns whether the material differs from other materials only by the values above.
static inline bool is_plain_material(const glint_shade_material *material)
{
    return !material->planes && (!material->highlight || material->lobe == GLINT_LOBE_POWER);
}

/// Looks up the values of a group's lanes, which are 0 for misses; *specular: whether any lane has a highlight.
/// Returns false if a material is not plain.
INNER bool find_mixed(const glint_shade_args *args, uint32_t g, mixed_table *table,
                      float lanes_of[MIXED_COUNT][GLINT_GROUP], bool *specular)
{
    memset(lanes_of, 0, sizeof(float[MIXED_COUNT][GLINT_GROUP]));
    for (unsigned rest = args->hits[g], lanes; rest; rest &= ~lanes) {
        lanes = rest;
        const glint_shade_material *material = material_of(args, (size_t)g * GLINT_GROUP, &lanes);
        if (!is_plain_material(material))
            return false;
        *specular = *specular || (args->highlights && material->highlight);
        const float *numbers = mixed_numbers_of(args, material, table);
        for (int i = 0; i < GLINT_GROUP; i += VF)
            for (int k = 0; k < MIXED_COUNT; k++)
                put_float(lanes_of[k] + i, fm_from_bits(lanes >> i & ((1u << VF) - 1)), f_set(numbers[k]));
    }
    return true;
}

/// Shades a group. Returns whether the group could be shaded here.
static __attribute__((noinline)) bool shade_mixed(const glint_shade_args *args, uint32_t g, mixed_table *table)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    const unsigned empty = args->active[g] & ~(unsigned)args->hits[g];
    const bool lit = args->light_count && args->lights->lit[g];
    _Alignas(64) float lanes[MIXED_COUNT][GLINT_GROUP], diffuse[GLINT_GROUP], specular[GLINT_GROUP];
    bool shiny = false;
    if (!table->usable || !find_mixed(args, g, table, lanes, &shiny))
        return false;
    shiny = shiny && lit;
    if (shiny)
        shiny = put_factors(args->lights, NULL, lanes[MIXED_EXPONENT], true, at, false, diffuse, specular);
    else if (lit)
        put_factors(args->lights, NULL, lanes[MIXED_EXPONENT], false, at, false, diffuse, NULL);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(empty >> i & ((1u << VF) - 1));
        for (int c = 0; c < 3; c++) {
            vf sum = f_select(mask, f_set((float)args->background[c]), f_set(0)) + f_load(lanes[MIXED_AMBIENT + c] + i);
            if (lit)
                sum = sum + f_load(diffuse + i) * f_load(lanes[MIXED_DIFFUSE + c] + i);
            if (shiny)
                sum = sum + f_load(specular + i) * f_load(lanes[MIXED_SPECULAR + c] + i);
            f_store(args->beauty[c] + at + i, sum);
        }
    }
    return true;
}

#endif
