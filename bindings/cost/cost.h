/// glint cost SCRIPT: what each setting of a scene costs in time, and how far its picture is from a converged one.
/// Private to bindings/.
///
///   cost.c          the command: its options, the phases of a study in order
///   cost/values.c   the values of a knob
///   cost/knobs.c    the table of knobs: a setting that trades accuracy for time is a row of it
///   cost/scene.c    a scene whose materials and lights a knob edits, and their restoration
///   cost/shapes.c   the same for meshes: shading, and spheres with other numbers of segments
///   cost/moments.c  the same at the times of an open shutter
///   cost/cases.c    the settings to measure, and the rows of the table that show them
///   cost/measure.c  one setting in the engine: its plan, its picture and its time
///   cost/errors.c   the distance from the truth: the reference, decisions pixel by pixel
///   cost/timing.c   runs in random order, quartiles, the time left
///   cost/front.c    the Pareto front, combinations worth measuring, the advice
///   cost/present.c  the study as data; cost/lines.lua the table for people, and lines for programs
///   cost/report.c   the page and the pictures; their contents are cost/page.lua, page.html, plot.lua, plot.css
#ifndef GLINT_COST_H
#define GLINT_COST_H

#include "bindings/command/cli.h"
#include "bindings/run/carried.h"

#define COST_KNOBS_MAX 20
#define COST_VALUES_MAX 12
#define COST_RUNS_MAX 64
#define COST_RUNS_LEAST 3 ///< quartiles of fewer runs mean nothing
#define COST_COMBINATIONS_MAX 8
#define COST_REFERENCE_PARTS 4 ///< the reference is the mean of this many pictures with different seeds
#define COST_LABEL_SIZE 128

// ---- cost/scene.c ----

typedef struct cost_shaded {
    glint_shape *shape; ///< borrowed
    glint_shading shading; ///< shading before the edit
} cost_shaded;

/// A copy of the scene whose spheres have other segments.
typedef struct cost_copy {
    double segments; ///< 0: exact
    glint_scene *scene; ///< owned
} cost_copy;

/// The objects that a knob may edit, each once, with their descriptions from the script.
typedef struct cost_scene {
    glint_scene *scene; ///< the scene to plan: the original or a copy
    glint_scene *original; ///< borrowed
    cost_copy copies[COST_VALUES_MAX];
    int copy_count;
    cost_shaded *shaded; ///< meshes whose shading is currently edited
    size_t shaded_count;
    glint_scene_desc desc; ///< description of the original, from the script
    glint_material **materials;
    glint_material_desc *material_descs;
    size_t material_count;
    glint_light **lights;
    glint_light_desc *light_descs;
    double (*corners)[3]; ///< vertices of all polygon lights' descriptions
    size_t light_count;
} cost_scene;

bool cost_scene_open(cost_scene *scene, glint_scene *engine_scene); ///< false: out of memory
void cost_scene_close(cost_scene *scene);
/// Restores all objects.
void cost_scene_restore(cost_scene *scene);
/// Sets material or light i to a description.
glint_status cost_scene_set_material(cost_scene *scene, size_t i, const glint_material_desc *desc, glint_error *error);
glint_status cost_scene_set_light(cost_scene *scene, size_t i, const glint_light_desc *desc, glint_error *error);
/// Sets the description of the scene itself.
glint_status cost_scene_set(cost_scene *scene, const glint_scene_desc *desc, glint_error *error);
/// Makes every surface matt white without indirect light, so that exactly the points that light number `light` reaches
/// are lit. The light has strength 1 and the others 0; if `light` is not the number of a light, all have strength 1.
/// Shadow settings stay.
glint_status cost_scene_show_light(cost_scene *scene, size_t light, glint_error *error);

// ---- cost/shapes.c ----

typedef struct cost_meshes {
    size_t count, globe_count; ///< meshes, and the spheres made of triangles among them; instances count
    bool is_mixed; ///< the meshes have different shadings
    glint_shading shading; ///< shading of one of the meshes
    double segments; ///< segments of all spheres of triangles; 0: they differ
} cost_meshes;

cost_meshes cost_scene_meshes(const cost_scene *scene);
glint_status cost_scene_set_shading(cost_scene *scene, glint_shading shading, glint_error *error);
/// Sets the segments of every sphere of triangles; 0: exact spheres. Call it before setting the shading.
glint_status cost_scene_set_segments(cost_scene *scene, double segments, glint_error *error);
void cost_scene_restore_meshes(cost_scene *scene);
void cost_scene_close_meshes(cost_scene *scene);

