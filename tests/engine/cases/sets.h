/// The instruction sets of the kernels. A machine or a build may lack the last ones.
#ifndef GLINT_TESTS_SETS_H
#define GLINT_TESTS_SETS_H

enum { FIRST_KERNELS = 1, INSTRUCTION_SETS = 4 }; ///< FIRST_KERNELS: the first one after the reference
static const char *const instruction_sets[INSTRUCTION_SETS] = { "ref", "generic", "avx2", "avx512" };

#endif
