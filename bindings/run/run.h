/// The job side of the binding: the options of a run, and the loop over its frames. Private to bindings/.
///
///   selection.c       which frames: --frames, --shard
///   render_options.c  the fields of scene:render{}, animations and sweeps that describe a frame
///   names.c           frame number and pass -> file name
///   params.c          glint.params; param_spec.c one parameter and its --set
///   animation.c       the job object and its fields; sweep.c its other kind
///   derivatives.c     passes d:NAME: the slopes of a frame's scene
///   light_passes.c    passes light:NAME
///   work.c            one frame: plan, names, keys, render, hand to the writer
///   until.c           one frame with more and more samples, until its error is small enough
///   provenance.c      the text entries of files, and whether files belong together; source.c the script's text
///   film.c            films: their frames, stored in a folder until the film is made; film_pipe.c through ffmpeg
///   sheet.c           contact sheets; sheet_axes.c their axes, sheet_page.c as an HTML page, sweep_sheet.c of sweeps
///   state.c           the run of a Lua state, and its failure; records.c its frames in order
///   order.c           the order in which a sweep's frames are rendered
///   walk.c            one frame of a list of jobs; job_frames.c a list frame by frame
///   jobs.c            frames of jobs; job_run.c :run; call.c scene:render
///   places.c          the files written so far
///   brightness.c      clipped values, and the measurements of --exposure auto
///   kept_image.c      the picture of an existing file
///
/// No function here raises a Lua error while it owns resources: Lua code runs only under lua_pcall.
#ifndef GLINT_L_RUN_H
#define GLINT_L_RUN_H

#include <signal.h>
#include <stdio.h>

#include "bindings/run/render_fields.h"
#include "bindings/pattern/pattern.h"
#include "engine/glint_files.h"
#include "engine/glint_inspect.h"
#include "engine/glint_programs.h"

#define GLINTL_PATH_SIZE 4096
#define GLINTL_MESSAGE_SIZE 1024
#define GLINTL_PASSES_MAX (GLINT_PASS_COUNT + GLINT_DERIVATIVES_MAX) ///< passes of a frame; light passes follow them
#define GLINTL_PASS_NAME_SIZE (GLINT_NAME_SIZE + 6) ///< bytes of "d:lamp_x", "light:key"
#define GLINTL_FRAMES_MAX 100000000 ///< maximum number of frames of one job

typedef enum glintL_exit {
    GLINTL_EXIT_DONE = 0,
    GLINTL_EXIT_FAILED = 1, ///< a frame failed
    GLINTL_EXIT_USAGE = 2, ///< usage or script error
    GLINTL_EXIT_LATER = 75 ///< disk full
} glintL_exit;

// ---- state.c: the current run. One per lua_State, in the registry; plain Lua has one with no options ----

/// The request of the command line (or :run{}). The run owns the strings.
typedef struct glintL_run glintL_run;
glintL_run *glintL_get_run(lua_State *L); ///< NULL only before glintL_open_run
void glintL_open_run(lua_State *L); ///< makes a run, which the state owns, unless there is one
int luaopen_glint(lua_State *L); ///< lua/module.c: the module
/// scene:render{...} for the scene at 1: reads the table at `index` (may be none), numbers the call, skips or renders
/// it, and writes its files. Pushes an image, or nil and "skipped". Returns the number of results.
int glintL_render_call(lua_State *L, glint_scene *scene, int index);

extern const char *const glintL_colormaps[]; ///< names of glint_colormap, NULL at the end
extern const char *const glintL_tone_curves[]; ///< names of glint_tone_curve, NULL at the end
extern const char *const glintL_pass_colormaps[]; ///< "none" and the names of glint_colormap, NULL at the end
/// run/curves.c: computes the points of the scene's lobes, paths and frustums from its present state.
void glintL_update_curves(lua_State *L, const glint_scene *scene);

// ---- selection.c ----

typedef struct glintL_range {
    int64_t first, last, step; ///< last = INT64_MAX: open
} glintL_range;

typedef struct glintL_selection {
    glintL_range *ranges; ///< owned; none: every frame
    size_t range_count;
    int64_t shard, shard_count; ///< shard 1 .. shard_count; 0 of 0: no shards
} glintL_selection;

/// Return false on failure, when `message` has the expected and the actual text, and the selection is unchanged.
bool glintL_selection_parse(glintL_selection *selection, const char *text, char message[GLINTL_MESSAGE_SIZE]);
bool glintL_selection_parse_shard(glintL_selection *selection, const char *text, char message[GLINTL_MESSAGE_SIZE]);
bool glintL_selection_add(glintL_selection *selection, glintL_range range);
void glintL_selection_clear(glintL_selection *selection);
bool glintL_selection_is_whole(const glintL_selection *selection); ///< whether it selects all frames
/// Returns whether a frame is selected; ignores shards.
bool glintL_selection_has(const glintL_selection *selection, int64_t number);
int64_t glintL_selection_count(const glintL_selection *selection, int64_t first, int64_t last);
/// Returns the range *from .. *to of the selected frames of first .. last, counted from 1, that belong to this shard;
/// empty when to < from.
void glintL_selection_part(const glintL_selection *selection, int64_t first, int64_t last, int64_t *from, int64_t *to);
/// Warns about selected frames outside first .. last, the frames of the script. False: none of these frames is
/// selected, and the run has failed. An empty shard is not a failure.
bool glintL_selection_settle(struct glintL_run *run, int64_t first, int64_t last);

