/// Shared by the files of the binding. The engine knows nothing about Lua, and uses nothing from here.
///
/// An object of the engine travels as a full userdata `glintL_box` holding one reference. Assigning a field copies
/// the description, changes one member and hands it back to the engine, which checks it: the object is unchanged
/// when the check fails. Errors raised to Lua read "material.shininess: number >= 0 expected, got -1".
#ifndef GLINT_L_H
#define GLINT_L_H

#include <lauxlib.h>
#include <lua.h>

#include "engine/glint.h"

// ---- check.c: arguments and tables in ----

/// One field of a description, and how Lua spells it: of the objects rows of glint_object_fields, of other tables the binding's own.
typedef glint_object_field glintL_field;

/// How a binding's own field is read and written: GLINT_TYPE_CUSTOM.
typedef struct glintL_custom {
    void (*read)(lua_State *L, int index, const char *path, void *desc); ///< raises for a wrong value
    void (*push)(lua_State *L, const void *desc);
} glintL_custom;
#define GLINTL_CUSTOM(read, push) .type = GLINT_TYPE_CUSTOM, .custom = &(const glintL_custom) { read, push }

/// How far away something is, or where.
typedef struct glintL_distance {
    double number; ///< 0: it is not given so
    bool has_point;
    double point[3];
} glintL_distance;

/// Pushes "<file>:<line>: " of the Lua code that called; "" where there is none.
void glintL_push_position(lua_State *L);
/// Raises `message` with the position of the Lua code that called.
int glintL_error(lua_State *L, const char *format, ...);
/// Raises "<path>.<message>" for an engine error; `path` may be "" (only the message). Does nothing for GLINT_OK.
void glintL_check_status(lua_State *L, const char *path, const glint_error *error, glint_status status);
/// Reads the value at `index` into the field of `desc`; raises "<path>.<field>: ... expected, got ...".
void glintL_read_field(lua_State *L, int index, const char *path, const glintL_field *field, void *desc);
/// Writes the defaults of a table's parts.
void glintL_begin_table(const glintL_field *parts, void *desc);
/// Pushes the field's value as Lua sees it.
void glintL_push_field(lua_State *L, const glintL_field *field, const void *desc);
/// Replaces the table on top of the stack by an empty one that reads like it: assigning to a part of a value read from an
/// object's field of this name would not reach the object, and raises.
void glintL_freeze(lua_State *L, const char *name);
/// Reads every key of the table at `index`; raises on an unknown key (naming the nearest known one), a non-string key
/// (unless allow_array, when integer keys are left to the caller) and a missing required field.
void glintL_read_table(lua_State *L, int index, const char *path, const glintL_field *fields, void *desc,
                       bool allow_array);
/// "#rgb", "#rrggbb" or a CSS name, as 0xRRGGBB. False: it is none.
bool glintL_find_color(const char *text, size_t length, uint32_t *code);
/// The nearest of `fields` to a misspelt name, else what it means among them, or NULL.
const char *glintL_nearest(const char *name, const glintL_field *fields);
const glintL_field *glintL_find_field(const glintL_field *fields, const char *name);
void glintL_read_vector(lua_State *L, int index, const char *path, double out[3]);
void glintL_read_color(lua_State *L, int index, const char *path, double out[3]);
double glintL_read_number(lua_State *L, int index, const char *path); ///< any number, NaN and infinity too
/// Three finite numbers: a vector or an array of exactly three; `expected` says so in the message.
void glintL_read_three(lua_State *L, int index, const char *path, const char *expected, double out[3]);
/// Which of `best` (NULL: none yet) and `candidate` the misspelt `name` is nearer to; NULL when neither is near.
const char *glintL_nearer(const char *name, const char *best, const char *candidate);
/// What `name` is called here where other programs call it so ("color" of a material: "diffuse"), of those that `has`
/// knows; or NULL.
const char *glintL_meaning(const char *name, bool (*has)(const void *context, const char *known), const void *context);
/// Raises "<path>.<name>: no such field", with "; did you mean '...'?" unless `near` is NULL.
int glintL_no_such_field(lua_State *L, const char *path, const char *name, const char *near);
/// The value at `index` for messages when it is where a field's name should be: raises.
int glintL_bad_key(lua_State *L, const char *path, int index);
/// Raises "<path>: <expected> expected, got <the value at index>".
int glintL_refuse(lua_State *L, int index, const char *path, const char *expected);
/// Pushes the value at `index` as messages spell it: 5, true, string "64", sphere, closed material.
const char *glintL_push_spelling(lua_State *L, int index);
/// Checks that the table at `index` holds 1 .. n and nothing else (string keys pass when `allow_fields`); returns n.
size_t glintL_check_list(lua_State *L, int index, const char *path, bool allow_fields);

