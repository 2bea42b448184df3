/// Bumps: turns shading normals by the slope of a height that a program computes.
#include "engine/base/vec.h"
#include "engine/render/pattern/inputs.h"
#include "engine/render/pattern/work.h"
#include "engine/render/program/program.h"

#include <string.h>

/// Computes the gradient of a height in world space for one lane: from the derivatives in the shape's own space and in
/// world space. on_surface: includes the derivatives by u and v.
static void gradient_of(const struct glint_pattern *pattern, const glint_pattern_space *space, bool on_surface,
                        uint32_t lane, double out[3])
{
    double own[3];
    for (int c = 0; c < 3; c++) {
        own[c] = pattern->slopes[c][lane];
        for (int k = 0; k < 2 && on_surface; k++)
            own[c] += pattern->slopes[6 + k][lane] * pattern->inputs.uv_slope[k][c][lane];
    }
    for (int c = 0; c < 3; c++) {
        const double by_axes = space->mapped ? (space->inverse[0][c] * own[0] + space->inverse[1][c] * own[1]) +
                                                   space->inverse[2][c] * own[2]
                                             : own[c];
        out[c] = by_axes + pattern->slopes[3 + c][lane];
    }
}

/// n' = unit(n - (g - (g.n) n)); seen from behind, the height is a depth. Returns false if there is no such normal.
static bool perturb(double n[3], const double gradient[3], bool back)
{
    const double along = vec_dot(gradient, n);
    double perturbed[3];
    for (int c = 0; c < 3; c++) {
        const double across = gradient[c] - along * n[c];
        perturbed[c] = back ? n[c] + across : n[c] - across;
    }
    const double length = sqrt(vec_dot(perturbed, perturbed));
    if (!(length > 0 && length < HUGE_VAL))
        return false;
    for (int c = 0; c < 3; c++)
        n[c] = perturbed[c] / length;
    return true;
}

static const glint_pattern_space *space_of(const glint_tile_frame *frame, uint32_t prim)
{
    const glint_geometry *geometry = frame->plan->geometry;
    return &frame->plan->patterns->spaces[geometry->prim_part[frame->geometry.prims[prim].id]];
}

static void perturb_lanes(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_lanes *entry, uint32_t k,
                          bool on_surface)
{
    const glint_precision precision = frame->plan->desc.precision;
    for (unsigned bits = entry->lanes; bits; bits &= bits - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(bits), i = entry->group * GLINT_GROUP + lane;
        double n[3], gradient[3];
        for (int c = 0; c < 3; c++)
            n[c] = glint_real_at(tile->surface.normal[c], precision, i);
        gradient_of(tile->pattern, space_of(frame, tile->at.prim[i]), on_surface, k * GLINT_GROUP + lane, gradient);
        if (!perturb(n, gradient, glint_has_lane(tile->hit.back, i)))
            continue;
        for (int c = 0; c < 3; c++)
            glint_real_put(tile->surface.normal[c], precision, i, n[c]);
    }
}

/// Bumps the normals of one material, for groups that show it.
static void bump_material(glint_tile *tile, const glint_tile_frame *frame, const glint_pattern_points *points,
                          const glint_plan_pattern *own, const glint_pattern_lanes *entries, uint32_t count)
{
    struct glint_pattern *pattern = tile->pattern;
    const uint32_t uv = own->program[GLINT_FIELD_BUMP]->inputs & GLINT_READS_UV;
    uint16_t wanted[GLINT_PROGRAM_GROUPS];
    for (uint32_t k = 0; k < count; k++)
        wanted[k] = entries[k].lanes;
    glint_pattern_gather(&pattern->inputs, frame, points, own->slope->inputs | uv, entries, count);
    glint_program_args args = { .group_count = count, .wanted = wanted };
    for (uint32_t k = 0; k < own->slope->code.output_count; k++)
        args.result[k] = pattern->slopes[k];
    glint_pattern_call(pattern, frame, &own->slope->code, 0, &args);
    for (uint32_t k = 0; k < count; k++)
        perturb_lanes(tile, frame, &entries[k], k, uv);
}

static bool is_bumped(const glint_plan_pattern *own, uint32_t fields)
{
    (void)fields;
    return own->slope;
}

/// Turns the normals of surfaces with a bump. The original normals go to tile->unbumped.
static void turn_normals(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    (void)walk;
    const size_t bytes = tile->group_count * GLINT_GROUP * sizeof(double); // at least the size of floats
    const glint_pattern_points points = glint_pattern_points_of(tile);
    for (int c = 0; c < 3; c++)
        memcpy(tile->unbumped[c], tile->surface.normal[c], bytes);
    glint_pattern_find_lanes(tile->pattern, frame->plan->patterns, &points, is_bumped);
    const glint_pattern_lanes *entries;
    for (uint32_t taken; (taken = glint_pattern_take(tile->pattern, &entries));)
        bump_material(tile, frame, &points, &frame->plan->patterns->of[entries[0].material], entries, taken);
}

// ---- The surface's own horizon ----

/// Returns whether a light is above the unbumped surface.
static bool is_above(const glint_tile *tile, const glint_plan *plan, const glint_light_args *light, uint32_t sample,
                     uint32_t i)
{
    const glint_light_sample *from = light->light_sample[sample];
    const double *position = light->positions[0] ? light->positions[sample] : light->position;
    double n[3], l[3];
    if (from)
        glint_tile_sample_position(tile, plan->desc.precision, from, light->scale, i, l);
    else
        vec_copy(l, position);
    for (int c = 0; c < 3; c++) {
        n[c] = glint_real_at(tile->unbumped[c], plan->desc.precision, i);
        if (!light->directional)
            l[c] -= glint_real_at(tile->surface.point[c], plan->desc.precision, i);
    }
    return vec_dot(n, l) > 0;
}

/// After the stage light: clears lanes where the light is below the horizon of the unbumped surface.
static void cut_horizon(glint_tile *tile, const glint_plan *plan, const glint_light_args *light)
{
    for (uint32_t s = 0; s < light->sample_count; s++)
        for (uint32_t g = 0; g < tile->group_count; g++)
            for (unsigned bits = light->lit[s][g]; bits; bits &= bits - 1) {
                const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
                if (plan->patterns->of[tile->surface.material[i]].slope && !is_above(tile, plan, light, s, i))
                    light->lit[s][g] &= (uint16_t) ~(bits & -bits);
            }
}

static glint_key own_key(const glint_plan *plan, glint_key key)
{
    return glint_programs_key(plan, 1u << GLINT_FIELD_BUMP, key);
}

/// Runs as a part of the stages surface and light.
const glint_stage glint_stage_bump = {
    .called = glint_plan_bumps,
    .own = own_key,
    .step[GLINT_AT_SURFACE] = turn_normals,
    .limit = cut_horizon,
};
