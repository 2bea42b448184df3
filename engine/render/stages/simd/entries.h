/// The kernel functions that a frame calls, by their names in `glint_stages`. The object file of a stage defines the
/// entries of that stage, and the table of an instruction set has all entries. The symbol of an entry contains the
/// instruction set: glint_avx2_tone, glint_avx2_camera_f64.
#ifndef GLINT_ENTRIES_H
#define GLINT_ENTRIES_H

#include "engine/render/stages/stages.h"

#define GLINT_TEXT_(x) #x
#define GLINT_TEXT(x) GLINT_TEXT_(x)
#define GLINT_ENTRY_(isa, name) glint_##isa##_##name
#define GLINT_ENTRY_OF(isa, name) GLINT_ENTRY_(isa, name)
#define GLINT_ENTRY(name) GLINT_ENTRY_OF(GLINT_ISA, name)

#define GLINT_DECLARE(with, result, name, parameters) extern result GLINT_ENTRY(name) parameters;
#define GLINT_DECLARE_GEOMETRY(with, result, name, parameters) \
    extern result GLINT_ENTRY(name##_f64) parameters, GLINT_ENTRY(name##_f32) parameters;

GLINT_GEOMETRY_KERNELS(GLINT_DECLARE_GEOMETRY)
GLINT_SAMPLE_KERNELS(GLINT_DECLARE)

#endif
