/// The renderer's structure, for the files that render: render.c, adaptive.c, stats.c. Internal.
#ifndef GLINT_FRAME_RENDERER_H
#define GLINT_FRAME_RENDERER_H

#include "engine/base/pool.h"
#include "engine/film/image.h"
#include "engine/film/tone.h"
#include "engine/glint_inspect.h"
#include "engine/render/adaptive/choose.h"
#include "engine/render/frame/grids.h"
#include "engine/render/reuse/reuse.h"
#include "engine/render/tile/tile.h"

#include <stdatomic.h>

/// Number of pictures whose memory a renderer reuses, for a job with two in its queue: these two, the one being
/// encoded and the one being rendered. A fifth picture would cost new memory, and a whole picture to copy or render
/// each time.
#define GLINT_SPARE_IMAGES 4

/// A picture that is returned again when the next frame has the same inputs.
typedef struct glint_picture {
    glint_image *image; ///< a reference, owned; NULL: none
    glint_key key;
    glint_frame_stats stats;
} glint_picture;

struct glint_renderer {
    glint_pool *pool;
    const glint_stages *stages;
    bool time_stages, count_work;
    atomic_bool cancelled;
    atomic_bool *stop; ///< the renderer's own `cancelled`; for a renderer of bases, the flag of the frame's renderer
    atomic_size_t tiles_done;
    atomic_size_t tile_count;
    glint_tile **tiles; ///< working memory for a tile, one for each worker
    glint_reuse reuse;
    void *own[GLINT_STAGE_COUNT]; ///< memory of each stage that has `begin`; NULL: not needed in the last frame
    double cast_ms; ///< time of finding hits before the tiles of the frame
    glint_grids own_grids, *grids; ///< a renderer of bases uses the grids of the frame's renderer
    glint_picture last; ///< the last frame's picture
    /// Earlier pictures, whose memory is reused when there is no other reference.
    glint_image *spare[GLINT_SPARE_IMAGES];
    glint_refine own_refine, *refine; ///< a renderer of bases uses the data of the frame's renderer
    double refined_by[3]; ///< threshold, curve and exposure of the last base's comparison
    glint_key setting; ///< setting_key of the last frame with a base
    /// Renders the bases of adaptive sampling, with the pool and the tiles of this renderer; NULL until a frame
    /// needs it, and again after a frame that does not.
    struct glint_renderer *base;
    bool shares; ///< true for a renderer of bases: its pool and tiles belong to another renderer
};

/// Renders a plan of one instant into `image`, which has its format and size. The caller owns all arguments.
/// base   adaptive sampling: the picture with one sample per pixel, already compared; otherwise NULL
/// table  table of the plan's tone curve; NULL: there are no pixel values
/// Fails with GLINT_ERR_CANCELLED or GLINT_ERR_NOMEM; the image then holds parts of the frame.
glint_status glint_renderer_run(glint_renderer *renderer, const glint_plan *plan, glint_image *image, const glint_image *base,
                                const glint_tone_table *table, glint_frame_stats *stats, glint_error *error);

/// Returns a picture to render into: an earlier one without other references, or a new one. The caller releases it.
glint_status glint_renderer_take_image(glint_renderer *renderer, const glint_render_desc *desc, glint_image **out,
                                       glint_error *error);

/// adaptive.c: does the same as glint_renderer_run for a plan with a base: renders the base, then all samples of the
/// pixels that need them.
glint_status glint_renderer_run_adaptive(glint_renderer *renderer, const glint_plan *plan, glint_image *image,
                                         const glint_tone_table *table, glint_frame_stats *stats, glint_error *error);

/// pictures.c: returns the last picture if this frame's would be the same. Returns false if it would not.
bool glint_picture_give(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats);
/// Stores the picture as the last one, if its image is one of the spare images.
void glint_picture_remember(glint_renderer *renderer, const glint_plan *plan, glint_image *image, const glint_frame_stats *stats);
void glint_picture_forget(glint_renderer *renderer);

/// stats.c: collects the counts of a frame's tiles. wall_ms: from the first tile to the last.
void glint_renderer_collect(const glint_renderer *renderer, const glint_plan *plan, const glint_extent *extent, double wall_ms,
                            glint_frame_stats *out);
/// Counts the pixels at edges that a derivative's parameter moves.
uint64_t glint_count_shifted(const glint_image *image, const glint_extent *extent);

/// Returns the milliseconds since a fixed moment.
double glint_frame_now_ms(void);

#endif
