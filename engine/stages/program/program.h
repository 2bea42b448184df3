// The stage `program`: one call for each instruction, over all lanes. Contract: contract/program.h.

#include "engine/stages/program/call.h"
#include "engine/stages/program/exact.h"
#include "engine/stages/program/elementary.h"
#include "engine/stages/program/noise.h"
#include "engine/stages/program/cell.h"
#include "engine/stages/program/texel.h"

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
    [GLINT_OP_NOISE_SLOPE] = op_noise_slope,
    [GLINT_OP_CELL_SLOPE] = op_cell_slope,
    [GLINT_OP_TEXEL] = op_texel,
    [GLINT_OP_TEXEL_SLOPE] = op_texel_slope,
};

/// Where an operand is read.
static inline void find_operand(const glint_program_args *args, uint32_t row, const double **from, size_t *step)
{
    *step = ~(size_t)0;
    if (row < GLINT_ROW_INPUT) {
        *from = args->rows + row * GLINT_PROGRAM_LANES;
    } else if (row < GLINT_ROW_NUMBER) {
        *from = args->input[row - GLINT_ROW_INPUT];
        *step = args->same >> (row - GLINT_ROW_INPUT) & 1 ? 0 : *step;
    } else {
        *from = args->code->numbers[row - GLINT_ROW_NUMBER];
        *step = 0;
    }
}

/// A number as a reflectance; NaN gives 0.
static inline vd reflectance(vd v) { return d_min(d_max(v, d_set(0)), d_set(GLINT_REFLECTANCE_MAX)); }

/// A group of one output as reflectances, where wanted. Returns the lanes that are none, where `odd`, a constant, says so.
INNER unsigned store_plane(const double *from, unsigned wanted, float *plane, bool odd)
{
    unsigned even = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vd half[VF / VD];
        for (int k = 0; k < VF / VD; k++) {
            const vd x = d_load(from + i + k * VD);
            half[k] = reflectance(x);
            if (odd)
                even |= dm_bits(d_eq(half[k], x)) << (i + k * VD);
        }
        const vf v = f_join(half[0], half[1]);
        if (wanted == 0xffff)
            f_store(plane + i, v);
        else
            f_store(plane + i, f_select(fm_from_bits(wanted >> i & ((1u << VF) - 1)), v, f_load(plane + i)));
    }
    return ~even & wanted;
}

/// Adds a group of one output, as store_plane rounds it, times `share`.
INNER void add_total(const double *from, unsigned wanted, const float *share, double *total)
{
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vd v[VF / VD], weight[VF / VD];
        f_split(f_join(reflectance(d_load(from + i)), reflectance(d_load(from + i + VD))), v);
        if (share)
            f_split(f_load(share + i), weight);
        for (int k = 0; k < VF / VD; k++) {
            double *to = total + i + k * VD;
            if (share)
                v[k] = weight[k] * v[k];
            const vd sum = d_load(to) + v[k];
            d_store(to, wanted == 0xffff ? sum
                                         : d_select(dm_from_bits(wanted >> (i + k * VD) & D_ALL), sum, d_load(to)));
        }
    }
}

static void store_result(const double *from, unsigned wanted, double *result)
{
    for (int i = 0; i < GLINT_GROUP; i += VD)
        d_store(result + i, d_select(dm_from_bits(wanted >> i & D_ALL), d_load(from + i), d_load(result + i)));
}

static void store_output(const glint_program_args *args, uint32_t k)
{
    const double *row;
    size_t step;
    find_operand(args, args->code->outputs[k], &row, &step);
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t to = (size_t)(args->groups ? args->groups[g] : g) * GLINT_GROUP;
        const double *from = row + ((size_t)g * GLINT_GROUP & step);
        const unsigned wanted = args->wanted[g];
        if (args->result[k])
            store_result(from, wanted, args->result[k] + to);
        if (args->plane[k] && args->odd)
            args->odd[g] |= (uint16_t)store_plane(from, wanted, args->plane[k] + to, true);
        else if (args->plane[k] && wanted == 0xffff)
            store_plane(from, 0xffff, args->plane[k] + to, false);
        else if (args->plane[k])
            store_plane(from, wanted, args->plane[k] + to, false);
        if (args->total[k] && args->share)
            add_total(from, wanted, args->share + (size_t)g * GLINT_GROUP, args->total[k] + to);
        else if (args->total[k] && wanted == 0xffff)
            add_total(from, 0xffff, NULL, args->total[k] + to);
        else if (args->total[k] && wanted)
            add_total(from, wanted, NULL, args->total[k] + to);
    }
}

static void program(const glint_program_args *args)
{
    const glint_program_code *code = args->code;
    op_call call = { .lanes = (size_t)args->group_count * GLINT_GROUP };
    for (const glint_instruction *at = code->instructions; at < code->instructions + code->length; at++) {
        for (uint32_t k = 0; k < at->operands; k++)
            find_operand(args, at->in[k], &call.in[k], &call.step[k]);
        for (uint32_t k = 0; k < at->results; k++)
            call.out[k] = args->rows + (size_t)at->out[k] * GLINT_PROGRAM_LANES;
        if (at->op >= GLINT_OP_TEXEL)
            call.texture = code->textures[at->texture];
        op_kernels[at->op](&call);
    }
    for (uint32_t g = 0; args->odd && g < args->group_count; g++)
        args->odd[g] = 0;
    for (uint32_t k = 0; k < code->output_count; k++)
        if (args->result[k] || args->plane[k] || args->total[k])
            store_output(args, k);
}
