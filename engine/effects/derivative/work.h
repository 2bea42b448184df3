/// What the parts of this room share. Internal to engine/tile.
#ifndef GLINT_DERIVATIVE_WORK_H
#define GLINT_DERIVATIVE_WORK_H

#include "engine/effects/derivative/plan.h"
#include "engine/tile/batch.h"

#define GLINT_SHADOW_MIXER 0x9e3779b1u

/// Of a ray that left a surface, by one derivative.
typedef struct glint_ray_slope {
    double origin[3], direction[3], weight[3];
} glint_ray_slope;

typedef struct glint_derivative_work {
    _Alignas(64) double sum[GLINT_DERIVATIVES_MAX][3][GLINT_TILE_SAMPLES];
    _Alignas(64) double light[3][GLINT_TILE_SAMPLES]; ///< where rays have slopes of weights or light fades: what hits give, in double
    _Alignas(64) double eye[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double point[3][GLINT_TILE_SAMPLES], normal[3][GLINT_TILE_SAMPLES]; ///< where the tile's are of float
    _Alignas(64) double position[3][GLINT_GROUP], weight[GLINT_GROUP]; ///< of the current light
    _Alignas(64) double bend[3][3][GLINT_GROUP]; ///< slopes of a group's points, normals and eyes
    glint_bend_camera camera[GLINT_DERIVATIVES_MAX]; ///< that the eye sees by
    _Alignas(64) double tint[3][GLINT_TILE_SAMPLES]; ///< what is left of a light's colours, and its slopes, for samples and for rays
    _Alignas(64) double tint_slope[GLINT_DERIVATIVES_MAX][3][GLINT_TILE_SAMPLES];
    _Alignas(64) double ray_tint[GLINT_DERIVATIVES_MAX][3][GLINT_TILE_SAMPLES];
    _Alignas(64) double planes[GLINT_DERIVED_COUNT][GLINT_GROUP]; ///< what programs give of the current material
    double (*faded)[3][GLINT_TILE_SAMPLES]; ///< where light fades, the slopes of the samples that are done; NULL: not yet
    double *painted; ///< slopes of what programs give: as many planes as the tile has, for each derivative; NULL: none changes
    struct glint_shader_slopes *shader; ///< memory of shader.c; NULL: there are no shaders
    size_t painted_count; ///< numbers that it has room for
    float plane[GLINT_TILE_SAMPLES];
    uint32_t shadows[GLINT_TILE_SAMPLES]; ///< a hash of what is kept from each sample; in the first, and in this one
    uint32_t first[GLINT_TILE_SAMPLES];
    uint16_t kept[GLINT_TILE_GROUPS], given[GLINT_TILE_GROUPS]; ///< lanes that samples of the current light do not reach, do
    uint16_t mixed[GLINT_TILE_GROUPS]; ///< lanes that a light reaches in part
} glint_derivative_work;

/// The slopes of where a sample is: of its point, of its normal, of the unit vector to where it is seen from, and of that place.
typedef struct glint_bend {
    double point[3], normal[3], eye[3], from[3];
} glint_bend;

static inline glint_derivative_work *glint_derivative_of(const glint_tile *tile) { return tile->own[GLINT_STAGE_DERIVATIVE]; }

/// Whether what is left of light on its way has a slope.
static inline bool glint_derivatives_weigh(const glint_plan_derivatives *all)
{
    return all->bends || all->weighs || all->fades;
}

/// Whether a tile's samples are faces and vertices.
static inline bool glint_derives_sites(const glint_tile *tile) { return tile->owner; }

/// Whether the slopes of a tile read how much light there is: where rays left surfaces, and where what the eye sees fades.
static inline bool glint_derivatives_read_light(const glint_tile *tile, const glint_plan *plan)
{
    return (tile->batch || plan->runs[GLINT_STAGE_DEPTH_CUE]) && glint_derivatives_weigh(plan->derivatives);
}

/// Those of `lanes` that have the number of the first of them; `of`: of a group.
static inline unsigned glint_lanes_alike(const uint32_t of[GLINT_GROUP], unsigned lanes)
{
    const uint32_t first = of[__builtin_ctz(lanes)];
    unsigned same = 0;
    if (glint_all_are(of, first)) // the common case
        return lanes;
    for (unsigned rest = lanes; rest; rest &= rest - 1)
        same |= of[__builtin_ctz(rest)] == first ? rest & -rest : 0;
    return same;
}

/// derivative.c: points `out` at the samples of group g, after glint_tile_derive; their slopes are 0. In place, since a copy of so many
/// pointers that were just written waits for them.
void glint_derivative_find_points(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g, glint_derivative_points *out);

/// The sample that each lane of a group has of a ball, in the cone in which it sees that.
void glint_derivative_take_cone(glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light,
                                const glint_derivative_points *points, glint_derivative_source *out);
/// What is left of a light's colours at group g, and how that changes by derivative number `index`.
void glint_derivative_take_tint(const glint_tile *tile, size_t index, uint32_t g, glint_derivative_source *out);

/// A light of the plan as derivatives see it.
typedef struct glint_derivative_reach {
    const glint_plan_light *light;
    uint32_t slot;
    const glint_derivative_source *source;
    const uint16_t *lanes; ///< that it reaches, a bit each
    bool tinted; ///< through something, which leaves its tint
} glint_derivative_reach;

/// shader.c: makes room; false: no memory.
bool glint_derive_shaders_fit(glint_derivative_work *work, const glint_plan *plan);
void glint_shader_slopes_free(struct glint_shader_slopes *slopes); ///< NULL: nothing
/// Adds how fast what shaders make of a light changes.
void glint_derive_shaders(glint_tile *tile, const glint_tile_frame *frame, const glint_derivative_reach *reach);

/// pattern.c: finds the slopes of what programs give the current sample.
void glint_derivative_repaint(const glint_tile *tile, const glint_tile_frame *frame);
/// Those of a field by derivative number `index`; NULL: no program gives the field, or none changes.
const double *glint_derivative_painted(const glint_tile *tile, const glint_plan *plan, size_t index, int field, int channel);

/// bounce.c: beside glint_batch_split, the slopes of both rays by all derivatives.
void glint_derive_split(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                        glint_ray_slope *mirror, glint_ray_slope *through);
/// After glint_batch_light: the slopes of the rays' weights by what the rays went through.
void glint_derive_absorption(const glint_batch *batch, const glint_tile_frame *frame);
/// Adds the slopes of what the rays found to those of their pixels.
void glint_derive_collect(const glint_batch *batch, const glint_plan *plan, glint_tile *to);

/// fade.c: makes room; false: no memory.
bool glint_derive_fade_fits(glint_derivative_work *work, const glint_plan *plan);

/// bend.c: by derivative number `index`. False: nothing moves it.
bool glint_bend_sample(const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t i,
                       const glint_derivative_points *points, glint_bend *out);

/// The slopes of those points of a group, among `lanes`, that derivative number `index` moves; returns which they are. slope: of
/// points, of normals, of eyes, sixteen each.
unsigned glint_bend_points(const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t g, unsigned lanes,
                           const glint_derivative_points *points, double *const slope[9]);

/// What of the current sample's camera stays from hit to hit.
void glint_bend_aim(const glint_tile *tile, const glint_plan *plan);

/// The shares of a triangle's corners at the end of a way `at` from the first of them, less the 1 that the first has at its own
/// place: of the slope of a point, the slopes of its shares. scale: of the table.
void glint_bend_shares(double scale, const glint_prim *prim, const double at[3], double out[3]);

/// Makes room for what the plan's derivatives need beside; false: no memory.
bool glint_derivative_fits(struct glint_derivative_work *work, const glint_plan *plan);

#endif
