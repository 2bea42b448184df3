/// The stage `program`: every operation and thousands of random programs on every instruction set against the scalar
/// reference, and built programs against the same programs without folding, sharing or fusing.
#include "engine/glint_files.h"
#include "tests/engine/png_case.h"
#include "tests/engine/cases/program_case.h"

#include <unistd.h>

#define CASES 4000

static uint32_t damaged[2]; ///< number of programs that were refused, and of programs that ran

/// Sets an operand to one number in all lanes: often a power of two, as is common for `mod` and `div`.
static void put_power(double *x, glint_program_args *args, uint32_t input)
{
    const double power = ldexp(one_in(8) ? 3 : 1, (int)below(12) - 6) * (one_in(8) ? 0x1p600 : 1);
    const double number = one_in(8) ? -power : power;
    for (uint32_t i = 0; i < GLINT_GROUP; i++)
        x[i] = number;
    args->same |= 1u << input;
}

/// Runs one operation on numbers of every kind.
static void operation_case(glint_op op, bool odd)
{
    glint_builder *b;
    glint_program *program;
    glint_error error;
    glint_value operand[GLINT_OPERANDS_MAX], out[GLINT_RESULTS_MAX];
    const glint_op_info *info = glint_op_info_of(op);
    uint32_t texture = 0;
    assert_int_equal(glint_builder_create(GLINT_PROGRAM_PATTERN, &b, &error), GLINT_OK);
    for (uint32_t k = 0; k < info->operands; k++)
        glint_builder_input(b, (glint_input)k, &operand[k], &error);
    if (op == GLINT_OP_NOISE_SLOPE)
        glint_builder_number(b, below(4), &operand[3], &error);
    if (op >= GLINT_OP_TEXEL)
        glint_builder_texture(b, recipe_texture, &texture, &error);
    glint_builder_add(b, op, texture, operand, out, &error);
    assert_int_equal(glint_program_make(b, out, info->results, &program, &error), GLINT_OK);
    const uint32_t groups = 1 + below(GLINT_PROGRAM_GROUPS);
    glint_program_args args = program_inputs(program, groups, odd);
    args.same = 0;
    for (uint32_t k = 0; k < info->operands; k++)
        for (uint32_t i = 0; i < groups * GLINT_GROUP; i++) {
            double *x = &((double *)(uintptr_t)args.input[k])[i];
            if (one_in(3))
                *x = odd && one_in(3) ? either_sign(power_of_ten(-308, 308)) : either_sign(power_of_ten(-3, 3));
            if (one_in(3))
                *x = between(-1.1, 1.1);
            if (one_in(4))
                *x = either_sign(below(5));
        }
    for (uint32_t k = 1; k < info->operands && one_in(2); k++)
        put_power((double *)(uintptr_t)args.input[k], &args, k);
    args.wanted = masks(groups);
    FOR_EACH_TESTED
    {
        for (uint32_t k = 0; k < info->results; k++)
            args.result[k] = output(info->name, KIND_DOUBLE, groups * GLINT_GROUP);
        running->program(&args);
        compare_outputs("program");
    }
    glint_program_release(program);
    glint_builder_destroy(b);
}

static void every_operation(int precision, bool odd)
{
    (void)precision;
    for (int op = 0; op < GLINT_OP_COUNT; op++)
        if (recipe_may_have((glint_op)op)) {
            operation_case((glint_op)op, odd);
            end_case();
        }
}

static void test_operations(void **state)
{
    (void)state;
    run_cases(300, 41000, every_operation);
}

/// Makes the outputs of the running instruction set. `more` allocates an array.
static void make_outputs(glint_program_args *args, uint32_t outputs, uint32_t n, uint32_t groups,
                         void *(*more)(const char *name, array_kind kind, uint32_t count))
{
    for (uint32_t k = 0; k < outputs; k++) {
        args->result[k] = more("result", KIND_DOUBLE, n);
        args->plane[k] = more("plane", KIND_FLOAT, n);
        args->total[k] = more("total", KIND_DOUBLE, n);
        for (uint32_t i = 0; i < n; i++)
            args->total[k][i] = 0.125 * i; // the total starts at an arbitrary value
    }
    args->odd = more("odd", KIND_U16, groups);
}