// ---- cure.c: what messages add to common mistakes ----

bool glintL_is_module(lua_State *L, int index); ///< whether the value is the table that require "glint" gives
bool glintL_makes(lua_State *L, const char *name); ///< whether glint has a function of that name
/// Each pushes the end of a message, "" where it has no cure: of glint:sphere { ... }, of scene.add(x).
const char *glintL_push_dot_cure(lua_State *L, int index);
const char *glintL_push_colon_cure(lua_State *L, int index);
/// The end of one of Lua's own messages, pushed; NULL: it has no cure. May leave other values on the stack.
const char *glintL_push_lua_cure(lua_State *L, const char *text);
/// Pushes the name after `before` in the text, up to "'" or ")"; NULL, and nothing pushed: the text has no `before`.
const char *glintL_push_name_after(lua_State *L, const char *text, const char *before);

// ---- vector.c: the immutable value of a vector or colour ----

/// Pushes a userdata "glint.vector": v[1..3], v.x/y/z, v.r/g/b, #v, unpack(), ==, tostring, + - * /; assigning raises.
void glintL_push_vector(lua_State *L, const double v[3]);
/// The same with a field `a`.
void glintL_push_texel(lua_State *L, const double v[4]);
#define GLINTL_VECTOR_TYPE "glint.vector"
/// NULL when the value at index is not one.
const double *glintL_to_vector(lua_State *L, int index);
int glintL_unpack(lua_State *L); ///< the method

// ---- dual.c: numbers that know how fast they change with variables ----

#define GLINTL_VARIABLES_MAX 32 ///< of one script
#define GLINTL_DUAL "glint.dual"

typedef struct glintL_dual {
    double value;
    double slope[GLINTL_VARIABLES_MAX]; ///< by each variable
    uint32_t depends; ///< a bit for each variable that it is made of, also where the slope is 0
} glintL_dual;

/// Pushes the variable of this name at a value; the first call of a name makes it. Raises when there are too many.
void glintL_push_variable(lua_State *L, const char *name, double value);
/// The variable's number, from 0; -1: there is none. The nearest one's name, or NULL.
int glintL_find_variable(lua_State *L, const char *name);
const char *glintL_near_variable(lua_State *L, const char *name);
/// lua/variable.c: the same, and from the first one on `math` takes dual numbers.
void glintL_make_variable(lua_State *L, const char *name, double value);
/// Pushes the result of glint's elementary function of that name for the dual number at 1; returns false, and pushes nothing, for other names.
bool glintL_dual_function(lua_State *L, const char *name);
/// Pushes a dual number, or a number where it has no slope.
void glintL_push_dual(lua_State *L, const glintL_dual *d);
const glintL_dual *glintL_to_dual(lua_State *L, int index); ///< NULL: it is none
/// A dual number or a number; false: it is neither.
bool glintL_read_dual(lua_State *L, int index, glintL_dual *out);
/// The value of a function of a (and b, or NULL), whose derivatives by them are by_a and by_b.
glintL_dual glintL_dual_apply(const glintL_dual *a, double by_a, const glintL_dual *b, double by_b, double value);
glintL_dual glintL_dual_pow(const glintL_dual *a, const glintL_dual *b);
/// The numbers of a field's value where there is a dual number among them, of three in a table, of a colour one for all;
/// false: there is none. Allocates nothing.
bool glintL_read_duals(lua_State *L, int index, const char *path, bool is_color, int count, double *out);
/// Keeps the slopes of a value that was assigned to a field with the userdata at `index`, or forgets those that were there.
void glintL_keep_slopes(lua_State *L, int index, const glintL_field *field, int value);
/// The same of one component.
void glintL_keep_part_slopes(lua_State *L, int index, const glintL_field *field, int part, int value);
/// The same of all fields of the constructor's table at `table`.
void glintL_keep_table_slopes(lua_State *L, int index, int table, const glintL_field *fields);
/// Pushes a field's value where it has slopes; false: it has none.
bool glintL_push_sloped(lua_State *L, int index, const glintL_field *field);
/// The slopes of a field by a variable; false: it does not depend on that.
bool glintL_get_slope(lua_State *L, int index, const glintL_field *field, int variable, double out[3]);
/// Counts the userdata at `index` among those with slopes.
void glintL_note_sloped(lua_State *L, int index);
/// Pushes a table that has as keys all userdata with slopes, and maybe others.
void glintL_push_all_sloped(lua_State *L);
void glintL_open_dual(lua_State *L);