// ---- render_options.c ----

#define GLINTL_ONE(...) +1
#define GLINTL_RENDER_FIELDS (0 GLINTL_RENDER_LIST(GLINTL_ONE, GLINTL_ONE))

extern const glintL_field glintL_render_fields[GLINTL_RENDER_FIELDS + 1]; ///< names and whether numbers, for listing
glintL_render glintL_render_default(void);
/// Returns the field's number, or -1.
int glintL_render_find(const char *name);
/// Returns the words that a field accepts, ended by NULL; NULL: it takes no word, or `field` is -1.
const char *const *glintL_render_choices(int field);
/// Sets a field from text as on the command line. Returns false on failure, when `message` has the expected and the
/// actual text.
bool glintL_render_set_text(glintL_render *render, int field, const char *text, char message[GLINTL_MESSAGE_SIZE]);
/// Sets a field from the Lua value at `index`; raises "<path><name>: ... expected, got ...".
void glintL_render_read(lua_State *L, int index, const char *path, int field, glintL_render *render);
void glintL_render_push(lua_State *L, int field, const glintL_render *render);
/// Writes the field as glintL_render_set_text reads it; false: the field does not affect the picture.
bool glintL_render_spell(const glintL_render *render, int field, char out[96]);

// ---- colormap_words.c ----

/// Reads ":LOW:HIGH", or "" for the picture's own range. False: `message` says what was expected.
bool glintL_read_range(const char *text, double range[2], char message[GLINTL_MESSAGE_SIZE]);
/// Writes "viridis" or "viridis:1:9".
void glintL_spell_colormap(int colormap, const double range[2], char out[64]);

// ---- names.c ----

const char *glintL_base_name(const char *path); ///< returns the part of a path after its last '/'

typedef enum glintL_film_kind {
    GLINTL_FILM_NONE, ///< a picture
    GLINTL_FILM_APNG,
    GLINTL_FILM_MP4,
    GLINTL_FILM_WEBM,
    GLINTL_FILM_GIF
} glintL_film_kind;

typedef struct glintL_naming {
    const char *pattern; ///< borrowed; NULL: no file is written
    bool is_plain; ///< '%' and '#' are ordinary characters
    bool is_numbered; ///< a pattern without a place for the number gets "_0001" before its extension
    struct glintL_film *film; ///< the film of the frames, which the run owns; NULL: none
} glintL_naming;

bool glintL_name_check(const char *pattern, char message[GLINTL_MESSAGE_SIZE]);
bool glintL_name_has_number(const char *pattern);
/// Writes the file name of a frame's pass. False: too long.
/// pass: its name, such as "beauty" or "d:lamp_x"; the file name has "d_lamp_x".
bool glintL_name_file(const glintL_naming *naming, int64_t number, const char *pass, char path[GLINTL_PATH_SIZE]);
bool glintL_name_is_linear(const char *path); ///< .pfm, .npy, .exr: linear light, without integer pixel values and key
bool glintL_name_is_vector(const char *path); ///< .svg, .pdf: pixel values without a key, and overlays as vectors
bool glintL_name_is_exr(const char *path); ///< one file contains all passes
/// Returns the kind of film by the extension; `apng`: a .png is also a film.
glintL_film_kind glintL_film_kind_of(const char *path, bool apng);
bool glintL_name_is_special(const char *path); ///< an existing pipe or device
/// Returns whether an untrusted script may write a file with this name: no folder, not hidden.
bool glintL_name_is_plain(const char *name, size_t length);
#define GLINTL_PLAIN_NAME "plain file name (no folder, no leading '.' or '-', at most 200 bytes)"

// ---- derivatives.c ----

/// Returns whether the command line requests the pass d:NAME.
bool glintL_wants_variable(const glintL_run *run, const char *name);
/// Fills the derivatives of a frame's description with the current slopes of the scene. They are valid until the next
/// call. May raise.
void glintL_find_derivatives(lua_State *L, const glint_scene *scene, glintL_render *render);

// ---- light_passes.c ----

/// Points a frame's description at its own list of light passes. Needed before planning and after each copy.
void glintL_render_point(glintL_render *render);
/// Adds a light pass. False: too long, or too many.
bool glintL_add_light_pass(glintL_render *to, const char *name);
/// Copies the name at `index`, from 0. Returns false if the list is shorter, or NULL.
bool glintL_light_pass_at(const char *list, size_t index, char name[GLINT_NAME_SIZE]);
/// Fails with the nearest name if the scene lacks a light whose pass the frame requests.
glint_status glintL_check_light_passes(const glint_scene *scene, const glintL_render *render, glint_error *error);

// ---- The request ----

typedef struct glintL_set { ///< --set name=text, or a value of --sweep
    const char *name;
    const char *text;
    const char *const *values; ///< all values of the --sweep; NULL for --set
    int64_t value_count;
    bool is_known; ///< a params table has the parameter
} glintL_set;

