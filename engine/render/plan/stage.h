/// The declaration of a stage: when a frame needs it, what it reads, and its functions. Internal.
///
/// The list of a plan's stages, `glint explain`, the keys, the cached results, and the times and counts of a frame
/// follow from the table of these declarations, which effects/list.h lists. An effect's declaration is in its folder.
#ifndef GLINT_STAGE_H
#define GLINT_STAGE_H

#include "engine/base/hash.h"
#include "engine/glint_types.h"
#include "engine/render/effects/list.h"

#define GLINT_STAGE_ID(id, name) GLINT_STAGE_##id,
typedef enum glint_stage_id { GLINT_STAGES(GLINT_STAGE_ID) GLINT_STAGE_COUNT } glint_stage_id;

/// A set of stages: bit i is that of number i.
typedef uint64_t glint_stage_set;

struct glint_plan;
struct glint_plan_input;

/// Continues a key with the bytes of a value.
#define GLINT_KEY_ADD(key, value) ((key) = glint_key_add((key), &(value), sizeof(value)))

/// Parts of the scene that several stages may read.
typedef enum glint_scene_part {
    GLINT_PART_VIEW, ///< camera, size of the picture, samples
    GLINT_PART_POSITIONS, ///< positions of the surfaces
    GLINT_PART_APPEARANCE, ///< material and two-sidedness of each surface
    GLINT_PART_HIGHLIGHTS, ///< kind of highlight of each material
    GLINT_PART_LIGHT_POSITIONS, ///< kind, position and fall-off of each light
    GLINT_PART_SHADOWS, ///< lights that cast shadows
    GLINT_PART_LIGHT_COLORS,
    GLINT_PART_MATERIALS, ///< reflectances and exponents of materials
    GLINT_PART_BACKGROUND, ///< background: a colour or a program; brightness of visible lights
    GLINT_PART_PASSES,
    GLINT_PART_TONE,
    GLINT_PART_OWN ///< the first part by stage: GLINT_PART_OWN + a glint_stage_id is the data that this stage declares,
        ///< if it runs
} glint_scene_part;

#define GLINT_READS(input) (UINT64_C(1) << GLINT_PART_##input)
#define GLINT_READS_OWN(stage) (UINT64_C(1) << (GLINT_PART_OWN + GLINT_STAGE_##stage))

struct glint_tile;
struct glint_tile_frame;
struct glint_sample_walk;
struct glint_plan_light;
struct glint_light_args;
struct glint_cast_args;
struct glint_shade_args;
struct glint_shade_light;
struct glint_extent;

/// One step of a stage in the walk of a tile. walk: the state of the current sample; NULL at times without a current
/// sample.
typedef void glint_stage_step(struct glint_tile *tile, const struct glint_tile_frame *frame, struct glint_sample_walk *walk);

/// When the walk of a tile calls the steps of its stages. Stages that take the same time are called in the order of
/// the list.
typedef enum glint_stage_time {
    GLINT_AT_CAST, ///< the nearest objects are known: for the tile's own rays, or for secondary rays
    GLINT_AT_SURFACE, ///< points and normals are known: for the tile's own rays, or for secondary rays
    GLINT_AT_HITS, ///< the nearest objects are known for a sample of the primary rays
    GLINT_AT_ALBEDO, ///< the reflectances of the surfaces that the eye sees are known; with the pass albedo
    GLINT_AFTER_PRIMARY, ///< visible lights are known, too; hits no longer change
    GLINT_AT_LIT, ///< before the lights, if some point of the sample is shaded
    GLINT_AT_LIGHT, ///< after each light or, for an area light, after its samples
    GLINT_AT_SHADED, ///< after each chunk of lights is shaded
    GLINT_AFTER_LIGHTS, ///< after all lights
    GLINT_AT_MISSED, ///< the secondary rays that leave the scene are known; not if the walk has all of them
    GLINT_AFTER_SECONDARY, ///< the light of secondary rays is added to the tile that they left
    GLINT_AT_SUMMED, ///< all light of the sample has been added to the sums, which hold the samples so far
    GLINT_AT_DONE, ///< after the last sample, before the mean is taken
    GLINT_AT_KEYS, ///< keys of cached results are set
    GLINT_AT_STORE, ///< the pixels go to the picture
    GLINT_AT_STORE_LIGHT, ///< the light of the pixels goes to the picture
    GLINT_TIME_COUNT
} glint_stage_time;

