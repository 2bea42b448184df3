// The stages in the order a frame runs them, compiled for one instruction set: what isa_*.c have in common. Everything
// is static but the table, so that no function compiled for one processor is ever run on another.

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "engine/stages/simd/elementary.h"
#include "engine/stages/stages.h"

#include "engine/stages/index/walk.h"
#include "engine/stages/index/screen.h"
#include "engine/stages/index/eye_box.h"
#include "engine/stages/index/leaf.h"
#include "engine/stages/occlude/beam.h"
#include "engine/stages/light/layer.h"
#include "engine/stages/shade/sequence.h"

#define GLINT_REAL 64
#include "engine/stages/simd/geometry_stages.h"

#undef GLINT_REAL
#define GLINT_REAL 32
#include "engine/stages/simd/geometry_stages.h"

#include "engine/stages/program/coefficients.h"
#include "engine/stages/program/program.h"
#include "engine/stages/program/unit.h"
#include "engine/stages/derivative/sloped.h"
#include "engine/stages/derivative/bend.h"
#include "engine/stages/derivative/light.h"
#include "engine/stages/shade/shade.h"
#include "engine/stages/shade/sky.h"
#include "engine/stages/film/resolve.h"
#include "engine/stages/film/samples.h"
#include "engine/stages/film/differ.h"
#include "engine/stages/film/tone.h"

// Of one precision.
#define GEOMETRY_STAGES(real) \
    { \
        .camera = camera_##real, .in_sight = in_sight_##real, .cast_bundle = cast_bundle_##real, \
        .cast_rays = cast_rays_##real, .surface = surface_##real, .lit_surface = lit_surface_##real, \
        .view = GLINT_WITH_FACET ? view_##real : NULL, .light = light_##real, \
        .facet = GLINT_WITH_FACET ? facet_##real : NULL, .occlude = GLINT_WITH_SHADOW ? occlude_##real : NULL, \
        .soft_light = GLINT_WITH_AREA && GLINT_WITH_SHADOW ? soft_light_##real : NULL, \
        .raster = GLINT_WITH_RASTER ? raster_##real : NULL, \
        .bounce = GLINT_WITH_BOUNCE ? bounce_##real : NULL, .vertex = GLINT_WITH_VERTEX ? vertex_##real : NULL, \
        .scatter = GLINT_WITH_INDIRECT ? scatter_##real : NULL, \
    }

const glint_stages GLINT_STAGES_SYMBOL = {
    .name = GLINT_STAGES_NAME,
    .geometry = { GEOMETRY_STAGES(f64), GEOMETRY_STAGES(f32) },
    .sky = GLINT_WITH_INDIRECT ? sky : NULL,
    .program = GLINT_WITH_PROGRAM ? program : NULL,
    .unit = GLINT_WITH_PROGRAM ? unit : NULL,
    .choose = GLINT_WITH_PROGRAM ? choose : NULL,
    .eyes = GLINT_WITH_DERIVATIVE ? eyes : NULL,
    .bend = GLINT_WITH_DERIVATIVE ? bend : NULL,
    .slope = GLINT_WITH_DERIVATIVE ? slope : NULL,
    .arrival = GLINT_WITH_DERIVATIVE ? arrival : NULL,
    .shade = shade,
    .resolve = GLINT_WITH_SAMPLES ? resolve : NULL,
    .resolve_samples = GLINT_WITH_SAMPLES ? resolve_samples : NULL,
    .estimate = GLINT_WITH_SAMPLES ? estimate : NULL,
    .range = GLINT_WITH_SAMPLES ? range : NULL,
    .differ = GLINT_WITH_SAMPLES ? differ : NULL,
    .tone = tone,
};
