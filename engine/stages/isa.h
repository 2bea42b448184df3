// The stages in the order a frame runs them, compiled for one instruction set: what isa_*.c have in common. Everything
// is static but the table, so that no function compiled for one processor is ever run on another.

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "engine/stages/elementary.h"
#include "engine/stages/stages.h"

#include "engine/stages/walk.h"
#include "engine/stages/beam.h"

#define GLINT_REAL 64
#include "engine/stages/real.h"
#include "engine/stages/camera.h"
#include "engine/stages/triangle.h"
#include "engine/stages/solid.h"
#include "engine/stages/meet.h"
#include "engine/stages/candidate.h"
#include "engine/stages/cast.h"
#include "engine/stages/cast_rays.h"
#include "engine/stages/surface.h"
#include "engine/stages/vertex.h"
#include "engine/stages/lamp.h"
#include "engine/stages/light.h"
#include "engine/stages/facet.h"
#include "engine/stages/blocked.h"
#include "engine/stages/occlude.h"
#include "engine/stages/beam_points.h"
#include "engine/stages/occlude_beam.h"
#include "engine/stages/soft.h"
#include "engine/stages/bounce.h"

#undef GLINT_REAL
#define GLINT_REAL 32
#include "engine/stages/real.h"
#include "engine/stages/camera.h"
#include "engine/stages/triangle.h"
#include "engine/stages/solid.h"
#include "engine/stages/meet.h"
#include "engine/stages/candidate.h"
#include "engine/stages/cast.h"
#include "engine/stages/cast_rays.h"
#include "engine/stages/surface.h"
#include "engine/stages/vertex.h"
#include "engine/stages/lamp.h"
#include "engine/stages/light.h"
#include "engine/stages/facet.h"
#include "engine/stages/blocked.h"
#include "engine/stages/occlude.h"
#include "engine/stages/beam_points.h"
#include "engine/stages/occlude_beam.h"
#include "engine/stages/soft.h"
#include "engine/stages/bounce.h"

#include "engine/stages/shade.h"
#include "engine/stages/resolve.h"
#include "engine/stages/tone.h"

const glint_stages GLINT_STAGES_SYMBOL = {
    .name = GLINT_STAGES_NAME,
    .geometry = { { camera_f64, in_sight_f64, cast_bundle_f64, cast_rays_f64, surface_f64, view_f64, light_f64,
                    facet_f64, occlude_f64, bounce_f64, vertex_f64 },
                  { camera_f32, in_sight_f32, cast_bundle_f32, cast_rays_f32, surface_f32, view_f32, light_f32,
                    facet_f32, occlude_f32, bounce_f32, vertex_f32 } },
    .shade = shade,
    .resolve = resolve,
    .tone = tone,
};
