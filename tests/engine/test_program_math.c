/// The elementary functions of programs against multiple-precision arithmetic,
/// and derivatives against differences at 113 bits.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <mpfr.h>
#include <stdio.h>
#include <string.h>

#include "engine/render/program/builder.h"
#include "tests/engine/cases/random.h"

typedef int mpfr_function(mpfr_t, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);

static double ours(glint_op op, double a, double b)
{
    const double operands[GLINT_OPERANDS_MAX] = { a, b };
    double results[GLINT_RESULTS_MAX];
    glint_fold(op, NULL, operands, results);
    return results[0];
}

static int truth_sin(mpfr_t r, mpfr_srcptr a, mpfr_srcptr b, mpfr_rnd_t m) { return (void)b, mpfr_sin(r, a, m); }
static int truth_cos(mpfr_t r, mpfr_srcptr a, mpfr_srcptr b, mpfr_rnd_t m) { return (void)b, mpfr_cos(r, a, m); }
static int truth_exp2(mpfr_t r, mpfr_srcptr a, mpfr_srcptr b, mpfr_rnd_t m) { return (void)b, mpfr_exp2(r, a, m); }
static int truth_log2(mpfr_t r, mpfr_srcptr a, mpfr_srcptr b, mpfr_rnd_t m) { return (void)b, mpfr_log2(r, a, m); }
static int truth_acos(mpfr_t r, mpfr_srcptr a, mpfr_srcptr b, mpfr_rnd_t m) { return (void)b, mpfr_acos(r, a, m); }
static int truth_pow(mpfr_t r, mpfr_srcptr a, mpfr_srcptr b, mpfr_rnd_t m) { return mpfr_pow(r, a, b, m); }
static int truth_atan2(mpfr_t r, mpfr_srcptr a, mpfr_srcptr b, mpfr_rnd_t m) { return mpfr_atan2(r, a, b, m); }

// ---- Errors -------------------------------------------------------------------------------------------------------

/// Returns the error |got - truth| / max(|truth|, least). A correct infinity or NaN counts as 0.
static double error_of(glint_op op, mpfr_function *truth, double a, double b, double least)
{
    mpfr_t x, y, want;
    mpfr_inits2(53, x, y, (mpfr_ptr)0);
    mpfr_init2(want, 200);
    mpfr_set_d(x, a, MPFR_RNDN);
    mpfr_set_d(y, b, MPFR_RNDN);
    truth(want, x, y, MPFR_RNDN);
    const double got = ours(op, a, b), rounded = mpfr_get_d(want, MPFR_RNDN), size = fabs(rounded);
    mpfr_sub_d(want, want, got, MPFR_RNDN);
    double error = fabs(mpfr_get_d(want, MPFR_RNDN)) / (size < least ? least : size);
    if (!isfinite(rounded))
        error = got == rounded || (isnan(got) && isnan(rounded)) ? 0 : INFINITY;
    mpfr_clears(x, y, want, (mpfr_ptr)0);
    return error;
}

typedef double draw(void);

static double draw_angle(void) { return one_in(3) ? between(-7, 7) : between(-1e6, 1e6); }
static double draw_wide_angle(void) { return ldexp(between(-2, 2), (int)below(1000)); }
static double draw_multiple(void) { return (double)below(600000) * 0x1.921fb54442d18p+0; }
static double draw_exponent(void) { return between(-1021, 1023); }
static double draw_low_exponent(void) { return between(-1074, -1022); }
static double draw_any_size(void) { return ldexp(between(1, 2), (int)below(2040) - 1060); }
static double draw_near_1(void) { return 1 + ldexp(between(-1, 1), -(int)below(40)); }
static double draw_base(void) { return between(0, 10); }
static double draw_power(void) { return between(-30, 30); }
static double draw_coordinate(void) { return ldexp(between(-2, 2), (int)below(40) - 20); }
static double draw_cosine(void) { return one_in(2) ? between(-1, 1) : copysign(1 - ldexp(1, -(int)below(53)), between(-1, 1)); }

