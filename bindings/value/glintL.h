/// Shared by the files of the binding. The engine knows nothing about Lua, and uses nothing from here.
///
/// Lua holds an object of the engine as a full userdata `glintL_box` with one reference. Assigning a field copies the
/// description, changes one member and passes it back to the engine, which checks it. If the check fails, the object is
/// unchanged. Errors raised to Lua read "material.shininess: number >= 0 expected, got -1".
#ifndef GLINT_L_H
#define GLINT_L_H

#include <lauxlib.h>
#include <lua.h>
#include <stdio.h>

#include "engine/glint_inspect.h"
#include "engine/glint_programs.h"

// ---- check.c: reading arguments and tables ----

/// One field of a description, and its form in Lua: for objects a row of glint_object_fields, for other tables the
/// binding's own.
typedef glint_object_field glintL_field;

/// Functions that read and write a binding's own field: GLINT_TYPE_CUSTOM.
typedef struct glintL_custom {
    void (*read)(lua_State *L, int index, const char *path, void *desc); ///< raises for a wrong value
    void (*push)(lua_State *L, const void *desc);
} glintL_custom;
#define GLINTL_CUSTOM(read, push) .type = GLINT_TYPE_CUSTOM, .custom = &(const glintL_custom) { read, push }

/// A value that may be given as a distance or as a point.
typedef struct glintL_distance {
    double number; ///< 0: not given as a number
    bool has_point;
    double point[3];
} glintL_distance;

/// Pushes "<file>:<line>: " of the calling Lua code; "" if there is none.
void glintL_push_position(lua_State *L);
/// Raises `message` with the position of the calling Lua code.
int glintL_error(lua_State *L, const char *format, ...);
/// Raises "<path>.<message>" for an engine error; `path` may be "" (only the message). Does nothing for GLINT_OK.
void glintL_check_status(lua_State *L, const char *path, const glint_error *error, glint_status status);
/// Reads the value at `index` into the field of `desc`; raises "<path>.<field>: ... expected, got ...".
void glintL_read_field(lua_State *L, int index, const char *path, const glintL_field *field, void *desc);
/// Writes the defaults of a nested table's fields.
void glintL_begin_table(const glintL_field *parts, void *desc);
/// Pushes the field's value as a Lua value.
void glintL_push_field(lua_State *L, const glintL_field *field, const void *desc);
/// Replaces the table on top of the stack by an empty one that reads the same, but raises on assignment: the table is a
/// copy of a field of this name, so that an assignment would not reach the object.
void glintL_freeze(lua_State *L, const char *name);
/// Reads every key of the table at `index`; raises on an unknown key (naming the nearest known one), a non-string key
/// (unless allow_array, when integer keys are left to the caller) and a missing required field.
void glintL_read_table(lua_State *L, int index, const char *path, const glintL_field *fields, void *desc,
                       bool allow_array);
