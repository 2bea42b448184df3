/// Splits the programs of materials in a sequence of frames in which some of their numbers change: see
/// engine/render/program/split.h. The results of the first parts are cached for each sample, so that only the second parts
/// run again. Internal.
#ifndef GLINT_REUSE_SPLITS_H
#define GLINT_REUSE_SPLITS_H

#include "engine/render/plan/plan.h"
#include "engine/render/program/split.h"

/// A program and its changes.
typedef struct glint_split_field {
    glint_key like; ///< key of the program and its inputs without the numbers; all zero: no program
    uint32_t number_count;
    double *numbers; ///< owned: the values of the numbers in the last frame
    bool *changed, *now; ///< owned flags: whether each number has ever changed, and whether it has changed in this
        ///< frame
    glint_split *split; ///< owned; NULL: none of its numbers changes
    /// Positions of the cached values, among the numbers or booleans of a sample
    uint32_t slot[GLINT_PROGRAM_OUTPUTS_MAX];
} glint_split_field;

typedef struct glint_split_material {
    glint_split_field of[GLINT_FIELD_PLANES];
    uint32_t again; ///< the fields that depend on changing numbers, one bit each: fields computed by programs, and
        ///< fields derived from these
    bool whole; ///< whether the programs run as a whole, because caching does not pay
} glint_split_material;

typedef struct glint_splits {
    glint_split_material *of; ///< one for each material of the plan; owned
    uint32_t material_count;
    glint_key surface; ///< key of the last frame's surfaces
    glint_key key; ///< key of the values cached for this frame; all zero: none
    uint32_t numbers, planes, truths; ///< numbers of cached values per sample: doubles; the plan's planes, if some do
        ///< not change; bits
} glint_splits;

/// Called before a frame. Without memory, nothing is cached.
void glint_splits_begin(glint_splits *splits, const glint_plan *plan);
void glint_splits_clear(glint_splits *splits);

static inline bool glint_splits_are_on(const glint_splits *splits)
{
    return !glint_key_equal(splits->key, (glint_key) { 0 });
}

/// Returns the cached bytes of one sample: numbers, then planes, then booleans.
static inline size_t glint_splits_bytes(const glint_splits *splits)
{
    const size_t bits = splits->truths * GLINT_TILE_SAMPLES / 8;
    return GLINT_TILE_SAMPLES * (splits->numbers * sizeof(double) + splits->planes * sizeof(float)) + (bits + 63) / 64 * 64;
}

#endif
