/// Arithmetic that gives the same bits on every machine: elementary functions, the operations of programs, and
/// how textures are read. Kernels know this much of the interface.
#ifndef GLINT_MATH_H
#define GLINT_MATH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

// ---- Elementary functions ------------------------------------------------------------------------------------------

/// Elementary functions with the same bits on every machine, within 0.51 ulp of the exact result (0.76 if the result
/// is subnormal). Infinite and NaN arguments as in C11 annex F.
double glint_sin(double radians);
double glint_cos(double radians);
double glint_tan(double radians);
double glint_exp(double x);
double glint_log(double x);
double glint_pow(double x, double y);
double glint_srgb_encode(double linear); ///< IEC 61966-2-1:1999; input clamped to 0 .. 1, NaN gives 0
double glint_srgb_decode(double encoded); ///< the inverse; input clamped to 0 .. 1

// ---- Inputs and operations of programs -----------------------------------------------------------------------------

#define GLINT_PROGRAM_LENGTH_MAX 4096 ///< most instructions of a program
#define GLINT_PROGRAM_ROWS_MAX 256 ///< most intermediate values that a program may need at the same time
#define GLINT_PROGRAM_OUTPUTS_MAX 8 ///< most outputs of a program, per point

/// The inputs of a program at a point. Directions are unit vectors.
typedef enum glint_input {
    GLINT_INPUT_P_X, ///< x of the point in the shape's own space, before the transforms of the shape and its groups
    GLINT_INPUT_P_Y, ///< its y
    GLINT_INPUT_P_Z, ///< its z
    GLINT_INPUT_WORLD_X, ///< x of the point in world space
    GLINT_INPUT_WORLD_Y, ///< its y
    GLINT_INPUT_WORLD_Z, ///< its z
    GLINT_INPUT_N_X, ///< x of the geometric normal, facing the viewer
    GLINT_INPUT_N_Y, ///< its y
    GLINT_INPUT_N_Z, ///< its z
    GLINT_INPUT_V_X, ///< x of the direction towards the eye
    GLINT_INPUT_V_Y, ///< its y
    GLINT_INPUT_V_Z, ///< its z
    /// The first of the shape's own surface coordinates. Plane and disk: lengths along two tangents. Box: 0 .. 1 on
    /// each face. Sphere, cylinder and cone: 0 .. 1 around and along. Torus: 0 .. 1 around its axis and around its
    /// tube. Mesh: interpolated between the corners by barycentric coordinates
    GLINT_INPUT_UV_U,
    GLINT_INPUT_UV_V, ///< the second surface coordinate
    GLINT_INPUT_FOOTPRINT, ///< width of a pixel at the point, in world units
    GLINT_INPUT_UV_FOOTPRINT, ///< width of a pixel at the point, in units of u and v: by the one that grows faster
    GLINT_INPUT_UV_FOOTPRINT_U, ///< the same in units of u
    GLINT_INPUT_UV_FOOTPRINT_V, ///< the same in units of v
    GLINT_INPUT_L_X, ///< x of the direction towards the light; this and all later inputs are for shaders only
    GLINT_INPUT_L_Y, ///< its y
    GLINT_INPUT_L_Z, ///< its z
    GLINT_INPUT_LIGHT_R, ///< red part of the light's colour times its intensity times its attenuation
    GLINT_INPUT_LIGHT_G, ///< its green part
    GLINT_INPUT_LIGHT_B, ///< its blue part
    GLINT_INPUT_DISTANCE, ///< distance to the light, in world units; infinite for a directional light
    GLINT_INPUT_KD_R, ///< red part of the material's diffuse reflectance at the point
    GLINT_INPUT_KD_G, ///< its green part
    GLINT_INPUT_KD_B, ///< its blue part
    GLINT_INPUT_KS_R, ///< red part of the material's specular reflectance at the point
    GLINT_INPUT_KS_G, ///< its green part
    GLINT_INPUT_KS_B, ///< its blue part
    GLINT_INPUT_SHININESS, ///< the material's exponent at the point
    GLINT_INPUT_COUNT ///< number of inputs
} glint_input;

