/// One tile's walk through the stages of a plan. Internal.
#ifndef GLINT_TILE_H
#define GLINT_TILE_H

#include "engine/film/image.h"
#include "engine/film/tone.h"
#include "engine/render/adaptive/refine.h"
#include "engine/render/plan/plan.h"
#include "engine/render/reuse/reuse.h"

#include <string.h>

/// Invalid reflectances computed by patterns.
typedef struct glint_odd_pattern {
    uint64_t count;
    uint32_t material; ///< `material` and the next fields: of the result at the smallest point, by x, then y, then z
    int field;
    double point[3];
} glint_odd_pattern;

/// The invalid reflectances of each glint_odd_kind.
typedef struct glint_odd_patterns {
    glint_odd_pattern of[GLINT_ODD_COUNT];
} glint_odd_patterns;

/// Merge `more` into `to`.
void glint_odd_pattern_add(glint_odd_pattern *to, const glint_odd_pattern *more);
void glint_odd_patterns_add(glint_odd_patterns *to, const glint_odd_patterns *more);
/// Adds a point at which the outputs of a pattern, `step` numbers apart, are not all valid.
void glint_odd_patterns_note(glint_odd_patterns *to, const glint_odd_pattern *one, const double *outputs, size_t step, uint32_t count);
/// Returns the count over all kinds.
static inline uint64_t glint_odd_patterns_count(const glint_odd_patterns *odd)
{
    uint64_t count = 0;
    for (int kind = 0; kind < GLINT_ODD_COUNT; kind++)
        count += odd->of[kind].count;
    return count;
}

/// The counts of one worker in one frame.
typedef struct glint_tile_counts {
    uint64_t ns[GLINT_STAGE_COUNT], tile_ns;
    uint64_t primary, shadow, mirror, refraction, indirect, clipped, nonfinite;
    glint_work work;
    glint_odd_patterns odd;
    uint64_t runs[GLINT_STAGE_COUNT], reuses[GLINT_STAGE_COUNT]; ///< calls; results reused from earlier frames
} glint_tile_counts;

/// Adds every counter of `more`.
static inline void glint_work_add(glint_work *to, const glint_work *more)
{
    to->tests += more->tests;
    to->light_samples += more->light_samples;
    to->powers += more->powers;
    to->sites += more->sites;
    to->lights_seen += more->lights_seen;
    to->patterns += more->patterns;
    to->environment += more->environment;
    to->overlaps += more->overlaps;
}

#define GLINT_TILE_GRIDS 4 ///< maximum number of lights with a grid

/// Data shared by all tiles of a frame.
typedef struct glint_tile_frame {
    const glint_plan *plan;
    const glint_image *base; ///< adaptive sampling: the picture with one sample per pixel; otherwise NULL
    glint_refine *refine; ///< the pixels of the base that get all samples; for a base, the data to compare
    const glint_image *last; ///< the last picture, of the same format, or NULL
    glint_geometry_table geometry; ///< the plan's geometry, with its index
    const glint_light_grid *grids[GLINT_TILE_GRIDS]; ///< grids of some lights; NULL: that light has none
    uint32_t grid_count;
    const glint_stages *stages;
    glint_image *image;
    const glint_tone_table *tone_table; ///< NULL: no pixel values
    float gain; ///< factor of the exposure
    glint_reuse *reuse;
    const atomic_bool *cancelled; ///< the picture is cancelled and may be left unfinished
    bool time_stages, count_work;
    void *const *own; ///< what tiles read of each stage that has `begin`
    const glint_stage *caster; ///< the stage that finds the first hits; NULL: rays are cast
} glint_tile_frame;

/// One light's results for one sample of each pixel, when they are not cached.
typedef struct glint_tile_light {
    _Alignas(64) float cosine[GLINT_TILE_SAMPLES];
    _Alignas(64) float attenuation[GLINT_TILE_SAMPLES];
    _Alignas(64) float log2_specular[GLINT_TILE_SAMPLES];
    _Alignas(64) float visible[GLINT_TILE_SAMPLES];
    uint16_t lit[GLINT_TILE_GROUPS], unoccluded[GLINT_TILE_GROUPS];
} glint_tile_light;

