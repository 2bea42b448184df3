/// The contract of every stage: what it reads and writes. This file has the rules for all stages. contract/tables.h,
/// contract/hits.h, contract/light.h and contract/film.h describe the individual stages in the order in which they
/// run. The contract of an effect's kernels is in the effect's folder.
///
/// A stage takes plain arrays in and gives plain arrays out. It knows nothing about scenes. Each stage is written
/// once in the vector vocabulary (simd/) and compiled for every instruction set, and once more, independently, as the
/// scalar reference (ref/). All versions give the same bits: they use + - * / sqrt, compares and selects in the order
/// of ref/, without contraction or reassociation. `min(a, b)` is `a < b ? a : b` and `max(a, b)` is `a > b ? a : b`,
/// also for NaN. dot(a, b) is (a.x b.x + a.y b.y) + a.z b.z. length2(a) is dot(a, a).
///
/// Samples of a tile are stored in groups of 16: a block of 4 x 4 pixels, row by row. `real` is double or float,
/// depending on the frame's precision. Arrays of real are `void *` here, and every kernel of geometry exists for
/// both. Values in tables, which are double, are rounded to float before they are used in float arithmetic.
///
/// Arrays are aligned to 64 bytes and as long as the groups. Indices of primitives and materials are below 2^31. The
/// sign and payload of NaN results are not defined.
#ifndef GLINT_STAGES_H
#define GLINT_STAGES_H

#include "engine/base/machine.h"
#include "engine/render/adaptive/contract.h"
#include "engine/render/effects/bounce/contract.h"
#include "engine/render/effects/derivative/contract.h"
#include "engine/render/effects/indirect/contract.h"
#include "engine/render/effects/microfacet/contract.h"
#include "engine/render/pattern/contract.h"
#include "engine/render/effects/raster/contract.h"
#include "engine/render/effects/rough/contract.h"
#include "engine/render/effects/vertex_shading/contract.h"
#include "engine/render/stages/contract/film.h"
#include "engine/render/stages/contract/hits.h"
#include "engine/render/stages/contract/light.h"
#include "engine/render/stages/contract/tables.h"

/// The kernels: ROW(WITH, RESULT, NAME, PARAMETERS) for each one. If WITH is false, the build has no such kernel. The
/// kernels of geometry exist for each precision.
#define GLINT_GEOMETRY_KERNELS(ROW) \
    ROW(true, void, camera, (const glint_camera_args *args)) \
    ROW(true, bool, in_sight, (const glint_cast_args *args)) \
    ROW(true, void, cast_bundle, (const glint_cast_args *args)) \
    ROW(true, void, cast_rays, (const glint_cast_args *args)) \
    ROW(true, void, surface, (const glint_surface_args *args)) \
    ROW(true, void, lit_surface, (const glint_surface_args *surface, const glint_light_args *light)) \
    ROW(GLINT_WITH(MICROFACET), void, view, (const glint_view_args *args)) \
    ROW(true, void, light, (const glint_light_args *args)) \
    ROW(GLINT_WITH(MICROFACET), void, facet, (const glint_facet_args *args)) \
    ROW(GLINT_WITH(SHADOW), void, occlude, (const glint_occlude_args *args)) \
    ROW(GLINT_WITH(AREA) && GLINT_WITH(SHADOW), bool, soft_light, (const glint_soft_args *args)) \
    ROW(GLINT_WITH(BOUNCE), void, bounce, (const glint_bounce_args *args)) \
    ROW(GLINT_WITH(VERTEX_SHADING), void, vertex, (const glint_vertex_args *args)) \
    ROW(GLINT_WITH(INDIRECT), void, scatter, (const glint_scatter_args *args)) \
    ROW(GLINT_WITH(ROUGH), void, spread, (const glint_spread_args *args)) \
    ROW(GLINT_WITH(RASTER), void, raster, (const glint_raster_args *args))
#define GLINT_SAMPLE_KERNELS(ROW) \
    ROW(GLINT_WITH(PROGRAM), void, program, (const glint_program_args *args)) \
    ROW(GLINT_WITH(PROGRAM), void, unit, (const glint_unit_args *args)) \
    ROW(GLINT_WITH(PROGRAM), void, choose, (const glint_choose_args *args)) \
    ROW(GLINT_WITH(DERIVATIVE), void, eyes, (const glint_eyes_args *args)) \
    ROW(GLINT_WITH(DERIVATIVE), void, bend, (const glint_bend_args *args)) \
    ROW(GLINT_WITH(DERIVATIVE), void, slope, (const glint_slope_args *args)) \
    ROW(GLINT_WITH(DERIVATIVE), void, arrival, (const glint_arrival_args *args)) \
    ROW(GLINT_WITH(INDIRECT), void, sky, (const glint_sky_args *args)) \
    ROW(true, void, shade, (const glint_shade_args *args)) \
    ROW(GLINT_WITH(SAMPLES), void, resolve, (const glint_resolve_args *args)) \
    ROW(GLINT_WITH(SAMPLES), void, resolve_samples, (const glint_shade_args *sample, uint32_t count)) \
    ROW(GLINT_WITH(SAMPLES), void, estimate, (const glint_estimate_args *args)) \
    ROW(GLINT_WITH(SAMPLES), void, differ, (const glint_differ_args *args, glint_differences *out)) \
    ROW(true, void, tone, (const glint_tone_args *args))

#define GLINT_KERNEL_MEMBER(with, result, name, parameters) result(*name) parameters;

/// The stages compiled for one instruction set.
typedef struct glint_stages {
    const char *name;
    struct glint_geometry_stages {
        GLINT_GEOMETRY_KERNELS(GLINT_KERNEL_MEMBER)
    } geometry[2]; ///< double, float
    GLINT_SAMPLE_KERNELS(GLINT_KERNEL_MEMBER)
} glint_stages;

extern const glint_stages glint_stages_ref, glint_stages_generic, glint_stages_avx2, glint_stages_avx512;

/// The instruction sets of this build, NULL-terminated, best last.
extern const glint_stages *const glint_stages_built[];
bool glint_stages_usable(const glint_stages *stages);
/// Returns an instruction set by name, with "sse2" for generic. NULL selects the one that the environment variable
/// GLINT_ISA names, otherwise the best one that the machine supports. Returns NULL if the name is unknown (*unknown
/// is true) or the machine lacks the instruction set (*unknown is false); *requested is the name.
const glint_stages *glint_stages_select(const char *name, const char **requested, bool *unknown);
/// Returns the kernels of a frame whose geometry is float or double: `stages`, or the reference in a build without float
/// kernels.
const glint_stages *glint_stages_for(const glint_stages *stages, bool is_float);

#endif
