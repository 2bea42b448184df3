/// Patterns and shaders: functions of a script that are traced to programs of the engine. Private to bindings/.
///
///   term.c        numbers and symbols in C: read from Lua, computed with, pushed
///   symbol.c      glint.symbol: a number that is known at the point only, and its operators
///   triple.c      glint.triple: three numbers or symbols, their operators and methods
///   operation.c   glint.NAME for every operation
///   tiling.c      glint.checker, stripe, brick
///   input.c       what a function reads of a point: p, and the fields of s
///   trace.c       a function called with symbols; its result as a program
///   points.c      the same function with plain numbers, against the program
///   functions.c   the objects that glint.pattern and glint.shader make
///   texture.c     the objects that glint.texture makes
///   colormap.c    glint.colormap: colours of numbers
///   reflection.c  material:evaluate with patterns and shaders
///   patterns.c    opens all of them
///   patterned.c   materials whose fields hold patterns: traced when a frame is planned
#ifndef GLINT_PATTERN_H
#define GLINT_PATTERN_H

#include "bindings/value/glintL.h"

#define GLINTL_SYMBOL "glint.symbol"
#define GLINTL_TRIPLE "glint.triple"
#define GLINTL_SURROUNDINGS "glint.surroundings" ///< s

// ---- term.c ----

/// A number, or a symbol: a value of the builder of the function that is traced.
typedef struct glintL_term {
    bool is_symbol;
    double number;
    glint_value value;
} glintL_term;

/// A scalar is three times the same term.
typedef struct glintL_operand {
    bool is_vector;
    glintL_term at[3];
} glintL_operand;

#define GLINTL_CHOICES_MAX 4096 ///< of a call that are told apart

/// The symbols of a call that came from choices: glint.less, glint.checker and such, in their order.
typedef struct glintL_choices {
    uint32_t count;
    uint64_t used[GLINTL_CHOICES_MAX / 64]; ///< a bit each: something was made of it
    char place[96]; ///< where the first of those came about that were not: "scene.lua:12: "; "": no second call looked
} glintL_choices;

/// A function that is running: with symbols, or (builder NULL) with the numbers of one point.
typedef struct glintL_trace {
    glint_builder *builder;
    const double *point; ///< GLINT_INPUT_COUNT numbers; NULL: symbols
    bool is_shader;
    bool has_power; ///< `^` was used with other bits than C's pow
    glintL_choices choices;
    glintL_choices *before; ///< of the same function: a choice that was not used there is false; NULL: none is
    uint64_t serial; ///< no two of a Lua state have the same
    struct glintL_trace *outer; ///< the function within which this one was called, or NULL
    char place[96]; ///< where the function begins: "scene.lua:12: "
    int64_t steps; ///< of Lua, about, of the outermost one
    lua_Hook hook; ///< the state's hook before the outermost call; restored after it
    int hook_mask, hook_count;
} glintL_trace;

/// The innermost one, or NULL.
glintL_trace *glintL_current_trace(lua_State *L);
void glintL_enter_trace(lua_State *L, glintL_trace *trace); ///< gives it a serial number
void glintL_leave_trace(lua_State *L, const glintL_trace *trace);

glintL_term glintL_number_term(double number);
/// results  written: as many as the operation has.
///
/// Numbers alone give numbers, with the bits that the program would have.
void glintL_apply(lua_State *L, glint_op op, const glintL_term *operands, glintL_term *results);
glintL_term glintL_apply1(lua_State *L, glint_op op, glintL_term a);
glintL_term glintL_apply2(lua_State *L, glint_op op, glintL_term a, glintL_term b);
glintL_term glintL_apply3(lua_State *L, glint_op op, glintL_term a, glintL_term b, glintL_term c);
glintL_term glintL_dot_terms(lua_State *L, const glintL_term a[3], const glintL_term b[3]);

