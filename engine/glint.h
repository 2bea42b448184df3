/// glint: a ray-tracing render engine. This header is the whole public C API.
///
/// The order of use: describe (materials, lights, shapes, a camera, a scene), plan (glint_plan_create takes a
/// snapshot of the scene and lists the stages that a frame needs), render (glint_render runs the plan), write.
///
/// Units     lengths are in world units, angles in radians (`_rad`), colours linear RGB with 1.0 = display white.
/// Vectors   `double v[3]` is x, y, z or red, green, blue. The world is right-handed.
/// Errors    every function that can fail returns a glint_status and fills `error`, which may be NULL. On failure,
///           outputs and objects are unchanged. The message starts with the argument's name: "shininess: number >= 0
///           expected, got -1". NULL for a pointer that is not optional is GLINT_ERR_INVALID, too: "shape: pointer
///           expected, got NULL". Functions that return no status return 0, NULL, false or the identity transform
///           instead, or do nothing.
/// Ownership `_create` returns a reference that the caller owns and must release with `_release`; `_retain` adds one.
///           `_release(NULL)` does nothing. Pointers in a description struct are borrowed for the call only.
/// Threads   described objects (material, light, camera, shape, overlay, scene) belong to one thread at a time. Plans
///           and finished images are immutable. A renderer renders one frame at a time.
#ifndef GLINT_H
#define GLINT_H

// clang-format off: it would separate comments from the lines that they explain

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

#define GLINT_VERSION "0.2.0"

#define GLINT_NAME_SIZE 64 ///< bytes of an object's name, with the ending NUL
#define GLINT_SIDE_MAX 65535 ///< longest side of an image, in pixels

/// The result of a call that can fail.
typedef enum glint_status {
    GLINT_OK = 0, ///< done
    GLINT_ERR_INVALID, ///< an argument is out of its range
    GLINT_ERR_NOMEM, ///< out of memory; nothing was changed
    GLINT_ERR_IO, ///< a failure of the system: a file that cannot be opened, a short write
    GLINT_ERR_NO_SPACE, ///< disk or quota full; a later attempt may succeed
    GLINT_ERR_FORMAT, ///< a file with invalid contents
    GLINT_ERR_CANCELLED, ///< glint_renderer_cancel was called
    GLINT_ERR_UNSUPPORTED ///< this machine or build cannot do it
} glint_status;

/// Why a call failed. Written only on failure.
typedef struct glint_error {
    glint_status status; ///< never GLINT_OK
    char message[512]; ///< UTF-8, one line, begins with the argument's name
} glint_error;

// ---- Programs: patterns and shaders -------------------------------------------------------------------------------

/// A straight-line list of operations on doubles, run for many points at once. A pattern computes a material's value
/// at a point; a shader computes the light that a point reflects from one light source. A builder makes the program,
/// value by value. A program has no branches and no loops, so its time is proportional to its length. The same
/// numbers give the same bits on every machine.

typedef struct glint_program glint_program; ///< immutable
typedef struct glint_builder glint_builder; ///< a program under construction; only one thread at a time may use it
typedef struct glint_texture glint_texture; ///< immutable
typedef uint32_t glint_value; ///< a value in a builder: one double per point

#define GLINT_PROGRAM_LENGTH_MAX 4096 ///< most instructions of a program
#define GLINT_PROGRAM_ROWS_MAX 256 ///< most intermediate values that a program may need at the same time
#define GLINT_PROGRAM_OUTPUTS_MAX 8 ///< most outputs of a program, per point
#define GLINT_PARAMETERS_MAX 32 ///< most parameters that the numbers of a program may depend on

/// A pattern gives a number or a colour at a point, a shader the light reflected from one light source.
typedef enum glint_program_kind { GLINT_PROGRAM_PATTERN, GLINT_PROGRAM_SHADER } glint_program_kind;

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

/// The fields of a texture.
typedef struct glint_texture_desc {
    const char *path; ///< path of a .png, .hdr or .pfm file, or of a .jpg or .exr file if the build has libjpeg or OpenEXR;
        ///< NULL: `rgb` is the picture
    const uint8_t *rgb; ///< red, green and blue of each pixel, 8 bits each, top row first; borrowed for the call
    int width, height; ///< size of `rgb`, pixels, >= 1
    glint_wrap wrap; ///< default repeat
    glint_filter filter; ///< default bilinear
    bool linear; ///< true: pixel values are linear. false, the default: they are sRGB and are decoded, unless the
        ///< file declares itself linear (gAMA 1.0). .hdr, .exr and .pfm are always linear
} glint_texture_desc;

/// Returns the defaults: no path, repeat, bilinear, sRGB.
glint_texture_desc glint_texture_desc_default(void);
/// Reads a picture. GLINT_ERR_IO, GLINT_ERR_FORMAT if the file cannot be read or is not a complete picture;
/// GLINT_ERR_NOMEM.
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

// ---- Fields -------------------------------------------------------------------------------------------------------

/// The type of a field in a description.
typedef enum glint_field_type {
    GLINT_TYPE_NUMBER, ///< double, finite
    GLINT_TYPE_WHOLE, ///< double, a whole number
    GLINT_TYPE_ANGLE, ///< double, radians; scripts and messages use degrees
    GLINT_TYPE_FLAG, ///< bool
    GLINT_TYPE_VECTOR, ///< double[3], finite
    GLINT_TYPE_DIRECTION, ///< double[3], finite, not zero
    GLINT_TYPE_COLOR, ///< double[3], linear RGB, finite, >= 0
    GLINT_TYPE_CHOICE, ///< an enumeration; `names` lists its values
    GLINT_TYPE_TEXT, ///< char[GLINT_NAME_SIZE]
    GLINT_TYPE_OBJECT, ///< a pointer to an object; `names[0]` is the kind of object
    GLINT_TYPE_POINTS, ///< const double (*)[3], followed by a size_t: the number of points
    GLINT_TYPE_DISTANCE, ///< a double, > 0, followed by a bool and a double[3]: if the bool is true, the point
        ///< replaces the distance. 0 and false: neither is set
    GLINT_TYPE_TRANSFORM, ///< glint_transform
    GLINT_TYPE_POSE, ///< a rigid map of the world to a camera's axes; `parts` begins with the rows of the fields that
        ///< it replaces: eye, at, direction and up
    GLINT_TYPE_PROGRAM, ///< a program only
    GLINT_TYPE_TABLE, ///< several fields of the same description, listed in `parts`, that are given together
    GLINT_TYPE_CUSTOM, ///< defined by the caller; no engine table uses it
    GLINT_TYPE_OTHER ///< defined by the caller; no engine table uses it
} glint_field_type;

#define GLINT_TAKES_PATTERN 1u ///< bits of glint_object_field.takes: a program evaluated at each point
#define GLINT_TAKES_TEXTURE 2u ///< a picture
#define GLINT_TAKES_SHADER 4u ///< a program evaluated for each light
#define GLINT_TAKES_VARIABLE 8u ///< a number with a slope; frames compute derivatives with respect to it

/// One field of an object: the row that defines its default, its check and its documentation.
typedef struct glint_object_field {
    const char *name; ///< name of the field in scripts and messages
    const char *member; ///< name of the member of the description; NULL: the field has no member of its own
    glint_field_type type; ///< type of the value in the description
    size_t offset; ///< in the description
    size_t set_offset; ///< offset of a bool that says whether the field is set; 0: the field always counts as set
    size_t unset_offset; ///< offset of a bool that is true while another field is used instead; 0: there is none
    size_t program_offset; ///< offset of a glint_program *; unless NULL, the program replaces the value. 0: there is
        ///< none
    unsigned takes; ///< what may replace a number: bits GLINT_TAKES_...
    bool required; ///< whether an object cannot be made without the field
    /// GLINT_TYPE_CHOICE: names of the values, from 0, ending with NULL; GLINT_TYPE_OBJECT: the kind
    const char *const *names;
    const struct glint_object_field *parts; ///< GLINT_TYPE_TABLE: ends with a row without a name
    double low, high; ///< smallest and largest number allowed, for each component; angles in radians
    const char *expected; ///< the allowed values in words, for messages: "number >= 0"
    double initial[3]; ///< the default, or the index of the default choice; components not given are 0
    const char *follows; ///< the field that supplies the value until this one is set; NULL: none
    const char *unit; ///< the unit, such as "world units"; NULL: none
    const char *doc; ///< the meaning of the field, in one line
    const void *custom; ///< GLINT_TYPE_CUSTOM: for the caller's use
} glint_object_field;

/// Kinds of objects that have a table of fields.
typedef enum glint_object_kind {
    GLINT_OBJECT_NONE, ///< no object, no fields
    GLINT_OBJECT_MATERIAL, ///< fields of glint_material_desc
    GLINT_OBJECT_POINT_LIGHT, ///< the fields of glint_light_desc that this kind reads; the kind is
        ///< GLINT_OBJECT_POINT_LIGHT + a glint_light_kind
    GLINT_OBJECT_DIRECTIONAL_LIGHT, ///< fields of a directional light
    GLINT_OBJECT_SPOT_LIGHT, ///< fields of a spot light
    GLINT_OBJECT_DISK_LIGHT, ///< fields of a disk light
    GLINT_OBJECT_POLYGON_LIGHT, ///< fields of a polygon light
    GLINT_OBJECT_SPHERE_LIGHT, ///< fields of a sphere light
    GLINT_OBJECT_SCENE, ///< fields of glint_scene_desc
    GLINT_OBJECT_CAMERA, ///< fields of glint_camera_desc
    GLINT_OBJECT_SPHERE, ///< the fields of glint_shape_desc that this kind reads; the kind is GLINT_OBJECT_SPHERE + a
        ///< glint_shape_kind
    GLINT_OBJECT_PLANE, ///< fields of a plane
    GLINT_OBJECT_SPHERES, ///< fields of many spheres
    GLINT_OBJECT_MESH, ///< fields of a mesh
    GLINT_OBJECT_BOX, ///< fields of a box
    GLINT_OBJECT_DISK, ///< fields of a disk
    GLINT_OBJECT_CYLINDER, ///< fields of a cylinder
    GLINT_OBJECT_CONE, ///< fields of a cone
    GLINT_OBJECT_TORUS, ///< fields of a torus
    GLINT_OBJECT_CYLINDERS, ///< fields of many cylinders
    GLINT_OBJECT_GROUP, ///< fields of a group
    GLINT_OBJECT_UNION, ///< fields of a union
    GLINT_OBJECT_INTERSECTION, ///< fields of an intersection
    GLINT_OBJECT_DIFFERENCE, ///< fields of a difference
    GLINT_OBJECT_KINDS ///< number of kinds
} glint_object_kind;

/// Returns the fields of a kind of object, in the order of the documentation, followed by a row without a name.
/// Writes their number to `count` unless it is NULL. NULL: there is no such kind.
const glint_object_field *glint_object_fields(glint_object_kind kind, size_t *count);

// ---- Materials ----------------------------------------------------------------------------------------------------

/// How a surface reflects, emits and transmits light. Shared by reference between shapes; see Ownership.
typedef struct glint_material glint_material;

/// The specular term S of one light. Unit vectors: n, the normal facing the viewer; l, towards the light; v, towards
/// the eye.
typedef enum glint_model {
    GLINT_MODEL_PHONG, ///< S = max(0, r.v)^shininess, r = 2(n.l)n - l
    GLINT_MODEL_BLINN_PHONG, ///< S = max(0, n.h)^shininess, h = (l + v)/|l + v|
    GLINT_MODEL_LAMBERT, ///< no specular term
    GLINT_MODEL_COOK_TORRANCE ///< S = pi D F G / (4 n.v): microfacets; F is Schlick's, from f0 or ior
} glint_model;

/// The distribution of microfacet slopes, with width alpha = roughness^2. G is Smith's, height-correlated (E. Heitz,
/// "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014; for Beckmann by the fit
/// of B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007).
typedef enum glint_distribution { GLINT_DISTRIBUTION_GGX, GLINT_DISTRIBUTION_BECKMANN } glint_distribution;

/// The meaning of an opacity between 0 and 1. In every mode a surface of opacity 0 is invisible and one of opacity 1
/// is opaque.
typedef enum glint_opacity_mode {
    GLINT_OPACITY_AUTO, ///< a number blends, a pattern cuts
    GLINT_OPACITY_CUT, ///< where the opacity is below 0.5 or NaN, the surface is absent for all rays of a frame;
        ///< elsewhere it is opaque. Objects behind a hole look as they do without the surface
    /// The light that the surface gives, including mirrored, refracted and indirect light, is multiplied by the
    /// opacity o. Eye, mirror, glass and indirect rays also continue straight on with weight 1 - o, and shadow rays
    /// pass with weight 1 - o. Each surface counts: a ray through a closed ball crosses two surfaces and keeps
    /// (1 - o)^2.
    GLINT_OPACITY_BLEND
} glint_opacity_mode;

/// Programs that replace a material's numbers; NULL: the number is used. A material retains its programs. A pattern
/// result that is NaN or below 0 becomes 0, and one above 2^100 becomes 2^100; both are counted in glint_frame_stats.
/// A program whose outputs are numbers is replaced by them, and glint_material_get returns them, except that an
/// opacity between 0 and 1 stays a pattern.
typedef struct glint_material_programs {
    glint_program *diffuse, *ambient, *specular, *mirror, *transmission; ///< patterns of a colour, or of one number
        ///< for a grey; `ambient` follows the pattern of `diffuse` until `ambient` is set or has a pattern of its own
    glint_program *shininess, *roughness; ///< patterns of one number; `roughness` above 1 counts as 1
    /// Pattern of one number, the height above the surface in world units. Lighting, reflection and refraction use
    /// the normal unit(n - (g - (g.n) n)), where g is the gradient of the height with respect to `p` and `world`. A
    /// point is lit only if n.l > 0 for the unperturbed n as well
    glint_program *bump;
    glint_program *opacity; ///< pattern of one number; see glint_opacity_mode
    glint_program *shader; ///< replaces `model`. The program computes the diffuse term of each light and, if it has
        ///< six outputs, also the specular term
} glint_material_programs;

