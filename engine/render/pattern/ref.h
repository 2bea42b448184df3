// The reference of the stage `program`, a lane at a time. Included by ref.c.

static double horner(const double *c, int count, double x)
{
    double p = c[count - 1];
    for (int i = count - 2; i >= 0; i--)
        p = p * x + c[i];
    return p;
}
#define HORNER(name, x) horner(name, (int)(sizeof name / sizeof *name), x)

static uint64_t bits_of_double(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static double double_of_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

// ---- exact -------------------------------------------------------------------------------------------------------

static double op_round(double x)
{
    double size = fabs(x), whole = floor(size);
    if (size - whole >= 0.5)
        whole = whole + 1;
    return copysign(whole, x);
}

/// Returns the same as luai_nummod of Lua 5.4; fmod is exact.
static double op_mod(double a, double b)
{
    double m = fmod(a, b);
    if (m > 0 ? b < 0 : m < 0 && b > 0)
        m += b;
    return m;
}

static double op_sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

static double op_smoothstep(double a, double b, double x)
{
    double t = (x - a) / (b - a);
    t = t > 0 ? t : 0;
    t = t < 1 ? t : 1;
    return (t * t) * (3 - 2 * t);
}

static double op_clamp(double x, double a, double b)
{
    x = x > a ? x : a;
    return x < b ? x : b;
}

// ---- elementary --------------------------------------------------------------------------------------------------

/// Returns sine (quarter 0) or cosine (quarter 1): x = q pi/2 + r, |r| <= pi/4.
static double op_sine(double x, unsigned quarter)
{
    static const double sine[] = GLINT_SINE, cosine[] = GLINT_COSINE;
    if (!(fabs(x) <= GLINT_ANGLE_MAX))
        return quarter ? glint_cos(x) : glint_sin(x);
    double q = (x * GLINT_2_PI + GLINT_ROUNDER_DOUBLE) - GLINT_ROUNDER_DOUBLE;
    double r = ((x - q * GLINT_HALF_PI_HIGH) - q * GLINT_HALF_PI_MIDDLE) - q * GLINT_HALF_PI_LOW, z = r * r;
    unsigned quadrant = ((unsigned)(int)q + quarter) & 3;
    double y = quadrant & 1 ? 1 + z * HORNER(cosine, z) : r + (r * z) * HORNER(sine, z);
    return quadrant & 2 ? -y : y;
}

/// Returns 2^y. The power of two is applied in two factors, so that small results can be subnormal.
static double op_exp2(double y)
{
    static const double series[] = GLINT_POWER_OF_2;
    if (isnan(y))
        return y;
    double x = y > -1100 ? y : -1100;
    x = x < 1100 ? x : 1100;
    double n = (x + GLINT_ROUNDER_DOUBLE) - GLINT_ROUNDER_DOUBLE, half = floor(0.5 * n);
    return (HORNER(series, x - n) * ldexp(1, (int)half)) * ldexp(1, (int)(n - half));
}

/// Returns log2 of x = m 2^e, with m in [sqrt(1/2), sqrt(2)).
static double op_log2(double x)
{
    static const double ratio[] = GLINT_LOG2_RATIO;
    if (!(x > 0) || x == INFINITY)
        return x == 0 ? -INFINITY : x < 0 ? NAN : x;
    double e = 0;
    if (x < 0x1p-1022) {
        x = x * 0x1p54;
        e = -54;
    }
    e = e + (double)((int)(bits_of_double(x) >> 52) - 1023);
    double m = double_of_bits((bits_of_double(x) & 0xfffffffffffff) | 0x3ff0000000000000);
    if (m >= GLINT_SQRT2) {
        m = 0.5 * m;
        e = e + 1;
    }
    double s = (m - 1) / (m + 1);
    return e + s * HORNER(ratio, s * s);
}

static double op_pow(double x, double y)
{
    double size = fabs(x), power = op_exp2(y * op_log2(size));
    bool whole = floor(y) == y, odd = whole && 2 * floor(0.5 * y) != y;
    if (size == 1 && !isnan(y))
        power = 1;
    if (x < 0 && x > -INFINITY && !whole)
        power = NAN;
    if (signbit(x) && odd)
        power = -power;
    return x == 1 || y == 0 ? 1 : power;
}

static double op_atan2(double y, double x)
{
    static const double arc[] = GLINT_ARC_TANGENT;
    double ax = fabs(x), ay = fabs(y);
    double low = ax < ay ? ax : ay, high = ax < ay ? ay : ax;
    double t = low == high ? 1 : low / high; // 1 also if both are infinite
    if (high == 0)
        t = 0;
    bool upper = t > GLINT_TAN_PI_8;
    if (upper)
        t = (t - 1) / (t + 1);
    double angle = t * HORNER(arc, t * t);
    if (upper)
        angle = angle + GLINT_PI_4;
    if (ax < ay)
        angle = GLINT_PI_2 - angle;
    if (signbit(x))
        angle = GLINT_PI_1 - angle;
    return isnan(x) || isnan(y) ? NAN : copysign(angle, y);
}

static double op_acos(double x)
{
    static const double arc[] = GLINT_ARC_SINE;
    double size = fabs(x);
    bool middle = size <= 0.5;
    double t = middle ? x : sqrt(0.5 * (1 - size)); // NaN if |x| > 1
    double angle = t * HORNER(arc, t * t);
    if (middle)
        return GLINT_PI_2 - angle;
    return x < 0 ? GLINT_PI_1 - 2 * angle : 2 * angle;
}

/// Returns the highlight S as the stage shade computes it, rounded to float.
static double op_highlight(double x, double s)
{
    if (!(x >= 0x1p-126))
        return 0;
    x = x < 1 ? x : 1;
    s = s > 0 ? s : 0;
    s = s < (double)FLT_MAX ? s : (double)FLT_MAX;
    return (double)highlight_strength((float)s, log2_of((float)x, (float)(x - 1)));
}

#include "engine/render/pattern/ref_pattern.h"

// ---- the interpreter ---------------------------------------------------------------------------------------------

/// Computes the operations with one result. a .. c: the operands.
static double op_of_one(glint_op op, double a, double b, double c)
{
    switch (op) {
    case GLINT_OP_ADD: return a + b;
    case GLINT_OP_SUB: return a - b;
    case GLINT_OP_MUL: return a * b;
    case GLINT_OP_DIV: return a / b;
    case GLINT_OP_NEG: return -a;
    case GLINT_OP_ABS: return fabs(a);
    case GLINT_OP_SQRT: return sqrt(a);
    case GLINT_OP_MIN: return a < b ? a : b;
    case GLINT_OP_MAX: return a > b ? a : b;
    case GLINT_OP_FLOOR: return floor(a);
    case GLINT_OP_CEIL: return ceil(a);
    case GLINT_OP_ROUND: return op_round(a);
    case GLINT_OP_FRACT: return a - floor(a);
    case GLINT_OP_MOD: return op_mod(a, b);
    case GLINT_OP_SIGN: return op_sign(a);
    case GLINT_OP_MULADD: return a * b + c;
    case GLINT_OP_SUBMUL: return a - b * c;
    case GLINT_OP_MULSUB: return a * b - c;
    case GLINT_OP_MIX: return a + c * (b - a);
    case GLINT_OP_LESS: return a < b;
    case GLINT_OP_LESSEQ: return a <= b;
    case GLINT_OP_EQUAL: return a == b;
    case GLINT_OP_AND: return a != 0 && b != 0;
    case GLINT_OP_OR: return a != 0 || b != 0;
    case GLINT_OP_NOT: return a == 0;
    case GLINT_OP_SELECT: return a != 0 ? b : c;
    case GLINT_OP_STEP: return b < a ? 0 : 1;
    case GLINT_OP_SMOOTHSTEP: return op_smoothstep(a, b, c);
    case GLINT_OP_CLAMP: return op_clamp(a, b, c);
    case GLINT_OP_SIN: return op_sine(a, 0);
    case GLINT_OP_COS: return op_sine(a, 1);
    case GLINT_OP_EXP2: return op_exp2(a);
    case GLINT_OP_LOG2: return op_log2(a);
    case GLINT_OP_POW: return op_pow(a, b);
    case GLINT_OP_ATAN2: return op_atan2(a, b);
    case GLINT_OP_ACOS: return op_acos(a);
    case GLINT_OP_HIGHLIGHT: return op_highlight(a, b);
    case GLINT_OP_NOISE: return op_noise(a, b, c, 0, NULL);
    case GLINT_OP_HASH: return op_hash(a, b, c);
    case GLINT_OP_PARITY: return op_parity(a, b, c);
    case GLINT_OP_MULMUL: return (a * b) * c;
    default: return NAN;
    }
}

/// Computes the results of one instruction for a lane.
static void run_instruction(const glint_instruction *at, const glint_program_code *code, const double in[GLINT_OPERANDS_MAX],
                            double out[GLINT_RESULTS_MAX])
{
    switch ((glint_op)at->op) {
    case GLINT_OP_NOISE3:
        for (unsigned k = 0; k < 3; k++)
            out[k] = op_noise(in[0], in[1], in[2], k + 1, NULL);
        break;
    case GLINT_OP_NOISE_SLOPE: op_noise(in[0], in[1], in[2], word_of(in[3]), out); break;
    case GLINT_OP_CELL: op_cell(in, out, NULL); break;
    case GLINT_OP_CELL_SLOPE: op_cell(in, NULL, out); break;
    case GLINT_OP_DOT: out[0] = (in[0] * in[1] + in[2] * in[3]) + in[4] * in[5]; break;
    case GLINT_OP_TEXEL: op_texel(code->textures[at->texture], in, out, NULL); break;
    case GLINT_OP_TEXEL_SLOPE: op_texel(code->textures[at->texture], in, NULL, out); break;
    default: out[0] = op_of_one((glint_op)at->op, in[0], in[1], in[2]);
    }
}

static double row_value(const glint_program_args *args, const double *rows, uint32_t row, uint32_t lane)
{
    if (row >= GLINT_ROW_NUMBER)
        return args->code->numbers[row - GLINT_ROW_NUMBER][0];
    if (row < GLINT_ROW_INPUT)
        return rows[row];
    const uint32_t input = row - GLINT_ROW_INPUT;
    return args->input[input][args->same >> input & 1 ? 0 : lane];
}

static void add_sums(const glint_program_args *args, const double *rows, uint32_t lane)
{
    for (uint32_t k = 0; k < args->code->output_count; k++) {
        const double v = row_value(args, rows, args->code->outputs[k], lane);
        for (const glint_program_sums *sums = args->sums; sums < args->sums + args->sums_count; sums++)
            if (sums->by[k] && sums->by[k][lane] != 0)
                sums->sum[sums->sum_of[k]][lane] += v * sums->by[k][lane];
    }
}

static void store_outputs(const glint_program_args *args, const double *rows, uint32_t lane)
{
    const uint32_t group = lane / GLINT_GROUP;
    const size_t to = (size_t)(args->groups ? args->groups[group] : group) * GLINT_GROUP + lane % GLINT_GROUP;
    for (uint32_t k = 0; k < args->code->output_count; k++) {
        const double v = row_value(args, rows, args->code->outputs[k], lane);
        if (args->result[k])
            args->result[k][to] = v;
        const float reflectance = (float)(v > 0 ? v < GLINT_REFLECTANCE_MAX ? v : GLINT_REFLECTANCE_MAX : 0);
        if (args->plane[k])
            args->plane[k][to] = reflectance;
        if (args->total[k])
            args->total[k][to] += (double)(args->share ? args->share[lane] : 1) * (double)reflectance;
        if (args->plane[k] && args->odd && !(v >= 0 && v <= GLINT_REFLECTANCE_MAX))
            args->odd[group] |= (uint16_t)(1u << lane % GLINT_GROUP);
    }
}

static void add_slopes(const glint_program_args *args, const double *rows, uint32_t lane)
{
    const uint32_t group = lane / GLINT_GROUP;
    const size_t to = (size_t)(args->groups ? args->groups[group] : group) * GLINT_GROUP + lane % GLINT_GROUP;
    double slope[3];
    bool finite = true;
    for (uint32_t k = 0; k < 3; k++) {
        slope[k] = row_value(args, rows, args->code->outputs[k], lane) * (double)(args->share ? args->share[lane] : 1);
        finite = finite && fabs(slope[k]) < HUGE_VAL;
    }
    for (uint32_t k = 0; k < 3 && finite; k++)
        args->added[k][to] += slope[k];
    if (!finite)
        args->odd[group] |= (uint16_t)(1u << lane % GLINT_GROUP);
}

static void program(const glint_program_args *args)
{
    const glint_program_code *code = args->code;
    for (uint32_t g = 0; args->odd && g < args->group_count; g++)
        args->odd[g] = 0;
    for (uint32_t lane = 0; lane < args->group_count * GLINT_GROUP; lane++) {
        double rows[GLINT_PROGRAM_ROWS_MAX];
        if (!(args->wanted[lane / GLINT_GROUP] >> lane % GLINT_GROUP & 1))
            continue;
        for (const glint_instruction *at = code->instructions; at < code->instructions + code->length; at++) {
            double in[GLINT_OPERANDS_MAX] = { 0 }, out[GLINT_RESULTS_MAX];
            for (uint32_t k = 0; k < at->operands; k++)
                in[k] = row_value(args, rows, at->in[k], lane);
            run_instruction(at, code, in, out);
            for (uint32_t k = 0; k < at->results; k++)
                rows[at->out[k]] = out[k];
        }
        if (args->sums_count)
            add_sums(args, rows, lane);
        if (args->added[0])
            add_slopes(args, rows, lane);
        if (!args->sums_alone)
            store_outputs(args, rows, lane);
    }
}

static double direction_to_eye(const glint_camera_args *camera, uint32_t group, int c, uint32_t lane)
{
    const uint32_t x = group % camera->groups_across, y = group / camera->groups_across;
    const double *across = (const double *)camera->across + 3 * x * GLINT_GROUP,
                 *down = (const double *)camera->down + 3 * y * GLINT_GROUP;
    return -(across[(uint32_t)c * GLINT_GROUP + lane] + down[(uint32_t)c * GLINT_GROUP + lane]);
}

static void unit(const glint_unit_args *args)
{
    for (uint32_t lane = 0; lane < args->group_count * GLINT_GROUP; lane++) {
        double d[3];
        for (int c = 0; c < 3; c++)
            d[c] = args->camera
                       ? direction_to_eye(args->camera, args->groups[lane / GLINT_GROUP], c, lane % GLINT_GROUP)
                       : (args->position ? args->position[c] : args->to[c][lane]);
        for (int c = 0; c < 3 && !args->camera && args->from[0]; c++)
            d[c] -= args->from[c][lane];
        const double length = sqrt((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]);
        for (int c = 0; c < 3; c++)
            args->unit[c][lane] = d[c] / length;
        if (args->length)
            args->length[lane] = length;
    }
}

static void choose(const glint_choose_args *args)
{
    for (uint32_t k = 0; k < args->group_count; k++)
        for (uint32_t lane = 0; lane < GLINT_GROUP; lane++)
            if (args->wanted[k] >> lane & 1)
                args->plane[args->groups[k] * GLINT_GROUP + lane] = args->number[args->truths[args->groups[k]] >> lane & 1];
}
