/// The derivatives of materials' programs by their numbers: for each plane of the tile, one double per sample and
/// derivative.
#include "engine/base/alloc.h"
#include "engine/base/dual.h"
#include "engine/render/effects/derivative/work.h"
#include "engine/render/pattern/work.h"
#include "engine/render/program/program.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool glint_derivative_fits(struct glint_derivative_work *work, const glint_plan *plan)
{
    if (!glint_derive_fade_fits(work, plan) || !glint_derive_shaders_fit(work, plan))
        return false;
    if (!plan->derivatives->repaints)
        return true;
    const size_t wanted = plan->derivatives->count * plan->patterns->plane_count * GLINT_TILE_SAMPLES;
    if (work->painted_count < wanted) {
        free(work->painted);
        work->painted = glint_alloc(wanted, sizeof *work->painted);
        work->painted_count = work->painted ? wanted : 0;
    }
    return work->painted;
}

const double *glint_derivative_painted(const glint_tile *tile, const glint_plan *plan, size_t index, int field, int channel)
{
    const ptrdiff_t start = plan->derivatives->repaints ? glint_plane_start(plan->patterns, field, channel) : -1;
    if (start < 0)
        return NULL;
    return glint_derivative_of(tile)->painted + index * plan->patterns->plane_count * GLINT_TILE_SAMPLES + start;
}

static double *painted_at(const glint_tile *tile, const glint_plan *plan, size_t index, int field, int channel)
{
    return (double *)(uintptr_t)glint_derivative_painted(tile, plan, index, field, channel);
}

// ---- Planes derived from the results of programs; see `finish` in pattern/pattern.c -----------------------

/// Returns the normalising factor of Phong's and Blinn-Phong's highlights.
static glint_dual even_factor(const glint_material_desc *desc, glint_dual s)
{
    const glint_dual two = dual(2, 0), four = dual(4, 0), more = dual_add(s, two);
    if (desc->model != GLINT_MODEL_BLINN_PHONG)
        return dual_scale(more, 0.5);
    return dual_div(dual_mul(more, dual_add(s, four)), dual_scale(dual_add(dual_exp2(dual_scale(s, -0.5)), s), 8));
}

static void finish_exponent(const glint_tile *tile, const glint_plan *plan, const glint_plan_pattern *own, size_t index,
                            uint32_t i)
{
    double *slope = &painted_at(tile, plan, index, GLINT_FIELD_SHININESS, 0)[i];
    const double s = (double)glint_plane_of(tile->at.planes, plan, GLINT_FIELD_SHININESS, 0)[i];
    if (own->desc.model == GLINT_MODEL_BLINN_PHONG && own->desc.matched)
        *slope *= 4;
    for (int c = 0; c < 3 && own->desc.normalized; c++) {
        double *specular = &painted_at(tile, plan, index, GLINT_FIELD_SPECULAR, c)[i];
        const glint_dual even = even_factor(&own->desc, dual(s, *slope));
        const double whole = (double)glint_plane_of(tile->at.planes, plan, GLINT_FIELD_SPECULAR, c)[i];
        *specular = *specular * even.value + whole / even.value * even.slope;
    }
}

static void finish_roughness(const glint_tile *tile, const glint_plan *plan, size_t index, uint32_t i)
{
    const double alpha = (double)glint_plane_of(tile->at.planes, plan, GLINT_FIELD_ROUGHNESS, 0)[i];
    painted_at(tile, plan, index, GLINT_FIELD_ROUGHNESS, 0)[i] *= alpha < 1 ? 2 * sqrt(alpha) : 0;
}

static void finish(const glint_tile *tile, const glint_plan *plan, size_t index, const glint_pattern_lanes *entry)
{
    const glint_plan_pattern *own = &plan->patterns->of[entry->material];
    const glint_derivative_programs *programs = &plan->derivatives->of[index].programs[entry->material];
    const uint32_t planes = plan->materials[entry->material].planes;
    for (unsigned bits = entry->lanes; bits; bits &= bits - 1) {
        const uint32_t i = entry->group * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
        if (planes & GLINT_PLANE_SHININESS && (programs->of[GLINT_FIELD_SHININESS] || programs->of[GLINT_FIELD_SPECULAR]))
            finish_exponent(tile, plan, own, index, i);
        if (programs->of[GLINT_FIELD_ROUGHNESS])
            finish_roughness(tile, plan, index, i);
    }
}

// ---- The programs -------------------------------------------------------------------------------------------------

/// Runs a program of a field for entries whose inputs are gathered, into pattern->slopes from offset `to` on.
static void run(const glint_tile *tile, const glint_tile_frame *frame, const glint_program *program,
                glint_program_args args, uint32_t to)
{
    for (uint32_t k = 0; k < program->code.output_count; k++)
        args.result[k] = tile->pattern->slopes[to + k];
    glint_pattern_call(tile->pattern, frame, &program->code, 0, &args);
}