typedef struct function_case {
    glint_op op;
    mpfr_function *truth;
    draw *a, *b;
    double bound; ///< largest allowed error, as stated in program/elementary.h
    double least; ///< the error is relative to the truth, or to `least` where the truth is smaller
} function_case;

static const function_case functions[] = {
    { GLINT_OP_SIN, truth_sin, draw_angle, NULL, 4e-16, 1 },
    { GLINT_OP_COS, truth_cos, draw_angle, NULL, 4e-16, 1 },
    { GLINT_OP_SIN, truth_sin, draw_wide_angle, NULL, 4e-16, 1 },
    { GLINT_OP_COS, truth_cos, draw_wide_angle, NULL, 4e-16, 1 },
    { GLINT_OP_SIN, truth_sin, draw_multiple, NULL, 1e-15, 1e-300 },
    { GLINT_OP_EXP2, truth_exp2, draw_exponent, NULL, 2.5e-16, 0 },
    { GLINT_OP_EXP2, truth_exp2, draw_low_exponent, NULL, 0x1p-52, 0x1p-1022 },
    { GLINT_OP_LOG2, truth_log2, draw_any_size, NULL, 4e-16, 1 },
    { GLINT_OP_LOG2, truth_log2, draw_near_1, NULL, 4e-16, 1e-300 },
    { GLINT_OP_POW, truth_pow, draw_base, draw_power, 1e-12, 0x1p-1022 },
    { GLINT_OP_POW, truth_pow, draw_any_size, draw_power, 1e-12, 0x1p-1022 },
    { GLINT_OP_ATAN2, truth_atan2, draw_coordinate, draw_coordinate, 6e-16, 1 },
    { GLINT_OP_ACOS, truth_acos, draw_cosine, NULL, 6e-16, 1 },
};

static void test_stated_errors(void **state)
{
    (void)state;
    bool good = true;
    random_state = 51000;
    for (size_t k = 0; k < sizeof functions / sizeof *functions; k++) {
        const function_case *f = &functions[k];
        double worst = 0, at[2] = { 0 };
        for (int i = 0; i < 30000; i += (int)case_step()) {
            const double a = f->a(), b = f->b ? f->b() : 0, error = error_of(f->op, f->truth, a, b, f->least);
            if (!(error <= worst))
                worst = error, at[0] = a, at[1] = b;
        }
        print_message("%s: %.3g, stated %.3g (at %a %a)\n", glint_op_info_of(f->op)->name, worst, f->bound, at[0], at[1]);
        good = good && worst <= f->bound;
    }
    assert_true(good);
}

/// Results follow C99 annex F where it specifies them.
static void test_special_values(void **state)
{
    (void)state;
    static const double odd[] = { 0, -0.0, 1, -1, 2, -2, 3, -3, 0.5, -0.5, 2.5, -2.5, INFINITY, -INFINITY, NAN, 0x1p53,
                                  0x1p-1074, 0x1p1023 };
    const size_t count = sizeof odd / sizeof *odd;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < count; k++) {
            const double a = odd[i], b = odd[k];
            const double got[] = { ours(GLINT_OP_POW, a, b), ours(GLINT_OP_ATAN2, a, b), ours(GLINT_OP_LOG2, a, 0),
                                   ours(GLINT_OP_EXP2, a, 0), ours(GLINT_OP_ACOS, a, 0) };
            const double want[] = { pow(a, b), atan2(a, b), log2(a), exp2(a), acos(a) };
            for (int n = 0; n < 5; n++) {
                bool same = isnan(want[n]) ? isnan(got[n]) : got[n] == want[n] && !signbit(got[n]) == !signbit(want[n]);
                if (!same && isfinite(want[n]) && want[n] != 0)
                    same = fabs(got[n] - want[n]) <= 1e-12 * fabs(want[n]);
                if (!same)
                    fail_msg("function %d of %a, %a: %a, want %a", n, a, b, got[n], want[n]);
            }
        }
}