static void *plain_output(const char *name, array_kind kind, uint32_t count)
{
    return new_array(gotten, &gotten_count, name, kind, count);
}

/// A program that selects between numbers by a parity, with only planes as outputs:
/// often a checkerboard, which has a special kernel.
static void checker_case(int precision, bool odd)
{
    (void)precision;
    glint_builder *b;
    glint_program *program;
    glint_error error;
    glint_value p[3], parity, number[2], out[3];
    const uint32_t groups = 1 + below(GLINT_PROGRAM_GROUPS), places = groups + below(5), outputs = one_in(2) ? 1 : 3;
    uint32_t *place = input(KIND_U32, groups);
    assert_int_equal(glint_builder_create(GLINT_PROGRAM_PATTERN, &b, &error), GLINT_OK);
    for (uint32_t c = 0; c < 3; c++)
        glint_builder_input(b, (glint_input)c, &p[c], &error);
    for (uint32_t c = below(6); c < 3; c++) {
        glint_builder_number(b, maybe_odd(odd, between(-4, 4)), &number[0], &error);
        glint_builder_op(b, GLINT_OP_MUL, (const glint_value[]) { p[c], number[0], 0 }, &p[c], &error);
    }
    glint_builder_op(b, GLINT_OP_PARITY, p, &parity, &error);
    for (uint32_t k = 0; k < outputs; k++) {
        for (int i = 0; i < 2; i++)
            glint_builder_number(b, one_in(8) ? maybe_odd(odd, -0.0) : between(one_in(8) ? -1 : 0, 1), &number[i], &error);
        const glint_value by = k > 0 && one_in(8) ? out[k - 1] : parity, other = one_in(8) ? p[0] : number[1];
        glint_builder_op(b, GLINT_OP_SELECT, (const glint_value[]) { by, number[0], other }, &out[k], &error);
    }
    assert_int_equal(glint_builder_finish(b, out, outputs, &program, &error), GLINT_OK);
    glint_program_args args = program_inputs(program, groups, odd);
    args.wanted = masks(groups);
    for (uint32_t g = 0; g < groups; g++)
        place[g] = g + places - groups;
    args.groups = one_in(2) ? place : NULL;
    FOR_EACH_TESTED
    {
        for (uint32_t k = 0; k < outputs; k++)
            args.plane[k] = output("plane", KIND_FLOAT, places * GLINT_GROUP);
        args.odd = output("odd", KIND_U16, groups);
        running->program(&args);
        compare_outputs("checker");
    }
    glint_program_release(program);
    glint_builder_destroy(b);
}

static void test_checkers(void **state)
{
    (void)state;
    run_cases(CASES, 48000, checker_case);
}

/// Chooses the factors of the outputs, and the sums to which the outputs are added. Some factors of 0 multiply
/// infinities and NaN.
static void random_sums(uint32_t outputs, uint32_t n, bool odd, glint_program_sums *out)
{
    *out = (glint_program_sums) { .by = { NULL } };
    for (uint32_t k = 0; k < outputs; k++) {
        double *by = input(KIND_DOUBLE, n);
        for (uint32_t i = 0; i < n; i++)
            by[i] = one_in(4) ? 0 : maybe_odd(odd, between(-2, 2));
        out->by[k] = one_in(4) ? NULL : by;
        out->sum_of[k] = (uint8_t)below(3);
    }
}

/// Runs the sums on the current instruction set.
/// Clears the lanes that are not requested, because they may hold anything.
static void run_sums(glint_program_args *args, glint_program_sums *sums, uint32_t count, uint32_t n)
{
    for (uint32_t k = 0; k < 3 * count; k++) {
        double *sum = sums[k / 3].sum[k % 3] = output("sum", KIND_DOUBLE, n);
        for (uint32_t i = 0; i < n; i++)
            sum[i] = 0.25 * i; // the sum starts at an arbitrary value
    }
    args->sums = sums;
    args->sums_count = count;
    running->program(args);
    for (uint32_t k = 0; k < 3 * count; k++)
        for (uint32_t i = 0; i < n; i++)
            if (!lane_of(args->wanted, i))
                sums[k / 3].sum[k % 3][i] = 0;
}