typedef enum glintL_warnings { GLINTL_WARNINGS_SHOW, GLINTL_WARNINGS_ERROR, GLINTL_WARNINGS_NONE } glintL_warnings;

typedef struct glintL_request {
    glintL_selection selection;
    const char *render_text[GLINTL_RENDER_FIELDS]; ///< takes precedence over the script; NULL: not given
    glintL_set *sets;
    size_t set_count;
    size_t swept_count; ///< how many of the last sets come from --sweep
    bool apng; ///< an output in .png is a film
    double fps; ///< frame rate of films; 0: from the script
    int threads; ///< 0: one per processor
    int repeat; ///< >= 1
    double until; ///< error of the picture as seen at which a frame has enough samples; 0: not given
    double until_light; ///< the same for the error of linear light
    double seconds; ///< time for the samples of a frame; 0: not given
    bool force, no_reuse;
    bool starts_anew; ///< refining does not go on from an unfinished picture
    bool is_untrusted; ///< the script is; its pictures must have plain names
    char *folder; ///< owned; folder for an untrusted script's pictures; NULL: none are written
    glintL_warnings warnings;
    size_t reuse_memory; ///< bytes; 0: the engine's default
} glintL_request;

typedef enum glintL_mode {
    GLINTL_MODE_RENDER,
    GLINTL_MODE_DESCRIBE,
    GLINTL_MODE_EXPLAIN,
    GLINTL_MODE_WATCH ///< jobs wait until cli_run_jobs runs them; scene:render works as usual
} glintL_mode;

// ---- One frame ----

/// The report of a frame, which is printed when its last file is written.
typedef struct glintL_record {
    int64_t index;
    int repeat; ///< 1 ..; 0: no repeats
    bool kept, is_last; ///< is_last: the last of its repeats
    bool is_step; ///< the picture is replaced by one of more samples, and not reported
    double build_ms, encode_ms, write_ms;
    double pixel_count;
    double samples, error; ///< samples of a pixel and the estimated error, if the run refines frames; 0 samples: it does not
    glint_frame_stats stats;
    int files_left; ///< number of files still to be written
    bool failed;
    char derivative[GLINT_DERIVATIVES_MAX][GLINT_DERIVATIVE_NAME_SIZE]; ///< names of the frame's derivatives
    char **files; ///< by pass; owned; NULL: none
    int slots; ///< length of `files`: GLINTL_PASSES_MAX and the light passes
    char *light_passes; ///< owned; names separated by commas; NULL: none
    struct glintL_film *film; ///< the film that gets the beauty pass; NULL: none
    struct glintL_record *next;
} glintL_record;

#define GLINTL_KEY_SIZE 48
/// Writes the key of a file as its text entry. is_unfinished: of a picture that --until has not finished.
#define GLINTL_SPELL_KEY(out, key, is_unfinished) snprintf(out, GLINTL_KEY_SIZE, "%s%s", key, is_unfinished ? "-unfinished" : "")

typedef struct glintL_file {
    glint_pass pass;
    char key[33]; ///< "": the format stores no key
    char whole[33]; ///< key of the whole frame if the file shows a region of it, otherwise ""
    char path[GLINTL_PATH_SIZE];
} glintL_file;

typedef struct glintL_work {
    int64_t index;
    double build_ms;
    glintL_render render;
    glint_plan *plan;
    glint_camera_desc camera; ///< of the frame, turned by render.orbit
    glint_image *image; ///< NULL before rendering
    glint_frame_stats stats;
    double error; ///< the estimate, if the run refines frames
    bool follows_step; ///< its files replace those of an unfinished picture that this run has left
    char unfinished[96]; ///< text of a file that a run with more samples goes on from; "": the picture is finished
    char *sweep; ///< owned; "name=value" lines: the frame's place in a glint.sweep; NULL: none
    char *names; ///< owned; "axis=text" lines: `names` of the sweep's sheet; NULL: none
    struct glintL_film *film;
    int file_count;
    glintL_file *files; ///< owned
} glintL_work;

/// work.c: returns "ambient", "d:lamp_x", "light:key".
const char *glintL_pass_name(const glintL_work *work, glint_pass pass, char buffer[GLINTL_PASS_NAME_SIZE]);

// ---- state.c, records.c ----

/// A step of a frame that is refined, see until.c.
typedef struct glintL_step {
    int64_t index; ///< of the frame
    int number; ///< from 1
    double samples, ms, error;
} glintL_step;

typedef struct glintL_reporter {
    void *context;
    void (*rendering)(void *context, const glintL_run *run, bool begins); ///< called before and after each glint_render
    void (*frame)(void *context, const glintL_run *run, const glintL_record *record);
    void (*warn)(void *context, const char *message);
    /// Called when a sheet or film was made from `count` frames.
    void (*figure)(void *context, const char *kind, const char *path, int64_t count);
    /// Called while a film is being made and has `done` of `count` frames. May be NULL.
    void (*making)(void *context, const char *path, size_t done, size_t count);
    /// Called after each step of a frame that is refined. May be NULL.
    void (*step)(void *context, const glintL_step *step);
    /// Called with each rendered picture, including its linear beauty pass if the run keeps images. May be NULL.
    void (*image)(void *context, const glintL_run *run, const glintL_work *work);
    /// Called before the script runs in `L`, whose libraries are open. May raise. May be NULL.
    void (*prepare)(void *context, lua_State *L);
    /// Called before the engine reads a mesh file that the script names. May be NULL.
    void (*reads)(void *context, const char *path);
} glintL_reporter;

