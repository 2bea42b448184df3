/// What is kept of a frame, so that later ones run only the stages whose inputs changed. Internal.
///
/// Every stage has a key of exactly what it reads (plan/keys.c). A result is kept per tile from the second frame on that
/// has its key, the last frame's or one of some frames before: a stage that differs in every frame is not worth the memory it
/// would write. A kept result is used where its key equals the plan's, so the reused frame has the fresh frame's bits.
///
/// A tile as a whole has a key too, of what its pixels were made from: the materials it shows and the lights that reach
/// it, and no others; of a material that no highlight shows on, its highlight neither. Where that is the last frame's, its
/// pixels are copied from the last picture.
///
/// Keys of what follows the geometry hold all of it. Where little of it has changed, reuse/carry.c finds what that cannot
/// have touched, and gives it the new keys.
#ifndef GLINT_REUSE_H
#define GLINT_REUSE_H

#include "engine/film/image.h"
#include "engine/plan/plan.h"
#include "engine/reuse/splits.h"

#include <pthread.h>

#define GLINT_CACHED_LIGHTS 64 ///< lights of a frame whose results may be kept

/// What one light left in a tile, all its samples one after the other. NULL: not kept.
typedef struct glint_cached_light {
    glint_key light, occlude; ///< of what is in the arrays; all zero: nothing yet
    float *cosine, *attenuation, *log2_specular; ///< in one block, cosine first
    uint16_t *lit;
    float cached_brightest; ///< the largest log2_specular there
    uint16_t *open; ///< its own block: lit lanes that the light reaches
    float *visible; ///< its own block: by caps, how far, with the attenuation
    glint_key facet; ///< of what is in the next
    float *sine2, *schlick; ///< a block of their own, sine2 first
    glint_key place; ///< the light's place and shadows when the following was found; all zero: never
    bool reaches; ///< some lane
    float brightest; ///< the largest log2_specular of those lit, in shadow or not
} glint_cached_light;

/// What a tile's frame took with kept hits and with new ones.
typedef struct glint_cached_ways {
    uint32_t turn; ///< frames so far in which it could go either way
    float least[2]; ///< ns, of those that were timed: with kept hits, with new ones
} glint_cached_ways;

#define GLINT_SHOWN_MAX 8 ///< materials of a tile that are told apart

typedef struct glint_cached_tile {
    uint64_t pixels; ///< of adaptive sampling: those whose samples all of this is of; 0: of all
    uint64_t last_pixels; ///< the same of the last frame in which it had some
    glint_key cast;
    void *t; ///< doubles or floats; in one block with prim and hits
    uint32_t *prim;
    uint16_t *hits;
    glint_cached_ways ways;
    glint_key view;
    float *facing; ///< its own block
    glint_key pattern;
    float *planes; ///< its own block: of each sample the plan's planes, one after the other
    glint_key split; ///< of what the first parts of programs gave:
    void *values; ///< its own block: of each sample what glint_splits_bytes says
    size_t value_bytes;
    glint_cached_light *lights;
    // what the tile's pixels show, as far as known
    glint_key seen; ///< the surfaces' key when that was found; all zero: never
    uint32_t shown[GLINT_SHOWN_MAX], shown_count; ///< materials; more than GLINT_SHOWN_MAX: all of them
    uint32_t only; ///< the primitive of all hits; GLINT_MISS: they have several, or there are none
    glint_key boxed; ///< the surfaces' key when `box` was found; all zero: never
    glint_point_box box; ///< of the points of all samples
    bool background; ///< some sample hits nothing
    bool shading_points; ///< some sample has the light of a face or of vertices, which are not all in the tile
    uint64_t clipped, nonfinite; ///< pixels, when the tile was last run
} glint_cached_tile;

/// Where a primitive of the last frame was.
typedef struct glint_cached_place {
    glint_key key; ///< of its place
    double center[3], radius; ///< a ball around it; infinite: it has no end
    uint32_t at; ///< in the geometry's table; GLINT_MISS: it was like another
} glint_cached_place;

#define GLINT_EARLIER_MAX 64 ///< results of each light that may be set aside
#define GLINT_EARLIER_TILES 8 ///< the same of whole tiles

/// The keys of the last frames that had others than the frame before.
typedef struct glint_recent {
    glint_key keys[GLINT_EARLIER_MAX];
    size_t next;
} glint_recent;

/// Lights of all tiles as they were in an earlier frame.
typedef struct glint_earlier_set {
    glint_cached_light *lights; ///< owned: tile after tile; NULL: not made yet
    glint_key held[GLINT_CACHED_LIGHTS]; ///< keys of what is in each; all zero: nothing of use
    uint64_t used[GLINT_CACHED_LIGHTS]; ///< when it was set aside
} glint_earlier_set;

/// All tiles as they were in an earlier frame.
typedef struct glint_earlier_tiles {
    glint_cached_tile *tiles; ///< owned; NULL: not made yet
    glint_key cast, light[GLINT_CACHED_LIGHTS]; ///< as of the reuse
    bool light_recurs[GLINT_CACHED_LIGHTS];
    uint64_t used; ///< when they were set aside
} glint_earlier_tiles;

