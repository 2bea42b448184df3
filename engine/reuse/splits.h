/// The programs of materials in a row of frames in which some of their numbers change, split: see engine/program/split.h. What their
/// first parts give is kept of each sample, so that the second parts alone run again. Internal.
#ifndef GLINT_REUSE_SPLITS_H
#define GLINT_REUSE_SPLITS_H

#include "engine/plan/plan.h"
#include "engine/program/split.h"

/// A program, and how it has changed.
typedef struct glint_split_field {
    glint_key like; ///< of it and what it reads, but for its numbers; all zero: there is none
    uint32_t number_count;
    double *numbers; ///< owned: those of the last frame
    bool *changed, *now; ///< owned: which were others before; which have just changed
    glint_split *split; ///< owned; NULL: none of its numbers changes
    uint32_t place[GLINT_PROGRAM_OUTPUTS_MAX]; ///< of what is kept, among the numbers or truths of a sample
} glint_split_field;

typedef struct glint_split_material {
    glint_split_field of[GLINT_FIELD_PLANES];
    uint32_t again; ///< fields that depend on what changes, a bit each: those that programs give, and what follows from these
    bool whole; ///< these are run as they are, as keeping does not pay
} glint_split_material;

typedef struct glint_splits {
    glint_split_material *of; ///< beside the plan's materials; owned
    uint32_t material_count;
    glint_key surface; ///< of the last frame
    glint_key key; ///< of what is kept for this one; all zero: nothing is
    uint32_t numbers, planes, truths; ///< that are kept of a sample: doubles; the plan's planes, if some do not change; bits
} glint_splits;

/// Before a frame. Without memory nothing is kept.
void glint_splits_begin(glint_splits *splits, const glint_plan *plan);
void glint_splits_clear(glint_splits *splits);

static inline bool glint_splits_are_on(const glint_splits *splits)
{
    return !glint_key_equal(splits->key, (glint_key) { 0 });
}

/// Bytes of what is kept of one sample: the numbers, then the planes, then the truths.
static inline size_t glint_splits_bytes(const glint_splits *splits)
{
    const size_t bits = splits->truths * GLINT_TILE_SAMPLES / 8;
    return GLINT_TILE_SAMPLES * (splits->numbers * sizeof(double) + splits->planes * sizeof(float)) + (bits + 63) / 64 * 64;
}

#endif
