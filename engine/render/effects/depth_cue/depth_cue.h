/// Light that fades with the distance from the eye. Internal.
#ifndef GLINT_DEPTH_CUE_H
#define GLINT_DEPTH_CUE_H

#include "engine/render/tile/tile.h"

/// The depth cue of a frame. All members are double: the key is made of its bytes.
typedef struct glint_plan_depth_cue {
    double color[3], near, far; ///< see glint_scene_desc
} glint_plan_depth_cue;

/// Returns the depth cue; NULL: none. The light may fade even so, in a medium around the eye.
static inline const glint_plan_depth_cue *glint_plan_depth_cue_of(const glint_plan *plan)
{
    return plan->own[GLINT_STAGE_DEPTH_CUE];
}

#endif