/// Finds "#rgb", "#rrggbb" or a CSS name and returns it as 0xRRGGBB. False: not a colour.
bool glintL_find_color(const char *text, size_t length, uint32_t *code);
/// Returns the name among `fields` that is nearest to a misspelt name, or its equivalent from other programs, or NULL.
const char *glintL_nearest(const char *name, const glintL_field *fields);
const glintL_field *glintL_find_field(const glintL_field *fields, const char *name);
void glintL_read_vector(lua_State *L, int index, const char *path, double out[3]);
void glintL_read_color(lua_State *L, int index, const char *path, double out[3]);
double glintL_read_number(lua_State *L, int index, const char *path); ///< any number, also NaN and infinity
/// Reads three finite numbers: a vector or an array of exactly three. `expected` describes them in the message.
void glintL_read_three(lua_State *L, int index, const char *path, const char *expected, double out[3]);
/// Returns whichever of `best` (NULL: none yet) and `candidate` is nearer to the misspelt `name`; NULL if neither is
/// near.
const char *glintL_nearer(const char *name, const char *best, const char *candidate);
/// Returns the name used here for a name from other programs ("diffuse" for a material's "color"), if `has` accepts it;
/// otherwise NULL.
const char *glintL_meaning(const char *name, bool (*has)(const void *context, const char *known), const void *context);
/// Raises "<path>.<name>: no such field", with "; did you mean '...'?" unless `near` is NULL.
int glintL_no_such_field(lua_State *L, const char *path, const char *name, const char *near);
/// Raises the error for a key that is not a field's name: the value at `index`.
int glintL_bad_key(lua_State *L, const char *path, int index);
/// Raises "<path>: <expected> expected, got <the value at index>".
int glintL_refuse(lua_State *L, int index, const char *path, const char *expected);
/// Pushes the value at `index` as written in messages: 5, true, string "64", sphere, closed material.
const char *glintL_push_spelling(lua_State *L, int index);
/// Checks that the table at `index` has the keys 1 .. n and no others (with `allow_fields`, string keys are ignored).
/// Returns n.
size_t glintL_check_list(lua_State *L, int index, const char *path, bool allow_fields);

// ---- cure.c: hints for common mistakes ----

bool glintL_is_module(lua_State *L, int index); ///< whether the value is the table that require "glint" returns
bool glintL_makes(lua_State *L, const char *name); ///< whether glint has a function of that name
/// Push a hint for a message, or "": for glint:sphere { ... }, and for scene.add(x).
const char *glintL_push_dot_cure(lua_State *L, int index);
const char *glintL_push_colon_cure(lua_State *L, int index);
/// Pushes a hint for one of Lua's own messages; NULL: there is none. May leave other values on the stack.
const char *glintL_push_lua_cure(lua_State *L, const char *text);
/// Pushes the name after `before` in the text, up to "'" or ")". NULL: the text does not contain `before`, and nothing
/// is pushed.
const char *glintL_push_name_after(lua_State *L, const char *text, const char *before);

// ---- vector.c: the immutable value of a vector or colour ----

/// Pushes a userdata "glint.vector": v[1..3], v.x/y/z, v.r/g/b, #v, unpack(), ==, tostring, + - * /; assigning raises.
void glintL_push_vector(lua_State *L, const double v[3]);
/// Pushes such a userdata with a field `a`.
void glintL_push_texel(lua_State *L, const double v[4]);
#define GLINTL_VECTOR_TYPE "glint.vector"
/// Returns NULL if the value at index is not a vector.
static inline const double *glintL_to_vector(lua_State *L, int index) { return luaL_testudata(L, index, GLINTL_VECTOR_TYPE); }
int glintL_unpack(lua_State *L); ///< the method `unpack`

// ---- array.c: blocks of numbers ----

#define GLINTL_ARRAY "glint.array"

/// A userdata with its numbers behind it, row by row. Lua's allocator counts all its memory.
typedef struct glintL_array {
    size_t count; ///< number of rows
    uint32_t width; ///< numbers of a row, >= 1
    bool is_whole; ///< the numbers are in `wholes`, otherwise in `numbers`
    double *numbers;
    int64_t *wholes;
} glintL_array;

/// Returns NULL if the value at index is not an array.
glintL_array *glintL_to_array(lua_State *L, int index);
/// A list of numbers in a script.
typedef struct glintL_numbers {
    const char *path; ///< names the list in messages
    const char *what; ///< names one number; NULL: "number" or "whole number"
    size_t per; ///< numbers that messages count as one entry; 0: 1
    bool is_whole;
} glintL_numbers;