/// The fields of a material. Reflectances are fractions of light, in linear RGB.
typedef struct glint_material_desc {
    glint_model model; ///< default phong
    bool has_ambient; ///< false: `ambient` follows `diffuse`
    double ambient[3]; ///< reflectance: finite, >= 0; above 1 the surface gives off more light than it receives
    double diffuse[3]; ///< default 0.8
    bool has_specular; ///< read only by cook_torrance; false: `specular` is 1
    double specular[3]; ///< default 0
    double shininess; ///< exponent, finite, >= 0; default 32. 0 gives S = 1 wherever r.v > 0
    bool has_mirror; ///< false: `mirror` is 1 with `fresnel` or cook_torrance, otherwise 0
    /// Fraction of the light along the mirrored ray that is added; >= 0, default 0. cook_torrance: factor of the light
    /// that the facets reflect from everything but the lamps, whose highlights are `specular`; default 1
    double mirror[3];
    /// Fraction of the light along the refracted ray that is added; >= 0, default 0. It also tints the object's
    /// shadow, once for each surface that the light crosses. A totally reflected ray crosses no surface and keeps
    /// max(mirror, 1) of its light
    double transmission[3];
    double ior; ///< refractive index inside, > 0; default 1.5. Outside it is 1, or the index of the enclosing object
    /// Multiplies `mirror` by a dielectric's Fresnel reflectance R, `transmission` by 1 - R; default false
    bool fresnel;
    double absorption[3]; ///< absorption coefficient inside, per world unit, >= 0; default 0: light is multiplied by
        ///< exp(-absorption distance)
    /// Energy-conserving normalisation. phong: S = (s + 2)/2 (r.v)^s (n.l) (E. Lafortune and Y. Willems 1994);
    /// blinn_phong: S = (s + 2)(s + 4)/(8 (2^(-s/2) + s)) (n.h)^s (n.l) (F. Giesen, "Phong and Blinn-Phong
    /// normalization factors", 2009). Both are reciprocal. Other models ignore it
    bool normalized;
    /// blinn_phong: the exponent is 4 s, which gives the highlight closest to Phong's. Other models ignore it
    bool matched;
    /// false: models other than cook_torrance are smooth. cook_torrance always reads `roughness`
    bool has_roughness;
    /// 0 .. 1, default 0.3. cook_torrance: below 1e-9 it counts as 1e-9: a highlight narrower than any pixel. Other models: 0 is a
    /// smooth mirror or smooth glass; above, reflected and refracted rays have the distribution of microfacets, as
    /// with cook_torrance
    double roughness;
    glint_distribution distribution; ///< default GGX
    // cook_torrance:
    bool has_f0; ///< false: f0 = ((ior - 1) / (ior + 1))^2
    double f0[3]; ///< reflectance at normal incidence, 0 .. 1; coloured for metals
    double opacity; ///< 0 .. 1, default 1; see glint_opacity_mode. glint_scene_cast hits the surface at any opacity
    glint_opacity_mode opacity_mode; ///< default auto
    glint_material_programs program;
    char name[GLINT_NAME_SIZE];
} glint_material_desc;

/// Returns a description with every field at its default.
glint_material_desc glint_material_desc_default(void);
/// Writes `ambient`, `specular`, `f0` and `mirror` if they follow other fields, and marks them as set.
void glint_material_desc_resolve(glint_material_desc *desc);
/// Makes a material from a copy of `desc`. GLINT_ERR_INVALID names the field that is out of range; GLINT_ERR_NOMEM.
glint_status glint_material_create(const glint_material_desc *desc, glint_material **out, glint_error *error);
/// Replaces the whole description by a copy of `desc`; existing plans keep the old one. On error nothing changes.
glint_status glint_material_set(glint_material *material, const glint_material_desc *desc, glint_error *error);
/// Returns the description; borrowed, valid until the material is set or released.
const glint_material_desc *glint_material_get(const glint_material *material);
/// Takes another reference; returns its argument.
glint_material *glint_material_retain(glint_material *material);
/// Releases a reference; the last one frees the material. NULL: nothing.
void glint_material_release(glint_material *material);

/// The two terms of one light of strength 1, from the kernels that a frame uses.
typedef struct glint_reflection {
    double diffuse[3]; ///< kd (n.l), 0 where n.l <= 0
    double specular[3]; ///< ks S, 0 where n.l <= 0
} glint_reflection;

/// Evaluates a material at a point from its numeric fields; programs are ignored. The three vectors point away from
/// the surface and need not be unit; finite, not zero.
glint_status glint_material_evaluate(const glint_material *material, const double normal[3], const double to_light[3],
                                     const double to_eye[3], glint_reflection *out, glint_error *error);

// ---- Lights -------------------------------------------------------------------------------------------------------

/// A light source. Shared by reference between scenes.
typedef struct glint_light glint_light;

/// The shape of a light. Area lights (disk, polygon, sphere) cast soft shadows.
typedef enum glint_light_kind {
    GLINT_LIGHT_POINT, ///< shines equally in all directions from `position`
    GLINT_LIGHT_DIRECTIONAL, ///< parallel light along `direction`
    GLINT_LIGHT_SPOT, ///< a point light restricted to a cone
    GLINT_LIGHT_DISK, ///< the first of the area lights, which take `samples` points on their surface, different ones
        ///< for each pixel of a 4 x 4 block
    GLINT_LIGHT_POLYGON, ///< convex, flat; shines on one side unless `two_sided`
    GLINT_LIGHT_SPHERE ///< the surface of a ball
} glint_light_kind;

#define GLINT_CORNERS_MAX 4096 ///< most corners of a polygon light

/// How a light's shadows are computed.
typedef enum glint_shadow {
    GLINT_SHADOW_RAYS, ///< one ray to each sample of the light
    GLINT_SHADOW_HARD, ///< area lights: one ray to the centre of the light, for all of its samples
    GLINT_SHADOW_CAPS ///< sphere lights: the share of the light's apparent disk that is covered by spheres, computed
        ///< in closed form
} glint_shadow;

/// The fields of a light. Each kind reads the fields whose comment names it, and those whose comment names no kind.
typedef struct glint_light_desc {
    glint_light_kind kind; ///< kind of the light; glint_light_set cannot change it
    double color[3]; ///< default 1; finite, >= 0
    double intensity; ///< default 1; finite, >= 0; multiplies each of the three terms
    bool has_diffuse, has_specular; ///< false: the term's colour is `color`
    double ambient[3]; ///< default 0; neither attenuated nor shadowed
    double diffuse[3], specular[3]; ///< light colours for these two terms; finite, >= 0; default `color`
    double attenuation[3]; ///< c0, c1, c2 of A = 1/(c0 + c1 d + c2 d^2); >= 0, not all 0; default {1, 0, 0}
    bool shadows; ///< default true
    /// Area lights; default GLINT_SHADOW_RAYS. Caps are free of noise: the light's terms are computed for a point
    /// light at the centre and multiplied by the visible share of the light. With `radiance` L the irradiance is pi L
    /// r^2/d^2 (n.l), which is exact above the horizon. The share is exact with one sphere as occluder. With several
    /// it is the product of their shares, while the true share lies between 1 - the sum of the covered shares and the
    /// smallest visible share. Planes, and spheres that intersect the light, cover a share of its diameter. Scenes
    /// with other or transparent shapes use rays: see the effects of the plan
    glint_shadow shadow;
    /// Eye, mirror and glass rays see the light's surface, on the sides that shine; default false. With `radiance` L
    /// it shows pi L color: pixel values are pi times radiance, as for the background. With `intensity` I it shows
    /// color I A(D), where D is the light's radius (for a polygon, the radius of a disk of the same area). A visible
    /// light casts no shadow and is not an object: in the passes it is background with a depth and a normal. Lights
    /// without a surface ignore this field
    bool visible;
    double position[3]; ///< point and spot light; disk and sphere light: the centre
    double direction[3]; ///< directional and spot light: the direction of travel; not zero, need not be unit
    double inner_rad, outer_rad; ///< spot: half angles, 0 <= inner <= outer <= pi: full light inside, none outside,
        ///< smoothstep of the cosine between; default 20 and 30 degrees
    double exponent; ///< spot: the light is multiplied by cos^exponent of the angle to the axis; >= 0, default 0
    double normal[3]; ///< disk: normal on the side that emits light; not zero, need not be unit; default {0, -1, 0}
    double radius; ///< disk and sphere: >= 0, 0 is a point; with `radiance` 0 or 1e-150 .. 1e150; default 1
    /// Polygon: its corners, convex and in one plane, 3 .. GLINT_CORNERS_MAX; copied. It shines on the side from
    /// which they run counter-clockwise
    const double (*vertices)[3];
    size_t vertex_count;
    bool two_sided; ///< polygon: shines on both sides; default false
    double samples; ///< area lights: number of shadow rays for each sample of a pixel; whole number, 1 .. 65536;
        ///< default 16
    bool has_radiance; ///< area lights: `radiance` gives the strength; `intensity` must then be 1
    /// Name of the light pass that collects this group's lights; "": the light's own name
    char group[GLINT_NAME_SIZE];
    /// >= 0: the light adds kd times the integral of radiance cos cos' / distance^2 over its surface. With `intensity`,
    /// it adds the mean light of point lights spread over its surface
    double radiance;
    char name[GLINT_NAME_SIZE];
} glint_light_desc;

/// Returns a description with every field at the default for this kind.
glint_light_desc glint_light_desc_default(glint_light_kind kind);
/// Makes a light from a copy of `desc`. GLINT_ERR_INVALID names the field that is out of range; GLINT_ERR_NOMEM.
glint_status glint_light_create(const glint_light_desc *desc, glint_light **out, glint_error *error);
/// Replaces the description by a copy; on error nothing changes. `desc->kind` must be the light's kind.
glint_status glint_light_set(glint_light *light, const glint_light_desc *desc, glint_error *error);
/// Returns the description; borrowed, with its `vertices`, until the light is set or released.
const glint_light_desc *glint_light_get(const glint_light *light);
/// Takes another reference; returns its argument.
glint_light *glint_light_retain(glint_light *light);
/// Releases a reference; the last one frees the light. NULL: nothing.
void glint_light_release(glint_light *light);

// ---- Camera -------------------------------------------------------------------------------------------------------

/// The camera of a scene. Shared by reference between scenes.
typedef struct glint_camera glint_camera;

/// Rays through one point (perspective) or parallel rays (orthographic).
typedef enum glint_projection { GLINT_PERSPECTIVE, GLINT_ORTHOGRAPHIC } glint_projection;

/// The fields of a camera; lengths in world units.
typedef struct glint_camera_desc {
    glint_projection projection; ///< default GLINT_PERSPECTIVE
    double eye[3]; ///< world units, finite; default {0, 0, 10}
    bool has_direction; ///< true: looks along `direction`; false: looks at the point `at`
    /// Finite; `at` differs from `eye`, `direction` is not zero; defaults: the origin, {0, 0, -1}
    double at[3], direction[3];
    /// Default {0,1,0}; not zero. If parallel to the view, the world axis least aligned with the view replaces it
    double up[3];
    double fov_y_rad; ///< vertical field of view of a perspective camera, in (0, pi); default 40 degrees
    /// Focal lengths of a perspective camera in pixels, horizontal and vertical, > 0, instead of `fov_y_rad`. 0, the
    /// default: not given; `fy` 0: same as `fx`
    double fx, fy;
    /// The principal point, where the optical axis meets the picture: pixels from its left and upper edges; the
    /// centre of the first pixel is 0.5. Finite; default: the centre of the picture
    bool has_cx, has_cy;
    double cx, cy;
    double w, h; ///< the picture size that fx, fy, cx and cy refer to; other sizes scale them. 0, the default: they
        ///< hold for every size
    double height; ///< vertical extent of an orthographic camera, world units, > 0; default 10
    double pixel_offset; ///< position of the sample in its pixel if there is only one, 0 .. 1; default 0.5, the centre
    /// Time that the shutter is open, as a fraction of the time between frames, 0 .. 1; default 0, an instant. Used
    /// by callers that plan a frame for several times, see glint_plan_create_exposed
    double shutter;
    double shutter_times; ///< number of times at which the scene is planned while the shutter is open,
        ///< 1 .. GLINT_SHUTTER_TIMES_MAX; default 8
    /// Radius of the lens, world units, >= 0; default 0: a pinhole, which shows everything sharp. Each sample starts
    /// at a point of the lens, in the plane through the eye perpendicular to the view, and passes through the point
    /// where the pinhole's ray crosses the plane of focus. At depth d, a point is blurred over a disk of diameter
    /// 2 aperture |1 - d / focus|. An orthographic camera has a lens for each ray. Many samples make the blur smooth.
    double aperture;
    /// Distance of the plane of focus along the view, > 0; default 0: given by `focus_point`, or else by `at`
    double focus;
    bool has_focus_point; ///< true: the plane of focus goes through `focus_point`; `focus` must be 0
    double focus_point[3]; ///< finite, in front of the eye
    /// 0: a round lens, the default; 3 .. 64, whole: a regular polygon inscribed in that circle, a corner up
    double blades;
    double blade_rotation_rad; ///< turns the polygon, counter-clockwise as seen by the eye; default 0
    char name[GLINT_NAME_SIZE]; ///< name for messages; "": none
} glint_camera_desc;
#define GLINT_SHUTTER_TIMES_MAX 1024

/// Returns a perspective camera at (0, 0, 10) that looks at the origin, with every field at its default.
glint_camera_desc glint_camera_desc_default(void);
/// Makes a camera from a copy of `desc`. GLINT_ERR_INVALID names the field that is out of range; GLINT_ERR_NOMEM.
glint_status glint_camera_create(const glint_camera_desc *desc, glint_camera **out, glint_error *error);
/// Replaces the whole description by a copy of `desc`; on error nothing changes.
glint_status glint_camera_set(glint_camera *camera, const glint_camera_desc *desc, glint_error *error);
/// Returns the description; borrowed, valid until the camera is set or released.
const glint_camera_desc *glint_camera_get(const glint_camera *camera);
/// Computes the view window of a picture of width x height pixels at distance 1: window[0] .. window[1] to the right
/// and window[2] .. window[3] up, world units. For an orthographic camera the window is the same at every distance.
void glint_camera_window(const glint_camera_desc *desc, double width, double height, double window[4]);
/// Computes the world point at a position in a picture of width x height pixels, at a distance from the eye along the
/// view. It is the inverse of glint_camera_project.
///   pixel   to the right and down from the picture's upper left corner.
void glint_camera_point(const glint_camera_desc *desc, double width, double height, const double pixel[2], double distance,
                        double point[3]);
