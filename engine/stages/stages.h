/// The contract of every stage: what it reads and writes. The exact order of its arithmetic is that of ref/. What
/// holds for all stands here, each stage in one of contract/tables.h, contract/hits.h, contract/light.h and
/// contract/film.h, in the order of work.
///
/// A stage takes plain arrays in and gives plain arrays out; it has never heard of a scene. Each is written once in
/// the vector vocabulary (simd_*.h) and compiled for every instruction set, and once more, on its own, as the scalar
/// reference (ref.c). All of them give the same bits: + - * / sqrt, compares and selects in the order written here,
/// no contraction, no reassociation. `min(a, b)` is `a < b ? a : b` and `max(a, b)` is `a > b ? a : b`, NaN included.
/// dot(a, b) is (a.x b.x + a.y b.y) + a.z b.z. length2(a) is dot(a, a).
///
/// Samples of a tile travel in groups of 16: a block of 4 x 4 pixels, row by row. `real` is double or float by the
/// frame's precision; arrays of real are `void *` here and every kernel of geometry exists for both. Where a table
/// (which is double) meets float arithmetic, its numbers are first rounded to float.
///
/// Arrays are aligned to 64 bytes and as long as the groups; indices of primitives and materials are below 2^31.
/// Where a result is NaN, its sign and payload are not part of the promise.
#ifndef GLINT_STAGES_H
#define GLINT_STAGES_H

#include "engine/base/machine.h"
#include "engine/stages/contract/derivative.h"
#include "engine/stages/contract/film.h"
#include "engine/stages/contract/hits.h"
#include "engine/stages/contract/light.h"
#include "engine/stages/contract/program.h"
#include "engine/stages/contract/tables.h"

/// One instruction set's stages.
typedef struct glint_stages {
    const char *name;
    struct glint_geometry_stages {
        void (*camera)(const glint_camera_args *args);
        bool (*in_sight)(const glint_cast_args *args);
        void (*cast_bundle)(const glint_cast_args *args);
        void (*cast_rays)(const glint_cast_args *args);
        void (*surface)(const glint_surface_args *args);
        void (*lit_surface)(const glint_surface_args *surface, const glint_light_args *light);
        void (*view)(const glint_view_args *args);
        void (*light)(const glint_light_args *args);
        void (*facet)(const glint_facet_args *args);
        void (*occlude)(const glint_occlude_args *args);
        bool (*soft_light)(const glint_soft_args *args);
        void (*bounce)(const glint_bounce_args *args);
        void (*vertex)(const glint_vertex_args *args);
        void (*scatter)(const glint_scatter_args *args);
        void (*raster)(const glint_raster_args *args);
    } geometry[2]; ///< by glint_precision: double, float
    void (*program)(const glint_program_args *args);
    void (*unit)(const glint_unit_args *args);
    void (*choose)(const glint_choose_args *args);
    void (*eyes)(const glint_eyes_args *args);
    void (*bend)(const glint_bend_args *args);
    void (*slope)(const glint_slope_args *args);
    void (*arrival)(const glint_arrival_args *args);
    void (*sky)(const glint_sky_args *args);
    void (*shade)(const glint_shade_args *args);
    void (*resolve)(const glint_resolve_args *args);
    void (*resolve_samples)(const glint_shade_args *sample, uint32_t count);
    void (*estimate)(const glint_estimate_args *args);
    void (*range)(const glint_range_args *args, float out[2]);
    void (*differ)(const glint_differ_args *args, glint_differences *out);
    void (*tone)(const glint_tone_args *args);
} glint_stages;

extern const glint_stages glint_stages_ref, glint_stages_generic, glint_stages_avx2, glint_stages_avx512;

/// The instruction sets of this build, NULL-terminated, best last.
extern const glint_stages *const glint_stages_built[];
bool glint_stages_usable(const glint_stages *stages);
/// By name, "sse2" for generic; NULL takes the environment's GLINT_ISA, else the best usable. Returns NULL with
/// *unknown telling whether the name is unknown (true) or the machine lacks it (false); *requested is that name.
const glint_stages *glint_stages_select(const char *name, const char **requested, bool *unknown);

#endif