/// A callback that receives a frame's scene while the shutter is open: at each of the camera's own moments, then with
/// each number of moments in `counts`, and last at the frame's own instant, with times 0.
typedef struct glintL_moments {
    const int *counts;
    size_t count;
    bool (*see)(void *data, glint_scene *scene, int times, int k); ///< false: out of memory
    void *data;
} glintL_moments;

/// A file that the run has written, an entry of a hash table.
typedef struct glintL_written {
    uint64_t path; ///< hash; 0: a free entry
    uint64_t picture; ///< hash of the picture's key, or of the frame if it has none
    int64_t index; ///< number of the first frame that it was written for
} glintL_written;

/// The light of the pictures in one folder.
typedef struct glintL_folder_light {
    char *folder; ///< with its slash; "": the working directory. Owned
    glint_brightness seen;
    char stops[16]; ///< the folder's exposure
} glintL_folder_light;

struct glintL_run {
    bool times_stages, counts_work;
    bool keeps_images; ///< every picture includes its linear beauty pass
    int preview_side; ///< > 0: limit of the longer side of pictures, which have one sample per pixel
    bool was_shrunk; ///< preview_side made the picture smaller
    double least_samples; ///< samples of a pixel if the script has fewer
    double most_samples; ///< see glintL_run_limit; 0: no limit
    bool renders_partner; ///< pictures are the partners of those that are wanted, for glint_estimate_error
    bool is_dialect; ///< the script is in a dialect, where the functions that warnings name have other names
    bool is_command; ///< run by the command: its options override the script's; files are written in the background
    glintL_mode mode;
    int64_t explain_frame;
    glint_plan *explain_plan; ///< owned
    struct glintL_order *explain_order; ///< owned; order of the sweep that contains the frame; NULL: no sweep
    /// Called with the scene of the explained frame, in the script's state; must not raise. NULL: not called
    void (*see_scene)(lua_State *L, glint_scene *scene, const glintL_render *render);
    bool keeps_scene; ///< keeps the scene of the explained frame and sets the next three fields
    glint_scene *retained_scene; ///< owned; the scene at that frame
    glintL_render retained_render;
    glint_plan *retained_neighbour; ///< owned; the previous frame, or the second for the first; NULL: none
    glintL_moments moments; ///< receives the frame's scene at the times of open shutters, if `see` is not NULL
    char script[256]; ///< base name
    char source[33]; ///< see glintL_find_source; "": not computed yet
    glintL_request request;
    glintL_reporter reporter;

    glint_renderer *renderer;
    glint_renderer *other_renderer; ///< the one that glintL_run_limit exchanges for `renderer`; NULL: none yet
    int renderer_threads; ///< number of threads, as requested
    glint_writer *writer;
    glintL_record *head, *tail; ///< in the order of frames
    int64_t files_pending;
    glintL_work *deferred; ///< the first call, until it is known whether there is a second
    char *params_text; ///< owned; "name=value" lines
    char *names_text; ///< owned; lines "name=label" and "name:choice=text" of parameters that have them
    glintL_written *written; ///< owned
    size_t written_count, written_capacity;
    struct timespec written_since; ///< files with a later time are of this run or of one beside it
    bool met_other_run; ///< a warning has named a file that another run writes
    struct glintL_film *films; ///< owned; made when all their frames exist

    int64_t count; ///< frames numbered so far
    int64_t call_count; ///< frames numbered by scene:render
    int64_t selected_calls;
    int64_t total, todo; ///< 0: unknown
    int64_t done, kept; ///< number of reported frames
    uint64_t clipped, pixels, nonfinite; ///< totals of the reported frames
    bool finds_range; ///< the run also measures the pass that is scaled for viewing
    double range[2]; ///< range of that pass's values
    glint_brightness brightness; ///< brightness of data pictures; in a measuring run, of all pictures with integer values
    glintL_folder_light *folders; ///< light of each folder's pictures, for --exposure auto
    size_t folder_count;
    int64_t point, point_count; ///< number of the --sweep point, 1 .. point_count; 0 of 0: no sweep
    int64_t point_first; ///< frames numbered before this point
    int64_t earlier; ///< number of job lists already run
    bool is_stopped; ///< glintL_stop_script ended the script
    double since_ms; ///< when the last call returned
    bool in_frame; ///< a frame function is running
    bool no_sheets; ///< only frames are wanted
    const char *live; ///< HTML of a live figure for the pages of sheets; NULL: none
    bool measures; ///< renders every frame for run->brightness, even if its file exists; reports and writes none

    bool has_light; ///< some picture was not black
    bool has_aperture, has_focus; ///< a frame's camera has a lens; has a focus or blades
    bool told_of_view; ///< a warning reported the position of something invisible
    char black[GLINTL_MESSAGE_SIZE]; ///< message about the first black picture; "": none
    char **said; ///< warnings given so far, each once; owned
    size_t said_count;

