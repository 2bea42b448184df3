/// The unit shapes, of which solids are images, and rays at the unit shapes, in 113 bits: the ball, the cube and the
/// cylinder from -1 to 1, the cone from its apex at 0 to z = 1, the disk at z = 0, the torus around a circle of
/// radius 1. A ray may enter a torus twice: the first span that does not end behind the origin counts.
///
/// Each shape is the intersection of its parts: a box has three slabs; a cylinder or cone has its curved side, part
/// 0, and the slab between its ends, part 1; the other shapes have one part. A shape grown by g has each part moved
/// outwards by g (inwards for g < 0).
#ifndef HARD_ORACLE_UNIT_H
#define HARD_ORACLE_UNIT_H

#include "engine/glint.h"
#include "tests/hard/oracle/quad.h"

typedef struct unit_ray {
    quad f[3], e[3]; ///< the ray f + t e
} unit_ray;

typedef struct unit_span {
    bool hit;
    quad t[2]; ///< the t where the ray enters and where it leaves
} unit_span;

int unit_parts(const glint_shape_desc *desc);

/// Returns the ray's span inside the shape grown by g.
unit_span unit_meet(const glint_shape_desc *desc, const unit_ray *r, quad g);

/// Returns which end of the span is the first ahead of the origin: 0 or 1; 2 for none.
int unit_first_ahead(const unit_span *s);

/// Returns whether a part can be the one that ends the span at `end`, when each part moves by up to g > 0 on its own.
/// A ray enters the shape through the part that it enters last: at the latest where that part is shrunk, and no
/// earlier than it enters the last of the other parts. That is no earlier than the entry into the shape grown as a
/// whole. In the same way, the ray leaves through the part that it leaves first.
bool unit_may_end(const glint_shape_desc *desc, int part, const unit_ray *r, quad g, int end, const unit_span *grown);

/// Computes the outward normal, of any length, of a part that ends the span next to t.
void unit_normal(const glint_shape_desc *desc, int part, const unit_ray *r, int end, quad t, quad n[3]);

/// Returns how far the normal turns per unit length along the part, at t.
quad unit_bend(const glint_shape_desc *desc, int part, const unit_ray *r, quad t);

#endif
