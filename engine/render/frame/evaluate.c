/// Evaluates a program at one point, with the frame's own kernel.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/render/plan/plan.h"
#include "engine/render/program/program.h"

#include <stdlib.h>

glint_status glint_program_evaluate(const glint_program *program, const double inputs[GLINT_INPUT_COUNT],
                                    double *outputs, glint_error *error)
{
    GLINT_REFUSE_NULL(program, error);
    GLINT_REFUSE_NULL(inputs, error);
    GLINT_REFUSE_NULL(outputs, error);
    const glint_stages *stages;
    const uint16_t first_lane = 1;
    const glint_status status = glint_choose_isa(NULL, &stages, error);
    if (status)
        return status;
    double *lanes = glint_alloc(GLINT_INPUT_COUNT + GLINT_PROGRAM_OUTPUTS_MAX, GLINT_GROUP * sizeof *lanes);
    double *rows = glint_alloc(program->code.row_count, GLINT_PROGRAM_LANES * sizeof *rows);
    glint_program_args args = { .code = &program->code, .group_count = 1, .wanted = &first_lane, .rows = rows };
    for (size_t i = 0; i < GLINT_INPUT_COUNT && lanes; i++) {
        lanes[i * GLINT_GROUP] = inputs[i];
        args.input[i] = lanes + i * GLINT_GROUP;
    }
    for (size_t k = 0; k < program->code.output_count && lanes; k++)
        args.result[k] = lanes + (GLINT_INPUT_COUNT + k) * GLINT_GROUP;
    if (lanes && rows) {
        stages->program(&args);
        for (size_t k = 0; k < program->code.output_count; k++)
            outputs[k] = args.result[k][0];
    }
    const bool done = lanes && rows;
    free(lanes);
    free(rows);
    return done ? GLINT_OK : glint_fail_nomem(error);
}
