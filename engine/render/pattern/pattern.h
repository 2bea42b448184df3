/// The stages pattern and shader of a tile: the programs of materials. Internal.
#ifndef GLINT_TILE_PATTERN_H
#define GLINT_TILE_PATTERN_H

#include "engine/render/effects/bounce/plan.h"
#include "engine/render/tile/tile.h"

/// Selects a set of planes. A walk may begin while the results of another one are still needed.
typedef enum glint_walk {
    GLINT_WALK_EYE,
    GLINT_WALK_BOUNCE,
    GLINT_WALK_INDIRECT,
    GLINT_WALK_ROUGH,
    GLINT_WALK_SHADING_POINTS, ///< points of faces and vertices
    GLINT_WALK_SHADOW, ///< surfaces between a point and a light
    GLINT_WALK_COUNT
} glint_walk;

/// Points on surfaces, in the layout of a tile.
typedef struct glint_pattern_points {
    uint32_t group_count;
    const uint16_t *hits, *back;
    const uint32_t *prim, *material;
    const uint32_t *only; ///< the primitive that all hits have in common; NULL: unknown
    const void *point[3], *normal[3]; ///< real; the geometric normal, or the interpolated one of a smooth mesh
    const void *t; ///< NULL: the points belong to no pixel, so there is no footprint
    const glint_tile *tile; ///< the tile whose rays hit them
    const void *direction[3]; ///< real: directions of rays that belong to no pixel; NULL: the rays of the tile
    float *planes; ///< out
    uint32_t fields; ///< the requested fields, one bit each
    bool shading; ///< pass `normal` to the programs as it is
} glint_pattern_points;

/// Returns whether the memory is large enough for the plan's programs (which may need none).
bool glint_pattern_fits(const struct glint_pattern *pattern, const glint_plan *plan);
/// Allocates memory for the plan's programs. NULL: out of memory.
struct glint_pattern *glint_pattern_create(const glint_plan *plan);
void glint_pattern_destroy(struct glint_pattern *pattern); ///< NULL: nothing
/// Lets a tile use the planes of a walk. Does nothing in frames without programs.
void glint_pattern_point(struct glint_pattern *pattern, glint_tile *tile, glint_walk walk);

float *glint_pattern_planes(struct glint_pattern *pattern, glint_walk walk);
/// Returns whether a plan's programs read or turn normals.
bool glint_pattern_needs_normals(const glint_plan *plan);
/// Returns the fields that programs compute for the visible materials, one bit each. tile->material must be known.
uint32_t glint_tile_fields_shown(const glint_tile *tile, const glint_plan *plan);
/// Lists the lanes whose materials have programs that fill planes. Returns whether there are any. tile->material must
/// be known.
bool glint_tile_find_painted(glint_tile *tile, const glint_tile_frame *frame);
/// Writes the lanes listed by glint_tile_find_painted, one bit each, for every group.
void glint_tile_painted_lanes(const glint_tile *tile, uint16_t painted[GLINT_TILE_GROUPS]);
/// Points the planes of sample k to their slot in the cache. Returns whether the slot already has their values.
bool glint_tile_pattern_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k);
/// kept.c: for the lanes listed by glint_tile_find_painted, if the results of the programs' first parts are cached
/// for sample k: runs the second parts into the tile's planes. Returns false if nothing is cached or an error needs
/// its point; the list is then unchanged.
bool glint_tile_recall_pattern(glint_tile *tile, const glint_tile_frame *frame, uint32_t k);
/// Like glint_tile_pattern, and caches the results of first parts for later frames.
void glint_tile_cache_pattern(glint_tile *tile, const glint_tile_frame *frame, uint32_t k);

/// Runs the programs of the lanes listed by glint_tile_find_painted into the tile's planes, and counts the stage. The
/// points must be known, and the normals if programs read them.
void glint_tile_pattern(glint_tile *tile, const glint_tile_frame *frame);
/// Lists the lanes of all hits and runs their programs, if any of the materials has programs.
void glint_tile_find_patterns(glint_tile *tile, const glint_tile_frame *frame);
/// Lists and runs the programs of points outside a tile. Returns whether any material has programs.
bool glint_pattern_run(struct glint_pattern *pattern, const glint_tile_frame *frame, const glint_pattern_points *points,
                       glint_tile_counts *counts);