// ---- transform.c: the immutable value of an affine map ----

void glintL_push_transform(lua_State *L, const glint_transform *t);
/// NULL when the value at index is not one.
const glint_transform *glintL_to_transform(lua_State *L, int index);

// ---- What patterns do where values are read: bindings/pattern is above, and says it when the module opens ----

typedef struct glintL_tracing {
    const char *(*place)(lua_State *L, lua_CFunction reached); ///< glintL_traced_place, and so on: see below
    bool (*is_source)(lua_State *L, int index, bool is_shader);
    void (*refuse)(lua_State *L, const char *what);
    void (*keep)(lua_State *L, int index, const glintL_field *field, int value);
    void (*keep_closed)(lua_State *L, int index);
    const luaL_Reg *methods; ///< of vectors; ended by a NULL name
} glintL_tracing;

extern const glintL_tracing glintL_patterns; ///< bindings/pattern/patterns.c
void glintL_set_tracing(lua_State *L, const glintL_tracing *tracing);
const glintL_tracing *glintL_get_tracing(lua_State *L); ///< NULL before the module is opened

// ---- bindings/pattern: patterns and shaders ----

#define GLINTL_PATTERN "glint.pattern"
#define GLINTL_SHADER "glint.shader"
#define GLINTL_TEXTURE "glint.texture"

/// Whether a field can have the value's program: of a shader's field, a shader; of others, a pattern or a texture.
bool glintL_is_source(lua_State *L, int index, bool is_shader);
/// Methods of vectors and triples, and glint.dot and so on.
int glintL_dot(lua_State *L);
int glintL_cross(lua_State *L);
int glintL_length(lua_State *L);
int glintL_unit(lua_State *L);
int glintL_reflect(lua_State *L);
/// Returns the place of the traced function: "scene.lua:12: ". NULL: `reached`, found on the call stack of an error, is not
/// the C function that calls it.
const char *glintL_traced_place(lua_State *L, lua_CFunction reached);
/// Raises while a pattern's function runs: `what` would change the scene meanwhile.
void glintL_refuse_within_trace(lua_State *L, const char *what);
/// Keeps the patterns among the fields of the constructor's table at `table` with the object whose userdata is at `index`.
void glintL_keep_sources(lua_State *L, int index, int table, const glintL_field *fields);
/// The same for one field, whose value is at `value`.
void glintL_keep_source(lua_State *L, int index, const glintL_field *field, int value);
/// The userdata at `index` is about to be closed by the script: its patterns stay with the object.
void glintL_keep_closed(lua_State *L, int index);
/// Calls the functions of the patterns of all materials in the scene, and gives the materials their programs.
void glintL_trace_scene(lua_State *L, const glint_scene *scene);
/// Calls the functions of one material, whose userdata is at `index`.
void glintL_trace_material(lua_State *L, int index);
/// Where material:evaluate looks. The vectors need not be unit.
typedef struct glintL_geometry {
    double normal[3], to_light[3], to_eye[3];
    double p[3]; ///< what patterns and shaders read as p and s.world
} glintL_geometry;

/// glint_material_evaluate, of materials with programs, too: at one point, without bumps.
glint_status glintL_evaluate_material(const glint_material *material, const glintL_geometry *at, glint_reflection *out,
                                      glint_error *error);
void glintL_open_patterns(lua_State *L);

// ---- object.c: boxes ----

#define GLINTL_MATERIAL "glint.material"
#define GLINTL_LIGHT "glint.light"
#define GLINTL_CAMERA "glint.camera"
#define GLINTL_SHAPE "glint.shape"
#define GLINTL_OVERLAY "glint.overlay"
#define GLINTL_SCENE "glint.scene"
#define GLINTL_IMAGE "glint.image"
#define GLINTL_PARAMS "glint.params"
#define GLINTL_ANIMATION "glint.animation" ///< job.c: animations and sweeps are one type

typedef struct glintL_box {
    void *object; ///< a reference; NULL before it is made and after close
} glintL_box;

/// Pushes the userdata with its metatable and a NULL object: handle first, resource second.
glintL_box *glintL_new_box(lua_State *L, const char *type);
/// The object; raises "<type> expected, got ..." or "<type> is closed".
void *glintL_check_object(lua_State *L, int index, const char *type);
/// Same without raising: NULL when the value is something else.
void *glintL_test_object(lua_State *L, int index, const char *type);
/// Remembers (weakly) that the userdata on top of the stack stands for its object; and pushes it again later, nil
/// when it is gone.
void glintL_remember(lua_State *L, void *object);
void glintL_push_remembered(lua_State *L, const void *object);

