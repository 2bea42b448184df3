/// Light passes: the light of each group of lights, summed in addition to the picture's own sums. Internal.
///
/// Each place that adds light to the sums of a tile also adds it to the sums of the light's group: shade, shaders,
/// transparent shadows, visible lights, mirrors and glass, indirect light, and the light of faces and vertices. Rays,
/// hits, shadows and weights are those of the picture. The light that comes from no lamp is the difference to the
/// picture's sums.
#ifndef GLINT_LIGHT_GROUPS_H
#define GLINT_LIGHT_GROUPS_H

#include "engine/render/light_groups/plan.h"
#include "engine/render/paths/batch.h"

#define GLINT_GROUP_SUMS 3 ///< diffuse, specular and other light

/// Sums of the light of a group.
typedef double glint_group_terms[GLINT_GROUP_SUMS][3][GLINT_TILE_SAMPLES];

/// Returns the sums for a batch of a tile; points: those for faces and vertices. NULL in frames without light passes.
struct glint_group_sums *glint_group_sums_of(const glint_tile *to, bool points);

/// Adds the light of a call of shade whose lights are all of one group.
void glint_groups_shade_one(glint_tile *tile, const glint_tile_frame *frame, const glint_shade_args *args,
                            uint32_t group);
/// Returns the sums of a group's diffuse and specular light.
static inline double (*glint_group_sum(const glint_tile *tile, uint32_t group))[3][GLINT_TILE_SAMPLES]
{
    glint_group_terms *const *sums = tile->own[GLINT_STAGE_LIGHT_GROUPS]; // the stage's memory begins with them
    return (*sums)[group];
}
/// Adds `light` of a visible light of this group to pixel i.
void glint_groups_add(const glint_tile *tile, uint32_t group, uint32_t i, const double light[3]);
/// In frames with light passes: adds the light of sample `at` of a batch, times a weight, to pixel `pixel` of `to`.
void glint_groups_collect(const glint_batch *batch, const glint_plan *plan, glint_tile *to, uint32_t at, uint32_t pixel,
                          const double weight[3]);
/// In frames with light passes: adds the lights' share of ambient light to a pixel.
void glint_groups_add_ambient(const glint_tile *to, const glint_plan *plan, uint32_t pixel, int c, double light);
/// Fades the sums of the current sample, in each pixel and channel; see effects/depth_cue/.
void glint_groups_fade(const glint_tile *tile, const glint_plan *plan,
                       const double (*transmittance)[GLINT_TILE_SAMPLES]);

#endif
