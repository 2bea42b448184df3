/// A renderer, as the files see it that render with it: render.c, adaptive.c, stats.c. Internal.
#ifndef GLINT_FRAME_RENDERER_H
#define GLINT_FRAME_RENDERER_H

#include "engine/base/pool.h"
#include "engine/film/image.h"
#include "engine/film/tone.h"
#include "engine/frame/grids.h"
#include "engine/effects/adaptive/choose.h"
#include "engine/effects/transparent_shadow/plan.h"
#include "engine/reuse/reuse.h"
#include "engine/tile/tile.h"

#include <stdatomic.h>

/// Pictures whose memory a renderer holds on to, for a job with two in its queue: these, the one that is encoded and the one
/// that is rendered. A fifth would be new memory and a whole picture to copy or make each time.
#define GLINT_SPARE_IMAGES 4

#define GLINT_PICTURES_MAX 33 ///< that may be given again

/// A picture that is given again when a frame reads what it did.
typedef struct glint_picture {
    glint_image *image; ///< a reference; NULL: none
    glint_key key;
    glint_frame_stats stats;
    uint64_t used; ///< when it was given last
} glint_picture;

struct glint_renderer {
    glint_pool *pool;
    const glint_stages *stages;
    bool time_stages, count_work;
    atomic_bool cancelled;
    atomic_bool *stop; ///< its own `cancelled`; of a renderer of bases, that of its frames
    atomic_size_t tiles_done;
    atomic_size_t tile_count;
    glint_tile **tiles; ///< a tile's working memory for each worker
    glint_reuse reuse;
    glint_shading_points_cached shading_points;
    glint_raster raster;
    glint_tints tints; ///< of frames where what transmits tints shadows
    glint_grids own_grids, *grids; ///< a renderer of bases has those of its frames
    glint_picture pictures[GLINT_PICTURES_MAX]; ///< the last frame's; those set aside
    uint64_t pictures_given; ///< and set aside
    glint_recent recent; ///< keys of the last pictures
    /// Pictures given before, whose memory is used again once no other reference holds them.
    glint_image *spare[GLINT_SPARE_IMAGES];
    glint_refine own_refine, *refine; ///< a renderer of bases has that of its frames
    double refined_by[3]; ///< threshold, curve and exposure that the last base was compared by
    glint_key setting; ///< the plan's setting_key of the last frame that had a base
    /// Makes the pictures that adaptive sampling looks at, with the pool and the tiles of this one; NULL until a frame
    /// has it, and again after one that has not.
    struct glint_renderer *base;
    bool shares; ///< it is such a one: pool and tiles are another's
};

/// Renders a plan that is no mean of times into `image`, of its format and size. The caller owns all that is given.
/// base   of adaptive sampling: the picture of one sample a pixel, whose pixels have been compared; else NULL
/// table  of the plan's tone; NULL: there are no codes
/// Fails with GLINT_ERR_CANCELLED or GLINT_ERR_NOMEM; the image then holds parts of the frame.
glint_status glint_renderer_run(glint_renderer *renderer, const glint_plan *plan, glint_image *image, const glint_image *base,
                                const glint_tone_table *table, glint_frame_stats *stats, glint_error *error);

/// A picture to render into: one given before that has no other reference, or a new one. The caller releases it.
glint_status glint_renderer_take_image(glint_renderer *renderer, const glint_render_desc *desc, glint_image **out,
                                       glint_error *error);

/// adaptive.c: glint_renderer_run of a plan with a base: the base, then all samples of the pixels that are worth them.
glint_status glint_renderer_run_adaptive(glint_renderer *renderer, const glint_plan *plan, glint_image *image,
                                         const glint_tone_table *table, glint_frame_stats *stats, glint_error *error);

/// pictures.c: gives an earlier picture again when this frame's would be the same. False: there is none.
bool glint_picture_give(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats);
/// Makes the picture the last one, when it is among the spares.
void glint_picture_remember(glint_renderer *renderer, const glint_plan *plan, glint_image *image, const glint_frame_stats *stats);
void glint_pictures_clear(glint_renderer *renderer);

/// stats.c: what the tiles of a frame counted. wall_ms: from the first tile to the last.
void glint_renderer_collect(const glint_renderer *renderer, const glint_plan *plan, const glint_extent *extent, double wall_ms,
                            glint_frame_stats *out);
/// Pixels at the edges of shadows that a derivative's parameter moves, of a picture that has them.
uint64_t glint_count_shifted(const glint_image *image, const glint_extent *extent);

/// Milliseconds since a fixed moment.
double glint_frame_now_ms(void);

#endif
