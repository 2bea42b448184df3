/// Rays at solids that once got a wrong answer or a wrong judgement, with answers computed in 400 bits.
#ifndef HARD_SOLID_CASES_H
#define HARD_SOLID_CASES_H

#include "tests/hard/oracle/oracle_solid.h"

typedef struct solid_case {
    const char *id, *what;
    hard_ray ray;
    glint_shape_kind kind;
    double center[3], normal[3], base[3], top[3], radius, min[3], max[3]; ///< the fields that the kind of solid has
    double map[3][4]; ///< the map; all 0: the identity
    double t;
} solid_case;

extern const solid_case solid_cases[];
extern const int solid_case_count;

hard_solid solid_of_case(const solid_case *c);

#endif
