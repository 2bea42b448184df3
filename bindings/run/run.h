/// The job side of the binding: the options of a run, and the walk of its frames. Private to bindings/.
///
///   selection.c       which frames: --frames, --shard
///   render_options.c  the fields of scene:render{}, animations and sweeps that describe a frame
///   names.c           frame number and pass -> file name
///   params.c          glint.params; param_spec.c one parameter and its --set
///   animation.c       the job object and its fields; sweep.c its other kind
///   derivatives.c     passes d:NAME: the slopes of a frame's scene
///   light_passes.c    passes light:NAME
///   work.c            one frame: plan, names, keys, render, hand to the writer
///   provenance.c      what a file says of itself, and whether files belong together; source.c the script's text
///   film.c            films: their frames, kept in a folder until they are made; film_pipe.c through ffmpeg
///   sheet.c           contact sheets of files; sheet_axes.c their axes, sheet_page.c as an HTML page, sweep_sheet.c of sweeps
///   state.c           the run of a Lua state, and its failure; records.c its frames in order
///   order.c           in which order a sweep's frames are rendered
///   walk.c            one frame of a list of jobs; job_frames.c a list frame by frame
///   jobs.c            frames of jobs; job_run.c :run; call.c scene:render
///   places.c          the files written so far
///   brightness.c      clipped values, and the measurements of --exposure auto
///   kept_image.c      the picture of a file that is already there
///
/// Nothing here raises a Lua error while it holds something: Lua code is called under lua_pcall only.
#ifndef GLINT_L_RUN_H
#define GLINT_L_RUN_H

#include <signal.h>
#include <stdio.h>

#include "bindings/run/render_fields.h"
#include "bindings/value/glintL.h"

#define GLINTL_PATH_SIZE 4096
#define GLINTL_MESSAGE_SIZE 1024
#define GLINTL_PASSES_MAX (GLINT_PASS_COUNT + GLINT_DERIVATIVES_MAX) ///< of a frame, light passes not counted, which follow them
#define GLINTL_PASS_NAME_SIZE (GLINT_NAME_SIZE + 6) ///< bytes of "d:lamp_x", "light:key"
#define GLINTL_FRAMES_MAX 100000000 ///< of one job

typedef enum glintL_exit {
    GLINTL_EXIT_DONE = 0,
    GLINTL_EXIT_FAILED = 1, ///< a frame failed
    GLINTL_EXIT_USAGE = 2, ///< usage or script error
    GLINTL_EXIT_LATER = 75 ///< disk full
} glintL_exit;

// ---- selection.c ----

typedef struct glintL_range {
    int64_t first, last, step; ///< last = INT64_MAX: open
} glintL_range;

typedef struct glintL_selection {
    glintL_range *ranges; ///< owned; none: every frame
    size_t range_count;
    int64_t shard, shard_count; ///< shard 1 .. shard_count; 0 of 0: no shards
} glintL_selection;

/// Each returns false on failure and writes the expectation and the actual text; the selection is then unchanged.
bool glintL_selection_parse(glintL_selection *selection, const char *text, char message[GLINTL_MESSAGE_SIZE]);
bool glintL_selection_parse_shard(glintL_selection *selection, const char *text, char message[GLINTL_MESSAGE_SIZE]);
bool glintL_selection_add(glintL_selection *selection, glintL_range range);
void glintL_selection_clear(glintL_selection *selection);
bool glintL_selection_is_whole(const glintL_selection *selection); ///< every frame
/// Without regard to shards.
bool glintL_selection_has(const glintL_selection *selection, int64_t number);
int64_t glintL_selection_count(const glintL_selection *selection, int64_t first, int64_t last);
/// Which of the selected frames of 1 .. total are this shard's, counted from 1: *from .. *to, empty when to < from.
void glintL_selection_part(const glintL_selection *selection, int64_t first, int64_t last, int64_t *from, int64_t *to);
/// Warns of selected frames outside first .. last, the frames of the script. False: the selection has none of these frames,
/// and the run has failed. An empty shard is not a failure.
bool glintL_selection_settle(struct glintL_run *run, int64_t first, int64_t last);

