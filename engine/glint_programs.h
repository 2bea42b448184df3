/// Programs: patterns and shaders, and textures, which patterns read.
#ifndef GLINT_PROGRAMS_H
#define GLINT_PROGRAMS_H

#include "glint_math.h"
#include "glint_types.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// A straight-line list of operations on doubles, run for many points at once. A pattern computes a material's value
/// at a point; a shader computes the light that a point reflects from one light source. A builder makes the program,
/// value by value. A program has no branches and no loops, so its time is proportional to its length. The same
/// numbers give the same bits on every machine.

typedef struct glint_builder glint_builder; ///< a program under construction; only one thread at a time may use it
typedef struct glint_texture glint_texture; ///< immutable
typedef uint32_t glint_value; ///< a value in a builder: one double per point

#define GLINT_PARAMETERS_MAX 32 ///< most parameters that the numbers of a program may depend on

/// A pattern gives a number or a colour at a point, a shader the light reflected from one light source.
typedef enum glint_program_kind { GLINT_PROGRAM_PATTERN, GLINT_PROGRAM_SHADER } glint_program_kind;

/// Begins a program; the caller destroys the builder. GLINT_ERR_INVALID: no such kind; GLINT_ERR_NOMEM;
/// GLINT_ERR_UNSUPPORTED in a build without programs.
///
/// The builder's values are valid until it is destroyed. It holds fewer than 65536 values, numbers and inputs
/// included. The functions that make a value fail with GLINT_ERR_INVALID beyond that limit, and with GLINT_ERR_NOMEM
/// when memory is short. The builder is then unchanged.
glint_status glint_builder_create(glint_program_kind kind, glint_builder **out, glint_error *error);
/// Destroys the builder; finished programs stay valid. NULL does nothing.
void glint_builder_destroy(glint_builder *builder);
/// Makes a number: any double. Numbers with the same bits are the same value.
glint_status glint_builder_number(glint_builder *builder, double number, glint_value *out, glint_error *error);
/// Makes a number that depends on parameters: slopes[k] is its derivative with respect to parameter k,
/// 0 <= k < `count`. Programs use the number itself; glint_program_tangent uses the slopes. GLINT_ERR_INVALID for
/// more than GLINT_PARAMETERS_MAX slopes.
glint_status glint_builder_parameter(glint_builder *builder, double number, const double *slopes, size_t count,
                                     glint_value *out, glint_error *error);
/// Makes an input. GLINT_ERR_INVALID for a shader input in a pattern.
glint_status glint_builder_input(glint_builder *builder, glint_input input, glint_value *out, glint_error *error);
/// Makes the results of an operation.
///
/// operands  as many values of this builder as the operation reads.
/// out       written: as many values as the operation has results.
///
/// An operation on numbers gives a number, computed by the reference kernels. A value that exists already is reused.
/// GLINT_ERR_INVALID for an operand that is not a value of the builder, or for an internal operation.
glint_status glint_builder_op(glint_builder *builder, glint_op op, const glint_value *operands, glint_value *out,
                              glint_error *error);
/// Makes the colour of a texture, as red, green, blue and alpha.
///
/// u, v       (0, 0) is the lower left corner of the picture, (1, 1) the upper right.
/// footprint  width over which the picture is averaged, in units of u and v; 0 or less: no averaging. If the picture is
///            not square and the width is computed from GLINT_INPUT_UV_FOOTPRINT, each axis has its own width:
///            computed from GLINT_INPUT_UV_FOOTPRINT_U and _V instead.
///
/// The program retains the texture.
glint_status glint_builder_texel(glint_builder *builder, const glint_texture *texture, glint_value u, glint_value v,
                                 glint_value footprint, glint_value out[4], glint_error *error);
/// Does the same with a width for each axis, footprint[0] in units of u and footprint[1] in units of v.
glint_status glint_builder_texel_by_axis(glint_builder *builder, const glint_texture *texture, glint_value u, glint_value v,
                                         const glint_value footprint[2], glint_value out[4], glint_error *error);
/// Returns whether a value is a number, and writes the number unless `number` is NULL. Also returns false if `value`
/// is not a value of the builder.
bool glint_builder_is_number(const glint_builder *builder, glint_value value, double *number);
/// Returns the number of instructions so far, including those that no output needs.
size_t glint_builder_length(const glint_builder *builder);
/// Makes a program with these values as outputs. The builder can still be used. The caller releases the program.
///
/// count  pattern: 1 or 3; shader: 3 (diffuse term) or 6 (diffuse and specular terms).
///
/// GLINT_ERR_NOMEM; GLINT_ERR_INVALID for another count, for an output that is not a value of the builder, and when
/// the program is longer than GLINT_PROGRAM_LENGTH_MAX or needs more rows than GLINT_PROGRAM_ROWS_MAX.
glint_status glint_builder_finish(glint_builder *builder, const glint_value *outputs, size_t count, glint_program **out,
                                  glint_error *error);

/// Takes another reference; returns its argument. Any thread.
glint_program *glint_program_retain(glint_program *program);
/// Releases a reference; the last one frees the program and releases its textures. NULL: nothing. Any thread.
void glint_program_release(glint_program *program);
/// Evaluates the program at one point with the kernel that a frame uses. The results are the values that a frame
/// computes, before they are rounded to float.
///
/// inputs   values of the inputs; those that the program does not read may be anything.
/// outputs  written: one value for each output of the program.
///
/// The variable GLINT_ISA may cause an error: GLINT_ERR_UNSUPPORTED for an instruction set that this machine lacks,
/// GLINT_ERR_INVALID for an unknown one.
glint_status glint_program_evaluate(const glint_program *program, const double inputs[GLINT_INPUT_COUNT],
                                    double *outputs, glint_error *error);