// ---- cost/moments.c ----

/// The scene at the times of shutters with more and fewer moments; none for a frame rendered as an instant.
typedef struct cost_moments cost_moments;

/// Prepares the run to record the moments; before the script runs. NULL: out of memory.
cost_moments *cost_moments_open(glintL_moments *out);
void cost_moments_close(cost_moments *moments); ///< NULL: no effect
/// Returns why there are no moments although the shutter is open; NULL: there are some, or the shutter is closed.
const char *cost_moments_lack(const cost_moments *moments);
/// Writes the numbers of moments available, the camera's own first. Returns how many numbers there are.
int cost_moments_counts(const cost_moments *moments, double out[COST_VALUES_MAX]);
/// Sets the scene's objects to time k of `times`; with times and k 0, to the frame's own instant.
glint_status cost_moments_enter(const cost_moments *moments, glint_scene *scene, int times, int k, glint_error *error);

// ---- cost/knobs.c ----

typedef struct cost_value {
    const char *text; ///< NULL: `number` is the value
    double number;
} cost_value;

/// The frame that a knob is applied to.
typedef struct cost_subject {
    const glint_plan *plan; ///< plan of the frame with the script's own settings
    const glintL_render *render;
    const cost_scene *scene;
    const cost_moments *moments;
    bool has_neighbour; ///< the script has another frame next to this one
    bool is_pfm; ///< the file has no integer pixel values
} cost_subject;

typedef struct cost_values {
    int count; ///< 0: the scene does not respond
    int own; ///< index of the script's own value
    int base; ///< index of the value used in the other knobs' rows; usually `own`
    int truth; ///< index of the value used for the reference, if `has_truth`; otherwise the base is used
    bool has_truth;
    cost_value value[COST_VALUES_MAX];
} cost_values;

/// One setting before it is measured; knobs change it.
typedef struct cost_draft {
    cost_scene *scene;
    glintL_render render;
    int shutter_times; ///< 0: the frame is an instant
    bool reuses; ///< rendered after the neighbouring frame, using that frame's cached results
} cost_draft;

typedef enum cost_source {
    COST_ERROR_FILM, ///< error of the linear light, before pixel values
    COST_ERROR_FILE ///< error of the pixel values in the file
} cost_source;

typedef struct cost_knob {
    const char *name; ///< name as printed
    const char *needs; ///< what a scene needs to respond: "a light that casts shadows"
    cost_source source; ///< stage where the knob's error arises
    bool combines; ///< the knob trades accuracy for time, so combinations with other knobs are tried
    bool is_other_time; ///< the times are not times of a whole frame, so the rows are not on the front
    /// Lists the values, if the plan shows that the scene responds.
    void (*list)(const cost_subject *subject, cost_values *out);
    glint_status (*apply)(cost_draft *draft, cost_value value, glint_error *error); ///< NULL: the value is a number of
    size_t render_at, scene_at; ///< this field of glint_render_desc or, if not 0, of glint_scene_desc
} cost_knob;

extern const cost_knob cost_knobs[];
extern const int cost_knob_count; ///< <= COST_KNOBS_MAX
glint_status cost_knob_apply(const cost_knob *knob, cost_draft *draft, cost_value value, glint_error *error);
int cost_knob_find(const char *name, size_t length); ///< -1: none
/// Returns whether a list such as "samples,model" contains only names of knobs. False: the message is written.
bool cost_knobs_check(const char *list, char message[GLINTL_MESSAGE_SIZE]);

// ---- cost/values.c ----

/// Lists the numbers in order, with the script's own number among them.
void cost_list_numbers(const double *numbers, int count, double own, cost_values *out);
/// Lists the words. own: index of the script's own word.
void cost_list_words(const char *const *words, int count, int own, cost_values *out);
/// Returns the index of a value among the words; the last index if it is none of them.
int cost_find_word(cost_value value, const char *const *words, int count);
void cost_value_text(cost_value value, char out[32]);

// ---- A study ----

typedef struct cost_quartiles {
    double min, q1, median, q3;
} cost_quartiles;

