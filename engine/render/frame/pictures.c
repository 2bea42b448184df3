/// Pictures of earlier frames, returned again when a frame has the same inputs. A picture is stored once its key has
/// recurred. When there is no space, the picture that cost the fewest rays per byte is dropped, and among equal ones
/// the least recently returned: a large cheap picture goes before a small expensive one.
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
    const glint_key key = picture_key(plan);
    for (int i = 0; i < GLINT_PICTURES_MAX; i++) {
        glint_picture *picture = &renderer->pictures[i];
        if (!picture->image || !picture->image->codes != !plan->desc.codes || !glint_key_equal(picture->key, key))
            continue;
        picture->worth = renderer->picture_floor + picture->cost;
        *out = glint_image_retain(picture->image);
        if (stats)
            fill_stats(&picture->stats, stats);
        return true;
    }
    return false;
}

static void drop(glint_renderer *renderer, glint_picture *picture)
{
    if (picture->image && picture != &renderer->pictures[0])
        glint_reuse_unreserve(&renderer->reuse, glint_image_bytes(picture->image));
    glint_image_release(picture->image);
    picture->image = NULL;
}

static double cost_of(const glint_plan *plan, const glint_image *image)
{
    const glint_ray_counts rays = glint_plan_expected_rays(plan);
    return (double)(rays.primary + rays.shadow + rays.mirror + rays.refraction + rays.indirect) /
           (double)glint_image_bytes(image);
}

/// Reserves memory for a picture, and drops pictures of lower worth to make space. NULL: there is not enough memory.
static glint_picture *make_slot(glint_renderer *renderer, double worth, size_t bytes)
{
    for (;;) {
        glint_picture *slot = NULL, *least = NULL;
        for (int i = 1; i < GLINT_PICTURES_MAX; i++) {
            glint_picture *picture = &renderer->pictures[i];
            slot = picture->image ? slot : picture;
            least = picture->image && (!least || picture->worth < least->worth) ? picture : least;
        }
        if (slot && glint_reuse_reserve(&renderer->reuse, bytes))
            return slot;
        const bool fits = least && least->worth <= worth;
        renderer->picture_floor = fits ? least->worth : worth;
        if (!fits)
            return NULL;
        drop(renderer, least);
    }
}

/// Moves the last picture from the spare images to the stored ones, if the budget has space for it.
static void set_aside(glint_renderer *renderer, const glint_picture *last, int spare)
{
    const size_t bytes = glint_image_bytes(last->image);
    glint_picture *slot = make_slot(renderer, renderer->picture_floor + last->cost, bytes);
    if (!slot)
        return;
    *slot = *last;
    // the floor may have risen to the worth of the last dropped picture
    slot->worth = renderer->picture_floor + last->cost;
    glint_image_retain(slot->image);
    glint_reuse_unreserve(&renderer->reuse, bytes); // the spare image's memory was reserved already
    glint_image_release(renderer->spare[spare]);
    renderer->spare[spare] = NULL;
}

void glint_picture_remember(glint_renderer *renderer, const glint_plan *plan, glint_image *image,
                            const glint_frame_stats *stats)
{
    glint_picture *last = &renderer->pictures[0];
    int spare = -1;
    for (int i = 0; i < GLINT_SPARE_IMAGES; i++)
        spare = renderer->spare[i] == image ? i : spare;
    glint_image_release(last->image);
    last->image = NULL;
    if (!renderer->reuse.on || spare < 0)
        return;
    *last = (glint_picture) {
        .image = glint_image_retain(image), .key = picture_key(plan), .stats = *stats, .cost = cost_of(plan, image)
    };
    if (renderer->shares) // the counts of adaptive sampling belong to the last frame
        return;
    if (glint_recent_has(&renderer->recent, GLINT_PICTURES_MAX - 1, last->key))
        set_aside(renderer, last, spare);
}

void glint_pictures_clear(glint_renderer *renderer)
{
    for (int i = 0; i < GLINT_PICTURES_MAX; i++)
        drop(renderer, &renderer->pictures[i]);
}
