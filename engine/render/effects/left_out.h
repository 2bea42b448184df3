/// The stages of an effect in a build without it (make WITHOUT="indirect bounce"). NAME/left_out.c declares them in such
/// a build, instead of the other files of the folder. An effect without this file cannot be left out. Internal.
#ifndef GLINT_LEFT_OUT_H
#define GLINT_LEFT_OUT_H

#include "engine/base/status.h"
#include "engine/render/plan/plan.h"

/// The error of a build without `what`, for the script's `field`.
#define GLINT_FAIL_LEFT_OUT(error, effect, field, what) \
    glint_fail(error, GLINT_ERR_UNSUPPORTED, field ": this build has no " what " (WITHOUT=" effect ")")

/// Declares the stage NAME of `effect`: no frame has it, and frames that need it are refused. needed: an expression of
/// `plan` and of `from`, what the plan is made from.
#define GLINT_LEFT_OUT(name, effect, field, what, needed) \
    static glint_status refuse_##name(glint_plan *plan, const glint_plan_input *from, glint_error *error) \
    { \
        (void)plan, (void)from; \
        return (needed) ? GLINT_FAIL_LEFT_OUT(error, effect, field, what) : GLINT_OK; \
    } \
    static bool calls_##name(const glint_plan *plan) { return (void)plan, false; } \
    const glint_stage glint_stage_##name = { .prepare = refuse_##name, .called = calls_##name };

#endif