/// Tests a program with as many outputs as allowed, several of them identical. Only sums are stored.
static void random_gradient(int precision, bool odd)
{
    (void)precision;
    const recipe r = random_recipe(odd);
    glint_program *program = recipe_build(&r, false);
    const uint32_t groups = 1 + below(GLINT_PROGRAM_GROUPS), n = groups * GLINT_GROUP, count = 1 + below(3);
    glint_program_args args = program_inputs(program, groups, odd);
    glint_program_code code = program->code;
    glint_program_sums sums[3];
    while (code.output_count < GLINT_CODE_OUTPUTS_MAX)
        code.outputs[code.output_count++] = code.outputs[below(program->code.output_count)];
    for (uint32_t k = 0; k < count; k++)
        random_sums(code.output_count, n, odd, &sums[k]);
    args.code = &code;
    args.wanted = masks(groups);
    args.sums_alone = true;
    FOR_EACH_TESTED
    {
        run_sums(&args, sums, count, n);
        compare_outputs("sums");
    }
    glint_program_release(program);
}

/// Tests a program whose outputs are added only where they are finite.
static void random_slopes(int precision, bool odd)
{
    (void)precision;
    const recipe r = random_recipe(odd);
    glint_program *program = recipe_build(&r, false);
    const uint32_t groups = 1 + below(GLINT_PROGRAM_GROUPS), n = groups * GLINT_GROUP, places = groups + below(5);
    uint32_t *place = input(KIND_U32, groups);
    glint_program_args args = program_inputs(program, groups, odd);
    glint_program_code code = program->code;
    float *share = input(KIND_FLOAT, n);
    double *before = input(KIND_DOUBLE, places * GLINT_GROUP);
    while (code.output_count < 3)
        code.outputs[code.output_count++] = code.outputs[0];
    for (uint32_t i = 0; i < n; i++)
        share[i] = (float)(one_in(6) ? 0 : between(0, 1));
    for (uint32_t i = 0; i < places * GLINT_GROUP; i++)
        before[i] = one_in(6) ? -0.0 : between(-1, 1);
    for (uint32_t g = 0; g < groups; g++)
        place[g] = g + places - groups;
    args.code = &code;
    args.wanted = masks(groups);
    args.groups = one_in(2) ? place : NULL;
    args.share = one_in(2) ? share : NULL;
    args.sums_alone = true;
    FOR_EACH_TESTED
    {
        for (int c = 0; c < 3; c++)
            args.added[c] = memcpy(output("added", KIND_DOUBLE, places * GLINT_GROUP), before, places * GLINT_GROUP * sizeof *before);
        args.odd = output("odd", KIND_U16, groups);
        running->program(&args);
        compare_outputs("slopes");
    }
    glint_program_release(program);
}

static void test_gradients(void **state)
{
    (void)state;
    run_cases(CASES / 10, 47000, random_gradient);
    run_cases(CASES / 10, 48000, random_slopes);
}

/// Tests outputs stored as values, as reflectances and as totals of reflectances, in groups at any position.
static void random_program(int precision, bool odd)
{
    (void)precision;
    const recipe r = random_recipe(odd);
    glint_program *program = recipe_build(&r, false), *plain = recipe_build(&r, true);
    const uint32_t groups = 1 + below(GLINT_PROGRAM_GROUPS), places = groups + below(5);
    uint32_t *place = input(KIND_U32, groups);
    glint_program_args args = program_inputs(program, groups, odd);
    double *plain_rows = input(KIND_DOUBLE, (plain->code.row_count + 1) * GLINT_PROGRAM_LANES);
    args.wanted = masks(groups);
    for (uint32_t g = 0; g < groups; g++)
        place[g] = g + places - groups;
    args.groups = one_in(2) ? place : NULL;
    float *share = input(KIND_FLOAT, groups * GLINT_GROUP);
    for (uint32_t i = 0; i < groups * GLINT_GROUP; i++)
        share[i] = (float)(one_in(6) ? 0 : between(0, 1));
    args.share = one_in(2) ? share : NULL;
    FOR_EACH_TESTED
    {
        double *rows = args.rows;
        make_outputs(&args, program->code.output_count, places * GLINT_GROUP, groups, output);
        args.code = &program->code;
        running->program(&args);
        if (running != &glint_stages_ref) {
            compare_outputs("program");
            continue;
        }
        // the reference runs the plain program, for the comparison
        make_outputs(&args, program->code.output_count, places * GLINT_GROUP, groups, plain_output);
        args.code = &plain->code;
        args.rows = plain_rows;
        running->program(&args);
        args.rows = rows;
        compare_outputs("plain program");
    }
    glint_program_release(program);
    glint_program_release(plain);
}