/// Checks x^s as used in shading. It is right to seven digits, and 0 below 2^-40, which changes no 16-bit pixel
/// value. The logarithm of the result is a product of floats: s and x are each rounded by a relative 2^-24 at most,
/// the logarithm is within three such errors, and the product adds one.
static void test_highlight(void **state)
{
    (void)state;
    random_state = 51500;
    for (int i = 0; i < 100000; i += (int)case_step()) {
        const double x = one_in(2) ? between(0, 1) : 1 - ldexp(between(0, 1), -(int)below(30));
        const double s = ldexp(between(1, 2), (int)below(14)), want = pow(x, s), got = ours(GLINT_OP_HIGHLIGHT, x, s);
        const double bound = 0x1p-24 * (2 - 6 * log(want));
        assert_true(want < 0x1p-40 ? got <= 0x1.0001p-40 : fabs(got - want) <= bound * want);
    }
    assert_true(ours(GLINT_OP_HIGHLIGHT, 1, 1e300) == 1 && ours(GLINT_OP_HIGHLIGHT, 7, 3) == 1);
    assert_true(ours(GLINT_OP_HIGHLIGHT, 0.5, 0) == 1 && ours(GLINT_OP_HIGHLIGHT, 0.5, -3) == 1);
    assert_true(ours(GLINT_OP_HIGHLIGHT, 0, 0) == 0 && ours(GLINT_OP_HIGHLIGHT, -1, 2) == 0);
    assert_true(ours(GLINT_OP_HIGHLIGHT, NAN, 2) == 0 && ours(GLINT_OP_HIGHLIGHT, 0.5, NAN) == 1);
}

// ---- Derivatives --------------------------------------------------------------------------------------------------

enum { BITS = 113 };

static glint_error error;

static glint_builder *building;

static glint_value make(glint_op op, glint_value a, glint_value b, glint_value c)
{
    const glint_value operands[GLINT_OPERANDS_MAX] = { a, b, c };
    glint_value out[GLINT_RESULTS_MAX];
    if (glint_builder_op(building, op, operands, out, &error))
        fail_msg("%s", error.message);
    return out[0];
}

static glint_value constant(double x)
{
    glint_value out;
    assert_int_equal(glint_builder_number(building, x, &out, &error), GLINT_OK);
    return out;
}

