/// Patterns and shaders: functions of a script that are traced to programs of the engine. Private to bindings/.
///
///   term.c        numbers and symbols in C: read from Lua, computed with, pushed
///   symbol.c      glint.symbol: a number that is known only at each point, and its operators
///   triple.c      glint.triple: three numbers or symbols, their operators and methods
///   operation.c   glint.NAME for every operation
///   tiling.c      glint.checker, stripe, brick
///   input.c       what a function can read at a point: p, and the fields of s
///   trace.c       a function called with symbols; its result as a program
///   points.c      the same function with plain numbers, against the program
///   functions.c   the objects that glint.pattern and glint.shader make
///   colormap.c    glint.colormap: colours of numbers
///   reflection.c  material:evaluate with patterns and shaders
///   patterns.c    opens all of them
///   patterned.c   materials whose fields hold patterns: traced when a frame is planned
#ifndef GLINT_PATTERN_H
#define GLINT_PATTERN_H

#include "bindings/value/glintL.h"
#include "engine/glint_math.h"
#include "engine/glint_programs.h"

#define GLINTL_SYMBOL "glint.symbol"
#define GLINTL_TRIPLE "glint.triple"
#define GLINTL_SURROUNDINGS "glint.surroundings" ///< the type of s

// ---- term.c ----

/// A number, or a symbol: a value in the builder of the function that is being traced.
typedef struct glintL_term {
    bool is_symbol;
    double number;
    glint_value value;
} glintL_term;

/// A scalar has the same term three times.
typedef struct glintL_operand {
    bool is_vector;
    glintL_term at[3];
} glintL_operand;

#define GLINTL_CHOICES_MAX 4096 ///< choices tracked in one call

/// The symbols in a call that result from choices (glint.less, glint.checker and so on), in order.
typedef struct glintL_choices {
    uint32_t count;
    uint64_t used[GLINTL_CHOICES_MAX / 64]; ///< a bit for each choice: its result was used
    char place[96]; ///< position of the first unused choice: "scene.lua:12: "; "": not known
} glintL_choices;

/// A running function: with symbols or, if builder is NULL, with the numbers of one point.
typedef struct glintL_trace {
    glint_builder *builder;
    const double *point; ///< GLINT_INPUT_COUNT numbers; NULL: symbols
    bool is_shader;
    bool has_power; ///< `^` was used with bits that may differ from C's pow
    glintL_choices choices;
    glintL_choices *before; ///< choices of the previous call; those unused there are now false. NULL: no choice is
    uint64_t serial; ///< unique in its Lua state
    struct glintL_trace *outer; ///< the function that called this one, or NULL
    char place[96]; ///< position of the function: "scene.lua:12: "
    int64_t steps; ///< approximate Lua instructions of the outermost function
    lua_Hook hook; ///< the state's hook before the outermost call, which restores it
    int hook_mask, hook_count;
} glintL_trace;

/// Returns the innermost running function, or NULL.
glintL_trace *glintL_current_trace(lua_State *L);
void glintL_enter_trace(lua_State *L, glintL_trace *trace); ///< assigns a serial number
void glintL_leave_trace(lua_State *L, const glintL_trace *trace);

glintL_term glintL_number_term(double number);
/// results  written: as many as the operation has.
///
/// If all operands are numbers, so are the results, with the bits that the program would compute.
void glintL_apply(lua_State *L, glint_op op, const glintL_term *operands, glintL_term *results);
glintL_term glintL_apply1(lua_State *L, glint_op op, glintL_term a);
glintL_term glintL_apply2(lua_State *L, glint_op op, glintL_term a, glintL_term b);
glintL_term glintL_apply3(lua_State *L, glint_op op, glintL_term a, glintL_term b, glintL_term c);
glintL_term glintL_dot_terms(lua_State *L, const glintL_term a[3], const glintL_term b[3]);

/// Reads an operand. False: the value is not a number, symbol, vector, triple, list of three of them, or (if
/// allow_color) name of a colour.
bool glintL_to_operand(lua_State *L, int index, bool allow_color, glintL_operand *out);
/// Reads an operand, but raises "<path>: number, symbol or vector expected, got ...".
void glintL_read_operand(lua_State *L, int index, const char *path, glintL_operand *out);
/// Reads one number or symbol.
glintL_term glintL_read_term(lua_State *L, int index, const char *path);
/// Reads a point: a vector in one argument, or three numbers. Returns the index after it.
int glintL_read_position(lua_State *L, int index, const char *path, glintL_term out[3]);
void glintL_push_term(lua_State *L, glintL_term term);
void glintL_push_choice(lua_State *L, glintL_term term); ///< for a value of 0 or 1; see glintL_trace.before
void glintL_push_operand(lua_State *L, const glintL_operand *operand);
/// Computes red, green, blue and alpha of a texture. in: u, v, and the footprint along each. Numbers give numbers.
void glintL_apply_texture(lua_State *L, const glint_texture *texture, const glintL_term in[4], glintL_term out[4]);

// ---- symbol.c, triple.c ----

/// Sets the arithmetic metamethods of symbols, triples and vectors.
void glintL_set_arithmetic(lua_State *L);
/// Sets the metamethods shared by symbols and triples: arithmetic, and those that raise.
void glintL_set_operators(lua_State *L);
/// Pushes a triple; three plain numbers become a vector.
void glintL_push_triple(lua_State *L, const glintL_term v[3]);
/// Pushes red, green, blue and alpha as a triple with a field `a`.
void glintL_push_color(lua_State *L, const glintL_term v[4]);

