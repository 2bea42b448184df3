/// glint: a ray-tracing render engine. This header is the whole public C API.
///
/// The order of use: describe (materials, lights, shapes, a camera, a scene), plan (glint_plan_create takes a
/// snapshot of the scene and lists the stages that a frame needs), render (glint_render runs the plan), write.
///
/// Units     lengths are in world units, angles in radians (`_rad`), colours linear RGB with 1.0 = display white.
/// Vectors   `double v[3]` is x, y, z or red, green, blue. The world is right-handed.
/// Errors    every function that can fail returns a glint_status and fills `error`, which may be NULL. On failure, outputs
///           and objects are unchanged. The message starts with the argument's name: "shininess: number >= 0 expected, got
///           -1". NULL for a pointer that is not optional is GLINT_ERR_INVALID, too: "shape: pointer expected, got NULL".
///           Functions that return no status return 0, NULL, false or the identity transform instead, or do nothing.
/// Ownership `_create` returns a reference that the caller owns and must release with `_release`; `_retain` adds one.
///           `_release(NULL)` does nothing. Pointers in a description struct are borrowed for the call only.
/// Threads   described objects (material, light, camera, shape, overlay, scene) belong to one thread at a time. Plans and
///           finished images are immutable. A renderer renders one frame at a time.
#ifndef GLINT_H
#define GLINT_H

// clang-format off: it would separate comments from the lines that they explain

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

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
typedef struct glint_builder glint_builder; ///< a program under construction; used by one thread at a time
typedef struct glint_texture glint_texture; ///< immutable
typedef uint32_t glint_value; ///< a value in a builder: one double per point

#define GLINT_PROGRAM_LENGTH_MAX 4096 ///< instructions of a program
#define GLINT_PROGRAM_ROWS_MAX 256 ///< intermediate values that a program may need at the same time
#define GLINT_PROGRAM_OUTPUTS_MAX 8 ///< outputs of a program, per point
#define GLINT_PARAMETERS_MAX 32 ///< parameters that numbers of a program may depend on

/// A pattern gives a number or a colour at a point, a shader the light reflected from one light source.
typedef enum glint_program_kind { GLINT_PROGRAM_PATTERN, GLINT_PROGRAM_SHADER } glint_program_kind;

/// The inputs of a program at a point. Directions are unit vectors.
typedef enum glint_input {
    GLINT_INPUT_P_X, ///< the point in the shape's own space, before the transforms of the shape and its groups
    GLINT_INPUT_P_Y, ///< likewise
    GLINT_INPUT_P_Z, ///< likewise
    GLINT_INPUT_WORLD_X, ///< the point in world space
    GLINT_INPUT_WORLD_Y, ///< likewise
    GLINT_INPUT_WORLD_Z, ///< likewise
    GLINT_INPUT_N_X, ///< the geometric normal, facing the viewer
    GLINT_INPUT_N_Y, ///< likewise
    GLINT_INPUT_N_Z, ///< likewise
    GLINT_INPUT_V_X, ///< towards the eye
    GLINT_INPUT_V_Y, ///< likewise
    GLINT_INPUT_V_Z, ///< likewise
    /// The shape's own surface coordinates. Plane and disk: lengths along two tangents. Box: 0 .. 1 on each face.
    /// Sphere, cylinder and cone: 0 .. 1 around and along. Torus: 0 .. 1 around its axis and around its tube. Mesh:
    /// interpolated between the corners by barycentric coordinates
    GLINT_INPUT_UV_U,
    GLINT_INPUT_UV_V, ///< likewise
    GLINT_INPUT_FOOTPRINT, ///< width of a pixel at the point, in world units
    GLINT_INPUT_UV_FOOTPRINT, ///< width of a pixel at the point, in units of u and v
    GLINT_INPUT_L_X, ///< towards the light; this and all later inputs are for shaders only
    GLINT_INPUT_L_Y, ///< likewise
    GLINT_INPUT_L_Z, ///< likewise
    GLINT_INPUT_LIGHT_R, ///< colour times intensity times attenuation
    GLINT_INPUT_LIGHT_G, ///< likewise
    GLINT_INPUT_LIGHT_B, ///< likewise
    GLINT_INPUT_DISTANCE, ///< distance to the light, in world units; infinite for a directional light
    GLINT_INPUT_KD_R, ///< the material's diffuse reflectance at the point
    GLINT_INPUT_KD_G, ///< likewise
    GLINT_INPUT_KD_B, ///< likewise
    GLINT_INPUT_KS_R, ///< its specular reflectance
    GLINT_INPUT_KS_G, ///< likewise
    GLINT_INPUT_KS_B, ///< likewise
    GLINT_INPUT_SHININESS, ///< its exponent
    GLINT_INPUT_COUNT ///< how many there are
} glint_input;

/// Operations. `true` is 1 and `false` is 0; as a condition, every number except 0 is true. min and max are a < b ? a
/// : b and a > b ? a : b. Operations under "exact" are IEEE 754 operations, rounded once. The others are composed of
/// these in the order written here, unless stated otherwise.
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
    GLINT_OP_STEP, ///< x < e ? 0 : 1; operands e, x
    GLINT_OP_SMOOTHSTEP, ///< t t (3 - 2 t), t = min(max((x - a) / (b - a), 0), 1); operands a, b, x
    GLINT_OP_CLAMP, ///< min(max(x, a), b); operands x, a, b
    // elementary functions, implemented here; special values as in C99, annex F
    GLINT_OP_SIN, ///< of radians; error at most 4e-16, for any angle
    GLINT_OP_COS, ///< likewise
    GLINT_OP_EXP2, ///< 2^a; relative error 2.5e-16
    GLINT_OP_LOG2, ///< relative error 4e-16; absolute error 4e-16 where the result is below 1
    GLINT_OP_POW, ///< a^b; relative error 1e-12
    GLINT_OP_ATAN2, ///< operands y, x; -pi .. pi; error 6e-16
    GLINT_OP_ACOS, ///< 0 .. pi; NaN outside -1 .. 1; error 6e-16
    GLINT_OP_HIGHLIGHT, ///< x^s for a cosine x and an exponent s, by the built-in models' kernel in float: seven
        ///< digits, 0 below 2^-40. x is clamped to at most 1, s to at least 0
    // patterns
    GLINT_OP_NOISE, ///< operands x, y, z: smooth gradient noise, -1 .. 1, 0 at whole numbers. Gradients and fade of
        ///< K. Perlin, "Improving Noise", SIGGRAPH 2002; the hash is our own. Repeats after 2^32
    GLINT_OP_NOISE3, ///< three independent noises: 3 results
    GLINT_OP_CELL, ///< operands x, y, z: distances to the nearest and the second-nearest feature point. Each unit
        ///< cube has one such point (S. Worley, "A Cellular Texture Basis Function", SIGGRAPH 1996): 2 results
    GLINT_OP_HASH, ///< operands x, y, z: a number in [0, 1), independent of the numbers at other x, y, z
    GLINT_OP_PARITY, ///< operands x, y, z: (floor(x) + floor(y) + floor(z)) % 2, for numbers of any size: a
        ///< checkerboard
    // made by the builder and by differentiation, and textures: not for glint_builder_op
    GLINT_OP_MULMUL, ///< (a b) c
    GLINT_OP_DOT, ///< (a b + c d) + e f
    GLINT_OP_NOISE_SLOPE, ///< operands x, y, z, k: derivatives of NOISE (k = 0) or of result k of NOISE3 (1 .. 3): 3
        ///< results
    GLINT_OP_CELL_SLOPE, ///< derivatives of CELL's first and second results: 6 results
    GLINT_OP_TEXEL, ///< glint_builder_texel: 4 results
    GLINT_OP_TEXEL_SLOPE, ///< derivatives of TEXEL's results with respect to u, and to v: 8 results
    GLINT_OP_COUNT
} glint_op;

#define GLINT_OPERANDS_MAX 6 ///< operands of an operation, at most
#define GLINT_RESULTS_MAX 8 ///< results of an operation, at most

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
/// Makes a number that depends on parameters: slopes[k] is its derivative with respect to parameter k, 0 <= k <
/// `count`. Programs use the number itself; glint_program_tangent uses the slopes. GLINT_ERR_INVALID for more than
/// GLINT_PARAMETERS_MAX slopes.
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
/// footprint  width over which the picture is averaged, in units of u and v; 0 or less: no averaging.
///
/// The program retains the texture.
glint_status glint_builder_texel(glint_builder *builder, const glint_texture *texture, glint_value u, glint_value v,
                                 glint_value footprint, glint_value out[4], glint_error *error);
/// Returns whether a value is a number, and writes the number unless `number` is NULL. False if it is not a value of
/// the builder.
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
/// Evaluates the program at one point with the kernel that a frame uses. The results are a frame's values before they
/// are rounded to float.
///
/// inputs   those that the program does not read may be anything.
/// outputs  written: as many as the program has.
///
/// The variable GLINT_ISA may cause an error: GLINT_ERR_UNSUPPORTED for an instruction set that this machine lacks,
/// GLINT_ERR_INVALID for an unknown one.
glint_status glint_program_evaluate(const glint_program *program, const double inputs[GLINT_INPUT_COUNT],
                                    double *outputs, glint_error *error);
glint_program_kind glint_program_kind_of(const glint_program *program);
size_t glint_program_output_count(const glint_program *program);
size_t glint_program_length(const glint_program *program); ///< instructions; 0 if all outputs are inputs or numbers
size_t glint_program_rows(const glint_program *program); ///< intermediate values that are live at the same time
bool glint_program_reads(const glint_program *program, glint_input input);
/// Returns a hash of the operations, their operands and the textures, excluding numbers: programs that differ only in
/// numbers have the same hash.
void glint_program_structure(const glint_program *program, uint64_t key[2]);
/// Returns true and fills `outputs` if all outputs are numbers, the same at every point.
bool glint_program_constant(const glint_program *program, double *outputs);
/// Returns a program that computes the derivatives of the outputs with respect to a parameter, for glint_slope. They
/// are exact, except that floor and similar steps, comparisons and a texel's footprint count as constant. Owned by
/// `program`. NULL: none of its numbers depends on the parameter.
const glint_program *glint_program_tangent(const glint_program *program, size_t parameter);
/// Returns the instructions as text, one per line, "r3 = muladd p.x 0.5 r1", followed by the outputs. Numbers read
/// back as the same bits. The caller frees the text. NULL: out of memory.
char *glint_program_listing(const glint_program *program);

/// How a texture continues where u or v is outside 0 .. 1.
typedef enum glint_wrap {
    GLINT_WRAP_REPEAT, ///< the picture repeats
    GLINT_WRAP_CLAMP, ///< the border texels continue
    GLINT_WRAP_AROUND ///< repeats in u, continues the border in v: for a picture around a ball, or of all directions
} glint_wrap;
/// How the colour between texels is computed.
typedef enum glint_filter {
    GLINT_FILTER_BILINEAR, ///< interpolates four texels of a mipmap level, which is the picture halved as often as
        ///< the footprint requires
    GLINT_FILTER_NEAREST ///< takes the texel at u, v of the full-size picture
} glint_filter;