/// Computes one operation on the operands x at 113 bits.
static void truth_of(glint_op op, mpfr_t r, mpfr_t *x)
{
    mpfr_t t;
    mpfr_init2(t, BITS);
    switch (op) {
    case GLINT_OP_ADD: mpfr_add(r, x[0], x[1], MPFR_RNDN); break;
    case GLINT_OP_SUB: mpfr_sub(r, x[0], x[1], MPFR_RNDN); break;
    case GLINT_OP_MUL: mpfr_mul(r, x[0], x[1], MPFR_RNDN); break;
    case GLINT_OP_DIV: mpfr_div(r, x[0], x[1], MPFR_RNDN); break;
    case GLINT_OP_NEG: mpfr_neg(r, x[0], MPFR_RNDN); break;
    case GLINT_OP_ABS: mpfr_abs(r, x[0], MPFR_RNDN); break;
    case GLINT_OP_SQRT: mpfr_sqrt(r, x[0], MPFR_RNDN); break;
    case GLINT_OP_MIN: mpfr_min(r, x[0], x[1], MPFR_RNDN); break;
    case GLINT_OP_MAX: mpfr_max(r, x[0], x[1], MPFR_RNDN); break;
    case GLINT_OP_FLOOR: mpfr_floor(r, x[0]); break;
    case GLINT_OP_CEIL: mpfr_ceil(r, x[0]); break;
    case GLINT_OP_ROUND: mpfr_round(r, x[0]); break;
    case GLINT_OP_SIGN: mpfr_set_si(r, mpfr_sgn(x[0]), MPFR_RNDN); break;
    case GLINT_OP_FRACT: mpfr_floor(t, x[0]), mpfr_sub(r, x[0], t, MPFR_RNDN); break;
    case GLINT_OP_MOD:
        mpfr_div(t, x[0], x[1], MPFR_RNDN), mpfr_floor(t, t);
        mpfr_mul(t, t, x[1], MPFR_RNDN), mpfr_sub(r, x[0], t, MPFR_RNDN);
        break;
    case GLINT_OP_MULMUL: mpfr_mul(t, x[0], x[1], MPFR_RNDN), mpfr_mul(r, t, x[2], MPFR_RNDN); break;
    case GLINT_OP_MULADD: mpfr_mul(t, x[0], x[1], MPFR_RNDN), mpfr_add(r, t, x[2], MPFR_RNDN); break;
    case GLINT_OP_MULSUB: mpfr_mul(t, x[0], x[1], MPFR_RNDN), mpfr_sub(r, t, x[2], MPFR_RNDN); break;
    case GLINT_OP_SUBMUL: mpfr_mul(t, x[1], x[2], MPFR_RNDN), mpfr_sub(r, x[0], t, MPFR_RNDN); break;
    case GLINT_OP_DOT:
        mpfr_mul(r, x[0], x[1], MPFR_RNDN);
        for (int k = 2; k < 6; k += 2)
            mpfr_mul(t, x[k], x[k + 1], MPFR_RNDN), mpfr_add(r, r, t, MPFR_RNDN);
        break;
    case GLINT_OP_MIX:
        mpfr_sub(t, x[1], x[0], MPFR_RNDN), mpfr_mul(t, t, x[2], MPFR_RNDN), mpfr_add(r, x[0], t, MPFR_RNDN);
        break;
    case GLINT_OP_LESS: mpfr_set_si(r, mpfr_less_p(x[0], x[1]), MPFR_RNDN); break;
    case GLINT_OP_SELECT: mpfr_set(r, mpfr_zero_p(x[0]) ? x[2] : x[1], MPFR_RNDN); break;
    case GLINT_OP_CLAMP: mpfr_max(t, x[0], x[1], MPFR_RNDN), mpfr_min(r, t, x[2], MPFR_RNDN); break;
    case GLINT_OP_SMOOTHSTEP:
        mpfr_sub(t, x[1], x[0], MPFR_RNDN), mpfr_sub(r, x[2], x[0], MPFR_RNDN), mpfr_div(t, r, t, MPFR_RNDN);
        if (mpfr_sgn(t) < 0)
            mpfr_set_zero(t, 1);
        if (mpfr_cmp_ui(t, 1) > 0)
            mpfr_set_ui(t, 1, MPFR_RNDN);
        mpfr_mul_si(r, t, -2, MPFR_RNDN), mpfr_add_ui(r, r, 3, MPFR_RNDN);
        mpfr_mul(r, r, t, MPFR_RNDN), mpfr_mul(r, r, t, MPFR_RNDN);
        break;
    case GLINT_OP_SIN: mpfr_sin(r, x[0], MPFR_RNDN); break;
    case GLINT_OP_COS: mpfr_cos(r, x[0], MPFR_RNDN); break;
    case GLINT_OP_EXP2: mpfr_exp2(r, x[0], MPFR_RNDN); break;
    case GLINT_OP_LOG2: mpfr_log2(r, x[0], MPFR_RNDN); break;
    case GLINT_OP_POW: mpfr_pow(r, x[0], x[1], MPFR_RNDN); break;
    case GLINT_OP_ATAN2: mpfr_atan2(r, x[0], x[1], MPFR_RNDN); break;
    case GLINT_OP_ACOS: mpfr_acos(r, x[0], MPFR_RNDN); break;
    default: fail_msg("%s has no truth", glint_op_info_of(op)->name);
    }
    mpfr_clear(t);
}