// ---- render_options.c ----

#define GLINTL_ONE(...) +1
#define GLINTL_RENDER_FIELDS (0 GLINTL_RENDER_LIST(GLINTL_ONE, GLINTL_ONE))

extern const glintL_field glintL_render_fields[GLINTL_RENDER_FIELDS + 1]; ///< names, and whether numbers, for listing
glintL_render glintL_render_default(void);
/// The field's number, or -1.
int glintL_render_find(const char *name);
/// The words a field takes, ended by NULL; NULL: it takes something else, or `field` is -1.
const char *const *glintL_render_choices(int field);
/// Sets a field from text as on the command line. Returns false on failure; `message` has the expectation and the actual text.
bool glintL_render_set_text(glintL_render *render, int field, const char *text, char message[GLINTL_MESSAGE_SIZE]);
/// Sets a field from the Lua value at `index`; raises "<path><name>: ... expected, got ...".
void glintL_render_read(lua_State *L, int index, const char *path, int field, glintL_render *render);
void glintL_render_push(lua_State *L, int field, const glintL_render *render);
/// The field as glintL_render_set_text reads it; false: a field that says nothing of the picture.
bool glintL_render_spell(const glintL_render *render, int field, char out[64]);

// ---- colormap_words.c ----

/// Reads ":LOW:HIGH", or "" for the picture's own. False: `message` says what was expected.
bool glintL_read_range(const char *text, double range[2], char message[GLINTL_MESSAGE_SIZE]);
/// Writes "viridis", "viridis:1:9".
void glintL_spell_colormap(int colormap, const double range[2], char out[64]);

// ---- names.c ----

typedef enum glintL_film_kind {
    GLINTL_FILM_NONE, ///< a picture
    GLINTL_FILM_APNG,
    GLINTL_FILM_MP4,
    GLINTL_FILM_WEBM,
    GLINTL_FILM_GIF
} glintL_film_kind;

typedef struct glintL_naming {
    const char *pattern; ///< borrowed; NULL: no file is written
    bool is_plain; ///< '%' and '#' stand for themselves
    bool is_numbered; ///< a pattern without a place for the number gets "_0001" before its ending
    struct glintL_film *film; ///< the frames go into; NULL: none. The run's
} glintL_naming;

bool glintL_name_check(const char *pattern, char message[GLINTL_MESSAGE_SIZE]);
bool glintL_name_has_number(const char *pattern);
/// The file of a frame's pass. False: too long.
/// pass: its name, "beauty" ... or "d:lamp_x", of which the file has "d_lamp_x".
bool glintL_name_file(const glintL_naming *naming, int64_t number, const char *pass, char path[GLINTL_PATH_SIZE]);
bool glintL_name_is_linear(const char *path); ///< .pfm, .npy, .exr: light as it is, without codes and key
bool glintL_name_is_exr(const char *path); ///< one file has all passes
/// By the ending; `apng`: a .png is a film, too.
glintL_film_kind glintL_film_kind_of(const char *path, bool apng);
bool glintL_name_is_special(const char *path); ///< an existing pipe or device
/// Whether an untrusted script may write a file of this name: a plain one, with no folder and nothing hidden.
bool glintL_name_is_plain(const char *name, size_t length);
#define GLINTL_PLAIN_NAME "plain file name (no folder, no leading '.', at most 200 bytes)"

// ---- derivatives.c ----

/// Whether the command line wants the pass d:NAME.
bool glintL_wants_variable(const glintL_run *run, const char *name);
/// Fills the derivatives of a frame's description with the slopes of the scene as it is; they last until the next call. May
/// raise.
void glintL_find_derivatives(lua_State *L, const glint_scene *scene, glintL_render *render);

// ---- light_passes.c ----

