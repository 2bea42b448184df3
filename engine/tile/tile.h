/// One tile's walk through the stages of a plan. Internal.
#ifndef GLINT_TILE_H
#define GLINT_TILE_H

#include "engine/film/image.h"
#include "engine/film/tone.h"
#include "engine/plan/plan.h"
#include "engine/reuse/reuse.h"
#include "engine/effects/raster/plan.h"
#include "engine/effects/adaptive/refine.h"
#include "engine/effects/vertex_shading/shading_points.h"

#include <string.h>

/// Results of patterns that are no reflectances.
typedef struct glint_odd_pattern {
    uint64_t count;
    uint32_t material; ///< of one of them, and the following: that at the least point, by x, then y, then z
    int field;
    double point[3];
} glint_odd_pattern;

/// The same of each glint_odd_kind.
typedef struct glint_odd_patterns {
    glint_odd_pattern of[GLINT_ODD_COUNT];
} glint_odd_patterns;

/// Adds some to others.
void glint_odd_pattern_add(glint_odd_pattern *to, const glint_odd_pattern *more);
void glint_odd_patterns_add(glint_odd_patterns *to, const glint_odd_patterns *more);
/// Adds a point at which the outputs of a pattern, `step` numbers from one to the next, are not all fit to be taken.
void glint_odd_patterns_note(glint_odd_patterns *to, const glint_odd_pattern *one, const double *outputs, size_t step, uint32_t count);
/// Of all kinds.
static inline uint64_t glint_odd_patterns_count(const glint_odd_patterns *odd)
{
    uint64_t count = 0;
    for (int kind = 0; kind < GLINT_ODD_COUNT; kind++)
        count += odd->of[kind].count;
    return count;
}

/// What one worker counted in one frame.
typedef struct glint_tile_counts {
    uint64_t ns[GLINT_STAGE_COUNT], tile_ns;
    uint64_t primary, shadow, mirror, refraction, indirect, clipped, nonfinite;
    glint_work work;
    glint_odd_patterns odd;
    uint64_t runs[GLINT_STAGE_COUNT], reuses[GLINT_STAGE_COUNT]; ///< calls made, and results taken from the last frame
    uint64_t ways[2]; ///< tiles whose hits are known and whose points are needed: those that read the hits; that find them anew
    uint64_t compared; ///< of these, the ones that have gone both ways
    double way_ns[2]; ///< the least that those took each way, summed
} glint_tile_counts;

/// Adds every count of `more`.
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

#define GLINT_TILE_GRIDS 4 ///< lights that have a grid, at most

/// What all tiles of a frame share.
typedef struct glint_tile_frame {
    const glint_plan *plan;
    const glint_image *base; ///< adaptive sampling: the picture of one sample a pixel; else NULL
    glint_refine *refine; ///< which pixels of it all samples are taken of; of a base, what is compared
    const glint_image *last; ///< the last picture, of the same format, or NULL
    glint_geometry_table geometry; ///< the plan's, with its index
    const glint_light_grid *grids[GLINT_TILE_GRIDS]; ///< of some lights; NULL: that light has none
    uint32_t grid_count;
    const glint_stages *stages;
    glint_image *image;
    const glint_tone_table *tone_table; ///< NULL: no codes
    float gain; ///< of the exposure
    glint_reuse *reuse;
    const atomic_bool *cancelled; ///< the picture is given up: what is begun may be left unfinished
    bool time_stages, count_work;
    glint_shading_points_cached *shading_points; ///< for the stage vertex
    const glint_raster *raster; ///< NULL: everything is cast
    const struct glint_tints *tints; ///< where what transmits is, in frames where that tints shadows; else NULL
} glint_tile_frame;

/// One light's results for one sample of each pixel, when they are not kept.
typedef struct glint_tile_light {
    _Alignas(64) float cosine[GLINT_TILE_SAMPLES];
    _Alignas(64) float attenuation[GLINT_TILE_SAMPLES];
    _Alignas(64) float log2_specular[GLINT_TILE_SAMPLES];
    _Alignas(64) float visible[GLINT_TILE_SAMPLES];
    uint16_t lit[GLINT_TILE_GROUPS], open[GLINT_TILE_GROUPS];
} glint_tile_light;

