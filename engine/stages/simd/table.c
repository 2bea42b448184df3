// The table of one instruction set.
#include <stddef.h>

#include "engine/stages/simd/entries.h"

// The entries of one precision.
#define GEOMETRY_STAGES(real) \
    { \
        .camera = GLINT_ENTRY(camera_##real), .in_sight = GLINT_ENTRY(in_sight_##real), .cast_bundle = GLINT_ENTRY(cast_bundle_##real), \
        .cast_rays = GLINT_ENTRY(cast_rays_##real), .surface = GLINT_ENTRY(surface_##real), .lit_surface = GLINT_ENTRY(lit_surface_##real), \
        .view = GLINT_WITH_FACET ? GLINT_ENTRY(view_##real) : NULL, .light = GLINT_ENTRY(light_##real), \
        .facet = GLINT_WITH_FACET ? GLINT_ENTRY(facet_##real) : NULL, .occlude = GLINT_WITH_SHADOW ? GLINT_ENTRY(occlude_##real) : NULL, \
        .soft_light = GLINT_WITH_AREA && GLINT_WITH_SHADOW ? GLINT_ENTRY(soft_light_##real) : NULL, \
        .raster = GLINT_WITH_RASTER ? GLINT_ENTRY(raster_##real) : NULL, \
        .bounce = GLINT_WITH_BOUNCE ? GLINT_ENTRY(bounce_##real) : NULL, .vertex = GLINT_WITH_VERTEX ? GLINT_ENTRY(vertex_##real) : NULL, \
        .scatter = GLINT_WITH_INDIRECT ? GLINT_ENTRY(scatter_##real) : NULL, .spread = GLINT_WITH_INDIRECT ? GLINT_ENTRY(spread_##real) : NULL, \
    }

const glint_stages GLINT_ENTRY_OF(stages, GLINT_ISA) = {
    .name = GLINT_TEXT(GLINT_ISA),
#ifdef GLINT_NO_FLOAT // glint_stages_for returns the reference
    .geometry = { GEOMETRY_STAGES(f64) },
#else
    .geometry = { GEOMETRY_STAGES(f64), GEOMETRY_STAGES(f32) },
#endif
    .sky = GLINT_WITH_INDIRECT ? GLINT_ENTRY(sky) : NULL,
    .program = GLINT_WITH_PROGRAM ? GLINT_ENTRY(program) : NULL,
    .unit = GLINT_WITH_PROGRAM ? GLINT_ENTRY(unit) : NULL,
    .choose = GLINT_WITH_PROGRAM ? GLINT_ENTRY(choose) : NULL,
    .eyes = GLINT_WITH_DERIVATIVE ? GLINT_ENTRY(eyes) : NULL,
    .bend = GLINT_WITH_DERIVATIVE ? GLINT_ENTRY(bend) : NULL,
    .slope = GLINT_WITH_DERIVATIVE ? GLINT_ENTRY(slope) : NULL,
    .arrival = GLINT_WITH_DERIVATIVE ? GLINT_ENTRY(arrival) : NULL,
    .shade = GLINT_ENTRY(shade),
    .resolve = GLINT_WITH_SAMPLES ? GLINT_ENTRY(resolve) : NULL,
    .resolve_samples = GLINT_WITH_SAMPLES ? GLINT_ENTRY(resolve_samples) : NULL,
    .estimate = GLINT_WITH_SAMPLES ? GLINT_ENTRY(estimate) : NULL,
    .range = GLINT_WITH_SAMPLES ? GLINT_ENTRY(range) : NULL,
    .differ = GLINT_WITH_SAMPLES ? GLINT_ENTRY(differ) : NULL,
    .tone = GLINT_ENTRY(tone),
};
