/// The contract of the stage `program`: the instructions of a pattern or a shader, for up to 256 points. Begin with
/// stages.h.
#ifndef GLINT_CONTRACT_PROGRAM_H
#define GLINT_CONTRACT_PROGRAM_H

#include "engine/base/math.h" // operations and inputs are those of glint_math.h
#include "engine/render/stages/contract/hits.h"

#define GLINT_PROGRAM_GROUPS 16 ///< maximum groups per call
#define GLINT_PROGRAM_LANES 256 ///< lanes per row: one double per lane, 2 KB
#define GLINT_CODE_OUTPUTS_MAX 96 ///< for gradients; stored programs have at most GLINT_PROGRAM_OUTPUTS_MAX
#define GLINT_TEXEL_PROBES 16 ///< most positions of a texture that a pixel reads along its longer side
#define GLINT_TEXEL_SLACK 0.015625 ///< a pixel that is longer by this share of its shorter side counts as square
#define GLINT_CODE_INPUTS (2 * GLINT_INPUT_COUNT) ///< the inputs, followed from GLINT_INPUT_COUNT on by the slope of
    ///< each input
#define GLINT_NUMBER_LANES 16 ///< number of copies of a constant in memory: one per lane of a group

// Numbers that say where an operand is read or a result is stored.
#define GLINT_ROW_INPUT 256u ///< plus one of GLINT_CODE_INPUTS: an input; smaller numbers are the program's own rows
#define GLINT_ROW_NUMBER 512u ///< plus an index into `numbers`: a constant

typedef struct glint_instruction { ///< no padding: its bytes are hashed
    uint16_t op; ///< glint_op
    uint16_t texture; ///< index into the textures; 0 if the operation has none
    uint8_t operands, results; ///< number of operands and results, which the operation determines
    uint16_t in[GLINT_OPERANDS_MAX]; ///< unused elements are 0
    uint16_t out[GLINT_RESULTS_MAX]; ///< the program's own rows, also for results that are not read; unused elements
        ///< are 0
} glint_instruction;

/// A picture at one size. Texels are red, green, blue, alpha; linear; row by row from the top.
typedef struct glint_texture_level {
    uint32_t width, height; ///< 1 .. 65535
    const float *texels;
} glint_texture_level;

typedef struct glint_texture_table {
    const glint_texture_level *levels; ///< each level has half the size of the one before, rounded up; the last level
        ///< has one texel
    uint32_t level_count;
    glint_wrap wrap;
    glint_filter filter;
} glint_texture_table;

typedef struct glint_program_code {
    const glint_instruction *instructions;
    uint32_t length;
    uint32_t row_count; ///< at most GLINT_PROGRAM_ROWS_MAX
    uint32_t output_count;
    uint16_t outputs[GLINT_CODE_OUTPUTS_MAX]; ///< where each output is: a row, input or constant, as for operands
    const double (*numbers)[GLINT_NUMBER_LANES];
    const glint_texture_table *const *textures;
} glint_program_code;

#define GLINT_REFLECTANCE_MAX 0x1p100

/// Returns the instruction that computes output k as a choice between two reflectances: number[0] if its condition is
/// 0, otherwise number[1]. NULL: the output is computed in another way.
static inline const glint_instruction *glint_find_choice(const glint_program_code *code, uint32_t k, float number[2])
{
    const glint_instruction *at = code->instructions + code->length;
    do
        if (at-- == code->instructions)
            return NULL;
    while (at->out[0] != code->outputs[k]);
    if (at->op != GLINT_OP_SELECT)
        return NULL;
    for (int i = 0; i < 2; i++) {
        const uint32_t row = at->in[2 - i];
        const double x = row < GLINT_ROW_NUMBER ? -1 : code->numbers[row - GLINT_ROW_NUMBER][0];
        if (!(x >= 0 && x <= GLINT_REFLECTANCE_MAX))
            return NULL;
        number[i] = (float)(x + 0.0); // -0 is 0
    }
    return at;
}

/// Sums of products of a program's outputs with other numbers.
typedef struct glint_program_sums {
    const double *by[GLINT_CODE_OUTPUTS_MAX]; ///< the factors of each output, 16 numbers per group; NULL: the output
        ///< is in no sum
    uint8_t sum_of[GLINT_CODE_OUTPUTS_MAX]; ///< for each output, the index of its sum
    double *sum[3]; ///< in and out, 16 numbers per group: the products are added one after another; undefined in lanes
        ///< that are not wanted
} glint_program_sums;

typedef struct glint_program_args {
    const glint_program_code *code;
    uint32_t group_count; ///< 1 .. GLINT_PROGRAM_GROUPS
    const uint16_t *wanted; ///< one bit per lane; nothing is stored elsewhere
    const double *input[GLINT_CODE_INPUTS]; ///< only set for inputs that the program reads: 16 numbers per group
    uint64_t same; ///< one bit per input: all its values are one number, stored GLINT_NUMBER_LANES times
    double *rows; ///< scratch: row_count * GLINT_PROGRAM_LANES
    const uint32_t *groups; ///< the position of each group in the arrays below; NULL: 0, 1, 2 ...
    const glint_program_sums *sums; ///< `sums_count` sums to compute; a factor of 0 adds nothing, even if the output
        ///< is not finite
    uint32_t sums_count;
    bool sums_alone; ///< true: no output is stored in the arrays below
    double *result[GLINT_PROGRAM_OUTPUTS_MAX]; ///< out: the unchanged outputs; NULL: not wanted
    /// out: the outputs as reflectances, v > 0 ? min(v, 2^100) : 0 in double, then rounded to float; NULL: not wanted
    float *plane[GLINT_PROGRAM_OUTPUTS_MAX];
    double *total[GLINT_PROGRAM_OUTPUTS_MAX]; ///< in and out: `share` times the value of the plane is added; NULL:
        ///< not wanted
    const float *share; ///< 16 numbers per group, in the order of `wanted`; NULL: 1
    /// in and out: `share` times each of the first three outputs is added, in lanes where all three are finite;
    /// added[0] NULL: not wanted
    double *added[3];
    /// out, one bit per wanted lane: an output stored in `plane` is NaN, below 0 or above 2^100, or an output added
    /// to `added` is not finite; NULL: not wanted, and nothing is added
    uint16_t *odd;
} glint_program_args;

/// Directions and distances: length = sqrt(length2(d)) and unit = d / length, where d = to - from, or the direction
/// from a hit back to the camera.
typedef struct glint_unit_args {
    uint32_t group_count;
    const glint_camera_args *camera; ///< perspective, in double: d = -(across + down) of `groups`; NULL: from `to` and
        ///< `from`
    const uint32_t *groups; ///< as in the camera's arguments
    const double *to[3]; ///< 16 numbers per group
    const double *position; ///< x, y, z: one point that replaces `to` in every lane; NULL: `to` is read
    const double *from[3]; ///< 16 numbers per group; NULL: d = to
    double *unit[3]; ///< out; may be the memory of `to` or `from`
    double *length; ///< out; NULL: not wanted
} glint_unit_args;

/// Stores reflectances, each of which is one of two numbers.
typedef struct glint_choose_args {
    uint32_t group_count;
    const uint32_t *groups; ///< the position of each group in `truths` and `plane`
    const uint16_t *wanted; ///< one bit per lane; nothing is stored elsewhere
    const uint16_t *truths; ///< one bit per lane: 0 for the first number, 1 for the second
    float number[2];
    float *plane; ///< out
} glint_choose_args;

// glint_math.h describes each operation; ref.h and ref_pattern.h have the arithmetic and its order.

#endif