/// The same of the stages view and facet.
typedef struct glint_tile_facets {
    _Alignas(64) float facing[GLINT_TILE_SAMPLES];
    _Alignas(64) float sine2[GLINT_LIGHT_CHUNK][GLINT_TILE_SAMPLES], schlick[GLINT_LIGHT_CHUNK][GLINT_TILE_SAMPLES];
} glint_tile_facets;

/// Where the results of the current sample are: in the tile's own memory or in what is kept between frames.
typedef struct glint_tile_sample {
    void *t;
    uint32_t *prim;
    uint16_t *hits;
    const uint32_t *only; ///< the primitive of all hits, where they have one; NULL: not known
    const glint_point_box *box; ///< of the points, NULL: not known
    const uint16_t *sampled; ///< of these, the lanes whose light is worked out for themselves
    struct {
        float *cosine, *attenuation, *log2_specular;
        float *sine2, *schlick; ///< only in frames with microfacets, as `facing`
        uint16_t *lit, *open;
        float *visible; ///< of lights with caps
        float brightest; ///< the largest log2_specular of the sample, or of all
        bool summed; ///< of samples of an area light: their sum alone is there, in place of the first's cosine and
            ///< log2_specular, and each has the `lit` and `open` of all
    } light[GLINT_LIGHT_CHUNK];
    float *facing;
    float *planes; ///< what programs gave, see effects/pattern/plan.h; NULL in frames without
} glint_tile_sample;

