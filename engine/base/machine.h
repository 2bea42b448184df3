/// Requirements on the machine for all instruction sets, checked at compile time.
#ifndef GLINT_BASE_MACHINE_H
#define GLINT_BASE_MACHINE_H

#include <float.h>

#if !defined(__BYTE_ORDER__) || __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "glint is for little-endian machines: files and hashes are written and read as they lie in memory"
#endif
#if FLT_EVAL_METHOD != 0
#error "glint needs float and double arithmetic without excess precision (on 32-bit x86: -msse2 -mfpmath=sse)"
#endif
#if defined(__FAST_MATH__)
#error "glint promises the same bits everywhere: -ffast-math and -Ofast are not for it"
#endif

#endif
