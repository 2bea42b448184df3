/// Programs as the engine knows them. Internal.
#ifndef GLINT_PROGRAM_H
#define GLINT_PROGRAM_H

#include "engine/base/hash.h"
#include "engine/stages/stages.h"

#include <stdatomic.h>

struct glint_program {
    glint_program_kind kind;
    glint_program_code code; ///< its arrays belong to the program
    uint32_t number_count, texture_count;
    uint32_t inputs; ///< a bit a glint_input that is read
    uint32_t slopes; ///< a bit a glint_input whose slope is read
    glint_key structure; ///< of the operations, what they read and the textures
    glint_key numbers; ///< of the numbers alone
    glint_texture **textures; ///< retained
    glint_program **tangents; ///< GLINT_PARAMETERS_MAX of them, owned, NULL where nothing changes; NULL: nothing does
    _Atomic uint32_t references;
};

/// The kernels' table of a texture, as long as the texture is there; and a hash of all that can change its texels.
const glint_texture_table *glint_texture_table_of(const glint_texture *texture);
glint_key glint_texture_key(const glint_texture *texture);

/// A program of the derivatives of the first output of `program` by each of the inputs, in their order: exact, but that
/// floor and its like have slope 0 everywhere, and so has a texel by its footprint.
/// count  1 .. GLINT_PROGRAM_OUTPUTS_MAX. GLINT_ERR_INVALID as glint_builder_finish.
glint_status glint_program_slope(const glint_program *program, const glint_input *inputs, size_t count,
                                 glint_program **out, glint_error *error);

/// Which slope a number of a gradient is: of a channel of light, by an input.
typedef struct glint_gradient_place {
    uint32_t channel, input;
} glint_gradient_place;

#define GLINT_GRADIENT_MAX (3 * GLINT_INPUT_COUNT)
#define GLINT_GRADIENT_PART 8
#define GLINT_FORWARD_MAX 2 ///< derivatives; of more a gradient is quicker, which is run once for all
_Static_assert(GLINT_GRADIENT_MAX <= GLINT_CODE_OUTPUTS_MAX, "a program may give all slopes");

/// How fast the light that a shader gives, diffuse and specular, changes with its inputs; slopes that are 0 everywhere are not listed.
typedef struct glint_gradient {
    uint32_t count;
    glint_gradient_place of[GLINT_GRADIENT_MAX];
    uint32_t each; ///< slopes that a program gives: all, or where that is too much for one GLINT_GRADIENT_PART
    glint_program *programs[(GLINT_GRADIENT_MAX + GLINT_GRADIENT_PART - 1) / GLINT_GRADIENT_PART]; ///< owned; NULL beyond
    /// By each derivative, see glint_shader_forward; owned. NULL: by the gradient. The frame's, not glint_shader_gradient's
    glint_program *forward[GLINT_FORWARD_MAX];
} glint_gradient;

/// A program of how fast the channels of a shader's light change, of the slopes of `inputs`, a bit each: forward, in one sweep for all
/// channels. Where a slope of 0 meets what has none, as a root of 0, it may not be finite; then the gradient says what it is. *out is
/// NULL where a program has no room for it.
glint_status glint_shader_forward(const glint_program *shader, uint32_t inputs, glint_program **out, glint_error *error);

/// inputs  those that count, a bit each.
///
/// As exact as glint_program_slope; what of an output is bounded, as glint_program_args' planes are, has slope 0. On error, too, the
/// gradient is released by the caller.
glint_status glint_shader_gradient(const glint_program *shader, uint32_t inputs, glint_gradient *out, glint_error *error);
void glint_gradient_release(glint_gradient *gradient);

/// Whether a kernel may run the code: operations, rows and textures that exist, and no row read before it is written.
glint_status glint_code_check(const glint_program_code *code, uint32_t number_count, uint32_t texture_count,
                              uint64_t inputs, glint_error *error);

#endif
