/// The test cases of one ray and one sphere.
#ifndef HARD_RAY_CASES_H
#define HARD_RAY_CASES_H

#include "tests/hard/oracle/oracle.h"

#include <stddef.h>

typedef struct ray_case {
    const char *id, *what;
    hard_ray ray;
    hard_sphere sphere;
    double t; ///< t computed elsewhere with 4096 bits; 0: a miss; NAN: a tangent ray, for which hit and miss are both
        ///< right
} ray_case;

extern const ray_case ray_cases[];
extern const size_t ray_case_count;

#endif