/// The fields of a texture.
typedef struct glint_texture_desc {
    const char *path; ///< a .png, or .jpg where the build has libjpeg; NULL: `rgb`
    const uint8_t *rgb; ///< red, green and blue of each pixel, 8 bits each, top row first; borrowed for the call
    int width, height; ///< of `rgb`, pixels, >= 1
    glint_wrap wrap; ///< default repeat
    glint_filter filter; ///< default bilinear
    bool linear; ///< true: pixel values are linear. false, the default: they are sRGB and are decoded, unless the
        ///< file declares itself linear (gAMA 1.0)
} glint_texture_desc;

/// Returns the defaults: no path, repeat, bilinear, sRGB.
glint_texture_desc glint_texture_desc_default(void);
/// Reads a picture. GLINT_ERR_IO, GLINT_ERR_FORMAT if it cannot be read or is not a complete PNG; GLINT_ERR_NOMEM.
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
    GLINT_TYPE_PROGRAM, ///< a program only
    GLINT_TYPE_TABLE, ///< several fields of the same description, listed in `parts`, that are given together
    GLINT_TYPE_CUSTOM, ///< defined by the caller; no engine table uses it
    GLINT_TYPE_OTHER ///< likewise
} glint_field_type;

#define GLINT_TAKES_PATTERN 1u ///< bits of glint_object_field.takes: a program evaluated at each point
#define GLINT_TAKES_TEXTURE 2u ///< a picture
#define GLINT_TAKES_SHADER 4u ///< a program evaluated for each light
#define GLINT_TAKES_VARIABLE 8u ///< a number with a slope; frames compute derivatives with respect to it

/// One field of an object: the row that defines its default, its check and its documentation.
typedef struct glint_object_field {
    const char *name; ///< in scripts and messages
    const char *member; ///< in the description; NULL: the field has no member of its own
    glint_field_type type; ///< of the value in the description
    size_t offset; ///< in the description
    size_t set_offset; ///< of a bool that says whether the field is set; 0: the field always counts as set
    size_t program_offset; ///< of the glint_program * that replaces the value unless it is NULL; 0: there is none
    unsigned takes; ///< what may replace a number: bits GLINT_TAKES_...
    bool required; ///< an object cannot be made without it
    const char *const *names; ///< GLINT_TYPE_CHOICE: names of the values, from 0, ending with NULL;
        ///< GLINT_TYPE_OBJECT: the kind
    const struct glint_object_field *parts; ///< GLINT_TYPE_TABLE: ends with a row without a name
    double low, high; ///< smallest and largest number allowed, for each component; angles in radians
    const char *expected; ///< the allowed values, in words, for messages: "number >= 0"
    double initial[3]; ///< the default, or the number of the default choice; components not given are 0
    const char *follows; ///< the field that supplies the value until this one is set; NULL: none
    const char *unit; ///< "world units"; NULL: none
    const char *doc; ///< meaning, in one line
    const void *custom; ///< GLINT_TYPE_CUSTOM: for the caller's use
} glint_object_field;