/// COST_TOTAL: wall time of rendering, tone and encoding. COST_CPU: processor time of all threads. Rows are compared by
/// COST_CPU, since other load on the machine changes it little.
typedef enum cost_part { COST_RENDER, COST_TONE, COST_ENCODE, COST_TOTAL, COST_CPU, COST_PART_COUNT } cost_part;

/// A setting to measure. Several rows may show it.
typedef struct cost_case {
    int choice[COST_KNOBS_MAX]; ///< index of each knob's value; -1: as in the base
    int bits; ///< bits of the file, once the case was run
    bool needs_file; ///< a row shows the error of the file
    double estimate_ms; ///< time of a run, with its overhead
    int batch; ///< frames in a run, to make it long enough to be timed; 0: one
    double guess_ms, guess_cpu_ms; ///< estimated times of a frame without overhead, before the timed runs
    int run_count;
    double ms[COST_PART_COUNT][COST_RUNS_MAX];
    cost_quartiles time[COST_PART_COUNT]; ///< quartiles of the runs, by cost_summarize
    bool is_first_alone; ///< the only run is the first, which is dropped when there are more
    bool is_left_out; ///< not timed, because the budget is too small
    glint_frame_stats stats; ///< statistics of the last run
    glint_work work;
    bool is_counted; ///< `work` is known
    bool has_error;
    glint_picture_error film, file; ///< errors of the linear light, and of the values in the file
    double estimate; ///< what --until takes for film.rmse; 0: not estimated
    uint64_t wrong_object, wrong_shadow; ///< pixels
    uint8_t *picture, *difference; ///< PNG, owned, for the report; NULL: none
    size_t picture_size, difference_size;
} cost_case;

/// The visible object and the lights that reach it, at the sample in the middle of each pixel.
typedef struct cost_decisions {
    float *object; ///< owned; the object's number, 0: background
    uint8_t *lit; ///< owned; light_count planes: whether light i reaches the pixel
    size_t light_count; ///< number of lights checked; 1 if there are too many to check each
} cost_decisions;

typedef struct cost_row {
    int knob; ///< -1: a combination of several
    int value;
    int measured; ///< index of the measured case
    char label[COST_LABEL_SIZE]; ///< the value, or "samples=16 precision=float"
    bool is_default, is_front, is_resolved, is_partial;
    double x_fastest;
    int difference; ///< relative to the script's own time: -1 faster, 1 slower, 0 within the quartile range
    bool is_apart; ///< its quartile range overlaps neither neighbour's in the order of times
} cost_row;

typedef struct cost_study {
    cli_output *output;
    glintL_run *run;
    const cli_options *options;
    cost_scene scene;
    cost_moments *moments; ///< owned
    int shutter_times; ///< the script's own number, if there are moments; 0: an instant
    const glintL_render *own;
    cost_values values[COST_KNOBS_MAX]; ///< values of each knob; count 0: not selected, or the scene does not respond
    glint_renderer *renderers[2][2]; ///< [reuses][counts work]; owned, except the run's own renderer
    cost_case *cases; ///< number 0 is the base
    int case_count;
    cost_row *rows;
    int row_count;
    int runs; ///< runs of each case, not counting the first
    int most_runs; ///< runs of a case whose quartile range overlaps a neighbour's
    double run_ms; ///< least time of a run
    double overhead_ms; ///< time to find the error of a picture
    double start_ms, deadline_ms; ///< deadline 0: none
    uint64_t random;

    double reference_samples; ///< samples of each part; 0: no reference
    double reference_seed[COST_REFERENCE_PARTS];
    glint_reference *reference; ///< the mean of the parts
    glint_picture_error reference_error; ///< error of the mean, estimated from the differences of the parts
    cost_decisions truth; ///< decisions of the base, computed in double
    bool is_complete; ///< not interrupted
    char *live; ///< HTML of --live for the page; owned; NULL: none

    char **left_out; ///< owned lines: what the budget or the scene excluded
    int left_out_count;
    char advice[512];
} cost_study;