/// Points a frame's description at its own list of light passes: before it is planned, and after each copy.
void glintL_render_point(glintL_render *render);
/// False: too long, or too many.
bool glintL_add_light_pass(glintL_render *to, const char *name);
/// Number `index` of a list, from 0. False: there are not so many, or list is NULL.
bool glintL_light_pass_at(const char *list, size_t index, char name[GLINT_NAME_SIZE]);
/// Fails with the nearest name where a scene has not the lights that a frame wants passes of.
glint_status glintL_check_light_passes(const glint_scene *scene, const glintL_render *render, glint_error *error);

// ---- The request ----

typedef struct glintL_set { ///< --set name=text, or a value of --sweep
    const char *name;
    const char *text;
    const char *const *values; ///< all values of the --sweep; NULL: of --set
    int64_t value_count;
    bool is_known; ///< a params table has it
} glintL_set;

typedef enum glintL_warnings { GLINTL_WARNINGS_SHOW, GLINTL_WARNINGS_ERROR, GLINTL_WARNINGS_NONE } glintL_warnings;

typedef struct glintL_request {
    glintL_selection selection;
    const char *render_text[GLINTL_RENDER_FIELDS]; ///< what beats the script; NULL: nothing
    glintL_set *sets;
    size_t set_count;
    size_t swept_count; ///< number of the last sets, which come from --sweep
    bool apng; ///< an output in .png is a film
    double fps; ///< of films; 0: as the script says
    int threads; ///< 0: one per processor
    int repeat; ///< >= 1
    bool force, no_reuse;
    bool is_untrusted; ///< the script: its pictures have plain names
    char *folder; ///< owned; where an untrusted script's pictures go; NULL: nowhere
    glintL_warnings warnings;
    size_t reuse_memory; ///< bytes; 0: the engine's default
} glintL_request;

typedef enum glintL_mode {
    GLINTL_MODE_RENDER,
    GLINTL_MODE_DESCRIBE,
    GLINTL_MODE_EXPLAIN,
    GLINTL_MODE_WATCH ///< jobs wait until they are run by cli_run_jobs; calls render as ever
} glintL_mode;

// ---- One frame ----

/// The report of a frame when its last file is written.
typedef struct glintL_record {
    int64_t index;
    int repeat; ///< 1 ..; 0: frames are rendered once
    bool kept, is_last; ///< is_last: of its repeats
    double build_ms, encode_ms, write_ms;
    double pixel_count;
    glint_frame_stats stats;
    int files_left; ///< at the writer
    bool failed;
    char derivative[GLINT_DERIVATIVES_MAX][GLINT_DERIVATIVE_NAME_SIZE]; ///< names
    char **files; ///< by pass; owned; NULL: none
    int slots; ///< of `files`: GLINTL_PASSES_MAX and the light passes
    char *light_passes; ///< owned; their names, divided by commas; NULL: there are none
    struct glintL_film *film; ///< its beauty goes into; NULL: none
    struct glintL_record *next;
} glintL_record;

typedef struct glintL_file {
    glint_pass pass;
    char key[33]; ///< "": the format carries none
    char whole[33]; ///< the key of the frame that this is a region of; "": it is none
    char path[GLINTL_PATH_SIZE];
} glintL_file;

typedef struct glintL_work {
    int64_t index;
    double build_ms;
    glintL_render render;
    glint_plan *plan;
    glint_image *image; ///< NULL until it is rendered
    glint_frame_stats stats;
    char *sweep; ///< owned; "name=value" lines of the frame's place in a glint.sweep; NULL: none
    struct glintL_film *film;
    int file_count;
    glintL_file *files; ///< owned
} glintL_work;

/// work.c: "ambient", "d:lamp_x", "light:key".
const char *glintL_pass_name(const glintL_work *work, glint_pass pass, char room[GLINTL_PASS_NAME_SIZE]);

// ---- state.c, records.c ----