/// Projects a world point into a picture of width x height pixels; occluders are ignored.
///   pixel   to the right and down from the picture's upper left corner; the centre of the first pixel is 0.5, 0.5
///   depth   as in the pass `depth`: the distance from the eye; for an orthographic camera, the distance along the view
/// Returns false and stores nothing if the point is not in front of the camera.
bool glint_camera_project(const glint_camera_desc *desc, double width, double height, const double point[3], double pixel[2],
                          double *depth);
/// Takes another reference; returns its argument.
glint_camera *glint_camera_retain(glint_camera *camera);
/// Releases a reference; the last one frees the camera. NULL: nothing.
void glint_camera_release(glint_camera *camera);

// ---- Shapes -------------------------------------------------------------------------------------------------------

/// A surface or a group of surfaces. Shared by reference between groups and scenes.
typedef struct glint_shape glint_shape;

/// The kind of a shape. It determines which fields of the description are used.
typedef enum glint_shape_kind {
    GLINT_SHAPE_SPHERE, ///< `center`, `radius`
    GLINT_SHAPE_PLANE, ///< `point`, `normal`; infinite
    GLINT_SHAPE_SPHERES, ///< made by glint_spheres_create
    GLINT_SHAPE_MESH, ///< made by the mesh functions
    GLINT_SHAPE_BOX, ///< `min`, `max`
    GLINT_SHAPE_DISK, ///< `center`, `normal`, `radius`
    GLINT_SHAPE_CYLINDER, ///< `base`, `top`, `radius`
    GLINT_SHAPE_CONE, ///< `base`, `top`, the apex, `radius` at the base
    GLINT_SHAPE_TORUS, ///< `center`, `axis`, `major`, `minor`
    GLINT_SHAPE_CYLINDERS, ///< made by glint_cylinders_create or glint_bonds_create; `capped`
    GLINT_SHAPE_GROUP, ///< a group of shapes; see glint_group_add
    GLINT_SHAPE_UNION, ///< a solid composed of parts: the points inside any of them; see glint_group_add
    GLINT_SHAPE_INTERSECTION, ///< the points inside all parts
    GLINT_SHAPE_DIFFERENCE ///< the points inside the first part and outside all others
} glint_shape_kind;

/// An affine map from (x, y, z) to out: out_i = m[i][0] x + m[i][1] y + m[i][2] z + m[i][3].
typedef struct glint_transform {
    double m[3][4]; ///< the last column is the translation, world units
} glint_transform;

/// Returns the identity.
glint_transform glint_transform_identity(void);
/// Returns the map that applies first `inner`, then `outer`.
glint_transform glint_transform_product(const glint_transform *outer, const glint_transform *inner);
/// Returns a translation by `by`, world units.
glint_transform glint_transform_translate(const double by[3]);
/// Returns the map that multiplies x, y and z by the three factors; negative ones mirror. Shapes refuse a factor of
/// 0.
glint_transform glint_transform_scale(const double by[3]);
/// Returns a rotation, counter-clockwise when the axis points at the eye. The axis is not zero and need not be unit;
/// quarter turns are exact.
glint_transform glint_transform_rotate(const double axis[3], double degrees);

/// The points and normals at which the lighting of a mesh is computed. With flat and gouraud, the light on a face is
/// the same for all viewers: a mirror shows the highlights as the eye sees them directly.
typedef enum glint_shading {
    GLINT_SHADING_FACETED, ///< at each sample, with the normal of its face
    /// At each sample, with the normal interpolated between the corners in the mesh's own space, so that a transform
    /// moves normals as it moves faces. Only the faces decide hits and shadows: a face that looks away from a light
    /// is dark up to its edge, whatever its normals; see glint_mesh_bend
    GLINT_SHADING_PHONG,
    GLINT_SHADING_FLAT, ///< once per face, at its centroid, with its normal
    GLINT_SHADING_GOURAUD ///< once per vertex, interpolated by barycentric coordinates over triangles
} glint_shading;

/// The fields of a shape. Each kind reads the fields whose comment names it, and those whose comment names no kind.
/// Lengths in world units.
typedef struct glint_shape_desc {
    glint_shape_kind kind; ///< kind of the shape; glint_shape_create makes all kinds except spheres, meshes and cylinders
    /// Retained by the shape. NULL: a material with default fields; for a part of a combined solid, the solid's
    /// material; for the solid, the material of its first part that has one. A group has none
    glint_material *material;
    /// From the shape's own space to its group or the world; default identity; must be invertible
    glint_transform transform;
    bool two_sided; ///< default true: the normal is turned to the viewer; false: back faces get ambient light only
    /// Sphere, disk (also radius of cylinder and cone, center of torus): finite, radius > 0; see glint_scene_cast
    double center[3], radius;
    double point[3], normal[3]; ///< plane (and disk: normal): finite, normal not zero, need not be unit
    double min[3], max[3]; ///< box: finite, min < max; default -1, 1
    double base[3], top[3]; ///< cylinder, cone: the centres of its ends, which differ; the cone's top is its apex
    bool capped; ///< cylinder: closed at both ends; cone: closed at its base; default true. False: only the curved
        ///< side, which is visible from inside, too. The shape then has no inside: rays refract as at a solid without
        ///< end
    double axis[3]; ///< torus: not zero, need not be unit; default {0, 1, 0}
    double major, minor; ///< torus: radius of the circle in the middle of the tube, and radius of the tube;
        ///< 0 < minor < major, so that the tube does not intersect itself; default 1, 0.25
    glint_shading shading; ///< mesh
    char name[GLINT_NAME_SIZE];
} glint_shape_desc;

/// Returns a description with every field at the default for this kind.
glint_shape_desc glint_shape_desc_default(glint_shape_kind kind);
/// Makes a shape from a copy of `desc` and retains its material. GLINT_ERR_INVALID names the field; GLINT_ERR_NOMEM.
glint_status glint_shape_create(const glint_shape_desc *desc, glint_shape **out, glint_error *error);
/// Replaces the description by a copy of the same kind; on error nothing changes.
glint_status glint_shape_set(glint_shape *shape, const glint_shape_desc *desc, glint_error *error);
/// Returns the description; borrowed. Only these fields are defined: for GLINT_SHAPE_SPHERES kind, transform,
/// two_sided, name and material (the first); for GLINT_SHAPE_CYLINDERS these and `capped`; for a mesh these and
/// `shading`; for a group kind, transform and name;
/// for a combined solid these, two_sided and material. Setting `material` replaces the first material.
const glint_shape_desc *glint_shape_get(const glint_shape *shape);
/// Takes another reference; returns its argument.
glint_shape *glint_shape_retain(glint_shape *shape);
/// Releases a reference; the last one frees the shape and releases what it retains. NULL: nothing.
void glint_shape_release(glint_shape *shape);

/// Returns the number of materials of a shape, 1 for most shapes, and writes their list, owned by the shape.
size_t glint_shape_materials(const glint_shape *shape, glint_material *const **list);

/// Computes a box around all spheres, cylinders or vertices of a GLINT_SHAPE_SPHERES, GLINT_SHAPE_CYLINDERS or
/// GLINT_SHAPE_MESH shape, before its transform. Returns false and leaves the box unchanged for other kinds, whose description gives their position.
bool glint_shape_bounds(const glint_shape *shape, double lower[3], double upper[3]);

#define GLINT_GROUP_DEPTH 64 ///< largest depth of nested groups and combined solids

// Combined solids. Parts are spheres, boxes, capped cylinders and cones, tori, planes (half-spaces, inside is the
// side opposite to the normal), closed meshes, other combined solids, and groups, which stand for the union of their
// shapes. A solid has at most 64 parts; a torus counts as two, a mesh as four.
//
// A mesh is closed if each edge is used by as many triangles in one direction as in the other; corners at the same
// position count as one. Its shading is faceted or phong. A point is inside if a path from it leaves the mesh more
// often than it enters. A mesh of negative volume is turned inside out first.
//
// A combined solid is one object. A part is visible only where it bounds the solid, and has its own material there, in
// its own space. Light that enters through any part is in one medium, with `ior` and `absorption` of the solid's
// material. `two_sided` of parts is ignored. Coincident faces enclose nothing: a box minus a box that ends at the
// same face is open there. Where several parts bound the solid at the same place, the first defined is visible.

/// Adds a shape to a group or combined solid, which retains it. The shape may also be in other groups and scenes: it
/// appears in each, under all transforms around it, and a change to it shows everywhere. Refused: a group inside
/// itself, the same shape twice, and in a combined solid a shape without an inside. The message then names an open
/// edge of a mesh.
glint_status glint_group_add(glint_shape *group, glint_shape *child, glint_error *error);
/// Removes the shape from the group or combined solid and releases it. GLINT_ERR_INVALID if the shape is not in it.
glint_status glint_group_remove(glint_shape *group, glint_shape *child, glint_error *error);
/// Returns the number of shapes directly in the group or combined solid, not counting those in nested groups.
size_t glint_group_count(const glint_shape *group);
glint_shape *glint_group_child(const glint_shape *group, size_t index); ///< borrowed

/// Many spheres in one shape, given as one array.
typedef struct glint_spheres_desc {
    const void *data; ///< count times x, y, z, radius; any alignment; copied
    size_t count; ///< 1 .. 2^30
    bool is_float; ///< true: `data` is binary32, false: binary64; native byte order
    glint_material *const *materials; ///< materials, retained; NULL entries are not allowed
    size_t material_count; ///< number of materials; 0: one material with default fields
    /// Material of each sphere: `count` numbers < material_count, copied; NULL: all are 0
    const uint32_t *material_index;
    bool two_sided; ///< default true: the normal is turned to the viewer
    char name[GLINT_NAME_SIZE]; ///< name for messages; "": none
} glint_spheres_desc;

/// Makes spheres. A message names the first invalid sphere, counted from 1: "data: sphere 12: radius > 0 expected,
/// got -1".
glint_status glint_spheres_create(const glint_spheres_desc *desc, glint_shape **out, glint_error *error);
/// Returns x, y, z and radius of all spheres; owned by the shape. NULL for other kinds.
const double *glint_spheres_data(const glint_shape *shape);
/// Returns the material of each sphere, cylinder or triangle, from 0; owned by the shape. NULL: all have the first.
const uint32_t *glint_spheres_index(const glint_shape *shape);
/// Makes cylinders from the same description: `data` is count times base, top and radius, 7 numbers. They are capped
/// until glint_shape_set changes it. Messages name the first invalid cylinder as glint_spheres_create does.
glint_status glint_cylinders_create(const glint_spheres_desc *desc, glint_shape **out, glint_error *error);

/// The atoms among which glint_bonds_create looks for bonds. All arrays are borrowed for the call.
typedef struct glint_bonds_desc {
    const double *points; ///< `stride` numbers for each atom; the first three are its position
    size_t stride, count; ///< stride >= 3; number of atoms, up to 2^30
    /// Two atoms are joined if their distance is above `closest` and not above the sum of their reaches, >= 0. NaN: the
    /// atom has no bonds
    const double *reach;
    double closest;
    double low[3], size[3]; ///< a box with periodic sides: its corner and the diagonal of its matrix; size >= 0, and
        ///< > 0 for periodic sides
    double xy, xz, yz; ///< tilt: x of the second side, x and y of the third
    bool periodic[3]; ///< sides across which bonds continue; none: the box is not used
    double radius; ///< of the cylinders; > 0
    glint_material *const *materials; ///< as for spheres
    size_t material_count;
    const uint32_t *material_index; ///< material of each atom; NULL: all are 0
} glint_bonds_desc;

/// Finds pairs of atoms by their distance and makes open cylinders of them: two for each bond, from each atom to the
/// middle, with the material of the atom. The middle is that of the nearest images. *out: NULL if there are no bonds.
/// GLINT_ERR_INVALID names a wrong number, or a periodic side shorter than 1/8 of the longest bond.
glint_status glint_bonds_create(const glint_bonds_desc *desc, glint_shape **out, glint_error *error);
/// Number of spheres or cylinders; of triangles for a mesh; 1 for other shapes
size_t glint_spheres_count(const glint_shape *shape);

/// Polygons with shared vertices. A face of more than three corners is cut into triangles: as a fan from its first
/// corner, or by ear clipping if the fan would leave the polygon. The front is the side from which corners run
/// counter-clockwise.
typedef struct glint_mesh_desc {
    const double *vertices; ///< x, y, z of each vertex; finite; copied, like all arrays here
    size_t vertex_count; ///< number of vertices, 3 .. 2^31 - 2
    const uint32_t *corners; ///< indices of vertices, from 0, face after face
    const uint32_t *face_sizes; ///< number of corners of each face, 3 or more
    size_t face_count; ///< number of faces, 1 .. 2^31 - 2; the same limit holds for the number of triangles
    const double *normals; ///< x, y, z of each normal; finite, not zero, need not be unit; NULL: none
    size_t normal_count; ///< number of normals; 0 without `normals`
    /// Index of a normal, from 0, for each entry of `corners`; GLINT_NO_NORMAL: none there. NULL: each vertex has one
    /// normal, in order
    const uint32_t *normal_corners;
    const double *uv; ///< texture coordinates, u and v of each pair; finite; NULL: none
    size_t uv_count; ///< number of u, v pairs; 0 without `uv`
    /// Index of a u, v pair, from 0, for each entry of `corners`; GLINT_NO_UV: none there, and no program may read
    /// the coordinates of this mesh. NULL: each vertex has one pair, in order
    const uint32_t *uv_corners;
    bool has_shading; ///< false: phong if there are normals, otherwise faceted
    /// Phong and gouraud without normals: the normals of the faces around a vertex are averaged, weighted by area
    glint_shading shading;
    glint_material *material; ///< material of all faces, retained; NULL: `materials`, the file's materials, or one
        ///< material with default fields
    /// Materials of individual faces: retained, instead of `material`; no NULL entries
    glint_material *const *materials;
    size_t material_count; ///< number of `materials`; 0: all faces have `material`
    /// Material of each face: face_count numbers < material_count, copied; NULL: all are 0
    const uint32_t *material_index;
    glint_transform transform; ///< default identity
    bool two_sided;
    char name[GLINT_NAME_SIZE];
    /// called by glint_mesh_load before a file is opened; NULL: not called
    void (*reads)(void *context, const char *path);
    /// called by glint_mesh_load when something in the file is ignored; the message names the file; NULL: not called
    void (*warns)(void *context, const char *message);
    void *context; ///< passed to both functions as `context`
} glint_mesh_desc;

