/// Elementary functions with the same bits on every machine. glint_sin and the others are in glint.h. Internal.
#ifndef GLINT_BASE_MATH_H
#define GLINT_BASE_MATH_H

#include "engine/glint.h"

/// tan(angle / 2), for fields of view. Exactly 1 for the double nearest pi/2, where the rounded tangent would not be.
double glint_tan_half(double angle_rad);

#endif
