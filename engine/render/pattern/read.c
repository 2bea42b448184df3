/// Reads the results of materials' programs for single samples.
#include "engine/base/vec.h"
#include "engine/render/effects/bounce/plan.h"
#include "engine/render/pattern/pattern.h"
#include "engine/render/plan/plan.h"
#include "engine/render/tile/tile.h"

#include <math.h>

const glint_bounce_material *glint_tile_pattern_bouncing(const glint_tile *tile, const glint_plan *plan, uint32_t i,
                                                         glint_bounce_material *buffer)
{
    const uint32_t material = tile->surface.material[i];
    const glint_bounce_material *m = &plan->bouncing[material];
    const uint32_t read = 1u << GLINT_FIELD_MIRROR | 1u << GLINT_FIELD_TRANSMISSION | 1u << GLINT_FIELD_CLEAR |
                          1u << GLINT_FIELD_ROUGHNESS | 1u << GLINT_FIELD_SPECULAR;
    double color[3];
    const uint32_t made = plan->patterns->of[material].made & read;
    if (!made)
        return m;
    *buffer = *m;
    if (made >> GLINT_FIELD_ROUGHNESS & 1)
        buffer->alpha = (double)glint_plane_of(tile->at.planes, plan, GLINT_FIELD_ROUGHNESS, 0)[i];
    vec_copy(buffer->mirror, glint_color_at(tile->at.planes, plan, GLINT_FIELD_MIRROR, material, i, m->mirror, color));
    vec_copy(buffer->transmission,
             glint_color_at(tile->at.planes, plan, GLINT_FIELD_TRANSMISSION, material, i, m->transmission, color));
    if (m->facets)
        vec_copy(buffer->specular, glint_color_at(tile->at.planes, plan, GLINT_FIELD_SPECULAR, material, i, m->specular, color));
    if (made >> GLINT_FIELD_CLEAR & 1)
        buffer->clear = (double)glint_plane_of(tile->at.planes, plan, GLINT_FIELD_CLEAR, 0)[i];
    return buffer;
}

double glint_tile_pattern_rest(const glint_tile *tile, const glint_plan *plan, uint32_t i, int c)
{
    const uint32_t material = tile->surface.material[i];
    const glint_plan_pattern *own = plan->patterns ? &plan->patterns->of[material] : NULL;
    double buffer[3];
    if (own && own->made >> GLINT_FIELD_REST & 1)
        return (double)glint_plane_of(tile->at.planes, plan, GLINT_FIELD_REST, c)[i] * plan->ambient[c];
    if (!own || !(own->made >> GLINT_FIELD_DIFFUSE & 1))
        return plan->indirect.rest[material][c];
    const double kd = glint_tile_diffuse(tile, plan, i, buffer)[c];
    return (own->ambient_follows ? kd : fmin(kd, own->desc.ambient[c])) * plan->ambient[c];
}