/// Returns whether a plane of an entry may hold a limit instead of the program's result.
static bool is_bounded(const glint_tile *tile, const glint_plan *plan, int field, const glint_pattern_lanes *entry)
{
    bool any = false;
    for (int c = 0; c < plan->patterns->planes[field]; c++) {
        const float *plane = glint_plane_of(tile->at.planes, plan, field, c) + (size_t)entry->group * GLINT_GROUP;
        for (int i = 0; i < GLINT_GROUP; i++)
            any = any || ((entry->lanes >> i & 1) && !(plane[i] > 1e-17f && plane[i] < 0x1p99f)); // roughness is at least 1e-18
    }
    return any;
}

/// Stores the slopes of one entry, number e of its call. The slope is 0 for a value that was clamped to 0, and for a
/// value without a slope, such as the root of a constant 0.
static void put_slopes(const glint_tile *tile, const glint_plan *plan, size_t index, int field, bool one, bool bounded,
                       const glint_pattern_lanes *entry, uint32_t e)
{
    for (int c = 0; c < plan->patterns->planes[field]; c++) {
        const double *value = tile->pattern->slopes[one ? 0 : c] + e * GLINT_GROUP;
        const double *slope = tile->pattern->slopes[one ? 3 : 3 + c] + e * GLINT_GROUP;
        double *to = painted_at(tile, plan, index, field, c) + (size_t)entry->group * GLINT_GROUP;
        for (unsigned bits = entry->lanes; bits; bits &= bits - 1) {
            const int i = __builtin_ctz(bits);
            const bool inside = !bounded || (value[i] >= 0 && value[i] <= GLINT_REFLECTANCE_MAX);
            to[i] = inside && isfinite(slope[i]) ? slope[i] : 0;
        }
    }
}

/// Runs one program for groups that show a material.
static void run_field(const glint_tile *tile, const glint_tile_frame *frame, size_t index, int field,
                      const glint_pattern_lanes *entries, const glint_program_args *args)
{
    const glint_program *program = frame->plan->patterns->of[entries->material].program[field];
    bool bounded = false;
    for (uint32_t e = 0; e < args->group_count && !bounded; e++)
        bounded = is_bounded(tile, frame->plan, field, &entries[e]);
    if (bounded)
        run(tile, frame, program, *args, 0);
    run(tile, frame, frame->plan->derivatives->of[index].programs[entries->material].of[field], *args, 3);
    for (uint32_t e = 0; e < args->group_count; e++)
        put_slopes(tile, frame->plan, index, field, program->code.output_count == 1, bounded, &entries[e], e);
}

/// Runs the programs of one material for some groups.
static void run_material(const glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points,
                         const glint_pattern_lanes *entries, uint32_t count)
{
    const glint_plan_derivatives *all = frame->plan->derivatives;
    const glint_plan_pattern *own = &frame->plan->patterns->of[entries->material];
    uint16_t wanted[GLINT_PROGRAM_GROUPS];
    for (uint32_t e = 0; e < count; e++)
        wanted[e] = entries[e].lanes;
    glint_pattern_gather(&tile->pattern->inputs, frame, points, own->reads, entries, count);
    const glint_program_args args = { .group_count = count, .wanted = wanted };
    for (size_t k = 0; k < all->count; k++) {
        for (int field = 0; field < GLINT_FIELD_PLANES; field++)
            if (all->of[k].programs[entries->material].of[field])
                run_field(tile, frame, k, field, entries, &args);
        for (uint32_t e = 0; e < count; e++)
            finish(tile, frame->plan, k, &entries[e]);
    }
}

static bool repaints(const glint_plan_pattern *own, uint32_t fields)
{
    (void)fields;
    return own->repaints;
}

void glint_derivative_repaint(const glint_tile *tile, const glint_tile_frame *frame)
{
    const size_t planes = frame->plan->derivatives->count * frame->plan->patterns->plane_count;
    const glint_pattern_points points = glint_pattern_points_of(tile);
    for (size_t k = 0; k < planes; k++)
        memset(glint_derivative_of(tile)->painted + k * GLINT_TILE_SAMPLES, 0, tile->group_count * GLINT_GROUP * sizeof(double));
    glint_pattern_find_lanes(tile->pattern, frame->plan->patterns, &points, repaints);
    const glint_pattern_lanes *entries;
    for (uint32_t taken; (taken = glint_pattern_take(tile->pattern, &entries));)
        run_material(tile, frame, &points, entries, taken);
}
