// The stages in the order a frame runs them, for one instruction set: each object of a stage includes all and defines the entries of
// its own. Everything else is static, so that no function compiled for one processor is ever run on another, and compilers drop what an
// object does not call. The Makefile defines GLINT_ISA and, for stages of geometry and light, GLINT_REAL.

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "engine/stages/simd/entries.h"
#include GLINT_TEXT(engine/stages/simd/GLINT_ISA.h)
#pragma GCC diagnostic ignored "-Wunused-function"

#include "engine/stages/simd/elementary.h"

#include "engine/stages/index/walk.h"
#include "engine/stages/index/screen.h"
#include "engine/stages/index/eye_box.h"
#include "engine/stages/index/leaf.h"
#include "engine/stages/occlude/beam.h"
#include "engine/stages/light/layer.h"
#include "engine/stages/shade/sequence.h"

#ifdef GLINT_REAL
#include "engine/stages/simd/real.h"
#include "engine/stages/cast/camera.h"
#include "engine/stages/cast/face.h"
#include "engine/stages/cast/triangle.h"
#include "engine/stages/cast/shared_edge.h"
#include "engine/stages/cast/torus.h"
#include "engine/stages/cast/box.h"
#include "engine/stages/cast/solid.h"
#include "engine/stages/cast/meet.h"
#include "engine/stages/cast/hull.h"
#include "engine/stages/cast/simple.h"
#include "engine/stages/cast/combined.h"
#include "engine/stages/index/candidate.h"
#include "engine/stages/index/cover.h"
#include "engine/stages/index/view.h"
#include "engine/stages/cast/groups.h"
#include "engine/stages/cast/leaf.h"
#include "engine/stages/cast/nearest.h"
#include "engine/stages/cast/rays.h"
#include "engine/stages/cast/rounds.h"
#include "engine/stages/cast/together.h"
#include "engine/stages/cast/slot.h"
#include "engine/stages/cast/cast.h"
#include "engine/stages/cast/pixels.h"
#include "engine/stages/cast/parallel.h"
#include "engine/stages/cast/raster.h"
#include "engine/stages/surface/mesh.h"
#include "engine/stages/surface/sphere.h"
#include "engine/stages/surface/box.h"
#include "engine/stages/surface/surface.h"
#include "engine/stages/surface/vertex.h"
#include "engine/stages/light/light_sample.h"
#include "engine/stages/light/cone.h"
#include "engine/stages/light/light.h"
#include "engine/stages/light/lit_surface.h"
#include "engine/stages/light/plain.h"
#include "engine/stages/light/lit_balls.h"
#include "engine/stages/shade/microfacets.h"
#include "engine/stages/occlude/blocked.h"
#include "engine/stages/occlude/near.h"
#include "engine/stages/occlude/occlude.h"
#include "engine/stages/occlude/beam_points.h"
#include "engine/stages/occlude/beam_leaf.h"
#include "engine/stages/occlude/grid.h"
#include "engine/stages/occlude/through_beam.h"
#include "engine/stages/light/caps.h"
#include "engine/stages/light/soft.h"
#include "engine/stages/light/layer_frame.h"
#include "engine/stages/light/layer_blocker.h"
#include "engine/stages/light/layers.h"
#include "engine/stages/light/soft_shadow.h"
#include "engine/stages/light/soft_light.h"
#include "engine/stages/shade/bounce.h"
#include "engine/stages/shade/scatter.h"

#define KERNEL(name, type) \
    void GLINT_ENTRY(R(name))(const type *args) \
    { \
        R(name)(args); \
    }
#else
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

#define KERNEL(name, type) \
    void GLINT_ENTRY(name)(const type *args) \
    { \
        name(args); \
    }
#endif