    int exit_code; ///< exit code of the first failure
    int64_t failed_index;
    char message[GLINTL_MESSAGE_SIZE];
    volatile sig_atomic_t interrupted; ///< number of the signal
};

glintL_run *glintL_run_create(void);
void glintL_run_destroy(glintL_run *run);
/// Resets the run: counts, failure, parameters. Renderer, writer, request and a pending signal stay.
void glintL_run_reset(glintL_run *run);
/// Makes an empty box that glintL_get_run finds, with `collect` as its finalizer (NULL: none).
glintL_run **glintL_new_run_box(lua_State *L, lua_CFunction collect);
/// Lets `L` use a run that the caller owns, and that outlives `L`.
void glintL_attach_run(lua_State *L, glintL_run *run);
double glintL_now_ms(void);
size_t glintL_run_reuse_bytes(const glintL_run *run); ///< memory for cached results: --reuse-memory, or a quarter of the machine's
/// Returns the exit code of a script's error. Lack of memory is not the script's fault, unless the script has a memory
/// limit.
static inline int glintL_script_exit(const glintL_run *run, int status)
{
    return status == LUA_ERRMEM && !run->request.is_untrusted ? GLINTL_EXIT_FAILED : GLINTL_EXIT_USAGE;
}
/// Writes a message, and returns false.
__attribute__((format(printf, 2, 3))) bool glintL_complain(char message[GLINTL_MESSAGE_SIZE], const char *format, ...);
/// Stores the failure if it is the first, and returns false. `index` 0: not about one frame.
bool glintL_run_fail(glintL_run *run, int exit_code, int64_t index, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/// Applies the options of the command line, which take precedence over the script's.
void glintL_run_apply(glintL_run *run, glintL_render *render);
/// Writes the name pattern for a script that names no output.
void glintL_run_default_name(const glintL_run *run, char pattern[GLINTL_PATH_SIZE]);
/// Returns the exit code for an engine's error.
int glintL_run_exit_code(glint_status status);
bool glintL_run_open(glintL_run *run, glint_error *error); ///< makes the renderer and the writer
/// Shows or stores the scene of the explained frame, if the run requests it.
void glintL_run_keep_scene(lua_State *L, glintL_run *run, glint_scene *scene, const glintL_render *render);
/// Adds a record, which is reported in order. False: out of memory, and the run has failed.
glintL_record *glintL_run_add(glintL_run *run, const glintL_work *work);
/// Reports completed frames; with `wait`, waits for all. False: the run has failed.
bool glintL_run_collect(glintL_run *run, bool wait);
/// Message handler: turns any error object into a string.
int glintL_message_handler(lua_State *L);

// ---- warnings.c, warn_view.c ----

/// Gives a warning. Skips it if it was given before (also for another frame, "frame 7: ...") or after a hundred
/// warnings. Under --warnings=error the run fails with it.
void glintL_run_warn(glintL_run *run, const char *format, ...) __attribute__((format(printf, 2, 3)));
/// Gives a warning with the position of the calling Lua code: "<position>: <message>".
void glintL_warn(lua_State *L, const char *message);
/// Warns that a camera's shutter is open, but there is no frame function to evaluate at several times.
void glintL_warn_of_shutter(glintL_run *run);
/// Computes the axes of a camera's view, of length 1. False: the camera looks along its `up`, so that the engine
/// chooses the sides.
bool glintL_view_axes(const glint_camera_desc *camera, double forward[3], double right[3], double up[3]);
/// Returns whether some shape may be in a camera's view: its bounding ball is not outside.
bool glintL_may_show(const glint_scene *scene, const glint_camera_desc *camera, const glint_render_desc *desc);
/// Computes a ball around the scene's shapes except planes; false: there are none.
bool glintL_bound_scene(const glint_scene *scene, double center[3], double *radius);
/// orbit.c: reads "true", "false" or the numbers of --orbit. False: the text is neither.
bool glintL_orbit_read(const char *text, glintL_orbit *orbit);
/// Writes the numbers of --orbit. Returns whether they turn the view.
bool glintL_orbit_spell(const glintL_orbit *orbit, char out[96]);
/// Turns the camera of a scene and stores its fields in `before`. If true, the caller then calls glintL_orbit_end. False:
/// the view is not turned.
bool glintL_orbit_begin(const glint_scene *scene, const glintL_orbit *orbit, const glint_render_desc *desc,
                        glint_camera_desc *before);
void glintL_orbit_end(const glint_scene *scene, const glint_camera_desc *before);
/// glint_plan_create with the turned camera. camera: gets the fields of the camera; may be NULL.
glint_status glintL_orbit_plan(const glint_scene *scene, const glintL_orbit *orbit, const glint_render_desc *desc,
                               glint_camera_desc *camera, glint_plan **out, glint_error *error);
/// own_camera.c: gives a scene without a camera one that has its shapes in view, with a warning. The scene's userdata
/// is at `index`. A chart without shapes gets any camera, without a warning. Other values and scenes without shapes are
/// left unchanged.
void glintL_give_camera(lua_State *L, glintL_run *run, int index);
/// Pushes a white scene with the chart at `index`; false: it is not a chart, and nothing is pushed.
bool glintL_push_chart_scene(lua_State *L, int index);
void glintL_give_cameras(lua_State *L, int list, glintL_run *run); ///< gives cameras to all jobs at `list` (absolute)
/// Prints a note about the state that a later run continues from. It is no mistake, so it is no failure under
/// --warnings=error.
void glintL_run_note(const glintL_run *run, const char *format, ...) __attribute__((format(printf, 2, 3)));
void glintL_forget_warnings(glintL_run *run);
/// Notes a new material. is_dull: it has a shininess and no specular. May raise.
void glintL_note_material(lua_State *L, int index, bool is_dull);
void glintL_note_specular(lua_State *L, int index); ///< the material now has a specular
/// Checks the scene at `scene_index` before a frame is rendered. May raise.
void glintL_observe_frame(lua_State *L, glintL_run *run, int scene_index, const glint_render_desc *desc,
                          int64_t number);
/// Gives the warnings about all frames together, after the script has ended. May raise.
void glintL_report_observed(lua_State *L, glintL_run *run, const char *script);
void glintL_report_unseen(lua_State *L, glintL_run *run);

// ---- warn_black.c ----

/// Checks whether the picture of a frame, just rendered from `scene`, is black, and why.
void glintL_look_for_black(glintL_run *run, const glint_scene *scene, const glintL_work *work);
/// Gives the warning if every picture was black.
void glintL_report_black(glintL_run *run);

// ---- work.c ----

/// Plans a frame. `keep_image`: the script will read the linear picture.
glint_status glintL_work_create(const glint_scene *scene, const glintL_render *render, int64_t index, bool writes,
                                bool keep_image, glintL_work **out, glint_error *error);
/// Turns the frame into the mean of `count` plans, by glint_shutter_desc. On success it owns the plans and their list.
/// `scene` is at the frame's own instant.
glint_status glintL_work_expose(glintL_work *work, const glint_scene *scene, glint_plan **times, size_t count,
                                glint_error *error);
void glintL_work_destroy(glintL_work *work);
/// Names the files and computes their keys.
glint_status glintL_work_name(glintL_work *work, const glintL_naming *naming, glint_error *error);
/// Returns whether all files exist, are complete and have the work's keys. Waits for a file of the same name that is
/// still being written.
bool glintL_work_is_kept(glintL_run *run, const glintL_work *work);
/// Gives the warnings about a planned frame.
glint_status glintL_work_warn(glintL_run *run, const glintL_work *work, glint_error *error);
/// Renders a frame. The run does not count the picture.
glint_status glintL_work_draw(glintL_run *run, glintL_work *work, glint_error *error);
/// Counts the brightness of a rendered frame and reports its picture.
void glintL_work_show(glintL_run *run, const glintL_work *work);
/// Warns about a frame, renders and shows it.
glint_status glintL_work_render(glintL_run *run, glintL_work *work, glint_error *error);
/// Reports a frame and passes its files to the writer. False: the run has failed.
bool glintL_work_finish(glintL_run *run, glintL_work *work, bool kept);
/// Writes the files of an unfinished picture, and waits for them. False: the run has failed.
bool glintL_work_leave(glintL_run *run, const glintL_work *work);
/// Renders a frame for a run that measures. False: the run has failed.
bool glintL_work_measure(glintL_run *run, glintL_work *work);
/// Processes a whole frame: finds its files, or renders it `repeat` times, and finishes it. False: the run has failed.
bool glintL_work_run(glintL_run *run, glintL_work *work, bool force);

// ---- until.c ----

#define GLINTL_SAMPLES_MAX 65536

/// Plans one frame several times.
typedef struct glintL_frame_planner {
    const glintL_render *render; ///< as the script and the command line say
    /// Plans the frame with these options; samples, seed and passes may differ from `render`. NULL: the run has failed.
    glintL_work *(*plan)(void *context, const glintL_render *render);
    /// Names the files of a planned work. False: they have no names yet, or cannot be replaced later.
    bool (*name)(void *context, glintL_work *work);
    void *context;
} glintL_frame_planner;

bool glintL_run_refines(const glintL_run *run); ///< whether the run has --until, --until-light or --seconds
#define GLINTL_ESTIMATE_PIXELS 10 ///< with fewer pixels (glint_estimate_pixels), an estimate is not to be trusted
/// Turns the options of a picture into those of its partner, which glint_estimate_error needs.
void glintL_render_be_partner(glintL_render *render);
/// Renders a frame with 2, 4, 8 ... samples until its error or the time is as requested. The caller owns the last
/// work, which is rendered. NULL: the run has failed.
glintL_work *glintL_refine(glintL_run *run, const glintL_frame_planner *planner, int64_t index);

// ---- steps.c ----

/// Returns how many samples a pixel the next picture takes. samples: of the picture now shown, 0 if there is none.
/// own_samples: of the full picture. full_ms: the time to render the full picture, 0 if unknown.
double glintL_next_samples(double samples, double own_samples, double full_ms);
/// Limits the next pictures, or their partners, to `samples` samples a pixel; 0 removes the limit. Limited pictures have
/// their own renderer, which reuses nothing, so that the run's renderer keeps the data of full pictures.
void glintL_run_limit(glintL_run *run, double samples, bool is_partner);

// ---- brightness.c ----

/// Returns whether pixel values are data, not for viewing: 16 bits, proportional to light.
bool glintL_tone_is_data(const glint_tone_desc *tone);
/// Adds a picture written with that tone to run->brightness, if its pixel values are data or the run measures. In plain
/// Lua, warns about the first clipped picture at once.
void glintL_look_at_brightness(glintL_run *run, const glint_image *image, const glint_tone_desc *tone);
/// Adds a rendered picture of a measuring run to its folder: the part of its output before the name. A lack of memory
/// fails the run.
void glintL_note_folder(glintL_run *run, const char *output, const glint_image *image, const glint_tone_desc *tone);
/// Returns the measured light of an output's folder; NULL: none was measured.
const glintL_folder_light *glintL_find_folder(const glintL_run *run, const char *output);
void glintL_forget_folders(glintL_run *run);
/// Warns about clipped values of the run.
void glintL_warn_of_clipping(glintL_run *run);

// ---- places.c ----

/// Notes the files of a frame, and warns if one of them had another picture in this run. False: the run has failed.
bool glintL_places_add(glintL_run *run, const glintL_work *work);
/// Notes a sheet, or a file that the script saves. number: the number of the last frame before it. If this run has
/// already written the file with another number, warns that the earlier picture is lost. False: the run has failed.
bool glintL_written_note(glintL_run *run, const char *what, const char *path, int64_t number);
void glintL_places_forget(glintL_run *run);

// ---- source.c ----

/// Pushes and returns the path of a file that a script reads: as given if that exists, otherwise next to the script (in
/// the folder of arg[0]) if it exists there.
const char *glintL_push_file(lua_State *L, const char *name);

/// Hashes the text of the script and of the modules that it has loaded so far into run->source, once per run.
void glintL_find_source(lua_State *L, glintL_run *run);

// ---- provenance.c ----

#define GLINTL_TEXT_COUNT 12

/// The text entries of a file: its origin, and everything needed to render it again.
typedef struct glintL_provenance {
    char pass[GLINTL_PASS_NAME_SIZE]; ///< name of the file's pass
    glint_text text[GLINTL_TEXT_COUNT];
    size_t count;
    char frame[24]; ///< number in the script
    char key[GLINTL_KEY_SIZE];
    char options[1024]; ///< "name=value" lines: the options of the frame
    char *sweep; ///< owned; "name=value" lines: the axes of glint.sweep, then of --sweep; NULL: none
    char *names; ///< owned; "axis=text" and "axis:value=text" lines of the sweep's sheet, then of the parameters; NULL: none
} glintL_provenance;

/// Fills the entries. False: out of memory, and there is nothing to free. The texts point into the arguments and into
/// `out`.
bool glintL_provenance_take(glintL_provenance *out, const glintL_run *run, const glintL_work *work,
                            const glintL_file *file);
void glintL_provenance_drop(glintL_provenance *provenance);
/// Returns the value of the line "name=..." in "name=value" lines, and its length. NULL: no such line, or no lines.
const char *glintL_find_line(const char *lines, const char *name, size_t name_length, size_t *length);
/// Returns whether two files were made by the same script and version, so that they can be in one film or sheet. When
/// `strict`, pass, parameters and options must also match, except the values that a sweep changes. False: the message
/// names the difference.
bool glintL_provenance_match(const glint_picture *a, const char *a_path, const glint_picture *b, const char *b_path,
                             bool strict, char message[GLINTL_MESSAGE_SIZE]);

// ---- animation.c, sweep.c, jobs.c, job_run.c ----

typedef enum glintL_job_kind { GLINTL_JOB_ANIMATION, GLINTL_JOB_SWEEP } glintL_job_kind;

#define GLINTL_JOB_SCENE 1 ///< user values: the scene;
#define GLINTL_JOB_FRAME 2 ///< the frame function or the list of axes;
#define GLINTL_JOB_SHEET 3 ///< the sheet;
#define GLINTL_JOB_SAVED 4 ///< the original values of the fields that a sweep changes;
#define GLINTL_JOB_PLACE 5 ///< "name=value" lines of the sweep's current frame;
#define GLINTL_JOB_NAMES 6 ///< "axis=text" lines of the sweep's sheet

typedef struct glintL_job {
    void *self; ///< not NULL, since messages treat a userdata with NULL here as a closed object
    glintL_job_kind kind;
    int64_t frames;
    double fps;
    bool cyclic;
    glintL_render render;
} glintL_job;

int glintL_job_run(lua_State *L); ///< animation:run{...}
/// Reads the constructor's table at `index` into the job at `job_index`. Both are absolute.
void glintL_job_read_table(lua_State *L, int index, int job_index);
void glintL_sweep_read(lua_State *L, int index, int job_index, const char *name); ///< reads size, over or sheet
void glintL_sweep_build(lua_State *L, int index, int64_t n);
/// Pushes a userdata with default fields; see GLINTL_JOB_... for its user values.
glintL_job *glintL_push_job(lua_State *L, glintL_job_kind kind);
const char *glintL_job_name(glintL_job_kind kind); ///< "animation", "sweep"
const glintL_field *glintL_job_fields(glintL_job_kind kind); ///< the fields that are not a frame's; only their names
/// Reads the value at `index` into a field of the job at `job_index`. Both are absolute.
void glintL_job_read_field(lua_State *L, int index, int job_index, const char *name);
int glintL_job_unknown_field(lua_State *L, const glintL_job *job, const char *name); ///< raises
/// Returns the time of frame n of the job, 0 .. 1.
double glintL_job_time(const glintL_job *job, int64_t n);
/// Returns the shutter's k-th of `times` moments, from 0, at frame n. The moments cover the share `share` of the
/// frame's duration around its own time. A cyclic animation wraps around; another one stops at 0 and 1. A single frame
/// lasts from 0 to 1, and its shutter opens at 0.
double glintL_job_shutter_time(const glintL_job *job, int64_t n, double share, int k, int times);
/// Sets the scene to frame n of the job, 1 .. frames, at time t; 1: the job. May raise.
void glintL_job_build(lua_State *L, int index, int64_t n, double t);
/// Restores the values that a sweep has changed, so that the next job does not depend on which frames were rendered.
void glintL_sweep_restore(lua_State *L, int index);

/// Makes a list of jobs from a script's result at `index` (a job, a scene, a chart, or a list of them). Pushes it and returns
/// true, or pushes a message and returns false.
bool glintL_push_jobs(lua_State *L, int index);
/// Returns the number of frames of the jobs in the list at `index`.
int64_t glintL_jobs_total(lua_State *L, int index);
/// Renders the selected frames of a list of jobs, numbered after those that the run has numbered already. Raises only
/// when out of memory. False: the run has failed.
bool glintL_jobs_run(lua_State *L, int index, glintL_run *run);

// ---- job_frames.c: a list of jobs frame by frame, g = 1 .. glintL_jobs_total ----

/// The state of a list's scenes after the frames rendered so far; all 0 at first.
typedef struct glintL_jobs_state {
    int64_t settled; ///< number of jobs whose scene is in the state that the next job starts from
    int64_t sweeping; ///< the sweep whose axes currently have a frame's values; 0: none
} glintL_jobs_state;

/// Renders frame g, as number run->point_first + g. The jobs must be in ascending order. False: the run has failed.
bool glintL_jobs_frame(lua_State *L, int index, glintL_run *run, glintL_jobs_state *state, int64_t g);
/// Plans frame g for its keys. NULL: it cannot be planned, or the run has failed.
glint_plan *glintL_jobs_probe(lua_State *L, int index, glintL_run *run, glintL_jobs_state *state, int64_t g);
/// Adds the axes of job i to the order; adds none if there is no such job. False: the job's frames go to a pipe, so
/// they must be rendered in the order of their numbers.
bool glintL_jobs_axes(lua_State *L, int index, glintL_run *run, int64_t i, struct glintL_order *order);
/// Draws the sheets of the sweeps. False: the run has failed.
bool glintL_jobs_end(lua_State *L, int index, glintL_run *run, glintL_jobs_state *state);

/// Stores the plan of the explained frame in run->explain_plan, if the list contains the frame. With run->keeps_scene
/// it also stores the frame's scene, its render options and the plan of a neighbouring frame.
bool glintL_jobs_explain(lua_State *L, int index, glintL_run *run);

// ---- call.c ----

/// Decides the name of the first call at the end of the script. False: the run has failed.
bool glintL_call_settle(glintL_run *run);
/// Raises an error if the script may not render by calls: under --sweep, when the script returned its frames at the
/// first point, or failed there.
void glintL_check_may_render(lua_State *L, const glintL_run *run);
/// Raises the error that ends a script which has provided what was requested (its parameters, one frame's plan).
int glintL_stop_script(lua_State *L);
void glintL_open_kept_image(lua_State *L);
/// Pushes an image that is rendered only when the script reads it. glintL_set_kept_plan gives it its plan, which it
/// owns.
void glintL_push_kept_image(lua_State *L);
void glintL_set_kept_plan(lua_State *L, int index, glint_plan *plan);

// ---- params.c, param_spec.c ----

/// Pushes the spec of one parameter, from its entry in the table of glint.params at `entry` (absolute).
void glintL_push_param_spec(lua_State *L, glintL_run *run, const char *name, int entry);
/// Pushes the value of a parameter for the script: spec.value, or a vector for a point, whose value in its spec is the
/// text "X,Y,Z". spec: absolute index.
void glintL_push_param_value(lua_State *L, int spec);
/// Pushes the list of all parameters: {name=, type=, default=, value=, min=, max=, whole=, drag=, unit=, label=, doc=,
/// choices=, names=}. `names` has a text for each choice.
void glintL_push_params(lua_State *L);
/// Pushes the allowed values of a parameter, for messages. spec: absolute index of its description.
const char *glintL_push_allowed(lua_State *L, int spec);
/// Pushes the message about a --set that matches no params table; or pushes nothing and returns false.
bool glintL_push_unknown_set(lua_State *L);

#endif
