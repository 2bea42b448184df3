/// The operations and inputs of programs by name.
#include "engine/glint.h"

static const glint_op_info operations[GLINT_OP_COUNT] = {
    [GLINT_OP_ADD] = { "add", 2, 1 },
    [GLINT_OP_SUB] = { "sub", 2, 1 },
    [GLINT_OP_MUL] = { "mul", 2, 1 },
    [GLINT_OP_DIV] = { "div", 2, 1 },
    [GLINT_OP_NEG] = { "neg", 1, 1 },
    [GLINT_OP_ABS] = { "abs", 1, 1 },
    [GLINT_OP_SQRT] = { "sqrt", 1, 1 },
    [GLINT_OP_MIN] = { "min", 2, 1 },
    [GLINT_OP_MAX] = { "max", 2, 1 },
    [GLINT_OP_FLOOR] = { "floor", 1, 1 },
    [GLINT_OP_CEIL] = { "ceil", 1, 1 },
    [GLINT_OP_ROUND] = { "round", 1, 1 },
    [GLINT_OP_FRACT] = { "fract", 1, 1 },
    [GLINT_OP_MOD] = { "mod", 2, 1 },
    [GLINT_OP_SIGN] = { "sign", 1, 1 },
    [GLINT_OP_MULADD] = { "muladd", 3, 1 },
    [GLINT_OP_SUBMUL] = { "submul", 3, 1 },
    [GLINT_OP_MULSUB] = { "mulsub", 3, 1 },
    [GLINT_OP_MIX] = { "mix", 3, 1 },
    [GLINT_OP_LESS] = { "less", 2, 1 },
    [GLINT_OP_LESSEQ] = { "lesseq", 2, 1 },
    [GLINT_OP_EQUAL] = { "equal", 2, 1 },
    [GLINT_OP_AND] = { "and", 2, 1 },
    [GLINT_OP_OR] = { "or", 2, 1 },
    [GLINT_OP_NOT] = { "not", 1, 1 },
    [GLINT_OP_SELECT] = { "select", 3, 1 },
    [GLINT_OP_STEP] = { "step", 2, 1 },
    [GLINT_OP_SMOOTHSTEP] = { "smoothstep", 3, 1 },
    [GLINT_OP_CLAMP] = { "clamp", 3, 1 },
    [GLINT_OP_SIN] = { "sin", 1, 1 },
    [GLINT_OP_COS] = { "cos", 1, 1 },
    [GLINT_OP_EXP2] = { "exp2", 1, 1 },
    [GLINT_OP_LOG2] = { "log2", 1, 1 },
    [GLINT_OP_POW] = { "pow", 2, 1 },
    [GLINT_OP_ATAN2] = { "atan2", 2, 1 },
    [GLINT_OP_ACOS] = { "acos", 1, 1 },
    [GLINT_OP_HIGHLIGHT] = { "highlight", 2, 1 },
    [GLINT_OP_NOISE] = { "noise", 3, 1 },
    [GLINT_OP_NOISE3] = { "noise3", 3, 3 },
    [GLINT_OP_CELL] = { "cell", 3, 2 },
    [GLINT_OP_HASH] = { "hash", 3, 1 },
    [GLINT_OP_PARITY] = { "parity", 3, 1 },
    [GLINT_OP_NOISE_SLOPE] = { "noise_slope", 4, 3 },
    [GLINT_OP_CELL_SLOPE] = { "cell_slope", 3, 6 },
    [GLINT_OP_TEXEL] = { "texel", 3, 4 },
    [GLINT_OP_TEXEL_SLOPE] = { "texel_slope", 3, 8 },
};

static const char *const inputs[GLINT_INPUT_COUNT] = {
    [GLINT_INPUT_P_X] = "p.x",
    [GLINT_INPUT_P_Y] = "p.y",
    [GLINT_INPUT_P_Z] = "p.z",
    [GLINT_INPUT_WORLD_X] = "world.x",
    [GLINT_INPUT_WORLD_Y] = "world.y",
    [GLINT_INPUT_WORLD_Z] = "world.z",
    [GLINT_INPUT_N_X] = "n.x",
    [GLINT_INPUT_N_Y] = "n.y",
    [GLINT_INPUT_N_Z] = "n.z",
    [GLINT_INPUT_V_X] = "v.x",
    [GLINT_INPUT_V_Y] = "v.y",
    [GLINT_INPUT_V_Z] = "v.z",
    [GLINT_INPUT_UV_U] = "uv.u",
    [GLINT_INPUT_UV_V] = "uv.v",
    [GLINT_INPUT_FOOTPRINT] = "footprint",
    [GLINT_INPUT_UV_FOOTPRINT] = "uv.footprint",
    [GLINT_INPUT_L_X] = "l.x",
    [GLINT_INPUT_L_Y] = "l.y",
    [GLINT_INPUT_L_Z] = "l.z",
    [GLINT_INPUT_LIGHT_R] = "light.r",
    [GLINT_INPUT_LIGHT_G] = "light.g",
    [GLINT_INPUT_LIGHT_B] = "light.b",
    [GLINT_INPUT_DISTANCE] = "distance",
    [GLINT_INPUT_KD_R] = "kd.r",
    [GLINT_INPUT_KD_G] = "kd.g",
    [GLINT_INPUT_KD_B] = "kd.b",
    [GLINT_INPUT_KS_R] = "ks.r",
    [GLINT_INPUT_KS_G] = "ks.g",
    [GLINT_INPUT_KS_B] = "ks.b",
    [GLINT_INPUT_SHININESS] = "shininess",
};

const glint_op_info *glint_op_info_of(glint_op op)
{
    return (unsigned)op < GLINT_OP_COUNT ? &operations[op] : NULL;
}

const char *glint_input_name(glint_input input)
{
    return (unsigned)input < GLINT_INPUT_COUNT ? inputs[input] : NULL;
}
