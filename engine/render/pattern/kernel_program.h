// The stage `program`: one call for each instruction, over all lanes. Contract: contract.h.
#ifndef GLINT_PATTERN_KERNEL_PROGRAM_H
#define GLINT_PATTERN_KERNEL_PROGRAM_H

#include "engine/render/pattern/kernel_call.h"
#include "engine/render/pattern/kernel_cell.h"
#include "engine/render/pattern/kernel_elementary.h"
#include "engine/render/pattern/kernel_exact.h"
#include "engine/render/pattern/kernel_noise.h"
#include "engine/render/pattern/kernel_texel.h"
#include "engine/render/stages/simd/elementary.h"

static void (*const op_kernels[GLINT_OP_COUNT])(const op_call *call) = {
    [GLINT_OP_ADD] = op_add,
    [GLINT_OP_SUB] = op_sub,
    [GLINT_OP_MUL] = op_mul,
    [GLINT_OP_DIV] = op_div,
    [GLINT_OP_NEG] = op_neg,
    [GLINT_OP_ABS] = op_abs,
    [GLINT_OP_SQRT] = op_sqrt,
    [GLINT_OP_MIN] = op_min,
    [GLINT_OP_MAX] = op_max,
    [GLINT_OP_FLOOR] = op_floor,
    [GLINT_OP_CEIL] = op_ceil,
    [GLINT_OP_ROUND] = op_round,
    [GLINT_OP_FRACT] = op_fract,
    [GLINT_OP_MOD] = op_mod,
    [GLINT_OP_SIGN] = op_sign,
    [GLINT_OP_MULADD] = op_muladd,
    [GLINT_OP_SUBMUL] = op_submul,
    [GLINT_OP_MULSUB] = op_mulsub,
    [GLINT_OP_MIX] = op_mix,
    [GLINT_OP_LESS] = op_less,
    [GLINT_OP_LESSEQ] = op_lesseq,
    [GLINT_OP_EQUAL] = op_equal,
    [GLINT_OP_AND] = op_and,
    [GLINT_OP_OR] = op_or,
    [GLINT_OP_NOT] = op_not,
    [GLINT_OP_SELECT] = op_select,
    [GLINT_OP_STEP] = op_step,
    [GLINT_OP_SMOOTHSTEP] = op_smoothstep,
    [GLINT_OP_CLAMP] = op_clamp,
    [GLINT_OP_SIN] = op_sin,
    [GLINT_OP_COS] = op_cos,
    [GLINT_OP_EXP2] = op_exp2,
    [GLINT_OP_LOG2] = op_log2,
    [GLINT_OP_POW] = op_pow,
    [GLINT_OP_ATAN2] = op_atan2,
    [GLINT_OP_ACOS] = op_acos,
    [GLINT_OP_HIGHLIGHT] = op_highlight,
    [GLINT_OP_NOISE] = op_noise,
    [GLINT_OP_NOISE3] = op_noise3,
    [GLINT_OP_CELL] = op_cell,
    [GLINT_OP_HASH] = op_hash,
    [GLINT_OP_PARITY] = op_parity,
    [GLINT_OP_MULMUL] = op_mulmul,
    [GLINT_OP_DOT] = op_dot,
    [GLINT_OP_NOISE_SLOPE] = op_noise_slope,
    [GLINT_OP_CELL_SLOPE] = op_cell_slope,
    [GLINT_OP_TEXEL] = op_texel,
    [GLINT_OP_TEXEL_SLOPE] = op_texel_slope,
};

/// Returns where an operand is read; `step` as in op_call.
static inline const double *find_operand(const glint_program_args *args, uint32_t row, size_t *step)
{
    *step = ~(size_t)0;
    if (row < GLINT_ROW_INPUT)
        return args->rows + row * GLINT_PROGRAM_LANES;
    if (row < GLINT_ROW_NUMBER) {
        *step = args->same >> (row - GLINT_ROW_INPUT) & 1 ? 0 : *step;
        return args->input[row - GLINT_ROW_INPUT];
    }
    *step = 0;
    return args->code->numbers[row - GLINT_ROW_NUMBER];
}

/// Converts VF numbers to reflectances; NaN gives 0. The numbers are rounded before they are clamped, because the
/// bounds are floats.
INNER vf reflectances(vd low, vd high)
{
    return f_min(f_max(f_join(low, high), f_set(0)), f_set((float)GLINT_REFLECTANCE_MAX));
}

/// Returns the lanes whose numbers are valid reflectances without clamping.
INNER dm are_even(vd x) { return dm_and(d_le(d_set(0), x), d_le(x, d_set(GLINT_REFLECTANCE_MAX))); }