// ---- input.c ----

/// Push `p` and `s`. The fields of `s` are made when they are first read.
void glintL_push_point(lua_State *L);
void glintL_push_surroundings(lua_State *L);
/// Reads {p = ..., uv = ...} at `index`. Missing fields get defaults.
void glintL_read_inputs(lua_State *L, int index, bool is_shader, double inputs[GLINT_INPUT_COUNT]);

// ---- trace.c ----

/// The result of a traced function: a userdata on the stack that owns a reference to the program.
typedef struct glintL_traced {
    glint_program *program;
    bool has_power;
} glintL_traced;

/// Runs a function. Marks the end of the script's Lua code on the call stack, see glintL_traced_place.
int glintL_call_function(lua_State *L);
/// Runs the function of the pattern at `index` and pushes its program. Compares a new structure with plain Lua at 64
/// points. is_background: a texture wraps around in u, whatever its own wrap mode.
glintL_traced *glintL_make_program(lua_State *L, int index, bool is_background);
/// Runs the function of the pattern at `index` with the numbers of a point. Returns how many numbers it returned,
/// counted like the program's outputs.
size_t glintL_run_on_numbers(lua_State *L, int index, const double inputs[GLINT_INPUT_COUNT], double *outputs);

/// Pushes the position of the function of the pattern at `index`, "scene.lua:12: "; "": it has no function.
const char *glintL_push_pattern_position(lua_State *L, int index);

// ---- points.c ----

/// Raises if plain Lua and the program differ at one of 64 points.
void glintL_compare_points(lua_State *L, int index, const glintL_traced *traced);

// ---- functions.c ----

/// User value 1 is the function of a pattern or shader. User value 2 is a table whose keys are the structures already
/// compared.
typedef struct glintL_pattern {
    glint_program_kind kind;
    glint_texture *texture; ///< texture of glint.texture, whose user value 1 has its fields; NULL: a function
} glintL_pattern;

/// Returns a pattern, shader or texture; NULL: the value at index is none.
glintL_pattern *glintL_to_pattern(lua_State *L, int index);
glintL_pattern *glintL_push_pattern(lua_State *L, glint_program_kind kind, const char *type);
int glintL_pattern_evaluate(lua_State *L); ///< the method `evaluate`
int glintL_map_array(lua_State *L); ///< the method `map` of arrays

// ---- Opened by patterns.c ----

void glintL_open_symbol(lua_State *L);
void glintL_open_triple(lua_State *L);
void glintL_open_operation(lua_State *L);
void glintL_open_tiling(lua_State *L);
void glintL_open_input(lua_State *L);
void glintL_open_trace(lua_State *L);
void glintL_open_colormap(lua_State *L);
void glintL_open_functions(lua_State *L);

// ---- For the other parts of the binding ----

/// Returns whether the value is a program that a field can have: a shader for a shader's field, otherwise a pattern or
/// texture.
bool glintL_is_source(lua_State *L, int index, bool is_shader);
/// Methods of vectors and triples; also glint.dot and so on.
int glintL_dot(lua_State *L);
int glintL_cross(lua_State *L);
int glintL_length(lua_State *L);
int glintL_unit(lua_State *L);
int glintL_reflect(lua_State *L);
/// Returns the position of the traced function: "scene.lua:12: ". `reached` is a C function on the call stack of an
/// error. NULL: it is not the one that calls traced functions.
const char *glintL_traced_position(lua_State *L, lua_CFunction reached);
/// Raises if a pattern's function is running, during which `what` would change the scene.
void glintL_refuse_within_trace(lua_State *L, const char *what);
/// Stores the patterns in the constructor's table at `table` with the object whose userdata is at `index`.
void glintL_keep_sources(lua_State *L, int index, int table, const glintL_field *fields);
/// Stores the pattern of one field, whose value is at `value`.
void glintL_keep_source(lua_State *L, int index, const glintL_field *field, int value);
/// Called before the script closes the userdata at `index`: its patterns stay with the object.
void glintL_keep_closed(lua_State *L, int index);
/// Runs the functions of the patterns of all materials in the scene, and sets the materials' programs.
void glintL_trace_scene(lua_State *L, const glint_scene *scene);
/// Runs the functions of one material, whose userdata is at `index`.
void glintL_trace_material(lua_State *L, int index);
/// The directions for material:evaluate. They need not be unit vectors.
typedef struct glintL_geometry {
    double normal[3], to_light[3], to_eye[3];
    double p[3]; ///< read by patterns and shaders as p and s.world
} glintL_geometry;

/// As glint_material_evaluate, but also for materials with programs: at one point, without bumps.
glint_status glintL_evaluate_material(const glint_material *material, const glintL_geometry *at, glint_reflection *out,
                                      glint_error *error);
void glintL_open_patterns(lua_State *L);
/// colormap.c: reads a map as 256 sRGB colours, from a list of evenly spaced colours or from a function of 0 ..
/// 1, which it calls. With a list it allocates nothing.
void glintL_read_colors(lua_State *L, int index, const char *path, uint8_t rgb[256][3]);

#endif
