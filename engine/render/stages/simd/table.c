// The table of one instruction set.
#include <stddef.h>

#include "engine/render/stages/simd/entries.h"

#define ENTRY(with, result, name, parameters) .name = (with) ? GLINT_ENTRY(name) : NULL,
#define ENTRY_F64(with, result, name, parameters) .name = (with) ? GLINT_ENTRY(name##_f64) : NULL,
#define ENTRY_F32(with, result, name, parameters) .name = (with) ? GLINT_ENTRY(name##_f32) : NULL,

const glint_stages GLINT_ENTRY_OF(stages, GLINT_ISA) = {
    .name = GLINT_TEXT(GLINT_ISA),
    .geometry[0] = { GLINT_GEOMETRY_KERNELS(ENTRY_F64) },
#ifndef GLINT_NO_FLOAT // otherwise glint_stages_for returns the reference
    .geometry[1] = { GLINT_GEOMETRY_KERNELS(ENTRY_F32) },
#endif
    GLINT_SAMPLE_KERNELS(ENTRY)
};
