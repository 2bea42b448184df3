/// The kernel functions that a frame calls, by their names in `glint_stages`. The object file of a stage defines the
/// entries of that stage, and the table of an instruction set has all entries. The symbol of an entry contains the
/// instruction set: glint_avx2_tone, glint_avx2_camera_f64.
#ifndef GLINT_ENTRIES_H
#define GLINT_ENTRIES_H

#include "engine/stages/stages.h"

#define GLINT_TEXT_(x) #x
#define GLINT_TEXT(x) GLINT_TEXT_(x)
#define GLINT_ENTRY_(isa, name) glint_##isa##_##name
#define GLINT_ENTRY_OF(isa, name) GLINT_ENTRY_(isa, name)
#define GLINT_ENTRY(name) GLINT_ENTRY_OF(GLINT_ISA, name)

#define GLINT_DECLARE(name) extern __typeof__(*((glint_stages *)0)->name) GLINT_ENTRY(name);
#define GLINT_DECLARE_GEOMETRY(name) \
    extern __typeof__(*((struct glint_geometry_stages *)0)->name) GLINT_ENTRY(name##_f64), GLINT_ENTRY(name##_f32);

GLINT_DECLARE_GEOMETRY(camera)
GLINT_DECLARE_GEOMETRY(in_sight)
GLINT_DECLARE_GEOMETRY(cast_bundle)
GLINT_DECLARE_GEOMETRY(cast_rays)
GLINT_DECLARE_GEOMETRY(raster)
GLINT_DECLARE_GEOMETRY(surface)
GLINT_DECLARE_GEOMETRY(lit_surface)
GLINT_DECLARE_GEOMETRY(vertex)
GLINT_DECLARE_GEOMETRY(light)
GLINT_DECLARE_GEOMETRY(view)
GLINT_DECLARE_GEOMETRY(facet)
GLINT_DECLARE_GEOMETRY(occlude)
GLINT_DECLARE_GEOMETRY(soft_light)
GLINT_DECLARE_GEOMETRY(bounce)
GLINT_DECLARE_GEOMETRY(scatter)
GLINT_DECLARE_GEOMETRY(spread)
GLINT_DECLARE(sky)
GLINT_DECLARE(program)
GLINT_DECLARE(unit)
GLINT_DECLARE(choose)
GLINT_DECLARE(eyes)
GLINT_DECLARE(bend)
GLINT_DECLARE(slope)
GLINT_DECLARE(arrival)
GLINT_DECLARE(shade)
GLINT_DECLARE(resolve)
GLINT_DECLARE(resolve_samples)
GLINT_DECLARE(estimate)
GLINT_DECLARE(range)
GLINT_DECLARE(differ)
GLINT_DECLARE(tone)

#endif