glint_program_kind glint_program_kind_of(const glint_program *program);
size_t glint_program_output_count(const glint_program *program);
size_t glint_program_length(const glint_program *program); ///< number of instructions; 0 if all outputs are inputs or
    ///< numbers
size_t glint_program_rows(const glint_program *program); ///< largest number of intermediate values that are live at
    ///< the same time
bool glint_program_reads(const glint_program *program, glint_input input);
/// Returns a hash of the operations, their operands and the textures, excluding numbers: programs that differ only in
/// numbers have the same hash.
void glint_program_structure(const glint_program *program, uint64_t key[2]);
/// Returns true and fills `outputs` if every output is a number and so the same at every point.
bool glint_program_constant(const glint_program *program, double *outputs);
/// Returns a program that computes the derivatives of the outputs with respect to a parameter, for glint_slope. The
/// derivatives are exact, except that floor and similar steps, comparisons and a texel's footprint count as constant.
/// Owned by `program`. NULL: none of its numbers depends on the parameter.
const glint_program *glint_program_tangent(const glint_program *program, size_t parameter);
/// Returns the instructions as text, one per line, "r3 = muladd p.x 0.5 r1", followed by the outputs. Numbers read
/// back as the same bits. The caller frees the text. NULL: out of memory.
char *glint_program_listing(const glint_program *program);

#define GLINT_TEXELS_MAX ((size_t)1 << 25) ///< most pixels of a texture

/// The fields of a texture.
typedef struct glint_texture_desc {
    size_t struct_size; ///< sizeof(glint_texture_desc)
    int width, height; ///< size of the picture, pixels: 1 .. 65535, together at most GLINT_TEXELS_MAX
    const uint8_t *rgb; ///< red, green and blue of each pixel, 8 bits each, top row first; borrowed for the call. NULL:
        ///< `row` gives the picture
    /// Writes the linear red, green, blue and alpha of each pixel of row y, 0 .. 1e30; called once for each row
    void (*row)(void *context, int y, float *rgba);
    void *context; ///< passed to `row`
    glint_wrap wrap; ///< default repeat
    glint_filter filter; ///< default bilinear
    bool linear; ///< true: values of `rgb` are linear. false, the default: they are sRGB and are decoded
} glint_texture_desc;

/// Writes the defaults: no picture, repeat, bilinear, sRGB.
void glint_texture_desc_init(glint_texture_desc *desc, size_t size);
GLINT_DESC_DEFAULT(texture);
/// Makes a texture; glint_texture_read of glint_files.h reads one. GLINT_ERR_INVALID names the field; GLINT_ERR_FORMAT
/// names a pixel out of its range; GLINT_ERR_NOMEM.
glint_status glint_texture_create(const glint_texture_desc *desc, glint_texture **out, glint_error *error);
/// Makes a texture that shares the same picture but has another wrap. GLINT_ERR_NOMEM.
glint_status glint_texture_rewrap(const glint_texture *texture, glint_wrap wrap, glint_texture **out,
                                  glint_error *error);
/// Takes another reference; returns its argument. Any thread.
glint_texture *glint_texture_retain(glint_texture *texture);
/// Releases a reference; the last one frees the texture. NULL: nothing. Any thread.
void glint_texture_release(glint_texture *texture);
/// Size in pixels.
int glint_texture_width(const glint_texture *texture);
int glint_texture_height(const glint_texture *texture);

// ---- Derivatives of pictures ---------------------------------------------------------------------------------------

#define GLINT_DERIVATIVE_NAME_SIZE 32 ///< bytes of a derivative's name, with the ending NUL

/// The derivative of one field of the scene with respect to a parameter. At most one of the four objects is not NULL;
/// if all are NULL, it is a field of the scene's own description.
typedef struct glint_slope {
    const glint_material *material; ///< the object that has the field, if it is a material; otherwise NULL
    const glint_light *light; ///< the owner, if it is a light
    const glint_shape *shape; ///< the owner, if it is a shape
    const glint_camera *camera; ///< the owner, if it is a camera
    const char *field; ///< name of the field in the description, one of those listed at glint_derivative
    double slope[3]; ///< slope of each component; a single number uses the first
    /// For a material's field that a program computes: the derivative at each point, from glint_program_tangent;
    /// `slope` is then ignored. Retained by the plan. NULL: `slope` is used
    const glint_program *program;
} glint_slope;

/// The derivative of the picture's light (linear beauty) with respect to a parameter. It is exact while the visible
/// surfaces, the shadows and the samples of area lights stay the same, and while a surface point moves with its
/// viewer, as seen by the eye, in mirrors and through glass. Rays too weak to be seen (2^-20 of linear light per
/// sample) are not followed. Slopes of objects outside the scene are ignored. The fields that may have slopes:
///
///   material  every number and colour; mirror and transmission where they are above 0; for fields that programs
///             compute, only with built-in models
///   light     color, intensity, ambient, diffuse, specular, attenuation, position, direction, inner_rad, outer_rad,
///             exponent, radiance
///   scene     ambient, background, depth_cue_color, depth_cue_near, depth_cue_far
///   shape     spheres: center, radius; planes: point, normal
///   camera    eye, at, direction, up, fov_y_rad, height; with a lens also aperture, focus, focus_point
struct glint_derivative {
    const char *name; ///< name of the derivative, 1 .. 31 bytes, such as "lamp_x"
    const glint_slope *slopes; ///< slopes of the same field add up
    size_t slope_count; ///< number of slopes. 0: the parameter affects nothing, which a plan refuses. A slope of 0
        ///< marks a field that depends on the parameter but has slope 0 here
};

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