typedef struct glint_stage {
    /// name in `glint explain`, --json and the statistics of a frame; NULL: part of another stage, not listed
    const char *name;
    const char *doc; ///< the result in a few words, for `glint explain`
    const char *effect, *caller; ///< the effect and the option that asks for it, for `glint explain`; NULL: not listed
    const char *calls; ///< other effects whose functions this effect calls, with spaces between; NULL: none.
        ///< tests/circles.lua compares it with the symbols
    /// Fills the tables of the stage: in plan->own[id], one block that the plan frees, or in fields of the plan. Called
    /// in the order of the list, when geometry, materials and lights are known. NULL: the stage has no tables. `effect`
    /// is listed if there is such a block.
    glint_status (*prepare)(struct glint_plan *plan, const struct glint_plan_input *from, glint_error *error);
    /// Refuses frames that the stage cannot render. The stages of the frame are known. NULL: none
    glint_status (*check)(const struct glint_plan *plan, const glint_scene *scene, glint_error *error);
    void (*release)(struct glint_plan *plan); ///< frees the fields of the plan that `prepare` filled. NULL: none
    /// Returns whether the frame needs the stage; the plan's tables are filled
    bool (*called)(const struct glint_plan *plan);
    uint64_t reads; ///< inputs of the stage, a set made by GLINT_READS and GLINT_READS_OWN; the results of the stages
        ///< before it are implied
    glint_key (*own)(const struct glint_plan *plan,
                     glint_key key); ///< continues a key with data that this stage adds to the scene's parts; NULL: none.
        ///< Not NULL if some stage's `reads` has GLINT_READS_OWN of the stage, or with `scales` or `passes`
    glint_key (*pass_key)(const struct glint_plan *plan, int pass,
                          glint_key key); ///< continues a key with what only this pass depends on; NULL: nothing
    /// Renders frames of a plan with several times in place of glint_render_instant. NULL: the stage renders no whole
    /// frame.
    glint_status (*render)(glint_renderer *renderer, const struct glint_plan *plan, glint_image **out, glint_frame_stats *stats,
                           glint_error *error);
    /// Prepares what tiles read of the stage, in renderer->own[id], before the tiles of a frame that needs the stage.
    /// Geometry is placed. NULL: nothing
    glint_status (*begin)(glint_renderer *renderer, struct glint_tile_frame *frame, glint_error *error);
    void (*finish)(glint_renderer *renderer, const struct glint_tile_frame *frame,
                   const struct glint_extent *extent); ///< changes the picture after its tiles. NULL: nothing
    /// Frees renderer->own[id]: for a frame that does not need it, and in the end. NULL: there is nothing
    void (*end)(glint_renderer *renderer);
    bool passes; ///< whether `own` says what passes contain: then keys with GLINT_READS(PASSES) have it, too
    bool aside; ///< the stages after it read its inputs instead of its result, or neither
    bool per_light; ///< whether the stage runs once for each light
    bool walks; ///< whether the stage traverses the BVH
    bool sums; ///< whether the stage adds light to the sums of a sample
    bool scales; ///< whether the stage changes the finished light of samples, even of samples that hit nothing
    bool normals; ///< whether the stage is likely to read the normals of points
    bool remote; ///< whether the stage adds light or slopes of light that do not come from the one call of `shade`
        ///< per sample

    glint_stage_step *step[GLINT_TIME_COUNT]; ///< NULL: nothing to do at that time
    /// After the stage light: removes lanes from those above the light's horizon. NULL: none.
    void (*limit)(struct glint_tile *tile, const struct glint_plan *plan, const struct glint_light_args *args);
    /// Called before a call of the stage shade for `count` lights of the plan from `from` on, also for secondary rays:
    /// changes its arguments. lights: those of `args`. NULL: none.
    void (*before_shade)(struct glint_tile *tile, const struct glint_tile_frame *frame, struct glint_shade_args *args,
                         struct glint_shade_light *lights, uint32_t from, uint32_t count);
    /// Called after it: adds light. NULL: none.
    void (*after_shade)(struct glint_tile *tile, const struct glint_tile_frame *frame, const struct glint_shade_args *args,
                        uint32_t from, uint32_t count);
    /// Returns whether the stage changes the light of a tile's only sample beyond its call of shade. any: something is
    /// hit. Materials and shadows are known. NULL: no; stages that scale light always do.
    bool (*adds)(const struct glint_tile *tile, const struct glint_tile_frame *frame, bool any);
    /// Returns whether the stage reads single samples of an area light at the tile's points. NULL: no.
    bool (*singles)(const struct glint_tile *tile, const struct glint_tile_frame *frame, const struct glint_plan_light *light);
    /// Called after the stage occlude, which tested the lanes in `lit`: adds lanes to `unoccluded`. middle: the lanes
    /// are for the whole light, tested at its centre. NULL: none.
    void (*admit)(struct glint_tile *tile, const struct glint_tile_frame *frame, const struct glint_plan_light *light, bool middle,
                  const uint16_t *lit, uint16_t *unoccluded);
    /// Computes the normal of a surface that the stage shows where ray i hits nothing. NULL: the stage shows no
    /// surface.
    void (*normal)(const struct glint_tile *tile, const struct glint_tile_frame *frame, uint32_t i, double normal[3]);
    /// Find the first hits in place of casting all primitives; glint_tile_frame names a stage that does. in_sight:
    /// returns false if no ray of the tile hits anything.
    bool (*in_sight)(const struct glint_tile *tile, const struct glint_tile_frame *frame);
    void (*cast)(struct glint_tile *tile, const struct glint_tile_frame *frame, const struct glint_cast_args *args);
    void *(*create)(const struct glint_plan *plan); ///< allocates the stage's memory for a worker; returns NULL when
        ///< out of memory. NULL: the stage needs no memory
    void (*destroy)(void *memory); ///< accepts NULL
    bool (*fit)(void *memory, const struct glint_plan *plan); ///< grows the memory for a plan; returns false when out
        ///< of memory. NULL: its size is fixed
    bool sized; ///< whether the size of the memory depends on the plan, so that it is allocated for each frame
    bool shared; ///< whether rays that leave a surface use the same memory as the tile
} glint_stage;

extern const glint_stage *const glint_stage_table[GLINT_STAGE_COUNT];

#endif