#define GLINT_NO_NORMAL 0xffffffffu
#define GLINT_NO_UV 0xffffffffu

/// Returns the defaults: no faces, two-sided, identity transform.
glint_mesh_desc glint_mesh_desc_default(void);
/// Makes a mesh. A message names the first invalid face and vertex, counted from 1: "faces[3]: vertex 1 .. 8
/// expected, got 9", "faces[3]: a face with an area expected: its vertices 1, 2, 3 are on one line". A triangle
/// without area inside a larger face is left out.
glint_status glint_mesh_create(const glint_mesh_desc *desc, glint_shape **out, glint_error *error);
/// Reads a mesh; `desc` gives the fields that are not in the file. GLINT_ERR_IO if it cannot be read,
/// GLINT_ERR_FORMAT if its contents are invalid: the message has "FILE:LINE: ...", or the number of the vertex or
/// face. The ending of the name selects the format:
///
/// .stl  text or binary; corners at the same position are one vertex. Normals in the file are ignored; faces have
///       their own.
/// .ply  text or binary, either byte order: vertices (x y z, nx ny nz, u v or s t), faces (texcoord) and tristrips.
///       If `desc` has no material, a comment TextureFile names the picture of the diffuse colour. Otherwise red,
///       green and blue (8-bit or 16-bit values, or floats 0 .. 1 or 0 .. 255; sRGB) give each face a material named
///       after its colour ("#ff8000"): the face's own colour, or the mean of its corners in linear light, rounded to
///       8 bits.
/// else  Wavefront .obj: v (x y z, and r g b as in .ply), vt, vn and f (any polygon; negative numbers count from the
///       end). If `desc` has no material, also usemtl and mtllib: Kd, Ks, Ns, d (or Tr), Pr and Pm (microfacets),
///       illum 3 .. 7 (mirror of Ks; 5, 7 fresnel; 6, 7 refraction by Ni), map_Kd, map_Ks, map_d (holes where red is
///       below one half), map_Bump (grey; -bm is its height). For other illum, d < 1 transmits without refraction,
///       and Kd and Ks are multiplied by d. Groups, lines and points are ignored.
///
/// Faces without area, with fewer than 3 corners or with vertices that are not finite are left out. Polygons that
/// intersect themselves are cut as fans. Normals of length 0, invalid lines of .mtl files and unknown statements are
/// ignored. `warns` is called once for each kind of problem.
glint_status glint_mesh_load(const char *path, const glint_mesh_desc *desc, glint_shape **out, glint_error *error);
/// Makes a sphere of `segments` (whole number, 3 .. 16384) around the equator and half as many, rounded up, from pole
/// to pole. The vertices have the sphere's exact normals. `desc` gives shading (default phong), material, sides and
/// name.
glint_status glint_sphere_mesh_create(const double center[3], double radius, double segments,
                                      const glint_mesh_desc *desc, glint_shape **out, glint_error *error);

/// Returns the largest angle between a face of a mesh and its corner normals, in degrees, 0 .. 90, in the mesh's own
/// space; 0 for other shapes and shading. Where light grazes a face at a smaller angle, the face shadows itself
/// although its shading is lit. To avoid this, use more segments, or lights with `shadows` false. The first call
/// reads all triangles; do not call it for one mesh from two threads at once.
double glint_mesh_bend(const glint_shape *shape);

/// Returns the arguments with which glint_sphere_mesh_create made a shape. Returns false and writes nothing if
/// another function made the shape.
bool glint_sphere_mesh_get(const glint_shape *shape, double center[3], double *radius, double *segments);

// ---- Overlays -----------------------------------------------------------------------------------------------------

/// A label, a colour bar, axes, an arrow, a line or an arc, drawn onto a finished picture's 8-bit or 16-bit values.
/// Shared by reference between scenes.
///
/// Only .png files of beauty show overlays; other passes, stored planes and linear files do not. Later overlays cover
/// earlier ones. No stage reads overlays, so changing one traces no rays. A point is dpi / 72 pixels if the file has
/// a dpi, and otherwise one pixel.
///
/// FreeType draws the letters, from the font file that the variable GLINT_FONT names, or from DejaVu Sans where
/// installed. Their pixels, and so the frame's key, depend on that font and on FreeType's version; pictures without
/// text do not. Without FreeType or a font, or if GLINT_FONT is "bitmap", letters come from a bitmap font of 8 by 13
/// pixels and its multiples, identical on every machine.
typedef struct glint_overlay glint_overlay;

/// The kind of an overlay. It determines which fields of the description are used.
typedef enum glint_overlay_kind {
    GLINT_OVERLAY_LABEL, ///< `text`
    GLINT_OVERLAY_COLORBAR, ///< the colours of a map with numbers next to them; `text` is its title
    GLINT_OVERLAY_AXES, ///< the world's x, y and z directions as the camera sees them, each with its name. With a
        ///< `box`: three of its edges as the camera sees them, with numbers along them
    GLINT_OVERLAY_ARROW, ///< a line between two points of the world, with a head at `to`; `text` is its label
    GLINT_OVERLAY_LINE, ///< the same as an arrow, but without a head; its label is next to its middle
    GLINT_OVERLAY_ARC, ///< the angle between the directions `from` and `to` at `point`; `text` is its label
    GLINT_OVERLAY_POLYLINE, ///< straight segments between `points`; `text` is its label, next to its middle
    // Polylines whose points the caller computes before a plan is made, from the fields that their comments name:
    GLINT_OVERLAY_LOBE, ///< the polar diagram of a highlight at `point`; see glint_material_evaluate
    GLINT_OVERLAY_PATH, ///< the path of a ray; see glint_scene_path
    GLINT_OVERLAY_FRUSTUM, ///< the view of a camera; see glint_camera_point
    GLINT_OVERLAY_CHART ///< curves over a grid, with numbers and names along two axes; `text` is its title
} glint_overlay_kind;

#define GLINT_OVERLAY_POINTS_MAX 128 ///< most points of a polyline
#define GLINT_POINT_BEGINS 1u ///< bits of point_flags: no segment leads to this point
#define GLINT_POINT_MARKED 2u ///< a dot is drawn at the point

/// How an arrow, a line, an arc or a label at a point is drawn where surfaces hide it.
/// Surfaces count at any opacity.
typedef enum glint_hidden {
    GLINT_HIDDEN_DRAWN, ///< the same as in front of surfaces
    GLINT_HIDDEN_DASHED, ///< dashes; not for labels
    GLINT_HIDDEN_NONE ///< nothing; an arrow has no head and no label if its tip is hidden, and a line or an arc no
        ///< label if its middle is hidden
} glint_hidden;

/// A table of 256 colours, from the lowest value to the highest.
typedef enum glint_colormap {
    GLINT_COLORMAP_VIRIDIS, ///< N. Smith and S. van der Walt, 2015
    GLINT_COLORMAP_MAGMA, ///< N. Smith and S. van der Walt, 2015
    GLINT_COLORMAP_CIVIDIS, ///< J. R. Nunez, C. R. Anderton and R. S. Renslow, 2018
    GLINT_COLORMAP_TURBO, ///< A. Mikhailov, 2019
    GLINT_COLORMAP_COOLWARM, ///< K. Moreland, 2009
    GLINT_COLORMAP_COUNT ///< number of colour maps
} glint_colormap;

/// Returns "viridis", ...; NULL if out of range.
const char *glint_colormap_name(glint_colormap map);
/// Returns the 256 colours of a map as 8-bit sRGB 0xRRGGBB; static. NULL if out of range.
const uint32_t *glint_colormap_table(glint_colormap map);

/// The direction of a colour bar: from bottom to top, or from left to right.
typedef enum glint_orientation { GLINT_VERTICAL, GLINT_HORIZONTAL } glint_orientation;

#define GLINT_CURVES_MAX 16 ///< most curves of a chart
#define GLINT_CHART_TEXT_SIZE 128 ///< bytes of the label of a curve or the name of an axis, with the ending NUL

/// A curve of a chart: straight lines from point to point. Pointers are borrowed for the call.
typedef struct glint_curve {
    const double *x, *y; ///< finite. Where one of them is NaN, the line has a gap; at least one point is not a gap
    size_t count; ///< number of points, 1 .. 1000000
    const char *label; ///< UTF-8, one line, next to the end of the curve; "": none
    bool has_color; ///< false: a colour for the curve's number
    double color[3]; ///< linear RGB, finite, >= 0
    bool has_width; ///< false: about a seventh of the letters' size
    double width; ///< thickness, points, 0 .. 1000; 0: no line; otherwise at least a pixel
    bool has_dots; ///< true: a dot at each point. A point between two gaps always has one
} glint_curve;

/// The curves of a chart. Immutable, reference counted; any thread.
typedef struct glint_chart glint_chart;
/// Makes a chart from a copy of 1 .. GLINT_CURVES_MAX curves. GLINT_ERR_INVALID names the curve and its field.
glint_status glint_chart_create(const glint_curve *curves, size_t count, glint_chart **out, glint_error *error);
/// Takes another reference; returns its argument.
glint_chart *glint_chart_retain(glint_chart *chart);
/// Releases a reference; the last one frees the chart. NULL: nothing.
void glint_chart_release(glint_chart *chart);
/// Returns curve number `i`, from 0, whose pointers are valid as long as the chart; NULL: there is none.
const glint_curve *glint_chart_curve(const glint_chart *chart, size_t i);

#define GLINT_OVERLAY_TEXT_SIZE 384 ///< bytes of an overlay's text, with the ending NUL
#define GLINT_OVERLAY_TICKS_MAX 16 ///< most numbers next to a colour bar
#define GLINT_AXIS_NAME_SIZE 64 ///< bytes of an axis's name, with the ending NUL

/// The fields of an overlay. Each kind reads the fields whose comment names it, and those whose comment names no
/// kind.
typedef struct glint_overlay_desc {
    glint_overlay_kind kind; ///< kind of the overlay; glint_overlay_set cannot change it
    /// All kinds except axes: UTF-8, lines separated by newlines; "": none. Parts between two $ are formulas. Without a
    /// position, a label's lines that are wider than the picture are broken at blanks
    char text[GLINT_OVERLAY_TEXT_SIZE];
    /// Position as a fraction of the free space inside the margin: 0 is left or top, 1 right or bottom. Default:
    /// label {0, 0}, colour bar {1, 0.5}, axes {0, 1}, chart {0.5, 0.5}
    double at[2];
    bool has_position; ///< true: `position` is used instead of `at`
    /// Upper left corner, in pixels from the picture's upper left corner; finite, may lie outside
    double position[2];
    bool has_size; ///< false: a 36th of the picture's height in pixels, at least 10
    double size; ///< size of the letters, points, 1 .. 10000
    bool has_margin; ///< false: half of `size`
    /// Distance to the picture's border; for a label at a point of the world, distance to that point; points,
    /// 0 .. 10000
    double margin;
    /// Colour of letters and lines, linear RGB, finite, >= 0; above 1 counts as 1; default 1, chart 0.02. Not tone-mapped
    double color[3];
    bool has_background; ///< false: no rectangle is drawn behind the overlay; default false, chart true
    double background[3]; ///< colour of the rectangle behind the overlay; linear RGB like `color`; chart: default 1
    double opacity; ///< opacity of the rectangle, 0 .. 1; default 1
    bool has_length; ///< false: colour bar 10 times `size`, axes 2.5 times
    /// Colour bar: length of the bar; axes: length of an axis parallel to the picture; points, 1 .. 10000
    double length;
    glint_colormap map; ///< colour bar
    bool has_colors; ///< true: the colour bar shows `colors` instead of `map`
    uint32_t colors[256]; ///< from low to high, 8-bit sRGB 0xRRGGBB
    double low, high; ///< colour bar: the values at its ends; finite, different from each other; default 0, 1
    bool is_log; ///< colour bar: logarithmic scale; low and high are above 0
    glint_orientation orientation; ///< colour bar; default vertical
    double ticks[GLINT_OVERLAY_TICKS_MAX]; ///< colour bar: the values labelled, from low to high
    size_t tick_count; ///< number of `ticks`; 0: about five round values
    char names[3][GLINT_AXIS_NAME_SIZE]; ///< axes: names of x, y and z
    /// Axes. true: along edges of `box` that bound the visible part of it, instead of `at`; the upright axis is at
    /// the left, the others below. A direction that the eye looks along has no such edge and no axis; from inside the
    /// box there are none. Then has_position, has_margin, has_length and has_background must be false
    bool has_box;
    /// Lowest and highest corner in the world; finite; one or two sides may be 0 and then have no axis
    double box[2][3];
    /// With has_box: the box is an oblique cell at box[0] with the edge vectors `sides`; box[1] is not read
    bool has_sides;
    double sides[3][3]; ///< finite; one may be 0 and then has no axis, the others span a plane
    bool has_values; ///< false: axes show world coordinates, or for a cell lengths along its sides
    double values[2][3]; ///< values at the two corners; finite, different along each side that is not 0; may decrease
    /// Arrow, line: the two ends in the world, a finite distance apart; where they are equal, nothing is drawn. Arc:
    /// two directions, not zero, need not be unit; opposite ones have a half circle that faces the camera. Default
    /// {0, 0, 0}, {1, 0, 0}; arc {1, 0, 0}, {0, 1, 0}
    double from[3], to[3];
    bool has_point; ///< label. true: next to `point`, instead of `at` and `position`
    /// Label, arc: a point in the world. The text of a label, an arrow, a line or an arc tries eight positions around
    /// its place, and takes the first inside the picture that covers no other text, bar or axes and if possible no
    /// arrow, line or arc. If none is free it tries eight more, farther away, up to 11 times; if still none is free,
    /// it takes the first position of all
    double point[3];
    /// Polyline, lobe, path, frustum: points of the world, finite; flags of each point; their number: 2 .. 128 for a
    /// polyline, 0 .. 128 for the others
    double points[GLINT_OVERLAY_POINTS_MAX][3];
    uint8_t point_flags[GLINT_OVERLAY_POINTS_MAX];
    size_t point_count;
    /// Lobe: `from` is the normal (has_normal false: the surface's at `point`), `to` the direction to the light. Path:
    /// origin and direction of the ray. Both directions need not be unit
    bool has_normal;
    double depth; ///< path: most surfaces at which the ray goes on, a whole number 0 .. 63; default 4
    double aspect; ///< frustum: width of the picture divided by its height, > 0; default 16 / 9
    bool has_radius; ///< arc. false: the radius is a twelfth of the picture's height at the distance of `point`
    /// Arc: its radius. Lobe: length of a highlight of 1; without has_radius 1. Path: length of a segment that hits
    /// nothing; without has_radius the length of the first segment. Frustum: distance of the picture from the eye;
    /// without has_radius the distance of the point that the camera looks at, or 1. World units, > 0
    double radius;
    bool has_width; ///< overlays with lines. false: the width is an eighth of `size`
    double width; ///< thickness of a line, points, 0 .. 10000; at least one pixel is drawn
    /// Overlays with lines: how the hidden part is drawn; label at `point`: what is drawn if the point is hidden, not
    /// dashes; default drawn
    glint_hidden hidden;
    glint_chart *chart; ///< chart: its curves; retained, not NULL
    char titles[2][GLINT_CHART_TEXT_SIZE]; ///< chart: names of x and y; "": none
    bool is_log_axis[2]; ///< chart: logarithmic x, y; all their numbers are above 0
    bool has_range[2]; ///< chart. false: the range of the points, for y with a little space
    double range[2][2]; ///< chart: first and last number along x and y; finite, different
    bool has_extent; ///< chart. false: the picture inside the margin
    double extent[2]; ///< chart: width and height with numbers and names, points, 1 .. 10000
    char name[GLINT_NAME_SIZE]; ///< name for messages; "": none
} glint_overlay_desc;

