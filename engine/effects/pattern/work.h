/// What the stages pattern and shader, and bumps, have in common. Internal.
#ifndef GLINT_PATTERN_WORK_H
#define GLINT_PATTERN_WORK_H

#include "engine/effects/pattern/inputs.h"

#define GLINT_BUMP_SLOPES 8 ///< by the point in the shape's own space, in the world, and on the surface

#define GLINT_SHADER_TERMS 6 ///< diffuse, specular

/// How large what depends on the plan is.
typedef struct glint_pattern_room {
    size_t planes; ///< floats of a sample's planes
    size_t samples; ///< that are shaded together
    size_t rows;
    bool bumps, cut_outs; ///< whether any surface has them
} glint_pattern_room;

struct glint_pattern {
    glint_pattern_inputs inputs;
    _Alignas(64) double slopes[GLINT_BUMP_SLOPES][GLINT_PROGRAM_LANES];
    _Alignas(64) float shaded[GLINT_SHADER_TERMS][GLINT_TILE_SAMPLES]; ///< what shaders made of all lights; see glint_shade_planes
    _Alignas(64) double total[GLINT_SHADER_TERMS][GLINT_PROGRAM_LANES]; ///< the same of a call's groups, before it is rounded
    _Alignas(64) double bounced[3][GLINT_TILE_SAMPLES]; ///< real: see glint_tile_bounce_normals
    _Alignas(64) double values[GLINT_PROGRAM_OUTPUTS_MAX][GLINT_PROGRAM_LANES]; ///< that go from a program's first part to its second
    double *rows; ///< scratch of the kernel
    float *planes[GLINT_WALK_COUNT]; ///< those of the first walk for each sample that is shaded together with others
    double *normals[GLINT_WALK_COUNT]; ///< of bumped surfaces, before; NULL: there are none
    struct glint_cut_out *cut_out; ///< memory of cut_out.c; NULL: no surface has holes
    glint_pattern_room room;
    glint_pattern_lanes lanes[GLINT_TILE_SAMPLES]; ///< the list of glint_pattern_find_lanes
    uint32_t first, count; ///< the entries of it that are left are among lanes[first .. count)
    bool several; ///< they are of several materials, and those that were taken have no lanes
    glint_pattern_lanes taken[GLINT_PROGRAM_GROUPS];
};

/// Which lanes a call of a program is about.
typedef struct glint_pattern_called {
    uint32_t groups[GLINT_PROGRAM_GROUPS];
    uint16_t wanted[GLINT_PROGRAM_GROUPS], odd[GLINT_PROGRAM_GROUPS];
} glint_pattern_called;

/// Some groups that show one material, and what its programs are run with.
typedef struct glint_pattern_batch {
    const glint_plan_pattern *own;
    const glint_pattern_lanes *entries;
    uint32_t count;
    glint_pattern_called called;
    glint_program_args args; ///< of a call about all of these
} glint_pattern_batch;

/// Takes a batch off the list of glint_pattern_find_lanes; of the first all else is 0. Returns false where the list is empty.
bool glint_pattern_next(struct glint_pattern *pattern, const glint_tile_frame *frame, glint_pattern_batch *batch);
/// The batch's programs of points->fields, whose inputs are gathered.
void glint_pattern_run_batch(struct glint_pattern *pattern, const glint_tile_frame *frame,
                             const glint_pattern_points *points, glint_pattern_batch *batch, glint_tile_counts *counts);
/// Points the batch's arguments at the planes of a field. Returns the code; where that gives one number of several planes, in `room`
/// one that gives it for each.
const glint_program_code *glint_pattern_point_planes(glint_pattern_batch *batch, const glint_tile_frame *frame,
                                                     const glint_pattern_points *points, int field,
                                                     const glint_program_code *code, glint_program_code *room);
/// What follows from the program of a field, once it has been run.
void glint_pattern_finish(const glint_pattern_batch *batch, const glint_pattern_points *points, const glint_plan *plan,
                          int field);
/// Notes the lanes at which the last call gave what is no reflectance.
void glint_pattern_note_odd(const glint_pattern_batch *batch, const glint_tile_frame *frame,
                            const glint_pattern_points *points, int field, glint_tile_counts *counts);
/// The points that a tile has found.
glint_pattern_points glint_pattern_points_of(const glint_tile *tile);
/// Lists the lanes of the materials that are wanted.
void glint_pattern_find_lanes(struct glint_pattern *pattern, const glint_plan_patterns *patterns,
                              const glint_pattern_points *points,
                              bool (*wants)(const glint_plan_pattern *own, uint32_t fields));
/// Takes the first entry that is left and those after it of the same material, as many as a call has room for, off the list.
/// Returns how many: 0, where the list is empty.
uint32_t glint_pattern_take(struct glint_pattern *pattern, const glint_pattern_lanes **entries);
/// shader.c: lists those of the lanes, a bit each, that show materials with shaders. Returns the points as shaders see them.
glint_pattern_points glint_shader_find_lanes(const glint_tile *tile, const glint_plan *plan, const uint16_t *lanes);
/// Finds what a shader reads of the points of some entries, and of their material; what is `known`, a bit an input, is put there by
/// the caller.
void glint_shader_gather(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points, uint32_t known,
                         const glint_pattern_lanes *entries, uint32_t count);
/// Runs a program on the inputs that are gathered, from entry `first` on.
void glint_pattern_call(struct glint_pattern *pattern, const glint_tile_frame *frame, const glint_program_code *code,
                        uint32_t first, glint_program_args *args);

#endif
