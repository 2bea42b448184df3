/// The vector vocabulary of the instruction set that a kernel is compiled for. The Makefile defines GLINT_ISA, and
/// GLINT_REAL for stages of geometry and light. All functions of a kernel except its entries are static, so that no
/// function compiled for one processor ever runs on another. Compilers remove functions that an object does not call.
#ifndef GLINT_VECTOR_H
#define GLINT_VECTOR_H

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "engine/render/stages/simd/entries.h"
#include GLINT_TEXT(engine/render/stages/simd/GLINT_ISA.h)

#pragma GCC diagnostic ignored "-Wunused-function"

// Defines the entry of a kernel.
#ifdef GLINT_REAL
#define KERNEL(name, type) \
    void GLINT_ENTRY(R(name))(const type *args) \
    { \
        R(name)(args); \
    }
#else
#define KERNEL(name, type) \
    void GLINT_ENTRY(name)(const type *args) \
    { \
        name(args); \
    }
#endif

#endif