/// The userdata of an object: the remembered one, else a new one holding a reference. NULL gives nil. The caller
/// keeps the object alive meanwhile.
void glintL_push_object(lua_State *L, const char *type, void *object);
/// Keeps the value at `value` alive as long as the userdata at `index`, under `key` (the name of a field).
void glintL_keep(lua_State *L, int index, const char *key, int value);
/// Pushes the value stored under `key`; returns false, and pushes nothing, if there is none.
bool glintL_push_kept(lua_State *L, int index, const char *key);
/// Tells the collector that the userdata just made stands for so many bytes it cannot see, so that a loop that drops
/// images does not fill the memory. May run the collector.
void glintL_charge(lua_State *L, size_t bytes);

/// The script's view of one class of objects.
typedef struct glintL_variant {
    const char *name; ///< "point_light": the path in messages
    glint_object_kind kind; ///< the table of its fields; GLINT_OBJECT_NONE: `fields`
    const glintL_field *fields; ///< ends with a NULL name
    bool is_list; ///< its constructor's table may hold a list, too
    const char *place; ///< the vector field that `x`, `y` and `z` are parts of; NULL: none
    const luaL_Reg *getters; ///< fields that are only read: functions of the object; NULL: none
    const luaL_Reg *methods; ///< in addition to the class's; NULL: none
} glintL_variant;

const glintL_field *glintL_fields_of(const glintL_variant *variant); ///< NULL: it has none

/// How the objects of one type are read and written. `desc` is a copy of the description, of at most
/// GLINTL_DESC_SIZE bytes.
typedef struct glintL_class {
    const char *type;
    const glintL_variant *(*variant)(const void *object);
    void (*get)(const void *object, void *desc);
    glint_status (*set)(void *object, const void *desc, glint_error *error);
    void *(*retain)(void *object);
    void (*release)(void *object);
    /// One field was read from a script: checks or adjusts the rest, before `set`. NULL: nothing to do.
    void (*assigned)(lua_State *L, const glintL_field *field, void *desc);
    /// Fills in fields that follow others, for reading. NULL: there are none.
    void (*follow)(void *desc);
    /// `field` was taken over by the object: the place for a warning. NULL: nothing to do.
    void (*accepted)(lua_State *L, const glintL_field *field, const void *desc);
    const luaL_Reg *methods; ///< besides close; NULL: none
    // For glintL_open_objects:
    void (*begin)(int variant, void *desc); ///< writes the defaults of the variant with this number
    glint_status (*create)(const void *desc, void **out, glint_error *error);
    /// The constructor's table, at 1, was read: checks what its fields are together. NULL: nothing to do.
    void (*given)(lua_State *L, const glintL_variant *variant, const void *desc);
    void (*made)(lua_State *L, const void *desc); ///< the userdata, at 2, has its object. NULL: nothing to do
} glintL_class;

