/// The cache of a renderer, so that a frame runs only the stages whose inputs changed. Internal.
///
/// Every stage has a key of exactly the data that it reads (plan/keys.c). The result of a stage is cached per tile
/// once the last frame had the same key: a stage that differs in every frame is not worth the memory traffic. A
/// cached result is used if its key equals the plan's key. So a frame with reuse has the same bits as a frame without
/// reuse.
///
/// Each tile also has a key of everything its pixels depend on: only the materials that it shows and the lights that
/// reach it, without the highlight of a material if none is visible. If this key equals the key of the last frame,
/// the pixels are copied from the last picture.
///
/// Keys of stages after the geometry include all geometry. If little of it has changed, reuse/carry.c finds results
/// that cannot have changed, and gives them the new keys.
#ifndef GLINT_REUSE_H
#define GLINT_REUSE_H

#include "engine/film/image.h"
#include "engine/render/plan/plan.h"
#include "engine/render/reuse/splits.h"

#include <pthread.h>

#define GLINT_CACHED_LIGHTS 64 ///< largest number of lights whose results may be cached

/// The results of one light in a tile: for all samples of the tile, one after another. NULL arrays are not cached.
typedef struct glint_cached_light {
    glint_key light, occlude; ///< keys of the arrays below; all zero: they are empty
    float *cosine, *attenuation, *log2_specular; ///< three arrays in one block that begins at `cosine`
    uint16_t *lit;
    float cached_brightest; ///< the largest value in log2_specular
    uint16_t *unoccluded; ///< a separate block: bit masks of the lanes above the light's horizon that the light reaches
    float *visible; ///< a separate block: with caps, the visible share of the light, multiplied by the attenuation
    glint_key facet; ///< key of the arrays sine2 and schlick
    float *sine2, *schlick; ///< two arrays in a separate block that begins at `sine2`
    glint_key position; ///< key of the light's position and shadows when the following fields were computed; all
        ///< zero: never
    bool reaches; ///< whether the light reaches some lane
    float brightest; ///< the largest log2_specular of the lanes above the light's horizon, in shadow or not
} glint_cached_light;

#define GLINT_SHOWN_MAX 8 ///< largest number of materials that a tile distinguishes

typedef struct glint_cached_tile {
    uint64_t pixels; ///< adaptive sampling: identifies the pixels to which these results belong; 0: all pixels
    uint64_t last_pixels; ///< the last value of `pixels` in a frame in which the tile had some
    glint_key cast;
    void *t; ///< ray parameters of the hits, doubles or floats; in one block with prim and hits
    uint32_t *prim;
    uint16_t *hits;
    glint_key view;
    float *facing; ///< a separate block
    glint_key pattern;
    float *planes; ///< a separate block: the plan's planes of each sample, one sample after another
    glint_key split; ///< key of the results of the programs' first parts, in `values`
    void *values; ///< a separate block: glint_splits_bytes for each sample
    size_t value_bytes;
    glint_cached_light *lights;
    // what is known about the tile's pixels:
    glint_key seen; ///< key of the surfaces when the following fields were determined; all zero: never
    uint32_t shown[GLINT_SHOWN_MAX], shown_count; ///< indices of the materials in the tile; shown_count above
        ///< GLINT_SHOWN_MAX: there are too many, assume all
    uint32_t only; ///< the primitive that all rays hit; GLINT_MISS: several primitives or none
    glint_key boxed; ///< key of the surfaces when `box` was computed; all zero: never
    glint_point_box box; ///< bounding box of the points of all samples
    bool background; ///< whether some sample hits nothing
    bool shading_points; ///< whether some sample uses the light of a face or of vertices that is computed outside the
        ///< tile
    uint64_t clipped, nonfinite; ///< numbers of such pixels when the tile was last rendered
} glint_cached_tile;

/// The position of a primitive in the last frame.
typedef struct glint_cached_position {
    glint_key key; ///< hash of the position
    double center[3], radius; ///< bounding ball of the primitive; infinite radius: the primitive is unbounded
    uint32_t at; ///< index in the geometry's table; GLINT_MISS: not there, because an equal primitive comes first
} glint_cached_position;

