/// Times programs in the frame's kernel, 128 points at a time: nanoseconds per point, including the time to store the
/// results as reflectances.
#include <string.h>

#include "engine/render/program/program.h"
#include "tests/bench/glint_side.h"
#include "tests/bench/program_points.h"

static glint_builder *builder;
static glint_error error;
static double dark; ///< the darker colour of a pattern

static glint_value number(double x)
{
    glint_value out;
    side_must(glint_builder_number(builder, x, &out, &error), &error);
    return out;
}

static glint_value op(glint_op which, glint_value a, glint_value b, glint_value c)
{
    const glint_value operands[] = { a, b, c };
    glint_value out[GLINT_RESULTS_MAX];
    side_must(glint_builder_op(builder, which, operands, out, &error), &error);
    return out[0];
}

static glint_value add(glint_value a, glint_value b) { return op(GLINT_OP_ADD, a, b, 0); }
static glint_value mul(glint_value a, glint_value b) { return op(GLINT_OP_MUL, a, b, 0); }

static void read3(glint_input first, glint_value out[3])
{
    for (int c = 0; c < 3; c++)
        side_must(glint_builder_input(builder, (glint_input)(first + c), &out[c], &error), &error);
}

static glint_value dot(const glint_value a[3], const glint_value b[3])
{
    return add(add(mul(a[0], b[0]), mul(a[1], b[1])), mul(a[2], b[2]));
}

static size_t phong(glint_value out[6])
{
    glint_value n[3], l[3], v[3], r[3], kd[3], ks[3], light[3], shininess;
    read3(GLINT_INPUT_N_X, n), read3(GLINT_INPUT_L_X, l), read3(GLINT_INPUT_V_X, v);
    read3(GLINT_INPUT_KD_R, kd), read3(GLINT_INPUT_KS_R, ks), read3(GLINT_INPUT_LIGHT_R, light);
    side_must(glint_builder_input(builder, GLINT_INPUT_SHININESS, &shininess, &error), &error);
    const glint_value cosine = dot(n, l), twice = mul(number(2), cosine);
    for (int c = 0; c < 3; c++)
        r[c] = op(GLINT_OP_SUB, mul(twice, n[c]), l[c], 0);
    const glint_value highlight = op(GLINT_OP_HIGHLIGHT, dot(r, v), shininess, 0);
    for (int c = 0; c < 3; c++) {
        out[c] = mul(mul(kd[c], light[c]), cosine);
        out[3 + c] = mul(mul(ks[c], light[c]), highlight);
    }
    return 6;
}

static size_t checker(glint_value out[6])
{
    glint_value p[3];
    read3(GLINT_INPUT_P_X, p);
    out[0] = op(GLINT_OP_SELECT, op(GLINT_OP_PARITY, p[0], p[1], p[2]), number(dark), number(0.9));
    return 1;
}

static glint_value octaves(const glint_value p[3])
{
    glint_value sum = number(0);
    for (double size = 1, strength = 1; size < 8; size *= 2, strength /= 2) {
        const glint_value k = number(size), noise = op(GLINT_OP_NOISE, mul(p[0], k), mul(p[1], k), mul(p[2], k));
        sum = add(sum, mul(number(strength), noise));
    }
    return sum;
}

static size_t noise(glint_value out[6])
{
    glint_value p[3];
    read3(GLINT_INPUT_P_X, p);
    out[0] = octaves(p);
    return 1;
}

static size_t marble(glint_value out[6])
{
    glint_value p[3];
    read3(GLINT_INPUT_P_X, p);
    const glint_value wave = op(GLINT_OP_SIN, add(mul(p[0], number(7)), mul(octaves(p), number(5))), 0, 0);
    const glint_value share = op(GLINT_OP_MULADD, wave, number(0.5), number(0.5));
    for (int c = 0; c < 3; c++)
        out[c] = op(GLINT_OP_MIX, number(0.9), number(dark + 0.1 * c), share);
    return 3;
}

static size_t cells(glint_value out[6])
{
    glint_value p[3];
    read3(GLINT_INPUT_P_X, p);
    out[0] = op(GLINT_OP_CELL, p[0], p[1], p[2]);
    return 1;
}

typedef struct named {
    const char *name;
    glint_program_kind kind;
    size_t (*make)(glint_value out[6]); ///< builds the program and returns the number of outputs
} named;

static const named programs[] = {
    { "phong", GLINT_PROGRAM_SHADER, phong },   { "checker", GLINT_PROGRAM_PATTERN, checker },
    { "octaves", GLINT_PROGRAM_PATTERN, noise }, { "marble", GLINT_PROGRAM_PATTERN, marble },
    { "cells", GLINT_PROGRAM_PATTERN, cells },
};
enum { PROGRAMS = sizeof programs / sizeof *programs };

static glint_program *create(const named *of, double number)
{
    glint_program *program;
    glint_value out[6];
    dark = number;
    side_must(glint_builder_create(of->kind, &builder, &error), &error);
    side_must(glint_builder_finish(builder, out, of->make(out), &program, &error), &error);
    glint_builder_destroy(builder);
    return program;
}

glint_program *side_program_create(const char *pattern, double number)
{
    for (int i = 0; i < PROGRAMS; i++)
        if (strcmp(programs[i].name, pattern) == 0)
            return create(&programs[i], number);
    if (strcmp(pattern, "none") != 0)
        bench_fail(pattern, "no such pattern");
    return NULL;
}

typedef struct runner {
    const glint_stages *stages;
    glint_program_args args;
} runner;

static double time_points(void *state)
{
    const runner *r = state;
    const double start = bench_now_ms();
    for (int i = 0; i < PROGRAM_REPEATS; i++)
        r->stages->program(&r->args);
    return bench_now_ms() - start;
}

static void run(const named *of)
{
    static const uint16_t all[GLINT_PROGRAM_GROUPS] = { 65535, 65535, 65535, 65535, 65535, 65535, 65535, 65535 };
    static _Alignas(64) double rows[GLINT_PROGRAM_ROWS_MAX][GLINT_PROGRAM_LANES];
    static program_points points;
    const char *asked;
    bool unknown;
    glint_program *program = create(of, 0.05);
    program_points_fill(&points);
    runner r = { .stages = glint_stages_select(NULL, &asked, &unknown) };
    r.args = (glint_program_args) { .code = &program->code, .group_count = PROGRAM_POINTS / GLINT_GROUP, .wanted = all };
    r.args.rows = rows[0];
    for (int i = 0; i < GLINT_INPUT_COUNT; i++)
        r.args.input[i] = points.input[i];
    for (size_t k = 0; k < glint_program_output_count(program); k++)
        r.args.plane[k] = points.plane[k];
    bench_say(of->name, "ns", bench_median(time_points, &r) * 1e6 / ((double)PROGRAM_REPEATS * PROGRAM_POINTS));
    glint_program_release(program);
}

void side_run_program(const bench_options *options)
{
    (void)options;
    for (int i = 0; i < PROGRAMS; i++)
        run(&programs[i]);
}
