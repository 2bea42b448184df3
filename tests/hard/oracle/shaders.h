/// Phong's and Blinn's models as shaders that read every input except texture coordinates.
#ifndef GLINT_HARD_SHADERS_H
#define GLINT_HARD_SHADERS_H

#include "engine/glint_math.h"
#include "engine/glint_programs.h"
#include "tests/hard/oracle/drive.h"

static inline glint_value apply(glint_builder *b, glint_op op, glint_value x, glint_value y)
{
    glint_value out[GLINT_RESULTS_MAX];
    glint_error error;
    must(glint_builder_op(b, op, (const glint_value[GLINT_OPERANDS_MAX]) { x, y }, out, &error), &error);
    return out[0];
}

static inline glint_value number_of(glint_builder *b, double x)
{
    glint_value out;
    glint_error error;
    must(glint_builder_number(b, x, &out, &error), &error);
    return out;
}

static inline glint_value input_of(glint_builder *b, int input)
{
    glint_value out;
    glint_error error;
    must(glint_builder_input(b, (glint_input)input, &out, &error), &error);
    return out;
}

/// Makes the dot product of two vectors whose inputs start at x and y.
static inline glint_value product(glint_builder *b, int x, int y)
{
    glint_value sum = apply(b, GLINT_OP_MUL, input_of(b, x), input_of(b, y));
    for (int c = 1; c < 3; c++)
        sum = apply(b, GLINT_OP_ADD, sum, apply(b, GLINT_OP_MUL, input_of(b, x + c), input_of(b, y + c)));
    return sum;
}

/// Makes x^s of Phong's or Blinn's cosine. (l + v)^2 is 2 (1 + l.v).
static inline glint_value make_strength(glint_model model, glint_builder *b)
{
    const glint_value nl = product(b, GLINT_INPUT_N_X, GLINT_INPUT_L_X), nv = product(b, GLINT_INPUT_N_X, GLINT_INPUT_V_X),
                      lv = product(b, GLINT_INPUT_L_X, GLINT_INPUT_V_X), two = number_of(b, 2);
    const glint_value half = apply(b, GLINT_OP_SQRT, apply(b, GLINT_OP_MUL, two, apply(b, GLINT_OP_ADD, number_of(b, 1), lv)), 0);
    const glint_value cosine = model == GLINT_MODEL_PHONG
                                   ? apply(b, GLINT_OP_SUB, apply(b, GLINT_OP_MUL, two, apply(b, GLINT_OP_MUL, nl, nv)), lv)
                                   : apply(b, GLINT_OP_DIV, apply(b, GLINT_OP_ADD, nl, nv), half);
    return apply(b, GLINT_OP_POW, apply(b, GLINT_OP_MAX, cosine, number_of(b, 0)), input_of(b, GLINT_INPUT_SHININESS));
}

static inline glint_value make_wave(bool directional, glint_builder *b)
{
    const glint_value own = apply(b, GLINT_OP_MUL, number_of(b, 3), input_of(b, GLINT_INPUT_P_X));
    const glint_value curves = apply(b, GLINT_OP_ADD, apply(b, GLINT_OP_SIN, own, 0),
                                     apply(b, GLINT_OP_SIN, input_of(b, GLINT_INPUT_WORLD_Z), 0));
    const glint_value wave = apply(b, GLINT_OP_ADD, number_of(b, 1.5), apply(b, GLINT_OP_DIV, curves, number_of(b, 4)));
    return directional ? wave
                       : apply(b, GLINT_OP_ADD, wave, apply(b, GLINT_OP_DIV, input_of(b, GLINT_INPUT_DISTANCE), number_of(b, 16)));
}

/// Makes a shader: the model's formula times 1.5 + (sin(3 p.x) + sin(world.z)) / 4 + distance / 16. Under directional
/// light, the factor lacks the distance.
static inline glint_program *make_shader(glint_model model, bool directional)
{
    glint_builder *b;
    glint_program *program;
    glint_error error;
    glint_value outputs[6];
    must(glint_builder_create(GLINT_PROGRAM_SHADER, &b, &error), &error);
    const glint_value factors[2] = { product(b, GLINT_INPUT_N_X, GLINT_INPUT_L_X), make_strength(model, b) };
    for (int k = 0; k < 6; k++) {
        const glint_value light = apply(b, GLINT_OP_MUL, input_of(b, GLINT_INPUT_LIGHT_R + k % 3), make_wave(directional, b));
        const glint_value share = input_of(b, (k < 3 ? GLINT_INPUT_KD_R : GLINT_INPUT_KS_R) + k % 3);
        outputs[k] = apply(b, GLINT_OP_MUL, apply(b, GLINT_OP_MUL, share, light), factors[k / 3]);
    }
    must(glint_builder_finish(b, outputs, 6, &program, &error), &error);
    glint_builder_destroy(b);
    return program;
}

#endif