/// One sample's results of the stages view and facet.
typedef struct glint_tile_facets {
    _Alignas(64) float facing[GLINT_TILE_SAMPLES];
    _Alignas(64) float sine2[GLINT_LIGHT_CHUNK][GLINT_TILE_SAMPLES], schlick[GLINT_LIGHT_CHUNK][GLINT_TILE_SAMPLES];
} glint_tile_facets;

/// Pointers to the results of the current sample: in the tile's own memory or in the cache.
typedef struct glint_tile_sample {
    void *t;
    uint32_t *prim;
    uint16_t *hits;
    const uint32_t *only; ///< the primitive that all hits have in common; NULL: unknown
    const glint_point_box *box; ///< box around the points; NULL: unknown
    const uint16_t *sampled; ///< the hits that are shaded per sample
    struct {
        float *cosine, *attenuation, *log2_specular;
        float *sine2, *schlick; ///< only in frames with microfacets, like `facing`
        uint16_t *lit, *unoccluded;
        float *visible; ///< for lights with caps
        float brightest; ///< the largest log2_specular of the sample, or of all samples
        bool summed; ///< for samples of an area light: only their sum is stored, in the cosine and log2_specular of the
            ///< first sample; `lit` and `unoccluded` of each sample are those of all samples
    } light[GLINT_LIGHT_CHUNK];
    float *facing;
    float *planes; ///< results of programs, see pattern/plan.h; NULL in frames without programs
} glint_tile_sample;

