/// The unit shapes that solids are images of, and rays at them, in 113 bits: the ball, the cube and the cylinder from -1 to 1,
/// the cone from its apex at 0 to z = 1, the disk at z = 0, the torus around a circle of radius 1. A ray may be within a torus
/// twice: the first time that does not end behind it is what counts.
///
/// Each is what its parts have in common: a box of three slabs; a cylinder or cone of its curved side, part 0, and of the slab
/// between its ends, part 1; the others are one part. Grown by g, each part is moved outwards by g (inwards where g < 0).
#ifndef HARD_ORACLE_UNIT_H
#define HARD_ORACLE_UNIT_H

#include "engine/glint.h"
#include "tests/hard/oracle/quad.h"

typedef struct unit_ray {
    quad f[3], e[3]; ///< f + t e
} unit_ray;

typedef struct unit_span {
    bool hit;
    quad t[2]; ///< where the ray goes in, and out
} unit_span;

int unit_parts(const glint_shape_desc *desc);

/// The ray within the shape grown by g.
unit_span unit_meet(const glint_shape_desc *desc, const unit_ray *r, quad g);

/// The end of the span that is the first ahead: 0, 1; 2: none.
int unit_first_ahead(const unit_span *s);

/// Whether a part can be the one that ends the span at `end`, when each part is moved by up to g > 0 on its own. The ray goes
/// in by the part that it goes into last: at the latest where that part is shrunk, and no sooner than the last of the others,
/// which is no sooner than into the shape grown as a whole. It goes out by the first, alike.
bool unit_may_end(const glint_shape_desc *desc, int part, const unit_ray *r, quad g, int end, const unit_span *grown);

/// The outward normal, of any length, of a part that ends the span next to t.
void unit_normal(const glint_shape_desc *desc, int part, const unit_ray *r, int end, quad t, quad n[3]);

/// By how much it turns on a way of length 1 along the part, at t.
quad unit_bend(const glint_shape_desc *desc, int part, const unit_ray *r, quad t);

#endif