/// Returns the lanes of a group whose numbers are not valid reflectances.
INNER unsigned find_odd(const double *from)
{
    unsigned even = 0;
    for (int i = 0; i < GLINT_GROUP; i += VD)
        even |= dm_bits(are_even(d_load(from + i))) << i;
    return ~even;
}

/// One output of a call: the row, and the positions of the groups in the result.
typedef struct output {
    const glint_program_args *args;
    const double *row;
    size_t step;
    bool whole; ///< true: all lanes are wanted, and the groups are consecutive; see is_whole
} output;

INNER const double *output_of(const output *out, uint32_t g) { return out->row + ((size_t)g * GLINT_GROUP & out->step); }

INNER size_t place_of(const output *out, uint32_t g)
{
    return (size_t)(out->args->groups ? out->args->groups[g] : g) * GLINT_GROUP;
}

static bool is_whole(const glint_program_args *args)
{
    unsigned wanted = 0xffff, apart = 0; // gathered without a branch for each group
    for (uint32_t g = 0; g < args->group_count; g++)
        wanted &= args->wanted[g];
    for (uint32_t g = 0; args->groups && g < args->group_count; g++)
        apart |= args->groups[g] ^ (args->groups[0] + g);
    return wanted == 0xffff && !apart;
}

/// Records in `odd` the lanes whose values are not valid reflectances.
static void note_odd(const output *out)
{
    for (uint32_t g = 0; g < out->args->group_count; g++)
        out->args->odd[g] |= (uint16_t)(find_odd(output_of(out, g)) & out->args->wanted[g]);
}

/// Stores the results of a whole call. If `watched`, a constant, is true, returns whether all are valid reflectances.
INNER bool store_lanes(const output *out, const bool watched, float *to)
{
    const size_t step = out->step, count = (size_t)out->args->group_count * GLINT_GROUP;
    const double *row = out->row;
    dm even = d_eq(d_set(0), d_set(0));
    for (size_t i = 0; i < count; i += GLINT_GROUP)
        for (size_t k = 0; k < GLINT_GROUP; k += VF) {
            const double *from = row + (i & step) + k;
            const vd low = d_load(from), high = d_load(from + VD);
            f_store(to + i + k, reflectances(low, high));
            if (watched)
                even = dm_and(even, dm_and(are_even(low), are_even(high)));
        }
    return dm_bits(even) == D_ALL;
}

static void store_whole_plane(const output *out, float *plane)
{
    float *to = plane + place_of(out, 0);
    if (!out->args->odd)
        store_lanes(out, false, to);
    else if (!store_lanes(out, true, to))
        note_odd(out);
}

static void store_plane(const output *out, float *plane)
{
    for (uint32_t g = 0; g < out->args->group_count; g++) {
        const double *from = output_of(out, g);
        float *to = plane + place_of(out, g);
        const unsigned wanted = out->args->wanted[g];
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const fm here = fm_from_bits(wanted >> i & ((1u << VF) - 1));
            f_store(to + i, f_select(here, reflectances(d_load(from + i), d_load(from + i + VD)), f_load(to + i)));
        }
    }
    if (out->args->odd)
        note_odd(out);
}

/// Adds an output, rounded as in store_plane, times `share`, to a total.
static void add_total(const output *out, double *total)
{
    for (uint32_t g = 0; g < out->args->group_count; g++) {
        const double *from = output_of(out, g);
        const float *share = out->args->share ? out->args->share + (size_t)g * GLINT_GROUP : NULL;
        double *to = total + place_of(out, g);
        const unsigned wanted = out->args->wanted[g];
        for (int i = 0; wanted && i < GLINT_GROUP; i += VF) {
            vd v[VF / VD], weight[VF / VD];
            f_split(reflectances(d_load(from + i), d_load(from + i + VD)), v);
            f_split(share ? f_load(share + i) : f_set(1), weight);
            for (int k = 0; k < VF / VD; k++) {
                const vd old = d_load(to + i + k * VD), sum = old + weight[k] * v[k];
                d_store(to + i + k * VD, d_select(dm_from_bits(wanted >> (i + k * VD) & D_ALL), sum, old));
            }
        }
    }
}

static void store_result(const output *out, double *result)
{
    for (uint32_t g = 0; g < out->args->group_count; g++) {
        const double *from = output_of(out, g);
        double *to = result + place_of(out, g);
        for (int i = 0; i < GLINT_GROUP; i += VD)
            d_store(to + i, d_select(dm_from_bits(out->args->wanted[g] >> i & D_ALL), d_load(from + i), d_load(to + i)));
    }
}

static void store_output(const output *out, double *result, float *plane, double *total)
{
    if (result)
        store_result(out, result);
    if (plane && out->whole)
        store_whole_plane(out, plane);
    else if (plane)
        store_plane(out, plane);
    if (total)
        add_total(out, total);
}

