/// The values of a builder in the order of their creation: operands before the values computed from them. Internal.
#ifndef GLINT_PROGRAM_BUILDER_H
#define GLINT_PROGRAM_BUILDER_H

#include "engine/glint_types.h"
#include "engine/glint_programs.h"
#include "engine/render/program/program.h"

#define GLINT_SSA_NUMBER GLINT_OP_COUNT ///< kinds of node that are not operations
#define GLINT_SSA_INPUT (GLINT_OP_COUNT + 1)
#define GLINT_SSA_PARAMETER (GLINT_OP_COUNT + 2)
#define GLINT_VALUES_MAX 65536u ///< values of a builder, including those that no output needs

typedef struct glint_ssa_node {
    uint16_t op; ///< operation: a glint_op, or a kind of node
    uint16_t part; ///< number of this result of the operation, from 0; only part 0 stores the operands
    uint32_t operand[GLINT_OPERANDS_MAX]; ///< the operands; for an input, operand[0] is the input's number
    uint32_t texture; ///< index into the builder's textures
    double number; ///< value of a number or parameter; the slopes of a parameter are parameters[operand[0]] of the
        ///< builder
} glint_ssa_node;

struct glint_builder {
    glint_program_kind kind;
    bool plain; ///< whether nothing is folded, shared or fused: a reference for tests
    glint_ssa_node *nodes;
    uint32_t count, capacity;
    uint32_t *slots; ///< hash table of the nodes with part 0: index of the node + 1; 0: free
    uint32_t slot_count; ///< a power of 2
    glint_texture **textures; ///< retained
    uint32_t texture_count;
    double (*parameters)[GLINT_PARAMETERS_MAX]; ///< slopes of the numbers that depend on parameters
    uint32_t parameter_count;
};

static inline bool glint_ssa_is_op(const glint_ssa_node *node) { return node->op < GLINT_OP_COUNT; }

/// Does the same as glint_builder_op, but also accepts internal operations.
glint_status glint_builder_add(glint_builder *builder, glint_op op, uint32_t texture, const glint_value *operands,
                               glint_value *out, glint_error *error);
/// Returns the index of a texture in the builder's list, after adding the texture if it is new.
glint_status glint_builder_texture(glint_builder *builder, const glint_texture *texture, uint32_t *out,
                                   glint_error *error);

/// Adds the values of a finished program to a builder. instead: for each input the value that replaces it; 0 keeps
/// the input, so value 0 cannot replace one. NULL: no input is replaced.
glint_status glint_builder_load(glint_builder *builder, const glint_program *program, const glint_value *instead,
                                glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX], glint_error *error);

/// Adds a value that is not the result of an operation. `kind` is the kind of its node; its first operand and its
/// number follow.
glint_status glint_builder_intern(glint_builder *builder, uint16_t kind, uint32_t operand, double number,
                                  glint_value *out, glint_error *error);

/// Computes the results of an operation on numbers with the reference kernels.
void glint_fold(glint_op op, const glint_texture *texture, const double *operands, double results[GLINT_RESULTS_MAX]);

/// Does the same as glint_builder_finish, but does not check the number of outputs.
glint_status glint_program_make(const glint_builder *builder, const glint_value *outputs, size_t count,
                                glint_program **out, glint_error *error);

// program/parameter.c: builders that have parameters.

/// Copies all values of a builder into a new one. `map` gives the new value of each old value. The caller frees `map`
/// and destroys the new builder, on error too. open: parameters stay parameters; otherwise they become plain numbers.
glint_status glint_builder_copy(const glint_builder *from, bool open, glint_builder **out, glint_value **map,
                                glint_error *error);
/// Makes a program in which parameters are plain numbers.
glint_status glint_builder_close(const glint_builder *builder, const glint_value *outputs, size_t count,
                                 glint_program **out, glint_error *error);
/// Does the same, and adds the program's tangents.
glint_status glint_builder_finish_open(const glint_builder *builder, const glint_value *outputs, size_t count,
                                       glint_program **out, glint_error *error);
/// program/slope.c: makes a program of the derivatives of the outputs by a parameter, with the same exactness as
/// glint_program_slope.
glint_status glint_builder_tangent(const glint_builder *builder, const glint_value *outputs, size_t count, size_t parameter,
                                   glint_program **out, glint_error *error);

#endif
