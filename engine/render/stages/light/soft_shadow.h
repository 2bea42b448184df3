// soft_shadow: the stage occlude for an area light, with a tile's list of occluders (soft.h) or with layers
// (layers.h). It works sample by sample, as for a point light, if the points and samples allow no frame for layers,
// if each point has its own samples, or if float decides. Contract: stages.h, occlude.
#ifndef GLINT_LIGHT_SOFT_SHADOW_H
#define GLINT_LIGHT_SOFT_SHADOW_H

#include "engine/render/stages/light/caps.h"
#include "engine/render/stages/light/cone.h"
#include "engine/render/stages/light/layers.h"
#include "engine/render/stages/light/light_sample.h"
#include "engine/render/stages/light/soft.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/occlude/occlude.h"
#include "engine/render/stages/occlude/through_beam.h"
#include "engine/render/stages/simd/real.h"

/// Traverses the index for every group and sample, if there are too many occluders for a list.
static void R(occlude_walking)(R(shadow_tile) * tile)
{
    const glint_occlude_args *args = tile->args;
    const bool cone = R(is_cone)(args->light_sample[0]);
    R(light_sample_set) light_samples;
    for (uint32_t s = 0; s < args->sample_count; s++) {
        R(shadow_group) group = { .last_blocker = GLINT_MISS };
        const double(*target)[GLINT_GROUP] =
            cone ? (const double(*)[GLINT_GROUP])light_samples.exact_position[0] : args->light_sample[s]->position;
        if (!cone)
            R(aim_at)(tile, target);
        for (uint32_t g = 0; g < args->group_count; g++) {
            unsigned unoccluded = args->lit[s][g];
            *args->rays += (unsigned)__builtin_popcount(unoccluded);
            if (unoccluded) {
                R(begin_group)(g, &group);
                if (cone) {
                    R(place_in_cone)
                    (&args->light_sample[s], 1, args->scale, args->point, args->normal, group.at, &light_samples);
                    R(aim_at)(tile, target);
                }
                unoccluded = R(test_unbounded)(tile, target, &group, unoccluded);
                unoccluded = R(walk_group)(tile, target, &group, unoccluded);
            }
            args->unoccluded[s][g] = (uint16_t)unoccluded;
        }
    }
}

static void R(occlude_light_sample)(const glint_occlude_args *args)
{
    R(shadow_tile) tile;
    uint16_t lit[GLINT_TILE_GROUPS];
    for (uint32_t g = 0; g < args->group_count; g++) {
        lit[g] = 0;
        for (uint32_t s = 0; s < args->sample_count; s++)
            lit[g] |= args->lit[s][g];
    }
    R(begin_shadows)(args, lit, &tile);
    if (tile.count <= GLINT_OCCLUDERS)
        R(occlude_listed)(&tile, lit);
    else if (!R(occlude_by_layers)(&tile, lit))
        R(occlude_walking)(&tile);
}

static void R(occlude)(const glint_occlude_args *args)
{
    if (GLINT_WITH(CAPS) && args->visible)
        R(occlude_caps)(args);
    else if (GLINT_WITH(AREA) && args->light_sample[0])
        R(occlude_light_sample)(args);
    else
        R(occlude_point)(args);
}

#endif