/// Kinds of objects that have a table of fields.
typedef enum glint_object_kind {
    GLINT_OBJECT_NONE, ///< no object, no fields
    GLINT_OBJECT_MATERIAL, ///< fields of glint_material_desc
    GLINT_OBJECT_POINT_LIGHT, ///< the fields of glint_light_desc that this kind reads; the kind is
        ///< GLINT_OBJECT_POINT_LIGHT + a glint_light_kind
    GLINT_OBJECT_DIRECTIONAL_LIGHT, ///< likewise
    GLINT_OBJECT_SPOT_LIGHT, ///< likewise
    GLINT_OBJECT_DISK_LIGHT, ///< likewise
    GLINT_OBJECT_POLYGON_LIGHT, ///< likewise
    GLINT_OBJECT_SPHERE_LIGHT, ///< likewise
    GLINT_OBJECT_SCENE, ///< of glint_scene_desc
    GLINT_OBJECT_KINDS ///< how many there are
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

/// The meaning of an opacity between 0 and 1. In every mode a surface of opacity 0 is invisible, and one of opacity 1 opaque.
typedef enum glint_opacity_mode {
    GLINT_OPACITY_AUTO, ///< a number blends, a pattern cuts
    GLINT_OPACITY_CUT, ///< where the opacity is below 0.5 or NaN, the surface is absent for all rays of a frame;
        ///< elsewhere it is opaque. Objects behind a hole look as they do without the surface
    /// The light that the surface gives, including mirrored, refracted and indirect light, is multiplied by the
    /// opacity o. Eye, mirror, glass and indirect rays also continue straight on with weight 1 - o, and shadow rays
    /// pass with weight 1 - o. Each surface counts: a ray through a closed ball crosses two surfaces and keeps (1 -
    /// o)^2.
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
    glint_program *shader; ///< replaces `model`: computes the diffuse term of each light, and also the specular term
        ///< if it has six outputs
} glint_material_programs;

/// The fields of a material. Reflectances are fractions of light, in linear RGB.
typedef struct glint_material_desc {
    glint_model model; ///< default phong
    bool has_ambient; ///< false: `ambient` follows `diffuse`
    double ambient[3]; ///< reflectance: finite, >= 0; above 1 the surface gives off more light than it receives
    double diffuse[3]; ///< default 0.8
    bool has_specular; ///< read by cook_torrance only; false: `specular` is 1
    double specular[3]; ///< default 0
    double shininess; ///< exponent, finite, >= 0; default 32. 0 gives S = 1 wherever r.v > 0
    bool has_mirror; ///< false: `mirror` is 1 with `fresnel` and 0 without
    double mirror[3]; ///< fraction of the light along the mirrored ray that is added; >= 0, default 0
    /// Fraction of the light along the refracted ray that is added; >= 0, default 0. It also tints the object's
    /// shadow, once for each surface that the light crosses. A totally reflected ray crosses no surface and keeps
    /// max(mirror, 1) of its light
    double transmission[3];
    double ior; ///< refractive index inside, > 0; default 1.5. Outside it is 1, or the index of the enclosing object
    bool fresnel; ///< multiplies `mirror` by a dielectric's Fresnel reflectance R, `transmission` by 1 - R; default
        ///< false
    double absorption[3]; ///< absorption coefficient inside, per world unit, >= 0; default 0: light is multiplied by
        ///< exp(-absorption distance)
    /// Energy-conserving normalisation. phong: S = (s + 2)/2 (r.v)^s (n.l) (E. Lafortune and Y. Willems 1994);
    /// blinn_phong: S = (s + 2)(s + 4)/(8 (2^(-s/2) + s)) (n.h)^s (n.l) (F. Giesen, "Phong and Blinn-Phong
    /// normalization factors", 2009). Both are reciprocal. Other models ignore it
    bool normalized;
    bool matched; ///< blinn_phong: the exponent is 4 s, which gives the highlight closest to Phong's. Other models
        ///< ignore it
    // cook_torrance:
    double roughness; ///< 0 .. 1, default 0.3; below 1e-9 it counts as 1e-9: a highlight narrower than any pixel
    glint_distribution distribution; ///< default GGX
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

#define GLINT_CORNERS_MAX 4096 ///< corners of a polygon light

/// How a light's shadows are computed.
typedef enum glint_shadow {
    GLINT_SHADOW_RAYS, ///< one ray to each sample of the light
    GLINT_SHADOW_HARD, ///< area lights: one ray to the centre of the light, for all of its samples
    GLINT_SHADOW_CAPS ///< sphere lights: the share of the light's apparent disk that spheres cover, in closed form
} glint_shadow;

/// The fields of a light. Each kind reads the fields whose comment names it, and those whose comment names no kind.
typedef struct glint_light_desc {
    glint_light_kind kind; ///< glint_light_set cannot change it
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
    double exponent; ///< spot: falloff cos^exponent of the angle to the axis; >= 0, default 0
    double normal[3]; ///< disk: points to the side that shines; not zero, need not be unit; default {0, -1, 0}
    double radius; ///< disk and sphere: >= 0, 0 is a point; with `radiance` 0 or 1e-150 .. 1e150; default 1
    /// Polygon: its corners, convex and in one plane, 3 .. GLINT_CORNERS_MAX; copied. It shines on the side from
    /// which they run counter-clockwise
    const double (*vertices)[3];
    size_t vertex_count;
    bool two_sided; ///< polygon: shines on both sides; default false
    double samples; ///< area lights: shadow rays for each sample of a pixel; whole number, 1 .. 65536; default 16
    bool has_radiance; ///< area lights: `radiance` gives the strength; `intensity` must then be 1
    char group[GLINT_NAME_SIZE]; ///< name of the light pass that collects this group's lights; "": the light's own
        ///< name
    /// >= 0: the light adds kd times the integral of radiance cos cos' / distance^2 over its surface. With
    /// `intensity` it adds the mean over its surface of point lights
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
    double at[3], direction[3]; ///< finite; `at` differs from `eye`, `direction` is not zero; defaults: the origin,
        ///< {0, 0, -1}
    double up[3]; ///< default {0,1,0}; not zero. If parallel to the view, the world axis least aligned with the view
        ///< replaces it
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
    double pixel_offset; ///< position of a single sample in a pixel, 0 .. 1; default 0.5, its centre
    /// Time that the shutter is open, as a fraction of the time between frames, 0 .. 1; default 0, an instant. Used
    /// by callers that plan a frame for several times, see glint_plan_create_exposed
    double shutter;
    double shutter_times; ///< number of times at which the scene is planned while the shutter is open, 1 ..
        ///< GLINT_SHUTTER_TIMES_MAX; default 8
    /// Radius of the lens, world units, >= 0; default 0: a pinhole, which shows everything sharp. Each sample starts
    /// at a point of the lens, in the plane through the eye perpendicular to the view, and passes through the point
    /// where the pinhole's ray crosses the plane of focus. A point at depth d is blurred over a disk of diameter 2
    /// aperture |1 - d / focus| at that depth. An orthographic camera has a lens for each ray. Many samples make the
    /// blur smooth.
    double aperture;
    double focus; ///< distance of the plane of focus along the view, > 0; default 0: given by `focus_point`, or else
        ///< by `at`
    bool has_focus_point; ///< true: the plane of focus goes through `focus_point`, and `focus` is 0
    double focus_point[3]; ///< finite, in front of the eye
    double blades; ///< 0: a round lens, the default; 3 .. 64, whole: a regular polygon inscribed in that circle, a
        ///< corner up
    double blade_rotation_rad; ///< turns the polygon, counter-clockwise as seen by the eye; default 0
    char name[GLINT_NAME_SIZE]; ///< for messages; "": none
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

/// A surface, or a group of them. Shared by reference between groups and scenes.
typedef struct glint_shape glint_shape;

/// The kind of a shape, which determines the fields of its description that are used.
typedef enum glint_shape_kind {
    GLINT_SHAPE_SPHERE, ///< `center`, `radius`
    GLINT_SHAPE_PLANE, ///< `point`, `normal`; without end
    GLINT_SHAPE_SPHERES, ///< made by glint_spheres_create
    GLINT_SHAPE_MESH, ///< made by the functions of meshes
    GLINT_SHAPE_BOX, ///< `min`, `max`
    GLINT_SHAPE_DISK, ///< `center`, `normal`, `radius`
    GLINT_SHAPE_CYLINDER, ///< `base`, `top`, `radius`
    GLINT_SHAPE_CONE, ///< `base`, `top`, the apex, `radius` at the base
    GLINT_SHAPE_TORUS, ///< `center`, `axis`, `major`, `minor`
    GLINT_SHAPE_GROUP, ///< of shapes; see glint_group_add
    GLINT_SHAPE_UNION, ///< one solid of several, its parts: what is in any of them; see glint_group_add
    GLINT_SHAPE_INTERSECTION, ///< what is in all of them
    GLINT_SHAPE_DIFFERENCE ///< what is in the first and in none of the others
} glint_shape_kind;

/// An affine map: out_i = m[i][0] x + m[i][1] y + m[i][2] z + m[i][3].
typedef struct glint_transform {
    double m[3][4]; ///< the last column moves, world units
} glint_transform;

/// The map that leaves everything in place.
glint_transform glint_transform_identity(void);
/// First `inner`, then `outer`.
glint_transform glint_transform_product(const glint_transform *outer, const glint_transform *inner);
/// Moves by `by`, world units.
glint_transform glint_transform_translate(const double by[3]);
/// Multiplies x, y and z by the three factors; negative ones mirror. 0 makes a map that shapes refuse.
glint_transform glint_transform_scale(const double by[3]);
/// Counter-clockwise as seen with the axis pointing at the eye. The axis is not zero and need not be unit; quarter turns
/// are exact.
glint_transform glint_transform_rotate(const double axis[3], double degrees);

/// The points where the light on a mesh is computed, and their normals. With the last two, the light on a face is the same from
/// every direction: a mirror shows the highlights that the eye sees from its own place.
typedef enum glint_shading {
    GLINT_SHADING_FACETED, ///< for each sample, with the normal of its face
    /// For each sample, with a normal interpolated between the corners in the mesh's own space: a
    /// transform moves normals like faces. Hits and shadows are decided only by the faces:
    /// a face that looks away from a light is dark to its edge, however its normals lean; see glint_mesh_bend
    GLINT_SHADING_PHONG,
    GLINT_SHADING_FLAT, ///< once a face, at its centroid, with its normal
    GLINT_SHADING_GOURAUD ///< once a vertex; between them by barycentric coordinates, over triangles
} glint_shading;

/// The fields of a shape; each kind reads those that name it, and those that name none. Lengths in world units.
typedef struct glint_shape_desc {
    glint_shape_kind kind; ///< of glint_shape_create: not spheres and mesh
    glint_material *material; ///< retained by the shape; NULL: a material with default fields. A group has none. NULL, of a
        ///< part of a combined solid: that of the solid; of that: of its first part that has one
    glint_transform transform; ///< of the shape as described here; default identity; must be possible to undo
    bool two_sided; ///< default true: the normal turns to the viewer; false: the back gets ambient light only
    double center[3], radius; ///< sphere, disk (and cylinder, cone: radius; torus: center): finite, radius > 0; see glint_scene_cast
    double point[3], normal[3]; ///< plane (and disk: normal): finite, normal not zero, need not be unit
    double min[3], max[3]; ///< box: finite, min < max; default -1, 1
    double base[3], top[3]; ///< cylinder, cone: the middles of its ends; the cone's top is its apex; not the same place
    bool capped; ///< cylinder: closed at both ends, cone: at its base; default true. False: its side alone, seen from
        ///< within too; it has no inside, so that what it transmits is bent as by a solid that never ends
    double axis[3]; ///< torus: not zero, need not be unit; default {0, 1, 0}
    double major, minor; ///< torus: radii of the circle in the middle of its tube and of the tube, 0 < minor < major: the tube
        ///< does not meet itself; default 1, 0.25
    glint_shading shading; ///< mesh
    char name[GLINT_NAME_SIZE];
} glint_shape_desc;

/// Every field of a shape of this kind at its default.
glint_shape_desc glint_shape_desc_default(glint_shape_kind kind);
/// Makes a shape of a copy of `desc`, and retains its material. GLINT_ERR_INVALID names the field; GLINT_ERR_NOMEM.
glint_status glint_shape_create(const glint_shape_desc *desc, glint_shape **out, glint_error *error);
/// Replaces the description by a copy, of the same kind; on error nothing changes.
glint_status glint_shape_set(glint_shape *shape, const glint_shape_desc *desc, glint_error *error);
/// The description; of a GLINT_SHAPE_SPHERES shape only kind, transform, two_sided, name and material (its first) mean
/// anything, of a mesh these and `shading`, of a group kind, transform and name, of a combined solid these, two_sided and
/// material. Setting `material` replaces the first.
const glint_shape_desc *glint_shape_get(const glint_shape *shape);
/// Takes another reference; returns its argument.
glint_shape *glint_shape_retain(glint_shape *shape);
/// Gives a reference back; the last one frees the shape and releases what it retains. NULL: nothing.
void glint_shape_release(glint_shape *shape);

/// The materials of a shape, one for most; returns how many. The list belongs to the shape.
size_t glint_shape_materials(const glint_shape *shape, glint_material *const **list);

/// A box around all spheres or vertices of a GLINT_SHAPE_SPHERES or GLINT_SHAPE_MESH shape, before its transform. False,
/// with the box untouched: the shape is of another kind, and its description says where it is.
bool glint_shape_bounds(const glint_shape *shape, double lower[3], double upper[3]);

#define GLINT_GROUP_DEPTH 64 ///< groups and combined solids one within the other

// Combined solids. Parts are spheres, boxes, capped cylinders and cones, tori, planes (half-spaces: the side away from the normal is inside), closed
// meshes, other combined solids, and groups, which stand for the union of what is in them; at most 64 in all, a torus counts twice, a mesh four
// times. A mesh is closed where along every edge as many triangles run one way as the other, corners at one place being one; its shading is
// faceted or phong. A place is inside of it where every way from there goes out through its faces more often than in; where its volume is
// below 0 its faces are taken the other way round. The whole is one object; a part shows
// nowhere but where it bounds the whole, with its own material, in its own space. Light that goes in through any part is in one medium: `ior` and
// `absorption` are those of the whole's material. `two_sided` of parts means nothing. Faces that coincide leave nothing between them: a box
// less one that ends at the same face is open there; where several parts bound the whole at one place, the first defined shows.

/// The group or combined solid retains the shape, which may be in other groups and scenes as well: it shows in each, under the transforms of
/// all that it is in, and what is changed in it changes everywhere. Refused: a group within itself, the same shape twice; what has
/// no inside in a combined solid: the message names an edge at which a mesh is open.
glint_status glint_group_add(glint_shape *group, glint_shape *child, glint_error *error);
/// Takes the shape out of the group or combined solid and releases it. GLINT_ERR_INVALID when it is not there.
glint_status glint_group_remove(glint_shape *group, glint_shape *child, glint_error *error);
/// How many shapes the group or combined solid holds itself, those within its groups not counted.
size_t glint_group_count(const glint_shape *group);
glint_shape *glint_group_child(const glint_shape *group, size_t index); ///< borrowed

/// Many spheres in one shape, from one array.
typedef struct glint_spheres_desc {
    const void *data; ///< count times x, y, z, radius; any alignment; copied
    size_t count; ///< 1 .. 2^30
    bool is_float; ///< true: `data` is binary32, false: binary64; native byte order
    glint_material *const *materials; ///< retained; NULL entries are not allowed
    size_t material_count; ///< 0: one material with default fields
    const uint32_t *material_index; ///< count numbers < material_count, copied; NULL: all are 0
    bool two_sided; ///< default true: the normal turns to the viewer
    char name[GLINT_NAME_SIZE]; ///< for messages; "": none
} glint_spheres_desc;

/// A message names the sphere at fault, counted from 1: "data: sphere 12: radius > 0 expected, got -1".
glint_status glint_spheres_create(const glint_spheres_desc *desc, glint_shape **out, glint_error *error);
size_t glint_spheres_count(const glint_shape *shape); ///< of a mesh its triangles; 1 for other shapes

/// Polygons that share vertices. A face of more than three corners is cut into triangles: a fan from its first corner,
/// or, where that would leave the polygon, ear by ear. Corners that run counter-clockwise are seen from the front.
typedef struct glint_mesh_desc {
    const double *vertices; ///< x, y, z each; finite; copied, like everything here
    size_t vertex_count; ///< 3 .. 2^31 - 2
    const uint32_t *corners; ///< numbers of vertices, from 0, face after face
    const uint32_t *face_sizes; ///< corners of each face, 3 or more
    size_t face_count; ///< 1 .. 2^31 - 2; so is the number of triangles
    const double *normals; ///< x, y, z each; finite, not zero, need not be unit; NULL: none
    size_t normal_count; ///< 0 without `normals`
    /// A number of a normal, from 0, for each entry of `corners`; GLINT_NO_NORMAL: none there. NULL: normals belong to
    /// vertices, one each
    const uint32_t *normal_corners;
    const double *uv; ///< coordinates on a picture, u and v each; finite; NULL: none
    size_t uv_count; ///< 0 without `uv`
    /// A number of such a pair, from 0, for each entry of `corners`; GLINT_NO_UV: none there, and no program reads the
    /// coordinates of this mesh. NULL: they belong to vertices, a pair each
    const uint32_t *uv_corners;
    bool has_shading; ///< false: phong where there are normals, faceted where there are none
    /// Phong and gouraud without normals: those of the faces around a vertex are averaged by area
    glint_shading shading;
    glint_material *material; ///< retained; NULL: one with default fields, or `materials`, or those of the file
    glint_material *const *materials; ///< where faces have their own: retained, in place of `material`; no NULL entries
    size_t material_count; ///< 0: all faces have `material`
    const uint32_t *material_index; ///< face_count numbers < material_count, copied; NULL: all are 0
    glint_transform transform; ///< default identity
    bool two_sided;
    char name[GLINT_NAME_SIZE];
    void (*reads)(void *context, const char *path); ///< glint_mesh_load: a file is about to be opened; NULL: nothing
    /// glint_mesh_load: something that the file has or names is ignored; the message names the file; NULL: nothing
    void (*warns)(void *context, const char *message);
    void *context; ///< of both
} glint_mesh_desc;

#define GLINT_NO_NORMAL 0xffffffffu
#define GLINT_NO_UV 0xffffffffu

/// No faces, two-sided, where it is described.
glint_mesh_desc glint_mesh_desc_default(void);
/// A message names the face and the vertex at fault, counted from 1: "faces[3]: vertex 1 .. 8 expected, got 9",
/// "faces[3]: a face with an area expected: its vertices 1, 2, 3 are on one line". A triangle of no area within a larger
/// face is left out.
glint_status glint_mesh_create(const glint_mesh_desc *desc, glint_shape **out, glint_error *error);
/// Reads a mesh; `desc` gives the fields that are not in the file. GLINT_ERR_IO when it cannot be read, GLINT_ERR_FORMAT
/// when it is not as it should be: "FILE:LINE: ...", or the number of the vertex or face. By the ending of the name:
///
/// .stl  text or binary; corners at one place are one vertex. Normals are those of the faces, whatever the file says.
/// .ply  text or binary, of either byte order: vertices (x y z, nx ny nz, u v or s t), faces (texcoord) and tristrips. Where `desc` has no
///       material: a comment TextureFile names the picture of the diffuse colour; else red, green and blue (8-bit or 16-bit codes, or
///       floats 0 .. 1 or 0 .. 255; sRGB) give each face a material of its colour,
///       named by it ("#ff8000"): its own, or the mean of its corners' light, rounded to 8 bits.
/// else  Wavefront .obj: v (x y z, and r g b as in .ply), vt, vn and f (any polygon; numbers from the end where negative), and, where `desc`
///       has no material, usemtl and mtllib: Kd, Ks, Ns, d (or Tr), Pr and Pm (microfacets), illum 3 .. 7 (mirror of Ks; 5, 7 fresnel; 6, 7 Ni),
///       map_Kd, map_Ks, map_d (holes where red is below one half), map_Bump (grey, -bm is its height). d < 1 is not refracted otherwise, and
///       leaves d of Kd and Ks. Groups, lines and points are ignored.
/// Faces without an area, of fewer than 3 corners or of vertices that are not finite are left out, polygons that cross themselves are cut as
/// fans, normals of length 0 are none, wrong lines of .mtl files and unknown statements are ignored: one call of `warns` a kind.
glint_status glint_mesh_load(const char *path, const glint_mesh_desc *desc, glint_shape **out, glint_error *error);
/// A sphere of `segments` (whole number, 3 .. 16384) around the equator and half as many, rounded up, from pole to pole,
/// with the sphere's own normals at the vertices. `desc` gives shading (default phong), material, sides and name.
glint_status glint_sphere_mesh_create(const double center[3], double radius, double segments,
                                      const glint_mesh_desc *desc, glint_shape **out, glint_error *error);

/// How far smooth shading bends a mesh: the largest angle between a face and the normals of its corners, degrees, 0 .. 90, in the
/// mesh's own space; 0 for other shapes and shading. Faces that a light grazes by less throw a shadow on themselves
/// where their shading is lit: more segments, or lights with `shadows` false, are the cure. The first call looks at all
/// triangles; not to be called for one mesh by two threads at once.
double glint_mesh_bend(const glint_shape *shape);

/// The arguments of glint_sphere_mesh_create; false, and nothing written, when the shape was not made by it.
bool glint_sphere_mesh_get(const glint_shape *shape, double center[3], double *radius, double *segments);

// ---- Overlays -----------------------------------------------------------------------------------------------------

/// A label, a colour bar or axes: drawn over a finished picture, on its codes. Shared by reference between scenes.
///
/// Overlays are in .png files of beauty alone: other passes, planes and linear files are without. They lie over each other in
/// the order in which they were added. No stage reads them: another text makes no ray run again. Lengths in points are
/// dpi / 72 pixels where the file says its dpi, else a pixel.
///
/// Letters are those of a font, by FreeType: the file that the environment's GLINT_FONT names, or DejaVu Sans where systems have it.
/// Their pixels depend on that font and on FreeType's version, and so does the frame's key; those of pictures without text never
/// do. Without FreeType or a font, or where GLINT_FONT is "bitmap", they are of a bitmap font of 8 by 13 pixels and its multiples,
/// the same everywhere.
typedef struct glint_overlay glint_overlay;

/// What an overlay is; it says which fields of its description mean anything.
typedef enum glint_overlay_kind {
    GLINT_OVERLAY_LABEL, ///< `text`
    GLINT_OVERLAY_COLORBAR, ///< the colours of a map with numbers beside them; `text` is its title
    GLINT_OVERLAY_AXES ///< directions x, y and z of the world as the camera has them, each with its name; or, with a `box`, three
                       ///< edges of it where the camera has them, with numbers along them
} glint_overlay_kind;

/// A table of 256 colours, from the lowest number to the highest.
typedef enum glint_colormap {
    GLINT_COLORMAP_VIRIDIS, ///< these two N. Smith and S. van der Walt, 2015
    GLINT_COLORMAP_MAGMA, ///< likewise
    GLINT_COLORMAP_CIVIDIS, ///< J. R. Nunez, C. R. Anderton and R. S. Renslow, 2018
    GLINT_COLORMAP_TURBO, ///< A. Mikhailov, 2019
    GLINT_COLORMAP_COOLWARM, ///< K. Moreland, 2009
    GLINT_COLORMAP_COUNT ///< how many there are
} glint_colormap;

/// "viridis", ...; NULL when out of range.
const char *glint_colormap_name(glint_colormap map);
/// The 256 colours of a map as sRGB codes 0xRRGGBB; static. NULL when out of range.
const uint32_t *glint_colormap_table(glint_colormap map);

/// Which way a colour bar runs: from bottom to top, or from left to right.
typedef enum glint_orientation { GLINT_VERTICAL, GLINT_HORIZONTAL } glint_orientation;

#define GLINT_OVERLAY_TEXT_SIZE 384 ///< bytes of an overlay's text, with the ending NUL
#define GLINT_OVERLAY_TICKS_MAX 16 ///< numbers beside a colour bar
#define GLINT_AXIS_NAME_SIZE 16 ///< bytes of an axis's name, with the ending NUL

/// The fields of an overlay; each kind reads those that name it, and those that name none.
typedef struct glint_overlay_desc {
    glint_overlay_kind kind; ///< not changed by glint_overlay_set
    /// Label, colour bar: UTF-8, lines divided by newlines; "": none. Lines of a label without a position that are wider than
    /// the picture are broken at blanks
    char text[GLINT_OVERLAY_TEXT_SIZE];
    /// Where it is: shares of the room that it leaves within the margin, 0 left or top, 1 right or bottom. Default label
    /// {0, 0}, colour bar {1, 0.5}, axes {0, 1}
    double at[2];
    bool has_position; ///< true: in place of `at`, `position`
    double position[2]; ///< its upper left corner, in pixels from that of the picture; finite, may lie outside
    bool has_size; ///< false: a 36th of the picture's height in pixels, and no less than 10
    double size; ///< of its letters, points, 1 .. 10000
    bool has_margin; ///< false: half of `size`
    double margin; ///< to the picture's border, points, 0 .. 10000
    double color[3]; ///< of letters and lines, linear RGB, finite, >= 0; above 1 as 1; default 1. Not toned
    bool has_background; ///< false: nothing behind it
    double background[3]; ///< a rectangle behind it; linear RGB as `color`
    double opacity; ///< of the background, 0 .. 1; default 1
    bool has_length; ///< false: colour bar 10 times `size`, axes 2.5 times
    double length; ///< colour bar, axes: of the bar, of an axis that lies in the picture; points, 1 .. 10000
    glint_colormap map; ///< colour bar
    bool has_colors; ///< true: colour bar of `colors` in place of `map`
    uint32_t colors[256]; ///< from low to high, sRGB codes 0xRRGGBB
    double low, high; ///< colour bar: the numbers at its ends; finite, not the same; default 0, 1
    bool is_log; ///< colour bar: equal factors are equally long; low and high are above 0
    glint_orientation orientation; ///< colour bar; default vertical
    double ticks[GLINT_OVERLAY_TICKS_MAX]; ///< colour bar: numbers written beside it, from low to high
    size_t tick_count; ///< 0: round numbers, about five
    char names[3][GLINT_AXIS_NAME_SIZE]; ///< axes: of x, y and z
    /// Axes: true: at edges of `box`, those that bound what the camera sees of it, in place of `at`; the upright one at the left,
    /// the others below. A direction that the eye looks along has no such edge, and no axis; seen from within the box none has.
    /// Then has_position, has_margin, has_length and has_background must be false
    bool has_box;
    double box[2][3]; ///< its lowest and highest corner in the world; finite; a side may be 0, which has no axis, not all three
    /// With has_box: the box is a cell from box[0], whose sides `sides` lie anyhow; box[1] is not read
    bool has_sides;
    double sides[3][3]; ///< finite; one may be 0, which has no axis, the others span a plane
    bool has_values; ///< false: the numbers are places in the world, of a cell lengths along its sides
    double values[2][3]; ///< what the two corners stand for; finite, not the same where the box has a side; may fall
    char name[GLINT_NAME_SIZE]; ///< for messages; "": none
} glint_overlay_desc;

/// Every field of an overlay of this kind at its default.
glint_overlay_desc glint_overlay_desc_default(glint_overlay_kind kind);
/// Makes an overlay of a copy of `desc`. Texts are drawn from left to right: letters that run from right to left are an error.
/// GLINT_ERR_INVALID names the field that is out of range; GLINT_ERR_NOMEM.
glint_status glint_overlay_create(const glint_overlay_desc *desc, glint_overlay **out, glint_error *error);
/// Replaces the description by a copy, of the same kind; on error nothing changes.
glint_status glint_overlay_set(glint_overlay *overlay, const glint_overlay_desc *desc, glint_error *error);
/// The description; borrowed, valid until the overlay is set or released.
const glint_overlay_desc *glint_overlay_get(const glint_overlay *overlay);
/// Takes another reference; returns its argument.
glint_overlay *glint_overlay_retain(glint_overlay *overlay);
/// Gives a reference back; the last one frees the overlay. NULL: nothing.
void glint_overlay_release(glint_overlay *overlay);

// ---- Scene --------------------------------------------------------------------------------------------------------

/// Shapes and lights under one camera.
typedef struct glint_scene glint_scene;

/// What a scene is beside its shapes and lights. Light in linear RGB, lengths in world units.
typedef struct glint_scene_desc {
    glint_camera *camera; ///< retained; may be NULL until a frame is planned
    double ambient[3]; ///< finite, >= 0; default 0
    double background[3]; ///< finite, >= 0; default 0
    /// Retained: a pattern of the direction that a ray leaves in, in place of `background`, seen by the eye, in mirrors,
    /// through glass and by indirect light; NULL: none. It reads as p and world the unit direction d, as n and v -d, as
    /// footprint the angle of a pixel in radians (0 with parallel rays), and as uv where d is in a picture of all
    /// directions: u = 1/2 + atan2(x, -z) / 2 pi, so that the middle column is -z, the first and last are +z, and +x is
    /// three quarters from the left; v = acos(-y) / pi, from straight down to straight up. A pattern of numbers alone is
    /// a `background` of these; of others NaN and less than 0 are 0
    glint_program *background_program;
    /// Light fades with the distance d of the first surface from the eye (that of the pass depth) towards a colour:
    /// f = min(max((d - near) / (far - near), 0), 1) of the colour and 1 - f of the light. The colour's share is in the term
    /// of the background; the background itself, and what mirrors show, do not fade
    bool has_depth_cue;
    bool has_depth_cue_color; ///< false: `background`, which then must not be a pattern
    double depth_cue_color[3]; ///< finite, >= 0
    double depth_cue_near, depth_cue_far; ///< finite, 0 <= near < far; default 0, 1
    bool has_indirect; ///< false: `ambient` stands for all light that surfaces get from each other and the background
    /// Paths of light that are followed from each point seen, over cosine-weighted directions: the diffuse term gets kd times
    /// the mean of what they find. Whole number, 1 .. 65536.
    double indirect_samples;
    /// Matt surfaces on such a path that light is followed beyond; whole number, 0 .. 2^31. At the one after the last
    /// `ambient` stands for the rest: with 0 it does so at once. What a material's `ambient` has beyond its `diffuse` is
    /// light of its own, and stays everywhere.
    double indirect_bounces;
    /// Ambient light, as far as `ambient` of a material is no more than its `diffuse`, is multiplied by the share of the sky
    /// over the point, weighed by the cosine, that is open. It is then in the pass `indirect`; the rest of it, light of the
    /// material's own, stays in `ambient`. Not together with `has_indirect`, which finds where that light comes from
    bool has_ambient_occlusion;
    double ambient_occlusion_samples; ///< rays from each point seen; whole number, 1 .. 65536
    /// World units, > 0, may be infinite: surfaces farther away close nothing. What transmits closes as much as it takes of
    /// the light, and leads rays on refracted; from there the distance counts anew
    double ambient_occlusion_distance;
} glint_scene_desc;

/// Makes an empty scene without a camera. GLINT_ERR_NOMEM.
glint_status glint_scene_create(glint_scene **out, glint_error *error);
/// Replaces the description by a copy, and retains its camera; on error nothing changes.
glint_status glint_scene_set(glint_scene *scene, const glint_scene_desc *desc, glint_error *error);
/// The description; borrowed, valid until the scene is set or released.
const glint_scene_desc *glint_scene_get(const glint_scene *scene);
/// Takes another reference; returns its argument.
glint_scene *glint_scene_retain(glint_scene *scene);
/// Gives a reference back; the last one frees the scene and releases what it retains. NULL: nothing.
void glint_scene_release(glint_scene *scene);
/// Objects are numbered in the order they were added. The scene retains them; adding one twice is an error, and so
/// is removing one that is not there. One object may be in several scenes.
glint_status glint_scene_add_shape(glint_scene *scene, glint_shape *shape, glint_error *error);
glint_status glint_scene_add_light(glint_scene *scene, glint_light *light, glint_error *error);
glint_status glint_scene_remove_shape(glint_scene *scene, glint_shape *shape, glint_error *error);
glint_status glint_scene_remove_light(glint_scene *scene, glint_light *light, glint_error *error);
glint_status glint_scene_add_overlay(glint_scene *scene, glint_overlay *overlay, glint_error *error);
glint_status glint_scene_remove_overlay(glint_scene *scene, glint_overlay *overlay, glint_error *error);
/// How many shapes, lights and overlays were added; a group counts as one.
size_t glint_scene_shape_count(const glint_scene *scene);
size_t glint_scene_light_count(const glint_scene *scene);
size_t glint_scene_overlay_count(const glint_scene *scene);

/// One of them, `index` < the count, in the order they were added; borrowed from the scene.
glint_shape *glint_scene_shape_at(const glint_scene *scene, size_t index);
glint_light *glint_scene_light_at(const glint_scene *scene, size_t index);
glint_overlay *glint_scene_overlay_at(const glint_scene *scene, size_t index);
/// Writes the name of the light pass that light number `index`, < the count, belongs to: see glint_render_desc.
void glint_scene_light_pass(const glint_scene *scene, size_t index, char name[GLINT_NAME_SIZE]);

/// What a ray meets first; lengths in units of its direction or of the world.
typedef struct glint_hit {
    double t; ///< point = origin + t direction; t > 0
    double point[3]; ///< world units, double
    double normal[3]; ///< unit, geometric, outward (a plane's own normal; a triangle's faces where its corners run
        ///< counter-clockwise)
    glint_shape *shape; ///< borrowed from the scene
    size_t element; ///< which sphere of a GLINT_SHAPE_SPHERES shape, which triangle of a mesh, which part of a combined solid
        ///< (those of parts that have parts are counted one by one), from 0
} glint_hit;

/// Finds the nearest hit of one ray with t > 0, by the kernels a frame uses. `direction` need not be unit; not zero. Spheres and
/// round solids below 1e-150 in the world, or of their distance from `origin`, are refused; so are they in a frame, by the eye.
/// *hit tells whether there is one; *out is written only then.
glint_status glint_scene_cast(const glint_scene *scene, const double origin[3], const double direction[3], bool *hit,
                              glint_hit *out, glint_error *error);

// ---- A frame --------------------------------------------------------------------------------------------------------

/// The arithmetic that decides hits, their order and shadows: binary64, or binary32 to show the cost of that.
typedef enum glint_precision { GLINT_DOUBLE, GLINT_FLOAT } glint_precision;

/// How it is found what the eye sees. The pictures are the same in every bit, but where a ray runs in the very plane of a
/// triangle, whose edges then are nothing but rounding: a pixel in some thousand pictures taken from such planes.
typedef enum glint_visibility {
    GLINT_VISIBILITY_AUTO, ///< the one that is likely to be faster
    GLINT_VISIBILITY_CAST, ///< a ray through each sample
    GLINT_VISIBILITY_SCAN ///< triangles are projected; other shapes are cast
} glint_visibility;

/// The values of a picture's pixels, as linear float32. Light is the mean over the samples.
typedef enum glint_pass {
    GLINT_PASS_BEAUTY, ///< (((((background + ambient) + diffuse) + specular) + indirect) + mirror) + transmission, in float32
    GLINT_PASS_BACKGROUND, ///< light of pixels that hit nothing, and the depth cue
    GLINT_PASS_AMBIENT, ///< ambient terms
    GLINT_PASS_DIFFUSE, ///< diffuse terms of all lights
    GLINT_PASS_SPECULAR, ///< specular terms of all lights
    GLINT_PASS_INDIRECT, ///< diffuse light from other surfaces
    GLINT_PASS_MIRROR, ///< mirror times what mirrored rays bring
    GLINT_PASS_TRANSMISSION, ///< transmission times what refracted rays bring
    GLINT_PASS_DEPTH, ///< one channel: distance from the eye, +inf where nothing is hit; at the pixel's centre
    GLINT_PASS_NORMAL, ///< shading normal turned to the eye, 0 where nothing is hit; at the pixel's centre
    GLINT_PASS_OBJECT_ID, ///< one channel: 1.. in order of definition, 0 where nothing is hit; at the pixel's centre
    GLINT_PASS_ALPHA, ///< one channel, 0 .. 1: the share of the samples that hit something. A sample that reaches the background
        ///< through glass or translucent surfaces, without a reflection, counts 1 less the mean of its three channels' weight
    GLINT_PASS_OUTLINE, ///< one channel: 1 where objects end, hide each other or have an edge, else 0; at the pixel's centre
    GLINT_PASS_REFINED, ///< one channel: 1 where `adaptive` took all samples, else 0; 1 everywhere without it
    GLINT_PASS_ALBEDO, ///< diffuse reflectance, 0 where nothing is hit; at the pixel's centre
    GLINT_PASS_COUNT, ///< how many there are
    /// The first of the frame's derivatives, see glint_render_desc; the others follow it. Three channels
    GLINT_PASS_DERIVATIVE = GLINT_PASS_COUNT,
    /// The first of the frame's light passes, see glint_render_desc; the others follow it. Three channels
    GLINT_PASS_LIGHT = GLINT_PASS_DERIVATIVE + 8
} glint_pass;

/// "beauty", "background", ...; NULL when out of range.
const char *glint_pass_name(glint_pass pass);
/// GLINT_PASS_COUNT when there is no such pass.
glint_pass glint_pass_from_name(const char *name);
int glint_pass_channels(glint_pass pass); ///< 1 or 3

/// How light becomes codes.
typedef enum glint_transfer {
    GLINT_TRANSFER_SRGB, ///< IEC 61966-2-1:1999
    GLINT_TRANSFER_LINEAR, ///< codes are light, and the file says so (gAMA): viewers brighten them
    GLINT_TRANSFER_NONE ///< codes are light, and the file does not say so: viewers take them for sRGB
} glint_transfer;
/// How a code between two whole numbers is rounded.
typedef enum glint_rounding { GLINT_ROUND_NEAREST, GLINT_ROUND_TRUNCATE } glint_rounding;

/// The tone curve, applied to each channel on its own. x is the light after exposure, the result 0 .. 1.
typedef enum glint_tone_curve {
    GLINT_TONE_CLAMP, ///< min(x, 1)
    GLINT_TONE_REINHARD, ///< x / (1 + x): Reinhard, Stark, Shirley and Ferwerda 2002, equation 3. Nothing is cut off
    GLINT_TONE_FILMIC ///< h(2 x) / h(11.2), h Hable's curve of "Uncharted 2" (Filmic Games, 2010): white from 5.6 on
} glint_tone_curve;

#define GLINT_EXPOSURE_MAX 32 ///< stops, either way

/// How linear light becomes integer codes: exposure, curve, transfer, rounding. NaN and negative become 0, above the
/// range M.
typedef struct glint_tone_desc {
    glint_tone_curve curve; ///< default clamp
    glint_transfer transfer; ///< default sRGB, IEC 61966-2-1:1999
    glint_rounding rounding; ///< default nearest: floor(x M + 0.5); truncate: floor(x M)
    int bits; ///< 8 (default) or 16: M = 255 or 65535
    double exposure; ///< stops: light is first multiplied by 2^exposure, in float; default 0
} glint_tone_desc;

/// Clamp, sRGB, nearest, 8 bits, no exposure.
glint_tone_desc glint_tone_desc_default(void);
/// Writes the least float of light after exposure that has each code 1 .. 255 of 8 bits, by a valid tone: for programs that show the very
/// codes of a file.
void glint_tone_steps(const glint_tone_desc *tone, float least[255]);

/// Lines drawn into a PNG of beauty where the pass `outline` is 1.
typedef enum glint_outline_color { GLINT_OUTLINE_NONE, GLINT_OUTLINE_BLACK, GLINT_OUTLINE_WHITE } glint_outline_color;

#define GLINT_DERIVATIVES_MAX (GLINT_PASS_LIGHT - GLINT_PASS_DERIVATIVE) ///< of one frame
#define GLINT_DERIVATIVE_NAME_SIZE 32 ///< bytes of a derivative's name, with the ending NUL

/// How fast one field of the scene changes with a parameter. At most one of the four objects is not NULL; without any it is a
/// field of the scene's own description.
typedef struct glint_slope {
    const glint_material *material; ///< whose field it is; or NULL
    const glint_light *light; ///< likewise
    const glint_shape *shape; ///< likewise
    const glint_camera *camera; ///< likewise
    const char *field; ///< its name in the description, one of those under glint_derivative
    double slope[3]; ///< of each component; of a single number the first
    const glint_program *program; ///< of a material's field that a program gives: how fast that changes, for each point, as
        ///< glint_program_tangent has it; `slope` means nothing. Retained by the plan. NULL: numbers
} glint_slope;

/// How fast the picture's light, linear beauty, changes with a parameter: exact where surfaces, shadows and the samples of area
/// lights are held constant, and a point of a surface moves with its viewer, seen by the eye, in mirrors and through glass. Rays too
/// weak to be seen (2^-20 of linear light, a sample) are not followed. Slopes of objects outside the scene are ignored.
///
///   material  diffuse, ambient, specular, shininess, roughness, f0; mirror and transmission where they are above 0, ior, absorption;
///             of those that programs give, of built-in models
///   light     color, intensity, ambient, diffuse, specular, attenuation, position, direction, inner_rad, outer_rad,
///             exponent, radiance
///   scene     ambient, background, depth_cue_color, depth_cue_near, depth_cue_far
///   shape     spheres: center, radius; planes: point, normal
///   camera    eye, at, direction, up, fov_y_rad, height; of a lens aperture, focus, focus_point
typedef struct glint_derivative {
    const char *name; ///< 1 .. 31 bytes; "lamp_x"
    const glint_slope *slopes; ///< slopes of the same field add up
    size_t slope_count; ///< 0: nothing depends on it, which a plan refuses; a slope of 0 marks a field that depends on it with slope 0 here
} glint_derivative;

/// One frame: its size, samples and passes.
typedef struct glint_render_desc {
    /// Whole numbers, 1 .. GLINT_SIDE_MAX; default 1280 x 720. Doubles: any script number is checked
    double width, height;
    double samples; ///< a pixel; whole number, 1 .. 65536; default 1
    /// 0 (default): every pixel gets all samples. Above, up to 3: first each gets one, in its middle. All are taken only
    /// where a pixel and one of its eight neighbours show two objects or normals 26 degrees apart, or codes that differ by
    /// more than this, red, green and blue together, in shares of white; that pixel is then as without `adaptive`, every
    /// other as with one sample. With one sample it does nothing
    double adaptive;
    glint_precision precision; ///< what decides hits and shadows; default GLINT_DOUBLE
    glint_visibility visibility; ///< default GLINT_VISIBILITY_AUTO
    double seed; ///< whole number, 0 .. 2^53; another seed, another (equally good) sample pattern; 0 = unshifted
    double max_depth; ///< longest chain of mirrors and refractions; whole number, 0 .. 2^31; default 5. At most 31
        ///< where the mirror + transmission of a material that has both is above 1: rays double at each surface. From
        ///< the 17th surface of a chain on one of two rays, drawn by lot, stands for both
    uint32_t passes; ///< bits 1u << GLINT_PASS_...; kept in the image as linear float planes. Beauty may be left out.
        ///< With `outline`, the passes that it needs (depth, normal and object_id) are kept, too
    bool codes; ///< make integer codes of the beauty pass while rendering, by `tone`
    /// Where nothing is hit nothing is shown: the background is black there and codes have alpha, so that a PNG of beauty
    /// is RGBA. Passes hold light times coverage; codes show only the light, beauty / alpha. The background is also left out
    /// behind glass and translucent surfaces: see GLINT_PASS_ALPHA. Mirrored and totally reflected rays show the scene's
    /// background. If beauty is kept, so is GLINT_PASS_ALPHA
    bool alpha;
    glint_outline_color outline; ///< only in files: planes and codes do not have it; the pass is kept. Default none
    glint_tone_desc tone;
    /// x, y, width and height, in pixels, of the part of the frame that is rendered, with the bits that the whole has there;
    /// the image has the part's size. Whole numbers within the frame; all 0 (default): the whole
    double region[4];
    /// Number i is stored in the image as pass GLINT_PASS_DERIVATIVE + i. Borrowed by glint_plan_create; a plan's own
    /// description has only the count
    const glint_derivative *derivatives;
    size_t derivative_count; ///< 0 (default) .. GLINT_DERIVATIVES_MAX
    /// Light passes, divided by commas: names of groups of lights, "ambient" for the light that no lamp sends, "*" for all
    /// groups of the scene in the order of their first lights, then "ambient". NULL (default): none. A light belongs to the pass of
    /// its `group`, or else of its name, or else to "point_light_2", by its kind and its number among the scene's lights.
    ///
    /// A light pass holds all light of the picture that those lights send: direct, in mirrors, through glass, indirect, and
    /// their visible surfaces. "ambient" is the rest: the scene's ambient light, background, the depth cue's colour. Number i is
    /// kept in the image as pass GLINT_PASS_LIGHT + i. Beauty is the same with or without light passes, and all of them
    /// add up to it within 2^-21 of itself. Borrowed by glint_plan_create; a plan's own description has them without "*".
    const char *light_passes;
} glint_render_desc;

/// 1280 x 720, 1 sample, double, passes = beauty, codes = false.
glint_render_desc glint_render_desc_default(void);

// ---- Plan ---------------------------------------------------------------------------------------------------------

/// The stages that one frame needs, with a snapshot of all they read. Immutable; any thread.
typedef struct glint_plan glint_plan;

/// Why a stage is in a plan. Both texts belong to the plan.
typedef struct glint_effect {
    const char *effect; ///< "hard shadow", "specular phong", ...
    const char *caller; ///< which object called for it: "point_light 'lamp'"
} glint_effect;

/// A stage of a plan. The texts belong to the plan.
typedef struct glint_stage_info {
    const char *name; ///< "camera", "cast", "surface", "view", "light", "facet", "occlude", "vertex", ...
    char key[33]; ///< hex XXH3-128 of exactly what the stage reads
    const char *why; ///< one line for people
} glint_stage_info;

/// Numbers of rays by purpose.
typedef struct glint_ray_counts {
    uint64_t primary, shadow, mirror, refraction, indirect; ///< 0 where none is cast
} glint_ray_counts;

/// Takes a snapshot of the scene for one frame and lists what the frame needs. The scene may be edited at once.
/// Fails when the scene has no camera, a field of `desc` is out of range, or a derivative goes through what has none: the
/// message then begins with "derivative 'NAME': ".
glint_status glint_plan_create(const glint_scene *scene, const glint_render_desc *desc, glint_plan **out,
                               glint_error *error);
/// Returns the description for each time of a frame with an open shutter: the passes that have a mean, and no codes.
glint_render_desc glint_shutter_desc(const glint_render_desc *frame);
/// Plans a frame that is seen while a shutter is open: light and alpha are the mean of `times`, `count` plans of the scene
/// as it was then, by glint_shutter_desc(desc); 1 .. GLINT_SHUTTER_TIMES_MAX. All else is of `scene` as it is now: what the
/// plan says, and depth, normal, object_id, albedo, outline and refined. If only lights differ, each such light becomes one light for each
/// time, with its share of the strength. A derivative of the frame is the mean of those by its name that the times' own descriptions
/// have; of a time without it, on which nothing depends then, 0.
/// Takes over the plans and the list, which is from malloc, also when it fails.
glint_status glint_plan_create_exposed(const glint_scene *scene, const glint_render_desc *desc, glint_plan **times,
                                       size_t count, glint_plan **out, glint_error *error);
/// Frees the plan; images rendered from it stay. NULL: nothing.
void glint_plan_destroy(glint_plan *plan);
/// Calls `warns` for each overlay that a picture of the plan cannot show as it is: text outside of it, lines wider than it,
/// letters that the font lacks. The message names the overlay. dpi: of the file, 0: not said.
glint_status glint_plan_check_overlays(const glint_plan *plan, double dpi, void (*warns)(void *context, const char *message),
                                       void *context, glint_error *error);
/// The frame as planned: passes that others are made of are added. Belongs to the plan.
const glint_render_desc *glint_plan_render_desc(const glint_plan *plan);
/// The name of the frame's light pass number `index`, from 0; the plan's. NULL: it has not so many.
const char *glint_plan_light_pass(const glint_plan *plan, size_t index);
/// The lists belong to the plan.
size_t glint_plan_effects(const glint_plan *plan, const glint_effect **list);
size_t glint_plan_stages(const glint_plan *plan, const glint_stage_info **list);
/// Primary rays exactly; shadow rays at most (every sample hits and faces every light that casts shadows), without those
/// that mirrored, refracted and indirect rays and transparent objects call for; mirror, refraction and indirect: 0 or the
/// first generation.
glint_ray_counts glint_plan_expected_rays(const glint_plan *plan);
/// Estimates the work of rendering `plan` right after `before`, by their keys: a stage whose key differs counts 1, the stages
/// `light` and `occlude` count 1 for each light or light sample that differs, `shade` counts a half where only highlights of
/// materials differ. Bit i of *stages is set where number i of
/// glint_plan_stages must run. 0: the two pictures are the same.
double glint_plan_work_after(const glint_plan *plan, const glint_plan *before, uint32_t *stages);

/// A program that a frame runs for a material, or for the background.
typedef struct glint_program_use {
    const char *material; ///< its name; may be empty; NULL: the scene's own
    const char *field; ///< "diffuse"; "model" of a shader; "background"
    const glint_program *program; ///< the plan's
} glint_program_use;

/// Describes number `index` of the plan's programs, from 0; pointers belong to the plan. Returns false, and writes nothing, if there are not so
/// many.
bool glint_plan_program(const glint_plan *plan, size_t index, glint_program_use *out);

// ---- Render -------------------------------------------------------------------------------------------------------

/// Worker threads, and the cache between frames.
typedef struct glint_renderer glint_renderer;
/// A rendered picture: planes of its passes, and codes. Immutable, reference counted; any thread.
typedef struct glint_image glint_image;

/// The fields of a renderer.
typedef struct glint_renderer_desc {
    int threads; ///< 1 .. 1024 workers; 0 (default): one per processor the process may use
    const char *isa; ///< "ref", "generic" (also "sse2"), "avx2", "avx512"; NULL: the environment's GLINT_ISA, else the best
    bool time_stages; ///< measure each stage on each tile (costs a few per cent)
    bool count_work; ///< fill in the work of the stats (costs some per cent)
    bool no_reuse; ///< keep nothing from frame to frame; the pictures are the same
    size_t reuse_memory; ///< bytes that may be kept between frames; 0 (default): a quarter of the machine's memory
} glint_renderer_desc;

/// A thread a processor, the best instruction set, reuse within a quarter of the memory.
glint_renderer_desc glint_renderer_desc_default(void);
/// GLINT_ERR_UNSUPPORTED when the machine lacks that instruction set, GLINT_ERR_INVALID when there is none
/// of that name.
glint_status glint_renderer_create(const glint_renderer_desc *desc, glint_renderer **out, glint_error *error);
/// Ends the threads and frees the cache; no frame may be running. NULL: nothing.
void glint_renderer_destroy(glint_renderer *renderer);
/// The instruction set in use: "avx2". A static string.
const char *glint_renderer_isa(const glint_renderer *renderer);
/// How many workers there are, the calling thread included.
int glint_renderer_threads(const glint_renderer *renderer);
/// Makes the running or next glint_render return GLINT_ERR_CANCELLED within a tile. Async-signal-safe; sticks.
void glint_renderer_cancel(glint_renderer *renderer);
/// Share of the running frame that is done, 0 .. 1. Any thread.
double glint_renderer_progress(const glint_renderer *renderer);

#define GLINT_STAGE_MAX 24

/// Work that a frame took: free of noise, unlike time.
typedef struct glint_work {
    uint64_t tests; ///< pairs of a ray and a primitive that were decided: what index and filters could not rule out
    uint64_t light_samples; ///< pairs of a point and a light, or a sample of an area light, evaluated
    uint64_t powers; ///< highlights raised to their exponent
    uint64_t sites; ///< sides of faces and vertices whose light was computed once, for flat and gouraud shading
    uint64_t lights_seen; ///< rays that end on a visible light
    uint64_t patterns; ///< points for which the programs of a material were run
    uint64_t environment; ///< rays that left the scene, for which the background's was
    uint64_t overlaps; ///< pairs of a point and a sphere or plane whose cover of a light was looked at, for caps
} glint_work;

/// Numbers of a pattern that no field takes: NaN and numbers below 0 are taken as 0, numbers above 2^100 as 2^100.
typedef enum glint_odd_kind { GLINT_ODD_NAN, GLINT_ODD_NEGATIVE, GLINT_ODD_HUGE, GLINT_ODD_COUNT } glint_odd_kind;

/// How often a frame's patterns gave such a number, and where.
typedef struct glint_odd {
    uint64_t count; ///< points; of the background, directions
    const char *field; ///< of one of them: static string, "diffuse"; "background" of the scene; NULL: there is none
    char material[GLINT_NAME_SIZE]; ///< name of its material; may be empty
    double point[3]; ///< in the world; of the background, the direction
} glint_odd;

/// The statistics of a frame.
typedef struct glint_frame_stats {
    double build_ms; ///< wall time of building the spatial index; next to 0 when it was there
    double render_ms; ///< wall time of the stages up to the film
    double tone_ms; ///< wall time of making codes
    int stage_count; ///< the plan's stages, in its order
    const char *stage_name[GLINT_STAGE_MAX]; ///< static strings
    double stage_ms[GLINT_STAGE_MAX]; ///< summed over workers; 0 unless the renderer times stages
    /// Share of the stage's results taken from earlier frames: 0 it ran, 1 it did not
    double stage_reused[GLINT_STAGE_MAX];
    glint_ray_counts rays; ///< as cast; reused stages cast none
    glint_work work; ///< 0 unless the renderer counts it; reused results cost none
    uint64_t refined; ///< pixels that got all samples, where `adaptive` chooses; else 0
    uint64_t pixels; ///< rendered, for a region all pixels of the tiles that it touches; `clipped` and `nonfinite` count these
    uint64_t clipped; ///< pixels with a channel above 1; 0 without codes
    uint64_t nonfinite; ///< pixels with a channel that is not finite; 0 without codes
    uint64_t shifted; ///< pixels next to an edge of a shape or shadow that a derivative's parameter moves, or within a soft
        ///< shadow: the derivative does not include the motion of the edge. 0 without derivatives
    glint_odd odd[GLINT_ODD_COUNT]; ///< what patterns gave and fields cannot take
} glint_frame_stats;

/// Renders one frame. *out holds the passes and codes the plan's glint_render_desc names. `stats` may be NULL.
glint_status glint_render(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats,
                          glint_error *error);

// ---- Images -------------------------------------------------------------------------------------------------------

/// Takes another reference; returns its argument. Any thread.
glint_image *glint_image_retain(glint_image *image);
/// Gives a reference back; the last one frees the image. NULL: nothing. Any thread.
void glint_image_release(glint_image *image);
/// Size in pixels.
int glint_image_width(const glint_image *image);
int glint_image_height(const glint_image *image);
/// Returns whether the pass is stored; beauty may exist only as codes.
bool glint_image_has_pass(const glint_image *image, glint_pass pass);
/// Returns the name of derivative number `index`, from 0; owned by the image. NULL: it has fewer.
const char *glint_image_derivative(const glint_image *image, size_t index);
/// Returns the name of light pass number `index`, from 0; owned by the image. NULL: it has fewer.
const char *glint_image_light_pass(const glint_image *image, size_t index);
/// Returns whether all codes are 0, except alpha; without codes, whether no value of beauty is above 0. Stops
/// at the first other value. False if there is neither.
bool glint_image_is_black(const glint_image *image);
/// Stops of glint_tone_desc that the frame's codes have, or would have.
double glint_image_exposure(const glint_image *image);

/// How bright pictures are; begins as { 0 }.
typedef struct glint_brightness {
    double most; ///< greatest finite value of a channel, before exposure; 0: none is above 0
    uint64_t pictures; ///< how many were added
    uint64_t values; ///< three a pixel
    uint64_t clipped; ///< finite values that are above 1 after exposure
} glint_brightness;

/// Adds an image's linear beauty to *sum, clipped after `exposure` stops. GLINT_ERR_INVALID: it has no linear beauty.
glint_status glint_image_brightness(const glint_image *image, double exposure, glint_brightness *sum, glint_error *error);
/// Widens range[0] .. range[1] to the finite values of the pass: of depth its nearest and farthest, of a derivative the largest slope of
/// a channel either way. Begins as +inf, -inf. GLINT_ERR_INVALID: the image has not that pass, or it is neither.
glint_status glint_image_range(const glint_image *image, glint_pass pass, double range[2], glint_error *error);
/// The greatest exposure, in whole hundredths of a stop within GLINT_EXPOSURE_MAX, that leaves light of `most` at or below 1; 0 of
/// no light. The same on every machine.
double glint_exposure_for(double most);
/// Reads one pixel of a kept pass; (0, 0) is the top left. One-channel passes give the same number three times.
glint_status glint_image_pixel(const glint_image *image, glint_pass pass, int x, int y, float out[3],
                               glint_error *error);

// ---- Files --------------------------------------------------------------------------------------------------------

/// How PNG data are deflated: quickly, or into fewer bytes.
typedef enum glint_encode { GLINT_ENCODE_FAST, GLINT_ENCODE_SMALL } glint_encode;

/// Name and version of the deflate library behind a setting in this build: "isal 2.30.0".
const char *glint_encoder_name(glint_encode encode);

/// A text that a PNG carries. Both strings are borrowed.
typedef struct glint_text {
    const char *keyword; ///< PNG tEXt keyword: 1 .. 79 Latin-1 characters
    const char *value; ///< any length up to 64 KiB; bytes outside Latin-1 are written as '?'
} glint_text;

/// One pass as a file. Pointers are borrowed for the call.
typedef struct glint_write_desc {
    /// Ends in .png; in .pfm or .npy for the linear float32 of one pass (.npy: NumPy's, height x width or height x width x 3,
    /// top row first); or in .exr for all passes of the image, as channels of one file: R, G, B, A, depth.Z,
    /// normal.X ... diffuse.B
    const char *path;
    glint_pass pass; ///< one the image has; an .exr has all
    /// .png; depth, normal, object_id and derivatives are scaled for viewing, see README. In an .exr, 16 `bits` make light and normals half,
    /// 8 leave them float; the rest is float either way
    glint_tone_desc tone;
    glint_encode encode; ///< .png; default GLINT_ENCODE_FAST
    double dpi; ///< .png: pixels an inch where it is printed, 0 .. 1e6; 0: not said
    /// .png of depth and derivatives: 1 + a glint_colormap, whose colours replace greys; 0: grey. With depth, the
    /// background stays black; with a derivative, the mean of its three components is shown
    int colormap;
    /// .png of depth and derivatives: the numbers at the ends of the greys or the map, which is linear between them; finite. Equal (default):
    /// the picture's own, see README
    double range[2];
    const glint_text *text; ///< .png and .exr
    size_t text_count; ///< 0: no texts
} glint_write_desc;

/// "OpenEXR 3.1.5"; NULL: this build cannot write .exr.
const char *glint_exr_library(void);
/// Names and versions of the libraries that are in use, the last one NULL. Static strings.
const char *const *glint_libraries(void);

/// Writes one pass to a file that appears whole or not at all: temporary name beside it, fsync, rename. An existing
/// file that is not a regular one (a pipe, /dev/full) is written in place. Missing folders are made.
/// GLINT_ERR_NO_SPACE for ENOSPC and EDQUOT, GLINT_ERR_IO otherwise; the message names the file.
glint_status glint_image_write(const glint_image *image, const glint_write_desc *desc, glint_error *error);

/// The bytes that glint_image_write would write; `desc->path` gives the format by its ending. The caller frees *data
/// with free().
glint_status glint_image_to_bytes(const glint_image *image, const glint_write_desc *desc, uint8_t **data, size_t *size,
                                  glint_error *error);

/// Fills `out`, which has 4 x width x height bytes, with the 8-bit codes of one pass as a .png would have them: RGBA, top row first,
/// alpha 255 where the picture has none. Of `desc` the pass, the tone of 8 bits, dpi and colormap are read.
glint_status glint_image_rgba(const glint_image *image, const glint_write_desc *desc, uint8_t *out, glint_error *error);

/// Identifies a finished frame: 32 hex digits over engine version, everything the plan reads, `desc`'s tone, encode,
/// encoder version and pass. Threads, instruction set, shard and path are not in it.
void glint_frame_key(const glint_plan *plan, const glint_write_desc *desc, char key[33]);
/// The key of the whole frame that a region is a part of; without a region the frame's own.
void glint_whole_key(const glint_plan *plan, const glint_write_desc *desc, char key[33]);

/// Whether `path` is a whole PNG (every chunk's CRC right, IEND at the end) whose tEXt "glint:key" equals key.
bool glint_file_has_key(const char *path, const char *key);

/// Writes images on threads of its own, in the order submitted, so that rendering, encoding and the disk overlap. It
/// remembers the last picture deflated, about the size of its file, so as not to deflate again what has not changed.
typedef struct glint_writer glint_writer;

/// The result of one submitted file.
typedef struct glint_write_result {
    glint_status status; ///< GLINT_OK: the file is there
    char message[512]; ///< "" when it is; else the file and the reason
    double encode_ms; ///< codes to bytes
    double write_ms; ///< bytes to a synced, renamed file
    double reused; ///< share of the deflated bytes, in bands of rows, that the file before had already, 0 .. 1
    void *user; ///< as submitted
} glint_write_result;

/// queue_depth  images that may wait, >= 1; a further submit blocks. With more than 2 a renderer that is faster than the
///              encoder runs out of pictures whose memory it can use again.
/// threads      that encode an image together, 1 .. 1024; 0: one per processor; 1: the writer's own. Files do not
///              depend on it.
glint_status glint_writer_create(int queue_depth, int threads, glint_writer **out, glint_error *error);
/// Finishes the queue, then frees. Results not collected are lost.
void glint_writer_destroy(glint_writer *writer);
/// Retains the image and copies `desc` with its strings. `user` comes back with the result.
glint_status glint_writer_submit(glint_writer *writer, glint_image *image, const glint_write_desc *desc, void *user,
                                 glint_error *error);
/// Takes the next result, in the order submitted; waits for it when `wait`. False: none (left).
bool glint_writer_collect(glint_writer *writer, bool wait, glint_write_result *result);
/// Drops queued files that are not begun (their results read GLINT_ERR_CANCELLED); files that are begun are finished.
void glint_writer_cancel(glint_writer *writer);

/// How far two pictures are apart, over all pixels and channels.
typedef struct glint_compare_result {
    int width, height, channels; ///< pixels; of both pictures
    double mean_error, rms_error, peak_snr, max_error; ///< of values in 0 .. 1 (PNG) or linear (PFM)
    int max_x, max_y, max_channel; ///< where max_error is, from 0
    uint64_t failed, warned; ///< pixels off by more than the two thresholds
    uint64_t pixels; ///< width x height
} glint_compare_result;

/// Thresholds of differences.
typedef struct glint_compare_desc {
    double fail, warn; ///< thresholds, default 1e-6 as in idiff
} glint_compare_desc;

/// Compares two .png or .pfm files. GLINT_ERR_INVALID when the sizes or channels differ (out->width is then -1),
/// GLINT_ERR_IO or GLINT_ERR_FORMAT when one cannot be read.
glint_status glint_compare_files(const char *a, const char *b, const glint_compare_desc *desc,
                                 glint_compare_result *out, glint_error *error);

// ---- How far a picture is from a reference ------------------------------------------------------------------------

/// A picture that others are measured against: the mean of pictures that ought to be the same. Immutable.
typedef struct glint_reference glint_reference;

/// How far a picture is from a reference.
typedef struct glint_picture_error {
    double rmse; ///< root of the mean squared difference of linear light, over pixels and channels
    double relmse; ///< mean of (x - r)^2 / (r^2 + 0.01)
    double max_code; ///< largest difference of codes, in steps of 8 bits; fractions at 16 bits
    double over1, over8; ///< share of pixels with a channel off by more than 1, 8 such steps
    double flip; ///< mean LDR-FLIP, 0 .. 1 (Andersson et al. 2020), at 67 pixels a degree
} glint_picture_error;

/// images  `count` >= 1 of them, of one size, each with the beauty pass; read only, not kept.
/// tone    how the codes that are compared are made; its `bits` mean nothing here.
glint_status glint_reference_create(const glint_image *const *images, size_t count, const glint_tone_desc *tone,
                                    glint_reference **out, glint_error *error);
/// Frees the reference with its image. NULL: nothing.
void glint_reference_destroy(glint_reference *reference);
/// The mean, with the beauty pass; borrowed.
const glint_image *glint_reference_image(const glint_reference *reference);

/// Measures a picture of the reference's size that has the beauty pass.
///
/// file_bits  0: the linear light itself; 8 or 16: what the codes of such a file keep of it, exposure and curve undone.
///            Light above white, which no file keeps, counts as it is either way, so that the numbers compare.
///
/// Where a channel is not finite, rmse and relmse are not.
glint_status glint_reference_measure(const glint_reference *reference, const glint_image *image, int file_bits,
                                     glint_picture_error *out, glint_error *error);

/// A picture of codes for the eye: `scale` times the difference of the 8-bit codes in each channel, white at most.
glint_status glint_reference_difference(const glint_reference *reference, const glint_image *image, double scale,
                                        glint_image **out, glint_error *error);

// ---- Other strengths and colours of lights ---------------------------------------------------------------------------

#define GLINT_LIGHT_OTHER "..." ///< the name of the light of a file that is in none of its passes

/// Reads an .exr of scan lines with light passes: channels R, G and B of the picture, light.NAME.R, .G and .B of each pass, and A, if any.
/// Light of the picture that is in none of them, beyond rounding, is one more pass, GLINT_LIGHT_OTHER. The image has no beauty, which its
/// passes make up. GLINT_ERR_IO, GLINT_ERR_FORMAT with the file's name; GLINT_ERR_UNSUPPORTED in a build without OpenEXR.
glint_status glint_lights_read(const char *path, glint_image **out, glint_error *error);
/// Makes the picture in which light pass number i is `factors[i]` times as strong, in each channel: beauty, with the alpha that there is.
/// The sum is made in double in the order of the passes, and rounded to float32 once.
glint_status glint_image_relight(const glint_image *lights, const double (*factors)[3], glint_image **out, glint_error *error);

// ---- Finished files, sheets and films -------------------------------------------------------------------------------

/// A file being written: it grows under a hidden name beside its place, which has the whole file or none at any time.
typedef struct glint_draft glint_draft;

/// Opens a draft for `path`. Missing folders are made, a symbolic link is followed. An existing file that is not a
/// regular file (a pipe, a device) is written in place and never replaced.
///
/// Messages of the three read "<path>: <reason>"; GLINT_ERR_NO_SPACE for ENOSPC and EDQUOT, GLINT_ERR_NOMEM, GLINT_ERR_IO
/// for the rest. A draft belongs to one thread at a time.
glint_status glint_draft_create(const char *path, glint_draft **out, glint_error *error);
/// The hidden name, for another program to write to; the draft's.
const char *glint_draft_name(const glint_draft *draft);
glint_status glint_draft_append(glint_draft *draft, const void *bytes, size_t size, glint_error *error);
/// Syncs the file and gives it its name; an older one is replaced. Then only glint_draft_destroy may follow.
glint_status glint_draft_finish(glint_draft *draft, glint_error *error);
/// Removes an unfinished draft. NULL does nothing.
void glint_draft_destroy(glint_draft *draft);

/// Removes from a folder the hidden files of drafts whose process was killed: drafts of this host at once, drafts of other hosts a
/// day after they were last written. A process does it once in each folder where it opens a draft or calls glint_file_has_key. Any
/// thread.
void glint_drafts_collect(const char *path);
/// Removes the hidden files of this process's drafts. For a signal's handler that ends the process next: it may be called
/// there, and no draft can be finished afterwards.
void glint_drafts_abandon(void);

/// A finished .png or .pfm, read again. Immutable.
typedef struct glint_picture glint_picture;

/// Reads `path`; an incomplete file is GLINT_ERR_FORMAT. Without `pixels` only the size and the texts: then the
/// deflated data are not looked at, the CRCs are. Messages name the file.
glint_status glint_picture_read(const char *path, bool pixels, glint_picture **out, glint_error *error);
/// The same of the bytes of a .png, with its pixels; they may be freed after the call.
glint_status glint_picture_from_bytes(const void *data, size_t size, glint_picture **out, glint_error *error);
/// Frees the picture with its texts. NULL: nothing.
void glint_picture_destroy(glint_picture *picture);
/// Size in pixels.
int glint_picture_width(const glint_picture *picture);
int glint_picture_height(const glint_picture *picture);
int glint_picture_bits(const glint_picture *picture); ///< 8, 16; 32: a .pfm
int glint_picture_channels(const glint_picture *picture); ///< 1 .. 4; 2 and 4: the last is alpha
/// Whether codes are sRGB or light, by gAMA and sRGB chunks; a .pfm is light.
glint_transfer glint_picture_transfer(const glint_picture *picture);
/// The value of a PNG's tEXt, as UTF-8; the picture's; NULL: there is none.
const char *glint_picture_text(const glint_picture *picture, const char *keyword);
/// Row `y`, from 0 at the top, as 3 * width sRGB codes of 8 bits, for viewing: grey becomes RGB, 16 bits and linear codes
/// are rounded, what shows through alpha is a grey of `backdrop`, 0 .. 255. Needs the pixels.
void glint_picture_row(const glint_picture *picture, int y, int backdrop, uint8_t *rgb);
/// Row `y` as 3 * width numbers of linear light: sRGB codes are decoded, linear ones are shares of the largest code, grey becomes
/// RGB, alpha is left out. Needs the pixels.
void glint_picture_light(const glint_picture *picture, int y, float *rgb);

/// A finished part of a picture.
typedef struct glint_picture_part {
    const glint_picture *picture; ///< read with its pixels, of a .png with three or four channels
    int x, y; ///< where its top left pixel is in the whole
} glint_picture_part;

/// Writes the picture of width x height pixels that the parts make, as glint_image_write would have written the whole:
/// `desc` has path (.png), transfer and bits of the tone, encode and text; its pass means nothing. Parts may overlap where they
/// agree. GLINT_ERR_INVALID names by its number, from 1, a part that lies outside, is of other bits or channels than
/// the first, or disagrees with one before it, and the first pixel that none has.
glint_status glint_picture_join(const glint_picture_part *parts, size_t count, int width, int height, const glint_write_desc *desc,
                               glint_error *error);

/// One picture of a contact sheet. Strings are borrowed.
typedef struct glint_sheet_cell {
    const char *path; ///< a .png or .pfm, all of one size
    const char *label; ///< UTF-8, parts divided by newlines, which share a line where they fit; NULL: none
} glint_sheet_cell;

/// A contact sheet. Pointers are borrowed for the call.
typedef struct glint_sheet_desc {
    const glint_sheet_cell *cells; ///< row by row
    size_t cell_count; ///< >= 1
    int columns; ///< >= 1
    const char *title, *across, *down; ///< of the sheet, of its columns, of its rows; NULL: none
    size_t difference; ///< the cell, from 1, that each row is compared with in a row below it; 0: no such rows
    double gain; ///< factor of the differences; > 0
    double size; ///< of labels, points of dpi / 72 pixels, 0 .. 10000; 0: 13 pixels, below pictures of 900 across and more 26
    double dpi; ///< pixels an inch where it is printed, 0 .. 1e6; 0: not said, and a point is a pixel
    bool transparent; ///< the paper is; pictures are as on white
    /// A colour bar of all pictures, at their right, or below them where it is horizontal; NULL: none. It has its kind's own fields,
    /// with `length` in points (default: as the pictures together, at most 20 times `size`), and the sheet's text and ink
    const glint_overlay_desc *colorbar;
} glint_sheet_desc;

/// Draws finished pictures in rows, with labels, as one PNG: dark text on white, pixels of 8 bits. A picture that is
/// missing or of another size than the first is an error that names it; the file is then as it was.
/// A row of differences holds |cell - chosen cell| times `gain`, in 8-bit sRGB codes.
glint_status glint_sheet_write(const glint_sheet_desc *desc, const char *path, glint_error *error);

/// An animated PNG being written.
typedef struct glint_apng glint_apng;

/// The fields of an animated PNG.
typedef struct glint_apng_desc {
    int width, height; ///< 1 .. GLINT_SIDE_MAX
    int bits; ///< 8 or 16
    bool alpha; ///< frames are RGBA
    glint_transfer transfer; ///< how the codes of all frames are made
    uint32_t frame_count; ///< 1 .. 2^30
    double fps; ///< 1/65535 .. 65535; a frame stays for the nearest ratio of two 16-bit numbers to 1/fps
    uint32_t plays; ///< 0: for ever
    glint_encode encode; ///< how frames are deflated
} glint_apng_desc;

/// Opens a draft for `path` and writes its head.
glint_status glint_apng_create(const char *path, const glint_apng_desc *desc, glint_apng **out, glint_error *error);
/// Adds a frame, of which only what has changed is stored: RGB or RGBA, of the size, bits and transfer described.
glint_status glint_apng_add(glint_apng *apng, const glint_picture *picture, glint_error *error);
/// Gives the file its name, once frame_count frames were added.
glint_status glint_apng_finish(glint_apng *apng, glint_error *error);
/// Removes what was not finished. NULL does nothing.
void glint_apng_destroy(glint_apng *apng);

// ---- Numbers that are the same on every machine -------------------------------------------------------------------

/// Elementary functions with the same bits on every machine, within 0.51 ulp of the truth (0.76 where the result
/// is subnormal). Infinite and NaN arguments as in C11 annex F.
double glint_sin(double radians);
double glint_cos(double radians);
double glint_tan(double radians);
double glint_exp(double x);
double glint_log(double x);
double glint_pow(double x, double y);
double glint_srgb_encode(double linear); ///< IEC 61966-2-1:1999; input clamped to 0 .. 1, NaN gives 0
double glint_srgb_decode(double encoded); ///< the inverse; input clamped to 0 .. 1

#ifdef __cplusplus
}
#endif

#endif