/// Replaces the list of `count` numbers at `index` by an array.
glintL_array *glintL_take_list(lua_State *L, int index, const glintL_numbers *numbers, size_t count);
/// Replaces the string at `index` by an array of the numbers packed in it: 'f' float, 'd' double, 'u' uint32_t.
glintL_array *glintL_take_packed(lua_State *L, int index, char format);
/// Pushes an array whose numbers are not set.
glintL_array *glintL_push_array(lua_State *L, size_t count, size_t width, bool is_whole);
/// Pushes the result of an operator (LUA_OPADD, _OPSUB, _OPMUL or _OPDIV) of the values at 1 and 2, one of them an array.
int glintL_array_operate(lua_State *L, int op);
void glintL_open_array(lua_State *L);

// ---- dual.c: numbers with their derivatives by variables ----

#define GLINTL_VARIABLES_MAX 32 ///< maximum number of variables in one script
#define GLINTL_DUAL "glint.dual"

typedef struct glintL_dual {
    double value;
    double slope[GLINTL_VARIABLES_MAX]; ///< derivative by each variable
    uint32_t depends; ///< a bit for each variable that the value depends on, even with slope 0
} glintL_dual;

/// Pushes a variable with this name and value. The first call with a name makes the variable. Raises when there are too
/// many.
void glintL_push_variable(lua_State *L, const char *name, double value);
/// Return the variable's number, from 0 (-1: none), and the nearest variable's name, or NULL.
int glintL_find_variable(lua_State *L, const char *name);
const char *glintL_near_variable(lua_State *L, const char *name);
/// variable.c: pushes a variable. When the first variable is made, extends `math` to dual numbers.
void glintL_make_variable(lua_State *L, const char *name, double value);
/// Pushes the result of glint's elementary function of that name for the dual number at 1. Returns false and pushes
/// nothing for other names.
bool glintL_dual_function(lua_State *L, const char *name);
/// Pushes a dual number, or a plain number if no slope is set.
void glintL_push_dual(lua_State *L, const glintL_dual *d);
/// Returns NULL if the value at index is not a dual number.
static inline const glintL_dual *glintL_to_dual(lua_State *L, int index) { return luaL_testudata(L, index, GLINTL_DUAL); }
/// Reads a dual number or a number; false: it is neither.
bool glintL_read_dual(lua_State *L, int index, glintL_dual *out);
/// Returns the value of a function of a (and b, or NULL), whose derivatives by them are by_a and by_b.
glintL_dual glintL_dual_apply(const glintL_dual *a, double by_a, const glintL_dual *b, double by_b, double value);
glintL_dual glintL_dual_pow(const glintL_dual *a, const glintL_dual *b);
/// Reads the numbers of a field's value if any is a dual number: three from a table; for a colour also one for all
/// three. False: none is a dual number. Allocates nothing.
bool glintL_read_duals(lua_State *L, int index, const char *path, bool is_color, int count, double *out);
/// Stores the slopes of a value assigned to a field in the userdata at `index`, or removes the previous slopes.
void glintL_keep_slopes(lua_State *L, int index, const glintL_field *field, int value);
/// Stores or removes the slopes of one component of a field.
void glintL_keep_part_slopes(lua_State *L, int index, const glintL_field *field, int part, int value);
/// Stores the slopes of all fields in the constructor's table at `table`.
void glintL_keep_table_slopes(lua_State *L, int index, int table, const glintL_field *fields);
/// Pushes a field's value if it has slopes; false: it has none.
bool glintL_push_sloped(lua_State *L, int index, const glintL_field *field);
/// Returns the slopes of a field by a variable; false: the field does not depend on the variable.
bool glintL_get_slope(lua_State *L, int index, const glintL_field *field, int variable, double out[3]);
/// Adds the userdata at `index` to those with slopes.
void glintL_note_sloped(lua_State *L, int index);
/// Pushes a table whose keys are all userdata with slopes, and possibly others.
void glintL_push_all_sloped(lua_State *L);
void glintL_open_dual(lua_State *L);

// ---- transform.c: the immutable value of an affine map ----

struct glint_transform;
void glintL_push_transform(lua_State *L, const struct glint_transform *t);
/// Returns NULL if the value at index is not a transform.
const struct glint_transform *glintL_to_transform(lua_State *L, int index);

