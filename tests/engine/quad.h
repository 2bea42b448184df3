/// A float of 113 bits, for witnesses: long double where that has them (ARM, RISC-V), else the compiler's own.
#ifndef GLINT_TESTS_QUAD_H
#define GLINT_TESTS_QUAD_H

#include <float.h>

#if LDBL_MANT_DIG == 113
typedef long double quad;
#else
__extension__ typedef __float128 quad;
#endif

#endif