/// Returns a description with every field at the default for this kind.
glint_overlay_desc glint_overlay_desc_default(glint_overlay_kind kind);
/// Makes an overlay from a copy of `desc`. Texts run from left to right: letters of right-to-left scripts are an
/// error. GLINT_ERR_INVALID names the field that is out of range; GLINT_ERR_NOMEM.
glint_status glint_overlay_create(const glint_overlay_desc *desc, glint_overlay **out, glint_error *error);
/// Replaces the description by a copy of the same kind; on error nothing changes.
glint_status glint_overlay_set(glint_overlay *overlay, const glint_overlay_desc *desc, glint_error *error);
/// Returns the description; borrowed, valid until the overlay is set or released.
const glint_overlay_desc *glint_overlay_get(const glint_overlay *overlay);
/// Takes another reference; returns its argument.
glint_overlay *glint_overlay_retain(glint_overlay *overlay);
/// Releases a reference; the last one frees the overlay. NULL: nothing.
void glint_overlay_release(glint_overlay *overlay);

// ---- Scene --------------------------------------------------------------------------------------------------------

/// Shapes, lights and overlays, with one camera.
typedef struct glint_scene glint_scene;

/// The fields of a scene, except its lists of objects. Light in linear RGB, lengths in world units.
typedef struct glint_scene_desc {
    glint_camera *camera; ///< retained; may be NULL until a frame is planned
    double ambient[3]; ///< ambient light; finite, >= 0; default 0
    double background[3]; ///< background colour; finite, >= 0; default 0
    /// Retained: a pattern that gives the background for the direction d of a ray, instead of `background`, as seen
    /// by the eye, in mirrors, through glass and by indirect light; NULL: none. d is unit. The pattern reads d as p
    /// and world, -d as n and v, the angle of a pixel in radians as footprint (0 with parallel rays), and the
    /// position of d in a panorama as uv: u = 1/2 + atan2(x, -z) / 2 pi, so that the middle column is -z, the first
    /// and last are +z, and +x is three quarters from the left; v = acos(-y) / pi, from straight down to straight up.
    /// A pattern of numbers only replaces `background` by these numbers. Other results that are NaN or below 0 become
    /// 0
    glint_program *background_program;
    /// Light fades towards a colour with the distance d from the eye to the first surface, as in the pass depth: the
    /// pixel gets f = min(max((d - near) / (far - near), 0), 1) of the colour and 1 - f of the light. The colour's
    /// part goes to the background pass. The background itself and light from mirrors do not fade
    bool has_depth_cue;
    bool has_depth_cue_color; ///< false: `background` is the colour; it must not be a pattern
    double depth_cue_color[3]; ///< finite, >= 0
    double depth_cue_near, depth_cue_far; ///< finite, 0 <= near < far; default 0, 1
    /// false: `ambient` replaces all light that surfaces receive from each other and from the background
    bool has_indirect;
    /// Indirect light paths from each visible point, in cosine-weighted directions. Their mean light times kd is the
    /// indirect light. Whole number, 1 .. 65536.
    double indirect_samples;
    /// Diffuse surfaces at which a path continues; whole number, 0 .. 2^31. At the next diffuse surface `ambient`
    /// replaces the rest; with 0 that is the first one. The part of a material's `ambient` above its `diffuse` is
    /// emitted light and is always added.
    double indirect_bounces;
    /// Ambient light is multiplied by the cosine-weighted unoccluded share of the sky above the point. This applies
    /// to `ambient` of a material up to its `diffuse`; the product goes to the pass `indirect`. The part above
    /// `diffuse` is emitted light and stays in the pass `ambient`. Not together with `has_indirect`, which computes
    /// the light that arrives
    bool has_ambient_occlusion;
    double ambient_occlusion_samples; ///< number of rays from each visible point; whole number, 1 .. 65536
    /// World units, > 0, may be infinite: more distant surfaces do not occlude. A transmitting surface occludes only
    /// the light that it takes; the ray continues refracted, and the distance starts again there
    double ambient_occlusion_distance;
    /// Number of rays that a rough surface reflects or refracts for each sample of a pixel that shows it, from the
    /// distribution of its microfacets: whole number, 0 .. 65536; 16 in a new scene. 0: rough surfaces show lamps only
    double reflection_samples;
} glint_scene_desc;

/// Makes an empty scene without a camera. GLINT_ERR_NOMEM.
glint_status glint_scene_create(glint_scene **out, glint_error *error);
/// Replaces the description by a copy and retains its camera; on error nothing changes.
glint_status glint_scene_set(glint_scene *scene, const glint_scene_desc *desc, glint_error *error);
/// Returns the description; borrowed, valid until the scene is set or released.
const glint_scene_desc *glint_scene_get(const glint_scene *scene);
/// Takes another reference; returns its argument.
glint_scene *glint_scene_retain(glint_scene *scene);
/// Releases a reference; the last one frees the scene and releases what it retains. NULL: nothing.
void glint_scene_release(glint_scene *scene);
/// Adds or removes an object. Objects are numbered in the order they were added, and the scene retains them. Adding
/// an object twice is an error, and so is removing one that is not in the scene. An object may be in several scenes.
glint_status glint_scene_add_shape(glint_scene *scene, glint_shape *shape, glint_error *error);
glint_status glint_scene_add_light(glint_scene *scene, glint_light *light, glint_error *error);
glint_status glint_scene_remove_shape(glint_scene *scene, glint_shape *shape, glint_error *error);
glint_status glint_scene_remove_light(glint_scene *scene, glint_light *light, glint_error *error);
glint_status glint_scene_add_overlay(glint_scene *scene, glint_overlay *overlay, glint_error *error);
glint_status glint_scene_remove_overlay(glint_scene *scene, glint_overlay *overlay, glint_error *error);
/// Returns how many shapes, lights or overlays were added; a group counts as one.
size_t glint_scene_shape_count(const glint_scene *scene);
size_t glint_scene_light_count(const glint_scene *scene);
size_t glint_scene_overlay_count(const glint_scene *scene);

/// Returns an object, `index` < the count, in the order they were added; borrowed from the scene.
glint_shape *glint_scene_shape_at(const glint_scene *scene, size_t index);
glint_light *glint_scene_light_at(const glint_scene *scene, size_t index);
glint_overlay *glint_scene_overlay_at(const glint_scene *scene, size_t index);
/// Writes the name of the light pass that light number `index` < the count belongs to: see glint_render_desc.
void glint_scene_light_pass(const glint_scene *scene, size_t index, char name[GLINT_NAME_SIZE]);

/// The first hit of a ray.
typedef struct glint_hit {
    double t; ///< point = origin + t direction, in units of the direction's length; t > 0
    double point[3]; ///< world units
    double normal[3]; ///< unit, geometric, outward. A plane has its own normal; a triangle's normal points to the
        ///< side from which its corners run counter-clockwise
    glint_shape *shape; ///< borrowed from the scene
    size_t element; ///< number, from 0, of the sphere in a GLINT_SHAPE_SPHERES shape, of the triangle in a mesh, or
        ///< of the part in a combined solid, where nested parts are counted individually
} glint_hit;

/// Computes the nearest hit of one ray with t > 0, by the kernels that a frame uses. `direction` is not zero and need
/// not be unit. Spheres and round solids smaller than 1e-150, in world units or as a fraction of their distance from
/// `origin`, are refused; a frame refuses them by their distance from the eye. *hit says whether there is a hit; *out
/// is written only then.
glint_status glint_scene_cast(const glint_scene *scene, const double origin[3], const double direction[3], bool *hit,
                              glint_hit *out, glint_error *error);

#define GLINT_SEGMENTS_MAX 64 ///< most segments of a path

/// A straight part of the path of a ray.
typedef struct glint_segment {
    double from[3], direction[3]; ///< start; unit direction
    bool hit; ///< whether the segment ends at a surface
    double to[3]; ///< its end; only if `hit`
} glint_segment;

/// Follows one ray through mirrored and refracted directions, by the kernels that a frame uses. `direction` is not zero
/// and need not be unit. A ray goes on from at most `depth` surfaces, and only while it carries at least a hundredth of
/// the light of the first one. Bumps and opacity are ignored, and a mirror or transmission by a program counts as 1.
/// *count: number of segments, at least 1. A segment precedes the segments that begin at its end.
glint_status glint_scene_path(const glint_scene *scene, const double origin[3], const double direction[3], uint32_t depth,
                              glint_segment out[GLINT_SEGMENTS_MAX], size_t *count, glint_error *error);

// ---- A frame --------------------------------------------------------------------------------------------------------

/// The arithmetic that decides hits, their order and shadows: binary64, or binary32 to show the errors that it
/// causes.
typedef enum glint_precision { GLINT_DOUBLE, GLINT_FLOAT } glint_precision;

/// How visible surfaces are found. The pictures are identical bit by bit, except where rays lie in the plane of a
/// triangle, so that rounding decides its edges: about one pixel in some thousand pictures taken from such planes.
typedef enum glint_visibility {
    GLINT_VISIBILITY_AUTO, ///< chooses the method that is likely to be faster
    GLINT_VISIBILITY_CAST, ///< casts a ray through each sample
    GLINT_VISIBILITY_SCAN ///< projects triangles; casts rays at other shapes
} glint_visibility;

/// The values stored for a pixel, as linear float32. Light is the mean over the samples.
typedef enum glint_pass {
    /// (((((background + ambient) + diffuse) + specular) + indirect) + mirror) + transmission, in float32
    GLINT_PASS_BEAUTY,
    GLINT_PASS_BACKGROUND, ///< light of samples that hit nothing, and the light that the colour of the depth cue adds
    GLINT_PASS_AMBIENT, ///< ambient terms
    GLINT_PASS_DIFFUSE, ///< diffuse terms of all lights
    GLINT_PASS_SPECULAR, ///< specular terms of all lights
    GLINT_PASS_INDIRECT, ///< diffuse light from other surfaces
    GLINT_PASS_MIRROR, ///< mirror times the light along mirrored rays
    GLINT_PASS_TRANSMISSION, ///< transmission times the light along refracted rays
    GLINT_PASS_DEPTH, ///< one channel: distance from the eye, +inf where nothing is hit; at the pixel's centre
    GLINT_PASS_NORMAL, ///< shading normal facing the eye, 0 where nothing is hit; at the pixel's centre
    GLINT_PASS_OBJECT_ID, ///< one channel: 1.. in order of definition, 0 where nothing is hit; at the pixel's centre
    GLINT_PASS_ALPHA, ///< one channel, 0 .. 1: the share of the samples that hit something. A sample that reaches the
        ///< background through glass or translucent surfaces, without a reflection, counts as 1 - the mean of its
        ///< weights in the three channels
    GLINT_PASS_OUTLINE, ///< one channel: 1 at silhouettes, at borders between objects and at edges of objects, else
        ///< 0; at the pixel's centre
    GLINT_PASS_REFINED, ///< one channel: 1 where `adaptive` took all samples, else 0; without `adaptive` 1 everywhere
    GLINT_PASS_ALBEDO, ///< diffuse reflectance, 0 where nothing is hit; at the pixel's centre
    GLINT_PASS_COUNT, ///< number of passes
    /// The first derivative of the frame, see glint_render_desc; the others follow it. Three channels
    GLINT_PASS_DERIVATIVE = GLINT_PASS_COUNT,
    /// The first light pass of the frame, see glint_render_desc; the others follow it. Three channels
    GLINT_PASS_LIGHT = GLINT_PASS_DERIVATIVE + 8
} glint_pass;