/// False: the value is not a number, symbol, vector, triple, list of three of them, or (when allow_color) name of a colour.
bool glintL_to_operand(lua_State *L, int index, bool allow_color, glintL_operand *out);
/// Raises "<path>: number, symbol or vector expected, got ..."
void glintL_read_operand(lua_State *L, int index, const char *path, glintL_operand *out);
/// One number or symbol.
glintL_term glintL_read_term(lua_State *L, int index, const char *path);
/// A vector in one argument, or three numbers; returns the index after it.
int glintL_read_place(lua_State *L, int index, const char *path, glintL_term out[3]);
void glintL_push_term(lua_State *L, glintL_term term);
void glintL_push_choice(lua_State *L, glintL_term term); ///< like glintL_push_term, for a value that is 0 or 1; see glintL_trace.before
void glintL_push_operand(lua_State *L, const glintL_operand *operand);

// ---- symbol.c, triple.c ----

/// The metamethods of arithmetic, of symbols, triples and vectors.
void glintL_set_arithmetic(lua_State *L);
/// Metamethods shared by symbols and triples: arithmetic, and those that raise.
void glintL_set_operators(lua_State *L);
/// Three numbers are pushed as a vector.
void glintL_push_triple(lua_State *L, const glintL_term v[3]);
/// The same of red, green, blue and alpha, with a field `a`.
void glintL_push_color(lua_State *L, const glintL_term v[4]);

// ---- input.c ----

/// Pushes `p`, and `s`, whose fields are made when they are read.
void glintL_push_point(lua_State *L);
void glintL_push_surroundings(lua_State *L);
/// Reads {p = ..., uv = ...} at `index`; missing fields have defaults.
void glintL_read_inputs(lua_State *L, int index, bool is_shader, double inputs[GLINT_INPUT_COUNT]);

// ---- trace.c ----

/// The result of a traced function, as a userdata on the stack that holds a reference to the program.
typedef struct glintL_traced {
    glint_program *program;
    bool has_power;
} glintL_traced;

/// Runs a function. It marks the end of the script's Lua code on the call stack, see glintL_traced_place.
int glintL_call_function(lua_State *L);
/// Calls the function of the pattern at `index` and pushes what it gave; the 64 points are looked at when its structure is new.
/// As a background a texture goes around, whatever it does at its border elsewhere.
glintL_traced *glintL_make_program(lua_State *L, int index, bool is_background);
/// Runs the function of the pattern at `index` with the numbers of a point.
/// Returns how many numbers it gave, as the program's outputs are counted.
size_t glintL_run_on_numbers(lua_State *L, int index, const double inputs[GLINT_INPUT_COUNT], double *outputs);

/// Pushes where the function of the pattern at `index` begins, "scene.lua:12: "; "": it has none.
const char *glintL_push_pattern_place(lua_State *L, int index);

// ---- points.c ----

/// Raises when plain Lua and the program differ at one of 64 points.
void glintL_compare_points(lua_State *L, int index, const glintL_traced *traced);

// ---- functions.c ----

/// The function of a pattern or shader is the user value 1, the structures that were looked at are the keys of the table 2.
typedef struct glintL_pattern {
    glint_program_kind kind;
    glint_texture *texture; ///< of glint.texture, whose user value 1 has its fields; NULL: there is a function
} glintL_pattern;

/// A pattern, shader or texture; NULL when the value at index is none.
glintL_pattern *glintL_to_pattern(lua_State *L, int index);
glintL_pattern *glintL_push_pattern(lua_State *L, glint_program_kind kind, const char *type);
int glintL_pattern_evaluate(lua_State *L); ///< the method

// ---- texture.c ----

/// Red, green, blue and alpha of a texture at u, v, of a footprint; numbers give numbers.
void glintL_apply_texture(lua_State *L, const glint_texture *texture, const glintL_term in[3], glintL_term out[4]);

// ---- What patterns.c opens ----

void glintL_open_symbol(lua_State *L);
void glintL_open_triple(lua_State *L);
void glintL_open_operation(lua_State *L);
void glintL_open_tiling(lua_State *L);
void glintL_open_input(lua_State *L);
void glintL_open_trace(lua_State *L);
void glintL_open_texture(lua_State *L);
void glintL_open_colormap(lua_State *L);
void glintL_open_functions(lua_State *L);

#endif
