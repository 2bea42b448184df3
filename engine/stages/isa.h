// The stages in the order a frame runs them, compiled for one instruction set: what isa_*.c have in common. Everything
// is static but the table, so that no function compiled for one processor is ever run on another.

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "engine/stages/elementary.h"
#include "engine/stages/stages.h"

#include "engine/stages/walk.h"
#include "engine/stages/screen.h"
#include "engine/stages/leaf.h"
#include "engine/stages/beam.h"

#define GLINT_REAL 64
#include "engine/stages/real.h"
#include "engine/stages/camera.h"
#include "engine/stages/triangle.h"
#include "engine/stages/beside.h"
#include "engine/stages/solid.h"
#include "engine/stages/meet.h"
#include "engine/stages/candidate.h"
#include "engine/stages/cover.h"
#include "engine/stages/view.h"
#include "engine/stages/cast_leaf.h"
#include "engine/stages/cast.h"
#include "engine/stages/cast_rays.h"
#include "engine/stages/scan.h"
#include "engine/stages/surface_mesh.h"
#include "engine/stages/surface.h"
#include "engine/stages/vertex.h"
#include "engine/stages/lamp.h"
#include "engine/stages/light.h"
#include "engine/stages/lit_surface.h"
#include "engine/stages/facet.h"
#include "engine/stages/blocked.h"
#include "engine/stages/occlude.h"
#include "engine/stages/beam_points.h"
#include "engine/stages/beam_leaf.h"
#include "engine/stages/occlude_beam.h"
#include "engine/stages/caps.h"
#include "engine/stages/soft.h"
#include "engine/stages/soft_light.h"
#include "engine/stages/bounce.h"
#include "engine/stages/scatter.h"

#undef GLINT_REAL
#define GLINT_REAL 32
#include "engine/stages/real.h"
#include "engine/stages/camera.h"
#include "engine/stages/triangle.h"
#include "engine/stages/beside.h"
#include "engine/stages/solid.h"
#include "engine/stages/meet.h"
#include "engine/stages/candidate.h"
#include "engine/stages/cover.h"
#include "engine/stages/view.h"
#include "engine/stages/cast_leaf.h"
#include "engine/stages/cast.h"
#include "engine/stages/cast_rays.h"
#include "engine/stages/scan.h"
#include "engine/stages/surface_mesh.h"
#include "engine/stages/surface.h"
#include "engine/stages/vertex.h"
#include "engine/stages/lamp.h"
#include "engine/stages/light.h"
#include "engine/stages/lit_surface.h"
#include "engine/stages/facet.h"
#include "engine/stages/blocked.h"
#include "engine/stages/occlude.h"
#include "engine/stages/beam_points.h"
#include "engine/stages/beam_leaf.h"
#include "engine/stages/occlude_beam.h"
#include "engine/stages/caps.h"
#include "engine/stages/soft.h"
#include "engine/stages/soft_light.h"
#include "engine/stages/bounce.h"
#include "engine/stages/scatter.h"

#include "engine/stages/shade.h"
#include "engine/stages/resolve.h"
#include "engine/stages/samples.h"
#include "engine/stages/tone.h"

// Of one precision.
#define GEOMETRY_STAGES(real) \
    { \
        .camera = camera_##real, .in_sight = in_sight_##real, .cast_bundle = cast_bundle_##real, \
        .cast_rays = cast_rays_##real, .surface = surface_##real, .lit_surface = lit_surface_##real, \
        .view = GLINT_WITH_FACET ? view_##real : NULL, .light = light_##real, \
        .facet = GLINT_WITH_FACET ? facet_##real : NULL, .occlude = GLINT_WITH_SHADOW ? occlude_##real : NULL, \
        .soft_light = GLINT_WITH_LAMP && GLINT_WITH_SHADOW ? soft_light_##real : NULL, \
        .scan = GLINT_WITH_SCAN ? scan_##real : NULL, \
        .bounce = GLINT_WITH_BOUNCE ? bounce_##real : NULL, .vertex = GLINT_WITH_VERTEX ? vertex_##real : NULL, \
        .scatter = GLINT_WITH_INDIRECT ? scatter_##real : NULL, \
    }

const glint_stages GLINT_STAGES_SYMBOL = {
    .name = GLINT_STAGES_NAME,
    .geometry = { GEOMETRY_STAGES(f64), GEOMETRY_STAGES(f32) },
    .shade = shade,
    .resolve = GLINT_WITH_SAMPLES ? resolve : NULL,
    .resolve_samples = GLINT_WITH_SAMPLES ? resolve_samples : NULL,
    .tone = tone,
};
