/// The pass `outline`: 1 where a line is drawn, otherwise 0; computed from the finished planes depth, normal and
/// object_id. Internal.
///
/// There is an edge between two adjacent pixels if one hits nothing, if they show different objects, or if no single
/// smooth surface contains both their points P, Q with their normals m, n. With e = (Q - P) / |Q - P|: on an arc, e.m
/// and -e.n are the sine of half the angle between the normals. If the larger of e.m and -e.n is positive, the
/// surface bends towards the eye, or one point hides in front of the other: an edge above GLINT_OUTLINE_VALLEY. If it
/// is negative, the surface bends away: an edge above GLINT_OUTLINE_RIDGE, as smaller values could also be a small
/// ball. If m.n is above GLINT_OUTLINE_SMOOTH, the surface may be a mesh whose interpolated normals are far from the
/// geometric ones, and GLINT_OUTLINE_STEP is needed: one surface behind the other. The line is one pixel wide, on the
/// nearer side.
#ifndef GLINT_OUTLINE_H
#define GLINT_OUTLINE_H

#include "engine/base/pool.h"
#include "engine/film/image.h"
#include "engine/plan/plan.h"

#define GLINT_OUTLINE_VALLEY 0.25 ///< sine of half of 29 degrees
#define GLINT_OUTLINE_RIDGE 0.45 ///< sine of half of 53 degrees
#define GLINT_OUTLINE_SMOOTH 0.95 ///< cosine of 18 degrees
#define GLINT_OUTLINE_STEP 0.7 ///< sine of 44 degrees

/// Fills the rendered part of the image's plane. The result does not depend on the number of threads.
void glint_outline(const glint_plan *plan, const glint_extent *extent, glint_pool *pool, glint_image *image);

#endif