/// The rays of the current sample. Arrays of real are as long as doubles need, here and below.
typedef struct glint_tile_rays {
    _Alignas(64) double origin[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double direction[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double across[GLINT_TILE_WIDTH / 4][3][GLINT_GROUP], down[GLINT_TILE_HEIGHT / 4][3][GLINT_GROUP];
} glint_tile_rays;

/// What they meet first.
typedef struct glint_tile_hit {
    _Alignas(64) double t[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t prim[GLINT_TILE_SAMPLES];
    uint16_t mask[GLINT_TILE_GROUPS]; ///< lanes that meet anything
    uint16_t back[GLINT_TILE_GROUPS], dark[GLINT_TILE_GROUPS];
} glint_tile_hit;

/// The surface there.
typedef struct glint_tile_surface {
    _Alignas(64) double point[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double normal[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double slack[GLINT_TILE_SAMPLES]; ///< see glint_surface_args
    _Alignas(64) uint32_t material[GLINT_TILE_SAMPLES];
    glint_point_box box; ///< what at.box points to
} glint_tile_surface;

/// What the samples so far add up to.
typedef struct glint_tile_film {
    _Alignas(64) double sum[GLINT_TERM_COUNT][3][GLINT_TILE_SAMPLES];
    _Alignas(64) float terms[GLINT_TERM_COUNT][3][GLINT_TILE_SAMPLES];
    _Alignas(64) float beauty[3][GLINT_TILE_SAMPLES];
    double covered[GLINT_TILE_SAMPLES]; ///< how many samples hit something, less the shares of them that reach the background through
        ///< surfaces; may be below 0. Only if the plan needs coverage
} glint_tile_film;

/// A worker's memory for one tile.
typedef struct glint_tile {
    glint_tile_rays rays;
    glint_tile_hit hit;
    glint_tile_surface surface;
    glint_tile_film film;
    glint_tile_light lights[GLINT_LIGHT_CHUNK];
    bool transparent; ///< where nothing is hit, nothing is seen: the eye's own rays of a frame with alpha
    uint16_t active[GLINT_TILE_GROUPS]; ///< lanes whose rays are followed
    glint_camera_args camera; ///< of the current sample
    glint_lens lens; ///< what camera.lens points to
    glint_cast_view view; ///< of the frame's cameras
    uint32_t sample; ///< which it is
    uint32_t boxed; ///< samples so far whose points are in the kept box
    uint32_t painted, kept; ///< samples so far that programs were run of; of which the values of their first parts are kept
    glint_tile_sample at;
    size_t index; ///< of the tile in the picture
    glint_cached_tile *cached; ///< NULL: nothing is kept for this tile
    bool anew; ///< its hits are found, though they are kept
    bool timed; ///< this frame's time tells whether that is quicker
    bool direct; ///< its only sample gets no light but what shade makes, without sums
    uint64_t begun; ///< of such a frame

    uint32_t x0, y0, width, height; ///< of the part of the tile inside the image
    uint32_t group_count, groups_across;
    uint16_t own_light[GLINT_TILE_GROUPS]; ///< what at.sampled points to in frames with the stage vertex
    const uint32_t *owner; ///< for occlude: the primitives that points are on, of faces and vertices; NULL: those that were hit
    const void *viewed[3]; ///< for occlude: the rays that found the points; NULL: the tile's
    void *own[GLINT_STAGE_COUNT]; ///< the memory of each stage; NULL until a frame needs it
    struct glint_samples *samples; ///< memory of tile/shade.c; likewise
    uint32_t own_lights; ///< the first of `lights` that is the current sample's
    const struct glint_batch *batch; ///< whose rays found the samples; NULL: the eye's did
    struct glint_raster_rest *raster_rest; ///< of effects/raster/raster.c: what is cast because it is no triangle; likewise
    struct glint_gathered *gathered; ///< of effects/adaptive/gather.c; NULL until a frame is adaptive
    struct glint_differ_work *differ; ///< of effects/adaptive/differ.c; NULL until a frame is a base
    uint64_t clock; ///< end of the last timed stage, ns
    glint_tile_counts counts;
    void *shadow_room; ///< of occlude; owned; NULL until a frame has shadows of area lights
    struct glint_pattern *pattern; ///< memory of effects/pattern/pattern.c; NULL in frames without programs
    struct glint_group_sums *group_sums; ///< of effects/light_groups/; NULL in frames without light passes; of a batch the tile's
    double *unbumped[3]; ///< real: the normals that bumps have turned, as they were; NULL: there are no bumps
    uint32_t own_planes; ///< of the planes that samples have which are shaded together, the current sample's
} glint_tile;

static inline bool glint_has_lane(const uint16_t *mask, uint32_t i)
{
    return mask[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
}

/// Whether any of the groups, GLINT_TILE_GROUPS at most, has a lane.
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

/// The current sample's own memory for the light in a slot.
static inline const glint_tile_light *glint_tile_own_light(const glint_tile *tile, uint32_t slot)
{
    return &tile->lights[tile->own_lights + slot];
}

/// The current sample of a tile, on its way through the stages.
typedef struct glint_sample_walk {
    uint32_t sample;
    bool rays, points; ///< made already
    bool patterns; ///< known, or nothing in sight has any
    bool lit; ///< points and the only light's work are made, maybe without normals
    bool centres; ///< of the rays through the pixels' centres, which are no samples
    bool shows; ///< its geometry is the picture's, and is stored when normals are known
    bool any; ///< something is hit
    bool shines; ///< of that, some point takes light for itself
    uint32_t from, count; ///< the rows of the plan's lights that are looked at: the chunk; GLINT_AT_LIGHT: those in `count` slots from
        ///< `slot` on, of the chunk from `from` on
    uint32_t slot;
} glint_sample_walk;

/// Makes the rays of the sample, and finds the surfaces there, unless the walk has them.
void glint_tile_need_rays(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk);
void glint_tile_need_points(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk);

/// Calls the steps that the stages of the frame take at a time.
static inline void glint_tile_step(glint_tile *tile, const glint_tile_frame *frame, glint_stage_time time, glint_sample_walk *walk)
{
    for (uint32_t left = frame->plan->steps[time]; left; left &= left - 1)
        glint_stage_table[__builtin_ctz(left)]->step[time](tile, frame, walk);
}

static inline bool glint_tile_cancelled(const glint_tile_frame *frame)
{
    return atomic_load_explicit(frame->cancelled, memory_order_relaxed);
}

/// tile/memory.c: makes what this plan's stages need beside the tile. False: out of memory.
bool glint_tile_extend(glint_tile *tile, const glint_plan *plan);
/// The memory of one stage, if it runs. False: out of memory.
bool glint_tile_fit_stage(glint_tile *tile, const glint_plan *plan, glint_stage_id id);
void glint_tile_free_stage(glint_tile *tile, glint_stage_id id);
void glint_tile_destroy(glint_tile *tile); ///< NULL: nothing

/// tile/place.c: puts the tile at a column and row of tiles. All its pixels that the image has are active.
void glint_tile_place_at(glint_tile *tile, const glint_plan *plan, uint32_t column, uint32_t row);
void glint_tile_activate(glint_tile *tile);

/// Renders tile (column, row) into the frame's image, and adds to tile->counts.
void glint_tile_render(glint_tile *tile, const glint_tile_frame *frame, uint32_t column, uint32_t row);

/// tile/cached.c: points the results of the light in `slot` at the tile's own memory.
void glint_tile_use_own_light(glint_tile *tile, uint32_t slot);
/// Points the results of sample k at kept memory where this frame keeps them or has them, else at the tile's
/// own. Memory is allocated at the first sample alone: all samples of a tile are kept, or none. Returns whether the hits are
/// known.
bool glint_tile_hit_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k);
/// The same of light `light` of the plan, in `slot`.
void glint_tile_light_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k, uint32_t light, uint32_t slot,
                             bool *light_known, bool *occlude_known);
/// Writes down what the kept arrays hold now. After the last sample, since the keys cover all of them.
void glint_tile_sign_cached(glint_tile *tile, const glint_tile_frame *frame);
/// Notes a sample's materials, and whether there is background among it; the latter where nothing is hit; whether a light
/// reaches any point of a sample, and the most that its highlights may be there.
void glint_tile_note_surfaces(const glint_tile *tile, const glint_tile_frame *frame, uint32_t k);
void glint_tile_note_nothing(const glint_tile *tile, uint32_t k);
void glint_tile_note_light(const glint_tile *tile, uint32_t index, uint32_t slot, bool shadows, uint32_t k);
/// Adds the points of the current sample to the box that is kept of all; NULL: it has none.
void glint_tile_keep_box(glint_tile *tile, const glint_tile_frame *frame, const glint_point_box *box);
/// Whether the tile's pixels are those of the last picture; then they are copied, unless they are in this one's memory
/// from before.
bool glint_tile_is_unchanged(glint_tile *tile, const glint_tile_frame *frame);
/// What the worker had counted before a tile.
typedef struct glint_film_counts {
    uint64_t clipped, nonfinite;
    uint64_t lights; ///< calls of the stage light
} glint_film_counts;
/// Writes down what the tile shows now. sampled: by samples of this frame, not by the base alone.
void glint_tile_sign_film(glint_tile *tile, const glint_tile_frame *frame, glint_film_counts before, bool sampled);

/// tile/cached.c: forgets what is kept where that is of other pixels, from the second frame on that has these; in the first nothing is
/// kept, nor where they may be gathered and are not shaded alone.
void glint_tile_fit_cached(glint_tile *tile, const glint_tile_frame *frame);
/// Of a tile that is to run and whose hits are known, chooses whether to read them or to find them anew, by what its
/// frames took; afterwards notes what this one took.
void glint_tile_choose_way(glint_tile *tile, const glint_tile_frame *frame);
void glint_tile_note_way(const glint_tile *tile);
/// Prefetches what the tile has kept of its first sample and will read.
void glint_tile_prefetch(const glint_tile *tile, const glint_tile_frame *frame);

/// Each calls one stage for the current sample, and books it.
void glint_tile_aim(glint_tile *tile, const glint_tile_frame *frame, uint32_t sample);
void glint_tile_make_rays(glint_tile *tile, const glint_tile_frame *frame);
/// False: no ray of the tile hits anything. Not booked.
bool glint_tile_in_sight(glint_tile *tile, const glint_tile_frame *frame);
/// What is not in sight needs no rays.
void glint_tile_cast(glint_tile *tile, const glint_tile_frame *frame);
void glint_tile_find_surfaces(glint_tile *tile, const glint_tile_frame *frame);
/// The points alone, of some of the lanes that are hit; all of these are balls and planes.
void glint_tile_find_points(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *hits);
/// The same and light number `light` of the plan, a plain one, in slot 0. Some normals are left out unless all are wanted.
void glint_tile_find_lit_surfaces(glint_tile *tile, const glint_tile_frame *frame, uint32_t light, bool normals);
/// Whether a spot light shines at no point of the tile, by the box around them. False where that is not known.
bool glint_tile_is_past_spot(const glint_tile *tile, const glint_plan_light *light);

/// One light, samples of one, or lights that are alike: light `first + slot[i]` of the plan, for each of `count` slots of the
/// chunk.
void glint_tile_shine(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, const uint32_t *slot,
                      uint32_t count);
void glint_tile_occlude(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, const uint32_t *slot,
                        uint32_t count);
/// The arguments of these two.
glint_light_args glint_tile_light_args(glint_tile *tile, const glint_tile_frame *frame, uint32_t first,
                                       const uint32_t *slot, uint32_t count);
glint_occlude_args glint_tile_occlude_args(glint_tile *tile, const glint_tile_frame *frame, uint32_t first,
                                           const uint32_t *slot, uint32_t count);
/// effects/area_light/soft_shadow.c: computes light and shadow of the samples of a light together, in slots `slot` and on, where only
/// their sum is read. Returns whether only the sum is read, and marks the slots. The points are found.
bool glint_tile_sum_light(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, uint32_t slot,
                          uint32_t count);
/// The arguments of shade but the outputs, for `count` lights of the plan from `from` on, which are filled in, as are the
/// planes where there are any.
glint_shade_args glint_tile_shade_args(const glint_tile *tile, const glint_tile_frame *frame, uint32_t from,
                                       uint32_t count, glint_shade_light *lights, glint_shade_planes *planes);
/// Where the requested parts of the picture go.
void glint_tile_point_film(glint_tile *tile, const glint_plan *plan, float *film[GLINT_TERM_COUNT][3],
                           float *beauty[3]);
void glint_tile_shade(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count);
void glint_tile_resolve(glint_tile *tile, const glint_tile_frame *frame);
/// tile/shade.c: for plans whose samples are shaded together. Remembers what the current sample needs for that, and
/// after the last shades and resolves all.
struct glint_samples *glint_samples_create(void);
void glint_samples_destroy(struct glint_samples *samples);
void glint_tile_remember_sample(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count);
void glint_tile_resolve_samples(glint_tile *tile, const glint_tile_frame *frame);
/// Shades `samples` samples that the tile has one after the other in its groups, the first of which is number `first` of their pixels:
/// together, or into the tile's sums; after the last resolves them. sites: diffuse and specular light that each has from elsewhere, one
/// pixel's samples after another's, `count` pixels; NULL: none. beauty: of the pixels.
void glint_tile_shade_stacked(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count, uint32_t first, uint32_t samples,
                              const double (*sites)[3][GLINT_TILE_SAMPLES], uint32_t count, float *const beauty[3]);
/// Counts a stage's call and, when stages are timed, its time; `reused`: its result was at hand.
void glint_tile_count_stage(glint_tile *tile, const glint_tile_frame *frame, glint_stage_id stage, bool reused);
uint64_t glint_tile_now_ns(void);

/// Names the material of each hit, where no surfaces were found.
void glint_tile_name_materials(glint_tile *tile, const glint_tile_frame *frame);

/// tile/work.c: when work is counted, adds what the last call of a stage took.
/// Every hit looks at one light, or at `count` samples of it.
void glint_tile_count_light(glint_tile *tile, const glint_tile_frame *frame, uint32_t count);
/// Where kernels count what they decide; NULL: they do not.
static inline uint64_t *glint_tile_tests_of(glint_tile *tile, const glint_tile_frame *frame)
{
    return frame->count_work ? &tile->counts.work.tests : NULL;
}
void glint_tile_count_powers(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count);

/// effects/bounce/bounce.c:
/// Whether any material in sight sends rays on. They have been named.
bool glint_tile_sends_on(const glint_tile *tile, const glint_tile_frame *frame);

/// effects/depth_cue/depth_cue.c: light that fades with the distance from the eye.
/// The distance to what pixel i sees; infinite: to nothing.
double glint_tile_way_of(const glint_tile *tile, const glint_plan *plan, uint32_t i);

/// effects/visible_light/visible_light.c: lights that are seen.
/// Forgets what was seen. False: no ray of the tile can see a light.
bool glint_tile_visible_light_in_sight(glint_tile *tile, const glint_tile_frame *frame);
/// Of the rays in `lanes`, which are made and whose hits are known, those that see a light become misses at its distance.
void glint_tile_see_lights(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *lanes);
/// Whether ray i sees one; the normal of its surface there, turned to the eye.
static inline bool glint_tile_sees_light(const glint_tile *tile, uint32_t i)
{
    const uint16_t *seen = tile->own[GLINT_STAGE_VISIBLE_LIGHT]; // which begins with the lanes whose ray sees one
    return seen && seen[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
}
/// Fills in the active lanes that see no light.
const uint16_t *glint_tile_unlit_lanes(const glint_tile *tile, uint16_t lanes[GLINT_TILE_GROUPS]);
/// Adds what lights look like to the sums, as background.
void glint_tile_add_visible_light(glint_tile *tile, const glint_tile_frame *frame);

/// effects/environment/environment.c: a background that a program gives.
/// Whether some ray may leave the scene and show it: then the tile's rays are needed.
bool glint_tile_sees_environment(const glint_tile *tile);
/// Adds what such rays see to the sums.
void glint_tile_add_environment(glint_tile *tile, const glint_tile_frame *frame);

/// effects/adaptive/differ.c: compares the pixels of a base, which are stored, and leaves what the tiles around compare.
struct glint_differ_work *glint_differ_work_create(void);
void glint_differ_work_destroy(struct glint_differ_work *work); ///< NULL: nothing
/// Where the numbers of its objects and normals go, in the order of groups.
static inline float *glint_differ_values(struct glint_differ_work *work, int value)
{
    return (float *)work + (size_t)value * GLINT_TILE_SAMPLES;
}
void glint_tile_prefetch_borders(const glint_tile *tile, const glint_refine *refine);
void glint_tile_compare(glint_tile *tile, const glint_tile_frame *frame, glint_film_counts before);

/// effects/adaptive/gather.c: the chosen pixels of a tile, apart from the others.
struct glint_gathered *glint_gathered_create(void);
void glint_gathered_destroy(struct glint_gathered *gathered); ///< NULL: nothing
/// Whether light is local, and no stage depends on where in its group, or in its tile, a pixel is.
bool glint_tile_may_gather(const glint_tile_frame *frame);
/// Lists the places of the active pixels in the tile where that pays and the frame lets it be done; returns how many they are, 0: all
/// samples are to be taken where they are.
uint32_t glint_tile_list_gathered(const glint_tile *tile, const glint_tile_frame *frame, uint16_t place[GLINT_TILE_SAMPLES]);
/// How many samples of gathered pixels are walked together; and of how many pixels, at most.
static inline uint32_t glint_tile_gathered_samples(const glint_plan *plan)
{
    const uint32_t samples = (uint32_t)plan->desc.samples, walks = (samples + GLINT_LIGHT_CHUNK - 1) / GLINT_LIGHT_CHUNK;
    return (samples + walks - 1) / walks;
}
static inline uint32_t glint_tile_most_gathered(const glint_plan *plan)
{
    return GLINT_TILE_GROUPS / glint_tile_gathered_samples(plan) * GLINT_GROUP;
}
/// Makes the groups of the tile those of `samples` samples from number `first` on of `count` listed pixels, sample by sample, and their
/// rays.
void glint_tile_gather(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *place, uint32_t count, uint32_t first,
                       uint32_t samples);
/// The light of sites, where any is seen, whose points are found.
void glint_tile_vertex_gathered(glint_tile *tile, const glint_tile_frame *frame);
/// After the stages before it: shades them, and resolves the last into their places. The tile is as it was.
void glint_tile_shade_gathered(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count, const uint16_t *place,
                               uint32_t count, uint32_t first, uint32_t samples);

/// effects/adaptive/refine.c: whether some pixels of the tile get all samples.
bool glint_tile_has_chosen(const glint_tile *tile, const glint_tile_frame *frame);
/// Leaves these active; returns whether there are any.
bool glint_tile_choose_refined(glint_tile *tile, const glint_tile_frame *frame);
/// Whether the base's pixels are all that there is to the tile; then the picture has them.
bool glint_tile_is_base(glint_tile *tile, const glint_tile_frame *frame);
/// Takes the lanes that are not refined from a plane of the base, of numbers of four bytes, into an array of the tile.
void glint_tile_take_plane(const glint_tile *tile, const glint_tile_frame *frame, const void *plane, void *groups);
/// The other pixels' light, and all pixels' geometry, are those of the base; all are active again. Of codes alone, where no light
/// is clipped or not finite, nothing is taken and the refined pixels stay the active ones: see glint_refine.in_codes.
void glint_tile_take_base(glint_tile *tile, const glint_tile_frame *frame);

/// effects/indirect/: follows paths of light from the points that `seen` hits, and adds what they find to the sums of `tile`.
/// `from`: the batch that `seen` belongs to; NULL: it is what the eye sees, `tile` itself.
struct glint_batch;
void glint_tile_indirect(glint_tile *tile, const glint_tile_frame *frame, const glint_tile *seen,
                         const struct glint_batch *from);

/// effects/transparent_shadow/transparent_shadow.c: light through transparent objects.
/// Finds the points whose light goes through what absorbs from its first step on, and returns whether there are any. The points
/// are found.
bool glint_tile_find_dim(const glint_tile *tile, const glint_tile_frame *frame);
/// After that: those lanes of group `g` that are open to a light are not lit by it as by others, but by its tint.
static inline uint16_t glint_tile_dim_lanes(const glint_tile *tile, uint32_t g)
{
    return ((const uint16_t *)tile->own[GLINT_STAGE_TINT])[g]; // which begins with them
}
/// Where sample i sees a light sample. `scale`: see glint_light_args. The point is found, and for GLINT_EMIT_CONE the normal.
void glint_tile_sample_place(const glint_tile *tile, glint_precision precision, const glint_light_sample *light_sample,
                             double scale, uint32_t i, double out[3]);
/// Where sample i's ray to a light goes, from its point: directional: the way there.
void glint_tile_light_target(const glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light,
                             uint32_t i, double out[3]);
/// Whether one of `count` lights of the plan, from number `first` on, is kept from any point, or dimmed on its way to one.
bool glint_tile_is_shadowed(const glint_tile *tile, const glint_plan *plan, uint32_t first, uint32_t count);
/// Whether light on its way to one of the tile's points may go through something. The points are found.
bool glint_tile_may_be_tinted(const glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light);
/// Adds to the sums what `count` lights of the plan, from number `first` on, give to points that they do not reach freely, or not
/// whole. The points are found.
void glint_tile_transparent_shadows(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, uint32_t count);

/// Whether each ray has its origin and direction in the arrays: those of an orthographic camera, of one with a lens, and
/// of batches.
static inline bool glint_tile_has_arrays(const glint_tile *tile)
{
    return tile->camera.orthographic || tile->camera.lens;
}

/// The camera, where the rays are not in arrays.
static inline const glint_camera_args *glint_tile_rays_of(const glint_tile *tile)
{
    return glint_tile_has_arrays(tile) ? NULL : &tile->camera;
}

/// The pattern of a light's sample for the current sample of each pixel; NULL: it is no area light.
static inline const glint_light_sample *glint_tile_light_sample_of(const glint_tile *tile,
                                                                   const glint_plan_light *light)
{
    return light->light_samples ? &light->light_samples[tile->sample % light->turn_count] : NULL;
}

/// Where in the tile's arrays pixel (x, y) of it is.
static inline uint32_t glint_tile_place(const glint_tile *tile, uint32_t x, uint32_t y)
{
    return ((y / 4) * tile->groups_across + x / 4) * GLINT_GROUP + y % 4 * 4 + x % 4;
}

/// Arrays of real.
static inline double glint_real_at(const void *array, glint_precision precision, uint32_t i)
{
    return precision == GLINT_FLOAT ? (double)((const float *)array)[i] : ((const double *)array)[i];
}
/// Whether a group's numbers are all this one.
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
/// How many lanes there are.
static inline uint32_t glint_count_lanes(uint16_t lanes)
{
    return lanes == 0xffff ? GLINT_GROUP : (uint32_t)__builtin_popcount(lanes);
}
/// Those of group g.
static inline void glint_reals_of(const void *array, glint_precision precision, uint32_t g, double out[GLINT_GROUP])
{
    const size_t at = (size_t)g * GLINT_GROUP;
    if (precision == GLINT_DOUBLE)
        memcpy(out, (const double *)array + at, GLINT_GROUP * sizeof *out);
    for (size_t i = 0; precision == GLINT_FLOAT && i < GLINT_GROUP; i++)
        out[i] = (double)((const float *)array)[at + i];
}
static inline void glint_real_put(void *array, glint_precision precision, uint32_t i, double x)
{
    if (precision == GLINT_FLOAT)
        ((float *)array)[i] = (float)x;
    else
        ((double *)array)[i] = x;
}

/// effects/microfacet/microfacet.c: for frames with microfacets.
void glint_tile_view(glint_tile *tile, const glint_tile_frame *frame);
void glint_tile_facet(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, const uint32_t *slot,
                      uint32_t count);
/// Lets a tile write view's and facet's results into the own memory of another, which has shaded its sample.
void glint_tile_lend_facets(glint_tile *to, const glint_tile *from);

/// effects/vertex_shading/vertex.c: flat and Gouraud shading.
/// Points at.sampled to the hits whose light is worked out for themselves. Returns whether there are any.
bool glint_tile_choose_sampled(glint_tile *tile, const glint_tile_frame *frame);
/// Whether there are others, of triangles with sites.
bool glint_tile_has_shading_points(const glint_tile *tile);
/// Adds the light of sites to the sums of these others, whose points are found; after `shade`.
void glint_tile_vertex(glint_tile *tile, const glint_tile_frame *frame);
/// The same, added to others: diffuse and specular.
void glint_tile_vertex_to(glint_tile *tile, const glint_tile_frame *frame, double (*const sum[2])[GLINT_TILE_SAMPLES]);

/// effects/raster/raster.c: scan conversion.
struct glint_raster_rest *glint_raster_rest_create(void);
void glint_raster_rest_destroy(struct glint_raster_rest *rest);
bool glint_tile_raster_in_sight(const glint_tile *tile, const glint_tile_frame *frame);
/// `args`: as for a cast of everything.
void glint_tile_raster(glint_tile *tile, const glint_tile_frame *frame, const glint_cast_args *args);

/// effects/derivative/derivative.c: how fast the light of the current sample changes with parameters.
/// What is there without lights, at the first call of a sample, and what `count` lights of the plan from `from` on add, of which
/// it is known where they reach. The points are found.
void glint_tile_derive(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count);
/// Of light through transparent objects: before the first step of its rays; ray `ray` crosses a surface, at which `share` and
/// `left` are what its colour in channel c is multiplied by; it arrives, at sample i; a light in `slot` shines on samples so.
void glint_tile_begin_tints(const glint_tile *tile, const glint_plan *plan);
void glint_tile_derive_tint(const glint_tile *tile, const glint_plan *plan, uint32_t material, uint32_t ray, int c,
                            double color, double share, double left);
void glint_tile_put_tint(const glint_tile *tile, const glint_plan *plan, uint32_t i, uint32_t ray,
                         const double (*color)[GLINT_TILE_SAMPLES]);
void glint_tile_derive_tinted(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light, uint32_t slot,
                              const uint16_t *reached);
/// effects/derivative/vertex.c: keeps the slopes of a block of faces and vertices; gives samples what lies between those of their
/// triangles, after their light.
void glint_derive_keep_block(const glint_tile *tile, const glint_tile_frame *frame, uint32_t block);
void glint_derive_vertex(const glint_tile *tile, const glint_tile_frame *frame, const uint16_t *wanted);
/// effects/derivative/fade.c: after a sample of what the eye sees, where light fades.
void glint_derive_fade(glint_tile *tile, const glint_tile_frame *frame);
/// After the last sample: into the image.
void glint_tile_store_derivatives(glint_tile *tile, const glint_tile_frame *frame);

/// tile/output.c: puts the finished tile into the image's planes and codes; its geometry is that of sample 0.
/// Copies an array of the tile, in the order of its groups, into a plane of the image; of numbers of four bytes.
void glint_tile_store_plane(const glint_tile *tile, const void *groups, void *plane, int stride);
/// `groups`: the channels one after the other, in the order of groups. Nothing where the picture has no such pass.
void glint_tile_store_pass(const glint_tile *tile, const glint_tile_frame *frame, glint_pass pass, const float *groups);
bool glint_tile_wants_geometry(const glint_plan *plan);
/// A component of the ray of sample i.
double glint_tile_direction(const glint_tile *tile, glint_precision precision, int c, uint32_t i);
void glint_tile_store_geometry(const glint_tile *tile, const glint_tile_frame *frame);
bool glint_tile_wants_coverage(const glint_plan *plan);
/// Counts the hits of sample k, from 0.
void glint_tile_count_hits(glint_tile *tile, const glint_plan *plan, uint32_t k);
void glint_tile_store_light(glint_tile *tile, const glint_tile_frame *frame);
/// Prefetches the tile's codes and planes, which are written at its end; of derivatives' planes those of group g, some lines at a
/// time, since a core waits for more at once than it has room for.
void glint_tile_prefetch_output(const glint_tile *tile, const glint_tile_frame *frame);
void glint_tile_prefetch_derivatives(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g);
void glint_tile_tone(glint_tile *tile, const glint_tile_frame *frame);
/// Whether two pictures of one format have the same codes, if any, in the tile's pixels.
bool glint_tile_has_codes_of(const glint_tile *tile, const glint_image *a, const glint_image *b);
/// Takes the tile's pixels from another picture, what both have of them.
void glint_tile_copy(const glint_tile *tile, const glint_tile_frame *frame, const glint_image *from);

#endif