/// The passes in the order of glint_pass: PASS(ID, name, channels, LOOK) for each one. The look is how a picture shows
/// the pass: LIGHT by the tone curve, SHARE as grey from 0 to 1, DEPTH, NORMAL and OBJECT as bindings/README.md says.
#define GLINT_PASSES(PASS) \
    PASS(BEAUTY, "beauty", 3, LIGHT) \
    PASS(BACKGROUND, "background", 3, LIGHT) \
    PASS(AMBIENT, "ambient", 3, LIGHT) \
    PASS(DIFFUSE, "diffuse", 3, LIGHT) \
    PASS(SPECULAR, "specular", 3, LIGHT) \
    PASS(INDIRECT, "indirect", 3, LIGHT) \
    PASS(MIRROR, "mirror", 3, LIGHT) \
    PASS(TRANSMISSION, "transmission", 3, LIGHT) \
    PASS(DEPTH, "depth", 1, DEPTH) \
    PASS(NORMAL, "normal", 3, NORMAL) \
    PASS(OBJECT_ID, "object_id", 1, OBJECT) \
    PASS(ALPHA, "alpha", 1, SHARE) \
    PASS(OUTLINE, "outline", 1, SHARE) \
    PASS(REFINED, "refined", 1, SHARE) \
    PASS(ALBEDO, "albedo", 3, LIGHT)

/// Returns "beauty", "background", ...; NULL if out of range.
const char *glint_pass_name(glint_pass pass);
/// Returns the pass of that name; GLINT_PASS_COUNT if there is none.
glint_pass glint_pass_from_name(const char *name);
int glint_pass_channels(glint_pass pass); ///< 1 or 3

/// The encoding of light as integer pixel values.
typedef enum glint_transfer {
    GLINT_TRANSFER_SRGB, ///< IEC 61966-2-1:1999
    GLINT_TRANSFER_LINEAR, ///< pixel values are linear, and the file says so (gAMA): viewers brighten them
    GLINT_TRANSFER_NONE ///< pixel values are linear, but the file does not say so: viewers take them for sRGB
} glint_transfer;
/// The rounding of pixel values to integers.
typedef enum glint_rounding { GLINT_ROUND_NEAREST, GLINT_ROUND_TRUNCATE } glint_rounding;

/// The tone curve, applied to each channel separately. x is the light after exposure, the result is 0 .. 1.
typedef enum glint_tone_curve {
    GLINT_TONE_CLAMP, ///< min(x, 1)
    GLINT_TONE_REINHARD, ///< x / (1 + x): Reinhard, Stark, Shirley and Ferwerda 2002, equation 3. Nothing is clipped
    /// h(2 x) / h(11.2), where h is Hable's curve of "Uncharted 2" (Filmic Games, 2010): white from 5.6 on
    GLINT_TONE_FILMIC
} glint_tone_curve;

#define GLINT_EXPOSURE_MAX 32 ///< largest exposure in stops, in both directions

/// The conversion of linear light to integer pixel values, 0 .. M: exposure, curve, transfer, rounding. NaN and
/// negative values become 0; values above the range become M.
typedef struct glint_tone_desc {
    glint_tone_curve curve; ///< default clamp
    glint_transfer transfer; ///< default sRGB, IEC 61966-2-1:1999
    glint_rounding rounding; ///< default nearest: floor(x M + 0.5); truncate: floor(x M)
    int bits; ///< 8 (default) or 16: M = 255 or 65535
    double exposure; ///< stops: light is multiplied by 2^exposure first, in float; default 0
} glint_tone_desc;

/// Returns the defaults: clamp, sRGB, nearest, 8 bits, no exposure.
glint_tone_desc glint_tone_desc_default(void);
/// Writes the smallest float of light, after exposure, that a valid tone maps to each of the 8-bit values 1 .. 255.
/// For programs that display exactly the pixel values of a file.
void glint_tone_steps(const glint_tone_desc *tone, float least[255]);

/// Lines drawn into a PNG of beauty where the pass `outline` is 1.
typedef enum glint_outline_color { GLINT_OUTLINE_NONE, GLINT_OUTLINE_BLACK, GLINT_OUTLINE_WHITE } glint_outline_color;

#define GLINT_DERIVATIVES_MAX (GLINT_PASS_LIGHT - GLINT_PASS_DERIVATIVE) ///< most derivatives of one frame
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
typedef struct glint_derivative {
    const char *name; ///< name of the derivative, 1 .. 31 bytes, such as "lamp_x"
    const glint_slope *slopes; ///< slopes of the same field add up
    size_t slope_count; ///< number of slopes. 0: the parameter affects nothing, which a plan refuses. A slope of 0
        ///< marks a field that depends on the parameter but has slope 0 here
} glint_derivative;

/// One frame: its size, samples and passes.
typedef struct glint_render_desc {
    /// Whole numbers, 1 .. GLINT_SIDE_MAX; default 1280 x 720. Doubles: any script number is checked
    double width, height;
    double samples; ///< samples per pixel; whole number, 1 .. 65536; default 1
    /// 0 (default): every pixel takes all samples. Above 0, at most 3: each pixel first takes one sample, at its
    /// centre. A pixel takes all samples if it and one of its eight neighbours show different objects, normals 26
    /// degrees apart, or pixel values that differ by more than this, summed over red, green and blue, in fractions of
    /// white. Such a pixel is then as without `adaptive`, and every other pixel as with one sample. With one sample
    /// it has no effect
    double adaptive;
    glint_precision precision; ///< the precision of hits and shadows; default GLINT_DOUBLE
    glint_visibility visibility; ///< default GLINT_VISIBILITY_AUTO
    double seed; ///< whole number, 0 .. 2^53; each seed gives another, equally good sample pattern; 0: the pattern is
        ///< not shifted
    /// Longest chain of reflections and refractions; whole number, 0 .. 2^31; default 5. At most 31 if a material has
    /// both and its mirror + transmission is above 1, because rays then double at each surface. From the 17th surface
    /// of a chain on, one of the two rays, chosen at random, represents both
    double max_depth;
    uint32_t passes; ///< bits 1u << GLINT_PASS_...; stored in the image as linear float planes. Beauty may be left
        ///< out. With `outline`, the passes that it needs (depth, normal and object_id) are stored, too
    bool codes; ///< compute integer pixel values of the beauty pass while rendering, by `tone`
    /// Pixels that hit nothing are transparent: the background is black there and pixel values have alpha, so that a
    /// PNG of beauty is RGBA. Passes hold premultiplied light; pixel values hold unpremultiplied light, beauty /
    /// alpha. The background is also left out behind glass and translucent surfaces: see GLINT_PASS_ALPHA. Mirrored
    /// and totally reflected rays show the scene's background. If beauty is stored, so is GLINT_PASS_ALPHA
    bool alpha;
    /// Drawn only in files: planes and pixel values do not have it; the pass is stored. Default none
    glint_outline_color outline;
    glint_tone_desc tone;
    /// x, y, width and height, in pixels, of the part of the frame to render. Its pixels are identical to the same
    /// pixels of the whole frame; the image has the size of the part. Whole numbers within the frame; all 0
    /// (default): the whole frame
    double region[4];
    /// Derivative number i is stored in the image as pass GLINT_PASS_DERIVATIVE + i. Borrowed by glint_plan_create; a
    /// plan's own description has only the count
    const glint_derivative *derivatives;
    size_t derivative_count; ///< 0 (default) .. GLINT_DERIVATIVES_MAX
    /// Light passes, separated by commas: names of light groups, "ambient" for light that no lamp emits, "*" for all
    /// groups of the scene in the order of their first lights, then "ambient". NULL (default): none. A light belongs
    /// to the pass of its `group`; if it has none, of its name; if it has no name, of "point_light_2", by its kind
    /// and its number among the scene's lights.
    ///
    /// A light pass holds all light of the picture that those lights emit: direct, in mirrors, through glass,
    /// indirect, and their visible surfaces. "ambient" is the rest: the scene's ambient light, background, the depth
    /// cue's colour. Light pass number i is stored in the image as pass GLINT_PASS_LIGHT + i. Beauty is the same with
    /// or without light passes, and all of them add up to it within a relative error of 2^-21. Borrowed by
    /// glint_plan_create; a plan's own description has them without "*".
    const char *light_passes;
} glint_render_desc;

/// Returns the defaults: 1280 x 720, 1 sample, double, passes = beauty, codes = false.
glint_render_desc glint_render_desc_default(void);

// ---- Plan ---------------------------------------------------------------------------------------------------------

/// The stages that one frame needs, with a snapshot of all data that they read. Immutable; any thread.
typedef struct glint_plan glint_plan;

/// Why a stage is in a plan. Both texts belong to the plan.
typedef struct glint_effect {
    const char *effect; ///< "hard shadow", "specular phong", ...
    const char *caller; ///< the object that needs it: "point_light 'lamp'"
} glint_effect;

/// A stage of a plan. The texts belong to the plan.
typedef struct glint_stage_info {
    const char *name; ///< "camera", "cast", "surface", "view", "light", "facet", "occlude", "vertex", ...
    char key[33]; ///< hex XXH3-128 of all data that the stage reads
    const char *why; ///< the reason for the stage, in one line for people
} glint_stage_info;

/// Numbers of rays by type.
typedef struct glint_ray_counts {
    uint64_t primary, shadow, mirror, refraction, indirect; ///< 0 if none is cast
} glint_ray_counts;

/// Takes a snapshot of the scene for one frame and lists the stages that it needs. The scene may be edited
/// afterwards. Fails if the scene has no camera, if a field of `desc` is out of range, or if a derivative depends on
/// something that has no derivative: the message then begins with "derivative 'NAME': ".
glint_status glint_plan_create(const glint_scene *scene, const glint_render_desc *desc, glint_plan **out,
                               glint_error *error);
/// Returns the description for each point in time of a frame with an open shutter: the passes that can be averaged,
/// no pixel values.
glint_render_desc glint_shutter_desc(const glint_render_desc *frame);
/// Plans a frame with an open shutter. `times` are `count` plans of the scene at different times,
/// 1 .. GLINT_SHUTTER_TIMES_MAX, made with glint_shutter_desc(desc). Light and alpha are the mean over the times.
/// Everything else comes from `scene` as it is now: the plan's effects and stages, and depth, normal, object_id,
/// albedo, outline and refined. If only lights differ, each such light is replaced by one light per time with its
/// share of the strength. A derivative of the frame is the mean of the derivatives of the same name at the times; a
/// time without it counts as 0. Takes ownership of the plans and of the list, which malloc allocated, even on
/// failure.
glint_status glint_plan_create_exposed(const glint_scene *scene, const glint_render_desc *desc, glint_plan **times,
                                       size_t count, glint_plan **out, glint_error *error);
/// Frees the plan; images rendered from it stay valid. NULL: nothing.
void glint_plan_destroy(glint_plan *plan);
/// Calls `warns` for each overlay that the plan's picture cannot show as described: text outside the picture, lines
/// wider than the picture, letters missing from the font, points behind the camera, an arrow of no length. The
/// message names the overlay. dpi: pixels per inch of the file; 0: not set.
glint_status glint_plan_check_overlays(const glint_plan *plan, double dpi, void (*warns)(void *context, const char *message),
                                       void *context, glint_error *error);
/// Returns the description of the frame as planned, including passes that other passes require. The plan owns the
/// description.
const glint_render_desc *glint_plan_render_desc(const glint_plan *plan);
/// Returns the name of light pass number `index`, from 0; owned by the plan. NULL: the plan has fewer passes.
const char *glint_plan_light_pass(const glint_plan *plan, size_t index);
/// Return the number of effects or stages, and their list; the lists belong to the plan.
size_t glint_plan_effects(const glint_plan *plan, const glint_effect **list);
size_t glint_plan_stages(const glint_plan *plan, const glint_stage_info **list);
/// Returns the expected numbers of rays. Primary rays are exact. Shadow rays are an upper bound, as if every sample
/// hit a surface facing every light that casts shadows; they exclude the shadow rays of mirrored, refracted and
/// indirect rays and of transparent objects. mirror, refraction and indirect are 0 or the first generation.
glint_ray_counts glint_plan_expected_rays(const glint_plan *plan);
/// Estimates the work of rendering `plan` right after `before`, from their keys. Each stage whose key differs counts
/// 1. The stages `light` and `occlude` count 1 for each light or light sample that differs; `shade` counts a half if
/// only highlights of materials differ. Bit i of *stages is set if stage number i of glint_plan_stages must run. 0:
/// the two pictures are identical.
double glint_plan_work_after(const glint_plan *plan, const glint_plan *before, uint32_t *stages);

/// A program that a frame runs for a material or for the background.
typedef struct glint_program_use {
    const char *material; ///< the material's name; may be empty; NULL: the scene's background
    const char *field; ///< "diffuse"; "model" for a shader; "background"
    const glint_program *program; ///< owned by the plan
} glint_program_use;

/// Describes number `index` of the plan's programs, from 0; pointers belong to the plan. Returns false and writes
/// nothing if there are fewer.
bool glint_plan_program(const glint_plan *plan, size_t index, glint_program_use *out);

// ---- Render -------------------------------------------------------------------------------------------------------

/// Worker threads, and the cache between frames.
typedef struct glint_renderer glint_renderer;
/// A rendered picture: the planes of its passes, and its pixel values. Immutable, reference counted; any thread.
typedef struct glint_image glint_image;

/// The fields of a renderer.
typedef struct glint_renderer_desc {
    int threads; ///< 1 .. 1024 worker threads; 0 (default): one per processor available to the process
    /// "ref", "generic" (also "sse2"), "avx2", "avx512"; NULL: the variable GLINT_ISA, else the best
    const char *isa;
    bool time_stages; ///< measure the time of each stage on each tile (costs a few per cent)
    bool count_work; ///< count the work for the statistics (costs some per cent)
    bool no_reuse; ///< cache nothing between frames; the pictures are the same
    size_t reuse_memory; ///< bytes that may be cached between frames; 0 (default): a quarter of the machine's memory
} glint_renderer_desc;

/// Returns the defaults: one thread per processor, the best instruction set, reuse within a quarter of the memory.
glint_renderer_desc glint_renderer_desc_default(void);
/// Starts the threads. GLINT_ERR_UNSUPPORTED if the machine lacks the instruction set, GLINT_ERR_INVALID if there is
/// none of that name.
glint_status glint_renderer_create(const glint_renderer_desc *desc, glint_renderer **out, glint_error *error);
/// Ends the threads and frees the cache; no frame may be running. NULL: nothing.
void glint_renderer_destroy(glint_renderer *renderer);
/// Returns the instruction set in use: "avx2". A static string.
const char *glint_renderer_isa(const glint_renderer *renderer);
/// Returns the number of workers, including the calling thread.
int glint_renderer_threads(const glint_renderer *renderer);
/// Cancels: the current glint_render, and all later ones of this renderer, return GLINT_ERR_CANCELLED, at the latest
/// after the current tile. Async-signal-safe.
void glint_renderer_cancel(glint_renderer *renderer);
/// Returns the finished share of the current frame, 0 .. 1. Any thread.
double glint_renderer_progress(const glint_renderer *renderer);