/// Operations. `true` is 1 and `false` is 0; as a condition, every number except 0 is true. min and max are
/// a < b ? a : b and a > b ? a : b. Operations under "exact" are IEEE 754 operations, rounded once. The others are
/// composed of these in the order written here, unless stated otherwise.
typedef enum glint_op {
    // exact
    GLINT_OP_ADD, ///< a + b
    GLINT_OP_SUB, ///< a - b
    GLINT_OP_MUL, ///< a b
    GLINT_OP_DIV, ///< a / b
    GLINT_OP_NEG, ///< -a
    GLINT_OP_ABS, ///< |a|
    GLINT_OP_SQRT,
    GLINT_OP_MIN,
    GLINT_OP_MAX,
    GLINT_OP_FLOOR,
    GLINT_OP_CEIL,
    GLINT_OP_ROUND, ///< to the nearest whole number, halves away from 0
    GLINT_OP_FRACT, ///< a - floor(a)
    GLINT_OP_MOD, ///< a % b as in Lua on floats: exact, with the sign of b
    GLINT_OP_SIGN, ///< 1, 0 or -1; 0 for NaN
    // two roundings
    GLINT_OP_MULADD, ///< a b + c
    GLINT_OP_SUBMUL, ///< a - b c
    GLINT_OP_MULSUB, ///< a b - c
    GLINT_OP_MIX, ///< a + t (b - a); operands a, b, t
    // choice
    GLINT_OP_LESS, ///< a < b
    GLINT_OP_LESSEQ, ///< a <= b
    GLINT_OP_EQUAL, ///< a == b
    GLINT_OP_AND,
    GLINT_OP_OR,
    GLINT_OP_NOT,
    GLINT_OP_SELECT, ///< c ? a : b; operands c, a, b
    GLINT_OP_STEP, ///< 0 if x < e, otherwise 1; operands e, x
    GLINT_OP_SMOOTHSTEP, ///< t t (3 - 2 t), t = min(max((x - a) / (b - a), 0), 1); operands a, b, x
    GLINT_OP_CLAMP, ///< min(max(x, a), b); operands x, a, b
    // elementary functions, implemented here; special values as in C99, annex F
    GLINT_OP_SIN, ///< sine of an angle in radians; error at most 4e-16, for any angle
    GLINT_OP_COS, ///< cosine of an angle in radians; error at most 4e-16, for any angle
    GLINT_OP_EXP2, ///< 2^a; relative error 2.5e-16
    GLINT_OP_LOG2, ///< relative error 4e-16; absolute error 4e-16 where the result is below 1
    GLINT_OP_POW, ///< a^b; relative error 1e-12
    GLINT_OP_ATAN2, ///< operands y, x; -pi .. pi; error 6e-16
    GLINT_OP_ACOS, ///< 0 .. pi; NaN outside -1 .. 1; error 6e-16
    GLINT_OP_HIGHLIGHT, ///< x^s for a cosine x and an exponent s, computed in float by the kernel of the built-in
        ///< models: seven digits, 0 below 2^-40. x is clamped to at most 1, s to at least 0
    // patterns
    GLINT_OP_NOISE, ///< operands x, y, z: smooth gradient noise, -1 .. 1, 0 at whole numbers. Gradients and fade of
        ///< K. Perlin, "Improving Noise", SIGGRAPH 2002; the hash is our own. Repeats after 2^32
    GLINT_OP_NOISE3, ///< three independent noises: 3 results
    GLINT_OP_CELL, ///< operands x, y, z: distances to the nearest and the second-nearest feature point. Each unit
        ///< cube has one such point (S. Worley, "A Cellular Texture Basis Function", SIGGRAPH 1996): 2 results
    GLINT_OP_HASH, ///< operands x, y, z: a number in [0, 1), independent of the numbers at other x, y, z
    /// Operands x, y, z: (floor(x) + floor(y) + floor(z)) % 2, for numbers of any size: a checkerboard
    GLINT_OP_PARITY,
    // made by the builder and by differentiation, and textures: not for glint_builder_op
    GLINT_OP_MULMUL, ///< (a b) c
    GLINT_OP_DOT, ///< (a b + c d) + e f
    /// Operands x, y, z, k: derivatives of NOISE (k = 0) or of result k of NOISE3 (1 .. 3): 3 results
    GLINT_OP_NOISE_SLOPE,
    GLINT_OP_CELL_SLOPE, ///< derivatives of CELL's first and second results: 6 results
    GLINT_OP_TEXEL, ///< glint_builder_texel: 4 results
    GLINT_OP_TEXEL_SLOPE, ///< derivatives of TEXEL's results with respect to u, and to v: 8 results
    GLINT_OP_COUNT
} glint_op;

#define GLINT_OPERANDS_MAX 6 ///< most operands of an operation
#define GLINT_RESULTS_MAX 8 ///< most results of an operation

/// The description of an operation.
typedef struct glint_op_info {
    const char *name; ///< "add"
    uint32_t operands; ///< 1 .. GLINT_OPERANDS_MAX
    uint32_t results; ///< 1 .. GLINT_RESULTS_MAX
} glint_op_info;

/// Returns the description of an operation; static. NULL: there is no such operation.
const glint_op_info *glint_op_info_of(glint_op op);
/// Applies one operation to plain numbers. The results have the same bits as in a program. Any thread.
/// op        any operation except TEXEL and TEXEL_SLOPE.
/// operands  as many as the operation reads.
/// results   written: as many as the operation has.
void glint_op_apply(glint_op op, const double *operands, double *results);
/// Returns the name of an input, such as "p.x" or "light.r"; static. NULL: there is no such input.
const char *glint_input_name(glint_input input);

// ---- Textures ------------------------------------------------------------------------------------------------------

/// How a texture continues where u or v is outside 0 .. 1.
typedef enum glint_wrap {
    GLINT_WRAP_REPEAT, ///< the picture repeats
    GLINT_WRAP_CLAMP, ///< the border texels continue
    GLINT_WRAP_AROUND ///< repeats in u, continues the border in v: for a picture around a ball, or a panorama
} glint_wrap;
/// How the colour at a point between texels is computed.
typedef enum glint_filter {
    /// Interpolates four texels of a mipmap level, which is the picture halved as often as the footprint requires. If a
    /// pixel covers more texels along one axis than along the other, takes the mean of up to 16 such colours
    GLINT_FILTER_BILINEAR,
    GLINT_FILTER_NEAREST ///< takes the texel at u, v of the full-size picture
} glint_filter;

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
