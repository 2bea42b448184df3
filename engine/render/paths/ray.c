#include "engine/render/paths/ray.h"

#include <string.h>

void glint_rays_clear(glint_rays *rays, uint32_t group_count)
{
    rays->group_count = group_count;
    memset(rays->active, 0, group_count * sizeof *rays->active);
    memset(rays->inward, 0, group_count * sizeof *rays->inward);
    memset(rays->skip_emitters, 0, group_count * sizeof *rays->skip_emitters);
}