#define GLINT_STAGE_MAX 24

/// Work counters of a frame. Unlike times, they are free of noise.
typedef struct glint_work {
    uint64_t tests; ///< ray-primitive tests: pairs that the BVH and the filters could not rule out
    uint64_t light_samples; ///< evaluated pairs of a point and a light, or of a point and a sample of an area light
    uint64_t powers; ///< highlights computed (powers of a cosine)
    uint64_t sites; ///< sides of faces and vertices whose light was computed, for flat and gouraud shading
    uint64_t lights_seen; ///< rays that end on a visible light
    uint64_t patterns; ///< points at which a material's programs were run
    uint64_t environment; ///< rays that left the scene, so that the background's program was run for them
    uint64_t overlaps; ///< tests of how much of a light a sphere or plane covers from a point, for caps
} glint_work;

/// Kinds of pattern results that are not valid for any field: NaN and numbers below 0 become 0, numbers above 2^100
/// become 2^100.
typedef enum glint_odd_kind { GLINT_ODD_NAN, GLINT_ODD_NEGATIVE, GLINT_ODD_HUGE, GLINT_ODD_COUNT } glint_odd_kind;

/// How often a frame's patterns gave one kind of invalid result, and one place where they did.
typedef struct glint_odd {
    uint64_t count; ///< number of points with such a result; for the background, number of directions
    /// Field of one such result: static string, "diffuse"; "background" of the scene; NULL: there is none
    const char *field;
    char material[GLINT_NAME_SIZE]; ///< name of the material; may be empty
    double point[3]; ///< position in the world; for the background, the direction
} glint_odd;

/// The statistics of a frame.
typedef struct glint_frame_stats {
    double build_ms; ///< wall time of building the BVH; near 0 if it was cached
    double render_ms; ///< wall time of the stages before the film
    double tone_ms; ///< wall time of computing pixel values
    int stage_count; ///< the plan's stages, in its order
    const char *stage_name[GLINT_STAGE_MAX]; ///< static strings
    double stage_ms[GLINT_STAGE_MAX]; ///< summed over workers; 0 unless the renderer times stages
    /// Share of the stage's results taken from earlier frames: 0 all were computed, 1 none
    double stage_reused[GLINT_STAGE_MAX];
    glint_ray_counts rays; ///< rays cast; stages whose results are reused cast none
    glint_work work; ///< work counters; 0 unless the renderer counts work; reused results cost none
    uint64_t refined; ///< number of pixels that took all samples with `adaptive`; otherwise 0
    /// Pixels rendered; for a region, all pixels of the tiles that it touches. `clipped` and `nonfinite` count these
    uint64_t pixels;
    uint64_t clipped; ///< pixels with a channel above 1; 0 without pixel values
    uint64_t nonfinite; ///< pixels with a channel that is not finite; 0 without pixel values
    uint64_t shifted; ///< pixels within a soft shadow, or next to an edge of a shape or shadow that a derivative's
        ///< parameter moves. The derivative does not include the motion of the edge. 0 without derivatives
    glint_odd odd[GLINT_ODD_COUNT]; ///< invalid results of patterns
} glint_frame_stats;

/// Renders one frame. *out holds the passes and pixel values that the plan's description names. `stats` may be NULL.
glint_status glint_render(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats,
                          glint_error *error);

// ---- Images -------------------------------------------------------------------------------------------------------

/// Takes another reference; returns its argument. Any thread.
glint_image *glint_image_retain(glint_image *image);
/// Releases a reference; the last one frees the image. NULL: nothing. Any thread.
void glint_image_release(glint_image *image);
/// Size in pixels.
int glint_image_width(const glint_image *image);
int glint_image_height(const glint_image *image);
/// Returns whether the pass is stored; beauty may exist only as pixel values.
bool glint_image_has_pass(const glint_image *image, glint_pass pass);
/// Returns the name of derivative number `index`, from 0; owned by the image. NULL: the image has fewer derivatives.
const char *glint_image_derivative(const glint_image *image, size_t index);
/// Returns the name of light pass number `index`, from 0; owned by the image. NULL: the image has fewer passes.
const char *glint_image_light_pass(const glint_image *image, size_t index);
/// Returns whether all pixel values except alpha are 0; without pixel values, whether no value of beauty is above 0.
/// Stops at the first other value. False if the image has neither.
bool glint_image_is_black(const glint_image *image);
/// Returns the exposure, in stops, that the frame's pixel values have or would have.
double glint_image_exposure(const glint_image *image);

/// The brightness of several pictures together; starts as { 0 }.
typedef struct glint_brightness {
    double most; ///< largest finite value of a channel, before exposure; 0: none is above 0
    uint64_t pictures; ///< number of images added
    uint64_t values; ///< number of channel values: three per pixel
    uint64_t clipped; ///< finite values that are above 1 after exposure
} glint_brightness;

/// Adds an image's linear beauty to *sum; counts clipping after `exposure` stops. GLINT_ERR_INVALID: the image has no
/// linear beauty.
glint_status glint_image_brightness(const glint_image *image, double exposure, glint_brightness *sum, glint_error *error);
/// Widens range[0] .. range[1] to the finite values of a pass: for depth, the nearest and farthest; for a derivative,
/// plus and minus the largest slope of a channel. Starts as +inf, -inf. GLINT_ERR_INVALID: the image lacks that pass,
/// or the pass is neither depth nor a derivative.
glint_status glint_image_range(const glint_image *image, glint_pass pass, double range[2], glint_error *error);
/// Returns the greatest exposure, in whole hundredths of a stop within GLINT_EXPOSURE_MAX, at which light of `most`
/// does not exceed 1; 0 if `most` is 0. The same on every machine.
double glint_exposure_for(double most);
/// Reads one pixel of a stored pass; (0, 0) is the top left. One-channel passes give the same number three times.
glint_status glint_image_pixel(const glint_image *image, glint_pass pass, int x, int y, float out[3],
                               glint_error *error);
/// Copies all pixels of a stored pass, row by row from the top, each with the channels of the pass, to `out`, which has
/// space for width x height x glint_pass_channels(pass) numbers.
glint_status glint_image_floats(const glint_image *image, glint_pass pass, float *out, glint_error *error);

// ---- Files --------------------------------------------------------------------------------------------------------

/// How PNG data are compressed: quickly, or into fewer bytes.
typedef enum glint_encode { GLINT_ENCODE_FAST, GLINT_ENCODE_SMALL } glint_encode;

/// Returns the name and version of the deflate library behind a setting in this build: "isal 2.30.0".
const char *glint_encoder_name(glint_encode encode);

/// A text chunk of a PNG. Both strings are borrowed.
typedef struct glint_text {
    const char *keyword; ///< PNG tEXt keyword: 1 .. 79 Latin-1 characters
    const char *value; ///< any length up to 64 KiB; bytes outside Latin-1 are written as '?'
} glint_text;

/// One pass as a file. Pointers are borrowed for the call.
typedef struct glint_write_desc {
    /// Ends in .png; in .svg or .pdf for a bitmap with overlays and text as vectors, on a page of 72 / dpi points per
    /// pixel; in .pfm or .npy for the linear float32 of one pass (.npy: NumPy, height x width or height x
    /// width x 3, top row first); or in .exr for all passes of the image, as channels of one file: R, G, B, A,
    /// depth.Z, normal.X ... diffuse.B
    const char *path;
    glint_pass pass; ///< a pass of the image; ignored by .exr, which has all
    /// .png; depth, normal, object_id and derivatives are scaled for viewing, see README. .exr: with 16 `bits`, light
    /// and normals are half floats; with 8, they are float. Everything else is always float. .svg: like .png; .pdf:
    /// 8-bit sRGB values only
    glint_tone_desc tone;
    glint_encode encode; ///< .png; default GLINT_ENCODE_FAST
    double dpi; ///< .png, .svg, .pdf: pixels per inch for printing, 0 .. 1e6; 0: not set
    /// .png of depth and derivatives: 1 + a glint_colormap, whose colours replace grey; 0: grey. For depth, the
    /// background stays black; for a derivative, the mean of its three components is shown
    int colormap;
    /// .png of depth and derivatives: the values at the ends of the grey scale or colour map, which is linear;
    /// finite. Equal (default): the picture's own range, see README
    double range[2];
    const glint_text *text; ///< .png and .exr
    size_t text_count; ///< 0: no texts
} glint_write_desc;

/// Returns "OpenEXR 3.1.5"; NULL: this build cannot write .exr.
const char *glint_exr_library(void);
/// Returns the version of cairo, "1.16.0"; NULL: this build cannot write .pdf.
const char *glint_cairo_version(void);
/// Returns the names and versions of the libraries in use; the last entry is NULL. Static strings.
const char *const *glint_libraries(void);

/// Writes one pass to a file that appears complete or not at all: a temporary name in the same folder, fsync, rename.
/// An existing file that is not a regular one (a pipe, /dev/full) is written in place. Missing folders are created.
/// GLINT_ERR_NO_SPACE for ENOSPC and EDQUOT, GLINT_ERR_IO otherwise; the message names the file.
glint_status glint_image_write(const glint_image *image, const glint_write_desc *desc, glint_error *error);

/// Returns the bytes that glint_image_write would write; the ending of `desc->path` gives the format. The caller
/// frees *data with free().
glint_status glint_image_to_bytes(const glint_image *image, const glint_write_desc *desc, uint8_t **data, size_t *size,
                                  glint_error *error);

/// Fills `out`, 4 x width x height bytes, with the 8-bit values of one pass as a .png would hold them: RGBA, top row
/// first, alpha 255 where the picture has none. Reads from `desc` the pass, the tone (8 bits), dpi and colormap.
glint_status glint_image_rgba(const glint_image *image, const glint_write_desc *desc, uint8_t *out, glint_error *error);

/// Writes the key of a finished frame: 32 hex digits, a hash of the engine version, all data that the plan reads, the
/// encoder version, and the fields tone, encode and pass of `desc`. Threads, instruction set, shard and path are not
/// included.
void glint_frame_key(const glint_plan *plan, const glint_write_desc *desc, char key[33]);
/// Writes the key of the whole frame that a region belongs to; without a region, the frame's own key.
void glint_whole_key(const glint_plan *plan, const glint_write_desc *desc, char key[33]);

/// Returns whether `path` is a complete PNG (every CRC right, IEND at the end) whose tEXt "glint:key" equals key.
bool glint_file_has_key(const char *path, const char *key);

/// Writes images on its own threads, in the order submitted, so that rendering, encoding and disk writes overlap. The
/// writer keeps the last picture in compressed form, about as large as its file, so that unchanged parts are not
/// compressed again.
typedef struct glint_writer glint_writer;

/// The result of one submitted file.
typedef struct glint_write_result {
    glint_status status; ///< GLINT_OK: the file is complete
    char message[512]; ///< "" on success; otherwise the file and the reason
    double encode_ms; ///< time from pixel values to bytes
    double write_ms; ///< time from bytes to a synced, renamed file
    double reused; ///< share of the compressed bytes that were taken from the previous file, band of rows by band of
        ///< rows, 0 .. 1
    void *user; ///< the pointer submitted with the image
} glint_write_result;

/// Makes a writer.
///
/// queue_depth  number of images that may wait, >= 1; a further submit blocks. Above 2, a renderer that is faster than
///              the encoder finds no finished pictures whose memory it could reuse.
/// threads      number of threads that encode one image together, 1 .. 1024; 0: one per processor; 1: only the
///              writer's own thread. The files do not depend on this number.
glint_status glint_writer_create(int queue_depth, int threads, glint_writer **out, glint_error *error);
/// Finishes the queue, then frees the writer. Results not collected are lost.
void glint_writer_destroy(glint_writer *writer);
/// Retains the image and copies `desc` with its strings. The result carries `user`.
glint_status glint_writer_submit(glint_writer *writer, glint_image *image, const glint_write_desc *desc, void *user,
                                 glint_error *error);
/// Takes the next result, in the order submitted; waits for it if `wait` is set. False: there is none.
bool glint_writer_collect(glint_writer *writer, bool wait, glint_write_result *result);
/// Drops queued files that are not started (their results have GLINT_ERR_CANCELLED); files already started are
/// finished.
void glint_writer_cancel(glint_writer *writer);

/// The difference of two pictures, over all pixels and channels.
typedef struct glint_compare_result {
    int width, height, channels; ///< size in pixels and channels of both pictures
    double mean_error, rms_error, peak_snr, max_error; ///< differences of values, which are in 0 .. 1 (PNG) or linear
        ///< (PFM); peak signal-to-noise ratio
    int max_x, max_y, max_channel; ///< position of max_error, from 0
    uint64_t failed, warned; ///< number of pixels whose difference exceeds `fail`; number of those that exceed `warn`
    uint64_t pixels; ///< width x height
} glint_compare_result;

/// Thresholds of differences.
typedef struct glint_compare_desc {
    double fail, warn; ///< default 1e-6, as in the program idiff
} glint_compare_desc;

/// Compares two .png or .pfm files. GLINT_ERR_INVALID if the sizes or channels differ (out->width is then -1),
/// GLINT_ERR_IO or GLINT_ERR_FORMAT if one cannot be read.
glint_status glint_compare_files(const char *a, const char *b, const glint_compare_desc *desc,
                                 glint_compare_result *out, glint_error *error);

// ---- How far a picture is from a reference ------------------------------------------------------------------------

/// A reference for measuring other pictures: the mean of pictures that should be identical. Immutable.
typedef struct glint_reference glint_reference;

/// The error of a picture relative to a reference.
typedef struct glint_picture_error {
    double rmse; ///< root of the mean squared difference of linear light, over pixels and channels
    double relmse; ///< mean of (x - r)^2 / (r^2 + 0.01)
    double max_code; ///< largest difference of pixel values, in steps of 8 bits; fractions at 16 bits
    double over1, over8; ///< share of the pixels with a channel that differs by more than 1 such step, and by more
        ///< than 8
    double flip; ///< mean LDR-FLIP, 0 .. 1 (Andersson et al. 2020), at 67 pixels per degree
} glint_picture_error;