static void test_random_programs(void **state)
{
    (void)state;
    run_cases(CASES, 42000, random_program);
}

/// Tests code in which a few bytes come from another program. The check must accept only code that can run, and the
/// test runs the accepted code.
static void damaged_program(int precision, bool odd)
{
    (void)precision;
    const recipe r = random_recipe(odd);
    glint_program *program = recipe_build(&r, false);
    const size_t bytes = program->code.length * sizeof(glint_instruction);
    glint_instruction *copy = input(KIND_U16, (uint32_t)(bytes / 2 + 1));
    glint_program_args args = program_inputs(program, 1, odd);
    glint_program_code code = program->code;
    memcpy(copy, code.instructions, bytes);
    code.instructions = copy;
    for (uint32_t i = 0; i < 1 + below(3) && bytes; i++) {
        uint16_t *word = (uint16_t *)copy + below((uint32_t)(bytes / 2));
        const uint32_t any[] = { below(64), below(8), GLINT_ROW_INPUT + below(32), GLINT_ROW_NUMBER + below(16),
                                 below(65536) };
        *word = (uint16_t)any[below(5)];
    }
    if (one_in(8))
        code.outputs[0] = (uint16_t)(one_in(2) ? below(600) : below(16));
    if (one_in(8))
        code.row_count = below(8);
    args.code = &code;
    args.wanted = masks(1);
    const bool runs = !glint_code_check(&code, program->number_count, program->texture_count, program->inputs, NULL);
    FOR_EACH_TESTED
    {
        args.result[0] = output("result", KIND_DOUBLE, GLINT_GROUP);
        if (runs)
            running->program(&args);
        compare_outputs("damaged program");
    }
    damaged[runs]++;
    glint_program_release(program);
}

static void test_damaged_programs(void **state)
{
    (void)state;
    run_cases(CASES, 43000, damaged_program);
    assert_true(damaged[0] * case_step() > CASES / 4 && damaged[1] * case_step() > CASES / 10);
}

/// Makes the axes of a camera's rays, of any size.
static glint_camera_args any_camera(bool odd)
{
    glint_camera_args camera = { .groups_across = 1 + below(4) };
    const uint32_t rows = 1 + below(4), across = 3 * camera.groups_across * GLINT_GROUP, down = 3 * rows * GLINT_GROUP;
    double *x = input(KIND_DOUBLE, across), *y = input(KIND_DOUBLE, down);
    for (uint32_t i = 0; i < across; i++)
        x[i] = maybe_odd(odd, between(-2, 2));
    for (uint32_t i = 0; i < down; i++)
        y[i] = maybe_odd(odd, one_in(6) ? -x[i % across] : between(-2, 2));
    camera.across = x;
    camera.down = y;
    camera.group_count = rows * camera.groups_across;
    return camera;
}

/// Tests vectors of any length: between points, along directions or back along a camera's rays. The results go to
/// separate rows or overwrite the input.
static void unit_case(int precision, bool odd)
{
    (void)precision;
    const uint32_t groups = 1 + below(GLINT_PROGRAM_GROUPS), n = groups * GLINT_GROUP;
    const bool one_place = one_in(2), from = one_in(2), in_place = one_in(2), back = one_in(3);
    const bool hard_length = one_in(4); // a length whose last bits are ones, where a reciprocal is hardest to round
    const glint_camera_args camera = any_camera(odd);
    uint32_t *places = input(KIND_U32, groups);
    for (uint32_t g = 0; g < groups; g++)
        places[g] = below(camera.group_count);
    double *to[3], *start[3];
    for (int c = 0; c < 3; c++) {
        to[c] = input(KIND_DOUBLE, n);
        start[c] = input(KIND_DOUBLE, n);
        for (uint32_t i = 0; i < n; i++) {
            const double scale = one_in(8) ? power_of_ten(-200, 200) : 10;
            to[c][i] = maybe_odd(odd, one_in(6) ? (double)below(5) - 2 : between(-scale, scale));
            start[c][i] = maybe_odd(odd, one_in(6) ? to[c][i] : between(-scale, scale));
            if (hard_length)
                start[c][i] = 0;
            if (hard_length && c == 0)
                to[c][i] = ldexp(2 - (1 + below(4)) * 0x1p-52, (int)below(9) - 4);
            else if (hard_length)
                to[c][i] = ldexp(one_in(2) ? 1 : between(-2, 2), -(int)below(80));
        }
    }
    const double place[3] = { to[0][0], to[1][0], to[2][0] };
    FOR_EACH_TESTED
    {
        glint_unit_args args = { .group_count = groups,
                                 .camera = back ? &camera : NULL,
                                 .groups = places,
                                 .position = one_place ? place : NULL,
                                 .length = output("length", KIND_DOUBLE, n) };
        for (int c = 0; c < 3; c++) {
            args.unit[c] = output("unit", KIND_DOUBLE, n);
            args.to[c] = to[c];
            args.from[c] = from ? start[c] : NULL;
            if (in_place)
                args.to[c] = memcpy(args.unit[c], to[c], n * sizeof **to);
        }
        running->unit(&args);
        compare_outputs("unit");
    }
}