// ---- pose.c: a camera's matrix. `parts` are the rows of eye, at, direction and up ----

void glintL_read_pose(lua_State *L, int index, const char *path, const glintL_field *parts, void *desc);
/// Pushes nil if the view is along `up`.
void glintL_push_pose(lua_State *L, const glintL_field *parts, const void *desc);

// ---- Functions of the layers above, which lua/module.c registers ----

/// The functions of bindings/pattern and bindings/run that this layer calls.
typedef struct glintL_tracing {
    const char *(*place)(lua_State *L,
                         lua_CFunction reached); ///< glintL_traced_position
    bool (*is_source)(lua_State *L, int index, bool is_shader);
    void (*refuse)(lua_State *L, const char *what);
    void (*keep)(lua_State *L, int index, const glintL_field *field, int value);
    void (*keep_all)(lua_State *L, int index, int table, const glintL_field *fields); ///< glintL_keep_sources
    void (*keep_closed)(lua_State *L, int index);
    const luaL_Reg *methods; ///< methods of vectors; ended by a NULL name
    lua_CFunction map_array; ///< the method `map` of arrays
    int (*frame_field)(const char *name); ///< glintL_render_find: returns the number of a frame's field, or -1
} glintL_tracing;

void glintL_set_tracing(lua_State *L, const glintL_tracing *tracing);
const glintL_tracing *glintL_get_tracing(lua_State *L); ///< NULL before the module is opened

#define GLINTL_PATTERN "glint.pattern"
#define GLINTL_SHADER "glint.shader"
#define GLINTL_TEXTURE "glint.texture"

// ---- object.c: boxes ----

#define GLINTL_MATERIAL "glint.material"
#define GLINTL_LIGHT "glint.light"
#define GLINTL_CAMERA "glint.camera"
#define GLINTL_SHAPE "glint.shape"
#define GLINTL_OVERLAY "glint.overlay"
#define GLINTL_SCENE "glint.scene"
#define GLINTL_IMAGE "glint.image"
#define GLINTL_PARAMS "glint.params"
#define GLINTL_ANIMATION "glint.animation" ///< animations and sweeps are one type

typedef struct glintL_box {
    void *object; ///< owns a reference; NULL before the object is made and after close
} glintL_box;

/// Pushes a userdata with its metatable and a NULL object. Make it before the object, so that errors leak nothing.
glintL_box *glintL_new_box(lua_State *L, const char *type);
/// Returns the object; raises "<type> expected, got ..." or "<type> is closed".
void *glintL_check_object(lua_State *L, int index, const char *type);
/// Returns the object without raising; NULL if the value is something else.
void *glintL_test_object(lua_State *L, int index, const char *type);
/// Remember (weakly) the userdata on top of the stack for its object; push it again later, or nil if it is gone.
void glintL_remember(lua_State *L, void *object);
void glintL_push_remembered(lua_State *L, const void *object);

/// Pushes an object's userdata: the remembered one, or a new one with a reference. NULL pushes nil. The caller keeps
/// the object alive during the call.
void glintL_push_object(lua_State *L, const char *type, void *object);
/// Keeps the value at `value` alive as long as the userdata at `index`, under `key`, the name of a field.
void glintL_keep(lua_State *L, int index, const char *key, int value);
/// Pushes the value stored under `key`; returns false, and pushes nothing, if there is none.
bool glintL_push_kept(lua_State *L, int index, const char *key);
/// Tells the collector that the new userdata stands for so many bytes that it cannot see, so that a loop that drops
/// images does not fill the memory. May run the collector.
void glintL_charge(lua_State *L, size_t bytes);