typedef struct glint_reuse {
    bool on;
    bool is_eager; ///< hits are cached in the first frame with their key
    size_t budget;
    size_t pictures; ///< bytes reserved by glint_reuse_reserve
    size_t used; ///< bytes of the budget that tiles use
    pthread_mutex_t lock; ///< protects `used` and the following fields while a frame's workers make blocks
    void *chunk; ///< owned: the current chunk, which begins with a pointer to the previous one
    char *free; ///< the unused rest of the chunk
    size_t free_bytes;
    uint32_t width, height, samples, plane_count; ///< the layout of the cached arrays
    size_t real_size;
    bool plain; ///< value of glint_index.plain when the positions were stored: the order of the primitives
    glint_cached_tile *tiles;
    size_t tile_count;
    uint32_t light_count; ///< number of lights that each tile has slots for
    glint_key cast, pattern, view, light[GLINT_CACHED_LIGHTS]; ///< keys of the last frame
    glint_splits splits;
    glint_key where; ///< hash of the positions of surfaces in the last frame
    glint_cached_position *positions; ///< the positions of primitives, by id; owned; NULL: there were too many
    uint32_t position_count;
    /// Number of coming frames that do not record positions; length of the last such pause
    uint32_t carry_wait, carry_pause;
    double scale; ///< scale of the geometry's table when the results were computed
    // results with the same key as in the last frame, which this frame caches
    bool caches_cast, caches_pattern, caches_view, caches_light[GLINT_CACHED_LIGHTS];
} glint_reuse;

/// budget  bytes; 0: a quarter of the machine's memory.
void glint_reuse_init(glint_reuse *reuse, bool on, size_t budget);
void glint_reuse_clear(glint_reuse *reuse);
void glint_reuse_destroy(glint_reuse *reuse);
/// Before a frame: compares keys with the last frame's and makes the tiles' slots. Without memory, nothing is cached.
void glint_reuse_begin(glint_reuse *reuse, const glint_plan *plan, size_t tile_count);

/// Reserves `bytes` of the budget for memory other than the tiles' results: the renderer's images, and the light of
/// vertices and faces. Returns false if reuse is off, if too little is left, or if more than half would be reserved.
bool glint_reuse_reserve(glint_reuse *reuse, size_t bytes);
void glint_reuse_unreserve(glint_reuse *reuse, size_t bytes);

/// reuse/carry.c, before glint_reuse_begin: if a few primitives have moved since the last frame, gives the new plan's
/// keys to results that cannot have changed: in the tiles, and in the `film` of pictures of the same size (NULL
/// entries are skipped). The geometry must be arranged.
void glint_reuse_carry(glint_reuse *reuse, const glint_plan *plan, glint_image *const *images, uint32_t image_count);

/// Returns whether the tile's pixels may depend on surfaces that its primary rays do not hit: through mirrors,
/// transparent surfaces, indirect light, or light computed at points outside the tile.
bool glint_reuse_shows_more(const glint_cached_tile *tile, const glint_plan *plan);

/// Returns the key of a tile's pixels; all zero if the tile's contents are not known for this plan's surfaces.
glint_key glint_reuse_film_key(const glint_reuse *reuse, const glint_cached_tile *tile, const glint_plan *plan);

/// Allocate blocks for a tile at first use, within the budget. Return false if there is no memory. Any worker may
/// call them, but only one per tile.
bool glint_reuse_hold_cast(glint_reuse *reuse, glint_cached_tile *tile);
bool glint_reuse_hold_light(glint_reuse *reuse, glint_cached_light *light);
bool glint_reuse_hold_occlude(glint_reuse *reuse, glint_cached_light *light, bool caps);
bool glint_reuse_hold_planes(glint_reuse *reuse, glint_cached_tile *tile);
bool glint_reuse_hold_values(glint_reuse *reuse, glint_cached_tile *tile);
bool glint_reuse_hold_view(glint_reuse *reuse, glint_cached_tile *tile);
bool glint_reuse_hold_facet(glint_reuse *reuse, glint_cached_light *light);

#endif
