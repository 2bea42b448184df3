// matt: what several lights make of a group that shows one material without highlights, in one pass: no factor is stored. Contract:
// stages.h, shade.
#ifndef GLINT_SHADE_MATT_H
#define GLINT_SHADE_MATT_H

#include "engine/stages/program/exact.h"
#include "engine/stages/shade/group.h"
#include "engine/stages/simd/elementary.h"

/// A light's factor of diffuse light, of one vector of a group.
INNER vf diffuse_factor(const glint_shade_light *light, size_t at, int i)
{
    vf w = f_set(1);
    if (light->attenuation)
        w = w * f_load(light->attenuation + at + i);
    const fm lit = fm_from_bits(light->lit[at / GLINT_GROUP] >> i & ((1u << VF) - 1));
    return f_select(lit, w * f_load(light->cosine + at + i), f_set(0));
}

/// Whether there are several lights, none of which is a sample or the sum of samples.
static inline bool has_plain_lights(const glint_shade_args *args)
{
    bool plain = args->light_count > 1;
    for (uint32_t k = 0; plain && k < args->light_count; k++)
        plain = !args->lights[k].joined && !args->lights[k].summed;
    return plain;
}

/// Adds what the lights of a call make of a material without highlights to one vector; they are plain.
INNER void add_plain_lights(const glint_shade_args *args, const light_colors *colors, size_t at, int i, vd total[3][VF / VD])
{
    for (uint32_t k = 0; k < args->light_count; k++) {
        const glint_shade_light *light = &args->lights[k];
        if (!light->lit[at / GLINT_GROUP])
            continue;
        const vf factor = diffuse_factor(light, at, i);
        for (int c = 0; c < 3; c++) {
            vd share[VF / VD];
            f_split(factor * f_set(colors->color[0][k][c]), share);
            for (int h = 0; h < VF / VD; h++)
                total[c][h] = total[c][h] + share[h];
        }
    }
}

/// A group whose terms are final, in registers.
static __attribute__((noinline)) void shade_matt(const glint_shade_args *args, const glint_shade_material *material,
                                                 light_colors *colors, size_t at)
{
    color_lights(args, material, false, colors);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vd total[3][VF / VD];
        for (int c = 0; c < 3; c++)
            for (int h = 0; h < VF / VD; h++)
                total[c][h] = d_set(0);
        add_plain_lights(args, colors, at, i, total);
        for (int c = 0; c < 3; c++)
            f_store(args->beauty[c] + at + i, f_set(0 + (float)material->ambient[c]) + f_join(total[c][0], total[c][1]));
    }
}

/// A group, added to sums.
static __attribute__((noinline)) void add_matt(const glint_shade_args *args, const glint_shade_material *material, uint32_t g,
                                               light_colors *colors, const group_sums *to)
{
    color_lights(args, material, false, colors);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vd total[3][VF / VD];
        for (int c = 0; c < 3; c++)
            for (int h = 0; h < VF / VD; h++) {
                double *const sum = to->sum[GLINT_TERM_AMBIENT][c] + to->at + i + h * VD;
                if (args->first)
                    d_store(sum, d_load(sum) + d_set(material->ambient[c]));
                total[c][h] = d_load(to->sum[GLINT_TERM_DIFFUSE][c] + to->at + i + h * VD);
            }
        add_plain_lights(args, colors, (size_t)g * GLINT_GROUP, i, total);
        for (int c = 0; c < 3; c++)
            for (int h = 0; h < VF / VD; h++)
                d_store(to->sum[GLINT_TERM_DIFFUSE][c] + to->at + i + h * VD, total[c][h]);
    }
}

#endif
