/// The structure of programs. Internal.
#ifndef GLINT_PROGRAM_H
#define GLINT_PROGRAM_H

#include "engine/base/hash.h"
#include "engine/glint_types.h"
#include "engine/glint_programs.h"
#include "engine/render/stages/stages.h"

#include <stdatomic.h>

#define GLINT_ATTACHED_MAX 4

/// Data that was computed from a program and lives as long as it. The first member of its structure.
typedef struct glint_attached {
    void (*release)(struct glint_attached *attached);
} glint_attached;

struct glint_program {
    glint_program_kind kind;
    glint_program_code code; ///< the program owns its arrays
    uint32_t number_count, texture_count;
    uint32_t inputs; ///< the inputs that the program reads, one bit each
    uint32_t slopes; ///< the inputs whose slopes the program reads, one bit each
    glint_key structure; ///< hash of the operations, of their operands and of the textures
    glint_key numbers; ///< hash of only the program's numbers
    glint_texture **textures; ///< retained
    glint_program **tangents; ///< one for each of GLINT_PARAMETERS_MAX parameters, owned; an entry is NULL if no
        ///< output depends on the parameter. NULL: no number depends on parameters
    _Atomic(glint_attached *) attached[GLINT_ATTACHED_MAX]; ///< owned; each is set once. NULL: free
    _Atomic uint32_t references;
};

/// The kernels' table of a texture, valid as long as the texture; and a hash of everything that determines its texels.
const glint_texture_table *glint_texture_table_of(const glint_texture *texture);
glint_key glint_texture_key(const glint_texture *texture);

/// Makes a program of the derivatives of the first output of `program` by each of the inputs, in their order. The
/// derivatives are exact, except that floor and similar operations have slope 0 everywhere, and so has a texel by its
/// footprint.
/// count  1 .. GLINT_PROGRAM_OUTPUTS_MAX. Fails with GLINT_ERR_INVALID like glint_builder_finish.
glint_status glint_program_slope(const glint_program *program, const glint_input *inputs, size_t count,
                                 glint_program **out, glint_error *error);

/// The meaning of one number of a gradient: the derivative of one channel of light by one input.
typedef struct glint_gradient_entry {
    uint32_t channel, input;
} glint_gradient_entry;

#define GLINT_GRADIENT_MAX (3 * GLINT_INPUT_COUNT)
#define GLINT_GRADIENT_PART 8
/// largest number of derivatives in forward mode; for more derivatives a gradient is faster, because it runs only
/// once
#define GLINT_FORWARD_MAX 2
_Static_assert(GLINT_GRADIENT_MAX <= GLINT_CODE_OUTPUTS_MAX, "a program may give all slopes");

/// The derivatives of a shader's light, diffuse and specular, by its inputs. Slopes that are 0 everywhere are not
/// listed.
typedef struct glint_gradient {
    uint32_t count;
    glint_gradient_entry of[GLINT_GRADIENT_MAX];
    uint32_t each; ///< number of slopes that each program computes: all slopes, or GLINT_GRADIENT_PART if one program
        ///< cannot hold all
    glint_program *programs[(GLINT_GRADIENT_MAX + GLINT_GRADIENT_PART - 1) / GLINT_GRADIENT_PART]; ///< owned, or NULL
    /// Owned: one program for each derivative, see glint_shader_forward; NULL: use the gradient. Set for each frame,
    /// not by glint_shader_gradient
    glint_program *forward[GLINT_FORWARD_MAX];
} glint_gradient;

/// Makes a program of the derivatives of the channels of a shader's light, from the slopes of `inputs` (one bit
/// each): forward mode, one sweep for all channels. The result may not be finite where a zero slope meets an infinite
/// derivative, such as the root of 0; the gradient gives the right value there. *out is NULL if the program would be
/// too long.
glint_status glint_shader_forward(const glint_program *shader, uint32_t inputs, glint_program **out, glint_error *error);

/// inputs  the inputs to derive by, one bit each.
///
/// The derivatives are as exact as in glint_program_slope. Where an output is clamped (see the planes of
/// glint_program_args), its slope is 0. The caller releases the gradient, on error too.
glint_status glint_shader_gradient(const glint_program *shader, uint32_t inputs, glint_gradient *out, glint_error *error);
void glint_gradient_release(glint_gradient *gradient);

/// Checks that a kernel may run the code: operations, rows and textures exist, and no row is read before it is written.
glint_status glint_code_check(const glint_program_code *code, uint32_t number_count, uint32_t texture_count,
                              uint64_t inputs, glint_error *error);

#endif