/// Computes the first output of a program at the point p, at 113 bits.
static void truth_at(const glint_program *program, mpfr_t *p, mpfr_t out)
{
    const glint_program_code *code = &program->code;
    static mpfr_t rows[GLINT_PROGRAM_ROWS_MAX], in[GLINT_OPERANDS_MAX];
    static bool ready;
    for (int i = 0; !ready && i < GLINT_PROGRAM_ROWS_MAX; i++)
        mpfr_init2(rows[i], BITS);
    for (int i = 0; !ready && i < GLINT_OPERANDS_MAX; i++)
        mpfr_init2(in[i], BITS);
    ready = true;
    for (uint32_t at = 0; at <= code->length; at++) {
        const glint_instruction *i = &code->instructions[at];
        const bool last = at == code->length;
        for (uint32_t k = 0; k < (last ? 1 : i->operands); k++) {
            const uint32_t from = last ? code->outputs[0] : i->in[k];
            if (from >= GLINT_ROW_NUMBER)
                mpfr_set_d(in[k], code->numbers[from - GLINT_ROW_NUMBER][0], MPFR_RNDN);
            else
                mpfr_set(in[k], from >= GLINT_ROW_INPUT ? p[from - GLINT_ROW_INPUT] : rows[from], MPFR_RNDN);
        }
        if (last)
            mpfr_set(out, in[0], MPFR_RNDN);
        else
            truth_of((glint_op)i->op, rows[i->out[0]], in);
    }
}

/// Computes the derivative along an axis by a central difference with step 2^-36. The error is the squared step times
/// the third derivative.
static double difference(const glint_program *program, const double at[3], int axis)
{
    mpfr_t p[3], low, high;
    mpfr_inits2(BITS, p[0], p[1], p[2], low, high, (mpfr_ptr)0);
    for (int k = 0; k < 3; k++)
        mpfr_set_d(p[k], at[k], MPFR_RNDN);
    mpfr_sub_d(p[axis], p[axis], 0x1p-36, MPFR_RNDN);
    truth_at(program, p, low);
    mpfr_add_d(p[axis], p[axis], 0x1p-35, MPFR_RNDN);
    truth_at(program, p, high);
    mpfr_sub(high, high, low, MPFR_RNDN);
    mpfr_div_d(high, high, 0x1p-35, MPFR_RNDN);
    const double slope = mpfr_get_d(high, MPFR_RNDN);
    mpfr_clears(p[0], p[1], p[2], low, high, (mpfr_ptr)0);
    return slope;
}

static const glint_input axes[3] = { GLINT_INPUT_P_X, GLINT_INPUT_P_Y, GLINT_INPUT_P_Z };

/// Checks the derivatives of an expression at random points, each to a relative error of 1e-11.
static void check_slopes(const char *name, glint_value root, double low, double high)
{
    glint_program *program, *slope;
    if (glint_builder_finish(building, &root, 1, &program, &error) || glint_program_slope(program, axes, 3, &slope, &error))
        fail_msg("%s: %s", name, error.message);
    for (int i = 0; i < 200; i++) {
        double inputs[GLINT_INPUT_COUNT] = { 0 }, got[3];
        for (int k = 0; k < 3; k++)
            inputs[k] = between(low, high);
        assert_int_equal(glint_program_evaluate(slope, inputs, got, &error), GLINT_OK);
        for (int k = 0; k < 3; k++) {
            const double want = difference(program, inputs, k);
            if (!(fabs(got[k] - want) <= 1e-11 * (1 + fabs(want))))
                fail_msg("d %s / d %c at %a %a %a: %.17g, want %.17g", name, "xyz"[k], inputs[0], inputs[1], inputs[2],
                         got[k], want);
        }
    }
    glint_program_release(program);
    glint_program_release(slope);
}