/// The script's view of one class of objects.
typedef struct glintL_variant {
    const char *name; ///< "point_light": the path in messages
    glint_object_kind kind; ///< selects the table of its fields; GLINT_OBJECT_NONE: `fields`
    const glintL_field *fields; ///< ends with a NULL name
    bool is_list; ///< the constructor's table may also contain a list
    const char *place; ///< the vector field whose components are `x`, `y` and `z`; NULL: none
    const luaL_Reg *getters; ///< read-only fields: functions of the object; NULL: none
    const luaL_Reg *methods; ///< in addition to the class's; NULL: none
} glintL_variant;

const glintL_field *glintL_fields_of(const glintL_variant *variant); ///< NULL: it has no fields

/// How the objects of one type are read and written. `desc` is a copy of the description, at most GLINTL_DESC_SIZE
/// bytes.
typedef struct glintL_class {
    const char *type;
    const glintL_variant *(*variant)(const void *object);
    void (*get)(const void *object, void *desc);
    glint_status (*set)(void *object, const void *desc, glint_error *error);
    void *(*retain)(void *object);
    void (*release)(void *object);
    /// Called when a field was read from a script, before `set`: checks or adjusts the rest. NULL: nothing to do.
    void (*assigned)(lua_State *L, const glintL_field *field, void *desc);
    /// Fills in fields whose defaults depend on others, for reading. NULL: there are none.
    void (*follow)(void *desc);
    /// Called when the object has accepted `field`: gives warnings. NULL: nothing to do.
    void (*accepted)(lua_State *L, const glintL_field *field, const void *desc);
    const luaL_Reg *methods; ///< in addition to close; NULL: none
    /// Returns the number of objects that the object consists of, and pushes the one with this index; `count` returns -1
    /// for an object that is not a list. NULL: none is.
    lua_Integer (*count)(const void *object);
    void (*push_at)(lua_State *L, const void *object, size_t index);
    // For glintL_open_objects:
    void (*begin)(int variant, void *desc); ///< writes the defaults of variant number `variant`
    glint_status (*create)(const void *desc, void **out, glint_error *error);
    /// Called when the constructor's table, at 1, was read: checks the fields together. NULL: nothing to do.
    void (*given)(lua_State *L, const glintL_variant *variant, const void *desc);
    void (*made)(lua_State *L, const void *desc); ///< called when the userdata, at 2, has its object. May be NULL
} glintL_class;

/// Pushes object number `number` of a list, or nil beyond its end.
int glintL_push_numbered(lua_State *L, const glintL_class *class, const void *object, lua_Integer number);
/// The getter `count` and the method `objects` of scenes and groups, and __pairs of every object.
int glintL_count_objects(lua_State *L);
int glintL_list_objects(lua_State *L);
int glintL_pairs(lua_State *L);
/// fields(object): returns a list of { name, value, default, has_program } for the fields that are set on the object
/// itself. Values are numbers without derivatives, and patterns. `has_program` is true if a program replaces the value,
/// but no pattern of the script, such as a texture of a mesh's file.
int glintL_list_fields(lua_State *L);