/// Makes a reference.
///
/// images  `count` >= 1 images of the same size, each with the beauty pass; only read during the call.
/// tone    the conversion to the pixel values that are compared; its `bits` are ignored.
glint_status glint_reference_create(const glint_image *const *images, size_t count, const glint_tone_desc *tone,
                                    glint_reference **out, glint_error *error);
/// Frees the reference with its image. NULL: nothing.
void glint_reference_destroy(glint_reference *reference);
/// Returns the mean image, with the beauty pass; borrowed.
const glint_image *glint_reference_image(const glint_reference *reference);

/// Measures a picture that has the reference's size and the beauty pass.
///
/// file_bits  0: the linear light; 8 or 16: the light decoded from a file with such values, exposure and curve
///            undone. Light above white, which no file can hold, counts unchanged in both cases, so that the numbers
///            are comparable.
///
/// If a channel is not finite, neither are rmse and relmse.
glint_status glint_reference_measure(const glint_reference *reference, const glint_image *image, int file_bits,
                                     glint_picture_error *out, glint_error *error);

/// Makes a picture for viewing: `scale` times the difference of the 8-bit values in each channel, clamped to white.
glint_status glint_reference_difference(const glint_reference *reference, const glint_image *image, double scale,
                                        glint_image **out, glint_error *error);

// ---- The error of a picture from its own samples -------------------------------------------------------------------

/// Returns the seed of the frame's partner: an independent picture with four times the samples of the frame.
double glint_partner_seed(const glint_render_desc *desc);
/// Estimates the error of a picture of at least 2 samples a pixel: the root of the mean squared difference to the
/// picture of infinitely many samples, in linear light, over pixels and channels. Channels that are not finite do not
/// count. `partner` is rendered from the same scene with the frame's partner seed and four times the samples; with
/// fewer, the estimate is larger. Both images have the beauty pass.
///
/// With one sample the estimate sees no edges, because the only sample is in the middle of the pixel. It never sees
/// details that both pictures miss.
glint_status glint_estimate_error(const glint_image *image, const glint_image *partner, double *rmse, glint_error *error);
/// Returns the number of pixels that hold most of the squared difference of the two pictures, (sum d^2)^2 / sum d^4; 0
/// for pictures that glint_estimate_error refuses; infinite for equal pictures. With few pixels, fewer than 10 for example,
/// the estimate depends on chance: rare bright paths may be missing from it, or dominate it.
double glint_estimate_pixels(const glint_image *image, const glint_image *partner);

// ---- Other strengths and colours of lights ---------------------------------------------------------------------------

/// name of the light pass for the light in a file that none of its light passes contains
#define GLINT_LIGHT_OTHER "..."

/// Reads a scan-line .exr with light passes: channels R, G and B of the picture, light.NAME.R, .G and .B of each
/// pass, and A, if any. If the passes do not add up to the picture, beyond rounding, the rest becomes one more pass,
/// GLINT_LIGHT_OTHER. The image has no beauty plane, since the passes add up to it. GLINT_ERR_IO, GLINT_ERR_FORMAT
/// with the file's name; GLINT_ERR_UNSUPPORTED in a build without OpenEXR.
glint_status glint_lights_read(const char *path, glint_image **out, glint_error *error);
/// Makes a beauty picture in which light pass number i is multiplied by `factors[i]` in each channel; alpha is copied
/// if there is any. The sum is computed in double in the order of the passes and rounded to float32 once.
glint_status glint_image_relight(const glint_image *lights, const double (*factors)[3], glint_image **out, glint_error *error);

// ---- Finished files, sheets and films -------------------------------------------------------------------------------

/// A file being written, under a hidden name in the same folder. At any time the final name holds a complete file or
/// none.
typedef struct glint_draft glint_draft;

/// Opens a draft for `path`. Missing folders are created; a symbolic link is followed. An existing file that is not a
/// regular file (a pipe, a device) is written in place and never replaced.
///
/// Messages of create, append and finish read "<path>: <reason>"; GLINT_ERR_NO_SPACE for ENOSPC and EDQUOT,
/// GLINT_ERR_NOMEM, GLINT_ERR_IO for the rest. A draft belongs to one thread at a time.
glint_status glint_draft_create(const char *path, glint_draft **out, glint_error *error);
/// Returns the hidden name, for another program to write to; owned by the draft.
const char *glint_draft_name(const glint_draft *draft);
glint_status glint_draft_append(glint_draft *draft, const void *bytes, size_t size, glint_error *error);
/// Syncs the file and renames it to its final name, replacing an older file. Only glint_draft_destroy may follow.
glint_status glint_draft_finish(glint_draft *draft, glint_error *error);
/// Removes an unfinished draft. NULL does nothing.
void glint_draft_destroy(glint_draft *draft);

/// Removes from a folder the hidden files of drafts whose process was killed: drafts of this host at once, drafts of
/// other hosts one day after their last write. A process does this once in each folder where it opens a draft or
/// calls glint_file_has_key. Any thread.
void glint_drafts_collect(const char *path);
/// Removes the hidden files of this process's drafts, for a signal handler that ends the process next. It is
/// async-signal-safe; no draft can be finished afterwards.
void glint_drafts_abandon(void);

/// A finished .png or .pfm, read back. Immutable.
typedef struct glint_picture glint_picture;

/// Reads `path`; an incomplete file is GLINT_ERR_FORMAT. Without `pixels`, reads only the size and the texts: CRCs
/// are checked, but nothing is decompressed. Messages name the file.
glint_status glint_picture_read(const char *path, bool pixels, glint_picture **out, glint_error *error);
/// Reads a .png, with its pixels, from bytes in memory, which may be freed after the call.
glint_status glint_picture_from_bytes(const void *data, size_t size, glint_picture **out, glint_error *error);
/// Frees the picture with its texts. NULL: nothing.
void glint_picture_destroy(glint_picture *picture);
/// Size in pixels.
int glint_picture_width(const glint_picture *picture);
int glint_picture_height(const glint_picture *picture);
int glint_picture_bits(const glint_picture *picture); ///< bits per channel, 8 or 16; 32 for a .pfm
int glint_picture_channels(const glint_picture *picture); ///< number of channels, 1 .. 4; with 2 and 4, the last
    ///< channel is alpha
/// Returns whether pixel values are sRGB or linear, by the gAMA and sRGB chunks; a .pfm is linear.
glint_transfer glint_picture_transfer(const glint_picture *picture);
/// Returns the value of a PNG's tEXt, as UTF-8; owned by the picture. NULL: there is none.
const char *glint_picture_text(const glint_picture *picture, const char *keyword);
/// Writes row `y`, from 0 at the top, as 3 * width 8-bit sRGB values for viewing. Grey becomes RGB, 16-bit and linear
/// values are rounded, and transparent pixels are blended over a grey of `backdrop`, 0 .. 255. Needs the pixels.
void glint_picture_row(const glint_picture *picture, int y, int backdrop, uint8_t *rgb);
/// Writes row `y` as 3 * width numbers of linear light. sRGB values are decoded, linear values are divided by the
/// largest possible value, grey becomes RGB, alpha is dropped. Needs the pixels.
void glint_picture_light(const glint_picture *picture, int y, float *rgb);

/// A finished part of a picture.
typedef struct glint_picture_part {
    const glint_picture *picture; ///< a .png with three or four channels, read with its pixels
    int x, y; ///< position of its top left pixel in the whole picture
} glint_picture_part;

/// Joins parts to a picture of width x height pixels and writes it as glint_image_write would have written the whole.
/// `desc` gives path (.png), transfer and bits of the tone, encode and text; its pass is ignored. Parts may overlap
/// if their pixels are equal. GLINT_ERR_INVALID: the message names, by its number from 1, a part that lies outside,
/// that differs from the first in bits or channels, or that disagrees with an earlier part; or the first pixel that
/// no part covers.
glint_status glint_picture_join(const glint_picture_part *parts, size_t count, int width, int height, const glint_write_desc *desc,
                               glint_error *error);

/// One picture of a contact sheet. Strings are borrowed.
typedef struct glint_sheet_cell {
    const char *path; ///< path of a .png or .pfm; all cells have pictures of the same size
    const char *label; ///< UTF-8, parts separated by newlines, which share a line if they fit; NULL: none
} glint_sheet_cell;

/// A contact sheet. Pointers are borrowed for the call.
typedef struct glint_sheet_desc {
    const glint_sheet_cell *cells; ///< row by row
    size_t cell_count; ///< >= 1
    int columns; ///< >= 1
    const char *title; ///< title of the sheet; NULL: none
    const char *across, *down; ///< names of the columns and of the rows, at most 1000 bytes each; NULL: none
    /// Heads: a text above each column, next to each row, and above each block of `block_rows` rows; NULL: none. The
    /// text above a column has parts like a label
    const char *const *column_heads, *const *row_heads, *const *block_heads;
    int block_rows; ///< >= 1 with `block_heads`
    /// Number of the cell, from 1, that each row is compared with in an extra row below it; 0: no such rows
    size_t difference;
    double gain; ///< factor applied to the differences; > 0
    /// Size of labels, in points of dpi / 72 pixels, 0 .. 10000; 0: 13 pixels, or 26 below pictures at least 900 wide
    double size;
    double dpi; ///< pixels per inch for printing, 0 .. 1e6; 0: not set, and a point is a pixel
    bool transparent; ///< the paper is transparent; pictures are drawn as on white
    /// A colour bar for all pictures, to their right, or below them if horizontal; NULL: none. It uses the fields of
    /// its kind, with `length` in points (default: as long as the pictures together, at most 20 times `size`), and
    /// the sheet's text size and ink
    const glint_overlay_desc *colorbar;
} glint_sheet_desc;

/// Draws finished pictures in rows, with labels, as one 8-bit .png, .svg or .pdf: dark text on white. If a picture is
/// missing or differs in size from the first, the error names it and the file is unchanged. A row of differences holds
/// `gain` times |cell - chosen cell|, in 8-bit sRGB values.
glint_status glint_sheet_write(const glint_sheet_desc *desc, const char *path, glint_error *error);

/// An animated PNG being written.
typedef struct glint_apng glint_apng;

/// The fields of an animated PNG.
typedef struct glint_apng_desc {
    int width, height; ///< 1 .. GLINT_SIDE_MAX
    int bits; ///< 8 or 16
    bool alpha; ///< frames are RGBA
    glint_transfer transfer; ///< encoding of the pixel values of all frames
    uint32_t frame_count; ///< 1 .. 2^30
    /// Frames per second, 1/65535 .. 65535; a frame's duration is the ratio of two 16-bit numbers nearest to 1/fps
    double fps;
    uint32_t plays; ///< 0: for ever
    glint_encode encode; ///< how frames are compressed
} glint_apng_desc;

/// Opens a draft for `path` and writes the header.
glint_status glint_apng_create(const char *path, const glint_apng_desc *desc, glint_apng **out, glint_error *error);
/// Adds a frame: RGB or RGBA, of the size, bits and transfer described. Only the part that changed is stored.
glint_status glint_apng_add(glint_apng *apng, const glint_picture *picture, glint_error *error);
/// Gives the file its name, after frame_count frames were added.
glint_status glint_apng_finish(glint_apng *apng, glint_error *error);
/// Frees the writer; an unfinished file is removed. NULL does nothing.
void glint_apng_destroy(glint_apng *apng);

// ---- Rows of numbers in text -----------------------------------------------------------------------------------------

/// A table from words to numbers, for columns of words.
typedef struct glint_words glint_words;

/// Makes an empty table; the caller destroys it.
glint_status glint_words_create(glint_words **out, glint_error *error);
/// Adds a word, or changes the number of a word. GLINT_ERR_INVALID: the table already has 65536 words.
glint_status glint_words_add(glint_words *words, const char *word, size_t length, uint32_t number, glint_error *error);
/// Frees the table. NULL: nothing.
void glint_words_destroy(glint_words *words);

/// What a field must be.
typedef enum glint_column_kind {
    GLINT_COLUMN_NUMBER, ///< a finite decimal number such as -1.5, 3e-7 or Fortran's 1.5D+03
    GLINT_COLUMN_SIZE, ///< a number > 0
    GLINT_COLUMN_VALUE, ///< a finite number, in Fortran's form only with a point; or a missing value, NaN: nan, NA, n/a,
        ///< null, or an empty field
    GLINT_COLUMN_WORD ///< a word of `words`
} glint_column_kind;

/// A field that is read from each row.
typedef struct glint_column {
    size_t field; ///< position of the field in its row, from 0
    glint_column_kind kind; ///< what the field must be
    double *numbers; ///< memory for the values; a missing value is NaN. NULL: the field is only checked
    const glint_words *words; ///< GLINT_COLUMN_WORD: the table of its words
    int64_t *indices; ///< GLINT_COLUMN_WORD: memory for the words' numbers. NULL: the field is only checked
} glint_column;

/// How the rows of a text are read.
typedef struct glint_rows_desc {
    char separator; ///< 0: fields are separated by spaces and tabs; otherwise by this character, and may be "quoted"
    size_t field_count; ///< number of fields in each row; 0: any number
    bool skips; ///< lines that are empty or begin with # are not rows
    const glint_column *columns; ///< in the order of their fields
    size_t column_count; ///< number of columns
    int threads; ///< 1 .. 1024 threads that read parts of a long text; 0: one per processor
} glint_rows_desc;

/// Reads up to `most` rows of a text, one per line. It stops at the first line that does not have the expected fields,
/// at a line without a newline at its end, and after `most` rows. Numbers are the doubles nearest to their decimal
/// form, whatever the locale.
///
/// used   written: the bytes of the lines read; the next line begins there.
/// lines  written: the number of lines read, including skipped ones.
///
/// Returns the number of rows.
size_t glint_rows_read(const glint_rows_desc *desc, const char *text, size_t length, size_t most, size_t *used,
                       size_t *lines);

// ---- Numbers that are the same on every machine -------------------------------------------------------------------

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

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
