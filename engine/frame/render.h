/// What the files of a frame have of its renderer. Internal.
#ifndef GLINT_FRAME_RENDER_H
#define GLINT_FRAME_RENDER_H

#include "engine/base/pool.h"
#include "engine/film/image.h"
#include "engine/plan/plan.h"

glint_pool *glint_renderer_pool(const glint_renderer *renderer);

/// One instant, in an image of the whole frame's size, of which the plan's extent is rendered. The image may be the renderer's
/// last, too: it is not written to.
glint_status glint_render_instant(glint_renderer *renderer, const glint_plan *plan, glint_image **out,
                                  glint_frame_stats *stats, glint_error *error);

/// exposure.c: likewise of a plan that has `times`, in an image of its own.
glint_status glint_render_times(glint_renderer *renderer, const glint_plan *plan, glint_image **out,
                                glint_frame_stats *stats, glint_error *error);

/// Adds what another part of the frame took: times, rays, work. Stages are those of `to`, and `share` of what they did is of the
/// other part.
void glint_frame_stats_add(glint_frame_stats *to, const glint_frame_stats *more, double share);

#endif