typedef struct glintL_reporter {
    void *context;
    void (*rendering)(void *context, const glintL_run *run, bool begins); ///< around each glint_render
    void (*frame)(void *context, const glintL_run *run, const glintL_record *record);
    void (*warn)(void *context, const char *message);
    /// A sheet or film was made of `count` frames.
    void (*figure)(void *context, const char *kind, const char *path, int64_t count);
    /// A film is being made: `done` of its `count` frames are in it. May be NULL.
    void (*making)(void *context, const char *path, size_t done, size_t count);
    /// A picture is rendered, with its linear beauty pass when the run keeps images. May be NULL.
    void (*image)(void *context, const glintL_run *run, const glintL_work *work);
    /// The script is about to run in `L`, whose libraries are open. May raise. NULL: nothing to do.
    void (*prepare)(void *context, lua_State *L);
    /// The engine is about to read a file that the script names: a mesh. May be NULL.
    void (*reads)(void *context, const char *path);
} glintL_reporter;

/// Shown a frame's scene while its shutter is open: as often as the camera has it, then as often as each of `counts`, and last in
/// its own instant, which is of 0 times.
typedef struct glintL_moments {
    const int *counts;
    size_t count;
    bool (*see)(void *data, glint_scene *scene, int times, int k); ///< false: out of memory
    void *data;
} glintL_moments;

/// A file that the run has written, in a hash table.
typedef struct glintL_place {
    uint64_t path; ///< hash; 0: a free entry
    uint64_t picture; ///< hash of the file's content
    int64_t index; ///< number of the first frame that it was written for
} glintL_place;

struct glintL_run {
    bool times_stages, counts_work;
    bool keeps_images; ///< every picture has its linear beauty pass
    int preview_side; ///< > 0: no picture has a longer side or more than one sample a pixel
    bool was_shrunk; ///< by preview_side
    bool is_dialect; ///< the script is in another dialect, with other words than warnings that name functions have
    bool is_command; ///< run by the command: its options beat the script's, files are written behind
    glintL_mode mode;
    int64_t explain_frame;
    glint_plan *explain_plan; ///< owned
    struct glintL_order *explain_order; ///< owned; of the sweep that the frame belongs to; NULL: it is of none
    bool keeps_scene; ///< of the frame that is explained; then there are, too:
    glint_scene *kept_scene; ///< owned; as it is in that frame
    glintL_render kept_render;
    glint_plan *kept_neighbour; ///< owned; the frame before it, or after the first; NULL: none
    glintL_moments moments; ///< who is shown its scene at the times of open shutters, if `see` is not NULL
    char script[256]; ///< base name
    char source[33]; ///< of glintL_find_source; "": not looked for yet
    glintL_request request;
    glintL_reporter reporter;

    glint_renderer *renderer;
    int renderer_threads; ///< as requested
    glint_writer *writer;
    glintL_record *head, *tail; ///< in the order of frames
    int64_t files_pending;
    glintL_work *deferred; ///< the first call, while it is not known whether there is a second
    char *params_text; ///< owned; "name=value" lines
    glintL_place *places; ///< owned
    size_t place_count, place_room;
    struct glintL_film *films; ///< owned; made when all their frames are there

    int64_t count; ///< frames numbered so far
    int64_t call_count; ///< of these by scene:render
    int64_t selected_calls;
    int64_t total, todo; ///< 0: unknown
    int64_t done, kept; ///< reported
    uint64_t clipped, pixels, nonfinite; ///< of the reported frames
    bool finds_range; ///< the run also measures the pass that is scaled for viewing:
    double range[2]; ///< of its numbers
    glint_brightness brightness; ///< of pictures that are data; while the run measures, of all that would be written as codes
    int64_t point, point_count; ///< which value of --sweep, 1 .. point_count; 0 of 0: no sweep
    int64_t point_first; ///< frames numbered before this point
    int64_t earlier; ///< lists of jobs that were run before this one
    bool is_stopped; ///< the script was ended by glintL_stop_script
    double since_ms; ///< when the last call returned
    bool in_frame; ///< a frame function runs
    bool no_sheets; ///< frames alone are wanted
    const char *live; ///< HTML of a live figure for the pages of sheets; NULL: none
    bool measures; ///< every frame is rendered for run->brightness, whatever is there, and none is reported or written