/// Returns the index of the plane that holds this channel of the field; -1 if no material has the field.
static inline ptrdiff_t glint_plane_start(const glint_plan_patterns *patterns, int field, int channel)
{
    const int first = patterns->plane[field], more = channel < patterns->planes[field] ? channel : 0;
    return first < 0 ? -1 : (ptrdiff_t)(first + more) * GLINT_TILE_SAMPLES;
}

/// Returns that plane; NULL: no material has it.
static inline const float *glint_plane_of(const float *planes, const glint_plan *plan, int field, int channel)
{
    const ptrdiff_t start = glint_plane_start(plan->patterns, field, channel);
    return start < 0 ? NULL : planes + start;
}

/// Returns a colour of material `m` at sample i: the program's result, written to `buffer`, or `number` without a
/// program.
static inline const double *glint_color_at(const float *planes, const glint_plan *plan, glint_field field, uint32_t m,
                                           uint32_t i, const double *number, double buffer[3])
{
    if (!plan->patterns || !(plan->patterns->of[m].made >> field & 1))
        return number;
    for (int c = 0; c < 3; c++)
        buffer[c] = (double)glint_plane_of(planes, plan, field, c)[i];
    return buffer;
}


/// The input of shaders for one light: the lanes that it reaches, and its strength there.
typedef struct glint_shader_light {
    const glint_plan_light *light;
    const uint16_t *lit; ///< one bit per lane
    const float *weight[3]; ///< factor of the light's colour, per channel; NULL: 1
    const float *visible; ///< visible share, times the weight of red; NULL: 1
} glint_shader_light;

/// Returns whether a visible material has a shader.
static inline bool glint_tile_shows_shader(const glint_tile *tile, const glint_plan *plan)
{
    return plan->runs[GLINT_STAGE_SHADER] && glint_tile_fields_shown(tile, plan) >> GLINT_FIELD_SHADER & 1;
}
/// Adds the shaders' results for some lights to the sums. In a frame without sums, writes them into the planes that
/// shade reads; `lights` are then all lights. Points and normals must be known, and patterns must have run.
void glint_tile_shader(glint_tile *tile, const glint_tile_frame *frame, const glint_shader_light *lights, uint32_t count);

/// Returns the diffuse reflectance of a tile's sample.
static inline const double *glint_tile_diffuse(const glint_tile *tile, const glint_plan *plan, uint32_t i,
                                               double buffer[3])
{
    const uint32_t m = tile->surface.material[i];
    return glint_color_at(tile->at.planes, plan, GLINT_FIELD_DIFFUSE, m, i, glint_plan_diffuse(plan, m), buffer);
}

/// Returns mirror, transmission and absorption of a tile's sample; `buffer` holds them if programs compute any.
const glint_bounce_material *glint_tile_pattern_bouncing(const glint_tile *tile, const glint_plan *plan, uint32_t i,
                                                         glint_bounce_material *buffer);
static inline const glint_bounce_material *glint_tile_bouncing(const glint_tile *tile, const glint_plan *plan, uint32_t i,
                                                               glint_bounce_material *buffer)
{
    return plan->patterns ? glint_tile_pattern_bouncing(tile, plan, i, buffer) : &plan->bouncing[tile->surface.material[i]];
}
/// Returns the part of a sample's ambient light that indirect light replaces, in channel c: for materials whose
/// diffuse reflectance a program computes, and for all others.
double glint_tile_pattern_rest(const glint_tile *tile, const glint_plan *plan, uint32_t i, int c);
static inline double glint_tile_ambient_rest(const glint_tile *tile, const glint_plan *plan, uint32_t i, int c)
{
    return plan->patterns ? glint_tile_pattern_rest(tile, plan, i, c)
                          : plan->indirect.rest[tile->surface.material[i]][c];
}

/// Returns the planes that shade reads, or NULL if no material has any.
const glint_shade_planes *glint_tile_shade_planes(const glint_tile *tile, const glint_plan *plan,
                                                  glint_shade_planes *planes);

#endif
