/// A stage of a frame as one declaration: when a frame needs it, and what it reads. Internal.
///
/// The list of a plan's stages, `glint explain`, the keys, what is cached, and the times and counts of a frame follow from the table of
/// these declarations, which effects/list.h lists. An effect's declaration is in its folder.
#ifndef GLINT_STAGE_H
#define GLINT_STAGE_H

#include "engine/base/hash.h"
#include "engine/effects/list.h"

#define GLINT_STAGE_ID(id, name) GLINT_STAGE_##id,
typedef enum glint_stage_id { GLINT_STAGES(GLINT_STAGE_ID) GLINT_STAGE_COUNT } glint_stage_id;

struct glint_plan;

/// Continues a key with the bytes of a value.
#define GLINT_KEY_ADD(key, value) ((key) = glint_key_add((key), &(value), sizeof(value)))

/// Parts of the scene that several stages may read.
typedef enum glint_scene_part {
    GLINT_PART_VIEW, ///< camera, picture size, samples
    GLINT_PART_PLACES, ///< where the surfaces are
    GLINT_PART_LOOKS, ///< which material each has, and its sides
    GLINT_PART_PATTERNS, ///< programs that give numbers of materials, and where the shapes' own spaces are
    GLINT_PART_CUT_OUTS, ///< programs that say where surfaces have holes, and materials that are not there
    GLINT_PART_BUMPS, ///< programs that turn normals
    GLINT_PART_HIGHLIGHTS, ///< what kind of highlight each material has
    GLINT_PART_LIGHT_PLACES, ///< kind, position, fall-off
    GLINT_PART_SHADOWS, ///< which lights cast them
    GLINT_PART_LIGHT_COLORS,
    GLINT_PART_MATERIALS, ///< reflectances, exponents
    GLINT_PART_BACKGROUND, ///< a colour or a program, and what lights look like
    GLINT_PART_TINTS, ///< what light is left of by the transparent, where it tints shadows
    GLINT_PART_PASSES,
    GLINT_PART_TONE,
    GLINT_PART_OWN ///< and on, by glint_stage_id: what only this stage reads, if it runs
} glint_scene_part;

#define GLINT_READS(input) (UINT64_C(1) << GLINT_PART_##input)
#define GLINT_READS_OWN(stage) (UINT64_C(1) << (GLINT_PART_OWN + GLINT_STAGE_##stage))

struct glint_tile;
struct glint_tile_frame;
struct glint_sample_walk;
struct glint_plan_light;
struct glint_light_args;

/// A part of the walk of a tile. walk: the state of the current sample; NULL where there is none.
typedef void glint_stage_step(struct glint_tile *tile, const struct glint_tile_frame *frame, struct glint_sample_walk *walk);

/// When the walk of a tile calls the steps of its stages. Stages that take the same time are called in the order of the list.
typedef enum glint_stage_time {
    GLINT_AT_CAST, ///< the nearest objects are known, of the tile's rays or of those that left a surface
    GLINT_AT_SURFACE, ///< points and normals are known, likewise
    GLINT_AT_HITS, ///< of a sample of the eye: the nearest objects are known
    GLINT_AT_SIGHT, ///< lights are seen, too; what is visible does not change any more
    GLINT_AT_LIT, ///< before the lights, where some point takes light for itself
    GLINT_AT_LIGHT, ///< after each light, or the samples of one
    GLINT_AT_SHADED, ///< after each chunk of lights is shaded
    GLINT_AT_REST, ///< after all lights
    GLINT_AT_SUMMED, ///< the sums of the sample are complete
    GLINT_AT_DONE, ///< after the last sample, before the mean is taken
    GLINT_AT_SIGN, ///< keys are written to the cached results
    GLINT_AT_STORE, ///< the pixels go to the picture
    GLINT_AT_STORE_LIGHT, ///< the light of the pixels goes to the picture
    GLINT_TIME_COUNT
} glint_stage_time;

typedef struct glint_stage {
    const char *name; ///< in `glint explain`, --json and the statistics of a frame; NULL: it is a part of another stage, and not listed
    const char *doc; ///< the result in a few words, for `glint explain`
    bool (*called)(const struct glint_plan *plan); ///< whether the frame needs the stage; the plan's tables are filled
    uint64_t reads; ///< GLINT_READS and GLINT_READS_OWN: with the stages before it, what its result depends on
    glint_key (*own)(const struct glint_plan *plan,
                     glint_key key); ///< continues a key with what only this stage reads; NULL: nothing
    bool aside; ///< the stages after it do not read its result, or read what it is made from
    bool per_light; ///< it runs once for each light
    bool walks; ///< it needs the index
    bool sums; ///< it adds light to the sums of a sample
    bool normals; ///< it is likely to read the normals of points
    bool remote; ///< it is light, or slopes of light, that one call of `shade` for a sample does not give

    glint_stage_step *step[GLINT_TIME_COUNT]; ///< NULL: nothing is to do then
    /// After the stage light: takes lanes from those above the light's horizon. NULL: none.
    void (*limit)(struct glint_tile *tile, const struct glint_plan *plan, const struct glint_light_args *args);
    /// After the stage occlude, which read `lit`: adds lanes to `open`. middle: of the whole light, by its middle. NULL: none.
    void (*admit)(struct glint_tile *tile, const struct glint_tile_frame *frame, const struct glint_plan_light *light, bool middle,
                  const uint16_t *lit, uint16_t *open);
    /// The normal at what ray i sees, where nothing is hit. NULL: the stage shows no surface.
    void (*normal)(const struct glint_tile *tile, const struct glint_tile_frame *frame, uint32_t i, double normal[3]);
    void *(*create)(const struct glint_plan *plan); ///< the memory of a worker for it; NULL: out of memory. No function: it needs none
    void (*destroy)(void *memory); ///< of NULL: nothing
    bool (*fit)(void *memory, const struct glint_plan *plan); ///< grows it for a plan; false: out of memory. No function: its size is fixed
    bool sized; ///< its size is the plan's: it is made anew for each frame
    bool shared; ///< rays that leave a surface use the memory of the tile
} glint_stage;

extern const glint_stage *const glint_stage_table[GLINT_STAGE_COUNT];

#endif