/// The rays of the current sample. Arrays of real have the size of doubles, here and below.
typedef struct glint_tile_rays {
    _Alignas(64) double origin[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double direction[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double across[GLINT_TILE_WIDTH / 4][3][GLINT_GROUP], down[GLINT_TILE_HEIGHT / 4][3][GLINT_GROUP];
} glint_tile_rays;

/// The first hits of the rays.
typedef struct glint_tile_hit {
    _Alignas(64) double t[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t prim[GLINT_TILE_SAMPLES];
    uint16_t mask[GLINT_TILE_GROUPS]; ///< lanes with a hit
    uint16_t back[GLINT_TILE_GROUPS], dark[GLINT_TILE_GROUPS];
} glint_tile_hit;

/// The surfaces at the hits.
typedef struct glint_tile_surface {
    _Alignas(64) double point[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double normal[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double slack[GLINT_TILE_SAMPLES]; ///< see glint_surface_args
    _Alignas(64) uint32_t material[GLINT_TILE_SAMPLES];
    glint_point_box box; ///< target of at.box
} glint_tile_surface;

/// Sums over the samples so far.
typedef struct glint_tile_film {
    _Alignas(64) double sum[GLINT_TERM_COUNT][3][GLINT_TILE_SAMPLES];
    _Alignas(64) float terms[GLINT_TERM_COUNT][3][GLINT_TILE_SAMPLES];
    _Alignas(64) float beauty[3][GLINT_TILE_SAMPLES];
    double covered[GLINT_TILE_SAMPLES]; ///< number of samples that hit something, minus their shares that reach the
        ///< background through surfaces; may be below 0. Only if the plan needs coverage
} glint_tile_film;

/// A worker's memory for one tile.
typedef struct glint_tile {
    glint_tile_rays rays;
    glint_tile_hit hit;
    glint_tile_surface surface;
    glint_tile_film film;
    glint_tile_light lights[GLINT_LIGHT_CHUNK];
    bool transparent; ///< the background adds no light: for the eye's own rays in a frame with alpha
    uint16_t active[GLINT_TILE_GROUPS]; ///< lanes whose rays are followed
    glint_camera_args camera; ///< camera of the current sample
    glint_lens lens; ///< target of camera.lens
    glint_cast_view view; ///< view of the frame's cameras
    uint32_t sample; ///< number of the current sample
    uint32_t boxed; ///< samples so far whose points are in the cached box
    uint32_t painted, cached_samples; ///< samples so far with programs run; samples with cached results of first parts
    glint_tile_sample at;
    size_t index; ///< index of the tile in the picture
    glint_cached_tile *cached; ///< NULL: nothing is cached for this tile
    bool direct; ///< the only sample gets light only from shade, without sums

    uint32_t x0, y0, width, height; ///< the part of the tile inside the image
    uint32_t group_count, groups_across;
    uint16_t own_light[GLINT_TILE_GROUPS]; ///< target of at.sampled in frames with the stage vertex
    _Alignas(64) uint32_t moved[GLINT_TILE_SAMPLES]; ///< for occlude: at.prim, or GLINT_MISS for points moved by a terminator
    const uint32_t *owner; ///< for occlude: the primitives that the points are on, for faces and vertices; NULL: the
        ///< primitives hit
    const void *viewed[3]; ///< for occlude: the rays that hit the points; NULL: the tile's rays
    void *own[GLINT_STAGE_COUNT]; ///< the memory of each stage; NULL until a frame needs it
    struct glint_samples *samples; ///< memory of tile/shade.c; NULL until a frame needs it
    uint32_t own_lights; ///< index of the current sample's first element in `lights`
    const struct glint_batch *batch; ///< the batch whose rays hit the samples; NULL: rays of the eye
    struct glint_gathered *gathered; ///< memory of adaptive/gather.c; NULL until a frame is adaptive
    struct glint_differ_work *differ; ///< memory of adaptive/differ.c; NULL until a frame is a base
    uint64_t clock; ///< end time of the last timed stage, ns
    glint_tile_counts counts;
    void *shadow_scratch; ///< scratch memory of occlude; owned; NULL until a frame has shadows of area lights
    struct glint_pattern *pattern; ///< memory of pattern/pattern.c; NULL in frames without programs
    double *unbumped[3]; ///< real: normals before bumps; NULL: no bumps
    uint32_t own_planes; ///< index of the current sample's planes among those of samples shaded together
} glint_tile;

static inline bool glint_has_lane(const uint16_t *mask, uint32_t i)
{
    return mask[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
}

/// Returns whether any of the groups, at most GLINT_TILE_GROUPS, has a lane.
static inline bool glint_has_lanes(const uint16_t *mask, uint32_t group_count)
{
    uint64_t any = 0, four;
    uint32_t g = 0;
    for (; g + 4 <= group_count; g += 4) {
        memcpy(&four, mask + g, sizeof four);
        any |= four;
    }
    for (; g < group_count; g++)
        any |= mask[g];
    return any;
}

/// Returns the current sample's own memory for the light in a slot.
static inline const glint_tile_light *glint_tile_own_light(const glint_tile *tile, uint32_t slot)
{
    return &tile->lights[tile->own_lights + slot];
}

/// The current sample of a tile on its walk through the stages.
typedef struct glint_sample_walk {
    uint32_t sample;
    bool rays, points; ///< `rays`, `points`: already computed
    bool patterns; ///< patterns are computed, or no visible material has patterns
    bool lit; ///< points and the result of the only light are computed, perhaps without normals
    bool centres; ///< the walk of the rays through the pixels' centres, which are not samples
    bool shows; ///< this walk's geometry is stored in the picture when normals are known
    bool any; ///< something is hit
    bool shines; ///< some hit is shaded per sample
    bool gathered; ///< the samples are those of gathered pixels
    uint32_t from, count; ///< the current chunk of the plan's light rows: its first row and its number of rows; at
        ///< GLINT_AT_LIGHT, `count` is the number of rows from `slot` on, in that chunk
    uint32_t slot;
    struct glint_batch *batch; ///< the secondary rays, at GLINT_AT_MISSED and GLINT_AFTER_SECONDARY
    double (*albedo)[GLINT_TILE_SAMPLES]; ///< channels of the pass albedo, at GLINT_AT_ALBEDO
} glint_sample_walk;

/// Compute the rays of the sample, and the surfaces, unless the walk has them.
void glint_tile_need_rays(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk);
void glint_tile_need_points(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk);

/// Calls the steps of all stages of the frame at a time of the walk.
static inline void glint_tile_step(glint_tile *tile, const glint_tile_frame *frame, glint_stage_time time, glint_sample_walk *walk)
{
    for (glint_stage_set bits = frame->plan->steps[time]; bits; bits &= bits - 1)
        glint_stage_table[__builtin_ctzll(bits)]->step[time](tile, frame, walk);
}

static inline bool glint_tile_cancelled(const glint_tile_frame *frame)
{
    return atomic_load_explicit(frame->cancelled, memory_order_relaxed);
}

/// tile/memory.c: allocates what this plan's stages need in addition. Returns false when out of memory.
bool glint_tile_extend(glint_tile *tile, const glint_plan *plan);
/// Allocates the memory of one stage, if it runs. Returns false when out of memory.
bool glint_tile_fit_stage(glint_tile *tile, const glint_plan *plan, glint_stage_id id);
void glint_tile_free_stage(glint_tile *tile, glint_stage_id id);
void glint_tile_destroy(glint_tile *tile); ///< NULL: nothing

/// tile/place.c: places the tile at a column and row of tiles. All its pixels inside the image become active.
void glint_tile_place_at(glint_tile *tile, const glint_plan *plan, uint32_t column, uint32_t row);
void glint_tile_activate(glint_tile *tile);

/// Renders tile (column, row) into the frame's image, and adds to tile->counts.
void glint_tile_render(glint_tile *tile, const glint_tile_frame *frame, uint32_t column, uint32_t row);

/// tile/cached.c: sets the results of the light in `slot` to the tile's own memory.
void glint_tile_use_own_light(glint_tile *tile, uint32_t slot);
/// Sets the results of sample k to cache memory if this frame stores or reads them there, otherwise to the tile's
/// own. Memory is allocated only at the first sample: all samples of a tile are cached, or none. Returns whether the
/// hits are known.
bool glint_tile_hit_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k);
/// Sets the results of light `light` of the plan, in `slot`, to cache memory in the same way.
void glint_tile_light_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k, uint32_t light, uint32_t slot,
                             bool *light_known, bool *occlude_known);
/// Sets the keys of the cached arrays. Called after the last sample, because the keys cover all samples.
void glint_tile_sign_cached(glint_tile *tile, const glint_tile_frame *frame);
/// Record for sample k: its materials, and whether it shows background; that it shows only background; whether a
/// light reaches any of its points, and the largest possible highlight there.
void glint_tile_note_surfaces(const glint_tile *tile, const glint_tile_frame *frame, uint32_t k);
void glint_tile_note_nothing(const glint_tile *tile, uint32_t k);
void glint_tile_note_light(const glint_tile *tile, uint32_t index, uint32_t slot, bool shadows, uint32_t k);
/// Adds `box`, which contains the current sample's points, to the cached box; NULL: there are no points.
void glint_tile_cache_box(glint_tile *tile, const glint_tile_frame *frame, const glint_point_box *box);
/// Returns whether the tile's pixels equal those of the last picture. They are then copied, unless this picture's
/// memory has them already.
bool glint_tile_is_unchanged(glint_tile *tile, const glint_tile_frame *frame);
/// The worker's counts before a tile.
typedef struct glint_film_counts {
    uint64_t clipped, nonfinite;
    uint64_t lights; ///< calls of the stage light
} glint_film_counts;
/// Sets the stamp of the tile's pixels. sampled: they have samples of this frame, not only of the base.
void glint_tile_sign_film(glint_tile *tile, const glint_tile_frame *frame, glint_film_counts before, bool sampled);

/// tile/cached.c: drops cached results of other pixels, from the second frame on with the same choice. In the first
/// such frame, and if pixels may be gathered, nothing is cached.
void glint_tile_fit_cached(glint_tile *tile, const glint_tile_frame *frame);
/// Prefetches the cached results of the first sample that the tile will read.
void glint_tile_prefetch(const glint_tile *tile, const glint_tile_frame *frame);

/// The following functions each call one stage for the current sample, and count it.
void glint_tile_aim(glint_tile *tile, const glint_tile_frame *frame, uint32_t sample);
void glint_tile_make_rays(glint_tile *tile, const glint_tile_frame *frame);
/// Returns false if no ray of the tile hits anything. Not counted.
bool glint_tile_in_sight(glint_tile *tile, const glint_tile_frame *frame);
/// Casts the rays, unless nothing is in sight.
void glint_tile_cast(glint_tile *tile, const glint_tile_frame *frame);
void glint_tile_find_surfaces(glint_tile *tile, const glint_tile_frame *frame);
/// Computes only points, for some of the hits, if all hits are spheres and planes.
void glint_tile_find_points(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *hits);
/// Computes surfaces and light number `light` of the plan, a plain one, in slot 0. Writes all normals only with
/// `normals`.
void glint_tile_find_lit_surfaces(glint_tile *tile, const glint_tile_frame *frame, uint32_t light, bool normals);
/// Returns whether a spot light certainly misses all points of the tile, by the box around them.
bool glint_tile_is_past_spot(const glint_tile *tile, const glint_plan_light *light);

/// Call the stage light or occlude for one light, samples of one, or similar lights: light `first + slot[i]` of the
/// plan, for each of `count` slots of the chunk.
void glint_tile_shine(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, const uint32_t *slot,
                      uint32_t count);
void glint_tile_occlude(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, const uint32_t *slot,
                        uint32_t count);
/// Return the arguments of these two stages.
glint_light_args glint_tile_light_args(glint_tile *tile, const glint_tile_frame *frame, uint32_t first,
                                       const uint32_t *slot, uint32_t count);
glint_occlude_args glint_tile_occlude_args(glint_tile *tile, const glint_tile_frame *frame, uint32_t first,
                                           const uint32_t *slot, uint32_t count);
/// tile/soft_shadow.c: computes light and shadow of all samples of a light together, in slots from
/// `slot` on, if only their sum is read. Returns whether that is so, and marks the slots. The points must be known.
bool glint_tile_sum_light(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, uint32_t slot,
                          uint32_t count);
/// Returns the arguments of shade except the outputs, for `count` lights of the plan from `from` on. Fills in the
/// lights and the planes, if there are any.
glint_shade_args glint_tile_shade_args(const glint_tile *tile, const glint_tile_frame *frame, uint32_t from,
                                       uint32_t count, glint_shade_light *lights, glint_shade_planes *planes);
/// For glint_stage.adds: true; `any`.
bool glint_tile_adds_anywhere(const glint_tile *tile, const glint_tile_frame *frame, bool any);
bool glint_tile_adds_to_hits(const glint_tile *tile, const glint_tile_frame *frame, bool any);
/// Sets pointers to the requested planes of the picture.
void glint_tile_point_film(glint_tile *tile, const glint_plan *plan, float *film[GLINT_TERM_COUNT][3],
                           float *beauty[3]);
void glint_tile_shade(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count);
void glint_tile_resolve(glint_tile *tile, const glint_tile_frame *frame);
/// tile/shade.c: for plans whose samples are shaded together. Store what shading needs of the current sample;
/// shade and resolve all samples after the last one.
struct glint_samples *glint_samples_create(void);
void glint_samples_destroy(struct glint_samples *samples);
void glint_tile_remember_sample(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count);
void glint_tile_resolve_samples(glint_tile *tile, const glint_tile_frame *frame);
/// Shades `samples` consecutive samples in the tile's groups; the first one is number `first` of its pixel: together,
/// or into the tile's sums; after the last sample resolves them. point_light: diffuse and specular light of faces and
/// vertices, one pixel's samples after another's, `count` pixels; NULL: none. beauty: the light of the pixels.
void glint_tile_shade_stacked(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count, uint32_t first,
                              uint32_t samples, const double (*point_light)[3][GLINT_TILE_SAMPLES], uint32_t count,
                              float *const beauty[3]);
/// Counts a stage's call and, when stages are timed, its time; `reused`: its result was in the cache.
void glint_tile_count_stage(glint_tile *tile, const glint_tile_frame *frame, glint_stage_id stage, bool reused);
uint64_t glint_tile_now_ns(void);

/// Finds the material of each hit, if the surfaces were not computed.
void glint_tile_name_materials(glint_tile *tile, const glint_tile_frame *frame);

/// tile/work.c: when work is counted, adds the work of evaluating one light, or `count` samples
/// of it, at every hit.
void glint_tile_count_light(glint_tile *tile, const glint_tile_frame *frame, uint32_t count);
/// Returns the counter for kernels' decisions; NULL: they are not counted.
static inline uint64_t *glint_tile_tests_of(glint_tile *tile, const glint_tile_frame *frame)
{
    return frame->count_work ? &tile->counts.work.tests : NULL;
}
void glint_tile_count_powers(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count);

/// Returns the lanes of a group whose rays see a light.
static inline uint16_t glint_tile_sees_lights(const glint_tile *tile, const glint_plan *plan, uint32_t group)
{
    const uint16_t *seen = tile->own[GLINT_STAGE_VISIBLE_LIGHT]; // starts with lanes that see a light
    return plan->runs[GLINT_STAGE_VISIBLE_LIGHT] && seen ? seen[group] : 0;
}
/// Returns whether ray i sees a light.
static inline bool glint_tile_sees_light(const glint_tile *tile, const glint_plan *plan, uint32_t i)
{
    return glint_tile_sees_lights(tile, plan, i / GLINT_GROUP) >> i % GLINT_GROUP & 1;
}

/// effects/environment/environment.c: a background computed by a program.
/// Returns whether some ray may leave the scene: then the tile's rays are needed.
bool glint_tile_sees_environment(const glint_tile *tile);

/// adaptive/differ.c: compares the stored pixels of a base, and keeps the pixels that neighbouring tiles
/// compare.
struct glint_differ_work *glint_differ_work_create(void);
void glint_differ_work_destroy(struct glint_differ_work *work); ///< NULL: nothing
/// Returns the buffer for object numbers and normals, in the order of groups.
static inline float *glint_differ_values(struct glint_differ_work *work, int value)
{
    return (float *)work + (size_t)value * GLINT_TILE_SAMPLES;
}
void glint_tile_prefetch_borders(const glint_tile *tile, const glint_refine *refine);
void glint_tile_compare(glint_tile *tile, const glint_tile_frame *frame, glint_film_counts before);

/// adaptive/gather.c: gathers the chosen pixels of a tile in their own groups.
struct glint_gathered *glint_gathered_create(void);
void glint_gathered_destroy(struct glint_gathered *gathered); ///< NULL: nothing
/// Returns whether light is local, and no stage depends on the position of a pixel in its group or tile.
bool glint_tile_may_gather(const glint_tile_frame *frame);
/// Lists the positions of the active pixels in the tile, if gathering pays and is possible in this frame. Returns
/// their number; 0: the pixels are not gathered.
uint32_t glint_tile_list_gathered(const glint_tile *tile, const glint_tile_frame *frame,
                                  uint16_t slots[GLINT_TILE_SAMPLES]);
/// Return the number of samples of gathered pixels that are walked together, and the largest number of pixels.
static inline uint32_t glint_tile_gathered_samples(const glint_plan *plan)
{
    const uint32_t samples = (uint32_t)plan->desc.samples, walks = (samples + GLINT_LIGHT_CHUNK - 1) / GLINT_LIGHT_CHUNK;
    return (samples + walks - 1) / walks;
}
static inline uint32_t glint_tile_most_gathered(const glint_plan *plan)
{
    return GLINT_TILE_GROUPS / glint_tile_gathered_samples(plan) * GLINT_GROUP;
}
/// Fills the groups of the tile with `samples` samples, from number `first` on, of `count` listed pixels, pixel by
/// pixel, and computes their rays.
void glint_tile_gather(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *slots, uint32_t count,
                       uint32_t first, uint32_t samples);
/// Returns the sums of the light of faces and vertices, diffuse and specular, for the samples gathered, and clears them.
double (*glint_tile_gathered_points(glint_tile *tile))[3][GLINT_TILE_SAMPLES];
/// After the other stages: shades the samples, and after the last one resolves them into their pixels. The tile is
/// then restored.
void glint_tile_shade_gathered(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count,
                               const uint16_t *slots, uint32_t count, uint32_t first, uint32_t samples);

/// adaptive/refine.c: returns whether some pixels of the tile get all samples.
bool glint_tile_has_chosen(const glint_tile *tile, const glint_tile_frame *frame);
/// Makes only the chosen pixels active. Returns whether there are any.
bool glint_tile_choose_refined(glint_tile *tile, const glint_tile_frame *frame);
/// Returns whether all pixels of the tile come from the base. The picture then has them.
bool glint_tile_is_base(glint_tile *tile, const glint_tile_frame *frame);
/// Copies the lanes that are not refined from a plane of the base (4-byte numbers) into an array of the tile.
void glint_tile_take_plane(const glint_tile *tile, const glint_tile_frame *frame, const void *plane, void *groups);
/// Copies the other pixels' light, and all pixels' geometry, from the base, and makes all pixels active.
void glint_tile_take_base(glint_tile *tile, const glint_tile_frame *frame);

/// Returns the lanes of group `g` inside an absorbing medium, whose light is tinted even without an occluder. The sample
/// is shaded.
static inline uint16_t glint_tile_dim_lanes(const glint_tile *tile, uint32_t g)
{
    return ((const uint16_t *)tile->own[GLINT_STAGE_TRANSPARENT_SHADOW])[g]; // the stage's memory begins with these lanes
}

/// tile/stages.c: computes the position of a light sample as seen from sample i. `scale`: see glint_light_args. Point (and normal
/// for GLINT_EMIT_CONE) must be known.
void glint_tile_sample_position(const glint_tile *tile, glint_precision precision,
                                const glint_light_sample *light_sample, double scale, uint32_t i, double out[3]);
/// Computes the target of sample i's ray to a light, relative to its point; for a directional light the direction.
void glint_tile_light_target(const glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light,
                             uint32_t i, double out[3]);

/// Returns whether origins and directions of rays are in arrays: for orthographic cameras, lenses
/// and batches.
static inline bool glint_tile_has_arrays(const glint_tile *tile)
{
    return tile->camera.orthographic || tile->camera.lens;
}

/// Returns the camera if the rays are not in arrays, otherwise NULL.
static inline const glint_camera_args *glint_tile_rays_of(const glint_tile *tile)
{
    return glint_tile_has_arrays(tile) ? NULL : &tile->camera;
}

/// Returns the sample pattern of an area light for the current sample of each pixel; NULL: not an area light.
static inline const glint_light_sample *glint_tile_light_sample_of(const glint_tile *tile,
                                                                   const glint_plan_light *light)
{
    return light->light_samples ? &light->light_samples[tile->sample % light->sample_set_count] : NULL;
}

/// Returns the index of pixel (x, y) in the tile's arrays.
static inline uint32_t glint_tile_slot(const glint_tile *tile, uint32_t x, uint32_t y)
{
    return ((y / 4) * tile->groups_across + x / 4) * GLINT_GROUP + y % 4 * 4 + x % 4;
}

/// Reads a number of an array of real.
static inline double glint_real_at(const void *array, glint_precision precision, uint32_t i)
{
    return precision == GLINT_PRECISION_FLOAT ? (double)((const float *)array)[i] : ((const double *)array)[i];
}
/// Returns whether all numbers of a group equal `number`.
static inline bool glint_all_are(const uint32_t of[GLINT_GROUP], uint32_t number)
{
    const uint64_t both = (uint64_t)number << 32 | number;
    uint64_t two, other = 0;
    for (int i = 0; i < GLINT_GROUP; i += 2) {
        memcpy(&two, of + i, sizeof two);
        other |= two ^ both;
    }
    return !other;
}
/// Returns the number of lanes.
static inline uint32_t glint_count_lanes(uint16_t lanes)
{
    return lanes == 0xffff ? GLINT_GROUP : (uint32_t)__builtin_popcount(lanes);
}
/// Reads the numbers of group g as doubles.
static inline void glint_reals_of(const void *array, glint_precision precision, uint32_t g, double out[GLINT_GROUP])
{
    const size_t at = (size_t)g * GLINT_GROUP;
    if (precision == GLINT_PRECISION_DOUBLE)
        memcpy(out, (const double *)array + at, GLINT_GROUP * sizeof *out);
    for (size_t i = 0; precision == GLINT_PRECISION_FLOAT && i < GLINT_GROUP; i++)
        out[i] = (double)((const float *)array)[at + i];
}
static inline void glint_real_put(void *array, glint_precision precision, uint32_t i, double x)
{
    if (precision == GLINT_PRECISION_FLOAT)
        ((float *)array)[i] = (float)x;
    else
        ((double *)array)[i] = x;
}

/// effects/derivative/derivative.c: how fast the light of the current sample changes with parameters. At the first
/// call of a sample, adds the part without lights; then the part of `count` lights of the plan from `from` on, whose
/// shadows must be known. The points must be known.
void glint_tile_derive(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count);
/// Called for light through transparent surfaces: before the first step of the rays; when ray `ray` crosses a
/// surface, where `share` and `transmitted` multiply channel c of the ray's colour; when the ray arrives at sample i;
/// and when the light in `slot` is added to samples.
void glint_tile_begin_tints(const glint_tile *tile, const glint_plan *plan);
void glint_tile_derive_tint(const glint_tile *tile, const glint_plan *plan, uint32_t material, uint32_t ray, int c,
                            double color, double share, double transmitted);
void glint_tile_put_tint(const glint_tile *tile, const glint_plan *plan, uint32_t i, uint32_t ray,
                         const double (*color)[GLINT_TILE_SAMPLES]);
void glint_tile_derive_tinted(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light, uint32_t slot,
                              const uint16_t *reached);
/// effects/derivative/vertex.c: stores the slopes of a block of faces and vertices; interpolates them for samples of
/// their triangles, after their light.
void glint_derive_store_block(const glint_tile *tile, const glint_tile_frame *frame, uint32_t block);
void glint_derive_vertex(const glint_tile *tile, const glint_tile_frame *frame, const uint16_t *wanted);
/// effects/derivative/fade.c: fades the derivatives after a sample of the eye's hits, if light fades.
void glint_derive_fade(glint_tile *tile, const glint_tile_frame *frame);
/// After the last sample: stores the derivatives in the image.
void glint_tile_store_derivatives(glint_tile *tile, const glint_tile_frame *frame);

/// tile/output.c: stores the finished tile in the image's planes and pixel values.
/// Copies an array of 4-byte numbers, in the order of the tile's groups, into a plane of the image.
void glint_tile_store_plane(const glint_tile *tile, const void *groups, void *plane, int stride);
/// Stores a pass, if the picture has it. `groups`: the channels one after the other, in the order of groups.
void glint_tile_store_pass(const glint_tile *tile, const glint_tile_frame *frame, glint_pass pass, const float *groups);
bool glint_tile_wants_geometry(const glint_plan *plan);
/// Returns a component of the direction of sample i's ray.
double glint_tile_direction(const glint_tile *tile, glint_precision precision, int c, uint32_t i);
/// Returns the distance at which ray i hits something or sees a light; infinite if it does neither.
double glint_tile_hit_distance(const glint_tile *tile, const glint_plan *plan, uint32_t i);
void glint_tile_store_geometry(glint_tile *tile, const glint_tile_frame *frame);
/// Fills the albedo of the hit of sample i. followed: without what a smooth mirror or smooth glass sends on. Reflectances
/// of translucent materials are divided by the opacity again; at an opacity of 0 they are 0. Returns the opacity.
double glint_tile_albedo(const glint_tile *tile, const glint_plan *plan, uint32_t i, bool followed, double color[3]);
bool glint_tile_wants_coverage(const glint_plan *plan);
/// Counts the hits of sample k, from 0.
void glint_tile_count_hits(glint_tile *tile, const glint_plan *plan, uint32_t k);
void glint_tile_store_light(glint_tile *tile, const glint_tile_frame *frame);
/// Prefetches the tile's pixel values and planes, which are written at its end; for planes of derivatives, prefetches
/// only the lines of group g, because a core stalls on too many outstanding requests.
void glint_tile_prefetch_output(const glint_tile *tile, const glint_tile_frame *frame);
void glint_tile_prefetch_derivatives(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g);
void glint_tile_tone(glint_tile *tile, const glint_tile_frame *frame);
/// Returns whether two pictures of one format have equal pixel values, if any, in the tile.
bool glint_tile_has_codes_of(const glint_tile *tile, const glint_image *a, const glint_image *b);
/// Copies the tile's pixels from another picture, as far as both have the same planes.
void glint_tile_copy(const glint_tile *tile, const glint_tile_frame *frame, const glint_image *from);

#endif
