/// Adaptive sampling: which pixels of a picture of one sample each are worth all samples. Internal.
///
/// A frame with it is two: a base, of one sample in the middle of each pixel, and of the pixels chosen here the frame with
/// all its samples. Each pixel has the bits of the one or of the other. The base is done before the choice begins, so that
/// no pixel's neighbours depend on tiles, threads or what was kept.
///
/// Two of eight neighbours are both chosen where they show two objects, or one and nothing; where their normals are more
/// than 25.8 degrees apart; or where the codes that they would be shown with differ, red, green and blue together, by more
/// than the threshold: as POV-Ray's +A does, in shares of the code for white, sRGB.
///
/// Through a lens a pixel of the base shows one point of it, and 4 x 4 neighbours all 16 that there are: what any of them see
/// otherwise is in the blur of all. So pixels are chosen as well that are up to GLINT_REFINE_SPREAD from such a pair.
#ifndef GLINT_REFINE_H
#define GLINT_REFINE_H

#include "engine/base/pool.h"
#include "engine/film/image.h"
#include "engine/plan/plan.h"

#define GLINT_REFINE_NORMAL 0.9f ///< cosine
#define GLINT_REFINE_SPREAD 2 ///< pixels, in every direction

typedef struct glint_refine {
    uint8_t *chosen; ///< a byte a pixel: whether it gets all samples
    uint8_t *below; ///< likewise: chosen for the sake of the row before
    size_t capacity; ///< of each
    float *rows; ///< codes of two rows, or their estimates, for each thread
    size_t row_capacity; ///< of these
    uint64_t count; ///< pixels chosen
} glint_refine;

/// Chooses among the pixels of `extent`. `base` was rendered as glint_plan_base describes, which is `desc`, with or without a lens. Any
/// number of threads gives the same.
glint_status glint_refine_choose(glint_refine *refine, const glint_image *base, const glint_extent *extent,
                                 const glint_render_desc *desc, double threshold, bool lens, glint_pool *pool,
                                 glint_error *error);
void glint_refine_clear(glint_refine *refine);

#endif
