/// glint cost SCRIPT: what each setting of a scene costs in time, and how far its picture is from a converged one.
/// The Lua modules decide what to measure, judge the measurements and print them; they call the C functions, which
/// render and measure. Private to bindings/.
///
///   cost.c       the command; its options, the script and the output, for the modules
///   subject.c    the scene, for the knobs
///   setting.c    the values of a setting, read and applied to render options and scene
///   scene.c      the state of a scene: its camera, materials and lights, edited and restored
///   shapes.c     the same for meshes: shading, and spheres with other numbers of segments
///   moments.c    the same at the times of an open shutter
///   measure.c    one setting in the engine: its plan, its picture and its time
///   errors.c     a picture against the reference
///
///   study.lua    the phases of a study; its cases and rows
///   knobs.lua    the table of knobs: a setting that trades accuracy for time is a row of it
///   errors.lua   the reference, and the pictures of a case with several seeds
///   verdict.lua  what the spread of the errors allows to say: confidence, verdicts, effects that are lost
///   timing.lua   runs in random order, quartiles, the time left
///   front.lua    the Pareto front
///   advice.lua   the sentence of advice, or what is not decided
///   lines.lua    the table for people, and lines for programs
///   page.lua, page.html, plot.lua, plot.css   the page and the plot
#ifndef GLINT_COST_H
#define GLINT_COST_H

#include "bindings/command/cli.h"
#include "bindings/run/carried.h"
#include "engine/glint_compare.h"

#define COST_VALUES_MAX 12

// ---- scene.c ----

typedef struct cost_shaded {
    glint_shape *shape; ///< borrowed
    glint_shading shading; ///< shading before the edit
} cost_shaded;

/// A copy of the scene whose spheres have other segments.
typedef struct cost_copy {
    int64_t segments; ///< 0: exact
    glint_scene *scene; ///< owned
} cost_copy;

/// The objects that a setting may edit, each once and borrowed, and owned copies (notes) of them as the script set them.
typedef struct cost_scene {
    glint_scene *scene; ///< the scene to plan: the original or a copy
    glint_scene *original; ///< borrowed
    glint_scene *note; ///< has the original's description, but no shapes
    cost_copy copies[COST_VALUES_MAX];
    int copy_count;
    cost_shaded *shaded; ///< meshes whose shading is currently edited
    size_t shaded_count;
    glint_camera *camera, *camera_note;
    glint_shape **shapes; ///< with the children of groups, once per instance
    size_t shape_count;
    glint_material **materials, **material_notes;
    size_t material_count;
    glint_light **lights, **light_notes;
    size_t light_count;
} cost_scene;

/// Notes the state of all objects. False: out of memory. Close it, on failure too.
bool cost_scene_open(cost_scene *scene, glint_scene *engine_scene);
void cost_scene_close(cost_scene *scene);
/// Restores all objects. It fails only for want of memory.
glint_status cost_scene_restore(cost_scene *scene, glint_error *error);

// ---- shapes.c ----

typedef struct cost_meshes {
    size_t count, globe_count; ///< meshes, and the spheres made of triangles among them; instances count
    bool is_mixed; ///< the meshes have different shadings
    glint_shading shading; ///< shading of one of the meshes
    int64_t segments; ///< segments of all spheres of triangles; 0: they differ
} cost_meshes;

cost_meshes cost_scene_meshes(const cost_scene *scene);
glint_status cost_scene_set_shading(cost_scene *scene, glint_shading shading, glint_error *error);
/// Sets the segments of every sphere of triangles; 0: exact spheres. Call it before setting the shading.
glint_status cost_scene_set_segments(cost_scene *scene, int64_t segments, glint_error *error);
void cost_scene_restore_meshes(cost_scene *scene);
void cost_scene_close_meshes(cost_scene *scene); ///< frees the copies

// ---- moments.c ----

/// The scene at the times of shutters with more and fewer moments; none for a frame rendered as an instant.
typedef struct cost_moments cost_moments;

/// Prepares the run to record the moments; before the script runs. NULL: out of memory.
cost_moments *cost_moments_open(glintL_moments *out);
void cost_moments_close(cost_moments *moments); ///< NULL: no effect
/// Returns why there are no moments although the shutter is open; NULL: there are some, or the shutter is closed.
const char *cost_moments_lack(const cost_moments *moments);
/// Writes the numbers of moments available, the camera's own first. Returns how many numbers there are.
int cost_moments_counts(const cost_moments *moments, double out[COST_VALUES_MAX]);
/// Sets the scene's objects to time k of `times`; with times and k 0, to the frame's own instant. `scene` receives their
/// state then.
glint_status cost_moments_enter(const cost_moments *moments, int times, int k, cost_scene **scene, glint_error *error);

// ---- cost.c ----

typedef struct cost_study {
    cli_output *output;
    glintL_run *run;
    const cli_options *options;
    cost_scene scene;
    cost_moments *moments; ///< owned
    const glintL_render *own; ///< the script's own options
    glint_renderer *renderers[2][2]; ///< [reuses][counts work]; owned, except the run's own renderer
    glint_reference *references[2]; ///< the truth, and the script's own setting; owned; NULL: none
} cost_study;

cost_study *cost_study_of(lua_State *L); ///< the study of the running function
/// Stops the study: fails the run, unless a signal stopped it, and raises nil.
int cost_fail(lua_State *L, const glint_error *error);

// ---- subject.c ----

/// Adds the numbers of the scene that knobs read to the table on top of the stack. May raise an error.
void cost_add_subject(lua_State *L, const cost_study *study);

// ---- setting.c ----

#define COST_SCENE_NUMBERS 4

/// The changes of a setting to the frame, and how its picture is rendered.
typedef struct cost_setting {
    glintL_render render;
    int shutter_times; ///< 0: the frame is an instant
    bool reuses; ///< rendered after the neighbouring frame, using that frame's cached results
    int shadows, model, shading; ///< indices of words; -1: as in the script
    int64_t light_samples, segments, numbers[COST_SCENE_NUMBERS]; ///< -1: as in the script; segments 0: exact
} cost_setting;

extern const char *const cost_shading_words[]; ///< by glint_shading; ends with NULL
extern const struct cost_scene_number {
    const char *name;
    size_t at; ///< offset in glint_scene_desc
} cost_scene_numbers[COST_SCENE_NUMBERS];
/// Reads the arguments of the Lua function `plan` of measure.c. May raise an error.
void cost_setting_read(lua_State *L, const cost_study *study, cost_setting *out);
glint_status cost_setting_apply(const cost_setting *setting, cost_scene *scene, glint_error *error);
bool cost_is_soft(const glint_light_desc *light); ///< whether the light has a surface and casts soft shadows

// ---- measure.c, errors.c: functions for the modules ----

extern const luaL_Reg cost_measure_functions[], cost_error_functions[];
bool cost_open_renderers(cost_study *study, glint_error *error);
glint_image **cost_push_image(lua_State *L); ///< pushes an owner of an image
const glint_image *cost_image_at(lua_State *L, int index);

#endif
