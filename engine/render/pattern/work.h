/// Shared by the stages pattern and shader, and by bumps. Internal.
#ifndef GLINT_PATTERN_WORK_H
#define GLINT_PATTERN_WORK_H

#include "engine/render/pattern/inputs.h"

#define GLINT_BUMP_SLOPES 8 ///< derivatives by p, by the world point, and by u and v

#define GLINT_SHADER_TERMS 6 ///< diffuse, specular

/// Sizes that depend on the plan.
typedef struct glint_pattern_sizes {
    size_t planes; ///< floats in the planes of a sample
    size_t samples; ///< number of samples shaded together
    size_t rows;
    bool bumps; ///< whether any surface has bumps
} glint_pattern_sizes;

struct glint_pattern {
    glint_pattern_inputs inputs;
    _Alignas(64) double slopes[GLINT_BUMP_SLOPES][GLINT_PROGRAM_LANES];
    _Alignas(64) float shaded[GLINT_SHADER_TERMS][GLINT_TILE_SAMPLES]; ///< results of shaders for all lights; see
        ///< glint_shade_planes
    _Alignas(64) double total[GLINT_SHADER_TERMS][GLINT_PROGRAM_LANES]; ///< the same for the groups of a call, before
        ///< rounding
    _Alignas(64) double values[GLINT_PROGRAM_OUTPUTS_MAX][GLINT_PROGRAM_LANES]; ///< passed from the first part of a
        ///< program to the second
    double *rows; ///< scratch of the kernel
    float *planes[GLINT_WALK_COUNT]; ///< the first walk has a set for each sample shaded together
    double *normals[GLINT_WALK_COUNT]; ///< normals of bumped surfaces, before the bump; NULL: no bumps
    glint_pattern_sizes sizes;
    glint_pattern_lanes lanes[GLINT_TILE_SAMPLES]; ///< the list made by glint_pattern_find_lanes
    uint32_t first, count; ///< the remaining entries are among lanes[first .. count)
    bool several; ///< the entries have several materials; taken entries have no lanes
    glint_pattern_lanes taken[GLINT_PROGRAM_GROUPS];
};

/// The lanes of one call of a program.
typedef struct glint_pattern_called {
    uint32_t groups[GLINT_PROGRAM_GROUPS];
    uint16_t wanted[GLINT_PROGRAM_GROUPS], odd[GLINT_PROGRAM_GROUPS];
} glint_pattern_called;

/// Groups that show one material, and the arguments of its programs.
typedef struct glint_pattern_batch {
    const glint_plan_pattern *own;
    const glint_pattern_lanes *entries;
    uint32_t count;
    glint_pattern_called called;
    glint_program_args args; ///< arguments of a call for all these groups
} glint_pattern_batch;

/// Takes a batch off the list of glint_pattern_find_lanes. The first batch must be zeroed. Returns false if the list
/// is empty.
bool glint_pattern_next(struct glint_pattern *pattern, const glint_tile_frame *frame, glint_pattern_batch *batch);
/// Runs the batch's programs for points->fields. Their inputs must be gathered.
void glint_pattern_run_batch(struct glint_pattern *pattern, const glint_tile_frame *frame,
                             const glint_pattern_points *points, glint_pattern_batch *batch, glint_tile_counts *counts);
/// Sets the batch's outputs to the planes of a field. Returns the program; if the program gives one number for
/// several planes, returns a copy in `buffer` that repeats the number per plane.
const glint_program_code *glint_pattern_point_planes(glint_pattern_batch *batch, const glint_tile_frame *frame,
                                                     const glint_pattern_points *points, int field,
                                                     const glint_program_code *code, glint_program_code *buffer);
/// Computes the planes derived from a field, after the field's program has run.
void glint_pattern_finish(const glint_pattern_batch *batch, const glint_pattern_points *points, const glint_plan *plan,
                          int field);
/// Returns whether the last call gave an invalid reflectance.
bool glint_pattern_any_odd(const glint_pattern_batch *batch);
/// Returns the points of a tile.
glint_pattern_points glint_pattern_points_of(const glint_tile *tile);
/// Lists the lanes of the requested materials.
void glint_pattern_find_lanes(struct glint_pattern *pattern, const glint_plan_patterns *patterns,
                              const glint_pattern_points *points,
                              bool (*wants)(const glint_plan_pattern *own, uint32_t fields));
/// Takes the first remaining entry and the following ones with the same material off the list, as many as fit into
/// one call. Returns their number; 0 if the list is empty.
uint32_t glint_pattern_take(struct glint_pattern *pattern, const glint_pattern_lanes **entries);
/// shader.c: lists the lanes of `lanes` (one bit each) whose materials have shaders. Returns the points with the
/// normals for shaders.
glint_pattern_points glint_shader_find_lanes(const glint_tile *tile, const glint_plan *plan, const uint16_t *lanes);
/// Gathers the inputs of a shader for some entries and their material. The caller sets the inputs in `known` (one bit
/// each).
void glint_shader_gather(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points, uint32_t known,
                         const glint_pattern_lanes *entries, uint32_t count);
/// Runs a program on the gathered inputs, from entry `first` on.
void glint_pattern_call(struct glint_pattern *pattern, const glint_tile_frame *frame, const glint_program_code *code,
                        uint32_t first, glint_program_args *args);

#endif
