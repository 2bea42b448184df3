/// Cuts polygons into triangles, ear by ear. Internal to scene/.
#ifndef GLINT_MESH_EARS_H
#define GLINT_MESH_EARS_H

#include "engine/glint_types.h"

/// One face of a mesh.
typedef struct glint_polygon {
    const double *vertices; ///< the vertices of the mesh, three numbers each
    const uint32_t *corners; ///< indices of vertices
    uint32_t size; ///< number of corners
    double normal[3]; ///< normal by Newell's sum, in units of the polygon's largest extent
} glint_polygon;

/// Computes the cross product of two sides of the triangle at corners i, j, k, scaled to about 1 by a power of two;
/// 0: no area.
void glint_polygon_cross(const glint_polygon *polygon, uint32_t i, uint32_t j, uint32_t k, double out[3]);

/// Memory for cutting polygons. The caller sets it to zeros, and frees it with glint_ears_free.
typedef struct glint_ears {
    struct corner *corners; ///< corners of the current polygon
    struct node *nodes; ///< tree over the corners
    uint32_t *order, *heap, (*triangles)[3];
    size_t capacity; ///< capacity, in corners
    size_t triangle_count; ///< number of `triangles`, each of them three corners of the polygon
} glint_ears;

void glint_ears_free(glint_ears *ears);

/// Cuts off the first corner that can be cut, repeatedly. *whole says whether the whole polygon was cut; a polygon
/// that crosses itself may not be. Takes n log n steps for most polygons.
glint_status glint_ears_cut(glint_ears *ears, const glint_polygon *polygon, bool *whole, glint_error *error);

#endif