/// Defines get, set, retain, release and create of a class whose objects have a description glint_NAME_desc.
#define GLINTL_FUNCTIONS(name) \
    static void get(const void *object, void *desc) { memcpy(desc, glint_##name##_get(object), sizeof(glint_##name##_desc)); } \
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
/// Members of the class that are these.
#define GLINTL_FUNCTION_MEMBERS .get = get, .set = set, .retain = retain, .release = release, .create = create

#define GLINTL_DESC_SIZE 2048

/// The class of a type, by the metatable glintL_open_class made.
const glintL_class *glintL_class_of(lua_State *L, const char *type);
/// Pushes the table of the registry at `key`, an address; made when it is not there.
void glintL_push_table(lua_State *L, const void *key);
/// Likewise, a table whose keys ("k") or values ("v") do not keep what they stand for.
void glintL_push_weak_table(lua_State *L, const void *key, const char *mode);

// ---- class.c: fields and metatables of boxes ----

/// Makes the metatable of a class.
void glintL_open_class(lua_State *L, const glintL_class *type);
/// The same, and adds the constructors of its variants to the table on top of the stack.
void glintL_open_objects(lua_State *L, const glintL_class *type, const glintL_variant *variants, int count);
/// Lists a sort of object, its fields and its methods in glint._fields(), which the test of meta/glint.lua reads.
/// `methods` may be NULL.
void glintL_list_variant(lua_State *L, const glintL_variant *variant, const luaL_Reg *methods);
/// The same for a variant of a class, with the methods of every object.
void glintL_list_object(lua_State *L, const glintL_variant *variant, const glintL_class *type);
/// rows.c: glint._rows(name): a list of { name, type, doc, unit, follows, required, default } of each field, empty where the object
/// has no table of the engine.
int glintL_list_rows(lua_State *L);
void glintL_note_rows(lua_State *L, const glintL_variant *variant); ///< lists a variant there
/// The result of glint._fields(): variant -> name -> "field" or "method".
void glintL_push_listed(lua_State *L);
/// Pushes what messages call the object at `index` ("plane", "closed shape"); false, and nothing pushed, when it is
/// not of a class.
bool glintL_push_object_name(lua_State *L, int index);

/// Each file's part of the module: adds its constructors to the table on top of the stack and makes its metatables.
void glintL_open_vector(lua_State *L);
void glintL_open_material(lua_State *L);
void glintL_open_variable(lua_State *L);
void glintL_open_light(lua_State *L);
void glintL_open_camera(lua_State *L);
void glintL_open_transform(lua_State *L);
void glintL_open_shape(lua_State *L);
void glintL_open_overlay(lua_State *L); ///< label, colorbar and axes
void glintL_open_scene(lua_State *L);
void glintL_open_image(lua_State *L);
void glintL_open_math(lua_State *L);
void glintL_open_motion(lua_State *L);
void glintL_open_params(lua_State *L);
void glintL_open_animation(lua_State *L); ///< animation and sweep
int luaopen_glint(lua_State *L);

/// pattern/colormap.c: a list of colours, evenly from the first to the last, or a function of 0 .. 1, which is called, as 256
/// sRGB codes. With a list it allocates nothing.
void glintL_read_colors(lua_State *L, int index, const char *path, uint8_t rgb[256][3]);
/// picture.c: glint.read_image.
void glintL_open_picture(lua_State *L);
/// Writes the four bytes of a float32, the least first; returns the place after them.
char *glintL_put_float(char *to, float value);

/// The constructor glint.spheres, of spheres.c.
int glintL_new_spheres(lua_State *L);
/// The constructors glint.mesh and glint.sphere_mesh, of mesh.c.
int glintL_new_mesh(lua_State *L);
int glintL_new_sphere_mesh(lua_State *L);
/// group.c: methods, the getter `count`, and the children in the list at `list`.
int glintL_group_add(lua_State *L);
int glintL_group_remove(lua_State *L);
int glintL_group_count(lua_State *L);
void glintL_group_fill(lua_State *L, int list, int index, const char *name);

/// Sets an object's field by name, for a sweep's axis: the value is on top of the stack and stays there.
/// Works on anything with __newindex; raises as the assignment would.
void glintL_set_field(lua_State *L, int object_index, const char *name);

/// The fields of scene:render{}, of animations and of sweeps that describe a frame and its file.
typedef struct glintL_render {
    glint_render_desc desc;
    char output[4096]; ///< "" = none given
    glint_encode encode;
    int colormap; ///< of the passes depth and d:NAME: 1 + a glint_colormap; 0: grey
    double range[2]; ///< of these: see glint_write_desc
    double dpi; ///< pixels an inch; 0: not said
    uint32_t file_passes; ///< passes to write as files beside the beauty: bits 1u << GLINT_PASS_...
    char derivative[GLINT_DERIVATIVES_MAX][GLINT_DERIVATIVE_NAME_SIZE]; ///< likewise: names of the passes d:NAME
    int derivative_count;
    char light_passes[4096]; ///< likewise: names of the passes light:NAME, divided by commas; see glintL_render_point
} glintL_render;

// ---- state.c: the current run. One per lua_State, in the registry; plain Lua has one with no options ----

/// The request of the command line (or :run{}). The run owns the strings.
typedef struct glintL_run glintL_run;
glintL_run *glintL_get_run(lua_State *L); ///< NULL only before glintL_open_run
void glintL_open_run(lua_State *L); ///< makes one, which the state owns, where there is none
/// scene:render{...} of the scene at 1: reads the table at `index` (may be none), numbers the call, skips or renders it, writes its
/// files. Pushes an image, or nil and "skipped". Returns the number of results.
int glintL_render_call(lua_State *L, glint_scene *scene, int index);

extern const char *const glintL_colormaps[]; ///< names of glint_colormap, NULL at the end
extern const char *const glintL_tone_curves[]; ///< names of glint_tone_curve, NULL at the end
extern const char *const glintL_pass_colormaps[]; ///< "none" and the names of glint_colormap, NULL at the end

#endif
