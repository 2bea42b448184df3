/// Functions of the renderer, shared by the files of this folder. Internal.
#ifndef GLINT_FRAME_RENDER_H
#define GLINT_FRAME_RENDER_H

#include "engine/base/pool.h"
#include "engine/film/image.h"
#include "engine/render/plan/plan.h"

glint_pool *glint_renderer_pool(const glint_renderer *renderer);

/// Renders one instant into an image of the whole frame's size, within the plan's extent. The image may be the
/// renderer's last image, so the caller must not write to it.
glint_status glint_render_instant(glint_renderer *renderer, const glint_plan *plan, glint_image **out,
                                  glint_frame_stats *stats, glint_error *error);

/// Writes the plan's cover, with the parts that surfaces hide. The plan must have one. The caller owns a reference, even
/// on failure unless *out is NULL.
glint_status glint_cover_hide(const glint_stages *stages, const glint_plan *plan, glint_cover **out, glint_error *error);

/// Adds the times, rays and work of another part of the frame. The stages are the stages of `to`; `share` of their
/// work belongs to the other part.
void glint_frame_stats_add(glint_frame_stats *to, const glint_frame_stats *more, double share);

#endif