static void begin(glint_value p[3])
{
    assert_int_equal(glint_builder_create(GLINT_PROGRAM_PATTERN, &building, &error), GLINT_OK);
    for (int k = 0; k < 3; k++)
        assert_int_equal(glint_builder_input(building, axes[k], &p[k], &error), GLINT_OK);
}

static void test_slopes_of_operations(void **state)
{
    (void)state;
    random_state = 52000;
    for (int op = 0; op < GLINT_OP_HIGHLIGHT; op++) {
        const bool truth_is_0_or_1 = op == GLINT_OP_LESSEQ || op == GLINT_OP_EQUAL || op == GLINT_OP_AND ||
                                     op == GLINT_OP_OR || op == GLINT_OP_NOT || op == GLINT_OP_STEP;
        glint_value p[3];
        if (truth_is_0_or_1)
            continue;
        begin(p);
        const bool positive = op == GLINT_OP_SQRT || op == GLINT_OP_LOG2 || op == GLINT_OP_POW;
        const double most = op == GLINT_OP_ACOS ? 0.99 : 3, least = positive ? 0.1 : op == GLINT_OP_ACOS ? -0.99 : -3;
        check_slopes(glint_op_info_of((glint_op)op)->name, make((glint_op)op, p[0], p[1], p[2]), least, most);
        glint_builder_destroy(building);
    }
}

/// Tests the derivatives of typical bump functions.
static void test_slopes_of_programs(void **state)
{
    (void)state;
    glint_value p[3];
    random_state = 53000;
    begin(p);
    const glint_value square = make(GLINT_OP_MULADD, p[0], p[0], make(GLINT_OP_MUL, p[2], p[2], 0));
    const glint_value radius = make(GLINT_OP_SQRT, square, 0, 0);
    check_slopes("rings", make(GLINT_OP_FRACT, make(GLINT_OP_MUL, radius, constant(8), 0), 0, 0), -3, 3);
    check_slopes("waves", make(GLINT_OP_MUL, make(GLINT_OP_SIN, make(GLINT_OP_MUL, radius, constant(5), 0), 0, 0),
                               make(GLINT_OP_EXP2, make(GLINT_OP_NEG, p[1], 0, 0), 0, 0), 0), -3, 3);
    const glint_value edge = make(GLINT_OP_MIN, make(GLINT_OP_FRACT, p[0], 0, 0), make(GLINT_OP_FRACT, p[1], 0, 0), 0);
    check_slopes("bricks", make(GLINT_OP_SMOOTHSTEP, constant(0.05), constant(0.1), edge), -3, 3);
    check_slopes("product", make(GLINT_OP_MUL, make(GLINT_OP_MUL, p[0], p[1], 0), p[2], 0), -3, 3);
    const glint_value two = make(GLINT_OP_ADD, make(GLINT_OP_MUL, p[0], p[1], 0), make(GLINT_OP_MUL, p[1], p[2], 0), 0);
    check_slopes("dot", make(GLINT_OP_ADD, two, make(GLINT_OP_MUL, p[2], p[0], 0), 0), -3, 3);
    const glint_value turn = make(GLINT_OP_ATAN2, p[1], p[0], 0);
    check_slopes("screw", make(GLINT_OP_POW, make(GLINT_OP_CLAMP, make(GLINT_OP_ADD, turn, p[2], 0), constant(0.1),
                                                  constant(3)), constant(2.5), 0), -3, 3);
    glint_builder_destroy(building);
}

// ---- Derivatives with their own kernels ---------------------------------------------------------------------------

