/// The contract of vertex: light that is computed once per face or vertex. Begin with stages.h.
#ifndef GLINT_CONTRACT_VERTEX_SHADING_H
#define GLINT_CONTRACT_VERTEX_SHADING_H

#include "engine/render/stages/contract/hits.h"

/// The sum of all lights at a face or vertex, as two terms.
typedef struct glint_shading_point_light {
    float term[2][3]; ///< diffuse, specular; finite
} glint_shading_point_light;

typedef struct glint_vertex_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< one bit per lane: the lane's triangle has shading points
    const uint16_t *back; ///< written by surface
    const uint32_t *prim;
    const glint_prim *prims;
    double scale; ///< the table's scale
    const glint_shading_points *shading_points;
    const glint_shading_point_light *light[2]; ///< each shading point's light, seen from the front and from behind
    const glint_camera_args *camera; ///< the rays, as in glint_surface_args
    const void *origin[3], *direction[3];
    double *sum[2][3]; ///< in and out: the light is added in wanted lanes; NULL: the frame does not have this term
} glint_vertex_args;
// The arithmetic: ref.h, in double, with the corner weights that surface uses.

#endif