    bool has_light; ///< a picture was seen that is not black
    bool has_aperture, has_focus; ///< a frame's camera has a lens; has a focus or blades
    bool told_of_view; ///< a warning said where something is that does not show
    char black[GLINTL_MESSAGE_SIZE]; ///< the message about the first black one; "": none
    char **said; ///< warnings given, each once; owned
    size_t said_count;

    int exit_code; ///< of the first failure
    int64_t failed_index;
    char message[GLINTL_MESSAGE_SIZE];
    volatile sig_atomic_t interrupted; ///< number of the signal
};

glintL_run *glintL_run_create(void);
void glintL_run_destroy(glintL_run *run);
/// As if nothing had run yet: counts, failure, parameters. Renderer, writer, request and a signal stay.
void glintL_run_reset(glintL_run *run);
/// Makes the box that glintL_get_run finds, empty, with `collect` as its finalizer (NULL: none).
glintL_run **glintL_new_run_box(lua_State *L, lua_CFunction collect);
/// Lets `L` use a run that the caller owns and keeps longer than `L`.
void glintL_attach_run(lua_State *L, glintL_run *run);
double glintL_now_ms(void);
size_t glintL_run_reuse_bytes(const glintL_run *run); ///< memory for cached results: --reuse-memory, or a quarter of the machine's
/// Returns the exit code of a script's error: lack of memory is not the script's fault, unless it has its own limit.
static inline int glintL_script_exit(const glintL_run *run, int status)
{
    return status == LUA_ERRMEM && !run->request.is_untrusted ? GLINTL_EXIT_FAILED : GLINTL_EXIT_USAGE;
}
/// Keeps the first failure and returns false. `index` 0: not one frame's.
bool glintL_run_fail(glintL_run *run, int exit_code, int64_t index, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/// The command line takes precedence over the script.
void glintL_run_apply(glintL_run *run, glintL_render *render);
/// The pattern of a script that names no output.
void glintL_run_default_name(const glintL_run *run, char pattern[GLINTL_PATH_SIZE]);
/// The exit code that answers an engine's error.
int glintL_run_exit_code(glint_status status);
bool glintL_run_open(glintL_run *run, glint_error *error); ///< the renderer and the writer exist afterwards
/// Keeps the scene of the frame that is explained, when the run is to.
void glintL_run_keep_scene(glintL_run *run, glint_scene *scene, const glintL_render *render);
/// Adds a record to be reported in its turn. False: out of memory, and the run has failed.
glintL_record *glintL_run_add(glintL_run *run, const glintL_work *work);
/// Reports completed frames; waits for all when `wait`. False: the run has failed.
bool glintL_run_collect(glintL_run *run, bool wait);
/// Message handler: a string out of any error object.
int glintL_message_handler(lua_State *L);

// ---- warnings.c, warn_view.c ----

/// Gives a warning unless it was given before, if only of another frame ("frame 7: ..."), or a hundred others were; under
/// --warnings=error the run fails with it.
void glintL_run_warn(glintL_run *run, const char *format, ...) __attribute__((format(printf, 2, 3)));
/// The same with the position of the Lua code that called: "<position>: <message>".
void glintL_warn(lua_State *L, const char *message);
/// That a camera's shutter has no frame function to look at several times.
void glintL_warn_of_shutter(glintL_run *run);
/// A ball around the scene's shapes, but planes; false: there are none.
bool glintL_bound_scene(const glint_scene *scene, double center[3], double *radius);
/// own_camera.c: a scene without a camera gets one that has its shapes in view, and a warning says so. The scene's userdata is at
/// `index`; other values, and scenes with nothing to look at, are left unchanged.
void glintL_give_camera(lua_State *L, glintL_run *run, int index);
void glintL_give_cameras(lua_State *L, int list, glintL_run *run); ///< the same of all jobs of the list at `list`, absolute
/// Says what a later run goes on from: no mistake, so that it stays no failure under --warnings=error.
void glintL_run_note(const glintL_run *run, const char *format, ...) __attribute__((format(printf, 2, 3)));
void glintL_forget_warnings(glintL_run *run);
/// A material was made; is_dull: with a shininess and without a specular. May raise.
void glintL_note_material(lua_State *L, int index, bool is_dull);
void glintL_note_specular(lua_State *L, int index); ///< it has got one since
/// Looks at the scene at `scene_index` as it is in a frame that is about to be rendered. May raise.
void glintL_observe_frame(lua_State *L, glintL_run *run, int scene_index, const glint_render_desc *desc,
                          int64_t number);
/// Warns about all frames together, when the script `script` has ended. May raise.
void glintL_report_observed(lua_State *L, glintL_run *run, const char *script);
void glintL_report_unseen(lua_State *L, glintL_run *run);

// ---- warn_black.c ----

/// Looks whether the picture of a frame, just rendered of `scene`, is black, and why.
void glintL_look_for_black(glintL_run *run, const glint_scene *scene, const glintL_work *work);
/// The warning, when no picture has shown anything.
void glintL_report_black(glintL_run *run);

// ---- work.c ----

/// Plans a frame. `keep_image`: the script will look at the linear picture.
glint_status glintL_work_create(const glint_scene *scene, const glintL_render *render, int64_t index, bool writes,
                                bool keep_image, glintL_work **out, glint_error *error);
/// Makes of the frame the mean of `count` plans, which it takes over with their list, by glint_shutter_desc. `scene` is as it is
/// in the frame's own instant.
glint_status glintL_work_expose(glintL_work *work, const glint_scene *scene, glint_plan **times, size_t count,
                                glint_error *error);
void glintL_work_destroy(glintL_work *work);
/// Names the files and takes their keys.
glint_status glintL_work_name(glintL_work *work, const glintL_naming *naming, glint_error *error);
/// Whether every file is there with its key.
/// Whether the files are there, whole and with the work's keys. Waits for a file of the same name still at the writer.
bool glintL_work_is_kept(glintL_run *run, const glintL_work *work);
glint_status glintL_work_render(glintL_run *run, glintL_work *work, glint_error *error);
/// Reports a frame and hands its files to the writer. False: the run has failed.
bool glintL_work_finish(glintL_run *run, glintL_work *work, bool kept);
/// Renders a frame for a run that measures. False: the run has failed.
bool glintL_work_measure(glintL_run *run, glintL_work *work);
/// The whole of a frame: kept or rendered `repeat` times, and finished. False: the run has failed.
bool glintL_work_run(glintL_run *run, glintL_work *work, bool force);

// ---- brightness.c ----

/// Whether codes are data and not for the eye: 16 bits in proportion to light.
bool glintL_tone_is_data(const glint_tone_desc *tone);
/// Adds a picture that is written with that tone to run->brightness, if its codes are data or the run measures. In plain Lua the first
/// clipped picture is warned of at once.
void glintL_look_at_brightness(glintL_run *run, const glint_image *image, const glint_tone_desc *tone);
/// Warns about clipped values of the run.
void glintL_warn_of_clipping(glintL_run *run);

// ---- places.c ----

/// Notes the files of a frame, and warns when one of them had another picture in this run. False: the run has failed.
bool glintL_places_add(glintL_run *run, const glintL_work *work);
/// The same of a file that the script saves, or of a sheet. number: of the last frame before it; what is written after another frame is
/// another picture.
bool glintL_places_note(glintL_run *run, const char *what, const char *path, int64_t number);
void glintL_places_forget(glintL_run *run);

// ---- source.c ----

/// Pushes and returns the name of a file that a script reads: as it is where that is there, else beside the script (the folder
/// of arg[0]), where it is there.
const char *glintL_push_file(lua_State *L, const char *name);

/// Hashes the text of the script and of the modules it has required so far into run->source, once a run.
void glintL_find_source(lua_State *L, glintL_run *run);

// ---- provenance.c ----

#define GLINTL_TEXT_COUNT 11

/// The text entries of a file: its origin, and everything needed to render it again.
typedef struct glintL_provenance {
    char pass[GLINTL_PASS_NAME_SIZE]; ///< name of the file's pass
    glint_text text[GLINTL_TEXT_COUNT];
    size_t count;
    char frame[24]; ///< number within the script
    char options[1024]; ///< "name=value" lines: the options of the frame
    char *sweep; ///< owned; "name=value" lines: the axes of glint.sweep, then of --sweep; NULL: none
} glintL_provenance;

/// False: out of memory, and nothing is to be dropped. The texts point into the arguments and into `out`.
bool glintL_provenance_take(glintL_provenance *out, const glintL_run *run, const glintL_work *work,
                            const glintL_file *file);
void glintL_provenance_drop(glintL_provenance *provenance);
/// Finds the line "name=..." in "name=value" lines; its length goes to *length. NULL: there is none, or no lines.
const char *glintL_find_line(const char *lines, const char *name, size_t name_length, size_t *length);
/// Whether two files were made by the same script and version for the same end, so that they may stand in one film or
/// sheet; pass, parameters and options count when `strict`, but what a sweep changes. False: the message names what
/// differs and where.
bool glintL_provenance_match(const glint_picture *a, const char *a_path, const glint_picture *b, const char *b_path,
                             bool strict, char message[GLINTL_MESSAGE_SIZE]);

// ---- animation.c, sweep.c, jobs.c, job_run.c ----

typedef enum glintL_job_kind { GLINTL_JOB_ANIMATION, GLINTL_JOB_SWEEP } glintL_job_kind;

#define GLINTL_JOB_SCENE 1 ///< user values: the scene,
#define GLINTL_JOB_FRAME 2 ///< the frame function or the list of axes,
#define GLINTL_JOB_SHEET 3 ///< the sheet,
#define GLINTL_JOB_SAVED 4 ///< what a sweep changes, as it was before,
#define GLINTL_JOB_PLACE 5 ///< "name=value" lines of the sweep's frame that was built last

typedef struct glintL_job {
    void *self; ///< not NULL: messages take a userdata with NULL here for a closed object
    glintL_job_kind kind;
    int64_t frames;
    double fps;
    bool cyclic;
    glintL_render render;
} glintL_job;

int glintL_new_sweep(lua_State *L);
int glintL_job_run(lua_State *L); ///< animation:run{...}
/// Reads the table of a constructor at `index` into the job at `job_index`; both absolute.
void glintL_job_read_table(lua_State *L, int index, int job_index);
void glintL_sweep_read(lua_State *L, int index, int job_index, const char *name); ///< size, over, sheet
void glintL_sweep_push_axes(lua_State *L, int axes); ///< a copy of the list at `axes` (absolute)
void glintL_sweep_build(lua_State *L, int index, int64_t n);
/// Pushes a userdata with default fields; see GLINTL_JOB_... for its user values.
glintL_job *glintL_push_job(lua_State *L, glintL_job_kind kind);
const char *glintL_job_name(glintL_job_kind kind); ///< "animation", "sweep"
/// When frame n of the job is, 0 .. 1.
double glintL_job_time(const glintL_job *job, int64_t n);
/// When the shutter looks the k-th time of `times`, from 0, at frame n: `share` of the frame's time lies around the frame's own.
/// A cyclic animation goes around; one that is not stands still before 0 and after 1; a single frame lasts from 0 to 1, and its
/// shutter opens at 0.
double glintL_job_shutter_time(const glintL_job *job, int64_t n, double share, int k, int times);
/// Sets the scene to frame n of the job, 1 .. frames, at time t; 1: the job. May raise.
void glintL_job_build(lua_State *L, int index, int64_t n, double t);
/// Puts back what a sweep has changed, so that the next job does not depend on which frames were rendered.
void glintL_sweep_restore(lua_State *L, int index);
/// Pushes the object, the name of the field and the list of values of axis `i` of those at `axes`; returns the object's
/// index.
int glintL_sweep_push_axis(lua_State *L, int axes, lua_Integer i);
/// Pushes "object.field" of axis `i` of those at `axes`, or its name where the object has none.
void glintL_sweep_push_title(lua_State *L, int axes, lua_Integer i);
/// Pushes the table name -> value of frame n of the sweep at `index`.
void glintL_sweep_push_values(lua_State *L, int index, int64_t n);
/// Pushes the "name=value" lines of frame n of the sweep at `index`, an axis each.
void glintL_sweep_push_place(lua_State *L, int index, int64_t n);

/// Makes a list of jobs from a script's result at `index` (a job, a scene, a list of them): pushes it and
/// returns true, or pushes a message and returns false.
bool glintL_push_jobs(lua_State *L, int index);
/// Frames of the jobs in the list at `index`.
int64_t glintL_jobs_total(lua_State *L, int index);
/// Renders the selected frames of a list of jobs, numbered after those the run has numbered already. Raises
/// for want of memory only. False: the run has failed.
bool glintL_jobs_run(lua_State *L, int index, glintL_run *run);

// ---- job_frames.c: a list of jobs frame by frame, g = 1 .. glintL_jobs_total ----

/// The state that frames rendered so far have left in the scenes of a list; all 0 at first.
typedef struct glintL_jobs_state {
    int64_t settled; ///< jobs that left their scene as the next job finds it
    int64_t sweeping; ///< the sweep whose axes have values of a frame; 0: none
} glintL_jobs_state;

/// Renders frame g, as number run->point_first + g. Jobs come in ascending order. False: the run has failed.
bool glintL_jobs_frame(lua_State *L, int index, glintL_run *run, glintL_jobs_state *state, int64_t g);
/// Plans frame g, for its keys. NULL: it cannot be planned, or the run has failed.
glint_plan *glintL_jobs_probe(lua_State *L, int index, glintL_run *run, glintL_jobs_state *state, int64_t g);
/// Adds the axes of job i; none: there is no such job. False: its frames go to a pipe, as they are numbered.
bool glintL_jobs_axes(lua_State *L, int index, glintL_run *run, int64_t i, struct glintL_order *order);
/// Draws the sheets of the sweeps. False: the run has failed.
bool glintL_jobs_end(lua_State *L, int index, glintL_run *run, glintL_jobs_state *state);

/// The plan of one frame of the list into run->explain_plan, when the frame is among them; run->keeps_scene: what else
/// is stored of it.
bool glintL_jobs_explain(lua_State *L, int index, glintL_run *run);

// ---- call.c ----

/// Settles the name of the first call now that the script has ended. False: the run has failed.
bool glintL_call_settle(glintL_run *run);
/// Raises an error where the frames of --sweep must be returned: after a point that returned some, or failed.
void glintL_check_may_render(lua_State *L, const glintL_run *run);
/// Raises the error that ends a script which has shown what was requested (its parameters, one frame's plan).
int glintL_stop_script(lua_State *L);
void glintL_open_kept_image(lua_State *L);
/// Pushes an image that is rendered only when the script looks at it; it gets its plan, which it owns, later.
void glintL_push_kept_image(lua_State *L);
void glintL_set_kept_plan(lua_State *L, int index, glint_plan *plan);

// ---- params.c, param_spec.c ----

/// Pushes the spec of one parameter, from its entry in the table of glint.params at `entry` (absolute).
void glintL_push_param_spec(lua_State *L, glintL_run *run, const char *name, int entry);
/// Pushes the list of every parameter: {name=, type=, default=, value=, min=, max=, choices=, doc=}.
void glintL_push_params(lua_State *L);
/// Pushes the message about a --set that no params table has, or nothing and returns false.
bool glintL_push_unknown_set(lua_State *L);

// ---- json.c ----

/// The shortest spelling that reads back as the same number.
void glintL_format_number(char out[32], double value);
void glintL_json_string(FILE *out, const char *text);
void glintL_json_number(FILE *out, double value); ///< null when it is not finite

#endif
