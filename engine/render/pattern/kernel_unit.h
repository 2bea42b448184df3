// The stage `unit`: directions to lights and to the eye, as shaders read them. Contract: contract.h.
#ifndef GLINT_PATTERN_KERNEL_UNIT_H
#define GLINT_PATTERN_KERNEL_UNIT_H

#include "engine/render/pattern/kernel_call.h"
#include "engine/render/pattern/kernel_exact.h"
#include "engine/render/stages/simd/elementary.h"

/// Computes d / by, where `by` is the length of d.
static inline void divide_each(const vd d[3], vd by, vd q[3])
{
    for (int c = 0; c < 3; c++)
        q[c] = d[c] / by;
}

#ifdef GLINT_D_FUSED
/// Computes the same bits with one division instead of three, if |1 - y by| < 2^-53 (y: 1 / by) holds after rounding,
/// because it then holds exactly. If q is a neighbour of d / by, q + (d - q by) y with both steps fused is d / by
/// rounded to nearest (after P. Markstein, IBM J. Res. Dev. 34(1), 1990): the error before the last rounding is less
/// than 2^-53 of the error of q, and d / by is at least 2^-54 of a last place away from the nearest rounding
/// boundary. d y + d rest, fused, is within 2^-104 of d / by before rounding, and so rounds to a neighbour of d / by.
/// Within the bounds below, and because the root `by` is at most 2^512, no number that matters overflows or
/// underflows.
static inline void divide_by_length(const vd d[3], vd by, vd q[3])
{
    const vd y = d_set(1) / by, less_1 = d_fnma(by, y, d_set(1)), rest = less_1 * y;
    const vd least = d_least_size(d_least_size(d[0], d[1]), d[2]);
    const dm good = dm_and(d_lt(d_abs(less_1), d_set(0x1p-53)), d_le(d_set(0x1p-400), least));
    if (dm_bits(good) != D_ALL) {
        divide_each(d, by, q);
        return;
    }
    for (int c = 0; c < 3; c++) {
        const vd near = d_fma(d[c], y, d[c] * rest);
        q[c] = d_fma(d_fnma(near, by, d[c]), y, near);
    }
}
#else
static inline void divide_by_length(const vd d[3], vd by, vd q[3]) { divide_each(d, by, q); }
#endif

/// The kinds of directions, each compiled separately.
typedef enum unit_target { TO_EYE, TO_POSITION, TO_EACH } unit_target;

/// Computes VD directions; across and down: the camera's arrays, at these lanes.
INNER void unit_lanes(const glint_unit_args *args, const unit_target target, const double *across, const double *down,
                      size_t at)
{
    vd d[3], q[3];
    for (int c = 0; c < 3; c++) {
        if (target == TO_EYE)
            d[c] = -(d_load(across + c * GLINT_GROUP) + d_load(down + c * GLINT_GROUP));
        else
            d[c] = target == TO_POSITION ? d_set(args->position[c]) : d_load(args->to[c] + at);
        if (target != TO_EYE && args->from[0])
            d[c] = d[c] - d_load(args->from[c] + at);
    }
    const vd length = d_sqrt((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]);
    divide_by_length(d, length, q);
    for (int c = 0; c < 3; c++)
        d_store(args->unit[c] + at, q[c]);
    if (args->length)
        d_store(args->length + at, length);
}

INNER void unit_groups(const glint_unit_args *args, const unit_target target)
{
    const glint_unit_args call = *args; // a copy, because stores might change it
    const double *across = NULL, *down = NULL;
    for (size_t k = 0; k < call.group_count; k++) {
        if (target == TO_EYE) {
            const uint32_t g = call.groups[k], columns = call.camera->groups_across;
            across = (const double *)call.camera->across + (size_t)3 * GLINT_GROUP * (g % columns);
            down = (const double *)call.camera->down + (size_t)3 * GLINT_GROUP * (g / columns);
        }
        for (size_t i = 0; i < GLINT_GROUP; i += VD)
            unit_lanes(&call, target, across + i, down + i, k * GLINT_GROUP + i);
    }
}

static void unit(const glint_unit_args *args)
{
    if (args->camera)
        unit_groups(args, TO_EYE);
    else if (args->position)
        unit_groups(args, TO_POSITION);
    else
        unit_groups(args, TO_EACH);
}

#endif
