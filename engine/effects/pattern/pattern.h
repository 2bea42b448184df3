/// The stages pattern and shader of a tile: the programs of materials. Internal.
#ifndef GLINT_TILE_PATTERN_H
#define GLINT_TILE_PATTERN_H

#include "engine/tile/tile.h"

/// Whose planes: tiles whose walks are begun while another's results are still needed.
typedef enum glint_walk {
    GLINT_WALK_EYE,
    GLINT_WALK_BOUNCE,
    GLINT_WALK_INDIRECT,
    GLINT_WALK_SITES, ///< faces and vertices
    GLINT_WALK_SHADOW, ///< surfaces between a point and a light
    GLINT_WALK_COUNT
} glint_walk;

/// Points on surfaces, as a tile has them.
typedef struct glint_pattern_points {
    uint32_t group_count;
    const uint16_t *hits, *back;
    const uint32_t *prim, *material;
    const uint32_t *only; ///< the primitive of all hits, where they have one; NULL: not known
    const void *point[3], *normal[3]; ///< real; the normal geometric, or of smooth meshes theirs
    const void *t; ///< NULL: no pixel is as wide as anything there
    const glint_tile *tile; ///< whose rays found them
    const void *direction[3]; ///< real: other rays, which show no pixel; NULL: those of the tile
    float *planes; ///< out
    uint32_t fields; ///< that are wanted, a bit each
    bool shading; ///< `normal` is the one to give, whatever it is
} glint_pattern_points;

/// Whether there is the room that the plan's programs need, which may be none.
bool glint_pattern_fits(const struct glint_pattern *pattern, const glint_plan *plan);
/// Makes room for the plan's programs. NULL: no memory.
struct glint_pattern *glint_pattern_create(const glint_plan *plan);
void glint_pattern_destroy(struct glint_pattern *pattern); ///< NULL: nothing
/// Points a tile at the planes of a walk. Nothing happens in frames without programs.
void glint_pattern_point(struct glint_pattern *pattern, glint_tile *tile, glint_walk walk);

float *glint_pattern_planes(struct glint_pattern *pattern, glint_walk walk);
/// Whether a plan's programs read normals, or turn them.
bool glint_pattern_needs_normals(const glint_plan *plan);
/// The fields that programs give of the materials in sight, which are named; a bit each.
uint32_t glint_tile_fields_shown(const glint_tile *tile, const glint_plan *plan);
/// Lists the lanes that show materials, which are named, of which programs fill planes. Returns whether there are any.
bool glint_tile_find_painted(glint_tile *tile, const glint_tile_frame *frame);
/// Those that are listed.
void glint_tile_painted_lanes(const glint_tile *tile, uint16_t painted[GLINT_TILE_GROUPS]);
/// Points the planes of sample k to where they are kept, or go. Returns whether they are there already.
bool glint_tile_pattern_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k);
/// kept.c: of what glint_tile_find_painted has listed, where what first parts of programs give is kept of sample k: runs their second
/// parts into the tile's planes. Returns false where that is not, or a point has to be named; the list is as it was.
bool glint_tile_recall_pattern(glint_tile *tile, const glint_tile_frame *frame, uint32_t k);
/// As glint_tile_pattern, and keeps what later frames can recall.
void glint_tile_keep_pattern(glint_tile *tile, const glint_tile_frame *frame, uint32_t k);

/// Runs the programs of what glint_tile_find_painted has listed, into the tile's planes, and counts the stage. The points are
/// found, and where programs read them, the normals.
void glint_tile_pattern(glint_tile *tile, const glint_tile_frame *frame);
/// Both: of all that is hit, where any of it has programs.
void glint_tile_find_patterns(glint_tile *tile, const glint_tile_frame *frame);
/// The same for other points. Returns whether any material has programs.
bool glint_pattern_run(struct glint_pattern *pattern, const glint_tile_frame *frame, const glint_pattern_points *points,
                       glint_tile_counts *counts);

/// Turns the normals of surfaces with a bump, which have been found; what they were is kept in tile->unbumped.
void glint_tile_bump(glint_tile *tile, const glint_tile_frame *frame);