/// Adds an output's products to a sum.
INNER void add_products(const output *out, const double *by, double *sum)
{
    const size_t further = GLINT_GROUP & out->step;
    const double *row = out->row, *const end = by + (size_t)out->args->group_count * GLINT_GROUP;
    const vd zero = d_set(0);
    for (; by < end; by += GLINT_GROUP, sum += GLINT_GROUP, row += further)
        for (int i = 0; i < GLINT_GROUP; i += VD) {
            const vd factor = d_load(by + i);
            d_store(sum + i, d_load(sum + i) + d_select(d_eq(factor, zero), zero, d_load(row + i) * factor));
        }
}

static void add_sums(const glint_program_args *args)
{
    for (uint32_t n = 0; n < args->sums_count; n++)
        for (uint32_t k = 0; k < args->code->output_count; k++) {
            const glint_program_sums *sums = &args->sums[n];
            output out = { .args = args };
            if (!sums->by[k])
                continue;
            out.row = find_operand(args, args->code->outputs[k], &out.step);
            add_products(&out, sums->by[k], sums->sum[sums->sum_of[k]]);
        }
}

/// Adds the three slopes to `added`, in lanes where all three are finite.
static void add_slopes(const glint_program_args *args)
{
    const vd most = d_set(HUGE_VAL);
    output out[3];
    for (int k = 0; k < 3; k++) {
        out[k] = (output) { .args = args };
        out[k].row = find_operand(args, args->code->outputs[k], &out[k].step);
    }
    for (uint32_t g = 0; g < args->group_count; g++) {
        const float *share = args->share ? args->share + (size_t)g * GLINT_GROUP : NULL;
        const size_t to = place_of(out, g);
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            vd weight[VF / VD];
            f_split(share ? f_load(share + i) : f_set(1), weight);
            for (int n = 0; n < VF / VD; n++) {
                const int at = i + n * VD;
                const unsigned wanted = args->wanted[g] >> at & D_ALL;
                dm finite = dm_from_bits(wanted);
                vd slope[3];
                for (int k = 0; k < 3; k++) {
                    slope[k] = d_load(output_of(&out[k], g) + at) * weight[n];
                    finite = dm_and(finite, d_lt(d_abs(slope[k]), most));
                }
                for (int k = 0; k < 3; k++) {
                    double *sum = args->added[k] + to + at;
                    const vd old = d_load(sum);
                    d_store(sum, d_select(finite, old + slope[k], old));
                }
                args->odd[g] |= (uint16_t)((wanted & ~dm_bits(finite)) << at);
            }
        }
    }
}

// ---- Choices by one bit -------------------------------------------------------------------------------------------

/// Stores one of two numbers in each wanted lane of a group.
INNER void choose_lanes(float *to, unsigned wanted, unsigned truths, vf no, vf yes)
{
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const unsigned all = (1u << VF) - 1;
        const vf chosen = f_select(fm_from_bits(truths >> i & all), yes, no);
        f_store(to + i, f_select(fm_from_bits(wanted >> i & all), chosen, f_load(to + i)));
    }
}

/// The stage `choose`.
static void choose(const glint_choose_args *args)
{
    const vf no = f_set(args->number[0]), yes = f_set(args->number[1]);
    for (uint32_t k = 0; k < args->group_count; k++) {
        const uint32_t g = args->groups[k];
        choose_lanes(args->plane + (size_t)g * GLINT_GROUP, args->wanted[k], args->truths[g], no, yes);
    }
}

static void program(const glint_program_args *args)
{
    const glint_program_code *code = args->code;
    const glint_instruction *end = code->instructions + code->length;
    double *rows = args->rows;
    for (uint32_t g = 0; args->odd && g < args->group_count; g++)
        args->odd[g] = 0;
    op_call call = { .lanes = (size_t)args->group_count * GLINT_GROUP };
    for (const glint_instruction *at = code->instructions; at < end; at++) {
        for (uint32_t k = 0; k < at->operands; k++)
            call.in[k] = find_operand(args, at->in[k], &call.step[k]);
        call.out[0] = rows + (size_t)at->out[0] * GLINT_PROGRAM_LANES;
        for (uint32_t k = 1; k < at->results; k++)
            call.out[k] = rows + (size_t)at->out[k] * GLINT_PROGRAM_LANES;
        if (at->op >= GLINT_OP_TEXEL)
            call.texture = code->textures[at->texture];
        op_kernels[at->op](&call);
    }
    if (args->sums_count)
        add_sums(args);
    if (args->added[0])
        add_slopes(args);
    const bool whole = is_whole(args);
    for (uint32_t k = 0; k < code->output_count && !args->sums_alone; k++) {
        output out = { .args = args, .whole = whole };
        out.row = find_operand(args, code->outputs[k], &out.step);
        store_output(&out, args->result[k], args->plane[k], args->total[k]);
    }
}

#endif
