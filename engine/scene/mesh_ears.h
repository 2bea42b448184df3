/// Polygons cut into triangles, ear by ear. Internal to scene/.
#ifndef GLINT_MESH_EARS_H
#define GLINT_MESH_EARS_H

#include "engine/glint.h"

/// One face of a mesh.
typedef struct glint_polygon {
    const double *vertices; ///< of the mesh
    const uint32_t *corners; ///< numbers of vertices
    uint32_t size; ///< corners
    double normal[3]; ///< by Newell's sum, in units of the largest extent
} glint_polygon;

/// Cross product of two sides of the triangle at places i, j, k, brought near 1 by a power of two: 0 means no area.
void glint_polygon_cross(const glint_polygon *polygon, uint32_t i, uint32_t j, uint32_t k, double out[3]);

/// Memory for cutting polygons; starts as zeros, freed by glint_ears_free.
typedef struct glint_ears {
    struct corner *corners; ///< of the polygon at hand
    struct node *nodes; ///< of the tree over the corners
    uint32_t *order, *heap, (*triangles)[3];
    size_t room; ///< corners
    size_t triangle_count; ///< of `triangles`: three places in the polygon each
} glint_ears;

void glint_ears_free(glint_ears *ears);

/// Cuts the first corner off that can be, again and again: *whole says whether the polygon came to an end, which one that
/// crosses itself does not. Takes n log n steps for most polygons.
glint_status glint_ears_cut(glint_ears *ears, const glint_polygon *polygon, bool *whole, glint_error *error);

#endif