/// Defines get, set, retain, release and create for a class whose objects have a description glint_NAME_desc.
#define GLINTL_FUNCTIONS(name) \
    static void get(const void *object, void *desc) \
    { \
        glint_##name##_desc *const copy = desc; \
        *copy = *glint_##name##_get(object); \
        copy->struct_size = sizeof *copy; \
    } \
    static glint_status set(void *object, const void *desc, glint_error *error) { return glint_##name##_set(object, desc, error); } \
    static void *retain(void *object) { return glint_##name##_retain(object); } \
    static void release(void *object) { glint_##name##_release(object); } \
    static glint_status create(const void *desc, void **out, glint_error *error) \
    { \
        glint_##name *made = NULL; \
        const glint_status status = glint_##name##_create(desc, &made, error); \
        *out = made; \
        return status; \
    } \
    _Static_assert(sizeof(glint_##name##_desc) <= GLINTL_DESC_SIZE, "GLINTL_DESC_SIZE")
/// The members of the class that point to these functions.
#define GLINTL_FUNCTION_MEMBERS .get = get, .set = set, .retain = retain, .release = release, .create = create

#define GLINTL_DESC_SIZE 6400

/// Returns the class of a type from the metatable made by glintL_open_class.
const glintL_class *glintL_class_of(lua_State *L, const char *type);
/// Pushes the registry's table at `key`, an address; makes the table if necessary.
void glintL_push_table(lua_State *L, const void *key);
/// Pushes such a table with weak keys ("k") or values ("v").
void glintL_push_weak_table(lua_State *L, const void *key, const char *mode);

// ---- type.c: metatables of types ----

/// Each sets a field of the table on top of the stack. `value` of a text may be NULL: nil.
void glintL_set_text(lua_State *L, const char *name, const char *value);
void glintL_set_number(lua_State *L, const char *name, double value);
void glintL_set_whole(lua_State *L, const char *name, lua_Integer value);
void glintL_set_flag(lua_State *L, const char *name, bool value);
void glintL_set_function(lua_State *L, const char *name, lua_CFunction value);
/// Makes the metatable of a type, which scripts cannot read.
void glintL_new_type(lua_State *L, const char *type, const luaL_Reg *functions);
/// Lists functions as `how`, "field" or "method", in the table on top of the stack.
void glintL_list_functions(lua_State *L, const luaL_Reg *functions, const char *how);
/// Returns the variant of that name that has a table in the engine, or NULL.
const glintL_variant *glintL_find_variant(lua_State *L, const char *name);

// ---- class.c: fields and metatables of boxes ----

/// Makes the metatable of a class.
void glintL_open_class(lua_State *L, const glintL_class *type);
/// Makes the metatable of a class, and adds the constructors of its variants to the table on top of the stack.
void glintL_open_objects(lua_State *L, const glintL_class *type, const glintL_variant *variants, int count);
/// Returns whether the constructor's table, at 1, has the field.
bool glintL_is_given(lua_State *L, const char *name);
/// Lists a kind of object, its fields and its methods in glint._fields(), which the test of meta/glint.lua reads.
/// `methods` may be NULL.
void glintL_list_variant(lua_State *L, const glintL_variant *variant, const luaL_Reg *methods);
/// Lists a variant of a class in glint._fields(), including the methods of every object.
void glintL_list_object(lua_State *L, const glintL_variant *variant, const glintL_class *type);
/// rows.c: glint._rows(name): returns a list of { name, type, doc, unit, follows, required, takes_variable, default }
/// for each field. The list is empty if the object has no table in the engine.
int glintL_list_rows(lua_State *L);
void glintL_push_default(lua_State *L, const glintL_field *field); ///< nil: the field has no default value
/// Pushes the result of glint._fields(): variant -> name -> "field" or "method".
void glintL_push_listed(lua_State *L);
/// Pushes the name of the object at `index` for messages ("plane", "closed shape"); false: it belongs to no class, and
/// nothing is pushed.
bool glintL_push_object_name(lua_State *L, int index);

/// Each file's part of the module: adds its constructors to the table on top of the stack, and makes its metatables.
void glintL_open_vector(lua_State *L);
void glintL_open_variable(lua_State *L);
void glintL_open_transform(lua_State *L);
// ---- json.c ----

/// Writes the shortest text that reads back as the same number.
void glintL_format_number(char out[32], double value);
void glintL_json_string(FILE *out, const char *text);
/// Writes text of `size` bytes before a zero byte, for people: control characters except newline and tab, and bytes that
/// are not UTF-8, are shown escaped.
void glintL_put_text(FILE *out, const char *text, size_t size);
void glintL_json_number(FILE *out, double value); ///< null if it is not finite
/// Prints a format that has only %s, a JSON string or null, and %g, a JSON number.
__attribute__((format(printf, 2, 3))) void glintL_json(FILE *out, const char *format, ...);

#endif
