/// Shared by the files of this folder. Internal.
#ifndef GLINT_DERIVATIVE_WORK_H
#define GLINT_DERIVATIVE_WORK_H

#include "engine/render/effects/derivative/plan.h"
#include "engine/render/paths/event.h"

#define GLINT_SHADOW_MIXER 0x9e3779b1u

/// The slopes of a ray that left a surface, for one derivative.
typedef struct glint_ray_slope {
    double origin[3], direction[3], weight[3];
} glint_ray_slope;

typedef struct glint_derivative_work {
    _Alignas(64) double sum[GLINT_DERIVATIVES_MAX][3][GLINT_TILE_SAMPLES];
    _Alignas(64) double light[3][GLINT_TILE_SAMPLES]; ///< light of hits in double, if ray weights have slopes or light
        ///< fades
    _Alignas(64) double eye[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double point[3][GLINT_TILE_SAMPLES], normal[3][GLINT_TILE_SAMPLES]; ///< if the tile's are float
    _Alignas(64) double position[3][GLINT_GROUP], weight[GLINT_GROUP]; ///< direction and weight of the current light
    _Alignas(64) double bend[3][3][GLINT_GROUP]; ///< slopes of a group's points, normals and eyes
    glint_bend_camera camera[GLINT_DERIVATIVES_MAX]; ///< cameras of the eye, one per derivative
    _Alignas(64) double tint[3][GLINT_TILE_SAMPLES]; ///< transmitted share of a light's colours, and its slopes, for
        ///< samples and rays
    _Alignas(64) double tint_slope[GLINT_DERIVATIVES_MAX][3][GLINT_TILE_SAMPLES];
    _Alignas(64) double ray_tint[GLINT_DERIVATIVES_MAX][3][GLINT_TILE_SAMPLES];
    _Alignas(64) double planes[GLINT_DERIVED_COUNT][GLINT_GROUP]; ///< results of programs for the current material
    double (*faded)[3][GLINT_TILE_SAMPLES]; ///< slopes of finished samples, if light fades; NULL: none yet
    double *painted; ///< slopes of the tile's planes, for each derivative; NULL: none changes
    struct glint_shader_slopes *shader; ///< memory of shader.c; NULL: there are no shaders
    size_t painted_count; ///< capacity of `painted`, in numbers
    float plane[GLINT_TILE_SAMPLES];
    uint32_t shadows[GLINT_TILE_SAMPLES]; ///< hashes of the lights hidden from each pixel, in the first sample and in
        ///< this one
    uint32_t first[GLINT_TILE_SAMPLES];
    uint16_t occluded[GLINT_TILE_GROUPS],
        unoccluded[GLINT_TILE_GROUPS]; ///< lanes that some samples of the current light leave dark
        ///< and lanes that some samples reach
    uint16_t mixed[GLINT_TILE_GROUPS]; ///< lanes that a light reaches partly
} glint_derivative_work;

/// The slopes of a sample's point, of its normal, of the unit vector to the viewer, and of the viewer's position.
typedef struct glint_bend {
    double point[3], normal[3], eye[3], from[3];
} glint_bend;

static inline glint_derivative_work *glint_derivative_of(const glint_tile *tile) { return tile->own[GLINT_STAGE_DERIVATIVE]; }

/// Returns whether the transmitted share of light has a slope.
static inline bool glint_derivatives_weigh(const glint_plan_derivatives *all)
{
    return all->bends || all->weighs || all->fades;
}

/// Returns whether the samples of a tile are faces and vertices.
static inline bool glint_derives_shading_points(const glint_tile *tile) { return tile->owner; }

/// Returns whether the slopes of a tile depend on the amount of light: for rays that left surfaces, and with a depth
/// cue.
static inline bool glint_derivatives_read_light(const glint_tile *tile, const glint_plan *plan)
{
    return (tile->batch || plan->runs[GLINT_STAGE_DEPTH_CUE]) && glint_derivatives_weigh(plan->derivatives);
}

/// Returns the lanes of `lanes` whose number in `of` equals the number of the first of these lanes.
static inline unsigned glint_lanes_equal(const uint32_t of[GLINT_GROUP], unsigned lanes)
{
    const uint32_t first = of[__builtin_ctz(lanes)];
    unsigned same = 0;
    if (glint_all_are(of, first)) // the common case
        return lanes;
    for (unsigned rest = lanes; rest; rest &= rest - 1)
        same |= of[__builtin_ctz(rest)] == first ? rest & -rest : 0;
    return same;
}

/// derivative.c: fills `out` with pointers to the samples of group g, after glint_tile_derive; their slopes are 0.
/// It fills `out` in place, because copying so many pointers just written would stall.
void glint_derivative_find_points(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g, glint_derivative_points *out);

/// Computes the sample of a sphere light for each lane of a group, within the cone in which the lane sees the sphere.
void glint_derivative_take_cone(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light,
                                const glint_derivative_points *points, glint_derivative_source *out);
/// Loads the transmitted share of a light's colours at group g, and its slopes by derivative number `index`.
void glint_derivative_take_tint(const glint_tile *tile, size_t index, uint32_t g, glint_derivative_source *out);

/// A light of the plan and the lanes that it reaches.
typedef struct glint_derivative_reach {
    const glint_plan_light *light;
    uint32_t slot;
    const glint_derivative_source *source;
    const uint16_t *lanes; ///< one bit per lane
    bool tinted; ///< through transparent surfaces, which tint it
} glint_derivative_reach;

/// shader.c: allocates memory; false: out of memory.
bool glint_derive_shaders_fit(glint_derivative_work *work, const glint_plan *plan);
void glint_shader_slopes_free(struct glint_shader_slopes *slopes); ///< NULL: nothing
/// Adds the derivatives of the shaders' results for a light.
void glint_derive_shaders(glint_tile *tile, const glint_tile_frame *frame, const glint_derivative_reach *reach);

/// pattern.c: computes the slopes of the programs' results for the current sample.
void glint_derivative_repaint(const glint_tile *tile, const glint_tile_frame *frame);
/// Returns the slopes of a field by derivative number `index`; NULL: no program computes the field, or none changes.
const double *glint_derivative_painted(const glint_tile *tile, const glint_plan *plan, size_t index, int field, int channel);

/// bounce.c: with glint_bsdf_weights, computes the slopes of the rays for all derivatives.
void glint_derive_split(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                        glint_ray_slope slopes[GLINT_SPLITS][GLINT_DERIVATIVES_MAX]);
/// After glint_batch_light: computes the slopes of the rays' weights by absorption.
void glint_derive_absorption(const glint_batch *batch, const glint_tile_frame *frame);
/// Adds the slopes of the rays' light to those of their pixels.
void glint_derive_collect(const glint_batch *batch, const glint_plan *plan, glint_tile *to);

/// fade.c: allocates memory; false: out of memory.
bool glint_derive_fade_fits(glint_derivative_work *work, const glint_plan *plan);

/// bend.c: computes the slopes of one sample by derivative number `index`. Returns false if nothing moves it.
bool glint_bend_sample(const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t i,
                       const glint_derivative_points *points, glint_bend *out);

/// Computes the slopes of the points of `lanes` that derivative number `index` moves, and returns these lanes. slope:
/// of points, of normals, of eyes, sixteen each.
unsigned glint_bend_points(const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t g, unsigned lanes,
                           const glint_derivative_points *points, double *const slope[9]);

/// Prepares the part of the current sample's camera that is the same for all hits.
void glint_bend_aim(const glint_tile *tile, const glint_plan *plan);

/// Computes the barycentric weights of the point `at`, relative to the first corner of a triangle, less the 1 that
/// the first weight has at the corner. With the slope of a point for `at`, these are the slopes of its weights.
/// scale: the scale of the geometry's table.
void glint_bend_shares(double scale, const glint_prim *prim, const double at[3], double out[3]);

/// Allocates the other memory of the plan's derivatives; false: out of memory.
bool glint_derivative_fits(struct glint_derivative_work *work, const glint_plan *plan);

#endif
