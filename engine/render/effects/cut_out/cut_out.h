/// Cut-outs: surfaces have holes where the opacity of their material is below one half. Internal.
#ifndef GLINT_PATTERN_CUT_OUT_H
#define GLINT_PATTERN_CUT_OUT_H

#include "engine/render/pattern/pattern.h"


/// Finds the points on surfaces that are in holes, one bit per lane.
void glint_tile_find_holes(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points,
                           uint16_t *holes);

#endif
