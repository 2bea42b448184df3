/// Light passes of faces and vertices: their light is cached for each group of lights, too.
#include "engine/render/effects/vertex_shading/shading_points.h"
#include "engine/render/light_groups/light_groups.h"

#include <float.h>

/// Returns the cached light of `group` for the faces and vertices of both sides. The picture's own light comes first.
static glint_shading_point_light *stored_light(const glint_tile_frame *frame, uint32_t group)
{
    const size_t each = 2 * (size_t)glint_shading_points_of(frame)->blocks * GLINT_SHADING_POINT_BLOCK;
    return glint_shading_points_of(frame)->light + (group + 1) * each;
}

void glint_groups_store_block(const glint_tile *tile, const glint_tile_frame *frame, uint32_t block)
{
    for (uint32_t g = 0; frame->plan->light_groups && g < frame->plan->light_groups->count; g++) {
        glint_shading_point_light *light = stored_light(frame, g) + (size_t)block * GLINT_SHADING_POINT_BLOCK;
        for (uint32_t i = 0; i < GLINT_SHADING_POINT_BLOCK; i++)
            for (int term = 0; term < 2; term++)
                for (int c = 0; c < 3; c++)
                    light[i].term[term][c] = (float)fmin(glint_group_sum(tile, g)[term][c][i], FLT_MAX);
    }
}

void glint_groups_spread(const glint_tile *tile, const glint_tile_frame *frame, glint_vertex_args *args)
{
    for (uint32_t g = 0; frame->plan->light_groups && g < frame->plan->light_groups->count; g++) {
        args->light[0] = stored_light(frame, g);
        args->light[1] = args->light[0] + (size_t)glint_shading_points_of(frame)->blocks * GLINT_SHADING_POINT_BLOCK;
        for (int term = 0; term < 2; term++)
            for (int c = 0; c < 3; c++)
                args->sum[term][c] = args->sum[term][c] ? glint_group_sum(tile, g)[term][c] : NULL;
        frame->stages->geometry[frame->plan->desc.precision].vertex(args);
    }
}