/// What is set aside of frames before the last, see reuse/earlier.c.
typedef struct glint_earlier {
    uint64_t frame; ///< exchanges so far
    glint_recent casts, lights[GLINT_CACHED_LIGHTS];
    glint_earlier_set sets[GLINT_EARLIER_MAX];
    glint_earlier_tiles tiles[GLINT_EARLIER_TILES];
} glint_earlier;

typedef struct glint_reuse {
    bool on;
    glint_hits_choice hits;
    size_t budget;
    size_t pictures; ///< bytes of the budget that whole pictures have, see glint_reuse_reserve
    size_t used; ///< bytes of it that the tiles have
    pthread_mutex_t lock; ///< of `used` and of the following, while a frame's workers make blocks
    void *chunk; ///< owned: the last piece of memory that blocks were cut from; it begins with the one before
    char *free; ///< what is left of it
    size_t free_bytes;
    uint32_t width, height, samples, plane_count; ///< the layout of what is kept
    size_t real_size;
    bool plain; ///< order of the primitives, whose places are kept
    glint_cached_tile *tiles;
    size_t tile_count;
    uint32_t light_count; ///< slots in each tile
    glint_key cast, pattern, view, light[GLINT_CACHED_LIGHTS]; ///< of the last frame
    bool cast_recurs, light_recurs[GLINT_CACHED_LIGHTS]; ///< it had them some frames before
    glint_earlier *earlier; ///< owned; NULL: nothing
    glint_splits splits;
    glint_key where; ///< of the places of the last frame's surfaces, and
    glint_cached_place *places; ///< these, by id; owned; NULL: there were too many
    uint32_t place_count;
    uint32_t carry_wait, carry_pause; ///< frames whose places are not found, of those to come; how many after the last great change
    double scale; ///< of the geometry's table
    // which results this frame has in common with the last, and therefore keeps
    bool keep_cast, keep_pattern, keep_view, keep_light[GLINT_CACHED_LIGHTS];
} glint_reuse;

/// budget  bytes; 0: a quarter of the machine's memory.
void glint_reuse_init(glint_reuse *reuse, bool on, size_t budget, glint_hits_choice hits);
void glint_reuse_clear(glint_reuse *reuse);
void glint_reuse_destroy(glint_reuse *reuse);
/// Before a frame: compares keys with the last frame's and makes the tiles' slots. Without memory nothing is kept.
void glint_reuse_begin(glint_reuse *reuse, const glint_plan *plan, size_t tile_count);

/// Takes `bytes` of the budget for a picture that is kept as a whole; at most half of it goes to pictures.
bool glint_reuse_reserve(glint_reuse *reuse, size_t bytes);
void glint_reuse_unreserve(glint_reuse *reuse, size_t bytes);

/// reuse/carry.c, before glint_reuse_begin: where a few primitives have moved since the last frame, gives the new plan's keys
/// to what that cannot have changed, in the tiles and in the `film` of pictures of their size (NULL among them are passed
/// over). The geometry is arranged.
void glint_reuse_carry(glint_reuse *reuse, const glint_plan *plan, glint_image *const *images, uint32_t image_count);

/// Whether a key is among the last `size`, at most GLINT_EARLIER_MAX, which it joins.
bool glint_recent_has(glint_recent *recent, size_t size, glint_key key);

/// reuse/earlier.c, of glint_reuse_begin: finds the tiles of the frame's hits among earlier frames, and with them its lights' keys.
/// Returns whether hits are kept.
bool glint_earlier_tiles_found(glint_reuse *reuse, glint_key key);
/// The same of each light, whose key and whether it is kept it fills.
void glint_earlier_lights(glint_reuse *reuse, const glint_plan *plan);
void glint_earlier_clear(glint_reuse *reuse);

/// Whether the tile's pixels may show what it does not hit itself: by mirrors, through what is transparent, by its
/// light, or as light that was worked out at points beside it.
bool glint_reuse_shows_more(const glint_cached_tile *tile, const glint_plan *plan);

/// The key of a tile's pixels, from what is known of it; all zero where that is not of this plan's surfaces.
glint_key glint_reuse_film_key(const glint_reuse *reuse, const glint_cached_tile *tile, const glint_plan *plan);

/// Blocks for a tile, made at first use within the budget. False: do without. Any worker, one at a time for a tile.
bool glint_reuse_hold_cast(glint_reuse *reuse, glint_cached_tile *tile);
bool glint_reuse_hold_light(glint_reuse *reuse, glint_cached_light *light);
bool glint_reuse_hold_occlude(glint_reuse *reuse, glint_cached_light *light, bool caps);
bool glint_reuse_hold_planes(glint_reuse *reuse, glint_cached_tile *tile);
bool glint_reuse_hold_values(glint_reuse *reuse, glint_cached_tile *tile);
bool glint_reuse_hold_view(glint_reuse *reuse, glint_cached_tile *tile);
bool glint_reuse_hold_facet(glint_reuse *reuse, glint_cached_light *light);

#endif
