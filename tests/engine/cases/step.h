/// The step of tests of many cases.
#ifndef GLINT_TESTS_STEP_H
#define GLINT_TESTS_STEP_H

#include <stdint.h>
#include <stdlib.h>

/// Returns n: the tests run every n-th case. n is 1, or GLINT_CASE_STEP where all cases would take too long (on an
/// emulated machine, under a sanitizer). It must be coprime to 5 and 6, the periods of the kinds of cases, or some
/// kinds would never run.
static inline uint32_t case_step(void)
{
    const char *step = getenv("GLINT_CASE_STEP");
    return step ? (uint32_t)strtoul(step, NULL, 10) : 1;
}

#endif
