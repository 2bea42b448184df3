/// Elementary functions with the same bits on every machine; the public ones are in glint_math.h. Internal.
#ifndef GLINT_BASE_MATH_H
#define GLINT_BASE_MATH_H

#include "engine/glint_math.h"

/// Returns tan(angle / 2), for fields of view. Exactly 1 for the double nearest pi/2, where the rounded tangent is
/// not.
double glint_tan_half(double angle_rad);

#endif