/// Where the plane of a field's channel begins among the tile's; -1: no material has it.
static inline ptrdiff_t glint_plane_start(const glint_plan_patterns *patterns, int field, int channel)
{
    const int first = patterns->plane[field], more = channel < patterns->planes[field] ? channel : 0;
    return first < 0 ? -1 : (ptrdiff_t)(first + more) * GLINT_TILE_SAMPLES;
}

/// That plane; NULL: no material has it.
static inline const float *glint_plane_of(const float *planes, const glint_plan *plan, int field, int channel)
{
    const ptrdiff_t start = glint_plane_start(plan->patterns, field, channel);
    return start < 0 ? NULL : planes + start;
}

/// A colour of material `m` at sample i: `number`, unless a program gives it; `room`: for what it gives.
static inline const double *glint_color_at(const float *planes, const glint_plan *plan, glint_field field, uint32_t m,
                                           uint32_t i, const double *number, double room[3])
{
    if (!plan->patterns || !(plan->patterns->of[m].made >> field & 1))
        return number;
    for (int c = 0; c < 3; c++)
        room[c] = (double)glint_plane_of(planes, plan, field, c)[i];
    return room;
}

/// The normals that mirrors and glass of a tile's samples see: where light would go on through the surface of a mirror, or
/// not through that of glass, the surface's own. ratio: see glint_bounce_args.
void glint_tile_bounce_normals(const glint_tile *tile, const glint_plan *plan, const uint16_t *wanted,
                               const void *ratio, const void *normal[3]);
/// Whether light that is scattered around a normal that a bump has turned leaves the surface.
bool glint_tile_leaves(const glint_tile *tile, const glint_plan *plan, uint32_t i, const double direction[3]);

/// A light as shaders see it: where it reaches, and how strongly.
typedef struct glint_shader_light {
    const glint_plan_light *light;
    const uint16_t *lit; ///< a bit a lane
    const float *weight[3]; ///< of its colour, a channel each; NULL: 1
    const float *visible; ///< of it, times the weight of red; NULL: all
} glint_shader_light;

/// Whether some material in sight has a shader.
static inline bool glint_tile_shows_shader(const glint_tile *tile, const glint_plan *plan)
{
    return plan->runs[GLINT_STAGE_SHADER] && glint_tile_fields_shown(tile, plan) >> GLINT_FIELD_SHADER & 1;
}
/// What shaders make of some lights: added to the sums; where the frame has none, into the planes that shade reads, and these
/// are all lights. Points and normals are found, patterns run.
void glint_tile_shader(glint_tile *tile, const glint_tile_frame *frame, const glint_shader_light *lights, uint32_t count);

/// The diffuse reflectance of a tile's sample.
static inline const double *glint_tile_diffuse(const glint_tile *tile, const glint_plan *plan, uint32_t i,
                                               double room[3])
{
    const uint32_t m = tile->surface.material[i];
    return glint_color_at(tile->at.planes, plan, GLINT_FIELD_DIFFUSE, m, i, glint_plan_diffuse(plan, m), room);
}

/// What the surface of a tile's sample sends on; `room`: for what programs give of it.
const glint_bounce_material *glint_tile_bouncing(const glint_tile *tile, const glint_plan *plan, uint32_t i,
                                                 glint_bounce_material *room);
/// The ambient light of a tile's sample that indirect light stands for, in channel c: where a program gives the diffuse
/// reflectance, and of any.
double glint_tile_pattern_rest(const glint_tile *tile, const glint_plan *plan, uint32_t i, int c);
static inline double glint_tile_ambient_rest(const glint_tile *tile, const glint_plan *plan, uint32_t i, int c)
{
    return plan->patterns ? glint_tile_pattern_rest(tile, plan, i, c)
                          : plan->indirect.rest[tile->surface.material[i]][c];
}

/// What shade reads of a tile's planes. Returns NULL where no material has any.
const glint_shade_planes *glint_tile_shade_planes(const glint_tile *tile, const glint_plan *plan,
                                                  glint_shade_planes *planes);

#endif
