/// The picture of the last frame, returned again when a frame has the same inputs.
#include "engine/render/frame/renderer.h"

/// Returns the key of the whole picture or, if only a region is rendered, of that region.
static glint_key picture_key(const glint_plan *plan)
{
    const glint_stage_id last = plan->desc.codes ? GLINT_STAGE_TONE : GLINT_STAGE_RESOLVE;
    const glint_key key = plan->keys[plan->derivatives ? GLINT_STAGE_DERIVATIVE : last];
    return glint_key_add(key, plan->desc.region, sizeof plan->desc.region);
}

/// Fills in the statistics of a frame for which no stage ran.
static void fill_stats(const glint_frame_stats *of, glint_frame_stats *stats)
{
    *stats = (glint_frame_stats) { .stage_count = of->stage_count };
    stats->clipped = of->clipped;
    stats->pixels = of->pixels;
    stats->nonfinite = of->nonfinite;
    stats->refined = of->refined;
    stats->shifted = of->shifted;
    for (int i = 0; i < stats->stage_count; i++) {
        stats->stage_name[i] = of->stage_name[i];
        stats->stage_reused[i] = 1;
    }
}

bool glint_picture_give(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats)
{
    const glint_picture *last = &renderer->last;
    if (!last->image || !last->image->codes != !plan->desc.codes || !glint_key_equal(last->key, picture_key(plan)))
        return false;
    *out = glint_image_retain(last->image);
    if (stats)
        fill_stats(&last->stats, stats);
    return true;
}

void glint_picture_remember(glint_renderer *renderer, const glint_plan *plan, glint_image *image,
                            const glint_frame_stats *stats)
{
    bool is_spare = false;
    for (int i = 0; i < GLINT_SPARE_IMAGES; i++)
        is_spare = is_spare || renderer->spare[i] == image;
    glint_picture_forget(renderer);
    if (renderer->reuse.on && is_spare)
        renderer->last = (glint_picture) { .image = glint_image_retain(image), .key = picture_key(plan), .stats = *stats };
}

void glint_picture_forget(glint_renderer *renderer)
{
    glint_image_release(renderer->last.image);
    renderer->last.image = NULL;
}