static void test_unit(void **state)
{
    (void)state;
    run_cases(CASES, 46000, unit_case);
}

/// Tests a choice of some groups of a tile, each group once.
static void choose_case(int precision, bool odd)
{
    (void)precision;
    (void)odd;
    const uint32_t count = 1 + below(GLINT_PROGRAM_GROUPS), more = below(4), tile = count + more;
    uint32_t *places = input(KIND_U32, count);
    uint16_t *lanes = input(KIND_U16, count), *truths = input(KIND_U16, tile);
    for (uint32_t k = 0; k < count; k++) {
        places[k] = k + (k >= count / 2 ? more : 0);
        lanes[k] = (uint16_t)(one_in(2) ? 0xffff : random_bits());
    }
    for (uint32_t g = 0; g < tile; g++)
        truths[g] = (uint16_t)random_bits();
    const float first = (float)between(0, 2), second = (float)between(0, 2);
    FOR_EACH_TESTED
    {
        const glint_choose_args args = { .group_count = count,
                                         .groups = places,
                                         .wanted = lanes,
                                         .truths = truths,
                                         .number = { first, second },
                                         .plane = output("plane", KIND_FLOAT, tile * GLINT_GROUP) };
        running->choose(&args);
        compare_outputs("choose");
    }
}

static void test_choose(void **state)
{
    (void)state;
    run_cases(200, 47000, choose_case);
}

/// A texture with odd sides and random texels.
static void load_texture(glint_wrap wrap, glint_filter filter)
{
    char path[64];
    uint16_t samples[37 * 21 * 4];
    glint_error error;
    glint_texture_desc desc = glint_texture_desc_default();
    snprintf(path, sizeof path, "/tmp/glint_program_%ld.png", (long)getpid());
    for (size_t i = 0; i < COUNT_OF(samples); i++)
        samples[i] = (uint16_t)random_bits();
    write_png(path, 37, 21, PNG_COLOR_TYPE_RGB_ALPHA, 16, 0, samples);
    desc.wrap = wrap;
    desc.filter = filter;
    if (glint_texture_read(path, &desc, &recipe_texture, &error))
        fail_msg("%s", error.message);
    remove(path);
}

static void texel_operations(int precision, bool odd)
{
    (void)precision;
    operation_case(GLINT_OP_TEXEL, odd);
    end_case();
    operation_case(GLINT_OP_TEXEL_SLOPE, odd);
}

static void test_texels(void **state)
{
    (void)state;
    for (int kind = 0; kind < 6; kind++) {
        load_texture((glint_wrap)(kind % 3), (glint_filter)(kind / 3));
        run_cases(200, 44000, texel_operations);
        run_cases(200, 45000, random_program);
        glint_texture_release(recipe_texture);
        recipe_texture = NULL;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_operations),
        cmocka_unit_test(test_random_programs),
        cmocka_unit_test(test_gradients),
        cmocka_unit_test(test_damaged_programs),
        cmocka_unit_test(test_checkers),
        cmocka_unit_test(test_unit),
        cmocka_unit_test(test_choose),
        cmocka_unit_test(test_texels),
    };
    find_tested();
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