bool cost_leave_out(cost_study *study, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool cost_is_stopped(const cost_study *study); ///< a signal arrived, or the run has failed

// ---- cost/cases.c ----

/// Fills values, cases and rows: each knob varied on its own around the base. False: the run has failed.
bool cost_list_cases(cost_study *study, const cost_subject *subject);
/// Adds a combination. False: out of memory.
bool cost_add_combination(cost_study *study, const int choice[COST_KNOBS_MAX]);
const cost_knob *cost_row_knob(const cost_row *row); ///< NULL: a combination
const glint_picture_error *cost_row_error(const cost_study *study, const cost_row *row); ///< NULL: not measured
/// Writes the knob's name and the value, "samples 16"; for a combination, its label.
void cost_row_name(const cost_row *row, char out[COST_LABEL_SIZE]);

// ---- cost/measure.c ----

/// Options for planning a case that replace its own.
typedef struct cost_shot {
    uint32_t passes;
    bool codes;
    double samples; ///< 0: the case's
    double seed; ///< < 0: the case's
    bool is_exact; ///< computed in double
    bool is_painted; ///< matt white, lit by light number `light`
    size_t light;
} cost_shot;

double cost_cpu_ms(void); ///< processor time so far, of all threads of the process
bool cost_fail(cost_study *study, const glint_error *error); ///< fails the run, unless it was stopped; returns false
// The bool functions below return false when the run has failed or was stopped.
bool cost_open_renderers(cost_study *study);
cost_shot cost_own_shot(const cost_study *study); ///< how a case is rendered for timing
/// Renders, encodes and times a case once, in memory.
bool cost_run(cost_study *study, cost_case *c);
/// Renders a picture for the study, outside the timed runs. stats: NULL, or receives the statistics, with work counted.
glint_status cost_take(cost_study *study, const cost_case *c, const cost_shot *how, glint_image **out,
                       glint_frame_stats *stats, glint_error *error);
/// Computes the rays that a case's plan expects, to guess its time.
bool cost_expect(cost_study *study, const cost_case *c, double *rays);

// ---- cost/errors.c ----

/// Writes the settings of the reference that differ from the script's: ", with segments exact"; "" if there are none.
void cost_truth_name(const cost_study *study, char out[COST_LABEL_SIZE]);
/// Makes the reference, its own error and the true decisions. `allowance_ms` is the time for all parts.
bool cost_make_reference(cost_study *study, double allowance_ms);
/// Runs a case once; measures its work, errors and decisions; makes the pictures for the report.
bool cost_measure(cost_study *study, cost_case *c);

// ---- cost/timing.c ----

double cost_left_ms(const cost_study *study); ///< time left in the budget; infinite without a budget
/// Runs all cases, one at a time, in random order; then repeats those whose quartile range overlaps a neighbour's, up
/// to the most runs or the budget's end.
bool cost_time_cases(cost_study *study);
void cost_summarize(cost_study *study); ///< computes the quartiles of the measured times
double cost_time_ms(const cost_case *c); ///< the median of COST_CPU, by which rows are compared
double cost_quartile_range(const cost_case *c); ///< the quartile range of COST_CPU
/// Returns whether a case's quartile range overlaps neither neighbour's in the order of times.
bool cost_is_apart(const cost_study *study, int index);
double cost_round_ms(const cost_study *study); ///< time to run every case that is not left out once, as far as known
/// Shows the current step on a terminal, with the expected time of this step and of the rest of the study.
void cost_show(const cost_study *study, const char *what, double step_ms, double remaining_ms);

// ---- cost/front.c ----

/// Adds the combinations that are likely to be on the front, judging from the effect of each knob on its own.
bool cost_add_combinations(cost_study *study);
/// Fills in the comparisons of rows, and the advice.
void cost_judge(cost_study *study);

// ---- cost/present.c, cost/report.c ----

/// Pushes the results of the study as a table, for the Lua modules; `study` is a cost_study. May raise.
void cost_push_study(lua_State *L, const void *study);
/// Makes a text from the table: "table", "events", "plot" (empty if no error is known) or "page".
bool cost_make(const cost_study *study, const char *what, void (*push)(lua_State *L, const void *study),
               glintL_made_text *out, char message[GLINTL_MESSAGE_SIZE]);
/// Prints the table, or JSON lines. False: the message is written.
bool cost_print(const cost_study *study, FILE *out, char message[GLINTL_MESSAGE_SIZE]);
/// Checks that the folder exists, or makes it, and that it is writable. False: the message is written.
bool cost_report_check(const char *folder, char message[GLINTL_MESSAGE_SIZE]);
/// Returns the exit code; the message says what is wrong.
int cost_report_write(const cost_study *study, const char *folder, char message[GLINTL_MESSAGE_SIZE]);

#endif
