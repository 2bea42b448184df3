#include "engine/render/tile/rays.h"

#include <string.h>

void glint_rays_clear(glint_rays *rays, uint32_t group_count)
{
    rays->group_count = group_count;
    memset(rays->active, 0, group_count * sizeof *rays->active);
    memset(rays->inward, 0, group_count * sizeof *rays->inward);
    memset(rays->blind, 0, group_count * sizeof *rays->blind);
}

/// Sets or clears the bit of lane i.
static void put_bit(uint16_t *bits, uint32_t i, bool set)
{
    const unsigned bit = 1u << i % GLINT_GROUP;
    bits[i / GLINT_GROUP] = (uint16_t)(set ? bits[i / GLINT_GROUP] | bit : bits[i / GLINT_GROUP] & ~bit);
}

void glint_rays_put(glint_rays *rays, const glint_plan *plan, uint32_t i, const glint_ray *ray)
{
    const glint_precision precision = plan->desc.precision;
    for (int c = 0; c < 3; c++) {
        glint_real_put(rays->origin[c], precision, i, ray->origin[c]);
        glint_real_put(rays->direction[c], precision, i, ray->direction[c]);
        rays->weight[c][i] = ray->weight[c];
    }
    rays->leaving[i] = ray->leaving;
    rays->path_length[i] = ray->path_length;
    rays->least[i] = ray->least;
    rays->pixel[i] = ray->pixel;
    rays->point[i] = ray->point;
    rays->depth[i] = ray->depth;
    rays->passes[i] = ray->passes;
    rays->sight[i] = ray->sight;
    rays->scatters[i] = ray->scatters;
    rays->term[i] = ray->term;
    rays->active[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
    put_bit(rays->inward, i, ray->inward);
    put_bit(rays->blind, i, ray->blind);
    if (plan->transmits)
        rays->media[i] = ray->media;
}