/// Noise by its definition: the gradients at the integer points (the derivatives there) times the offset from each of
/// these points, blended by the fade.
static long double noise_by_definition(uint32_t k, const long double p[3])
{
    long double sum = 0;
    for (int c = 0; c < 8; c++) {
        long double weight = 1, ramp = 0;
        double corner[GLINT_OPERANDS_MAX] = { 0, 0, 0, k }, gradient[GLINT_RESULTS_MAX];
        for (int i = 0; i < 3; i++)
            corner[i] = (double)(floorl(p[i]) + (c >> i & 1));
        glint_fold(GLINT_OP_NOISE_SLOPE, NULL, corner, gradient);
        for (int i = 0; i < 3; i++) {
            const long double t = p[i] - floorl(p[i]), fade = t * t * t * (t * (6 * t - 15) + 10);
            weight *= c >> i & 1 ? fade : 1 - fade;
            ramp += gradient[i] * (p[i] - corner[i]);
        }
        sum += weight * ramp;
    }
    return sum;
}

static void test_noise_slopes(void **state)
{
    (void)state;
    random_state = 54000;
    for (int i = 0; i < 20000; i += (int)case_step()) {
        const uint32_t k = below(4);
        double operands[GLINT_OPERANDS_MAX] = { between(-50, 50), between(-50, 50), between(-50, 50), k };
        double value[GLINT_RESULTS_MAX], slope[GLINT_RESULTS_MAX];
        const long double p[3] = { operands[0], operands[1], operands[2] };
        glint_fold(k ? GLINT_OP_NOISE3 : GLINT_OP_NOISE, NULL, operands, value);
        glint_fold(GLINT_OP_NOISE_SLOPE, NULL, operands, slope);
        assert_true(fabsl(value[k ? k - 1 : 0] - noise_by_definition(k, p)) < 1e-14L);
        for (int axis = 0; axis < 3; axis++) {
            long double low[3] = { p[0], p[1], p[2] }, high[3] = { p[0], p[1], p[2] };
            low[axis] -= 0x1p-20L, high[axis] += 0x1p-20L;
            const long double want = (noise_by_definition(k, high) - noise_by_definition(k, low)) / 0x1p-19L;
            if (!(fabsl(slope[axis] - want) < 1e-10L))
                fail_msg("noise slope %d: %.12g, want %.12Lg", axis, slope[axis], want);
        }
    }
}

/// Cell distances grow by one per unit: the gradients have length 1 and equal the differences.
static void test_cell_slopes(void **state)
{
    (void)state;
    random_state = 55000;
    uint32_t kinks = 0;
    for (int i = 0; i < 5000; i++) {
        double p[GLINT_OPERANDS_MAX] = { between(-50, 50), between(-50, 50), between(-50, 50) };
        double slope[GLINT_RESULTS_MAX], low[GLINT_RESULTS_MAX], high[GLINT_RESULTS_MAX];
        glint_fold(GLINT_OP_CELL_SLOPE, NULL, p, slope);
        for (int n = 0; n < 2; n++) {
            const double *s = slope + 3 * n;
            assert_true(fabs(sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) - 1) < 1e-14);
        }
        for (int axis = 0; axis < 3; axis++) {
            double at[GLINT_OPERANDS_MAX] = { p[0], p[1], p[2] };
            at[axis] = p[axis] - 1e-5;
            glint_fold(GLINT_OP_CELL, NULL, at, low);
            at[axis] = p[axis] + 1e-5;
            glint_fold(GLINT_OP_CELL, NULL, at, high);
            for (int n = 0; n < 2; n++)
                kinks += fabs((high[n] - low[n]) / 2e-5 - slope[3 * n + axis]) > 1e-6;
        }
    }
    // a few of the 30000 differences cross a kink, where two feature points are equally far away
    assert_true(kinks < 60);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stated_errors),        cmocka_unit_test(test_special_values),
        cmocka_unit_test(test_highlight),
        cmocka_unit_test(test_slopes_of_operations), cmocka_unit_test(test_slopes_of_programs),
        cmocka_unit_test(test_noise_slopes),         cmocka_unit_test(test_cell_slopes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
